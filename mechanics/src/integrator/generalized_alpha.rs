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
//! ⎡ M + hγκ C + h²βκ K   Gᵀ⎤ ⎡Δq̈⎤     ⎡ r           ⎤
//! ⎣ G                    0 ⎦ ⎣Δλ⎦ = − ⎣ g / (h² βκ) ⎦
//! ```
//!
//! whose condition does not deteriorate as h → 0: this is the scaling of index-3 equations of Bottasso,
//! Bauchau & Cardona (2007, doi 10.1137/050638503) without a separate pass for it.
//!
//! The tangent and its factors are kept from step to step until the iterations that their age costs are dearer than
//! new ones: see [`Wear`]; until then it is carried along with the turning sections (see [`System::turns`]), without which
//! the stretching stiffness of a slender beam points in wrong directions soon. An affine system is solved exactly by one iteration with the tangent of its step; a second
//! one then shows the size of rounding errors, below which no later step iterates (see [`Convergence`]). Systems
//! with constraints get a new tangent every iteration.
//! The predictor is q̈ₙ₊₁ = q̈ₙ + q̈ₙ₋₁ − q̈ₙ₋₂: exact for accelerations linear in time, and for those that change their
//! sign from step to step, as vibrations far too fast for the step do for ever in a method without dissipation.
//!
//! Order: 2 in q, v and λ for γ = ½ + αf − αm (measured 2.00, also for index-3 constraints). Stability:
//! unconditional on linear systems for the constructors here. Dense output: cubic in q, linear in q̈.
//!
//! Sources: Newmark (1959, doi 10.1061/JMCEA3.0000098); Hilber, Hughes & Taylor (1977,
//! doi 10.1002/eqe.4290050306); Chung & Hulbert (1993, doi 10.1115/1.2900803); Arnold & Brüls (2007,
//! doi 10.1007/s11044-007-9084-0).

use super::acceleration::Accelerations;
use super::{
    Checkpoint, Convergence, Counters, Info, Integrator, InvalidParameter, NotResumed, Progress, StepError,
    StepReport, failure, hermite,
};
use crate::linalg::Matrix;
use crate::system::{Level, State, System, Turns, Weights};

/// Iteration error, relative to the scales of the unknowns, at which Newton's method stops: far below
/// the truncation error of a second-order method at any useful step.
const ITERATION_TOLERANCE: f64 = 1e-10;

/// The same where the tangent is kept and the iteration converges linearly. The balance of energy shows ten times as
/// much: its error would not fall with the square of the step.
const KEPT_TOLERANCE: f64 = 1e-13;

/// Largest size of increments that are taken for rounding errors when they suddenly stop shrinking.
const NOISE: f64 = 1e-7;

/// Cost of a tangent and its factors, in iterations.
const RENEWAL: f64 = 2.0;

/// What kept factors have cost in iterations.
///
/// Their price grows with their age, their renewal costs [`RENEWAL`] at once. The cheapest age to renew them at is
/// that at which the next step would cost more than the average step of their life so far, renewal included.
#[derive(Clone, Copy, Debug, Default)]
struct Wear {
    spent: f64,
    steps: f64,
    due: bool,
}

impl Wear {
    /// Factors were made.
    fn renew(&mut self) {
        *self = Wear { spent: RENEWAL, steps: 0.0, due: false };
    }

    /// A step took so many iterations.
    fn count(&mut self, iterations: u32) {
        self.spent += f64::from(iterations);
        self.steps += 1.0;
        self.due = f64::from(iterations) * self.steps > self.spent;
    }

    fn to_numbers(self) -> [f64; 3] {
        [self.spent, self.steps, f64::from(u8::from(self.due))]
    }

    fn from_numbers([spent, steps, due]: [f64; 3]) -> Wear {
        Wear { spent, steps, due: due != 0.0 }
    }
}

/// The generalized-α method. See the [module documentation](self) for formulas and sources.
#[derive(Debug)]
pub struct GeneralizedAlpha {
    info: Info,
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
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
    /// Auxiliary acceleration aₙ, and aₙ₊₁ of the attempt.
    a: Vec<f64>,
    a_next: Vec<f64>,
    /// Increment d of the attempt, and of the accepted step.
    d: Vec<f64>,
    d_accepted: Vec<f64>,
    /// 1/scale of the unknowns.
    inverse_scale: Vec<f64>,
    work: Option<Box<Work>>,
}

