//! The layout of a case file: its keys, and the choices in them.

use super::declaration::{Bound::*, Key, Kinds, Presence as Default, Presence::*, Type, Type::Quantity, key};
use super::kinds::basis::{BASIS, FIELD};
use super::kinds::coupling::COUPLING;
use super::kinds::initial::INITIAL;
use super::kinds::integrator::INTEGRATOR;
use super::kinds::motion::MOTION;
use super::kinds::section::SECTION;
use super::kinds::{
    amplitude, beam, blade, body, contact, damping, force_law, joint, load, mass, obstacle, rotation, spring,
    torque,
};
use super::tree::{Line, Raw};
use super::units::{ACCELERATION, INERTIA, LENGTH, TIME};
use std::sync::LazyLock;

/// The choices, in the order of a case file.
pub(super) static CHOICES: &[&dyn Kinds] = &[
    &SECTION,
    &MOTION,
    &torque::TORQUE_ON_HUB,
    &torque::CONTROLLER,
    &load::AXES,
    &amplitude::AMPLITUDE,
    &amplitude::DISTRIBUTION,
    &force_law::FORCE_LAW,
    &obstacle::OBSTACLE,
    &contact::MOUNT,
    &contact::LAW,
    &spring::SPRING_KIND,
    &blade::STRAIN_ENERGY,
    &COUPLING,
    &BASIS,
    &FIELD,
    &INITIAL,
    &INTEGRATOR,
    &body::INERTIA,
    &beam::CURVE,
    &beam::END,
    &joint::JOINT,
    &joint::TRAVEL,
    &joint::TRAVEL_OF,
];

/// The table that only a case of a beam on a hub has.
const ON_HUB: &str = "hub";

/// The keys of the case with these lines: those of a beam on a hub where `[beam]` is one table, and of a system in space where bodies,
/// joints and beams are lists.
pub(super) fn keys_of(entries: &[Line]) -> &'static [Key] {
    let is_list = |entry: &Line| matches!(entry.node.value, Raw::List(_));
    let beam = entries.iter().find(|entry| entry.key == beam::BEAMS.key.name);
    let named = |entry: &Line| [body::BODY.key.name, joint::JOINTS.key.name].contains(&entry.key.as_str());
    let in_space = beam.map_or_else(|| entries.iter().any(named), is_list);
    if in_space { spatial_keys() } else { keys() }
}

/// Whether keys are those of a system in space.
pub(super) fn is_spatial(keys: &[Key]) -> bool {
    keys.iter().all(|key| key.name != ON_HUB)
}

/// The tables of a beam on a hub that only a model in space carries.
pub(super) const SPATIAL_TABLES: [Key; 4] =
    [body::BODY.key, joint::JOINTS.key, beam::FIBRES.key, rotation::ROTATION.key];

/// What both have: what acts, what is carried, and what may be touched.
static ACTING: [&Key; 5] =
    [&GRAVITY, &mass::MASS.key, &spring::SPRING.key, &load::LOAD.key, &contact::CONTACT.key];

/// The tables of a system in space, in the order of a case file.
static TABLES: [&Key; 3] = [&body::BODY.key, &beam::BEAMS.key, &joint::JOINTS.key];

/// The keys of a system in space.
pub(super) fn spatial_keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
        let (parts, acting) = (TABLES.map(|key| *key), ACTING.map(|key| *key));
        let more = [beam::FIBRES.key, rotation::ROTATION.key, MODEL];
        [&[TITLE][..], &acting[..1], &parts, &acting[1..], &more, RUN, &[SPATIAL_OUTPUT]].concat()
    });
    &KEYS
}

/// The keys of a beam on a hub.
pub(super) fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
        let acting = ACTING.map(|key| *key);
        let damping = &[damping::DAMPING.key];
        let (all, one) = (&acting[1..], &acting[..1]);
        [&[TITLE], one, PLANAR, all, damping, &SPATIAL_TABLES, RUN, &[OUTPUT]].concat()
    });
    &KEYS
}

/// Gravity, at the top of a case.
pub(super) const GRAVITY: Key = key(
    "gravity",
    Type::Quantities(&ACCELERATION, Any),
    Empty,
    "acceleration of gravity along x, y and z, none if left out; z may be left out",
);

const fn coupling(default: &'static str) -> Key {
    key("coupling", Type::Choice(&COUPLING), Default::Name(default), "kinematic model")
}

const fn redundant(presence: Default) -> Key {
    key(
        "drop-redundant-rows",
        Type::Boolean,
        presence,
        "rows of joints that follow from others are left out, in place of an error, and have no forces; a run ends where they no \
         longer follow",
    )
}

