//! Analyses: plain functions over a system.

pub mod campbell;
mod crossings;
mod diagram;
mod energy_balance;
pub mod equilibrium;
mod joints;
pub mod modes;
pub mod rotation;
mod speeds;
mod stiffness;
pub mod superposition;
mod tracking;
pub mod transient;
mod violation;

pub use energy_balance::EnergyBalance;
pub use violation::Violation;
