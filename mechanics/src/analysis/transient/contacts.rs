//! Contacts of a run: impacts, and which contacts are closed.

use super::chatter::{Chatter, Together};
use super::ending::RunError;
use super::locate::{Locator, lowest};
use super::{Event, EventKind};
use crate::contact::{Bounds, Impact, ImpactMap, Neglected, TOUCHING};
use crate::system::{Mode, RowWeights, Set, State, System};

/// Writes the gaps, or what is asked of them, at a time within a step.
type Within<'a> = dyn FnMut(&mut dyn System, f64, &mut [f64]) + 'a;

/// Arc over which a gap falls and rises no more than once \[rad\]: steps between which contacts are looked for are not longer.
pub(super) const ARC: f64 = 0.5;
/// Closing speed, over the largest met in the run, below which an impact is taken without restitution: bounces that
/// accumulate end there, and the run goes past their limit.
const RESTING: f64 = 1e-5;
/// Events in a row with next to no time between them at which a run ends.
const MOST_EVENTS: usize = 1000;
/// Part of the closing speed above which a contact rebounds in a step of a nonsmooth method.
const REBOUND: f64 = 1e-6;
/// Parts of a step, each of half an [`ARC`], at whose ends the gap to a half-space is looked at, at most.
const MOST_PARTS: f64 = 64.0;
/// Part of an attempted step below which an event follows the one before at once.
const SHORT: f64 = 1e-6;

/// What a run needs for contacts and events.
pub(super) struct Contacts {
    pub(super) locator: Locator,
    map: ImpactMap,
    /// Largest speed so far with which the gap of any contact closed at an event, whether it touched or not [m/s].
    fastest: f64,
    /// Bounds of what bounces not followed would have done.
    pub(super) neglected: Neglected,
    rates: Vec<f64>,
    /// Events in a row with no time between them.
    events: usize,
    /// How fast events of different contacts follow each other, and the contacts of the last event.
    pub(super) chatter: Chatter,
    pub(super) last: Option<Together>,
    /// The same of the indicators of the model and of continuous forces.
    pub(super) touches: Chatter,
    pub(super) touched: Option<Together>,
    /// Whether the integrator resolves the contacts, so that only the model's own indicators are looked at.
    pub(super) resolved: bool,
}

impl Contacts {
    /// `None` for a system without contacts and indicators.
    pub(super) fn new(system: &mut dyn System, state: &State) -> Option<Contacts> {
        Some(Contacts {
            locator: Locator::new(system, state)?,
            map: ImpactMap::new(system),
            fastest: 0.0,
            neglected: Neglected::default(),
            rates: vec![0.0; state.lambda.len()],
            events: 0,
            chatter: Chatter::default(),
            last: None,
            touches: Chatter::default(),
            touched: None,
            resolved: false,
        })
    }

    /// For an integrator that resolves contacts: what is left is the model's own indicators, if it has any.
    pub(super) fn of_indicators(mut self) -> Option<Contacts> {
        self.resolved = true;
        self.locator.ignore_rows().then_some(self)
    }

    /// Sets the modes of the contacts at the start of a run.
    pub(super) fn settle(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), RunError> {
        if self.resolved {
            return Ok(());
        }
        let touching = 100.0 * TOUCHING * self.locator.length;
        let settled = self.map.settle(system, state, touching, &[]);
        settled.map_err(|cause| RunError::Contact { time: state.t, cause })
    }

    /// Whether more contacts were left closed than motions that they hold.
    pub(super) fn are_dependent(&self) -> bool {
        !self.resolved && self.map.are_dependent()
    }

    /// Gives a state that was settled last the forces of its closed contacts.
    pub(super) fn press(&mut self, state: &mut State) {
        self.map.press(state);
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
        let bounds = Bounds { touching, resting: RESTING * self.fastest, weak };
        let struck = self.map.strike(system, state, p, bounds);
        let impact = struck.map_err(|cause| RunError::Contact { time: state.t, cause })?;
        self.neglected.add(impact.neglected);
        if impact.impulses.iter().all(|x| *x == 0.0) {
            self.locator.open_released(state);
        }
        Ok(impact)
    }

    /// Whether a gap was closing at an event.
    pub(super) fn has_struck(&self) -> bool {
        self.fastest > 0.0
    }

    /// What later steps depend on, as numbers.
    pub(super) fn memory(&self) -> [f64; 17] {
        let Neglected { count, time, gap, energy } = self.neglected;
        let strongest = self.locator.strongest;
        let ([h, i, j, k, l], [m, n, o, p, q]) = (self.chatter.memory(), self.touches.memory());
        let own = [self.fastest, strongest, self.events as f64, count as f64, time, gap, energy];
        let [a, b, c, d, e, f, g] = own;
        [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q]
    }

