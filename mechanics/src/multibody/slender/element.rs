//! One element: its energies, forces and their derivatives.

use super::inertia::{Rate, Rotation};
use super::pair::Pair;
use super::properties::Properties;
use super::shapes::{MASS_POINTS, POINTS, Point, Shapes, hermite};
use super::stiffness;
use super::strain::{
    self, CENTRELINE, COORDINATES, SPINS, Section, Sections, Stiffness, Stress, VARIABLES, VELOCITIES,
    centreline, chord, combined, positions, sampled, shares, slopes,
};
use super::triad::Triad;
use crate::linalg::Vec3;
use crate::linalg::vector::inner;
use crate::quadrature::Gauss;
use crate::system::Weights;
use std::ops::Deref;
use std::sync::Arc;

/// Motion of an element: its coordinates, velocities and accelerations in the order of [`VELOCITIES`].
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    /// r₁, r′₁, n₁, nₘ, r₂, r′₂, n₂
    pub q: &'a [f64; COORDINATES],
    /// ṙ₁, ṙ′₁, w₁, wₘ, ṙ₂, ṙ′₂, w₂
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
    /// (ε, κ₁, κ₂, κ₃) less those without stress.
    pub strain: [f64; 4],
    /// ½ (κ₁² − κ₁₀²) [1/m²]: a fibre at the distance r from the axis is lengthened by r² times it.
    pub winding: f64,
    /// (N, M₁, M₂, M₃) \[N, N·m\]
    pub stress: [f64; 4],
}

/// What a variable of the strains is among the velocities of an element: r₂ − r₁ is two of them.
const PLACES: [usize; VARIABLES] = [8, 9, 10, 3, 4, 5, 11, 12, 13, 6, 7, 14];

/// The rates of the variables of the strains.
fn variables(v: &[f64; VELOCITIES]) -> [f64; VARIABLES] {
    std::array::from_fn(|i| v[PLACES[i]] - if i < 3 { v[i] } else { 0.0 })
}

/// An element of a slender beam. See the [module documentation](super).
#[derive(Clone, Debug)]
pub struct Element {
    constants: Arc<Constants>,
    /// Strains (ε̄, κ₁, κ₂, κ₃) without stress, and of ε̄ and κ₁ the part that vanishes at the points.
    initial: [[f64; 4]; POINTS],
    rest: [f64; 2],
    /// κ₁ of the three sections without stress.
    windings: [f64; 3],
    damping: f64,
    viscosity: f64,
}

/// What elements of one length and one section have in common.
#[derive(Debug)]
pub struct Constants {
    shapes: Shapes,
    stiffness: [Stiffness; POINTS],
    /// C in the middle.
    middle: Stiffness,
    /// ∫ρA Nᵢ Nⱼ ds
    mass: [[f64; 4]; 4],
    /// ∫ρA Nᵢ ds
    weight: [f64; 4],
    /// (J₁, J₂, J₃) of the three sections, times the weights of Simpson's rule.
    inertia: [[f64; 3]; 3],
    has_rotary_inertia: bool,
    /// K² of the three sections.
    polar: [f64; 3],
}

/// Relative difference of numbers that are equal but for the rounding of the arc lengths of 10⁴ nodes.
const SAME: f64 = 1e-11;

impl Constants {
    /// Of an element of the length `length` \[m\] whose section at the place 0 ≤ z ≤ 1 is `section(z)`. C is evaluated at two Gauss
    /// points and in the middle, ρA at four, the moments of inertia at the three sections.
    fn new(length: f64, section: impl Fn(f64) -> Properties) -> Constants {
        let shapes = Shapes::new(length);
        let middle = Stiffness(section(0.5).stiffness);
        let stiffness = shapes.points.map(|at| Stiffness(section(at.place).stiffness));
        let (mut mass, mut weight) = ([[0.0; 4]; 4], [0.0; 4]);
        for (z, w) in Gauss::new(MASS_POINTS).on(0.0, 1.0) {
            let ([n, ..], density) = (hermite(z, length), w * length * section(z).mass);
            for i in 0..4 {
                weight[i] += density * n[i];
                for j in 0..4 {
                    mass[i][j] += density * n[i] * n[j];
                }
            }
        }
        let inertia = [(0.0, 1.0), (0.5, 4.0), (1.0, 1.0)]
            .map(|(z, w)| section(z).inertia.map(|j| w * length / 6.0 * j));
        let has_rotary_inertia = inertia.iter().any(|j| j.iter().any(|j| *j != 0.0));
        let polar = [0.0, 0.5, 1.0].map(|z| Stiffness(section(z).stiffness).polar_radius_squared());
        Constants { shapes, stiffness, middle, mass, weight, inertia, has_rotary_inertia, polar }
    }

