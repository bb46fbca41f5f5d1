//! Lumped masses on beams.

use super::name::{NAME, name};
use crate::declaration::Bound::*;
use crate::keys::{keys, place, quantity};
use crate::kind::{Of, Table};
use crate::units::{INERTIA, MASS as MASSES};

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

keys! {
    /// What a case says of a mass.
    struct Written {
        name: Option<String> = NAME;
        /// station of a beam
        on: (usize, f64) = place();
        /// mass
        mass: f64 = quantity(&MASSES, Positive);
        /// moment of inertia about its centre, which lies on the axis of the beam
        inertia: f64 = quantity(&INERTIA, NotNegative).or(0.0);
    }
}

/// The tables `[[mass]]`.
pub static MASS: Table<Mass> = Table::list(
    "mass",
    "lumped masses on beams",
    "mass=[{on='tip', mass='300 g', inertia=2e-3}]",
    &Of(|k: Written, _| {
        let (beam, station) = k.on;
        Ok(Mass { name: name(k.name, &["ground"])?, beam, station, mass: k.mass, inertia: k.inertia })
    }),
);
