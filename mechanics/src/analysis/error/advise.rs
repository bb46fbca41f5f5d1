//! Advice: the cheapest model, mesh and method with which a motion is as accurate as is asked.
//!
//! The trusted answer is that of the highest model whose data are given, refined until its estimated error is a fifth of what is asked.
//! Then the ladder is climbed: each model on the trusted mesh; of those that hold, each family of meshes with more and more functions,
//! integrated accurately; of those that hold, each method with smaller and smaller steps. A run is held against the trusted answer: its
//! difference d, and the error of that answer added, over the bound. Of the trusted model d is an error of mesh and steps; of another it is
//! the difference of the models too, which is no error. Work is counted, evaluations of the residual times unknowns, so that the advice is
//! the same everywhere; a run that becomes costlier than the cheapest that holds is given up.

use super::estimate::NoEstimate;
use super::pair::{ColumnError, Pair};
use super::refine::{Ended, Goal, Refinement, Rung, refine};
use super::{Mesh, Refinable, Variant};
use crate::analysis::recording::{Record, Trajectory, Watch};
use crate::analysis::transient::{Ending, Plan, RunError};
use crate::integrator::Tolerance;
use crate::system::State;
use std::ops::{ControlFlow, Range};

/// Error of the trusted answer over what is asked, which is aimed at, and with which it is still trusted.
const TRUSTED: (f64, f64) = (0.2, 0.5);
/// Steps times unknowns of all runs of the ladder, about two minutes of computing.
const MOST_WORK: f64 = 3e8;
/// Tolerance of runs that tell the errors of meshes, over what is asked of the largest value.
const ACCURATE: f64 = 1e-2;
/// Functions of the meshes of a family, over those of the coarsest.
const MESHES: [f64; 5] = [1.0, 2.0, 4.0, 8.0, 16.0];
/// Relative tolerances of Radau, each with the next as the absolute one.
const TOLERANCES: [f64; 9] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11];
/// Those that are tried one after the other, and those that runs which tell the errors of meshes may have.
const TRIED: Range<usize> = 0..5;
const FINE: Range<usize> = 2..8;
/// Numbers of steps of the methods with fixed steps.
const STEPS: [f64; 7] = [50.0, 200.0, 800.0, 3200.0, 12_800.0, 51_200.0, 204_800.0];

/// The models, meshes and methods by which one motion can be computed, by numbers.
pub trait Ladder {
    /// The motion by one of them.
    type Motion: Refinable;

    /// Number of models. The first leaves out most and the last least; they have the same columns for the same quantities.
    fn models(&self) -> usize;

    /// The motion by a model, with control of steps, on the mesh from which the trusted answer is refined. All models have the same one.
    ///
    /// # Errors
    /// Where the data of the model are not given, or it cannot carry what the motion has.
    fn model(&self, model: usize) -> Result<Self::Motion, Fault<Self>>;

    /// The motion by a model on the coarsest mesh of each of its families.
    fn families(&self, model: usize) -> Vec<Result<Self::Motion, Fault<Self>>>;

    /// The same on one of them by each method with fixed steps: that of its variants without tolerance.
    fn methods(&self, model: usize, family: usize) -> Vec<Result<Self::Motion, Fault<Self>>>;
}

/// Why a motion of a ladder cannot be run.
pub type Fault<L> = <<L as Ladder>::Motion as Refinable>::Fault;

/// Which run of a ladder, by numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The model.
    pub model: usize,
    /// The family of meshes; `None` is the trusted mesh.
    pub family: Option<usize>,
    /// The method with fixed steps; `None` is Radau.
    pub method: Option<usize>,
}

/// Why a run has no difference from the trusted answer.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum NoDifference<F> {
    /// It became costlier than the cheapest that holds.
    Costlier,
    /// It failed.
    Failed(RunError),
    /// There is no such run.
    Refused(F),
    /// It has no such column.
    NoColumn(String),
}

