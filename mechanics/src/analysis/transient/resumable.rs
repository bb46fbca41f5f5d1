//! Checkpoints of a run, and whether a run goes on from one.

use super::breaks::{is_fixed, jump_at, next_break};
use super::burst::open as open_contacts;
use super::chatter::Bursts;
use super::contacts::Contacts;
use super::segment::Segment;
use super::{
    Checkpoint, Integral, Integration, Integrator, NotResumed, Observer, Plan, Run, State, Step, System,
};

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

impl Run {
    /// Takes up a run where a checkpoint was made.
    pub(super) fn resume(
        &mut self,
        system: &mut dyn System,
        integrator: &dyn Integrator,
        from: &Checkpoint,
        state: &mut State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) -> Result<Integration, NotResumed> {
        from.check_format()?;
        from.check_numbers()?;
        from.fill_state("", state)?;
        let [origin, samples, begins, open] = from.finite("run")?;
        let open = open != 0.0;
        if !(origin <= state.t && samples >= 0.0) {
            return Err(NotResumed::Invalid("run".to_owned()));
        }
        (self.origin, self.samples, self.begins) = (origin, samples as u64, begins != 0.0);
        self.bursts = Bursts::recall(from.numbers("bursts")?);
        let [size, iterations] = from.finite("last")?;
        self.last = Step { size, iterations: iterations as u32, ..Step::default() };
        let [sample] = from.finite("sample")?;
        if sample != plan.sample {
            let before = (state.t - origin) / plan.sample;
            self.samples = (before + 1e-9).floor().max(0.0) as u64 + 1;
        }
        if let Some(asked) = plan.step.filter(|_| !open && is_fixed(integrator.info())) {
            let segment = from.finite("segment")?;
            let stop = next_break(system, integrator.info(), state.t, plan.end);
            let recalled = if jump_at(system, integrator.info(), state.t).is_some() {
                // The run ended at a break: behind it begins another segment.
                Ok((Segment::new(state.t, stop, asked), state.t))
            } else {
                Segment::recall(segment, stop, asked)
            };
            // Of a segment that began later, as behind a burst, what is left is divided anew.
            let recalled = match recalled {
                Err(_) if segment[0] > origin => Ok((Segment::new(state.t, stop, asked), state.t)),
                recalled => recalled,
            };
            let (segment, at) = recalled.map_err(|[before, now]| {
                NotResumed::Failed(format!(
                    "the run was made with steps of {before} s, and until {} s steps would be {now} s: give the step \
                     and a duration that is a multiple of it",
                    plan.end
                ))
            })?;
            // Where the run ended inside a step, that step goes on.
            if (state.t - at).abs() <= 1e-9 * segment.step {
                state.t = at;
            }
            self.segment = Some(segment);
        }
        if integrator.resolves_contacts() {
            self.contacts = self.contacts.take().and_then(Contacts::of_indicators);
        }
        let step = self.segment.map(|segment| segment.step).or(plan.step).unwrap_or(plan.end - origin);
        let mut start = state.clone();
        if open {
            // Of more contacts than motions the method of the run knows no forces.
            open_contacts(system, &mut start);
        }
        let started = integrator.start(system, &mut start, step);
        let mut integration = started.map_err(|error| NotResumed::Failed(error.to_string()))?;
        self.set_control(system, integrator.info(), state, plan);
        if let Some(control) = self.control.as_mut().filter(|_| !open) {
            let memory: [f64; 4] = from.numbers("control")?;
            if !(memory[0] > 0.0 && memory[0].is_finite()) {
                return Err(NotResumed::Invalid("control".to_owned()));
            }
            control.recall(memory);
        }
        if let Some(contacts) = self.contacts.as_mut().filter(|_| !open) {
            contacts.recall(from.numbers("contacts")?);
        }
        if observer.wants_energy_balance() {
            let mut balance = Integral::new(system, state);
            balance.recall(from)?;
            self.balance = Some(balance);
        }
        if open {
            self.reopen(system, &mut integration, from, state, plan)?;
        } else {
            integration.resume(system, from)?;
        }
        observer.begin(open || integrator.resolves_contacts());
        observer.resume(from)?;
        Ok(integration)
    }

    /// What [`Run::resume`] needs.
    pub(super) fn checkpoint(
        &self,
        integration: Option<&Integration>,
        state: &State,
        sample: f64,
        observer: &dyn Observer,
    ) -> Checkpoint {
        let mut out = Checkpoint::of_this_format();
        out.put_state("", state);
        let [begins, open] = [self.begins, self.open.is_some()].map(|flag| f64::from(u8::from(flag)));
        out.put("run", &[self.origin, self.samples as f64, begins, open]);
        out.put("bursts", &self.bursts.memory());
        out.put("sample", &[sample]);
        out.put("last", &[self.last.size, f64::from(self.last.iterations)]);
        if let Some(segment) = &self.segment {
            out.put("segment", &segment.memory());
        }
        if let Some(control) = &self.control {
            out.put("control", &control.memory());
        }
        if let Some(contacts) = &self.contacts {
            out.put("contacts", &contacts.memory());
        }
        if let Some(balance) = &self.balance {
            balance.save(&mut out);
        }
        match (&self.open, integration) {
            (Some(open), own) => open.save(&self.bursts, own, &mut out),
            (None, Some(integration)) => integration.save(&mut out),
            (None, None) => {}
        }
        observer.save(&mut out);
        out
    }
}
