//! The error of a run, from companions that are run more finely.
//!
//! ```text
//! discretization = S max_t |y(t) − y_f(t)| + 10⁻¹² max_t |y_f(t)|
//! model          = 1.1 max_t |y_f(t) − y_x(t)|
//! ```
//!
//! y is a column of the run; y_f the same of a companion with twice the elements (functions, nodes) and a more
//! accurate integration; y_x of one with the exact coupling, the elements of the run and its tolerance. With
//! errors of the mesh that fall like hᵖ the difference y − y_f is (1 − 2⁻ᵖ) of the error of y: S = 2 covers every order
//! p ≥ 1, with half as much again in reserve for p ≥ 2. The factor 1.1 is for what y_x is off itself. Vibration modes converge more slowly than that when the beam
//! rotates fast, and functions other than elements where a section jumps or a load or mass sits within them: S = 4.
//!
//! The errors of the smallest, largest and last value are S times the differences of these values, or of the columns
//! at their times, or a quarter of the largest difference until then, whichever is largest: a difference that passes
//! through zero is no small error. Where the largest difference d of all times is a part of the largest value y of the column, they are
//! d²/(y/10) at least, and d from y/10 on: vibrations that the mesh does not resolve differ in their phases, at any time.
//!
//! Half the step would not serve where vibrations are hardly resolved, for errors do not fall like hᵖ there. So `radau`
//! runs all companions: those of its own runs with a tenth of their tolerance, which makes the error 18 times smaller
//! (h ∼ tol^(1/4), error ∼ h⁵), or 6 times where only the stages' order counts (error ∼ h³), and with steps
//! below 0.9 of its longest, or half where there is no mesh to refine. Those of fixed steps have
//! the tolerances 10⁻⁵, 10⁻⁷ and 10⁻⁹ in turn, until two of them differ by half of what the run differs from the
//! second: a coarse step needs no fine companion, which would follow every wave that the mesh can carry.
//!
//! A run of a mesh with rigid contacts is compared until the first impact of both only: after it another mesh has other masses at its
//! contacts, and between the two impacts one run has struck and the other has not. Bodies without a mesh have the same masses in both.
//!
//! Work is counted in steps times unknowns, not in seconds, so that the same case gives the same files everywhere.
//!
//! An estimate, not a bound: a mesh or a step so coarse that the run and its companion miss the same thing shows
//! nothing.

use super::Run;
use super::difference::{Pair, vanishes};
use crate::kinds::initial::Initial;
use crate::kinds::integrator::Steps;
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::analysis::recording::Watch;
use flexion::contact::Law;
use flexion::system::{Role, State};
use flexion_results::{ColumnError, Errors, Status, Unstable};
use std::ops::ControlFlow;

/// Tolerances of the companions of fixed steps, one after the other.
const LADDER: [f64; 3] = [1e-5, 1e-7, 1e-9];
/// Difference of two companions over that of the run and the second, with which the second is accurate enough: its own
/// error is a thirtieth of the difference or less (100^(3/4), see above).
const SETTLED: f64 = 0.5;
/// Tolerance of a companion over that of a run of `radau`.
pub(super) const FINER: f64 = 0.1;
/// Longest step of a companion over that of the run: with a finer mesh, which most of the difference is of, and without.
const SHORTER: (f64, f64) = (0.9, 0.5);
/// Smallest tolerance that is asked of `radau`.
pub(super) const TIGHTEST: f64 = 1e-13;
/// Largest error of a mesh of elements over its difference from one of twice as many.
pub(crate) const SAFETY: f64 = 2.0;
/// Elements of the companion with the exact coupling where the run has no elements.
const ELEMENTS: usize = 24;
/// The column whose exact value is known: 0, which a method that conserves energy meets better than its companions.
const BALANCE: &str = "energy.balance";
/// Factor on the difference to the exact coupling, for the error of its own run.
const OWN_ERROR: f64 = 1.1;
/// Steps times unknowns of a run beyond which its companions are not run unasked: about a second of computing.
const COSTLY: f64 = 3e6;
/// Evaluations of the residual that a step has: location of impacts takes more, and counts as so many more steps.
const RESIDUALS: f64 = 4.0;
/// Work of all companions beyond which they are given up unasked: over that of the run, and what is always allowed.
const ALLOWANCE: (f64, f64) = (20.0, 2e6);
/// Part of a column that rounding may have taken.
pub(crate) const ROUNDING: f64 = 1e-12;
/// Part of the recording interval in which a record and an impact are at the same time.
const SAME: f64 = 1e-9;

