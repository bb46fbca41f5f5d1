//! Scalar constraints between two markers A and B.
//!
//! With axes a of A and b of B, and d = x_B − x_A,
//!
//! ```text
//! across:  g = a·b          δg = (a × b)·(δθ_A − δθ_B)
//! along:   g = a·d − u(t)   δg = a·(δx_B − δx_A) + (a × d)·δθ_A
//! point:   g = e·d          with e fixed in space
//! turned:  g = (cos θ(t) y_A − sin θ(t) x_A)·x_B = sin(θ_B − θ(t)) for a common third axis
//! ```
//!
//! ġ and g̈ follow by differentiation, ȧ = ω × a + a_t, with a_t what the axis moves in its own marker. The multiplier λ is
//! a force along a or a moment about a × b, and changes with the markers as the wrench λ n, n = (∂g/∂x_A, ∂g/∂θ_A,
//! ∂g/∂x_B, ∂g/∂θ_B). Prescribed angles and displacements give B the multiplier as torque or force in the positive direction.

use super::marker::Pose;
use crate::linalg::{Mat3, Vec3};
use crate::profile::HubKinematics;
use crate::system::RowWeights;

/// A scalar constraint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Row {
    /// The markers have the same coordinate of space.
    Point(usize),
    /// B has no displacement along an axis of A.
    Along(usize),
    /// An axis of A and one of B are perpendicular.
    Across(usize, usize),
    /// The displacement along the third axis of A is prescribed.
    Displacement,
    /// The angle about the third axis of A is prescribed.
    Angle,
}

/// A force and moment on A and on B.
pub(super) type Wrench = [Vec3; 4];

/// Derivatives of a wrench by the positions and rotations of A and B, in blocks of 3 × 3.
pub(super) type Gradient = [[f64; 12]; 12];

/// c block += c m at block (i, j).
#[inline]
pub(super) fn add_block(out: &mut Gradient, [i, j]: [usize; 2], c: f64, m: &Mat3) {
    for k in 0..3 {
        for l in 0..3 {
            out[3 * i + k][3 * j + l] += c * m[k][l];
        }
    }
}

/// What a row is at a state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    pub(super) g: f64,
    pub(super) rate: f64,
    pub(super) acceleration: f64,
    /// ∂g/∂t
    pub(super) by_time: f64,
}

impl Value {
    pub(super) fn combine(&self, c: RowWeights) -> f64 {
        c.combine(self.g, self.rate, self.acceleration)
    }
}

/// An axis of a marker with what it moves in the marker: a, a_t, a_tt.
struct Axis([Vec3; 3]);

impl Row {
    /// For messages.
    pub(super) fn describe(self) -> String {
        let axis = |i: usize| ["first", "second", "third"][i];
        match self {
            Row::Point(i) => format!("position along {}", ["x", "y", "z"][i]),
            Row::Along(i) => format!("displacement along the {} axis", axis(i)),
            Row::Across(i, j) => format!("right angle of the axes {} and {}", axis(i), axis(j)),
            Row::Displacement => "prescribed displacement".to_owned(),
            Row::Angle => "prescribed angle".to_owned(),
        }
    }

    /// Whether its multiplier is a force, and g a length.
    pub(super) fn is_length(self) -> bool {
        matches!(self, Row::Point(_) | Row::Along(_) | Row::Displacement)
    }

    /// Whether its multiplier is that of a prescribed motion.
    pub(super) fn is_prescribed(self) -> bool {
        matches!(self, Row::Displacement | Row::Angle)
    }

    fn axis(self, a: &Pose, motion: &HubKinematics) -> Axis {
        let zero = Vec3::ZERO;
        match self {
            Row::Point(i) => Axis([Vec3::AXES[i], zero, zero]),
            Row::Along(i) | Row::Across(i, _) => Axis([a.axis(i), zero, zero]),
            Row::Displacement => Axis([a.axis(2), zero, zero]),
            Row::Angle => {
                let (sin, cos) = libm::sincos(motion.angle);
                let (x, y) = (a.axis(0), a.axis(1));
                let normal = cos * y - sin * x;
                let turned = -sin * y - cos * x;
                let bent = motion.acceleration * turned - motion.speed * motion.speed * normal;
                Axis([normal, motion.speed * turned, bent])
            }
        }
    }

