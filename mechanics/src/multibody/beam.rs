//! A beam of a model, slender or with shear: all that joints, loads, contacts and frames need of it.
//!
//! Both kinds have nodes with a section each, and numbers of their own for what a node has: a [slender](super::slender) one r, r′ and an axis n, and the
//! section in the middle of the element behind it; one with [shear](super::shear) the frame of a rigid section. In an element, both have
//!
//! ```text
//! r(z) = Σ Nᵢ(z) xᵢ,    i = 1 … 4
//! ```
//!
//! with vectors xᵢ among the coordinates, (r₁, r′₁, r₂, r′₂) and (r₁, r₂, r₃, r₄), and their rates among the velocities.

use super::body::Placed;
use super::layout::Link;
use super::line_load::{LineDistribution, LineLoad, cuts, weights};
use super::marker::Pose;
use super::shear::{self, NODE_COORDINATES, NODE_VELOCITIES, POINTS};
use super::slender::{self, ELEMENT_COORDINATES, ELEMENT_VELOCITIES, hermite, sample};
use crate::linalg::{Mat3, Matrix, Vec3};
use crate::profile::drawn;
use crate::system::{Corotation, Frame, Weights};

/// How far the cosine of two axes that count as one may be from one.
const ALIGNED: f64 = 1e-12;

/// A beam in space.
#[derive(Clone, Debug)]
pub enum Beam {
    /// Without shear.
    Slender(slender::Beam),
    /// With shear and any symmetric 6 × 6 stiffness and mass.
    Shear(shear::Beam),
}

impl From<slender::Beam> for Beam {
    fn from(beam: slender::Beam) -> Beam {
        Beam::Slender(beam)
    }
}

impl From<shear::Beam> for Beam {
    fn from(beam: shear::Beam) -> Beam {
        Beam::Shear(beam)
    }
}

impl Beam {
    /// Arc lengths of the nodes \[m\]: of a beam with shear those within elements too.
    pub fn nodes(&self) -> &[f64] {
        match self {
            Beam::Slender(beam) => beam.nodes(),
            Beam::Shear(beam) => beam.nodes(),
        }
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        match self {
            Beam::Slender(beam) => beam.elements().len(),
            Beam::Shear(beam) => beam.elements().len(),
        }
    }

    /// Arc length \[m\] of the end `i` of the elements, of which there is one more than elements.
    pub fn end(&self, i: usize) -> f64 {
        self.nodes()[self.steps() * i]
    }

    /// Nodes from one end of an element to the other.
    pub(super) fn steps(&self) -> usize {
        match self {
            Beam::Slender(_) => 1,
            Beam::Shear(_) => POINTS,
        }
    }

    /// Part of a deflection that rounding may take from a beam with shear.
    pub(super) fn rounding(&self) -> f64 {
        match self {
            Beam::Slender(_) => 0.0,
            Beam::Shear(beam) => beam.rounding(),
        }
    }

    /// Largest stiffness in shear, or along the axis without shear, and least in bending \[N, N·m²\].
    pub(super) fn stiffest_and_bending(&self) -> [f64; 2] {
        let most = |[a, b]: [f64; 2], [x, y]: [f64; 2]| [a.max(x), b.min(y)];
        let none = [0.0, f64::INFINITY];
        match self {
            Beam::Slender(beam) => {
                beam.elements().iter().map(slender::Element::axial_and_bending).fold(none, most)
            }
            Beam::Shear(beam) => {
                beam.elements().iter().map(shear::Element::shear_and_bending).fold(none, most)
            }
        }
    }

    /// Whether its sections have shear strains.
    pub fn has_shear(&self) -> bool {
        matches!(self, Beam::Shear(_))
    }

    /// Number of coordinates q.
    pub fn coordinates(&self) -> usize {
        match self {
            Beam::Slender(beam) => beam.coordinates(),
            Beam::Shear(beam) => beam.coordinates(),
        }
    }

