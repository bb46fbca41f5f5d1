//! The package `flexion` for Python, below its surface: cases in, arrays and texts out. It holds no mechanics and no drivers; what the
//! program computes is computed by the same functions of `flexion-case`. The classes that a reader of the documentation sees are
//! those of the Python sources beside it.

mod case;
mod columns;
mod faults;
mod figure;
mod law;
mod linear;
mod path;
mod run;
mod sweep;
mod value;
mod vibration;
mod watch;

use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _core {
    #[pymodule_export]
    use super::case::Case;
    #[pymodule_export]
    use super::columns::{Stored, compare, runs_figure};
    #[pymodule_export]
    use super::figure::Figure;
    #[pymodule_export]
    use super::path::LoadPath;
    #[pymodule_export]
    use super::run::Run;
    #[pymodule_export]
    use super::sweep::{Sweep, item};
    #[pymodule_export]
    use super::vibration::{Diagram, Modes};
    #[pymodule_export]
    use super::watch::{end, forked};
    #[pymodule_export]
    use super::{program, schema, speed, version, view};
}

/// Version of the engine.
#[pyfunction]
fn version() -> &'static str {
    flexion_results::VERSION
}

/// The JSON Schema of cases.
#[pyfunction]
fn schema() -> String {
    flexion_case::schema()
}

/// A speed of rotation [rad/s] as it is written, with a unit or without.
#[pyfunction]
fn speed(text: &str) -> PyResult<f64> {
    let read = flexion_case::Speed::read(text).map_err(pyo3::exceptions::PyValueError::new_err)?;
    Ok(read.in_radians(&flexion_results::Frequencies::RADIANS))
}

/// The page that plays the motion or the modes in a folder of results.
#[pyfunction]
fn view(py: Python<'_>, path: std::path::PathBuf, columns: Vec<String>) -> PyResult<String> {
    let page = watch::guarded(py, || flexion_results::view_page(&path, &columns))?;
    page.map_err(|error| faults::results(py, &error))
}

/// Does what a command line says and returns the exit code.
#[pyfunction]
fn program(py: Python<'_>, words: Vec<std::ffi::OsString>) -> PyResult<u8> {
    watch::guarded(py, || flexion_cli::program(words))
}
