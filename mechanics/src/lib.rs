//! **Flexion**: rigid–flexible coupled dynamics of rotating and slender beams.
//!
//! The flow is one-directional: a case file is read, validated and made into a
//! [`system::System`] and an [`integrator::Integrator`]; an analysis drives the pair and
//! hands the recorded trajectory to the output. Every quantity inside the library is in SI
//! units. See `ARCHITECTURE.md` for the layers and what may import what.

pub mod analysis;
pub mod basis;
pub mod blade;
pub mod contact;
pub mod exact;
pub mod hub_beam;
pub mod integrator;
pub mod linalg;
pub mod profile;
pub mod quadrature;
pub mod section;
pub mod system;
pub mod verify;
