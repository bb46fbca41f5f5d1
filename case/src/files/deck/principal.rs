//! Decks of sections by their stiffnesses about principal axes: without shear, without offsets, and on a straight axis.
//!
//! | format | station | columns read |
//! |---|---|---|
//! | CSV | `x` | `mass`, `EA`, `EI-flap`, `EI-chord` and, if there, `GJ`, `inertia-flap`, `inertia-chord`, `twist`, in SI or with units |
//! | ElastoDyn | `BlFract` of the length | `StrcTwst`, `BMassDen`, `FlpStff`, `EdgStff`, and `GJStff`, `EAStff`, `FlpIner`, `EdgIner` of older files; the factors `AdjBlMs`, `AdjFlSt`, `AdjEdSt` |
//!
//! The twist of a CSV file is positive about the axis towards the tip, that of ElastoDyn about the axis towards the root.

use super::fortran::{Text, decoded, words};
use crate::files::columns::{self, Column, column};
use crate::units::{ANGLE, AXIAL_STIFFNESS, BENDING_STIFFNESS, LENGTH, MASS_PER_LENGTH, ROTARY_INERTIA};
use flexion::section::{BladeResultants, BladeTable};

/// The sections of a straight blade.
#[derive(Clone, Debug)]
pub struct Principal {
    /// Its length \[m\].
    pub length: f64,
    /// The sections.
    pub table: BladeTable,
    /// What is unlikely, or not used, each in one sentence.
    pub cautions: Vec<String>,
}

/// Slenderness L√(EA/EI) of a blade of ElastoDyn, which does not stretch: its strain moves frequencies by less than 1e-6.
const SLENDERNESS: f64 = 3000.0;
/// Largest twist that a file may give \[rad\]: more of it is in degrees.
const LARGEST_TWIST: f64 = std::f64::consts::PI;
/// Twist above which there is a caution \[rad\]; blades have less than 0.5.
const MUCH_TWIST: f64 = 1.0;

/// The columns of a CSV file.
static COLUMNS: [Column; 9] = [
    column("x", &["s", "span", "station"], &LENGTH, true),
    column("mass", &["massperlength", "bmassden", "rhoa"], &MASS_PER_LENGTH, true),
    column("EA", &["eastff", "axialstiffness"], &AXIAL_STIFFNESS, true),
    column("EI-flap", &["flpstff", "flapstiffness", "flapwisestiffness"], &BENDING_STIFFNESS, true),
    column(
        "EI-chord",
        &["edgstff", "eiedge", "edgestiffness", "edgewisestiffness"],
        &BENDING_STIFFNESS,
        true,
    ),
    column("GJ", &["gjstff", "torsionalstiffness"], &BENDING_STIFFNESS, false),
    column("inertia-flap", &["flpiner", "flapinertia"], &ROTARY_INERTIA, false),
    column("inertia-chord", &["edginer", "inertiaedge", "edgeinertia"], &ROTARY_INERTIA, false),
    column("twist", &["strctwst"], &ANGLE, false),
];

/// Titles of a CSV file that such a table has not: those of matrices, of shear, and of centres.
const OF_MATRICES: [&str; 12] = [
    "k11",
    "gachord",
    "gaedge",
    "gaflap",
    "massy",
    "massz",
    "tensiony",
    "tensionz",
    "sheary",
    "shearz",
    "polarinertia",
    "inertiaproduct",
];

/// Whether a CSV file has none of the columns that need matrices.
pub(super) fn is_principal(bytes: &[u8]) -> bool {
    let text = decoded(bytes);
    let header = text.lines().find(|line| !line.trim_start().starts_with('#')).unwrap_or("");
    let titles = header.split(',').map(|title| columns::plain(columns::parts(title.trim()).0));
    !titles.into_iter().any(|title| OF_MATRICES.contains(&title.as_str()))
}

