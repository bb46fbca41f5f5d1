//! The layout of a case file, and the case in SI that comes out of it.

use super::basis::{self, Bases, Basis};
use super::blade::{self, Blade};
use super::declaration::{
    Bound::*, Key, Kind, Presence as Default, Presence::*, Seam, Type, Type::Quantity, key,
};
use super::initial::{self, Initial};
use super::integrator::{self, Integrator};
use super::load_trial;
use super::loads::{self, Loads};
use super::motion::{self, Motion};
use super::problem::{Problem, Problems};
use super::section::{self, Section};
use super::torque;
use super::trial;
use super::units::{INERTIA, LENGTH, TIME};
use super::values::{Filled, Value, Values};
use std::path::Path;

/// A validated case: everything in SI.
#[derive(Clone, Debug, PartialEq)]
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
    pub loads: Loads,
    /// The state at t = 0.
    pub initial: Initial,
    /// The integrator.
    pub integrator: Integrator,
    /// Duration of the run \[s\].
    pub duration: f64,
    /// What is recorded.
    pub output: Output,
}

/// The hub, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Hub {
    /// Radius a \[m\].
    pub radius: f64,
    /// Moment of inertia about the axis [kg·m²].
    pub inertia: f64,
    /// Its motion: prescribed, or free.
    pub motion: Motion,
}

/// The kinematic model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coupling {
    /// No foreshortening.
    Zeroth,
    /// Foreshortening to first order.
    First,
    /// Foreshortening to every order in the kinetic energy.
    High,
    /// Geometrically exact.
    Exact,
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

static COUPLING: Seam = Seam {
    name: "coupling",
    path: "model.coupling",
    summary: "kinematic model of the beam",
    kinds: &[
        Kind {
            name: "zeroth",
            summary: "no foreshortening: softens falsely and diverges at high speed, for comparison only",
            source: "the conventional model of Kane, Ryan & Banerjee 1987, doi:10.2514/3.20195",
            keys: &[],
        },
        Kind {
            name: "first",
            summary: "foreshortening to first order: linear with dynamic stiffening, small deflections",
            source: "Kane, Ryan & Banerjee 1987, doi:10.2514/3.20195",
            keys: &[],
        },
        Kind {
            name: "high",
            summary: "foreshortening to every order in the kinetic energy: nonlinear, moderate deflections",
            source: "Li, Zhang & Hong 2013, Journal of Mechanical Engineering 49(13) 77–84",
            keys: &[],
        },
        Kind {
            name: "exact",
            summary: "geometrically exact, without shear: any deflection",
            source: "Simo & Vu-Quoc 1986, doi:10.1115/1.3171870",
            keys: &[],
        },
    ],
};

/// The seams, in the order of a case file.
pub(super) static SEAMS: &[&Seam] = &[
    &section::SEAM,
    &motion::SEAM,
    &torque::TORQUES,
    &torque::CONTROLLERS,
    &loads::AXES,
    &loads::AMPLITUDE,
    &loads::DISTRIBUTION,
    &blade::STRAIN_ENERGY,
    &COUPLING,
    &basis::SEAM,
    &basis::FIELD,
    &initial::SEAM,
    &integrator::SEAM,
];

