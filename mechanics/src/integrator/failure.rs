//! How failures of a step are told: with the label of the unknown to blame.

use super::StepError;
use crate::linalg::Singular;
use crate::system::{State, System};

/// Name of unknown `index`.
pub(super) fn label(system: &dyn System, index: usize) -> String {
    system.labels().get(index).map_or_else(|| format!("unknown {index}"), |label| label.name.clone())
}

/// The error of a matrix that cannot be factored, be it singular or not finite.
pub(super) fn singular(system: &dyn System, time: f64, step: f64, cause: Singular) -> StepError {
    if !cause.pivot.is_finite() {
        return StepError::NotFinite { time, step, worst: label(system, cause.index) };
    }
    StepError::Singular { time, step, pivot: cause.pivot, worst: label(system, cause.index) }
}

/// Index of the first entry of `x` that is not finite.
pub(super) fn first_bad(x: &[f64]) -> Option<usize> {
    x.iter().position(|x| !x.is_finite())
}

/// The error of a state that is not finite, from which `step` was taken at `time`.
pub(super) fn not_finite(system: &dyn System, time: f64, step: f64, state: &State) -> StepError {
    let velocities = state.v.len();
    let index = first_bad(&state.a)
        .or_else(|| first_bad(&state.v))
        .or_else(|| first_bad(&state.q))
        .or_else(|| first_bad(&state.lambda).map(|i| i + velocities))
        .unwrap_or(0);
    StepError::NotFinite { time, step, worst: label(system, index) }
}
