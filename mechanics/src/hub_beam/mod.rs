//! A flexible beam on a rigid hub that rotates about a fixed axis, in the hub's frame (P1, P3, P4).
//!
//! The hub has radius a and angle θ(t); the beam is clamped to it radially, x ∈ [0, L]. In the hub's frame
//! the axis is at X = a + x + (axial displacement), Y = (transverse displacement). A [`Coupling`] says which
//! terms of the kinematics are kept:
//!
//! | coupling | kept | fails when |
//! |---|---|---|
//! | [`zeroth`](LinearCoupling) | small displacements on a rigidly rotating beam | θ̇ nears the first frequency |
//! | [`first`](LinearCoupling) | foreshortening, to first order in the kinetic energy | deflections are no longer small |
//! | [`high`](HighCoupling) | the same foreshortening, to every order in the kinetic energy | the same |
//! | [`exact`](ExactCoupling) | everything but shear | strains are no longer small |

mod beam;
mod contact_point;
mod contact_points;
mod coupling;
mod damping;
mod element;
mod exact;
mod fields;
mod high;
mod hub;
mod inertia;
mod isotropic;
mod linear;
pub mod load;
mod lumped;
mod measured;
mod point_forces;
mod positive;
mod product;
mod rule;
mod section_forces;
mod section_rotation;
mod station;
mod system;
#[cfg(test)]
mod tests;
mod vectors;

pub use beam::{Beam, Mass};
pub use contact_point::{ContactPoint, Mount};
pub use coupling::Coupling;
pub use damping::Damping;
pub use exact::ExactCoupling;
pub use fields::{Fields, Point, Shapes};
pub use high::HighCoupling;
pub use hub::{Drive, FreeHub, Hub};
pub use inertia::{Border, Foreshortening, Inertia, Scratch, Totals};
pub use linear::LinearCoupling;
pub use section_forces::{Sampling, SectionForces};
pub use station::{Placement, Station};
pub use system::HubBeam;
