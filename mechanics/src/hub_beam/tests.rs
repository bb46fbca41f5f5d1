//! The equations of motion against d'Alembert's principle, finite differences and closed forms.

use super::*;
use crate::basis::{Field, Hermite, Lagrange};
use crate::drive::{Actuator, Controller};
use crate::linalg::{Matrix, Structure};
use crate::profile::{Expression, HubKinematics, Motion};
use crate::section::{Resultants, Section};
use crate::system::{Dynamics, State, System, Weights};
use std::sync::Arc;

pub(super) const LENGTH: f64 = 2.0;
pub(super) const RADIUS: f64 = 0.3;

/// Two rows of fibres of different mass and stiffness, which vary along the beam: every resultant is
/// non-zero, and the equations can be written fibre by fibre.
#[derive(Debug)]
pub(super) struct TwoFibres;

impl TwoFibres {
    /// (height, mass per length, axial stiffness) of each fibre.
    pub(super) fn fibres(x: f64) -> [(f64, f64, f64); 2] {
        [(-0.05, 1.5 + 0.2 * x, 900.0), (0.11, 0.8 - 0.1 * x, 1300.0 + 100.0 * x)]
    }
}

impl Section for TwoFibres {
    fn resultants(&self, x: f64) -> Resultants {
        let mut r = Resultants::default();
        for (y, m, ea) in TwoFibres::fibres(x) {
            r.mass += m;
            r.first_moment += m * y;
            r.rotary_inertia += m * y * y;
            r.axial_stiffness += ea;
            r.coupling_stiffness += ea * y;
            r.bending_stiffness += ea * y * y;
        }
        r
    }
}

pub(super) fn hub() -> Hub {
    let formula = "0.4 + 1.3*t + 0.35*t^2";
    Hub::prescribed(RADIUS, 0.7, Motion::Angle(Arc::new(Expression::new(formula, "t", 10.0).unwrap())))
}

/// A hub with everything that can drive it.
pub(super) fn free_hub() -> Hub {
    let profile = |text: &str| Arc::new(Expression::new(text, "t", 10.0).unwrap());
    let controller = Controller {
        proportional: 3.0,
        derivative: 0.7,
        reference: Motion::Angle(profile("0.2*t^2")),
        limit: f64::INFINITY,
    };
    let drive = Drive::Free(FreeHub {
        angle: 0.4,
        speed: 1.1,
        actuator: Actuator {
            torque: profile("2 + sin(3*t)"),
            damping: 0.3,
            stiffness: 4.0,
            rest_angle: 0.1,
            controller: Some(controller),
        },
    });
    Hub { radius: RADIUS, inertia: 0.7, drive }
}

fn fields(elements: usize) -> Fields {
    Fields::new(
        LENGTH,
        Box::new(Lagrange::new(LENGTH, elements, 2).unwrap()),
        Box::new(Hermite::new(LENGTH, elements, Field::Transverse).unwrap()),
        &[],
    )
}

fn linear_on(hub: Hub, foreshortening: Foreshortening) -> HubBeam<LinearCoupling> {
    let coupling = LinearCoupling::new(fields(3), &TwoFibres, &hub, foreshortening);
    HubBeam::new(hub, coupling, &[])
}

fn linear(foreshortening: Foreshortening) -> HubBeam<LinearCoupling> {
    linear_on(hub(), foreshortening)
}

fn exact_on(hub: Hub) -> HubBeam<ExactCoupling> {
    let coupling = ExactCoupling::new(LENGTH, 3, &TwoFibres, &hub).unwrap();
    HubBeam::new(hub, coupling, &[])
}

fn exact() -> HubBeam<ExactCoupling> {
    exact_on(hub())
}

/// Every coupling, on a hub that moves as prescribed and on one that is free.
fn systems() -> Vec<Box<dyn System>> {
    let mut systems: Vec<Box<dyn System>> = Vec::new();
    for hub in [hub(), free_hub()] {
        systems.push(Box::new(linear_on(hub.clone(), Foreshortening::None)));
        systems.push(Box::new(linear_on(hub.clone(), Foreshortening::First)));
        let high = HighCoupling::new(fields(3), &TwoFibres, &hub).unwrap();
        systems.push(Box::new(HubBeam::new(hub.clone(), high, &[])));
        systems.push(Box::new(exact_on(hub)));
    }
    systems
}