/// What `start` allocates for a system.
#[derive(Debug)]
struct Work {
    tangent: Matrix,
    rhs: Vec<f64>,
    accelerations: Accelerations,
    affine: bool,
    /// Whether factors may be kept; the weights (of v and q) that the present ones belong to, NaN without.
    keeps: bool,
    kept: [f64; 2],
    /// Where the kept tangent was formed: state and increment.
    place: State,
    increment: Vec<f64>,
    /// How the sections have turned since.
    turns: Turns,
    wear: Wear,
    /// Whether the tangent of an affine system is, as far as known, the same at all times.
    constant: bool,
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
            full: Convergence::full(ITERATION_TOLERANCE),
            kept: Convergence::kept(KEPT_TOLERANCE, ITERATION_TOLERANCE).with_noise(NOISE),
            counters: Counters::default(),
            worst: 0,
            pending: false,
            before: Vec::new(),
            earlier: Vec::new(),
            history: 0,
            a: Vec::new(),
            a_next: Vec::new(),
            d: Vec::new(),
            d_accepted: Vec::new(),
            inverse_scale: Vec::new(),
            work: None,
        }
    }

    /// αm, αf, β, γ.
    pub fn parameters(&self) -> [f64; 4] {
        [self.alpha_m, self.alpha_f, self.beta, self.gamma]
    }

    /// κ = (1 − αf)/(1 − αm), by which an increment of q̈ moves the auxiliary acceleration.
    fn kappa(&self) -> f64 {
        (1.0 - self.alpha_f) / (1.0 - self.alpha_m)
    }

    /// Starting values of the step: the accelerations of the last three steps, continued.
    fn predict(&mut self, system: &dyn System, from: &State, h: f64, to: &mut State) {
        let n = from.v.len();
        let (alpha_m, beta, gamma, kappa) = (self.alpha_m, self.beta, self.gamma, self.kappa());
        let (v_old, v_new) = (h * (1.0 - gamma), h * gamma);
        let (d_old, d_new) = (h * h * (0.5 - beta), h * h * beta);
        let (from_a, from_v) = (&from.a[..n], &from.v[..n]);
        // The trend: of the last step at first, then of the one before it.
        let (later, sooner) = match self.history {
            0 => (from_a, from_a),
            1 => (from_a, &self.before[..n]),
            _ => (&self.before[..n], &self.earlier[..n]),
        };
        let (a, a_next, d) = (&self.a[..n], &mut self.a_next[..n], &mut self.d[..n]);
        let (out_a, out_v) = (&mut to.a[..n], &mut to.v[..n]);
        let lag = 1.0 / (1.0 - alpha_m);
        for i in 0..n {
            let change = later[i] - sooner[i];
            let next = (from_a[i] - alpha_m * a[i]) * lag + kappa * change;
            a_next[i] = next;
            out_a[i] = from_a[i] + change;
            out_v[i] = from_v[i] + v_old * a[i] + v_new * next;
            d[i] = h * from_v[i] + d_old * a[i] + d_new * next;
        }
        to.lambda.copy_from_slice(&from.lambda);
        to.t = from.t + h;
        system.retract(&from.q, d, &mut to.q);
    }

    /// Solves the equations of a step.
    fn solve(
        &mut self,
        work: &mut Work,
        system: &mut dyn System,
        from: &State,
        h: f64,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let n = from.v.len();
        let kappa = self.kappa();
        let (to_v, to_q) = (h * self.gamma * kappa, h * h * self.beta * kappa);

        // Whether every iteration has a tangent of its own, and whether the next one needs a new tangent.
        let mut full = !work.keeps;
        let mut renew = full || work.kept != [to_v, to_q] || work.wear.due || work.constant;
        'attempt: loop {
            self.predict(system, from, h, to);
            let convergence = if full { &mut self.full } else { &mut self.kept };
            if renew {
                convergence.forget();
                work.turns.clear();
            } else {
                system.turns(&work.place, to, &mut work.turns);
            }
            convergence.begin(renew);
            let (a_next, d) = (&mut self.a_next[..n], &mut self.d[..n]);
            // Whether the tangent is that of this step, and whether it was made for it.
            let (mut exact, mut made) = (false, false);
            loop {
                let (motion, constraints) = work.rhs.split_at_mut(n);
                system.residual(to, motion);
                if !constraints.is_empty() {
                    system.constraint(to, Level::Position, constraints);
                    for g in constraints.iter_mut() {
                        *g /= to_q;
                    }
                }
                if renew {
                    let weights =
                        Weights { q: to_q, v: to_v, a: 1.0, increment: Some(d), level: Level::Position };
                    system.tangent(to, weights, &mut work.tangent);
                    let factored =
                        work.tangent.factor().map_err(|e| failure::singular(system, from.t, h, e))?;
                    self.counters.tangents += u64::from(factored);
                    self.counters.factorizations += u64::from(factored);
                    // The first tangent is the only one until a second one is another.
                    work.constant = work.affine && (!factored || work.kept != [to_v, to_q]);
                    work.kept = [to_v, to_q];
                    if factored {
                        work.place.copy_from(to);
                        work.increment.copy_from_slice(d);
                    }
                    work.wear.renew();
                    (exact, made) = (work.affine, factored);
                    renew = full && !exact;
                }
                work.turns.turn_back(&mut work.rhs);
                work.tangent.solve(&mut work.rhs);
                work.turns.turn(&mut work.rhs);
                self.counters.residuals += 1;
                self.counters.solves += 1;
                self.counters.iterations += 1;

                let (x, multipliers) = work.rhs.split_at(n);
                let (out_a, out_v, scale) = (&mut to.a[..n], &mut to.v[..n], &self.inverse_scale[..n]);
                let mut square = 0.0;
                for i in 0..n {
                    out_a[i] -= x[i];
                    a_next[i] -= kappa * x[i];
                    out_v[i] -= to_v * x[i];
                    d[i] -= to_q * x[i];
                    let scaled = x[i] * scale[i];
                    square += scaled * scaled;
                }
                for (lambda, x) in to.lambda.iter_mut().zip(multipliers) {
                    *lambda -= x;
                    square += 0.0 * x; // a multiplier that is not finite must not pass unseen
                }
                system.retract(&from.q, d, &mut to.q);
                let size = to_q * (square / n.max(1) as f64).sqrt();
                let progress = convergence.judge(size);
                let iterations = convergence.iterations();
                if exact && size.is_finite() {
                    if made && !work.constant && iterations == 1 {
                        continue;
                    }
                    // What is left by an exact solution is rounding error.
                    if iterations > 1 {
                        self.kept.learn_rounding(size);
                    }
                    work.wear.count(iterations);
                    return Ok(StepReport { iterations, error: None });
                }
                match progress {
                    Progress::Converged => {
                        self.worst = worst(x, scale);
                        work.wear.count(iterations);
                        return Ok(StepReport { iterations, error: None });
                    }
                    Progress::Continue => {}
                    Progress::Diverged if !full => {
                        (full, renew) = (true, true);
                        continue 'attempt;
                    }
                    Progress::Diverged => {
                        self.worst = worst(x, scale);
                        work.kept = [f64::NAN; 2];
                        if !size.is_finite() {
                            return Err(failure::not_finite(system, from.t, h, to));
                        }
                        return Err(StepError::NotConverged {
                            time: from.t,
                            step: h,
                            iterations: convergence.iterations(),
                            size: size / ITERATION_TOLERANCE,
                            worst: failure::label(system, self.worst),
                        });
                    }
                }
            }
        }
    }
}

