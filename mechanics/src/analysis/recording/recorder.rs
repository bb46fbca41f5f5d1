//! An observer that records a run.

use super::Record;
use super::events::Events;
use super::passing::{Followed, Passing};
use super::trajectory::Trajectory;
use super::warning::Warning;
use crate::analysis::energy_balance::rounding_energy;
use crate::analysis::transient::{Burst, Ending, Event, EventKind, Observer, Plan, Step};
use crate::analysis::violation::Violation;
use crate::integrator::{Checkpoint, Counters, NotResumed};
use crate::system::{Channel, Direction, Role, Sink, State, System};
use std::ops::ControlFlow;

/// Relative imbalance of the energy that a run may show without a warning.
const IMBALANCE: f64 = 0.2;
/// The same of a run with impacts, behind the first.
const UNEXPLAINED: f64 = 0.01;
/// Fewest steps a period of a vibration whose amplitude and phase are followed.
const STEPS_A_PERIOD: f64 = 10.0;
/// What an impact adds of energy, over half of what its impulses do with the closing speeds, from which on it is told.
const GAINED: f64 = 1e-2;
/// and over the largest energy of the run, below which nobody asks for it.
const SMALL: f64 = 1e-6;

/// Called after every accepted step; `Break` stops the run.
pub type Watch<'a> = dyn FnMut(&State) -> ControlFlow<()> + 'a;

/// Called with every recorded state, e.g. to take pictures.
pub type Sampled<'a> = dyn FnMut(&mut dyn System, &State) + 'a;

/// What a [`Recorder`] records besides the channels of the system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Columns {
    /// Work, losses and the energy balance.
    pub energy_balance: bool,
    /// Shares of the unknowns across the beam, W_i = B_i²/ΣB².
    pub modal_shares: bool,
}

/// Bursts of one kind, all together.
#[derive(Clone, Copy, Debug, Default)]
struct Bursts {
    begin: f64,
    duration: f64,
    bursts: u64,
    step: f64,
    less: f64,
}

/// Records the channels of a system and what every run has: the total energy, the size of the step and
/// the iterations it took.
pub struct Recorder<'a> {
    trajectory: Trajectory,
    events: Events,
    common: Common,
    gain: Option<f64>,
    /// The first time at which a point may have stepped over an obstacle, and the name of its contact.
    stepped_over: Option<(f64, String)>,
    /// Bursts of contacts that chattered, and of those that rubbed.
    chatter: Option<Bursts>,
    rubbing: Option<Bursts>,
    /// When events of continuous forces began to follow each other fast, and the time between them.
    grinds: Option<(f64, f64)>,
    /// When an impact has added most energy, and that.
    impact_gain: Option<(f64, f64)>,
    /// Steps in which the forces of contacts did not settle, the largest residual, and when.
    unsettled: Option<(u64, f64, f64)>,
    passing: Passing,
    first_step: Option<f64>,
    /// Whether the steps are fixed.
    fixed: bool,
    watch: Option<&'a mut Watch<'a>>,
    sampled: Option<&'a mut Sampled<'a>>,
}

/// What every run has besides the channels of its system.
struct Common {
    /// Whether work and losses are recorded.
    balance: bool,
    contacts: bool,
    /// Of systems with rows of constraints.
    violation: Option<Violation>,
    /// Unknowns of the transverse modes whose shares are recorded.
    modes: Vec<usize>,
}

