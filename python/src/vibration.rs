//! Modes and Campbell diagrams.

use super::figure::Figure;
use super::watch::{Watch, guarded, interruptible};
use super::{columns, faults};
use flexion::analysis::modes::Mode;
use flexion_case::{DiagramRequest, FoundModes, ModesRequest, Reading, moves};
use flexion_results::plot::{campbell_figure, modes_figure};
use flexion_results::{Artifact, Directory, Frequencies, Units};
use numpy::{Complex64, PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

/// Units of speeds and frequencies in texts, figures and files: rad/s, Hz, or rpm with Hz.
pub fn units(name: &str) -> PyResult<Units> {
    let (speed, frequency) = match name {
        "rad/s" => (Frequencies::RADIANS, Frequencies::RADIANS),
        "Hz" => (Frequencies::HERTZ, Frequencies::HERTZ),
        "rpm" => (Frequencies::RPM, Frequencies::HERTZ),
        other => return Err(PyValueError::new_err(format!("unit: `{other}` is none of rad/s, Hz, rpm"))),
    };
    Ok(Units { speed, frequency })
}

/// Eigenvalue, error of the frequency by the mesh, number of nodes, residual, what it moves in words, in axes of the section too.
type Row = (Complex64, Option<f64>, usize, f64, String, String);

fn row(mode: &Mode) -> Row {
    let shares = &mode.shares;
    let words = (moves(&shares.named()), moves(&shares.in_section()));
    (mode.eigenvalue, mode.mesh, mode.nodes, mode.residual, words.0, words.1)
}

/// Modes at one speed.
#[pyclass(frozen, module = "flexion._core")]
pub struct Modes {
    reading: Arc<Reading>,
    found: FoundModes,
}

impl Modes {
    pub fn of(
        py: Python<'_>,
        reading: &Arc<Reading>,
        speed: f64,
        count: usize,
        free_hub: bool,
        units: Units,
    ) -> PyResult<Modes> {
        let request = ModesRequest { speed, count, free_hub, units, film: false };
        let shared = Arc::clone(reading);
        let found = interruptible(py, move || shared.modes(&request))?;
        let found = found.map_err(|error| faults::vibration(py, &error))?;
        Ok(Modes { reading: Arc::clone(reading), found })
    }
}

#[pymethods]
impl Modes {
    fn rows(&self) -> Vec<Row> {
        self.found.modes.modes.iter().map(row).collect()
    }

    /// Decay rates of overdamped motions [1/s].
    fn overdamped(&self) -> Vec<f64> {
        self.found.modes.overdamped.iter().map(|mode| -mode.eigenvalue.re).collect()
    }

    fn stations<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        columns::array(py, self.found.stations.iter().copied())
    }

    /// Displacements along the three axes and rotation about the beam, a row for each station.
    fn shape<'py>(&self, py: Python<'py>, mode: usize) -> PyResult<Bound<'py, PyArray2<Complex64>>> {
        let mode = self.found.modes.modes.get(mode);
        let mode = mode.ok_or_else(|| pyo3::exceptions::PyIndexError::new_err("there is no such mode"))?;
        let rows: Vec<Vec<Complex64>> = mode.shape.movement.iter().map(|row| row.to_vec()).collect();
        let array = PyArray2::from_vec2(py, &rows)?;
        array.readwrite().make_nonwriteable();
        Ok(array)
    }

    #[getter]
    fn about(&self) -> &str {
        &self.found.about
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.found.warnings.clone()
    }

    fn figure(&self) -> Figure {
        let FoundModes { modes, stations, axes, request, .. } = &self.found;
        Figure(modes_figure(modes, (stations, *axes), &request.units.frequency, self.reading.title()))
    }

    fn save(&self, py: Python<'_>, path: PathBuf, force: bool) -> PyResult<()> {
        let written = guarded(py, || {
            let directory = Directory::create_for(Artifact::MODES, &path, force, &self.reading.inputs())?;
            self.reading.write_modes(&self.found, self.reading.title(), &directory)
        })?;
        written.map_err(|error| faults::output(&error))
    }
}

/// Modes over speeds.
#[pyclass(frozen, module = "flexion._core")]
pub struct Diagram {
    reading: Arc<Reading>,
    found: flexion_case::Diagram,
}

impl Diagram {
    /// Computes a diagram; beside it stands what was raised meanwhile.
    pub fn of(
        py: Python<'_>,
        reading: &Arc<Reading>,
        request: &DiagramRequest,
        watch: Watch,
    ) -> PyResult<(Diagram, Option<PyErr>)> {
        let watch = Mutex::new(watch);
        let count = request.speeds.len();
        let progress = |done: usize, _: f64| {
            // What another thread asks at this moment holds for this one too.
            let Ok(mut watch) = watch.try_lock() else { return true };
            watch.show(done as f64 / count as f64, || format!("{done} of {count} speeds")).is_continue()
        };
        let found = guarded(py, || reading.campbell(request, &progress))?;
        let raised = watch.into_inner().ok().and_then(|mut watch| watch.raised());
        match (found, raised) {
            (Ok(found), raised) => Ok((Diagram { reading: Arc::clone(reading), found }, raised)),
            (Err(_), Some(raised)) => Err(faults::interrupted(py, raised)),
            (Err(error), None) => Err(faults::vibration(py, &error)),
        }
    }
}

#[pymethods]
impl Diagram {
    fn speeds<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        columns::array(py, self.found.campbell.speeds.iter().copied())
    }

    /// Of each branch: the word for what it moves, and its points, a speed with a mode each.
    fn branches(&self) -> Vec<(&'static str, Vec<(f64, Row)>)> {
        let branches = self.found.campbell.branches.iter();
        let named = branches.map(|branch| {
            let name = branch.points.first().map_or("", |point| point.mode.shares.dominant());
            (name, branch.points.iter().map(|point| (point.speed, row(&point.mode))).collect())
        });
        named.collect()
    }

    /// Branch, number k of the line kΩ, speed.
    fn crossings(&self) -> Vec<(usize, u32, f64)> {
        self.found.campbell.crossings.iter().map(|c| (c.branch, c.revolutions, c.speed)).collect()
    }

    /// Branch, number k of the line kΩ, first and last speed.
    fn resonances(&self) -> Vec<(usize, u32, f64, f64)> {
        self.found.resonances.iter().map(|r| (r.branch, r.revolutions, r.from, r.to)).collect()
    }

    /// Critical speeds.
    fn criticals(&self) -> Vec<f64> {
        self.found.campbell.criticals.iter().map(|c| c.speed).collect()
    }

    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.found.warnings.clone()
    }

    /// Why it ends early.
    #[getter]
    fn incomplete(&self) -> Vec<String> {
        self.found.incomplete.clone()
    }

    fn figure(&self) -> Figure {
        let flexion_case::Diagram { campbell, request, .. } = &self.found;
        Figure(campbell_figure(campbell, request.revolutions, &request.units, self.reading.title()))
    }

    fn save(&self, py: Python<'_>, path: PathBuf, force: bool) -> PyResult<()> {
        let written = guarded(py, || {
            let directory = Directory::create_for(Artifact::CAMPBELL, &path, force, &self.reading.inputs())?;
            self.reading.write_campbell(&self.found, self.reading.title(), &directory)
        })?;
        written.map_err(|error| faults::output(&error))
    }
}
