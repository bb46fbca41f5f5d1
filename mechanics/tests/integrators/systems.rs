//! Small mechanical systems with known solutions.

#![allow(dead_code)]

use flexion::linalg::{Matrix, Structure};
use flexion::system::{
    Dynamics, Energy, Events, Observed, RowWeights, Set, Size, State, Steady, VisitRow, Weights,
};

/// The faces of a model that these systems leave as they are.
macro_rules! plain {
    ($($system:ty),*) => {
        $(impl Events for $system {} impl Steady for $system {})*
    };
}
plain!(Chain, SpringPendulum, Pendulum, CartesianPendulum, TwoFrequencies);

/// m q̈ + c q̇ + k q = sin(Ω t), a chain or a single mass, in a band; constant matrices, stamped.
pub struct Chain {
    /// Masses (diagonal), dampers and springs: `springs[i]` between mass i − 1 (or ground) and mass i.
    pub masses: Vec<f64>,
    pub springs: Vec<f64>,
    pub damping: f64,
    /// Amplitude and angular frequency of a force on the last mass.
    pub force: (f64, f64),
    pub width: usize,
    scales: Vec<f64>,
}

impl Chain {
    pub fn new(masses: Vec<f64>, springs: Vec<f64>, damping: f64) -> Chain {
        let scales = vec![1.0; masses.len()];
        Chain { masses, springs, damping, force: (0.0, 0.0), width: 1, scales }
    }

    /// One mass: q̈ + c q̇ + ω² q = f sin Ωt.
    pub fn oscillator(frequency: f64, damping: f64) -> Chain {
        Chain::new(vec![1.0], vec![frequency * frequency], damping)
    }

    fn stretch_force(&self, x: &[f64], out: &mut [f64]) {
        let n = x.len();
        for i in 0..n {
            let stretch = x[i] - if i > 0 { x[i - 1] } else { 0.0 };
            let force = self.springs[i] * stretch;
            out[i] += force;
            if i > 0 {
                out[i - 1] -= force;
            }
        }
    }
}

impl Dynamics for Chain {
    fn scales(&self) -> &[f64] {
        &self.scales
    }
    fn size(&self) -> Size {
        Size { q: self.masses.len(), v: self.masses.len(), lambda: 0, memory: 0 }
    }
    fn structure(&self, _multipliers: usize) -> Structure {
        Structure::band(self.masses.len(), self.width, self.width, 0)
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let n = r.len();
        for i in 0..n {
            r[i] = self.masses[i] * (s.a[i] + self.damping * s.v[i]);
        }
        self.stretch_force(&s.q, r);
        r[n - 1] -= self.force.0 * (self.force.1 * s.t).sin();
    }
    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        let stamp = [w.a, w.v, w.q, 0.0, 0.0, 0.0];
        if out.holds(&stamp) {
            return;
        }
        out.clear();
        for i in 0..self.masses.len() {
            out.add(i, i, self.masses[i] * (w.a + self.damping * w.v) + w.q * self.springs[i]);
            if i > 0 {
                out.add(i - 1, i - 1, w.q * self.springs[i]);
                out.add(i, i - 1, -w.q * self.springs[i]);
                out.add(i - 1, i, -w.q * self.springs[i]);
            }
        }
        out.set_stamp(Some(stamp));
    }
    fn is_affine(&self) -> bool {
        true
    }
}

impl Observed for Chain {
    fn energy(&mut self, s: &State) -> Energy {
        let kinetic = (0..s.v.len()).map(|i| 0.5 * self.masses[i] * s.v[i] * s.v[i]).sum();
        let mut force = vec![0.0; s.q.len()];
        self.stretch_force(&s.q, &mut force);
        let strain = 0.5 * s.q.iter().zip(&force).map(|(q, f)| q * f).sum::<f64>();
        Energy { kinetic, strain, ..Energy::default() }
    }
}

