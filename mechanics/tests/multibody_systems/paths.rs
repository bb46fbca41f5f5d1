//! Paths of equilibria and their stability, against closed forms.

use flexion::analysis::equilibrium::{equilibrium, stable_equilibrium};
use flexion::analysis::modes::modes;
use flexion::analysis::path::{Critical, PathEnd, Plan, Point, follow};
use flexion::analysis::stability;
use flexion::drive::Actuator;
use flexion::linalg::Vec3;
use flexion::multibody::{Axes, Body, Drive, Kind, Load, Marker, Model, Multibody, Part, Spring};
use flexion::profile::Constant;
use flexion::system::{Dynamics, Parameter, Steady};
use std::ops::ControlFlow;
use std::sync::Arc;

fn spring(stiffness: f64) -> Drive {
    let torque = Arc::new(Constant::new(0.0).unwrap());
    Drive::Actuated(Actuator { torque, damping: 0.0, stiffness, rest_angle: 0.0, controller: None })
}

fn load(at: Marker, force: [f64; 3], axes: Axes) -> Load {
    Load { name: "load".into(), at, force: Vec3(force), moment: Vec3([0.0; 3]), axes, amplitude: None }
}

/// The points of a path up to its load factor.
fn points(system: &mut Multibody, plan: &Plan) -> (Vec<Point>, Result<(), PathEnd>) {
    let (mut points, start) = (Vec::new(), system.initial());
    let end = follow(system, &start, plan, |_, point| {
        points.push(point.clone());
        !point.arrived
    });
    system.release();
    (points, end)
}

const WIDTH: f64 = 1.0;
const HEIGHT: f64 = 0.3;
const STIFFNESS: f64 = 2000.0;

/// Two springs that support a slide on a vertical guide: F(z) = 2 k (1 − l₀/l) z, l² = b² + z².
fn truss(force: f64) -> Multibody {
    let mut model = Model::new();
    let slide = model.body(Body::new("slide", 1.0, [0.1; 3]).at([0.0, 0.0, HEIGHT]));
    let up = ([0.0, 0.0, 1.0], None);
    model.join("guide", Kind::Prismatic, [Part::Ground, slide], [0.0, 0.0, HEIGHT], up).unwrap();
    for (name, x) in [("left", -WIDTH), ("right", WIDTH)] {
        let [from, to] = [Marker::new(Part::Ground, [x, 0.0, 0.0]), Marker::new(slide, [0.0; 3])];
        let length = WIDTH.hypot(HEIGHT);
        model.spring(Spring {
            name: name.into(),
            from,
            to,
            stiffness: STIFFNESS,
            damping: 0.0,
            length,
            directions: flexion::multibody::Directions::Line,
        });
    }
    model.load(load(Marker::new(slide, [0.0; 3]), [0.0, 0.0, -force], Axes::Dead));
    Multibody::new(model).unwrap()
}

fn supports(z: f64) -> f64 {
    2.0 * STIFFNESS * (1.0 - WIDTH.hypot(HEIGHT) / WIDTH.hypot(z)) * z
}

#[test]
fn a_shallow_truss_snaps_through() {
    // dF/dz = 0 where l³ = l₀ b².
    let cube = (WIDTH.hypot(HEIGHT) * WIDTH * WIDTH).cbrt();
    let at_limit = (cube * cube - WIDTH * WIDTH).sqrt();
    let limit = -supports(at_limit);
    let mut system = truss(1.5 * limit);
    let (path, end) = points(&mut system, &Plan::to(1.0));
    end.unwrap();
    let critical: Vec<&Point> = path.iter().filter(|p| p.critical.is_some()).collect();
    assert_eq!(critical.iter().map(|p| p.critical.unwrap()).collect::<Vec<_>>(), [Critical::Limit; 2]);
    for (point, sign) in critical.iter().zip([1.0, -1.0]) {
        assert!((point.factor * 1.5 - sign).abs() < 1e-7, "limit at {}", point.factor * 1.5);
        assert!((point.state.q[2] - sign * at_limit).abs() < 1e-5);
    }
    for p in &path {
        let z = p.state.q[2];
        assert!((p.factor * 1.5 * limit + supports(z)).abs() < 1e-8 * limit, "not in equilibrium at {z}");
        let unstable = usize::from(z.abs() < at_limit * (1.0 - 1e-4));
        if p.critical.is_none() {
            assert_eq!(p.stability.as_ref().unwrap().unstable(), unstable, "at {z}");
        }
    }
    // What hangs below its supports is found from the load alone.
    let mut s = system.initial();
    let found = stable_equilibrium(&mut system, &mut s, &mut |_| ControlFlow::Continue(())).unwrap();
    assert!(found.stability.unwrap().is_stable() && s.q[2] < -at_limit);
    assert!((supports(s.q[2]) + 1.5 * limit).abs() < 1e-8);
}

