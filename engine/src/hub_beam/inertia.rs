//! The part of the equations of motion that is quadratic in the unknowns: constant matrices.
//!
//! With q the unknowns of the fields, ω = θ̇ the hub speed and R = a + x, every coupling has
//!
//! ```text
//! T = ½ vᵀM v + ω (s_yᵀ v + qᵀP v) + ½ ω² (J + 2 s_xᵀ q + qᵀD q) [+ terms of the coupling's own]
//! U = ½ qᵀK q                                                    [+ the same]
//! ```
//!
//! and Lagrange's equations for q and θ are
//!
//! ```text
//! M a + ω (Pᵀ − P) v + (K − ω² D + ω̇ Pᵀ) q + ω̇ s_y − ω² s_x = 0
//! ω̇ (J + 2 s_xᵀq + qᵀD q) + 2 ω (s_x + D q)ᵀ v + (s_y + Pᵀq)ᵀ a + vᵀP v = τ
//! ```
//!
//! Entries, with mass ρA, first moment ρS and rotary inertia ρI of the section, φ = w₂′ and the
//! foreshortening w_c = −½ ∫₀ˣ w₂′² dξ kept to first order (terms marked ◦; the zeroth-order coupling
//! leaves them out). The section itself turns rigidly, to second order in φ, in either case:
//!
//! ```text
//! T ∋ ½ρA (ẇ₁² + ẇ₂²) + ½ρI φ̇² − ρS ẇ₁ φ̇
//!   + ω [ ρA R ẇ₂ + ρI φ̇ − ρS ẇ₁ + ρA (w₁ẇ₂ − w₂ẇ₁) − ρS (φẇ₂ − φ̇w₂) − ρS R φφ̇ − ◦ρS ẇ_c ]
//!   + ½ω² [ ρA (R² + 2R w₁ + w₁² + w₂² + ◦2R w_c) + ρI + 2ρS (w₂ − Rφ − w₁φ) ]
//! ```
//!
//! Integrals of w_c are turned round: ∫ f(x) w_c dx = −½ ∫ F(ξ) w₂′² dξ with F(ξ) = ∫_ξᴸ f dx, so the
//! matrices stay banded (the papers store the full H(x)).

use super::fields::{Fields, Shapes};
use crate::linalg::{Matrix, Storage, Structure};
use crate::profile::HubKinematics;
use crate::section::{Resultants, Section};
use crate::system::{State, Weights};

/// Whether the foreshortening enters the kinetic energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foreshortening {
    /// Left out: zeroth-order coupling, or a field that needs none.
    None,
    /// Kept to first order.
    First,
}

/// Constant matrices of a beam on a hub; see the [module documentation](self).
#[derive(Debug)]
pub struct Inertia {
    layout: Layout,
    /// M
    mass: Matrix,
    /// Pᵀ − P
    gyroscopic: Matrix,
    /// D
    centrifugal: Matrix,
    /// Pᵀ
    euler: Matrix,
    /// K
    stiffness: Matrix,
    /// s_x and s_y
    axial_moment: Vec<f64>,
    transverse_moment: Vec<f64>,
    /// J, hub included [kg·m²].
    moment: f64,
}

/// How the rows of the stored matrices lie in memory.
#[derive(Clone, Copy, Debug)]
struct Layout {
    n: usize,
    stride: usize,
    lower: usize,
    upper: usize,
    band: bool,
}

impl Layout {
    fn of(structure: &Structure, n: usize) -> Layout {
        match *structure {
            Structure::Dense { order } => Layout { n, stride: order, lower: n, upper: n, band: false },
            Structure::Band { lower, upper, .. } => {
                let (lower, upper) = (lower.min(n.saturating_sub(1)), upper.min(n.saturating_sub(1)));
                Layout { n, stride: 2 * lower + upper + 1, lower, upper, band: true }
            }
        }
    }

    /// First column of row `i`, and where its entry is stored.
    #[inline(always)]
    fn row(&self, i: usize) -> (usize, usize, usize) {
        if self.band {
            let first = i.saturating_sub(self.lower);
            let last = (i + self.upper + 1).min(self.n);
            (first, i * self.stride + first + self.lower - i, last - first)
        } else {
            (0, i * self.stride, self.n)
        }
    }
}

/// The entries of a matrix apart from its border.
fn entries(matrix: &Matrix) -> &[f64] {
    match matrix.storage() {
        Storage::Dense(a) => a.data(),
        Storage::Band(a) => a.band().data(),
    }
}

