//! The nonsmooth generalized-α method against closed forms, and beside Moreau–Jean's scheme.

use super::models::{Block, Linear, rest, steps};
use crate::integrators::multibody::{BallOnMovingWall, BallsOnWall, FourBar, GRAVITY, MasslessNode};
use flexion::analysis::Violation;
use flexion::analysis::transient::{Ending, Plan, resume, transient, transient_to_checkpoint};
use flexion::integrator::{Integrator, MoreauJean, NonsmoothAlpha, Radau, Tolerance};
use flexion::linalg::Matrix;
use flexion::system::{
    Crossing, Dynamics, Events, Mode, Observed, RowWeights, Set, Size, State, Steady, VisitRow, Weights,
};

/// The decoupled scheme and the coupled one.
pub fn methods(rho: f64) -> [Box<dyn Integrator>; 2] {
    [Box::new(NonsmoothAlpha::decoupled(rho).unwrap()), Box::new(NonsmoothAlpha::coupled(rho).unwrap())]
}

pub fn ball(restitution: f64, height: f64) -> (BallOnMovingWall, State) {
    let mut system = BallOnMovingWall::new(restitution);
    system.amplitude = 0.0;
    let mut start = system.initial();
    (start.q[0], start.mode[0]) = (height, Mode::Open);
    (system, start)
}

/// The first impact of a ball that falls from y₀ happens in the step that contains √(2 y₀/g); the energy never grows, and
/// with e = 0 nothing of it is left.
#[test]
fn a_ball_bounces_without_penetration_and_never_gains_energy() {
    for mut method in methods(0.8) {
        for restitution in [0.0, 0.5, 1.0] {
            let (mut system, start) = ball(restitution, 1.0);
            let (h, fall) = (1e-3, (2.0 / GRAVITY).sqrt());
            let (mut impact, mut least, mut energy) = (f64::NAN, f64::INFINITY, GRAVITY);
            let last = steps(method.as_mut(), &mut system, start, (3.0, h), |system, _, to| {
                if to.lambda[0] > 0.0 && impact.is_nan() {
                    impact = to.t;
                }
                least = least.min(to.q[0]);
                let now = system.energy(to).total();
                assert!(now <= energy + 1e-12, "{now} after {energy} at {}", to.t);
                energy = now;
            });
            assert!((impact - fall).abs() <= h, "{impact} for {fall}");
            assert!(least >= -1e-13, "{least:e}");
            if restitution == 1.0 {
                // Each impact throws back the velocity at the start of its step and loses at most m g h v.
                let bounces = (3.0 - fall) / (2.0 * fall) + 1.0;
                let lost = bounces * GRAVITY * h * (2.0 * GRAVITY).sqrt();
                assert!(energy > GRAVITY - lost, "{energy}");
            } else {
                assert!(energy < 1e-12 && last.q[0].abs() < 1e-13 && last.v[0].abs() < 1e-12, "{last:?}");
                assert!((last.lambda[0] / GRAVITY - 1.0).abs() < 1e-12 && last.a[0].abs() < 1e-9, "{last:?}");
            }
        }
    }
}

/// A free motion is one of order 2, with joints that hold at both levels.
#[test]
fn the_order_is_two_while_nothing_strikes() {
    let mut bars = FourBar::new();
    let start = bars.swung(0.8, 0.0);
    let radau = Radau::new(Tolerance::uniform(1e-12)).unwrap();
    let exact = steps(&radau, &mut bars, start.clone(), (1.0, 1e-3), |_, _, _| {});
    for mut method in methods(0.7) {
        let mut error = |h: f64| {
            let last = steps(method.as_mut(), &mut bars, start.clone(), (1.0, h), |bars, _, to| {
                let mut g = [0.0; 8];
                for weights in [RowWeights::POSITION, RowWeights::VELOCITY] {
                    bars.constraint(to, weights, &mut g);
                    assert!(g.iter().all(|g| g.abs() < 1e-8), "{g:?}");
                }
            });
            last.q.iter().zip(&exact.q).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()))
        };
        let (coarse, fine) = (error(4e-3), error(2e-3));
        assert!(((coarse / fine).log2() - 2.0).abs() < 0.1 && fine < 1e-4, "{coarse:e} {fine:e}");
    }
}

