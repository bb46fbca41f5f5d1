//! Contacts of the beam with rigid obstacles: where, with what, and what happens then.

use super::amplitude::{CHANGE, amplitude};
use crate::declaration::{Bound::*, Key, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Faults, Made, both};
use crate::kind::{Choice, Context, Kind, Table};
use crate::units::{ANGLE, LENGTH, VELOCITY};
use crate::values::Values;
use flexion::contact::{Circle, ContactForce, Dissipation, Law, Obstacle, Plane, Translation};
use flexion::hub_beam::Mount;
use flexion::profile::jumping_derivative;
use std::sync::Arc;

/// Most points of the whole beam.
pub(super) const MOST_POINTS: i64 = 1000;

/// Stations of the beam and the obstacle that they may touch.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Name, which begins the names of its columns; `None` for that of its number.
    pub name: Option<String>,
    /// Stations \[m\].
    pub stations: Vec<f64>,
    /// What the obstacle is fixed to.
    pub mount: Mount,
    /// The obstacle, in axes of what it is fixed to.
    pub obstacle: Arc<dyn Obstacle>,
    /// What happens at a touch; the stiffness of a force on points along the whole beam is one per length.
    pub law: Law,
    /// Whether the stations are points along the whole beam.
    pub whole: bool,
    /// Whether the tip loses its mass for it.
    pub massless: bool,
}

/// An obstacle, and what it is fixed to.
type Placed = (Arc<dyn Obstacle>, Mount);

/// Two coordinates in the plane, the third being zero.
fn place(v: &Values, name: &str) -> Made<[f64; 3]> {
    match *v.numbers(name)? {
        [x, y] => Ok([x, y, 0.0]),
        ref other => {
            let message = format!("a place in the plane has 2 coordinates, not {}", other.len());
            Err(Fault::new(name, message).into())
        }
    }
}

/// The motion of an obstacle; `None` for one at rest.
pub(super) fn motion(
    v: &Values,
    c: &Context<'_>,
    place: fn(&Values, &str) -> Made<[f64; 3]>,
) -> Made<Option<Translation>> {
    let Some(_) = v.optional("motion")? else { return Ok(None) };
    let v = v.table("motion")?;
    let made = || {
        let (direction, profile) = both(place(v, "displacement"), amplitude(v, c))?;
        let Some(displacement) = profile else {
            let message = "a constant amplitude is no motion: the obstacle keeps its place";
            let help =
                "give the amplitude as a `ramp`, a `table` or an `expression`, or leave the motion out";
            return Err(Fault::new(CHANGE.name, message).help(help).into());
        };
        let duration = c.duration()?;
        let within = |t: &&f64| **t > 0.0 && **t <= duration;
        let jumps = |t: &&f64| jumping_derivative(displacement.as_ref(), **t) == 0;
        if let Some(time) = displacement.breaks().iter().filter(within).find(jumps) {
            let message =
                format!("the displacement of the obstacle jumps at t = {time} s, which no motion does");
            return Err(Fault::new(CHANGE.name, message).into());
        }
        Ok(Some(Translation { direction, displacement }))
    };
    made().map_err(|faults: Faults| faults.within("motion"))
}

const MOUNT_KEY: Key = key(
    "mount",
    Type::Choice(&MOUNT),
    Default::Name("ground"),
    "what the obstacle is fixed to, in whose axes it is given",
);
/// Keys of the motion of an obstacle.
static MOVED: [Key; 2] = [
    key(
        "displacement",
        Type::Quantities(&LENGTH, Any),
        Required,
        "components of the displacement at the amplitude 1",
    ),
    CHANGE,
];
pub(super) const MOTION: Key = key(
    "motion",
    Type::Table(&MOVED),
    Optional,
    "prescribed translation of the obstacle, at rest if left out",
);

/// What an obstacle is fixed to.
pub static MOUNT: Choice<Mount> = Choice {
    name: "mount",
    path: "contact.obstacle.mount",
    summary: "what an obstacle is fixed to",
    kinds: &[
        Kind {
            name: "ground",
            summary: "inertial axes, from the axis of the hub",
            source: "",
            keys: &[],
            example: "contact=[{obstacle={kind='plane', mount='ground', point=[0, '-1 mm']}, law={kind='hertz', stiffness=1e4}}]\n\
                      hub.motion={kind='constant', speed='-0.1 rad/s'}",
            make: |_, _| Ok(Mount::Ground),
        },
        Kind {
            name: "hub",
            summary: "radial and transverse axis of the hub, from its axis: the obstacle turns with it",
            source: "",
            keys: &[],
            example: "contact=[{obstacle={kind='plane', mount='hub', point=[0, '-1 um']}, law={kind='hertz', stiffness=1e5}}]",
            make: |_, _| Ok(Mount::Hub),
        },
    ],
};

