//! Vectors and matrices of space, with operators.
//!
//! Sums and products are taken component by component and in the order in which they are written: a·b = (a₁b₁ + a₂b₂) + a₃b₃.

use super::vector::{cross, inner};
use std::ops::{Add, AddAssign, Div, Index, IndexMut, Mul, Neg, Sub, SubAssign};

/// A vector by its three components.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vec3(pub [f64; 3]);

/// A 3 × 3 matrix by rows; as a rotation its columns are the rotated axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mat3(pub [[f64; 3]; 3]);

impl Vec3 {
    /// The vector without length.
    pub const ZERO: Vec3 = Vec3([0.0; 3]);
    /// The unit vectors along the axes.
    pub const AXES: [Vec3; 3] = [Vec3([1.0, 0.0, 0.0]), Vec3([0.0, 1.0, 0.0]), Vec3([0.0, 0.0, 1.0])];

    /// The three entries of `x` from `i` on.
    #[inline(always)]
    pub fn at(x: &[f64], i: usize) -> Vec3 {
        Vec3([x[i], x[i + 1], x[i + 2]])
    }

    /// Writes the components into the entries of `x` from `i` on.
    #[inline(always)]
    pub fn put(self, x: &mut [f64], i: usize) {
        x[i..i + 3].copy_from_slice(&self.0);
    }

    /// Adds the components to the entries of `x` from `i` on.
    #[inline(always)]
    pub fn add_to(self, x: &mut [f64], i: usize) {
        for k in 0..3 {
            x[i + k] += self.0[k];
        }
    }

    /// x·y
    #[inline(always)]
    pub fn dot(self, other: Vec3) -> f64 {
        inner(self.0, other.0)
    }

    /// x × y
    #[inline(always)]
    pub fn cross(self, other: Vec3) -> Vec3 {
        Vec3(cross(self.0, other.0))
    }

    /// |x|
    #[inline(always)]
    pub fn norm(self) -> f64 {
        self.dot(self).sqrt()
    }

    /// x/|x|; `None` where |x| is zero or not finite.
    pub fn unit(self) -> Option<Vec3> {
        let size = self.norm();
        (size.is_finite() && size > 0.0).then(|| 1.0 / size * self)
    }

    /// The vector of the components f(x).
    #[inline(always)]
    pub fn map(self, f: impl FnMut(f64) -> f64) -> Vec3 {
        Vec3(self.0.map(f))
    }

    /// Whether all components are finite.
    pub fn is_finite(self) -> bool {
        self.0.iter().all(|x| x.is_finite())
    }

    /// x less its part along the unit vector `n`: x − (x·n) n.
    #[inline(always)]
    pub fn across(self, n: Vec3) -> Vec3 {
        self - self.dot(n) * n
    }
}

impl Mat3 {
    /// The matrix of zeros.
    pub const ZERO: Mat3 = Mat3([[0.0; 3]; 3]);
    /// The identity.
    pub const IDENTITY: Mat3 = Mat3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);

    /// The matrix with these columns.
    #[inline(always)]
    pub fn columns([x, y, z]: [Vec3; 3]) -> Mat3 {
        Mat3([[x[0], y[0], z[0]], [x[1], y[1], z[1]], [x[2], y[2], z[2]]])
    }

    /// Column j, the axis j of a rotation.
    #[inline(always)]
    pub fn column(&self, j: usize) -> Vec3 {
        Vec3([self.0[0][j], self.0[1][j], self.0[2][j]])
    }

    /// x̃, the matrix of x ×.
    #[inline(always)]
    pub fn skew(x: Vec3) -> Mat3 {
        Mat3([[0.0, -x[2], x[1]], [x[2], 0.0, -x[0]], [-x[1], x[0], 0.0]])
    }

    /// x yᵀ
    #[inline(always)]
    pub fn outer(x: Vec3, y: Vec3) -> Mat3 {
        Mat3([(x[0] * y).0, (x[1] * y).0, (x[2] * y).0])
    }

    /// Aᵀ, the inverse of a rotation.
    #[inline(always)]
    pub fn transpose(&self) -> Mat3 {
        Mat3([self.column(0).0, self.column(1).0, self.column(2).0])
    }

    /// det A
    pub fn determinant(&self) -> f64 {
        let [x, y, z] = self.0.map(Vec3);
        x.dot(y.cross(z))
    }

    /// Whether all entries are finite.
    pub fn is_finite(&self) -> bool {
        self.0.as_flattened().iter().all(|x| x.is_finite())
    }

    /// The matrix whose entries are `f` of those of both.
    #[inline(always)]
    fn zip(self, other: Mat3, f: impl Fn(f64, f64) -> f64) -> Mat3 {
        let (Mat3(a), Mat3(b)) = (self, other);
        let row = |i: usize| [f(a[i][0], b[i][0]), f(a[i][1], b[i][1]), f(a[i][2], b[i][2])];
        Mat3([row(0), row(1), row(2)])
    }
}

