//! Known breaks: every method keeps its order across them, and a jump of a prescribed velocity is an impulse.

use flexion::analysis::transient::{Ending, EventKind, Observer, Plan, Step, transient};
use flexion::integrator::{Adams, GeneralizedAlpha, Integrator, Radau, RungeKutta, Tolerance};
use flexion::linalg::Matrix;
use flexion::system::{
    Break, Dynamics, Energy, Events, Jump, Observed, Power, Size, State, Steady, System, Weights,
};

/// q̈ + ω² q = F(t) with a force F = 1 behind a time that no step meets by itself.
struct StepLoad {
    frequency: f64,
    breaks: [Break; 1],
}

impl StepLoad {
    fn new() -> StepLoad {
        StepLoad {
            frequency: 3.0,
            breaks: [Break { time: std::f64::consts::FRAC_1_PI, jump: Jump::Acceleration }],
        }
    }

    fn force(&self, s: &State) -> f64 {
        f64::from(u8::from(s.time() >= self.breaks[0].time))
    }

    /// q and q̇ at time t.
    fn exact(&self, t: f64) -> [f64; 2] {
        let (w, since) = (self.frequency, (t - self.breaks[0].time).max(0.0));
        let (sin, cos) = (w * since).sin_cos();
        [(1.0 - cos) / (w * w), sin / w]
    }
}

impl Dynamics for StepLoad {
    fn size(&self) -> Size {
        Size { q: 1, v: 1, lambda: 0, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0]
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        r[0] = s.a[0] + self.frequency.powi(2) * s.q[0] - self.force(s);
    }
    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        out.add(0, 0, w.a + w.q * self.frequency.powi(2));
    }
}

impl Events for StepLoad {
    fn breaks(&self) -> &[Break] {
        &self.breaks
    }
}

impl Steady for StepLoad {}

impl Observed for StepLoad {
    fn energy(&mut self, s: &State) -> Energy {
        let strain = 0.5 * (self.frequency * s.q[0]).powi(2);
        Energy { kinetic: 0.5 * s.v[0] * s.v[0], strain, ..Energy::default() }
    }
    fn power(&mut self, s: &State) -> Power {
        Power { loads: self.force(s) * s.v[0], ..Power::default() }
    }
}

/// Counts events, and takes the last imbalance of energy.
#[derive(Default)]
struct Watch {
    jumps: usize,
    imbalance: f64,
}

impl Observer for Watch {
    fn wants_energy_balance(&self) -> bool {
        true
    }
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        self.imbalance = step.balance.unwrap().imbalance(system.energy(state).total());
    }
    fn event(&mut self, event: &flexion::analysis::transient::Event) {
        self.jumps += usize::from(matches!(event.kind, EventKind::Jump { .. }));
    }
}

/// Error of q and q̇ at the end, and of the energy balance, of a run with steps of about `h`.
fn error(method: &dyn Integrator, h: f64) -> [f64; 2] {
    let mut system = StepLoad::new();
    let mut state = system.initial();
    let end = 2.0;
    let plan = Plan::new(end, end).with_step(h).with_longest_step(h);
    let mut watch = Watch::default();
    assert_eq!(transient(&mut system, method, &mut state, &plan, &mut watch), Ending::Finished);
    let [q, v] = system.exact(end);
    [(state.q[0] - q).abs() + (state.v[0] - v).abs(), watch.imbalance.abs()]
}

type Make = fn() -> Box<dyn Integrator>;

#[test]
fn every_method_keeps_its_order_across_a_step_load() {
    let methods: [(&str, Make, f64, f64); 4] = [
        ("newmark", || Box::new(GeneralizedAlpha::newmark(0.25, 0.5).unwrap()), 0.01, 2.0),
        ("runge-kutta", || Box::new(RungeKutta::new()), 0.02, 4.0),
        ("adams", || Box::new(Adams::new()), 0.005, 4.0),
        // Without control: the longest step is the step.
        ("radau", || Box::new(Radau::new(Tolerance::uniform(1e3)).unwrap()), 0.2, 5.0),
    ];
    for (name, make, h, order) in methods {
        let (coarse, fine) = (error(make().as_mut(), h), error(make().as_mut(), 0.5 * h));
        let found = (coarse[0] / fine[0]).log2();
        assert!(found > order - 0.4, "{name}: order {found} ({coarse:?} {fine:?})");
        assert!(fine[1] < 10.0 * fine[0] + 1e-14, "{name}: imbalance {:e} for {:e}", fine[1], fine[0]);
    }
}
