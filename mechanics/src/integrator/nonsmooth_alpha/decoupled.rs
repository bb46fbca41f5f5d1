//! The decoupled scheme: smooth motion, position, velocity.

use super::{AlphaSteps, Attempt, Level, Set, Work, failure};
use crate::integrator::{Counters, Progress, Span, StepError, StepReport, Stepper};
use crate::system::{Dynamics, RowWeights, State, Weights};

impl Work {
    /// Attempts a step of the decoupled scheme.
    pub(super) fn step(
        &mut self,
        smooth: &mut AlphaSteps,
        system: &mut dyn Dynamics,
        (from, to): (&State, &mut State),
        span: Span,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        (self.smooth.t, self.smooth.side) = (span.end, span.side);
        let mut report =
            smooth.step(system, &self.from, (span, Attempt::First), &mut self.smooth, counters)?;
        to.copy_from(&self.smooth);
        self.corrected = false;
        if self.rows.is_empty() {
            return Ok(report);
        }
        system.constraint(from, RowWeights::VELOCITY, &mut self.start);
        system.constraint(to, RowWeights::POSITION, &mut self.gaps);
        self.takes_part.fill(false);
        self.forces.fill(0.0);
        if !self.admit(|work, i| work.gaps[i] <= 0.0) {
            return Ok(report);
        }
        self.corrected = true;
        report.iterations += self.correct(system, span.step, to, Level::Position, counters)?;
        // Impulses act where the position is at its bound.
        for i in 0..self.takes_part.len() {
            self.takes_part[i] = self.is_contact(i) && (self.forces[i] > 0.0 || self.gaps[i] <= 0.0);
        }
        self.keep_directions(system);
        report.iterations += self.correct(system, span.step, to, Level::Velocity, counters)?;
        self.stopped(system, span.step)?;
        to.a.copy_from_slice(&self.trial.a);
        to.lambda.copy_from_slice(&self.trial.lambda);
        self.modes(&to.lambda, &mut to.mode);
        report.unsettled = self.unsettled();
        if to.is_finite() { Ok(report) } else { Err(failure::not_finite(system, from.t, span.step, to)) }
    }

    /// Solves one of the two corrections: leaves the position or the velocity in `to`, the acceleration q̈ + α and the
    /// multipliers in the trial state; gives the number of iterations.
    fn correct(
        &mut self,
        system: &mut dyn Dynamics,
        h: f64,
        to: &mut State,
        level: Level,
        counters: &mut Counters,
    ) -> Result<u32, StepError> {
        let (n, m) = (self.alpha.len(), self.forces.len());
        let (to_v, to_q) = (h, 0.5 * h * h);
        self.alpha.fill(0.0);
        self.trial.copy_from(&self.smooth);
        match level {
            Level::Position => self.before.store_jacobian(system, &self.smooth),
            Level::Velocity => self.forces.fill(0.0),
        }
        let (mut iterations, mut largest) = (0, 0.0_f64);
        self.convergence.begin(true);
        loop {
            for i in 0..n {
                self.increment[i] = to_q * self.alpha[i];
                self.trial.v[i] = self.smooth.v[i] + to_v * self.alpha[i];
                self.trial.a[i] = self.smooth.a[i] + self.alpha[i];
            }
            system.retract(&self.smooth.q, &self.increment, &mut self.trial.q);
            to.v.copy_from_slice(&self.trial.v);
            if level == Level::Position {
                to.q.copy_from_slice(&self.trial.q);
            }
            system.constraint(to, RowWeights::POSITION, &mut self.gaps);
            system.constraint(to, RowWeights::VELOCITY, &mut self.rates);
            let new = level == Level::Position && self.admit(|work, i| work.gaps[i] <= 0.0);
            let (motion, joints) = self.rhs.split_at_mut(n);
            system.residual(&self.trial, motion);
            for (k, set) in self.rows.sets().iter().enumerate() {
                joints[k] = match (*set == Set::Free, level) {
                    (false, _) => 0.0,
                    (true, Level::Position) => self.gaps[k] / to_q,
                    (true, Level::Velocity) => self.rates[k] / to_v,
                };
            }
            self.push(level);
            self.rhs.iter_mut().for_each(|r| *r = -*r);
            let weights = Weights { a: 1.0, v: to_v, q: to_q, increment: Some(&self.increment) };
            system.tangent(&self.trial, weights, &mut self.matrix);
            self.rows.add_border(system, to, n, &mut self.matrix);
            self.impulses.keep(&self.matrix);
            self.matrix.factor().map_err(|e| failure::singular(system, self.from.t, h, e))?;
            self.matrix.solve(&mut self.rhs);
            self.rows.store_jacobian(system, to);
            let solved = self.solve_cone(level, [to_v, to_q], None);
            solved.map_err(|cause| self.unresolved(system, h, cause))?;
            let mut square = 0.0;
            for i in 0..n {
                self.alpha[i] += self.rhs[i];
                square += (self.rhs[i] / self.scale[i]).powi(2);
            }
            for k in 0..m {
                if self.rows.sets()[k] == Set::Free {
                    self.trial.lambda[k] += self.rhs[n + k];
                }
            }
            counters.add_full_iteration(1 + self.impulses.len() as u64);
            let size = h * h * (square / n.max(1) as f64).sqrt();
            if new {
                iterations += self.begin_anew();
            }
            largest = largest.max(size);
            match self.progress(size, largest, new) {
                Progress::Converged => break,
                Progress::Continue => {}
                Progress::Diverged => return Err(self.not_converged(system, h, size)),
            }
        }
        for i in 0..n {
            self.increment[i] = to_q * self.alpha[i];
            self.trial.a[i] = self.smooth.a[i] + self.alpha[i];
            to.v[i] = self.smooth.v[i] + to_v * self.alpha[i];
        }
        if level == Level::Position {
            system.retract(&self.smooth.q, &self.increment, &mut to.q);
            self.correction.copy_from_slice(&self.increment);
            system.constraint(to, RowWeights::POSITION, &mut self.gaps);
        } else {
            for k in (0..m).filter(|k| self.rows.sets()[*k] != Set::Free) {
                self.trial.lambda[k] = self.forces[k];
            }
        }
        Ok(iterations + self.convergence.iterations())
    }

    /// Subtracts the forces of the contacts of a correction from the residual in `rhs`, along directions that the correction does not change: at the level of positions
    /// those of q̃, and of velocities those of the end of the step and those that have turned into them. Along the ones of the trial state, forces that balance each other
    /// would not, and the iteration would not end; a heavy body that drives a light one around a corner makes the matrix indefinite there.
    fn push(&mut self, level: Level) {
        let Work { rows, before, rhs, forces, .. } = self;
        let along = if level == Level::Position { before } else { rows };
        for &(row, j, x) in along.stored() {
            if along.sets()[row] != Set::Free {
                rhs[j] -= x * forces[row];
            }
        }
        if level == Level::Position {
            return;
        }
        let mut change = std::mem::take(&mut self.change);
        for (k, change) in change.iter_mut().enumerate() {
            let free = self.rows.sets()[k] == Set::Free;
            *change = if free { self.trial.lambda[k] - self.smooth.lambda[k] } else { self.forces[k] };
        }
        self.turn(&change);
        self.change = change;
    }
}