impl Common {
    /// Puts what belongs to a state with the energy `total` \[J\] into a sink.
    fn observe(&self, state: &State, step: &Step, total: f64, sink: &mut Sink<'_>) {
        let mut put = |value, role, name, unit: &'static str, meaning| {
            sink.put(value, || Channel::new(role, name, unit, meaning));
        };
        put(total, Role::Work, "energy.total", "J", "kinetic, strain, gravity and contact energy");
        if self.balance {
            let balance = step.balance.unwrap_or_default();
            let meaning = "work of what moves the hub since the start";
            put(balance.drive, Role::Work, "energy.drive", "J", meaning);
            let meaning = "work of the loads since the start, gravity aside";
            put(balance.loads, Role::Work, "energy.loads", "J", meaning);
            let meaning = "energy lost in dampers since the start";
            put(balance.dissipated, Role::Work, "energy.dissipated", "J", meaning);
            if self.contacts {
                let meaning = "energy lost in contacts since the start";
                put(balance.contact, Role::Work, "energy.contact_loss", "J", meaning);
            }
            let meaning = "error of the energy balance, E(t) − E(0) − work + losses: zero if exact";
            put(balance.imbalance(total), Role::Imbalance, "energy.balance", "J", meaning);
        }
        let of_steps = Role::Integration;
        put(step.size, of_steps, "step.size", "s", "size of the time step that covers this time");
        put(f64::from(step.iterations), of_steps, "step.iterations", "", "Newton iterations of that step");
        if let Some(Violation { largest: [position, velocity, acceleration], .. }) = self.violation {
            let meaning =
                "largest violation of constraints and closed contacts, and penetration of open ones";
            put(position, of_steps, "constraint.position", "m", meaning);
            let meaning = "largest velocity against constraints and closed contacts";
            put(velocity, of_steps, "constraint.velocity", "m/s", meaning);
            let meaning = "largest acceleration against constraints and closed contacts";
            put(acceleration, of_steps, "constraint.acceleration", "m/s^2", meaning);
        }
        let square = |i: &usize| state.q[*i] * state.q[*i];
        let sum = self.modes.iter().map(square).sum::<f64>().max(f64::MIN_POSITIVE);
        for (k, i) in self.modes.iter().enumerate() {
            sink.put(square(i) / sum, || {
                let (name, meaning) = (
                    format!("mode.{}.share", k + 1),
                    format!("share B²/ΣB² of the transverse mode {}", k + 1),
                );
                Channel::new(Role::Detail, name, "", meaning)
            });
        }
    }
}

