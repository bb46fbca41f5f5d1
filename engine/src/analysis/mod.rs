//! Analyses: plain functions over a system.

mod audit;
pub mod equilibrium;
mod ledger;
pub mod transient;

pub use ledger::Books;
