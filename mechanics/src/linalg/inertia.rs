//! Inertia (number of negative eigenvalues) of a Hermitian matrix by Sylvester's law.
//!
//! A = L D Lᴴ with D of diagonal blocks has as many negative eigenvalues as D. A pivot is a block of the next unknowns, one
//! where it can be, more where it is too small: an unknown without stiffness, or a multiplier, whose diagonal is zero, is
//! eliminated together with what it is coupled with. Blocks of consecutive unknowns leave the band as it is.

use super::equilibration::Equilibration;
use super::{Matrix, Scalar, Storage};
use nalgebra::{ComplexField, DMatrix};

/// Largest growth of a diagonal entry, over the largest entry of its row, by which a pivot is taken.
const GROWTH: f64 = 1e4;

/// Number of negative eigenvalues of the symmetric matrix A + w B (equal structures): O(n·b²) for half-bandwidth b.
pub fn negative_pivots(a: &Matrix, b: &Matrix, w: f64) -> usize {
    negative_pivots_of(shape(a), |i, j| a.storage().get(i, j) + w * b.storage().get(i, j))
}

/// Order, half-bandwidth and border of a matrix, in the order of its places.
pub(super) fn shape(matrix: &Matrix) -> [usize; 3] {
    match matrix.storage() {
        Storage::Dense(a) => [a.order(), a.order().saturating_sub(1), 0],
        Storage::Band(a) => [a.order(), a.band().upper().max(a.band().lower()), a.order() - a.band().order()],
    }
}

/// Number of negative eigenvalues of a Hermitian matrix with the entries `entry(i, j)`, j ≥ i: its order, its half-bandwidth
/// and the number of dense rows and columns behind the band are given.
///
/// The matrix is brought into other units of its unknowns (`Equilibration`), which leave the number: those of a multiplier, a force over
/// the reach of a row, would otherwise let a pivot pass that is small against the stiffness around it.
pub fn negative_pivots_of<T>(shape: [usize; 3], entry: impl Fn(usize, usize) -> T) -> usize
where
    T: Scalar + ComplexField<RealField = f64>,
{
    let mut rows = Rows::new(shape, entry);
    rows.scale();
    rows.measure();
    rows.eliminate()
}

/// A block D of unknowns, and what its elimination does to those behind it that it is coupled with.
struct Pivot<T: Scalar> {
    size: usize,
    negative: usize,
    growth: f64,
    /// B, the couplings, and D⁻¹ B.
    coupling: DMatrix<T>,
    solved: DMatrix<T>,
}

/// The rows of the upper triangle, of which those before the next pivot have been eliminated.
struct Rows<T: Scalar> {
    band: usize,
    half: usize,
    border: usize,
    /// Rows of the band from the diagonal on and, behind their band, in the columns of the border.
    data: Vec<T>,
    /// Largest entry of each row of the matrix.
    sizes: Vec<f64>,
    corner: DMatrix<T>,
}

impl<T: Scalar + ComplexField<RealField = f64>> Rows<T> {
    fn new([n, half, border]: [usize; 3], entry: impl Fn(usize, usize) -> T) -> Rows<T> {
        let band = n - border;
        let mut data = Vec::with_capacity(band * (half + 1 + border));
        for i in 0..band {
            let end = (i + half + 1).min(band);
            data.extend((i..end).map(|j| entry(i, j)));
            data.resize(data.len() + i + half + 1 - end, T::ZERO);
            data.extend((band..n).map(|j| entry(i, j)));
        }
        let corner = DMatrix::from_fn(border, border, |i, j| {
            let x = entry(band + i.min(j), band + i.max(j));
            if i <= j { x } else { Scalar::conj(x) }
        });
        Rows { band, half, border, data, sizes: Vec::new(), corner }
    }

    fn width(&self) -> usize {
        self.half + 1 + self.border
    }

    fn row(&self, i: usize) -> &[T] {
        &self.data[i * self.width()..][..self.width()]
    }

    /// Unknowns of the entries of a row of the band, within it and in the border.
    fn unknowns(&self, i: usize) -> [std::ops::Range<usize>; 2] {
        [i..(i + self.half + 1).min(self.band), self.band..self.band + self.border]
    }

    /// Calls `f` with the places and the size of every entry.
    fn each(&self, f: &mut dyn FnMut(usize, usize, f64)) {
        for i in 0..self.band {
            let (row, [within, behind]) = (self.row(i), self.unknowns(i));
            let (near, far) = (&row[..within.len()], &row[self.half + 1..]);
            within.zip(near).chain(behind.zip(far)).for_each(|(j, x)| f(i, j, x.size()));
        }
        for i in 0..self.border {
            (0..self.border).for_each(|j| f(self.band + i, self.band + j, self.corner[(i, j)].size()));
        }
    }

