//! The error of a run, from companions that are run more finely.
//!
//! ```text
//! discretization = S max_t |y(t) − y_f(t)| + 10⁻¹² max_t |y_f(t)|
//! model          = 1.1 max_t |y_f(t) − y_x(t)|
//! ```
//!
//! y is a column of the run; y_f the same of a companion with twice the elements (functions, nodes) and a more
//! accurate integration; y_x of one with the reference model, the elements of the run and its tolerance. With
//! errors of the mesh that fall like hᵖ the difference y − y_f is (1 − 2⁻ᵖ) of the error of y: S = 2 covers every order
//! p ≥ 1, with half as much again in reserve for p ≥ 2. The factor 1.1 is for what y_x is off itself. Vibration modes converge more slowly than that when the beam
//! rotates fast, and functions other than elements where a section jumps or a load or mass sits within them: S = 4.
//!
//! Of the smallest, largest and last value, found at t*, between records too, the error is (the bracket is `Pair::of_values`)
//!
//! ```text
//! e = S max(|Δ value|, |Δy(t*)|, ¼ max_{t ≤ t*} |Δy(t)|, d min(1, d/(0.1 Y))) + 10⁻¹² Y,   Δy = y − y_f,   d = max_t |Δy|,   Y = max_t |y_f|
//! ```
//!
//! Δ value is the difference of the values of both runs, each at its own t*; it is left out where the companion ends earlier, and e is not known (NaN) where t* lies behind that. Δy(t*) is that of the last record not after t*. The third term is for a difference that passes through zero at t*, the last for vibrations that the mesh does not resolve, whose phases
//! differ.
//!
//! Half the step would not serve where vibrations are hardly resolved, for errors do not fall like hᵖ there. So `Radau`
//! runs all companions: those of its own runs with a tenth of their tolerance, which makes the error 18 times smaller
//! (h ∼ tol^(1/4), error ∼ h⁵), or 6 times where only the stages' order counts (error ∼ h³), and with steps
//! of at most half of its longest, and twice as many between two breaks: where the interval of recording bounds the steps, or a load acts
//! for a short time, those of the run may all be as long as that, and within every tolerance. Vibrations far smaller than the tolerance
//! are damped by such steps, by slightly shorter ones too: a companion with 0.9 of the step has nearly the same error. Those of fixed steps have
//! the tolerances 10⁻⁵, 10⁻⁷ and 10⁻⁹ in turn, until two of them differ by half of what the run differs from the
//! second: the companion need be no more accurate than that, and a tighter tolerance would resolve every frequency of the mesh.
//!
//! A run of a mesh with rigid contacts is compared until the first impact of both only: after it another mesh has other masses at its
//! contacts, and between the two impacts one run has struck and the other has not. Bodies without a mesh have the same masses in both.
//!
//! Work is counted in steps times unknowns, not in seconds, so that the same motion gives the same figures everywhere.
//!
//! An estimate, not a bound: an error that the run and its companion have in common is not seen.

use super::coarse::{Coarse, coarse};
use super::impacts::{before_impacts, until_impact};
use super::instability::{Unstable, instability};
use super::pair::{ColumnError, Pair, vanishes};
use super::trust::{Parting, parting};
use super::variant::SHORTER;
use super::{Refinable, Variant};
use crate::analysis::recording::{Record, Trajectory, Warning, Watch};
use crate::analysis::transient::{Ending, Plan, RunError};
use crate::system::{Channel, Role, State};
use std::ops::ControlFlow;

/// Tolerances of the companions of fixed steps, one after the other.
const LADDER: [f64; 3] = [1e-5, 1e-7, 1e-9];
/// Difference of two companions over that of the run and the second, with which the second is accurate enough: its own
/// error is a thirtieth of the difference or less (100^(3/4), see above).
const SETTLED: f64 = 0.5;
/// Factor on the difference to the reference model, for the error of its own run.
const OWN_ERROR: f64 = 1.1;
/// Steps times unknowns of a run beyond which its companions are not run unasked: about a second of computing.
const COSTLY: f64 = 3e6;
/// Evaluations of the residual that a step has: location of impacts takes more, and counts as so many more steps.
const RESIDUALS: f64 = 4.0;
/// Work of all companions beyond which they are given up unasked: over that of the run, and what is always allowed.
const ALLOWANCE: (f64, f64) = (20.0, 2e6);
/// Part of a value that rounding may have taken.
pub const ROUNDING: f64 = 1e-12;

