//! One element: its energies, forces and their derivatives.

use super::inertia::{Rate, Rotation};
use super::pair::Pair;
use super::properties::Properties;
use super::shapes::{MASS_POINTS, POINTS, Point, Shapes, hermite};
use super::stiffness::{self, Tangent};
use super::strain::{
    CENTRELINE, COORDINATES, Forces, SPINS, Section, Sections, VELOCITIES, centreline, combined,
};
use super::triad::{Triad, Vector, plus, times, vector};
use crate::linalg::vector::inner;
use crate::quadrature::Gauss;
use crate::system::Weights;

/// The stiffness matrix C of a section.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiffness(pub [[f64; 4]; 4]);

impl Stiffness {
    /// weight · C (γ − γ₀)
    #[inline(always)]
    pub fn stress(&self, strain: &[f64; 4], initial: &[f64; 4], weight: f64) -> [f64; 4] {
        let strain: [f64; 4] = std::array::from_fn(|k| weight * (strain[k] - initial[k]));
        self.0.map(|row| inner(row, strain))
    }
}

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

/// An element of a slender beam. See the [module documentation](super).
#[derive(Clone, Debug)]
pub struct Element {
    shapes: Shapes,
    stiffness: [Stiffness; POINTS],
    /// Strains without stress.
    initial: [[f64; 4]; POINTS],
    /// ∫ρA Nᵢ Nⱼ ds
    mass: [[f64; 4]; 4],
    /// ∫ρA Nᵢ ds
    weight: [f64; 4],
    /// (J₁, J₂, J₃) of the three sections, times the weights of Simpson's rule.
    inertia: [[f64; 3]; 3],
    has_rotary_inertia: bool,
    damping: f64,
}

impl Element {
    /// An element of the length `length` \[m\] without stress at the coordinates `q`, whose section at the place 0 ≤ z ≤ 1
    /// is `section(z)`. C is evaluated at three points, ρA at four, the moments of inertia at the three sections.
    pub fn new(length: f64, q: &[f64; COORDINATES], section: impl Fn(f64) -> Properties) -> Element {
        let shapes = Shapes::new(length);
        let sections = Sections::new(&shapes, q);
        let initial = shapes.points.map(|at| Section::new(&at, &sections).strain);
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
        Element { shapes, stiffness, initial, mass, weight, inertia, has_rotary_inertia, damping: 0.0 }
    }

    /// Sets the damping β [1/s] in proportion to the mass: a force −β M v.
    pub fn damp(&mut self, damping: f64) {
        self.damping = damping;
    }

    /// Length of the element \[m\].
    pub fn length(&self) -> f64 {
        self.shapes.length
    }

    /// r′ in the middle, or its rate, by those of the ends.
    pub(super) fn middle_slope(&self, centreline: &[Vector; 4]) -> Vector {
        combined(&self.shapes.middle, centreline)
    }

    /// N′ in the middle, by which r₁, r′₁, r₂, r′₂ make r′ there.
    pub(super) fn middle(&self) -> &[f64; 4] {
        &self.shapes.middle
    }

    /// Strain energy \[J\].
    pub fn strain_energy(&self, q: &[f64; COORDINATES]) -> f64 {
        let sections = Sections::new(&self.shapes, q);
        let mut energy = 0.0;
        for (k, at) in self.shapes.points.iter().enumerate() {
            let strain = Section::new(at, &sections).strain;
            let stress = self.stiffness[k].stress(&strain, &self.initial[k], at.weight);
            let strain = std::array::from_fn(|i| strain[i] - self.initial[k][i]);
            energy += 0.5 * inner(stress, strain);
        }
        energy
    }

