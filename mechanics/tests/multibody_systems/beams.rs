//! Beams as parts, slender and with shear: conformance with every joint and load, and the layout of chains.

use super::conformance::{profile, tangent_follows_the_increment};
use super::{GRAVITY, odd_body, odd_rotation, radau, run, wave};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{
    self, Axes, Flexible, Joint, Kind, LineLoad, Load, Marker, Model, Multibody, Part, Spring, shear,
};
use flexion::system::{Dynamics, Frame, Observed, State};
use flexion::verify::dynamics;

/// An arc with a pretwist whose root is where the marker of `part` is.
pub fn arc(elements: usize, root: Frame) -> Beam {
    let axis = |j: usize| [0, 1, 2].map(|i| root.rotation[i][j]);
    let [t, n, b] = [0, 1, 2].map(axis);
    let combine = |x: f64, y: f64, z: f64| [0, 1, 2].map(|i| x * t[i] + y * n[i] + z * b[i]);
    let curve = |s: f64| {
        let (sin, cos) = (0.7 * s).sin_cos();
        let (sine, cosine) = (0.3 * s).sin_cos();
        let place = combine(sin / 0.7, (1.0 - cos) / 0.7, 0.0);
        Station {
            position: Vec3([0, 1, 2].map(|i| root.position[i] + place[i])),
            tangent: Vec3(combine(cos, sin, 0.0)),
            normal: Vec3(combine(-sin * cosine, cos * cosine, sine)),
        }
    };
    let section = Properties::principal([400.0, 1.1, 0.9, 1.6], 1.2, [0.03, 0.012, 0.018]);
    let nodes: Vec<f64> = (0..=elements).map(|i| 1.1 * i as f64 / elements as f64).collect();
    Beam::new(&nodes, curve, |_| section).unwrap()
}

/// The same arc as a beam with shear, all of whose strains and motions are coupled.
pub fn sheared_arc(elements: usize, root: Frame) -> shear::Beam {
    let slender = multibody::Beam::from(arc(4 * elements, root));
    let curve = |s: f64| {
        let at = slender.node(0, slender.initial());
        let (sin, cos) = (0.7 * s).sin_cos();
        let (sine, cosine) = (0.3 * s).sin_cos();
        let place = at.rotation * Vec3([sin / 0.7, (1.0 - cos) / 0.7, 0.0]);
        let axes = [[cos, sin, 0.0], [-sin * cosine, cos * cosine, sine], [sin * sine, -cos * sine, cosine]];
        let rotation = at.rotation * flexion::linalg::Mat3(axes).transpose();
        Frame { position: at.position + place, rotation }
    };
    let section =
        flexion::section::Matrices::principal([400.0, 90.0, 70.0, 1.1, 0.9, 1.6], 1.2, [0.03, 0.012, 0.018])
            .with_tension_centre([0.02, -0.03])
            .with_shear_centre([-0.01, 0.02])
            .with_mass_centre([0.05, 0.03])
            .with_damping_times([0.01, 0.02, 0.03, 0.01, 0.005, 0.02])
            .rolled(0.4);
    let ends: Vec<f64> = (0..=elements).map(|i| 1.1 * i as f64 / elements as f64).collect();
    shear::Beam::new(&ends, curve, |_| section).unwrap()
}

fn somewhere(k: f64) -> Frame {
    Frame { position: Vec3([wave(1, k), wave(2, k), wave(3, k)]), rotation: odd_rotation(k) }
}

fn system(kind: Kind, has_shear: [bool; 2]) -> Multibody {
    with_loads(kind, has_shear, true)
}

