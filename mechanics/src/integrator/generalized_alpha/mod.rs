//! The generalized-α family: Newmark, HHT-α, Chung–Hulbert; second order, fixed step.
//!
//! ```text
//! r(tₙ₊₁, qₙ₊₁, vₙ₊₁, q̈ₙ₊₁, λₙ₊₁) = 0,   g(tₙ₊₁, qₙ₊₁) = 0                    exactly at the end of a step
//! (1 − αm) aₙ₊₁ + αm aₙ = (1 − αf) q̈ₙ₊₁ + αf q̈ₙ
//! qₙ₊₁ = qₙ ⊞ d,   d = h vₙ + h² ((½ − β) aₙ + β aₙ₊₁)
//! vₙ₊₁ = vₙ + h ((1 − γ) aₙ + γ aₙ₊₁)
//! ```
//!
//! q̈ is the acceleration of the equations of motion (`State::a`), a the auxiliary one (`Auxiliary::a`); with αm = αf = 0 they are the
//! same. As in Arnold & Brüls, and other than in Chung & Hulbert, the equations hold at tₙ₊₁ and not between tₙ and tₙ₊₁; for a linear
//! system both forms have the same amplification matrix. A run begins with a₀ = q̈₀. The unknowns of a step are q̈ₙ₊₁ and λₙ₊₁. With κ = (1 − αf)/(1 − αm) an increment Δq̈ moves v by hγκ Δq̈
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
//! This is the form of systems with contacts that may open. Events shorten steps, from h to h′, and behind one of them the form of index 3
//! asks for the acceleration of size ġ h/h′² that brings back g, which its ġ, held by no equation, has moved: forces of contacts would grow
//! without bound.
//!
//! Newton's method is modified: tangent and factors are kept from step to step, and made anew as soon as a step takes more
//! iterations than the mean step since the last renewal, the cost of the renewal included (`../kept.rs`). An iteration with one tangent ends when the
//! increments are small (`../newton.rs`); with constraints or rotations, when they are rounding errors; and the forces of joints have settled (`../joint_forces.rs`).
//! Newton's method proper, which follows where that fails and in Euler steps, ends at 10⁻¹⁰. An affine system is solved exactly
//! by one iteration with the tangent of its step.
//! The predictor is q̈ₙ₊₁ = q̈ₙ + q̈ₙ₋₁ − q̈ₙ₋₂: exact for accelerations linear in time in equal steps, and for those of undamped frequencies far above
//! 1/h, which change their sign at each step of a method without dissipation. Until three accelerations are known it is constant, then linear; λ is that of the last step.
//!
//! Behind a jump of a force on little mass h² q̈ₙ is no displacement of a step. Where in the first step behind a restart Newton's method
//! fails, or ½h² (q̈ₙ₊₁ − q̈ₙ) is more than the scale of an unknown, three steps are those of the implicit Euler method,
//!
//! ```text
//! vₙ₊₁ = vₙ + h q̈ₙ₊₁,   d = h vₙ₊₁
//! ```
//!
//! in which position, velocity and acceleration of what is far faster than the step come to rest, one after the other (Rannacher's start). So
//! they are where one of the first three steps behind an event of contacts, or a jump of velocities, has an acceleration at its end that is nothing like
//! that at its start, with a change w of more than half of |q̈ₙ| + |q̈ₙ₊₁|, and damping brings w to rest within the step, h wᵀCw > wᵀMw: the trapezium would let
//! it ring, and forces of contacts with it. The first of these steps may be as short as the event leaves it, and tell nothing. Vibrations without damping keep their
//! energy. Unknowns without mass have no accelerations that tell.
//! Their errors of h² do not add up: the method keeps its order.
//!
//! Steps may change their size (`auxiliary.rs`).
//!
//! Order: 2 in q, v and λ for γ = ½ + αf − αm (measured 2.00, also for constraints of index 3 and in the stabilized
//! form, and on rotations). Stability: unconditional on linear systems for the constructors here. Dense output: cubic
//! in q, linear in q̈.
//!
//! Sources: Newmark (1959, doi 10.1061/JMCEA3.0000098); Hilber, Hughes & Taylor (1977,
//! doi 10.1002/eqe.4290050306); Chung & Hulbert (1993, doi 10.1115/1.2900803); Arnold & Brüls (2007,
//! doi 10.1007/s11044-007-9084-0); Gear, Gupta & Leimkuhler (1985, doi 10.1016/0377-0427(85)90008-1); Arnold, Brüls &
//! Cardona (2015, doi 10.1007/s00211-014-0633-1); Rannacher (1984, doi 10.1007/BF01390130).