    /// Kinetic energy \[J\].
    pub fn kinetic_energy(&self, q: &[f64; COORDINATES], v: &[f64; VELOCITIES]) -> f64 {
        let velocity = centreline(v);
        let mut energy = 0.0;
        for i in 0..4 {
            for j in 0..4 {
                energy += 0.5 * self.mass[i][j] * inner(velocity[i], velocity[j]);
            }
        }
        let sections = Sections::new(&self.shapes, q);
        let rest = [0.0; VELOCITIES];
        let of = |k| self.rotation(k, &sections, v, &rest).energy();
        energy + (0..3).map(of).sum::<f64>()
    }

    /// ∫ρA r ds [kg·m], the mass times its centre.
    pub fn first_moment(&self, q: &[f64; COORDINATES]) -> Vector {
        combined(&self.weight, &[0, 3, 12, 15].map(|at| vector(q, at)))
    }

    /// Mass \[kg\].
    pub fn mass(&self) -> f64 {
        self.weight[0] + self.weight[2]
    }

    /// Rotation of section `k` of the three.
    #[inline(always)]
    fn rotation(&self, k: usize, s: &Sections, v: &[f64; VELOCITIES], a: &[f64; VELOCITIES]) -> Rotation {
        let rate = |x: &[f64; VELOCITIES]| {
            let slope = match k {
                0 => vector(x, CENTRELINE[1]),
                1 => combined(&self.shapes.middle, &centreline(x)),
                _ => vector(x, CENTRELINE[3]),
            };
            Rate { slope, spin: x[SPINS[k]] }
        };
        Rotation::new(&s.triads[k], rate(v), rate(a), self.inertia[k], self.damping)
    }

    /// Adds the forces of strain and inertia, ∂U/∂q + M a + …, to `r`.
    pub fn add_forces(&self, m: &Motion<'_>, r: &mut [f64; VELOCITIES]) {
        let sections = Sections::new(&self.shapes, m.q);
        let mut forces = Forces::default();
        for ((at, stiffness), initial) in self.shapes.points.iter().zip(&self.stiffness).zip(&self.initial) {
            let section = Section::new(at, &sections);
            forces.add(at, &section, stiffness.stress(&section.strain, initial, at.weight));
        }
        let (v, a) = (centreline(m.v), centreline(m.a));
        let rate: [Vector; 4] = std::array::from_fn(|i| plus(a[i], self.damping, v[i]));
        for i in 0..4 {
            forces.centreline[i] = plus(forces.centreline[i], 1.0, combined(&self.mass[i], &rate));
        }
        forces.scatter(&self.shapes, &sections, r);
        if !self.has_rotary_inertia {
            return;
        }
        for k in 0..3 {
            let force = self.rotation(k, &sections, m.v, m.a).force();
            r[SPINS[k]] += force.spin;
            for (i, share) in self.shares(k) {
                for l in 0..3 {
                    r[CENTRELINE[i] + l] += share * force.slope[l];
                }
            }
        }
    }

    /// The unknowns of the centreline that make r′ at section `k` of the three, and their parts.
    fn shares(&self, k: usize) -> impl Iterator<Item = (usize, f64)> + Clone {
        let parts = match k {
            0 => [0.0, 1.0, 0.0, 0.0],
            1 => self.shapes.middle,
            _ => [0.0, 0.0, 0.0, 1.0],
        };
        parts.into_iter().enumerate().filter(|(_, part)| *part != 0.0)
    }

    /// Adds the derivative of the forces to `out`. By q it is that along variations δr, δr′, δΘ of the configuration.
    pub fn add_tangent(&self, m: &Motion<'_>, w: &Weights<'_>, out: &mut Tangent) {
        let sections = Sections::new(&self.shapes, m.q);
        if w.q != 0.0 {
            stiffness::add_tangent(&self.shapes, &self.stiffness, &self.initial, &sections, w.q, out);
        }
        let inertia = w.a + self.damping * w.v;
        for i in 0..4 {
            for j in 0..4 {
                for k in 0..3 {
                    out[CENTRELINE[i] + k][CENTRELINE[j] + k] += inertia * self.mass[i][j];
                }
            }
        }
        if !self.has_rotary_inertia {
            return;
        }
        for k in 0..3 {
            let rotation = self.rotation(k, &sections, m.v, m.a);
            for direction in 0..4 {
                let along = |c: f64| {
                    let mut rate = Rate::default();
                    match direction {
                        3 => rate.spin = c,
                        axis => rate.slope[axis] = c,
                    }
                    rate
                };
                let change = rotation.derivative(along(w.q), along(w.v), along(w.a));
                if direction == 3 {
                    self.add_column(k, SPINS[k], 1.0, &change, out);
                } else {
                    for (j, share) in self.shares(k) {
                        self.add_column(k, CENTRELINE[j] + direction, share, &change, out);
                    }
                }
            }
        }
    }

