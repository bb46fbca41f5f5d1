//! Joints of a system in space, and what drives them.

use super::motion::MOTION;
use super::name::{NAME, name};
use super::profile::{self, Given, INTERPOLATION, Through, speed};
use super::spring::between;
use super::vector::{ACROSS, AXIS, direction};
use crate::declaration::Bound::*;
use crate::fault::{Fault, Made};
use crate::keys::{Field, File, Named, choice, keys, kind, path, quantity, text, texts, vector};
use crate::kind::{Choice, Is, Kind, Of, Table};
use crate::places::Place;
use crate::units::{DAMPING, FORCE, FORCE_PER_LENGTH, LENGTH, VELOCITY};
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
            example: "joint=[{kind='fixed', between=['ground', 'bar'], at=[0, 0, 0]}]",
            make: &Is(Freedom::Fixed),
        },
        Kind {
            name: "revolute",
            summary: "a rotation about its axis: five rows",
            source: "",
            example: "joint=[{kind='revolute', between=['ground', 'bar'], at=[0, 0, 0], axis=[0, 1, 0]}]",
            make: &Is(Freedom::Revolute),
        },
        Kind {
            name: "prismatic",
            summary: "a displacement along its axis: five rows",
            source: "",
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], axis=[0, 1, -1]}]",
            make: &Is(Freedom::Prismatic),
        },
        Kind {
            name: "cylindrical",
            summary: "a rotation about its axis and a displacement along it: four rows",
            source: "",
            example: "joint=[{kind='cylindrical', between=['ground', 'bar'], at=[0, 0, 0], axis=[0, 1, -1]}]",
            make: &Is(Freedom::Cylindrical),
        },
        Kind {
            name: "universal",
            summary: "rotations about both arms of a cross: `across` on the first part, and normal to it and to `axis` on the \
                      second: four rows",
            source: "",
            example: "joint=[{kind='universal', between=['ground', 'bar'], at=[0, 0, 0], axis=[1, 0, 0], across=[0, 1, 1]}]",
            make: &Is(Freedom::Universal),
        },
        Kind {
            name: "spherical",
            summary: "all rotations about its point: three rows",
            source: "",
            example: "joint=[{kind='spherical', between=['ground', 'bar'], at=[0, '5 cm', 0]}]",
            make: &Is(Freedom::Spherical),
        },
        Kind {
            name: "planar",
            summary: "displacements across its axis, and rotations about it: three rows",
            source: "",
            example: "joint=[{kind='planar', between=['ground', 'bar'], axis=[0, 1, 0.3]}]",
            make: &Is(Freedom::Planar),
        },
    ],
};

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
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='expression', formula='sin(t)^2', of='speed'}}]",
            make: &Is(Given { motion: speed, measure: &VELOCITY }),
        },
        Kind {
            name: "displacement",
            summary: "the displacement [m]",
            source: "",
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='expression', formula='sin(t)^2', of='displacement'}}]",
            make: &Is(Given { motion: Motion::Angle, measure: &LENGTH }),
        },
    ],
};

const OF_TRAVEL: Field<Given> = choice(&TRAVEL_OF).called("of", "quantity that is given");

