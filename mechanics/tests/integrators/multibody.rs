//! Five small systems with contacts, friction, joints and rotations: those that the seam was cut for.

#![allow(dead_code)]

use flexion::linalg::Matrix;
use flexion::system::{
    Dynamics, Energy, Events, Observed, RowWeights, Set, Size, State, Steady, VisitRow, Weights,
};

macro_rules! plain {
    ($($system:ty),*) => {
        $(impl Events for $system {} impl Steady for $system {})*
    };
}
plain!(BallsOnWall, HeavyTop, FourBar, MasslessNode, BallOnMovingWall);

/// Acceleration of gravity [m/s²].
pub const GRAVITY: f64 = 9.81;

/// Two balls of radius R, mass m, inertia ⅖mR², joined by a rod without mass from centre to centre, on a rigid floor:
/// q = (x₁, y₁, φ₁, x₂, y₂, φ₂); floor and friction of both, and the rod.
pub struct BallsOnWall {
    pub mass: f64,
    pub radius: f64,
    pub length: f64,
    rows: Vec<Set>,
}

impl BallsOnWall {
    pub fn new(restitution: f64, friction: [f64; 2]) -> BallsOnWall {
        let unilateral = Set::Unilateral { restitution };
        let rows = vec![
            unilateral,
            unilateral,
            Set::Friction { coefficient: friction[0], normal: 0 },
            Set::Friction { coefficient: friction[1], normal: 1 },
            Set::Free,
        ];
        BallsOnWall { mass: 0.5, radius: 0.1, length: 0.7, rows }
    }

    pub fn inertia(&self) -> f64 {
        0.4 * self.mass * self.radius * self.radius
    }

    fn rod(s: &State) -> [f64; 2] {
        [s.q[3] - s.q[0], s.q[4] - s.q[1]]
    }
}

impl Dynamics for BallsOnWall {
    fn size(&self) -> Size {
        Size { q: 6, v: 6, lambda: 5, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0; 6]
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let [dx, dy] = BallsOnWall::rod(s);
        for k in 0..2 {
            let (i, sign) = (3 * k, if k == 0 { -1.0 } else { 1.0 });
            r[i] = self.mass * s.a[i] - s.lambda[2 + k] - sign * dx * s.lambda[4];
            r[i + 1] = self.mass * (s.a[i + 1] + GRAVITY) - s.lambda[k] - sign * dy * s.lambda[4];
            r[i + 2] = self.inertia() * s.a[i + 2] - self.radius * s.lambda[2 + k];
        }
    }
    fn rows(&self) -> &[Set] {
        &self.rows
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        for k in 0..2 {
            let i = 3 * k;
            g[k] = c.combine(s.q[i + 1] - self.radius, s.v[i + 1], s.a[i + 1]);
            let slide = |x: &[f64]| x[i] + self.radius * x[i + 2];
            g[2 + k] = c.combine(0.0, slide(&s.v), slide(&s.a));
        }
        let [dx, dy] = BallsOnWall::rod(s);
        let (u, w) = (s.v[3] - s.v[0], s.v[4] - s.v[1]);
        let (p, b) = (s.a[3] - s.a[0], s.a[4] - s.a[1]);
        g[4] = c.combine(
            0.5 * (dx * dx + dy * dy - self.length * self.length),
            dx * u + dy * w,
            u * u + w * w + dx * p + dy * b,
        );
    }
    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        visit(0, &[1], &[1.0]);
        visit(1, &[4], &[1.0]);
        visit(2, &[0, 2], &[1.0, self.radius]);
        visit(3, &[3, 5], &[1.0, self.radius]);
        let [dx, dy] = BallsOnWall::rod(s);
        visit(4, &[0, 1, 3, 4], &[-dx, -dy, dx, dy]);
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        let lambda = w.q * s.lambda[4];
        for k in 0..2 {
            let (i, other) = (3 * k, 3 * (1 - k));
            out.add(i + 2, i + 2, w.a * self.inertia());
            for axis in 0..2 {
                out.add(i + axis, i + axis, w.a * self.mass - lambda);
                out.add(i + axis, other + axis, lambda);
            }
        }
    }
}

