//! Statics of slender beams in space: paths, critical loads, closed forms.

use super::conformance::profile;
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::path::{Critical, Plan, Point, follow};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Axes, Drive, Flexible, Kind, LineLoad, Load, Marker, Model, Multibody, Part};
use flexion::profile::Motion;
use flexion::system::{Dynamics, Frame, Observed, Steady};
use std::f64::consts::PI;

/// A cantilever of length 1 along x, n along y, with a load at its tip.
fn cantilever(elements: usize, stiffness: [f64; 4], axes: Axes, [force, moment]: [[f64; 3]; 2]) -> Multibody {
    let root =
        Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]) };
    let section = Properties::principal(stiffness, 1.0, [1e-6; 3]);
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("beam", Beam::straight(root, 1.0, elements, section).unwrap()));
    let part = |node| Part::Section { beam, node };
    model
        .join("root", Kind::Fixed, [Part::Ground, part(0)], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None))
        .unwrap();
    let at = Marker::new(part(elements), [0.0; 3]);
    model.load(Load {
        name: "tip".into(),
        at,
        force: Vec3(force),
        moment: Vec3(moment),
        axes,
        amplitude: None,
    });
    Multibody::new(model).unwrap()
}

fn tip(system: &mut Multibody, s: &flexion::system::State) -> [f64; 3] {
    let mut frame = [Frame::default()];
    system.frames(0, s, &[1.0], &mut frame);
    frame[0].position.0
}

/// The points of the path up to the load factor 1, with the place of the tip.
fn path(system: &mut Multibody, plan: &Plan) -> Vec<(Point, Vec3)> {
    let (mut points, start) = (Vec::new(), system.initial());
    let mut frame = [Frame::default()];
    let end = follow(system, &start, plan, |system, point| {
        system.frames(0, &point.state, &[1.0], &mut frame);
        points.push((point.clone(), frame[0].position));
        !point.arrived
    });
    system.release();
    end.unwrap();
    points
}

fn critical(points: &[(Point, Vec3)]) -> Vec<(Critical, f64)> {
    points.iter().filter_map(|(p, _)| p.critical.map(|critical| (critical, p.factor))).collect()
}

/// A bar of length 1 whose tip is rotated about its axis, slowly: φ = 4 rad is more than one element can be twisted by. In two the torque is
/// GJ φ + N K² φ with the tension N = ½ EA K² φ² of fibres that both ends hold.
#[test]
fn an_element_is_not_twisted_beyond_half_a_turn() {
    for (elements, expected) in [(1, None), (2, Some(2.0 * 4.0 + 0.5 * 6.0 * 6.0 / 1e6 * 64.0))] {
        let root = Station { position: Vec3::ZERO, tangent: Vec3::AXES[0], normal: Vec3::AXES[1] };
        let section = Properties::principal([1e6, 2.0, 3.0, 3.0], 1.0, [0.01; 3]);
        let mut model = Model::new();
        let beam = model.beam(Flexible::new("bar", Beam::straight(root, 1.0, elements, section).unwrap()));
        let part = |node| Part::Section { beam, node };
        let x = (Vec3::AXES[0].0, None);
        model.join("clamp", Kind::Fixed, [Part::Ground, part(0)], [0.0; 3], x).unwrap();
        let tip = [Part::Ground, part(elements)];
        model.join("tip", Kind::Revolute, tip, [1.0, 0.0, 0.0], x).unwrap().drive =
            Drive::Prescribed(Motion::Angle(profile("4*min(t, 1)")));
        let mut system = Multibody::new(model).unwrap();
        let mut s = system.initial();
        let mut reached = Ok(());
        for k in 1..=40 {
            s.t = f64::from(k) / 40.0;
            if let Err(error) = equilibrium(&mut system, &mut s) {
                reached = Err(error.to_string());
                break;
            }
        }
        match expected {
            Some(torque) => {
                reached.unwrap();
                let found = super::channel(&mut system, &s, "tip.torque");
                assert!((found - torque).abs() < 1e-9, "{found} for {torque}");
            }
            None => assert!(reached.clone().is_err_and(|said| said.contains("half a turn")), "{reached:?}"),
        }
    }
}

