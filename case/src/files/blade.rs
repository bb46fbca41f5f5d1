//! Files of blades: sectional properties along the span.
//!
//! | format | station | columns or matrices read |
//! |---|---|---|
//! | `csv` | `x` | `mass`, `EA`, `EI-flap`, `EI-chord` and, if there, `GJ`, `inertia-flap`, `inertia-chord`, `twist`, in SI or with units |
//! | `elastodyn` | `BlFract` of the length | `StrcTwst`, `BMassDen`, `FlpStff`, `EdgStff`, and `GJStff`, `EAStff`, `FlpIner`, `EdgIner` of older files; the factors `AdjBlMs`, `AdjFlSt`, `AdjEdSt` |
//! | `beamdyn` | fraction of the length | K₃₃ = EA, K₄₄ edgewise, K₅₅ flapwise, K₆₆ = GJ; M₁₁, M₄₄, M₅₅ |
//!
//! Of a BeamDyn file the shear strains are eliminated at zero shear force, and offsets of the mass centre are left out; where
//! the others are [coupled](Contents::coupled), each stiffness is that at zero force of the others.

use super::columns::{self, Column, column};
use crate::units::{ANGLE, AXIAL_STIFFNESS, BENDING_STIFFNESS, LENGTH, MASS_PER_LENGTH, ROTARY_INERTIA};
use flexion::section::BladeResultants;

/// Stations x [m] and the resultants there.
pub type Rows = Vec<(f64, BladeResultants)>;

/// The rows of a file, and what it says besides them and no blade here uses.
#[derive(Clone, Debug, Default)]
pub struct Contents {
    /// The rows.
    pub rows: Rows,
    /// Cautions, each in one sentence.
    pub cautions: Vec<String>,
    /// What couples stretch, bending and torsion, which a blade here does not have: as [`Contents::cautions`].
    pub coupled: Option<String>,
}

/// Reads the text of a file that the case calls by the second argument, for a blade of the length [m] of the third.
pub type Format = fn(&str, &str, f64) -> Result<Contents, String>;

/// Share of √(Kᵢᵢ Kⱼⱼ) up to which an entry off the diagonal counts as zero.
const UNCOUPLED: f64 = 1e-6;

/// Slenderness L√(EA/EI) of a blade whose file gives no axial stiffness.
const SLENDERNESS: f64 = 100.0;

/// The rows of a file that the case calls `name`, for a blade of the given length [m].
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read(bytes: &[u8], name: &str, format: Format, length: f64) -> Result<Contents, String> {
    // Comments of old files are in whatever encoding their author had.
    let mut contents = format(&String::from_utf8_lossy(bytes), name, length)?;
    let rows = &contents.rows;
    if rows.is_empty() {
        return Err(format!("{name} holds no station"));
    }
    let stiff = |r: &BladeResultants| r.torsional_stiffness > 0.0 && !r.has_torsion();
    if rows.iter().any(|(_, r)| stiff(r)) && contents.cautions.is_empty() {
        contents.cautions.push(format!(
            "{name} gives a torsional stiffness without rotary inertias, and without these a blade has no torsion"
        ));
    }
    let twist = contents.rows.iter().fold(0.0_f64, |most, (_, r)| most.max(r.twist.abs()));
    if twist > MUCH_TWIST {
        contents.cautions.push(format!(
            "the twist in {name} reaches {:.1}°: where it is given in degrees, name the column `twist [deg]`",
            twist.to_degrees()
        ));
    }
    Ok(contents)
}

/// Largest twist that a file may give [rad]: more of it is in degrees.
const LARGEST_TWIST: f64 = std::f64::consts::PI;
/// Twist above which there is a caution [rad]; blades have less than 0.5.
const MUCH_TWIST: f64 = 1.0;

/// The numbers of a line, or what is wrong with it.
fn numbers(line: &str, number: usize, name: &str) -> Result<Vec<f64>, String> {
    let parse = |word: &str| {
        // Fortran writes exponents with D, too.
        let plain = word.replace(['d', 'D'], "e");
        plain.parse::<f64>().map_err(|_| format!("line {number} of {name}: `{word}` is not a number"))
    };
    line.split_whitespace().map(parse).collect()
}

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

/// CSV with a line of names.
///
/// # Errors
/// What is wrong with it.
pub fn csv(text: &str, name: &str, _length: f64) -> Result<Contents, String> {
    let mut rows = Vec::new();
    for v in columns::read(text, name, &COLUMNS)? {
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
        if v[8].abs() > LARGEST_TWIST {
            return Err(format!(
                "the twist of {name} at x = {} m is {} rad, more than half a revolution: for degrees name the column \
                 `twist [deg]`",
                v[0], v[8]
            ));
        }
        rows.push((v[0], resultants));
    }
    Ok(Contents { rows, ..Contents::default() })
}

