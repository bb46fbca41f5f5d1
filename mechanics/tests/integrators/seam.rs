//! The five small systems through event-driven and nonsmooth drivers, against closed forms.

use super::drive::fixed;
use super::multibody::{BallOnMovingWall, BallsOnWall, FourBar, GRAVITY, HeavyTop, MasslessNode};
use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::integrator::{GeneralizedAlpha, Integrator, MoreauJean, Radau, RungeKutta, Tolerance};
use flexion::system::{Dynamics, Mode, Observed, State, System};
use flexion::verify::dynamics;

/// Observes events, and the largest imbalance of energy of the samples.
#[derive(Default)]
struct Watch {
    events: Vec<Event>,
    samples: Vec<State>,
    imbalance: f64,
}

impl Observer for Watch {
    fn wants_energy_balance(&self) -> bool {
        true
    }
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        let total = system.energy(state).total();
        let imbalance = step.balance.unwrap().imbalance(total);
        self.imbalance = self.imbalance.max(imbalance.abs());
        self.samples.push(state.clone());
    }
    fn event(&mut self, event: &Event) {
        self.events.push(event.clone());
    }
}

/// An event-driven run.
fn run(
    system: &mut dyn System,
    method: &dyn Integrator,
    mut state: State,
    end: f64,
    step: Option<f64>,
) -> (State, Watch) {
    let mut watch = Watch::default();
    let plan =
        Plan { end, step, longest_step: None, break_steps: 1, contact_step: None, sample: end / 200.0 };
    let ending = transient(system, method, &mut state, &plan, &mut watch);
    assert_eq!(ending, Ending::Finished);
    (state, watch)
}

fn radau() -> Radau {
    Radau::new(Tolerance::uniform(1e-10)).unwrap()
}

fn impacts(watch: &Watch) -> usize {
    watch.events.iter().filter(|e| matches!(e.kind, EventKind::Impact { .. })).count()
}

/// A state that is not special, with consistent rows or not.
pub fn anywhere(system: &dyn Dynamics) -> State {
    let mut s = system.initial();
    let wave = |i: usize, k: f64| (1.3 * i as f64 + k).sin();
    let d: Vec<f64> = (0..s.v.len()).map(|i| 0.4 * wave(i, 0.7)).collect();
    let q = s.q.clone();
    system.retract(&q, &d, &mut s.q);
    s.v.iter_mut().enumerate().for_each(|(i, v)| *v = wave(i, 2.1));
    s.a.iter_mut().enumerate().for_each(|(i, a)| *a = 3.0 * wave(i, 4.0));
    s.lambda.iter_mut().enumerate().for_each(|(i, x)| *x = 2.0 * wave(i, 5.0));
    s.t = 0.123;
    s
}

#[test]
fn the_five_systems_conform() {
    let systems: [Box<dyn System>; 3] =
        [Box::new(BallsOnWall::new(0.5, [0.2, 0.3])), Box::new(HeavyTop::new()), Box::new(FourBar::new())];
    for mut system in systems {
        let s = anywhere(system.as_ref());
        let mut defects = dynamics(system.as_mut(), &s);
        // Rows that do not hold at this state do work.
        defects.retain(|d| d.check != "dE/dt" || s.lambda.is_empty());
        assert!(defects.is_empty(), "{defects:?}");
    }
    let mut bars = FourBar::new();
    let s = bars.swung(0.7, 1.3);
    assert_eq!(dynamics(&mut bars, &s), []);
    let mut node = MasslessNode::new();
    let mut s = node.initial();
    (s.q, s.v, s.mode[0]) = (vec![0.5, 0.3], vec![-1.0, -1.0], Mode::Open);
    assert_eq!(dynamics(&mut node, &s), []);
    let mut ball = BallOnMovingWall::new(0.5);
    let mut s = anywhere(&ball);
    s.mode[0] = Mode::Open;
    assert_eq!(dynamics(&mut ball, &s), []);
}

