//! Rotations in space: unit quaternions, rotation vectors, rotation matrices.
//!
//! A rotation vector d has the direction of the axis and the length of the angle a = |d|. With x̃ y = x × y,
//!
//! ```text
//! exp(d) = (cos a/2, sin(a/2)/a d),   R(exp d) = I + sin a/a d̃ + (1 − cos a)/a² d̃²
//! T(d)   = I − (1 − cos a)/a² d̃ + (a − sin a)/a³ d̃²          exp(d)⁻¹ δexp(d) = T(d) δd, in the rotated axes
//! T(d)⁻¹ = I + ½ d̃ + (1 − (a/2) cot(a/2))/a² d̃²
//! ```

use crate::linalg::vector::inner;
use crate::linalg::{Mat3, Vec3};
use std::ops::Mul;

/// A unit quaternion (w, x, y, z). The product p q is the rotation q after p, both in rotated axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion(pub [f64; 4]);

/// Below this square of an angle the quotients are taken from their series.
const SMALL: f64 = 1e-6;

impl Mul for Quaternion {
    type Output = Quaternion;

    fn mul(self, Quaternion(q): Quaternion) -> Quaternion {
        let p = self.0;
        Quaternion([
            p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
            p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
            p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
            p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
        ])
    }
}

impl Quaternion {
    /// The four entries of `x` from `i` on.
    #[inline(always)]
    pub fn at(x: &[f64], i: usize) -> Quaternion {
        Quaternion([x[i], x[i + 1], x[i + 2], x[i + 3]])
    }

    /// The quaternion of unit length in the same direction.
    pub fn normalized(self) -> Quaternion {
        let size = inner(self.0, self.0).sqrt();
        Quaternion(self.0.map(|x| x / size))
    }

    /// The inverse rotation.
    pub fn inverse(self) -> Quaternion {
        let [w, x, y, z] = self.0;
        Quaternion([w, -x, -y, -z])
    }

    /// R(q).
    pub fn matrix(self) -> Mat3 {
        let [w, x, y, z] = self.0;
        let (xx, yy, zz, xy, xz, yz) = (x * x, y * y, z * z, x * y, x * z, y * z);
        let (wx, wy, wz) = (w * x, w * y, w * z);
        Mat3([
            [1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)],
            [2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)],
            [2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)],
        ])
    }

    /// exp(d)
    pub fn exponential(d: Vec3) -> Quaternion {
        let square = d.dot(d);
        let half = 0.5 * square.sqrt();
        let part = if square > SMALL { 0.5 * libm::sin(half) / half } else { 0.5 - square / 48.0 };
        Quaternion([libm::cos(half), part * d[0], part * d[1], part * d[2]])
    }

    /// The rotation vector, of an angle up to π.
    pub fn logarithm(self) -> Vec3 {
        let [w, x, y, z] = if self.0[0] < 0.0 { self.0.map(|x| -x) } else { self.0 };
        let axis = Vec3([x, y, z]);
        let sine = axis.norm();
        let part = if sine > 1e-8 { 2.0 * libm::atan2(sine, w) / sine } else { 2.0 };
        part * axis
    }
}

/// The quaternion of a rotation matrix, from its largest component (Shepperd 1978, doi 10.2514/3.55767b).
impl From<Mat3> for Quaternion {
    fn from(Mat3(r): Mat3) -> Quaternion {
        let trace = r[0][0] + r[1][1] + r[2][2];
        let squares = [
            1.0 + trace,
            1.0 + 2.0 * r[0][0] - trace,
            1.0 + 2.0 * r[1][1] - trace,
            1.0 + 2.0 * r[2][2] - trace,
        ];
        let largest = (0..4).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
        let (w, x, y, z) = (r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], squares[largest]);
        let (xy, xz, yz) = (r[0][1] + r[1][0], r[0][2] + r[2][0], r[1][2] + r[2][1]);
        let q = match largest {
            0 => [z, w, x, y],
            1 => [w, z, xy, xz],
            2 => [x, xy, z, yz],
            _ => [y, xz, yz, z],
        };
        Quaternion(q).normalized()
    }
}

/// R(exp d), the rotation about d by the angle |d|.
pub fn about(d: impl Into<Vec3>) -> Mat3 {
    Quaternion::exponential(d.into()).matrix()
}

