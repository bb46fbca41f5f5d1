//! The cost of a step is linear in the number of elements: by counts, not by the clock. The tangent of
//! the coupling `high` is full: of it only the iterations are counted.
#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]

#[path = "../benches/spin_up/mod.rs"]
mod spin_up;

use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate;
use flexion::basis::{Field, Hermite, Lagrange};
use flexion::hub_beam::{Fields, Foreshortening, Hub, HubBeam, LinearCoupling};
use flexion::integrator::{GeneralizedAlpha, Integrator, Span};
use flexion::linalg::Matrix;
use flexion::profile::{Motion, Ramp};
use flexion::section::{Resultants, Uniform};
use flexion::system::{Dynamics, Observed};
use std::sync::Arc;

/// Numbers stored for the tangent.
fn stored(matrix: &Matrix) -> usize {
    matrix.storage().entries().len()
}

#[test]
fn the_tangent_takes_memory_in_proportion_to_the_elements() {
    for coupling in ["first", "exact"] {
        let size = |n: usize| stored(&Matrix::new(&spin_up::system(coupling, n).structure(0)));
        let sizes: Vec<usize> = spin_up::sizes().map(size).collect();
        for pair in sizes.windows(2) {
            assert!(pair[1] <= 2 * pair[0], "{coupling}: {sizes:?}");
        }
    }
}

/// With the work of one iteration linear in the elements, so is the work of a step if the number of
/// iterations, residuals and factorisations does not grow with them.
#[test]
fn the_iterations_of_a_step_do_not_grow_with_the_elements() {
    for (coupling, integrator) in
        ["first", "high", "exact"].into_iter().flat_map(|c| [(c, "newmark"), (c, "radau")])
    {
        for elements in [10, 40, 160] {
            let counters = spin_up::Run::new(coupling, elements, integrator).integrator.counters();
            let what = format!("{coupling}, {integrator}, {elements} elements: {counters:?}");
            assert!(counters.iterations <= 4 * counters.steps, "{what}");
            // One a step at most, and the mass matrix at the start.
            assert!(counters.factorizations <= counters.steps + 1, "{what}");
        }
    }
}

/// The stiffness is a band and each solution linear in the elements: so is the cost of modes if the number of solutions
/// does not grow with them. At rest the problem is symmetric, in rotation gyroscopic.
#[test]
fn the_solutions_that_ten_modes_take_do_not_grow_with_the_elements() {
    for speed in [0.0, 4.0] {
        let solutions = |elements: usize| {
            let mut system = spin_up::system("first", elements);
            let mut state = system.initial();
            rotate(system.as_mut(), &mut state, 0.0, speed, &mut || true).unwrap();
            let found = modes(system.as_mut(), &state, 10, &[]).unwrap();
            assert_eq!(found.counted, Some(10), "{elements} elements at {speed} rad/s");
            found.solutions
        };
        let counts = [50, 200, 800, 3200].map(solutions);
        println!("{counts:?} solutions at {speed} rad/s");
        assert!(counts.iter().all(|c| *c <= counts[0] + 4), "{counts:?}");
    }
}

/// Rounding errors grow with the fourth power of the number of elements, iterations must not.
#[test]
fn rounding_errors_of_fine_meshes_are_not_iterated_upon() {
    for (integrator, iterations) in [("newmark", 1.6), ("radau", 2.5)] {
        for elements in [320, 1280, 2560] {
            let counters = spin_up::Run::new("first", elements, integrator).integrator.counters();
            let what = format!("{integrator}, {elements} elements: {counters:?}");
            assert!((counters.iterations as f64) < iterations * counters.steps as f64, "{what}");
            assert!(counters.factorizations * 2 < counters.steps, "{what}");
        }
    }
}

/// A hundred thousand unknowns: a tether of 3.3 km whose hub begins to rotate. No bending wave reaches the tip in ten
/// steps; it stays where it is, and is seen from the hub at −L θ = −½ L ω̇ t².
#[test]
fn a_hundred_thousand_unknowns_take_few_numbers_each() {
    let (elements, length, acceleration) = (33_334, 3_333.4, 1e-6);
    let resultants =
        Resultants { mass: 1.2, axial_stiffness: 2.8e7, bending_stiffness: 1.4e4, ..Default::default() };
    let section = Uniform::from_resultants(resultants).unwrap();
    let profile = Arc::new(Ramp::new(0.0, acceleration, 1.0).unwrap());
    let hub = Hub::prescribed(0.0, 0.0, Motion::Speed { profile, initial_angle: 0.0 });
    let fields = Fields::new(
        length,
        Box::new(Lagrange::new(length, elements, 1).unwrap()),
        Box::new(Hermite::new(length, elements, Field::Transverse).unwrap()),
        &[],
    );
    let coupling = LinearCoupling::new(fields, &section, &hub, Foreshortening::First);
    let mut system = HubBeam::new(hub, coupling, &[]);
    let n = system.size().v;
    assert!(n > 100_000);
    assert!(stored(&Matrix::new(&system.structure(0))) <= 16 * n, "half-bandwidth 5 and its fill");
    let integrator = GeneralizedAlpha::newmark(0.25, 0.5).unwrap();
    let mut from = system.initial();
    let mut integrator = integrator.start(&mut system, &mut from, spin_up::STEP).unwrap();
    let mut to = from.clone();
    for _ in 0..10 {
        integrator.step(&mut system, &from, Span::new(from.t, spin_up::STEP), &mut to).unwrap();
        integrator.accept(&from, &to);
        std::mem::swap(&mut from, &mut to);
    }
    let mut values = vec![0.0; system.channels().len()];
    system.record(&from, &mut values);
    let tip = system.channels().iter().position(|c| c.name == "tip.deflection").unwrap();
    let expected = -0.5 * length * acceleration * from.t * from.t;
    assert!((values[tip] / expected - 1.0).abs() < 1e-6, "{} for {expected}", values[tip]);
}
