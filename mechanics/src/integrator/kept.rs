//! Tangents that are kept from step to step: when their factors serve, and when new ones are due.
//!
//! Between renewals they are rotated with the sections (see [`Dynamics::corotate`]), without which the axial stiffness of a slender
//! beam soon points in wrong directions.

use super::{Checkpoint, NotResumed};
use crate::linalg::Matrix;
use crate::system::{Corotation, Dynamics, State};

/// Cost of a tangent and its factors, in iterations.
const RENEWAL: f64 = 2.0;

/// Relative difference of two steps by which divisions of the same time differ.
const SAME: f64 = 1e-9;

/// Rate of convergence below which tangents serve the next step too.
const REUSE_RATE: f64 = 0.03;

/// Where a tangent was assembled, for which weights it is factored, and whether it has aged.
#[derive(Debug)]
pub(super) struct KeptTangent {
    /// Where it was assembled.
    pub(super) place: State,
    /// Weights of v and q in its factors; NaN without factors.
    pub(super) weights: [f64; 2],
    /// How the sections have rotated since.
    corotation: Corotation,
    /// Whether it was assembled in the step under way.
    pub(super) fresh: bool,
    /// Whether the next step is to have a new one.
    pub(super) due: bool,
    /// Iterations since the renewal, its own cost included, and steps.
    cost: f64,
    steps: f64,
}

impl KeptTangent {
    pub(super) fn new(system: &dyn Dynamics, state: &State) -> KeptTangent {
        KeptTangent {
            place: State::zeros(system.size(), state.t),
            weights: [f64::NAN; 2],
            corotation: corotation(system, state),
            fresh: false,
            due: false,
            cost: 0.0,
            steps: 0.0,
        }
    }

    /// Forgets tangent and factors; `due`: the first step asks for new ones whatever its weights are.
    pub(super) fn forget(&mut self, due: bool) {
        self.weights = [f64::NAN; 2];
        (self.due, self.cost, self.steps) = (due, 0.0, 0.0);
    }

    /// The tangent has been assembled anew for the step under way.
    pub(super) fn renewed(&mut self) {
        (self.fresh, self.due, self.cost, self.steps) = (true, false, RENEWAL, 0.0);
    }

    /// Whether the factors have these weights, but for rounding.
    pub(super) fn serves(&self, weights: [f64; 2]) -> bool {
        self.weights.iter().zip(weights).all(|(kept, x)| (kept - x).abs() <= SAME * x)
    }

    /// The rule of age replacement: a new tangent is due as soon as a step costs more iterations than the mean step since the last
    /// renewal, the cost of the renewal included. Its mean cost is then least.
    pub(super) fn age(&mut self, iterations: u32) {
        self.cost += f64::from(iterations);
        self.steps += 1.0;
        self.due = f64::from(iterations) * self.steps > self.cost;
    }

    /// The rule of methods whose steps change: a new tangent is due when an iteration has converged at a slow rate.
    pub(super) fn judge_rate(&mut self, rate: f64) {
        self.due = rate > REUSE_RATE;
    }

    /// Finds how the sections have rotated from the place to `to`.
    pub(super) fn rotate_to(&mut self, system: &dyn Dynamics, to: &State) {
        system.corotate(&self.place, to, &mut self.corotation);
    }

    /// The tangent is that of the place.
    pub(super) fn unrotate(&mut self) {
        self.corotation.clear();
    }

    /// `x` = A⁻¹ x with the rotated tangent.
    pub(super) fn solve(&self, factors: &mut Matrix, x: &mut [f64]) {
        self.corotation.rotate_back(x);
        factors.solve(x);
        self.corotation.rotate(x);
    }

    /// `out` = A x with the rotated `matrix`; `x` is lost.
    pub(super) fn multiply(&self, matrix: &Matrix, x: &mut [f64], out: &mut [f64]) {
        self.corotation.rotate_back(x);
        matrix.multiply(x, out);
        self.corotation.rotate(out);
    }

    pub(super) fn save(&self, out: &mut Checkpoint) {
        let [v, q] = self.weights;
        out.put("tangent", &[v, q, self.cost, self.steps, f64::from(u8::from(self.due))]);
        out.put_state("tangent.", &self.place);
    }

    /// What [`KeptTangent::save`] wrote; matrix and factors are to be made at the place.
    pub(super) fn resume(&mut self, from: &Checkpoint) -> Result<(), NotResumed> {
        let [v, q, cost, steps, due] = from.numbers("tangent")?;
        if ![cost, steps, due].iter().all(|x| x.is_finite()) || v.is_nan() != q.is_nan() {
            return Err(NotResumed::Invalid("tangent".to_owned()));
        }
        (self.weights, self.cost, self.steps, self.due) = ([v, q], cost, steps, due != 0.0);
        self.fresh = false;
        from.fill_state("tangent.", &mut self.place)
    }
}

/// Memory for the rotations of a system's sections.
pub(super) fn corotation(system: &dyn Dynamics, state: &State) -> Corotation {
    let mut made = Corotation::default();
    system.corotate(state, state, &mut made);
    made.emptied()
}