    fn measure(&mut self) {
        let mut sizes = vec![0.0_f64; self.band + self.border];
        self.each(&mut |i, j, size| {
            sizes[i] = sizes[i].max(size);
            sizes[j] = sizes[j].max(size);
        });
        self.sizes = sizes;
    }

    /// Replaces A by S A S.
    fn scale(&mut self) {
        let mut units = Equilibration::default();
        units.find(self.band + self.border, |measure| self.each(measure));
        let (s, width) = (units.scales(), self.width());
        for i in 0..self.band {
            let [within, behind] = self.unknowns(i);
            let (near, far) = self.data[i * width..(i + 1) * width].split_at_mut(self.half + 1);
            for (j, x) in within.zip(near).chain(behind.zip(far)) {
                *x = x.times(s[i] * s[j]);
            }
        }
        for i in 0..self.border {
            for j in 0..self.border {
                self.corner[(i, j)] = self.corner[(i, j)].times(s[self.band + i] * s[self.band + j]);
            }
        }
    }

    fn eliminate(mut self) -> usize {
        let (mut k, mut count) = (0, 0);
        let mut solved = Vec::with_capacity(self.width());
        while k < self.band {
            if let Some(negative) = self.eliminate_one(k, &mut solved) {
                count += usize::from(negative);
                k += 1;
                continue;
            }
            let mut best: Option<Pivot<T>> = None;
            for size in 1..=(self.half + 1).min(self.band - k) {
                let pivot = self.pivot(k, size);
                let good = pivot.growth <= GROWTH;
                if good || best.as_ref().is_none_or(|best| pivot.growth < best.growth) {
                    best = Some(pivot);
                }
                if good {
                    break;
                }
            }
            let Some(pivot) = best else { break };
            self.subtract(k, &pivot);
            count += pivot.negative;
            k += pivot.size;
        }
        if self.border > 0 {
            count += self.corner.symmetric_eigen().eigenvalues.iter().filter(|x| **x < 0.0).count();
        }
        count
    }

    /// Eliminates one unknown of a matrix without border, if its pivot is large enough: whether it is negative.
    fn eliminate_one(&mut self, k: usize, solved: &mut Vec<T>) -> Option<bool> {
        let (width, reach) = (self.width(), self.reach(k + 1));
        let (head, behind) = self.data.split_at_mut((k + 1) * width);
        let row = &head[k * width..][..reach + 1];
        let d = row[0].re();
        if self.border > 0 || d == 0.0 {
            return None;
        }
        let (coupling, inverse) = (&row[1..], 1.0 / d);
        solved.clear();
        solved.extend(coupling.iter().map(|b| b.times(inverse)));
        let changes = coupling.iter().zip(&*solved).map(|(b, x)| b.size() * x.size());
        if !changes.zip(&self.sizes[k + 1..]).all(|(change, size)| change <= GROWTH * size) {
            return None;
        }
        for (i, (row, b)) in behind.chunks_exact_mut(width).zip(coupling).enumerate() {
            if *b != T::ZERO {
                let b = Scalar::conj(*b);
                row.iter_mut().zip(&solved[i..]).for_each(|(x, y)| *x -= b * *y);
            }
        }
        Some(d < 0.0)
    }

    /// The unknowns behind a block that it may be coupled with: those of the band, and behind them the border.
    fn reach(&self, end: usize) -> usize {
        (end + self.half).min(self.band) - end
    }

    /// Entry of row i with neighbour number `j` of a block that ends at `end`.
    fn coupled(&self, i: usize, end: usize, j: usize) -> T {
        let row = self.row(i);
        match j.checked_sub(self.reach(end)) {
            Some(b) => row[self.half + 1 + b],
            None if end + j - i <= self.half => row[end + j - i],
            None => T::ZERO,
        }
    }

    fn pivot(&self, k: usize, size: usize) -> Pivot<T> {
        let end = k + size;
        let others = self.reach(end) + self.border;
        let coupling = DMatrix::from_fn(size, others, |i, j| self.coupled(k + i, end, j));
        // An eigenvalue that vanishes is counted as positive and kept from dividing.
        let inverse = |x: f64| 1.0 / if x == 0.0 { f64::MIN_POSITIVE.sqrt() } else { x };
        // What a pivot changes is Bᴴ D⁻¹ B, whose entries are at most √(c_i c_j) with c_j = b_jᴴ |D|⁻¹ b_j.
        let (negative, solved, changes): (usize, DMatrix<T>, Vec<f64>) = if size == 1 {
            let d = self.row(k)[0].re();
            let solved = coupling.map(|b| b.times(inverse(d)));
            let changes = coupling.iter().zip(&solved).map(|(b, x)| b.size() * x.size()).collect();
            (usize::from(d < 0.0), solved, changes)
        } else {
            let block = DMatrix::from_fn(size, size, |i, j| {
                let x = self.row(k + i.min(j))[i.abs_diff(j).min(self.half)];
                if i <= j { x } else { Scalar::conj(x) }
            });
            let parts = block.symmetric_eigen();
            let mut scaled = parts.eigenvectors.ad_mul(&coupling);
            let mut changes = vec![0.0; others];
            for (mut row, x) in scaled.row_iter_mut().zip(parts.eigenvalues.iter()) {
                for (b, change) in row.iter_mut().zip(&mut changes) {
                    let by = b.times(inverse(*x));
                    *change += b.size() * by.size();
                    *b = by;
                }
            }
            let negative = parts.eigenvalues.iter().filter(|x| **x < 0.0).count();
            (negative, parts.eigenvectors * scaled, changes)
        };
        let reach = others - self.border;
        let growth = changes.iter().enumerate().map(|(j, change)| {
            let largest = self.sizes[if j < reach { end + j } else { self.band + j - reach }];
            if *change == 0.0 { 0.0 } else { change / largest }
        });
        let growth = growth.fold(0.0, |worst: f64, x| if x <= worst { worst } else { x });
        Pivot { size, negative, growth, coupling, solved }
    }

