//! Shape functions of radial point interpolation on one support domain, in scaled coordinates
//! ξ = (x − middle of the cell)/d_c.
//!
//! Moment matrix G = [R P; Pᵀ 0], R_kl = λ_k λ_l R(ξ − η): λ are the values (and, for Hermite type, the
//! slopes) at the nodes; shape functions φ_k = Σ_l b_l G⁻¹_lk. G is so ill-conditioned for flat radial
//! functions (α_c > 3) that it is inverted, and the sums are taken, in double-double arithmetic; inside
//! the cell each derivative is then kept as a Chebyshev series, exact to working precision.

use super::double::Double;
use crate::basis::domains;
use std::f64::consts::PI;

/// Highest derivative kept.
const DERIVATIVES: usize = 4;

/// Largest tolerated error of a value or slope of a shape function at a node.
const KRONECKER: f64 = 1e-10;
/// Largest tolerated remainder of a series, over the largest coefficient: rounding noise included.
const NOISE: f64 = 1e-14;

/// What defines a support domain.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// Scaled positions of the nodes ξ; the cell is [−½, ½].
    pub nodes: Vec<f64>,
    /// Whether slopes are interpolated too.
    pub slopes: bool,
    /// α_c.
    pub shape: f64,
    /// q.
    pub exponent: f64,
    /// Number of polynomial terms m.
    pub terms: usize,
}

/// Why a patch cannot be formed.
pub(super) enum Fault {
    /// κ₁ of the moment matrix (infinite when a pivot vanished).
    Singular(f64),
    /// The functions vary too fast inside the cell.
    Unresolved,
}

/// Shape functions of one layout inside its cell.
#[derive(Clone, Debug)]
pub struct Patch {
    layout: Layout,
    /// κ₁ of the moment matrix.
    condition: f64,
    /// Chebyshev coefficients, `[derivative][function][degree]`.
    series: Vec<f64>,
    functions: usize,
    terms: usize,
}

impl Patch {
    pub(super) fn new(layout: Layout) -> Result<Patch, Fault> {
        let functions = layout.nodes.len() * if layout.slopes { 2 } else { 1 };
        let n = functions + layout.terms;
        let moment = layout.moment_matrix(functions);
        let inverse = invert(&moment, n).ok_or(Fault::Singular(f64::INFINITY))?;
        let (inverse, kronecker) = refine(&moment, inverse, n);
        let condition = norm(&moment, n) * norm(&inverse, n);
        let sound = condition * f64::EPSILON < 1.0 && kronecker <= KRONECKER;
        if !sound {
            return Err(Fault::Singular(condition));
        }
        for terms in [12, 16, 20, 24, 32, 48, 64] {
            let series = layout.chebyshev(functions, &inverse, terms);
            if resolved(&series, functions, terms) {
                return Ok(Patch { layout, condition, series, functions, terms });
            }
        }
        // Rounding noise of an ill-conditioned matrix never falls; otherwise the functions are too steep.
        Err(if condition > 1e12 { Fault::Singular(condition) } else { Fault::Unresolved })
    }
}

impl domains::Patch for Patch {
    fn nodes(&self) -> &[f64] {
        &self.layout.nodes
    }

    fn functions(&self) -> usize {
        self.functions
    }

    /// By Clenshaw's recurrence.
    fn eval(&self, k: usize, derivative: usize, xi: f64) -> f64 {
        if derivative >= DERIVATIVES {
            return 0.0;
        }
        let start = (derivative * self.functions + k) * self.terms;
        let c = &self.series[start..start + self.terms];
        let (z, mut b, mut before) = (2.0 * xi, 0.0, 0.0);
        for &c in c[1..].iter().rev() {
            (b, before) = (c + 2.0 * z * b - before, b);
        }
        c[0] + z * b - before
    }

    fn condition(&self) -> f64 {
        self.condition
    }

    /// n Gauss points integrate degree 2n − 1; the coefficients of a product of two resolved series have fallen to rounding
    /// at the degree of one.
    fn points(&self) -> usize {
        (self.terms - 1) / 2 + 3
    }
}

impl Layout {
    /// Derivative `d` of (ξ² + α_c²)^q.
    fn radial(&self, xi: Double, d: usize) -> Double {
        let q = Double::from(self.exponent);
        let falling = |k: usize| (0..k).fold(Double::ONE, |p, i| p * (q - (i as f64).into()));
        let c = Double::from(self.shape);
        let s = xi * xi + c * c;
        let power = s.pow(self.exponent);
        let term = |factor: f64, k: usize, r: usize| -> Double {
            Double::from(factor) * falling(k) * xi.powi(r) * power / s.powi(k)
        };
        match d {
            0 => power,
            1 => term(2.0, 1, 1),
            2 => term(2.0, 1, 0) + term(4.0, 2, 2),
            3 => term(12.0, 2, 1) + term(8.0, 3, 3),
            _ => term(12.0, 2, 0) + term(48.0, 3, 2) + term(16.0, 4, 4),
        }
    }

