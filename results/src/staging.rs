//! How the files of a directory of results change places, so that a process killed at any moment loses neither
//! the former results nor the new ones.
//!
//! New files are written into the hidden folder [`NEW`]. When all are whole it is renamed to [`COMPLETE`]: from
//! here on the new results count. Then the former files that have no successor are removed, the closing file
//! first, the folder is renamed to [`MOVING`] and its files are moved to their names, the closing file last.
//! The name of the folder thus says what remains to be done, and [`recover`] does it.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::artifact::{Artifact, SHAPES};

/// Files being written.
pub(super) const NEW: &str = ".flexion-new";
/// Files that are whole, former ones still in place.
pub(super) const COMPLETE: &str = ".flexion-complete";
/// Files being moved, former ones gone.
pub(super) const MOVING: &str = ".flexion-moving";

/// Makes the new files the results.
pub(super) fn publish(path: &Path) -> io::Result<()> {
    fs::rename(path.join(NEW), path.join(COMPLETE))?;
    sync(path);
    recover(path)
}

/// Moves the new files to their names beside whatever is there.
pub(super) fn place(path: &Path) -> io::Result<()> {
    fs::rename(path.join(NEW), path.join(MOVING))?;
    recover(path)
}

/// Finishes what was interrupted, if anything was.
pub(super) fn recover(path: &Path) -> io::Result<()> {
    let (complete, moving) = (path.join(COMPLETE), path.join(MOVING));
    if complete.is_dir() {
        remove_former(path, &complete)?;
        fs::rename(&complete, &moving)?;
        sync(path);
    }
    if moving.is_dir() {
        for file in files(&moving)? {
            let target = path.join(&file);
            target.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::rename(moving.join(&file), target)?;
        }
        fs::remove_dir_all(&moving)?;
        sync(path);
    }
    Ok(())
}

/// Removes what an interrupted run had begun to write.
pub(super) fn clear(path: &Path) -> io::Result<()> {
    match fs::remove_dir_all(path.join(NEW)) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// The file of that name as a reader should see it: the new one while files are being moved.
pub(super) fn current(path: &Path, artifact: Artifact) -> PathBuf {
    let name = artifact.file_name();
    let hidden = [COMPLETE, MOVING].map(|folder| path.join(folder).join(&*name));
    hidden.into_iter().find(|file| file.is_file()).unwrap_or_else(|| path.join(&*name))
}

/// Removes the files of the former results, the closing one first and those that have no successor after it.
fn remove_former(path: &Path, complete: &Path) -> io::Result<()> {
    let closed = |set: &&&[Artifact]| set.first().is_some_and(|a| complete.join(&*a.file_name()).exists());
    let own = Artifact::SETS.iter().find(closed).copied().unwrap_or(Artifact::RUN);
    for (i, artifact) in own.iter().enumerate() {
        let name = artifact.file_name();
        if i == 0 || !complete.join(&*name).exists() {
            remove(&path.join(&*name))?;
        }
    }
    let shapes = path.join(SHAPES);
    if own.contains(&Artifact::ShapeSeries) && shapes.is_dir() {
        for entry in fs::read_dir(&shapes)? {
            let name = entry?.file_name();
            let is_shape = name.to_str().is_some_and(Artifact::is_shape);
            if is_shape && !complete.join(SHAPES).join(&name).exists() {
                remove(&shapes.join(&name))?;
            }
        }
        // Only if nothing else is in it.
        let _ = fs::remove_dir(&shapes);
    }
    Ok(())
}

fn remove(file: &Path) -> io::Result<()> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// The files in a folder and its folders, relative to it, in order of their names, a closing file last.
fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = PathBuf::from(entry.file_name());
        if entry.file_type()?.is_dir() {
            found.extend(files(&entry.path())?.into_iter().map(|file| name.join(file)));
        } else {
            found.push(name);
        }
    }
    let closing = |file: &Path| {
        Artifact::SETS.iter().filter_map(|set| set.first()).any(|a| file == Path::new(&*a.file_name()))
    };
    found.sort_by(|a, b| closing(a).cmp(&closing(b)).then_with(|| a.cmp(b)));
    Ok(found)
}

/// Brings the new names to disk where the system can; some file systems cannot, and the files are whole anyway.
fn sync(path: &Path) {
    if cfg!(unix)
        && let Ok(directory) = File::open(path)
    {
        let _ = directory.sync_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: [&str; 4] = ["case.resolved.toml", "trajectory.csv", "vtk/frame_00000.vtu", "summary.json"];
    /// What only the former results had.
    const STALE: [&str; 3] = ["plot.svg", "beam.pvd", "vtk/frame_00001.vtu"];

    fn write(folder: &Path, name: &str, text: &str) {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), text).unwrap();
    }

    fn content(path: &Path) -> Vec<(String, String)> {
        let pair = |f: PathBuf| (f.to_string_lossy().into_owned(), fs::read_to_string(path.join(f)).unwrap());
        files(path).unwrap().into_iter().map(pair).collect()
    }

    fn expected() -> Vec<(String, String)> {
        let mut all: Vec<_> = FILES.iter().map(|n| ((*n).to_owned(), "new".to_owned())).collect();
        all.insert(1, ("notes.txt".to_owned(), "mine".to_owned()));
        all
    }

    #[test]
    fn a_replacement_killed_at_any_moment_is_finished_by_the_next_run() {
        // Killed after `removed` former files (the closing one first) were removed, before the first move …
        for removed in 0..=STALE.len() + 1 {
            let dir = tempfile::tempdir().unwrap();
            let path = dir.path();
            write(path, "notes.txt", "mine");
            for name in FILES.iter().chain(&STALE) {
                write(path, name, "old");
            }
            for name in FILES {
                write(&path.join(COMPLETE), name, "new");
            }
            for name in std::iter::once(&"summary.json").chain(&STALE).take(removed) {
                fs::remove_file(path.join(name)).unwrap();
            }
            // A reader sees the new results already.
            assert_eq!(fs::read_to_string(current(path, Artifact::TrajectoryCsv)).unwrap(), "new");
            recover(path).unwrap();
            assert_eq!(content(path), expected(), "{removed} removed");
        }
        // … or after `moved` new files were moved.
        for moved in 0..=FILES.len() {
            let dir = tempfile::tempdir().unwrap();
            let path = dir.path();
            write(path, "notes.txt", "mine");
            for (i, name) in FILES.iter().enumerate() {
                if i >= moved && *name != "summary.json" {
                    write(path, name, "old");
                }
                let folder = if i < moved { path.to_owned() } else { path.join(MOVING) };
                write(&folder, name, "new");
            }
            fs::create_dir_all(path.join(MOVING)).unwrap();
            assert_eq!(fs::read_to_string(current(path, Artifact::TrajectoryCsv)).unwrap(), "new");
            recover(path).unwrap();
            assert_eq!(content(path), expected(), "{moved} moved");
        }
    }

    #[test]
    fn without_an_interruption_nothing_is_touched() {
        let dir = tempfile::tempdir().unwrap();
        write(dir.path(), "summary.json", "old");
        write(dir.path(), ".flexion-new/summary.json", "half");
        recover(dir.path()).unwrap();
        assert_eq!(fs::read_to_string(dir.path().join("summary.json")).unwrap(), "old");
        assert_eq!(fs::read_to_string(current(dir.path(), Artifact::Summary)).unwrap(), "old");
    }
}
