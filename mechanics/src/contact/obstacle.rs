//! Obstacles: rigid surfaces that a point may touch, at rest or moved as prescribed.
//!
//! A surface is given by its signed distance g(p, t), positive outside, with n = ∇g, |n| = 1 and the curvatures κ₁, κ₂
//! along the tangents t₁, t₂:
//!
//! ```text
//! ∇∇g = κ₁ t₁t₁ᵀ + κ₂ t₂t₂ᵀ,   ∂g/∂t = −n·u,   t₁ = e_z × n in the plane
//! ∂t₁/∂p x = −κ₁ (t₁·x) n + (τ·x) t₂,   ∂t₂/∂p x = −κ₂ (t₂·x) n − (τ·x) t₁
//! ```
//!
//! τ, the rotation of the tangents about the normal, vanishes on planes and cylinders; a sphere has no tangents without it.
//!
//! Obstacles of planar systems are cylinders over the plane of motion: their normals have no component along z.

use crate::linalg::vector::{cross, inner};
use crate::profile::{Profile, jumping_derivative};
use crate::system::{Break, Jump};
use std::sync::Arc;

/// The surface of an obstacle as seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Signed distance g of the point \[m\]; negative inside.
    pub gap: f64,
    /// Unit normal n, out of the obstacle.
    pub normal: [f64; 3],
    /// Unit tangents t₁, t₂.
    pub tangents: [[f64; 3]; 2],
    /// Curvatures κ₁, κ₂ \[1/m\].
    pub curvatures: [f64; 2],
    /// Rotation τ of the tangents about the normal \[1/m\].
    pub twist: [f64; 3],
    /// Velocity u of the obstacle \[m/s\].
    pub velocity: [f64; 3],
    /// Acceleration u̇ of the obstacle \[m/s²\].
    pub acceleration: [f64; 3],
}

/// A rigid obstacle.
pub trait Obstacle: std::fmt::Debug + Send + Sync {
    /// The surface as seen from the point `p` \[m\] at time `t` \[s\].
    fn surface(&self, p: [f64; 3], t: f64) -> Surface;

    /// The number of the point that is nearest to it, or deepest in it; 0 where there is none.
    fn nearest(&self, points: &[[f64; 3]], t: f64) -> usize {
        let gap = |(i, p): (usize, &[f64; 3])| (i, self.surface(*p, t).gap);
        points.iter().enumerate().map(gap).min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i)
    }

    /// Times at which its motion is not smooth.
    fn breaks(&self) -> Vec<Break> {
        Vec::new()
    }

    /// Points of its surface near `p` \[m\] at time `t` \[s\], to be drawn as a line in the plane of motion; `size` \[m\] is that of
    /// the system.
    fn outline(&self, p: [f64; 3], t: f64, size: f64) -> Vec<[f64; 3]>;

    /// The same to be drawn in space, one line.
    fn outline_in_space(&self, p: [f64; 3], t: f64, size: f64) -> Vec<[f64; 3]>;
}

/// A prescribed translation of an obstacle: x(t) d.
#[derive(Clone, Debug)]
pub struct Translation {
    /// Direction d.
    pub direction: [f64; 3],
    /// Displacement x(t) along d \[m\] for |d| = 1.
    pub displacement: Arc<dyn Profile>,
}

impl Translation {
    /// Displacement, velocity and acceleration at `t`.
    fn at(motion: Option<&Translation>, t: f64) -> [[f64; 3]; 3] {
        let Some(Translation { direction, displacement: x }) = motion else { return [[0.0; 3]; 3] };
        [x.value(t), x.rate(t), x.acceleration(t)].map(|x| direction.map(|d| d * x))
    }

    fn breaks(motion: Option<&Translation>) -> Vec<Break> {
        let Some(Translation { displacement: x, .. }) = motion else { return Vec::new() };
        let jump = |time| match jumping_derivative(x.as_ref(), time) {
            0 | 1 => Jump::Velocity,
            2 => Jump::Acceleration,
            _ => Jump::Slope,
        };
        let smooth = x.resolution().iter().map(|&time| Break { time, jump: Jump::Nothing });
        x.breaks().iter().map(|&time| Break { time, jump: jump(time) }).chain(smooth).collect()
    }
}

