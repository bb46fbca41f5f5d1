//! The rotation of a rotation vector, its tangent and the inverse of that, with their derivatives.
//!
//! All three are matrices A(d) = I − f d̃ + g d̃² with functions f and g of x = d·d:
//!
//! ```text
//! R(exp d)ᵀ:  f = c₁,   g = c₂            cₖ(x) = Σ (−x)ʲ/(2j + k)!
//! T(d):       f = c₂,   g = c₃            cₖ = 1/k! − x cₖ₊₂,   dcₖ/dx = (k cₖ₊₂ − cₖ₊₁)/2
//! T(d)⁻¹:     f = −½,   g = (c₃ − 2c₄)/(2c₂)
//! ```
//!
//! cₖ are Stumpff's functions. No angle is small to them: the two of highest number are summed as series, the others follow from
//! these. For vectors n and p, with a = n × p, l = d·a, s = (d·n)(d·p) − x n·p and s′ = (d·p) n + (d·n) p − 2 (n·p) d,
//!
//! ```text
//! n·A p   = n·p + f l + g s
//! ∂/∂d    = f a + g s′ + 2 (f′ l + g′ s) d
//! ∂²/∂d²  = g (n pᵀ + p nᵀ − 2 n·p I) + 2 f′ (a dᵀ + d aᵀ) + 2 g′ (s′ dᵀ + d s′ᵀ)
//!           + 2 (f′ l + g′ s) I + 4 (f″ l + g″ s) d dᵀ
//! ```

use crate::linalg::{Mat3, Vec3};

/// A function of x with its first and second derivative.
type Jet = [f64; 3];

/// Terms of a series: the rest is below rounding for x ≤ π².
const TERMS: usize = 11;
/// As many are enough for x up to this, a quarter of a radian: within most elements.
const FEW: usize = 5;
const SMALL: f64 = 0.0625;

/// 1/k!
const INVERSE_FACTORIALS: [f64; 9] = {
    let (mut out, mut k, mut product) = ([1.0; 9], 1, 1.0);
    while k < 9 {
        product *= k as f64;
        out[k] = 1.0 / product;
        k += 1;
    }
    out
};

/// 1/((2j + k + 1)(2j + k + 2)), the quotient of the terms j + 1 and j of cₖ but for −x.
const fn quotients(k: usize) -> [f64; TERMS] {
    let (mut out, mut j) = ([0.0; TERMS], 0);
    while j < TERMS {
        out[j] = 1.0 / ((2 * j + k + 1) as f64 * (2 * j + k + 2) as f64);
        j += 1;
    }
    out
}

const OF_SEVEN: [f64; TERMS] = quotients(7);
const OF_EIGHT: [f64; TERMS] = quotients(8);

/// c₁ to c₈ at a place x, by their number.
#[derive(Clone, Copy, Debug)]
struct Stumpff([f64; 9]);

impl Stumpff {
    #[inline(always)]
    fn at(x: f64) -> Stumpff {
        if x <= SMALL { Stumpff::summed::<FEW>(x) } else { Stumpff::summed::<TERMS>(x) }
    }

    #[inline(always)]
    fn summed<const COUNT: usize>(x: f64) -> Stumpff {
        let mut c = [0.0; 9];
        (c[7], c[8]) = (1.0, 1.0);
        for j in (0..COUNT).rev() {
            c[7] = 1.0 - x * OF_SEVEN[j] * c[7];
            c[8] = 1.0 - x * OF_EIGHT[j] * c[8];
        }
        c[7] *= INVERSE_FACTORIALS[7];
        c[8] *= INVERSE_FACTORIALS[8];
        for k in (1..=6).rev() {
            c[k] = INVERSE_FACTORIALS[k] - x * c[k + 2];
        }
        Stumpff(c)
    }

