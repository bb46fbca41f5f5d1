//! Beams in a frame that rotates: their modes against series, the planar beam, and the blade.

use super::blades::{Setting, blade, frequencies};
use super::{odd_body, odd_rotation, wave};
use crate::integrators::drive::fixed;
use flexion::analysis::campbell::{HubState, Plan, campbell};
use flexion::analysis::modes::modes;
use flexion::analysis::rotation::{NoRotation, rotate_stably};
use flexion::analysis::superposition::{Vibration, superpose};
use flexion::drive::Actuator;
use flexion::exact::rotating::flapwise_frequency;
use flexion::hub_beam::{self, ExactCoupling, FreeHub, Hub, HubBeam};
use flexion::integrator::{Radau, Tolerance};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{
    self, Axes, Axis, Body, Drive, Flexible, Kind, Load, Marker, Model, Multibody, Part, Rotating,
};
use flexion::profile::{Constant, Motion};
use flexion::section::{BladeResultants, BladeSection, Resultants, Uniform};
use flexion::system::{Dynamics, Frame, Observed, Parameter, State, Steady, System};
use num_complex::Complex64;
use std::sync::Arc;

const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// ρA = EI₂ = L = 1, slender, and far stiffer in the plane of rotation and in torsion.
fn flat() -> BladeResultants {
    BladeResultants {
        mass: 1.0,
        axial_stiffness: 1e9,
        flap_stiffness: 1.0,
        chord_stiffness: 1e6,
        torsional_stiffness: 1e4,
        flap_inertia: 1e-9,
        chord_inertia: 1e-9,
        ..BladeResultants::default()
    }
}

#[test]
fn flapwise_frequencies_are_those_of_wright() {
    // Far from the axis the deflection is all in a narrow layer at the root.
    for (speed, radius, off) in
        [(0.0, 0.0, 1e-6), (3.0, 0.0, 1e-6), (12.0, 0.0, 1e-6), (4.0, 1.0, 1e-6), (12.0, 5.0, 1e-5)]
    {
        let setting = Setting { length: 1.0, hub_radius: radius, ..Setting::default() };
        let found = frequencies(&mut blade(setting, &flat(), 56), speed, 3);
        for (k, found) in found.iter().enumerate() {
            let expected = flapwise_frequency(k + 1, speed, radius);
            assert!((found / expected - 1.0).abs() < off, "γ {speed}, a {radius}: {found} for {expected}");
        }
    }
}

/// In the plane of rotation: with gyroscopic coupling, the planar beam of exact geometry.
#[test]
fn chordwise_frequencies_are_those_of_the_planar_beam() {
    let section =
        BladeResultants { axial_stiffness: 4900.0, flap_stiffness: 1e6, chord_stiffness: 1.0, ..flat() };
    let planar = Uniform::from_resultants(Resultants {
        mass: 1.0,
        axial_stiffness: 4900.0,
        bending_stiffness: 1.0,
        ..Resultants::default()
    });
    let planar = planar.unwrap();
    for (speed, radius) in [(4.0, 0.0), (10.0, 0.1)] {
        let profile = Arc::new(Constant::new(0.0).unwrap());
        let hub = Hub::prescribed(radius, 0.0, Motion::Speed { profile, initial_angle: 0.0 });
        let coupling = ExactCoupling::new(1.0, 40, &planar, &hub).unwrap();
        let mut planar = HubBeam::new(hub, coupling, &[]);
        let mut at_rest = State::zeros(planar.size(), 0.0);
        rotate_stably(&mut planar, &mut at_rest, 0.0, speed).unwrap();
        let expected = modes(&mut planar, &at_rest, 3, &[]).unwrap();
        let setting = Setting { length: 1.0, hub_radius: radius, ..Setting::default() };
        let found = frequencies(&mut blade(setting, &section, 40), speed, 3);
        for (found, expected) in found.iter().zip(&expected.modes) {
            let expected = expected.frequency();
            assert!((found / expected - 1.0).abs() < 1e-6, "γ {speed}: {found} for {expected}");
        }
    }
}

