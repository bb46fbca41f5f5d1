//! Beams that turn: through half a turn, in flight, about an axis under gravity, and in a closed loop.

use super::conformance::profile;
use super::{channel, radau, run};
use crate::integrators::drive::fixed;
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::rotation::rotate_stably;
use flexion::drive::Actuator;
use flexion::integrator::GeneralizedAlpha;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{
    Axes, Axis, Body, Drive, Flexible, Joint, Kind, Load, Marker, Model, Multibody, Part, Rotating,
};
use flexion::profile::Motion;
use flexion::system::{Dynamics, Frame, Observed, State};
use std::f64::consts::PI;

const Z: [f64; 3] = [0.0, 0.0, 1.0];

fn part(beam: usize, node: usize) -> Part {
    Part::Section { beam, node }
}

fn along_x(length: f64, elements: usize, section: Properties) -> Beam {
    let root =
        Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 0.8, 0.6]) };
    Beam::straight(root, length, elements, section).unwrap()
}

fn tip(system: &mut Multibody, s: &State) -> Frame {
    let mut frame = [Frame::default()];
    system.frames(0, s, &[1.0], &mut frame);
    frame[0]
}

/// Where a smallest rotation from the axes of the start has no direction: the tip stands at 180° to them, by a couple that bends it there, and
/// by a hinge that turns it there and stops. n and b of the section are those turned by half a turn about z.
#[test]
fn half_a_turn_is_an_angle_like_any_other() {
    let section = Properties::principal([1e6, 0.7, 1.0, 1.0], 1.0, [1e-6; 3]);
    let half = [[-1.0, 0.0, 0.0], [0.0, -0.8, 0.6], [0.0, 0.6, 0.8]];
    let turned = |frame: Frame, allowed: f64| {
        let far = |i: usize| (0..3).map(|j| (frame.rotation[i][j] - half[i][j]).abs()).fold(0.0, f64::max);
        let far = (0..3).map(far).fold(0.0, f64::max);
        assert!(far < allowed, "{far:e}: {frame:?}");
    };
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("beam", along_x(1.0, 32, section)));
    model.join("root", Kind::Fixed, [Part::Ground, part(beam, 0)], Vec3([0.0; 3]), (Vec3(Z), None)).unwrap();
    let at = Marker::new(part(beam, 32), [0.0; 3]);
    let moment = [0.0, 0.0, PI];
    model.load(Load {
        name: "couple".into(),
        at,
        force: Vec3([0.0; 3]),
        moment: Vec3(moment),
        axes: Axes::Dead,
        amplitude: None,
    });
    let mut system = Multibody::new(model).unwrap();
    let mut s = system.initial();
    equilibrium(&mut system, &mut s).unwrap();
    let frame = tip(&mut system, &s);
    turned(frame, 1e-5);
    let Vec3([x, y, z]) = frame.position;
    assert!(x.abs() < 1e-5 && (y - 2.0 / PI).abs() < 1e-5 && z.abs() < 1e-9, "{frame:?}");

    let mut model = Model::new();
    let damped = Flexible::new("beam", along_x(1.0, 6, section)).damped(8.0);
    let beam = model.beam(damped);
    let ends = [Part::Ground, part(beam, 0)].map(|part| Marker::new(part, [0.0; 3]));
    let space = |part| {
        model.marker(
            part,
            Frame { position: Vec3([0.0; 3]), rotation: Mat3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], Z]) },
        )
    };
    let ends = [space(ends[0].part).unwrap(), space(ends[1].part).unwrap()];
    let motion = Motion::Angle(profile("if(t < 1, pi*t - sin(2*pi*t)/2, pi)"));
    let [from, to] = ends;
    model.joint(Joint::new("hinge", Kind::Revolute, from, to).driven(Drive::Prescribed(motion)));
    let mut system = Multibody::new(model).unwrap();
    let (s, imbalance) = run(&mut system, &radau(1e-9), 8.0, None, |_, _| {});
    let frame = tip(&mut system, &s);
    turned(frame, 1e-6);
    let Vec3([x, y, z]) = frame.position;
    assert!((x + 1.0).abs() < 1e-6 && y.abs() < 1e-6 && z.abs() < 1e-9, "{frame:?}");
    assert!(imbalance < 1e-4, "{imbalance:e}");
}