/// See `two_balls_strike_the_floor_at_once_with_friction` for the closed forms.
#[test]
fn two_balls_slide_and_two_balls_roll() {
    let (e, friction) = (0.6, [0.1, 0.25]);
    let mut system = BallsOnWall::new(e, friction);
    let (m, r) = (system.mass, system.radius);
    let mut start = system.initial();
    start.q = vec![0.0, r + 0.3, 0.0, system.length, r + 0.3, 0.0];
    start.v = vec![4.0, 0.0, 0.0, 4.0, 0.0, 0.0];
    let fall = (2.0 * GRAVITY * 0.3).sqrt();
    let end = fall / GRAVITY + 0.1;
    let v_x = 4.0 - 0.35 * (1.0 + e) * m * fall / (2.0 * m);
    let exact_y = r + e * fall * 0.1 - 0.5 * GRAVITY * 0.01;
    for mut method in methods(0.8) {
        let mut far = |count: f64| {
            let last = steps(method.as_mut(), &mut system, start.clone(), (end, end / count), |_, _, _| {});
            [(last.v[0] - v_x).abs() / v_x, (last.q[1] - exact_y).abs()]
        };
        let ([coarse_v, coarse_y], [fine_v, fine_y]) = (far(500.0), far(8000.0));
        assert!(fine_v < 1e-5 && fine_v < 0.2 * coarse_v, "{coarse_v:e} {fine_v:e}");
        assert!(fine_y < 1e-4 && fine_y < 0.2 * coarse_y, "{coarse_y:e} {fine_y:e}");
        let mut system = BallsOnWall::new(0.0, [2.0; 2]);
        let mut start = system.initial();
        start.q = vec![0.0, r + 0.2, 0.0, system.length, r + 0.2, 0.0];
        start.v = vec![1.4, 0.0, 0.0, 1.4, 0.0, 0.0];
        let last = steps(method.as_mut(), &mut system, start, (0.6, 1e-3), |_, _, _| {});
        assert!((last.v[0] - 1.0).abs() < 1e-10 && (last.v[2] + 1.0 / r).abs() < 1e-9, "{:?}", last.v);
        assert!((last.q[1] - r).abs() < 1e-13 && (last.lambda[0] / (m * GRAVITY) - 1.0).abs() < 1e-9);
        assert_eq!(last.mode, [Mode::Closed; 5]);
    }
}

/// Half a period on the spring, and the whole speed back; the error is one of order 1.
#[test]
fn a_node_without_mass_is_stopped_and_all_energy_comes_back() {
    let mut system = MasslessNode::new();
    let speed = 1.5;
    let mut start = system.initial();
    (start.q, start.v) = (vec![0.3 + system.length, 0.3], vec![-speed; 2]);
    start.mode[0] = Mode::Open;
    let end = 0.3 + std::f64::consts::PI * (system.mass / system.stiffness).sqrt();
    let exact = system.length + speed * 0.1;
    let method = NonsmoothAlpha::decoupled(0.8).unwrap();
    let mut error = |count: f64| {
        let last = steps(&method, &mut system, start.clone(), (end, end / count), |_, _, to| {
            assert!(to.q[1] >= -1e-13);
        });
        [(last.q[0] - exact).abs(), (last.v[0] - speed).abs()]
    };
    let (coarse, fine) = (error(1000.0), error(10_000.0));
    assert!(fine[0] < 3e-4 && fine[1] < 3e-3, "{fine:?}");
    assert!(fine[0] < 0.15 * coarse[0] && fine[1] < 0.15 * coarse[1], "{coarse:?} {fine:?}");
}

/// The ball on a moving plate: both nonsmooth schemes come to the event-driven solution, this one sooner.
#[test]
fn a_ball_on_a_moving_plate_comes_to_the_event_driven_solution() {
    let mut system = BallOnMovingWall::new(0.7);
    let mut start = system.initial();
    (start.q[0], start.mode[0]) = (0.25, Mode::Open);
    let mut state = start.clone();
    let plan = Plan::new(0.8, 0.1);
    let radau = Radau::new(Tolerance::uniform(1e-10)).unwrap();
    rest(&mut system, &radau, &mut state, &plan);
    let exact = state.q[0];
    let mut error = |method: &dyn Integrator, h: f64| {
        (steps(method, &mut system, start.clone(), (0.8, h), |_, _, _| {}).q[0] - exact).abs()
    };
    let of_moreau = error(&mut MoreauJean::new(0.5).unwrap(), 1e-4);
    for mut method in methods(0.8) {
        let (coarse, fine) = (error(method.as_mut(), 1e-4), error(method.as_mut(), 1e-5));
        assert!(coarse < of_moreau && fine < 1e-5, "{coarse:e} {fine:e} {of_moreau:e}");
    }
}

