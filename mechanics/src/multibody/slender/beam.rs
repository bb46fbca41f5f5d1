//! A chain of elements: its unknowns, and the space of its configurations.
//!
//! Node by node, with the section in the middle of the following element behind each: 12 coordinates and 8 velocities an
//! element, and 9 and 7 at the end,
//!
//! ```text
//! q = (r, r′, n | nₘ | r, r′, n | …),    v = (ṙ, ṙ′, w | wₘ | ṙ, ṙ′, w | …)
//! ```
//!
//! An increment d = (δr, δr′, φ | φₘ | …) moves r and r′ as vectors; each n follows its tangent by the smallest rotation, and
//! rotates about it by φ. Of this motion the spin is w = φ̇ − c·ṙ′/|r′|, with c of the tangents before and now
//! ([`Pair`]): that is v = T(d) ḋ.

use super::element::{Element, Motion, Sample, Tangent};
use super::loads::LineWeights;
use super::pair::{Pair, spin_by_slope};
use super::properties::Properties;
use super::shapes::POINTS;
use super::strain::{COORDINATES, VELOCITIES, centreline, positions};
use super::triad::Triad;
use crate::linalg::Vec3;
use crate::linalg::vector::inner;
use crate::multibody::error::{BeamError, equal_ends};
use crate::multibody::line_load::LineDistribution;
use crate::system::Weights;

/// Coordinates of an element that the next one does not share.
pub const ELEMENT_COORDINATES: usize = 12;
/// Velocities of an element that the next one does not share.
pub const ELEMENT_VELOCITIES: usize = 8;

/// A point of the centreline without stress.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// r \[m\]
    pub position: Vec3,
    /// t, a unit vector.
    pub tangent: Vec3,
    /// n, a unit vector across t.
    pub normal: Vec3,
}

/// A slender beam. See the [module documentation](super).
#[derive(Clone, Debug)]
pub struct Beam {
    elements: Vec<Element>,
    initial: Vec<f64>,
    /// Arc lengths of the nodes \[m\].
    nodes: Vec<f64>,
}

impl Beam {
    /// A beam with nodes at the ascending arc lengths `nodes` \[m\], whose centreline without stress is `curve(s)`, with the
    /// sections `section(s)` in its axes.
    ///
    /// # Errors
    /// [`BeamError`]: no mesh, no axes, an element that turns too far, or a section without positive energies.
    pub fn new(
        nodes: &[f64],
        curve: impl Fn(f64) -> Station,
        section: impl Fn(f64) -> Properties,
    ) -> Result<Beam, BeamError> {
        BeamError::of_ends(nodes)?;
        let mut initial = Vec::with_capacity(ELEMENT_COORDINATES * nodes.len());
        let station = |s: f64| {
            let at = curve(s);
            let one = |x: Vec3, y: Vec3, c: f64| (x.dot(y) - c).abs() < 1e-9;
            let (t, n) = (at.tangent, at.normal);
            let axes = one(t, t, 1.0) && one(n, n, 1.0) && one(t, n, 0.0);
            if axes && at.position.dot(at.position).is_finite() {
                Ok(at)
            } else {
                Err(BeamError::Axes { at: s })
            }
        };
        for (i, &s) in nodes.iter().enumerate() {
            let now = station(s)?;
            if i > 0 {
                // n in the middle is placed when both ends are known.
                let at = station(0.5 * (nodes[i - 1] + s))?;
                initial.extend(at.normal);
            }
            initial.extend([now.position, now.tangent, now.normal].into_iter().flatten());
        }
        let mut elements = Vec::with_capacity(nodes.len() - 1);
        for (e, ends) in nodes.windows(2).enumerate() {
            let (s, length) = (ends[0], ends[1] - ends[0]);
            validate(&section, s, length)?;
            let begin = ELEMENT_COORDINATES * e;
            let mut q: [f64; COORDINATES] = *part(&initial, begin);
            let element = Element::new(length, &q, |z| section(s + z * length), elements.last());
            let slope = element.middle_slope(&positions(&q));
            let middle = curve(s + 0.5 * length);
            let halfway = middle.tangent;
            let middle = Triad::new(middle.tangent, middle.normal).transported(slope, 0.0);
            middle.normal.put(&mut q, 9);
            middle.normal.put(&mut initial, begin + 9);
            let element = Element::new(length, &q, |z| section(s + z * length), elements.last());
            // By the middle, for the ends alone do not tell 300° from 60°.
            let turned = |at: usize| libm::acos(halfway.dot(Vec3::at(&q, at)).clamp(-1.0, 1.0));
            let twist = element.pairs(&q).into_iter().map(|pair| pair.angle.abs()).fold(0.0, f64::max);
            let angle = (turned(3) + turned(15)).max(twist).to_degrees();
            if !(angle < 90.0) {
                return Err(BeamError::Turned { at: s, angle });
            }
            elements.push(element);
        }
        Ok(Beam { elements, initial, nodes: nodes.to_vec() })
    }

