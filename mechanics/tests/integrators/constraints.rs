//! Index-3 constraints through the generalized-α method.

use super::drive::fixed;
use super::systems::{CartesianPendulum, Pendulum, state};
use flexion::integrator::{GeneralizedAlpha, Integrator, Radau, StepError, Tolerance};
use flexion::system::System;

/// The pendulum in Cartesian coordinates against the same pendulum by its angle (Radau, tight).
#[test]
fn generalized_alpha_is_of_order_two_under_an_index_3_constraint() {
    let end = 4.0;
    let angle = {
        let mut system = Pendulum::new();
        let from = state(&system, &[1.5], &[0.2]);
        let mut radau = Radau::new(Tolerance::uniform(1e-13)).unwrap();
        fixed(&mut radau, &mut system, from, end, 400, |_, _, _, _| {}).unwrap()
    };
    let (phi, rate): (f64, f64) = (angle.q[0], angle.v[0]);
    let exact_q = [phi.sin(), -phi.cos()];
    let exact_v = [rate * phi.cos(), rate * phi.sin()];
    // a + λ q + (0, 1) = 0 and q·a = −v²: λ = v² − y.
    let exact_lambda = rate * rate + phi.cos();
    let run = |steps| {
        let mut system = CartesianPendulum::new();
        let (s, c) = 1.5_f64.sin_cos();
        let from = state(&system, &[s, -c], &[0.2 * c, 0.2 * s]);
        let mut method = GeneralizedAlpha::chung_hulbert(0.6).unwrap();
        let mut drift: f64 = 0.0;
        let last = fixed(&mut method, &mut system, from, end, steps, |_, _, _, to| {
            drift = drift.max((to.q[0].hypot(to.q[1]) - 1.0).abs());
        })
        .unwrap();
        assert!(drift < 1e-9, "the rod's length drifts by {drift:e}");
        assert!(method.counters().iterations <= 4 * steps as u64, "{:?}", method.counters());
        let far = |x: &[f64], y: &[f64]| (x[0] - y[0]).hypot(x[1] - y[1]);
        [far(&last.q, &exact_q), far(&last.v, &exact_v), (last.lambda[0] - exact_lambda).abs()]
    };
    let (coarse, fine) = (run(400), run(800));
    for (i, what) in ["q", "v", "λ"].into_iter().enumerate() {
        let order = (coarse[i] / fine[i]).log2();

        assert!((order - 2.0).abs() < 0.15, "{what}: order {order} ({:e}, {:e})", coarse[i], fine[i]);
    }
}

#[test]
fn radau_says_that_it_cannot_take_constraints() {
    let mut system = CartesianPendulum::new();
    let mut from = state(&system, &[1.0, 0.0], &[0.0, 0.0]);
    assert_eq!(system.size().lambda, 1);
    let mut method = Radau::new(Tolerance::uniform(1e-6)).unwrap();
    let error = method.start(&mut system, &mut from, 0.0).unwrap_err();
    assert!(matches!(error, StepError::Unsupported { .. }));
    assert!(error.to_string().contains("generalized-alpha"));
}
