//! Stability limits, dissipation, conservation, and what is said when a run breaks down.

use super::drive::fixed;
use super::systems::{CartesianPendulum, Chain, Pendulum, state, wide_chain};
use flexion::integrator::{
    Adams, Counters, GeneralizedAlpha, Integration, Integrator, Radau, RungeKutta, Span, StepError,
    Tolerance, largest_frequency,
};
use flexion::system::{Observed, State, System};

/// A chain of n equal masses and springs, free at the end: ω = 2 √(k/m) cos(π/(2n+1)).
#[test]
fn the_largest_frequency_of_a_chain_is_found_from_below_within_a_thousandth() {
    for n in [1, 2, 5, 30, 400] {
        let mut system = wide_chain(n);
        let at = state(&system, &vec![0.0; n], &vec![0.0; n]);
        let found = largest_frequency(&mut system, &at).unwrap();
        let exact = 2.0 * 1e5_f64.sqrt() * (std::f64::consts::PI / (2 * n + 1) as f64).cos();

        assert!(found <= exact * (1.0 + 1e-9) && found > exact * (1.0 - 1e-3), "{n}: {found} {exact}");
    }
}

/// On the constraint x² + y² = 1 the hanging pendulum swings at 1 rad/s and has no other frequency.
#[test]
fn the_largest_frequency_respects_constraints() {
    let mut system = CartesianPendulum::new();
    let mut at = state(&system, &[0.0, -1.0], &[0.0, 0.0]);
    GeneralizedAlpha::hht(0.1).unwrap().start(&mut system, &mut at, 0.1).unwrap();
    assert!((at.lambda[0] + 1.0).abs() < 1e-14);
    let found = largest_frequency(&mut system, &at).unwrap();
    assert!((found - 1.0).abs() < 1e-12, "{found}");
}

/// Largest |q| over the last tenth of `steps` steps of size `h` on q̈ + q = 0.
fn amplitude(method: &dyn Integrator, h: f64, steps: usize) -> f64 {
    let mut system = Chain::oscillator(1.0, 0.0);
    let mut from = state(&system, &[1.0], &[0.0]);
    // Started with a step inside the limit, so that what the step beyond it does can be seen.
    let mut method = method.start(&mut system, &mut from, 1e-3).unwrap();
    let mut to = from.clone();
    let mut largest: f64 = 0.0;
    for k in 0..steps {
        if method.step(&mut system, &from, Span::new(from.t, h), &mut to).is_err() {
            return f64::INFINITY;
        }
        method.accept(&from, &to);
        if k >= steps - steps / 10 {
            largest = largest.max(to.q[0].hypot(to.v[0]));
        }
        std::mem::swap(&mut from, &mut to);
    }
    largest
}

#[test]
fn runge_kutta_is_stable_up_to_two_root_two() {
    let limit = 8.0_f64.sqrt();
    assert!(amplitude(&RungeKutta::new(), 0.995 * limit, 10_000) < 1.0);
    assert!(amplitude(&RungeKutta::new(), 1.005 * limit, 10_000) > 1e6);
}

/// Growth by e in 10⁴ steps at hω = 0.29989, e^0.57 at 0.9 of it, e^1.7 at 1.1; e^0.1 in 10⁶ steps at the limit.
#[test]
fn adams_grows_at_every_step_and_harmlessly_at_its_limit() {
    let at = |x: f64| amplitude(&Adams::new(), x * 0.29989, 10_000).ln();
    let [below, exactly, above] = [0.9, 1.0, 1.1].map(at);
    assert!((exactly - 1.0).abs() < 0.05 && below < 0.6 && above > 1.6);
    let limit = amplitude(&Adams::new(), 0.0925, 1_000_000).ln();
    assert!((limit - 0.1).abs() < 0.02, "{limit}");
    assert!(amplitude(&Adams::new(), 0.95, 10_000) > 1e100);
}

#[test]
fn explicit_methods_refuse_a_step_beyond_the_limit_and_name_it() {
    let methods: [(Box<dyn Integrator>, f64); 2] =
        [(Box::new(RungeKutta::new()), 8.0_f64.sqrt()), (Box::new(Adams::new()), 0.0925)];
    for (method, constant) in methods {
        let mut system = Chain::oscillator(50.0, 0.0);
        let mut from = state(&system, &[1.0], &[0.0]);
        let exact = constant / 50.0;
        assert!(method.start(&mut system, &mut from, 0.99 * exact).is_ok());
        match method.start(&mut system, &mut from, exact).map(|_| ()).unwrap_err() {
            StepError::Unstable { limit, frequency, .. } => {
                assert!((frequency - 50.0).abs() < 1e-9);
                assert!(limit < exact && limit > 0.99 * exact);
            }
            other => panic!("{other}"),
        }
    }
}

#[test]
fn a_run_that_blows_up_says_when_and_where() {
    let mut system = Chain::oscillator(1.0, 0.0);
    let mut from = state(&system, &[1.0], &[0.0]);
    let method = RungeKutta::new();
    let mut method = method.start(&mut system, &mut from, 1.0).unwrap();
    let mut to = from.clone();
    let error = loop {
        match method.step(&mut system, &from, Span::new(from.t, 10.0), &mut to) {
            Ok(_) => {
                method.accept(&from, &to);
                std::mem::swap(&mut from, &mut to);
            }
            Err(error) => break error,
        }
    };
    assert!(matches!(error, StepError::NotFinite { .. }));
    assert!(error.to_string().contains("unknown 0"), "{error}");
}