    /// A straight beam of equal sections and `elements` elements of equal length.
    ///
    /// # Errors
    /// See [`Beam::new`].
    pub fn straight(
        root: Station,
        length: f64,
        elements: usize,
        section: Properties,
    ) -> Result<Beam, BeamError> {
        let nodes = equal_ends(length, elements);
        let at = |s: f64| Station { position: root.position + s * root.tangent, ..root };
        Beam::new(&nodes, at, |_| section)
    }

    /// The elements, from the first node on.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Sets the damping β [1/s] in proportion to the mass: forces −β M v.
    pub fn damp(&mut self, damping: f64) {
        self.elements.iter_mut().for_each(|element| element.damp(damping));
    }

    /// Sets the damping η \[s\] in proportion to the stiffness (Kelvin–Voigt): stresses C (γ − γ₀ + η γ̇).
    pub fn make_viscous(&mut self, viscosity: f64) {
        self.elements.iter_mut().for_each(|element| element.make_viscous(viscosity));
    }

    /// Power \[W\] that the damping in proportion to the stiffness takes.
    pub fn viscous_power(&self, q: &[f64], v: &[f64]) -> f64 {
        self.middles().map(|(element, i, j)| element.viscous_power(part(q, i), part(v, j))).sum()
    }

    /// Arc lengths of the nodes \[m\].
    pub fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Number of coordinates q.
    pub fn coordinates(&self) -> usize {
        self.initial.len()
    }

    /// Number of velocities v.
    pub fn velocities(&self) -> usize {
        ELEMENT_VELOCITIES * self.elements.len() + 7
    }

    /// Half-bandwidth of the tangent.
    pub fn half_bandwidth(&self) -> usize {
        VELOCITIES - 1
    }

    /// The configuration without stress.
    pub fn initial(&self) -> &[f64] {
        &self.initial
    }

    /// Position and axes of node `i`; its velocities begin at 8 i.
    pub fn node(&self, i: usize, q: &[f64]) -> (Vec3, Triad) {
        let at = ELEMENT_COORDINATES * i;
        (Vec3::at(q, at), Triad::new(Vec3::at(q, at + 3), Vec3::at(q, at + 6)))
    }

    /// The place z, 0 to 1, of an element: position and axes.
    pub fn section(&self, q: &[f64], element: usize, z: f64) -> (Vec3, Triad) {
        self.elements[element].section(part(q, ELEMENT_COORDINATES * element), z)
    }

    /// Strains and stress resultants of an element at its quadrature points.
    pub fn samples(&self, q: &[f64], element: usize) -> [Sample; POINTS] {
        self.elements[element].samples(part(q, ELEMENT_COORDINATES * element))
    }

    /// The larger κ·M/EA of an element with its place z, where it is `least` or more.
    pub fn bending(&self, q: &[f64], element: usize, least: f64) -> Option<(f64, f64)> {
        self.elements[element].bending(part(q, ELEMENT_COORDINATES * element), least)
    }

    /// Whether an element is twisted by more than half a turn.
    pub fn is_wound(&self, q: &[f64], element: usize) -> bool {
        self.elements[element].is_wound(part(q, ELEMENT_COORDINATES * element))
    }

    /// Writes the velocities of a rigid motion: the velocity of the first node and the angular velocity, both in space.
    pub fn move_rigidly(&self, velocity: Vec3, spin: Vec3, q: &[f64], v: &mut [f64]) {
        let (origin, _) = self.node(0, q);
        for node in 0..self.nodes.len() {
            let (position, triad) = self.node(node, q);
            let at = ELEMENT_VELOCITIES * node;
            let slope = triad.length * triad.tangent;
            (velocity + spin.cross(position - origin)).put(v, at);
            spin.cross(slope).put(v, at + 3);
            v[at + 6] = spin.dot(triad.tangent);
            if node < self.elements.len() {
                v[at + 7] = spin.dot(self.section(q, node, 0.5).1.tangent);
            }
        }
    }

