//! Analyses: plain functions over a system.

pub mod campbell;
mod crossings;
mod energy_balance;
pub mod equilibrium;
mod follow;
pub mod modes;
pub mod rotation;
mod stiffness;
pub mod superposition;
mod tracking;
pub mod transient;
mod worker;

pub use energy_balance::EnergyBalance;
