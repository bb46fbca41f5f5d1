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

use crate::linalg::Vec3;
use crate::profile::{Profile, jumping_derivative};
use crate::system::{Break, Jump};
use std::sync::Arc;

/// The surface of an obstacle as seen from a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Signed distance g of the point \[m\]; negative inside.
    pub gap: f64,
    /// Unit normal n, out of the obstacle.
    pub normal: Vec3,
    /// Unit tangents t₁, t₂.
    pub tangents: [Vec3; 2],
    /// Curvatures κ₁, κ₂ \[1/m\].
    pub curvatures: [f64; 2],
    /// Rotation τ of the tangents about the normal \[1/m\].
    pub twist: Vec3,
    /// Velocity u of the obstacle \[m/s\].
    pub velocity: Vec3,
    /// Acceleration u̇ of the obstacle \[m/s²\].
    pub acceleration: Vec3,
}

impl Surface {
    /// The same with the tangents of a planar system, in whose plane t₁ is.
    pub(super) fn in_plane(self) -> Surface {
        Surface { tangents: tangents(self.normal), ..self }
    }
}

/// A rigid obstacle.
pub trait Obstacle: std::fmt::Debug + Send + Sync {
    /// The surface as seen from the point `p` \[m\] at time `t` \[s\].
    fn surface(&self, p: Vec3, t: f64) -> Surface;

