//! Joints of a system in space, and what drives them.

use super::motion::MOTION;
use super::name::{NAME, name};
use super::profile::{self, Shared};
use super::spring::between;
use super::vector::{MARKED, direction, optional_vector};
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made};
use crate::kind::{Choice, Context, Kind, Table};
use crate::places::Place;
use crate::units::{DAMPING, FORCE, FORCE_PER_LENGTH, LENGTH, VELOCITY};
use crate::values::Values;
use flexion::drive::Actuator;
use flexion::hub_beam;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::{Drive, Kind as Freedom};
use flexion::profile::{Constant, Motion};
use std::sync::Arc;

/// The kinds of joint.
pub static JOINT: Choice<Freedom> = Choice {
    name: "joint",
    path: "joint.kind",
    summary: "what a joint leaves free",
    kinds: &[
        Kind {
            name: "fixed",
            summary: "nothing: six rows",
            source: "",
            keys: &[],
            example: "joint=[{kind='fixed', between=['ground', 'bar'], at=[0, 0, 0]}]",
            make: |_, _| Ok(Freedom::Fixed),
        },
        Kind {
            name: "revolute",
            summary: "a rotation about its axis: five rows",
            source: "",
            keys: &[],
            example: "joint=[{kind='revolute', between=['ground', 'bar'], at=[0, 0, 0], axis=[0, 1, 0]}]",
            make: |_, _| Ok(Freedom::Revolute),
        },
        Kind {
            name: "prismatic",
            summary: "a displacement along its axis: five rows",
            source: "",
            keys: &[],
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], axis=[0, 1, -1]}]",
            make: |_, _| Ok(Freedom::Prismatic),
        },
        Kind {
            name: "cylindrical",
            summary: "a rotation about its axis and a displacement along it: four rows",
            source: "",
            keys: &[],
            example: "joint=[{kind='cylindrical', between=['ground', 'bar'], at=[0, 0, 0], axis=[0, 1, -1]}]",
            make: |_, _| Ok(Freedom::Cylindrical),
        },
        Kind {
            name: "universal",
            summary: "rotations about both arms of a cross: `across` on the first part, and normal to it and to `axis` on the \
                      second: four rows",
            source: "",
            keys: &[],
            example: "joint=[{kind='universal', between=['ground', 'bar'], at=[0, 0, 0], axis=[1, 0, 0], across=[0, 1, 1]}]",
            make: |_, _| Ok(Freedom::Universal),
        },
        Kind {
            name: "spherical",
            summary: "all rotations about its point: three rows",
            source: "",
            keys: &[],
            example: "joint=[{kind='spherical', between=['ground', 'bar'], at=[0, '5 cm', 0]}]",
            make: |_, _| Ok(Freedom::Spherical),
        },
        Kind {
            name: "planar",
            summary: "displacements across its axis, and rotations about it: three rows",
            source: "",
            keys: &[],
            example: "joint=[{kind='planar', between=['ground', 'bar'], axis=[0, 1, 0.3]}]",
            make: |_, _| Ok(Freedom::Planar),
        },
    ],
};

/// Makes a motion of the profile of the quantity that a table or a formula gives.
type Given = fn(Shared) -> Motion;

/// Which quantity of a displacement a table or a formula gives.
pub static TRAVEL_OF: Choice<Given> = Choice {
    name: "travel quantity",
    path: "joint.travel.of",
    summary: "what a table or formula of a displacement gives",
    kinds: &[
        Kind {
            name: "speed",
            summary: "the speed [m/s]",
            source: "",
            keys: &[],
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='expression', formula='sin(t)^2', of='speed'}}]",
            make: |_, _| Ok(|profile| Motion::Speed { profile, initial_angle: 0.0 }),
        },
        Kind {
            name: "displacement",
            summary: "the displacement [m]",
            source: "",
            keys: &[],
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='expression', formula='sin(t)^2', of='displacement'}}]",
            make: |_, _| Ok(Motion::Angle),
        },
    ],
};

const GIVES: Key = key("of", Type::Choice(&TRAVEL_OF), Required, "quantity that is given");

fn given(profile: Shared, v: &Values, c: &Context<'_>, key: &str) -> Made<Drive> {
    let motion = TRAVEL_OF.make(v, "of", c)?(profile);
    profile::checked(motion.validate(c.duration()?), key)?;
    Ok(Drive::Prescribed(motion))
}