keys! {
    struct Steady {
        /// speed
        speed: f64 = quantity(&VELOCITY, Any);
    }

    struct Rows {
        /// CSV file with the columns t and value, in SI or with the units in their titles
        file: File = path();
        interpolation: Through = INTERPOLATION;
        of: Given = OF_TRAVEL;
    }

    struct Formula {
        /// formula in t, in m/s or m
        formula: String = text();
        of: Given = OF_TRAVEL;
    }

    struct Free {
        /// force on the second part
        force: f64 = quantity(&FORCE, Any).or(0.0);
        /// force over speed
        damping: f64 = quantity(&DAMPING, NotNegative).or(0.0);
        /// force over displacement
        stiffness: f64 = quantity(&FORCE_PER_LENGTH, NotNegative).or(0.0);
        /// displacement at which the spring is at rest
        rest: f64 = quantity(&LENGTH, Any).or(0.0);
    }
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
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='constant', speed='2 m/s'}}]",
            make: &Of(|k: Steady, _| {
                let profile = profile::checked(Constant::new(k.speed), "speed")?;
                Ok(Drive::Prescribed(speed(Arc::new(profile))))
            }),
        },
        Kind {
            name: "table",
            summary: "table of time and speed or displacement",
            source: "",
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='table', file='measured.csv', of='displacement'}}]",
            make: &Of(|k: Rows, c| profile::tabled(&k.file, k.of, k.interpolation, c).map(Drive::Prescribed)),
        },
        Kind {
            name: "expression",
            summary: "formula of time t [s] for the speed or the displacement",
            source: "",
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='expression', formula='4*t', of='speed'}}]",
            make: &Of(|k: Formula, c| profile::formulated(&k.formula, k.of, c).map(Drive::Prescribed)),
        },
        Kind {
            name: "free",
            summary: "free to slide, with a force, a spring and a damper",
            source: "",
            example: "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='free', force=3, damping=2, stiffness='100 N/m', rest='1 cm'}}]",
            make: &Of(|Free { force, damping, stiffness, rest: rest_angle }, _| {
                let torque = Arc::new(profile::checked(Constant::new(force), "force")?);
                Ok(Drive::Actuated(Actuator { torque, damping, stiffness, rest_angle, controller: None }))
            }),
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

keys! {
    /// What a case says of a joint.
    struct Written {
        name: Option<String> = NAME;
        /// motions that it leaves free
        kind: Named<Freedom> = choice(&JOINT);
        /// the two parts: `ground`, bodies, or places of beams such as `blade.root` and `blade.tip`
        between: Vec<String> = texts();
        /// its point in space at the start; the second part's own if left out
        at: Option<Vec3> = vector(&LENGTH);
        axis: Option<Vec3> = AXIS;
        across: Option<Vec3> = ACROSS;
        /// rotation of a revolute or cylindrical joint: prescribed, or driven by a torque
        motion: Option<hub_beam::Drive> = kind(&MOTION);
        /// displacement of a prismatic joint: prescribed, or driven by a force
        travel: Option<Drive> = kind(&TRAVEL);
    }
}

/// The tables `[[joint]]`.
pub static JOINTS: Table<Joint> = Table::list(
    "joint",
    "joints between two parts",
    "joint=[{name='hinge', kind='revolute', between=['ground', 'bar'], at=[0, 0, 0], axis=[0, 1, 0], \
     motion={kind='free', angle='10 deg', stiffness=2, damping='0.1 N*m*s/rad'}}]",
    &Of(|k: Written, c| {
        let (drive, start) = drive(k.motion, k.travel, &k.kind)?;
        let (name, between) = (name(k.name, &["ground"])?, between(&k.between, c)?);
        let written = [k.kind.name.to_owned(), k.between[0].clone(), k.between[1].clone()];
        let axes = direction(k.axis, k.across)?;
        Ok(Joint { name, kind: k.kind.made, written, between, at: k.at, axes, drive, start })
    }),
);

/// What moves a joint, and its coordinate at the start.
fn drive(
    motion: Option<hub_beam::Drive>,
    travel: Option<Drive>,
    Named { name, made: kind }: &Named<Freedom>,
) -> Made<(Drive, f64)> {
    if travel.is_some() && *kind != Freedom::Prismatic {
        let message = format!("`travel` moves a prismatic joint, and this one is {name}");
        return Err(Fault::new("travel", message).into());
    }
    if motion.is_some() && !matches!(kind, Freedom::Revolute | Freedom::Cylindrical) {
        let message = format!("`motion` rotates a revolute or cylindrical joint, and this one is {name}");
        let help = "a prismatic joint is moved by `travel`";
        let fault = Fault::new("motion", message);
        return Err(if *kind == Freedom::Prismatic { fault.help(help) } else { fault }.into());
    }
    let drive = match motion {
        Some(hub_beam::Drive::Prescribed(motion)) => Drive::Prescribed(motion),
        Some(hub_beam::Drive::Free(hub)) if hub.speed != 0.0 => {
            let message = "the speed of a joint at the start is that of its parts";
            let help = "give `velocity` and `spin` to the bodies instead";
            return Err(Fault::new("motion.speed", message).help(help).into());
        }
        Some(hub_beam::Drive::Free(hub)) => return Ok((Drive::Actuated(hub.actuator), hub.angle)),
        None => travel.unwrap_or(Drive::None),
    };
    let start = if let Drive::Prescribed(motion) = &drive { motion.at(0.0).angle } else { 0.0 };
    Ok((drive, start))
}
