//! A system in space: its parts by name, and the model that is made of them.

use super::fault::{Fault, Faults, Found, Made};
use super::kind::Context;
use super::kinds::beam::{BEAMS, Beam, End};
use super::kinds::body::BODY;
use super::kinds::contact::share;
use super::kinds::integrator::Method;
use super::kinds::joint::{JOINTS, Joint};
use super::kinds::obstacle::{CONTACT, Contact};
use super::kinds::rotation::{ROTATION, Rotation};
use super::kinds::spatial::{GRAVITY, LINE_LOAD, LOAD, LineLoad, Load, MODEL, SPRING, Spring, vector};
use super::units;
use super::values::{Value, Values, item};
use flexion::contact::{self as touch, Contacting, Surface};
use flexion::multibody::rotation::{IDENTITY, Vector, exponential, matrix, plus, product};
use flexion::multibody::slender;
use flexion::multibody::{self, Body, Flexible, Marker, Model, ModelError, Multibody, Part};
use flexion::system::{Fork, Frame};
use flexion_results::nearest;
use std::collections::BTreeSet;
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
    pub point: Vector,
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

/// The parts that a case names, and where they stand.
struct Parts<'b> {
    bodies: Vec<(String, Part, Vector)>,
    beams: &'b [(Beam, slender::Beam)],
}

/// The beam and the station in the name of a place: `blade.root`, `blade.tip`, `blade@2 m`.
fn place(name: &str, length: impl Fn(&str) -> Option<f64>) -> Result<Option<(&str, f64)>, Fault> {
    if let Some((beam, station)) = name.split_once('@') {
        let Some(length) = length(beam) else { return Ok(None) };
        let station = units::parse(station, &units::LENGTH)
            .map_err(|error| Fault::new("", format!("`{name}`: {}", error.message)).help(error.help))?;
        if !(0.0..=length).contains(&station) {
            let message = format!("`{name}` is not on the beam, which ends at {length} m");
            return Err(Fault::new("", message));
        }
        return Ok(Some((beam, station)));
    }
    let Some((beam, end)) = name.split_once('.') else { return Ok(None) };
    Ok(match (length(beam), end) {
        (Some(_), "root") => Some((beam, 0.0)),
        (Some(length), "tip") => Some((beam, length)),
        _ => None,
    })
}

impl Parts<'_> {
    /// The part of this name, and its own point if it has one.
    fn find(&self, name: &str) -> Result<(Part, Option<Vector>), Fault> {
        if name == "ground" {
            return Ok((Part::Ground, None));
        }
        if let Some((_, part, point)) = self.bodies.iter().find(|(known, ..)| known == name) {
            return Ok((*part, Some(*point)));
        }
        let length =
            |name: &str| self.beams.iter().find(|(beam, _)| beam.name == name).map(|(beam, _)| beam.length);
        if let Some((of, station)) = place(name, length)?
            && let Some(number) = self.beams.iter().position(|(beam, _)| beam.name == of)
        {
            let built = &self.beams[number].1;
            let apart = |node: &f64| (node - station).abs();
            let nearest =
                |a: &usize, b: &usize| apart(&built.nodes()[*a]).total_cmp(&apart(&built.nodes()[*b]));
            let node = (0..built.nodes().len()).min_by(nearest).unwrap_or(0);
            let point = built.node(node, built.initial()).0;
            return Ok((Part::Section { beam: number, node }, Some(point)));
        }
        let places =
            |(beam, _): &(Beam, slender::Beam)| ["root", "tip"].map(|end| format!("{}.{end}", beam.name));
        let bodies = self.bodies.iter().map(|(name, ..)| name.clone());
        let all: Vec<String> = std::iter::once("ground".to_owned())
            .chain(bodies)
            .chain(self.beams.iter().flat_map(places))
            .collect();
        let near = nearest(name, all.iter().map(String::as_str));
        let near = near.map_or(String::new(), |near| format!(": did you mean `{near}`?"));
        let mut listed = super::declaration::listed(all.iter().map(String::as_str));
        if let Some((beam, _)) = self.beams.first() {
            listed += &format!(", and stations such as `{}@{} m`", beam.name, 0.5 * beam.length);
        }
        Err(Fault::new("", format!("there is no part `{name}`{near}"))
            .help(format!("the parts are {listed}")))
    }

    /// The part of this name and the point given, or its own.
    fn point(&self, name: &str, given: Option<Vector>, key: &str) -> Made<(Part, Vector)> {
        let (part, own) = self.find(name).map_err(|fault| Faults::from(fault).within(key))?;
        let point =
            given.or(own).ok_or_else(|| Fault::new("at", "the ground has no point of its own: give one"));
        Ok((part, point?))
    }

    /// Both parts of a table with `between`.
    fn pair(&self, names: &[String; 2]) -> Made<[(Part, Option<Vector>); 2]> {
        let find = |name: &String| self.find(name).map_err(|fault| Faults::from(fault).within("between"));
        let [a, b] = [find(&names[0])?, find(&names[1])?];
        if a.0 == b.0 {
            return Err(Fault::new("between", "both parts are the same").into());
        }
        Ok([a, b])
    }
}