impl Observed for BallsOnWall {
    fn energy(&mut self, s: &State) -> Energy {
        let mut energy = Energy::default();
        for i in [0, 3] {
            energy.kinetic += 0.5 * self.mass * (s.v[i] * s.v[i] + s.v[i + 1] * s.v[i + 1])
                + 0.5 * self.inertia() * s.v[i + 2] * s.v[i + 2];
            energy.gravity += self.mass * GRAVITY * s.q[i + 1];
        }
        energy
    }
}

/// A symmetric top about a fixed point: q a unit quaternion (w, x, y, z), v the angular velocity in the body's axes, its
/// third axis the axis of symmetry with the centre of mass at the distance l. I₁, I₃ about the fixed point.
pub struct HeavyTop {
    pub inertia: [f64; 3],
    /// m g l [N·m]
    pub moment: f64,
}

impl HeavyTop {
    pub fn new() -> HeavyTop {
        HeavyTop { inertia: [0.8, 0.8, 0.25], moment: 1.9 }
    }

    /// The vertical in the body's axes.
    fn vertical(q: &[f64]) -> [f64; 3] {
        let [w, x, y, z] = [q[0], q[1], q[2], q[3]];
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z]
    }

    /// The axis of symmetry in the inertial axes.
    pub fn axis(q: &[f64]) -> [f64; 3] {
        let [w, x, y, z] = [q[0], q[1], q[2], q[3]];
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), w * w - x * x - y * y + z * z]
    }

    /// Angular momentum about the vertical.
    pub fn momentum(&self, s: &State) -> f64 {
        HeavyTop::vertical(&s.q).iter().zip(&self.inertia).zip(&s.v).map(|((e, i), w)| e * i * w).sum()
    }
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn product(p: &[f64], q: &[f64]) -> [f64; 4] {
    [
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    ]
}

/// The quaternion of a rotation vector.
pub fn exponential(d: &[f64]) -> [f64; 4] {
    let angle = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
    let part = if angle > 1e-8 { (0.5 * angle).sin() / angle } else { 0.5 - angle * angle / 48.0 };
    [(0.5 * angle).cos(), part * d[0], part * d[1], part * d[2]]
}