    /// Whether they are those of another element but for rounding.
    fn are_those_of(&self, other: &Constants) -> bool {
        let close = |a: &f64, b: &f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
        let all = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| close(a, b));
        let points = self.stiffness.iter().zip(&other.stiffness);
        let stiffness = points.chain([(&self.middle, &other.middle)]);
        close(&self.shapes.length, &other.shapes.length)
            && stiffness.into_iter().all(|(a, b)| all(a.0.as_flattened(), b.0.as_flattened()))
            && all(self.mass.as_flattened(), other.mass.as_flattened())
            && all(self.inertia.as_flattened(), other.inertia.as_flattened())
            && all(&self.polar, &other.polar)
    }
}

impl Deref for Element {
    type Target = Constants;

    fn deref(&self) -> &Constants {
        &self.constants
    }
}

impl Element {
    /// An element of the length `length` \[m\] without stress at the coordinates `q`, whose section at the place 0 ≤ z ≤ 1
    /// is `section(z)`. It shares the constants of the element `like` if they are the same but for rounding.
    pub fn new(
        length: f64,
        q: &[f64; COORDINATES],
        section: impl Fn(f64) -> Properties,
        like: Option<&Element>,
    ) -> Element {
        let own = Constants::new(length, section);
        let constants = match like {
            Some(like) if own.are_those_of(like) => Arc::clone(&like.constants),
            _ => Arc::new(own),
        };
        let sections = Sections::new(&constants.shapes, constants.polar, q);
        let initial = sections.points(&constants.shapes).map(|point| point.strain);
        let rest = sampled(&constants.shapes.rest, &sections);
        let windings = sections.windings;
        Element { constants, initial, rest, windings, damping: 0.0, viscosity: 0.0 }
    }

    /// Sets the damping β [1/s] in proportion to the mass: a force −β M v.
    pub fn damp(&mut self, damping: f64) {
        self.damping = damping;
    }

    /// Sets the damping η \[s\] in proportion to the stiffness: stresses C (γ − γ₀ + η γ̇).
    pub fn make_viscous(&mut self, viscosity: f64) {
        self.viscosity = viscosity;
    }

    /// Its shape functions.
    pub(super) fn shapes(&self) -> &Shapes {
        &self.shapes
    }

    /// The sections at the coordinates `q`.
    #[inline]
    pub(super) fn sections(&self, q: &[f64; COORDINATES]) -> Sections {
        Sections::new(&self.shapes, self.polar, q)
    }

    /// Length of the element \[m\].
    pub fn length(&self) -> f64 {
        self.shapes.length
    }

    /// Largest stiffness along the axis, and least in bending, at the quadrature points \[N, N·m²\].
    pub(in crate::multibody) fn axial_and_bending(&self) -> [f64; 2] {
        let axial = self.stiffness.iter().map(|c| c.0[0][0]).fold(0.0, f64::max);
        let bending = self.stiffness.iter().flat_map(|c| [c.0[2][2], c.0[3][3]]);
        [axial, bending.fold(f64::INFINITY, f64::min)]
    }

    /// r′ in the middle, or its rate, by r₁, r′₁, r₂, r′₂ or theirs.
    #[inline]
    pub(in crate::multibody) fn middle_slope(&self, centreline: &[Vec3; 4]) -> Vec3 {
        combined(&self.shapes.middle, &chord(centreline))
    }

    /// Strain energy \[J\].
    pub fn strain_energy(&self, q: &[f64; COORDINATES]) -> f64 {
        let sections = self.sections(q);
        let mut energy = 0.0;
        for (k, at) in self.shapes.points.iter().enumerate() {
            let strain = Section::new(at, &sections).strain;
            let stress = self.stiffness[k].stress(&strain, &self.initial[k], at.weight);
            let strain = std::array::from_fn(|i| strain[i] - self.initial[k][i]);
            energy += 0.5 * inner(stress, strain);
        }
        let strain = sampled(&self.shapes.rest, &sections);
        let stress = self.rest_stress(strain);
        energy + 0.5 * (stress[0] * (strain[0] - self.rest[0]) + stress[1] * (strain[1] - self.rest[1]))
    }

