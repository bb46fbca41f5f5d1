//! The spatial slender beam.

mod cost;
mod derivatives;
mod newton;
mod statics;