mod equations;
mod family;

use super::auxiliary::{Auxiliary, Parameters};
use super::joint_forces::JointForces;
use super::kept::KeptTangent;
use super::{
    Attempt, Checkpoint, Convergence, Counters, NotResumed, Progress, Span, StepError, StepReport, Stepper,
    failure, hermite,
};
use crate::system::{Dynamics, Mode, RowWeights, Set, State};
use equations::Equations;
pub use family::GeneralizedAlpha;

/// Iteration error, relative to the scales of the unknowns, at which Newton's method stops: far below
/// the truncation error of a second-order method at any useful step.
const ITERATION_TOLERANCE: f64 = 1e-10;

/// The same where the tangent is kept and the iteration converges linearly. The balance of energy shows ten times as
/// much: its error would not fall with the square of the step.
const KEPT_TOLERANCE: f64 = 1e-13;

/// The same for systems with constraints or rotations: the rounding error of a position, for an error δ of g is an error δ/(h²βκ) of λ.
const ROWS_TOLERANCE: f64 = 1e-16;

/// Part of the largest force of a joint by which forces of joints may change in the last iteration.
const FORCES: f64 = 1e-5;

/// Largest size of increments that may be rounding errors.
const NOISE: f64 = 1e-7;

/// Steps of the implicit Euler method behind a jump that the method itself does not follow.
const EULER_STEPS: u8 = 3;

/// Steps behind a blow that are judged: the first of them may be as short as an event leaves it.
const JUDGED: u8 = 3;

/// Part of the accelerations at both ends of a step by which those change that ring.
const RINGING: f64 = 0.5;

/// Rate of decay of what rings, over 1/h.
const DAMPED: f64 = 1.0;

/// Part of the velocities by which they are moved to find what damping does.
const PROBED: f64 = 1e-3;

/// Which tangent an iteration has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Tangents {
    /// That of an earlier step.
    Kept,
    /// One of this step.
    New,
    /// A new one in every iteration: Newton's method proper.
    Newton,
}

/// The method with its memory.
#[derive(Debug)]
pub(in crate::integrator) struct AlphaSteps {
    auxiliary: Auxiliary,
    trend: Trend,
    /// Increment d of the attempt.
    d: Vec<f64>,
    equations: Equations,
    kept: KeptTangent,
    /// Of iterations with one tangent, and of Newton's method proper.
    simplified: Convergence,
    full: Convergence,
    forces: JointForces,
    /// An affine system without rows: its tangents since the restart, and whether the last one was found unchanged.
    affine: bool,
    renewals: u32,
    constant: bool,
    /// Whether no step has been taken since the restart.
    begins: bool,
    /// Steps of the implicit Euler method that are left, with that of the attempt: an attempt that chooses it does so for the shorter ones from the same state too.
    euler: u8,
    /// Whether the accepted step is one of them.
    line: bool,
    /// Steps behind a blow that are still to be judged.
    struck: u8,
}

/// Accelerations q̈ₙ₋₁ and q̈ₙ₋₂, and how many of them are known.
#[derive(Debug)]
struct Trend {
    before: Vec<f64>,
    earlier: Vec<f64>,
    known: u8,
}

impl AlphaSteps {
    /// Iterates with the kept tangent, where that does not converge with a new one, and at last with a new one each time.
    fn solve(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        self.equations.begin(system, from);
        if self.euler > 0 {
            return self.solve_euler(system, from, h, to, counters);
        }
        // To renew a constant tangent costs nothing, and makes the step exact.
        let free = self.affine && (self.constant || self.renewals == 1);
        let kept = !self.kept.due && !free && self.kept.serves(self.auxiliary.parameters.weights(h));
        let order = [Tangents::Kept, Tangents::New, Tangents::Newton];
        let mut iterations = None;
        for tangents in order.into_iter().skip(usize::from(!kept)) {
            iterations = match self.iterate(system, (from, to), h, tangents, counters) {
                Err(failed) if self.begins => {
                    self.euler = EULER_STEPS;
                    return self.solve_euler(system, from, h, to, counters).map_err(|_| failed);
                }
                other => other?,
            };
            if iterations.is_some() {
                break;
            }
        }
        let begins = self.begins && !self.affine && jumps(system, from, to, h);
        let struck = self.struck > 0 && !self.equations.is_massless();
        if begins || struck && self.rings(system, from, to, h) {
            self.euler = EULER_STEPS;
            return self.solve_euler(system, from, h, to, counters);
        }
        let iterations = iterations.unwrap_or_default();
        self.kept.age(iterations);
        Ok(StepReport { iterations, ..StepReport::default() })
    }

