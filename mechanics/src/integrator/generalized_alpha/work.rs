//! What a run of a generalized-α method allocates, and its tangent.

use crate::integrator::acceleration::Accelerations;
use crate::integrator::rows::Rows;
use crate::linalg::{Matrix, Singular};
use crate::system::{Corotation, Dynamics, RowWeights, Set, State, Weights, is_active};

/// Cost of a tangent and its factors, in iterations.
const RENEWAL: f64 = 2.0;

/// When to renew a kept tangent, by the rule of age replacement: as soon as a step costs more iterations than the mean
/// step since the last renewal, the cost of the renewal included. Its mean cost is then least.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Age {
    pub(super) cost: f64,
    pub(super) steps: f64,
    pub(super) due: bool,
}

impl Age {
    pub(super) fn renewed() -> Age {
        Age { cost: RENEWAL, steps: 0.0, due: false }
    }

    pub(super) fn count(&mut self, iterations: u32) {
        self.cost += f64::from(iterations);
        self.steps += 1.0;
        self.due = f64::from(iterations) * self.steps > self.cost;
    }
}

/// What `start` allocates for a system.
#[derive(Debug)]
pub(super) struct Work {
    pub(super) tangent: Matrix,
    pub(super) rhs: Vec<f64>,
    pub(super) accelerations: Accelerations,
    pub(super) rows: Rows,
    /// Multipliers μ of the stabilized form, K, and the rows of Gₙ with an entry at each velocity.
    pub(super) mu: Vec<f64>,
    pub(super) stiffness: Option<Matrix>,
    pub(super) meeting: Vec<Vec<(usize, f64)>>,
    pub(super) affine: bool,
    /// Weights (of v and q) of the kept tangent, NaN without.
    pub(super) kept: [f64; 2],
    /// Where the kept tangent was assembled: state, start of its step with Gₙ, and increment.
    pub(super) place: State,
    pub(super) start: State,
    pub(super) increment: Vec<f64>,
    pub(super) corotation: Corotation,
    pub(super) age: Age,
    /// Renewals since the start, and whether the last one found the tangent of an affine system unchanged.
    pub(super) renewals: u32,
    pub(super) constant: bool,
}

/// Relative difference of two steps by which divisions of the same time differ.
const SAME: f64 = 1e-9;

impl Work {
    /// Whether the kept tangent has these weights.
    pub(super) fn is_of(&self, weights: [f64; 2]) -> bool {
        self.kept.iter().zip(weights).all(|(kept, x)| (kept - x).abs() <= SAME * x)
    }

    /// The residuals of the equations and of the rows into `rhs`.
    pub(super) fn residual(&mut self, system: &mut dyn Dynamics, to: &State, [to_v, to_q]: [f64; 2]) {
        let m = self.rows.len();
        let (motion, rows) = self.rhs.split_at_mut(to.v.len());
        system.residual(to, motion);
        let (positions, velocities) = rows.split_at_mut(m);
        self.rows.positions(system, to, [to_q, to_v], positions);
        if !velocities.is_empty() {
            system.constraint(to, RowWeights::VELOCITY, velocities);
            for (k, rate) in velocities.iter_mut().enumerate() {
                *rate = if has_mu(self.rows.sets()[k], to, k) { *rate / to_v } else { self.mu[k] };
            }
        }
    }

    /// Assembles the kept tangent again, of a step of size `h`.
    pub(super) fn reassemble(&mut self, system: &mut dyn Dynamics, h: f64) -> Result<bool, Singular> {
        let (place, d) = (self.place.clone(), self.increment.clone());
        if self.stiffness.is_some() {
            let start = self.start.clone();
            self.rows.store_jacobian(system, &start);
        }
        self.assemble(system, &place, &d, h, self.kept)
    }

    /// Assembles and factors the tangent at `to`.
    pub(super) fn assemble(
        &mut self,
        system: &mut dyn Dynamics,
        to: &State,
        d: &[f64],
        h: f64,
        [to_v, to_q]: [f64; 2],
    ) -> Result<bool, Singular> {
        let n = d.len();
        system.tangent(to, Weights { q: to_q, v: to_v, a: 1.0, increment: Some(d) }, &mut self.tangent);
        if !self.rows.is_empty() {
            self.rows.add_border(system, to, n, &mut self.tangent);
            self.stabilize(system, to, d, h, [to_v, to_q]);
        }
        self.tangent.factor()
    }

    /// Adds the rows and columns of μ, where the form is stabilized.
    pub(super) fn stabilize(
        &mut self,
        system: &mut dyn Dynamics,
        to: &State,
        d: &[f64],
        h: f64,
        [_, to_q]: [f64; 2],
    ) {
        let Some(stiffness) = &mut self.stiffness else { return };
        let (n, m) = (d.len(), self.rows.len());
        let has = |row: usize| has_mu(self.rows.sets()[row], to, row);
        for k in (0..m).filter(|k| !has(*k)) {
            self.tangent.add(n + m + k, n + m + k, 1.0);
        }
        if !(0..m).any(has) {
            return;
        }
        system.tangent(to, Weights { q: 1.0, v: 0.0, a: 0.0, increment: Some(d) }, stiffness);
        let (rows, tangent, meeting) = (&self.rows, &mut self.tangent, &mut self.meeting);
        meeting.iter_mut().for_each(Vec::clear);
        for &(k, j, x) in rows.stored().iter().filter(|(k, ..)| has(*k)) {
            meeting[j].push((k, x));
            stiffness.column(j, |i, y| tangent.add(i, n + m + k, h * x * y));
        }
        system.jacobian(to, &mut |row, velocities, entries| {
            for (&j, &x) in velocities.iter().zip(entries).filter(|_| has(row)) {
                tangent.add(n + m + row, j, x);
                for &(k, y) in &meeting[j] {
                    tangent.add(n + row, n + m + k, h * x * y / to_q);
                }
            }
        });
    }
}

/// Whether a row has a multiplier μ: its position is imposed.
pub(super) fn has_mu(set: Set, s: &State, row: usize) -> bool {
    is_active(set, s.mode[row]) && !matches!(set, Set::Friction { .. })
}
