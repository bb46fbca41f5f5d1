//! Inertia of the rotation of a section in the exact coupling: rotary inertia ρI and first mass moment ρS
//! at one point of the axis, as forces on p and p′, as a torque on the hub, and their tangents. Symbols and
//! equations as in [`super::exact`].

use super::hub::absolute;
use super::inertia::Totals;
use crate::linalg::vector::inner;
use crate::profile::HubKinematics;
use crate::system::Weights;

/// The rotation of a section: everything the inertia of its rotation needs.
pub struct SectionRotation {
    p: [f64; 2],
    velocity: [f64; 2],
    /// ℓ, t, n
    stretch: f64,
    t: [f64; 2],
    n: [f64; 2],
    slope_velocity: [f64; 2],
    slope_acceleration: [f64; 2],
    /// φ̇, φ̈ relative to the hub; t·ṗ′
    rate: f64,
    rate_rate: f64,
    along: f64,
    /// Ω, Ω̇
    spin: f64,
    spin_rate: f64,
    /// Absolute acceleration of the axis, in the hub's frame.
    acceleration: [f64; 2],
}

/// c₁ a + c₂ b
fn sum(c1: f64, a: [f64; 2], c2: f64, b: [f64; 2]) -> [f64; 2] {
    [c1 * a[0] + c2 * b[0], c1 * a[1] + c2 * b[1]]
}

impl SectionRotation {
    /// The rotation at a point p with slope p′, their rates and their accelerations.
    pub fn new(
        p: [f64; 2],
        slope: [f64; 2],
        [velocity, slope_velocity]: [[f64; 2]; 2],
        [acceleration, slope_acceleration]: [[f64; 2]; 2],
        hub: &HubKinematics,
    ) -> SectionRotation {
        let stretch = libm::hypot(slope[0], slope[1]);
        let t = [slope[0] / stretch, slope[1] / stretch];
        let n = [-t[1], t[0]];
        let rate = inner(n, slope_velocity) / stretch;
        let along = inner(t, slope_velocity);
        let rate_rate = (inner(n, slope_acceleration) - 2.0 * rate * along) / stretch;
        SectionRotation {
            p,
            velocity,
            stretch,
            t,
            n,
            slope_velocity,
            slope_acceleration,
            rate,
            rate_rate,
            along,
            spin: hub.speed + rate,
            spin_rate: hub.acceleration + rate_rate,
            acceleration: absolute(p, velocity, acceleration, hub),
        }
    }

    /// Forces on p and on p′.
    pub fn force(&self, rotary: f64, first: f64) -> ([f64; 2], [f64; 2]) {
        let value = sum(-first * self.spin_rate, self.t, -first * self.spin * self.spin, self.n);
        let couple = rotary * self.spin_rate - first * inner(self.t, self.acceleration);
        (value, sum(couple / self.stretch, self.n, 0.0, self.n))
    }

    /// Derivative of [`SectionRotation::force`] for a unit `seed` of p (or of p′ if `slope`), moving positions,
    /// velocities and accelerations by the weights.
    pub fn derivative(
        &self,
        seed: [f64; 2],
        slope: bool,
        hub: &HubKinematics,
        w: &Weights<'_>,
        rotary: f64,
        first: f64,
    ) -> ([f64; 2], [f64; 2]) {
        let (t, n, l) = (self.t, self.n, self.stretch);
        let (mut dphi, mut dl, mut drate, mut drate_rate) = (0.0, 0.0, 0.0, 0.0);
        let mut dacceleration = [0.0; 2];
        if slope {
            let (tangential, normal) = (inner(t, seed), inner(n, seed));
            dphi = w.q * normal / l;
            dl = w.q * tangential;
            drate = (w.v * normal - self.along * dphi - self.rate * dl) / l;
            let dalong = dphi * inner(n, self.slope_velocity) + w.v * tangential;
            drate_rate = (w.a * normal
                - dphi * inner(t, self.slope_acceleration)
                - 2.0 * (drate * self.along + self.rate * dalong)
                - self.rate_rate * dl)
                / l;
        } else {
            let scaled = |c: f64| [c * seed[0], c * seed[1]];
            dacceleration = absolute(scaled(w.q), scaled(w.v), scaled(w.a), hub);
        }
        let spin = self.spin;
        let value = sum(
            first * (-drate_rate + spin * spin * dphi),
            t,
            -first * (self.spin_rate * dphi + 2.0 * spin * drate),
            n,
        );
        let couple = rotary * self.spin_rate - first * inner(t, self.acceleration);
        let dcouple =
            rotary * drate_rate - first * (dphi * inner(n, self.acceleration) + inner(t, dacceleration));
        (value, sum((dcouple - couple * dl / l) / l, n, -couple * dphi / l, t))
    }