/// A motor that is off, with a spring and a damper.
fn restraint(stiffness: f64, damping: f64) -> Actuator {
    Actuator {
        torque: Arc::new(Constant::new(0.0).unwrap()),
        damping,
        stiffness,
        rest_angle: 0.0,
        controller: None,
    }
}

/// Eigenvalues in steady rotation with the hub held at first, and free or held then.
fn eigenvalues(system: &mut dyn System, free: bool, count: usize) -> Vec<Complex64> {
    let mut s = system.initial();
    rotate_stably(system, &mut s, 0.0, 4.0).unwrap();
    if free {
        system.hold(false);
        s.v = system.initial().v;
    }
    let found = modes(system, &s, count, &[]).unwrap();
    found.modes.iter().map(|mode| mode.eigenvalue).collect()
}

/// P1's beam on a hub that rotates with it, free, on a spring, and with a damper: the joint whose angle is kept meanwhile is let go
/// for the modes. Across the plane the beam in space is so stiff that its lowest modes are those in the plane.
#[test]
fn a_joint_that_is_let_go_vibrates_as_the_free_hub_in_the_plane() {
    let (length, radius, inertia) = (10.0, 0.5, 150.0);
    let resultants =
        Resultants { mass: 1.2, axial_stiffness: 2.8e7, bending_stiffness: 1.4e4, ..Resultants::default() };
    let section = Properties::principal([2.8e7, 1e7, 1.4e8, 1.4e4], 1.2, [1e-3, 0.0, 0.0]);
    for (stiffness, damping) in [(0.0, 0.0), (900.0, 0.0), (900.0, 40.0)] {
        let actuator = restraint(stiffness, damping);
        let free = FreeHub { angle: 0.0, speed: 0.0, actuator: actuator.clone() };
        let hub = Hub { radius, inertia, drive: hub_beam::Drive::Free(free) };
        let uniform = Uniform::from_resultants(resultants).unwrap();
        let coupling = ExactCoupling::new(length, 40, &uniform, &hub).unwrap();
        let mut planar = HubBeam::new(hub, coupling, &[]);

        let mut model = Model::new();
        let hub = model.body(Body::new("hub", 3.0, [0.7 * inertia, 0.7 * inertia, inertia]));
        let root = Station {
            position: Vec3([radius, 0.0, 0.0]),
            tangent: Vec3([1.0, 0.0, 0.0]),
            normal: Vec3([0.0, 1.0, 0.0]),
        };
        let beam = Beam::straight(root, length, 40, section).unwrap();
        let beam = model.beam(Flexible::new("beam", beam));
        let clamped = Part::Section { beam, node: 0 };
        model.join("clamp", Kind::Fixed, [hub, clamped], root.position, (Vec3(Z), None)).unwrap();
        let hinge = model
            .join("hinge", Kind::Revolute, [Part::Ground, hub], Vec3([0.0; 3]), (Vec3(Z), None))
            .unwrap();
        hinge.drive = multibody::Drive::Actuated(actuator);
        model.keep_angle("hinge");
        let axis = Axis::new([0.0; 3], Z).unwrap();
        let mut spatial = Rotating::new(Multibody::new(model).unwrap(), axis);

        for free in [false, true, false] {
            let expected = eigenvalues(&mut planar, free, 4);
            let found = eigenvalues(&mut spatial, free, 4);
            for (found, expected) in found.iter().zip(&expected) {
                let close = (found - expected).norm() <= 1e-6 * expected.norm();
                assert!(close, "k {stiffness}, c {damping}, free {free}: {found} for {expected}");
            }
            assert_eq!(found[0].norm() == 0.0, free && stiffness == 0.0);
            assert_eq!(found[0].re < 0.0, free && damping > 0.0);
        }
    }
}

/// Twist, taper, pitch, precone and a body at the tip.
#[derive(Debug)]
struct General;

impl BladeSection for General {
    fn resultants(&self, x: f64) -> BladeResultants {
        let taper = 1.0 - 0.4 * x;
        BladeResultants {
            mass: taper,
            axial_stiffness: 3e4 * taper,
            flap_stiffness: taper * taper,
            chord_stiffness: 9.0 * taper * taper,
            torsional_stiffness: 0.8 * taper,
            flap_inertia: 1e-4 * taper,
            chord_inertia: 1e-4 * taper,
            twist: 0.5 - 0.6 * x,
            twist_rate: -0.6,
        }
    }
}

