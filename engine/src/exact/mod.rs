//! Closed forms with their sources: library code that tests and reports share.

pub mod cantilever;
