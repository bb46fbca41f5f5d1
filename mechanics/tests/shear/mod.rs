//! The beam with shear.

#![allow(clippy::unwrap_used, clippy::panic)]

mod automatic;
mod derivatives;
mod invariance;
mod nilpotent;
