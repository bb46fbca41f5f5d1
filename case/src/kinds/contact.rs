//! Contacts: what may touch which obstacle, and what happens then.

use super::name::{NAME, name, numbered};
use super::obstacle::{OBSTACLE, Placed};
use super::vector::optional_vector;
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made, both};
use crate::kind::{Choice, Context, Kind, Table};
use crate::places::{Parts, Place};
use crate::units::{LENGTH, VELOCITY};
use crate::values::Values;
use flexion::contact::{ContactForce, Dissipation, Law};
use flexion::hub_beam::Mount;
use flexion::linalg::Vec3;

/// Most points of the whole beam.
const MOST_POINTS: i64 = 1000;

/// What may touch an obstacle.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Name, which begins the names of its columns; empty until its number is known.
    pub name: String,
    /// What may touch.
    pub on: Touching,
    /// Point of a body, in space at the start \[m\].
    pub at: Option<Vec3>,
    /// Radius of the ball about the point, or of the beam \[m\].
    pub radius: f64,
    /// What the obstacle is fixed to.
    pub mount: Mount,
    /// The obstacle, in axes of what it is fixed to.
    pub obstacle: Placed,
    /// What happens at a touch; the stiffness of a force on points along a whole beam is one per length.
    pub law: Law,
    /// Whether the tip loses its mass for it.
    pub massless: bool,
}

/// A contact of the beam.
#[derive(Clone, Debug)]
pub struct OnBeam {
    /// What the case says of it.
    pub contact: Contact,
    /// Names, stations \[m\] and laws of its points.
    pub points: Vec<(String, f64, Law)>,
}

/// What may touch.
#[derive(Clone, Debug, PartialEq)]
pub enum Touching {
    /// Places, each a contact of its own.
    Places(Vec<Place>),
    /// A whole beam, where it is nearest to the obstacle.
    Beam(usize),
    /// The points that cut a beam into so many equal parts.
    Points {
        /// Number of the beam.
        beam: usize,
        /// Number of the parts.
        parts: usize,
    },
}

/// A point that may touch: its name, place and law.
pub type Point = (String, Place, Law);

impl Contact {
    /// Its points; that at the root of a beam is none where the root is `held`.
    pub fn points(&self, parts: &Parts, held: bool) -> Vec<Point> {
        let name = |k: usize| format!("{}.{}", self.name, k + 1);
        match &self.on {
            Touching::Beam(beam) => vec![(self.name.clone(), Place::Beam(*beam), self.law)],
            Touching::Places(places) if places.len() == 1 => vec![(self.name.clone(), places[0], self.law)],
            Touching::Places(places) => {
                places.iter().enumerate().map(|(k, place)| (name(k), *place, self.law)).collect()
            }
            Touching::Points { beam, parts: n } => {
                let length = parts.beams[*beam].1;
                let point = |(i, k): (usize, usize)| {
                    let s = if k == *n { length } else { length * k as f64 / *n as f64 };
                    let law = share(self.law, length / *n as f64, k == 0 || k == *n);
                    let name = if *n == 1 && held { self.name.clone() } else { name(i) };
                    (name, Place::Station { beam: *beam, s }, law)
                };
                (usize::from(held)..=*n).enumerate().map(point).collect()
            }
        }
    }
}

/// What an obstacle is fixed to.
pub static MOUNT: Choice<Mount> = Choice {
    name: "mount",
    path: "contact.mount",
    summary: "what an obstacle is fixed to",
    kinds: &[
        Kind {
            name: "ground",
            summary: "axes of space",
            source: "",
            keys: &[],
            example: "contact=[{mount='ground', obstacle={kind='plane', point=[0, '-1 mm']}, law={kind='hertz', stiffness=1e4}}]\n\
                      hub.motion={kind='constant', speed='-0.1 rad/s'}",
            make: |_, _| Ok(Mount::Ground),
        },
        Kind {
            name: "hub",
            summary: "radial and transverse axis of the hub, from its axis: the obstacle turns with it",
            source: "",
            keys: &[],
            example: "contact=[{mount='hub', obstacle={kind='plane', point=[0, '-1 um']}, law={kind='hertz', stiffness=1e5}}]",
            make: |_, _| Ok(Mount::Hub),
        },
    ],
};

const RESTITUTION: Key =
    key("restitution", Type::Number(Between(0.0, 1.0)), Required, "nominal coefficient of restitution e");
const STIFFNESS: Key =
    key("stiffness", Type::Number(Positive), Required, "K in N/mⁿ, with `points` that of a length of 1 m");
const EXPONENT: Key = key("exponent", Type::Number(Between(1.0, 4.0)), Default::Number(1.5), "n");
const FRICTION: Key =
    key("friction", Type::Number(NotNegative), Default::Number(0.0), "coefficient of friction μ");
const SLIP_SPEED: Key = key(
    "slip-speed",
    Quantity(&VELOCITY, Positive),
    Default::Number(0.01),
    "sliding speed v_s of the regularised friction, −μ F tanh(v/v_s)",
);
const DAMPED: &[Key] = &[STIFFNESS, EXPONENT, RESTITUTION, FRICTION, SLIP_SPEED];

