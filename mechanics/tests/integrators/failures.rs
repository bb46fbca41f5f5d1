//! What a step that fails says: which unknown, how large, of what.

use flexion::integrator::{
    GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha, Radau, Span, StepError, Tolerance,
};
use flexion::linalg::{Matrix, Structure};
use flexion::system::{Dynamics, Size, State, Weights};

/// q̈₀ = 0 and q̈₁ + K atan(q₁/ε) = 0: the spring saturates, and Newton's method diverges from where it is saturated.
struct Saturated {
    scales: [f64; 2],
}

const STIFFNESS: f64 = 1e4;
const WIDTH: f64 = 1e-3;

impl Dynamics for Saturated {
    fn scales(&self) -> &[f64] {
        &self.scales
    }
    fn size(&self) -> Size {
        Size { q: 2, v: 2, lambda: 0, memory: 0 }
    }
    fn structure(&self, _multipliers: usize) -> Structure {
        Structure::dense(2)
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        r.copy_from_slice(&[s.a[0], s.a[1] + STIFFNESS * (s.q[1] / WIDTH).atan()]);
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        let slope = STIFFNESS / WIDTH / (1.0 + (s.q[1] / WIDTH).powi(2));
        out.clear();
        out.add(0, 0, w.a);
        out.add(1, 1, w.a + w.q * slope);
    }
    fn unknown(&self, index: usize) -> String {
        format!("mass {index}")
    }
}

/// Moreau–Jean solves (v₁ − v₀)/h + K atan(q_θ/ε) = 0 with q_θ = q₀ + θh((1 − θ)v₀ + θv₁): the iterates of Newton's method for one
/// number, and with them the last increment, are known. It is measured in scales of a displacement and in units of 10⁻¹².
#[test]
fn a_step_of_moreau_and_jean_that_does_not_converge_names_the_unknown_and_its_increment() {
    let (h, theta) = (0.1, 0.5);
    let mut system = Saturated { scales: [1.0, 1.0] };
    let mut from = State { v: vec![0.0, 1.0], ..State::zeros(system.size(), 0.0) };
    let method = MoreauJean::new(theta).unwrap();
    let mut method = method.start(&mut system, &mut from, h).unwrap();
    let mut to = from.clone();
    let error = method.step(&mut system, &from, Span::new(0.0, h), &mut to).unwrap_err();
    let StepError::NotConverged { iterations, size, worst, .. } = error else { panic!("{error}") };
    assert_eq!(worst, "mass 1");
    let (mut v, mut increment) = (1.0, 0.0);
    for _ in 0..iterations {
        let y = theta * h * ((1.0 - theta) + theta * v) / WIDTH;
        let slope = 1.0 / h + STIFFNESS * theta * theta * h / WIDTH / (1.0 + y * y);
        increment = -((v - 1.0) / h + STIFFNESS * y.atan()) / slope;
        v += increment;
    }
    let expected = h * increment.abs() / 2.0_f64.sqrt() / 1e-12;
    assert!((size / expected - 1.0).abs() < 1e-9, "{size:e} {expected:e}");
}

/// The same of all methods that solve equations.
#[test]
fn steps_that_do_not_converge_name_the_unknown_that_does_not() {
    let methods: [Box<dyn Integrator>; 5] = [
        Box::new(MoreauJean::new(0.5).unwrap()),
        Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()),
        Box::new(NonsmoothAlpha::decoupled(0.8).unwrap()),
        Box::new(NonsmoothAlpha::coupled(0.8).unwrap()),
        Box::new(Radau::new(Tolerance::uniform(1e-8)).unwrap()),
    ];
    for method in methods {
        let mut system = Saturated { scales: [1.0, 1.0] };
        let mut from = State { v: vec![0.0, 1.0], ..State::zeros(system.size(), 0.0) };
        let mut method = method.start(&mut system, &mut from, 0.1).unwrap();
        let mut to = from.clone();
        let error = method.step(&mut system, &from, Span::new(0.0, 0.1), &mut to).unwrap_err();
        let StepError::NotConverged { worst, size, .. } = error else { panic!("{error}") };
        assert_eq!(worst, "mass 1", "{}", method.info().name);
        assert!(size > 1e3, "{}: {size}", method.info().name);
    }
}
