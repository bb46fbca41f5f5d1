//! The second variation of the strain energy of an element, strain by strain.
//!
//! With the second derivatives H of the energy per length by e = (u′, v′, w′, u″, v″, w″, φ, φ′) and the axial strain
//! sampled at three points likewise,
//!
//! ```text
//! xᵀ (∂²U/∂q²) x = Σ weight · Σ_vw H_vw e_v e_w
//! ```
//!
//! where e are the strains of x. The product with the assembled matrix loses n⁴ε of n elements, this sum n²ε.

use super::element::{Functions, exact_energy};
use super::mesh::{Element, LOCAL};
use super::model::{Model, Terms};

/// Σ h(i, j) eᵢ eⱼ
pub fn form<const N: usize>(e: &[f64; N], h: impl Fn(usize, usize) -> f64) -> f64 {
    (0..N).map(|i| e[i] * (0..N).map(|j| h(i, j) * e[j]).sum::<f64>()).sum()
}

/// (u′, v′, w′, u″, v″, w″, φ, φ′) of the unknowns of an element.
fn strains(f: &Functions, x: &[f64; LOCAL]) -> [f64; 8] {
    let ([u, v, w], [u2, v2, w2]) = (f.field(x, 1), f.field(x, 2));
    [u, v, w, u2, v2, w2, f.torsion(x, 0), f.torsion(x, 1)]
}

impl Element {
    /// Adds the form of the exact strain energy at the unknowns `q` for each of the vectors.
    pub fn exact_forms(
        &self,
        q: &[f64; LOCAL],
        pitch: f64,
        model: &Model,
        vectors: &[[f64; LOCAL]],
        out: &mut [f64],
    ) {
        for point in &self.points {
            let f = Functions::of(point);
            let h = exact_energy(&f, pitch, &point.section, model, q).h;
            for (x, out) in vectors.iter().zip(&mut *out) {
                *out += point.weight * form(&strains(&f, x), |v, w| h[v][w]);
            }
        }
        let samples = self.samples(q);
        for (x, out) in vectors.iter().zip(out) {
            let mut strains = [0.0; 3];
            for (a, (_, stretch, t, n)) in samples.iter().enumerate() {
                let slopes: [f64; 3] = std::array::from_fn(|f| (0..4).map(|k| n[k] * x[4 * f + k]).sum());
                let tension: f64 = (0..3).map(|b| self.axial[a][b] * samples[b].0).sum();
                strains[a] = (0..3).map(|f| t[f] * slopes[f]).sum();
                let across: f64 = (0..3).map(|f| (slopes[f] - t[f] * strains[a]).powi(2)).sum();
                *out += tension * across / stretch;
            }
            *out += form(&strains, |a, b| self.axial[a][b]);
        }
    }

    /// Adds the form of the strain energy of the straight blade; arguments as of
    /// [`straight_energies`](Element::straight_energies).
    #[allow(clippy::too_many_arguments)]
    pub fn straight_forms(
        &self,
        pitch: f64,
        square: f64,
        tension: &[(f64, f64)],
        terms: Terms,
        model: &Model,
        vectors: &[[f64; LOCAL]],
        out: &mut [f64],
    ) {
        for (point, energy) in self.straight_energies(pitch, square, tension, terms, model) {
            let f = Functions::of(point);
            for (x, out) in vectors.iter().zip(&mut *out) {
                *out += point.weight * form(&strains(&f, x), |v, w| energy.h[v][w]);
            }
        }
    }
}
