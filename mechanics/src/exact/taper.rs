//! Clamped–free beams that taper linearly to the tip.
//!
//! With r = h(x)/h(0), from 1 at the root to the taper ratio τ at the tip, and n = 1 for a wedge (constant
//! width, linear height) or n = 2 for a cone or pyramid (every dimension linear),
//!
//! ```text
//! ρA = ρA₀ rⁿ,   EI = EI₀ rⁿ⁺²,   (rⁿ⁺² w″)″ = k⁴ rⁿ w,   k⁴ = ρA₀ ω² L⁴/(EI₀ (1 − τ)⁴)      (′ = d/dr)
//! w = r^{−n/2} [c₁ Jₙ(z) + c₂ Yₙ(z) + c₃ Iₙ(z) + c₄ Kₙ(z)],   z = 2k√r
//! ```
//!
//! w = w′ = 0 at r = 1 and w″ = (rⁿ⁺² w″)′ = 0 at r = τ give the frequencies as zeros of
//!
//! ```text
//! |  Jₙ    Yₙ    Iₙ    Kₙ   |  at z(1)
//! | −Jₙ₊₁ −Yₙ₊₁  Iₙ₊₁ −Kₙ₊₁ |  at z(1)
//! |  Jₙ₊₂  Yₙ₊₂  Iₙ₊₂  Kₙ₊₂ |  at z(τ)
//! |  Jₙ₊₁  Yₙ₊₁  Iₙ₊₁ −Kₙ₊₁ |  at z(τ)
//! ```
//!
//! Sources: G. Kirchhoff, *Monatsber. Königl. Preuss. Akad. Wiss. Berlin* (1879) 815–828; H. H. Mabie & C. B.
//! Rogers, *J. Acoust. Soc. Am.* 36 (1964) 463–469 (wedge) and 51 (1972) 1771–1774 (double taper).

use super::bessel::Bessel;

/// What tapers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Taper {
    /// The height only: ρA ∝ r, EI ∝ r³.
    Wedge,
    /// Every dimension: ρA ∝ r², EI ∝ r⁴.
    Cone,
}

impl Taper {
    /// n.
    fn exponent(self) -> usize {
        match self {
            Taper::Wedge => 1,
            Taper::Cone => 2,
        }
    }
}

/// Angular frequency ω of bending mode `mode` = 1, 2, … [rad/s]: EI₀ [N·m²] and ρA₀ [kg/m] at the root, L
/// \[m\], taper ratio 0 < τ < 1; without shear and rotary inertia. `None` for τ outside (0, 1), or so near its ends
/// that the Bessel functions overflow; `mode` = 0 is taken as 1. Accurate to about 1e-10 for the first ten modes and τ from 0.01 to 0.95.
pub fn bending_frequency(
    taper: Taper,
    ratio: f64,
    mode: usize,
    bending_stiffness: f64,
    mass: f64,
    length: f64,
) -> Option<f64> {
    if !(ratio > 0.0 && ratio < 1.0) {
        return None;
    }
    // The phase z(1) − z(τ) is βL of the uniform beam in the limit; neighbouring zeros are about π apart.
    let rate = 2.0 * (1.0 - ratio.sqrt());
    let at = |phase: f64| determinant(taper.exponent(), phase / rate, ratio);
    let (step, mut start) = (0.1, 0.3);
    let mut value = at(start);
    let mut found = 0;
    // Zeros stand less than 4 apart, so this many steps suffice unless a value is not finite.
    for _ in 0..40 * (mode.max(1) + 1) {
        let (end, next) = (start + step, at(start + step));
        if value * next <= 0.0 {
            found += 1;
            if found >= mode.max(1) {
                let k = bisect(start, end, value, at) / rate;
                let square = k * k * (1.0 - ratio) * (1.0 - ratio) / (length * length);
                return Some(square * (bending_stiffness / mass).sqrt());
            }
        }
        (start, value) = (end, next);
    }
    None
}

/// Deflection \[m\] of the tip under a tip load P \[N\]: EI₀ [N·m²] at the root, L \[m\], taper ratio 0 < τ ≤ 1.
///
/// ```text
/// wedge  P L³/EI₀ (−ln τ − d − d²/2)/d³ = P L³/EI₀ Σ dᵏ/(k + 3),   d = 1 − τ
/// cone   P L³/(3 EI₀ τ)
/// ```
pub fn tip_deflection(taper: Taper, ratio: f64, load: f64, bending_stiffness: f64, length: f64) -> f64 {
    let unit = load * length.powi(3) / bending_stiffness;
    let d = 1.0 - ratio;
    unit * match taper {
        Taper::Cone => 1.0 / (3.0 * ratio),
        // The closed form cancels for small d.
        Taper::Wedge if d < 0.1 => (0..16).map(|k| d.powi(k) / (k as f64 + 3.0)).sum::<f64>(),
        Taper::Wedge => (-libm::log(ratio) - d - 0.5 * d * d) / d.powi(3),
    }
}