impl<'a> Recorder<'a> {
    /// A recorder for runs of `system` from `state` by `plan`.
    pub fn new(system: &mut dyn System, state: &State, plan: &Plan, columns: Columns) -> Recorder<'a> {
        let Columns { energy_balance: balance, modal_shares: shares } = columns;
        let mut events = Events::new(system, state);
        events.apart = plan.sample;
        let mut channels = system.channels();
        let parts = channels.iter().enumerate().filter(|(_, c)| c.role == Role::Energy);
        let energies = parts.map(|(i, _)| i).collect();
        let across = |i: &usize| shares && system.direction(*i) == Direction::Chord;
        let common = Common {
            balance,
            contacts: !events.is_empty(),
            violation: (system.size().lambda > 0).then(|| Violation::new(system)),
            modes: (0..system.size().v).filter(across).collect(),
        };
        let followed = Followed { own: channels.len(), energies, balance, contacts: common.contacts };
        common.observe(state, &Step::default(), 0.0, &mut Sink::channels(&mut channels));
        let mut passing = Passing::new(followed, &channels, (system.scales(), state), plan.sample);
        let mut trajectory = Trajectory::new(channels);
        passing.quaternions = trajectory.quaternions();
        trajectory.reserve((plan.end / plan.sample).min(1e7) as usize + 2);
        Recorder {
            trajectory,
            events,
            common,
            gain: None,
            stepped_over: None,
            chatter: None,
            rubbing: None,
            grinds: None,
            impact_gain: None,
            unsettled: None,
            passing,
            first_step: None,
            fixed: plan.step.is_some(),
            watch: None,
            sampled: None,
        }
    }

    /// The columns that it records.
    pub fn channels(&self) -> &[Channel] {
        self.trajectory.channels()
    }

    /// The recorder, calling `watch` after every step.
    #[must_use]
    pub fn with_watch(self, watch: &'a mut Watch<'a>) -> Recorder<'a> {
        Recorder { watch: Some(watch), ..self }
    }

    /// The recorder, calling `sampled` with every recorded state.
    #[must_use]
    pub fn with_sampled(self, sampled: &'a mut Sampled<'a>) -> Recorder<'a> {
        Recorder { sampled: Some(sampled), ..self }
    }

    /// What makes the motion doubtful: the run has gained energy that nothing has put in, its energy balance does not close,
    /// a point may have stepped over an obstacle, or fixed steps do not resolve a vibration.
    fn warnings(&self, system: &mut dyn System, state: &State) -> Vec<Warning> {
        let known = rounding_energy(system, state).max(f64::EPSILON * self.trajectory.largest_energy());
        let gain = self.gain.filter(|excess| *excess > known).map(|excess| Warning::EnergyGained { excess });
        let doubtful = self.imbalance().or_else(|| self.unexplained());
        let doubtful = doubtful.filter(|(size, _)| *size > known).map(|(_, warning)| warning);
        let stepped_over = self.stepped_over.clone();
        let stepped_over = stepped_over.map(|(time, contact)| Warning::SteppedOver { time, contact });
        let coarse = self.passing.steps_a_period().filter(|steps| self.fixed && *steps < STEPS_A_PERIOD);
        let coarse = coarse.map(|steps| Warning::FewStepsAPeriod { steps, wanted: STEPS_A_PERIOD });
        let chatter = self.chatter.map(|Bursts { begin, duration, bursts, step, less }| Warning::Chatter {
            begin,
            duration,
            bursts,
            step,
            less,
        });
        let rubbing = self.rubbing.map(|Bursts { begin, duration, step, .. }| Warning::Rubbing {
            begin,
            duration,
            step,
        });
        let grinds = self.grinds.map(|(time, mean)| Warning::Grinds { time, mean });
        let unsettled =
            self.unsettled.map(|(steps, largest, time)| Warning::Unsettled { steps, largest, time });
        let told = |gain: &(f64, f64)| gain.1 > SMALL * self.trajectory.largest_energy();
        let gained =
            self.impact_gain.filter(told).map(|(time, energy)| Warning::ImpactGained { time, energy });
        let of_contacts = gained
            .into_iter()
            .chain(stepped_over)
            .chain(chatter)
            .chain(rubbing)
            .chain(grinds)
            .chain(unsettled);
        gain.or(doubtful).into_iter().chain(of_contacts).chain(coarse).collect()
    }

    /// An energy balance that does not close, with its largest value \[J\].
    fn imbalance(&self) -> Option<(f64, Warning)> {
        let balances = self.trajectory.with_role(Role::Imbalance);
        let largest = balances.map(|i| self.trajectory.extremes(i).largest()).fold(0.0, f64::max);
        let relative = self.trajectory.relative_imbalance().filter(|imbalance| *imbalance > IMBALANCE)?;
        Some((largest, Warning::EnergyImbalance { relative }))
    }

    /// Energy \[J\] that is lost or comes behind the first impact and that nothing explains: what is lost before it is the damping of the method.
    fn unexplained(&self) -> Option<(f64, Warning)> {
        let first = self.events.impacts().next()?.time;
        let balance = self.trajectory.with_role(Role::Imbalance).next()?;
        let rows = || self.trajectory.times().iter().zip(self.trajectory.values(balance));
        let before = rows().take_while(|(t, _)| **t <= first).last().map_or(0.0, |(_, y)| y);
        let behind = rows().filter(|(t, _)| **t > first).map(|(_, y)| y - before);
        let added = behind.fold(0.0_f64, |most, y| if y.abs() > most.abs() { y } else { most });
        let relative = added.abs() / self.trajectory.largest_energy();
        (relative > UNEXPLAINED).then_some((added.abs(), Warning::EnergyUnexplained { added, relative }))
    }

    /// The record of a run that has ended at `state`.
    pub fn into_record(
        self,
        system: &mut dyn System,
        state: State,
        counters: Counters,
        ending: Ending,
    ) -> Record {
        let warnings = self.warnings(system, &state);
        let Recorder { trajectory, mut events, first_step, .. } = self;
        events.end(trajectory.times().last().copied().unwrap_or_default());
        Record { trajectory, events, warnings, state, counters, first_step, ending }
    }
}

