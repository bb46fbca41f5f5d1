//! The spatial slender beam.

#![allow(clippy::unwrap_used, clippy::panic)]

mod automatic;
mod bend;
mod buckling;
mod coupled;
mod derivatives;
mod dynamics;
mod frequencies;
mod helix;
mod invariance;
pub mod newton;
mod plane;
mod princeton;
mod refusals;
mod rotation;
