//! The error of a run, from companions that are run more finely.
//!
//! ```text
//! discretization = S max_t |y(t) − y_f(t)| + 10⁻¹² max_t |y_f(t)|,    model = max_t |y_f(t) − y_x(t)|
//! ```
//!
//! y is a column of the run; y_f the same of a companion with twice the elements (functions, nodes) and a far more
//! accurate integration; y_x of one that has the exact coupling as well. With errors of the mesh that fall like hᵖ the
//! difference y − y_f is (1 − 2⁻ᵖ) of the error of y: S = 2 covers every order p ≥ 1, with half as much again in reserve
//! for p ≥ 2. Vibration modes converge more slowly than that when the beam turns fast: S = 4. Half the step would not
//! serve where vibrations are hardly resolved, for errors do not fall like hᵖ there: the companions of all fixed steps
//! are integrated by `radau`, those of `radau` with a hundredth of its tolerance.
//!
//! An estimate, not a bound: a mesh or a step so coarse that the run and its companion miss the same thing shows
//! nothing.

use super::{Basis, Coupling, Initial, Integrator, Problems, Reading, Run};
use crate::output::{Status, Trajectory, Watch};

/// Tolerance of the companions of fixed steps.
const TIGHT: f64 = 1e-9;
/// Smallest tolerance that is asked of `radau`.
const TIGHTEST: f64 = 1e-13;
/// Elements of the companion with the exact coupling where the run has no elements.
const ELEMENTS: usize = 24;
/// Safety factors S.
const SAFETY: f64 = 2.0;
const SAFETY_OF_MODES: f64 = 4.0;
/// Part of a column that rounding may have taken.
const ROUNDING: f64 = 1e-12;

/// Estimated error of one column, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnError {
    /// Name of the column.
    pub column: String,
    /// Error of mesh and time integration.
    pub discretization: f64,
    /// Difference to the exact coupling, where there is one.
    pub model: Option<f64>,
}

/// Estimated errors of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Errors {
    /// One entry for each column but those that tell of the integrator.
    pub columns: Vec<ColumnError>,
    /// What could not be estimated, and why.
    pub warnings: Vec<String>,
}

impl Reading {
    /// Runs the companions of a run of this case, and compares. `watch` is shown their progress.
    ///
    /// # Errors
    /// [`Problems`] when the case cannot be refined: it goes on from the state of an earlier run.
    pub fn estimate_errors(&self, run: &Run, watch: &mut Watch<'_>) -> Result<Errors, Problems> {
        if let Initial::Restart { .. } = self.case.initial {
            let message = "the error of a run that goes on from a stored state cannot be estimated: the state belongs to \
                           its mesh; estimate it for the whole run";
            return Err(self.problem("initial", message));
        }
        let mut warnings = Vec::new();
        let finer = self.refined();
        let fine = finer.prepare()?.run(watch);
        let mut exact = None;
        let is_elements = |basis: &Basis| matches!(basis, Basis::FiniteElements { .. });
        let case = &self.case;
        if case.coupling != Coupling::Exact {
            let mut reading = finer.clone();
            reading.case.coupling = Coupling::Exact;
            let bases = &mut reading.case.bases;
            if !(is_elements(&bases.axial) && bases.axial == bases.transverse) {
                // The exact coupling has a mesh of its own; its error is then part of the difference.
                let elements = Basis::FiniteElements { elements: ELEMENTS, axial_degree: 1 };
                (bases.axial, bases.transverse) = (elements.clone(), elements);
            }
            exact = Some(reading.prepare()?.run(watch));
        }
        for (what, companion) in [("finer", Some(&fine)), ("exact", exact.as_ref())] {
            if let Some(message) = companion.filter(|c| c.status != Status::Finished).map(|c| &c.message) {
                let why = message.as_deref().unwrap_or("it was stopped");
                warnings.push(format!("the {what} companion of the run did not finish, and errors are known until then only: {why}"));
            }
        }
        let safety = if [&case.bases.axial, &case.bases.transverse]
            .iter()
            .any(|basis| matches!(basis, Basis::Modes { .. }))
        {
            SAFETY_OF_MODES
        } else {
            SAFETY
        };
        let mut columns = Vec::new();
        for channel in run.trajectory.channels().iter().filter(|c| !c.name.starts_with("step.")) {
            let apart = |a: &Trajectory, b: &Trajectory| largest_difference(a, b, &channel.name);
            let Some((difference, size)) = apart(&run.trajectory, &fine.trajectory) else { continue };
            let model = exact.as_ref().and_then(|exact| apart(&fine.trajectory, &exact.trajectory));
            columns.push(ColumnError {
                column: channel.name.clone(),
                discretization: safety * difference + ROUNDING * size,
                model: model.map(|(difference, _)| difference),
            });
        }
        Ok(Errors { columns, warnings })
    }

    /// The case with twice the functions and a far more accurate integration.
    fn refined(&self) -> Reading {
        let mut finer = self.clone();
        let case = &mut finer.case;
        for basis in [&mut case.bases.axial, &mut case.bases.transverse] {
            match basis {
                Basis::FiniteElements { elements, .. }
                | Basis::BSpline { elements, .. }
                | Basis::Bezier { elements, .. } => *elements *= 2,
                Basis::Modes { count } => *count *= 2,
                Basis::Radial(radial) => radial.nodes = 2 * radial.nodes - 1,
                Basis::Polynomial { nodes, .. } => *nodes = 2 * *nodes - 1,
            }
        }
        match &mut case.integrator {
            Integrator::Radau { tolerance, absolute_tolerance, .. } => {
                *tolerance = (0.01 * *tolerance).max(TIGHTEST);
                *absolute_tolerance = (0.01 * *absolute_tolerance).max(TIGHTEST);
            }
            fixed => {
                *fixed = Integrator::Radau {
                    tolerance: TIGHT,
                    absolute_tolerance: TIGHT,
                    initial_step: None,
                    max_step: None,
                };
            }
        }
        // Shapes are those of the run itself.
        case.output.vtk = None;
        finer
    }
}

/// Largest difference of a column over the common rows, and the largest value of the second.
fn largest_difference(a: &Trajectory, b: &Trajectory, column: &str) -> Option<(f64, f64)> {
    let pairs = a.values(a.index(column)?).zip(b.values(b.index(column)?));
    let mut largest = (0.0_f64, 0.0_f64);
    for (x, y) in pairs {
        // NaN is not hidden.
        let difference = (x - y).abs();
        if !(difference <= largest.0) {
            largest.0 = difference;
        }
        largest.1 = largest.1.max(y.abs());
    }
    Some(largest)
}
