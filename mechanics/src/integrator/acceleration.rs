//! Accelerations of a given position and velocity: a = M⁻¹ f.

use super::{Counters, StepError, failure};
use crate::linalg::Matrix;
use crate::system::{Level, State, System, Weights};

/// Solver of
///
/// ```text
/// ⎡ M  Gᵀ⎤ ⎡a⎤     ⎡ r(t, q, v, a = 0, λ = 0) ⎤
/// ⎣ G  0 ⎦ ⎣λ⎦ = − ⎣ g̈(t, q, v, a = 0)        ⎦
/// ```
///
/// for the acceleration a and the multipliers λ consistent with t, q, v. The residual is linear in a and
/// λ, so one solution is exact. A mass matrix that its stamp shows to be unchanged is not factored again.
#[derive(Debug)]
pub(super) struct Accelerations {
    mass: Matrix,
    rhs: Vec<f64>,
}

impl Accelerations {
    /// Allocates for `system`.
    pub(super) fn new(system: &dyn System) -> Accelerations {
        let size = system.size();
        Accelerations { mass: Matrix::new(&system.structure()), rhs: vec![0.0; size.v + size.lambda] }
    }

    /// Replaces `state.a` and `state.lambda` by the consistent ones. `from` and `step` are the start and
    /// the size of the step in which this happens, for messages.
    pub(super) fn complete(
        &mut self,
        system: &mut dyn System,
        state: &mut State,
        (from, step): (f64, f64),
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let n = state.v.len();
        state.a.fill(0.0);
        state.lambda.fill(0.0);
        let (motion, constraints) = self.rhs.split_at_mut(n);
        system.residual(state, motion);
        if !constraints.is_empty() {
            system.constraint(state, Level::Acceleration, constraints);
        }
        let weights = Weights { q: 0.0, v: 0.0, a: 1.0, increment: None, level: Level::Acceleration };
        system.tangent(state, weights, &mut self.mass);
        let factored = self.mass.factor().map_err(|e| failure::singular(system, from, step, e))?;
        self.mass.solve(&mut self.rhs);
        let (a, lambda) = self.rhs.split_at(n);
        for (out, x) in state.a.iter_mut().zip(a) {
            *out = -x;
        }
        for (out, x) in state.lambda.iter_mut().zip(lambda) {
            *out = -x;
        }
        counters.residuals += 1;
        counters.tangents += u64::from(factored);
        counters.factorizations += u64::from(factored);
        counters.solves += 1;
        if state.is_finite() { Ok(()) } else { Err(failure::not_finite(system, from, step, state)) }
    }
}
