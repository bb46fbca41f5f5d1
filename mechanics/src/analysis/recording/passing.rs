//! What a run passes through between its records: extremes of the channels, and how fast it vibrates.

use super::trajectory::{COMPONENTS, Trajectory, continue_quaternions, vertex};
use crate::analysis::energy_balance::EnergyBalance;
use crate::integrator::Checkpoint;
use crate::system::{Channel, Kind, Side, State, System};
use std::f64::consts::TAU;

/// Part of a step below which rows in it are too near to each other for a parabola, and of that the part that is no time at all.
const NEAR: f64 = 1.0 / 32.0;
const SAME: f64 = 1e-3;
/// Part of the largest acceleration by which the accelerations between two rows may be off the line through both, and of the largest velocity
/// by which velocities may be off what that line makes of them; part of a radius by which an arc may be off its chord.
const OFF_LINE: f64 = 1e-3;
/// What is left at each row of the square of the largest acceleration before it: what a jump set vibrating fast is soon forgotten.
const REMEMBERED: f64 = 0.5;

/// What the last unit quaternions are called in a checkpoint.
const SIGNS: &str = "quaternions";

/// Unknowns that are looked at together.
const LANES: usize = 4;

/// The columns that are followed: the channels of a system, and behind them its energy and what it was done.
#[derive(Clone, Debug)]
pub(super) struct Followed {
    /// Number of channels of the system.
    pub own: usize,
    /// Those that are parts of the total energy.
    pub energies: Vec<usize>,
    /// Whether work and losses are recorded, and those of contacts too.
    pub balance: bool,
    pub contacts: bool,
}

impl Followed {
    /// How many they are.
    pub fn len(&self) -> usize {
        self.own + 1 + if self.balance { 3 + usize::from(self.contacts) } else { 0 }
    }

    /// Writes their values at a state.
    pub fn write(&self, system: &mut dyn System, state: &State, balance: &EnergyBalance, row: &mut [f64]) {
        let (own, rest) = row.split_at_mut(self.own);
        system.record(state, own);
        let total = match self.energies.as_slice() {
            [] => system.energy(state).total(),
            parts => parts.iter().map(|&i| own[i]).sum(),
        };
        let EnergyBalance { drive, loads, dissipated, contact, .. } = *balance;
        rest.iter_mut().zip([total, drive, loads, dissipated, contact]).for_each(|(y, x)| *y = x);
    }
}

/// Follows the accepted steps of a run, and its records.
pub(super) struct Passing {
    /// The columns of its rows.
    pub(super) followed: Followed,
    /// Shortest time between rows in the present step \[s\].
    apart: f64,
    /// The last four rows with their times, and how many of them belong to one smooth motion.
    rows: [(f64, Vec<f64>); 4],
    count: usize,
    /// Whether the last row is a record.
    recorded: bool,
    /// From where the motion is a line of accelerations, and the interval of the records \[s\].
    line: Line,
    ahead: f64,
    /// Least and largest value of each channel in the rows so far, and whether one may turn there before the next record.
    seen: Vec<[f64; 2]>,
    turns: bool,
    /// Whether something has happened at the last row or behind it: no curve goes on through that.
    cut: bool,
    /// Whether the last step's end was too near to the row before it to become one, or told nothing that the rows do not tell.
    skipped: bool,
    /// Channels that are never negative.
    pressing: Vec<usize>,
    /// First channels of unit quaternions.
    pub(super) quaternions: Vec<usize>,
    /// Whether velocities may jump in any step.
    pub(super) rough: bool,
    last: State,
    balance: EnergyBalance,
    /// Σ |Δv|² h² and Σ |Δq|² over the steps.
    sums: [f64; 2],
}

impl Passing {
    /// Follows the first columns of a run.
    pub(super) fn new(
        followed: Followed,
        channels: &[Channel],
        (scales, state): (&[f64], &State),
        ahead: f64,
    ) -> Passing {
        let width = followed.len();
        let row = || (state.t, vec![0.0; width]);
        let pressing = channels.iter().take(width).enumerate().filter(|(_, c)| c.kind == Kind::NonNegative);
        Passing {
            followed,
            apart: 0.0,
            rows: [row(), row(), row(), row()],
            count: 0,
            recorded: false,
            line: Line::new(scales, state),
            ahead,
            seen: vec![[f64::INFINITY, f64::NEG_INFINITY]; width],
            turns: true,
            cut: false,
            skipped: false,
            pressing: pressing.map(|(i, _)| i).collect(),
            quaternions: Vec::new(),
            rough: false,
            last: state.clone(),
            balance: EnergyBalance::default(),
            sums: [0.0; 2],
        }
    }

