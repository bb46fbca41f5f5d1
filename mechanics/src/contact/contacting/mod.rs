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

mod events;
mod observed;

use super::law::{Contact, Law};
use super::obstacle::{Obstacle, Surface};
use super::points::{Curve, PointMotion, Points, TOUCHING, Variation};
use crate::linalg::vector::inner;
use crate::linalg::{Matrix, Structure, Vec3};
use crate::system::{
    Break, Corotation, Dynamics, Events, Mode, Observed, RowWeights, Set, Size, State, StiffnessForm,
    VisitRow, Weights, ordered,
};
use std::ops::Range;

/// Square of the speed over twice the acceleration and the way, up to which one is what the other makes of it, twice that of a constant acceleration.
const AT_REST: f64 = 4.0;

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

/// A point and the surface before it.
struct Proximity {
    motion: PointMotion,
    surface: Surface,
    /// w = ṗ − u
    velocity: Vec3,
    /// Arc length of the nearest point of a curve.
    station: Option<f64>,
    /// ġ
    rate: f64,
    /// c, the velocity of what touches: w, of a ball w − R ω × n.
    touching: Vec3,
    /// t₁·c, t₂·c
    sliding: [f64; 2],
}

impl Proximity {
    /// Of point `k` of a model before an obstacle; `planar` where its friction has one row, along the first tangent.
    fn new(model: &mut impl Points, k: usize, obstacle: &dyn Obstacle, planar: bool, s: &State) -> Proximity {
        model.approach(k, s, obstacle);
        let (motion, station) = (model.motion(k, s), model.station(k));
        let mut surface = obstacle.surface(motion.position, s.time());
        surface.gap -= motion.radius;
        if planar {
            surface = surface.in_plane();
        }
        let velocity = motion.velocity - surface.velocity;
        let swept = motion.spin.cross(surface.normal);
        let touching = velocity - motion.radius * swept;
        let (rate, sliding) = (surface.normal.dot(velocity), surface.tangents.map(|t| t.dot(touching)));
        Proximity { motion, surface, velocity, station, rate, touching, sliding }
    }

    /// Whether point `k` is known not to touch, at less cost than that of its motion.
    fn is_away(model: &mut impl Points, k: usize, obstacle: &dyn Obstacle, s: &State) -> bool {
        if model.station(k).is_some() {
            // It would have to be found for that.
            return false;
        }
        model.approach(k, s, obstacle);
        let placed = model.position(k, s);
        placed.is_some_and(|(position, radius)| obstacle.surface(position, s.time()).gap > radius)
    }

    /// The speed −ġ with which it touches; 0 where it has none but what its acceleration makes of a rounding of the gap, in a system of this `length` \[m\]: a
    /// contact that begins at rest.
    fn closing_speed(&self, length: f64) -> f64 {
        let least = AT_REST * self.acceleration().abs() * TOUCHING * length;
        if self.rate < 0.0 && self.rate * self.rate > least { -self.rate } else { 0.0 }
    }

    /// g̈
    fn acceleration(&self) -> f64 {
        let (path, acceleration) = self.path();
        self.surface.normal.dot(acceleration) + self.turned(path)[0].dot(self.velocity)
    }

    /// Rate of the sliding velocity along tangent `i`.
    fn sliding_rate(&self, i: usize) -> f64 {
        let PointMotion { radius, spin, spin_rate, .. } = self.motion;
        let ((path, acceleration), normal) = (self.path(), self.surface.normal);
        let turned = self.turned(path);
        let swept = spin_rate.cross(normal) + spin.cross(turned[0]);
        let acceleration = acceleration - radius * swept;
        self.surface.tangents[i].dot(acceleration) + turned[1 + i].dot(self.touching)
    }

    /// w + p′ṡ, by which the point moves past the obstacle, and ẇ on that path.
    fn path(&self) -> (Vec3, Vec3) {
        let acceleration = self.motion.acceleration - self.surface.acceleration;
        let Some(Curve { slope, slope_rate, .. }) = self.motion.curve else {
            return (self.velocity, acceleration);
        };
        let moved = self.moved(self.velocity, slope_rate);
        (self.velocity + moved * slope, acceleration + moved * slope_rate)
    }

    /// By how much s of the nearest point changes when the material point there moves by `x` and p′ by `slope`.
    fn moved(&self, x: Vec3, slope: Vec3) -> f64 {
        let Some(curve) = self.motion.curve else { return 0.0 };
        let normal = self.surface.normal;
        let stiffness = normal.dot(curve.curvature) + self.turned(curve.slope)[0].dot(curve.slope);
        -(normal.dot(slope) + self.turned(x)[0].dot(curve.slope)) / stiffness
    }

    /// ∂n/∂p x, ∂t₁/∂p x and ∂t₂/∂p x.
    fn turned(&self, x: Vec3) -> [Vec3; 3] {
        let Surface { normal, tangents: [t1, t2], curvatures: [k1, k2], twist, .. } = self.surface;
        let (first, second, turn) = (k1 * t1.dot(x), k2 * t2.dot(x), twist.dot(x));
        [first * t1 + second * t2, -first * normal + turn * t2, -second * normal - turn * t1]
    }

    /// The force and, on a ball, its moment.
    fn wrench(&self, force: Vec3) -> [Vec3; 2] {
        [force, -self.motion.radius * self.surface.normal.cross(force)]
    }
}

/// Normal force and friction of a contact at a state, with their derivatives by a variation.
struct Forces {
    normal: f64,
    friction: [f64; 2],
    /// ∂N by g and ġ.
    by_gap: [f64; 2],
    /// ∂T by N, and by the sliding velocity.
    by_normal: [f64; 2],
    by_sliding: [[f64; 2]; 2],
}

impl Forces {
    fn vector(&self, surface: &Surface) -> Vec3 {
        let ([first, second], [t1, t2]) = (self.friction, surface.tangents);
        self.normal * surface.normal + first * t1 + second * t2
    }

    fn vanish(&self) -> bool {
        self.normal == 0.0 && self.friction == [0.0; 2]
    }

    /// Change of the force and its moment by changes of the `position` of the point, its `velocity` and the `spin`.
    fn change(&self, near: &Proximity, [position, velocity, spin]: [Vec3; 3]) -> [Vec3; 2] {
        let (Surface { normal: n, tangents: [t1, t2], .. }, radius) = (near.surface, near.motion.radius);
        let [dn, d1, d2] = near.turned(position);
        let gap = n.dot(position);
        let rate = dn.dot(near.velocity) + n.dot(velocity);
        let touching = if radius == 0.0 {
            velocity
        } else {
            velocity - radius * spin.cross(n) - radius * near.motion.spin.cross(dn)
        };
        let sliding = [(d1, t1), (d2, t2)].map(|(dt, t)| dt.dot(near.touching) + t.dot(touching));
        let normal = self.by_gap[0] * gap + self.by_gap[1] * rate;
        let [first, second] = [0, 1].map(|i| self.by_normal[i] * normal + inner(self.by_sliding[i], sliding));
        let turned = self.normal * dn + self.friction[0] * d1 + self.friction[1] * d2;
        let force = normal * n + first * t1 + second * t2 + turned;
        if radius == 0.0 {
            return [force, Vec3([0.0; 3])];
        }
        let turned = dn.cross(self.vector(&near.surface));
        [force, -radius * n.cross(force) - radius * turned]
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
