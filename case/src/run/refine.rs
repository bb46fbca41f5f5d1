//! Refinement of a case until what is asked of it is accurate enough: what is asked, and what is said.

use super::Run;
use crate::change::Change;
use crate::problem::Problems;
use crate::reading::Reading;
use crate::units;
use flexion::analysis::error::{self, Effort, Ended, GivenUp, Goal, Part, principal, refine};
use flexion::analysis::recording::Watch;
use flexion::system::Role;
use flexion_results::{ResultsError, Rung, Status, Trajectory, nearest};

/// What is to be how accurate.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    tolerance: String,
    quantity: Option<String>,
}

/// A refined case and its run.
pub struct Refinement {
    /// The case that was refined.
    pub reading: Reading,
    /// Its run, with its errors and their sequence.
    pub run: Run,
    /// Why what was asked is not reached; `None` where it is.
    pub refused: Option<String>,
}

/// Why nothing was refined.
#[derive(Debug, thiserror::Error)]
pub enum RefineError {
    /// The case is to blame.
    #[error(transparent)]
    Case(#[from] Problems),
    /// There is no such column.
    #[error(transparent)]
    Column(#[from] ResultsError),
    /// The tolerance is to blame.
    #[error("the tolerance `{text}` {reason}")]
    Tolerance {
        /// What was written.
        text: String,
        /// What is wrong with it.
        reason: String,
    },
}

impl Target {
    /// A tolerance of the largest value of each quantity, `1e-4`, or with a unit, `0.1 mm`; and a quantity, `tip.deflection`,
    /// `tip.deflection.min`, `.max` or `.final`. Without one all principal columns are meant, or those of that kind of unit.
    pub fn new(tolerance: String, quantity: Option<String>) -> Target {
        Target { tolerance, quantity }
    }

    /// The columns with their bounds. Of all principal ones those that vanish have none; `size` \[m\] is that of the model.
    pub(super) fn goals(&self, trajectory: &Trajectory, size: f64) -> Result<Vec<Goal>, RefineError> {
        if let Some(quantity) = &self.quantity {
            let (column, part) = split(quantity);
            let moves = |index: &usize| trajectory.channels()[*index].role != Role::Integration;
            let index = trajectory.index(column).filter(moves).ok_or_else(|| unknown(column, trajectory))?;
            return Ok(vec![self.goal(trajectory, index, part)?]);
        }
        let principal = principal(trajectory, size);
        // A tolerance with a unit bounds the columns that it fits.
        let fits = |index: &usize| {
            self.is_relative()
                || units::parse_in(&self.tolerance, &trajectory.channels()[*index].unit).is_ok()
        };
        let fitting: Vec<usize> = principal.iter().copied().filter(fits).collect();
        let asked = if fitting.is_empty() { principal } else { fitting };
        asked.into_iter().map(|index| self.goal(trajectory, index, Part::History)).collect()
    }

    /// Whether the tolerance is a part of the largest value.
    fn is_relative(&self) -> bool {
        self.tolerance.trim().parse::<f64>().is_ok()
    }

    fn goal(&self, trajectory: &Trajectory, index: usize, part: Part) -> Result<Goal, RefineError> {
        let channel = &trajectory.channels()[index];
        let fault = |reason: String| RefineError::Tolerance { text: self.tolerance.clone(), reason };
        let bound = match self.tolerance.trim().parse::<f64>() {
            Ok(relative) => relative * trajectory.extremes(index).largest(),
            Err(_) => units::parse_in(&self.tolerance, &channel.unit)
                .map_err(|error| fault(format!("of `{}` is no number: {}", channel.name, error.message)))?,
        };
        if bound.is_nan() || bound < 0.0 || self.tolerance.trim().starts_with(['-', '0']) && bound == 0.0 {
            return Err(fault(
                "must be a number > 0, or one with a unit of the quantity, e.g. `0.1 mm`".to_owned(),
            ));
        }
        let rounding = f64::EPSILON * trajectory.extremes(index).largest();
        if bound < rounding {
            return Err(fault(format!(
                "is below {rounding:.1e}, the last digit of the largest `{}`",
                channel.name
            )));
        }
        Ok(Goal { column: channel.name.clone(), part, bound })
    }
}

/// The column and the part of it that `tip.deflection.min` names.
fn split(quantity: &str) -> (&str, Part) {
    let parts = [(".min", Part::Min), (".max", Part::Max), (".final", Part::Final)];
    let found = parts.into_iter().find_map(|(end, part)| Some((quantity.strip_suffix(end)?, part)));
    found.unwrap_or((quantity, Part::History))
}

fn unknown(column: &str, trajectory: &Trajectory) -> ResultsError {
    let moving = trajectory.channels().iter().filter(|channel| channel.role != Role::Integration);
    let names: Vec<&str> = moving.map(|channel| channel.name.as_str()).collect();
    ResultsError::NoColumn {
        pattern: column.to_owned(),
        of: "this run".to_owned(),
        nearest: nearest(column, names.iter().copied()).map(str::to_owned),
        there: names.join(", "),
    }
}

impl Reading {
    /// Refines the case until the estimated errors of what is asked are below their tolerance, or cannot be brought there. The result is
    /// the run with the smallest error; one that `watch` has stopped counts only where it is the first. `said` is shown each run.
    ///
    /// # Errors
    /// [`RefineError`]: a case that cannot be refined, a column that is not there, a tolerance that is none.
    pub fn refine(
        &self,
        target: &Target,
        watch: &mut Watch<'_>,
        said: &mut dyn FnMut(&Rung),
    ) -> Result<Refinement, RefineError> {
        self.has_errors()?;
        let goals = |trajectory: &Trajectory| target.goals(trajectory, self.case.size());
        let found = refine(self, &goals, watch, &mut |rung| said(&self.rung(rung)))?;
        let refused = refused(&found.ended, found.rungs.last());
        let mut run = found.run;
        run.errors = found.errors.map(|errors| self.errors(errors, Effort::Full));
        if let Some(errors) = &mut run.errors {
            errors.sequence = found.rungs.iter().map(|rung| self.rung(rung)).collect();
        }
        if run.status == Status::Finished {
            run.message.clone_from(&refused);
        }
        Ok(Refinement { reading: self.at(&found.variant)?, run, refused })
    }

    /// A run of a sequence as it is written.
    fn rung(&self, rung: &error::Rung) -> Rung {
        let changes = self.at(&rung.variant).map_or_else(|_| Vec::new(), |reading| reading.mesh_and_steps());
        let changes = changes.iter().map(Change::to_string).collect();
        let error::Rung { goal, value, error, order, .. } = rung;
        Rung { changes, quantity: goal.quantity(), value: *value, error: *error, order: *order }
    }
}

/// Why a sequence ended before its goal, of which `last` is the last run, if it did.
pub(super) fn refused(ended: &Ended<Problems>, last: Option<&error::Rung>) -> Option<String> {
    let found = last.map_or(String::new(), |rung| {
        let (quantity, bound) = (rung.goal.quantity(), rung.goal.bound);
        format!("the error of {quantity} is {:.1e} and not below {bound:.1e}", rung.error)
    });
    let better = "ask for less, or begin with a finer mesh";
    let why = match ended {
        Ended::Reached => return None,
        Ended::Unknown => return Some("whether the tolerance is held is not known: the errors could not be estimated".to_owned()),
        Ended::Failed(error) => return Some(format!("a refined run failed: {error}")),
        Ended::Refused(problems) => {
            format!(", and the case cannot be refined further: {}", problems.reason())
        }
        Ended::GivenUp(GivenUp::Amplified) => {
            ", and errors do not fall: the motion amplifies differences, as an unstable or chaotic one does; ask for a shorter time, or for \
             less"
                .to_owned()
        }
        Ended::GivenUp(GivenUp::Rounding) => {
            ", and errors no longer fall: rounding, which grows with the mesh, is of their size; ask for less".to_owned()
        }
        Ended::GivenUp(GivenUp::NotFalling) => {
            ", and errors do not fall: a load may have no derivative, or a section a jump within an element; ask for less"
                .to_owned()
        }
        Ended::GivenUp(GivenUp::Refinements(most)) => format!(" after {most} refinements: {better}"),
        Ended::GivenUp(GivenUp::Work(all, next)) => format!(
            " after {all:.1e} steps times unknowns, and the next refinement would take {next:.1e}: {better}"
        ),
        _ => return Some("stopped by the user".to_owned()),
    };
    Some(format!("{found}{why}"))
}
