//! Analyses: plain functions over a system.

mod audit;
pub mod campbell;
mod crossings;
pub mod equilibrium;
mod follow;
mod ledger;
pub mod modes;
pub mod rotation;
mod stiffness;
pub mod superposition;
mod tracking;
pub mod transient;
mod worker;

pub use ledger::Books;
