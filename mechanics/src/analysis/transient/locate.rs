//! Events inside a step: found by their indicators, located by stepping again.
//!
//! An indicator φ is positive while nothing happens:
//!
//! | row | mode | φ |
//! |---|---|---|
//! | contact | open | gap g |
//! | contact | closed | force λ of the accelerations at q, v |
//! | friction | sticks | μ λₙ − ∣λ∣ of the same |
//! | friction | slips | ±ġ |
//! | of the model | | φ, with the sign it has at the start of the step |
//!
//! λ is not the multiplier of the method, which differs from that of the accelerations by the method's error (without
//! bound in steps that are next to nothing): what is closed behind an event is decided by the latter, and the same contact
//! would close and open in turn, for no time. With an implicit method accelerations and multipliers of accepted steps are these too. Where unknowns
//! have no mass, the multipliers of the method are taken.
//!
//! A gap that is positive at both ends of a step may have been negative inside: where it first falls and then rises, its
//! least value is sought by steps to times inside, ġ there saying on which side of them it is, until a bound from below is
//! positive ([`lowest`]): however thin an obstacle is against the way of a step, it is found. The time of an event is refined
//! by steps from the same state until φ vanishes to rounding.

use super::ending::{RunError, failed};
use crate::contact::TOUCHING;
use crate::integrator::{Accelerations, Counters, Integration, Span};
use crate::system::{Mode, RowWeights, Set, Side, State, System, is_active};

/// Size of a force or sliding velocity that counts as zero, over the largest in the step.
const VANISHING: f64 = 1e-12;
/// Least scale of an indicator: a number that is zero to rounding whatever its unit.
const SMALLEST: f64 = 1e-30;
/// Part of a step below which an event happens at its start.
const SHORTEST: f64 = 1e-9;
/// Least scaled indicator of a contact that has just opened and separates: above 1, which is rounding.
const SEPARATING: f64 = 2.0;
/// Attempts to find the least value of a gap inside a step.
const DIVISIONS: usize = 60;
/// Part of the change of h ġ by which a gap may fall below its tangents: its point does not move along a straight line.
const BENDING: f64 = 0.1;
/// Attempts to refine the time of an event.
const ATTEMPTS: usize = 200;
/// Part of an attempted step within which indicators of the model that vanish one after the other do so in one event: a force that begins late
/// by τ gives an impulse that is off by ½ F′ ġ τ², which is 1e-10 of what a step resolves.
const TOGETHER: f64 = 1e-5;

/// Indicators of a system, with their values at both ends of a step.
#[derive(Debug)]
pub(super) struct Locator {
    sets: Vec<Set>,
    /// Number of the model's own indicators.
    own: usize,
    /// Length of the system \[m\].
    pub(super) length: f64,
    /// Largest multiplier of the run so far.
    pub(super) strongest: f64,
    start: Values,
    end: Values,
    /// At the end of the part of the step in which dips are sought.
    far: Values,
    signs: Vec<f64>,
    /// Gaps of continuous forces among the model's own indicators, and those of them that neither open nor close at the start of the step, within rounding: what
    /// rounding makes of them is no touch.
    is_gap: Vec<bool>,
    rests: Vec<bool>,
    /// Open contacts that touch and do not approach at the start of the step: open as they are, they separate.
    leaving: Vec<bool>,
    /// Time and side of the end of the attempted step.
    whole: (f64, Side),
    trial: State,
    forces: Forces,
}

/// Multipliers of the accelerations.
#[derive(Debug)]
struct Forces {
    accelerations: Accelerations,
    state: State,
    /// Whether `state` is the last one that was asked for.
    known: bool,
    counters: Counters,
}

impl Forces {
    /// The multipliers at `s`: the method's own if no contact is closed or an unknown has no mass.
    fn at<'a>(&'a mut self, system: &mut dyn System, s: &'a State, sets: &[Set]) -> &'a [f64] {
        let closed = |(set, mode): (&Set, &Mode)| *set != Set::Free && is_active(*set, *mode);
        self.known = sets.iter().zip(&s.mode).any(closed) && !self.accelerations.is_massless();
        if self.known {
            self.state.copy_from(s);
            let done = self.accelerations.complete(system, &mut self.state, (s.t, 0.0), &mut self.counters);
            self.known = done.is_ok() && !self.accelerations.is_massless();
        }
        if self.known { &self.state.lambda } else { &s.lambda }
    }
}

