//! Time integrators: each a file, each behind the one trait [`Integrator`].
//!
//! | method | file | order (q, v) | steps | equations solved a step |
//! |---|---|---|---|---|
//! | [`Radau`] IIA, 3 stages | `radau/` | 5 | adaptive | one real and one complex system per iteration |
//! | [`GeneralizedAlpha`]: Newmark, HHT-α, Chung–Hulbert | `generalized_alpha/` | 2 | fixed | one system per iteration |
//! | [`RungeKutta`], classical | `runge_kutta.rs` | 4 | fixed | mass matrix only |
//! | [`MoreauJean`], nonsmooth | `moreau_jean.rs` | 1 | fixed | one system per iteration, and one per contact |
//! | [`NonsmoothAlpha`], nonsmooth | `nonsmooth_alpha.rs` | 2 in smooth motion, 1 across impacts | fixed | one system per iteration, and one per contact |
//! | [`Adams`]–Bashforth–Moulton PECE | `adams.rs` | 4 | fixed | mass matrix only |

mod acceleration;
mod adams;
mod checkpoint;
mod failure;
mod generalized_alpha;
mod hermite;
mod impulses;
mod moreau_jean;
mod newton;
mod nonsmooth_alpha;
mod radau;
mod rows;
mod runge_kutta;
mod stability;
mod step_control;

pub(crate) use acceleration::Accelerations;
pub use adams::Adams;
pub use checkpoint::{Checkpoint, NotResumed};
pub use generalized_alpha::GeneralizedAlpha;
pub use moreau_jean::MoreauJean;
pub use newton::{Convergence, Progress};
pub use nonsmooth_alpha::NonsmoothAlpha;
pub use radau::{Radau, Tolerance};
pub use runge_kutta::RungeKutta;
pub use stability::{StabilityLimit, largest_frequency};
pub use step_control::{Law, StepControl};

use crate::system::{Corotation, Dynamics, Side, State};

/// What an integrator is: for listings, reports and step control.
#[derive(Clone, Debug, PartialEq)]
pub struct Info {
    /// Name as in a case file, e.g. `radau`.
    pub name: &'static str,
    /// Order of convergence of the configuration.
    pub order: usize,
    /// Order of the embedded error estimate, for step control; `None` for fixed-step methods.
    pub estimate_order: Option<usize>,
    /// Whether it solves equations (and so has no stability limit of its own).
    pub implicit: bool,
}

/// Work done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Steps accepted.
    pub steps: u64,
    /// Steps attempted and thrown away (error too large or no convergence).
    pub rejected: u64,
    /// Newton iterations.
    pub iterations: u64,
    /// Evaluations of the residual.
    pub residuals: u64,
    /// Tangents assembled.
    pub tangents: u64,
    /// Factorisations.
    pub factorizations: u64,
    /// Forward and back substitutions.
    pub solves: u64,
}

/// The time that a step covers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Size h of the step \[s\].
    pub step: f64,
    /// Where it ends \[s\]: the start + h but for rounding.
    pub end: f64,
    /// Which limit is meant at the end, where something jumps there.
    pub side: Side,
}

impl Span {
    /// A step of size `step` from time `start`, at whose end nothing jumps.
    pub fn new(start: f64, step: f64) -> Span {
        Span { step, end: start + step, side: Side::Right }
    }
}

/// What one successful step reports.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Newton iterations (0 for explicit methods).
    pub iterations: u32,
    /// Estimated local error over the tolerance (≤ 1 is acceptable); `None` without an estimate.
    pub error: Option<f64>,
}

