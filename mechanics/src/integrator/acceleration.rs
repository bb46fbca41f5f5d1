//! Accelerations of a given position and velocity: a = M⁻¹ f.

use super::rows::Rows;
use super::{Counters, StepError, failure};
use crate::linalg::{Matrix, Singular};
use crate::system::{Dynamics, RowWeights, State, Weights, is_active};

/// Corrections by which unknowns without mass are put in equilibrium.
const CORRECTIONS: usize = 20;
/// Last correction over the scale of the unknown.
const SETTLED: f64 = 1e-13;

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
/// An unknown c without mass, whose row of M is zero and which no active constraint moves, has the equation f_c(q, v) = 0.
/// Where f_c has no damping it gives q_c by Newton's method, and v_c, a_c by K_c v = 0 and K_c a = 0, its derivatives for
/// constant K; where it has, v_c and C_c a = −K_c v.
#[derive(Debug)]
pub(super) struct Accelerations {
    matrix: Matrix,
    rhs: Vec<f64>,
    pub(super) rows: Rows,
    weights: RowWeights,
    massless: Option<Box<Massless>>,
}

/// Memory for unknowns without mass.
#[derive(Debug)]
struct Massless {
    stiffness: Matrix,
    damping: Matrix,
    /// Which unknowns have no mass, and of which the velocity, not the configuration, is in equilibrium.
    unknowns: Vec<(usize, bool)>,
    increment: Vec<f64>,
    q: Vec<f64>,
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
            massless: None,
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
                return self.complete_massless(system, state, (from, step), counters, singular);
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

    /// As [`Accelerations::complete`] with unknowns without mass; `singular` is why M could not be factored.
    fn complete_massless(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        (from, step): (f64, f64),
        counters: &mut Counters,
        singular: Singular,
    ) -> Result<(), StepError> {
        let n = state.v.len();
        let work = self.massless.get_or_insert_with(|| {
            let matrix = || Matrix::new(&system.structure(0));
            let (increment, q) = (vec![0.0; n], state.q.clone());
            Box::new(Massless {
                stiffness: matrix(),
                damping: matrix(),
                unknowns: Vec::with_capacity(n),
                increment,
                q,
            })
        });
        system.tangent(state, Weights::new(1.0, 0.0, 0.0), &mut self.matrix);
        system.tangent(state, Weights::new(0.0, 1.0, 0.0), &mut work.damping);
        system.tangent(state, Weights::new(0.0, 0.0, 1.0), &mut work.stiffness);
        self.rows.store_jacobian(system, state);
        work.find(&self.matrix, &self.rows, state);
        if work.unknowns.is_empty() {
            return Err(failure::singular(system, from, step, singular));
        }
        if !self.rows.is_empty() {
            self.rows.add_border(system, state, n, &mut self.matrix);
        }
        for &(c, damped) in &work.unknowns {
            let row = if damped { &work.damping } else { &work.stiffness };
            for j in (0..n).filter(|j| row.get(c, *j) != 0.0) {
                self.matrix.add(c, j, row.get(c, j));
            }
        }
        self.matrix.factor().map_err(|e| failure::singular(system, from, step, e))?;
        // Equilibrium of the unknowns without mass: what has mass does not move.
        let scales = system.scales();
        let scales: Vec<f64> = work.unknowns.iter().map(|&(c, _)| scales[c]).collect();
        let mut size = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            self.rhs.fill(0.0);
            system.residual(state, &mut work.increment);
            for &(c, _) in &work.unknowns {
                self.rhs[c] = -work.increment[c];
            }
            self.matrix.solve(&mut self.rhs);
            counters.residuals += 1;
            counters.solves += 1;
            work.increment.fill(0.0);
            size = 0.0;
            for (&(c, damped), scale) in work.unknowns.iter().zip(&scales) {
                size = size.max((self.rhs[c] / scale).abs());
                if damped {
                    state.v[c] += self.rhs[c];
                } else {
                    work.increment[c] = self.rhs[c];
                }
            }
            system.retract(&state.q, &work.increment, &mut work.q);
            state.q.copy_from_slice(&work.q);
            if !(size > SETTLED) {
                break;
            }
        }
        if !(size <= 1e4 * SETTLED) {
            let worst = "unknowns without mass, which find no equilibrium".to_owned();
            return Err(StepError::Singular { time: from, step, pivot: 0.0, worst });
        }
        work.velocities(&mut self.matrix, &mut self.rhs, state);
        // Accelerations, with −C_c a = K_c v where there is damping.
        let (motion, constraints) = self.rhs.split_at_mut(n);
        system.residual(state, motion);
        work.stiffness.multiply(&state.v, &mut work.increment);
        for &(c, damped) in &work.unknowns {
            motion[c] = if damped { work.increment[c] } else { 0.0 };
        }
        self.rows.weighted(system, state, self.weights, 1.0, constraints);
        self.matrix.solve(&mut self.rhs);
        self.take(state, counters, true);
        if state.is_finite() { Ok(()) } else { Err(failure::not_finite(system, from, step, state)) }
    }
}

impl Massless {
    /// Finds the unknowns whose row of `mass` is zero and which no active constraint moves.
    fn find(&mut self, mass: &Matrix, rows: &Rows, state: &State) {
        let n = state.v.len();
        self.unknowns.clear();
        for c in (0..n).filter(|c| mass.get(*c, *c) == 0.0) {
            let held = rows
                .stored()
                .iter()
                .any(|&(row, j, x)| j == c && x != 0.0 && is_active(rows.sets()[row], state.mode[row]));
            if !held && (0..n).all(|j| mass.get(c, j) == 0.0) {
                self.unknowns.push((c, self.damping.get(c, c) != 0.0));
            }
        }
    }

    /// v_c of K_c v = 0, where f_c has no damping.
    fn velocities(&mut self, matrix: &mut Matrix, rhs: &mut [f64], state: &mut State) {
        self.stiffness.multiply(&state.v, &mut self.increment);
        rhs.fill(0.0);
        for &(c, _) in self.unknowns.iter().filter(|(_, damped)| !damped) {
            rhs[c] = -self.increment[c];
        }
        matrix.solve(rhs);
        for &(c, _) in self.unknowns.iter().filter(|(_, damped)| !damped) {
            state.v[c] += rhs[c];
        }
    }
}
