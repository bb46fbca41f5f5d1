//! The error of a run, and what is said of it.

use super::Run;
use crate::kinds::initial::Initial;
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::analysis::error::{
    COARSE, Coarse, Companion, Doubt, Effort, Estimate, Finer, NoEstimate, Parting, Refinable, Remedy,
    Unstable, estimate,
};
use flexion::analysis::recording::Watch;
use flexion_results::Errors;

impl Reading {
    /// Runs the companions of a run of this case, and compares. `watch` is shown their progress. Where a companion cannot be run, or, with
    /// [`Effort::Auto`], would be costly, or where `watch` stops one, there is no estimate, and [`Errors::unknown`] says why.
    pub fn estimate_errors(&self, run: &Run, effort: Effort, watch: &mut Watch<'_>) -> Errors {
        match self.has_errors() {
            Err(problems) => unknown(problems.reason(), effort),
            Ok(()) => self.errors(estimate(self, &self.variant(), run.as_ref(), effort, watch), effort),
        }
    }

    /// Refuses a case whose errors cannot be estimated.
    pub(super) fn has_errors(&self) -> Result<(), Problems> {
        let Initial::Restart(_) = self.case.initial else { return Ok(()) };
        let message = "the error of a run that goes on from a stored state cannot be estimated: the state belongs to \
                       its mesh; estimate it for the whole run";
        Err(self.problem("initial", message))
    }

    /// The errors as they are written.
    pub(super) fn errors(
        &self,
        estimated: Result<Estimate<Problems>, NoEstimate<Problems>>,
        effort: Effort,
    ) -> Errors {
        match estimated {
            Ok(estimate) => {
                let unstable = estimate.unstable().cloned();
                let warnings = estimate.doubts.iter().map(|doubt| self.doubt(doubt)).collect();
                let Estimate { columns, trusted, distrusted, finer, safety, .. } = estimate;
                Errors {
                    columns,
                    warnings,
                    trusted,
                    distrusted,
                    unstable,
                    finer,
                    safety,
                    ..Errors::default()
                }
            }
            Err(NoEstimate::Costly(work)) => Errors::none(format!(
                "the run took {work:.1e} steps times unknowns, and its companions several times as many: `--error full` runs them"
            )),
            Err(NoEstimate::Refused(problems)) => {
                // The case itself is sound: it has run.
                unknown(format!("there is no finer run: {}", problems.reason()), effort)
            }
            Err(NoEstimate::Stopped) => {
                Errors::none("the runs that estimate them were stopped by the user".to_owned())
            }
            Err(_) => unknown("the first impact comes within the first step or record".to_owned(), effort),
        }
    }

    /// A doubt as a warning.
    fn doubt(&self, doubt: &Doubt<Problems>) -> String {
        match doubt {
            Doubt::GivenUp => {
                "a companion was given up for the work it takes: `--error full` runs it to its end".to_owned()
            }
            Doubt::BeforeImpact { time } => format!(
                "the errors are those until t = {time:.6} s, before the first impact: what an impact on a beam does is a matter of \
                 the mesh"
            ),
            Doubt::Parting(Parting { time, given_up, by }) => {
                let what = match by {
                    Finer::Tolerance => "a tenth of the tolerance",
                    Finer::Step => "half the step",
                };
                if *given_up {
                    format!(
                        "gaps and impacts are known until t = {time:.6} s only: a run with {what} was given up there"
                    )
                } else {
                    format!(
                        "from t = {time:.6} s gaps and impacts are not those of a run with {what}: impacts amplify every \
                         difference"
                    )
                }
            }
            Doubt::Refused { companion, fault } => {
                let what = match companion {
                    Companion::Reference => {
                        "the difference to the exact coupling is not known, for there is no run of it"
                    }
                    Companion::SmallerSteps => "until when gaps and impacts are right is not known",
                    Companion::Disturbed => "whether the motion is unstable is not known",
                    Companion::Finer => "the errors are not known",
                };
                format!("{what}: {}", fault.reason())
            }
            Doubt::Unstable(Unstable { size, column, from, until }) => format!(
                "a disturbance of {size:e} of the amplitudes grows from t = {from:.6} s to {until:.6} s to a hundredth of \
                 the motion, first in {column}: the motion is unstable; a small force written into the \
                 case shows where it leads"
            ),
            Doubt::Unfinished { companion, time, why } => {
                let what = if *companion == Companion::Reference { "exact" } else { "finer" };
                let stopped = || format!("it was given up at t = {time:.6} s");
                let why = why.as_ref().map_or_else(stopped, ToString::to_string);
                format!(
                    "the {what} companion of the run did not finish, and errors are known until then only: {why}"
                )
            }
            Doubt::Coarse(coarse) => self.coarse(coarse),
            _ => "the errors are doubtful".to_owned(),
        }
    }

    /// The warning of a coarse mesh.
    fn coarse(&self, Coarse { column, part, remedy }: &Coarse) -> String {
        let said =
            format!("mesh and steps are coarse: the error of {column} {} of its largest value", much(*part));
        match remedy {
            Remedy::MeshAndSteps => format!("{said}; `--tolerance {COARSE}` refines them"),
            Remedy::Mesh(mesh, order) => {
                let changes = super::variant::said(&self.mesh_changes(*mesh).unwrap_or_default());
                format!("{said}; with `{changes}` it is below 1 % (observed order {order:.1})")
            }
            Remedy::None => format!(
                "{said}, and twice the functions do not bring it down: the motion has waves that no mesh of this size follows; \
                 let loads set in more slowly, damp it, or ask for a shorter time"
            ),
            _ => format!(
                "{said}, and a finer mesh alone does not bring it down: `--tolerance {COARSE}` refines mesh and steps"
            ),
        }
    }
}

/// No estimate, and why. Someone who has asked for it is warned.
fn unknown(why: String, effort: Effort) -> Errors {
    let warning = (effort == Effort::Full).then(|| format!("the errors could not be estimated: {why}"));
    Errors { warnings: warning.into_iter().collect(), ..Errors::none(why) }
}

/// How large a part of a value is, in words.
pub(crate) fn much(part: f64) -> String {
    match (100.0 * part).ceil() {
        percent if percent < 100.0 => format!("is {percent:.0} %"),
        _ => "is as large as all".to_owned(),
    }
}
