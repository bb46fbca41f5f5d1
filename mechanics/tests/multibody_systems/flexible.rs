//! Motions of beams in systems: against the planar program, closed forms and published values.

use super::conformance::profile;
use super::{channel, radau};
use crate::integrators::drive::fixed;
use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::hub_beam::{self, ExactCoupling, Hub, HubBeam};
use flexion::integrator::GeneralizedAlpha;
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Axes, Drive, Flexible, Joint, Kind, Load, Marker, Model, Multibody, Part};
use flexion::profile::{Motion, SpinUp};
use flexion::section::{Resultants, Uniform};
use flexion::system::{Dynamics, Observed, State, System};
use std::f64::consts::PI;
use std::sync::Arc;

const ALONG_X: Station =
    Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]) };

fn node(beam: usize, node: usize) -> Marker {
    Marker::new(Part::Section { beam, node }, [0.0; 3])
}

fn grounded(position: [f64; 3]) -> Marker {
    Marker::new(Part::Ground, position)
}

/// (w, u) of the tip in the hub's frame at every sample.
struct Tip<F>(Vec<[f64; 2]>, F);

impl<F: FnMut(&mut dyn System, &State) -> [f64; 2]> Observer for Tip<F> {
    fn sample(&mut self, system: &mut dyn System, state: &State, _: &Step) {
        self.0.push((self.1)(system, state));
    }
}

/// Wu & Haug's spin-up (doi 10.1002/nme.1620260202) in space and in the frame of the planar hub, with the exact coupling.
#[test]
fn a_beam_in_a_plane_moves_as_the_planar_program_says() {
    let motion = Motion::Speed { profile: Arc::new(SpinUp::new(4.0, 15.0).unwrap()), initial_angle: 0.0 };
    let hub = Hub { radius: 0.0, inertia: 0.0, drive: hub_beam::Drive::Prescribed(motion.clone()) };
    let resultants =
        Resultants { mass: 1.2, axial_stiffness: 2.8e7, bending_stiffness: 1.4e4, ..Default::default() };
    let section = Uniform::from_resultants(resultants).unwrap();
    let mut planar =
        HubBeam::new(hub.clone(), ExactCoupling::new(10.0, 10, &section, &hub).unwrap(), &[10.0]);
    let properties = Properties::principal([2.8e7, 1.1e4, 1.4e4, 1.4e4], 1.2, [1.2e-3, 0.0, 0.0]);
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("beam", Beam::straight(ALONG_X, 10.0, 10, properties).unwrap()));
    let joint = Joint::new("hub", Kind::Revolute, grounded([0.0; 3]), node(beam, 0));
    model.joint(joint.driven(Drive::Prescribed(motion.clone())));
    let mut spatial = Multibody::new(model).unwrap();
    let plan = Plan::new(20.0, 0.1);
    let value = |system: &mut dyn System, s: &State, name: &str| {
        let mut values = vec![0.0; system.channels().len()];
        system.record(s, &mut values);
        values[system.channels().iter().position(|c| c.name == name).unwrap()]
    };
    let mut of_planar = Tip(Vec::new(), |system: &mut dyn System, s: &State| {
        ["tip.deflection", "tip.axial"].map(|name| value(system, s, name))
    });
    let mut start = planar.initial();
    transient(&mut planar, &radau(1e-8), &mut start, &plan, &mut of_planar);
    let mut of_space = Tip(Vec::new(), |system: &mut dyn System, s: &State| {
        let [x, y] = ["x", "y"].map(|axis| value(system, s, &format!("beam.tip.position.{axis}")));
        let (sin, cos) = motion.at(s.t).angle.sin_cos();
        [cos * y - sin * x, cos * x + sin * y - 10.0]
    });
    let mut start = spatial.initial();
    transient(&mut spatial, &radau(1e-8), &mut start, &plan, &mut of_space);
    assert_eq!(of_space.0.len(), 201);
    let peak = of_planar.0.iter().fold(0.0_f64, |m, [w, _]| m.max(w.abs()));
    assert!((peak - 0.4).abs() < 1e-3);
    for (a, b) in of_space.0.iter().zip(&of_planar.0) {
        assert!((0..2).all(|k| (a[k] - b[k]).abs() < 1e-6 * peak), "{a:?} for {b:?}");
    }
}

