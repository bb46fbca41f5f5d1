//! The models of a case: what is made of its parts.

use super::case::{Case, Output, Subject};
use super::change::Change;
use super::fault::{Fault, Made};
use super::hub_beam::{Acting, HubBeam};
use super::kinds::basis::Bases;
use super::kinds::coupling::Assembly;
use super::kinds::initial::Initial;
use super::kinds::rotation::vibrating;
use super::layout::{BASIS, MODEL, Model};
use super::space::Space;
use super::values::{item, join};
use flexion::hub_beam::{Beam, load as acting};
use flexion::system::Fork;

impl HubBeam {
    /// The mechanical system.
    fn system(&self, output: &Output) -> Made<Box<dyn Fork>> {
        let masses = self.loads.iter().filter_map(|load| load.mass).collect();
        let loaded = self.loads.iter().flat_map(|load| load.stations.iter().copied());
        let touching = self.contacts.iter().flat_map(|of| of.points.iter().map(|(_, station, _)| *station));
        let stations: Vec<f64> = loaded.chain(touching).collect();
        let beam = Beam::new(self.section.planar.as_ref(), masses, &stations);
        let act = |load: &'_ Acting| load.load.clone();
        let loads: Vec<_> = self.loads.iter().filter_map(act).collect();
        let loads: Vec<&dyn acting::Load> =
            loads.iter().map(|load| load.as_ref() as &dyn acting::Load).collect();
        let parts = Assembly {
            length: self.length,
            beam: &beam,
            hub: self.hub.clone(),
            bases: &self.bases,
            loads: &loads,
            contacts: &self.contacts,
            damping: self.damping,
            stations: &output.stations,
            section_forces: output.section_forces,
            strain_heights: &output.strain_heights,
        };
        (self.coupling.assemble)(&parts)
    }
}

impl Case {
    /// The beam on its hub, if the case has one.
    pub fn hub_beam(&self) -> Option<&HubBeam> {
        if let Subject::HubBeam(beam) = &self.subject { Some(beam) } else { None }
    }

    /// The system in space, if the case is of one.
    pub fn space(&self) -> Option<&Space> {
        if let Subject::Space(space) = &self.subject { Some(space) } else { None }
    }

    /// Whether its run begins in static equilibrium.
    pub fn begins_in_static_equilibrium(&self) -> bool {
        matches!(self.initial, Initial::Static)
    }

    /// The mechanical system.
    ///
    /// # Errors
    /// Faults at dotted paths of the case; a case that was read has passed most checks.
    pub fn system(&self) -> Made<Box<dyn Fork>> {
        match &self.subject {
            Subject::HubBeam(beam) => beam.system(&self.output),
            Subject::Space(space) => Ok(space.system()),
        }
    }

    /// A length by which distances are measured: that of the beam, or the extent of a system in space \[m\].
    pub fn size(&self) -> f64 {
        match &self.subject {
            Subject::HubBeam(beam) => beam.length,
            Subject::Space(space) => space.size,
        }
    }

    /// The largest damping in proportion to the stiffness of its beams \[s\].
    pub fn damping_of_stiffness(&self) -> f64 {
        match &self.subject {
            Subject::HubBeam(beam) => beam.damping.stiffness,
            Subject::Space(space) => space.beams.iter().map(|(beam, _)| beam.damping[1]).fold(0.0, f64::max),
        }
    }

    /// Whether anything may touch an obstacle.
    pub fn has_contacts(&self) -> bool {
        !self.contact_keys().is_empty()
    }

    /// The key of the table of each contact, in the order of the system.
    pub(super) fn contact_keys(&self) -> Vec<String> {
        let several = match &self.subject {
            Subject::HubBeam(beam) => beam.contacts.iter().map(|of| of.points.len()).collect(),
            Subject::Space(space) => space.points.clone(),
        };
        let tables = several.into_iter().enumerate();
        tables.flat_map(|(table, points)| std::iter::repeat_n(item("contact", table), points)).collect()
    }

    /// Changes that give the case twice the functions; none for a system without a mesh.
    pub fn finer(&self) -> Vec<Change> {
        self.doubled(|bases| &bases.finer).map(|(key, count)| Change::count(key, count)).collect()
    }

    /// Changes that give the case about `factor` times the functions, rounded up.
    pub(super) fn with_functions(&self, factor: f64) -> Vec<Change> {
        let changed = |(key, doubled): (String, usize)| {
            // Between n equally spaced nodes are n − 1 spaces.
            let ends = if key.ends_with("nodes") { 1.0 } else { 0.0 };
            let count = (0.5 * factor * (doubled as f64 - ends) - 1e-9).ceil() + ends;
            Change::count(key, count as usize)
        };
        self.doubled(|bases| &bases.more).map(changed).collect()
    }

    /// Dotted paths of the numbers of functions, and twice these.
    fn doubled(&self, of: fn(&Bases) -> &[(String, usize)]) -> impl Iterator<Item = (String, usize)> {
        let doubled = match &self.subject {
            Subject::HubBeam(beam) => {
                of(&beam.bases).iter().map(|(key, n)| (join(BASIS.key.name, key), *n)).collect()
            }
            Subject::Space(space) if space.beams.is_empty() => Vec::new(),
            Subject::Space(space) => {
                vec![(join(MODEL.key.name, Model::refine.key.name), 2 * space.refine)]
            }
        };
        doubled.into_iter()
    }

    /// What vibrates: the beam on its hub or the system in space, without contacts; and what is left out of it. Where it rotates steadily, its motion is replaced by that rotation, and loads of a direction that
    /// is fixed in space are left out.
    ///
    /// # Errors
    /// Faults at dotted paths of the case.
    pub fn vibrating(&self, rotates: bool) -> Made<(Box<dyn Fork>, Vec<String>)> {
        match &self.subject {
            Subject::HubBeam(beam) => {
                let mut beam = HubBeam { contacts: Vec::new(), ..(**beam).clone() };
                let fixed = |load: &Acting| load.fixed_in_space.filter(|_| rotates);
                let mut names: Vec<String> = beam.loads.iter().filter_map(fixed).map(str::to_owned).collect();
                names.dedup();
                beam.loads.retain(|load| fixed(load).is_none());
                Ok((beam.system(&self.output)?, names))
            }
            Subject::Space(space) => {
                let Space { multibody, rotation, .. } = &**space;
                vibrating(multibody, rotation, rotates).map_err(|why| Fault::new("rotation", why).into())
            }
        }
    }
}