/// The marker of a part with the axes of space at a point.
fn marker(model: &Model, part: Part, position: Vector) -> Made<Marker> {
    let space = Frame { position, rotation: IDENTITY };
    model.marker(part, space).ok_or_else(|| Fault::new("", "is on a part that is not there").into())
}

/// `name`, or that of its number: `joint`, `joint2`, ….
fn numbered(name: &str, what: &str, number: usize) -> String {
    match (name.is_empty(), number) {
        (false, _) => name.to_owned(),
        (_, 0) => what.to_owned(),
        (_, i) => format!("{what}{}", i + 1),
    }
}

fn add_joint(model: &mut Model, parts: &Parts<'_>, joint: &Joint, number: usize) -> Made<()> {
    let [(from, first), (to, second)] = parts.pair(&joint.between)?;
    let point = joint.at.or(second).or(first).ok_or_else(Faults::default)?;
    let space = Frame { position: point, rotation: joint.axes };
    let [a, mut b] = [from, to].map(|part| model.marker(part, space));
    if let Some(b) = &mut b {
        // The joint begins with its coordinate of the start.
        if matches!(joint.kind, multibody::Kind::Prismatic) {
            let along = b.frame.rotation.map(|row| joint.start * row[2]);
            b.frame.position = plus(b.frame.position, 1.0, along);
        } else {
            b.frame.rotation = product(&b.frame.rotation, &matrix(exponential([0.0, 0.0, joint.start])));
        }
    }
    let (Some(a), Some(b)) = (a, b) else { return Err(Faults::default()) };
    let name = numbered(&joint.name, "joint", number);
    model.joint(multibody::Joint::new(&name, joint.kind, a, b).driven(joint.drive.clone()));
    Ok(())
}

fn add_spring(model: &mut Model, parts: &Parts<'_>, spring: &Spring, number: usize) -> Made<()> {
    let [(from, first), (to, second)] = parts.pair(&spring.between)?;
    let end = |given: Option<Vector>, own: Option<Vector>, key: &str| {
        let message = "the ground has no point of its own: give one";
        given.or(own).ok_or_else(|| Faults::from(Fault::new(key, message)))
    };
    let (a, b) = (end(spring.ends[0], first, "from")?, end(spring.ends[1], second, "to")?);
    let apart = plus(b, -1.0, a).iter().map(|x| x * x).sum::<f64>().sqrt();
    if apart == 0.0 {
        return Err(Fault::new("", "has both ends at one point, and its force no direction").into());
    }
    model.spring(multibody::Spring {
        name: numbered(&spring.name, "spring", number),
        from: marker(model, from, a)?,
        to: marker(model, to, b)?,
        stiffness: spring.stiffness,
        damping: spring.damping,
        length: spring.length.unwrap_or(apart),
    });
    Ok(())
}

