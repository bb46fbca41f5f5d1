//! The angle of twist between two sections, and its derivatives.
//!
//! c of a [`Pair`] is orthogonal to both tangents, so that c·δt = c·δr′/|r′|. It changes only with the directions of r′ at the
//! two ends, and
//!
//! ```text
//! ∂c/∂r′_a = −([t_b]× + c (t_a + t_b)ᵀ)/((1 + t_a·t_b) |r′_a|),    ∂c/∂r′_b = ([t_a]× − c (t_a + t_b)ᵀ)/((1 + t_a·t_b) |r′_b|)
//! ```

use super::triad::Triad;
use crate::linalg::{Mat3, Vec3};

/// The twist of section b against section a.
///
/// Take the frame Λ_a to the tangent t_b by the smallest rotation. The angle from there to Λ_b about t_b is
///
/// ```text
/// φ = atan2(b_a·n_b − n_a·b_b, n_a·n_b + b_a·b_b)
/// ```
///
/// the twist of the relative rotation when it is split into swing and twist. With the rotations of the sections,
/// δθ = δΘ t + t × δt, its variation does not contain n and b:
///
/// ```text
/// δφ = (t_a + t_b)·(δθ_b − δθ_a)/(1 + t_a·t_b) = δΘ_b − δΘ_a + c·(δt_a + δt_b),    c = t_a × t_b/(1 + t_a·t_b)
/// ```
///
/// φ is not defined where t_b = −t_a, and jumps by 2π where Λ_b is twisted by half a turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pair {
    /// φ \[rad\]
    pub angle: f64,
    /// c
    pub c: Vec3,
    /// 1/(1 + t_a·t_b)
    factor: f64,
}

impl Pair {
    /// The twist of `b` against `a`.
    #[inline]
    pub fn new(a: &Triad, b: &Triad) -> Pair {
        let sin = a.binormal.dot(b.normal) - a.normal.dot(b.binormal);
        let cos = a.normal.dot(b.normal) + a.binormal.dot(b.binormal);
        Pair { angle: libm::atan2(sin, cos), ..Pair::of_tangents(a.tangent, b.tangent) }
    }

    /// c alone; the angle is 0.
    #[inline]
    pub fn of_tangents(a: Vec3, b: Vec3) -> Pair {
        let factor = 1.0 / (1.0 + a.dot(b));
        Pair { angle: 0.0, c: factor * a.cross(b), factor }
    }

    /// The derivatives of (c/|r′_a|, c/|r′_b|) by r′_a and r′_b, times `weight`: `[i][j]` is that of the entry i by r′ of j.
    #[inline]
    pub(super) fn second(&self, a: &Triad, b: &Triad, weight: f64) -> [[Mat3; 2]; 2] {
        let ends = [a, b];
        let sum = a.tangent + b.tangent;
        let swept = [-b.tangent, a.tangent];
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let scale = weight / (ends[i].length * ends[j].length);
                let own = if i == j { 1.0 } else { 0.0 };
                // The length in front of c changes only with its own end.
                let row = scale * (self.factor * sum + own * ends[j].tangent);
                Mat3::skew(scale * self.factor * swept[j]) - Mat3::outer(self.c, row)
            })
        })
    }
}

impl Triad {
    /// The vector x in δΘ = δφ + x·δr′ for increments (δr′, φ) of a configuration whose r′ was less by `increment`.
    pub fn spin_by_slope(&self, increment: Vec3) -> Vec3 {
        spin_by_slope(self.length * self.tangent - increment, increment)
    }
}

/// The vector x in δΘ = δφ + x·δr′ for increments (δr′, φ) of a configuration whose r′ was `before`, and has grown by `increment`:
/// x = −c/|r′| with c of the tangents before and now, −(r′₀ × r′)/(|r′| (|r′₀||r′| + r′₀·r′)).
#[inline]
pub(super) fn spin_by_slope(before: Vec3, increment: Vec3) -> Vec3 {
    let now = before + increment;
    let (old, new) = (before.norm(), now.norm());
    -1.0 / (new * (old * new + before.dot(now))) * before.cross(increment)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    const X: Vec3 = Vec3::AXES[0];
    const Y: Vec3 = Vec3::AXES[1];
    const Z: Vec3 = Vec3::AXES[2];

    #[test]
    fn transport_around_an_octant_turns_by_its_solid_angle() {
        // The smallest rotations along a triangle of great circles turn a frame by the area of the triangle, π/2.
        let begin = Triad::new(X, Y);
        let end = begin.transported(Y, 0.0).transported(Z, 0.0).transported(X, 0.0);
        assert!((Pair::new(&begin, &end).angle - FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn the_twist_is_the_angle_behind_the_transport_and_changes_its_sign_with_the_order() {
        let a = Triad::new(Vec3([0.3, -1.2, 0.4]), 1.0 / 1.53_f64.sqrt() * Vec3([1.2, 0.3, 0.0]));
        for angle in [-3.0, -0.4, 0.0, 1e-9, 2.5] {
            let b = a.transported(Vec3([0.9, 0.1, -0.7]), angle);
            assert!((Pair::new(&a, &b).angle - angle).abs() < 4e-16 * 8.0);
            assert!((Pair::new(&b, &a).angle + angle).abs() < 4e-16 * 8.0);
        }
    }
}
