//! Adaptive runs: tolerance proportionality, stiffness, work, reproducibility.

use super::drive::adaptive;
use super::systems::{Chain, Pendulum, SpringPendulum, TwoFrequencies, state, wide_chain};
use flexion::integrator::{
    Counters, GeneralizedAlpha, Integration, Integrator, NonsmoothAlpha, Radau, Span, Tolerance,
};
use flexion::system::{State, System};

fn run(system: &mut dyn System, from: &State, end: f64, tolerance: f64) -> (State, Counters) {
    let method = Radau::new(Tolerance::uniform(tolerance)).unwrap();
    let mut counters = Counters::default();
    let each = |run: &Integration, _: &mut dyn System, _: &State, _: &State| counters = run.counters();
    let last = adaptive(&method, system, from.clone(), end, tolerance, each).unwrap();
    (last, counters)
}

#[test]
fn the_error_is_in_proportion_to_the_tolerance() {
    let period = Pendulum::period(2.0);
    let mut points = Vec::new();
    for tolerance in [1e-4, 1e-6, 1e-8, 1e-10] {
        let mut system = Pendulum::new();
        let from = state(&system, &[2.0], &[0.0]);
        let (last, counters) = run(&mut system, &from, 4.0 * period, tolerance);
        let error = (last.q[0] - 2.0).hypot(last.v[0]);

        assert!(error < 100.0 * tolerance, "tolerance {tolerance:e}: error {error:e}");
        points.push((error, counters.steps));
    }
    for pair in points.windows(2) {
        let slope = (pair[0].0 / pair[1].0).log10() / 2.0;
        assert!((0.5..2.0).contains(&slope), "slope {slope}");
        // Error per step of order 4: a hundredth of the tolerance costs 100^(1/4) = 3.2 times the steps.
        let growth = pair[1].1 as f64 / pair[0].1 as f64;
        assert!((1.5..4.5).contains(&growth), "growth {growth}");
    }
}

/// q̈ + ω²(q − cos t) = 0 started on its smooth solution cos t·ω²/(ω² − 1): ω does not matter.
#[test]
fn a_stiff_oscillator_on_its_smooth_solution_costs_as_much_as_a_soft_one() {
    let steps = [30.0, 1e4, 1e6].map(|fast: f64| {
        let mut system = TwoFrequencies::new(fast, 0.0);
        let smooth = fast * fast / (fast * fast - 1.0);
        let from = state(&system, &[smooth, 1.0], &[0.0, 0.0]);
        let (last, counters) = run(&mut system, &from, 10.0, 1e-7);
        let error = (last.q[0] - smooth * 10.0_f64.cos()).abs().max((last.q[1] - 10.0_f64.cos()).abs());

        assert!(error < 1e-5, "ω = {fast}: {error:e}");
        counters.steps + counters.rejected
    });
    assert!(steps[1] <= steps[0] * 2 && steps[2] <= steps[0] * 2, "{steps:?}");
}

/// The same disturbed: the fast oscillation is not resolved for ever but dies, and the slow part stays
/// accurate.
#[test]
fn a_fast_oscillation_of_small_amplitude_dies_and_leaves_the_slow_one_alone() {
    let fast = 1e4;
    let mut system = TwoFrequencies::new(fast, 0.0);
    let from = state(&system, &[1.0 + 1e-5, 1.0], &[0.0, 0.0]);
    let (last, counters) = run(&mut system, &from, 10.0, 1e-6);
    assert!((last.q[1] - 10.0_f64.cos()).abs() < 1e-4);
    assert!(counters.steps < 5_000, "{counters:?}");
}

/// A stiff spring makes the constraint force; the slow swing must not notice.
#[test]
fn a_stiff_spring_pendulum_swings_like_a_rigid_one() {
    let mut system = SpringPendulum::new(1e8);
    let from = state(&system, &[1.0_f64.cos() / 1e8, 1.0], &[0.0, 0.0]);
    let period = Pendulum::period(1.0);
    let (last, counters) = run(&mut system, &from, period, 1e-8);
    assert!((last.q[1] - 1.0).abs() < 1e-6, "{last:?}");
    assert!(counters.steps < 400, "{counters:?}");
}

