//! Sweeps: one case with many values of some of its keys, one row a run.
//!
//! [`Sweep::new`] reads the inputs and refuses what is wrong before anything runs. [`Sweep::run`] computes a [`Chunk`] of rows and keeps
//! nothing: this is what a cluster calls. [`Sweep::run_all`] computes all rows, or those of a [`Shard`], on several threads, and keeps them as
//! parts in a folder, from which it goes on after it was ended.
//!
//! A row depends on its inputs alone: it has the same bits on any thread, in any order, and beside any other row. Its wall time is the one
//! value that differs.
//!
//! ```
//! use flexion_case::sweep::{Chunk, Inputs, Options, Sweep};
//! use std::ops::ControlFlow;
//!
//! # let text = include_str!("../../../verification/p1_spin_up_4/case.toml").to_owned();
//! let case = flexion_case::parse(text, "case.toml".as_ref(), &["run.duration=1 s".to_owned()])?;
//! let inputs = Inputs { vary: vec!["section.modulus=60 GPa:80 GPa:3".to_owned()], ..Inputs::default() };
//! let sweep = Sweep::new(case, inputs, &["tip.deflection.min".to_owned()], Options::default())?;
//! let rows = sweep.run(Chunk { first: 0, count: sweep.rows() }, &mut || ControlFlow::Continue(()));
//! let deflection = |i: usize| rows[i].quantities[0].map(|of| of.value);
//! // A stiffer beam bends less.
//! assert!(deflection(0) < deflection(2));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod csv_file;
mod distribution;
mod folder;
mod identity;
mod inputs;
mod keeping;
mod parquet_file;
mod part;
mod points;
mod random;
mod read;
mod row;
mod spread;
mod table;
mod written;

pub use crate::run::quantity::{Collected, Quantity, Value};
pub use distribution::Distribution;
pub use folder::{How, Outcome, Progress, Shard, Stop};
pub use inputs::{Cell, Inputs, Method, Sample, Table};
pub use keeping::Totals;
pub use read::Input;
pub use row::{Point, Row, Status};
pub use table::{Data, Named};

use crate::change::{Change, Setting};
use crate::problem::Problems;
use crate::reading::{Laid, Reading};
use crate::run::clock::Clock;
use flexion::analysis::error::Effort;
use flexion_results::ResultsError;
use points::Column;
use read::Takes;
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Steps of a run after which it is given up, if no other limit is asked for and its own steps are not as many.
pub const LIMIT: u64 = 10_000_000;
/// How many times the steps of its limit the estimate of the errors of a row may take.
const COMPANIONS: u64 = 20;
/// Rows of which errors are estimated, of a sample.
const SAMPLED: usize = 20;
/// Parts of a sweep, about.
const PARTS: usize = 200;

/// Of which rows errors are estimated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Errors {
    /// Of every row.
    Each,
    /// Of 20 rows that lie far apart among the inputs, or of all if there are no more.
    #[default]
    Sample,
    /// Of none.
    None,
}

impl Errors {
    /// Its name, as it is written.
    pub fn name(self) -> &'static str {
        match self {
            Errors::Each => "each",
            Errors::Sample => "sample",
            Errors::None => "none",
        }
    }
}

/// How the rows of a sweep are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Of which rows errors are estimated.
    pub errors: Errors,
    /// Accepted steps after which a run is given up, and points of the path on which its equilibrium is looked for; `None` is [`LIMIT`], or
    /// twice the steps of a case with fixed ones.
    pub limit: Option<u64>,
    /// Rows of a part; `None` makes about 200 parts.
    pub part: Option<usize>,
}

/// Rows that follow one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chunk {
    /// Number of the first, from 0.
    pub first: usize,
    /// How many.
    pub count: usize,
}

