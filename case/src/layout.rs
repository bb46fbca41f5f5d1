//! The layout of a case file: its keys, and the choices in them.

use super::declaration::{Bound::*, Key, Kinds, Presence as Default, Presence::*, Type, Type::Quantity, key};
use super::kinds::basis::{BASIS, FIELD};
use super::kinds::coupling::COUPLING;
use super::kinds::initial::INITIAL;
use super::kinds::integrator::INTEGRATOR;
use super::kinds::motion::MOTION;
use super::kinds::section::SECTION;
use super::kinds::{amplitude, blade, contact, load, torque};
use super::units::{INERTIA, LENGTH, TIME};
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
    &contact::OBSTACLE,
    &contact::MOUNT,
    &contact::LAW,
    &blade::STRAIN_ENERGY,
    &COUPLING,
    &BASIS,
    &FIELD,
    &INITIAL,
    &INTEGRATOR,
];

/// The keys of a case file.
pub(super) fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
        let loads: Vec<Key> = load::LOADS.iter().map(|table| table.key).collect();
        [MODEL, &loads, &[contact::CONTACT.key, load::DAMPING.key], RUN].concat()
    });
    &KEYS
}

/// Keys of the beam, its hub and its model.
static MODEL: &[Key] = &[
    key("title", Type::Text, Default::Name(""), "title for plots and reports"),
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
            key("motion", Type::Kind(&MOTION), Required, "rotation of the hub: prescribed, or free"),
        ]),
        Required,
        "hub and its motion",
    ),
    blade::BLADE.key,
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
    key("basis", Type::Kind(&BASIS), Default::Name("finite-elements"), "basis of the displacements"),
];

/// Keys of a run.
static RUN: &[Key] = &[
    key("initial", Type::Kind(&INITIAL), Default::Name("undeformed"), "state at the start"),
    key("integrator", Type::Kind(&INTEGRATOR), Default::Name("radau"), "integrator"),
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
                "modal-shares",
                Type::Boolean,
                Default::Boolean(false),
                "the shares B²/ΣB² of the transverse modes are recorded, for the basis `modes`",
            ),
            key("plots", Type::Boolean, Default::Boolean(true), "the run is drawn: plot.svg and plot.png"),
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
