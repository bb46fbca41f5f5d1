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
//! with the matrix M + θh C + θ²h² K; the impulses of each iteration solve the [cone problem](crate::contact::solve).
//! Recorded accelerations and multipliers are means over the step. Dense output: linear.
//!
//! Sources: Moreau (1988, doi 10.1007/978-3-7091-2624-0_1); Jean (1999, doi 10.1016/S0045-7825(98)00383-1).

use super::rows::Rows;
use super::{
    Checkpoint, Convergence, Counters, Info, Integrator, InvalidParameter, NotResumed, Progress, Span,
    StepError, StepReport, failure,
};
use crate::contact::{RowLaw as Law, solve};
use crate::linalg::Matrix;
use crate::system::{Dynamics, Mode, RowWeights, Set, Side, State, Weights};

/// Name as in a case file.
const NAME: &str = "moreau-jean";

/// Iteration error of Newton's method, relative to the scales of the unknowns.
const TOLERANCE: f64 = 1e-12;

/// Moreau's scheme. Its formulas head the source file.
#[derive(Debug)]
pub struct MoreauJean {
    info: Info,
    theta: f64,
    counters: Counters,
    convergence: Convergence,
    pending: bool,
    worst: usize,
    work: Option<Work>,
}

/// What `start` allocates for a system.
#[derive(Debug)]
struct Work {
    matrix: Matrix,
    rows: Rows,
    middle: State,
    increment: Vec<f64>,
    rhs: Vec<f64>,
    image: Vec<f64>,
    impulses: Vec<f64>,
    start: Vec<f64>,
    gaps: Vec<f64>,
    rates: Vec<f64>,
    /// Rows that take part, their laws, W, b and multipliers.
    part: Vec<usize>,
    laws: Vec<Law>,
    w: Vec<f64>,
    b: Vec<f64>,
    solution: Vec<f64>,
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
        Ok(MoreauJean {
            info: Info { name: NAME, order: 1, estimate_order: None, implicit: true },
            theta,
            counters: Counters::default(),
            convergence: Convergence::full(TOLERANCE, 1e-9),
            pending: false,
            worst: 0,
            work: None,
        })
    }

    /// Solves the equations of a step.
    fn solve(
        &mut self,
        work: &mut Work,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        to: &mut State,
    ) -> Result<u32, StepError> {
        let (n, theta) = (from.v.len(), self.theta);
        work.choose(system, from, h);
        to.v.copy_from_slice(&from.v);
        to.copy_modes(from);
        work.impulses.fill(0.0);
        self.convergence.begin(true);
        loop {
            // The residual at t₀ + θh.
            for i in 0..n {
                work.middle.v[i] = (1.0 - theta) * from.v[i] + theta * to.v[i];
                work.middle.a[i] = (to.v[i] - from.v[i]) / h;
                work.increment[i] = theta * h * work.middle.v[i];
            }
            (work.middle.t, work.middle.side) = (from.t + theta * h, Side::Right);
            system.retract(&from.q, &work.increment, &mut work.middle.q);
            for (lambda, p) in work.middle.lambda.iter_mut().zip(&work.impulses) {
                *lambda = p / h;
            }
            system.residual(&work.middle, &mut work.rhs);
            let weights =
                Weights { a: 1.0, v: theta * h, q: (theta * h).powi(2), increment: Some(&work.increment) };
            system.tangent(&work.middle, weights, &mut work.matrix);
            work.matrix.factor().map_err(|e| failure::singular(system, from.t, h, e))?;
            work.rhs.iter_mut().for_each(|r| *r *= -h);
            work.matrix.solve(&mut work.rhs);
            work.rows.store_jacobian(system, &work.middle);
            work.respond(system, from, h, to, theta)?;
            let square: f64 = work.rhs.iter().zip(&work.scale).map(|(x, s)| (h * x / s).powi(2)).sum();
            let size = (square / n.max(1) as f64).sqrt();
            self.counters.residuals += 1;
            self.counters.tangents += 1;
            self.counters.factorizations += 1;
            self.counters.solves += 1 + work.part.len() as u64;
            self.counters.iterations += 1;
            match self.convergence.judge(size) {
                Progress::Converged => break,
                Progress::Continue => {}
                Progress::Diverged => {
                    let iterations = self.convergence.iterations();
                    let worst = system.unknown(self.worst);
                    return Err(StepError::NotConverged { time: from.t, step: h, iterations, size, worst });
                }
            }
        }
        work.finish(system, from, h, to, theta);
        if to.is_finite() {
            Ok(self.convergence.iterations())
        } else {
            Err(failure::not_finite(system, from.t, h, to))
        }
    }
}

