//! Rotations in space: unit quaternions, rotation vectors, rotation matrices.
//!
//! A rotation vector d has the direction of the axis and the length of the angle a = |d|. With x̃ y = x × y,
//!
//! ```text
//! exp(d) = (cos a/2, sin(a/2)/a d),   R(exp d) = I + sin a/a d̃ + (1 − cos a)/a² d̃²
//! T(d)   = I − (1 − cos a)/a² d̃ + (a − sin a)/a³ d̃²          exp(d)⁻¹ δexp(d) = T(d) δd, in the rotated axes
//! T(d)⁻¹ = I + ½ d̃ + (1 − (a/2) cot(a/2))/a² d̃²
//! ```

use crate::linalg::vector::{cross, inner};

/// Components of a vector.
pub type Vector = [f64; 3];

/// A matrix by rows; as a rotation its columns are the rotated axes.
pub type Matrix3 = [[f64; 3]; 3];

/// A unit quaternion (w, x, y, z).
pub type Quaternion = [f64; 4];

/// The identity.
pub const IDENTITY: Matrix3 = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Below this square of an angle the quotients are taken from their series.
const SMALL: f64 = 1e-6;

/// x + c y
#[inline(always)]
pub fn plus(x: Vector, c: f64, y: Vector) -> Vector {
    [x[0] + c * y[0], x[1] + c * y[1], x[2] + c * y[2]]
}

/// c x
#[inline(always)]
pub fn times(c: f64, x: Vector) -> Vector {
    x.map(|x| c * x)
}

/// A x
#[inline(always)]
pub fn apply(a: &Matrix3, x: Vector) -> Vector {
    a.map(|row| inner(row, x))
}

/// Aᵀ x
#[inline(always)]
pub fn apply_transposed(a: &Matrix3, x: Vector) -> Vector {
    [0, 1, 2].map(|j| a[0][j] * x[0] + a[1][j] * x[1] + a[2][j] * x[2])
}

/// A B
#[inline(always)]
pub fn product(a: &Matrix3, b: &Matrix3) -> Matrix3 {
    a.map(|row| apply_transposed(b, row))
}

/// Column j, the axis j of a rotation.
#[inline(always)]
pub fn column(a: &Matrix3, j: usize) -> Vector {
    [a[0][j], a[1][j], a[2][j]]
}

/// x̃, the matrix of x ×.
#[inline(always)]
pub fn skew(x: Vector) -> Matrix3 {
    [[0.0, -x[2], x[1]], [x[2], 0.0, -x[0]], [-x[1], x[0], 0.0]]
}

/// The quaternion of the rotation `q` after that of `p`, both in rotated axes: p q.
pub fn compose(p: Quaternion, q: Quaternion) -> Quaternion {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// The quaternion of unit length in the direction of `q`.
pub fn normalized(q: Quaternion) -> Quaternion {
    let size = inner(q, q).sqrt();
    q.map(|x| x / size)
}

/// The inverse of a unit quaternion.
pub fn inverse(q: Quaternion) -> Quaternion {
    [q[0], -q[1], -q[2], -q[3]]
}

/// R(q).
pub fn matrix(q: Quaternion) -> Matrix3 {
    let [w, x, y, z] = q;
    let (xx, yy, zz, xy, xz, yz) = (x * x, y * y, z * z, x * y, x * z, y * z);
    let (wx, wy, wz) = (w * x, w * y, w * z);
    [
        [1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)],
        [2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)],
        [2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)],
    ]
}

/// The quaternion of a rotation matrix, from its largest component (Shepperd 1978, doi 10.2514/3.55767b).
pub fn quaternion(r: &Matrix3) -> Quaternion {
    let trace = r[0][0] + r[1][1] + r[2][2];
    let squares =
        [1.0 + trace, 1.0 + 2.0 * r[0][0] - trace, 1.0 + 2.0 * r[1][1] - trace, 1.0 + 2.0 * r[2][2] - trace];
    let largest = (0..4).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
    let (w, x, y, z) = (r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1], squares[largest]);
    let (xy, xz, yz) = (r[0][1] + r[1][0], r[0][2] + r[2][0], r[1][2] + r[2][1]);
    normalized(match largest {
        0 => [z, w, x, y],
        1 => [w, z, xy, xz],
        2 => [x, xy, z, yz],
        _ => [y, xz, yz, z],
    })
}

/// exp(d)
pub fn exponential(d: Vector) -> Quaternion {
    let square = inner(d, d);
    let half = 0.5 * square.sqrt();
    let part = if square > SMALL { 0.5 * libm::sin(half) / half } else { 0.5 - square / 48.0 };
    [libm::cos(half), part * d[0], part * d[1], part * d[2]]
}

/// The rotation vector of a unit quaternion, of an angle up to π.
pub fn logarithm(q: Quaternion) -> Vector {
    let q = if q[0] < 0.0 { q.map(|x| -x) } else { q };
    let axis = [q[1], q[2], q[3]];
    let sine = inner(axis, axis).sqrt();
    let part = if sine > 1e-8 { 2.0 * libm::atan2(sine, q[0]) / sine } else { 2.0 };
    times(part, axis)
}

