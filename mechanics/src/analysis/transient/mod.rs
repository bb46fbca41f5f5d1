//! Motion in time: drives a system with an integrator from a state to an end time.
//!
//! Steps end at the known [breaks](crate::system::Events::breaks) that a method can see, and at events: the closing step
//! takes the left limit of what jumps there, and the method restarts from the right one. A method with step control sees
//! every break and also ends steps where a load or a motion changes fast, one with fixed steps those of velocities and accelerations, for a kink costs it less than its own error.

mod adaptive;
mod breaks;
mod burst;
mod chatter;
mod contacts;
mod ending;
mod locate;
mod observer;
mod open_burst;
mod plan;
mod resumable;
mod rubbing;
mod segment;
mod show;

use ending::failed;
pub use ending::{Ending, RunError};
pub use observer::{Burst, Event, EventKind, Observer, Step};
pub use plan::Plan;
pub use resumable::resumable;

use super::energy_balance::Integral;
use crate::contact::{Bounds, Impact, ImpactMap};
use crate::integrator::{
    Checkpoint, Info, Integration, Integrator, NotResumed, Span, StepControl, StepReport,
};
use crate::quadrature::Gauss;
use crate::system::{Crossing, Jump, RowWeights, Side, State, System};
use adaptive::adapt;
use breaks::{is_fixed, jump_at, next_break, stop};
use chatter::{Bursts, Together};
use contacts::{ARC, Contacts, Unseen, approaches, loss, struck};
use open_burst::Open;
use rubbing::Rubbing;
use segment::Segment;

/// Blocks of events of continuous forces, too fast for what is left of a run, behind which it says so: those of one flat fall are no reason.
const GRINDING: u32 = 50;
/// Part of a fixed step that is not taken as a step of its own.
const SLIVER: f64 = 1e-6;
/// What is too short for a step, over the step that is due and over the time: what a step divides by its square would be rounding.
const INSTANT: f64 = 1e-10;
const MOMENT: f64 = 1e-12;