/// Both balls touch at once; floor and friction at the limit, and the rod between them.
///
/// Λₙ = (1+e) m |v_y| each, Λ_t = −μ Λₙ; the rod gives both the same Δv_x = −(μ₁+μ₂) Λₙ/(2m); Δφ̇ = −R μ Λₙ/J.
#[test]
fn two_balls_strike_the_floor_at_once_with_friction() {
    let (e, friction) = (0.6, [0.1, 0.25]);
    let mut system = BallsOnWall::new(e, friction);
    let (m, r, j) = (system.mass, system.radius, system.inertia());
    let (height, speed) = (0.3, 4.0);
    let mut start = system.initial();
    start.q = vec![0.0, r + height, 0.0, system.length, r + height, 0.0];
    start.v = vec![speed, 0.0, 0.0, speed, 0.0, 0.0];
    start.mode[..4].fill(Mode::Open);
    let fall = (2.0 * GRAVITY * height).sqrt();
    let time = fall / GRAVITY;
    let impulse = (1.0 + e) * m * fall;
    let v_x = speed - (friction[0] + friction[1]) * impulse / (2.0 * m);
    let after = 0.1;
    let exact_y = r + e * fall * after - 0.5 * GRAVITY * after * after;
    let methods: [(Box<dyn Integrator>, Option<f64>); 3] = [
        (Box::new(radau()), None),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.9).unwrap()), Some(1e-3)),
        (Box::new(GeneralizedAlpha::hht(0.1).unwrap().stabilized()), Some(1e-3)),
    ];
    for (mut method, step) in methods {
        let (end, watch) = run(&mut system, method.as_mut(), start.clone(), time + after, step);
        assert_eq!(watch.events.len(), 1, "{:?}", watch.events);
        assert!((watch.events[0].time - time).abs() < 1e-9, "{} for {time}", watch.events[0].time);
        let EventKind::Impact { impulses, lost, .. } = &watch.events[0].kind else { panic!("no impact") };
        for (k, mu) in friction.into_iter().enumerate() {
            assert!((impulses[k] / impulse - 1.0).abs() < 1e-9, "{impulses:?} for {impulse}");
            assert!((impulses[2 + k] / (-mu * impulse) - 1.0).abs() < 1e-9, "{impulses:?}");
            let i = 3 * k;
            assert!((end.v[i] - v_x).abs() < 1e-8, "{} for {v_x}", end.v[i]);
            assert!((end.v[i + 2] + r * mu * impulse / j).abs() < 1e-7);
            assert!((end.q[i + 1] - exact_y).abs() < 1e-8, "{} for {exact_y}", end.q[i + 1]);
        }
        assert!(*lost > 0.0 && watch.imbalance < 1e-9, "{lost} {:e}", watch.imbalance);
    }
    let mut far = |steps: usize| {
        let method = MoreauJean::new(0.5).unwrap();
        let end = fixed(&method, &mut system, start.clone(), time + after, steps, |_, _, _, _| {}).unwrap();
        assert!((end.v[0] - v_x).abs() < 1e-2 * v_x, "{} for {v_x}", end.v[0]);
        (end.q[1] - exact_y).abs()
    };
    let (coarse, fine) = (far(1000), far(8000));
    assert!(fine < 2e-4 && coarse < 2e-3, "{coarse:e} {fine:e}");
}

