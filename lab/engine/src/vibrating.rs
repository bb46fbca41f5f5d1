//! Modes of vibration, their diagram over speeds, and equilibria under growing loads.

use crate::request::Request;
use crate::work::{Found, Progress, Work, refused, rejected, unknowns};
use flexion::analysis::path::Plan;
use flexion_case::{
    Diagram, DiagramRequest, Effort, FoundModes, ModesRequest, Reading, Speed, Speeds, StaticsError,
    StaticsRequest, VibrationError, Wanted,
};
use flexion_results::view_modes;
use flexion_results::{
    Frequencies, LoadPath, campbell_json, modes_json, put_campbell, put_modes, put_statics, statics_json,
};
use serde_json::{Map, Value, json};
use std::sync::Mutex;

/// Work of the modes at one speed of a diagram, over the unknowns; the same of an equilibrium on a path.
const SPEED: f64 = 50.0;
const POINT: f64 = 10.0;
/// Work of ten modes at one speed with those of the finer mesh that their errors take, over the unknowns: as it was measured, from 90 to 230 at rest
/// and from 160 to 440 in rotation.
const TEN_MODES: f64 = 400.0;
/// Modes at most.
const MOST: f64 = 1000.0;

/// A whole number from `least` to `most`.
fn count(request: &Request, name: &str, usual: usize, least: f64, most: f64) -> Found<usize> {
    match request.option(name) {
        None => Ok(usual),
        Some(value) => match value.as_f64() {
            Some(x) if x.fract() == 0.0 && (least..=most).contains(&x) => Ok(x as usize),
            _ => Err(refused(format!("`{name}` is a whole number from {least} to {most}"))),
        },
    }
}

fn positive(request: &Request, name: &str, usual: f64) -> Found<f64> {
    match request.option(name) {
        None => Ok(usual),
        Some(value) => match value.as_f64() {
            Some(x) if x > 0.0 => Ok(x),
            _ => Err(refused(format!("`{name}` is a positive number"))),
        },
    }
}

/// The units that are asked for.
fn wanted(request: &Request) -> Found<Wanted> {
    let named = |name: &str| match request.option(name) {
        None => Ok(None),
        Some(value) => match value.as_str().and_then(Frequencies::named) {
            Some(unit) => Ok(Some(unit)),
            None => Err(refused(format!("`{name}` is one of rad/s, Hz, rpm"))),
        },
    };
    let (both, speed, frequency) = (named("unit")?, named("speed-unit")?, named("frequency-unit")?);
    Ok(Wanted { both, speed, frequency, dimensionless: request.is("dimensionless", false) })
}

/// The reply to a case without modes.
fn none(error: &VibrationError) -> Value {
    match error {
        VibrationError::Case(problems) => rejected(problems),
        error => json!({ "status": "failed", "message": error.to_string(), "problems": [] }),
    }
}

/// Modes at one speed.
pub(crate) fn modes(request: &Request, reading: &Reading) -> Found<FoundModes> {
    let speed = match request.option("speed") {
        None => Speed::Plain(0.0),
        Some(Value::String(text)) => Speed::read(text).map_err(refused)?,
        Some(value) => Speed::Plain(value.as_f64().ok_or_else(|| refused("`speed` is a number or a text"))?),
    };
    let units = wanted(request)?.units(&reading.case, speed).map_err(|error| none(&error))?;
    let asked = ModesRequest {
        speed: speed.in_radians(&units.speed),
        count: count(request, "count", 10, 1.0, MOST)?,
        free_hub: request.is("free-hub", false),
        units,
        film: false,
    };
    allowed(request, TEN_MODES * (asked.count as f64 / 10.0).max(1.0) * unknowns(reading))?;
    reading.modes(&asked).map_err(|error| none(&error))
}

/// Modes as a page shows them.
pub(crate) fn told_modes(reading: &Reading, found: &FoundModes) -> Value {
    let FoundModes { request, modes, stations, axes, scene, about, warnings, .. } = found;
    let table = modes_json(modes, request.speed, &request.units, reading.title(), warnings);
    let (mut drawn, mut shapes) = (Map::new(), Map::new());
    // To a page nothing is refused.
    let _ = scene
        .put(&mut drawn)
        .and_then(|()| put_modes(&mut shapes, &modes.modes, stations, &request.units.frequency));
    json!({
        "status": "finished", "about": about, "axes": axes, "warnings": warnings, "problems": [],
        "summary": table, "results": view_modes(&reading.case.title, table.clone(), drawn, shapes),
    })
}

