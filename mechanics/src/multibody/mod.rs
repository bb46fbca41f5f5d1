//! Bodies in space.

pub mod slender;
