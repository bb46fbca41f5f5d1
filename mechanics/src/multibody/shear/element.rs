//! One element: its energies, forces and their derivatives.

use super::inertia::Moving;
use super::rotation_map::RotationMap;
use super::shapes::{LOBATTO, NODES, OTHERS, POINTS, Point, REFERENCE, gauss, lagrange};
use super::strain::{
    Blocks, Rates, Relative, Section, Strain, Variables, add_forces, blocks, interpolated, product,
};
use super::tangent::{self, Nodal};
use crate::linalg::{Mat3, Vec3};
use crate::multibody::rotation::{self, Quaternion};
use crate::section::Matrices;
use crate::system::{Frame, Weights};
use std::sync::Arc;

/// Coordinates of a node: its position r and the unit quaternion p of its section.
pub const NODE_COORDINATES: usize = 7;
/// Velocities of a node: ṙ in space, and the angular velocity Ω in the axes of its section.
pub const NODE_VELOCITIES: usize = 6;
/// Coordinates of an element.
pub const COORDINATES: usize = NODE_COORDINATES * NODES;
/// Velocities of an element.
pub const VELOCITIES: usize = NODE_VELOCITIES * NODES;

/// Motion of an element, node by node.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// r and p of each node.
    pub q: &'a [f64; COORDINATES],
    /// ṙ and Ω of each node.
    pub v: &'a [f64; VELOCITIES],
    /// The derivatives of v.
    pub a: &'a [f64; VELOCITIES],
}

/// Matrix of an element, by rows.
pub type Tangent = [[f64; VELOCITIES]; VELOCITIES];

/// Strains and stress resultants of a section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Place z in the element, 0 to 1.
    pub place: f64,
    /// (ε, γ₂, γ₃, κ₁, κ₂, κ₃) less those without stress \[1, 1/m\].
    pub strain: [f64; 6],
    /// (N, Q₂, Q₃, M₁, M₂, M₃) of the strains \[N, N·m\].
    pub stress: [f64; 6],
}

/// An element of a beam with shear. See the [module documentation](super).
#[derive(Clone, Debug)]
pub struct Element {
    constants: Arc<Constants>,
    /// Γ and κ without stress.
    rest: [Strain; POINTS],
}

/// What elements of one length and one section have in common.
#[derive(Clone, Debug)]
struct Constants {
    length: f64,
    points: [Point; POINTS],
    stiffness: [Blocks; POINTS],
    damping: Option<[Blocks; POINTS]>,
    /// The mass matrices of the sections at the nodes, times the weights of Lobatto's rule.
    mass: [Blocks; NODES],
}

/// Relative difference of numbers that are equal but for the rounding of the arc lengths of 10⁴ nodes.
const SAME: f64 = 1e-11;

impl Constants {
    fn new(length: f64, section: impl Fn(f64) -> Matrices) -> Constants {
        let points = gauss(length);
        let at = points.map(|point| section(point.place));
        let is_damped = at.iter().any(|of| of.damping.as_flattened().iter().any(|d| *d != 0.0));
        let damping = is_damped.then(|| at.map(|of| blocks(&of.damping)));
        let mass = LOBATTO.map(|(z, weight)| {
            let weighted = |row: [f64; 6]| row.map(|m| weight * length * m);
            blocks(&section(z).mass.map(weighted))
        });
        Constants { length, points, stiffness: at.map(|of| blocks(&of.stiffness)), damping, mass }
    }

    /// Whether they are those of another element but for rounding.
    fn are_those_of(&self, other: &Constants) -> bool {
        let entries = |of: &[Blocks]| -> Vec<f64> {
            of.iter().flatten().flatten().flat_map(|block| block.0).flatten().collect()
        };
        let all = |a: &[Blocks], b: &[Blocks]| {
            let (a, b) = (entries(a), entries(b));
            let largest = a.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let close =
                |(a, b): (&f64, &f64)| (a - b).abs() <= SAME * a.abs().max(b.abs()).max(SAME * largest);
            a.len() == b.len() && a.iter().zip(&b).all(close)
        };
        let [own, others] = [self, other].map(|of| of.damping.as_ref().map_or(&[][..], |d| &d[..]));
        (self.length - other.length).abs() <= SAME * self.length
            && all(&self.stiffness, &other.stiffness)
            && all(own, others)
            && all(&self.mass, &other.mass)
    }
}

