//! A run.

use crate::request::Request;
use crate::work::{Found, Progress, Work, refused, rejected, unknowns};
use flexion::system::{Channel, Role};
use flexion_case::{
    Calculation, Effort, Prepared, Reading, RefineError, Request as Asked, Run, Shown, Stage,
};
use flexion_results::{Arrays, Numbers, Status, write_events};
use serde_json::{Map, Value, json};
use std::cell::RefCell;
use std::rc::Rc;

/// A run, and why it was given up, if it was.
pub(crate) struct Ran<'r> {
    pub of: Calculation<'r>,
    given_up: Option<String>,
}

/// Runs the case and tells what it gave.
pub(crate) fn run(request: &Request, reading: &Reading, progress: &mut Progress<'_>) -> Found<Value> {
    calculate(request, reading, progress).map(|ran| told(request, &ran))
}

/// Runs the case.
pub(crate) fn calculate<'r>(
    request: &Request,
    reading: &'r Reading,
    progress: &mut Progress<'_>,
) -> Found<Ran<'r>> {
    let end = reading.case.duration;
    let effort = match request.option("errors") {
        None | Some(Value::Bool(false)) => None,
        Some(Value::Bool(true)) => Some(Effort::Auto),
        Some(Value::String(text)) if text == "full" => Some(Effort::Full),
        Some(_) => return Err(refused("`errors` is true, false or \"full\"")),
    };
    let until = request.option("until").and_then(Value::as_f64).unwrap_or(f64::INFINITY);
    let unknowns = unknowns(reading);
    let mut work = Work::new(request.work, progress);
    let prepared = reading
        .prepare_watched(&mut |factor| work.add(unknowns, || json!({ "phase": "start", "factor": factor })));
    let mut prepared = prepared.map_err(|problems| {
        let mut reply = rejected(&problems);
        if let Some(why) = work.given_up.take() {
            (reply["status"], reply["message"]) = ("given-up".into(), why.into());
        }
        reply
    })?;
    if !request.is("scene", true) {
        prepared = prepared.without_pictures();
    }
    let rows = if request.is("rows", false) { Some(Rows::of(&mut prepared)) } else { None };
    if let Some(rows) = &rows {
        prepared = prepared.with_shown(rows.taking());
    }
    let (mut last, mut number) = (0.0, 1);
    let asked = Asked { until, effort, target: None };
    let of = reading.calculate(prepared, &asked, &mut |stage| match stage {
        Stage::Search(factor) => work.add(unknowns, || json!({ "phase": "start", "factor": factor })),
        Stage::Time(t) => {
            // A companion or a refined run begins.
            number += u32::from(t < last);
            last = t;
            let phase = if number == 1 { "run" } else { "errors" };
            work.add(unknowns, || {
                let rows = rows.as_ref().filter(|_| number == 1).map(Rows::since);
                json!({ "phase": phase, "run": number, "time": t, "end": end, "rows": rows })
            })
        }
        Stage::Refined(rung) => {
            work.add(0.0, || json!({ "phase": "refined", "case": rung.changes, "error": rung.error }))
        }
    });
    let of = of.map_err(|error| match error {
        RefineError::Case(problems) => rejected(&problems),
        error => refused(error.to_string()),
    })?;
    Ok(Ran { of, given_up: work.given_up })
}

/// What a run gave.
fn told(
    request: &Request,
    Ran { of: Calculation { reading, run, refused, .. }, given_up }: &Ran<'_>,
) -> Value {
    let summary = reading.summary(run);
    let status = match (given_up, summary.status()) {
        (Some(_), Status::Stopped) => "given-up",
        (_, status) => status.word(),
    };
    let message = summary.get("message").and_then(Value::as_str).map(str::to_owned);
    let events = (!run.events.is_empty()).then(|| {
        let mut text = Vec::new();
        let written = write_events(&run.events, &mut text);
        written.map_or(Value::Null, |()| String::from_utf8_lossy(&text).into())
    });
    let results = (!run.trajectory.is_empty()).then(|| reading.view(run));
    let mut reply = json!({
        "status": status,
        "message": given_up.clone().or(message),
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

/// The records of a run, as it goes on: its principal columns.
struct Rows {
    channels: Vec<(usize, String)>,
    /// Times and columns since the last notice.
    taken: Rc<RefCell<Vec<Vec<f64>>>>,
}

impl Rows {
    fn of(prepared: &mut Prepared) -> Rows {
        let principal = |(_, channel): &(usize, Channel)| channel.role == Role::Primary;
        let channels = prepared.channels().into_iter().enumerate().filter(principal);
        let channels: Vec<_> = channels.map(|(i, channel)| (i, channel.name)).collect();
        let taken = vec![Vec::new(); channels.len() + 1];
        Rows { channels, taken: Rc::new(RefCell::new(taken)) }
    }

    fn taking(&self) -> Shown {
        let (taken, columns) =
            (Rc::clone(&self.taken), self.channels.iter().map(|of| of.0).collect::<Vec<_>>());
        Box::new(move |time, values| {
            let mut taken = taken.borrow_mut();
            let row = columns.iter().map(|i| values.get(*i).copied().unwrap_or(f64::NAN));
            taken.iter_mut().zip(std::iter::once(time).chain(row)).for_each(|(column, x)| column.push(x));
        })
    }

    /// Those since the last time.
    fn since(&self) -> Map<String, Value> {
        let (mut all, names) = (Map::new(), self.channels.iter().map(|of| of.1.as_str()));
        for (name, values) in std::iter::once("time").chain(names).zip(self.taken.borrow_mut().iter_mut()) {
            // To a page nothing is refused.
            let _ = all.put(name, &[values.len() as u64], Numbers::Double(values));
            values.clear();
        }
        all
    }
}
