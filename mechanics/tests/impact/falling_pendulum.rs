//! P4's pendulum, which falls onto a plane.
#![allow(missing_docs, clippy::unwrap_used)]

use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::basis::{Field, Modes};
use flexion::contact::{Contact, Contacting, Law, Plane};
use flexion::drive::Actuator;
use flexion::hub_beam::load::Gravity;
use flexion::hub_beam::{Coupling, Drive, Fields, FreeHub, HighCoupling, Hub, HubBeam, Mount};
use flexion::integrator::{Integrator, Radau, Tolerance};
use flexion::linalg::Vec3;
use flexion::profile::Constant;
use flexion::section::{Resultants, Uniform};
use flexion::system::{Energy, State, System};
use std::sync::Arc;

/// P4's beam.
pub fn section() -> Uniform {
    let (density, modulus, area, second) = (2766.7, 6.8952e10, 3.14e-4, 7.85e-9);
    Uniform::from_resultants(Resultants {
        mass: density * area,
        axial_stiffness: modulus * area,
        bending_stiffness: modulus * second,
        ..Default::default()
    })
    .unwrap()
}

/// A hinge at 45°.
pub fn hub() -> Hub {
    let drive = Drive::Free(FreeHub {
        angle: std::f64::consts::FRAC_PI_4,
        speed: 0.0,
        actuator: Actuator {
            torque: Arc::new(Constant::new(0.0).unwrap()),
            damping: 0.0,
            stiffness: 0.0,
            rest_angle: 0.0,
            controller: None,
        },
    });
    Hub { radius: 0.0, inertia: 0.0, drive }
}

/// The pendulum over the ground y = 0.
pub fn with_ground<C: Coupling>(coupling: C, law: Law) -> Contacting<HubBeam<C>> {
    let gravity = Gravity { acceleration: 9.81, direction: -std::f64::consts::FRAC_PI_2 };
    let model = HubBeam::new(hub(), coupling, &[])
        .with_loads(&section(), &[&gravity])
        .with_contact_points(&[(1.0, Mount::Ground)]);
    let plane = Plane { point: Vec3([0.0; 3]), normal: Vec3([0.0, 1.0, 0.0]), motion: None };
    let contact = Contact { name: "ground".into(), point: 0, obstacle: Arc::new(plane), law };
    Contacting::new(model, vec![contact])
}

/// Pendulum of P4 with N modes of each field, which falls from 45° onto y = 0.
pub fn pendulum(modes: usize, law: Law) -> Contacting<HubBeam<HighCoupling>> {
    let basis = |field| Box::new(Modes::new(1.0, modes, field).unwrap());
    let fields = Fields::new(1.0, basis(Field::Axial), basis(Field::Transverse), &[]);
    with_ground(HighCoupling::new(fields, &section(), &hub()).unwrap(), law)
}

#[derive(Default)]
pub struct Watch {
    pub events: Vec<Event>,
    pub energies: Vec<Energy>,
}

impl Observer for Watch {
    fn sample(&mut self, system: &mut dyn System, state: &State, _: &Step) {
        self.energies.push(system.energy(state));
    }
    fn event(&mut self, event: &Event) {
        self.events.push(event.clone());
    }
}

pub fn run(system: &mut dyn System, method: &dyn Integrator, plan: &Plan) -> (Watch, State, Ending) {
    let mut state = system.initial();
    let mut watch = Watch::default();
    let ending = transient(system, method, &mut state, plan, &mut watch);
    (watch, state, ending)
}

/// Values of an independent program: N = 2, e = 0, first touch.
#[test]
fn the_first_touch_is_that_of_an_independent_program() {
    let mut system = pendulum(2, Law::Constraint { restitution: 0.0, friction: 0.0 });
    let method = Radau::new(Tolerance::uniform(1e-9)).unwrap();
    let plan = Plan::new(0.3701, 0.01);
    let (watch, _, ending) = run(&mut system, &method, &plan);
    assert_eq!(ending, Ending::Finished, "{:?}", watch.events);
    let first = watch.events.first().unwrap();
    let EventKind::Impact { impulses, lost, .. } = &first.kind else { panic!("{first:?}") };
    assert!((first.time - 0.37001005).abs() < 1e-8, "{}", first.time);
    assert!((impulses[0] / 0.4291842 - 1.0).abs() < 1e-6, "{}", impulses[0]);
    assert!((lost / 0.981371 - 1.0).abs() < 1e-6, "{lost}");
}