    /// Forces on the parts of ε and κ₁ that vanish at the quadrature points.
    #[inline(always)]
    fn rest_stress(&self, [axial, torsion]: [f64; 2]) -> [f64; 2] {
        let initial = [self.rest[0], self.rest[1], 0.0, 0.0];
        let stress = self.middle.stress(&[axial, torsion, 0.0, 0.0], &initial, self.shapes.rest.weight);
        [stress[0], stress[1]]
    }

    /// Stresses C (γ − γ₀ + η γ̇).
    #[inline(always)]
    fn stress(&self, sections: &Sections, points: &[Section; POINTS], v: &[f64; VELOCITIES]) -> Stress {
        let mut strains = [points[0].strain, points[1].strain];
        let mut rest = sampled(&self.shapes.rest, sections);
        if self.viscosity != 0.0 {
            let (rates, of_rest) = stiffness::rates(&self.shapes, sections, points, &variables(v));
            for (strain, rate) in strains.iter_mut().zip(rates) {
                (0..4).for_each(|i| strain[i] += self.viscosity * rate[i]);
            }
            (0..2).for_each(|i| rest[i] += self.viscosity * of_rest[i]);
        }
        let of =
            |k: usize| self.stiffness[k].stress(&strains[k], &self.initial[k], self.shapes.points[k].weight);
        Stress { points: [of(0), of(1)], rest: self.rest_stress(rest) }
    }

    /// Power \[W\] that the damping in proportion to the stiffness takes, η ∫γ̇ᵀ C γ̇ ds.
    pub fn viscous_power(&self, q: &[f64; COORDINATES], v: &[f64; VELOCITIES]) -> f64 {
        if self.viscosity == 0.0 { 0.0 } else { self.viscosity * self.strain_form(q, v) }
    }

    /// ∫ δγᵀ C δγ ds of the strains δγ of a motion x, point by point.
    pub fn strain_form(&self, q: &[f64; COORDINATES], x: &[f64; VELOCITIES]) -> f64 {
        let sections = self.sections(q);
        let points = sections.points(&self.shapes);
        let (rates, rest) = stiffness::rates(&self.shapes, &sections, &points, &variables(x));
        let zero = [0.0; 4];
        let mut form = 0.0;
        for (k, rate) in rates.iter().enumerate() {
            form += inner(self.stiffness[k].stress(rate, &zero, self.shapes.points[k].weight), *rate);
        }
        let rest = [rest[0], rest[1], 0.0, 0.0];
        form + inner(self.middle.stress(&rest, &zero, self.shapes.rest.weight), rest)
    }

    /// Adds `weight` times the part η Bᵀ C ∂(B v)/∂q of the tangent: strain by strain, its forces for a unit of strain and the
    /// derivative of its rate, which is v·∂b/∂q.
    fn add_change_of_rates(
        &self,
        (sections, points): (&Sections, &[Section; POINTS]),
        v: &[f64; VELOCITIES],
        weight: f64,
        out: &mut [[f64; VARIABLES]; VARIABLES],
    ) {
        let (u, none) = (variables(v), Stiffness([[0.0; 4]; 4]));
        let mut add = |unit: &Stress, stress: &Stress| {
            let at = (sections, points);
            let change = stiffness::tangent(&self.shapes, (&[none; POINTS], &none), unit, at, [1.0, 0.0]);
            let forces = strain::forces(&self.shapes, sections, points, stress);
            let mut rate = [0.0; VARIABLES];
            for (u, row) in u.iter().zip(&change) {
                (0..VARIABLES).for_each(|j| rate[j] += u * row[j]);
            }
            for (row, force) in out.iter_mut().zip(forces) {
                (0..VARIABLES).for_each(|j| row[j] += weight * force * rate[j]);
            }
        };
        for k in 0..POINTS {
            for i in 0..4 {
                let (mut unit, mut stress) = (Stress::default(), Stress::default());
                unit.points[k][i] = 1.0;
                stress.points[k] =
                    std::array::from_fn(|l| self.shapes.points[k].weight * self.stiffness[k].0[l][i]);
                add(&unit, &stress);
            }
        }
        for i in 0..2 {
            let (mut unit, mut stress) = (Stress::default(), Stress::default());
            unit.rest[i] = 1.0;
            stress.rest = std::array::from_fn(|l| self.shapes.rest.weight * self.middle.0[l][i]);
            add(&unit, &stress);
        }
    }

