//! The members of the family: Newmark, HHT-α, Chung–Hulbert.

use super::{
    AlphaSteps, Auxiliary, Equations, FORCES, KEPT_TOLERANCE, NOISE, Parameters, ROWS_TOLERANCE, Trend,
};
use super::{Convergence, Counters, ITERATION_TOLERANCE, JointForces, KeptTangent, StepError, Stepper};
use crate::integrator::{Info, Integrator, InvalidParameter};
use crate::system::{Dynamics, Set, State};

/// The generalized-α method. Its formulas and sources head the source file.
#[derive(Clone, Debug)]
pub struct GeneralizedAlpha {
    info: Info,
    parameters: Parameters,
    /// Whether ġ = 0 holds beside g = 0; where nothing is said, with contacts that may open.
    stabilized: Option<bool>,
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
            parameters: Parameters { alpha_m, alpha_f, beta, gamma },
            stabilized: None,
        }
    }

    /// The same method on the stabilized form of index 2, in which ġ = 0 holds beside g = 0: that of systems with contacts that may open.
    pub fn stabilized(self) -> GeneralizedAlpha {
        GeneralizedAlpha { stabilized: Some(true), ..self }
    }

    /// The same method on the form of index 3, in which g = 0 alone holds: that of systems without such contacts. Where events shorten steps
    /// its forces may grow without bound.
    pub fn positions_only(self) -> GeneralizedAlpha {
        GeneralizedAlpha { stabilized: Some(false), ..self }
    }

    /// The auxiliary acceleration of `n` unknowns.
    pub(in crate::integrator) fn auxiliary(&self, n: usize) -> Auxiliary {
        Auxiliary::new(self.parameters, n)
    }

    /// αm, αf, β, γ.
    pub fn parameters(&self) -> [f64; 4] {
        let Parameters { alpha_m, alpha_f, beta, gamma } = self.parameters;
        [alpha_m, alpha_f, beta, gamma]
    }

    /// The method with its memory, not yet [restarted](Stepper::restart).
    pub(in crate::integrator) fn memory(&self, system: &mut dyn Dynamics, state: &State) -> AlphaSteps {
        let size = system.size();
        let vector = || vec![0.0; size.v];
        let opens = system.rows().iter().any(|set| matches!(set, Set::Unilateral { .. }));
        // Iteration errors leave the momentum of a system whose tangent is rotated section by section.
        let exactly = size.lambda > 0 || !system.is_vector_space();
        let simplified = if exactly {
            let places = state.q.iter().zip(system.scales()).map(|(q, scale)| (q / scale).abs());
            let mut convergence = Convergence::measured(ROWS_TOLERANCE, NOISE);
            convergence.learn_rounding(0.25 * f64::EPSILON * places.fold(1.0, f64::max));
            convergence
        } else {
            Convergence::kept(KEPT_TOLERANCE, NOISE)
        };
        AlphaSteps {
            auxiliary: self.auxiliary(size.v),
            trend: Trend { before: vector(), earlier: vector(), known: 0 },
            d: vector(),
            equations: Equations::new(system, state, self.stabilized.unwrap_or(opens)),
            kept: KeptTangent::new(system, state),
            simplified,
            forces: JointForces::new(FORCES),
            full: Convergence::full(ITERATION_TOLERANCE, 0.0),
            affine: system.is_affine() && size.lambda == 0,
            renewals: 0,
            constant: false,
            begins: true,
            euler: 0,
            line: false,
            struck: 0,
        }
    }
}

impl Integrator for GeneralizedAlpha {
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
        let mut steps = self.memory(system, state);
        steps.restart(system, state, counters)?;
        Ok(Box::new(steps))
    }
}
