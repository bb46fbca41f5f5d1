//! The functions that the WebAssembly module exports.
//!
//! | function | returns |
//! |---|---|
//! | `flexion_run(elements)` | number of rows of the trajectory, 0 if the run failed |
//! | `flexion_columns()` | number of columns |
//! | `flexion_values()` | address of the first of rows × columns numbers of 64 bits, row after row |
//! | `flexion_heading()`, `flexion_heading_length()` | address and bytes of the names of the columns in UTF-8, or of the reason of the failure |
//!
//! The addresses hold until the next run.

use super::{Trajectory, spin_up};
use std::sync::{Mutex, MutexGuard, PoisonError};

static TRAJECTORY: Mutex<Trajectory> =
    Mutex::new(Trajectory { heading: String::new(), columns: 0, values: Vec::new() });

fn trajectory() -> MutexGuard<'static, Trajectory> {
    TRAJECTORY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Runs the case with so many finite elements, and returns the number of rows; 0 if it failed.
#[unsafe(no_mangle)]
pub extern "C" fn flexion_run(elements: usize) -> usize {
    let run = spin_up(elements)
        .unwrap_or_else(|error| Trajectory { heading: error.to_string(), ..Trajectory::default() });
    let mut trajectory = trajectory();
    *trajectory = run;
    trajectory.values.len().checked_div(trajectory.columns).unwrap_or(0)
}

/// Number of columns of the trajectory, the time included.
#[unsafe(no_mangle)]
pub extern "C" fn flexion_columns() -> usize {
    trajectory().columns
}

/// Address of the values of the trajectory, row after row.
#[unsafe(no_mangle)]
pub extern "C" fn flexion_values() -> *const f64 {
    trajectory().values.as_ptr()
}

/// Address of the names of the columns, separated by commas, or of the reason of the failure.
#[unsafe(no_mangle)]
pub extern "C" fn flexion_heading() -> *const u8 {
    trajectory().heading.as_ptr()
}

/// Bytes of [`flexion_heading`].
#[unsafe(no_mangle)]
pub extern "C" fn flexion_heading_length() -> usize {
    trajectory().heading.len()
}
