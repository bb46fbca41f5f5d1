//! A validated case: its parts, and what is checked across them.

use super::declaration::Type;
use super::fault::{Fault, Faults, Made};
use super::kind::{Choice, Context, Table};
use super::kinds::basis::{self, Bases};
use super::kinds::blade::{BLADE, Blade};
use super::kinds::contact::{self, CONTACT, Contact};
use super::kinds::coupling::{COUPLING, Coupling, fits_whole_curve};
use super::kinds::initial::{INITIAL, Initial};
use super::kinds::integrator::{INTEGRATOR, Method, Steps};
use super::kinds::load::{self, LOADS, Load};
use super::kinds::motion::MOTION;
use super::kinds::section::{SECTION, Section};
use super::values::{Filled, Value, Values};
use flexion::hub_beam::{Damping, Drive, Hub};
use std::cell::RefCell;

/// A validated case: the parts of a model, each built once and shared by all that is made of them.
#[derive(Clone, Debug)]
pub struct Case {
    /// Title for plots and reports.
    pub title: String,
    /// Length L of the beam \[m\].
    pub length: f64,
    /// The cross-section.
    pub section: Section,
    /// The hub.
    pub hub: Hub,
    /// What makes the beam a blade; `None` for a beam in the plane of rotation.
    pub blade: Option<Blade>,
    /// The kinematic model.
    pub coupling: Coupling,
    /// The bases of the two displacement fields.
    pub bases: Bases,
    /// What acts on the beam and what it carries.
    pub loads: Vec<Load>,
    /// What the beam may touch.
    pub contacts: Vec<Contact>,
    /// Damping of the beam.
    pub damping: Damping,
    /// The state at t = 0.
    pub initial: Initial,
    /// The steps that the integrator takes.
    pub steps: Steps,
    /// Duration of the run \[s\].
    pub duration: f64,
    /// What is recorded.
    pub output: Output,
    /// What its reader should know of its parts.
    pub cautions: Vec<String>,
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

/// What is wrong with a case, as it is found.
#[derive(Default)]
struct Found(Faults);

impl Found {
    /// The part, or `None`, with its faults noted.
    fn part<T>(&mut self, made: Made<T>) -> Option<T> {
        made.map_err(|faults| self.0.0.extend(faults.0)).ok()
    }

