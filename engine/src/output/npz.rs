//! `trajectory.npz`: the columns as NumPy arrays.

use std::io::{self, Seek, Write};

use npyz::WriterBuilder;
use npyz::npz::NpzWriter;
use npyz::zip::{CompressionMethod, DateTime, write::FileOptions};

use super::Trajectory;

/// Writes a trajectory as a NumPy archive (NEP 1): one array of f64, shape (rows,), for each column,
/// named `time` [s] and then by the channel, e.g. `numpy.load(path)["tip.deflection"]`.
///
/// The entries are stored without compression and carry no date: the same trajectory gives the same bytes.
///
/// # Errors
/// Whatever `to` returns; two channels of one name.
pub fn write_npz(trajectory: &Trajectory, to: impl Write + Seek) -> io::Result<()> {
    let mut npz = NpzWriter::new(to);
    write_array(&mut npz, "time", trajectory.len(), trajectory.times().iter().copied())?;
    for (i, c) in trajectory.channels().iter().enumerate() {
        write_array(&mut npz, &c.name, trajectory.len(), trajectory.values(i))?;
    }
    npz.zip_writer().finish().map_err(io::Error::other)?.flush()
}

fn write_array<W: Write + Seek>(
    npz: &mut NpzWriter<W>,
    name: &str,
    len: usize,
    values: impl Iterator<Item = f64>,
) -> io::Result<()> {
    // The header of an array takes 128 bytes; beyond 4 GiB an entry needs the 64-bit format.
    let bytes = (len as u64).saturating_mul(8).saturating_add(128);
    let options = FileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default())
        .unix_permissions(0o644)
        .large_file(bytes >= u64::from(u32::MAX));
    let mut array = npz.array::<f64>(name, options)?.default_dtype().shape(&[len as u64]).begin_nd()?;
    array.extend(values)?;
    array.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::trajectory::tests::sample;
    use std::io::Cursor;

    fn bytes(t: &Trajectory) -> Vec<u8> {
        let mut out = Cursor::new(Vec::new());
        write_npz(t, &mut out).unwrap();
        out.into_inner()
    }

    #[test]
    fn arrays_read_back_under_their_names() {
        let t = sample();
        let mut npz = npyz::npz::NpzArchive::new(Cursor::new(bytes(&t))).unwrap();
        let mut names: Vec<String> = npz.array_names().map(String::from).collect();
        names.sort();
        assert_eq!(names, ["hub.speed", "time", "tip.deflection"]);
        for (name, expected) in
            [("time", t.times().to_vec()), ("tip.deflection", t.column("tip.deflection").unwrap())]
        {
            let array = npz.by_name(name).unwrap().unwrap();
            assert_eq!(array.shape(), [5]);
            assert_eq!(array.into_vec::<f64>().unwrap(), expected);
        }
    }

    #[test]
    fn entries_carry_no_date() {
        let mut zip = npyz::zip::ZipArchive::new(Cursor::new(bytes(&sample()))).unwrap();
        for i in 0..zip.len() {
            let date = zip.by_index(i).unwrap().last_modified();
            assert_eq!((date.year(), date.month(), date.day(), date.hour()), (1980, 1, 1, 0));
        }
    }

    #[test]
    fn an_empty_trajectory_gives_empty_arrays() {
        let t = Trajectory::new(sample().channels().to_vec());
        let mut npz = npyz::npz::NpzArchive::new(Cursor::new(bytes(&t))).unwrap();
        assert_eq!(npz.by_name("hub.speed").unwrap().unwrap().into_vec::<f64>().unwrap(), Vec::<f64>::new());
    }
}
