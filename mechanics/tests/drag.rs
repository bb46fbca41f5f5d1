//! Drag on beams: falls and rotors with closed forms, the decrement of a vibration, in the plane and in space.

#![allow(clippy::unwrap_used)] // in helpers of tests

use flexion::analysis::recording::{Record, record, record_from};
use flexion::analysis::transient::{Ending, Plan};
use flexion::basis::{Field, Lagrange, Modes};
use flexion::drive::Actuator;
use flexion::hub_beam::load::{self, Load};
use flexion::hub_beam::{
    Drive, ExactCoupling, Fields, Foreshortening, FreeHub, Hub, HubBeam, LinearCoupling,
};
use flexion::integrator::{GeneralizedAlpha, Radau, Tolerance};
use flexion::law::{ForceLaw, LinearDrag, Place, QuadraticDrag};
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Flexible, LineLaw, Model, Multibody};
use flexion::profile::{Constant, Motion};
use flexion::section::{Resultants, Uniform};
use flexion::system::{Direction, Dynamics, Observed, State, System};
use std::sync::Arc;

/// Length \[m\] and mass per length [kg/m] of the beam, coefficient of the quadratic drag [kg/m²].
const LENGTH: f64 = 2.0;
const MASS: f64 = 1.5;
const DRAG: QuadraticDrag = QuadraticDrag { coefficient: 0.6 };

fn section(bending_stiffness: f64) -> Uniform {
    let axial_stiffness = 100.0 * bending_stiffness;
    let resultants = Resultants { mass: MASS, axial_stiffness, bending_stiffness, ..Default::default() };
    Uniform::from_resultants(resultants).unwrap()
}

fn radau() -> Radau {
    Radau::new(Tolerance { relative: 1e-9, absolute: 1e-11 }).unwrap()
}

fn last(run: &Record, name: &str) -> f64 {
    assert_eq!(run.ending, Ending::Finished);
    *run.column(name).unwrap().last().unwrap()
}

/// The derivatives of a law are those of its force, through ṙ = 0 too, where the quadratic drag is as smooth as |v| v.
#[test]
fn derivatives_of_laws_are_those_of_their_forces() {
    let laws: [Arc<dyn ForceLaw>; 2] = [Arc::new(DRAG), Arc::new(LinearDrag { coefficient: 0.6 })];
    for law in laws {
        for velocity in [[0.0; 3], [1e-9, 0.0, -2e-9], [0.7, -1.3, 0.4], [0.0, 30.0, 0.0]] {
            let place = Place { velocity, ..Place::default() };
            let response = law.response(&place);
            for j in 0..3 {
                let h = 1e-6;
                let moved = |by: f64| {
                    let mut velocity = velocity;
                    velocity[j] += by;
                    law.response(&Place { velocity, ..place }).force
                };
                for i in 0..3 {
                    let difference = (moved(h)[i] - moved(-h)[i]) / (2.0 * h);
                    // Of |v| v the difference is off by its second derivative, 2 c, times h.
                    let error = (difference - response.by_velocity[i][j]).abs();
                    assert!(error < 3e-6, "{law:?} {velocity:?}: {difference}");
                }
            }
        }
    }
}

/// A free beam across gravity in space: ρA v̇ = ρA g − c v², v = v_t tanh(g t/v_t), v_t = √(ρA g/c).
#[test]
fn a_falling_beam_comes_to_its_terminal_speed() {
    let root = Station {
        position: [0.0; 3].into(),
        tangent: [0.6, 0.8, 0.0].into(),
        normal: [-0.8, 0.6, 0.0].into(),
    };
    let properties = Properties::principal([1e5, 10.0, 20.0, 30.0], MASS, [1e-3, 0.0, 0.0]);
    let beam = Beam::straight(root, LENGTH, 3, properties).unwrap();
    let mut model = Model::new().with_gravity([0.0, 0.0, -9.81]);
    let number = model.beam(Flexible::new("beam", beam));
    model.line_law(LineLaw { name: "air".into(), beam: number, elements: None, law: Arc::new(DRAG) });
    let mut system = Multibody::new(model).unwrap();
    let terminal = (MASS * 9.81 / DRAG.coefficient).sqrt();
    for end in [0.5, 5.0] {
        let run = record(&mut system, &radau(), &Plan::new(end, 0.01));
        let speed = terminal * (9.81 * end / terminal).tanh();
        let found = -last(&run, "beam.tip.velocity.z");
        assert!((found - speed).abs() < 1e-7 * speed, "{found} for {speed} at {end} s");
        // What gravity has done is kinetic energy or lost.
        let imbalance = run.trajectory.relative_imbalance().unwrap();
        assert!(imbalance < 1e-8 && last(&run, "energy.dissipated") > 0.0, "{imbalance}");
    }
    assert!((terminal - 4.952).abs() < 1e-3);
}

