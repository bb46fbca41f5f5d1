//! Tables of sections in CSV, with titles and units: 6 × 6 matrices, or stiffnesses with places of centres.
//!
//! Components are those of this program: axes tangent, height, across, and strains axial, shear along the height, shear across, torsion, bending
//! about the height (flapwise) and about across (edgewise). The blade is straight; its twist is positive about the axis from root to tip.
//!
//! What a table of centres leaves out, or gives as 0 in all rows, of the stiffness in shear and torsion and the moments of inertia, it is
//! [silent](Silent) on. For these its sections have GA = EA, GJ the smaller EI, and the radii of gyration √(EI/EA).

use super::rows::{Convention, Row};
use super::{Deck, FARTHEST, Keypoints, Line, Raw, Silent, TURNED, within};
use crate::files::columns::{self, Column, column};
use crate::units::{
    ANGLE, AXIAL_STIFFNESS, BENDING_STIFFNESS, COUPLING_STIFFNESS, LENGTH, MASS_PER_LENGTH, ROTARY_INERTIA,
};
use flexion::section::{Matrices, Matrix6};

pub(super) const CSV: Convention = Convention {
    place: [0, 1, 2, 3, 4, 5],
    sign: [1.0; 6],
    station: "x",
    stiffness: None,
    inertia: Some(["mass", "polar-inertia", "inertia-flap", "inertia-chord", "mass-y", "mass-z"]),
    twists: false,
};
static OF_CSV: Convention = CSV;

const fn force(name: &'static str, required: bool) -> Column {
    column(name, &[], &AXIAL_STIFFNESS, required)
}

const fn couple(name: &'static str) -> Column {
    column(name, &[], &COUPLING_STIFFNESS, false)
}

const fn bend(name: &'static str, required: bool) -> Column {
    column(name, &[], &BENDING_STIFFNESS, required)
}

/// The upper triangle by rows.
static FULL: [Column; 30] = [
    column("x", &["s", "span", "station"], &LENGTH, true),
    column("mass", &["massperlength", "bmassden", "rhoa"], &MASS_PER_LENGTH, true),
    column("mass-y", &[], &LENGTH, false),
    column("mass-z", &[], &LENGTH, false),
    column("inertia-flap", &["flpiner", "flapinertia"], &ROTARY_INERTIA, true),
    column("inertia-chord", &["edginer", "inertiaedge", "edgeinertia"], &ROTARY_INERTIA, true),
    column("inertia-product", &[], &ROTARY_INERTIA, false),
    column("polar-inertia", &[], &ROTARY_INERTIA, false),
    column("twist", &["strctwst"], &ANGLE, false),
    force("K11", true),
    force("K12", false),
    force("K13", false),
    couple("K14"),
    couple("K15"),
    couple("K16"),
    force("K22", true),
    force("K23", false),
    couple("K24"),
    couple("K25"),
    couple("K26"),
    force("K33", true),
    couple("K34"),
    couple("K35"),
    couple("K36"),
    bend("K44", true),
    bend("K45", false),
    bend("K46", false),
    bend("K55", true),
    bend("K56", false),
    bend("K66", true),
];

static CENTRES: [Column; 19] = [
    column("x", &["s", "span", "station"], &LENGTH, true),
    column("mass", &["massperlength", "bmassden", "rhoa"], &MASS_PER_LENGTH, true),
    column("mass-y", &[], &LENGTH, false),
    column("mass-z", &[], &LENGTH, false),
    column("inertia-flap", &["flpiner", "flapinertia"], &ROTARY_INERTIA, false),
    column("inertia-chord", &["edginer", "inertiaedge", "edgeinertia"], &ROTARY_INERTIA, false),
    column("inertia-product", &[], &ROTARY_INERTIA, false),
    column("polar-inertia", &[], &ROTARY_INERTIA, false),
    column("twist", &["strctwst"], &ANGLE, false),
    column("EA", &["eastff", "axialstiffness"], &AXIAL_STIFFNESS, true),
    column("GA-chord", &["gaedge"], &AXIAL_STIFFNESS, false),
    column("GA-flap", &[], &AXIAL_STIFFNESS, false),
    column("GJ", &["gjstff", "torsionalstiffness"], &BENDING_STIFFNESS, false),
    column("EI-flap", &["flpstff", "flapstiffness", "flapwisestiffness"], &BENDING_STIFFNESS, true),
    column(
        "EI-chord",
        &["edgstff", "eiedge", "edgestiffness", "edgewisestiffness"],
        &BENDING_STIFFNESS,
        true,
    ),
    column("tension-y", &[], &LENGTH, false),
    column("tension-z", &[], &LENGTH, false),
    column("shear-y", &[], &LENGTH, false),
    column("shear-z", &[], &LENGTH, false),
];

