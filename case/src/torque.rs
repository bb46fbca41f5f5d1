//! What turns a free hub: the torque on it and the controller of its angle.

use super::declaration::{
    Bound::*, Key, Kind, Presence as Default, Presence::*, Seam, Type, Type::Quantity, key,
};
use super::units::{ANGLE, ANGULAR_DAMPING, ANGULAR_SPEED, ANGULAR_STIFFNESS, TIME, TORQUE};
use super::values::Values;
use std::path::{Path, PathBuf};

/// The torque on a free hub against time, in SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Torque {
    /// Constant; zero for a hub that nothing drives.
    Constant {
        /// Torque [N·m].
        torque: f64,
    },
    /// Growing linearly from zero, then constant.
    Ramp {
        /// Torque reached [N·m].
        torque: f64,
        /// Time in which it is reached \[s\].
        time: f64,
    },
    /// A table of time and torque.
    Table {
        /// File with two columns: t \[s\] and torque [N·m].
        file: PathBuf,
    },
    /// A formula in `t` \[s\].
    Expression {
        /// The formula, in N·m.
        formula: String,
    },
}

/// Proportional–derivative controller of the hub's angle, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Controller {
    /// Gain K_p [N·m/rad].
    pub proportional: f64,
    /// Gain K_d [N·m·s/rad].
    pub derivative: f64,
    /// Angle to be reached \[rad\].
    pub target: f64,
    /// Largest speed of the reference on its way to the target [rad/s]; a step when `None`.
    pub rate: Option<f64>,
    /// Largest torque of the actuator [N·m]; no limit when `None`.
    pub limit: Option<f64>,
}

/// A hub that is free to turn, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Free {
    /// Angle at the start \[rad\].
    pub angle: f64,
    /// Speed at the start [rad/s].
    pub speed: f64,
    /// Torque.
    pub torque: Torque,
    /// Viscous restraint [N·m·s/rad].
    pub damping: f64,
    /// Spring restraint [N·m/rad].
    pub stiffness: f64,
    /// Angle at which the spring is at rest \[rad\].
    pub rest_angle: f64,
    /// Controller of the angle.
    pub controller: Option<Controller>,
}

/// The kinds of torque.
pub(super) static TORQUES: Seam = Seam {
    name: "torque",
    path: "hub.motion.torque",
    summary: "torque on a free hub",
    kinds: &[
        Kind {
            name: "constant",
            summary: "constant torque",
            source: "",
            keys: &[key("torque", Quantity(&TORQUE, Any), Default::Number(0.0), "torque on the hub")],
        },
        Kind {
            name: "ramp",
            summary: "torque growing linearly from zero, then constant",
            source: "",
            keys: &[
                key("torque", Quantity(&TORQUE, Any), Required, "torque reached"),
                key("time", Quantity(&TIME, Positive), Required, "time in which it is reached"),
            ],
        },
        Kind {
            name: "table",
            summary: "table of time and torque",
            source: "",
            keys: &[key("file", Type::Path, Required, "CSV file with the columns t [s] and torque [N·m]")],
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the torque",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in t, in N·m")],
        },
    ],
};

/// The kinds of controller.
pub(super) static CONTROLLERS: Seam = Seam {
    name: "controller",
    path: "hub.motion.controller",
    summary: "controller of the angle of a free hub",
    kinds: &[
        Kind { name: "none", summary: "no controller", source: "", keys: &[] },
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
        },
    ],
};

/// The keys of a free hub.
pub(super) const KEYS: &[Key] = &[
    key("angle", Quantity(&ANGLE, Any), Default::Number(0.0), "angle of the hub at the start"),
    key("speed", Quantity(&ANGULAR_SPEED, Any), Default::Number(0.0), "speed of the hub at the start"),
    key("torque", Type::Kind(&TORQUES), Default::Name("constant"), "torque on the hub"),
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
    key("controller", Type::Kind(&CONTROLLERS), Default::Name("none"), "controller of the angle"),
];

/// Reads a free hub; `folder` is that of the case.
pub(super) fn read(v: &Values, folder: &Path) -> Option<Free> {
    let (kind, t) = v.kind("torque")?;
    let torque = match kind.name {
        "ramp" => Torque::Ramp { torque: t.number("torque")?, time: t.number("time")? },
        "table" => Torque::Table { file: folder.join(t.text("file")?) },
        "expression" => Torque::Expression { formula: t.text("formula")?.to_owned() },
        _ => Torque::Constant { torque: t.number("torque")? },
    };
    let (kind, c) = v.kind("controller")?;
    let controller = match kind.name {
        "pd" => Some(Controller {
            proportional: c.number("proportional")?,
            derivative: c.number("derivative")?,
            target: c.number("target")?,
            rate: c.number("rate"),
            limit: c.number("limit"),
        }),
        _ => None,
    };
    Some(Free {
        angle: v.number("angle")?,
        speed: v.number("speed")?,
        torque,
        damping: v.number("damping")?,
        stiffness: v.number("stiffness")?,
        rest_angle: v.number("rest-angle")?,
        controller,
    })
}