/// The prescribed motion at a time.
pub(super) fn at<C: Coupling>(system: &HubBeam<C>, t: f64) -> HubKinematics {
    match &system.hub().drive {
        Drive::Prescribed(motion) => motion.at(t),
        Drive::Free(_) => panic!("the hub is free"),
    }
}

/// A smooth, generic state of the given size of deformation.
pub(super) fn state(system: &dyn System, size: f64) -> State {
    let mut s = State::zeros(system.size(), 0.6);
    for i in 0..s.q.len() {
        let x = i as f64;
        s.q[i] = size * (1.3 * x + 0.2).sin();
        s.v[i] = size * (0.7 * x + 1.0).cos();
        s.a[i] = size * (2.1 * x + 0.5).sin();
    }
    s
}

pub(super) fn residual(system: &mut dyn System, s: &State) -> Vec<f64> {
    let mut r = vec![0.0; s.v.len()];
    system.residual(s, &mut r);
    r
}

/// Largest difference over the largest entry of `b`.
pub(super) fn relative(a: &[f64], b: &[f64]) -> f64 {
    let scale = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    a.iter().zip(b).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs())) / scale
}

pub(super) fn check_tangent(system: &mut dyn System, s: &State) {
    let n = system.size().v;
    for (wa, wv, wq) in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (0.3, 0.5, 2.0)] {
        let mut tangent = Matrix::new(&system.structure(0));
        system.tangent(s, Weights::new(wa, wv, wq), &mut tangent);
        let (mut analytic, mut numeric) = (Vec::new(), Vec::new());
        for j in 0..n {
            // Fourth-order central difference.
            let h = 1e-3;
            let mut column = vec![0.0; n];
            for (c, k) in [(1.0, -2.0), (-8.0, -1.0), (8.0, 1.0), (-1.0, 2.0)] {
                let mut moved = s.clone();
                moved.q[j] += wq * k * h;
                moved.v[j] += wv * k * h;
                moved.a[j] += wa * k * h;
                for (column, r) in column.iter_mut().zip(residual(system, &moved)) {
                    *column += c * r / (12.0 * h);
                }
            }
            analytic.extend((0..n).map(|i| tangent.get(i, j)));
            numeric.extend(column);
        }
        let error = relative(&analytic, &numeric);
        assert!(error < 1e-7, "weights {wa} {wv} {wq}: {error:e}");
    }
}

#[test]
fn tangents_equal_finite_differences_on_every_basis() {
    use crate::basis::{
        BSpline, Basis, Bezier, Modes, Polynomial, PolynomialParameters, Radial, RadialParameters,
    };
    let both = |of: &dyn Fn(Field) -> Box<dyn Basis>| [of(Field::Axial), of(Field::Transverse)];
    let polynomial = PolynomialParameters { nodes: 6, support: 1.5 };
    let pairs = [
        both(&|field| Box::new(Modes::new(LENGTH, 3, field).unwrap())),
        both(&|field| Box::new(Radial::new(LENGTH, RadialParameters::new(6), field).unwrap())),
        both(&|field| Box::new(Polynomial::new(LENGTH, polynomial, field).unwrap())),
        both(&|field| Box::new(BSpline::new(LENGTH, 4, 3, field).unwrap())),
        both(&|field| Box::new(Bezier::new(LENGTH, 1, 6, field).unwrap())),
    ];
    // The free hub's equations hold those of the prescribed one.
    for [axial, transverse] in pairs {
        let fields = Fields::new(LENGTH, axial, transverse, &[]);
        let coupling = LinearCoupling::new(fields, &TwoFibres, &free_hub(), Foreshortening::First);
        let mut system = HubBeam::new(free_hub(), coupling, &[]);
        let s = state(&system, 0.1);
        check_tangent(&mut system, &s);
    }
}

#[test]
fn tangents_equal_finite_differences() {
    for size in [1e-3, 0.15] {
        let mut systems = systems();
        for system in &mut systems {
            let s = state(&**system, size);
            check_tangent(&mut **system, &s);
        }
    }
}

/// Position of a fibre at height y over the point at x, in the hub's frame.
pub(super) fn fibre(p: &Placement, x: f64, y: f64) -> [f64; 2] {
    let (sin, cos) = p.rotation.sin_cos();
    [RADIUS + x + p.axial - y * sin, p.deflection + y * cos]
}

