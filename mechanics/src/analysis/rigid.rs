//! How rigid motions, which have no stiffness, are told from others.

use crate::linalg::Matrix;
use crate::linalg::eigen::{EigenError, Pencil, UNCERTAIN};

/// A rigid motion has |λ| below this part of the lowest frequency of the held system.
pub(super) const RIGID: f64 = 1e-4;
/// Shift, over a frequency that bounds all, with which rigid motions are told from others.
const SHIFT: f64 = 1e-3;
/// Shift, over the lowest frequency that is not of a rigid motion, from which the modes are seen where there are such motions.
pub(super) const BELOW: f64 = 0.3;
/// Rigid motions of a body.
pub(super) const RIGID_MOTIONS: usize = 6;

/// Lowest frequency that is not of a rigid motion, of a system whose rigid motions nothing holds, seen from a shift far above
/// rounding and below most frequencies.
pub(super) fn elastic_frequency(
    all: &[Matrix; 3],
    multipliers: usize,
    count: usize,
) -> Result<f64, EigenError> {
    let largest = |k: usize| {
        let n = all[k].order() - multipliers;
        (0..n).map(|i| all[k].get(i, i).abs()).fold(0.0, f64::max)
    };
    let top = (largest(2) / largest(0)).sqrt();
    if !(top > 0.0) {
        return Ok(1.0);
    }
    let there = all[0].order() - 2 * multipliers;
    let mut pencil = Pencil::new(all.clone(), multipliers, SHIFT * top)?;
    let found = pencil.pairs((count + RIGID_MOTIONS).min(there), &[])?;
    let last = found.iter().map(|pair| pair.value.norm()).fold(0.0, f64::max);
    let elastic = found.iter().filter(|pair| pencil.rounding(pair.value, &pair.vector) < UNCERTAIN);
    Ok(elastic.map(|pair| pair.value.norm()).filter(|size| *size > RIGID * last).fold(last, f64::min))
}
