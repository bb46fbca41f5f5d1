//! Runs the cases of the folder `verification`, as the program does.

#![allow(dead_code)] // each test binary uses its part
#![allow(clippy::unwrap_used, clippy::panic)]

use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::system::{State, System};
use flexion_case::{Problems, Reading, read};
use flexion_results::{Status, Trajectory};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// The folder of verification cases.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification")
}

/// A run: why it failed, if it did, when it ended, and what it recorded.
pub struct Run {
    pub failure: Option<String>,
    pub end: f64,
    pub trajectory: Trajectory,
    pub steps: u64,
}

/// Part of the run for one figure.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    pub from: f64,
    pub to: f64,
}

impl Run {
    /// The values of a column.
    pub fn column(&self, name: &str) -> Vec<f64> {
        self.trajectory.column(name).unwrap_or_else(|| panic!("no column {name}"))
    }

    /// Value and time of the extreme (`sign` −1: smallest; 1: largest) of a column, on the parabola
    /// through the recorded extreme and its neighbours.
    pub fn extreme(&self, name: &str, sign: f64, span: Span) -> (f64, f64) {
        let (t, y) = (self.trajectory.times(), self.column(name));
        let inside = |i: &usize| t[*i] >= span.from - 1e-9 && t[*i] <= span.to + 1e-9;
        let i = (0..t.len()).filter(inside).max_by(|a, b| (sign * y[*a]).total_cmp(&(sign * y[*b]))).unwrap();
        if i == 0 || i + 1 == t.len() {
            return (y[i], t[i]);
        }
        let (before, after) = (y[i - 1] - y[i], y[i + 1] - y[i]);
        let curvature = before + after;
        if curvature == 0.0 {
            return (y[i], t[i]);
        }
        let shift = 0.5 * (before - after) / curvature;
        (y[i] - 0.5 * curvature * shift * shift, t[i] + shift * (t[i + 1] - t[i]))
    }

    /// (max − min)/2 of a column within a span.
    pub fn amplitude(&self, name: &str, span: Span) -> f64 {
        0.5 * (self.extreme(name, 1.0, span).0 - self.extreme(name, -1.0, span).0)
    }
}

/// Reads the case of a folder with overrides `KEY=VALUE`.
pub fn case(folder: &str, overrides: &[&str]) -> Result<Reading, Problems> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    read(&root().join(folder), &overrides)
}

/// Reads, builds and runs the case of a folder.
pub fn run(folder: &str, overrides: &[&str]) -> Run {
    let what = || format!("{folder} {overrides:?}");
    let reading = case(folder, overrides).unwrap_or_else(|e| panic!("{}: {e}", what()));
    integrate(&reading).unwrap_or_else(|e| panic!("{}: {e}", what()))
}

/// Builds and runs a case, as the program does.
pub fn integrate(reading: &Reading) -> Result<Run, Problems> {
    let run = reading.prepare()?.run(&mut |_| ControlFlow::Continue(()));
    let failure = (run.status != Status::Finished).then(|| run.message.unwrap());
    Ok(Run { failure, end: run.state.t, trajectory: run.trajectory, steps: run.counters.steps })
}

/// Runs a case with a given system and integrator, from its initial state.
pub fn integrate_system(
    reading: &Reading,
    system: &mut dyn System,
    integrator: &mut dyn flexion::integrator::Integrator,
) -> Run {
    let case = &reading.case;
    let mut state = system.initial();
    let plan =
        Plan { end: case.duration, step: case.steps.step(), longest_step: None, sample: case.output.step };
    let mut record = Record(Trajectory::new(system.channels().to_vec()));
    let ending = transient(system, integrator, &mut state, &plan, &mut record);
    let failure = match ending {
        Ending::Failed(error) => Some(error.to_string()),
        _ => None,
    };
    Run { failure, end: state.t, trajectory: record.0, steps: integrator.counters().steps }
}

struct Record(Trajectory);

impl Observer for Record {
    fn sample(&mut self, system: &mut dyn System, state: &State, _step: &Step) {
        self.0.push(state.t, |row| system.record(state, row));
    }
}
