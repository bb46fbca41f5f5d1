//! A validated case: what moves, how it is integrated, and what is recorded.

use super::declaration::Type;
use super::fault::{Fault, Faults, Found, Made};
use super::hub_beam::HubBeam;
use super::kind::Context;
use super::kinds::initial::Initial;
use super::kinds::integrator::{Method, Steps};
use super::laws::Signals;
use super::layout::{self, BASIS, INITIAL, INTEGRATOR, OUTPUT, OUTPUT_IN_SPACE, RUN, Recorded, Run, TITLE};
use super::length::length;
use super::places::Parts;
use super::sources::Files;
use super::space::{self, Space};
use super::stations::stations;
use super::values::{Filled, Value, Values};
use std::cell::RefCell;

/// A validated case: each part is built once and shared by all that is made of it.
#[derive(Clone, Debug)]
pub struct Case {
    /// Title for plots and reports.
    pub title: String,
    /// What moves.
    pub subject: Subject,
    /// The state at t = 0.
    pub initial: Initial,
    /// The steps that the integrator takes.
    pub steps: Steps,
    /// Duration of the run, 0 for a case [without one](super::Reading::missing_for_run) \[s\].
    pub duration: f64,
    /// The accuracy to which the run is to be refined: part of the largest value, and column.
    pub accuracy: Option<(f64, Option<String>)>,
    /// What is recorded.
    pub output: Output,
    /// What its reader should know of its parts.
    pub cautions: Vec<String>,
}

/// What moves.
#[derive(Clone, Debug)]
pub enum Subject {
    /// A beam on a hub, in the plane of its rotation.
    HubBeam(Box<HubBeam>),
    /// Bodies, joints and beams in space.
    Space(Box<Space>),
}

/// What is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Interval between records \[s\].
    pub step: f64,
    /// Stations along the beam to be recorded besides the tip \[m\].
    pub stations: Vec<f64>,
    /// Whether axial, shear force and bending moment are recorded at the stations.
    pub section_forces: bool,
    /// Heights over the axis at which the strain is recorded at the stations \[m\].
    pub strain_heights: Vec<f64>,
    /// Whether work, losses and the balance of energy are recorded.
    pub energy_balance: bool,
    /// Whether the shares of the transverse modes are recorded.
    pub modal_shares: bool,
    /// Whether the run is drawn.
    pub plots: bool,
    /// Interval between shapes of the beam for ParaView \[s\]; `None` writes none.
    pub vtk: Option<f64>,
}

/// Largest number of fixed steps of a run.
const MOST_STEPS: f64 = 1e10;

/// Interval between records of a run without duration, which has one [s].
const ONE: f64 = 1.0;

/// Largest number of records of a run.
const MOST_RECORDS: f64 = 1e7;

/// Shapes of a run if nothing else is said, and largest number.
const SHAPES: f64 = 200.0;
const MOST_SHAPES: f64 = 1e4;

/// Makes the parts of a case of its values, and checks them across their keys.
///
/// # Errors
/// All faults of all parts, at dotted paths of the case.
pub(super) fn case(v: &mut Values, files: &Files<'_>, signals: &Signals) -> Made<Case> {
    let mut found = Found::default();
    let cautions = RefCell::default();
    let c = &Context { length: None, duration: None, parts: None, files, cautions: &cautions, signals };
    let run = RUN.read(v, c);
    // A case that gives no duration has no run.
    let duration = run.as_ref().ok().map(|run| run.duration.unwrap_or(0.0));
    fill_output_step(v, duration);
    let v = &*v;
    let in_space = layout::is_spatial(v.keys);
    let length = if in_space { None } else { found.part(length(v, c)) };
    let parts = length.map(|length| Parts { bodies: Vec::new(), beams: vec![("beam".to_owned(), length)] });
    let c = &Context { length, duration, parts: parts.as_ref(), ..*c };
    let method = found.part(INTEGRATOR.read(v, c));
    let subject = found.part(if in_space {
        space::make(v, c, method.as_ref()).map(|space| Subject::Space(Box::new(space)))
    } else {
        super::hub_beam::make(v, c, method.as_ref()).map(|beam| Subject::HubBeam(Box::new(beam)))
    });
    let initial = found.part(INITIAL.read(v, c));
    let output = found.part(output(v, c));
    if let Some(method) = &method {
        check_steps(method, duration, &mut found);
    }
    let accuracy = found.part(run.and_then(accuracy));
    let parts = || {
        Some(Case {
            title: TITLE.read(v, c).ok()?,
            subject: subject?,
            initial: initial?,
            steps: method?.steps,
            duration: duration?,
            accuracy: accuracy?,
            output: output?,
            cautions: cautions.take(),
        })
    };
    match parts() {
        Some(case) if found.0.0.is_empty() => Ok(case),
        _ => {
            // What has an advice of its own, as a name that is unknown, is another matter.
            let unexplained = found.0.0.iter_mut().find(|fault| fault.help.is_none());
            if let (Some(fault), Some(caution)) = (unexplained, suspected(&cautions.take())) {
                fault.help = Some(caution);
            }
            Err(found.0)
        }
    }
}

