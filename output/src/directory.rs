//! The directory of results: all files appear together, when they are whole.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use super::OutputError;
#[cfg(feature = "archives")]
use super::archive;
use super::arrays::Arrays;
use super::artifact::Artifact;
use super::file::write_whole;
use super::refusal::{refuse_contents, refuse_foreign, refuse_inputs, refuse_others};
use super::staging::{self, NEW};
use super::written::{LIST, Written};

/// A directory known to be writable that results of one kind will fill.
///
/// Files are written into a hidden folder of it, and moved to their names by [`Directory::publish`] when all of
/// them are whole: former results stay as they are until then, whatever ends the run. A directory is complete
/// if and only if it holds its closing file (`summary.json`, `compare.json`, `modes.json`, `campbell.json` or `statics.json`),
/// which is moved last and removed first. The next run finishes a move that was interrupted, and removes what an
/// interrupted run had begun to write.
///
/// After a loss of power that holds for former results, which go only when the new files are on the disk; a first run into
/// a directory may then have to be repeated.
///
/// A hidden list says which files the program wrote. Only these are ever replaced or removed.
///
/// As long as the value lives no other run can take the same directory, where the file system has locks.
#[derive(Debug)]
pub struct Directory {
    path: PathBuf,
    own: &'static [Artifact],
    /// Whether there are former results.
    replaces: bool,
    /// Whether it was not there before.
    made: bool,
    /// Holds the lock.
    _lock: Option<File>,
    /// The files, of a directory in memory.
    memory: Option<Mutex<BTreeMap<String, Vec<u8>>>>,
}

/// Where the bytes of a file go.
pub trait Sink: io::Write + io::Seek {}

impl<W: io::Write + io::Seek> Sink for W {}

impl Directory {
    /// [`Directory::create_for`] a run that reads no files.
    ///
    /// # Errors
    /// Those of [`Directory::create_for`].
    pub fn create(path: impl AsRef<Path>, force: bool) -> Result<Directory, OutputError> {
        Directory::create_for(Artifact::RUN, path, force, &[])
    }

    /// Makes the directory of one kind of results, e.g. [`Artifact::MODES`], with its parents, or takes an empty
    /// one, and checks that it can be written to: call it before a long run. With `force` a directory that is not
    /// empty is taken too; former files of this kind that the program wrote will be replaced in the end, and other files are
    /// left alone. `inputs` are the files that the results are computed from.
    ///
    /// # Errors
    /// [`OutputError::NotADirectory`], [`OutputError::HoldsResults`], [`OutputError::NotEmpty`] and
    /// [`OutputError::Busy`] as their names say; [`OutputError::Foreign`] and [`OutputError::Input`] where a file has the name
    /// of a result and is none, or is one of the inputs; [`OutputError::Io`] when the system refuses.
    pub fn create_for(
        own: &'static [Artifact],
        path: impl AsRef<Path>,
        force: bool,
        inputs: &[PathBuf],
    ) -> Result<Directory, OutputError> {
        Directory::take(own, path.as_ref(), |path, taken| {
            if !force {
                refuse_contents(path)?;
            }
            refuse_inputs(path, taken, inputs)
        })
    }

    /// [`Directory::create_for`] results that are renewed without being asked: those that the program wrote are taken without
    /// `force`, and so is the folder called `beside`, where a caller keeps what is no result. With `force` other files are left alone.
    ///
    /// # Errors
    /// [`OutputError::Unlisted`] where nothing says that the program wrote the results that are there, and those of
    /// [`Directory::create_for`].
    pub fn renew(
        own: &'static [Artifact],
        path: impl AsRef<Path>,
        force: bool,
        beside: &str,
    ) -> Result<Directory, OutputError> {
        Directory::take(own, path.as_ref(), |path, taken| {
            let written = Written::read(path);
            let closing = own.first().map_or(Cow::Borrowed(""), |artifact| artifact.file_name());
            if taken.contains(&&*closing) && !written.holds(&closing) {
                return Err(OutputError::Unlisted { path: path.to_path_buf(), file: closing.into_owned() });
            }
            let ours = |name: &str| {
                name == NEW
                    || name == LIST
                    || (name == beside && path.join(name).is_dir())
                    || written.of(&closing).any(|own| own == name)
            };
            if force { Ok(()) } else { refuse_others(path, ours) }
        })
    }

