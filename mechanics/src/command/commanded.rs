//! A model with laws of one's own. Its formulas head the [module](super).

use super::acting::Acting;
use super::input::{CommandFault, Input, LawState};
use super::seen::Seen;
use crate::linalg::{Matrix, Structure};
use crate::system::{
    Break, Channel, ContactInfo, ContactSample, Corotation, Crossing, Direction, Dynamics, Energy, Events,
    Frame, Jump, Limit, Mode, NotSet, Observed, Parameter, Power, Role, RowWeights, Set, Sink, Size, Slender,
    State, Steady, StiffnessForm, System, VisitRow, Weights, ordered,
};
use std::collections::HashSet;

/// Part of the scale of a quantity by which it is moved for differences.
const STEP: f64 = 1e-6;
/// Change of a quantity over its size by which it depends on accelerations or forces.
const DEPENDS: f64 = 1e-9;

/// A model with laws.
pub struct Commanded {
    inner: Box<dyn System>,
    laws: Vec<Acting>,
    /// What the model sees of a state.
    seen: Seen,
    /// Sizes of the velocities' unknowns, those of the states behind them.
    scales: Vec<f64>,
    breaks: Vec<Break>,
    /// The quantities that some law reads: numbers of columns, and their scales.
    read: Vec<(usize, f64)>,
    /// Recorded quantities of the model.
    row: Vec<f64>,
    /// Whether a run has begun.
    began: bool,
    /// Why it cannot go on.
    fault: Option<Limit>,
}

/// The column in which a law, or a state of it, is recorded.
fn column(law: &str, state: Option<&LawState>) -> String {
    state.map_or_else(|| format!("law.{law}"), |state| format!("law.{law}.{}", state.name))
}

/// Whether each column of the laws has a name of its own.
fn distinct(channels: &[Channel], inputs: &[Input]) -> Result<(), CommandFault> {
    let mut taken: HashSet<String> = channels.iter().map(|channel| channel.name.clone()).collect();
    for input in inputs {
        let own = std::iter::once(None).chain(input.states.iter().map(Some));
        for column in own.map(|state| column(&input.name, state)) {
            if let Some(column) = taken.replace(column) {
                return Err(CommandFault::Twice { input: input.name.clone(), column });
            }
        }
    }
    Ok(())
}

impl Commanded {
    /// A model with laws, for a run until `end` \[s\].
    ///
    /// # Errors
    /// [`CommandFault`]: what a law reads is not there or no function of the motion, or its times are none.
    pub fn new(mut inner: Box<dyn System>, inputs: Vec<Input>, end: f64) -> Result<Commanded, CommandFault> {
        let mut breaks = inner.breaks().to_vec();
        for input in &inputs {
            let times = input.times(end)?;
            breaks.extend(times.into_iter().map(|time| Break { time, jump: Jump::Acceleration }));
            input.check_states()?;
        }
        let channels = inner.channels();
        distinct(&channels, &inputs)?;
        let reactions = reactions(inner.as_mut(), &inputs, channels.len());
        let length = inner.length();
        let mut read: Vec<(usize, f64)> = Vec::new();
        let mut laws: Vec<Acting> = Vec::new();
        let mut scales = inner.scales().to_vec();
        for input in inputs {
            let mut own = Vec::new();
            for column in &input.reads {
                let Some(i) = channels.iter().position(|channel| channel.name == *column) else {
                    let columns = channels.into_iter().map(|channel| channel.name).collect();
                    return Err(CommandFault::NoColumn {
                        input: input.name,
                        column: column.clone(),
                        columns,
                    });
                };
                if reactions[i] {
                    return Err(CommandFault::Reaction { input: input.name, column: column.clone() });
                }
                let scale = if channels[i].unit.starts_with('m') { length } else { 1.0 };
                own.push(read.iter().position(|(of, _)| *of == i).unwrap_or(read.len()));
                if own.last() == Some(&read.len()) {
                    read.push((i, scale));
                }
            }
            let first = laws.last().map_or(0, |law| law.states().end);
            scales.extend(input.states.iter().map(|state| state.size));
            laws.push(Acting::new(input, own, first));
        }
        let row = vec![0.0; channels.len()];
        let seen = Seen::new(inner.size(), laws.last().map_or(0, |law| law.states().end));
        let breaks = ordered(breaks);
        Ok(Commanded { inner, laws, seen, scales, breaks, read, row, began: false, fault: None })
    }

