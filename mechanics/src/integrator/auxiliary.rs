//! The auxiliary acceleration of the α methods.
//!
//! ```text
//! (1 − αm) aₙ₊₁ + αm aₙ = (1 − αf) q̈ₙ₊₁ + αf q̈ₙ
//! d = h vₙ + h² ((½ − β) aₙ + β aₙ₊₁),   vₙ₊₁ = vₙ + h ((1 − γ) aₙ + γ aₙ₊₁)
//! ```
//!
//! a is the acceleration at another time than q̈, aₙ ≈ q̈(tₙ + Δh) with Δ = αm − αf: where the step changes from h₀ to h, aₙ is
//! replaced by q̈ₙ + (aₙ − q̈ₙ) h/h₀. Dampers act in vₙ₊₁ − vₙ by the velocity (1 − γ) wₙ + γ wₙ₊₁, with w to v as a to q̈: the balance of energy needs it, the step does not. With κ = (1 − αf)/(1 − αm) an increment Δq̈ₙ₊₁ moves v by hγκ Δq̈ and q by h²βκ Δq̈.

use super::{Checkpoint, NotResumed};

/// αm, αf, β, γ.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters {
    pub(super) alpha_m: f64,
    pub(super) alpha_f: f64,
    pub(super) beta: f64,
    pub(super) gamma: f64,
}

impl Parameters {
    /// κ.
    pub(super) fn kappa(&self) -> f64 {
        (1.0 - self.alpha_f) / (1.0 - self.alpha_m)
    }

    /// hγκ and h²βκ: what an increment of q̈ moves v and q by.
    pub(super) fn weights(&self, h: f64) -> [f64; 2] {
        [h * self.gamma * self.kappa(), h * h * self.beta * self.kappa()]
    }
}

/// The auxiliary acceleration aₙ, and the sizes of the steps accepted last and attempted.
#[derive(Debug)]
pub(super) struct Auxiliary {
    pub(super) parameters: Parameters,
    pub(super) a: Vec<f64>,
    steps: [f64; 2],
    /// wₙ, vₙ as the forces of the smooth motion see it, and the velocity by which dampers act in the accepted step.
    w: Vec<f64>,
    v: Vec<f64>,
    pub(super) damped: Vec<f64>,
}

impl Auxiliary {
    pub(super) fn new(parameters: Parameters, n: usize) -> Auxiliary {
        let zeros = || vec![0.0; n];
        Auxiliary { parameters, a: zeros(), steps: [0.0; 2], w: zeros(), v: zeros(), damped: zeros() }
    }

    /// The formulas of an attempt of size `h`.
    pub(super) fn attempt(&mut self, h: f64) -> Formulas {
        self.steps[1] = h;
        self.formulas()
    }

    fn formulas(&self) -> Formulas {
        let Parameters { alpha_m, alpha_f, beta, gamma } = self.parameters;
        let [last, h] = self.steps;
        Formulas {
            ratio: if last > 0.0 { h / last } else { 1.0 },
            kappa: self.parameters.kappa(),
            of_a: alpha_m / (1.0 - alpha_m),
            of_start: alpha_f / (1.0 - alpha_m),
            h,
            v: [h * (1.0 - gamma), h * gamma],
            d: [h * h * (0.5 - beta), h * h * beta],
        }
    }

    /// Accepts the attempt with q̈ₙ and q̈ₙ₊₁, whose forces see the velocity `v`.
    pub(super) fn accept(&mut self, start: &[f64], end: &[f64], v: &[f64]) {
        let formulas = self.formulas();
        for ((a, start), end) in self.a.iter_mut().zip(start).zip(end) {
            *a = formulas.next(formulas.lagging(*a, *start), *start, *end);
        }
        let gamma = self.parameters.gamma;
        for (i, end) in v.iter().enumerate() {
            let (start, w) = (self.v[i], formulas.lagging(self.w[i], self.v[i]));
            self.w[i] = formulas.next(w, start, *end);
            self.damped[i] = (1.0 - gamma) * w + gamma * self.w[i];
            self.v[i] = *end;
        }
        self.steps[0] = self.steps[1];
    }

    /// Begins anew with the accelerations `a` and velocities `v`.
    pub(super) fn restart(&mut self, a: &[f64], v: &[f64]) {
        self.a.copy_from_slice(a);
        [&mut self.w, &mut self.v, &mut self.damped].into_iter().for_each(|list| list.copy_from_slice(v));
        self.steps = [0.0; 2];
    }

    pub(super) fn save(&self, out: &mut Checkpoint) {
        out.put("auxiliary", &self.a);
        out.put("auxiliary.step", &self.steps[..1]);
        out.put("auxiliary.w", &self.w);
        out.put("auxiliary.v", &self.v);
    }

    pub(super) fn resume(&mut self, from: &Checkpoint) -> Result<(), NotResumed> {
        from.fill("auxiliary", &mut self.a)?;
        from.fill("auxiliary.step", &mut self.steps[..1])?;
        from.fill("auxiliary.w", &mut self.w)?;
        from.fill("auxiliary.v", &mut self.v)
    }
}

/// The formulas of one step, for one unknown after the other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Formulas {
    /// Size of the step over that of the last one.
    ratio: f64,
    kappa: f64,
    of_a: f64,
    of_start: f64,
    h: f64,
    /// Weights of aₙ and aₙ₊₁ in v and d.
    v: [f64; 2],
    d: [f64; 2],
}

impl Formulas {
    /// vₙ₊₁ and d, from aₙ of the last step, vₙ, q̈ₙ and q̈ₙ₊₁.
    #[inline(always)]
    pub(super) fn motion(&self, a: f64, v: f64, start: f64, end: f64) -> [f64; 2] {
        let a = self.lagging(a, start);
        let next = self.next(a, start, end);
        [v + self.v[0] * a + self.v[1] * next, self.h * v + self.d[0] * a + self.d[1] * next]
    }

    #[inline(always)]
    fn next(&self, a: f64, start: f64, end: f64) -> f64 {
        self.kappa * end + self.of_start * start - self.of_a * a
    }

    /// aₙ for this size of the step: its lag behind q̈ₙ is a part of the step.
    #[inline(always)]
    fn lagging(&self, a: f64, start: f64) -> f64 {
        if self.ratio == 1.0 { a } else { start + self.ratio * (a - start) }
    }
}
