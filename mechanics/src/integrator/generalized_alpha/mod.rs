//! The generalized-α family: Newmark, HHT-α, Chung–Hulbert; second order, fixed step.
//!
//! ```text
//! r(tₙ₊₁, qₙ₊₁, vₙ₊₁, q̈ₙ₊₁, λₙ₊₁) = 0,   g(tₙ₊₁, qₙ₊₁) = 0                    exactly at the end of a step
//! (1 − αm) aₙ₊₁ + αm aₙ = (1 − αf) q̈ₙ₊₁ + αf q̈ₙ
//! qₙ₊₁ = qₙ ⊞ d,   d = h vₙ + h² ((½ − β) aₙ + β aₙ₊₁)
//! vₙ₊₁ = vₙ + h ((1 − γ) aₙ + γ aₙ₊₁)
//! ```
//!
//! q̈ is the true acceleration, a an auxiliary one that lags behind it; with αm = αf = 0 they are the same.
//! The unknowns of a step are q̈ₙ₊₁ and λₙ₊₁. With κ = (1 − αf)/(1 − αm) an increment Δq̈ moves v by hγκ Δq̈
//! and q by h²βκ Δq̈, so that Newton's method solves
//!
//! ```text
//! ⎡ M + hγκ C + h²βκ K   −Gᵀ⎤ ⎡Δq̈⎤     ⎡ r           ⎤
//! ⎣ G                     0 ⎦ ⎣Δλ⎦ = − ⎣ g / (h² βκ) ⎦
//! ```
//!
//! whose condition does not deteriorate as h → 0: this is the scaling of index-3 equations of Bottasso,
//! Bauchau & Cardona (2007, doi 10.1137/050638503) without a separate pass for it.
//!
//! In the [stabilized](GeneralizedAlpha::stabilized) form of index 2 (Gear, Gupta & Leimkuhler), d = … + h Gₙᵀ μ with a
//! second multiplier μ for every row, and ġ(tₙ₊₁, qₙ₊₁, vₙ₊₁) = 0 holds beside g = 0:
//!
//! ```text
//! ⎡ M + hγκ C + h²βκ K   −Gᵀ   hK Gₙᵀ          ⎤ ⎡Δq̈⎤     ⎡ r          ⎤
//! ⎢ G                     0    G Gₙᵀ / (hβκ)   ⎥ ⎢Δλ⎥ = − ⎢ g / (h²βκ) ⎥
//! ⎣ G                     0    0               ⎦ ⎣Δμ⎦     ⎣ ġ / (hγκ)  ⎦
//! ```
//!
//! The tangent and its factors are kept from step to step until their age costs more iterations than new ones; they are
//! rotated with the sections (see [`Dynamics::corotate`]), without which the axial stiffness of a slender beam
//! soon points in wrong directions. An affine system is solved exactly by one iteration with the tangent of its step.
//! With constraints a step goes on to the rounding errors.
//! The predictor is q̈ₙ₊₁ = q̈ₙ + q̈ₙ₋₁ − q̈ₙ₋₂: exact for accelerations linear in time, and for those that change their
//! sign from step to step, as vibrations far too fast for the step do for ever in a method without dissipation.
//!
//! Steps may change their size, and may be controlled by an estimate of their error (`steps.rs`).
//!
//! Order: 2 in q, v and λ for γ = ½ + αf − αm (measured 2.00, also for constraints of index 3 and in the stabilized
//! form, and on rotations). Stability: unconditional on linear systems for the constructors here. Dense output: cubic
//! in q, linear in q̈.
//!
//! Sources: Newmark (1959, doi 10.1061/JMCEA3.0000098); Hilber, Hughes & Taylor (1977,
//! doi 10.1002/eqe.4290050306); Chung & Hulbert (1993, doi 10.1115/1.2900803); Arnold & Brüls (2007,
//! doi 10.1007/s11044-007-9084-0); Gear, Gupta & Leimkuhler (1985, doi 10.1016/0377-0427(85)90008-1); Arnold, Brüls &
//! Cardona (2015, doi 10.1007/s00211-014-0633-1).