/// Modes over speeds.
pub(crate) fn campbell(request: &Request, reading: &Reading, progress: &mut Progress<'_>) -> Found<Diagram> {
    let text = request.option("speeds").and_then(Value::as_str).unwrap_or_default();
    let speeds = Speeds::read(text).map_err(refused)?;
    let units = wanted(request)?.units(&reading.case, speeds.to).map_err(|error| none(&error))?;
    let margin = request.option("margin").map_or(Some(5.0), Value::as_f64);
    let margin = margin.filter(|percent| (0.0..100.0).contains(percent));
    let asked = DiagramRequest {
        speeds: speeds.in_radians(&units.speed),
        count: count(request, "modes", 6, 1.0, MOST)?,
        revolutions: count(request, "revolutions", 4, 0.0, MOST)? as u32,
        margin: margin.ok_or_else(|| refused("`margin` is a number of percent from 0 to less than 100"))?,
        free_hub: request.is("free-hub", false),
        threads: 1,
        units,
    };
    allowed(request, SPEED * unknowns(reading))?;
    let (of, unknowns) = (asked.speeds.len(), unknowns(reading));
    let work = Mutex::new(Work::new(request.work, progress));
    let watched = |done: usize, part: f64| {
        let Ok(mut work) = work.lock() else { return false };
        work.add(part * SPEED * unknowns, || json!({ "phase": "campbell", "speeds": done, "of": of }))
            .is_continue()
    };
    let found = reading.campbell(&asked, &watched);
    let given_up = work.into_inner().ok().and_then(|work| work.given_up);
    found.map_err(|error| match given_up {
        Some(why) => json!({ "status": "given-up", "message": why, "problems": [] }),
        None => none(&error),
    })
}

/// A diagram as a page shows it.
pub(crate) fn told_campbell(request: &Request, found: &Diagram) -> Value {
    let Diagram { request: asked, campbell, resonances, stations, warnings, incomplete } = found;
    let mut curves = Map::new();
    let shapes = request.is("scene", false).then_some(stations.as_slice());
    // To a page nothing is refused.
    let _ = put_campbell(&mut curves, campbell, &asked.units, shapes);
    let moves = |branch: &flexion::analysis::campbell::Branch| {
        branch.points.first().map(|point| point.mode.shares.dominant())
    };
    // Its work ended it, and no user.
    let message = incomplete.first().map(|why| why.trim_start_matches("stopped by the user: "));
    json!({
        "status": if incomplete.is_empty() { "finished" } else { "given-up" },
        "message": message, "problems": [], "warnings": warnings,
        "moves": campbell.branches.iter().map(moves).collect::<Vec<_>>(),
        "summary": campbell_json(campbell, resonances, &asked.units, warnings),
        "results": { "version": flexion_results::VERSION, "curves": curves },
    })
}

/// Equilibria under growing loads, and why they were given up, if they were.
pub(crate) fn statics(
    request: &Request,
    reading: &Reading,
    progress: &mut Progress<'_>,
) -> Found<(LoadPath, Option<String>)> {
    let plan = Plan {
        points: count(request, "points", 1000, 2.0, 1e6)?,
        longest: positive(request, "step", 0.05)?,
        ..Plan::to(positive(request, "to", 1.0)?)
    };
    let asked = StaticsRequest { plan, effort: request.is("errors", true).then_some(Effort::Auto) };
    allowed(request, SPEED * unknowns(reading))?;
    let (mut work, unknowns) = (Work::new(request.work, progress), unknowns(reading));
    let found = reading.statics(&asked, &mut |points, factor| {
        work.add(POINT * unknowns, || json!({ "phase": "statics", "points": points, "factor": factor }))
            .is_continue()
    });
    let found = found.map_err(|error| match error {
        StaticsError::Case(problems) => rejected(&problems),
        error => json!({ "status": "failed", "message": error.to_string(), "problems": [] }),
    })?;
    Ok((found, work.given_up))
}

/// A path as a page shows it.
pub(crate) fn told_statics((path, given_up): &(LoadPath, Option<String>)) -> Value {
    let mut curves = Map::new();
    // To a page nothing is refused.
    let _ = put_statics(&mut curves, path);
    let channel = |channel: &flexion::system::Channel| json!({ "name": channel.name, "unit": channel.unit, "role": channel.role.name() });
    let (status, message) = match (given_up, &path.end) {
        (Some(why), Some(_)) => ("given-up", Some(why)),
        (None, Some(end)) => ("failed", Some(end)),
        // It was whole when its work ended, and lacks its errors alone.
        (why, None) => ("finished", why.as_ref().filter(|_| path.unknown.is_some())),
    };
    json!({
        "status": status, "message": message, "problems": [], "warnings": path.cautions,
        "columns": path.channels.iter().map(channel).collect::<Vec<_>>(),
        "summary": statics_json(path, &path.cautions),
        "results": { "version": flexion_results::VERSION, "curves": curves },
    })
}

/// Refuses what takes more work than is allowed.
fn allowed(request: &Request, work: f64) -> Found<()> {
    if work <= request.work {
        return Ok(());
    }
    Err(json!({ "status": "given-up", "message": "this takes more work than is allowed", "problems": [] }))
}
