//! The size of steps: from the error of one step to the size of the next.
//!
//! With e the scaled error of a step (≤ 1 is accepted), p̂ + 1 the power of h with which it decreases and
//! S a safety factor, the next step is h·f with Söderlind's digital filter H211b,
//!
//! ```text
//! f = (S/eₙ)^(1/(4(p̂+1))) (S/eₙ₋₁)^(1/(4(p̂+1))) (hₙ/hₙ₋₁)^(−1/4) ≤ eₙ^(−1/(p̂+1)),   behind the first step  f = S e^(−1/(p̂+1))
//! ```
//!
//! It smooths the error's ups and downs within a vibration, so that steps, and with them the factors of the tangent, last. (Measured on
//! oscillators, a spring pendulum and a stiff pair: as many steps as Gustafsson's predictive controller and half the factorisations.)
//! S shrinks with the number of Newton iterations. The growth of a step is limited,
//! does not follow a rejection at once, and changes of −5 % to +40 % are not worth a new factorisation.
//!
//! Sources: Söderlind (2003, doi 10.1145/641876.641877); Hairer & Wanner, *Solving Ordinary Differential Equations II*, section IV.8
//! (doi 10.1007/978-3-642-05221-7).

use crate::system::State;

/// Error and size of an accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Past {
    step: f64,
    error: f64,
}

/// Step-size control. Its law heads the source file.
#[derive(Clone, Copy, Debug)]
pub struct StepControl {
    /// 1/(p̂ + 1)
    exponent: f64,
    shortest: f64,
    longest: f64,
    next: f64,
    past: Option<Past>,
    rejected: bool,
}

/// Safety factor S.
const SAFETY: f64 = 0.9;
/// Limits of f.
const SHRINK: f64 = 0.2;
const GROW: f64 = 8.0;
/// Factors in this range count as 1, so that the factors of the tangent serve again.
const DEAD_BAND: [f64; 2] = [0.95, 1.4];
/// Errors below this are taken as this.
const NEGLIGIBLE: f64 = 1e-10;
/// Iterations at which S is not lowered.
const MAX_ITERATIONS: f64 = 10.0;

impl StepControl {
    /// Control for an error estimate of order `estimate_order` (p̂), over runs of length `span`
    /// \[s\]: steps between 1e-18 and 1 times the span, beginning with `first`.
    pub fn new(estimate_order: usize, span: f64, first: f64) -> StepControl {
        let longest = span.abs();
        let shortest = 1e-18 * longest;
        StepControl {
            exponent: 1.0 / (estimate_order as f64 + 1.0),
            shortest,
            longest,
            next: first.clamp(shortest, longest),
            past: None,
            rejected: false,
        }
    }

    /// Another longest step \[s\]: it keeps step control from passing over short events.
    #[must_use]
    pub fn with_longest(mut self, longest: f64) -> StepControl {
        self.longest = longest.max(self.shortest);
        self.next = self.next.clamp(self.shortest, self.longest);
        self
    }

    /// A first step from the state itself \[s\]: tol^(1/(p̂+1)) times the shortest of scale/|v|,
    /// (scale/|a|)^½ and `span`/100, in the root mean square. Cheap and cautious; a wrong guess costs a
    /// few steps.
    pub fn first_step(
        estimate_order: usize,
        state: &State,
        scales: &[f64],
        tolerance: f64,
        span: f64,
    ) -> f64 {
        let mean = |x: &[f64]| {
            let sum: f64 = x.iter().zip(scales).map(|(x, scale)| (x / scale).powi(2)).sum();
            (sum / x.len().max(1) as f64).sqrt()
        };
        let (v, a) = (mean(&state.v), mean(&state.a));
        let mut time = 0.01 * span.abs();
        if v > 0.0 {
            time = time.min(1.0 / v);
        }
        if a > 0.0 {
            time = time.min(1.0 / a.sqrt());
        }
        time * libm::pow(tolerance.clamp(1e-14, 1.0), 1.0 / (estimate_order as f64 + 1.0))
    }

    /// Size of the next step \[s\], where `left` \[s\] remain to the next time that a step must end at.
    /// A remainder just above the step is halved rather than left as a sliver.
    pub fn propose(&self, left: f64) -> f64 {
        let h = self.next;
        if left <= h * (1.0 + 1e-9) {
            left
        } else if left < 2.0 * h {
            0.5 * left
        } else {
            h
        }
    }

