//! What a run shows: samples, steps, events.

use crate::analysis::EnergyBalance;
use crate::contact::Neglected;
use crate::integrator::{Checkpoint, NotResumed};
use crate::system::{Mode, State, System};
use std::ops::ControlFlow;

/// What an observer receives besides the state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// Size of the step that ended at or covers this state \[s\]; 0 at the start.
    pub size: f64,
    /// Newton iterations of that step.
    pub iterations: u32,
    /// The energy balance until this state, if the observer [wants it](Observer::wants_energy_balance).
    pub balance: Option<EnergyBalance>,
    /// Bounds of what the bounces that were not followed since the start would have done.
    pub neglected: Neglected,
}

/// A part of a run in which steps of a nonsmooth method took the place of those of the method of the run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Burst {
    /// Its begin \[s\].
    pub begin: f64,
    /// Its end \[s\].
    pub end: f64,
    /// Its longest step \[s\].
    pub step: f64,
    /// What dampers have taken less than by their power at the ends of steps \[J\].
    pub less: f64,
    /// Whether it was for the friction of contacts in space, and not for contacts that chatter.
    pub rubbing: bool,
}

/// Something that happened at one time of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Time \[s\].
    pub time: f64,
    /// What happened.
    pub kind: EventKind,
    /// Mode of every row behind it.
    pub modes: Vec<Mode>,
}

/// What happened at an event.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// A prescribed velocity jumped; with the work \[J\] of what enforces it.
    Jump {
        /// Work \[J\].
        work: f64,
    },
    /// Contacts closed with an impulse.
    Impact {
        /// Impulse of each row [N·s].
        impulses: Vec<f64>,
        /// Energy lost \[J\].
        lost: f64,
        /// ġ of each row before [m/s].
        rates: Vec<f64>,
        /// Effective mass of each row that took part \[kg\], 0 for the others.
        masses: Vec<f64>,
    },
    /// Contacts opened, closed without impulse, began to slip or to stick.
    Switch,
    /// Indicators of the model changed their signs.
    Crossing {
        /// Their numbers.
        indicators: Vec<usize>,
    },
}

/// Observes a run: records, reports progress, stops it.
pub trait Observer {
    /// Whether the energy balance is integrated along the run: one to three evaluations of the power a step.
    fn wants_energy_balance(&self) -> bool {
        false
    }

    /// A state at a time to be recorded.
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step);

    /// A method begins in whose steps velocities may jump, so that a multiplier is the impulse of its step over its size, or one in which they do not.
    fn begin(&mut self, _jumps: bool) {}

    /// An accepted step ended at `state`, or a jump: what happens between samples is seen here.
    fn passing(&mut self, _system: &mut dyn System, _state: &State, _step: &Step) {}

    /// A state between the ends of a step that is the first or the last of a smooth motion, in order of time with the samples.
    fn between(&mut self, _system: &mut dyn System, _state: &State, _step: &Step) {}

    /// Whether states [within](Observer::within) the steps are shown.
    fn wants_within(&self) -> bool {
        false
    }

    /// A state in an accepted step: the integral of a quantity over the step is the sum of its values times `weight` \[s\]
    /// (Gauss's rule).
    fn within(&mut self, _system: &mut dyn System, _state: &State, _weight: f64) {}

    /// An accepted step ended at `state`; `Break` stops the run there.
    fn step(&mut self, _state: &State) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }

    /// An event.
    fn event(&mut self, _event: &Event) {}

    /// The run has gained the energy `excess` \[J\] beyond the work done on it: its steps are too large for its method.
    fn gained_energy(&mut self, _excess: f64) {}

    /// The gap of the row `row` has fallen and risen in the step that ends at `time`, and may have been negative inside: the
    /// method locates no events, and a point may have passed through an obstacle.
    fn stepped_over(&mut self, _time: f64, _row: usize) {}

    /// The forces of contacts did not settle in the step that ends at `time`: what a force and the motion of its contact contradict each other by is `residual` of the
    /// largest.
    fn unsettled(&mut self, _time: f64, _residual: f64) {}

    /// Steps of a nonsmooth method have followed contacts.
    fn burst(&mut self, _burst: &Burst) {}

    /// At `time` continuous forces of contacts, or what the model indicates, begin and end so fast, with the time `mean` \[s\] between, that the run has more events
    /// before it than it is likely to come through.
    fn grinds(&mut self, _time: f64, _mean: f64) {}

    /// Adds to the checkpoint of the run what it depends on later of what it has seen.
    fn save(&self, _out: &mut Checkpoint) {}

    /// Takes up what an observer of the earlier run [saved](Observer::save), if one did.
    ///
    /// # Errors
    /// [`NotResumed`] when it is not of such a run.
    fn resume(&mut self, _from: &Checkpoint) -> Result<(), NotResumed> {
        Ok(())
    }
}