/// How much an estimate of errors may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// A few times the run, decided by counted work; no estimate where it would cost more or cannot be made.
    Auto,
    /// Whatever it takes.
    Full,
}

/// Counts the work of companions, and gives them up when it exceeds what is allowed.
struct Allowance<'a, 'b> {
    watch: &'a mut Watch<'b>,
    left: f64,
}

impl Allowance<'_, '_> {
    fn watch(&mut self, state: &State) -> ControlFlow<()> {
        self.left -= state.v.len() as f64;
        if self.left < 0.0 { ControlFlow::Break(()) } else { (self.watch)(state) }
    }
}

impl Reading {
    /// Runs the companions of a run of this case, and compares. `watch` is shown their progress. With [`Effort::Auto`]
    /// a run whose companions would be costly, or cannot be run, has no estimate, and [`Errors::unknown`] says why.
    ///
    /// # Errors
    /// [`Problems`] when the case cannot be refined: it goes on from the state of an earlier run.
    pub fn estimate_errors(
        &self,
        run: &Run,
        effort: Effort,
        watch: &mut Watch<'_>,
    ) -> Result<Errors, Problems> {
        let steps = (run.counters.steps as f64).max(run.counters.residuals as f64 / RESIDUALS);
        let work = steps * run.size.unknowns as f64;
        if effort == Effort::Auto && work > COSTLY {
            return Ok(Errors::none(format!(
                "the run took {work:.1e} steps times unknowns, and its companions several times as many: `--error full` runs them"
            )));
        }
        if let Initial::Restart(_) = self.case.initial {
            let message = "the error of a run that goes on from a stored state cannot be estimated: the state belongs to \
                           its mesh; estimate it for the whole run";
            return match effort {
                Effort::Auto => Ok(Errors::none(message.to_owned())),
                Effort::Full => Err(self.problem("initial", message)),
            };
        }
        let first = self.case.steps.step().unwrap_or(0.0).max(self.case.output.step);
        if self.before_impacts(run).is_some_and(|end| end < first) {
            return Ok(Errors::none("the first impact comes within the first step or record".to_owned()));
        }
        let allowed = match effort {
            Effort::Auto => (ALLOWANCE.0 * work).max(ALLOWANCE.1),
            Effort::Full => f64::INFINITY,
        };
        let mut allowance = Allowance { watch, left: allowed };
        let errors = self.compare(run, &mut |state| allowance.watch(state));
        let given_up = allowance.left < 0.0;
        let errors = match errors {
            // The case itself is sound: it has run.
            Err(problems) if effort == Effort::Auto => {
                let why = problems.list.first().map_or("", |problem| problem.message.as_str());
                return Ok(Errors::none(format!("there is no finer run: {why}")));
            }
            errors => errors,
        };
        errors.map(|mut errors| {
            if given_up {
                let message =
                    "a companion was given up for the work it takes: `--error full` runs it to its end";
                errors.warnings.insert(0, message.to_owned());
            }
            errors
        })
    }

