//! What a computation does beside computing: it shows how far it is, and ends at Ctrl-C or where it is told to.

use super::faults;
use pyo3::prelude::*;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// Interval at which Python is asked.
const INTERVAL: Duration = Duration::from_millis(50);

/// Computes without the lock of the interpreter; a panic, which no input should reach, is an exception.
pub fn guarded<T: Send>(py: Python<'_>, compute: impl FnOnce() -> T + Send) -> PyResult<T> {
    let computed = py.detach(|| catch_unwind(AssertUnwindSafe(compute)));
    computed.map_err(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a reason");
        faults::internal(py, &format!("the program broke down, which is its fault: {text}"))
    })
}

/// Asks Python, now and then, whether a computation goes on.
pub struct Watch {
    /// Called with what is said and the part that is done, or `None`: what it returns as true stops.
    notify: Option<Py<PyAny>>,
    last: Instant,
    stopped: bool,
    /// What a call has raised, or Ctrl-C.
    raised: Option<PyErr>,
}

impl Watch {
    pub fn new(notify: Option<Py<PyAny>>) -> Watch {
        Watch { notify, last: Instant::now(), stopped: false, raised: None }
    }

    /// Goes on, or stops.
    pub fn show(&mut self, part: f64, text: impl FnOnce() -> String) -> ControlFlow<()> {
        if self.stopped {
            return ControlFlow::Break(());
        }
        if self.last.elapsed() < INTERVAL {
            return ControlFlow::Continue(());
        }
        // Of a run without duration.
        let part = if part.is_finite() { part } else { 0.0 };
        let asked = Python::attach(|py| {
            // Signals reach the main thread alone.
            py.check_signals()?;
            let Some(notify) = &self.notify else { return Ok(false) };
            notify.call1(py, (part, text()))?.is_truthy(py)
        });
        self.last = Instant::now();
        self.stopped = asked.unwrap_or_else(|error| {
            self.raised = Some(error);
            true
        });
        if self.stopped { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// What was raised while it watched.
    pub fn raised(&mut self) -> Option<PyErr> {
        self.raised.take()
    }
}