#[test]
fn constant_matrices_are_factored_only_when_the_step_changes() {
    let mut system = Chain::oscillator(1.0, 0.0);
    let from = state(&system, &[1.0], &[0.0]);
    let (last, counters) = run(&mut system, &from, 100.0, 1e-8);
    assert!((last.q[0] - 100.0_f64.cos()).abs() < 1e-5);
    assert!(counters.factorizations < counters.steps / 4, "{counters:?}");
    assert!(10 * counters.iterations < 14 * (counters.steps + counters.rejected), "{counters:?}");
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let once = || {
        let mut system = SpringPendulum::new(50.0);
        let from = state(&system, &[0.1, 1.0], &[0.0, 0.0]);
        let (last, counters) = run(&mut system, &from, 10.0, 1e-7);
        let bits: Vec<u64> = last.q.iter().chain(&last.v).chain(&last.a).map(|x| x.to_bits()).collect();
        (bits, counters)
    };
    assert_eq!(once(), once());
}

/// A rejected attempt leaves no trace: stepping with a wasted attempt in between ends at the same bits.
#[test]
fn a_rejected_attempt_leaves_no_trace_in_the_history() {
    let mut ends = Vec::new();
    for waste in [false, true] {
        let mut system = wide_chain(6);
        let mut from = state(&system, &[0.01; 6], &[0.0; 6]);
        let method = flexion::integrator::GeneralizedAlpha::chung_hulbert(0.7).unwrap();
        let mut method = method.start(&mut system, &mut from, 1e-3).unwrap();
        let mut to = from.clone();
        for _ in 0..50 {
            if waste {
                method.step(&mut system, &from, Span::new(from.t, 3e-3), &mut to).unwrap();
            }
            method.step(&mut system, &from, Span::new(from.t, 1e-3), &mut to).unwrap();
            method.accept(&from, &to);
            std::mem::swap(&mut from, &mut to);
        }
        assert_eq!(method.counters().rejected, if waste { 50 } else { 0 });
        ends.push(from);
    }
    assert_eq!(ends[0], ends[1]);
}

/// Steps of h, h/2, 3h/2, again and again: the order of the methods whose auxiliary acceleration lags stays 2.
#[test]
fn steps_that_change_their_size_keep_the_order_of_generalized_alpha() {
    let mut system = SpringPendulum::new(9.0);
    let start = state(&system, &[0.1, 1.2], &[0.0, 0.0]);
    let (exact, _) = run(&mut system, &start, 2.0, 1e-12);
    let methods: [&dyn Fn() -> Box<dyn Integrator>; 3] = [
        &|| Box::new(GeneralizedAlpha::chung_hulbert(0.4).unwrap()),
        &|| Box::new(NonsmoothAlpha::decoupled(0.4).unwrap()),
        &|| Box::new(NonsmoothAlpha::coupled(0.4).unwrap()),
    ];
    for make in methods {
        let mut error = |count: usize| {
            let method = make();
            let (h, mut from) = (2.0 / (3 * count) as f64, start.clone());
            let mut method = method.start(&mut system, &mut from, h).unwrap();
            let mut to = from.clone();
            for _ in 0..count {
                for part in [1.0, 0.5, 1.5] {
                    method.step(&mut system, &from, Span::new(from.t, part * h), &mut to).unwrap();
                    method.accept(&from, &to);
                    std::mem::swap(&mut from, &mut to);
                }
            }
            (from.q[0] - exact.q[0]).hypot(from.q[1] - exact.q[1])
        };
        let (coarse, fine) = (error(200), error(400));
        let order = (coarse / fine).log2();
        assert!((order - 2.0).abs() < 0.1, "{order}: {coarse:e} {fine:e}");
    }
}
