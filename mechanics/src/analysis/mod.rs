//! Analyses: plain functions over a system.

pub mod campbell;
mod crossings;
mod degenerate;
mod diagram;
mod disturbance;
mod energy_balance;
mod equations;
pub mod equilibrium;
pub mod error;
mod joints;
pub mod linearization;
mod mac;
mod mechanism;
pub mod mesh_error;
pub mod modes;
pub mod path;
pub mod periodic;
mod polynomial;
pub mod recording;
mod resonance;
mod rigid;
pub mod rotation;
mod settling;
mod solved;
mod speeds;
mod stability;
mod stiffness;
pub mod superposition;
mod tracking;
pub mod transient;
mod violation;

pub use disturbance::disturb;
pub use energy_balance::{EnergyBalance, rounding_energy};
pub use stability::{Stability, stability};
pub use violation::Violation;
