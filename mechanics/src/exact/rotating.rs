//! Flapwise vibration of the uniform rotating cantilever, by its power series.
//!
//! With L = ρA = EI = 1 and the tension T = Ω² [a + ½ − a x − ½x²] the deflection satisfies
//!
//! ```text
//! w⁗ − (T w′)′ − ω² w = 0,   w(0) = w′(0) = w″(1) = w‴(1) = 0
//! ```
//!
//! From panel to panel of the beam a power series carries the plane of solutions with w = w′ = 0 at the root; two vectors of it are
//! made orthonormal again behind each, or the one that grows fastest would hide the other. ω is where the determinant of the
//! conditions at x = 1 vanishes.
//!
//! Source: A. D. Wright, C. E. Smith, R. W. Thresher & J. L. C. Wang, *J. Appl. Mech.* 49 (1982) 197–202,
//! doi:10.1115/1.3161966.

/// Terms of a series in a panel, in which nothing grows more than e-fold: 1/32! is far below rounding.
const TERMS: usize = 32;

/// Frequency ω of flapwise mode `mode` = 1, 2, … at the speed Ω, both in units of √(EI/(ρA L⁴)), of a beam whose root is
/// `hub` lengths from the axis. `mode` = 0 is taken as 1. Eleven digits.
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

/// w₁″ w₂‴ − w₁‴ w₂″ at x = 1, times a positive number, for Ω² and ω².
fn determinant(speed: f64, frequency: f64, hub: f64) -> f64 {
    let fastest = f64::max((speed * (hub + 0.5)).sqrt(), frequency.sqrt().sqrt());
    let panels = fastest.ceil().max(1.0);
    let h = 1.0 / panels;
    // w, h w′, h² w″, h³ w‴ of two solutions.
    let mut plane = [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];
    for panel in 0..panels as usize {
        let x = panel as f64 * h;
        // T h² in powers of the place in the panel.
        let tension =
            [hub + 0.5 - hub * x - 0.5 * x * x, -(hub + x) * h, -0.5 * h * h].map(|t| speed * h * h * t);
        plane = plane.map(|y| carried(y, tension, frequency * h * h * h * h));
        let inner = |a: [f64; 4], b: [f64; 4]| a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>();
        let unit = |y: [f64; 4]| y.map(|x| x / inner(y, y).sqrt());
        let first = unit(plane[0]);
        let along = inner(first, plane[1]);
        plane = [first, unit([0, 1, 2, 3].map(|k| plane[1][k] - along * first[k]))];
    }
    let [a, b] = plane;
    a[2] * b[3] - a[3] * b[2]
}

/// A solution and its first three derivatives at the end of a panel of length one, from those at its beginning.
fn carried([w, slope, second, third]: [f64; 4], tension: [f64; 3], frequency: f64) -> [f64; 4] {
    // Coefficients n … n + 3 of the series.
    let mut a = [w, slope, 0.5 * second, third / 6.0];
    let mut sums = [0.0; 4];
    for n in 0..TERMS {
        let k = n as f64;
        let mut term = a[0];
        for (j, sum) in sums.iter_mut().enumerate() {
            *sum += term;
            term *= k - j as f64;
        }
        let pulled = tension[0] * (k + 2.0) * (k + 1.0) * a[2]
            + tension[1] * (k + 1.0) * (k + 1.0) * a[1]
            + tension[2] * k * (k + 1.0) * a[0];
        let next = (pulled + frequency * a[0]) / ((k + 4.0) * (k + 3.0) * (k + 2.0) * (k + 1.0));
        a = [a[1], a[2], a[3], next];
    }
    sums
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
    /// Far from the axis the tension is nearly Ω²R(1 − x): with L²/R → 0 the equation is that of a beam under its own weight g = Ω²R, and
    /// for g → ∞ that of a hanging chain, whose frequencies are j √g / 2 with the zeros j of J₀. The bending stiffness adds a part
    /// of the order g^−½.
    #[test]
    fn far_from_the_axis_and_fast_it_is_a_hanging_chain() {
        let off = |pull: f64| {
            let hub = 1e4;
            let found = flapwise_frequency(1, (pull / hub).sqrt(), hub);
            found / (0.5 * 2.404825557695773 * pull.sqrt()) - 1.0
        };
        let (coarse, fine) = (off(1e4), off(4e4));
        assert!(fine > 0.0 && fine < 0.02 && (coarse / fine - 2.0).abs() < 0.1, "{coarse:e} {fine:e}");
    }
}
