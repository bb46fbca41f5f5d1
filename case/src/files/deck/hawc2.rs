//! Structural data of HAWC2 (`st` files): full 6 × 6 matrices (FPM) or the classical columns.
//!
//! Distances are from the half chord, in its axes x (chordwise, to the leading edge) and y (to the suction side), z along the blade. Stiffnesses
//! are those at the elastic centre (x_e, y_e), in shear and torsion of the classical columns at the shear centre, about axes rotated by `pitch` about
//! z, the principal bending axes. With the strains (γ_x, γ_y, ε, κ_x, κ_y, κ_z) of the half chord, those there are T W e:
//!
//! ```text
//! W:  γ_x − y_s κ_z,  γ_y + x_s κ_z,  ε + y_e κ_x − x_e κ_y;      T: a rotation of (x, y) by the pitch;      K = Wᵀ Tᵀ K_e T W
//! ```
//!
//! Radii of gyration are about the elastic centre and the axes x_e and y_e, as in the manual. In the deck of the IEA 22 MW turbine they are about the
//! elastic centre (moments to 0.4 % over the outer 70 % of the span, up to 13 % off about the centre of mass); in that of the IEA 15 MW turbine they
//! are about the centre of mass, so that its edgewise and polar moments are too small, by less than 15 %.
//!
//! Columns: HAWC2's manual, *How 2 HAWC2* (Larsen & Hansen, DTU R-1597), as `wetb` of DTU has them; axes by comparison of both decks of the IEA
//! 15 MW turbine.

use super::fortran::{Text, words};
use super::rows::{Convention, Row};
use super::{Deck, FARTHEST, Keypoints, Line, Raw, Silent, within};
use flexion::section::Matrix6;
use std::fmt::Write;

/// (tangent, height, across) = (z, −x, −y).
pub(super) static HAWC2: Convention = Convention {
    place: [2, 0, 1, 5, 3, 4],
    sign: [1.0, -1.0, -1.0, 1.0, -1.0, -1.0],
    station: "r",
    stiffness: None,
    inertia: Some(["m", "ri_x, ri_y", "ri_x", "ri_y", "x_cg", "y_cg"]),
    twists: false,
};

/// Columns of full matrices and of the classical form.
const COLUMNS: [usize; 2] = [30, 19];
/// Largest `pitch` \[°\].
const REVOLUTION: f64 = 360.0;
/// Distance of the first station from the root over the length.
const ROOT: f64 = 1e-4;

/// The rows of a table that begins in line `at`: of a line and numbers, with which of both forms they have.
fn table(text: &Text<'_>, mut at: usize, count: usize) -> Result<Vec<(usize, Vec<f64>)>, String> {
    let name = text.name;
    let Some(first) = text.next_with_number(at) else {
        return Err(format!("{name} ends behind line {}, which announces {count} rows", at - 1));
    };
    let numbers = |line: usize| {
        words(text.line(line)).iter().take_while(|word| super::fortran::number(word).is_some()).count()
    };
    let width = numbers(first);
    if !COLUMNS.contains(&width) {
        return Err(format!(
            "line {first} of {name} has {width} numbers; a row has 30 with full matrices (r, m, x_cg, y_cg, ri_x, ri_y, pitch, x_e, y_e, K11 … \
             K66) and 19 without"
        ));
    }
    let rows = (1..=count)
        .map(|number| {
            let row = text.row(&mut at, width, &format!("row {number} of {count}"))?;
            if row.surplus > 0 {
                return Err(format!(
                    "line {} of {name} has more than the {width} numbers of the rows before it",
                    row.line
                ));
            }
            Ok((row.line, row.values))
        })
        .collect::<Result<Vec<_>, String>>()?;
    // Another subset has a line of its own.
    let of_this = |line: &usize| {
        numbers(*line) == width && (at..*line).all(|i| !text.line(i).trim_start().starts_with(['$', '#']))
    };
    if let Some(further) = text.next_with_number(at).filter(of_this) {
        return Err(format!(
            "line {further} of {name} is a row behind the {count} rows that the line of `$` announces"
        ));
    }
    Ok(rows)
}

/// K in the axes of the half chord, of K in axes rotated by an angle about z at the centres.
fn moved(k: &Matrix6, pitch: f64, elastic: [f64; 2], shear: [f64; 2]) -> Matrix6 {
    let (sin, cos) = libm::sincos(pitch);
    let mut turn = [[0.0; 6]; 6];
    for at in [0, 3] {
        (turn[at][at], turn[at][at + 1]) = (cos, sin);
        (turn[at + 1][at], turn[at + 1][at + 1]) = (-sin, cos);
        turn[at + 2][at + 2] = 1.0;
    }
    let mut shift: Matrix6 = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    (shift[2][3], shift[2][4]) = (elastic[1], -elastic[0]);
    (shift[0][5], shift[1][5]) = (-shear[1], shear[0]);
    congruent(k, &product(&turn, &shift))
}

fn product(a: &Matrix6, b: &Matrix6) -> Matrix6 {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| a[i][k] * b[k][j]).sum()))
}