impl Dynamics for HeavyTop {
    fn size(&self) -> Size {
        Size { q: 4, v: 3, lambda: 0, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0; 3]
    }
    fn initial(&self) -> State {
        let mut s = State::zeros(self.size(), 0.0);
        s.q[0] = 1.0;
        s
    }
    fn is_vector_space(&self) -> bool {
        false
    }
    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        let moved = product(q, &exponential(d));
        let size = moved.iter().map(|x| x * x).sum::<f64>().sqrt();
        out.iter_mut().zip(moved).for_each(|(out, x)| *out = x / size);
    }
    fn difference(&self, from: &[f64], to: &[f64], d: &mut [f64]) {
        let inverse = [from[0], -from[1], -from[2], -from[3]];
        let turn = product(&inverse, to);
        let sine = (turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]).sqrt();
        let half = sine.atan2(turn[0]);
        let part = if sine > 1e-12 { 2.0 * half / sine } else { 2.0 };
        d.iter_mut().zip(&turn[1..]).for_each(|(d, x)| *d = part * x);
    }
    /// ḋ = v + ½ d × v + (1 − (a/2) cot(a/2))/a² d × (d × v), a = |d|
    fn rate(&self, _from: &[f64], d: &[f64], v: &[f64], out: &mut [f64]) {
        let (d, v) = ([d[0], d[1], d[2]], [v[0], v[1], v[2]]);
        let square: f64 = d.iter().map(|x| x * x).sum();
        let half = 0.5 * square.sqrt();
        let part =
            if square > 1e-6 { (1.0 - half / half.tan()) / square } else { 1.0 / 12.0 + square / 720.0 };
        let once = cross(d, v);
        let twice = cross(d, once);
        for i in 0..3 {
            out[i] = v[i] + 0.5 * once[i] + part * twice[i];
        }
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let w = [s.v[0], s.v[1], s.v[2]];
        let l: [f64; 3] = std::array::from_fn(|i| self.inertia[i] * w[i]);
        let gyro = cross(w, l);
        // Weight −(m g) e_z at l in the third axis: moment l × (−m g e) = m g l (e₂, −e₁, 0).
        let e = HeavyTop::vertical(&s.q);
        let applied = [self.moment * e[1], -self.moment * e[0], 0.0];
        for i in 0..3 {
            r[i] = self.inertia[i] * s.a[i] + gyro[i] - applied[i];
        }
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        let omega = [s.v[0], s.v[1], s.v[2]];
        let l: [f64; 3] = std::array::from_fn(|i| self.inertia[i] * omega[i]);
        let e = HeavyTop::vertical(&s.q);
        for j in 0..3 {
            let unit: [f64; 3] = std::array::from_fn(|i| if i == j { 1.0 } else { 0.0 });
            let scaled: [f64; 3] = std::array::from_fn(|i| self.inertia[i] * unit[i]);
            let (a, b) = (cross(unit, l), cross(omega, scaled));
            // δe = e × δd, with an increment in the step behind T(d), which differs from 1 by the step.
            let de = cross(e, unit);
            let moment = [-self.moment * de[1], self.moment * de[0], 0.0];
            for i in 0..3 {
                let mass = if i == j { w.a * self.inertia[i] } else { 0.0 };
                out.add(i, j, mass + w.v * (a[i] + b[i]) + w.q * moment[i]);
            }
        }
    }
}

impl Observed for HeavyTop {
    fn energy(&mut self, s: &State) -> Energy {
        let kinetic = 0.5 * self.inertia.iter().zip(&s.v).map(|(i, w)| i * w * w).sum::<f64>();
        Energy { kinetic, gravity: self.moment * HeavyTop::vertical(&s.q)[2], ..Energy::default() }
    }
}

/// A closed four-bar chain that is a parallelogram: two cranks of length a hung from the ground, and a coupler of length
/// b; uniform bars, each with q = (x, y, φ) of its centre; four joints, eight rows.
pub struct FourBar {
    pub crank: f64,
    pub coupler: f64,
    pub density: f64,
    rows: Vec<Set>,
}

/// An end of a bar: number of the bar, or the ground, and place along it from its centre.
type End = (Option<usize>, [f64; 2]);

impl FourBar {
    pub fn new() -> FourBar {
        FourBar { crank: 0.4, coupler: 0.9, density: 2.0, rows: vec![Set::Free; 8] }
    }

    pub fn bars(&self) -> [f64; 3] {
        [self.crank, self.coupler, self.crank]
    }

    fn masses(&self, bar: usize) -> [f64; 3] {
        let length = self.bars()[bar];
        let m = self.density * length;
        [m, m, m * length * length / 12.0]
    }

    /// The state with both cranks at the angle `theta` from the vertical, turning at `rate`.
    pub fn swung(&self, theta: f64, rate: f64) -> State {
        let mut s = State::zeros(self.size(), 0.0);
        let (sin, cos) = theta.sin_cos();
        let (a, b) = (self.crank, self.coupler);
        let crank = theta - std::f64::consts::FRAC_PI_2;
        for (bar, x, part) in [(0, 0.0, 0.5), (1, 0.5 * b, 1.0), (2, b, 0.5)] {
            s.q[3 * bar..3 * bar + 3].copy_from_slice(&[
                x + part * a * sin,
                -part * a * cos,
                if bar == 1 { 0.0 } else { crank },
            ]);
            s.v[3 * bar..3 * bar + 3].copy_from_slice(&[
                part * a * cos * rate,
                part * a * sin * rate,
                if bar == 1 { 0.0 } else { rate },
            ]);
        }
        s
    }