/// Inertia forces Σ m A·∂r/∂q and torque Σ m A·Jr of the two fibres, by finite differences of nothing but
/// their positions; the shape functions and the foreshortening come from `placements`.
pub(super) fn inertia_forces<C: Coupling>(
    coupling: &C,
    s: &State,
    hub: &HubKinematics,
    masses: &[Mass],
) -> (Vec<f64>, f64) {
    let gauss = crate::quadrature::Gauss::new(8);
    let n = s.q.len();
    let mut stations = Vec::new();
    let mut weights = Vec::new();
    for ends in coupling.fields().cells().windows(2) {
        for (x, w) in gauss.on(ends[0], ends[1]) {
            stations.push(Station::new(coupling.fields(), x));
            weights.push(w);
        }
    }
    // A body is two particles at the distance √(j/m) from the axis.
    let spread = stations.len();
    for m in masses {
        stations.push(Station::new(coupling.fields(), m.station));
        weights.push(1.0);
    }
    let particles = |station: usize| match station.checked_sub(spread) {
        Some(i) => {
            let y = (masses[i].inertia / masses[i].mass).sqrt();
            [(-y, 0.5 * masses[i].mass), (y, 0.5 * masses[i].mass)]
        }
        None => TwoFibres::fibres(stations[station].point.x).map(|(y, m, _)| (y, m)),
    };
    let positions = |q: &[f64]| -> Vec<[f64; 2]> {
        let moved = State { q: q.to_vec(), ..s.clone() };
        let mut p = vec![Placement::default(); stations.len()];
        let mut order: Vec<usize> = (0..stations.len()).collect();
        order.sort_by(|a, b| stations[*a].point.x.total_cmp(&stations[*b].point.x));
        let sorted: Vec<Station> = order.iter().map(|&i| stations[i].clone()).collect();
        let mut found = p.clone();
        coupling.placements(&moved, &sorted, &mut found);
        order.iter().zip(found).for_each(|(&i, found)| p[i] = found);
        let of = |i: usize| particles(i).map(|(y, _)| fibre(&p[i], stations[i].point.x, y));
        (0..stations.len()).flat_map(of).collect()
    };
    let at = |t: f64| -> Vec<[f64; 2]> {
        let q: Vec<f64> = (0..n).map(|i| s.q[i] + t * s.v[i] + 0.5 * t * t * s.a[i]).collect();
        positions(&q)
    };
    let h = 2e-3;
    let times = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(k * h));
    let slopes: Vec<Vec<[f64; 2]>> = (0..n)
        .map(|k| {
            let d = 1e-4;
            let moved = |c: f64| {
                let mut q = s.q.clone();
                q[k] += c * d;
                positions(&q)
            };
            let (a, b, c, e) = (moved(-2.0), moved(-1.0), moved(1.0), moved(2.0));
            (0..a.len())
                .map(|i| [0, 1].map(|j| (a[i][j] - 8.0 * b[i][j] + 8.0 * c[i][j] - e[i][j]) / (12.0 * d)))
                .collect()
        })
        .collect();
    let (mut forces, mut torque) = (vec![0.0; n], 0.0);
    for i in 0..times[0].len() {
        let mass = weights[i / 2] * particles(i / 2)[i % 2].1;
        let value = |j: usize| times.each_ref().map(|p| p[i][j]);
        let velocity = [0, 1].map(|j| {
            let p = value(j);
            (p[0] - 8.0 * p[1] + 8.0 * p[3] - p[4]) / (12.0 * h)
        });
        let acceleration = [0, 1].map(|j| {
            let p = value(j);
            (-p[0] + 16.0 * p[1] - 30.0 * p[2] + 16.0 * p[3] - p[4]) / (12.0 * h * h)
        });
        let [px, py] = times[2][i];
        let (om, al) = (hub.speed, hub.acceleration);
        let ax = acceleration[0] - 2.0 * om * velocity[1] - al * py - om * om * px;
        let ay = acceleration[1] + 2.0 * om * velocity[0] + al * px - om * om * py;
        for k in 0..n {
            forces[k] += mass * (ax * slopes[k][i][0] + ay * slopes[k][i][1]);
        }
        torque += mass * (px * ay - py * ax);
    }
    (forces, torque + 0.7 * hub.acceleration)
}

/// The residual without the elastic forces.
pub(super) fn without_strain(system: &mut dyn System, s: &State) -> Vec<f64> {
    let rest = State { v: vec![0.0; s.v.len()], a: vec![0.0; s.a.len()], ..s.clone() };
    let mut r = residual(system, s);
    // Elastic forces are those that neither speed nor acceleration changes: finite differences of U.
    for (k, r) in r.iter_mut().enumerate() {
        let h = 1e-4;
        let mut energy = |c: f64| {
            let mut moved = rest.clone();
            moved.q[k] += c * h;
            system.energy(&moved).strain
        };
        *r -= (energy(-2.0) - 8.0 * energy(-1.0) + 8.0 * energy(1.0) - energy(2.0)) / (12.0 * h);
    }
    r
}