impl Inertia {
    /// Integrates the matrices of `fields` with hub radius a = `radius` \[m\] and hub inertia
    /// `hub_inertia` [kg·m²]. `section` is the section as this coupling sees it.
    pub fn new(
        fields: &Fields,
        section: &dyn Section,
        radius: f64,
        hub_inertia: f64,
        foreshortening: Foreshortening,
        border: usize,
    ) -> Inertia {
        let structure = fields.structure(border);
        let first = foreshortening == Foreshortening::First;
        let mass_tail = fields.tail(|x| section.resultants(x).mass * (radius + x));
        let moment_tail = fields.tail(|x| section.resultants(x).first_moment);
        let new = || Matrix::new(&structure);
        let (mut m, mut p, mut d, mut k) = (new(), new(), new(), new());
        let n = fields.len();
        let (mut sx, mut sy) = (vec![0.0; n], vec![0.0; n]);
        let mut moment = hub_inertia;
        fields.integrate(|point| {
            let (x, w, r) = (point.x, point.weight, radius + point.x);
            let (a, b) = (&point.axial, &point.transverse);
            let Resultants {
                mass,
                first_moment: s,
                rotary_inertia: i,
                axial_stiffness: ea,
                coupling_stiffness: es,
                bending_stiffness: ei,
            } = section.resultants(x);
            moment += w * (mass * r * r + i);
            add_vector(&mut sx, a, 0, w * mass * r);
            add_vector(&mut sx, b, 0, w * s);
            add_vector(&mut sx, b, 1, -w * s * r);
            add_vector(&mut sy, b, 0, w * mass * r);
            add_vector(&mut sy, b, 1, w * i);
            add_vector(&mut sy, a, 0, -w * s);
            add_outer(&mut m, (a, 0), (a, 0), w * mass);
            add_outer(&mut m, (b, 0), (b, 0), w * mass);
            add_outer(&mut m, (b, 1), (b, 1), w * i);
            add_symmetric(&mut m, (a, 0), (b, 1), -w * s);
            add_outer(&mut p, (a, 0), (b, 0), w * mass);
            add_outer(&mut p, (b, 0), (a, 0), -w * mass);
            add_outer(&mut p, (b, 1), (b, 0), -w * s);
            add_outer(&mut p, (b, 0), (b, 1), w * s);
            add_outer(&mut d, (a, 0), (a, 0), w * mass);
            add_outer(&mut d, (b, 0), (b, 0), w * mass);
            add_symmetric(&mut d, (a, 0), (b, 1), -w * s);
            add_outer(&mut p, (b, 1), (b, 1), -w * s * r);
            if first {
                add_outer(&mut p, (b, 1), (b, 1), w * moment_tail(x));
                add_outer(&mut d, (b, 1), (b, 1), -w * mass_tail(x));
            }
            add_outer(&mut k, (a, 1), (a, 1), w * ea);
            add_symmetric(&mut k, (a, 1), (b, 2), -w * es);
            add_outer(&mut k, (b, 2), (b, 2), w * ei);
        });
        let (mut euler, mut gyroscopic) = (new(), new());
        let layout = Layout::of(&structure, n);
        for i in 0..n {
            let (start, _, len) = layout.row(i);
            for j in start..start + len {
                euler.add(i, j, p.get(j, i));
                gyroscopic.add(i, j, p.get(j, i) - p.get(i, j));
            }
        }
        Inertia {
            layout,
            mass: m,
            gyroscopic,
            centrifugal: d,
            euler,
            stiffness: k,
            axial_moment: sx,
            transverse_moment: sy,
            moment,
        }
    }

    /// Number of unknowns of the fields.
    pub fn len(&self) -> usize {
        self.layout.n
    }

    /// Whether there is no unknown.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The mass matrix M, the matrix D of the centrifugal forces and the stiffness matrix K.
    pub fn matrices(&self) -> (&Matrix, &Matrix, &Matrix) {
        (&self.mass, &self.centrifugal, &self.stiffness)
    }

    /// r = M a + ω (Pᵀ − P) v + (K − ω² D + ω̇ Pᵀ) q + ω̇ s_y − ω² s_x.
    pub fn residual(&self, s: &State, hub: &HubKinematics, r: &mut [f64]) {
        let (w, w1, w2) = (hub.speed, hub.acceleration, hub.speed * hub.speed);
        let [m, g, d, e, k] =
            [&self.mass, &self.gyroscopic, &self.centrifugal, &self.euler, &self.stiffness].map(entries);
        for i in 0..self.layout.n {
            let (first, at, len) = self.layout.row(i);
            let (m, g, d) = (&m[at..at + len], &g[at..at + len], &d[at..at + len]);
            let (e, k) = (&e[at..at + len], &k[at..at + len]);
            let (q, v, a) = (&s.q[first..first + len], &s.v[first..first + len], &s.a[first..first + len]);
            let mut sum = w1 * self.transverse_moment[i] - w2 * self.axial_moment[i];
            for j in 0..len {
                sum += m[j] * a[j] + w * g[j] * v[j] + (k[j] - w2 * d[j] + w1 * e[j]) * q[j];
            }
            r[i] = sum;
        }
    }