/// Wᵀ K W
fn congruent(k: &Matrix6, w: &Matrix6) -> Matrix6 {
    let transposed: Matrix6 = std::array::from_fn(|i| std::array::from_fn(|j| w[j][i]));
    product(&transposed, &product(k, w))
}

/// The mass matrix of a mass per length at (x, y) whose radii of gyration are about axes through the elastic centre that are rotated by an angle.
fn mass(m: f64, [x, y]: [f64; 2], elastic: [f64; 2], radii: [f64; 2], pitch: f64) -> Matrix6 {
    let [a, b] = radii.map(|r| m * r * r);
    let (sin, cos) = libm::sincos(pitch);
    // From the elastic centre to the centre of mass and on to the half chord.
    let moved = |p: f64, q: f64| -(p - elastic[0]) * (q - elastic[1]) + p * q;
    let [xx, yy] = [y * y - (y - elastic[1]).powi(2), x * x - (x - elastic[0]).powi(2)];
    let mut out = [[0.0; 6]; 6];
    (0..3).for_each(|i| out[i][i] = m);
    out[3][3] = cos * cos * a + sin * sin * b + m * xx;
    out[4][4] = sin * sin * a + cos * cos * b + m * yy;
    out[5][5] = out[3][3] + out[4][4];
    let xy = sin * cos * (a - b) - m * moved(x, y);
    for (i, j, value) in [(0, 5, -m * y), (1, 5, m * x), (2, 3, m * y), (2, 4, -m * x), (3, 4, xy)] {
        (out[i][j], out[j][i]) = (value, value);
    }
    out
}

/// Reads subset `subset` of set `set`, the first where they are not given.
pub(super) fn read(
    bytes: &[u8],
    name: &str,
    set: Option<usize>,
    subset: Option<usize>,
) -> Result<Deck, String> {
    let text = Text::new(bytes, name);
    let mut found = Vec::new();
    let mut here = None;
    for at in 1..=text.len() {
        let line = text.line(at).trim_start();
        let numbers =
            |rest: &str| -> Vec<usize> { words(rest).iter().map_while(|word| word.parse().ok()).collect() };
        if let Some(rest) = line.strip_prefix('#') {
            here = numbers(rest).first().copied();
        } else if let Some(rest) = line.strip_prefix('$') {
            let (Some(set), [number, count, ..]) = (here, &numbers(rest)[..]) else {
                return Err(format!(
                    "line {at} of {name}: `$` is followed by the number of a subset and that of its rows, behind a line of `#` and the number of \
                     the set"
                ));
            };
            found.push((set, *number, *count, at + 1));
        }
    }
    let is = |asked: Option<usize>, number: usize| asked.is_none_or(|asked| asked == number);
    let Some((_, _, count, at)) = found.iter().copied().find(|(s, n, ..)| is(set, *s) && is(subset, *n))
    else {
        let known: Vec<String> = found.iter().map(|(set, number, ..)| format!("{set} {number}")).collect();
        return Err(match &known[..] {
            [] => format!(
                "{name} has no set: a line of `#` and a number, and behind it one of `$`, a number and the count of rows"
            ),
            _ => format!("{name} has no such set and subset; it has {}", known.join(", ")),
        });
    };
    if !(2..=1_000_000).contains(&count) {
        return Err(format!("line {} of {name}: a blade has two rows or more, and not {count}", at - 1));
    }
    let rows = table(&text, at, count)?;
    let (first, last) = (rows[0].1[0], rows[count - 1].1[0]);
    let length = last - first;
    if !(length > 0.0 && first.abs() <= ROOT * length) {
        return Err(format!(
            "line {} of {name}: the rows run from r = {first} m to {last} m, and must begin at 0 and ascend",
            rows[0].0
        ));
    }
    let mut made: Vec<Row> = Vec::with_capacity(count);
    for (number, (line, v)) in rows.iter().enumerate() {
        if made.last().is_some_and(|before| !(v[0] >= before.written)) {
            return Err(format!(
                "line {line} of {name}: r = {} m comes behind {} m; rows ascend",
                v[0],
                made[number - 1].written
            ));
        }
        if !(v[1] > 0.0) {
            return Err(format!("line {line} of {name}: m = {} kg/m must be positive", v[1]));
        }
        let full = v.len() == COLUMNS[0];
        let centres = if full { [("x_e", v[7]), ("y_e", v[8])] } else { [("x_e", v[17]), ("y_e", v[18])] };
        let lengths = [("r", v[0]), ("x_cg", v[2]), ("y_cg", v[3]), ("ri_x", v[4]), ("ri_y", v[5])];
        for (what, value) in lengths.into_iter().chain(centres) {
            within(*line, name, what, value, FARTHEST)?;
        }
        let (pitch, elastic) = if full { (v[6], [v[7], v[8]]) } else { (v[16], [v[17], v[18]]) };
        if !(pitch.abs() <= REVOLUTION) {
            return Err(format!(
                "line {line} of {name}: pitch = {pitch:.4e}° is more than a revolution; it turns the axes of bending and is an angle in degrees"
            ));
        }
        let pitch = pitch.to_radians();
        let mut k = [[0.0; 6]; 6];
        let shear = if full {
            let mut values = v[9..].iter();
            for (i, j) in (0..6).flat_map(|i| (i..6).map(move |j| (i, j))) {
                let value = values.next().copied().unwrap_or(0.0);
                (k[i][j], k[j][i]) = (value, value);
            }
            elastic
        } else {
            let (young, shear, area) = (v[8], v[9], v[15]);
            let diagonal = [
                v[13] * shear * area,
                v[14] * shear * area,
                young * area,
                young * v[10],
                young * v[11],
                shear * v[12],
            ];
            (0..6).for_each(|i| k[i][i] = diagonal[i]);
            [v[6], v[7]]
        };
        made.push(Row {
            number: number + 1,
            written: v[0],
            place: v[0] - first,
            lines: [[*line; 6]; 2],
            stiffness: moved(&k, pitch, elastic, shear),
            mass: mass(v[1], [v[2], v[3]], elastic, [v[4], v[5]], pitch),
        });
    }
    let line = Line::straight(length, &[])?;
    let notes = vec![format!(
        "{name} has no line and no twist, which stand in another file (`c2_def`): the blade is straight along the half chord; and no damping"
    )];
    Raw {
        name,
        convention: &HAWC2,
        line,
        keypoints: Keypoints { name: name.to_owned(), ..Keypoints::default() },
        rows: made,
        damping: None,
        cautions: Vec::new(),
        notes,
        silent: Silent::default(),
    }
    .deck()
}

