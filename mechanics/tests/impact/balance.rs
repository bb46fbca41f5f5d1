//! The balance of energy of a pendulum that bounces on.
#![allow(missing_docs)]

use super::falling_pendulum::pendulum;
use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::contact::Law;
use flexion::integrator::{GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha};
use flexion::linalg::Matrix;
use flexion::system::{
    Dynamics, Energy, Events, Observed, Power, RowWeights, Set, Size, State, Steady, System, VisitRow,
    Weights,
};

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

/// Three masses in a row with dampers between them: the last strikes a stop at 1 m.
struct Dashpots {
    masses: [f64; 3],
    dampers: [f64; 2],
}

impl Dashpots {
    fn forces(&self, v: &[f64]) -> [f64; 3] {
        let [a, b] = [0, 1].map(|k| self.dampers[k] * (v[k + 1] - v[k]));
        [a, b - a, -b]
    }
}

impl Events for Dashpots {}
impl Steady for Dashpots {}

impl Dynamics for Dashpots {
    fn size(&self) -> Size {
        Size { q: 3, v: 3, lambda: 1, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0; 3]
    }
    fn rows(&self) -> &[Set] {
        &[Set::Unilateral { restitution: 0.3 }]
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let forces = self.forces(&s.v);
        (0..3).for_each(|i| r[i] = self.masses[i] * s.a[i] - forces[i]);
        r[2] += s.lambda[0];
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        g[0] = c.combine(1.0 - s.q[2], -s.v[2], -s.a[2]);
    }
    fn jacobian(&mut self, _s: &State, visit: &mut VisitRow<'_>) {
        visit(0, &[2], &[-1.0]);
    }
    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        (0..3).for_each(|i| out.add(i, i, w.a * self.masses[i]));
        for (k, c) in self.dampers.iter().enumerate() {
            for (i, j, sign) in [(k, k, 1.0), (k, k + 1, -1.0), (k + 1, k, -1.0), (k + 1, k + 1, 1.0)] {
                out.add(i, j, w.v * sign * c);
            }
        }
    }
}

impl Observed for Dashpots {
    fn energy(&mut self, s: &State) -> Energy {
        let kinetic = (0..3).map(|i| 0.5 * self.masses[i] * s.v[i] * s.v[i]).sum();
        Energy { kinetic, ..Energy::default() }
    }
    fn power(&mut self, s: &State) -> Power {
        let forces = self.forces(&s.v);
        Power { dissipated: -(0..3).map(|i| forces[i] * s.v[i]).sum::<f64>(), ..Power::default() }
    }
}

/// Dampers a hundred times stiffer than a step resolves take the motion of an impact within a step: what they take is what is missing, to rounding, whatever the
/// radius of the method.
#[test]
fn what_dampers_take_in_a_step_with_an_impact_is_what_is_missing() {
    let methods: [Box<dyn Integrator>; 6] = [
        Box::new(MoreauJean::new(0.5).unwrap()),
        Box::new(MoreauJean::new(0.8).unwrap()),
        Box::new(NonsmoothAlpha::decoupled(0.5).unwrap()),
        Box::new(NonsmoothAlpha::decoupled(1.0).unwrap()),
        Box::new(NonsmoothAlpha::coupled(0.5).unwrap()),
        Box::new(NonsmoothAlpha::coupled(1.0).unwrap()),
    ];
    for (k, mut method) in methods.into_iter().enumerate() {
        for stiff in [1e2, 1e5] {
            let mut system = Dashpots { masses: [1.0, 0.5, 0.25], dampers: [stiff, 0.3 * stiff] };
            let mut state = system.initial();
            (state.q, state.v) = (vec![0.0, 0.3, 0.7], vec![1.0, 1.2, 1.5]);
            let plan = Plan::new(0.5, 1e-3).with_step(1e-3);
            let mut balance = Balance::default();
            let ending = transient(&mut system, method.as_mut(), &mut state, &plan, &mut balance);
            assert_eq!(ending, Ending::Finished);
            assert!(balance.impacts >= 1 && balance.lost > 0.0, "{k} {stiff}");
            assert!(balance.error < 1e-12, "{k} {stiff}: {:e}", balance.error);
        }
    }
}