    /// Derivative `d` at ξ of all functions b_l: radial ones, their slopes, monomials.
    fn functions_at(&self, xi: Double, d: usize, out: &mut Vec<Double>) {
        out.clear();
        for &node in &self.nodes {
            let r = xi - node.into();
            out.push(self.radial(r, d));
            if self.slopes {
                out.push(-self.radial(r, d + 1));
            }
        }
        for m in 0..self.terms {
            let falling = (0..d).fold(1.0, |p, i| p * (m as f64 - i as f64));
            out.push(if d > m { Double::ZERO } else { Double::from(falling) * xi.powi(m - d) });
        }
    }

    fn moment_matrix(&self, functions: usize) -> Vec<Double> {
        let n = functions + self.terms;
        let mut matrix = vec![Double::ZERO; n * n];
        let mut row = Vec::with_capacity(n);
        let per_node = if self.slopes { 2 } else { 1 };
        for i in 0..functions {
            self.functions_at(self.nodes[i / per_node].into(), i % per_node, &mut row);
            matrix[i * n..(i + 1) * n].copy_from_slice(&row);
            for m in functions..n {
                matrix[m * n + i] = row[m];
            }
        }
        matrix
    }

    fn chebyshev(&self, functions: usize, inverse: &[Double], terms: usize) -> Vec<f64> {
        let n = functions + self.terms;
        let mut series = vec![0.0; DERIVATIVES * functions * terms];
        let mut basis = Vec::with_capacity(n);
        for p in 0..terms {
            let angle = PI * (p as f64 + 0.5) / terms as f64;
            for d in 0..DERIVATIVES {
                self.functions_at((0.5 * libm::cos(angle)).into(), d, &mut basis);
                for k in 0..functions {
                    let sum = (0..n).fold(Double::ZERO, |sum, l| sum + basis[l] * inverse[l * n + k]);
                    let start = (d * functions + k) * terms;
                    for (m, c) in series[start..start + terms].iter_mut().enumerate() {
                        let weight = if m == 0 { 1.0 } else { 2.0 } / terms as f64;
                        *c += weight * sum.value() * libm::cos(m as f64 * angle);
                    }
                }
            }
        }
        series
    }
}

/// Whether the last coefficients of every series have fallen to rounding.
fn resolved(series: &[f64], functions: usize, terms: usize) -> bool {
    series.chunks(functions * terms).all(|derivative| {
        let most = derivative.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        derivative.chunks(terms).all(|c| c[terms - 3..].iter().all(|c| c.abs() <= NOISE * most))
    })
}

/// Largest sum of magnitudes down a column.
fn norm(a: &[Double], n: usize) -> f64 {
    (0..n).map(|j| (0..n).map(|i| a[i * n + j].value().abs()).sum()).fold(0.0, f64::max)
}

/// One step of Newton's method X ← X + X (1 − G X), and the largest entry of |1 − G X| after it: the
/// error of the Kronecker property.
fn refine(g: &[Double], x: Vec<Double>, n: usize) -> (Vec<Double>, f64) {
    let product = |a: &[Double], b: &[Double], start: &dyn Fn(usize, usize) -> Double, sign: f64| {
        let mut out = vec![Double::ZERO; n * n];
        for i in 0..n {
            for j in 0..n {
                let sum = (0..n).fold(Double::ZERO, |sum, k| sum + a[i * n + k] * b[k * n + j]);
                out[i * n + j] = start(i, j) + sum * sign.into();
            }
        }
        out
    };
    let unit = |i: usize, j: usize| if i == j { Double::ONE } else { Double::ZERO };
    let rest = product(g, &x, &unit, -1.0);
    let better = product(&x, &rest, &|i, j| x[i * n + j], 1.0);
    let after = product(g, &better, &unit, -1.0);
    let largest = after.iter().fold(0.0_f64, |m, r| m.max(r.value().abs()));
    (better, largest)
}

/// Gauss–Jordan inverse with row pivoting; `None` when a pivot vanishes.
fn invert(a: &[Double], n: usize) -> Option<Vec<Double>> {
    let width = 2 * n;
    let mut work = vec![Double::ZERO; n * width];
    for i in 0..n {
        work[i * width..i * width + n].copy_from_slice(&a[i * n..(i + 1) * n]);
        work[i * width + n + i] = Double::ONE;
    }
    for column in 0..n {
        let size = |row: usize| work[row * width + column].abs().value();
        let pivot = (column..n).fold(column, |best, row| if size(row) > size(best) { row } else { best });
        if !(size(pivot) > 0.0 && size(pivot).is_finite()) {
            return None;
        }
        for j in 0..width {
            work.swap(pivot * width + j, column * width + j);
        }
        let scale = Double::ONE / work[column * width + column];
        for j in column..width {
            work[column * width + j] *= scale;
        }
        for row in (0..n).filter(|&row| row != column) {
            let factor = work[row * width + column];
            for j in column..width {
                work[row * width + j] = work[row * width + j] - factor * work[column * width + j];
            }
        }
    }
    Some((0..n).flat_map(|i| work[i * width + n..(i + 1) * width].to_vec()).collect())
}
