//! What drives a free hub: the torque on it and the controller of its angle.

use super::profile::{self, Shared};
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Made, both};
use crate::kind::{Choice, Context, Kind};
use crate::units::{ANGLE, ANGULAR_DAMPING, ANGULAR_SPEED, ANGULAR_STIFFNESS, TIME, TORQUE};
use crate::values::Values;
use flexion::drive::{Actuator, Controller};
use flexion::hub_beam::FreeHub;
use flexion::profile::{Constant, Motion, Profile, ProfileError, Ramp};
use std::sync::Arc;

/// Makes a controller of a hub that begins at an angle [rad].
type Control = Box<dyn Fn(f64) -> Result<Controller, ProfileError>>;

/// The kinds of torque.
pub static TORQUE_ON_HUB: Choice<Shared> = Choice {
    name: "torque",
    path: "hub.motion.torque",
    summary: "torque on a free hub",
    kinds: &[
        Kind {
            name: "constant",
            summary: "constant torque",
            source: "",
            keys: &[key("torque", Quantity(&TORQUE, Any), Default::Number(0.0), "torque on the hub")],
            example: "hub={inertia=5, motion={kind='free', torque={kind='constant', torque='3 N*m'}}}",
            make: |v, c| simple(Constant::new(v.number("torque")?), c),
        },
        Kind {
            name: "ramp",
            summary: "torque growing linearly from zero, then constant",
            source: "",
            keys: &[
                key("torque", Quantity(&TORQUE, Any), Required, "torque reached"),
                key("time", Quantity(&TIME, Positive), Required, "time in which it is reached"),
            ],
            example: "hub={inertia=5, motion={kind='free', torque={kind='ramp', torque=3, time='20 ms'}}}",
            make: |v, c| simple(Ramp::new(0.0, v.number("torque")?, v.number("time")?), c),
        },
        Kind {
            name: "table",
            summary: "table of time and torque",
            source: "",
            keys: &[
                key("file", Type::Path, Required, "CSV file with the columns t [s] and torque [N·m]"),
                profile::OF_LOADS,
            ],
            example: "hub={inertia=5, motion={kind='free', torque={kind='table', file='measured.csv'}}}",
            make: |v, c| profile::covering(profile::table(v, c)?, c, "file"),
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the torque",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in t, in N·m")],
            example: "hub={inertia=5, motion={kind='free', torque={kind='expression', formula='2*sin(t)'}}}",
            make: |v, c| profile::covering(profile::of_time(v, c)?, c, "formula"),
        },
    ],
};

/// The kinds of controller.
pub static CONTROLLER: Choice<Option<Control>> = Choice {
    name: "controller",
    path: "hub.motion.controller",
    summary: "controller of the angle of a free hub",
    kinds: &[
        Kind {
            name: "none",
            summary: "no controller",
            source: "",
            keys: &[],
            example: "hub={inertia=5, motion={kind='free', speed=1, controller={kind='none'}}}",
            make: |_, _| Ok(None),
        },
        Kind {
            name: "pd",
            summary: "proportional–derivative control of the angle, towards a target reached at a limited rate",
            source: "",
            keys: &[
                key("proportional", Quantity(&ANGULAR_STIFFNESS, NotNegative), Required, "gain of the angle"),
                key("derivative", Quantity(&ANGULAR_DAMPING, NotNegative), Required, "gain of the speed"),
                key("target", Quantity(&ANGLE, Any), Required, "angle to be reached"),
                key(
                    "rate",
                    Quantity(&ANGULAR_SPEED, Positive),
                    Optional,
                    "largest speed of the reference on its way to the target; a step if left out",
                ),
                key(
                    "limit",
                    Quantity(&TORQUE, Positive),
                    Optional,
                    "largest torque of the actuator; no limit if left out",
                ),
            ],
            example: "hub={inertia=5, motion={kind='free', controller={kind='pd', proportional=20, derivative=4, target='90 deg', rate='60 deg/s', limit=9}}}",
            make: pd,
        },
    ],
};

/// The keys of a free hub.
pub(super) const KEYS: &[Key] = &[
    key("angle", Quantity(&ANGLE, Any), Default::Number(0.0), "angle of the hub at the start"),
    key("speed", Quantity(&ANGULAR_SPEED, Any), Default::Number(0.0), "speed of the hub at the start"),
    key("torque", Type::Kind(&TORQUE_ON_HUB), Default::Name("constant"), "torque on the hub"),
    key(
        "damping",
        Quantity(&ANGULAR_DAMPING, NotNegative),
        Default::Number(0.0),
        "viscous restraint of the hub",
    ),
    key(
        "stiffness",
        Quantity(&ANGULAR_STIFFNESS, NotNegative),
        Default::Number(0.0),
        "spring restraint of the hub",
    ),
    key("rest-angle", Quantity(&ANGLE, Any), Default::Number(0.0), "angle at which the spring is at rest"),
    key("controller", Type::Kind(&CONTROLLER), Default::Name("none"), "controller of the angle"),
];

/// A torque of closed form that covers the run.
fn simple<P: Profile + 'static>(torque: Result<P, ProfileError>, c: &Context<'_>) -> Made<Shared> {
    profile::covering(Arc::new(profile::checked(torque, "kind")?), c, "kind")
}

/// The reference goes to the target at the rate, or is there from the start.
fn pd(v: &Values, _: &Context<'_>) -> Made<Option<Control>> {
    let (proportional, derivative) = (v.number("proportional")?, v.number("derivative")?);
    let (target, rate) = (v.number("target")?, v.optional_number("rate")?);
    let limit = v.optional_number("limit")?.unwrap_or(f64::INFINITY);
    Ok(Some(Box::new(move |angle| {
        let way = target - angle;
        let reference: Shared = match rate {
            Some(rate) if way != 0.0 => Arc::new(Ramp::new(angle, target, (way / rate).abs())?),
            _ => Arc::new(Constant::new(target)?),
        };
        Ok(Controller { proportional, derivative, reference: Motion::Angle(reference), limit })
    })))
}

/// A hub that is free to rotate.
pub(super) fn free_hub(v: &Values, c: &Context<'_>) -> Made<FreeHub> {
    let (torque, control) = both(TORQUE_ON_HUB.make(v, "torque", c), CONTROLLER.make(v, "controller", c))?;
    let angle = v.number("angle")?;
    let controller = control.map(|control| control(angle)).transpose();
    Ok(FreeHub {
        angle,
        speed: v.number("speed")?,
        actuator: Actuator {
            torque,
            damping: v.number("damping")?,
            stiffness: v.number("stiffness")?,
            rest_angle: v.number("rest-angle")?,
            controller: profile::checked(controller, "controller")?,
        },
    })
}
