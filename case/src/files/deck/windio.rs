//! Blades of windIO, versions 2 and 1.
//!
//! The words of the schema (2.1: x to the trailing edge, `K44` flapwise, `i_edge` about y) and its examples contradict each other by a right
//! angle. The examples of the IEA 15 and 22 MW turbines have BeamDyn's axes: x to the suction side, K44 and i_edge about x and edgewise, `cm_y` along
//! the chord, the product of inertia `i_cp` = −M45. They are followed here, and a blade that has K44 < K55 is refused.
//!
//! Grids are fractions of the parameter of `reference_axis`, whose coordinates are natural cubic splines of it. Twist is that of BeamDyn, in degrees
//! from version 2 on and in radians before.

use super::beamdyn::LONGEST;
use super::fortran::decoded;
use super::rows::{BEAMDYN, Convention, Row};
use super::yaml::{self, Node};
use super::{Deck, Keypoints, Line, Raw, Silent};
use flexion::linalg::Vec3;
use flexion::profile::{End, Profile, Table};
use flexion::section::Matrix6;
use flexion_results::nearest;

/// BeamDyn's order with the names of windIO.
static WINDIO: Convention = Convention {
    station: "grid",
    inertia: Some(["mass", "i_plr", "i_flap", "i_edge", "cm_y", "cm_x"]),
    ..BEAMDYN
};
/// Distance of the ends of a grid from 0 and 1.
const ENDS: f64 = 1e-6;
/// Distance of the beginning of the line from the origin over its length, up to which it is rounding.
const ROOT: f64 = 1e-9;
/// Part of the span with K44 < K55 from which the axes are exchanged.
const EXCHANGED: f64 = 0.5;

/// A number along the blade.
struct Distribution {
    line: usize,
    grid: Vec<f64>,
    values: Vec<f64>,
}

impl Distribution {
    /// The value at u, on straight lines.
    fn at(&self, u: f64) -> f64 {
        let i = self.grid.partition_point(|x| *x <= u).clamp(1, self.grid.len() - 1) - 1;
        let (a, b) = (self.grid[i], self.grid[i + 1]);
        let share = if b > a { ((u - a) / (b - a)).clamp(0.0, 1.0) } else { 1.0 };
        self.values[i] + share * (self.values[i + 1] - self.values[i])
    }
}

/// A grid from 0 to 1.
fn grid(node: &Node, name: &str, what: &str) -> Result<Vec<f64>, String> {
    let Some(found) = node.get("grid") else {
        return Err(format!("line {} of {name}: `{what}` has no `grid`", node.line));
    };
    let values = found.numbers(name, &format!("{what}.grid"))?;
    let at = format!("line {} of {name}: the grid of `{what}`", found.line);
    let ascends = values.windows(2).all(|pair| pair[0] < pair[1]);
    let (Some(first), Some(last), true) = (values.first(), values.last(), ascends && values.len() > 1) else {
        return Err(format!("{at} must have two values or more, which ascend from 0 to 1"));
    };
    if !(first.abs() <= ENDS && (last - 1.0).abs() <= ENDS) {
        let guess = if (last - 100.0).abs() < 1.0 { ": is it in per cent?" } else { ": is it in metres?" };
        return Err(format!("{at} runs from {first} to {last} and must run from 0 to 1{guess}"));
    }
    Ok(values)
}

/// Values of a distribution under `key`, on the grid beside it.
fn values(node: &Node, key: &str, grid: &[f64], name: &str) -> Result<Option<Distribution>, String> {
    let Some(found) = node.get(key) else { return Ok(None) };
    let values = found.numbers(name, key)?;
    if values.len() != grid.len() {
        return Err(format!(
            "line {} of {name}: `{key}` has {} values and its grid {}",
            found.line,
            values.len(),
            grid.len()
        ));
    }
    Ok(Some(Distribution { line: found.line, grid: grid.to_vec(), values }))
}

/// The entries of a matrix of version 2: without one of them it is not known.
static STIFFNESS: [&str; 21] = [
    "K11", "K12", "K13", "K14", "K15", "K16", "K22", "K23", "K24", "K25", "K26", "K33", "K34", "K35", "K36",
    "K44", "K45", "K46", "K55", "K56", "K66",
];
static INERTIA: [&str; 7] = ["mass", "cm_x", "cm_y", "i_edge", "i_flap", "i_plr", "i_cp"];