    /// Makes and locks a directory of one kind of results, where `judge` does not refuse what is in it: the directory, and the names in it
    /// that such results may have.
    fn take(
        own: &'static [Artifact],
        path: &Path,
        judge: impl FnOnce(&Path, &[&str]) -> Result<(), OutputError>,
    ) -> Result<Directory, OutputError> {
        let path = path.to_path_buf();
        if path.exists() && !path.is_dir() {
            return Err(OutputError::NotADirectory { path });
        }
        let made = !path.exists();
        fs::create_dir_all(&path).map_err(OutputError::io("make the directory", &path))?;
        let lock = lock(&path)?;
        staging::recover(&path).map_err(OutputError::io("finish the interrupted replacement in", &path))?;
        let there = staging::names(&path).map_err(OutputError::io("read the directory", &path))?;
        let taken: Vec<&str> =
            there.iter().map(String::as_str).filter(|name| Artifact::may_be_of(own, name)).collect();
        judge(&path, &taken)?;
        refuse_foreign(&path, &taken)?;
        staging::clear(&path).and_then(|()| probe(&path)).map_err(OutputError::io("write to", &path))?;
        let replaces = own.iter().any(|artifact| path.join(&*artifact.file_name()).exists());
        Ok(Directory { path, own, replaces, made, _lock: lock, memory: None })
    }

    /// A directory of one kind of results that is in memory, for where there are no files.
    pub fn in_memory(own: &'static [Artifact]) -> Directory {
        let memory = Some(Mutex::default());
        Directory { path: PathBuf::new(), own, replaces: false, made: false, _lock: None, memory }
    }

    /// The files of a directory in memory, by their names.
    pub fn into_files(self) -> BTreeMap<String, Vec<u8>> {
        let files = self.memory.map(|files| files.into_inner().unwrap_or_else(PoisonError::into_inner));
        files.unwrap_or_default()
    }

    /// Where it is, as it was asked for.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Path of one of its files when it is published, written or not.
    pub fn file(&self, artifact: Artifact) -> PathBuf {
        self.path.join(&*artifact.file_name())
    }

    /// Writes one file whole, not yet under its name: [`Directory::publish`] moves it there. When anything
    /// fails nothing is left of it.
    ///
    /// # Errors
    /// [`OutputError::Io`] with the system's reason.
    pub fn write(
        &self,
        artifact: Artifact,
        fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        self.write_named(&artifact.file_name(), fill)
    }