/// How much an estimate of errors may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// A few times the run, decided by counted work; no estimate where it would cost more.
    Auto,
    /// Whatever it takes.
    Full,
}

/// A companion that an estimate needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Companion {
    /// With twice the functions and a more accurate integration.
    Finer,
    /// With the reference model.
    Reference,
    /// On the same mesh, with a tenth of the tolerance or half the step.
    SmallerSteps,
    /// With a disturbance.
    Disturbed,
}

/// What makes a motion, or the errors that are stated for it, doubtful.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Doubt<F> {
    /// A companion was given up for the work it takes.
    GivenUp,
    /// The errors are those until `time` \[s\], before the first impact.
    BeforeImpact {
        /// The last time compared \[s\].
        time: f64,
    },
    /// From some time on gaps and impacts are others in a more accurate run.
    Parting(Parting),
    /// There is no run of a companion, and what it shows is not known: the difference to the reference model, until when contacts are
    /// right, or whether the motion is unstable.
    Refused {
        /// Which.
        companion: Companion,
        /// Why.
        fault: F,
    },
    /// A small disturbance leads elsewhere.
    Unstable(Unstable),
    /// A companion did not finish, and errors are known until then only.
    Unfinished {
        /// Which.
        companion: Companion,
        /// Its end \[s\].
        time: f64,
        /// Why it failed; `None` where it was given up.
        why: Option<RunError>,
    },
    /// The mesh or the steps are too coarse.
    Coarse(Coarse),
}

/// Estimated errors of a run; `F` is why a variant of it [cannot be run](Refinable::Fault).
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Estimate<F> {
    /// One entry for each column but those about the integrator.
    pub columns: Vec<ColumnError>,
    /// What makes the motion or its errors doubtful.
    pub doubts: Vec<Doubt<F>>,
    /// Time \[s\] until which the errors of the principal columns stay below a tenth of their largest values.
    pub trusted: f64,
    /// The column whose error exceeds that first, where one does.
    pub distrusted: Option<String>,
    /// What the finer companion recorded, until the first impact at the latest.
    pub finer: Trajectory,
    /// By how much the difference from it is multiplied.
    pub safety: f64,
}

impl<F> Estimate<F> {
    /// The errors of the column called `name`.
    pub fn of(&self, name: &str) -> Option<&ColumnError> {
        self.columns.iter().find(|error| error.column == name)
    }

    /// How a small disturbance grows, where it does.
    pub fn unstable(&self) -> Option<&Unstable> {
        self.doubts
            .iter()
            .find_map(|doubt| if let Doubt::Unstable(unstable) = doubt { Some(unstable) } else { None })
    }
}

/// Why there is no estimate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoEstimate<F> {
    /// The run took this many steps times unknowns, and its companions take several times as many: [`Effort::Full`] runs them.
    #[error("the run took {0:.1e} steps times unknowns, and its companions several times as many")]
    Costly(f64),
    /// The first impact comes within the first step or record.
    #[error("the first impact comes within the first step or record")]
    Impact,
    /// There is no finer run.
    #[error("there is no finer run: {0}")]
    Refused(F),
    /// The companions were stopped before they had finished.
    #[error("the companions of the run were stopped")]
    Stopped,
}