/// The entries under their keys, all of which are there.
fn entries<const N: usize>(
    node: &Node,
    keys: &[&str; N],
    grid: &[f64],
    (name, what): (&str, &str),
) -> Result<[Distribution; N], String> {
    let mut found = Vec::with_capacity(N);
    for key in keys {
        let missing = || {
            let is_other = |other: &&str| *other != "grid" && !keys.contains(other);
            let others: Vec<String> = node.keys().filter(is_other).map(str::to_lowercase).collect();
            let near = nearest(key, others.iter().map(String::as_str));
            let near = node.keys().find(|other| near == Some(&other.to_lowercase()));
            let near = near.map_or_else(String::new, |near| format!(" (is `{near}` meant for it?)"));
            format!(
                "line {} of {name}: `{what}` has no `{key}`{near}; it has {}, of which what is zero is written as zeros",
                node.line,
                keys.join(", ")
            )
        };
        found.push(values(node, key, grid, name)?.ok_or_else(missing)?);
    }
    found.try_into().map_err(|_| String::new())
}

/// `grid` and `values` under a key.
fn distribution(node: &Node, path: &[&str], name: &str) -> Result<Option<Distribution>, String> {
    let Some(found) = node.at(path) else { return Ok(None) };
    let what = path.join(".");
    let grid = grid(found, name, &what)?;
    values(found, "values", &grid, name)?
        .map(Some)
        .ok_or_else(|| format!("line {} of {name}: `{what}` has no `values`", found.line))
}

/// The twist under a key: the matrices do not tell it, and few blades have none.
fn twist(node: &Node, path: &[&str], name: &str) -> Result<Distribution, String> {
    distribution(node, path, name)?.ok_or_else(|| {
        format!(
            "line {} of {name}: the blade has no `{}`, which turns the axes of its sections; of a blade without twist it is written as zeros",
            node.line,
            path.join(".")
        )
    })
}

/// The 21 entries of the upper triangles along the blade: line, grid, values by entry.
struct Matrices {
    lines: [usize; 6],
    grid: Vec<f64>,
    values: Vec<Matrix6>,
}

impl Matrices {
    fn at(&self, u: f64) -> Matrix6 {
        let of = |i: usize, j: usize| {
            let values = self.values.iter().map(|of| of[i][j]).collect();
            Distribution { line: 0, grid: self.grid.clone(), values }.at(u)
        };
        std::array::from_fn(|i| std::array::from_fn(|j| of(i, j)))
    }

    /// Of lists of 21 values at each station, as version 1 has them.
    fn of_lists(node: &Node, name: &str, what: &str) -> Result<Matrices, String> {
        let grid = grid(node, name, what)?;
        let rows = node.get("values").map_or(&[][..], Node::items);
        if rows.len() != grid.len() {
            return Err(format!(
                "line {} of {name}: `{what}` has {} values and a grid of {}",
                node.line,
                rows.len(),
                grid.len()
            ));
        }
        let mut values = Vec::with_capacity(rows.len());
        for row in rows {
            let numbers = row.numbers(name, what)?;
            if numbers.len() != 21 {
                return Err(format!(
                    "line {} of {name}: `{what}` has {} numbers at a station, and the upper triangle of a 6 × 6 matrix 21",
                    row.line,
                    numbers.len()
                ));
            }
            let (mut of, mut rest) = ([[0.0; 6]; 6], numbers.into_iter());
            for (i, j) in (0..6).flat_map(|i| (i..6).map(move |j| (i, j))) {
                let value = rest.next().unwrap_or(0.0);
                (of[i][j], of[j][i]) = (value, value);
            }
            values.push(of);
        }
        Ok(Matrices { lines: [node.line; 6], grid, values })
    }
}

/// Stiffness of version 2: an array for each entry.
fn stiffness(node: &Node, name: &str) -> Result<Matrices, String> {
    let grid = grid(node, name, "stiffness_matrix")?;
    let (mut all, mut lines) = (vec![[[0.0; 6]; 6]; grid.len()], [node.line; 6]);
    let found = entries(node, &STIFFNESS, &grid, (name, "stiffness_matrix"))?;
    for ((i, j), entry) in (0..6).flat_map(|i| (i..6).map(move |j| (i, j))).zip(found) {
        if i == j {
            lines[i] = entry.line;
        }
        for (of, value) in all.iter_mut().zip(entry.values) {
            (of[i][j], of[j][i]) = (value, value);
        }
    }
    Ok(Matrices { lines, grid, values: all })
}

