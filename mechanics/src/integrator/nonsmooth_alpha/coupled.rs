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
use super::{Level, Set, Work, failure, open};
use crate::integrator::auxiliary::Formulas;
use crate::integrator::{Counters, Progress, Span, StepError, StepReport};
use crate::system::{Dynamics, RowWeights, State, Weights};

impl Coupled {
    /// Attempts a step.
    pub(super) fn step(
        &mut self,
        work: &mut Work,
        system: &mut dyn Dynamics,
        span: Span,
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        let (h, t) = (span.step, work.from.t);
        let parameters = self.auxiliary.parameters;
        let (kappa, beta) = (parameters.kappa(), parameters.beta);
        let ([to_v, to_q], half) = (parameters.weights(h), 0.5 * h * h);
        let formulas = self.auxiliary.attempt(h);
        let (n, m) = (work.alpha.len(), work.forces.len());
        system.constraint(&work.from, RowWeights::VELOCITY, &mut work.start);
        to.copy_from(&work.from);
        (to.t, to.side) = (span.end, span.side);
        work.smooth.copy_from(to);
        work.takes_part.fill(false);
        work.turns = false;
        for list in [&mut work.alpha, &mut work.forces, &mut self.velocity, &mut self.impulses] {
            list.fill(0.0);
        }
        let joints = work.rows.sets().contains(&Set::Free);
        let (mut iterations, mut largest) = (0, 0.0_f64);
        work.convergence.begin(true);
        loop {
            self.place(work, formulas, system, h, to);
            system.constraint(to, RowWeights::POSITION, &mut work.gaps);
            let new = work.admit(|work, i| work.gaps[i] <= 0.0);
            work.corrected = work.takes_part.contains(&true);
            if new {
                work.keep_directions(system);
            }
            system.residual(to, &mut self.residual);
            // r₂, with which the position is corrected.
            work.difference(system, to, None, &self.residual);
            for (i, r) in work.rhs[..n].iter_mut().enumerate() {
                self.rhs[i] = -*r;
                *r = -2.0 * beta * kappa * self.residual[i] - *r;
            }
            for i in 0..n {
                work.trial.v[i] = work.smooth.v[i] + h * work.alpha[i];
            }
            system.constraint(&work.trial, RowWeights::VELOCITY, &mut work.rates);
            for (k, set) in work.rows.sets().iter().enumerate() {
                work.rhs[n + k] = if *set == Set::Free { -work.gaps[k] / half } else { 0.0 };
            }
            let weights = Weights { a: 1.0, v: to_v, q: to_q, increment: Some(&self.d) };
            system.tangent(to, weights, &mut work.matrix);
            work.rows.add_border(system, to, n, &mut work.matrix);
            work.impulses.keep(&work.matrix);
            work.matrix.factor().map_err(|cause| failure::singular(system, t, h, cause))?;
            work.matrix.solve(&mut work.rhs);
            work.rows.store_jacobian(system, to);
            self.before.copy_from_slice(&work.forces);
            let solved = work.solve_cone(Level::Position, [h, half], None);
            solved.map_err(|cause| work.unresolved(system, h, cause))?;
            counters.add_full_iteration(1 + work.impulses.len() as u64);
            let mut square: f64 = work.rhs[..n].iter().zip(&work.scale).map(|(x, s)| (x / s).powi(2)).sum();
            let active = joints || work.corrected;
            if active {
                let increment = Some(&self.d[..]);
                system.tangent(to, Weights { a: 1.0, v: 0.0, q: 0.0, increment }, &mut self.mass);
                work.rows.add_border(system, to, n, &mut self.mass);
                work.impulses.keep(&self.mass);
                self.mass.factor().map_err(|cause| failure::singular(system, t, h, cause))?;
                counters.factorizations += 1;
                // Δα with G Δα from G Δq̈ = −ġ(q, ṽ)/(hγκ).
                system.constraint(&work.smooth, RowWeights::VELOCITY, &mut work.rates);
                for k in 0..m {
                    let free = work.rows.sets()[k] == Set::Free;
                    self.rhs[n + k] = if free { 2.0 * beta * kappa * work.rates[k] / to_v } else { 0.0 };
                }
                for &(row, j, x) in work.rows.stored() {
                    if work.rows.sets()[row] == Set::Free {
                        self.rhs[n + row] += x * work.rhs[j];
                    } else {
                        self.rhs[j] += x * (work.forces[row] - self.before[row]);
                    }
                }
                self.mass.solve(&mut self.rhs);
            } else {
                self.rhs.fill(0.0);
            }
            for i in 0..n {
                work.alpha[i] += self.rhs[i];
                to.a[i] += (work.rhs[i] - self.rhs[i]) / (2.0 * beta * kappa);
            }
            for k in (0..m).filter(|k| work.rows.sets()[*k] == Set::Free) {
                // The multipliers of the position, and what is left for those of the smooth motion.
                work.forces[k] += self.rhs[n + k];
                to.lambda[k] += (work.rhs[n + k] - self.rhs[n + k]) / (2.0 * beta * kappa);
            }
            if active {
                self.place(work, formulas, system, h, to);
                system.residual(to, &mut self.residual);
                work.difference(system, to, Some((&self.velocity, &self.impulses)), &self.residual);
                work.turn(&self.impulses);
                system.constraint(to, RowWeights::VELOCITY, &mut work.rates);
                for (k, set) in work.rows.sets().iter().enumerate() {
                    work.rhs[n + k] = if *set == Set::Free { work.rates[k] / h } else { 0.0 };
                }
                work.rhs.iter_mut().for_each(|r| *r = -*r);
                self.mass.solve(&mut work.rhs);
                let swapped = (&mut self.mass, &mut self.impulses[..]);
                let solved = work.solve_cone(Level::Velocity, [h, half], Some(swapped));
                solved.map_err(|cause| work.unresolved(system, h, cause))?;
                counters.solves += 3 + work.impulses.len() as u64;
                for i in 0..n {
                    self.velocity[i] += work.rhs[i];
                    square += (work.rhs[i] / work.scale[i]).powi(2);
                }
                for k in (0..m).filter(|k| work.rows.sets()[*k] == Set::Free) {
                    self.impulses[k] += work.rhs[n + k];
                }
            }
            let size = h * h * (square / n.max(1) as f64).sqrt();
            if new {
                iterations += work.begin_anew();
            }
            largest = largest.max(size);
            match work.progress(size, largest, new) {
                Progress::Converged => break,
                Progress::Continue => {}
                Progress::Diverged => return Err(work.not_converged(system, h, size)),
            }
        }
        work.stopped(system, h)?;
        self.place(work, formulas, system, h, to);
        // What the smooth motion remembers, and what the state shows.
        work.smooth.a.copy_from_slice(&to.a);
        work.smooth.lambda.copy_from_slice(&to.lambda);
        open(work.rows.sets(), &mut work.smooth);
        for i in 0..n {
            to.a[i] += self.velocity[i];
        }
        for k in 0..m {
            to.lambda[k] += self.impulses[k];
        }
        work.modes(&to.lambda, &mut to.mode);
        if !to.is_finite() {
            return Err(failure::not_finite(system, work.from.t, h, to));
        }
        iterations += work.convergence.iterations();
        Ok(StepReport { iterations, unsettled: work.unsettled(), ..StepReport::default() })
    }

    /// Makes position, velocities and accelerations of the attempt from the unknowns: `to` becomes the end of the step,
    /// `work.smooth` has ṽ and the same position.
    fn place(&mut self, work: &mut Work, formulas: Formulas, system: &dyn Dynamics, h: f64, to: &mut State) {
        for i in 0..self.d.len() {
            let [v, d] = formulas.motion(self.auxiliary.a[i], work.from.v[i], work.from.a[i], to.a[i]);
            self.d[i] = d + 0.5 * h * h * work.alpha[i];
            work.smooth.v[i] = v;
            to.v[i] = v + h * self.velocity[i];
        }
        system.retract(&work.from.q, &self.d, &mut to.q);
        work.smooth.q.copy_from_slice(&to.q);
    }
}

impl Work {
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
