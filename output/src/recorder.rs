//! An observer that records a run.

use super::passing::Passing;
use super::summary::relative_imbalance;
use super::{Events, Scene, Shapes, Trajectory};
use flexion::analysis::Violation;
use flexion::analysis::transient::{Event, Observer, Plan, Step};
use flexion::system::{Channel, Direction, Role, State, System};
use std::ops::ControlFlow;

/// Relative imbalance of the energy that a run may show without a warning.
const IMBALANCE: f64 = 0.2;
/// Fewest steps a period of a vibration whose amplitude and phase are followed.
const STEPS_A_PERIOD: f64 = 10.0;

/// Called after every accepted step; `Break` stops the run.
pub type Watch<'a> = dyn FnMut(&State) -> ControlFlow<()> + 'a;

/// Records the channels of a system and what every run has: the total energy, the size of the step and
/// the iterations it took.
pub struct Recorder<'a> {
    trajectory: Trajectory,
    shapes: Option<Shapes>,
    scene: Scene,
    events: Events,
    /// Of systems with rows of constraints.
    violation: Option<Violation>,
    /// Unknowns of the transverse modes whose shares are recorded.
    modes: Vec<usize>,
    balance: bool,
    /// Channels of the system that are parts of the total energy.
    energies: Vec<usize>,
    /// First columns of unit quaternions.
    quaternions: Vec<usize>,
    gain: Option<f64>,
    /// The first time at which a point may have stepped over an obstacle, and the name of its contact.
    stepped_over: Option<(f64, String)>,
    passing: Passing,
    /// Whether the steps are fixed.
    fixed: bool,
    watch: &'a mut Watch<'a>,
}

impl<'a> Recorder<'a> {
    /// A recorder for runs of `system` from `state` by `plan` that calls `watch` after every step.
    /// `balance` asks for work, losses and the energy balance too, `shares` for those of the unknowns across the beam,
    /// W_i = B_i²/ΣB².
    pub fn new(
        system: &mut dyn System,
        state: &State,
        plan: &Plan,
        [balance, shares]: [bool; 2],
        watch: &'a mut Watch<'a>,
    ) -> Recorder<'a> {
        let events = Events::new(system, state);
        let mut channels = system.channels().to_vec();
        let parts = channels.iter().enumerate().filter(|(_, c)| c.role == Role::Energy);
        let energies = parts.map(|(i, _)| i).collect();
        let mut add = |role, name: &str, unit, meaning: &str| {
            channels.push(Channel { name: name.to_owned(), unit, meaning: meaning.to_owned(), role });
        };
        add(Role::Work, "energy.total", "J", "kinetic, strain, gravity and contact energy");
        if balance {
            add(Role::Work, "energy.drive", "J", "work of what moves the hub since the start");
            add(Role::Work, "energy.loads", "J", "work of the loads since the start, gravity aside");
            add(Role::Work, "energy.dissipated", "J", "energy lost in dampers since the start");
            if !events.is_empty() {
                add(Role::Work, "energy.contact_loss", "J", "energy lost in contacts since the start");
            }
            let meaning = "error of the energy balance, E(t) − E(0) − work + losses: zero if exact";
            add(Role::Imbalance, "energy.balance", "J", meaning);
        }
        add(Role::Integration, "step.size", "s", "size of the time step that covers this time");
        add(Role::Integration, "step.iterations", "", "Newton iterations of that step");
        let violation = (system.size().lambda > 0).then(|| Violation::new(system));
        if violation.is_some() {
            let meaning =
                "largest violation of constraints and closed contacts, and penetration of open ones";
            add(Role::Integration, "constraint.position", "m", meaning);
            let meaning = "largest velocity against constraints and closed contacts";
            add(Role::Integration, "constraint.velocity", "m/s", meaning);
            let meaning = "largest acceleration against constraints and closed contacts";
            add(Role::Integration, "constraint.acceleration", "m/s^2", meaning);
        }
        let across = |i: &usize| shares && system.direction(*i) == Direction::Chord;
        let modes: Vec<usize> = (0..system.size().v).filter(across).collect();
        for k in 1..=modes.len() {
            add(
                Role::Detail,
                &format!("mode.{k}.share"),
                "",
                &format!("share B²/ΣB² of the transverse mode {k}"),
            );
        }
        let mut passing = Passing::new(system, state, plan.end - state.t);
        let forces: Vec<String> = events.names().map(|name| format!("{name}.force")).collect();
        let of_contact = |(_, channel): &(usize, &Channel)| forces.contains(&channel.name);
        passing.pressing = system.channels().iter().enumerate().filter(of_contact).map(|(i, _)| i).collect();
        let mut trajectory = Trajectory::new(channels);
        trajectory.reserve((plan.end / plan.sample).min(1e7) as usize + 2);
        Recorder {
            quaternions: trajectory.quaternions(),
            trajectory,
            shapes: None,
            scene: Scene::default(),
            events,
            violation,
            modes,
            balance,
            energies,
            gain: None,
            stepped_over: None,
            passing,
            fixed: plan.step.is_some(),
            watch,
        }
    }

    /// The recorder, taking shapes and the motion in space too.
    pub fn with_shapes(self, shapes: Option<Shapes>, scene: Scene) -> Recorder<'a> {
        Recorder { shapes, scene, ..self }
    }

    /// The recorder, for a method in whose steps velocities may jump: no curve is drawn through their ends.
    pub fn with_jumps_in_steps(mut self, jumps: bool) -> Recorder<'a> {
        self.passing.rough = jumps && !self.events.is_empty();
        self
    }

    /// What the reader should know of the steps: the run has gained energy that nothing has put in, its energy balance does
    /// not close, or fixed steps do not resolve its vibrations.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let imbalance = relative_imbalance(&self.trajectory).filter(|imbalance| *imbalance > IMBALANCE);
        if let Some(excess) = self.gain {
            let advice = if self.fixed {
                "use a smaller step or the adaptive method `radau`"
            } else {
                "use a tighter tolerance"
            };
            warnings.push(format!(
                "the energy has grown by {excess:.3e} J more than drives and loads have put in: the steps are too large for \
                 this method, and the motion is not to be trusted; {advice}"
            ));
        } else if let Some(imbalance) = imbalance {
            warnings.push(format!(
                "the energy balance is off by {:.0} % of the largest energy or work of the run: its steps miss what happens, \
                 and the motion is not to be trusted; use smaller steps or a tighter tolerance",
                100.0 * imbalance
            ));
        }
        if let Some((time, contact)) = &self.stepped_over {
            warnings.push(format!(
                "the contact `{contact}` may have passed through its obstacle in the step that ends at t = {time:.6} s: this \
                 method locates no events, and its steps are too large for an obstacle of this size; use smaller steps, or \
                 `radau`"
            ));
        }
        let coarse = self.passing.steps_a_period().filter(|steps| self.fixed && *steps < STEPS_A_PERIOD);
        if let Some(steps) = coarse {
            warnings.push(format!(
                "the motion is mostly a vibration of {steps:.1} steps a period, and its amplitude and phase need \
                 {STEPS_A_PERIOD} at least: use smaller steps or the adaptive method `radau`"
            ));
        }
        warnings
    }

    /// What was recorded.
    pub fn into_parts(self) -> (Trajectory, Option<Shapes>, Scene, Events) {
        (self.trajectory, self.shapes, self.scene, self.events)
    }
}