/// Two coupled nonlinear coordinates with a configuration-dependent mass and a gyroscopic force: the
/// elastic (spring) pendulum in polar coordinates, q = (stretch x, angle φ), length ℓ₀ + x:
/// ẍ − (ℓ₀+x)φ̇² + k x − g cos φ = 0,  (ℓ₀+x)² φ̈ + 2(ℓ₀+x)ẋφ̇ + g (ℓ₀+x) sin φ = 0.
pub struct SpringPendulum {
    pub length: f64,
    pub stiffness: f64,
    pub gravity: f64,
    scales: Vec<f64>,
}

impl SpringPendulum {
    pub fn new(stiffness: f64) -> SpringPendulum {
        SpringPendulum { length: 1.0, stiffness, gravity: 1.0, scales: vec![1.0; 2] }
    }
}

impl Dynamics for SpringPendulum {
    fn scales(&self) -> &[f64] {
        &self.scales
    }
    fn size(&self) -> Size {
        Size { q: 2, v: 2, lambda: 0, memory: 0 }
    }
    fn structure(&self, _multipliers: usize) -> Structure {
        Structure::dense(2)
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let (l, g) = (self.length + s.q[0], self.gravity);
        r[0] = s.a[0] - l * s.v[1] * s.v[1] + self.stiffness * s.q[0] - g * s.q[1].cos();
        r[1] = l * l * s.a[1] + 2.0 * l * s.v[0] * s.v[1] + g * l * s.q[1].sin();
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        let (l, g) = (self.length + s.q[0], self.gravity);
        let (sin, cos) = s.q[1].sin_cos();
        out.clear();
        out.add(0, 0, w.a + w.q * (self.stiffness - s.v[1] * s.v[1]));
        out.add(0, 1, -2.0 * w.v * l * s.v[1] + w.q * g * sin);
        out.add(1, 0, 2.0 * w.v * l * s.v[1] + w.q * (2.0 * l * s.a[1] + 2.0 * s.v[0] * s.v[1] + g * sin));
        out.add(1, 1, w.a * l * l + 2.0 * w.v * l * s.v[0] + w.q * g * l * cos);
    }
}

impl Observed for SpringPendulum {
    fn energy(&mut self, s: &State) -> Energy {
        let l = self.length + s.q[0];
        Energy {
            kinetic: 0.5 * (s.v[0] * s.v[0] + l * l * s.v[1] * s.v[1]),
            strain: 0.5 * self.stiffness * s.q[0] * s.q[0],
            gravity: -self.gravity * l * s.q[1].cos(),
            ..Energy::default()
        }
    }
}

/// Mathematical pendulum φ̈ + sin φ = 0, by its angle.
pub struct Pendulum {
    scales: Vec<f64>,
}

impl Pendulum {
    pub fn new() -> Pendulum {
        Pendulum { scales: vec![1.0; 1] }
    }

    /// Period of the swing of amplitude `phi`: 2π / agm(1, cos φ/2).
    pub fn period(phi: f64) -> f64 {
        let (mut a, mut g): (f64, f64) = (1.0, (0.5 * phi).cos());
        for _ in 0..10 {
            (a, g) = (0.5 * (a + g), (a * g).sqrt());
        }
        2.0 * std::f64::consts::PI / a
    }
}

impl Dynamics for Pendulum {
    fn scales(&self) -> &[f64] {
        &self.scales
    }
    fn size(&self) -> Size {
        Size { q: 1, v: 1, lambda: 0, memory: 0 }
    }
    fn structure(&self, _multipliers: usize) -> Structure {
        Structure::dense(1)
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        r[0] = s.a[0] + s.q[0].sin();
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        out.add(0, 0, w.a + w.q * s.q[0].cos());
    }
}

impl Observed for Pendulum {
    fn energy(&mut self, s: &State) -> Energy {
        Energy { kinetic: 0.5 * s.v[0] * s.v[0], gravity: -s.q[0].cos(), ..Energy::default() }
    }
}

/// The same pendulum by Cartesian coordinates of its unit mass: q = (x, y), g = ½(x² + y² − 1) = 0.
pub struct CartesianPendulum {
    scales: Vec<f64>,
}

