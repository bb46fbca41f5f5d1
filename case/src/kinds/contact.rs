//! Contacts: what may touch which obstacle, and what happens then.

use super::name::{NAME, name, numbered};
use super::obstacle::{Mounted, OBSTACLE};
use crate::declaration::Bound::*;
use crate::fault::{Fault, Made};
use crate::keys::{Field, Takes, integer, keys, kind, number, place, places, quantity, vector};
use crate::kind::{Choice, Context, Is, Kind, Of, Table};
use crate::places::{Parts, Place};
use crate::units::{LENGTH, VELOCITY};
use crate::values::{Value, Values, item};
use flexion::contact::{self as touch, ContactForce, Contacting, Dissipation, Law};
use flexion::hub_beam::{self, HubBeam};
use flexion::linalg::Vec3;
use flexion::system::Fork;
use std::sync::Arc;

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
    pub obstacle: Mounted,
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
    /// Whether its points are those of the axis of a beam, which needs no node at them: friction on a radius asks for the rotation of a
    /// section too.
    pub fn is_on_axis(&self) -> bool {
        let rolls = self.radius > 0.0 && self.law.has_friction();
        matches!(self.on, Touching::Points { .. }) && !rolls
    }

    /// The part that carries its obstacle.
    pub fn carrier(&self) -> Option<Place> {
        if let Mount::Part(place) = self.mount { Some(place) } else { None }
    }

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

/// What an obstacle is fixed to, in whose axes it is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mount {
    /// Axes of space.
    Ground,
    /// Radial and transverse axis of the hub, from its axis.
    Hub,
    /// A body, or a section of a beam, from its own point.
    Part(Place),
}

impl Mount {
    /// That of a beam on a hub.
    pub fn on_hub(self) -> hub_beam::Mount {
        if self == Mount::Hub { hub_beam::Mount::Hub } else { hub_beam::Mount::Ground }
    }
}

impl Takes<Place> for Mount {
    fn take(value: Option<&Value>, c: &Context<'_>) -> Made<Mount> {
        let written: String = Takes::<str>::take(value, c)?;
        match c.parts()?.find(&written) {
            Ok(Place::Ground) => Ok(Mount::Ground),
            Ok(Place::Beam(_)) => {
                let message = format!("`{written}` is a whole beam, and a section is meant");
                Err(Fault::new("", message).help(format!("write for example `{written}.tip`")).into())
            }
            Ok(place) => Ok(Mount::Part(place)),
            Err(_) if written.trim() == "hub" => Ok(Mount::Hub),
            Err(fault) => Err(fault.into()),
        }
    }
}

const RESTITUTION: Field<f64> =
    number(Between(0.0, 1.0)).called("restitution", "nominal coefficient of restitution e");
const STIFFNESS: Field<f64> =
    number(Positive).called("stiffness", "K in N/mⁿ, with `points` that of a length of 1 m");
const EXPONENT: Field<f64> = number(Between(1.0, 4.0)).or(1.5).called("exponent", "n");
const FRICTION: Field<f64> = number(NotNegative).or(0.0).called("friction", "coefficient of friction μ");
const SLIP_SPEED: Field<f64> = quantity(&VELOCITY, Positive)
    .or(0.01)
    .called("slip-speed", "sliding speed v_s of the regularised friction, −μ F tanh(v/v_s)");

keys! {
    struct Rigid {
        restitution: f64 = RESTITUTION;
        friction: f64 = FRICTION;
    }

    struct Elastic {
        stiffness: f64 = STIFFNESS;
        exponent: f64 = EXPONENT;
        friction: f64 = FRICTION;
        slip_speed: f64 = SLIP_SPEED;
    }

    struct Damped {
        stiffness: f64 = STIFFNESS;
        exponent: f64 = EXPONENT;
        restitution: f64 = RESTITUTION;
        friction: f64 = FRICTION;
        slip_speed: f64 = SLIP_SPEED;
    }
}

/// A continuous force K δⁿ (1 + χ δ̇/v₀).
fn force(k: &Elastic, restitution: f64, dissipation: Dissipation) -> (Law, bool) {
    let &Elastic { stiffness, exponent, friction, slip_speed } = k;
    let factor = dissipation.factor(restitution);
    (Law::Force(ContactForce { stiffness, exponent, factor, friction, slip_speed }), false)
}