/// The keys of a case file.
pub(super) static KEYS: &[Key] = &[
    key("title", Type::Text, Default::Name(""), "title for plots and reports"),
    key(
        "beam",
        Type::Table(&[key("length", Quantity(&LENGTH, Positive), Required, "length L of the beam")]),
        Required,
        "beam itself",
    ),
    key("section", Type::Kind(&section::SEAM), Required, "cross-section"),
    key(
        "hub",
        Type::Table(&[
            key(
                "radius",
                Quantity(&LENGTH, NotNegative),
                Default::Number(0.0),
                "radius a, where the beam is clamped",
            ),
            key(
                "inertia",
                Quantity(&INERTIA, NotNegative),
                Default::Number(0.0),
                "moment of inertia of the hub about its axis",
            ),
            key("motion", Type::Kind(&motion::SEAM), Required, "rotation of the hub: prescribed, or free"),
        ]),
        Required,
        "hub and its motion",
    ),
    key(
        "blade",
        Type::Table(blade::KEYS),
        Optional,
        "makes the beam a blade, which also bends out of the plane and twists",
    ),
    key(
        "model",
        Type::Table(&[key(
            "coupling",
            Type::Choice(&COUPLING),
            Default::Name("first"),
            "kinematic model of the beam",
        )]),
        Default::Empty,
        "model of the beam",
    ),
    key("basis", Type::Kind(&basis::SEAM), Default::Name("finite-elements"), "basis of the displacements"),
    loads::GRAVITY,
    loads::MASSES,
    loads::FORCES,
    loads::COUPLES,
    loads::DISTRIBUTED,
    loads::DAMPING,
    key("initial", Type::Kind(&initial::SEAM), Default::Name("undeformed"), "state at the start"),
    key("integrator", Type::Kind(&integrator::SEAM), Default::Name("radau"), "integrator"),
    key(
        "run",
        Type::Table(&[key(
            "duration",
            Quantity(&TIME, NotNegative),
            Required,
            "simulated time; 0 for the initial state alone",
        )]),
        Required,
        "extent of the run",
    ),
    key(
        "output",
        Type::Table(&[
            key(
                "step",
                Quantity(&TIME, Positive),
                Optional,
                "interval between records, a thousandth of the duration if left out",
            ),
            key(
                "stations",
                Type::Quantities(&LENGTH, NotNegative),
                Default::Empty,
                "stations along the beam, from the root, recorded besides the tip",
            ),
            key(
                "section-forces",
                Type::Boolean,
                Default::Boolean(false),
                "axial force, shear force and bending moment are recorded at the stations",
            ),
            key(
                "strain-heights",
                Type::Quantities(&LENGTH, Any),
                Default::Empty,
                "heights over the axis at which the strain is recorded at the stations",
            ),
            key(
                "energy-balance",
                Type::Boolean,
                Default::Boolean(true),
                "work, losses and the balance of energy are recorded, for an evaluation or more of the power a step",
            ),
            key(
                "vtk",
                Type::Boolean,
                Default::Boolean(false),
                "the shape of the beam is written too, for ParaView: beam.pvd",
            ),
            key(
                "vtk-step",
                Quantity(&TIME, Positive),
                Optional,
                "interval between shapes, rounded to records, 200 shapes if left out",
            ),
        ]),
        Default::Empty,
        "recording of results",
    ),
];

