//! `trajectory.parquet`: the columns as an Apache Parquet table, for pandas, Polars, DuckDB, Arrow and MATLAB.
//!
//! One column of doubles that are never null for each channel, named as in the other files, after the column
//! `time`; units and meanings stand in the metadata of the file. The values are stored plain, without
//! compression and without dictionaries: every reader knows this encoding, and the digits of computed doubles
//! compress by 20 to 30 % at best.
//!
//! Format: <https://parquet.apache.org/docs/file-format/>.

use std::io::{self, Write};
use std::sync::Arc;

use parquet::basic::{Repetition, Type as Physical};
use parquet::data_type::DoubleType;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;

use super::Trajectory;

/// Rows of a group: what a reader takes into memory at once.
const GROUP: usize = 1 << 20;

/// Writes a trajectory as a Parquet table: required DOUBLE columns `time` [s] and then one for each channel.
///
/// The metadata of the file hold `<column>.unit` (empty for a pure number) and `<column>.meaning`, e.g.
/// `pyarrow.parquet.read_schema(path).metadata[b"tip.deflection.unit"]`. Every value reads back to the same
/// bits, and the same trajectory gives the same bytes.
///
/// # Errors
/// Whatever `to` returns.
pub fn write_parquet(trajectory: &Trajectory, to: impl Write + Send) -> io::Result<()> {
    write(trajectory, to, GROUP).map_err(io_error)
}

/// The system's own error where there is one: what to try depends on it.
fn io_error(error: ParquetError) -> io::Error {
    match error {
        ParquetError::External(source) => match source.downcast::<io::Error>() {
            Ok(error) => *error,
            Err(other) => io::Error::other(other),
        },
        other => io::Error::other(other),
    }
}

fn write(trajectory: &Trajectory, to: impl Write + Send, group: usize) -> Result<(), ParquetError> {
    let channels = trajectory.channels();
    let mut names = vec!["time"];
    let mut notes = vec![note("time", "unit", "s")];
    for c in channels {
        names.push(&c.name);
        notes.push(note(&c.name, "unit", &c.unit));
        if !c.meaning.is_empty() {
            notes.push(note(&c.name, "meaning", &c.meaning));
        }
    }
    let column = |name: &str| {
        let column = Type::primitive_type_builder(name, Physical::DOUBLE);
        Ok(Arc::new(column.with_repetition(Repetition::REQUIRED).build()?))
    };
    let columns = names.into_iter().map(column).collect::<Result<_, ParquetError>>()?;
    let schema = Type::group_type_builder("trajectory").with_fields(columns).build()?;
    let properties =
        WriterProperties::builder().set_dictionary_enabled(false).set_key_value_metadata(Some(notes)).build();

    let mut file = SerializedFileWriter::new(to, Arc::new(schema), Arc::new(properties))?;
    let mut values = Vec::new();
    for start in (0..trajectory.len()).step_by(group) {
        let end = trajectory.len().min(start + group);
        let mut rows = file.next_row_group()?;
        let mut index = 0;
        while let Some(mut column) = rows.next_column()? {
            values.clear();
            match index {
                0 => values.extend_from_slice(&trajectory.times()[start..end]),
                i => values.extend(trajectory.values(i - 1).skip(start).take(end - start)),
            }
            column.typed::<DoubleType>().write_batch(&values, None, None)?;
            column.close()?;
            index += 1;
        }
        rows.close()?;
    }
    file.finish().map(drop)
}

fn note(column: &str, what: &str, text: &str) -> KeyValue {
    KeyValue::new(format!("{column}.{what}"), text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{channel, sample};
    use flexion::system::{Channel, Role};
    use parquet::file::reader::{FileReader, SerializedFileReader};
    use parquet::record::Field;
    use std::fs::File;

    fn bytes(t: &Trajectory, group: usize) -> Vec<u8> {
        let mut out = Vec::new();
        write(t, &mut out, group).unwrap();
        out
    }

    fn open(bytes: &[u8]) -> SerializedFileReader<File> {
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(bytes).unwrap();
        SerializedFileReader::new(file).unwrap()
    }

    /// The rows as bits, by the library's reader of records.
    fn rows(bytes: &[u8]) -> Vec<Vec<u64>> {
        let bits = |field: &Field| match field {
            Field::Double(y) => y.to_bits(),
            other => panic!("{other:?}"),
        };
        let row = |row: parquet::errors::Result<parquet::record::Row>| {
            row.unwrap().get_column_iter().map(|(_, field)| bits(field)).collect()
        };
        open(bytes).into_iter().map(row).collect()
    }

    fn extremes() -> Trajectory {
        let mut t = Trajectory::new(vec![channel("a", "m"), channel("share", "")]);
        for (i, y) in [0.1 + 0.2, f64::NAN, -0.0, f64::NEG_INFINITY, 5e-324, f64::MAX].into_iter().enumerate()
        {
            t.push(i as f64 / 3.0, |row| row.copy_from_slice(&[y, 1.0 / y]));
        }
        t
    }

    #[test]
    fn values_read_back_bit_for_bit_whatever_the_groups() {
        let t = extremes();
        let expected: Vec<Vec<u64>> =
            t.rows().map(|(t, row)| [&[t], row].concat().into_iter().map(f64::to_bits).collect()).collect();
        for (group, groups) in [(1, 6), (4, 2), (6, 1), (GROUP, 1)] {
            let file = bytes(&t, group);
            assert_eq!(open(&file).num_row_groups(), groups);
            assert_eq!(rows(&file), expected);
        }
    }

    #[test]
    fn columns_carry_names_units_and_meanings() {
        let t = Trajectory::new(vec![
            Channel::new(Role::Detail, "x=2.5.w", "m", "deflection"),
            channel("share", ""),
        ]);
        let file = open(&bytes(&t, GROUP));
        let metadata = file.metadata().file_metadata();
        let names: Vec<&str> = metadata.schema_descr().columns().iter().map(|c| c.name()).collect();
        assert_eq!(names, ["time", "x=2.5.w", "share"]);
        for column in metadata.schema_descr().columns() {
            assert_eq!((column.physical_type(), column.max_def_level()), (Physical::DOUBLE, 0));
        }
        let notes = metadata.key_value_metadata().unwrap();
        let note = |key: &str| notes.iter().find(|n| n.key == key).and_then(|n| n.value.as_deref());
        assert_eq!(
            [note("time.unit"), note("x=2.5.w.unit"), note("share.unit")].map(Option::unwrap),
            ["s", "m", ""]
        );
        assert_eq!(note("x=2.5.w.meaning"), Some("deflection"));
        assert_eq!(rows(&bytes(&t, GROUP)), Vec::<Vec<u64>>::new());
    }

    #[test]
    fn the_same_trajectory_gives_the_same_bytes() {
        assert!(bytes(&sample(), GROUP) == bytes(&sample(), GROUP));
    }

    #[test]
    fn a_full_disk_is_reported_as_such() {
        /// Takes so many bytes and no more.
        struct Full(usize);
        impl Write for Full {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                let count = bytes.len().min(self.0);
                self.0 -= count;
                if count == 0 { Err(io::ErrorKind::StorageFull.into()) } else { Ok(count) }
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let mut t = sample();
        for i in 5..50_000 {
            t.push(f64::from(i), |_| {});
        }
        for capacity in [0, 100, 10_000, 1_000_000] {
            let error = write_parquet(&t, Full(capacity)).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{capacity}: {error}");
        }
    }
}
