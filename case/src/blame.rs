//! What is wrong with a system in space, at the table that is to blame.

use super::fault::{Fault, Faults, Made};
use super::kinds::contact::Contact;
use super::kinds::load::{Acts, Load};
use super::kinds::spring::{Joins, Spring};
use super::layout::GRAVITY;
use super::values::item;
use flexion::linalg::Vec3;
use flexion::multibody::{DependentRow, ModelError};

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
    check(gravity[2] != 0.0, GRAVITY.key.name.to_owned());
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

/// The tables of which the parts of a model are made, in the order of the model.
#[derive(Default)]
pub(super) struct Tables {
    /// Bodies, and behind them those of masses.
    pub bodies: Vec<String>,
    /// The ends of beams, joints, and what fixes masses.
    pub joints: Vec<String>,
    /// Loads at points, behind them those along beams, and behind these force laws.
    pub loads: Vec<String>,
}

impl Tables {
    fn of(&self, kind: &str, number: usize) -> String {
        let own = match kind {
            "body" => &self.bodies,
            "joint" => &self.joints,
            "load" => &self.loads,
            "beam" | "spring" => return item(kind, number),
            _ => return String::new(),
        };
        own.get(number).cloned().unwrap_or_default()
    }

    /// Of the last joint among rows.
    fn of_last(&self, rows: &[DependentRow]) -> String {
        rows.iter().map(|row| row.joint).max().map_or(String::new(), |joint| self.of("joint", joint))
    }
}

/// A fault of the model at the table that is to blame.
pub(super) fn blamed(error: &ModelError, tables: &Tables) -> Faults {
    let help = |fault: Fault, help: &str| Faults::from(fault.help(help));
    let texts = |rows: &[DependentRow], text: fn(&DependentRow) -> String| {
        rows.iter().map(text).collect::<Vec<_>>().join(", ")
    };
    match error {
        ModelError::Part { kind, number, name, fault } => {
            Fault::new(tables.of(kind, *number), format!("{kind} `{name}` {fault}")).into()
        }
        ModelError::Empty => Fault::new("body", "a system in space has at least one body or beam").into(),
        ModelError::Positions { violations } => {
            let worst = violations.first().map(|violation| tables.of("joint", violation.number));
            let message = "the parts do not fit this joint at the start";
            let off = violations.iter().map(|violation| violation.to_string()).collect::<Vec<_>>().join(", ");
            let message = format!("{message}: {off}");
            help(Fault::new(worst.unwrap_or_default(), message), "move the parts or the joints")
        }
        ModelError::Redundant { rows, freedoms } => {
            let key = tables.of_last(rows);
            let message = format!(
                "{} redundant: the joints of a loop hold a motion twice, and {freedoms} degrees of freedom are left",
                texts(rows, DependentRow::following)
            );
            help(
                Fault::new(key, message),
                "give a joint of the loop more freedom (spherical, universal or cylindrical in the place of revolute), take \
                 away the prescribed motion of what is locked, or write `model.drop-redundant-rows = true`",
            )
        }
        ModelError::Contradictory { rows } => help(
            Fault::new(
                tables.of_last(rows),
                format!("joints that contradict each other: {}", texts(rows, DependentRow::opposed)),
            ),
            "what they prescribe at the start differs in velocity or acceleration: take away a prescribed motion, let them agree, \
             or give a joint more freedom",
        ),
        ModelError::Singular { rows } => help(
            Fault::new(
                tables.of_last(rows),
                format!("the start is a singular configuration of {}", texts(rows, DependentRow::opposed)),
            ),
            "bars that are stretched out or folded flat may move on in more than one way or in none: begin elsewhere, or give a \
             joint more freedom",
        ),
        _ => Fault::new("joint", error.to_string()).into(),
    }
}
