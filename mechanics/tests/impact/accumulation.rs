//! Impacts that accumulate: to their limit, and past it.

use super::models::Rod;
use super::nonsmooth::{ball, methods};
use crate::integrators::multibody::{BallsOnWall, GRAVITY};
use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient_to_checkpoint};
use flexion::contact::Neglected;
use flexion::exact::pendulum::rod_angle;
use flexion::integrator::{Counters, GeneralizedAlpha, Integrator, Radau, Tolerance};
use flexion::system::{Dynamics, Mode, State, System};

/// Times of impacts, and what the last sample says.
#[derive(Default)]
struct Watch {
    impacts: Vec<f64>,
    neglected: Neglected,
    imbalance: f64,
    steps: Vec<(f64, f64)>,
}

impl Observer for Watch {
    fn wants_energy_balance(&self) -> bool {
        true
    }
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        self.neglected = step.neglected;
        let imbalance = step.balance.unwrap().imbalance(system.energy(state).total());
        self.imbalance = self.imbalance.max(imbalance.abs());
        self.steps.push((state.t, step.size));
    }
    fn event(&mut self, event: &Event) {
        if matches!(event.kind, EventKind::Impact { .. }) {
            self.impacts.push(event.time);
        }
    }
}

fn run(
    system: &mut dyn System,
    method: &dyn Integrator,
    mut state: State,
    plan: &Plan,
) -> (State, Watch, Counters) {
    let mut watch = Watch::default();
    let (ending, checkpoint) = transient_to_checkpoint(system, method, &mut state, plan, &mut watch);
    assert_eq!(ending, Ending::Finished);
    (state, watch, checkpoint.counters().unwrap())
}

fn event_driven() -> [(Box<dyn Integrator>, Option<f64>); 2] {
    [
        (Box::new(Radau::new(Tolerance::uniform(1e-10)).unwrap()), None),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), Some(1e-2)),
    ]
}

/// Bounces at t₀(1 + 2e + 2e² + …) with t₀ = √(2y₀/g), which end at t₀(1 + e)/(1 − e); the bounces that are not followed
/// would have taken the time, the height and the energy that are reported.
#[test]
fn a_ball_comes_to_rest_at_the_limit_of_its_bounces() {
    let (e, height) = (0.5, 1.0);
    let first = (2.0 * height / GRAVITY).sqrt();
    let limit = first * (1.0 + e) / (1.0 - e);
    for (mut method, step) in event_driven() {
        let (mut system, start) = ball(e, height);
        let plan =
            Plan { end: 2.0, step, longest_step: None, break_steps: 1, contact_step: None, sample: 0.02 };
        let (last, watch, counters) = run(&mut system, method.as_mut(), start, &plan);
        let mut exact = first;
        for (k, time) in watch.impacts.iter().enumerate() {
            // A gap touches at 1e-13 m.
            let allowed = 1e-10 + 2e-13 / (e.powi(k as i32) * GRAVITY * first);
            assert!((time - exact).abs() < allowed, "{k}: {time} for {exact}");
            exact += 2.0 * first * e.powi(k as i32 + 1);
        }
        // e^k ≤ 1e-5 of the first speed.
        assert_eq!(watch.impacts.len(), 18);
        let end = watch.impacts[17];
        let speed = e.powi(17) * (2.0 * GRAVITY * height).sqrt();
        let Neglected { count, time, gap, energy } = watch.neglected;
        assert_eq!(count, 1);
        // The speed of the last impact is known to some 1e-3, by where it touches.
        assert!((end + time - limit).abs() < 1e-7 && time < 1e-5, "{end} + {time} for {limit}");
        assert!((gap / (e * e * speed * speed / (2.0 * GRAVITY)) - 1.0).abs() < 1e-2, "{gap:e}");
        assert!((energy / (0.5 * e * e * speed * speed) - 1.0).abs() < 1e-2, "{energy:e}");
        assert!(last.q[0].abs() < 1e-11 && last.v[0].abs() < 1e-9, "{last:?}");
        assert!((last.lambda[0] / GRAVITY - 1.0).abs() < 1e-9 && last.mode == [Mode::Closed]);
        assert!(watch.imbalance < 1e-9, "{:e}", watch.imbalance);
        // What locates events is no rejected step.
        assert!(counters.rejected <= 3, "{counters:?}");
    }
    for mut method in methods(0.8) {
        let (mut system, start) = ball(e, height);
        let plan = Plan::new(2.0, 0.02).with_step(1e-3);
        let (last, watch, _) = run(&mut system, method.as_mut(), start, &plan);
        // The losses of the impacts are counted; what is left is the error of steps in which gravity acts beside an impact.
        assert!(watch.imbalance < 5e-3 * GRAVITY * height, "{}", watch.imbalance);
        assert!(last.q[0].abs() < 1e-13 && last.v[0].abs() < 1e-12, "{last:?}");
    }
}

