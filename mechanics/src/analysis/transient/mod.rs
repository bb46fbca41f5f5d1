//! Motion in time: drives a system with an integrator from a state to an end time.
//!
//! Steps end at the known [breaks](crate::system::Events::breaks) that a method can see, and at events: the closing step
//! takes the left limit of what jumps there, and the method restarts from the right one. A method with step control sees
//! every break and also ends steps where a load or a motion changes fast, one with fixed steps those of velocities and accelerations, for a kink costs it less than its own error.

mod adaptive;
mod contacts;
mod ending;
mod locate;
mod observer;
mod stretch;

use ending::failed;
pub use ending::{Ending, RunError};
pub use observer::{Event, EventKind, Observer, Step};

use super::energy_balance::Integral;
use crate::contact::{Bounds, Impact, ImpactMap};
use crate::integrator::{Checkpoint, Integrator, NotResumed, Span, StepControl, StepReport};
use crate::quadrature::Gauss;
use crate::system::{Crossing, Jump, Side, State, System};
use adaptive::adapt;
use contacts::{Contacts, Unseen, approaches, loss, struck};
use stretch::Stretch;

/// Shortest recording interval, over the length of the run.
const SMALLEST_SAMPLE: f64 = 1e-9;
/// Part of a fixed step that is not taken as a step of its own.
const SLIVER: f64 = 1e-6;
/// What a run is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// End of the run \[s\].
    pub end: f64,
    /// Step of a fixed-step method \[s\]: each stretch between breaks is divided into the
    /// fewest equal steps not longer than it.
    /// For an adaptive method, its first step; `None` lets the method choose.
    pub step: Option<f64>,
    /// Longest step of an adaptive method \[s\]; `None` for two recording intervals, or a hundredth of the run if
    /// that is shorter.
    pub longest_step: Option<f64>,
    /// Step while a contact is closed or comes near \[s\], if shorter than `step`: the rest of a fixed step is divided into
    /// the fewest equal ones not longer than it. A step under control is not longer than it from the first impact on: what
    /// impacts set vibrating is damped by longer steps, in flight too.
    pub contact_step: Option<f64>,
    /// Interval of recording \[s\]; the end is recorded too.
    pub sample: f64,
}

