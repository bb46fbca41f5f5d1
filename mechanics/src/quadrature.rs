//! Gauss–Legendre quadrature.
//!
//! ∫₋₁¹ f(z) dz ≈ Σ wᵢ f(zᵢ), exact for polynomials of degree 2n − 1, where zᵢ are the zeros of the
//! Legendre polynomial Pₙ and wᵢ = 2 / ((1 − zᵢ²) Pₙ′(zᵢ)²).
//!
//! Source: Abramowitz & Stegun, *Handbook of Mathematical Functions* (1964), 25.4.29.

use std::f64::consts::PI;

/// Tolerance of the moments of a function, over ∫|f| dx, and how often an interval may be halved for it.
const TOLERANCE: f64 = 1e-10;
const HALVINGS: u32 = 24;
/// Distance of two ends that count as one, over the whole interval.
const SAME: f64 = 1e-12;

/// A Gauss–Legendre rule of n points.
#[derive(Clone, Debug, PartialEq)]
pub struct Gauss {
    points: Vec<f64>,
    weights: Vec<f64>,
}

impl Gauss {
    /// The rule of `n` points on [−1, 1], to working precision (`n` = 0 is taken as 1).
    ///
    /// Newton's method on Pₙ from zᵢ ≈ cos(π (i − ¼)/(n + ½)); symmetric to the last digit.
    pub fn new(n: usize) -> Gauss {
        let n = n.max(1);
        let (mut points, mut weights) = (vec![0.0; n], vec![0.0; n]);
        for i in 0..n.div_ceil(2) {
            let middle = 2 * i + 1 == n;
            let mut z = if middle { 0.0 } else { libm::cos(PI * (i as f64 + 0.75) / (n as f64 + 0.5)) };
            let (mut p, mut slope) = legendre(n, z);
            for _ in 0..10 {
                let step = p / slope;
                if middle || step.abs() <= 2e-16 {
                    break;
                }
                z -= step;
                (p, slope) = legendre(n, z);
            }
            let weight = 2.0 / ((1.0 - z) * (1.0 + z) * slope * slope);
            (points[i], points[n - 1 - i]) = (-z, z);
            (weights[i], weights[n - 1 - i]) = (weight, weight);
        }
        Gauss { points, weights }
    }

    /// Number of points n.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Always false: a rule has at least one point.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Points and weights (x, w) of ∫ₐᵇ f dx ≈ Σ w f(x), x ascending when a < b.
    pub fn on(&self, a: f64, b: f64) -> impl ExactSizeIterator<Item = (f64, f64)> + Clone + '_ {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        self.points.iter().zip(&self.weights).map(move |(z, w)| (middle + half * z, half * w))
    }

    /// ∫ₐᵇ f dx with this rule.
    pub fn integrate(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        self.on(a, b).map(|(x, w)| w * f(x)).sum()
    }

    /// Intervals between these `ends` \[m\], in any order, halved until this rule integrates f, by itself and times a cubic, to 10⁻¹⁰ of ∫|f| dx or in
    /// 2⁻²⁴ of an interval. The ends must show f: three points between two of them see it.
    pub fn resolved(&self, mut ends: Vec<f64>, f: impl Fn(f64) -> f64) -> Vec<f64> {
        ends.sort_by(f64::total_cmp);
        let (Some(&first), Some(&last)) = (ends.first(), ends.last()) else { return ends };
        ends.dedup_by(|b, a| *b - *a <= SAME * (last - first));
        let size: f64 = ends.windows(2).map(|e| self.integrate(e[0], e[1], |x| f(x).abs())).sum();
        let mut open: Vec<(f64, f64, u32)> = ends.windows(2).rev().map(|e| (e[0], e[1], 0)).collect();
        let mut out = vec![first];
        while let Some((a, b, halvings)) = open.pop() {
            let middle = 0.5 * (a + b);
            let moments = |from: f64, to: f64| {
                let cubic = |x: f64| ((x - a) / (b - a)).powi(3);
                [0, 1].map(|k| self.integrate(from, to, |x| f(x) * if k == 0 { 1.0 } else { cubic(x) }))
            };
            let (whole, first, second) = (moments(a, b), moments(a, middle), moments(middle, b));
            let good = (0..2).all(|k| (whole[k] - first[k] - second[k]).abs() <= TOLERANCE * size);
            if good || halvings == HALVINGS {
                out.push(b);
            } else {
                open.push((middle, b, halvings + 1));
                open.push((a, middle, halvings + 1));
            }
        }
        out
    }
}

/// Pₙ(z) and Pₙ′(z) for |z| < 1, by the three-term recurrence.
fn legendre(n: usize, z: f64) -> (f64, f64) {
    let (mut before, mut p) = (1.0, z);
    for k in 2..=n {
        let k = k as f64;
        (before, p) = (p, ((2.0 * k - 1.0) * z * p - (k - 1.0) * before) / k);
    }
    (p, n as f64 * (before - z * p) / ((1.0 - z) * (1.0 + z)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn monomials_up_to_degree_2n_minus_1_are_exact_and_the_next_is_not() {
        for n in [1, 2, 3, 4, 5, 8, 13, 20, 33, 64] {
            let gauss = Gauss::new(n);
            for degree in 0..2 * n {
                let exact = 1.0 / (degree as f64 + 1.0);
                let found = gauss.integrate(0.0, 1.0, |x| x.powi(degree as i32));
                assert!((found - exact).abs() < 2e-15, "n {n} degree {degree}: {found} for {exact}");
            }
            if n < 8 {
                let degree = 2 * n as i32;
                let missed = gauss.integrate(0.0, 1.0, |x| x.powi(degree)) - 1.0 / (degree as f64 + 1.0);
                assert!(missed < -1e-10, "n {n}: degree 2n must be missed from below, got {missed}");
            }
        }
    }

    #[test]
    fn three_points_are_those_of_the_handbook() {
        let rule: Vec<_> = Gauss::new(3).on(-1.0, 1.0).collect();
        let z = 0.6_f64.sqrt();
        let handbook = [(-z, 5.0 / 9.0), (0.0, 8.0 / 9.0), (z, 5.0 / 9.0)];
        for ((x, w), (z, v)) in rule.into_iter().zip(handbook) {
            assert!((x - z).abs() < 2e-16 && (w - v).abs() < 5e-16, "({x}, {w}) for ({z}, {v})");
        }
    }

    #[test]
    fn an_oscillating_function_is_integrated_on_any_interval() {
        let exact = (3.0_f64.cos() - 21.0_f64.cos()) / 3.0;
        let found = Gauss::new(24).integrate(1.0, 7.0, |x| (3.0 * x).sin());
        assert!((found - exact).abs() < 1e-14, "{found} for {exact}");
    }
}