/// With much friction the balls stick and roll: m Δv_x = Λ, J Δφ̇ = R Λ and v_x + R φ̇ = 0 leave v_x m R²/(m R² + J) =
/// 5/7 v_x.
#[test]
fn balls_that_stick_roll_on_with_five_sevenths_of_their_speed() {
    let mut system = BallsOnWall::new(0.0, [2.0, 2.0]);
    let r = system.radius;
    let mut start = system.initial();
    start.q = vec![0.0, r + 0.2, 0.0, system.length, r + 0.2, 0.0];
    start.v = vec![1.4, 0.0, 0.0, 1.4, 0.0, 0.0];
    start.mode[..4].fill(Mode::Open);
    let mut alpha = GeneralizedAlpha::chung_hulbert(0.8).unwrap();
    let mut methods: [(&dyn Integrator, Option<f64>); 2] = [(&mut radau(), None), (&mut alpha, Some(1e-3))];
    for (method, step) in &mut methods {
        let (end, watch) = run(&mut system, *method, start.clone(), 0.6, *step);
        assert_eq!(impacts(&watch), 1, "{:?}", watch.events);
        assert!((end.v[0] - 1.0).abs() < 1e-9 && (end.v[2] + 1.0 / r).abs() < 1e-8, "{:?}", end.v);
        assert!((end.q[1] - r).abs() < 1e-11, "{}", end.q[1] - r);
        assert!((end.lambda[0] / (system.mass * GRAVITY) - 1.0).abs() < 1e-9);
        assert!(watch.imbalance < 1e-9, "{:e}", watch.imbalance);
    }
}

/// Moreau's scheme through the driver of a run: it resolves contacts itself, and no events are looked for.
#[test]
fn the_nonsmooth_scheme_runs_under_the_driver_too() {
    let mut system = BallOnMovingWall::new(0.5);
    system.amplitude = 0.0;
    let mut start = system.initial();
    (start.q[0], start.mode[0]) = (0.1, Mode::Open);
    let method = MoreauJean::new(0.5).unwrap();
    let (last, watch) = run(&mut system, &method, start, 2.0, Some(1e-3));
    assert!(last.q[0].abs() < 1e-3 && last.v[0].abs() < 0.02, "{last:?}");
    // It tells of the impact at the end of a step at whose middle the ball touches.
    let first = watch.events.first().unwrap();
    assert!((first.time - (0.2 / GRAVITY).sqrt()).abs() <= 1.5e-3, "{first:?}");
    assert!((last.lambda[0] / GRAVITY - 1.0).abs() < 1e-6, "{:?}", last.lambda);
}

/// A ball dropped onto a plate at rest, so that it lands on the end of a step, stays there.
#[test]
fn a_ball_that_lands_at_the_end_of_a_step_stays() {
    let mut system = BallOnMovingWall::new(0.0);
    system.amplitude = 0.0;
    let mut start = system.initial();
    (start.q[0], start.mode[0]) = (0.5 * GRAVITY * 0.3 * 0.3, Mode::Open);
    let alpha = GeneralizedAlpha::chung_hulbert(0.8).unwrap();
    let (last, watch) = run(&mut system, &alpha, start, 1.0, Some(1e-3));
    assert_eq!(watch.events.len(), 1, "{:?}", watch.events);
    assert!(last.q[0].abs() < 1e-12 && last.v[0].abs() < 1e-9, "{last:?}");
}

