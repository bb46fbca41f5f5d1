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
//! A lumped mass is a point of the quadrature with ρA → m, ρI → j and no ρS. [`Damping`] adds β M v and η K v to the
//! forces: those of the dissipation function ½ vᵀ(βM + ηK) v, which rigid rotation leaves at zero.
//!
//! Integrals of w_c are turned round: ∫ f(x) w_c dx = −½ ∫ F(ξ) w₂′² dξ with F(ξ) = ∫_ξᴸ f dx, so the
//! matrices stay banded (the papers store the full H(x)).

use super::damping::Damping;
use super::fields::{Fields, Point, Shapes};
use super::hub::Hub;
use super::product::{Bundle, Vectors};
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
///
/// Most models have D close to M, and P antisymmetric or nearly so. With N = M − D and the symmetric part S
/// of P, whose zeros are not multiplied, the equations for q are
///
/// ```text
/// M (a − ω² q) + (Pᵀ − P)(ω v + ½ω̇ q) + (K + ω² N + ω̇ S) q + ω̇ s_y − ω² s_x = 0
/// ```
#[derive(Debug)]
pub struct Inertia {
    /// M, Pᵀ − P and, unless both vanish, K and N.
    bundle: Bundle,
    /// S, unless it vanishes.
    symmetric: Option<Bundle>,
    /// D and Pᵀ − P, for the torque.
    torque: Bundle,
    /// M
    mass: Matrix,
    /// D
    centrifugal: Matrix,
    /// K
    stiffness: Matrix,
    /// s_x and s_y
    axial_moment: Vec<f64>,
    transverse_moment: Vec<f64>,
    /// J, hub included [kg·m²].
    moment: f64,
    damping: Damping,
}

/// What hub and beam have together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Kinetic energy T [J].
    pub kinetic: f64,
    /// Angular momentum about the hub's axis ∂T/∂ω [kg·m²/s].
    pub momentum: f64,
    /// Torque τ that the motion needs [N·m].
    pub torque: f64,
}

impl std::ops::Add for Totals {
    type Output = Totals;
    fn add(self, other: Totals) -> Totals {
        Totals {
            kinetic: self.kinetic + other.kinetic,
            momentum: self.momentum + other.momentum,
            torque: self.torque + other.torque,
        }
    }
}

/// Row, column and corner of a free hub in the tangent.
#[derive(Clone, Debug, Default)]
pub struct Border {
    /// Derivatives of the fields' equations by the hub's angle, weighted.
    pub column: Vec<f64>,
    /// Derivatives of the hub's equation by the fields' unknowns, weighted.
    pub row: Vec<f64>,
    /// Derivative of the hub's equation by the hub's angle, weighted.
    pub corner: f64,
}

impl Border {
    /// A border of zeros for `n` unknowns.
    pub fn new(n: usize) -> Border {
        Border { column: vec![0.0; n], row: vec![0.0; n], corner: 0.0 }
    }
}

/// What [`Inertia`] multiplies its matrices with: scratch of the system's.
#[derive(Clone, Debug)]
pub struct Scratch {
    all: Vectors,
    pair: Vectors,
    symmetric: Option<Vectors>,
    torque: Vectors,
    /// D q and ½ (Pᵀ − P) q, for the torque.
    products: Vec<[f64; 2]>,
}

