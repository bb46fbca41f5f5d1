//! CSV files whose first line names the columns: `EI-flap`, `EI_flap` or `FlpStff`, with a unit or in SI.

use crate::units::{self, Measure};
use flexion_results::nearest;

/// A column that a file may have.
pub struct Column {
    /// Its name.
    pub name: &'static str,
    /// Other names of it; case, blanks, `-` and `_` do not count.
    pub aliases: &'static [&'static str],
    /// What it measures.
    pub measure: &'static Measure,
    /// Whether each file has it.
    pub required: bool,
}

/// Declares a column.
pub const fn column(
    name: &'static str,
    aliases: &'static [&'static str],
    measure: &'static Measure,
    required: bool,
) -> Column {
    Column { name, aliases, measure, required }
}

/// ElastoDyn's twist, which is in degrees without saying so, and positive about the axis towards the root.
const OF_ELASTODYN: &str = "strctwst";

/// Letters and digits of a title, in lower case.
pub(super) fn plain(title: &str) -> String {
    title.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

/// A title without its unit, and the unit: `twist [deg]`, `EA (kN)`.
pub(super) fn parts(title: &str) -> (&str, Option<&str>) {
    match title.find(['[', '(']) {
        Some(at) => (title[..at].trim(), Some(title[at + 1..].trim_end_matches([']', ')']).trim())),
        None => (title, None),
    }
}

/// The number of SI units in one of a column's.
fn factor(title: &str, unit: Option<&str>, column: &Column, name: &str) -> Result<f64, String> {
    let is_of_elastodyn = plain(title) == OF_ELASTODYN;
    let unit = unit.or(is_of_elastodyn.then_some("deg"));
    let size = unit.map_or(Ok(1.0), |unit| in_si(unit, column.measure, column.name, name))?;
    Ok(if is_of_elastodyn { -size } else { size })
}

/// The number of SI units in the `unit` of the column `title` of the file `name`.
pub(super) fn in_si(unit: &str, measure: &Measure, title: &str, name: &str) -> Result<f64, String> {
    let unit = unit.replace("Nm", "N*m").replace("kgm", "kg*m");
    let of = |unit: &str| units::parse(&format!("1 {unit}"), measure);
    // A title in capitals has its unit in capitals.
    of(&unit)
        .or_else(|error| of(&unit.to_lowercase()).map_err(|_| error))
        .map_err(|error| format!("the column `{title}` of {name}: {}; {}", error.message, error.help))
}

/// The rows of a file that the case calls `name`, in SI and in the order of `columns`, zero where one is left out. Lines
/// that begin with `#` are skipped.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read<const N: usize>(text: &str, name: &str, columns: &[Column; N]) -> Result<Vec<[f64; N]>, String> {
    Ok(with_lines(text, name, columns)?.into_iter().map(|(_, row)| row).collect())
}

