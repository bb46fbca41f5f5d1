//! What is wrong with a system in space, at the table that is to blame.

use super::fault::{Fault, Faults, Made};
use super::kinds::contact::Contact;
use super::kinds::load::{Acts, Load};
use super::kinds::name::numbered;
use super::kinds::spring::{Joins, Spring};
use super::layout::GRAVITY;
use super::values::{Value, Values, item};
use flexion::linalg::Vec3;
use flexion::multibody::ModelError;

/// Refuses what acts out of the plane of x and y: gravity, loads, springs and contacts.
pub(super) fn leaves_the_plane(
    (gravity, loads, springs, contacts): (Vec3, &[Load], &[Spring], &[Contact]),
) -> Made<()> {
    let mut faults = Faults::default();
    let mut check = |out: bool, key: String| {
        if out {
            let message =
                "leads out of the plane of x and y, in which alone the section of the beam is known";
            let help = "give a section that says torsion and bending across: `rectangle`, `circle`, `tube`, `ellipse` or `general`";
            faults.0.push(Fault::new(key, message).help(help));
        }
    };
    check(gravity[2] != 0.0, GRAVITY.name.to_owned());
    for (i, load) in loads.iter().enumerate() {
        let table = item("load", i);
        match &load.acts {
            Acts::At { force, couple, .. } => {
                check(force[2] != 0.0, format!("{table}.force"));
                check(couple[0] != 0.0 || couple[1] != 0.0, format!("{table}.couple"));
            }
            Acts::Along { force, .. } => check(force[2] != 0.0, format!("{table}.force-per-length")),
            Acts::By { law, .. } => check(!law.is_isotropic(), format!("{table}.law")),
        }
    }
    for (i, spring) in springs.iter().enumerate() {
        let out = match &spring.joins {
            Joins::Point { to, .. } => to[2] != 0.0,
            Joins::Line { ends, .. } => ends.iter().flatten().any(|end| end[2] != 0.0),
        };
        check(out, item("spring", i));
    }
    for (i, contact) in contacts.iter().enumerate() {
        check(!contact.obstacle.planar, format!("{}.obstacle", item("contact", i)));
    }
    if faults.0.is_empty() { Ok(()) } else { Err(faults) }
}

/// A fault of the model at the table that is to blame.
pub(super) fn blamed(error: &ModelError, v: &Values, joints: &[String]) -> Faults {
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
        _ => Fault::new("joint", error.to_string()).into(),
    }
}