    /// cₖ, k ≤ 4.
    #[inline(always)]
    fn jet(&self, k: usize) -> Jet {
        let (c, of) = (&self.0, k as f64);
        let second = of * (of + 2.0) * c[k + 4] - (2.0 * of + 1.0) * c[k + 3] + c[k + 2];
        [c[k], 0.5 * (of * c[k + 2] - c[k + 1]), 0.25 * second]
    }
}

/// A(d) of a vector d, |d| ≤ π. See the [module documentation](self).
#[derive(Clone, Copy, Debug)]
pub(super) struct RotationMap {
    vector: Vec3,
    first: Jet,
    second: Jet,
}

impl RotationMap {
    /// R(exp d)ᵀ and T(d)
    #[inline(always)]
    pub fn inverse_rotation_and_tangent(d: Vec3) -> [RotationMap; 2] {
        let c = Stumpff::at(d.dot(d));
        let [one, two, three] = [c.jet(1), c.jet(2), c.jet(3)];
        let map = |first: Jet, second: Jet| RotationMap { vector: d, first, second };
        [map(one, two), map(two, three)]
    }

    /// T(d)⁻¹
    #[inline(always)]
    pub fn inverse_tangent(d: Vec3) -> RotationMap {
        let c = Stumpff::at(d.dot(d));
        let [two, three, four] = [c.jet(2), c.jet(3), c.jet(4)];
        // g = n/m with m = 2c₂, m′ = −n
        let n: Jet = std::array::from_fn(|i| three[i] - 2.0 * four[i]);
        let inverse = 0.5 / two[0];
        let g = inverse * n[0];
        let slope = inverse * (n[1] + g * n[0]);
        let second = inverse * (n[2] + 2.0 * slope * n[0] + g * n[1]);
        RotationMap { vector: d, first: [-0.5, 0.0, 0.0], second: [g, slope, second] }
    }

    /// Aᵀ
    #[inline(always)]
    pub fn transposed(&self) -> RotationMap {
        RotationMap { first: self.first.map(|f| -f), ..*self }
    }

    /// A p
    #[inline(always)]
    pub fn apply(&self, p: Vec3) -> Vec3 {
        let once = self.vector.cross(p);
        p + self.second[0] * self.vector.cross(once) - self.first[0] * once
    }

    /// A
    #[inline(always)]
    pub fn matrix(&self) -> Mat3 {
        let (d, f, g) = (self.vector, self.first[0], self.second[0]);
        let diagonal = 1.0 - g * d.dot(d);
        let scaled = g * d;
        let mut out = Mat3::outer(scaled, d) - Mat3::skew(f * d);
        (0..3).for_each(|k| out[k][k] += diagonal);
        out
    }

    /// ∂(A p)/∂d
    #[inline(always)]
    pub fn derivative(&self, p: Vec3) -> Mat3 {
        let (d, [f, f1, _], [g, g1, _]) = (self.vector, self.first, self.second);
        let along = d.dot(p);
        let once = d.cross(p);
        let by_square = 2.0 * (g1 * d.cross(once) - f1 * once) - 2.0 * g * p;
        let mut out = Mat3::skew(f * p) + Mat3::outer(g * d, p) + Mat3::outer(by_square, d);
        (0..3).for_each(|k| out[k][k] += g * along);
        out
    }

    /// a, l, s and s′ of n and p.
    #[inline(always)]
    fn products(&self, n: Vec3, p: Vec3) -> (Vec3, f64, f64, Vec3) {
        let (d, a) = (self.vector, n.cross(p));
        let (dn, dp, np) = (d.dot(n), d.dot(p), n.dot(p));
        (a, d.dot(a), dn * dp - d.dot(d) * np, dp * n + dn * p - 2.0 * np * d)
    }

    /// ∂(n·A p)/∂d
    #[inline(always)]
    pub fn gradient(&self, n: Vec3, p: Vec3) -> Vec3 {
        let (a, l, s, slope) = self.products(n, p);
        self.first[0] * a
            + self.second[0] * slope
            + 2.0 * (self.first[1] * l + self.second[1] * s) * self.vector
    }

