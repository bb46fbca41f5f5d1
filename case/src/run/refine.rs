//! Refinement of a case until what is asked of it is accurate enough.
//!
//! Run k has twice the elements (functions) of run k − 1, and a tenth of its tolerance or half its step. Its error is
//! [estimated](Reading::estimate_errors) from a finer companion. The order p of a sequence is that of its errors against the
//! elements, log₂(e_{k−1}/e_k): mesh and steps together, as they are refined. The run with the smallest error is the result: rounding
//! grows with the mesh, and the last run need not be the best.

use super::Run;
use super::difference::{Pair, vanishes};
use super::error::{Effort, FINER, TIGHTEST};
use crate::kinds::integrator::Steps;
use crate::problem::Problems;
use crate::reading::Reading;
use crate::units;
use flexion::analysis::recording::Watch;
use flexion::system::{Role, State};
use flexion_results::{Errors, ResultsError, Rung, Status, Trajectory, nearest};
use std::cell::Cell;

/// Largest number of refinements.
const MOST: usize = 8;
/// Steps times unknowns of all runs and companions, about two minutes of computing.
const MOST_WORK: f64 = 3e8;
/// Work of a refinement over that of the one before: twice the unknowns, and as many steps or nearly so.
const COSTLIER: f64 = 4.0;
/// Quotient of two successive errors above which they do not fall.
const FALLING: f64 = 0.7;
/// Error over the largest value of a column below which rounding is to blame for errors that have fallen and no longer do.
const SMALL: f64 = 1e-4;

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
    /// `tip.deflection.min`, `.max` or `.final`. Without one all principal columns are meant, or those of that kind of unit.
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
                let principal: Vec<usize> = principal.map(|(index, _)| index).collect();
                // A tolerance with a unit bounds the columns that it fits.
                let fits = |index: &usize| {
                    self.is_relative()
                        || units::parse_in(&self.tolerance, &trajectory.channels()[*index].unit).is_ok()
                };
                let mut fitting: Vec<usize> = principal.iter().copied().filter(fits).collect();
                if fitting.is_empty() {
                    fitting = principal;
                }
                goals.extend(fitting.into_iter().map(|index| (index, Part::History)));
            }
        }
        goals.into_iter().map(|(index, part)| self.goal(trajectory, index, part)).collect()
    }

    /// Whether the tolerance is a part of the largest value.
    fn is_relative(&self) -> bool {
        self.tolerance.trim().parse::<f64>().is_ok()
    }

    fn goal(&self, trajectory: &Trajectory, index: usize, part: Part) -> Result<Goal, RefineError> {
        let channel = &trajectory.channels()[index];
        let fault = |reason: String| RefineError::Tolerance { text: self.tolerance.clone(), reason };
        let bound = match self.tolerance.trim().parse::<f64>() {
            Ok(relative) => relative * trajectory.extremes(index).largest(),
            Err(_) => units::parse_in(&self.tolerance, &channel.unit)
                .map_err(|error| fault(format!("of `{}` is no number: {}", channel.name, error.message)))?,
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

/// A refined case and its run, with its errors over their bounds.
struct Best {
    reading: Reading,
    run: Run,
    ratio: f64,
}

impl Reading {
    /// Refines the case until the estimated errors of what is asked are below their tolerance, or cannot be brought there. The result is
    /// the run with the smallest error; one that `watch` has stopped counts only where it is the first. `said` is shown each run.
    ///
    /// # Errors
    /// [`RefineError`]: a case that cannot be refined, a column that is not there, a tolerance that is none.
    pub fn refine(
        &self,
        target: &Target,
        watch: &mut Watch<'_>,
        said: &mut dyn FnMut(&Rung),
    ) -> Result<Refinement, RefineError> {
        let (work, stopped) = (Cell::new(0.0), Cell::new(false));
        let mut watch = |state: &State| {
            work.set(work.get() + state.v.len() as f64);
            let flow = watch(state);
            stopped.set(stopped.get() || flow.is_break());
            flow
        };
        let mut best: Option<Best> = None;
        let (mut reading, mut rungs, mut ratios) = (self.clone(), Vec::<Rung>::new(), Vec::new());
        let mut before = 0.0;
        let refused = loop {
            let mut run = reading.prepare()?.run(&mut watch);
            let goals = target.goals(&run, self.case.size())?;
            if run.status != Status::Finished {
                let why = match run.status {
                    Status::Stopped => "stopped by the user".to_owned(),
                    _ => format!("a refined run failed: {}", run.message.as_deref().unwrap_or_default()),
                };
                best.get_or_insert(Best { reading, run, ratio: f64::INFINITY });
                break Some(why);
            }
            let errors = reading.estimate_errors(&run, Effort::Full, &mut watch)?;
            let reached = goals.iter().filter_map(|goal| Some((goal, goal.reached(&run, &errors)?)));
            // The goal that is farthest from its bound.
            let farthest = reached.max_by(|(a, (_, x)), (b, (_, y))| (x / a.bound).total_cmp(&(y / b.bound)));
            let Some((goal, (value, error))) = farthest else {
                run.errors = Some(errors);
                best = Some(Best { reading, run, ratio: 0.0 });
                break None;
            };
            if stopped.get() && best.is_some() {
                break Some("stopped by the user".to_owned());
            }
            let (bound, ratio) = (goal.bound, error / goal.bound);
            let largest = run.trajectory.extremes(goal.index).largest();
            let order = rungs
                .last()
                .filter(|rung| rung.quantity == goal.quantity())
                .map(|rung| (rung.error / error).log2());
            let changes = reading.mesh_and_steps();
            rungs.push(Rung { changes, quantity: goal.quantity(), value, error, order });
            ratios.push(ratio);
            rungs.last().into_iter().for_each(&mut *said);
            let amplified = errors.unstable.is_some() || errors.trusted < run.state.t;
            run.errors = Some(errors);
            let next = reading.next();
            if best.as_ref().is_none_or(|best| !(best.ratio <= ratio)) {
                best = Some(Best { reading, run, ratio });
            }
            if error <= bound {
                break None;
            }
            if stopped.get() {
                break Some("stopped by the user".to_owned());
            }
            let found = format!("the error of {} is {error:.1e} and not below {bound:.1e}", goal.quantity());
            let last = std::mem::replace(&mut before, work.get());
            let works = (work.get(), work.get() - last);
            if let Some(why) = give_up(&ratios, error / largest, amplified, works) {
                break Some(format!("{found}{why}"));
            }
            match next {
                Ok(next) => reading = next,
                Err(problems) => {
                    let why = problems.list.first().map_or("", |problem| problem.message.as_str());
                    break Some(format!("{found}, and the case cannot be refined further: {why}"));
                }
            }
        };
        let Some(Best { reading, mut run, .. }) = best else {
            return Err(self.problem("", "nothing was run").into());
        };
        if let Some(errors) = &mut run.errors {
            errors.sequence = rungs;
        }
        if run.status == Status::Finished {
            run.message.clone_from(&refused);
        }
        Ok(Refinement { reading, run, refused })
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

/// Why a sequence ends before its goal, if it does: `ratios` are its errors over their bounds, the last is a `part` of the largest value,
/// `amplified` says whether the motion amplifies differences; and the work of all runs, and of the last with its companions.
fn give_up(ratios: &[f64], part: f64, amplified: bool, (all, last): (f64, f64)) -> Option<String> {
    let slow = ratios.windows(2).map(|pair| !(pair[1] <= FALLING * pair[0]));
    let slow: Vec<bool> = slow.collect();
    let better = "ask for less, or begin with a finer mesh";
    match slow.as_slice() {
        [.., true, true] if amplified => Some(
            ", and errors do not fall: the motion amplifies differences, as an unstable or chaotic one does; ask for a shorter time, or for \
             less"
                .to_owned(),
        ),
        [.., false, true] | [true] if part < SMALL && !amplified => {
            Some(", and errors no longer fall: rounding, which grows with the mesh, is of their size; ask for less".to_owned())
        }
        [.., true, true] => Some(
            ", and errors do not fall: a load may have no derivative, or a section a jump within an element; ask for less".to_owned(),
        ),
        _ if ratios.len() > MOST => Some(format!(" after {MOST} refinements: {better}")),
        _ if all + COSTLIER * last > MOST_WORK => Some(format!(
            " after {all:.1e} steps times unknowns, and the next refinement would take {:.1e}: {better}",
            COSTLIER * last
        )),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors that fall and then rise at 10⁻⁷ of the largest value are rounding; errors that never fall are not, and of a motion that
    /// amplifies differences two refinements show it.
    #[test]
    fn a_sequence_ends_for_the_reason_that_it_has() {
        let why = |ratios: &[f64], part: f64, amplified: bool| {
            give_up(ratios, part, amplified, (1e6, 1e6)).unwrap_or_default()
        };
        assert!(why(&[100.0, 6.0, 9.0], 1e-7, false).contains("rounding"));
        assert!(why(&[100.0, 99.0, 98.0], 0.3, true).contains("amplifies differences"));
        assert!(why(&[100.0, 99.0, 98.0], 0.3, false).contains("no derivative"));
        assert_eq!(why(&[100.0, 99.0], 0.3, false), "");
        assert_eq!(why(&[100.0, 6.0], 1e-7, false), "");
        assert!(give_up(&[100.0, 6.0], 1e-7, false, (1e8, 0.9e8)).unwrap().contains("3.6e8"));
    }
}
