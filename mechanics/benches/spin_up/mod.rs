//! The benchmarks' case: a slender beam on a hub spun up to 4 rad/s in 15 s (Wu & Haug 1988,
//! doi 10.1002/nme.1620260202), with any number of elements.
#![allow(missing_docs, clippy::unwrap_used, dead_code)]

use flexion::basis::{Field, Hermite, Lagrange};
use flexion::drive::Actuator;
use flexion::hub_beam::{
    Drive, ExactCoupling, Fields, Foreshortening, FreeHub, HighCoupling, Hub, HubBeam, LinearCoupling,
};
use flexion::integrator::{GeneralizedAlpha, Integration, Integrator, Radau, Span, Tolerance};
use flexion::linalg::{Mat3, Matrix, Vec3};
use flexion::multibody::slender::{Beam, ELEMENT_VELOCITIES, Properties, Station};
use flexion::multibody::{self, Flexible, Joint, Kind, Marker, Model, Multibody, Part, shear};
use flexion::profile::{Expression, Motion, SpinUp};
use flexion::section::{Matrices, Resultants, Uniform};
use flexion::system::{Frame, State, System, Weights};
use std::hint::black_box;
use std::sync::Arc;

/// Step of the fixed-step runs [s].
pub const STEP: f64 = 0.005;

/// Length of the beam [m].
const LENGTH: f64 = 10.0;

/// Numbers of elements: ten, doubled up to ten thousand.
pub fn sizes() -> impl Iterator<Item = usize> {
    (0..=10).map(|k| 10 << k)
}

/// The system of a coupling, or with `space` and `waves` the beam in space; `first-free` and `exact-free` are driven by a torque, that of the rigid beam.
pub fn system(coupling: &str, elements: usize) -> Box<dyn System> {
    let resultants =
        Resultants { mass: 1.2, axial_stiffness: 2.8e7, bending_stiffness: 1.4e4, ..Default::default() };
    let section = Uniform::from_resultants(resultants).unwrap();
    let profile = Arc::new(SpinUp::new(4.0, 15.0).unwrap());
    let motion = Motion::Speed { profile, initial_angle: 0.0 };
    if ["space", "waves"].contains(&coupling) {
        return Box::new(in_space(elements, motion));
    }
    let drive = if coupling.ends_with("-free") {
        let moment = 100.0 + resultants.mass * LENGTH.powi(3) / 3.0;
        let torque = format!("{moment} * 4 / 15 * (1 - cos(2 * pi * t / 15))");
        Drive::Free(FreeHub {
            angle: 0.0,
            speed: 0.0,
            actuator: Actuator {
                torque: Arc::new(Expression::new(&torque, "t", 15.0).unwrap()),
                damping: 0.0,
                stiffness: 0.0,
                rest_angle: 0.0,
                controller: None,
            },
        })
    } else {
        Drive::Prescribed(motion)
    };
    let hub = Hub { radius: 0.0, inertia: if coupling.ends_with("-free") { 100.0 } else { 0.0 }, drive };
    if coupling.starts_with("exact") {
        let coupling = ExactCoupling::new(LENGTH, elements, &section, &hub).unwrap();
        return Box::new(HubBeam::new(hub, coupling, &[]));
    }
    let fields = Fields::new(
        LENGTH,
        Box::new(Lagrange::new(LENGTH, elements, 1).unwrap()),
        Box::new(Hermite::new(LENGTH, elements, Field::Transverse).unwrap()),
        &[],
    );
    if coupling == "high" {
        let coupling = HighCoupling::new(fields, &section, &hub).unwrap();
        return Box::new(HubBeam::new(hub, coupling, &[]));
    }
    let coupling = LinearCoupling::new(fields, &section, &hub, Foreshortening::First);
    Box::new(HubBeam::new(hub, coupling, &[]))
}

/// The beam in space on a driven hinge, a metre an element.
fn in_space(elements: usize, motion: Motion) -> Multibody {
    let section = Properties::principal([2.8e7, 1.1e4, 1.4e4, 1.4e4], 1.2, [1.2e-3, 0.0, 0.0]);
    let root =
        Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]) };
    let mut model = Model::new();
    let beam = Beam::straight(root, elements as f64, elements, section).unwrap();
    let beam = model.beam(Flexible::new("beam", beam));
    let to = Marker::new(Part::Section { beam, node: 0 }, [0.0; 3]);
    let joint = Joint::new("hub", Kind::Revolute, Marker::new(Part::Ground, [0.0; 3]), to);
    model.joint(joint.driven(multibody::Drive::Prescribed(motion)));
    Multibody::new(model).unwrap()
}