/// w(L) = 11 p₀ L⁴/(120 EI) under p₀ s/L, and p₀ (L⁴/8 − b⁴/8 − b³ (L − b)/6)/EI under p₀ from b to L; nodes of cubic elements are exact.
#[test]
fn distributed_loads_bend_a_cantilever_by_their_closed_forms() {
    let (length, bending, load) = (2.0_f64, 3.0, 1e-5);
    let triangle = 11.0 / 120.0 * load * length.powi(4) / bending;
    let (all, begin) = (length.powi(4) / 8.0, 0.5_f64);
    let part = load * (all - begin.powi(4) / 8.0 - begin.powi(3) * (length - begin) / 6.0) / bending;
    for (axes, distribution, elements, expected) in [
        (Axes::Dead, Some("t/2"), None, triangle),
        (Axes::Follower, Some("t/2"), None, triangle),
        (Axes::Dead, None, Some(1..4), part),
        (Axes::Follower, Some("if(t < 0.5, 0, 1)"), None, part),
    ] {
        let root = Station { position: Vec3::ZERO, tangent: Vec3::AXES[0], normal: Vec3::AXES[1] };
        let section = Properties::principal([1e4, 2.0, bending, bending], 1.0, [1e-3, 0.0, 0.0]);
        let mut model = Model::new();
        let beam = model.beam(Flexible::new("beam", Beam::straight(root, length, 4, section).unwrap()));
        let clamped = Part::Section { beam, node: 0 };
        let z = ([0.0, 0.0, 1.0], None);
        model.join("clamp", Kind::Fixed, [Part::Ground, clamped], [0.0; 3], z).unwrap();
        let distribution = distribution.map(profile);
        let force = load * Vec3::AXES[1];
        model.line_load(LineLoad {
            name: "pressure".into(),
            beam,
            elements,
            distribution,
            force,
            axes,
            amplitude: None,
        });
        let mut system = Multibody::new(model).unwrap();
        let mut s = system.initial();
        equilibrium(&mut system, &mut s).unwrap();
        let mut tip = [Frame::default()];
        system.frames(0, &s, &[length], &mut tip);
        let found = tip[0].position[1];
        assert!((found / expected - 1.0).abs() < 1e-6, "{axes:?}: {found} for {expected}");
    }
}

#[test]
fn a_couple_rolls_the_beam_up_at_every_load() {
    let moment = [[0.0; 3], [0.0, 0.0, 2.0 * PI]];
    let mut system = cantilever(40, [1e8, 0.7, 1.0, 1.0], Axes::Follower, moment);
    let points = path(&mut system, &Plan::to(1.0));
    let mut worst: f64 = 0.0;
    for (point, Vec3([x, y, z])) in points.iter().filter(|(point, _)| point.factor > 0.0) {
        let curvature = 2.0 * PI * point.factor;
        let (sin, cos) = curvature.sin_cos();
        let [along, across] = [sin / curvature, (1.0 - cos) / curvature];
        worst = worst.max((x - along).abs()).max((y - across).abs()).max(z.abs());
    }
    assert!(points.len() > 10 && worst < 1e-5, "{worst:e} at {} points", points.len());
}

/// A column bent far past its buckling load: with α the angle of its tip and k = sin ½α, P = K² EI/L², x = (2E/K − 1) L and
/// z = (2k/K) L (Timoshenko & Gere, *Theory of Elastic Stability*, section 2.7).
#[test]
fn a_column_past_its_buckling_load_takes_the_shape_of_the_elastica() {
    for angle in [60.0_f64, 120.0] {
        let k = (0.5 * angle.to_radians()).sin();
        let [first, second] = elliptic(k);
        let load = first * first;
        let mut system = cantilever(24, [1e8, 0.7, 1.0, 1e3], Axes::Dead, [[-load, 0.0, 1e-5], [0.0; 3]]);
        let points = path(&mut system, &Plan { longest: 0.1, ..Plan::to(1.0) });
        let (last, Vec3([x, y, z])) = points.last().unwrap();
        assert!(last.stability.as_ref().unwrap().is_stable(), "{:?}", last.stability);
        let expected = [2.0 * second / first - 1.0, 2.0 * k / first];
        let found = [x - expected[0], z - expected[1], *y];
        assert!(found.iter().all(|d| d.abs() < 5e-5), "{angle}°: ({x}, {z}) for {expected:?}");
    }
}

/// Complete elliptic integrals K and E of the modulus k, by means.
fn elliptic(k: f64) -> [f64; 2] {
    let (mut a, mut b, mut c, mut sum, mut power) = (1.0, (1.0 - k * k).sqrt(), k, 0.5 * k * k, 1.0);
    while c > 1e-16 {
        (a, b, c) = (0.5 * (a + b), f64::sqrt(a * b), 0.5 * (a - b));
        sum += power * c * c;
        power *= 2.0;
    }
    let first = 0.5 * PI / a;
    [first, first * (1.0 - sum)]
}