/// Estimates the errors of `run`, which is that of `variant`; `watch` is shown the steps of the companions, and `Break` ends the estimate.
///
/// # Errors
/// [`NoEstimate`]
pub fn estimate<P: Refinable>(
    problem: &P,
    variant: &Variant,
    run: &Record,
    effort: Effort,
    watch: &mut Watch<'_>,
) -> Result<Estimate<P::Fault>, NoEstimate<P::Fault>> {
    let steps = (run.counters.steps as f64).max(run.counters.residuals as f64 / RESIDUALS);
    let work = steps * (run.state.v.len() + run.state.lambda.len()) as f64;
    if effort == Effort::Auto && work > COSTLY {
        return Err(NoEstimate::Costly(work));
    }
    let first = variant.fixed_step().unwrap_or(0.0).max(variant.plan.sample);
    if before_impacts(problem, &variant.plan, run).is_some_and(|end| end < first) {
        return Err(NoEstimate::Impact);
    }
    let mut left = match effort {
        Effort::Auto => (ALLOWANCE.0 * work).max(ALLOWANCE.1),
        Effort::Full => f64::INFINITY,
    };
    // Counts the work of companions, and gives them up when it exceeds what is allowed.
    let mut stopped = false;
    let mut counted = |state: &State| {
        left -= state.v.len() as f64;
        stopped |= watch(state).is_break();
        if left < 0.0 || stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let estimate = compared(problem, variant, run, &mut counted);
    if stopped {
        return Err(NoEstimate::Stopped);
    }
    let mut estimate = estimate.map_err(NoEstimate::Refused)?;
    if left < 0.0 {
        estimate.doubts.insert(0, Doubt::GivenUp);
    }
    Ok(estimate)
}

fn compared<P: Refinable>(
    problem: &P,
    variant: &Variant,
    run: &Record,
    watch: &mut Watch<'_>,
) -> Result<Estimate<P::Fault>, P::Fault> {
    let mut doubts = Vec::new();
    let until = before_impacts(problem, &variant.plan, run);
    let end = until.unwrap_or(variant.plan.end);
    let shortened = Variant { plan: Plan { end, ..variant.plan.clone() }, ..variant.clone() };
    let (finer, fine) = finer_run(problem, &shortened, run, watch)?;
    // Before the companion of the reference model, which may use up what work is allowed.
    let parting = parting(problem, variant, run, watch);
    doubts.extend(until.map(|_| Doubt::BeforeImpact { time: reach(&fine) }));
    let parting = found(parting, Companion::SmallerSteps, &mut doubts);
    doubts.extend(parting.map(Doubt::Parting));
    let safety = problem.safety();
    let reference = problem.has_reference().then(|| reference(problem, variant, &finer, watch)).transpose();
    let reference = found(reference, Companion::Reference, &mut doubts);
    let unstable = instability(problem, variant, run, &fine, watch);
    let unstable = found(unstable, Companion::Disturbed, &mut doubts);
    let grown = unstable.as_ref().map_or(f64::INFINITY, |unstable| unstable.until);
    doubts.extend(unstable.map(Doubt::Unstable));
    let other = reference.as_ref().map(|run| (Companion::Reference, run));
    for (companion, run) in std::iter::once((Companion::Finer, &fine)).chain(other) {
        if run.ending != Ending::Finished {
            let why = if let Ending::Failed(error) = &run.ending { Some(error.clone()) } else { None };
            doubts.push(Doubt::Unfinished { companion, time: run.state.t, why });
        }
    }
    let (mut columns, mut trusted) = (Vec::new(), reach(&fine).min(run.state.t).min(grown));
    let mut distrusted = None;
    // What moves only in joints has no principal column that is not zero.
    let moves =
        |(i, c): (usize, &Channel)| c.role == Role::Primary && !vanishes(&run.trajectory, i, problem.size());
    let principal =
        if run.trajectory.channels().iter().enumerate().any(moves) { Role::Primary } else { Role::Secondary };
    for channel in estimated(run) {
        let name = channel.name.as_str();
        let Some(pair) = Pair::new(&run.trajectory, &fine.trajectory, name) else { continue };
        let model = reference.as_ref().and_then(|reference| {
            Pair::new(&fine.trajectory, &reference.trajectory, name).map(|pair| OWN_ERROR * pair.largest())
        });
        let rounding = ROUNDING * pair.size();
        let error = |difference: f64| safety * difference + rounding;
        let [min, max, last] = pair.of_values().map(error);
        if channel.role == principal && !vanishes(pair.ours, pair.index, problem.size()) {
            let until = pair.trusted(safety);
            if until < trusted {
                (trusted, distrusted) = (until, Some(name.to_owned()));
            }
        }
        let discretization = error(pair.largest());
        columns.push(ColumnError { column: name.to_owned(), min, max, last, discretization, model });
    }
    if fine.ending == Ending::Finished {
        let coarse = coarse(problem, variant, run, &columns, (&finer, &fine), watch);
        doubts.extend(coarse.map(Doubt::Coarse));
    }
    Ok(Estimate { columns, doubts, trusted, distrusted, finer: fine.trajectory, safety })
}

/// What a companion shows; where there is no run of it, a doubt says why.
fn found<T, F>(shown: Result<Option<T>, F>, companion: Companion, doubts: &mut Vec<Doubt<F>>) -> Option<T> {
    shown.unwrap_or_else(|fault| {
        doubts.push(Doubt::Refused { companion, fault });
        None
    })
}

/// The last time recorded.
fn reach(run: &Record) -> f64 {
    run.trajectory.times().last().copied().unwrap_or(0.0)
}

/// The variant with twice the functions and a far more accurate integration, and its run: for fixed steps the first of the ladder whose
/// own error does not count beside that of `run`.
fn finer_run<P: Refinable>(
    problem: &P,
    variant: &Variant,
    run: &Record,
    watch: &mut Watch<'_>,
) -> Result<(Variant, Record), P::Fault> {
    let mut finer = refined(problem, variant, run);
    let mut fine = until_impact(problem, &finer, watch)?;
    let Some(step) = variant.fixed_step() else {
        return Ok((finer, fine));
    };
    // Where the companion leaves contacts to nonsmooth steps, which are of the first order, those are a quarter of the steps of the run.
    if rubbing(&fine).is_some() {
        let near = rubbing(run).unwrap_or_else(|| variant.plan.contact_step.unwrap_or(step));
        let finer = finer.by_radau(LADDER[1]);
        let plan = Plan { contact_step: Some(SHORTER * SHORTER * near), ..finer.plan.clone() };
        let finer = Variant { plan, ..finer };
        let fine = until_impact(problem, &finer, watch)?;
        return Ok((finer, fine));
    }
    for rung in &LADDER[1..] {
        if fine.ending != Ending::Finished {
            break;
        }
        let next = finer.by_radau(*rung).with_shorter_parts();
        let Ok(finest) = until_impact(problem, &next, watch) else { break };
        if finest.ending == Ending::Stopped {
            // Given up for its work: the one before has gone to the end.
            break;
        }
        let settled = settled(run, &fine, &finest);
        (finer, fine) = (next, finest);
        if settled {
            break;
        }
    }
    Ok((finer, fine))
}

/// The longest nonsmooth step to which contacts that rub were left \[s\].
fn rubbing(run: &Record) -> Option<f64> {
    run.warnings.iter().find_map(|warning| match warning {
        Warning::Rubbing { step, .. } => Some(*step),
        _ => None,
    })
}

/// The variant with twice the functions and a far more accurate integration.
fn refined<P: Refinable>(problem: &P, variant: &Variant, run: &Record) -> Variant {
    let halved = variant.halved(problem.has_mesh());
    if variant.fixed_step().is_some() { halved.by_radau(LADDER[0]) } else { halved.more_accurate(run) }
}

/// The run of the reference model on the mesh of `variant`, to its tolerance.
fn reference<P: Refinable>(
    problem: &P,
    variant: &Variant,
    finer: &Variant,
    watch: &mut Watch<'_>,
) -> Result<Record, P::Fault> {
    let longest = finer.plan.longest_step.map(|longest| longest / SHORTER);
    let plan = Plan { longest_step: longest, ..finer.plan.clone() };
    let tolerance = variant.tolerance.or(finer.tolerance);
    until_impact(problem, &Variant { reference: true, plan, tolerance, ..variant.clone() }, watch)
}

/// Whether the errors of all columns of `run` are known from `finer`, which a `coarser` companion confirms. The energy balance, whose
/// exact value 0 is known, is not asked: a method that conserves energy meets it better than its companions.
fn settled(run: &Record, coarser: &Record, finer: &Record) -> bool {
    let known = |channel: &Channel| {
        let pair = |run| Pair::new(run, &finer.trajectory, &channel.name);
        let (Some(ours), Some(theirs)) = (pair(&run.trajectory), pair(&coarser.trajectory)) else {
            return true;
        };
        theirs.largest() <= SETTLED * ours.largest() + ROUNDING * ours.size()
    };
    finer.ending == Ending::Finished && estimated(run).filter(|c| c.role != Role::Imbalance).all(known)
}

/// The columns whose errors are estimated: all but those about the integrator.
fn estimated(run: &Record) -> impl Iterator<Item = &Channel> {
    run.trajectory.channels().iter().filter(|c| c.role != Role::Integration)
}