mod steps;
mod work;

use super::acceleration::Accelerations;
use super::rows::Rows;
use super::{
    Checkpoint, Convergence, Counters, Info, Integrator, InvalidParameter, NotResumed, Progress, Span,
    StepError, StepReport, Tolerance, corotation, failure, hermite,
};
use crate::linalg::Matrix;
use crate::system::{Dynamics, RowWeights, Side, Size, State};
use work::{Age, Work};

/// Iteration error, relative to the scales of the unknowns, at which Newton's method stops: far below
/// the truncation error of a second-order method at any useful step.
const ITERATION_TOLERANCE: f64 = 1e-10;

/// The same where the tangent is kept and the iteration converges linearly. The balance of energy shows ten times as
/// much: its error would not fall with the square of the step.
const KEPT_TOLERANCE: f64 = 1e-13;

/// The same for systems with constraints or rotations: the rounding error of a position, for an error δ of g is an error δ/(h²βκ) of λ.
const ROWS_TOLERANCE: f64 = 1e-16;

/// Largest size of increments that may be rounding errors.
const NOISE: f64 = 1e-7;

/// The generalized-α method. Its formulas and sources head the source file.
#[derive(Debug)]
pub struct GeneralizedAlpha {
    info: Info,
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
    stabilized: bool,
    /// Of full Newton iterations, and of those with a kept tangent.
    full: Convergence,
    kept: Convergence,
    counters: Counters,
    worst: usize,
    pending: bool,
    /// Acceleration q̈ at the start of the last accepted step.
    before: Vec<f64>,
    /// The same one step earlier, and how many of the two there are.
    earlier: Vec<f64>,
    history: u8,
    /// Auxiliary acceleration aₙ.
    a: Vec<f64>,
    /// The steps accepted last and attempted.
    spacing: [f64; 2],
    tolerance: Option<Tolerance>,
    /// Increment d of the attempt.
    d: Vec<f64>,
    work: Option<Box<Work>>,
}

impl GeneralizedAlpha {
    /// Newmark's method. β = ¼, γ = ½ is the average-acceleration (trapezoidal) rule, without
    /// dissipation; γ > ½ dissipates but reduces the order to 1.
    ///
    /// # Errors
    /// Outside γ ≥ ½, 2β ≥ γ, where the method is not unconditionally stable.
    pub fn newmark(beta: f64, gamma: f64) -> Result<GeneralizedAlpha, InvalidParameter> {
        if !(gamma >= 0.5 && gamma.is_finite()) {
            let range = "γ ≥ 1/2 (below, the method is unstable at every step)";
            return Err(InvalidParameter { parameter: "gamma", value: gamma, range });
        }
        if !(2.0 * beta >= gamma && beta.is_finite()) {
            let range = "β ≥ γ/2 (below, the method is only conditionally stable)";
            return Err(InvalidParameter { parameter: "beta", value: beta, range });
        }
        let order = if gamma == 0.5 { 2 } else { 1 };
        Ok(GeneralizedAlpha::new("newmark", order, 0.0, 0.0, beta, gamma))
    }

    /// HHT-α: αm = 0, αf = α, β = (1 + α)²/4, γ = ½ + α. α = 0 is the trapezoidal rule; dissipation of high
    /// frequencies grows with α.
    ///
    /// # Errors
    /// Outside 0 ≤ α ≤ 1/3.
    pub fn hht(alpha: f64) -> Result<GeneralizedAlpha, InvalidParameter> {
        if !(0.0..=1.0 / 3.0).contains(&alpha) {
            let range = "0 ≤ α ≤ 1/3";
            return Err(InvalidParameter { parameter: "alpha", value: alpha, range });
        }
        let beta = 0.25 * (1.0 + alpha) * (1.0 + alpha);
        Ok(GeneralizedAlpha::new("hht", 2, 0.0, alpha, beta, 0.5 + alpha))
    }

