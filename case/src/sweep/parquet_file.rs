//! Columns as a Parquet file of one row group, sealed: its footer holds the SHA-256 of all its bytes.

use super::table::{Data, Named};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs::File;
use std::io::{Read, Write};
use std::ops::Range;
use std::sync::Arc;

/// Definition levels of a value and of none.
const THERE: i16 = 1;
const NONE: i16 = 0;

/// The key of the seal in the footer, and what stands for it while the bytes are hashed.
const SEAL: &str = "sha256";
const UNSEALED: [u8; 64] = [b'0'; 64];

/// Where the seal stands: behind its key, the type of a text in the compact protocol of Thrift, and its length. What is written behind it is
/// the name of the program.
fn seal(bytes: &[u8]) -> Option<Range<usize>> {
    let head = [SEAL.as_bytes(), &[0x18, 64]].concat();
    let start = bytes.windows(head.len()).rposition(|window| window == head)? + head.len();
    (start + UNSEALED.len() <= bytes.len()).then_some(start..start + UNSEALED.len())
}

fn digest(unsealed: &[u8]) -> String {
    let mut text = String::with_capacity(UNSEALED.len());
    for byte in Sha256::digest(unsealed) {
        let _ = write!(text, "{byte:02x}");
    }
    text
}

/// Whether the bytes are those that were written.
fn is_sealed(mut bytes: Vec<u8>) -> bool {
    let Some(at) = seal(&bytes) else { return false };
    let stated = bytes[at.clone()].to_vec();
    bytes[at].copy_from_slice(&UNSEALED);
    digest(&bytes).as_bytes() == stated
}

fn field((name, data): &Named) -> Result<Arc<Type>> {
    let (physical, repetition, logical) = match data {
        Data::Whole(_) => (Physical::INT64, Repetition::REQUIRED, None),
        Data::Numbers(_) => (Physical::DOUBLE, Repetition::OPTIONAL, None),
        Data::Texts(_) => (Physical::BYTE_ARRAY, Repetition::OPTIONAL, Some(LogicalType::String)),
        Data::Booleans(_) => (Physical::BOOLEAN, Repetition::OPTIONAL, None),
    };
    let builder = Type::primitive_type_builder(name, physical);
    builder.with_repetition(repetition).with_logical_type(logical).build().map(Arc::new)
}

/// Writes columns of one length.
///
/// # Errors
/// Those of the file, and of names that no file can hold.
pub(super) fn write(columns: &[Named], created_by: &str, mut to: impl Write) -> Result<()> {
    let fields = columns.iter().map(field).collect::<Result<Vec<_>>>()?;
    let schema = Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?);
    let properties = WriterProperties::builder()
        .set_created_by(created_by.to_owned())
        .set_dictionary_enabled(false)
        .set_statistics_enabled(EnabledStatistics::Chunk)
        .set_offset_index_disabled(true)
        .set_key_value_metadata(Some(vec![KeyValue::new(
            SEAL.to_owned(),
            String::from_utf8_lossy(&UNSEALED).into_owned(),
        )]))
        .build();
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for (_, data) in columns {
        match data {
            Data::Whole(values) => column::<Int64Type, _>(&mut group, values, None)?,
            Data::Numbers(values) => optional::<DoubleType, _, _>(&mut group, values, |x| *x)?,
            Data::Booleans(values) => optional::<BoolType, _, _>(&mut group, values, |x| *x)?,
            Data::Texts(values) => {
                optional::<ByteArrayType, _, _>(&mut group, values, |text| ByteArray::from(text.as_str()))?;
            }
        }
    }
    group.close()?;
    file.close()?;
    let at =
        seal(&bytes).ok_or_else(|| ParquetError::General("there is no place for the seal".to_owned()))?;
    let sealed = digest(&bytes);
    bytes[at].copy_from_slice(sealed.as_bytes());
    Ok(to.write_all(&bytes)?)
}

fn optional<T: DataType, V, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &[Option<V>],
    make: impl Fn(&V) -> T::T,
) -> Result<()> {
    let levels: Vec<i16> = values.iter().map(|x| if x.is_some() { THERE } else { NONE }).collect();
    let there: Vec<T::T> = values.iter().flatten().map(make).collect();
    column::<T, W>(group, &there, Some(&levels))
}