    /// Derivative of the torque of [`SectionRotation::totals`] for a `seed` as in [`SectionRotation::derivative`].
    pub fn torque_derivative(
        &self,
        seed: [f64; 2],
        slope: bool,
        hub: &HubKinematics,
        w: &Weights<'_>,
        rotary: f64,
        first: f64,
    ) -> f64 {
        let jp = [-self.p[1], self.p[0]];
        let (value, _) = self.derivative(seed, slope, hub, w, rotary, first);
        let moment = inner(value, jp);
        if slope {
            // The couple ρIΩ̇ − ρS t·A acts on δp′ through n/ℓ: its derivative is read off there, and what
            // the derivative of n/ℓ adds is along t.
            let (_, on_slope) = self.derivative(seed, true, hub, w, rotary, first);
            let couple = rotary * self.spin_rate - first * inner(self.t, self.acceleration);
            let dl = w.q * inner(self.t, seed);
            return moment + self.stretch * inner(on_slope, self.n) + couple * dl / self.stretch;
        }
        let (force, _) = self.force(rotary, first);
        let jseed = [-w.q * seed[1], w.q * seed[0]];
        let scaled = |c: f64| [c * seed[0], c * seed[1]];
        let dacceleration = absolute(scaled(w.q), scaled(w.v), scaled(w.a), hub);
        moment + inner(force, jseed) - first * inner(self.t, dacceleration)
    }

    /// Derivatives of the forces on p and p′ and of the torque by the motion of the hub, weighted.
    pub fn by_hub(
        &self,
        hub: &HubKinematics,
        w: &Weights<'_>,
        rotary: f64,
        first: f64,
    ) -> ([f64; 2], [f64; 2], f64) {
        let jp = [-self.p[1], self.p[0]];
        let jv = [-self.velocity[1], self.velocity[0]];
        let value = sum(-first * w.a, self.t, -2.0 * first * self.spin * w.v, self.n);
        // A by ω and ω̇.
        let dacceleration = sum(1.0, sum(w.a, jp, 2.0 * w.v, jv), -2.0 * hub.speed * w.v, self.p);
        let couple = rotary * w.a - first * inner(self.t, dacceleration);
        let slope = sum(couple / self.stretch, self.n, 0.0, self.n);
        (value, slope, couple + inner(value, jp))
    }

    /// ½ρIΩ² − ρSΩ (ṗ + ωJp)·t, its derivative by ω, and the moment of the inertia forces about the hub's axis.
    pub fn totals(&self, rotary: f64, first: f64, hub: &HubKinematics) -> Totals {
        let jp = [-self.p[1], self.p[0]];
        let along = inner(sum(1.0, self.velocity, hub.speed, jp), self.t);
        let (value, _) = self.force(rotary, first);
        Totals {
            kinetic: 0.5 * rotary * self.spin * self.spin - first * self.spin * along,
            momentum: rotary * self.spin - first * (along + self.spin * inner(jp, self.t)),
            torque: rotary * self.spin_rate + inner(value, jp) - first * inner(self.t, self.acceleration),
        }
    }
}
