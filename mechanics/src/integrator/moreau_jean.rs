//! Moreau's time-stepping scheme with the θ-method: nonsmooth, fixed step, order 1.
//!
//! Velocities may jump in a step; contacts act by their impulses P over the step. With v_θ = (1 − θ) v₀ + θ v₁,
//!
//! ```text
//! r(t₀ + θh, q₀ ⊞ θh v_θ, v_θ, (v₁ − v₀)/h, P/h) = 0,     q₁ = q₀ ⊞ h v_θ
//! joints    ġ₁ = 0
//! contacts  ġ₁ + e ġ₀ ≥ 0 ⟂ P ≥ 0   where g₀ + ½h ġ₀ ≤ 0,   P = 0 elsewhere
//! friction  |P_t| ≤ μ Pₙ, opposite to ġ₁
//! ```
//!
//! No event is located: any number of impacts may fall into a step. θ = ½ keeps the energy of linear free motion.
//! Constraints hold at the level of velocities: gaps are violated by O(h), joints drift by O(h). Newton's method
//! with the matrix M + θh C + θ²h² K, bordered by the rows of the joints; the impulses of the contacts solve the [cone problem](crate::contact::Few) in
//! each iteration.
//! Recorded accelerations and multipliers are means over the step. Dense output: linear.
//!
//! Sources: Moreau (1988, doi 10.1007/978-3-7091-2624-0_1); Jean (1999, doi 10.1016/S0045-7825(98)00383-1).

use super::impulses::{Closing, Impulses};
use super::rows::Rows;
use super::{
    Attempt, Checkpoint, Convergence, Counters, Info, Integrator, InvalidParameter, NotResumed, Progress,
    Span, StepError, StepReport, Stepper, failure, hermite,
};
use crate::linalg::Matrix;
use crate::system::{Dynamics, Mode, RowWeights, Set, Side, State, Weights};

/// Name as in a case file.
const NAME: &str = "moreau-jean";

/// Iteration error of Newton's method, relative to the scales of the unknowns.
const TOLERANCE: f64 = 1e-12;

/// Moreau's scheme. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct MoreauJean {
    info: Info,
    theta: f64,
}

/// The scheme with its memory.
#[derive(Debug)]
struct MoreauSteps {
    theta: f64,
    convergence: Convergence,
    /// With rows of joints, it has their multipliers too.
    matrix: Matrix,
    joints: bool,
    rows: Rows,
    middle: State,
    increment: Vec<f64>,
    rhs: Vec<f64>,
    impulses: Vec<f64>,
    start: Vec<f64>,
    gaps: Vec<f64>,
    rates: Vec<f64>,
    part: Impulses,
    scale: Vec<f64>,
}

impl MoreauJean {
    /// The scheme with the given θ.
    ///
    /// # Errors
    /// Outside ½ ≤ θ ≤ 1, where it is not unconditionally stable.
    pub fn new(theta: f64) -> Result<MoreauJean, InvalidParameter> {
        if !(0.5..=1.0).contains(&theta) {
            return Err(InvalidParameter { parameter: "theta", value: theta, range: "1/2 ≤ θ ≤ 1" });
        }
        Ok(MoreauJean { info: Info { name: NAME, order: 1, estimate_order: None, implicit: true }, theta })
    }
}

impl MoreauSteps {
    fn new(theta: f64, system: &mut dyn Dynamics, state: &State) -> MoreauSteps {
        let size = system.size();
        let (n, m) = (size.v, size.lambda);
        let zeros = |n| vec![0.0; n];
        let joints = system.rows().contains(&Set::Free);
        let unknowns = if joints { n + m } else { n };
        MoreauSteps {
            theta,
            convergence: Convergence::full(TOLERANCE, 1e-9),
            matrix: Matrix::new(&system.structure(usize::from(joints))),
            joints,
            rows: Rows::new(system, state),
            middle: State::zeros(size, state.t),
            increment: zeros(n),
            rhs: zeros(unknowns),
            impulses: zeros(m),
            start: zeros(m),
            gaps: zeros(m),
            rates: zeros(m),
            part: Impulses::new(system, unknowns),
            scale: system.scales().to_vec(),
        }
    }

