//! Motion in time: drives a system with an integrator from a state to an end time.

use super::audit::Audit;
use crate::integrator::{Integrator, StepControl, StepError, StepReport};
use crate::system::{State, System};
use std::ops::ControlFlow;

/// Shortest recording interval, over the length of the run.
const SMALLEST_SAMPLE: f64 = 1e-9;

/// What a run is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// End of the run [s].
    pub end: f64,
    /// Step of a fixed-step method [s]: the run is divided into the fewest equal steps not longer than it.
    /// For an adaptive method, its first step; `None` lets the method choose.
    pub step: Option<f64>,
    /// Longest step of an adaptive method [s]; `None` for two recording intervals, or a hundredth of the run if
    /// that is shorter.
    pub longest_step: Option<f64>,
    /// Interval of recording [s]; the end is recorded too.
    pub sample: f64,
}

/// What an observer is told besides the state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// Size of the step that ended at or covers this state [s]; 0 at the start.
    pub size: f64,
    /// Newton iterations of that step.
    pub iterations: u32,
}

/// Someone who watches a run: records, reports progress, stops it.
pub trait Observer {
    /// A state at a time to be recorded.
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step);

    /// An accepted step ended at `state`; `Break` stops the run there.
    fn step(&mut self, _state: &State) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// At its end time.
    Finished,
    /// An observer stopped it.
    Stopped,
    /// It could not go on.
    Failed(RunError),
}

/// Why a run could not go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunError {
    /// The integrator gave up.
    #[error("{error}{}", because(.reason))]
    Step {
        /// What the integrator says.
        error: StepError,
        /// What the model knows about it.
        reason: Option<String>,
    },
    /// The model left its range.
    #[error("the run broke down at t = {time:.4} s: {what}{}", because(.reason))]
    Inadmissible {
        /// Time [s].
        time: f64,
        /// What is out of range.
        what: String,
        /// What the model knows about it.
        reason: Option<String>,
    },
    /// The energy does not balance.
    #[error(
        "the run broke down at t = {time:.4} s: the energy has grown by {excess:.3e} J more than the drive has put in \
         ({work:.3e} J; strain energy {strain:.3e} J): the steps are too large for this method; use a smaller step or \
         the adaptive method `radau`"
    )]
    Energy {
        /// Time [s].
        time: f64,
        /// Energy gained beyond the work done [J].
        excess: f64,
        /// Work of drives and loads [J].
        work: f64,
        /// Strain energy [J].
        strain: f64,
    },
}

fn because(reason: &Option<String>) -> String {
    reason.as_ref().map(|r| format!("; {r}")).unwrap_or_default()
}

