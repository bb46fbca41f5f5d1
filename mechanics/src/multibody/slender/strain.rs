//! Strains of an element and the forces of its strain energy.
//!
//! At a point of the centreline with the derivatives r′ and r″, and with t, n, b the axes of the section there,
//!
//! ```text
//! ε = |r′| − 1,   κ₂ = −b·r″/|r′|,   κ₃ = n·r″/|r′|,   κ₁ = b·n′
//! ```
//!
//! ε and κ₁ are sampled and interpolated (see [`super::shapes`]), κ₂ and κ₃ are evaluated at two Gauss points, where those of a
//! cubic curve are best. ε and κ₁ have a part beside, which vanishes at both and is integrated apart. The samples are those of the
//! mean strain of the fibres, ε̄ = ε + ½ K² κ₁²: with κ₁ of the same sections, a beam that twists may shorten at all of them and have
//! no ε̄ anywhere. δε̄ = t·δr′ + K² κ₁ δκ₁. The
//! axes there are those of the middle, transported to t by the smallest rotation and twisted by φ = −L₁ φ₁ₘ + L₂ φₘ₂. With
//! μ = t·r″/|r′| and c of the pair of the middle and the point,
//!
//! ```text
//! δκ₂ = (−b·δr″ + μ b·δr′ − κ₂ t·δr′)/|r′| + κ₃ δΘ
//! δκ₃ = ( n·δr″ − μ n·δr′ − κ₃ t·δr′)/|r′| − κ₂ δΘ,    δΘ = δΘₘ − L₁ δφ₁ₘ + L₂ δφₘ₂ − c·(δtₘ + δt)
//! ```

use super::pair::Pair;
use super::shapes::{POINTS, Point, Shapes};
use super::triad::Triad;
use crate::linalg::Vec3;

/// Coordinates of an element: r₁, r′₁, n₁, nₘ, r₂, r′₂, n₂.
pub const COORDINATES: usize = 21;
/// Velocities of an element: ṙ₁, ṙ′₁, w₁, wₘ, ṙ₂, ṙ′₂, w₂.
pub const VELOCITIES: usize = 15;
/// Where r₁, r′₁, r₂, r′₂ begin among the velocities.
pub(super) const CENTRELINE: [usize; 4] = [0, 3, 8, 11];
/// The places of w₁, wₘ, w₂ among the velocities.
pub(super) const SPINS: [usize; 3] = [6, 7, 14];
/// The sections of the pairs of angles φ₁ₘ, φₘ₂, φ₁₂.
pub(super) const ENDS: [[usize; 2]; 3] = [[0, 1], [1, 2], [0, 2]];
/// What the strains depend on: r₂ − r₁, r′₁, r′₂ and the rotations of the three sections about their tangents.
pub(super) const VARIABLES: usize = 12;

/// Σ nᵢ xᵢ
#[inline(always)]
pub(in crate::multibody) fn combined<const N: usize>(n: &[f64; N], x: &[Vec3; N]) -> Vec3 {
    let mut out = Vec3::ZERO;
    for i in 0..N {
        out += n[i] * x[i];
    }
    out
}

/// r₁, r′₁, r₂, r′₂ of the coordinates of an element.
#[inline(always)]
pub(super) fn positions(q: &[f64; COORDINATES]) -> [Vec3; 4] {
    [Vec3::at(q, 0), Vec3::at(q, 3), Vec3::at(q, 12), Vec3::at(q, 15)]
}

/// r₁, r′₁, r₂, r′₂ among the velocities of an element, or their rates.
#[inline(always)]
pub(super) fn centreline(v: &[f64; VELOCITIES]) -> [Vec3; 4] {
    let [a, b, c, d] = CENTRELINE;
    [Vec3::at(v, a), Vec3::at(v, b), Vec3::at(v, c), Vec3::at(v, d)]
}

/// (r₂ − r₁, r′₁, r′₂)
#[inline(always)]
pub(super) fn chord(x: &[Vec3; 4]) -> [Vec3; 3] {
    [x[2] - x[0], x[1], x[3]]
}