/// What moves a prismatic joint.
pub static TRAVEL: Choice<Drive> = Choice {
    name: "travel",
    path: "joint.travel",
    summary: "what moves a prismatic joint along its axis",
    kinds: &[
        Kind {
            name: "constant",
            summary: "constant speed",
            source: "",
            keys: &[key("speed", Quantity(&VELOCITY, Any), Required, "speed")],
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='constant', speed='2 m/s'}}]",
            make: |v, _| {
                let profile = profile::checked(Constant::new(v.number("speed")?), "speed")?;
                Ok(Drive::Prescribed(Motion::Speed { profile: Arc::new(profile), initial_angle: 0.0 }))
            },
        },
        Kind {
            name: "table",
            summary: "table of time and speed or displacement",
            source: "",
            keys: &[
                key("file", Type::Path, Required, "CSV file with the columns t [s] and value"),
                profile::INTERPOLATION,
                GIVES,
            ],
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='table', file='measured.csv', of='displacement'}}]",
            make: |v, c| given(profile::table(v, c)?, v, c, "file"),
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the speed or the displacement",
            source: "",
            keys: &[key("formula", Type::Text, Required, "formula in t, in m/s or m"), GIVES],
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='expression', formula='4*t', of='speed'}}]",
            make: |v, c| given(profile::of_time(v, c)?, v, c, "formula"),
        },
        Kind {
            name: "free",
            summary: "free to slide, with a force, a spring and a damper",
            source: "",
            keys: &[
                key("force", Quantity(&FORCE, Any), Default::Number(0.0), "force on the second part"),
                key("damping", Quantity(&DAMPING, NotNegative), Default::Number(0.0), "force over speed"),
                key(
                    "stiffness",
                    Quantity(&FORCE_PER_LENGTH, NotNegative),
                    Default::Number(0.0),
                    "force over displacement",
                ),
                key(
                    "rest",
                    Quantity(&LENGTH, Any),
                    Default::Number(0.0),
                    "displacement at which the spring is at rest",
                ),
            ],
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='free', force=3, damping=2, stiffness='100 N/m', rest='1 cm'}}]",
            make: |v, _| {
                let torque = Arc::new(profile::checked(Constant::new(v.number("force")?), "force")?);
                let (damping, stiffness) = (v.number("damping")?, v.number("stiffness")?);
                let rest_angle = v.number("rest")?;
                Ok(Drive::Actuated(Actuator { torque, damping, stiffness, rest_angle, controller: None }))
            },
        },
    ],
};

/// A joint between two parts.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name; empty where none is given.
    pub name: String,
    /// What it leaves free.
    pub kind: Freedom,
    /// The same as written, and the parts.
    pub written: [String; 3],
    /// The parts.
    pub between: [Place; 2],
    /// Its point in space at the start \[m\].
    pub at: Option<Vec3>,
    /// Its axes.
    pub axes: Mat3,
    /// What moves it.
    pub drive: Drive,
    /// Angle or displacement that it has at the start.
    pub start: f64,
}

/// The tables `[[joint]]`.
pub static JOINTS: Table<Joint> = Table {
    key: key(
        "joint",
        Type::Tables(&[
            NAME,
            key("kind", Type::Choice(&JOINT), Required, "what it leaves free"),
            key(
                "between",
                Type::Texts,
                Required,
                "the two parts: `ground`, bodies, or places of beams such as `blade.root` and `blade.tip`",
            ),
            key(
                "at",
                Type::Quantities(&LENGTH, Any),
                Empty,
                "its point in space at the start; the second part's own if left out",
            ),
            MARKED[0],
            MARKED[1],
            key(
                "motion",
                Type::Kind(&MOTION),
                Optional,
                "rotation of a revolute or cylindrical joint: prescribed, or driven by a torque",
            ),
            key(
                "travel",
                Type::Kind(&TRAVEL),
                Optional,
                "displacement of a prismatic joint: prescribed, or driven by a force",
            ),
        ]),
        Empty,
        "joints between two parts",
    ),
    example: "joint=[{name='hinge', kind='revolute', between=['ground', 'bar'], at=[0, 0, 0], axis=[0, 1, 0], \
              motion={kind='free', angle='10 deg', stiffness=2, damping='0.1 N*m*s/rad'}}]",
    make: |v, c| {
        let kind = JOINT.make(v, "kind", c)?;
        let (drive, start) = drive(v, c, kind)?;
        let (name, between) = (name(v, &["ground"])?, between(v, c)?);
        let parts = v.texts("between")?;
        let written = [v.text("kind")?.to_owned(), parts[0].clone(), parts[1].clone()];
        Ok(Joint {
            name,
            kind,
            written,
            between,
            at: optional_vector(v, "at")?,
            axes: direction(v)?,
            drive,
            start,
        })
    },
};

/// What moves a joint, and its coordinate at the start.
fn drive(v: &Values, c: &Context<'_>, kind: Freedom) -> Made<(Drive, f64)> {
    let (turns, slides) = (v.optional("motion")?.is_some(), v.optional("travel")?.is_some());
    let name = v.text("kind")?;
    if slides && kind != Freedom::Prismatic {
        let message = format!("`travel` moves a prismatic joint, and this one is {name}");
        return Err(Fault::new("travel", message).into());
    }
    if turns && !matches!(kind, Freedom::Revolute | Freedom::Cylindrical) {
        let message = format!("`motion` rotates a revolute or cylindrical joint, and this one is {name}");
        let help = "a prismatic joint is moved by `travel`";
        let fault = Fault::new("motion", message);
        return Err(if kind == Freedom::Prismatic { fault.help(help) } else { fault }.into());
    }
    let drive = match (turns, slides) {
        (true, _) => match MOTION.make(v, "motion", c)? {
            hub_beam::Drive::Prescribed(motion) => Drive::Prescribed(motion),
            hub_beam::Drive::Free(hub) if hub.speed != 0.0 => {
                let message = "the speed of a joint at the start is that of its parts";
                let help = "give `velocity` and `spin` to the bodies instead";
                return Err(Fault::new("motion.speed", message).help(help).into());
            }
            hub_beam::Drive::Free(hub) => return Ok((Drive::Actuated(hub.actuator), hub.angle)),
        },
        (_, true) => TRAVEL.make(v, "travel", c)?,
        _ => Drive::None,
    };
    let start = if let Drive::Prescribed(motion) = &drive { motion.at(0.0).angle } else { 0.0 };
    Ok((drive, start))
}