    fn joints(&self) -> [[End; 2]; 4] {
        let (a, b) = (0.5 * self.crank, 0.5 * self.coupler);
        [
            [(None, [0.0, 0.0]), (Some(0), [-a, 0.0])],
            [(Some(0), [a, 0.0]), (Some(1), [-b, 0.0])],
            [(Some(1), [b, 0.0]), (Some(2), [a, 0.0])],
            [(Some(2), [-a, 0.0]), (None, [self.coupler, 0.0])],
        ]
    }
}

impl Dynamics for FourBar {
    fn size(&self) -> Size {
        Size { q: 9, v: 9, lambda: 8, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0; 9]
    }
    fn rows(&self) -> &[Set] {
        &self.rows
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        for bar in 0..3 {
            let m = self.masses(bar);
            for i in 0..3 {
                r[3 * bar + i] = m[i] * s.a[3 * bar + i];
            }
            r[3 * bar + 1] += m[1] * GRAVITY;
        }
        let lambda = s.lambda.clone();
        self.jacobian(s, &mut |row, velocities, entries| {
            for (&j, &x) in velocities.iter().zip(entries) {
                r[j] -= x * lambda[row];
            }
        });
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        for (k, ends) in self.joints().iter().enumerate() {
            let mut sum = [0.0; 2];
            for ((bar, at), sign) in ends.iter().zip([1.0, -1.0]) {
                let Some(bar) = bar else {
                    for i in 0..2 {
                        sum[i] += sign * c.combine(at[i], 0.0, 0.0);
                    }
                    continue;
                };
                let (q, v, a) = (&s.q[3 * bar..], &s.v[3 * bar..], &s.a[3 * bar..]);
                let (sin, cos) = q[2].sin_cos();
                let (arm, normal) = ([at[0] * cos, at[0] * sin], [-at[0] * sin, at[0] * cos]);
                for i in 0..2 {
                    sum[i] += sign
                        * c.combine(
                            q[i] + arm[i],
                            v[i] + normal[i] * v[2],
                            a[i] + normal[i] * a[2] - arm[i] * v[2] * v[2],
                        );
                }
            }
            g[2 * k..2 * k + 2].copy_from_slice(&sum);
        }
    }
    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        for (k, ends) in self.joints().iter().enumerate() {
            for i in 0..2 {
                for ((bar, at), sign) in ends.iter().zip([1.0, -1.0]) {
                    if let Some(bar) = bar {
                        let (sin, cos) = s.q[3 * bar + 2].sin_cos();
                        let normal = [-at[0] * sin, at[0] * cos];
                        visit(2 * k + i, &[3 * bar + i, 3 * bar + 2], &[sign, sign * normal[i]]);
                    }
                }
            }
        }
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        for bar in 0..3 {
            let m = self.masses(bar);
            for i in 0..3 {
                out.add(3 * bar + i, 3 * bar + i, w.a * m[i]);
            }
        }
        // −∂(Gᵀλ)/∂φ: the arms turn.
        for (k, ends) in self.joints().iter().enumerate() {
            for ((bar, at), sign) in ends.iter().zip([1.0, -1.0]) {
                if let Some(bar) = bar {
                    let (sin, cos) = s.q[3 * bar + 2].sin_cos();
                    let arm = [at[0] * cos, at[0] * sin];
                    let turn = arm[0] * s.lambda[2 * k] + arm[1] * s.lambda[2 * k + 1];
                    out.add(3 * bar + 2, 3 * bar + 2, w.q * sign * turn);
                }
            }
        }
    }
}

