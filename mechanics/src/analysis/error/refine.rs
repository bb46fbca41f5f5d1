//! Refinement of mesh and steps until what is asked is accurate enough.
//!
//! Run k has twice the elements (functions) of run k − 1, and a tenth of its tolerance with steps below half of its longest, or half its
//! step. Its error is
//! [estimated](super::estimate()) from a finer companion. The order p of a sequence is that of its errors against the
//! elements, log₂(e_{k−1}/e_k): mesh and steps together, as they are refined. The run with the smallest error is the result: rounding
//! grows with the mesh, and the last run need not be the best.

use super::estimate::{Effort, Estimate, NoEstimate, estimate};
use super::pair::{ColumnError, Pair, vanishes};
use super::{Refinable, Variant};
use crate::analysis::recording::{Record, Trajectory, Watch};
use crate::analysis::transient::{Ending, Plan, RunError};
use crate::system::{Role, State};
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
pub enum Part {
    /// The smallest value.
    Min,
    /// The largest value.
    Max,
    /// The last value.
    Final,
    /// The value at any recorded time.
    History,
}

/// A column, or a value of it, and how accurate it is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// Name of the column.
    pub column: String,
    /// What of it is meant.
    pub part: Part,
    /// Largest error, in the unit of the column.
    pub bound: f64,
}

impl Goal {
    /// The value in a run, where it is one, and its error.
    pub fn reached(&self, of: &Trajectory, errors: &[ColumnError]) -> Option<(Option<f64>, f64)> {
        let error = errors.iter().find(|error| error.column == self.column)?;
        let e = of.extremes(of.index(&self.column)?);
        Some(match self.part {
            Part::Min => (Some(e.min), error.min),
            Part::Max => (Some(e.max), error.max),
            Part::Final => (Some(e.last), error.last),
            Part::History => (None, error.discretization),
        })
    }

    /// The difference of the value in two runs.
    pub fn off(&self, pair: &Pair<'_>) -> f64 {
        let [min, max, last] = pair.of_values();
        match self.part {
            Part::Min => min,
            Part::Max => max,
            Part::Final => last,
            Part::History => pair.largest(),
        }
    }

    /// Its name, `tip.deflection.min`.
    pub fn quantity(&self) -> String {
        let end = match self.part {
            Part::Min => ".min",
            Part::Max => ".max",
            Part::Final => ".final",
            Part::History => "",
        };
        format!("{}{end}", self.column)
    }
}

/// The principal columns that do not vanish; `size` \[m\] is that of the [system](Refinable::size).
pub fn principal(of: &Trajectory, size: f64) -> Vec<usize> {
    of.with_role(Role::Primary).filter(|index| !vanishes(of, *index, size)).collect()
}

/// A run of a sequence that is refined until its error is small enough.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rung {
    /// How it was computed.
    pub variant: Variant,
    /// The goal that is farthest from its bound.
    pub goal: Goal,
    /// Its value, where it is one.
    pub value: Option<f64>,
    /// Its error.
    pub error: f64,
    /// Observed order p: log₂ of the error of the run before over this, where that had the same goal.
    pub order: Option<f64>,
}

/// Why errors were given up before they were small enough.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum GivenUp {
    /// Errors do not fall, for the motion amplifies differences, as an unstable or chaotic one does.
    Amplified,
    /// Errors no longer fall: rounding, which grows with the mesh, is of their size.
    Rounding,
    /// Errors do not fall: a load may have no derivative, or a section a jump within an element.
    NotFalling,
    /// So many refinements were made.
    Refinements(usize),
    /// The work of all runs, and what the next refinement would take, in steps times unknowns.
    Work(f64, f64),
}

/// How a sequence ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Ended<F> {
    /// What was asked is reached, as far as errors are known.
    Reached,
    /// It was stopped.
    Stopped,
    /// A refined run failed.
    Failed(RunError),
    /// The errors cannot be brought down.
    GivenUp(GivenUp),
    /// There is no finer variant, or none to estimate its errors by.
    Refused(F),
    /// The errors of a run are not known; where it is the result, they say why.
    Unknown,
}

/// The best run of a sequence.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Refinement<R, F> {
    /// How it was computed.
    pub variant: Variant,
    /// The run.
    pub run: R,
    /// Its errors; `None` where it did not finish.
    pub errors: Option<Result<Estimate<F>, NoEstimate<F>>>,
    /// All runs of the sequence.
    pub rungs: Vec<Rung>,
    /// How the sequence ended.
    pub ended: Ended<F>,
}

/// A run with its errors over their bounds.
struct Best<R, F> {
    variant: Variant,
    run: R,
    errors: Option<Result<Estimate<F>, NoEstimate<F>>>,
    ratio: f64,
}

