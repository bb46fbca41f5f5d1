//! CSV files of rows of numbers: times with values, points.

use super::columns::{in_si, parts, plain};
use crate::units::Measure;

/// A column by its place: the names that its title may have, of which another column's is an error, and what it measures.
pub type Titled = (&'static [&'static str], &'static Measure);

/// The rows of N numbers of a file that the case calls `name`, which are `what`, in SI. A first line has the titles of the columns, with their
/// units or without; lines that begin with `#` are skipped.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read<const N: usize>(
    bytes: &[u8],
    name: &str,
    what: &str,
    columns: [Titled; N],
) -> Result<Vec<[f64; N]>, String> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(bytes);
    let (mut rows, mut factors) = (Vec::new(), [1.0; N]);
    for (index, record) in reader.records().enumerate() {
        let record = record.map_err(|error| format!("cannot read {name}: {error}"))?;
        let numbers: Vec<f64> = record.iter().filter_map(|text| text.parse().ok()).collect();
        match <[f64; N]>::try_from(numbers.as_slice()) {
            Ok(row) if record.len() == N => {
                rows.push(std::array::from_fn(|k| factors[k] * row[k]));
            }
            _ if numbers.is_empty() && index == 0 => {
                for (k, title) in record.iter().enumerate().take(N) {
                    factors[k] = factor(title, name, k, &columns)?;
                }
            }
            _ => {
                let line = record.position().map_or(0, csv::Position::line);
                let text = record.iter().collect::<Vec<_>>().join(",");
                return Err(format!("line {line} of {name}, `{text}`, is not {what}"));
            }
        }
    }
    Ok(rows)
}

/// The number of SI units in the unit of column `k`, whose title must not be that of another.
fn factor(title: &str, name: &str, k: usize, columns: &[Titled]) -> Result<f64, String> {
    let title = title.trim_start_matches('\u{feff}');
    let (own, unit) = parts(title);
    let (names, measure) = columns[k];
    let is = |names: &[&str]| names.contains(&plain(own).as_str());
    if let Some(other) = columns.iter().position(|(names, _)| is(names)).filter(|_| !is(names)) {
        return Err(format!(
            "column {} of {name} is called `{title}`, which is column {}: columns are read in their order",
            k + 1,
            other + 1
        ));
    }
    unit.map_or(Ok(1.0), |unit| in_si(unit, measure, title, name))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{ANGULAR_SPEED, LENGTH, TIME};

    const MOTION: [Titled; 2] = [(&["t", "time"], &TIME), (&[], &ANGULAR_SPEED)];
    const POINTS: [Titled; 3] = [(&["x"], &LENGTH), (&["y"], &LENGTH), (&["z"], &LENGTH)];

    #[test]
    fn units_of_titles_count() {
        let read = |text: &str| super::read(text.as_bytes(), "f", "two numbers", MOTION);
        let si = read("0,0\n1,2\n").unwrap();
        for text in [
            "t,speed\n0,0\n1,2\n",
            "time [s], v (rad/s)\n0,0\n1,2\n",
            "# measured\nT [ms],v [rad/s]\n0,0\n1000,2\n",
            "\u{feff}t [s],v [mrad/s]\r\n0,0\r\n1,2000\r\n",
        ] {
            let rows = read(text).unwrap();
            let near = |a: &[f64; 2], b: &[f64; 2]| (0..2).all(|k| (a[k] - b[k]).abs() < 1e-12);
            assert!(rows.len() == 2 && rows.iter().zip(&si).all(|(a, b)| near(a, b)), "{text}: {rows:?}");
        }
        let turned = read("t,n [rpm]\n0,0\n1,60\n").unwrap()[1][1];
        assert!((turned - 2.0 * std::f64::consts::PI).abs() < 1e-12);
        for (text, says) in [
            ("t [s],angle [deg]\n0,0\n1,1\n", "`deg` is a unit of angle"),
            ("value,time\n0,0\n1,1\n", "column 2 of f is called `time`, which is column 1"),
            ("t [s],v [furlong]\n0,0\n1,1\n", "furlong"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
        let points = super::read(b"z,x,y\n0,0,0\n", "f", "three numbers", POINTS).unwrap_err();
        assert!(points.contains("`z`, which is column 3"), "{points}");
    }
}