    /// The number of the point that is nearest to it, or deepest in it; 0 where there is none.
    fn nearest(&self, points: &[Vec3], t: f64) -> usize {
        let gap = |(i, p): (usize, &Vec3)| (i, self.surface(*p, t).gap);
        points.iter().enumerate().map(gap).min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i)
    }

    /// Times at which its motion is not smooth.
    fn breaks(&self) -> Vec<Break> {
        Vec::new()
    }

    /// Points of its surface near `p` \[m\] at time `t` \[s\], to be drawn as a line in the plane of motion; `size` \[m\] is that of
    /// the system.
    fn outline(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3>;

    /// The same to be drawn in space, one line.
    fn outline_in_space(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3>;
}

/// A prescribed translation of an obstacle: x(t) d.
#[derive(Clone, Debug)]
pub struct Translation {
    /// Direction d.
    pub direction: Vec3,
    /// Displacement x(t) along d \[m\] for |d| = 1.
    pub displacement: Arc<dyn Profile>,
}

impl Translation {
    /// Displacement, velocity and acceleration at `t`.
    fn at(motion: Option<&Translation>, t: f64) -> [Vec3; 3] {
        let Some(Translation { direction, displacement: x }) = motion else { return [Vec3([0.0; 3]); 3] };
        [x.value(t), x.rate(t), x.acceleration(t)].map(|x| x * *direction)
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

/// Axis of the circles along which t₁ of a sphere is: at its ends the tangents turn, and nothing rests there as it does at the top of a ball and the bottom of a bowl.
const POLES: Vec3 = Vec3([0.48, 0.6, 0.64]);

/// Tangents e × n and n × (e × n) of a normal n that is not along e, and |e × n|.
fn around(e: Vec3, n: Vec3) -> ([Vec3; 2], f64) {
    let t = e.cross(n);
    let across = t.norm();
    let t = t / across;
    ([t, n.cross(t)], across)
}

/// Tangents of a normal: e_z × n and n × (e_z × n), or e_x and e_y where n is along z.
fn tangents(n: Vec3) -> [Vec3; 2] {
    let across = libm::hypot(n[0], n[1]);
    if across == 0.0 {
        return [Vec3([1.0, 0.0, 0.0]), Vec3([0.0, n[2], 0.0])];
    }
    let t = [-n[1] / across, n[0] / across, 0.0];
    [Vec3(t), Vec3([-n[2] * t[1], n[2] * t[0], n[0] * t[1] - n[1] * t[0]])]
}

/// A half-space behind a plane.
#[derive(Clone, Debug)]
pub struct Plane {
    /// A point of the plane \[m\].
    pub point: Vec3,
    /// Unit normal, out of the obstacle.
    pub normal: Vec3,
    /// How it moves; `None` at rest.
    pub motion: Option<Translation>,
}

impl Plane {
    /// Half-space to the right of a line through `point` at `angle` \[rad\] against the x axis.
    pub fn inclined(point: Vec3, angle: f64, motion: Option<Translation>) -> Plane {
        let (sin, cos) = libm::sincos(angle);
        Plane { point, normal: Vec3([-sin, cos, 0.0]), motion }
    }
}

impl Obstacle for Plane {
    fn surface(&self, p: Vec3, t: f64) -> Surface {
        let [place, velocity, acceleration] = Translation::at(self.motion.as_ref(), t);
        let gap = self.normal.dot(p - self.point - place);
        let tangents = tangents(self.normal);
        let (curvatures, twist) = ([0.0; 2], [0.0; 3]);
        Surface { gap, normal: self.normal, tangents, curvatures, twist: Vec3(twist), velocity, acceleration }
    }

    fn breaks(&self) -> Vec<Break> {
        Translation::breaks(self.motion.as_ref())
    }

    fn outline(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3> {
        let surface = self.surface(p, t);
        let foot = p - surface.gap * surface.normal;
        [-size, size].map(|x| foot + x * surface.tangents[0]).to_vec()
    }

    /// A square.
    fn outline_in_space(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3> {
        let surface = self.surface(p, t);
        let (foot, [t1, t2]) = (p - surface.gap * surface.normal, surface.tangents);
        let corner = |[x, y]: [f64; 2]| foot + size * x * t1 + size * y * t2;
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]].map(corner).to_vec()
    }
}

/// A circular cylinder: with its axis along z a circle in the plane of motion.
#[derive(Clone, Debug)]
pub struct Circle {
    /// Centre, a point of the axis \[m\].
    pub centre: Vec3,
    /// Unit vector along the axis.
    pub axis: Vec3,
    /// Radius \[m\].
    pub radius: f64,
    /// Whether the points are inside it, in a hole, rather than outside.
    pub hollow: bool,
    /// How it moves; `None` at rest.
    pub motion: Option<Translation>,
}

impl Obstacle for Circle {
    fn surface(&self, p: Vec3, t: f64) -> Surface {
        let [place, velocity, acceleration] = Translation::at(self.motion.as_ref(), t);
        let from = p - self.centre - place;
        let from = from - self.axis.dot(from) * self.axis;
        let distance = libm::hypot(libm::hypot(from[0], from[1]), from[2]);
        let side = if self.hollow { -1.0 } else { 1.0 };
        // On the axis every direction is as near.
        let normal = match distance {
            0.0 => side * tangents(self.axis)[0],
            _ => side * from / distance,
        };
        let curvature = side / distance.max(1e-3 * self.radius);
        Surface {
            gap: side * (distance - self.radius),
            normal,
            tangents: [self.axis.cross(normal), self.axis],
            curvatures: [curvature, 0.0],
            twist: Vec3([0.0; 3]),
            velocity,
            acceleration,
        }
    }

    fn breaks(&self) -> Vec<Break> {
        Translation::breaks(self.motion.as_ref())
    }

    fn outline(&self, _p: Vec3, t: f64, _size: f64) -> Vec<Vec3> {
        const SIDES: usize = 72;
        let [place, ..] = Translation::at(self.motion.as_ref(), t);
        let centre = self.centre + place;
        let [first, second] = tangents(self.axis);
        let around = |k: usize| {
            let (sin, cos) = libm::sincos(k as f64 * std::f64::consts::TAU / SIDES as f64);
            centre + self.radius * cos * first + self.radius * sin * second
        };
        (0..=SIDES).map(around).collect()
    }

    /// A circle on either side of the point.
    fn outline_in_space(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3> {
        let circle = self.outline(p, t, size);
        let at =
            |side: f64| circle.iter().map(move |x| *x + (self.axis.dot(p - *x) + side * size) * self.axis);
        at(-1.0).chain(at(1.0)).collect()
    }
}

/// A ball, or the outside of a hollow one.
#[derive(Clone, Debug)]
pub struct Sphere {
    /// Centre \[m\].
    pub centre: Vec3,
    /// Radius \[m\].
    pub radius: f64,
    /// Whether the points are inside it rather than outside.
    pub hollow: bool,
    /// How it moves; `None` at rest.
    pub motion: Option<Translation>,
}

impl Obstacle for Sphere {
    fn surface(&self, p: Vec3, t: f64) -> Surface {
        let [place, velocity, acceleration] = Translation::at(self.motion.as_ref(), t);
        let from = p - self.centre - place;
        let distance = libm::hypot(libm::hypot(from[0], from[1]), from[2]);
        let side = if self.hollow { -1.0 } else { 1.0 };
        // In the centre every direction is as near.
        let normal = match distance {
            0.0 => [0.0, 0.0, side],
            _ => (side * from / distance).0,
        };
        let curvature = side / distance.max(1e-3 * self.radius);
        // t₁ is along the circles of latitude, which turn at the poles.
        let (tangents, turn) = match around(POLES, Vec3(normal)) {
            (tangents, across) if across > 0.0 => (tangents, curvature * POLES.dot(Vec3(normal)) / across),
            _ => (tangents(Vec3(normal)), 0.0),
        };
        Surface {
            gap: side * (distance - self.radius),
            normal: Vec3(normal),
            tangents,
            curvatures: [curvature; 2],
            twist: turn * tangents[0],
            velocity,
            acceleration,
        }
    }

    fn breaks(&self) -> Vec<Break> {
        Translation::breaks(self.motion.as_ref())
    }

    fn outline(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3> {
        let Sphere { centre, radius, hollow, motion } = self.clone();
        Circle { centre, axis: Vec3([0.0, 0.0, 1.0]), radius, hollow, motion }.outline(p, t, size)
    }

    /// The equator and a circle of longitude, which begin at one point.
    fn outline_in_space(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3> {
        let Sphere { centre, radius, hollow, motion } = self.clone();
        let circle =
            |axis: Vec3| Circle { centre, axis, radius, hollow, motion: motion.clone() }.outline(p, t, size);
        [Vec3::AXES[2], -Vec3::AXES[1]].into_iter().flat_map(circle).collect()
    }
}