/// By cubic elements for small vibrations about the steady state of a blade, coded apart with another energy and other unknowns: 48 of
/// them, which leave 1e-6 of the fifth frequency.
#[test]
fn a_general_blade_has_the_frequencies_of_another_formulation() {
    for (precone, tip, speed, expected) in [
        (0.0, [0.0; 2], 0.0, [3.9341659, 11.1897221, 22.1725833, 51.0667430, 69.2095960]),
        (0.0, [0.0; 2], 6.0, [7.6883661, 12.6690327, 27.3955861, 55.5313311, 72.3743586]),
        (0.05, [0.3, 0.004], 0.0, [2.28370259, 6.37891747, 12.4514615, 14.3666756, 28.7862921]),
        (0.05, [0.3, 0.004], 6.0, [6.28024329, 8.74961035, 12.1942860, 22.0428341, 34.8930267]),
    ] {
        let setting = Setting { length: 1.0, hub_radius: 0.2, precone, pitch: 0.1, tip };
        let found = frequencies(&mut blade(setting, &General, 48), speed, 5);
        for (found, expected) in found.iter().zip(&expected) {
            assert!(
                (found / expected - 1.0).abs() < 1e-6,
                "precone {precone}, Ω {speed}: {found} for {expected}"
            );
        }
    }
}

/// Torsion of a rotating strip: with the tension N = ½ ρA Ω² (R² − X²) and the propeller moment, i of the inertia per length and
/// c = (i_c − i_f)/i,
///
/// ```text
/// ((GJ + N K²) φ′)′ + i (ω² − c Ω²) φ = 0,   b² = R² + 2 GJ/(ρA K² Ω²):   ((b² − X²) φ′)′ + 2 (ω²/Ω² − c) φ = 0
/// ```
///
/// for a homogeneous section, i = ρA K². φ = Σ cₙ Xⁿ with b² (n + 1)(n + 2) cₙ₊₂ = (n (n + 1) − 2 (ω²/Ω² − c)) cₙ.
#[test]
fn a_rotating_strip_twists_against_its_tension() {
    let (speed, radius) = (30.0_f64, 0.1_f64);
    let strip = BladeResultants {
        mass: 1.0,
        axial_stiffness: 1e8,
        flap_stiffness: 1e3,
        chord_stiffness: 1e5,
        torsional_stiffness: 0.5,
        flap_inertia: 1e-5,
        chord_inertia: 1e-3,
        ..BladeResultants::default()
    };
    let polar = 1.01e-3;
    let outer = radius + 1.0;
    let square = outer * outer + 2.0 * strip.torsional_stiffness / (polar * speed * speed);
    // φ′ at the tip of the motion that is 0 at the root.
    let slope = |frequency: f64| {
        let of = 2.0 * ((frequency / speed).powi(2) - 0.99 / 1.01);
        let solution = |begin: usize| {
            let (mut value, mut slope, mut c) = (0.0, 0.0, 1.0);
            for n in (begin..400).step_by(2) {
                let n = n as f64;
                value += c * radius.powf(n);
                slope += if n > 0.0 { c * n * outer.powf(n - 1.0) } else { 0.0 };
                c *= (n * (n + 1.0) - of) / (square * (n + 1.0) * (n + 2.0));
            }
            [value, slope]
        };
        let [even, odd] = [0, 1].map(solution);
        even[0] * odd[1] - odd[0] * even[1]
    };
    let (mut low, mut high) = (30.0, 60.0);
    assert!(slope(low) * slope(high) < 0.0);
    while high - low > 1e-12 {
        let middle = 0.5 * (low + high);
        if slope(low) * slope(middle) > 0.0 { low = middle } else { high = middle }
    }
    let setting = Setting { length: 1.0, hub_radius: radius, ..Setting::default() };
    let found = frequencies(&mut blade(setting, &strip, 12), speed, 1)[0];
    // The strain N/EA = 5e-6 of the axis is left out of the closed form.
    assert!((found / low - 1.0).abs() < 1e-5, "{found} for {low}");
}

