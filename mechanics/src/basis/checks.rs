//! Properties of every basis, for the tests of each.

use super::{Basis, Field};
use crate::quadrature::Gauss;

/// All checks below.
pub fn all(basis: &dyn Basis, field: Field) {
    supports_are_contiguous_and_ascending(basis);
    derivatives_equal_finite_differences(basis, 1e-8);
    clamp_holds(basis, field);
    field_is_continuous_across_cells(basis, field);
    quadrature_is_exact(basis, field, 1e-13);
}

fn supports_are_contiguous_and_ascending(basis: &dyn Basis) {
    let cells = basis.cells().len() - 1;
    assert_eq!(basis.cells()[0], 0.0);
    assert!(basis.cells().windows(2).all(|c| c[0] < c[1]));
    assert_eq!(basis.support(0).start, 0);
    assert_eq!(basis.support(cells - 1).end, basis.len());
    for c in 1..cells {
        let (a, b) = (basis.support(c - 1), basis.support(c));
        assert!(a.start <= b.start && a.end <= b.end && b.start <= a.end, "cell {c}: {a:?} then {b:?}");
    }
    for i in 1..basis.len() {
        assert!(basis.anchor(i - 1) <= basis.anchor(i));
    }
}

/// Derivative d + 1 against the five-point difference of derivative d, relative to its largest value.
pub fn derivatives_equal_finite_differences(basis: &dyn Basis, tolerance: f64) {
    let mut buffers = vec![vec![0.0; basis.max_support()]; 6];
    let scale: Vec<f64> = (0..4).map(|d| largest(basis, d)).collect();
    for c in 0..basis.cells().len() - 1 {
        let (a, b) = (basis.cells()[c], basis.cells()[c + 1]);
        for s in [0.07, 0.31, 0.5, 0.83, 0.94] {
            let (x, h) = (a + s * (b - a), 2e-3 * (b - a));
            for d in 0..3 {
                for (buffer, step) in buffers.iter_mut().zip([-2.0, -1.0, 1.0, 2.0]) {
                    basis.eval(c, x + step * h, d, buffer);
                }
                let count = basis.eval(c, x, d + 1, &mut buffers[5]).len();
                for k in 0..count {
                    let y: Vec<f64> = buffers[..4].iter().map(|b| b[k]).collect();
                    let slope = (y[0] - 8.0 * y[1] + 8.0 * y[2] - y[3]) / (12.0 * h);
                    let error = (buffers[5][k] - slope).abs();
                    // Rounding of the difference itself.
                    let floor = 8.0 * f64::EPSILON * scale[d] / h;
                    assert!(
                        error <= tolerance * scale[d + 1] + floor,
                        "cell {c} x {x} derivative {} function {k}: {} for {slope}",
                        d + 1,
                        buffers[5][k]
                    );
                }
            }
        }
    }
}

/// Largest |φ⁽ᵈ⁾| of all functions at a few points of each cell.
pub fn largest(basis: &dyn Basis, derivative: usize) -> f64 {
    let mut out = vec![0.0; basis.max_support()];
    let mut most: f64 = 0.0;
    for c in 0..basis.cells().len() - 1 {
        let (a, b) = (basis.cells()[c], basis.cells()[c + 1]);
        for k in 0..=8 {
            let count = basis.eval(c, a + k as f64 / 8.0 * (b - a), derivative, &mut out).len();
            most = out[..count].iter().fold(most, |m, v| m.max(v.abs()));
        }
    }
    most
}

fn clamp_holds(basis: &dyn Basis, field: Field) {
    let mut out = vec![0.0; basis.max_support()];
    let order = if field == Field::Transverse { 2 } else { 1 };
    for d in 0..order {
        let count = basis.eval(0, 0.0, d, &mut out).len();
        let most = out[..count].iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        assert!(most <= 1e-11 * largest(basis, d), "derivative {d} at the clamp is {most}");
    }
}

fn field_is_continuous_across_cells(basis: &dyn Basis, field: Field) {
    let (mut left, mut right) = (vec![0.0; basis.max_support()], vec![0.0; basis.max_support()]);
    let order = if field == Field::Transverse { 2 } else { 1 };
    for d in 0..order {
        let scale = largest(basis, d);
        for c in 1..basis.cells().len() - 1 {
            let x = basis.cells()[c];
            let (a, b) = (basis.eval(c - 1, x, d, &mut left), basis.eval(c, x, d, &mut right));
            for i in a.start..b.end {
                let one = if a.contains(&i) { left[i - a.start] } else { 0.0 };
                let two = if b.contains(&i) { right[i - b.start] } else { 0.0 };
                assert!(
                    (one - two).abs() <= 1e-10 * scale,
                    "derivative {d} of function {i} jumps at {x}: {one} {two}"
                );
            }
        }
    }
}

/// ∫ φᵢ⁽ᵈ⁾ φⱼ⁽ᵈ⁾ w dx with `points` Gauss points a cell, row-major.
pub fn gram(basis: &dyn Basis, derivative: usize, points: usize, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let (n, gauss) = (basis.len(), Gauss::new(points));
    let mut out = vec![0.0; basis.max_support()];
    let mut matrix = vec![0.0; n * n];
    for c in 0..basis.cells().len() - 1 {
        for (x, w) in gauss.on(basis.cells()[c], basis.cells()[c + 1]) {
            let support = basis.eval(c, x, derivative, &mut out);
            for (k, i) in support.clone().enumerate() {
                for (l, j) in support.clone().enumerate() {
                    matrix[i * n + j] += w * weight(x) * out[k] * out[l];
                }
            }
        }
    }
    matrix
}

/// The rule of the basis against one of many more points, relative to √(Gᵢᵢ Gⱼⱼ).
pub fn quadrature_is_exact(basis: &dyn Basis, field: Field, tolerance: f64) {
    let (n, points) = (basis.len(), basis.points_per_cell());
    let length = basis.cells()[basis.cells().len() - 1];
    let order = if field == Field::Transverse { 2 } else { 1 };
    for d in 0..=order {
        let weight = |x: f64| 0.3 + x / length;
        let (few, many) = (gram(basis, d, points, weight), gram(basis, d, 2 * points + 6, weight));
        for i in 0..n {
            for j in 0..n {
                let scale = (many[i * n + i] * many[j * n + j]).sqrt();
                let error = (few[i * n + j] - many[i * n + j]).abs();
                assert!(error <= tolerance * scale, "derivative {d} entry {i} {j}: {:.1e}", error / scale);
            }
        }
    }
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