/// A continuous force K δⁿ (1 + χ δ̇/v₀).
fn force(v: &Values, dissipation: Dissipation) -> Made<(Law, bool)> {
    let restitution = if dissipation == Dissipation::Hertz { 1.0 } else { v.number("restitution")? };
    if restitution == 0.0 && dissipation.needs_rebound() {
        let message = "with e = 0 this law has no finite damping";
        let help = "take `hunt-crossley` or `lankarani-nikravesh`, or a `constraint`";
        return Err(Fault::new("restitution", message).help(help).into());
    }
    let law = Law::Force(ContactForce {
        stiffness: v.number("stiffness")?,
        exponent: v.number("exponent")?,
        factor: dissipation.factor(restitution),
        friction: v.number("friction")?,
        slip_speed: v.number("slip-speed")?,
    });
    Ok((law, false))
}

/// The laws of contact, and whether the point has no mass for them.
pub static LAW: Choice<(Law, bool)> = Choice {
    name: "contact law",
    path: "contact.law",
    summary: "what happens where the beam touches an obstacle",
    kinds: &[
        Kind {
            name: "massless",
            summary: "the tip has no mass of its own: it is stopped without impulse and loss, and no restitution is needed",
            source: "Khenous, Laborde & Renard 2008, doi:10.1016/j.euromechsol.2008.01.001; arXiv 2207.00795",
            keys: &[],
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='massless'}}]",
            make: |_, _| Ok((Law::Constraint { restitution: 0.0, friction: 0.0 }, true)),
        },
        Kind {
            name: "constraint",
            summary: "impulse with Newton's restitution, then a constraint until it would pull; Coulomb friction",
            source: "Pfeiffer & Glocker 1996, doi:10.1002/9783527618385",
            keys: &[RESTITUTION, FRICTION],
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='constraint', restitution=0.5}}]",
            make: |v, _| {
                let (restitution, friction) = (v.number("restitution")?, v.number("friction")?);
                Ok((Law::Constraint { restitution, friction }, false))
            },
        },
        Kind {
            name: "hertz",
            summary: "elastic force K δⁿ of the indentation δ",
            source: "Hertz 1881, doi:10.1515/crll.1882.92.156",
            keys: &[STIFFNESS, EXPONENT, FRICTION, SLIP_SPEED],
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='hertz', stiffness=1e5}}]",
            make: |v, _| force(v, Dissipation::Hertz),
        },
        Kind {
            name: "hunt-crossley",
            summary: "the same damped by χ = 3(1 − e)/2 in K δⁿ (1 + χ δ̇/v₀)",
            source: "Hunt & Crossley 1975, doi:10.1115/1.3423596",
            keys: DAMPED,
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='hunt-crossley', stiffness=1e5, restitution=0.5}}]",
            make: |v, _| force(v, Dissipation::HuntCrossley),
        },
        Kind {
            name: "lankarani-nikravesh",
            summary: "the same with χ = 3(1 − e²)/4",
            source: "Lankarani & Nikravesh 1990, doi:10.1115/1.2912617",
            keys: DAMPED,
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='lankarani-nikravesh', stiffness=1e5, restitution=0.5}}]",
            make: |v, _| force(v, Dissipation::LankaraniNikravesh),
        },
        Kind {
            name: "flores",
            summary: "the same with χ = 8(1 − e)/(5e)",
            source: "Flores et al. 2011, doi:10.1007/s11044-010-9237-4",
            keys: DAMPED,
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='flores', stiffness=1e5, restitution=0.5}}]",
            make: |v, _| force(v, Dissipation::Flores),
        },
        Kind {
            name: "gonthier",
            summary: "the same with χ = (1 − e²)/e",
            source: "Gonthier et al. 2004, doi:10.1023/B:MUBO.0000029392.21648.bc",
            keys: DAMPED,
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='gonthier', stiffness=1e5, restitution=0.5}}]",
            make: |v, _| force(v, Dissipation::Gonthier),
        },
        Kind {
            name: "matched",
            summary: "the same with the χ that gives back e itself to a single mass",
            source: "χ (1 + e) = ln[(1 + χ)/(1 − χ e)], the exact rebound of that force",
            keys: DAMPED,
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='matched', stiffness=1e5, restitution=0.5}}]",
            make: |v, _| force(v, Dissipation::Matched),
        },
    ],
};