impl CartesianPendulum {
    pub fn new() -> CartesianPendulum {
        CartesianPendulum { scales: vec![1.0; 2] }
    }
}

impl Dynamics for CartesianPendulum {
    fn scales(&self) -> &[f64] {
        &self.scales
    }
    fn size(&self) -> Size {
        Size { q: 2, v: 2, lambda: 1, memory: 0 }
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        r[0] = s.a[0] - s.q[0] * s.lambda[0];
        r[1] = s.a[1] - s.q[1] * s.lambda[0] + 1.0;
    }
    fn constraint(&mut self, s: &State, c: RowWeights, g: &mut [f64]) {
        let dot = |x: &[f64], y: &[f64]| x[0] * y[0] + x[1] * y[1];
        g[0] = c.combine(0.5 * (dot(&s.q, &s.q) - 1.0), dot(&s.q, &s.v), dot(&s.q, &s.a) + dot(&s.v, &s.v));
    }
    fn rows(&self) -> &[Set] {
        &[Set::Free]
    }
    fn jacobian(&mut self, s: &State, visit: &mut VisitRow<'_>) {
        visit(0, &[0, 1], &s.q);
    }
    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        out.clear();
        for i in 0..2 {
            out.add(i, i, w.a - w.q * s.lambda[0]);
        }
    }
}

impl Observed for CartesianPendulum {
    fn energy(&mut self, s: &State) -> Energy {
        Energy { kinetic: 0.5 * (s.v[0] * s.v[0] + s.v[1] * s.v[1]), gravity: s.q[1], ..Energy::default() }
    }
}

/// A stiff linear oscillator about a smooth slow motion,
/// q̈ + 2ζω q̇ + ω² (q − cos t) = 0 with ω large, beside a slow oscillator q̈₂ + q₂ = 0.
pub struct TwoFrequencies {
    pub fast: f64,
    pub ratio: f64,
    scales: Vec<f64>,
}

impl TwoFrequencies {
    pub fn new(fast: f64, ratio: f64) -> TwoFrequencies {
        TwoFrequencies { fast, ratio, scales: vec![1.0; 2] }
    }
}

impl Dynamics for TwoFrequencies {
    fn scales(&self) -> &[f64] {
        &self.scales
    }
    fn size(&self) -> Size {
        Size { q: 2, v: 2, lambda: 0, memory: 0 }
    }
    fn structure(&self, _multipliers: usize) -> Structure {
        Structure::band(2, 0, 0, 0)
    }
    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let w = self.fast;
        r[0] = s.a[0] + 2.0 * self.ratio * w * s.v[0] + w * w * (s.q[0] - s.t.cos());
        r[1] = s.a[1] + s.q[1];
    }
    fn tangent(&mut self, _s: &State, w: Weights<'_>, out: &mut Matrix) {
        let stamp = [w.a, w.v, w.q, 0.0, 0.0, 0.0];
        if out.holds(&stamp) {
            return;
        }
        out.clear();
        out.add(0, 0, w.a + 2.0 * self.ratio * self.fast * w.v + self.fast * self.fast * w.q);
        out.add(1, 1, w.a + w.q);
        out.set_stamp(Some(stamp));
    }
    fn is_affine(&self) -> bool {
        true
    }
}

impl Observed for TwoFrequencies {
    fn energy(&mut self, _s: &State) -> Energy {
        Energy::default()
    }
}

/// A chain stored with five neighbours a side: a band like that of a beam of 10 elements.
pub fn wide_chain(n: usize) -> Chain {
    let mut chain = Chain::new(vec![0.1; n], vec![1e4; n], 0.0);
    chain.width = 5;
    chain
}

/// A state of the system at t = 0.
pub fn state(system: &dyn Dynamics, q: &[f64], v: &[f64]) -> State {
    let mut state = State::zeros(system.size(), 0.0);
    state.q.copy_from_slice(q);
    state.v.copy_from_slice(v);
    state
}