/// T(d)
pub fn tangent(d: Vec3) -> Mat3 {
    let square = d.dot(d);
    let (once, twice) = if square > SMALL {
        let a = square.sqrt();
        let half = libm::sin(0.5 * a);
        (2.0 * half * half / square, (a - libm::sin(a)) / (a * square))
    } else {
        (0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
    };
    let d = Mat3::skew(d);
    Mat3::IDENTITY + (twice * (d * d) - once * d)
}

/// T(d)⁻¹ v
pub fn rate(d: Vec3, v: Vec3) -> Vec3 {
    let square = d.dot(d);
    let half = 0.5 * square.sqrt();
    let part =
        if square > SMALL { (1.0 - half / libm::tan(half)) / square } else { 1.0 / 12.0 + square / 720.0 };
    let once = d.cross(v);
    v + 0.5 * once + part * d.cross(once)
}

/// A rotation whose third axis is along `axis` and whose first lies in the plane of `axis` and `first`; without
/// `first`, or where it is parallel, in that of the coordinate axis that is farthest from `axis`. `None` for an axis
/// that has no direction.
pub fn frame(axis: Vec3, first: Option<Vec3>) -> Option<Mat3> {
    let z = axis.unit()?;
    let across = |x: Vec3| {
        let across = x.across(z);
        (across.dot(across) > 1e-12 * x.dot(x)).then_some(across).and_then(Vec3::unit)
    };
    let farthest = (0..3).fold(0, |best, i| if z[i].abs() < z[best].abs() { i } else { best });
    let x = first.and_then(across).or_else(|| across(Vec3::AXES[farthest]))?;
    Some(Mat3::columns([x, z.cross(x), z]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const VECTORS: [Vec3; 5] = [
        Vec3([0.3, -0.7, 1.1]),
        Vec3([2.0, 1.5, -1.2]),
        Vec3([1e-4, 2e-4, -3e-4]),
        Vec3([1e-9, 0.0, 0.0]),
        Vec3([0.0, 3.1, 0.0]),
    ];

    fn close(a: Vec3, b: Vec3, allowed: f64) -> bool {
        (a - b).0.iter().all(|x| x.abs() < allowed)
    }

    #[test]
    fn matrix_quaternion_and_vector_are_the_same_rotation() {
        for d in VECTORS {
            let q = Quaternion::exponential(d);
            let r = q.matrix();
            let back = Quaternion::from(r);
            assert!(close(q.logarithm(), d, 1e-14), "{d:?}");
            assert!(close(back.logarithm(), d, 1e-13), "{d:?} {:?}", back.logarithm());
            let identity = r * r.transpose();
            for i in 0..3 {
                assert!(close(identity.column(i), Vec3::AXES[i], 1e-15));
            }
            // The axis stays where it is.
            assert!(close(r * d, d, 1e-14));
        }
    }

    /// exp(d)⁻¹ exp(d + δ) by differences, and T⁻¹ T = I.
    #[test]
    fn the_tangent_is_the_derivative_of_the_exponential() {
        for d in VECTORS {
            let t = tangent(d);
            for j in 0..3 {
                let at = |h: f64| {
                    let moved = Quaternion::exponential(d + h * Vec3::AXES[j]);
                    (Quaternion::exponential(d).inverse() * moved).logarithm()
                };
                let h = 1e-3;
                let [far, near] = [2.0 * h, h].map(|h| at(h) - at(-h));
                let difference = 1.0 / (12.0 * h) * (8.0 * near - far);
                assert!(close(t.column(j), difference, 1e-10), "{d:?} {j}");
                assert!(close(rate(d, t.column(j)), Vec3::AXES[j], 1e-13), "{d:?} {j}");
            }
        }
    }

    #[test]
    fn a_frame_has_the_axis_asked_for() {
        let r = frame(Vec3([1.0, 2.0, -2.0]), Some(Vec3::AXES[0])).unwrap();
        assert!(close(r.column(2), 1.0 / 3.0 * Vec3([1.0, 2.0, -2.0]), 1e-15));
        let determinant = r.column(0).dot(r.column(1).cross(r.column(2)));
        assert!((determinant - 1.0).abs() < 1e-15 && r.column(0)[0] > 0.9);
        assert!(frame(Vec3::ZERO, None).is_none() && frame(Vec3([f64::NAN, 0.0, 0.0]), None).is_none());
        assert_eq!(frame(3.0 * Vec3::AXES[2], Some(Vec3::AXES[2])).map(|r| r.column(2)), Some(Vec3::AXES[2]));
    }
}