/// Refines mesh and steps until the estimated errors of what is asked are below their bounds, or cannot be brought there. The result is
/// the run with the smallest error; one that `watch` has stopped counts only where it is the first. `goals` says of the first run what is
/// asked, and of every other anew, since a bound may be a part of the largest value. `said` is shown each run.
///
/// # Errors
/// Those of `goals`, and of a motion that cannot be run as it is asked for.
pub fn refine<P: Refinable, E: From<P::Fault>>(
    problem: &P,
    goals: &dyn Fn(&Trajectory) -> Result<Vec<Goal>, E>,
    watch: &mut Watch<'_>,
    said: &mut dyn FnMut(&Rung),
) -> Result<Refinement<P::Run, P::Fault>, E> {
    let work = Cell::new(0.0);
    let mut watch = |state: &State| {
        work.set(work.get() + state.v.len() as f64);
        watch(state)
    };
    let (mut rungs, mut ratios) = (Vec::<Rung>::new(), Vec::new());
    let (mut variant, mut before) = (problem.variant(), 0.0);
    let mut best: Option<Best<P::Run, P::Fault>> = None;
    let (best, ended) = loop {
        let run = match (problem.run(&variant, &mut watch), best) {
            (Ok(run), kept) => {
                best = kept;
                run
            }
            (Err(fault), Some(best)) => break (best, Ended::Refused(fault)),
            (Err(fault), None) => return Err(fault.into()),
        };
        let record = run.as_ref();
        let goals = goals(&record.trajectory)?;
        let ended = match &record.ending {
            Ending::Finished => None,
            Ending::Stopped => Some(Ended::Stopped),
            Ending::Failed(error) => Some(Ended::Failed(error.clone())),
        };
        if let Some(ended) = ended {
            let unfinished = Best { variant, run, errors: None, ratio: f64::INFINITY };
            break (best.unwrap_or(unfinished), ended);
        }
        let errors = match (estimate(problem, &variant, record, Effort::Full, &mut watch), best) {
            (Ok(errors), kept) => {
                best = kept;
                errors
            }
            (Err(NoEstimate::Refused(fault)), Some(best)) => break (best, Ended::Refused(fault)),
            (Err(unknown), kept) => {
                let ended = if let NoEstimate::Stopped = unknown { Ended::Stopped } else { Ended::Unknown };
                let first = || Best { variant, run, errors: Some(Err(unknown)), ratio: 0.0 };
                break (kept.unwrap_or_else(first), ended);
            }
        };
        let reached =
            goals.iter().filter_map(|goal| Some((goal, goal.reached(&record.trajectory, &errors.columns)?)));
        // The goal that is farthest from its bound.
        let farthest = reached.max_by(|(a, (_, x)), (b, (_, y))| (x / a.bound).total_cmp(&(y / b.bound)));
        let Some((goal, (value, error))) = farthest else {
            break (Best { variant, run, errors: Some(Ok(errors)), ratio: 0.0 }, Ended::Reached);
        };
        let ratio = error / goal.bound;
        let largest = record
            .trajectory
            .index(&goal.column)
            .map_or(f64::NAN, |index| record.trajectory.extremes(index).largest());
        let alike =
            rungs.last().filter(|rung| (&rung.goal.column, rung.goal.part) == (&goal.column, goal.part));
        let order = alike.map(|rung| libm::log2(rung.error / error));
        let rung = Rung { variant: variant.clone(), goal: goal.clone(), value, error, order };
        said(&rung);
        rungs.push(rung);
        ratios.push(ratio);
        let amplified = errors.unstable().is_some() || errors.trusted < record.state.t;
        let next = next(problem, &variant, record);
        let kept = match best.take() {
            Some(best) if best.ratio <= ratio => best,
            _ => Best { variant, run, errors: Some(Ok(errors)), ratio },
        };
        if error <= goal.bound {
            break (kept, Ended::Reached);
        }
        let last = std::mem::replace(&mut before, work.get());
        let works = (work.get(), work.get() - last);
        if let Some(why) = give_up(&ratios, error / largest, amplified, works) {
            break (kept, Ended::GivenUp(why));
        }
        (variant, best) = (next, Some(kept));
    };
    let Best { variant, run, errors, .. } = best;
    Ok(Refinement { variant, run, errors, rungs, ended })
}

/// The variant with twice the functions, and a tenth of the tolerance with half the first and the longest step of its `run` and twice the steps between
/// breaks, or half the step.
fn next<P: Refinable>(problem: &P, variant: &Variant, run: &Record) -> Variant {
    let halved = variant.halved(problem.has_mesh());
    match variant.fixed_step() {
        Some(step) => Variant { plan: Plan { step: Some(0.5 * step), ..halved.plan.clone() }, ..halved },
        None => halved.more_accurate(run),
    }
}

/// Why a sequence ends before its goal, if it does: `ratios` are its errors over their bounds, the last is a `part` of the largest value,
/// `amplified` says whether the motion amplifies differences; and the work of all runs, and of the last with its companions.
fn give_up(ratios: &[f64], part: f64, amplified: bool, (all, last): (f64, f64)) -> Option<GivenUp> {
    let slow = ratios.windows(2).map(|pair| !(pair[1] <= FALLING * pair[0]));
    let slow: Vec<bool> = slow.collect();
    match slow.as_slice() {
        [.., true, true] if amplified => Some(GivenUp::Amplified),
        [.., false, true] | [true] if part < SMALL && !amplified => Some(GivenUp::Rounding),
        [.., true, true] => Some(GivenUp::NotFalling),
        _ if ratios.len() > MOST => Some(GivenUp::Refinements(MOST)),
        _ if all + COSTLIER * last > MOST_WORK => Some(GivenUp::Work(all, COSTLIER * last)),
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
        let why = |ratios: &[f64], part: f64, amplified: bool| give_up(ratios, part, amplified, (1e6, 1e6));
        assert_eq!(why(&[100.0, 6.0, 9.0], 1e-7, false), Some(GivenUp::Rounding));
        assert_eq!(why(&[100.0, 99.0, 98.0], 0.3, true), Some(GivenUp::Amplified));
        assert_eq!(why(&[100.0, 99.0, 98.0], 0.3, false), Some(GivenUp::NotFalling));
        assert_eq!(why(&[100.0, 99.0], 0.3, false), None);
        assert_eq!(why(&[100.0, 6.0], 1e-7, false), None);
        assert_eq!(give_up(&[100.0, 6.0], 1e-7, false, (1e8, 0.9e8)), Some(GivenUp::Work(1e8, 3.6e8)));
    }
}