/// g, ġ and behind them the rates of the model's own indicators, indicators, and the scale of each indicator.
#[derive(Clone, Debug, Default)]
struct Values {
    gap: Vec<f64>,
    rate: Vec<f64>,
    indicator: Vec<f64>,
    zero: Vec<f64>,
}

impl Values {
    fn new(rows: usize, own: usize) -> Values {
        let zeros = |n| vec![0.0; n];
        Values {
            gap: zeros(rows),
            rate: zeros(rows + own),
            indicator: zeros(rows + own),
            zero: zeros(rows + own),
        }
    }

    fn evaluate(
        &mut self,
        system: &mut dyn System,
        s: &State,
        forces: &mut Forces,
        sets: &[Set],
        (length, strongest): (f64, &mut f64),
    ) {
        let m = sets.len();
        let lambda = forces.at(system, s, sets);
        *strongest = lambda.iter().fold(*strongest, |most, x| most.max(x.abs()));
        system.constraint(s, RowWeights::POSITION, &mut self.gap);
        system.constraint(s, RowWeights::VELOCITY, &mut self.rate[..m]);
        let rates = self.rate[..m].iter().zip(sets).filter(|(_, set)| **set != Set::Free);
        let fastest = rates.fold(system.fastest(&s.v), |most, (rate, _)| most.max(rate.abs()));
        let (force, rate) = (VANISHING * *strongest, VANISHING * fastest);
        for (i, set) in sets.iter().enumerate() {
            let (value, zero) = match (*set, s.mode[i]) {
                (Set::Free, _) => (f64::INFINITY, 0.0),
                (Set::Unilateral { .. }, Mode::Open) => (self.gap[i], TOUCHING * length),
                (Set::Unilateral { .. }, _) => (lambda[i], force),
                (Set::Friction { .. }, Mode::Open) => (f64::INFINITY, 0.0),
                (Set::Friction { coefficient, normal }, Mode::Closed) => {
                    (coefficient * lambda[normal] - lambda[i].abs(), force)
                }
                (Set::Friction { .. }, Mode::SlipForward) => (self.rate[i], rate),
                (Set::Friction { .. }, Mode::SlipBackward) => (-self.rate[i], rate),
            };
            (self.indicator[i], self.zero[i]) = (value, zero);
        }
        system.indicate(s, &mut self.indicator[m..]);
        system.indicator_rates(s, &mut self.rate[m..]);
    }
}

impl Locator {
    /// `None` for a system without contacts and indicators.
    pub(super) fn new(system: &mut dyn System, state: &State) -> Option<Locator> {
        let sets = system.rows().to_vec();
        let own = system.indicators();
        if own == 0 && sets.iter().all(|set| *set == Set::Free) {
            return None;
        }
        let length = system.length();
        let values = || Values::new(sets.len(), own);
        let (start, end, far, signs) = (values(), values(), values(), vec![1.0; own]);
        let leaving = vec![false; sets.len()];
        let mut is_gap = vec![false; own];
        system.contacts(state).iter().filter_map(|contact| contact.indicator).for_each(|k| is_gap[k] = true);
        Some(Locator {
            leaving,
            rests: vec![false; own],
            is_gap,
            whole: (state.t, Side::Right),
            own,
            length,
            strongest: 0.0,
            start,
            end,
            far,
            signs,
            trial: state.clone(),
            forces: Forces {
                accelerations: Accelerations::new(system, state, RowWeights::ACCELERATION),
                state: state.clone(),
                known: false,
                counters: Counters::default(),
            },
            sets,
        })
    }

    /// Leaves the rows out of account; whether there is something else to locate.
    pub(super) fn ignore_rows(&mut self) -> bool {
        self.sets.fill(Set::Free);
        self.own > 0
    }

