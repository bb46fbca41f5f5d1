//! What acts on the beam and what it carries: gravity, forces, couples, masses and damping. Each table of a case is one
//! entry of [`LOADS`].

use super::amplitude::{CHANGE, DISTRIBUTION, amplitude};
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made, both};
use crate::kind::{Choice, Context, Kind, Table};
use crate::units;
use crate::values::Values;
use flexion::hub_beam::Damping;
use flexion::hub_beam::Mass;
use flexion::hub_beam::load::{self, Axes, DistributedForce};
use std::sync::Arc;

/// What one table of a case puts onto the beam.
#[derive(Clone, Debug, Default)]
pub struct Load {
    /// The table that it is of.
    pub table: &'static str,
    /// What acts.
    pub load: Option<Arc<dyn load::Load + Send + Sync>>,
    /// What the beam carries.
    pub mass: Option<Mass>,
    /// Stations at which cells of the quadrature must end \[m\].
    pub stations: Vec<f64>,
    /// Stations at which elements should end \[m\]: something acts or begins there.
    pub nodes: Vec<f64>,
    /// What it is called, if its direction is fixed in space: seen from a hub that rotates, it changes with every
    /// revolution.
    pub fixed_in_space: Option<&'static str>,
}

/// A load that acts on `stations`.
fn acting(load: impl load::Load + Send + Sync + 'static, stations: Vec<f64>) -> Load {
    Load { load: Some(Arc::new(load)), nodes: stations.clone(), stations, ..Load::default() }
}

/// What a force of these axes is called, if its direction is fixed in space.
fn in_space(axes: Axes) -> Option<&'static str> {
    (axes == Axes::Dead).then_some("forces of fixed direction")
}

/// Two components of a force.
fn components(v: &Values) -> Made<[f64; 2]> {
    let components = v.numbers("force")?;
    components.try_into().map_err(|_| {
        let message = format!("a force in the plane has 2 components, not {}", components.len());
        Fault::new("force", message).into()
    })
}

/// What the components of a force refer to.
pub static AXES: Choice<Axes> = Choice {
    name: "frame of a force",
    path: "force.frame",
    summary: "axes that the components of a force refer to",
    kinds: &[
        Kind {
            name: "dead",
            summary: "inertial axes: the force keeps its direction in space",
            source: "",
            keys: &[],
            example: "force=[{station='1 m', force=[0, '3 N'], frame='dead'}]",
            make: |_, _| Ok(Axes::Dead),
        },
        Kind {
            name: "hub",
            summary: "radial and transverse axis of the hub: the force rotates with it",
            source: "",
            keys: &[],
            example: "force=[{station=1, force=[0, 3], frame='hub'}]",
            make: |_, _| Ok(Axes::Hub),
        },
        Kind {
            name: "follower",
            summary: "tangent and normal of the beam: the force rotates with the section",
            source: "",
            keys: &[],
            example: "force=[{station=1, force=[0, 3], frame='follower'}]",
            make: |_, _| Ok(Axes::Follower),
        },
    ],
};

const STATION: Key =
    key("station", Type::Station(NotNegative), Required, "station along the beam, from the root");
const FRAME: Key =
    key("frame", Type::Choice(&AXES), Default::Name("dead"), "axes that the components refer to");

/// Everything that a case may put onto the beam, in the order of a case file.
pub static LOADS: &[&Table<Load>] = &[&GRAVITY, &MASS, &FORCE, &COUPLE, &DISTRIBUTED, &SPRING];

static SPRING: Table<Load> = Table {
    key: key(
        "spring",
        Type::Tables(&[
            STATION,
            key(
                "stiffness",
                Quantity(&units::FORCE_PER_LENGTH, NotNegative),
                Required,
                "stiffness k, the same in all directions",
            ),
            key(
                "damping",
                Quantity(&units::DAMPING, NotNegative),
                Default::Number(0.0),
                "force over velocity of the station, c",
            ),
            key(
                "anchor",
                Type::Quantities(&units::LENGTH, Any),
                Required,
                "x and y of the other end in inertial axes, from the axis of the hub",
            ),
        ]),
        Default::Empty,
        "springs between a station and a point fixed in space",
    ),
    example: "spring=[{station='tip', stiffness='200 N/m', damping='2 N s/m', anchor=['2.1 m', 0]}]",
    make: |v, c| {
        let anchor = v.numbers("anchor").and_then(|place| {
            let message = format!("a place in the plane has 2 coordinates, not {}", place.len());
            place.try_into().map_err(|_| Fault::new("anchor", message).into())
        });
        let (station, anchor) = both(c.station(v, "station"), anchor)?;
        let (stiffness, damping) = (v.number("stiffness")?, v.number("damping")?);
        let spring = load::Spring { station, stiffness, damping, anchor };
        Ok(Load { fixed_in_space: Some("springs to the ground"), ..acting(spring, vec![station]) })
    },
};

static GRAVITY: Table<Load> = Table {
    key: key(
        "gravity",
        Type::Table(&[
            key("acceleration", Quantity(&units::ACCELERATION, NotNegative), Required, "acceleration g"),
            key(
                "direction",
                Quantity(&units::ANGLE, Any),
                Default::Number(-std::f64::consts::FRAC_PI_2),
                "angle of its direction against the inertial x axis; down, along -y, if left out",
            ),
        ]),
        Optional,
        "gravity in the plane of motion",
    ),
    example: "gravity={acceleration='9.81 m/s^2', direction='-90 deg'}",
    make: |v, _| {
        let gravity =
            load::Gravity { acceleration: v.number("acceleration")?, direction: v.number("direction")? };
        Ok(Load { fixed_in_space: Some("gravity"), ..acting(gravity, Vec::new()) })
    },
};

