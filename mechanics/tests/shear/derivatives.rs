//! A beam without symmetries, and the system that integrators see, by differences.

use flexion::linalg::vector::noise;
use flexion::linalg::{Mat3, Matrix, Structure, Vec3};
use flexion::multibody::rotation::about;
use flexion::multibody::shear::{Beam, NODE_VELOCITIES, VELOCITIES};
use flexion::section::{Matrices, Matrix6};
use flexion::system::{Dynamics, Energy, Events, Frame, Observed, Power, Size, State, Steady, Weights};
use flexion::verify;

/// A Aᵀ + c I of numbers without structure, times `scale`.
fn positive(seed: u64, scale: f64) -> Matrix6 {
    let x = noise(36, seed);
    let product = |i: usize, j: usize| (0..6).map(|k| x[6 * i + k] * x[6 * j + k]).sum::<f64>();
    std::array::from_fn(|i| std::array::from_fn(|j| scale * (product(i, j) + if i == j { 0.5 } else { 0.0 })))
}

fn scaled(matrix: Matrix6, c: f64) -> Matrix6 {
    matrix.map(|row| row.map(|x| c * x))
}

/// C, D and M of the sections at the arc length s.
pub fn stiffness(s: f64) -> Matrix6 {
    scaled(positive(71, 3.0), 1.0 - 0.2 * s)
}

pub fn damping(s: f64) -> Matrix6 {
    scaled(positive(73, 0.2), 1.0 + 0.3 * s)
}

pub fn mass(s: f64) -> Matrix6 {
    let mut of = Matrices::principal([1.0; 6], 1.3 + 0.1 * s, [0.05, 0.03, 0.04]);
    of = of.with_mass_centre([0.08, -0.05]).rolled(0.3);
    // A centre of mass before the section, and products of inertia.
    (of.mass[1][5], of.mass[2][4], of.mass[5][1], of.mass[4][2]) = (0.06, -0.06, 0.06, -0.06);
    (of.mass[3][4], of.mass[4][3]) = (0.004, 0.004);
    of.mass
}

/// A helix of radius ½ whose sections are turned about the tangent by s/2 and swept.
pub fn general(damped: bool) -> Beam {
    let curve = |s: f64| {
        let (sin, cos) = s.sin_cos();
        let root = 0.5_f64.sqrt();
        let (t, n) = (Vec3([-sin * root, cos * root, root]), Vec3([-cos, -sin, 0.0]));
        let (c, d) = ((0.5 * s).cos(), (0.5 * s).sin());
        let b = t.cross(n);
        let normal = c * n + d * b;
        let axes = Mat3::columns([t, normal, t.cross(normal)]);
        Frame { position: Vec3([root * cos, root * sin, root * s]), rotation: axes * about([0.1, -0.2, 0.3]) }
    };
    let section = |s: f64| Matrices {
        stiffness: stiffness(s),
        damping: if damped { damping(s) } else { [[0.0; 6]; 6] },
        mass: mass(s),
    };
    Beam::new(&[0.0, 0.6, 1.5], curve, section).unwrap()
}

/// A configuration far from the one without stress, velocities and accelerations.
pub fn far(beam: &Beam, seed: u64) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let n = beam.velocities();
    let d: Vec<f64> = noise(n, seed).iter().map(|x| 0.35 * x).collect();
    let mut q = beam.initial().to_vec();
    beam.retract(beam.initial(), &d, &mut q);
    (q, noise(n, seed + 1), noise(n, seed + 2))
}

/// A free beam.
pub struct Free {
    pub beam: Beam,
    pub scales: Vec<f64>,
}

impl Free {
    pub fn new(beam: Beam) -> Free {
        Free { scales: vec![1.0; beam.velocities()], beam }
    }
}

impl Dynamics for Free {
    fn size(&self) -> Size {
        Size { q: self.beam.coordinates(), v: self.beam.velocities(), lambda: 0, memory: 0 }
    }
    fn structure(&self, _multipliers: usize) -> Structure {
        let width = self.beam.half_bandwidth();
        Structure::band(self.beam.velocities(), width, width, 0).cheaper()
    }
    fn scales(&self) -> &[f64] {
        &self.scales
    }
    fn initial(&self) -> State {
        let mut state = State::zeros(self.size(), 0.0);
        state.q.copy_from_slice(self.beam.initial());
        state
    }
    fn is_vector_space(&self) -> bool {
        false
    }
    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        self.beam.retract(q, d, out);
    }
    fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        self.beam.difference(from, to, d);
    }
    fn rate(&self, _from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        self.beam.rate(d, v, out);
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        r.fill(0.0);
        self.beam.add_forces([&s.q, &s.v, &s.a], Vec3::ZERO, r);
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        self.beam.add_tangent([&s.q, &s.v, &s.a], Vec3::ZERO, &w, |at, block| {
            for i in 0..VELOCITIES {
                (0..VELOCITIES).for_each(|j| out.add(at + i, at + j, block[i][j]));
            }
        });
    }
}

