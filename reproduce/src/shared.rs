//! Runs with which several others are compared: each is computed once.

use flexion_case::{Reading, Run};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

type Slot = Arc<OnceLock<Result<Arc<Run>, String>>>;

/// The runs that were computed, by their cases.
#[derive(Default)]
pub struct Shared {
    runs: Mutex<BTreeMap<String, Slot>>,
}

impl Shared {
    /// The run of a case. A second who asks for it while it is computed waits for it.
    pub fn run(&self, reading: &Reading, stop: &dyn Fn() -> bool) -> Result<Arc<Run>, String> {
        let slot = {
            let mut runs = self.runs.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(runs.entry(reading.resolved()).or_default())
        };
        slot.get_or_init(|| {
            let prepared = reading.prepare().map_err(|problems| problems.reason())?.without_pictures();
            let run = prepared
                .run(&mut |_| if stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) });
            Ok(Arc::new(run))
        })
        .clone()
    }
}
