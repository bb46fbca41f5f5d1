//! The time that a run takes: the one place that looks at a clock.

use std::sync::OnceLock;

static GIVEN: OnceLock<fn() -> f64> = OnceLock::new();

/// Gives the clock of a machine on which the standard library has none, such as a browser: seconds since any time. Without one, times are
/// zero there.
pub fn use_clock(now: fn() -> f64) {
    let _ = GIVEN.set(now);
}

fn now() -> f64 {
    GIVEN.get().map_or_else(of_system, |now| now())
}

#[cfg(not(target_family = "wasm"))]
fn of_system() -> f64 {
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

#[cfg(target_family = "wasm")]
fn of_system() -> f64 {
    0.0
}

/// A clock that runs.
pub(crate) struct Clock {
    start: f64,
    processor: Option<f64>,
}

impl Clock {
    /// Starts a clock.
    pub(crate) fn start() -> Clock {
        Clock { start: now(), processor: processor_time() }
    }

    /// Time since the start [s], and that of the processor, where the system gives it.
    pub(crate) fn elapsed(&self) -> (f64, Option<f64>) {
        let processor = processor_time().zip(self.processor).map(|(end, start)| end - start);
        (now() - self.start, processor)
    }
}

/// Processor time of this thread [s].
#[cfg(unix)]
fn processor_time() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

/// Unknown on this system.
#[cfg(not(unix))]
fn processor_time() -> Option<f64> {
    None
}
