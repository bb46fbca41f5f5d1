//! A model whose points may touch obstacles.
//!
//! With p a point of the model, u the velocity of the obstacle, w = ṗ − u, and n, t, κ of its [`Surface`],
//!
//! ```text
//! g,   ġ = n·w,   g̈ = n·(p̈ − u̇) + κ₁ (t₁·w)² + κ₂ (t₂·w)²
//! sliding velocity tᵢ·w, its rate tᵢ·(p̈ − u̇) − κᵢ (tᵢ·w)(n·w)
//! F = λₙ n + Σ λᵢ tᵢ  or  F = N(δ, δ̇) n + Σ Tᵢ tᵢ,   r −= F·∂p/∂q
//! ```
//!
//! A ball of radius R about the point has the gap g − R, slides with c = w − R ω × n in the place of w, and gets the moment
//! −R n × F. The point nearest to an obstacle on a curve p(s) of material points, n·p′ = 0, moves along it:
//!
//! ```text
//! ṡ = −(n·ṗ′ + p′·∇n w)/(n·p″ + p′·∇n p′),   g̈ = n·(p̈ + ṗ′ṡ − u̇) + w·∇n (w + p′ṡ),   ∂s/∂q alike
//! ```
//!
//! ġ and F·∂p/∂q are those of the material point, for n·p′ = 0.
//!
//! In the plane t₁ alone counts, in space both tangents. A contact with the law [`Law::Constraint`] gives a row to the
//! system, and with friction one more for each tangent: |λ_t| ≤ μ λ_n, in space with both components. Integrators
//! impose the rows, `analysis::transient` locates and resolves impacts. A [`Law::Force`] is a load; its closing speed is written into
//! `State::memory` by the event g = 0 at which a contact begins.

mod forces;
mod observed;
mod proximity;

use super::force::ContactForce;
use super::obstacle::Obstacle;
use super::points::{Curve, Points, Variation};
use crate::linalg::vector::inner;
use crate::linalg::{Matrix, Structure, Vec3};
use crate::system::{
    Break, Corotation, Crossing, Dynamics, Events, Jump, Limit, Mode, NotSet, Observed, Parameter, Power,
    RowWeights, Set, Size, State, Steady, StiffnessForm, VisitRow, Weights, ordered,
};
use forces::Forces;
use proximity::Proximity;
use std::ops::Range;
use std::sync::Arc;

/// What happens when a point touches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law {
    /// The point cannot enter: impulse and momentum, then a constraint until it would pull.
    Constraint {
        /// Newton's coefficient of restitution e, 0 … 1.
        restitution: f64,
        /// Coefficient of Coulomb's friction μ ≥ 0.
        friction: f64,
    },
    /// A continuous force.
    Force(ContactForce),
}

impl Law {
    /// Whether it has friction.
    pub fn has_friction(&self) -> bool {
        match self {
            Law::Constraint { friction, .. } => *friction > 0.0,
            Law::Force(force) => force.friction > 0.0,
        }
    }
}

/// A point and the obstacle that it may touch.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Prefix of its columns.
    pub name: String,
    /// Number of the point.
    pub point: usize,
    /// What it may touch.
    pub obstacle: Arc<dyn Obstacle>,
    /// What happens then.
    pub law: Law,
}

/// A model `S` with contacts. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct Contacting<S> {
    inner: S,
    contacts: Vec<Placed>,
    /// Rows of the model and of the contacts.
    sets: Vec<Set>,
    /// Numbers of rows, memory and indicators of the model itself.
    rows: usize,
    memory: usize,
    indicators: usize,
    breaks: Vec<Break>,
    /// Of the point at hand.
    variations: Vec<Variation>,
    numbers: Vec<usize>,
    entries: Vec<f64>,
}

/// A contact with its place in the lists of the system.
#[derive(Clone, Debug)]
struct Placed {
    contact: Contact,
    /// Row of the normal force, or number of the indicator and of the memory among those of contacts.
    place: usize,
    /// Rows of the friction, one a tangent.
    friction: Range<usize>,
}