/// Reads a table in CSV.
///
/// # Errors
/// What is wrong with it.
pub(super) fn csv(bytes: &[u8], name: &str) -> Result<Principal, String> {
    let mut rows = Vec::new();
    for v in columns::read(&decoded(bytes), name, &COLUMNS)? {
        if v[8].abs() > LARGEST_TWIST {
            return Err(format!(
                "the twist of {name} at x = {} m is {} rad, more than half a revolution: for degrees name the column \
                 `twist [deg]`",
                v[0], v[8]
            ));
        }
        let resultants = BladeResultants {
            mass: v[1],
            axial_stiffness: v[2],
            flap_stiffness: v[3],
            chord_stiffness: v[4],
            torsional_stiffness: v[5],
            flap_inertia: v[6],
            chord_inertia: v[7],
            twist: v[8],
            twist_rate: 0.0,
        };
        rows.push((v[0], resultants));
    }
    let length = rows.last().map_or(0.0, |row| row.0);
    let mut cautions = Vec::new();
    let twist = rows.iter().fold(0.0_f64, |most, (_, r)| most.max(r.twist.abs()));
    if twist > MUCH_TWIST {
        cautions.push(format!(
            "the twist in {name} reaches {:.1}°: where it is given in degrees, name the column `twist [deg]`",
            twist.to_degrees()
        ));
    }
    made(name, length, &rows, cautions)
}

fn made(
    name: &str,
    length: f64,
    rows: &[(f64, BladeResultants)],
    cautions: Vec<String>,
) -> Result<Principal, String> {
    let table = BladeTable::new(length, rows).map_err(|error| format!("{name}: {error}"))?;
    Ok(Principal { length, table, cautions })
}