/// A run of the ladder.
#[derive(Clone, Debug)]
pub struct Tried<F> {
    /// Which it is.
    pub choice: Choice,
    /// How it was computed.
    pub variant: Variant,
    /// Evaluations of the residual times unknowns.
    pub work: f64,
    /// Its difference from the trusted answer over the bound, the largest of all goals, with the error of that answer.
    pub difference: Result<f64, NoDifference<F>>,
}

impl<F> Tried<F> {
    /// Whether it is as accurate as is asked.
    pub fn holds(&self) -> bool {
        self.difference.as_ref().is_ok_and(|difference| *difference <= 1.0)
    }
}

/// What came of a ladder.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Advice<F> {
    /// The trusted model.
    pub trusted: usize,
    /// How its answer was computed.
    pub variant: Variant,
    /// Its answer.
    pub record: Record,
    /// The estimated error of that over the bound, the largest of all goals.
    pub error: f64,
    /// What was asked.
    pub goals: Vec<Goal>,
    /// The models that were not tried, and why.
    pub untried: Vec<(usize, F)>,
    /// All runs, in the order in which they were tried.
    pub tried: Vec<Tried<F>>,
    /// The number of the cheapest that holds among them.
    pub cheapest: Option<usize>,
    /// Whether the ladder ended early for the work it takes.
    pub bounded: bool,
    /// Whether it was stopped.
    pub stopped: bool,
}

/// Why there is no advice.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum NoAdvice<F, E> {
    /// What is asked is to blame.
    Asked(E),
    /// No model can be run, each for its reason.
    NoModel(Vec<(usize, F)>),
    /// The answer of the highest model is not accurate enough to be trusted.
    NotTrusted(Box<NotTrusted<F>>),
}

/// An answer that is not accurate enough.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct NotTrusted<F> {
    /// The model.
    pub model: usize,
    /// Its error over what is asked; NaN where it is not known.
    pub error: f64,
    /// Its last refined run.
    pub last: Option<Rung>,
    /// How its refinement ended.
    pub ended: Ended<F>,
    /// Why its errors are not known, where they are not.
    pub unknown: Option<NoEstimate<F>>,
}

/// What a refinement may fail by.
enum Failed<F, E> {
    Motion(F),
    Asked(E),
}

impl<F, E> From<F> for Failed<F, E> {
    fn from(fault: F) -> Failed<F, E> {
        Failed::Motion(fault)
    }
}

/// Climbs a ladder for the cheapest run with which `goals` hold; they are asked of the trusted answer.
///
/// # Errors
/// [`NoAdvice`]
pub fn advise<L: Ladder, E>(
    ladder: &L,
    goals: &dyn Fn(&Trajectory) -> Result<Vec<Goal>, E>,
    watch: &mut Watch<'_>,
) -> Result<Advice<Fault<L>>, NoAdvice<Fault<L>, E>> {
    let strict = |of: &Trajectory| {
        let part = |goal: Goal| Goal { bound: TRUSTED.0 * goal.bound, ..goal };
        goals(of).map(|goals| goals.into_iter().map(part).collect()).map_err(Failed::Asked)
    };
    let mut untried = Vec::new();
    for model in (0..ladder.models()).rev() {
        let refined = ladder.model(model).map_err(Failed::Motion);
        match refined.and_then(|motion| refine(&motion, &strict, watch, &mut |_| {})) {
            Ok(refined) => {
                let mut advice = trusted(model, refined, goals)?;
                advice.untried = untried;
                climb(ladder, &mut advice, watch);
                return Ok(advice);
            }
            Err(Failed::Motion(fault)) => untried.push((model, fault)),
            Err(Failed::Asked(error)) => return Err(NoAdvice::Asked(error)),
        }
    }
    Err(NoAdvice::NoModel(untried))
}

