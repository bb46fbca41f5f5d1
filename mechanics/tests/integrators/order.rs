//! Orders of convergence, of the solution and of dense output.

use super::drive::fixed;
use super::systems::{Chain, Pendulum, SpringPendulum, state};
use flexion::integrator::{Adams, GeneralizedAlpha, Integrator, Radau, RungeKutta, Tolerance};
use flexion::system::{State, System};

type Make = fn() -> Box<dyn Integrator>;

const METHODS: [(&str, Make, f64, [usize; 2]); 6] = [
    ("newmark", || Box::new(GeneralizedAlpha::newmark(0.25, 0.5).unwrap()), 2.0, [200, 400]),
    ("hht", || Box::new(GeneralizedAlpha::hht(0.2).unwrap()), 2.0, [200, 400]),
    ("chung-hulbert", || Box::new(GeneralizedAlpha::chung_hulbert(0.6).unwrap()), 2.0, [200, 400]),
    ("runge-kutta-4", || Box::new(RungeKutta::new()), 4.0, [80, 160]),
    ("adams-4", || Box::new(Adams::new()), 4.0, [160, 320]),
    ("radau", || Box::new(Radau::new(Tolerance::uniform(1e-12)).unwrap()), 5.0, [32, 64]),
];

/// Largest errors of q and v at the ends of steps, and of q within them, against `exact`.
fn errors(
    make: Make,
    system: &mut dyn System,
    from: &State,
    end: f64,
    steps: usize,
    exact: &dyn Fn(f64) -> (Vec<f64>, Vec<f64>),
) -> [f64; 3] {
    let integrator = make();
    let distance = |x: &[f64], y: &[f64]| x.iter().zip(y).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
    let mut largest = [0.0_f64; 3];
    let mut inside = from.clone();
    fixed(&*integrator, system, from.clone(), end, steps, |integrator, system, from, to| {
        let (q, v) = exact(to.t);
        largest[0] = largest[0].max(distance(&to.q, &q));
        largest[1] = largest[1].max(distance(&to.v, &v));
        for part in [0.25, 0.5, 0.75] {
            let t = from.t + part * (to.t - from.t);
            integrator.interpolate(system, from, to, t, &mut inside);
            largest[2] = largest[2].max(distance(&inside.q, &exact(t).0));
        }
    })
    .unwrap();
    largest
}

fn assert_orders(
    what: &str,
    system: &mut dyn System,
    from: &State,
    end: f64,
    exact: &dyn Fn(f64) -> (Vec<f64>, Vec<f64>),
) {
    for (name, make, order, steps) in METHODS {
        let [coarse, fine] = steps.map(|n| errors(make, system, from, end, n, exact));
        for (i, quantity) in ["q", "v", "dense q"].into_iter().enumerate() {
            let measured = (coarse[i] / fine[i]).log2();
            assert!(
                (measured - order).abs() < 0.2,
                "{what}: {name} {quantity}: order {measured} from errors {:e}, {:e}",
                coarse[i],
                fine[i]
            );
        }
    }
}

/// q̈ + c q̇ + ω² q = f sin Ωt from q(0) = 1, q̇(0) = 0, in closed form.
#[test]
fn every_method_has_its_order_on_a_damped_forced_oscillator() {
    let (omega, c, f, drive): (f64, f64, f64, f64) = (1.7, 0.3, 0.8, 1.1);
    let mut system = Chain::oscillator(omega, c);
    system.force = (f, drive);
    let denominator = (omega * omega - drive * drive).powi(2) + (c * drive).powi(2);
    let (s, k) = (f * (omega * omega - drive * drive) / denominator, -f * c * drive / denominator);
    let damped = (omega * omega - 0.25 * c * c).sqrt();
    let (p, r) = (1.0 - k, (-drive * s + 0.5 * c * (1.0 - k)) / damped);
    let exact = move |t: f64| {
        let decay = (-0.5 * c * t).exp();
        let (sin, cos) = (damped * t).sin_cos();
        let free = decay * (p * cos + r * sin);
        let rate = -0.5 * c * free + decay * damped * (r * cos - p * sin);
        let (sd, cd) = (drive * t).sin_cos();
        (vec![free + s * sd + k * cd], vec![rate + drive * (s * cd - k * sd)])
    };
    let from = state(&system, &[1.0], &[0.0]);
    assert_orders("forced oscillator", &mut system, &from, 5.0, &exact);
}

/// The spring pendulum: configuration-dependent mass, gyroscopic and geometric nonlinearity. The exact
/// solution is a run of 12 800 Runge–Kutta steps, whose error is at rounding level.
#[test]
fn every_method_has_its_order_on_a_nonlinear_system() {
    let mut system = SpringPendulum::new(9.0);
    let from = state(&system, &[0.1, 1.2], &[0.0, 0.1]);
    let end = 3.0;
    let steps = 12_800;
    let mut table: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let reference = RungeKutta::new();
    table.push((from.q.clone(), from.v.clone()));
    fixed(&reference, &mut system, from.clone(), end, steps, |_, _, _, to| {
        table.push((to.q.clone(), to.v.clone()));
    })
    .unwrap();
    // Every inquiry, down to quarters of the finest step, lies on the grid of the reference.
    let exact = move |t: f64| {
        let place = t / end * steps as f64;
        assert!((place - place.round()).abs() < 1e-6, "{t} is off the grid");
        table[place.round() as usize].clone()
    };
    assert_orders("spring pendulum", &mut system, &from, end, &exact);
}

/// The period of a swing of amplitude 2 rad is known by the arithmetic–geometric mean.
#[test]
fn the_pendulum_returns_after_its_elliptic_period() {
    let mut system = Pendulum::new();
    let from = state(&system, &[2.0], &[0.0]);
    let period = Pendulum::period(2.0);
    for (name, make, _, steps) in METHODS {
        let n = 8 * steps[1];
        let integrator = make();
        let last = fixed(&*integrator, &mut system, from.clone(), period, n, |_, _, _, _| {}).unwrap();
        let (dq, dv) = ((last.q[0] - 2.0).abs(), last.v[0].abs());

        assert!(dq < 1e-6 && dv < 1e-4, "{name}: {dq:e}, {dv:e}");
    }
}

/// The quintic of Radau's dense output against its collocation polynomial, which is of degree 4 in q.
#[test]
fn dense_output_of_radau_is_as_accurate_as_its_steps() {
    let mut system = Chain::oscillator(1.0, 0.0);
    let from = state(&system, &[1.0], &[0.0]);
    let mut orders = Vec::new();
    for steps in [8, 16] {
        let integrator = Radau::new(Tolerance::uniform(1e-13)).unwrap();
        let mut worst = [0.0_f64; 3];
        let mut inside = from.clone();
        fixed(&integrator, &mut system, from.clone(), 6.0, steps, |integrator, system, from, to| {
            for k in 1..20 {
                let t = from.t + f64::from(k) / 20.0 * (to.t - from.t);
                integrator.interpolate(system, from, to, t, &mut inside);
                worst[0] = worst[0].max((inside.q[0] - t.cos()).abs());
                worst[1] = worst[1].max((inside.v[0] + t.sin()).abs());
                worst[2] = worst[2].max((inside.a[0] + t.cos()).abs());
            }
        })
        .unwrap();

        orders.push(worst);
    }
    for (i, least) in [4.8, 4.6, 3.7].into_iter().enumerate() {
        let order = (orders[0][i] / orders[1][i]).log2();
        assert!(order > least, "quantity {i}: order {order}");
    }
}
