//! Laws of one's own: torques, forces and factors of loads that follow from time and motion.
//!
//! A law gives a number u(t, y, x) of the time, of recorded quantities y of the motion, positions and velocities, and of states x of its own. A model applies it
//! through a [`Signal`], a [`Profile`](crate::profile::Profile) that it takes for the torque of a motor or for the amplitude of a load, and
//! [`Commanded`] is the model with its laws:
//!
//! ```text
//! r(t, q, v, a, λ; u) = 0,   uₖ = uₖ(t, y(q, v), x),   ẋ = f(t, y(q, v), x)
//! ∂r/∂q of all = ∂r/∂q + Σₖ ∂r/∂uₖ Σⱼ ∂uₖ/∂yⱼ ∂yⱼ/∂q,   and so by v and x
//! ```
//!
//! r is linear in u, so that ∂r/∂uₖ is the difference of two residuals; ∂uₖ/∂yⱼ and ∂yⱼ/∂q are central differences. A law couples places that may
//! be far from each other: tangents are then dense.
//!
//! A state is to every method of integration the velocity of an unknown of its own, x = Ẋ with the mass 1: its equation is a − f(t, y, x) = 0 with a = ẋ.
//! Its error is controlled and stated like that of a velocity, measured by its [size](LawState::size).
//!
//! | timing | evaluated | memory |
//! |---|---|---|
//! | [`Timing::Continuous`] | in every evaluation of the residual, in any order of time | its states alone: a second call with the same arguments has to give the same |
//! | [`Timing::Sampled`] | once a sample, in order of time, and held until the next | its own, for a run has a law of its own |
//!
//! Sample times are [breaks](crate::system::Events::breaks). Before a run begins all laws command zero: the state that it begins with is that of the
//! model without them.

mod acting;
mod commanded;
mod input;
mod seen;
mod signal;

pub use commanded::Commanded;
pub use input::{Command, CommandFault, Input, LawState, Timing};
pub use signal::{Added, Signal};
