//! CSV files of rows of numbers: times with values, points.

/// The rows of N numbers of a file that the case calls `name`, which are `what`; a first line of names and lines that begin with `#`
/// are skipped.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read<const N: usize>(bytes: &[u8], name: &str, what: &str) -> Result<Vec<[f64; N]>, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let mut rows = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| format!("cannot read {name}: {error}"))?;
        let numbers: Vec<f64> = record.iter().filter_map(|text| text.parse().ok()).collect();
        match <[f64; N]>::try_from(numbers.as_slice()) {
            Ok(row) if record.len() == N => rows.push(row),
            _ if numbers.is_empty() && index == 0 => {}
            _ => {
                let line = record.position().map_or(0, csv::Position::line);
                let text = record.iter().collect::<Vec<_>>().join(",");
                return Err(format!("line {line} of {name}, `{text}`, is not {what}"));
            }
        }
    }
    Ok(rows)
}
