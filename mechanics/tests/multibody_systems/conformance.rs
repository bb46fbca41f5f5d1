//! Every joint, spring and load against differences.

use super::{odd_body, odd_rotation, wave};
use flexion::drive::{Actuator, Controller};
use flexion::law::{ForceLaw, LinearDrag, Place, Response};
use flexion::linalg::{Matrix, Vec3};
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{
    Axes, Directions, Drive, Flexible, Joint, Kind, LineLaw, Load, Marker, Model, Multibody, Part, Spring,
};
use flexion::profile::{Expression, Motion, Profile};
use flexion::system::{Dynamics, Frame, State, Weights};
use flexion::verify::dynamics;
use std::sync::Arc;

pub fn profile(text: &str) -> Arc<dyn Profile> {
    Arc::new(Expression::new(text, "t", 10.0).unwrap())
}

/// The state at the start with accelerations and multipliers of no account.
fn anywhere(system: &Multibody) -> State {
    let mut s = system.initial();
    s.a.iter_mut().enumerate().for_each(|(i, a)| *a = 3.0 * wave(i, 4.0));
    s.lambda.iter_mut().enumerate().for_each(|(i, x)| *x = 2.0 * wave(i, 5.0));
    s
}

/// Ground – first – second, with two joints of the kind.
fn pair(kind: Kind, drive: Drive) -> Multibody {
    let mut model = Model::new().with_gravity([1.0, 2.0, -9.81]);
    let first = model.body(odd_body("first", 0.3));
    let second = model.body(odd_body("second", 1.7));
    for (name, parts, k) in [("root", [Part::Ground, first], 0.9), ("elbow", [first, second], 2.2)] {
        // What is fixed to the ground does not move.
        let kind = if kind == Kind::Fixed && name == "root" { Kind::Spherical } else { kind };
        let point = [0.3 * wave(1, k), 0.4 * wave(2, k), 0.5 * wave(3, k)];
        let axis = [wave(4, k), wave(5, k), wave(6, k)];
        let joint =
            model.join(name, kind, parts, Vec3(point), (Vec3(axis), Some(Vec3([0.3, 1.0, 0.2])))).unwrap();
        joint.drive = drive.clone();
    }
    Multibody::new(model).unwrap()
}

fn actuator() -> Actuator {
    let controller = Some(Controller {
        proportional: 3.0,
        derivative: 0.7,
        reference: Motion::Angle(profile("0.2*t^2 + 0.3")),
        limit: f64::INFINITY,
    });
    Actuator { torque: profile("2 + sin(3*t)"), damping: 0.3, stiffness: 4.0, rest_angle: 0.1, controller }
}

#[test]
fn every_joint_conforms() {
    for kind in [
        Kind::Fixed,
        Kind::Revolute,
        Kind::Prismatic,
        Kind::Cylindrical,
        Kind::Universal,
        Kind::Spherical,
        Kind::Planar,
    ] {
        let mut system = pair(kind, Drive::None);
        let s = anywhere(&system);
        assert_eq!(dynamics(&mut system, &s), [], "{kind:?}");
    }
}

#[test]
fn every_drive_conforms() {
    for kind in [Kind::Revolute, Kind::Cylindrical, Kind::Prismatic] {
        // At t = 0 the prescribed coordinate is that of the start.
        let motion = Motion::Angle(profile("0.7*t + 0.4*t^2"));
        for drive in [Drive::Prescribed(motion), Drive::Actuated(actuator())] {
            let mut system = pair(kind, drive);
            let s = anywhere(&system);
            assert_eq!(dynamics(&mut system, &s), [], "{kind:?}");
        }
    }
}

/// Off the constraints, where g is not zero, the equations are differentiated rightly too.
#[test]
fn the_tangent_is_exact_where_the_constraints_do_not_hold() {
    for kind in [Kind::Revolute, Kind::Prismatic, Kind::Universal, Kind::Planar] {
        let drive = match kind {
            Kind::Revolute | Kind::Prismatic => Drive::Actuated(actuator()),
            _ => Drive::None,
        };
        let mut system = pair(kind, drive);
        let mut s = anywhere(&system);
        let d: Vec<f64> = (0..s.v.len()).map(|i| 0.3 * wave(i, 0.7)).collect();
        let q = s.q.clone();
        system.retract(&q, &d, &mut s.q);
        s.v.iter_mut().enumerate().for_each(|(i, v)| *v = wave(i, 2.1));
        let mut defects = dynamics(&mut system, &s);
        defects.retain(|d| d.check != "dE/dt");
        assert_eq!(defects, [], "{kind:?}");
    }
}

#[test]
fn springs_and_loads_conform() {
    let mut model = Model::new().with_gravity([0.0, 0.0, -9.81]);
    let bodies = [odd_body("first", 0.3), odd_body("second", 1.7)].map(|mut body| {
        body.damping = 0.4;
        model.body(body)
    });
    let marker = |part, k| Marker {
        part,
        frame: Frame { position: Vec3([0.3 * wave(1, k), 0.4, 0.5 * wave(3, k)]), rotation: odd_rotation(k) },
    };
    for (name, parts, k, length, directions) in [
        ("to ground", [Part::Ground, bodies[0]], 0.1, 0.3, Directions::Line),
        ("between", [bodies[1], bodies[0]], 1.3, 0.3, Directions::Line),
        ("in all directions", [bodies[1], bodies[0]], 0.7, 0.0, Directions::All),
    ] {
        let [from, to] = [marker(parts[0], k), marker(parts[1], k + 0.4)];
        let spring =
            Spring { name: name.to_owned(), from, to, stiffness: 20.0, damping: 0.8, length, directions };
        model.spring(spring);
    }
    for (name, axes) in [("dead", Axes::Dead), ("follower", Axes::Follower)] {
        model.load(Load {
            name: name.to_owned(),
            at: marker(bodies[1], 0.6),
            force: Vec3([1.0, -2.0, 0.7]),
            moment: Vec3([0.4, 0.9, -1.1]),
            axes,
            amplitude: Some(profile("1 + t")),
        });
    }
    let mut system = Multibody::new(model).unwrap();
    let s = anywhere(&system);
    assert_eq!(dynamics(&mut system, &s), []);
}