    /// The elements under a load, with the begin of their coordinates and velocities and the weights of the load.
    fn under<'a>(
        &'a self,
        on: &'a LineDistribution,
    ) -> impl Iterator<Item = ((&'a Element, usize, usize), &'a LineWeights)> {
        self.middles().skip(on.first).zip(on.rows.as_chunks().0)
    }

    /// The middle sections of the elements: element, its coordinates' and velocities' begin.
    fn middles(&self) -> impl Iterator<Item = (&Element, usize, usize)> {
        let places = |(e, element)| (element, ELEMENT_COORDINATES * e, ELEMENT_VELOCITIES * e);
        self.elements.iter().enumerate().map(places)
    }

    /// r′ in the middle of an element whose coordinates begin at `at`.
    fn middle_slope(element: &Element, q: &[f64], at: usize) -> Vec3 {
        element.middle_slope(&positions(part(q, at)))
    }

    /// `out` = q ⊞ d
    pub fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        for node in 0..=self.elements.len() {
            let (i, j) = (ELEMENT_COORDINATES * node, ELEMENT_VELOCITIES * node);
            for k in 0..6 {
                out[i + k] = q[i + k] + d[j + k];
            }
            let before = Triad::new(Vec3::at(q, i + 3), Vec3::at(q, i + 6));
            let now = before.transported(Vec3::at(out, i + 3), d[j + 6]);
            now.normal.put(out, i + 6);
        }
        for (element, i, j) in self.middles() {
            let before = Triad::new(Beam::middle_slope(element, q, i), Vec3::at(q, i + 9));
            let now = before.transported(Beam::middle_slope(element, out, i), d[j + 7]);
            now.normal.put(out, i + 9);
        }
    }

    /// `d` = `to` ⊟ `from`; φ lies between −π and π.
    pub fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        for node in 0..=self.elements.len() {
            let (i, j) = (ELEMENT_COORDINATES * node, ELEMENT_VELOCITIES * node);
            for k in 0..6 {
                d[j + k] = to[i + k] - from[i + k];
            }
            d[j + 6] = Pair::new(&self.node(node, from).1, &self.node(node, to).1).angle;
        }
        for (element, i, j) in self.middles() {
            let triad = |q: &[f64]| Triad::new(Beam::middle_slope(element, q, i), Vec3::at(q, i + 9));
            d[j + 7] = Pair::new(&triad(from), &triad(to)).angle;
        }
    }

    /// `out` = ḋ = T(d)⁻¹ v, the rate of the increment d in `from` ⊞ d where the velocity is v.
    pub fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        out.copy_from_slice(v);
        let turn = |from: Vec3, d: Vec3, rate: Vec3| spin_by_slope(from, d).dot(rate);
        for node in 0..=self.elements.len() {
            let (i, j) = (ELEMENT_COORDINATES * node, ELEMENT_VELOCITIES * node);
            out[j + 6] -= turn(Vec3::at(from, i + 3), Vec3::at(d, j + 3), Vec3::at(v, j + 3));
        }
        for (element, i, j) in self.middles() {
            let rates = |x: &[f64]| element.middle_slope(&centreline(part(x, j)));
            out[j + 7] -= turn(Beam::middle_slope(element, from, i), rates(d), rates(v));
        }
    }

    /// Adds the forces of strain and inertia to `r`: r = M a + … + ∂U/∂q.
    pub fn add_forces(&self, q: &[f64], v: &[f64], a: &[f64], r: &mut [f64]) {
        for (element, i, j) in self.middles() {
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
        for (element, i, j) in self.middles() {
            let motion = Motion { q: part(q, i), v: part(v, j), a: part(a, j) };
            let mut tangent = [[0.0; VELOCITIES]; VELOCITIES];
            let w = Weights { increment: w.increment.map(|d| &d[j..]), ..*w };
            element.add_tangent(&motion, &w, &mut tangent);
            add(j, &tangent);
        }
    }

    /// The same of ∂r/∂q without the part of which the [forms](Beam::strain_form) are summed strain by strain.
    pub fn add_unstrained_stiffness(
        &self,
        q: &[f64],
        v: &[f64],
        a: &[f64],
        mut add: impl FnMut(usize, &Tangent),
    ) {
        for (element, i, j) in self.middles() {
            let motion = Motion { q: part(q, i), v: part(v, j), a: part(a, j) };
            let mut tangent = [[0.0; VELOCITIES]; VELOCITIES];
            element.add_unstrained_stiffness(&motion, &mut tangent);
            add(j, &tangent);
        }
    }

    /// ∫ δγᵀ C δγ ds of the strains δγ of a motion x.
    pub fn strain_form(&self, q: &[f64], x: &[f64]) -> f64 {
        self.middles().map(|(element, i, j)| element.strain_form(part(q, i), part(x, j))).sum()
    }

    /// Adds the forces of a load per length [N/m], with components in fixed axes or in those of the sections, and with its weights
    /// element by element.
    pub(in crate::multibody) fn add_line_load(
        &self,
        on: &LineDistribution,
        q: &[f64],
        load: Vec3,
        follows: bool,
        r: &mut [f64],
    ) {
        for ((element, i, j), weights) in self.under(on) {
            element.add_line_load(part(q, i), weights, load, follows, &mut r[j..]);
        }
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
        for ((element, i, j), weights) in self.under(on) {
            let mut tangent = [[0.0; VELOCITIES]; VELOCITIES];
            let increment = increment.map(|d| part(d, j));
            element.add_line_tangent(part(q, i), weights, load, increment, &mut tangent);
            add(j, &tangent);
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
        let of = |((element, i, j), weights): ((&Element, usize, usize), &LineWeights)| {
            let mut forces = [0.0; VELOCITIES];
            element.add_line_load(part(q, i), weights, load, follows, &mut forces);
            inner(forces, *part(v, j))
        };
        self.under(on).map(of).sum()
    }

    /// ∫ρA r ds [kg·m], the mass times its centre.
    pub fn first_moment(&self, q: &[f64]) -> Vec3 {
        self.middles().fold(Vec3::ZERO, |sum, (element, i, _)| sum + element.first_moment(part(q, i)))
    }

    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.elements.iter().map(|element| element.mass()).sum()
    }

    /// Momentum and angular momentum about the origin.
    pub fn momenta(&self, q: &[f64], v: &[f64]) -> [Vec3; 2] {
        self.middles().fold([Vec3::ZERO; 2], |[p, l], (element, i, j)| {
            let [linear, angular] = element.momenta(part(q, i), part(v, j));
            [p + linear, l + angular]
        })
    }

    /// Strain energy \[J\].
    pub fn strain_energy(&self, q: &[f64]) -> f64 {
        self.middles().map(|(element, i, _)| element.strain_energy(part(q, i))).sum()
    }

    /// Kinetic energy \[J\].
    pub fn kinetic_energy(&self, q: &[f64], v: &[f64]) -> f64 {
        self.middles().map(|(element, i, j)| element.kinetic_energy(part(q, i), part(v, j))).sum()
    }
}

