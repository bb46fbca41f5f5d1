//! Files of sections: a CSV table of resultants along the beam, with named columns in SI.

use flexion::section::Resultants;

/// The columns, and whether each must be there.
const COLUMNS: [(&str, bool); 7] = [
    ("x", true),
    ("mass", true),
    ("EA", true),
    ("EI", true),
    ("ES", false),
    ("first-moment", false),
    ("rotary-inertia", false),
];

/// The rows (x [m], resultants) of a file that the case calls `name`. The first line names the columns, in any order;
/// lines that begin with `#` are skipped.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read(bytes: &[u8], name: &str) -> Result<Vec<(f64, Resultants)>, String> {
    let failed = |error: csv::Error| format!("cannot read {name}: {error}");
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(bytes);
    let header = reader.headers().map_err(failed)?.clone();
    let names = || COLUMNS.iter().map(|column| column.0).collect::<Vec<_>>().join(", ");
    for (i, title) in header.iter().enumerate() {
        if !COLUMNS.iter().any(|column| column.0 == title) {
            return Err(format!("{name} has a column `{title}`; the columns are named {}", names()));
        }
        if header.iter().take(i).any(|other| other == title) {
            return Err(format!("{name} has two columns `{title}`"));
        }
    }
    let mut places = [None; COLUMNS.len()];
    for (place, (title, required)) in places.iter_mut().zip(COLUMNS) {
        *place = header.iter().position(|other| other == title);
        if required && place.is_none() {
            return Err(format!("{name} has no column `{title}`; the columns are named {}", names()));
        }
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(failed)?;
        let mut values = [0.0; COLUMNS.len()];
        for (value, place) in values.iter_mut().zip(places) {
            let Some(place) = place else { continue };
            let text = record.get(place).unwrap_or("");
            *value = text.parse().map_err(|_| {
                let line = record.position().map_or(0, csv::Position::line);
                format!("line {line} of {name}: `{text}` under `{}` is not a number", &header[place])
            })?;
        }
        let [x, mass, axial_stiffness, bending_stiffness, coupling_stiffness, first_moment, rotary_inertia] =
            values;
        let resultants = Resultants {
            mass,
            first_moment,
            rotary_inertia,
            axial_stiffness,
            coupling_stiffness,
            bending_stiffness,
        };
        rows.push((x, resultants));
    }
    Ok(rows)
}
