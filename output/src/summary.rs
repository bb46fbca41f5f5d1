//! `summary.json`: how a run went, in numbers a program can read.

use serde_json::{Map, Value, json};

use super::events::to_json;
use super::{Errors, Events, Trajectory};
use flexion::integrator::{Counters, Info};
use flexion::system::{Kind, Role};

/// Version of the program, as stated in every summary.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// It reached its end.
    Finished,
    /// It was stopped before its end; what was recorded until then is valid.
    Stopped,
    /// It could not go on.
    Failed,
}

impl Status {
    /// The word in the summary: `finished`, `stopped` or `failed`.
    pub fn word(self) -> &'static str {
        match self {
            Status::Finished => "finished",
            Status::Stopped => "stopped",
            Status::Failed => "failed",
        }
    }
}

/// Size of the equations solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ProblemSize {
    /// Number of unknowns, multipliers included.
    pub unknowns: usize,
    /// Half bandwidth of the tangent, without its border.
    pub half_bandwidth: usize,
    /// Number of full rows and columns that border the band.
    pub border: usize,
}

/// The integrator of a run and its settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Integration<'a> {
    /// What it is.
    pub info: &'a Info,
    /// Its settings under the names of the case file, in the order to be written,
    /// e.g. `step` 0.005.
    pub settings: Map<String, Value>,
}

/// What the driver of a transient run knows, for its summary.
#[derive(Clone, Debug)]
pub struct RunReport<'a> {
    /// How it ended.
    pub status: Status,
    /// Why it stopped or failed; `None` for a run that finished.
    pub message: Option<&'a str>,
    /// Title of the case.
    pub title: &'a str,
    /// File name of the case, without directories; `None` for a case that came from no file.
    pub file: Option<&'a str>,
    /// Duration asked for \[s\].
    pub duration: f64,
    /// Time reached \[s\].
    pub end_time: f64,
    /// Warnings, in the order in which they arose.
    pub warnings: &'a [String],
    /// The integrator.
    pub integrator: Integration<'a>,
    /// Estimated errors; `None` where nobody asked for them.
    pub errors: Option<&'a Errors>,
    /// Events at contacts; `None` for a system without contacts.
    pub events: Option<&'a Events>,
    /// Work done.
    pub counters: Counters,
    /// Size of the equations.
    pub size: ProblemSize,
    /// Wall time of the run \[s\], preparation included; times are the entries that differ between two runs of one case.
    pub wall_time: f64,
    /// Processor time of the run \[s\], where the system reports it.
    pub cpu_time: Option<f64>,
    /// The part of both in which the model was built and its start found \[s\].
    pub preparation: (f64, Option<f64>),
    /// Names of the laws of a program, which no file holds.
    pub laws: &'a [String],
}

/// A summary: keys in the order in which they were added, no number that is not finite (`null` instead).
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    status: Status,
    entries: Map<String, Value>,
}

impl Summary {
    /// A summary with what every analysis states: `status`, `message`, `version` and
    /// `case` {`title`, `file`}.
    pub fn new(status: Status, message: Option<&str>, title: &str, file: Option<&str>) -> Summary {
        let mut summary = Summary { status, entries: Map::new() };
        summary.insert("status", status.word());
        summary.insert("message", message);
        summary.insert("version", VERSION);
        summary.insert("case", json!({ "title": title, "file": file }));
        summary
    }

    /// The summary of a transient run, with its [`outcome`].
    pub fn of_run(report: &RunReport<'_>, trajectory: &Trajectory) -> Summary {
        let (status, message) = outcome(report.status, report.message, trajectory);
        let mut s = Summary::new(status, message.as_deref(), report.title, report.file);
        s.insert("duration", report.duration);
        s.insert("end_time", report.end_time);
        s.insert("columns", columns(trajectory, report.errors));
        if let Some(errors) = report.errors {
            s.insert("trust", errors.trust());
        }
        if let Some(energy) = imbalance(trajectory) {
            s.insert("energy", energy);
        }
        if let Some(events) = report.events {
            s.insert("events", to_json(events));
        }
        s.insert("warnings", report.warnings);
        if !report.laws.is_empty() {
            s.insert("laws", report.laws);
        }
        let info = report.integrator.info;
        let mut integrator = Map::new();
        integrator.insert("name".into(), info.name.into());
        integrator.insert("order".into(), info.order.into());
        integrator.extend(report.integrator.settings.clone());
        s.insert("integrator", integrator);
        let (c, size) = (report.counters, report.size);
        s.insert(
            "work",
            json!({
                "steps": c.steps,
                "rejected": c.rejected,
                "iterations": c.iterations,
                "residuals": c.residuals,
                "tangents": c.tangents,
                "factorizations": c.factorizations,
                "solves": c.solves,
                "unknowns": size.unknowns,
                "half_bandwidth": size.half_bandwidth,
                "border": size.border,
            }),
        );
        s.insert("wall_time", report.wall_time);
        s.insert("cpu_time", report.cpu_time);
        s.insert("preparation_wall_time", report.preparation.0);
        s.insert("preparation_cpu_time", report.preparation.1);
        s
    }

    /// Adds an entry, or replaces it in its place. A floating-point number that is not finite becomes `null`.
    pub fn insert(&mut self, key: &str, value: impl Into<Value>) {
        self.entries.insert(key.into(), value.into());
    }

    /// The status stated.
    pub fn status(&self) -> Status {
        self.status
    }