    /// What follows is in a step of this size \[s\].
    pub(super) fn begin(&mut self, step: f64) {
        self.apart = NEAR * step;
    }

    /// Takes the end of a step; it becomes a row where a channel may turn near its extremes. Where accelerations leave the [line](Line) through
    /// those of the last row, the end before it does, and this one if it is off the line from there. The states before and behind an event count,
    /// however near to a row.
    pub(super) fn enter(
        &mut self,
        system: &mut dyn System,
        (state, balance): (&State, &EnergyBalance),
        trajectory: &mut Trajectory,
    ) {
        let h = state.t - self.last.t;
        if h > 0.0 {
            self.begin(h);
        }
        let follows = self.catch_up(system, state, trajectory);
        self.measure(h, state);
        self.balance = *balance;
        self.offer(system, (state, balance, follows), trajectory);
    }

    /// Takes a state; `trajectory` learns the extremes, also those of the parabola through three of them.
    pub(super) fn show(
        &mut self,
        system: &mut dyn System,
        (state, balance): (&State, &EnergyBalance),
        trajectory: &mut Trajectory,
    ) {
        self.offer(system, (state, balance, false), trajectory);
    }

    /// Makes the end of the last step a row where the motion until `state` leaves the line; gives whether it needs no row here.
    pub(super) fn catch_up(
        &mut self,
        system: &mut dyn System,
        state: &State,
        trajectory: &mut Trajectory,
    ) -> bool {
        let mut follows = self.line.holds(system, state) && !self.rough;
        if self.skipped && (self.cut || !follows && !self.is_near(self.last.t)) {
            let before = std::mem::take(&mut self.last);
            self.evaluate(system, (&before, &self.balance.clone()), trajectory);
            if !self.cut {
                self.find_vertices(trajectory);
            }
            self.last = before;
            self.skipped = false;
            follows = self.line.holds(system, state) && !self.rough;
        }
        follows && !self.turns
    }

    /// Whether the last row is too near to `t` for another one.
    fn is_near(&self, t: f64) -> bool {
        self.count > 0 && t - self.rows[3].0 < self.apart
    }

    fn offer(
        &mut self,
        system: &mut dyn System,
        (state, balance, follows): (&State, &EnergyBalance, bool),
        trajectory: &mut Trajectory,
    ) {
        let behind = std::mem::take(&mut self.cut);
        if behind {
            (self.count, self.recorded) = (0, false);
        }
        self.skipped = false;
        let ends = state.side == Side::Left;
        let since = state.t - self.rows[3].0;
        let recorded = std::mem::take(&mut self.recorded);
        let same = recorded && since <= SAME * self.apart;
        if same && !(ends && since > 0.0) {
            // It was recorded, at this time but for rounding, and counts where an event follows.
            self.rows[3].0 = state.t;
            self.skipped = since > 0.0;
            return;
        }
        if since == 0.0 && self.count > 0 {
            self.count = 0;
        } else if (follows || self.is_near(state.t)) && !ends && !behind {
            self.skipped = true;
            return;
        }
        self.evaluate(system, (state, balance), trajectory);
        if !same {
            self.find_vertices(trajectory);
        }
    }

    /// Makes a state a row, whose values `trajectory` learns.
    fn evaluate(
        &mut self,
        system: &mut dyn System,
        (state, balance): (&State, &EnergyBalance),
        trajectory: &mut Trajectory,
    ) {
        self.add(state);
        self.followed.write(system, state, balance, &mut self.rows[3].1);
        let [.., (_, before), (_, now)] = &mut self.rows;
        continue_quaternions(&self.quaternions, before, now);
        for (i, y) in self.rows[3].1.iter().enumerate() {
            trajectory.pass(i, state.t, *y);
        }
        self.look_ahead();
    }