    /// From the [memory](Contacts::memory) of a run.
    pub(super) fn recall(&mut self, memory: [f64; 17]) {
        let [fastest, strongest, events, count, time, gap, energy, h, i, j, k, l, touches @ ..] = memory;
        (self.chatter, self.touches) = (Chatter::recall([h, i, j, k, l]), Chatter::recall(touches));
        (self.fastest, self.locator.strongest, self.events) = (fastest, strongest, events as usize);
        self.neglected = Neglected { count: count as u64, time, gap, energy };
    }

    /// Remembers the contacts of an event: those that were open and strike, or whose modes have changed.
    pub(super) fn remember(&mut self, sets: &[Set], before: &State, after: &State, impact: &Impact) {
        let normals = || (0..sets.len()).filter(|i| matches!(sets[*i], Set::Unilateral { .. }));
        let strikes = |i: &usize| before.mode[*i] == Mode::Open && impact.impulses[*i] != 0.0;
        let changes = |i: &usize| before.mode[*i] != after.mode[*i];
        let rubs = |i: usize| match sets[i] {
            Set::Friction { normal, .. } => changes(&i).then_some(normal),
            _ => None,
        };
        self.last = Together::of(normals().filter(strikes))
            .or_else(|| Together::of(normals().filter(changes)))
            .or_else(|| Together::of((0..sets.len()).filter_map(rubs)));
    }

    /// Counts the events that follow each other with no time between them. Tells whether they are too many for this method, which a [burst](super::burst) ends.
    ///
    /// # Errors
    /// Of continuous forces, for which there is no other method.
    pub(super) fn count_event(&mut self, sets: &[Set], time: f64, part: f64) -> Result<bool, RunError> {
        self.events = if part < SHORT { self.events + 1 } else { 0 };
        let too_many = self.events > MOST_EVENTS;
        let rigid = sets.iter().any(|set| matches!(set, Set::Unilateral { .. }));
        if too_many && (self.resolved || !rigid) {
            return Err(RunError::Chatter { time, count: self.events });
        }
        if too_many {
            self.events = 0;
        }
        Ok(too_many)
    }
}

/// Energy \[J\] that contacts have taken in a step of a nonsmooth method, −½ hλ (ġ₀ + ġ₁) for a normal impulse and likewise
/// for friction: in a step without impact it is a part of the error of the step.
pub(super) fn loss(system: &mut dyn System, from: &State, to: &State, rates: &mut [f64]) -> f64 {
    let half = 0.5 * (to.t - from.t);
    let mut lost = 0.0;
    let of_contacts = |i: usize, sets: &[Set]| sets[i] != Set::Free && to.lambda[i] != 0.0;
    if !(0..rates.len()).any(|i| of_contacts(i, system.rows())) {
        return 0.0;
    }
    for s in [from, to] {
        system.constraint(s, RowWeights::VELOCITY, rates);
        for (i, rate) in rates.iter().enumerate().filter(|(i, _)| of_contacts(*i, system.rows())) {
            lost -= half * to.lambda[i] * rate;
        }
    }
    lost
}

/// What a step of a nonsmooth method did: an impact where contacts begin to press, and that contacts cease to. The
/// impulse is that of the step; effective masses are not known.
pub(super) fn struck(system: &mut dyn System, from: &State, to: &State, rates: &mut [f64]) -> Option<Event> {
    let contact = |i: usize, sets: &[Set]| match sets[i] {
        Set::Free => None,
        Set::Unilateral { .. } => Some(i),
        Set::Friction { normal, .. } => Some(normal),
    };
    let begins = |i: usize| to.lambda[i] > 0.0 && from.lambda[i].max(0.0) == 0.0;
    let m = rates.len();
    let sets = system.rows();
    let of_contacts = || (0..m).filter(|i| matches!(sets[*i], Set::Unilateral { .. }));
    let impact = of_contacts().any(begins);
    if !impact && !of_contacts().any(|i| from.lambda[i] > 0.0 && to.lambda[i].max(0.0) == 0.0) {
        return None;
    }
    let mut impulses = vec![0.0; m];
    let mut modes = to.mode.clone();
    for i in 0..m {
        let Some(normal) = contact(i, sets) else { continue };
        if begins(normal) {
            impulses[i] = (to.t - from.t) * to.lambda[i];
        }
        if normal == i {
            modes[i] = if to.lambda[i] > 0.0 { Mode::Closed } else { Mode::Open };
        }
    }
    if !impact {
        return Some(Event { time: to.t, kind: EventKind::Switch, modes });
    }
    let lost = loss(system, from, to, rates);
    system.constraint(to, RowWeights::VELOCITY, rates);
    let after = rates.to_vec();
    system.constraint(from, RowWeights::VELOCITY, rates);
    // A contact that has rebounded is open again.
    for (i, mode) in modes.iter_mut().enumerate() {
        let rebounded = |n: usize| impulses[n] > 0.0 && after[n] > REBOUND * rates[n].abs();
        if contact(i, system.rows()).is_some_and(rebounded) {
            *mode = Mode::Open;
        }
    }
    let (rates, masses) = (rates.to_vec(), vec![0.0; m]);
    Some(Event { time: to.t, kind: EventKind::Impact { impulses, lost, rates, masses }, modes })
}

