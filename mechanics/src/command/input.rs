//! A law with what it reads, when it is asked, and the signal that it gives.

use super::signal::Signal;
use std::sync::Arc;

/// Most samples of a law in a run.
const MOST: f64 = 1e7;

/// A law: a number that follows from time and motion.
pub trait Command: Send {
    /// u(t, y, x), with y the values of the quantities that it reads, in their order, and behind them in the same slice its states x. Writes
    /// the rates ẋ(t, y, x) into `rates`.
    ///
    /// # Errors
    /// Why there is none, behind the words "the law `name`": the run ends there.
    fn value(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<f64, String>;
}

/// A state of a law, which the method of integration integrates with the motion.
#[derive(Clone, Debug, PartialEq)]
pub struct LawState {
    /// Its name.
    pub name: String,
    /// Its value at t = 0.
    pub start: f64,
    /// The size (> 0) by which its errors are measured.
    pub size: f64,
}

/// When a law is asked.
#[derive(Clone, Debug, PartialEq)]
pub enum Timing {
    /// At any time and in any order.
    Continuous {
        /// Times at which it jumps or kinks \[s\].
        breaks: Vec<f64>,
    },
    /// At 0, T, 2 T and so on, once each.
    Sampled {
        /// Period T \[s\].
        period: f64,
    },
}

/// A law of a model.
pub struct Input {
    /// Its name.
    pub name: String,
    /// Unit of what it gives.
    pub unit: &'static str,
    /// Columns that it reads.
    pub reads: Vec<String>,
    /// Its states.
    pub states: Vec<LawState>,
    /// When it is asked.
    pub timing: Timing,
    /// The law.
    pub command: Box<dyn Command>,
    /// What the model applies.
    pub signal: Arc<Signal>,
}

impl Input {
    /// Whether its states can be integrated.
    pub(super) fn check_states(&self) -> Result<(), CommandFault> {
        for (i, state) in self.states.iter().enumerate() {
            let LawState { name, start, size } = state;
            let other = self.reads.iter().chain(self.states[..i].iter().map(|state| &state.name));
            let why = if matches!(self.timing, Timing::Sampled { .. }) {
                "is integrated, and a sampled law has a memory of its own".to_owned()
            } else if !start.is_finite() {
                format!("begins with {start}, which must be finite")
            } else if !(size.is_finite() && *size > 0.0) {
                format!("has the size {size}, which must be positive and finite")
            } else if name.is_empty() || other.into_iter().any(|other| other == name) {
                "must have a name of its own".to_owned()
            } else {
                continue;
            };
            return Err(CommandFault::State { input: self.name.clone(), state: name.clone(), why });
        }
        Ok(())
    }

    /// The times at which a law jumps, between the start of a run and its end.
    pub(super) fn times(&self, end: f64) -> Result<Vec<f64>, CommandFault> {
        let Input { name, timing, .. } = self;
        let fault = |what, value, needed| CommandFault::Time { input: name.clone(), what, value, needed };
        match timing {
            Timing::Continuous { breaks } => match breaks.iter().find(|time| !time.is_finite()) {
                Some(time) => Err(fault("break", *time, "finite")),
                None => Ok(breaks.iter().copied().filter(|time| *time > 0.0 && *time < end).collect()),
            },
            &Timing::Sampled { period } if !(period.is_finite() && period > 0.0) => {
                Err(fault("period", period, "positive and finite"))
            }
            &Timing::Sampled { period } if end / period > MOST => {
                Err(CommandFault::Samples { input: name.clone(), period, samples: end / period, most: MOST })
            }
            &Timing::Sampled { period } => {
                let all = (1..).map(|k: u64| k as f64 * period);
                Ok(all.take_while(|time| *time < end).collect())
            }
        }
    }
}

/// Why a model takes no law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CommandFault {
    /// A quantity is not there.
    #[error(
        "the law `{input}` reads `{column}`, and there is no such column (those of a run alone, as `energy.total` and `step.size`, no law reads)"
    )]
    NoColumn {
        /// Name of the law.
        input: String,
        /// What it reads.
        column: String,
        /// All columns.
        columns: Vec<String>,
    },
    /// A quantity follows from what the law gives.
    #[error(
        "the law `{input}` reads `{column}`, which is a reaction or an acceleration: a law follows from time, positions and velocities"
    )]
    Reaction {
        /// Name of the law.
        input: String,
        /// What it reads.
        column: String,
    },
    /// A period or a time is none.
    #[error("the law `{input}` has the {what} {value} s, which must be {needed}")]
    Time {
        /// Name of the law.
        input: String,
        /// What it is.
        what: &'static str,
        /// Its value \[s\].
        value: f64,
        /// What it must be.
        needed: &'static str,
    },
    /// A state cannot be integrated.
    #[error("the state `{state}` of the law `{input}` {why}")]
    State {
        /// Name of the law.
        input: String,
        /// Name of the state.
        state: String,
        /// What is wrong.
        why: String,
    },
    /// A column of the law has the name of another.
    #[error(
        "the law `{input}` is recorded as `{column}`, and so is something else: give it, or its state, another name"
    )]
    Twice {
        /// Name of the law.
        input: String,
        /// The column.
        column: String,
    },
    /// There are too many samples.
    #[error(
        "the law `{input}` with the period {period} s has {samples:.1e} samples in the run, and at most {most:.0e} are taken"
    )]
    Samples {
        /// Name of the law.
        input: String,
        /// Its period \[s\].
        period: f64,
        /// Number of samples.
        samples: f64,
        /// How many are taken.
        most: f64,
    },
}
