//! The start: whether the bodies fit their joints, which rows follow from others, and velocities that obey the rows.

use super::constants::Constants;
use super::error::{DependentRow, ModelError, Violation};
use crate::linalg::vector::{axpy, dot};
use crate::linalg::{Matrix, Vec3};
use crate::system::{Dynamics, RowWeights, State, Weights};
use std::ops::Range;

/// Displacement of markers, over the largest arm, and cosine of an angle that count as rounding.
const FITTING: f64 = 1e-9;
/// Part of a row that must be independent of the others.
const INDEPENDENT: f64 = 1e-9;
/// Least singular value of rows that are independent beyond doubt, and powers by which it is found.
const CERTAIN: f64 = 1e-6;
const POWERS: usize = 8;
/// Part by which velocities and accelerations that redundant rows ask for may differ.
const SAME: f64 = 1e-6;

/// Refuses joints whose markers do not coincide.
pub(super) fn positions(
    system: &mut dyn Dynamics,
    constants: &Constants,
    s: &State,
) -> Result<(), ModelError> {
    let mut g = vec![0.0; s.lambda.len()];
    system.constraint(s, RowWeights::POSITION, &mut g);
    let scale = system.length();
    let mut violations = Vec::new();
    for (number, (joint, rows)) in constants.model.joints.iter().zip(&constants.of_joint).enumerate() {
        let (mut length, mut angle) = (0.0_f64, 0.0_f64);
        for i in rows.clone() {
            let largest = if constants.rows[i].1.is_length() { &mut length } else { &mut angle };
            *largest = largest.max(g[i].abs());
        }
        if !(length <= FITTING * scale && angle <= FITTING) {
            violations.push(Violation { number, joint: joint.name.clone(), length, angle });
        }
    }
    violations.sort_by(|a, b| (b.length + b.angle).total_cmp(&(a.length + a.angle)));
    if violations.is_empty() { Ok(()) } else { Err(ModelError::Positions { violations }) }
}

/// A row of the jacobian as a vector.
pub(super) fn rows(system: &mut dyn Dynamics, s: &State) -> Vec<Vec<(usize, f64)>> {
    let mut out = vec![Vec::new(); system.size().lambda];
    system.jacobian(s, &mut |row, velocities, entries| {
        out[row].extend(velocities.iter().copied().zip(entries.iter().copied()));
    });
    out
}

/// A row that follows from others.
pub(super) struct Redundant {
    pub(super) row: usize,
    /// What it is, and the joints that it follows from.
    pub(super) of: DependentRow,
    /// c with c G = 0.
    combination: Vec<f64>,
}