/// A rigid rod on the ground: it keeps its energy between impacts, so that it rises from the k-th with eᵏ ω₀ to
/// sin θₖ = L (eᵏω₀)²/(3g), and falls from there as it fell first.
#[test]
fn a_rod_comes_to_rest_at_the_limit_of_its_impacts() {
    let (e, start_angle) = (0.6_f64, std::f64::consts::FRAC_PI_4);
    let length = Rod::new(e).length;
    let fall = |from: f64| {
        let (mut low, mut high) = (0.0, 2.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if rod_angle(from, length, GRAVITY, middle) > 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    };
    let first = (3.0 * GRAVITY * start_angle.sin() / length).sqrt();
    let mut exact = vec![fall(start_angle)];
    for k in 1..40 {
        let rate = e.powi(k) * first;
        let angle = (length * rate * rate / (3.0 * GRAVITY)).asin();
        exact.push(exact.last().unwrap() + 2.0 * fall(angle));
    }
    for (mut method, step) in event_driven() {
        let mut system = Rod::new(e);
        let mut start = system.initial();
        (start.q[0], start.mode[0]) = (start_angle, Mode::Open);
        let step = step.map(|h| 0.02 * h);
        let plan =
            Plan { end: 2.0, step, longest_step: None, break_steps: 1, contact_step: None, sample: 0.02 };
        let (last, watch, _) = run(&mut system, method.as_mut(), start, &plan);
        // A gap touches at 1e-13 m, and the last impacts have some 1e-5 of the first speed.
        let allowed = if step.is_some() { 2e-7 } else { 1e-8 };
        assert!(watch.impacts.len() > 20, "{:?}", watch.impacts);
        for (time, exact) in watch.impacts.iter().zip(&exact) {
            assert!((time - exact).abs() < allowed, "{time} for {exact}");
        }
        let limit = exact.last().unwrap();
        let found = watch.impacts.last().unwrap() + watch.neglected.time;
        let allowed = allowed + 1e-2 * watch.neglected.time;
        assert!((found - limit).abs() < allowed, "{found} for {limit}");
        assert!(last.q[0].abs() < 1e-11 && last.v[0].abs() < 1e-9, "{last:?}");
        assert!((last.lambda[0] / (0.5 * system.mass * GRAVITY) - 1.0).abs() < 1e-9);
    }
}

/// Steps are short where a contact is closed or near, and those asked for elsewhere.
#[test]
fn steps_are_shorter_while_a_contact_is_closed_or_near() {
    let (mut system, start) = ball(0.0, 1.0);
    let fall = (2.0 / GRAVITY).sqrt();
    let plan = |contact_step| Plan {
        end: 0.6,
        step: Some(1e-2),
        longest_step: None,
        break_steps: 1,
        contact_step,
        sample: 1e-3,
    };
    for mut method in methods(0.8) {
        let (last, watch, short) = run(&mut system, method.as_mut(), start.clone(), &plan(Some(1e-3)));
        assert!(last.q[0].abs() < 1e-13);
        for (t, size) in &watch.steps[1..] {
            let expected = if *t < fall - 2.1e-2 {
                Some(1e-2)
            } else if *t > fall {
                Some(1e-3)
            } else {
                None
            };
            assert!(expected.is_none_or(|h| (size / h - 1.0).abs() < 1e-6), "{t}: {size}");
        }
        let (_, _, long) = run(&mut system, method.as_mut(), start.clone(), &plan(None));
        assert!(long.steps == 60 && short.steps > 180 && short.steps < 240, "{long:?} {short:?}");
    }
}

/// Balls that spin and bounce: every impact changes the sliding velocity u = v_x + Rφ̇ by Λ(1/m + R²/J), with
/// Λ = min(μ (1 + e) m eᵏv₀, m |u| · 2/7), until they roll with 5/7 of v_x.
#[test]
fn spinning_balls_bounce_with_friction() {
    let (e, friction) = (0.7, 0.05);
    let mut system = BallsOnWall::new(e, [friction; 2]);
    let (m, r, j) = (system.mass, system.radius, system.inertia());
    let height = 0.5;
    let mut start = system.initial();
    start.q = vec![0.0, r + height, 0.0, system.length, r + height, 0.0];
    start.v = vec![2.0, 0.0, 5.0, 2.0, 0.0, 5.0];
    start.mode[..4].fill(Mode::Open);
    let first = (2.0 * height / GRAVITY).sqrt();
    // Between the third impact and the fourth.
    let end = first * (1.0 + 2.0 * (e + e * e) + e.powi(3));
    let (mut v, mut spin) = (2.0, 5.0);
    for k in 0..3 {
        let slide: f64 = v + r * spin;
        let normal = (1.0 + e) * m * e.powi(k) * GRAVITY * first;
        let impulse = (friction * normal).min(slide.abs() / (1.0 / m + r * r / j)).copysign(slide);
        (v, spin) = (v - impulse / m, spin - r * impulse / j);
    }
    for (mut method, step) in event_driven() {
        let plan = Plan { end, step, longest_step: None, break_steps: 1, contact_step: None, sample: end };
        let (last, watch, _) = run(&mut system, method.as_mut(), start.clone(), &plan);
        assert_eq!(watch.impacts.len(), 3);
        assert!((last.v[0] - v).abs() < 1e-9 && (last.v[2] - spin).abs() < 1e-8, "{:?} {v} {spin}", last.v);
    }
    for mut method in methods(0.8) {
        let mut far = |count: f64| {
            let plan = Plan::new(end, end).with_step(end / count);
            let (last, _, _) = run(&mut system, method.as_mut(), start.clone(), &plan);
            (last.v[0] - v).abs().max(r * (last.v[2] - spin).abs())
        };
        let (coarse, fine) = (far(500.0), far(8000.0));
        assert!(fine < 1e-3 && fine < 0.3 * coarse, "{coarse:e} {fine:e}");
        // At the end it rolls, whatever the bounces have been: angular momentum about the ground is kept.
        let plan = Plan::new(4.0, 1.0).with_step(1e-3);
        let (last, _, _) = run(&mut system, method.as_mut(), start.clone(), &plan);
        let rolls = (m * 2.0 - j / r * 5.0) / (m + j / (r * r));
        assert!((last.v[0] - rolls).abs() < 1e-9 && (last.v[0] + r * last.v[2]).abs() < 1e-9, "{:?}", last.v);
    }
}
