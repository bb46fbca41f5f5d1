//! Blade files of ElastoDyn: stiffnesses about principal axes of a straight blade, without shear and offsets.
//!
//! OpenFAST up to 4 reads the columns by their place, whatever their titles: 17 in FAST 7, the first six of them from FAST 8 on. OpenFAST 5 reads
//! five, without the second, by their titles. Here they are read by their place, and titles that name other columns are refused. Columns
//! behind the fifth stiffness column are those of FAST 7, or what their titles say. The factors `AdjBlMs`, `AdjFlSt`, `AdjEdSt` are applied. The twist
//! is positive about the axis towards the root. Formats: FAST 7 to OpenFAST 5 (`ElastoDyn_IO.f90`, Apache 2.0).

use super::fortran::{Text, begins_number, number, words};
use super::rows::Convention;
use super::{Deck, csv};
use crate::files::columns;
use crate::units::{ANGLE, BENDING_STIFFNESS, MASS_PER_LENGTH, Measure};
use flexion::section::MatrixTable;

/// Slenderness L√(EA/EI) of a blade whose file gives no axial stiffness and which does not stretch in ElastoDyn: its strain moves frequencies by
/// less than 1e-6.
const SLENDERNESS: f64 = 3000.0;
/// The same of a blade of an ordinary size, for what is unlikely of one.
const ORDINARY: f64 = 50.0;

/// The order and the axes of a table of centres, with ElastoDyn's names.
static ELASTODYN: Convention = Convention {
    stiffness: Some(["EAStff", "GA", "GA", "GJStff", "FlpStff", "EdgStff"]),
    inertia: Some(["BMassDen", "FlpIner + EdgIner", "FlpIner", "EdgIner", "FlpcgOf", "EdgcgOf"]),
    twists: true,
    ..csv::CSV
};

/// The columns of FAST 7.
const COLUMNS: [&str; 17] = [
    "BlFract",
    "PitchAxis",
    "StrcTwst",
    "BMassDen",
    "FlpStff",
    "EdgStff",
    "GJStff",
    "EAStff",
    "Alpha",
    "FlpIner",
    "EdgIner",
    "PrecrvRef",
    "PreswpRef",
    "FlpcgOf",
    "EdgcgOf",
    "FlpEAOf",
    "EdgEAOf",
];
const PITCH_AXIS: usize = 1;
/// Columns from FAST 8 on.
const NEEDED: usize = 6;
/// Columns that are read.
const READ: [usize; 9] = [0, 2, 3, 4, 5, 6, 7, 9, 10];

/// The column that a title names.
fn known(title: &str) -> Option<usize> {
    let plain = columns::plain(columns::parts(title).0);
    if matches!(&*plain, "aerocent" | "aercen") {
        return Some(PITCH_AXIS);
    }
    COLUMNS.iter().position(|column| columns::plain(column) == plain)
}

/// Where a table has the columns of FAST 7.
struct Table {
    /// The line of its first row.
    first: usize,
    /// Numbers of a row.
    width: usize,
    places: [Option<usize>; 17],
}

