//! Contacts of a case before its run: nothing begins inside an obstacle, and masses at contacts are those of the beam.

use crate::kinds::contact::Contact;
use crate::kinds::initial::Initial;
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::contact::{ImpactMap, Law};
use flexion::system::{State, System, Touch};

/// Gap over the length of the beam below which a contact touches at the start.
const TOUCHING: f64 = 1e-11;
/// Change of an effective mass on doubling the basis that is worth a warning.
const CHANGE: f64 = 0.2;

impl Reading {
    /// Whether no contact begins inside its obstacle, or closes at the start.
    pub(super) fn check_contacts(&self, system: &mut dyn System, state: &State) -> Result<(), Problems> {
        let tolerance = TOUCHING * self.case.size();
        // An equilibrium may rest on elastic contacts.
        let at_rest = !matches!(self.case.initial, Initial::Undeformed);
        for (touch, key) in system.contacts(state).iter().zip(self.case.contact_keys()) {
            let Touch { name, row, gap, rate, .. } = touch;
            if at_rest && row.is_none() {
                continue;
            }
            if *gap < -tolerance {
                let message = format!(
                    "the contact `{name}` begins {:.3e} m inside the obstacle: move the obstacle, or turn it to the other side",
                    -gap
                );
                return Err(self.problem(&format!("{key}.obstacle"), message));
            }
            if *gap <= tolerance && *rate < 0.0 && state.t == 0.0 {
                let message = format!(
                    "the contact `{name}` touches at the start and closes with {:.3e} m/s: begin with a gap, or at rest",
                    -rate
                );
                return Err(self.problem(&format!("{key}.obstacle"), message));
            }
        }
        Ok(())
    }

    /// A warning where twice the functions have another effective mass at a contact with restitution.
    pub(super) fn effective_masses(&self, system: &mut dyn System, state: &State) -> Vec<String> {
        let rigid = |law: &Law| matches!(law, Law::Constraint { .. });
        let planar = |contact: &Contact| !contact.massless && rigid(&contact.law);
        let planar = self.case.hub_beam().is_some_and(|beam| beam.contacts.iter().any(planar));
        let space = self.case.space().filter(|space| !space.beams.is_empty());
        if !planar && !space.is_some_and(|space| space.contacts.iter().any(|contact| rigid(&contact.law))) {
            return Vec::new();
        }
        let masses = |system: &mut dyn System, state: &State| -> Option<Vec<(String, f64)>> {
            let masses = ImpactMap::new(system).masses(system, state).ok()?;
            let contacts = system.contacts(state);
            Some(contacts.into_iter().filter_map(|touch| Some((touch.name, masses[touch.row?]))).collect())
        };
        let doubled = || {
            let mut system = self.with(&self.case.finer()).ok()?.case.system().ok()?;
            let state = State { t: state.t, ..system.initial() };
            masses(system.as_mut(), &state)
        };
        let undeformed = State { t: state.t, ..system.initial() };
        let (Some(coarse), Some(fine)) = (masses(system, &undeformed), doubled()) else { return Vec::new() };
        let pairs = coarse.iter().zip(&fine).map(|((name, coarse), (_, fine))| (name, *coarse, *fine));
        let far = |(_, coarse, fine): &(&String, f64, f64)| (coarse - fine).abs() > CHANGE * coarse;
        let Some((name, coarse, fine)) = pairs.into_iter().find(far) else { return Vec::new() };
        vec![format!(
            "the effective mass at {name} is {coarse:.3e} kg and with twice the functions {fine:.3e} kg: restitution \
             here is a parameter of the mesh; the impulse of a whole burst, the next touch and heights of rebound stay \
             within a few per cent for e < 1, single impulses and energies do not"
        )]
    }
}