    /// Chung & Hulbert's optimal member with spectral radius ρ∞ at infinite frequency:
    /// αm = (2ρ∞ − 1)/(ρ∞ + 1), αf = ρ∞/(ρ∞ + 1), γ = ½ − αm + αf, β = ¼(γ + ½)². ρ∞ = 1 keeps high
    /// frequencies, ρ∞ = 0 annihilates them in one step.
    ///
    /// # Errors
    /// Outside 0 ≤ ρ∞ ≤ 1.
    pub fn chung_hulbert(spectral_radius: f64) -> Result<GeneralizedAlpha, InvalidParameter> {
        let rho = spectral_radius;
        if !(0.0..=1.0).contains(&rho) {
            let range = "0 ≤ ρ∞ ≤ 1";
            return Err(InvalidParameter { parameter: "spectral radius", value: rho, range });
        }
        let (alpha_m, alpha_f) = ((2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0));
        let gamma = 0.5 - alpha_m + alpha_f;
        let beta = 0.25 * (gamma + 0.5) * (gamma + 0.5);
        Ok(GeneralizedAlpha::new("generalized-alpha", 2, alpha_m, alpha_f, beta, gamma))
    }

    fn new(name: &'static str, order: usize, alpha_m: f64, alpha_f: f64, beta: f64, gamma: f64) -> Self {
        GeneralizedAlpha {
            info: Info { name, order, estimate_order: None, implicit: true },
            alpha_m,
            alpha_f,
            beta,
            gamma,
            stabilized: false,
            full: Convergence::full(ITERATION_TOLERANCE, 0.0),
            kept: Convergence::kept(KEPT_TOLERANCE, NOISE),
            counters: Counters::default(),
            worst: 0,
            pending: false,
            before: Vec::new(),
            earlier: Vec::new(),
            history: 0,
            a: Vec::new(),
            spacing: [0.0; 2],
            tolerance: None,
            d: Vec::new(),
            work: None,
        }
    }

    /// The same method on the stabilized form of index 2, in which ġ = 0 holds beside g = 0.
    pub fn stabilized(self) -> GeneralizedAlpha {
        GeneralizedAlpha { stabilized: true, ..self }
    }

    /// αm, αf, β, γ.
    pub fn parameters(&self) -> [f64; 4] {
        [self.alpha_m, self.alpha_f, self.beta, self.gamma]
    }

    /// κ = (1 − αf)/(1 − αm), by which an increment of q̈ moves the auxiliary acceleration.
    fn kappa(&self) -> f64 {
        (1.0 - self.alpha_f) / (1.0 - self.alpha_m)
    }

    /// Solves the equations of a step: with the kept tangent, and where that does not converge with new ones.
    fn solve(
        &mut self,
        work: &mut Work,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let kappa = self.kappa();
        let to = (to, [h * self.gamma * kappa, h * h * self.beta * kappa]);
        if !work.rows.is_empty() && work.stiffness.is_some() {
            work.rows.store_jacobian(system, from);
        }
        // To renew a constant tangent costs nothing, and makes the step exact.
        let free = work.affine && (work.constant || work.renewals == 1);
        let renew = work.age.due || free || !work.is_of(to.1);
        if !renew && self.iterate(work, system, from, h, (to.0, to.1), false)? {
            return Ok(self.report(work, false));
        }
        if self.iterate(work, system, from, h, (to.0, to.1), true)? {
            return Ok(self.report(work, false));
        }
        self.iterate_fully(work, system, from, h, to)?;
        Ok(self.report(work, true))
    }

    fn report(&self, work: &mut Work, full: bool) -> StepReport {
        let iterations = if full { self.full.iterations() } else { self.kept.iterations() };
        work.age.count(iterations);
        StepReport { iterations, error: None }
    }