/// Integrates `system` from `state`, which is left at the last accepted step, and shows the observer the
/// start, every multiple of the recording interval, and the end.
///
/// No step of a fixed-step method is ever shortened, and steps of an adaptive method end at the system's
/// [breaks](System::breaks). A run that fails or is stopped has shown everything up to its last accepted step.
pub fn transient(
    system: &mut dyn System,
    integrator: &mut dyn Integrator,
    state: &mut State,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> Ending {
    let mut run = Run { origin: state.t, samples: 1, last: Step::default(), middle: state.clone() };
    match run.integrate(system, integrator, state, plan, observer) {
        Ok(ending) => ending,
        Err(error) => Ending::Failed(error),
    }
}

/// The moving parts of one run.
struct Run {
    origin: f64,
    /// Number of samples shown.
    samples: u64,
    last: Step,
    /// Dense output.
    middle: State,
}

impl Run {
    fn integrate(
        &mut self,
        system: &mut dyn System,
        integrator: &mut dyn Integrator,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<Ending, RunError> {
        let span = plan.end - state.t;
        let failed = |system: &mut dyn System, state: &State, error: StepError| RunError::Step {
            error,
            reason: system.explain(state),
        };
        // A run of no length: its state is recorded, completed.
        let uniform = plan.step.map(|h| span / (span / h - 1e-9).ceil().max(1.0));
        if let Err(error) = integrator.start(system, state, uniform.unwrap_or(span)) {
            return Err(failed(system, state, error));
        }
        // Step control sees what an audit would; implicit steps of affine systems cannot go wrong by converging.
        let (fixed, implicit) = (integrator.info().estimate_order.is_none(), integrator.info().implicit);
        let mut audit = (fixed && !(implicit && system.is_affine())).then(|| Audit::new(system, state));
        observer.sample(system, state, &self.last);
        let mut next = state.clone();
        let mut control = integrator.info().estimate_order.map(|order| {
            let first = plan
                .step
                .unwrap_or_else(|| StepControl::first_step(order, state, system.labels(), 1e-4, span));
            let control = StepControl::new(order, span, first);
            // A drive that is quiet shows an error estimate nothing of an event that its step passes over. What
            // the recorded columns can show must not be missed.
            let longest = plan.longest_step.unwrap_or((2.0 * plan.sample).min(0.01 * span));
            control.with_limits(1e-14 * span, longest)
        });
        let mut count: u64 = 0;
        while state.t < plan.end {
            let (h, report) = match &mut control {
                None => {
                    // Step ends are multiples, not sums: no drift, and the last one is the end itself.
                    count += 1;
                    let h = uniform.unwrap_or(span);
                    let end = self.origin + count as f64 * h;
                    let end = if end >= plan.end - 1e-9 * h { plan.end } else { end };
                    match integrator.step(system, state, h, &mut next) {
                        Ok(report) => {
                            next.t = end;
                            (h, report)
                        }
                        Err(error) => return Err(failed(system, state, error)),
                    }
                }
                Some(control) => adapt(system, integrator, state, &mut next, plan.end, control)
                    .map_err(|error| failed(system, state, error))?,
            };
            self.last = Step { size: h, iterations: report.iterations };
            if let Err(what) = system.admissible(&next) {
                let reason = system.explain(&next);
                return Err(RunError::Inadmissible { time: next.t, what, reason });
            }
            integrator.accept(state, &next);
            if let Some(audit) = &mut audit {
                audit.enter(system, h, &next)?;
            }
            self.show(system, integrator, state, &next, plan, observer);
            std::mem::swap(state, &mut next);
            if observer.step(state).is_break() && state.t < plan.end {
                return Ok(Ending::Stopped);
            }
            if let Some(control) = &mut control
                && at_break(system, state.t)
            {
                control.restart(h);
                if let Err(error) = integrator.restart(system, state) {
                    return Err(failed(system, state, error));
                }
            }
        }
        Ok(Ending::Finished)
    }

    /// Shows the observer the samples in the step.
    fn show(
        &mut self,
        system: &mut dyn System,
        integrator: &dyn Integrator,
        from: &State,
        to: &State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) {
        let interval = plan.sample.max(SMALLEST_SAMPLE * (plan.end - self.origin));
        let slack = 1e-9 * interval;
        loop {
            let t = (self.origin + multiple(self.samples, interval)).min(plan.end);
            if t > to.t + slack {
                return;
            }
            if t >= to.t - slack {
                self.middle.copy_from(to);
            } else {
                integrator.interpolate(system, from, to, t, &mut self.middle);
            }
            // The very multiple, not a sum of steps that comes close to it.
            self.middle.t = t;
            observer.sample(system, &self.middle, &self.last);
            self.samples += 1;
            if t >= plan.end {
                return;
            }
        }
    }
}

/// k times the interval; k over a whole number where the interval is the inverse of one, so that samples
/// every 0.02 s fall on 13.28 s and not on its neighbour.
fn multiple(k: u64, interval: f64) -> f64 {
    let inverse = (1.0 / interval).round();
    if inverse >= 1.0 && (inverse * interval - 1.0).abs() < 1e-14 {
        k as f64 / inverse
    } else {
        k as f64 * interval
    }
}

fn at_break(system: &dyn System, t: f64) -> bool {
    system.breaks().contains(&t)
}

/// Attempts steps under step control until one is good.
fn adapt(
    system: &mut dyn System,
    integrator: &mut dyn Integrator,
    state: &State,
    next: &mut State,
    end: f64,
    control: &mut StepControl,
) -> Result<(f64, StepReport), StepError> {
    let stop = system.breaks().iter().copied().find(|b| *b > state.t).unwrap_or(end).min(end);
    loop {
        let left = stop - state.t;
        let h = control.propose(left);
        let lands = h == left;
        match integrator.step(system, state, h, next) {
            Ok(report) => {
                let error = report.error.unwrap_or(0.0);
                if error <= 1.0 {
                    control.accepted(h, error, report.iterations);
                    if lands {
                        next.t = stop;
                    }
                    return Ok((h, report));
                }
                control.rejected(h, error, report.iterations);
                give_up(system, integrator, control, (state.t, left), error)?;
            }
            Err(
                error @ (StepError::NotConverged { .. }
                | StepError::NotFinite { .. }
                | StepError::Singular { .. }),
            ) => {
                control.failed(h);
                if control.is_too_small(state.t, control.propose(left)) {
                    return Err(error);
                }
            }
            Err(error) => return Err(error),
        }
    }
}

fn give_up(
    system: &dyn System,
    integrator: &dyn Integrator,
    control: &StepControl,
    (time, left): (f64, f64),
    error: f64,
) -> Result<(), StepError> {
    let step = control.propose(left);
    if !control.is_too_small(time, step) {
        return Ok(());
    }
    let worst = system.labels().get(integrator.worst()).map_or("model", |l| &l.name).to_owned();
    Err(StepError::StepTooSmall { time, step, error, worst })
}
