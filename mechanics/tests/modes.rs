//! Modes against published values and closed forms.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, missing_docs)]

use flexion::analysis::modes::{Mode, Modes, modes};
use flexion::analysis::rotation::{NoRotation, rotate_stably};
use flexion::basis::{Basis, Field, Hermite, Lagrange};
use flexion::drive::Actuator;
use flexion::hub_beam::{
    Damping, Drive, ExactCoupling, Fields, Foreshortening, FreeHub, HighCoupling, Hub, HubBeam,
    LinearCoupling,
};
use flexion::linalg::Matrix;
use flexion::linalg::eigen::Kind;
use flexion::linalg::vector::dot;
use flexion::profile::{Constant, Motion};
use flexion::section::{Resultants, Uniform};
use flexion::system::{Dynamics, Parameter, State, Steady, System, Weights};
use std::sync::Arc;

/// Roots of cos x cosh x = −1, squared.
const CANTILEVER: [f64; 4] = [3.516015268500612, 22.034491564668223, 61.69721441178178, 120.90191605230585];

/// A beam with L = ρA = EI = 1 and EA = slenderness².
fn section(slenderness: f64) -> Uniform {
    let axial_stiffness = slenderness * slenderness;
    Uniform::from_resultants(Resultants {
        mass: 1.0,
        axial_stiffness,
        bending_stiffness: 1.0,
        ..Resultants::default()
    })
    .unwrap()
}

fn hub(radius: f64) -> Hub {
    let profile = Arc::new(Constant::new(0.0).unwrap());
    Hub::prescribed(radius, 0.0, Motion::Speed { profile, initial_angle: 0.0 })
}

fn first(elements: usize, slenderness: f64, radius: f64) -> Box<dyn System> {
    beam(elements, slenderness, radius, Foreshortening::First)
}

fn beam(elements: usize, slenderness: f64, radius: f64, foreshortening: Foreshortening) -> Box<dyn System> {
    let axial: Box<dyn Basis> = Box::new(Lagrange::new(1.0, elements, 1).unwrap());
    let transverse: Box<dyn Basis> = Box::new(Hermite::new(1.0, elements, Field::Transverse).unwrap());
    let fields = Fields::new(1.0, axial, transverse, &[]);
    let hub = hub(radius);
    let coupling = LinearCoupling::new(fields, &section(slenderness), &hub, foreshortening);
    Box::new(HubBeam::new(hub, coupling, &[]))
}

fn exact(elements: usize, slenderness: f64, radius: f64) -> Box<dyn System> {
    let hub = hub(radius);
    let coupling = ExactCoupling::new(1.0, elements, &section(slenderness), &hub).unwrap();
    Box::new(HubBeam::new(hub, coupling, &[]))
}

fn high(elements: usize, slenderness: f64, radius: f64) -> Box<dyn System> {
    let axial: Box<dyn Basis> = Box::new(Lagrange::new(1.0, elements, 1).unwrap());
    let transverse: Box<dyn Basis> = Box::new(Hermite::new(1.0, elements, Field::Transverse).unwrap());
    let hub = hub(radius);
    let coupling =
        HighCoupling::new(Fields::new(1.0, axial, transverse, &[]), &section(slenderness), &hub).unwrap();
    Box::new(HubBeam::new(hub, coupling, &[]))
}

fn stations() -> Vec<f64> {
    (0..=200).map(|i| f64::from(i) / 200.0).collect()
}

fn at(system: &mut dyn System, speed: f64, count: usize) -> Modes {
    let mut state = State::zeros(system.size(), 0.0);
    rotate_stably(system, &mut state, 0.0, speed).unwrap();
    modes(system, &state, count, &stations()).unwrap()
}

fn frequencies(modes: &Modes) -> Vec<f64> {
    modes.modes.iter().map(Mode::frequency).collect()
}

#[test]
fn a_cantilever_at_rest_has_the_frequencies_and_nodes_of_the_textbook() {
    let modes = at(first(80, 1000.0, 0.0).as_mut(), 0.0, 4);
    assert_eq!((modes.kind, modes.counted), (Kind::Symmetric, Some(4)));
    for (number, (mode, expected)) in modes.modes.iter().zip(CANTILEVER).enumerate() {
        assert!((mode.frequency() / expected - 1.0).abs() < 3e-7, "{} for {expected}", mode.frequency());
        assert_eq!((mode.nodes, mode.shares.dominant()), (number, "chord"));
        assert!(mode.residual < 1e-8 && mode.damping_ratio() == 0.0);
    }
}

#[test]
fn hermite_elements_give_frequencies_to_order_four() {
    let error = |n| frequencies(&at(first(n, 1000.0, 0.0).as_mut(), 0.0, 2))[1] / CANTILEVER[1] - 1.0;
    for n in [8, 16, 32] {
        let order = (error(n) / error(2 * n)).log2();
        assert!((order - 4.0).abs() < 0.05, "order {order} from {n} elements");
    }
}