impl Observer for Recorder<'_> {
    fn wants_energy_balance(&self) -> bool {
        self.balance
    }

    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        self.events.begin(state);
        self.events.neglected = step.neglected;
        if let Some(violation) = &mut self.violation {
            violation.evaluate(system, state);
        }
        let largest = self.violation.as_ref().map(|violation| violation.largest);
        let contacts = !self.events.is_empty();
        if self.trajectory.is_empty() {
            self.passing.enter(system, state, &mut self.trajectory);
        }
        let passing = &mut self.passing;
        let mut taken = false;
        self.trajectory.push(state.t, |row| {
            let (own, common) = row.split_at_mut(system.channels().len());
            system.record(state, own);
            taken = passing.take(state.t, own);
            let total = match self.energies.as_slice() {
                [] => system.energy(state).total(),
                recorded => recorded.iter().map(|&i| own[i]).sum(),
            };
            let balance = step.balance.filter(|_| self.balance);
            let work = balance.map(|b| [b.drive, b.loads, b.dissipated]);
            let lost = balance.filter(|_| contacts).map(|b| b.contact);
            let steps = [step.size, f64::from(step.iterations)];
            let values = std::iter::once(total).chain(work.into_iter().flatten()).chain(lost);
            let values = values.chain(balance.map(|b| b.imbalance(total))).chain(steps);
            let values = values.chain(largest.into_iter().flatten());
            let square = |i: &usize| state.q[*i] * state.q[*i];
            let sum = self.modes.iter().map(square).sum::<f64>().max(f64::MIN_POSITIVE);
            let values = values.chain(self.modes.iter().map(|i| square(i) / sum));
            for (out, value) in common.iter_mut().zip(values) {
                *out = value;
            }
        });
        let rows = self.trajectory.len();
        self.trajectory.continue_quaternions(&self.quaternions, rows - 1..rows);
        if taken {
            self.passing.find_vertices(&mut self.trajectory);
        }
        if let Some(shapes) = &mut self.shapes {
            shapes.sample(system, state);
        }
        self.scene.sample(system, state);
    }

    fn event(&mut self, event: &Event) {
        self.passing.cut();
        if !self.events.is_empty() {
            self.events.add(event);
        }
    }

    fn gained_energy(&mut self, excess: f64) {
        self.gain = Some(excess);
    }

    fn stepped_over(&mut self, time: f64, row: usize) {
        if self.stepped_over.is_none() {
            self.stepped_over = Some((time, self.events.name_of_row(row).to_owned()));
        }
    }

    fn passing(&mut self, system: &mut dyn System, state: &State) {
        self.passing.enter(system, state, &mut self.trajectory);
        self.events.pass(system, state);
    }

    fn wants_within(&self) -> bool {
        self.events.touching()
    }

    fn within(&mut self, system: &mut dyn System, state: &State, weight: f64) {
        self.events.within(system, state, weight);
    }

    fn step(&mut self, state: &State) -> ControlFlow<()> {
        (self.watch)(state)
    }
}
