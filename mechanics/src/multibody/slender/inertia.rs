//! Inertia of the rotation of a section.
//!
//! The section rotates with the spin w = ω·t and with its tangent, and H = J ω is its angular momentum per length, J = Λ
//! diag(J₁, J₂, J₃) Λᵀ. With the rates of r′ in the axes of the section, u = Λᵀ ṙ′/|r′| and p = Λᵀ r̈′/|r′|, the components of ω
//! and of ω̇ along t, n, b are
//!
//! ```text
//! ω = w t + r′ × ṙ′/|r′|²                                       = (w, −u₃, u₂)
//! ω̇ = ẇ t + w ṫ + r′ × r̈′/|r′|² − 2 (r′·ṙ′)/|r′|⁴ r′ × ṙ′    = (ẇ, −p₃ + w u₂ + 2u₁u₃, p₂ + w u₃ − 2u₁u₂)
//! δW = δθ·Y,   Y = J ω̇ + ω × J ω + β J ω,   δθ = δΘ t + r′ × δr′/|r′|²
//! ```
//!
//! so that Y₁ belongs to the spin and Λ (0, Y₃, −Y₂)/|r′| to r′; β is the damping in proportion to the mass. With J₂ = J₃ = 0
//! only the spin has inertia.
//!
//! Components of a vector change by what it changes itself and by the rotation of the axes. With d = Λᵀ δr′/|r′| that is
//! δθ = (δΘ, −d₃, d₂), and
//!
//! ```text
//! δu = Λᵀ δṙ′/|r′| − d₁ u − δθ × u,   δp = Λᵀ δr̈′/|r′| − d₁ p − δθ × p
//! ```

use super::triad::Triad;
use crate::linalg::Vec3;

/// Rates of the slope r′ and of the rotation about t: (ṙ′, w) or (r̈′, ẇ), or variations (δr′, δΘ).
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rate {
    pub slope: Vec3,
    pub spin: f64,
}

/// A section in motion; vectors by their components along t, n, b.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rotation {
    triad: Triad,
    /// 1/|r′|
    inverse: f64,
    /// J₁, J₂, J₃ and β.
    inertia: Vec3,
    damping: f64,
    /// u, p, ω, ω̇, H and Y.
    velocity: Vec3,
    acceleration: Vec3,
    angular_velocity: Vec3,
    angular_acceleration: Vec3,
    momentum: Vec3,
    moment: Vec3,
}

/// t, in the axes of the section.
const TANGENT: Vec3 = Vec3::AXES[0];

/// t × x
#[inline(always)]
fn across(Vec3([_, y, z]): Vec3) -> Vec3 {
    Vec3([0.0, -z, y])
}

impl Rotation {
    /// The section with these axes and rates; J₁, J₂, J₃ and β.
    #[inline(always)]
    pub fn new(triad: &Triad, velocity: Rate, acceleration: Rate, inertia: Vec3, damping: f64) -> Rotation {
        let inverse = 1.0 / triad.length;
        let u = inverse * triad.inward(velocity.slope);
        let p = inverse * triad.inward(acceleration.slope);
        let omega = across(u) + velocity.spin * TANGENT;
        let omega_rate = Vec3([
            acceleration.spin,
            -p[2] + velocity.spin * u[1] + 2.0 * u[0] * u[2],
            p[1] + velocity.spin * u[2] - 2.0 * u[0] * u[1],
        ]);
        let momentum = product(inertia, omega);
        let moment = product(inertia, omega_rate) + damping * momentum;
        Rotation {
            triad: *triad,
            inverse,
            inertia,
            damping,
            velocity: u,
            acceleration: p,
            angular_velocity: omega,
            angular_acceleration: omega_rate,
            momentum,
            moment: moment + omega.cross(momentum),
        }
    }

    /// ω and ω̇
    pub fn angular_motion(&self) -> [Vec3; 2] {
        [self.angular_velocity, self.angular_acceleration].map(|x| self.triad.outward(x))
    }

    /// H
    pub fn angular_momentum(&self) -> Vec3 {
        self.triad.outward(self.momentum)
    }

    /// ½ ω·H
    pub fn energy(&self) -> f64 {
        0.5 * self.angular_velocity.dot(self.momentum)
    }

    /// The forces on r′ and on the spin.
    #[inline(always)]
    pub fn force(&self) -> Rate {
        let slope = -self.inverse * across(self.moment);
        Rate { slope: self.triad.outward(slope), spin: self.moment[0] }
    }

    /// The derivative of the forces on r′ and on the spin by both, `[of][by]`: by w\[0\] (δr′, δΘ + turn·δr′) in the configuration,
    /// by w\[1\] (δr′, δΘ) in the velocity and by w\[2\] (δr′, δΘ) in the acceleration.
    #[inline]
    pub fn tangent(&self, turn: Vec3, w: Vec3) -> [[f64; 4]; 4] {
        let mut out = [[0.0; 4]; 4];
        for by in 0..4 {
            let mut unit = Rate::default();
            match by {
                3 => unit.spin = 1.0,
                axis => unit.slope[axis] = 1.0,
            }
            let rate = |c: f64, turn: f64| Rate { slope: c * unit.slope, spin: c * (unit.spin + turn) };
            let turn = turn.dot(unit.slope);
            let change = self.derivative(rate(w[0], turn), rate(w[1], 0.0), rate(w[2], 0.0));
            (0..3).for_each(|of| out[of][by] = change.slope[of]);
            out[3][by] = change.spin;
        }
        out
    }

    /// How the forces change with variations of configuration, velocity and acceleration.
    #[inline(always)]
    fn derivative(&self, q: Rate, v: Rate, a: Rate) -> Rate {
        let inward = |x: Rate| self.inverse * self.triad.inward(x.slope);
        let (d, dv, da) = (inward(q), inward(v), inward(a));
        let turn = across(d) + q.spin * TANGENT;
        let moved = |change: Vec3, x: Vec3| change - d[0] * x - turn.cross(x);
        let (u, w) = (self.velocity, self.angular_velocity[0]);
        let (du, dp) = (moved(dv, u), moved(da, self.acceleration));
        let domega = across(du) + v.spin * TANGENT;
        let dacceleration = Vec3([
            a.spin,
            -dp[2] + v.spin * u[1] + w * du[1] + 2.0 * (du[0] * u[2] + u[0] * du[2]),
            dp[1] + v.spin * u[2] + w * du[2] - 2.0 * (du[0] * u[1] + u[0] * du[1]),
        ]);
        let dmomentum = product(self.inertia, domega);
        let mut dmoment = product(self.inertia, dacceleration) + self.damping * dmomentum;
        dmoment += domega.cross(self.momentum);
        dmoment += self.angular_velocity.cross(dmomentum);
        let force = -self.inverse * across(self.moment);
        let mut dforce = -self.inverse * across(dmoment) - d[0] * force;
        dforce += turn.cross(force);
        Rate { slope: self.triad.outward(dforce), spin: dmoment[0] }
    }
}

/// Component by component.
#[inline(always)]
fn product(x: Vec3, y: Vec3) -> Vec3 {
    Vec3([x[0] * y[0], x[1] * y[1], x[2] * y[2]])
}
