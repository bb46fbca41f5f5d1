//! Damping of beams and bodies.

use crate::declaration::Bound::*;
use crate::keys::{Field, keys, quantity};
use crate::kind::{Of, Table};
use crate::units::{RATE, TIME};
use flexion::hub_beam;

const MASS: Field<f64> = quantity(&RATE, NotNegative).or(0.0);
const STIFFNESS: Field<f64> = quantity(&TIME, NotNegative)
    .or(0.0)
    .called("stiffness", "viscous over elastic stress and rate of strain, η");

keys! {
    /// Damping of a beam of its own.
    pub(super) struct Damped {
        /// force over mass and velocity against the ground, β: it brakes a beam that rotates too
        mass: f64 = MASS;
        stiffness: f64 = STIFFNESS;
    }

    /// Damping of a body.
    pub(super) struct Rigid {
        /// force over mass and velocity, and moment over inertia and angular velocity, β
        mass: f64 = MASS;
    }

    /// Damping of a beam on a hub.
    struct Damping {
        /// force over mass and velocity relative to the hub, β
        mass: f64 = MASS;
        stiffness: f64 = STIFFNESS;
    }
}

/// The table `[damping]`.
pub static DAMPING: Table<hub_beam::Damping> = Table::one(
    "damping",
    "damping of the beam",
    "damping={mass='0.2 1/s', stiffness='1 ms'}",
    &Of(|k: Damping, _| Ok(hub_beam::Damping { mass: k.mass, stiffness: k.stiffness })),
);