/// A top that precesses steadily at the angle α from the vertical: I₁ Ω² cos α − I₃ ω₃ Ω + m g l = 0.
#[test]
fn the_heavy_top_precesses_at_the_order_of_each_method() {
    let mut top = HeavyTop::new();
    let [i1, _, i3] = top.inertia;
    let (alpha, spin): (f64, f64) = (0.9, 9.0);
    let (sin, cos) = alpha.sin_cos();
    let root = (i3 * i3 * spin * spin - 4.0 * i1 * cos * top.moment).sqrt();
    let precession = (i3 * spin - root) / (2.0 * i1 * cos);
    let mut start = top.initial();
    // Tilted about x: the axis is (0, −sin α, cos α); the precession along e in the body's axes, and the spin.
    start.q = vec![(0.5 * alpha).cos(), (0.5 * alpha).sin(), 0.0, 0.0];
    start.v = vec![0.0, precession * sin, spin];
    let end = 2.0;
    let angle = precession * end;
    let exact = [sin * angle.sin(), -sin * angle.cos(), cos];
    let mut error = |method: &dyn Integrator, steps| {
        let last = fixed(method, &mut top, start.clone(), end, steps, |_, _, _, _| {}).unwrap();
        let axis = HeavyTop::axis(&last.q);
        axis.iter().zip(exact).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
    };
    let mut order = |make: &dyn Fn() -> Box<dyn Integrator>, steps: usize| {
        let (coarse, fine) = (error(make().as_mut(), steps), error(make().as_mut(), 2 * steps));
        ((coarse / fine).log2(), fine)
    };
    let (alpha_order, _) = order(&|| Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), 400);
    assert!((alpha_order - 2.0).abs() < 0.2, "generalized-α: {alpha_order}");
    let (radau_order, fine) = order(&|| Box::new(Radau::new(Tolerance::uniform(1e-8)).unwrap()), 150);
    assert!(radau_order > 4.6, "radau: {radau_order} ({fine:e})");
    let (classical, _) = order(&|| Box::new(RungeKutta::new()), 100);
    assert!((classical - 4.0).abs() < 0.4, "runge-kutta: {classical}");
    // A free motion with nutation keeps energy and vertical momentum.
    let mut top = HeavyTop::new();
    let mut start = anywhere(&top);
    start.t = 0.0;
    let (energy, momentum) = (top.energy(&start).total(), top.momentum(&start));
    let (last, _) = run(&mut top, &radau(), start, 3.0, None);
    assert!((top.energy(&last).total() - energy).abs() < 1e-7);
    assert!((top.momentum(&last) - momentum).abs() < 1e-7);
}

/// A parallelogram of cranks (m, a) and a coupler (M): (⅔ m + M) a² θ̈ = −(m + M) g a sin θ, a pendulum.
#[test]
fn the_closed_four_bar_swings_like_its_pendulum() {
    let mut bars = FourBar::new();
    let (m, coupler) = (bars.density * bars.crank, bars.density * bars.coupler);
    let square = (m + coupler) * GRAVITY / ((2.0 / 3.0 * m + coupler) * bars.crank);
    // θ″ = −ω² sin θ against the pendulum by its angle, in its own time.
    let (theta, end) = (0.8, 1.5);
    let angle = {
        let mut pendulum = super::systems::Pendulum::new();
        let from = super::systems::state(&pendulum, &[theta], &[0.0]);
        let method = Radau::new(Tolerance::uniform(1e-13)).unwrap();
        fixed(&method, &mut pendulum, from, end * square.sqrt(), 800, |_, _, _, _| {}).unwrap().q[0]
    };
    let start = bars.swung(theta, 0.0);
    let exact = bars.swung(angle, 0.0);
    let methods: [(Box<dyn Integrator>, Option<f64>, f64); 4] = [
        (Box::new(radau()), None, 1e-7),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), Some(1e-3), 1e-4),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap().stabilized()), Some(1e-3), 1e-4),
        (Box::new(RungeKutta::new().with_baumgarte(20.0, 30.0)), Some(1e-3), 1e-8),
    ];
    for (mut method, step, allowed) in methods {
        let (last, watch) = run(&mut bars, method.as_mut(), start.clone(), end, step);
        for i in 0..9 {
            let far = (last.q[i] - exact.q[i]).abs();
            assert!(far < allowed, "{} {i}: {far:e}", method.info().name);
        }
        assert!(watch.imbalance < 10.0 * allowed, "{:e}", watch.imbalance);
    }
}