/// The rows as [`read`] gives them, each with its line.
///
/// # Errors
/// As [`read`].
pub(super) fn with_lines<const N: usize>(
    text: &str,
    name: &str,
    columns: &[Column; N],
) -> Result<Vec<(usize, [f64; N])>, String> {
    let failed = |error: csv::Error| format!("cannot read {name}: {error}");
    let mut reader =
        csv::ReaderBuilder::new().comment(Some(b'#')).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = reader.headers().map_err(failed)?.clone();
    if header.len() == 1 && header.iter().any(|title| title.contains([';', '\t'])) {
        return Err(format!(
            "{name} has one column: separate columns by commas, and write decimals with a point"
        ));
    }
    let known = || {
        let names: Vec<&str> = columns.iter().map(|column| column.name).collect();
        format!("the columns are named {}, in SI or with a unit, as in `x [mm]`", names.join(", "))
    };
    let mut places: [Option<(usize, f64)>; N] = [None; N];
    for (i, whole) in header.iter().enumerate() {
        let (title, unit) = parts(whole);
        let is = |column: &Column| {
            plain(column.name) == plain(title) || column.aliases.contains(&plain(title).as_str())
        };
        let Some(number) = columns.iter().position(is) else {
            let lower: Vec<String> = columns.iter().map(|column| column.name.to_lowercase()).collect();
            let free = |lower: &&String| !header.iter().any(|other| plain(parts(other).0) == plain(lower));
            let near = nearest(title, lower.iter().filter(free).map(String::as_str));
            let near = columns.iter().find(|column| near == Some(&column.name.to_lowercase()));
            let near = near.map_or(String::new(), |near| format!(" (did you mean `{}`?)", near.name));
            return Err(format!("{name} has a column `{whole}`{near}; {}", known()));
        };
        let column = &columns[number];
        if places[number].is_some() {
            return Err(format!("{name} has two columns `{}`", column.name));
        }
        places[number] = Some((i, factor(title, unit, column, name)?));
    }
    for (column, place) in columns.iter().zip(places) {
        if column.required && place.is_none() {
            return Err(format!("{name} has no column `{}`; {}", column.name, known()));
        }
    }
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(failed)?;
        let line = record.position().map_or(0, |at| at.line() as usize);
        let mut row = [0.0; N];
        for (value, place) in row.iter_mut().zip(places) {
            let Some((place, factor)) = place else { continue };
            let text = record.get(place).unwrap_or("");
            let finite = text.parse().ok().filter(|x: &f64| x.is_finite());
            let number = finite.ok_or_else(|| {
                format!("line {line} of {name}: `{text}` under `{}` is not a number", &header[place])
            })?;
            *value = factor * number;
        }
        rows.push((line, row));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::{ANGLE, AXIAL_STIFFNESS, BENDING_STIFFNESS, LENGTH};

    static COLUMNS: [Column; 4] = [
        column("x", &["span"], &LENGTH, true),
        column("EA", &[], &AXIAL_STIFFNESS, true),
        column("EI-flap", &["flpstff"], &BENDING_STIFFNESS, false),
        column("twist", &["strctwst"], &ANGLE, false),
    ];

    #[test]
    fn titles_may_have_units_and_other_names() {
        let read = |text| read(text, "f", &COLUMNS);
        let si = [[0.5, 2e6, 3.0, 0.1]];
        for text in [
            "x,EA,EI-flap,twist\n0.5,2e6,3,0.1\n",
            "Span [mm], EA [MN], EI_flap (Nm^2), twist [rad]\n500,2,3,0.1\n",
            "ea,X (cm),FlpStff [kN*m^2],Twist\n2e6,50,0.003,0.1\n",
        ] {
            let rows = read(text).unwrap();
            let near = |a: &f64, b: &f64| (a - b).abs() <= 1e-12 * b.abs();
            assert!(rows[0].iter().zip(&si[0]).all(|(a, b)| near(a, b)), "{text}: {rows:?}");
        }
        // That of ElastoDyn is about the axis towards the root.
        for text in [
            "x,EA,twist [deg]\n0,1,180\n",
            "X,ea,TWIST [DEG]\n0,1,180\n",
            "x,EA,StrcTwst\n0,1,-180\n",
            "x,EA,StrcTwst (deg)\n0,1,-180\n",
        ] {
            assert!((read(text).unwrap()[0][3] - std::f64::consts::PI).abs() < 1e-15, "{text}");
        }
        for (text, says) in [
            ("x;EA\n0;1\n", "separate columns by commas"),
            ("x,EA,span\n0,1,2\n", "two columns `x`"),
            ("x,EA [m]\n0,1\n", "the column `EA` of f: `m` is a unit of length"),
            ("x,EA,chord\n0,1,2\n", "a column `chord`; the columns are named x, EA"),
            (
                "x,EA,ei_flp [N m^2]\n0,1,2\n",
                "a column `ei_flp [N m^2]` (did you mean `EI-flap`?); the columns",
            ),
            ("x,EA\n# comment\n0,1\n1,inf\n", "line 4 of f: `inf` under `EA` is not a number"),
            ("x,EA\n0,NaN\n", "line 2 of f: `NaN` under `EA` is not a number"),
        ] {
            let message = read(text).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
    }
}
