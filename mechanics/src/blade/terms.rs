//! The stiffness of the strain energy as a sum of terms w b bᵀ.
//!
//! The second derivatives H of the energy per length by the eight numbers (u′, v′, w′, u″, v″, w″, φ, φ′), whose rows
//! of functions are b_v, give
//!
//! ```text
//! K = Σ H_vv b_v b_vᵀ + Σ_{v<w} ½H_vw [(b_v + b_w)(b_v + b_w)ᵀ − (b_v − b_w)(b_v − b_w)ᵀ]
//! ```
//!
//! and the axial strain, sampled at three places, likewise. An entry of K in doubles has lost the lowest
//! frequencies of n elements by n⁴ε; H and b have not.

use super::element::{Functions, exact_energy};
use super::mesh::{CLAMPED, Element, LOCAL, SAMPLES, hermite, quadratic};
use super::model::{Model, Terms};
use crate::system::VisitTerm;

/// Functions of the element's unknowns.
type Row = [f64; LOCAL];

/// The rows of (u′, v′, w′, u″, v″, w″, φ, φ′).
fn rows(f: &Functions) -> [Row; 8] {
    let mut out = [[0.0; LOCAL]; 8];
    for field in 0..3 {
        for k in 0..4 {
            out[field][4 * field + k] = f.n[1][k];
            out[3 + field][4 * field + k] = f.n[2][k];
        }
    }
    for k in 0..3 {
        out[6][12 + k] = f.m[0][k];
        out[7][12 + k] = f.m[1][k];
    }
    out
}

impl Element {
    /// One term, of the unknowns that exist.
    fn visit(&self, row: &Row, weight: f64, visit: &mut VisitTerm<'_>) {
        let (mut index, mut b, mut count) = ([0; LOCAL], [0.0; LOCAL], 0);
        for (&unknown, &value) in self.unknowns.iter().zip(row) {
            if unknown != CLAMPED && value != 0.0 {
                (index[count], b[count]) = (unknown, value);
                count += 1;
            }
        }
        if weight != 0.0 && count > 0 {
            visit(&index[..count], &b[..count], weight);
        }
    }

    /// weight · Σ `form`_vw b_v b_wᵀ of a symmetric form.
    fn visit_form<const N: usize>(
        &self,
        rows: &[Row; N],
        form: impl Fn(usize, usize) -> f64,
        weight: f64,
        visit: &mut VisitTerm<'_>,
    ) {
        for v in 0..N {
            self.visit(&rows[v], weight * form(v, v), visit);
            for w in v + 1..N {
                let half = 0.5 * weight * form(v, w);
                if half != 0.0 {
                    for sign in [1.0, -1.0] {
                        let both = std::array::from_fn(|k| rows[v][k] + sign * rows[w][k]);
                        self.visit(&both, sign * half, visit);
                    }
                }
            }
        }
    }

    /// The terms of the exact strain energy at the unknowns `q`.
    pub fn visit_exact(&self, q: &[f64; LOCAL], pitch: f64, model: &Model, visit: &mut VisitTerm<'_>) {
        for point in &self.points {
            let f = Functions::of(point);
            let h = exact_energy(&f, pitch, &point.section, model, q).h;
            self.visit_form(&rows(&f), |v, w| h[v][w], point.weight, visit);
        }
        let samples = self.samples(q);
        let h = self.ends[1] - self.ends[0];
        let mut gradients = [[0.0; LOCAL]; 3];
        for (gradient, (_, _, t, n)) in gradients.iter_mut().zip(&samples) {
            for (i, entry) in gradient.iter_mut().take(12).enumerate() {
                *entry = t[i / 4] * n[i % 4];
            }
        }
        self.visit_form(&gradients, |a, b| self.axial[a][b], 1.0, visit);
        for (a, (s, (_, stretch, t, _))) in SAMPLES.into_iter().zip(&samples).enumerate() {
            let tension: f64 = (0..3).map(|b| self.axial[a][b] * samples[b].0).sum();
            let [x, y, z, ..] = rows(&Functions { n: hermite(s, h), m: quadratic(s, h) });
            let across = |f: usize, g: usize| (f64::from(f == g) - t[f] * t[g]) / stretch;
            self.visit_form(&[x, y, z], across, tension, visit);
        }
    }

    /// The terms of the strain energy of the straight blade; arguments as of
    /// [`straight_energies`](Element::straight_energies).
    pub fn visit_straight(
        &self,
        pitch: f64,
        square: f64,
        tension: &[(f64, f64)],
        terms: Terms,
        model: &Model,
        visit: &mut VisitTerm<'_>,
    ) {
        for (point, energy) in self.straight_energies(pitch, square, tension, terms, model) {
            let form = |v: usize, w: usize| energy.h[v][w];
            self.visit_form(&rows(&Functions::of(point)), form, point.weight, visit);
        }
    }
}
