//! Bursts: contacts that chatter are followed by steps of a nonsmooth method, until none of them opens or closes any more.
//!
//! Where a beam lies down on a floor, each impact sets it vibrating, and its other contacts open and close at the rate of its fastest vibrations. Their
//! events are too many to be found one by one ([`super::chatter`]). A nonsmooth step resolves all contacts that touch within it at its end: the time of an
//! impact is known to a step h, its place to h|ġ|, and of the rebounds within a step those that would follow are lost, ½ (eġ)²/W each. These bounds are
//! added up as what [bounces not followed](crate::contact::Neglected) would have done.
//!
//! Steps begin short and are doubled, for what is fast in a burst is dissipated first, and halved where they do not converge. What dampers take in them of vibrations that
//! they do not resolve follows from the [balance of energy](super::super::energy_balance), and is shown with the burst.
//!
//! So are rigid contacts with friction in space, which [rub](super::rubbing), and more contacts than there are motions for them to hold, as the four feet of a box: while they are
//! closed.
//!
//! The run comes back to its own method when no contact has opened or closed for so many steps, twice as many each time; where it cannot, for rows of
//! closed contacts depend on each other, it goes on with nonsmooth steps.

use super::breaks::{is_fixed, next_break};
use super::contacts::Contacts;
use super::open_burst::{OWN, Open};
use super::segment::Segment;
use super::{Burst, Ending, Event, EventKind, Leg, Observer, Plan, Run, RunError};
use crate::integrator::{
    Checkpoint, Integration, Integrator, InvalidParameter, NonsmoothAlpha, NotResumed, StepError,
};
use crate::system::{Mode, Set, State, System};

/// Spectral radius of the nonsmooth method at infinite frequency.
const SPECTRAL_RADIUS: f64 = 0.8;
/// Longest step over the longest that the method of the run would take, and the first one over that.
const PART: f64 = 0.25;
const FIRST_PART: f64 = 0.125;
/// Halvings of a step that does not converge.
const HALVINGS: u32 = 12;

impl Run {
    /// Leaves the contacts of `state` to a burst, if one of them rubs or more are closed than motions that they hold: a method that locates events begins with all open.
    /// Tells whether it does.
    pub(super) fn leave_contacts(&mut self, system: &dyn System, state: &mut State) -> bool {
        let leaves = self.rubbing.is_on(state) || self.contacts.as_ref().is_some_and(Contacts::are_dependent);
        if leaves {
            self.bursts.due = Some(0.0);
            open(system, state);
        }
        leaves
    }

    /// Leaves contacts that chatter from `state` on to a nonsmooth method. `mean` is the time between their events, 0 for contacts that [rub](super::rubbing) and are
    /// followed until they are open.
    pub(super) fn begin_burst(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &mut State,
        (plan, mean): (&Plan, f64),
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let longest = plan.step.unwrap_or_else(|| plan.longest_from(self.origin));
        let step = plan.contact_step.unwrap_or((PART * longest).max(mean));
        (self.bursts.longest, self.bursts.step, self.bursts.count) = (step, FIRST_PART * step, 0);
        let Ok(method) = method() else { return Ok(()) };
        let started = method.start(system, state, self.bursts.step);
        let mut nonsmooth = started.map_err(|error| super::failed(system, state, error))?;
        nonsmooth.take_over(integrator);
        let mut contacts = self.contacts.take();
        if let Some(contacts) = &mut contacts {
            self.bursts.add(std::mem::take(&mut contacts.neglected));
        }
        self.contacts = Contacts::new(system, state).and_then(Contacts::of_indicators);
        if let Some(balance) = &mut self.balance {
            balance.begin_burst(system, state);
        }
        observer.begin(true);
        self.divide_burst(system, &nonsmooth, state, plan.end);
        self.bursts.quiet = Some(0);
        let (control, rubbing) = (self.control.take(), mean == 0.0);
        self.open = Some(Open { nonsmooth, contacts, control, begin: state.t, rubbing, halvings: 0 });
        Ok(())
    }

