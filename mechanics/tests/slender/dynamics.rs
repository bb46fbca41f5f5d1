//! A beam in motion, by the integrators of the library.

use super::derivatives::far;
use super::newton::{distance, equal};
use crate::integrators::drive::fixed;
use flexion::integrator::{GeneralizedAlpha, Integrator, Radau, Tolerance};
use flexion::linalg::vector::noise;
use flexion::linalg::{Matrix, Structure, Vec3};
use flexion::multibody::slender::{Beam, Element, Load, Properties, Station};
use flexion::system::{Dynamics, Energy, Events, Observed, Power, Size, State, Steady, Weights};
use flexion::verify;

/// A beam with a load at its tip and gravity down the z axis; its root may be held.
struct Single {
    held: bool,
    beam: Beam,
    load: Load,
    gravity: f64,
    damping: f64,
    scales: Vec<f64>,
}

impl Single {
    fn new(beam: Beam, held: bool, load: Load, gravity: f64, damping: f64) -> Single {
        let mut beam = beam;
        beam.damp(damping);
        let scales = vec![1.0; beam.velocities()];
        Single { held, beam, load, gravity, damping, scales }
    }

    fn tip(&self) -> (usize, usize) {
        let last = self.beam.elements().len();
        (last, 8 * last)
    }
}

impl Dynamics for Single {
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
    fn rate(&self, from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        self.beam.rate(from, d, v, out);
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        r.fill(0.0);
        self.beam.add_forces(&s.q, &s.v, &s.a, r);
        let (node, at) = self.tip();
        let forces = self.load.forces(&self.beam.node(node, &s.q).1);
        (0..7).for_each(|k| r[at + k] -= forces[k]);
        for (e, element) in self.beam.elements().iter().enumerate() {
            let forces = element.body_force(Vec3([0.0, 0.0, -self.gravity]));
            for (i, force) in [0, 3, 8, 11].into_iter().zip(forces) {
                (0..3).for_each(|k| r[8 * e + i + k] -= force[k]);
            }
        }
        if self.held {
            r[..7].copy_from_slice(&s.a[..7]);
        }
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        self.beam.add_tangent(&s.q, &s.v, &s.a, &w, |at, block| {
            for i in (0..15).filter(|i| !self.held || at + i >= 7) {
                (0..15).for_each(|j| out.add(at + i, at + j, block[i][j]));
            }
        });
        let (node, at) = self.tip();
        let triad = self.beam.node(node, &s.q).1;
        let mut block = self.load.derivative(&triad);
        if let Some(d) = w.increment {
            let turn = triad.spin_by_slope(Vec3([d[at + 3], d[at + 4], d[at + 5]]));
            block.iter_mut().for_each(|row| (0..3).for_each(|k| row[3 + k] += row[6] * turn[k]));
        }
        (0..7).for_each(|i| (0..7).for_each(|j| out.add(at + i, at + j, -w.q * block[i][j])));
        if self.held {
            (0..7).for_each(|i| out.add(i, i, w.a));
        }
    }
}

impl Events for Single {}
impl Steady for Single {}

impl Observed for Single {
    fn energy(&mut self, s: &State) -> Energy {
        let height: f64 = self
            .beam
            .elements()
            .iter()
            .enumerate()
            .map(|(e, element)| element.first_moment(s.q[12 * e..12 * e + 21].try_into().unwrap())[2])
            .sum();
        Energy {
            kinetic: self.beam.kinetic_energy(&s.q, &s.v),
            strain: self.beam.strain_energy(&s.q),
            gravity: self.gravity * height,
            contact: 0.0,
        }
    }
    fn power(&mut self, s: &State) -> Power {
        let (node, at) = self.tip();
        let rates = std::array::from_fn(|k| s.v[at + k]);
        Power {
            loads: self.load.power(&self.beam.node(node, &s.q).1, &rates),
            // −β M v does the power −2 β T.
            dissipated: 2.0 * self.damping * self.beam.kinetic_energy(&s.q, &s.v),
            ..Power::default()
        }
    }
}

/// A beam with a bow and a pretwist, all three inertias, and stiffnesses apart.
fn bowed(elements: usize) -> Beam {
    let curve = |s: f64| {
        let (sin, cos) = (0.8 * s).sin_cos();
        Station {
            position: Vec3([sin / 0.8, (1.0 - cos) / 0.8, 0.0]),
            tangent: Vec3([cos, sin, 0.0]),
            normal: Vec3([0.0, 0.0, 1.0]),
        }
    };
    let section = Properties::principal([300.0, 1.0, 0.7, 2.0], 1.0, [0.02, 0.008, 0.012]);
    Beam::new(&equal(1.0, elements), curve, |_| section).unwrap()
}

#[test]
fn the_beam_is_what_the_integrators_take_it_for() {
    for load in [
        Load::Force(Vec3([0.2, 0.3, -0.5])),
        Load::FollowerForce(Vec3([0.2, 0.3, -0.5])),
        Load::FollowerCouple(Vec3([0.3, 0.6, -0.2])),
    ] {
        let mut system = Single::new(bowed(2), true, load, 3.0, 0.4);
        let (q, mut v, a) = far(&system.beam, 61);
        let mut state = system.initial();
        // The root rests, and is not moved away from where it is held.
        let mut d: Vec<f64> = noise(v.len(), 61).iter().map(|x| 0.25 * x).collect();
        d[..7].fill(0.0);
        v[..7].fill(0.0);
        assert_eq!(q.len(), state.q.len());
        system.beam.retract(system.beam.initial(), &d, &mut state.q);
        state.v.copy_from_slice(&v);
        state.a.copy_from_slice(&a);
        let defects = verify::dynamics(&mut system, &state);
        assert!(defects.is_empty(), "{load:?}: {defects:?}");
    }
}