/// The kinds of obstacle.
pub static OBSTACLE: Choice<Placed> = Choice {
    name: "obstacle",
    path: "contact.obstacle",
    summary: "rigid obstacle that the beam may touch",
    kinds: &[
        Kind {
            name: "plane",
            summary: "half-plane behind a straight surface",
            source: "",
            keys: &[
                key("point", Type::Quantities(&LENGTH, Any), Required, "x and y of a point of the surface"),
                key(
                    "angle",
                    Quantity(&ANGLE, Any),
                    Default::Number(0.0),
                    "angle of the surface against the x axis; the free side is to its left",
                ),
                MOUNT_KEY,
                MOTION,
            ],
            example: "contact=[{obstacle={kind='plane', point=[0, '1 mm'], angle='180 deg'}, law={kind='hertz', stiffness=1e5}}]",
            make: |v, c| {
                let ((point, motion), mount) =
                    both(both(place(v, "point"), motion(v, c, place)), MOUNT.make(v, "mount", c))?;
                Ok((Arc::new(Plane::inclined(point, v.number("angle")?, motion)), mount))
            },
        },
        Kind {
            name: "circle",
            summary: "disc, or the outside of a hole",
            source: "",
            keys: &[
                key("centre", Type::Quantities(&LENGTH, Any), Required, "x and y of the centre"),
                key("radius", Quantity(&LENGTH, Positive), Required, "radius"),
                key(
                    "inside",
                    Type::Boolean,
                    Default::Boolean(false),
                    "the beam is inside the circle, in a hole",
                ),
                MOUNT_KEY,
                MOTION,
            ],
            example: "contact=[{obstacle={kind='circle', centre=[2, '501 mm'], radius='500 mm'}, law={kind='hertz', stiffness=1e5}}]",
            make: |v, c| {
                let ((centre, motion), mount) =
                    both(both(place(v, "centre"), motion(v, c, place)), MOUNT.make(v, "mount", c))?;
                let (radius, hollow) = (v.number("radius")?, v.boolean("inside")?);
                Ok((Arc::new(Circle { centre, axis: [0.0, 0.0, 1.0], radius, hollow, motion }), mount))
            },
        },
        Kind {
            name: "stop",
            summary: "stop beside the beam, fixed to the hub: bounds the deflection of the station",
            source: "",
            keys: &[key(
                "offset",
                Quantity(&LENGTH, Any),
                Required,
                "height of the stop over the axis of the undeformed beam: positive on the side of y, negative on the other",
            )],
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='hertz', stiffness=1e5}}]",
            make: |v, _| {
                let offset = v.number("offset")?;
                if offset == 0.0 {
                    let message = "a stop at the offset 0 is on neither side of the beam";
                    let help =
                        "for a stop that touches the undeformed beam take a `plane` with the mount `hub`";
                    return Err(Fault::new("offset", message).help(help).into());
                }
                let plane =
                    Plane { point: [0.0, offset, 0.0], normal: [0.0, -offset.signum(), 0.0], motion: None };
                Ok((Arc::new(plane), Mount::Hub))
            },
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

/// The stations of a contact: the given ones, equidistant ones, or the tip.
fn stations(v: &Values, c: &Context<'_>) -> Made<Vec<f64>> {
    let length = c.length()?;
    let mut given = Vec::new();
    for key in ["station", "stations", "points"] {
        if v.optional(key)?.is_some() {
            given.push(key);
        }
    }
    match given[..] {
        [] => Ok(vec![length]),
        ["station"] => Ok(vec![c.station(v, "station")?]),
        ["stations"] => {
            let stations = v.numbers("stations")?;
            if stations.is_empty() || stations.windows(2).any(|two| two[0] >= two[1]) {
                let message = "the stations of a contact ascend, and there is one at least";
                return Err(Fault::new("stations", message).into());
            }
            stations.iter().try_for_each(|station| c.on_beam(*station, "stations"))?;
            Ok(stations.to_vec())
        }
        [_] => {
            let n = v.count("points")?;
            Ok((1..=n).map(|k| length * k as f64 / n as f64).collect())
        }
        [first, second, ..] => {
            let message = format!("a contact has one kind of points: give `{first}` or `{second}`, not both");
            Err(Fault::new(second, message).into())
        }
    }
}

/// Parts of the names of columns that are not those of contacts.
const TAKEN: [&str; 6] = ["tip", "hub", "energy", "step", "time", "constraint"];

/// The name of a contact, which begins the names of its columns.
fn name(v: &Values) -> Made<Option<String>> {
    let Some(_) = v.optional("name")? else { return Ok(None) };
    let name = v.text("name")?;
    let plain = |c: char| c.is_alphanumeric() || c == '-' || c == '_';
    if !name.starts_with(char::is_alphabetic) || !name.chars().all(plain) {
        let message = format!("`{name}` cannot begin the name of a column");
        let help = "begin with a letter, and go on with letters, digits, `-` and `_`";
        return Err(Fault::new("name", message).help(help).into());
    }
    if TAKEN.contains(&name) {
        return Err(Fault::new("name", format!("columns of another kind begin with `{name}`")).into());
    }
    Ok(Some(name.to_owned()))
}

