//! Fixed and adaptive runs for tests.

#![allow(dead_code)]

use flexion::integrator::{Integration, Integrator, Span, StepControl, StepError};
use flexion::system::{State, System};

/// `steps` equal steps to `end`; the callback sees (integrator, system, from, to) of each.
pub fn fixed(
    integrator: &dyn Integrator,
    system: &mut dyn System,
    mut from: State,
    end: f64,
    steps: usize,
    mut each: impl FnMut(&Integration, &mut dyn System, &State, &State),
) -> Result<State, StepError> {
    let h = end / steps as f64;
    let mut integrator = integrator.start(system, &mut from, h)?;
    let mut to = from.clone();
    for _ in 0..steps {
        integrator.step(system, &from, Span::new(from.t, h), &mut to)?;
        integrator.accept(&from, &to);
        each(&integrator, system, &from, &to);
        std::mem::swap(&mut from, &mut to);
    }
    Ok(from)
}

/// Adaptive run to `end`.
pub fn adaptive(
    integrator: &dyn Integrator,
    system: &mut dyn System,
    mut from: State,
    end: f64,
    tolerance: f64,
    mut each: impl FnMut(&Integration, &mut dyn System, &State, &State),
) -> Result<State, StepError> {
    let order = integrator.info().estimate_order.unwrap_or(1);
    let mut integrator = integrator.start(system, &mut from, 0.0)?;
    let first = StepControl::first_step(order, &from, system.scales(), tolerance, end);
    let mut control = StepControl::new(order, end, first);
    let mut to = from.clone();
    while from.t < end * (1.0 - 1e-12) {
        let h = control.propose(end - from.t);
        assert!(!control.is_too_small(from.t, h), "the step fell to {h} at {}", from.t);
        match integrator.step(system, &from, Span::new(from.t, h), &mut to) {
            Ok(report) => {
                let error = report.error.unwrap_or(0.0);
                if error <= 1.0 {
                    integrator.accept(&from, &to);
                    control.accepted(h, error, report.iterations);
                    each(&integrator, system, &from, &to);
                    std::mem::swap(&mut from, &mut to);
                } else {
                    control.rejected(h, error, report.iterations);
                }
            }
            Err(StepError::NotConverged { .. }) => control.failed(h),
            Err(other) => return Err(other),
        }
    }
    Ok(from)
}
