//! Sweeps of parameters.

use super::case::Case;
use super::faults;
use super::watch::{Watch, guarded};
use flexion_case::sweep::{self, Data, Errors, How, Inputs, Method, Options, Sample, Shard, Stop, Table};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A case and the values of its inputs, read and checked.
#[pyclass(frozen, module = "flexion._core")]
pub struct Sweep {
    sweep: sweep::Sweep,
}

/// Rows that are kept, rows of the shard, rows that did not finish, rows with estimated errors, worst relative error, why it stopped.
type Outcome = (usize, usize, usize, usize, Option<f64>, Option<String>);

fn errors_of(name: &str) -> PyResult<Errors> {
    let all = [Errors::Each, Errors::Sample, Errors::None];
    let found = all.into_iter().find(|of| of.name() == name);
    found.ok_or_else(|| PyValueError::new_err(format!("errors: `{name}` is none of each, sample, none")))
}

#[pymethods]
impl Sweep {
    #[new]
    fn new(
        py: Python<'_>,
        case: &Case,
        vary: Vec<String>,
        table: Option<(String, String)>,
        sample: Option<(String, usize, u64)>,
        quantities: Vec<String>,
        errors: &str,
        limit: Option<u64>,
        part: Option<usize>,
    ) -> PyResult<Sweep> {
        let options = Options { errors: errors_of(errors)?, limit, part };
        let sample = sample.map(|(method, runs, seed)| {
            let none = || PyValueError::new_err(format!("sample: `{method}` is none of lhs, sobol"));
            PyResult::Ok(Sample { method: Method::of(&method).ok_or_else(none)?, runs, seed })
        });
        let sample = sample.transpose()?;
        let reading = case.reading.as_ref().clone();
        let made = guarded(py, || {
            let table = table.map(|(name, text)| Table::parse(&name, &text)).transpose()?;
            sweep::Sweep::new(reading, Inputs { vary, table, sample }, &quantities, options)
        })?;
        Ok(Sweep { sweep: made.map_err(|error| faults::sweep(py, &error))? })
    }

    #[getter]
    fn rows(&self) -> usize {
        self.sweep.rows()
    }

    #[getter]
    fn parts(&self) -> usize {
        self.sweep.parts()
    }

    #[getter]
    fn seed(&self) -> Option<u64> {
        self.sweep.seed()
    }

    /// Makes a folder one of this sweep.
    fn open(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        let opened = guarded(py, || self.sweep.open(&folder))?;
        opened.map_err(|error| faults::sweep(py, &error))
    }

    /// Numbers of the parts that a folder holds.
    fn kept_parts(&self, py: Python<'_>, folder: PathBuf) -> PyResult<Vec<usize>> {
        guarded(py, || self.sweep.kept_parts(&folder))
    }

    /// Whether so many of the rows that a folder holds failed that the sweep stops.
    fn fails(&self, py: Python<'_>, folder: PathBuf) -> PyResult<bool> {
        guarded(py, || self.sweep.fails(&folder))
    }

    /// Computes what a folder lacks, all of it or a part; beside what became of it stands what was raised meanwhile.
    fn run(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        threads: usize,
        part: Option<usize>,
        keep_going: bool,
        notify: Option<Py<PyAny>>,
    ) -> PyResult<(Outcome, Option<PyErr>)> {
        let shard =
            part.map_or(How::default().shard, |part| Shard { number: part + 1, of: self.sweep.parts() });
        let how = How { threads, shard, keep_going };
        let (watch, done) = (Mutex::new(Watch::new(notify)), AtomicUsize::new(0));
        let all = self.sweep.rows();
        let look = || {
            // What another thread asks at this moment holds for this one too.
            let Ok(mut watch) = watch.try_lock() else { return ControlFlow::Continue(()) };
            let done = done.load(Ordering::Relaxed);
            watch.show(done as f64 / all as f64, || format!("{done} of {all} rows"))
        };
        let swept = guarded(py, || {
            self.sweep
                .run_all(&folder, &how, &look, &|progress| done.store(progress.rows.0, Ordering::Relaxed))
        })?;
        let raised = watch.into_inner().ok().and_then(|mut watch| watch.raised());
        let swept = match (swept, raised) {
            (Ok(swept), raised) => (swept, raised),
            (Err(_), Some(raised)) => return Err(faults::interrupted(py, raised)),
            (Err(error), None) => return Err(faults::sweep(py, &error)),
        };
        let (swept, raised) = swept;
        let totals = &swept.totals;
        let stop = swept.stop.map(|stop| match stop {
            Stop::Asked => "stopped by the user: the same call goes on with the rows that are missing".to_owned(),
            Stop::Failures { failures, rows } => format!(
                "{failures} of the first {rows} rows did not finish, which is more than a tenth: look at their `reason`, or \
                 set keep_going"
            ),
        });
        let counts = (totals.rows, swept.rows, totals.failures(), totals.estimated, totals.worst(), stop);
        Ok((counts, raised))
    }

    /// The rows that a folder holds, as columns by name.
    fn columns<'py>(&self, py: Python<'py>, folder: PathBuf) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let columns = guarded(py, || self.sweep.table(&self.sweep.kept(&folder)))?;
        let python = |(name, data): (String, Data)| {
            let values = match data {
                Data::Whole(values) => values.into_pyobject(py)?.into_any(),
                Data::Numbers(values) => values.into_pyobject(py)?.into_any(),
                Data::Texts(values) => values.into_pyobject(py)?.into_any(),
                Data::Booleans(values) => values.into_pyobject(py)?.into_any(),
            };
            Ok((name, values))
        };
        columns.into_iter().map(python).collect()
    }
}

/// The text of a value in a list of a sweep.
#[pyfunction]
pub fn item(given: &Bound<'_, PyAny>) -> PyResult<String> {
    Ok(super::value::value(given, "a value of a sweep", 0)?.to_string())
}