    /// Looks for events in the step of size `h` from `from` to `to`, which was attempted. Where there is one, `to` becomes
    /// the state at the first of them; gives the size of that step, and whether an event is at its end.
    pub(super) fn locate(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        from: &State,
        h: f64,
        to: &mut State,
    ) -> Result<(f64, bool), RunError> {
        self.begin(system, from);
        self.whole = (to.t, to.side);
        let implicit = integrator.info().implicit;
        let mut value = self.value(system, to);
        self.complete(to, implicit);
        let (mut low, mut high) = (0.0, h);
        if value > 0.0 {
            let Some(dip) = self.dip(system, integrator, from, h, to)? else { return Ok((h, false)) };
            (high, value) = dip;
        }
        // A time at which nothing has happened yet.
        let mut below = self.least(&self.start);
        let start_is_clear = below > SEPARATING;
        if !start_is_clear {
            let mut size = high;
            loop {
                size *= 0.5;
                self.retry(system, integrator, from, size)?;
                let found = self.trial_value(system);
                if found > 1.0 {
                    (low, below) = (size, found);
                    break;
                }
                if found > 0.0 || size < SHORTEST * h {
                    // It happens at once.
                    if found <= 0.0 && !self.forces.accelerations.is_massless() {
                        self.extrapolate(system, from, size);
                    }
                    to.copy_from(&self.trial);
                    self.complete(to, implicit);
                    return Ok((size, true));
                }
                (high, value) = (size, found);
            }
        }
        // Illinois' variant of the false position.
        let (mut weight_low, mut weight_high) = (below, value);
        let mut last = 0;
        let mut size = high;
        for _ in 0..ATTEMPTS {
            let secant = low + (high - low) * weight_low / (weight_low - weight_high);
            size = if secant > low && secant < high { secant } else { 0.5 * (low + high) };
            if size <= low || size >= high {
                size = high;
            }
            self.retry(system, integrator, from, size)?;
            let found = self.trial_value(system);
            if self.vanishes() || size == high || (high - low) <= 2.0 * f64::EPSILON * (from.t.abs() + high) {
                break;
            }
            if found > 0.0 {
                (low, weight_low) = (size, found);
                if last == 1 {
                    weight_high *= 0.5;
                }
                last = 1;
            } else {
                (high, weight_high) = (size, found);
                if last == -1 {
                    weight_low *= 0.5;
                }
                last = -1;
            }
        }
        if !self.vanishes() && self.least(&self.end) > 0.0 {
            size = high;
            self.retry(system, integrator, from, size)?;
            self.trial_value(system);
        }
        to.copy_from(&self.trial);
        if let Some(later) = self.together(size, h) {
            self.retry(system, integrator, from, later)?;
            self.trial_value(system);
            if self.least_row(&self.end) > 0.0 {
                to.copy_from(&self.trial);
                size = later;
            } else {
                self.trial.copy_from(to);
                self.trial_value(system);
            }
        }
        self.complete(to, implicit);
        Ok((size, true))
    }

    /// The size of the step, `size` or little more, within which all indicators of the model have vanished that do so next to at once, if there is one that
    /// has not.
    fn together(&self, size: f64, h: f64) -> Option<f64> {
        let m = self.sets.len();
        let mut later: Option<f64> = None;
        for k in 0..self.own {
            let (left, rate) =
                (self.own_value(self.end.indicator[m + k], k), self.signs[k] * self.end.rate[m + k]);
            let time = -left / rate;
            if left > 0.0 && rate < 0.0 && time <= TOGETHER * h {
                later = Some(later.unwrap_or(0.0).max(time));
            }
        }
        later.map(|time| size + 1.1 * time).filter(|later| *later < h)
    }

    /// Gives `to`, whose indicators were evaluated last, accelerations and multipliers that are consistent with its position and velocity, where
    /// contacts are closed. Those of an implicit method are what its formulas ask for to end on the constraints: with what rounding, and steps before,
    /// leave of ġ in the start of a step h they are off by ġ/h. Explicit methods have their own, which draw g to zero. Closed contacts that
    /// are pulled, by an error, have the force of the consistent ones.
    fn complete(&self, to: &mut State, implicit: bool) {
        if self.forces.known && implicit {
            to.a.copy_from_slice(&self.forces.state.a);
            to.lambda.copy_from_slice(&self.forces.state.lambda);
        }
        for (i, set) in self.sets.iter().enumerate() {
            let closed = matches!(set, Set::Unilateral { .. }) && to.mode[i] != Mode::Open;
            if closed && to.lambda[i] < 0.0 {
                to.lambda[i] = self.end.indicator[i].max(0.0);
            }
        }
    }

