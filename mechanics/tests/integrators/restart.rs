//! Runs that are ended at random times and continued from their checkpoints.

use crate::impact::falling_pendulum::pendulum;
use flexion::analysis::transient::{
    Ending, Event, Observer, Plan, Step, resume, transient, transient_to_checkpoint,
};
use flexion::contact::Law;
use flexion::integrator::{
    Adams, Checkpoint, GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha, NotResumed, Radau,
    RungeKutta, Tolerance,
};
use flexion::system::{Dynamics, State, System};
use std::ops::ControlFlow;

/// Everything that an observer sees, as bits, with its time.
#[derive(Default)]
struct Watch {
    seen: Vec<(f64, Vec<u64>)>,
    /// The run is ended by the first step that ends at this time or later.
    until: f64,
}

impl Watch {
    fn until(until: f64) -> Watch {
        Watch { seen: Vec::new(), until }
    }

    /// What is seen behind a time; events of a step are at its end but for rounding.
    fn after(&self, time: f64) -> &[(f64, Vec<u64>)] {
        &self.seen[self.seen.iter().take_while(|(t, _)| *t <= time + 1e-12).count()..]
    }
}

impl Observer for Watch {
    fn wants_energy_balance(&self) -> bool {
        true
    }
    fn sample(&mut self, _: &mut dyn System, state: &State, step: &Step) {
        let balance = step.balance.unwrap();
        let numbers = [&state.q, &state.v, &state.a, &state.lambda].into_iter().flatten();
        let all = numbers.chain([&balance.drive, &step.size]);
        self.seen.push((state.t, all.map(|x| x.to_bits()).collect()));
    }
    fn event(&mut self, event: &Event) {
        self.seen.push((event.time, event.modes.iter().map(|mode| *mode as u64).collect()));
    }
    fn step(&mut self, state: &State) -> ControlFlow<()> {
        if state.t >= self.until { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn bits(checkpoint: &Checkpoint) -> Vec<(String, Vec<u64>)> {
    let of = |(name, list): (&str, &[f64])| (name.to_owned(), list.iter().map(|x| x.to_bits()).collect());
    checkpoint.entries().map(of).collect()
}

fn pendulum_with_impacts() -> impl System + Clone {
    pendulum(1, Law::Constraint { restitution: 0.3, friction: 0.0 })
}

/// A state of its fall, shortly before the first impact.
fn falling(system: &mut dyn System) -> State {
    let radau = Radau::new(Tolerance::uniform(1e-6)).unwrap();
    let (plan, mut state) = (Plan::new(FALLING, 7e-3), system.initial());
    assert_eq!(
        transient(system, &radau, &mut state, &plan, &mut Watch::until(f64::INFINITY)),
        Ending::Finished
    );
    state
}

/// Begin and end of the runs \[s\].
const FALLING: f64 = 0.34;
const END: f64 = 0.43;

/// A pendulum falls onto a plane at 0.37 s, bounces and comes to rest on it: whenever the run is ended, in flight or in contact, it
/// is continued bit by bit, with the same steps, events, work and counts.
#[test]
fn a_run_that_is_ended_at_any_time_is_continued_bit_by_bit() {
    let alpha = || GeneralizedAlpha::chung_hulbert(0.7).unwrap();
    let methods: Vec<(Box<dyn Integrator>, Option<f64>)> = vec![
        (Box::new(Radau::new(Tolerance::uniform(1e-6)).unwrap()), None),
        (Box::new(alpha()), Some(1e-3)),
        (Box::new(alpha().stabilized()), Some(1e-3)),
        (Box::new(GeneralizedAlpha::hht(0.1).unwrap()), Some(1e-3)),
        (Box::new(GeneralizedAlpha::newmark(0.25, 0.5).unwrap()), Some(1e-3)),
        (Box::new(MoreauJean::new(0.5).unwrap()), Some(1e-3)),
        (Box::new(NonsmoothAlpha::decoupled(0.7).unwrap()), Some(1e-3)),
        (Box::new(NonsmoothAlpha::coupled(0.7).unwrap()), Some(1e-3)),
        (Box::new(RungeKutta::new().with_baumgarte(100.0, 100.0)), Some(5e-5)),
        (Box::new(Adams::new().with_baumgarte(100.0, 100.0)), Some(5e-6)),
    ];
    let original = pendulum_with_impacts();
    let start = falling(&mut original.clone());
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    for (method, step) in methods {
        let name = &method.info().name;
        let plan =
            Plan { end: END, step, longest_step: None, break_steps: 1, contact_step: None, sample: 7e-3 };
        let (mut system, mut last) = (original.clone(), start.clone());
        let mut whole = Watch::until(f64::INFINITY);
        let (ending, complete) = transient_to_checkpoint(&mut system, &*method, &mut last, &plan, &mut whole);
        assert_eq!(ending, Ending::Finished, "{name}");
        for k in 0..20 {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            // Every other time where the pendulum bounces.
            let part = (random >> 11) as f64 / (1_u64 << 53) as f64;
            let until = if k % 2 == 0 { FALLING + (END - FALLING) * part } else { 0.37 + 0.03 * part };
            let (mut system, mut state) = (original.clone(), start.clone());
            let mut first = Watch::until(until);
            let (ending, checkpoint) =
                transient_to_checkpoint(&mut system, &*method, &mut state, &plan, &mut first);
            let since = state.t;
            assert!(ending == Ending::Stopped || since == plan.end, "{name} {until}: {ending:?}");
            if ending == Ending::Finished {
                continue;
            }
            let (mut system, mut state) = (original.clone(), original.initial());
            let mut rest = Watch::until(f64::INFINITY);
            let (ending, end) =
                resume(&mut system, &*method, &checkpoint, &mut state, &plan, &mut rest).unwrap();
            assert_eq!(ending, Ending::Finished, "{name} {until}");
            assert!(whole.after(since) == rest.after(since), "{name}: {until} s, ended at {since} s");
            assert_eq!(bits(&complete), bits(&end), "{name}: {until} s");
        }
    }
}

/// What another version of the program keeps has other lists: its format is refused before any of them is read.
#[test]
fn a_checkpoint_of_another_format_is_refused() {
    let original = pendulum_with_impacts();
    let method = GeneralizedAlpha::chung_hulbert(0.7).unwrap();
    let plan = Plan::new(0.1, 7e-3).with_step(1e-3);
    let (mut system, mut state) = (original.clone(), original.initial());
    let (_, checkpoint) =
        transient_to_checkpoint(&mut system, &method, &mut state, &plan, &mut Watch::until(0.05));
    let mut go_on = |checkpoint: &Checkpoint| {
        resume(&mut system, &method, checkpoint, &mut state, &plan, &mut Watch::until(1.0))
            .map(|(ending, _)| ending)
    };
    assert_eq!(go_on(&checkpoint), Ok(Ending::Finished));
    let [needed] = checkpoint.numbers("format").unwrap();
    let mut other = checkpoint.clone();
    other.put("format", &[needed + 1.0]);
    assert_eq!(go_on(&other), Err(NotResumed::Format { found: needed + 1.0, needed }));
    let mut old = Checkpoint::default();
    checkpoint.entries().filter(|(name, _)| *name != "format").for_each(|(name, list)| old.put(name, list));
    assert_eq!(go_on(&old), Err(NotResumed::Format { found: 1.0, needed }));
}