/// Position and axes of the node `i`.
fn frame(q: &[f64; COORDINATES], i: usize) -> Frame {
    let at = NODE_COORDINATES * i;
    Frame { position: Vec3::at(q, at), rotation: Quaternion::at(q, at + 3).matrix() }
}

/// What the velocities of the node `i` are among those of an element, or their rates.
#[inline(always)]
fn pair(v: &[f64; VELOCITIES], i: usize) -> [Vec3; 2] {
    [Vec3::at(v, NODE_VELOCITIES * i), Vec3::at(v, NODE_VELOCITIES * i + 3)]
}

/// σ, and the forces on the variables, of the stress resultants at the points times their weights.
struct Stressed {
    stresses: [Strain; POINTS],
    forces: Variables,
}

impl Element {
    /// An element of the length `length` \[m\] without stress at the coordinates `q`, whose section at the place 0 ≤ z ≤ 1 is
    /// `section(z)`. C and D are evaluated at the quadrature points, M at the nodes, which are at the places [`Element::places`]. It shares the constants of the element `like` if they are the same but for rounding.
    pub fn new(
        length: f64,
        q: &[f64; COORDINATES],
        section: impl Fn(f64) -> Matrices,
        like: Option<&Element>,
    ) -> Element {
        let own = Constants::new(length, section);
        let constants = match like {
            Some(like) if own.are_those_of(&like.constants) => Arc::clone(&like.constants),
            _ => Arc::new(own),
        };
        let relative = Relative::new(q);
        let rest = constants.points.map(|point| Section::new(&point, &relative.variables).strain());
        Element { constants, rest }
    }

    /// Whether it shares its constants with another one.
    pub(super) fn is_like(&self, other: &Element) -> bool {
        Arc::ptr_eq(&self.constants, &other.constants)
    }

    /// The same element with the damping D + η C; it shares its constants with the element `like`.
    pub(super) fn damped(&self, viscosity: f64, like: Option<&Element>) -> Element {
        if let Some(like) = like {
            return Element { constants: Arc::clone(&like.constants), rest: self.rest };
        }
        let own = &*self.constants;
        let none = [[[Mat3::ZERO; 2]; 2]; POINTS];
        let mut damping = own.damping.unwrap_or(none);
        for (d, c) in damping
            .as_flattened_mut()
            .as_flattened_mut()
            .iter_mut()
            .zip(own.stiffness.as_flattened().as_flattened())
        {
            *d = *d + viscosity * *c;
        }
        let constants = Constants { damping: Some(damping), ..own.clone() };
        Element { constants: Arc::new(constants), rest: self.rest }
    }

    /// Places z of the nodes, 0 to 1: those of Lobatto's rule.
    pub fn places() -> [f64; NODES] {
        LOBATTO.map(|(z, _)| z)
    }

    /// Length \[m\].
    pub fn length(&self) -> f64 {
        self.constants.length
    }

    /// Largest stiffness in shear, and least in bending, at the quadrature points \[N, N·m²\].
    pub(in crate::multibody) fn shear_and_bending(&self) -> [f64; 2] {
        let all = |f: fn(&Blocks) -> [f64; 2]| self.constants.stiffness.iter().flat_map(f);
        let shear = all(|c| [c[0][0][1][1], c[0][0][2][2]]).fold(0.0, f64::max);
        [shear, all(|c| [c[1][1][1][1], c[1][1][2][2]]).fold(f64::INFINITY, f64::min)]
    }