/// What may touch: the places of `on`, the whole beam that it names, or the tip of the only beam.
fn touching(v: &Values, c: &Context<'_>) -> Made<Touching> {
    let parts = c.parts()?;
    let tip = ["tip".to_owned()];
    let names = if v.is_written("on") { v.texts("on")? } else { &tip };
    let find = |name: &String| parts.find(name).map_err(|fault| Fault { key: "on".to_owned(), ..fault });
    let places = names.iter().map(find).collect::<Result<Vec<_>, _>>()?;
    let points = if v.optional("points")?.is_some() { Some(v.count("points")?) } else { None };
    match (&places[..], points) {
        ([], _) => Err(Fault::new("on", "names no place").into()),
        ([Place::Beam(beam)], Some(parts)) => Ok(Touching::Points { beam: *beam, parts }),
        (_, Some(_)) => {
            let message = "belong to a whole beam, and `on` names none";
            Err(Fault::new("points", message).help("write for example `on = \"beam\"`").into())
        }
        ([Place::Beam(beam)], None) => Ok(Touching::Beam(*beam)),
        (places, None) => {
            for (i, place) in places.iter().enumerate() {
                let name = &names[i];
                let message = match place {
                    Place::Ground => "a point of the ground touches nothing".to_owned(),
                    Place::Beam(_) => format!("`{name}` is a whole beam, and one of several places is meant"),
                    _ if places[..i].contains(place) => {
                        format!("`{name}` is the same place as one before it")
                    }
                    _ => continue,
                };
                return Err(Fault::new("on", message).into());
            }
            Ok(Touching::Places(places.to_vec()))
        }
    }
}

/// The tables `[[contact]]`.
pub static CONTACT: Table<Contact> = Table {
    key: key(
        "contact",
        Type::Tables(&[
            NAME,
            key(
                "on",
                Type::Places,
                Optional,
                "what may touch: a body, a place of a beam, a list of them, or a whole beam, where it is nearest to the obstacle or by \
                 `points`; the tip of the only beam if left out",
            ),
            key(
                "at",
                Type::Quantities(&LENGTH, Any),
                Empty,
                "point of a body that may touch, in space at the start; its centre of mass if left out",
            ),
            key(
                "radius",
                Quantity(&LENGTH, NotNegative),
                Default::Number(0.0),
                "radius of the ball about the point, which slides and rolls on the obstacle, or of a beam that is round",
            ),
            key(
                "points",
                Type::Integer(1, MOST_POINTS),
                Optional,
                "number of equidistant points, the last at the tip, by which a whole beam may touch, and one more at the root where \
                 nothing holds it",
            ),
            key("obstacle", Type::Kind(&OBSTACLE), Required, "rigid obstacle"),
            key(
                "mount",
                Type::Choice(&MOUNT),
                Optional,
                "what the obstacle is fixed to, in whose axes it is given: the ground if left out, the hub of a stop",
            ),
            key("law", Type::Kind(&LAW), Default::Name("massless"), "what happens at a touch"),
        ]),
        Empty,
        "contacts with obstacles",
    ),
    example: "contact=[{name='floor', on='beam', points=4, obstacle={kind='plane', point=[0, '-2 mm']}, law={kind='constraint', restitution=0, friction=0.3}}]",
    make: |v, c| {
        let (on, (obstacle, (law, massless))) =
            both(touching(v, c), both(OBSTACLE.make(v, "obstacle", c), LAW.make(v, "law", c)))?;
        let mount = match v.optional("mount")? {
            None if obstacle.stop => Mount::Hub,
            None => Mount::Ground,
            Some(_) => MOUNT.make(v, "mount", c)?,
        };
        if obstacle.stop && mount == Mount::Ground {
            let help = "leave the mount out, or take a `plane`";
            return Err(Fault::new("mount", "a stop is fixed to the hub").help(help).into());
        }
        let at = optional_vector(v, "at")?;
        if at.is_some() && !matches!(&on, Touching::Places(places) if matches!(places[..], [Place::Body(_)]))
        {
            let help = "write `on = \"beam@2 m\"` for one place of a beam";
            return Err(Fault::new("at", "is a point of a body, and `on` names none").help(help).into());
        }
        let (name, radius) = (name(v, &["hub"])?, v.number("radius")?);
        Ok(Contact { name, on, at, radius, mount, obstacle, law, massless })
    },
};

/// All contacts with their names: `contact`, `contact2`, … where none is given.
///
/// # Errors
/// At a name that two contacts have.
pub fn contacts(v: &Values, c: &Context<'_>) -> Made<Vec<Contact>> {
    let mut contacts = CONTACT.make(v, c)?;
    for k in 0..contacts.len() {
        let name = numbered(&contacts[k].name, "contact", k);
        if contacts[..k].iter().any(|other| other.name == name) {
            let message = format!("two contacts are called `{name}`");
            return Err(Fault::new(format!("contact[{}].name", k + 1), message).into());
        }
        contacts[k].name = name;
    }
    Ok(contacts)
}

/// The law of one of the points, `spacing` \[m\] apart, by which a beam may touch everywhere and whose force is one per length: by the
/// trapezium rule, half of it at an end.
fn share(law: Law, spacing: f64, end: bool) -> Law {
    let length = if end { 0.5 * spacing } else { spacing };
    match law {
        Law::Force(force) => Law::Force(ContactForce { stiffness: length * force.stiffness, ..force }),
        law => law,
    }
}
