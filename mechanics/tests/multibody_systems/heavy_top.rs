//! The heavy top on a spherical joint: Brüls & Cardona 2010 (doi 10.1115/1.4001370).
//!
//! m = 15 kg, J = diag(0.234375, 0.46875, 0.234375) kg·m², centre of mass at (0, 1, 0) from the fixed point in the body's
//! axes, g = 9.81 m/s² down, Ω(0) = (0, 150, −4.61538) rad/s. The reference is the same body with the fixed point as
//! its only reference: I_O Ω̇ + Ω × I_O Ω = X × Rᵀ m g, by the classical Runge–Kutta method.

use super::{GRAVITY, radau, run};
use flexion::integrator::{GeneralizedAlpha, Integrator, Span};
use flexion::linalg::Vec3;
use flexion::multibody::rotation::Quaternion;
use flexion::multibody::{Body, Kind, Model, Multibody, Part};
use flexion::system::{Dynamics, RowWeights, State};

const MASS: f64 = 15.0;
const INERTIA: [f64; 3] = [0.234375, 0.46875, 0.234375];
const SPIN: [f64; 3] = [0.0, 150.0, -4.61538];

fn top() -> Multibody {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let mut body = Body::new("top", MASS, INERTIA).at([0.0, 1.0, 0.0]);
    body.spin = Some(Vec3(SPIN));
    // Ω × X
    body.velocity = Some(Vec3([-SPIN[2], 0.0, 0.0]));
    let part = model.body(body);
    let axis = ([0.0, 0.0, 1.0], None);
    model.join("tip", Kind::Spherical, [Part::Ground, part], [0.0; 3], axis).unwrap();
    Multibody::new(model).unwrap()
}

/// Position and velocity of the centre of mass and angular velocity, body axes, at `end`, and the force at the fixed point.
fn reference(end: f64) -> ([f64; 9], [f64; 3]) {
    let about = [INERTIA[0] + MASS, INERTIA[1], INERTIA[2] + MASS];
    let rate = |p: [f64; 4], w: [f64; 3]| {
        let g = Quaternion(p).normalized().matrix().transpose() * Vec3([0.0, 0.0, -GRAVITY]);
        // X × m g with X = (0, 1, 0).
        let moment = [MASS * g[2], 0.0, -MASS * g[0]];
        let l = [0, 1, 2].map(|i| about[i] * w[i]);
        let gyro = [w[1] * l[2] - w[2] * l[1], w[2] * l[0] - w[0] * l[2], w[0] * l[1] - w[1] * l[0]];
        let dp = Quaternion(p) * Quaternion([0.0, 0.5 * w[0], 0.5 * w[1], 0.5 * w[2]]);
        (dp.0, [0, 1, 2].map(|i| (moment[i] - gyro[i]) / about[i]))
    };
    let steps = 40_000;
    let h = end / steps as f64;
    let (mut p, mut w) = ([1.0, 0.0, 0.0, 0.0], SPIN);
    let ahead = |p: [f64; 4], w: [f64; 3], k: ([f64; 4], [f64; 3]), c: f64| {
        ([0, 1, 2, 3].map(|i| p[i] + c * k.0[i]), [0, 1, 2].map(|i| w[i] + c * k.1[i]))
    };
    for _ in 0..steps {
        let k1 = rate(p, w);
        let (a, b) = ahead(p, w, k1, 0.5 * h);
        let k2 = rate(a, b);
        let (a, b) = ahead(p, w, k2, 0.5 * h);
        let k3 = rate(a, b);
        let (a, b) = ahead(p, w, k3, h);
        let k4 = rate(a, b);
        p = [0, 1, 2, 3].map(|i| p[i] + h / 6.0 * (k1.0[i] + 2.0 * k2.0[i] + 2.0 * k3.0[i] + k4.0[i]));
        w = [0, 1, 2].map(|i| w[i] + h / 6.0 * (k1.1[i] + 2.0 * k2.1[i] + 2.0 * k3.1[i] + k4.1[i]));
        p = Quaternion(p).normalized().0;
    }
    let r = Quaternion(p).matrix();
    let x = r * Vec3::AXES[1];
    let v = r * Vec3([-w[2], 0.0, w[0]]);
    let dw = rate(p, w).1;
    // ẍ = R (Ω̇ × X + Ω × (Ω × X)).
    let bend = [-dw[2] + w[0] * w[1], -(w[0] * w[0] + w[2] * w[2]), dw[0] + w[1] * w[2]];
    let a = r * Vec3(bend);
    let force = [MASS * a[0], MASS * a[1], MASS * (a[2] + GRAVITY)];
    ([x[0], x[1], x[2], v[0], v[1], v[2], w[0], w[1], w[2]], force)
}

