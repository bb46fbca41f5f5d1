//! Laws of one's own: torques, forces and factors of loads that follow from time and motion.
//!
//! A law gives a number u(t, y) of the time and of recorded quantities y of the motion, positions and velocities. A model applies it
//! through a [`Signal`], a [`Profile`](crate::profile::Profile) that it takes for the torque of a motor or for the amplitude of a load, and
//! [`Commanded`] is the model with its laws:
//!
//! ```text
//! r(t, q, v, a, λ; u) = 0,   uₖ = uₖ(t, y(q, v)),   ∂r/∂q of all = ∂r/∂q + Σₖ ∂r/∂uₖ Σⱼ ∂uₖ/∂yⱼ ∂yⱼ/∂q,   and so by v
//! ```
//!
//! r is linear in u, so that ∂r/∂uₖ is the difference of two residuals; ∂uₖ/∂yⱼ and ∂yⱼ/∂q are central differences. A law couples places that may
//! be far from each other: tangents are then dense.
//!
//! | timing | evaluated | memory |
//! |---|---|---|
//! | [`Timing::Continuous`] | in every evaluation of the residual, in any order of time | none: a second call with the same arguments has to give the same |
//! | [`Timing::Sampled`] | once a sample, in order of time, and held until the next | its own, for a run has a law of its own |
//!
//! Sample times are [breaks](crate::system::Events::breaks). Before a run begins all laws command zero: the state that it begins with is that of the
//! model without them.

mod acting;
mod commanded;
mod input;
mod signal;

pub use commanded::Commanded;
pub use input::{Command, CommandFault, Input, Timing};
pub use signal::{Added, Signal};