/// The same of a law that dissipates.
fn damped(k: Damped, dissipation: Dissipation) -> Made<(Law, bool)> {
    let Damped { stiffness, exponent, restitution, friction, slip_speed } = k;
    if restitution == 0.0 && dissipation.needs_rebound() {
        let message = "with e = 0 this law has no finite damping";
        let help = "take `hunt-crossley` or `lankarani-nikravesh`, or a `constraint`";
        return Err(Fault::new("restitution", message).help(help).into());
    }
    Ok(force(&Elastic { stiffness, exponent, friction, slip_speed }, restitution, dissipation))
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
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='massless'}}]",
            make: &Is((Law::Constraint { restitution: 0.0, friction: 0.0 }, true)),
        },
        Kind {
            name: "constraint",
            summary: "impulse with Newton's restitution, then a constraint until it would pull; Coulomb friction",
            source: "Pfeiffer & Glocker 1996, doi:10.1002/9783527618385",
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='constraint', restitution=0.5}}]",
            make: &Of(|Rigid { restitution, friction }, _| {
                Ok((Law::Constraint { restitution, friction }, false))
            }),
        },
        Kind {
            name: "hertz",
            summary: "elastic force K δⁿ of the indentation δ",
            source: "Hertz 1881, doi:10.1515/crll.1882.92.156",
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='hertz', stiffness=1e5}}]",
            make: &Of(|k: Elastic, _| Ok(force(&k, 1.0, Dissipation::Hertz))),
        },
        Kind {
            name: "hunt-crossley",
            summary: "the same damped by χ = 3(1 − e)/2 in K δⁿ (1 + χ δ̇/v₀)",
            source: "Hunt & Crossley 1975, doi:10.1115/1.3423596",
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='hunt-crossley', stiffness=1e5, restitution=0.5}}]",
            make: &Of(|k: Damped, _| damped(k, Dissipation::HuntCrossley)),
        },
        Kind {
            name: "lankarani-nikravesh",
            summary: "the same with χ = 3(1 − e²)/4",
            source: "Lankarani & Nikravesh 1990, doi:10.1115/1.2912617",
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='lankarani-nikravesh', stiffness=1e5, restitution=0.5}}]",
            make: &Of(|k: Damped, _| damped(k, Dissipation::LankaraniNikravesh)),
        },
        Kind {
            name: "flores",
            summary: "the same with χ = 8(1 − e)/(5e)",
            source: "Flores et al. 2011, doi:10.1007/s11044-010-9237-4",
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='flores', stiffness=1e5, restitution=0.5}}]",
            make: &Of(|k: Damped, _| damped(k, Dissipation::Flores)),
        },
        Kind {
            name: "gonthier",
            summary: "the same with χ = (1 − e²)/e",
            source: "Gonthier et al. 2004, doi:10.1023/B:MUBO.0000029392.21648.bc",
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='gonthier', stiffness=1e5, restitution=0.5}}]",
            make: &Of(|k: Damped, _| damped(k, Dissipation::Gonthier)),
        },
        Kind {
            name: "matched",
            summary: "the same with the χ that gives back e itself to a single mass",
            source: "χ (1 + e) = ln[(1 + χ)/(1 − χ e)], the exact rebound of that force",
            example: "contact=[{obstacle={kind='stop', offset='-1 um'}, law={kind='matched', stiffness=1e5, restitution=0.5}}]",
            make: &Of(|k: Damped, _| damped(k, Dissipation::Matched)),
        },
    ],
};