/// Ground – body – beam – beam – body, with a spring, loads of every kind, those along beams if `along`, and damping.
fn with_loads(kind: Kind, has_shear: [bool; 2], along: bool) -> Multibody {
    let mut model = Model::new().with_gravity([1.0, 2.0, -GRAVITY]);
    let body = model.body(odd_body("hub", 0.3));
    let end = model.body(odd_body("end", 1.7));
    let root = Frame { position: Vec3([0.4, -0.2, 0.3]), rotation: odd_rotation(0.8) };
    let beam = |name, elements, root, has_shear: bool| {
        if has_shear {
            Flexible::new(name, sheared_arc(elements, root))
        } else {
            Flexible::new(name, arc(elements, root))
        }
    };
    let mut first = beam("first", 3, root, has_shear[0]).damped(0.4);
    let last = first.beam.nodes().len() - 1;
    (first.velocity, first.spin) = (Some(Vec3([0.3, -0.2, 0.5])), Some(Vec3([0.7, -0.4, 0.9])));
    let next = first.beam.node(last, first.beam.initial());
    let at = next.position;
    let first = model.beam(first);
    let second = model.beam(beam("second", 2, next, has_shear[1]).viscous(0.02));
    let section = |beam, node| Part::Section { beam, node };
    let mut join = |name: &str, kind, parts, point, k: usize| {
        let axis = ([wave(k, 0.1), wave(k, 1.2), wave(k, 2.3)], Some(Vec3([0.3, 1.0, 0.2])));
        model.join(name, kind, parts, point, axis).unwrap();
    };
    join("hinge", Kind::Revolute, [Part::Ground, body], Vec3([0.1, 0.2, 0.3]), 1);
    join("clamp", Kind::Fixed, [body, section(first, 0)], root.position, 2);
    join("elbow", kind, [section(first, last), section(second, 0)], at, 3);
    // Off the centreline, at a node within.
    join("tail", kind, [section(second, 1), end], Vec3([0.2, 0.9, -0.4]), 4);
    let marker = |part, k| Marker {
        part,
        frame: Frame { position: somewhere(k).position.map(|x| 0.2 * x), ..somewhere(k) },
    };
    for (name, parts, k) in [
        ("to ground", [Part::Ground, section(first, 1)], 0.1),
        ("between", [section(second, 2), section(first, 2)], 1.3),
    ] {
        let [from, to] = [marker(parts[0], k), marker(parts[1], k + 0.4)];
        model.spring(Spring {
            name: name.into(),
            from,
            to,
            stiffness: 7.0,
            damping: 0.8,
            length: 0.3,
            directions: flexion::multibody::Directions::Line,
        });
    }
    for (name, axes) in [("dead", Axes::Dead), ("follower", Axes::Follower)] {
        model.load(Load {
            name: name.to_owned(),
            at: marker(section(second, 2), 0.6),
            force: Vec3([1.0, -2.0, 0.7]),
            moment: Vec3([0.4, 0.9, -1.1]),
            axes,
            amplitude: Some(profile("1 + t")),
        });
        if !along {
            continue;
        }
        model.line_load(LineLoad {
            elements: (axes == Axes::Dead).then_some(1..2),
            name: format!("{name} along"),
            distribution: Some(profile("1 + 0.5*sin(3*t)")),
            beam: first,
            force: Vec3([0.8, 0.3, -0.9]),
            axes,
            amplitude: Some(profile("1 - t")),
        });
    }
    Multibody::new(model).unwrap()
}

fn disturb(s: &mut State) {
    s.a.iter_mut().enumerate().for_each(|(i, a)| *a = 3.0 * wave(i, 4.0));
    s.lambda.iter_mut().enumerate().for_each(|(i, x)| *x = 2.0 * wave(i, 5.0));
}

/// Which of the two beams have shear.
const SHEARS: [[bool; 2]; 3] = [[false, false], [true, true], [true, false]];

const KINDS: [Kind; 5] = [Kind::Fixed, Kind::Revolute, Kind::Universal, Kind::Spherical, Kind::Cylindrical];

/// Deformed and moving, but where the constraints hold, so that the power is compared too.
#[test]
fn a_system_of_beams_and_bodies_conforms_in_motion() {
    for (kind, has_shear) in KINDS.into_iter().flat_map(|kind| SHEARS.map(|shears| (kind, shears))) {
        let mut system = system(kind, has_shear);
        let (mut s, _) = run(&mut system, &radau(1e-7), 0.1, None, |_, _| {});
        disturb(&mut s);
        assert_eq!(dynamics(&mut system, &s), [], "{kind:?} {has_shear:?}");
    }
}

