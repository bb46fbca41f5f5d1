//! Equilibria under growing loads.

use super::columns::{self, Described};
use super::faults;
use super::figure::Figure;
use super::watch::{Watch, guarded};
use flexion::analysis::path::Plan;
use flexion_case::{Effort, Reading, StaticsError, StaticsRequest};
use flexion_results::plot::statics_figure;
use flexion_results::{Artifact, Directory, write_statics};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A path of equilibria.
#[pyclass(frozen, module = "flexion._core")]
pub struct LoadPath {
    reading: Arc<Reading>,
    path: flexion_results::LoadPath,
}

/// Load factor, what it is if it is critical, its stability in words, whether it is stable, errors of the factor and of the columns.
type Point = (f64, Option<&'static str>, String, Option<bool>, Option<(f64, Vec<f64>)>);

impl LoadPath {
    /// Follows a path; beside it stands what was raised meanwhile.
    pub fn of(
        py: Python<'_>,
        reading: &Arc<Reading>,
        (to, step, points): (f64, f64, usize),
        effort: Option<Effort>,
        mut watch: Watch,
    ) -> PyResult<(LoadPath, Option<PyErr>)> {
        let request = StaticsRequest { plan: Plan { points, longest: step, ..Plan::to(to) }, effort };
        let mut show = |points: usize, factor: f64| {
            let text = || format!("{points} equilibria, load factor {factor:.4}");
            watch.show((factor / to).clamp(0.0, 1.0), text).is_continue()
        };
        let path = guarded(py, || reading.statics(&request, &mut show))?;
        match (path, watch.raised()) {
            (Ok(path), raised) => Ok((LoadPath { reading: Arc::clone(reading), path }, raised)),
            (Err(_), Some(raised)) => Err(faults::interrupted(py, raised)),
            (Err(StaticsError::Case(problems)), None) => Err(faults::problems(py, &problems)),
            (Err(error), None) => Err(faults::analysis(py, &error.to_string())),
        }
    }
}

#[pymethods]
impl LoadPath {
    fn described(&self) -> Described {
        let of =
            |c: &flexion::system::Channel| (c.name.clone(), c.unit.to_string(), c.role.name(), c.kind.name());
        self.path.channels.iter().map(of).collect()
    }

    fn column<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = self.path.points.iter().map(|point| point.values.get(index).copied());
        let values: Option<Vec<f64>> = values.collect();
        let values =
            values.ok_or_else(|| pyo3::exceptions::PyIndexError::new_err("there is no such column"))?;
        columns::array(py, values.into_iter())
    }

    fn points(&self) -> Vec<Point> {
        let points = self.path.points.iter().map(|point| {
            let stability = point.stability.map_or_else(|| "unknown".to_owned(), |found| found.to_string());
            let error = point.error.as_ref().map(|error| (error.factor, error.values.clone()));
            let critical = point.critical.map(|critical| critical.name());
            (point.factor, critical, stability, point.stability.map(|found| found.is_stable()), error)
        });
        points.collect()
    }

    /// Why it ends early, if it does.
    #[getter]
    fn end(&self) -> Option<&str> {
        self.path.end.as_deref()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.path.cautions.clone()
    }

    fn figure(&self) -> Figure {
        Figure(statics_figure(&self.path, self.reading.title()))
    }

    fn save(&self, py: Python<'_>, path: PathBuf, force: bool) -> PyResult<()> {
        let written = guarded(py, || {
            let directory = Directory::create_for(Artifact::STATICS, &path, force, &self.reading.inputs())?;
            let title = self.reading.title();
            write_statics(&directory, &self.path, &self.reading.resolved(), title, &self.path.cautions)
        })?;
        written.map_err(|error| faults::output(&error))
    }
}
