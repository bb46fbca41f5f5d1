//! A system in space: the model that is made of its parts.

mod alike;
mod mounted;
mod named;
mod placed;
mod spinning;
mod trapeze;

use crate::blame::{Tables, blamed, leaves_the_plane};
use crate::driven;
use crate::fault::{Fault, Found, Made};
use crate::kind::Context;
use crate::kinds::beam::{BEAMS, Beam, End, FIBRES, Fibre};
use crate::kinds::body::BODY;
use crate::kinds::contact::{Contact, Mount, Point, Touching, contacts};
use crate::kinds::coupling::{SPACE, SPACE_WITH_SHEAR};
use crate::kinds::integrator::Method;
use crate::kinds::joint::{JOINTS, Joint};
use crate::kinds::load::{Acts, LOAD, Load};
use crate::kinds::mass::{MASS, Mass};
use crate::kinds::name::numbered;
use crate::kinds::rotation::{ROTATION, Rotation};
use crate::kinds::spring::SPRING;
use crate::layout::{GRAVITY, INITIAL, MODEL, OUTPUT_IN_SPACE};
use crate::places::{Parts, Place};
use crate::stations::stations;
use crate::values::{Values, item};
use flexion::contact::{self as touch, Contacting, Surface};
use flexion::linalg::Vec3;
use flexion::multibody::{self, Body, Model, Multibody};
use flexion::system::Fork;
use named::Named;
use placed::{Placed, add_beam, add_ends, add_joint, add_load, add_mass, add_point, add_spring};

/// Component of a unit vector, against 0 or 1, that is rounding.
const LEVEL: f64 = 1e-9;

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
    /// The same of what carries its obstacle, if a part does.
    pub carriers: Vec<Option<(usize, f64)>>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The beams, and as they are built.
    pub beams: Vec<(Beam, multibody::Beam)>,
    /// The joints.
    pub joints: Vec<Link>,
    /// How it rotates steadily, or why it does not.
    pub rotation: Result<Rotation, String>,
    /// Whether beams lie in the plane of x and y with one axis of their sections, and nothing leads out of it.
    pub flat: bool,
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