#[test]
fn frequencies_of_cantilevers_are_right_to_1e_8_up_to_a_thousand_elements() {
    let mut systems: Vec<(&str, Box<dyn System>)> = Vec::new();
    for n in [300, 1000] {
        systems.push(("zeroth", beam(n, 1000.0, 0.0, Foreshortening::None)));
        systems.push(("first", first(n, 1000.0, 0.0)));
        if n <= 300 {
            systems.push(("high", high(n, 1000.0, 0.0)));
        }
        systems.push(("exact", exact(n, 1000.0, 0.0)));
    }
    for (name, mut system) in systems {
        for (number, mode) in at(system.as_mut(), 0.0, 4).modes.iter().enumerate() {
            let off = mode.frequency() / CANTILEVER[number] - 1.0;
            assert!(off.abs() < 1e-8, "mode {number} of {name}: {off:e}, bound {:e}", mode.rounding);
        }
    }
}

#[test]
fn frequencies_of_turning_beams_are_right_to_1e_8_up_to_a_thousand_elements() {
    type Make<'a> = &'a dyn Fn(usize) -> Box<dyn System>;
    let makes: [(&str, f64, Make<'_>); 3] = [
        ("zeroth", 2.0, &|n| beam(n, 1000.0, 0.1, Foreshortening::None)),
        ("first", 3.0, &|n| first(n, 1000.0, 0.1)),
        ("exact", 3.0, &|n| exact(n, 1000.0, 0.1)),
    ];
    for (name, speed, make) in makes {
        // A mesh whose rounding and discretisation errors are both below 1e-8.
        let coarse = at(make(200).as_mut(), speed, 3);
        let fine = at(make(1000).as_mut(), speed, 3);
        for (a, b) in coarse.modes.iter().zip(&fine.modes) {
            let off = b.frequency() / a.frequency() - 1.0;
            assert!(off.abs() < 1e-8, "{name}: {off:e}, bound {:e}", b.rounding);
        }
    }
}

/// The stiffness of bent systems, on which every term of the second variation of the strain energy acts.
#[test]
fn the_strains_of_a_vector_make_the_form_of_the_stiffness() {
    let systems: [Box<dyn System>; 3] = [exact(5, 20.0, 0.1), high(5, 20.0, 0.1), first(5, 20.0, 0.1)];
    for (number, mut system) in systems.into_iter().enumerate() {
        system.set(Parameter::Speed, 5.0).unwrap();
        let mut state = system.initial();
        let n = state.v.len();
        (0..n).for_each(|i| state.q[i] += 0.1 * (i as f64).sin());
        let mut stiffness = Matrix::new(&system.structure(0));
        system.tangent(&state, Weights::new(0.0, 0.0, 1.0), &mut stiffness);
        let vectors: Vec<Vec<f64>> =
            (1..4).map(|k| (0..n).map(|i| ((k * i) as f64).cos()).collect()).collect();
        let forms = system.stiffness_forms(&state, &vectors).unwrap();
        let (mut product, mut sizes) = (vec![0.0; n], vec![0.0; n]);
        for (x, form) in vectors.iter().zip(forms) {
            stiffness.multiply(x, &mut product);
            let expected = dot(x, &product);
            sizes.iter_mut().zip(&product).for_each(|(s, p)| *s = p.abs());
            let size: f64 = x.iter().zip(&sizes).map(|(x, p)| x.abs() * p).sum();
            assert!((form.value - expected).abs() < 1e-12 * size, "system {number}: {form:?} for {expected}");
        }
    }
}

#[test]
fn chordwise_frequencies_with_gyroscopic_forces_are_those_of_the_literature() {
    // Hamza-cherif & Houmat 2004: slenderness 70, no hub; and the same by collocation of both equations of motion. The published digits are
    // cut, not rounded, and their last one is not converged.
    for (speed, published, collocation) in [
        (2.0, 3.6195, 3.619566),
        (4.0, 3.888, 3.888068),
        (6.0, 4.2393, 4.239333),
        (8.0, 4.6105, 4.610583),
        (10.0, 4.97, 4.970022),
        (50.0, 7.3362, 7.333589),
    ] {
        let modes = at(first(40, 70.0, 0.0).as_mut(), speed, 4);
        assert_eq!((modes.kind, modes.counted), (Kind::Gyroscopic, Some(4)));
        let found = modes.modes[0].frequency();
        assert!((found / published - 1.0).abs() < 5e-4, "{found} for {published} at {speed}");
        // The layer at the root in which a fast beam bends is 1/γ long.
        let tolerance = if speed > 10.0 { 3e-4 } else { 2e-5 };
        assert!((found / collocation - 1.0).abs() < tolerance, "{found} for {collocation} at {speed}");
    }
}

#[test]
fn the_exact_beam_agrees_with_the_first_coupling_while_its_stretch_is_small() {
    // The stretch is of the order of (speed/slenderness)².
    for (slenderness, tolerance) in [(70.0, 6e-3), (700.0, 6e-5)] {
        let one = at(first(40, slenderness, 0.1).as_mut(), 10.0, 3);
        let other = at(exact(40, slenderness, 0.1).as_mut(), 10.0, 3);
        for (a, b) in frequencies(&one).iter().zip(frequencies(&other)) {
            assert!((a / b - 1.0).abs() < tolerance, "{a} and {b} at slenderness {slenderness}");
        }
    }
}

#[test]
fn a_beam_without_centrifugal_stiffening_buckles_at_its_first_frequency() {
    let mut system = beam(20, 1000.0, 0.0, Foreshortening::None);
    let mut state = State::zeros(system.size(), 0.0);
    let Err(NoRotation::Buckled { reached, stability, .. }) =
        rotate_stably(system.as_mut(), &mut state, 0.0, 5.0)
    else {
        panic!("it rotates steadily at 5 rad/s");
    };
    assert_eq!((stability.divergent, stability.fluttering), (1, 0));
    // The axial stretch is not coupled to the deflection: K − Ω²M is exhausted at Ω = ω₁.
    assert!((reached / CANTILEVER[0] - 1.0).abs() < 1e-5, "{reached}");
}

/// The first-order coupling of a beam of slenderness 1000 on a hub.
fn coupling(elements: usize, hub: &Hub) -> LinearCoupling {
    let axial: Box<dyn Basis> = Box::new(Lagrange::new(1.0, elements, 1).unwrap());
    let transverse: Box<dyn Basis> = Box::new(Hermite::new(1.0, elements, Field::Transverse).unwrap());
    let fields = Fields::new(1.0, axial, transverse, &[]);
    LinearCoupling::new(fields, &section(1000.0), hub, Foreshortening::First)
}

#[test]
fn damping_in_proportion_to_mass_and_stiffness_gives_the_ratios_of_the_textbook() {
    // C = β M + η K: ζ = (β/ω + η ω)/2, |λ| = ω.
    let (hub, damping) = (hub(0.0), Damping { mass: 0.05, stiffness: 2e-4 });
    let mut system = HubBeam::new(hub.clone(), coupling(40, &hub), &[]).with_damping(damping);
    let modes = at(&mut system, 0.0, 4);
    assert_eq!(modes.kind, Kind::General);
    for (mode, omega) in modes.modes.iter().zip(CANTILEVER) {
        let expected = 0.5 * (0.05 / omega + 2e-4 * omega);
        assert!((mode.damping_ratio() / expected - 1.0).abs() < 2e-5, "{} {expected}", mode.damping_ratio());
        assert!((mode.eigenvalue.norm() / omega - 1.0).abs() < 1e-5);
    }
}

/// λ² + ηω² λ + ω² = 0 vibrates up to ω = 2/η; the roots of the others are all beyond 1/η.
#[test]
fn overdamped_motions_are_no_modes() {
    let eta = 0.05;
    let (hub, damping) = (hub(0.0), Damping { mass: 0.0, stiffness: eta });
    let mut system = HubBeam::new(hub.clone(), coupling(20, &hub), &[]).with_damping(damping);
    let found = at(&mut system, 0.0, 4);
    assert_eq!(found.modes.len(), 2, "{:?}", frequencies(&found));
    for (mode, omega) in found.modes.iter().zip(CANTILEVER) {
        let zeta = 0.5 * eta * omega;
        let expected = omega * (1.0 - zeta * zeta).sqrt();
        assert!((mode.frequency() / expected - 1.0).abs() < 1e-4, "{} for {expected}", mode.frequency());
    }
    assert!(!found.overdamped.is_empty() && found.overdamped.len() <= 4);
    for motion in &found.overdamped {
        assert!(motion.eigenvalue.im == 0.0 && motion.eigenvalue.re < -(1.0 - 1e-6) / eta);
    }
}

#[test]
fn a_free_hub_without_inertia_makes_a_pinned_beam() {
    let torque = Arc::new(Constant::new(0.0).unwrap());
    let free = FreeHub {
        angle: 0.0,
        speed: 0.0,
        actuator: Actuator { torque, damping: 0.0, stiffness: 0.0, rest_angle: 0.0, controller: None },
    };
    let hub = Hub { radius: 0.0, inertia: 0.0, drive: Drive::Free(free) };
    let mut system = HubBeam::new(hub.clone(), coupling(40, &hub), &[]);
    // Roots of tan x = tanh x, squared; the rigid rotation comes first.
    for (speed, tolerance) in [(0.0, 1e-5), (0.01, 1e-4)] {
        let mut state = State::zeros(system.size(), 0.0);
        rotate_stably(&mut system, &mut state, 0.0, speed).unwrap();
        system.hold(false);
        state.v = system.initial().v;
        let found = modes(&mut system, &state, 3, &stations()).unwrap().modes;
        assert_eq!(found[0].frequency(), 0.0, "{:?}", found[0].eigenvalue);
        for (mode, expected) in found[1..].iter().zip([15.418205716, 49.964862031]) {
            assert!((mode.frequency() / expected - 1.0).abs() < tolerance, "{} {expected}", mode.frequency());
        }
    }
}
