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
//! leaves them out). The section itself rotates rigidly, to second order in φ, in either case:
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
//! The order of integration is interchanged in integrals of w_c: ∫ f(x) w_c dx = −½ ∫ F(ξ) w₂′² dξ with F(ξ) = ∫_ξᴸ f dx, so the
//! matrices stay banded (the papers store the full H(x)).

use super::beam::Beam;
use super::damping::Damping;
use super::fields::{Fields, Point, Shapes, add_outer, add_vector};
use super::hub::Hub;
use super::isotropic::{Isotropic, Plane};
use super::product::Bundle;
use super::vectors::{Entry, Vectors};
use crate::linalg::{Matrix, Storage};
use crate::profile::HubKinematics;
use crate::section::Resultants;
use crate::system::{State, Weights};

/// Whether the foreshortening enters the kinetic energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foreshortening {
    /// Left out: zeroth-order coupling, or a field that needs none.
    None,
    /// Kept to first order.
    First,
}

/// Numbers of M and K among the four matrices of an [`Inertia`].
const MASS: usize = 2;
const STIFFNESS: usize = 3;

/// Constant matrices of a beam on a hub; their formulas head the source file.
///
/// P is antisymmetric in most models, or nearly so. With its symmetric part S, whose zeros are not multiplied, the equations for q are
///
/// ```text
/// M a − ω² D q + (Pᵀ − P)(ω v + ½ω̇ q) + (K + ω̇ S) q + ω̇ s_y − ω² s_x = 0
/// ```
///
/// The torque takes products with D and Pᵀ − P alone: they are the first two.
#[derive(Clone, Debug)]
pub struct Inertia {
    /// D, Pᵀ − P, M and K; the first two alone where D is M and K vanishes.
    bundle: Bundle,
    /// Whether there are four.
    four: bool,
    /// M and Pᵀ − P again, where they are those of fields of one basis along both axes, and the only two.
    isotropic: Option<Isotropic>,
    /// S, unless it vanishes.
    symmetric: Option<Bundle>,
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

/// Energy, momentum and torque of hub and beam.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Totals {
    /// Kinetic energy T \[J\].
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

/// Scratch for the products of the matrices of [`Inertia`].
#[derive(Clone, Debug)]
pub struct Scratch {
    vectors: [Vectors; 2],
    symmetric: Option<Vectors>,
    plane: Option<Plane>,
    /// Their products, row after row.
    products: [Vec<Entry>; 2],
    /// S q and S v; empty where S vanishes.
    of_symmetric: Vec<[f64; 2]>,
}

/// Sums over the unknowns that the equation of motion of the hub takes, with d = D q + s_x and e = Pᵀq + s_y.
#[derive(Clone, Copy, Debug, Default)]
struct HubSums {
    /// J + qᵀ(d + s_x), the moment of inertia.
    moment: f64,
    /// vᵀe, the angular momentum about the axis relative to the hub.
    relative: f64,
    /// vᵀd
    coriolis: f64,
    /// aᵀe + vᵀS v
    rest: f64,
}

impl HubSums {
    /// τ
    fn torque(&self, hub: &HubKinematics) -> f64 {
        hub.acceleration * self.moment + 2.0 * hub.speed * self.coriolis + self.rest
    }
}

impl Inertia {
    /// Integrates the matrices of `fields` on `hub`; of `beam` the inertia and stiffness of the
    /// section enter that are quadratic for the coupling.
    pub fn new(fields: &Fields, beam: &Beam<'_>, hub: &Hub, foreshortening: Foreshortening) -> Inertia {
        let structure = fields.structure(hub.unknowns());
        let radius = hub.radius;
        let first = foreshortening == Foreshortening::First;
        let Beam { section, masses, .. } = beam;
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
            let Resultants { mass, first_moment: s, rotary_inertia: i, .. } = resultants;
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
            // Centrifugal (dynamic) stiffening: the foreshortening −½∫w₂′² against the centrifugal force Ω² ∫_ξᴸ ρA (a + x) dx.
            if first && !lumped {
                add_outer(&mut p, (b, 1), (b, 1), w * moment_tail(x));
                add_outer(&mut d, (b, 1), (b, 1), -w * mass_tail(x));
            }
        };
        let inertial = fields.inertial();
        inertial.integrate(|point| add(point, section.resultants(point.x), false));
        for m in masses {
            let resultants = Resultants { mass: m.mass, rotary_inertia: m.inertia, ..Resultants::default() };
            add(&inertial.point(m.station, 1.0), resultants, true);
        }
        fields.integrate(|point| {
            let (w, a, b) = (point.weight, &point.axial, &point.transverse);
            let r = section.resultants(point.x);
            add_outer(&mut k, (a, 1), (a, 1), w * r.axial_stiffness);
            add_symmetric(&mut k, (a, 1), (b, 2), -w * r.coupling_stiffness);
            add_outer(&mut k, (b, 2), (b, 2), w * r.bending_stiffness);
        });
        let (mut gyroscopic, mut stiffening, mut symmetric) = (new(), new(), new());
        let half = structure.half_bandwidth();
        for i in 0..n {
            for j in i.saturating_sub(half)..(i + half + 1).min(n) {
                gyroscopic.add(i, j, p.get(j, i) - p.get(i, j));
                stiffening.add(i, j, m.get(i, j) - d.get(i, j));
                symmetric.add(i, j, 0.5 * (p.get(j, i) + p.get(i, j)));
            }
        }
        let bundle = |matrices| Bundle::new(&structure, n, matrices);
        let (elastic, stiffened) = (unless_zero(&k, 0.0), unless_zero(&stiffening, largest(&m)));
        let four = elastic.is_some() || stiffened.is_some();
        let isotropic = if four { None } else { Isotropic::of(n, half, &m, &gyroscopic) };
        let [centrifugal, inertial] = if four { [&d, &m].map(Some) } else { [Some(&m), None] };
        Inertia {
            bundle: bundle([centrifugal, Some(&gyroscopic), inertial, elastic]),
            four,
            isotropic,
            symmetric: unless_zero(&symmetric, largest(&p)).map(|s| bundle([Some(s), Some(s), None, None])),
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
        form(mass, self.mass_term()) + form(stiffness, STIFFNESS)
    }

