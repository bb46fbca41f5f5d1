//! Obstacles that parts carry: the motion of a point as seen from the carrier of its obstacle.
//!
//! With the point x_P and the frame x, R of the carrier, its angular velocity ω and α = ω̇, d = x_P − x, and ω_P of a ball,
//!
//! ```text
//! p = Rᵀd                                       δp = Rᵀ(δx_P − δx − δθ × d)
//! ṗ = Rᵀw,  w = ḋ − ω × d                       δṗ = Rᵀ(δẋ_P − ω × δx_P − (δẋ + δω × d − ω × δx + δθ × w))
//! p̈ = Rᵀ(d̈ − α × d − ω × (ω × d) − 2ω × w)
//! ω_rel = Rᵀ(ω_P − ω)                           δω_rel = Rᵀ(δω_P − δω − δθ × (ω_P − ω))
//! p′ = Rᵀr′ on a curve                          δp′ = Rᵀ(δr′ − δθ × r′)
//! ```
//!
//! δẋ and δω are those by the configuration at constant velocities. A force f and a moment m on the point, in space, act back on the carrier:
//!
//! ```text
//! Q_P = J_Pᵀ(f, m),   Q = −Jᵀ(f, d × f + m),   δf = δθ × f,  δm = δθ × m
//! ```

use super::marker::Pose;
use crate::contact::{Curve, Obstacle, PointMotion, Surface, Variation};
use crate::linalg::{Matrix, Vec3};

/// The motion of a point as seen from `carrier`.
pub(super) fn relative(of: &PointMotion, carrier: &Pose) -> PointMotion {
    let back = carrier.axes.transpose();
    let (spin, d) = (carrier.spin, of.position - carrier.position);
    let w = of.velocity - carrier.velocity - spin.cross(d);
    let carried = carrier.spin_rate.cross(d) + spin.cross(spin.cross(d)) + 2.0 * spin.cross(w);
    let curve = |curve: Curve| Curve {
        slope: back * curve.slope,
        curvature: back * curve.curvature,
        slope_rate: back * (curve.slope_rate - spin.cross(curve.slope)),
    };
    PointMotion {
        position: back * d,
        velocity: back * w,
        acceleration: back * (of.acceleration - carrier.acceleration - carried),
        spin: back * (of.spin - spin),
        spin_rate: back * (of.spin_rate - carrier.spin_rate - spin.cross(of.spin)),
        curve: of.curve.map(curve),
        ..*of
    }
}

/// Turns the derivatives of the motion of a point in space into those of its motion as seen from `carrier`, whose own follow.
pub(super) fn vary(of: &PointMotion, carrier: &Pose, out: &mut Vec<Variation>) {
    let back = carrier.axes.transpose();
    let (spin, d) = (carrier.spin, of.position - carrier.position);
    let w = of.velocity - carrier.velocity - spin.cross(d);
    let (turned, slope) = (of.spin - spin, of.curve.unwrap_or_default().slope);
    for by in out.iter_mut() {
        *by = Variation {
            unknown: by.unknown,
            position: back * by.position,
            velocity: back * (by.velocity - spin.cross(by.position)),
            rotation: back * by.rotation,
            spin: back * by.spin,
            slope: back * by.slope,
        };
    }
    let of_carrier = |by: Variation| Variation {
        unknown: by.unknown,
        position: -(back * (by.position + by.rotation.cross(d))),
        velocity: -(back * (by.velocity + by.spin.cross(d) - spin.cross(by.position) + by.rotation.cross(w))),
        rotation: -(back * by.rotation),
        spin: -(back * (by.spin + by.rotation.cross(turned))),
        slope: -(back * by.rotation.cross(slope)),
    };
    out.extend(carrier.variations().map(of_carrier));
}

/// Adds w ∂(Q_P, Q)/∂q of the wrench (f, m) on the point at `position`, which `moved` varies, but for the curvatures ∂J of both markers.
pub(super) fn add_cross_curvature(
    (moved, position): (&[Variation], Vec3),
    carrier: &Pose,
    [force, moment]: [Vec3; 2],
    w: f64,
    out: &mut Matrix,
) {
    let d = position - carrier.position;
    for by in carrier.variations() {
        let [f, m] = [by.rotation.cross(force), by.rotation.cross(moment)];
        for row in moved {
            out.add(row.unknown, by.unknown, w * (row.position.dot(f) + row.rotation.dot(m)));
        }
        let turn = d.cross(f) - by.position.cross(force) + m;
        for row in carrier.variations() {
            out.add(row.unknown, by.unknown, -w * (row.position.dot(f) + row.rotation.dot(turn)));
        }
    }
    for by in moved {
        let turn = by.position.cross(force);
        for row in carrier.variations() {
            out.add(row.unknown, by.unknown, -w * row.rotation.dot(turn));
        }
    }
}

/// An obstacle as it stands in space.
#[derive(Debug)]
pub(super) struct Mounted<'a> {
    obstacle: &'a dyn Obstacle,
    carrier: &'a Pose,
}

impl<'a> Mounted<'a> {
    /// On a carrier that has been placed.
    pub(super) fn new(obstacle: &'a dyn Obstacle, carrier: &'a Pose) -> Mounted<'a> {
        Mounted { obstacle, carrier }
    }
}

/// Its velocities are those in the axes of its carrier.
impl Obstacle for Mounted<'_> {
    fn surface(&self, p: Vec3, t: f64) -> Surface {
        let surface = self.obstacle.surface(self.carrier.within(p), t);
        let turn = |x: Vec3| self.carrier.axes * x;
        Surface {
            normal: turn(surface.normal),
            tangents: surface.tangents.map(turn),
            twist: turn(surface.twist),
            velocity: turn(surface.velocity),
            acceleration: turn(surface.acceleration),
            ..surface
        }
    }

    fn outline(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3> {
        self.placed(self.obstacle.outline(self.carrier.within(p), t, size))
    }

    fn outline_in_space(&self, p: Vec3, t: f64, size: f64) -> Vec<Vec3> {
        self.placed(self.obstacle.outline_in_space(self.carrier.within(p), t, size))
    }
}

impl Mounted<'_> {
    /// Points of the carrier's axes in space.
    fn placed(&self, points: Vec<Vec3>) -> Vec<Vec3> {
        points.into_iter().map(|p| self.carrier.position + self.carrier.axes * p).collect()
    }
}