    /// Writes one file whose name is none of a fixed list, e.g. `P1_F4_curves.csv` of a report, as [`Directory::write`] does.
    ///
    /// # Errors
    /// [`OutputError::Io`] with the system's reason.
    pub fn write_named(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Sink) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        if let Some(files) = &self.memory {
            let mut bytes = io::Cursor::new(Vec::new());
            fill(&mut bytes).map_err(OutputError::io("write", &self.path.join(name)))?;
            let mut files = files.lock().unwrap_or_else(PoisonError::into_inner);
            files.insert(name.to_owned(), bytes.into_inner());
            return Ok(());
        }
        let staged = self.path.join(NEW).join(name);
        let attempt = || {
            // A directory that has gone is not made again: its owner removed it.
            fs::metadata(&self.path)?;
            staged.parent().map_or(Ok(()), fs::create_dir_all)?;
            let mut file = File::create(&staged)?;
            let mut buffered = BufWriter::new(&mut file);
            let written = fill(&mut buffered).and_then(|()| buffered.flush());
            // Without this the buffer would try to write once more when it is dropped.
            drop(buffered.into_parts());
            // A new run has nothing to lose but itself: only where it replaces another is the disk waited for.
            written.and_then(|()| if self.replaces { file.sync_all() } else { Ok(()) })
        };
        attempt().map_err(|error| {
            let _ = fs::remove_file(&staged);
            OutputError::io("write", &self.path.join(name))(error)
        })
    }

    /// Writes an archive of arrays, as [`Directory::write`] does; nothing in a build without archives.
    ///
    /// # Errors
    /// [`OutputError::Io`] with the system's reason.
    #[cfg(feature = "archives")]
    pub fn write_arrays(
        &self,
        artifact: Artifact,
        put: impl FnOnce(&mut dyn Arrays) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        self.write(artifact, |f| {
            let mut archive = archive::archive(f);
            put(&mut archive)?;
            archive::finish(archive)
        })
    }

    /// Writes nothing: this build has no archives.
    ///
    /// # Errors
    /// None.
    #[cfg(not(feature = "archives"))]
    pub fn write_arrays(
        &self,
        _: Artifact,
        _: impl FnOnce(&mut dyn Arrays) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        Ok(())
    }

    /// Brings all that was written under its names, in place of former results.
    ///
    /// # Errors
    /// [`OutputError::Io`] with the system's reason; the next run into this directory finishes the work.
    /// [`OutputError::Foreign`] where a file has come meanwhile that has the name of a result.
    pub fn publish(&self) -> Result<(), OutputError> {
        if self.memory.is_some() {
            return Ok(());
        }
        self.refuse_what_came()?;
        let published = staging::publish(&self.path, &self.closing());
        published.map_err(OutputError::io("move the results into", &self.path))
    }

    /// Name of the closing file.
    fn closing(&self) -> Cow<'static, str> {
        self.own.first().map_or(Cow::Borrowed(""), |artifact| artifact.file_name())
    }

    /// Refuses to replace files that have come since the directory was made.
    fn refuse_what_came(&self) -> Result<(), OutputError> {
        let new = staging::names(&self.path.join(NEW));
        let new = new.map_err(OutputError::io("read the directory", &self.path))?;
        let there: Vec<&str> =
            new.iter().map(String::as_str).filter(|name| self.path.join(name).exists()).collect();
        refuse_foreign(&self.path, &there)
    }

    /// Saves what was written whole before something failed, and says where it is: under its names, without
    /// the closing file, if there are no former results, or else in a folder beside them that the next run
    /// removes. `None` when no trajectory was written.
    pub fn salvage(&self) -> Option<PathBuf> {
        let staged = self.path.join(NEW);
        let trajectories = [Artifact::TrajectoryNpz, Artifact::TrajectoryCsv];
        if !trajectories.iter().any(|artifact| staged.join(&*artifact.file_name()).exists()) {
            self.discard();
            return None;
        }
        let free = !self.replaces && self.refuse_what_came().is_ok();
        if free && staging::place(&self.path, &self.closing()).is_ok() {
            Some(self.path.clone())
        } else {
            Some(staged)
        }
    }

    /// Removes what was written and not published, and the directory if it was made for that and is empty.
    pub fn discard(&self) {
        let _ = staging::clear(&self.path);
        if self.made {
            let _ = fs::remove_dir(&self.path);
        }
    }
}

/// Writes and removes a small file: permissions, read-only and full disks show only so.
fn probe(path: &Path) -> io::Result<()> {
    let folder = path.join(NEW);
    fs::create_dir(&folder)?;
    let written = write_whole(&folder.join("probe"), &[0; 4096]);
    written.and(staging::clear(path))
}