/// r′ at the three sections, or its rate, by (r₂ − r₁, r′₁, r′₂) or theirs.
#[inline(always)]
pub(super) fn slopes(shapes: &Shapes, chord: &[Vec3; 3]) -> [Vec3; 3] {
    [chord[1], combined(&shapes.middle, chord), chord[2]]
}

/// The parts that (r₂ − r₁, r′₁, r′₂) have in r′ at the three sections.
pub(super) fn shares(shapes: &Shapes) -> [[f64; 3]; 3] {
    [[0.0, 1.0, 0.0], shapes.middle, [0.0, 0.0, 1.0]]
}

/// The three sections of an element that carry unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sections {
    /// (r₂ − r₁, r′₁, r′₂)
    pub chord: [Vec3; 3],
    pub triads: [Triad; 3],
    pub pairs: [Pair; 3],
    /// κ₁ of the three sections.
    pub windings: [f64; 3],
    /// K² of the three sections \[m²\].
    pub polar: [f64; 3],
}

impl Sections {
    #[inline]
    pub fn new(shapes: &Shapes, polar: [f64; 3], q: &[f64; COORDINATES]) -> Sections {
        let chord = chord(&positions(q));
        let [first, middle, second] = slopes(shapes, &chord);
        let triads = [
            Triad::new(first, Vec3::at(q, 6)),
            Triad::new(middle, Vec3::at(q, 9)),
            Triad::new(second, Vec3::at(q, 18)),
        ];
        let pair = |[a, b]: [usize; 2]| Pair::new(&triads[a], &triads[b]);
        let pairs = [pair(ENDS[0]), pair(ENDS[1]), pair(ENDS[2])];
        let windings = shapes.windings.map(|p| (0..3).map(|j| p[j] * pairs[j].angle).sum());
        Sections { chord, triads, pairs, windings, polar }
    }

    /// ε̄ of the section `i`.
    #[inline(always)]
    fn mean_strain(&self, i: usize) -> f64 {
        self.triads[i].length - 1.0 + 0.5 * self.polar[i] * self.windings[i] * self.windings[i]
    }

    /// K² κ₁ of the section `i`, the derivative of ε̄ by κ₁.
    #[inline(always)]
    pub fn lever(&self, i: usize) -> f64 {
        self.polar[i] * self.windings[i]
    }

    /// The sections at the quadrature points.
    #[inline(always)]
    pub fn points(&self, shapes: &Shapes) -> [Section; POINTS] {
        let [first, second] = &shapes.points;
        [Section::new(first, self), Section::new(second, self)]
    }
}

/// A section at a quadrature point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    pub triad: Triad,
    /// The middle and this section.
    pub pair: Pair,
    /// μ
    pub along: f64,
    /// (ε̄, κ₁, κ₂, κ₃)
    pub strain: [f64; 4],
}

impl Section {
    #[inline]
    pub fn new(at: &Point, sections: &Sections) -> Section {
        let Sections { chord, triads, pairs, .. } = sections;
        let (slope, curvature) = (combined(&at.slope, chord), combined(&at.curvature, chord));
        let l = &at.sample;
        let twist = l[2] * pairs[1].angle - l[0] * pairs[0].angle;
        let triad = triads[1].transported(slope, twist);
        let pair = Pair::of_tangents(triads[1].tangent, triad.tangent);
        let Vec3([along, second, third]) = triad.inward(1.0 / triad.length * curvature);
        let [axial, torsion] = sampled(at, sections);
        Section { triad, pair, along, strain: [axial, torsion, -third, second] }
    }

    /// Forces on (r′, r″, Θ, ε̄, κ₁) here of the stress resultants (N, M₁, M₂, M₃), and the moment ω on Θ.
    #[inline]
    pub fn forces(&self, stress: [f64; 4]) -> Local<f64> {
        let [axial, torsion, m2, m3] = stress;
        let [_, _, k2, k3] = self.strain;
        let (inverse, mu) = (1.0 / self.triad.length, self.along);
        let slope = Vec3([-(m2 * k2 + m3 * k3), -mu * m3, mu * m2]);
        let curvature = Vec3([0.0, m3, -m2]);
        Local {
            slope: (inverse * self.triad.outward(slope)).0,
            curvature: (inverse * self.triad.outward(curvature)).0,
            spin: m2 * k3 - m3 * k2,
            axial,
            torsion,
        }
    }
}

