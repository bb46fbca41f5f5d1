//! Inertia of the section at a node.
//!
//! With the velocity u = Λᵀ ṙ and the angular velocity Ω, both in the axes of the section, and the mass matrix M of the part of
//! the beam that belongs to the node, the kinetic energy is T = ½ (u, Ω)ᵀ M (u, Ω). Momentum and angular momentum about the node
//! are (p, h) = M (u, Ω), and force and moment that the motion needs, in the axes of the section,
//!
//! ```text
//! f = ṗ + Ω × p,      m = ḣ + Ω × h + u × p,      u̇ = Λᵀ r̈ − Ω × u
//! ```
//!
//! They hold for any symmetric M, and have the centrifugal and gyroscopic forces of an offset centre of mass in them.

use super::strain::{Blocks, product};
use crate::linalg::{Mat3, Vec3};

/// A section in motion; vectors in its axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving<'a> {
    mass: &'a Blocks,
    rotation: Mat3,
    /// u and Ω; Λᵀ r̈.
    velocity: [Vec3; 2],
    acceleration: Vec3,
    /// p and h; f and m.
    momentum: [Vec3; 2],
    force: [Vec3; 2],
}

impl<'a> Moving<'a> {
    /// The section with the axes Λ, the velocities (ṙ, Ω) and the accelerations (r̈, Ω̇).
    #[inline(always)]
    pub fn new(mass: &'a Blocks, rotation: Mat3, v: [Vec3; 2], a: [Vec3; 2]) -> Moving<'a> {
        let inward = rotation.transpose();
        let (velocity, acceleration) = ([inward * v[0], v[1]], inward * a[0]);
        let [u, spin] = velocity;
        let rate = [acceleration - spin.cross(u), a[1]];
        let (momentum, change) = (product(mass, &velocity), product(mass, &rate));
        let force =
            [change[0] + spin.cross(momentum[0]), change[1] + spin.cross(momentum[1]) + u.cross(momentum[0])];
        Moving { mass, rotation, velocity, acceleration, momentum, force }
    }

    /// T
    pub fn energy(&self) -> f64 {
        0.5 * (self.velocity[0].dot(self.momentum[0]) + self.velocity[1].dot(self.momentum[1]))
    }

    /// Momentum, and angular momentum about the node, in space.
    pub fn momenta(&self) -> [Vec3; 2] {
        self.momentum.map(|x| self.rotation * x)
    }

    /// The force in space and the moment in the axes of the section.
    #[inline(always)]
    pub fn force(&self) -> [Vec3; 2] {
        [self.rotation * self.force[0], self.force[1]]
    }

    /// The derivative of force and moment, by rows, by displacement and rotation: by `w[0]` (0, turn·δφ) in the configuration, by
    /// `w[1]` of the velocity and `w[2]` of the acceleration.
    #[inline(always)]
    pub fn tangent(&self, turn: &Mat3, [wq, wv, wa]: [f64; 3]) -> Blocks {
        let ([u, spin], [p, h], [force, _]) = (self.velocity, self.momentum, self.force);
        let [[m11, m12], [m21, m22]] = *self.mass;
        let [u, spin, acceleration] = [u, spin, self.acceleration].map(Mat3::skew);
        let [p, h, force] = [p, h, force].map(Mat3::skew);
        // By u: δu = Λᵀδṙ + u × δφ, δu̇ = Λᵀδr̈ + Λᵀr̈ × δφ − δΩ × u − Ω × δu.
        let by_velocity = [spin * m11 - m11 * spin, spin * m21 - m21 * spin + u * m11 - p];
        let by_spin = [m11 * u + spin * m12 - p, m21 * u + spin * m22 + u * m12 - h];
        let by_turn =
            [by_velocity[0] * u + m11 * acceleration - force, by_velocity[1] * u + m21 * acceleration];
        let inward = self.rotation.transpose();
        let of = |k: usize, [by_rate, by_spin_rate]: [Mat3; 2]| {
            let by_place = (wa * by_rate + wv * by_velocity[k]) * inward;
            [by_place, wq * (by_turn[k] * *turn) + wv * by_spin[k] + wa * by_spin_rate]
        };
        let [by_place, by_rotation] = of(0, [m11, m12]);
        [[self.rotation * by_place, self.rotation * by_rotation], of(1, [m21, m22])]
    }
}