pub fn integrator(name: &str) -> Box<dyn Integrator> {
    match name {
        "radau" => Box::new(Radau::new(Tolerance { relative: 1e-6, absolute: 1e-8 }).unwrap()),
        "alpha" => Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()),
        _ => Box::new(GeneralizedAlpha::newmark(0.25, 0.5).unwrap()),
    }
}

/// A run that can be continued step by step.
pub struct Run {
    pub system: Box<dyn System>,
    pub integrator: Integration,
    pub from: State,
    to: State,
}

impl Run {
    /// The run, a second after its start from rest; with `waves` a tenth of a second after its start with a velocity across the
    /// beam that has a wave in ten elements, so that all of them have the same to do, however many there are.
    pub fn new(coupling: &str, elements: usize, integrator_name: &str) -> Run {
        let mut system = system(coupling, elements);
        let method = integrator(integrator_name);
        let mut from = system.initial();
        let waves = coupling == "waves";
        for (i, v) in from.v.chunks_mut(ELEMENT_VELOCITIES).enumerate().filter(|_| waves) {
            let number = 0.2 * std::f64::consts::PI;
            (v[1], v[4]) = (0.1 * (number * i as f64).sin(), 0.1 * number * (number * i as f64).cos());
        }
        let integrator = method.start(&mut *system, &mut from, STEP).unwrap();
        let mut run = Run { system, integrator, to: from.clone(), from };
        run.steps(if waves { 20 } else { 200 });
        run
    }

    /// `count` accepted steps of the fixed size.
    pub fn steps(&mut self, count: usize) {
        for _ in 0..count {
            self.integrator
                .step(&mut *self.system, &self.from, Span::new(self.from.t, STEP), &mut self.to)
                .unwrap();
            self.integrator.accept(&self.from, &self.to);
            std::mem::swap(&mut self.from, &mut self.to);
        }
    }
}

/// The tangent of a step of the first-order beam and a right-hand side: what a step's equations are.
pub fn equations(elements: usize) -> (Matrix, Vec<f64>) {
    let mut system = system("first", elements);
    let state = State::zeros(system.size(), 5.0);
    let mut tangent = Matrix::new(&system.structure(0));
    system.tangent(&state, Weights::new(1.0, 0.5 * STEP, 0.25 * STEP * STEP), &mut tangent);
    let mut rhs = vec![0.0; state.v.len()];
    system.residual(&state, &mut rhs);
    (tangent, rhs)
}

/// Evaluates the forces of a straight beam in space, slender or with shear, or its tangent, `count` times at a bent configuration with
/// velocities.
pub fn evaluate(has_shear: bool, differentiate: bool, elements: usize, count: usize) {
    let w = Weights::new(1.0, 0.5 * STEP, 0.25 * STEP * STEP);
    let wave = |n: usize| -> Vec<f64> { (0..n).map(|i| 0.01 * (0.3 * i as f64).sin()).collect() };
    let length = elements as f64;
    if has_shear {
        let root = Frame { position: Vec3([0.0; 3]), rotation: Mat3::IDENTITY };
        let stiffness = [2.8e7, 1e7, 1e7, 1.1e4, 1.4e4, 1.4e4];
        let section = Matrices::principal(stiffness, 1.2, [1.2e-3, 6e-4, 6e-4]);
        let beam = shear::Beam::straight(root, length, elements, section).unwrap();
        let (d, mut q) = (wave(beam.velocities()), beam.initial().to_vec());
        beam.retract(beam.initial(), &d, &mut q);
        let (mut r, mut sum) = (vec![0.0; d.len()], 0.0);
        for _ in 0..count {
            if differentiate {
                beam.add_tangent([&q, &d, &d], Vec3::ZERO, &w, |_, block| sum += block[7][11]);
            } else {
                beam.add_forces([&q, &d, &d], Vec3::ZERO, &mut r);
            }
        }
        black_box((r, sum));
    } else {
        let root = Station {
            position: Vec3([0.0; 3]),
            tangent: Vec3([1.0, 0.0, 0.0]),
            normal: Vec3([0.0, 1.0, 0.0]),
        };
        let section = Properties::principal([2.8e7, 1.1e4, 1.4e4, 1.4e4], 1.2, [1.2e-3, 6e-4, 6e-4]);
        let beam = Beam::straight(root, length, elements, section).unwrap();
        let (d, mut q) = (wave(beam.velocities()), beam.initial().to_vec());
        beam.retract(beam.initial(), &d, &mut q);
        let (mut r, mut sum) = (vec![0.0; d.len()], 0.0);
        for _ in 0..count {
            if differentiate {
                beam.add_tangent(&q, &d, &d, &w, |_, block| sum += block[7][11]);
            } else {
                beam.add_forces(&q, &d, &d, &mut r);
            }
        }
        black_box((r, sum));
    }
}