/// The refined answer of a model, where it is accurate enough.
fn trusted<R: Into<Record>, F, E>(
    model: usize,
    refined: Refinement<R, F>,
    goals: &dyn Fn(&Trajectory) -> Result<Vec<Goal>, E>,
) -> Result<Advice<F>, NoAdvice<F, E>> {
    let Refinement { variant, run, errors, rungs, ended } = refined;
    let record: Record = run.into();
    let goals = goals(&record.trajectory).map_err(NoAdvice::Asked)?;
    let (columns, unknown) = match errors {
        Some(Ok(errors)) => (Some(errors.columns), None),
        Some(Err(unknown)) => (None, Some(unknown)),
        None => (None, None),
    };
    let part = |goal: &Goal, columns: &[ColumnError]| {
        goal.reached(&record.trajectory, columns).map_or(0.0, |(_, error)| over(error, goal.bound))
    };
    let of = |columns: &Vec<ColumnError>| goals.iter().map(|goal| part(goal, columns)).fold(0.0, worse);
    let error = columns.as_ref().map_or(f64::NAN, of);
    if !(error <= TRUSTED.1 && record.ending == Ending::Finished) {
        let last = rungs.into_iter().next_back();
        return Err(NoAdvice::NotTrusted(Box::new(NotTrusted { model, error, last, ended, unknown })));
    }
    let (untried, tried) = (Vec::new(), Vec::new());
    let (cheapest, bounded, stopped) = (None, false, false);
    Ok(Advice { trusted: model, variant, record, error, goals, untried, tried, cheapest, bounded, stopped })
}

/// A difference over its bound; what stands still has a bound of zero.
fn over(difference: f64, bound: f64) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / bound }
}

/// The larger, or NaN.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b <= a { a } else { b }
}

/// The climb of one ladder.
struct Climb<'a, 'b, F> {
    advice: &'a mut Advice<F>,
    /// Work of the cheapest run that holds.
    least: f64,
    left: f64,
    watch: &'a mut Watch<'b>,
}

fn climb<L: Ladder>(ladder: &L, advice: &mut Advice<Fault<L>>, watch: &mut Watch<'_>) {
    let (accurate, mesh) = (accurate(advice), advice.variant.mesh);
    let top = advice.trusted;
    let mut climb = Climb { advice, least: f64::INFINITY, left: MOST_WORK, watch };
    for model in 0..=top {
        let motion = match ladder.model(model) {
            Ok(motion) => motion,
            Err(fault) => {
                climb.advice.untried.push((model, fault));
                continue;
            }
        };
        let choice = Choice { model, family: None, method: None };
        let variant = by_radau(&motion, mesh, accurate);
        if !climb.run(&motion, choice, variant) {
            continue;
        }
        for (family, motion) in ladder.families(model).into_iter().enumerate() {
            let choice = Choice { family: Some(family), ..choice };
            let Ok(motion) = motion.map_err(|fault| climb.refused(choice, fault)) else { continue };
            let count = if motion.has_mesh() { MESHES.len() } else { 1 };
            let mut meshes = MESHES[..count].iter().map(|factor| Mesh { halvings: 0, factor: Some(*factor) });
            let enough = meshes.find(|mesh| climb.run(&motion, choice, by_radau(&motion, *mesh, accurate)));
            let Some(mesh) = enough else { continue };
            for tolerance in TRIED {
                if climb.run(&motion, choice, by_radau(&motion, mesh, tolerance)) {
                    break;
                }
            }
            for (method, motion) in ladder.methods(model, family).into_iter().enumerate() {
                let choice = Choice { method: Some(method), ..choice };
                let Ok(motion) = motion.map_err(|fault| climb.refused(choice, fault)) else { continue };
                climb.steps(&motion, choice, mesh);
            }
        }
    }
    climb.advice.bounded = climb.left < 0.0;
    let holds = climb.advice.tried.iter().enumerate().filter(|(_, tried)| tried.holds());
    climb.advice.cheapest = holds.min_by(|a, b| a.1.work.total_cmp(&b.1.work)).map(|(index, _)| index);
    climb.advice.untried.sort_by_key(|(model, _)| *model);
}

