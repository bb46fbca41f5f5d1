//! The motion of the hub: kinds and their keys.

use super::declaration::{Bound::*, Key, Kind, Presence::Required, Seam, Type, Type::Quantity, key};
use super::torque::{self, Free};
use super::units::{ANGULAR_SPEED, TIME};
use super::values::Values;
use std::path::{Path, PathBuf};

/// The motion of the hub, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// Smooth spin-up from rest to `speed` [rad/s] in `time` \[s\].
    SpinUp {
        /// Final angular speed Ω [rad/s].
        speed: f64,
        /// Duration T of the spin-up \[s\].
        time: f64,
    },
    /// Constant angular speed [rad/s].
    Constant {
        /// Ω [rad/s].
        speed: f64,
    },
    /// Angular speed growing linearly from rest.
    Ramp {
        /// Final angular speed Ω [rad/s].
        speed: f64,
        /// Duration T of the ramp \[s\].
        time: f64,
    },
    /// A table of time and value.
    Table {
        /// File with two columns: t \[s\] and the value.
        file: PathBuf,
        /// What the second column is.
        of: MotionOf,
    },
    /// A formula in `t` \[s\].
    Expression {
        /// The formula.
        formula: String,
        /// What it gives.
        of: MotionOf,
    },
    /// Not prescribed: the hub is turned by torques.
    Free(Free),
}

/// Which quantity a table or a formula gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionOf {
    /// The angle θ \[rad\].
    Angle,
    /// The angular speed θ̇ [rad/s].
    Speed,
}

static OF: Seam = Seam {
    name: "motion quantity",
    path: "hub.motion.of",
    summary: "what a table or formula gives",
    kinds: &[
        Kind { name: "speed", summary: "the angular speed of the hub [rad/s]", source: "", keys: &[] },
        Kind { name: "angle", summary: "the angle of the hub [rad]", source: "", keys: &[] },
    ],
};

const SPEED: Key = key("speed", Quantity(&ANGULAR_SPEED, Any), Required, "angular speed Ω reached");
const DURATION: Key = key("time", Quantity(&TIME, Positive), Required, "time T in which it is reached");
const GIVES: Key = key("of", Type::Choice(&OF), Required, "quantity that is given");

/// The kinds of motion.
pub(super) static SEAM: Seam = Seam {
    name: "motion",
    path: "hub.motion",
    summary: "rotation of the hub: prescribed, or free",
    kinds: &[
        Kind {
            name: "spin-up",
            summary: "smooth spin-up from rest: Ω t/T − Ω/(2π) sin(2πt/T), then Ω",
            source: "Kane, Ryan & Banerjee 1987, doi:10.2514/3.20195",
            keys: &[SPEED, DURATION],
        },
        Kind {
            name: "constant",
            summary: "constant angular speed",
            source: "",
            keys: &[key("speed", Quantity(&ANGULAR_SPEED, Any), Required, "angular speed Ω")],
        },
        Kind {
            name: "ramp",
            summary: "angular speed growing linearly from rest, then constant",
            source: "",
            keys: &[SPEED, DURATION],
        },
        Kind {
            name: "table",
            summary: "table of time and angular speed or angle",
            source: "",
            keys: &[key("file", Type::Path, Required, "CSV file with the columns t [s] and value"), GIVES],
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the angular speed or the angle",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in t, in rad/s or rad"), GIVES],
        },
        Kind {
            name: "free",
            summary: "free to turn, driven by torques, restrained or controlled",
            source: "",
            keys: torque::KEYS,
        },
    ],
};

/// Reads the motion; `folder` is that of the case.
pub(super) fn read(kind: &Kind, v: &Values, folder: &Path) -> Option<Motion> {
    let of = || match v.text("of")? {
        "angle" => Some(MotionOf::Angle),
        _ => Some(MotionOf::Speed),
    };
    Some(match kind.name {
        "constant" => Motion::Constant { speed: v.number("speed")? },
        "ramp" => Motion::Ramp { speed: v.number("speed")?, time: v.number("time")? },
        "table" => Motion::Table { file: folder.join(v.text("file")?), of: of()? },
        "expression" => Motion::Expression { formula: v.text("formula")?.to_owned(), of: of()? },
        "free" => Motion::Free(torque::read(v, folder)?),
        _ => Motion::SpinUp { speed: v.number("speed")?, time: v.number("time")? },
    })
}
