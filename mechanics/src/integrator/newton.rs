//! Convergence of Newton's method, judged in scaled norms.
//!
//! The size of an increment Δ is its weighted root mean square, ‖Δ‖ = (1/n Σ (Δᵢ/wᵢ)²)^½. From two
//! sizes in a row follow the rate θ = ‖Δₖ‖/‖Δₖ₋₁‖ and the estimate of what is still missing,
//! θ/(1 − θ)·‖Δₖ‖. Source: Hairer & Wanner, *Solving Ordinary Differential Equations II*, section IV.8
//! (doi 10.1007/978-3-642-05221-7).
//!
//! Below a certain size increments are rounding errors of the residual and no longer shrink: with finite
//! elements of length ℓ that size grows as ℓ⁻⁴. It is learnt where an iteration stalls, is left out of the
//! rates measured from then on, and no smaller iteration error is asked for. It fades, and so is learnt anew.

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

/// Watches one Newton iteration after another.
#[derive(Clone, Copy, Debug)]
pub struct Convergence {
    /// Size of the iteration error at which to stop.
    tolerance: f64,
    /// Below this size an increment that no longer shrinks is rounding error: converged.
    floor: f64,
    max_iterations: u32,
    /// Whether the tangent is kept during the iteration, so that convergence is linear at best.
    simplified: bool,
    iteration: u32,
    /// Whether the tangent is of this step.
    fresh: bool,
    /// Sizes of the last increment and of the one before.
    previous: f64,
    earlier: f64,
    rate: f64,
    /// θ/(1 − θ), carried over from one step to the next by simplified iterations.
    ahead: f64,
    /// Power with which `ahead` < 1 fades from step to step.
    fading: f64,
    /// Size of increments that are rounding errors, as far as known.
    rounding: f64,
    /// Largest size of increments that are taken for rounding errors when their shrinking comes to a sudden end.
    noise: f64,
}

/// Share of the known size of rounding errors that is kept from step to step.
const FADE: f64 = 0.99;

/// Shrinking by less than this may be the end of convergence.
const STALLED: f64 = 0.3;

impl Convergence {
    /// Full Newton iteration (a new tangent every time) to the iteration error `tolerance`: at most 20
    /// iterations, increments may grow in the first three.
    pub fn full(tolerance: f64) -> Convergence {
        Convergence {
            tolerance,
            floor: 100.0 * tolerance,
            max_iterations: 20,
            simplified: false,
            iteration: 0,
            fresh: true,
            previous: 0.0,
            earlier: 0.0,
            rate: 0.0,
            ahead: 1.0,
            fading: 0.8,
            rounding: 0.0,
            noise: 0.0,
        }
    }

    /// Simplified Newton iteration (one tangent) to the iteration error `tolerance`: at most
    /// 10 iterations, given up as soon as the rate shows that they will not do. Increments below
    /// `floor` that no longer shrink count as rounding error.
    pub fn simplified(tolerance: f64, floor: f64) -> Convergence {
        Convergence { tolerance, floor, max_iterations: 10, simplified: true, ..Convergence::full(tolerance) }
    }

    /// Like [`Convergence::simplified`], for a tangent that is kept over many equal steps: what was learnt
    /// about the rate is forgotten more slowly.
    pub fn kept(tolerance: f64, floor: f64) -> Convergence {
        Convergence { fading: 0.95, ..Convergence::simplified(tolerance, floor) }
    }

    /// The same, which takes increments up to the size `noise` for rounding errors when they suddenly
    /// stop shrinking, though the tangent is new.
    pub fn with_noise(self, noise: f64) -> Convergence {
        Convergence { noise, ..self }
    }

    /// Begins the iteration of a new attempt; `fresh`: with a tangent of this step, not of one before.
    pub fn begin(&mut self, fresh: bool) {
        self.iteration = 0;
        self.fresh = fresh;
        self.rate = 0.0;
        self.rounding *= FADE;
        self.ahead = if self.simplified { self.ahead.max(f64::EPSILON).powf(self.fading) } else { 1.0 };
    }

    /// Forgets the rates of former steps.
    pub fn forget(&mut self) {
        self.ahead = 1.0;
    }

    /// Judges the increment of size `size`.
    pub fn judge(&mut self, size: f64) -> Progress {
        self.iteration += 1;
        if !size.is_finite() {
            return Progress::Diverged;
        }
        // An old tangent may be wrong in just the direction that grows: rounding is left to new ones.
        let noise = if self.fresh { self.noise } else { 0.0 };
        let allowed = self.tolerance.max(self.rounding);
        if self.iteration > 1 {
            let ratio = if self.previous > 0.0 { size / self.previous } else { 0.0 };
            if self.stalls(ratio, size, noise) {
                if self.fresh && self.simplified {
                    self.rounding = self.rounding.max(size);
                }
                return Progress::Converged;
            }
            // Rounding errors say nothing about the rate.
            let ratio = ratio * (1.0 - self.rounding / size).max(0.0);
            // From the third iteration on the geometric mean of two ratios, as Hairer & Wanner do.
            let smooth = self.simplified && self.iteration > 2;
            self.rate = if smooth { (ratio * self.rate).sqrt() } else { ratio };
            if self.rate < 0.99 {
                self.ahead = self.rate / (1.0 - self.rate);
                let left = self.max_iterations.saturating_sub(self.iteration) as i32;
                let predicted = self.ahead * size * self.rate.powi(left);
                if self.simplified && predicted > allowed && size > noise {
                    return Progress::Diverged;
                }
            } else if (self.simplified && size > noise) || (self.iteration > 3 && ratio >= 2.0) {
                return Progress::Diverged;
            } else {
                self.ahead = f64::INFINITY;
            }
        }
        (self.earlier, self.previous) = (self.previous, size);
        if size == 0.0 || self.ahead * size <= allowed {
            Progress::Converged
        } else if self.iteration >= self.max_iterations {
            Progress::Diverged
        } else {
            Progress::Continue
        }
    }

    /// What later attempts depend on.
    pub(super) fn memory(&self) -> [f64; 3] {
        [self.ahead, self.rate, self.rounding]
    }

    /// Takes up the [memory](Convergence::memory) of another run.
    pub(super) fn recall(&mut self, memory: [f64; 3]) {
        [self.ahead, self.rate, self.rounding] = memory;
    }

    /// Whether an increment of this size, `ratio` times the one before, is rounding error.
    fn stalls(&self, ratio: f64, size: f64, noise: f64) -> bool {
        if !(ratio >= STALLED) {
            return false;
        }
        // Convergence is linear at least: where it was fast, it does not become slow but by rounding.
        let expected = if self.iteration > 2 { self.rate } else { self.ahead };
        let ended = ratio >= 4.0 * expected || (self.iteration > 2 && size >= 0.5 * self.earlier);
        size <= self.floor || size <= 2.0 * self.rounding || (size <= noise && ended)
    }

    /// Takes increments of this size for rounding errors.
    pub fn learn_rounding(&mut self, size: f64) {
        self.rounding = size;
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
