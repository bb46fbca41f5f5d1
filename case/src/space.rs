//! A system in space: the model that is made of its parts.

use super::blame::{Tables, blamed, leaves_the_plane};
use super::fault::{Fault, Faults, Found, Made};
use super::kind::Context;
use super::kinds::beam::{BEAMS, Beam, End, FIBRES, Fibre};
use super::kinds::body::BODY;
use super::kinds::contact::{Contact, Point, Touching, contacts};
use super::kinds::integrator::Method;
use super::kinds::joint::{JOINTS, Joint};
use super::kinds::load::{Acts, LOAD, Load};
use super::kinds::mass::{MASS, Mass};
use super::kinds::name::numbered;
use super::kinds::rotation::{ROTATION, Rotation};
use super::kinds::spring::{Joins, SPRING, Spring};
use super::layout::{GRAVITY, INITIAL, MODEL, OUTPUT_IN_SPACE};
use super::places::{Parts, Place};
use super::stations::stations;
use super::values::{Values, item};
use flexion::contact::{self as touch, Contacting, Surface};
use flexion::hub_beam::Mount;
use flexion::hub_beam::load::Axes;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::about;
use flexion::multibody::slender;
use flexion::multibody::{self, Body, Directions, Flexible, Marker, Model, Multibody, Part};
use flexion::system::{Fork, Frame};
use std::sync::Arc;

/// Bodies, joints and beams in space.
#[derive(Clone, Debug)]
pub struct Space {
    /// The system, without its contacts.
    pub multibody: Multibody,
    /// What its points may touch.
    pub contacts: Vec<touch::Contact>,
    /// How many of them each table describes.
    pub points: Vec<usize>,
    /// The body of each, beams behind bodies, and its station \[m\].
    pub touching: Vec<(usize, f64)>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The beams, and as they are built.
    pub beams: Vec<(Beam, slender::Beam)>,
    /// The joints.
    pub joints: Vec<Link>,
    /// How it rotates steadily, or why it does not.
    pub rotation: Result<Rotation, String>,
    /// Into how many each element of the beams is cut.
    pub refine: usize,
    /// Largest distance between its parts \[m\].
    pub size: f64,
}

/// A joint as it is shown.
#[derive(Clone, Debug)]
pub struct Link {
    /// Name.
    pub name: String,
    /// What it is called in the case.
    pub kind: String,
    /// The two parts as written.
    pub between: [String; 2],
    /// Its point at the start \[m\].
    pub point: Vec3,
}

impl Space {
    /// The mechanical system.
    pub fn system(&self) -> Box<dyn Fork> {
        if self.contacts.is_empty() {
            return Box::new(self.multibody.clone());
        }
        Box::new(Contacting::new(self.multibody.clone(), self.contacts.clone()))
    }
}

/// The parts of a model, and where they stand.
struct Placed<'b> {
    bodies: Vec<(Part, Vec3)>,
    beams: &'b [(Beam, slender::Beam)],
}

