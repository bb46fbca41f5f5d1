//! Whether a run goes on from a checkpoint.

use super::{Checkpoint, Integrator, NotResumed, Observer, Plan, Run, State, Step, System};

/// Observes nothing; asks for the energy balance where the run does.
struct Unobserved {
    balance: bool,
}

impl Observer for Unobserved {
    fn wants_energy_balance(&self) -> bool {
        self.balance
    }

    fn sample(&mut self, _system: &mut dyn System, _state: &State, _step: &Step) {}
}

/// Whether [`resume`](super::resume) takes the checkpoint, with an energy balance if `balance`: `state` is left as it is, and nothing is
/// integrated.
///
/// # Errors
/// Those of [`resume`](super::resume) but what its observer refuses.
pub fn resumable(
    system: &mut dyn System,
    integrator: &dyn Integrator,
    from: &Checkpoint,
    state: &State,
    plan: &Plan,
    balance: bool,
) -> Result<(), NotResumed> {
    let mut state = state.clone();
    let mut run = Run::new(system, &state);
    run.resume(system, integrator, from, &mut state, plan, &mut Unobserved { balance }).map(drop)
}
