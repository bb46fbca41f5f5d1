//! Two columns of a CSV file: time and value.

/// The rows of a file that the case calls `name`; a first line of names and lines that begin with `#` are skipped.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read(bytes: &[u8], name: &str) -> Result<Vec<(f64, f64)>, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let mut rows = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| format!("cannot read {name}: {error}"))?;
        let number = |column: usize| record.get(column).and_then(|text| text.parse::<f64>().ok());
        match (number(0), number(1), record.len()) {
            (Some(time), Some(value), 2) => rows.push((time, value)),
            (None, None, _) if index == 0 => {}
            _ => {
                let line = record.position().map_or(0, csv::Position::line);
                let text = record.iter().collect::<Vec<_>>().join(",");
                return Err(format!(
                    "line {line} of {name}, `{text}`, is not two numbers with a comma between: a time in s and a value"
                ));
            }
        }
    }
    Ok(rows)
}
