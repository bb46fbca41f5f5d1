//! Figures in the style of the program.

use super::faults;
use flexion_results::plot;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// A figure.
#[pyclass(frozen, module = "flexion._core")]
pub struct Figure(pub plot::Figure);

#[pymethods]
impl Figure {
    fn svg(&self) -> String {
        self.0.draw().svg()
    }

    fn png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let png = py.detach(|| self.0.draw().png());
        png.map(|bytes| PyBytes::new(py, &bytes)).map_err(|error| faults::output(&error))
    }

    fn pdf<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let pdf = py.detach(|| self.0.draw().pdf());
        pdf.map(|bytes| PyBytes::new(py, &bytes)).map_err(|error| faults::output(&error))
    }
}