/// Whether a contact is closed, or may close within two steps of size `h` with the present velocity and acceleration.
pub(super) fn approaches(system: &mut dyn System, s: &State, h: f64, gaps: &mut [f64]) -> bool {
    if gaps.is_empty() {
        return false;
    }
    system.constraint(s, RowWeights([1.0, 2.0 * h, 2.0 * h * h]), gaps);
    system.rows().iter().enumerate().any(|(i, set)| {
        let closes = s.mode[i] != Mode::Open || s.lambda[i] > 0.0 || gaps[i] <= 0.0;
        matches!(set, Set::Unilateral { .. }) && closes
    })
}

/// Looks for obstacles that a method without location of events has stepped over.
pub(super) struct Unseen {
    /// g and ġ of each row at the start and at the end of a step.
    values: [[Vec<f64>; 2]; 2],
    /// Rows whose gap has become negative in a step without force.
    entered: Vec<bool>,
    accelerations: Vec<f64>,
    /// Rows of contacts with half-spaces, through which no way leads: what dips into one and leaves it again without force within rounding of
    /// the method, at the ends of steps, has not passed through.
    flat: Vec<bool>,
    /// Gap that is rounding.
    rounding: f64,
}

impl Unseen {
    /// For systems with contacts.
    pub(super) fn new(system: &mut dyn System, state: &State) -> Option<Unseen> {
        let rows = system.rows().len();
        let zeros = || vec![0.0; rows];
        let contacts = system.rows().iter().any(|set| matches!(set, Set::Unilateral { .. }));
        if !contacts {
            return None;
        }
        let mut flat = vec![false; rows];
        let planes =
            system.contacts(state).into_iter().filter(|touch| touch.flat).filter_map(|touch| touch.row);
        planes.for_each(|row| flat[row] = true);
        Some(Unseen {
            flat,
            rounding: TOUCHING * system.length(),
            values: [(); 2].map(|()| [zeros(), zeros()]),
            entered: vec![false; rows],
            accelerations: zeros(),
        })
    }

    /// The row of a contact whose gap has fallen and risen in a step without force, and was negative between, as the gaps `within`
    /// the step say, or may have been, if its obstacle is no half-space: more sharply than the accelerations at both ends tell, or over an [`ARC`] on which its ends tell
    /// nothing. Also of one that was negative at the ends of steps before, all of them without force.
    pub(super) fn find(
        &mut self,
        system: &mut dyn System,
        (from, to): (&State, &State),
        within: &mut Within<'_>,
    ) -> Option<usize> {
        for (s, [gap, rate]) in [from, to].into_iter().zip(&mut self.values) {
            system.constraint(s, RowWeights::POSITION, gap);
            system.constraint(s, RowWeights::VELOCITY, rate);
        }
        let h = to.t - from.t;
        let arc = h * system.turning(from).min(system.turning(to));
        let at = |k: usize, i: usize| self.values[k].each_ref().map(|x| x[i]);
        for i in 0..self.accelerations.len() {
            let free = |s: &State| s.lambda[i].max(0.0) == 0.0;
            let ([g0, v0], [g1, v1]) = (at(0, i), at(1, i));
            let contact = matches!(system.rows()[i], Set::Unilateral { .. });
            let entered = self.entered[i] && free(to);
            self.entered[i] =
                contact && g1 < -self.rounding && (entered || free(from) && free(to) && g0 > 0.0);
            if entered && g1 > 0.0 && !self.flat[i] {
                return Some(i);
            }
            if !(contact && free(from) && free(to) && g0 > 0.0 && g1 > 0.0) {
                continue;
            }
            if arc > ARC && !self.flat[i] {
                return Some(i);
            }
            if arc > ARC {
                let parts = (2.0 * arc / ARC).ceil().min(MOST_PARTS);
                let mut dips = |k: usize| {
                    within(system, from.t + h * k as f64 / parts, &mut self.accelerations);
                    self.accelerations[i] < -self.rounding
                };
                if (1..parts as usize).any(&mut dips) {
                    return Some(i);
                }
                continue;
            }
            let Some(lows) = lowest((0.0, [g0, v0]), (h, [g1, v1])) else { continue };
            let negative = |low: f64| {
                within(system, from.t + low, &mut self.accelerations);
                self.accelerations[i] < -self.rounding
            };
            if lows.into_iter().any(negative) {
                return Some(i);
            }
            let [_, meet] = lows;
            let sharp = |s: &State, system: &mut dyn System, accelerations: &mut [f64]| {
                system.constraint(s, RowWeights::ACCELERATION, accelerations);
                h * accelerations[i] < 0.5 * (v1 - v0)
            };
            if !self.flat[i]
                && g0 + meet * v0 <= 0.0
                && sharp(from, system, &mut self.accelerations)
                && sharp(to, system, &mut self.accelerations)
            {
                return Some(i);
            }
        }
        None
    }
}
