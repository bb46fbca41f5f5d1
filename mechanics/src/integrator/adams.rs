//! The Adams–Bashforth–Moulton pair of fourth order, PECE, explicit, fixed step.
//!
//! With y = (q, v), y′ = (v, a(t, q, v)) = f:
//!
//! ```text
//! predict   y* = yₙ + h/24 (55 fₙ − 59 fₙ₋₁ + 37 fₙ₋₂ − 9 fₙ₋₃)
//! evaluate  f* = f(tₙ₊₁, y*)
//! correct   yₙ₊₁ = yₙ + h/24 (9 f* + 19 fₙ − 5 fₙ₋₁ + fₙ₋₂)
//! evaluate  fₙ₊₁ = f(tₙ₊₁, yₙ₊₁)
//! ```
//!
//! Two evaluations a step. The first three steps, and those after a restart or a change of step, are
//! classical Runge–Kutta steps. Order: 4 in q, v, a (measured 4.0) on a vector space; a system with
//! rotations is refused, and one with constraints too unless [Baumgarte's constants](Adams::with_baumgarte) are given.
//!
//! Stability. On an undamped oscillation y′ = iωy the growth factor is the largest root ρ of
//!
//! ```text
//! ρ⁴ − (1 + (28 + 55·9/24 z) z/24) ρ³ − ((−5 − 59·9/24 z) z/24) ρ² − ((1 + 37·9/24 z) z/24) ρ + (9·9/24 z²/24) = 0,   z = iωh
//! ```
//!
//! It exceeds 1 for every step, ln |ρ| ≈ 0.16 (ωh)⁶ at first: there is no sharp limit but a growth to be
//! kept harmless. (At ωh = 0.93 a parasitic root takes over and the growth becomes violent.) The limit
//! taken here is ln |ρ| = 10⁻⁷, a factor e in 10⁷ steps: ωh = 0.0925. (At ωh = 0.29989, found by bisection on
//! the roots of the polynomial, it is e in 10⁴ steps, fewer than many runs have.) [`StabilityLimit`] refuses larger steps. Dense output: quintic.
//!
//! Source: Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, section III.1
//! (doi 10.1007/978-3-540-78862-1); Lambert, *Numerical Methods for Ordinary Differential Systems*,
//! section 4.5 (ISBN 978-0-471-92990-1).

use super::runge_kutta::RungeKuttaSteps;
use super::{
    Attempt, Checkpoint, Counters, Info, Integrator, NotResumed, RungeKutta, Span, StabilityLimit, StepError,
    StepReport, Stepper,
};
use crate::system::{Dynamics, State};

/// Name as in a case file.
const NAME: &str = "adams-4";

/// hω at which an undamped oscillation grows by the factor e in 10⁷ steps.
const LIMIT: f64 = 0.0925;

/// Names of the slopes in a checkpoint.
const HISTORY: [[&str; 2]; 3] = [["v.1", "a.1"], ["v.2", "a.2"], ["v.3", "a.3"]];

/// Velocities and accelerations at one former time.
#[derive(Debug)]
struct Slope {
    v: Vec<f64>,
    a: Vec<f64>,
}

/// The Adams–Bashforth–Moulton pair of order 4. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct Adams {
    /// The first steps, and all that explicit methods have in common.
    start: RungeKutta,
}

/// The method with its memory.
#[derive(Debug)]
struct AdamsSteps {
    start: RungeKuttaSteps,
    /// Slopes at tₙ₋₁, tₙ₋₂, tₙ₋₃.
    history: [Slope; 3],
    /// How many of them are valid, and the step they are apart.
    known: usize,
    spacing: f64,
    /// Step of the attempt.
    attempt: f64,
}

impl Adams {
    /// The method.
    pub fn new() -> Adams {
        Adams { start: RungeKutta::starting(NAME, LIMIT) }
    }

    /// The same method, with constraints stabilized by Baumgarte's constants δ and ε [1/s].
    #[must_use]
    pub fn with_baumgarte(self, delta: f64, epsilon: f64) -> Adams {
        Adams { start: self.start.with_baumgarte(delta, epsilon) }
    }

