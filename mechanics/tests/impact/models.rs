//! Small systems that meet an obstacle, and how they are driven.

use crate::integrators::multibody::GRAVITY;
use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::integrator::{Integrator, Span};
use flexion::linalg::{Matrix, Structure};
use flexion::system::{
    Dynamics, Energy, Events, Observed, RowWeights, Set, Size, State, Steady, System, VisitRow, Weights,
};

/// A linear system M a + K q = f with stops at single unknowns, g = q − place ≥ 0.
pub struct Linear {
    pub mass: Vec<Vec<f64>>,
    pub stiffness: Vec<Vec<f64>>,
    pub force: Vec<f64>,
    pub scales: Vec<f64>,
    pub stops: Vec<(usize, f64)>,
    pub rows: Vec<Set>,
    width: usize,
}

impl Linear {
    pub fn new(mass: Vec<Vec<f64>>, stiffness: Vec<Vec<f64>>, force: Vec<f64>) -> Linear {
        let n = force.len();
        let entry = |i: usize, j: usize| mass[i][j] != 0.0 || stiffness[i][j] != 0.0;
        let width = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let width = width.filter(|(i, j)| entry(*i, *j)).map(|(i, j)| i.abs_diff(j)).max().unwrap_or(0);
        Linear { mass, stiffness, force, scales: vec![1.0; n], stops: Vec::new(), rows: Vec::new(), width }
    }

    pub fn with_stop(mut self, unknown: usize, place: f64, restitution: f64) -> Linear {
        self.stops.push((unknown, place));
        self.rows.push(Set::Unilateral { restitution });
        self
    }

    fn entries(matrix: &[Vec<f64>], width: usize) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        matrix.iter().enumerate().flat_map(move |(i, row)| {
            let (low, high) = (i.saturating_sub(width), (i + width + 1).min(row.len()));
            (low..high).map(move |j| (i, j, row[j]))
        })
    }

    fn form(matrix: &[Vec<f64>], width: usize, x: &[f64]) -> f64 {
        0.5 * Linear::entries(matrix, width).map(|(i, j, a)| a * x[i] * x[j]).sum::<f64>()
    }

    /// A bar of n linear elements from x = 0 to L with EA and ρA: q the displacements of its nodes, consistent mass, or
    /// lumped.
    pub fn bar(n: usize, length: f64, [ea, mass]: [f64; 2], lumped: bool) -> Linear {
        let (h, size) = (length / n as f64, n + 1);
        let mut m = vec![vec![0.0; size]; size];
        let mut k = vec![vec![0.0; size]; size];
        for e in 0..n {
            for i in 0..2 {
                for j in 0..2 {
                    let consistent = if i == j { 2.0 } else { 1.0 } / 6.0;
                    let part = if lumped { if i == j { 0.5 } else { 0.0 } } else { consistent };
                    m[e + i][e + j] += mass * h * part;
                    k[e + i][e + j] += if i == j { ea / h } else { -ea / h };
                }
            }
        }
        Linear::new(m, k, vec![0.0; size])
    }

    /// A beam of n cubic elements from x = 0 to L with EI and ρA, clamped at x = 0 or free: deflection and slope of each
    /// node, the slope times the length of an element.
    pub fn beam(n: usize, length: f64, [ei, mass]: [f64; 2], clamped: bool) -> Linear {
        let (h, size) = (length / n as f64, 2 * n + 2);
        let bending = [
            [12.0, 6.0, -12.0, 6.0],
            [6.0, 4.0, -6.0, 2.0],
            [-12.0, -6.0, 12.0, -6.0],
            [6.0, 2.0, -6.0, 4.0],
        ];
        let inertia = [
            [156.0, 22.0, 54.0, -13.0],
            [22.0, 4.0, 13.0, -3.0],
            [54.0, 13.0, 156.0, -22.0],
            [-13.0, -3.0, -22.0, 4.0],
        ];
        let mut m = vec![vec![0.0; size]; size];
        let mut k = vec![vec![0.0; size]; size];
        for e in 0..n {
            for i in 0..4 {
                for j in 0..4 {
                    m[2 * e + i][2 * e + j] += mass * h / 420.0 * inertia[i][j];
                    k[2 * e + i][2 * e + j] += ei / h.powi(3) * bending[i][j];
                }
            }
        }
        let first = if clamped { 2 } else { 0 };
        let cut = |a: Vec<Vec<f64>>| a[first..].iter().map(|row| row[first..].to_vec()).collect();
        Linear::new(cut(m), cut(k), vec![0.0; size - first])
    }

    /// Adds a weight across the beam, −g times the mass times a deflection of 1.
    pub fn with_gravity_across(mut self, gravity: f64) -> Linear {
        for (force, row) in self.force.iter_mut().zip(&self.mass) {
            *force -= gravity * row.iter().step_by(2).sum::<f64>();
        }
        self
    }

    /// Adds the weight of every node, −g times the row sum of the mass.
    pub fn with_gravity(mut self, gravity: f64) -> Linear {
        for (force, row) in self.force.iter_mut().zip(&self.mass) {
            *force -= gravity * row.iter().sum::<f64>();
        }
        self
    }
}