/// A block on an incline of slope α: it sticks without creeping where tan α < μ, and slides by ½ g (sin α − μ cos α) t²
/// where tan α > μ. Moreau–Jean's scheme does as well.
#[test]
fn a_block_on_an_incline_sticks_and_slides() {
    let slope: f64 = 0.4;
    for mut method in methods(0.8).into_iter().chain([Box::new(MoreauJean::new(0.5).unwrap()) as _]) {
        let mut end = |friction: f64| {
            let mut block = Block::new(slope, friction);
            let start = block.initial();
            steps(method.as_mut(), &mut block, start, (1.0, 1e-3), |_, _, to| assert!(to.q[1] > -1e-13))
        };
        let sticks = end(slope.tan() + 0.05);
        assert!(sticks.q[0].abs() < 1e-12 && sticks.v[0].abs() < 1e-12, "{sticks:?}");
        assert!((sticks.lambda[1] / (GRAVITY * slope.sin()) + 1.0).abs() < 1e-10, "{sticks:?}");
        let slides = end(0.2);
        let rate = GRAVITY * (slope.sin() - 0.2 * slope.cos());
        assert!((slides.v[0] / rate - 1.0).abs() < 1e-10, "{slides:?}");
        assert!((slides.q[0] / (0.5 * rate) - 1.0).abs() < 2e-3, "{slides:?}");
    }
}

/// A point of mass 1 outside a circle of radius 1, under gravity.
struct Hill;

impl Events for Hill {}
impl Steady for Hill {}
impl Observed for Hill {}

impl Dynamics for Hill {
    fn size(&self) -> Size {
        Size { q: 2, v: 2, lambda: 1, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0; 2]
    }
    fn rows(&self) -> &[Set] {
        &[Set::Unilateral { restitution: 0.0 }]
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let radius = s.q[0].hypot(s.q[1]);
        for i in 0..2 {
            r[i] = s.a[i] - s.lambda[0] * s.q[i] / radius;
        }
        r[1] += GRAVITY;
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        let radius = s.q[0].hypot(s.q[1]);
        let dot = |x: &[f64], y: &[f64]| x[0] * y[0] + x[1] * y[1];
        let rate = dot(&s.q, &s.v) / radius;
        let second = (dot(&s.q, &s.a) + dot(&s.v, &s.v) - rate * rate) / radius;
        g[0] = c.combine(radius - 1.0, rate, second);
    }
    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        let radius = s.q[0].hypot(s.q[1]);
        visit(0, &[0, 1], &[s.q[0] / radius, s.q[1] / radius]);
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        let square = s.q[0] * s.q[0] + s.q[1] * s.q[1];
        let force = s.lambda[0] / square.sqrt();
        for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
            let unit = f64::from(u8::from(i == j));
            out.add(i, j, w.a * unit - w.q * force * (unit - s.q[i] * s.q[j] / square));
        }
    }
}