    fn compare(&self, run: &Run, watch: &mut Watch<'_>) -> Result<Errors, Problems> {
        let mut warnings = Vec::new();
        let until = self.before_impacts(run);
        // The recording interval that is left out is a part of the duration.
        let step = format!("output.step={:e}", self.case.output.step);
        let until_then = |end| self.with(&[format!("run.duration={end:e}"), step]);
        let shortened = until.map(until_then).transpose()?;
        let (finer, fine) = shortened.as_ref().unwrap_or(self).finer_run(run, watch)?;
        // Before the exact companion, which may use up what work is allowed.
        let trust = self.trust(run, watch)?;
        let reach = |run: &Run| run.trajectory.times().last().copied().unwrap_or(0.0);
        warnings.extend(until.map(|_| {
            format!(
                "the errors are those until t = {:.6} s, before the first impact: what an impact on a beam does is a matter of \
                 the mesh",
                reach(&fine)
            )
        }));
        warnings.extend(trust);
        let safety = self.case.hub_beam().map_or(SAFETY, |beam| beam.bases.safety);
        let foreshortened = self.case.hub_beam().is_some_and(|beam| !beam.coupling.whole_curve);
        let exact = match foreshortened.then(|| finer.with_exact_coupling(self, watch)) {
            Some(Ok(mut exact)) => {
                self.cut_at_impact(&mut exact);
                Some(exact)
            }
            Some(Err(problems)) => {
                let why = problems.list.first().map_or("", |problem| problem.message.as_str());
                warnings.push(format!(
                    "the difference to the exact coupling is not known, for there is no run of it: {why}"
                ));
                None
            }
            None => None,
        };
        let unstable = self.instability(run, &fine, safety, watch)?;
        warnings.extend(unstable.as_ref().map(|Unstable { size, column, from, until }| {
            format!(
                "a disturbance of {size:e} of the amplitudes grows from t = {from:.6} s to {until:.6} s to a hundredth of \
                 the motion, first in {column}: the motion is unstable; a small force written into the \
                 case shows where it leads"
            )
        }));
        let exact_run = exact.as_ref().map(|exact| ("exact", exact));
        for (what, companion) in std::iter::once(("finer", &fine)).chain(exact_run) {
            if companion.status != Status::Finished {
                let stopped = format!("it was given up at t = {:.6} s", companion.state.t);
                let failed = companion.message.as_ref().filter(|_| companion.status == Status::Failed);
                let why = failed.unwrap_or(&stopped);
                warnings.push(format!(
                    "the {what} companion of the run did not finish, and errors are known until then only: {why}"
                ));
            }
        }
        let grown = unstable.as_ref().map_or(f64::INFINITY, |unstable| unstable.until);
        let (mut columns, mut trusted) = (Vec::new(), reach(&fine).min(run.state.t).min(grown));
        let mut distrusted = None;
        for name in self::columns(run) {
            let Some(pair) = Pair::new(&run.trajectory, &fine.trajectory, name) else { continue };
            let model = exact.as_ref().and_then(|exact| {
                Pair::new(&fine.trajectory, &exact.trajectory, name).map(|pair| OWN_ERROR * pair.largest())
            });
            let rounding = ROUNDING * pair.size();
            let error = |difference: f64| safety * difference + rounding;
            let [min, max, last] = pair.of_values().map(error);
            let principal = pair.ours.channels()[pair.index].role == Role::Primary;
            if principal && !vanishes(pair.ours, pair.index, self.case.size()) {
                let until = pair.trusted(safety);
                if until < trusted {
                    (trusted, distrusted) = (until, Some(name.to_owned()));
                }
            }
            columns.push(ColumnError {
                column: name.to_owned(),
                min,
                max,
                last,
                discretization: error(pair.largest()),
                model,
            });
        }
        let primary = |error: &&ColumnError| {
            let channels = run.trajectory.channels();
            channels.iter().any(|c| c.name == error.column && c.role == Role::Primary)
        };
        let principal: Vec<&ColumnError> = columns.iter().filter(primary).collect();
        if fine.status == Status::Finished {
            warnings.extend(self.coarse(run, &principal, (&finer, &fine), safety, watch));
        }
        Ok(Errors { columns, warnings, trusted, distrusted, unstable, ..Errors::default() })
    }

    /// The last time recorded before the first impact of a run of a mesh with a rigid contact: after it a run on another mesh says nothing
    /// of the error.
    pub fn before_impacts(&self, run: &Run) -> Option<f64> {
        let step = self.case.output.step;
        let end = (self.first_impact(run)? / step - SAME).floor().max(0.0) * step;
        Some(end).filter(|end| *end < self.case.duration)
    }

    /// The time of the first impact of a run of a mesh with a rigid contact.
    fn first_impact(&self, run: &Run) -> Option<f64> {
        let rigid = |law: &Law| matches!(law, Law::Constraint { .. });
        let planar =
            self.case.hub_beam().into_iter().flat_map(|beam| beam.contacts.iter().map(|of| &of.contact.law));
        let spatial =
            self.case.space().into_iter().flat_map(|space| space.contacts.iter().map(|contact| &contact.law));
        let has_mesh = !self.case.finer().is_empty();
        let first = run.events.list.first().filter(|_| has_mesh && planar.chain(spatial).any(rigid))?;
        Some(first.time)
    }

    /// Leaves out what a companion records from its first impact on.
    pub(super) fn cut_at_impact(&self, companion: &mut Run) {
        if let Some(time) = self.first_impact(companion) {
            companion.trajectory.cut(time);
        }
    }

    /// The refined case and its run: for fixed steps the first of the ladder whose own error does not count beside that
    /// of `run`.
    fn finer_run(&self, run: &Run, watch: &mut Watch<'_>) -> Result<(Reading, Run), Problems> {
        let finer = self.refined(run)?;
        let mut fine = finer.prepare()?.run(watch);
        self.cut_at_impact(&mut fine);
        if self.case.steps.step().is_none() {
            return Ok((finer, fine));
        }
        let mut last = (finer, fine);
        for rung in &LADDER[1..] {
            if last.1.status != Status::Finished {
                break;
            }
            let finer = last.0.with(&[radau(*rung)])?;
            let mut fine = finer.prepare()?.run(watch);
            self.cut_at_impact(&mut fine);
            let settled = settled(run, &last.1, &fine);
            last = (finer, fine);
            if settled {
                break;
            }
        }
        Ok(last)
    }