/// ε̄ and κ₁ by the functions of a point.
#[inline(always)]
pub(super) fn sampled(at: &Point, sections: &Sections) -> [f64; 2] {
    let (mut axial, mut torsion) = (0.0, 0.0);
    for i in 0..3 {
        axial += at.sample[i] * sections.mean_strain(i);
        torsion += at.torsion[i] * sections.pairs[i].angle;
    }
    [axial, torsion]
}

/// A force, or its derivative as a row over the [`VARIABLES`].
pub(super) trait Linear: Copy {
    const ZERO: Self;
    /// self += c x
    fn add(&mut self, c: f64, x: &Self);
}

impl Linear for f64 {
    const ZERO: f64 = 0.0;

    #[inline(always)]
    fn add(&mut self, c: f64, x: &f64) {
        *self += c * x;
    }
}

/// Forces on what the strains at a point are made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local<T> {
    pub slope: [T; 3],
    pub curvature: [T; 3],
    pub spin: T,
    pub axial: T,
    pub torsion: T,
}

/// Forces on what the strains of an element are made of, summed over the quadrature points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Forces<T> {
    /// On the samples of ε̄.
    samples: [T; 3],
    /// On the angles of the pairs, beside those by the samples.
    angles: [T; 3],
    /// On Θₘ and r′ₘ, beside those by the pairs.
    spin: T,
    middle: [T; 3],
    /// On (r₂ − r₁, r′₁, r′₂), beside those by samples and pairs.
    chord: [[T; 3]; 3],
}

impl<T: Linear> Forces<T> {
    pub const ZERO: Forces<T> = Forces {
        samples: [T::ZERO; 3],
        angles: [T::ZERO; 3],
        spin: T::ZERO,
        middle: [T::ZERO; 3],
        chord: [[T::ZERO; 3]; 3],
    };

    /// Adds the forces at a point. δΘ there is made of δΘₘ, of the angles, and of r′ here and in the middle.
    #[inline(always)]
    pub fn add(&mut self, at: &Point, section: &Section, middle: &Triad, local: &Local<T>) {
        let (here, there) = (-1.0 / section.triad.length, -1.0 / middle.length);
        let c = section.pair.c;
        self.add_sampled(at, &local.axial, &local.torsion);
        for k in 0..3 {
            self.middle[k].add(there * c[k], &local.spin);
        }
        self.spin.add(1.0, &local.spin);
        self.angles[0].add(-at.sample[0], &local.spin);
        self.angles[1].add(at.sample[2], &local.spin);
        for k in 0..3 {
            let mut slope = local.slope[k];
            slope.add(here * c[k], &local.spin);
            for i in 0..3 {
                self.chord[i][k].add(at.slope[i], &slope);
                self.chord[i][k].add(at.curvature[i], &local.curvature[k]);
            }
        }
    }

    /// Adds the forces on ε̄ and κ₁ alone.
    #[inline(always)]
    pub fn add_sampled(&mut self, at: &Point, axial: &T, torsion: &T) {
        for k in 0..3 {
            self.samples[k].add(at.sample[k], axial);
            self.angles[k].add(at.torsion[k], torsion);
        }
    }

    /// Adds forces on the κ₁ of the three sections.
    pub fn add_windings(&mut self, shapes: &Shapes, forces: &[T; 3]) {
        for (force, p) in forces.iter().zip(&shapes.windings) {
            (0..3).for_each(|j| self.angles[j].add(p[j], force));
        }
    }

    /// All forces on the angles of the pairs.
    #[inline(always)]
    fn on_angles(&self, shapes: &Shapes, sections: &Sections) -> [T; 3] {
        let mut angles = self.angles;
        for (i, p) in shapes.windings.iter().enumerate() {
            (0..3).for_each(|j| angles[j].add(sections.lever(i) * p[j], &self.samples[i]));
        }
        angles
    }