/// Integrates `system` from `state`, which is left at the last accepted step, and shows the observer the
/// start, every multiple of the recording interval, and the end.
///
/// A run that fails or is stopped has shown everything up to its last accepted step.
pub fn transient(
    system: &mut dyn System,
    integrator: &mut dyn Integrator,
    state: &mut State,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> Ending {
    transient_to_checkpoint(system, integrator, state, plan, observer).0
}

/// As [`transient`], and gives a checkpoint of the last accepted step, from which [`resume`] goes on.
pub fn transient_to_checkpoint(
    system: &mut dyn System,
    integrator: &mut dyn Integrator,
    state: &mut State,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> (Ending, Checkpoint) {
    let mut run = Run::new(system, state);
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
    let mut run = Run::new(system, state);
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
    /// Steps of a fixed-step method until the next break.
    stretch: Option<Stretch>,
    control: Option<StepControl>,
    balance: Option<Integral>,
    contacts: Option<Contacts>,
    /// For methods that locate no contacts.
    unseen: Option<Unseen>,
    /// Where states within steps are shown.
    within: Gauss,
    /// Dense output.
    middle: State,
    /// Gaps, to see whether a contact comes near.
    gaps: Vec<f64>,
}

impl Run {
    fn new(system: &mut dyn System, state: &State) -> Run {
        let contacts = Contacts::new(system, state);
        Run {
            origin: state.t,
            samples: 1,
            last: Step::default(),
            stretch: None,
            control: None,
            balance: None,
            contacts,
            unseen: Unseen::new(system),
            within: Gauss::new(3),
            middle: state.clone(),
            gaps: vec![0.0; state.lambda.len()],
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
        if integrator.resolves_contacts() {
            self.contacts = self.contacts.take().and_then(Contacts::of_indicators);
        }
        if let Some(contacts) = &mut self.contacts {
            contacts.settle(system, state)?;
        }
        self.stretch = plan.step.filter(|_| is_fixed(integrator)).map(|h| {
            let stop = next_break(system, integrator, state.t, plan.end);
            Stretch::new(state.t, stop, h)
        });
        let step = self.stretch.map_or(plan.end - self.origin, |stretch| stretch.step);
        if let Err(error) = integrator.start(system, state, step) {
            return Err(failed(system, state, error));
        }
        self.set_control(system, integrator, state, plan);
        let order = integrator.info().order;
        self.balance = observer.wants_energy_balance().then(|| Integral::new(system, order, state));
        let balance = self.balance.as_ref().map(Integral::balance);
        observer.sample(system, state, &Step { balance, ..self.last });
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
        let [origin, samples] = from.finite("run")?;
        if !(origin <= state.t && samples >= 0.0) {
            return Err(NotResumed::Invalid("run".to_owned()));
        }
        (self.origin, self.samples) = (origin, samples as u64);
        let [size, iterations] = from.finite("last")?;
        self.last = Step { size, iterations: iterations as u32, ..Step::default() };
        let [sample] = from.finite("sample")?;
        if sample != plan.sample {
            let before = (state.t - origin) / plan.sample;
            self.samples = (before + 1e-9).floor().max(0.0) as u64 + 1;
        }
        if let Some(asked) = plan.step.filter(|_| is_fixed(integrator)) {
            let stretch = from.finite("stretch")?;
            let stop = next_break(system, integrator, state.t, plan.end);
            let recalled = if jump_at(system, integrator, state.t).is_some() {
                // The run ended at a break: behind it begins another stretch.
                Ok((Stretch::new(state.t, stop, asked), state.t))
            } else {
                Stretch::recall(stretch, stop, asked)
            };
            let (stretch, at) = recalled.map_err(|[before, now]| {
                NotResumed::Failed(format!(
                    "the run was made with steps of {before} s, and until {} s steps would be {now} s: give the step \
                     and a duration that is a multiple of it",
                    plan.end
                ))
            })?;
            // Where the run ended inside a step, that step goes on.
            if (state.t - at).abs() <= 1e-9 * stretch.step {
                state.t = at;
            }
            self.stretch = Some(stretch);
        }
        if integrator.resolves_contacts() {
            self.contacts = self.contacts.take().and_then(Contacts::of_indicators);
        }
        let step = self.stretch.map_or(plan.end - origin, |stretch| stretch.step);
        let started = integrator.start(system, &mut state.clone(), step);
        started.map_err(|error| NotResumed::Failed(error.to_string()))?;
        self.set_control(system, integrator, state, plan);
        if let Some(control) = &mut self.control {
            let memory: [f64; 4] = from.numbers("control")?;
            if !(memory[0] > 0.0 && memory[0].is_finite()) {
                return Err(NotResumed::Invalid("control".to_owned()));
            }
            control.recall(memory);
        }
        if let Some(contacts) = &mut self.contacts {
            contacts.recall(from.numbers("contacts")?);
        }
        if observer.wants_energy_balance() {
            let mut balance = Integral::new(system, integrator.info().order, state);
            balance.recall(from)?;
            self.balance = Some(balance);
        }
        integrator.resume(system, from)
    }

    /// What [`Run::resume`] needs.
    fn checkpoint(&self, integrator: &dyn Integrator, state: &State, sample: f64) -> Checkpoint {
        let mut out = Checkpoint::default();
        out.put_state("", state);
        out.put("run", &[self.origin, self.samples as f64]);
        out.put("sample", &[sample]);
        out.put("last", &[self.last.size, f64::from(self.last.iterations)]);
        if let Some(stretch) = &self.stretch {
            out.put("stretch", &stretch.memory());
        }
        if let Some(control) = &self.control {
            out.put("control", &control.memory());
        }
        if let Some(contacts) = &self.contacts {
            out.put("contacts", &contacts.memory());
        }
        if let Some(balance) = &self.balance {
            balance.save(&mut out);
        }
        integrator.save(&mut out);
        out
    }

    fn set_control(
        &mut self,
        system: &mut dyn System,
        integrator: &dyn Integrator,
        state: &State,
        plan: &Plan,
    ) {
        let span = plan.end - self.origin;
        self.control = integrator.info().estimate_order.map(|order| {
            let first = plan
                .step
                .unwrap_or_else(|| StepControl::first_step(order, state, system.scales(), 1e-4, span));
            let control = StepControl::new(order, span, first);
            // While the drive is constant, the error estimate cannot detect an event inside the step: what the
            // recorded columns can show bounds the step.
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
        let ending = self.integrate(system, integrator, state, plan, observer);
        if let Some(excess) = self.balance.as_ref().and_then(Integral::gain) {
            observer.gained_energy(excess);
        }
        ending.unwrap_or_else(Ending::Failed)
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
            let stop = stop(system, integrator, state.t, plan.end);
            let (mut h, report) =
                self.attempt(system, integrator, state, &mut next, stop, plan.contact_step)?;
            let attempted = h;
            let mut event = false;
            if let Some(contacts) = &mut self.contacts {
                match (contacts.locator.locate(system, integrator, state, h, &mut next), &mut self.control) {
                    (Ok(found), _) => (h, event) = found,
                    // A step by which an event is looked for does not converge: it is looked for in a shorter one.
                    (Err(_), Some(control)) if !control.is_too_small(state.t, 0.5 * h) => {
                        control.failed(h);
                        continue;
                    }
                    (Err(error), _) => return Err(error),
                }
            }
            let neglected = self.contacts.as_ref().map(|contacts| contacts.neglected).unwrap_or_default();
            self.last = Step { size: h, iterations: report.iterations, balance: None, neglected };
            if let Err(what) = system.admissible(&next) {
                let reason = system.explain(&next).filter(|reason| *reason != what);
                return Err(RunError::Inadmissible { time: next.t, what, reason });
            }
            integrator.accept(state, &next);
            if let Some(stretch) = self.stretch.as_mut().filter(|stretch| next.t == stretch.next()) {
                stretch.advance();
            }
            if let Some(balance) = &mut self.balance {
                if integrator.resolves_contacts() {
                    let [lost, counted] = loss(system, state, &next, &mut self.gaps);
                    balance.add_impulse(0.0, lost - counted);
                }
                balance.enter(system, integrator, (state, &next));
            }
            self.show(system, integrator, state, &next, plan, observer);
            if let Some(balance) = &mut self.balance {
                balance.close();
            }
            if observer.wants_within() {
                for (node, weight) in self.within.on(0.0, 1.0) {
                    let t = state.t + node * h;
                    integrator.interpolate(system, state, &next, t, &mut self.middle);
                    observer.within(system, &self.middle, weight * h);
                }
            }
            observer.passing(system, &next);
            if integrator.resolves_contacts() {
                if let Some(event) = struck(system, state, &next, &mut self.gaps) {
                    observer.event(&event);
                }
                if let Some(row) = self.unseen.as_mut().and_then(|unseen| unseen.find(system, state, &next)) {
                    observer.stepped_over(next.t, row);
                }
            }
            std::mem::swap(state, &mut next);
            let at_break = jump_at(system, integrator, state.t);
            if event || at_break.is_some() {
                self.cross(system, integrator, state, at_break, event.then_some(h / attempted), observer)?;
                observer.passing(system, state);
                if let Some(control) = &mut self.control {
                    control.restart(attempted);
                }
                if at_break.is_some()
                    && state.t < plan.end
                    && let (Some(stretch), Some(asked)) = (&mut self.stretch, plan.step)
                {
                    *stretch =
                        Stretch::new(state.t, next_break(system, integrator, state.t, plan.end), asked);
                }
            }
            if observer.step(state).is_break() && state.t < plan.end {
                return Ok(Ending::Stopped);
            }
        }
        Ok(Ending::Finished)
    }

    /// Attempts the next step.
    fn attempt(
        &mut self,
        system: &mut dyn System,
        integrator: &mut dyn Integrator,
        state: &State,
        next: &mut State,
        (stop, side): (f64, Side),
        contact_step: Option<f64>,
    ) -> Result<(f64, StepReport), RunError> {
        if let Some(control) = &mut self.control {
            let h = control.propose(stop - state.t);
            let struck = self.contacts.as_ref().is_some_and(Contacts::has_struck);
            let near = |short: &f64| *short < h && (struck || approaches(system, state, h, &mut self.gaps));
            let longest = contact_step.filter(near).unwrap_or(f64::INFINITY);
            return adapt(system, integrator, (state, longest), next, (stop, side), control)
                .map_err(|error| failed(system, state, error));
        }
        let (h, end) = match &mut self.stretch {
            Some(stretch) => {
                // A step that an event has shortened goes on to where it would have ended, or a step further where
                // next to nothing is left.
                while stretch.next() < stop && stretch.next() - state.t < SLIVER * stretch.step {
                    stretch.advance();
                }
                let left = stretch.next() - state.t;
                let whole = (left - stretch.step).abs() <= 1e-9 * stretch.step;
                let h = if whole { stretch.step } else { left };
                match contact_step.filter(|_| approaches(system, state, h, &mut self.gaps)) {
                    Some(short) if short < h * (1.0 - 1e-9) => {
                        let h = h / (h / short - 1e-9).ceil();
                        (h, state.t + h)
                    }
                    _ => (h, stretch.next()),
                }
            }
            None => (stop - state.t, stop),
        };
        let span = Span { step: h, end, side: if end == stop { side } else { Side::Right } };
        let report = integrator.step(system, state, span, next);
        Ok((h, report.map_err(|error| failed(system, state, error))?))
    }

    /// What happens at a break or an event at `state`, and the restart behind it.
    fn cross(
        &mut self,
        system: &mut dyn System,
        integrator: &mut dyn Integrator,
        state: &mut State,
        at_break: Option<Jump>,
        event: Option<f64>,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let before = state.clone();
        state.side = Side::Right;
        let mut happened = Vec::new();
        let mut jump = at_break == Some(Jump::Velocity);
        if event.is_some()
            && let Some(contacts) = &mut self.contacts
        {
            let fired = contacts.locator.fired();
            if !fired.is_empty() {
                let crossing = system.cross(&fired, state);
                happened.push(EventKind::Crossing { indicators: fired });
                match crossing {
                    Crossing::Continue | Crossing::Restart => {}
                    Crossing::Jump => jump = true,
                    Crossing::Stop(reason) => return Err(RunError::Ended { time: state.t, reason }),
                }
            }
        }
        let mut impulse = vec![0.0; state.v.len()];
        let jump = jump && system.impulse(&before, &mut impulse);
        let (mut work, mut lost) = (0.0, 0.0);
        if event.is_some() || jump {
            let mut fallback;
            let contacts = match &mut self.contacts {
                Some(contacts) => contacts,
                None => {
                    fallback = ImpactMap::new(system);
                    let impact = fallback.strike(system, state, &impulse, Bounds::default());
                    impact.map_err(|cause| RunError::Contact { time: state.t, cause })?;
                    work = system.impulse_work(&before, state);
                    happened.push(EventKind::Jump { work });
                    return self.restart(system, integrator, state, (work, lost), happened, observer);
                }
            };
            if let Some(part) = event {
                contacts.count_event(state.t, part)?;
            }
            if contacts.resolved && !jump {
                return self.restart(system, integrator, state, (work, lost), happened, observer);
            }
            let impact = contacts.strike(system, state, &impulse)?;
            // A prescribed motion does work in every impact.
            work += system.impulse_work(&before, state);
            if jump {
                happened.push(EventKind::Jump { work });
            }
            work += impact.work;
            lost = impact.lost;
            happened.push(if impact.impulses.iter().any(|x| *x != 0.0) {
                let Impact { impulses, rates, masses, .. } = impact;
                EventKind::Impact { impulses, lost, rates, masses }
            } else {
                EventKind::Switch
            });
        }
        self.restart(system, integrator, state, (work, lost), happened, observer)
    }

    fn restart(
        &mut self,
        system: &mut dyn System,
        integrator: &mut dyn Integrator,
        state: &mut State,
        (work, lost): (f64, f64),
        happened: Vec<EventKind>,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        for kind in happened {
            observer.event(&Event { time: state.t, kind, modes: state.mode.clone() });
        }
        integrator.restart(system, state).map_err(|error| failed(system, state, error))?;
        if let Some(balance) = &mut self.balance {
            balance.add_impulse(work, lost);
            balance.restart(system, state);
        }
        Ok(())
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
            let mut balance = None;
            if t >= to.t - slack {
                self.middle.copy_from(to);
                balance = self.balance.as_ref().map(Integral::end);
            } else {
                integrator.interpolate(system, from, to, t, &mut self.middle);
                if let Some(integral) = &self.balance {
                    balance = Some(integral.until((from, to), t));
                }
            }
            // The very multiple, not a sum of steps that comes close to it.
            self.middle.t = t;
            observer.sample(system, &self.middle, &Step { balance, ..self.last });
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

fn is_fixed(integrator: &dyn Integrator) -> bool {
    integrator.info().estimate_order.is_none()
}

/// Whether steps of this method end at a jump.
fn sees(integrator: &dyn Integrator, jump: Jump) -> bool {
    !is_fixed(integrator) || jump <= Jump::Acceleration
}

/// The first break after `t` that the method sees, or the end of the run.
fn next_break(system: &dyn System, integrator: &dyn Integrator, t: f64, end: f64) -> f64 {
    let breaks = system.breaks();
    let later = &breaks[breaks.partition_point(|b| b.time <= t)..];
    let found = later.iter().find(|b| sees(integrator, b.jump));
    found.map_or(end, |b| b.time.min(end))
}

/// Where a step after `t` must end, and the side of that time: the left one of a break.
fn stop(system: &dyn System, integrator: &dyn Integrator, t: f64, end: f64) -> (f64, Side) {
    let stop = next_break(system, integrator, t, end);
    let side = if jump_at(system, integrator, stop).is_some() { Side::Left } else { Side::Right };
    (stop, side)
}

/// What jumps at `t`, if the method sees it.
fn jump_at(system: &dyn System, integrator: &dyn Integrator, t: f64) -> Option<Jump> {
    let breaks = system.breaks();
    let at = breaks.get(breaks.partition_point(|b| b.time < t))?;
    (at.time == t && at.jump != Jump::Nothing && sees(integrator, at.jump)).then_some(at.jump)
}
