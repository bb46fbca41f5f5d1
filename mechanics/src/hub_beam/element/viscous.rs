//! Stiffness-proportional damping of an element of the exact coupling: the material of Kelvin and Voigt.
//!
//! The strains e = (ε at the three samples, κ at the quadrature points) have the work conjugates S e; the stresses
//! S (e + η ė) add, with B = ∂e/∂d, ė = B ḋ and H_k = ∂²e_k/∂d²,
//!
//! ```text
//! f = η Bᵀ S ė,   ∂f/∂ḋ = η Bᵀ S B,   ∂f/∂d = η [ Σ_k (S ė)_k H_k + Bᵀ S D ],  D_k = (H_k ḋ)ᵀ,   power η ėᵀ S ė
//! ```
//!
//! ε̇ and κ̇ are those of the curve: a rigid rotation of a deformed beam dissipates nothing.

use super::{Element, Local, components};
use crate::hub_beam::rule::{POINTS, Rule};
use crate::linalg::vector::inner;
use crate::system::Weights;

/// Strains of an element: three of the axis, then the curvatures.
const STRAINS: usize = 3 + POINTS;

/// One strain with its derivatives by the local unknowns: value aside, B_k and H_k ḋ.
#[derive(Clone, Copy, Debug)]
struct Strain {
    /// B_k
    gradient: [f64; 8],
    /// H_k ḋ
    hessian_rate: [f64; 8],
    /// ė_k
    rate: f64,
}

/// Second derivatives of a strain by its arguments z (slopes, and second derivatives for a curvature).
type Hessian = [[f64; 4]; 4];

/// ε = |p′| − 1: gradient and Hessian by (X′, Y′).
fn axial_strain(x: f64, y: f64) -> ([f64; 4], Hessian) {
    let l = libm::hypot(x, y);
    let (tx, ty) = (x / l, y / l);
    let mut h = [[0.0; 4]; 4];
    (h[0][0], h[0][1], h[1][0], h[1][1]) = (ty * ty / l, -tx * ty / l, -tx * ty / l, tx * tx / l);
    ([tx, ty, 0.0, 0.0], h)
}

/// κ = c/s, c = X′Y″ − Y′X″, s = X′² + Y′²: gradient and Hessian by (X′, Y′, X″, Y″).
fn curvature([x1, y1, x2, y2]: [f64; 4]) -> ([f64; 4], Hessian) {
    let s = x1 * x1 + y1 * y1;
    let k = (x1 * y2 - y1 * x2) / s;
    let (ds, dc) = ([2.0 * x1, 2.0 * y1, 0.0, 0.0], [y2, -x2, -y1, x1]);
    let mut g = [0.0; 4];
    for a in 0..4 {
        g[a] = (dc[a] - k * ds[a]) / s;
    }
    let mut h = [[0.0; 4]; 4];
    let cross = [(0, 3, 1.0), (1, 2, -1.0)];
    for (a, b, c) in cross {
        h[a][b] += c / s;
        h[b][a] += c / s;
    }
    for a in 0..4 {
        for b in 0..4 {
            h[a][b] -= (g[a] * ds[b] + g[b] * ds[a]) / s;
        }
    }
    for a in 0..2 {
        h[a][a] -= 2.0 * k / s;
    }
    (g, h)
}

/// The rows that map the local unknowns to the arguments of a strain: N′ and N″.
struct Rows {
    n1: [f64; 4],
    n2: [f64; 4],
}

impl Rows {
    /// Row of argument `a` for the functions of its own component.
    fn row(&self, a: usize) -> &[f64; 4] {
        if a < 2 { &self.n1 } else { &self.n2 }
    }

    /// The arguments' rates for the local vector `d`.
    fn arguments(&self, d: &[f64; 8]) -> [f64; 4] {
        let [u, v] = components(d);
        [inner(self.n1, u), inner(self.n1, v), inner(self.n2, u), inner(self.n2, v)]
    }

