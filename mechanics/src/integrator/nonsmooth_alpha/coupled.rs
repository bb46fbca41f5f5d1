//! The coupled scheme: smooth motion, position and velocity at once.
//!
//! With the accelerations α of the position and ϖ of the velocity, U = ½h²α, W = hϖ, the residuals
//!
//! ```text
//! r₁ = r(tₙ₊₁, qₙ₊₁, vₙ₊₁, q̈, λ̃),   r₂ = r(…, q̈ + α, λ̃ + λ) − r₁ = Mα − Gᵀλ,   r₃ = r(…, q̈ + ϖ, λ̃ + Λ) − r₁
//! ```
//!
//! vanish together. An increment of the position, ½h²x = h²βκ Δq̈ + ½h² Δα, follows from 2βκ r₁ + r₂,
//!
//! ```text
//! S x = −2βκ r₁ − r₂ + Gᵀ Δλ,   S = M + hγκ C + h²βκ K,   M Δα = −r₂ + Gᵀ Δλ,   Δq̈ = (x − Δα)/(2βκ)
//! M Δϖ = −r₃ + Gᵀ ΔΛ
//! ```
//!
//! so that the cone problem of the position has G S⁻¹ Gᵀ and that of the velocity G M⁻¹ Gᵀ. What damping couples beyond
//! this is left to the iteration.

use super::memory::Coupled;
use super::{Level, NAME, NonsmoothAlpha, Set, Work, failure, open};
use crate::integrator::{Progress, Span, StepError, StepReport};
use crate::system::{Dynamics, RowWeights, State, Weights};

impl NonsmoothAlpha {
    /// Attempts a step of the coupled scheme.
    pub(super) fn attempt_coupled(
        &mut self,
        coupled: &mut Coupled,
        work: &mut Work,
        system: &mut dyn Dynamics,
        span: Span,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let h = span.step;
        let p = self.smooth.parameters();
        let [alpha_m, alpha_f, beta, gamma] = p;
        let kappa = (1.0 - alpha_f) / (1.0 - alpha_m);
        let (to_v, to_q, half) = (h * gamma * kappa, h * h * beta * kappa, 0.5 * h * h);
        let (n, m) = (work.alpha.len(), work.forces.len());
        let Some(mut mass) = coupled.mass.take() else { return Err(StepError::NotStarted { method: NAME }) };
        system.constraint(&work.from, RowWeights::VELOCITY, &mut work.start);
        to.copy_from(&work.from);
        (to.t, to.side) = (span.end, span.side);
        work.smooth.copy_from(to);
        work.takes_part.fill(false);
        for list in [&mut work.alpha, &mut work.forces, &mut coupled.velocity, &mut coupled.impulses] {
            list.fill(0.0);
        }
        let joints = work.rows.sets().contains(&Set::Free);
        self.convergence.begin(true);
        let result = loop {
            work.place(p, coupled, system, h, to);
            system.constraint(to, RowWeights::POSITION, &mut work.gaps);
            let new = work.admit(|work, i| work.gaps[i] <= 0.0);
            self.corrected = work.takes_part.contains(&true);
            system.residual(to, &mut coupled.residual);
            // r₂, with which the position is corrected.
            work.difference(system, to, None, &coupled.residual);
            for (i, r) in work.rhs[..n].iter_mut().enumerate() {
                coupled.rhs[i] = -*r;
                *r = -2.0 * beta * kappa * coupled.residual[i] - *r;
            }
            for i in 0..n {
                work.trial.v[i] = work.smooth.v[i] + h * work.alpha[i];
            }
            system.constraint(&work.trial, RowWeights::VELOCITY, &mut work.rates);
            for (k, set) in work.rows.sets().iter().enumerate() {
                work.rhs[n + k] = if *set == Set::Free { -work.gaps[k] / half } else { 0.0 };
            }
            let weights = Weights { a: 1.0, v: to_v, q: to_q, increment: Some(&coupled.d) };
            system.tangent(to, weights, &mut work.matrix);
            work.rows.add_border(system, to, n, &mut work.matrix);
            if let Err(cause) = work.matrix.factor() {
                break Err(failure::singular(system, work.from.t, h, cause));
            }
            work.matrix.solve(&mut work.rhs);
            work.rows.store_jacobian(system, to);
            coupled.before.copy_from_slice(&work.forces);
            if let Err(cause) = work.solve_cone(Level::Position, [h, half], None) {
                break Err(StepError::Contacts { time: work.from.t, step: h, cause });
            }
            self.counters.iterations += 1;
            self.counters.residuals += 1;
            self.counters.tangents += 1;
            self.counters.factorizations += 1;
            self.counters.solves += 1 + work.impulses.len() as u64;
            let mut square: f64 = work.rhs[..n].iter().zip(&work.scale).map(|(x, s)| (x / s).powi(2)).sum();
            let active = joints || self.corrected;
            if active {
                let increment = Some(&coupled.d[..]);
                system.tangent(to, Weights { a: 1.0, v: 0.0, q: 0.0, increment }, &mut mass);
                work.rows.add_border(system, to, n, &mut mass);
                if let Err(cause) = mass.factor() {
                    break Err(failure::singular(system, work.from.t, h, cause));
                }
                self.counters.factorizations += 1;
                // Δα with G Δα from G Δq̈ = −ġ(q, ṽ)/(hγκ).
                system.constraint(&work.smooth, RowWeights::VELOCITY, &mut work.rates);
                for k in 0..m {
                    let free = work.rows.sets()[k] == Set::Free;
                    coupled.rhs[n + k] = if free { 2.0 * beta * kappa * work.rates[k] / to_v } else { 0.0 };
                }
                for &(row, j, x) in work.rows.stored() {
                    if work.rows.sets()[row] == Set::Free {
                        coupled.rhs[n + row] += x * work.rhs[j];
                    } else {
                        coupled.rhs[j] += x * (work.forces[row] - coupled.before[row]);
                    }
                }
                mass.solve(&mut coupled.rhs);
            } else {
                coupled.rhs.fill(0.0);
            }
            for i in 0..n {
                work.alpha[i] += coupled.rhs[i];
                to.a[i] += (work.rhs[i] - coupled.rhs[i]) / (2.0 * beta * kappa);
            }
            for k in (0..m).filter(|k| work.rows.sets()[*k] == Set::Free) {
                // The multipliers of the position, and what is left for those of the smooth motion.
                work.forces[k] += coupled.rhs[n + k];
                to.lambda[k] += (work.rhs[n + k] - coupled.rhs[n + k]) / (2.0 * beta * kappa);
            }
            if active {
                work.place(p, coupled, system, h, to);
                system.residual(to, &mut coupled.residual);
                work.difference(system, to, Some((&coupled.velocity, &coupled.impulses)), &coupled.residual);
                system.constraint(to, RowWeights::VELOCITY, &mut work.rates);
                for (k, set) in work.rows.sets().iter().enumerate() {
                    work.rhs[n + k] = if *set == Set::Free { work.rates[k] / h } else { 0.0 };
                }
                work.rhs.iter_mut().for_each(|r| *r = -*r);
                mass.solve(&mut work.rhs);
                let swapped = (&mut mass, &mut coupled.impulses[..]);
                if let Err(cause) = work.solve_cone(Level::Velocity, [h, half], Some(swapped)) {
                    break Err(StepError::Contacts { time: work.from.t, step: h, cause });
                }
                self.counters.solves += 3 + work.impulses.len() as u64;
                for i in 0..n {
                    coupled.velocity[i] += work.rhs[i];
                    square += (work.rhs[i] / work.scale[i]).powi(2);
                }
                for k in (0..m).filter(|k| work.rows.sets()[*k] == Set::Free) {
                    coupled.impulses[k] += work.rhs[n + k];
                }
            }
            let size = h * h * (square / n.max(1) as f64).sqrt();
            match self.convergence.judge(size) {
                Progress::Converged if !new => break Ok(()),
                Progress::Converged | Progress::Continue => {}
                Progress::Diverged => break Err(self.not_converged(work, system, h, size)),
            }
        };
        coupled.mass = Some(mass);
        result?;
        work.place(p, coupled, system, h, to);
        // What the smooth motion remembers, and what the state shows.
        work.smooth.a.copy_from_slice(&to.a);
        work.smooth.lambda.copy_from_slice(&to.lambda);
        open(work.rows.sets(), &mut work.smooth);
        for i in 0..n {
            to.a[i] += coupled.velocity[i];
        }
        for k in 0..m {
            to.lambda[k] += coupled.impulses[k];
        }
        work.modes(&to.lambda, &mut to.mode);
        if !to.is_finite() {
            return Err(failure::not_finite(system, work.from.t, h, to));
        }
        Ok(StepReport { iterations: self.convergence.iterations(), error: None })
    }
}

