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

use super::breaks::next_break;
use super::contacts::Contacts;
use super::segment::Segment;
use super::{Burst, Ending, Event, EventKind, Leg, Observer, Plan, Run, RunError};
use crate::integrator::{Integration, Integrator, NonsmoothAlpha, StepError};
use crate::system::{Mode, Set, State, System};

/// Spectral radius of the nonsmooth method at infinite frequency.
const SPECTRAL_RADIUS: f64 = 0.8;
/// Longest step over the longest that the method of the run would take, and the first one over that.
const PART: f64 = 0.25;
const FIRST_PART: f64 = 0.125;
/// Halvings of a step that does not converge.
const HALVINGS: u32 = 12;

impl Run {
    /// Leaves the contacts of `state` to a burst, if one of them rubs or more are closed than motions that they hold: its method opens all.
    pub(super) fn leave_contacts(&mut self, system: &dyn System, state: &mut State) {
        if !self.rubbing.is_on(state) && !self.contacts.as_ref().is_some_and(Contacts::are_dependent) {
            return;
        }
        self.bursts.due = Some(0.0);
        for (i, _) in system.rows().iter().enumerate().filter(|(_, set)| **set != Set::Free) {
            (state.mode[i], state.lambda[i]) = (Mode::Open, 0.0);
        }
    }

    /// Follows contacts that chatter from `state` until they have come to rest, or to the end of the run. `mean` is the time between their events, 0 for contacts that
    /// [rub](super::rubbing) and are followed until they are open.
    pub(super) fn burst(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        state: &mut State,
        (plan, mean): (&Plan, f64),
        observer: &mut dyn Observer,
    ) -> Result<Option<Ending>, RunError> {
        let longest = plan.step.unwrap_or_else(|| plan.longest_from(self.origin));
        let step = plan.contact_step.unwrap_or((PART * longest).max(mean));
        (self.bursts.longest, self.bursts.step, self.bursts.count) = (step, FIRST_PART * step, 0);
        let rubbing = mean == 0.0;
        let begin = state.t;
        let mut own = (self.contacts.take(), self.control.take(), self.segment.take());
        if let Some(contacts) = &mut own.0 {
            self.bursts.add(std::mem::take(&mut contacts.neglected));
        }
        self.contacts = Contacts::new(system, state).and_then(Contacts::of_indicators);
        if let Some(balance) = &mut self.balance {
            balance.begin_burst(system, state);
        }
        observer.begin(true);
        let within = Plan { step: Some(self.bursts.step), longest_step: None, contact_step: None, ..*plan };
        let result = self.nonsmooth(system, state, &within, observer, integrator, (own.0, rubbing));
        (self.control, self.segment) = (own.1, own.2);
        let less = self.balance.as_mut().map_or(0.0, super::Integral::end_burst);
        observer.burst(&Burst { begin, end: state.t, step, less, rubbing });
        let (ended, contacts) = result?;
        self.contacts = contacts;
        if ended.is_some() {
            self.bursts.open = true;
            return Ok(ended);
        }
        observer.begin(false);
        observer.event(&Event { time: state.t, kind: EventKind::Switch, modes: state.mode.clone() });
        observer.passing(system, state);
        if let Some(control) = &mut self.control {
            control.restart(step);
        }
        if self.segment.is_some() {
            let end = next_break(system, integrator.info(), state.t, plan.end);
            self.segment = Some(Segment::new(state.t, end, longest));
        }
        self.begins = true;
        Ok(None)
    }

    /// The steps of a burst, and the way back to the method of the run, with its contacts.
    fn nonsmooth(
        &mut self,
        system: &mut dyn System,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
        integrator: &mut Integration,
        (mut contacts, rubbing): (Option<Contacts>, bool),
    ) -> Result<(Option<Ending>, Option<Contacts>), RunError> {
        let Ok(method) = NonsmoothAlpha::decoupled(SPECTRAL_RADIUS) else { return Ok((None, contacts)) };
        let started = method.start(system, state, self.bursts.step);
        let mut nonsmooth = started.map_err(|error| super::failed(system, state, error))?;
        self.begin_nonsmooth(system, &nonsmooth, state, plan);
        let mut halvings = 0;
        loop {
            self.bursts.quiet = Some(0);
            let leg = self.leg(system, &mut nonsmooth, state, plan, observer);
            self.bursts.quiet = None;
            let leg = match leg {
                Ok(leg) => leg,
                Err(RunError::Step { error: StepError::NotConverged { .. }, .. }) if halvings < HALVINGS => {
                    halvings += 1;
                    self.bursts.step *= 0.5;
                    self.bursts.count = 0;
                    let restarted = nonsmooth.restart(system, state);
                    restarted.map_err(|error| super::failed(system, state, error))?;
                    self.begin_nonsmooth(system, &nonsmooth, state, plan);
                    continue;
                }
                Err(error) => {
                    integrator.absorb(&nonsmooth);
                    return Err(error);
                }
            };
            if let Leg::Ended(ending) = leg {
                integrator.absorb(&nonsmooth);
                return Ok((Some(ending), contacts));
            }
            // Contacts that do not hold by themselves are left to this method.
            let mut settled = state.clone();
            let held = match &mut contacts {
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
                if !rubbing {
                    self.bursts.hold = self.bursts.hold.saturating_mul(2);
                }
                *state = settled;
                if let Some(balance) = &mut self.balance {
                    balance.restart(system, state);
                }
                integrator.absorb(&nonsmooth);
                return Ok((None, contacts));
            }
            self.bursts.hold = u32::MAX;
        }
    }

    /// Divides what is left into steps of a burst, from a state at which its method has begun anew.
    fn begin_nonsmooth(
        &mut self,
        system: &mut dyn System,
        nonsmooth: &Integration,
        state: &State,
        plan: &Plan,
    ) {
        let stop = next_break(system, nonsmooth.info(), state.t, plan.end);
        self.segment = Some(Segment::new(state.t, stop, self.bursts.step));
        if let Some(balance) = &mut self.balance {
            balance.restart(system, state);
        }
    }
}