    /// Numbers of the model's indicators that are not positive at the end of the step located last.
    pub(super) fn fired(&mut self) -> Vec<usize> {
        let m = self.sets.len();
        let fired: Vec<usize> =
            (0..self.own).filter(|k| self.own_value(self.end.indicator[m + k], *k) <= 0.0).collect();
        // An indicator that is zero now counts for the other side.
        fired.iter().for_each(|k| self.signs[*k] = -self.signs[*k]);
        fired
    }

    /// Opens the contacts in `state` whose force has fallen to zero at the end of the step located last: what rounding
    /// leaves of it must not close them again.
    pub(super) fn open_released(&self, state: &mut State) {
        for (i, set) in self.sets.iter().enumerate() {
            let normal = if let Set::Friction { normal, .. } = *set { normal } else { i };
            let contact = matches!(self.sets[normal], Set::Unilateral { .. });
            let closed = contact && self.trial.mode[normal] != Mode::Open;
            if closed && self.end.indicator[normal] <= self.end.zero[normal] {
                state.mode[i] = Mode::Open;
            }
        }
    }

    fn begin(&mut self, system: &mut dyn System, from: &State) {
        self.start.evaluate(system, from, &mut self.forces, &self.sets, (self.length, &mut self.strongest));
        let m = self.sets.len();
        for (sign, x) in self.signs.iter_mut().zip(&self.start.indicator[m..]) {
            if *x != 0.0 {
                *sign = x.signum();
            }
        }
        let still =
            VANISHING * self.start.rate[..m].iter().chain(&from.v).fold(0.0_f64, |m, x| m.max(x.abs()));
        for k in 0..self.own {
            let (gap, rate) = (self.start.indicator[m + k], self.start.rate[m + k]);
            self.rests[k] = self.is_gap[k] && gap.abs() < TOUCHING * self.length && rate.abs() <= still;
            if self.rests[k] {
                self.signs[k] = 1.0;
            }
        }
        for i in 0..m {
            let touches =
                self.start.indicator[i] == self.start.gap[i] && self.start.gap[i] <= self.start.zero[i];
            self.leaving[i] = touches && self.start.rate[i] >= -still;
        }
    }

    /// The least indicator at `s`, scaled.
    fn value(&mut self, system: &mut dyn System, s: &State) -> f64 {
        self.end.evaluate(system, s, &mut self.forces, &self.sets, (self.length, &mut self.strongest));
        self.least(&self.end)
    }

    fn trial_value(&mut self, system: &mut dyn System) -> f64 {
        self.end.evaluate(
            system,
            &self.trial,
            &mut self.forces,
            &self.sets,
            (self.length, &mut self.strongest),
        );
        self.least(&self.end)
    }

    fn least(&self, values: &Values) -> f64 {
        let m = self.sets.len();
        let own = (0..self.own).map(|k| self.own_value(values.indicator[m + k], k) / SMALLEST);
        own.fold(self.least_row(values), f64::min)
    }

    /// The model's indicator `k`, positive while nothing happens.
    fn own_value(&self, x: f64, k: usize) -> f64 {
        if self.rests[k] { x + TOUCHING * self.length } else { self.signs[k] * x }
    }

    /// The least indicator of a row, scaled.
    fn least_row(&self, values: &Values) -> f64 {
        let rows = (0..self.sets.len()).map(|i| {
            let (x, zero) = (values.indicator[i], values.zero[i]);
            let scaled = if x.is_finite() { x / zero.max(SMALLEST) } else { f64::MAX };
            let leaves = self.leaving[i] && (values.rate[i] > 0.0 || scaled > -1.0);
            if leaves { scaled.max(SEPARATING) } else { scaled }
        });
        rows.fold(f64::MAX, f64::min)
    }

    /// Whether the least indicator at the trial is zero to rounding.
    fn vanishes(&self) -> bool {
        self.least(&self.end).abs() <= 1.0
    }

    /// One step of size `size`.
    fn retry(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        from: &State,
        size: f64,
    ) -> Result<(), RunError> {
        let (end, side) = self.whole;
        let span =
            if from.t + size >= end { Span { step: size, end, side } } else { Span::new(from.t, size) };
        integrator.discard();
        let done = integrator.step(system, from, span, &mut self.trial);
        done.map(|_| ()).map_err(|error| failed(system, from, error))
    }