impl Placed {
    /// The point and the surface before it at a state.
    fn proximity(&self, model: &mut impl Points, s: &State) -> Proximity {
        Proximity::new(model, self.contact.point, self.contact.obstacle.as_ref(), self.friction.len() == 1, s)
    }

    /// Whether it is a row without a force.
    fn is_open(&self, s: &State) -> bool {
        let rows = std::iter::once(self.place).chain(self.friction.clone());
        matches!(self.contact.law, Law::Constraint { .. }) && rows.into_iter().all(|i| s.lambda[i] == 0.0)
    }

    /// The point and the surface before it, if it may act on the model: a row always, a force where the point touches.
    fn acting(&self, model: &mut impl Points, s: &State) -> Option<Proximity> {
        let Contact { point, obstacle, law, .. } = &self.contact;
        let away = matches!(law, Law::Force(_)) && Proximity::is_away(model, *point, obstacle.as_ref(), s);
        (!away).then(|| self.proximity(model, s))
    }

    /// The forces at a state.
    fn forces(&self, near: &Proximity, s: &State, memory: usize) -> Forces {
        match &self.contact.law {
            Law::Constraint { .. } => Forces {
                normal: s.lambda[self.place],
                friction: [0, 1].map(|i| self.friction.clone().nth(i).map_or(0.0, |row| s.lambda[row])),
                by_gap: [0.0; 2],
                by_normal: [0.0; 2],
                by_sliding: [[0.0; 2]; 2],
            },
            Law::Force(law) => {
                let normal = law.normal(-near.surface.gap, -near.rate, s.memory[memory + self.place]);
                let (part, slope) = law.friction(near.sliding);
                Forces {
                    normal: normal.value,
                    friction: part.map(|part| part * normal.value),
                    by_gap: [-normal.by_indentation, -normal.by_rate],
                    by_normal: part,
                    by_sliding: slope.map(|row| row.map(|x| x * normal.value)),
                }
            }
        }
    }
    /// Power lost in friction and damping.
    fn lost(&self, near: &Proximity, forces: &Forces) -> f64 {
        let friction = -inner(forces.friction, near.sliding);
        let Law::Force(law) = &self.contact.law else { return friction };
        let elastic = law.normal(-near.surface.gap, 0.0, 0.0).value;
        friction - (forces.normal - elastic) * near.rate
    }
}

impl<S: Points + Dynamics + Events + Observed> Contacting<S> {
    /// `inner` with contacts.
    pub fn new(inner: S, contacts: Vec<Contact>) -> Contacting<S> {
        let Size { lambda: rows, memory, .. } = inner.size();
        let directions = inner.directions();
        let mut sets = inner.rows().to_vec();
        let mut breaks = inner.breaks().to_vec();
        let mut forces = 0;
        let mut placed = Vec::new();
        for contact in contacts {
            breaks.extend(contact.obstacle.breaks());
            let (place, friction) = match contact.law {
                Law::Constraint { restitution, friction } => {
                    let place = sets.len();
                    sets.push(Set::Unilateral { restitution });
                    let directions = if friction > 0.0 { directions } else { 0 };
                    sets.extend(
                        (0..directions).map(|_| Set::Friction { coefficient: friction, normal: place }),
                    );
                    (place, place + 1..place + 1 + directions)
                }
                Law::Force(_) => {
                    forces += 1;
                    (forces - 1, 0..0)
                }
            };
            placed.push(Placed { contact, place, friction });
        }
        let n = inner.size().v;
        Contacting {
            indicators: inner.indicators(),
            inner,
            contacts: placed,
            sets,
            rows,
            memory,
            breaks: ordered(breaks),
            variations: Vec::with_capacity(n),
            numbers: Vec::with_capacity(n),
            entries: Vec::with_capacity(n),
        }
    }

    /// The model without contacts.
    pub fn inner(&self) -> &S {
        &self.inner
    }

    /// The model without contacts.
    pub fn into_inner(self) -> S {
        self.inner
    }

    /// The contacts.
    pub fn contacts(&self) -> impl Iterator<Item = &Contact> {
        self.contacts.iter().map(|placed| &placed.contact)
    }

