//! What a computation does beside computing: it shows how far it is, and ends at Ctrl-C or where it is told to.

use super::faults;
use pyo3::exceptions::{PyRecursionError, PyRuntimeError};
use pyo3::prelude::*;
use std::any::Any;
use std::cell::Cell;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, OnceLock};
use std::thread::{self, ThreadId};
use std::time::{Duration, Instant};

/// Interval at which Python is asked.
const INTERVAL: Duration = Duration::from_millis(50);

/// Why a thread computes no more.
const ENDS: &str = "Python ends, and other threads compute no more";

/// Computations of laws of computations of laws …, beyond which a thread has no stack left.
const DEEPEST: usize = 4;

thread_local! {
    /// Computations of this thread, each but the first by a law of the one before.
    static DEPTH: Cell<usize> = const { Cell::new(0) };
    /// What Python calls this thread.
    static IDENT: Cell<Option<u64>> = const { Cell::new(None) };
}
/// Threads that ask something of Python: a law, or whether to stop.
static ASKED: Mutex<Vec<u64>> = Mutex::new(Vec::new());
/// Computations of all threads.
static RUNNING: AtomicUsize = AtomicUsize::new(0);
/// The thread in which the interpreter ends.
static ENDING: OnceLock<ThreadId> = OnceLock::new();

/// One that is counted as long as it lasts.
struct Counted;

impl Counted {
    fn new() -> Counted {
        DEPTH.set(DEPTH.get() + 1);
        RUNNING.fetch_add(1, Ordering::SeqCst);
        Counted
    }
}

impl Drop for Counted {
    fn drop(&mut self) {
        DEPTH.set(DEPTH.get() - 1);
        RUNNING.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Whether the interpreter ends, and with it the computations of this thread: all but what it still computes itself.
pub fn ending() -> bool {
    ENDING.get().is_some_and(|thread| *thread != thread::current().id())
}

/// Ends the computations of other threads before the interpreter ends, which would end these threads in the middle of Rust. Gives `None` when none
/// is left, and after `patience` \[s\] the threads in which Python has not returned.
#[pyfunction]
pub fn end(py: Python<'_>, patience: f64) -> Option<Vec<u64>> {
    ENDING.get_or_init(|| thread::current().id());
    let began = Instant::now();
    py.detach(|| {
        while RUNNING.load(Ordering::SeqCst) > 0 && began.elapsed().as_secs_f64() < patience {
            std::thread::sleep(Duration::from_millis(1));
        }
    });
    (RUNNING.load(Ordering::SeqCst) > 0).then(|| ASKED.lock().map(|asked| asked.clone()).unwrap_or_default())
}

/// A thread that asks something of Python, as long as it lasts.
pub struct Asked(u64);

impl Asked {
    pub fn new(py: Python<'_>) -> PyResult<Asked> {
        let ident = match IDENT.get() {
            Some(ident) => ident,
            None => py.import("threading")?.call_method0("get_ident")?.extract()?,
        };
        IDENT.set(Some(ident));
        if let Ok(mut asked) = ASKED.lock() {
            asked.push(ident);
        }
        Ok(Asked(ident))
    }
}

impl Drop for Asked {
    fn drop(&mut self) {
        if let Ok(mut asked) = ASKED.lock()
            && let Some(last) = asked.iter().rposition(|ident| *ident == self.0)
        {
            asked.swap_remove(last);
        }
    }
}

/// Leaves computations to the process that has forked: its child has the thread alone that forked, with what it computes.
#[pyfunction]
pub fn forked() {
    RUNNING.store(DEPTH.get(), Ordering::SeqCst);
}

/// Computes without the lock of the interpreter; a panic, which no input should reach, is an exception.
pub fn guarded<T: Send>(py: Python<'_>, compute: impl FnOnce() -> T + Send) -> PyResult<T> {
    if DEPTH.get() >= DEEPEST {
        let text = format!("a law computes a case whose law computes a case …, {DEEPEST} deep");
        return Err(PyRecursionError::new_err(text));
    }
    if ending() {
        return Err(PyRuntimeError::new_err(ENDS));
    }
    let computed = py.detach(|| {
        let _counted = Counted::new();
        catch_unwind(AssertUnwindSafe(compute))
    });
    computed.map_err(|panic| broken(py, panic))
}

/// Stack of a thread that computes beside the one that called.
const STACK: usize = 8 << 20;

/// Computes what nobody asks on its way whether it goes on, beside the thread that calls: Ctrl-C returns at once, and what is still computed
/// then is dropped.
pub fn interruptible<T: Send + 'static>(
    py: Python<'_>,
    compute: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    if ending() {
        return Err(PyRuntimeError::new_err(ENDS));
    }
    let (send, mut receive) = channel();
    let work = move || {
        // Of one that has been interrupted nobody takes the result.
        let _ = send.send(catch_unwind(AssertUnwindSafe(compute)));
    };
    thread::Builder::new().stack_size(STACK).spawn(work)?;
    // This thread alone returns to Python.
    let _counted = Counted::new();
    loop {
        let next = &mut receive;
        match py.detach(move || next.recv_timeout(INTERVAL)) {
            Ok(computed) => return computed.map_err(|panic| broken(py, panic)),
            Err(_) if ending() => return Err(PyRuntimeError::new_err(ENDS)),
            Err(RecvTimeoutError::Timeout) => {
                py.check_signals().map_err(|raised| faults::interrupted(py, raised))?;
            }
            Err(RecvTimeoutError::Disconnected) => return Err(faults::internal(py, "a thread has ended")),
        }
    }
}

/// A panic as an exception.
fn broken(py: Python<'_>, panic: Box<dyn Any + Send>) -> PyErr {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a reason");
    faults::internal(py, &format!("the program broke down, which is its fault: {text}"))
}

/// Asks Python, now and then, whether a computation goes on.
pub struct Watch {
    /// Called with what is said and the part that is done, or `None`: what it returns as true stops.
    notify: Option<Py<PyAny>>,
    last: Instant,
    stopped: bool,
    /// Set by a law that ends all runs of its case.
    ended: Option<Arc<AtomicBool>>,
    /// What a call has raised, or Ctrl-C.
    raised: Option<PyErr>,
}

impl Watch {
    pub fn new(notify: Option<Py<PyAny>>) -> Watch {
        Watch { notify, last: Instant::now(), stopped: false, ended: None, raised: None }
    }

    /// Stops too when `ended` is set.
    pub fn with_end(self, ended: Arc<AtomicBool>) -> Watch {
        Watch { ended: Some(ended), ..self }
    }

    /// Goes on, or stops.
    pub fn show(&mut self, part: f64, text: impl FnOnce() -> String) -> ControlFlow<()> {
        let by_law = self.ended.as_ref().is_some_and(|ended| ended.load(Ordering::Relaxed));
        if self.stopped || by_law || ending() {
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
            let _asked = Asked::new(py)?;
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