/// A beam on a hub that is driven at 6 rad/s begins in its steady rotation with its first mode, which is flapwise: the tip moves by
/// A cos ωt out of the plane, and nothing else moves in the frame of the hub.
#[test]
fn a_motion_begins_with_a_steady_rotation_and_its_modes() {
    let (speed, amplitude, length) = (6.0, 1e-3, 1.0);
    let section = Properties::principal([3e4, 0.8, 1.0, 9.0], 1.0, [1e-3, 0.0, 0.0]);
    let root = Station { position: Vec3([0.2, 0.0, 0.0]), tangent: Vec3::AXES[0], normal: Vec3::AXES[1] };
    let mut model = Model::new();
    let hub = model.body(Body::new("hub", 1.0, [0.1; 3]));
    let beam = model.beam(Flexible::new("beam", Beam::straight(root, length, 8, section).unwrap()));
    model.join("hinge", Kind::Revolute, [Part::Ground, hub], [0.0; 3], (Z, None)).unwrap().drive =
        Drive::Prescribed(Motion::Speed {
            profile: Arc::new(Constant::new(speed).unwrap()),
            initial_angle: 0.0,
        });
    let clamp = [hub, Part::Section { beam, node: 0 }];
    model.join("clamp", Kind::Fixed, clamp, root.position, (Z, None)).unwrap();
    let mut moving = Multibody::new(model.clone()).unwrap();
    let axis = model.axis_of("hinge").unwrap();
    model.keep_angle("hinge");
    let mut frame = Rotating::new(Multibody::new(model).unwrap(), axis);
    let mut s = frame.initial();
    rotate_stably(&mut frame, &mut s, 0.0, speed).unwrap();
    let steady = frame.in_space(&s);
    let found =
        superpose(&mut frame, &mut s, &[Vibration { displacement: amplitude, velocity: 0.0 }], length)
            .unwrap();
    let begin = frame.in_space(&s);
    let place = |system: &mut Multibody, s: &State| {
        let mut tip = [Frame::default()];
        system.frames(1, s, &[length], &mut tip);
        let angle = speed * s.t;
        let Vec3([x, y, z]) = tip[0].position;
        [x * angle.cos() + y * angle.sin(), y * angle.cos() - x * angle.sin(), z]
    };
    let period = std::f64::consts::TAU / found[0].frequency();
    let method = Radau::new(Tolerance::uniform(1e-9)).unwrap();
    let still = place(&mut moving, &steady);
    let mut of = |begin: &State, end: f64| {
        let end = fixed(&method, &mut moving, begin.clone(), end, 200, |_, _, _, _| {}).unwrap();
        place(&mut moving, &end)
    };
    for k in 0..3 {
        assert!((of(&steady, period)[k] - still[k]).abs() < 1e-9);
    }
    for (part, expected) in [(0.25, 0.0), (0.5, -amplitude), (1.0, amplitude)] {
        let [x, y, z] = of(&begin, part * period);
        assert!((z - expected).abs() < 2e-4 * amplitude, "{part}: {z} for {expected}");
        // The foreshortening is A²/L by order.
        assert!((x - still[0]).abs() < 2.0 * amplitude * amplitude && y.abs() < 1e-2 * amplitude, "{x} {y}");
    }
}

#[test]
fn a_campbell_diagram_of_a_spatial_beam_follows_its_modes() {
    let setting = Setting { length: 1.0, hub_radius: 0.1, ..Setting::default() };
    let speeds: Vec<f64> = (0..=6).map(|i| 2.0 * f64::from(i)).collect();
    let plan = Plan { speeds, count: 3, stations: Vec::new(), hub: HubState::Held, revolutions: 2 };
    let diagram = campbell(Box::new(blade(setting, &flat(), 16)), &plan, |_| true).unwrap();
    for (k, branch) in diagram.branches.iter().enumerate() {
        for point in &branch.points {
            let expected = flapwise_frequency(k + 1, point.speed, 0.1);
            assert!((point.mode.frequency() / expected - 1.0).abs() < 1e-4);
        }
    }
    assert!(diagram.instabilities.is_empty() && !diagram.crossings.is_empty());
}

