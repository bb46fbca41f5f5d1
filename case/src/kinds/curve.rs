//! The axis of a beam in space without stress.

use super::centreline::{Centreline, Points};
use crate::declaration::Bound::*;
use crate::fault::Fault;
use crate::keys::{keys, quantity, vector};
use crate::kind::{Choice, Kind, Nothing, Of};
use crate::units::{ANGLE, FACTOR, LENGTH};
use flexion::linalg::Vec3;
use flexion::multibody::rotation::about;
use flexion::multibody::slender::Station;
use std::sync::Arc;

/// The centreline without stress by its arc length, for one that begins at the origin along `direction` with the height of its
/// section along `up`.
pub type Curve = Arc<dyn Fn(f64) -> Station + Send + Sync>;

/// Makes the curve of a length, a direction and the direction of the height.
type Along = Box<dyn Fn(f64, Vec3, Vec3) -> Curve>;

/// A kind of centreline.
pub enum Bent {
    /// Of the length and direction that its beam has.
    Along(Along),
    /// Through points.
    Through(Box<Centreline>),
}

/// A straight line.
pub fn straight(tangent: Vec3, normal: Vec3) -> Curve {
    Arc::new(move |s| Station { position: s * tangent, tangent, normal })
}

keys! {
    struct Turn {
        /// angle of the arc
        angle: f64 = quantity(&ANGLE, Any);
        /// direction to which it bends at the root, `up` if left out
        towards: Option<Vec3> = vector(&FACTOR);
    }

    struct Helix {
        /// radius of the centreline
        radius: f64 = quantity(&LENGTH, Positive);
        /// advance along the axis in a turn
        pitch: f64 = quantity(&LENGTH, Any);
    }
}

/// The kinds of centreline.
pub static CURVE: Choice<Bent> = Choice {
    name: "curve",
    path: "beam.curve",
    summary: "centreline of a beam in space without stress",
    kinds: &[
        Kind {
            name: "straight",
            summary: "a straight line",
            source: "",
            example: "beam=[{length=1, section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, curve={kind='straight'}, root='clamped'}]",
            make: &Of(|_: Nothing, _| {
                Ok(Bent::Along(Box::new(|_, tangent, normal| straight(tangent, normal))))
            }),
        },
        Kind {
            name: "arc",
            summary: "an arc of a circle",
            source: "",
            example: "beam=[{length=1, section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, curve={kind='arc', angle='45 deg', towards=[0, 1, 0]}, root='clamped'}]",
            make: &Of(|Turn { angle, towards }, _| {
                if angle == 0.0 {
                    return Err(Fault::new("angle", "an arc of the angle 0 is straight").into());
                }
                Ok(Bent::Along(Box::new(move |length, tangent, normal| {
                    let towards = towards.unwrap_or(normal);
                    let side = towards - towards.dot(tangent) * tangent;
                    let size = side.dot(side).sqrt();
                    let side = if size > 0.0 { 1.0 / size * side } else { normal };
                    let (axis, radius) = (tangent.cross(side), length / angle);
                    Arc::new(move |s| {
                        let turned = about(s / radius * axis);
                        let (sin, cos) = libm::sincos(s / radius);
                        let position = radius * sin * tangent + radius * (1.0 - cos) * side;
                        Station { position, tangent: turned * tangent, normal: turned * normal }
                    })
                })))
            }),
        },
        Kind {
            name: "helix",
            summary: "a helix about `direction`, that begins on the side of `up` of its axis; the height points outwards",
            source: "",
            example: "beam=[{length=1, section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, curve={kind='helix', radius='20 cm', pitch='10 cm'}, root='clamped'}]",
            make: &Of(|Helix { radius, pitch }, _| {
                Ok(Bent::Along(Box::new(move |_, axis, out| {
                    let (side, rise) = (axis.cross(out), pitch / std::f64::consts::TAU);
                    let scale = libm::hypot(radius, rise);
                    Arc::new(move |s| {
                        let (sin, cos) = libm::sincos(s / scale);
                        let normal = cos * out + sin * side;
                        let along = -sin * out + cos * side;
                        let radial = radius * normal - radius * out;
                        let position = radial + rise * s / scale * axis;
                        let tangent = radius / scale * along + rise / scale * axis;
                        Station { position, tangent, normal }
                    })
                })))
            }),
        },
        Kind {
            name: "points",
            summary: "a cubic spline through points of space, which says the length and the direction of the beam; the height \
                      follows it without turning about it",
            source: "",
            example: "beam=[{section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, curve={kind='points', x=[0, '20 cm', '50 cm'], y=[0, '1 cm', '8 cm'], z=[0, 0, '5 cm']}, root='clamped'}]",
            make: &Of(|k: Points, _| Ok(Bent::Through(Box::new(Centreline::of(k)?)))),
        },
    ],
};
