//! Radau IIA with three stages: fifth order, L-stable, adaptive. The default method.
//!
//! The collocation method is written for equations of second order, with the stage accelerations aᵢ as
//! unknowns (A, b, c: the method's coefficients; h: step):
//!
//! ```text
//! Vᵢ = v₀ + h Σ Aᵢⱼ aⱼ,   Qᵢ = q₀ ⊞ (h cᵢ v₀ + h² Σ (A²)ᵢⱼ aⱼ),   r(t₀ + cᵢh, Qᵢ, Vᵢ, aᵢ) = 0
//! ```
//!
//! The last stage is the end of the step. Simplified Newton iterations for ΔQ = h²A² Δa,
//! ((hA)⁻²⊗M + (hA)⁻¹⊗C + I⊗K) ΔQ = −r, decouple with A = T Λ T⁻¹, Λ = diag(γ, μ, μ̄), into a real and a complex system of the size of the
//! model,
//!
//! ```text
//! (M + hγ C + h²γ² K) w₁ = h²γ² (T⁻¹r)₁,   (M + hμ C + h²μ² K)(w₂ + i w₃) = h²μ² ((T⁻¹r)₂ + i (T⁻¹r)₃),   ΔQ = −T w
//! ```
//!
//! K, which the axial stiffness of a slender beam dominates, is carried along with the rotating sections (see
//! [`Dynamics::corotate`]): in the frames that have rotated with each stage, K of the second serves them all. It is formed there,
//! as predicted: at half the rotation of the step.
//!
//! Starting values extrapolate the last step's collocation polynomial, or interpolate that of an attempt from the same
//! start. The tangents M, C and K are kept while convergence is fast, their factors while the step is the same too. Multipliers
//! of joints must converge as well: what a joint takes up moves nothing.
//!
//! Error estimate: the embedded formula of order 3 through f(y₀), filtered by the real system, in
//! second-order form:
//!
//! ```text
//! e_q = h² Σ (eᵀA²)ⱼ aⱼ,   e_v = h (γ a₀ + Σ (eᵀA)ⱼ aⱼ)
//! (M + hγ C + h²γ² K) ε_v = M e_v − hγ K e_q,   ε_q = e_q + hγ ε_v
//! ```
//!
//! filtered a second time on a first or repeated step when it exceeds the tolerance. Errors are measured
//! by the weighted root mean square of ε_q and h ε_v with weights absolute·scaleᵢ + relative·|qᵢ|, off a vector space the larger of both
//! tolerances times scaleᵢ: an error of
//! velocity counts as the displacement it makes in one step.
//!
//! Constraints are imposed in the form of index 2, ġ(Qᵢ, Vᵢ) = 0 with a multiplier in every stage, which adds to both
//! systems the rows G and the columns −Gᵀ; the end of the step is then projected onto g = 0 and ġ = 0. On a
//! configuration that is not a vector space (rotations) the increments obey Dᵢ = h Σ Aᵢⱼ Ḋⱼ, Ḋ = T(D)⁻¹ V.
//!
//! Order: 5 in q and v (measured 5.0), 3 of the stages, on which stiff problems depend; of the error
//! estimate 3. Stability: A- and L-stable; frequencies far above 1/h are annihilated, those below are
//! integrated with a dissipation of O((hω)⁶). Dense output: quintic Hermite through q, v, a at both ends;
//! measured four to eight times as accurate as the collocation polynomial; forces of joints by this polynomial. At the times of the
//! stages it is the stages. Where a step behind a break begins with a velocity that tells nothing of it, that of a load's rate in vibrations much faster than
//! the step, it is the polynomial through the stages, which have forgotten it. In steps that an event has cut to a small part velocities and accelerations are lines, and in those behind a blow on a
//! damped beam, whose first accelerations decay within a part of the step.
//!
//! Sources: Hairer & Wanner, *Solving Ordinary Differential Equations II*, sections IV.5 and IV.8
//! (doi 10.1007/978-3-642-05221-7); Hairer & Wanner (1999, doi 10.1016/S0377-0427(99)00134-X).

mod coefficients;
mod dense;
mod prediction;
mod stages;
mod tolerance;

use super::{
    Attempt, Checkpoint, Convergence, Counters, Info, Integrator, InvalidParameter, NotResumed, Progress,
    Span, StepError, StepReport, Stepper, hermite,
};
use crate::system::{Dynamics, State};
use dense::{BLIND, RESOLVED};
use prediction::Prediction;
use stages::{Stages, weights};
pub use tolerance::Tolerance;

