//! Analyses: plain functions over a system.

mod audit;
pub mod equilibrium;
pub mod transient;