impl Table {
    /// The table behind line `from`.
    fn find(text: &Text<'_>, from: usize, cautions: &mut Vec<String>) -> Result<Table, String> {
        let name = text.name;
        let Some(first) = text.next_with_number(from + 1) else {
            return Err(format!("line {} of {name}: the file ends before its table", text.len()));
        };
        let width = words(text.line(first)).iter().take_while(|word| begins_number(word)).count();
        let mut heads = (from + 1..first)
            .filter(|i| !words(text.line(*i)).is_empty() && !text.line(*i).trim_start().starts_with("--"));
        let header = heads.next().unwrap_or(first);
        let titles = if header < first { words(text.line(header)) } else { Vec::new() };
        let titled: Vec<Option<usize>> = titles.iter().take(width).map(|title| known(title)).collect();
        let is_named =
            titled.len() == width && (0..NEEDED).all(|j| j == PITCH_AXIS || titled.contains(&Some(j)));
        let has_axis = if is_named { titled.contains(&Some(PITCH_AXIS)) } else { width != NEEDED - 1 };
        let column = |k: usize| if k > 0 && !has_axis { k + 1 } else { k };
        let fixed = if is_named { NEEDED - usize::from(!has_axis) } else { width };
        let widths = [NEEDED - 1, NEEDED, COLUMNS.len()];
        if !is_named && !widths.contains(&width) {
            return Err(format!(
                "line {first} of {name} has {width} numbers; a row of ElastoDyn has five (BlFract, StrcTwst, BMassDen, FlpStff, EdgStff), six (PitchAxis is \
                 the second), or the 17 of FAST 7, or all have titles"
            ));
        }
        for (k, title) in titled.iter().enumerate().take(fixed) {
            if title.is_some_and(|j| j != column(k)) {
                let count = if titles.len() == width {
                    String::new()
                } else {
                    format!("; {} titles stand over the {width} numbers of line {first}", titles.len())
                };
                return Err(format!(
                    "line {header} of {name}: the title `{}` stands over column {}, which is read as `{}`{count}. OpenFAST up to 4 reads columns by their \
                     place, and 5 by their titles, which must agree: BlFract, PitchAxis (not from 5 on), StrcTwst, BMassDen, FlpStff, EdgStff",
                    titles[k],
                    k + 1,
                    COLUMNS[column(k)]
                ));
            }
        }
        let mut places = [None; 17];
        for k in 0..width {
            let title = titled.get(k).copied().flatten();
            let Some(j) = (if k < fixed { Some(column(k)) } else { title }) else { continue };
            if places[j].is_some() {
                return Err(format!("line {header} of {name}: two columns have the title `{}`", COLUMNS[j]));
            }
            places[j] = Some(k);
        }
        let other = |k: &usize| column(*k) != PITCH_AXIS && titled.get(*k).copied().flatten().is_none();
        let others: Vec<String> = (0..fixed.min(NEEDED))
            .filter(other)
            .map(|k| {
                let title = titles.get(k).map_or("without a title".to_owned(), |title| format!("`{title}`"));
                format!("{title} as `{}`", COLUMNS[column(k)])
            })
            .collect();
        if !others.is_empty() {
            cautions.push(format!(
                "line {header} of {name}: columns are read by their place, as OpenFAST up to 4 does: {}; 5 asks for its titles",
                others.join(", ")
            ));
        }
        cautions.extend(heads.next().or(Some(header)).and_then(|i| units(text, i, &places, width)));
        Ok(Table { first, width, places })
    }
}

/// Units that stand over columns and are not those in which ElastoDyn reads them.
fn units(text: &Text<'_>, line: usize, places: &[Option<usize>; 17], width: usize) -> Option<String> {
    let of = |part: &str| part.split_once(')').map(|(unit, _)| unit.trim().to_owned());
    let units: Vec<String> = text.line(line).split('(').skip(1).filter_map(of).collect();
    let degree = std::f64::consts::PI / 180.0;
    let read: [(usize, &Measure, f64, &str); 5] = [
        (2, &ANGLE, degree, "deg"),
        (3, &MASS_PER_LENGTH, 1.0, "kg/m"),
        (4, &BENDING_STIFFNESS, 1.0, "Nm^2"),
        (5, &BENDING_STIFFNESS, 1.0, "Nm^2"),
        (6, &BENDING_STIFFNESS, 1.0, "Nm^2"),
    ];
    read.into_iter().filter(|_| units.len() == width).find_map(|(j, measure, size, own)| {
        let unit = &units[places[j]?];
        let factor = columns::in_si(unit, measure, COLUMNS[j], text.name).ok()?;
        ((factor / size - 1.0).abs() > 1e-9).then(|| {
            format!(
                "line {line} of {}: `{}` has the unit {unit}, and is read in {own}, as ElastoDyn reads it whatever its unit: is the unit right, or are the numbers?",
                text.name, COLUMNS[j]
            )
        })
    })
}