    /// Follows the contacts of an open burst until they have come to rest, or to the end of the run.
    pub(super) fn follow(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<Option<Ending>, RunError> {
        let Some(mut open) = self.open.take() else { return Ok(None) };
        let result = self.nonsmooth(system, integrator, state, (plan, &mut open), observer);
        let less = self.balance.as_ref().map_or(0.0, super::Integral::burst_less);
        let Open { begin, rubbing, .. } = open;
        observer.burst(&Burst { begin, end: state.t, step: self.bursts.longest, less, rubbing });
        if !matches!(result, Ok(None)) {
            // From here the run can go on.
            self.open = Some(open);
            return result;
        }
        let Open { mut nonsmooth, contacts, control, .. } = open;
        integrator.take_over(&mut nonsmooth);
        (self.contacts, self.control, self.bursts.quiet) = (contacts, control, None);
        if let Some(balance) = &mut self.balance {
            balance.end_burst();
        }
        observer.begin(false);
        observer.event(&Event { time: state.t, kind: EventKind::Switch, modes: state.mode.clone() });
        observer.passing(system, state, &self.passed());
        if let Some(control) = &mut self.control {
            control.restart(self.bursts.longest);
        }
        self.segment = plan.step.filter(|_| is_fixed(integrator.info())).map(|step| {
            let end = next_break(system, integrator.info(), state.t, plan.end);
            Segment::new(state.t, end, step)
        });
        self.begins = true;
        Ok(None)
    }

    /// The steps of a burst, and the way back to the method of the run, with its contacts.
    fn nonsmooth(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &mut State,
        (plan, open): (&Plan, &mut Open),
        observer: &mut dyn Observer,
    ) -> Result<Option<Ending>, RunError> {
        let step = Some(FIRST_PART * self.bursts.longest);
        let plan = &Plan { step, longest_step: None, contact_step: None, ..*plan };
        let Open { nonsmooth, contacts, rubbing, halvings, .. } = open;
        loop {
            // A run that was stopped where its contacts had come to rest.
            let settles = self.bursts.rest() && !self.rubbing.is_on(state);
            let leg =
                if settles { Ok(Leg::Settled) } else { self.leg(system, nonsmooth, state, plan, observer) };
            match leg {
                Ok(Leg::Ended(ending)) => return Ok(Some(ending)),
                Ok(_) => self.bursts.quiet = Some(0),
                Err(RunError::Step { error: StepError::NotConverged { .. }, .. }) if *halvings < HALVINGS => {
                    *halvings += 1;
                    (self.bursts.step, self.bursts.count, self.bursts.quiet) =
                        (0.5 * self.bursts.step, 0, Some(0));
                    let restarted = nonsmooth.restart(system, state);
                    restarted.map_err(|error| super::failed(system, state, error))?;
                    self.divide_burst(system, nonsmooth, state, plan.end);
                    continue;
                }
                Err(error) => return Err(error),
            }
            // Contacts that do not hold by themselves are left to this method.
            let mut settled = state.clone();
            let held = match contacts {
                Some(contacts) => contacts.settle(system, &mut settled).is_ok(),
                None => false,
            };
            if held && self.rubbing.is_on(&settled) {
                continue;
            }
            if held && contacts.as_ref().is_some_and(Contacts::are_dependent) {
                self.bursts.hold = self.bursts.hold.saturating_mul(2);
                continue;
            }
            if held && settled.is_finite() && integrator.restart(system, &mut settled).is_ok() {
                if !*rubbing {
                    self.bursts.hold = self.bursts.hold.saturating_mul(2);
                }
                *state = settled;
                if let Some(balance) = &mut self.balance {
                    balance.restart(system, state);
                }
                return Ok(None);
            }
            self.bursts.hold = u32::MAX;
        }
    }

    /// Divides what is left into steps of a burst, from a state at which its method has begun anew.
    fn divide_burst(&mut self, system: &mut dyn System, nonsmooth: &Integration, state: &State, end: f64) {
        let stop = next_break(system, nonsmooth.info(), state.t, end);
        self.segment = Some(Segment::new(state.t, stop, self.bursts.step));
        if let Some(balance) = &mut self.balance {
            balance.restart(system, state);
        }
    }
}

/// Opens all contacts.
pub(super) fn open(system: &dyn System, state: &mut State) {
    for i in of_contacts(system) {
        (state.mode[i], state.lambda[i]) = (Mode::Open, 0.0);
    }
}

/// The rows of contacts.
fn of_contacts(system: &dyn System) -> impl Iterator<Item = usize> {
    system.rows().iter().enumerate().filter(|(_, set)| **set != Set::Free).map(|(i, _)| i)
}

/// The nonsmooth method of a burst.
fn method() -> Result<NonsmoothAlpha, InvalidParameter> {
    NonsmoothAlpha::decoupled(SPECTRAL_RADIUS)
}

impl Run {
    /// Takes up the burst in which a run ended, from its `state`; the run has taken up all else.
    pub(super) fn reopen(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        from: &Checkpoint,
        state: &mut State,
        plan: &Plan,
    ) -> Result<(), NotResumed> {
        let [step, longest, quiet, count, halvings, rubbing] = from.finite("burst")?;
        if !(step > 0.0 && longest >= step) {
            return Err(NotResumed::Invalid("burst".to_owned()));
        }
        (self.bursts.step, self.bursts.longest) = (step, longest);
        (self.bursts.quiet, self.bursts.count) = (Some(quiet as u32), count as u32);
        let (mut contacts, mut control) = (self.contacts.take(), self.control.take());
        if let Some(contacts) = &mut contacts {
            contacts.recall(from.numbers("burst.contacts")?);
        }
        if let Some(control) = &mut control {
            let memory: [f64; 4] = from.numbers("burst.control")?;
            if !(memory[0] > 0.0 && memory[0].is_finite()) {
                return Err(NotResumed::Invalid("burst.control".to_owned()));
            }
            control.recall(memory);
        }
        self.contacts = Contacts::new(system, state).and_then(Contacts::of_indicators);
        if let Some(contacts) = &mut self.contacts {
            contacts.recall(from.numbers("contacts")?);
        }
        let failed = |error: &dyn std::fmt::Display| NotResumed::Failed(error.to_string());
        let method = method().map_err(|error| failed(&error))?;
        let started = method.start(system, &mut state.clone(), step);
        let mut nonsmooth = started.map_err(|error| failed(&error))?;
        nonsmooth.resume(system, from)?;
        integrator.resume(system, &from.part(OWN))?;
        let stop = next_break(system, nonsmooth.info(), state.t, plan.end);
        let recalled = Segment::recall(from.finite("segment")?, stop, step);
        // A run to another end divides what is left anew.
        let (segment, at) = recalled.unwrap_or_else(|_| (Segment::new(state.t, stop, step), state.t));
        if (state.t - at).abs() <= 1e-9 * segment.step {
            state.t = at;
        }
        self.segment = Some(segment);
        let (begin, halvings, rubbing) = (state.t, halvings as u32, rubbing != 0.0);
        self.open = Some(Open { nonsmooth, contacts, control, begin, rubbing, halvings });
        Ok(())
    }
}
