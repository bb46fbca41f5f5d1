//! Refinement of a case until what is asked of it is accurate enough.
//!
//! Run k has twice the elements (functions) of run k − 1, and a tenth of its tolerance or half its step. Its error is
//! [estimated](Reading::estimate_errors) from a finer companion. The order p of a sequence is that of its errors against the
//! elements, log₂(e_{k−1}/e_k): mesh and steps together, as they are refined.

use super::Run;
use super::difference::{Pair, vanishes};
use super::error::{Effort, FINER, TIGHTEST};
use crate::kinds::integrator::Steps;
use crate::problem::Problems;
use crate::reading::Reading;
use crate::units;
use flexion::system::Role;
use flexion_results::{Errors, ResultsError, Rung, Status, Trajectory, Watch, nearest};

/// Largest number of refinements.
const MOST: usize = 8;
/// Steps times unknowns of a run that is no longer refined: about ten minutes of computing.
const COSTLIEST: f64 = 2e9;
/// Quotient of two successive errors above which they do not fall.
const FALLING: f64 = 0.7;

/// A value of a column, or all of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Min,
    Max,
    Final,
    History,
}

/// What is to be how accurate.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    tolerance: String,
    quantity: Option<String>,
    /// Factor on the tolerance.
    factor: f64,
}

/// A column to be refined: its bound in its unit.
pub(super) struct Goal {
    pub(super) index: usize,
    pub(super) name: String,
    part: Part,
    pub(super) bound: f64,
}

/// A refined case and its run.
pub struct Refinement {
    /// The case that was refined.
    pub reading: Reading,
    /// Its run, with its errors and their sequence.
    pub run: Run,
    /// Why what was asked is not reached; `None` where it is.
    pub refused: Option<String>,
}

