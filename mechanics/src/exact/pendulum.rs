//! A rigid rod that falls about its end.
//!
//! Source: any text on mechanics; the elliptic functions by arithmetic–geometric means, M. Abramowitz & I. A. Stegun,
//! *Handbook of Mathematical Functions* (1964), 16.4 and 17.6.

use std::f64::consts::FRAC_PI_2;

/// Angle θ(t) \[rad\] over the horizontal of a uniform rod of length L \[m\] on a frictionless axis through its end, released at
/// rest at `start` θ₀ \[rad\], −π/2 ≤ θ₀ < π/2, under gravity g \[m/s²\]: θ̈ = −(3g/2L) cos θ. With φ = θ + π/2, k = sin(φ₀/2),
///
/// ```text
/// sin(φ/2) = k sn(K(k) + √(3g/2L) t, k)
/// ```
pub fn rod_angle(start: f64, length: f64, gravity: f64, t: f64) -> f64 {
    let modulus = libm::sin(0.5 * (start + FRAC_PI_2));
    let (mut a, mut c) = (vec![1.0_f64], vec![modulus]);
    let mut b = (1.0 - modulus * modulus).sqrt();
    while let (Some(&last), Some(&off)) = (a.last(), c.last())
        && off.abs() > 1e-16
        && a.len() < 30
    {
        a.push(0.5 * (last + b));
        c.push(0.5 * (last - b));
        b = (last * b).sqrt();
    }
    let mean = a.last().copied().unwrap_or(1.0);
    let steps = a.len() - 1;
    let quarter = FRAC_PI_2 / mean;
    let argument = quarter + (1.5 * gravity / length).sqrt() * t;
    let mut amplitude = 2.0_f64.powi(i32::try_from(steps).unwrap_or(0)) * mean * argument;
    for n in (1..=steps).rev() {
        amplitude = 0.5 * (amplitude + libm::asin(c[n] / a[n] * libm::sin(amplitude)));
    }
    2.0 * libm::asin(modulus * libm::sin(amplitude)) - FRAC_PI_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_4, PI};

    #[test]
    fn a_rod_released_at_45_degrees_is_level_after_the_published_time() {
        // Guo, Zhang & Chen 2017, doi:10.7498/aps.66.164501, with L = 1 m and g = 9.81 m/s².
        let angle = |t| rod_angle(FRAC_PI_4, 1.0, 9.81, t);
        assert!((angle(0.0) - FRAC_PI_4).abs() < 1e-15);
        assert!(angle(0.369_998_5).abs() < 4e-7 && angle(0.3699) > 0.0);
    }

    #[test]
    fn a_falling_rod_keeps_its_energy_and_accelerates_by_the_law() {
        let h = 1e-4;
        for start in [-1.5, -0.3, 0.0, 1.2] {
            for t in [0.1, 0.4, 1.3, 4.0] {
                let angle = |t| rod_angle(start, 1.3, 9.81, t);
                let speed = (angle(t + h) - angle(t - h)) / (2.0 * h);
                let expected = 3.0 * 9.81 / 1.3 * (f64::sin(start) - angle(t).sin());
                assert!((speed * speed - expected).abs() < 1e-5, "{start} {t}: {speed} {expected}");
                let acceleration = (angle(t + h) - 2.0 * angle(t) + angle(t - h)) / (h * h);
                assert!((acceleration + 1.5 * 9.81 / 1.3 * angle(t).cos()).abs() < 1e-5, "{start} {t}");
            }
        }
    }

    #[test]
    fn a_hanging_rod_hangs() {
        assert_eq!(rod_angle(-0.5 * PI, 1.0, 9.81, 3.0), -0.5 * PI);
    }
}