/// The power of what is drawn, by the trapezoidal rule over its places, whose velocities are differences.
#[test]
fn forces_per_length_that_are_drawn_do_the_work_of_their_loads() {
    for shears in SHEARS {
        let mut loaded = system(Kind::Revolute, shears);
        let mut unloaded = with_loads(Kind::Revolute, shears, false);
        let (mut s, _) = run(&mut loaded, &radau(1e-7), 0.1, None, |_, _| {});
        disturb(&mut s);
        let power = loaded.power(&s).loads - unloaded.power(&s).loads;
        let places = |system: &mut Multibody, s: &State| -> Vec<Vec<Vec3>> {
            let all = system.line_forces(s);
            all.iter().map(|line| line.points.iter().map(|[place, _]| *place).collect()).collect()
        };
        let first = loaded.initial();
        let initial = places(&mut loaded, &first);
        let moved = [1e-5, -1e-5].map(|by| {
            let d: Vec<f64> = s.v.iter().map(|v| by * v).collect();
            let mut moved = s.clone();
            loaded.retract(&s.q, &d, &mut moved.q);
            places(&mut loaded, &moved)
        });
        let mut drawn = 0.0;
        for (k, line) in loaded.line_forces(&s).iter().enumerate() {
            let speed = |i: usize| 5e4 * (moved[0][k][i] - moved[1][k][i]);
            let density: Vec<f64> =
                line.points.iter().enumerate().map(|(i, [_, force])| force.dot(speed(i))).collect();
            for i in 1..density.len() {
                let length = (initial[k][i] - initial[k][i - 1]).norm();
                drawn += 0.5 * length * (density[i] + density[i - 1]);
            }
        }
        assert!((drawn / power - 1.0).abs() < 5e-3, "{shears:?}: {drawn} {power}");
    }
}

#[test]
fn a_system_of_beams_and_bodies_conforms_anywhere() {
    for (kind, has_shear) in KINDS.into_iter().flat_map(|kind| SHEARS.map(|shears| (kind, shears))) {
        let mut system = system(kind, has_shear);
        let mut s = system.initial();
        let d: Vec<f64> = (0..s.v.len()).map(|i| 0.2 * wave(i, 0.7)).collect();
        let q = s.q.clone();
        system.retract(&q, &d, &mut s.q);
        s.v.iter_mut().enumerate().for_each(|(i, v)| *v = wave(i, 2.1));
        disturb(&mut s);
        let mut defects = dynamics(&mut system, &s);
        defects.retain(|d| d.check != "dE/dt");
        assert_eq!(defects, [], "{kind:?} {has_shear:?}");
    }
}

/// Newton's tangent by the increment of a step: ∂r/∂d at q₀ ⊞ d, d not small.
#[test]
fn the_tangent_of_beams_follows_the_increment_of_a_step() {
    for has_shear in SHEARS {
        let mut system = system(Kind::Revolute, has_shear);
        let mut from = system.initial();
        disturb(&mut from);
        tangent_follows_the_increment(&mut system, &from, 0.25, 3e-6);
    }
}

/// A clamp holds a motion of its body alone, and lets r′ grow.
#[test]
fn a_clamp_has_six_rows() {
    let mut model = Model::new();
    let root = Frame { position: Vec3([0.0; 3]), rotation: odd_rotation(0.2) };
    let beam = model.beam(Flexible::new("beam", arc(4, root)));
    let part = Part::Section { beam, node: 0 };
    let [from, to] = [Marker { part: Part::Ground, frame: root }, Marker::new(part, [0.0; 3])];
    model.joint(Joint::new("clamp", Kind::Fixed, from, to));
    let system = Multibody::new(model).unwrap();
    assert_eq!(system.freedoms(), 4 * 8 + 7 - 6);
}