/// A beam that flies and spins freely: the states at begin and end of equal steps.
fn fly(method: &dyn Integrator, end: f64, steps: usize) -> (Single, State, State) {
    let mut system = Single::new(bowed(3), false, Load::Force(Vec3([0.0; 3])), 2.0, 0.0);
    let mut begin = system.initial();
    let omega = Vec3([1.0, -2.0, 3.0]);
    for node in 0..=3 {
        let (position, triad) = system.beam.node(node, &begin.q);
        omega.cross(position).put(&mut begin.v, 8 * node);
        omega.cross(triad.tangent).put(&mut begin.v, 8 * node + 3);
        begin.v[8 * node + 6] = omega.dot(triad.tangent);
        if node < 3 {
            let q = begin.q[12 * node..12 * node + 21].try_into().unwrap();
            begin.v[8 * node + 7] = omega.dot(system.beam.elements()[node].section(q, 0.5).1.tangent);
        }
    }
    let end = fixed(method, &mut system, begin.clone(), end, steps, |_, _, _, _| {}).unwrap();
    (system, begin, end)
}

#[test]
fn a_free_beam_keeps_its_energy_and_its_momenta() {
    let (mut system, begin, end) = fly(&Radau::new(Tolerance::uniform(1e-11)).unwrap(), 0.5, 400);
    let energy = |system: &mut Single, s: &State| system.energy(s);
    let (before, after) = (energy(&mut system, &begin), energy(&mut system, &end));
    assert!(after.strain > 0.004 * before.kinetic, "it deforms: {after:?}");
    let change = after.total() - before.total();
    assert!(change.abs() < 1e-9 * before.kinetic, "{change}");
    // Momentum and angular momentum about the origin: the forces of inertia for v in the place of a do no other work in rigid
    // velocities than v does.
    let momenta = |s: &State| {
        let (zero, mut p) = (vec![0.0; s.v.len()], vec![0.0; s.v.len()]);
        let mut strain = p.clone();
        system.beam.add_forces(&s.q, &zero, &s.v, &mut p);
        system.beam.add_forces(&s.q, &zero, &zero, &mut strain);
        let (mut linear, mut angular) = (Vec3::ZERO, Vec3::ZERO);
        for node in 0..=3 {
            let (position, triad) = system.beam.node(node, &s.q);
            let of = |at: usize| Vec3::at(&p, 8 * node + at) - Vec3::at(&strain, 8 * node + at);
            linear += of(0);
            angular += position.cross(of(0)) + (triad.length * triad.tangent).cross(of(3));
            let spins = [(6, triad)].into_iter().chain((node < 3).then(|| {
                let q = s.q[12 * node..12 * node + 21].try_into().unwrap();
                (7, system.beam.elements()[node].section(q, 0.5).1)
            }));
            for (at, triad) in spins {
                let spin = p[8 * node + at] - strain[8 * node + at];
                angular += spin * triad.tangent;
            }
        }
        (linear, angular)
    };
    let mass: f64 = system.beam.elements().iter().map(|e| e.mass()).sum();
    let centre = |s: &State| {
        let parts = system.beam.elements().iter().enumerate();
        let moment = |(e, element): (usize, &Element)| {
            element.first_moment(s.q[12 * e..12 * e + 21].try_into().unwrap()) / mass
        };
        parts.map(moment).sum::<Vec3>()
    };
    let ((linear, angular), (linear_end, angular_end)) = (momenta(&begin), momenta(&end));
    let t = end.t;
    let expected = linear - 2.0 * mass * t * Vec3::AXES[2];
    assert!(distance(linear_end, expected) < 1e-11, "{linear_end:?} for {expected:?}");
    // The centre falls in a parabola.
    let (from, to) = (centre(&begin), centre(&end));
    let fallen = from + t / mass * linear - t * t * Vec3::AXES[2];
    assert!(distance(to, fallen) < 1e-11, "{to:?} for {fallen:?}");
    // About the centre, the angular momentum stays.
    let about = |centre: Vec3, linear: Vec3, angular: Vec3| angular - centre.cross(linear);
    let (spin, spin_end) = (about(from, linear, angular), about(to, linear_end, angular_end));
    assert!(distance(spin, spin_end) < 1e-9, "{spin_end:?} for {spin:?}");
}

#[test]
fn integrators_agree_and_keep_their_orders_on_a_free_beam() {
    let apart = |a: &State, b: &State| {
        a.q.iter().zip(&b.q).chain(a.v.iter().zip(&b.v)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
    };
    let radau = |steps| fly(&Radau::new(Tolerance::uniform(1e-12)).unwrap(), 0.1, steps).2;
    let fine = radau(800);
    let alpha = |steps| fly(&GeneralizedAlpha::chung_hulbert(0.8).unwrap(), 0.1, steps).2;
    let errors = [800, 1600].map(|n| apart(&alpha(n), &fine));
    let order = (errors[0] / errors[1]).log2();
    assert!((1.8..2.2).contains(&order), "{errors:?} of order {order}");
    // The iteration error of Radau's method on a group is a part of the first increment, which hides its order.
    let error = apart(&radau(100), &fine);
    assert!(error < 1e-5, "{error}");
}
