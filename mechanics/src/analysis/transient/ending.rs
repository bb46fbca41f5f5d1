//! How a run ends.

use crate::contact::ImpactError;
use crate::integrator::{NotResumed, StepError};
use crate::system::{Limit, State, System};

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// At its end time.
    Finished,
    /// An observer stopped it.
    Stopped,
    /// It could not go on.
    Failed(RunError),
}

/// Why a run could not go on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The integrator gave up.
    #[error("{error}{}", because(.reason))]
    Step {
        /// What the integrator says.
        error: StepError,
        /// What the model knows about it.
        reason: Option<Box<Limit>>,
    },
    /// The model left its range.
    #[error("the run broke down at t = {time:.4} s: {what}{}", because(.reason))]
    Inadmissible {
        /// Time \[s\].
        time: f64,
        /// What is out of range.
        what: Limit,
        /// What the model knows about it.
        reason: Option<Box<Limit>>,
    },
    /// The history of an earlier run could not be taken up.
    #[error("the run cannot go on: {0}")]
    NotResumed(#[from] NotResumed),
    /// Contacts have no solution.
    #[error("the contacts cannot be resolved at t = {time:.6} s: {cause}")]
    Contact {
        /// Time \[s\].
        time: f64,
        /// Why.
        cause: ImpactError,
    },
    /// Events accumulate.
    #[error(
        "{count} events follow each other at t = {time:.9} s with no time between them: the contacts chatter; give them less restitution or use a continuous contact force"
    )]
    Chatter {
        /// Time \[s\].
        time: f64,
        /// Events.
        count: usize,
    },
    /// The model ended the run.
    #[error("the run was ended at t = {time:.6} s: {reason}")]
    Ended {
        /// Time \[s\].
        time: f64,
        /// Why.
        reason: Limit,
    },
}

fn because(reason: &Option<Box<Limit>>) -> String {
    reason.as_ref().map(|r| format!("; {r}")).unwrap_or_default()
}

/// The error of a step, with what the model knows about it.
pub(super) fn failed(system: &mut dyn System, state: &State, error: StepError) -> RunError {
    // What the error says already is not said again.
    let reason = system.explain(state).filter(|reason| !error.to_string().contains(&reason.to_string()));
    // A law that gives nothing leaves no numbers; it is the reason, whatever the step says of them.
    if let Some(reason @ Limit::Command { .. }) = reason {
        return RunError::Ended { time: state.t, reason };
    }
    RunError::Step { error, reason: reason.map(Box::new) }
}
