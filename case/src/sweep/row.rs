//! A row of a sweep: what one run gave.

use crate::run::quantity::Collected;

/// How a run of a sweep ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It reached its end.
    Finished,
    /// The integration failed.
    Failed,
    /// Whoever watched it stopped it: no such row is kept.
    Stopped,
    /// It took more steps than the limit.
    GivenUp,
    /// The case of these inputs cannot be run.
    Rejected,
}

const STATUSES: [(Status, &str); 5] = [
    (Status::Finished, "finished"),
    (Status::Failed, "failed"),
    (Status::Stopped, "stopped"),
    (Status::GivenUp, "given-up"),
    (Status::Rejected, "rejected"),
];

impl Status {
    /// Its word in files.
    pub fn word(self) -> &'static str {
        STATUSES.iter().find(|(status, _)| *status == self).map_or("", |(_, word)| *word)
    }

    /// The status of a word.
    pub(super) fn of(word: &str) -> Option<Status> {
        STATUSES.iter().find(|(_, other)| *other == word).map(|(status, _)| *status)
    }
}

/// A value of an input.
#[derive(Clone, Debug, PartialEq)]
pub enum Point {
    /// A number in SI.
    Number(f64),
    /// A text.
    Text(String),
}

/// What one run gave. Everything but the wall time depends on the inputs alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Its number, from 0.
    pub number: usize,
    /// The values of the inputs.
    pub inputs: Vec<Point>,
    /// How the run ended.
    pub status: Status,
    /// Why it did not finish.
    pub reason: Option<String>,
    /// A value for each quantity; `None` where the run did not finish.
    pub quantities: Vec<Option<Collected>>,
    /// Time until which the run is trusted \[s\]; `None` where that is not estimated.
    pub trusted_until: Option<f64>,
    /// Number of warnings.
    pub warnings: usize,
    /// Accepted steps.
    pub steps: u64,
    /// Time that it took, reading and the estimate of errors included \[s\].
    pub wall_time: f64,
}

impl Row {
    /// Whether it counts as a failure.
    pub fn has_failed(&self) -> bool {
        self.status != Status::Finished
    }

    /// The same but for the wall time, to the bit.
    pub fn is_same(&self, other: &Row) -> bool {
        let bits = |x: Option<f64>| x.map(f64::to_bits);
        let of = |row: &Row| {
            let quantities = row.quantities.iter().map(|of| {
                of.map(|Collected { value, time, error, trusted, .. }| {
                    (value.to_bits(), time.to_bits(), bits(error), trusted)
                })
            });
            (quantities.collect::<Vec<_>>(), bits(row.trusted_until))
        };
        let plain = |row: &Row| (row.number, row.status, row.warnings, row.steps);
        let inputs = self.inputs.len() == other.inputs.len()
            && self.inputs.iter().zip(&other.inputs).all(|pair| match pair {
                (Point::Number(a), Point::Number(b)) => a.to_bits() == b.to_bits(),
                (a, b) => a == b,
            });
        inputs && plain(self) == plain(other) && self.reason == other.reason && of(self) == of(other)
    }
}
