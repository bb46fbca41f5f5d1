//! Strains of an element and the forces of its strain energy.
//!
//! At a point of the centreline with the derivatives r′ and r″, and with t, n, b the axes of the section there,
//!
//! ```text
//! ε = |r′| − 1,   κ₂ = −b·r″/|r′|,   κ₃ = n·r″/|r′|,   κ₁ = b·n′
//! ```
//!
//! ε and κ₁ are sampled and interpolated (see [`super::shapes`]), κ₂ and κ₃ are evaluated at the quadrature points. The
//! axes there are those of the middle, transported to t by the smallest rotation and twisted by φ = −L₁ φ₁ₘ + L₂ φₘ₂. With
//! μ = t·r″/|r′| and c of the pair of the middle and the point,
//!
//! ```text
//! δκ₂ = (−b·δr″ + μ b·δr′ − κ₂ t·δr′)/|r′| + κ₃ δΘ
//! δκ₃ = ( n·δr″ − μ n·δr′ − κ₃ t·δr′)/|r′| − κ₂ δΘ,    δΘ = δΘₘ − L₁ δφ₁ₘ + L₂ δφₘ₂ − c·(δtₘ + δt)
//! ```

use super::pair::Pair;
use super::shapes::{Point, Shapes};
use super::triad::{Triad, Vector, plus, times, vector};

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

/// Σ Nᵢ xᵢ
#[inline(always)]
pub(super) fn combined(n: &[f64; 4], x: &[Vector; 4]) -> Vector {
    std::array::from_fn(|k| n[0] * x[0][k] + n[1] * x[1][k] + n[2] * x[2][k] + n[3] * x[3][k])
}

/// The centreline's unknowns r₁, r′₁, r₂, r′₂ among the velocities of an element, or their rates.
#[inline(always)]
pub(super) fn centreline(v: &[f64; VELOCITIES]) -> [Vector; 4] {
    CENTRELINE.map(|at| vector(v, at))
}

/// The three sections of an element that carry unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sections {
    /// r₁, r′₁, r₂, r′₂
    pub centreline: [Vector; 4],
    pub triads: [Triad; 3],
    pub pairs: [Pair; 3],
}

impl Sections {
    #[inline]
    pub fn new(shapes: &Shapes, q: &[f64; COORDINATES]) -> Sections {
        let centreline = [0, 3, 12, 15].map(|at| vector(q, at));
        let middle = combined(&shapes.middle, &centreline);
        let slopes = [centreline[1], middle, centreline[3]];
        let normals = [6, 9, 18].map(|at| vector(q, at));
        let triads: [Triad; 3] = std::array::from_fn(|i| Triad::new(slopes[i], normals[i]));
        let pairs = ENDS.map(|[a, b]| Pair::new(&triads[a], &triads[b]));
        Sections { centreline, triads, pairs }
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
    /// (ε, κ₁, κ₂, κ₃)
    pub strain: [f64; 4],
}

impl Section {
    #[inline]
    pub fn new(at: &Point, sections: &Sections) -> Section {
        let Sections { centreline, triads, pairs } = sections;
        let (slope, curvature) = (combined(&at.slope, centreline), combined(&at.curvature, centreline));
        let (l, p) = (&at.sample, &at.torsion);
        let twist = l[2] * pairs[1].angle - l[0] * pairs[0].angle;
        let triad = triads[1].transported(slope, twist);
        let pair = Pair::of_tangents(triads[1].tangent, triad.tangent);
        let [along, second, third] = triad.inward(times(1.0 / triad.length, curvature));
        let axial: f64 = (0..3).map(|i| l[i] * (triads[i].length - 1.0)).sum();
        let torsion = (0..3).map(|i| p[i] * pairs[i].angle).sum();
        Section { triad, pair, along, strain: [axial, torsion, -third, second] }
    }
}

/// Forces on what the strains are made of, summed over the quadrature points.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Forces {
    /// On the samples of ε.
    pub samples: [f64; 3],
    /// On the angles of the pairs.
    pub angles: [f64; 3],
    /// On Θₘ and r′ₘ, beside those by the pairs.
    pub spin: f64,
    pub middle: Vector,
    /// On the centreline, beside those by samples and pairs.
    pub centreline: [Vector; 4],
}

impl Forces {
    /// Adds those of a section with the stress resultants (N, M₁, M₂, M₃), already times the weight of the point.
    #[inline]
    pub fn add(&mut self, at: &Point, section: &Section, stress: [f64; 4]) {
        let Section { triad, pair, along, strain } = section;
        let [normal, torque, m2, m3] = stress;
        let [_, _, k2, k3] = *strain;
        let spin = m2 * k3 - m3 * k2;
        for k in 0..3 {
            self.samples[k] += at.sample[k] * normal;
            self.angles[k] += at.torsion[k] * torque;
        }
        self.angles[0] -= at.sample[0] * spin;
        self.angles[1] += at.sample[2] * spin;
        self.spin += spin;
        // The length |r′ₘ| is divided by at the end.
        self.middle = plus(self.middle, -spin, pair.c);
        let inverse = 1.0 / triad.length;
        let slope = [-(m2 * k2 + m3 * k3), -along * m3, along * m2];
        let slope = times(inverse, plus(triad.outward(slope), -spin, pair.c));
        let curvature = times(inverse, plus(times(m3, triad.normal), -m2, triad.binormal));
        for i in 0..4 {
            let force = plus(times(at.slope[i], slope), at.curvature[i], curvature);
            self.centreline[i] = plus(self.centreline[i], 1.0, force);
        }
    }

    /// Adds all forces to those on the velocities of the element.
    pub fn scatter(&self, shapes: &Shapes, sections: &Sections, out: &mut [f64; VELOCITIES]) {
        let Sections { triads, pairs, .. } = sections;
        let mut spins = [0.0, self.spin, 0.0];
        let mut slopes = [[0.0; 3], self.middle, [0.0; 3]];
        for ((pair, [a, b]), force) in pairs.iter().zip(ENDS).zip(self.angles) {
            spins[a] -= force;
            spins[b] += force;
            slopes[a] = plus(slopes[a], force, pair.c);
            slopes[b] = plus(slopes[b], force, pair.c);
        }
        for i in 0..3 {
            slopes[i] = plus(times(1.0 / triads[i].length, slopes[i]), self.samples[i], triads[i].tangent);
            out[SPINS[i]] += spins[i];
        }
        let mut centreline = self.centreline;
        centreline[1] = plus(centreline[1], 1.0, slopes[0]);
        centreline[3] = plus(centreline[3], 1.0, slopes[2]);
        for i in 0..4 {
            let force = plus(centreline[i], shapes.middle[i], slopes[1]);
            for k in 0..3 {
                out[CENTRELINE[i] + k] += force[k];
            }
        }
    }
}