/// Largest twist \[rad\] of a column without a unit, and that above which there is a caution: blades have less than 0.5.
const TWIST: [f64; 2] = [std::f64::consts::PI, 1.0];

/// A row of a table.
struct Given {
    line: usize,
    /// The columns that both kinds of table begin with: x to twist.
    values: [f64; 9],
    stiffness: Matrix6,
}

/// Reads a table; one with a column `K11` has matrices.
pub(super) fn read(bytes: &[u8], name: &str) -> Result<Deck, String> {
    let text = super::fortran::decoded(bytes);
    let is_title = |line: &&str| !line.trim_start().starts_with('#') && !line.trim().is_empty();
    let titles =
        text.lines().find(is_title).unwrap_or("").split(',').map(|title| columns::parts(title.trim()));
    let titles: Vec<(String, Option<&str>)> =
        titles.map(|(title, unit)| (columns::plain(title), unit)).collect();
    let is_full = titles.iter().any(|(title, _)| title == "k11");
    let mut cautions = Vec::new();
    let mut twisted = |line: usize, twist: f64| {
        if !titles.iter().any(|(title, unit)| title == "twist" && unit.is_none()) || twist.abs() <= TWIST[1] {
            return Ok(());
        }
        if twist.abs() > TWIST[0] {
            return Err(format!(
                "line {line} of {name}: the twist is {twist} rad, more than half a revolution: for degrees name the column `twist [deg]`"
            ));
        }
        cautions.push(format!(
            "line {line} of {name}: the twist is {twist} rad, {:.1}°: where it is given in degrees, name the column `twist [deg]`",
            twist.to_degrees()
        ));
        Ok(())
    };
    let most =
        |rows: &mut dyn Iterator<Item = (usize, f64)>| rows.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    if !is_full {
        let rows = columns::with_lines(&text, name, &CENTRES)?;
        let (line, twist) = most(&mut rows.iter().map(|(line, row)| (*line, row[8]))).unwrap_or_default();
        twisted(line, twist)?;
        return of_centres(name, rows, cautions, &OF_CSV, false);
    }
    let full = |(line, row): (usize, [f64; 30])| {
        let (mut stiffness, mut values) = ([[0.0; 6]; 6], row[9..].iter());
        for (i, j) in (0..6).flat_map(|i| (i..6).map(move |j| (i, j))) {
            let value = values.next().copied().unwrap_or(0.0);
            (stiffness[i][j], stiffness[j][i]) = (value, value);
        }
        Given { line, values: std::array::from_fn(|i| row[i]), stiffness }
    };
    let made: Vec<Given> = columns::with_lines(&text, name, &FULL)?.into_iter().map(full).collect();
    let (line, twist) = most(&mut made.iter().map(|of| (of.line, of.values[8]))).unwrap_or_default();
    twisted(line, twist)?;
    deck(name, made, Silent::default(), (cautions, &OF_CSV))
}

/// The deck of the rows of a table of centres, each with its line; `axial` is whether the file says no axial stiffness.
pub(super) fn of_centres(
    name: &str,
    rows: Vec<(usize, [f64; 19])>,
    cautions: Vec<String>,
    convention: &'static Convention,
    axial: bool,
) -> Result<Deck, String> {
    let none = |i: usize| rows.iter().all(|(_, row)| row[i] == 0.0);
    let silent = Silent {
        axial,
        shear: none(10) && none(11),
        torsion: none(12),
        inertia: [none(4) && none(5) && none(7), none(4), none(5)],
    };
    let made = rows.into_iter().map(|(line, row)| centres(line, row, silent)).collect();
    deck(name, made, silent, (cautions, convention))
}

