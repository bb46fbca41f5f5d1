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

/// Files being written.
pub(super) const NEW: &str = ".flexion-new";
/// Files that are whole, former ones still in place.
const COMPLETE: &str = ".flexion-complete";
/// Files being moved, former ones gone.
const MOVING: &str = ".flexion-moving";

/// Makes the new files the results.
pub(super) fn publish(path: &Path) -> io::Result<()> {
    fs::rename(path.join(NEW), path.join(COMPLETE))?;
    // Not every system can bring a folder to disk; the files are there anyway.
    let _ = File::open(path).and_then(|folder| folder.sync_all());
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
        let closes =
            |set: &&&[Artifact]| set.first().is_some_and(|a| complete.join(&*a.file_name()).exists());
        let own = Artifact::SETS.iter().find(closes).copied().unwrap_or(Artifact::RUN);
        let closing = own.first().map(|artifact| PathBuf::from(&*artifact.file_name()));
        for file in held(path, own)?.into_iter().rev() {
            if !complete.join(&file).exists() || closing.as_ref() == Some(&file) {
                fs::remove_file(path.join(file))?;
            }
        }
        // Only if nothing else is in it.
        let _ = fs::remove_dir(path.join(SHAPES));
        fs::rename(&complete, &moving)?;
    }
    if moving.is_dir() {
        for file in held(&moving, &Artifact::SETS.concat())? {
            let target = path.join(&file);
            target.parent().map_or(Ok(()), fs::create_dir_all)?;
            fs::rename(moving.join(&file), target)?;
        }
        fs::remove_dir_all(&moving)?;
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

/// The files of `set`, their tables and shapes that a folder holds, relative to it, the closing file last.
fn held(folder: &Path, set: &[Artifact]) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let shapes = folder.join(SHAPES);
    if set.contains(&Artifact::ShapeSeries) && shapes.is_dir() {
        for entry in fs::read_dir(shapes)? {
            let name = entry?.file_name();
            found
                .extend(name.to_str().is_some_and(Artifact::is_shape).then(|| Path::new(SHAPES).join(&name)));
        }
    }
    if set.contains(&Artifact::SectionTable) && folder.is_dir() {
        for entry in fs::read_dir(folder)? {
            let name = entry?.file_name();
            found.extend(name.to_str().is_some_and(Artifact::is_table).then(|| PathBuf::from(&name)));
        }
    }
    let names = set.iter().rev().map(|artifact| PathBuf::from(&*artifact.file_name()));
    found.extend(names.filter(|name| folder.join(name).is_file()));
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: [&str; 4] = ["vtk/frame_00000.vtu", "trajectory.csv", "case.resolved.toml", "summary.json"];
    /// What only the former results have, in the order of removal after their summary.
    const STALE: [&str; 3] = ["plot.svg", "beam.pvd", "vtk/frame_00001.vtu"];

    fn write(folder: &Path, name: &str, text: &str) {
        fs::create_dir_all(folder.join(name).parent().unwrap()).unwrap();
        fs::write(folder.join(name), text).unwrap();
    }

    /// Results whose replacement was killed after so many removals or moves, beside a file of the user.
    fn interrupted(folder: &str, removed: usize, moved: usize) -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path();
        write(path, "notes.txt", "mine");
        for (i, name) in ["summary.json"].iter().chain(&STALE).chain(&FILES[..3]).enumerate() {
            if i >= removed {
                write(path, name, "old");
            }
        }
        fs::create_dir(path.join(folder)).unwrap();
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
            assert_eq!(fs::read_to_string(path.join("notes.txt")).unwrap(), "mine");
            assert_eq!(fs::read_dir(path).unwrap().count(), 5, "{folder} {removed} {moved}");
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