/// The node is stopped without an impulse, the mass then swings on the spring for half a period, and all flies back with
/// the whole energy.
#[test]
fn a_node_without_mass_meets_a_stop_and_all_energy_comes_back() {
    let mut system = MasslessNode::new();
    let speed = 1.5;
    let mut start = system.initial();
    (start.q, start.v) = (vec![0.3 + system.length, 0.3], vec![-speed; 2]);
    start.mode[0] = Mode::Open;
    let touch = 0.3 / speed;
    let half = std::f64::consts::PI * (system.mass / system.stiffness).sqrt();
    let end = touch + half + 0.1;
    let exact = system.length + speed * 0.1;
    let alpha = GeneralizedAlpha::chung_hulbert(1.0).unwrap();
    let (last, watch) = run(&mut system, &alpha, start.clone(), end, Some(1e-4));
    assert_eq!(watch.events.len(), 2, "{:?}", watch.events);
    assert!((watch.events[0].time - touch).abs() < 1e-10);
    assert!((watch.events[1].time - touch - half).abs() < 1e-6);
    assert!(
        (last.q[0] - exact).abs() < 1e-6 && (last.v[0] - speed).abs() < 1e-6,
        "{:?} {:?}",
        last.q,
        last.v
    );
    // The method's error of energy in a contact is some (hω)²/12 = 2e-6 of the whole.
    assert!(watch.imbalance < 1e-5 * 0.5 * system.mass * speed * speed, "{:e}", watch.imbalance);
    let method = MoreauJean::new(0.5).unwrap();
    let last = fixed(&method, &mut system, start, end, 20_000, |_, _, _, _| {}).unwrap();
    assert!((last.q[0] - exact).abs() < 1e-3, "{:?}", last.q);
}

/// Parabolas between bounces that are found by bisection on the plate's height; the balance closes with its work.
#[test]
fn a_ball_bounces_on_a_moving_plate_and_the_balance_counts_its_work() {
    let restitution = 0.7;
    let mut system = BallOnMovingWall::new(restitution);
    let (mut t, mut y, mut v) = (0.0, 0.25, 0.0);
    let mut bounces = Vec::new();
    let end = 0.8;
    loop {
        let height = |s: f64| y + v * (s - t) - 0.5 * GRAVITY * (s - t).powi(2) - system.wall(s)[0];
        let mut hit = t + 1e-6;
        while hit < end && height(hit) > 0.0 {
            hit += 1e-5;
        }
        if hit >= end {
            break;
        }
        let (mut low, mut high) = (hit - 1e-5, hit);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            if height(middle) > 0.0 { low = middle } else { high = middle }
        }
        let wall = system.wall(high);
        let closing = v - GRAVITY * (high - t) - wall[1];
        (t, y, v) = (high, wall[0], wall[1] - restitution * closing);
        bounces.push(high);
    }
    let exact = y + v * (end - t) - 0.5 * GRAVITY * (end - t).powi(2);
    assert!(bounces.len() >= 2, "{bounces:?}");
    let mut start = system.initial();
    (start.q[0], start.mode[0]) = (0.25, Mode::Open);
    let mut alpha = GeneralizedAlpha::chung_hulbert(0.8).unwrap();
    let mut methods: [(&dyn Integrator, Option<f64>); 2] = [(&mut radau(), None), (&mut alpha, Some(2e-3))];
    for (method, step) in &mut methods {
        let (last, watch) = run(&mut system, *method, start.clone(), end, *step);
        let times: Vec<f64> = watch.events.iter().map(|e| e.time).collect();
        assert_eq!(times.len(), bounces.len(), "{times:?} for {bounces:?}");
        assert!(times.iter().zip(&bounces).all(|(a, b)| (a - b).abs() < 1e-8), "{times:?} for {bounces:?}");
        assert!((last.q[0] - exact).abs() < 1e-8, "{} for {exact}", last.q[0]);
        assert!(watch.imbalance < 1e-9, "{:e}", watch.imbalance);
    }
    let method = MoreauJean::new(0.5).unwrap();
    let last = fixed(&method, &mut system, start, end, 40_000, |_, _, _, _| {}).unwrap();
    assert!((last.q[0] - exact).abs() < 5e-3, "{} for {exact}", last.q[0]);
}
