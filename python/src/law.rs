//! Laws that functions of Python give.

use super::value;
use super::watch::{Asked, ending};
use flexion::command::{Command, LawState, Timing};
use flexion_case::{Law, Start};
use pyo3::exceptions::{PyException, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyMapping, PyTuple};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// What a law has raised first, and whether that ends all runs of the case: Ctrl-C, and whatever is no error.
#[derive(Debug, Default)]
struct First {
    error: Mutex<Option<PyErr>>,
    ends: Arc<AtomicBool>,
}

type Raised = Arc<First>;

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

/// What laws of a run keep of Python until it has ended: a function may hold the results of the run, and the collector of Python does not see
/// that these hold the function.
pub struct Held {
    makers: Vec<Arc<Maker>>,
    raised: Raised,
}

impl Held {
    /// What a law has raised first.
    pub fn raised(&self) -> Option<PyErr> {
        self.raised.error.lock().ok().and_then(|mut raised| raised.take())
    }

    /// Whether a law has ended all runs of the case.
    pub fn ends(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.raised.ends)
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        for maker in &self.makers {
            if let Ok(mut make) = maker.make.lock() {
                *make = None;
            }
        }
    }
}

/// The laws as the engine takes them, and what they hold.
pub fn laws(given: Vec<Given<'_>>) -> PyResult<(Vec<Law>, Held)> {
    let mut held = Held { makers: Vec::new(), raised: Raised::default() };
    let mut law = |(name, load, reads, states, period, breaks, make): Given<'_>| {
        let load = load.map(|load| value::table(&load, &name, 0)).transpose()?;
        let load = load.map(|load| toml::Value::Table(load).to_string());
        let timing = period.map_or(Timing::Continuous { breaks }, |period| Timing::Sampled { period });
        let states = states.into_iter().map(|(name, start, size)| LawState { name, start, size }).collect();
        let start = Arc::new(Maker { make: Mutex::new(Some(make)), raised: Arc::clone(&held.raised) });
        held.makers.push(Arc::clone(&start));
        PyResult::Ok(Law { name, load, reads, states, timing, start })
    };
    let listed = given.into_iter().map(&mut law).collect::<PyResult<_>>()?;
    Ok((listed, held))
}

#[derive(Debug)]
struct Maker {
    make: Mutex<Option<Py<PyAny>>>,
    raised: Raised,
}

/// Keeps the first exception, and says what it is.
fn keep(raised: &Raised, error: PyErr) -> String {
    let said = format!("raised {error}");
    if !Python::attach(|py| error.is_instance_of::<PyException>(py)) {
        raised.ends.store(true, Ordering::Relaxed);
    }
    if let Ok(mut raised) = raised.error.lock() {
        raised.get_or_insert(error);
    }
    said
}

impl Start for Maker {
    fn start(&self) -> Result<Box<dyn Command>, String> {
        if self.raised.ends.load(Ordering::Relaxed) {
            return Err("is not asked any more".to_owned());
        }
        let function = Python::attach(|py| {
            let make = self.make.lock().ok().and_then(|make| make.as_ref().map(|make| make.clone_ref(py)));
            let make = make.ok_or_else(|| "belongs to a run that has ended".to_owned())?;
            let made = Asked::new(py).and_then(|_asked| make.call0(py));
            made.map_err(|error| keep(&self.raised, error))
        })?;
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
            let _asked = Asked::new(py)?;
            let y = PyTuple::new(py, y)?;
            let given = self.function.call1(py, (t, y))?;
            if rates.is_empty() {
                return real(given.bind(py));
            }
            let (value, of_states) = given.extract::<(Bound<'_, PyAny>, Vec<f64>)>(py)?;
            let value = real(&value)?;
            // `_made` gives one for each.
            rates.iter_mut().zip(of_states).for_each(|(rate, of)| *rate = of);
            Ok(value)
        });
        asked.map_err(|error| format!("{} at t = {t:.6} s", keep(&self.raised, error)))
    }
}

/// The number that a law gives. NumPy makes complex numbers real ones, with no more than a warning.
fn real(given: &Bound<'_, PyAny>) -> PyResult<f64> {
    let is_complex = !given.is_instance_of::<PyFloat>()
        && given
            .getattr("dtype")
            .and_then(|dtype| dtype.getattr("kind"))
            .is_ok_and(|kind| kind.eq("c").unwrap_or(false));
    if is_complex { Err(PyTypeError::new_err("must be real number, not complex")) } else { given.extract() }
}
