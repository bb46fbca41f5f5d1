//! Tangents of a system, one by one.

use super::joints;
use crate::linalg::Matrix;
use crate::system::{State, System, Weights};

/// The mass M = ∂r/∂a at a state, hidden unknowns eliminated.
pub fn mass(system: &mut dyn System, state: &State) -> Matrix {
    tangent(system, state, Weights::new(1.0, 0.0, 0.0), 0)
}

/// The damping ∂r/∂v at a state.
pub(super) fn damping(system: &mut dyn System, state: &State) -> Matrix {
    tangent(system, state, Weights::new(0.0, 1.0, 0.0), 0)
}

/// The stiffness ∂r/∂q at a state.
pub(super) fn stiffness(system: &mut dyn System, state: &State) -> Matrix {
    tangent(system, state, Weights::new(0.0, 0.0, 1.0), 0)
}

/// M, C and K of the unknowns (v, λ), with the jacobian in K: [M 0; 0 0], [C 0; 0 0] and [K −Gᵀ; −G 0]; and the number of
/// multipliers.
pub(super) fn matrices(system: &mut dyn System, state: &State) -> ([Matrix; 3], usize) {
    let mut of = |a, v, q| tangent(system, state, Weights::new(a, v, q), 1);
    let mut all = [of(1.0, 0.0, 0.0), of(0.0, 1.0, 0.0), of(0.0, 0.0, 1.0)];
    let multipliers = joints::add(system, state, state.v.len(), &mut all[2]);
    (all, multipliers)
}

fn tangent(system: &mut dyn System, state: &State, weights: Weights<'_>, multipliers: usize) -> Matrix {
    let mut matrix = Matrix::new(&system.structure(multipliers));
    system.tangent(state, weights, &mut matrix);
    matrix
}
