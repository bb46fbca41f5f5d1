//! The spatial slender beam.

mod derivatives;
mod newton;
mod statics;
