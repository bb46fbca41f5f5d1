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

use super::element::{Element, Motion, NODE_COORDINATES, NODE_VELOCITIES, Tangent, VELOCITIES};
use super::shapes::POINTS;
use crate::linalg::{Mat3, Vec3};
use crate::multibody::rotation::{Quaternion, rate};
use crate::section::Matrices;
use crate::system::{Frame, Weights};

/// Why no beam can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum BeamError {
    /// The ends of the elements are not ascending, or fewer than two.
    #[error(
        "the elements of a beam must end at two or more ascending arc lengths: number {number} is {at} m"
    )]
    Ends {
        /// Number of the end.
        number: usize,
        /// Its arc length \[m\].
        at: f64,
    },
    /// The axes of a section are no rotation, or its position is not finite.
    #[error("the axes of the section at s = {at} m must be unit vectors at right angles, right-handed")]
    Axes {
        /// Arc length \[m\].
        at: f64,
    },
    /// The sections of an element are too far apart in orientation.
    #[error(
        "the beam turns by {angle:.0}° within the element from s = {at} m: it must stay below 90°; take more elements"
    )]
    Turned {
        /// Arc length of the element's begin \[m\].
        at: f64,
        /// Angle \[°\].
        angle: f64,
    },
    /// A quantity of a section is out of range.
    #[error("the section at s = {at} m: {what}")]
    Section {
        /// Arc length \[m\].
        at: f64,
        /// What is wrong.
        what: &'static str,
    },
}

/// A beam with shear. See the [module documentation](super).
#[derive(Clone, Debug)]
pub struct Beam {
    elements: Vec<Element>,
    initial: Vec<f64>,
    /// Arc lengths of the nodes \[m\].
    nodes: Vec<f64>,
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
        if ends.len() < 2 {
            return Err(BeamError::Ends { number: ends.len(), at: ends.first().copied().unwrap_or(0.0) });
        }
        for (number, &at) in ends.iter().enumerate() {
            if !at.is_finite() || number > 0 && !(at > ends[number - 1]) {
                return Err(BeamError::Ends { number, at });
            }
        }
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
        Ok(Beam { elements, initial, nodes })
    }

    /// A straight beam of equal sections and `elements` elements of equal length along the first axis of `root`.
    ///
    /// # Errors
    /// See [`Beam::new`].
    pub fn straight(root: Frame, length: f64, elements: usize, section: Matrices) -> Result<Beam, BeamError> {
        let ends: Vec<f64> = (0..=elements).map(|i| length * i as f64 / elements.max(1) as f64).collect();
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

    /// Adds the forces of strain, damping and inertia to `r`. A field of acceleration b, as gravity, acts as the accelerations
    /// r̈ − b.
    pub fn add_forces(&self, q: &[f64], v: &[f64], a: &[f64], r: &mut [f64]) {
        for (element, i, j) in self.places() {
            let motion = Motion { q: part(q, i), v: part(v, j), a: part(a, j) };
            let mut forces = [0.0; VELOCITIES];
            element.add_forces(&motion, &mut forces);
            r[j..].iter_mut().zip(forces).for_each(|(r, force)| *r += force);
        }
    }

    /// Hands the tangent w.q ∂r/∂d + w.v ∂r/∂v + w.a ∂r/∂a of each element to `add`, with the number of its first velocity.
    /// ∂r/∂d is that by the increment d since the configuration that was retracted, `w.increment`.
    pub fn add_tangent(
        &self,
        q: &[f64],
        v: &[f64],
        a: &[f64],
        w: &Weights<'_>,
        mut add: impl FnMut(usize, &Tangent),
    ) {
        for (element, i, j) in self.places() {
            let motion = Motion { q: part(q, i), v: part(v, j), a: part(a, j) };
            let mut tangent = [[0.0; VELOCITIES]; VELOCITIES];
            let w = Weights { increment: w.increment.map(|d| &d[j..]), ..*w };
            element.add_tangent(&motion, &w, &mut tangent);
            add(j, &tangent);
        }
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
