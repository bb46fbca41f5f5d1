//! Motion in time: drives a system with an integrator from a state to an end time.

use super::audit::Audit;
use super::ledger::{Books, Ledger};
use crate::integrator::{Checkpoint, Integrator, NotResumed, StepControl, StepError, StepReport};
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
    /// The books of energy until this state, if the observer [wants them](Observer::wants_books).
    pub books: Option<Books>,
}

/// Someone who watches a run: records, reports progress, stops it.
pub trait Observer {
    /// Whether work and losses are to be integrated along the run: one to three evaluations of the power a step, whatever is recorded.
    fn wants_books(&self) -> bool {
        false
    }

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
    /// The history of an earlier run could not be taken up.
    #[error("the run cannot go on: {0}")]
    NotResumed(#[from] NotResumed),
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
    let mut run = Run::new(state);
    match run.begin(system, integrator, state, plan, observer) {
        Ok(()) => run.go_on(system, integrator, state, plan, observer),
        Err(error) => Ending::Failed(error),
    }
}

/// As [`transient`], and gives a checkpoint of the last accepted step, from which [`resume`] goes on.
pub fn transient_to_checkpoint(
    system: &mut dyn System,
    integrator: &mut dyn Integrator,
    state: &mut State,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> (Ending, Checkpoint) {
    let mut run = Run::new(state);
    let ending = match run.begin(system, integrator, state, plan, observer) {
        Ok(()) => run.go_on(system, integrator, state, plan, observer),
        Err(error) => Ending::Failed(error),
    };
    (ending, run.checkpoint(integrator, state, plan.sample))
}

/// Goes on from a checkpoint of a run of the same system with the same integrator, of which `state` receives the
/// state: steps, samples and counters are bit by bit those of a run that has never stopped, if the plan is the same.
/// The state of the checkpoint itself is not shown to the observer.
///
/// # Errors
/// [`NotResumed`] when the checkpoint is not one of such a run, or a fixed step would change by the new end.
pub fn resume(
    system: &mut dyn System,
    integrator: &mut dyn Integrator,
    from: &Checkpoint,
    state: &mut State,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> Result<(Ending, Checkpoint), NotResumed> {
    let mut run = Run::new(state);
    run.resume(system, integrator, from, state, plan, observer)?;
    let ending = run.go_on(system, integrator, state, plan, observer);
    Ok((ending, run.checkpoint(integrator, state, plan.sample)))
}

/// The moving parts of one run.
struct Run {
    origin: f64,
    /// Number of samples shown.
    samples: u64,
    last: Step,
    /// Steps taken, and the size of fixed steps [s].
    count: u64,
    uniform: Option<f64>,
    control: Option<StepControl>,
    audit: Option<Audit>,
    ledger: Option<Ledger>,
    /// Dense output.
    middle: State,
}

impl Run {
    fn new(state: &State) -> Run {
        Run {
            origin: state.t,
            samples: 1,
            last: Step::default(),
            count: 0,
            uniform: None,
            control: None,
            audit: None,
            ledger: None,
            middle: state.clone(),
        }
    }

    /// Prepares the run, and shows its start.
    fn begin(
        &mut self,
        system: &mut dyn System,
        integrator: &mut dyn Integrator,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        self.plan(plan);
        let step = self.uniform.unwrap_or(plan.end - self.origin);
        if let Err(error) = integrator.start(system, state, step) {
            return Err(failed(system, state, error));
        }
        self.supervise(system, integrator, state, plan);
        let order = integrator.info().order;
        self.ledger = observer.wants_books().then(|| Ledger::new(system, order, state));
        let books = self.ledger.as_ref().map(Ledger::books);
        observer.sample(system, state, &Step { books, ..self.last });
        Ok(())
    }

    /// Takes up a run where a checkpoint was made.
    fn resume(
        &mut self,
        system: &mut dyn System,
        integrator: &mut dyn Integrator,
        from: &Checkpoint,
        state: &mut State,
        plan: &Plan,
        observer: &dyn Observer,
    ) -> Result<(), NotResumed> {
        from.fill_state("", state)?;
        let [origin, samples, count, uniform] = from.numbers("run")?;
        (self.origin, self.samples, self.count) = (origin, samples as u64, count as u64);
        let [size, iterations] = from.numbers("last")?;
        self.last = Step { size, iterations: iterations as u32, books: None };
        let [sample] = from.numbers("sample")?;
        if sample != plan.sample {
            let before = (state.t - origin) / plan.sample;
            self.samples = (before + 1e-9).floor().max(0.0) as u64 + 1;
        }
        self.plan(plan);
        if let Some(step) = &mut self.uniform {
            if (*step - uniform).abs() > 1e-12 * uniform {
                let message = format!(
                    "the run was made with steps of {uniform} s, and until {} s steps would be {step} s: give the step \
                     and a duration that is a multiple of it",
                    plan.end
                );
                return Err(NotResumed::Failed(message));
            }
            *step = uniform;
            state.t = origin + count * uniform;
        }
        let step = self.uniform.unwrap_or(plan.end - origin);
        let started = integrator.start(system, &mut state.clone(), step);
        started.map_err(|error| NotResumed::Failed(error.to_string()))?;
        self.supervise(system, integrator, state, plan);
        if let Some(control) = &mut self.control {
            control.recall(from.numbers("control")?);
        }
        if let Some(audit) = &mut self.audit {
            audit.recall(from.numbers("audit")?);
        }
        if observer.wants_books() {
            let mut ledger = Ledger::new(system, integrator.info().order, state);
            ledger.recall(from)?;
            self.ledger = Some(ledger);
        }
        integrator.resume(system, from)
    }

    /// What [`Run::resume`] needs.
    fn checkpoint(&self, integrator: &dyn Integrator, state: &State, sample: f64) -> Checkpoint {
        let mut out = Checkpoint::default();
        out.put_state("", state);
        let (samples, count) = (self.samples as f64, self.count as f64);
        out.put("run", &[self.origin, samples, count, self.uniform.unwrap_or(0.0)]);
        out.put("sample", &[sample]);
        out.put("last", &[self.last.size, f64::from(self.last.iterations)]);
        if let Some(control) = &self.control {
            out.put("control", &control.memory());
        }
        if let Some(audit) = &self.audit {
            out.put("audit", &audit.memory());
        }
        if let Some(ledger) = &self.ledger {
            ledger.save(&mut out);
        }
        integrator.save(&mut out);
        out
    }

    /// The fewest equal steps not longer than the one asked for.
    fn plan(&mut self, plan: &Plan) {
        let span = plan.end - self.origin;
        self.uniform = plan.step.map(|h| span / (span / h - 1e-9).ceil().max(1.0));
    }

    /// Step control or audit.
    fn supervise(
        &mut self,
        system: &mut dyn System,
        integrator: &dyn Integrator,
        state: &State,
        plan: &Plan,
    ) {
        let span = plan.end - self.origin;
        // Step control sees what an audit would; implicit steps of affine systems cannot go wrong by converging.
        let (fixed, implicit) = (integrator.info().estimate_order.is_none(), integrator.info().implicit);
        self.audit = (fixed && !(implicit && system.is_affine())).then(|| Audit::new(system, state));
        self.control = integrator.info().estimate_order.map(|order| {
            let first = plan
                .step
                .unwrap_or_else(|| StepControl::first_step(order, state, system.labels(), 1e-4, span));
            let control = StepControl::new(order, span, first);
            // A drive that is quiet shows an error estimate nothing of an event that its step passes over. What
            // the recorded columns can show must not be missed.
            let longest = plan.longest_step.unwrap_or((2.0 * plan.sample).min(0.01 * span));
            control.with_limits(1e-14 * span, longest)
        });
    }

    /// Integrates to the end.
    fn go_on(
        &mut self,
        system: &mut dyn System,
        integrator: &mut dyn Integrator,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Ending {
        match self.integrate(system, integrator, state, plan, observer) {
            Ok(ending) => ending,
            Err(error) => Ending::Failed(error),
        }
    }

    fn integrate(
        &mut self,
        system: &mut dyn System,
        integrator: &mut dyn Integrator,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<Ending, RunError> {
        let mut next = state.clone();
        while state.t < plan.end {
            let (h, report) = match &mut self.control {
                None => {
                    // Step ends are multiples, not sums: no drift, and the last one is the end itself.
                    let h = self.uniform.unwrap_or(plan.end - self.origin);
                    let end = self.origin + (self.count + 1) as f64 * h;
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
            self.last = Step { size: h, iterations: report.iterations, books: None };
            if let Err(what) = system.admissible(&next) {
                let reason = system.explain(&next);
                return Err(RunError::Inadmissible { time: next.t, what, reason });
            }
            integrator.accept(state, &next);
            self.count += 1;
            let power = match &mut self.audit {
                Some(audit) => audit.enter(system, h, &next)?,
                None => None,
            };
            if let Some(ledger) = &mut self.ledger {
                ledger.enter(system, integrator, (state, &next), power);
            }
            self.show(system, integrator, state, &next, plan, observer);
            if let Some(ledger) = &mut self.ledger {
                ledger.close();
            }
            std::mem::swap(state, &mut next);
            if let Some(control) = &mut self.control
                && at_break(system, state.t)
            {
                control.restart(h);
                if let Err(error) = integrator.restart(system, state) {
                    return Err(failed(system, state, error));
                }
            }
            if observer.step(state).is_break() && state.t < plan.end {
                return Ok(Ending::Stopped);
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
            let mut books = None;
            if t >= to.t - slack {
                self.middle.copy_from(to);
                books = self.ledger.as_ref().map(Ledger::end);
            } else {
                integrator.interpolate(system, from, to, t, &mut self.middle);
                if let Some(ledger) = &self.ledger {
                    books = Some(ledger.until((from, to), t));
                }
            }
            // The very multiple, not a sum of steps that comes close to it.
            self.middle.t = t;
            observer.sample(system, &self.middle, &Step { books, ..self.last });
            // An end that is no multiple is not counted: a run that goes on records the next multiple.
            self.samples += u64::from(self.origin + multiple(self.samples, interval) <= plan.end + slack);
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

fn failed(system: &mut dyn System, state: &State, error: StepError) -> RunError {
    RunError::Step { error, reason: system.explain(state) }
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
