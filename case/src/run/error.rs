//! The error of a run, from companions that are run more finely.
//!
//! ```text
//! discretization = S max_t |y(t) − y_f(t)| + 10⁻¹² max_t |y_f(t)|
//! model          = max_t |y_f(t) − y_x(t)| + max_t |y_x(t) − y_c(t)|
//! ```
//!
//! y is a column of the run; y_f the same of a companion with twice the elements (functions, nodes) and a more
//! accurate integration; y_x of one that has the exact coupling as well, y_c of a third with half the elements of it
//! and a less accurate integration: y_x − y_c covers the error of y_x, which need not be less than that of y_f. With
//! errors of the mesh that fall like hᵖ the difference y − y_f is (1 − 2⁻ᵖ) of the error of y: S = 2 covers every order
//! p ≥ 1, with half as much again in reserve for p ≥ 2. Vibration modes converge more slowly than that when the beam
//! rotates fast: S = 4.
//!
//! Half the step would not serve where vibrations are hardly resolved, for errors do not fall like hᵖ there. So `radau`
//! runs all companions: those of its own runs with a tenth of their tolerance, which makes the error 18 times smaller
//! (h ∼ tol^(1/4), error ∼ h⁵), or 6 times where only the stages' order counts (error ∼ h³). Those of fixed steps have
//! the tolerances 10⁻⁵, 10⁻⁷ and 10⁻⁹ in turn, until two of them differ by half of what the run differs from the
//! second: a coarse step needs no fine companion, which would follow every wave that the mesh can carry.
//!
//! A run with rigid contacts is compared until its first impact only: behind it another mesh has other masses at its contacts.
//!
//! An estimate, not a bound: a mesh or a step so coarse that the run and its companion miss the same thing shows
//! nothing.

use super::Run;
use super::errors::{ColumnError, Errors};
use crate::kinds::contact::Contact;
use crate::kinds::initial::Initial;
use crate::kinds::integrator::Steps;
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::contact::Law;
use flexion_results::{Status, Trajectory, Watch};

/// Tolerances of the companions of fixed steps, one after the other.
const LADDER: [f64; 3] = [1e-5, 1e-7, 1e-9];
/// Difference of two companions over that of the run and the second, with which the second is accurate enough: its own
/// error is a thirtieth of the difference or less (100^(3/4), see above).
const SETTLED: f64 = 0.5;
/// Tolerance of a companion over that of a run of `radau`.
const FINER: f64 = 0.1;
/// Smallest and largest tolerance that is asked of `radau`.
const TIGHTEST: f64 = 1e-13;
const LOOSEST: f64 = 0.01;
/// Elements of the companion with the exact coupling where the run has no elements.
const ELEMENTS: usize = 24;
/// The column whose exact value is known: 0, which a method that conserves energy meets better than its companions.
const BALANCE: &str = "energy.balance";
/// Part of a column that rounding may have taken.
const ROUNDING: f64 = 1e-12;

impl Reading {
    /// Runs the companions of a run of this case, and compares. `watch` is shown their progress.
    ///
    /// # Errors
    /// [`Problems`] when the case cannot be refined: it goes on from the state of an earlier run.
    pub fn estimate_errors(&self, run: &Run, watch: &mut Watch<'_>) -> Result<Errors, Problems> {
        if let Initial::Restart(_) = self.case.initial {
            let message = "the error of a run that goes on from a stored state cannot be estimated: the state belongs to \
                           its mesh; estimate it for the whole run";
            return Err(self.problem("initial", message));
        }
        let mut warnings = Vec::new();
        let until = self.before_impacts(run);
        // The recording interval that is left out is a part of the duration.
        let step = format!("output.step={:e}", self.case.output.step);
        let until_then = |end| self.with(&[format!("run.duration={end:e}"), step]);
        let shortened = until.map(until_then).transpose()?;
        let (finer, fine) = shortened.as_ref().unwrap_or(self).finer_run(run, watch)?;
        warnings.extend(until.map(|end| {
            format!(
                "the errors are those until t = {end} s, before the first impact: what an impact on a beam does is a matter of \
                 the mesh"
            )
        }));
        let exact = match (!self.case.coupling.whole_curve).then(|| finer.with_exact_coupling(watch)) {
            Some(Ok(exact)) => Some(exact),
            Some(Err(problems)) => {
                let why = problems.list.first().map_or("", |problem| problem.message.as_str());
                warnings.push(format!(
                    "the difference to the exact coupling is not known, for there is no run of it: {why}"
                ));
                None
            }
            None => None,
        };
        let runs = exact.as_ref().map(|(exact, coarse)| [("exact", exact), ("coarser exact", coarse)]);
        for (what, companion) in std::iter::once(("finer", &fine)).chain(runs.into_iter().flatten()) {
            if companion.status != Status::Finished {
                let why = companion.message.as_deref().unwrap_or("it was stopped");
                warnings.push(format!(
                    "the {what} companion of the run did not finish, and errors are known until then only: {why}"
                ));
            }
        }
        warnings.extend(self.trust(run, watch)?);
        let safety = self.case.bases.safety;
        let mut columns = Vec::new();
        for name in self::columns(run) {
            let apart = |a: &Trajectory, b: &Trajectory| largest_difference(a, b, name);
            let Some((difference, size)) = apart(&run.trajectory, &fine.trajectory) else { continue };
            let model = exact.as_ref().and_then(|(exact, coarse)| {
                let (difference, _) = apart(&fine.trajectory, &exact.trajectory)?;
                let (own, _) = apart(&exact.trajectory, &coarse.trajectory)?;
                Some(difference + own)
            });
            columns.push(ColumnError {
                column: name.to_owned(),
                discretization: safety * difference + ROUNDING * size,
                model,
            });
        }
        Ok(Errors { columns, warnings })
    }