/// A free beam under a force and a couple that end: its centre of mass has a closed form, and its momenta stay.
#[test]
fn a_flying_beam_keeps_its_momenta() {
    let section = Properties::principal([1e4, 500.0, 500.0, 500.0], 1.0, [20.0, 10.0, 10.0]);
    let root = Station {
        position: Vec3([6.0, 0.0, 0.0]),
        tangent: Vec3([-0.6, 0.8, 0.0]),
        normal: Vec3([-0.8, -0.6, 0.0]),
    };
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("beam", Beam::straight(root, 10.0, 6, section).unwrap()));
    let amplitude = "if(t < 0.5, t/0.5, if(t < 1, 2 - t/0.5, 0))";
    model.load(Load {
        name: "push".into(),
        at: node(beam, 0),
        force: Vec3([20.0, 0.0, 5.0]),
        moment: Vec3([0.0, 200.0, -200.0]),
        axes: Axes::Dead,
        amplitude: Some(profile(amplitude)),
    });
    let mut system = Multibody::new(model).unwrap();
    // Steps of 2.5 ms: an iteration error δ of a place is an error δ/h of a velocity.
    let method = radau(1e-10);
    let start = system.initial();
    let middle = fixed(&method, &mut system, start.clone(), 1.0, 400, |_, _, _, _| {}).unwrap();
    let s = fixed(&method, &mut system, middle.clone(), 1.0, 400, |_, _, _, _| {}).unwrap();
    let ([p, l], [_, before]) = (system.momenta(&s), system.momenta(&middle));
    let size = l.into_iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(size > 50.0 && system.energy(&s).strain > 1.0, "{l:?} {:?}", system.energy(&s));
    for (i, force) in [20.0, 0.0, 5.0].into_iter().enumerate() {
        // ∫f dt = ½.
        assert!((p[i] - 0.5 * force).abs() < 1e-9, "{p:?}");
        assert!((l[i] - before[i]).abs() < 1e-10 * size, "{l:?} for {before:?}");
    }
    // ∬f dt dt = ¼ until 1 s, and ½ a second from then on.
    let beam = Beam::straight(root, 10.0, 6, section).unwrap();
    let centre = |s: &State| beam.first_moment(&s.q).map(|x| x / beam.mass());
    let (from, to) = (centre(&start), centre(&s));
    for (i, force) in [20.0, 0.0, 5.0].into_iter().enumerate() {
        let moved = force / 10.0 * (0.25 + 0.5);
        assert!((to[i] - from[i] - moved).abs() < 1e-9, "{to:?} from {from:?}");
    }
}

/// Two legs that are welded to an elbow, pushed out of their plane (Simo & Vu-Quoc 1988, doi 10.1016/0045-7825(88)90073-4).
#[test]
fn an_elbow_swings_as_published() {
    let section = Properties::principal([1e6, 1e3, 1e3, 1e3], 1.0, [20.0, 10.0, 10.0]);
    let mut model = Model::new();
    let elements = 5;
    let first = model.beam(Flexible::new("first", Beam::straight(ALONG_X, 10.0, elements, section).unwrap()));
    let root = Station {
        position: Vec3([10.0, 0.0, 0.0]),
        tangent: Vec3([0.0, 1.0, 0.0]),
        normal: Vec3([-1.0, 0.0, 0.0]),
    };
    let second = model.beam(Flexible::new("second", Beam::straight(root, 10.0, elements, section).unwrap()));
    model.joint(Joint::new("clamp", Kind::Fixed, grounded([0.0; 3]), node(first, 0)));
    let parts = [Part::Section { beam: first, node: elements }, Part::Section { beam: second, node: 0 }];
    model.join("elbow", Kind::Fixed, parts, root.position, (Vec3([0.0, 0.0, 1.0]), None)).unwrap();
    model.load(Load {
        name: "push".into(),
        at: node(first, elements),
        force: Vec3([0.0, 0.0, 50.0]),
        moment: Vec3([0.0; 3]),
        axes: Axes::Dead,
        amplitude: Some(profile("if(t < 1, t, if(t < 2, 2 - t, 0))")),
    });
    let mut system = Multibody::new(model).unwrap();
    let (mut highest, mut lowest) = ((0.0_f64, 0.0), (0.0_f64, 0.0));
    let method = GeneralizedAlpha::chung_hulbert(0.8).unwrap();
    let mut path = Tip(Vec::new(), |_: &mut dyn System, s: &State| [s.t, s.q[s.q.len() - 7]]);
    let plan = Plan::new(18.0, 0.01).with_step(0.01);
    let mut start = system.initial();
    transient(&mut system, &method, &mut start, &plan, &mut path);
    for [t, z] in path.0 {
        if z > highest.0 {
            highest = (z, t);
        }
        if z < lowest.0 {
            lowest = (z, t);
        }
    }
    assert!((highest.0 - 8.25).abs() < 0.05 && (highest.1 - 7.44).abs() < 0.1, "{highest:?}");
    assert!((lowest.0 + 9.73).abs() < 0.1 && (lowest.1 - 15.87).abs() < 0.15, "{lowest:?}");
}

