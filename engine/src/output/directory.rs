//! The directory of a run: each file is written whole, and the summary last.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write as _};
use std::path::{Path, PathBuf};

/// Why results could not be written. Every message says where, why and what to try.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The path of the directory is taken by something else.
    #[error("{} is a file, not a directory; choose another output directory", path.display())]
    NotADirectory {
        /// The path asked for.
        path: PathBuf,
    },
    /// The directory holds the results of a former run.
    #[error(
        "{} already holds the results of a run (summary.json); choose another output directory or replace them with --force",
        path.display()
    )]
    HoldsResults {
        /// The directory.
        path: PathBuf,
    },
    /// The directory holds something else.
    #[error(
        "{} is not empty (it holds {found}); choose another output directory or write into it with --force",
        path.display()
    )]
    NotEmpty {
        /// The directory.
        path: PathBuf,
        /// Name of one of the things found in it.
        found: String,
    },
    /// The operating system refused.
    #[error("cannot {action} {}: {source}; {}", path.display(), advice(source))]
    Io {
        /// What was being done, e.g. `write`.
        action: &'static str,
        /// To which file or directory.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A figure could not be drawn.
    #[error(
        "cannot draw the plot: {reason}; the other files are not affected, draw it again from trajectory.csv"
    )]
    Draw {
        /// The reason of the drawing library.
        reason: String,
    },
}

impl OutputError {
    fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> OutputError {
        move |source| OutputError::Io { action, path: path.to_path_buf(), source }
    }
}

/// What to try when the system refuses.
fn advice(error: &io::Error) -> &'static str {
    match error.kind() {
        ErrorKind::PermissionDenied => {
            "choose a directory you may write to, or ask its owner for the permission"
        }
        ErrorKind::ReadOnlyFilesystem => "this file system is read-only: choose a directory on another one",
        ErrorKind::StorageFull => {
            "the disk is full: make room, choose a directory on another disk, or record less often"
        }
        ErrorKind::QuotaExceeded => {
            "the disk quota is used up: make room, choose a directory on another disk, or record less often"
        }
        ErrorKind::FileTooLarge => "record less often or for a shorter time",
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            "part of the path is a file: choose another output directory"
        }
        ErrorKind::InvalidFilename => "choose a shorter or simpler name",
        ErrorKind::NotFound => "check the path; it cannot be made or was removed during the run",
        _ => "check the path and the disk, or choose another output directory",
    }
}

/// The files that results are made of. Their names belong to the program: `--force` replaces them
/// and no other file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Artifact {
    /// `summary.json`: its presence says that the directory is complete.
    Summary,
    /// `case.resolved.toml`.
    ResolvedCase,
    /// `trajectory.csv`.
    TrajectoryCsv,
    /// `trajectory.npz`.
    TrajectoryNpz,
    /// `plot.svg`.
    PlotSvg,
    /// `plot.png`.
    PlotPng,
}

impl Artifact {
    /// All of them, the summary first: the order in which they are removed.
    pub const ALL: [Artifact; 6] = [
        Artifact::Summary,
        Artifact::ResolvedCase,
        Artifact::TrajectoryCsv,
        Artifact::TrajectoryNpz,
        Artifact::PlotSvg,
        Artifact::PlotPng,
    ];

    /// The file's name.
    pub fn file_name(self) -> &'static str {
        match self {
            Artifact::Summary => "summary.json",
            Artifact::ResolvedCase => "case.resolved.toml",
            Artifact::TrajectoryCsv => "trajectory.csv",
            Artifact::TrajectoryNpz => "trajectory.npz",
            Artifact::PlotSvg => "plot.svg",
            Artifact::PlotPng => "plot.png",
        }
    }
}

/// A directory known to be writable, empty of former results, that a run will fill.
///
/// It is complete if and only if it holds `summary.json`: the summary is written last, and removed
/// first when former results are replaced. A run that dies in between leaves no summary.
#[derive(Debug)]
pub struct Directory {
    path: PathBuf,
}