    fn feeds_back(&self) -> bool {
        self.laws.iter().any(Acting::feeds_back)
    }

    /// The quantities that are read, at a state.
    fn quantities(&mut self, s: &State) -> Vec<f64> {
        if self.read.is_empty() {
            return Vec::new();
        }
        self.inner.record(self.seen.of(s), &mut self.row);
        self.read.iter().map(|(i, _)| self.row[*i]).collect()
    }

    /// The states of the laws, with their numbers.
    fn states(&self) -> impl Iterator<Item = (usize, &LawState)> {
        self.laws.iter().flat_map(|law| law.states().zip(&law.input.states))
    }

    /// Asks the laws that are asked at any time. Returns the rates of their states.
    fn command(&mut self, s: &State) -> Vec<f64> {
        let mut rates = vec![0.0; self.seen.states];
        if !self.began || !self.laws.iter().any(Acting::is_continuous) {
            return rates;
        }
        let t = s.time();
        let y = if self.feeds_back() { self.quantities(s) } else { Vec::new() };
        let x = self.seen.laws(s);
        for law in self.laws.iter_mut().filter(|law| law.is_continuous()) {
            let own = law.own_of(&y, x);
            // A state that is no number is an attempt that has failed already.
            let given = match &self.fault {
                None if own.iter().all(|y| y.is_finite()) => law.value(t, &own),
                _ => Ok(law.nothing()),
            };
            let given = given.unwrap_or_else(|fault| {
                self.fault = Some(fault);
                law.nothing()
            });
            law.input.signal.set(given[0]);
            rates[law.states()].copy_from_slice(&given[1..]);
        }
        rates
    }

    /// The slopes of what laws read, ∂y/∂q w.q + ∂y/∂v w.v.
    fn slopes_of_quantities(&mut self, s: &State, w: &Weights<'_>) -> Vec<Vec<f64>> {
        let n = self.seen.model.v;
        let mut by: Vec<Vec<f64>> = vec![vec![0.0; n]; self.read.len()];
        if by.is_empty() {
            return by;
        }
        let at = self.seen.copy(s);
        let mut moved = s.clone();
        let mut way = vec![0.0; n];
        for i in 0..n {
            let h = STEP * self.scales[i];
            for (weight, of_velocity) in [(w.q, false), (w.v, true)] {
                if weight == 0.0 {
                    continue;
                }
                let ends = [h, -h].map(|h| {
                    if of_velocity {
                        moved.v[i] = s.v[i] + h;
                    } else {
                        way[i] = h;
                        self.inner.retract(&at.q, &way, &mut moved.q[..self.seen.model.q]);
                    }
                    self.quantities(&moved)
                });
                (way[i], moved.v[i]) = (0.0, s.v[i]);
                moved.q.copy_from_slice(&s.q);
                for (j, by) in by.iter_mut().enumerate() {
                    by[i] += weight * (ends[0][j] - ends[1][j]) / (2.0 * h);
                }
            }
        }
        by
    }

    /// ∂u/∂q w.q + ∂u/∂v w.v of every law, and behind it the same of the rates of its states: slopes by what it reads times the slopes of
    /// that, and slopes by its states.
    fn slopes(&mut self, s: &State, w: &Weights<'_>) -> Result<Vec<Vec<Vec<f64>>>, Limit> {
        let (t, y) = (s.time(), self.quantities(s));
        let by = self.slopes_of_quantities(s, w);
        let (n, x) = (self.seen.model.v, self.seen.laws(s));
        let mut all = Vec::new();
        for law in &mut self.laws {
            let mut slopes = vec![vec![0.0; n + x.len()]; 1 + law.input.states.len()];
            let arguments = if law.feeds_back() { law.own.len() + law.input.states.len() } else { 0 };
            let mut own = law.own_of(&y, x);
            for k in 0..arguments {
                let read = law.own.get(k).copied();
                let state = law.first + k.saturating_sub(law.own.len());
                let scale = read.map_or_else(|| self.scales[n + state], |j| self.read[j].1);
                let (at, h) = (own[k], STEP * scale.max(own[k].abs()));
                own[k] = at + h;
                let after = law.call(t, &own)?;
                own[k] = at - h;
                let before = law.call(t, &own)?;
                own[k] = at;
                for ((slope, after), before) in slopes.iter_mut().zip(after).zip(before) {
                    let by_argument = (after - before) / (2.0 * h);
                    match read {
                        Some(j) => {
                            slope.iter_mut().zip(&by[j]).for_each(|(slope, by)| *slope += by_argument * by);
                        }
                        None => slope[n + state] += w.v * by_argument,
                    }
                }
            }
            all.push(slopes);
        }
        Ok(all)
    }

