//! What each integrator promises: order, stability, dissipation, dense output, messages.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests

mod adaptive;
mod constraints;
pub mod drive;
mod order;
mod stability;
mod systems;
