//! Where parts come to rest that loads drive and contacts stop.
//!
//! A mechanism has no equilibrium near its start, and Newton's method, which sees no obstacle before it is inside, may go through one. The motion
//! without inertia M q̇ = −r sinks until contacts hold it. Its implicit steps, each linear but for the contacts, are
//!
//! ```text
//! (K + σM) δ − Gᵀ λ′ = −(r + Gᵀ λ),   g + G δ = 0 of joints,   g + G δ ≥ 0 ⟂ λ′ ≥ 0 of contacts,   q ← q ⊞ δ
//! ```
//!
//! with σ = 1/h large enough for K + σM to be positive definite on what the rows allow, which makes δ lead downwards, and for δ to be short. σ falls
//! as the motion slows down, until the steps are those of Newton's method: pseudo-transient continuation. Which contacts hold is found as for an
//! [equilibrium](super::equations), one change after the other, but of every step.
//!
//! Source: C. T. Kelley, D. E. Keyes, *SIAM J. Numer. Anal.* 35 (1998) 508–523, doi:10.1137/S0036142996304796.

use super::equations::{Equations, Failure, highest, largest};
use super::stiffness::mass;
use crate::system::State;
use std::ops::ControlFlow;

/// Longest step, scaled.
const LONGEST: f64 = 0.1;
/// Scaled step at which the motion is at rest.
const RESTS: f64 = 1e-9;
/// Factor by which σ grows and falls.
const GROWTH: f64 = 4.0;
/// Smallest and largest σ over the square of the highest frequency.
const RANGE: [f64; 2] = [1e-12, 1e6];
/// Steps allowed.
const STEPS: usize = 3000;

/// Brings `state` to rest under all of the loads, near an equilibrium that is left to [`Equations::solve`].
pub(super) fn settle(
    equations: &mut Equations<'_>,
    state: &mut State,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<(), Failure> {
    let unit = unit(equations, state);
    let mut hold = RANGE[0] * unit;
    for _ in 0..STEPS {
        if watch(1.0).is_break() {
            return Err(Failure::of("the search was stopped"));
        }
        let mut steep = false;
        let (d, size) = loop {
            equations.hold = hold;
            let modes = state.mode.clone();
            let step = equations.sink(state);
            let failure = match step {
                Ok(Some(d)) => {
                    let (worst, size) = largest(&d, equations.scales());
                    if size <= LONGEST {
                        break (d, size);
                    }
                    Failure {
                        worst,
                        ..Failure::of("parts begin too deep inside an obstacle, or no step is short enough")
                    }
                }
                Ok(None) => {
                    steep = true;
                    Failure::of("the stiffness is negative in some direction")
                }
                Err(failure) => failure,
            };
            state.mode.copy_from_slice(&modes);
            hold *= GROWTH;
            if !(hold <= RANGE[1] * unit) {
                return Err(failure);
            }
        };
        equations.take(state, &d);
        if size <= RESTS && (steep || hold <= RANGE[0] * unit) {
            return Ok(());
        }
        hold = (hold / GROWTH).max(RANGE[0] * unit);
    }
    Err(Failure::of("what the loads drive comes to no rest on its contacts"))
}

/// Square of the highest frequency, or of that with which the loads would move the system by its size [1/s²].
fn unit(equations: &mut Equations<'_>, state: &State) -> f64 {
    let mass = mass(equations.system, state);
    let forces = equations.forces(state);
    let scales = equations.scales();
    let driven = (0..forces.len()).map(|i| (forces[i] / (mass.get(i, i) * scales[i])).abs());
    let driven = driven.filter(|x| x.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
    highest(equations.system, state).max(driven)
}