/// A rod that stands on a hinge with a spring under a dead load: P l = k, and beyond it the straight rod is unstable.
#[test]
fn a_standing_rod_branches_at_its_buckling_load() {
    let (length, stiffness) = (0.8, 40.0);
    let mut model = Model::new();
    let rod = model.body(Body::new("rod", 1.0, [0.05, 0.05, 0.01]).at([0.0, 0.0, 0.5 * length]));
    model
        .join("hinge", Kind::Revolute, [Part::Ground, rod], Vec3([0.0; 3]), (Vec3([0.0, 1.0, 0.0]), None))
        .unwrap()
        .drive = spring(stiffness);
    let tip = Marker::new(rod, [0.0, 0.0, 0.5 * length]);
    model.load(load(tip, [0.0, 0.0, -2.0 * stiffness / length], Axes::Dead));
    let mut system = Multibody::new(model).unwrap();
    let (path, end) = points(&mut system, &Plan::to(1.0));
    end.unwrap();
    let critical: Vec<&Point> = path.iter().filter(|p| p.critical.is_some()).collect();
    assert_eq!(critical.len(), 1);
    assert_eq!(critical[0].critical, Some(Critical::Branching));
    assert!((critical[0].factor - 0.5).abs() < 1e-7, "{}", critical[0].factor);
    // No path leads from the straight rod to the bent one: it is said to be unstable.
    let mut s = system.initial();
    let found = stable_equilibrium(&mut system, &mut s, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(found.stability.unwrap().to_string(), "unstable: 1 direction");
}

/// Ziegler's column: two rods of length l with springs k, masses 2m and m at their ends, and a force that follows the second.
/// It flutters at P l/k = 7/2 − √2 (Ziegler 1977).
#[test]
fn a_column_under_a_following_force_flutters() {
    let (mass, length, stiffness): (f64, f64, f64) = (0.7, 0.5, 3.0);
    let mut model = Model::new();
    let mut point = |name: &str, mass, x| model.body(Body::new(name, mass, [1e-10; 3]).at([x, 0.0, 0.0]));
    let (one, two) = (point("one", 2.0 * mass, length), point("two", mass, 2.0 * length));
    let z = ([0.0, 0.0, 1.0], None);
    model.join("root", Kind::Revolute, [Part::Ground, one], [0.0; 3], z).unwrap().drive = spring(stiffness);
    model.join("elbow", Kind::Revolute, [one, two], [length, 0.0, 0.0], z).unwrap().drive = spring(stiffness);
    let critical = (3.5 - 2.0_f64.sqrt()) * stiffness / length;
    model.load(load(Marker::new(two, [0.0; 3]), [-2.0 * critical, 0.0, 0.0], Axes::Follower));
    let mut system = Multibody::new(model).unwrap();
    let (path, end) = points(&mut system, &Plan::to(1.0));
    end.unwrap();
    let found: Vec<&Point> = path.iter().filter(|p| p.critical.is_some()).collect();
    assert!(
        found[0].critical == Some(Critical::Flutter) && (found[0].factor - 0.5).abs() < 1e-6,
        "{}",
        found[0].factor
    );
    // Its modes below, by (2 c₁₁ …) x² + …: M = [[3, 1], [1, 1]] m l², K = k [[2, −1], [−1, 1]] − P l [[1, −1], [0, 0]].
    let (ml, p) = (mass * length * length, 0.5 * critical * length);
    let (k11, k12, k21, k22) = (2.0 * stiffness - p, p - stiffness, -stiffness, stiffness);
    let (a, b, c) = (2.0 * ml * ml, ml * (k11 + 3.0 * k22 - k12 - k21), k11 * k22 - k12 * k21);
    let root = (b * b - 4.0 * a * c).sqrt();
    let s = &points(&mut system, &Plan::to(0.25)).0.pop().unwrap().state;
    system.set(Parameter::LoadFactor, 0.25).unwrap();
    assert!(stability(&mut system, s).unwrap().is_stable());
    let found = modes(&mut system, s, 2, &[]).unwrap();
    for (mode, square) in found.modes.iter().zip([(b - root) / (2.0 * a), (b + root) / (2.0 * a)]) {
        assert!((mode.frequency() / square.sqrt() - 1.0).abs() < 1e-8, "{} for {square}", mode.frequency());
    }
}

/// Two bodies joined by a hinge with a spring at their common centre float: six rigid motions, and ω² = k (1/J₁ + 1/J₂).
#[test]
fn bodies_that_float_have_rigid_motions() {
    let mut model = Model::new();
    let [one, two] =
        [("one", 0.3), ("two", 0.5)].map(|(name, j)| model.body(Body::new(name, 1.0, [0.3, 0.35, j])));
    model
        .join("hinge", Kind::Revolute, [one, two], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None))
        .unwrap()
        .drive = spring(7.0);
    let mut system = Multibody::new(model).unwrap();
    let s = system.initial();
    let found = modes(&mut system, &s, 7, &[]).unwrap();
    let frequencies: Vec<f64> = found.modes.iter().map(|mode| mode.frequency()).collect();
    assert!(frequencies[..6].iter().all(|f| *f == 0.0), "{frequencies:?}");
    let omega = (7.0_f64 * (1.0 / 0.3 + 1.0 / 0.5)).sqrt();
    assert!((frequencies[6] / omega - 1.0).abs() < 1e-8, "{frequencies:?} for {omega}");
}

