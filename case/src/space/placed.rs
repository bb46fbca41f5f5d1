//! The parts of a model and where they stand; what joins them, acts on them and may touch.

use crate::fault::{Fault, Faults, Made};
use crate::kinds::beam::{Beam, End};
use crate::kinds::contact::{Contact, Point};
use crate::kinds::joint::Joint;
use crate::kinds::load::{Acts, Load};
use crate::kinds::mass::Mass;
use crate::kinds::name::numbered;
use crate::kinds::spring::{Joins, Spring};
use crate::places::Place;
use flexion::contact as touch;
use flexion::hub_beam::load::Axes;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::about;
use flexion::multibody::{self, Body, Directions, Flexible, Marker, Model, Part};
use flexion::system::Frame;
use std::sync::Arc;

/// The parts of a model, and where they stand.
pub(super) struct Placed<'b> {
    pub(super) bodies: Vec<(Part, Vec3)>,
    pub(super) beams: &'b [(Beam, multibody::Beam)],
}

impl Placed<'_> {
    /// The part at a place, and its own point if it has one.
    pub(super) fn at(&self, place: Place) -> (Part, Option<Vec3>) {
        match place {
            Place::Ground | Place::Beam(_) => (Part::Ground, None),
            Place::Body(i) => (self.bodies[i].0, Some(self.bodies[i].1)),
            Place::Station { beam, s } => {
                let built = &self.beams[beam].1;
                let apart = |node: &usize| (built.nodes()[*node] - s).abs();
                let nearest = (0..built.nodes().len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
                let node = nearest.unwrap_or(0);
                (Part::Section { beam, node }, Some(built.node(node, built.initial()).position))
            }
        }
    }
}

impl Placed<'_> {
    /// The number of what is drawn of a part, beams behind bodies, and the station on it \[m\].
    fn drawn(&self, part: Part) -> (usize, f64) {
        match part {
            Part::Section { beam, node } => (self.bodies.len() + beam, self.beams[beam].1.nodes()[node]),
            Part::Body(body) => (body, 0.0),
            Part::Ground => (0, 0.0),
        }
    }

    /// The same of what carries the obstacle of a contact.
    pub(super) fn carrier(&self, contact: &Contact) -> Option<(usize, f64)> {
        contact.carrier().map(|place| self.drawn(self.at(place).0))
    }
}

/// The marker of a part with the axes of space at a point.
fn marker(model: &Model, part: Part, position: Vec3) -> Made<Marker> {
    let space = Frame { position, rotation: Mat3::IDENTITY };
    model.marker(part, space).ok_or_else(|| Fault::new("", "is on a part that is not there").into())
}

/// The point given, or that of the part.
fn point(given: Option<Vec3>, own: Option<Vec3>, key: &str) -> Made<Vec3> {
    let message = "the ground has no point of its own: give one";
    given.or(own).ok_or_else(|| Faults::from(Fault::new(key, message)))
}

pub(super) fn add_joint(model: &mut Model, parts: &Placed<'_>, joint: &Joint, number: usize) -> Made<()> {
    let [(from, first), (to, second)] = joint.between.map(|place| parts.at(place));
    let point = joint.at.or(second).or(first).ok_or_else(Faults::default)?;
    let space = Frame { position: point, rotation: joint.axes };
    let [a, mut b] = [from, to].map(|part| model.marker(part, space));
    if let Some(b) = &mut b {
        // The joint begins with its coordinate of the start.
        if matches!(joint.kind, multibody::Kind::Prismatic) {
            let along = joint.start * b.frame.rotation.column(2);
            b.frame.position += along;
        } else {
            b.frame.rotation = b.frame.rotation * about([0.0, 0.0, joint.start]);
        }
    }
    let (Some(a), Some(b)) = (a, b) else { return Err(Faults::default()) };
    let name = numbered(&joint.name, "joint", number);
    model.joint(multibody::Joint::new(&name, joint.kind, a, b).driven(joint.drive.clone()));
    Ok(())
}

pub(super) fn add_spring(model: &mut Model, parts: &Placed<'_>, spring: &Spring, number: usize) -> Made<()> {
    let ((from, a), (to, b), length, directions) = match &spring.joins {
        Joins::Line { between, ends, length } => {
            let [(from, first), (to, second)] = between.map(|place| parts.at(place));
            let (a, b) = (point(ends[0], first, "from")?, point(ends[1], second, "to")?);
            let apart = (b - a).norm();
            if apart == 0.0 {
                return Err(Fault::new("", "has both ends at one point, and its force no direction").into());
            }
            ((from, a), (to, b), length.unwrap_or(apart), Directions::Line)
        }
        Joins::Point { on: (beam, s), to } => {
            let (part, own) = parts.at(Place::Station { beam: *beam, s: *s });
            ((Part::Ground, *to), (part, own.unwrap_or_default()), 0.0, Directions::All)
        }
    };
    model.spring(multibody::Spring {
        name: numbered(&spring.name, "spring", number),
        from: marker(model, from, a)?,
        to: marker(model, to, b)?,
        stiffness: spring.stiffness,
        damping: spring.damping,
        length,
        directions,
    });
    Ok(())
}