/// A law that depends on place, velocity and time.
#[derive(Debug)]
struct Swirl;

impl ForceLaw for Swirl {
    fn response(&self, place: &Place) -> Response {
        let ([x, y, z], [u, v, w], f) = (place.position, place.velocity, 1.0 + place.time);
        Response {
            force: [f * x * v, f * (y - z * w), f * u * u],
            by_position: [[f * v, 0.0, 0.0], [0.0, f, -f * w], [0.0; 3]],
            by_velocity: [[0.0, f * x, 0.0], [0.0, 0.0, -f * z], [2.0 * f * u, 0.0, 0.0]],
        }
    }
}

#[test]
fn force_laws_along_beams_conform() {
    let root = Station {
        position: [0.3, -0.2, 0.1].into(),
        tangent: [0.6, 0.8, 0.0].into(),
        normal: [-0.8, 0.6, 0.0].into(),
    };
    let section = Properties::principal([1e3, 20.0, 30.0, 40.0], 1.3, [0.2, 0.1, 0.1]);
    let laws: [Arc<dyn ForceLaw>; 2] = [Arc::new(LinearDrag { coefficient: 0.7 }), Arc::new(Swirl)];
    let place = Frame { position: root.position, rotation: super::odd_rotation(0.8) };
    let beams = [
        Flexible::new("beam", Beam::straight(root, 2.0, 3, section).unwrap()),
        Flexible::new("beam", super::beams::sheared_arc(3, place)),
    ];
    for (law, beam) in
        laws.iter().flat_map(|law| beams.iter().map(move |beam| (Arc::clone(law), beam.clone())))
    {
        let mut model = Model::new().with_gravity([0.0, 0.0, -9.81]);
        let beam = model.beam(beam);
        model.line_law(LineLaw { name: "law".into(), beam, elements: Some(1..3), law });
        let mut system = Multibody::new(model).unwrap();
        let mut s = anywhere(&system);
        let d: Vec<f64> = (0..s.v.len()).map(|i| 0.02 * wave(i, 0.3)).collect();
        let from = s.q.clone();
        system.retract(&from, &d, &mut s.q);
        s.v.iter_mut().enumerate().for_each(|(i, v)| *v = wave(i, 2.0));
        assert_eq!(dynamics(&mut system, &s), []);
    }
}

/// Newton's tangent by the increment of a step, ∂r/∂d at q₀ ⊞ d with d not small, against differences.
pub(super) fn tangent_follows_the_increment(system: &mut Multibody, from: &State, size: f64, bound: f64) {
    let n = from.v.len();
    let mut d: Vec<f64> = (0..n).map(|i| size * wave(i, 0.7)).collect();
    let mut s = from.clone();
    system.retract(&from.q, &d, &mut s.q);
    let mut matrix = Matrix::new(&system.structure(0));
    system.tangent(&s, Weights { q: 1.0, v: 0.0, a: 0.0, increment: Some(&d) }, &mut matrix);
    let step = 1e-4;
    for j in 0..n {
        let mut residual = |h: f64, d: &mut Vec<f64>| {
            let old = d[j];
            d[j] += h;
            system.retract(&from.q, d, &mut s.q);
            d[j] = old;
            let mut r = vec![0.0; n];
            system.residual(&s, &mut r);
            r
        };
        let [a, b, c, e] = [-2.0, -1.0, 1.0, 2.0].map(|k| residual(k * step, &mut d));
        for i in 0..n {
            let slope = (a[i] - 8.0 * b[i] + 8.0 * c[i] - e[i]) / (12.0 * step);
            assert!((matrix.get(i, j) - slope).abs() < bound, "{i} {j}: {} {slope}", matrix.get(i, j));
        }
    }
}

#[test]
fn the_tangent_follows_the_increment_of_a_step() {
    let mut system = pair(Kind::Revolute, Drive::Actuated(actuator()));
    let from = anywhere(&system);
    tangent_follows_the_increment(&mut system, &from, 0.8, 1e-7);
}

/// Three markers that are given by hand, two bodies that share no point: markers need not coincide in a prismatic joint.
#[test]
fn a_prismatic_joint_with_markers_of_its_own_conforms() {
    let mut model = Model::new();
    let mut body = odd_body("slider", 0.4);
    body.frame.rotation = odd_rotation(1.0);
    let along = body.frame.rotation.column(2);
    body.frame.position = along.map(|x| 0.7 * x);
    let part = model.body(body);
    let from =
        Marker { part: Part::Ground, frame: Frame { position: Vec3([0.0; 3]), rotation: odd_rotation(1.0) } };
    model.joint(Joint::new("rail", Kind::Prismatic, from, Marker::new(part, [0.0; 3])));
    let mut system = Multibody::new(model).unwrap();
    let s = anywhere(&system);
    assert!((super::channel(&mut system, &s, "rail.displacement") - 0.7).abs() < 1e-15);
    assert_eq!(dynamics(&mut system, &s), []);
}