/// Why there is no sweep.
#[derive(Debug, thiserror::Error)]
pub enum SweepError {
    /// The case or the inputs are to blame.
    #[error(transparent)]
    Case(#[from] Problems),
    /// There is no such column.
    #[error(transparent)]
    Column(#[from] ResultsError),
    /// What is asked for cannot be done.
    #[error("{0}")]
    Asked(String),
    /// The folder holds something else.
    #[error("{} {what}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What is wrong with it.
        what: String,
    },
    /// The system refuses.
    #[error("cannot {what} {}: {source}", path.display())]
    Io {
        /// What was tried.
        what: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The reason.
        source: std::io::Error,
    },
}

/// A case and the values of its inputs, read and checked.
#[derive(Clone, Debug)]
pub struct Sweep {
    reading: Reading,
    given: Inputs,
    inputs: Vec<Input>,
    /// The order in which inputs are laid over the case.
    order: Vec<usize>,
    columns: Vec<Column>,
    rows: usize,
    quantities: Vec<Quantity>,
    options: Options,
    /// Of which rows errors are estimated.
    estimated: Vec<bool>,
}

impl Sweep {
    /// The sweep of a case over inputs, of which the values of `quantities` are collected: `tip.deflection.min`, `.max` or `.final`; a
    /// column alone stands for all three.
    ///
    /// # Errors
    /// Everything that is wrong with the inputs, as of `--set`; a column that is not there; more rows than can be.
    pub fn new(
        reading: Reading,
        given: Inputs,
        quantities: &[String],
        options: Options,
    ) -> Result<Sweep, SweepError> {
        if reading.case.accuracy.is_some() {
            let message = "a sweep does not refine mesh and steps: leave the tolerance out, and choose them for all rows";
            return Err(SweepError::Case(reading.problem("run.tolerance", message)));
        }
        let (inputs, levels): (Vec<Input>, Vec<_>) = read::read(&reading, &given)?.into_iter().unzip();
        let levels: Vec<_> = inputs.iter().map(|input| input.key.clone()).zip(levels).collect();
        let rows = points::count(&given, &levels).map_err(SweepError::Asked)?;
        if options.part == Some(0) || options.limit == Some(0) {
            return Err(SweepError::Asked(
                "a part has at least one row, and a run at least one step".to_owned(),
            ));
        }
        let columns = points::columns(&given, &levels, rows);
        let estimated = match options.errors {
            Errors::Each => vec![true; rows],
            Errors::None => vec![false; rows],
            Errors::Sample => spread::spread(&columns, rows, SAMPLED),
        };
        let order = read::order(inputs.iter().map(|input| input.key.as_str()));
        let quantities_asked = quantities;
        let mut sweep = Sweep {
            reading,
            given,
            inputs,
            order,
            columns,
            rows,
            quantities: Vec::new(),
            options,
            estimated,
        };
        sweep.quantities = sweep.known(quantities_asked)?;
        Ok(sweep)
    }

