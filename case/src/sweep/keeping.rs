//! What the rows of a sweep say together, and whether it goes on.

use super::row::{Row, Status};
use crate::run::quantity::Collected;
use std::collections::BTreeMap;

/// Part of the rows that may fail.
const MOST_FAILURES: f64 = 0.1;
/// Rows from which on that is judged; of fewer, all.
const ENOUGH: usize = 20;

/// What the rows of a sweep say together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Totals {
    /// Number of rows.
    pub rows: usize,
    /// Number of rows that ended so.
    pub failed: usize,
    /// The same.
    pub given_up: usize,
    /// The same.
    pub rejected: usize,
    /// Number of rows with estimated errors, of which one quantity at least has one.
    pub estimated: usize,
    /// Number of rows with a value beyond the time in which its run is trusted.
    pub distrusted: usize,
    /// For each quantity what its rows say.
    pub quantities: Vec<OfQuantity>,
    /// The first row that did not finish, and why.
    pub first_failure: Option<(usize, String)>,
    /// Sum of the wall times of the rows \[s\].
    pub wall_time: f64,
}

/// What the rows say of a quantity, in its unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfQuantity {
    /// Smallest value.
    pub min: f64,
    /// Largest value.
    pub max: f64,
    /// Largest estimated error.
    pub error: Option<f64>,
    /// Largest ratio of an estimated error to the value of its row.
    pub relative: Option<f64>,
}

impl Default for OfQuantity {
    fn default() -> OfQuantity {
        OfQuantity { min: f64::INFINITY, max: f64::NEG_INFINITY, error: None, relative: None }
    }
}

impl Totals {
    /// Number of rows that did not finish.
    pub fn failures(&self) -> usize {
        self.failed + self.given_up + self.rejected
    }

    /// The largest ratio of an estimated error to its value, over all quantities.
    pub fn worst(&self) -> Option<f64> {
        self.quantities.iter().filter_map(|of| of.relative).reduce(f64::max)
    }

    fn add(&mut self, row: &Row) {
        self.rows += 1;
        self.wall_time += row.wall_time;
        match row.status {
            Status::Finished => {}
            Status::Failed | Status::Stopped => self.failed += 1,
            Status::GivenUp => self.given_up += 1,
            Status::Rejected => self.rejected += 1,
        }
        if row.has_failed() && self.first_failure.as_ref().is_none_or(|(first, _)| row.number < *first) {
            self.first_failure = Some((row.number, row.reason.clone().unwrap_or_default()));
        }
        self.quantities.resize(row.quantities.len(), OfQuantity::default());
        for (of, collected) in self.quantities.iter_mut().zip(&row.quantities) {
            let Some(Collected { value, error, .. }) = collected else { continue };
            (of.min, of.max) = (of.min.min(*value), of.max.max(*value));
            let largest = |of: Option<f64>, x: f64| Some(of.map_or(x, |of| of.max(x)));
            if let Some(error) = error {
                of.error = largest(of.error, *error);
                if *value != 0.0 {
                    of.relative = largest(of.relative, error / value.abs());
                }
            }
        }
        let has = |test: fn(&Collected) -> bool| row.quantities.iter().flatten().any(test);
        self.estimated += usize::from(has(|of| of.error.is_some()));
        self.distrusted += usize::from(has(|of| of.trusted == Some(false)));
    }
}

/// Judges the failures of a sweep in the order of its rows, whatever the order in which they are computed.
#[derive(Default)]
pub(super) struct Keeping {
    pub(super) totals: Totals,
    /// Whether each row of the parts that cannot be judged yet has failed.
    waiting: BTreeMap<usize, Vec<bool>>,
    /// Number of the next part to be judged, rows judged, and failures among them.
    next: usize,
    judged: usize,
    failures: usize,
    /// Failures and rows at which there were too many.
    too_many: Option<(usize, usize)>,
}

impl Keeping {
    /// Takes the rows of a part, by its number among those of the shard, which has `all` rows. Returns the failures and the rows among which they
    /// are, where these are too many.
    pub(super) fn add(&mut self, number: usize, rows: &[Row], all: usize) -> Option<(usize, usize)> {
        rows.iter().for_each(|row| self.totals.add(row));
        self.waiting.insert(number, rows.iter().map(Row::has_failed).collect());
        while let Some(rows) = self.waiting.remove(&self.next) {
            self.next += 1;
            for failed in rows {
                self.judged += 1;
                self.failures += usize::from(failed);
                let enough = self.judged >= ENOUGH.min(all);
                if enough && self.failures as f64 > MOST_FAILURES * self.judged as f64 {
                    self.too_many = self.too_many.or(Some((self.failures, self.judged)));
                }
            }
        }
        self.too_many
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(failed: &[bool]) -> Vec<Row> {
        let status = |failed: &bool| if *failed { Status::Failed } else { Status::Finished };
        let row = |(number, failed): (usize, &bool)| Row {
            number,
            inputs: Vec::new(),
            status: status(failed),
            reason: None,
            quantities: Vec::new(),
            trusted_until: None,
            warnings: 0,
            steps: 1,
            wall_time: 0.0,
        };
        failed.iter().enumerate().map(row).collect()
    }

    #[test]
    fn failures_are_judged_in_the_order_of_rows_from_the_twentieth_on() {
        let bad = [true, true, true, false, false, false, false, false, false, false];
        let good = [false; 10];
        // 3 of 20 are more than a tenth, whichever part is computed first.
        for order in [[0, 1, 2], [2, 1, 0], [1, 2, 0]] {
            let mut keeping = Keeping::default();
            let parts = [rows(&bad), rows(&good), rows(&bad)];
            let found: Vec<_> = order.iter().map(|i| keeping.add(*i, &parts[*i], 30)).collect();
            assert_eq!(found[2], Some((3, 20)));
        }
        // 3 of 30 are not, where they come last.
        let late: Vec<bool> = bad.into_iter().rev().collect();
        let mut keeping = Keeping::default();
        assert_eq!(keeping.add(0, &rows(&good), 30), None);
        assert_eq!(keeping.add(1, &rows(&good), 30), None);
        assert_eq!(keeping.add(2, &rows(&late), 30), None);
        // Of few rows all are waited for.
        let mut few = Keeping::default();
        assert_eq!(few.add(0, &rows(&[true]), 5), None);
        assert_eq!(few.add(1, &rows(&[false; 4]), 5), Some((1, 5)));
    }
}