/// The deck of rows by their places.
fn deck(
    name: &str,
    made: Vec<Given>,
    silent: Silent,
    (cautions, convention): (Vec<String>, &'static Convention),
) -> Result<Deck, String> {
    let [first, .., last] = &made[..] else {
        return Err(format!("{name} has {} rows, and a blade two or more", made.len()));
    };
    for of in &made {
        let lengths = [("x", of.values[0]), ("mass-y", of.values[2]), ("mass-z", of.values[3])];
        lengths.into_iter().try_for_each(|(what, value)| within(of.line, name, what, value, FARTHEST))?;
        within(of.line, name, "twist in degrees", of.values[8].to_degrees(), TURNED)?;
    }
    let (from, to) = (first.values[0], last.values[0]);
    if let Some(pair) = made.windows(2).find(|pair| !(pair[0].values[0] <= pair[1].values[0])) {
        return Err(format!(
            "line {} of {name}: x = {} m comes behind {} m; rows ascend",
            pair[1].line, pair[1].values[0], pair[0].values[0]
        ));
    }
    if !(from == 0.0 && to > 0.0) {
        return Err(format!(
            "line {} of {name}: the rows run from x = {from} m to {to} m, and must begin at 0 and ascend",
            first.line
        ));
    }
    let twist: Vec<[f64; 2]> = made.iter().map(|of| [of.values[0], -of.values[8]]).collect();
    let line = Line::straight(to, &twist)?;
    let rows = made.iter().enumerate().map(|(i, of)| row(i, of)).collect();
    // ElastoDyn's twist is positive about the axis towards the root.
    let sense = if convention.twists { -1.0 } else { 1.0 };
    let twist = made.iter().map(|of| (of.line, of.values[0], sense * of.values[8].to_degrees())).collect();
    let keypoints = Keypoints { name: name.to_owned(), points: Vec::new(), twist };
    let (damping, notes) = (None, Vec::new());
    Raw { name, convention, line, keypoints, rows, damping, cautions, notes, silent }.deck()
}

/// A row of a table of centres.
fn centres(line: usize, mut row: [f64; 19], silent: Silent) -> Given {
    let [mass, axial, flap, chord] = [row[1], row[9], row[13], row[14]];
    if silent.shear {
        (row[10], row[11]) = (axial, axial);
    }
    if row[7] == 0.0 && !silent.inertia[0] {
        row[7] = row[4] + row[5];
    }
    if silent.torsion {
        row[12] = flap.abs().min(chord.abs());
    }
    for (k, bending) in [(1, flap), (2, chord)] {
        if silent.inertia[k] {
            row[3 + k] = (mass * bending / axial).abs();
        }
    }
    let of = Matrices::principal([row[9], row[10], row[11], row[12], row[13], row[14]], 1.0, [1.0; 3]);
    let of = of.with_shear_centre([row[17], row[18]]).with_tension_centre([row[15], row[16]]);
    Given { line, values: std::array::from_fn(|i| row[i]), stiffness: of.stiffness }
}

fn row(i: usize, of: &Given) -> Row {
    let [x, m, y, z, flap, chord, product, polar, _] = of.values;
    let mut mass = [[0.0; 6]; 6];
    (0..3).for_each(|i| mass[i][i] = m);
    let polar = if polar > 0.0 { polar } else { flap + chord };
    (mass[3][3], mass[4][4], mass[5][5]) = (polar + m * (y * y + z * z), flap + m * z * z, chord + m * y * y);
    for (i, j, value) in
        [(0, 4, m * z), (0, 5, -m * y), (1, 3, -m * z), (2, 3, m * y), (4, 5, -product - m * y * z)]
    {
        (mass[i][j], mass[j][i]) = (value, value);
    }
    Row { number: i + 1, written: x, place: x, lines: [[of.line; 6]; 2], stiffness: of.stiffness, mass }
}
