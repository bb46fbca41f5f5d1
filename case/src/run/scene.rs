//! What is drawn of a case.

use crate::case::Case;
use crate::kinds::contact::Contact;
use flexion::hub_beam::Mount;
use flexion_results::{Drawn, Part, Scene};
use std::sync::Arc;

/// Length over height of a beam drawn without knowing its height.
const SLENDERNESS: f64 = 50.0;

impl Case {
    /// Its motion in space, not yet taken. The beam is as wide as high, for a model in a plane knows no width.
    pub fn scene(&self) -> Scene {
        let contacts = self.drawn();
        let also: Vec<f64> = contacts.iter().map(|drawn| drawn.station).collect();
        let section = [self.height(); 2];
        let beam = Part::beam(("beam", 0), self.length, section, Some(self.hub.radius), &also);
        Scene::new(vec![beam], contacts, (self.duration / self.output.step) as usize)
    }

    /// Height of the beam, as it is drawn \[m\].
    pub(super) fn height(&self) -> f64 {
        self.section.height.unwrap_or(self.length / SLENDERNESS)
    }

    /// The obstacles, as they are drawn.
    pub(super) fn drawn(&self) -> Vec<Drawn> {
        let drawn = |contact: &Contact| Drawn {
            name: contact.name.clone().unwrap_or_default(),
            station: contact.stations.last().copied().unwrap_or(self.length),
            on_hub: contact.mount == Mount::Hub,
            obstacle: Arc::clone(&contact.obstacle),
        };
        self.contacts.iter().map(drawn).collect()
    }
}