    /// The gap of each contact \[m\].
    pub fn gaps(&mut self, s: &State) -> Vec<f64> {
        let gap = |placed: &Placed, model: &mut S| placed.proximity(model, s).surface.gap;
        self.contacts.iter().map(|placed| gap(placed, &mut self.inner)).collect()
    }

    /// Number of contacts with a continuous force.
    fn forces(&self) -> usize {
        self.contacts.iter().filter(|placed| matches!(placed.contact.law, Law::Force(_))).count()
    }

    /// Calls `f` for every contact with its point, surface and forces.
    fn each(&mut self, s: &State, mut f: impl FnMut(&Placed, &Proximity, &Forces)) {
        for placed in &self.contacts {
            let near = placed.proximity(&mut self.inner, s);
            f(placed, &near, &placed.forces(&near, s, self.memory));
        }
    }

    /// Calls `f` for every contact that may act, as [`Contacting::each`] does for all.
    fn each_acting(&mut self, s: &State, mut f: impl FnMut(&Placed, &Proximity, &Forces)) {
        for placed in &self.contacts {
            if let Some(near) = placed.acting(&mut self.inner, s) {
                f(placed, &near, &placed.forces(&near, s, self.memory));
            }
        }
    }

    /// Tells the model the forces on its points.
    fn set_forces(&mut self, s: &State) {
        self.inner.begin_forces();
        for placed in &self.contacts {
            let Some(near) = placed.acting(&mut self.inner, s) else { continue };
            let force = placed.forces(&near, s, self.memory).vector(&near.surface);
            self.inner.add_force(placed.contact.point, s, force);
        }
    }

    /// Energy stored in contacts.
    fn stored(&mut self, s: &State) -> f64 {
        let mut stored = 0.0;
        self.each_acting(s, |placed, near, _| {
            if let Law::Force(law) = &placed.contact.law {
                stored += law.stored(-near.surface.gap);
            }
        });
        stored
    }

    /// Adds the power of the contacts: moving obstacles and the prescribed motion of the model drive, friction and damping lose.
    fn add_power(&mut self, s: &State, power: &mut Power) {
        self.each_acting(s, |placed, near, forces| {
            let force = forces.vector(&near.surface);
            power.drive += force.dot(near.surface.velocity - near.motion.prescribed);
            power.contact += placed.lost(near, forces);
        });
    }
}

impl<S: Points + Dynamics + Events + Observed> Dynamics for Contacting<S> {
    fn size(&self) -> Size {
        let size = self.inner.size();
        Size { lambda: self.sets.len(), memory: self.memory + self.forces(), ..size }
    }

    fn structure(&self, multipliers: usize) -> Structure {
        // Behind each copy of the model's own multipliers.
        let (n, own) = (self.inner.size().v, self.sets.len() - self.rows);
        let structure = (1..=multipliers).fold(self.inner.structure(multipliers), |structure, copy| {
            structure.widened(n + copy * self.rows + (copy - 1) * own, own)
        });
        let full = self.contacts.iter().any(|placed| {
            let surface = placed.contact.obstacle.surface(Vec3([0.0; 3]), 0.0);
            let stiff = matches!(placed.contact.law, Law::Force(_)) || surface.curvatures != [0.0; 2];
            stiff && !self.inner.is_local(placed.contact.point)
        });
        if full { Structure::dense(structure.order()) } else { structure }
    }

    fn contacts_are_local(&self) -> bool {
        let rigid = |placed: &&Placed| matches!(placed.contact.law, Law::Constraint { .. });
        self.rows == self.inner.rows().iter().filter(|set| **set == Set::Free).count()
            && self.contacts.iter().filter(rigid).all(|placed| self.inner.is_local(placed.contact.point))
    }

    fn twists(&self, row: usize) -> bool {
        let of_row = |placed: &&Placed| placed.friction.len() == 2 && placed.friction.contains(&row);
        let obstacle = self.contacts.iter().find(of_row).map(|placed| &placed.contact.obstacle);
        obstacle.is_some_and(|obstacle| obstacle.surface(Vec3([0.0; 3]), 0.0).curvatures[1] != 0.0)
    }

    fn scales(&self) -> &[f64] {
        self.inner.scales()
    }

