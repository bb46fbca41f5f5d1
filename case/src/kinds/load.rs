//! Forces, couples and forces per length.

use super::amplitude::{CHANGE, DISTRIBUTION};
use super::force_law::FORCE_LAW;
use super::name::{NAME, name};
use crate::declaration::Bound::*;
use crate::fault::{Fault, Made, both};
use crate::keys::{Later, Moment, choice, keys, kind, moment, place, quantity, vector};
use crate::kind::{Choice, Context, Is, Kind, Of, Table};
use crate::places::Place;
use crate::units::{FORCE, FORCE_PER_LENGTH, LENGTH, TORQUE};
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
            example: "load=[{on='1 m', force=[0, '3 N'], axes='dead'}]",
            make: &Is(Axes::Dead),
        },
        Kind {
            name: "hub",
            summary: "radial and transverse axis of the hub: the load rotates with it",
            source: "",
            example: "load=[{on='1 m', force=[0, 3], axes='hub'}]",
            make: &Is(Axes::Hub),
        },
        Kind {
            name: "follower",
            summary: "axes of the body, or tangent and normal of the beam: the load rotates with the body or the section",
            source: "",
            example: "load=[{on='1 m', force=[0, 3], axes='follower'}]",
            make: &Is(Axes::Follower),
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

keys! {
    /// What a case says of a load.
    pub(crate) struct Written {
        name: Option<String> = NAME;
        /// place where it acts, or the beam along which it acts
        on: Place = place();
        /// point of a body where it acts, in space at the start; its centre of mass if left out
        at: Option<Vec3> = vector(&LENGTH);
        /// components of the force at the place
        force: Option<Vec3> = vector(&FORCE);
        /// couple at the place: a number is about z
        couple: Option<Moment> = moment(&TORQUE);
        /// components of the force per length along the beam
        force_per_length: Option<Vec3> = vector(&FORCE_PER_LENGTH);
        /// arc length where a force per length begins, the root if left out
        from: Option<f64> = quantity(&LENGTH, NotNegative);
        /// arc length where it ends, the tip if left out
        to: Option<f64> = quantity(&LENGTH, Positive);
        /// factor of a force per length against the arc length, 1 if left out
        distribution: Later<Amplitude> = kind(&DISTRIBUTION);
        /// law by which a force per length follows from the motion, in the place of `force-per-length`
        law: Option<Arc<dyn ForceLaw>> = kind(&FORCE_LAW);
        /// axes of the components
        axes: Axes = choice(&AXES).or_name("dead");
        amplitude: Amplitude = CHANGE;
    }
}

/// The tables `[[load]]`.
pub static LOAD: Table<Load> = Table::list(
    "load",
    "forces, couples, and forces per length",
    "load=[{on='tip', force=['0 N', '3 N']}, {on='beam@1 m', couple='3 N*m'}, {on='beam', force-per-length=[0, '-2 N/m'], from='0.5 m', to='1 m'}]",
    &Of(|k: Written, c| {
        let acts = if let Place::Beam(beam) = k.on { along(&k, c, beam)? } else { at(&k)? };
        Ok(Load { name: name(k.name, &[])?, acts, axes: k.axes, amplitude: k.amplitude })
    }),
);

/// Refuses the keys that a load of this sort does not have.
fn without(written: &[(bool, &str)], message: &str, help: &str) -> Made<()> {
    let first = written.iter().find(|(written, _)| *written);
    first.map_or(Ok(()), |(_, key)| Err(Fault::new(*key, message).help(help).into()))
}

fn at(k: &Written) -> Made<Acts> {
    let message = "belongs to a force per length, and this place is a point";
    let help = "name the whole beam, `on = \"beam\"`, or give `force` in N";
    let of_length = [
        (k.force_per_length.is_some(), "force-per-length"),
        (k.from.is_some(), "from"),
        (k.to.is_some(), "to"),
        (k.distribution.is_given(), "distribution"),
        (k.law.is_some(), "law"),
    ];
    without(&of_length, message, help)?;
    if k.on == Place::Ground {
        return Err(Fault::new("on", "a load on the ground moves nothing").into());
    }
    if k.at.is_some() && !matches!(k.on, Place::Body(_)) {
        return Err(Fault::new("at", "is a point of a body, and the place is a station of a beam").into());
    }
    if k.force.is_none() && k.couple.is_none() {
        let message = "is neither a force nor a couple: give `force`, `couple` or both";
        return Err(Fault::new("", message).into());
    }
    let couple = k.couple.map_or(Vec3::ZERO, |Moment(couple)| couple);
    Ok(Acts::At { on: k.on, at: k.at, force: k.force.unwrap_or_default(), couple })
}

fn along(k: &Written, c: &Context<'_>, beam: usize) -> Made<Acts> {
    let message = "acts at a place, and `on` names a whole beam";
    let help = "name a place, `on = \"tip\"`, or give `force-per-length` in N/m";
    let of_place = [(k.force.is_some(), "force"), (k.couple.is_some(), "couple"), (k.at.is_some(), "at")];
    without(&of_place, message, help)?;
    let length = c.parts()?.beams[beam].1;
    let c = &Context { length: Some(length), ..*c };
    let (from, to) = (k.from.unwrap_or(0.0), k.to.unwrap_or(length));
    both(c.on_beam(from, "from"), c.on_beam(to, "to"))?;
    if from >= to {
        let message = format!("the load begins at {from} m and ends at {to} m: it has no length");
        return Err(Fault::new("from", message).into());
    }
    if let Some(law) = &k.law {
        let message = "is of a force per length that is given, and `law` says what this one is";
        let given =
            [(k.force_per_length.is_some(), "force-per-length"), (k.distribution.is_given(), "distribution")];
        without(&given, message, "leave it out, or write a second [[load]]")?;
        let message = "is of a force that is given, and the force of a `law` follows from the motion alone";
        let given = [(k.axes != Axes::Dead, "axes"), (k.amplitude.is_some(), "amplitude")];
        without(&given, message, "leave it out")?;
        return Ok(Acts::By { beam, range: (from, to), law: Arc::clone(law) });
    }
    let distribution = k.distribution.make("distribution", c)?.flatten();
    let known = distribution.as_ref().map(|of| of.range());
    if let Some((first, last)) = known.filter(|(first, last)| *first > from || *last < to) {
        let message = format!(
            "covers the stations from {first} m to {last} m, and the load acts from {from} m to {to} m"
        );
        let help = "extend it with factors of the rest, or write `from` and `to`";
        return Err(Fault::new("distribution", message).help(help).into());
    }
    let Some(force) = k.force_per_length else {
        let message =
            "is no load: give `force-per-length` or a `law`, or name a place for a `force` or a `couple`";
        return Err(Fault::new("", message).into());
    };
    Ok(Acts::Along { beam, range: (from, to), force, distribution })
}