/// Takes the lock of the directory; a file system without locks gives none.
fn lock(path: &Path) -> Result<Option<File>, OutputError> {
    // Only on Unix can a directory be opened as a file.
    let Ok(file) = File::open(path) else { return Ok(None) };
    match file.try_lock() {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Err(OutputError::Busy { path: path.to_path_buf() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::written::unsealed;

    /// What is in a folder but the list of what the program wrote.
    fn names(path: &Path) -> Vec<String> {
        let all = fs::read_dir(path).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = all.filter(|name| name != LIST).collect();
        names.sort();
        names
    }

    /// A directory of former results with a file of the user.
    fn former() -> tempfile::TempDir {
        let dir = tempfile::tempdir().unwrap();
        fs::create_dir(dir.path().join("vtk")).unwrap();
        let mut names = Vec::new();
        for a in Artifact::RUN.iter().copied().chain((0..3).map(Artifact::Shape)) {
            fs::write(dir.path().join(&*a.file_name()), "old").unwrap();
            names.push(a.file_name());
        }
        Written::default().with("summary.json", unsealed(names)).write(dir.path()).unwrap();
        fs::write(dir.path().join("notes.txt"), "mine").unwrap();
        dir
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
    fn results_and_other_files_are_refused_without_force() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("notes.txt"), "mine").unwrap();
        let e = Directory::create(dir.path(), false).unwrap_err();
        assert!(matches!(&e, OutputError::NotEmpty { found, .. } if found == "notes.txt"), "{e}");
        fs::write(dir.path().join("summary.json"), "{}").unwrap();
        for refused in [
            Directory::create(dir.path(), false),
            Directory::create_for(Artifact::COMPARISON, dir.path(), false, &[]),
        ] {
            let e = refused.unwrap_err();
            assert!(matches!(e, OutputError::HoldsResults { .. }), "{e}");
            assert!(e.to_string().contains("--force"));
        }
    }

    #[test]
    fn former_results_stay_until_the_new_ones_are_published() {
        let dir = former();
        let before = names(dir.path());
        let out = Directory::create(dir.path(), true).unwrap();
        assert_eq!(names(dir.path()), before);
        out.write(Artifact::Summary, |f| f.write_all(b"new")).unwrap();
        out.write(Artifact::Shape(1), |f| f.write_all(b"new")).unwrap();
        assert_eq!(fs::read_to_string(out.file(Artifact::Summary)).unwrap(), "old");
        assert_eq!(fs::read_to_string(out.file(Artifact::Shape(1))).unwrap(), "old");
        out.publish().unwrap();
        assert_eq!(names(dir.path()), ["notes.txt", "summary.json", "vtk"]);
        assert_eq!(names(&dir.path().join("vtk")), ["frame_00001.vtu"]);
        assert_eq!(fs::read_to_string(out.file(Artifact::Summary)).unwrap(), "new");
        assert_eq!(fs::read_to_string(out.file(Artifact::Shape(1))).unwrap(), "new");
    }

    #[test]
    fn files_with_the_names_of_results_that_no_run_wrote_are_left_alone() {
        for name in ["plot.svg", "beam.pvd", "table99.csv", "vtk/frame_00007.vtu", "case.resolved.toml"] {
            for dir in [tempfile::tempdir().unwrap(), former()] {
                fs::create_dir_all(dir.path().join("vtk")).unwrap();
                // Whatever the list says of the other files.
                let names =
                    Written::read(dir.path()).of("summary.json").map(str::to_owned).collect::<Vec<_>>();
                let others = names.into_iter().filter(|other| other != name);
                Written::default().with("summary.json", unsealed(others)).write(dir.path()).unwrap();
                fs::write(dir.path().join(name), "mine").unwrap();
                let before = names_within(dir.path());
                let e = Directory::create(dir.path(), true).unwrap_err();
                assert!(matches!(&e, OutputError::Foreign { path } if path.ends_with(name)), "{e}");
                assert_eq!(names_within(dir.path()), before);
            }
        }
        // A name that results of another kind have is free.
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("modes.csv"), "mine").unwrap();
        let out = Directory::create(dir.path(), true).unwrap();
        out.write(Artifact::Summary, |f| f.write_all(b"{}")).unwrap();
        // One that comes during the run is left alone too, and the results are kept.
        out.write(Artifact::TrajectoryCsv, |f| f.write_all(b"new")).unwrap();
        fs::write(dir.path().join("trajectory.csv"), "mine").unwrap();
        let e = out.publish().unwrap_err();
        assert!(matches!(&e, OutputError::Foreign { path } if path.ends_with("trajectory.csv")), "{e}");
        let saved = out.salvage().unwrap();
        assert_eq!(fs::read_to_string(saved.join("trajectory.csv")).unwrap(), "new");
        assert_eq!(fs::read_to_string(dir.path().join("trajectory.csv")).unwrap(), "mine");
    }

    fn names_within(path: &Path) -> Vec<String> {
        staging::names(path).unwrap()
    }

    #[test]
    fn what_a_run_reads_is_never_replaced_even_if_a_run_wrote_it() {
        let dir = former();
        let inputs = |name: &str| [dir.path().join("vtk/..").join(name)];
        for name in ["state.npz", "case.resolved.toml", "section.csv"] {
            let e = Directory::create_for(Artifact::RUN, dir.path(), true, &inputs(name)).unwrap_err();
            assert!(matches!(&e, OutputError::Input { path } if path.ends_with(name)), "{e}");
        }
        drop(Directory::create_for(Artifact::RUN, dir.path(), true, &inputs("notes.txt")).unwrap());
        drop(Directory::create_for(Artifact::COMPARISON, dir.path(), true, &inputs("state.npz")).unwrap());
    }

    #[test]
    fn a_comparison_replaces_no_file_of_a_run() {
        let dir = former();
        let out = Directory::create_for(Artifact::COMPARISON, dir.path(), true, &[]).unwrap();
        out.write(Artifact::CompareJson, |f| f.write_all(b"{}")).unwrap();
        out.publish().unwrap();
        assert_eq!(names(dir.path()).len(), Artifact::RUN.len() + 3);
        assert_eq!(fs::read_to_string(out.file(Artifact::Summary)).unwrap(), "old");
    }

    #[test]
    fn the_next_run_removes_only_what_a_killed_one_had_begun() {
        let dir = former();
        let killed = Directory::create(dir.path(), true).unwrap();
        killed.write(Artifact::TrajectoryCsv, |f| f.write_all(b"half")).unwrap();
        drop(killed);
        let next = Directory::create(dir.path(), true).unwrap();
        assert!(!dir.path().join(NEW).exists());
        assert_eq!(fs::read_to_string(next.file(Artifact::TrajectoryCsv)).unwrap(), "old");
        // A leftover alone does not make a directory that is not empty.
        let fresh = tempfile::tempdir().unwrap();
        fs::create_dir(fresh.path().join(NEW)).unwrap();
        fs::write(fresh.path().join(NEW).join("trajectory.csv"), "half").unwrap();
        drop(Directory::create(fresh.path(), false).unwrap());
        assert_eq!(names(fresh.path()), Vec::<String>::new());
    }

    #[test]
    fn a_failed_write_leaves_nothing_of_the_file() {
        let dir = tempfile::tempdir().unwrap();
        let out = Directory::create(dir.path(), false).unwrap();
        let full = || io::Error::from(io::ErrorKind::StorageFull);
        let e = out.write(Artifact::TrajectoryCsv, |f| f.write_all(b"half a li").and(Err(full())));
        let e = e.unwrap_err().to_string();
        assert!(e.contains("trajectory.csv") && e.contains("make room"), "{e}");
        assert_eq!(out.salvage(), None);
        assert_eq!(names(dir.path()), Vec::<String>::new());
    }

    #[test]
    fn files_written_before_a_failure_are_saved() {
        let dir = tempfile::tempdir().unwrap();
        let out = Directory::create(dir.path(), false).unwrap();
        out.write(Artifact::TrajectoryCsv, |f| f.write_all(b"whole")).unwrap();
        assert_eq!(out.salvage().as_deref(), Some(dir.path()));
        assert_eq!(names(dir.path()), ["trajectory.csv"]);
        // Beside former results it goes into a folder of its own.
        let dir = former();
        let out = Directory::create(dir.path(), true).unwrap();
        out.write(Artifact::TrajectoryCsv, |f| f.write_all(b"whole")).unwrap();
        let saved = out.salvage().unwrap();
        assert_eq!(fs::read_to_string(saved.join("trajectory.csv")).unwrap(), "whole");
        assert_eq!(fs::read_to_string(out.file(Artifact::TrajectoryCsv)).unwrap(), "old");
    }

    #[test]
    fn a_directory_removed_during_the_run_is_an_error() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("gone");
        let out = Directory::create(&path, false).unwrap();
        fs::remove_dir(&path).unwrap();
        let e = out.write(Artifact::Summary, |_| Ok(())).unwrap_err().to_string();
        assert!(e.contains("gone") && e.contains("removed during the run"), "{e}");
    }

    #[cfg(unix)]
    #[test]
    fn a_directory_is_filled_by_one_run_at_a_time() {
        let dir = tempfile::tempdir().unwrap();
        let first = Directory::create(dir.path(), false).unwrap();
        let e = Directory::create(dir.path(), true).unwrap_err();
        assert!(matches!(e, OutputError::Busy { .. }), "{e}");
        drop(first);
        Directory::create(dir.path(), true).unwrap();
    }

    /// Of what was never published nothing is left: no directory that was not there, and one that was as it was.
    #[test]
    fn what_is_discarded_leaves_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        for (name, was_there) in [("new", false), ("old", true)] {
            let path = folder.path().join(name);
            if was_there {
                fs::create_dir(&path).unwrap();
            }
            let directory = Directory::create(&path, false).unwrap();
            directory.write(Artifact::TrajectoryCsv, |file| file.write_all(b"t")).unwrap();
            directory.discard();
            assert_eq!(path.exists(), was_there);
            assert!(!was_there || fs::read_dir(&path).unwrap().next().is_none());
        }
    }

    /// Of a report only the files of a former one are replaced; all else is left alone, or refused.
    #[test]
    fn a_report_is_renewed_and_nothing_else_is() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path();
        let put = |names: &[&str]| {
            let out = Directory::renew(Artifact::REPORT, path, false, "kept").unwrap();
            names.iter().for_each(|name| out.write_named(name, |f| f.write_all(b"new")).unwrap());
            out.publish().unwrap();
        };
        fs::create_dir(path.join("kept")).unwrap();
        put(&["claims.csv", "P1_F4_curves.csv", "report.html"]);
        put(&["claims.csv", "P2_T1_table.csv", "report.html"]);
        assert_eq!(names(path), ["P2_T1_table.csv", "claims.csv", "kept", "report.html"]);
        let renew = |force| Directory::renew(Artifact::REPORT, path, force, "kept");
        fs::write(path.join("notes.txt"), "mine").unwrap();
        let e = renew(false).unwrap_err();
        assert!(matches!(&e, OutputError::NotEmpty { found, .. } if found == "notes.txt"), "{e}");
        drop(renew(true).unwrap());
        // Another's file with the name of a table is not replaced, and a report that no list has is said to be one.
        fs::write(path.join("P3_F1_curves.csv"), "mine").unwrap();
        let e = renew(true).unwrap_err();
        assert!(matches!(&e, OutputError::Foreign { path } if path.ends_with("P3_F1_curves.csv")), "{e}");
        fs::remove_file(path.join(LIST)).unwrap();
        for force in [false, true] {
            let e = renew(force).unwrap_err();
            assert!(matches!(&e, OutputError::Unlisted { file, .. } if file == "report.html"), "{e}");
        }
        assert_eq!(fs::read_to_string(path.join("P3_F1_curves.csv")).unwrap(), "mine");
    }
}