    /// n.
    pub(super) fn normal(self, a: &Pose, b: &Pose, motion: &HubKinematics) -> Wrench {
        let Axis([axis, ..]) = self.axis(a, motion);
        match self {
            Row::Point(_) => [-axis, Vec3::ZERO, axis, Vec3::ZERO],
            Row::Along(_) | Row::Displacement => {
                let d = b.position - a.position;
                [-axis, axis.cross(d), axis, Vec3::ZERO]
            }
            Row::Across(_, j) => Row::perpendicular(axis, b.axis(j)),
            Row::Angle => Row::perpendicular(axis, b.axis(0)),
        }
    }

    fn perpendicular(a: Vec3, b: Vec3) -> Wrench {
        let moment = a.cross(b);
        [Vec3::ZERO, moment, Vec3::ZERO, -moment]
    }

    /// g, ġ and g̈.
    pub(super) fn value(self, a: &Pose, b: &Pose, motion: &HubKinematics) -> Value {
        let Axis([axis, drift, acceleration]) = self.axis(a, motion);
        let fixed = matches!(self, Row::Point(_));
        // Of the axis in space.
        let (rate, acceleration) = if fixed {
            (Vec3::ZERO, Vec3::ZERO)
        } else {
            let swept = a.spin.cross(axis);
            let rate = swept + drift;
            let twice = a.spin.cross(swept) + 2.0 * a.spin.cross(drift);
            (rate, a.spin_rate.cross(axis) + twice + acceleration)
        };
        // What it is multiplied by.
        let (other, moved, [x, x_rate, x_acceleration]) = match self {
            Row::Across(..) | Row::Angle => {
                let other = b.axis(if let Row::Across(_, j) = self { j } else { 0 });
                let swept = b.spin.cross(other);
                let moved = b.spin_rate.cross(other) + b.spin.cross(swept);
                (other, [swept, moved], [0.0; 3])
            }
            _ => {
                let difference = |x: Vec3, y: Vec3| y - x;
                let moved = [difference(a.velocity, b.velocity), difference(a.acceleration, b.acceleration)];
                let prescribed = if self == Row::Displacement {
                    [motion.angle, motion.speed, motion.acceleration]
                } else {
                    [0.0; 3]
                };
                (difference(a.position, b.position), moved, prescribed)
            }
        };
        Value {
            g: axis.dot(other) - x,
            rate: rate.dot(other) + axis.dot(moved[0]) - x_rate,
            acceleration: acceleration.dot(other) + 2.0 * rate.dot(moved[0]) + axis.dot(moved[1])
                - x_acceleration,
            by_time: drift.dot(other) - x_rate,
        }
    }

    /// Adds λ ∂n to the gradient of the wrench.
    pub(super) fn add_gradient(
        self,
        lambda: f64,
        (a, b): (&Pose, &Pose),
        motion: &HubKinematics,
        out: &mut Gradient,
    ) {
        let Axis([axis, ..]) = self.axis(a, motion);
        let along = Mat3::skew(axis);
        match self {
            Row::Point(_) => {}
            Row::Along(_) | Row::Displacement => {
                // Moment on A: δ(a × d) = d̃ ã δθ_A + ã (δx_B − δx_A); force ∓ã δθ_A.
                let d = Mat3::skew(b.position - a.position);
                add_block(out, [0, 1], lambda, &along);
                add_block(out, [2, 1], -lambda, &along);
                add_block(out, [1, 0], -lambda, &along);
                add_block(out, [1, 2], lambda, &along);
                add_block(out, [1, 1], lambda, &(d * along));
            }
            Row::Across(..) | Row::Angle => {
                let other = Mat3::skew(b.axis(if let Row::Across(_, j) = self { j } else { 0 }));
                // δ(a × b) = b̃ ã δθ_A − ã b̃ δθ_B.
                let (by_a, by_b) = (other * along, along * other);
                add_block(out, [1, 1], lambda, &by_a);
                add_block(out, [1, 3], -lambda, &by_b);
                add_block(out, [3, 1], -lambda, &by_a);
                add_block(out, [3, 3], lambda, &by_b);
            }
        }
    }
}