/// T(d)
pub fn tangent(d: Vector) -> Matrix3 {
    let square = inner(d, d);
    let (once, twice) = if square > SMALL {
        let a = square.sqrt();
        let half = libm::sin(0.5 * a);
        (2.0 * half * half / square, (a - libm::sin(a)) / (a * square))
    } else {
        (0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
    };
    let d = skew(d);
    let dd = product(&d, &d);
    let mut out = IDENTITY;
    for i in 0..3 {
        for j in 0..3 {
            out[i][j] += twice * dd[i][j] - once * d[i][j];
        }
    }
    out
}

/// T(d)⁻¹ v
pub fn rate(d: Vector, v: Vector) -> Vector {
    let square = inner(d, d);
    let half = 0.5 * square.sqrt();
    let part =
        if square > SMALL { (1.0 - half / libm::tan(half)) / square } else { 1.0 / 12.0 + square / 720.0 };
    let once = cross(d, v);
    plus(plus(v, 0.5, once), part, cross(d, once))
}

/// A rotation whose third axis is along `axis` and whose first lies in the plane of `axis` and `first`; without
/// `first`, or where it is parallel, in that of the coordinate axis that is farthest from `axis`. `None` for an axis
/// that has no direction.
pub fn frame(axis: Vector, first: Option<Vector>) -> Option<Matrix3> {
    let unit = |x: Vector| {
        let size = inner(x, x).sqrt();
        (size.is_finite() && size > 0.0).then(|| times(1.0 / size, x))
    };
    let z = unit(axis)?;
    let across = |x: Vector| {
        let along = inner(x, z);
        let rest = plus(x, -along, z);
        (inner(rest, rest) > 1e-12 * inner(x, x)).then_some(rest).and_then(unit)
    };
    let farthest = (0..3).fold(0, |best, i| if z[i].abs() < z[best].abs() { i } else { best });
    let x = first.and_then(across).or_else(|| across(IDENTITY[farthest]))?;
    let y = cross(z, x);
    Some([0, 1, 2].map(|i| [x[i], y[i], z[i]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    const VECTORS: [Vector; 5] =
        [[0.3, -0.7, 1.1], [2.0, 1.5, -1.2], [1e-4, 2e-4, -3e-4], [1e-9, 0.0, 0.0], [0.0, 3.1, 0.0]];

    fn close(a: Vector, b: Vector, allowed: f64) -> bool {
        a.iter().zip(b).all(|(a, b)| (a - b).abs() < allowed)
    }

    #[test]
    fn matrix_quaternion_and_vector_are_the_same_rotation() {
        for d in VECTORS {
            let q = exponential(d);
            let r = matrix(q);
            let back = quaternion(&r);
            assert!(close(logarithm(q), d, 1e-14), "{d:?}");
            assert!(close(logarithm(back), d, 1e-13), "{d:?} {:?}", logarithm(back));
            let identity = product(&r, &[0, 1, 2].map(|j| column(&r, j)));
            for i in 0..3 {
                assert!(close(identity[i], IDENTITY[i], 1e-15));
            }
            // The axis stays where it is.
            assert!(close(apply(&r, d), d, 1e-14));
        }
    }

    /// exp(d)⁻¹ exp(d + δ) by differences, and T⁻¹ T = I.
    #[test]
    fn the_tangent_is_the_derivative_of_the_exponential() {
        for d in VECTORS {
            let t = tangent(d);
            for j in 0..3 {
                let at = |h: f64| {
                    let mut moved = d;
                    moved[j] += h;
                    logarithm(compose(inverse(exponential(d)), exponential(moved)))
                };
                let h = 1e-3;
                let [far, near] = [2.0 * h, h].map(|h| plus(at(h), -1.0, at(-h)));
                let difference = times(1.0 / (12.0 * h), plus(times(8.0, near), -1.0, far));
                assert!(close(column(&t, j), difference, 1e-10), "{d:?} {j}");
                assert!(close(rate(d, column(&t, j)), IDENTITY[j], 1e-13), "{d:?} {j}");
            }
        }
    }

    #[test]
    fn a_frame_has_the_axis_asked_for() {
        let r = frame([1.0, 2.0, -2.0], Some([1.0, 0.0, 0.0])).unwrap();
        assert!(close(column(&r, 2), [1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0], 1e-15));
        let determinant = inner(column(&r, 0), cross(column(&r, 1), column(&r, 2)));
        assert!((determinant - 1.0).abs() < 1e-15 && column(&r, 0)[0] > 0.9);
        assert!(frame([0.0; 3], None).is_none() && frame([f64::NAN, 0.0, 0.0], None).is_none());
        assert_eq!(
            frame([0.0, 0.0, 3.0], Some([0.0, 0.0, 1.0])).map(|r| column(&r, 2)),
            Some([0.0, 0.0, 1.0])
        );
    }
}
