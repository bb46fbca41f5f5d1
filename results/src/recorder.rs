//! An observer that records a run.

use super::{Shapes, Trajectory};
use flexion::analysis::transient::{Observer, Plan, Step};
use flexion::system::{Channel, State, System};
use std::ops::ControlFlow;

/// Called after every accepted step; `Break` stops the run.
pub type Watch<'a> = dyn FnMut(&State) -> ControlFlow<()> + 'a;

/// Records the channels of a system and what every run has: the total energy, the size of the step and
/// the iterations it took.
pub struct Recorder<'a> {
    trajectory: Trajectory,
    shapes: Option<Shapes>,
    books: bool,
    /// Where the system records its kinetic, strain and gravity energy.
    energies: Vec<usize>,
    watch: &'a mut Watch<'a>,
}

impl<'a> Recorder<'a> {
    /// A recorder for runs of `system` by `plan`, with someone to be told of every step.
    /// `books` asks for work, losses and the balance of energy too.
    pub fn new(system: &dyn System, plan: &Plan, books: bool, watch: &'a mut Watch<'a>) -> Recorder<'a> {
        let mut channels = system.channels().to_vec();
        let mut add = |name: &str, unit, meaning: &str| {
            channels.push(Channel { name: name.to_owned(), unit, meaning: meaning.to_owned() });
        };
        add("energy.total", "J", "kinetic, strain and gravity energy");
        if books {
            add("energy.drive", "J", "work of what moves the hub since the start");
            add("energy.loads", "J", "work of the loads since the start, gravity aside");
            add("energy.dissipated", "J", "energy lost in dampers since the start");
            add(
                "energy.balance",
                "J",
                "total energy beyond that of the start and the work, losses added: 0 if exact",
            );
        }
        add("step.size", "s", "size of the time step that covers this time");
        add("step.iterations", "", "Newton iterations of that step");
        let mut trajectory = Trajectory::new(channels);
        trajectory.reserve((plan.end / plan.sample).min(1e7) as usize + 2);
        let place = |kind: &str| system.channels().iter().position(|c| c.name == format!("energy.{kind}"));
        let energies = ["kinetic", "strain", "gravity"].into_iter().filter_map(place).collect();
        Recorder { trajectory, shapes: None, books, energies, watch }
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
    fn wants_books(&self) -> bool {
        self.books
    }

    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        self.trajectory.push(state.t, |row| {
            let (own, common) = row.split_at_mut(system.channels().len());
            system.record(state, own);
            let total = match self.energies.as_slice() {
                [] => system.energy(state).total(),
                recorded => recorded.iter().map(|&i| own[i]).sum(),
            };
            let books = step.books.filter(|_| self.books);
            let kept = books.map(|b| [b.drive, b.loads, b.dissipated, b.balance(total)]);
            let steps = [step.size, f64::from(step.iterations)];
            let values = std::iter::once(total).chain(kept.into_iter().flatten()).chain(steps);
            for (out, value) in common.iter_mut().zip(values) {
                *out = value;
            }
        });
        if let Some(shapes) = &mut self.shapes {
            shapes.sample(system, state);
        }
    }

    fn step(&mut self, state: &State) -> ControlFlow<()> {
        (self.watch)(state)
    }
}
