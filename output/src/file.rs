//! Single files, written whole or not at all.

use std::fs::{self, File};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::OutputError;

/// Number of files that this process has begun to write by [`write_file`].
static WRITTEN: AtomicU64 = AtomicU64::new(0);

/// Whether [`write_file`] could write a file: what is there is not touched.
///
/// # Errors
/// [`OutputError::Io`] with the system's reason.
pub fn try_file(path: &Path) -> Result<(), OutputError> {
    if path.is_dir() {
        return Err(OutputError::io("write", path)(io::ErrorKind::IsADirectory.into()));
    }
    let hidden = hidden_beside(path).map_err(OutputError::io("write", path))?;
    let written = write_whole(&hidden, &[0; 4096]);
    let removed = fs::remove_file(&hidden);
    written.and(removed).map_err(OutputError::io("write", path))
}

/// A name beside a file that no other process and no other thread has.
fn hidden_beside(path: &Path) -> io::Result<PathBuf> {
    let Some(name) = path.file_name() else { return Err(io::ErrorKind::InvalidFilename.into()) };
    let (process, number) = (std::process::id(), WRITTEN.fetch_add(1, Ordering::Relaxed));
    Ok(path.with_file_name(format!(".{}.{process}-{number}.flexion-new", name.to_string_lossy())))
}

pub(super) fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

/// Writes a single file whole or not at all, replacing what is there: under a hidden name beside it first.
///
/// # Errors
/// [`OutputError::Io`] with the system's reason.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    let attempt = || {
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        // Another process, or another thread, may write the same file at the same time.
        let hidden = hidden_beside(path)?;
        let written = write_whole(&hidden, bytes).and_then(|()| fs::rename(&hidden, path));
        if written.is_err() {
            let _ = fs::remove_file(&hidden);
        }
        written
    };
    attempt().map_err(OutputError::io("write", path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_tried_without_a_trace() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("expected.toml");
        try_file(&file).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        assert!(try_file(&folder.path().join("nowhere/expected.toml")).is_err());
        fs::create_dir(&file).unwrap();
        assert!(try_file(&file).is_err());
    }

    /// Several that write one file at the same time write it whole, each under a name of its own.
    #[test]
    fn a_file_that_is_written_by_many_is_that_of_one() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("report.html");
        std::thread::scope(|scope| {
            for letter in b'a'..b'i' {
                let file = &file;
                scope.spawn(move || {
                    for _ in 0..8 {
                        write_file(file, &vec![letter; 100_000]).unwrap();
                    }
                });
            }
        });
        let whole = fs::read(&file).unwrap();
        assert!(whole.len() == 100_000 && whole.iter().all(|letter| *letter == whole[0]));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