/// A shaft between two spherical joints spins about its axis and is struck across: (ρA + ρI k²) ω² ∓ 2 ρI k² Ω ω = EI k⁴ has the
/// frequencies of the forward and the backward whirl, k = π/L.
#[test]
fn a_spinning_shaft_whirls_by_its_closed_form() {
    let (elements, spin, rotary) = (8, 50.0, 0.01);
    let section = Properties::principal([1e4, 1.0, 1.0, 1.0], 1.0, [2.0 * rotary, rotary, rotary]);
    let mut shaft = Flexible::new("shaft", Beam::straight(ALONG_X, 1.0, elements, section).unwrap());
    shaft.spin = Some(Vec3([spin, 0.0, 0.0]));
    shaft.stations = vec![0.5];
    let mut model = Model::new();
    let beam = model.beam(shaft);
    model.joint(Joint::new("first", Kind::Spherical, grounded([0.0; 3]), node(beam, 0)));
    model.joint(Joint::new("last", Kind::Spherical, grounded([1.0, 0.0, 0.0]), node(beam, elements)));
    let mut system = Multibody::new(model).unwrap();
    let mut s = system.initial();
    let speed = 1e-5;
    for i in 0..=elements {
        let x = PI * i as f64 / elements as f64;
        s.v[8 * i + 1] += speed * x.sin();
        s.v[8 * i + 4] += speed * PI * x.cos();
    }
    let k2 = PI * PI;
    let (inertia, gyro) = (1.0 + rotary * k2, rotary * k2 * spin);
    let root = (gyro * gyro + inertia * k2 * k2).sqrt();
    let (forward, backward) = ((root + gyro) / inertia, (root - gyro) / inertia);
    assert!(forward > 2.0 * backward);
    let plan = Plan::new(3.0, 0.05);
    let mut path = Tip(Vec::new(), |system: &mut dyn System, s: &State| {
        let mut values = vec![0.0; system.channels().len()];
        system.record(s, &mut values);
        [values[1], values[2]]
    });
    transient(&mut system, &radau(1e-9), &mut s, &plan, &mut path);
    assert_eq!(path.0.len(), 61);
    let amplitude = speed / (forward + backward);
    for (i, found) in path.0.into_iter().enumerate() {
        let t = 0.05 * i as f64;
        // y + i z = V/(i (ω₁ + ω₂)) (exp iω₁t − exp −iω₂t)
        let exact = [
            amplitude * ((forward * t).sin() + (backward * t).sin()),
            amplitude * ((backward * t).cos() - (forward * t).cos()),
        ];
        let far = (found[0] - exact[0]).hypot(found[1] - exact[1]);
        assert!(far < 2e-3 * amplitude, "{t}: {found:?} for {exact:?}");
    }
}

