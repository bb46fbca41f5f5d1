//! The angle of twist between two sections, and its derivatives.
//!
//! c of a [`Pair`] is orthogonal to both tangents, so that c·δt = c·δr′/|r′|. It changes only with the directions of r′ at the
//! two ends, and
//!
//! ```text
//! ∂c/∂r′_a = −([t_b]× + c (t_a + t_b)ᵀ)/((1 + t_a·t_b) |r′_a|),    ∂c/∂r′_b = ([t_a]× − c (t_a + t_b)ᵀ)/((1 + t_a·t_b) |r′_b|)
//! ```

use super::triad::{Triad, Vector, plus, times};
use crate::linalg::vector::{cross, inner};

/// A 3 × 3 matrix, by rows.
pub(super) type Block = [[f64; 3]; 3];

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
    pub c: Vector,
    /// 1/(1 + t_a·t_b)
    factor: f64,
}

impl Pair {
    /// The twist of `b` against `a`.
    #[inline]
    pub fn new(a: &Triad, b: &Triad) -> Pair {
        let sin = inner(a.binormal, b.normal) - inner(a.normal, b.binormal);
        let cos = inner(a.normal, b.normal) + inner(a.binormal, b.binormal);
        Pair { angle: libm::atan2(sin, cos), ..Pair::of_tangents(a.tangent, b.tangent) }
    }

    /// c alone; the angle is 0.
    #[inline]
    pub fn of_tangents(a: Vector, b: Vector) -> Pair {
        let factor = 1.0 / (1.0 + inner(a, b));
        Pair { angle: 0.0, c: times(factor, cross(a, b)), factor }
    }

    /// The derivatives of (c/|r′_a|, c/|r′_b|) by r′_a and r′_b, times `weight`: `[i][j]` is that of the entry i by r′ of j.
    #[inline]
    pub(super) fn second(&self, a: &Triad, b: &Triad, weight: f64) -> [[Block; 2]; 2] {
        let ends = [a, b];
        let sum = plus(a.tangent, 1.0, b.tangent);
        let swept = [times(-1.0, b.tangent), a.tangent];
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let scale = weight / (ends[i].length * ends[j].length);
                let own = if i == j { 1.0 } else { 0.0 };
                let mut out = skew(times(scale * self.factor, swept[j]));
                // The length in front of c changes only with its own end.
                let row = times(scale, plus(times(self.factor, sum), own, ends[j].tangent));
                for (out, c) in out.iter_mut().zip(self.c) {
                    *out = plus(*out, -c, row);
                }
                out
            })
        })
    }
}

impl Triad {
    /// The vector x in δΘ = δφ + x·δr′ for increments (δr′, φ) of a configuration whose r′ was less by `increment`.
    pub fn spin_by_slope(&self, increment: Vector) -> Vector {
        spin_by_slope(plus(times(self.length, self.tangent), -1.0, increment), increment)
    }
}

/// The vector x in δΘ = δφ + x·δr′ for increments (δr′, φ) of a configuration whose r′ was `before`, and has grown by `increment`:
/// x = −c/|r′| with c of the tangents before and now, −(r′₀ × r′)/(|r′| (|r′₀||r′| + r′₀·r′)).
#[inline]
pub(super) fn spin_by_slope(before: Vector, increment: Vector) -> Vector {
    let now = plus(before, 1.0, increment);
    let (old, new) = (inner(before, before).sqrt(), inner(now, now).sqrt());
    times(-1.0 / (new * (old * new + inner(before, now))), cross(before, increment))
}

/// \[x\]×, with \[x\]× y = x × y.
#[inline(always)]
pub(super) fn skew(x: Vector) -> Block {
    [[0.0, -x[2], x[1]], [x[2], 0.0, -x[0]], [-x[1], x[0], 0.0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    const X: Vector = [1.0, 0.0, 0.0];
    const Y: Vector = [0.0, 1.0, 0.0];
    const Z: Vector = [0.0, 0.0, 1.0];

    #[test]
    fn transport_around_an_octant_turns_by_its_solid_angle() {
        // The smallest rotations along a triangle of great circles turn a frame by the area of the triangle, π/2.
        let begin = Triad::new(X, Y);
        let end = begin.transported(Y, 0.0).transported(Z, 0.0).transported(X, 0.0);
        assert!((Pair::new(&begin, &end).angle - FRAC_PI_2).abs() < 1e-15);
    }

    #[test]
    fn the_twist_is_the_angle_behind_the_transport_and_changes_its_sign_with_the_order() {
        let a = Triad::new([0.3, -1.2, 0.4], times(1.0 / 1.53_f64.sqrt(), [1.2, 0.3, 0.0]));
        for angle in [-3.0, -0.4, 0.0, 1e-9, 2.5] {
            let b = a.transported([0.9, 0.1, -0.7], angle);
            assert!((Pair::new(&a, &b).angle - angle).abs() < 4e-16 * 8.0);
            assert!((Pair::new(&b, &a).angle + angle).abs() < 4e-16 * 8.0);
        }
    }
}
