//! Forces and couples at a section, and what joints need to know of its rotation.
//!
//! A section has four variations (δr′, δΘ) beside that of its place, and rotates with
//!
//! ```text
//! δθ = B (δr′, δΘ) = r′ × δr′/|r′|² + t δΘ
//! ```
//!
//! A moment m does the work m·δθ: its forces are Bᵀm, that is m × r′/|r′|² on r′ and m·t on the spin.
//!
//! A load p per length with components in the axes of the sections is Λp at both nodes and in the middle, and integrated by
//! Simpson's rule with the shape functions there: (1, 0, 0, 0), (½, h/8, ½, −h/8) and (0, 0, 1, 0).

use super::inertia::{Rate, Rotation};
use super::triad::Triad;
use crate::linalg::vector::inner;
use crate::linalg::{Mat3, Vec3};

use super::element::{Element, Tangent};
use super::strain::{CENTRELINE, COORDINATES, SPINS, VELOCITIES, centreline, chord, combined, shares};

/// The variations (δr′, δΘ) of a section.
const VARIATIONS: usize = 4;

impl Triad {
    /// B: the rotation δθ by (δr′, δΘ), and in the same way ω by (ṙ′, w).
    pub fn rotation_jacobian(&self) -> [[f64; VARIATIONS]; 3] {
        let swing = Mat3::skew(1.0 / self.length * self.tangent);
        std::array::from_fn(|i| [swing[i][0], swing[i][1], swing[i][2], self.tangent[i]])
    }

    /// Bᵀ m: the forces of a moment m on (r′, Θ).
    pub fn moment_forces(&self, m: Vec3) -> [f64; VARIATIONS] {
        let Vec3([x, y, z]) = 1.0 / self.length * m.cross(self.tangent);
        [x, y, z, m.dot(self.tangent)]
    }

    /// The derivative of Bᵀ m by (δr′, δΘ) for a moment m that stays as it is.
    pub fn moment_derivative(&self, m: Vec3) -> [[f64; VARIATIONS]; VARIATIONS] {
        let (inverse, t) = (1.0 / self.length, self.tangent);
        let square = inverse * inverse;
        let (turned, swept) = (Mat3::skew(square * m), 2.0 * square * m.cross(t));
        let across = inverse * (m - m.dot(t) * t);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i, j) {
                (3, 3) => 0.0,
                (3, j) => across[j],
                (_, 3) => 0.0,
                (i, j) => turned[i][j] - swept[i] * t[j],
            })
        })
    }

    /// ω and ω̇ for the rates (ṙ′, w) and (r̈′, ẇ).
    pub fn angular_motion(&self, velocity: [f64; VARIATIONS], acceleration: [f64; VARIATIONS]) -> [Vec3; 2] {
        let rate = |x: [f64; VARIATIONS]| Rate { slope: Vec3([x[0], x[1], x[2]]), spin: x[3] };
        Rotation::new(self, rate(velocity), rate(acceleration), Vec3::ZERO, 0.0).angular_motion()
    }
}

/// A force or a couple at a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// A force \[N\] with components in fixed axes.
    Force(Vec3),
    /// A force \[N\] with components in the axes of the section, which it follows.
    FollowerForce(Vec3),
    /// A couple [N·m] with components in fixed axes.
    Couple(Vec3),
    /// A couple [N·m] with components in the axes of the section, which it follows.
    FollowerCouple(Vec3),
}

/// Forces on the unknowns (r, r′, Θ) of a section.
pub type SectionForces = [f64; 7];

impl Load {
    /// Forces on (r, r′, Θ) of the section with these axes.
    pub fn forces(&self, triad: &Triad) -> SectionForces {
        let (f, m) = match *self {
            Load::Force(f) => (f, Vec3::ZERO),
            Load::FollowerForce(f) => (triad.outward(f), Vec3::ZERO),
            Load::Couple(m) => (Vec3::ZERO, m),
            Load::FollowerCouple(m) => (Vec3::ZERO, triad.outward(m)),
        };
        let [x, y, z, spin] = triad.moment_forces(m);
        [f[0], f[1], f[2], x, y, z, spin]
    }

