//! What the tests of the bases share.

use super::conformance::{self, Report};
pub use super::conformance::{gram, largest};
use super::{Basis, Field};

/// All that a basis must satisfy.
pub fn all(basis: &dyn Basis, field: Field) {
    asserted(|report| conformance::all(basis, field, (1e-8, 1e-13), report));
}

/// Derivatives against differences, to a relative tolerance.
pub fn derivatives_equal_finite_differences(basis: &dyn Basis, tolerance: f64) {
    asserted(|report| conformance::derivatives(basis, tolerance, report));
}

/// The rule the basis asks for against one of many more points, to a relative tolerance.
pub fn quadrature_is_exact(basis: &dyn Basis, field: Field, tolerance: f64) {
    asserted(|report| conformance::points(basis, field, tolerance, report));
}

/// Fails at the first report.
fn asserted(check: impl FnOnce(&mut Report<'_>)) {
    check(&mut |check, place, found, expected| panic!("{check}: {place} is {found:e} for {expected:e}"));
}

/// Σ φᵢ cᵢ and its derivatives against the given functions, everywhere.
pub fn reproduces<const N: usize>(
    basis: &dyn Basis,
    coefficients: &[f64],
    derivatives: [&dyn Fn(f64) -> f64; N],
) {
    let mut out = vec![0.0; basis.max_support()];
    for c in 0..basis.cells().len() - 1 {
        let (a, b) = (basis.cells()[c], basis.cells()[c + 1]);
        for k in 0..=4 {
            let x = a + 0.25 * k as f64 * (b - a);
            for (d, exact) in derivatives.iter().enumerate() {
                let support = basis.eval(c, x, d, &mut out);
                let found: f64 = support.zip(&out).map(|(i, v)| coefficients[i] * v).sum();
                let l = (b - a).powi(d as i32);
                assert!(
                    (found - exact(x)).abs() <= 1e-13 / l * (1.0 + exact(x).abs()),
                    "derivative {d} at {x}: {found} for {}",
                    exact(x)
                );
            }
        }
    }
}

/// Relative errors of the tip deflection under a tip load and of the first bending frequency of a uniform
/// cantilever, assembled from the basis.
pub fn cantilever_errors(basis: &dyn Basis) -> (f64, f64) {
    let (n, length) = (basis.len(), basis.cells()[basis.cells().len() - 1]);
    let stiffness = gram(basis, 2, basis.points_per_cell(), |_| 1.0);
    let mass = gram(basis, 0, basis.points_per_cell(), |_| 1.0);
    let mut tip = vec![0.0; n];
    let support = basis.support(basis.cells().len() - 2);
    basis.eval(basis.cells().len() - 2, length, 0, &mut tip[support]);
    let deflected = solve(stiffness.clone(), tip.clone());
    let deflection: f64 = tip.iter().zip(&deflected).map(|(a, b)| a * b).sum();
    let times = |x: &[f64]| -> Vec<f64> {
        mass.chunks(n).map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum()).collect()
    };
    let (mut x, mut square) = (deflected, 0.0);
    for _ in 0..8 {
        let load = times(&x);
        let y = solve(stiffness.clone(), load.clone());
        let work: f64 = y.iter().zip(&load).map(|(a, b)| a * b).sum();
        let inertia: f64 = y.iter().zip(times(&y)).map(|(a, b)| a * b).sum();
        square = work / inertia;
        let size = inertia.sqrt();
        x = y.iter().map(|y| y / size).collect();
    }
    let exact = crate::exact::cantilever::bending_frequency(1, 1.0, 1.0, length);
    (deflection * 3.0 / length.powi(3) - 1.0, square.sqrt() / exact - 1.0)
}

/// Gauss elimination with row pivoting, rows and columns scaled by the diagonal.
fn solve(mut a: Vec<f64>, b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    let scale: Vec<f64> = (0..n).map(|i| 1.0 / a[i * n + i].sqrt()).collect();
    let mut x: Vec<f64> = b.iter().zip(&scale).map(|(b, s)| b * s).collect();
    for i in 0..n {
        for j in 0..n {
            a[i * n + j] *= scale[i] * scale[j];
        }
    }
    for c in 0..n {
        let size = |r: usize| a[r * n + c].abs();
        let p = (c..n).max_by(|&r, &s| size(r).total_cmp(&size(s))).unwrap();
        for j in 0..n {
            a.swap(p * n + j, c * n + j);
        }
        x.swap(p, c);
        for r in c + 1..n {
            let factor = a[r * n + c] / a[c * n + c];
            for j in c..n {
                a[r * n + j] -= factor * a[c * n + j];
            }
            x[r] -= factor * x[c];
        }
    }
    for r in (0..n).rev() {
        let rest: f64 = (r + 1..n).map(|j| a[r * n + j] * x[j]).sum();
        x[r] = (x[r] - rest) / a[r * n + r];
    }
    x.iter().zip(&scale).map(|(x, s)| x * s).collect()
}