    /// A step of the implicit Euler method, by Newton's method proper.
    fn solve_euler(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        let result = self.iterate(system, (from, to), h, Tangents::Newton, counters);
        if result.is_err() {
            self.euler = 0;
        }
        Ok(StepReport { iterations: result?.unwrap_or_default(), ..StepReport::default() })
    }

    /// What an increment of q̈ₙ₊₁ moves v and q by.
    fn weights(&self, h: f64) -> [f64; 2] {
        if self.euler > 0 { [h, h * h] } else { self.auxiliary.parameters.weights(h) }
    }

    /// Predicts and iterates; gives the number of iterations, none where they do not converge with one tangent.
    fn iterate(
        &mut self,
        system: &mut dyn Dynamics,
        (from, to): (&State, &mut State),
        h: f64,
        tangents: Tangents,
        counters: &mut Counters,
    ) -> Result<Option<u32>, StepError> {
        let weights = self.weights(h);
        self.predict(system, from, h, to);
        self.begin(system, to, tangents);
        let mut moved = Progress::Continue;
        for iterations in 1.. {
            self.equations.residual(system, to, weights);
            if tangents == Tangents::Newton || (tangents == Tangents::New && iterations == 1) {
                self.renew(system, (from, to), h, counters)?;
            }
            let Equations { tangent, rhs, .. } = &mut self.equations;
            self.kept.solve(tangent, rhs);
            self.forces.begin(iterations == 1);
            let size = self.update(system, from, h, to);
            counters.add_iteration();
            // Increments that have converged are rounding errors from then on.
            if moved != Progress::Converged {
                moved = self.judge(tangents, size);
            }
            let held = moved == Progress::Converged && tangents != Tangents::Newton;
            match if held { self.forces.judge_and_learn(tangents == Tangents::New) } else { moved } {
                Progress::Converged => return Ok(Some(iterations)),
                Progress::Continue => {}
                Progress::Diverged if tangents == Tangents::Newton => {
                    self.kept.weights = [f64::NAN; 2];
                    return Err(match self.loose(system, from, h) {
                        Some(rate) => StepError::Loose { time: from.t, step: h, rate },
                        None => self.diverged(system, (from.t, h), size, to),
                    });
                }
                Progress::Diverged => break,
            }
        }
        Ok(None)
    }

    /// Starting values: the accelerations of the last three steps, continued, or none.
    fn predict(&mut self, system: &dyn Dynamics, from: &State, h: f64, to: &mut State) {
        let n = from.v.len();
        let formulas = self.auxiliary.attempt(h);
        let (from_a, from_v, a) = (&from.a[..n], &from.v[..n], &self.auxiliary.a[..n]);
        let Trend { before, earlier, known } = &self.trend;
        // Of the last step at first, then of the one before it.
        let (later, sooner) = match known {
            0 => (from_a, from_a),
            1 => (from_a, &before[..n]),
            _ => (&before[..n], &earlier[..n]),
        };
        let (d, out_a, out_v) = (&mut self.d[..n], &mut to.a[..n], &mut to.v[..n]);
        if self.euler > 0 {
            out_a.fill(0.0);
            out_v.copy_from_slice(from_v);
            d.iter_mut().zip(from_v).for_each(|(d, v)| *d = h * v);
        } else {
            for i in 0..n {
                out_a[i] = from_a[i] + (later[i] - sooner[i]);
                [out_v[i], d[i]] = formulas.motion(a[i], from_v[i], from_a[i], out_a[i]);
            }
        }
        to.lambda.copy_from_slice(&from.lambda);
        to.copy_modes(from);
        system.retract(&from.q, d, &mut to.q);
    }

    fn begin(&mut self, system: &dyn Dynamics, to: &State, tangents: Tangents) {
        self.equations.mu.fill(0.0);
        match tangents {
            Tangents::Kept => self.kept.rotate_to(system, to),
            Tangents::New => {
                self.simplified.forget();
                self.kept.unrotate();
            }
            Tangents::Newton => {
                self.kept.unrotate();
                return self.full.begin(true);
            }
        }
        self.simplified.begin(tangents == Tangents::New);
    }

    /// A new tangent at `to`, factored.
    fn renew(
        &mut self,
        system: &mut dyn Dynamics,
        (from, to): (&State, &State),
        h: f64,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let weights = self.weights(h);
        let factored = self
            .equations
            .assemble(system, to, &self.d, h, weights)
            .map_err(|cause| failure::singular(system, from.t, h, cause))?;
        counters.tangents += u64::from(factored);
        counters.factorizations += u64::from(factored);
        self.kept.renewed();
        self.kept.weights = weights;
        self.renewals += 1;
        self.constant = !factored;
        if factored {
            self.kept.place.copy_from(to);
            self.equations.remember(from, &self.d, h);
        }
        Ok(())
    }

