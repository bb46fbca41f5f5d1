//! The classical Runge–Kutta method: fourth order, explicit, fixed step.
//!
//! With a(t, q, v) = M⁻¹ f and y = (q, v),
//!
//! ```text
//! a₁ = a(tₙ, qₙ, vₙ)                 v₂ = vₙ + h/2 a₁     q₂ = qₙ ⊞ h/2 vₙ
//! a₂ = a(tₙ + h/2, q₂, v₂)           v₃ = vₙ + h/2 a₂     q₃ = qₙ ⊞ h/2 v₂
//! a₃ = a(tₙ + h/2, q₃, v₃)           v₄ = vₙ + h a₃       q₄ = qₙ ⊞ h v₃
//! a₄ = a(tₙ + h, q₄, v₄)
//! vₙ₊₁ = vₙ + h/6 (a₁ + 2a₂ + 2a₃ + a₄),   qₙ₊₁ = qₙ ⊞ h/6 (vₙ + 2v₂ + 2v₃ + v₄)
//! ```
//!
//! On a configuration that is not a vector space (rotations), increments from qₙ are integrated with their rates
//! ḋ = T(d)⁻¹ v in the place of v (Munthe-Kaas). Constraints take Baumgarte's form g̈ + 2δ ġ + ε² g = 0, with the
//! constants given to [`RungeKutta::with_baumgarte`]; without them a system with constraints is refused.
//!
//! a(tₙ₊₁, qₙ₊₁, vₙ₊₁) is evaluated at the end of a step and serves as a₁ of the next: four evaluations a
//! step. Order: 4 in q, v, a (measured 4.0, also on rotations). Stability: undamped
//! frequencies up to hω = 2√2, where it dissipates; [`StabilityLimit`] refuses larger steps. Heavy damping
//! lowers the limit (real eigenvalues of the first-order form must stay above −2.785/h).
//! Dense output: quintic.
//!
//! Source: Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, section II.1
//! (doi 10.1007/978-3-540-78862-1).

use super::acceleration::Accelerations;
use super::{
    Attempt, Checkpoint, Counters, Info, Integrator, NotResumed, Span, StabilityLimit, StepError, StepReport,
    Stepper, hermite,
};
use crate::system::{Dynamics, RowWeights, Side, State};

/// Name as in a case file.
const NAME: &str = "runge-kutta-4";

/// Largest stable hω on the imaginary axis, 2√2.
const LIMIT: f64 = 2.828_427_124_746_190_3;

/// The classical Runge–Kutta method. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct RungeKutta {
    info: Info,
    /// Largest stable hω.
    stable: f64,
    baumgarte: Option<RowWeights>,
}

/// The method with its memory.
#[derive(Debug)]
pub(super) struct RungeKuttaSteps {
    pub(super) accelerations: Accelerations,
    stage: State,
    is_vector_space: bool,
    /// Rate ḋ of the increment at the stage.
    rate: Vec<f64>,
    /// Weighted sums of the stages' accelerations and rates.
    sum_v: Vec<f64>,
    sum_d: Vec<f64>,
    /// qₙ₊₁ ⊟ qₙ of the attempt and of the accepted step.
    pub(super) increment: Vec<f64>,
    accepted: Vec<f64>,
}

impl RungeKutta {
    /// The method.
    pub fn new() -> RungeKutta {
        RungeKutta::starting(NAME, LIMIT)
    }

    /// The same, as the start of the explicit method of order 4 with this name and this largest stable hω.
    pub(super) fn starting(name: &'static str, stable: f64) -> RungeKutta {
        let info = Info { name, order: 4, estimate_order: None, implicit: false };
        RungeKutta { info, stable, baumgarte: None }
    }

    /// The same method, with constraints stabilized by Baumgarte's constants δ and ε [1/s].
    #[must_use]
    pub fn with_baumgarte(self, delta: f64, epsilon: f64) -> RungeKutta {
        RungeKutta { baumgarte: Some(RowWeights::baumgarte(delta, epsilon)), ..self }
    }

