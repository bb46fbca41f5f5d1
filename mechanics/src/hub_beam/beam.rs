//! What the models of a beam are built from: the cross-section along it, lumped masses, and breaks of the mesh.

use crate::section::Section;

/// A rigid body of small extent fixed to the axis of the beam.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mass {
    /// Station x_m on the axis \[m\].
    pub station: f64,
    /// Mass m \[kg\].
    pub mass: f64,
    /// Moment of inertia j about its centre of mass, which lies on the axis [kg·m²]; it rotates with the section.
    pub inertia: f64,
}

/// A beam. A reference to a [`Section`] is a beam without masses.
#[derive(Clone, Debug)]
pub struct Beam<'a> {
    /// Cross-section along the beam.
    pub section: &'a dyn Section,
    /// Lumped masses.
    pub masses: Vec<Mass>,
    /// Stations at which cells end \[m\], ascending, so that quadrature within cells meets smooth functions: those of
    /// the section, of the masses and of the loads.
    pub breaks: Vec<f64>,
}

impl<'a> Beam<'a> {
    /// A beam of `section` with `masses`; cells also end at `stations` \[m\].
    pub fn new(section: &'a dyn Section, masses: Vec<Mass>, stations: &[f64]) -> Beam<'a> {
        let mut breaks = section.breaks().to_vec();
        breaks.extend(masses.iter().map(|m| m.station));
        breaks.extend(stations);
        breaks.sort_by(f64::total_cmp);
        breaks.dedup();
        Beam { section, masses, breaks }
    }
}

impl<'a, S: Section> From<&'a S> for Beam<'a> {
    fn from(section: &'a S) -> Beam<'a> {
        Beam::new(section, Vec::new(), &[])
    }
}

impl<'a> From<&'a dyn Section> for Beam<'a> {
    fn from(section: &'a dyn Section) -> Beam<'a> {
        Beam::new(section, Vec::new(), &[])
    }
}

impl<'a> From<&Beam<'a>> for Beam<'a> {
    fn from(beam: &Beam<'a>) -> Beam<'a> {
        beam.clone()
    }
}
