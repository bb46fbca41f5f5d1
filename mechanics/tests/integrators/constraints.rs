//! Constraints in every form: index 3, stabilized index 2, index 2, Baumgarte.

use super::drive::fixed;
use super::systems::{CartesianPendulum, Pendulum, state};
use flexion::integrator::{Adams, GeneralizedAlpha, Integrator, Radau, RungeKutta, StepError, Tolerance};
use flexion::system::{Dynamics, RowWeights};

/// End of the runs \[s\].
const END: f64 = 4.0;

/// The pendulum by its angle (Radau, tight): position, velocity and multiplier of the same pendulum in Cartesian
/// coordinates. a = λ q − (0, 1) and q·a = −v²: λ = y − v².
fn exact() -> [Vec<f64>; 3] {
    let mut system = Pendulum::new();
    let from = state(&system, &[1.5], &[0.2]);
    let radau = Radau::new(Tolerance::uniform(1e-13)).unwrap();
    let angle = fixed(&radau, &mut system, from, END, 400, |_, _, _, _| {}).unwrap();
    let (phi, rate): (f64, f64) = (angle.q[0], angle.v[0]);
    let q = vec![phi.sin(), -phi.cos()];
    let v = vec![rate * phi.cos(), rate * phi.sin()];
    [q, v, vec![-phi.cos() - rate * rate]]
}

/// Errors of q, v and λ at the end, and the largest |g| and |ġ| of a run in `steps` steps.
fn run(method: &dyn Integrator, steps: usize, exact: &[Vec<f64>; 3]) -> ([f64; 3], [f64; 2]) {
    let mut system = CartesianPendulum::new();
    let (s, c) = 1.5_f64.sin_cos();
    let from = state(&system, &[s, -c], &[0.2 * c, 0.2 * s]);
    let mut violation = [0.0_f64; 2];
    let last = fixed(method, &mut system, from, END, steps, |_, system, _, to| {
        for (worst, weights) in violation.iter_mut().zip([RowWeights::POSITION, RowWeights::VELOCITY]) {
            let mut g = [0.0];
            system.constraint(to, weights, &mut g);
            *worst = worst.max(g[0].abs());
        }
    })
    .unwrap();
    let far = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt();
    ([far(&last.q, &exact[0]), far(&last.v, &exact[1]), far(&last.lambda, &exact[2])], violation)
}

fn has_order(make: impl Fn() -> Box<dyn Integrator>, steps: usize, order: f64, tolerance: f64) -> [f64; 2] {
    let exact = exact();
    let (coarse, _) = run(make().as_mut(), steps, &exact);
    let (fine, violation) = run(make().as_mut(), 2 * steps, &exact);
    for (i, what) in ["q", "v", "λ"].into_iter().enumerate() {
        let found = (coarse[i] / fine[i]).log2();
        assert!(found > order - tolerance, "{what}: order {found} ({:e}, {:e})", coarse[i], fine[i]);
    }
    violation
}

#[test]
fn generalized_alpha_is_of_order_two_at_index_3_and_keeps_the_position() {
    let make = || Box::new(GeneralizedAlpha::chung_hulbert(0.6).unwrap()) as Box<dyn Integrator>;
    let [position, velocity] = has_order(make, 400, 2.0, 0.15);
    assert!(position < 1e-9 && velocity > 1e-7, "{position:e} {velocity:e}");
}

#[test]
fn the_stabilized_form_keeps_position_and_velocity_at_order_two() {
    for make in [|| GeneralizedAlpha::chung_hulbert(0.6).unwrap(), || GeneralizedAlpha::hht(0.1).unwrap()] {
        let [position, velocity] = has_order(|| Box::new(make().stabilized()), 400, 2.0, 0.15);
        assert!(position < 1e-9 && velocity < 1e-8, "{position:e} {velocity:e}");
    }
}

#[test]
fn radau_is_of_order_five_at_index_2_and_keeps_position_and_velocity() {
    let make = || Box::new(Radau::new(Tolerance::uniform(1e-9)).unwrap()) as Box<dyn Integrator>;
    let exact = exact();
    let (coarse, _) = run(make().as_mut(), 80, &exact);
    let (fine, [position, velocity]) = run(make().as_mut(), 160, &exact);
    for i in 0..2 {
        let order = (coarse[i] / fine[i]).log2();
        assert!(order > 4.5, "order {order} ({:e}, {:e})", coarse[i], fine[i]);
    }
    // λ is that of a stage: of order 3.
    let order = (coarse[2] / fine[2]).log2();
    assert!(order > 2.5, "λ: order {order} ({:e}, {:e})", coarse[2], fine[2]);
    assert!(position < 1e-12 && velocity < 1e-12, "{position:e} {velocity:e}");
}

#[test]
fn explicit_methods_take_constraints_by_baumgarte_or_refuse_them() {
    let runge_kutta = || Box::new(RungeKutta::new().with_baumgarte(10.0, 20.0)) as Box<dyn Integrator>;
    let adams = || Box::new(Adams::new().with_baumgarte(10.0, 20.0)) as Box<dyn Integrator>;
    for make in [runge_kutta, adams] {
        let [position, _] = has_order(make, 200, 4.0, 0.6);
        assert!(position < 1e-5, "{position:e}");
    }
    let methods: [Box<dyn Integrator>; 2] = [Box::new(RungeKutta::new()), Box::new(Adams::new())];
    for method in methods {
        let mut system = CartesianPendulum::new();
        let mut from = state(&system, &[1.0, 0.0], &[0.0, 0.0]);
        assert_eq!(system.size().lambda, 1);
        let error = method.start(&mut system, &mut from, 0.01).map(|_| ()).unwrap_err();
        assert!(matches!(error, StepError::Unsupported { .. }));
        assert!(error.to_string().contains("Baumgarte"), "{error}");
    }
}