/// The characteristic determinant, its columns scaled by e^{∓z} so that nothing overflows.
fn determinant(n: usize, k: f64, ratio: f64) -> f64 {
    let (root, tip) = (2.0 * k, 2.0 * k * ratio.sqrt());
    let (a, b) = (Bessel::at(root), Bessel::at(tip));
    let decay = libm::exp(tip - root);
    let (m, o) = (n + 1, n + 2);
    let rows = [
        [a.j[n], a.y[n], a.i[n], decay * a.k[n]],
        [-a.j[m], -a.y[m], a.i[m], -decay * a.k[m]],
        [b.j[o], b.y[o], decay * b.i[o], b.k[o]],
        [b.j[m], b.y[m], decay * b.i[m], -b.k[m]],
    ];
    // Laplace expansion by pairs of columns.
    let upper = |i: usize, j: usize| rows[0][i] * rows[1][j] - rows[0][j] * rows[1][i];
    let lower = |i: usize, j: usize| rows[2][i] * rows[3][j] - rows[2][j] * rows[3][i];
    upper(0, 1) * lower(2, 3) - upper(0, 2) * lower(1, 3)
        + upper(0, 3) * lower(1, 2)
        + upper(1, 2) * lower(0, 3)
        - upper(1, 3) * lower(0, 2)
        + upper(2, 3) * lower(0, 1)
}

/// The zero between `a` and `b`, where f(a) = `value` has the other sign than f(b).
fn bisect(mut a: f64, mut b: f64, value: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (a + b);
        if (f(middle) > 0.0) == (value > 0.0) {
            a = middle;
        } else {
            b = middle;
        }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_tapered_beams_have_the_published_frequencies() {
        // Taper 0.5, as tabulated in the literature on rotating tapered beams.
        for (taper, published) in
            [(Taper::Wedge, [3.8238, 18.3173, 47.2648]), (Taper::Cone, [4.6252, 19.5476, 48.5789])]
        {
            for (i, published) in published.into_iter().enumerate() {
                let found = bending_frequency(taper, 0.5, i + 1, 4.0, 1.0, 2.0).unwrap() * 2.0;
                assert!((found - published).abs() < 6e-5, "{taper:?} {}: {found} for {published}", i + 1);
            }
        }
    }

    #[test]
    fn sharp_tips_reach_kirchhoffs_frequencies_and_blunt_ones_the_uniform_beam() {
        for (taper, sharp) in [(Taper::Wedge, 5.315), (Taper::Cone, 8.719)] {
            let found = bending_frequency(taper, 1e-5, 1, 1.0, 1.0, 1.0).unwrap();
            assert!((found - sharp).abs() < 1e-3, "{taper:?}: {found}");
            let blunt = |ratio| bending_frequency(taper, ratio, 2, 1.0, 1.0, 1.0).unwrap();
            let uniform = super::super::cantilever::bending_frequency(2, 1.0, 1.0, 1.0);
            let (far, near) = (blunt(0.90) - uniform, blunt(0.95) - uniform);
            // Linear in 1 − τ to first order.
            assert!((far / near - 2.0).abs() < 0.1, "{taper:?}: {far} {near}");
        }
    }

    #[test]
    fn deflections_tend_to_that_of_the_uniform_beam_and_both_forms_agree() {
        for taper in [Taper::Wedge, Taper::Cone] {
            assert!((tip_deflection(taper, 1.0, 3.0, 2.0, 2.0) - 4.0).abs() < 1e-15);
        }
        let (d, unit) = (0.1_f64, 8.0 / 2.0);
        let series: f64 = (0..20).map(|k| d.powi(k) / (k as f64 + 3.0)).sum();
        assert!((tip_deflection(Taper::Wedge, 0.9, 1.0, 2.0, 2.0) / (unit * series) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_ratio_that_is_no_taper_has_no_frequency() {
        for ratio in [0.0, 1.0, -0.5, f64::NAN] {
            assert_eq!(bending_frequency(Taper::Wedge, ratio, 1, 1.0, 1.0, 1.0), None);
        }
    }
}
