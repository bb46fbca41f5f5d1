//! A burst that is open: what of it, and of the run around it, goes into a checkpoint.

use super::chatter::Bursts;
use super::contacts::Contacts;
use crate::integrator::{Checkpoint, Integration, StepControl};

/// What the lists of the method of the run are called in a checkpoint within a burst.
pub(super) const OWN: &str = "own.";

/// A burst in which a run is, and what the method of the run has left to go on with behind it.
pub(super) struct Open {
    pub(super) nonsmooth: Integration,
    pub(super) contacts: Option<Contacts>,
    pub(super) control: Option<StepControl>,
    /// Where it began, or the run was taken up in it \[s\].
    pub(super) begin: f64,
    pub(super) rubbing: bool,
    /// Halvings of the step so far.
    pub(super) halvings: u32,
}

impl Open {
    /// Adds what later steps depend on to a checkpoint, with the method of the run, `own`.
    pub(super) fn save(&self, bursts: &Bursts, own: Option<&Integration>, out: &mut Checkpoint) {
        let Open { nonsmooth, contacts, control, rubbing, halvings, .. } = self;
        let quiet = bursts.quiet.unwrap_or_default();
        let counts = [quiet, bursts.count, *halvings, u32::from(*rubbing)].map(f64::from);
        out.put("burst", &[bursts.step, bursts.longest, counts[0], counts[1], counts[2], counts[3]]);
        if let Some(contacts) = contacts {
            out.put("burst.contacts", &contacts.memory());
        }
        if let Some(control) = control {
            out.put("burst.control", &control.memory());
        }
        if let Some(own) = own {
            let mut memory = Checkpoint::default();
            own.save(&mut memory);
            out.put_all(OWN, &memory);
        }
        nonsmooth.save(out);
    }
}