    /// Finds whether a channel may turn before the next record and become smaller or larger than it was: by the parabola through the last three rows,
    /// to half its slope.
    fn look_ahead(&mut self) {
        let [_, (t0, a), (t1, b), (t2, c)] = &self.rows;
        self.turns = self.count < 3;
        for (seen, ((a, b), c)) in self.seen.iter_mut().zip(a.iter().zip(b).zip(c)) {
            let [least, most] = seen;
            (*least, *most) = (least.min(*c), most.max(*c));
            let (first, second) = ((b - a) / (t1 - t0), (c - b) / (t2 - t1));
            let bend = (second - first) / (t2 - t0);
            let now = second + bend * (t2 - t1);
            let change = 2.0 * bend * self.ahead;
            let reach = (now.abs() + change.abs()) * self.ahead;
            let flattens = (now + change) * now < 0.5 * now * now;
            self.turns |= flattens && (c + reach > *most || c - reach < *least);
        }
    }

    /// An event has happened: the row of its time is the last of a smooth motion.
    pub(super) fn cut(&mut self) {
        self.cut = true;
    }

    /// Takes the row of a record, in which it chooses the signs of unit quaternions; [`Passing::find_vertices`] is to follow where it
    /// says so.
    pub(super) fn take(&mut self, state: &State, row: &mut [f64]) -> bool {
        continue_quaternions(&self.quaternions, &self.rows[3].1, row);
        if self.is_near(state.t) {
            return false;
        }
        self.add(state).copy_from_slice(row);
        self.look_ahead();
        self.recorded = true;
        true
    }

    /// Adds the unit quaternions of the last row to a checkpoint: those of a run that goes on keep their signs.
    pub(super) fn save(&self, out: &mut Checkpoint) {
        if !self.quaternions.is_empty() {
            let last = self.quaternions.iter().flat_map(|first| &self.rows[3].1[*first..first + COMPONENTS]);
            out.put(SIGNS, &last.copied().collect::<Vec<_>>());
        }
    }

    /// Takes up what [`Passing::save`] wrote, if as many are recorded.
    pub(super) fn resume(&mut self, from: &Checkpoint) {
        let Ok(last) = from.list(SIGNS) else { return };
        if last.len() == COMPONENTS * self.quaternions.len() {
            for (first, last) in self.quaternions.iter().zip(last.chunks_exact(COMPONENTS)) {
                self.rows[3].1[*first..first + COMPONENTS].copy_from_slice(last);
            }
        }
    }

    fn add(&mut self, state: &State) -> &mut [f64] {
        self.line.begin(state);
        self.rows.rotate_left(1);
        self.count += 1;
        self.rows[3].0 = state.t;
        &mut self.rows[3].1
    }

    /// `trajectory` learns the vertices of the parabolas through the last three rows, where these resolve the motion: the row before them
    /// tells how far the parabola may be off, and a vertex counts that rises by more than twice that. Forces that only press stay
    /// above zero, and components of unit quaternions within ±1.
    pub(super) fn find_vertices(&self, trajectory: &mut Trajectory) {
        if self.count <= 2 || self.rough {
            return;
        }
        let [(t, y), (t0, a), (t1, b), (t2, c)] = &self.rows;
        for (i, (y, ((a, b), c))) in y.iter().zip(a.iter().zip(b).zip(c)).enumerate() {
            let rows = [(*t0, *a), (*t1, *b), (*t2, *c)];
            let Some(vertex) = vertex(rows) else { continue };
            let [low, high] = [a.min(*b).min(*c), a.max(*b).max(*c)];
            let excess = (low - vertex.1).max(vertex.1 - high);
            // Without a row before them, what rows at equal distances allow at most.
            let before = (self.count > 3).then_some((*t, *y));
            let resolved = match before {
                Some(row) => 2.0 * error(rows, row, vertex.0) <= excess,
                None => 8.0 * excess <= high - low,
            };
            if resolved {
                let [least, most] = if self.pressing.contains(&i) {
                    [0.0, f64::INFINITY]
                } else if self.quaternions.iter().any(|first| (*first..first + 4).contains(&i)) {
                    [-1.0, 1.0]
                } else {
                    [f64::NEG_INFINITY, f64::INFINITY]
                };
                trajectory.pass(i, vertex.0, vertex.1.clamp(least, most));
            }
        }
    }

