//! The classical Runge–Kutta method: fourth order, explicit, fixed step.
//!
//! With a(t, q, v) = M⁻¹ f and y = (q, v),
//!
//! ```text
//! a₁ = a(tₙ, qₙ, vₙ)                 v₂ = vₙ + h/2 a₁     q₂ = qₙ ⊞ h/2 vₙ
//! a₂ = a(tₙ + h/2, q₂, v₂)           v₃ = vₙ + h/2 a₂     q₃ = qₙ ⊞ h/2 v₂
//! a₃ = a(tₙ + h/2, q₃, v₃)           v₄ = vₙ + h a₃       q₄ = qₙ ⊞ h v₃
//! a₄ = a(tₙ + h, q₄, v₄)
//! vₙ₊₁ = vₙ + h/6 (a₁ + 2a₂ + 2a₃ + a₄),   qₙ₊₁ = qₙ ⊞ (h vₙ + h²/6 (a₁ + a₂ + a₃))
//! ```
//!
//! a(tₙ₊₁, qₙ₊₁, vₙ₊₁) is evaluated at the end of a step and serves as a₁ of the next: four evaluations a
//! step. Order: 4 in q, v, a (measured 4.0) where the configuration is a vector space. Stability: undamped
//! frequencies up to hω = 2√2, where it dissipates; [`StabilityLimit`] refuses larger steps. Heavy damping
//! lowers the limit (real eigenvalues of the first-order form must stay above −2.785/h).
//! Dense output: quintic.
//!
//! Source: Hairer, Nørsett & Wanner, *Solving Ordinary Differential Equations I*, section II.1
//! (doi 10.1007/978-3-540-78862-1).

use super::acceleration::Accelerations;
use super::{
    Checkpoint, Counters, Info, Integrator, NotResumed, StabilityLimit, StepError, StepReport, hermite,
};
use crate::system::{State, System};

/// Name as in a case file.
const NAME: &str = "runge-kutta-4";

/// Largest stable hω on the imaginary axis, 2√2.
const LIMIT: f64 = 2.828_427_124_746_190_3;

/// The classical Runge–Kutta method. See the [module documentation](self).
#[derive(Debug)]
pub struct RungeKutta {
    info: Info,
    counters: Counters,
    limit: Option<StabilityLimit>,
    pending: bool,
    increment: Vec<f64>,
    accepted: Vec<f64>,
    scratch: Option<Scratch>,
}

/// One explicit step's memory; shared with the start of [`Adams`](super::Adams).
#[derive(Debug)]
pub(super) struct Scratch {
    pub(super) accelerations: Accelerations,
    stage: State,
    /// v₂, then v₃.
    velocity: Vec<f64>,
    /// Weighted sums of the stage accelerations for v and q.
    sum_v: Vec<f64>,
    sum_q: Vec<f64>,
}

impl Scratch {
    /// Allocates for `system`.
    pub(super) fn new(system: &dyn System) -> Scratch {
        let size = system.size();
        Scratch {
            accelerations: Accelerations::new(system),
            stage: State::zeros(size, 0.0),
            velocity: vec![0.0; size.v],
            sum_v: vec![0.0; size.v],
            sum_q: vec![0.0; size.v],
        }
    }

    /// One step of size `h`; `increment` receives qₙ₊₁ ⊟ qₙ.
    pub(super) fn step(
        &mut self,
        system: &mut dyn System,
        from: &State,
        h: f64,
        to: &mut State,
        increment: &mut [f64],
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let n = from.v.len();
        let place = (from.t, h);
        self.sum_v.copy_from_slice(&from.a);
        self.sum_q.copy_from_slice(&from.a);
        self.velocity.copy_from_slice(&from.v);
        self.stage.a.copy_from_slice(&from.a);
        // (c, weight of the stage in v, and in q) of stages 2, 3, 4.
        for (c, weight_v, weight_q) in [(0.5, 2.0, 1.0), (0.5, 2.0, 1.0), (1.0, 1.0, 0.0)] {
            let step = c * h;
            for i in 0..n {
                let v = from.v[i] + step * self.stage.a[i];
                increment[i] = step * self.velocity[i];
                self.velocity[i] = v;
                self.stage.v[i] = v;
            }
            self.stage.t = from.t + step;
            system.retract(&from.q, increment, &mut self.stage.q);
            self.accelerations.complete(system, &mut self.stage, place, counters)?;
            for i in 0..n {
                self.sum_v[i] += weight_v * self.stage.a[i];
                self.sum_q[i] += weight_q * self.stage.a[i];
            }
        }
        for i in 0..n {
            to.v[i] = from.v[i] + h / 6.0 * self.sum_v[i];
            increment[i] = h * from.v[i] + h * h / 6.0 * self.sum_q[i];
        }
        to.t = from.t + h;
        system.retract(&from.q, increment, &mut to.q);
        self.accelerations.complete(system, to, place, counters)
    }
}

impl RungeKutta {
    /// The method, not yet started.
    pub fn new() -> RungeKutta {
        RungeKutta {
            info: Info { name: NAME, order: 4, estimate_order: None, implicit: false },
            counters: Counters::default(),
            limit: None,
            pending: false,
            increment: Vec::new(),
            accepted: Vec::new(),
            scratch: None,
        }
    }

    /// The stability limit found by `start`.
    pub fn stability_limit(&self) -> Option<StabilityLimit> {
        self.limit
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

    fn start(&mut self, system: &mut dyn System, state: &mut State, step: f64) -> Result<(), StepError> {
        let size = system.size();
        self.counters = Counters::default();
        self.increment.resize(size.v, 0.0);
        self.accepted.resize(size.v, 0.0);
        self.limit = None;
        self.scratch = Some(Scratch::new(system));
        self.restart(system, state)?;
        let limit = StabilityLimit::find(NAME, LIMIT, system, state)?;
        self.limit = Some(limit);
        limit.check(step)
    }

    fn step(
        &mut self,
        system: &mut dyn System,
        from: &State,
        h: f64,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let Some(scratch) = &mut self.scratch else {
            return Err(StepError::NotStarted { method: NAME });
        };
        self.counters.rejected += u64::from(self.pending);
        self.pending = true;
        scratch.step(system, from, h, to, &mut self.increment, &mut self.counters)?;
        Ok(StepReport { iterations: 0, error: None })
    }

    fn accept(&mut self, _from: &State, _to: &State) {
        std::mem::swap(&mut self.increment, &mut self.accepted);
        self.pending = false;
        self.counters.steps += 1;
    }

    fn interpolate(&self, system: &dyn System, from: &State, to: &State, t: f64, out: &mut State) {
        hermite::quintic(system, from, to, &self.accepted, t, out);
    }

    fn restart(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), StepError> {
        let Some(scratch) = &mut self.scratch else {
            return Err(StepError::NotStarted { method: NAME });
        };
        self.pending = false;
        let place = (state.t, 0.0);
        scratch.accelerations.complete(system, state, place, &mut self.counters)
    }

    fn save(&self, out: &mut Checkpoint) {
        out.put("counters", &self.counters.to_numbers());
    }

    fn resume(&mut self, _system: &mut dyn System, from: &Checkpoint) -> Result<(), NotResumed> {
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
