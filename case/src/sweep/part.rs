//! The parts of a sweep: files of rows that follow one another, named by what they hold.

use super::row::Row;
use super::{Chunk, Sweep, SweepError, parquet_file, table};
use flexion_results::VERSION;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// The parts of a sweep in a folder.
pub(super) struct Parts<'a> {
    sweep: &'a Sweep,
    folder: &'a Path,
    /// The name of the sweep.
    name: String,
    /// Rows of a part.
    rows: usize,
}

/// What tells apart the files that are being written, by all threads of all processes.
pub(super) fn own() -> String {
    static WRITTEN: AtomicUsize = AtomicUsize::new(0);
    format!("{}-{}", std::process::id(), WRITTEN.fetch_add(1, Ordering::Relaxed))
}

/// Ending of a part, and of one that is being written.
const ENDING: &str = ".parquet";
const NEW: &str = ".new";

impl<'a> Parts<'a> {
    pub(super) fn new(sweep: &'a Sweep, folder: &'a Path, name: String) -> Parts<'a> {
        Parts { sweep, folder, name, rows: sweep.part() }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.sweep.parts()
    }

    /// The rows of a part.
    pub(super) fn chunk(&self, number: usize) -> Chunk {
        let first = number * self.rows;
        Chunk { first, count: self.rows.min(self.sweep.rows - first.min(self.sweep.rows)) }
    }

    /// The name of a part: that of the sweep, and its first and last row.
    fn file_name(&self, number: usize) -> String {
        let Chunk { first, count } = self.chunk(number);
        format!("part-{}-{first:08}-{:08}{ENDING}", self.name, first + count - 1)
    }

    /// Whether a file of this name may be a part of some sweep.
    pub(super) fn is_any(name: &str) -> bool {
        name.starts_with("part-") && name.ends_with(ENDING)
    }

    /// Whether a file of this name is a part of another sweep.
    pub(super) fn is_foreign(&self, name: &str) -> bool {
        Parts::is_any(name) && !name.starts_with(&format!("part-{}-", self.name))
    }

    fn path(&self, number: usize) -> PathBuf {
        self.folder.join(self.file_name(number))
    }

    /// The rows of a part that is whole; `None` of one that is torn, which is computed again, or not there.
    pub(super) fn read(&self, number: usize) -> Option<Vec<Row>> {
        let file = File::open(self.path(number)).ok()?;
        let (names, data): (Vec<String>, Vec<_>) = parquet_file::read(file).ok()?.into_iter().unzip();
        let wanted = table::columns(self.sweep, &[]);
        if names.len() != wanted.len() || names.iter().zip(&wanted).any(|(name, (other, _))| name != other) {
            return None;
        }
        let Chunk { first, count } = self.chunk(number);
        let rows = table::rows(self.sweep, data)?;
        let follow = rows.iter().enumerate().all(|(i, row)| row.number == first + i);
        (rows.len() == count && follow).then_some(rows)
    }

    /// Whether a part is there, whole or not.
    pub(super) fn is_there(&self, number: usize) -> bool {
        self.path(number).is_file()
    }

    /// Writes a part whole, under another name first: whoever reads it finds all of it or nothing.
    ///
    /// # Errors
    /// [`SweepError::Io`].
    pub(super) fn write(&self, number: usize, rows: &[Row]) -> Result<(), SweepError> {
        let (path, new) = (self.path(number), self.new_name(number));
        let written = File::create(&new).and_then(|file| {
            let by = format!("flexion version {VERSION}");
            parquet_file::write(&table::columns(self.sweep, rows), &by, file).map_err(std::io::Error::other)
        });
        let renamed = written.and_then(|()| fs::rename(&new, &path));
        renamed.or_else(|source| {
            let _ = fs::remove_file(&new);
            // Another process has written the same part, and tidied up.
            let done = source.kind() == std::io::ErrorKind::NotFound && self.read(number).is_some();
            if done { Ok(()) } else { Err(SweepError::Io { what: "write", path, source }) }
        })
    }

    /// A name that nobody else writes to.
    fn new_name(&self, number: usize) -> PathBuf {
        self.folder.join(format!(".{}-{}{NEW}", self.file_name(number), own()))
    }

    /// Takes away what processes left that were ended as they wrote parts that are there by now.
    pub(super) fn tidy(&self) {
        let names = fs::read_dir(self.folder).into_iter().flatten();
        let names = names.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        names.filter(|name| self.is_left(name)).for_each(|name| {
            let _ = fs::remove_file(self.folder.join(name));
        });
    }

    fn is_left(&self, name: &str) -> bool {
        let of = name.strip_prefix('.').and_then(|name| name.strip_suffix(NEW));
        let part = of.and_then(|name| name.split_once(ENDING)).map(|(part, _)| format!("{part}{ENDING}"));
        part.is_some_and(|part| Parts::is_any(&part) && self.folder.join(part).is_file())
    }
}