/// Integrates `system` from `state`, which is left at the last accepted step, and shows the observer the
/// start, every multiple of the recording interval, and the end: that of a run that fails or is stopped is its last accepted step.
pub fn transient(
    system: &mut dyn System,
    integrator: &dyn Integrator,
    state: &mut State,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> Ending {
    transient_to_checkpoint(system, integrator, state, plan, observer).0
}

/// As [`transient`], and gives a checkpoint of the last accepted step, from which [`resume`] goes on.
pub fn transient_to_checkpoint(
    system: &mut dyn System,
    integrator: &dyn Integrator,
    state: &mut State,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> (Ending, Checkpoint) {
    let mut run = Run::new(system, state);
    match run.begin(system, integrator, state, plan, observer) {
        Ok(mut integration) => {
            let ending = run.go_on(system, &mut integration, state, plan, observer);
            (ending, run.checkpoint(Some(&integration), state, plan.sample, observer))
        }
        Err(error) => (Ending::Failed(error), run.checkpoint(None, state, plan.sample, observer)),
    }
}

/// Goes on from a checkpoint of a run of the same system with the same integrator, of which `state` receives the
/// state: steps, samples and counters are bit by bit those of a run that has never stopped, if the plan is the same.
/// The state of the checkpoint itself is not shown to the observer.
///
/// # Errors
/// [`NotResumed`] when the checkpoint is not one of such a run, or a fixed step would change by the new end.
pub fn resume(
    system: &mut dyn System,
    integrator: &dyn Integrator,
    from: &Checkpoint,
    state: &mut State,
    plan: &Plan,
    observer: &mut dyn Observer,
) -> Result<(Ending, Checkpoint), NotResumed> {
    let mut run = Run::new(system, state);
    let mut integration = run.resume(system, integrator, from, state, plan, observer)?;
    let ending = run.go_on(system, &mut integration, state, plan, observer);
    Ok((ending, run.checkpoint(Some(&integration), state, plan.sample, observer)))
}

/// The moving parts of one run.
struct Run {
    origin: f64,
    /// Number of samples shown.
    samples: u64,
    last: Step,
    /// Steps of a fixed-step method until the next break.
    segment: Option<Segment>,
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
    /// Whether the next step is the first of a smooth motion.
    begins: bool,
    bursts: Bursts,
    /// The burst in which the run is.
    open: Option<Open>,
    rubbing: Rubbing,
}

/// Why a part of a run with one method is over.
#[derive(Clone, Debug, PartialEq)]
enum Leg {
    /// The run is.
    Ended(Ending),
    /// Contacts chatter, or are left to a nonsmooth method.
    Chatters,
    /// The contacts of a burst have come to rest.
    Settled,
}

impl Run {
    fn new(system: &mut dyn System, state: &State) -> Run {
        let contacts = Contacts::new(system, state);
        Run {
            origin: state.t,
            samples: 1,
            last: Step::default(),
            segment: None,
            control: None,
            balance: None,
            contacts,
            unseen: Unseen::new(system, state),
            within: Gauss::new(3),
            middle: state.clone(),
            gaps: vec![0.0; state.lambda.len()],
            begins: true,
            bursts: Bursts::default(),
            open: None,
            rubbing: Rubbing::new(system.rows()),
        }
    }

    /// Prepares the run, and shows its start.
    fn begin(
        &mut self,
        system: &mut dyn System,
        integrator: &dyn Integrator,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<Integration, RunError> {
        system.pass(state).map_err(|reason| RunError::Ended { time: state.t, reason })?;
        if integrator.resolves_contacts() {
            self.contacts = self.contacts.take().and_then(Contacts::of_indicators);
        }
        let mut pressed = None;
        if let Some(contacts) = &mut self.contacts {
            contacts.settle(system, state)?;
            if !contacts.resolved {
                let closed = state.clone();
                pressed = self.leave_contacts(system, state).then_some(closed);
            }
        }
        observer.begin(integrator.resolves_contacts());
        self.segment = plan.step.filter(|_| is_fixed(integrator.info())).map(|h| {
            let stop = next_break(system, integrator.info(), state.t, plan.end);
            Segment::new(state.t, stop, h)
        });
        let step = self.segment.map_or(plan.end - self.origin, |segment| segment.step);
        let started = integrator.start(system, state, step);
        let integration = started.map_err(|error| failed(system, state, error))?;
        // The first row has what the contacts press at rest.
        if let Some((mut closed, contacts)) = pressed.zip(self.contacts.as_mut()) {
            contacts.press(&mut closed);
            state.copy_forces(&closed);
        }
        self.set_control(system, integrator.info(), state, plan);
        self.balance = observer.wants_energy_balance().then(|| Integral::new(system, state));
        let balance = self.balance.as_ref().map(Integral::balance);
        observer.sample(system, state, &Step { balance, ..self.last });
        Ok(integration)
    }

    fn set_control(&mut self, system: &mut dyn System, info: &Info, state: &State, plan: &Plan) {
        let span = plan.end - self.origin;
        self.control = info.estimate_order.map(|order| {
            let first = plan
                .step
                .unwrap_or_else(|| StepControl::first_step(order, state, system.scales(), 1e-4, span));
            StepControl::new(order, span, first).with_longest(plan.longest_from(self.origin))
        });
    }

    /// Integrates to the end.
    fn go_on(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Ending {
        let ending = self.integrate(system, integrator, state, plan, observer).unwrap_or_else(Ending::Failed);
        if ending != Ending::Finished {
            self.show_last(system, state, plan, observer);
        }
        if let Some(excess) = self.balance.as_ref().and_then(|balance| balance.gain(system, state)) {
            observer.gained_energy(excess);
        }
        ending
    }

    /// The legs of a run: with its own method, and with a nonsmooth one while contacts chatter.
    fn integrate(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<Ending, RunError> {
        loop {
            if let Some(mean) = self.bursts.due.take() {
                self.begin_burst(system, integrator, state, (plan, mean), observer)?;
            }
            if let Some(ending) = self.follow(system, integrator, state, plan, observer)? {
                return Ok(ending);
            }
            if let Leg::Ended(ending) = self.leg(system, integrator, state, plan, observer)? {
                return Ok(ending);
            }
        }
    }

    /// Integrates with one method.
    fn leg(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<Leg, RunError> {
        let mut next = state.clone();
        while state.t < plan.end {
            let mut stop = stop(system, integrator.info(), state.t, plan.end);
            if stop.0 < plan.end && self.is_instant(state.t, stop.0, plan) {
                self.leap(system, integrator, state, stop, plan, observer)?;
                continue;
            }
            if self.control.is_some() && plan.break_steps > 1 {
                stop = self.part(system, state.t, stop, plan);
            }
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
            let mut neglected = self.contacts.as_ref().map(|contacts| contacts.neglected).unwrap_or_default();
            neglected.add(self.bursts.neglected());
            self.last = Step { size: h, iterations: report.iterations, balance: None, neglected };
            if let Err(what) = system.admissible(&next) {
                let reason = system.explain(&next).filter(|reason| *reason != what);
                return Err(RunError::Inadmissible { time: next.t, what, reason: reason.map(Box::new) });
            }
            integrator.accept(state, &next);
            if let Some(segment) = self.segment.as_mut().filter(|segment| next.t == segment.next()) {
                segment.advance();
            }
            let resolves = integrator.resolves_contacts();
            let struck = if resolves { struck(system, state, &next, &mut self.gaps) } else { None };
            let impact = struck.as_ref().is_some_and(|event| matches!(event.kind, EventKind::Impact { .. }));
            let (sample, slack) = self.next_sample(plan);
            if let Some(balance) = &mut self.balance {
                let lost = resolves.then(|| loss(system, state, &next, &mut self.gaps));
                let recorded = next.t >= sample - slack;
                balance.enter(system, integrator, (state, &next), (lost, impact), recorded);
            }
            let at_break = jump_at(system, integrator.info(), next.t);
            let ends = event || at_break.is_some() || next.t >= plan.end;
            self.show(system, integrator, (state, &next), (ends, impact), plan, observer);
            self.begins = event || at_break.is_some();
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
            observer.passing(system, &next, &self.passed());
            self.bursts.count(system, h, struck.as_ref());
            let rests = self.bursts.rest();
            if report.unsettled > 0.0 {
                observer.unsettled(next.t, report.unsettled);
            }
            if resolves {
                if let Some(event) = struck {
                    observer.event(&event);
                }
                let mut within = |system: &mut dyn System, t: f64, gaps: &mut [f64]| {
                    integrator.interpolate(system, state, &next, t, &mut self.middle);
                    system.constraint(&self.middle, RowWeights::POSITION, gaps);
                };
                let unseen = self.unseen.as_mut();
                if let Some(row) = unseen.and_then(|unseen| unseen.find(system, (state, &next), &mut within))
                {
                    observer.stepped_over(next.t, row);
                }
            }
            std::mem::swap(state, &mut next);
            let mut contact = None;
            if event || at_break.is_some() {
                self.cross(system, integrator, state, at_break, event.then_some(h / attempted), observer)?;
                contact = self.contacts.as_mut().and_then(|contacts| contacts.last.take());
                observer.passing(system, state, &self.passed());
                if let Some(control) = &mut self.control {
                    control.restart(attempted);
                }
                if at_break.is_some() && state.t < plan.end {
                    self.divide(system, integrator, state.t, plan);
                }
            }
            let left = plan.end - state.t;
            if let Some(contacts) = self.contacts.as_mut().filter(|contacts| !contacts.resolved) {
                let touched = contacts.touched.take();
                if let Some(mean) = contacts.touches.count(state.t, touched, left)
                    && contacts.touches.fast >= GRINDING
                {
                    observer.grinds(state.t, mean);
                }
                self.bursts.due = self.bursts.due.or(contacts.chatter.count(state.t, contact, left));
            }
            let settles = rests && !self.rubbing.is_on(state);
            if self.bursts.due.is_none()
                && !settles
                && let Some(step) = self.bursts.longer()
                && state.t < plan.end
            {
                let end = next_break(system, integrator.info(), state.t, plan.end);
                self.segment = Some(Segment::new(state.t, end, step));
            }
            if observer.step(state).is_break() && state.t < plan.end {
                return Ok(Leg::Ended(Ending::Stopped));
            }
            if self.bursts.due.is_some() && state.t < plan.end {
                return Ok(Leg::Chatters);
            }
            if settles && state.t < plan.end {
                return Ok(Leg::Settled);
            }
        }
        Ok(Leg::Ended(Ending::Finished))
    }

    /// Whether the time until `stop` is too short for a step.
    fn is_instant(&self, t: f64, stop: f64, plan: &Plan) -> bool {
        let asked = || plan.step.unwrap_or(plan.end - self.origin);
        let due = self.control.as_ref().map_or_else(asked, |control| control.propose(f64::INFINITY));
        stop - t <= (INSTANT * due).max(MOMENT * stop)
    }

    /// Goes on to a break that is next to nothing away, q ⊞ h v and v + h a, and across it.
    fn leap(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &mut State,
        (to, side): (f64, Side),
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let h = to - state.t;
        let way: Vec<f64> = state.v.iter().map(|v| h * v).collect();
        system.retract(&state.q.clone(), &way, &mut state.q);
        let State { v, a, .. } = state;
        v.iter_mut().zip(a.iter()).for_each(|(v, a)| *v += h * a);
        (state.t, state.side) = (to, side);
        let at_break = jump_at(system, integrator.info(), to);
        self.cross(system, integrator, state, at_break, None, observer)?;
        observer.passing(system, state, &self.passed());
        self.begins = true;
        self.divide(system, integrator, to, plan);
        Ok(())
    }

    /// Where a step under control after `t` must end, at `stop` or before, that as many lie between two breaks as the plan asks for.
    fn part(&self, system: &dyn System, t: f64, stop: (f64, Side), plan: &Plan) -> (f64, Side) {
        let breaks = system.breaks();
        let last = breaks[..breaks.partition_point(|b| b.time <= t)].last();
        let start = last.map_or(self.origin, |b| b.time.max(self.origin));
        let part = (stop.0 - start) / f64::from(plan.break_steps);
        // Where steps are shorter anyway, there is nothing to divide.
        if part >= plan.longest_from(self.origin) {
            return stop;
        }
        let next = (((t - start) / part + SLIVER).floor() + 1.0) * part + start;
        if stop.0 - next <= SLIVER * part { stop } else { (next, Side::Right) }
    }

    /// Divides the time from `t` to the next break into fixed steps.
    fn divide(&mut self, system: &dyn System, integrator: &Integration, t: f64, plan: &Plan) {
        if let (Some(segment), Some(asked)) = (&mut self.segment, plan.step) {
            *segment = Segment::new(t, next_break(system, integrator.info(), t, plan.end), asked);
        }
    }

    /// Attempts the next step.
    fn attempt(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &State,
        next: &mut State,
        (stop, side): (f64, Side),
        contact_step: Option<f64>,
    ) -> Result<(f64, StepReport), RunError> {
        let looked_for = self.contacts.as_ref().is_some_and(|contacts| !contacts.resolved);
        let arc = if looked_for { ARC / system.turning(state) } else { f64::INFINITY };
        if let Some(control) = &mut self.control {
            let h = control.propose(stop - state.t);
            let struck = self.contacts.as_ref().is_some_and(Contacts::has_struck);
            let near = |short: &f64| *short < h && (struck || approaches(system, state, h, &mut self.gaps));
            let longest = contact_step.filter(near).unwrap_or(f64::INFINITY).min(arc);
            return adapt(system, integrator, (state, longest), next, (stop, side), control)
                .map_err(|error| failed(system, state, error));
        }
        let (h, end) = match &mut self.segment {
            Some(segment) => {
                // A step that an event has shortened goes on to where it would have ended, or a step further where
                // next to nothing is left.
                while segment.next() < stop && segment.next() - state.t < SLIVER * segment.step {
                    segment.advance();
                }
                let left = segment.next() - state.t;
                let whole = (left - segment.step).abs() <= 1e-9 * segment.step;
                let h = if whole { segment.step } else { left };
                let near = contact_step.filter(|_| approaches(system, state, h, &mut self.gaps));
                let short = near.unwrap_or(f64::INFINITY).min(arc);
                if short < h * (1.0 - 1e-9) {
                    let h = h / (h / short - 1e-9).ceil();
                    (h, state.t + h)
                } else {
                    (h, segment.next())
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
        integrator: &mut Integration,
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
                contacts.touched = Together::of(fired.iter().copied().take(1));
                let crossing = system.cross(&fired, state);
                happened.push(EventKind::Crossing { indicators: fired });
                match crossing {
                    Crossing::Continue | Crossing::Restart => {}
                    Crossing::Jump => jump = true,
                    Crossing::Stop(reason) => return Err(RunError::Ended { time: state.t, reason }),
                }
            }
        }
        let mut impulse = vec![0.0; state.v.len() + state.lambda.len()];
        let jump = jump && system.impulse(&before, &mut impulse);
        let (mut work, mut lost) = (0.0, 0.0);
        if event.is_some() || jump {
            let mut fallback;
            let contacts = match &mut self.contacts {
                Some(contacts) => contacts,
                None => {
                    fallback = ImpactMap::new(system);
                    let impact = fallback.strike(system, state, &impulse, Bounds::default());
                    let impact = impact.map_err(|cause| RunError::Contact { time: state.t, cause })?;
                    work = system.impulse_work(&before, state) + impact.work;
                    happened.push(EventKind::Jump { work });
                    return self.restart(system, integrator, state, (work, lost), happened, observer);
                }
            };
            if let Some(part) = event
                && contacts.count_event(system.rows(), state.t, part)?
            {
                self.bursts.due = Some(f64::MIN_POSITIVE);
            }
            if contacts.resolved && !jump {
                return self.restart(system, integrator, state, (work, lost), happened, observer);
            }
            let impact = contacts.strike(system, state, &impulse)?;
            // A prescribed motion does work in every impact.
            work += system.impulse_work(&before, state) + impact.work;
            if jump {
                happened.push(EventKind::Jump { work });
            }
            lost = impact.lost;
            contacts.remember(system.rows(), &before, state, &impact);
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
        integrator: &mut Integration,
        state: &mut State,
        (work, lost): (f64, f64),
        happened: Vec<EventKind>,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let struck = !happened.is_empty();
        for kind in happened {
            observer.event(&Event { time: state.t, kind, modes: state.mode.clone() });
        }
        system.pass(state).map_err(|reason| RunError::Ended { time: state.t, reason })?;
        if !integrator.resolves_contacts() {
            self.leave_contacts(system, state);
        }
        integrator.restart(system, state).map_err(|error| failed(system, state, error))?;
        if struck {
            integrator.struck();
        }
        if let Some(balance) = &mut self.balance {
            balance.add_impulse(work, lost);
            balance.restart(system, state);
        }
        Ok(())
    }
}