    /// Subtracts the solution from the unknowns; gives the size of the increment of q.
    fn update(&mut self, system: &dyn Dynamics, from: &State, h: f64, to: &mut State) -> f64 {
        let n = from.v.len();
        let [to_v, to_q] = self.weights(h);
        let (x, multipliers) = self.equations.rhs.split_at(n);
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
        let (lambda, mu) = multipliers.split_at(to.lambda.len());
        for ((set, value), x) in system.rows().iter().zip(&mut to.lambda).zip(lambda) {
            *value -= x;
            self.forces.enter(*set, *x, *value);
        }
        if !mu.is_empty() {
            self.equations.mu.iter_mut().zip(mu).for_each(|(mu, x)| *mu -= x);
            self.equations.rows.add_transposed(-h, mu, d);
        }
        system.retract(&from.q, d, &mut to.q);
        let finite = multipliers.iter().all(|x| x.is_finite());
        if finite { to_q * (square / n.max(1) as f64).sqrt() } else { f64::NAN }
    }

    /// The verdict on an increment of this size. The first one of an affine system with its own tangent is exact.
    fn judge(&mut self, tangents: Tangents, size: f64) -> Progress {
        if tangents == Tangents::Newton {
            return self.full.judge(size);
        }
        let progress = self.simplified.judge(size);
        if !(tangents == Tangents::New && self.affine && size.is_finite()) {
            return progress;
        }
        let first = self.simplified.iterations() == 1;
        if first && self.simplified.wants_rounding() && !self.constant {
            return Progress::Continue;
        }
        if !first {
            self.simplified.learn_rounding(size);
        }
        Progress::Converged
    }

    /// The largest rate at `from` of a row that is held by its position alone, if a step at this rate goes farther than rounding: of joints
    /// in a method without dissipation, and of closed contacts, behind steps that events have shortened.
    fn loose(&self, system: &mut dyn Dynamics, from: &State, h: f64) -> Option<f64> {
        let undamped = self.auxiliary.parameters.gamma == 0.5;
        if self.equations.is_stabilized() || from.lambda.is_empty() {
            return None;
        }
        let mut rates = vec![0.0; from.lambda.len()];
        system.constraint(from, RowWeights::VELOCITY, &mut rates);
        let mut largest = 0.0_f64;
        for ((rate, set), mode) in rates.iter().zip(system.rows()).zip(&from.mode) {
            let held = match set {
                Set::Free => undamped,
                Set::Unilateral { .. } => *mode == Mode::Closed,
                Set::Friction { .. } => false,
            };
            largest = largest.max(if held { rate.abs() } else { 0.0 });
        }
        (largest * h > NOISE).then_some(largest)
    }

    /// Whether q̈ₙ₊₁ is nothing like q̈ₙ, for damping brings to rest within the step what begins in it: with w = q̈ₙ₊₁ − q̈ₙ it does so at
    /// the rate wᵀCw / wᵀMw. What vibrates without damping is not meant: its energy is kept.
    fn rings(&self, system: &mut dyn Dynamics, from: &State, to: &State, h: f64) -> bool {
        let [mut change, mut sum, mut speed] = [0.0_f64; 3];
        let scales = system.scales();
        for i in 0..scales.len() {
            let [before, now, v] = [from.a[i], to.a[i], to.v[i]].map(|x| x / scales[i]);
            change = change.max((now - before).abs());
            sum = sum.max(now.abs() + before.abs());
            speed = speed.max(v.abs());
        }
        if !(change > RINGING * sum) {
            return false;
        }
        // M w is exact, for r is linear in q̈; C w is a central difference over a part of the velocities.
        let w: Vec<f64> = to.a.iter().zip(&from.a).map(|(now, before)| now - before).collect();
        let part = PROBED * speed.max(h * change) / change;
        let mut probe = to.clone();
        let mut power = |state: &State, sign: f64| {
            let mut r = vec![0.0; w.len()];
            system.residual(state, &mut r);
            sign * r.iter().zip(&w).map(|(r, w)| r * w).sum::<f64>()
        };
        let inertia = power(to, 1.0) - power(&State { a: from.a.clone(), ..to.clone() }, 1.0);
        let mut damping = 0.0;
        for sign in [1.0, -1.0] {
            probe.v.iter_mut().zip(&to.v).zip(&w).for_each(|((v, at), w)| *v = at + sign * part * w);
            damping += power(&probe, sign);
        }
        h * damping / (2.0 * part) > DAMPED * inertia
    }

