//! A panel in its place, whose curves are followed in mapped numbers.

use super::axis::Resolved;
use super::{Panel, Series};

/// A panel with its axes decided.
pub(super) struct Placed<'a> {
    pub(super) panel: &'a Panel,
    pub(super) x: Resolved,
    pub(super) y: Resolved,
    /// Whether numbers and label stand below it.
    pub(super) x_labelled: bool,
}

impl Placed<'_> {
    /// The unbroken pieces of a curve, in mapped numbers.
    pub(super) fn pieces(&self, series: &Series) -> Vec<Vec<(f64, f64)>> {
        let mapped: Vec<Option<(f64, f64)>> =
            series.points.iter().map(|&(x, y)| self.x.map(x).zip(self.y.map(y))).collect();
        mapped
            .split(Option::is_none)
            .filter(|piece| !piece.is_empty())
            .map(|piece| piece.iter().flatten().copied().collect())
            .collect()
    }
}
