//! A model's equations, by differences.

use super::{ALLOWED, Defect};
use crate::integrator::{GeneralizedAlpha, Integrator};
use crate::linalg::Matrix;
use crate::system::{RowWeights, State, System, Weights};

/// Increment of an unknown for differences, over its scale.
const INCREMENT: f64 = 1e-3;

/// Checks of one model at one state.
struct Checker<'a> {
    system: &'a mut dyn System,
    scales: Vec<f64>,
    defects: Vec<Defect>,
}

/// Checks the model `system` at the state `s`; the result is empty if it passes. Accelerations and multipliers of `s` are used as
/// they are, but for the power, where they are replaced by consistent ones.
pub fn dynamics(system: &mut dyn System, s: &State) -> Vec<Defect> {
    let scales = system.scales().to_vec();
    let mut checker = Checker { system, scales, defects: Vec::new() };
    checker.tangent(s);
    checker.rows(s);
    checker.configuration(s);
    checker.power(s);
    checker.defects
}

impl Checker<'_> {
    /// Records where `found` is not `expected`; errors are measured by the largest of `expected`.
    fn compare(
        &mut self,
        check: &'static str,
        place: impl Fn(usize) -> String,
        found: &[f64],
        expected: &[f64],
        floor: f64,
    ) {
        let size = expected.iter().chain(found).fold(floor, |m, x| m.max(x.abs()));
        for (i, (&found, &expected)) in found.iter().zip(expected).enumerate() {
            if !((found - expected).abs() <= ALLOWED * size) {
                self.defects.push(Defect { check, place: place(i), found, expected });
                return;
            }
        }
    }

    /// Derivative at 0 of a vector function, by the central difference of order 4.
    fn derivative(step: f64, n: usize, mut f: impl FnMut(f64, &mut [f64])) -> Vec<f64> {
        let mut sum = vec![0.0; n];
        let mut value = vec![0.0; n];
        for (k, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
            f(k * step, &mut value);
            sum.iter_mut().zip(&value).for_each(|(sum, x)| *sum += weight * x / (12.0 * step));
        }
        sum
    }

    fn tangent(&mut self, s: &State) {
        let n = s.v.len();
        let mut r = vec![0.0; n];
        self.system.residual(s, &mut r);
        let largest = r.iter().fold(0.0_f64, |m, r| m.max(r.abs()));
        let names: Vec<String> = (0..n).map(|i| self.system.unknown(i)).collect();
        let m = s.lambda.len();
        let mut matrix = Matrix::new(&self.system.structure(usize::from(m > 0)));
        for (kind, check) in ["∂r/∂a", "∂r/∂v", "∂r/∂q"].into_iter().enumerate() {
            let w = |k| if kind == k { 1.0 } else { 0.0 };
            // Equations of multipliers, as an integrator leaves them there.
            (n..n + m).for_each(|i| matrix.add(i, i, 1.0));
            self.system.tangent(s, Weights::new(w(0), w(1), w(2)), &mut matrix);
            let left: Vec<f64> = (n..n + m).map(|i| matrix.get(i, i)).collect();
            self.compare("tangent, rest", |i| format!("multiplier {i}"), &left, &vec![0.0; m], 1.0);
            // Columns are compared in units of the largest entry of their kind.
            let mut floor = 0.0_f64;
            for i in 0..n {
                for j in 0..n {
                    floor = floor.max(matrix.get(i, j).abs());
                }
            }
            for j in 0..n {
                let (mut moved, mut d) = (s.clone(), vec![0.0; n]);
                let step = INCREMENT * self.scales[j];
                let system = &mut *self.system;
                let expected = Checker::derivative(step, n, |x, r| {
                    match kind {
                        0 => moved.a[j] = s.a[j] + x,
                        1 => moved.v[j] = s.v[j] + x,
                        _ => {
                            d[j] = x;
                            system.retract(&s.q, &d, &mut moved.q);
                        }
                    }
                    system.residual(&moved, r);
                });
                let found: Vec<f64> = (0..n).map(|i| matrix.get(i, j)).collect();
                let place = |i: usize| format!("equation of {} by {}", names[i], names[j]);
                // What the rounding of r leaves in a difference.
                let rounding = 1e-6 * largest / self.scales[j];
                self.compare(check, place, &found, &expected, rounding.max(1e-3 * floor));
            }
        }
    }

    fn rows(&mut self, s: &State) {
        let (n, m) = (s.v.len(), s.lambda.len());
        if m == 0 {
            return;
        }
        let mut jacobian = vec![0.0; m * n];
        self.system.jacobian(s, &mut |row, velocities, entries| {
            for (&j, &x) in velocities.iter().zip(entries) {
                jacobian[row * n + j] += x;
            }
        });
        let row = |i: usize| format!("row {i}");
        for j in 0..n {
            let mut moved = s.clone();
            let system = &mut *self.system;
            let expected = Checker::derivative(1.0, m, |x, g| {
                moved.v[j] = s.v[j] + x;
                system.constraint(&moved, RowWeights::VELOCITY, g);
            });
            let found: Vec<f64> = (0..m).map(|i| jacobian[i * n + j]).collect();
            self.compare("G", row, &found, &expected, 1e-3);
        }
        for i in 0..m {
            let mut moved = s.clone();
            let system = &mut *self.system;
            let expected = Checker::derivative(1.0, n, |x, r| {
                moved.lambda[i] = s.lambda[i] + x;
                system.residual(&moved, r);
                r.iter_mut().for_each(|r| *r = -*r);
            });
            let found = jacobian[i * n..(i + 1) * n].to_vec();
            self.compare("Gᵀ λ in r", |j| format!("row {i}, unknown {j}"), &found, &expected, 1e-3);
        }
        // Along q(t) = q ⊞ (v t + a t²/2), v + a t.
        let holonomic: Vec<bool> = self
            .system
            .rows()
            .iter()
            .map(|set| !matches!(set, crate::system::Set::Friction { .. }))
            .collect();
        for (check, low, high) in [
            ("ġ", RowWeights::POSITION, RowWeights::VELOCITY),
            ("g̈", RowWeights::VELOCITY, RowWeights::ACCELERATION),
        ] {
            let system = &mut *self.system;
            let expected = Checker::derivative(1e-3, m, |t, g| {
                system.constraint(&along(system, s, t), low, g);
            });
            let mut found = vec![0.0; m];
            self.system.constraint(s, high, &mut found);
            let mut expected = expected;
            for i in (0..m).filter(|i| check == "ġ" && !holonomic[*i]) {
                expected[i] = found[i];
            }
            self.compare(check, row, &found, &expected, 1.0);
        }
    }

    fn configuration(&mut self, s: &State) {
        let n = s.v.len();
        let d: Vec<f64> = (0..n).map(|i| 0.3 * self.scales[i] * libm::sin(1.7 * i as f64 + 0.4)).collect();
        let (mut q, mut back) = (s.q.clone(), vec![0.0; n]);
        self.system.retract(&s.q, &d, &mut q);
        self.system.difference(&s.q, &q, &mut back);
        self.compare("(q ⊞ d) ⊟ q", |i| format!("unknown {i}"), &back, &d, 1e-3);
        let mut rate = vec![0.0; n];
        self.system.rate(&s.q, &d, &s.v, &mut rate);
        let system = &mut *self.system;
        let (mut increment, mut moved) = (d.clone(), q.clone());
        let found = Checker::derivative(1e-3, n, |t, out| {
            for i in 0..n {
                increment[i] = d[i] + t * rate[i];
            }
            system.retract(&s.q, &increment, &mut moved);
            system.difference(&q, &moved, out);
        });
        self.compare("T(d)⁻¹ v", |i| format!("unknown {i}"), &found, &s.v.clone(), 1e-3);
    }

    fn power(&mut self, s: &State) {
        let mut s = s.clone();
        let Ok(method) = GeneralizedAlpha::newmark(0.25, 0.5) else { return };
        if let Err(error) = method.start(self.system, &mut s, 1e-3) {
            let (check, place) = ("accelerations", error.to_string());
            self.defects.push(Defect { check, place, found: f64::NAN, expected: 0.0 });
            return;
        }
        let power = self.system.power(&s).total();
        // Short against the time in which the acceleration moves an unknown by its scale.
        let times = s.a.iter().zip(&self.scales).map(|(a, scale)| libm::sqrt(scale / a.abs()));
        let step = times.fold(0.1, f64::min) * 1e-3;
        let system = &mut *self.system;
        let rate = Checker::derivative(step, 1, |t, e| {
            e[0] = system.energy(&along(system, &s, t)).total();
        });
        // Power of single forces, which may cancel.
        let mut forces = vec![0.0; s.v.len()];
        self.system.residual(&State { a: vec![0.0; s.a.len()], ..s.clone() }, &mut forces);
        let size = forces.iter().zip(&s.v).fold(0.0_f64, |m, (f, v)| m.max((f * v).abs()));
        // What the rounding of the energy leaves in a difference.
        let energy = self.system.energy(&s);
        let size = size.max(1e-9 * (energy.kinetic + energy.total().abs()) / step);
        self.compare("dE/dt", |_| "power".to_owned(), &[power], &rate, size);
    }
}

/// The state at t + `dt` of the motion that has the velocity and acceleration of `s` at t.
fn along(system: &dyn System, s: &State, dt: f64) -> State {
    let mut out = s.clone();
    let d: Vec<f64> = s.v.iter().zip(&s.a).map(|(v, a)| dt * (v + 0.5 * dt * a)).collect();
    system.retract(&s.q, &d, &mut out.q);
    out.v.iter_mut().zip(&s.a).for_each(|(v, a)| *v += dt * a);
    out.t = s.t + dt;
    out
}