/// The number before a keyword of an OpenFAST file, with its line.
fn keyword(text: &str, key: &str, name: &str) -> Result<Option<f64>, String> {
    for (i, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let (value, word) = (words.next().unwrap_or(""), words.next().unwrap_or(""));
        if word.eq_ignore_ascii_case(key) {
            return Ok(numbers(value, i + 1, name)?.first().copied());
        }
    }
    Ok(None)
}

/// The number of stations that a file announces.
fn stations(text: &str, key: &str, name: &str) -> Result<usize, String> {
    match keyword(text, key, name)? {
        Some(count) if (2.0..=1e6).contains(&count) && count.fract() == 0.0 => Ok(count as usize),
        Some(count) => Err(format!("{name} says `{key}` = {count}: a blade needs at least two stations")),
        None => Err(format!(
            "{name} has no line with `{key}`, the number of stations: is `format` that of the file, and the file that of \
                             the blade itself?"
        )),
    }
}

/// Blade file of ElastoDyn.
///
/// # Errors
/// What is wrong with it.
pub fn elastodyn(text: &str, name: &str, length: f64) -> Result<Contents, String> {
    let count = stations(text, "NBlInpSt", name)?;
    let factor = |key: &str| keyword(text, key, name).map(|found| found.unwrap_or(1.0));
    let (mass, flap, edge) = (factor("AdjBlMs")?, factor("AdjFlSt")?, factor("AdjEdSt")?);
    let mut lines = text.lines().enumerate().map(|(i, line)| (i + 1, line));
    let header = lines.by_ref().map(|(_, line)| line).find(|line| line.trim_start().starts_with("BlFract"));
    let Some(header) = header else {
        return Err(format!("{name} has no line of column names that begins with `BlFract`"));
    };
    let titles: Vec<&str> = header.split_whitespace().collect();
    let place = |title: &str| titles.iter().position(|other| other.eq_ignore_ascii_case(title));
    let needed = |title: &str| place(title).ok_or_else(|| format!("{name} has no column `{title}`"));
    let (station, twist) = (needed("BlFract")?, needed("StrcTwst")?);
    let (density, flapwise, edgewise) = (needed("BMassDen")?, needed("FlpStff")?, needed("EdgStff")?);
    let mut rows = Vec::new();
    // The line of units stands between.
    for (number, line) in lines.skip(1).take(count) {
        if line.trim_start().starts_with("---") {
            break;
        }
        let row = numbers(line, number, name)?;
        if row.len() < titles.len() {
            return Err(format!("line {number} of {name} has {} of the {} columns", row.len(), titles.len()));
        }
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
            twist: row[twist].to_radians(),
            twist_rate: 0.0,
        };
        rows.push((row[station] * length, resultants));
    }
    if rows.len() < count {
        return Err(format!("{name} announces {count} stations and holds {}", rows.len()));
    }
    Ok(Contents { rows, ..Contents::default() })
}

/// The strains of a section without shear, in the order of BeamDyn.
const STRAINS: [&str; 4] = ["stretch", "edgewise bending", "flapwise bending", "torsion"];

/// The stiffness for stretch, bending and torsion at zero shear force, K − Kₛᵀ Kₛₛ⁻¹ Kₛ; `None` for one in shear that is not
/// positive.
fn without_shear(k: &[Vec<f64>]) -> Option<[[f64; 4]; 4]> {
    let (a, b, c, d) = (k[0][0], k[0][1], k[1][0], k[1][1]);
    let determinant = a * d - b * c;
    if !(a > 0.0 && determinant > 0.0) {
        return None;
    }
    let entry = |i: usize, j: usize| {
        let solved = [d * k[0][j] - b * k[1][j], a * k[1][j] - c * k[0][j]];
        k[i][j] - (k[i][0] * solved[0] + k[i][1] * solved[1]) / determinant
    };
    Some(std::array::from_fn(|i| std::array::from_fn(|j| entry(i + 2, j + 2))))
}

/// The stiffness for strain `i` at zero force of all others, 1/(K⁻¹)ᵢᵢ: for bending that about the centre of tension.
fn alone(mut k: [[f64; 4]; 4], i: usize) -> f64 {
    for other in 0..4 {
        let pivot = k[other];
        if other == i || pivot[other] <= 0.0 {
            continue;
        }
        for row in k.iter_mut().filter(|row| **row != pivot) {
            let factor = row[other] / pivot[other];
            row.iter_mut().zip(pivot).for_each(|(entry, by)| *entry -= factor * by);
        }
    }
    k[i][i]
}