    /// Simplified Newton iterations with one tangent, kept or made at the start of the step if `renew`; whether they
    /// converged.
    fn iterate(
        &mut self,
        work: &mut Work,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        (to, weights): (&mut State, [f64; 2]),
        renew: bool,
    ) -> Result<bool, StepError> {
        self.predict(system, from, h, to);
        work.mu.fill(0.0);
        if renew {
            self.kept.forget();
            work.corotation.clear();
        } else {
            system.corotate(&work.place, to, &mut work.corotation);
        }
        self.kept.begin(renew);
        loop {
            work.residual(system, to, weights);
            if renew && self.kept.iterations() == 0 {
                self.renew(work, system, from, h, (to, weights))?;
            }
            work.corotation.rotate_back(&mut work.rhs);
            work.tangent.solve(&mut work.rhs);
            work.corotation.rotate(&mut work.rhs);
            let size = self.update(work, system, from, h, (to, weights));
            let progress = self.kept.judge(size);
            if renew && work.affine && size.is_finite() {
                if self.kept.wants_rounding() && self.kept.iterations() == 1 && !work.constant {
                    continue;
                }
                if self.kept.iterations() > 1 {
                    self.kept.learn_rounding(size);
                }
                return Ok(true);
            }
            if progress == Progress::Converged {
                return Ok(true);
            }
            if progress == Progress::Diverged {
                return Ok(false);
            }
        }
    }

    /// Newton iterations with a new tangent each.
    fn iterate_fully(
        &mut self,
        work: &mut Work,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        (to, weights): (&mut State, [f64; 2]),
    ) -> Result<(), StepError> {
        self.predict(system, from, h, to);
        work.mu.fill(0.0);
        self.full.begin(true);
        loop {
            work.residual(system, to, weights);
            self.renew(work, system, from, h, (to, weights))?;
            work.tangent.solve(&mut work.rhs);
            let size = self.update(work, system, from, h, (to, weights));
            match self.full.judge(size) {
                Progress::Converged => return Ok(()),
                Progress::Continue => {}
                Progress::Diverged => {
                    work.kept = [f64::NAN; 2];
                    if !size.is_finite() {
                        return Err(failure::not_finite(system, from.t, h, to));
                    }
                    self.worst = worst(&work.rhs[..from.v.len()], system.scales());
                    return Err(StepError::NotConverged {
                        time: from.t,
                        step: h,
                        iterations: self.full.iterations(),
                        size: size / ITERATION_TOLERANCE,
                        worst: system.unknown(self.worst),
                    });
                }
            }
        }
    }

    /// A new tangent at `to`, factored.
    fn renew(
        &mut self,
        work: &mut Work,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        (to, weights): (&State, [f64; 2]),
    ) -> Result<(), StepError> {
        let factored = work
            .assemble(system, to, &self.d, h, weights)
            .map_err(|cause| failure::singular(system, from.t, h, cause))?;
        self.counters.tangents += u64::from(factored);
        self.counters.factorizations += u64::from(factored);
        work.kept = weights;
        work.renewals += 1;
        work.age = Age::renewed();
        work.constant = !factored;
        if factored {
            work.place.copy_from(to);
            if work.stiffness.is_some() {
                work.start.copy_from(from);
            }
            work.increment.copy_from_slice(&self.d);
        }
        Ok(())
    }

