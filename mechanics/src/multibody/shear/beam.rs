//! A chain of elements: its unknowns, and the space of its configurations.
//!
//! Nodes follow each other along the beam, those at the ends of elements and those between them alike, each a frame as that of a
//! rigid body:
//!
//! ```text
//! q = (r, p | r, p | …),    v = (ṙ, Ω | ṙ, Ω | …),    Λ̇ = Λ Ω̃
//! ```
//!
//! An increment d = (d_r, d_φ | …) moves a node to r + d_r and p exp d_φ, so that Ω = T(d_φ) ḋ_φ.

use super::element::{Element, Motion, NODE_COORDINATES, NODE_VELOCITIES, Sample, Tangent, VELOCITIES};
use super::shapes::{NODES, POINTS};
use crate::linalg::{Mat3, Vec3};
use crate::multibody::error::{BeamError, equal_ends};
use crate::multibody::line_load::LineDistribution;
use crate::multibody::rotation::{Quaternion, rate, tangent};
use crate::section::Matrices;
use crate::system::{Frame, Weights};

/// A beam with shear. See the [module documentation](super).
#[derive(Clone, Debug)]
pub struct Beam {
    elements: Vec<Element>,
    initial: Vec<f64>,
    /// Arc lengths of the nodes \[m\].
    nodes: Vec<f64>,
    /// β [1/s], and the η \[s\] that the elements have beside the damping of their sections.
    damping: f64,
    viscosity: f64,
}

impl Beam {
    /// A beam of elements between the ascending arc lengths `ends` \[m\], whose sections without stress have the positions and axes
    /// `curve(s)`, and the properties `section(s)` in these axes. The first axis need not be the tangent of the curve. Sections may
    /// jump at the ends of elements: each element takes the limits within it.
    ///
    /// # Errors
    /// [`BeamError`]: no mesh, no axes, an element that turns too far, or a section without positive energies.
    pub fn new(
        ends: &[f64],
        curve: impl Fn(f64) -> Frame,
        section: impl Fn(f64) -> Matrices,
    ) -> Result<Beam, BeamError> {
        BeamError::of_ends(ends)?;
        let mut nodes = vec![ends[0]];
        for ends in ends.windows(2) {
            nodes.extend(Element::places()[1..].iter().map(|z| ends[0] + z * (ends[1] - ends[0])));
        }
        let mut initial = Vec::with_capacity(NODE_COORDINATES * nodes.len());
        for &s in &nodes {
            let Frame { position, rotation } = curve(s);
            let product = rotation * rotation.transpose() - Mat3::IDENTITY;
            let defect = product.0.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            if !(position.is_finite() && defect < 1e-9 && rotation.determinant() > 0.0) {
                return Err(BeamError::Axes { at: s });
            }
            initial.extend(position);
            initial.extend(Quaternion::from(rotation).0);
        }
        let mut elements: Vec<Element> = Vec::with_capacity(ends.len() - 1);
        for (e, ends) in ends.windows(2).enumerate() {
            let (begin, length) = (ends[0], ends[1] - ends[0]);
            let within = |z: f64| (begin + z * length).clamp(begin.next_up(), ends[1].next_down());
            for z in [0.0, 0.25, 0.5, 0.75, 1.0] {
                if let Some(what) = section(within(z)).fault() {
                    return Err(BeamError::Section { at: begin + z * length, what });
                }
            }
            let q = part(&initial, NODE_COORDINATES * POINTS * e);
            let element = Element::new(length, q, |z| section(within(z)), elements.last());
            let angle = element.turn(q).to_degrees();
            if !(angle < 90.0) {
                return Err(BeamError::Turned { at: begin, angle });
            }
            elements.push(element);
        }
        Ok(Beam { elements, initial, nodes, damping: 0.0, viscosity: 0.0 })
    }

    /// A straight beam of equal sections and `elements` elements of equal length along the first axis of `root`.
    ///
    /// # Errors
    /// See [`Beam::new`].
    pub fn straight(root: Frame, length: f64, elements: usize, section: Matrices) -> Result<Beam, BeamError> {
        let ends = equal_ends(length, elements);
        let at = |s: f64| Frame { position: root.position + s * root.rotation.column(0), ..root };
        Beam::new(&ends, at, |_| section)
    }