fn plus(a: [f64; 3], b: [f64; 3], factor: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + factor * b[i])
}

/// Tangents of a normal: e_z × n and n × (e_z × n), or e_x and e_y where n is along z.
fn tangents(n: [f64; 3]) -> [[f64; 3]; 2] {
    let across = libm::hypot(n[0], n[1]);
    if across == 0.0 {
        return [[1.0, 0.0, 0.0], [0.0, n[2], 0.0]];
    }
    let t = [-n[1] / across, n[0] / across, 0.0];
    [t, [-n[2] * t[1], n[2] * t[0], n[0] * t[1] - n[1] * t[0]]]
}

/// A half-space behind a plane.
#[derive(Clone, Debug)]
pub struct Plane {
    /// A point of the plane \[m\].
    pub point: [f64; 3],
    /// Unit normal, out of the obstacle.
    pub normal: [f64; 3],
    /// How it moves; `None` at rest.
    pub motion: Option<Translation>,
}

impl Plane {
    /// Half-space to the right of a line through `point` at `angle` \[rad\] against the x axis.
    pub fn inclined(point: [f64; 3], angle: f64, motion: Option<Translation>) -> Plane {
        let (sin, cos) = libm::sincos(angle);
        Plane { point, normal: [-sin, cos, 0.0], motion }
    }
}

impl Obstacle for Plane {
    fn surface(&self, p: [f64; 3], t: f64) -> Surface {
        let [place, velocity, acceleration] = Translation::at(self.motion.as_ref(), t);
        let gap = inner(self.normal, plus(plus(p, self.point, -1.0), place, -1.0));
        let tangents = tangents(self.normal);
        let (curvatures, twist) = ([0.0; 2], [0.0; 3]);
        Surface { gap, normal: self.normal, tangents, curvatures, twist, velocity, acceleration }
    }

    fn breaks(&self) -> Vec<Break> {
        Translation::breaks(self.motion.as_ref())
    }

    fn outline(&self, p: [f64; 3], t: f64, size: f64) -> Vec<[f64; 3]> {
        let surface = self.surface(p, t);
        let foot = plus(p, surface.normal, -surface.gap);
        [-size, size].map(|x| plus(foot, surface.tangents[0], x)).to_vec()
    }

    /// A square.
    fn outline_in_space(&self, p: [f64; 3], t: f64, size: f64) -> Vec<[f64; 3]> {
        let surface = self.surface(p, t);
        let (foot, [t1, t2]) = (plus(p, surface.normal, -surface.gap), surface.tangents);
        let corner = |[x, y]: [f64; 2]| plus(plus(foot, t1, size * x), t2, size * y);
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]].map(corner).to_vec()
    }
}

/// A circular cylinder: with its axis along z a circle in the plane of motion.
#[derive(Clone, Debug)]
pub struct Circle {
    /// Centre, a point of the axis \[m\].
    pub centre: [f64; 3],
    /// Unit vector along the axis.
    pub axis: [f64; 3],
    /// Radius \[m\].
    pub radius: f64,
    /// Whether the points are inside it, in a hole, rather than outside.
    pub hollow: bool,
    /// How it moves; `None` at rest.
    pub motion: Option<Translation>,
}

impl Obstacle for Circle {
    fn surface(&self, p: [f64; 3], t: f64) -> Surface {
        let [place, velocity, acceleration] = Translation::at(self.motion.as_ref(), t);
        let from = plus(plus(p, self.centre, -1.0), place, -1.0);
        let from = plus(from, self.axis, -inner(self.axis, from));
        let distance = libm::hypot(libm::hypot(from[0], from[1]), from[2]);
        let side = if self.hollow { -1.0 } else { 1.0 };
        // On the axis every direction is as near.
        let normal = match distance {
            0.0 => tangents(self.axis)[0].map(|x| side * x),
            _ => from.map(|x| side * x / distance),
        };
        let curvature = side / distance.max(1e-3 * self.radius);
        Surface {
            gap: side * (distance - self.radius),
            normal,
            tangents: [cross(self.axis, normal), self.axis],
            curvatures: [curvature, 0.0],
            twist: [0.0; 3],
            velocity,
            acceleration,
        }
    }

