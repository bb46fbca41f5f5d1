//! Convergence of Newton's method, judged in scaled norms.
//!
//! The size of an increment Δ is its weighted root mean square, ‖Δ‖ = (1/n Σ (Δᵢ/wᵢ)²)^½. From two sizes in a row
//! follow the rate θ = ‖Δₖ‖/‖Δₖ₋₁‖, and with η = θ/(1 − θ) the estimate η‖Δₖ‖ of what is still missing. A simplified
//! iteration (with a kept tangent) stops
//!
//! - as converged, when η‖Δₖ‖ ≤ tolerance; the first increment is judged by the η of the last step, raised to a power;
//! - as diverged, when θ ≥ 1, or when θ^(kₘₐₓ−k) η‖Δₖ‖ > tolerance: the iterations left will not do.
//!
//! Source: Hairer & Wanner, *Solving Ordinary Differential Equations II*, section IV.8
//! (doi 10.1007/978-3-642-05221-7).
//!
//! Increments that are rounding errors of the residual do not shrink: with a new tangent, an increment that is not
//! halved any more and is smaller than `noise` ends the iteration. Its size is the least that later iterations with
//! this tangent are asked for.

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
    max_iterations: u32,
    /// Whether the tangent is kept during the iteration, so that convergence is linear at best.
    simplified: bool,
    /// Power of η < 1 with which it is carried over from one step to the next.
    fading: f64,
    iteration: u32,
    /// Whether the tangent is of this step.
    fresh: bool,
    previous: f64,
    rate: f64,
    eta: f64,
    /// Size of increments that are rounding errors, as far as known with this tangent.
    rounding: f64,
}

/// An increment that is not reduced to this part has stopped shrinking, where the tangent is new.
const STALLED: f64 = 0.5;

impl Convergence {
    /// Full Newton iteration (a new tangent every time) to the iteration error `tolerance`: at most 20
    /// iterations, increments may grow in the first three.
    pub fn full(tolerance: f64, noise: f64) -> Convergence {
        Convergence {
            tolerance,
            noise,
            max_iterations: 20,
            simplified: false,
            fading: 0.8,
            iteration: 0,
            fresh: true,
            previous: 0.0,
            rate: 0.0,
            eta: 1.0,
            rounding: 0.0,
        }
    }

    /// Simplified Newton iteration (one tangent) to the iteration error `tolerance`: at most 10 iterations.
    pub fn simplified(tolerance: f64, noise: f64) -> Convergence {
        Convergence { max_iterations: 10, simplified: true, ..Convergence::full(tolerance, noise) }
    }

    /// Like [`Convergence::simplified`], for a tangent that is kept over many equal steps: η of the last step is
    /// forgotten more slowly.
    pub fn kept(tolerance: f64, noise: f64) -> Convergence {
        Convergence { fading: 0.95, ..Convergence::simplified(tolerance, noise) }
    }

    /// The same, with another largest size of increments that may be rounding errors.
    pub fn with_noise(self, noise: f64) -> Convergence {
        Convergence { noise, ..self }
    }

    /// Begins the iteration of a new attempt; `fresh`: with a tangent of this step, not of one before.
    pub fn begin(&mut self, fresh: bool) {
        self.iteration = 0;
        self.fresh = fresh;
        self.rate = 0.0;
        if fresh {
            self.rounding = 0.0;
        }
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
        let tolerance = self.tolerance.max(2.0 * self.rounding);
        if self.iteration > 1 {
            self.rate = if self.previous > 0.0 { size / self.previous } else { 0.0 };
            if self.fresh && self.rate >= STALLED && size <= self.noise {
                self.rounding = size;
                return Progress::Converged;
            }
            if self.rate < 1.0 {
                self.eta = self.rate / (1.0 - self.rate);
                let left = self.max_iterations.saturating_sub(self.iteration) as i32;
                if self.simplified && self.rate.powi(left) * self.eta * size > tolerance {
                    return Progress::Diverged;
                }
            } else if self.simplified || (self.iteration > 3 && self.rate >= 2.0) {
                return Progress::Diverged;
            } else {
                self.eta = f64::INFINITY;
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

    /// What later attempts depend on.
    pub(super) fn memory(&self) -> [f64; 3] {
        [self.eta, self.rate, self.rounding]
    }

    /// Continues from the [memory](Convergence::memory) of another run.
    pub(super) fn recall(&mut self, memory: [f64; 3]) {
        [self.eta, self.rate, self.rounding] = memory;
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
