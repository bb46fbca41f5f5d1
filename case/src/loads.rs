//! What acts on the beam and what it carries: gravity, forces, couples, masses and damping.

use super::declaration::{
    Bound::*, Key, Kind, Presence as Default, Presence::*, Seam, Type, Type::Quantity, key,
};
use super::units::{
    ACCELERATION, ANGLE, FACTOR, FORCE, FORCE_PER_LENGTH, INERTIA, LENGTH, MASS, RATE, TIME, TORQUE,
};
use super::values::Values;
pub use flexion::hub_beam::load::{Axes, Gravity};
pub use flexion::hub_beam::{Damping, Mass};

/// Everything on the beam, in SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Loads {
    /// Gravity.
    pub gravity: Option<Gravity>,
    /// Lumped masses.
    pub masses: Vec<Mass>,
    /// Forces at stations.
    pub forces: Vec<Force>,
    /// Couples at stations.
    pub couples: Vec<Couple>,
    /// Forces per length.
    pub distributed: Vec<Distributed>,
    /// Damping of the beam.
    pub damping: Damping,
}

/// How a load changes with time: a factor of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Amplitude {
    /// 1.
    Constant,
    /// From 0 to 1 in `time` \[s\].
    Ramp {
        /// Time \[s\].
        time: f64,
    },
    /// A cubic spline through rows of time \[s\] and factor.
    Table(Vec<(f64, f64)>),
    /// A formula in `t` \[s\].
    Expression(String),
}

/// How a force per length changes along the beam: a factor of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Distribution {
    /// 1.
    Uniform,
    /// Straight lines through rows of station \[m\] and factor.
    Table(Vec<(f64, f64)>),
    /// A formula in `x` \[m\].
    Expression(String),
}

/// A force at a station, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Force {
    /// Station \[m\].
    pub station: f64,
    /// Components \[N\].
    pub force: [f64; 2],
    /// What they refer to.
    pub axes: Axes,
    /// Change with time.
    pub amplitude: Amplitude,
}

/// A couple at a station, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Couple {
    /// Station \[m\].
    pub station: f64,
    /// Moment [N·m].
    pub couple: f64,
    /// Change with time.
    pub amplitude: Amplitude,
}

/// A force per length, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Distributed {
    /// Components \[N/m\].
    pub force: [f64; 2],
    /// What they refer to.
    pub axes: Axes,
    /// First and last station \[m\]; the ends of the beam when `None`.
    pub range: (f64, Option<f64>),
    /// Change along the beam.
    pub distribution: Distribution,
    /// Change with time.
    pub amplitude: Amplitude,
}

/// What the components of a force refer to.
pub(super) static AXES: Seam = Seam {
    name: "frame of a force",
    path: "force.frame",
    summary: "axes that the components of a force refer to",
    kinds: &[
        Kind {
            name: "dead",
            summary: "inertial axes: the force keeps its direction in space",
            source: "",
            keys: &[],
        },
        Kind {
            name: "hub",
            summary: "radial and transverse axis of the hub: the force turns with it",
            source: "",
            keys: &[],
        },
        Kind {
            name: "follower",
            summary: "tangent and normal of the beam: the force turns with the section",
            source: "",
            keys: &[],
        },
    ],
};

/// The kinds of change with time.
pub(super) static AMPLITUDE: Seam = Seam {
    name: "amplitude",
    path: "force.amplitude",
    summary: "change of a load with time, as a factor of it",
    kinds: &[
        Kind { name: "constant", summary: "constant", source: "", keys: &[] },
        Kind {
            name: "ramp",
            summary: "growing linearly from zero, then constant",
            source: "",
            keys: &[key("time", Quantity(&TIME, Positive), Required, "time in which it is reached")],
        },
        Kind {
            name: "table",
            summary: "cubic spline through times and factors",
            source: "",
            keys: &[
                key("times", Type::Quantities(&TIME, Any), Required, "times, ascending"),
                key("factors", Type::Quantities(&FACTOR, Any), Required, "factor at each time"),
            ],
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the factor",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in t")],
        },
    ],
};

/// The kinds of change along the beam.
pub(super) static DISTRIBUTION: Seam = Seam {
    name: "distribution",
    path: "distributed-load.distribution",
    summary: "change of a force per length along the beam, as a factor of it",
    kinds: &[
        Kind { name: "uniform", summary: "the same everywhere", source: "", keys: &[] },
        Kind {
            name: "table",
            summary: "straight lines through stations and factors",
            source: "",
            keys: &[
                key("stations", Type::Quantities(&LENGTH, NotNegative), Required, "stations, ascending"),
                key("factors", Type::Quantities(&FACTOR, Any), Required, "factor at each station"),
            ],
        },
        Kind {
            name: "expression",
            summary: "formula of the station x [m] for the factor",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in x")],
        },
    ],
};

const STATION: Key =
    key("station", Quantity(&LENGTH, NotNegative), Required, "station along the beam, from the root");
const FRAME: Key =
    key("frame", Type::Choice(&AXES), Default::Name("dead"), "axes that the components refer to");
const CHANGE: Key =
    key("amplitude", Type::Kind(&AMPLITUDE), Default::Name("constant"), "factor against time");

/// The keys of a case that stand here.
const GRAVITY_KEYS: &[Key] = &[
    key("acceleration", Quantity(&ACCELERATION, NotNegative), Required, "acceleration g"),
    key(
        "direction",
        Quantity(&ANGLE, Any),
        Default::Number(-std::f64::consts::FRAC_PI_2),
        "angle of its direction against the inertial x axis; down, along -y, if left out",
    ),
];
pub(super) const GRAVITY: Key =
    key("gravity", Type::Table(GRAVITY_KEYS), Optional, "gravity in the plane of motion");
