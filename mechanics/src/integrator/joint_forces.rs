//! Convergence of the forces of joints in Newton's method.
//!
//! What a joint takes up moves nothing, so that increments of displacements do not show whether its multipliers have converged: with a
//! kept tangent from which the joint has rotated by more than a radian each iteration magnifies their error.

use super::Progress;
use crate::system::Set;

/// A change that is not reduced to this part does not converge.
const STALLED: f64 = 0.5;

/// Judges the multipliers of rows that always hold. (Those of several contacts of one body may not be determined.)
#[derive(Clone, Copy, Debug)]
pub(super) struct JointForces {
    /// What the largest change may be over the largest multiplier, and what it was in the last iteration.
    allowed: f64,
    before: Option<f64>,
    /// Largest change and largest multiplier of this iteration.
    change: f64,
    largest: f64,
    /// Changes that are rounding errors, as far as known.
    rounding: f64,
}

impl JointForces {
    /// Changes of the part `allowed` of the largest multiplier are small.
    pub(super) fn new(allowed: f64) -> JointForces {
        JointForces { allowed, before: None, change: 0.0, largest: f64::MIN_POSITIVE, rounding: 0.0 }
    }

    /// Begins an iteration; `first`: of a step.
    pub(super) fn begin(&mut self, first: bool) {
        self.before = (!first).then_some(self.part());
        (self.change, self.largest) = (0.0, f64::MIN_POSITIVE);
    }

    /// Enters the change of the multiplier of a row and its value.
    #[inline]
    pub(super) fn enter(&mut self, set: Set, change: f64, value: f64) {
        if set == Set::Free {
            self.change = self.change.max(change.abs());
        }
        self.largest = self.largest.max(value.abs());
    }

    fn part(&self) -> f64 {
        self.change / self.largest
    }

    /// How fast the changes shrink, where this counts.
    pub(super) fn rate(&self) -> f64 {
        self.before.filter(|before| *before > self.allowed).map_or(0.0, |before| self.part() / before)
    }

    /// The verdict on an iteration whose displacements have converged: with a `fresh` tangent the forces do, down to rounding errors.
    pub(super) fn judge(&self, fresh: bool) -> Progress {
        match self.part() <= self.allowed {
            true => Progress::Converged,
            false if self.rate() <= STALLED => Progress::Continue,
            false if fresh => Progress::Converged,
            false => Progress::Diverged,
        }
    }

    /// The same of steps of one size, by what is still missing: changes that stalled with a fresh tangent are rounding errors with a kept
    /// one too.
    pub(super) fn judge_and_learn(&mut self, fresh: bool) -> Progress {
        let missing = match self.before {
            Some(before) if self.part() < before => self.part() * self.part() / (before - self.part()),
            _ => self.part(),
        };
        if missing <= self.allowed || self.change <= 4.0 * self.rounding {
            return Progress::Converged;
        }
        let verdict = self.judge(fresh);
        if verdict == Progress::Converged {
            self.rounding = self.change;
        }
        verdict
    }

    /// What later steps of one size depend on.
    pub(super) fn rounding(&self) -> f64 {
        self.rounding
    }

    /// Takes changes of this size for rounding errors.
    pub(super) fn learn(&mut self, rounding: f64) {
        self.rounding = rounding;
    }
}