/// Blade file of BeamDyn.
///
/// # Errors
/// What is wrong with it.
pub fn beamdyn(text: &str, name: &str, length: f64) -> Result<Contents, String> {
    let count = stations(text, "station_total", name)?;
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line))
        .skip_while(|(_, line)| !line.to_ascii_lowercase().contains("distributed properties"))
        .skip(1)
        .filter(|(_, line)| !line.trim().is_empty());
    let (mut rows, mut offset) = (Vec::new(), 0.0_f64);
    let mut coupling = (UNCOUPLED, [0, 0], 0.0);
    for station in 1..=count {
        let mut next = |columns: usize, what: &str| -> Result<Vec<f64>, String> {
            let Some((number, line)) = lines.next() else {
                return Err(format!("{name} announces {count} stations and ends in station {station}"));
            };
            let row = numbers(line, number, name)?;
            if row.len() != columns {
                return Err(format!(
                    "line {number} of {name} has {} numbers for {what}, which has {columns}",
                    row.len()
                ));
            }
            Ok(row)
        };
        let fraction = next(1, "the place of a station")?[0];
        let mut matrix = |what| (0..6).map(|_| next(6, what)).collect::<Result<Vec<_>, _>>();
        let (k, m) = (matrix("a row of a stiffness matrix")?, matrix("a row of a mass matrix")?);
        let k = without_shear(&k).ok_or_else(|| {
            format!("the stiffness in shear of station {station} of {name} is not positive")
        })?;
        for i in 0..4 {
            for j in 0..i {
                let share = k[i][j].abs().max(k[j][i].abs()) / (k[i][i] * k[j][j]).abs().sqrt();
                if share > coupling.0 {
                    coupling = (share, [j, i], fraction);
                }
            }
        }
        offset = [m[0][5], m[1][5]].iter().fold(offset, |most, moment| most.max((moment / m[0][0]).abs()));
        let resultants = BladeResultants {
            mass: m[0][0],
            axial_stiffness: k[0][0],
            flap_stiffness: alone(k, 2),
            chord_stiffness: alone(k, 1),
            torsional_stiffness: alone(k, 3),
            flap_inertia: m[4][4],
            chord_inertia: m[3][3],
            twist: 0.0,
            twist_rate: 0.0,
        };
        rows.push((fraction * length, resultants));
    }
    let mut caution = format!("of {name} the stiffness in shear is not used, and it holds no twist");
    if offset > 0.0 {
        caution.push_str(&format!(
            "; the centre of mass lies up to {offset:.4} m off the axis there and on it here"
        ));
    }
    let (share, [a, b], fraction) = coupling;
    let coupled = format!(
        "the stiffness of {name} couples {} and {}, by {:.1} % of √(K₁K₂) at {fraction} of the span, and the blade has none of \
         it",
        STRAINS[a],
        STRAINS[b],
        100.0 * share
    );
    Ok(Contents { rows, cautions: vec![caution], coupled: (share > UNCOUPLED).then_some(coupled) })
}

#[cfg(test)]
mod tests {
    use super::*;

    const ELASTODYN: &str = "--- header\ncomment\n--- PARAMETERS\n 2 NBlInpSt - stations\n 1.5 AdjBlMs - mass\n 1 AdjFlSt -\n\
        2.0D0 AdjEdSt -\n--- DISTRIBUTED\n BlFract StrcTwst BMassDen FlpStff EdgStff\n (-) (deg) (kg/m) (Nm^2) (Nm^2)\n\
        0.0 13.308 678.9 1.8E+10 1.9D+10\n1.0 0.0 10.0 2e5 5e6\n--- MODE SHAPES\n0.06 BldFl1Sh(2)\n";