impl Inertia {
    /// Integrates the matrices of `fields` on `hub`; `section` is the section as the coupling sees it.
    pub fn new(fields: &Fields, section: &dyn Section, hub: &Hub, foreshortening: Foreshortening) -> Inertia {
        let structure = fields.structure(hub.unknowns());
        let radius = hub.radius;
        let first = foreshortening == Foreshortening::First;
        let masses = section.masses();
        let spread = fields.tail(|x| section.resultants(x).mass * (radius + x));
        let mass_tail = |x: f64| {
            let beyond = masses.iter().filter(|m| m.station > x);
            spread(x) + beyond.map(|m| m.mass * (radius + m.station)).sum::<f64>()
        };
        let moment_tail = fields.tail(|x| section.resultants(x).first_moment);
        let new = || Matrix::new(&structure);
        let (mut m, mut p, mut d, mut k) = (new(), new(), new(), new());
        let n = fields.len();
        let (mut sx, mut sy) = (vec![0.0; n], vec![0.0; n]);
        let mut moment = hub.inertia;
        let mut add = |point: &Point, resultants: Resultants, lumped: bool| {
            let (x, w, r) = (point.x, point.weight, radius + point.x);
            let (a, b) = (&point.axial, &point.transverse);
            let Resultants {
                mass,
                first_moment: s,
                rotary_inertia: i,
                axial_stiffness: ea,
                coupling_stiffness: es,
                bending_stiffness: ei,
            } = resultants;
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
            if first && !lumped {
                add_outer(&mut p, (b, 1), (b, 1), w * moment_tail(x));
                add_outer(&mut d, (b, 1), (b, 1), -w * mass_tail(x));
            }
            add_outer(&mut k, (a, 1), (a, 1), w * ea);
            add_symmetric(&mut k, (a, 1), (b, 2), -w * es);
            add_outer(&mut k, (b, 2), (b, 2), w * ei);
        };
        fields.integrate(|point| add(point, section.resultants(point.x), false));
        for m in masses {
            let resultants = Resultants { mass: m.mass, rotary_inertia: m.inertia, ..Resultants::default() };
            add(&fields.point(m.station, 1.0), resultants, true);
        }
        let (mut gyroscopic, mut stiffening, mut symmetric) = (new(), new(), new());
        let half = match structure {
            Structure::Dense { order } => order,
            Structure::Band { lower, upper, .. } | Structure::Condensed { lower, upper, .. } => {
                lower.max(upper)
            }
        };
        for i in 0..n {
            for j in i.saturating_sub(half)..(i + half + 1).min(n) {
                gyroscopic.add(i, j, p.get(j, i) - p.get(i, j));
                stiffening.add(i, j, m.get(i, j) - d.get(i, j));
                symmetric.add(i, j, 0.5 * (p.get(j, i) + p.get(i, j)));
            }
        }
        let bundle = |matrices| Bundle::new(&structure, n, matrices);
        let (stiff, stiffened) = (unless_zero(&k, 0.0), unless_zero(&stiffening, largest(&m)));
        Inertia {
            bundle: bundle([Some(&m), Some(&gyroscopic), stiff, stiffened]),
            symmetric: unless_zero(&symmetric, largest(&p)).map(|s| bundle([Some(s), Some(s), None, None])),
            torque: bundle([Some(&d), Some(&gyroscopic), None, None]),
            mass: m,
            centrifugal: d,
            stiffness: k,
            axial_moment: sx,
            transverse_moment: sy,
            moment,
            damping: Damping::default(),
        }
    }

    /// Adds the forces β M v + η K v.
    pub fn damp(&mut self, damping: Damping) {
        self.damping = damping;
    }

    /// Power that [`Inertia::damp`] takes, vᵀ(βM + ηK) v \[W\].
    pub fn dissipated(&self, v: &[f64]) -> f64 {
        let Damping { mass, stiffness } = self.damping;
        let form = |factor: f64, term| if factor > 0.0 { factor * self.bundle.form(term, v) } else { 0.0 };
        form(mass, 0) + form(stiffness, 2)
    }

    /// Number of unknowns of the fields.
    pub fn len(&self) -> usize {
        self.bundle.order()
    }

    /// Whether there is no unknown.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Scratch for the products of these matrices.
    pub fn scratch(&self) -> Scratch {
        Scratch {
            all: self.bundle.vectors(),
            pair: self.bundle.pair(),
            symmetric: self.symmetric.as_ref().map(Bundle::vectors),
            torque: self.torque.vectors(),
            products: vec![[0.0; 2]; self.len()],
        }
    }

    /// The mass matrix M, the matrix D of the centrifugal forces and the stiffness matrix K.
    pub fn matrices(&self) -> (&Matrix, &Matrix, &Matrix) {
        (&self.mass, &self.centrifugal, &self.stiffness)
    }