impl Work {
    fn new(system: &mut dyn Dynamics, state: &State) -> Work {
        let size = system.size();
        let (n, m) = (size.v, size.lambda);
        let zeros = |n| vec![0.0; n];
        Work {
            matrix: Matrix::new(&system.structure(0)),
            rows: Rows::new(system, state),
            middle: State::zeros(size, state.t),
            increment: zeros(n),
            rhs: zeros(n),
            image: zeros(n * m),
            impulses: zeros(m),
            start: zeros(m),
            gaps: zeros(m),
            rates: zeros(m),
            part: Vec::with_capacity(m),
            laws: Vec::with_capacity(m),
            w: Vec::with_capacity(m * m),
            b: Vec::with_capacity(m),
            solution: Vec::with_capacity(m),
            scale: system.scales().to_vec(),
        }
    }

    /// Chooses the rows that take part in a step: joints, contacts that close, their friction.
    fn choose(&mut self, system: &mut dyn Dynamics, from: &State, h: f64) {
        self.part.clear();
        self.laws.clear();
        if self.rows.is_empty() {
            return;
        }
        system.constraint(from, RowWeights::POSITION, &mut self.gaps);
        system.constraint(from, RowWeights::VELOCITY, &mut self.start);
        for (i, set) in self.rows.sets().iter().enumerate() {
            let law = match set {
                Set::Free => Law::Free,
                Set::Unilateral { .. } if self.gaps[i] + 0.5 * h * self.start[i] <= 0.0 => Law::Unilateral,
                _ => continue,
            };
            self.part.push(i);
            self.laws.push(law);
        }
        for (i, set) in self.rows.sets().iter().enumerate() {
            if let Set::Friction { coefficient, normal } = *set
                && let Some(normal) = self.part.iter().position(|&row| row == normal)
            {
                self.part.push(i);
                self.laws.push(Law::Friction { coefficient, normal });
            }
        }
    }

