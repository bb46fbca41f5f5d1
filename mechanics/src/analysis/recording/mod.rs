//! Records of a run: its channels in time, and what happened at its contacts.
//!
//! [`record`] runs a system and gives its columns; a [`Recorder`] is the observer behind it, for drivers that need more
//! of a run.

mod events;
mod passing;
mod recorder;
mod rigid;
mod trajectory;
mod warning;

pub use events::{Entry, Events};
pub use recorder::{Columns, Recorder, Sampled, Watch};
pub(super) use trajectory::COMPONENTS;
pub use trajectory::{Extremes, Trajectory};
pub use warning::Warning;

use super::transient::{Ending, Plan, transient_to_checkpoint};
use crate::integrator::{Counters, Integrator};
use crate::system::{State, System};
use std::ops::ControlFlow;

/// A run and its records.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Record {
    /// Recorded times and values of all channels.
    pub trajectory: Trajectory,
    /// What happened at the contacts.
    pub events: Events,
    /// What makes the motion doubtful.
    pub warnings: Vec<Warning>,
    /// The last accepted step.
    pub state: State,
    /// Work done.
    pub counters: Counters,
    /// Size of the first step \[s\]; `None` where there was none.
    pub first_step: Option<f64>,
    /// How the run ended: what was computed until then is in the record.
    pub ending: Ending,
}

impl Record {
    /// Values of the channel called `name`, one a recorded time; `None` when there is none of that name.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        self.trajectory.column(name)
    }
}

impl AsRef<Record> for Record {
    fn as_ref(&self) -> &Record {
        self
    }
}

/// Integrates `system` from its [initial state](crate::system::Dynamics::initial) and records its channels and the energy
/// balance.
pub fn record(system: &mut dyn System, integrator: &dyn Integrator, plan: &Plan) -> Record {
    let start = system.initial();
    record_from(system, integrator, &start, plan)
}

/// As [`record`], from the state `start`.
pub fn record_from(
    system: &mut dyn System,
    integrator: &dyn Integrator,
    start: &State,
    plan: &Plan,
) -> Record {
    record_watched(system, integrator, start, plan, &mut |_| ControlFlow::Continue(()))
}

/// As [`record_from`]; `watch` is shown every step and ends the run by `Break`.
pub fn record_watched(
    system: &mut dyn System,
    integrator: &dyn Integrator,
    start: &State,
    plan: &Plan,
    watch: &mut Watch<'_>,
) -> Record {
    let mut state = start.clone();
    let columns = Columns { energy_balance: true, ..Columns::default() };
    let mut recorder = Recorder::new(system, &state, plan, columns).with_watch(watch);
    let (ending, checkpoint) = transient_to_checkpoint(system, integrator, &mut state, plan, &mut recorder);
    recorder.into_record(system, state, checkpoint.counters().unwrap_or_default(), ending)
}