    /// r = M (a + β v) + ω (Pᵀ − P) v + (K − ω² D + ω̇ Pᵀ) q + η K v + ω̇ s_y − ω² s_x.
    pub fn residual(&self, s: &State, hub: &HubKinematics, x: &mut Scratch, r: &mut [f64]) {
        let n = self.len();
        let (w, w1, w2) = (hub.speed, hub.acceleration, hub.speed * hub.speed);
        let (q, v, a) = (&s.q[..n], &s.v[..n], &s.a[..n]);
        let (sx, sy, r) = (&self.axial_moment[..n], &self.transverse_moment[..n], &mut r[..n]);
        let Scratch { all: x, symmetric: y, .. } = x;
        let constant = |i: usize| w1 * sy[i] - w2 * sx[i];
        if self.damping.is_none() {
            x.set(0, |i| a[i] - w2 * q[i]);
            x.set(2, |i| q[i]);
        } else {
            let Damping { mass, stiffness } = self.damping;
            x.set(0, |i| a[i] + mass * v[i] - w2 * q[i]);
            x.set(2, |i| q[i] + stiffness * v[i]);
        }
        x.set(1, |i| w * v[i] + 0.5 * w1 * q[i]);
        x.set(3, |i| w2 * q[i]);
        self.bundle.products(x, |i, [m, g, k, n]| r[i] = (m + k) + (g + n) + constant(i));
        if let Some((symmetric, y)) = self.symmetric.as_ref().zip(y.as_mut()) {
            y.set(0, |i| w1 * q[i]);
            symmetric.products(y, |i, [s, ..]| r[i] += s);
        }
    }

    /// [`Inertia::residual`] for a hub that is free to turn: also returns the torque of [`Inertia::totals`], with
    /// which it shares its products.
    pub fn residual_and_torque(&self, s: &State, hub: &HubKinematics, x: &mut Scratch, r: &mut [f64]) -> f64 {
        let n = self.len();
        let (w, w1, w2) = (hub.speed, hub.acceleration, hub.speed * hub.speed);
        let (q, v, a) = (&s.q[..n], &s.v[..n], &s.a[..n]);
        let (sx, sy, r) = (&self.axial_moment[..n], &self.transverse_moment[..n], &mut r[..n]);
        let Scratch { all: x, pair, symmetric: y, .. } = x;
        x.set_all(|i| q[i]);
        let Damping { mass, stiffness } = self.damping;
        if self.damping.is_none() {
            pair.set(0, |i| a[i]);
        } else {
            pair.set(0, |i| a[i] + mass * v[i]);
            x.set(2, |i| q[i] + stiffness * v[i]);
        }
        pair.set(1, |i| v[i]);
        let (mut qdq, mut qdv, mut aeq, mut vpv) = (0.0, 0.0, 0.0, 0.0);
        self.bundle.products_and_pair(x, pair, |i, [mq, gq, kq, nq], [ma, gv]| {
            let dq = mq - nq;
            qdq += q[i] * (dq + 2.0 * sx[i]);
            qdv += v[i] * (dq + sx[i]);
            aeq += a[i] * (0.5 * gq + sy[i]);
            r[i] = (ma + kq) + (w * gv + 0.5 * w1 * gq) + (w1 * sy[i] - w2 * (dq + sx[i]));
        });
        if let Some((symmetric, y)) = self.symmetric.as_ref().zip(y.as_mut()) {
            y.set(0, |i| q[i]);
            y.set(1, |i| v[i]);
            symmetric.products(y, |i, [sq, sv, ..]| {
                r[i] += w1 * sq;
                aeq += a[i] * sq;
                vpv += v[i] * sv;
            });
        }
        w1 * (self.moment + qdq) + 2.0 * w * qdv + aeq + vpv
    }

    /// The stamp of the tangent with weights `w` at a hub speed and acceleration; its last entry is free for others.
    pub fn stamp(&self, w: &Weights<'_>, hub: &HubKinematics) -> [f64; 6] {
        if !self.damping.is_none() {
            return [w.a, w.v, w.q, hub.speed, hub.acceleration, 0.0];
        }
        [w.a, w.v * hub.speed, w.q, w.q * hub.speed * hub.speed, w.q * hub.acceleration, 0.0]
    }

    /// Writes (w.a + β w.v) M + w.v (ω (Pᵀ − P) + η K) + w.q (K − ω² D + ω̇ Pᵀ) over the content of `out`, border aside.
    pub fn tangent(&self, w: &Weights<'_>, hub: &HubKinematics, out: &mut Storage<f64>) {
        let (w1, w2) = (hub.acceleration, hub.speed * hub.speed);
        let (wm, wg) = (w.a - w.q * w2, w.v * hub.speed + 0.5 * w.q * w1);
        let Damping { mass, stiffness } = self.damping;
        self.bundle.write_sum([wm + mass * w.v, wg, w.q + stiffness * w.v, w.q * w2], out);
        if let Some(symmetric) = &self.symmetric {
            symmetric.add_sum([w.q * w1, 0.0, 0.0, 0.0], out);
        }
    }