/// The rows that follow from others.
///
/// Rows of the tree of joints are independent. A row of a joint that closes a loop is projected on the motions x that the
/// tree allows, x = g + Gᵀ λ, G x = 0, and on what the rows before it leave of them: nothing is left of a redundant one, c G = 0.
/// Then c ġ = c ∂g/∂t and c g̈ are zero too, for all velocities that the rows allow: otherwise prescribed motions contradict each
/// other, or the start is a singular configuration, where c g̈ changes with the velocity.
pub(super) fn redundant(
    system: &mut dyn Dynamics,
    constants: &Constants,
    s: &State,
    in_tree: &[bool],
) -> Result<Vec<Redundant>, ModelError> {
    if in_tree.iter().all(|tree| *tree) {
        return Ok(Vec::new());
    }
    let g = rows(system, s);
    let (n, m) = (system.size().v, g.len());
    let of_tree = |i: usize| in_tree[constants.rows[i].0];
    // Translations count by their length.
    let scale = system.scales().to_vec();
    let mut matrix = Matrix::new(&system.structure(1));
    if are_independent(&mut matrix, &g, &scale) {
        return Ok(Vec::new());
    }
    matrix.clear();
    (0..n).for_each(|i| matrix.add(i, i, 1.0));
    for (i, row) in g.iter().enumerate() {
        if of_tree(i) {
            for &(j, x) in row {
                matrix.add(n + i, j, x * scale[j]);
                matrix.add(j, n + i, -x * scale[j]);
            }
        } else {
            matrix.add(n + i, n + i, 1.0);
        }
    }
    matrix
        .factor_equilibrated()
        .map_err(|e| ModelError::Velocities(format!("{} ({e})", system.unknown(e.index))))?;
    // Orthonormal, each with its combination of rows.
    let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let mut found: Vec<Redundant> = Vec::new();
    for (i, row) in g.iter().enumerate().filter(|(i, _)| !of_tree(*i)) {
        let mut x = vec![0.0; n + m];
        row.iter().for_each(|&(j, entry)| x[j] += entry * scale[j]);
        let size = dot(&x[..n], &x[..n]).sqrt();
        let mut combination = vec![0.0; m];
        combination[i] = 1.0;
        for _ in 0..2 {
            x[n..].fill(0.0);
            matrix.solve(&mut x);
            axpy(1.0, &x[n..], &mut combination);
            for (unit, of_unit) in &basis {
                let along = dot(&x[..n], unit);
                axpy(-along, unit, &mut x[..n]);
                axpy(-along, of_unit, &mut combination);
            }
        }
        let left = dot(&x[..n], &x[..n]).sqrt();
        if left > INDEPENDENT * size {
            let inverse = 1.0 / left;
            x.truncate(n);
            x.iter_mut().chain(&mut combination).for_each(|x| *x *= inverse);
            basis.push((x, combination));
            continue;
        }
        found.push(Redundant { row: i, of: constants.dependent_row(i, &combination), combination });
    }
    // Velocities that the rows allow: of the tree, and then of the loops.
    let mut allowed = |s: &mut State, rates: &mut [f64]| {
        system.constraint(s, RowWeights::VELOCITY, rates);
        let mut x = vec![0.0; n + m];
        for i in (0..m).filter(|i| of_tree(*i)) {
            x[n + i] = -rates[i];
        }
        matrix.solve(&mut x);
        (0..n).for_each(|j| s.v[j] += scale[j] * x[j]);
        for (unit, of_unit) in &basis {
            system.constraint(s, RowWeights::VELOCITY, rates);
            let excess = dot(of_unit, rates);
            (0..n).for_each(|j| s.v[j] -= excess * scale[j] * unit[j]);
        }
        let fastest = s.v.iter().zip(&scale).fold(0.0_f64, |x, (v, scale)| x.max((v / scale).abs()));
        let mut accelerations = vec![0.0; m];
        system.constraint(s, RowWeights::VELOCITY, rates);
        system.constraint(s, RowWeights::ACCELERATION, &mut accelerations);
        (accelerations, fastest)
    };
    let mut given = State { a: vec![0.0; n], ..s.clone() };
    let mut rates = vec![0.0; m];
    let (accelerations, fastest) = allowed(&mut given, &mut rates);
    let mut other = given.clone();
    for (j, v) in other.v.iter_mut().enumerate() {
        *v += (1.0 + fastest) * scale[j] * libm::sin(1.0 + j as f64);
    }
    let (other, faster) = allowed(&mut other, &mut vec![0.0; m]);
    let (mut contradictory, mut singular) = (Vec::new(), Vec::new());
    for of in &found {
        let c = &of.combination;
        let unit = |k: usize| if constants.rows[k].1.is_length() { scale[0] } else { 1.0 };
        let sum = |of: &dyn Fn(usize) -> f64| (0..m).map(|k| c[k].abs() * of(k)).sum::<f64>();
        // What counts as rounding.
        let speed = SAME * sum(&|k| rates[k].abs() + unit(k) * fastest);
        let acceleration =
            SAME * sum(&|k| accelerations[k].abs() + other[k].abs() + unit(k) * faster * faster);
        let differs = (dot(c, &other) - dot(c, &accelerations)).abs() > acceleration;
        if dot(c, &rates).abs() > speed || (!differs && dot(c, &accelerations).abs() > acceleration) {
            contradictory.push(of.of.clone());
        } else if differs {
            singular.push(of.of.clone());
        }
    }
    match (contradictory.is_empty(), singular.is_empty()) {
        (true, true) => Ok(found),
        (true, false) => Err(ModelError::Singular { rows: singular }),
        _ => Err(ModelError::Contradictory { rows: contradictory }),
    }
}

