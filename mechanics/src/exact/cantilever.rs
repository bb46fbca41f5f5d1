//! Vibration of the uniform clamped–free (cantilever) beam and rod.
//!
//! Source: R. D. Blevins, *Formulas for Natural Frequency and Mode Shape* (1979), tables 8-1 and 8-16.

use std::f64::consts::PI;

/// Root β L of cos z cosh z + 1 = 0 for bending mode `mode` = 1, 2, …, to the last digits at any order.
///
/// With z = (i − ½)π + δ the equation is sin δ = (−1)ⁱ⁺¹ sech z, in which nothing overflows or cancels;
/// Newton's method on δ. `mode` = 0 is taken as 1.
pub fn eigenvalue(mode: usize) -> f64 {
    let mode = mode.max(1);
    let start = (mode as f64 - 0.5) * PI;
    let sign = alternate(mode);
    let mut offset = sign / libm::cosh(start);
    for _ in 0..50 {
        let z = start + offset;
        let sech = 1.0 / libm::cosh(z);
        let step = (libm::sin(offset) - sign * sech) / (libm::cos(offset) + sign * sech * libm::tanh(z));
        offset -= step;
        if step.abs() <= 1e-17 + 1e-16 * offset.abs() {
            break;
        }
    }
    start + offset
}

/// Angular frequency ω = (βL)² √(EI/(ρA L⁴)) of bending mode `mode` = 1, 2, … [rad/s]; EI [N·m²],
/// ρA [kg/m], L \[m\], without shear and rotary inertia.
pub fn bending_frequency(mode: usize, bending_stiffness: f64, mass: f64, length: f64) -> f64 {
    (eigenvalue(mode) / length).powi(2) * (bending_stiffness / mass).sqrt()
}

/// (−1)ⁱ⁺¹: the sign of sin((i − ½)π).
pub(crate) fn alternate(mode: usize) -> f64 {
    if mode.is_multiple_of(2) { -1.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_are_those_of_the_tables_and_of_long_arithmetic() {
        // Modes 1 to 5: Blevins (8 digits); 40 and 100: computed with 250 digits.
        for (mode, expected, tolerance) in [
            (1, 1.87510407, 5e-9),
            (2, 4.69409113, 5e-9),
            (3, 7.85475744, 5e-9),
            (4, 10.99554073, 6e-9),
            (5, 14.13716839, 5e-9),
            (1, 1.8751040687119612, 1e-15),
            (2, 4.694091132974175, 2e-15),
            (40, 124.09290981679683, 3e-14),
            (100, 312.58846903218443, 6e-14),
        ] {
            let found = eigenvalue(mode);
            assert!((found - expected).abs() <= tolerance, "mode {mode}: {found} for {expected}");
        }
        assert!((eigenvalue(1000) - 999.5 * PI).abs() < 1e-12);
    }

    #[test]
    fn first_frequencies_are_the_tabulated_multiples() {
        assert!((bending_frequency(1, 2.0, 8.0, 1.0) / 0.5 - 3.516015).abs() < 1e-6);
    }
}