    /// Writes −ω² D + ω̇ Pᵀ over the content of `out`, border aside: ∂r/∂q without K.
    pub fn tangent_without_strain(&self, hub: &HubKinematics, out: &mut Storage<f64>) {
        let (w1, w2) = (hub.acceleration, hub.speed * hub.speed);
        self.bundle.write_sum([-w2, 0.5 * w1, 0.0, w2], out);
        if let Some(symmetric) = &self.symmetric {
            symmetric.add_sum([w1, 0.0, 0.0, 0.0], out);
        }
    }

    /// Kinetic energy T, angular momentum ∂T/∂ω and the torque τ of the equation of motion of the hub.
    pub fn totals(&self, s: &State, hub: &HubKinematics, x: &mut Scratch) -> Totals {
        let n = self.len();
        let (w, w1) = (hub.speed, hub.acceleration);
        let (q, v, a) = (&s.q[..n], &s.v[..n], &s.a[..n]);
        let (mut vmv, mut qdq, mut qdv) = (0.0, 0.0, 0.0);
        let (mut vpq, mut aeq, mut vpv) = (0.0, 0.0, 0.0);
        let Scratch { all: x, symmetric: y, .. } = x;
        x.set(0, |i| v[i]);
        x.set(1, |i| q[i]);
        x.set(3, |i| q[i]);
        self.bundle.products(x, |i, [mv, gq, _, nq]| {
            vmv += v[i] * mv;
            vpq += 0.5 * v[i] * gq;
            aeq += 0.5 * a[i] * gq;
            qdq -= q[i] * nq;
            qdv -= v[i] * nq;
        });
        x.set(0, |i| q[i]);
        self.bundle.products(x, |i, [mq, ..]| {
            qdq += q[i] * mq;
            qdv += v[i] * mq;
        });
        if let Some((symmetric, y)) = self.symmetric.as_ref().zip(y.as_mut()) {
            y.set(0, |i| q[i]);
            y.set(1, |i| v[i]);
            symmetric.products(y, |i, [sq, sv, ..]| {
                vpq += v[i] * sq;
                aeq += a[i] * sq;
                vpv += v[i] * sv;
            });
        }
        let sx = |u: &[f64]| inner(&self.axial_moment, u);
        let sy = |u: &[f64]| inner(&self.transverse_moment, u);
        let moment = self.moment + 2.0 * sx(q) + qdq;
        let relative = sy(v) + vpq;
        Totals {
            kinetic: 0.5 * vmv + w * relative + 0.5 * w * w * moment,
            momentum: w * moment + relative,
            torque: w1 * moment + 2.0 * w * (sx(v) + qdv) + sy(a) + aeq + vpv,
        }
    }

    /// The torque τ of [`Inertia::totals`] alone, for a fourth of the work: with y = ω̇ q + 2ω v,
    ///
    /// ```text
    /// τ = ω̇ J + s_xᵀ(y + ω̇ q) + yᵀD q + s_yᵀa + qᵀP a + vᵀP v
    /// ```
    pub fn torque(&self, s: &State, hub: &HubKinematics, x: &mut Scratch) -> f64 {
        let n = self.len();
        let (w2, w1) = (2.0 * hub.speed, hub.acceleration);
        let (q, v, a) = (&s.q[..n], &s.v[..n], &s.a[..n]);
        let (sx, sy) = (&self.axial_moment[..n], &self.transverse_moment[..n]);
        let Scratch { symmetric, torque: x, products, .. } = x;
        let products = &mut products[..n];
        x.set(0, |i| q[i]);
        x.set(1, |i| 0.5 * q[i]);
        self.torque.products(x, |i, [dq, gq, ..]| products[i] = [dq, gq]);
        let (mut torque, mut of_accelerations) = (w1 * self.moment, 0.0);
        for (i, [dq, gq]) in products.iter().enumerate() {
            torque += (w1 * q[i] + w2 * v[i]) * (dq + sx[i]) + w1 * (q[i] * sx[i]);
            of_accelerations += a[i] * (gq + sy[i]);
        }
        torque += of_accelerations;
        if let Some((matrix, y)) = self.symmetric.as_ref().zip(symmetric.as_mut()) {
            y.set(0, |i| q[i]);
            y.set(1, |i| v[i]);
            matrix.products(y, |i, [sq, sv, ..]| torque += a[i] * sq + v[i] * sv);
        }
        torque
    }