impl Add for Vec3 {
    type Output = Vec3;

    #[inline(always)]
    fn add(self, Vec3([x, y, z]): Vec3) -> Vec3 {
        Vec3([self.0[0] + x, self.0[1] + y, self.0[2] + z])
    }
}

impl Sub for Vec3 {
    type Output = Vec3;

    #[inline(always)]
    fn sub(self, Vec3([x, y, z]): Vec3) -> Vec3 {
        Vec3([self.0[0] - x, self.0[1] - y, self.0[2] - z])
    }
}

impl Neg for Vec3 {
    type Output = Vec3;

    #[inline(always)]
    fn neg(self) -> Vec3 {
        Vec3([-self.0[0], -self.0[1], -self.0[2]])
    }
}

impl Mul<Vec3> for f64 {
    type Output = Vec3;

    #[inline(always)]
    fn mul(self, Vec3([x, y, z]): Vec3) -> Vec3 {
        Vec3([self * x, self * y, self * z])
    }
}

impl Div<f64> for Vec3 {
    type Output = Vec3;

    #[inline(always)]
    fn div(self, c: f64) -> Vec3 {
        self.map(|x| x / c)
    }
}

impl AddAssign for Vec3 {
    #[inline(always)]
    fn add_assign(&mut self, other: Vec3) {
        *self = *self + other;
    }
}

impl SubAssign for Vec3 {
    #[inline(always)]
    fn sub_assign(&mut self, other: Vec3) {
        *self = *self - other;
    }
}

impl Index<usize> for Vec3 {
    type Output = f64;

    #[inline(always)]
    fn index(&self, i: usize) -> &f64 {
        &self.0[i]
    }
}

impl IndexMut<usize> for Vec3 {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut f64 {
        &mut self.0[i]
    }
}

impl std::iter::Sum for Vec3 {
    fn sum<I: Iterator<Item = Vec3>>(terms: I) -> Vec3 {
        terms.fold(Vec3::ZERO, Vec3::add)
    }
}

impl Add for Mat3 {
    type Output = Mat3;

    #[inline(always)]
    fn add(self, other: Mat3) -> Mat3 {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for Mat3 {
    type Output = Mat3;

    #[inline(always)]
    fn sub(self, other: Mat3) -> Mat3 {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul<Mat3> for f64 {
    type Output = Mat3;

    #[inline(always)]
    fn mul(self, Mat3(rows): Mat3) -> Mat3 {
        Mat3(rows.map(|row| row.map(|x| self * x)))
    }
}

/// A x
impl Mul<Vec3> for Mat3 {
    type Output = Vec3;

    #[inline(always)]
    fn mul(self, x: Vec3) -> Vec3 {
        Vec3([inner(self.0[0], x.0), inner(self.0[1], x.0), inner(self.0[2], x.0)])
    }
}

/// A B
impl Mul for Mat3 {
    type Output = Mat3;

    #[inline(always)]
    fn mul(self, b: Mat3) -> Mat3 {
        Mat3(
            self.0.map(|row| [0, 1, 2].map(|j| row[0] * b.0[0][j] + row[1] * b.0[1][j] + row[2] * b.0[2][j])),
        )
    }
}

/// Row i.
impl Index<usize> for Mat3 {
    type Output = [f64; 3];

    #[inline(always)]
    fn index(&self, i: usize) -> &[f64; 3] {
        &self.0[i]
    }
}

impl IndexMut<usize> for Mat3 {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut [f64; 3] {
        &mut self.0[i]
    }
}

/// Its components.
impl IntoIterator for Vec3 {
    type Item = f64;
    type IntoIter = std::array::IntoIter<f64, 3>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

/// Its components.
impl<'a> IntoIterator for &'a Vec3 {
    type Item = &'a f64;
    type IntoIter = std::slice::Iter<'a, f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl From<[f64; 3]> for Vec3 {
    fn from(x: [f64; 3]) -> Vec3 {
        Vec3(x)
    }
}

impl From<[[f64; 3]; 3]> for Mat3 {
    fn from(rows: [[f64; 3]; 3]) -> Mat3 {
        Mat3(rows)
    }
}