static MASS: Table<Load> = Table {
    key: key(
        "mass",
        Type::Tables(&[
            STATION,
            key("mass", Quantity(&units::MASS, Positive), Required, "mass"),
            key(
                "inertia",
                Quantity(&units::INERTIA, NotNegative),
                Default::Number(0.0),
                "moment of inertia about its centre, which lies on the axis of the beam",
            ),
        ]),
        Default::Empty,
        "lumped masses on the beam",
    ),
    example: "mass=[{station='tip', mass='300 g', inertia=2e-3}]",
    make: |v, c| {
        let (mass, inertia) = (v.number("mass")?, v.number("inertia")?);
        let mass = Mass { station: c.station(v, "station")?, mass, inertia };
        Ok(Load { mass: Some(mass), nodes: vec![mass.station], ..Load::default() })
    },
};

static FORCE: Table<Load> = Table {
    key: key(
        "force",
        Type::Tables(&[
            STATION,
            key("force", Type::Quantities(&units::FORCE, Any), Required, "two components of the force"),
            FRAME,
            CHANGE,
        ]),
        Default::Empty,
        "forces at stations",
    ),
    example: "force=[{station='tip', force=['0 N', '3 N']}]",
    make: |v, c| {
        let (station, force) = both(c.station(v, "station"), components(v))?;
        let (axes, amplitude) = both(AXES.make(v, "frame", c), amplitude(v, c))?;
        let force = load::Force { station, force, axes, amplitude };
        Ok(Load { fixed_in_space: in_space(axes), ..acting(force, vec![station]) })
    },
};

static COUPLE: Table<Load> = Table {
    key: key(
        "couple",
        Type::Tables(&[
            STATION,
            key("couple", Quantity(&units::TORQUE, Any), Required, "moment, counterclockwise"),
            CHANGE,
        ]),
        Default::Empty,
        "couples at stations",
    ),
    example: "couple=[{station='tip', couple='3 N*m'}]",
    make: |v, c| {
        let (station, amplitude) = both(c.station(v, "station"), amplitude(v, c))?;
        Ok(acting(load::Couple { station, couple: v.number("couple")?, amplitude }, vec![station]))
    },
};

static DISTRIBUTED: Table<Load> = Table {
    key: key(
        "distributed-load",
        Type::Tables(&[
            key(
                "force",
                Type::Quantities(&units::FORCE_PER_LENGTH, Any),
                Required,
                "two components of the force per length",
            ),
            FRAME,
            key(
                "from",
                Quantity(&units::LENGTH, NotNegative),
                Default::Number(0.0),
                "station where it begins",
            ),
            key(
                "to",
                Quantity(&units::LENGTH, Positive),
                Optional,
                "station where it ends, the tip if left out",
            ),
            key(
                "distribution",
                Type::Kind(&DISTRIBUTION),
                Default::Name("uniform"),
                "factor against the station",
            ),
            CHANGE,
        ]),
        Default::Empty,
        "forces per length",
    ),
    example: "distributed-load=[{force=['0 N/m', '-2 N/m'], from='0.5 m', to='1 m'}]",
    make: |v, c| {
        let range = range(v, c);
        let ((axes, distribution), amplitude) =
            both(both(AXES.make(v, "frame", c), DISTRIBUTION.make(v, "distribution", c)), amplitude(v, c))?;
        let (from, to) = range?;
        let load =
            DistributedForce { force: components(v)?, axes, distribution, range: (from, to), amplitude };
        let stations = load.stations();
        Ok(Load { nodes: vec![from, to], fixed_in_space: in_space(axes), ..acting(load, stations) })
    },
};

/// First and last station of a load per length.
fn range(v: &Values, c: &Context<'_>) -> Made<(f64, f64)> {
    let from = c.station(v, "from")?;
    let to = match v.optional_number("to")? {
        Some(_) => c.station(v, "to")?,
        None => c.length()?,
    };
    if from < to {
        return Ok((from, to));
    }
    let message = format!("the load begins at {from} m and ends at {to} m: it has no length");
    Err(Fault::new("from", message).into())
}

/// The table `[damping]`.
pub static DAMPING: Table<Damping> = Table {
    key: key(
        "damping",
        Type::Table(&[
            key(
                "mass-proportional",
                Quantity(&units::RATE, NotNegative),
                Default::Number(0.0),
                "force over mass and velocity relative to the hub, β",
            ),
            key(
                "stiffness-proportional",
                Quantity(&units::TIME, NotNegative),
                Default::Number(0.0),
                "viscous over elastic stress and rate of strain, η",
            ),
        ]),
        Optional,
        "damping of the beam",
    ),
    example: "damping={mass-proportional='0.2 1/s', stiffness-proportional='1 ms'}",
    make: |v, _| {
        let (mass, stiffness) = (v.number("mass-proportional")?, v.number("stiffness-proportional")?);
        Ok(Damping { mass, stiffness })
    },
};