    /// Number of M among the matrices.
    fn mass_term(&self) -> usize {
        if self.four { MASS } else { 0 }
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
            vectors: [self.bundle.vectors(), self.bundle.vectors()],
            products: [vec![[0.0; 4]; self.len()], vec![[0.0; 4]; self.len()]],
            symmetric: self.symmetric.as_ref().map(Bundle::vectors),
            plane: self.isotropic.as_ref().map(Isotropic::scratch),
            of_symmetric: self.symmetric.as_ref().map_or(Vec::new(), |_| vec![[0.0; 2]; self.len()]),
        }
    }

    /// The mass matrix M, the matrix D of the centrifugal forces and the stiffness matrix K.
    pub fn matrices(&self) -> (&Matrix, &Matrix, &Matrix) {
        (&self.mass, &self.centrifugal, &self.stiffness)
    }

    /// r = M (a + β v) + ω (Pᵀ − P) v + (K − ω² D + ω̇ Pᵀ) q + η K v + ω̇ s_y − ω² s_x: for a hub whose motion is known,
    /// one product a matrix.
    pub fn residual(&self, s: &State, hub: &HubKinematics, x: &mut Scratch, r: &mut [f64]) {
        let n = self.len();
        let (w, w1, w2) = (hub.speed, hub.acceleration, hub.speed * hub.speed);
        let (q, v, a) = (&s.q[..n], &s.v[..n], &s.a[..n]);
        let (sx, sy, r) = (&self.axial_moment[..n], &self.transverse_moment[..n], &mut r[..n]);
        let Damping { mass, stiffness } = self.damping;
        if let Some((isotropic, plane)) = self.isotropic.as_ref().zip(x.plane.as_mut()) {
            isotropic.inertia_forces(s, hub, mass, plane, r);
            for i in 0..n {
                r[i] += w1 * sy[i] - w2 * sx[i];
            }
        } else {
            x.vectors[0].set(|i| {
                let (q, v, a) = (q[i], v[i], a[i] + mass * v[i]);
                let with_d = if self.four { -w2 * q } else { a - w2 * q };
                [with_d, w * v + 0.5 * w1 * q, a, q + stiffness * v]
            });
            self.bundle.products(&x.vectors[0], &mut x.products[0]);
            for (i, [d, g, m, k]) in x.products[0].iter().enumerate() {
                r[i] = (m + k) + (g + d) + (w1 * sy[i] - w2 * sx[i]);
            }
        }
        if let Some((symmetric, y)) = self.symmetric.as_ref().zip(x.symmetric.as_mut()) {
            y.set(|i| [w1 * q[i], 0.0, 0.0, 0.0]);
            symmetric.products(y, &mut x.products[0]);
            r.iter_mut().zip(&x.products[0]).for_each(|(r, [s, ..])| *r += s);
        }
    }