/// A st file of one set with full matrices, of a deck.
///
/// The elastic centre is where the tension couples with no bending; axes are the principal ones of bending there. Inertias are the moments
/// about these axes. Their product, and what the polar moment has beside their sum, for which the format has no place, are left out: the largest
/// of both over that sum about the centre of mass is returned. Line, twist and damping do not belong to the format.
pub fn write(deck: &Deck, title: &str) -> (String, [f64; 2]) {
    let mut rows = String::new();
    let mut left_out = [0.0_f64; 2];
    for (s, section) in deck.table.rows() {
        let (k, m) = (HAWC2.outward(&section.stiffness), HAWC2.outward(&section.mass));
        let [x, y] = [-k[2][4] / k[2][2], k[2][3] / k[2][2]];
        // To the centre and back are shifts of opposite sign.
        let centred = moved(&k, 0.0, [-x, -y], [-x, -y]);
        let mut pitch = 0.5 * libm::atan2(2.0 * centred[3][4], centred[3][3] - centred[4][4]);
        // The axis x_e is the one closer to x.
        if pitch.abs() > 0.25 * std::f64::consts::PI {
            pitch -= 0.5 * std::f64::consts::PI * pitch.signum();
        }
        let turned = moved(&centred, -pitch, [0.0; 2], [0.0; 2]);
        let size = m[0][0];
        let centre = [-m[2][4] / size, m[2][3] / size];
        // About the centre of mass and on to the elastic centre.
        let [p, q] = [centre[0] - x, centre[1] - y];
        let xx = m[3][3] + size * (q * q - centre[1] * centre[1]);
        let yy = m[4][4] + size * (p * p - centre[0] * centre[0]);
        let xy = m[3][4] + size * (centre[0] * centre[1] - p * q);
        let (sin, cos) = libm::sincos(pitch);
        let radii = [
            cos * cos * xx + sin * sin * yy + 2.0 * sin * cos * xy,
            sin * sin * xx + cos * cos * yy - 2.0 * sin * cos * xy,
        ]
        .map(|inertia| (inertia / size).max(0.0).sqrt());
        let product = (cos * cos - sin * sin) * xy + sin * cos * (yy - xx);
        let beside = m[5][5] - m[3][3] - m[4][4];
        let sum = m[3][3] + m[4][4] - size * (centre[0] * centre[0] + centre[1] * centre[1]);
        for (most, part) in left_out.iter_mut().zip([product, beside]) {
            *most = most.max((part / sum).abs());
        }
        let mut values = vec![*s, size, centre[0], centre[1], radii[0], radii[1], pitch.to_degrees(), x, y];
        values.extend((0..6).flat_map(|i| (i..6).map(move |j| (i, j))).map(|(i, j)| turned[i][j]));
        let row: Vec<String> = values.iter().map(|value| format!("{value:20.13e}")).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(rows, "{}", row.join(" "));
    }
    let titles = "r m x_cg y_cg ri_x ri_y pitch x_e y_e K11 K12 K13 K14 K15 K16 K22 K23 K24 K25 K26 K33 K34 K35 K36 K44 K45 K46 K55 K56 K66";
    let text = format!(
        "1 ; number of sets, {title}\n-----\n#1 ; set number\n{titles}\n$1 {}\n{rows}",
        deck.table.rows().len()
    );
    (text, left_out)
}
