//! Energy and momentum of the state that was last asked for: the energy balance and the recorded row of a step ask for the same.

use super::inertia::Totals;
use crate::profile::HubKinematics;
use crate::system::State;

/// Totals and strain energy \[J\] of one state. Its memory is taken when a state is kept first; a clone has none.
#[derive(Debug, Default)]
pub(super) struct Measured {
    hub: HubKinematics,
    state: [Vec<f64>; 3],
    totals: Totals,
    strain: f64,
}

impl Clone for Measured {
    fn clone(&self) -> Measured {
        Measured::default()
    }
}

impl Measured {
    /// What was found for this state, if it was the last.
    pub(super) fn of(&self, s: &State, hub: &HubKinematics) -> Option<(Totals, f64)> {
        let [q, v, a] = &self.state;
        let same = !q.is_empty() && self.hub == *hub && *q == s.q && *v == s.v && *a == s.a;
        same.then_some((self.totals, self.strain))
    }

    /// Keeps what was found for this state.
    pub(super) fn keep(&mut self, s: &State, hub: &HubKinematics, (totals, strain): (Totals, f64)) {
        self.hub = *hub;
        for (kept, of) in self.state.iter_mut().zip([&s.q, &s.v, &s.a]) {
            kept.clone_from(of);
        }
        (self.totals, self.strain) = (totals, strain);
    }
}