const MASSES_KEYS: &[Key] = &[
    STATION,
    key("mass", Quantity(&MASS, Positive), Required, "mass"),
    key(
        "inertia",
        Quantity(&INERTIA, NotNegative),
        Default::Number(0.0),
        "moment of inertia about its centre, which lies on the axis of the beam",
    ),
];
pub(super) const MASSES: Key =
    key("mass", Type::Tables(MASSES_KEYS), Default::Empty, "lumped masses on the beam");
const FORCES_KEYS: &[Key] = &[
    STATION,
    key("force", Type::Quantities(&FORCE, Any), Required, "two components of the force"),
    FRAME,
    CHANGE,
];
pub(super) const FORCES: Key = key("force", Type::Tables(FORCES_KEYS), Default::Empty, "forces at stations");
const COUPLES_KEYS: &[Key] =
    &[STATION, key("couple", Quantity(&TORQUE, Any), Required, "moment, counterclockwise"), CHANGE];
pub(super) const COUPLES: Key =
    key("couple", Type::Tables(COUPLES_KEYS), Default::Empty, "couples at stations");
const DISTRIBUTED_KEYS: &[Key] = &[
    key(
        "force",
        Type::Quantities(&FORCE_PER_LENGTH, Any),
        Required,
        "two components of the force per length",
    ),
    FRAME,
    key("from", Quantity(&LENGTH, NotNegative), Default::Number(0.0), "station where it begins"),
    key("to", Quantity(&LENGTH, Positive), Optional, "station where it ends, the tip if left out"),
    key("distribution", Type::Kind(&DISTRIBUTION), Default::Name("uniform"), "factor against the station"),
    CHANGE,
];
pub(super) const DISTRIBUTED: Key =
    key("distributed-load", Type::Tables(DISTRIBUTED_KEYS), Default::Empty, "forces per length");
const DAMPING_KEYS: &[Key] = &[
    key(
        "mass-proportional",
        Quantity(&RATE, NotNegative),
        Default::Number(0.0),
        "force over mass and velocity relative to the hub, β",
    ),
    key(
        "stiffness-proportional",
        Quantity(&TIME, NotNegative),
        Default::Number(0.0),
        "viscous over elastic stress and rate of strain, η",
    ),
];
pub(super) const DAMPING: Key = key("damping", Type::Table(DAMPING_KEYS), Optional, "damping of the beam");

fn pair(v: &Values) -> Option<[f64; 2]> {
    v.numbers("force")?.try_into().ok()
}

fn rows(v: &Values, places: &str) -> Option<Vec<(f64, f64)>> {
    let (places, factors) = (v.numbers(places)?, v.numbers("factors")?);
    Some(places.iter().copied().zip(factors.iter().copied()).collect())
}

fn axes(v: &Values) -> Option<Axes> {
    Some(match v.text("frame")? {
        "hub" => Axes::Hub,
        "follower" => Axes::Follower,
        _ => Axes::Dead,
    })
}

fn amplitude(v: &Values) -> Option<Amplitude> {
    let (kind, v) = v.kind("amplitude")?;
    Some(match kind.name {
        "ramp" => Amplitude::Ramp { time: v.number("time")? },
        "table" => Amplitude::Table(rows(v, "times")?),
        "expression" => Amplitude::Expression(v.text("formula")?.to_owned()),
        _ => Amplitude::Constant,
    })
}

fn distribution(v: &Values) -> Option<Distribution> {
    let (kind, v) = v.kind("distribution")?;
    Some(match kind.name {
        "table" => Distribution::Table(rows(v, "stations")?),
        "expression" => Distribution::Expression(v.text("formula")?.to_owned()),
        _ => Distribution::Uniform,
    })
}

/// Reads everything on the beam; what has problems of its own is left out.
pub(super) fn read(values: &Values) -> Loads {
    let gravity = values.table("gravity").and_then(|v| {
        Some(Gravity { acceleration: v.number("acceleration")?, direction: v.number("direction")? })
    });
    let mass = |v: &Values| {
        Some(Mass { station: v.number("station")?, mass: v.number("mass")?, inertia: v.number("inertia")? })
    };
    let force = |v: &Values| {
        Some(Force {
            station: v.number("station")?,
            force: pair(v)?,
            axes: axes(v)?,
            amplitude: amplitude(v)?,
        })
    };
    let couple = |v: &Values| {
        Some(Couple { station: v.number("station")?, couple: v.number("couple")?, amplitude: amplitude(v)? })
    };
    let distributed = |v: &Values| {
        Some(Distributed {
            force: pair(v)?,
            axes: axes(v)?,
            range: (v.number("from")?, v.number("to")),
            distribution: distribution(v)?,
            amplitude: amplitude(v)?,
        })
    };
    let damping = values.table("damping").map_or(Damping::default(), |v| Damping {
        mass: v.number("mass-proportional").unwrap_or(0.0),
        stiffness: v.number("stiffness-proportional").unwrap_or(0.0),
    });
    Loads {
        gravity,
        masses: values.tables("mass").iter().filter_map(mass).collect(),
        forces: values.tables("force").iter().filter_map(force).collect(),
        couples: values.tables("couple").iter().filter_map(couple).collect(),
        distributed: values.tables("distributed-load").iter().filter_map(distributed).collect(),
        damping,
    }
}