impl Directory {
    /// Makes the directory (with its parents) or takes an empty one, and checks that it can be
    /// written to: call it before a long run. With `force` a directory that is not empty is taken
    /// too; the files of a former run are removed, the summary first, and other files are left alone.
    ///
    /// # Errors
    /// [`OutputError::NotADirectory`], [`OutputError::HoldsResults`] and [`OutputError::NotEmpty`]
    /// as their names say; [`OutputError::Io`] when the system refuses.
    pub fn create(path: impl AsRef<Path>, force: bool) -> Result<Directory, OutputError> {
        let path = path.as_ref().to_path_buf();
        if path.exists() && !path.is_dir() {
            return Err(OutputError::NotADirectory { path });
        }
        fs::create_dir_all(&path).map_err(OutputError::io("make the directory", &path))?;
        let directory = Directory { path };
        if !force {
            directory.refuse_contents()?;
        }
        directory.probe()?;
        for artifact in Artifact::ALL {
            let file = directory.file(artifact);
            match fs::remove_file(&file) {
                Err(e) if e.kind() != ErrorKind::NotFound => {
                    return Err(OutputError::io("remove the former", &file)(e));
                }
                _ => {}
            }
        }
        Ok(directory)
    }

    /// Where it is, as it was asked for.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of one of its files, written or not.
    pub fn file(&self, artifact: Artifact) -> PathBuf {
        self.path.join(artifact.file_name())
    }

    /// Writes one file: `fill` writes to a temporary file in this directory, which is brought to
    /// disk and only then given its name. When anything fails no file of that name is left half-written.
    ///
    /// # Errors
    /// [`OutputError::Io`] with the system's reason.
    pub fn write(
        &self,
        artifact: Artifact,
        fill: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
    ) -> Result<PathBuf, OutputError> {
        let target = self.file(artifact);
        let mut temporary = self.temporary().map_err(OutputError::io("write", &target))?;
        let mut buffered = BufWriter::new(temporary.as_file_mut());
        let written = fill(&mut buffered).and_then(|()| buffered.flush());
        // Without this the buffer would try to write once more when it is dropped.
        drop(buffered.into_parts());
        written
            .and_then(|()| temporary.as_file().sync_all())
            .and_then(|()| temporary.persist(&target).map(drop).map_err(|e| e.error))
            .map_err(OutputError::io("write", &target))?;
        self.sync();
        Ok(target)
    }

    fn refuse_contents(&self) -> Result<(), OutputError> {
        if self.file(Artifact::Summary).exists() {
            return Err(OutputError::HoldsResults { path: self.path.clone() });
        }
        let mut names = Vec::new();
        for entry in fs::read_dir(&self.path).map_err(OutputError::io("read the directory", &self.path))? {
            let entry = entry.map_err(OutputError::io("read the directory", &self.path))?;
            names.push(entry.file_name().to_string_lossy().into_owned());
        }
        match names.into_iter().min() {
            Some(found) => Err(OutputError::NotEmpty { path: self.path.clone(), found }),
            None => Ok(()),
        }
    }

    /// Writes and removes a small file: permissions, read-only and full disks show only so.
    fn probe(&self) -> Result<(), OutputError> {
        let attempt = || {
            let mut file = self.temporary()?;
            file.write_all(&[0; 4096])?;
            file.as_file().sync_all()?;
            file.close()
        };
        attempt().map_err(OutputError::io("write to", &self.path))
    }

