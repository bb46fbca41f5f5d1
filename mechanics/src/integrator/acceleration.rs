//! Accelerations of a given position and velocity: a = M⁻¹ f.

use super::rows::Rows;
use super::{Counters, StepError, failure};
use crate::linalg::Matrix;
use crate::system::{Dynamics, RowWeights, State, Weights};

/// Weight of K beside M where M is singular, in units of the ratio of their largest entries.
const REGULARIZATION: f64 = 1e-9;
/// Corrections of accelerations found with the regularized mass matrix.
const CORRECTIONS: usize = 3;
/// Change of accelerations, relative to the largest, that the corrections must fall below.
const SETTLED: f64 = 1e-9;

/// Solver of
///
/// ```text
/// ⎡ M  −Gᵀ⎤ ⎡a⎤     ⎡ r(t, q, v, a = 0, λ = 0)       ⎤
/// ⎣ G   0 ⎦ ⎣λ⎦ = − ⎣ c₀ g + c₁ ġ + g̈(t, q, v, a = 0) ⎦
/// ```
///
/// for the acceleration a and the multipliers λ consistent with t, q, v; c₀ = c₁ = 0 but for Baumgarte's stabilization.
/// The residual is linear in a and λ, so one solution is exact. A mass matrix that its stamp shows to be unchanged is
/// not factored again.
///
/// A singular mass matrix (a node without mass) is replaced by M + εK: the equations of massless unknowns,
/// f(q, v) = 0, then hold in their second derivative, and the limit ε → 0 is taken by corrections.
#[derive(Debug)]
pub(super) struct Accelerations {
    matrix: Matrix,
    rhs: Vec<f64>,
    pub(super) rows: Rows,
    weights: RowWeights,
    regularized: Option<Box<Regularized>>,
}

/// Memory for a singular mass matrix.
#[derive(Debug)]
struct Regularized {
    stiffness: Matrix,
    product: Vec<f64>,
    last: Vec<f64>,
}

impl Accelerations {
    /// Allocates for `system`.
    pub(super) fn new(system: &mut dyn Dynamics, state: &State, weights: RowWeights) -> Accelerations {
        let size = system.size();
        Accelerations {
            matrix: Matrix::new(&system.structure(1)),
            rhs: vec![0.0; size.v + size.lambda],
            rows: Rows::new(system, state),
            weights,
            regularized: None,
        }
    }

    /// Replaces `state.a` and `state.lambda` by the consistent ones. `from` and `step` are the start and
    /// the size of the step in which this happens, for messages.
    pub(super) fn complete(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        (from, step): (f64, f64),
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        if self.regularized.is_some() {
            return self.complete_regularized(system, state, (from, step), counters);
        }
        let n = state.v.len();
        state.a.fill(0.0);
        state.lambda.fill(0.0);
        let (motion, constraints) = self.rhs.split_at_mut(n);
        system.residual(state, motion);
        self.rows.weighted(system, state, self.weights, 1.0, constraints);
        system.tangent(state, Weights::new(1.0, 0.0, 0.0), &mut self.matrix);
        if !self.rows.is_empty() {
            self.rows.add_border(system, state, n, &mut self.matrix);
        }
        let factored = match self.matrix.factor() {
            Ok(factored) => factored,
            Err(singular) if singular.pivot.is_finite() => {
                let stiffness = Matrix::new(&system.structure(0));
                let regularized = Regularized { stiffness, product: vec![0.0; n], last: vec![0.0; n] };
                self.regularized = Some(Box::new(regularized));
                return self.complete_regularized(system, state, (from, step), counters);
            }
            Err(cause) => return Err(failure::singular(system, from, step, cause)),
        };
        self.matrix.solve(&mut self.rhs);
        self.take(state, counters, factored);
        if state.is_finite() { Ok(()) } else { Err(failure::not_finite(system, from, step, state)) }
    }

    fn take(&self, state: &mut State, counters: &mut Counters, factored: bool) {
        let (a, lambda) = self.rhs.split_at(state.v.len());
        for (out, x) in state.a.iter_mut().zip(a).chain(state.lambda.iter_mut().zip(lambda)) {
            *out = -x;
        }
        counters.residuals += 1;
        counters.tangents += u64::from(factored);
        counters.factorizations += u64::from(factored);
        counters.solves += 1;
    }

    /// (M + εK) aₖ₊₁ = −r₀ + εK aₖ with the rows.
    fn complete_regularized(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        (from, step): (f64, f64),
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let Some(mut work) = self.regularized.take() else { return Ok(()) };
        let n = state.v.len();
        state.lambda.fill(0.0);
        state.a.fill(0.0);
        system.tangent(state, Weights::new(0.0, 0.0, 1.0), &mut work.stiffness);
        let largest = |matrix: &Matrix| (0..n).fold(0.0_f64, |m, i| m.max(matrix.get(i, i).abs()));
        let stiffness = largest(&work.stiffness);
        system.tangent(state, Weights::new(1.0, 0.0, 0.0), &mut self.matrix);
        let weight = REGULARIZATION * largest(&self.matrix) / stiffness.max(f64::MIN_POSITIVE);
        system.tangent(state, Weights::new(1.0, 0.0, weight), &mut self.matrix);
        self.rows.add_border(system, state, n, &mut self.matrix);
        self.matrix.factor().map_err(|e| failure::singular(system, from, step, e))?;
        let mut change = f64::INFINITY;
        for _ in 0..=CORRECTIONS {
            work.last.copy_from_slice(&state.a);
            work.stiffness.multiply(&state.a, &mut work.product);
            state.a.fill(0.0);
            state.lambda.fill(0.0);
            let (motion, constraints) = self.rhs.split_at_mut(n);
            system.residual(state, motion);
            for (r, k) in motion.iter_mut().zip(&work.product) {
                *r -= weight * k;
            }
            self.rows.weighted(system, state, self.weights, 1.0, constraints);
            self.matrix.solve(&mut self.rhs);
            self.take(state, counters, true);
            let size = state.a.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
            let moved = state.a.iter().zip(&work.last).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            change = if size > 0.0 { moved / size } else { 0.0 };
        }
        self.regularized = Some(work);
        if !state.is_finite() {
            return Err(failure::not_finite(system, from, step, state));
        }
        if change > SETTLED {
            let worst = "unknowns without mass, which are not in equilibrium: start them there".to_owned();
            return Err(StepError::Singular { time: from, step, pivot: 0.0, worst });
        }
        Ok(())
    }
}
