//! Coefficients of the 3-stage Radau IIA method and its decoupling.
//!
//! Source: Hairer & Wanner, *Solving Ordinary Differential Equations II*, table IV.5.6 and section IV.8
//! (doi 10.1007/978-3-642-05221-7).

// The constants are given to the last digit, rounding excluded.
#![allow(clippy::excessive_precision)]

/// √6
const ROOT: f64 = 2.449_489_742_783_178;

/// Nodes c.
pub(super) const C: [f64; 3] = [(4.0 - ROOT) / 10.0, (4.0 + ROOT) / 10.0, 1.0];

/// Coefficients A; the last row is b.
pub(super) const A: [[f64; 3]; 3] = [
    [(88.0 - 7.0 * ROOT) / 360.0, (296.0 - 169.0 * ROOT) / 1800.0, (-2.0 + 3.0 * ROOT) / 225.0],
    [(296.0 + 169.0 * ROOT) / 1800.0, (88.0 + 7.0 * ROOT) / 360.0, (-2.0 - 3.0 * ROOT) / 225.0],
    [(16.0 - ROOT) / 36.0, (16.0 + ROOT) / 36.0, 1.0 / 9.0],
];

/// A².
pub(super) const A2: [[f64; 3]; 3] = square(A);

/// A⁻¹.
pub(super) const A_INVERSE: [[f64; 3]; 3] = [
    [3.224_744_871_391_589, 1.167_840_084_690_405_5, -0.253_197_264_742_180_83],
    [-3.567_840_084_690_405_5, 0.775_255_128_608_410_95, 1.053_197_264_742_180_8],
    [5.531_972_647_421_808_3, -7.531_972_647_421_808_3, 5.0],
];

/// A⁻².
pub(super) const A2_INVERSE: [[f64; 3]; 3] = square(A_INVERSE);

/// Real eigenvalue 1/γ of A⁻¹.
const INVERSE_GAMMA: f64 = 3.637_834_252_744_495_7;
/// Complex eigenvalues α ± iβ of A⁻¹.
const ALPHA: f64 = 2.681_082_873_627_752;
const BETA: f64 = 3.050_430_199_247_410_6;

/// γ, the real eigenvalue of A.
pub(super) const GAMMA: f64 = 1.0 / INVERSE_GAMMA;

/// μ = 1/(α + iβ), the complex eigenvalue of A: real and imaginary parts.
pub(super) const MU: [f64; 2] =
    [ALPHA / (ALPHA * ALPHA + BETA * BETA), -BETA / (ALPHA * ALPHA + BETA * BETA)];

/// T, with A = T Λ T⁻¹, Λ = diag(γ, [μ]), [μ] = ⎡Re μ  −Im μ⎤
///                                               ⎣Im μ   Re μ⎦.
pub(super) const T: [[f64; 3]; 3] = [
    [9.123_239_487_089_294e-2, -0.141_255_295_020_954_2, -3.002_919_410_514_742_4e-2],
    [0.241_717_932_707_107, 0.204_129_352_293_799_94, 0.382_942_112_757_261_94],
    [0.966_048_182_615_092_9, 1.0, 0.0],
];

/// T⁻¹.
pub(super) const T_INVERSE: [[f64; 3]; 3] = [
    [4.325_579_890_063_155, 0.339_199_251_815_809_84, 0.541_770_539_935_874_9],
    [-4.178_718_591_551_905, -0.327_682_820_761_062_4, 0.476_623_554_500_550_44],
    [-0.502_872_634_945_786_9, 2.571_926_949_855_605_4, -0.596_039_204_828_224_9],
];

/// Weights e of the stage increments in the error estimate ŷ − y = γ h f(y₀) + Σ eᵢ Zᵢ.
const E: [f64; 3] = [GAMMA / 3.0 * (-13.0 - 7.0 * ROOT), GAMMA / 3.0 * (-13.0 + 7.0 * ROOT), -GAMMA / 3.0];

/// eᵀA: weights of the stage accelerations in the velocity's estimate, over h.
pub(super) const E_V: [f64; 3] = row_times(E, A);

/// eᵀA²: weights of the stage accelerations in the position's estimate, over h². (The weight of v₀,
/// γ + Σ eᵢ cᵢ, is zero.)
pub(super) const E_Q: [f64; 3] = row_times(E, A2);

const fn row_times(e: [f64; 3], a: [[f64; 3]; 3]) -> [f64; 3] {
    let mut out = [0.0; 3];
    let mut j = 0;
    while j < 3 {
        out[j] = e[0] * a[0][j] + e[1] * a[1][j] + e[2] * a[2][j];
        j += 1;
    }
    out
}

const fn square(a: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    [row_times(a[0], a), row_times(a[1], a), row_times(a[2], a)]
}

/// Values at s of the quadratic through 1, 0, 0 and so on at the nodes.
pub(super) fn lagrange(s: f64) -> [f64; 3] {
    let [c1, c2, c3] = C;
    [
        (s - c2) * (s - c3) / ((c1 - c2) * (c1 - c3)),
        (s - c1) * (s - c3) / ((c2 - c1) * (c2 - c3)),
        (s - c1) * (s - c2) / ((c3 - c1) * (c3 - c2)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn product(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        [row_times(a[0], b), row_times(a[1], b), row_times(a[2], b)]
    }

    fn assert_close(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) {
        for i in 0..3 {
            for j in 0..3 {
                assert!((a[i][j] - b[i][j]).abs() < 1e-14, "({i}, {j}): {} {}", a[i][j], b[i][j]);
            }
        }
    }

    #[test]
    fn the_decoupling_reproduces_the_coefficients() {
        let lambda = [[GAMMA, 0.0, 0.0], [0.0, MU[0], -MU[1]], [0.0, MU[1], MU[0]]];
        assert_close(product(product(T, lambda), T_INVERSE), A);
        assert_close(product(T, T_INVERSE), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    }

    #[test]
    fn the_inverses_are_those_of_the_coefficients() {
        let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_close(product(A, A_INVERSE), identity);
        assert_close(product(A2, A2_INVERSE), identity);
    }

    /// B(5): Σ bᵢ cᵢᵏ⁻¹ = 1/k, k ≤ 5, and C(3): Σ aᵢⱼ cⱼᵏ⁻¹ = cᵢᵏ/k, k ≤ 3.
    #[test]
    fn the_order_conditions_of_order_five_hold() {
        for k in 1..=5 {
            let sum: f64 = (0..3).map(|i| A[2][i] * C[i].powi(k - 1)).sum();
            assert!((sum - 1.0 / f64::from(k)).abs() < 1e-15, "B({k})");
        }
        for k in 1..=3 {
            for i in 0..3 {
                let sum: f64 = (0..3).map(|j| A[i][j] * C[j].powi(k - 1)).sum();
                assert!((sum - C[i].powi(k) / f64::from(k)).abs() < 1e-15, "C({k}), row {i}");
            }
        }
        let sum: f64 = GAMMA + (0..3).map(|i| E[i] * C[i]).sum::<f64>();
        assert!(sum.abs() < 1e-15, "the estimate is consistent");
    }
}
