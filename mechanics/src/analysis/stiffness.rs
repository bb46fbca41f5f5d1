//! Tangents of a system, one by one.

use super::joints;
use crate::linalg::Matrix;
use crate::system::{State, System, Weights};

/// Part of a row of a joint in the plane of a system, over that across, that is rounding.
const ROUNDING: f64 = 1e-12;

/// The mass M = ∂r/∂a at a state, hidden unknowns eliminated.
pub fn mass(system: &mut dyn System, state: &State) -> Matrix {
    tangent(system, state, Weights::new(1.0, 0.0, 0.0), 0)
}

/// The stiffness ∂r/∂q at a state.
pub(super) fn stiffness(system: &mut dyn System, state: &State) -> Matrix {
    tangent(system, state, Weights::new(0.0, 0.0, 1.0), 0)
}

/// M, C and K of the unknowns (v, λ), with the jacobian in K: [M 0; 0 0], [C 0; 0 0] and [K −Gᵀ; −G 0]; and the number of
/// multipliers. What moves [across](crate::system::Dynamics::across) the plane of a system is held.
pub(super) fn matrices(system: &mut dyn System, state: &State) -> ([Matrix; 3], usize) {
    let mut of = |a, v, q| tangent(system, state, Weights::new(a, v, q), 1);
    let mut all = [of(1.0, 0.0, 0.0), of(0.0, 1.0, 0.0), of(0.0, 0.0, 1.0)];
    let multipliers = joints::add(system, state, state.v.len(), &mut all[2]);
    hold_across(&system.across(), &mut all, state.v.len());
    (all, multipliers)
}

/// K alone, as among the [matrices], and the number of multipliers.
pub(super) fn constrained(system: &mut dyn System, state: &State) -> (Matrix, usize) {
    let mut stiffness = [tangent(system, state, Weights::new(0.0, 0.0, 1.0), 1)];
    let multipliers = joints::add(system, state, state.v.len(), &mut stiffness[0]);
    hold_across(&system.across(), &mut stiffness, state.v.len());
    let [stiffness] = stiffness;
    (stiffness, multipliers)
}

/// Number of independent velocities in the plane of a system, of all without one, with the [stiffness](matrices) K of its unknowns.
pub(super) fn freedoms(system: &dyn System, stiffness: &Matrix) -> usize {
    let n = system.size().v;
    let holds = |row: &usize| {
        let mut holds = false;
        stiffness.column(*row, |other, _| holds |= other != *row);
        holds
    };
    (n - system.across().len()).saturating_sub((n..stiffness.order()).filter(holds).count())
}

/// Empties the rows and columns of unknowns but for a stiffness of their own, and of the multipliers behind the `n` velocities those
/// whose rows held nothing else. The stiffness is the last.
fn hold_across(across: &[usize], all: &mut [Matrix], n: usize) {
    let [.., stiffness] = &*all else { return };
    if across.is_empty() {
        return;
    }
    let own = |i: usize| [stiffness, &all[0]].map(|of| of.get(i, i).abs()).into_iter().find(|x| *x > 0.0);
    let held: Vec<f64> = across.iter().map(|i| own(*i).unwrap_or(1.0)).collect();
    let rows = n..stiffness.order();
    let before: Vec<f64> = rows.clone().map(|row| largest(stiffness, row)).collect();
    for matrix in &mut *all {
        across.iter().for_each(|i| empty(matrix, *i));
    }
    let [.., stiffness] = all else { return };
    across.iter().zip(held).for_each(|(i, held)| stiffness.add(*i, *i, held));
    for (row, before) in rows.zip(before) {
        if largest(stiffness, row) <= ROUNDING * before {
            empty(stiffness, row);
            stiffness.add(row, row, -1.0);
        }
    }
}

/// The largest entry of a column.
fn largest(matrix: &Matrix, column: usize) -> f64 {
    let mut largest = 0.0_f64;
    matrix.column(column, |_, x| largest = largest.max(x.abs()));
    largest
}

/// Empties the column of an unknown, and the entries of its row that mirror it.
fn empty(matrix: &mut Matrix, i: usize) {
    let mut column = Vec::new();
    matrix.column(i, |row, _| column.push(row));
    for row in column {
        let [below, right] = [matrix.get(row, i), matrix.get(i, row)];
        matrix.add(row, i, -below);
        if row != i {
            matrix.add(i, row, -right);
        }
    }
}

fn tangent(system: &mut dyn System, state: &State, weights: Weights<'_>, multipliers: usize) -> Matrix {
    let mut matrix = Matrix::new(&system.structure(multipliers));
    system.tangent(state, weights, &mut matrix);
    matrix
}
