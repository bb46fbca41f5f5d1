//! The nonsmooth generalized-α method.

use super::models::{Linear, steps};
use crate::integrators::multibody::{BallOnMovingWall, BallsOnWall, FourBar, GRAVITY, MasslessNode};
use flexion::integrator::{GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha};
use flexion::system::{Dynamics, Mode, Observed, State};

fn methods(rho: f64) -> [Box<dyn Integrator>; 1] {
    [Box::new(NonsmoothAlpha::decoupled(rho).unwrap())]
}

fn ball(restitution: f64, height: f64) -> (BallOnMovingWall, State) {
    let mut system = BallOnMovingWall::new(restitution);
    system.amplitude = 0.0;
    let mut start = system.initial();
    (start.q[0], start.mode[0]) = (height, Mode::Open);
    (system, start)
}

/// The first impact of a ball that falls from y₀ happens in the step that contains √(2 y₀/g), and never is there penetration.
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
            eprintln!("e {restitution} energy {energy} last {:?} {:?}", last.q, last.v);
        }
    }
}

#[test]
fn scratch() {
    for rho in [0.8] {
    for mut method in methods(rho) {
        let mut system = MasslessNode::new();
        let speed = 1.5;
        let mut start = system.initial();
        (start.q, start.v) = (vec![0.3 + system.length, 0.3], vec![-speed; 2]);
        start.mode[0] = Mode::Open;
        let half = std::f64::consts::PI * (system.mass / system.stiffness).sqrt();
        let end = 0.2 + half + 0.1;
        let exact = system.length + speed * 0.1;
        for h in [1e-3, 1e-4, 1e-5] {
            let mut least = 0.0_f64;
            let last = steps(method.as_mut(), &mut system, start.clone(), (end, end / (end / h).round()), |_, _, to| {
                least = least.min(to.q[1]);
            });
            eprintln!("massless rho {rho} h {h} {:?} {:?} exact {exact} {speed} least {least:e}", last.q, last.v);
        }
        let mut bars = FourBar::new();
        let start = bars.swung(0.8, 0.0);
        let last = steps(method.as_mut(), &mut bars, start, (1.5, 1e-3), |_, _, _| {});
        eprintln!("{:?}", last.q);
        // moving wall
        let mut system = BallOnMovingWall::new(0.7);
        let mut start = system.initial();
        (start.q[0], start.mode[0]) = (0.25, Mode::Open);
        for h in [1e-3, 1e-4, 2e-5] {
            let last = steps(method.as_mut(), &mut system, start.clone(), (0.8, h), |_, _, _| {});
            let mut mj = MoreauJean::new(0.5).unwrap();
            let mlast = steps(&mut mj, &mut system, start.clone(), (0.8, h), |_, _, _| {});
            eprintln!("wall {} {}", last.q[0], mlast.q[0]);
        }
        // two balls
        let mut system = BallsOnWall::new(0.6, [0.1, 0.25]);
        let mut start = system.initial();
        let r = system.radius;
        start.q = vec![0.0, r + 0.3, 0.0, system.length, r + 0.3, 0.0];
        start.v = vec![4.0, 0.0, 0.0, 4.0, 0.0, 0.0];
        let fall = (2.0 * GRAVITY * 0.3f64).sqrt();
        let time = fall / GRAVITY;
        let impulse = 1.6 * system.mass * fall;
        let v_x = 4.0 - 0.35 * impulse / (2.0 * system.mass);
        let exact_y = r + 0.6 * fall * 0.1 - 0.5 * GRAVITY * 0.1 * 0.1;
        for n in [1000., 8000.] {
            let last = steps(method.as_mut(), &mut system, start.clone(), (time + 0.1, (time + 0.1) / n), |_, _, _| {});
            eprintln!("balls {} for {v_x}; {:e}", last.v[0], last.q[1] - exact_y);
        }
        let mut system = BallsOnWall::new(0.0, [2.0, 2.0]);
        let mut start = system.initial();
        start.q = vec![0.0, r + 0.2, 0.0, system.length, r + 0.2, 0.0];
        start.v = vec![1.4, 0.0, 0.0, 1.4, 0.0, 0.0];
        let last = steps(method.as_mut(), &mut system, start.clone(), (0.6, 1e-3), |_, _, _| {});
        eprintln!("roll {:?} {:?} {:?}", last.v, last.q[1] - r, last.lambda);
    }
    }
    // rod: 10 in, touches 4.94e-5 leaves 1.481e-4
    for rho in [0.0, 0.5, 0.8, 1.0] {
    for (name, mut method) in [("nsga", Box::new(NonsmoothAlpha::decoupled(rho).unwrap()) as Box<dyn Integrator>), ("mj", Box::new(MoreauJean::new(0.5).unwrap()))] {
        for lumped in [false, true] {
        for c in [0.25, 1.0] {
        let n = 100;
        let mut rod = Linear::bar(n, 10.0, [3e7, 0.73e-3], lumped).with_stop(0, -0.01, 0.0);
        let mut start = rod.initial();
        start.v.fill(-202.2);
        let h = c * 0.1 / (3e7f64 / 0.73e-3).sqrt();
        let (mut first, mut last_t, mut plateau, mut count, mut least) = (0.0, 0.0, 0.0, 0.0, 0.0f64);
        let e0 = rod.energy(&start).total();
        let last = steps(method.as_mut(), &mut rod, start, ((2.2e-4 / h).round() * h, h), |_, _, to| {
            least = least.min(to.q[0] + 0.01);
            if to.lambda[0] > 0.0 { if first == 0.0 { first = to.t; } last_t = to.t; }
            if to.t > 6e-5 && to.t < 1.3e-4 { plateau += to.lambda[0]; count += 1.0; }
        });
        let p: f64 = (0..=n).map(|i| rod.mass[i].iter().zip(&last.v).map(|(m, v)| m * v).sum::<f64>()).sum();
        eprintln!("rod {name} rho {rho} lumped {lumped} c {c}: {first:e} {last_t:e} plateau {:e} mean v {} energy {} pen {least:e}", plateau / count, p / 7.3e-3, rod.energy(&last).total() / e0);
        }}
    }}
    let _ = GeneralizedAlpha::hht(0.1);
}