/// Why a step failed. Every variant says when, how large and what to try.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// Newton's method did not converge.
    #[error(
        "no convergence at t = {time:.6} s with a step of {step:.3e} s: after {iterations} iterations the increment is {size:.2e} times the tolerance, largest in the {worst}; try a smaller step"
    )]
    NotConverged {
        /// Time at the start of the step \[s\].
        time: f64,
        /// Step \[s\].
        step: f64,
        /// Iterations done.
        iterations: u32,
        /// Scaled increment.
        size: f64,
        /// Label of the worst unknown.
        worst: String,
    },
    /// The iteration matrix is singular.
    #[error(
        "singular tangent at t = {time:.6} s with a step of {step:.3e} s: relative pivot {pivot:.1e} at the {worst}"
    )]
    Singular {
        /// Time at the start of the step \[s\].
        time: f64,
        /// Step \[s\].
        step: f64,
        /// Relative pivot.
        pivot: f64,
        /// Label of the unknown at which elimination broke down.
        worst: String,
    },
    /// A number that is not finite appeared.
    #[error(
        "the solution is no longer finite at t = {time:.6} s with a step of {step:.3e} s (first in the {worst}); try a smaller step"
    )]
    NotFinite {
        /// Time at the start of the step \[s\].
        time: f64,
        /// Step \[s\].
        step: f64,
        /// Label of the first bad unknown.
        worst: String,
    },
    /// The step is beyond the stability limit of an explicit method.
    #[error(
        "the step {step:.6e} s is beyond the stability limit {limit:.6e} s of {method} (largest frequency {frequency:.4e} rad/s at t = {time:.3} s); use a step below {limit:.3e} s or an implicit integrator"
    )]
    Unstable {
        /// Method as in a case file.
        method: &'static str,
        /// Time at which the frequency was found \[s\].
        time: f64,
        /// Step asked for \[s\].
        step: f64,
        /// Largest stable step \[s\].
        limit: f64,
        /// Largest angular frequency of the system [rad/s].
        frequency: f64,
    },
    /// Step control drove the step below what arithmetic resolves.
    #[error(
        "the step fell to {step:.3e} s at t = {time:.6} s and the error is still {error:.2e} times the tolerance, largest in the {worst}; loosen the tolerance or look for a discontinuity in the motion there"
    )]
    StepTooSmall {
        /// Time at the start of the step \[s\].
        time: f64,
        /// Step \[s\].
        step: f64,
        /// Scaled error (infinite when Newton's method failed).
        error: f64,
        /// Label of the worst unknown.
        worst: String,
    },
    /// The impulses of contacts in a step were not found.
    #[error("at t = {time:.6} s with a step of {step:.3e} s {cause}")]
    Contacts {
        /// Time at the start of the step \[s\].
        time: f64,
        /// Step \[s\].
        step: f64,
        /// Why.
        cause: crate::contact::Unresolved,
    },
    /// `step` or `restart` was called before `start`.
    #[error("{method} was asked for a step before it was started")]
    NotStarted {
        /// Method as in a case file.
        method: &'static str,
    },
    /// The method cannot integrate this kind of system.
    #[error("{method} cannot integrate a system with {feature}; use {instead}")]
    Unsupported {
        /// Method as in a case file.
        method: &'static str,
        /// What the system has.
        feature: &'static str,
        /// Method that can.
        instead: &'static str,
    },
}

/// A parameter outside the range in which a method is what it is said to be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{parameter} = {value} is outside the valid range: {range}")]
pub struct InvalidParameter {
    /// Name of the parameter.
    pub parameter: &'static str,
    /// Value given.
    pub value: f64,
    /// Valid range, in words.
    pub range: &'static str,
}

/// A time integrator. Its history and scratch are its own; the states are the caller's.
///
/// Protocol: [`start`](Integrator::start) once; then [`step`](Integrator::step) any number of times
/// from the same state (a rejected attempt leaves the history as it was), and
/// [`accept`](Integrator::accept) when the attempt is kept. After `accept`, and until the next
/// `step`, [`interpolate`](Integrator::interpolate) gives the solution anywhere in the accepted step.
/// No method but `start` and `restart` allocates.
pub trait Integrator: Send {
    /// What this method is.
    fn info(&self) -> &Info;

    /// Prepares for integrating `system` from `state` with steps of about `step`; completes
    /// `state` with consistent accelerations (and multipliers).
    fn start(&mut self, system: &mut dyn Dynamics, state: &mut State, step: f64) -> Result<(), StepError>;

    /// Attempts one step from `from`, writing the new state to `to`.
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        span: Span,
        to: &mut State,
    ) -> Result<StepReport, StepError>;

    /// Takes note that the last attempt was a trial, by which something was looked for: it does not count as rejected.
    fn discard(&mut self);

    /// Commits the last attempt to the history.
    fn accept(&mut self, from: &State, to: &State);

    /// The solution at time `t` inside the last accepted step, between `from` and `to`. The system
    /// lends its [`retract`](Dynamics::retract): the polynomial lives in the space of increments.
    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State);

    /// Forgets the history after a discontinuity; completes `state`, from now on its right limit, as
    /// [`Integrator::start`] does.
    fn restart(&mut self, system: &mut dyn Dynamics, state: &mut State) -> Result<(), StepError>;

    /// Adds to `out` all that later steps depend on besides the state.
    fn save(&self, out: &mut Checkpoint);

    /// Takes up the history that [`Integrator::save`] wrote, after a [`start`](Integrator::start): the next steps are
    /// bit by bit those that would have followed.
    ///
    /// # Errors
    /// [`NotResumed`] when the history is not one of this method and this system.
    fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed>;

    /// Whether the method resolves contacts in its own steps, so that a driver looks for no events of theirs.
    fn resolves_contacts(&self) -> bool {
        false
    }

    /// Index of the unknown with the largest scaled error or increment in the last attempt.
    fn worst(&self) -> usize;

    /// Work done since `start`.
    fn counters(&self) -> Counters;
}

/// Memory for the rotations of a system's sections.
fn corotation(system: &dyn Dynamics, state: &State) -> Corotation {
    let mut made = Corotation::default();
    system.corotate(state, state, &mut made);
    made.emptied()
}