fn add_load(model: &mut Model, parts: &Parts<'_>, load: &Load, number: usize) -> Made<()> {
    let (part, point) = parts.point(&load.on, load.at, "on")?;
    if part == Part::Ground {
        return Err(Fault::new("on", "a load on the ground moves nothing").into());
    }
    let mut at = marker(model, part, point)?;
    if load.axes == multibody::Axes::Follower {
        // The components are those in the axes of the part.
        at.frame.rotation = IDENTITY;
    }
    model.load(multibody::Load {
        name: numbered(&load.name, "load", number),
        at,
        force: load.force,
        moment: load.couple,
        axes: load.axes,
        amplitude: load.amplitude.clone(),
    });
    Ok(())
}

fn add_line(model: &mut Model, beams: &[(Beam, slender::Beam)], load: &LineLoad, number: usize) -> Made<()> {
    let names = || beams.iter().map(|(beam, _)| beam.name.as_str());
    let Some(beam) = names().position(|name| name == load.on) else {
        let near =
            nearest(&load.on, names()).map_or(String::new(), |near| format!(": did you mean `{near}`?"));
        let fault = Fault::new("on", format!("there is no beam `{}`{near}", load.on));
        return Err(fault.help(format!("the beams are {}", super::declaration::listed(names()))).into());
    };
    let (of, built) = &beams[beam];
    let node = |station: f64, key: &str| {
        let near = |node: &f64| (node - station).abs() <= 1e-9 * of.length;
        built.nodes().iter().position(near).ok_or_else(|| {
            Faults::from(Fault::new(key, format!("is not on the beam, which ends at {} m", of.length)))
        })
    };
    let elements = node(load.range.0, "from")?..node(load.range.1.unwrap_or(of.length), "to")?;
    model.line_load(multibody::LineLoad {
        name: numbered(&load.name, "load", number),
        beam,
        elements: Some(elements),
        force: load.force,
        axes: load.axes,
        amplitude: load.amplitude.clone(),
    });
    Ok(())
}

fn add_contact(
    model: &mut Model,
    parts: &Parts<'_>,
    contact: &Contact,
    number: usize,
) -> Made<(touch::Contact, (usize, f64))> {
    let made = |point: usize| touch::Contact {
        name: numbered(&contact.name, "contact", number),
        point,
        obstacle: Arc::clone(&contact.obstacle),
        law: contact.law,
    };
    if let Some(beam) = parts.beams.iter().position(|(beam, _)| beam.name == contact.on) {
        let middle = 0.5 * parts.beams[beam].0.length;
        return Ok((made(model.contact_beam(beam, contact.radius)), (parts.bodies.len() + beam, middle)));
    }
    let (part, point) = parts.point(&contact.on, contact.at, "on")?;
    if part == Part::Ground {
        return Err(Fault::new("on", "a point of the ground touches nothing").into());
    }
    let marker = marker(model, part, point)?;
    let place = match part {
        Part::Section { beam, node } => (parts.bodies.len() + beam, parts.beams[beam].1.nodes()[node]),
        Part::Body(body) => (body, 0.0),
        Part::Ground => (0, 0.0),
    };
    Ok((made(model.contact_ball(marker, contact.radius)), place))
}

/// The contacts of the points of a beam that may touch everywhere, or the one contact of a place or of a whole beam. Forces are
/// summed up along the beam by the trapezium rule.
fn touches(contact: Contact, number: usize, beams: &[Beam], joints: &[Joint]) -> Made<Vec<Contact>> {
    let beam = beams.iter().find(|beam| beam.name == contact.on);
    if contact.at.is_some() && (beam.is_some() || contact.points.is_some()) {
        let help = "write `on = \"blade@2 m\"` for one place of a beam";
        return Err(Fault::new("at", "is a point of a body, and a whole beam may touch").help(help).into());
    }
    let Some(parts) = contact.points else {
        let bulges = |surface: Surface| surface.curvatures.iter().any(|k| *k > 0.0);
        if beam.is_some() && !bulges(contact.obstacle.surface([0.0; 3], 0.0)) {
            let message = "is flat or hollow: a beam touches it at many places, and none is the nearest";
            let help = "let the beam touch by points, `points = 20`, or name one place: `on = \"blade.tip\"`";
            return Err(Fault::new("obstacle", message).help(help).into());
        }
        return Ok(vec![contact]);
    };
    let Some(beam) = beam else {
        let message = format!("belong to a whole beam, and `{}` is none", contact.on);
        return Err(Fault::new("points", message).into());
    };
    let (root, name) = (format!("{}.root", beam.name), numbered(&contact.name, "contact", number));
    let held = beam.ends[0] != End::Free || joints.iter().any(|joint| joint.between.contains(&root));
    let spacing = beam.length / parts as f64;
    let point = |(i, k): (usize, usize)| {
        let (end, station) =
            (k == 0 || k == parts, if k == parts { beam.length } else { spacing * k as f64 });
        let law = share(contact.law, spacing, end);
        let (name, on) = (format!("{name}.{}", i + 1), format!("{}@{station} m", beam.name));
        Contact { name, on, law, ..contact.clone() }
    };
    Ok((usize::from(held)..=parts).enumerate().map(point).collect())
}