    /// Adds to the increment `rhs` of the velocities what the impulses change, and to `to` the whole.
    fn respond(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        to: &mut State,
        theta: f64,
    ) -> Result<(), StepError> {
        let (n, m) = (self.rhs.len(), self.part.len());
        if m > 0 {
            self.finish(system, from, h, to, theta);
            system.constraint(to, RowWeights::VELOCITY, &mut self.rates);
            self.w.clear();
            self.w.resize(m * m, 0.0);
            for (k, &row) in self.part.iter().enumerate() {
                let image = &mut self.image[k * n..(k + 1) * n];
                image.fill(0.0);
                for &(_, j, x) in self.rows.stored().iter().filter(|(i, ..)| *i == row) {
                    image[j] += x;
                }
                self.matrix.solve(image);
                for (l, &other) in self.part.iter().enumerate() {
                    let entries = self.rows.stored().iter().filter(|(i, ..)| *i == other);
                    self.w[l * m + k] = entries.map(|&(_, j, x)| x * image[j]).sum();
                }
            }
            self.b.clear();
            self.solution.clear();
            for &row in &self.part {
                let entries = self.rows.stored().iter().filter(|(i, ..)| *i == row);
                let mut b = self.rates[row] + entries.map(|&(_, j, x)| x * self.rhs[j]).sum::<f64>();
                if let Set::Unilateral { restitution } = self.rows.sets()[row] {
                    b += restitution * self.start[row].min(0.0);
                }
                self.b.push(b);
                self.solution.push(self.impulses[row]);
            }
            // In terms of the whole impulses, not of their change.
            for k in 0..m {
                let part = self.w[k * m..(k + 1) * m].iter().zip(&self.solution);
                self.b[k] -= part.map(|(w, p)| w * p).sum::<f64>();
            }
            solve(&self.laws, &self.w, &self.b, &mut self.solution).map_err(|cause| StepError::Contacts {
                time: from.t,
                step: h,
                cause,
            })?;
            for (k, &row) in self.part.iter().enumerate() {
                let change = self.solution[k] - self.impulses[row];
                self.impulses[row] = self.solution[k];
                for (x, image) in self.rhs.iter_mut().zip(&self.image[k * n..(k + 1) * n]) {
                    *x += change * image;
                }
            }
        }
        to.v.iter_mut().zip(&self.rhs).for_each(|(v, x)| *v += x);
        Ok(())
    }

    /// Position, mean accelerations and multipliers that belong to the velocities of `to`.
    fn finish(&mut self, system: &dyn Dynamics, from: &State, h: f64, to: &mut State, theta: f64) {
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

    fn start(&mut self, system: &mut dyn Dynamics, state: &mut State, _step: f64) -> Result<(), StepError> {
        self.counters = Counters::default();
        self.convergence.reset();
        self.work = Some(Work::new(system, state));
        self.restart(system, state)
    }

    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        span: Span,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let h = span.step;
        (to.t, to.side) = (span.end, span.side);
        let Some(mut work) = self.work.take() else {
            return Err(StepError::NotStarted { method: NAME });
        };
        self.counters.rejected += u64::from(self.pending);
        self.pending = true;
        let solved = self.solve(&mut work, system, from, h, to);
        self.work = Some(work);
        Ok(StepReport { iterations: solved?, error: None })
    }

    fn accept(&mut self, _from: &State, _to: &State) {
        self.pending = false;
        self.counters.steps += 1;
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        let h = to.t - from.t;
        let s = if h > 0.0 { (t - from.t) / h } else { 1.0 };
        let mean = |a: &[f64], b: &[f64], out: &mut [f64]| {
            for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
                *out = a + s * (b - a);
            }
        };
        system.difference(&from.q, &to.q, &mut out.v);
        out.v.iter_mut().for_each(|d| *d *= s);
        system.retract(&from.q, &out.v, &mut out.q);
        mean(&from.v, &to.v, &mut out.v);
        mean(&from.a, &to.a, &mut out.a);
        mean(&from.lambda, &to.lambda, &mut out.lambda);
        out.copy_modes(from);
        (out.t, out.side) = (t, Side::Right);
    }

    fn restart(&mut self, _system: &mut dyn Dynamics, state: &mut State) -> Result<(), StepError> {
        self.pending = false;
        state.side = Side::Right;
        // Impulses decide about contacts, not modes.
        if let Some(work) = &self.work {
            for (mode, set) in state.mode.iter_mut().zip(work.rows.sets()) {
                *mode = if *set == Set::Free { Mode::Closed } else { Mode::Open };
            }
        }
        Ok(())
    }

    fn save(&self, out: &mut Checkpoint) {
        out.put("counters", &self.counters.to_numbers());
        out.put("convergence", &self.convergence.memory());
    }

    fn resume(&mut self, _system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        self.counters = Counters::from_numbers(from.numbers("counters")?);
        self.convergence.recall(from.numbers("convergence")?);
        Ok(())
    }

    fn resolves_contacts(&self) -> bool {
        true
    }

    fn worst(&self) -> usize {
        self.worst
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}