/// The flying beam of Simo & Vu-Quoc (1988, doi 10.1016/0045-7825(88)90073-4) under the parts of its loads that lie in its plane: it stays
/// there, and has the momenta that force and couple gave, to 1e-10.
#[test]
fn a_beam_that_flies_in_a_plane_stays_in_it() {
    let section = Properties::principal([1e4, 500.0, 500.0, 500.0], 1.0, [20.0, 10.0, 10.0]);
    let root = Station {
        position: Vec3([6.0, 0.0, 0.0]),
        tangent: Vec3([-0.6, 0.8, 0.0]),
        normal: Vec3([-0.8, -0.6, 0.0]),
    };
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("beam", Beam::straight(root, 10.0, 6, section).unwrap()));
    model.load(Load {
        name: "push".into(),
        at: Marker::new(part(beam, 0), [0.0; 3]),
        force: Vec3([20.0, 0.0, 0.0]),
        moment: Vec3([0.0, 0.0, -200.0]),
        axes: Axes::Dead,
        amplitude: Some(profile("if(t < 0.5, t/0.5, if(t < 1, 2 - t/0.5, 0))")),
    });
    let mut system = Multibody::new(model).unwrap();
    let method = radau(1e-10);
    let start = system.initial();
    let middle = fixed(&method, &mut system, start, 1.0, 400, |_, _, _, _| {}).unwrap();
    let s = fixed(&method, &mut system, middle.clone(), 1.0, 400, |_, _, _, _| {}).unwrap();
    let ([p, l], [earlier, before]) = (system.momenta(&s), system.momenta(&middle));
    // While loads act what iterations leave of a force is lost.
    assert!((earlier[0] - 10.0).abs() < 1e-8 && earlier[1].abs() < 1e-8 && p[2] == 0.0, "{earlier:?}");
    let changed = (0..2).map(|i| (p[i] - earlier[i]).abs()).fold(0.0, f64::max);
    println!("momenta: {earlier:?} by the loads, changed by {changed:e}, {:e}", l[2] - before[2]);
    assert!(changed < 1e-10 * earlier[0], "{p:?} for {earlier:?}");
    assert!(l[2].abs() > 50.0 && (l[2] - before[2]).abs() < 1e-10 * l[2].abs(), "{l:?} for {before:?}");
    assert!(system.energy(&s).strain > 1.0, "{:?}", system.energy(&s));
    assert_eq!(channel(&mut system, &s, "beam.tip.position.z"), 0.0);
}

/// A beam that sags under its weight is spun up about the vertical: it comes to rest, in the axes that rotate, in the equilibrium of the
/// system in a rotating frame, which has other equations.
#[test]
fn a_spin_up_across_gravity_ends_in_steady_rotation() {
    let section = Properties::principal([1e5, 1.0, 2.0, 4.0], 1.0, [2e-4, 1e-4, 1e-4]);
    let (elements, speed) = (6, 3.0);
    let build = |drive: Drive| {
        let mut model = Model::new().with_gravity([0.0, 0.0, -4.0]);
        let beam = model.beam(Flexible::new("beam", along_x(1.0, elements, section)).viscous(0.05));
        let ground = Part::Ground;
        let space = |part| {
            model.marker(
                part,
                Frame { position: Vec3([0.0; 3]), rotation: Mat3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], Z]) },
            )
        };
        let (from, to) = (space(ground).unwrap(), space(part(beam, 0)).unwrap());
        model.joint(Joint::new("hinge", Kind::Revolute, from, to).driven(drive));
        model
    };
    let formula = format!("if(t < 2, {speed}*(t/2 - sin(pi*t)/(2*pi)), {speed})");
    let driven = Motion::Speed { profile: profile(&formula), initial_angle: 0.0 };
    let mut system = Multibody::new(build(Drive::Prescribed(driven))).unwrap();
    let end = 16.0;
    let (s, _) = run(&mut system, &radau(1e-8), end, None, |_, _| {});
    // The speed has the mean ½ until 2 s.
    let angle: f64 = speed * (end - 1.0);
    let (sin, cos) = angle.sin_cos();
    let Vec3([x, y, z]) = tip(&mut system, &s).position;
    let found = [cos * x + sin * y, cos * y - sin * x, z];
    let mut held = build(Drive::None);
    held.keep_angle("hinge");
    let mut steady = Rotating::new(Multibody::new(held).unwrap(), Axis::new([0.0; 3], Z).unwrap());
    let mut s = steady.initial();
    equilibrium(&mut steady, &mut s).unwrap();
    rotate_stably(&mut steady, &mut s, 0.0, speed).unwrap();
    let mut frame = [Frame::default()];
    steady.frames(0, &s, &[1.0], &mut frame);
    let expected = frame[0].position;
    assert!(expected[2] < -0.1, "{expected:?}");
    for k in 0..3 {
        assert!((found[k] - expected[k]).abs() < 1e-5, "{found:?} for {expected:?}");
    }
}

