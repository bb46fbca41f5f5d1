//! The frame of a section whose first axis is the tangent.

use crate::linalg::{Mat3, Vec3};

/// Section axes Λ = [t, n, b]: t = r′/|r′| the tangent, n and b = t × n along the second and third axis of the section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Triad {
    /// |r′|
    pub length: f64,
    /// t
    pub tangent: Vec3,
    /// n
    pub normal: Vec3,
    /// b
    pub binormal: Vec3,
}

impl Triad {
    /// The axes where the centreline has the derivative `slope` = r′ ≠ 0; `normal` is a unit vector across it.
    #[inline]
    pub fn new(slope: Vec3, normal: Vec3) -> Triad {
        let length = slope.norm();
        let tangent = 1.0 / length * slope;
        Triad { length, tangent, normal, binormal: tangent.cross(normal) }
    }

    /// The axes as columns of a rotation matrix.
    pub fn rotation(&self) -> Mat3 {
        Mat3::columns([self.tangent, self.normal, self.binormal])
    }

    /// Λ x, for components x in the axes of the section.
    #[inline]
    pub fn outward(&self, x: Vec3) -> Vec3 {
        x[0] * self.tangent + x[1] * self.normal + x[2] * self.binormal
    }

    /// Λᵀ x, the components of x in the axes of the section.
    #[inline]
    pub fn inward(&self, x: Vec3) -> Vec3 {
        Vec3([self.tangent.dot(x), self.normal.dot(x), self.binormal.dot(x)])
    }

    /// The axes rotated by the smallest rotation that takes t to the direction of `slope`, and then by `angle` about it:
    ///
    /// ```text
    /// n ← n − (n·t₁)/(1 + t·t₁) (t + t₁),     n ← cos φ n + sin φ (t₁ × n)
    /// ```
    ///
    /// Defined unless the tangent reverses, t₁ = −t. n is made a unit vector across t₁ again, so that rounding does not
    /// accumulate: (3 − n·n)/2 is 1/|n| but for the square of the error.
    #[inline]
    pub fn transported(&self, slope: Vec3, angle: f64) -> Triad {
        let length = slope.norm();
        let t = 1.0 / length * slope;
        let along = self.normal.dot(t) * (1.0 / (1.0 + self.tangent.dot(t)));
        let mut n = self.normal - along * (self.tangent + t);
        n = n.across(t);
        n = (1.5 - 0.5 * n.dot(n)) * n;
        let (sin, cos) = libm::sincos(angle);
        let b = t.cross(n);
        let normal = cos * n + sin * b;
        Triad { length, tangent: t, normal, binormal: t.cross(normal) }
    }
}