    /// Adds a change of the forces at section `k` of the three to a column.
    #[inline(always)]
    fn add_column(&self, k: usize, column: usize, scale: f64, change: &Rate, out: &mut Tangent) {
        out[SPINS[k]][column] += scale * change.spin;
        for (i, share) in self.shares(k) {
            for l in 0..3 {
                out[CENTRELINE[i] + l][column] += scale * share * change.slope[l];
            }
        }
    }

    /// Forces of a field of acceleration b, ∫ρA Nᵢ b ds, on r₁, r′₁, r₂, r′₂: gravity.
    pub fn body_force(&self, acceleration: Vector) -> [Vector; 4] {
        self.weight.map(|w| times(w, acceleration))
    }

    /// Forces of a load p(z) per length [N/m] at the place z, ∫Nᵢ p ds, on r₁, r′₁, r₂, r′₂.
    pub fn line_load(&self, load: impl Fn(f64) -> Vector) -> [Vector; 4] {
        let mut out = [[0.0; 3]; 4];
        for (z, w) in Gauss::new(MASS_POINTS).on(0.0, 1.0) {
            let ([n, ..], p) = (hermite(z, self.shapes.length), load(z));
            for i in 0..4 {
                out[i] = plus(out[i], w * self.shapes.length * n[i], p);
            }
        }
        out
    }

    /// The place z, 0 to 1, of the element: position, axes and strains (ε, κ₁, κ₂, κ₃) less those without stress. The latter
    /// are interpolated between the quadrature points, where the strains are best.
    pub fn section(&self, q: &[f64; COORDINATES], z: f64) -> (Vector, Triad, [f64; 4]) {
        let sections = Sections::new(&self.shapes, q);
        let at = Point::at(z, 0.0, self.shapes.length);
        let position = combined(&hermite(z, self.shapes.length)[0], &sections.centreline);
        let mut strain = [0.0; 4];
        let places = self.shapes.points.map(|at| at.place);
        for (k, point) in self.shapes.points.iter().enumerate() {
            let others = (0..POINTS).filter(|i| *i != k);
            let l: f64 = others.map(|i| (z - places[i]) / (places[k] - places[i])).product();
            let there = Section::new(point, &sections).strain;
            strain = std::array::from_fn(|i| strain[i] + l * (there[i] - self.initial[k][i]));
        }
        (position, Section::new(&at, &sections).triad, strain)
    }

    /// Stress resultants (N, M₁, M₂, M₃) \[N, N·m\] at the quadrature points, with their places z.
    pub fn stresses(&self, q: &[f64; COORDINATES]) -> [(f64, [f64; 4]); POINTS] {
        let sections = Sections::new(&self.shapes, q);
        std::array::from_fn(|k| {
            let at = &self.shapes.points[k];
            let strain = Section::new(at, &sections).strain;
            (at.place, self.stiffness[k].stress(&strain, &self.initial[k], 1.0))
        })
    }

    /// The twist of the ends and the middle against each other, φ₁ₘ, φₘ₂, φ₁₂.
    pub fn pairs(&self, q: &[f64; COORDINATES]) -> [Pair; 3] {
        Sections::new(&self.shapes, q).pairs
    }
}