/// Checks the values across their keys and makes the case; `None` only when there are problems.
pub(super) fn case(values: &mut Values, folder: &Path, problems: &mut Problems) -> Option<Case> {
    let run_duration = values.table("run").and_then(|run| run.number("duration"));
    fill_output_step(values, run_duration);
    let length = values.table("beam").and_then(|beam| beam.number("length"));
    let coupling = values.table("model").and_then(|model| model.text("coupling")).map(|name| match name {
        "zeroth" => Coupling::Zeroth,
        "high" => Coupling::High,
        "exact" => Coupling::Exact,
        _ => Coupling::First,
    });
    let section =
        values.kind("section").and_then(|(kind, v)| section::read(kind, v, "section", folder, problems));
    let motion = values.table("hub").and_then(|hub| hub.kind("motion"));
    let motion = motion.and_then(|(kind, v)| motion::read(kind, v, folder));
    trial::motion(motion.as_ref(), run_duration, values, problems);
    let bases = values.kind("basis").and_then(|(kind, v)| basis::read(kind, v));
    let exact_elements = match (coupling, bases.as_ref().map(|bases| &bases.transverse)) {
        (Some(Coupling::Exact), Some(Basis::FiniteElements { elements, .. })) => Some(*elements),
        _ => None,
    };
    trial::section(section.as_ref(), length, exact_elements, values, problems);
    let integrator = values.kind("integrator").and_then(|(kind, v)| integrator::read(kind, v));
    trial::integrator(integrator.as_ref(), values, problems);
    let loads = loads::read(values);
    load_trial::loads(&loads, (length, run_duration), integrator.as_ref(), values, problems);
    let initial = values.kind("initial").and_then(|(kind, v)| initial::read(kind, v, folder, problems));
    let output = values.table("output");
    let stations = output.and_then(|output| output.numbers("stations")).map(<[f64]>::to_vec);
    let section_forces = output.and_then(|output| output.boolean("section-forces"));
    let strain_heights = output.and_then(|output| output.numbers("strain-heights")).map(<[f64]>::to_vec);
    let energy_balance = output.and_then(|output| output.boolean("energy-balance"));
    let output_step = output.and_then(|output| output.number("step"));

    if let (Some(length), Some(stations), Some(output)) = (length, &stations, output) {
        for station in stations.iter().filter(|station| **station > length) {
            let message = format!("the station {station} m lies beyond the end of the beam at {length} m");
            problems.push(Problem::new("output.stations", output.place("stations"), message));
        }
    }
    if let (Some(duration), Some(step), Some(output)) = (run_duration, output_step, output)
        && step > duration
        && duration > 0.0
    {
        let message = format!("the output step {step} s is longer than the run of {duration} s");
        problems.push(Problem::new("output.step", output.place("step"), message));
    }
    if let (Some(duration), Some(step), Some(output)) = (run_duration, output_step, output)
        && duration / step > MOST_RECORDS
    {
        let message = format!(
            "the output step {step} s makes {:.1e} records in {duration} s; at most {MOST_RECORDS:.0e} are kept",
            duration / step
        );
        problems.push(Problem::new("output.step", output.place("step"), message));
    }
    let vtk = output.filter(|output| output.boolean("vtk") == Some(true));
    let vtk = vtk.zip(run_duration).map(|(output, duration)| {
        let interval = output.number("vtk-step").unwrap_or(if duration > 0.0 { duration / SHAPES } else { ONE });
        let mut refuse = |message| {
            problems.push(Problem::new("output.vtk-step", output.place("vtk-step"), message));
        };
        if interval > duration && duration > 0.0 {
            refuse(format!("the interval {interval} s between shapes is longer than the run of {duration} s"));
        }
        if duration / interval > MOST_SHAPES {
            let shapes = duration / interval;
            refuse(format!(
                "the interval {interval} s makes {shapes:.1e} shapes in {duration} s; at most {MOST_SHAPES:.0e} are kept"
            ));
        }
        interval
    });
    if let (Some(duration), Some(step), Some((_, v))) =
        (run_duration, integrator.as_ref().and_then(Integrator::step), values.kind("integrator"))
        && step > duration
        && duration > 0.0
    {
        let message = format!("the step {step} s is longer than the run of {duration} s");
        problems.push(Problem::new("integrator.step", v.place("step"), message));
    }
    if let (Some(duration), Some(step), Some((_, v))) =
        (run_duration, integrator.as_ref().and_then(Integrator::step), values.kind("integrator"))
        && duration / step > MOST_STEPS
    {
        let message = format!(
            "the step {step:e} s makes {:.1e} steps in {duration} s; at most {MOST_STEPS:.0e} can be run",
            duration / step
        );
        problems.push(Problem::new("integrator.step", v.place("step"), message));
    }
    if let (Some(Coupling::Exact), Some(bases), Some((kind, v))) = (coupling, &bases, values.kind("basis")) {
        let elements = |basis: &Basis| match basis {
            Basis::FiniteElements { elements, .. } => Some(*elements),
            _ => None,
        };
        if elements(&bases.axial).is_none() || elements(&bases.axial) != elements(&bases.transverse) {
            let message = format!(
                "the exact coupling describes the whole curve of the beam by one Hermite field and cannot use the basis `{}`",
                kind.name
            );
            problems.push(Problem::new("basis", v.place.clone(), message).help(
                "write `kind = \"finite-elements\"` and the number of elements, or use the coupling `first`",
            ));
        }
    } else {
        trial::bases(bases.as_ref(), coupling, length, values, problems);
    }
    let blade = values.table("blade").map(blade::read);
    trial::blade(blade.as_ref().and_then(Option::as_ref), section.as_ref(), length, values, problems);
    let hub = values.table("hub");
    Some(Case {
        title: values.text("title")?.to_owned(),
        length: length?,
        section: section?,
        hub: Hub { radius: hub?.number("radius")?, inertia: hub?.number("inertia")?, motion: motion? },
        blade: match blade {
            Some(blade) => Some(blade?),
            None => None,
        },
        coupling: coupling?,
        bases: bases?,
        loads,
        initial: initial?,
        integrator: integrator?,
        duration: run_duration?,
        output: Output {
            step: output_step?,
            stations: stations?,
            section_forces: section_forces?,
            strain_heights: strain_heights?,
            energy_balance: energy_balance?,
            vtk,
        },
    })
}

/// Writes the default of the output step, which depends on the duration, into the values.
fn fill_output_step(values: &mut Values, duration: Option<f64>) {
    let output = values.entries.iter_mut().find(|filled| filled.key.name == "output");
    if let (Some(Filled { key, value: Value::Table(output), .. }), Some(duration)) = (output, duration)
        && output.number("step").is_none()
        && let Type::Table(keys) = key.takes
        && let Some(key) = keys.iter().find(|key| key.name == "step")
    {
        let step = if duration > 0.0 { duration / 1000.0 } else { ONE };
        output.entries.insert(0, Filled { key, value: Value::Number(step), place: None });
    }
}