    /// Notes a fault if there is one.
    fn check(&mut self, wrong: bool, key: &str, message: impl FnOnce() -> String) {
        if wrong {
            self.0.0.push(Fault::new(key, message()));
        }
    }
}

/// The number at `key` of the table at `table`.
fn number(v: &Values, table: &str, key: &str) -> Made<f64> {
    v.table(table)?.number(key)
}

/// Makes the parts of a case of its values, and checks them across their keys.
///
/// # Errors
/// All faults of all parts, at dotted paths of the case.
pub(super) fn case(v: &mut Values, files: &super::sources::Files<'_>) -> Made<Case> {
    let mut found = Found::default();
    let duration = number(v, "run", "duration").ok();
    fill_output_step(v, duration);
    let v = &*v;
    let length = number(v, "beam", "length").ok();
    let c = &Context { length, duration, files, cautions: RefCell::default() };
    let coupling = found.part(model(v, &COUPLING, c));
    let section = found.part(SECTION.make(v, "section", c));
    let hub = found.part(hub(v, c));
    let method = found.part(INTEGRATOR.make(v, "integrator", c));
    let loads = loads(v, c, &mut found);
    let jumps = section.iter().flat_map(|section| section.planar.jumps().iter().copied());
    let acting = loads.iter().flatten().flat_map(|load| load.nodes.iter().copied());
    let bases = found.part(basis::make(v, c, &jumps.chain(acting).collect::<Vec<_>>()));
    let contacts = found.part(CONTACT.make(v, c).and_then(contact::named));
    let damping = found.part(load::DAMPING.make(v, c)).map(|list| list.first().copied().unwrap_or_default());
    let initial = found.part(INITIAL.make(v, "initial", c));
    let output = found.part(output(v, c));
    let blade = found.part(BLADE.make(v, c)).map(|list| list.into_iter().next());
    if let (Some(method), Some(damping)) = (&method, damping) {
        check_steps(method, damping, duration, &mut found);
    }
    if let (Some(coupling), Some(bases)) = (coupling, &bases)
        && coupling.whole_curve
    {
        let name = v.kind("basis").unwrap_or_default();
        found.part(fits_whole_curve(bases, name));
    }
    if let (Some(coupling), Some(bases), Some(section), Some(loads), Some(contacts), Some(length)) =
        (coupling, &bases, &section, &loads, &contacts, c.length)
    {
        let at_tip = |load: &Load| load.mass.is_some_and(|mass| mass.station == length);
        let has_mass = [
            (coupling.whole_curve, "the exact coupling needs it: use `first` or `high`"),
            (
                bases.massless.is_none(),
                "no function of this basis moves the tip alone: use finite elements or modes",
            ),
            (section.planar.resultants(length).rotary_inertia != 0.0, "the section has rotary inertia"),
            (loads.iter().any(at_tip), "a mass is fixed there"),
        ];
        let why_not = has_mass.iter().find(|(has, _)| *has).map(|(_, why)| *why);
        found.part(contact::fits_massless(contacts, why_not));
    }
    if let (Some(Some(blade)), Some(section)) = (&blade, &section) {
        found.part(blade.built(section, 0.0).map_err(|faults| faults.within("blade")));
    }
    let parts = || {
        Some(Case {
            title: v.text("title").ok()?.to_owned(),
            length: c.length?,
            section: section?,
            hub: hub?,
            blade: blade?,
            coupling: coupling?,
            bases: bases?,
            loads: loads?,
            contacts: contacts?,
            damping: damping?,
            initial: initial?,
            steps: method?.steps,
            duration: duration?,
            output: output?,
            cautions: c.cautions.take(),
        })
    };
    match parts() {
        Some(case) if found.0.0.is_empty() => Ok(case),
        _ => Err(found.0),
    }
}

fn model<T>(v: &Values, choice: &Choice<T>, c: &Context<'_>) -> Made<T> {
    choice.make(v.table("model")?, choice.name, c).map_err(|faults| faults.within("model"))
}

fn hub(v: &Values, c: &Context<'_>) -> Made<Hub> {
    let hub = v.table("hub")?;
    let drive: Drive = MOTION.make(hub, "motion", c).map_err(|faults| faults.within("hub"))?;
    Ok(Hub { radius: hub.number("radius")?, inertia: hub.number("inertia")?, drive })
}

fn loads(v: &Values, c: &Context<'_>, found: &mut Found) -> Option<Vec<Load>> {
    let named = |table: &Table<Load>| {
        let made = table.make(v, c);
        made.map(|list| {
            list.into_iter().map(|load| Load { table: table.key.name, ..load }).collect::<Vec<_>>()
        })
    };
    let made: Vec<_> = LOADS.iter().map(|table| found.part(named(table))).collect();
    let lists: Option<Vec<Vec<Load>>> = made.into_iter().collect();
    lists.map(|lists| lists.concat())
}

/// Fixed steps within the run, and damping that the method can follow.
fn check_steps(method: &Method, damping: Damping, duration: Option<f64>, found: &mut Found) {
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
    let overdamped = !method.integrator.info().implicit && damping.stiffness > 0.0;
    found.check(overdamped, "damping.stiffness-proportional", || {
        "damping in proportion to the stiffness overdamps the shortest waves, and no explicit method follows them: use \
         an implicit one, `radau` or `generalized-alpha`"
            .to_owned()
    });
}

/// What is recorded, within the run and on the beam.
fn output(v: &Values, c: &Context<'_>) -> Made<Output> {
    let output = v.table("output")?;
    let stations = output.numbers("stations").unwrap_or_default();
    let mut found = Found::default();
    for &station in stations {
        found.part(c.on_beam(station, "stations"));
    }
    let (step, duration) = (output.optional_number("step")?, c.duration.unwrap_or(f64::NAN));
    if let Some(step) = step {
        found.check(step > duration && duration > 0.0, "step", || {
            format!("the output step {step} s is longer than the run of {duration} s")
        });
        found.check(duration / step > MOST_RECORDS, "step", || {
            let records = duration / step;
            format!("the output step {step} s makes {records:.1e} records in {duration} s; at most {MOST_RECORDS:.0e} are kept")
        });
    }
    let modal_shares = output.boolean("modal-shares")?;
    found.check(modal_shares && v.kind("basis") != Some("modes"), "modal-shares", || {
        "only the functions of the basis `modes` are modes: choose it, or leave the shares out".to_owned()
    });
    let mut vtk = None;
    if output.boolean("vtk") == Ok(true) {
        let usual = if duration > 0.0 { duration / SHAPES } else { ONE };
        let interval = output.optional_number("vtk-step")?.unwrap_or(usual);
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
        step: step.ok_or_else(Faults::default)?,
        stations: output.numbers("stations")?.to_vec(),
        section_forces: output.boolean("section-forces")?,
        strain_heights: output.numbers("strain-heights")?.to_vec(),
        energy_balance: output.boolean("energy-balance")?,
        modal_shares,
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