    /// Kinetic energy \[J\].
    pub fn kinetic_energy(&self, q: &[f64; COORDINATES], v: &[f64; VELOCITIES]) -> f64 {
        let velocity = centreline(v);
        let mut energy = 0.0;
        for i in 0..4 {
            for j in 0..4 {
                energy += 0.5 * self.mass[i][j] * velocity[i].dot(velocity[j]);
            }
        }
        let sections = self.sections(q);
        let rest = [0.0; VELOCITIES];
        let rotations = self.rotations(&sections, v, &rest);
        energy + rotations.iter().map(Rotation::energy).sum::<f64>()
    }

    /// ∫ρA r ds [kg·m], the mass times its centre.
    pub fn first_moment(&self, q: &[f64; COORDINATES]) -> Vec3 {
        combined(&self.weight, &positions(q))
    }

    /// Momentum and angular momentum about the origin.
    pub fn momenta(&self, q: &[f64; COORDINATES], v: &[f64; VELOCITIES]) -> [Vec3; 2] {
        let (place, velocity) = (positions(q), centreline(v));
        let linear = combined(&self.weight, &velocity);
        let mut angular = Vec3::ZERO;
        for (place, mass) in place.into_iter().zip(&self.mass) {
            angular += place.cross(combined(mass, &velocity));
        }
        let (sections, rest) = (self.sections(q), [0.0; VELOCITIES]);
        for rotation in self.rotations(&sections, v, &rest) {
            angular += rotation.angular_momentum();
        }
        [linear, angular]
    }

    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.weight[0] + self.weight[2]
    }

    /// Rotations of the three sections.
    #[inline(always)]
    fn rotations(&self, s: &Sections, v: &[f64; VELOCITIES], a: &[f64; VELOCITIES]) -> [Rotation; 3] {
        let slopes = |x| slopes(&self.shapes, &chord(&centreline(x)));
        let ([v1, v2, v3], [a1, a2, a3]) = (slopes(v), slopes(a));
        let of = |k: usize, speed: Vec3, change: Vec3| {
            let (velocity, acceleration) =
                (Rate { slope: speed, spin: v[SPINS[k]] }, Rate { slope: change, spin: a[SPINS[k]] });
            Rotation::new(&s.triads[k], velocity, acceleration, Vec3(self.inertia[k]), self.damping)
        };
        [of(0, v1, a1), of(1, v2, a2), of(2, v3, a3)]
    }

    /// Adds the forces of strain and inertia, ∂U/∂q + M a + …, to `r`.
    pub fn add_forces(&self, m: &Motion<'_>, r: &mut [f64; VELOCITIES]) {
        let sections = self.sections(m.q);
        let points = sections.points(&self.shapes);
        let stress = self.stress(&sections, &points, m.v);
        let mut total = strain::forces(&self.shapes, &sections, &points, &stress);
        if self.has_rotary_inertia {
            let [first, middle, second] = self.rotations(&sections, m.v, m.a);
            let [first, middle, second] = [first.force(), middle.force(), second.force()];
            for k in 0..3 {
                (0..3).for_each(|i| total[3 * i + k] += self.shapes.middle[i] * middle.slope[k]);
                total[3 + k] += first.slope[k];
                total[6 + k] += second.slope[k];
            }
            total[9] += first.spin;
            total[10] += middle.spin;
            total[11] += second.spin;
        }
        for i in 0..VARIABLES {
            r[PLACES[i]] += total[i];
        }
        (0..3).for_each(|k| r[k] -= total[k]);
        let (v, a) = (centreline(m.v), centreline(m.a));
        let rate = |i: usize| a[i] + self.damping * v[i];
        let rate = [rate(0), rate(1), rate(2), rate(3)];
        for i in 0..4 {
            let force = combined(&self.mass[i], &rate);
            (0..3).for_each(|k| r[CENTRELINE[i] + k] += force[k]);
        }
    }

    /// Adds w.q ∂r/∂d + w.v ∂r/∂v + w.a ∂r/∂a to `out`: by the increment d of the element since the configuration that was
    /// retracted, or by variations (δr, δr′, δΘ) where `w.increment` is `None`.
    pub fn add_tangent(&self, m: &Motion<'_>, w: &Weights<'_>, out: &mut Tangent) {
        self.add_part(m, w, 1.0, out);
    }

    /// Adds ∂r/∂q without the part of which the [form](Element::strain_form) is summed strain by strain.
    pub fn add_unstrained_stiffness(&self, m: &Motion<'_>, out: &mut Tangent) {
        self.add_part(m, &Weights::new(0.0, 0.0, 1.0), 0.0, out);
    }

    /// Adds the tangent with so much of that part.
    #[inline(always)]
    fn add_part(&self, m: &Motion<'_>, w: &Weights<'_>, strains: f64, out: &mut Tangent) {
        let sections = self.sections(m.q);
        let parts = shares(&self.shapes);
        // δΘ = δφ + turn·δr′ at the three sections.
        let mut turns = [Vec3::ZERO; 3];
        if let Some(d) = w.increment.and_then(|d| d.first_chunk()) {
            let d = chord(&centreline(d));
            for k in 0..3 {
                turns[k] = sections.triads[k].spin_by_slope(combined(&parts[k], &d));
            }
        }
        let mut tangent = [[0.0; VARIABLES]; VARIABLES];
        let viscous = self.viscosity * w.v;
        if w.q != 0.0 || viscous != 0.0 {
            let points = sections.points(&self.shapes);
            let (at, stiffness) = ((&sections, &points), (&self.stiffness, &self.middle));
            let stress = self.stress(&sections, &points, m.v);
            if w.q != 0.0 {
                tangent = stiffness::tangent(&self.shapes, stiffness, &stress, at, [w.q, strains * w.q]);
                if self.viscosity != 0.0 {
                    self.add_change_of_rates(at, m.v, w.q * self.viscosity, &mut tangent);
                }
            }
            if w.increment.is_some() {
                for row in &mut tangent {
                    for k in 0..3 {
                        (0..9).for_each(|i| row[i] += row[9 + k] * parts[k][i / 3] * turns[k][i % 3]);
                    }
                }
            }
            if viscous != 0.0 {
                let rates = stiffness::tangent(&self.shapes, stiffness, &stress, at, [0.0, viscous]);
                for (row, rates) in tangent.iter_mut().zip(rates) {
                    (0..VARIABLES).for_each(|j| row[j] += rates[j]);
                }
            }
        }
        if self.has_rotary_inertia {
            for (k, rotation) in self.rotations(&sections, m.v, m.a).iter().enumerate() {
                let block = rotation.tangent(turns[k], Vec3([w.q, w.v, w.a]));
                let has_part = |i: &usize| parts[k][*i] != 0.0;
                for i in (0..3).filter(has_part) {
                    let part = parts[k][i];
                    for a in 0..3 {
                        for j in (0..3).filter(has_part) {
                            let part = part * parts[k][j];
                            (0..3).for_each(|b| tangent[3 * i + a][3 * j + b] += part * block[a][b]);
                        }
                        tangent[3 * i + a][9 + k] += part * block[a][3];
                        tangent[9 + k][3 * i + a] += part * block[3][a];
                    }
                }
                tangent[9 + k][9 + k] += block[3][3];
            }
        }
        for (i, row) in tangent.iter().enumerate() {
            // The columns of r₁ are those of r₂ − r₁ with the other sign, and so are its rows.
            let mut wide = [0.0; VELOCITIES];
            for j in 0..VARIABLES {
                wide[PLACES[j]] = row[j];
            }
            (0..3).for_each(|k| wide[k] = -row[k]);
            for (out, x) in out[PLACES[i]].iter_mut().zip(wide) {
                *out += x;
            }
            if i < 3 {
                out[i].iter_mut().zip(wide).for_each(|(out, x)| *out -= x);
            }
        }
        let inertia = w.a + self.damping * w.v;
        for i in 0..4 {
            for j in 0..4 {
                for k in 0..3 {
                    out[CENTRELINE[i] + k][CENTRELINE[j] + k] += inertia * self.mass[i][j];
                }
            }
        }
    }

    /// Forces of a field of acceleration b, ∫ρA Nᵢ b ds, on r₁, r′₁, r₂, r′₂: gravity.
    pub fn body_force(&self, acceleration: Vec3) -> [Vec3; 4] {
        self.weight.map(|w| w * acceleration)
    }

    /// Forces of a load p(z) per length [N/m] at the place z, ∫Nᵢ p ds, on r₁, r′₁, r₂, r′₂.
    pub fn line_load(&self, load: impl Fn(f64) -> Vec3) -> [Vec3; 4] {
        let mut out = [Vec3::ZERO; 4];
        for (z, w) in Gauss::new(MASS_POINTS).on(0.0, 1.0) {
            let ([n, ..], p) = (hermite(z, self.shapes.length), load(z));
            for i in 0..4 {
                out[i] += w * self.shapes.length * n[i] * p;
            }
        }
        out
    }

    /// The place z, 0 to 1, of the element: position and axes.
    pub fn section(&self, q: &[f64; COORDINATES], z: f64) -> (Vec3, Triad) {
        let position = combined(&hermite(z, self.shapes.length)[0], &positions(q));
        let at = Section::new(&Point::at(z, 0.0, self.shapes.length), &self.sections(q));
        (position, at.triad)
    }

    /// Strains and stress resultants at the quadrature points.
    pub fn samples(&self, q: &[f64; COORDINATES]) -> [Sample; POINTS] {
        let sections = self.sections(q);
        let square = |k: f64, initial: f64| 0.5 * (k * k - initial * initial);
        std::array::from_fn(|k| {
            let (at, initial) = (&self.shapes.points[k], &self.initial[k]);
            let there = Section::new(at, &sections).strain;
            let mut strain = std::array::from_fn(|i| there[i] - initial[i]);
            for i in 0..3 {
                strain[0] -= at.sample[i] * self.polar[i] * square(sections.windings[i], self.windings[i]);
            }
            let mut stress = self.stiffness[k].stress(&there, initial, 1.0);
            stress[1] += stress[0] * self.stiffness[k].polar_radius_squared() * there[1];
            Sample { place: at.place, strain, winding: square(there[1], initial[1]), stress }
        })
    }

    /// The larger κ·M/EA at the quadrature points, M of κ and what is bent without stress, with its place z; `None` where r′ turns so little
    /// that it is less than `least`.
    pub fn bending(&self, q: &[f64; COORDINATES], least: f64) -> Option<(f64, f64)> {
        let [_, before, behind] = chord(&positions(q));
        let (turn, length) = (behind - before, self.shapes.length);
        if turn.dot(turn) * self.polar[1] < 0.25 * least * length * length {
            return None;
        }
        let points = self.sections(q).points(&self.shapes).into_iter().enumerate();
        let of = points.map(|(k, point)| {
            let [.., m2, m3] = self.stiffness[k].stress(&point.strain, &self.initial[k], 1.0);
            let [.., k2, k3] = point.strain;
            ((k2 * m2 + k3 * m3) / self.stiffness[k].0[0][0], self.shapes.points[k].place)
        });
        of.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(bending, _)| *bending >= least)
    }

    /// ṙ at the place z.
    pub fn velocity(&self, v: &[f64; VELOCITIES], z: f64) -> Vec3 {
        combined(&hermite(z, self.shapes.length)[0], &centreline(v))
    }

    /// ṙ′ at the place z.
    pub fn slope_rate(&self, v: &[f64; VELOCITIES], z: f64) -> Vec3 {
        combined(&hermite(z, self.shapes.length)[1], &centreline(v))
    }

    /// Whether both halves together are twisted by more than half a turn, where the angle between the ends jumps by a whole one:
    /// sin(φ₁ₘ + φₘ₂) has another sign than the sines of both, by Λ_aᵀΛ_b alone.
    pub fn is_wound(&self, q: &[f64; COORDINATES]) -> bool {
        let [first, middle, second] = slopes(&self.shapes, &chord(&positions(q)));
        let middle = Triad::new(middle, Vec3::at(q, 9));
        let ends = [Triad::new(first, Vec3::at(q, 6)), Triad::new(second, Vec3::at(q, 18))];
        let [[before, along_before], [behind, along_behind]] = ends.map(|end| {
            let sin = middle.binormal.dot(end.normal) - middle.normal.dot(end.binormal);
            [sin, middle.normal.dot(end.normal) + middle.binormal.dot(end.binormal)]
        });
        let sum = behind * along_before - before * along_behind;
        before * behind < 0.0 && sum * behind < 0.0
    }

    /// The twist of the ends and the middle against each other, φ₁ₘ, φₘ₂, φ₁₂.
    pub fn pairs(&self, q: &[f64; COORDINATES]) -> [Pair; 3] {
        self.sections(q).pairs
    }
}