    /// The stamp of the tangent with weights `w` at a hub speed and acceleration.
    pub fn stamp(w: &Weights<'_>, hub: &HubKinematics) -> [f64; 6] {
        [w.a, w.v * hub.speed, w.q, w.q * hub.speed * hub.speed, w.q * hub.acceleration, 0.0]
    }

    /// Writes w.a M + w.v ω (Pᵀ − P) + w.q (K − ω² D + ω̇ Pᵀ) over the content of `out`, border aside.
    pub fn tangent(&self, w: &Weights<'_>, hub: &HubKinematics, out: &mut Storage<f64>) {
        let out = match out {
            Storage::Dense(a) => a.data_mut(),
            Storage::Band(a) => a.band_mut().data_mut(),
        };
        let [m, g, d, e, k] =
            [&self.mass, &self.gyroscopic, &self.centrifugal, &self.euler, &self.stiffness].map(entries);
        let (wa, wv, wk) = (w.a, w.v * hub.speed, w.q);
        let (wd, we) = (-w.q * hub.speed * hub.speed, w.q * hub.acceleration);
        let n = out.len();
        let (m, g, d, e, k) = (&m[..n], &g[..n], &d[..n], &e[..n], &k[..n]);
        for i in 0..n {
            out[i] = wa * m[i] + wv * g[i] + wk * k[i] + wd * d[i] + we * e[i];
        }
    }

    /// Kinetic energy, and the torque τ of the equation of motion of the hub.
    pub fn kinetic_and_torque(&self, s: &State, hub: &HubKinematics) -> (f64, f64) {
        let (w, w1) = (hub.speed, hub.acceleration);
        let [m, d, e] = [&self.mass, &self.centrifugal, &self.euler].map(entries);
        let (mut vmv, mut qdq, mut qdv) = (0.0, 0.0, 0.0);
        let (mut vpq, mut aeq, mut vpv) = (0.0, 0.0, 0.0);
        let (mut sxq, mut sxv, mut syv, mut sya) = (0.0, 0.0, 0.0, 0.0);
        for i in 0..self.layout.n {
            let (first, at, len) = self.layout.row(i);
            let (mut mv, mut dq, mut eq, mut ev) = (0.0, 0.0, 0.0, 0.0);
            for j in 0..len {
                mv += m[at + j] * s.v[first + j];
                dq += d[at + j] * s.q[first + j];
                eq += e[at + j] * s.q[first + j];
                ev += e[at + j] * s.v[first + j];
            }
            let (q, v, a) = (s.q[i], s.v[i], s.a[i]);
            vmv += v * mv;
            qdq += q * dq;
            qdv += v * dq;
            vpq += v * eq;
            aeq += a * eq;
            vpv += v * ev;
            sxq += self.axial_moment[i] * q;
            sxv += self.axial_moment[i] * v;
            syv += self.transverse_moment[i] * v;
            sya += self.transverse_moment[i] * a;
        }
        let moment = self.moment + 2.0 * sxq + qdq;
        let kinetic = 0.5 * vmv + w * (syv + vpq) + 0.5 * w * w * moment;
        let torque = w1 * moment + 2.0 * w * (sxv + qdv) + sya + aeq + vpv;
        (kinetic, torque)
    }

    /// ½ qᵀK q.
    pub fn strain(&self, q: &[f64]) -> f64 {
        let k = entries(&self.stiffness);
        let mut sum = 0.0;
        for i in 0..self.layout.n {
            let (first, at, len) = self.layout.row(i);
            let row: f64 = k[at..at + len].iter().zip(&q[first..first + len]).map(|(k, q)| k * q).sum();
            sum += row * q[i];
        }
        0.5 * sum
    }
}

fn add_vector(out: &mut [f64], shapes: &Shapes, d: usize, w: f64) {
    for (&i, phi) in shapes.index.iter().zip(&shapes.value[d]) {
        out[i] += w * phi;
    }
}

/// out += w φ⁽ᵈ⁾ ψ⁽ᵉ⁾ᵀ
fn add_outer(out: &mut Matrix, row: (&Shapes, usize), column: (&Shapes, usize), w: f64) {
    if w == 0.0 {
        return;
    }
    for (&i, phi) in row.0.index.iter().zip(&row.0.value[row.1]) {
        for (&j, psi) in column.0.index.iter().zip(&column.0.value[column.1]) {
            out.add(i, j, w * phi * psi);
        }
    }
}

/// out += w (φ⁽ᵈ⁾ ψ⁽ᵉ⁾ᵀ + ψ⁽ᵉ⁾ φ⁽ᵈ⁾ᵀ)
fn add_symmetric(out: &mut Matrix, a: (&Shapes, usize), b: (&Shapes, usize), w: f64) {
    add_outer(out, a, b, w);
    add_outer(out, b, a, w);
}