impl Observed for FourBar {
    fn energy(&mut self, s: &State) -> Energy {
        let mut energy = Energy::default();
        for bar in 0..3 {
            let m = self.masses(bar);
            energy.kinetic += (0..3).map(|i| 0.5 * m[i] * s.v[3 * bar + i].powi(2)).sum::<f64>();
            energy.gravity += m[1] * GRAVITY * s.q[3 * bar + 1];
        }
        energy
    }
}

/// A mass m at x₁ and a node without mass at x₂ < x₁ before it, joined by a spring k that is relaxed at x₁ − x₂ = ℓ; a
/// stop at x₂ = 0.
pub struct MasslessNode {
    pub mass: f64,
    pub stiffness: f64,
    pub length: f64,
    rows: [Set; 1],
}

impl MasslessNode {
    pub fn new() -> MasslessNode {
        let rows = [Set::Unilateral { restitution: 0.0 }];
        MasslessNode { mass: 0.3, stiffness: 700.0, length: 0.2, rows }
    }
}

impl Dynamics for MasslessNode {
    fn size(&self) -> Size {
        Size { q: 2, v: 2, lambda: 1, memory: 0 }
    }
    fn scales(&self) -> &[f64] {
        &[1.0; 2]
    }
    fn rows(&self) -> &[Set] {
        &self.rows
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let force = self.stiffness * (s.q[0] - s.q[1] - self.length);
        r[0] = self.mass * s.a[0] + force;
        r[1] = -force - s.lambda[0];
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        g[0] = c.combine(s.q[1], s.v[1], s.a[1]);
    }
    fn jacobian(&mut self, _s: &State, visit: &mut VisitRow<'_>) {
        visit(0, &[1], &[1.0]);
    }
    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        out.add(0, 0, w.a * self.mass);
        for (i, j, sign) in [(0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)] {
            out.add(i, j, sign * w.q * self.stiffness);
        }
    }
}

impl Observed for MasslessNode {
    fn energy(&mut self, s: &State) -> Energy {
        let stretch = s.q[0] - s.q[1] - self.length;
        Energy {
            kinetic: 0.5 * self.mass * s.v[0] * s.v[0],
            strain: 0.5 * self.stiffness * stretch * stretch,
            ..Energy::default()
        }
    }
}

/// A ball of mass 1 that falls on a plate at A sin Ωt.
pub struct BallOnMovingWall {
    pub amplitude: f64,
    pub frequency: f64,
    rows: [Set; 1],
}

impl BallOnMovingWall {
    pub fn new(restitution: f64) -> BallOnMovingWall {
        BallOnMovingWall { amplitude: 0.02, frequency: 30.0, rows: [Set::Unilateral { restitution }] }
    }

    /// Height, velocity and acceleration of the plate.
    pub fn wall(&self, t: f64) -> [f64; 3] {
        let (a, w) = (self.amplitude, self.frequency);
        let (sin, cos) = (w * t).sin_cos();
        [a * sin, a * w * cos, -a * w * w * sin]
    }
}

impl Dynamics for BallOnMovingWall {
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
        r[0] = s.a[0] + GRAVITY - s.lambda[0];
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        let wall = self.wall(s.time());
        g[0] = c.combine(s.q[0] - wall[0], s.v[0] - wall[1], s.a[0] - wall[2]);
    }
    fn jacobian(&mut self, _s: &State, visit: &mut VisitRow<'_>) {
        visit(0, &[0], &[1.0]);
    }
    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        out.add(0, 0, w.a);
    }
}

impl Observed for BallOnMovingWall {
    fn energy(&mut self, s: &State) -> Energy {
        Energy { kinetic: 0.5 * s.v[0] * s.v[0], gravity: GRAVITY * s.q[0], ..Energy::default() }
    }
    /// A plate that is touched drives the ball.
    fn power(&mut self, s: &State) -> flexion::system::Power {
        let drive = s.lambda[0] * self.wall(s.time())[1];
        flexion::system::Power { drive, ..Default::default() }
    }
}