/// Reads a blade file of ElastoDyn for a blade of the length \[m\], without its hub.
///
/// # Errors
/// What is wrong with it.
pub(super) fn read(bytes: &[u8], name: &str, length: Option<f64>) -> Result<Deck, String> {
    let Some(length) = length else {
        return Err(format!(
            "{name} gives its stations as parts of the blade: give the `length` of the beam, without the hub"
        ));
    };
    let text = Text::new(bytes, name);
    let (count, mut behind) = text.count(&["NBlInpSt"], 2, "the number of stations")?;
    let before = |keys: &[&str]| -> Result<Option<(usize, f64)>, String> {
        let Some((line, word)) = text.keyword(keys) else { return Ok(None) };
        let number = number(&word).map(|number| Some((line, number)));
        number.ok_or_else(|| format!("line {line} of {name}: `{word}` before `{}` is not a number", keys[0]))
    };
    let mut factors = [1.0; 3];
    for (factor, key) in factors.iter_mut().zip(["AdjBlMs", "AdjFlSt", "AdjEdSt"]) {
        match before(&[key])? {
            Some((line, found)) if !(found > 0.0) => {
                return Err(format!("line {line} of {name}: `{key}` is {found}, and must be positive"));
            }
            Some((line, found)) => (*factor, behind) = (found, behind.max(line)),
            None => return Err(format!("{name} has no line with `{key}`, a factor of its table")),
        }
    }
    let [mass, flap, edge] = factors;
    let mut cautions = Vec::new();
    let table = Table::find(&text, behind, &mut cautions)?;
    let stretches = table.places[7].is_some();
    let (mut rows, mut at) = (Vec::new(), table.first);
    let mut unused = vec![false; table.width];
    for number in 1..=count {
        let ends =
            text.next_with_number(at).is_none_or(|line| (at..line).any(|i| text.line(i).starts_with("---")));
        if ends {
            return Err(format!("{name} announces {count} stations and holds {}", number - 1));
        }
        let found = text.numbers(&mut at, table.width, &format!("station {number}"))?;
        let (line, row) = (found.line, found.values);
        if found.surplus > 0 {
            return Err(format!(
                "line {line} of {name} has {} numbers, and the first row, in line {}, {}",
                table.width + found.surplus,
                table.first,
                table.width
            ));
        }
        let of_column = |j: usize| table.places[j].map_or(0.0, |k| row[k]);
        let [station, twist, density, flapwise, edgewise, torsion, axial, of_flap, of_edge] =
            READ.map(of_column);
        for (k, unused) in unused.iter_mut().enumerate() {
            let is_read = READ.iter().chain(&[PITCH_AXIS]).any(|j| table.places[*j] == Some(k));
            *unused |= !is_read && row[k] != 0.0;
        }
        let chord = edge * edgewise;
        let axial = if stretches { axial } else { chord * (ORDINARY / length).powi(2) };
        let mut of = [0.0; 19];
        (of[0], of[1], of[8]) = (station * length, mass * density, -twist.to_radians());
        (of[4], of[5]) = (of_flap, of_edge);
        (of[9], of[12], of[13], of[14]) = (axial, torsion, flap * flapwise, chord);
        rows.push((line, of));
    }
    if unused.contains(&true) {
        let names = (0..table.width).filter(|k| unused[*k]).map(|k| {
            let column = table.places.iter().position(|place| *place == Some(k));
            column.map_or(format!("column {}", k + 1), |j| format!("`{}`", COLUMNS[j]))
        });
        cautions.push(format!(
            "{name} has offsets, precurve or others that ElastoDyn does not use, and are not used here: {}",
            names.collect::<Vec<_>>().join(", ")
        ));
    }
    if !stretches {
        cautions.push(format!(
            "{name} says no axial stiffness: the blade hardly stretches, as that of ElastoDyn, with EA = {SLENDERNESS}² EI/L² of the \
             edgewise stiffness"
        ));
    }
    let mut damped = Vec::new();
    for (key, other) in
        [("BldFlDmp(1)", "BldFlDmp1"), ("BldFlDmp(2)", "BldFlDmp2"), ("BldEdDmp(1)", "BldEdDmp1")]
    {
        if let Some((_, ratio)) = before(&[key, other])?.filter(|(_, ratio)| *ratio != 0.0) {
            damped.push(format!("{key} = {ratio} %"));
        }
    }
    if !damped.is_empty() {
        cautions.push(format!(
            "the damping of {name} is of the assumed modes of ElastoDyn and is not used ({}): `damping.stiffness` = 2ζ/ω of the beam damps \
             one of them as much",
            damped.join(", ")
        ));
    }
    let deck = csv::of_centres(name, rows, cautions, &ELASTODYN, !stretches)?;
    if stretches {
        return Ok(deck);
    }
    let mut rows = deck.table.rows().to_vec();
    rows.iter_mut().for_each(|(_, of)| of.stiffness[0][0] *= (SLENDERNESS / ORDINARY).powi(2));
    let table = MatrixTable::new(deck.length, &rows).map_err(|error| format!("{name}: {error}"))?;
    Ok(Deck { table, ..deck })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ELASTODYN: &str = "--- header\ncomment\n--- PARAMETERS\n 2 NBlInpSt - stations\n 3 BldFlDmp(1) - %\n 0 BldFlDmp(2)\n\
        1.5 AdjBlMs - mass\n 1 AdjFlSt -\n2.0D0 AdjEdSt -\n--- DISTRIBUTED\n BlFract StrcTwst BMassDen FlpStff EdgStff\n\
        (-) (deg) (kg/m) (Nm^2) (Nm^2)\n0.0 13.308 678.9 1.8E+10 1.9D+10\n1.0 0.0 10.0 2e5 5e6\n--- MODE SHAPES\n0.06 BldFl1Sh(2)\n";

    fn read(text: &str) -> Result<Deck, String> {
        super::read(text.as_bytes(), "f", Some(50.0))
    }

    #[test]
    fn an_elastodyn_file_is_read_with_its_factors() {
        let found = read(ELASTODYN).unwrap();
        let root = found.matrices(0.0);
        assert!((root.mass[0][0] - 1018.35).abs() < 1e-9 && root.stiffness[4][4] == 1.8e10, "{root:?}");
        assert!(root.stiffness[5][5] == 3.8e10 && (root.stiffness[0][0] / 1.368e14 - 1.0).abs() < 1e-12);
        // The line's twist is about the axis towards the root.
        assert!((found.line.twist(0.0) - 0.232_268_4).abs() < 1e-6 && found.length == 50.0);
        assert!(found.silent.shear && found.silent.torsion && found.silent.inertia == [true; 3]);
        assert!(
            found.cautions.iter().any(|caution| caution.contains("(BldFlDmp(1) = 3 %)")),
            "{:?}",
            found.cautions
        );
        for (from, to, says) in [
            (" 2 NBlInpSt", " 3 NBlInpSt", "announces 3 stations and holds 2"),
            (" 2 NBlInpSt", " 0 NBlInpSt", "a whole number of at least 2"),
            (" 2 NBlInpSt", " 2 Stations", "no line with `NBlInpSt`"),
            ("FlpStff EdgStff", "EdgStff FlpStff", "the title `EdgStff` stands over column 4"),
            ("5e6\n", "5e6 7\n", "line 14 of f has 6 numbers, and the first row"),
            ("1.9D+10\n", "\n", "line 13 of f has 4 numbers; a row of ElastoDyn has five"),
            ("678.9", "67x8", "line 13 of f: `67x8`"),
            (" 5e6", "", "station 2"),
            ("1.5 AdjBlMs", "-1.5 AdjBlMs", "must be positive"),
            ("1.5 AdjBlMs - mass\n", "", "no line with `AdjBlMs`"),
            ("2.0D0 AdjEdSt -\n", "", "no line with `AdjEdSt`"),
            ("1.8E+10", "-1.8E+10", "the bending stiffness flapwise"),
        ] {
            let message = read(&ELASTODYN.replacen(from, to, 1)).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
    }
}
