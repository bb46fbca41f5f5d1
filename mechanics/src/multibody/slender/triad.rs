//! The frame of a section whose first axis is the tangent.

use crate::linalg::vector::{cross, inner};

/// A vector in space.
pub type Vector = [f64; 3];

/// x + c y
#[inline(always)]
pub(super) fn plus(x: Vector, c: f64, y: Vector) -> Vector {
    [x[0] + c * y[0], x[1] + c * y[1], x[2] + c * y[2]]
}

/// c x
#[inline(always)]
pub(super) fn times(c: f64, x: Vector) -> Vector {
    [c * x[0], c * x[1], c * x[2]]
}

/// The vector whose components are `x[at..at + 3]`.
#[inline(always)]
pub(super) fn vector(x: &[f64], at: usize) -> Vector {
    [x[at], x[at + 1], x[at + 2]]
}

/// Section axes Λ = [t, n, b]: t = r′/|r′| the tangent, n and b = t × n along the second and third axis of the section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Triad {
    /// |r′|
    pub length: f64,
    /// t
    pub tangent: Vector,
    /// n
    pub normal: Vector,
    /// b
    pub binormal: Vector,
}

impl Triad {
    /// The axes where the centreline has the derivative `slope` = r′ ≠ 0; `normal` is a unit vector across it.
    #[inline]
    pub fn new(slope: Vector, normal: Vector) -> Triad {
        let length = inner(slope, slope).sqrt();
        let tangent = times(1.0 / length, slope);
        Triad { length, tangent, normal, binormal: cross(tangent, normal) }
    }

    /// The axes as columns of a rotation matrix.
    pub fn rotation(&self) -> [[f64; 3]; 3] {
        std::array::from_fn(|i| [self.tangent[i], self.normal[i], self.binormal[i]])
    }

    /// Λ x, for components x in the axes of the section.
    #[inline]
    pub fn outward(&self, x: Vector) -> Vector {
        plus(plus(times(x[0], self.tangent), x[1], self.normal), x[2], self.binormal)
    }

    /// Λᵀ x, the components of x in the axes of the section.
    #[inline]
    pub fn inward(&self, x: Vector) -> Vector {
        [inner(self.tangent, x), inner(self.normal, x), inner(self.binormal, x)]
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
    pub fn transported(&self, slope: Vector, angle: f64) -> Triad {
        let length = inner(slope, slope).sqrt();
        let t = times(1.0 / length, slope);
        let along = inner(self.normal, t) * (1.0 / (1.0 + inner(self.tangent, t)));
        let mut n = plus(self.normal, -along, plus(self.tangent, 1.0, t));
        n = plus(n, -inner(n, t), t);
        n = times(1.5 - 0.5 * inner(n, n), n);
        let (sin, cos) = libm::sincos(angle);
        let b = cross(t, n);
        let normal = plus(times(cos, n), sin, b);
        Triad { length, tangent: t, normal, binormal: cross(t, normal) }
    }
}
