//! Bessel functions of whole order for x > 0.
//!
//! J and I by Miller's backward recurrence, normalised by J₀ + 2J₂ + 2J₄ + … = 1 and I₀ + 2I₁ + 2I₂ + … = eˣ;
//! Y₀ from Neumann's expansion, Y₁ = −Y₀′ from its derivative, the rest by forward recurrence; K from its
//! integral by the trapezoidal rule, which converges exponentially:
//!
//! ```text
//! Y₀ = 2/π (ln(x/2) + γ) J₀ − 4/π Σ (−1)ᵏ J₂ₖ/k
//! eˣ Kₙ = ∫₀^∞ e^{−x(cosh t − 1)} cosh nt dt
//! ```
//!
//! Source: M. Abramowitz & I. A. Stegun, *Handbook of Mathematical Functions* (1964), 9.1.27, 9.1.46, 9.1.89,
//! 9.6.24, 9.6.37 and 9.12.

use std::f64::consts::PI;

/// Euler's constant γ.
const EULER: f64 = 0.577_215_664_901_532_9;
/// Highest order kept, plus one.
pub(super) const ORDERS: usize = 5;

/// Values of orders 0 to 4 at one argument.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bessel {
    /// Jₙ.
    pub j: [f64; ORDERS],
    /// Yₙ.
    pub y: [f64; ORDERS],
    /// e⁻ˣ Iₙ.
    pub i: [f64; ORDERS],
    /// eˣ Kₙ.
    pub k: [f64; ORDERS],
}

impl Bessel {
    /// All four at x > 0.
    pub fn at(x: f64) -> Bessel {
        // Beyond x + 9 x^⅓ + 30 orders J is below rounding.
        let top = 2 * ((x + 9.0 * libm::cbrt(x) + 30.0) / 2.0) as usize;
        let all = backward(x, top, -1.0);
        let sum = all[0] + 2.0 * all.iter().skip(2).step_by(2).sum::<f64>();
        let at = |n: usize| all[n] / sum;
        let logarithm = libm::log(0.5 * x) + EULER;
        let (mut even, mut slopes) = (0.0, 0.0);
        for k in (1..top / 2).rev() {
            let sign = if k % 2 == 0 { 1.0 } else { -1.0 } / k as f64;
            even += sign * at(2 * k);
            slopes += sign * 0.5 * (at(2 * k - 1) - at(2 * k + 1));
        }
        let mut y = [0.0; ORDERS];
        y[0] = 2.0 / PI * (logarithm * at(0) - 2.0 * even);
        y[1] = -2.0 / PI * (at(0) / x - logarithm * at(1) - 2.0 * slopes);
        for n in 2..ORDERS {
            y[n] = 2.0 * (n - 1) as f64 / x * y[n - 1] - y[n - 2];
        }
        let growing = backward(x, top, 1.0);
        let total = growing[0] + 2.0 * growing.iter().skip(1).sum::<f64>();
        Bessel {
            j: std::array::from_fn(at),
            y,
            i: std::array::from_fn(|n| growing[n] / total),
            k: std::array::from_fn(|n| decaying(n, x)),
        }
    }
}

/// f_{n−1} = (2n/x) f_n + sign f_{n+1} from order `top` down, up to a common factor.
fn backward(x: f64, top: usize, sign: f64) -> Vec<f64> {
    let mut f = vec![0.0; top + 2];
    f[top] = 1e-290;
    for n in (1..=top).rev() {
        f[n - 1] = 2.0 * n as f64 / x * f[n] + sign * f[n + 1];
        if f[n - 1].abs() > 1e200 {
            f[n - 1..].iter_mut().for_each(|f| *f *= 1e-200);
        }
    }
    f
}

/// eˣ Kₙ(x).
fn decaying(n: usize, x: f64) -> f64 {
    // The integrand has fallen to e⁻⁴⁵ where cosh t = 1 + 60/x; it varies over 1/√x there.
    let end = libm::acosh(1.0 + 60.0 / x);
    let steps = 200;
    let h = end / steps as f64;
    let value = |t: f64| libm::exp(-x * 2.0 * libm::sinh(0.5 * t).powi(2)) * libm::cosh(n as f64 * t);
    h * (0.5 * value(0.0) + (1..=steps).map(|i| value(i as f64 * h)).sum::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_the_handbook() {
        // Abramowitz & Stegun, tables 9.1, 9.2, 9.8, 9.9 and 9.11.
        let (one, five) = (Bessel::at(1.0), Bessel::at(5.0));
        let e = std::f64::consts::E;
        for (found, exact, tolerance) in [
            (one.j[0], 0.765_197_686_557_966_6, 1e-15),
            (one.j[1], 0.440_050_585_744_933_5, 1e-15),
            (five.j[0], -0.177_596_771_314_338_3, 2e-15),
            (five.j[3], 0.364_831_230_613_666_7, 2e-15),
            (one.y[0], 0.088_256_964_215_677, 1e-15),
            (one.y[1], -0.781_212_821_300_288_7, 1e-15),
            (five.y[1], 0.147_863_143_391_226_8, 2e-15),
            (one.i[0] * e, 1.266_065_877_752_008_4, 2e-15),
            (five.i[1] * e.powi(5), 24.335_642_142_450_53, 2e-13),
            (one.k[0] / e, 0.421_024_438_240_708_34, 1e-15),
            (one.k[1] / e, 0.601_907_230_197_234_6, 1e-15),
        ] {
            assert!((found - exact).abs() < tolerance, "{found} for {exact}");
        }
    }

    #[test]
    fn the_wronskians_hold_from_small_to_large_arguments() {
        for x in [0.02, 0.3, 2.0, 9.0, 40.0, 300.0] {
            let b = Bessel::at(x);
            for n in 0..ORDERS - 1 {
                let one = (b.j[n + 1] * b.y[n] - b.j[n] * b.y[n + 1]) * PI * x / 2.0;
                let two = (b.i[n] * b.k[n + 1] + b.i[n + 1] * b.k[n]) * x;
                assert!((one - 1.0).abs() < 2e-13 * (1.0 + x), "J, Y of order {n} at {x}: {:e}", one - 1.0);
                assert!((two - 1.0).abs() < 1e-13, "I, K of order {n} at {x}: {:e}", two - 1.0);
            }
        }
    }
}