    /// The largest stable step at `state`, whose accelerations are completed.
    ///
    /// # Errors
    /// [`StepError::Unsupported`] for constraints without Baumgarte's constants; [`StepError`] for a state without accelerations.
    pub fn stability_limit(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
    ) -> Result<StabilityLimit, StepError> {
        self.memory(system, state, &mut Counters::default())?;
        StabilityLimit::find(self.info.name, self.stable, system, state)
    }

    /// The method with its memory; completes `state`.
    pub(super) fn memory(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<RungeKuttaSteps, StepError> {
        let size = system.size();
        if size.lambda > 0 && self.baumgarte.is_none() {
            let (method, feature) = (self.info.name, "constraints");
            let instead =
                "Baumgarte's constants (key `baumgarte` of the integrator), generalized-alpha or radau";
            return Err(StepError::Unsupported { method, feature, instead });
        }
        let vector = || vec![0.0; size.v];
        let mut steps = RungeKuttaSteps {
            accelerations: Accelerations::new(
                system,
                state,
                self.baumgarte.unwrap_or(RowWeights::ACCELERATION),
            ),
            stage: State::zeros(size, 0.0),
            is_vector_space: system.is_vector_space(),
            rate: vector(),
            sum_v: vector(),
            sum_d: vector(),
            increment: vector(),
            accepted: vector(),
        };
        steps.restart(system, state, counters)?;
        Ok(steps)
    }
}

impl Default for RungeKutta {
    fn default() -> RungeKutta {
        RungeKutta::new()
    }
}

impl Integrator for RungeKutta {
    fn info(&self) -> &Info {
        &self.info
    }

    fn stepper(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
        step: f64,
        counters: &mut Counters,
    ) -> Result<Box<dyn Stepper>, StepError> {
        let steps = self.memory(system, state, counters)?;
        StabilityLimit::find(self.info.name, self.stable, system, state)?.check(step)?;
        Ok(Box::new(steps))
    }
}

impl Stepper for RungeKuttaSteps {
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        (span, _): (Span, Attempt),
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        let (n, h) = (from.v.len(), span.step);
        let place = (from.t, h);
        self.stage.copy_modes(from);
        self.stage.a.copy_from_slice(&from.a);
        self.rate.copy_from_slice(&from.v);
        self.sum_v.copy_from_slice(&from.a);
        self.sum_d.copy_from_slice(&from.v);
        // Part of the step and weight of the stages 2, 3, 4.
        for (c, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let step = c * h;
            for i in 0..n {
                self.stage.v[i] = from.v[i] + step * self.stage.a[i];
                self.increment[i] = step * self.rate[i];
            }
            (self.stage.t, self.stage.side) =
                if c < 1.0 { (from.t + step, Side::Right) } else { (to.t, to.side) };
            system.retract(&from.q, &self.increment, &mut self.stage.q);
            self.accelerations.complete(system, &mut self.stage, place, counters)?;
            if self.is_vector_space {
                self.rate.copy_from_slice(&self.stage.v);
            } else {
                system.rate(&from.q, &self.increment, &self.stage.v, &mut self.rate);
            }
            for i in 0..n {
                self.sum_v[i] += weight * self.stage.a[i];
                self.sum_d[i] += weight * self.rate[i];
            }
        }
        for i in 0..n {
            to.v[i] = from.v[i] + h / 6.0 * self.sum_v[i];
            self.increment[i] = h / 6.0 * self.sum_d[i];
        }
        to.copy_modes(from);
        system.retract(&from.q, &self.increment, &mut to.q);
        self.accelerations.complete(system, to, place, counters)?;
        Ok(StepReport::default())
    }

    fn accept(&mut self, _from: &State, _to: &State) {
        std::mem::swap(&mut self.increment, &mut self.accepted);
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        hermite::quintic(system, from, to, &self.accepted, t, out);
    }

    fn restart(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let place = (state.t, 0.0);
        self.accelerations.complete(system, state, place, counters)
    }

    fn save(&self, _out: &mut Checkpoint) {}

    fn resume(&mut self, _system: &mut dyn Dynamics, _from: &Checkpoint) -> Result<(), NotResumed> {
        Ok(())
    }
}
