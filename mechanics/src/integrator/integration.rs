//! An integration in progress: what all methods have in common.

use super::{Attempt, Checkpoint, Counters, Info, NotResumed, Span, StepError, StepReport, Stepper};
use crate::system::{Dynamics, Side, State};

/// A started integrator. It counts the work done and what becomes of the attempts; the states are the caller's.
///
/// Protocol: [`step`](Integration::step) any number of times from the same state (a rejected attempt leaves the history as it
/// was), and [`accept`](Integration::accept) when the attempt is kept. After `accept`, and until the next `step`,
/// [`interpolate`](Integration::interpolate) gives the solution anywhere in the accepted step. No method but
/// [`restart`](Integration::restart) and [`resume`](Integration::resume) allocates.
pub struct Integration {
    stepper: Box<dyn Stepper>,
    info: Info,
    resolves_contacts: bool,
    counters: Counters,
    next: Attempt,
}

impl Integration {
    pub(super) fn new(
        stepper: Box<dyn Stepper>,
        info: Info,
        resolves_contacts: bool,
        counters: Counters,
    ) -> Integration {
        Integration { stepper, info, resolves_contacts, counters, next: Attempt::First }
    }

    /// What the method is.
    pub fn info(&self) -> &Info {
        &self.info
    }

    /// Whether the method resolves contacts in its own steps, so that a driver looks for no events of theirs.
    pub fn resolves_contacts(&self) -> bool {
        self.resolves_contacts
    }

    /// Work done since the start.
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// Counts the work of another method, from which the run goes over to this one, as its own.
    pub(crate) fn take_over(&mut self, other: &mut Integration) {
        let of = std::mem::take(&mut other.counters);
        let Counters { steps, rejected, iterations, residuals, tangents, factorizations, solves } =
            &mut self.counters;
        *steps += of.steps;
        *rejected += of.rejected;
        *iterations += of.iterations;
        *residuals += of.residuals;
        *tangents += of.tangents;
        *factorizations += of.factorizations;
        *solves += of.solves;
    }

    /// Attempts one step from `from`, writing the new state to `to`.
    ///
    /// # Errors
    /// [`StepError`]; the history is as it was.
    pub fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        span: Span,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let attempt = std::mem::replace(&mut self.next, Attempt::Repeated);
        self.counters.rejected += u64::from(attempt == Attempt::Repeated);
        (to.t, to.side) = (span.end, span.side);
        self.stepper.step(system, from, (span, attempt), to, &mut self.counters)
    }

    /// Discards a trial step of the location of events; it does not count as rejected.
    pub fn discard(&mut self) {
        self.next = Attempt::Trial;
    }

    /// Commits the last attempt to the history.
    pub fn accept(&mut self, from: &State, to: &State) {
        self.next = Attempt::First;
        self.counters.steps += 1;
        self.stepper.accept(from, to);
    }

    /// The solution at time `t` inside the last accepted step, between `from` and `to`. The system
    /// lends its [`retract`](Dynamics::retract): the polynomial lives in the space of increments.
    pub fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        self.stepper.interpolate(system, from, to, t, out);
    }

    /// The accepted step between `from` and `to` as its [energy balance](Stepper::middle) sees it.
    pub(crate) fn middle(
        &self,
        system: &dyn Dynamics,
        from: &State,
        to: &State,
        out: &mut State,
        damped: &mut [f64],
    ) {
        self.stepper.middle(system, from, to, out, damped);
    }

    /// Forgets the history after a discontinuity; completes `state`, from now on its right limit, with consistent accelerations
    /// and multipliers.
    ///
    /// # Errors
    /// [`StepError`] where there are none.
    pub fn restart(&mut self, system: &mut dyn Dynamics, state: &mut State) -> Result<(), StepError> {
        self.next = Attempt::First;
        state.side = Side::Right;
        self.stepper.restart(system, state, &mut self.counters)
    }

    /// At the state of the last restart contacts have struck, opened, stuck or slipped, or velocities have jumped.
    pub fn struck(&mut self) {
        self.stepper.struck();
    }

    /// Adds to `out` all that later steps depend on besides the state.
    pub fn save(&self, out: &mut Checkpoint) {
        out.put("counters", &self.counters.to_numbers());
        self.stepper.save(out);
    }

    /// Takes up the history that [`Integration::save`] wrote, after a start: the next steps are bit by bit those that would have
    /// followed.
    ///
    /// # Errors
    /// [`NotResumed`] when the history is not one of this method and this system.
    pub fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        self.stepper.resume(system, from)?;
        self.counters = from.counters()?;
        Ok(())
    }
}
