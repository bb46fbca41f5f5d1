//! Starting values of a step.

use super::coefficients::{C, lagrange};
use super::stages::Stages;
use crate::system::{Dynamics, State};

/// What the starting values of a step are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Prediction {
    /// The velocity at the start. (Its acceleration may decay within the step, as behind a blow on a damped beam: the tangents are those of the
    /// place that it leads to.)
    Uniform,
    /// The last step, of this size.
    Extrapolated { last: f64 },
    /// The last attempt from the same start, of this size.
    Tried { last: f64 },
}

impl Stages {
    /// Starting values: the polynomial of the last attempt from here, or of the last step, or the velocity at the start.
    pub(super) fn predict(&mut self, system: &dyn Dynamics, from: &State, h: f64, start: Prediction) {
        match start {
            Prediction::Uniform => {
                for x in &mut self.a {
                    let (a, lambda) = x.split_at_mut(from.a.len());
                    a.fill(0.0);
                    lambda.copy_from_slice(&from.lambda);
                }
            }
            Prediction::Extrapolated { last } => {
                for (a, accepted) in self.a.iter_mut().zip(&self.a_accepted) {
                    a.copy_from_slice(accepted);
                }
                self.continue_polynomial(1.0, h / last);
            }
            Prediction::Tried { last } => self.continue_polynomial(0.0, h / last),
        }
        if !self.is_vector_space {
            self.start_rates(from, h);
            // Their first changes are not those of Newton's iterations.
            for i in 0..6 {
                self.set_motion(system, from, h, i % 3);
            }
        }
    }

    /// The polynomial through the stages of a step at those of one that is `steps` times as long and begins at the part `start` of it.
    fn continue_polynomial(&mut self, start: f64, steps: f64) {
        let weights = C.map(|c| lagrange(start + c * steps));
        let n = self.a[0].len();
        let [a1, a2, a3] = self.a.each_mut().map(|a| &mut a[..n]);
        for i in 0..n {
            let old = [a1[i], a2[i], a3[i]];
            [a1[i], a2[i], a3[i]] = weights.map(|l| l[0] * old[0] + l[1] * old[1] + l[2] * old[2]);
        }
    }

    /// Increments and their rates, as on a vector space at first.
    fn start_rates(&mut self, from: &State, h: f64) {
        for ((rate, increment), c) in self.rates.iter_mut().zip(&mut self.increments).zip(C) {
            for i in 0..from.v.len() {
                (rate[i], increment[i]) = (from.v[i], c * h * from.v[i]);
            }
        }
    }
}
