//! The balance of energy of a pendulum that bounces on.
#![allow(missing_docs)]

use super::falling_pendulum::pendulum;
use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::contact::Law;
use flexion::integrator::{GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha};
use flexion::system::{Dynamics, State, System};

/// Largest error of the balance over the energy of the start, and number of impacts.
#[derive(Default)]
struct Balance {
    initial: f64,
    error: f64,
    lost: f64,
    impacts: usize,
}

impl Observer for Balance {
    fn wants_energy_balance(&self) -> bool {
        true
    }

    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        let (energy, balance) = (system.energy(state).total(), step.balance.unwrap());
        (self.initial, self.lost) = (balance.initial, balance.contact);
        self.error = self.error.max(balance.imbalance(energy).abs() / balance.initial);
    }

    fn event(&mut self, event: &Event) {
        self.impacts += usize::from(matches!(event.kind, EventKind::Impact { .. }));
    }
}

/// N = 2, e = 0, the first 2 s: |E + losses − E₀| ≤ 1e-6 E₀ in the two schemes that conserve the energy of a linear vibration
/// of any frequency. (`studies/impacts`, T6, has 20 s, and the schemes that do not.)
#[test]
fn seconds_of_bouncing_keep_the_balance_of_energy_to_a_millionth() {
    let trapezium = GeneralizedAlpha::hht(0.0).unwrap().stabilized();
    let methods: [(Box<dyn Integrator>, f64); 2] =
        [(Box::new(trapezium), 2e-5), (Box::new(MoreauJean::new(0.5).unwrap()), 2e-5)];
    for (mut method, step) in methods {
        let mut system = pendulum(2, Law::Constraint { restitution: 0.0, friction: 0.0 });
        let mut state = Dynamics::initial(&system);
        let plan = Plan::new(2.0, 0.005).with_step(step);
        let mut balance = Balance::default();
        let ending = transient(&mut system, method.as_mut(), &mut state, &plan, &mut balance);
        assert_eq!(ending, Ending::Finished);
        assert!(balance.error < 1e-6, "{}: {:e}", method.info().name, balance.error);
        assert!(balance.impacts > 10 && balance.lost > 0.3 * balance.initial, "{}", balance.lost);
    }
}

/// Set-valued friction in the steps of the nonsmooth methods: what is left of the balance, through the first burst of
/// impacts with sliding and sticking, falls with the first power of the step at least.
#[test]
fn with_friction_the_balance_of_nonsmooth_steps_closes_with_the_step() {
    let methods: [fn() -> Box<dyn Integrator>; 3] = [
        || Box::new(MoreauJean::new(0.5).unwrap()),
        || Box::new(NonsmoothAlpha::decoupled(0.8).unwrap()),
        || Box::new(NonsmoothAlpha::coupled(0.8).unwrap()),
    ];
    for make in methods {
        let errors = [4e-5, 2e-5, 1e-5].map(|step| {
            let mut method = make();
            let mut system = pendulum(2, Law::Constraint { restitution: 0.0, friction: 0.3 });
            let mut state = Dynamics::initial(&system);
            let plan = Plan::new(0.45, 1e-3).with_step(step);
            let mut balance = Balance::default();
            let ending = transient(&mut system, method.as_mut(), &mut state, &plan, &mut balance);
            assert_eq!(ending, Ending::Finished);
            (balance.error, balance.lost / balance.initial)
        });
        let name = make().info().name;
        for halved in errors.windows(2) {
            assert!(halved[0].0 / halved[1].0 > 1.8, "{name}: {errors:?}");
        }
        let bound = if name == "moreau-jean" { 1e-7 } else { 1e-3 };
        assert!(errors[2].0 < bound && errors.iter().all(|(_, lost)| *lost > 0.3), "{name}: {errors:?}");
    }
}
