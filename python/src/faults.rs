//! Errors of the engine as exceptions of `flexion._errors`.

use flexion_case::sweep::SweepError;
use flexion_case::{AdviseError, Problems, RefineError, VibrationError};
use flexion_results::{OutputError, ResultsError};
use pyo3::call::PyCallArgs;
use pyo3::exceptions::{PyKeyError, PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;

/// An exception made by a function or a class of `flexion._errors`.
fn raise<'py>(py: Python<'py>, maker: &str, arguments: impl PyCallArgs<'py>) -> PyErr {
    let made = py.import("flexion._errors").and_then(|module| module.getattr(maker)?.call1(arguments));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// Everything that is wrong with a case.
pub fn problems(py: Python<'_>, problems: &Problems) -> PyErr {
    let each = problems.list.iter().zip(problems.lines_and_columns()).map(|(problem, place)| {
        let source = problem.place.as_ref().and_then(|place| problems.sources.get(place.source));
        let source = source.or(problems.sources.first()).map_or("", |source| source.name.as_str());
        let (line, column) = (place.map(|place| place.0), place.map(|place| place.1));
        (problem.message.as_str(), problem.key.as_str(), source, line, column, problem.help.clone())
    });
    let each: Vec<_> = each.collect();
    raise(py, "case_error", (problems.render(false), each))
}

/// An analysis without result.
pub fn analysis(py: Python<'_>, message: &str) -> PyErr {
    raise(py, "AnalysisError", (message,))
}

/// Ctrl-C before there is anything to keep; whatever else was raised stays what it is.
pub fn interrupted(py: Python<'_>, raised: PyErr) -> PyErr {
    if !raised.is_instance_of::<PyKeyboardInterrupt>(py) {
        return raised;
    }
    let error = raise(py, "Interrupted", ("interrupted before there was a result",));
    error.set_cause(py, Some(raised));
    error
}

/// A fault of the program.
pub fn internal(py: Python<'_>, message: &str) -> PyErr {
    raise(py, "InternalError", (message,))
}

/// Results that cannot be read or compared.
pub fn results(py: Python<'_>, error: &ResultsError) -> PyErr {
    match error {
        ResultsError::NoColumn { .. } => PyKeyError::new_err(error.to_string()),
        error => analysis(py, &error.to_string()),
    }
}

/// Files that cannot be written.
pub fn output(error: &OutputError) -> PyErr {
    PyOSError::new_err(error.to_string().replace("--force", "force=True"))
}

/// A refinement that is not possible.
pub fn refine(py: Python<'_>, error: &RefineError) -> PyErr {
    match error {
        RefineError::Case(of) => problems(py, of),
        RefineError::Column(error) => results(py, error),
        error @ RefineError::Tolerance { .. } => pyo3::exceptions::PyValueError::new_err(error.to_string()),
    }
}

/// A case without modes.
pub fn vibration(py: Python<'_>, error: &VibrationError) -> PyErr {
    match error {
        VibrationError::Case(of) => problems(py, of),
        error => analysis(py, &error.to_string()),
    }
}

/// A case without advice.
pub fn advise(py: Python<'_>, error: &AdviseError) -> PyErr {
    match error {
        AdviseError::Refine(error) => refine(py, error),
        error @ AdviseError::NoAnswer(_) => analysis(py, &error.to_string()),
    }
}

/// A sweep that is refused.
pub fn sweep(py: Python<'_>, error: &SweepError) -> PyErr {
    match error {
        SweepError::Case(of) => problems(py, of),
        SweepError::Column(error) => results(py, error),
        SweepError::Io { .. } => PyOSError::new_err(error.to_string()),
        error => raise(py, "SweepError", (error.to_string(),)),
    }
}
