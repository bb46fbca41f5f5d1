//! Errors of a step, with the name of the unknown that shows them.

use super::{Convergence, StepError};
use crate::contact::{Driven, Unresolved};
use crate::linalg::Singular;
use crate::system::{Dynamics, State};

/// The error of a matrix that cannot be factored, be it singular or not finite.
pub(super) fn singular(system: &dyn Dynamics, time: f64, step: f64, cause: Singular) -> StepError {
    let worst = system.unknown(cause.index);
    if !cause.pivot.is_finite() {
        return StepError::NotFinite { time, step, worst };
    }
    StepError::Singular { time, step, pivot: cause.pivot, worst }
}

/// Index of the first entry of `x` that is not finite.
pub(super) fn first_bad(x: &[f64]) -> Option<usize> {
    x.iter().position(|x| !x.is_finite())
}

/// The error of a state that is not finite, from which `step` was taken at `time`.
pub(super) fn not_finite(system: &dyn Dynamics, time: f64, step: f64, state: &State) -> StepError {
    let velocities = state.v.len();
    let index = first_bad(&state.a)
        .or_else(|| first_bad(&state.v))
        .or_else(|| first_bad(&state.q))
        .or_else(|| first_bad(&state.lambda).map(|i| i + velocities))
        .unwrap_or(0);
    StepError::NotFinite { time, step, worst: system.unknown(index) }
}

/// The error of contacts without a solution at `time`, in the iteration with the increment `x`.
pub(super) fn contacts(
    system: &dyn Dynamics,
    (time, step): (f64, f64),
    cause: Unresolved,
    x: &[f64],
) -> StepError {
    if cause.change.is_nan() {
        return StepError::NotFinite { time, step, worst: system.unknown(first_bad(x).unwrap_or(0)) };
    }
    StepError::Contacts { time, step, cause }
}

/// The error of a contact, of this row, that no finite force stops.
pub(super) fn driven(system: &dyn Dynamics, (time, step): (f64, f64), row: usize) -> StepError {
    let contact = system.unknown(system.size().v + row);
    StepError::Driven { time, step, cause: Driven { contact } }
}

/// The error of a Newton iteration that does not converge, whose last increment `x` is `size` times its tolerance.
pub(super) fn not_converged(
    system: &dyn Dynamics,
    (time, step): (f64, f64),
    convergence: &Convergence,
    size: f64,
    x: &[f64],
) -> StepError {
    let worst = system.unknown(largest(x.iter().zip(system.scales()).map(|(x, scale)| (x / scale).abs())));
    if !size.is_finite() {
        return StepError::NotFinite { time, step, worst };
    }
    StepError::NotConverged { time, step, iterations: convergence.iterations(), size, worst }
}

/// Index of the largest number, or of the first that is none.
pub(super) fn largest(sizes: impl Iterator<Item = f64>) -> usize {
    let mut found = (0, 0.0);
    for (i, size) in sizes.enumerate() {
        if size.is_nan() {
            return i;
        }
        if size > found.1 {
            found = (i, size);
        }
    }
    found.0
}
