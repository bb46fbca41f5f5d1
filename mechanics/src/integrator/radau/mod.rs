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
//! ((hA)⁻²⊗M + (hA)⁻¹⊗C + I⊗K) ΔQ = −r, decouple with A = T Λ T⁻¹ into a real and a complex system of the size of the
//! model,
//!
//! ```text
//! (M + hλ C + h²λ² K) w₁ = h²λ² (T⁻¹r)₁,   (M + hμ C + h²μ² K)(w₂ + i w₃) = h²μ² ((T⁻¹r)₂ + i (T⁻¹r)₃),   ΔQ = −T w
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
//! second-order form (γ₀ = λ):
//!
//! ```text
//! e_q = h² Σ (eᵀA²)ⱼ aⱼ,   e_v = h (γ₀ a₀ + Σ (eᵀA)ⱼ aⱼ)
//! (M + hγ₀ C + h²γ₀² K) ε_v = M e_v − hγ₀ K e_q,   ε_q = e_q + hγ₀ ε_v
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
//! stages it is the stages.
//!
//! Sources: Hairer & Wanner, *Solving Ordinary Differential Equations II*, sections IV.5 and IV.8
//! (doi 10.1007/978-3-642-05221-7); Hairer & Wanner (1999, doi 10.1016/S0377-0427(99)00134-X).

mod coefficients;
mod prediction;
mod stages;
mod tolerance;

use super::{
    Checkpoint, Convergence, Counters, Info, Integrator, InvalidParameter, NotResumed, Progress, Span,
    StepError, StepReport, hermite,
};
use crate::system::{Dynamics, Side, State};
use prediction::Prediction;
use stages::Stages;
pub use tolerance::Tolerance;

/// Name as in a case file.
const NAME: &str = "radau";

/// Names of the stages' accelerations in a checkpoint.
const STAGES: [&str; 3] = ["stage.1", "stage.2", "stage.3"];

/// Rate of convergence below which the tangents serve the next step too, and a number of iterations that new ones would not
/// make less.
const REUSE_RATE: f64 = 0.03;
const FEW: u32 = 2;

/// Largest iteration error in units of the tolerance, and relative to the scales of the unknowns. An error that is small
/// beside a displacement is large as a strain of the axis: it would make axial vibrations that short steps then follow. The
/// estimate multiplies it by a hundred: from 3e-3 on it may keep a step from being accepted however short it is.
const LARGEST_KAPPA: f64 = 1e-3;
const LARGEST_ITERATION_ERROR: f64 = 1e-5;

/// The 3-stage Radau IIA method. Its formulas head the source file.
#[derive(Debug)]
pub struct Radau {
    info: Info,
    tolerance: Tolerance,
    counters: Counters,
    convergence: Convergence,
    /// Iteration error of steps, and of those by which something is looked for: one that changes with the step from one
    /// number of iterations to another makes a root that no step hits.
    kappa: [f64; 2],
    worst: usize,
    /// Whether an attempt waits for `accept`, and whether any step was accepted since (re)start.
    pending: bool,
    first: bool,
    /// Step of the attempt, and of the accepted step.
    attempt: f64,
    accepted_step: f64,
    /// Size of an attempt from the same start that has converged.
    tried: Option<f64>,
    work: Option<Stages>,
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
        // Iteration error κ and rounding error, in units of the tolerance.
        let size = tolerance.size();
        let floor = 100.0 * f64::EPSILON / size;
        let kappa = size.sqrt().min(LARGEST_KAPPA).min(LARGEST_ITERATION_ERROR / size).max(0.1 * floor);
        Ok(Radau {
            info: Info { name: NAME, order: 5, estimate_order: Some(3), implicit: true },
            tolerance,
            counters: Counters::default(),
            convergence: Convergence::simplified(kappa, floor.max(kappa)),
            kappa: [kappa, kappa.min(floor)],
            worst: 0,
            pending: false,
            first: true,
            attempt: 0.0,
            accepted_step: 0.0,
            tried: None,
            work: None,
        })
    }

    /// The tolerance of local errors.
    pub fn tolerance(&self) -> Tolerance {
        self.tolerance
    }
}

impl Integrator for Radau {
    fn info(&self) -> &Info {
        &self.info
    }

