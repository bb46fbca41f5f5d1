//! A model with laws of one's own. Its formulas head the [module](super).

use super::acting::Acting;
use super::input::{CommandFault, Input};
use crate::linalg::{Matrix, Structure};
use crate::system::{
    Break, Channel, ContactInfo, ContactSample, Corotation, Crossing, Direction, Dynamics, Energy, Events,
    Frame, Jump, Limit, Mode, NotSet, Observed, Parameter, Power, Role, RowWeights, Set, Sink, Size, Slender,
    State, Steady, StiffnessForm, System, VisitRow, Weights, ordered,
};

/// Part of the scale of a quantity by which it is moved for differences.
const STEP: f64 = 1e-6;
/// Change of a quantity over its size by which it depends on accelerations or forces.
const DEPENDS: f64 = 1e-9;

/// A model with laws.
pub struct Commanded {
    inner: Box<dyn System>,
    laws: Vec<Acting>,
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
        }
        let channels = inner.channels();
        let reactions = reactions(inner.as_mut(), &inputs, channels.len());
        let length = inner.length();
        let mut read: Vec<(usize, f64)> = Vec::new();
        let mut laws = Vec::new();
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
            laws.push(Acting::new(input, own));
        }
        let row = vec![0.0; channels.len()];
        Ok(Commanded { inner, laws, breaks: ordered(breaks), read, row, began: false, fault: None })
    }

    fn feeds_back(&self) -> bool {
        self.laws.iter().any(Acting::feeds_back)
    }

    /// The quantities that are read, at a state.
    fn quantities(&mut self, s: &State) -> Vec<f64> {
        if self.read.is_empty() {
            return Vec::new();
        }
        self.inner.record(s, &mut self.row);
        self.read.iter().map(|(i, _)| self.row[*i]).collect()
    }

    /// Asks the laws that are asked at any time.
    fn command(&mut self, s: &State) {
        if !self.began || !self.laws.iter().any(Acting::is_continuous) {
            return;
        }
        let t = s.time();
        let y = if self.feeds_back() { self.quantities(s) } else { Vec::new() };
        for law in self.laws.iter_mut().filter(|law| law.is_continuous()) {
            let own = law.own_of(&y);
            // A state that is no number is an attempt that has failed already.
            let value = match &self.fault {
                None if own.iter().all(|y| y.is_finite()) => law.value(t, &own),
                _ => Ok(f64::NAN),
            };
            law.input.signal.set(value.unwrap_or_else(|fault| {
                self.fault = Some(fault);
                f64::NAN
            }));
        }
    }

    /// ∂u/∂q · w.q + ∂u/∂v · w.v of a law: its slopes by what it reads, times the slopes of these.
    fn slopes(&mut self, s: &State, w: &Weights<'_>) -> Result<Vec<Vec<f64>>, Limit> {
        let (t, n, y) = (s.time(), s.v.len(), self.quantities(s));
        let scales = self.inner.scales().to_vec();
        let mut by: Vec<Vec<f64>> = vec![vec![0.0; n]; self.read.len()];
        let mut moved = s.clone();
        let mut way = vec![0.0; n];
        for i in 0..n {
            let h = STEP * scales[i];
            for (weight, of_velocity) in [(w.q, false), (w.v, true)] {
                if weight == 0.0 {
                    continue;
                }
                let ends = [h, -h].map(|h| {
                    if of_velocity {
                        moved.v[i] = s.v[i] + h;
                    } else {
                        way[i] = h;
                        self.inner.retract(&s.q, &way, &mut moved.q);
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
        let mut all = Vec::new();
        for law in &mut self.laws {
            let mut slope = vec![0.0; n];
            let numbers = if law.feeds_back() { law.own.clone() } else { Vec::new() };
            let mut own = law.own_of(&y);
            for (k, j) in numbers.into_iter().enumerate() {
                let (at, h) = (own[k], STEP * self.read[j].1.max(own[k].abs()));
                own[k] = at + h;
                let after = law.call(t, &own)?;
                own[k] = at - h;
                let by_quantity = (after - law.call(t, &own)?) / (2.0 * h);
                own[k] = at;
                slope.iter_mut().zip(&by[j]).for_each(|(slope, by)| *slope += by_quantity * by);
            }
            all.push(slope);
        }
        Ok(all)
    }

    /// Adds Σ ∂r/∂u ∂u/∂(q, v) to a tangent.
    fn add_slopes(&mut self, s: &State, w: &Weights<'_>, out: &mut Matrix) -> Result<(), Limit> {
        let slopes = self.slopes(s, w)?;
        let n = s.v.len();
        let (mut before, mut after) = (vec![0.0; n], vec![0.0; n]);
        self.inner.residual(s, &mut before);
        for (law, slope) in self.laws.iter().zip(&slopes).filter(|(law, _)| law.feeds_back()) {
            let (signal, value) = (&law.input.signal, law.input.signal.last());
            let step = value.abs().max(1.0);
            signal.set(value + step);
            self.inner.residual(s, &mut after);
            signal.set(value);
            let storage = out.begin();
            for (i, (before, after)) in before.iter().zip(&after).enumerate() {
                storage.add_row(i, (after - before) / step, slope);
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
        self.inner.size()
    }

    fn structure(&self, multipliers: usize) -> Structure {
        let structure = self.inner.structure(multipliers);
        if self.feeds_back() { Structure::dense(structure.order()) } else { structure }
    }

    fn contacts_are_local(&self) -> bool {
        self.inner.contacts_are_local()
    }

    fn scales(&self) -> &[f64] {
        self.inner.scales()
    }

    fn unknown(&self, i: usize) -> String {
        self.inner.unknown(i)
    }

    fn initial(&self) -> State {
        self.inner.initial()
    }

    fn across(&self) -> Vec<usize> {
        self.inner.across()
    }

    fn is_affine(&self) -> bool {
        self.inner.is_affine() && !self.feeds_back()
    }

    fn is_vector_space(&self) -> bool {
        self.inner.is_vector_space()
    }

    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        self.inner.retract(q, d, out);
    }

    fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        self.inner.difference(from, to, d);
    }

    fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        self.inner.rate(from, d, v, out);
    }

    fn residual(&mut self, s: &State, r: &mut [f64]) {
        self.command(s);
        self.inner.residual(s, r);
    }

    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        self.inner.constraint(s, c, g);
    }

    fn dropped(&mut self, s: &State) -> [f64; 3] {
        self.inner.dropped(s)
    }

    fn rows(&self) -> &[Set] {
        self.inner.rows()
    }

    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        self.inner.jacobian(s, visit);
    }

    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        self.command(s);
        let adds = self.began && self.fault.is_none() && self.feeds_back() && (w.q != 0.0 || w.v != 0.0);
        if adds {
            // What the model has written there before may hold slopes of the laws.
            out.set_stamp(None);
        }
        self.inner.tangent(s, w, out);
        if adds && let Err(fault) = self.add_slopes(s, &w, out) {
            self.fault = Some(fault);
        }
    }

    fn corotate(&self, before: &State, now: &State, out: &mut Corotation) {
        self.inner.corotate(before, now, out);
    }

    fn stiffness_forms(&mut self, s: &State, vectors: &[Vec<f64>]) -> Option<Vec<StiffnessForm>> {
        if self.began && self.feeds_back() { None } else { self.inner.stiffness_forms(s, vectors) }
    }
}