/// All inertia forces, those of Coriolis among them.
#[test]
fn coriolis_and_inertia_forces_of_the_exact_coupling_are_dalemberts() {
    let mut system = exact();
    let s = state(&system, 0.15);
    let kinematics = at(&system, s.t);
    let (forces, torque) = inertia_forces(system.coupling(), &s, &kinematics, &[]);
    // The element integrates rotary terms with its own rule of three points, the check with eight: their
    // difference at rotations of this size is what the tolerance allows.
    let error = relative(&without_strain(&mut system, &s), &forces);
    assert!(error < 2e-3, "forces {error:e}");
    assert!((system.torque(&s) / torque - 1.0).abs() < 2e-3, "{} {torque}", system.torque(&s));
}

/// All inertia forces, those of Coriolis and of the gyroscopic matrix among them.
#[test]
fn coriolis_and_inertia_forces_of_linear_couplings_are_dalemberts() {
    for (foreshortening, kind) in [(Foreshortening::None, "zeroth"), (Foreshortening::First, "first")] {
        let mut system = linear(foreshortening);
        let kinematics = at(&system, 0.6);
        let zero = state(&system, 0.0);
        let rest = without_strain(&mut system, &zero);
        let (forces0, torque0) = inertia_forces(system.coupling(), &zero, &kinematics, &[]);
        assert!(relative(&rest, &forces0) < 1e-8, "{kind}");
        assert!((system.torque(&zero) / torque0 - 1.0).abs() < 1e-9);
        // (R(ε) − R(0))/ε, ε → 0 by extrapolation from ε and 2ε: the linear part of the full equations.
        let difference = |size: f64| -> (Vec<f64>, f64) {
            let up = inertia_forces(system.coupling(), &state(&system, size), &kinematics, &[]);
            let down = inertia_forces(system.coupling(), &state(&system, -size), &kinematics, &[]);
            let forces = up.0.iter().zip(&down.0).map(|(a, b)| (a - b) / (2.0 * size)).collect();
            (forces, (up.1 - down.1) / (2.0 * size))
        };
        let (one, two) = (difference(1e-3), difference(2e-3));
        let expected: Vec<f64> = one.0.iter().zip(&two.0).map(|(a, b)| (4.0 * a - b) / 3.0).collect();
        let unit = state(&system, 1.0);
        let full = without_strain(&mut system, &unit);
        let linear: Vec<f64> = full.iter().zip(&rest).map(|(a, b)| a - b).collect();
        let error = relative(&linear, &expected);
        assert!(error < 1e-6, "{kind}: {error:e}");
        let torque = (system.torque(&state(&system, 1e-6)) - system.torque(&state(&system, -1e-6))) / 2e-6;
        let expected = (4.0 * one.1 - two.1) / 3.0;
        assert!((torque - expected).abs() < 1e-5 * expected.abs(), "{kind}: torque {torque} {expected}");
    }
}

#[test]
fn power_of_the_drive_is_the_rate_of_the_energy() {
    for mut system in systems() {
        check_power(&mut *system);
    }
}

/// Along any motion the equations of motion hold, d(T + U + V)/dt is the power: a first integral of all terms.
pub(super) fn check_power(system: &mut dyn System) {
    let mut s = state(system, 0.05);
    s.a.fill(0.0);
    // a = −M⁻¹ r(q, v, 0)
    let mut mass = Matrix::new(&system.structure(0));
    system.tangent(&s, Weights::new(1.0, 0.0, 0.0), &mut mass);
    let mut a = residual(system, &s);
    mass.factor().unwrap();
    mass.solve(&mut a);
    s.a = a.iter().map(|a| -a).collect();
    let mut energy = |t: f64| {
        let mut moved = s.clone();
        moved.t += t;
        for i in 0..s.q.len() {
            moved.q[i] += t * (s.v[i] + 0.5 * t * s.a[i]);
            moved.v[i] += t * s.a[i];
        }
        system.energy(&moved).total()
    };
    let h = 2e-5;
    let rate = (energy(-2.0 * h) - 8.0 * energy(-h) + 8.0 * energy(h) - energy(2.0 * h)) / (12.0 * h);
    let power = system.power(&s).total();
    assert!((rate - power).abs() < 1e-6 * rate.abs().max(1.0), "{rate} {power}");
}