    /// The derivative of the forces by (δr, δr′, δΘ); not symmetric where the load has no potential.
    pub fn derivative(&self, triad: &Triad) -> [SectionForces; 7] {
        let mut out = [[0.0; 7]; 7];
        let jacobian = triad.rotation_jacobian();
        // δ(Λ x) = δθ × Λ x
        let followed = |x: Vec3, j: usize| {
            Vec3([jacobian[0][j], jacobian[1][j], jacobian[2][j]]).cross(triad.outward(x))
        };
        match *self {
            Load::Force(_) => {}
            Load::FollowerForce(f) => {
                for j in 0..VARIATIONS {
                    let change = followed(f, j);
                    for i in 0..3 {
                        out[i][3 + j] = change[i];
                    }
                }
            }
            Load::Couple(m) | Load::FollowerCouple(m) => {
                let follows = matches!(self, Load::FollowerCouple(_));
                let moment = if follows { triad.outward(m) } else { m };
                let fixed = triad.moment_derivative(moment);
                for j in 0..VARIATIONS {
                    let change = if follows { triad.moment_forces(followed(m, j)) } else { [0.0; 4] };
                    for i in 0..VARIATIONS {
                        out[3 + i][3 + j] = fixed[i][j] + change[i];
                    }
                }
            }
        }
        out
    }

    /// Power \[W\] at the rates (ṙ, ṙ′, w).
    pub fn power(&self, triad: &Triad, rates: &SectionForces) -> f64 {
        inner(self.forces(triad), *rates)
    }
}

/// Weights \[m\] with which a load per length at the three sections of an element acts on r₁, r′₁, r₂, r′₂.
pub type LineWeights = [[f64; 4]; 3];

/// Those of a uniform load on an element of the length h: shape functions at the sections, times the weights of Simpson's rule.
pub(in crate::multibody) fn uniform_weights(h: f64) -> LineWeights {
    let (sixth, third, twelfth) = (h / 6.0, h / 3.0, h * h / 12.0);
    [[sixth, 0.0, 0.0, 0.0], [third, twelfth, third, -twelfth], [0.0, 0.0, sixth, 0.0]]
}

impl Element {
    /// Adds the forces of a load per length [N/m], with components in fixed axes or in those of the sections.
    pub fn add_line_load(
        &self,
        q: &[f64; COORDINATES],
        weights: &LineWeights,
        load: Vec3,
        follows: bool,
        r: &mut [f64],
    ) {
        let sections = self.sections(q);
        for (n, triad) in weights.iter().zip(&sections.triads) {
            let force = if follows { triad.outward(load) } else { load };
            for (at, n) in CENTRELINE.into_iter().zip(n) {
                (0..3).for_each(|k| r[at + k] += n * force[k]);
            }
        }
    }

    /// Adds the derivative of the forces of a load that follows the sections: by the increment d of the element, or by
    /// variations where there is none.
    pub fn add_line_tangent(
        &self,
        q: &[f64; COORDINATES],
        weights: &LineWeights,
        load: Vec3,
        increment: Option<&[f64; VELOCITIES]>,
        out: &mut Tangent,
    ) {
        let sections = self.sections(q);
        let parts = shares(self.shapes());
        for (k, (n, triad)) in weights.iter().zip(&sections.triads).enumerate() {
            let force = triad.outward(load);
            let mut rotation = triad.rotation_jacobian();
            if let Some(d) = increment {
                let turn = triad.spin_by_slope(combined(&parts[k], &chord(&centreline(d))));
                rotation.iter_mut().for_each(|row| (0..3).for_each(|j| row[j] += row[3] * turn[j]));
            }
            for j in 0..VARIATIONS {
                // δ(Λp) = δθ × Λp
                let change = Vec3([rotation[0][j], rotation[1][j], rotation[2][j]]).cross(force);
                // r′ of the section by r₁, r′₁, r₂, r′₂.
                let places: [(usize, f64); 4] = match j {
                    3 => [(SPINS[k], 1.0), (0, 0.0), (0, 0.0), (0, 0.0)],
                    j => {
                        let [r, first, second] = parts[k];
                        let [a, b, c, d] = CENTRELINE.map(|at| at + j);
                        [(a, -r), (b, first), (c, r), (d, second)]
                    }
                };
                for (at, n) in CENTRELINE.into_iter().zip(n) {
                    for (column, part) in places {
                        (0..3).for_each(|i| out[at + i][column] += n * part * change[i]);
                    }
                }
            }
        }
    }
}
