//! Closed forms with their sources: library code that tests and reports share.

mod bessel;
pub mod cantilever;
pub mod pendulum;
pub mod rotating;
pub mod taper;
