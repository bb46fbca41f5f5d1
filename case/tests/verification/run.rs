//! Runs the cases of the folder `verification` and their variants, as the program does.

#![allow(dead_code)] // each test binary uses its part
#![allow(clippy::unwrap_used, clippy::panic)]

use flexion::analysis::recording::Record;
use flexion_case::{Problems, Reading, read};
use flexion_results::{Events, Status, Trajectory};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// The folder of verification cases.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification")
}

/// A case of a folder, as it stands or changed.
pub struct Variant {
    /// `FOLDER`, or `FOLDER/VARIANT`.
    pub name: String,
    pub folder: String,
    /// Title, where it differs from that of the case.
    pub title: Option<String>,
    /// What follows `--set` when it is run by hand.
    pub set: Vec<String>,
    /// What its run is held to.
    pub expected: Table,
}

/// The case of a folder as it stands, then its variants.
pub fn variants(folder: &str) -> Vec<Variant> {
    let path = root().join(folder).join("expected.toml");
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let mut table: Table = text.parse().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let others = table.remove("variant").map_or(Vec::new(), |others| others.as_array().unwrap().clone());
    let text = |value: Value| value.as_str().unwrap().to_owned();
    let base =
        Variant { name: folder.into(), folder: folder.into(), title: None, set: vec![], expected: table };
    let other = |value: Value| {
        let mut expected = value.as_table().unwrap().clone();
        let mut take = |key: &str| expected.remove(key).unwrap_or_else(|| panic!("{folder}: no `{key}`"));
        let name = format!("{folder}/{}", text(take("name")));
        let (title, set) = (Some(text(take("title"))), take("set").as_array().unwrap().clone());
        let set = set.into_iter().map(text).collect();
        Variant { name, folder: folder.into(), title, set, expected }
    };
    std::iter::once(base).chain(others.into_iter().map(other)).collect()
}

/// Every variant of every folder.
pub fn all() -> Vec<Variant> {
    let entries = std::fs::read_dir(root()).unwrap().map(|entry| entry.unwrap());
    let folders = entries.filter(|entry| entry.path().join("case.toml").exists());
    let mut folders: Vec<String> = folders.map(|entry| entry.file_name().into_string().unwrap()).collect();
    folders.sort();
    folders.iter().flat_map(|folder| variants(folder)).collect()
}

/// A run: why it failed, if it did, when it ended, and what it recorded.
pub struct Run {
    pub failure: Option<String>,
    pub warnings: Vec<String>,
    pub end: f64,
    pub trajectory: Trajectory,
    pub events: Events,
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

    /// FNV-1a of the bits of all times and values, row by row.
    pub fn fingerprint(&self) -> u64 {
        let words = self.trajectory.rows().flat_map(|(t, row)| std::iter::once(t).chain(row.iter().copied()));
        let bytes = words.flat_map(f64::to_le_bytes);
        bytes
            .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }

    /// (max − min)/2 of a column within a span.
    pub fn amplitude(&self, name: &str, span: Span) -> f64 {
        0.5 * (self.extreme(name, 1.0, span).0 - self.extreme(name, -1.0, span).0)
    }
}

/// Reads the case `FOLDER` or `FOLDER/VARIANT` with overrides `KEY=VALUE`.
pub fn case(name: &str, overrides: &[&str]) -> Result<Reading, Problems> {
    let folder = name.split('/').next().unwrap();
    let variant = variants(folder).into_iter().find(|variant| variant.name == name);
    let mut set = variant.unwrap_or_else(|| panic!("no case {name}")).set;
    set.extend(overrides.iter().map(|text| (*text).to_owned()));
    read(&root().join(folder), &set)
}

/// Reads, builds and runs such a case.
pub fn run(name: &str, overrides: &[&str]) -> Run {
    let what = || format!("{name} {overrides:?}");
    let reading = case(name, overrides).unwrap_or_else(|e| panic!("{}: {e}", what()));
    integrate(&reading).unwrap_or_else(|e| panic!("{}: {e}", what()))
}

/// Builds and runs a case, as the program does.
pub fn integrate(reading: &Reading) -> Result<Run, Problems> {
    let run = reading.prepare()?.run(&mut |_| ControlFlow::Continue(()));
    let failure = (run.status != Status::Finished).then(|| run.message.unwrap());
    let Record { trajectory, events, state, counters, .. } = run.record;
    Ok(Run { failure, warnings: run.warnings, end: state.t, trajectory, events, steps: counters.steps })
}