    /// Solves the equations of a step.
    fn solve(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<u32, StepError> {
        let (n, theta) = (from.v.len(), self.theta);
        self.choose(system, from, h);
        to.v.copy_from_slice(&from.v);
        to.copy_modes(from);
        self.middle.copy_modes(from);
        self.middle.memory.copy_from_slice(&from.memory);
        self.impulses.iter_mut().zip(&from.lambda).for_each(|(p, lambda)| *p = h * lambda);
        self.part.guess(&self.impulses);
        self.impulses.fill(0.0);
        let mut closing = Closing::default();
        self.convergence.begin(true);
        loop {
            if self.joints || self.part.len() > 0 {
                self.finish(system, from, h, to);
                system.constraint(to, RowWeights::VELOCITY, &mut self.rates);
            }
            // The residual at t₀ + θh.
            for i in 0..n {
                self.middle.v[i] = (1.0 - theta) * from.v[i] + theta * to.v[i];
                self.middle.a[i] = (to.v[i] - from.v[i]) / h;
                self.increment[i] = theta * h * self.middle.v[i];
            }
            (self.middle.t, self.middle.side) = (from.t + theta * h, Side::Right);
            system.retract(&from.q, &self.increment, &mut self.middle.q);
            for (lambda, p) in self.middle.lambda.iter_mut().zip(&self.impulses) {
                *lambda = p / h;
            }
            let (motion, joints) = self.rhs.split_at_mut(n);
            system.residual(&self.middle, motion);
            motion.iter_mut().for_each(|r| *r *= -h);
            for ((r, set), rate) in joints.iter_mut().zip(self.rows.sets()).zip(&self.rates) {
                *r = if *set == Set::Free { -rate } else { 0.0 };
            }
            let weights =
                Weights { a: 1.0, v: theta * h, q: (theta * h).powi(2), increment: Some(&self.increment) };
            system.tangent(&self.middle, weights, &mut self.matrix);
            if self.joints {
                self.rows.add_border(system, &self.middle, n, &mut self.matrix);
            }
            self.part.keep(&self.matrix);
            self.matrix.factor().map_err(|e| failure::singular(system, from.t, h, e))?;
            self.matrix.solve(&mut self.rhs);
            self.rows.store_jacobian(system, &self.middle);
            self.respond(system, from, h, to)?;
            closing.enter(&self.part);
            let square: f64 = self.rhs[..n].iter().zip(&self.scale).map(|(x, s)| (h * x / s).powi(2)).sum();
            let size = (square / n.max(1) as f64).sqrt();
            counters.add_full_iteration(1 + self.part.len() as u64);
            match self.convergence.judge(size) {
                Progress::Converged => break,
                Progress::Continue => {}
                Progress::Diverged => {
                    let size = size / TOLERANCE;
                    return Err(failure::not_converged(
                        system,
                        (from.t, h),
                        &self.convergence,
                        size,
                        &self.rhs[..n],
                    ));
                }
            }
        }
        if let Some(row) = closing.driven(h, &self.scale) {
            return Err(failure::driven(system, (from.t, h), row));
        }
        self.finish(system, from, h, to);
        if to.is_finite() {
            Ok(self.convergence.iterations())
        } else {
            Err(failure::not_finite(system, from.t, h, to))
        }
    }

    /// Chooses the rows whose impulses lie in sets: contacts that close, their friction.
    fn choose(&mut self, system: &mut dyn Dynamics, from: &State, h: f64) {
        if !self.rows.is_empty() {
            system.constraint(from, RowWeights::POSITION, &mut self.gaps);
            system.constraint(from, RowWeights::VELOCITY, &mut self.start);
        }
        let (sets, gaps, start) = (self.rows.sets(), &self.gaps, &self.start);
        self.part.choose(sets, |i| sets[i] != Set::Free && gaps[i] + 0.5 * h * start[i] <= 0.0);
    }

    /// Adds to the increment `rhs` what the impulses of contacts change, and the whole to `to` and to the impulses of joints.
    fn respond(
        &mut self,
        system: &dyn Dynamics,
        from: &State,
        h: f64,
        to: &mut State,
    ) -> Result<(), StepError> {
        let (sets, rates, start) = (self.rows.sets(), &self.rates, &self.start);
        let value = |row: usize| match sets[row] {
            Set::Unilateral { restitution } => rates[row] + restitution * start[row].min(0.0),
            _ => rates[row],
        };
        self.part
            .solve(&mut self.matrix, &self.rows, value, &mut self.impulses, &mut self.rhs)
            .map_err(|cause| failure::contacts(system, (from.t, h), cause, &self.rhs))?;
        let joints = self.impulses.iter_mut().zip(sets).zip(self.rhs.get(from.v.len()..).unwrap_or_default());
        joints.filter(|((_, set), _)| **set == Set::Free).for_each(|((p, _), change)| *p += change);
        to.v.iter_mut().zip(&self.rhs).for_each(|(v, x)| *v += x);
        Ok(())
    }

    /// Position, mean accelerations and multipliers that belong to the velocities of `to`.
    fn finish(&mut self, system: &dyn Dynamics, from: &State, h: f64, to: &mut State) {
        let theta = self.theta;
        for i in 0..self.increment.len() {
            self.increment[i] = h * ((1.0 - theta) * from.v[i] + theta * to.v[i]);
            to.a[i] = (to.v[i] - from.v[i]) / h;
        }
        for (lambda, p) in to.lambda.iter_mut().zip(&self.impulses) {
            *lambda = p / h;
        }
        system.retract(&from.q, &self.increment, &mut to.q);
    }
}

impl Integrator for MoreauJean {
    fn info(&self) -> &Info {
        &self.info
    }