/// The stations of a beam that tables name, and those where loads begin and end.
fn stations(v: &Values, lines: &[LineLoad], contacts: &[Vec<Contact>], beam: &Beam) -> Vec<f64> {
    let mut names: Vec<&str> = contacts.iter().flatten().map(|contact| contact.on.as_str()).collect();
    for table in ["joint", "spring", "load"] {
        let Ok(Some(Value::Tables(list))) = v.optional(table) else { continue };
        for values in list {
            names.extend(values.texts("between").unwrap_or_default().iter().map(String::as_str));
            names.extend(values.text("on").ok());
        }
    }
    let length = |name: &str| (name == beam.name).then_some(beam.length);
    let places = names.into_iter().filter_map(|name| place(name, length).ok().flatten());
    let ends = lines.iter().filter(|load| load.on == beam.name);
    let ends = ends.flat_map(|load| [Some(load.range.0), load.range.1]).flatten();
    let ends = ends.filter(|station| *station <= beam.length);
    places.map(|(_, station)| station).chain(ends).collect()
}

/// Adds a beam and the joints of its ends.
fn add_beam(model: &mut Model, (beam, built): &(Beam, slender::Beam)) {
    let [velocity, spin] = beam.motion;
    let [damping, viscosity] = beam.damping;
    let flexible = Flexible::new(&beam.name, built.clone()).damped(damping).viscous(viscosity);
    let mut flexible = Flexible { velocity, spin, ..flexible.recorded_at(&beam.stations) };
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
            .join(&name, kind, parts, point, ([0.0, 0.0, 1.0], None))
            .map_err(|error| Fault::new("", error.to_string()))?;
    }
    Ok(())
}