/// A uniform section given by its stiffnesses.
#[derive(Debug)]
struct Plain(f64, f64);
impl Section for Plain {
    fn resultants(&self, _x: f64) -> Resultants {
        Resultants { mass: 1.0, axial_stiffness: self.0, bending_stiffness: self.1, ..Default::default() }
    }
}

/// Static tip displacement (axial, deflection) over L under a dead transverse tip force, with the given load
/// P L²/EI and slenderness L/h (EA/EI = 12/h² of a rectangle).
fn cantilever(elements: usize, load: f64, slenderness: f64) -> (f64, f64) {
    let (length, ei) = (1.0, 1.0);
    let ea = 12.0 * ei * slenderness * slenderness / (length * length);
    let hub = Hub::prescribed(0.0, 0.0, Motion::Angle(Arc::new(crate::profile::Constant::new(0.0).unwrap())));
    let coupling = ExactCoupling::new(length, elements, &Plain(ea, ei), &hub).unwrap();
    let mut system = HubBeam::new(hub, coupling, &[]);
    let mut s = State::zeros(system.size(), 0.0);
    let tip = Station::new(system.coupling().fields(), length);
    let mut tangent = Matrix::new(&system.structure(0));
    for step in 1..=20 {
        let force = load * ei / (length * length) * step as f64 / 20.0;
        for _ in 0..30 {
            let mut r = residual(&mut system, &s);
            for (&i, phi) in tip.point.transverse.index.iter().zip(&tip.point.transverse.value[0]) {
                r[i] -= force * phi;
            }
            system.tangent(&s, Weights::new(0.0, 0.0, 1.0), &mut tangent);
            tangent.factor().unwrap();
            tangent.solve(&mut r);
            s.q.iter_mut().zip(&r).for_each(|(q, d)| *q -= d);
            if r.iter().all(|d| d.abs() < 1e-12) {
                break;
            }
        }
    }
    let [u, w, ..] = tip.fields(&s);
    (u, w)
}

#[test]
fn slender_cantilever_bends_to_the_elastica() {
    // Closed form by elliptic integrals (Bisshopp & Drucker 1945, doi 10.1090/qam/13360).
    for (load, w, u) in [
        (1.0, 0.301721, 0.056433),
        (2.0, 0.493457, 0.160642),
        (4.0, 0.669964, 0.328941),
        (10.0, 0.810609, 0.554996),
    ] {
        let (axial, deflection) = cantilever(20, load, 1e4);
        assert!((deflection - w).abs() < 2e-6, "{load}: {deflection} {w}");
        assert!((-axial - u).abs() < 2e-6, "{load}: {axial} {u}");
    }
}

#[test]
fn exact_coupling_does_not_lock_however_slender_the_beam() {
    // P L²/EI = 10, five elements: the error stays what it is at moderate slenderness.
    let mut errors = Vec::new();
    for slenderness in [1e2, 1e3, 1e4] {
        errors.push((cantilever(5, 10.0, slenderness).1 - 0.810609).abs());
    }
    assert!(errors.iter().all(|e| *e < 2e-3), "{errors:?}");
    assert!((errors[2] - errors[1]).abs() < 1e-5, "{errors:?}");
    // At L/h = 10 the axis itself stretches: compare with a fine mesh.
    let thick = cantilever(5, 10.0, 10.0).1 - cantilever(40, 10.0, 10.0).1;
    assert!(thick.abs() < 2e-3, "{thick}");
}

#[test]
fn exact_coupling_converges_with_order_four_in_the_tip_displacement() {
    let reference = cantilever(64, 4.0, 1e3).1;
    let error = |n: usize| (cantilever(n, 4.0, 1e3).1 - reference).abs();
    let (coarse, fine) = (error(4), error(8));
    let order = (coarse / fine).log2();
    assert!(order > 3.5, "errors {coarse:e} {fine:e}: order {order}");
}