    /// The largest stable step at `state`, whose accelerations are completed.
    ///
    /// # Errors
    /// As [`RungeKutta::stability_limit`], and [`StepError::Unsupported`] for rotations.
    pub fn stability_limit(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
    ) -> Result<StabilityLimit, StepError> {
        refuse_rotations(system)?;
        self.start.stability_limit(system, state)
    }
}

/// Slopes of a configuration with rotations do not add up.
fn refuse_rotations(system: &dyn Dynamics) -> Result<(), StepError> {
    if system.is_vector_space() {
        return Ok(());
    }
    let (feature, instead) = ("rotations, whose increments do not add up", "runge-kutta-4");
    Err(StepError::Unsupported { method: NAME, feature, instead })
}

impl Default for Adams {
    fn default() -> Adams {
        Adams::new()
    }
}

impl Integrator for Adams {
    fn info(&self) -> &Info {
        self.start.info()
    }

    fn stepper(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
        step: f64,
        counters: &mut Counters,
    ) -> Result<Box<dyn Stepper>, StepError> {
        refuse_rotations(system)?;
        let n = state.v.len();
        let slope = || Slope { v: vec![0.0; n], a: vec![0.0; n] };
        let history = [slope(), slope(), slope()];
        let start = self.start.memory(system, state, counters)?;
        StabilityLimit::find(NAME, LIMIT, system, state)?.check(step)?;
        Ok(Box::new(AdamsSteps { start, history, known: 0, spacing: 0.0, attempt: 0.0 }))
    }
}

impl Stepper for AdamsSteps {
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        attempt: (Span, Attempt),
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        let h = attempt.0.step;
        self.attempt = h;
        let equidistant = (h - self.spacing).abs() <= 1e-9 * h.abs();
        if self.known < 3 || !equidistant {
            return self.start.step(system, from, attempt, to, counters);
        }
        let RungeKuttaSteps { accelerations, increment, .. } = &mut self.start;
        let n = from.v.len();
        let place = (from.t, h);
        let w = h / 24.0;
        let [f1, f2, f3] = &self.history;
        for i in 0..n {
            increment[i] = w * (55.0 * from.v[i] - 59.0 * f1.v[i] + 37.0 * f2.v[i] - 9.0 * f3.v[i]);
            let dv = w * (55.0 * from.a[i] - 59.0 * f1.a[i] + 37.0 * f2.a[i] - 9.0 * f3.a[i]);
            to.v[i] = from.v[i] + dv;
        }
        to.copy_modes(from);
        system.retract(&from.q, increment, &mut to.q);
        accelerations.complete(system, to, place, counters)?;
        for i in 0..n {
            increment[i] = w * (9.0 * to.v[i] + 19.0 * from.v[i] - 5.0 * f1.v[i] + f2.v[i]);
            to.v[i] = from.v[i] + w * (9.0 * to.a[i] + 19.0 * from.a[i] - 5.0 * f1.a[i] + f2.a[i]);
        }
        system.retract(&from.q, increment, &mut to.q);
        accelerations.complete(system, to, place, counters)?;
        Ok(StepReport::default())
    }

    fn accept(&mut self, from: &State, to: &State) {
        let h = self.attempt;
        if (h - self.spacing).abs() > 1e-9 * h.abs() {
            self.spacing = h;
            self.known = 0;
        }
        self.history.rotate_right(1);
        self.history[0].v.copy_from_slice(&from.v);
        self.history[0].a.copy_from_slice(&from.a);
        self.known = (self.known + 1).min(3);
        self.start.accept(from, to);
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        self.start.interpolate(system, from, to, t, out);
    }

    fn restart(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        self.known = 0;
        self.start.restart(system, state, counters)
    }

    fn save(&self, out: &mut Checkpoint) {
        out.put("known", &[self.known as f64, self.spacing]);
        for (slope, [v, a]) in self.history.iter().zip(HISTORY) {
            out.put(v, &slope.v);
            out.put(a, &slope.a);
        }
    }

    fn resume(&mut self, _system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        let [known, spacing] = from.numbers("known")?;
        (self.known, self.spacing) = (known as usize, spacing);
        for (slope, [v, a]) in self.history.iter_mut().zip(HISTORY) {
            from.fill(v, &mut slope.v)?;
            from.fill(a, &mut slope.a)?;
        }
        Ok(())
    }
}