impl Work {
    /// Makes position, velocities and accelerations of the attempt from the unknowns: `to` becomes the end of the step,
    /// `self.smooth` has ṽ and the same position.
    fn place(&mut self, p: [f64; 4], memory: &mut Coupled, system: &dyn Dynamics, h: f64, to: &mut State) {
        let [alpha_m, alpha_f, beta, gamma] = p;
        let ratio = if memory.spacing[0] > 0.0 { h / memory.spacing[0] } else { 1.0 };
        memory.spacing[1] = h;
        for i in 0..memory.a.len() {
            let (from, v) = (self.from.a[i], self.from.v[i]);
            // The lag of a behind q̈ is a part of the step.
            let a = if ratio == 1.0 { memory.a[i] } else { from + ratio * (memory.a[i] - from) };
            let next = ((1.0 - alpha_f) * to.a[i] + alpha_f * from - alpha_m * a) / (1.0 - alpha_m);
            memory.a_next[i] = next;
            memory.d[i] = h * v + h * h * ((0.5 - beta) * a + beta * next) + 0.5 * h * h * self.alpha[i];
            self.smooth.v[i] = v + h * ((1.0 - gamma) * a + gamma * next);
            to.v[i] = self.smooth.v[i] + h * memory.velocity[i];
        }
        system.retract(&self.from.q, &memory.d, &mut to.q);
        self.smooth.q.copy_from_slice(&to.q);
    }

    /// `rhs` = r(…, q̈ + x, λ̃ + f) − r₁ with x and f of the position, or those given.
    fn difference(
        &mut self,
        system: &mut dyn Dynamics,
        to: &State,
        other: Option<(&[f64], &[f64])>,
        residual: &[f64],
    ) {
        let n = self.alpha.len();
        self.trial.copy_from(to);
        let (x, f) = other.unwrap_or((&self.alpha, &self.forces));
        self.trial.a.iter_mut().zip(x).for_each(|(a, x)| *a += x);
        self.trial.lambda.iter_mut().zip(f).for_each(|(lambda, f)| *lambda += f);
        system.residual(&self.trial, &mut self.rhs[..n]);
        self.rhs[..n].iter_mut().zip(residual).for_each(|(r, first)| *r -= first);
    }
}