/// Bauchau's four-bar (1998, doi 10.1023/A:1009710818135): crank and follower of 0.12 m, coupler of 0.24 m, and the axis of the third hinge 5°
/// off the others. Rigid bars lock; these bend and twist. No printed number is at hand: two meshes agree, two methods, and the energy.
#[test]
fn a_four_bar_with_a_crooked_hinge_turns_by_bending() {
    let steel = |width: f64| {
        let (modulus, square): (f64, f64) = (207e9, width * width);
        let second = square * square / 12.0;
        let density = 7850.0;
        Properties::principal(
            [
                modulus * square,
                modulus / 2.6 * 0.140577 * square * square,
                modulus * second,
                modulus * second,
            ],
            density * square,
            [2.0 * density * second, density * second, density * second],
        )
    };
    let build = |elements: usize| {
        let mut model = Model::new();
        let mut bar = |name: &str, from: [f64; 3], tangent: [f64; 3], length, section| {
            let root = Station { position: Vec3(from), tangent: Vec3(tangent), normal: Vec3(Z) };
            model.beam(Flexible::new(name, Beam::straight(root, length, elements, section).unwrap()))
        };
        let crank = bar("crank", [0.0; 3], [0.0, 1.0, 0.0], 0.12, steel(0.016));
        let coupler = bar("coupler", [0.0, 0.12, 0.0], [1.0, 0.0, 0.0], 0.24, steel(0.016));
        let follower = bar("follower", [0.24, 0.12, 0.0], [0.0, -1.0, 0.0], 0.12, steel(0.008));
        let space = |part, place| {
            model
                .marker(
                    part,
                    Frame { position: place, rotation: Mat3([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], Z]) },
                )
                .unwrap()
        };
        let (from, to) = (space(Part::Ground, Vec3([0.0; 3])), space(part(crank, 0), Vec3([0.0; 3])));
        // 0.6 rad/s after a second: two thirds of a turn in 8 s.
        let drive = Drive::Prescribed(Motion::Speed {
            profile: profile("if(t < 1, 0.6*(t - sin(2*pi*t)/(2*pi)), 0.6)"),
            initial_angle: 0.0,
        });
        model.joint(Joint::new("A", Kind::Revolute, from, to).driven(drive));
        let (sin, cos) = (5.0_f64).to_radians().sin_cos();
        for (name, ends, place, axis) in [
            ("B", [part(crank, elements), part(coupler, 0)], [0.0, 0.12, 0.0], Z),
            ("C", [part(coupler, elements), part(follower, 0)], [0.24, 0.12, 0.0], [0.0, sin, cos]),
            ("D", [Part::Ground, part(follower, elements)], [0.24, 0.0, 0.0], Z),
        ] {
            model.join(name, Kind::Revolute, ends, Vec3(place), (Vec3(axis), None)).unwrap();
        }
        Multibody::new(model).unwrap()
    };
    let follow = |elements: usize, alpha: bool| {
        let mut system = build(elements);
        let mut path = Vec::new();
        let mut values = vec![0.0; system.channels().len()];
        let at = ["coupler.tip.position.z", "A.torque"]
            .map(|name| system.channels().iter().position(|c| c.name == name).unwrap());
        let record = |system: &mut dyn flexion::system::System, s: &State| {
            system.record(s, &mut values);
            path.push([s.t, values[at[0]], values[at[1]]]);
        };
        let dissipative = GeneralizedAlpha::chung_hulbert(0.6).unwrap();
        let (_, imbalance) = if alpha {
            run(&mut system, &dissipative, 8.0, Some(4e-3), record)
        } else {
            run(&mut system, &radau(1e-6), 8.0, None, record)
        };
        println!("{elements} elements, {alpha}: imbalance {imbalance:e}");
        path
    };
    let (coarse, fine, alpha) = (follow(2, false), follow(4, false), follow(4, true));
    let largest = |k: usize| fine.iter().fold(0.0_f64, |m, row| m.max(row[k].abs()));
    for (what, other) in [("2 elements", &coarse), ("generalized-alpha", &alpha)] {
        for k in 1..3 {
            let pairs = fine.iter().zip(other);
            let far = pairs.fold(0.0_f64, |m, (a, b)| m.max((a[k] - b[k]).abs()));
            println!("{what}: {far:e} of {}", largest(k));
            assert!(far < 0.01 * largest(k), "{what}, {k}: {far:e} of {}", largest(k));
        }
    }
    // The coupler leaves the plane by millimetres.
    assert!(largest(1) > 1e-4, "{}", largest(1));
}

