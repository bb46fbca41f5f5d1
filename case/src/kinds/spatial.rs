//! What is common to the tables of a system in space, and its loads and springs.

use super::amplitude::{CHANGE, amplitude};
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made, both};
use crate::kind::{Choice, Kind, Table};
use crate::units::{ACCELERATION, DAMPING, FACTOR, FORCE, FORCE_PER_LENGTH, LENGTH, TORQUE};
use crate::values::Values;
use flexion::hub_beam::load::Amplitude;
use flexion::multibody::rotation::{Matrix3, frame};
use flexion::multibody::{Axes, rotation::Vector};

/// The keys of the axes of a body or joint.
pub(super) const MARKED: [Key; 2] = [
    key("axis", Type::Quantities(&FACTOR, Any), Empty, "direction of the third axis, [0, 0, 1] if left out"),
    key(
        "across",
        Type::Quantities(&FACTOR, Any),
        Empty,
        "direction to which the first axis points, as far as the third allows; chosen if left out",
    ),
];

/// Whether a name can begin the names of columns, and is not taken by columns of another kind.
const TAKEN: [&str; 7] = ["ground", "energy", "step", "time", "constraint", "momentum", "angular_momentum"];

/// Gravity, at the top of a case.
pub const GRAVITY: Key = key(
    "gravity",
    Type::Quantities(&ACCELERATION, Any),
    Empty,
    "acceleration of gravity along x, y and z, none if left out",
);

static MODEL_KEYS: [Key; 2] = [
    key(
        "drop-redundant-rows",
        Type::Boolean,
        Default::Boolean(false),
        "rows of joints that follow from others are left out, in place of an error, and have no forces; a run ends where they no \
         longer follow",
    ),
    key(
        "refine",
        Type::Integer(1, 1000),
        Default::Integer(1),
        "into how many each element of the beams is cut",
    ),
];

/// What is kept of the equations.
pub const MODEL: Key = key("model", Type::Table(&MODEL_KEYS), Empty, "model of the system");

/// Three components, or zeros where the key is left out.
pub(crate) fn vector(v: &Values, key: &str) -> Made<Vector> {
    Ok(optional_vector(v, key)?.unwrap_or_default())
}

/// Three components, if the key is given.
pub(crate) fn optional_vector(v: &Values, key: &str) -> Made<Option<Vector>> {
    match *v.numbers(key)? {
        [] => Ok(None),
        [x, y, z] => Ok(Some([x, y, z])),
        ref other => {
            let message = format!("a vector in space has 3 components, not {}", other.len());
            Err(Fault::new(key, message).into())
        }
    }
}

/// The axes that `axis` and `across` describe.
pub(super) fn direction(v: &Values) -> Made<Matrix3> {
    let axis = optional_vector(v, "axis")?.unwrap_or([0.0, 0.0, 1.0]);
    let across = optional_vector(v, "across")?;
    let fault =
        |key: &str| Fault::new(key, "has no direction: one of its components must not be zero").into();
    if across == Some([0.0; 3]) {
        return Err(fault("across"));
    }
    frame(axis, across).ok_or_else(|| fault("axis"))
}

/// The name of a part, or that of its number, e.g. `joint2`, where none is written.
pub(super) fn name(v: &Values, otherwise: Option<&str>) -> Made<String> {
    let Some(name) = (match otherwise {
        Some(_) => v.optional_text("name")?,
        None => Some(v.text("name")?),
    }) else {
        return Ok(String::new());
    };
    let plain = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if !name.starts_with(char::is_alphabetic) || !name.chars().all(plain) {
        let message = format!("`{name}` cannot begin the name of a column");
        let help = "begin with a letter, and go on with letters, digits, `-` and `_`";
        return Err(Fault::new("name", message).help(help).into());
    }
    if TAKEN.contains(&name) {
        return Err(Fault::new("name", format!("`{name}` has a meaning of its own")).into());
    }
    Ok(name.to_owned())
}

/// What the components of a load refer to.
pub static AXES: Choice<Axes> = Choice {
    name: "axes of a load",
    path: "load.axes",
    summary: "what the components of a load in space refer to",
    kinds: &[
        Kind {
            name: "dead",
            summary: "axes of space: force and couple keep their directions",
            source: "",
            keys: &[],
            example: "load=[{on='bar', force=[0, 3, 0], axes='dead'}]",
            make: |_, _| Ok(Axes::Dead),
        },
        Kind {
            name: "follower",
            summary: "axes of the body or section: force and couple turn with it",
            source: "",
            keys: &[],
            example: "load=[{on='bar', force=[0, 3, 0], axes='follower'}]",
            make: |_, _| Ok(Axes::Follower),
        },
    ],
};

/// A force and a couple on a part.
#[derive(Clone, Debug)]
pub struct Load {
    /// Name; empty where none is given.
    pub name: String,
    /// Name of the part.
    pub on: String,
    /// Point of space where it acts at the start \[m\].
    pub at: Option<Vector>,
    /// Force \[N\].
    pub force: Vector,
    /// Couple [N·m].
    pub couple: Vector,
    /// What the components refer to.
    pub axes: Axes,
    /// Change with time.
    pub amplitude: Amplitude,
}

const NAME: Key =
    key("name", Type::Text, Optional, "name, for messages and columns; that of its number if left out");