const fn refine(presence: Default) -> Key {
    key("refine", Type::Integer(1, 1000), presence, "into how many each element of beams in space is cut")
}

static MODEL_KEYS: [Key; 3] =
    [coupling("space"), redundant(Default::Boolean(false)), refine(Default::Integer(1))];
static MODEL_KEYS_ON_HUB: [Key; 3] = [coupling("first"), redundant(Optional), refine(Optional)];

/// What is kept of the equations.
pub(super) const MODEL: Key = key("model", Type::Table(&MODEL_KEYS), Empty, "model of the system");

const TITLE: Key = key("title", Type::Text, Default::Name(""), "title for plots and reports");

/// Keys of the beam, its hub and its model.
static PLANAR: &[Key] = &[
    key(
        "beam",
        Type::Table(&[key("length", Quantity(&LENGTH, Positive), Required, "length L of the beam")]),
        Required,
        "beam itself",
    ),
    key("section", Type::Kind(&SECTION), Required, "cross-section"),
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
            key("motion", Type::Kind(&MOTION), Default::Run, "rotation of the hub: prescribed, or free"),
        ]),
        Default::Empty,
        "hub and its motion",
    ),
    blade::BLADE.key,
    key("model", Type::Table(&MODEL_KEYS_ON_HUB), Default::Empty, "model of the beam"),
    key("basis", Type::Kind(&BASIS), Default::Name("finite-elements"), "basis of the displacements"),
];

/// Keys of a run.
static RUN: &[Key] = &[
    key("initial", Type::Kind(&INITIAL), Default::Name("undeformed"), "state at the start"),
    key("integrator", Type::Kind(&INTEGRATOR), Default::Name("radau"), "integrator"),
    key(
        "run",
        Type::Table(&[
            key(
                "duration",
                Quantity(&TIME, NotNegative),
                Default::Run,
                "simulated time; 0 for the initial state alone",
            ),
            key(
                "tolerance",
                Type::Number(Between(1e-12, 1.0)),
                Optional,
                "largest error of `quantity` over its largest value: mesh and steps are refined until it is reached",
            ),
            key(
                "quantity",
                Type::Text,
                Optional,
                "column of `tolerance`, also its `.min`, `.max` or `.final`; all principal columns if left out",
            ),
        ]),
        Default::Empty,
        "extent of the run",
    ),
];

const SAMPLE: Key = key(
    "step",
    Quantity(&TIME, Positive),
    Optional,
    "interval between records, a thousandth of the duration if left out",
);
const STATIONS: Key =
    key("stations", Type::Places, Default::Empty, "stations of beams that are recorded besides the tip");
const BALANCE: Key = key(
    "energy-balance",
    Type::Boolean,
    Default::Boolean(true),
    "work, losses and the balance of energy are recorded, for an evaluation or more of the power a step",
);
const PLOTS: Key =
    key("plots", Type::Boolean, Default::Boolean(true), "the run is drawn: plot.svg and plot.png");
const VTK: Key = key(
    "vtk",
    Type::Boolean,
    Default::Boolean(false),
    "the shape of the beam is written too, for ParaView: beam.pvd",
);
const VTK_STEP: Key = key(
    "vtk-step",
    Quantity(&TIME, Positive),
    Optional,
    "interval between shapes, rounded to records, 200 shapes if left out",
);

/// What is recorded of a beam on a hub.
static RECORDED: [Key; 9] = [
    SAMPLE,
    STATIONS,
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
    BALANCE,
    key(
        "modal-shares",
        Type::Boolean,
        Default::Boolean(false),
        "the shares B²/ΣB² of the transverse modes are recorded, for the basis `modes`",
    ),
    PLOTS,
    VTK,
    VTK_STEP,
];
const OUTPUT: Key = key("output", Type::Table(&RECORDED), Default::Empty, "recording of results");

/// What is recorded of a system in space.
static RECORDED_IN_SPACE: [Key; 7] = [
    SAMPLE,
    STATIONS,
    key(
        "root-axes",
        Type::Boolean,
        Default::Boolean(false),
        "stations are recorded in the axes of their root too, as those of a beam in the plane: deflection, axial, across, rotation",
    ),
    BALANCE,
    PLOTS,
    VTK,
    VTK_STEP,
];
const SPATIAL_OUTPUT: Key =
    key("output", Type::Table(&RECORDED_IN_SPACE), Default::Empty, "recording of results");