    /// Steps a period of what the motion is most like: 2π (Σ|Δq|² / Σ|Δv|²h²)^½. `None` without a motion.
    pub(super) fn steps_a_period(&self) -> Option<f64> {
        let [by_velocity, by_configuration] = self.sums;
        let ratio = by_configuration / by_velocity;
        (!self.rough && ratio.is_finite() && ratio > 0.0).then(|| TAU * ratio.sqrt())
    }

    fn measure(&mut self, h: f64, state: &State) {
        if h > 0.0 && state.q.len() == state.v.len() {
            self.sums[0] += h * h * distance_squared(&state.v, &self.last.v);
            self.sums[1] += distance_squared(&state.q, &self.last.q);
        }
        self.last.copy_from(state);
    }
}

/// The motion from the last row on, as long as it turns little and its accelerations are those of a line between its ends.
struct Line {
    t: f64,
    v: Vec<f64>,
    a: Vec<f64>,
    /// 1/w with the scales w.
    weights: Vec<f64>,
    /// Largest Σ (a/w)² of late, and largest |v/w| so far.
    largest: f64,
    fastest: f64,
}

impl Line {
    fn new(scales: &[f64], state: &State) -> Line {
        let weights = scales.iter().map(|scale| 1.0 / scale).collect();
        Line { t: state.t, v: state.v.clone(), a: state.a.clone(), weights, largest: 0.0, fastest: 0.0 }
    }

    fn begin(&mut self, state: &State) {
        self.t = state.t;
        self.v.copy_from_slice(&state.v);
        self.a.copy_from_slice(&state.a);
        self.largest = (REMEMBERED * self.largest).max(self.size(&state.a));
    }

    /// Whether the line holds until `state`. The trapezium between v₀ and v₁ leaves −h³ä/12 where the line is off by h²ä/8 in its
    /// middle; a chord is off an arc α of radius 1 by α²/8. What has no unknowns may move as it likes.
    fn holds(&mut self, system: &mut dyn System, state: &State) -> bool {
        let h = state.t - self.t;
        let mut rates = [0.0; LANES];
        scaled(&self.weights, &state.v, |k, rate| rates[k] = larger(rates[k], rate.abs()));
        let rate = rates.into_iter().fold(0.0, larger);
        self.fastest = self.fastest.max(rate);
        let arc = h * (rate + system.turning(state));
        if state.v.is_empty() || arc * arc > 8.0 * OFF_LINE {
            return false;
        }
        let off = 1.5 * self.defects(h, state).sqrt();
        // What is dear is computed where the rest does not tell.
        if !(off <= OFF_LINE * h * self.largest.sqrt()) {
            self.largest = self.largest.max(self.size(&state.a));
        }
        off <= OFF_LINE * h * self.largest.sqrt()
            && (off <= OFF_LINE * self.fastest
                || 1.5 * self.largest_defect(h, state) <= OFF_LINE * self.fastest)
    }

    /// Σ (a/w)²
    fn size(&self, a: &[f64]) -> f64 {
        let mut sums = [0.0; LANES];
        scaled(&self.weights, a, |k, a| sums[k] += a * a);
        sums.iter().sum()
    }

    /// Σ of the squares of what the line leaves of the velocities, over their scales.
    fn defects(&self, h: f64, state: &State) -> f64 {
        let all = [&self.v, &self.a, &state.v, &state.a, &self.weights].map(|x| x.as_chunks::<LANES>());
        let [(v0, rest0), (a0, rest1), (v, rest2), (a, rest3), (w, rest4)] = all;
        let mut sums = [0.0; LANES];
        for ((((v0, a0), v), a), w) in v0.iter().zip(a0).zip(v).zip(a).zip(w) {
            for k in 0..LANES {
                let left = defect(h, [v0[k], a0[k], v[k], a[k], w[k]]);
                sums[k] += left * left;
            }
        }
        for ((((v0, a0), v), a), w) in rest0.iter().zip(rest1).zip(rest2).zip(rest3).zip(rest4) {
            let left = defect(h, [*v0, *a0, *v, *a, *w]);
            sums[0] += left * left;
        }
        sums.iter().sum()
    }

    /// The largest of them.
    fn largest_defect(&self, h: f64, state: &State) -> f64 {
        let before = self.v.iter().zip(&self.a);
        let now = state.v.iter().zip(&state.a).zip(&self.weights);
        let each = before.zip(now).map(|((v0, a0), ((v, a), w))| defect(h, [*v0, *a0, *v, *a, *w]).abs());
        each.fold(0.0, larger)
    }
}