    /// The entry called `key`.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.entries.get(key)
    }

    /// All entries.
    pub fn entries(&self) -> &Map<String, Value> {
        &self.entries
    }

    /// The summary as indented JSON with a final newline.
    pub fn to_json(&self) -> String {
        format!("{:#}\n", Value::Object(self.entries.clone()))
    }
}

/// Status and message of a run: one that claims to have finished and recorded a value that is not finite has failed, with the channel
/// and the time in the message.
pub fn outcome(status: Status, message: Option<&str>, trajectory: &Trajectory) -> (Status, Option<String>) {
    if status == Status::Finished
        && let Some((channel, t)) = trajectory.first_not_finite()
    {
        let from = format!("{} is not a finite number from t = {t} s on", channel.name);
        return (Status::Failed, Some(format!("{from}; try a smaller step or a tighter tolerance")));
    }
    (status, message.map(String::from))
}

/// The energy balance: its largest and last value, and both over the largest energy or work of the run.
fn imbalance(trajectory: &Trajectory) -> Option<Value> {
    let balance = trajectory.extremes(trajectory.with_role(Role::Imbalance).next()?);
    let largest = trajectory.largest_energy();
    let max = balance.largest();
    let over = |x: f64| if largest > 0.0 { x / largest } else { 0.0 };
    Some(json!({
        "largest": largest,
        "imbalance": { "max": max, "final": balance.last },
        "relative_imbalance": { "max": over(max), "final": over(balance.last) },
    }))
}

fn columns(trajectory: &Trajectory, errors: Option<&Errors>) -> Map<String, Value> {
    let entry = |(i, c): (usize, &flexion::system::Channel)| {
        let e = trajectory.extremes(i);
        let mut value = json!({
            "min": e.min, "t_min": e.t_min, "max": e.max, "t_max": e.t_max, "final": e.last, "unit": c.unit,
            "role": c.role.name(),
        });
        if c.kind != Kind::Real {
            value["kind"] = c.kind.name().into();
        }
        if let Some(error) = errors.and_then(|errors| errors.of(&c.name)) {
            value["error"] = error;
        }
        (c.name.clone(), value)
    };
    trajectory.channels().iter().enumerate().map(entry).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::samples::{channel, sample};

    pub(crate) fn report() -> RunReport<'static> {
        const RADAU: Info = Info { name: "radau", order: 5, estimate_order: Some(3), implicit: true };
        let mut settings = Map::new();
        settings.insert("step".into(), 0.01.into());
        RunReport {
            status: Status::Finished,
            message: None,
            title: "Spin-up",
            file: Some("spin_up.toml"),
            duration: 4.0,
            end_time: 4.0,
            warnings: &[],
            integrator: Integration { info: &RADAU, settings },
            errors: None,
            events: None,
            counters: Counters { steps: 400, ..Counters::default() },
            size: ProblemSize { unknowns: 33, half_bandwidth: 5, border: 1 },
            wall_time: 0.25,
            cpu_time: None,
            preparation: (0.05, None),
            laws: &[],
        }
    }

    #[test]
    fn keys_are_in_the_documented_order_with_the_values_of_the_run() {
        let json = Summary::of_run(&report(), &sample()).to_json();
        let value: Value = serde_json::from_str(&json).unwrap();
        let keys: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(
            keys,
            [
                "status",
                "message",
                "version",
                "case",
                "duration",
                "end_time",
                "columns",
                "warnings",
                "integrator",
                "work",
                "wall_time",
                "cpu_time",
                "preparation_wall_time",
                "preparation_cpu_time"
            ]
        );
        assert_eq!(value["status"], "finished");
        assert_eq!(value["message"], Value::Null);
        assert_eq!(value["columns"]["tip.deflection"]["min"], -1.0);
        assert_eq!(value["columns"]["tip.deflection"]["t_min"], 2.0);
        assert_eq!(value["columns"]["hub.speed"]["unit"], "rad/s");
        assert_eq!(value["integrator"], json!({ "name": "radau", "order": 5, "step": 0.01 }));
        assert_eq!(value["work"]["steps"], 400);
        assert_eq!(value["work"]["half_bandwidth"], 5);
    }

    #[test]
    fn numbers_that_are_not_finite_become_null_and_fail_the_run() {
        let mut t = Trajectory::new(vec![channel("tip.deflection", "m")]);
        t.push(0.0, |row| row[0] = 0.0);
        t.push(0.5, |row| row[0] = f64::NAN);
        let report = RunReport { end_time: f64::INFINITY, ..report() };
        let summary = Summary::of_run(&report, &t);
        assert_eq!(summary.status(), Status::Failed);
        let value: Value = serde_json::from_str(&summary.to_json()).unwrap();
        assert_eq!(value["status"], "failed");
        assert!(
            value["message"]
                .as_str()
                .unwrap()
                .contains("tip.deflection is not a finite number from t = 0.5 s")
        );
        assert_eq!(value["end_time"], Value::Null);
        assert_eq!(value["columns"]["tip.deflection"]["final"], Value::Null);
        assert_eq!(value["columns"]["tip.deflection"]["max"], 0.0);
    }

    #[test]
    fn an_empty_trajectory_has_columns_without_values() {
        let t = Trajectory::new(vec![channel("tip.deflection", "m")]);
        let report = RunReport { status: Status::Failed, message: Some("singular"), ..report() };
        let s = Summary::of_run(&report, &t);
        assert_eq!(s.get("message"), Some(&json!("singular")));
        assert_eq!(s.get("columns").unwrap()["tip.deflection"]["min"], Value::Null);
    }
}
