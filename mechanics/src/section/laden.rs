//! A section with what the beam carries: lumped masses, and stations at which cells must end.

use super::{Resultants, Section};

/// A rigid body of small extent fixed to the axis of the beam.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mass {
    /// Station x_m on the axis \[m\].
    pub station: f64,
    /// Mass m \[kg\].
    pub mass: f64,
    /// Moment of inertia j about its centre of mass, which lies on the axis [kg·m²]; it turns with the section.
    pub inertia: f64,
}

/// A section along a beam that carries [masses](Mass). Cells end at the masses and at further stations, those of
/// the loads, so that quadrature within cells meets smooth functions.
#[derive(Debug)]
pub struct Laden {
    section: Box<dyn Section>,
    masses: Vec<Mass>,
    breaks: Vec<f64>,
}

impl Laden {
    /// `section` with `masses`; cells also end at `stations` \[m\].
    pub fn new(section: Box<dyn Section>, masses: Vec<Mass>, stations: &[f64]) -> Laden {
        let mut breaks = section.breaks().to_vec();
        breaks.extend(masses.iter().map(|m| m.station));
        breaks.extend(stations);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        Laden { section, masses, breaks }
    }
}

impl Section for Laden {
    fn resultants(&self, x: f64) -> Resultants {
        self.section.resultants(x)
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn jumps(&self) -> &[f64] {
        self.section.jumps()
    }

    fn masses(&self) -> &[Mass] {
        &self.masses
    }

    fn fibres(&self, x: f64) -> Option<(f64, f64)> {
        self.section.fibres(x)
    }
}