/// Whether the sections of an element have positive energies.
fn validate(section: &impl Fn(f64) -> Properties, s: f64, length: f64) -> Result<(), BeamError> {
    for z in [0.0, 0.5, 1.0] {
        let (at, of) = (s + z * length, section(s + z * length));
        let fault = |what| Err(BeamError::Section { at, what });
        let c = &of.stiffness;
        let largest = |i: usize, j: usize| (c[i][i] * c[j][j]).abs().sqrt();
        let symmetric = (0..4).all(|i| (0..i).all(|j| (c[i][j] - c[j][i]).abs() <= 1e-9 * largest(i, j)));
        if !(symmetric && is_positive_definite(c)) {
            return fault("the stiffness matrix must be symmetric and positive definite");
        }
        if !(of.mass > 0.0 && of.mass.is_finite()) {
            return fault("the mass per length must be positive and finite");
        }
        let [polar, second, third] = of.inertia;
        let finite = of.inertia.iter().all(|j| j.is_finite());
        if !(finite && polar > 0.0 && second >= 0.0 && third >= 0.0) {
            return fault(
                "the moment of inertia about the tangent must be positive, those about n and b not negative",
            );
        }
    }
    Ok(())
}

/// Whether all pivots of a symmetric matrix are positive.
fn is_positive_definite(matrix: &[[f64; 4]; 4]) -> bool {
    let mut a = *matrix;
    for k in 0..4 {
        if !(a[k][k] > 1e-12 * matrix[k][k] && a[k][k] > 0.0 && a[k][k].is_finite()) {
            return false;
        }
        for i in k + 1..4 {
            let factor = a[i][k] / a[k][k];
            for j in k..4 {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    true
}

/// The `N` entries from `at` on.
#[inline(always)]
fn part<const N: usize>(x: &[f64], at: usize) -> &[f64; N] {
    x[at..at + N].first_chunk().unwrap_or(const { &[0.0; N] })
}
