//! The quadratic strain energy term by term: elastic forces of fine meshes without their rounding errors.
//!
//! With one strain eₖ = bₖᵀq, stretch or curvature at a quadrature point, a term,
//!
//! ```text
//! U = ½ Σ wₖ eₖ²,   K q = Σ wₖ bₖ (bₖᵀ q)
//! ```
//!
//! The product of the assembled K with q loses, of n bending elements, some 8n³ units of the last digit: the entries
//! of K grow like n³, and only their cancellation over several rows leaves the stiffness of the beam. At 640 elements
//! that is 1e-6 of the deflection, at 2560 it is 1e-4. Here the rounding error of a strain makes forces that are in
//! balance, as those of any strain are, and stays what it is.

use crate::system::VisitTerm;
use std::ops::Range;

/// Cells beyond which the elastic forces are summed term by term: with fewer, rounding errors stay below 1e-8.
pub(super) const FINE: usize = 150;

/// The terms of a strain energy. See the [module documentation](self).
#[derive(Debug, Default)]
pub(super) struct StrainTerms {
    /// Unknowns and entries of all the b.
    entries: Vec<(usize, f64)>,
    terms: Vec<Term>,
}

/// One term: its b among the entries, and w.
#[derive(Debug)]
struct Term {
    entries: Range<usize>,
    weight: f64,
}

impl StrainTerms {
    /// Takes the terms that `tell` tells.
    pub(super) fn new(tell: impl FnOnce(&mut VisitTerm<'_>)) -> StrainTerms {
        let mut out = StrainTerms::default();
        tell(&mut |index: &[usize], b: &[f64], weight: f64| {
            let first = out.entries.len();
            out.entries.extend(index.iter().copied().zip(b.iter().copied()));
            out.terms.push(Term { entries: first..out.entries.len(), weight });
        });
        out
    }

    /// Adds K (q + η v) to `r`.
    pub(super) fn add_forces(&self, q: &[f64], v: &[f64], viscosity: f64, r: &mut [f64]) {
        for term in &self.terms {
            let b = &self.entries[term.entries.clone()];
            let strain: f64 = b.iter().map(|&(i, b)| b * (q[i] + viscosity * v[i])).sum();
            let stress = term.weight * strain;
            for &(i, b) in b {
                r[i] += b * stress;
            }
        }
    }

    /// ½ Σ w (bᵀq)² \[J\].
    pub(super) fn energy(&self, q: &[f64]) -> f64 {
        let strain =
            |term: &Term| self.entries[term.entries.clone()].iter().map(|&(i, b)| b * q[i]).sum::<f64>();
        0.5 * self.terms.iter().map(|term| term.weight * strain(term).powi(2)).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_and_energy_are_those_of_the_sum_of_squares() {
        let terms = StrainTerms::new(|visit| {
            visit(&[0, 2], &[1.0, -2.0], 3.0);
            visit(&[1, 2, 3], &[0.5, 1.0, 4.0], 2.0);
        });
        let (q, v, viscosity) = ([1.0, -2.0, 0.5, 0.25], [0.1, 0.2, -0.3, 0.4], 0.5);
        let energy = |q: &[f64]| 1.5 * (q[0] - 2.0 * q[2]).powi(2) + (0.5 * q[1] + q[2] + 4.0 * q[3]).powi(2);
        assert!((terms.energy(&q) - energy(&q)).abs() < 1e-15);
        let mut forces = [0.0; 4];
        terms.add_forces(&q, &v, viscosity, &mut forces);
        let moved: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + viscosity * v).collect();
        for i in 0..4 {
            let mut sides = [1e-5, -1e-5].map(|h| {
                let mut q = moved.clone();
                q[i] += h;
                energy(&q)
            });
            sides[0] -= sides[1];
            assert!((forces[i] - sides[0] / 2e-5).abs() < 1e-8, "{i}");
        }
    }
}