impl Integrator for GeneralizedAlpha {
    fn info(&self) -> &Info {
        &self.info
    }

    fn start(&mut self, system: &mut dyn System, state: &mut State, _step: f64) -> Result<(), StepError> {
        let size = system.size();
        let n = size.v + size.lambda;
        for buffer in [
            &mut self.before,
            &mut self.earlier,
            &mut self.a,
            &mut self.a_next,
            &mut self.d,
            &mut self.d_accepted,
        ] {
            buffer.clear();
            buffer.resize(size.v, 0.0);
        }
        self.inverse_scale.clear();
        self.inverse_scale.extend(system.labels().iter().map(|label| 1.0 / label.scale));
        self.inverse_scale.resize(n, 1.0);
        self.work = Some(Box::new(Work {
            tangent: Matrix::new(&system.structure()),
            rhs: vec![0.0; n],
            accelerations: Accelerations::new(system),
            affine: system.is_affine() && size.lambda == 0,
            keeps: size.lambda == 0,
            kept: [f64::NAN; 2],
            place: State::zeros(size, state.t),
            increment: vec![0.0; size.v],
            turns: Turns::with_room(size.v),
            wear: Wear::default(),
            constant: false,
        }));
        self.counters = Counters::default();
        self.restart(system, state)
    }