/// Mass of version 2: mass, its centre and moments of inertia.
fn inertia(node: &Node, name: &str) -> Result<Matrices, String> {
    let grid = grid(node, name, "inertia_matrix")?;
    let mut all = vec![[[0.0; 6]; 6]; grid.len()];
    let [mass, x, y, edge, flap, polar, cross] = entries(node, &INERTIA, &grid, (name, "inertia_matrix"))?;
    let lines = [mass.line, mass.line, mass.line, edge.line, flap.line, polar.line];
    let [mass, x, y, edge, flap, polar, cross] = [mass, x, y, edge, flap, polar, cross].map(|of| of.values);
    for (k, out) in all.iter_mut().enumerate() {
        let (m, x, y) = (mass[k], x[k], y[k]);
        (0..3).for_each(|i| out[i][i] = m);
        (out[3][3], out[4][4]) = (edge[k], flap[k]);
        out[5][5] = if polar[k] > 0.0 { polar[k] } else { edge[k] + flap[k] };
        for (i, j, value) in [(0, 5, -m * y), (1, 5, m * x), (2, 3, m * y), (2, 4, -m * x), (3, 4, -cross[k])]
        {
            (out[i][j], out[j][i]) = (value, value);
        }
    }
    Ok(Matrices { lines, grid, values: all })
}

/// The line through `reference_axis`, with the twist at rows (u, angle \[rad\]).
fn line(axis: &Node, twist: &[[f64; 2]], name: &str) -> Result<(Line, Vec<(usize, Vec3)>), String> {
    let mut coordinates = Vec::with_capacity(3);
    for key in ["x", "y", "z"] {
        let found = distribution(axis, &[key], name)?;
        let found =
            found.ok_or_else(|| format!("line {} of {name}: `reference_axis` has no `{key}`", axis.line))?;
        let rows: Vec<(f64, f64)> = found.grid.iter().copied().zip(found.values.iter().copied()).collect();
        let spline = if rows.len() > 2 { Table::new(&rows, End::Natural).ok() } else { None };
        coordinates.push((found, spline));
    }
    let mut all: Vec<f64> = coordinates.iter().flat_map(|(found, _)| found.grid.iter().copied()).collect();
    all.sort_by(f64::total_cmp);
    all.dedup_by(|a, b| *a - *b <= 1e-9);
    let place = |u: f64| {
        Vec3([0, 1, 2].map(|k| {
            let (found, spline) = &coordinates[k];
            spline.as_ref().map_or_else(|| found.at(u), |spline| spline.value(u))
        }))
    };
    let points: Vec<(f64, Vec3)> = all.into_iter().map(|u| (u, place(u))).collect();
    let line = Line::through(&points, twist).map_err(|error| format!("{name}, `reference_axis`: {error}"))?;
    Ok((line, points.into_iter().map(|(_, place)| (axis.line, place)).collect()))
}