/// Name as in a case file.
const NAME: &str = "radau";

/// A number of iterations that new tangents would not make less.
const FEW: u32 = 2;

/// Largest iteration error in units of the tolerance, and relative to the scales of the unknowns. An error that is small
/// beside a displacement is large as a strain of the axis: it would make axial vibrations that short steps then follow. The
/// estimate multiplies it by a hundred: from 3e-3 on it may keep a step from being accepted however short it is.
const LARGEST_KAPPA: f64 = 1e-3;
const LARGEST_ITERATION_ERROR: f64 = 1e-5;

/// Part of a step of good accuracy below which one from the same start is short: what iteration and rounding leave of its increment is divided by h².
const SHORT: f64 = 1.0 / 32.0;

/// Most steps behind a blow, or behind a break, that go over what is faster than themselves.
const SETTLING: u8 = 8;

/// The 3-stage Radau IIA method. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct Radau {
    info: Info,
    tolerance: Tolerance,
}

/// The method with its memory.
struct RadauSteps {
    tolerance: Tolerance,
    convergence: Convergence,
    /// Newton tolerance of regular steps, and of trial steps during the location of events: a tolerance that depends on
    /// the step makes the event function discontinuous.
    kappa: [f64; 2],
    /// Steps of the attempt and of the last accepted one; none since a restart.
    attempt: f64,
    accepted: Option<f64>,
    /// Size of an attempt from the same start that has converged.
    tried: Option<f64>,
    /// Size of the largest attempt of good accuracy from the same start.
    good: f64,
    /// Whether the accepted step is short against it, or goes over accelerations faster than itself: its dense output is a line.
    line: bool,
    /// Steps that may be of the kind behind a blow.
    settling: u8,
    /// Steps behind a restart that may begin with a velocity that tells nothing of them, and whether the accepted step did: its dense output is
    /// that of its stages.
    beginning: u8,
    blind: bool,
    stages: Stages,
}

impl Radau {
    /// The method with the given tolerance of local errors.
    ///
    /// # Errors
    /// When `absolute` is not positive, `relative` is negative, or one is not finite.
    pub fn new(tolerance: Tolerance) -> Result<Radau, InvalidParameter> {
        let Tolerance { relative, absolute } = tolerance;
        if !(absolute > 0.0 && absolute.is_finite()) {
            let range = "> 0";
            return Err(InvalidParameter { parameter: "absolute tolerance", value: absolute, range });
        }
        if !(relative >= 0.0 && relative.is_finite()) {
            let range = "≥ 0";
            return Err(InvalidParameter { parameter: "relative tolerance", value: relative, range });
        }
        Ok(Radau { info: Info { name: NAME, order: 5, estimate_order: Some(3), implicit: true }, tolerance })
    }

    /// The tolerance of local errors.
    pub fn tolerance(&self) -> Tolerance {
        self.tolerance
    }
}

/// Iteration error κ and rounding error, in units of the tolerance.
fn iteration_errors(tolerance: Tolerance) -> [f64; 2] {
    let size = tolerance.size();
    let floor = 100.0 * f64::EPSILON / size;
    let kappa = size.sqrt().min(LARGEST_KAPPA).min(LARGEST_ITERATION_ERROR / size).max(0.1 * floor);
    [kappa, floor]
}

impl Integrator for Radau {
    fn info(&self) -> &Info {
        &self.info
    }

    fn stepper(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
        _step: f64,
        counters: &mut Counters,
    ) -> Result<Box<dyn Stepper>, StepError> {
        let [kappa, floor] = iteration_errors(self.tolerance);
        // The iteration of an affine system does not become slow by anything but rounding.
        let noise = if system.is_affine() { 1.0 } else { floor.max(kappa) };
        let mut steps = RadauSteps {
            tolerance: self.tolerance,
            convergence: Convergence::simplified(kappa, noise),
            kappa: [kappa, kappa.min(floor)],
            attempt: 0.0,
            accepted: None,
            tried: None,
            good: 0.0,
            line: false,
            settling: 0,
            beginning: SETTLING,
            blind: false,
            stages: Stages::new(system, state, self.tolerance),
        };
        steps.restart(system, state, counters)?;
        Ok(Box::new(steps))
    }
}

