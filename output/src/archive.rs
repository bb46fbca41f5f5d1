//! Archives of arrays that report a failure once, by the error that is returned.
//!
//! The library for archives completes an archive that is dropped, and prints an error of that on standard error: on a
//! full disk, the same error again. Here what follows a failure is discarded, so that there is no second error.

use npyz::NpyFile;
use std::io::{self, Cursor, Read, Seek, SeekFrom, Write};
use zip::{ZipArchive, ZipWriter};

/// Largest array that is read [bytes].
const LARGEST: u64 = 1 << 32;
/// Bytes of an entry before its name.
const HEADER: usize = 30;

/// A writer that fails once, and discards what is written after that.
pub(super) struct Latched<W> {
    to: W,
    failed: bool,
    /// Place and end of what was written or discarded [bytes].
    place: u64,
    end: u64,
}

/// A new archive.
pub(super) fn archive<W: Write + Seek>(to: W) -> ZipWriter<Latched<W>> {
    ZipWriter::new(Latched { to, failed: false, place: 0, end: 0 })
}

/// Completes the archive.
///
/// # Errors
/// The error of the writer, or that it failed before.
pub(super) fn finish<W: Write + Seek>(archive: ZipWriter<Latched<W>>) -> io::Result<()> {
    let mut latched = archive.finish()?;
    if latched.failed {
        return Err(io::Error::other("the archive is incomplete"));
    }
    latched.flush()
}

/// Hands every array of a NumPy archive to `take`, with its name.
///
/// # Errors
/// What is wrong with the file, for people.
pub(super) fn arrays(
    mut from: impl Read + Seek,
    mut take: impl FnMut(&str, NpyFile<&[u8]>) -> io::Result<()>,
) -> Result<(), String> {
    let no_archive = |error: &dyn std::fmt::Display| format!("it is no NumPy archive ({error})");
    let mut whole = Vec::new();
    from.rewind().map_err(|error| no_archive(&error))?;
    from.take(LARGEST).read_to_end(&mut whole).map_err(|error| no_archive(&error))?;
    let mut archive = ZipArchive::new(Cursor::new(&whole)).map_err(|error| no_archive(&error))?;
    for i in 0..archive.len() {
        let entry = archive.by_index(i).map_err(|error| error.to_string())?;
        let file = entry.name().map_err(|error| error.to_string())?.into_owned();
        let Some(name) = file.strip_suffix(".npy") else {
            return Err(format!("it holds `{file}`, which is no array"));
        };
        let broken = |error: &dyn std::fmt::Display| format!("its array `{name}` cannot be read ({error})");
        if entry.size() > LARGEST {
            return Err(broken(&"it is too large"));
        }
        // The name stands before the array too, and no checksum guards it.
        let begin = usize::try_from(entry.header_start()).unwrap_or(usize::MAX).saturating_add(HEADER);
        if whole.get(begin..begin.saturating_add(file.len())) != Some(file.as_bytes()) {
            return Err(broken(&"it has two names"));
        }
        // To its end, where its checksum is compared: an array ends before it.
        let mut bytes = Vec::new();
        entry.take(LARGEST).read_to_end(&mut bytes).map_err(|error| broken(&error))?;
        let size = bytes.len() as u64;
        let array = NpyFile::new(bytes.as_slice()).map_err(|error| broken(&error))?;
        let width = match array.dtype() {
            npyz::DType::Plain(plain) => plain.num_bytes().unwrap_or(1) as u64,
            _ => 1,
        };
        if array.shape().iter().try_fold(width, |n: u64, k| n.checked_mul(*k)).is_none_or(|n| n > size) {
            return Err(broken(&"it is cut short"));
        }
        take(name, array).map_err(|error| broken(&error))?;
    }
    Ok(())
}

impl<W> Latched<W> {
    fn attempt<T>(&mut self, discarded: T, act: impl FnOnce(&mut W) -> io::Result<T>) -> io::Result<T> {
        if self.failed {
            return Ok(discarded);
        }
        let result = act(&mut self.to);
        self.failed = matches!(&result, Err(error) if error.kind() != io::ErrorKind::Interrupted);
        result
    }
}

impl<W: Write> Write for Latched<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = self.attempt(bytes.len(), |to| to.write(bytes))?;
        self.place += count as u64;
        self.end = self.end.max(self.place);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.attempt((), W::flush)
    }
}

impl<W: Seek> Seek for Latched<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let discarded = match to {
            SeekFrom::Start(place) => place,
            SeekFrom::Current(by) => self.place.saturating_add_signed(by),
            SeekFrom::End(by) => self.end.saturating_add_signed(by),
        };
        self.place = self.attempt(discarded, |inner| inner.seek(to))?;
        Ok(self.place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::npz::write_array;
    use std::cell::Cell;

    /// A disk of limited capacity, which counts the writes it refuses.
    struct Disk<'a> {
        file: Cursor<Vec<u8>>,
        capacity: u64,
        refusals: &'a Cell<usize>,
    }

    impl Write for Disk<'_> {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.file.position() + bytes.len() as u64 > self.capacity {
                self.refusals.set(self.refusals.get() + 1);
                return Err(io::ErrorKind::StorageFull.into());
            }
            self.file.write(bytes)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    impl Seek for Disk<'_> {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.file.seek(to)
        }
    }

    #[test]
    fn a_disk_that_is_full_at_any_byte_is_reported_once() {
        let attempt = |capacity| {
            let refusals = Cell::new(0);
            let mut zip = archive(Disk { file: Cursor::new(Vec::new()), capacity, refusals: &refusals });
            let outcome = ["a", "b"]
                .iter()
                .try_for_each(|name| write_array(&mut zip, name, 30, (0..30).map(f64::from)));
            let outcome = match outcome {
                Ok(()) => finish(zip),
                Err(error) => {
                    drop(zip);
                    Err(error)
                }
            };
            (outcome, refusals.get())
        };
        let whole = (0..4000).find(|capacity| attempt(*capacity).0.is_ok()).unwrap();
        assert!(whole > 2 * 30 * 8, "{whole}");
        for capacity in 0..whole {
            let (outcome, refusals) = attempt(capacity);
            assert_eq!(
                (outcome.unwrap_err().kind(), refusals),
                (io::ErrorKind::StorageFull, 1),
                "{capacity}"
            );
        }
    }
}
