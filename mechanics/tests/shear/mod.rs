//! The beam with shear.

#![allow(clippy::unwrap_used, clippy::panic)]

mod automatic;
mod chain;
mod derivatives;
mod flight;
mod invariance;
mod large;
mod linear;
mod nilpotent;
mod refusals;