/// The tables `[[contact]]`.
pub static CONTACT: Table<Contact> = Table {
    key: key(
        "contact",
        Type::Tables(&[
            key(
                "name",
                Type::Text,
                Optional,
                "name, which begins the names of its columns: `contact`, `contact2`, … if left out",
            ),
            key("station", Type::Station(Positive), Optional, "station that may touch, the tip if left out"),
            key(
                "stations",
                Type::Quantities(&LENGTH, Positive),
                Optional,
                "stations that may touch, ascending, each a contact of its own",
            ),
            key(
                "points",
                Type::Integer(1, MOST_POINTS),
                Optional,
                "number of equidistant points, the last at the tip, by which the whole beam may touch",
            ),
            key("obstacle", Type::Kind(&OBSTACLE), Required, "rigid obstacle"),
            key("law", Type::Kind(&LAW), Default::Name("massless"), "what happens at a touch"),
        ]),
        Default::Empty,
        "contacts of the beam with obstacles",
    ),
    example: "contact=[{name='ground', points=4, obstacle={kind='plane', point=[0, '-2 mm']}, law={kind='constraint', restitution=0, friction=0.3}}]",
    make: |v, c| {
        let ((name, stations), ((obstacle, mount), (law, massless))) = both(
            both(name(v), stations(v, c)),
            both(OBSTACLE.make(v, "obstacle", c), LAW.make(v, "law", c)),
        )?;
        if massless && stations != [c.length()?] {
            let message = "only the tip can do without mass: at other stations a law with restitution or a force is needed";
            return Err(Fault::new("law", message)
                .help("write `law = { kind = \"constraint\", restitution = 0.5 }`")
                .into());
        }
        let whole = v.optional("points")?.is_some();
        Ok(Contact { name, stations, mount, obstacle, law, whole, massless })
    },
};

/// Gives every contact its name: `contact`, `contact2`, … where none is given.
///
/// # Errors
/// At a name that two contacts have.
pub fn named(mut contacts: Vec<Contact>) -> Made<Vec<Contact>> {
    for k in 0..contacts.len() {
        let number = if k == 0 { String::new() } else { (k + 1).to_string() };
        let name = contacts[k].name.take().unwrap_or_else(|| format!("contact{number}"));
        if contacts[..k].iter().any(|other| other.name.as_ref() == Some(&name)) {
            let message = format!("two contacts are called `{name}`");
            return Err(Fault::new(format!("contact[{}].name", k + 1), message).into());
        }
        contacts[k].name = Some(name);
    }
    Ok(contacts)
}

impl Contact {
    /// The law of its `k`th station: the force per length on a whole beam is summed up by the trapezium rule, L/n at each of n
    /// points and half of it at the tip.
    fn law_at(&self, k: usize) -> Law {
        match self.stations.first() {
            Some(&spacing) if self.whole => share(self.law, spacing, k + 1 == self.stations.len()),
            _ => self.law,
        }
    }
}

/// The law of one of the points, `spacing` \[m\] apart, by which a beam may touch everywhere and whose force is one per length: by the
/// trapezium rule, half of it at an end.
pub fn share(law: Law, spacing: f64, end: bool) -> Law {
    let length = if end { 0.5 * spacing } else { spacing };
    match law {
        Law::Force(force) => Law::Force(ContactForce { stiffness: length * force.stiffness, ..force }),
        law => law,
    }
}

/// Names, stations, laws and contacts of the points of all contacts, in the order of the system's.
pub fn points(contacts: &[Contact]) -> impl Iterator<Item = (String, f64, Law, &Contact)> {
    contacts.iter().flat_map(|contact| {
        let name = contact.name.as_deref().unwrap_or("contact");
        let several = contact.stations.len() > 1;
        let named = move |k: usize| if several { format!("{name}.{}", k + 1) } else { name.to_owned() };
        contact
            .stations
            .iter()
            .enumerate()
            .map(move |(k, station)| (named(k), *station, contact.law_at(k), contact))
    })
}

/// Whether the tip of a beam can do without mass where a contact wants it so; `why_not` says what gives it mass.
pub fn fits_massless(contacts: &[Contact], why_not: Option<&str>) -> Made<()> {
    match (contacts.iter().position(|contact| contact.massless), why_not) {
        (Some(i), Some(why)) => {
            let message =
                format!("a contact without a law of its own takes the mass from the tip, but {why}");
            let help = "give it a law: `law = { kind = \"constraint\", restitution = 0.5 }`";
            Err(Fault::new(format!("contact[{}].law", i + 1), message).help(help).into())
        }
        _ => Ok(()),
    }
}
