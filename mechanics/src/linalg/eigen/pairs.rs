//! The eigenpairs of a pencil next to its shift.

use super::krylov::{Projection, Search, Space, TOLERANCE, krylov};
use super::operators::{General, Gyroscopic, Symmetric};
use super::{EigenError, Kind, Pair, Pencil, UNCERTAIN};
use num_complex::Complex64;

/// Growth |Re λ|/|λ| of a conservative vibration that rounding makes.
const NOISE: f64 = 1e-7;
/// |Im λ|/|λ| below which an eigenvalue counts as real: √ε of a double one, and some.
const REAL: f64 = 1e-6;
/// |Im λ|/|Re λ| = π/(52 ln 2), ζ = 0.9962, up to which a motion with damping counts as overdamped: it has fallen to 2⁻⁵² before it is back for the first time.
const FADED: f64 = 0.087;
/// Relative difference of eigenvalues that count as one.
const EQUAL: f64 = 1e-6;

impl Pencil {
    /// At least `count` eigenpairs next to the shift (fewer if there are fewer), ascending in |λ|, Im λ ≥ 0. Of a real
    /// pair ±λ of a conservative pencil the growing one is given. With damping, real λ < 0 are not counted and given too, as far as they
    /// are nearer to the shift than the last that counts. `near` are approximate pairs, with which it begins: the Krylov space of a sum of
    /// eigenvectors is spanned by them. The pairs found are then counted, those of damped vibrations as if without their damping, and if the
    /// numbers differ they are looked for anew. What has faded before it has vibrated is real too.
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
            Kind::General => {
                let warm = (!near.is_empty() && self.can_count()).then(|| self.sum(near));
                let found = warm.and_then(|start| self.general(count, Some(&start)).ok());
                match found.filter(|found| self.counts(found)) {
                    Some(found) => found,
                    None => self.general(count, None)?,
                }
            }
        };
        let snaps = self.kind() == Kind::General && self.is_conservative();
        let mut pairs: Vec<Pair> =
            found.into_iter().map(|(value, vector)| self.purified(value, vector)).collect();
        let decays = |pair: &&mut Pair| decays(pair.value, self.is_conservative());
        pairs.iter_mut().filter(decays).for_each(|pair| pair.value.im = 0.0);
        for pair in pairs.iter_mut().filter(|pair| snaps && pair.value.im > 0.0) {
            // Where two frequencies meet, a relative error δ of K makes √δ of them.
            let noise = NOISE.max(2.0 * self.rounding(pair.value, &pair.vector).sqrt());
            if pair.value.re.abs() <= noise * pair.value.norm() {
                pair.value.re = 0.0;
            }
        }
        pairs.sort_by(|a, b| a.value.norm().total_cmp(&b.value.norm()));
        // Of vibrations that grow and decay with one frequency, in the flutter of a conservative system, the growing one is first.
        for i in 1..pairs.len() {
            let [a, b] = [pairs[i - 1].value, pairs[i].value];
            if (a - Complex64::new(-b.re, b.im)).norm() <= EQUAL * b.norm() && b.re > 0.0 && a.re < 0.0 {
                pairs.swap(i - 1, i);
            }
        }
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
            let counts = |theta: Complex64| projection == Projection::Symmetric || theta.im <= 0.0;
            let search =
                Search { wanted, counts: &counts, projection, tolerance: TOLERANCE, start, seed: round };
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
                found.push((value, ritz.space.vector(pair, n)));
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
        let limit = self.just_below(*last, x);
        // Divergent ones, ω² < 0, are below.
        let below = found.iter().filter(|(value, _)| value.im < limit).count();
        self.count_below(limit).is_none_or(|counted| counted <= below)
    }

    /// Whether the number of vibrations below the widest gap among the upper half of those found is that without damping.
    fn counts(&self, found: &[(Complex64, Vec<Complex64>)]) -> bool {
        let mut sizes: Vec<f64> = found.iter().map(|(value, _)| value.norm()).collect();
        sizes.sort_by(f64::total_cmp);
        let gaps = (sizes.len() / 2..sizes.len().saturating_sub(1)).map(|i| (i + 1, sizes[i], sizes[i + 1]));
        let widest = gaps.max_by(|a, b| (a.2 / a.1).total_cmp(&(b.2 / b.1)));
        widest.is_some_and(|(number, low, high)| self.count_undamped((low * high).sqrt()) == number)
    }

    fn general(
        &mut self,
        count: usize,
        start: Option<&[f64]>,
    ) -> Result<Vec<(Complex64, Vec<Complex64>)>, EigenError> {
        let (n, shift, conservative) = (self.order(), self.shift(), self.is_conservative());
        let value = |theta: Complex64| {
            let value = 1.0 / theta + shift;
            // Of a double real eigenvalue rounding makes a pair.
            if value.im.abs() <= REAL * value.norm() { value.re.into() } else { value }
        };
        let mut operator = General::new(self);
        let search = Search {
            wanted: count,
            counts: &|theta| theta.norm() > 0.0 && !decays(value(theta), conservative),
            projection: Projection::Hessenberg,
            tolerance: TOLERANCE,
            start,
            seed: 0,
        };
        let found = krylov(&mut operator, &Space::default(), search)?;
        // Overdamped motions, which come in clusters that do not converge, may leave fewer vibrations than are asked for.
        let fewer = found.others > 0 && !conservative && found.converged == found.counting;
        let wanted = if fewer { found.converged } else { count };
        let found = found.all(wanted)?;
        let mut number = 0;
        let mut pairs = Vec::with_capacity(found.pairs.len());
        for r in found.pairs.iter().filter(|r| r.value.norm() > 0.0) {
            let value = value(r.value);
            let vector = found.space.vector(r, n);
            if decays(value, conservative) {
                // The other of a pair ±λ, unless it is zero but for rounding.
                if conservative && self.rounding(value, &vector) < UNCERTAIN {
                    continue;
                }
            } else if number == wanted {
                break;
            } else {
                number += 1;
            }
            if value.im >= 0.0 {
                pairs.push((value, vector));
            }
        }
        Ok(pairs)
    }
}

/// Whether a motion decays without vibrating, or before it does. Without damping the other of two that flutter grows.
fn decays(value: Complex64, is_conservative: bool) -> bool {
    let faded = if is_conservative { 0.0 } else { FADED };
    value.re < 0.0 && value.im.abs() <= faded * value.re.abs()
}