/// Whether the least singular value of the rows, each of length 1, is so far from zero that none follows from others: 1/σ² is the largest eigenvalue of (G Gᵀ)⁻¹, found by its
/// powers, λ ← (G Gᵀ)⁻¹ λ or x = Gᵀ λ⁺, G x = λ. Of a net with hundreds of loops this takes a few solutions in the place of two for each loop.
fn are_independent(matrix: &mut Matrix, g: &[Vec<(usize, f64)>], scale: &[f64]) -> bool {
    let n = scale.len();
    matrix.clear();
    (0..n).for_each(|i| matrix.add(i, i, 1.0));
    for (i, row) in g.iter().enumerate() {
        let size = row.iter().map(|&(j, x)| (x * scale[j]) * (x * scale[j])).sum::<f64>().sqrt();
        for &(j, x) in row {
            matrix.add(n + i, j, x * scale[j] / size);
            matrix.add(j, n + i, -x * scale[j] / size);
        }
    }
    if matrix.factor_equilibrated().is_err() {
        return false;
    }
    let mut x = vec![0.0; n + g.len()];
    let start = (0..g.len()).map(|i| libm::sin(1.0 + i as f64));
    x[n..].iter_mut().zip(start).for_each(|(x, start)| *x = start);
    for _ in 0..POWERS {
        let size = dot(&x[n..], &x[n..]).sqrt();
        x[..n].fill(0.0);
        x[n..].iter_mut().for_each(|x| *x /= size);
        matrix.solve(&mut x);
        let grown = dot(&x[n..], &x[n..]).sqrt();
        if !(grown * CERTAIN * CERTAIN < 1.0) {
            // What is no number is not independent either.
            return false;
        }
    }
    true
}

/// The velocities nearest to those of `s` that obey the rows: M Δv = Gᵀ Λ, G Δv = −ġ.
pub(super) fn velocities(system: &mut dyn Dynamics, s: &State) -> Result<Vec<f64>, ModelError> {
    let (n, m) = (s.v.len(), system.size().lambda);
    let mut v = s.v.clone();
    if m == 0 {
        return Ok(v);
    }
    let mut rhs = vec![0.0; n + m];
    system.constraint(s, RowWeights::VELOCITY, &mut rhs[n..]);
    let mut matrix = Matrix::new(&system.structure(1));
    system.tangent(s, Weights::new(1.0, 0.0, 0.0), &mut matrix);
    for (i, row) in rows(system, s).iter().enumerate() {
        for &(j, x) in row {
            matrix.add(n + i, j, x);
            matrix.add(j, n + i, -x);
        }
    }
    matrix
        .factor_equilibrated()
        .map_err(|e| ModelError::Velocities(format!("{} ({e})", system.unknown(e.index))))?;
    matrix.solve(&mut rhs);
    axpy(-1.0, &rhs[..n], &mut v);
    Ok(v)
}

/// What the joints have changed of velocities that the model gives, where it is more than rounding.
pub(super) fn changes(constants: &Constants, given: &State, used: &[f64]) -> Vec<String> {
    let scaled = |v: &[f64]| v.iter().zip(&constants.scales).map(|(v, scale)| v / scale).collect::<Vec<_>>();
    let (before, after) = (scaled(&given.v), scaled(used));
    let most = SAME * before.iter().fold(0.0_f64, |x, v| x.max(v.abs()));
    let changed = |mut numbers: Range<usize>| numbers.any(|j| !((after[j] - before[j]).abs() <= most));
    let why = "the joints do not allow what is given";
    let text = |Vec3([x, y, z]): Vec3| format!("({x:.4}, {y:.4}, {z:.4})");
    let mut out = Vec::new();
    for (body, place) in constants.model.bodies.iter().zip(&constants.place) {
        let (at, r) = (6 * place, body.frame.rotation);
        if !changed(at..at + 6) {
            continue;
        }
        let spin = r * Vec3::at(used, at + 3);
        let velocity = Vec3::at(used, at) - spin.cross(r * body.centre);
        let mut tell = |what: &str, given: Option<Vec3>, used: Vec3, unit: &str| {
            if let Some(given) = given {
                let (name, used, given) = (&body.name, text(used), text(given));
                out.push(format!(
                    "body `{name}` has the {what} {used} {unit} at t = 0, and not {given}: {why}"
                ));
            }
        };
        tell("velocity", body.velocity, velocity, "m/s");
        tell("spin", body.spin, spin, "rad/s");
    }
    for (of, [_, at]) in constants.model.beams.iter().zip(&constants.beams) {
        if !changed(*at..at + of.beam.velocities()) {
            continue;
        }
        out.push(if of.velocity.is_some() || of.spin.is_some() {
            format!("beam `{}` has other velocities at t = 0 than are given: {why}", of.name)
        } else {
            format!(
                "beam `{}` does not begin with the motion of a rigid body, which what the joints prescribe at t = 0 does not allow, but with \
                 the nearest velocities: its ends start with a shock",
                of.name
            )
        });
    }
    out
}