    /// Weights \[m\] with which a force p per length acts on the nodes: the force on node i is wᵢ p(zᵢ).
    pub fn weights(&self) -> [f64; NODES] {
        LOBATTO.map(|(_, weight)| weight * self.constants.length)
    }

    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.constants.mass.iter().map(|m| m[0][0][0][0]).sum()
    }

    #[inline(always)]
    fn sections(&self, relative: &Relative) -> [Section; POINTS] {
        self.constants.points.map(|point| Section::new(&point, &relative.variables))
    }

    /// e − e₀ at a point.
    #[inline(always)]
    fn strain(&self, k: usize, section: &Section) -> Strain {
        let [slope, bend] = section.strain();
        [slope - self.rest[k][0], bend - self.rest[k][1]]
    }

    /// The rates where there is damping.
    #[inline(always)]
    fn viscous(&self, relative: &Relative, v: &[f64; VELOCITIES]) -> Option<(&[Blocks; POINTS], Rates)> {
        self.constants.damping.as_ref().map(|damping| (damping, relative.rates(v)))
    }

    /// C (e − e₀) + D ė.
    #[inline(always)]
    fn stressed(
        &self,
        sections: &[Section; POINTS],
        viscous: Option<(&[Blocks; POINTS], &Rates)>,
    ) -> Stressed {
        let mut out = Stressed { stresses: [[Vec3::ZERO; 2]; POINTS], forces: [[Vec3::ZERO; 2]; POINTS] };
        for (k, (point, section)) in self.constants.points.iter().zip(sections).enumerate() {
            let mut stress = product(&self.constants.stiffness[k], &self.strain(k, section));
            if let Some((damping, rates)) = viscous {
                let rate = section.rate(interpolated(point, &rates.variables));
                let [force, moment] = product(&damping[k], &rate);
                stress[0] += force;
                stress[1] += moment;
            }
            out.stresses[k] = stress.map(|x| point.weight * x);
            add_forces(point, section.forces(out.stresses[k]), &mut out.forces);
        }
        out
    }

    /// The section of each node in motion.
    #[inline(always)]
    fn moving(&self, m: &Motion<'_>, i: usize) -> Moving<'_> {
        Moving::new(&self.constants.mass[i], frame(m.q, i).rotation, pair(m.v, i), pair(m.a, i))
    }

    /// Strain energy \[J\], ½ ∫ (e − e₀)ᵀ C (e − e₀) ds.
    pub fn strain_energy(&self, q: &[f64; COORDINATES]) -> f64 {
        let sections = self.sections(&Relative::new(q));
        let mut energy = 0.0;
        for (k, section) in sections.iter().enumerate() {
            let strain = self.strain(k, section);
            let [force, moment] = product(&self.constants.stiffness[k], &strain);
            let density = force.dot(strain[0]) + moment.dot(strain[1]);
            energy += 0.5 * self.constants.points[k].weight * density;
        }
        energy
    }

    /// Power \[W\] that the damping takes, ∫ ėᵀ D ė ds.
    pub fn viscous_power(&self, q: &[f64; COORDINATES], v: &[f64; VELOCITIES]) -> f64 {
        self.constants.damping.as_ref().map_or(0.0, |damping| self.form_of_rates(damping, q, v))
    }

    /// ∫ δeᵀ C δe ds of the strains δe of a motion x, point by point.
    pub fn strain_form(&self, q: &[f64; COORDINATES], x: &[f64; VELOCITIES]) -> f64 {
        self.form_of_rates(&self.constants.stiffness, q, x)
    }

    /// ∫ ėᵀ A ė ds
    fn form_of_rates(&self, a: &[Blocks; POINTS], q: &[f64; COORDINATES], v: &[f64; VELOCITIES]) -> f64 {
        let relative = Relative::new(q);
        let rates = relative.rates(v);
        let mut form = 0.0;
        for (k, section) in self.sections(&relative).iter().enumerate() {
            let point = &self.constants.points[k];
            let rate = section.rate(interpolated(point, &rates.variables));
            let [force, moment] = product(&a[k], &rate);
            form += point.weight * (force.dot(rate[0]) + moment.dot(rate[1]));
        }
        form
    }

    /// Kinetic energy \[J\].
    pub fn kinetic_energy(&self, q: &[f64; COORDINATES], v: &[f64; VELOCITIES]) -> f64 {
        let motion = Motion { q, v, a: &[0.0; VELOCITIES] };
        (0..NODES).map(|i| self.moving(&motion, i).energy()).sum()
    }

    /// Momentum and angular momentum about the origin.
    pub fn momenta(&self, q: &[f64; COORDINATES], v: &[f64; VELOCITIES]) -> [Vec3; 2] {
        let motion = Motion { q, v, a: &[0.0; VELOCITIES] };
        let mut out = [Vec3::ZERO; 2];
        for i in 0..NODES {
            let [linear, angular] = self.moving(&motion, i).momenta();
            out[0] += linear;
            out[1] += angular + frame(q, i).position.cross(linear);
        }
        out
    }

    /// ∫ μ (r + Λ c) ds [kg·m], the mass times its centre.
    pub fn first_moment(&self, q: &[f64; COORDINATES]) -> Vec3 {
        let mut out = Vec3::ZERO;
        for (i, [[mass, _], [moment, _]]) in self.constants.mass.iter().enumerate() {
            let Frame { position, rotation } = frame(q, i);
            // μ c of μ c̃
            let centre = Vec3([moment[2][1], moment[0][2], moment[1][0]]);
            out += mass[0][0] * position + rotation * centre;
        }
        out
    }

    /// Adds the forces of strain, damping and inertia, ∂U/∂q + … + M a, to `r`: forces on the nodes in space, and moments in the axes of
    /// their sections. A field of acceleration b, as gravity, acts as the accelerations r̈ − b.
    pub fn add_forces(&self, m: &Motion<'_>, r: &mut [f64; VELOCITIES]) {
        let relative = Relative::new(m.q);
        let sections = self.sections(&relative);
        let viscous = self.viscous(&relative, m.v);
        let viscous = viscous.as_ref().map(|(damping, rates)| (*damping, rates));
        let forces = relative.nodal(&self.stressed(&sections, viscous).forces);
        for (i, [force, moment]) in forces.into_iter().enumerate() {
            let inertia = self.moving(m, i).force();
            (force + inertia[0]).add_to(r, NODE_VELOCITIES * i);
            (moment + inertia[1]).add_to(r, NODE_VELOCITIES * i + 3);
        }
    }

    /// Adds w.q ∂r/∂d + w.v ∂r/∂v + w.a ∂r/∂a to `out`: by the increment d of the element since the configuration that was
    /// retracted, or by variations (δr, δφ) where `w.increment` is `None`.
    pub fn add_tangent(&self, m: &Motion<'_>, w: &Weights<'_>, out: &mut Tangent) {
        self.add_part(m, w, true, out);
    }

    /// Adds ∂r/∂q without the part of which the [form](Element::strain_form) is summed strain by strain.
    pub fn add_unstrained_stiffness(&self, m: &Motion<'_>, out: &mut Tangent) {
        self.add_part(m, &Weights::new(0.0, 0.0, 1.0), false, out);
    }

    #[inline(always)]
    fn add_part(&self, m: &Motion<'_>, w: &Weights<'_>, strains: bool, out: &mut Tangent) {
        let mut turns = [Mat3::IDENTITY; NODES];
        let increment: Option<&[f64; VELOCITIES]> = w.increment.and_then(|d| d.first_chunk());
        if let Some(d) = increment {
            turns = std::array::from_fn(|i| rotation::tangent(Vec3::at(d, NODE_VELOCITIES * i + 3)));
        }
        for (i, turn) in turns.iter().enumerate() {
            add_blocks(&self.moving(m, i).tangent(turn, [w.q, w.v, w.a]), [i, i], out);
        }
        let Constants { points, stiffness, damping, .. } = &*self.constants;
        let damping = damping.as_ref().filter(|_| w.v != 0.0);
        if w.q == 0.0 && damping.is_none() {
            return;
        }
        let relative = Relative::new(m.q);
        let sections = self.sections(&relative);
        let at = (points, &sections);
        if w.q != 0.0 {
            let viscous = self.viscous(&relative, m.v);
            let viscous = viscous.as_ref().map(|(damping, rates)| (*damping, rates));
            let Stressed { stresses, forces } = self.stressed(&sections, viscous);
            let stiffness = strains.then_some(stiffness);
            let mut nodal =
                tangent::by_configuration(&relative, at, stiffness, (&stresses, &forces), viscous, w.q);
            if increment.is_some() {
                for row in &mut nodal {
                    for (block, turn) in row.iter_mut().zip(&turns) {
                        block.iter_mut().for_each(|row| row[1] = row[1] * *turn);
                    }
                }
            }
            add_nodal(&relative.rotation, &nodal, out);
        }
        if let Some(damping) = damping {
            add_nodal(&relative.rotation, &tangent::by_velocity(&relative, at, damping, w.v), out);
        }
    }

    /// Position and axes at the place z, 0 to 1.
    pub fn section(&self, q: &[f64; COORDINATES], z: f64) -> Frame {
        let relative = Relative::new(q);
        let [value, ..] = lagrange(z);
        let (mut place, mut turn) = (Vec3::ZERO, Vec3::ZERO);
        for (k, i) in OTHERS.into_iter().enumerate() {
            let [x, of] = relative.variables[k];
            place += value[i] * x;
            turn += value[i] * of;
        }
        let Frame { position, rotation } = frame(q, REFERENCE);
        let [inward, _] = RotationMap::inverse_rotation_and_tangent(turn);
        let turned = inward.transposed().matrix();
        Frame { position: position + rotation * place, rotation: rotation * turned }
    }

    /// ṙ at the place z.
    pub fn velocity(&self, v: &[f64; VELOCITIES], z: f64) -> Vec3 {
        let [value, ..] = lagrange(z);
        (0..NODES).map(|i| value[i] * pair(v, i)[0]).sum()
    }

    /// Strains and stress resultants at the quadrature points, where their errors are of higher order than elsewhere.
    pub fn samples(&self, q: &[f64; COORDINATES]) -> [Sample; POINTS] {
        let sections = self.sections(&Relative::new(q));
        std::array::from_fn(|k| {
            let strain = self.strain(k, &sections[k]);
            let stress = product(&self.constants.stiffness[k], &strain);
            let flat = |[a, b]: Strain| [a[0], a[1], a[2], b[0], b[1], b[2]];
            let place = self.constants.points[k].place;
            Sample { place, strain: flat(strain), stress: flat(stress) }
        })
    }

    /// Largest angle \[rad\] by which a section of a node is rotated against the reference section. It must stay below π, where its
    /// rotation vector jumps.
    pub fn turn(&self, q: &[f64; COORDINATES]) -> f64 {
        Relative::new(q).variables.iter().map(|[_, turn]| turn.norm()).fold(0.0, f64::max)
    }
}

/// Adds the matrix of the nodes whose displacements are along the axes Λₘ.
#[inline(always)]
fn add_nodal(rotation: &Mat3, nodal: &Nodal, out: &mut Tangent) {
    let back = rotation.transpose();
    for (i, row) in nodal.iter().enumerate() {
        for (j, block) in row.iter().enumerate() {
            let [[rr, rf], [fr, ff]] = *block;
            add_blocks(&[[*rotation * rr * back, *rotation * rf], [fr * back, ff]], [i, j], out);
        }
    }
}

/// Adds the matrix of the displacement and the rotation of two nodes.
#[inline(always)]
fn add_blocks(blocks: &Blocks, [i, j]: [usize; 2], out: &mut Tangent) {
    for (k, row) in blocks.iter().enumerate() {
        for (l, part) in row.iter().enumerate() {
            let (top, left) = (NODE_VELOCITIES * i + 3 * k, NODE_VELOCITIES * j + 3 * l);
            for a in 0..3 {
                (0..3).for_each(|b| out[top + a][left + b] += part[a][b]);
            }
        }
    }
}