/// The tangents are the differences of the residual, for bodies and beams, about any axis.
#[test]
fn the_tangents_are_those_of_the_residual() {
    let mut model = Model::new();
    let body = model.body(odd_body("hub", 0.3));
    let at = [0.3, 0.2, -0.1];
    let turned = odd_rotation(0.7);
    let axes = [0, 1].map(|j| [0, 1, 2].map(|i| turned[i][j]));
    let root = Station { position: Vec3(at), tangent: Vec3(axes[0]), normal: Vec3(axes[1]) };
    let section = Properties::principal([400.0, 1.1, 0.9, 1.6], 1.2, [0.03, 0.012, 0.018]);
    let beam = model.beam(Flexible::new("arm", Beam::straight(root, 0.9, 2, section).unwrap()).damped(0.3));
    model
        .join("clamp", Kind::Fixed, [body, Part::Section { beam, node: 0 }], Vec3(at), (Vec3(Z), None))
        .unwrap();
    let mut system = Rotating::new(
        Multibody::new(model).unwrap(),
        Axis::new([0.1, -0.3, 0.2], turned * Vec3([0.3, 0.5, 0.8])).unwrap(),
    );
    system.set(Parameter::Speed, 2.3).unwrap();
    let mut s = system.initial();
    let n = s.v.len();
    let d: Vec<f64> = (0..n).map(|i| 0.05 * wave(i, 0.4)).collect();
    let from = s.q.clone();
    system.retract(&from, &d, &mut s.q);
    s.lambda.iter_mut().enumerate().for_each(|(i, x)| *x = wave(i, 0.9));
    let mut matrix = flexion::linalg::Matrix::new(&system.structure(0));
    let step = 1e-5;
    for (q, v) in [(1.0, 0.0), (0.0, 1.0)] {
        system.tangent(&s, flexion::system::Weights::new(0.0, v, q), &mut matrix);
        for j in 0..n {
            let mut at = |sign: f64| {
                let (mut moved, mut r) = (s.clone(), vec![0.0; n]);
                let mut d = vec![0.0; n];
                d[j] = sign * step;
                system.retract(&s.q, &d.iter().map(|x| q * x).collect::<Vec<_>>(), &mut moved.q);
                moved.v.iter_mut().zip(&d).for_each(|(x, d)| *x += v * d);
                system.residual(&moved, &mut r);
                r
            };
            let (ahead, behind) = (at(1.0), at(-1.0));
            for i in 0..n {
                let expected = (ahead[i] - behind[i]) / (2.0 * step);
                let found = matrix.get(i, j);
                assert!((found - expected).abs() < 2e-5, "({i}, {j}) for q {q}: {found} for {expected}");
            }
        }
    }
}

#[test]
fn a_load_that_keeps_its_direction_in_space_is_refused() {
    let mut model = Model::new();
    let part = model.body(Body::new("rotor", 1.0, [0.1; 3]));
    model.join("shaft", Kind::Fixed, [Part::Ground, part], Vec3([0.0; 3]), (Vec3(Z), None)).unwrap();
    let load = |force| Load {
        name: "wind".into(),
        at: Marker::new(part, [0.0; 3]),
        force,
        moment: Vec3([0.0; 3]),
        axes: Axes::Dead,
        amplitude: None,
    };
    let mut along = model.clone();
    along.load(load(Vec3([0.0, 0.0, 3.0])));
    model.load(load(Vec3([1.0, 0.0, 3.0])));
    let rotate = |model| {
        let mut system = Rotating::new(Multibody::new(model).unwrap(), Axis::new([0.0; 3], Z).unwrap());
        let mut s = system.initial();
        rotate_stably(&mut system, &mut s, 0.0, 2.0).map(|_| ())
    };
    rotate(along).unwrap();
    let Err(NoRotation::Lost { source, .. }) = rotate(model) else { panic!("it rotates") };
    assert!(source.to_string().contains("`wind`"), "{source}");
}
