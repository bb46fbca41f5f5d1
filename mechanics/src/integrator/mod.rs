//! Time integrators: each a file, each behind two traits. An [`Integrator`] is a method with its parameters; its [`Stepper`] is the
//! method with its memory for one system: predict, iterate, accept, interpolate. An [`Integration`] drives a stepper and owns
//! what all methods have in common. Methods share the auxiliary acceleration (`auxiliary.rs`) and tangents that are kept (`kept.rs`).
//!
//! | method | file | order (q, v) | steps | equations solved a step |
//! |---|---|---|---|---|
//! | [`Radau`] IIA, 3 stages | `radau/` | 5 | adaptive | one real and one complex system per iteration |
//! | [`GeneralizedAlpha`]: Newmark, HHT-α, Chung–Hulbert | `generalized_alpha/` | 2 | fixed | one system per iteration |
//! | [`RungeKutta`], classical | `runge_kutta.rs` | 4 | fixed | mass matrix only |
//! | [`MoreauJean`], nonsmooth | `moreau_jean.rs` | 1 | fixed | one system per iteration, and one per contact |
//! | [`NonsmoothAlpha`], nonsmooth | `nonsmooth_alpha/` | 2 in smooth motion, 1 across impacts | fixed | one system per iteration, and one per contact |
//! | [`Adams`]–Bashforth–Moulton PECE | `adams.rs` | 4 | fixed | mass matrix only |

mod acceleration;
mod adams;
mod auxiliary;
mod checkpoint;
mod failure;
mod generalized_alpha;
mod hermite;
mod impulses;
mod integration;
mod joint_forces;
mod kept;
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
pub use integration::Integration;
pub use moreau_jean::MoreauJean;
pub use newton::{Convergence, Progress};
pub use nonsmooth_alpha::NonsmoothAlpha;
pub use radau::{Radau, Tolerance};
pub use runge_kutta::RungeKutta;
pub use stability::{StabilityLimit, largest_frequency};
pub use step_control::StepControl;

use crate::system::{Dynamics, Side, State};

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
    /// The unknown with the largest estimated error.
    pub worst: usize,
    /// Where the forces of contacts did not settle: what a force and the motion of its contact contradict each other by, over the largest; else 0.
    pub unsettled: f64,
}

/// Why a step failed. Every variant says when, how large and what to try.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// Newton's method did not converge.
    #[error(
        "no convergence at t = {time:.6} s with a step of {step:.3e} s: after {iterations} iterations the increment is {size:.2e} times the tolerance, largest in the {worst}; smaller steps may help, which Radau's method takes by itself, or other sizes of loads and stiffnesses"
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
    /// Newton's method did not converge, for the velocities of joints or closed contacts have come loose: a method without dissipation that
    /// holds positions alone multiplies their rounding errors (Cardona & Géradin, Computers & Structures 33 (1989) 801–820), and every method
    /// does in steps that events shorten.
    #[error(
        "no convergence at t = {time:.6} s with a step of {step:.3e} s: the method holds the positions of joints and closed contacts and not their \
         velocities, which are off by {rate:.2e} m/s or rad/s, and grow from rounding errors; hold them too by the stabilized form (`stabilized`), or, \
         without contacts, take a method with dissipation"
    )]
    Loose {
        /// Time at the start of the step \[s\].
        time: f64,
        /// Step \[s\].
        step: f64,
        /// Largest rate at which a joint or a closed contact moves, in the units of its row a second.
        rate: f64,
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
        "the solution is no longer finite at t = {time:.6} s with a step of {step:.3e} s (first in the {worst}); smaller steps may help, which Radau's method takes by itself, or other sizes of loads and stiffnesses"
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
    #[error(
        "at t = {time:.6} s with a step of {step:.3e} s {cause}; try a smaller step, or a continuous contact force"
    )]
    Contacts {
        /// Time at the start of the step \[s\].
        time: f64,
        /// Step \[s\].
        step: f64,
        /// Why.
        cause: crate::contact::Unresolved,
    },
    /// Nothing stops a contact.
    #[error("at t = {time:.6} s with a step of {step:.3e} s {cause}")]
    Driven {
        /// Time at the start of the step \[s\].
        time: f64,
        /// Step \[s\].
        step: f64,
        /// What is pressed into what.
        cause: crate::contact::Driven,
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

/// What an attempt of a step is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attempt {
    /// The first from its state.
    First,
    /// The one before, from the same state, was rejected or failed.
    Repeated,
    /// A trial step of the location of events: the one before was discarded.
    Trial,
}

/// A time integrator: a method and its parameters.
pub trait Integrator: Send {
    /// What this method is.
    fn info(&self) -> &Info;

    /// Whether the method resolves contacts in its own steps, so that a driver looks for no events of theirs.
    fn resolves_contacts(&self) -> bool {
        false
    }

    /// The memory of the method for integrating `system` from `state` with steps of about `step`; completes `state` as
    /// [`Stepper::restart`] does.
    ///
    /// # Errors
    /// [`StepError`] for a system that the method cannot integrate, or a state without accelerations.
    fn stepper(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
        step: f64,
        counters: &mut Counters,
    ) -> Result<Box<dyn Stepper>, StepError>;

    /// Begins an integration of `system` from `state` with steps of about `step`; completes `state` with consistent
    /// accelerations and multipliers.
    ///
    /// # Errors
    /// As [`Integrator::stepper`].
    fn start(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
        step: f64,
    ) -> Result<Integration, StepError> {
        let mut counters = Counters::default();
        state.side = Side::Right;
        let stepper = self.stepper(system, state, step, &mut counters)?;
        Ok(Integration::new(stepper, self.info().clone(), self.resolves_contacts(), counters))
    }
}

/// The formulas of a method with their memory: an attempt changes no history, which [`Stepper::accept`] does.
/// [`Integration`] says in which order the calls come, counts attempts, and sets time and side of `to`.
pub trait Stepper: Send {
    /// Attempts one step from `from`, writing the new state to `to`.
    ///
    /// # Errors
    /// [`StepError`].
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        attempt: (Span, Attempt),
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError>;

    /// Commits the last attempt to the history.
    fn accept(&mut self, from: &State, to: &State);

    /// The solution at time `t` inside the last accepted step.
    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State);

    /// The accepted step as its energy balance sees it, for methods of order 1 and 2: `out` has the mean velocities, accelerations and
    /// multipliers, so that its power is the mean power of the forces that the method applies, and `damped` the velocities by which it applies those of
    /// dampers.
    fn middle(&self, system: &dyn Dynamics, from: &State, to: &State, out: &mut State, damped: &mut [f64]) {
        self.interpolate(system, from, to, 0.5 * (from.t + to.t), out);
        damped.copy_from_slice(&out.v);
    }

    /// Forgets the history; completes `state` with consistent accelerations and multipliers.
    ///
    /// # Errors
    /// [`StepError`] where there are none.
    fn restart(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError>;

    /// At the state of the last restart contacts have struck, opened, stuck or slipped, or velocities have jumped.
    fn struck(&mut self) {}

    /// Adds the history to `out`.
    fn save(&self, out: &mut Checkpoint);

    /// Takes up the history that [`Stepper::save`] wrote.
    ///
    /// # Errors
    /// [`NotResumed`] when it is not one of this method and this system.
    fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed>;
}