    /// The elements, from the first on.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Arc lengths of the nodes \[m\], those within elements too.
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Number of coordinates q.
    pub fn coordinates(&self) -> usize {
        NODE_COORDINATES * self.nodes.len()
    }

    /// Number of velocities v.
    pub fn velocities(&self) -> usize {
        NODE_VELOCITIES * self.nodes.len()
    }

    /// Part of a deflection that rounding may take: ε of the stiffness in shear GA/h of an element, over that of the beam in bending EI/L³.
    pub fn rounding(&self) -> f64 {
        let length: f64 = self.elements.iter().map(Element::length).sum();
        let (mut shear, mut bending) = (0.0_f64, f64::INFINITY);
        for element in &self.elements {
            let [stiff, soft] = element.shear_and_bending();
            (shear, bending) = (shear.max(stiff / element.length()), bending.min(soft));
        }
        0.5 * f64::EPSILON * shear * length.powi(3) / bending
    }

    /// Half-bandwidth of the tangent.
    pub fn half_bandwidth(&self) -> usize {
        VELOCITIES - 1
    }

    /// The configuration without stress.
    pub fn initial(&self) -> &[f64] {
        &self.initial
    }

    /// Position and axes of node `i`.
    pub fn node(&self, i: usize, q: &[f64]) -> Frame {
        let at = NODE_COORDINATES * i;
        Frame { position: Vec3::at(q, at), rotation: Quaternion::at(q, at + 3).matrix() }
    }

    /// The elements with the begin of their coordinates and velocities.
    fn places(&self) -> impl Iterator<Item = (&Element, usize, usize)> {
        let place = |(e, element)| (element, NODE_COORDINATES * POINTS * e, NODE_VELOCITIES * POINTS * e);
        self.elements.iter().enumerate().map(place)
    }