/// Reads a blade file of ElastoDyn for a blade of the length \[m\], without its hub.
///
/// # Errors
/// What is wrong with it.
pub(super) fn elastodyn(bytes: &[u8], name: &str, length: f64) -> Result<Principal, String> {
    let text = Text::new(bytes, name);
    let (count, _) = text.count(&["NBlInpSt"], 2, "the number of stations")?;
    let before = |key: &str| -> Result<Option<f64>, String> {
        let Some((line, word)) = text.keyword(&[key]) else { return Ok(None) };
        let number = super::fortran::number(&word);
        number
            .map(Some)
            .ok_or_else(|| format!("line {line} of {name}: `{word}` before `{key}` is not a number"))
    };
    let factor = |key: &str| match before(key)? {
        Some(factor) if !(factor > 0.0) => {
            Err(format!("`{key}` of {name} is {factor}, and must be positive"))
        }
        factor => Ok(factor.unwrap_or(1.0)),
    };
    let (mass, flap, edge) = (factor("AdjBlMs")?, factor("AdjFlSt")?, factor("AdjEdSt")?);
    let first =
        |i: &usize| words(text.line(*i)).first().is_some_and(|word| word.eq_ignore_ascii_case("BlFract"));
    let Some(header) = (1..=text.len()).find(first) else {
        return Err(format!("{name} has no line of column names that begins with `BlFract`"));
    };
    let titles = words(text.line(header));
    let place = |title: &str| titles.iter().position(|other| other.eq_ignore_ascii_case(title));
    let needed = |title: &str| place(title).ok_or_else(|| format!("{name} has no column `{title}`"));
    let (station, twist) = (needed("BlFract")?, needed("StrcTwst")?);
    let (density, flapwise, edgewise) = (needed("BMassDen")?, needed("FlpStff")?, needed("EdgStff")?);
    let (mut rows, mut at) = (Vec::new(), header + 1);
    for number in 1..=count {
        let ends =
            text.next_with_number(at).is_none_or(|line| (at..line).any(|i| text.line(i).starts_with("---")));
        if ends {
            return Err(format!("{name} announces {count} stations and holds {}", number - 1));
        }
        let row = text.numbers(&mut at, titles.len(), &format!("station {number}"))?.values;
        let optional = |title: &str| place(title).map_or(0.0, |i| row[i]);
        let chord_stiffness = edge * row[edgewise];
        let given = optional("EAStff");
        let axial_stiffness =
            if given > 0.0 { given } else { chord_stiffness * (SLENDERNESS / length).powi(2) };
        let resultants = BladeResultants {
            mass: mass * row[density],
            axial_stiffness,
            flap_stiffness: flap * row[flapwise],
            chord_stiffness,
            torsional_stiffness: optional("GJStff"),
            flap_inertia: optional("FlpIner"),
            chord_inertia: optional("EdgIner"),
            twist: -row[twist].to_radians(),
            twist_rate: 0.0,
        };
        rows.push((row[station] * length, resultants));
    }
    let mut cautions = Vec::new();
    if place("EAStff").is_none() {
        cautions.push(format!(
            "{name} says no axial stiffness: the blade hardly stretches, as that of ElastoDyn, with EA = {SLENDERNESS}² EI/L² of the \
             edgewise stiffness"
        ));
    }
    let mut damped = Vec::new();
    for key in ["BldFlDmp(1)", "BldFlDmp(2)", "BldEdDmp(1)"] {
        if let Some(ratio) = before(key)?.filter(|ratio| *ratio != 0.0) {
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
    made(name, length, &rows, cautions)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ELASTODYN: &str = "--- header\ncomment\n--- PARAMETERS\n 2 NBlInpSt - stations\n 3 BldFlDmp(1) - %\n 0 BldFlDmp(2)\n\
        1.5 AdjBlMs - mass\n 1 AdjFlSt -\n2.0D0 AdjEdSt -\n--- DISTRIBUTED\n BlFract StrcTwst BMassDen FlpStff EdgStff\n\
        (-) (deg) (kg/m) (Nm^2) (Nm^2)\n0.0 13.308 678.9 1.8E+10 1.9D+10\n1.0 0.0 10.0 2e5 5e6\n--- MODE SHAPES\n0.06 BldFl1Sh(2)\n";

    fn read(text: &str) -> Result<Principal, String> {
        elastodyn(text.as_bytes(), "f", 50.0)
    }

    #[test]
    fn an_elastodyn_file_is_read_with_its_factors() {
        use flexion::section::BladeSection;
        let found = read(ELASTODYN).unwrap();
        let root = found.table.resultants(0.0);
        assert!((root.mass - 1018.35).abs() < 1e-9 && root.flap_stiffness == 1.8e10, "{root:?}");
        assert!(root.chord_stiffness == 3.8e10 && (root.axial_stiffness / 1.368e14 - 1.0).abs() < 1e-12);
        assert!((root.twist + 0.232_268_4).abs() < 1e-6 && found.length == 50.0);
        assert!(
            found.cautions.iter().any(|caution| caution.contains("(BldFlDmp(1) = 3 %)")),
            "{:?}",
            found.cautions
        );
        for (from, to, says) in [
            (" 2 NBlInpSt", " 3 NBlInpSt", "announces 3 stations and holds 2"),
            (" 2 NBlInpSt", " 0 NBlInpSt", "a whole number of at least 2"),
            (" 2 NBlInpSt", " 2 Stations", "no line with `NBlInpSt`"),
            ("FlpStff", "FlapStff", "no column `FlpStff`"),
            ("678.9", "67x8", "line 13 of f: `67x8`"),
            (" 5e6", "", "station 2"),
            ("1.5 AdjBlMs", "-1.5 AdjBlMs", "must be positive"),
            ("1.8E+10", "-1.8E+10", "flapwise bending stiffness"),
        ] {
            let message = read(&ELASTODYN.replacen(from, to, 1)).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
    }

    #[test]
    fn a_csv_file_names_its_columns() {
        use flexion::section::BladeSection;
        let text = "# a blade\nx, mass, EA, EI-flap, EI-chord, twist\n0, 1, 2, 3, 4, 0.1\n5, 1, 2, 3, 4, 0\n";
        let read = |text: &str| csv(text.as_bytes(), "f");
        let found = read(text).unwrap();
        let root = found.table.resultants(0.0);
        assert_eq!((found.length, root.twist, root.flap_stiffness), (5.0, 0.1, 3.0));
        for (from, to, says) in [
            ("EI-flap", "EI", "column `EI`"),
            (", EI-chord", "", "no column `EI-chord`"),
            ("5, 1", "5, one", "line 4 of f: `one`"),
            ("4, 0.1", "4, 13.3", "`twist [deg]`"),
        ] {
            let message = read(&text.replacen(from, to, 1)).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
        assert!(is_principal(text.as_bytes()));
        for title in ["K11", "GA-flap [N]", "tension-y"] {
            assert!(!is_principal(text.replacen("EI-flap", title, 1).as_bytes()), "{title}");
        }
    }
}
