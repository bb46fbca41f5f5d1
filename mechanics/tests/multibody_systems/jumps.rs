//! Jumps of a prescribed speed, and prescribed speeds in impacts: impulses of drives and their work.

use super::conformance::profile;
use super::{radau, run};
use flexion::analysis::transient::EventKind;
use flexion::contact::{Bounds, Contact, Contacting, ImpactMap, Law, Plane};
use flexion::hub_beam::{self, ExactCoupling, Hub, HubBeam};
use flexion::integrator::{GeneralizedAlpha, Integrator};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Body, Drive, Flexible, Joint, Kind, Marker, Model, Multibody, Part};
use flexion::profile::Motion;
use flexion::section::{Resultants, Uniform};
use flexion::system::{Observed, Side, System};
use std::sync::Arc;

const Z: ([f64; 3], Option<Vec3>) = ([0.0, 0.0, 1.0], None);

fn speed(text: &str) -> Motion {
    Motion::Speed { profile: profile(text), initial_angle: 0.0 }
}

/// An arm of m = 2 kg with its centre at 0.5 m and J = 0.2 kg·m² about it: ½ (J + m d²)(ω₁² − ω₀²) is the work of the jump.
#[test]
fn a_prescribed_speed_that_jumps_gives_its_impulse_and_its_work() {
    // Velocities of generalized-alpha err with h².
    let methods: [(Box<dyn Integrator>, Option<f64>, f64); 2] = [
        (Box::new(radau(1e-9)), None, 1e-7),
        (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), Some(1e-3), 1e-4),
    ];
    for (method, step, allowed) in methods {
        for text in ["if(t < 0.5, 1, 3)", "if(t < 0.5, 1, -2)"] {
            let mut model = Model::new();
            let body = model.body(Body::new("arm", 2.0, [0.2; 3]).at([0.5, 0.0, 0.0]));
            let joint = model.join("hinge", Kind::Revolute, [Part::Ground, body], [0.0; 3], Z).unwrap();
            joint.drive = Drive::Prescribed(speed(text));
            let mut system = Multibody::new(model).unwrap();
            let (end, imbalance) = run(&mut system, method.as_ref(), 1.0, step, |_, _| {});
            let after = if text.ends_with("3)") { 3.0 } else { -2.0 };
            let angle = 0.5 + 0.5 * after;
            assert!((super::channel(&mut system, &end, "hinge.angle") - angle).abs() < allowed);
            assert!((super::channel(&mut system, &end, "hinge.speed") - after).abs() < allowed);
            let energy = system.energy(&end).kinetic;
            assert!((energy - 0.35 * after * after).abs() < allowed, "{energy}");
            assert!(imbalance < allowed, "{imbalance}");
        }
    }
}

/// The blow on a beam at rest whose hub begins to rotate at once: kinetic energy, and the work of the drive, against the planar model.
#[test]
fn a_jump_strikes_a_beam_in_space_as_in_the_plane() {
    let (length, elements, omega) = (2.0, 6, 0.7);
    let motion = speed("if(t < 1, 0, 0.7)");
    let hub = Hub { radius: 0.0, inertia: 0.0, drive: hub_beam::Drive::Prescribed(motion.clone()) };
    let resultants =
        Resultants { mass: 1.2, axial_stiffness: 2.8e7, bending_stiffness: 1.4e4, ..Default::default() };
    let section = Uniform::from_resultants(resultants).unwrap();
    let coupling = ExactCoupling::new(length, elements, &section, &hub).unwrap();
    let mut planar = HubBeam::new(hub, coupling, &[length]);
    let properties = Properties::principal([2.8e7, 1.1e4, 1.4e4, 1.4e4], 1.2, [1.2e-3, 0.0, 0.0]);
    let root = Station { position: Vec3::ZERO, tangent: Vec3::AXES[0], normal: Vec3::AXES[1] };
    let mut model = Model::new();
    let beam = Flexible::new("beam", Beam::straight(root, length, elements, properties).unwrap());
    let beam = model.beam(beam);
    let to = Marker::new(Part::Section { beam, node: 0 }, [0.0; 3]);
    let joint = Joint::new("hub", Kind::Revolute, Marker::new(Part::Ground, [0.0; 3]), to);
    model.joint(joint.driven(Drive::Prescribed(motion)));
    let mut spatial = Multibody::new(model).unwrap();
    let blow = |system: &mut dyn System| {
        let mut before = system.initial();
        (before.t, before.side) = (1.0, Side::Left);
        let mut after = before.clone();
        after.side = Side::Right;
        let mut p = vec![0.0; before.v.len() + before.lambda.len()];
        assert!(system.impulse(&before, &mut p));
        let impact = ImpactMap::new(system).strike(system, &mut after, &p, Bounds::default()).unwrap();
        let work = system.impulse_work(&before, &after) + impact.work;
        [system.energy(&after).kinetic, work]
    };
    let (plane, space) = (blow(&mut planar), blow(&mut spatial));
    // Less than that of the rigid beam, ½ (m L²/3) ω².
    let rigid = 0.5 * 1.2 * length * length * length / 3.0 * omega * omega;
    assert!(plane[0] > 1e-6 * rigid && plane[0] < rigid, "{plane:?} {rigid}");
    for x in [plane[1], space[0], space[1]] {
        assert!((x / plane[0] - 1.0).abs() < 1e-10, "{plane:?} {space:?}");
    }
}

/// A driven arm with a free one at its end, which strikes a wall: the drive holds its speed and works in the impact.
#[test]
fn a_driven_joint_works_in_an_impact() {
    let mut model = Model::new();
    let first = model.body(Body::new("first", 1.0, [0.1; 3]).at([0.5, 0.0, 0.0]));
    let second = model.body(Body::new("second", 1.0, [0.1; 3]).at([1.5, 0.0, 0.0]));
    let joint = model.join("motor", Kind::Revolute, [Part::Ground, first], [0.0; 3], Z).unwrap();
    joint.drive = Drive::Prescribed(speed("1"));
    model.join("elbow", Kind::Revolute, [first, second], [1.0, 0.0, 0.0], Z).unwrap();
    let point = model.contact_point(Marker::new(second, [0.5, 0.0, 0.0]));
    // The free arm begins with the motion of least energy that the hinge asks for: its tip moves down.
    let wall = Plane { point: Vec3([0.0, -0.1, 0.0]), normal: Vec3::AXES[1], motion: None };
    let law = Law::Constraint { restitution: 0.5, friction: 0.0 };
    let contact = Contact { name: "tip".into(), point, obstacle: Arc::new(wall), law };
    let mut system = Contacting::new(Multibody::new(model).unwrap(), vec![contact]);
    let (_, watch) = super::contacts::run(&mut system, &radau(1e-9), 1.0, None);
    assert!(watch.events.iter().any(|event| matches!(event.kind, EventKind::Impact { .. })));
    assert!(watch.imbalance < 1e-7, "{}", watch.imbalance);
}