    /// [`Inertia::residual`] for a free hub: also returns the torque of [`Inertia::totals`], with
    /// which it shares its products.
    ///
    /// ```text
    /// r = M (a + β v) + ω (Pᵀ − P) v + K (q + η v) + ω̇ e − ω² d,   d = D q + s_x,   e = Pᵀq + s_y
    /// ```
    pub fn residual_and_torque(&self, s: &State, hub: &HubKinematics, x: &mut Scratch, r: &mut [f64]) -> f64 {
        if self.isotropic.is_some() {
            self.residual(s, hub, x, r);
            return self.torque(s, hub, x);
        }
        let n = self.len();
        let (w, w1, w2) = (hub.speed, hub.acceleration, hub.speed * hub.speed);
        let (q, v, a, r) = (&s.q[..n], &s.v[..n], &s.a[..n], &mut r[..n]);
        let Damping { mass, stiffness } = self.damping;
        self.multiply_symmetric(s, x);
        x.vectors[0].set(|i| [q[i], q[i], a[i] + mass * v[i], q[i] + stiffness * v[i]]);
        x.vectors[1].set(|i| [a[i] + mass * v[i], v[i], 0.0, 0.0]);
        self.bundle.products(&x.vectors[0], &mut x.products[0]);
        self.bundle.first_products(&x.vectors[1], &mut x.products[1]);
        let sums = self.sums(s, x, |i, [d, e], [[_, _, ma, k], [m, gv, ..]]| {
            r[i] = (if self.four { ma } else { m } + k) + w * gv + (w1 * e - w2 * d);
        });
        sums.torque(hub)
    }

    /// The stamp of the tangent with weights `w` at a hub speed and acceleration: the key by which a factored tangent is recognised. The last entry is filled by the loads.
    pub fn stamp(&self, w: &Weights<'_>, hub: &HubKinematics) -> [f64; 6] {
        if !self.damping.is_none() {
            return [w.a, w.v, w.q, hub.speed, hub.acceleration, 0.0];
        }
        [w.a, w.v * hub.speed, w.q, w.q * hub.speed * hub.speed, w.q * hub.acceleration, 0.0]
    }

    /// Writes (w.a + β w.v) M + w.v (ω (Pᵀ − P) + η K) + w.q (K − ω² D + ω̇ Pᵀ) over the content of `out`, border aside.
    pub fn tangent(&self, w: &Weights<'_>, hub: &HubKinematics, out: &mut Storage<f64>) {
        let (w1, w2) = (hub.acceleration, hub.speed * hub.speed);
        let Damping { mass, stiffness } = self.damping;
        let (wm, wg) = (w.a + mass * w.v, w.v * hub.speed + 0.5 * w.q * w1);
        let wd = if self.four { -w.q * w2 } else { wm - w.q * w2 };
        self.bundle.write_sum([wd, wg, wm, w.q + stiffness * w.v], out);
        if let Some(symmetric) = &self.symmetric {
            symmetric.add_sum([w.q * w1, 0.0, 0.0, 0.0], out);
        }
    }