    fn unknown(&self, i: usize) -> String {
        let Some(row) = i.checked_sub(self.inner.size().v + self.rows) else { return self.inner.unknown(i) };
        let found = self.contacts.iter().find_map(|placed| {
            let name = &placed.contact.name;
            let own = matches!(placed.contact.law, Law::Constraint { .. });
            match row + self.rows {
                row if own && row == placed.place => Some(format!("force of the contact {name}")),
                row if own && placed.friction.contains(&row) => {
                    Some(format!("friction of the contact {name}"))
                }
                _ => None,
            }
        });
        found.unwrap_or_else(|| format!("unknown {i}"))
    }

    fn initial(&self) -> State {
        let inner = self.inner.initial();
        let mut state = State::zeros(self.size(), inner.t);
        let copy = |from: &[f64], to: &mut [f64]| to[..from.len()].copy_from_slice(from);
        copy(&inner.q, &mut state.q);
        copy(&inner.v, &mut state.v);
        copy(&inner.a, &mut state.a);
        copy(&inner.lambda, &mut state.lambda);
        copy(&inner.memory, &mut state.memory);
        state.mode.fill(Mode::Open);
        state.mode[..inner.mode.len()].copy_from_slice(&inner.mode);
        state
    }

    fn across(&self) -> Vec<usize> {
        self.inner.across()
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
        self.inner.residual(s, r);
        for placed in &self.contacts {
            if placed.is_open(s) {
                continue;
            }
            let Some(near) = placed.acting(&mut self.inner, s) else { continue };
            let forces = placed.forces(&near, s, self.memory);
            if forces.vanish() {
                continue;
            }
            let [force, moment] = near.wrench(forces.vector(&near.surface));
            self.inner.variations(placed.contact.point, s, &mut self.variations);
            for by in &self.variations {
                r[by.unknown] -= force.dot(by.position) + moment.dot(by.rotation);
            }
        }
    }

    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        self.inner.constraint(s, c, &mut g[..self.rows]);
        for placed in &self.contacts {
            if let Law::Constraint { .. } = placed.contact.law {
                let near = placed.proximity(&mut self.inner, s);
                g[placed.place] = c.combine(near.surface.gap, near.rate, near.acceleration());
                for (i, row) in placed.friction.clone().enumerate() {
                    g[row] = c.combine(0.0, near.sliding[i], near.sliding_rate(i));
                }
            }
        }
    }

    fn dropped(&mut self, s: &State) -> [f64; 3] {
        Vec3(self.inner.dropped(s)).0
    }

    fn rows(&self) -> &[Set] {
        &self.sets
    }

    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        self.inner.jacobian(s, visit);
        for placed in &self.contacts {
            if let Law::Constraint { .. } = placed.contact.law {
                let near = placed.proximity(&mut self.inner, s);
                self.inner.variations(placed.contact.point, s, &mut self.variations);
                self.numbers.clear();
                self.numbers.extend(self.variations.iter().map(|by| by.unknown));
                let friction = placed.friction.clone().zip(near.surface.tangents);
                for (row, direction) in [(placed.place, near.surface.normal)].into_iter().chain(friction) {
                    let [force, moment] = near.wrench(direction);
                    let entry = |by: &Variation| force.dot(by.position) + moment.dot(by.rotation);
                    self.entries.clear();
                    self.entries.extend(self.variations.iter().map(entry));
                    visit(row, &self.numbers, &self.entries);
                }
            }
        }
    }

    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        // The model alone may recognise its own content, to which contacts have been added.
        out.set_stamp(None);
        self.inner.tangent(s, w, out);
        out.set_stamp(None);
        if w.q == 0.0 && w.v == 0.0 {
            return;
        }
        for placed in &self.contacts {
            if placed.is_open(s) {
                continue;
            }
            let Some(near) = placed.acting(&mut self.inner, s) else { continue };
            let forces = placed.forces(&near, s, self.memory);
            if forces.vanish() {
                continue;
            }
            let point = placed.contact.point;
            self.inner.variations(point, s, &mut self.variations);
            let rigid = matches!(placed.contact.law, Law::Constraint { .. });
            let wrench = near.wrench(forces.vector(&near.surface));
            if !rigid || near.surface.curvatures != [0.0; 2] {
                let Curve { slope, slope_rate, .. } = near.motion.curve.unwrap_or_default();
                for column in &self.variations {
                    let moved = near.moved(column.position, column.slope);
                    let position = column.position + moved * slope;
                    let velocity = column.velocity + moved * slope_rate;
                    let by_position = forces.change(&near, [position, velocity, column.spin]);
                    let by_velocity =
                        forces.change(&near, [Vec3([0.0; 3]), column.position, column.rotation]);
                    let [force, moment] = [0, 1].map(|i| w.q * by_position[i] + w.v * by_velocity[i]);
                    let on_slope = w.q * moved * wrench[0];
                    for row in &self.variations {
                        let x = row.position.dot(force) + row.rotation.dot(moment) + row.slope.dot(on_slope);
                        if x != 0.0 {
                            out.add(row.unknown, column.unknown, -x);
                        }
                    }
                }
            }
            self.inner.add_curvature(point, s, wrench, -w.q, out);
        }
    }

    fn corotate(&self, before: &State, now: &State, out: &mut Corotation) {
        self.inner.corotate(before, now, out);
    }

    fn stiffness_forms(&mut self, s: &State, vectors: &[Vec<f64>]) -> Option<Vec<StiffnessForm>> {
        let mut free = true;
        self.each(s, |_, _, forces| free &= forces.vanish());
        if free { self.inner.stiffness_forms(s, vectors) } else { None }
    }
}