#[test]
fn what_moves_freely_is_named() {
    let mut model = Model::new();
    let rod = model.body(Body::new("rod", 1.0, [0.05; 3]).at([0.5, 0.0, 0.0]));
    model
        .join("hinge", Kind::Revolute, [Part::Ground, rod], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None))
        .unwrap();
    model.load(load(Marker::new(rod, [0.0; 3]), [0.0, 1.0, 0.0], Axes::Follower));
    let mut system = Multibody::new(model).unwrap();
    let mut s = system.initial();
    let message = equilibrium(&mut system, &mut s).unwrap_err().to_string();
    assert!(message.contains("rod") || message.contains("hinge"), "{message}");
}

/// A bar on a hinge that a force pushes across falls; held by a spring at the hinge, however soft, it has its path.
#[test]
fn a_mechanism_that_loads_drive_has_no_path_and_is_named() {
    let bar = |drive: Drive| {
        let mut model = Model::new();
        let bar = model.body(Body::new("bar", 1.0, [0.1; 3]).at([0.5, 0.0, 0.0]));
        let about = ([0.0, 1.0, 0.0], None);
        model.join("hinge", Kind::Revolute, [Part::Ground, bar], [0.0; 3], about).unwrap().drive = drive;
        model.load(load(Marker::new(bar, [0.0; 3]), [0.0, 0.0, -0.1], Axes::Dead));
        Multibody::new(model).unwrap()
    };
    let (free, end) = points(&mut bar(Drive::None), &Plan::to(1.0));
    assert!(free.is_empty(), "{} equilibria of a bar that falls", free.len());
    let Err(PathEnd::Mechanism { largest }) = end else { panic!("{end:?}") };
    assert!(largest.ends_with("of `bar`"), "{largest}");
    // k θ = F a cos θ, to the third order in F a/k = 1/20.
    let (held, end) = points(&mut bar(spring(1.0)), &Plan::to(1.0));
    assert_eq!(end, Ok(()));
    let angle = -held.last().unwrap().state.q[2].atan2(held.last().unwrap().state.q[0]);
    assert!((angle - 0.05 * angle.cos()).abs() < 1e-9, "{angle}");
}