    /// The last time recorded before the first impact of a run with a rigid contact; behind it a run on another mesh says
    /// nothing of the error.
    fn before_impacts(&self, run: &Run) -> Option<f64> {
        let rigid = |contact: &Contact| matches!(contact.law, Law::Constraint { .. });
        let first = run.events.list.first().filter(|_| self.case.contacts.iter().any(rigid))?;
        let step = self.case.output.step;
        Some((first.time / step).floor().max(1.0) * step).filter(|end| *end < self.case.duration)
    }

    /// The refined case and its run: for fixed steps the first of the ladder whose own error does not count beside that
    /// of `run`.
    fn finer_run(&self, run: &Run, watch: &mut Watch<'_>) -> Result<(Reading, Run), Problems> {
        let finer = self.refined()?;
        let fine = finer.prepare()?.run(watch);
        if self.case.steps.step().is_none() {
            return Ok((finer, fine));
        }
        let mut last = (finer, fine);
        for rung in &LADDER[1..] {
            if last.1.status != Status::Finished {
                break;
            }
            let finer = last.0.with(&[radau(*rung)])?;
            let fine = finer.prepare()?.run(watch);
            let settled = settled(run, &last.1, &fine);
            last = (finer, fine);
            if settled {
                break;
            }
        }
        Ok(last)
    }

    /// Runs this refined case with the exact coupling: with its own elements, or elements of their own in place of
    /// another basis, and with half as many and less accurate steps.
    fn with_exact_coupling(&self, watch: &mut Watch<'_>) -> Result<(Run, Run), Problems> {
        let elements = self.case.bases.elements.map_or(ELEMENTS, |(elements, _)| elements);
        let mut run = |elements: usize, factor: f64| {
            let mut changes = vec![
                "model.coupling=exact".to_owned(),
                format!("basis={{kind='finite-elements',elements={elements}}}"),
            ];
            changes.extend(self.tolerances(factor, 0.0, LOOSEST));
            Ok(self.with(&changes)?.prepare()?.run(watch))
        };
        Ok((run(elements, 1.0)?, run(elements / 2, 1.0 / FINER)?))
    }

    /// The case with twice the functions and a far more accurate integration.
    fn refined(&self) -> Result<Reading, Problems> {
        let finer = &self.case.bases.finer;
        let mut changes: Vec<String> =
            finer.iter().map(|(key, value)| format!("basis.{key}={value}")).collect();
        match self.case.steps {
            Steps::Controlled { .. } => changes.extend(self.tolerances(FINER, TIGHTEST, f64::INFINITY)),
            Steps::Fixed { .. } => changes.push(radau(LADDER[0])),
        }
        // Shapes are those of the run itself.
        changes.push("output.vtk=false".to_owned());
        self.with(&changes)
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
fn settled(run: &Run, coarser: &Run, finer: &Run) -> bool {
    finer.status == Status::Finished
        && columns(run).filter(|name| *name != BALANCE).all(|name| {
            let apart = |run: &Run| largest_difference(&run.trajectory, &finer.trajectory, name);
            let (Some((error, size)), Some((own, _))) = (apart(run), apart(coarser)) else { return true };
            own <= SETTLED * error + ROUNDING * size
        })
}

/// The columns whose errors are estimated: all but those about the integrator.
fn columns(run: &Run) -> impl Iterator<Item = &str> {
    run.trajectory.channels().iter().map(|c| c.name.as_str()).filter(|name| !name.starts_with("step."))
}

/// Largest difference of a column over the common rows, and the largest value of the second.
fn largest_difference(a: &Trajectory, b: &Trajectory, column: &str) -> Option<(f64, f64)> {
    let pairs = a.values(a.index(column)?).zip(b.values(b.index(column)?));
    let mut largest = (0.0_f64, 0.0_f64);
    for (x, y) in pairs {
        // NaN is not hidden, neither here nor by a later row.
        let difference = (x - y).abs();
        if !(difference <= largest.0 || largest.0.is_nan()) {
            largest.0 = difference;
        }
        largest.1 = largest.1.max(y.abs());
    }
    Some(largest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexion::system::Channel;

    fn column(values: [f64; 3]) -> Trajectory {
        let mut out = Trajectory::new(vec![Channel { name: "y".into(), unit: "m", ..Channel::default() }]);
        for (i, value) in values.into_iter().enumerate() {
            out.push(i as f64, |row| row[0] = value);
        }
        out
    }

    #[test]
    fn a_difference_that_is_no_number_is_reported_whatever_follows_it() {
        let (a, b) = (column([0.0, f64::NAN, 3.0]), column([0.0, 1.0, 2.0]));
        assert!(largest_difference(&a, &b, "y").unwrap().0.is_nan());
        assert_eq!(largest_difference(&b, &column([0.0, 0.5, 2.25]), "y"), Some((0.5, 2.25)));
    }
}
