//! The models of a case: what is made of its parts.

use super::case::Case;
use super::fault::Made;
use super::kinds::coupling::Assembly;
use super::kinds::load::Load;
use flexion::blade::Blade;
use flexion::hub_beam::{Beam, load as acting};
use flexion::system::Fork;

impl Case {
    /// The mechanical system.
    ///
    /// # Errors
    /// Faults at dotted paths of the case; a case that was read has passed most checks.
    pub fn system(&self) -> Made<Box<dyn Fork>> {
        let masses = self.loads.iter().filter_map(|load| load.mass).collect();
        let loaded = self.loads.iter().flat_map(|load| load.stations.iter().copied());
        let touching = self.contacts.iter().flat_map(|contact| contact.stations.iter().copied());
        let stations: Vec<f64> = loaded.chain(touching).collect();
        let beam = Beam::new(self.section.planar.as_ref(), masses, &stations);
        let act = |load: &'_ Load| load.load.clone();
        let loads: Vec<_> = self.loads.iter().filter_map(act).collect();
        let loads: Vec<&dyn acting::Load> =
            loads.iter().map(|load| load.as_ref() as &dyn acting::Load).collect();
        let output = &self.output;
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

    /// The blade at rest: `None` if the case has no `[blade]`.
    ///
    /// # Errors
    /// Faults at dotted paths of the case.
    pub fn blade(&self) -> Made<Option<Blade>> {
        let built = self.blade.as_ref().map(|blade| blade.built(&self.section, self.hub.radius));
        built.transpose().map_err(|faults| faults.within("blade"))
    }

    /// What vibrates about a steady rotation: the blade, or the hub–beam of a case without `[blade]`, in either case without
    /// contacts.
    ///
    /// # Errors
    /// Faults at dotted paths of the case.
    pub fn vibrating(&self) -> Made<Box<dyn Fork>> {
        match self.blade()? {
            Some(blade) => Ok(Box::new(blade)),
            None => Case { contacts: Vec::new(), ..self.clone() }.system(),
        }
    }

    /// The case without the loads whose direction is fixed in space, and what they are called.
    pub fn without_loads_in_space(&self) -> (Case, Vec<&'static str>) {
        let mut names: Vec<&str> = self.loads.iter().filter_map(|load| load.fixed_in_space).collect();
        names.dedup();
        let mut case = self.clone();
        case.loads.retain(|load| load.fixed_in_space.is_none());
        (case, names)
    }
}
