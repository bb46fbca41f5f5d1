//! Runs.

use super::columns::{self, Described, Extremes};
use super::faults;
use super::figure::Figure;
use super::watch::{Watch, guarded};
use flexion_case::{Calculation, Reading, Request, Stage};
use flexion_results::{Artifact, Directory, Entry, Trajectory};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

/// A run with its errors.
#[pyclass(frozen, module = "flexion._core")]
pub struct Run {
    reading: Arc<Reading>,
    run: flexion_case::Run,
    reached: bool,
    refused: Option<String>,
}

/// Time, contact, what happened; impulse, friction impulse, closing speed, effective mass, energy lost, duration, largest force,
/// largest indentation; place.
type Event = (f64, String, &'static str, [Option<f64>; 8], Option<[f64; 3]>);

impl Run {
    /// Runs a case; beside the run stands what was raised meanwhile.
    pub fn of(
        py: Python<'_>,
        reading: &Arc<Reading>,
        request: &Request,
        mut watch: Watch,
    ) -> PyResult<(Run, Option<PyErr>)> {
        let end = reading.case.duration;
        let (mut last, mut number) = (0.0, 1);
        let mut show = |stage: Stage<'_>| match stage {
            Stage::Search(factor) => watch.show(0.0, || format!("equilibrium: load factor {factor:.3}")),
            Stage::Refined(_) => ControlFlow::Continue(()),
            Stage::Time(t) => {
                // A companion or a refined run begins.
                number += i32::from(t < last);
                last = t;
                watch.show(t / end, || format!("run {number}: t = {t:.3} s"))
            }
        };
        enum Ended {
            Rejected(flexion_case::Problems),
            Refused(flexion_case::RefineError),
        }
        let calculated = guarded(py, || {
            let prepared = reading.prepare_watched(&mut |factor| show(Stage::Search(factor)));
            let prepared = prepared.map_err(Ended::Rejected)?;
            let calculated = reading.calculate(prepared, request, &mut show).map_err(Ended::Refused)?;
            let Calculation { reading: of, run, reached, refused } = calculated;
            let reading = match of {
                std::borrow::Cow::Borrowed(_) => Arc::clone(reading),
                std::borrow::Cow::Owned(refined) => Arc::new(refined),
            };
            Ok(Run { reading, run, reached, refused })
        })?;
        let raised = watch.raised();
        match (calculated, raised) {
            (Ok(run), raised) => Ok((run, raised)),
            (Err(_), Some(raised)) => Err(faults::interrupted(py, raised)),
            (Err(Ended::Rejected(problems)), None) => Err(faults::problems(py, &problems)),
            (Err(Ended::Refused(error)), None) => Err(faults::refine(py, &error)),
        }
    }

    pub fn trajectory(&self) -> &Trajectory {
        &self.run.trajectory
    }
}

#[pymethods]
impl Run {
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        columns::times(py, self.trajectory())
    }

    fn column<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        columns::column(py, self.trajectory(), index)
    }

    fn described(&self) -> Described {
        columns::described(self.trajectory())
    }

    fn extremes(&self, index: usize) -> PyResult<Extremes> {
        columns::extremes(self.trajectory(), index)
    }

    #[getter]
    fn reached(&self) -> bool {
        self.reached
    }

    /// Why a tolerance was not reached, or errors that were asked are not known.
    #[getter]
    fn refused(&self) -> Option<&str> {
        self.refused.as_deref()
    }

    /// `summary.json`.
    fn summary(&self) -> String {
        self.reading.summary(&self.run).to_json()
    }

    /// Status, message and warnings of `summary.json`.
    fn ended(&self) -> (&'static str, Option<String>, Vec<&str>) {
        let run = &self.run;
        let (status, message) = flexion_results::outcome(run.status, run.message.as_deref(), &run.trajectory);
        (status.word(), message, run.all_warnings().collect())
    }

    /// The case, refined where that was asked, without laws of Python.
    fn case(&self, py: Python<'_>) -> PyResult<super::case::Case> {
        let reading = if self.reading.laws().is_empty() {
            Arc::clone(&self.reading)
        } else {
            let without = guarded(py, || self.reading.without_laws())?;
            Arc::new(without.map_err(|problems| faults::problems(py, &problems))?)
        };
        Ok(super::case::Case { reading })
    }

    fn events(&self) -> Vec<Event> {
        let events = &self.run.events;
        let event = |e: &Entry| {
            let numbers =
                [e.impulse, e.friction, e.speed, e.mass, e.lost, e.duration, e.force, e.indentation];
            (e.time, events.name(e.contact).to_owned(), e.what, numbers, e.place.map(|place| place.0))
        };
        events.list.iter().map(event).collect()
    }

    fn figure(&self) -> Figure {
        Figure(self.reading.figure(&self.run))
    }

    /// Writes the files that the program writes.
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool) -> PyResult<()> {
        let written = guarded(py, || {
            let inputs = self.reading.inputs();
            let directory = Directory::create_for(Artifact::RUN, &path, force, &inputs)?;
            self.reading.write(&self.run, &directory)
        })?;
        written.map(drop).map_err(|error| faults::output(&error))
    }

    /// The page that plays it.
    fn page(&self, py: Python<'_>, columns: Vec<String>) -> PyResult<String> {
        let folder = tempfile::tempdir()?;
        self.save(py, folder.path().join("run"), false)?;
        let page = guarded(py, || flexion_results::view_page(&folder.path().join("run"), &columns))?;
        page.map_err(|error| faults::results(py, &error))
    }
}