    /// ∂²(n·A p)/∂d²
    #[inline(always)]
    pub fn hessian(&self, n: Vec3, p: Vec3) -> Mat3 {
        let (d, [_, f1, f2], [g, g1, g2]) = (self.vector, self.first, self.second);
        let (a, l, s, slope) = self.products(n, p);
        // Half of the matrix x dᵀ + d xᵀ, and of n pᵀ + p nᵀ.
        let x = 2.0 * (f1 * a + g1 * slope) + 2.0 * (f2 * l + g2 * s) * d;
        let half = Mat3::outer(x, d) + Mat3::outer(g * n, p);
        let mut out = half + half.transpose();
        let diagonal = 2.0 * (f1 * l + g1 * s) - 2.0 * g * n.dot(p);
        (0..3).for_each(|k| out[k][k] += diagonal);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::multibody::rotation;

    const VECTORS: [Vec3; 5] = [
        Vec3([0.3, -0.7, 1.1]),
        Vec3([2.0, 1.5, -1.2]),
        Vec3([1e-4, 2e-4, -3e-4]),
        Vec3([0.0; 3]),
        Vec3([0.0, 3.1, 0.0]),
    ];

    fn maps(d: Vec3) -> [RotationMap; 3] {
        let [rotation, tangent] = RotationMap::inverse_rotation_and_tangent(d);
        [rotation, tangent, RotationMap::inverse_tangent(d)]
    }

    fn close(a: Vec3, b: Vec3, allowed: f64) -> bool {
        (a - b).0.iter().all(|x| x.abs() < allowed)
    }

    #[test]
    fn the_maps_are_those_of_rotation_vectors() {
        for d in VECTORS {
            let [rotation, tangent, inverse] = maps(d);
            for axis in Vec3::AXES {
                assert!(close(rotation.apply(axis), rotation::about(d).transpose() * axis, 2e-15), "{d:?}");
                assert!(close(tangent.apply(axis), rotation::tangent(d) * axis, 1e-15), "{d:?}");
                assert!(close(inverse.apply(axis), rotation::rate(d, axis), 1e-14), "{d:?}");
                for map in [rotation, tangent, inverse] {
                    assert!(close(map.apply(axis), map.matrix() * axis, 1e-15), "{d:?}");
                    let back = map.transposed().matrix().transpose();
                    assert!(close(back * axis, map.apply(axis), 1e-15), "{d:?}");
                }
            }
        }
    }

    /// By central differences with the error of h² removed.
    #[test]
    fn derivatives_are_those_of_the_maps() {
        let (n, p) = (Vec3([0.4, -1.3, 0.8]), Vec3([-0.9, 0.2, 1.7]));
        let difference = |at: &dyn Fn(f64) -> Vec3| {
            let [near, far] = [1e-3, 2e-3].map(|h| at(h) - at(-h));
            1.0 / 0.012 * (8.0 * near - far)
        };
        for d in VECTORS {
            for which in 0..3 {
                let (map, allowed) = (maps(d)[which], 2e-10);
                let (derivative, hessian) = (map.derivative(p), map.hessian(n, p));
                let gradient = map.gradient(n, p);
                for (j, axis) in Vec3::AXES.into_iter().enumerate() {
                    let moved = |h: f64| maps(d + h * axis)[which];
                    let expected = difference(&|h| moved(h).apply(p));
                    assert!(close(derivative.column(j), expected, allowed), "{d:?} {which} {j}");
                    assert!((gradient[j] - n.dot(expected)).abs() < allowed, "{d:?} {which} {j}");
                    let expected = difference(&|h| moved(h).gradient(n, p));
                    assert!(close(hessian.column(j), expected, allowed), "{d:?} {which} {j}");
                }
            }
        }
    }
}
