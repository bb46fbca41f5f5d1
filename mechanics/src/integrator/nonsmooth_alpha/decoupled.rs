//! The decoupled scheme: smooth motion, position, velocity.

use super::{Level, NonsmoothAlpha, Set, Work, failure};
use crate::integrator::{Integrator, Progress, Span, StepError, StepReport};
use crate::system::{Dynamics, RowWeights, State, Weights};

impl NonsmoothAlpha {
    /// Attempts a step of the decoupled scheme.
    pub(super) fn attempt_decoupled(
        &mut self,
        work: &mut Work,
        system: &mut dyn Dynamics,
        from: &State,
        span: Span,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let mut report = self.smooth.step(system, &work.from, span, &mut work.smooth)?;
        to.copy_from(&work.smooth);
        self.corrected = false;
        if work.rows.is_empty() {
            return Ok(report);
        }
        system.constraint(from, RowWeights::VELOCITY, &mut work.start);
        system.constraint(to, RowWeights::POSITION, &mut work.gaps);
        work.takes_part.fill(false);
        work.forces.fill(0.0);
        if !work.admit(|work, i| work.gaps[i] <= 0.0) {
            return Ok(report);
        }
        self.corrected = true;
        report.iterations += self.correct(work, system, span.step, to, Level::Position)?;
        // Impulses act where the position is at its bound.
        for i in 0..work.takes_part.len() {
            work.takes_part[i] = work.is_contact(i) && (work.forces[i] > 0.0 || work.gaps[i] <= 0.0);
        }
        report.iterations += self.correct(work, system, span.step, to, Level::Velocity)?;
        to.a.copy_from_slice(&work.trial.a);
        to.lambda.copy_from_slice(&work.trial.lambda);
        work.modes(&to.lambda, &mut to.mode);
        if to.is_finite() { Ok(report) } else { Err(failure::not_finite(system, from.t, span.step, to)) }
    }

    /// Solves one of the two corrections: leaves the position or the velocity in `to`, the acceleration q̈ + α and the
    /// multipliers in the trial state; gives the number of iterations.
    fn correct(
        &mut self,
        work: &mut Work,
        system: &mut dyn Dynamics,
        h: f64,
        to: &mut State,
        level: Level,
    ) -> Result<u32, StepError> {
        let (n, m) = (work.alpha.len(), work.forces.len());
        let (to_v, to_q) = (h, 0.5 * h * h);
        work.alpha.fill(0.0);
        work.trial.copy_from(&work.smooth);
        if level == Level::Velocity {
            work.forces.fill(0.0);
        }
        self.convergence.begin(true);
        loop {
            for i in 0..n {
                work.increment[i] = to_q * work.alpha[i];
                work.trial.v[i] = work.smooth.v[i] + to_v * work.alpha[i];
                work.trial.a[i] = work.smooth.a[i] + work.alpha[i];
            }
            system.retract(&work.smooth.q, &work.increment, &mut work.trial.q);
            to.v.copy_from_slice(&work.trial.v);
            if level == Level::Position {
                to.q.copy_from_slice(&work.trial.q);
            }
            system.constraint(to, RowWeights::POSITION, &mut work.gaps);
            system.constraint(to, RowWeights::VELOCITY, &mut work.rates);
            let new = level == Level::Position && work.admit(|work, i| work.gaps[i] <= 0.0);
            let (motion, joints) = work.rhs.split_at_mut(n);
            system.residual(&work.trial, motion);
            for (k, set) in work.rows.sets().iter().enumerate() {
                joints[k] = match (*set == Set::Free, level) {
                    (false, _) => 0.0,
                    (true, Level::Position) => work.gaps[k] / to_q,
                    (true, Level::Velocity) => work.rates[k] / to_v,
                };
            }
            work.rhs.iter_mut().for_each(|r| *r = -*r);
            let weights = Weights { a: 1.0, v: to_v, q: to_q, increment: Some(&work.increment) };
            system.tangent(&work.trial, weights, &mut work.matrix);
            work.rows.add_border(system, to, n, &mut work.matrix);
            work.matrix.factor().map_err(|e| failure::singular(system, work.from.t, h, e))?;
            work.matrix.solve(&mut work.rhs);
            work.rows.store_jacobian(system, to);
            work.solve_cone(level, [to_v, to_q], None).map_err(|cause| StepError::Contacts {
                time: work.from.t,
                step: h,
                cause,
            })?;
            let mut square = 0.0;
            for i in 0..n {
                work.alpha[i] += work.rhs[i];
                square += (work.rhs[i] / work.scale[i]).powi(2);
            }
            for k in 0..m {
                work.trial.lambda[k] = if work.rows.sets()[k] == Set::Free {
                    work.trial.lambda[k] + work.rhs[n + k]
                } else {
                    work.forces[k]
                };
            }
            self.counters.residuals += 1;
            self.counters.tangents += 1;
            self.counters.factorizations += 1;
            self.counters.solves += 1 + work.impulses.len() as u64;
            self.counters.iterations += 1;
            let size = h * h * (square / n.max(1) as f64).sqrt();
            match self.convergence.judge(size) {
                Progress::Converged if !new => break,
                Progress::Converged | Progress::Continue => {}
                Progress::Diverged => return Err(self.not_converged(work, system, h, size)),
            }
        }
        for i in 0..n {
            work.increment[i] = to_q * work.alpha[i];
            work.trial.a[i] = work.smooth.a[i] + work.alpha[i];
            to.v[i] = work.smooth.v[i] + to_v * work.alpha[i];
        }
        if level == Level::Position {
            system.retract(&work.smooth.q, &work.increment, &mut to.q);
            system.constraint(to, RowWeights::POSITION, &mut work.gaps);
        }
        Ok(self.convergence.iterations())
    }
}
