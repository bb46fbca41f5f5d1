//! The kinematic model of the beam: kinds and how the system of each is assembled.

use super::basis::Bases;
use super::contact::{OnBeam, with_contacts};
use crate::fault::{At, Fault, Made};
use crate::kind::{Choice, Is, Kind};
use flexion::basis::Basis;
use flexion::hub_beam::load::Load;
use flexion::hub_beam::{
    self, Damping, ExactCoupling, Fields, Foreshortening, HighCoupling, Hub, HubBeam, LinearCoupling,
    Sampling,
};
use flexion::system::Fork;
use std::sync::Arc;

/// A kinematic model.
#[derive(Clone, Copy, Debug)]
pub struct Coupling {
    /// Whether one field describes the whole curve of the beam: it needs finite elements.
    pub whole_curve: bool,
    /// Assembles the system of a beam.
    pub assemble: fn(&Assembly<'_>) -> Made<Box<dyn Fork>>,
}

/// What a system is assembled of.
pub struct Assembly<'a> {
    /// Length \[m\].
    pub length: f64,
    /// The section, masses, and stations at which cells end.
    pub beam: &'a hub_beam::Beam<'a>,
    /// The hub.
    pub hub: Hub,
    /// The bases of both fields.
    pub bases: &'a Bases,
    /// What acts on the beam.
    pub loads: &'a [&'a dyn Load],
    /// What the beam may touch.
    pub contacts: &'a [OnBeam],
    /// Damping of the beam.
    pub damping: Damping,
    /// Stations that are recorded besides the tip \[m\].
    pub stations: &'a [f64],
    /// Whether axial, shear force and bending moment are recorded at the stations.
    pub section_forces: bool,
    /// Heights over the axis at which the strain is recorded at the stations \[m\].
    pub strain_heights: &'a [f64],
}

impl Assembly<'_> {
    fn fields(&self) -> Made<Fields> {
        let bases = self.bases;
        let fields = |transverse: &Arc<dyn Basis>| {
            let (axial, transverse) = (Arc::clone(&bases.axial), Arc::clone(transverse));
            Fields::new(self.length, Box::new(axial), Box::new(transverse), &self.beam.breaks)
        };
        match &bases.massless {
            Some(transverse) if self.contacts.iter().any(|of| of.contact.massless) => {
                fields(transverse).with_massless_tip().at("basis")
            }
            _ => Ok(fields(&bases.transverse)),
        }
    }

    fn linear(&self, foreshortening: Foreshortening) -> Made<Box<dyn Fork>> {
        let coupling = LinearCoupling::new(self.fields()?, self.beam, &self.hub, foreshortening);
        Ok(self.system(coupling, self.sampling()))
    }

    /// How forces in the sections are recovered from two fields.
    fn sampling(&self) -> Sampling {
        self.bases.elements.map_or(Sampling::Station, |(_, axial_degree)| Sampling::Elements(axial_degree))
    }

    /// The system under the loads and with the damping, and with the section forces and strains to be recorded.
    fn system<C: hub_beam::Coupling + Clone + 'static>(
        &self,
        coupling: C,
        sampling: Sampling,
    ) -> Box<dyn Fork> {
        let mut system = HubBeam::new(self.hub.clone(), coupling, self.stations);
        if !self.loads.is_empty() {
            system = system.with_loads(self.beam, self.loads);
        }
        system = system.with_damping(self.damping);
        if self.section_forces || !self.strain_heights.is_empty() {
            system =
                system.with_section_forces(self.beam, sampling, self.section_forces, self.strain_heights);
        }
        with_contacts(system, self.contacts)
    }
}

/// The coupling of systems in space.
pub const SPACE: &str = "space";
/// The same, all of whose beams have shear.
pub const SPACE_WITH_SHEAR: &str = "space-shear";

/// The kinds of coupling; `None` is a system in space, which is no model of a beam on a hub alone.
pub static COUPLING: Choice<Option<Coupling>> = Choice {
    name: "coupling",
    path: "model.coupling",
    summary: "kinematic model of the beam",
    kinds: &[
        Kind {
            name: "zeroth",
            summary: "no foreshortening: softens falsely and diverges at high speed, for comparison only",
            source: "the conventional model of Kane, Ryan & Banerjee 1987, doi:10.2514/3.20195",
            example: "model.coupling=zeroth",
            make: &Is(Some(Coupling {
                whole_curve: false,
                assemble: |parts| parts.linear(Foreshortening::None),
            })),
        },
        Kind {
            name: "first",
            summary: "foreshortening to first order: linear with dynamic stiffening, small deflections",
            source: "Kane, Ryan & Banerjee 1987, doi:10.2514/3.20195",
            example: "model.coupling=first",
            make: &Is(Some(Coupling {
                whole_curve: false,
                assemble: |parts| parts.linear(Foreshortening::First),
            })),
        },
        Kind {
            name: "high",
            summary: "foreshortening to every order in the kinetic energy: nonlinear, moderate deflections",
            source: "Li, Zhang & Hong 2013, Journal of Mechanical Engineering 49(13) 77–84",
            example: "model.coupling=high",
            make: &Is(Some(Coupling {
                whole_curve: false,
                assemble: |parts| {
                    let coupling = HighCoupling::new(parts.fields()?, parts.beam, &parts.hub);
                    Ok(parts.system(coupling.at("basis")?, parts.sampling()))
                },
            })),
        },
        Kind {
            name: "exact",
            summary: "geometrically exact, without shear: any deflection",
            source: "Simo & Vu-Quoc 1986, doi:10.1115/1.3171870",
            example: "model.coupling=exact",
            make: &Is(Some(Coupling {
                whole_curve: true,
                assemble: |parts| {
                    if parts.bases.elements.is_none() {
                        return Err(Fault::new("basis", "the exact coupling needs finite elements").into());
                    }
                    let nodes = parts.bases.transverse.cells().to_vec();
                    let coupling = ExactCoupling::on(nodes, parts.beam, &parts.hub);
                    Ok(parts.system(coupling.at("section")?, Sampling::Curve))
                },
            })),
        },
        Kind {
            name: SPACE,
            summary: "geometrically exact in space, without shear, of bodies, joints and beams: any motion",
            source: "Meier, Popp & Wall 2014, doi:10.1016/j.cma.2014.05.017",
            example: "model.coupling=space",
            make: &Is(None),
        },
        Kind {
            name: SPACE_WITH_SHEAR,
            summary: "the same with shear of every beam, by the shear stiffness of its section",
            source: "Simo 1985, doi:10.1016/0045-7825(85)90050-7; Crisfield & Jelenić 1999, doi:10.1098/rspa.1999.0352",
            example: "model.coupling=space-shear",
            make: &Is(None),
        },
    ],
};

/// Whether a coupling that describes the whole curve of the beam can use a basis, called `name`.
pub fn fits_whole_curve(bases: &Bases, name: &str) -> Made<()> {
    if bases.elements.is_some() {
        return Ok(());
    }
    let message = format!(
        "the exact coupling describes the whole curve of the beam by one Hermite field and cannot use the basis `{name}`"
    );
    let help = "write `kind = \"finite-elements\"` and the number of elements, or use the coupling `first`";
    Err(Fault::new("basis", message).help(help).into())
}