/// What a line of accelerations leaves of a velocity, (v − v₀ − ½h (a₀ + a))/w.
#[inline(always)]
fn defect(h: f64, [v0, a0, v, a, weight]: [f64; 5]) -> f64 {
    weight * (v - v0 - 0.5 * h * (a0 + a))
}

/// The larger of two numbers, of which a NaN is none.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Enters the products of weights and numbers, in lanes: each with its own chain of additions or comparisons.
#[inline(always)]
fn scaled(weights: &[f64], x: &[f64], mut enter: impl FnMut(usize, f64)) {
    let ((w, rest_w), (x, rest_x)) = (weights.as_chunks::<LANES>(), x.as_chunks::<LANES>());
    for (w, x) in w.iter().zip(x) {
        for k in 0..LANES {
            enter(k, w[k] * x[k]);
        }
    }
    for (k, (w, x)) in rest_w.iter().zip(rest_x).enumerate() {
        enter(k, w * x);
    }
}

/// Σ (aᵢ − bᵢ)²
fn distance_squared(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (a, b) in a.iter().zip(b) {
        for k in 0..LANES {
            sums[k] += (a[k] - b[k]) * (a[k] - b[k]);
        }
    }
    sums.iter().sum::<f64>() + rest_a.iter().zip(rest_b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>()
}

/// Error at `t` of the parabola through three points, by that of the cubic through another one: f[t₋₁, t₀, t₁, t₂] (t − t₀)(t − t₁)(t − t₂).
fn error(points: [(f64, f64); 3], (before, y): (f64, f64), t: f64) -> f64 {
    let [(t0, a), (t1, b), (t2, c)] = points;
    let (first, second) = ((b - a) / (t1 - t0), (c - b) / (t2 - t1));
    let bend = (second - first) / (t2 - t0);
    let parabola = a + (before - t0) * (first + bend * (before - t1));
    let product = |t: f64| (t - t0) * (t - t1) * (t - t2);
    ((y - parabola) / product(before) * product(t)).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Behind a restart at t = 0 the end of the first step lies beyond the crest of 3t − 10t², and a record before it.
    #[test]
    fn a_crest_within_the_first_step_is_found_by_the_records() {
        let mut trajectory = Trajectory::new(vec![super::super::trajectory::tests::channel("y", "m")]);
        let mut passing = Passing {
            followed: Followed { own: 1, energies: Vec::new(), balance: false, contacts: false },
            balance: EnergyBalance::default(),
            apart: 1e-6,
            rows: std::array::from_fn(|_| (0.0, vec![0.0])),
            count: 0,
            recorded: false,
            line: Line::new(&[], &State::default()),
            ahead: 0.1,
            seen: vec![[f64::INFINITY, f64::NEG_INFINITY]],
            turns: true,
            cut: false,
            skipped: false,
            pressing: Vec::new(),
            quaternions: Vec::new(),
            rough: false,
            last: State::default(),
            sums: [0.0; 2],
        };
        for t in [0.0, 0.1, 0.1 + 1e-8, 0.4] {
            let y = 3.0 * t - 10.0 * t * t;
            if passing.take(&State { t, ..State::default() }, &mut [y]) {
                passing.find_vertices(&mut trajectory);
            }
            if t == 0.0 || t == 0.4 {
                trajectory.push(t, |row| row[0] = y);
            }
        }
        let extremes = trajectory.extremes(0);
        assert!(
            (extremes.t_max - 0.15).abs() < 1e-12 && (extremes.max - 0.225).abs() < 1e-12,
            "{extremes:?}"
        );
    }

    #[test]
    fn the_vertex_of_a_parabola_is_found_and_that_of_a_line_is_not() {
        let at = |t: f64| (t, 3.0 - 2.0 * (t - 1.3) * (t - 1.3));
        let (t, y) = vertex([at(1.0), at(1.1), at(2.0)]).unwrap();
        assert!((t - 1.3).abs() < 1e-14 && (y - 3.0).abs() < 1e-14);
        assert_eq!(vertex([(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)]), None);
        assert_eq!(vertex([(0.0, 1.0), (1.0, 1.0), (2.0, 1.0)]), None);
        assert_eq!(vertex([(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)]), None);
    }
}
