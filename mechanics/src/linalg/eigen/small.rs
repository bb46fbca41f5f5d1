//! Eigenpairs of the projected matrix, which is small and dense.

use super::EigenError;
use super::schur::{Schur, Square};
use nalgebra::{DMatrix, SymmetricEigen};
use num_complex::Complex64;

/// An eigenpair of the projected matrix and the estimate of its error.
pub(super) struct Ritz {
    pub value: Complex64,
    pub coefficients: Vec<Complex64>,
    pub error: f64,
    /// By how much an error of the matrix changes the value.
    pub condition: f64,
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
            condition: 1.0,
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

/// The eigenpairs of a projected matrix, of a Hessenberg matrix with the vectors in the basis of its Schur form.
pub(super) struct Spectrum {
    schur: Option<Schur>,
    pub ritz: Vec<Ritz>,
}

impl Spectrum {
    /// Those of the projected matrix with these columns.
    pub(super) fn of(columns: &[Vec<f64>]) -> Result<Spectrum, EigenError> {
        let m = columns.len();
        let mut h = Square::zeros(m);
        for (j, column) in columns.iter().enumerate() {
            (0..(j + 2).min(m)).for_each(|i| h.set(i, j, column[i]));
        }
        let size = columns.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        let schur = Schur::of(h).ok_or(EigenError::Iterations(m))?;
        let beta = coupling(columns);
        let pair = |k: usize| {
            let floor = f64::EPSILON * size;
            let coefficients = schur.vector(k, floor);
            let condition = schur.condition(k, &coefficients, floor);
            let last: Complex64 =
                coefficients.iter().enumerate().map(|(j, s)| schur.q.at(m - 1, j) * s).sum();
            Ritz { value: schur.t.at(k, k), coefficients, error: (beta * last.norm()).abs(), condition }
        };
        let ritz = sorted((0..m).map(pair).collect());
        Ok(Spectrum { schur: Some(schur), ritz })
    }

    /// The eigenpairs at these places, ascending.
    pub(super) fn take(self, places: &[usize]) -> Vec<Ritz> {
        let Spectrum { schur, ritz } = self;
        let is_taken = |(k, _): &(usize, Ritz)| places.binary_search(k).is_ok();
        let taken = ritz.into_iter().enumerate().filter(is_taken).map(|(_, ritz)| ritz);
        match schur {
            Some(schur) => {
                taken.map(|ritz| Ritz { coefficients: schur.in_space(&ritz.coefficients), ..ritz }).collect()
            }
            None => taken.collect(),
        }
    }
}

impl From<Vec<Ritz>> for Spectrum {
    fn from(ritz: Vec<Ritz>) -> Spectrum {
        Spectrum { schur: None, ritz }
    }
}

impl Schur {
    /// The eigenvector of the diagonal entry k of T, of length 1; eigenvalues closer than `floor` count as that far apart.
    fn vector(&self, k: usize, floor: f64) -> Vec<Complex64> {
        let value = self.t.at(k, k);
        let mut s: Vec<Complex64> = self.t.column(k)[..k].to_vec();
        s.push(Complex64::ONE);
        for j in (0..k).rev() {
            let gap = value - self.t.at(j, j);
            s[j] /= if gap.norm() < floor { floor.into() } else { gap };
            let (above, x) = s.split_at_mut(j);
            above.iter_mut().zip(self.t.column(j)).for_each(|(s, t)| *s += t * x[0]);
        }
        let norm = s.iter().map(|s| s.norm_sqr()).sum::<f64>().sqrt();
        s.iter_mut().for_each(|s| *s /= norm);
        s
    }

    /// Condition number of the diagonal entry k of T as an eigenvalue, 1/|yᴴs| of its left and right eigenvectors of length 1, with the right
    /// one given: an error of H changes the eigenvalue by so much at most, to first order.
    fn condition(&self, k: usize, s: &[Complex64], floor: f64) -> f64 {
        let (m, value) = (self.t.order(), self.t.at(k, k));
        let mut left = vec![Complex64::ONE];
        for j in k + 1..m {
            let sum: Complex64 = left.iter().zip(&self.t.column(j)[k..]).map(|(y, t)| y * t).sum();
            let gap = value - self.t.at(j, j);
            left.push(sum / if gap.norm() < floor { floor.into() } else { gap });
        }
        let size = left.iter().map(|y| y.norm_sqr()).sum::<f64>().sqrt();
        size / s[k].norm()
    }

    /// Q s
    fn in_space(&self, s: &[Complex64]) -> Vec<Complex64> {
        let mut out = vec![Complex64::ZERO; self.q.order()];
        for (j, s) in s.iter().enumerate() {
            out.iter_mut().zip(self.q.column(j)).for_each(|(out, q)| *out += q * s);
        }
        out
    }
}
