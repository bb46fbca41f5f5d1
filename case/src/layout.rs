//! The layout of a case file: its keys, and the choices in them.

use super::declaration::{Bound::*, Key, Kinds};
use super::keys::{
    Field, Named, boolean, choice, integer, keys, kind, number, places, quantities, quantity, table, text,
    vector,
};
use super::kinds::basis::{self, Either, FIELD};
use super::kinds::coupling::{COUPLING, Coupling, SPACE};
use super::kinds::cross_section::Section;
use super::kinds::initial::{self, Initial};
use super::kinds::integrator::{self, Method};
use super::kinds::motion::MOTION;
use super::kinds::section;
use super::kinds::{
    amplitude, beam, body, contact, curve, damping, force_law, joint, load, mass, obstacle, rotation, spring,
    torque,
};
use super::tree::{Line, Raw};
use super::units::{ACCELERATION, ANGLE, INERTIA, LENGTH, ROTARY_INERTIA, TIME};
use flexion::hub_beam::Drive;
use flexion::linalg::Vec3;
use std::sync::LazyLock;

/// The choices, in the order of a case file.
pub(super) static CHOICES: &[&dyn Kinds] = &[
    &section::SECTION,
    &MOTION,
    &torque::TORQUE_ON_HUB,
    &torque::CONTROLLER,
    &load::AXES,
    &amplitude::AMPLITUDE,
    &amplitude::DISTRIBUTION,
    &force_law::FORCE_LAW,
    &obstacle::OBSTACLE,
    &contact::LAW,
    &spring::SPRING_KIND,
    &COUPLING,
    &basis::BASIS,
    &FIELD,
    &initial::INITIAL,
    &integrator::INTEGRATOR,
    &body::INERTIA,
    &curve::CURVE,
    &beam::END,
    &joint::JOINT,
    &joint::TRAVEL,
    &joint::TRAVEL_OF,
];

/// The table that only a case of a beam on a hub has.
const ON_HUB: &str = "hub";

/// The lists of which a system in space has one, that of beams first.
pub(super) const IN_SPACE: [&str; 3] = [beam::BEAMS.key.name, body::BODY.key.name, joint::JOINTS.key.name];

/// The keys of the case with these lines: those of a beam on a hub where `[beam]` is one table, and of a system in space where bodies,
/// joints and beams are lists.
pub(super) fn keys_of(entries: &[Line]) -> &'static [Key] {
    let is_list = |entry: &Line| matches!(entry.node.value, Raw::List(_));
    let [beam, others @ ..] = IN_SPACE;
    let beam = entries.iter().find(|entry| entry.key == beam);
    let named = |entry: &Line| others.contains(&entry.key.as_str());
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
    [&GRAVITY.key, &mass::MASS.key, &spring::SPRING.key, &load::LOAD.key, &contact::CONTACT.key];

/// The tables of a system in space, in the order of a case file.
static TABLES: [&Key; 3] = [&body::BODY.key, &beam::BEAMS.key, &joint::JOINTS.key];

/// The keys of a system in space.
pub(super) fn spatial_keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
        let (parts, acting) = (TABLES.map(|key| *key), ACTING.map(|key| *key));
        let more = [beam::FIBRES.key, rotation::ROTATION.key, MODEL.key];
        let output = [OUTPUT_IN_SPACE.key];
        [&[TITLE.key][..], &acting[..1], &parts, &acting[1..], &more, &OF_RUN, &output].concat()
    });
    &KEYS
}

/// The keys of a beam on a hub.
pub(super) fn keys() -> &'static [Key] {
    static KEYS: LazyLock<Vec<Key>> = LazyLock::new(|| {
        let acting = ACTING.map(|key| *key);
        let damping = &[damping::DAMPING.key];
        let (all, one) = (&acting[1..], &acting[..1]);
        [&[TITLE.key], one, &PLANAR, all, damping, &SPATIAL_TABLES, &OF_RUN, &[OUTPUT.key]].concat()
    });
    &KEYS
}

