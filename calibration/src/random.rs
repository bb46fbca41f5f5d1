//! Random numbers of a drawn case.

use fastrand::Rng;
use std::ops::Range;

/// A source of random numbers; the same seed gives the same case on every machine.
pub(super) struct Random(Rng);

impl Random {
    pub(super) fn new(seed: u64) -> Random {
        Random(Rng::with_seed(seed))
    }

    /// A number between two others.
    pub(super) fn between(&mut self, range: Range<f64>) -> f64 {
        rounded(range.start + (range.end - range.start) * self.0.f64())
    }

    /// A number between two others, whose logarithm is evenly distributed.
    pub(super) fn scale(&mut self, range: Range<f64>) -> f64 {
        rounded((range.start.ln() + (range.end.ln() - range.start.ln()) * self.0.f64()).exp())
    }

    pub(super) fn count(&mut self, range: Range<usize>) -> usize {
        self.0.usize(range)
    }

    pub(super) fn pick<'a>(&mut self, among: &[&'a str]) -> &'a str {
        among[self.0.usize(..among.len())]
    }

    pub(super) fn one_in(&mut self, count: usize) -> bool {
        self.0.usize(..count) == 0
    }

    pub(super) fn coin(&mut self) -> bool {
        self.0.bool()
    }

    pub(super) fn vector(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| self.between(-size..size))
    }
}

/// To five digits: a case is read by people, and its last digits would differ among systems.
fn rounded(number: f64) -> f64 {
    format!("{number:.4e}").parse().unwrap_or(number)
}
