//! The rows of joints and closed contacts in the equations of an equilibrium.

use crate::linalg::Matrix;
use crate::system::{Dynamics, Mode, RowWeights, Set, State, is_active};

/// Depth, over the largest scale of an unknown, that counts as rounding.
const DEPTH: f64 = 1e-12;

/// Whether the position of a row is imposed.
fn holds(set: Set, s: &State, row: usize) -> bool {
    is_active(set, s.mode[row]) && !matches!(set, Set::Friction { .. })
}

/// Writes −g of the rows that hold, and −λ of the others, whose equation is λ = 0.
pub(super) fn positions(system: &mut dyn Dynamics, s: &State, out: &mut [f64]) {
    if out.is_empty() {
        return;
    }
    system.constraint(s, RowWeights::POSITION, out);
    for (i, (set, out)) in system.rows().iter().zip(out).enumerate() {
        *out = if holds(*set, s, i) { -*out } else { -s.lambda[i] };
    }
}

/// Adds −Gᵀ, −G and the equations −λ = 0 of the rows that do not hold to a matrix whose multipliers begin at unknown `n`: K
/// that is symmetric stays so, and as many of its eigenvalues become negative as there are multipliers. Gives their number.
pub(super) fn add(system: &mut dyn Dynamics, s: &State, n: usize, matrix: &mut Matrix) -> usize {
    let held: Vec<bool> = system.rows().iter().enumerate().map(|(i, set)| holds(*set, s, i)).collect();
    system.jacobian(s, &mut |row, velocities, entries| {
        for (&j, &x) in velocities.iter().zip(entries).filter(|_| held[row]) {
            matrix.add(n + row, j, -x);
            matrix.add(j, n + row, -x);
        }
    });
    for i in (0..held.len()).filter(|i| !held[*i]) {
        matrix.add(n + i, n + i, -1.0);
    }
    held.len()
}

/// Closes the open contact that is deepest inside its obstacle, or else opens the closed one that pulls most. `false` where there
/// is none.
pub(super) fn change_contact(system: &mut dyn Dynamics, s: &mut State) -> bool {
    let lambda = s.lambda.clone();
    let gaps = gaps(system, s);
    change(system, s, &gaps, &lambda)
}

/// The same by gaps and forces behind an increment of the unknowns, to the first order.
pub(super) fn change_contact_behind(system: &mut dyn Dynamics, s: &mut State, d: &[f64]) -> bool {
    let (d, multipliers) = d.split_at(s.v.len());
    let lambda: Vec<f64> = s.lambda.iter().zip(multipliers).map(|(lambda, x)| lambda + x).collect();
    let mut gaps = gaps(system, s);
    system.jacobian(s, &mut |row, velocities, entries| {
        gaps[row] += velocities.iter().zip(entries).map(|(&j, x)| x * d[j]).sum::<f64>();
    });
    change(system, s, &gaps, &lambda)
}

fn gaps(system: &mut dyn Dynamics, s: &State) -> Vec<f64> {
    let mut gaps = vec![0.0; s.lambda.len()];
    if !gaps.is_empty() {
        system.constraint(s, RowWeights::POSITION, &mut gaps);
    }
    gaps
}

fn change(system: &dyn Dynamics, s: &mut State, gaps: &[f64], lambda: &[f64]) -> bool {
    let rounding = DEPTH * system.length();
    let least = |mode: Mode, x: &[f64]| {
        let contact = |i: &usize| matches!(system.rows()[*i], Set::Unilateral { .. }) && s.mode[*i] == mode;
        (0..x.len()).filter(contact).min_by(|i, j| x[*i].total_cmp(&x[*j]))
    };
    let inside = least(Mode::Open, gaps).filter(|i| gaps[*i] < -rounding);
    let pulls = least(Mode::Closed, lambda).filter(|i| lambda[*i] < 0.0);
    match (inside, pulls) {
        (Some(i), _) => s.mode[i] = Mode::Closed,
        (None, Some(i)) => (s.mode[i], s.lambda[i]) = (Mode::Open, 0.0),
        (None, None) => return false,
    }
    true
}

/// Adds to the multipliers those that leave the least of the residual, |S (r − Gᵀ Δλ)| with the scales S of the unknowns.
/// Nothing happens where the rows depend on each other.
pub(super) fn balance(system: &mut dyn Dynamics, s: &mut State) {
    let (n, m) = (s.v.len(), s.lambda.len());
    if m == 0 {
        return;
    }
    let mut r = vec![0.0; n + m];
    system.residual(s, &mut r);
    r[n..].fill(0.0);
    let mut matrix = Matrix::new(&system.structure(1));
    matrix.clear();
    for (i, scale) in system.scales().iter().enumerate() {
        matrix.add(i, i, 1.0 / (scale * scale));
    }
    add(system, s, n, &mut matrix);
    if matrix.factor_equilibrated().is_ok() {
        matrix.solve(&mut r);
        s.lambda.iter_mut().zip(&r[n..]).for_each(|(lambda, x)| *lambda -= x);
    }
}
