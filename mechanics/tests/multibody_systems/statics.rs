//! Equilibria and modes of systems with joints, against closed forms.

use super::{GRAVITY, channel, odd_body};
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::modes::modes;
use flexion::drive::Actuator;
use flexion::linalg::Vec3;
use flexion::multibody::rotation::about;
use flexion::multibody::{Body, Drive, Kind, Marker, Model, Multibody, Part, Spring};
use flexion::profile::Constant;
use flexion::system::{Dynamics, State};
use std::sync::Arc;

fn spring(stiffness: f64, rest_angle: f64) -> Drive {
    let torque = Arc::new(Constant::new(0.0).unwrap());
    Drive::Actuated(Actuator { torque, damping: 0.0, stiffness, rest_angle, controller: None })
}

/// A rod that lies along x is held by a spring in its hinge: k θ = ½ m g l cos θ, θ downward.
#[test]
fn a_rod_on_a_hinge_with_a_spring_sinks_to_its_equilibrium() {
    let (mass, length, stiffness) = (2.0, 1.2, 9.0);
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let rod = model.body(Body::new("rod", mass, [0.01, 0.24, 0.24]).at([0.5 * length, 0.0, 0.0]));
    let hinge = model.join(
        "hinge",
        Kind::Revolute,
        [Part::Ground, rod],
        Vec3([0.0; 3]),
        (Vec3([0.0, 1.0, 0.0]), None),
    );
    hinge.unwrap().drive = spring(stiffness, 0.0);
    let mut system = Multibody::new(model).unwrap();
    let mut s = system.initial();
    equilibrium(&mut system, &mut s).unwrap();
    let moment = 0.5 * mass * GRAVITY * length;
    let (mut low, mut high) = (0.0_f64, 1.5_f64);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if stiffness * middle < moment * middle.cos() { low = middle } else { high = middle }
    }
    let angle = channel(&mut system, &s, "hinge.angle");
    assert!((angle - low).abs() < 1e-12, "{angle} for {low}");
    assert!((channel(&mut system, &s, "hinge.force.z") - mass * GRAVITY).abs() < 1e-10);
    // Its small vibrations: (J + m l²/4) ω² = k + ½ m g l sin θ.
    let found = modes(&mut system, &s, 1, &[]).unwrap();
    let omega = ((stiffness + moment * low.sin()) / (0.24 + 0.25 * mass * length * length)).sqrt();
    assert!((found.modes[0].frequency() / omega - 1.0).abs() < 1e-10);
}

/// Two rods that hang: M = [[J + 5/4, ½], [½, J + ¼]] m l², K = diag(3/2, ½) m g l.
#[test]
fn a_double_pendulum_has_its_two_frequencies() {
    let inertia = 1.0 / 12.0;
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let y = ([0.0, 1.0, 0.0], None);
    let mut rod =
        |name: &str, z| model.body(Body::new(name, 1.0, [inertia, inertia, 0.001]).at([0.0, 0.0, z]));
    let (one, two) = (rod("one", -0.5), rod("two", -1.5));
    model.join("root", Kind::Revolute, [Part::Ground, one], [0.0; 3], y).unwrap();
    model.join("elbow", Kind::Revolute, [one, two], [0.0, 0.0, -1.0], y).unwrap();
    let mut system = Multibody::new(model).unwrap();
    let mut s = system.initial();
    equilibrium(&mut system, &mut s).unwrap();
    let found = modes(&mut system, &s, 2, &[]).unwrap();
    let (a, b, c) = (inertia + 1.25, 0.5, inertia + 0.25);
    let (k1, k2) = (1.5 * GRAVITY, 0.5 * GRAVITY);
    // (a c − b²) x² − (a k₂ + c k₁) x + k₁ k₂ = 0
    let (p, q) = (a * c - b * b, a * k2 + c * k1);
    let root = (q * q - 4.0 * p * k1 * k2).sqrt();
    for (mode, square) in found.modes.iter().zip([(q - root) / (2.0 * p), (q + root) / (2.0 * p)]) {
        assert!(
            (mode.frequency() / square.sqrt() - 1.0).abs() < 1e-10,
            "{} for {}",
            mode.frequency(),
            square.sqrt()
        );
        assert_eq!(mode.vector.len(), 12);
    }
    assert_eq!(found.counted, Some(2));
}