impl Placed<'_> {
    /// The part at a place, and its own point if it has one.
    fn at(&self, place: Place) -> (Part, Option<Vec3>) {
        match place {
            Place::Ground | Place::Beam(_) => (Part::Ground, None),
            Place::Body(i) => (self.bodies[i].0, Some(self.bodies[i].1)),
            Place::Station { beam, s } => {
                let built = &self.beams[beam].1;
                let apart = |node: &usize| (built.nodes()[*node] - s).abs();
                let nearest = (0..built.nodes().len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
                let node = nearest.unwrap_or(0);
                (Part::Section { beam, node }, Some(built.node(node, built.initial()).0))
            }
        }
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

fn add_joint(model: &mut Model, parts: &Placed<'_>, joint: &Joint, number: usize) -> Made<()> {
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

fn add_spring(model: &mut Model, parts: &Placed<'_>, spring: &Spring, number: usize) -> Made<()> {
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

fn add_load(model: &mut Model, parts: &Placed<'_>, load: &Load, number: usize) -> Made<()> {
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
        let node = |station: f64| {
            let near = |node: &f64| (node - station).abs() <= 1e-9 * of.length;
            built.nodes().iter().position(near).ok_or_else(Faults::default)
        };
        Ok::<_, Faults>(Some(node(range.0)?..node(range.1)?))
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
fn add_mass(model: &mut Model, parts: &Placed<'_>, mass: &Mass, number: usize) -> Made<()> {
    let (part, own) = parts.at(Place::Station { beam: mass.beam, s: mass.station });
    let at = own.unwrap_or_default();
    let name = numbered(&mass.name, "mass", number);
    let radius = POINT * parts.beams[mass.beam].0.length;
    let inertia = mass.inertia.max(0.4 * mass.mass * radius * radius);
    let body = Body::new(&name, mass.mass, [inertia; 3]).at(at);
    let body = model.body(body);
    let ends = [part, body];
    model
        .join(&format!("{name}-joint"), multibody::Kind::Fixed, ends, at, (Vec3([0.0, 0.0, 1.0]), None))
        .map_err(|error| Fault::new("", error.to_string()))?;
    Ok(())
}

/// Adds a point that may touch; gives it with the number of its body, beams behind bodies, and its station \[m\].
fn add_point(
    model: &mut Model,
    parts: &Placed<'_>,
    contact: &Contact,
    (name, place, law): &Point,
) -> Made<(touch::Contact, (usize, f64))> {
    let obstacle = Arc::clone(&contact.obstacle.obstacle);
    let made = |point: usize| touch::Contact { name: name.clone(), point, obstacle, law: *law };
    if let Place::Beam(beam) = *place {
        let middle = 0.5 * parts.beams[beam].0.length;
        return Ok((made(model.contact_beam(beam, contact.radius)), (parts.bodies.len() + beam, middle)));
    }
    let (part, own) = parts.at(*place);
    let marker = marker(model, part, point(contact.at, own, "at")?)?;
    let place = match part {
        Part::Section { beam, node } => (parts.bodies.len() + beam, parts.beams[beam].1.nodes()[node]),
        Part::Body(body) => (body, 0.0),
        Part::Ground => (0, 0.0),
    };
    Ok((made(model.contact_ball(marker, contact.radius)), place))
}

/// The points of a contact. Forces along a beam are summed up by the trapezium rule.
fn points_of(contact: &Contact, parts: &Parts, beams: &[Beam], joints: &[Joint]) -> Made<Vec<Point>> {
    if contact.massless {
        let message = "only the tip of a planar beam can do without mass";
        let help = "write `law = { kind = \"constraint\", restitution = 0.5 }`";
        return Err(Fault::new("law", message).help(help).into());
    }
    if contact.mount == Mount::Hub {
        let message = "a system in space has obstacles that are fixed to the ground, or moved";
        return Err(Fault::new(if contact.obstacle.stop { "obstacle" } else { "mount" }, message).into());
    }
    if let Some(key) = contact.obstacle.assumed {
        let message = "is left out, and a system in space has no plane of motion to take it from";
        let help = match key {
            "axis" => "write for example `axis = [0, 0, 1]`",
            _ => "write for example `normal = [0, 0, 1]`, up, for a floor",
        };
        return Err(Fault::new(format!("obstacle.{key}"), message).help(help).into());
    }
    let bulges = |surface: Surface| surface.curvatures.iter().any(|k| *k > 0.0);
    let held = match contact.on {
        Touching::Beam(_) if !bulges(contact.obstacle.obstacle.surface(Vec3::ZERO, 0.0)) => {
            let message = "is flat or hollow: a beam touches it at many places, and none is the nearest";
            let help = "let the beam touch by points, `points = 20`, or name one place: `on = \"beam.tip\"`";
            return Err(Fault::new("obstacle", message).help(help).into());
        }
        Touching::Points { beam, .. } => {
            let root = Place::Station { beam, s: 0.0 };
            beams[beam].ends[0] != End::Free || joints.iter().any(|joint| joint.between.contains(&root))
        }
        _ => false,
    };
    Ok(contact.points(parts, held))
}

/// What places the parts of a case name.
#[derive(Default)]
struct Named(Vec<Place>);

impl Named {
    /// Of joints, springs, loads, masses and points that may touch.
    fn of(
        joints: &[Joint],
        springs: &[Spring],
        loads: &[Load],
        masses: &[Mass],
        points: &[Vec<Point>],
    ) -> Named {
        let mut all: Vec<Place> = points.iter().flatten().map(|(_, place, _)| *place).collect();
        all.extend(joints.iter().flat_map(|joint| joint.between));
        for spring in springs {
            match spring.joins {
                Joins::Line { between, .. } => all.extend(between),
                Joins::Point { on: (beam, s), .. } => all.push(Place::Station { beam, s }),
            }
        }
        all.extend(masses.iter().map(|mass| Place::Station { beam: mass.beam, s: mass.station }));
        for load in loads {
            match load.acts {
                Acts::At { on, .. } => all.push(on),
                Acts::Along { beam, range, .. } | Acts::By { beam, range, .. } => {
                    all.extend([range.0, range.1].map(|s| Place::Station { beam, s }));
                }
            }
        }
        Named(all)
    }

    /// The stations on a beam \[m\].
    fn on(&self, number: usize) -> Vec<f64> {
        let station = |place: &Place| match *place {
            Place::Station { beam, s } if beam == number => Some(s),
            _ => None,
        };
        self.0.iter().filter_map(station).collect()
    }
}

/// Adds a beam and the joints of its ends.
fn add_beam(model: &mut Model, (beam, built): &(Beam, slender::Beam), in_root_axes: bool) {
    let [velocity, spin] = beam.motion;
    let [damping, viscosity] = beam.damping;
    let flexible = Flexible::new(&beam.name, built.clone()).damped(damping).viscous(viscosity);
    let mut flexible = Flexible { velocity, spin, in_root_axes, ..flexible.recorded_at(&beam.stations) };
    for (name, station, place) in &beam.fibres {
        flexible = flexible.with_fibre(name, *station, *place);
    }
    model.beam(flexible);
}

/// Adds the joints of a beam's ends.
fn add_ends(model: &mut Model, number: usize, (beam, built): &(Beam, slender::Beam)) -> Made<()> {
    for (end, name, node) in [(beam.ends[0], "root", 0), (beam.ends[1], "tip", built.nodes().len() - 1)] {
        let kind = match end {
            End::Free => continue,
            End::Clamped => multibody::Kind::Fixed,
            End::Hinged => multibody::Kind::Spherical,
        };
        let point = built.node(node, built.initial()).0;
        let parts = [Part::Ground, Part::Section { beam: number, node }];
        let name = format!("{}-{name}", beam.name);
        model
            .join(&name, kind, parts, point, (Vec3([0.0, 0.0, 1.0]), None))
            .map_err(|error| Fault::new("", error.to_string()))?;
    }
    Ok(())
}

/// The tables of what a model has, in its order.
fn tables(
    bodies: &[Body],
    beams: &[(Beam, slender::Beam)],
    joints: &[Joint],
    masses: &[Mass],
    loads: &[Load],
) -> Tables {
    let all = |table: &'static str, count: usize| (0..count).map(move |i| item(table, i));
    let held = |(i, (beam, _)): (usize, &(Beam, slender::Beam))| {
        let ends = beam.ends.iter().filter(|end| **end != End::Free).count();
        std::iter::repeat_n(item("beam", i), ends)
    };
    // The order of loads in a model.
    let order = |load: &Load| match load.acts {
        Acts::At { .. } => 0,
        Acts::Along { .. } => 1,
        Acts::By { .. } => 2,
    };
    let mut by_order: Vec<usize> = (0..loads.len()).collect();
    by_order.sort_by_key(|i| order(&loads[*i]));
    Tables {
        bodies: all("body", bodies.len()).chain(all("mass", masses.len())).collect(),
        joints: beams
            .iter()
            .enumerate()
            .flat_map(held)
            .chain(all("joint", joints.len()))
            .chain(all("mass", masses.len()))
            .collect(),
        loads: by_order.into_iter().map(|i| item("load", i)).collect(),
    }
}

/// The names of the bodies and beams, each of which is one.
fn parts(bodies: &[Body], beams: &[Beam], found: &mut Found) -> Parts {
    let of_bodies = bodies.iter().enumerate().map(|(i, body)| (item("body", i), &body.name));
    let of_beams = beams.iter().enumerate().map(|(i, beam)| (item("beam", i), &beam.name));
    let mut taken: Vec<&String> = Vec::new();
    for (table, name) in of_bodies.chain(of_beams) {
        let twice = taken.contains(&name);
        found.check(twice, &format!("{table}.name"), || format!("the name `{name}` is already taken"));
        taken.push(name);
    }
    Parts {
        bodies: bodies.iter().map(|body| body.name.clone()).collect(),
        beams: beams.iter().map(|beam| (beam.name.clone(), beam.length)).collect(),
    }
}

/// Lets beams record stations, the tips behind them, and fibres.
fn record(beams: &mut [Beam], stations: &[(usize, f64)], fibres: Vec<Fibre>) {
    for (i, beam) in beams.iter_mut().enumerate() {
        let on = stations.iter().filter(|(beam, _)| *beam == i).map(|(_, s)| *s);
        let all: Vec<f64> = on.chain([beam.length]).collect();
        let first = |(k, s): (usize, &f64)| (!all[..k].contains(s)).then_some(*s);
        beam.stations = all.iter().enumerate().filter_map(first).collect();
    }
    for Fibre { name, on: (beam, s), place } in fibres {
        beams[beam].fibres.push((name, s, place));
    }
}

/// Makes the system of the values of its case, for a method of integration.
pub(super) fn make(v: &Values, c: &Context<'_>, method: Option<&Method>) -> Made<Space> {
    let mut found = Found::default();
    let (bodies, beams) = (found.part(BODY.make(v, c)), found.part(BEAMS.make(v, c)));
    let mut beams = beams;
    let names = bodies.as_ref().zip(beams.as_ref()).map(|(bodies, beams)| parts(bodies, beams, &mut found));
    let c = &Context { parts: names.as_ref(), ..*c };
    let joints = found.part(JOINTS.make(v, c));
    let springs = found.part(SPRING.make(v, c));
    let masses = found.part(MASS.make(v, c));
    let loads = found.part(LOAD.make(v, c));
    let contacts = found.part(contacts(v, c));
    let output = OUTPUT_IN_SPACE.read(v, c);
    let stations =
        output.and_then(|output| stations(&output.stations, c).map_err(|faults| faults.within("output")));
    if let (Some(stations), Some(fibres), Some(beams)) =
        (found.part(stations), found.part(FIBRES.make(v, c)), &mut beams)
    {
        record(beams, &stations, fibres);
    }
    let rotation = found.part(ROTATION.make(v, c));
    let gravity = found.part(GRAVITY.read(v, c));
    let settings = found.part(settings(v, c));
    initial(v, &mut found);
    let (Some(bodies), Some(beams), Some(names), Some(joints)) = (bodies, beams, &names, joints) else {
        return Err(found.0);
    };
    let (Some(springs), Some(masses), Some(loads), Some(gravity)) = (springs, masses, loads, gravity) else {
        return Err(found.0);
    };
    let (Some(contacts), Some((drop, refine, in_root_axes)), Some(rotation)) = (contacts, settings, rotation)
    else {
        return Err(found.0);
    };
    let acting = (gravity, &loads[..], &springs[..], &contacts[..]);
    if beams.iter().any(|beam| beam.planar) {
        found.part(leaves_the_plane(acting));
    }
    let along = |(i, contact): (usize, &Contact)| {
        let points = points_of(contact, names, &beams, &joints);
        found.part(points.map_err(|faults| faults.within(&item("contact", i))))
    };
    let points: Option<Vec<Vec<Point>>> = contacts.iter().enumerate().map(along).collect();
    let Some(points) = points else { return Err(found.0) };
    let named = Named::of(&joints, &springs, &loads, &masses, &points);
    let build = |(i, beam): (usize, Beam)| {
        let built = beam.built(&named.on(i), refine).map_err(|faults| faults.within(&item("beam", i)));
        found.part(built).map(|built| (beam, built))
    };
    let beams: Vec<Option<(Beam, slender::Beam)>> = beams.into_iter().enumerate().map(build).collect();
    let Some(beams) = beams.into_iter().collect::<Option<Vec<_>>>() else { return Err(found.0) };
    let mut model = Model::new().with_gravity(gravity);
    if drop {
        model = model.drop_redundant_rows();
    }
    let place = |body: &Body| (model.body(body.clone()), body.frame.position);
    let parts = Placed { bodies: bodies.iter().map(place).collect(), beams: &beams };
    for beam in &beams {
        add_beam(&mut model, beam, in_root_axes);
    }
    let mut add = |table: &str, number: usize, added: Made<()>| {
        found.part(added.map_err(|faults| faults.within(&item(table, number))));
    };
    for (i, beam) in beams.iter().enumerate() {
        add("beam", i, add_ends(&mut model, i, beam));
    }
    for (i, joint) in joints.iter().enumerate() {
        add("joint", i, add_joint(&mut model, &parts, joint, i));
    }
    for (i, spring) in springs.iter().enumerate() {
        add("spring", i, add_spring(&mut model, &parts, spring, i));
    }
    for (i, mass) in masses.iter().enumerate() {
        add("mass", i, add_mass(&mut model, &parts, mass, i));
    }
    for (i, load) in loads.iter().enumerate() {
        add("load", i, add_load(&mut model, &parts, load, i));
    }
    let (mut touching, mut places): (Vec<touch::Contact>, Vec<_>) = Default::default();
    for (i, (contact, list)) in contacts.iter().zip(&points).enumerate() {
        for point in list {
            let made = add_point(&mut model, &parts, contact, point).map(|(made, place)| {
                touching.push(made);
                places.push(place);
            });
            add("contact", i, made);
        }
    }
    let points: Vec<usize> = points.iter().map(Vec::len).collect();
    if !found.0.0.is_empty() {
        return Err(found.0);
    }
    let held = beams.iter().any(|(beam, _)| beam.ends != [End::Free; 2]);
    if let (Some(method), false) = (method, joints.is_empty() && !held)
        && !method.integrator.info().implicit
    {
        let message = "an explicit method has no way to hold the joints";
        let help = "take `radau`, which controls its steps, or `generalized-alpha` with a step";
        return Err(Fault::new("integrator.kind", message).help(help).into());
    }
    let disc = |contact: &touch::Contact| {
        matches!(contact.law, touch::Law::Constraint { .. }) && contact.law.has_friction()
    };
    if let (Some(method), Some(i)) = (method, touching.iter().position(disc))
        && !method.integrator.resolves_contacts()
    {
        let message = "friction of a rigid contact in space has a direction of its own at every time, which events do not find";
        let help = "take `nonsmooth-generalized-alpha` or `moreau-jean`, which resolve contacts in every step, or a law of force";
        let mut tables = points.iter().enumerate().flat_map(|(table, n)| std::iter::repeat_n(table, *n));
        let table = item("contact", tables.nth(i).unwrap_or(0));
        return Err(Fault::new(format!("{table}.law.friction"), message).help(help).into());
    }
    let named = |(i, joint): (usize, &Joint)| numbered(&joint.name, "joint", i);
    let names_of_joints: Vec<String> = joints.iter().enumerate().map(named).collect();
    let tables = tables(&bodies, &beams, &joints, &masses, &loads);
    let multibody = Multibody::new(model).map_err(|error| blamed(&error, &tables))?;
    let rotation =
        match rotation.first() {
            Some(about) => Ok(Rotation::given(about, multibody.model())
                .map_err(|faults| faults.within(ROTATION.key.name))?),
            None => Rotation::found(multibody.model()),
        };
    let of_ends = beams.iter().flat_map(|(beam, _)| beam.held());
    let own = |place: Place| parts.at(place).1;
    let link = |(name, joint): (String, &Joint)| {
        let [a, b] = joint.between;
        let point = joint.at.or_else(|| own(b)).or_else(|| own(a)).unwrap_or_default();
        let [kind, from, to] = joint.written.clone();
        Link { name, kind, between: [from, to], point }
    };
    let held = |(name, kind, between): (String, String, [String; 2])| {
        let place = c.parts.and_then(|names| names.find(&between[1]).ok());
        let point = place.and_then(own).unwrap_or_default();
        Link { name, kind, between, point }
    };
    let joints = names_of_joints.into_iter().zip(&joints).map(link).chain(of_ends.map(held)).collect();
    let mut extent = 0.0_f64;
    for (_, point) in &parts.bodies {
        extent = point.into_iter().fold(extent, |extent, x| extent.max(x.abs()));
    }
    extent = beams.iter().fold(extent, |extent, (beam, _)| extent.max(beam.length));
    let size = if extent > 0.0 { extent } else { 1.0 };
    Ok(Space {
        multibody,
        contacts: touching,
        points,
        touching: places,
        bodies,
        beams,
        joints,
        rotation,
        refine,
        size,
    })
}

/// Whether redundant rows are left out, into how many each element is cut, and whether stations are recorded in the axes of their root.
fn settings(v: &Values, c: &Context<'_>) -> Made<(bool, usize, bool)> {
    let model = MODEL.read(v, c)?;
    let coupling = model.coupling.name;
    if coupling != "space" {
        let message = format!(
            "`{coupling}` is a model of one beam on a hub in the plane, and this case has bodies, joints or beams by name"
        );
        let help = "leave it out, or describe the beam by [beam], [section] and [hub]";
        return Err(Fault::new("model.coupling", message).help(help).into());
    }
    Ok((model.drop_redundant_rows, model.refine, OUTPUT_IN_SPACE.read(v, c)?.root_axes))
}

/// The initial states that a system in space can have.
fn initial(v: &Values, found: &mut Found) {
    if INITIAL.chosen_in(v) == Some("modes") {
        let message = "is of a beam on a hub in the plane: a system in space begins as its parts are written, in `static` equilibrium or \
                       in `steady-rotation`";
        let help = "take a planar model, `model.coupling = \"exact\"`";
        found.0.0.push(Fault::new("initial.kind", message).help(help));
    }
}
