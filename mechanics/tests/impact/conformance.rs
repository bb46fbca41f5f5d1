//! Points, obstacles and laws against differences, for every coupling and both kinds of hub.
#![allow(missing_docs, clippy::unwrap_used)]

use flexion::basis::{Field, Hermite, Modes};
use flexion::contact::{
    Circle, Contact, ContactForce, Contacting, Dissipation, Law, Obstacle, Plane, Points, Translation,
};
use flexion::drive::Actuator;
use flexion::hub_beam::{
    Coupling, Drive, ExactCoupling, Fields, Foreshortening, FreeHub, HighCoupling, Hub, HubBeam,
    LinearCoupling, Mount,
};
use flexion::linalg::Vec3;
use flexion::profile::{Constant, Expression, Motion};
use flexion::section::{Resultants, Uniform};
use flexion::system::{Mode, State, System};
use flexion::verify::dynamics;
use std::sync::Arc;

const LENGTH: f64 = 1.3;

fn section() -> Uniform {
    Uniform::from_resultants(Resultants {
        mass: 1.2,
        axial_stiffness: 200.0,
        bending_stiffness: 8.0,
        ..Default::default()
    })
    .unwrap()
}

fn hub(free: bool) -> Hub {
    let drive = if free {
        Drive::Free(FreeHub {
            angle: 0.4,
            speed: 1.5,
            actuator: Actuator {
                torque: Arc::new(Constant::new(0.0).unwrap()),
                damping: 0.0,
                stiffness: 0.0,
                rest_angle: 0.0,
                controller: None,
            },
        })
    } else {
        Drive::Prescribed(Motion::Angle(Arc::new(
            Expression::new("0.4 + 1.5*t + 0.7*t^2", "t", 1.0).unwrap(),
        )))
    };
    Hub { radius: 0.2, inertia: 3.0, drive }
}

fn wave() -> Option<Translation> {
    let displacement = Arc::new(Expression::new("0.1*sin(3*t)", "t", 1.0).unwrap());
    Some(Translation { direction: Vec3([0.6, 0.8, 0.0]), displacement })
}

fn obstacles() -> Vec<Arc<dyn Obstacle>> {
    let (sin, cos) = 0.7_f64.sin_cos();
    vec![
        Arc::new(Plane { point: Vec3([-1.0, 4.0, 0.0]), normal: Vec3([-sin, cos, 0.0]), motion: wave() }),
        Arc::new(Circle {
            centre: Vec3([1.0, 1.0, 0.0]),
            axis: Vec3([0.0, 0.0, 1.0]),
            radius: 1.6,
            hollow: false,
            motion: wave(),
        }),
        Arc::new(Circle {
            centre: Vec3([0.3, 0.1, 0.0]),
            axis: Vec3([0.0, 0.0, 1.0]),
            radius: 0.6,
            hollow: true,
            motion: None,
        }),
    ]
}

fn check<C: Coupling + 'static>(name: &str, make: impl Fn() -> HubBeam<C>, mount: Mount) {
    for obstacle in obstacles() {
        for law in [
            Law::Constraint { restitution: 0.3, friction: 0.2 },
            Law::Force(ContactForce {
                stiffness: 40.0,
                exponent: 1.5,
                factor: Dissipation::HuntCrossley.factor(0.4),
                friction: 0.3,
                slip_speed: 2.0,
            }),
        ] {
            let model = make().with_contact_points(&[(0.5 * LENGTH, mount), (LENGTH, mount)]);
            let contact =
                |point| Contact { name: format!("c{point}"), point, obstacle: Arc::clone(&obstacle), law };
            let mut system = Contacting::new(model, vec![contact(0), contact(1)]);
            let mut s = flexion::system::Dynamics::initial(&system);
            s.t = 0.31;
            fill(&mut s);
            let gaps = system.gaps(&s);
            if let Law::Force(_) = law {
                assert!(gaps.iter().any(|gap| *gap < 0.0), "{gaps:?}");
                s.memory.fill(0.8);
            } else {
                // Constraints that hold take and give no power: see below.
                s.lambda.fill(0.0);
                s.mode.fill(Mode::Open);
            }
            report(name, &mut system, &s);
            if let Law::Constraint { .. } = law {
                for (i, lambda) in s.lambda.iter_mut().enumerate() {
                    *lambda = 3.0 - 1.3 * i as f64;
                }
                let defects = dynamics(&mut system, &s);
                let defects: Vec<_> = defects.into_iter().filter(|d| d.check != "dE/dt").collect();
                assert!(defects.is_empty(), "{name} {mount:?}: {}", defects[0]);
            }
        }
    }
}

