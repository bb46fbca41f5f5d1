//! Analyses: plain functions over a system.

mod audit;
pub mod campbell;
pub mod equilibrium;
pub mod modes;
pub mod rotation;
mod stiffness;
mod tracking;
pub mod transient;