/// The points of a contact. Forces along a beam are summed up by the trapezium rule.
fn points_of(contact: &Contact, parts: &Parts, beams: &[Beam], joints: &[Joint]) -> Made<Vec<Point>> {
    if contact.massless {
        let message = "only the tip of a planar beam can do without mass";
        let help = "write `law = { kind = \"constraint\", restitution = 0.5 }`";
        return Err(Fault::new("law", message).help(help).into());
    }
    if contact.mount == Mount::Hub {
        let message = "a system in space has obstacles that are fixed to the ground, or to a part, or moved";
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

/// The tables of what a model has, in its order.
fn tables(
    bodies: &[Body],
    beams: &[(Beam, multibody::Beam)],
    joints: &[Joint],
    masses: &[Mass],
    loads: &[Load],
) -> Tables {
    let all = |table: &'static str, count: usize| (0..count).map(move |i| item(table, i));
    let held = |(i, (beam, _)): (usize, &(Beam, multibody::Beam))| {
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
    let mut joints = found.part(JOINTS.make(v, c));
    if let Some(joints) = &mut joints {
        found.part(driven::on_joints(c.signals, joints));
    }
    let springs = found.part(SPRING.make(v, c));
    let masses = found.part(MASS.make(v, c));
    let mut loads = found.part(LOAD.make(v, c));
    loads.iter_mut().for_each(|loads| driven::on_loads(c.signals, loads));
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
    let (Some(contacts), Some(Settings { drop, refine, in_root_axes, shear }), Some(rotation)) =
        (contacts, settings, rotation)
    else {
        return Err(found.0);
    };
    let acting = (gravity, &loads[..], &springs[..], &contacts[..]);
    let in_plane = leaves_the_plane(acting);
    let mut flat = in_plane.is_ok();
    if beams.iter().any(|beam| beam.planar) {
        found.part(in_plane);
    }
    let along = |(i, contact): (usize, &Contact)| {
        let points = points_of(contact, names, &beams, &joints);
        found.part(points.map_err(|faults| faults.within(&item("contact", i))))
    };
    let points: Option<Vec<Vec<Point>>> = contacts.iter().enumerate().map(along).collect();
    let Some(points) = points else { return Err(found.0) };
    let on_nodes = contacts.iter().zip(&points).filter(|(contact, _)| !contact.is_on_axis());
    let touching = on_nodes.flat_map(|(_, list)| list).map(|(_, place, _)| *place);
    let carriers = contacts.iter().filter_map(Contact::carrier);
    let touching = touching.chain(carriers).collect();
    let named = Named::of(&joints, &springs, &loads, &masses, touching);
    let build = |(i, mut beam): (usize, Beam)| {
        beam.shear |= shear;
        c.cautions.borrow_mut().extend(beam.left_out());
        let built = beam.built(&named.on(i), refine).map_err(|faults| faults.within(&item("beam", i)));
        found.part(built).map(|built| (beam, built))
    };
    let beams: Vec<Option<(Beam, multibody::Beam)>> = beams.into_iter().enumerate().map(build).collect();
    let Some(beams) = beams.into_iter().collect::<Option<Vec<_>>>() else { return Err(found.0) };
    for (i, (beam, built)) in beams.iter().enumerate() {
        let lies = is_flat(built);
        flat &= lies;
        found.check(beam.planar && !lies, &format!("{}.planar", item("beam", i)), || {
            "the beam does not lie in the plane of x and y with one axis of its section".to_owned()
        });
    }
    let mut model = Model::new().with_gravity(gravity);
    if drop {
        model = model.drop_redundant_rows();
    }
    let turns_in_plane = |joint: &Joint| {
        matches!(joint.kind, multibody::Kind::Prismatic) || joint.axes.column(2)[2].abs() >= 1.0 - LEVEL
    };
    if flat && beams.iter().any(|(beam, _)| beam.planar) && joints.iter().all(turns_in_plane) {
        model = model.in_plane();
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
    let (mut touching, mut places, mut carriers): (Vec<touch::Contact>, Vec<_>, Vec<_>) = Default::default();
    for (i, (contact, list)) in contacts.iter().zip(&points).enumerate() {
        for point in list {
            let made = add_point(&mut model, &parts, contact, point).map(|(made, place)| {
                touching.push(made);
                places.push(place);
                carriers.push(parts.carrier(contact));
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
    let space = Space {
        multibody,
        contacts: touching,
        points,
        touching: places,
        carriers,
        bodies,
        beams,
        joints,
        rotation,
        flat,
        refine,
        size,
    };
    let mut cautions = c.cautions.take();
    cautions.extend(space.mounted(c.duration.unwrap_or(0.0)));
    c.cautions.replace(space.once(cautions));
    Ok(space)
}

impl Space {
    /// Sentences that differ by the names of beams alone, as one.
    fn once(&self, sentences: Vec<String>) -> Vec<String> {
        let names: Vec<&str> = self.beams.iter().map(|(beam, _)| &*beam.name).collect();
        alike::once(sentences, &names)
    }
}

/// Whether a beam lies in the plane of x and y, with one axis of its sections.
fn is_flat(beam: &multibody::Beam) -> bool {
    let flat = |node| {
        let [tangent, up, _] = beam.node(node, beam.initial()).rotation[2].map(f64::abs);
        tangent <= LEVEL && (up <= LEVEL || up >= 1.0 - LEVEL)
    };
    (0..beam.nodes().len()).all(flat)
}

/// What holds for the whole system.
struct Settings {
    /// Whether redundant rows are left out.
    drop: bool,
    /// Into how many each element is cut.
    refine: usize,
    /// Whether stations are recorded in the axes of their root.
    in_root_axes: bool,
    /// Whether every beam has shear.
    shear: bool,
}

fn settings(v: &Values, c: &Context<'_>) -> Made<Settings> {
    let model = MODEL.read(v, c)?;
    let coupling = model.coupling.name;
    if ![SPACE, SPACE_WITH_SHEAR].contains(&coupling) {
        let message = format!(
            "`{coupling}` is a model of one beam on a hub in the plane, and this case has bodies, joints or beams by name"
        );
        let help = "leave it out, or describe the beam by [beam], [section] and [hub]";
        return Err(Fault::new("model.coupling", message).help(help).into());
    }
    Ok(Settings {
        drop: model.drop_redundant_rows,
        refine: model.refine,
        in_root_axes: OUTPUT_IN_SPACE.read(v, c)?.root_axes,
        shear: coupling == SPACE_WITH_SHEAR,
    })
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
