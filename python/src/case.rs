//! Cases.

use super::path::LoadPath;
use super::run::Run;
use super::vibration::{Diagram, Modes, units};
use super::watch::{Watch, guarded, interruptible};
use super::{faults, law, linear, value};
use flexion_case::{Contents, DiagramRequest, Effort, Reading, Target};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict, PyMapping};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A case that was read: it does not change.
#[pyclass(frozen, module = "flexion._core")]
pub struct Case {
    pub reading: Arc<Reading>,
}

fn case(py: Python<'_>, read: Result<Reading, flexion_case::Problems>) -> PyResult<Case> {
    let reading = read.map_err(|problems| faults::problems(py, &problems))?;
    Ok(Case { reading: Arc::new(reading) })
}

/// How much the estimate of errors may cost: `off`, `auto` or `full`.
pub fn effort(errors: &str) -> PyResult<Option<Effort>> {
    match errors {
        "off" => Ok(None),
        "auto" => Ok(Some(Effort::Auto)),
        "full" => Ok(Some(Effort::Full)),
        other => Err(PyValueError::new_err(format!("errors: `{other}` is none of off, auto, full"))),
    }
}

/// A tolerance, a number or a text with a unit, and the quantity that it is of.
pub fn target(tolerance: Option<String>, quantity: Option<String>) -> PyResult<Option<Target>> {
    match (tolerance, quantity) {
        (Some(tolerance), quantity) => Ok(Some(Target::new(tolerance, quantity))),
        (None, None) => Ok(None),
        (None, Some(quantity)) => {
            Err(PyValueError::new_err(format!("the quantity {quantity} needs a tolerance")))
        }
    }
}