    /// Adds to a local vector what belongs to derivatives `g` by the arguments.
    fn spread(&self, g: &[f64; 4], out: &mut [f64; 8]) {
        for (a, g) in g.iter().enumerate() {
            for (k, n) in self.row(a).iter().enumerate() {
                out[4 * (a % 2) + k] += g * n;
            }
        }
    }
}

/// Strains of an element, and the Hessians by their arguments.
struct Strains {
    rows: [Rows; STRAINS],
    strains: [Strain; STRAINS],
    hessians: [Hessian; STRAINS],
}

impl Element {
    fn strain_rates(&self, rule: &Rule, local: &Local) -> Strains {
        let sample = |n1: [f64; 4]| Rows { n1, n2: [0.0; 4] };
        let end = |k: usize| std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
        let rows: [Rows; STRAINS] = std::array::from_fn(|k| match k {
            0 => sample(end(1)),
            1 => sample(rule.middle()),
            2 => sample(end(3)),
            _ => {
                let (n1, n2) = rule.slopes(k - 3);
                Rows { n1, n2 }
            }
        });
        let mut hessians = [[[0.0; 4]; 4]; STRAINS];
        let strains = std::array::from_fn(|k| {
            let mut z = rows[k].arguments(&local.q);
            z[0] += 1.0;
            let rates = rows[k].arguments(&local.v);
            let (g, h) = if k < 3 { axial_strain(z[0], z[1]) } else { curvature(z) };
            let hessian_rate = h.map(|row| inner(row, rates));
            let mut strain = Strain { gradient: [0.0; 8], hessian_rate: [0.0; 8], rate: 0.0 };
            rows[k].spread(&g, &mut strain.gradient);
            rows[k].spread(&hessian_rate, &mut strain.hessian_rate);
            strain.rate = inner(g, rates);
            hessians[k] = h;
            strain
        });
        Strains { rows, strains, hessians }
    }

    /// Adds η ∂e/∂dᵀ S ė to `f`.
    pub fn viscous_force(&self, rule: &Rule, local: &Local, eta: f64, f: &mut [f64; 8]) {
        let strains = self.strain_rates(rule, local).strains;
        let stress = self.conjugates(rule, &strains.map(|s| s.rate));
        for (strain, stress) in strains.iter().zip(stress) {
            for (f, b) in f.iter_mut().zip(&strain.gradient) {
                *f += eta * stress * b;
            }
        }
    }

    /// Adds the tangent of [`Element::viscous_force`] to `out`.
    pub fn viscous_tangent(
        &self,
        rule: &Rule,
        local: &Local,
        eta: f64,
        w: &Weights<'_>,
        out: &mut [[f64; 8]; 8],
    ) {
        let Strains { rows, strains, hessians } = self.strain_rates(rule, local);
        let stress = self.conjugates(rule, &strains.map(|s| s.rate));
        for j in 0..8 {
            // Derivatives of the rates by unknown j, weighted.
            let by = strains.map(|s| w.v * s.gradient[j] + w.q * s.hessian_rate[j]);
            for (strain, stress) in strains.iter().zip(self.conjugates(rule, &by)) {
                for (row, b) in out.iter_mut().zip(&strain.gradient) {
                    row[j] += eta * stress * b;
                }
            }
        }
        for ((rows, hessian), stress) in rows.iter().zip(&hessians).zip(stress) {
            let c = eta * w.q * stress;
            for (a, of) in hessian.iter().enumerate() {
                let mut columns = [0.0; 8];
                rows.spread(&of.map(|h| c * h), &mut columns);
                for (k, n) in rows.row(a).iter().enumerate() {
                    for (out, x) in out[4 * (a % 2) + k].iter_mut().zip(&columns) {
                        *out += n * x;
                    }
                }
            }
        }
    }

    /// η ėᵀ S ė \[W\].
    pub fn viscous_power(&self, rule: &Rule, local: &Local, eta: f64) -> f64 {
        let rates = self.strain_rates(rule, local).strains.map(|s| s.rate);
        let stress = self.conjugates(rule, &rates);
        eta * rates.iter().zip(stress).map(|(e, s)| e * s).sum::<f64>()
    }
}
