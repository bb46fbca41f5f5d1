//! A run.

use crate::request::Request;
use crate::work::{Progress, Work, rejected};
use flexion_case::{Effort, Reading, RefineError, Request as Asked, Run, Stage};
use flexion_results::{Arrays, Numbers, write_events};
use serde_json::{Map, Value, json};
use std::cell::Cell;

/// Runs the case.
pub(crate) fn run(request: &Request, progress: &mut Progress<'_>) -> Result<Value, String> {
    let reading = match request.read() {
        Ok(reading) => reading,
        Err(problems) => return Ok(rejected(&problems)),
    };
    let end = reading.case.duration;
    let effort = match request.option("errors") {
        None | Some(Value::Bool(false)) => None,
        Some(Value::Bool(true)) => Some(Effort::Auto),
        Some(Value::String(text)) if text == "full" => Some(Effort::Full),
        Some(_) => return Err("`errors` is true, false or \"full\"".to_owned()),
    };
    let until = request.option("until").and_then(Value::as_f64).unwrap_or(f64::INFINITY);
    let mut work = Work::new(request.work, progress);
    let unknowns = reading.case.system().map_or(1, |system| system.size().v.max(1)) as f64;
    let prepared = reading
        .prepare_watched(&mut |factor| work.add(unknowns, || json!({ "phase": "start", "factor": factor })));
    let mut prepared = match prepared {
        Ok(prepared) => prepared,
        Err(problems) => {
            let mut reply = rejected(&problems);
            if let Some(why) = work.given_up {
                reply["status"] = "given-up".into();
                reply["message"] = why.into();
            }
            return Ok(reply);
        }
    };
    if !request.is("scene", true) {
        prepared = prepared.without_pictures();
    }
    let asked = Asked { until, effort, target: None };
    let (last, number) = (Cell::new(0.0), Cell::new(1));
    let calculated = reading.calculate(prepared, &asked, &mut |stage| match stage {
        Stage::Search(factor) => work.add(unknowns, || json!({ "phase": "start", "factor": factor })),
        Stage::Time(t) => {
            // A companion or a refined run begins.
            if t < last.get() {
                number.set(number.get() + 1);
            }
            last.set(t);
            let phase = if number.get() == 1 { "run" } else { "errors" };
            work.add(unknowns, || json!({ "phase": phase, "run": number.get(), "time": t, "end": end }))
        }
        Stage::Refined(rung) => {
            work.add(0.0, || json!({ "phase": "refined", "case": rung.changes, "error": rung.error }))
        }
    });
    match calculated {
        Ok(of) => Ok(told(request, &of.reading, &of.run, of.refused.as_deref(), &work)),
        Err(RefineError::Case(problems)) => Ok(rejected(&problems)),
        Err(error) => Err(error.to_string()),
    }
}

/// What a run gave.
fn told(request: &Request, reading: &Reading, run: &Run, refused: Option<&str>, work: &Work<'_>) -> Value {
    let summary = reading.summary(run);
    let status = work.status(summary.status());
    let message = summary.get("message").and_then(Value::as_str).map(str::to_owned);
    let events = (!run.events.is_empty()).then(|| {
        let mut text = Vec::new();
        let written = write_events(&run.events, &mut text);
        written.map_or(Value::Null, |()| String::from_utf8_lossy(&text).into())
    });
    let results = if run.trajectory.is_empty() { None } else { reading.view(run).ok() };
    let mut reply = json!({
        "status": status,
        "message": work.given_up.clone().or(message),
        "refused": refused,
        "problems": [],
        "results": results,
        "summary": summary.entries(),
        "warnings": run.all_warnings().collect::<Vec<_>>(),
        "events": events,
    });
    if request.is("columns", false) {
        reply["columns"] = columns(run).into();
    }
    reply
}

/// Every recorded value, in double precision.
fn columns(run: &Run) -> Map<String, Value> {
    let (trajectory, mut all) = (&run.trajectory, Map::new());
    let rows = trajectory.len() as u64;
    // To a page nothing is refused.
    let _ = all.put("time", &[rows], Numbers::Double(trajectory.times()));
    for (i, channel) in trajectory.channels().iter().enumerate() {
        let values: Vec<f64> = trajectory.values(i).collect();
        let _ = all.put(&channel.name, &[rows], Numbers::Double(&values));
    }
    all
}
