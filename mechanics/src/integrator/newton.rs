//! Convergence of Newton's method, judged in scaled norms.
//!
//! The size of an increment Δ is its weighted root mean square, ‖Δ‖ = (1/n Σ (Δᵢ/wᵢ)²)^½. From two sizes in a row
//! follow the rate θ = ‖Δₖ‖/‖Δₖ₋₁‖, and with η = θ/(1 − θ) the estimate η‖Δₖ‖ of what is still missing. A simplified
//! iteration (with a kept tangent) stops
//!
//! - as converged, when η‖Δₖ‖ ≤ tolerance; the first increment is judged by the η of the last step, raised to a power;
//! - as diverged, from the third increment on, when θ ≥ 1, or when θ^(kₘₐₓ−k) η‖Δₖ‖ > tolerance: the iterations left will not do.
//!
//! Tangents that have turned away from the axis of a slender beam by a small angle make errors along it of errors across it and
//! the other way, so that increments shrink at every second iteration only: from the third increment on θ is the geometric mean
//! of the last two ratios, η is that of the larger one, and the second increment may be twice the first.
//!
//! Source: Hairer & Wanner, *Solving Ordinary Differential Equations II*, section IV.8
//! (doi 10.1007/978-3-642-05221-7).
//!
//! Where steps are not controlled, the tolerance is at least a part of the first increment, which is what the step adds
//! to its prediction: the iteration error is then far below the error of the step.
//!
//! Increments that are rounding errors of the residual do not shrink: with a new tangent, an increment that is not
//! halved any more, for the second time, and is smaller than `noise` ends the iteration. Its size is the least that later iterations are asked
//! for. For an affine system the first increment with a new tangent is exact, so the second one measures it.

/// What to do after an iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// The iteration error is below the tolerance.
    Converged,
    /// Iterate on.
    Continue,
    /// The iteration diverges, is too slow, or produced a number that is not finite.
    Diverged,
}

/// Judges the iterations of one step after another.
#[derive(Clone, Copy, Debug)]
pub struct Convergence {
    /// Size of the iteration error at which to stop.
    tolerance: f64,
    /// Largest size of an increment that may be rounding error.
    noise: f64,
    /// Part of the first increment that the iteration error may have.
    part: f64,
    allowed: f64,
    max_iterations: u32,
    /// Whether the tangent is kept during the iteration, so that convergence is linear at best.
    simplified: bool,
    /// Power of η < 1 with which it is carried over from one step to the next.
    fading: f64,
    iteration: u32,
    /// Whether the tangent is of this step.
    fresh: bool,
    previous: f64,
    /// Ratio of the last two increments, and the rate.
    ratio: f64,
    rate: f64,
    eta: f64,
    /// Size of increments that are rounding errors, as far as known, and whether it has grown.
    rounding: f64,
    stalled: bool,
}

/// Part of the first increment that the iteration error may have, where steps are not controlled.
const PART: f64 = 1e-5;

/// An increment that is not reduced to this part has stopped shrinking, where the tangent is new.
const STALLED: f64 = 0.5;

/// An increment that grows by this factor shows that the iteration diverges.
const GROWN: f64 = 2.0;

impl Convergence {
    /// Full Newton iteration (a new tangent every time) to the iteration error `tolerance`: at most 20
    /// iterations, increments may grow in the first three.
    pub fn full(tolerance: f64, noise: f64) -> Convergence {
        Convergence {
            tolerance,
            noise,
            part: 0.0,
            allowed: tolerance,
            max_iterations: 20,
            simplified: false,
            fading: 0.8,
            iteration: 0,
            fresh: true,
            previous: 0.0,
            ratio: 0.0,
            rate: 0.0,
            eta: 1.0,
            rounding: 0.0,
            stalled: false,
        }
    }

    /// Simplified Newton iteration (one tangent) to the iteration error `tolerance`: at most 10 iterations.
    pub fn simplified(tolerance: f64, noise: f64) -> Convergence {
        Convergence { max_iterations: 10, simplified: true, ..Convergence::full(tolerance, noise) }
    }

    /// Like [`Convergence::simplified`], for a tangent that is kept over many equal steps: η of the last step is
    /// forgotten more slowly, and the iteration error may be a hundred-thousandth of the first increment.
    pub fn kept(tolerance: f64, noise: f64) -> Convergence {
        Convergence { fading: 0.95, part: PART, ..Convergence::simplified(tolerance, noise) }
    }

    /// Like [`Convergence::simplified`], without a rate of former attempts: each one measures its own.
    pub(super) fn measured(tolerance: f64, noise: f64) -> Convergence {
        Convergence { fading: 0.0, ..Convergence::simplified(tolerance, noise) }
    }

    /// Another size of the iteration error from now on.
    pub(super) fn aim(&mut self, tolerance: f64) {
        self.tolerance = tolerance;
    }