    fn temporary(&self) -> io::Result<tempfile::NamedTempFile> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".flexion-").suffix(".part");
        // Readable as any other file the user makes, not only by the owner: the umask applies.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        builder.tempfile_in(&self.path)
    }

    /// Brings the new name to disk where the system can; some file systems cannot, and the file is whole anyway.
    fn sync(&self) {
        if cfg!(unix)
            && let Ok(directory) = File::open(&self.path)
        {
            let _ = directory.sync_all();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(path: &Path) -> Vec<String> {
        let mut names: Vec<String> =
            fs::read_dir(path).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn missing_parents_are_made_and_nothing_is_left_by_the_check() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a/b/c");
        let out = Directory::create(&path, false).unwrap();
        assert_eq!(out.path(), path);
        assert_eq!(names(&path), Vec::<String>::new());
    }

    #[test]
    fn a_path_taken_by_a_file_is_refused_even_with_force() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("taken");
        fs::write(&path, "mine").unwrap();
        for force in [false, true] {
            let e = Directory::create(&path, force).unwrap_err();
            assert!(matches!(e, OutputError::NotADirectory { .. }), "{e}");
            assert!(e.to_string().contains("taken"));
            let e = Directory::create(path.join("below"), force).unwrap_err().to_string();
            assert!(e.contains("below") && e.contains("part of the path is a file"), "{e}");
        }
        assert_eq!(fs::read_to_string(&path).unwrap(), "mine");
    }

    #[test]
    fn results_and_other_files_are_refused_without_force() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("notes.txt"), "mine").unwrap();
        let e = Directory::create(dir.path(), false).unwrap_err();
        assert!(matches!(&e, OutputError::NotEmpty { found, .. } if found == "notes.txt"), "{e}");
        fs::write(dir.path().join("summary.json"), "{}").unwrap();
        let e = Directory::create(dir.path(), false).unwrap_err();
        assert!(matches!(e, OutputError::HoldsResults { .. }), "{e}");
        assert!(e.to_string().contains("--force"));
    }

    #[test]
    fn force_removes_every_file_of_the_former_run_and_no_other() {
        let dir = tempfile::tempdir().unwrap();
        for a in Artifact::ALL {
            fs::write(dir.path().join(a.file_name()), "old").unwrap();
        }
        fs::write(dir.path().join("notes.txt"), "mine").unwrap();
        Directory::create(dir.path(), true).unwrap();
        assert_eq!(names(dir.path()), ["notes.txt"]);
    }

    #[test]
    fn a_failed_write_leaves_neither_the_file_nor_its_temporary() {
        let dir = tempfile::tempdir().unwrap();
        let out = Directory::create(dir.path(), false).unwrap();
        let full = || io::Error::from(ErrorKind::StorageFull);
        let e = out.write(Artifact::TrajectoryCsv, |f| f.write_all(b"half a li").and(Err(full())));
        let e = e.unwrap_err().to_string();
        assert!(e.contains("trajectory.csv") && e.contains("make room"), "{e}");
        assert_eq!(names(dir.path()), Vec::<String>::new());
        out.write(Artifact::TrajectoryCsv, |f| f.write_all(b"whole")).unwrap();
        assert_eq!(fs::read_to_string(out.file(Artifact::TrajectoryCsv)).unwrap(), "whole");
    }

    #[test]
    fn a_directory_that_vanishes_during_the_run_is_an_error_with_its_path() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("gone");
        let out = Directory::create(&path, false).unwrap();
        fs::remove_dir(&path).unwrap();
        let e = out.write(Artifact::Summary, |_| Ok(())).unwrap_err().to_string();
        assert!(e.contains("gone") && e.contains("removed during the run"), "{e}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_file_system_that_takes_no_files_is_found_before_the_run() {
        for path in ["/proc", "/proc/flexion"] {
            let e = Directory::create(path, true).unwrap_err();
            assert!(matches!(e, OutputError::Io { .. }) && e.to_string().contains("/proc"), "{e}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn files_are_as_readable_as_any_other_file() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().unwrap();
        let out = Directory::create(dir.path(), false).unwrap();
        let written = out.write(Artifact::Summary, |f| f.write_all(b"{}")).unwrap();
        fs::write(dir.path().join("plain"), "").unwrap();
        let mode = |p: &Path| fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&written), mode(&dir.path().join("plain")));
    }
}