impl Events for Linear {}
impl Steady for Linear {}

impl Dynamics for Linear {
    fn size(&self) -> Size {
        Size { q: self.force.len(), v: self.force.len(), lambda: self.rows.len(), memory: 0 }
    }
    fn structure(&self, multipliers: usize) -> Structure {
        let (n, m) = (self.force.len(), multipliers * self.rows.len());
        Structure::band(n, self.width, self.width, m).cheaper()
    }
    fn scales(&self) -> &[f64] {
        &self.scales
    }
    fn is_affine(&self) -> bool {
        true
    }
    fn rows(&self) -> &[Set] {
        &self.rows
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        r.iter_mut().zip(&self.force).for_each(|(r, f)| *r = -f);
        for (i, j, m) in Linear::entries(&self.mass, self.width) {
            r[i] += m * s.a[j];
        }
        for (i, j, k) in Linear::entries(&self.stiffness, self.width) {
            r[i] += k * s.q[j];
        }
        for ((unknown, _), lambda) in self.stops.iter().zip(&s.lambda) {
            r[*unknown] -= lambda;
        }
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        for ((unknown, place), g) in self.stops.iter().zip(g) {
            *g = c.combine(s.q[*unknown] - place, s.v[*unknown], s.a[*unknown]);
        }
    }
    fn jacobian(&mut self, _s: &State, visit: &mut VisitRow<'_>) {
        for (row, (unknown, _)) in self.stops.iter().enumerate() {
            visit(row, &[*unknown], &[1.0]);
        }
    }
    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        for (i, j, m) in Linear::entries(&self.mass, self.width) {
            out.add(i, j, w.a * m + w.q * self.stiffness[i][j]);
        }
    }
}

impl Observed for Linear {
    fn energy(&mut self, s: &State) -> Energy {
        Energy {
            kinetic: Linear::form(&self.mass, self.width, &s.v),
            strain: Linear::form(&self.stiffness, self.width, &s.q),
            gravity: -self.force.iter().zip(&s.q).map(|(f, q)| f * q).sum::<f64>(),
            ..Energy::default()
        }
    }
}

/// Steps of size `step` from `from` to `end`; the callback sees the states at both ends of each.
pub fn steps(
    integrator: &dyn Integrator,
    system: &mut dyn System,
    mut from: State,
    (end, step): (f64, f64),
    mut each: impl FnMut(&mut dyn System, &State, &State),
) -> State {
    let mut integrator = integrator.start(system, &mut from, step).unwrap();
    let mut to = from.clone();
    let origin = from.t;
    let count = ((end - origin) / step).round() as u64;
    for k in 1..=count {
        let span = Span { end: origin + k as f64 * step, ..Span::new(from.t, step) };
        integrator.step(system, &from, span, &mut to).unwrap();
        integrator.accept(&from, &to);
        each(system, &from, &to);
        std::mem::swap(&mut from, &mut to);
    }
    from
}

/// Observes nothing.
pub struct Blind;