/// A stiff beam on a free hub: J ω̇ = −κ J ω², κ = c ((a + L)⁴ − a⁴)/4J, ω = ω₀/(1 + κ ω₀ t).
#[test]
fn a_free_rotor_slows_down_hyperbolically_with_every_coupling() {
    let (radius, inertia, speed) = (0.5, 3.0, 4.0);
    let actuator = Actuator {
        torque: Arc::new(Constant::new(0.0).unwrap()),
        damping: 0.0,
        stiffness: 0.0,
        rest_angle: 0.0,
        controller: None,
    };
    let free = FreeHub { angle: 0.0, speed, actuator };
    let hub = Hub { radius, inertia, drive: Drive::Free(free) };
    let section = section(1e9);
    let outer: f64 = radius + LENGTH;
    let whole = inertia + MASS * (outer.powi(3) - radius.powi(3)) / 3.0;
    let kappa = DRAG.coefficient * (outer.powi(4) - radius.powi(4)) / (4.0 * whole);
    let law = load::LineLaw { law: Arc::new(DRAG), range: (0.0, LENGTH) };
    let loads: [&dyn Load; 1] = [&law];
    let fields = || {
        let transverse = flexion::basis::Hermite::new(LENGTH, 3, Field::Transverse).unwrap();
        Fields::new(LENGTH, Box::new(Lagrange::new(LENGTH, 3, 1).unwrap()), Box::new(transverse), &[])
    };
    let linear = |foreshortening| {
        let coupling = LinearCoupling::new(fields(), &section, &hub, foreshortening);
        HubBeam::new(hub.clone(), coupling, &[]).with_loads(&section, &loads)
    };
    let exact = ExactCoupling::new(LENGTH, 3, &section, &hub).unwrap();
    let systems: [Box<dyn System>; 3] = [
        Box::new(linear(Foreshortening::None)),
        Box::new(linear(Foreshortening::First)),
        Box::new(HubBeam::new(hub.clone(), exact, &[]).with_loads(&section, &loads)),
    ];
    for mut system in systems {
        let run = record(system.as_mut(), &radau(), &Plan::new(2.0, 0.01));
        let (found, exact) = (last(&run, "hub.speed"), speed / (1.0 + kappa * speed * 2.0));
        assert!((found - exact).abs() < 1e-7 * exact, "{found} for {exact}");
        let lost = 0.5 * whole * (speed * speed - exact * exact);
        assert!((last(&run, "energy.dissipated") - lost).abs() < 1e-6 * lost);
        assert!(run.trajectory.relative_imbalance().unwrap() < 1e-7);
    }
}

/// Bending stiffness of the vibrating beam [N·m²].
const BENDING: f64 = 100.0;

/// A beam with one mode across, with the coupling `first` on a hub at rest; and the number of that mode.
fn one_mode(law: &load::LineLaw) -> (HubBeam<LinearCoupling>, usize) {
    let section = section(BENDING);
    let motion = Motion::Angle(Arc::new(Constant::new(0.0).unwrap()));
    let hub = Hub { radius: 0.0, inertia: 0.0, drive: Drive::Prescribed(motion) };
    let axial = Box::new(Lagrange::new(LENGTH, 1, 1).unwrap());
    let transverse = Box::new(Modes::new(LENGTH, 1, Field::Transverse).unwrap());
    let fields = Fields::new(LENGTH, axial, transverse, &[]);
    let coupling = LinearCoupling::new(fields, &section, &hub, Foreshortening::First);
    let system = HubBeam::new(hub, coupling, &[]).with_loads(&section, &[law]);
    let mode = (0..2).find(|i| system.direction(*i) == Direction::Chord).unwrap();
    (system, mode)
}