/// Reads the blade of a file.
pub(super) fn read(bytes: &[u8], name: &str) -> Result<Deck, String> {
    let tree = yaml::read(&decoded(bytes), name)?;
    let blade = tree.at(&["components", "blade"]).unwrap_or(&tree);
    let old = blade.get("elastic_properties_mb");
    let new = [&["elastic_properties"][..], &["structure", "elastic_properties"]]
        .into_iter()
        .find_map(|path| blade.at(path));
    let (of, axis, twist, k, m, degrees) = match (new, old) {
        (Some(of), _) => {
            let (Some(k), Some(m)) = (of.get("stiffness_matrix"), of.get("inertia_matrix")) else {
                let message = format!(
                    "line {} of {name}: `elastic_properties` needs `stiffness_matrix` and `inertia_matrix`",
                    of.line
                );
                return Err(message);
            };
            let twist = twist(blade, &["outer_shape", "twist"], name)?;
            (of, blade.get("reference_axis"), twist, stiffness(k, name)?, inertia(m, name)?, true)
        }
        (None, Some(old)) => {
            let Some(of) = old.get("six_x_six") else {
                return Err(format!(
                    "line {} of {name}: of `elastic_properties_mb` only `six_x_six` is read",
                    old.line
                ));
            };
            let (Some(k), Some(m)) = (of.get("stiff_matrix"), of.get("inertia_matrix")) else {
                return Err(format!(
                    "line {} of {name}: `six_x_six` needs `stiff_matrix` and `inertia_matrix`",
                    of.line
                ));
            };
            let axis = of.get("reference_axis").or_else(|| blade.at(&["outer_shape_bem", "reference_axis"]));
            let twist = if of.get("twist").is_some() {
                twist(of, &["twist"], name)?
            } else {
                twist(blade, &["outer_shape_bem", "twist"], name)?
            };
            let (k, m) = (
                Matrices::of_lists(k, name, "stiff_matrix")?,
                Matrices::of_lists(m, name, "inertia_matrix")?,
            );
            (of, axis, twist, k, m, false)
        }
        (None, None) => {
            return Err(format!(
                "{name} has no `components.blade` with `elastic_properties` (windIO 2) or `elastic_properties_mb` (windIO 1): sections from \
                 layers are not computed"
            ));
        }
    };
    let axis = axis.ok_or_else(|| format!("{name}: the blade has no `reference_axis`"))?;
    let at = twist.line;
    let twist: Vec<[f64; 2]> = twist
        .grid
        .iter()
        .zip(&twist.values)
        .map(|(u, angle)| [*u, if degrees { angle.to_radians() } else { *angle }])
        .collect();
    let (line, points) = line(axis, &twist, name)?;
    let length = line.length();
    let twist = twist.iter().map(|[u, angle]| (at, *u, angle.to_degrees())).collect();
    let mut cautions = Vec::new();
    if let Some((_, root)) = points.first().filter(|(_, root)| root.norm() > ROOT * length) {
        cautions.push(format!(
            "line {} of {name}: `reference_axis` begins at ({}, {}, {}) m, and not at the origin; its beginning is put at the `start` of the beam, which is \
             to be moved by as much where the origin is the centre of the root",
            axis.line, root[0], root[1], root[2]
        ));
    }
    let keypoints = Keypoints { name: name.to_owned(), points, twist };
    let mu = of
        .at(&["structural_damping", "mu"])
        .map(|mu| mu.numbers(name, "structural_damping.mu"))
        .transpose()?;
    let damping = mu
        .map(|mu| {
            <[f64; 6]>::try_from(mu)
                .map_err(|mu| format!("{name}: `mu` has {} numbers and not six", mu.len()))
        })
        .transpose()?;
    if let Some(mu) = damping.iter().flatten().find(|mu| !(0.0..=LONGEST).contains(*mu)) {
        let line = of.at(&["structural_damping", "mu"]).map_or(of.line, |mu| mu.line);
        return Err(format!(
            "line {line} of {name}: `mu` has a negative value or one beyond {LONGEST:e} s, {mu:e} s"
        ));
    }
    let damping = damping.filter(|mu| mu.iter().any(|mu| *mu > 0.0));
    if damping.is_none() {
        cautions.push(format!("{name} gives no damping: `structural_damping.mu` is zero or left out"));
    }
    let mut grid = k.grid.clone();
    grid.extend(&m.grid);
    grid.sort_by(f64::total_cmp);
    grid.dedup_by(|a, b| *a - *b <= 1e-9);
    let rows: Vec<Row> = grid
        .iter()
        .enumerate()
        .map(|(i, u)| Row {
            number: i + 1,
            written: *u,
            place: *u,
            lines: [k.lines, m.lines],
            stiffness: k.at(*u),
            mass: m.at(*u),
        })
        .collect();
    let exchanged: f64 = rows
        .windows(2)
        .filter(|pair| pair.iter().all(|row| row.stiffness[3][3] < row.stiffness[4][4]))
        .map(|pair| pair[1].place - pair[0].place)
        .sum();
    if exchanged > EXCHANGED {
        let chord = distribution(blade, &["outer_shape", "chord"], name)?.map_or_else(String::new, |chord| {
            let (largest, at) =
                chord.values.iter().fold((0.0_f64, chord.line), |most, x| (most.0.max(*x), most.1));
            format!(", though its chord, of up to {largest:.3} m by line {at}, is larger than its thickness")
        });
        return Err(format!(
            "line {} of {name}: K44 is smaller than K55 over {:.0} % of the span{chord}. The examples of windIO have BeamDyn's axes, K44 edgewise, \
             and its schema calls K44 flapwise: exchange the rows and columns 1 with 2 and 4 with 5, and cm_x, i_edge with cm_y, i_flap",
            k.lines[3],
            100.0 * exchanged
        ));
    }
    let (notes, silent) = (Vec::new(), Silent::default());
    Raw { name, convention: &WINDIO, line, keypoints, rows, damping, cautions, notes, silent }.deck()
}