/// What may touch: the places of these names, the whole beam that they are, or the tip of the only beam; the whole beam by so many points.
fn touching(names: Option<&[String]>, points: Option<usize>, c: &Context<'_>) -> Made<Touching> {
    let parts = c.parts()?;
    let tip = ["tip".to_owned()];
    let names = names.unwrap_or(&tip);
    let find = |name: &String| parts.find(name).map_err(|fault| Fault { key: "on".to_owned(), ..fault });
    let places = names.iter().map(find).collect::<Result<Vec<_>, _>>()?;
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

keys! {
    /// What a case says of a contact.
    pub(crate) struct Written {
        name: Option<String> = NAME;
        /// parts that may touch: a body, a place of a beam, a list of them, or a whole beam, where it is nearest to the obstacle or by
        /// `points`; the tip of the only beam if left out
        on: Option<Vec<String>> = places();
        /// point of a body that may touch, in space at the start; its centre of mass if left out
        at: Option<Vec3> = vector(&LENGTH);
        /// radius of the ball about the point, which slides and rolls on the obstacle, or of a beam that is round
        radius: f64 = quantity(&LENGTH, NotNegative).or(0.0);
        /// number of equidistant points, the last at the tip, by which a whole beam may touch, and one more at the root where
        /// nothing holds it
        points: Option<usize> = integer(1, MOST_POINTS);
        /// rigid obstacle
        obstacle: Mounted = kind(&OBSTACLE);
        /// part that the obstacle is fixed to, in whose axes and from whose point it is given: `ground`, `hub`, a body or a place of a beam in
        /// space; the ground if left out, the hub of a stop
        mount: Option<Mount> = place();
        /// law of the contact
        law: (Law, bool) = kind(&LAW).or_name("massless");
    }
}

/// The tables `[[contact]]`.
pub static CONTACT: Table<Contact> = Table::list(
    "contact",
    "contacts with obstacles",
    "contact=[{name='floor', on='beam', points=4, obstacle={kind='plane', point=[0, '-2 mm']}, law={kind='constraint', restitution=0, friction=0.3}}]",
    &Of(|k: Written, c| {
        let Written { at, radius, obstacle, law: (law, massless), .. } = k;
        let on = touching(k.on.as_deref(), k.points, c)?;
        let mount = k.mount.unwrap_or(if obstacle.stop { Mount::Hub } else { Mount::Ground });
        if obstacle.stop && mount != Mount::Hub {
            let help = "leave the mount out, or take a `plane`";
            return Err(Fault::new("mount", "a stop is fixed to the hub").help(help).into());
        }
        if at.is_some() && !matches!(&on, Touching::Places(places) if matches!(places[..], [Place::Body(_)]))
        {
            let help = "write `on = \"beam@2 m\"` for one place of a beam";
            return Err(Fault::new("at", "is a point of a body, and `on` names none").help(help).into());
        }
        if let (Mount::Part(carrier), Touching::Places(places)) = (mount, &on)
            && places.contains(&carrier)
        {
            return Err(Fault::new("mount", "carries the obstacle, and does not touch it").into());
        }
        Ok(Contact { name: name(k.name, &["hub"])?, on, at, radius, mount, obstacle, law, massless })
    }),
);

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

/// The contacts of a beam on a hub, with their points.
///
/// # Errors
/// At a contact that such a beam does not have.
pub fn on_beam(v: &Values, c: &Context<'_>) -> Made<Vec<OnBeam>> {
    let each = contacts(v, c)?.into_iter().enumerate();
    each.map(|(i, contact)| by_points(contact, c).map_err(|faults| faults.within(&item("contact", i))))
        .collect()
}

/// The points of a contact of a beam on a hub.
fn by_points(contact: Contact, c: &Context<'_>) -> Made<OnBeam> {
    if let Touching::Beam(_) = contact.on {
        let message = "is the whole beam, which touches a surface in the plane by points";
        return Err(Fault::new("on", message).help("give their number, `points = 20`").into());
    }
    if contact.radius != 0.0 {
        let message = "the axis of a beam on a hub touches, and has no radius";
        return Err(Fault::new("radius", message).help("move the obstacle by the radius").into());
    }
    if let Mount::Part(_) = contact.mount {
        let message =
            "names a part of a beam on a hub, whose obstacles are fixed to the `ground` or the `hub`";
        return Err(Fault::new("mount", message).help("in space, `[[beam]]`, bodies carry obstacles").into());
    }
    if !contact.obstacle.planar {
        let message = "stands or moves across the plane of motion, that of x and y";
        return Err(Fault::new("obstacle", message).help("let what it is made of lie in the plane").into());
    }
    let station = |place| if let Place::Station { s, .. } = place { s } else { f64::NAN };
    let points = contact.points(c.parts()?, true).into_iter();
    let points: Vec<(String, f64, Law)> =
        points.map(|(name, place, law)| (name, station(place), law)).collect();
    if points.windows(2).any(|two| two[0].1 >= two[1].1) {
        return Err(Fault::new("on", "the stations of a contact ascend").into());
    }
    if points[0].1 == 0.0 {
        return Err(Fault::new("on", "the root is clamped to the hub and touches nothing").into());
    }
    if contact.massless && points.iter().any(|(_, station, _)| Some(*station) != c.length) {
        let message =
            "only the tip can do without mass: at other stations a law with restitution or a force is needed";
        let help = "write `law = { kind = \"constraint\", restitution = 0.5 }`";
        return Err(Fault::new("law", message).help(help).into());
    }
    Ok(OnBeam { contact, points })
}

/// The beam with its contacts, one for each point in their order; the beam alone where there are none.
pub fn with_contacts<C: hub_beam::Coupling + Clone + 'static>(
    beam: HubBeam<C>,
    contacts: &[OnBeam],
) -> Box<dyn Fork> {
    let points = || contacts.iter().flat_map(|of| of.points.iter().map(move |point| (point, &of.contact)));
    let at: Vec<_> = points().map(|((_, station, _), contact)| (*station, contact.mount.on_hub())).collect();
    if at.is_empty() {
        return Box::new(beam);
    }
    let made =
        |(point, ((name, _, law), contact)): (usize, (&(String, f64, Law), &Contact))| touch::Contact {
            name: name.clone(),
            point,
            obstacle: Arc::clone(&contact.obstacle.obstacle),
            law: *law,
        };
    let contacts = points().enumerate().map(made).collect();
    Box::new(Contacting::new(beam.with_contact_points(&at), contacts))
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