fn report(name: &str, system: &mut dyn System, s: &State) {
    let defects = dynamics(system, s);
    assert!(defects.is_empty(), "{name}: {}", defects[0]);
}

fn fill(s: &mut State) {
    for (i, q) in s.q.iter_mut().enumerate() {
        *q += 0.05 * (1.3 * i as f64 + 0.2).sin();
    }
    for (i, v) in s.v.iter_mut().enumerate() {
        *v += 0.4 * (0.9 * i as f64 + 0.7).cos();
    }
    for (i, a) in s.a.iter_mut().enumerate() {
        *a += (0.5 * i as f64 + 0.1).cos();
    }
}

fn fields() -> Fields {
    let modes = |n, field| Box::new(Modes::new(LENGTH, n, field).unwrap());
    Fields::new(LENGTH, modes(1, Field::Axial), modes(3, Field::Transverse), &[0.5 * LENGTH])
}

fn elements() -> Fields {
    let elements = |field| Box::new(Hermite::new(LENGTH, 6, field).unwrap());
    Fields::new(LENGTH, elements(Field::Axial), elements(Field::Transverse), &[0.5 * LENGTH])
}

fn all(free: bool, mount: Mount) {
    let section = section();
    let linear = |kept, fields: Fields| {
        HubBeam::new(hub(free), LinearCoupling::new(fields, &section, &hub(free), kept), &[])
    };
    check("zeroth", || linear(Foreshortening::None, fields()), mount);
    check("first", || linear(Foreshortening::First, fields()), mount);
    check("first, elements", || linear(Foreshortening::First, elements()), mount);
    check(
        "high",
        || HubBeam::new(hub(free), HighCoupling::new(fields(), &section, &hub(free)).unwrap(), &[]),
        mount,
    );
    check(
        "exact",
        || HubBeam::new(hub(free), ExactCoupling::new(LENGTH, 4, &section, &hub(free)).unwrap(), &[]),
        mount,
    );
}

#[test]
fn contacts_with_the_ground_on_a_free_hub_conform() {
    all(true, Mount::Ground);
}

#[test]
fn contacts_with_the_ground_on_a_hub_that_moves_as_prescribed_conform() {
    all(false, Mount::Ground);
}

#[test]
fn contacts_with_the_hub_conform() {
    all(true, Mount::Hub);
    all(false, Mount::Hub);
}

/// The variations of a point against its motion are part of the checks; its acceleration is that of the rows.
#[test]
fn a_point_moves_with_the_hub() {
    let section = section();
    let coupling = ExactCoupling::new(LENGTH, 4, &section, &hub(false)).unwrap();
    let mut model = HubBeam::new(hub(false), coupling, &[]).with_contact_points(&[(LENGTH, Mount::Ground)]);
    let s = State { t: 0.5, ..flexion::system::Dynamics::initial(&model) };
    let motion = model.motion(0, &s);
    let (angle, speed) = (0.4_f64 + 0.75 + 0.175, 1.5 + 0.7);
    assert!((motion.position[0] - 1.5 * angle.cos()).abs() < 1e-14);
    assert!((motion.velocity[1] - 1.5 * speed * angle.cos()).abs() < 1e-13);
    assert!((motion.prescribed[1] - motion.velocity[1]).abs() < 1e-13);
}
