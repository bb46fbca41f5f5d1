//! Analyses: plain functions over a system.

mod audit;
pub mod campbell;
mod crossings;
pub mod equilibrium;
mod ledger;
pub mod modes;
pub mod rotation;
mod speeds;
mod stiffness;
pub mod superposition;
mod tracking;
pub mod transient;

pub use ledger::Books;