#[test]
fn a_state_that_is_not_finite_is_an_error_of_every_method() {
    let methods: [Box<dyn Integrator>; 4] = [
        Box::new(GeneralizedAlpha::hht(0.05).unwrap()),
        Box::new(Radau::new(Tolerance::uniform(1e-6)).unwrap()),
        Box::new(RungeKutta::new()),
        Box::new(Adams::new()),
    ];
    for method in methods {
        for nonlinear in [false, true] {
            let mut system: Box<dyn System> =
                if nonlinear { Box::new(Pendulum::new()) } else { Box::new(Chain::oscillator(1.0, 0.0)) };
            let mut from = state(&*system, &[1.0], &[0.0]);
            let mut method = method.start(&mut *system, &mut from, 0.05).unwrap();
            from.v[0] = f64::NAN;
            let mut to = from.clone();
            let error = method.step(&mut *system, &from, Span::new(from.t, 0.05), &mut to).unwrap_err();
            assert!(matches!(error, StepError::NotFinite { .. }), "{}: {error}", method.info().name);
        }
    }
}

#[test]
fn the_trapezoidal_rule_conserves_the_energy_of_linear_systems() {
    let mut system = Chain::new(vec![1.0, 2.0, 0.5], vec![3.0, 100.0, 1e4], 0.0);
    let mut from = state(&system, &[0.1, -0.2, 0.3], &[1.0, 0.0, -1.0]);
    let method = GeneralizedAlpha::newmark(0.25, 0.5).unwrap();
    method.start(&mut system, &mut from, 0.1).unwrap();
    let before = system.energy(&from).total();
    let mut counters = Counters::default();
    let each = |run: &Integration, _: &mut dyn System, _: &State, _: &State| counters = run.counters();
    let last = fixed(&method, &mut system, from, 1000.0, 10_000, each).unwrap();
    let after = system.energy(&last).total();
    assert!((after / before - 1.0).abs() < 1e-10, "{before} {after}");
    assert_eq!(counters.factorizations, 2, "mass once, tangent once");
    assert_eq!(counters.iterations, 10_000);
}

/// At hω = 1e6 the state shrinks by ρ∞ a step (to the power of the steps, times a polynomial from the
/// double eigenvalue).
#[test]
fn the_spectral_radius_at_infinity_is_the_parameter() {
    let radius = |method: GeneralizedAlpha| {
        let mut system = Chain::oscillator(1.0, 0.0);
        let mut sizes = Vec::new();
        let from = state(&system, &[1.0], &[0.0]);
        fixed(&method, &mut system, from, 1e6 * 400.0, 400, |_, _, _, to: &State| {
            sizes.push(to.a[0].hypot(to.q[0]));
        })
        .unwrap();
        let (a, b): (f64, f64) = (sizes[199], sizes[399]);
        ((b / a).ln() / 200.0).exp()
    };
    for rho in [0.5, 0.8, 0.95] {
        let measured = radius(GeneralizedAlpha::chung_hulbert(rho).unwrap());
        // The polynomial factor, between k and k² from step 200 to 400: 2^(1/200) to 4^(1/200).
        assert!((measured / rho - 1.0).abs() < 0.0075, "ρ∞ = {rho}: {measured}");
    }
    // HHT: ρ∞ = (1 − α)/(1 + α).
    let measured = radius(GeneralizedAlpha::hht(0.25).unwrap());
    assert!((measured / 0.6 - 1.0).abs() < 0.0075, "{measured}");
    assert!((radius(GeneralizedAlpha::newmark(0.25, 0.5).unwrap()) - 1.0).abs() < 1e-6);
}

#[test]
fn radau_annihilates_what_it_cannot_follow() {
    let mut system = Chain::oscillator(1e6, 0.0);
    let mut from = state(&system, &[1.0], &[0.0]);
    let method = Radau::new(Tolerance::uniform(1e-6)).unwrap();
    let mut method = method.start(&mut system, &mut from, 1.0).unwrap();
    let mut to = from.clone();
    method.step(&mut system, &from, Span::new(from.t, 1.0), &mut to).unwrap();
    assert!(to.q[0].abs() < 1e-4, "{to:?}");
}

#[test]
fn parameters_outside_their_range_are_refused() {
    assert!(GeneralizedAlpha::newmark(0.2, 0.5).is_err());
    assert!(GeneralizedAlpha::newmark(0.25, 0.4).is_err());
    assert!(GeneralizedAlpha::hht(0.34).is_err());
    assert!(GeneralizedAlpha::hht(-0.1).is_err());
    assert!(GeneralizedAlpha::chung_hulbert(1.1).is_err());
    assert!(GeneralizedAlpha::chung_hulbert(f64::NAN).is_err());
    assert!(Radau::new(Tolerance { relative: 0.0, absolute: 0.0 }).is_err());
    let error = GeneralizedAlpha::hht(0.5).unwrap_err();
    assert_eq!(error.to_string(), "alpha = 0.5 is outside the valid range: 0 ≤ α ≤ 1/3");
}