/// Dead force across the tip, P L²/EI: (w/L, u/L), at the slenderness 1e4.
#[test]
fn a_very_slender_beam_under_a_dead_force_does_not_lock() {
    for (load, across, along) in [
        (1.0, 0.301721, 0.056433),
        (2.0, 0.493457, 0.160642),
        (4.0, 0.669964, 0.328941),
        (10.0, 0.810609, 0.554996),
    ] {
        let mut system = cantilever(32, [12e8, 0.7, 1.0, 1.0], Axes::Dead, [[0.0, load, 0.0], [0.0; 3]]);
        let mut s = system.initial();
        equilibrium(&mut system, &mut s).unwrap();
        let [x, y, _] = tip(&mut system, &s);
        assert!((y - across).abs() < 2e-6 && (1.0 - x - along).abs() < 2e-6, "{load}: ({x}, {y})");
    }
}

/// A force that stays across the tip: from the tip inwards κ′ = −F cos θ/EI, θ′ = κ is a problem of initial values.
#[test]
fn a_follower_force_bends_the_beam_past_its_turning_point() {
    let load = 24.0;
    let mut system = cantilever(40, [1e8, 0.7, 1.0, 1.0], Axes::Follower, [[0.0, load, 0.0], [0.0; 3]]);
    let points = path(&mut system, &Plan { longest: 0.1, ..Plan::to(1.0) });
    let expected = |force: f64| {
        // s from the tip; θ, κ, and the place against the axes of the tip.
        let rates = |[angle, curvature, ..]: [f64; 4]| {
            let (sin, cos) = angle.sin_cos();
            [curvature, -force * cos, cos, sin]
        };
        let n = 4000;
        let h = 1.0 / n as f64;
        let mut y = [0.0; 4];
        for _ in 0..n {
            let at = |k: [f64; 4], c: f64| std::array::from_fn(|i| y[i] + c * h * k[i]);
            let k1 = rates(y);
            let k2 = rates(at(k1, 0.5));
            let k3 = rates(at(k2, 0.5));
            let k4 = rates(at(k3, 1.0));
            y = std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        }
        // Seen from the root, whose tangent points to the tip.
        let [angle, _, x, y] = y;
        let (sin, cos) = angle.sin_cos();
        [cos * x + sin * y, sin * x - cos * y]
    };
    let (mut worst, mut largest): (f64, f64) = (0.0, 0.0);
    for (point, Vec3([x, y, z])) in &points {
        let [along, across] = expected(load * point.factor);
        worst = worst.max((x - along).abs()).max((y.abs() - across.abs()).abs()).max(z.abs());
        largest = largest.max(y.abs());
    }
    let last = points.last().unwrap().1[1].abs();
    assert!(last < largest - 0.1, "no turning point: {last} of {largest}");
    assert!(worst < 2e-5, "{worst:e}");
}

/// Beck's column: 20.0509 EI/L² in the plane in which it is softer.
#[test]
fn becks_column_flutters() {
    let force = [[-30.0, 0.0, 0.0], [0.0; 3]];
    let mut system = cantilever(12, [1e6, 50.0, 1.0, 3.0], Axes::Follower, force);
    let found = critical(&path(&mut system, &Plan::to(1.0)));
    assert!(found[0].0 == Critical::Flutter && (found[0].1 * 30.0 / 20.0509 - 1.0).abs() < 1e-4, "{found:?}");
}

/// Prandtl's load 4.0126 √(EI₂ GJ)/L², raised by what the strip bends edgewise in proportion to EI₂/EI₃.
#[test]
fn a_strip_buckles_sideways_where_the_path_branches() {
    let torsion = 0.6_f64;
    let load = |ratio: f64| {
        let force = [[0.0, 6.0 * torsion.sqrt(), 0.0], [0.0; 3]];
        let mut system = cantilever(16, [1e6 * ratio, torsion, 1.0, ratio], Axes::Dead, force);
        let found = critical(&path(&mut system, &Plan::to(1.0)));
        assert_eq!(found[0].0, Critical::Branching);
        6.0 * found[0].1
    };
    let [soft, stiff] = [1e3, 1e4].map(load);
    let limit = stiff - (soft - stiff) / 9.0;
    assert!((limit - 4.012_599_3).abs() < 1e-4, "{limit} from {soft} and {stiff}");
}