/// One mode w = A(t) φ(x)/φ(L) with the coupling `first` on a hub at rest, by Newmark's method: m Ä + c̄ |Ȧ| Ȧ + k A = 0 with
/// m = ∫ρA φ², c̄ = c ∫|φ|³, φ(L) = 1. In every period 1/A grows by 8 c̄/3m, to second order in c̄ A/m.
#[test]
fn the_amplitude_of_a_vibration_falls_by_the_law_of_quadratic_drag() {
    let law = load::LineLaw { law: Arc::new(DRAG), range: (0.0, LENGTH) };
    let (mut system, mode) = one_mode(&law);
    assert!(!system.is_affine());

    // The first mode of the cantilever, βL = 1.8751…
    let beta = 1.875_104_068_711_961 / LENGTH;
    let sigma = 0.734_095_513_753_902_6;
    let phi = |x: f64| {
        let z = beta * x;
        0.5 * (z.cosh() - z.cos() - sigma * (z.sinh() - z.sin()))
    };
    let mean = |f: &dyn Fn(f64) -> f64| {
        let n = 2000;
        (0..n).map(|i| f(phi(LENGTH * (f64::from(i) + 0.5) / f64::from(n)))).sum::<f64>() / f64::from(n)
    };
    let (mass, drag) = (MASS * mean(&|x| x * x), DRAG.coefficient * mean(&|x| x.abs().powi(3)));
    let omega = beta * beta * (BENDING / MASS).sqrt();
    let period = std::f64::consts::TAU / omega;

    let tip = |system: &mut dyn System, s: &State| {
        let mut row = vec![0.0; system.channels().len()];
        system.record(s, &mut row);
        row[0]
    };
    let mut start = system.initial();
    start.q[mode] = 1.0;
    start.q[mode] = 0.02 / tip(&mut system, &start);
    let energy = system.energy(&start).strain;
    let periods = 10;
    let (end, step) = (f64::from(periods) * period, period / 400.0);
    let newmark = GeneralizedAlpha::newmark(0.25, 0.5).unwrap();
    let run = record_from(&mut system, &newmark, &start, &Plan::new(end, end).with_step(step));
    assert_eq!(run.ending, Ending::Finished);
    let left = system.energy(&run.state).total();
    let inverse = (energy / left).sqrt() / 0.02;
    let growth = f64::from(periods) * 8.0 * drag / (3.0 * mass);
    assert!((inverse - 50.0 - growth).abs() < 1e-3 * growth, "{inverse} for {}", 50.0 + growth);
    let counters = run.counters;
    assert!(counters.iterations > counters.steps, "{counters:?}");
}

/// Under a drag a thousand times as strong every step of Newmark's method needs several iterations, and ends in the solution of
/// its equations: the largest of the forces is balanced by the others.
#[test]
fn steps_under_a_strong_drag_are_iterated_to_their_solution() {
    let law = load::LineLaw { law: Arc::new(QuadraticDrag { coefficient: 600.0 }), range: (0.0, LENGTH) };
    let (mut system, _) = one_mode(&law);
    let mut start = system.initial();
    start.v.iter_mut().for_each(|v| *v = 3.0);
    let newmark = GeneralizedAlpha::newmark(0.25, 0.5).unwrap();
    let run = record_from(&mut system, &newmark, &start, &Plan::new(0.4, 0.4).with_step(0.01));
    assert_eq!(run.ending, Ending::Finished);
    let mut residual = |s: &State| {
        let mut r = vec![0.0; s.v.len()];
        system.residual(s, &mut r);
        r.iter().fold(0.0_f64, |m, r| m.max(r.abs()))
    };
    // Against the drag of the start, about the largest of all forces: increments of displacements are what is judged.
    let (left, size) =
        (residual(&run.state), residual(&State { a: vec![0.0; start.a.len()], ..start.clone() }));
    assert!(left < 1e-8 * size, "{left} of {size}");
    let counters = run.counters;
    assert!(counters.iterations >= 2 * counters.steps, "{counters:?}");
}
