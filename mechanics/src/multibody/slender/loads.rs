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
use super::pair::skew;
use super::triad::{Triad, Vector, plus, times};
use crate::linalg::vector::{cross, inner};

use super::element::{Element, Tangent};
use super::strain::{
    CENTRELINE, COORDINATES, SPINS, Sections, VELOCITIES, centreline, chord, combined, shares,
};

/// The variations (δr′, δΘ) of a section.
const VARIATIONS: usize = 4;

impl Triad {
    /// B: the rotation δθ by (δr′, δΘ), and in the same way ω by (ṙ′, w).
    pub fn rotation_jacobian(&self) -> [[f64; VARIATIONS]; 3] {
        let swing = skew(times(1.0 / self.length, self.tangent));
        std::array::from_fn(|i| [swing[i][0], swing[i][1], swing[i][2], self.tangent[i]])
    }

    /// Bᵀ m: the forces of a moment m on (r′, Θ).
    pub fn moment_forces(&self, m: Vector) -> [f64; VARIATIONS] {
        let [x, y, z] = times(1.0 / self.length, cross(m, self.tangent));
        [x, y, z, inner(m, self.tangent)]
    }

    /// The derivative of Bᵀ m by (δr′, δΘ) for a moment m that stays as it is.
    pub fn moment_derivative(&self, m: Vector) -> [[f64; VARIATIONS]; VARIATIONS] {
        let (inverse, t) = (1.0 / self.length, self.tangent);
        let square = inverse * inverse;
        let (turned, swept) = (skew(times(square, m)), times(2.0 * square, cross(m, t)));
        let across = times(inverse, plus(m, -inner(m, t), t));
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
    pub fn angular_motion(
        &self,
        velocity: [f64; VARIATIONS],
        acceleration: [f64; VARIATIONS],
    ) -> [Vector; 2] {
        let rate = |x: [f64; VARIATIONS]| Rate { slope: [x[0], x[1], x[2]], spin: x[3] };
        Rotation::new(self, rate(velocity), rate(acceleration), [0.0; 3], 0.0).angular_motion()
    }
}

/// A force or a couple at a section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// A force \[N\] with components in fixed axes.
    Force(Vector),
    /// A force \[N\] with components in the axes of the section, which it follows.
    FollowerForce(Vector),
    /// A couple [N·m] with components in fixed axes.
    Couple(Vector),
    /// A couple [N·m] with components in the axes of the section, which it follows.
    FollowerCouple(Vector),
}

/// Forces on the unknowns (r, r′, Θ) of a section.
pub type SectionForces = [f64; 7];

impl Load {
    /// Forces on (r, r′, Θ) of the section with these axes.
    pub fn forces(&self, triad: &Triad) -> SectionForces {
        let (f, m) = match *self {
            Load::Force(f) => (f, [0.0; 3]),
            Load::FollowerForce(f) => (triad.outward(f), [0.0; 3]),
            Load::Couple(m) => ([0.0; 3], m),
            Load::FollowerCouple(m) => ([0.0; 3], triad.outward(m)),
        };
        let [x, y, z, spin] = triad.moment_forces(m);
        [f[0], f[1], f[2], x, y, z, spin]
    }

    /// The derivative of the forces by (δr, δr′, δΘ); not symmetric where the load has no potential.
    pub fn derivative(&self, triad: &Triad) -> [SectionForces; 7] {
        let mut out = [[0.0; 7]; 7];
        let jacobian = triad.rotation_jacobian();
        // δ(Λ x) = δθ × Λ x
        let followed =
            |x: Vector, j: usize| cross([jacobian[0][j], jacobian[1][j], jacobian[2][j]], triad.outward(x));
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

/// Shape functions of the centreline at the three sections, times the weights of Simpson's rule, for the length h.
fn shapes(h: f64) -> [[f64; 4]; 3] {
    let (sixth, third, twelfth) = (h / 6.0, h / 3.0, h * h / 12.0);
    [[sixth, 0.0, 0.0, 0.0], [third, twelfth, third, -twelfth], [0.0, 0.0, sixth, 0.0]]
}

impl Element {
    /// Adds the forces of a uniform load per length [N/m], with components in fixed axes or in those of the sections.
    pub fn add_line_load(&self, q: &[f64; COORDINATES], load: Vector, follows: bool, r: &mut [f64]) {
        let sections = Sections::new(self.shapes(), q);
        for (n, triad) in shapes(self.length()).iter().zip(&sections.triads) {
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
        load: Vector,
        increment: Option<&[f64; VELOCITIES]>,
        out: &mut Tangent,
    ) {
        let sections = Sections::new(self.shapes(), q);
        let parts = shares(self.shapes());
        for (k, (n, triad)) in shapes(self.length()).iter().zip(&sections.triads).enumerate() {
            let force = triad.outward(load);
            let mut rotation = triad.rotation_jacobian();
            if let Some(d) = increment {
                let turn = triad.spin_by_slope(combined(&parts[k], &chord(&centreline(d))));
                rotation.iter_mut().for_each(|row| (0..3).for_each(|j| row[j] += row[3] * turn[j]));
            }
            for j in 0..VARIATIONS {
                // δ(Λp) = δθ × Λp
                let change = cross([rotation[0][j], rotation[1][j], rotation[2][j]], force);
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