pub(super) fn add_load(model: &mut Model, parts: &Placed<'_>, load: &Load, number: usize) -> Made<()> {
    let axes = match load.axes {
        Axes::Dead => multibody::Axes::Dead,
        Axes::Follower => multibody::Axes::Follower,
        Axes::Hub => {
            let fault = Fault::new("axes", "a system in space has loads with the axes `dead` or `follower`");
            return Err(fault.into());
        }
    };
    let (name, amplitude) = (numbered(&load.name, "load", number), load.amplitude.clone());
    let elements = |beam: usize, range: (f64, f64)| {
        let (of, built) = &parts.beams[beam];
        let end = |station: f64| {
            let near = |i: &usize| (built.end(*i) - station).abs() <= 1e-9 * of.length;
            (0..=built.elements()).find(near).ok_or_else(Faults::default)
        };
        Ok::<_, Faults>(Some(end(range.0)?..end(range.1)?))
    };
    match &load.acts {
        Acts::At { on, at, force, couple } => {
            let (part, own) = parts.at(*on);
            let mut at = marker(model, part, point(*at, own, "at")?)?;
            if axes == multibody::Axes::Follower {
                // The components are those in the axes of the part.
                at.frame.rotation = Mat3::IDENTITY;
            }
            model.load(multibody::Load { name, at, force: *force, moment: *couple, axes, amplitude });
        }
        Acts::Along { beam, range, force, distribution } => {
            model.line_load(multibody::LineLoad {
                name,
                beam: *beam,
                elements: elements(*beam, *range)?,
                distribution: distribution.clone(),
                force: *force,
                axes,
                amplitude,
            });
        }
        Acts::By { beam, range, law } => {
            let (beam, law, elements) = (*beam, Arc::clone(law), elements(*beam, *range)?);
            model.line_law(multibody::LineLaw { name, beam, elements, law });
        }
    }
    Ok(())
}

/// Radius, over the length of its beam, of the ball that a mass without inertia of its own is: its inertia is below rounding.
const POINT: f64 = 1e-7;

/// Adds a mass as a body that is fixed to its station.
pub(super) fn add_mass(model: &mut Model, parts: &Placed<'_>, mass: &Mass, number: usize) -> Made<()> {
    let (part, own) = parts.at(Place::Station { beam: mass.beam, s: mass.station });
    let at = own.unwrap_or_default();
    let name = numbered(&mass.name, "mass", number);
    let radius = POINT * parts.beams[mass.beam].0.length;
    let inertia = mass.inertia.max(0.4 * mass.mass * radius * radius);
    let mut body = Body::new(&name, mass.mass, [inertia; 3]).at(at);
    // As the beam that carries it.
    [body.damping, _] = parts.beams[mass.beam].0.damping;
    let body = model.body(body);
    let ends = [part, body];
    model
        .join(&format!("{name}-joint"), multibody::Kind::Fixed, ends, at, (Vec3([0.0, 0.0, 1.0]), None))
        .map_err(|error| Fault::new("", error.to_string()))?;
    Ok(())
}

/// Adds a point that may touch; gives it with the number of its body, beams behind bodies, and its station \[m\].
pub(super) fn add_point(
    model: &mut Model,
    parts: &Placed<'_>,
    contact: &Contact,
    (name, place, law): &Point,
) -> Made<(touch::Contact, (usize, f64))> {
    let obstacle = Arc::clone(&contact.obstacle.obstacle);
    let made = |model: &mut Model, point: usize| {
        if let Some(carrier) = contact.carrier() {
            model.mount(point, Marker::new(parts.at(carrier).0, Vec3::ZERO));
        }
        touch::Contact { name: name.clone(), point, obstacle, law: *law }
    };
    if let Place::Beam(beam) = *place {
        let middle = 0.5 * parts.beams[beam].0.length;
        let point = model.contact_beam(beam, contact.radius);
        return Ok((made(model, point), (parts.bodies.len() + beam, middle)));
    }
    if let (Place::Station { beam, s }, true) = (*place, contact.is_on_axis()) {
        let point = model.contact_station(beam, s, contact.radius);
        return Ok((made(model, point), (parts.bodies.len() + beam, s)));
    }
    let (part, own) = parts.at(*place);
    let marker = marker(model, part, point(contact.at, own, "at")?)?;
    let point = model.contact_ball(marker, contact.radius);
    Ok((made(model, point), parts.drawn(part)))
}

/// Adds a beam and the joints of its ends.
pub(super) fn add_beam(model: &mut Model, (beam, built): &(Beam, multibody::Beam), in_root_axes: bool) {
    let [velocity, spin] = beam.motion;
    let [damping, viscosity] = beam.damping;
    let flexible = Flexible::new(&beam.name, built.clone()).damped(damping).viscous(viscosity);
    let turned = beam.section.deck.is_some();
    let mut flexible =
        Flexible { velocity, spin, in_root_axes, turned, ..flexible.recorded_at(&beam.stations) };
    for (name, station, place) in &beam.fibres {
        flexible = flexible.with_fibre(name, *station, *place);
    }
    model.beam(flexible);
}

/// Adds the joints of a beam's ends.
pub(super) fn add_ends(
    model: &mut Model,
    number: usize,
    (beam, built): &(Beam, multibody::Beam),
) -> Made<()> {
    for (end, name, node) in [(beam.ends[0], "root", 0), (beam.ends[1], "tip", built.nodes().len() - 1)] {
        let kind = match end {
            End::Free => continue,
            End::Clamped => multibody::Kind::Fixed,
            End::Hinged => multibody::Kind::Spherical,
        };
        let point = built.node(node, built.initial()).position;
        let parts = [Part::Ground, Part::Section { beam: number, node }];
        let name = format!("{}-{name}", beam.name);
        model
            .join(&name, kind, parts, point, (Vec3([0.0, 0.0, 1.0]), None))
            .map_err(|error| Fault::new("", error.to_string()))?;
    }
    Ok(())
}
