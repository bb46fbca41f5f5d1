//! Tangents of a system, one by one.

use crate::linalg::Matrix;
use crate::system::{State, System, Weights};

/// The mass M = ∂r/∂a at a state, hidden unknowns eliminated.
pub fn mass(system: &mut dyn System, state: &State) -> Matrix {
    tangent(system, state, Weights::new(1.0, 0.0, 0.0))
}

/// The matrix C = ∂r/∂v of damping and gyroscopic forces.
pub fn damping(system: &mut dyn System, state: &State) -> Matrix {
    tangent(system, state, Weights::new(0.0, 1.0, 0.0))
}

/// The stiffness K = ∂r/∂q.
pub fn stiffness(system: &mut dyn System, state: &State) -> Matrix {
    tangent(system, state, Weights::new(0.0, 0.0, 1.0))
}

fn tangent(system: &mut dyn System, state: &State, weights: Weights<'_>) -> Matrix {
    let mut matrix = Matrix::new(&system.structure(0));
    system.tangent(state, weights, &mut matrix);
    matrix
}