/// The tables `[[load]]`.
pub static LOAD: Table<Load> = Table {
    key: key(
        "load",
        Type::Tables(&[
            NAME,
            key("on", Type::Text, Required, "body, or place of a beam: `hub`, `blade.tip`"),
            key(
                "at",
                Type::Quantities(&LENGTH, Any),
                Empty,
                "point of a body where it acts, in space at the start; its centre of mass if left out",
            ),
            key("force", Type::Quantities(&FORCE, Any), Empty, "components of the force"),
            key("couple", Type::Quantities(&TORQUE, Any), Empty, "components of the couple"),
            key("axes", Type::Choice(&AXES), Default::Name("dead"), "what the components refer to"),
            CHANGE,
        ]),
        Empty,
        "forces and couples",
    ),
    example: "load=[{name='push', on='bar', at=[1, 0, 0], force=[0, '3 N', 1], couple=[0, 0, '1 N*m']}]",
    make: |v, c| {
        let (axes, amplitude) = both(AXES.make(v, "axes", c), amplitude(v, c))?;
        let (force, couple) = (vector(v, "force")?, vector(v, "couple")?);
        if force == [0.0; 3] && couple == [0.0; 3] {
            let message = "is neither a force nor a couple: give `force`, `couple` or both";
            return Err(Fault::new("", message).into());
        }
        let (name, on) = (name(v, Some("load"))?, v.text("on")?.to_owned());
        Ok(Load { name, on, at: optional_vector(v, "at")?, force, couple, axes, amplitude })
    },
};

/// A load along a beam.
#[derive(Clone, Debug)]
pub struct LineLoad {
    /// Name; empty where none is given.
    pub name: String,
    /// Name of the beam.
    pub on: String,
    /// Where it begins and ends \[m\]; `None` at the end of the beam.
    pub range: (f64, Option<f64>),
    /// Force per length [N/m].
    pub force: Vector,
    /// What the components refer to.
    pub axes: Axes,
    /// Change with time.
    pub amplitude: Amplitude,
}

/// The tables `[[distributed-load]]` of a system in space.
pub static LINE_LOAD: Table<LineLoad> = Table {
    key: key(
        "distributed-load",
        Type::Tables(&[
            NAME,
            key("on", Type::Text, Required, "beam"),
            key("from", Quantity(&LENGTH, NotNegative), Default::Number(0.0), "arc length where it begins"),
            key("to", Quantity(&LENGTH, Positive), Optional, "arc length where it ends, the tip if left out"),
            key(
                "force",
                Type::Quantities(&FORCE_PER_LENGTH, Any),
                Required,
                "components of the force per length",
            ),
            key("axes", Type::Choice(&AXES), Default::Name("dead"), "what the components refer to"),
            CHANGE,
        ]),
        Empty,
        "forces per length along beams or parts of them",
    ),
    example: "beam=[{length=1, section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}, root='clamped'}]\n\
              distributed-load=[{on='beam', from='20 cm', to='60 cm', force=[0, 0, '-2 N/m'], axes='follower'}]",
    make: |v, c| {
        let (axes, amplitude) = both(AXES.make(v, "axes", c), amplitude(v, c))?;
        let (name, on) = (name(v, Some("load"))?, v.text("on")?.to_owned());
        let range = (v.number("from")?, v.optional_number("to")?);
        if range.1.is_some_and(|to| to <= range.0) {
            return Err(Fault::new("to", "the load must end behind its begin, `from`").into());
        }
        Ok(LineLoad { name, on, range, force: vector(v, "force")?, axes, amplitude })
    },
};

/// A spring and a damper between two parts.
#[derive(Clone, Debug)]
pub struct Spring {
    /// Name; empty where none is given.
    pub name: String,
    /// Names of the parts.
    pub between: [String; 2],
    /// Points of space where its ends are fixed at the start \[m\].
    pub ends: [Option<Vector>; 2],
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping [N·s/m].
    pub damping: f64,
    /// Length without force \[m\], that at the start where none is given.
    pub length: Option<f64>,
}

/// The two parts that a table joins.
pub(super) fn between(v: &Values) -> Made<[String; 2]> {
    let names = v.texts("between")?;
    names.to_vec().try_into().map_err(|_| {
        let message = format!("takes two parts, not {}", names.len());
        Fault::new("between", message).help("write for example `between = [\"ground\", \"hub\"]`").into()
    })
}

pub(super) const BETWEEN: Key = key(
    "between",
    Type::Texts,
    Required,
    "the two parts: `ground`, bodies, or places of beams such as `blade.root` and `blade.tip`",
);

/// The tables `[[spring]]`.
pub static SPRING: Table<Spring> = Table {
    key: key(
        "spring",
        Type::Tables(&[
            NAME,
            BETWEEN,
            key(
                "from",
                Type::Quantities(&LENGTH, Any),
                Empty,
                "point of space where it is fixed to the first part at the start",
            ),
            key("to", Type::Quantities(&LENGTH, Any), Empty, "the same of the second part"),
            key("stiffness", Quantity(&FORCE_PER_LENGTH, NotNegative), Required, "stiffness k"),
            key(
                "damping",
                Quantity(&DAMPING, NotNegative),
                Default::Number(0.0),
                "force over rate of the length, c",
            ),
            key(
                "length",
                Quantity(&LENGTH, NotNegative),
                Optional,
                "length without force, that at the start if left out",
            ),
        ]),
        Empty,
        "springs and dampers between two points",
    ),
    example: "spring=[{name='cord', between=['ground', 'bar'], from=[0, 0, '1 m'], to=[1, 0, 0], stiffness='200 N/m', damping='2 N s/m', length='80 cm'}]",
    make: |v, _| {
        Ok(Spring {
            name: name(v, Some("spring"))?,
            between: between(v)?,
            ends: [optional_vector(v, "from")?, optional_vector(v, "to")?],
            stiffness: v.number("stiffness")?,
            damping: v.number("damping")?,
            length: v.optional_number("length")?,
        })
    },
};