impl Events for Commanded {
    fn breaks(&self) -> &[Break] {
        &self.breaks
    }

    /// Takes the samples that are due.
    fn pass(&mut self, s: &State) -> Result<(), Limit> {
        self.began = true;
        self.inner.pass(s)?;
        let t = s.time();
        if self.laws.iter().any(|law| law.is_due(t)) {
            let y = self.quantities(s);
            for law in self.laws.iter_mut().filter(|law| law.is_due(t)) {
                let own = law.own_of(&y);
                law.sample(t, &own)?;
            }
        }
        Ok(())
    }

    fn impulse(&mut self, s: &State, p: &mut [f64]) -> bool {
        self.inner.impulse(s, p)
    }

    fn impulse_work(&mut self, before: &State, after: &State) -> f64 {
        self.inner.impulse_work(before, after)
    }

    fn turning(&mut self, s: &State) -> f64 {
        self.inner.turning(s)
    }

    fn indicators(&self) -> usize {
        self.inner.indicators()
    }

    fn indicate(&mut self, s: &State, out: &mut [f64]) {
        self.inner.indicate(s, out);
    }

    fn indicator_rates(&mut self, s: &State, out: &mut [f64]) {
        self.inner.indicator_rates(s, out);
    }

    fn cross(&mut self, fired: &[usize], s: &mut State) -> Crossing {
        self.inner.cross(fired, s)
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
        self.inner.energy(s)
    }

    fn power(&mut self, s: &State) -> Power {
        self.command(s);
        self.inner.power(s)
    }

    fn energy_and_power(&mut self, s: &State) -> (Energy, Power) {
        self.command(s);
        self.inner.energy_and_power(s)
    }

    fn frames(&mut self, body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
        self.inner.frames(body, s, stations, out);
    }

    fn observe(&mut self, s: &State, sink: &mut Sink<'_>) {
        self.command(s);
        self.inner.observe(s, sink);
        for Acting { input, .. } in &self.laws {
            let value = crate::profile::Profile::value(&*input.signal, s.time());
            sink.put(value, || {
                let name = &input.name;
                let meaning = format!("what the law `{name}` gives");
                Channel::new(Role::Secondary, format!("law.{name}"), input.unit, meaning)
            });
        }
    }

    fn contacts(&mut self, s: &State) -> Vec<ContactInfo> {
        self.inner.contacts(s)
    }

    fn contact_samples(&mut self, s: &State, out: &mut Vec<ContactSample>) {
        self.inner.contact_samples(s, out);
    }

    fn direction(&self, i: usize) -> Direction {
        self.inner.direction(i)
    }

    fn shares(&self, s: &State, x: &[f64], mx: &[f64], add: &mut dyn FnMut(Direction, f64)) {
        self.inner.shares(s, x, mx, add);
    }

    fn drawn(&self) -> usize {
        self.inner.drawn()
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        self.fault.clone().map_or(Ok(()), Err)?;
        self.inner.admissible(s)
    }

    fn explain(&mut self, s: &State) -> Option<Limit> {
        self.fault.clone().or_else(|| self.inner.explain(s))
    }

    fn slender(&self) -> Option<Slender> {
        self.inner.slender()
    }

    fn cautions(&self, peaks: &[f64]) -> Vec<String> {
        self.inner.cautions(peaks)
    }
}