    fn breaks(&self) -> Vec<Break> {
        Translation::breaks(self.motion.as_ref())
    }

    fn outline(&self, _p: [f64; 3], t: f64, _size: f64) -> Vec<[f64; 3]> {
        const SIDES: usize = 72;
        let [place, ..] = Translation::at(self.motion.as_ref(), t);
        let centre = plus(self.centre, place, 1.0);
        let [first, second] = tangents(self.axis);
        let around = |k: usize| {
            let (sin, cos) = libm::sincos(k as f64 * std::f64::consts::TAU / SIDES as f64);
            plus(plus(centre, first, self.radius * cos), second, self.radius * sin)
        };
        (0..=SIDES).map(around).collect()
    }

    /// A circle on either side of the point.
    fn outline_in_space(&self, p: [f64; 3], t: f64, size: f64) -> Vec<[f64; 3]> {
        let circle = self.outline(p, t, size);
        let at = |side: f64| {
            circle.iter().map(move |x| plus(*x, self.axis, inner(self.axis, plus(p, *x, -1.0)) + side * size))
        };
        at(-1.0).chain(at(1.0)).collect()
    }
}

/// A ball, or the outside of a hollow one.
#[derive(Clone, Debug)]
pub struct Sphere {
    /// Centre \[m\].
    pub centre: [f64; 3],
    /// Radius \[m\].
    pub radius: f64,
    /// Whether the points are inside it rather than outside.
    pub hollow: bool,
    /// How it moves; `None` at rest.
    pub motion: Option<Translation>,
}

impl Obstacle for Sphere {
    fn surface(&self, p: [f64; 3], t: f64) -> Surface {
        let [place, velocity, acceleration] = Translation::at(self.motion.as_ref(), t);
        let from = plus(plus(p, self.centre, -1.0), place, -1.0);
        let distance = libm::hypot(libm::hypot(from[0], from[1]), from[2]);
        let side = if self.hollow { -1.0 } else { 1.0 };
        // In the centre every direction is as near.
        let normal = match distance {
            0.0 => [0.0, 0.0, side],
            _ => from.map(|x| side * x / distance),
        };
        let tangents = tangents(normal);
        let curvature = side / distance.max(1e-3 * self.radius);
        // t₁ is along the circles of latitude, which turn at the poles.
        let across = libm::hypot(normal[0], normal[1]);
        let turn = if across > 0.0 { curvature * normal[2] / across } else { 0.0 };
        Surface {
            gap: side * (distance - self.radius),
            normal,
            tangents,
            curvatures: [curvature; 2],
            twist: tangents[0].map(|x| turn * x),
            velocity,
            acceleration,
        }
    }

    fn breaks(&self) -> Vec<Break> {
        Translation::breaks(self.motion.as_ref())
    }

    fn outline(&self, p: [f64; 3], t: f64, size: f64) -> Vec<[f64; 3]> {
        let Sphere { centre, radius, hollow, motion } = self.clone();
        Circle { centre, axis: [0.0, 0.0, 1.0], radius, hollow, motion }.outline(p, t, size)
    }

    /// The equator and a circle of longitude, which begin at one point.
    fn outline_in_space(&self, p: [f64; 3], t: f64, size: f64) -> Vec<[f64; 3]> {
        let Sphere { centre, radius, hollow, motion } = self.clone();
        let circle = |axis: [f64; 3]| {
            Circle { centre, axis, radius, hollow, motion: motion.clone() }.outline(p, t, size)
        };
        [[0.0, 0.0, 1.0], [0.0, -1.0, 0.0]].into_iter().flat_map(circle).collect()
    }
}
