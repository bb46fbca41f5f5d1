//! The motion of the hub: kinds, keys and makers.

use super::profile::{self, Shared};
use super::torque;
use crate::declaration::{Bound::*, Key, Presence::Required, Type, Type::Quantity, key};
use crate::fault::{Faults, Made};
use crate::kind::{Choice, Context, Kind};
use crate::units::{ANGULAR_SPEED, TIME};
use crate::values::Values;
use flexion::hub_beam::Drive;
use flexion::profile::{Constant, Motion, Profile, ProfileError, Ramp, SpinUp};
use std::sync::Arc;

/// Makes a motion of the profile of the quantity that a table or a formula gives.
type Given = fn(Shared) -> Motion;

fn speed(profile: Shared) -> Motion {
    Motion::Speed { profile, initial_angle: 0.0 }
}

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
            keys: &[],
            example: "hub.motion={kind='expression', formula='sin(t)^2', of='speed'}",
            make: |_, _| Ok(speed),
        },
        Kind {
            name: "angle",
            summary: "the angle of the hub [rad]",
            source: "",
            keys: &[],
            example: "hub.motion={kind='expression', formula='sin(t)^2', of='angle'}",
            make: |_, _| Ok(Motion::Angle),
        },
    ],
};

const SPEED: Key = key("speed", Quantity(&ANGULAR_SPEED, Any), Required, "angular speed Ω reached");
const DURATION: Key = key("time", Quantity(&TIME, Positive), Required, "time T in which it is reached");
const GIVES: Key = key("of", Type::Choice(&OF), Required, "quantity that is given");

/// A motion that is validated over the run, with what is wrong with it at `key`.
fn prescribed(motion: Motion, c: &Context<'_>, key: &str) -> Made<Drive> {
    profile::checked(motion.validate(c.duration()?), key)?;
    Ok(Drive::Prescribed(motion))
}

/// A motion whose speed is one of the profiles of closed form.
fn of_speed<P: Profile + 'static>(profile: Result<P, ProfileError>, c: &Context<'_>) -> Made<Drive> {
    prescribed(speed(Arc::new(profile::checked(profile, "kind")?)), c, "kind")
}

/// The motion by the profile of the quantity that `of` names.
fn given(profile: Made<Shared>, v: &Values, c: &Context<'_>, key: &str) -> Made<Drive> {
    let motion: Result<_, Faults> = OF.make(v, "of", c);
    prescribed(motion?(profile?), c, key)
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
            keys: &[SPEED, DURATION],
            example: "hub.motion={kind='spin-up', speed='3000 rpm', time='1 min'}",
            make: |v, c| of_speed(SpinUp::new(v.number("speed")?, v.number("time")?), c),
        },
        Kind {
            name: "constant",
            summary: "constant angular speed",
            source: "",
            keys: &[key("speed", Quantity(&ANGULAR_SPEED, Any), Required, "angular speed Ω")],
            example: "hub.motion={kind='constant', speed='-90 deg/s'}",
            make: |v, c| of_speed(Constant::new(v.number("speed")?), c),
        },
        Kind {
            name: "ramp",
            summary: "angular speed growing linearly from rest, then constant",
            source: "",
            keys: &[SPEED, DURATION],
            example: "hub.motion={kind='ramp', speed='0.1 rev/s', time=3}",
            make: |v, c| of_speed(Ramp::new(0.0, v.number("speed")?, v.number("time")?), c),
        },
        Kind {
            name: "table",
            summary: "table of time and angular speed or angle",
            source: "",
            keys: &[
                key("file", Type::Path, Required, "CSV file with the columns t [s] and value"),
                GIVES,
                profile::INTERPOLATION,
            ],
            example: "hub.motion={kind='table', file='measured.csv', of='speed'}",
            make: |v, c| given(profile::table(v, c), v, c, "file"),
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the angular speed or the angle",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in t, in rad/s or rad"), GIVES],
            example: "hub.motion={kind='expression', formula='4*sin(t)', of='speed'}",
            make: |v, c| given(profile::of_time(v, c), v, c, "formula"),
        },
        Kind {
            name: "free",
            summary: "free to rotate, driven by torques, restrained or controlled",
            source: "",
            keys: torque::KEYS,
            example: "hub={inertia=5, motion={kind='free', angle='10 deg', speed='1 rad/s', damping='0.1 N*m*s/rad', stiffness=2, rest-angle=0.1}}",
            make: |v, c| torque::free_hub(v, c).map(Drive::Free),
        },
    ],
};
