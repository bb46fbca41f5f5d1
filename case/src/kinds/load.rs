//! Forces, couples and forces per length.

use super::amplitude::{CHANGE, DISTRIBUTION, amplitude};
use super::force_law::FORCE_LAW;
use super::name::{NAME, name};
use super::vector::{moment, optional_vector, vector};
use crate::declaration::{Bound::*, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made, both};
use crate::kind::{Choice, Context, Kind, Table};
use crate::places::Place;
use crate::units::{FORCE, FORCE_PER_LENGTH, LENGTH, TORQUE};
use crate::values::Values;
use flexion::hub_beam::load::{Amplitude, Axes};
use flexion::law::ForceLaw;
use flexion::linalg::Vec3;
use std::sync::Arc;

/// What the components of a load refer to.
pub static AXES: Choice<Axes> = Choice {
    name: "axes of a load",
    path: "load.axes",
    summary: "what the components of a load refer to",
    kinds: &[
        Kind {
            name: "dead",
            summary: "axes of space: the load keeps its direction",
            source: "",
            keys: &[],
            example: "load=[{on='1 m', force=[0, '3 N'], axes='dead'}]",
            make: |_, _| Ok(Axes::Dead),
        },
        Kind {
            name: "hub",
            summary: "radial and transverse axis of the hub: the load rotates with it",
            source: "",
            keys: &[],
            example: "load=[{on='1 m', force=[0, 3], axes='hub'}]",
            make: |_, _| Ok(Axes::Hub),
        },
        Kind {
            name: "follower",
            summary: "axes of the body, or tangent and normal of the beam: the load rotates with the body or the section",
            source: "",
            keys: &[],
            example: "load=[{on='1 m', force=[0, 3], axes='follower'}]",
            make: |_, _| Ok(Axes::Follower),
        },
    ],
};

/// A load.
#[derive(Clone, Debug)]
pub struct Load {
    /// Name; empty where none is given.
    pub name: String,
    /// What acts where.
    pub acts: Acts,
    /// What the components refer to.
    pub axes: Axes,
    /// Change with time.
    pub amplitude: Amplitude,
}

/// What acts where.
#[derive(Clone, Debug)]
pub enum Acts {
    /// A force and a couple at a place.
    At {
        /// The place: a body or a station.
        on: Place,
        /// Point of a body, in space at the start \[m\].
        at: Option<Vec3>,
        /// Force \[N\].
        force: Vec3,
        /// Couple [N·m].
        couple: Vec3,
    },
    /// A force per length along a beam.
    Along {
        /// Number of the beam.
        beam: usize,
        /// First and last station \[m\].
        range: (f64, f64),
        /// Force per length [N/m].
        force: Vec3,
        /// Factor of it against the station.
        distribution: Amplitude,
    },
    /// A force per length by a law along a beam.
    By {
        /// Number of the beam.
        beam: usize,
        /// First and last station \[m\].
        range: (f64, f64),
        /// The law.
        law: Arc<dyn ForceLaw>,
    },
}

/// The tables `[[load]]`.
pub static LOAD: Table<Load> = Table {
    key: key(
        "load",
        Type::Tables(&[
            NAME,
            key("on", Type::Place, Required, "place where it acts, or the beam along which it acts"),
            key(
                "at",
                Type::Quantities(&LENGTH, Any),
                Empty,
                "point of a body where it acts, in space at the start; its centre of mass if left out",
            ),
            key("force", Type::Quantities(&FORCE, Any), Empty, "components of the force at the place"),
            key("couple", Type::Moment(&TORQUE), Empty, "couple at the place: a number is about z"),
            key(
                "force-per-length",
                Type::Quantities(&FORCE_PER_LENGTH, Any),
                Empty,
                "components of the force per length along the beam",
            ),
            key(
                "from",
                Quantity(&LENGTH, NotNegative),
                Optional,
                "arc length where a force per length begins, the root if left out",
            ),
            key("to", Quantity(&LENGTH, Positive), Optional, "arc length where it ends, the tip if left out"),
            key(
                "distribution",
                Type::Kind(&DISTRIBUTION),
                Optional,
                "factor of a force per length against the arc length, 1 if left out",
            ),
            key(
                "law",
                Type::Kind(&FORCE_LAW),
                Optional,
                "law by which a force per length follows from the motion, in the place of `force-per-length`",
            ),
            key("axes", Type::Choice(&AXES), Default::Name("dead"), "what the components refer to"),
            CHANGE,
        ]),
        Empty,
        "forces, couples, and forces per length",
    ),
    example: "load=[{on='tip', force=['0 N', '3 N']}, {on='beam@1 m', couple='3 N*m'}, {on='beam', force-per-length=[0, '-2 N/m'], from='0.5 m', to='1 m'}]",
    make: |v, c| {
        let (axes, amplitude) = both(AXES.make(v, "axes", c), amplitude(v, c))?;
        let acts = match c.place(v, "on")? {
            Place::Beam(beam) => along(v, c, beam)?,
            place => at(v, place)?,
        };
        Ok(Load { name: name(v, &[])?, acts, axes, amplitude })
    },
};