    fn step(
        &mut self,
        system: &mut dyn System,
        from: &State,
        h: f64,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let Some(mut work) = self.work.take() else {
            return Err(StepError::NotStarted { method: self.info.name });
        };
        self.counters.rejected += u64::from(self.pending);
        self.pending = true;
        let result = self.solve(&mut work, system, from, h, to);
        self.work = Some(work);
        result
    }

    fn accept(&mut self, from: &State, _to: &State) {
        std::mem::swap(&mut self.before, &mut self.earlier);
        self.before.copy_from_slice(&from.a);
        self.history = (self.history + 1).min(2);
        std::mem::swap(&mut self.a, &mut self.a_next);
        std::mem::swap(&mut self.d, &mut self.d_accepted);
        self.pending = false;
        self.counters.steps += 1;
    }

    fn interpolate(&self, system: &dyn System, from: &State, to: &State, t: f64, out: &mut State) {
        hermite::cubic(system, from, to, &self.d_accepted, t, out);
    }

    fn restart(&mut self, system: &mut dyn System, state: &mut State) -> Result<(), StepError> {
        let Some(work) = &mut self.work else {
            return Err(StepError::NotStarted { method: self.info.name });
        };
        self.pending = false;
        self.history = 0;
        self.kept.forget();
        work.kept = [f64::NAN; 2];
        let place = (state.t, 0.0);
        work.accelerations.complete(system, state, place, &mut self.counters)?;
        self.a.copy_from_slice(&state.a);
        Ok(())
    }

    fn save(&self, out: &mut Checkpoint) {
        out.put("counters", &self.counters.to_numbers());
        out.put("auxiliary", &self.a);
        out.put("before", &self.before);
        out.put("earlier", &self.earlier);
        out.put("history", &[f64::from(self.history)]);
        out.put("convergence", &self.kept.memory());
        if let Some(work) = &self.work {
            out.put("tangent.weights", &work.kept);
            out.put("tangent.wear", &work.wear.to_numbers());
            out.put("tangent.constant", &[f64::from(u8::from(work.constant))]);
            out.put_state("tangent.", &work.place);
            out.put("tangent.increment", &work.increment);
        }
    }

    fn resume(&mut self, system: &mut dyn System, from: &Checkpoint) -> Result<(), NotResumed> {
        let Some(work) = &mut self.work else {
            return Err(NotResumed::Failed(format!("{} was not started", self.info.name)));
        };
        from.fill("auxiliary", &mut self.a)?;
        from.fill("before", &mut self.before)?;
        from.fill("earlier", &mut self.earlier)?;
        let [history] = from.numbers("history")?;
        self.history = history as u8;
        self.kept.recall(from.numbers("convergence")?);
        work.kept = from.numbers("tangent.weights")?;
        work.wear = Wear::from_numbers(from.numbers("tangent.wear")?);
        let [constant] = from.numbers("tangent.constant")?;
        work.constant = constant != 0.0;
        from.fill_state("tangent.", &mut work.place)?;
        from.fill("tangent.increment", &mut work.increment)?;
        let [v, q] = work.kept;
        if work.keeps && v.is_finite() && q.is_finite() {
            // The same tangent at the same place has the same factors.
            let weights = Weights { q, v, a: 1.0, increment: Some(&work.increment), level: Level::Position };
            system.tangent(&work.place, weights, &mut work.tangent);
            work.tangent.factor().map_err(|e| NotResumed::Failed(format!("{}: {e}", self.info.name)))?;
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
fn worst(x: &[f64], inverse_scale: &[f64]) -> usize {
    let mut found = (0, 0.0);
    for (i, (x, scale)) in x.iter().zip(inverse_scale).enumerate() {
        let size = (x * scale).abs();
        if size > found.1 || !size.is_finite() {
            found = (i, size);
        }
        if !size.is_finite() {
            break;
        }
    }
    found.0
}
