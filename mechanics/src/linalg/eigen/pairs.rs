//! The eigenpairs of a pencil next to its shift.

use super::krylov::{Projection, Search, Space, TOLERANCE, krylov};
use super::operators::{General, Gyroscopic, Symmetric};
use super::{EigenError, Kind, Pair, Pencil};
use num_complex::Complex64;

impl Pencil {
    /// At least `count` eigenpairs next to the shift (fewer if there are fewer), ascending in |λ|, Im λ ≥ 0. Of a real
    /// pair ±λ of a symmetric pencil the growing one is given. `near` are approximate pairs, with which a conservative
    /// pencil begins: the Krylov space of a sum of eigenvectors is spanned by them.
    ///
    /// # Errors
    /// [`EigenError`] when they do not converge.
    pub fn pairs(
        &mut self,
        count: usize,
        near: &[(Complex64, &[Complex64])],
    ) -> Result<Vec<Pair>, EigenError> {
        let found = match self.kind() {
            Kind::Symmetric | Kind::Gyroscopic => self.conservative(count, near)?,
            Kind::General => self.general(count)?,
        };
        let mut pairs = Vec::with_capacity(found.len());
        for (value, vector) in found {
            let residual = self.residual(value, &vector);
            pairs.push(Pair { residual, value, vector });
        }
        pairs.sort_by(|a, b| a.value.norm().total_cmp(&b.value.norm()));
        Ok(pairs)
    }

    /// The pairs of a conservative pencil. Copies of a multiple eigenvalue are found one after the other, by a
    /// space that is orthogonal to what was found, until the count of frequencies says that none is missing.
    fn conservative(
        &mut self,
        count: usize,
        near: &[(Complex64, &[Complex64])],
    ) -> Result<Vec<(Complex64, Vec<Complex64>)>, EigenError> {
        let (n, shift) = (self.order(), self.shift());
        let projection = match self.kind() {
            Kind::Symmetric => Projection::Symmetric,
            _ => Projection::Skew,
        };
        let warm = (!near.is_empty()).then(|| self.sum(near));
        let mut found: Vec<(Complex64, Vec<Complex64>)> = Vec::new();
        let mut locked = Space::default();
        for round in 0..=count as u64 {
            // Copies are found one at a time.
            let wanted = if round == 0 { count } else { 1 };
            let start = warm.as_deref().filter(|_| round == 0);
            let search = Search { wanted, projection, tolerance: TOLERANCE, start, seed: round };
            let ritz = if self.kind() == Kind::Symmetric {
                krylov(&mut Symmetric(self), &locked, search)?
            } else {
                krylov(&mut Gyroscopic(self), &locked, search)?
            };
            let ritz = ritz.all(wanted)?;
            let before = found.len();
            for pair in ritz.pairs.iter().filter(|r| r.value.norm() > 0.0) {
                let value = if self.kind() == Kind::Symmetric {
                    let square = 1.0 / pair.value.re - shift * shift;
                    let root = square.abs().sqrt();
                    if square < 0.0 { Complex64::new(root, 0.0) } else { Complex64::new(0.0, root) }
                } else {
                    Complex64::new(0.0, (1.0 / pair.value).im)
                };
                let mut vector = ritz.space.vector(pair);
                vector.truncate(n);
                found.push((value, vector));
            }
            found.sort_by(|a, b| a.0.norm().total_cmp(&b.0.norm()));
            if found.len() == before || self.is_complete(&found, count) {
                break;
            }
            ritz.pairs.iter().for_each(|pair| locked.push_from(&ritz.space, pair));
        }
        Ok(found)
    }

    /// A sum of vectors of the operator in which each of the pairs has the same size after one product with it.
    fn sum(&self, near: &[(Complex64, &[Complex64])]) -> Vec<f64> {
        let n = self.order();
        let symmetric = self.kind() == Kind::Symmetric;
        let mut sum = vec![0.0; if symmetric { n } else { 2 * n }];
        for (value, x) in near {
            let factor = if symmetric { value.norm_sqr() } else { 1.0 };
            for (i, x) in x.iter().enumerate() {
                sum[i] += factor * x.re;
                if !symmetric {
                    sum[n + i] += (value * x).re;
                }
            }
        }
        sum
    }

    /// Whether nothing is missing among the first `count` eigenvalues found.
    fn is_complete(&self, found: &[(Complex64, Vec<Complex64>)], count: usize) -> bool {
        let Some((last, x)) = found.get(count.min(found.len()).saturating_sub(1)) else { return true };
        // With divergent eigenvalues those found need not be the lowest: nothing is counted.
        if found.iter().any(|(value, _)| value.re != 0.0) {
            return true;
        }
        let limit = self.just_below(*last, x);
        let below = found.iter().filter(|(value, _)| value.im < limit).count();
        self.count_below(limit).is_none_or(|counted| counted <= below)
    }

    fn general(&mut self, count: usize) -> Result<Vec<(Complex64, Vec<Complex64>)>, EigenError> {
        let (n, shift) = (self.order(), self.shift());
        let mut operator = General::new(self);
        let search = Search {
            wanted: count,
            projection: Projection::Hessenberg,
            tolerance: TOLERANCE,
            start: None,
            seed: 0,
        };
        let ritz = krylov(&mut operator, &Space::default(), search)?.all(count)?;
        let values = ritz.pairs.iter().filter(|r| r.value.norm() > 0.0);
        Ok(values
            .map(|r| (1.0 / r.value + shift, r))
            .filter(|(value, _)| value.im >= 0.0)
            .map(|(value, r)| {
                let mut vector = ritz.space.vector(r);
                vector.truncate(n);
                (value, vector)
            })
            .collect())
    }
}
