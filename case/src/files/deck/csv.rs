//! Tables of sections in CSV, with titles and units: 6 × 6 matrices, or stiffnesses with places of centres.
//!
//! Components are those of this program: axes tangent, height, across, and strains axial, shear along the height, shear across, torsion, bending
//! about the height (flapwise) and about across (edgewise). The blade is straight; its twist is positive about the axis towards the tip.

use super::rows::{Convention, Row};
use super::{Deck, Line, Raw};
use crate::files::columns::{self, Column, column};
use crate::units::{
    ANGLE, AXIAL_STIFFNESS, BENDING_STIFFNESS, COUPLING_STIFFNESS, LENGTH, MASS_PER_LENGTH, ROTARY_INERTIA,
};
use flexion::section::{Matrices, Matrix6};

static CSV: Convention = Convention {
    place: [0, 1, 2, 3, 4, 5],
    sign: [1.0; 6],
    station: "x",
    inertia: Some([
        "mass",
        "inertia-flap and inertia-chord",
        "inertia-flap",
        "inertia-chord",
        "mass-y",
        "mass-z",
    ]),
};

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
    column("mass", &["massperlength", "rhoa"], &MASS_PER_LENGTH, true),
    column("mass-y", &[], &LENGTH, false),
    column("mass-z", &[], &LENGTH, false),
    column("inertia-flap", &["flpiner", "flapinertia"], &ROTARY_INERTIA, true),
    column("inertia-chord", &["edginer", "inertiaedge", "edgeinertia"], &ROTARY_INERTIA, true),
    column("inertia-product", &[], &ROTARY_INERTIA, false),
    column("polar-inertia", &[], &ROTARY_INERTIA, false),
    column("twist", &[], &ANGLE, false),
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
    column("mass", &["massperlength", "rhoa"], &MASS_PER_LENGTH, true),
    column("mass-y", &[], &LENGTH, false),
    column("mass-z", &[], &LENGTH, false),
    column("inertia-flap", &["flpiner", "flapinertia"], &ROTARY_INERTIA, true),
    column("inertia-chord", &["edginer", "inertiaedge", "edgeinertia"], &ROTARY_INERTIA, true),
    column("inertia-product", &[], &ROTARY_INERTIA, false),
    column("polar-inertia", &[], &ROTARY_INERTIA, false),
    column("twist", &[], &ANGLE, false),
    column("EA", &["eastff", "axialstiffness"], &AXIAL_STIFFNESS, true),
    column("GA-chord", &["gaedge"], &AXIAL_STIFFNESS, true),
    column("GA-flap", &[], &AXIAL_STIFFNESS, true),
    column("GJ", &["gjstff", "torsionalstiffness"], &BENDING_STIFFNESS, true),
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

/// Reads a table; one with a column `K11` has matrices.
pub(super) fn read(bytes: &[u8], name: &str) -> Result<Deck, String> {
    let text = super::fortran::decoded(bytes);
    let header = text.lines().find(|line| !line.trim_start().starts_with('#')).unwrap_or("");
    let is_full = header.split(',').any(|title| columns::plain(columns::parts(title.trim()).0) == "k11");
    // Values before those of the stiffness are the same in both.
    let made: Vec<([f64; 9], Matrix6)> = if is_full {
        let full = |row: [f64; 30]| {
            let (mut k, mut values) = ([[0.0; 6]; 6], row[9..].iter());
            for (i, j) in (0..6).flat_map(|i| (i..6).map(move |j| (i, j))) {
                let value = values.next().copied().unwrap_or(0.0);
                (k[i][j], k[j][i]) = (value, value);
            }
            (std::array::from_fn(|i| row[i]), k)
        };
        columns::read(&text, name, &FULL)?.into_iter().map(full).collect()
    } else {
        let centres = |row: [f64; 19]| {
            let stiffness = [row[9], row[10], row[11], row[12], row[13], row[14]];
            let of = Matrices::principal(stiffness, 1.0, [1.0; 3]);
            let of = of.with_shear_centre([row[17], row[18]]).with_tension_centre([row[15], row[16]]);
            (std::array::from_fn(|i| row[i]), of.stiffness)
        };
        columns::read(&text, name, &CENTRES)?.into_iter().map(centres).collect()
    };
    let [first, .., last] = &made[..] else {
        return Err(format!("{name} has {} rows, and a blade two or more", made.len()));
    };
    let (from, to) = (first.0[0], last.0[0]);
    if !(from == 0.0 && to > 0.0) {
        return Err(format!(
            "the rows of {name} run from x = {from} m to {to} m, and must begin at 0 and ascend"
        ));
    }
    let twist: Vec<[f64; 2]> = made.iter().map(|(v, _)| [v[0], -v[8]]).collect();
    if let Some(i) = made.windows(2).position(|pair| !(pair[0].0[0] <= pair[1].0[0])) {
        return Err(format!(
            "row {} of {name}: x = {} m comes behind {} m; rows ascend",
            i + 2,
            made[i + 1].0[0],
            made[i].0[0]
        ));
    }
    let line = Line::straight(to, &twist)?;
    let row = |(i, (v, stiffness)): (usize, ([f64; 9], Matrix6))| {
        let [x, m, y, z, flap, chord, product, polar, _] = v;
        let mut mass = [[0.0; 6]; 6];
        (0..3).for_each(|i| mass[i][i] = m);
        let polar = if polar > 0.0 { polar } else { flap + chord };
        (mass[3][3], mass[4][4], mass[5][5]) =
            (polar + m * (y * y + z * z), flap + m * z * z, chord + m * y * y);
        for (i, j, value) in
            [(0, 4, m * z), (0, 5, -m * y), (1, 3, -m * z), (2, 3, m * y), (4, 5, -product - m * y * z)]
        {
            (mass[i][j], mass[j][i]) = (value, value);
        }
        Row { number: i + 1, written: x, place: x, lines: [[i + 2; 6]; 2], stiffness, mass }
    };
    let rows = made.into_iter().enumerate().map(row).collect();
    Raw { name, convention: &CSV, line, rows, damping: None, cautions: Vec::new(), notes: Vec::new() }.deck()
}
