//! Eigenpairs of the projected matrix, which is small and dense.

use super::EigenError;
use nalgebra::{Complex, DMatrix, Schur, SymmetricEigen};
use num_complex::Complex64;

/// An eigenpair of the projected matrix and the estimate of its error.
pub(super) struct Ritz {
    pub value: Complex64,
    pub coefficients: Vec<Complex64>,
    pub error: f64,
}

/// Sorts by size, largest first.
fn sorted(mut ritz: Vec<Ritz>) -> Vec<Ritz> {
    ritz.sort_by(|a, b| b.value.norm().total_cmp(&a.value.norm()));
    ritz
}

/// Last entry below the last column: what couples the space to the rest.
fn coupling(columns: &[Vec<f64>]) -> f64 {
    columns.last().and_then(|c| c.last()).copied().unwrap_or(0.0)
}

/// Of the symmetric part of the projected matrix, which is tridiagonal.
pub(super) fn symmetric(columns: &[Vec<f64>]) -> Vec<Ritz> {
    let m = columns.len();
    let mut t = DMatrix::<f64>::zeros(m, m);
    for (j, h) in columns.iter().enumerate() {
        t[(j, j)] = h[j];
        if j + 1 < m {
            (t[(j + 1, j)], t[(j, j + 1)]) = (h[j + 1], h[j + 1]);
        }
    }
    let eigen = SymmetricEigen::new(t);
    let beta = coupling(columns);
    let pair = |k: usize| {
        let s = eigen.eigenvectors.column(k);
        Ritz {
            value: eigen.eigenvalues[k].into(),
            coefficients: s.iter().map(|s| Complex64::from(*s)).collect(),
            error: (beta * s[m - 1]).abs(),
        }
    };
    sorted((0..m).map(pair).collect())
}

/// Of the skew part T of the projected matrix: T = D (−iB) D⁻¹ with B symmetric, tridiagonal, without diagonal,
/// and D = diag(iᵏ).
pub(super) fn skew(columns: &[Vec<f64>]) -> Vec<Ritz> {
    let mut columns = columns.to_vec();
    for (j, h) in columns.iter_mut().enumerate() {
        h[j] = 0.0;
    }
    let mut ritz = symmetric(&columns);
    let powers = [Complex64::ONE, Complex64::I, -Complex64::ONE, -Complex64::I];
    for r in &mut ritz {
        r.value *= -Complex64::I;
        for (k, c) in r.coefficients.iter_mut().enumerate() {
            *c *= powers[k % 4];
        }
    }
    ritz
}

/// Of a Hessenberg matrix, by its Schur form.
pub(super) fn hessenberg(columns: &[Vec<f64>]) -> Result<Vec<Ritz>, EigenError> {
    let m = columns.len();
    let mut h = DMatrix::<Complex<f64>>::zeros(m, m);
    for (j, column) in columns.iter().enumerate() {
        for i in 0..(j + 2).min(m) {
            h[(i, j)] = column[i].into();
        }
    }
    let size = h.iter().map(|x| x.norm()).fold(0.0, f64::max);
    let schur = Schur::try_new(h, f64::EPSILON, 300 * m).ok_or(EigenError::Projection(m))?;
    let (q, t) = schur.unpack();
    let beta = coupling(columns);
    let floor = f64::EPSILON * size;
    let mut ritz = Vec::with_capacity(m);
    for k in 0..m {
        let value = t[(k, k)];
        let mut s = vec![Complex64::default(); k + 1];
        s[k] = Complex64::ONE;
        for i in (0..k).rev() {
            let sum: Complex64 = (i + 1..=k).map(|j| t[(i, j)] * s[j]).sum();
            let mut gap = value - t[(i, i)];
            if gap.norm() < floor {
                gap = floor.into();
            }
            s[i] = sum / gap;
        }
        let mut coefficients: Vec<Complex64> =
            (0..m).map(|i| s.iter().enumerate().map(|(j, s)| q[(i, j)] * s).sum()).collect();
        let norm = coefficients.iter().map(|c| c.norm_sqr()).sum::<f64>().sqrt();
        coefficients.iter_mut().for_each(|c| *c /= norm);
        // Real eigenvalues of a real matrix come out with the rounding of a complex computation.
        let value = if value.im.abs() <= 1e-13 * size.min(value.norm()) { value.re.into() } else { value };
        let error = (beta * coefficients[m - 1].norm()).abs();
        ritz.push(Ritz { value, coefficients, error });
    }
    Ok(sorted(ritz))
}
