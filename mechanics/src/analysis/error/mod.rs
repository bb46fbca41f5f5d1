//! Errors of what a run gives, from companions: the same motion on a finer mesh, with smaller steps, disturbed, or by another model.
//!
//! Whoever can run the [variants](Variant) of a motion implements [`Refinable`]: for a system of its own, or for a case read from a file.
//! [`estimate`] then gives every recorded value its error, and says what makes it doubtful; [`refine`] refines mesh and steps until what is
//! asked is accurate enough. Who has several models, meshes and methods for it implements [`Ladder`], and [`advise()`] finds the cheapest that are
//! accurate enough. All return data: what is said of them, and in what words, is left to the program.
//!
//! The [front page](crate) has an example.

mod advise;
mod coarse;
mod estimate;
mod impacts;
mod instability;
mod pair;
mod refine;
mod trust;
mod variant;

pub use advise::{Advice, Choice, Fault, Ladder, NoAdvice, NoDifference, NotTrusted, Tried, advise};
pub use coarse::{COARSE, Coarse, Remedy};
pub use estimate::{Companion, Doubt, Effort, Estimate, NoEstimate, ROUNDING, estimate};
pub use impacts::before_impacts;
pub use instability::Unstable;
pub use pair::{ColumnError, Pair};
pub use refine::{Ended, GivenUp, Goal, Part, Refinement, Rung, principal, refine};
pub use trust::{Finer, Parting};
pub use variant::{Disturbance, Mesh, Variant};

use super::recording::{Record, Watch};

/// Largest error of a mesh over its difference from one of twice as many functions: 2 covers every order of convergence p ≥ 1, with half
/// as much again in reserve for p ≥ 2.
pub const SAFETY: f64 = 2.0;

/// A motion that can be computed in several ways.
pub trait Refinable {
    /// What a run gives: its records, and whatever else its program wants of it.
    type Run: AsRef<Record> + Into<Record>;
    /// Why a variant cannot be run.
    type Fault;

    /// The motion as it is asked for.
    fn variant(&self) -> Variant;

    /// Runs a variant; `watch` is shown every step and ends the run by `Break`. A run that ends early is no error: its record says so.
    ///
    /// # Errors
    /// Where there is no such variant: its mesh is too fine, its step beyond a limit, or there is no other model.
    fn run(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Self::Run, Self::Fault>;

    /// As [`Refinable::run`], of which the records alone are wanted.
    ///
    /// # Errors
    /// As [`Refinable::run`].
    fn record(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Record, Self::Fault> {
        self.run(variant, watch).map(Into::into)
    }

    /// Whether there is a mesh to refine.
    fn has_mesh(&self) -> bool {
        true
    }

    /// Whether there is a reference model, which leaves out less than the own one does.
    fn has_reference(&self) -> bool {
        false
    }

    /// A length \[m\] beside which displacements are large or small.
    fn size(&self) -> f64 {
        1.0
    }

    /// S: largest error of a mesh over its difference from one of twice as many functions.
    fn safety(&self) -> f64 {
        SAFETY
    }
}
