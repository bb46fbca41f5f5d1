//! Bodies in space that move and rotate by any amount.

pub mod slender;