/// Makes the system of the values of its case, for a method of integration.
pub(super) fn make(v: &Values, c: &Context<'_>, method: Option<&Method>) -> Made<Space> {
    let mut found = Found::default();
    let bodies = found.part(BODY.make(v, c));
    let beams = found.part(BEAMS.make(v, c));
    let joints = found.part(JOINTS.make(v, c));
    let springs = found.part(SPRING.make(v, c));
    let loads = found.part(LOAD.make(v, c));
    let lines = found.part(LINE_LOAD.make(v, c));
    let contacts = found.part(CONTACT.make(v, c));
    let rotation = found.part(ROTATION.make(v, c));
    let gravity = found.part(vector(v, GRAVITY.name));
    let settings = |model: &Values| Ok((model.boolean("drop-redundant-rows")?, model.count("refine")?));
    let settings = found.part(v.table(MODEL.name).and_then(settings));
    initial(v, &mut found);
    let (Some(bodies), Some(joints), Some(springs), Some(loads)) = (bodies, joints, springs, loads) else {
        return Err(found.0);
    };
    let (Some(contacts), Some(gravity), Some((drop, refine))) = (contacts, gravity, settings) else {
        return Err(found.0);
    };
    let (Some(beams), Some(lines), Some(rotation)) = (beams, lines, rotation) else { return Err(found.0) };
    let along = |(i, contact): (usize, Contact)| {
        let made = touches(contact, i, &beams, &joints).map_err(|faults| faults.within(&item("contact", i)));
        found.part(made)
    };
    let contacts: Option<Vec<Vec<Contact>>> = contacts.into_iter().enumerate().map(along).collect();
    let Some(contacts) = contacts else { return Err(found.0) };
    let build = |(i, beam): (usize, Beam)| {
        let built = beam
            .built(&stations(v, &lines, &contacts, &beam), refine)
            .map_err(|faults| faults.within(&item("beam", i)));
        found.part(built).map(|built| (beam, built))
    };
    let beams: Vec<Option<(Beam, slender::Beam)>> = beams.into_iter().enumerate().map(build).collect();
    let Some(beams) = beams.into_iter().collect::<Option<Vec<_>>>() else { return Err(found.0) };
    let mut model = Model::new().with_gravity(gravity);
    if drop {
        model = model.drop_redundant_rows();
    }
    let names = |body: &Body| (body.name.clone(), model.body(body.clone()), body.frame.position);
    let parts = Parts { bodies: bodies.iter().map(names).collect(), beams: &beams };
    let of_bodies = bodies.iter().enumerate().map(|(i, body)| (item("body", i), &body.name));
    let of_beams = beams.iter().enumerate().map(|(i, (beam, _))| (item("beam", i), &beam.name));
    let mut taken = BTreeSet::new();
    for (table, name) in of_bodies.chain(of_beams) {
        found.check(!taken.insert(name), &format!("{table}.name"), || {
            format!("the name `{name}` is already taken")
        });
    }
    for beam in &beams {
        add_beam(&mut model, beam);
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
    for (i, load) in loads.iter().enumerate() {
        add("load", i, add_load(&mut model, &parts, load, i));
    }
    for (i, load) in lines.iter().enumerate() {
        add("distributed-load", i, add_line(&mut model, &beams, load, loads.len() + i));
    }
    let (mut touching, mut places): (Vec<touch::Contact>, Vec<_>) = Default::default();
    let points: Vec<usize> = contacts.iter().map(Vec::len).collect();
    let each = contacts.iter().enumerate().flat_map(|(i, list)| list.iter().map(move |contact| (i, contact)));
    for (i, contact) in each {
        let made = add_contact(&mut model, &parts, contact, i).and_then(|(made, place)| {
            if touching.iter().any(|other| other.name == made.name) {
                let message = format!("two contacts are called `{}`", made.name);
                return Err(Fault::new("name", message).into());
            }
            touching.push(made);
            places.push(place);
            Ok(())
        });
        add("contact", i, made);
    }
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
    let disc =
        |contact: &touch::Contact| matches!(contact.law, touch::Law::Constraint { .. }) && contact.law.rubs();
    if let (Some(method), Some(i)) = (method, touching.iter().position(disc))
        && !method.integrator.resolves_contacts()
    {
        let message = "friction of a rigid contact in space has a direction of its own at every time, which events do not find";
        let help = "take `nonsmooth-generalized-alpha` or `moreau-jean`, which resolve contacts in every step, or a law of force";
        let mut tables = points.iter().enumerate().flat_map(|(table, n)| std::iter::repeat_n(table, *n));
        let table = item("contact", tables.nth(i).unwrap_or(0));
        return Err(Fault::new(format!("{table}.law.friction"), message).help(help).into());
    }
    let names: Vec<String> = joints.iter().enumerate().map(|(i, j)| numbered(&j.name, "joint", i)).collect();
    let multibody = Multibody::new(model).map_err(|error| blamed(&error, v, &names))?;
    let rotation =
        match rotation.first() {
            Some(about) => Ok(Rotation::given(about, multibody.model())
                .map_err(|faults| faults.within(ROTATION.key.name))?),
            None => Rotation::found(multibody.model()),
        };
    let of_ends = beams.iter().flat_map(|(beam, _)| beam.held());
    let joints =
        names.into_iter().zip(&joints).map(|(name, j)| (name, j.written.clone(), j.between.clone(), j.at));
    let joints = joints.chain(of_ends.map(|(name, kind, between)| (name, kind, between, None)));
    let link = |(name, kind, between, at): (String, String, [String; 2], Option<Vector>)| {
        let own = |place: &String| parts.find(place).ok().and_then(|(_, point)| point);
        let point = at.or_else(|| own(&between[1])).or_else(|| own(&between[0])).unwrap_or_default();
        Link { name, kind, between, point }
    };
    let joints = joints.map(link).collect();
    let mut extent = 0.0_f64;
    for (.., point) in &parts.bodies {
        extent = point.iter().fold(extent, |extent, x| extent.max(x.abs()));
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

/// The initial states that a system in space can have.
fn initial(v: &Values, found: &mut Found) {
    let kind = v.kind("initial").unwrap_or("undeformed");
    found.check(matches!(kind, "steady-rotation" | "modes"), "initial.kind", || {
        format!("`{kind}` is for a beam on a hub: a system in space begins as its parts are written, or in `static` equilibrium")
    });
}

/// A fault of the model at the table that is to blame.
fn blamed(error: &ModelError, v: &Values, joints: &[String]) -> Faults {
    let joint = |name: &str| joints.iter().position(|known| known == name).map(|i| item("joint", i));
    let named = |table: &str, name: &str| {
        if let Some(name) = name.strip_suffix("-root").or_else(|| name.strip_suffix("-tip"))
            && table == "joint"
            && let Ok(Some(Value::Tables(list))) = v.optional("beam")
            && let Some(i) = list.iter().position(|values| values.text("name") == Ok(name))
        {
            return Some(item("beam", i));
        }
        let list = if let Ok(Some(Value::Tables(list))) = v.optional(table) { list.as_slice() } else { &[] };
        let same = |(i, values): &(usize, &Values)| {
            let written = values.optional_text("name").ok().flatten().unwrap_or_default();
            numbered(written, table, *i) == name
        };
        list.iter().enumerate().rfind(same).map(|(i, _)| item(table, i))
    };
    let help = |fault: Fault, help: &str| Faults::from(fault.help(help));
    // The last joint of which a row is named.
    let last = |rows: &[String]| {
        let named = |name: &String| rows.iter().any(|row| row.contains(&format!("in joint `{name}`")));
        joints.iter().rposition(named).map_or(String::new(), |i| item("joint", i))
    };
    match error {
        ModelError::Part { kind, name, fault } => {
            Fault::new(named(kind, name).unwrap_or_default(), format!("{kind} `{name}` {fault}")).into()
        }
        ModelError::Empty => Fault::new("body", "a system in space has at least one body or beam").into(),
        ModelError::Positions { violations } => {
            let worst = violations.first().and_then(|violation| joint(&violation.joint));
            let message = "the parts do not fit this joint at the start";
            let off = violations.iter().map(|violation| violation.to_string()).collect::<Vec<_>>().join(", ");
            let message = format!("{message}: {off}");
            help(Fault::new(worst.unwrap_or_default(), message), "move the parts or the joints")
        }
        ModelError::Redundant { rows, freedoms } => {
            let key = last(rows);
            let message = format!(
                "{} redundant: the joints of a loop hold a motion twice, and {freedoms} degrees of freedom are left",
                rows.join(", ")
            );
            help(
                Fault::new(key, message),
                "give a joint of the loop more freedom (spherical, universal or cylindrical in the place of revolute), take \
                 away the prescribed motion of what is locked, or write `model.drop-redundant-rows = true`",
            )
        }
        ModelError::Contradictory { rows } => help(
            Fault::new(last(rows), format!("joints that contradict each other: {}", rows.join(", "))),
            "what they prescribe at the start differs in velocity or acceleration: take away a prescribed motion, let them agree, \
             or give a joint more freedom",
        ),
        ModelError::Singular { rows } => help(
            Fault::new(last(rows), format!("the start is a singular configuration of {}", rows.join(", "))),
            "bars that are stretched out or folded flat may move on in more than one way or in none: begin elsewhere, or give a \
             joint more freedom",
        ),
        ModelError::Velocities(_) => Fault::new("joint", error.to_string()).into(),
    }
}