    /// Writes −ω² D + ω̇ Pᵀ over the content of `out`, border aside: ∂r/∂q without K.
    pub fn tangent_without_strain(&self, hub: &HubKinematics, out: &mut Storage<f64>) {
        let (w1, w2) = (hub.acceleration, hub.speed * hub.speed);
        self.bundle.write_sum([-w2, 0.5 * w1, 0.0, 0.0], out);
        if let Some(symmetric) = &self.symmetric {
            symmetric.add_sum([w1, 0.0, 0.0, 0.0], out);
        }
    }

    /// Kinetic energy T, angular momentum ∂T/∂ω and the torque τ of the equation of motion of the hub.
    pub fn totals(&self, s: &State, hub: &HubKinematics, x: &mut Scratch) -> Totals {
        let w = hub.speed;
        let sums = self.hub_sums(s, x);
        let HubSums { moment, relative, .. } = sums;
        let v = &s.v[..self.len()];
        let form = match self.isotropic.as_ref().zip(x.plane.as_mut()) {
            Some((isotropic, plane)) => isotropic.form(v, plane),
            None => self.bundle.form(self.mass_term(), v),
        };
        Totals {
            kinetic: 0.5 * form + w * relative + 0.5 * w * w * moment,
            momentum: w * moment + relative,
            torque: sums.torque(hub),
        }
    }

    /// The torque τ of [`Inertia::totals`] alone.
    pub fn torque(&self, s: &State, hub: &HubKinematics, x: &mut Scratch) -> f64 {
        self.hub_sums(s, x).torque(hub)
    }

    /// The tangent's row and column of a free hub, and their corner: derivatives of the residual by θ, θ̇, θ̈
    /// and of the torque by q, v, a, with the weights of the integrator.
    ///
    /// ```text
    /// ∂r/∂θ̇ = (Pᵀ − P) v − 2ω d,           ∂r/∂θ̈ = e
    /// ∂τ/∂q = 2ω̇ d + P a + 2ω D v,          ∂τ/∂v = 2ω d + (P + Pᵀ) v,     ∂τ/∂a = e
    /// ∂τ/∂θ̇ = 2 dᵀv,                        ∂τ/∂θ̈ = J + 2 s_xᵀq + qᵀD q
    /// ```
    pub fn border(&self, s: &State, hub: &HubKinematics, w: &Weights<'_>, x: &mut Scratch, out: &mut Border) {
        let n = self.len();
        let (om, al) = (hub.speed, hub.acceleration);
        let (v, a) = (&s.v[..n], &s.a[..n]);
        let (column, row) = (&mut out.column, &mut out.row);
        // P = S − G/2 with G = Pᵀ − P.
        self.multiply(v, x, 1);
        self.multiply_symmetric(s, x);
        self.multiply(&s.q[..n], x, 0);
        let sums = self.sums(s, x, |i, [d, e], [_, [dv, gv, ..]]| {
            column[i] = w.v * (gv - 2.0 * om * d) + w.a * e;
            row[i] = 2.0 * (w.q * al + w.v * om) * d + w.a * e + 2.0 * w.q * om * dv;
        });
        self.multiply(a, x, 0);
        row.iter_mut().zip(&x.products[0]).for_each(|(row, [_, ga, ..])| *row -= 0.5 * w.q * ga);
        if let Some((symmetric, y)) = self.symmetric.as_ref().zip(x.symmetric.as_mut()) {
            y.set(|i| [2.0 * w.v * v[i] + w.q * a[i], 0.0, 0.0, 0.0]);
            symmetric.products(y, &mut x.products[0]);
            row.iter_mut().zip(&x.products[0]).for_each(|(row, [s, ..])| *row += s);
        }
        out.corner = 2.0 * w.v * sums.coriolis + w.a * sums.moment;
    }

