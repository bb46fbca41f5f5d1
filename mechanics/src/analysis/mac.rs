//! How much two modes at neighbouring speeds are alike.
//!
//! Without gyroscopic forces it is the modal assurance |xᴴ M y|² of vectors of modal mass 1. With them shapes alone do not tell modes
//! apart: about a shaft that rotates faster than its critical speed two whirls have one shape in the rotating frame. The solutions of
//! (λ² M + λ G + K) x = 0 with λ = iω, G skew and M, K symmetric are orthogonal in
//!
//! ```text
//! xᴴ ((ω_x + ω_y) M − i G) y = 0,   ω_x ≠ ω_y,     n_x = xᴴ (2 ω_x M − i G) x
//! ```
//!
//! and |xᴴ ((ω_x + ω_y) M − i G) y|² / |n_x n_y| takes the place of the assurance: to the differences of M, G and K of the two speeds
//! it is 1 or 0. Since (−ω, ȳ) is the same motion as (ω, y), the larger of the two counts: a whirl whose frequency passes through zero
//! goes on. Where n vanishes, at the onset of flutter and of motions that do not vibrate, the shapes decide.
//!
//! Source: L. Meirovitch, *AIAA Journal* 12 (1974) 1337–1342, doi:10.2514/3.49486 (modes of gyroscopic systems).

use super::modes::Mode;
use super::solved::Solved;
use crate::linalg::Matrix;
use crate::linalg::eigen::Sparse;
use num_complex::Complex64;

/// Size of n over that of its terms, below which it counts as zero.
const VANISHING: f64 = 1e-3;
/// Size of 2ω + Σ |x_k (G x)_k| over twice the highest frequency, below which it is rounding: that of a motion without stiffness which G does not see.
const ROUNDING: f64 = 1e-9;

/// xᴴ y
pub(super) fn product(x: &[Complex64], y: &[Complex64]) -> Complex64 {
    x.iter().zip(y).map(|(x, y)| x.conj() * y).sum()
}

/// xᵀ y
fn plain(x: &[Complex64], y: &[Complex64]) -> Complex64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

/// The modal assurance |xᴴ M y|² of two vectors of modal mass 1, from x and M y.
pub(super) fn assurance(x: &[Complex64], my: &[Complex64]) -> f64 {
    product(x, my).norm_sqr()
}

/// G z for each vector, with the skew part G of the damping; nothing where there is none.
pub(super) fn gyroscopic<'a>(
    damping: &Matrix,
    vectors: impl Iterator<Item = &'a [Complex64]>,
) -> Vec<Vec<Complex64>> {
    let of = Sparse::of(&damping.skew());
    if of.is_zero() { Vec::new() } else { vectors.map(|z| of.times(z)).collect() }
}

/// n of mode `i`, unless it vanishes.
pub(super) fn norm(of: &Solved, i: usize) -> Option<f64> {
    let (mode, gx) = (&of.modes[i], of.gyroscopic.get(i)?);
    let twice = 2.0 * mode.frequency();
    let gyroscopic = product(&mode.vector, gx).im;
    let n = twice + gyroscopic;
    let highest = of.modes.iter().map(Mode::frequency).fold(0.0, f64::max);
    let terms: f64 = mode.vector.iter().zip(gx).map(|(x, gx)| x.norm() * gx.norm()).sum();
    let is_seen = twice + terms > ROUNDING * 2.0 * highest;
    (is_seen && n.abs() > VANISHING * (twice + gyroscopic.abs())).then_some(n)
}

/// xᴴ ((ω_x + ω_y) M − i G) y of mode `i` at one speed and mode `j` at another, and the same of (−ω_x, x̄); with M and G of the mean of both
/// speeds, where they are known at both.
pub(super) fn forms(from: &Solved, i: usize, to: &Solved, j: usize) -> [Complex64; 2] {
    let (x, y) = (&from.modes[i], &to.modes[j]);
    let (gx, gy) = (&from.gyroscopic[i], &to.gyroscopic[j]);
    let half = Complex64::new(0.0, 0.5);
    // Gᵀ = −G.
    let same = product(&x.vector, &to.massed[j]) * (x.frequency() + y.frequency())
        - half * (product(&x.vector, gy) - product(gx, &y.vector));
    let conjugate = plain(&x.vector, &to.massed[j]) * (y.frequency() - x.frequency())
        - half * (plain(&x.vector, gy) - plain(gx, &y.vector));
    [same, conjugate]
}

/// Whether the mode `i` goes on as the mode `j` with −ω: its frequency passes through zero in between.
pub(super) fn passes_zero(from: &Solved, i: usize, to: &Solved, j: usize) -> bool {
    if norm(from, i).is_none() || norm(to, j).is_none() {
        return false;
    }
    let [same, conjugate] = forms(from, i, to, j);
    conjugate.norm_sqr() > same.norm_sqr()
}

/// Likeness of mode `i` at one speed and mode `j` at another, from 0 to 1.
pub(super) fn mac(from: &Solved, i: usize, to: &Solved, j: usize) -> f64 {
    let (Some(n), Some(m)) = (norm(from, i), norm(to, j)) else {
        return assurance(&from.modes[i].vector, &to.massed[j]);
    };
    let [same, conjugate] = forms(from, i, to, j);
    (same.norm_sqr().max(conjugate.norm_sqr()) / (n * m).abs()).min(1.0)
}
