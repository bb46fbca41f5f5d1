//! A case, checked.

use crate::keys;
use crate::request::Request;
use crate::work::problems;
use flexion_case::{Given, Reading};
use serde_json::{Value, json};

/// What is wrong with a case, what its reader should know of it, its values, and the work that it takes.
pub(crate) fn check(request: &Request) -> Value {
    let reading = match request.read() {
        Ok(reading) => reading,
        Err(of) => return json!({ "status": "rejected", "message": of.reason(), "problems": problems(&of) }),
    };
    let missing = reading.missing_for_run().err();
    let kind = if missing.is_some() { "modes" } else { "run" };
    let unknowns = reading.case.system().map_or(0, |system| system.size().v);
    let mut warnings =
        if missing.is_some() { reading.case.cautions.clone() } else { reading.case.unused_by_run() };
    warnings.dedup();
    json!({
        "status": "valid",
        "problems": [],
        "missing": missing.as_ref().map(problems),
        "warnings": warnings,
        "kind": kind,
        "title": reading.case.title,
        "subject": if reading.case.space().is_some() { "space" } else { "hub-beam" },
        "duration": reading.case.duration,
        "unknowns": unknowns,
        "work": missing.is_none().then(|| work(&reading, unknowns)),
        "tables": reading.given().iter().map(|given| entry(request, given)).collect::<Vec<_>>(),
    })
}

/// Steps times unknowns of a run, as far as they can be told: with controlled steps there is one a record, at least.
fn work(reading: &Reading, unknowns: usize) -> f64 {
    let case = &reading.case;
    let step = case.steps.step().map_or(case.output.step, |step| step.min(case.output.step));
    case.duration / step * unknowns as f64
}

/// A value of the case, for a form.
fn entry(request: &Request, given: &Given<'_>) -> Value {
    let written = given.place.as_ref().filter(|place| place.source == 0);
    let mut all = keys::key(given.key);
    all["path"] = given.path.as_str().into();
    all["value"] = given.value.as_str().into();
    all["number"] = given.number.into();
    all["written"] = given.written.into();
    all["default"] = given.place.is_none().into();
    all["line"] = written
        .and_then(|place| request.case().get(..place.start))
        .map(|before| before.matches('\n').count() + 1)
        .into();
    all
}