/// A point slides down a circle without friction, θ̈ = g sin θ: the direction of the force turns, and the order is 2.
#[test]
fn a_contact_that_stays_closed_on_a_curved_obstacle_is_of_order_2() {
    let (angle, end) = (0.2_f64, 0.5);
    // θ by the series of Störmer's rule with steps of 5 µs, whose error is 1e-10.
    let (mut theta, count) = ([angle, angle], 100_000);
    let step = end / f64::from(count);
    theta[1] += 0.5 * step * step * GRAVITY * angle.sin();
    for _ in 1..count {
        let next = 2.0 * theta[1] - theta[0] + step * step * GRAVITY * theta[1].sin();
        theta = [theta[1], next];
    }
    for mut method in methods(0.8) {
        let mut error = |count: f64| {
            let mut start = Hill.initial();
            start.q = vec![angle.sin(), angle.cos()];
            start.mode[0] = Mode::Open;
            let last = steps(method.as_mut(), &mut Hill, start, (end, end / count), |_, _, _| {});
            assert!((last.q[0].hypot(last.q[1]) - 1.0).abs() < 1e-12, "{last:?}");
            (last.q[0].atan2(last.q[1]) - theta[1]).abs()
        };
        let (coarse, fine) = (error(250.0), error(500.0));
        assert!(fine < 2e-6 && (3.5..4.5).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}

/// Violation of the gap at the ends of the steps of a rod that strikes a wall: rounding, where Moreau–Jean's scheme leaves
/// a part of v₀ h.
#[test]
fn a_gap_is_not_violated_at_the_end_of_any_step() {
    let mut rod = Linear::bar(40, 1.0, [1.0, 1.0], false).with_stop(0, -0.01, 0.0);
    let mut start = rod.initial();
    start.v.fill(-1.0);
    start.mode[0] = Mode::Open;
    let h = 0.007;
    let mut worst = |method: &dyn Integrator| {
        let mut least = 0.0_f64;
        steps(method, &mut rod, start.clone(), (3.0, h), |_, _, to| least = least.min(to.q[0] + 0.01));
        -least
    };
    let of_moreau = worst(&mut MoreauJean::new(0.5).unwrap());
    assert!(of_moreau > 0.05 * h && of_moreau < h, "{of_moreau:e}");
    for mut method in methods(0.8) {
        let violated = worst(method.as_mut());
        assert!(violated < 1e-14, "{violated:e}");
    }
}

/// A run that goes on from a checkpoint takes the steps of one that has not stopped.
#[test]
fn a_run_goes_on_bit_by_bit() {
    for (mut method, mut again) in methods(0.8).into_iter().zip(methods(0.8)) {
        let (mut system, mut start) = ball(0.6, 0.5);
        start.v[0] = -1.0;
        let plan = |end| Plan::new(end, 0.1).with_step(1e-3);
        let mut whole = start.clone();
        rest(&mut system, method.as_mut(), &mut whole, &plan(1.0));
        let mut half = start.clone();
        let (_, checkpoint) = transient_to_checkpoint(
            &mut system,
            again.as_mut(),
            &mut half,
            &plan(0.5),
            &mut super::models::Blind,
        );
        let mut state = system.initial();
        resume(&mut system, again.as_mut(), &checkpoint, &mut state, &plan(1.0), &mut super::models::Blind)
            .unwrap();
        assert_eq!(whole, state);
    }
}

/// What is recorded of rows: a ball at rest on a plate, and one in the air below it.
#[test]
fn violations_are_those_of_active_rows() {
    let (mut system, mut state) = ball(0.5, -2e-3);
    (state.v[0], state.a[0]) = (3.0, -5.0);
    let mut violation = Violation::new(&system);
    violation.evaluate(&mut system, &state);
    assert_eq!(violation.largest, [2e-3, 0.0, 0.0]);
    assert_eq!((violation.velocity[0], violation.acceleration[0]), (3.0, -5.0));
    state.mode[0] = Mode::Closed;
    violation.evaluate(&mut system, &state);
    assert_eq!(violation.largest, [2e-3, 3.0, 5.0]);
    let mut block = Block::new(0.3, 0.1);
    let mut state = block.initial();
    (state.v, state.mode[1]) = (vec![1.0, 0.0], Mode::SlipForward);
    let mut violation = Violation::new(&block);
    violation.evaluate(&mut block, &state);
    assert_eq!((violation.largest, violation.velocity[1]), ([0.0; 3], 1.0));
}

/// Friction in two directions, across the slope at first: it turns with the velocity and has the size μ λₙ all the time.
#[test]
fn two_rows_of_friction_are_a_disc() {
    let incline = || Block::new(0.5, 0.3).with_sideways();
    for mut method in methods(0.8).into_iter().chain([Box::new(MoreauJean::new(0.5).unwrap()) as _]) {
        let mut system = incline();
        let mut state = system.initial();
        state.v[2] = 2.0;
        steps(method.as_mut(), &mut system, state, (0.5, 1e-3), |_, _, to| {
            let size = to.lambda[1].hypot(to.lambda[2]);
            assert!((size / (0.3 * to.lambda[0]) - 1.0).abs() < 1e-9, "{size}");
            let across = to.lambda[1] * to.v[2] - to.lambda[2] * to.v[0];
            assert!(across.abs() < 1e-9 && to.lambda[2] < 0.0, "{across:e}");
        });
    }
}

/// Methods that locate events leave it to nonsmooth steps: a block that is dropped with 2 m/s across the slope strikes with the friction of its impulse, slides, and
/// comes to where v̇ = g sin α eₓ − μ g cos α v/|v| leads. Sideways speed falls towards zero and never ends.
#[test]
fn located_methods_follow_a_disc_by_nonsmooth_steps() {
    let (slope, friction, height): (f64, f64, f64) = (0.5, 0.3, 0.01);
    let [along, into] = [9.81 * slope.sin(), 9.81 * slope.cos()];
    let strikes = (2.0 * height / into).sqrt();
    // The impulse μ (1 + e) v is against the sliding velocity.
    let mut exact = [along * strikes, 2.0];
    let mut place = [0.5 * along * strikes * strikes, 2.0 * strikes];
    let size = exact[0].hypot(exact[1]);
    exact = exact.map(|v| v * (1.0 - friction * into * strikes / size));
    let rate = |v: [f64; 2]| {
        let size = v[0].hypot(v[1]);
        [along - friction * into * v[0] / size, -friction * into * v[1] / size]
    };
    let count = 100_000;
    let h = (0.5 - strikes) / f64::from(count);
    for _ in 0..count {
        // Heun's third-order rule.
        let k1 = rate(exact);
        let k2 = rate([0, 1].map(|i| exact[i] + h / 3.0 * k1[i]));
        let k3 = rate([0, 1].map(|i| exact[i] + 2.0 * h / 3.0 * k2[i]));
        for i in 0..2 {
            place[i] += h * (exact[i] + h * (k1[i] / 6.0 + k2[i] / 3.0));
            exact[i] += h * (k1[i] + 3.0 * k3[i]) / 4.0;
        }
    }
    let error = |step: f64| {
        let mut system = Block::new(slope, friction).with_sideways();
        let mut state = system.initial();
        (state.q[1], state.v[2]) = (height, 2.0);
        let radau = Radau::new(Tolerance::uniform(1e-10)).unwrap();
        let plan = Plan::new(0.5, 0.5).with_contact_step(step);
        let ending = transient(&mut system, &radau, &mut state, &plan, &mut super::models::Blind);
        assert_eq!(ending, Ending::Finished);
        assert!(state.q[1].abs() < 1e-9, "{}", state.q[1]);
        [state.v[0] - exact[0], state.v[2] - exact[1], state.q[0] - place[0], state.q[2] - place[1]]
            .into_iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    let [coarse, fine] = [1e-3, 2.5e-4].map(error);
    assert!(coarse < 1e-3 && fine < 0.3 * coarse, "{coarse:e} {fine:e}");
}

/// A ball that passes a height: the model remembers with which speed.
struct Gate {
    ball: BallOnMovingWall,
    height: f64,
}

impl Steady for Gate {}
impl Observed for Gate {}
impl Events for Gate {
    fn indicators(&self) -> usize {
        1
    }
    fn indicate(&mut self, s: &State, out: &mut [f64]) {
        out[0] = s.q[0] - self.height;
    }
    fn cross(&mut self, _fired: &[usize], s: &mut State) -> Crossing {
        s.memory[0] = s.v[0];
        Crossing::Continue
    }
}
impl Dynamics for Gate {
    fn size(&self) -> Size {
        Size { memory: 1, ..self.ball.size() }
    }
    fn scales(&self) -> &[f64] {
        self.ball.scales()
    }
    fn rows(&self) -> &[Set] {
        self.ball.rows()
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        self.ball.residual(s, r);
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        self.ball.constraint(s, c, g);
    }
    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        self.ball.jacobian(s, visit);
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        self.ball.tangent(s, w, out);
    }
}

/// Events of the model itself are located whatever resolves the contacts: at the height y the speed is √(2g(y₀ − y)).
#[test]
fn events_of_the_model_are_found_beside_contacts() {
    for mut method in methods(0.8).into_iter().chain([Box::new(MoreauJean::new(0.5).unwrap()) as _]) {
        let mut system = Gate { ball: ball(0.5, 1.0).0, height: 0.8 };
        let mut state = State::zeros(system.size(), 0.0);
        (state.q[0], state.mode[0]) = (1.0, Mode::Open);
        let plan = Plan::new(2.0, 0.5).with_step(1e-3);
        rest(&mut system, method.as_mut(), &mut state, &plan);
        // It rebounds to a quarter of the height only.
        let exact = -f64::sqrt(2.0 * GRAVITY * 0.2);
        let allowed = if method.info().order == 1 { 1e-2 } else { 1e-9 };
        assert!((state.memory[0] - exact).abs() < allowed, "{:?} for {exact}", state.memory);
        assert!(state.q[0].abs() < 1e-3 && state.v[0].abs() < 2e-2, "{state:?}");
    }
}