impl Observer for Blind {
    fn sample(&mut self, _system: &mut dyn System, _state: &State, _step: &Step) {}
}

/// A run to its end.
pub fn rest(system: &mut dyn System, method: &dyn Integrator, state: &mut State, plan: &Plan) {
    assert_eq!(transient(system, method, state, plan, &mut Blind), Ending::Finished);
}

/// A block of mass 1 on an incline with the slope α and friction: q along it, downwards, and away from it, and, where it
/// has rows of friction in two directions, along it sideways.
pub struct Block {
    pub slope: f64,
    rows: Vec<Set>,
}

impl Block {
    pub fn new(slope: f64, coefficient: f64) -> Block {
        let friction = Set::Friction { coefficient, normal: 0 };
        Block { slope, rows: vec![Set::Unilateral { restitution: 0.0 }, friction] }
    }

    pub fn with_sideways(mut self) -> Block {
        self.rows.push(self.rows[1]);
        self
    }

    /// Unknown of each row.
    const UNKNOWN: [usize; 3] = [1, 0, 2];
}

impl Events for Block {}
impl Steady for Block {}
impl Observed for Block {}

impl Dynamics for Block {
    fn size(&self) -> Size {
        let n = self.rows.len();
        Size { q: n, v: n, lambda: n, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0; 3][..self.rows.len()]
    }
    fn rows(&self) -> &[Set] {
        &self.rows
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        r.copy_from_slice(&s.a);
        r[0] -= GRAVITY * self.slope.sin();
        r[1] += GRAVITY * self.slope.cos();
        for (lambda, unknown) in s.lambda.iter().zip(Block::UNKNOWN) {
            r[unknown] -= lambda;
        }
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        for ((k, g), unknown) in g.iter_mut().enumerate().zip(Block::UNKNOWN) {
            let gap = if k == 0 { s.q[unknown] } else { 0.0 };
            *g = c.combine(gap, s.v[unknown], s.a[unknown]);
        }
    }
    fn jacobian(&mut self, _s: &State, visit: &mut VisitRow<'_>) {
        for (row, unknown) in Block::UNKNOWN.into_iter().enumerate().take(self.rows.len()) {
            visit(row, &[unknown], &[1.0]);
        }
    }
    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        (0..self.rows.len()).for_each(|i| out.add(i, i, w.a));
    }
}

/// A uniform rigid rod that falls about its end, q its angle over the horizontal; its tip meets the ground y = 0.
pub struct Rod {
    pub mass: f64,
    pub length: f64,
    rows: [Set; 1],
}

impl Rod {
    pub fn new(restitution: f64) -> Rod {
        Rod { mass: 0.8, length: 1.0, rows: [Set::Unilateral { restitution }] }
    }

    pub fn inertia(&self) -> f64 {
        self.mass * self.length * self.length / 3.0
    }
}

impl Events for Rod {}
impl Steady for Rod {}

impl Dynamics for Rod {
    fn size(&self) -> Size {
        Size { q: 1, v: 1, lambda: 1, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0]
    }
    fn rows(&self) -> &[Set] {
        &self.rows
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let cos = s.q[0].cos();
        r[0] = self.inertia() * s.a[0] + 0.5 * self.mass * GRAVITY * self.length * cos
            - self.length * cos * s.lambda[0];
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        let (sin, cos) = s.q[0].sin_cos();
        let bend = cos * s.a[0] - sin * s.v[0] * s.v[0];
        g[0] = c.combine(self.length * sin, self.length * cos * s.v[0], self.length * bend);
    }
    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        visit(0, &[0], &[self.length * s.q[0].cos()]);
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        let moment = (s.lambda[0] - 0.5 * self.mass * GRAVITY) * self.length * s.q[0].sin();
        out.add(0, 0, w.a * self.inertia() + w.q * moment);
    }
}

impl Observed for Rod {
    fn energy(&mut self, s: &State) -> Energy {
        Energy {
            kinetic: 0.5 * self.inertia() * s.v[0] * s.v[0],
            gravity: 0.5 * self.mass * GRAVITY * self.length * s.q[0].sin(),
            ..Energy::default()
        }
    }
}