/// Why nothing was refined.
#[derive(Debug, thiserror::Error)]
pub enum RefineError {
    /// The case is to blame.
    #[error(transparent)]
    Case(#[from] Problems),
    /// There is no such column.
    #[error(transparent)]
    Column(#[from] ResultsError),
    /// The tolerance is to blame.
    #[error("the tolerance `{text}` {reason}")]
    Tolerance {
        /// What was written.
        text: String,
        /// What is wrong with it.
        reason: String,
    },
}

impl Target {
    /// A tolerance of the largest value of each quantity, `1e-4`, or with a unit, `0.1 mm`; and a quantity, `tip.deflection`,
    /// `tip.deflection.min`, `.max` or `.final`. Without one all principal columns are meant.
    pub fn new(tolerance: String, quantity: Option<String>) -> Target {
        Target { tolerance, quantity, factor: 1.0 }
    }

    /// The same with a factor on the tolerance.
    pub(super) fn times(&self, factor: f64) -> Target {
        Target { factor: factor * self.factor, ..self.clone() }
    }

    /// The columns with their bounds. Of all principal ones those that vanish have none; `size` \[m\] is that of the model.
    pub(super) fn goals(&self, run: &Run, size: f64) -> Result<Vec<Goal>, RefineError> {
        let trajectory = &run.trajectory;
        let mut goals = Vec::new();
        match &self.quantity {
            Some(quantity) => {
                let (column, part) = split(quantity);
                let index = trajectory.index(column).ok_or_else(|| unknown(column, trajectory))?;
                goals.push((index, part));
            }
            None => {
                let principal = trajectory.channels().iter().enumerate();
                let principal = principal.filter(|(index, channel)| {
                    channel.role == Role::Primary && !vanishes(trajectory, *index, size)
                });
                goals.extend(principal.map(|(index, _)| (index, Part::History)));
            }
        }
        goals.into_iter().map(|(index, part)| self.goal(trajectory, index, part)).collect()
    }

    fn goal(&self, trajectory: &Trajectory, index: usize, part: Part) -> Result<Goal, RefineError> {
        let channel = &trajectory.channels()[index];
        let fault = |reason: String| RefineError::Tolerance { text: self.tolerance.clone(), reason };
        let bound = match self.tolerance.trim().parse::<f64>() {
            Ok(relative) => relative * trajectory.extremes(index).largest(),
            Err(_) => units::parse_in(&self.tolerance, channel.unit).map_err(|error| {
                let all = if self.quantity.is_none() {
                    "; a tolerance with a unit bounds one quantity, which `--quantity` names, e.g. `--quantity tip.deflection`"
                } else {
                    ""
                };
                fault(format!("of `{}` is no number: {}{all}", channel.name, error.message))
            })?,
        };
        if bound.is_nan() || bound < 0.0 || self.tolerance.trim().starts_with(['-', '0']) && bound == 0.0 {
            return Err(fault(
                "must be a number > 0, or one with a unit of the quantity, e.g. `0.1 mm`".to_owned(),
            ));
        }
        let rounding = f64::EPSILON * trajectory.extremes(index).largest();
        if bound < rounding {
            return Err(fault(format!(
                "is below {rounding:.1e}, the last digit of the largest `{}`",
                channel.name
            )));
        }
        Ok(Goal { index, name: channel.name.clone(), part, bound: self.factor * bound })
    }
}

/// The column and the part of it that `tip.deflection.min` names.
fn split(quantity: &str) -> (&str, Part) {
    let parts = [(".min", Part::Min), (".max", Part::Max), (".final", Part::Final)];
    let found = parts.into_iter().find_map(|(end, part)| Some((quantity.strip_suffix(end)?, part)));
    found.unwrap_or((quantity, Part::History))
}

fn unknown(column: &str, trajectory: &Trajectory) -> ResultsError {
    let names: Vec<&str> = trajectory.channels().iter().map(|channel| channel.name.as_str()).collect();
    ResultsError::NoColumn {
        pattern: column.to_owned(),
        of: "this run".to_owned(),
        nearest: nearest(column, names.iter().copied()).map(str::to_owned),
        there: names.join(", "),
    }
}

impl Goal {
    /// The value, where it is one, and its error.
    pub(super) fn reached(&self, run: &Run, errors: &Errors) -> Option<(Option<f64>, f64)> {
        let error = errors.columns.iter().find(|error| error.column == self.name)?;
        let e = run.trajectory.extremes(self.index);
        Some(match self.part {
            Part::Min => (Some(e.min), error.min),
            Part::Max => (Some(e.max), error.max),
            Part::Final => (Some(e.last), error.last),
            Part::History => (None, error.discretization),
        })
    }

    /// The difference of the value in two runs.
    pub(super) fn off(&self, pair: &Pair<'_>) -> f64 {
        let [min, max, last] = pair.of_values();
        match self.part {
            Part::Min => min,
            Part::Max => max,
            Part::Final => last,
            Part::History => pair.largest(),
        }
    }

    /// Its name, `tip.deflection.min`.
    pub(super) fn quantity(&self) -> String {
        let end = match self.part {
            Part::Min => ".min",
            Part::Max => ".max",
            Part::Final => ".final",
            Part::History => "",
        };
        format!("{}{end}", self.name)
    }
}

impl Reading {
    /// Refines the case until the estimated errors of what is asked are below their tolerance, or cannot be brought there.
    ///
    /// # Errors
    /// [`RefineError`]: a case that cannot be refined, a column that is not there, a tolerance that is none.
    pub fn refine(&self, target: &Target, watch: &mut Watch<'_>) -> Result<Refinement, RefineError> {
        let (mut reading, mut rungs) = (self.clone(), Vec::<Rung>::new());
        loop {
            let mut run = reading.prepare()?.run(watch);
            let goals = target.goals(&run, self.case.size())?;
            if run.status != Status::Finished {
                return Ok(Refinement { reading, run, refused: None });
            }
            let mut errors = reading.estimate_errors(&run, Effort::Full, watch)?;
            let reached = goals.iter().filter_map(|goal| Some((goal, goal.reached(&run, &errors)?)));
            // The goal that is farthest from its bound.
            let farthest = reached.max_by(|(a, (_, x)), (b, (_, y))| (x / a.bound).total_cmp(&(y / b.bound)));
            let (mut refused, mut done) = (None, true);
            if let Some((goal, (value, error))) = farthest {
                let order = rungs
                    .last()
                    .filter(|rung| rung.quantity == goal.quantity())
                    .map(|rung| (rung.error / error).log2());
                rungs.push(Rung {
                    changes: reading.mesh_and_steps(),
                    quantity: goal.quantity(),
                    value,
                    error,
                    order,
                });
                done = error <= goal.bound;
                if !done {
                    refused = reading.give_up(&run, &rungs, goal.bound);
                }
            }
            let next = if done || refused.is_some() { None } else { Some(reading.next()) };
            match next {
                Some(Ok(next)) => reading = next,
                stopped => {
                    if let Some(Err(problems)) = stopped {
                        let why =
                            problems.list.first().map_or(String::new(), |problem| problem.message.clone());
                        refused = Some(format!("the case cannot be refined further: {why}"));
                    }
                    errors.sequence = rungs;
                    run.errors = Some(errors);
                    return Ok(Refinement { reading, run, refused });
                }
            }
        }
    }

    /// Why the sequence ends before its goal, if it does.
    fn give_up(&self, run: &Run, rungs: &[Rung], bound: f64) -> Option<String> {
        let last = rungs.last()?;
        let found = format!("the error of {} is {:.1e} and not below {bound:.1e}", last.quantity, last.error);
        let slow = |pair: &[Rung]| !(pair[1].error <= FALLING * pair[0].error);
        if rungs.len() > 2 && rungs[rungs.len() - 3..].windows(2).all(slow) {
            return Some(format!(
                "{found}, and errors do not fall: the motion may be chaotic or unstable, or a load may have no derivative; \
                 ask for a shorter time, or for less"
            ));
        }
        if rungs.len() > MOST {
            return Some(format!(
                "{found} after {MOST} refinements: ask for less, or begin with a finer mesh"
            ));
        }
        let work = run.counters.steps as f64 * run.size.unknowns as f64;
        (work > COSTLIEST).then(|| {
            format!("{found}, and the last run took {work:.1e} steps times unknowns: ask for less, or begin with a finer mesh")
        })
    }

    /// The case with twice the functions, and a tenth of the tolerance or half the step.
    fn next(&self) -> Result<Reading, Problems> {
        let mut changes = self.case.finer();
        match self.case.steps {
            Steps::Fixed { step, .. } => changes.push(format!("integrator.step={:e}", 0.5 * step)),
            Steps::Controlled { .. } => changes.extend(self.tolerances(FINER, TIGHTEST, f64::INFINITY)),
        }
        self.with(&changes)
    }

    /// The mesh and the steps of the case, as changes.
    pub(super) fn mesh_and_steps(&self) -> Vec<String> {
        let now = |change: String| {
            let (key, _) = change.split_once('=')?;
            let (tables, name) = key.rsplit_once('.')?;
            let mut within = &self.values;
            for table in tables.split('.') {
                within = within.inner(table)?;
            }
            Some(format!("{key}={}", within.to_json().get(name)?))
        };
        let mut changes: Vec<String> = self.case.finer().into_iter().filter_map(now).collect();
        changes.extend(match self.case.steps {
            Steps::Fixed { step, .. } => vec![format!("integrator.step={step:e}")],
            Steps::Controlled { tolerance, .. } => vec![format!("integrator.tolerance={tolerance:e}")],
        });
        changes
    }
}