/// Errors of position, velocity, angular velocity, and multiplier.
fn errors(method: &dyn Integrator, end: f64, steps: usize, exact: &([f64; 9], [f64; 3])) -> [f64; 4] {
    let mut system = top();
    let mut from = system.initial();
    let h = end / steps as f64;
    let mut method = method.start(&mut system, &mut from, h).unwrap();
    let mut to = from.clone();
    for _ in 0..steps {
        method.step(&mut system, &from, Span::new(from.t, h), &mut to).unwrap();
        method.accept(&from, &to);
        std::mem::swap(&mut from, &mut to);
    }
    let far = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt();
    let (of, force) = exact;
    [
        far(&from.q[..3], &of[..3]),
        far(&from.v[..3], &of[3..6]),
        far(&from.v[3..6], &of[6..]),
        far(&from.lambda, force),
    ]
}

fn orders(
    make: &dyn Fn() -> Box<dyn Integrator>,
    end: f64,
    steps: [usize; 2],
    exact: &([f64; 9], [f64; 3]),
) -> [f64; 4] {
    let [coarse, fine] = steps.map(|n| errors(make().as_mut(), end, n, exact));
    assert!(coarse.iter().chain(&fine).all(|e| e.is_finite()), "{steps:?} steps: {coarse:?}, {fine:?}");
    [0, 1, 2, 3].map(|i| (coarse[i] / fine[i]).ln() / (steps[1] as f64 / steps[0] as f64).ln())
}

#[test]
fn generalized_alpha_has_order_two_in_positions_velocities_and_forces() {
    let end = 0.25;
    let exact = reference(end);
    for stabilized in [false, true] {
        let make = || -> Box<dyn Integrator> {
            let method = GeneralizedAlpha::chung_hulbert(0.6).unwrap();
            Box::new(if stabilized { method.stabilized() } else { method })
        };
        let orders = orders(&make, end, [1000, 2000], &exact);
        println!("stabilized {stabilized}: {orders:.3?}");
        assert!(orders.iter().all(|o| (o - 2.0).abs() < 0.1), "stabilized {stabilized}: {orders:?}");
    }
}

#[test]
fn radau_has_order_five_and_three() {
    let end = 0.1;
    let exact = reference(end);
    // Finer steps show the rounding of positions that are 150 times as fast as they are large.
    let orders = orders(&|| Box::new(radau(1e-12)), end, [160, 250], &exact);
    println!("radau: {orders:.3?}");
    assert!(orders[..3].iter().all(|o| *o > 4.6), "{orders:?}");
    assert!(orders[3] > 2.7, "{orders:?}");
}

#[test]
fn the_top_keeps_its_energy_and_its_joint() {
    let mut system = top();
    let mut worst = 0.0_f64;
    let (_, imbalance) = run(&mut system, &radau(1e-9), 0.5, None, |system, s: &State| {
        let mut g = [0.0; 3];
        system.constraint(s, RowWeights::POSITION, &mut g);
        worst = g.iter().fold(worst, |m, g| m.max(g.abs()));
    });
    // Of 5.4 kJ.
    assert!(imbalance < 1e-4, "{imbalance:e}");
    assert!(worst < 1e-7, "{worst:e}");
}
