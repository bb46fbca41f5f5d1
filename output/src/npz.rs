//! `trajectory.npz`: the columns as NumPy arrays.

use std::io::{self, Seek, Write};

use npyz::WriterBuilder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use super::arrays::{Arrays, Numbers};
use super::{Trajectory, archive};

/// Writes a trajectory as a NumPy archive (NEP 1): one array of f64, shape (rows,), for each column,
/// named `time` \[s\] and then by the channel, e.g. `numpy.load(path)["tip.deflection"]`.
///
/// The entries are stored without compression and carry no date: the same trajectory gives the same bytes.
///
/// # Errors
/// Whatever `to` returns; two channels of one name.
pub fn write_npz(trajectory: &Trajectory, to: impl Write + Seek) -> io::Result<()> {
    let mut archive = archive::archive(to);
    write_array(&mut archive, "time", trajectory.len(), trajectory.times().iter().copied())?;
    for (i, c) in trajectory.channels().iter().enumerate() {
        write_array(&mut archive, &c.name, trajectory.len(), trajectory.values(i))?;
    }
    archive::finish(archive)
}

/// Writes one array of the archive, of one dimension.
pub(super) fn write_array<T: npyz::AutoSerialize, W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    name: &str,
    len: usize,
    values: impl Iterator<Item = T>,
) -> io::Result<()> {
    write_shaped(archive, name, &[len as u64], values)
}

impl<W: Write + Seek> Arrays for ZipWriter<W> {
    fn put(&mut self, name: &str, shape: &[u64], numbers: Numbers<'_>) -> io::Result<()> {
        match numbers {
            Numbers::Single(values) => write_shaped(self, name, shape, values.iter().copied()),
            Numbers::Double(values) => write_shaped(self, name, shape, values.iter().copied()),
        }
    }
}

/// Writes one array of several dimensions, the last of which runs fastest.
fn write_shaped<T: npyz::AutoSerialize, W: Write + Seek>(
    archive: &mut ZipWriter<W>,
    name: &str,
    shape: &[u64],
    values: impl Iterator<Item = T>,
) -> io::Result<()> {
    // The header of an array takes 128 bytes; beyond 4 GiB an entry needs the 64-bit format.
    let bytes = shape.iter().fold(size_of::<T>() as u64, |n, k| n.saturating_mul(*k)).saturating_add(128);
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644)
        .large_file(bytes >= u64::from(u32::MAX));
    archive.start_file(format!("{name}.npy"), options)?;
    let mut array = npyz::WriteOptions::<T>::new().default_dtype().shape(shape).writer(archive).begin_nd()?;
    array.extend(values)?;
    array.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::sample;
    use std::io::Cursor;

    fn bytes(t: &Trajectory) -> Vec<u8> {
        let mut out = Cursor::new(Vec::new());
        write_npz(t, &mut out).unwrap();
        out.into_inner()
    }

    fn array(archive: Vec<u8>, name: &str) -> (Vec<u64>, Vec<f64>) {
        let mut zip = zip::ZipArchive::new(Cursor::new(archive)).unwrap();
        let array = npyz::NpyFile::new(zip.by_name(&format!("{name}.npy")).unwrap()).unwrap();
        (array.shape().to_vec(), array.into_vec().unwrap())
    }

    #[test]
    fn arrays_read_back_under_their_names() {
        let t = sample();
        let zip = zip::ZipArchive::new(Cursor::new(bytes(&t))).unwrap();
        let mut names: Vec<String> = zip.file_names().map(|n| n.unwrap().into_owned()).collect();
        names.sort();
        assert_eq!(names, ["hub.speed.npy", "time.npy", "tip.deflection.npy"]);
        for (name, expected) in
            [("time", t.times().to_vec()), ("tip.deflection", t.column("tip.deflection").unwrap())]
        {
            assert_eq!(array(bytes(&t), name), (vec![5], expected));
        }
    }

    #[test]
    fn entries_carry_no_date() {
        let mut zip = zip::ZipArchive::new(Cursor::new(bytes(&sample()))).unwrap();
        for i in 0..zip.len() {
            let date = zip.by_index(i).unwrap().last_modified().unwrap();
            assert_eq!((date.year(), date.month(), date.day(), date.hour()), (1980, 1, 1, 0));
        }
    }

    #[test]
    fn an_empty_trajectory_gives_empty_arrays() {
        let t = Trajectory::new(sample().channels().to_vec());
        assert_eq!(array(bytes(&t), "hub.speed"), (vec![0], vec![]));
    }
}
