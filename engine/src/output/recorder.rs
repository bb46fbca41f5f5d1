//! An observer that records a run.

use super::{Shapes, Trajectory};
use crate::analysis::transient::{Observer, Plan, Step};
use crate::system::{Channel, State, System};
use std::ops::ControlFlow;

/// Called after every accepted step; `Break` stops the run.
pub type Watch<'a> = dyn FnMut(&State) -> ControlFlow<()> + 'a;

/// Records the channels of a system and what every run has: the total energy, the size of the step and
/// the iterations it took.
pub struct Recorder<'a> {
    trajectory: Trajectory,
    shapes: Option<Shapes>,
    watch: &'a mut Watch<'a>,
}

impl<'a> Recorder<'a> {
    /// A recorder for runs of `system` by `plan`, with someone to be told of every step.
    pub fn new(system: &dyn System, plan: &Plan, watch: &'a mut Watch<'a>) -> Recorder<'a> {
        let mut channels = system.channels().to_vec();
        let mut add = |name: &str, unit, meaning: &str| {
            channels.push(Channel { name: name.to_owned(), unit, meaning: meaning.to_owned() });
        };
        add("energy.total", "J", "kinetic, strain and gravity energy");
        add("step.size", "s", "size of the time step that covers this time");
        add("step.iterations", "", "Newton iterations of that step");
        let mut trajectory = Trajectory::new(channels);
        trajectory.reserve((plan.end / plan.sample).min(1e7) as usize + 2);
        Recorder { trajectory, shapes: None, watch }
    }

    /// The recorder, taking shapes too.
    pub fn with_shapes(self, shapes: Option<Shapes>) -> Recorder<'a> {
        Recorder { shapes, ..self }
    }

    /// What was recorded.
    pub fn into_parts(self) -> (Trajectory, Option<Shapes>) {
        (self.trajectory, self.shapes)
    }
}

impl Observer for Recorder<'_> {
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        self.trajectory.push(state.t, |row| {
            let (own, common) = row.split_at_mut(system.channels().len());
            system.record(state, own);
            common.copy_from_slice(&[system.energy(state).total(), step.size, f64::from(step.iterations)]);
        });
        if let Some(shapes) = &mut self.shapes {
            shapes.sample(system, state);
        }
    }

    fn step(&mut self, state: &State) -> ControlFlow<()> {
        (self.watch)(state)
    }
}
