//! Motions that nothing holds and that loads drive: a mechanism has no equilibrium near the state in which it is.
//!
//! A motion x without stiffness about a state without loads leaves the state in equilibrium. Where the loads f do work on it,
//! fᵀx ≠ 0, there is none as soon as they set in, however small they are.

use super::equations::apply;
use super::modes::modes;
use crate::system::{State, System};
use num_complex::Complex64;

/// Modes among which motions without stiffness are looked for: those of one rigid body.
const MOTIONS: usize = 6;
/// Work of the loads on a motion, over that of their components, from which it is more than rounding.
const WORK: f64 = 1e-9;

/// The unknown that is the largest of a motion without stiffness about the unloaded `state` on which the loads do work; `None` where
/// there is no such motion. The system carries all of its loads on return.
pub(super) fn driven_motion(system: &mut dyn System, state: &State) -> Option<String> {
    let size = system.size();
    let mut state = state.clone();
    state.v.fill(0.0);
    state.a.fill(0.0);
    apply(system, 0.0);
    let mut without = vec![0.0; size.v];
    system.residual(&state, &mut without);
    let free = modes(system, &state, MOTIONS, &[]);
    apply(system, 1.0);
    let mut loads = vec![0.0; size.v];
    system.residual(&state, &mut loads);
    loads.iter_mut().zip(&without).for_each(|(f, r)| *f -= r);
    let scales = system.scales().to_vec();
    let free = free.ok()?.modes.into_iter().filter(|mode| mode.eigenvalue == Complex64::ZERO);
    for mode in free {
        let terms = || mode.vector.iter().zip(&loads).map(|(x, f)| x.re * f);
        if terms().sum::<f64>().abs() > WORK * terms().map(f64::abs).sum::<f64>() {
            let sizes = mode.vector.iter().zip(&scales).map(|(x, scale)| x.norm() / scale);
            let (largest, _) = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
            return Some(system.unknown(largest));
        }
    }
    None
}
