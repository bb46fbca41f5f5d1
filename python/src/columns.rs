//! Recorded columns, of a run in memory or of one that was read from its files.

use super::faults;
use super::figure::Figure;
use super::run::Run;
use flexion::system::Channel;
use flexion_results::plot;
use flexion_results::{Comparison, Results, Trajectory};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyTypeError};
use pyo3::prelude::*;
use std::path::PathBuf;

/// Name, unit, role and kind of each column.
pub type Described = Vec<(String, String, &'static str, &'static str)>;

/// Smallest value and its time, largest value and its time, last value.
pub type Extremes = (f64, f64, f64, f64, f64);

/// A column as an array that cannot be written to.
pub fn array<'py>(
    py: Python<'py>,
    values: impl ExactSizeIterator<Item = f64>,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let array = PyArray1::from_vec(py, values.collect());
    array.readwrite().make_nonwriteable();
    Ok(array)
}

pub fn times<'py>(py: Python<'py>, trajectory: &Trajectory) -> PyResult<Bound<'py, PyArray1<f64>>> {
    array(py, trajectory.times().iter().copied())
}

pub fn column<'py>(
    py: Python<'py>,
    trajectory: &Trajectory,
    index: usize,
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    if index >= trajectory.channels().len() {
        return Err(PyIndexError::new_err("there is no such column"));
    }
    array(py, trajectory.values(index).collect::<Vec<_>>().into_iter())
}

pub fn described(trajectory: &Trajectory) -> Described {
    let of = |c: &Channel| (c.name.clone(), c.unit.to_string(), c.role.name(), c.kind.name());
    trajectory.channels().iter().map(of).collect()
}

pub fn extremes(trajectory: &Trajectory, index: usize) -> PyResult<Extremes> {
    if index >= trajectory.channels().len() {
        return Err(PyIndexError::new_err("there is no such column"));
    }
    let e = trajectory.extremes(index);
    Ok((e.min, e.t_min, e.max, e.t_max, e.last))
}

/// The columns of a run that was read from its files.
#[pyclass(frozen, module = "flexion._core")]
pub struct Stored {
    results: Results,
}

#[pymethods]
impl Stored {
    #[new]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Stored> {
        let results = super::watch::guarded(py, || Results::read(&path))?;
        Ok(Stored { results: results.map_err(|error| faults::results(py, &error))? })
    }

    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        times(py, &self.results.trajectory)
    }

    fn column<'py>(&self, py: Python<'py>, index: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        column(py, &self.results.trajectory, index)
    }

    fn described(&self) -> Described {
        described(&self.results.trajectory)
    }

    fn extremes(&self, index: usize) -> PyResult<Extremes> {
        extremes(&self.results.trajectory, index)
    }

    #[getter]
    fn caution(&self) -> Option<&str> {
        self.results.caution.as_deref()
    }
}

/// The columns of either.
fn with<T>(given: &Bound<'_, PyAny>, use_it: impl FnOnce(&Trajectory) -> T) -> PyResult<T> {
    if let Ok(run) = given.cast::<Run>() {
        return Ok(use_it(run.get().trajectory()));
    }
    let stored = given.cast::<Stored>().map_err(|_| PyTypeError::new_err("a run is needed"))?;
    Ok(use_it(&stored.get().results.trajectory))
}

fn results(name: &str, given: &Bound<'_, PyAny>) -> PyResult<Results> {
    let trajectory = with(given, Trajectory::clone)?;
    Ok(Results { name: name.to_owned(), path: PathBuf::from(name), trajectory, caution: None })
}

/// Runs in one figure.
#[pyfunction]
pub fn runs_figure(
    py: Python<'_>,
    runs: Vec<(String, Bound<'_, PyAny>)>,
    columns: Vec<String>,
    title: Option<String>,
) -> PyResult<Figure> {
    let runs: Vec<Results> = runs.iter().map(|(name, of)| results(name, of)).collect::<PyResult<_>>()?;
    let named: Vec<(&str, &Trajectory)> = runs.iter().map(|r| (r.name.as_str(), &r.trajectory)).collect();
    let figure = plot::runs_figure(&named, &columns, title.as_deref());
    Ok(Figure(figure.map_err(|error| faults::results(py, &error))?))
}

/// How far the second run is from the first, as JSON, and as a figure.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    first: (String, Bound<'_, PyAny>),
    second: (String, Bound<'_, PyAny>),
    patterns: Vec<String>,
) -> PyResult<(String, Figure)> {
    let runs = [results(&first.0, &first.1)?, results(&second.0, &second.1)?];
    let compared = Comparison::of(&runs[0], &runs[1], &patterns);
    let compared = [compared.map_err(|error| faults::results(py, &error))?];
    let figure = plot::difference_figure(&runs, &compared, &compared[0].drawn(!patterns.is_empty()), None);
    Ok((flexion_results::compare_json(&compared, None), Figure(figure)))
}