/// Refuses the keys that a load of this sort does not have.
fn without(v: &Values, keys: &[&str], message: &str, help: &str) -> Made<()> {
    for key in keys {
        if v.is_written(key) {
            return Err(Fault::new(*key, message).help(help).into());
        }
    }
    Ok(())
}

fn at(v: &Values, on: Place) -> Made<Acts> {
    let message = "belongs to a force per length, and this place is a point";
    let help = "name the whole beam, `on = \"beam\"`, or give `force` in N";
    without(v, &["force-per-length", "from", "to", "distribution", "law"], message, help)?;
    if on == Place::Ground {
        return Err(Fault::new("on", "a load on the ground moves nothing").into());
    }
    let at = optional_vector(v, "at")?;
    if at.is_some() && !matches!(on, Place::Body(_)) {
        return Err(Fault::new("at", "is a point of a body, and the place is a station of a beam").into());
    }
    let (force, couple) = (vector(v, "force")?, moment(v, "couple")?);
    if !v.is_written("force") && !v.is_written("couple") {
        let message = "is neither a force nor a couple: give `force`, `couple` or both";
        return Err(Fault::new("", message).into());
    }
    Ok(Acts::At { on, at, force, couple })
}

fn along(v: &Values, c: &Context<'_>, beam: usize) -> Made<Acts> {
    let message = "acts at a place, and `on` names a whole beam";
    let help = "name a place, `on = \"tip\"`, or give `force-per-length` in N/m";
    without(v, &["force", "couple", "at"], message, help)?;
    let length = c.parts()?.beams[beam].1;
    let c = &Context { length: Some(length), ..*c };
    let from = v.optional_number("from")?.unwrap_or(0.0);
    let to = v.optional_number("to")?.unwrap_or(length);
    both(c.on_beam(from, "from"), c.on_beam(to, "to"))?;
    if from >= to {
        let message = format!("the load begins at {from} m and ends at {to} m: it has no length");
        return Err(Fault::new("from", message).into());
    }
    if v.has("law") {
        let law = by_law(v, c)?;
        return Ok(Acts::By { beam, range: (from, to), law });
    }
    let distribution = match v.optional("distribution")? {
        Some(_) => DISTRIBUTION.make(v, "distribution", c)?,
        None => None,
    };
    let Some(force) = optional_vector(v, "force-per-length")? else {
        let message =
            "is no load: give `force-per-length` or a `law`, or name a place for a `force` or a `couple`";
        return Err(Fault::new("", message).into());
    };
    Ok(Acts::Along { beam, range: (from, to), force, distribution })
}

/// The law of a load, which needs no more than the motion of the beam.
fn by_law(v: &Values, c: &Context<'_>) -> Made<Arc<dyn ForceLaw>> {
    let message = "is of a force per length that is given, and `law` says what this one is";
    without(v, &["force-per-length", "distribution"], message, "leave it out, or write a second [[load]]")?;
    for (key, other) in
        [("axes", v.text("axes")? != "dead"), ("amplitude", v.kind("amplitude") != Some("constant"))]
    {
        if other {
            let message =
                "is of a force that is given, and the force of a `law` follows from the motion alone";
            return Err(Fault::new(key, message).help("leave it out").into());
        }
    }
    FORCE_LAW.make(v, "law", c)
}