/// A cantilever of 10,000 elements: a band with the multipliers of its clamp inside.
#[test]
fn a_long_beam_is_a_narrow_band() {
    let section = Properties::principal([1e4, 1.0, 1.0, 1.0], 1.0, [0.01; 3]);
    let stored = |elements: usize| {
        let mut model = Model::new();
        let beam = Beam::straight(ALONG_X, elements as f64, elements, section).unwrap();
        let beam = model.beam(Flexible::new("beam", beam));
        model.joint(Joint::new("clamp", Kind::Fixed, grounded([0.0; 3]), node(beam, 0)));
        let system = Multibody::new(model).unwrap();
        let structure = system.structure(1);
        assert_eq!(structure.border(), 0);
        assert!(structure.half_bandwidth() <= 15, "{structure:?}");
        flexion::linalg::Matrix::<f64>::new(&structure).storage().entries().len()
    };
    let bytes = 8.0 * (stored(10_000) - stored(5_000)) as f64 / 5_000.0;
    assert!(bytes < 2000.0, "{bytes} bytes an element");
    let mut model = Model::new();
    let beam = Beam::straight(ALONG_X, 1.0, 2, section).unwrap();
    model.beam(Flexible::new("beam", beam));
    let mut system = Multibody::new(model).unwrap();
    let s = system.initial();
    assert!((channel(&mut system, &s, "beam.tip.position.x") - 1.0).abs() < 1e-15);
}

/// A beam that is rolled up to a full turn and back within 0.5 s: a whip, in which the tip reaches ten times the speed of bending
/// waves of the beam's own length. The energy that the couple gives is the beam's, and twice as many elements agree at first.
#[test]
fn a_whip_keeps_its_balance_of_energy() {
    let (stiffness, mass) = (0.0933, 0.0108);
    let whipped = |elements: usize| {
        let section =
            Properties::principal([2.8e5, 0.0605, stiffness, stiffness], mass, [7.2e-9, 3.6e-9, 3.6e-9]);
        let mut model = Model::new();
        let beam =
            model.beam(Flexible::new("beam", Beam::straight(ALONG_X, 1.0, elements, section).unwrap()));
        model.joint(Joint::new("clamp", Kind::Fixed, grounded([0.0; 3]), node(beam, 0)));
        model.load(Load {
            name: "couple".into(),
            at: node(beam, elements),
            force: Vec3([0.0; 3]),
            moment: Vec3([0.0, 0.0, 2.0 * PI * stiffness]),
            axes: Axes::Dead,
            amplitude: Some(profile("if(t < 1, sin(pi*t), 0)")),
        });
        let mut system = Multibody::new(model).unwrap();
        let mut watch = Balance::default();
        let plan = Plan::new(1.5, 0.05);
        let mut state = system.initial();
        let ending = transient(&mut system, &radau(1e-6), &mut state, &plan, &mut watch);
        assert_eq!(ending, Ending::Finished, "{elements} elements");
        watch
    };
    let [coarse, fine] = [12, 24].map(whipped);
    for watch in [&coarse, &fine] {
        assert!(watch.imbalance < 1e-3 * watch.most, "{:e} J of {:e} J", watch.imbalance, watch.most);
    }
    let apart = |until: f64| {
        let pairs = coarse.tips.iter().zip(&fine.tips).filter(|(a, _)| a[0] <= until);
        pairs.fold(0.0_f64, |m, (a, b)| m.max((a[1] - b[1]).abs()))
    };
    assert!(apart(0.8) < 0.02, "{} m until 0.8 s", apart(0.8));
}

/// Largest energy, error of its balance, and y of the tip.
#[derive(Default)]
struct Balance {
    most: f64,
    imbalance: f64,
    tips: Vec<[f64; 2]>,
}

impl Observer for Balance {
    fn wants_energy_balance(&self) -> bool {
        true
    }
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        let energy = system.energy(state).total();
        self.most = self.most.max(energy);
        self.imbalance = self.imbalance.max(step.balance.map_or(0.0, |of| of.imbalance(energy).abs()));
        self.tips.push([state.t, state.q[state.q.len() - 8]]);
    }
}