    #[test]
    fn an_elastodyn_file_is_read_with_its_factors() {
        let rows = elastodyn(ELASTODYN, "f", 50.0).unwrap().rows;
        assert_eq!((rows.len(), rows[1].0), (2, 50.0));
        let root = rows[0].1;
        assert!((root.mass - 1018.35).abs() < 1e-9 && root.flap_stiffness == 1.8e10);
        assert!(root.chord_stiffness == 3.8e10 && (root.axial_stiffness - 1.52e11).abs() < 1.0);
        assert!((root.twist - 0.232_268_4).abs() < 1e-6);
        for (from, to, says) in [
            (" 2 NBlInpSt", " 3 NBlInpSt", "announces 3 stations and holds 2"),
            (" 2 NBlInpSt", " 0 NBlInpSt", "at least two stations"),
            (" 2 NBlInpSt", " 2 Stations", "no line with `NBlInpSt`"),
            ("FlpStff", "FlapStff", "no column `FlpStff`"),
            ("678.9", "67x8", "line 11 of f: `67x8`"),
            (" 5e6", "", "line 12 of f has 4 of the 5 columns"),
        ] {
            let message = elastodyn(&ELASTODYN.replacen(from, to, 1), "f", 50.0).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
    }

    fn diagonal(entries: [f64; 6]) -> String {
        let row = |i: usize| {
            (0..6).map(|j| if i == j { entries[i] } else { 0.0 }.to_string() + " ").collect::<String>()
        };
        (0..6).map(|i| row(i) + "\n").collect()
    }

    #[test]
    fn a_beamdyn_file_is_read_matrix_by_matrix() {
        let station = |x: &str| {
            format!(
                "{x}\n{}\n{}\n",
                diagonal([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
                diagonal([7.0, 7.0, 7.0, 8.0, 9.0, 17.0])
            )
        };
        let text = format!(
            "--- BEAMDYN\n2 station_total - n\n1 damp_type\n--- Distributed Properties ---\n{}{}",
            station("0.0"),
            station("1.0")
        );
        let rows = beamdyn(&text, "f", 20.0).unwrap().rows;
        let r = rows[1].1;
        assert_eq!((rows.len(), rows[1].0), (2, 20.0));
        assert_eq!(
            [
                r.axial_stiffness,
                r.chord_stiffness,
                r.flap_stiffness,
                r.torsional_stiffness,
                r.mass,
                r.chord_inertia,
                r.flap_inertia
            ],
            [3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]
        );
        for (from, to, says) in [
            ("2 station_total", "3 station_total", "announces 3 stations and ends in station 3"),
            ("1 0 0 0 0 0", "0 0 0 0 0 0", "in shear of station 1"),
            ("0 0 3 0 0 0", "0 0 3 0 0", "has 5 numbers for a row of a stiffness matrix"),
        ] {
            let message = beamdyn(&text.replacen(from, to, 1), "f", 20.0).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
        assert_eq!(beamdyn(&text, "f", 20.0).unwrap().coupled, None);
        // Shear and torsion: at zero shear force a force of torsion shears, too.
        let sheared =
            text.replacen("1 0 0 0 0 0", "1 0 0 0 0 0.5", 1).replacen("0 0 0 0 0 6", "0.5 0 0 0 0 6", 1);
        let sheared = beamdyn(&sheared, "f", 20.0).unwrap();
        assert_eq!((sheared.rows[0].1.torsional_stiffness, sheared.coupled), (6.0 - 0.25, None));
        let coupled =
            text.replacen("0 0 3 0 0 0", "0 0 3 0 1.5 0", 1).replacen("0 0 0 0 5 0", "0 0 1.5 0 5 0", 1);
        let coupled = beamdyn(&coupled, "f", 20.0).unwrap();
        // The centre of tension lies off the axis: EI about it is less by (EA e)²/EA.
        assert_eq!((coupled.rows[0].1.flap_stiffness, coupled.rows[0].1.axial_stiffness), (5.0 - 0.75, 3.0));
        let coupled = coupled.coupled.unwrap();
        assert!(coupled.contains("couples stretch and flapwise bending, by 38.7 %"), "{coupled}");
    }

    #[test]
    fn a_csv_file_names_its_columns() {
        let text = "# a blade\nx, mass, EA, EI-flap, EI-chord, twist\n0, 1, 2, 3, 4, 0.1\n5, 1, 2, 3, 4, 0\n";
        let rows = csv(text, "f", 5.0).unwrap().rows;
        assert_eq!((rows.len(), rows[1].0, rows[0].1.twist, rows[0].1.flap_stiffness), (2, 5.0, 0.1, 3.0));
        for (from, to, says) in [
            ("EI-flap", "EI", "column `EI`"),
            (", EI-chord", "", "no column `EI-chord`"),
            ("5, 1", "5, one", "line 4 of f: `one`"),
            ("4, 0.1", "4, 13.3", "`twist [deg]`"),
        ] {
            let message = csv(&text.replacen(from, to, 1), "f", 5.0).unwrap_err();
            assert!(message.contains(says), "{message}");
        }
    }
}
