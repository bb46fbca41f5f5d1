//! One motion, computed in several ways.

use crate::analysis::disturb;
use crate::analysis::recording::{Record, Warning, Watch, record_watched};
use crate::analysis::transient::Plan;
use crate::integrator::{Integrator, InvalidParameter, Radau, Tolerance};
use crate::system::{Channel, Role, System};

/// Tolerance of a companion over that of a run under control.
const FINER: f64 = 0.1;
/// Longest step of a companion over that of the run.
pub(super) const SHORTER: f64 = 0.5;
/// Smallest tolerance that is asked of `Radau`.
const TIGHTEST: f64 = 1e-13;

/// The functions of a mesh, against those of the mesh that is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mesh {
    /// How often every element is cut in two.
    pub halvings: u32,
    /// About how many times as many functions as that, where any mesh of about so many will do.
    pub factor: Option<f64>,
}

impl Mesh {
    /// The mesh with every element cut in two.
    #[must_use]
    pub fn halved(self) -> Mesh {
        Mesh { halvings: self.halvings + 1, ..self }
    }

    /// How many cells take the place of `cells`, rounded up.
    pub fn cells(self, cells: usize) -> usize {
        let halved = cells << self.halvings;
        self.factor.map_or(halved, |factor| libm::ceil(factor * halved as f64) as usize)
    }
}

/// A disturbance of the velocities at the start, [in all directions](disturb).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disturbance {
    /// Its kinetic energy \[J\].
    pub energy: f64,
    /// Waves of a shorter period are left out \[s\].
    pub period: f64,
}

/// A way of computing a motion.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Variant {
    /// Its mesh.
    pub mesh: Mesh,
    /// Whether the reference model takes the place of the own one, on the mesh that is asked for.
    pub reference: bool,
    /// Its end, its steps and its records.
    pub plan: Plan,
    /// Tolerance of [`Radau`]; `None` where the steps of the plan are fixed, those of a method of its own.
    pub tolerance: Option<Tolerance>,
    /// Its disturbance.
    pub disturbance: Option<Disturbance>,
}

impl Variant {
    /// A motion by a plan with fixed steps.
    pub fn new(plan: Plan) -> Variant {
        Variant { mesh: Mesh::default(), reference: false, plan, tolerance: None, disturbance: None }
    }

    /// The same by [`Radau`] with steps under control.
    #[must_use]
    pub fn with_tolerance(self, tolerance: Tolerance) -> Variant {
        Variant { tolerance: Some(tolerance), ..self }
    }

    /// Integrates a system of this mesh and model from its initial state by [`Radau`], and records it.
    ///
    /// # Errors
    /// [`InvalidParameter`] of the tolerance, also where there is none: then [`Variant::record_by`] has the method of the fixed steps.
    pub fn record(&self, system: &mut dyn System, watch: &mut Watch<'_>) -> Result<Record, InvalidParameter> {
        let radau = Radau::new(self.tolerance.unwrap_or(Tolerance::uniform(f64::NAN)))?;
        self.record_by(&radau, system, watch)
    }

    /// As [`Variant::record`], by `method` where the variant has no tolerance.
    ///
    /// # Errors
    /// [`InvalidParameter`] of the tolerance.
    pub fn record_by(
        &self,
        method: &dyn Integrator,
        system: &mut dyn System,
        watch: &mut Watch<'_>,
    ) -> Result<Record, InvalidParameter> {
        let mut start = system.initial();
        if let Some(Disturbance { energy, period }) = self.disturbance {
            // What cannot be disturbed moves as it did.
            let _ = disturb(system, &mut start, energy, period);
        }
        let radau = self.tolerance.map(Radau::new).transpose()?;
        let method = radau.as_ref().map_or(method, |radau| radau as &dyn Integrator);
        Ok(record_watched(system, method, &start, &self.plan, watch))
    }

    /// The step where all have one length \[s\].
    pub fn fixed_step(&self) -> Option<f64> {
        self.plan.step.filter(|_| self.tolerance.is_none())
    }

    /// The same by [`Radau`] with this tolerance, whose steps nothing else bounds.
    pub(super) fn by_radau(&self, tolerance: f64) -> Variant {
        let plan = Plan { step: None, longest_step: None, contact_step: None, ..self.plan.clone() };
        Variant { plan, tolerance: Some(Tolerance::uniform(tolerance)), ..self.clone() }
    }

    /// The same with tolerances times `factor` that are `least` to `most`.
    pub(super) fn with_tolerances(&self, factor: f64, least: f64, most: f64) -> Variant {
        let of = |tolerance: f64| (factor * tolerance).max(least).min(most);
        let scaled = |tolerance: Tolerance| Tolerance {
            relative: of(tolerance.relative),
            absolute: of(tolerance.absolute),
        };
        Variant { tolerance: self.tolerance.map(scaled), ..self.clone() }
    }

    /// The same, of which `run` is, more accurate in time where steps are under control: with a tenth of the tolerance, half the longest step and half the
    /// first one, and twice as many steps between breaks. Steps of `run` may be as long as they are for another reason than its tolerance. Where contacts were followed by a
    /// nonsmooth method, steps near contacts are half as long too: they were its steps.
    pub(super) fn more_accurate(&self, run: &Record) -> Variant {
        let longest = longest_step(run).map(|longest| SHORTER * longest).or(self.plan.longest_step);
        let followed =
            |warning: &Warning| matches!(warning, Warning::Chatter { .. } | Warning::Rubbing { .. });
        let part = if run.warnings.iter().any(followed) { SHORTER } else { 1.0 };
        let contact_step = self.plan.contact_step.map(|step| part * step);
        let step = run.first_step.map(|first| SHORTER * first).or(self.plan.step);
        let plan = Plan { step, longest_step: longest, contact_step, ..self.plan.clone() };
        Variant { plan, ..self.with_tolerances(FINER, TIGHTEST, f64::INFINITY) }.with_shorter_parts()
    }

    /// The same with twice as many steps under control between two neighbouring breaks.
    pub(super) fn with_shorter_parts(self) -> Variant {
        let break_steps = self.plan.break_steps.saturating_mul(2);
        Variant { plan: Plan { break_steps, ..self.plan }, ..self }
    }

    /// The same with twice the functions, where there is a mesh.
    pub(super) fn halved(&self, has_mesh: bool) -> Variant {
        Variant { mesh: if has_mesh { self.mesh.halved() } else { self.mesh }, ..self.clone() }
    }
}

/// The longest step of a run \[s\].
fn longest_step(run: &Record) -> Option<f64> {
    let of_steps = |c: &Channel| c.role == Role::Integration && c.unit == "s";
    let index = run.trajectory.channels().iter().position(of_steps)?;
    Some(run.trajectory.extremes(index).max).filter(|longest| *longest > 0.0)
}
