//! The start: whether the bodies fit their joints, which rows follow from others, and velocities that obey the rows.

use super::constants::Constants;
use super::model::{ModelError, Violation};
use crate::linalg::Matrix;
use crate::linalg::vector::{axpy, dot};
use crate::system::{Dynamics, RowWeights, State, Weights};

/// Displacement of markers, over the largest arm, and cosine of an angle that count as rounding.
const FITTING: f64 = 1e-9;
/// Part of a row that must be independent of the others.
const INDEPENDENT: f64 = 1e-9;

/// Refuses joints whose markers do not coincide.
pub(super) fn positions(
    system: &mut dyn Dynamics,
    constants: &Constants,
    s: &State,
) -> Result<(), ModelError> {
    let mut g = vec![0.0; s.lambda.len()];
    system.constraint(s, RowWeights::POSITION, &mut g);
    let scale = system.scales().first().copied().unwrap_or(1.0);
    let mut violations = Vec::new();
    for (joint, rows) in constants.model.joints.iter().zip(&constants.of_joint) {
        let (mut length, mut angle) = (0.0_f64, 0.0_f64);
        for i in rows.clone() {
            let largest = if constants.rows[i].1.is_length() { &mut length } else { &mut angle };
            *largest = largest.max(g[i].abs());
        }
        if !(length <= FITTING * scale.max(1.0) && angle <= FITTING) {
            violations.push(Violation { joint: joint.name.clone(), length, angle });
        }
    }
    violations.sort_by(|a, b| (b.length + b.angle).total_cmp(&(a.length + a.angle)));
    if violations.is_empty() { Ok(()) } else { Err(ModelError::Positions { violations }) }
}

/// A row of the jacobian as a vector.
fn rows(system: &mut dyn Dynamics, s: &State) -> Vec<Vec<(usize, f64)>> {
    let mut out = vec![Vec::new(); system.size().lambda];
    system.jacobian(s, &mut |row, velocities, entries| {
        out[row].extend(velocities.iter().copied().zip(entries.iter().copied()));
    });
    out
}

/// The rows that follow from others, each with its name and the joints that it follows from.
///
/// Rows of the tree of joints are independent. A row of a joint that closes a loop is projected on the motions x that the
/// tree allows, x = g + Gᵀ λ, G x = 0, and on what the rows before it leave of them: nothing is left of a redundant one.
pub(super) fn redundant(
    system: &mut dyn Dynamics,
    constants: &Constants,
    s: &State,
    in_tree: &[bool],
) -> Result<Vec<(usize, String)>, ModelError> {
    if in_tree.iter().all(|tree| *tree) {
        return Ok(Vec::new());
    }
    let g = rows(system, s);
    let (n, m) = (system.size().v, g.len());
    let of_tree = |i: usize| in_tree[constants.rows[i].0];
    // Translations count by their length.
    let scale = system.scales().to_vec();
    let mut matrix = Matrix::new(&system.structure(1));
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
    matrix.factor().map_err(|e| ModelError::Velocities(format!("{} ({e})", system.unknown(e.index))))?;
    // Orthonormal, each with its combination of rows.
    let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let mut found = Vec::new();
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
        let own = constants.rows[i].0;
        let mut joints: Vec<usize> = (0..m)
            .filter(|k| combination[*k].abs() > 1e-6)
            .map(|k| constants.rows[k].0)
            .filter(|joint| *joint != own)
            .collect();
        joints.dedup();
        let others: Vec<String> =
            joints.iter().map(|k| format!("`{}`", constants.model.joints[*k].name)).collect();
        found.push((i, format!("{} (which follows from {})", constants.row_name(i), others.join(", "))));
    }
    Ok(found)
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
    matrix.factor().map_err(|e| ModelError::Velocities(format!("{} ({e})", system.unknown(e.index))))?;
    matrix.solve(&mut rhs);
    axpy(-1.0, &rhs[..n], &mut v);
    Ok(v)
}