    fn diverged(&self, system: &dyn Dynamics, place: (f64, f64), size: f64, to: &State) -> StepError {
        if !size.is_finite() {
            return failure::not_finite(system, place.0, place.1, to);
        }
        let x = &self.equations.rhs[..to.v.len()];
        failure::not_converged(system, place, &self.full, size / ITERATION_TOLERANCE, x)
    }
}

/// Whether the change of an acceleration in a step h moves its unknown by more than its scale.
fn jumps(system: &dyn Dynamics, from: &State, to: &State, h: f64) -> bool {
    let changes = from.a.iter().zip(&to.a).map(|(before, now)| 0.5 * h * h * (now - before).abs());
    changes.zip(system.scales()).any(|(change, scale)| change > *scale)
}

impl AlphaSteps {
    /// Increment d of the attempt.
    pub(in crate::integrator) fn increment(&self) -> &[f64] {
        &self.d
    }

    /// Velocity by which dampers act in the accepted step.
    pub(in crate::integrator) fn damped(&self) -> &[f64] {
        &self.auxiliary.damped
    }
}

impl Stepper for AlphaSteps {
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        (span, _): (Span, Attempt),
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        self.solve(system, from, span.step, to, counters)
    }

    fn accept(&mut self, from: &State, to: &State) {
        self.begins = false;
        self.struck = self.struck.saturating_sub(1);
        self.line = self.euler > 0;
        if self.euler > 0 {
            self.euler -= 1;
            self.auxiliary.restart(&to.a, &to.v);
            self.kept.forget(false);
            return;
        }
        self.auxiliary.accept(&from.a, &to.a, &to.v);
        let Trend { before, earlier, known } = &mut self.trend;
        std::mem::swap(before, earlier);
        before.copy_from_slice(&from.a);
        *known = (*known + 1).min(2);
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        match self.line {
            true => hermite::line(system, from, to, &self.d, t, out),
            false => hermite::cubic(system, from, to, &self.d, t, out),
        }
    }

    fn middle(&self, system: &dyn Dynamics, from: &State, to: &State, out: &mut State, damped: &mut [f64]) {
        hermite::middle(system, from, to, &self.d, out);
        if self.line {
            out.lambda.copy_from_slice(&to.lambda);
        }
        damped.copy_from_slice(&self.auxiliary.damped);
    }

    fn restart(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        self.trend.known = 0;
        self.simplified.forget();
        self.forces.learn(0.0);
        self.kept.forget(false);
        (self.renewals, self.begins, self.euler, self.struck) = (0, true, 0, 0);
        self.equations.complete(system, state, counters)?;
        self.auxiliary.restart(&state.a, &state.v);
        Ok(())
    }

    fn struck(&mut self) {
        self.struck = JUDGED;
    }

    fn save(&self, out: &mut Checkpoint) {
        self.auxiliary.save(out);
        out.put("before", &self.trend.before);
        out.put("earlier", &self.trend.earlier);
        let [constant, begins] = [self.constant, self.begins].map(|flag| f64::from(u8::from(flag)));
        out.put("history", &[f64::from(self.trend.known), f64::from(self.renewals), constant]);
        out.put("start", &[begins, f64::from(self.euler), f64::from(self.struck)]);
        out.put("convergence", &self.simplified.memory());
        out.put("forces", &[self.forces.rounding()]);
        self.kept.save(out);
        self.equations.save(out);
    }

    fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        self.auxiliary.resume(from)?;
        from.fill("before", &mut self.trend.before)?;
        from.fill("earlier", &mut self.trend.earlier)?;
        let [known, renewals, constant] = from.numbers("history")?;
        let [begins, euler, struck] = from.numbers("start")?;
        (self.begins, self.euler, self.struck) = (begins != 0.0, euler as u8, struck as u8);
        (self.trend.known, self.renewals, self.constant) = (known as u8, renewals as u32, constant != 0.0);
        self.simplified.recall(from.numbers("convergence")?);
        let [rounding] = from.numbers("forces")?;
        self.forces.learn(rounding);
        self.kept.resume(from)?;
        self.equations.resume(from)?;
        if self.kept.weights.iter().all(|weight| weight.is_finite()) {
            let made = self.equations.reassemble(system, &self.kept.place, self.kept.weights);
            made.map_err(|error| NotResumed::Failed(error.to_string()))?;
        }
        Ok(())
    }
}