/// A chain of links between two supports: the slopes of the links are tan θᵢ = (Vᵢ + Vᵢ₊₁)/(2H), Vᵢ = w (n/2 − i), and the
/// span gives H. It begins on an arc of a circle.
#[test]
fn a_hanging_chain_finds_its_shape_and_its_tension() {
    let (n, length, mass) = (12, 0.25, 0.3);
    let heading = |i: usize| 0.9 - 1.8 * i as f64 / (n - 1) as f64;
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let (mut at, mut last) = ([0.0, 0.0], Part::Ground);
    for i in 0..n {
        let (sin, cos) = heading(i).sin_cos();
        let middle = [at[0] + 0.5 * length * cos, 0.0, at[1] - 0.5 * length * sin];
        let link = model.body(Body::new(&format!("link {i}"), mass, [0.01; 3]).at(middle));
        let hinge = ([0.0, 1.0, 0.0], None);
        model.join(&format!("hinge {i}"), Kind::Revolute, [last, link], [at[0], 0.0, at[1]], hinge).unwrap();
        at = [at[0] + length * cos, at[1] - length * sin];
        last = link;
    }
    let span = at[0];
    let hinge = ([0.0, 1.0, 0.0], None);
    model.join("support", Kind::Revolute, [Part::Ground, last], [at[0], 0.0, at[1]], hinge).unwrap();
    let mut system = Multibody::new(model.drop_redundant_rows()).unwrap();
    assert_eq!(system.freedoms(), n - 2);
    let mut s = system.initial();
    equilibrium(&mut system, &mut s).unwrap();
    let weight = mass * GRAVITY;
    let vertical = |i: usize| weight * (0.5 * n as f64 - i as f64);
    let slope = |i: usize, h: f64| (0.5 * (vertical(i) + vertical(i + 1)) / h).atan();
    let reach = |h: f64| (0..n).map(|i| length * slope(i, h).cos()).sum::<f64>();
    let (mut low, mut high) = (1e-3, 1e3);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if reach(middle) < span { low = middle } else { high = middle }
    }
    let force = ["x", "z"].map(|axis| channel(&mut system, &s, &format!("hinge 0.force.{axis}")));
    assert!((force[0] + low).abs() < 1e-8 && (force[1] - vertical(0)).abs() < 1e-8, "{force:?} for {low}");
    let (mut x, mut z) = (0.0, 0.0);
    for i in 0..n {
        let (sin, cos) = slope(i, low).sin_cos();
        let middle = [x + 0.5 * length * cos, z - 0.5 * length * sin];
        let found = ["x", "z"].map(|axis| channel(&mut system, &s, &format!("link {i}.position.{axis}")));
        assert!((found[0] - middle[0]).abs() < 1e-9 && (found[1] - middle[1]).abs() < 1e-9, "link {i}");
        (x, z) = (x + length * cos, z - length * sin);
    }
}

/// A body on six springs turns far to its equilibrium: all forces and moments then vanish, and a shaken state comes back.
#[test]
fn a_body_on_springs_finds_its_place_and_its_rotation() {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let mut body = odd_body("box", 0.4);
    (body.velocity, body.spin) = (None, None);
    let (centre, own) = (body.frame.position, body.frame.rotation);
    let part = model.body(body);
    for k in 0..8 {
        let sign = |bit: usize| if k >> bit & 1 == 0 { 1.0 } else { -1.0 };
        let corner = Vec3([0.4 * sign(0), 0.3 * sign(1), 0.2 * sign(2)]);
        let turned = own * (about([0.3, -0.5, 0.6]) * corner);
        let anchor = centre + 3.0 * turned;
        let [from, to] = [Marker::new(Part::Ground, anchor), Marker::new(part, corner)];
        model.spring(Spring {
            name: format!("spring {k}"),
            from,
            to,
            stiffness: 80.0,
            damping: 0.0,
            length: 0.4,
            directions: flexion::multibody::Directions::Line,
        });
    }
    let mut system = Multibody::new(model).unwrap();
    let mut s: State = system.initial();
    equilibrium(&mut system, &mut s).unwrap();
    let mut r = vec![0.0; 6];
    system.residual(&s, &mut r);
    assert!(r.iter().all(|r| r.abs() < 1e-9), "{r:?}");
    let found = modes(&mut system, &s, 6, &[]).unwrap();
    assert!(
        found.modes.iter().all(|mode| mode.frequency() > 1.0 && mode.eigenvalue.re == 0.0),
        "{:?}",
        found.modes
    );
    let mut moved = s.clone();
    system.retract(&s.q, &[0.05, -0.04, 0.03, 0.2, -0.1, 0.15], &mut moved.q);
    equilibrium(&mut system, &mut moved).unwrap();
    assert!(moved.q.iter().zip(&s.q).all(|(a, b)| (a - b).abs() < 1e-9));
}