    /// Adds forces on r′ₘ.
    #[inline(always)]
    pub fn add_middle(&mut self, forces: &[T; 3]) {
        for k in 0..3 {
            self.middle[k].add(1.0, &forces[k]);
        }
    }

    /// All forces as those on the [`VARIABLES`].
    #[inline(always)]
    pub fn total(&self, shapes: &Shapes, sections: &Sections) -> [T; VARIABLES] {
        let Sections { triads, pairs, .. } = sections;
        let mut spins = [T::ZERO, self.spin, T::ZERO];
        let mut slopes = [[T::ZERO; 3], self.middle, [T::ZERO; 3]];
        for ((pair, ends), force) in pairs.iter().zip(ENDS).zip(&self.on_angles(shapes, sections)) {
            for (end, sign) in ends.into_iter().zip([-1.0, 1.0]) {
                spins[end].add(sign, force);
                for k in 0..3 {
                    slopes[end][k].add(pair.c[k] / triads[end].length, force);
                }
            }
        }
        for ((slope, triad), sample) in slopes.iter_mut().zip(triads).zip(&self.samples) {
            for k in 0..3 {
                slope[k].add(triad.tangent[k], sample);
            }
        }
        let mut out = [T::ZERO; VARIABLES];
        out[9..].copy_from_slice(&spins);
        for k in 0..3 {
            let [first, middle, second] = [&slopes[0][k], &slopes[1][k], &slopes[2][k]];
            for i in 0..3 {
                out[3 * i + k] = self.chord[i][k];
                out[3 * i + k].add(shapes.middle[i], middle);
            }
            out[3 + k].add(1.0, first);
            out[6 + k].add(1.0, second);
        }
        out
    }
}

impl Forces<f64> {
    /// The forces on the samples of ε̄ and on the angles of the pairs.
    pub fn of_samples_and_angles(&self, shapes: &Shapes, sections: &Sections) -> ([f64; 3], [f64; 3]) {
        (self.samples, self.on_angles(shapes, sections))
    }
}

/// C (γ − γ₀) with γ = (ε̄, κ₁, κ₂, κ₃) at the quadrature points times their weights, and those of the parts of ε̄ and κ₁ that vanish
/// there. The torque M₁ has N K² κ₁ beside its entry, by ε̄.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stress {
    pub points: [[f64; 4]; POINTS],
    pub rest: [f64; 2],
}

/// The forces of stresses on the [`VARIABLES`].
pub(super) fn forces(
    shapes: &Shapes,
    sections: &Sections,
    points: &[Section; POINTS],
    stress: &Stress,
) -> [f64; VARIABLES] {
    let mut forces = Forces::ZERO;
    for ((at, section), stress) in shapes.points.iter().zip(points).zip(&stress.points) {
        forces.add(at, section, &sections.triads[1], &section.forces(*stress));
    }
    forces.add_sampled(&shapes.rest, &stress.rest[0], &stress.rest[1]);
    forces.total(shapes, sections)
}

/// The stiffness matrix C of a section.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiffness(pub [[f64; 4]; 4]);

impl Stiffness {
    /// K² = (C₂₂ + C₃₃)/C₀₀ \[m²\], counted from 0: the square of the radius of gyration of the axial stiffness about the centreline,
    /// ∫E (y² + z²) dA/EA.
    pub fn polar_radius_squared(&self) -> f64 {
        (self.0[2][2] + self.0[3][3]) / self.0[0][0]
    }

    /// weight · C (γ − γ₀)
    #[inline(always)]
    pub fn stress(&self, strain: &[f64; 4], initial: &[f64; 4], weight: f64) -> [f64; 4] {
        let mut stress = [0.0; 4];
        for (stress, row) in stress.iter_mut().zip(&self.0) {
            for k in 0..4 {
                *stress += row[k] * weight * (strain[k] - initial[k]);
            }
        }
        stress
    }
}