    /// Subtracts the solution in `work.rhs` from the unknowns; gives the size of the increment of q.
    fn update(
        &mut self,
        work: &mut Work,
        system: &dyn Dynamics,
        from: &State,
        h: f64,
        (to, [to_v, to_q]): (&mut State, [f64; 2]),
    ) -> f64 {
        self.counters.residuals += 1;
        self.counters.solves += 1;
        self.counters.iterations += 1;
        let n = from.v.len();
        let (x, multipliers) = work.rhs.split_at(n);
        let d = &mut self.d[..n];
        let (out_a, out_v, scale) = (&mut to.a[..n], &mut to.v[..n], &system.scales()[..n]);
        let mut square = 0.0;
        for i in 0..n {
            out_a[i] -= x[i];
            out_v[i] -= to_v * x[i];
            d[i] -= to_q * x[i];
            let scaled = x[i] / scale[i];
            square += scaled * scaled;
        }
        let mut finite = true;
        let (lambda, mu) = multipliers.split_at(to.lambda.len());
        for (lambda, x) in to.lambda.iter_mut().zip(lambda) {
            *lambda -= x;
            finite &= x.is_finite();
        }
        if !mu.is_empty() {
            for (mu, x) in work.mu.iter_mut().zip(mu) {
                *mu -= x;
                finite &= x.is_finite();
            }
            work.rows.add_transposed(-h, mu, d);
        }
        system.retract(&from.q, d, &mut to.q);
        if finite { to_q * (square / n.max(1) as f64).sqrt() } else { f64::NAN }
    }
}

impl Integrator for GeneralizedAlpha {
    fn info(&self) -> &Info {
        &self.info
    }