    /// Whether this is the size of the iteration error.
    pub(super) fn aims_at(&self, tolerance: f64) -> bool {
        self.tolerance == tolerance
    }

    /// Begins the iteration of a new attempt; `fresh`: with a tangent of this step, not of one before.
    pub fn begin(&mut self, fresh: bool) {
        self.iteration = 0;
        self.fresh = fresh;
        self.rate = 0.0;
        self.eta = if self.simplified { libm::pow(self.eta.max(f64::EPSILON), self.fading) } else { 1.0 };
    }

    /// Forgets the rates of former steps.
    pub fn forget(&mut self) {
        self.eta = 1.0;
    }

    /// Judges the increment of size `size`.
    pub fn judge(&mut self, size: f64) -> Progress {
        self.iteration += 1;
        if !size.is_finite() {
            return Progress::Diverged;
        }
        if self.iteration == 1 {
            self.allowed = self.tolerance.max(4.0 * self.rounding).max(self.part * size);
        }
        let tolerance = self.allowed;
        if self.iteration > 1 {
            let ratio = if self.previous > 0.0 { size / self.previous } else { 0.0 };
            let small = if self.fresh { self.noise } else { self.noise.min(10.0 * self.rounding) };
            // Not by the second increment alone, unless the first was as small: it may be an error of the tangent, which the third one
            // shows.
            let again = if self.iteration > 2 { self.ratio >= STALLED } else { self.previous <= tolerance };
            let stalls = ratio >= STALLED && size <= small;
            if stalls && again {
                self.rounding = self.rounding.max(size);
                return Progress::Converged;
            }
            self.stalled |= ratio >= STALLED && size <= self.noise;
            let alternates = self.simplified && self.iteration > 2;
            self.rate = if alternates { (ratio * self.ratio).sqrt() } else { ratio };
            let worst = if alternates { ratio.max(self.ratio) } else { ratio };
            self.eta = if worst < 1.0 { worst / (1.0 - worst) } else { f64::INFINITY };
            self.ratio = ratio;
            let left = self.max_iterations.saturating_sub(self.iteration) as i32;
            let diverges = if self.iteration <= 2 {
                self.simplified && ratio >= GROWN
            } else if self.simplified {
                !stalls && (self.rate >= 1.0 || self.rate.powi(left) * self.eta * size > tolerance)
            } else {
                self.iteration > 3 && ratio >= GROWN
            };
            if diverges {
                return Progress::Diverged;
            }
        }
        self.previous = size;
        if size == 0.0 || self.eta * size <= tolerance {
            Progress::Converged
        } else if self.iteration >= self.max_iterations {
            Progress::Diverged
        } else {
            Progress::Continue
        }
    }

    /// η of this iteration; before its second increment, that carried over from the step before.
    pub(super) fn eta(&self) -> f64 {
        self.eta
    }

    /// Whether the size of rounding errors is to be learnt from the second increment of an exact iteration.
    pub(super) fn wants_rounding(&self) -> bool {
        self.stalled
    }

    /// Takes increments of this size for rounding errors.
    pub(super) fn learn_rounding(&mut self, size: f64) {
        (self.rounding, self.stalled) = (size, false);
    }

    /// What later attempts depend on.
    pub(super) fn memory(&self) -> [f64; 4] {
        [self.eta, self.rate, self.rounding, f64::from(u8::from(self.stalled))]
    }

    /// Continues from the [memory](Convergence::memory) of another run.
    pub(super) fn recall(&mut self, [eta, rate, rounding, stalled]: [f64; 4]) {
        (self.eta, self.rate, self.rounding, self.stalled) = (eta, rate, rounding, stalled != 0.0);
    }

    /// Iterations of this attempt.
    pub fn iterations(&self) -> u32 {
        self.iteration
    }

    /// Last measured rate θ; 0 when one iteration was enough.
    pub fn rate(&self) -> f64 {
        self.rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdicts(sizes: &[f64]) -> Vec<Progress> {
        let mut convergence = Convergence::measured(1e-16, 1e-7);
        convergence.learn_rounding(1e-16);
        convergence.begin(true);
        sizes.iter().map(|size| convergence.judge(*size)).collect()
    }

    #[test]
    fn two_increments_of_one_size_are_no_rounding_errors_and_three_are() {
        use Progress::{Continue, Converged};
        // The second is an error of the tangent along the axis of a beam.
        assert_eq!(verdicts(&[3e-8, 2e-8, 1e-14, 1e-21]), [Continue, Continue, Continue, Converged]);
        assert_eq!(verdicts(&[3e-8, 2e-8, 1.5e-8]), [Continue, Continue, Converged]);
        assert_eq!(verdicts(&[1e-3, 2e-8, 1.5e-8, 1.2e-8]), [Continue, Continue, Continue, Converged]);
        assert_eq!(verdicts(&[1e-17, 3e-17])[1], Converged);
    }
}