    fn start(&mut self, system: &mut dyn Dynamics, state: &mut State, _step: f64) -> Result<(), StepError> {
        self.counters = Counters::default();
        self.convergence.reset();
        if system.is_affine() {
            // The iteration of an affine system does not become slow by anything but rounding.
            self.convergence = self.convergence.with_noise(1.0);
        }
        self.work = Some(Stages::new(system, state, self.tolerance));
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
        let Some(work) = &mut self.work else {
            return Err(StepError::NotStarted { method: NAME });
        };
        let repeated = self.pending;
        self.counters.rejected += u64::from(repeated);
        self.pending = true;
        self.attempt = h;
        work.set_error_weights(from, self.tolerance);
        let last = self.accepted_step;
        let again = if self.first { Prediction::Constant } else { Prediction::Extrapolated { last } };
        let tried = self.tried.take().filter(|last| h < 2.0 * last);
        let mut prediction = tried.map_or(again, |last| Prediction::Tried { last });
        let mut renew = work.rate > REUSE_RATE;
        loop {
            work.predict(system, from, h, prediction);
            prediction = again;
            if std::mem::take(&mut renew) {
                work.renew(system, (from, to), h, &mut self.counters);
            }
            work.corotate(system, from);
            if work.factored_step != h {
                work.factor(system, from, h, &mut self.counters)?;
            }
            self.convergence.begin(work.fresh);
            let (progress, size) =
                work.iterate(system, (from, to), h, &mut self.convergence, &mut self.counters);
            if progress == Progress::Converged {
                let few = self.convergence.iterations() <= FEW;
                work.rate = if few { 0.0 } else { self.convergence.rate().max(work.force_rate) };
                self.tried = Some(h);
                break;
            }
            self.convergence.forget();
            if !work.fresh {
                renew = true;
                continue;
            }
            if self.convergence.aims_at(self.kappa[1]) && self.kappa[1] < self.kappa[0] {
                // Rounding is in the way.
                self.convergence.aim(self.kappa[0]);
                continue;
            }
            self.worst = work.worst_increment();
            let worst = system.unknown(self.worst);
            if !size.is_finite() {
                return Err(StepError::NotFinite { time: from.t, step: h, worst });
            }
            let iterations = self.convergence.iterations();
            return Err(StepError::NotConverged { time: from.t, step: h, iterations, size, worst });
        }
        work.finish(system, from, h, to);
        let error = work.estimate(system, from, h, self.first || repeated, &mut self.counters);
        self.worst = work.worst_error(h);
        if !error.is_finite() {
            let worst = system.unknown(self.worst);
            return Err(StepError::NotFinite { time: from.t, step: h, worst });
        }
        Ok(StepReport { iterations: self.convergence.iterations(), error: Some(error) })
    }

    fn discard(&mut self) {
        self.pending = false;
        self.convergence.aim(self.kappa[1]);
    }

    fn accept(&mut self, _from: &State, _to: &State) {
        self.convergence.aim(self.kappa[0]);
        (self.pending, self.first, self.tried) = (false, false, None);
        self.accepted_step = self.attempt;
        self.counters.steps += 1;
        if let Some(work) = &mut self.work {
            std::mem::swap(&mut work.a, &mut work.a_accepted);
            std::mem::swap(&mut work.end, &mut work.end_accepted);
            work.fresh = false;
        }
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        match &self.work {
            Some(work) if work.write_stage(system, (from, to), t, out) => {}
            Some(work) => {
                hermite::quintic(system, from, to, &work.end_accepted, t, out);
                work.interpolate_forces((t - from.t) / (to.t - from.t), out);
            }
            None => out.copy_from(to),
        }
    }

    fn restart(&mut self, system: &mut dyn Dynamics, state: &mut State) -> Result<(), StepError> {
        let Some(work) = &mut self.work else {
            return Err(StepError::NotStarted { method: NAME });
        };
        (self.pending, self.first, self.tried) = (false, true, None);
        self.convergence.forget();
        work.rate = f64::INFINITY;
        state.side = Side::Right;
        work.factored_step = f64::NAN;
        let place = (state.t, 0.0);
        let memory = (&mut work.real, &mut work.rhs);
        work.accelerations.complete_in(memory, system, state, place, &mut self.counters)
    }

    fn save(&self, out: &mut Checkpoint) {
        out.put("counters", &self.counters.to_numbers());
        out.put("first", &[f64::from(u8::from(self.first)), self.accepted_step]);
        out.put("convergence", &self.convergence.memory());
        if let Some(work) = &self.work {
            for (a, name) in work.a_accepted.iter().zip(STAGES) {
                out.put(name, a);
            }
            out.put("factors", &[work.factored_step, work.rate]);
            out.put_state("factors.", &work.place);
        }
    }

    fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        let Some(work) = &mut self.work else {
            return Err(NotResumed::Failed(format!("{NAME} was not started")));
        };
        let [first, accepted] = from.numbers("first")?;
        (self.first, self.accepted_step) = (first != 0.0, accepted);
        for (a, name) in work.a_accepted.iter_mut().zip(STAGES) {
            from.fill(name, a)?;
        }
        let [step, rate] = from.numbers("factors")?;
        if step.is_finite() {
            // The same tangents at the same place have the same factors.
            from.fill_state("factors.", &mut work.place)?;
            work.assemble(system, &mut self.counters);
            let place = work.place.clone();
            let factored = work.factor(system, &place, step, &mut self.counters);
            factored.map_err(|error| NotResumed::Failed(error.to_string()))?;
            (work.rate, work.fresh) = (rate, false);
        }
        self.convergence.recall(from.numbers("convergence")?);
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