    fn resolves_contacts(&self) -> bool {
        true
    }

    fn stepper(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
        _step: f64,
        counters: &mut Counters,
    ) -> Result<Box<dyn Stepper>, StepError> {
        let mut steps = MoreauSteps::new(self.theta, system, state);
        steps.restart(system, state, counters)?;
        Ok(Box::new(steps))
    }
}

impl Stepper for MoreauSteps {
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        (span, _): (Span, Attempt),
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        let iterations = self.solve(system, from, span.step, to, counters)?;
        Ok(StepReport { iterations, unsettled: self.part.residual, ..StepReport::default() })
    }

    fn accept(&mut self, _from: &State, _to: &State) {}

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        let (h, s) = (to.t - from.t, hermite::fraction(from, to, t));
        for (d, (v0, v1)) in out.v.iter_mut().zip(from.v.iter().zip(&to.v)) {
            *d = s * (h * ((1.0 - self.theta) * v0 + self.theta * v1));
        }
        system.retract(&from.q, &out.v, &mut out.q);
        hermite::linear(from, to, t, out);
    }

    fn middle(&self, system: &dyn Dynamics, from: &State, to: &State, out: &mut State, damped: &mut [f64]) {
        let (h, theta) = (to.t - from.t, self.theta);
        for (i, w) in damped.iter_mut().enumerate() {
            *w = (1.0 - theta) * from.v[i] + theta * to.v[i];
            out.a[i] = theta * h * *w;
        }
        system.retract(&from.q, &out.a, &mut out.q);
        hermite::means(from, to, out);
        out.t = from.t + theta * h;
        out.lambda.copy_from_slice(&to.lambda);
    }

    /// Impulses decide about contacts, not modes.
    fn restart(
        &mut self,
        _system: &mut dyn Dynamics,
        state: &mut State,
        _counters: &mut Counters,
    ) -> Result<(), StepError> {
        for (mode, set) in state.mode.iter_mut().zip(self.rows.sets()) {
            *mode = if *set == Set::Free { Mode::Closed } else { Mode::Open };
        }
        Ok(())
    }

    fn save(&self, out: &mut Checkpoint) {
        out.put("convergence", &self.convergence.memory());
    }

    fn resume(&mut self, _system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        self.convergence.recall(from.numbers("convergence")?);
        Ok(())
    }
}