    /// The tangent without slopes of laws.
    fn tangent_of_model(&mut self, s: &State, w: &Weights<'_>, out: &mut Matrix) {
        let Seen { model, states, .. } = self.seen;
        let of_model = Weights { increment: w.increment.map(|d| &d[..model.v]), ..*w };
        self.inner.tangent(self.seen.of(s), of_model, out);
        let storage = out.begin();
        for i in model.v..model.v + states {
            storage.add(i, i, w.a + if self.began { 0.0 } else { w.q });
        }
    }

    /// Adds Σ ∂r/∂u ∂u/∂(q, v), and −∂ẋ/∂(q, v) of the states, to a tangent.
    fn add_slopes(&mut self, s: &State, w: &Weights<'_>, out: &mut Matrix) -> Result<(), Limit> {
        let slopes = self.slopes(s, w)?;
        let n = self.seen.model.v;
        let (mut before, mut after) = (vec![0.0; n], vec![0.0; n]);
        let seen = self.seen.of(s);
        self.inner.residual(seen, &mut before);
        for (law, slopes) in self.laws.iter().zip(&slopes).filter(|(law, _)| law.feeds_back()) {
            let (signal, value) = (&law.input.signal, law.input.signal.last());
            let step = value.abs().max(1.0);
            signal.set(value + step);
            self.inner.residual(seen, &mut after);
            signal.set(value);
            let storage = out.begin();
            for (i, (before, after)) in before.iter().zip(&after).enumerate() {
                storage.add_row(i, (after - before) / step, &slopes[0]);
            }
            for (i, slope) in law.states().zip(&slopes[1..]) {
                storage.add_row(n + i, -1.0, slope);
            }
        }
        Ok(())
    }
}

/// Which columns of a model depend on accelerations, on forces of rows, or on what laws give.
fn reactions(inner: &mut dyn System, inputs: &[Input], count: usize) -> Vec<bool> {
    let mut s = inner.initial();
    // Some motion, in which nothing vanishes by chance.
    let some = |i: usize| libm::sin(1.0 + 2.3 * i as f64);
    let scales = inner.scales().to_vec();
    let way: Vec<f64> = scales.iter().enumerate().map(|(i, scale)| 1e-3 * scale * some(i)).collect();
    let q = s.q.clone();
    inner.retract(&q, &way, &mut s.q);
    s.v.iter_mut().enumerate().for_each(|(i, v)| *v += 0.1 * scales[i] * some(3 * i));
    s.mode.fill(Mode::Closed);
    let mut record = |s: &State| {
        let mut row = vec![0.0; count];
        inner.record(s, &mut row);
        row
    };
    let before = record(&s);
    s.a.iter_mut().enumerate().for_each(|(i, a)| *a += scales[i] * (2.0 + some(i)));
    s.lambda.iter_mut().enumerate().for_each(|(i, force)| *force += 2.0 + some(i));
    inputs.iter().for_each(|input| input.signal.set(1.0));
    let after = record(&s);
    inputs.iter().for_each(|input| input.signal.set(0.0));
    let differs = |(a, b): (&f64, &f64)| (a - b).abs() > DEPENDS * b.abs().max(1.0);
    after.iter().zip(&before).map(differs).collect()
}

impl Dynamics for Commanded {
    fn size(&self) -> Size {
        let Size { q, v, lambda, memory } = self.seen.model;
        Size { q: q + self.seen.states, v: v + self.seen.states, lambda, memory }
    }

    fn structure(&self, multipliers: usize) -> Structure {
        let structure = self.inner.structure(multipliers);
        if self.feeds_back() { Structure::dense(structure.order() + self.seen.states) } else { structure }
    }

    fn contacts_are_local(&self) -> bool {
        self.inner.contacts_are_local()
    }

