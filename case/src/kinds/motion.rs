//! The motion of the hub: kinds, keys and makers.

use super::profile::{self, Given, INTERPOLATION, Through, speed};
use super::torque;
use crate::declaration::Bound::*;
use crate::fault::Made;
use crate::keys::{Field, File, choice, keys, path, quantity, text};
use crate::kind::{Choice, Context, Is, Kind, Of};
use crate::units::{ANGLE, ANGULAR_SPEED, TIME};
use flexion::hub_beam::Drive;
use flexion::profile::{Constant, Motion, Profile, ProfileError, Ramp, SpinUp};
use std::sync::Arc;

/// Which quantity a table or a formula gives.
pub static OF: Choice<Given> = Choice {
    name: "motion quantity",
    path: "hub.motion.of",
    summary: "what a table or formula gives",
    kinds: &[
        Kind {
            name: "speed",
            summary: "the angular speed of the hub [rad/s]",
            source: "",
            example: "hub.motion={kind='expression', formula='sin(t)^2', of='speed'}",
            make: &Is(Given { motion: speed, measure: &ANGULAR_SPEED }),
        },
        Kind {
            name: "angle",
            summary: "the angle of the hub [rad]",
            source: "",
            example: "hub.motion={kind='expression', formula='sin(t)^2', of='angle'}",
            make: &Is(Given { motion: Motion::Angle, measure: &ANGLE }),
        },
    ],
};

keys! {
    struct Reached {
        /// angular speed Ω reached
        speed: f64 = quantity(&ANGULAR_SPEED, Any);
        /// time T in which it is reached
        time: f64 = quantity(&TIME, Positive);
    }

    struct Steady {
        /// angular speed Ω
        speed: f64 = quantity(&ANGULAR_SPEED, Any);
    }
}

const OF_MOTION: Field<Given> = choice(&OF).called("of", "quantity that is given");

keys! {
    struct Table {
        /// CSV file with the columns t and value, in SI or with the units in their titles
        file: File = path();
        of: Given = OF_MOTION;
        interpolation: Through = INTERPOLATION;
    }

    struct Formula {
        /// formula in t, in rad/s or rad
        formula: String = text();
        of: Given = OF_MOTION;
    }
}

/// A motion whose speed is one of the profiles of closed form.
fn of_speed<P: Profile + 'static>(profile: Result<P, ProfileError>, c: &Context<'_>) -> Made<Drive> {
    let motion = speed(Arc::new(profile::checked(profile, "kind")?));
    profile::validated(motion, c, "kind").map(Drive::Prescribed)
}

/// The kinds of motion.
pub static MOTION: Choice<Drive> = Choice {
    name: "motion",
    path: "hub.motion",
    summary: "rotation of the hub: prescribed, or free",
    kinds: &[
        Kind {
            name: "spin-up",
            summary: "smooth spin-up from rest: Ω t/T − Ω/(2π) sin(2πt/T), then Ω",
            source: "Kane, Ryan & Banerjee 1987, doi:10.2514/3.20195",
            example: "hub.motion={kind='spin-up', speed='3000 rpm', time='1 min'}",
            make: &Of(|k: Reached, c| of_speed(SpinUp::new(k.speed, k.time), c)),
        },
        Kind {
            name: "constant",
            summary: "constant angular speed",
            source: "",
            example: "hub.motion={kind='constant', speed='-90 deg/s'}",
            make: &Of(|k: Steady, c| of_speed(Constant::new(k.speed), c)),
        },
        Kind {
            name: "ramp",
            summary: "angular speed growing linearly from rest, then constant",
            source: "",
            example: "hub.motion={kind='ramp', speed='0.1 rev/s', time=3}",
            make: &Of(|k: Reached, c| of_speed(Ramp::new(0.0, k.speed, k.time), c)),
        },
        Kind {
            name: "table",
            summary: "table of time and angular speed or angle",
            source: "",
            example: "hub.motion={kind='table', file='measured.csv', of='speed'}",
            make: &Of(|k: Table, c| {
                profile::tabled(&k.file, k.of, k.interpolation, c).map(Drive::Prescribed)
            }),
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the angular speed or the angle",
            source: "",
            example: "hub.motion={kind='expression', formula='4*sin(t)', of='speed'}",
            make: &Of(|k: Formula, c| profile::formulated(&k.formula, k.of, c).map(Drive::Prescribed)),
        },
        Kind {
            name: "free",
            summary: "free to rotate, driven by torques, restrained or controlled",
            source: "",
            example: "hub={inertia=5, motion={kind='free', angle='10 deg', speed='1 rad/s', damping='0.1 N*m*s/rad', stiffness=2, rest-angle=0.1}}",
            make: &Of(|k, _| torque::free_hub(k).map(Drive::Free)),
        },
    ],
};
