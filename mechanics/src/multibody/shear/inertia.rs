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

    /// Hands the columns of the derivative of force and moment to `add`, by number: by `w[0]` turn·δφ in the configuration,
    /// `w[1]` of the velocity and `w[2]` of the acceleration.
    #[inline]
    pub fn add_tangent(&self, turn: &Mat3, [wq, wv, wa]: [f64; 3], mut add: impl FnMut(usize, [Vec3; 2])) {
        let inward = self.rotation.transpose();
        let none = Vec3::ZERO;
        for k in 0..3 {
            let (along, axis) = (inward.column(k), Vec3::AXES[k]);
            add(k, self.derivative(none, [wv * along, none], [wa * along, none]));
            add(3 + k, self.derivative(wq * turn.column(k), [none, wv * axis], [none, wa * axis]));
        }
    }

    /// How force and moment change with a rotation δφ and with Λᵀδṙ, δΩ, Λᵀδr̈ and δΩ̇.
    #[inline(always)]
    fn derivative(&self, turn: Vec3, v: [Vec3; 2], a: [Vec3; 2]) -> [Vec3; 2] {
        let ([u, spin], [p, h]) = (self.velocity, self.momentum);
        let du = v[0] + u.cross(turn);
        let dspin = v[1];
        let da = a[0] + self.acceleration.cross(turn) - dspin.cross(u) - spin.cross(du);
        let [dp, dh] = product(self.mass, &[du, dspin]);
        let change = product(self.mass, &[da, a[1]]);
        let dforce = change[0] + dspin.cross(p) + spin.cross(dp) + turn.cross(self.force[0]);
        let dmoment = change[1] + dspin.cross(h) + spin.cross(dh) + du.cross(p) + u.cross(dp);
        [self.rotation * dforce, dmoment]
    }
}