fn column<T: DataType, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<()> {
    let mut column =
        group.next_column()?.ok_or_else(|| ParquetError::General("a column is missing".to_owned()))?;
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}

/// Reads what [`write`] wrote: the columns in their order, with their names.
///
/// # Errors
/// A file that is torn or changed, in one bit even, or that this program did not write.
pub(super) fn read(mut file: File) -> Result<Vec<Named>> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    if !is_sealed(bytes) {
        return Err(ParquetError::General("its bytes are not those that were written".to_owned()));
    }
    let reader = SerializedFileReader::new(file)?;
    let rows = usize::try_from(reader.metadata().file_metadata().num_rows()).unwrap_or(0);
    if reader.num_row_groups() != 1 {
        return Err(ParquetError::General(format!("it has {} row groups, not one", reader.num_row_groups())));
    }
    let group = reader.get_row_group(0)?;
    let schema = reader.metadata().file_metadata().schema_descr();
    let read = |i: usize| {
        let name = schema.column(i).name().to_owned();
        let data = match group.get_column_reader(i)? {
            ColumnReader::Int64ColumnReader(of) => Data::Whole(plain(of, rows)?),
            ColumnReader::DoubleColumnReader(of) => Data::Numbers(there(of, rows, Some)?),
            ColumnReader::BoolColumnReader(of) => Data::Booleans(there(of, rows, Some)?),
            ColumnReader::ByteArrayColumnReader(of) => {
                Data::Texts(there(of, rows, |bytes| String::from_utf8(bytes.data().to_vec()).ok())?)
            }
            _ => return Err(ParquetError::General(format!("the column {name} is of another type"))),
        };
        if data.len() == rows {
            Ok((name, data))
        } else {
            Err(ParquetError::General(format!("the column {name} has {} values, not {rows}", data.len())))
        }
    };
    (0..group.num_columns()).map(read).collect()
}

fn plain<T: DataType>(mut column: ColumnReaderImpl<T>, rows: usize) -> Result<Vec<T::T>> {
    let mut values = Vec::with_capacity(rows);
    column.read_records(rows, None, None, &mut values)?;
    Ok(values)
}

fn there<T: DataType, V>(
    mut column: ColumnReaderImpl<T>,
    rows: usize,
    make: impl Fn(T::T) -> Option<V>,
) -> Result<Vec<Option<V>>> {
    let (mut levels, mut values) = (Vec::with_capacity(rows), Vec::with_capacity(rows));
    column.read_records(rows, Some(&mut levels), None, &mut values)?;
    let mut values = values.into_iter();
    Ok(levels
        .into_iter()
        .map(|level| if level == THERE { values.next().and_then(&make) } else { None })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_read_back_to_the_bit_and_a_torn_file_is_not_read() {
        let texts = [Some("a, \"b\" µ".to_owned()), None, Some(String::new())].to_vec();
        let columns: Vec<Named> = vec![
            ("row".to_owned(), Data::Whole(vec![-1, 0, i64::MAX])),
            (
                "tip.deflection.min [m]".to_owned(),
                Data::Numbers(vec![Some(-0.0), None, Some(f64::MIN_POSITIVE / 3.0)]),
            ),
            ("reason".to_owned(), Data::Texts(texts)),
            ("trusted".to_owned(), Data::Booleans(vec![None, Some(true), Some(false)])),
            ("nothing".to_owned(), Data::Numbers(vec![None; 3])),
        ];
        let mut bytes = Vec::new();
        write(&columns, "test", &mut bytes).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let read = |bytes: &[u8]| {
            let path = folder.path().join("part");
            std::fs::write(&path, bytes).unwrap();
            super::read(File::open(path).unwrap())
        };
        assert_eq!(format!("{:?}", read(&bytes).unwrap()), format!("{columns:?}"));
        for length in [0, 3, bytes.len() / 2, bytes.len() - 1] {
            assert!(read(&bytes[..length]).is_err(), "{length}");
        }
    }
}