/// A rotor on the ground and another one on it, about parallel axes.
fn two_rotors(spins: [f64; 2], drive: Drive) -> Multibody {
    let mut model = Model::new();
    let rotor = |name: &str, spin: f64| {
        let mut body = Body::new(name, 1.0, [1.0 / 12.0, 1.0 / 12.0, 1.0 / 6.0]);
        body.spin = Some(Vec3([0.0, 0.0, spin]));
        body
    };
    let (a, b) = (model.body(rotor("a", spins[0])), model.body(rotor("b", spins[1])));
    model.join("first", Kind::Revolute, [Part::Ground, Part::Body(0)], [0.0; 3], (Z, None)).unwrap().drive =
        drive;
    assert_eq!((a, b), (Part::Body(0), Part::Body(1)));
    model.join("second", Kind::Revolute, [a, b], [0.0; 3], (Z, None)).unwrap();
    Multibody::new(model).unwrap()
}

/// Free rotors turn by Ω t, in steps and between records of many turns, forward and backward, and against each other.
#[test]
fn angles_count_every_turn_of_a_step() {
    let end = 100.0;
    let methods = || -> [(Box<dyn flexion::integrator::Integrator>, Option<f64>); 3] {
        [
            (Box::new(radau(1e-6)), None),
            (Box::new(GeneralizedAlpha::chung_hulbert(0.8).unwrap()), Some(0.73)),
            (Box::new(flexion::integrator::MoreauJean::new(0.5).unwrap()), Some(0.31)),
        ]
    };
    for spins in [[50.0, -70.0], [-50.0, 31.0], [400.0, 400.0], [0.01, 250.0]] {
        for (method, step) in methods() {
            let mut system = two_rotors(spins, Drive::None);
            run(&mut system, method.as_ref(), end, step, |system, s| {
                let mut row = vec![0.0; system.channels().len()];
                system.record(s, &mut row);
                let channels = system.channels();
                let at = |name: &str| row[channels.iter().position(|c| c.name == name).unwrap()];
                for (name, speed) in [("first.angle", spins[0]), ("second.angle", spins[1] - spins[0])] {
                    let exact = speed * s.t;
                    let far = (at(name) - exact).abs();
                    assert!(far < 1e-6 * (1.0 + exact.abs()), "{name} {} for {exact}, {step:?}", at(name));
                }
            });
        }
    }
}

/// A motor with the torque M and a damper c on J: θ = (M/c) (t − J/c (1 − e^(−ct/J))), 8337 rad; and a prescribed angle that goes forward and
/// back by 800 rad, with records farther apart than a turn.
#[test]
fn driven_angles_count_every_turn() {
    let actuator =
        Actuator { torque: profile("1"), damping: 0.01, stiffness: 0.0, rest_angle: 0.0, controller: None };
    let end = 100.0;
    let mut system = two_rotors([0.0, 0.0], Drive::Actuated(actuator));
    let (s, _) = run(&mut system, &radau(1e-8), end, None, |_, _| {});
    let lag = 100.0 / 6.0;
    let exact = 100.0 * (end - lag * (1.0 - (-end / lag).exp()));
    let found = channel(&mut system, &s, "first.angle");
    assert!((found - exact).abs() < 1e-5 * exact, "{found} for {exact}");

    let mut system = two_rotors([240.0, 240.0], Drive::Prescribed(Motion::Angle(profile("800*sin(0.3*t)"))));
    run(&mut system, &radau(1e-8), end, None, |system, s| {
        let mut row = vec![0.0; system.channels().len()];
        system.record(s, &mut row);
        let at = system.channels().iter().position(|c| c.name == "first.angle").unwrap();
        let exact = 800.0 * (0.3 * s.t).sin();
        assert!((row[at] - exact).abs() < 1e-6 * 800.0, "{} for {exact}", row[at]);
    });
}
