//! Steps under step control.

use crate::integrator::{Integration, Span, StepControl, StepError, StepReport};
use crate::system::{Side, State, System};

/// Attempts steps under step control, not longer than `longest`, until one is good.
pub(super) fn adapt(
    system: &mut dyn System,
    integrator: &mut Integration,
    (state, longest): (&State, f64),
    next: &mut State,
    (stop, side): (f64, Side),
    control: &mut StepControl,
) -> Result<(f64, StepReport), StepError> {
    loop {
        let left = stop - state.t;
        let h = control.propose(left).min(longest);
        let lands = h == left;
        let span = if lands { Span { step: h, end: stop, side } } else { Span::new(state.t, h) };
        match integrator.step(system, state, span, next) {
            Ok(report) => {
                let error = report.error.unwrap_or(0.0);
                if error <= 1.0 {
                    control.accepted(h, error, report.iterations);
                    return Ok((h, report));
                }
                control.rejected(h, error, report.iterations);
                give_up(system, control, (state.t, left), (error, report.worst))?;
            }
            Err(
                error @ (StepError::NotConverged { .. }
                | StepError::NotFinite { .. }
                | StepError::Singular { .. }),
            ) => {
                control.failed(h);
                if control.is_too_small(state.t, control.propose(left)) {
                    return Err(error);
                }
            }
            Err(error) => return Err(error),
        }
    }
}

fn give_up(
    system: &dyn System,
    control: &StepControl,
    (time, left): (f64, f64),
    (error, worst): (f64, usize),
) -> Result<(), StepError> {
    let step = control.propose(left);
    if !control.is_too_small(time, step) {
        return Ok(());
    }
    let worst = system.unknown(worst);
    Err(StepError::StepTooSmall { time, step, error, worst })
}
