//! Three columns of a CSV file: x, y and z of points.

/// The points \[m\] of a file that the case calls `name`; a first line of names and lines that begin with `#` are skipped.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read(bytes: &[u8], name: &str) -> Result<Vec<[f64; 3]>, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let mut points = Vec::new();
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| format!("cannot read {name}: {error}"))?;
        let numbers: Option<Vec<f64>> = record.iter().map(|text| text.parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y, z]) => points.push([x, y, z]),
            None if index == 0 => {}
            _ => {
                let line = record.position().map_or(0, csv::Position::line);
                let text = record.iter().collect::<Vec<_>>().join(",");
                return Err(format!(
                    "line {line} of {name}, `{text}`, is not three numbers: x, y and z in m"
                ));
            }
        }
    }
    Ok(points)
}
