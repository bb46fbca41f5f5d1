//! Steps of changing size: the prediction, and the estimate of the local error.
//!
//! The auxiliary acceleration is the true one at another time, aₙ ≈ q̈(tₙ + Δh) with Δ = αm − αf: where the step changes from h₀
//! to h, aₙ is replaced by q̈ₙ + (aₙ − q̈ₙ) h/h₀. By Taylor's series the local error of the position is
//!
//! ```text
//! e = h² (β + ½Δ − 1/6) (aₙ₊₁ − aₙ)
//! ```
//!
//! Sources: Zienkiewicz & Xie (1991, doi 10.1002/eqe.4290200907) for Newmark's method, Δ = 0; Hulbert & Jang (1995,
//! doi 10.1016/0045-7825(95)00746-T).

use super::GeneralizedAlpha;
use crate::integrator::Tolerance;
use crate::system::{Dynamics, State};

impl GeneralizedAlpha {
    /// The same method with an estimate of its local error, by which a run controls its steps. Constraints take the
    /// stabilized form: with index 3 a rounding error ε of g is one of ε/h in v, and a shorter step has the larger error.
    pub fn adaptive(mut self, tolerance: Tolerance) -> GeneralizedAlpha {
        self.info.estimate_order = Some(2);
        GeneralizedAlpha { tolerance: Some(tolerance), stabilized: true, ..self }
    }

    /// Whether a second multiplier stabilizes the rows.
    pub(in crate::integrator) fn stabilize(&mut self, stabilized: bool) {
        self.stabilized = stabilized;
    }

    /// The step `h` over the last one, or 1.
    fn ratio(&self, h: f64) -> f64 {
        if self.spacing[0] > 0.0 { h / self.spacing[0] } else { 1.0 }
    }

    /// aₙ₊₁ of a step `h`, by aₙ, q̈ₙ and q̈ₙ₊₁.
    pub(super) fn auxiliary(&self, h: f64) -> impl Fn(f64, f64, f64) -> f64 + use<> {
        let (ratio, kappa) = (self.ratio(h), self.kappa());
        let (of_a, of_from) = (self.alpha_m / (1.0 - self.alpha_m), self.alpha_f / (1.0 - self.alpha_m));
        move |a, from, to| kappa * to + of_from * from - of_a * lagging(ratio, a, from)
    }

    /// The estimated local error of the attempt over the tolerance.
    pub(super) fn estimate(&self, scales: &[f64], (from, to): (&State, &State), h: f64) -> Option<f64> {
        let tolerance = self.tolerance?;
        let part = h * h * (self.beta + 0.5 * (self.alpha_m - self.alpha_f) - 1.0 / 6.0).abs();
        let n = from.v.len();
        let (ratio, next) = (self.ratio(h), self.auxiliary(h));
        // Where q has more entries than v they do not correspond, and the scale alone counts.
        let relative = if from.q.len() == n { tolerance.relative } else { 0.0 };
        let mut square = 0.0;
        for i in 0..n {
            let size = relative * from.q[i].abs();
            let change = next(self.a[i], from.a[i], to.a[i]) - lagging(ratio, self.a[i], from.a[i]);
            square += (part * change / (tolerance.absolute * scales[i] + size)).powi(2);
        }
        Some((square / n.max(1) as f64).sqrt())
    }

    /// Starting values of the step: the accelerations of the last three steps, continued.
    pub(super) fn predict(&mut self, system: &dyn Dynamics, from: &State, h: f64, to: &mut State) {
        let n = from.v.len();
        let (beta, gamma, ratio, next) = (self.beta, self.gamma, self.ratio(h), self.auxiliary(h));
        let (v_old, v_new) = (h * (1.0 - gamma), h * gamma);
        let (d_old, d_new) = (h * h * (0.5 - beta), h * h * beta);
        let (from_a, from_v) = (&from.a[..n], &from.v[..n]);
        // The trend: of the last step at first, then of the one before it.
        let (later, sooner) = match self.history {
            0 => (from_a, from_a),
            1 => (from_a, &self.before[..n]),
            _ => (&self.before[..n], &self.earlier[..n]),
        };
        self.spacing[1] = h;
        let (a, d) = (&self.a[..n], &mut self.d[..n]);
        let (out_a, out_v) = (&mut to.a[..n], &mut to.v[..n]);
        for i in 0..n {
            out_a[i] = from_a[i] + (later[i] - sooner[i]);
            let next = next(a[i], from_a[i], out_a[i]);
            let a = lagging(ratio, a[i], from_a[i]);
            out_v[i] = from_v[i] + v_old * a + v_new * next;
            d[i] = h * from_v[i] + d_old * a + d_new * next;
        }
        to.lambda.copy_from_slice(&from.lambda);
        to.copy_modes(from);
        system.retract(&from.q, d, &mut to.q);
    }
}

/// aₙ behind q̈ₙ for a step of another size: the lag is a part of the step.
#[inline(always)]
fn lagging(ratio: f64, a: f64, exact: f64) -> f64 {
    if ratio == 1.0 { a } else { exact + ratio * (a - exact) }
}