    fn start(&mut self, system: &mut dyn Dynamics, state: &mut State, _step: f64) -> Result<(), StepError> {
        let size = system.size();
        for buffer in [&mut self.before, &mut self.earlier, &mut self.a, &mut self.d] {
            buffer.clear();
            buffer.resize(size.v, 0.0);
        }
        let multipliers = if self.stabilized { 2 } else { 1 };
        let stabilized = self.stabilized && size.lambda > 0;
        let rows = Rows::new(system, state);
        let mut meeting = vec![Vec::new(); if stabilized { size.v } else { 0 }];
        for &(_, j, _) in rows.stored().iter().filter(|_| stabilized) {
            meeting[j].push((0, 0.0));
        }
        self.work = Some(Box::new(Work {
            tangent: Matrix::new(&system.structure(multipliers)),
            rhs: vec![0.0; size.v + multipliers * size.lambda],
            accelerations: if stabilized {
                Accelerations::new(system, state, RowWeights::ACCELERATION)
            } else {
                Accelerations::borrowing(system, state, RowWeights::ACCELERATION)
            },
            rows,
            mu: vec![0.0; size.lambda],
            stiffness: stabilized.then(|| Matrix::new(&system.structure(0))),
            meeting,
            affine: system.is_affine() && size.lambda == 0,
            kept: [f64::NAN; 2],
            place: State::zeros(size, state.t),
            start: State::zeros(if stabilized { size } else { Size::default() }, state.t),
            increment: vec![0.0; size.v],
            corotation: corotation(system, state),
            age: Age::default(),
            renewals: 0,
            constant: false,
        }));
        self.counters = Counters::default();
        // Iteration errors leave the momentum of a system whose tangent is rotated section by section.
        let exactly = size.lambda > 0 || !system.is_vector_space();
        self.kept = if exactly {
            Convergence::measured(ROWS_TOLERANCE, NOISE)
        } else {
            Convergence::kept(KEPT_TOLERANCE, NOISE)
        };
        if exactly {
            let places = state.q.iter().zip(system.scales()).map(|(q, scale)| (q / scale).abs());
            self.kept.learn_rounding(0.25 * f64::EPSILON * places.fold(1.0, f64::max));
        }
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
            return Err(StepError::NotStarted { method: self.info.name });
        };
        self.counters.rejected += u64::from(self.pending);
        self.pending = true;
        let result = self.solve(&mut work, system, from, h, to);
        self.work = Some(work);
        Ok(StepReport { error: self.estimate(system.scales(), (from, to), h), ..result? })
    }

    fn discard(&mut self) {
        self.pending = false;
    }

    fn accept(&mut self, from: &State, to: &State) {
        let next = self.auxiliary(self.spacing[1]);
        let accelerations = from.a.iter().zip(&to.a);
        self.a.iter_mut().zip(accelerations).for_each(|(a, (from, to))| *a = next(*a, *from, *to));
        std::mem::swap(&mut self.before, &mut self.earlier);
        self.before.copy_from_slice(&from.a);
        self.history = (self.history + 1).min(2);
        self.spacing[0] = self.spacing[1];
        self.pending = false;
        self.counters.steps += 1;
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        hermite::cubic(system, from, to, &self.d, t, out);
    }

    fn restart(&mut self, system: &mut dyn Dynamics, state: &mut State) -> Result<(), StepError> {
        let Some(work) = &mut self.work else {
            return Err(StepError::NotStarted { method: self.info.name });
        };
        self.pending = false;
        (self.history, self.spacing) = (0, [0.0; 2]);
        self.kept.forget();
        (work.age, work.renewals) = (Age::default(), 0);
        work.kept = [f64::NAN; 2];
        state.side = Side::Right;
        let place = (state.t, 0.0);
        let Work { accelerations, tangent, rhs, stiffness, .. } = &mut **work;
        if stiffness.is_some() {
            accelerations.complete(system, state, place, &mut self.counters)?;
        } else {
            accelerations.complete_in((tangent, rhs), system, state, place, &mut self.counters)?;
        }
        self.a.copy_from_slice(&state.a);
        Ok(())
    }

    fn save(&self, out: &mut Checkpoint) {
        out.put("counters", &self.counters.to_numbers());
        out.put("auxiliary", &self.a);
        out.put("before", &self.before);
        out.put("earlier", &self.earlier);
        out.put("history", &[f64::from(self.history), self.spacing[0]]);
        out.put("convergence", &self.kept.memory());
        if let Some(work) = &self.work {
            out.put("tangent.weights", &work.kept);
            let flag = |flag| f64::from(u8::from(flag));
            let Age { cost, steps, due } = work.age;
            out.put("tangent.age", &[cost, steps, flag(due), flag(work.constant), f64::from(work.renewals)]);
            out.put_state("tangent.", &work.place);
            out.put_state("tangent.start.", &work.start);
            out.put("tangent.increment", &work.increment);
        }
    }

    fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        let Some(work) = &mut self.work else {
            return Err(NotResumed::Failed(format!("{} was not started", self.info.name)));
        };
        from.fill("auxiliary", &mut self.a)?;
        from.fill("before", &mut self.before)?;
        from.fill("earlier", &mut self.earlier)?;
        let [history, spacing] = from.numbers("history")?;
        (self.history, self.spacing[0]) = (history as u8, spacing);
        self.kept.recall(from.numbers("convergence")?);
        work.kept = from.numbers("tangent.weights")?;
        let [cost, steps, due, constant, renewals] = from.numbers("tangent.age")?;
        work.age = Age { cost, steps, due: due != 0.0 };
        (work.constant, work.renewals) = (constant != 0.0, renewals as u32);
        from.fill_state("tangent.", &mut work.place)?;
        from.fill_state("tangent.start.", &mut work.start)?;
        from.fill("tangent.increment", &mut work.increment)?;
        let [v, q] = work.kept;
        if v.is_finite() && q.is_finite() {
            // The same tangent at the same place has the same factors.
            let h = v / (self.gamma * (1.0 - self.alpha_f) / (1.0 - self.alpha_m));
            work.reassemble(system, h).map_err(|e| NotResumed::Failed(format!("{}: {e}", self.info.name)))?;
        }
        self.counters = Counters::from_numbers(from.numbers("counters")?);
        Ok(())
    }

    fn worst(&self) -> usize {
        self.worst
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

/// Index of the largest entry of `x` in units of the scales.
fn worst(x: &[f64], scales: &[f64]) -> usize {
    let sizes = x.iter().zip(scales).map(|(x, scale)| (x / scale).abs());
    let largest = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
    largest.map_or(0, |(i, _)| i)
}
