//! A system in space: its parts by name, and the model that is made of them.

use super::case::Found;
use super::fault::{Fault, Faults, Made};
use super::kind::Context;
use super::kinds::body::BODY;
use super::kinds::integrator::Method;
use super::kinds::joint::{JOINTS, Joint};
use super::kinds::obstacle::{CONTACT, Contact};
use super::kinds::spatial::{GRAVITY, LOAD, Load, MODEL, SPRING, Spring, vector};
use super::values::{Value, Values, item};
use flexion::contact::{self as touch, Contacting};
use flexion::multibody::rotation::{IDENTITY, Vector, exponential, matrix, plus, product};
use flexion::multibody::{self, Body, Marker, Model, ModelError, Multibody, Part};
use flexion::system::{Fork, Frame};
use flexion_results::nearest;
use std::sync::Arc;

/// Bodies, joints and beams in space.
#[derive(Clone, Debug)]
pub struct Space {
    /// The system, without its contacts.
    pub multibody: Multibody,
    /// What its points may touch.
    pub contacts: Vec<touch::Contact>,
    /// The bodies.
    pub bodies: Vec<Body>,
    /// The joints: name, kind as written, and the two parts as written.
    pub joints: Vec<(String, String, [String; 2])>,
    /// Largest distance between its parts \[m\].
    pub size: f64,
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
struct Parts {
    names: Vec<(String, Part, Vector)>,
}

impl Parts {
    /// The part of this name, and its own point if it has one.
    fn find(&self, name: &str) -> Result<(Part, Option<Vector>), Fault> {
        if name == "ground" {
            return Ok((Part::Ground, None));
        }
        if let Some((_, part, point)) = self.names.iter().find(|(known, ..)| known == name) {
            return Ok((*part, Some(*point)));
        }
        let all = || std::iter::once("ground").chain(self.names.iter().map(|(name, ..)| name.as_str()));
        let near = nearest(name, all()).map_or(String::new(), |near| format!(": did you mean `{near}`?"));
        let listed = super::declaration::listed(all());
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

fn add_joint(model: &mut Model, parts: &Parts, joint: &Joint, number: usize) -> Made<()> {
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

fn add_spring(model: &mut Model, parts: &Parts, spring: &Spring, number: usize) -> Made<()> {
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

fn add_load(model: &mut Model, parts: &Parts, load: &Load, number: usize) -> Made<()> {
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

fn add_contact(model: &mut Model, parts: &Parts, contact: &Contact, number: usize) -> Made<touch::Contact> {
    let (part, point) = parts.point(&contact.on, contact.at, "on")?;
    if part == Part::Ground {
        return Err(Fault::new("on", "a point of the ground touches nothing").into());
    }
    let marker = marker(model, part, point)?;
    Ok(touch::Contact {
        name: numbered(&contact.name, "contact", number),
        point: model.contact_point(marker),
        obstacle: Arc::clone(&contact.obstacle),
        law: contact.law,
    })
}

/// Makes the system of the values of its case, for a method of integration.
pub(super) fn make(v: &Values, c: &Context<'_>, method: Option<&Method>) -> Made<Space> {
    let mut found = Found::default();
    let bodies = found.part(BODY.make(v, c));
    let joints = found.part(JOINTS.make(v, c));
    let springs = found.part(SPRING.make(v, c));
    let loads = found.part(LOAD.make(v, c));
    let contacts = found.part(CONTACT.make(v, c));
    let gravity = found.part(vector(v, GRAVITY.name));
    let drop = found.part(v.table(MODEL.name).and_then(|model| model.boolean("drop-redundant-rows")));
    initial(v, &mut found);
    let (Some(bodies), Some(joints), Some(springs), Some(loads)) = (bodies, joints, springs, loads) else {
        return Err(found.0);
    };
    let (Some(contacts), Some(gravity), Some(drop)) = (contacts, gravity, drop) else { return Err(found.0) };
    let mut model = Model::new().with_gravity(gravity);
    if drop {
        model = model.drop_redundant_rows();
    }
    let names = |body: &Body| (body.name.clone(), model.body(body.clone()), body.frame.position);
    let parts = Parts { names: bodies.iter().map(names).collect() };
    let mut add = |table: &str, number: usize, added: Made<()>| {
        found.part(added.map_err(|faults| faults.within(&item(table, number))));
    };
    for (i, joint) in joints.iter().enumerate() {
        add("joint", i, add_joint(&mut model, &parts, joint, i));
    }
    for (i, spring) in springs.iter().enumerate() {
        add("spring", i, add_spring(&mut model, &parts, spring, i));
    }
    for (i, load) in loads.iter().enumerate() {
        add("load", i, add_load(&mut model, &parts, load, i));
    }
    let mut touching: Vec<touch::Contact> = Vec::new();
    for (i, contact) in contacts.iter().enumerate() {
        let made = add_contact(&mut model, &parts, contact, i).and_then(|made| {
            if touching.iter().any(|other| other.name == made.name) {
                let message = format!("two contacts are called `{}`", made.name);
                return Err(Fault::new("name", message).into());
            }
            touching.push(made);
            Ok(())
        });
        add("contact", i, made);
    }
    if !found.0.0.is_empty() {
        return Err(found.0);
    }
    if let (Some(method), false) = (method, joints.is_empty())
        && !method.integrator.info().implicit
    {
        let message = "an explicit method has no way to hold the joints";
        let help = "take `radau`, which controls its steps, or `generalized-alpha` with a step";
        return Err(Fault::new("integrator.kind", message).help(help).into());
    }
    let names: Vec<String> = joints.iter().enumerate().map(|(i, j)| numbered(&j.name, "joint", i)).collect();
    let multibody = Multibody::new(model).map_err(|error| blamed(&error, v, &names))?;
    let joints = names.into_iter().zip(joints).map(|(name, j)| (name, j.written, j.between)).collect();
    let mut extent = 0.0_f64;
    for (_, _, a) in &parts.names {
        let farthest = |b: &Vector| plus(*b, -1.0, *a).iter().map(|x| x * x).sum::<f64>().sqrt();
        let others = parts.names.iter().map(|(.., b)| farthest(b)).chain([farthest(&[0.0; 3])]);
        extent = others.fold(extent, f64::max);
    }
    let size = if extent > 0.0 { extent } else { 1.0 };
    Ok(Space { multibody, contacts: touching, bodies, joints, size })
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
        let list = if let Ok(Some(Value::Tables(list))) = v.optional(table) { list.as_slice() } else { &[] };
        let same = |(i, values): &(usize, &Values)| {
            let written = values.optional_text("name").ok().flatten().unwrap_or_default();
            numbered(written, table, *i) == name
        };
        list.iter().enumerate().filter(same).last().map(|(i, _)| item(table, i))
    };
    let help = |fault: Fault, help: &str| Faults::from(fault.help(help));
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
            let last = joints
                .iter()
                .rposition(|name| rows.iter().any(|row| row.contains(&format!("in joint `{name}`"))));
            let key = last.map_or(String::new(), |i| item("joint", i));
            let message = format!(
                "{} redundant: the joints of a loop hold a motion twice, and {freedoms} degrees of freedom are left",
                rows.join(", ")
            );
            let fault = Fault::new(key, message);
            help(
                fault,
                "give a joint of the loop more freedom (spherical, universal or cylindrical in the place of revolute), take \
                 away the prescribed motion of what is locked, or write `model.drop-redundant-rows = true`",
            )
        }
        ModelError::Velocities(_) => Fault::new("joint", error.to_string()).into(),
    }
}
