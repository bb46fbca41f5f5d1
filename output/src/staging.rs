//! How new results take the place of former ones, so that a process killed at any moment loses neither.
//!
//! New files are written into the hidden folder [`NEW`]. When all are whole it is renamed to [`COMPLETE`]: from
//! here on the new results count. Then the former closing file and the former files without a successor are
//! removed, the folder is renamed to [`MOVING`], and its files are moved to their names, the closing file last.
//! The name of the folder thus says what remains to be done, and [`recover`] does it.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use super::artifact::{Artifact, SHAPES};
use super::written::{LIST, Written, hash};

/// Files being written.
pub(super) const NEW: &str = ".flexion-new";
/// Files that are whole, former ones still in place.
const COMPLETE: &str = ".flexion-complete";
/// Files being moved, former ones gone.
const MOVING: &str = ".flexion-moving";

/// Makes the new files, whose closing file has this name, the results.
pub(super) fn publish(path: &Path, closing: &str) -> io::Result<()> {
    list(path, closing)?;
    fs::rename(path.join(NEW), path.join(COMPLETE))?;
    // Not every system can bring a folder to disk; the files are there anyway.
    let _ = File::open(path).and_then(|folder| folder.sync_all());
    recover(path)
}

/// Moves the new files to their names beside whatever is there.
pub(super) fn place(path: &Path, closing: &str) -> io::Result<()> {
    list(path, closing)?;
    fs::rename(path.join(NEW), path.join(MOVING))?;
    recover(path)
}

/// Lists the new files among those that the folder then holds of the program.
fn list(path: &Path, closing: &str) -> io::Result<()> {
    let new = path.join(NEW);
    let names = names(&new)?.into_iter().filter(|name| name != LIST);
    let sealed = names.map(|name| hash(&new.join(&name)).map(|hash| (name, hash)));
    Written::read(path).with(closing, sealed.collect::<io::Result<_>>()?).write(&new)
}

/// Finishes what was interrupted, if anything was.
pub(super) fn recover(path: &Path) -> io::Result<()> {
    let (complete, moving) = (path.join(COMPLETE), path.join(MOVING));
    if complete.is_dir() {
        let closing =
            Artifact::closing().map(Artifact::file_name).find(|name| complete.join(&**name).exists());
        let written = Written::read(path);
        if let Some(closing) = closing {
            // The closing file first: without it the others are no results.
            let others =
                written.of(&closing).filter(|name| *name != closing && !complete.join(name).exists());
            let former = written.holds(&closing).then_some(&*closing);
            for name in former.into_iter().chain(others) {
                remove(&path.join(name))?;
            }
        }
        // Only if nothing else is in it.
        let _ = fs::remove_dir(path.join(SHAPES));
        fs::rename(&complete, &moving)?;
    }
    if moving.is_dir() {
        let closes = |name: &String| Artifact::closing().any(|closing| closing.file_name() == **name);
        let (last, mut first): (Vec<String>, Vec<String>) = names(&moving)?.into_iter().partition(closes);
        first.extend(last);
        for name in first {
            let target = path.join(&name);
            target.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::rename(moving.join(&name), target)?;
        }
        fs::remove_dir_all(&moving)?;
    }
    Ok(())
}

/// Removes a file that may have gone before.
fn remove(file: &Path) -> io::Result<()> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
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

/// The list of the files that a reader should see.
pub(super) fn written(path: &Path) -> Written {
    let hidden = [COMPLETE, MOVING].map(|folder| path.join(folder));
    let new = hidden.into_iter().find(|folder| folder.join(LIST).is_file());
    Written::read(new.as_deref().unwrap_or(path))
}

/// The files in a folder and in that of the shapes in it, relative to it; none where there is no folder.
pub(super) fn names(folder: &Path) -> io::Result<Vec<String>> {
    let mut found = Vec::new();
    for (inside, prefix) in [(folder.to_path_buf(), ""), (folder.join(SHAPES), "vtk/")] {
        let entries = match fs::read_dir(&inside) {
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => continue,
            entries => entries?,
        };
        for entry in entries {
            let entry = entry?;
            let name = entry.file_name();
            if let (Some(name), false) = (name.to_str(), entry.file_type()?.is_dir()) {
                found.push(format!("{prefix}{name}"));
            }
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::written::unsealed;

    const FILES: [&str; 4] = ["vtk/frame_00000.vtu", "trajectory.csv", "case.resolved.toml", "summary.json"];
    /// What only the former results have, in the order of removal after their summary.
    const STALE: [&str; 3] = ["plot.svg", "beam.pvd", "vtk/frame_00001.vtu"];

    fn write(folder: &Path, name: &str, text: &str) {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), text).unwrap();
    }

    /// Results whose replacement was killed after so many removals or moves, beside files of the user, one with the name of
    /// a result.
    fn interrupted(folder: &str, removed: usize, moved: usize) -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path();
        write(path, "notes.txt", "mine");
        write(path, "plot.png", "mine");
        let former = ["summary.json"].iter().chain(&STALE).chain(&FILES[..3]);
        let list =
            |names: &mut dyn Iterator<Item = &&str>| Written::default().with("summary.json", unsealed(names));
        list(&mut former.clone()).write(path).unwrap();
        for (i, name) in former.enumerate() {
            if i >= removed {
                write(path, name, "old");
            }
        }
        fs::create_dir(path.join(folder)).unwrap();
        list(&mut FILES.iter()).write(&path.join(folder)).unwrap();
        for (i, name) in FILES.iter().enumerate() {
            write(&if i < moved { path.to_owned() } else { path.join(folder) }, name, "new");
        }
        dir
    }

    #[test]
    fn a_killed_replacement_is_finished_by_the_next_run() {
        let removals = (0..=4).map(|removed| (COMPLETE, removed, 0));
        for (folder, removed, moved) in removals.chain((0..=4).map(|moved| (MOVING, 4, moved))) {
            let dir = interrupted(folder, removed, moved);
            let path = dir.path();
            // A reader sees the new results already.
            assert_eq!(fs::read_to_string(current(path, Artifact::TrajectoryCsv)).unwrap(), "new");
            recover(path).unwrap();
            for name in FILES {
                assert_eq!(fs::read_to_string(path.join(name)).unwrap(), "new", "{folder} {removed} {moved}");
            }
            for name in ["notes.txt", "plot.png"] {
                assert_eq!(fs::read_to_string(path.join(name)).unwrap(), "mine");
            }
            assert_eq!(fs::read_dir(path).unwrap().count(), 7, "{folder} {removed} {moved}");
            assert_eq!(fs::read_dir(path.join("vtk")).unwrap().count(), 1, "{folder} {removed} {moved}");
        }
    }

    #[test]
    fn without_an_interruption_nothing_is_touched() {
        let dir = tempfile::tempdir().unwrap();
        write(dir.path(), "summary.json", "old");
        write(dir.path(), ".flexion-new/summary.json", "half");
        recover(dir.path()).unwrap();
        assert_eq!(fs::read_to_string(current(dir.path(), Artifact::Summary)).unwrap(), "old");
    }
}
