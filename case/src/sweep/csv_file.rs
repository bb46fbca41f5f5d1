//! Columns as lines of a CSV file.

use super::table::{Data, Named};
use std::fmt::Write as _;
use std::io::Write;

/// Writes the lines of columns, and their names before them if `head`. Every number is the shortest text that reads back as the very same
/// f64; what is not there is empty.
///
/// # Errors
/// Whatever `to` returns.
pub(super) fn write(columns: &[Named], head: bool, to: impl Write) -> std::io::Result<()> {
    let mut csv = csv::Writer::from_writer(to);
    if head {
        csv.write_record(columns.iter().map(|(name, _)| name))?;
    }
    let rows = columns.first().map_or(0, |(_, data)| data.len());
    let mut text = String::new();
    for row in 0..rows {
        for (_, data) in columns {
            text.clear();
            let written = match data {
                Data::Whole(of) => write!(text, "{}", of[row]),
                Data::Numbers(of) => of[row].map_or(Ok(()), |x| write!(text, "{x:?}")),
                Data::Booleans(of) => of[row].map_or(Ok(()), |x| write!(text, "{x}")),
                Data::Texts(of) => of[row].as_deref().map_or(Ok(()), |x| text.write_str(x)),
            };
            written.map_err(std::io::Error::other)?;
            csv.write_field(&text)?;
        }
        csv.write_record(None::<&[u8]>)?;
    }
    csv.flush()
}