impl Events for Free {}
impl Steady for Free {}

impl Observed for Free {
    fn energy(&mut self, s: &State) -> Energy {
        Energy {
            kinetic: self.beam.kinetic_energy(&s.q, &s.v),
            strain: self.beam.strain_energy(&s.q),
            gravity: 0.0,
            contact: 0.0,
        }
    }
    fn power(&mut self, s: &State) -> Power {
        Power { dissipated: self.beam.viscous_power(&s.q, &s.v), ..Power::default() }
    }
}

#[test]
fn the_beam_is_what_the_integrators_take_it_for() {
    for damped in [false, true] {
        let mut system = Free::new(general(damped));
        let (q, v, a) = far(&system.beam, 7);
        let mut state = system.initial();
        (state.q, state.v, state.a) = (q, v, a);
        let defects = verify::dynamics(&mut system, &state);
        assert!(defects.is_empty(), "{damped}: {defects:?}");
    }
}

fn tangent(beam: &Beam, [q, v, a]: [&[f64]; 3], w: &Weights<'_>) -> Vec<Vec<f64>> {
    let n = beam.velocities();
    let mut out = vec![vec![0.0; n]; n];
    beam.add_tangent([q, v, a], Vec3::ZERO, w, |at, block| {
        for i in 0..VELOCITIES {
            (0..VELOCITIES).for_each(|j| out[at + i][at + j] += block[i][j]);
        }
    });
    out
}

#[test]
fn the_tangent_by_an_increment_is_that_of_the_forces_by_differences() {
    for damped in [false, true] {
        let beam = general(damped);
        let n = beam.velocities();
        let (q, v, a) = far(&beam, 17);
        let d: Vec<f64> = noise(n, 3).iter().map(|x| 0.3 * x).collect();
        let at = |d: &[f64]| {
            let mut to = q.clone();
            beam.retract(&q, d, &mut to);
            to
        };
        let forces = |d: &[f64]| {
            let mut r = vec![0.0; n];
            beam.add_forces([&at(d), &v, &a], Vec3::ZERO, &mut r);
            r
        };
        let there = at(&d);
        let state = [&there[..], &v, &a];
        let w = Weights { q: 1.0, v: 0.0, a: 0.0, increment: Some(&d) };
        let found = tangent(&beam, state, &w);
        let largest = found.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
        for j in 0..n {
            let moved = |h: f64| {
                let mut d = d.clone();
                d[j] += h;
                forces(&d)
            };
            let [near, far] = [1e-3, 2e-3]
                .map(|h| moved(h).into_iter().zip(moved(-h)).map(|(a, b)| a - b).collect::<Vec<f64>>());
            for i in 0..n {
                let expected = (8.0 * near[i] - far[i]) / 12e-3;
                let error = (found[i][j] - expected).abs() / largest;
                assert!(error < 1e-9, "({i}, {j}): {} for {expected}", found[i][j]);
            }
        }
        // Three weights together are the sum of the three.
        let together = Weights { q: 0.7, v: 0.4, a: -0.2, increment: Some(&d) };
        let parts = [Weights::new(0.0, 1.0, 0.0), Weights::new(1.0, 0.0, 0.0)];
        let [by_v, by_a] = parts.map(|w| tangent(&beam, state, &w));
        for (i, row) in tangent(&beam, state, &together).into_iter().enumerate() {
            for (j, x) in row.into_iter().enumerate() {
                let sum = 0.7 * found[i][j] + 0.4 * by_v[i][j] - 0.2 * by_a[i][j];
                assert!((x - sum).abs() < 1e-13 * largest);
            }
        }
    }
}

#[test]
fn a_rigid_motion_has_no_rates_of_strain() {
    let beam = general(true);
    let (q, ..) = far(&beam, 29);
    let mut v = vec![0.0; beam.velocities()];
    beam.move_rigidly(Vec3([1.0, -2.0, 0.5]), Vec3([0.7, 1.1, -0.4]), &q, &mut v);
    assert!(beam.viscous_power(&q, &v) < 1e-28);
    // It has the momenta of a rigid body.
    let [linear, _] = beam.momenta(&q, &v);
    let root = beam.node(0, &q).position;
    let arm = beam.first_moment(&q) - beam.mass() * root;
    let expected = beam.mass() * Vec3([1.0, -2.0, 0.5]) + Vec3([0.7, 1.1, -0.4]).cross(arm);
    assert!((linear - expected).norm() < 1e-14);
    assert_eq!(v.len() % NODE_VELOCITIES, 0);
}