    /// The tangent's row and column of a free hub, and their corner: derivatives of the residual by θ, θ̇, θ̈
    /// and of the torque by q, v, a, with the weights of the integrator.
    ///
    /// ```text
    /// ∂r/∂θ̇ = (Pᵀ − P) v − 2ω (D q + s_x),   ∂r/∂θ̈ = s_y + Pᵀq
    /// ∂τ/∂q = 2ω̇ (D q + s_x) + P a + 2ω D v,  ∂τ/∂v = 2ω (D q + s_x) + (P + Pᵀ) v,  ∂τ/∂a = s_y + Pᵀq
    /// ∂τ/∂θ̇ = 2 (D q + s_x)·v,                ∂τ/∂θ̈ = J + 2 s_xᵀq + qᵀD q
    /// ```
    pub fn border(&self, s: &State, hub: &HubKinematics, w: &Weights<'_>, x: &mut Scratch, out: &mut Border) {
        let n = self.len();
        let (om, al) = (hub.speed, hub.acceleration);
        let (q, v, a) = (&s.q[..n], &s.v[..n], &s.a[..n]);
        let (sx, sy) = (&self.axial_moment, &self.transverse_moment);
        let (mut by_speed, mut moment) = (0.0, self.moment);
        let (column, row) = (&mut out.column, &mut out.row);
        let Scratch { all: x, symmetric: y, .. } = x;
        // D = M − N; Pᵀ = S + G/2 and P = S − G/2 with G = Pᵀ − P.
        self.each(
            x,
            |i| [q[i], q[i], q[i]],
            |i, [mq, gq, nq]| {
                let dq = mq - nq + sx[i];
                by_speed += 2.0 * dq * v[i];
                moment += q[i] * (dq + sx[i]);
                let euler = w.a * (sy[i] + 0.5 * gq);
                row[i] = (2.0 * w.q * al + 2.0 * w.v * om) * dq + euler;
                column[i] = -2.0 * w.v * om * dq + euler;
            },
        );
        let dv = 2.0 * w.q * om;
        self.each(
            x,
            |i| [v[i], v[i], v[i]],
            |i, [mv, gv, nv]| {
                row[i] += dv * (mv - nv);
                column[i] += w.v * gv;
            },
        );
        self.each(x, |i| [0.0, a[i], 0.0], |i, [_, ga, _]| row[i] -= 0.5 * w.q * ga);
        if let Some((symmetric, y)) = self.symmetric.as_ref().zip(y.as_mut()) {
            y.set(0, |i| 2.0 * w.v * v[i] + w.q * a[i]);
            symmetric.products(y, |i, [s, ..]| row[i] += s);
            y.set(0, |i| w.a * q[i]);
            symmetric.products(y, |i, [s, ..]| {
                column[i] += s;
                row[i] += s;
            });
        }
        out.corner = w.v * by_speed + w.a * moment;
    }

    /// Calls `f` with i and (M x, (Pᵀ − P) y, N z)ᵢ for vectors with the entries (x, y, z)ᵢ = `of(i)`.
    #[inline]
    fn each(
        &self,
        vectors: &mut Vectors,
        of: impl Fn(usize) -> [f64; 3],
        mut f: impl FnMut(usize, [f64; 3]),
    ) {
        for (term, vector) in [(0, 0), (1, 1), (3, 2)] {
            vectors.set(term, |i| of(i)[vector]);
        }
        self.bundle.products(vectors, |i, [m, g, _, n]| f(i, [m, g, n]));
    }

    /// ½ qᵀK q.
    pub fn strain(&self, q: &[f64]) -> f64 {
        0.5 * self.bundle.form(2, q)
    }
}

/// `matrix`, unless it is the rounding error of numbers of the given size.
fn unless_zero(matrix: &Matrix, size: f64) -> Option<&Matrix> {
    (largest(matrix) > 1e-13 * size).then_some(matrix)
}

/// Largest entry, border aside.
fn largest(matrix: &Matrix) -> f64 {
    let entries = match matrix.storage() {
        Storage::Dense(a) => a.data(),
        Storage::Band(a) => a.band().data(),
        Storage::Condensed(a) => a.whole().band().data(),
    };
    entries.iter().fold(0.0, |m, x| x.abs().max(m))
}

fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
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