    /// The quantities of these names among the columns of a row that can be prepared.
    fn known(&self, quantities: &[String]) -> Result<Vec<Quantity>, SweepError> {
        if quantities.is_empty() {
            let message = "no quantity is collected: name one, e.g. `tip.deflection.min`";
            return Err(SweepError::Asked(message.to_owned()));
        }
        let mut refused = None;
        for row in [0, self.rows / 2, self.rows.saturating_sub(1)] {
            match self.case(row).and_then(|reading| reading.prepare()) {
                Ok(mut prepared) => return Ok(prepared.quantities(quantities)?),
                Err(problems) => refused = refused.or(Some(problems)),
            }
        }
        Err(refused.map_or_else(|| SweepError::Asked("the sweep has no rows".to_owned()), SweepError::Case))
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The inputs.
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    /// The quantities.
    pub fn quantities(&self) -> &[Quantity] {
        &self.quantities
    }

    /// Number of parts in which all rows are kept: as a [`Shard`] of so many, each is one part, for whoever hands them out one by one.
    pub fn parts(&self) -> usize {
        self.rows.div_ceil(self.part())
    }

    /// The seed of the sample, where there is one.
    pub fn seed(&self) -> Option<u64> {
        self.given.sample.map(|sample| sample.seed)
    }

    /// Number of rows of which errors are estimated.
    pub fn estimated(&self) -> usize {
        self.estimated.iter().filter(|of| **of).count()
    }

    /// The values of the inputs of a row below [`Sweep::rows`].
    pub fn point(&self, row: usize) -> Vec<Point> {
        let value = |column: &Column| match column {
            Column::Numbers(of) => Point::Number(of[row]),
            Column::Texts(texts, of) => Point::Text(written::bare(&texts[of[row] as usize])),
        };
        self.columns.iter().map(value).collect()
    }

    /// The case of a row below [`Sweep::rows`].
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn case(&self, row: usize) -> Result<Reading, Problems> {
        let value = |number: &usize| {
            let Input { key, takes, .. } = &self.inputs[*number];
            match &self.columns[*number] {
                Column::Texts(texts, of) => Laid::Text(format!("{key}={}", texts[of[row] as usize])),
                Column::Numbers(of) if *takes == Takes::Integer => {
                    Laid::Typed(Change { path: key.clone(), to: Setting::Integer(of[row] as i64) })
                }
                Column::Numbers(of) => {
                    Laid::Typed(Change { path: key.clone(), to: Setting::Number(of[row]) })
                }
            }
        };
        self.reading.laid(&self.order.iter().map(value).collect::<Vec<_>>())
    }

    /// Runs the rows of a chunk, as far as there are so many, one after another. `watch` is called after every step and ends the chunk by
    /// `Break`: the row that it ends is the last, with the status [`Status::Stopped`].
    pub fn run(&self, chunk: Chunk, watch: &mut dyn FnMut() -> ControlFlow<()>) -> Vec<Row> {
        let mut out = Vec::with_capacity(chunk.count.min(self.rows));
        let end = chunk.first.saturating_add(chunk.count).min(self.rows);
        for number in chunk.first..end {
            let row = self.row(number, watch);
            let stopped = row.status == Status::Stopped;
            out.push(row);
            if stopped {
                break;
            }
        }
        out
    }

    /// Runs a row.
    fn row(&self, number: usize, watch: &mut dyn FnMut() -> ControlFlow<()>) -> Row {
        let clock = Clock::start();
        let mut row = Row {
            number,
            inputs: self.point(number),
            status: Status::Rejected,
            reason: None,
            quantities: vec![None; self.quantities.len()],
            trusted_until: None,
            warnings: 0,
            steps: 0,
            wall_time: 0.0,
        };
        match self.case(number) {
            Ok(reading) => self.fill(&mut row, &reading, watch),
            Err(problems) => row.reason = Some(first(&problems)),
        }
        row.wall_time = clock.elapsed().0;
        row
    }

    /// What the run of a case gives.
    fn fill(&self, row: &mut Row, reading: &Reading, watch: &mut dyn FnMut() -> ControlFlow<()>) {
        let limit = self.limit(reading);
        let mut count = Count { limit, taken: 0, ended: None };
        let prepared = match reading.prepare_watched(&mut |_| count.go_on(watch)) {
            Ok(prepared) => prepared,
            Err(problems) => {
                row.reason = Some(first(&problems));
                row.status = count.ended.unwrap_or(Status::Rejected);
                return;
            }
        };
        count = Count { limit, taken: 0, ended: None };
        let mut run = prepared.without_pictures().run(&mut |_| count.go_on(watch));
        row.steps = run.counters.steps;
        row.warnings = run.all_warnings().count();
        if run.status != flexion_results::Status::Finished {
            row.status = count.ended.unwrap_or(Status::Failed);
            row.reason = match row.status {
                Status::GivenUp => {
                    Some(format!("given up: more than {limit} steps at t = {:.6} s", run.state.t))
                }
                _ => run.message.clone(),
            };
            return;
        }
        if self.estimated[row.number] {
            let mut count = Count { limit: limit.saturating_mul(COMPANIONS), taken: 0, ended: None };
            run.errors = Some(reading.estimate_errors(&run, Effort::Full, &mut |_| count.go_on(watch)));
            if count.ended == Some(Status::Stopped) {
                row.status = Status::Stopped;
                return;
            }
            row.warnings = run.all_warnings().count();
        }
        let collected: Result<Vec<_>, String> = self.quantities.iter().map(|of| of.collect(&run)).collect();
        match collected {
            Ok(collected) => {
                row.status = Status::Finished;
                row.quantities = collected.into_iter().map(Some).collect();
                let known = run.errors.as_ref().filter(|errors| errors.unknown.is_none());
                row.trusted_until = known.map(|errors| errors.trusted);
            }
            Err(reason) => (row.status, row.reason) = (Status::Failed, Some(reason)),
        }
    }

    /// Steps after which a run is given up.
    fn limit(&self, reading: &Reading) -> u64 {
        self.options.limit.unwrap_or_else(|| {
            let steps = reading.case.steps.step().map_or(0.0, |step| reading.case.duration / step);
            LIMIT.max((2.0 * steps) as u64)
        })
    }

    /// Rows of a part.
    fn part(&self) -> usize {
        self.options.part.unwrap_or_else(|| self.rows.div_ceil(PARTS)).max(1)
    }
}

/// Counts steps, and says which limit was met.
struct Count {
    limit: u64,
    taken: u64,
    ended: Option<Status>,
}

impl Count {
    fn go_on(&mut self, watch: &mut dyn FnMut() -> ControlFlow<()>) -> ControlFlow<()> {
        self.taken += 1;
        if self.taken > self.limit {
            self.ended = Some(Status::GivenUp);
        } else if watch().is_break() {
            self.ended = Some(Status::Stopped);
        } else {
            return ControlFlow::Continue(());
        }
        ControlFlow::Break(())
    }
}

/// The first problem of a case, at its key.
fn first(problems: &Problems) -> String {
    problems.list.first().map_or_else(String::new, |problem| {
        if problem.key.is_empty() {
            problem.message.clone()
        } else {
            format!("{}: {}", problem.key, problem.message)
        }
    })
}