/// Gravity, at the top of a case.
pub(super) const GRAVITY: Field<Vec3> = vector(&ACCELERATION)
    .called("gravity", "acceleration of gravity along x, y and z, none if left out; z may be left out");

const COUPLED: Field<Named<Option<Coupling>>> = choice(&COUPLING).called("coupling", "kinematic model");
const REDUNDANT: &str = "rows of joints that follow from others are left out, in place of an error, and have no forces; a run ends where they no \
                         longer follow";
const REFINE: &str = "into how many each element of beams in space is cut";

keys! {
    /// What is kept of the equations of a system in space.
    pub(super) struct Model {
        coupling: Named<Option<Coupling>> = COUPLED.or_name(SPACE);
        drop_redundant_rows: bool = boolean().or_false().called("", REDUNDANT);
        refine: usize = integer(1, 1000).or_count(1).called("", REFINE);
    }

    /// What is kept of the equations of a beam on a hub.
    pub(super) struct ModelOnHub {
        coupling: Named<Option<Coupling>> = COUPLED.or_name("first");
        drop_redundant_rows: Option<bool> = boolean().called("", REDUNDANT);
        refine: Option<usize> = integer(1, 1000).called("", REFINE);
    }
}

/// The model of a system in space.
pub(super) const MODEL: Field<Model> = table().called("model", "model of the system");
/// The model of a beam on a hub.
pub(super) const MODEL_ON_HUB: Field<ModelOnHub> = table().called("model", "model of the beam");

/// The title.
pub(super) const TITLE: Field<String> = text().or_name("").called("title", "title for plots and reports");

keys! {
    /// The beam on a hub; what space alone carries is handed on as it is written.
    #[allow(dead_code)]
    pub(super) struct OneBeam {
        /// length L of the beam; a deck that has a length says it by itself
        length: Option<f64> = quantity(&LENGTH, Positive);
        /// in space, angle of the root section about the axis towards the tip; at 0 its height is along the motion, that of a deck against it, with the leading edge ahead
        pitch: Option<f64> = quantity(&ANGLE, Any);
        /// in space, angle of the axis out of the plane of rotation, towards the vector of rotation
        precone: Option<f64> = quantity(&ANGLE, Between(-1.5, 1.5));
        /// in space, angle of the tip section against the root without stress, linear between, added to that of a deck
        twist: Option<f64> = quantity(&ANGLE, Any);
        /// in space, it has shear strains, by the stiffness GA of its section, and rotary inertia
        shear: Option<bool> = boolean();
        /// in space, shear factor of a shape, Cowper's if left out
        shear_factor: Option<f64> = number(Positive);
        /// in space, it twists; if left out, where its section says enough
        torsion: Option<bool> = boolean();
        /// in space, Poisson's ratio, for the stiffness of a shape in torsion and in shear
        poisson_ratio: Option<f64> = number(Between(-0.99, 0.5));
        /// in space, moment of inertia per length about the axis; that of the section if left out
        polar_inertia: Option<f64> = quantity(&ROTARY_INERTIA, Positive);
    }

    /// The hub.
    pub(super) struct Hub {
        /// radius a, where the beam is clamped
        radius: f64 = quantity(&LENGTH, NotNegative).or(0.0);
        /// moment of inertia of the hub about its axis
        inertia: f64 = quantity(&INERTIA, NotNegative).or(0.0);
        /// rotation of the hub: prescribed, or free
        motion: Option<Drive> = kind(&MOTION).for_run();
    }
}

/// The table `[beam]`.
pub(super) const BEAM: Field<OneBeam> = table().required().called("beam", "beam itself");
/// The table `[section]`.
pub(super) const SECTION: Field<Section> = kind(&section::SECTION).called("section", "cross-section");
/// The table `[hub]`.
pub(super) const HUB: Field<Hub> = table().called("hub", "hub and its motion");
/// The table `[basis]`.
pub(super) const BASIS: Field<Either> =
    kind(&basis::BASIS).or_name("finite-elements").called("basis", "basis of the displacements");