#[pymethods]
impl Case {
    /// Reads a file, or a folder that holds a case.toml.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Case> {
        let read = guarded(py, || flexion_case::read(&path, &[]))?;
        case(py, read)
    }

    /// Reads a text. Files that it names are those of `contents` where these are given, or else those in the folder of `file`.
    #[staticmethod]
    #[pyo3(signature = (text, file, contents=None))]
    fn parse(
        py: Python<'_>,
        text: String,
        file: PathBuf,
        contents: Option<Vec<(String, Vec<u8>)>>,
    ) -> PyResult<Case> {
        let read = guarded(py, || match contents {
            None => flexion_case::parse(text, &file, &[]),
            Some(list) => {
                let contents: Contents = list.into_iter().map(|(name, bytes)| (name, bytes.into())).collect();
                flexion_case::parse_with(text, &file, &[], &contents)
            }
        })?;
        case(py, read)
    }

    /// The TOML text of nested dicts.
    #[staticmethod]
    fn toml(given: &Bound<'_, PyMapping>) -> PyResult<String> {
        let table = value::table(given, "", 0)?;
        toml::to_string(&table).map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// The same case with other values at dotted keys.
    fn changed(&self, py: Python<'_>, changes: &Bound<'_, PyDict>) -> PyResult<Case> {
        let mut set = Vec::with_capacity(changes.len());
        for (key, given) in changes.iter() {
            let key: String = key.extract()?;
            if key.contains('=') {
                return Err(PyValueError::new_err(format!("`{key}` is no key of a case")));
            }
            set.push(format!("{key}={}", value::value(&given, &key, 0)?));
        }
        let reading = Arc::clone(&self.reading);
        let read = guarded(py, || reading.with(&set))?;
        case(py, read)
    }

    /// The case as it is written, in SI and without defaults.
    fn stated(&self) -> String {
        self.reading.stated()
    }

    /// The case with every default.
    fn resolved(&self) -> String {
        self.reading.resolved()
    }

    /// The files that it names.
    fn contents<'py>(&self, py: Python<'py>) -> Vec<(String, Bound<'py, PyBytes>)> {
        let files = self.reading.contents().iter();
        files.map(|(name, bytes)| (name.clone(), PyBytes::new(py, bytes))).collect()
    }

    #[getter]
    fn file(&self) -> &Path {
        &self.reading.file
    }

    #[getter]
    fn title(&self) -> &str {
        &self.reading.case.title
    }

    /// Whether both mean the same.
    fn means(&self, other: &Case) -> bool {
        Arc::ptr_eq(&self.reading, &other.reading) || self.reading.means(&other.reading)
    }

    /// A text that cases of the same meaning share.
    fn shared(&self) -> String {
        self.reading.resolved_with_copies()
    }

    /// Builds all that a run needs, and returns what its reader should know.
    fn check(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let reading = Arc::clone(&self.reading);
        let checked = move || {
            let missing = reading.missing_for_run().err();
            let Some(missing) = missing.filter(|_| reading.build().is_ok()) else {
                return reading.prepare().map(|prepared| prepared.warnings().to_vec());
            };
            Ok(vec![format!("a run: {}", missing.without_run())])
        };
        let prepared = interruptible(py, checked)?;
        prepared.map_err(|problems| faults::problems(py, &problems))
    }

    /// Runs the case; beside the run stands what was raised meanwhile, and by a law.
    #[pyo3(signature = (until, errors, tolerance, quantity, laws, notify))]
    fn run(
        &self,
        py: Python<'_>,
        until: Option<f64>,
        errors: &str,
        tolerance: Option<String>,
        quantity: Option<String>,
        laws: Vec<law::Given<'_>>,
        notify: Option<Py<PyAny>>,
    ) -> PyResult<(Run, Option<PyErr>, Option<PyErr>)> {
        let request = flexion_case::Request {
            until: until.unwrap_or(f64::INFINITY),
            effort: effort(errors)?,
            target: target(tolerance, quantity)?,
        };
        if laws.is_empty() {
            let (run, raised) = Run::of(py, &self.reading, &request, Watch::new(notify))?;
            return Ok((run, raised, None));
        }
        let (laws, held) = law::laws(laws)?;
        let reading = guarded(py, || self.reading.with_laws(laws))?;
        let reading = Arc::new(reading.map_err(|problems| faults::problems(py, &problems))?);
        let watch = Watch::new(notify).with_end(held.ends());
        let (run, raised) =
            Run::of(py, &reading, &request, watch).map_err(|error| held.raised().unwrap_or(error))?;
        Ok((run, raised, held.raised()))
    }

    fn modes(&self, py: Python<'_>, speed: f64, count: usize, free_hub: bool, unit: &str) -> PyResult<Modes> {
        Modes::of(py, &self.reading, speed, count, free_hub, units(unit)?)
    }

    #[pyo3(signature = (speeds, count, free_hub, revolutions, margin, threads, unit, notify))]
    fn campbell(
        &self,
        py: Python<'_>,
        speeds: Vec<f64>,
        count: usize,
        free_hub: bool,
        revolutions: u32,
        margin: f64,
        threads: usize,
        unit: &str,
        notify: Option<Py<PyAny>>,
    ) -> PyResult<(Diagram, Option<PyErr>)> {
        let units = units(unit)?;
        let request = DiagramRequest { speeds, count, revolutions, margin, free_hub, threads, units };
        Diagram::of(py, &self.reading, &request, Watch::new(notify))
    }

    #[pyo3(signature = (to, step, points, errors, notify))]
    fn statics(
        &self,
        py: Python<'_>,
        to: f64,
        step: f64,
        points: usize,
        errors: &str,
        notify: Option<Py<PyAny>>,
    ) -> PyResult<(LoadPath, Option<PyErr>)> {
        LoadPath::of(py, &self.reading, (to, step, points), effort(errors)?, Watch::new(notify))
    }

    fn linearize<'py>(
        &self,
        py: Python<'py>,
        speed: f64,
        free_hub: bool,
        inputs: Vec<(String, Option<Bound<'py, PyMapping>>)>,
        outputs: Vec<String>,
    ) -> PyResult<linear::Linearized<'py>> {
        linear::linearize(py, &self.reading, speed, free_hub, inputs, outputs)
    }

    fn stiffness_at<'py>(&self, py: Python<'py>, place: &str) -> PyResult<linear::Held<'py>> {
        linear::stiffness_at(py, &self.reading, place)
    }

    /// What is advised, as JSON.
    #[pyo3(signature = (tolerance, quantity, notify))]
    fn advise(
        &self,
        py: Python<'_>,
        tolerance: String,
        quantity: Option<String>,
        notify: Option<Py<PyAny>>,
    ) -> PyResult<(String, Option<PyErr>)> {
        let (reading, target) = (Arc::clone(&self.reading), Target::new(tolerance, quantity));
        let mut watch = Watch::new(notify);
        let end = reading.case.duration;
        let advice = guarded(py, || {
            reading
                .advise(&target, &mut |state| watch.show(state.t / end, || format!("t = {:.3} s", state.t)))
        })?;
        match (advice, watch.raised()) {
            (Ok(advice), raised) => Ok((advice.to_json().to_string(), raised)),
            (Err(_), Some(raised)) => Err(faults::interrupted(py, raised)),
            (Err(error), None) => Err(faults::advise(py, &error)),
        }
    }
}
