//! The time that a run takes: the one place that looks at a clock.

use std::time::Instant;

/// A clock that runs.
pub(crate) struct Clock {
    start: Instant,
    processor: Option<f64>,
}

impl Clock {
    /// Starts a clock.
    pub(crate) fn start() -> Clock {
        Clock { start: Instant::now(), processor: processor_time() }
    }

    /// Time since the start [s], and that of the processor, where the system gives it.
    pub(crate) fn elapsed(&self) -> (f64, Option<f64>) {
        let processor = processor_time().zip(self.processor).map(|(end, start)| end - start);
        (self.start.elapsed().as_secs_f64(), processor)
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