/// What else may be the cause where something fails: the cautions of the case, in a sentence.
pub(super) fn suspected(cautions: &[String]) -> Option<String> {
    let (first, more) = cautions.split_first()?;
    let intro = if more.is_empty() { "a caution of the case" } else { "cautions of the case" };
    let more: String = more.iter().map(|caution| format!("; {caution}")).collect();
    Some(format!("{intro} may name the cause: {first}{more}"))
}

/// What `[run]` asks of the accuracy.
fn accuracy(run: Run) -> Made<Option<(f64, Option<String>)>> {
    match (run.tolerance, run.quantity) {
        (None, Some(_)) => Err(Fault::new("run.quantity", "is of no use without `run.tolerance`").into()),
        (tolerance, quantity) => Ok(tolerance.map(|tolerance| (tolerance, quantity))),
    }
}

/// Fixed steps within the run.
fn check_steps(method: &Method, duration: Option<f64>, found: &mut Found) {
    if let (Some(step), Some(duration)) = (method.steps.step(), duration) {
        found.check(step > duration && duration > 0.0, "integrator.step", || {
            format!("the step {step} s is longer than the run of {duration} s")
        });
        found.check(duration / step > MOST_STEPS, "integrator.step", || {
            let steps = duration / step;
            format!("the step {step:e} s makes {steps:.1e} steps in {duration} s; at most {MOST_STEPS:.0e} can be run")
        });
    }
    if let (Steps::Controlled { longest: Some(longest), .. }, Some(duration)) = (method.steps, duration) {
        found.check(duration / longest > MOST_STEPS, "integrator.max-step", || {
            let steps = duration / longest;
            format!("steps of {longest:e} s at most make {steps:.1e} steps in {duration} s; at most {MOST_STEPS:.0e} can be run")
        });
    }
}

/// What is recorded, within the run and on the beam.
fn output(v: &Values, c: &Context<'_>) -> Made<Output> {
    let of = if layout::is_spatial(v.keys) {
        let of = OUTPUT_IN_SPACE.read(v, c)?;
        // Stations belong to the beams of a system in space.
        Recorded {
            step: of.step,
            stations: Vec::new(),
            section_forces: false,
            strain_heights: Vec::new(),
            energy_balance: of.energy_balance,
            modal_shares: false,
            plots: of.plots,
            vtk: of.vtk,
            vtk_step: of.vtk_step,
        }
    } else {
        OUTPUT.read(v, c)?
    };
    let mut found = Found::default();
    let stations = found.part(stations(&of.stations, c));
    let heights = &of.strain_heights;
    let twice = heights.iter().enumerate().find(|(i, height)| heights[..*i].contains(height));
    found.check(twice.is_some(), "strain-heights", || "a height is given twice".to_owned());
    let duration = c.duration.unwrap_or(f64::NAN);
    if let Some(step) = of.step {
        found.check(step > duration && duration > 0.0, "step", || {
            format!("the output step {step} s is longer than the run of {duration} s")
        });
        found.check(duration / step > MOST_RECORDS, "step", || {
            let records = duration / step;
            format!("the output step {step} s makes {records:.1e} records in {duration} s; at most {MOST_RECORDS:.0e} are kept")
        });
    }
    found.check(of.modal_shares && BASIS.chosen_in(v) != Some("modes"), "modal-shares", || {
        "only the functions of the basis `modes` are modes: choose it, or leave the shares out".to_owned()
    });
    let mut vtk = None;
    if of.vtk {
        let usual = if duration > 0.0 { duration / SHAPES } else { ONE };
        let interval = of.vtk_step.unwrap_or(usual);
        found.check(interval > duration && duration > 0.0, "vtk-step", || {
            format!("the interval {interval} s between shapes is longer than the run of {duration} s")
        });
        found.check(duration / interval > MOST_SHAPES, "vtk-step", || {
            let shapes = duration / interval;
            format!("the interval {interval} s makes {shapes:.1e} shapes in {duration} s; at most {MOST_SHAPES:.0e} are kept")
        });
        vtk = Some(interval);
    }
    if !found.0.0.is_empty() {
        return Err(found.0.within("output"));
    }
    Ok(Output {
        step: of.step.ok_or_else(Faults::default)?,
        stations: stations.unwrap_or_default().into_iter().map(|(_, station)| station).collect(),
        section_forces: of.section_forces,
        strain_heights: of.strain_heights,
        energy_balance: of.energy_balance,
        modal_shares: of.modal_shares,
        plots: of.plots,
        vtk,
    })
}

/// Writes the default of the output step, which depends on the duration, into the values.
fn fill_output_step(values: &mut Values, duration: Option<f64>) {
    let output = values.entries.iter_mut().find(|filled| filled.key.name == "output");
    if let (Some(Filled { key, value: Value::Table(output), .. }), Some(duration)) = (output, duration)
        && output.entries.iter().all(|filled| filled.key.name != "step")
        && let Type::Table(keys) = key.takes
        && let Some(key) = keys.iter().find(|key| key.name == "step")
    {
        let step = if duration > 0.0 { duration / 1000.0 } else { ONE };
        output.entries.insert(0, Filled { key, value: Value::Number(step), place: None });
    }
}
