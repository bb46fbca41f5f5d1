//! Analyses: plain functions over a system.

pub mod equilibrium;
pub mod transient;