    /// The step of size `h` with scaled error `error` and `iterations` Newton iterations was kept.
    pub fn accepted(&mut self, h: f64, error: f64, iterations: u32) {
        let error = error.max(NEGLIGIBLE);
        let safety = Self::safety(iterations);
        let k = self.exponent;
        let elementary = safety * libm::pow(error, -k);
        let mut factor = elementary;
        if let Some(past) = self.past {
            let ratio = h / past.step;
            let filtered = libm::pow((safety / error) * (safety / past.error), 0.25 * k);
            // Never more than the last error alone allows: a small one before it must not lengthen a step that just passed.
            factor = (filtered * libm::pow(ratio, -0.25)).min(elementary / safety);
        }
        factor = factor.clamp(SHRINK, GROW);
        if self.rejected {
            factor = factor.min(1.0);
        }
        // Smoothing laws ask for little at a time: the band must not hide what the error itself allows.
        if (DEAD_BAND[0]..DEAD_BAND[1]).contains(&factor) && elementary < DEAD_BAND[1] {
            factor = 1.0;
        }
        // A step cut short to end at a given time says little: keep the former proposal if it was larger
        // and the error does not speak against it.
        let next = if h < 0.99 * self.next && factor >= 1.0 { self.next.max(h * factor) } else { h * factor };
        self.next = next.clamp(self.shortest, self.longest);
        self.past = Some(Past { step: h, error });
        self.rejected = false;
    }

    /// The step of size `h` was thrown away for its scaled error `error` > 1.
    pub fn rejected(&mut self, h: f64, error: f64, iterations: u32) {
        // A very first step may be wrong by any factor.
        let factor = match self.past {
            None => 0.1,
            Some(_) => (Self::safety(iterations) * libm::pow(error, -self.exponent)).clamp(SHRINK, 0.9),
        };
        self.retreat(h * factor);
    }

    /// Newton's method failed in the step of size `h`.
    pub fn failed(&mut self, h: f64) {
        self.retreat(0.5 * h);
    }

    /// What the next steps depend on, for a [`Checkpoint`](super::Checkpoint): the next step, step and error of the
    /// last one (NaN before the first), and whether it was rejected.
    pub fn memory(&self) -> [f64; 4] {
        let past = self.past.unwrap_or(Past { step: f64::NAN, error: f64::NAN });
        [self.next, past.step, past.error, f64::from(u8::from(self.rejected))]
    }

    /// Takes up the [memory](StepControl::memory) of another run.
    pub fn recall(&mut self, [next, step, error, rejected]: [f64; 4]) {
        self.next = next;
        self.past = (!step.is_nan()).then_some(Past { step, error });
        self.rejected = rejected != 0.0;
    }

    /// Forgets the past at a discontinuity, and begins again with a step of size `first` at most.
    pub fn restart(&mut self, first: f64) {
        self.past = None;
        self.rejected = false;
        self.next = self.next.min(first).clamp(self.shortest, self.longest);
    }

    /// Whether a step of size `h` at time `t` is below what control or arithmetic resolves.
    pub fn is_too_small(&self, t: f64, h: f64) -> bool {
        h < self.shortest || h <= 4.0 * f64::EPSILON * t.abs()
    }

    fn retreat(&mut self, h: f64) {
        // Not clamped from below: the driver must see that the step has become too small.
        self.next = h.min(self.longest);
        self.rejected = true;
    }

    fn safety(iterations: u32) -> f64 {
        let most = 2.0 * MAX_ITERATIONS + 1.0;
        SAFETY * (most / (2.0 * MAX_ITERATIONS + f64::from(iterations.max(1)))).min(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A process whose error is (h/τ)^(p̂+1): the step must settle where the error is S^(p̂+1) at least and 1 at most, whatever the first
    /// step.
    #[test]
    fn it_settles_on_a_steady_process() {
        for first in [1e-6, 1e-2, 5.0] {
            let mut control = StepControl::new(3, 1000.0, first);
            let mut error = 0.0;
            for _ in 0..60 {
                let h = control.propose(f64::INFINITY);
                error = (h / 0.1_f64).powi(4);
                if error > 1.0 {
                    control.rejected(h, error, 1);
                } else {
                    control.accepted(h, error, 1);
                }
            }
            assert!((0.1..=1.0).contains(&error), "from {first}: error {error}");
        }
    }

    #[test]
    fn the_last_steps_end_where_they_must_without_a_sliver() {
        let control = StepControl::new(3, 10.0, 1.0);
        assert_eq!(control.propose(0.3), 0.3);
        assert_eq!(control.propose(1.1), 0.55);
        assert_eq!(control.propose(5.0), 1.0);
    }

    #[test]
    fn failures_shrink_the_step_until_it_is_called_too_small() {
        let mut control = StepControl::new(3, 1.0, 0.1);
        let mut halvings = 0;
        while !control.is_too_small(1.0, control.propose(1.0)) {
            control.failed(control.propose(1.0));
            halvings += 1;
        }
        assert!((40..60).contains(&halvings), "{halvings}");
    }

    /// After a rejection the next accepted step does not grow at once.
    #[test]
    fn a_step_does_not_grow_right_after_a_rejection() {
        let mut control = StepControl::new(3, 100.0, 1.0);
        control.accepted(1.0, 0.5, 1);
        control.rejected(1.0, 3.0, 1);
        let h = control.propose(50.0);
        assert!(h < 1.0);
        control.accepted(h, 1e-6, 1);
        assert_eq!(control.propose(50.0), h);
    }
}