impl Observer for Recorder<'_> {
    fn wants_energy_balance(&self) -> bool {
        self.common.balance
    }

    /// No curve is drawn through the ends of steps in which velocities jump.
    fn begin(&mut self, jumps: bool) {
        self.passing.rough = jumps && !self.events.is_empty();
        self.events.by_step = jumps;
    }

    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        self.events.begin(state);
        self.events.neglected = step.neglected;
        if let Some(violation) = &mut self.common.violation {
            violation.evaluate(system, state);
        }
        let balance = step.balance.unwrap_or_default();
        if self.trajectory.is_empty() {
            self.passing.enter(system, (state, &balance), &mut self.trajectory);
        }
        self.passing.begin(step.size);
        self.passing.catch_up(system, state, &mut self.trajectory);
        let passing = &mut self.passing;
        let mut taken = false;
        self.trajectory.push(state.t, |row| {
            let (own, width) = (passing.followed.own, passing.followed.len());
            passing.followed.write(system, state, &balance, &mut row[..width]);
            taken = passing.take(state, &mut row[..width]);
            self.common.observe(state, step, row[own], &mut Sink::row(&mut row[own..]));
        });
        if taken {
            self.passing.find_vertices(&mut self.trajectory);
        }
        if let Some(sampled) = &mut self.sampled {
            sampled(system, state);
        }
    }

    fn event(&mut self, event: &Event) {
        self.passing.cut();
        if let EventKind::Impact { lost, impulses, rates, .. } = &event.kind {
            let exchanged: f64 = impulses.iter().zip(rates).map(|(p, rate)| 0.5 * (p * rate).abs()).sum();
            let gain = -lost - self.events.parted(impulses, rates);
            if gain > GAINED * exchanged && gain > self.impact_gain.map_or(0.0, |(_, gain)| gain) {
                self.impact_gain = Some((event.time, gain));
            }
        }
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

    fn burst(&mut self, burst: &Burst) {
        let kind = if burst.rubbing { &mut self.rubbing } else { &mut self.chatter };
        let all = kind.get_or_insert(Bursts { begin: burst.begin, ..Bursts::default() });
        all.duration += burst.end - burst.begin;
        all.bursts += 1;
        all.step = all.step.max(burst.step);
        all.less += burst.less;
    }

    fn grinds(&mut self, time: f64, mean: f64) {
        self.grinds.get_or_insert((time, mean));
    }

    fn unsettled(&mut self, time: f64, residual: f64) {
        let (steps, largest, at) = self.unsettled.get_or_insert_default();
        *steps += 1;
        if residual > *largest {
            (*largest, *at) = (residual, time);
        }
    }

    fn passing(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        self.first_step = self.first_step.or((step.size > 0.0).then_some(step.size));
        let balance = step.balance.unwrap_or_default();
        self.passing.enter(system, (state, &balance), &mut self.trajectory);
        self.events.pass(system, state);
    }

    fn between(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        self.passing.begin(step.size);
        let balance = step.balance.unwrap_or_default();
        self.passing.show(system, (state, &balance), &mut self.trajectory);
        self.events.look(system, state);
    }

    fn wants_within(&self) -> bool {
        self.events.touching()
    }

    fn within(&mut self, system: &mut dyn System, state: &State, weight: f64) {
        self.events.within(system, state, weight);
    }

    fn save(&self, out: &mut Checkpoint) {
        self.events.save(out);
        self.passing.save(out);
    }

    fn resume(&mut self, from: &Checkpoint) -> Result<(), NotResumed> {
        self.passing.resume(from);
        self.events.resume(from)
    }

    fn step(&mut self, state: &State) -> ControlFlow<()> {
        self.watch.as_mut().map_or(ControlFlow::Continue(()), |watch| watch(state))
    }
}
