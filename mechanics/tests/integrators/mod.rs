//! What each integrator promises: order, stability, dissipation, dense output, messages.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests

mod adaptive;
mod breaks;
mod conformance;
mod constraints;
pub mod drive;
mod failures;
pub mod multibody;
mod order;
mod restart;
mod seam;
mod stability;
mod systems;