    /// The state a time `size` that is next to nothing later: a step would divide the rounding error of a constraint by it.
    fn extrapolate(&mut self, system: &mut dyn System, from: &State, size: f64) {
        let trial = &mut self.trial;
        trial.copy_from(from);
        trial.t = from.t + size;
        trial.v.iter_mut().for_each(|v| *v *= size);
        system.retract(&from.q, &trial.v, &mut trial.q);
        for ((v, old), a) in trial.v.iter_mut().zip(&from.v).zip(&from.a) {
            *v = old + size * a;
        }
        self.trial_value(system);
    }

    /// The gap of an open contact, or an indicator of the model with the sign that it has at the start, and its rate.
    fn distance(&self, values: &Values, i: usize) -> Option<[f64; 2]> {
        match self.sets.get(i) {
            None => {
                let sign = self.signs[i - self.sets.len()];
                Some([sign * values.indicator[i], sign * values.rate[i]])
            }
            Some(Set::Unilateral { .. }) if self.start.indicator[i] == self.start.gap[i] => {
                Some([values.gap[i], values.rate[i]])
            }
            Some(_) => None,
        }
    }

    /// A time inside a step of size `h`, at whose end nothing has happened, at which something has, with the least indicator
    /// there. Where there is none, `to` is the state at the end of the step.
    fn dip(
        &mut self,
        system: &mut dyn System,
        integrator: &mut Integration,
        from: &State,
        h: f64,
        to: &mut State,
    ) -> Result<Option<(f64, f64)>, RunError> {
        let (mut high, mut found, mut tried) = (h, None, false);
        std::mem::swap(&mut self.far, &mut self.end);
        for i in 0..self.sets.len() + self.own {
            let (Some(start), Some(end)) = (self.distance(&self.start, i), self.distance(&self.far, i))
            else {
                continue;
            };
            let (mut low, mut up) = ((0.0, start), (high, end));
            for k in 0..DIVISIONS {
                let Some([cubic, tangents]) = lowest(low, up) else { break };
                let size = if k % 2 == 0 { cubic } else { tangents };
                self.retry(system, integrator, from, size)?;
                tried = true;
                let value = self.trial_value(system);
                if value <= 0.0 {
                    (high, found) = (size, Some((size, value)));
                    std::mem::swap(&mut self.far, &mut self.end);
                    break;
                }
                let Some(inside) = self.distance(&self.end, i) else { break };
                if inside[1] < 0.0 {
                    low = (size, inside)
                } else {
                    up = (size, inside)
                }
                if up.0 - low.0 < SHORTEST * h {
                    break;
                }
            }
        }
        if tried && found.is_none() {
            // The step as it was.
            let span = Span { step: h, end: self.whole.0, side: self.whole.1 };
            integrator.discard();
            integrator.step(system, from, span, to).map_err(|error| failed(system, from, error))?;
            self.value(system, to);
            self.complete(to, integrator.info().implicit);
        }
        Ok(found)
    }
}

/// Where a gap may be least between two times, if it falls at the first, rises at the second and may be negative between
/// them: the least value of the cubic through g and ġ of both, and the time at which the two tangents meet. A gap over a
/// convex obstacle lies over its tangents while its point moves along a straight line, however sharp the dip is.
pub(super) fn lowest((t0, [g0, v0]): (f64, [f64; 2]), (t1, [g1, v1]): (f64, [f64; 2])) -> Option<[f64; 2]> {
    let h = t1 - t0;
    let (v0, v1) = (h * v0, h * v1);
    if !(v0 < 0.0 && v1 > 0.0) {
        return None;
    }
    // g(s) = g0 + v0 s + c s² + d s³, g′ = 0
    let (c, d) = (3.0 * (g1 - g0) - 2.0 * v0 - v1, 2.0 * (g0 - g1) + v0 + v1);
    let root = (c * c - 3.0 * d * v0).max(0.0).sqrt();
    let smooth = (-v0 / (c + root)).clamp(0.02, 0.98);
    let sharp = ((g0 - g1 + v1) / (v1 - v0)).clamp(0.02, 0.98);
    let cubic = g0 + smooth * (v0 + smooth * (c + smooth * d));
    let tangents = (g0 + sharp * v0).max(g1 - (1.0 - sharp) * v1);
    (cubic.min(tangents) < BENDING * (v1 - v0)).then_some([t0 + h * smooth, t0 + h * sharp])
}