/// A motion by Radau on a mesh, with a tolerance of this number.
fn by_radau<P: Refinable>(motion: &P, mesh: Mesh, k: usize) -> Variant {
    let tolerance = Tolerance { relative: TOLERANCES[k], absolute: TOLERANCES[k + 1] };
    let variant = motion.variant().by_radau(tolerance.relative);
    Variant { mesh, ..variant }.with_tolerance(tolerance)
}

/// The number of a tolerance at which the error of the steps does not count.
fn accurate<F>(advice: &Advice<F>) -> usize {
    let of = &advice.record.trajectory;
    let largest = |goal: &Goal| of.index(&goal.column).map_or(f64::NAN, |i| of.extremes(i).largest());
    let parts = advice.goals.iter().map(|goal| goal.bound / largest(goal));
    let wanted = ACCURATE * parts.fold(1.0, f64::min);
    FINE.into_iter().find(|k| TOLERANCES[*k] <= wanted).unwrap_or(FINE.end - 1)
}

impl<F> Climb<'_, '_, F> {
    /// A method with smaller and smaller steps, until it holds or becomes too costly.
    fn steps<P: Refinable<Fault = F>>(&mut self, motion: &P, choice: Choice, mesh: Mesh) {
        for count in STEPS {
            let own = motion.variant();
            let plan = Plan { step: Some(own.plan.end / count), ..own.plan.clone() };
            let holds = self.run(motion, choice, Variant { mesh, plan, tolerance: None, ..own });
            if holds || self.advice.tried.last().is_some_and(|tried| tried.work >= self.least) {
                break;
            }
        }
    }

    /// Notes a run that there is not.
    fn refused(&mut self, choice: Choice, fault: F) {
        let variant = self.advice.variant.clone();
        let difference = Err(NoDifference::Refused(fault));
        self.advice.tried.push(Tried { choice, variant, work: 0.0, difference });
    }

    /// Runs one rung, unless the work is used up: whether it holds.
    fn run<P: Refinable<Fault = F>>(&mut self, motion: &P, choice: Choice, variant: Variant) -> bool {
        if self.left < 0.0 || self.advice.stopped {
            return false;
        }
        let (least, mut steps, mut stopped) = (self.least, 0.0, false);
        let run = motion.record(&variant, &mut |state: &State| {
            steps += state.v.len() as f64;
            stopped |= (self.watch)(state).is_break();
            if steps > least || stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        self.left -= steps;
        self.advice.stopped = stopped;
        if stopped {
            return false;
        }
        let unknowns = |run: &Record| (run.state.v.len() + run.state.lambda.len()) as f64;
        let work = run.as_ref().map_or(0.0, |run| run.counters.residuals as f64 * unknowns(run));
        let difference = match run {
            Ok(Record { ending: Ending::Stopped, .. }) => Err(NoDifference::Costlier),
            Ok(Record { ending: Ending::Failed(error), .. }) => Err(NoDifference::Failed(error)),
            Ok(run) => self.difference(&run.trajectory),
            Err(fault) => Err(NoDifference::Refused(fault)),
        };
        let tried = Tried { choice, variant, work: work.max(steps), difference };
        let holds = tried.holds();
        if holds {
            self.least = self.least.min(tried.work);
        }
        self.advice.tried.push(tried);
        holds
    }

    /// The largest difference from the trusted answer over its bound.
    fn difference(&self, of: &Trajectory) -> Result<f64, NoDifference<F>> {
        let mut largest = 0.0;
        for goal in &self.advice.goals {
            let pair = Pair::new(of, &self.advice.record.trajectory, &goal.column);
            let pair = pair.ok_or_else(|| NoDifference::NoColumn(goal.column.clone()))?;
            largest = worse(largest, over(goal.off(&pair), goal.bound));
        }
        Ok(largest + self.advice.error)
    }
}
