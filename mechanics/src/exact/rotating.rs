//! Flapwise vibration of the uniform rotating cantilever, by its power series.
//!
//! With L = ρA = EI = 1 and the tension T = Ω² [a + ½ − a x − ½x²] the deflection satisfies
//!
//! ```text
//! w⁗ − (T w′)′ − ω² w = 0,   w(0) = w′(0) = w″(1) = w‴(1) = 0
//! ```
//!
//! Two power series, with w = x² + … and w = x³ + …, converge everywhere; ω is where the determinant of the
//! conditions at x = 1 vanishes.
//!
//! Source: A. D. Wright, C. E. Smith, R. W. Thresher & J. L. C. Wang, *J. Appl. Mech.* 49 (1982) 197–202,
//! doi:10.1115/1.3161966.

/// Relative size at which the series end.
const END: f64 = 1e-40;

/// Frequency ω of flapwise mode `mode` = 1, 2, … at the speed Ω, both in units of √(EI/(ρA L⁴)), of a beam whose root is
/// `hub` lengths from the axis. `mode` = 0 is taken as 1. Twelve digits for Ω up to 20 and the first five modes.
pub fn flapwise_frequency(mode: usize, speed: f64, hub: f64) -> f64 {
    let squares = |frequency: f64| determinant(speed * speed, frequency * frequency, hub);
    // No two frequencies are as near as this.
    let step = 0.25;
    let (mut low, mut sign) = (1e-6, squares(1e-6) > 0.0);
    let mut left = mode.max(1);
    loop {
        let high = low + step;
        let next = squares(high) > 0.0;
        if next != sign {
            left -= 1;
            if left == 0 {
                break;
            }
        }
        (low, sign) = (high, next);
        if !low.is_finite() || low > 1e5 {
            return f64::NAN;
        }
    }
    let mut high = low + step;
    while high - low > 4.0 * f64::EPSILON * high {
        let middle = 0.5 * (low + high);
        if (squares(middle) > 0.0) == sign { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// w₁″ w₂‴ − w₁‴ w₂″ at x = 1 of the two series.
fn determinant(speed: f64, frequency: f64, hub: f64) -> f64 {
    let [a, b] = [2, 3].map(|first| tip(first, speed, frequency, hub));
    a.0 * b.1 - a.1 * b.0
}

/// w″(1) and w‴(1) of the series that begins with x^`first`, for Ω² and ω².
fn tip(first: usize, speed: f64, frequency: f64, hub: f64) -> (f64, f64) {
    let mut a = [0.0; 4];
    a[first] = 1.0;
    let (mut second, mut third, mut n) = (0.0, 0.0, 0_usize);
    loop {
        // a holds the coefficients n … n + 3.
        let k = n as f64;
        let bend = k * (k - 1.0) * a[0];
        second += bend;
        third += bend * (k - 2.0);
        let largest = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if n > 20 && largest * k.powi(3) <= END * (second.abs() + third.abs()) {
            return (second, third);
        }
        let tension = (hub + 0.5) * (k + 2.0) * (k + 1.0) * a[2]
            - hub * (k + 1.0) * (k + 1.0) * a[1]
            - 0.5 * k * (k + 1.0) * a[0];
        let next = (speed * tension + frequency * a[0]) / ((k + 4.0) * (k + 3.0) * (k + 2.0) * (k + 1.0));
        a = [a[1], a[2], a[3], next];
        n += 1;
        if n > 2000 {
            return (f64::NAN, f64::NAN);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::cantilever::bending_frequency;

    #[test]
    fn at_rest_the_series_gives_the_frequencies_of_the_cantilever() {
        for mode in 1..=4 {
            let exact = bending_frequency(mode, 1.0, 1.0, 1.0);
            assert!((flapwise_frequency(mode, 0.0, 0.0) / exact - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_published_table_of_a_rotating_beam_is_met_to_its_last_digit() {
        // Wright et al. 1982, hub radius 0.
        for (speed, expected) in
            [(1.0, [3.682, 22.181, 61.842]), (5.0, [6.450, 25.446, 65.205]), (12.0, [13.170, 37.603, 79.615])]
        {
            for (mode, expected) in expected.into_iter().enumerate() {
                let found = flapwise_frequency(mode + 1, speed, 0.0);
                assert!((found - expected).abs() < 6e-4, "{found} for {expected}");
            }
        }
    }
}