    fn twists(&self, row: usize) -> bool {
        self.inner.twists(row)
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn length(&self) -> f64 {
        self.inner.length()
    }

    fn fastest(&self, v: &[f64]) -> f64 {
        self.inner.fastest(&v[..self.seen.model.v])
    }

    fn unknown(&self, i: usize) -> String {
        let Seen { model, states, .. } = self.seen;
        let state =
            i.checked_sub(model.v).and_then(|state| self.states().find(|(number, _)| *number == state));
        let of_model = if i < model.v { i } else { i.saturating_sub(states) };
        state.map_or_else(
            || self.inner.unknown(of_model),
            |(_, state)| {
                format!("state `{}` of a law, which is measured by its size {:?}", state.name, state.size)
            },
        )
    }

    fn initial(&self) -> State {
        let mut s = self.inner.initial();
        s.q.extend(self.states().map(|_| 0.0));
        s.v.extend(self.states().map(|(_, state)| state.start));
        s.a.extend(self.states().map(|_| 0.0));
        s
    }

    fn across(&self) -> Vec<usize> {
        let n = self.seen.model.v;
        let mut across = self.inner.across();
        across.extend(n..n + self.seen.states);
        across
    }

    fn is_affine(&self) -> bool {
        self.inner.is_affine() && !self.feeds_back()
    }

    fn is_vector_space(&self) -> bool {
        self.inner.is_vector_space()
    }

    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        let Size { q: coordinates, v, .. } = self.seen.model;
        self.inner.retract(&q[..coordinates], &d[..v], &mut out[..coordinates]);
        let moved = q[coordinates..].iter().zip(&d[v..]);
        out[coordinates..].iter_mut().zip(moved).for_each(|(out, (q, d))| *out = q + d);
    }

    fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        let Size { q: coordinates, v, .. } = self.seen.model;
        self.inner.difference(&from[..coordinates], &to[..coordinates], &mut d[..v]);
        let moved = from[coordinates..].iter().zip(&to[coordinates..]);
        d[v..].iter_mut().zip(moved).for_each(|(d, (from, to))| *d = to - from);
    }

    fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        let Size { q: coordinates, v: n, .. } = self.seen.model;
        self.inner.rate(&from[..coordinates], &d[..n], &v[..n], &mut out[..n]);
        out[n..].copy_from_slice(&v[n..]);
    }

    /// r of the model, and behind it a − ẋ(t, y, x) of each state; X + a before a run begins, so that an equilibrium is one.
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let rates = self.command(s);
        let Size { q, v, .. } = self.seen.model;
        self.inner.residual(self.seen.of(s), &mut r[..v]);
        for (i, rate) in rates.into_iter().enumerate() {
            r[v + i] = s.a[v + i] - if self.began { rate } else { -s.q[q + i] };
        }
    }

    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        self.inner.constraint(self.seen.of(s), c, g);
    }

    fn dropped(&mut self, s: &State) -> [f64; 3] {
        self.inner.dropped(self.seen.of(s))
    }

    fn rows(&self) -> &[Set] {
        self.inner.rows()
    }

    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        self.inner.jacobian(self.seen.of(s), visit);
    }

    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        self.command(s);
        let adds = self.began && self.fault.is_none() && self.feeds_back() && (w.q != 0.0 || w.v != 0.0);
        if adds {
            // What the model has written there before may hold slopes of the laws.
            out.set_stamp(None);
        }
        self.tangent_of_model(s, &w, out);
        if adds && let Err(fault) = self.add_slopes(s, &w, out) {
            self.fault = Some(fault);
        }
    }

    fn corotate(&self, before: &State, now: &State, out: &mut Corotation) {
        if self.seen.states == 0 {
            self.inner.corotate(before, now, out);
        } else {
            // It would number multipliers as the model does.
            out.clear();
        }
    }

    fn stiffness_forms(&mut self, s: &State, vectors: &[Vec<f64>]) -> Option<Vec<StiffnessForm>> {
        let is_model = self.seen.states == 0 && !(self.began && self.feeds_back());
        if is_model { self.inner.stiffness_forms(s, vectors) } else { None }
    }
}

impl Events for Commanded {
    fn breaks(&self) -> &[Break] {
        &self.breaks
    }

    /// Takes the samples that are due.
    fn pass(&mut self, s: &State) -> Result<(), Limit> {
        self.began = true;
        self.inner.pass(self.seen.of(s))?;
        let t = s.time();
        if self.laws.iter().any(|law| law.is_due(t)) {
            let y = self.quantities(s);
            let x = self.seen.laws(s);
            for law in self.laws.iter_mut().filter(|law| law.is_due(t)) {
                let own = law.own_of(&y, x);
                law.sample(t, &own)?;
            }
        }
        Ok(())
    }

