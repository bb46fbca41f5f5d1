//! What drives a free hub: the torque on it and the controller of its angle.

use super::profile::{self, OF_LOADS, Shared, Through};
use crate::declaration::Bound::*;
use crate::fault::Made;
use crate::keys::{File, keys, kind, path, quantity, text};
use crate::kind::{Choice, Context, Kind, Nothing, Of};
use crate::units::{ANGLE, ANGULAR_DAMPING, ANGULAR_SPEED, ANGULAR_STIFFNESS, TIME, TORQUE};
use flexion::drive::{Actuator, Controller};
use flexion::hub_beam::FreeHub;
use flexion::profile::{Constant, Motion, Profile, ProfileError, Ramp};
use std::sync::Arc;

/// Makes a controller of a hub that begins at an angle [rad].
type Control = Box<dyn Fn(f64) -> Result<Controller, ProfileError>>;

keys! {
    struct Steady {
        /// torque on the hub
        torque: f64 = quantity(&TORQUE, Any).or(0.0);
    }

    struct Reached {
        /// torque reached
        torque: f64 = quantity(&TORQUE, Any);
        /// time in which it is reached
        time: f64 = quantity(&TIME, Positive);
    }

    struct Table {
        /// CSV file with the columns t and torque, in SI or with the units in their titles
        file: File = path();
        interpolation: Through = OF_LOADS;
    }

    struct Formula {
        /// formula in t, in N·m
        formula: String = text();
    }
}

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
            example: "hub={inertia=5, motion={kind='free', torque={kind='constant', torque='3 N*m'}}}",
            make: &Of(|k: Steady, c| simple(Constant::new(k.torque), c)),
        },
        Kind {
            name: "ramp",
            summary: "torque growing linearly from zero, then constant",
            source: "",
            example: "hub={inertia=5, motion={kind='free', torque={kind='ramp', torque=3, time='20 ms'}}}",
            make: &Of(|k: Reached, c| simple(Ramp::new(0.0, k.torque, k.time), c)),
        },
        Kind {
            name: "table",
            summary: "table of time and torque",
            source: "",
            example: "hub={inertia=5, motion={kind='free', torque={kind='table', file='measured.csv'}}}",
            make: &Of(|k: Table, c| {
                profile::covering(profile::table(&k.file, &TORQUE, k.interpolation, c)?, c, "file")
            }),
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the torque",
            source: "",
            example: "hub={inertia=5, motion={kind='free', torque={kind='expression', formula='2*sin(t)'}}}",
            make: &Of(|k: Formula, c| profile::covering(profile::of_time(&k.formula, c)?, c, "formula")),
        },
    ],
};

keys! {
    struct Gains {
        /// gain of the angle
        proportional: f64 = quantity(&ANGULAR_STIFFNESS, NotNegative);
        /// gain of the speed
        derivative: f64 = quantity(&ANGULAR_DAMPING, NotNegative);
        /// angle to be reached
        target: f64 = quantity(&ANGLE, Any);
        /// largest speed of the reference on its way to the target; a step if left out
        rate: Option<f64> = quantity(&ANGULAR_SPEED, Positive);
        /// largest torque of the actuator; no limit if left out
        limit: Option<f64> = quantity(&TORQUE, Positive);
    }
}

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
            example: "hub={inertia=5, motion={kind='free', speed=1, controller={kind='none'}}}",
            make: &Of(|_: Nothing, _| Ok(None)),
        },
        Kind {
            name: "pd",
            summary: "proportional–derivative control of the angle, towards a target reached at a limited rate",
            source: "",
            example: "hub={inertia=5, motion={kind='free', controller={kind='pd', proportional=20, derivative=4, target='90 deg', rate='60 deg/s', limit=9}}}",
            make: &Of(pd),
        },
    ],
};

keys! {
    /// What a case says of a hub that is free to rotate.
    pub(super) struct Free {
        /// angle of the hub at the start
        angle: f64 = quantity(&ANGLE, Any).or(0.0);
        /// speed of the hub at the start
        speed: f64 = quantity(&ANGULAR_SPEED, Any).or(0.0);
        /// torque on the hub
        torque: Shared = kind(&TORQUE_ON_HUB).or_name("constant");
        /// viscous restraint of the hub
        damping: f64 = quantity(&ANGULAR_DAMPING, NotNegative).or(0.0);
        /// spring restraint of the hub
        stiffness: f64 = quantity(&ANGULAR_STIFFNESS, NotNegative).or(0.0);
        /// angle at which the spring is at rest
        rest_angle: f64 = quantity(&ANGLE, Any).or(0.0);
        /// controller of the angle
        controller: Option<Control> = kind(&CONTROLLER).or_name("none");
    }
}

/// A torque of closed form that covers the run.
fn simple<P: Profile + 'static>(torque: Result<P, ProfileError>, c: &Context<'_>) -> Made<Shared> {
    profile::covering(Arc::new(profile::checked(torque, "kind")?), c, "kind")
}

/// The reference goes to the target at the rate, or is there from the start.
fn pd(k: Gains, _: &Context<'_>) -> Made<Option<Control>> {
    let Gains { proportional, derivative, target, rate, limit } = k;
    let limit = limit.unwrap_or(f64::INFINITY);
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
pub(super) fn free_hub(k: Free) -> Made<FreeHub> {
    let Free { angle, speed, torque, damping, stiffness, rest_angle, controller } = k;
    let controller = profile::checked(controller.map(|control| control(angle)).transpose(), "controller")?;
    Ok(FreeHub { angle, speed, actuator: Actuator { torque, damping, stiffness, rest_angle, controller } })
}
