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
    Checkpoint, Counters, Info, Integrator, NotResumed, Span, StabilityLimit, StepError, StepReport, hermite,
};
use crate::system::{Dynamics, RowWeights, Side, State};

/// Name as in a case file.
const NAME: &str = "runge-kutta-4";

/// Largest stable hω on the imaginary axis, 2√2.
const LIMIT: f64 = 2.828_427_124_746_190_3;

/// The classical Runge–Kutta method. Its formulas head the source file.
#[derive(Debug)]
pub struct RungeKutta {
    info: Info,
    /// Largest stable hω.
    stable: f64,
    counters: Counters,
    limit: Option<StabilityLimit>,
    baumgarte: Option<RowWeights>,
    pending: bool,
    increment: Vec<f64>,
    accepted: Vec<f64>,
    scratch: Option<Scratch>,
}

/// One explicit step's memory.
#[derive(Debug)]
pub(super) struct Scratch {
    pub(super) accelerations: Accelerations,
    stage: State,
    flat: bool,
    /// Rate ḋ of the increment at the stage.
    rate: Vec<f64>,
    /// Weighted sums of the stages' accelerations and rates.
    sum_v: Vec<f64>,
    sum_d: Vec<f64>,
}

impl Scratch {
    /// Allocates for `system`.
    ///
    /// # Errors
    /// [`StepError::Unsupported`] for constraints without Baumgarte's constants.
    fn new(
        method: &'static str,
        system: &mut dyn Dynamics,
        state: &State,
        baumgarte: Option<RowWeights>,
    ) -> Result<Scratch, StepError> {
        let size = system.size();
        if size.lambda > 0 && baumgarte.is_none() {
            let (feature, instead) = (
                "constraints",
                "Baumgarte's constants (key `baumgarte` of the integrator), generalized-alpha or radau",
            );
            return Err(StepError::Unsupported { method, feature, instead });
        }
        let weights = baumgarte.unwrap_or(RowWeights::ACCELERATION);
        Ok(Scratch {
            accelerations: Accelerations::new(system, state, weights),
            stage: State::zeros(size, 0.0),
            flat: system.is_vector_space(),
            rate: vec![0.0; size.v],
            sum_v: vec![0.0; size.v],
            sum_d: vec![0.0; size.v],
        })
    }

    /// One step of size `h` to the time of `to`; `increment` receives qₙ₊₁ ⊟ qₙ.
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        to: &mut State,
        increment: &mut [f64],
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let n = from.v.len();
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
                increment[i] = step * self.rate[i];
            }
            (self.stage.t, self.stage.side) =
                if c < 1.0 { (from.t + step, Side::Right) } else { (to.t, to.side) };
            system.retract(&from.q, increment, &mut self.stage.q);
            self.accelerations.complete(system, &mut self.stage, place, counters)?;
            if self.flat {
                self.rate.copy_from_slice(&self.stage.v);
            } else {
                system.rate(&from.q, increment, &self.stage.v, &mut self.rate);
            }
            for i in 0..n {
                self.sum_v[i] += weight * self.stage.a[i];
                self.sum_d[i] += weight * self.rate[i];
            }
        }
        for i in 0..n {
            to.v[i] = from.v[i] + h / 6.0 * self.sum_v[i];
            increment[i] = h / 6.0 * self.sum_d[i];
        }
        to.copy_modes(from);
        system.retract(&from.q, increment, &mut to.q);
        self.accelerations.complete(system, to, place, counters)
    }
}

impl RungeKutta {
    /// The method, not yet started.
    pub fn new() -> RungeKutta {
        RungeKutta::starting(NAME, LIMIT)
    }

    /// The same, as the start of the explicit method of order 4 with this name and this largest stable hω.
    pub(super) fn starting(name: &'static str, stable: f64) -> RungeKutta {
        RungeKutta {
            info: Info { name, order: 4, estimate_order: None, implicit: false },
            stable,
            counters: Counters::default(),
            limit: None,
            baumgarte: None,
            pending: false,
            increment: Vec::new(),
            accepted: Vec::new(),
            scratch: None,
        }
    }

    /// The same method, with constraints stabilized by Baumgarte's constants δ and ε [1/s].
    pub fn with_baumgarte(self, delta: f64, epsilon: f64) -> RungeKutta {
        RungeKutta { baumgarte: Some(RowWeights::baumgarte(delta, epsilon)), ..self }
    }

    /// The stability limit found by `start`.
    pub fn stability_limit(&self) -> Option<StabilityLimit> {
        self.limit
    }

    /// Begins an attempt of a step: its memory, the increment and the counters.
    pub(super) fn attempt(
        &mut self,
        span: Span,
        to: &mut State,
    ) -> Result<(&mut Scratch, &mut [f64], &mut Counters), StepError> {
        let Some(scratch) = &mut self.scratch else {
            return Err(StepError::NotStarted { method: self.info.name });
        };
        (to.t, to.side) = (span.end, span.side);
        self.counters.rejected += u64::from(self.pending);
        self.pending = true;
        Ok((scratch, &mut self.increment, &mut self.counters))
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

    fn start(&mut self, system: &mut dyn Dynamics, state: &mut State, step: f64) -> Result<(), StepError> {
        let size = system.size();
        self.counters = Counters::default();
        self.increment.resize(size.v, 0.0);
        self.accepted.resize(size.v, 0.0);
        self.limit = None;
        self.scratch = Some(Scratch::new(self.info.name, system, state, self.baumgarte)?);
        self.restart(system, state)?;
        let limit = StabilityLimit::find(self.info.name, self.stable, system, state)?;
        self.limit = Some(limit);
        limit.check(step)
    }

    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        span: Span,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let (scratch, increment, counters) = self.attempt(span, to)?;
        scratch.step(system, from, span.step, to, increment, counters)?;
        Ok(StepReport { iterations: 0, error: None })
    }

    fn discard(&mut self) {
        self.pending = false;
    }

    fn accept(&mut self, _from: &State, _to: &State) {
        std::mem::swap(&mut self.increment, &mut self.accepted);
        self.pending = false;
        self.counters.steps += 1;
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        hermite::quintic(system, from, to, &self.accepted, t, out);
    }

    fn restart(&mut self, system: &mut dyn Dynamics, state: &mut State) -> Result<(), StepError> {
        let Some(scratch) = &mut self.scratch else {
            return Err(StepError::NotStarted { method: self.info.name });
        };
        self.pending = false;
        state.side = Side::Right;
        let place = (state.t, 0.0);
        scratch.accelerations.complete(system, state, place, &mut self.counters)
    }

    fn save(&self, out: &mut Checkpoint) {
        out.put("counters", &self.counters.to_numbers());
    }

    fn resume(&mut self, _system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        self.counters = Counters::from_numbers(from.numbers("counters")?);
        Ok(())
    }

    fn worst(&self) -> usize {
        0
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}