    fn impulse(&mut self, s: &State, p: &mut [f64]) -> bool {
        let states = self.seen.states;
        if states == 0 {
            return self.inner.impulse(s, p);
        }
        let n = self.seen.model.v;
        let mut of_model = vec![0.0; p.len() - states];
        let acts = self.inner.impulse(self.seen.of(s), &mut of_model);
        p[..n].copy_from_slice(&of_model[..n]);
        p[n..n + states].fill(0.0);
        p[n + states..].copy_from_slice(&of_model[n..]);
        acts
    }

    fn impulse_work(&mut self, before: &State, after: &State) -> f64 {
        self.inner.impulse_work(&self.seen.copy(before), &self.seen.copy(after))
    }

    fn turning(&mut self, s: &State) -> f64 {
        self.inner.turning(self.seen.of(s))
    }

    fn indicators(&self) -> usize {
        self.inner.indicators()
    }

    fn indicate(&mut self, s: &State, out: &mut [f64]) {
        self.inner.indicate(self.seen.of(s), out);
    }

    fn indicator_rates(&mut self, s: &State, out: &mut [f64]) {
        self.inner.indicator_rates(self.seen.of(s), out);
    }

    fn cross(&mut self, fired: &[usize], s: &mut State) -> Crossing {
        let mut model = self.seen.copy(s);
        let crossing = self.inner.cross(fired, &mut model);
        self.seen.put(&model, s);
        crossing
    }
}

impl Steady for Commanded {
    fn set(&mut self, parameter: Parameter, value: f64) -> Result<(), NotSet> {
        self.inner.set(parameter, value)
    }

    fn hold(&mut self, held: bool) {
        self.inner.hold(held);
    }

    fn release(&mut self) {
        self.inner.release();
    }
}

impl Observed for Commanded {
    fn energy(&mut self, s: &State) -> Energy {
        self.inner.energy(self.seen.of(s))
    }

    fn power(&mut self, s: &State) -> Power {
        self.command(s);
        self.inner.power(self.seen.of(s))
    }

    fn energy_and_power(&mut self, s: &State) -> (Energy, Power) {
        self.command(s);
        self.inner.energy_and_power(self.seen.of(s))
    }

    fn frames(&mut self, body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
        self.inner.frames(body, self.seen.of(s), stations, out);
    }

    fn observe(&mut self, s: &State, sink: &mut Sink<'_>) {
        self.command(s);
        self.inner.observe(self.seen.of(s), sink);
        for law in &self.laws {
            let Input { name, unit, signal, states, .. } = &law.input;
            let value = crate::profile::Profile::value(&**signal, s.time());
            sink.put(value, || {
                let meaning = format!("what the law `{name}` gives");
                Channel::new(Role::Secondary, column(name, None), *unit, meaning)
            });
            for (state, value) in states.iter().zip(&self.seen.laws(s)[law.states()]) {
                sink.put(*value, || {
                    let meaning = format!("the state `{}` of the law `{name}`", state.name);
                    Channel::new(Role::Secondary, column(name, Some(state)), "", meaning)
                });
            }
        }
    }

    fn contacts(&mut self, s: &State) -> Vec<ContactInfo> {
        self.inner.contacts(self.seen.of(s))
    }

    fn contact_samples(&mut self, s: &State, out: &mut Vec<ContactSample>) {
        self.inner.contact_samples(self.seen.of(s), out);
    }

    fn direction(&self, i: usize) -> Direction {
        if i < self.seen.model.v { self.inner.direction(i) } else { Direction::Other }
    }

    fn shares(&self, s: &State, x: &[f64], mx: &[f64], add: &mut dyn FnMut(Direction, f64)) {
        let n = self.seen.model.v;
        self.inner.shares(&self.seen.copy(s), &x[..n], &mx[..n], add);
    }

    fn drawn(&self) -> usize {
        self.inner.drawn()
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        self.fault.clone().map_or(Ok(()), Err)?;
        self.inner.admissible(self.seen.of(s))
    }

    fn explain(&mut self, s: &State) -> Option<Limit> {
        self.fault.clone().or_else(|| self.inner.explain(self.seen.of(s)))
    }

    fn slender(&self) -> Option<Slender> {
        self.inner.slender()
    }

    fn cautions(&self, peaks: &[f64]) -> Vec<String> {
        self.inner.cautions(peaks)
    }
}