impl<S: Points + Dynamics + Events + Observed> Events for Contacting<S> {
    fn breaks(&self) -> &[Break] {
        &self.breaks
    }

    fn pass(&mut self, s: &State) -> Result<(), Limit> {
        self.inner.pass(s)
    }

    /// An obstacle whose velocity jumps strikes too, without an impulse of its own.
    fn impulse(&mut self, s: &State, p: &mut [f64]) -> bool {
        // Its rows come first.
        let own = self.inner.impulse(s, &mut p[..s.v.len() + self.rows]);
        let moved = |b: &Break| b.time == s.t && b.jump == Jump::Velocity;
        own || self.contacts.iter().any(|placed| placed.contact.obstacle.breaks().iter().any(moved))
    }

    fn impulse_work(&mut self, before: &State, after: &State) -> f64 {
        self.inner.impulse_work(before, after)
    }

    fn turning(&mut self, s: &State) -> f64 {
        self.inner.turning(s)
    }

    fn indicators(&self) -> usize {
        self.indicators + self.forces()
    }

    fn indicate(&mut self, s: &State, out: &mut [f64]) {
        let (own, gaps) = out.split_at_mut(self.indicators);
        self.inner.indicate(s, own);
        self.each(s, |placed, near, _| {
            if let Law::Force(_) = placed.contact.law {
                gaps[placed.place] = near.surface.gap;
            }
        });
    }

    fn indicator_rates(&mut self, s: &State, out: &mut [f64]) {
        let (own, rates) = out.split_at_mut(self.indicators);
        self.inner.indicator_rates(s, own);
        self.each(s, |placed, near, _| {
            if let Law::Force(_) = placed.contact.law {
                rates[placed.place] = near.rate;
            }
        });
    }

    fn cross(&mut self, fired: &[usize], s: &mut State) -> Crossing {
        let own: Vec<usize> = fired.iter().copied().filter(|k| *k < self.indicators).collect();
        let crossing = if own.is_empty() { Crossing::Restart } else { self.inner.cross(&own, s) };
        let mut closing = vec![0.0; self.forces()];
        let length = self.length();
        self.each(s, |placed, near, _| {
            if let Law::Force(_) = placed.contact.law {
                closing[placed.place] = near.closing_speed(length);
            }
        });
        for &k in fired.iter().filter(|k| **k >= self.indicators) {
            s.memory[self.memory + k - self.indicators] = closing[k - self.indicators];
        }
        if crossing == Crossing::Continue { Crossing::Restart } else { crossing }
    }
}

impl<S: Steady> Steady for Contacting<S> {
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
