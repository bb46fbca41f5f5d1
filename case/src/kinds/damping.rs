//! Damping of beams and bodies.

use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::Made;
use crate::kind::Table;
use crate::units;
use crate::values::Values;
use flexion::hub_beam::Damping;

const fn mass(doc: &'static str) -> Key {
    key("mass", Quantity(&units::RATE, NotNegative), Default::Number(0.0), doc)
}

const STIFFNESS: Key = key(
    "stiffness",
    Quantity(&units::TIME, NotNegative),
    Default::Number(0.0),
    "viscous over elastic stress and rate of strain, η",
);

/// The keys of the damping of a beam of its own.
pub(super) static DAMPED: [Key; 2] = [
    mass("force over mass and velocity against the ground, β: it brakes a beam that rotates too"),
    STIFFNESS,
];

/// The keys of the damping of a body.
pub(super) static RIGID: [Key; 1] =
    [mass("force over mass and velocity, and moment over inertia and angular velocity, β")];

/// β [1/s] and η \[s\] of the table `damping` of a beam.
pub(super) fn damping(v: &Values) -> Made<[f64; 2]> {
    let v = v.table("damping")?;
    Ok([v.number("mass")?, v.number("stiffness")?])
}

/// The table `[damping]`.
pub static DAMPING: Table<Damping> = Table {
    key: key(
        "damping",
        Type::Table(&[mass("force over mass and velocity relative to the hub, β"), STIFFNESS]),
        Optional,
        "damping of the beam",
    ),
    example: "damping={mass='0.2 1/s', stiffness='1 ms'}",
    make: |v, _| Ok(Damping { mass: v.number("mass")?, stiffness: v.number("stiffness")? }),
};
