//! Lumped masses on beams.

use super::name::{NAME, name};
use crate::declaration::{Bound::*, Presence as Default, Presence::*, Type, Type::Quantity, key};
use crate::fault::{Fault, Made};
use crate::kind::{Context, Table};
use crate::places::Place;
use crate::units;
use crate::values::Values;

/// A mass on a beam.
#[derive(Clone, Debug, PartialEq)]
pub struct Mass {
    /// Name; empty where none is given.
    pub name: String,
    /// Number of the beam.
    pub beam: usize,
    /// Arc length \[m\].
    pub station: f64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Moment of inertia about its centre, which lies on the axis of the beam [kg·m²].
    pub inertia: f64,
}

/// The station of a beam that `key` names.
pub(super) fn station(v: &Values, key: &str, c: &Context<'_>) -> Made<(usize, f64)> {
    match c.place(v, key)? {
        Place::Station { beam, s } => Ok((beam, s)),
        place => {
            let what = match place {
                Place::Ground => "the ground",
                Place::Body(_) => "a body",
                _ => "a whole beam",
            };
            let message = format!("is {what}, and not a station of a beam");
            Err(Fault::new(key, message).help("write for example `on = \"tip\"` or `on = \"2 m\"`").into())
        }
    }
}

/// The tables `[[mass]]`.
pub static MASS: Table<Mass> = Table {
    key: key(
        "mass",
        Type::Tables(&[
            NAME,
            key("on", Type::Place, Required, "station of a beam"),
            key("mass", Quantity(&units::MASS, Positive), Required, "mass"),
            key(
                "inertia",
                Quantity(&units::INERTIA, NotNegative),
                Default::Number(0.0),
                "moment of inertia about its centre, which lies on the axis of the beam",
            ),
        ]),
        Empty,
        "lumped masses on beams",
    ),
    example: "mass=[{on='tip', mass='300 g', inertia=2e-3}]",
    make: |v, c| {
        let (beam, station) = station(v, "on", c)?;
        Ok(Mass {
            name: name(v, &[])?,
            beam,
            station,
            mass: v.number("mass")?,
            inertia: v.number("inertia")?,
        })
    },
};
