//! A point and the surface before it: gap, sliding velocity and their rates.

use crate::contact::obstacle::{Obstacle, Surface};
use crate::contact::points::{Curve, PointMotion, Points};
use crate::linalg::vector::{cross, inner};
use crate::system::State;

/// A point and the surface before it.
pub(super) struct Touch {
    pub motion: PointMotion,
    pub surface: Surface,
    /// w = ṗ − u
    pub velocity: [f64; 3],
    /// Arc length of the nearest point of a curve.
    pub station: Option<f64>,
    /// ġ
    pub rate: f64,
    /// c, the velocity of what touches: w, of a ball w − R ω × n.
    pub touching: [f64; 3],
    /// t₁·c, t₂·c
    pub sliding: [f64; 2],
}

pub(super) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// Σ xᵢ aᵢ
pub(super) fn sum<const N: usize>(terms: [(f64, [f64; 3]); N]) -> [f64; 3] {
    [0, 1, 2].map(|i| terms.iter().map(|(x, a)| x * a[i]).sum())
}

impl Touch {
    /// Of point `k` of a model before an obstacle.
    pub fn new(model: &mut impl Points, k: usize, obstacle: &dyn Obstacle, s: &State) -> Touch {
        model.approach(k, s, obstacle);
        let (motion, station) = (model.motion(k, s), model.station(k));
        let mut surface = obstacle.surface(motion.position, s.time());
        surface.gap -= motion.radius;
        let velocity = minus(motion.velocity, surface.velocity);
        let swept = cross(motion.spin, surface.normal);
        let touching = sum([(1.0, velocity), (-motion.radius, swept)]);
        let (rate, sliding) = (inner(surface.normal, velocity), surface.tangents.map(|t| inner(t, touching)));
        Touch { motion, surface, velocity, station, rate, touching, sliding }
    }

    /// g̈
    pub fn acceleration(&self) -> f64 {
        let (path, bend) = self.path();
        inner(self.surface.normal, bend) + inner(self.turned(path)[0], self.velocity)
    }

    /// Rate of the sliding velocity along tangent `i`.
    pub fn sliding_rate(&self, i: usize) -> f64 {
        let PointMotion { radius, spin, spin_rate, .. } = self.motion;
        let ((path, bend), normal) = (self.path(), self.surface.normal);
        let turned = self.turned(path);
        let swept = sum([(1.0, cross(spin_rate, normal)), (1.0, cross(spin, turned[0]))]);
        let bend = sum([(1.0, bend), (-radius, swept)]);
        inner(self.surface.tangents[i], bend) + inner(turned[1 + i], self.touching)
    }

    /// w + p′ṡ, by which the point moves past the obstacle, and ẇ on that path.
    fn path(&self) -> ([f64; 3], [f64; 3]) {
        let bend = minus(self.motion.acceleration, self.surface.acceleration);
        let Some(Curve { slope, slope_rate, .. }) = self.motion.curve else { return (self.velocity, bend) };
        let moved = self.moved(self.velocity, slope_rate);
        (sum([(1.0, self.velocity), (moved, slope)]), sum([(1.0, bend), (moved, slope_rate)]))
    }

    /// By how much s of the nearest point changes when the material point there moves by `x` and p′ by `slope`.
    pub fn moved(&self, x: [f64; 3], slope: [f64; 3]) -> f64 {
        let Some(curve) = self.motion.curve else { return 0.0 };
        let normal = self.surface.normal;
        let stiffness = inner(normal, curve.bend) + inner(self.turned(curve.slope)[0], curve.slope);
        -(inner(normal, slope) + inner(self.turned(x)[0], curve.slope)) / stiffness
    }

    /// ∂n/∂p x, ∂t₁/∂p x and ∂t₂/∂p x.
    pub fn turned(&self, x: [f64; 3]) -> [[f64; 3]; 3] {
        let Surface { normal, tangents: [t1, t2], curvatures: [k1, k2], twist, .. } = self.surface;
        let (first, second, turn) = (k1 * inner(t1, x), k2 * inner(t2, x), inner(twist, x));
        [
            sum([(first, t1), (second, t2)]),
            sum([(-first, normal), (turn, t2)]),
            sum([(-second, normal), (-turn, t1)]),
        ]
    }

    /// The force and, on a ball, its moment.
    pub fn wrench(&self, force: [f64; 3]) -> [[f64; 3]; 2] {
        [force, cross(self.surface.normal, force).map(|x| -self.motion.radius * x)]
    }
}