/// Keys of the beam, its hub and its model.
static PLANAR: [Key; 5] = [BEAM.key, SECTION.key, HUB.key, MODEL_ON_HUB.key, BASIS.key];

keys! {
    /// The extent of a run.
    pub(super) struct Run {
        /// simulated time; 0 for the initial state alone
        duration: Option<f64> = quantity(&TIME, Between(0.0, 1e12)).for_run();
        /// largest error of `quantity` over its largest value: mesh and steps are refined until it is reached
        tolerance: Option<f64> = number(Between(1e-12, 1.0));
        /// column of `tolerance`, also its `.min`, `.max` or `.final`; all principal columns if left out
        quantity: Option<String> = text();
    }
}

/// The table `[initial]`.
pub(super) const INITIAL: Field<Initial> =
    kind(&initial::INITIAL).or_name("undeformed").called("initial", "state at the start");
/// The table `[integrator]`.
pub(super) const INTEGRATOR: Field<Method> =
    kind(&integrator::INTEGRATOR).or_name("radau").called("integrator", "integrator");
/// The table `[run]`.
pub(super) const RUN: Field<Run> = table().called("run", "extent of the run");

/// Keys of a run.
static OF_RUN: [Key; 3] = [INITIAL.key, INTEGRATOR.key, RUN.key];

const SAMPLE: Field<Option<f64>> = quantity(&TIME, Positive)
    .called("step", "interval between records, a thousandth of the duration if left out");
const STATIONS: Field<Vec<String>> =
    places().or_empty().called("stations", "stations of beams that are recorded besides the tip");
const BALANCE: Field<bool> = boolean().or_true().called(
    "energy-balance",
    "work, losses and the balance of energy are recorded, for an evaluation or more of the power a step",
);
const PLOTS: Field<bool> = boolean().or_true().called("plots", "the run is drawn: plot.svg and plot.png");
const VTK: Field<bool> =
    boolean().or_false().called("vtk", "the shape of the beam is written too, for ParaView: beam.pvd");
const VTK_STEP: Field<Option<f64>> = quantity(&TIME, Positive)
    .called("vtk-step", "interval between shapes, rounded to records, 200 shapes if left out");

keys! {
    /// What is recorded of a beam on a hub.
    pub(super) struct Recorded {
        step: Option<f64> = SAMPLE;
        stations: Vec<String> = STATIONS;
        /// axial force, shear force and bending moment are recorded at the stations
        section_forces: bool = boolean().or_false();
        /// heights over the axis at which the strain is recorded at the stations
        strain_heights: Vec<f64> = quantities(&LENGTH, Any).or_empty();
        energy_balance: bool = BALANCE;
        /// the shares B²/ΣB² of the transverse modes are recorded, for the basis `modes`
        modal_shares: bool = boolean().or_false();
        plots: bool = PLOTS;
        vtk: bool = VTK;
        vtk_step: Option<f64> = VTK_STEP;
    }

    /// What is recorded of a system in space.
    pub(super) struct RecordedInSpace {
        step: Option<f64> = SAMPLE;
        stations: Vec<String> = STATIONS;
        /// stations are recorded in the axes of their root too, as those of a beam in the plane: deflection, axial, across, rotation
        root_axes: bool = boolean().or_false();
        energy_balance: bool = BALANCE;
        plots: bool = PLOTS;
        vtk: bool = VTK;
        vtk_step: Option<f64> = VTK_STEP;
    }
}

/// The table `[output]` of a beam on a hub.
pub(super) const OUTPUT: Field<Recorded> = table().called("output", "recording of results");
/// The table `[output]` of a system in space.
pub(super) const OUTPUT_IN_SPACE: Field<RecordedInSpace> = table().called("output", "recording of results");