    /// Number of velocities v.
    pub fn velocities(&self) -> usize {
        match self {
            Beam::Slender(beam) => beam.velocities(),
            Beam::Shear(beam) => beam.velocities(),
        }
    }

    /// The configuration without stress.
    pub fn initial(&self) -> &[f64] {
        match self {
            Beam::Slender(beam) => beam.initial(),
            Beam::Shear(beam) => beam.initial(),
        }
    }

    /// Position and axes of node `i`.
    pub fn node(&self, i: usize, q: &[f64]) -> Frame {
        match self {
            Beam::Slender(beam) => {
                let (position, triad) = beam.node(i, q);
                Frame { position, rotation: triad.rotation() }
            }
            Beam::Shear(beam) => beam.node(i, q),
        }
    }

    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        match self {
            Beam::Slender(beam) => beam.mass(),
            Beam::Shear(beam) => beam.mass(),
        }
    }

    /// Sets the damping β [1/s] in proportion to the mass and η \[s\] in proportion to the stiffness, in place of a slender beam's and beside a
    /// sheared one's own.
    pub(super) fn damp(&mut self, mass: f64, stiffness: f64) {
        match self {
            Beam::Slender(beam) => {
                beam.damp(mass);
                beam.make_viscous(stiffness);
            }
            Beam::Shear(beam) => beam.damp(mass, stiffness),
        }
    }

    /// The first coordinate and the first velocity of node `i`.
    pub(super) fn place(&self, i: usize) -> [usize; 2] {
        match self {
            Beam::Slender(_) => [ELEMENT_COORDINATES * i, ELEMENT_VELOCITIES * i],
            Beam::Shear(_) => [NODE_COORDINATES * i, NODE_VELOCITIES * i],
        }
    }

    /// Velocities that a node adds to the unknowns, node by node.
    pub(super) fn sizes(&self) -> impl Iterator<Item = usize> {
        let count = self.nodes().len();
        let velocities = self.velocities();
        (0..count).map(move |i| {
            let first = |i: usize| self.place(i)[1];
            first(i + 1).min(velocities) - first(i)
        })
    }

    /// The couplings of its nodes, of which the first has the number `first`: along the beam, and, of those in an element, of one with another.
    pub(super) fn links(&self, first: usize) -> Vec<Link> {
        let link =
            |a: usize, b: usize, along| Link { nodes: [Some(first + a), Some(first + b)], rows: 0, along };
        let steps = self.steps();
        let along = (1..self.nodes().len()).map(|b| link(b - 1, b, true));
        let within = (0..self.elements()).flat_map(|e| {
            let nodes = steps * e..=steps * (e + 1);
            nodes.clone().flat_map(move |a| (a + 2..=steps * (e + 1)).map(move |b| link(a, b, false)))
        });
        along.chain(within).collect()
    }

    /// The scale of each velocity for parts of the size `length` \[m\].
    pub(super) fn scales(&self, length: f64) -> impl Iterator<Item = f64> {
        let of_node = match self {
            Beam::Slender(_) => ELEMENT_VELOCITIES,
            Beam::Shear(_) => NODE_VELOCITIES,
        };
        (0..self.velocities()).map(move |i| if i % of_node < 3 { length } else { 1.0 })
    }

    /// What the velocity `i` is, for messages.
    pub(super) fn unknown(&self, i: usize) -> String {
        let axis = ["x", "y", "z"][i % 3];
        match self {
            Beam::Slender(_) => {
                let node = i / ELEMENT_VELOCITIES;
                match i % ELEMENT_VELOCITIES {
                    k @ 0..3 => format!("velocity along {} of node {node}", ["x", "y", "z"][k]),
                    k @ 3..6 => format!("rate of the slope along {} of node {node}", ["x", "y", "z"][k - 3]),
                    6 => format!("spin of node {node}"),
                    _ => format!("spin of the middle behind node {node}"),
                }
            }
            Beam::Shear(_) => {
                let node = i / NODE_VELOCITIES;
                let what =
                    if i % NODE_VELOCITIES < 3 { "velocity along" } else { "angular velocity about its" };
                format!("{what} {axis} of node {node}")
            }
        }
    }

    /// Adds the velocities across the plane of x and y to a list, whose numbers begin at `first`: along z, and about the axes in the plane. Whether each section has
    /// an axis along z.
    pub(super) fn put_across(&self, first: usize, across: &mut Vec<usize>) -> bool {
        for node in 0..self.nodes().len() {
            let at = first + self.place(node)[1];
            across.push(at + 2);
            match self {
                Beam::Slender(_) => {
                    let end = (at + ELEMENT_VELOCITIES).min(first + self.velocities());
                    across.extend([at + 5].into_iter().chain(at + 6..end));
                }
                Beam::Shear(_) => {
                    let normal = self.node(node, self.initial()).rotation[2];
                    let Some(about) = (0..3).find(|k| normal[*k].abs() > 1.0 - ALIGNED) else { return false };
                    across.extend((0..3).filter(|k| *k != about).map(|k| at + 3 + k));
                }
            }
        }
        true
    }

    /// `out` = q ⊞ d
    pub(super) fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        match self {
            Beam::Slender(beam) => beam.retract(q, d, out),
            Beam::Shear(beam) => beam.retract(q, d, out),
        }
    }

    /// `d` = `to` ⊟ `from`
    pub(super) fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        match self {
            Beam::Slender(beam) => beam.difference(from, to, d),
            Beam::Shear(beam) => beam.difference(from, to, d),
        }
    }

    /// `out` = ḋ where the velocity in `from` ⊞ d is v.
    pub(super) fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        match self {
            Beam::Slender(beam) => beam.rate(from, d, v, out),
            Beam::Shear(beam) => beam.rate(d, v, out),
        }
    }

    /// The rotation vector in space of node `i` in the increment d from one configuration to another, where it is more than a radian. That of a
    /// slender section is the smallest one of its tangent, which is no more than half a turn, and a twist about it.
    pub(super) fn turned(&self, i: usize, from: &[f64], d: &[f64], to: &[f64]) -> Option<Vec3> {
        let at = self.place(i)[1];
        match self {
            Beam::Slender(beam) => {
                let twist = d[at + 6];
                (twist.abs() > 1.0).then(|| twist * beam.node(i, to).1.tangent)
            }
            Beam::Shear(beam) => {
                let vector = Vec3::at(d, at + 3);
                (vector.dot(vector) > 1.0).then(|| beam.node(i, from).rotation * vector)
            }
        }
    }

    /// Writes the velocities of a rigid motion: the velocity of the first node and the angular velocity, in space.
    pub(super) fn move_rigidly(&self, velocity: Vec3, spin: Vec3, q: &[f64], v: &mut [f64]) {
        match self {
            Beam::Slender(beam) => beam.move_rigidly(velocity, spin, q, v),
            Beam::Shear(beam) => beam.move_rigidly(velocity, spin, q, v),
        }
    }

    /// Adds the constant forces of a field of acceleration b, as gravity. Those of a beam with shear are no constants: its centre of mass may lie beside its
    /// axis, and they are among its [forces](Beam::add_forces).
    pub(super) fn add_weight(&self, field: Vec3, out: &mut [f64]) {
        let Beam::Slender(beam) = self else { return };
        for (e, element) in beam.elements().iter().enumerate() {
            for ([_, at], force) in self.supports(e).into_iter().zip(element.body_force(field)) {
                (0..3).for_each(|k| out[at + k] += force[k]);
            }
        }
    }

    /// Adds the forces of strain, inertia and damping, and those of the field of acceleration that are no constants.
    pub(super) fn add_forces(&self, [q, v, a]: [&[f64]; 3], field: Vec3, r: &mut [f64]) {
        match self {
            Beam::Slender(beam) => beam.add_forces(q, v, a, r),
            Beam::Shear(beam) => beam.add_forces([q, v, a], field, r),
        }
    }

    /// Adds their tangent to a matrix in which the velocities of the beam begin at `first`.
    pub(super) fn add_tangent(
        &self,
        [q, v, a]: [&[f64]; 3],
        field: Vec3,
        w: &Weights<'_>,
        (first, out): (usize, &mut Matrix),
    ) {
        match self {
            Beam::Slender(beam) => beam.add_tangent(q, v, a, w, |at, block| out.add_block(first + at, block)),
            Beam::Shear(beam) => {
                beam.add_tangent([q, v, a], field, w, |at, block| out.add_block(first + at, block));
            }
        }
    }

    /// Adds their ∂r/∂q without the part of which the [forms](Beam::strain_form) are summed strain by strain.
    pub(super) fn add_unstrained_stiffness(
        &self,
        [q, v, a]: [&[f64]; 3],
        field: Vec3,
        (first, out): (usize, &mut Matrix),
    ) {
        match self {
            Beam::Slender(beam) => {
                beam.add_unstrained_stiffness(q, v, a, |at, block| out.add_block(first + at, block));
            }
            Beam::Shear(beam) => {
                beam.add_unstrained_stiffness([q, v, a], field, |at, block| out.add_block(first + at, block));
            }
        }
    }

    /// ∫ δγᵀ C δγ ds of the strains δγ of a motion x.
    pub(super) fn strain_form(&self, q: &[f64], x: &[f64]) -> f64 {
        match self {
            Beam::Slender(beam) => beam.strain_form(q, x),
            Beam::Shear(beam) => beam.strain_form(q, x),
        }
    }

    /// Strain energy \[J\].
    pub(super) fn strain_energy(&self, q: &[f64]) -> f64 {
        match self {
            Beam::Slender(beam) => beam.strain_energy(q),
            Beam::Shear(beam) => beam.strain_energy(q),
        }
    }

    /// Kinetic energy \[J\].
    pub(super) fn kinetic_energy(&self, q: &[f64], v: &[f64]) -> f64 {
        match self {
            Beam::Slender(beam) => beam.kinetic_energy(q, v),
            Beam::Shear(beam) => beam.kinetic_energy(q, v),
        }
    }

    /// Power \[W\] that the damping of the strains takes.
    pub(super) fn viscous_power(&self, q: &[f64], v: &[f64]) -> f64 {
        match self {
            Beam::Slender(beam) => beam.viscous_power(q, v),
            Beam::Shear(beam) => beam.viscous_power(q, v),
        }
    }

    /// Momentum and angular momentum about the origin.
    pub(super) fn momenta(&self, q: &[f64], v: &[f64]) -> [Vec3; 2] {
        match self {
            Beam::Slender(beam) => beam.momenta(q, v),
            Beam::Shear(beam) => beam.momenta(q, v),
        }
    }

    /// The mass times its centre [kg·m].
    pub(super) fn first_moment(&self, q: &[f64]) -> Vec3 {
        match self {
            Beam::Slender(beam) => beam.first_moment(q),
            Beam::Shear(beam) => beam.first_moment(q),
        }
    }

    /// A marker that a node moves, whose velocities begin at `first`.
    pub(super) fn pose(&self, first: usize) -> Pose {
        match self {
            Beam::Slender(_) => Pose::moved(first, ELEMENT_VELOCITIES - 1),
            Beam::Shear(_) => Pose::moved(first, NODE_VELOCITIES),
        }
    }

    /// Places a marker at node `i`, with its frame in the axes of the section.
    #[inline]
    pub(super) fn place_marker(&self, i: usize, [q, v, a]: [&[f64]; 3], marker: &Frame, pose: &mut Pose) {
        let [at, rates] = self.place(i);
        let (q, v, a) = (&q[at..], &v[rates..], &a[rates..]);
        match self {
            Beam::Slender(_) => pose.place_on_section([q, v, a], marker),
            Beam::Shear(_) => pose.place(&Placed::new(q, v, a), marker),
        }
    }

    /// Rotations of the velocities since a configuration before, which begin at `first`.
    pub(super) fn corotate(&self, [before, now]: [&[f64]; 2], first: usize, out: &mut Corotation) {
        for i in 0..self.nodes().len() {
            let (turned, at) = (self.rotation(i, before, now), first + self.place(i)[1]);
            match self {
                Beam::Slender(_) => out.push_vectors::<2>(at, turned.0),
                // Ω is in the axes of the section.
                Beam::Shear(_) => out.push_vectors::<1>(at, turned.0),
            }
        }
    }

    /// The rotation of node `i` from one configuration to another.
    pub(super) fn rotation(&self, i: usize, before: &[f64], now: &[f64]) -> Mat3 {
        self.node(i, now).rotation * self.node(i, before).rotation.transpose()
    }

    /// The largest |(ṙ′, w)| of the nodes of a slender beam, or |Ω|.
    pub(super) fn turning(&self, v: &[f64]) -> f64 {
        let end = match self {
            Beam::Slender(_) => ELEMENT_VELOCITIES - 1,
            Beam::Shear(_) => NODE_VELOCITIES,
        };
        let square = |i: usize| {
            let at = self.place(i)[1];
            v[at + 3..at + end].iter().map(|x| x * x).sum::<f64>()
        };
        (0..self.nodes().len()).map(square).fold(0.0, f64::max).sqrt()
    }

    /// The weights of a load along the beam.
    pub(super) fn distribution(&self, load: &LineLoad) -> LineDistribution {
        let count = self.elements();
        let on = load.elements.clone().map_or(0..count, |on| on.start.min(count)..on.end.min(count));
        let (first, f) = (on.start, load.distribution.as_deref());
        let stations = drawn(f, [self.end(on.start), self.end(on.end)], self.end(count));
        let cuts = f.map_or_else(Vec::new, |f| cuts((on.start..=on.end).map(|e| self.end(e)).collect(), f));
        let f = (f, cuts.as_slice());
        let mut rows = Vec::new();
        for e in on {
            let (h, ends) = (self.length(e), [self.end(e), self.end(e + 1)]);
            match self {
                Beam::Slender(_) if f.0.is_none() => rows.extend(slender::uniform_weights(h)),
                Beam::Slender(_) => rows.extend(weights(h, ends, f, sample, |z| hermite(z, h)[0])),
                Beam::Shear(_) => {
                    let shapes = |z| shear::lagrange(z)[0];
                    rows.extend(weights(h, ends, f, shapes, shapes));
                }
            }
        }
        LineDistribution { first, rows, stations }
    }

    /// Adds the forces of a load per length [N/m], with components in fixed axes or in those of the sections.
    pub(super) fn add_line_load(
        &self,
        on: &LineDistribution,
        q: &[f64],
        load: Vec3,
        follows: bool,
        r: &mut [f64],
    ) {
        match self {
            Beam::Slender(beam) => beam.add_line_load(on, q, load, follows, r),
            Beam::Shear(beam) => beam.add_line_load(on, q, load, follows, r),
        }
    }

    /// Power \[W\] of a load per length.
    pub(super) fn line_power(
        &self,
        on: &LineDistribution,
        [q, v]: [&[f64]; 2],
        load: Vec3,
        follows: bool,
    ) -> f64 {
        match self {
            Beam::Slender(beam) => beam.line_power(on, q, v, load, follows),
            Beam::Shear(beam) => beam.line_power(on, q, v, load, follows),
        }
    }

    /// Adds the derivative of the forces of a load that follows the sections to a matrix in which the velocities of the beam begin at
    /// `first`: by the increment d since the configuration that was retracted, or by variations.
    pub(super) fn add_line_tangent(
        &self,
        on: &LineDistribution,
        q: &[f64],
        load: Vec3,
        d: Option<&[f64]>,
        (first, out): (usize, &mut Matrix),
    ) {
        match self {
            Beam::Slender(beam) => {
                beam.add_line_tangent(on, q, load, d, |at, block| out.add_block(first + at, block));
            }
            Beam::Shear(beam) => {
                beam.add_line_tangent(on, q, load, d, |at, block| out.add_block(first + at, block));
            }
        }
    }
}
