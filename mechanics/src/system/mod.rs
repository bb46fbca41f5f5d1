//! The seam: what a mechanical model shows to integrators and analyses.
//!
//! A model has the equations of motion
//!
//! ```text
//! r(t, q, v, a, λ) = M(q) a − f(t, q, v) − G(q)ᵀ λ = 0,     g(t, q) = 0 or g ≥ 0 ⟂ λ ≥ 0,     q̇ = v,  v̇ = a
//! ```
//!
//! and shows four faces, each to those who need it:
//!
//! | trait | used by | content |
//! |---|---|---|
//! | [`Dynamics`] | integrators | residual, tangent, constraints, the space of configurations |
//! | [`Events`] | drivers of a run | known breaks, impulses, indicators |
//! | [`Steady`] | equilibria, modes | parameters that are followed |
//! | [`Observed`] | recording, energy balance | channels, energies, shapes, limits |
//!
//! An integrator never sees M, C or K: it hands over three scalar [`Weights`] and the model writes the one weighted
//! tangent `w.a ∂r/∂a + w.v ∂r/∂v + w.q ∂r/∂q`. Constraints are imposed by the integrator: it hands over three
//! [`RowWeights`] for g, ġ and g̈, so that the forms of index 3, 2 and 1 and Baumgarte's are one formula.
//!
//! The traits are object-safe and every virtual call is made at the level of the system: never inside a loop over
//! elements, where it would cost more than the element.

mod corotation;
mod dynamics;
mod events;
mod limit;
mod observed;
mod rows;
mod sink;
mod state;
mod steady;

pub use corotation::Corotation;
pub use dynamics::{Dynamics, StiffnessForm, VisitRow, Weights};
pub use events::{Break, Crossing, Events, Jump, ordered};
pub use limit::Limit;
pub use observed::{
    ContactInfo, ContactSample, Direction, Energy, Frame, LineForce, Observed, PointForce, Power, Slender,
};
pub use rows::{RowWeights, Set, is_active, replace_inactive, slip};
pub use sink::{Channel, Kind, Role, Sink};
pub use state::{Mode, Side, Size, State};
pub use steady::{NotSet, Parameter, Steady};

/// A whole model: all that an analysis may ask for.
pub trait System: Dynamics + Events + Steady + Observed {}

impl<T: Dynamics + Events + Steady + Observed + ?Sized> System for T {}

/// A system that can be copied at the cost of its work memory: its constants are shared, so that each run or thread has a
/// system of its own and the model is built once. Every system that is `Clone` is one.
pub trait Fork: System {
    /// A copy that from now on is independent of this system.
    fn fork(&self) -> Box<dyn Fork>;
}

impl<T: System + Clone + 'static> Fork for T {
    fn fork(&self) -> Box<dyn Fork> {
        Box::new(self.clone())
    }
}
