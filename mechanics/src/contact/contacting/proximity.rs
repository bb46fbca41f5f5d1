//! A point and the surface before it: gap, sliding velocity and their rates.

use crate::contact::obstacle::{Obstacle, Surface};
use crate::contact::points::{Curve, PointMotion, Points, TOUCHING};
use crate::linalg::Vec3;
use crate::system::State;

/// Square of the speed over twice the acceleration and the way, up to which one is what the other makes of it, twice that of a constant acceleration.
const AT_REST: f64 = 4.0;

/// A point and the surface before it.
pub(super) struct Proximity {
    pub motion: PointMotion,
    pub surface: Surface,
    /// w = ṗ − u
    pub velocity: Vec3,
    /// Arc length of the nearest point of a curve.
    pub station: Option<f64>,
    /// ġ
    pub rate: f64,
    /// c, the velocity of what touches: w, of a ball w − R ω × n.
    pub touching: Vec3,
    /// t₁·c, t₂·c
    pub sliding: [f64; 2],
}

impl Proximity {
    /// Of point `k` of a model before an obstacle; `planar` where its friction has one row, along the first tangent.
    pub fn new(
        model: &mut impl Points,
        k: usize,
        obstacle: &dyn Obstacle,
        planar: bool,
        s: &State,
    ) -> Proximity {
        model.approach(k, s, obstacle);
        let (motion, station) = (model.motion(k, s), model.station(k));
        let mut surface = obstacle.surface(motion.position, s.time());
        surface.gap -= motion.radius;
        if planar {
            surface = surface.in_plane();
        }
        let velocity = motion.velocity - surface.velocity;
        let swept = motion.spin.cross(surface.normal);
        let touching = velocity - motion.radius * swept;
        let (rate, sliding) = (surface.normal.dot(velocity), surface.tangents.map(|t| t.dot(touching)));
        Proximity { motion, surface, velocity, station, rate, touching, sliding }
    }

    /// Whether point `k` is known not to touch, at less cost than that of its motion.
    pub fn is_away(model: &mut impl Points, k: usize, obstacle: &dyn Obstacle, s: &State) -> bool {
        if model.station(k).is_some() {
            // It would have to be found for that.
            return false;
        }
        model.approach(k, s, obstacle);
        let placed = model.position(k, s);
        placed.is_some_and(|(position, radius)| obstacle.surface(position, s.time()).gap > radius)
    }

    /// The speed −ġ with which it touches; 0 where it has none but what its acceleration makes of a rounding of the gap, in a system of this `length` \[m\]: a
    /// contact that begins at rest.
    pub fn closing_speed(&self, length: f64) -> f64 {
        let least = AT_REST * self.acceleration().abs() * TOUCHING * length;
        if self.rate < 0.0 && self.rate * self.rate > least { -self.rate } else { 0.0 }
    }

    /// g̈
    pub fn acceleration(&self) -> f64 {
        let (path, acceleration) = self.path();
        self.surface.normal.dot(acceleration) + self.turned(path)[0].dot(self.velocity)
    }

    /// Rate of the sliding velocity along tangent `i`.
    pub fn sliding_rate(&self, i: usize) -> f64 {
        let PointMotion { radius, spin, spin_rate, .. } = self.motion;
        let ((path, acceleration), normal) = (self.path(), self.surface.normal);
        let turned = self.turned(path);
        let swept = spin_rate.cross(normal) + spin.cross(turned[0]);
        let acceleration = acceleration - radius * swept;
        self.surface.tangents[i].dot(acceleration) + turned[1 + i].dot(self.touching)
    }

    /// w + p′ṡ, by which the point moves past the obstacle, and ẇ on that path.
    fn path(&self) -> (Vec3, Vec3) {
        let acceleration = self.motion.acceleration - self.surface.acceleration;
        let Some(Curve { slope, slope_rate, .. }) = self.motion.curve else {
            return (self.velocity, acceleration);
        };
        let moved = self.moved(self.velocity, slope_rate);
        (self.velocity + moved * slope, acceleration + moved * slope_rate)
    }

    /// By how much s of the nearest point changes when the material point there moves by `x` and p′ by `slope`.
    pub fn moved(&self, x: Vec3, slope: Vec3) -> f64 {
        let Some(curve) = self.motion.curve else { return 0.0 };
        let normal = self.surface.normal;
        let stiffness = normal.dot(curve.curvature) + self.turned(curve.slope)[0].dot(curve.slope);
        -(normal.dot(slope) + self.turned(x)[0].dot(curve.slope)) / stiffness
    }

    /// ∂n/∂p x, ∂t₁/∂p x and ∂t₂/∂p x.
    pub fn turned(&self, x: Vec3) -> [Vec3; 3] {
        let Surface { normal, tangents: [t1, t2], curvatures: [k1, k2], twist, .. } = self.surface;
        let (first, second, turn) = (k1 * t1.dot(x), k2 * t2.dot(x), twist.dot(x));
        [first * t1 + second * t2, -first * normal + turn * t2, -second * normal - turn * t1]
    }

    /// The force and, on a ball, its moment.
    pub fn wrench(&self, force: Vec3) -> [Vec3; 2] {
        [force, -self.motion.radius * self.surface.normal.cross(force)]
    }
}