#[test]
fn band_and_dense_storage_give_the_same_increment() {
    let mut system = exact();
    let s = state(&system, 0.1);
    let n = s.q.len();
    let mut band = Matrix::new(&Structure::band(n, 7, 7, 0));
    let mut dense = Matrix::new(&Structure::dense(n));
    // The tangent goes through the system's own storage; copy it into both.
    let mut own = Matrix::new(&system.structure(0));
    system.tangent(&s, Weights::new(1.0, 0.1, 0.01), &mut own);
    for i in 0..n {
        for j in 0..n {
            if own.get(i, j) != 0.0 {
                band.add(i, j, own.get(i, j));
                dense.add(i, j, own.get(i, j));
            }
        }
    }
    let rhs = residual(&mut system, &s);
    let (mut x, mut y) = (rhs.clone(), rhs);
    band.factor().unwrap();
    dense.factor().unwrap();
    band.solve(&mut x);
    dense.solve(&mut y);
    assert!(relative(&x, &y) < 1e-11);
}

#[test]
fn zeroth_order_coupling_softens_at_its_first_frequency() {
    let length = 10.0;
    let fields = Fields::new(
        length,
        Box::new(Lagrange::new(length, 10, 1).unwrap()),
        Box::new(Hermite::new(length, 10, Field::Transverse).unwrap()),
        &[],
    );
    // P1's beam: ρA scaled to 1, EI/ρA = 14000/1.2.
    let section = Plain(2.8e7 / 1.2, 1.4e4 / 1.2);
    let hub = Hub { radius: 0.0, inertia: 0.0, ..hub() };
    let coupling = LinearCoupling::new(fields, &section, &hub, Foreshortening::None);
    let first = 3.516015268628 * (1.4e4f64 / 1.2).sqrt() / 100.0;
    let critical = coupling.critical_speed(20.0).unwrap();
    assert!((critical / first - 1.0).abs() < 1e-5, "{critical} {first}");
    assert!(coupling.critical_speed(0.99 * first).is_none());
}

#[test]
fn angular_momentum_changes_by_the_torque_alone() {
    // H = ∂T/∂ω along any motion: dH/dt is the torque that the motion needs.
    for mut system in systems() {
        let s = state(&*system, 0.05);
        let n = s.q.len();
        let channel = |system: &mut dyn System, name: &str| {
            system.channels().iter().position(|c| c.name == name).unwrap()
        };
        let momentum = channel(&mut *system, "hub.angular_momentum");
        let mut row = vec![0.0; system.channels().len()];
        let mut record = |t: f64| {
            let mut moved = s.clone();
            moved.t += t;
            for i in 0..n {
                moved.q[i] += t * (s.v[i] + 0.5 * t * s.a[i]);
                moved.v[i] += t * s.a[i];
            }
            system.record(&moved, &mut row);
            row[momentum]
        };
        let h = 1e-4;
        let rate = (record(-2.0 * h) - 8.0 * record(-h) + 8.0 * record(h) - record(2.0 * h)) / (12.0 * h);
        // A free hub's residual is the torque needed less the torque applied.
        let torque = channel(&mut *system, "hub.torque");
        system.record(&s, &mut row);
        let free = system.unknown(system.size().v - 1).contains("hub");
        let needed = row[torque] + if free { residual(&mut *system, &s)[n - 1] } else { 0.0 };
        assert!((rate - needed).abs() < 1e-7 * needed.abs().max(1.0), "{rate} {needed}");
    }
}

/// A free hub's forces on the beam share their products with its torque; those of a prescribed hub stand alone.
#[test]
fn the_beam_does_not_feel_whether_its_hub_is_free_or_prescribed() {
    let damping = Damping { mass: 0.7, stiffness: 0.02 };
    let hub_motion = at(&exact(), 0.6);
    let systems = |hub: Hub| -> [Box<dyn System>; 5] {
        let first = || linear_on(hub.clone(), Foreshortening::First);
        [
            Box::new(linear_on(hub.clone(), Foreshortening::None)),
            Box::new(first()),
            Box::new(first().with_damping(damping)),
            Box::new(exact_on(hub.clone())),
            Box::new(exact_on(hub.clone()).with_damping(damping)),
        ]
    };
    for (mut free, mut prescribed) in systems(free_hub()).into_iter().zip(systems(hub())) {
        let alone = state(prescribed.as_ref(), 0.1);
        let mut s = state(free.as_ref(), 0.1);
        let n = alone.q.len();
        (s.q[n], s.v[n], s.a[n]) = (hub_motion.angle, hub_motion.speed, hub_motion.acceleration);
        let forces = residual(free.as_mut(), &s);
        let expected = residual(prescribed.as_mut(), &alone);
        assert!(relative(&forces[..n], &expected) < 1e-13, "{:e}", relative(&forces[..n], &expected));
    }
}