    /// Runs this refined case with the exact coupling: with the elements of the `coarse` case, or elements of their own
    /// in place of another basis, and its tolerance.
    fn with_exact_coupling(&self, coarse: &Reading, watch: &mut Watch<'_>) -> Result<Run, Problems> {
        let elements = coarse.case.hub_beam().and_then(|beam| beam.bases.elements);
        let elements = elements.map_or(ELEMENTS, |(elements, _)| elements);
        let mut changes = vec![
            "model.coupling=exact".to_owned(),
            format!("basis={{kind='finite-elements',elements={elements}}}"),
        ];
        changes.extend(coarse.tolerances(1.0, 0.0, f64::INFINITY));
        if let (Steps::Controlled { longest: Some(longest), .. }, Steps::Controlled { .. }) =
            (self.case.steps, coarse.case.steps)
        {
            changes.push(format!("integrator.max-step={:e}", longest / SHORTER.0));
        }
        Ok(self.with(&changes)?.prepare()?.run(watch))
    }

    /// The case with twice the functions: of the blade, or else of the bases.
    ///
    /// # Errors
    /// [`Problems`] when there are too many.
    pub fn with_finer_mesh(&self) -> Result<Reading, Problems> {
        let changes = match self.case.hub_beam().and_then(|beam| beam.blade.as_ref()) {
            Some(blade) => vec![format!("blade.elements={}", 2 * blade.elements())],
            None => self.case.finer(),
        };
        self.with(&changes)
    }

    /// The case with twice the functions and a far more accurate integration. Steps of `run` may be as long as they are for
    /// another reason than its tolerance: those of the companion are shorter.
    fn refined(&self, run: &Run) -> Result<Reading, Problems> {
        let mut changes = self.case.finer();
        match self.case.steps {
            Steps::Controlled { .. } => {
                let longest = run.trajectory.index("step.size").map(|i| run.trajectory.extremes(i).max);
                let shorter = if changes.is_empty() { SHORTER.1 } else { SHORTER.0 };
                let longest = longest.filter(|longest| *longest > 0.0).map(|longest| shorter * longest);
                changes.extend(self.tolerances(FINER, TIGHTEST, f64::INFINITY));
                changes.extend(longest.map(|longest| format!("integrator.max-step={longest:e}")));
            }
            Steps::Fixed { .. } => changes.push(radau(LADDER[0])),
        }
        // Shapes are those of the run itself.
        changes.push("output.vtk=false".to_owned());
        self.with(&changes)
    }

    /// The relative tolerance of the case; `None` for fixed steps.
    pub fn tolerance(&self) -> Option<f64> {
        match self.case.steps {
            Steps::Controlled { tolerance, .. } => Some(tolerance),
            Steps::Fixed { .. } => None,
        }
    }

    /// Changes that multiply the tolerances by `factor` and keep them between the bounds; none for fixed steps.
    pub(super) fn tolerances(&self, factor: f64, least: f64, most: f64) -> Vec<String> {
        let Steps::Controlled { tolerance, absolute_tolerance, .. } = self.case.steps else {
            return Vec::new();
        };
        [("tolerance", tolerance), ("absolute-tolerance", absolute_tolerance)]
            .map(|(key, value)| format!("integrator.{key}={:e}", (factor * value).max(least).min(most)))
            .to_vec()
    }
}

/// The change to `radau` with this tolerance.
fn radau(tolerance: f64) -> String {
    format!("integrator={{kind='radau',tolerance={tolerance:e},absolute-tolerance={tolerance:e}}}")
}

/// Whether the errors of all columns of `run` are known from `finer`, which a `coarser` companion confirms.
fn settled<'a>(run: &'a Run, coarser: &'a Run, finer: &'a Run) -> bool {
    finer.status == Status::Finished
        && columns(run).filter(|name| *name != BALANCE).all(|name| {
            let pair = |run: &'a Run| Pair::new(&run.trajectory, &finer.trajectory, name);
            let (Some(ours), Some(theirs)) = (pair(run), pair(coarser)) else { return true };
            theirs.largest() <= SETTLED * ours.largest() + ROUNDING * ours.size()
        })
}

/// The columns whose errors are estimated: all but those about the integrator.
fn columns(run: &Run) -> impl Iterator<Item = &str> {
    run.trajectory.channels().iter().filter(|c| c.role != Role::Integration).map(|c| c.name.as_str())
}