    /// `out` = q ⊞ d
    pub fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        for node in 0..self.nodes.len() {
            let (i, j) = (NODE_COORDINATES * node, NODE_VELOCITIES * node);
            (Vec3::at(q, i) + Vec3::at(d, j)).put(out, i);
            let turned = Quaternion::at(q, i + 3) * Quaternion::exponential(Vec3::at(d, j + 3));
            out[i + 3..i + NODE_COORDINATES].copy_from_slice(&turned.normalized().0);
        }
    }

    /// `d` = `to` ⊟ `from`; |d_φ| ≤ π.
    pub fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        for node in 0..self.nodes.len() {
            let (i, j) = (NODE_COORDINATES * node, NODE_VELOCITIES * node);
            (Vec3::at(to, i) - Vec3::at(from, i)).put(d, j);
            (Quaternion::at(from, i + 3).inverse() * Quaternion::at(to, i + 3)).logarithm().put(d, j + 3);
        }
    }

    /// `out` = ḋ = T(d)⁻¹ v, the rate of the increment d where the velocity is v.
    pub fn rate(&self, d: &[f64], v: &[f64], out: &mut [f64]) {
        for node in 0..self.nodes.len() {
            let j = NODE_VELOCITIES * node;
            Vec3::at(v, j).put(out, j);
            rate(Vec3::at(d, j + 3), Vec3::at(v, j + 3)).put(out, j + 3);
        }
    }

    /// Writes the velocities of a rigid motion: the velocity of the first node and the angular velocity, both in space.
    pub fn move_rigidly(&self, velocity: Vec3, spin: Vec3, q: &[f64], v: &mut [f64]) {
        let origin = Vec3::at(q, 0);
        for node in 0..self.nodes.len() {
            let Frame { position, rotation } = self.node(node, q);
            (velocity + spin.cross(position - origin)).put(v, NODE_VELOCITIES * node);
            (rotation.transpose() * spin).put(v, NODE_VELOCITIES * node + 3);
        }
    }

    /// Sets the damping β [1/s] in proportion to the mass, forces −β M v, and one of η \[s\] in proportion to the
    /// stiffness beside that of the sections, D + η C.
    pub fn damp(&mut self, mass: f64, stiffness: f64) {
        self.damping = mass;
        // The elements of a model that is built anew have η C already.
        let more = stiffness - std::mem::replace(&mut self.viscosity, stiffness);
        if more != 0.0 {
            let mut last: Option<(Element, Element)> = None;
            for element in &mut self.elements {
                let like = last.as_ref().filter(|(before, _)| before.is_like(element)).map(|(_, now)| now);
                let damped = element.damped(more, like);
                last = Some((std::mem::replace(element, damped.clone()), damped));
            }
        }
    }

    /// r̈ − b + β ṙ and Ω̇ + β Ω of an element in a field of acceleration b: the forces of inertia are then those of field and damping too.
    fn accelerations(&self, v: &[f64; VELOCITIES], a: &[f64; VELOCITIES], field: Vec3) -> [f64; VELOCITIES] {
        std::array::from_fn(|k| {
            let along = k % NODE_VELOCITIES;
            a[k] + self.damping * v[k] - if along < 3 { field[along] } else { 0.0 }
        })
    }

    /// Adds the forces of strain, damping and inertia, and those of a field of acceleration b, as gravity, to `r`.
    pub fn add_forces(&self, [q, v, a]: [&[f64]; 3], field: Vec3, r: &mut [f64]) {
        for (element, i, j) in self.places() {
            let a = self.accelerations(part(v, j), part(a, j), field);
            let motion = Motion { q: part(q, i), v: part(v, j), a: &a };
            let mut forces = [0.0; VELOCITIES];
            element.add_forces(&motion, &mut forces);
            r[j..].iter_mut().zip(forces).for_each(|(r, force)| *r += force);
        }
    }

    /// Hands the tangent w.q ∂r/∂d + w.v ∂r/∂v + w.a ∂r/∂a of each element to `add`, with the number of its first velocity.
    /// ∂r/∂d is that by the increment d since the configuration that was retracted, `w.increment`.
    pub fn add_tangent(
        &self,
        [q, v, a]: [&[f64]; 3],
        field: Vec3,
        w: &Weights<'_>,
        mut add: impl FnMut(usize, &Tangent),
    ) {
        for (element, i, j) in self.places() {
            let a = self.accelerations(part(v, j), part(a, j), field);
            let motion = Motion { q: part(q, i), v: part(v, j), a: &a };
            let mut tangent = [[0.0; VELOCITIES]; VELOCITIES];
            let w = Weights { increment: w.increment.map(|d| &d[j..]), a: w.a + self.damping * w.v, ..*w };
            element.add_tangent(&motion, &w, &mut tangent);
            add(j, &tangent);
        }
    }

    /// The same of ∂r/∂q without the part of which the [forms](Beam::strain_form) are summed strain by strain.
    pub fn add_unstrained_stiffness(
        &self,
        [q, v, a]: [&[f64]; 3],
        field: Vec3,
        mut add: impl FnMut(usize, &Tangent),
    ) {
        for (element, i, j) in self.places() {
            let a = self.accelerations(part(v, j), part(a, j), field);
            let motion = Motion { q: part(q, i), v: part(v, j), a: &a };
            let mut tangent = [[0.0; VELOCITIES]; VELOCITIES];
            element.add_unstrained_stiffness(&motion, &mut tangent);
            add(j, &tangent);
        }
    }

    /// ∫ δeᵀ C δe ds of the strains δe of a motion x.
    pub fn strain_form(&self, q: &[f64], x: &[f64]) -> f64 {
        self.places().map(|(element, i, j)| element.strain_form(part(q, i), part(x, j))).sum()
    }

    /// The place z, 0 to 1, of an element: position and axes.
    pub fn section(&self, q: &[f64], element: usize, z: f64) -> Frame {
        self.elements[element].section(part(q, NODE_COORDINATES * POINTS * element), z)
    }

    /// Strains and stress resultants of an element at its quadrature points.
    pub fn samples(&self, q: &[f64], element: usize) -> [Sample; POINTS] {
        self.elements[element].samples(part(q, NODE_COORDINATES * POINTS * element))
    }

    /// Largest angle \[rad\] by which a section of an element is rotated against its reference section.
    pub fn turn(&self, q: &[f64], element: usize) -> f64 {
        self.elements[element].turn(part(q, NODE_COORDINATES * POINTS * element))
    }

    /// Calls `visit` with the forces of a load per length: the number of the first velocity of a node, and its force.
    fn line_forces(
        &self,
        on: &LineDistribution,
        q: &[f64],
        load: Vec3,
        follows: bool,
        mut visit: impl FnMut(usize, Vec3),
    ) {
        for (e, rows) in (on.first..).zip(on.rows.as_chunks::<NODES>().0) {
            let first = POINTS * e;
            for (k, row) in rows.iter().enumerate() {
                let force = if follows { self.node(first + k, q).rotation * load } else { load };
                for (i, weight) in row.iter().enumerate() {
                    visit(NODE_VELOCITIES * (first + i), *weight * force);
                }
            }
        }
    }

    /// Adds the forces of a load per length [N/m], with components in fixed axes or in those of the sections.
    pub(in crate::multibody) fn add_line_load(
        &self,
        on: &LineDistribution,
        q: &[f64],
        load: Vec3,
        follows: bool,
        r: &mut [f64],
    ) {
        self.line_forces(on, q, load, follows, |at, force| force.add_to(r, at));
    }

    /// Hands the derivative of the forces of a load that follows the sections to `add`, element by element, with the number of its
    /// first velocity: by the increment d since the configuration that was retracted, or by variations.
    pub(in crate::multibody) fn add_line_tangent(
        &self,
        on: &LineDistribution,
        q: &[f64],
        load: Vec3,
        increment: Option<&[f64]>,
        mut add: impl FnMut(usize, &Tangent),
    ) {
        for (e, rows) in (on.first..).zip(on.rows.as_chunks::<NODES>().0) {
            let (first, mut out) = (POINTS * e, [[0.0; VELOCITIES]; VELOCITIES]);
            for (k, row) in rows.iter().enumerate() {
                // δ(Λ p) = −Λ p̃ δφ
                let rotation = self.node(first + k, q).rotation;
                let at = NODE_VELOCITIES * (first + k) + 3;
                let turn = increment.map_or(Mat3::IDENTITY, |d| tangent(Vec3::at(d, at)));
                let change = -1.0 * (rotation * Mat3::skew(load) * turn);
                for (i, weight) in row.iter().enumerate() {
                    for a in 0..3 {
                        for b in 0..3 {
                            out[NODE_VELOCITIES * i + a][NODE_VELOCITIES * k + 3 + b] +=
                                weight * change[a][b];
                        }
                    }
                }
            }
            add(NODE_VELOCITIES * first, &out);
        }
    }

    /// Power \[W\] of a load per length.
    pub(in crate::multibody) fn line_power(
        &self,
        on: &LineDistribution,
        q: &[f64],
        v: &[f64],
        load: Vec3,
        follows: bool,
    ) -> f64 {
        let mut power = 0.0;
        self.line_forces(on, q, load, follows, |at, force| power += force.dot(Vec3::at(v, at)));
        power
    }

    /// Strain energy \[J\].
    pub fn strain_energy(&self, q: &[f64]) -> f64 {
        self.places().map(|(element, i, _)| element.strain_energy(part(q, i))).sum()
    }

    /// Kinetic energy \[J\].
    pub fn kinetic_energy(&self, q: &[f64], v: &[f64]) -> f64 {
        self.places().map(|(element, i, j)| element.kinetic_energy(part(q, i), part(v, j))).sum()
    }

    /// Power \[W\] that the damping takes.
    pub fn viscous_power(&self, q: &[f64], v: &[f64]) -> f64 {
        self.places().map(|(element, i, j)| element.viscous_power(part(q, i), part(v, j))).sum()
    }

    /// Momentum and angular momentum about the origin.
    pub fn momenta(&self, q: &[f64], v: &[f64]) -> [Vec3; 2] {
        self.places().fold([Vec3::ZERO; 2], |[p, l], (element, i, j)| {
            let [linear, angular] = element.momenta(part(q, i), part(v, j));
            [p + linear, l + angular]
        })
    }

    /// The mass times its centre [kg·m].
    pub fn first_moment(&self, q: &[f64]) -> Vec3 {
        self.places().fold(Vec3::ZERO, |sum, (element, i, _)| sum + element.first_moment(part(q, i)))
    }

    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.elements.iter().map(Element::mass).sum()
    }
}

/// The `N` entries from `at` on.
#[inline(always)]
fn part<const N: usize>(x: &[f64], at: usize) -> &[f64; N] {
    x[at..at + N].first_chunk().unwrap_or(const { &[0.0; N] })
}