    /// Subtracts Bᴴ D⁻¹ B from what is behind a block.
    fn subtract(&mut self, k: usize, pivot: &Pivot<T>) {
        let (end, width) = (k + pivot.size, self.width());
        let reach = self.reach(end);
        for j in 0..reach + self.border {
            for i in 0..=j {
                let mut x = T::ZERO;
                for l in 0..pivot.size {
                    x += Scalar::conj(pivot.coupling[(l, i)]) * pivot.solved[(l, j)];
                }
                if i >= reach {
                    self.corner[(i - reach, j - reach)] -= x;
                    if i != j {
                        self.corner[(j - reach, i - reach)] -= Scalar::conj(x);
                    }
                } else {
                    let at = if j >= reach { self.half + 1 + j - reach } else { j - i };
                    self.data[(end + i) * width + at] -= x;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::vector::noise;
    use num_complex::Complex64;

    /// Two places without stiffness, held by a row each: elimination leaves d = 0 but for rounding, as alike for both as it is coupled,
    /// and no pivot of theirs is one without the rows.
    #[test]
    fn rounding_between_unknowns_without_stiffness_is_no_pivot() {
        for y in [1e-41, 1e-17, 1e-8] {
            let a = DMatrix::from_row_slice(
                4,
                4,
                &[
                    0.0, y, 1.0, 0.0, //
                    y, 0.0, 0.0, 1.0, //
                    1.0, 0.0, 0.0, 0.0, //
                    0.0, 1.0, 0.0, 0.0,
                ],
            );
            // Behind the rows a spring that hangs on them.
            let entry = |i: usize, j: usize| match (i, j) {
                (4, 4) => 0.5,
                (2 | 3, 4) => 1e-9,
                (_, 4) => 0.0,
                _ => a[(i, j)],
            };
            assert_eq!(negative_pivots_of([5, 4, 0], entry), 2, "y = {y}");
        }
    }

    /// Saddle points with unknowns without stiffness, in the band and in the border, against all eigenvalues.
    #[test]
    fn it_is_that_of_the_eigenvalues() {
        for seed in 0..60 {
            let (n, half, border) = (24, 5, (seed % 4) as usize);
            let random = noise(2 * n * n, seed + 1);
            let band = n - border;
            let multiplier = |i: usize| seed % 3 > 0 && i % 4 == 3 || i >= band && seed % 2 == 1;
            let free = |i: usize| seed % 5 > 2 && i % 8 < 2;
            let entry = |i: usize, j: usize| {
                let none = multiplier(i) && multiplier(j) || free(i) && free(j) || j < band && j - i > half;
                let im = if i == j { 0.0 } else { random[n * n + i * n + j] };
                if none { Complex64::ZERO } else { Complex64::new(random[i * n + j], im) }
            };
            let real = |i: usize, j: usize| entry(i, j).re;
            let full = DMatrix::from_fn(n, n, |i, j| {
                let x = entry(i.min(j), i.max(j));
                if i <= j { x } else { x.conj() }
            });
            let count = |x: &nalgebra::DVector<f64>| x.iter().filter(|x| **x < 0.0).count();
            let expected = count(&full.clone().symmetric_eigen().eigenvalues);
            assert_eq!(negative_pivots_of([n, half, border], entry), expected, "complex, seed {seed}");
            let expected = count(&full.map(|x| x.re).symmetric_eigen().eigenvalues);
            assert_eq!(negative_pivots_of([n, half, border], real), expected, "real, seed {seed}");
            if seed % 3 > 0 {
                // The same in other units.
                let unit = |i: usize| libm::pow(10.0, 6.0 * random[i]);
                let scaled = |i: usize, j: usize| real(i, j) * unit(i) * unit(j);
                assert_eq!(negative_pivots_of([n, half, border], scaled), expected, "units, seed {seed}");
            }
        }
    }
}
