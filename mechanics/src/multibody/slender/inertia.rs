//! Inertia of the rotation of a section.
//!
//! The section rotates with the spin w = ω·t and with its tangent, and H = J ω is its angular momentum per length, J = Λ
//! diag(J₁, J₂, J₃) Λᵀ:
//!
//! ```text
//! ω = w t + r′ × ṙ′/|r′|²,    ω̇ = ẇ t + w ṫ + r′ × r̈′/|r′|² − 2 (r′·ṙ′)/|r′|⁴ r′ × ṙ′
//! δW = δθ·Y,   Y = J ω̇ + ω × J ω + β J ω,   δθ = δΘ t + r′ × δr′/|r′|²
//! ```
//!
//! so that Y·t belongs to the spin and Y × r′/|r′|² to r′; β is the damping in proportion to the mass. With J₂ = J₃ = 0
//! only the spin has inertia.

use super::triad::{Triad, Vector, plus, times};
use crate::linalg::vector::{cross, inner};

/// Rates of the slope r′ and of the rotation about t: (ṙ′, w) or (r̈′, ẇ), or variations (δr′, δΘ).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rate {
    pub slope: Vector,
    pub spin: f64,
}

/// A section in motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation {
    triad: Triad,
    /// r′
    slope: Vector,
    velocity: Rate,
    acceleration: Rate,
    /// J₁, J₂, J₃ and β.
    inertia: [f64; 3],
    damping: f64,
    /// ω, ω̇, H and Y.
    angular_velocity: Vector,
    angular_acceleration: Vector,
    momentum: Vector,
    moment: Vector,
}

impl Rotation {
    /// The section with these axes and rates; J₁, J₂, J₃ and β.
    #[inline]
    pub fn new(
        triad: &Triad,
        velocity: Rate,
        acceleration: Rate,
        inertia: [f64; 3],
        damping: f64,
    ) -> Rotation {
        let slope = times(triad.length, triad.tangent);
        let inverse = 1.0 / (triad.length * triad.length);
        let swing = times(inverse, cross(slope, velocity.slope));
        let omega = plus(swing, velocity.spin, triad.tangent);
        let rate = cross(omega, triad.tangent);
        let mut omega_rate = plus(times(acceleration.spin, triad.tangent), velocity.spin, rate);
        omega_rate = plus(omega_rate, inverse, cross(slope, acceleration.slope));
        omega_rate = plus(omega_rate, -2.0 * inverse * inner(slope, velocity.slope), swing);
        let mut out = Rotation {
            triad: *triad,
            slope,
            velocity,
            acceleration,
            inertia,
            damping,
            angular_velocity: omega,
            angular_acceleration: omega_rate,
            momentum: [0.0; 3],
            moment: [0.0; 3],
        };
        out.momentum = out.times_inertia(omega);
        let moment = plus(out.times_inertia(omega_rate), damping, out.momentum);
        out.moment = plus(moment, 1.0, cross(omega, out.momentum));
        out
    }

    /// J x
    #[inline(always)]
    fn times_inertia(&self, x: Vector) -> Vector {
        let [x, y, z] = self.triad.inward(x);
        let [a, b, c] = self.inertia;
        self.triad.outward([a * x, b * y, c * z])
    }

    /// ω and ω̇
    pub fn angular_motion(&self) -> [Vector; 2] {
        [self.angular_velocity, self.angular_acceleration]
    }

    /// H
    pub fn angular_momentum(&self) -> Vector {
        self.momentum
    }

    /// ½ ω·H
    pub fn energy(&self) -> f64 {
        0.5 * inner(self.angular_velocity, self.momentum)
    }

    /// The forces on r′ and on the spin.
    #[inline]
    pub fn force(&self) -> Rate {
        let inverse = 1.0 / (self.triad.length * self.triad.length);
        Rate {
            slope: times(inverse, cross(self.moment, self.slope)),
            spin: inner(self.triad.tangent, self.moment),
        }
    }

    /// How the forces change with variations of configuration, velocity and acceleration.
    #[inline]
    pub fn derivative(&self, q: Rate, v: Rate, a: Rate) -> Rate {
        let (g, t, length) = (self.slope, self.triad.tangent, self.triad.length);
        let inverse = 1.0 / (length * length);
        let (spin, speed) = (self.velocity.spin, self.velocity.slope);
        let stretch = inner(t, q.slope) / length;
        let dt = times(1.0 / length, plus(q.slope, -inner(t, q.slope), t));
        let dtheta = plus(times(inverse, cross(g, q.slope)), q.spin, t);
        // r′ × ṙ′/|r′|² and its variation.
        let swing = times(inverse, cross(g, speed));
        let moved = plus(cross(q.slope, speed), 1.0, cross(g, v.slope));
        let dswing = plus(times(inverse, moved), -2.0 * stretch, swing);
        let domega = plus(plus(dswing, v.spin, t), spin, dt);
        // ṫ = ω × t.
        let rate = cross(self.angular_velocity, t);
        let drate = plus(cross(domega, t), 1.0, cross(self.angular_velocity, dt));
        // ω̇ in its four parts.
        let mut dacceleration = plus(times(a.spin, t), self.acceleration.spin, dt);
        dacceleration = plus(plus(dacceleration, v.spin, rate), spin, drate);
        let swept = cross(g, self.acceleration.slope);
        let dswept = plus(cross(q.slope, self.acceleration.slope), 1.0, cross(g, a.slope));
        dacceleration = plus(plus(dacceleration, inverse, dswept), -2.0 * stretch * inverse, swept);
        let growth = inner(g, speed) * inverse;
        let dgrowth = (inner(q.slope, speed) + inner(g, v.slope)) * inverse - 2.0 * stretch * growth;
        dacceleration = plus(plus(dacceleration, -2.0 * dgrowth, swing), -2.0 * growth, dswing);
        // J turns with the section: δ(J x) = δθ × J x + J (δx − δθ × x).
        let of = |x: Vector, jx: Vector, dx: Vector| {
            plus(cross(dtheta, jx), 1.0, self.times_inertia(plus(dx, -1.0, cross(dtheta, x))))
        };
        let dmomentum = of(self.angular_velocity, self.momentum, domega);
        let acceleration = self.angular_acceleration;
        let mut dmoment = of(acceleration, self.times_inertia(acceleration), dacceleration);
        dmoment = plus(dmoment, self.damping, dmomentum);
        dmoment = plus(dmoment, 1.0, cross(domega, self.momentum));
        dmoment = plus(dmoment, 1.0, cross(self.angular_velocity, dmomentum));
        let force = plus(cross(dmoment, g), 1.0, cross(self.moment, q.slope));
        let force = plus(times(inverse, force), -2.0 * stretch * inverse, cross(self.moment, g));
        Rate { slope: force, spin: inner(dt, self.moment) + inner(t, dmoment) }
    }
}
