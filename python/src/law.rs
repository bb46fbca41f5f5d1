//! Laws that functions of Python give.

use super::value;
use super::watch::ending;
use flexion::command::{Command, LawState, Timing};
use flexion_case::{Law, Start};
use pyo3::prelude::*;
use pyo3::types::{PyMapping, PyTuple};
use std::sync::{Arc, Mutex};

/// What a law has raised.
pub type Raised = Arc<Mutex<Option<PyErr>>>;

/// Name, load, columns that are read, states with their starts and sizes, period or none, times of breaks, what makes the function of a run.
pub type Given<'py> = (
    String,
    Option<Bound<'py, PyMapping>>,
    Vec<String>,
    Vec<(String, f64, f64)>,
    Option<f64>,
    Vec<f64>,
    Py<PyAny>,
);

/// The laws as the engine takes them, and where what they raise is found.
pub fn laws(given: Vec<Given<'_>>) -> PyResult<(Vec<Law>, Raised)> {
    let raised = Raised::default();
    let law = |(name, load, reads, states, period, breaks, make): Given<'_>| {
        let load = load.map(|load| value::table(&load, &name, 0)).transpose()?;
        let load = load.map(|load| toml::Value::Table(load).to_string());
        let timing = period.map_or(Timing::Continuous { breaks }, |period| Timing::Sampled { period });
        let states = states.into_iter().map(|(name, start, size)| LawState { name, start, size }).collect();
        let start = Arc::new(Maker { make, raised: Arc::clone(&raised) });
        PyResult::Ok(Law { name, load, reads, states, timing, start })
    };
    Ok((given.into_iter().map(law).collect::<PyResult<_>>()?, raised))
}

#[derive(Debug)]
struct Maker {
    make: Py<PyAny>,
    raised: Raised,
}

/// Keeps the first exception, and says what it is.
fn keep(raised: &Raised, error: PyErr) -> String {
    let said = format!("raised {error}");
    if let Ok(mut raised) = raised.lock() {
        raised.get_or_insert(error);
    }
    said
}

impl Start for Maker {
    fn start(&self) -> Result<Box<dyn Command>, String> {
        let function = Python::attach(|py| self.make.call0(py)).map_err(|error| keep(&self.raised, error))?;
        Ok(Box::new(Function { function, raised: Arc::clone(&self.raised) }))
    }
}

struct Function {
    function: Py<PyAny>,
    raised: Raised,
}

impl Command for Function {
    fn value(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<f64, String> {
        if ending() {
            return Err("is not asked any more: Python ends".to_owned());
        }
        let asked = Python::attach(|py| {
            let y = PyTuple::new(py, y)?;
            let given = self.function.call1(py, (t, y))?;
            if rates.is_empty() {
                return given.extract::<f64>(py);
            }
            let (value, of_states) = given.extract::<(f64, Vec<f64>)>(py)?;
            // `_made` gives one for each.
            rates.iter_mut().zip(of_states).for_each(|(rate, of)| *rate = of);
            Ok(value)
        });
        asked.map_err(|error| format!("{} at t = {t:.6} s", keep(&self.raised, error)))
    }
}