impl Stepper for RadauSteps {
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        (span, attempt): (Span, Attempt),
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        let (h, work) = (span.step, &mut self.stages);
        let filter_twice = self.accepted.is_none() || attempt == Attempt::Repeated;
        if attempt == Attempt::Trial {
            self.convergence.aim(self.kappa[1]);
        }
        self.attempt = h;
        work.set_error_weights(from, self.tolerance);
        let again = self.accepted.map_or(Prediction::Uniform, |last| Prediction::Extrapolated { last });
        let tried = self.tried.take().filter(|last| h < 2.0 * last);
        let mut prediction = tried.map_or(again, |last| Prediction::Tried { last });
        let mut renew = work.kept.due;
        loop {
            work.predict(system, from, h, prediction);
            prediction = again;
            if std::mem::take(&mut renew) {
                work.renew(system, (from, to), h, counters);
            }
            work.kept.rotate_to(system, from);
            if work.kept.weights != weights(h) {
                work.factor(system, from, h, counters)?;
            }
            self.convergence.begin(work.kept.fresh);
            let (progress, size) = work.iterate(system, (from, to), h, &mut self.convergence, counters);
            if progress == Progress::Converged {
                let few = self.convergence.iterations() <= FEW;
                let rate = self.convergence.rate().max(work.forces.rate());
                work.kept.judge_rate(if few { 0.0 } else { rate });
                self.tried = Some(h);
                break;
            }
            self.convergence.forget();
            if !work.kept.fresh {
                renew = true;
                continue;
            }
            if self.convergence.aims_at(self.kappa[1]) && self.kappa[1] < self.kappa[0] {
                // Rounding is in the way.
                self.convergence.aim(self.kappa[0]);
                continue;
            }
            let worst = system.unknown(work.worst_increment());
            if !size.is_finite() {
                return Err(StepError::NotFinite { time: from.t, step: h, worst });
            }
            let iterations = self.convergence.iterations();
            return Err(StepError::NotConverged { time: from.t, step: h, iterations, size, worst });
        }
        work.finish(system, from, h, to);
        let error = work.estimate(system, from, h, filter_twice, counters);
        let worst = work.worst_error(h);
        if !error.is_finite() {
            return Err(StepError::NotFinite { time: from.t, step: h, worst: system.unknown(worst) });
        }
        if error <= 1.0 {
            self.good = self.good.max(h);
        }
        let iterations = self.convergence.iterations();
        Ok(StepReport { iterations, error: Some(error), worst, ..StepReport::default() })
    }

    fn accept(&mut self, from: &State, to: &State) {
        self.convergence.aim(self.kappa[0]);
        (self.accepted, self.tried) = (Some(self.attempt), None);
        let short = self.attempt < SHORT * self.good;
        self.blind = self.beginning > 0 && !self.stages.resolve(from, to, BLIND);
        self.beginning = if self.blind { self.beginning - 1 } else { 0 };
        let settles = self.settling > 0 && !self.stages.resolve(from, to, RESOLVED);
        self.settling = if settles || short { self.settling.saturating_sub(1) } else { 0 };
        (self.line, self.good) = (short || settles, 0.0);
        self.stages.accept();
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        if self.line {
            hermite::line(system, from, to, &self.stages.end_accepted, t, out);
        } else if self.blind {
            hermite::linear(from, to, t, out);
            self.stages.collocate(system, (from, to), t, out);
            self.stages.interpolate_forces((t - from.t) / (to.t - from.t), out);
        } else if !self.stages.write_stage(system, (from, to), t, out) {
            hermite::quintic(system, from, to, &self.stages.end_accepted, t, out);
            self.stages.interpolate_forces((t - from.t) / (to.t - from.t), out);
        }
    }

    fn restart(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        (self.accepted, self.tried, self.good, self.settling) = (None, None, 0.0, 0);
        self.beginning = SETTLING;
        self.convergence.forget();
        self.stages.restart(system, state, counters)
    }

    fn struck(&mut self) {
        self.settling = SETTLING;
    }

    fn save(&self, out: &mut Checkpoint) {
        let counts = [self.settling, self.beginning].map(f64::from);
        out.put("accepted", &[self.accepted.unwrap_or(f64::NAN), counts[0], counts[1]]);
        out.put("convergence", &self.convergence.memory());
        self.stages.save(out);
    }

    fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        let [accepted, settling, beginning] = from.numbers("accepted")?;
        (self.settling, self.beginning) = (settling as u8, beginning as u8);
        self.accepted = Some(accepted).filter(|step| step.is_finite());
        self.convergence.recall(from.numbers("convergence")?);
        self.stages.resume(system, from)
    }
}
