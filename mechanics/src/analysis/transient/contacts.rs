//! Contacts of a run: impacts, and which contacts are closed.

use super::ending::RunError;
use super::locate::{Locator, TOUCHING};
use crate::contact::{Impact, ImpactMap};
use crate::system::{RowWeights, Set, State, System};

/// Closing speed, over the largest met in the run, below which an impact is taken without restitution.
const RESTING: f64 = 1e-5;
/// Events in a row with next to no time between them at which a run ends.
const MOST_EVENTS: usize = 1000;
/// Part of an attempted step below which an event follows the one before at once.
const SHORT: f64 = 1e-6;

/// What a run needs for contacts and events.
pub(super) struct Contacts {
    pub(super) locator: Locator,
    map: ImpactMap,
    /// Largest closing speed so far [m/s].
    pub(super) fastest: f64,
    rates: Vec<f64>,
    /// Events in a row with no time between them.
    events: usize,
}

impl Contacts {
    /// `None` for a system without contacts and indicators.
    pub(super) fn new(system: &dyn System, state: &State) -> Option<Contacts> {
        Some(Contacts {
            locator: Locator::new(system, state)?,
            map: ImpactMap::new(system),
            fastest: 0.0,
            rates: vec![0.0; state.lambda.len()],
            events: 0,
        })
    }

    /// Sets the modes of the contacts at the start of a run.
    pub(super) fn settle(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), RunError> {
        let touching = 100.0 * TOUCHING * self.locator.length;
        let settled = self.map.settle(system, state, touching, &[]);
        settled.map_err(|cause| RunError::Contact { time: state.t, cause })
    }

    /// The impact at `state` with the impulse `p`: without restitution where it is slow.
    pub(super) fn strike(
        &mut self,
        system: &mut dyn System,
        state: &mut State,
        p: &[f64],
    ) -> Result<Impact, RunError> {
        let touching = 100.0 * TOUCHING * self.locator.length;
        system.constraint(state, RowWeights::VELOCITY, &mut self.rates);
        for (set, rate) in system.rows().iter().zip(&self.rates) {
            if matches!(set, Set::Unilateral { .. }) {
                self.fastest = self.fastest.max(-rate);
            }
        }
        let weak = 1e-9 * self.locator.strongest;
        let bounds = [touching, RESTING * self.fastest, weak];
        let struck = self.map.strike(system, state, p, bounds);
        struck.map_err(|cause| RunError::Contact { time: state.t, cause })
    }

    /// Counts the events that follow each other with no time between them.
    pub(super) fn count_event(&mut self, time: f64, part: f64) -> Result<(), RunError> {
        self.events = if part < SHORT { self.events + 1 } else { 0 };
        if self.events > MOST_EVENTS { Err(RunError::Chatter { time, count: self.events }) } else { Ok(()) }
    }
}