    /// Writes D y and (Pᵀ − P) y.
    fn multiply(&self, y: &[f64], x: &mut Scratch, to: usize) {
        if let Some((isotropic, plane)) = self.isotropic.as_ref().zip(x.plane.as_mut()) {
            isotropic.products(y, plane, &mut x.products[to]);
        } else {
            x.vectors[to].set(|i| [y[i], y[i], 0.0, 0.0]);
            self.bundle.first_products(&x.vectors[to], &mut x.products[to]);
        }
    }

    /// Writes S q and S v.
    fn multiply_symmetric(&self, s: &State, x: &mut Scratch) {
        let n = self.len();
        let (q, v) = (&s.q[..n], &s.v[..n]);
        if let Some((symmetric, y)) = self.symmetric.as_ref().zip(x.symmetric.as_mut()) {
            y.set(|i| [q[i], v[i], 0.0, 0.0]);
            symmetric.products(y, &mut x.products[0]);
            x.of_symmetric.iter_mut().zip(&x.products[0]).for_each(|(out, [sq, sv, ..])| *out = [*sq, *sv]);
        }
    }

    /// The sums of a state.
    fn hub_sums(&self, s: &State, x: &mut Scratch) -> HubSums {
        self.multiply_symmetric(s, x);
        self.multiply(&s.q[..self.len()], x, 0);
        self.sums(s, x, |_, _, _| {})
    }

    /// The sums of a state of which D q and (Pᵀ − P) q are the first products. Calls `f` with i, (d, e)ᵢ, and both products.
    #[inline(always)]
    fn sums(&self, s: &State, x: &Scratch, mut f: impl FnMut(usize, [f64; 2], [Entry; 2])) -> HubSums {
        let n = self.len();
        let (q, v, a) = (&s.q[..n], &s.v[..n], &s.a[..n]);
        let (sx, sy) = (&self.axial_moment[..n], &self.transverse_moment[..n]);
        let [of_q, of_others] = &x.products;
        let (of_q, of_others) = (&of_q[..n], &of_others[..n]);
        let mut sums = HubSums { moment: self.moment, ..HubSums::default() };
        for i in 0..n {
            let [dq, gq, ..] = of_q[i];
            let [sq, sv] = x.of_symmetric.get(i).copied().unwrap_or_default();
            let (d, e) = (dq + sx[i], 0.5 * gq + sq + sy[i]);
            sums.moment += q[i] * (d + sx[i]);
            sums.relative += v[i] * e;
            sums.coriolis += v[i] * d;
            sums.rest += a[i] * e + v[i] * sv;
            f(i, [d, e], [of_q[i], of_others[i]]);
        }
        sums
    }

    /// ½ qᵀK q.
    pub fn strain(&self, q: &[f64]) -> f64 {
        0.5 * self.bundle.form(STIFFNESS, q)
    }
}

/// `matrix`, unless it is the rounding error of numbers of the given size.
fn unless_zero(matrix: &Matrix, size: f64) -> Option<&Matrix> {
    (largest(matrix) > 1e-13 * size).then_some(matrix)
}

/// Largest entry, border aside.
fn largest(matrix: &Matrix) -> f64 {
    matrix.storage().entries().iter().fold(0.0, |m, x| x.abs().max(m))
}

/// out += w (φ⁽ᵈ⁾ ψ⁽ᵉ⁾ᵀ + ψ⁽ᵉ⁾ φ⁽ᵈ⁾ᵀ)
fn add_symmetric(out: &mut Matrix, a: (&Shapes, usize), b: (&Shapes, usize), w: f64) {
    add_outer(out, a, b, w);
    add_outer(out, b, a, w);
}
