//! Dense matrix with LU by partial pivoting.

use super::{NOTHING, Scalar, Singular};

/// Dense square matrix, stored by rows; factored in place.
///
/// Unknowns at its end that couple to nothing, as the multipliers of contacts that are open, cost one division each.
#[derive(Clone, Debug)]
pub struct Dense<T> {
    n: usize,
    data: Vec<T>,
    pivots: Vec<usize>,
    /// Number of unknowns before those that couple to nothing, in a matrix that is factored.
    coupled: usize,
}

impl<T: Scalar> Dense<T> {
    /// The n × n zero matrix.
    pub fn new(n: usize) -> Dense<T> {
        Dense { n, data: vec![T::ZERO; n * n], pivots: vec![0; n], coupled: n }
    }

    /// Takes the content of another.
    pub(super) fn copy_from(&mut self, other: &Dense<T>) {
        self.n = other.n;
        self.data.clone_from(&other.data);
        self.pivots.clone_from(&other.pivots);
    }

    /// Takes the first rows and columns of another, so many.
    pub(super) fn copy_leading(&mut self, other: &Dense<T>, n: usize) {
        self.n = n;
        self.data.clear();
        let rows = other.data.chunks_exact(other.n.max(1)).take(n);
        rows.for_each(|row| self.data.extend_from_slice(&row[..n]));
        self.pivots.resize(n, 0);
    }

    /// Makes it the zero matrix of another order.
    pub(super) fn resize(&mut self, n: usize) {
        self.n = n;
        self.data.clear();
        self.data.resize(n * n, T::ZERO);
        self.pivots.resize(n, 0);
    }

    /// Order of the matrix.
    pub fn order(&self) -> usize {
        self.n
    }

    /// All entries by rows.
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// All entries by rows, to be changed.
    pub fn data_mut(&mut self) -> &mut [T] {
        &mut self.data
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.data.fill(T::ZERO);
    }

    /// Entry (i, j).
    #[inline]
    pub fn get(&self, i: usize, j: usize) -> T {
        self.data[i * self.n + j]
    }

    /// Sets entry (i, j).
    #[inline]
    pub fn set(&mut self, i: usize, j: usize, x: T) {
        self.data[i * self.n + j] = x;
    }

    /// Adds `x` to entry (i, j).
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, x: T) {
        self.data[i * self.n + j] += x;
    }

    /// Calls `f` with the place and the value of every entry.
    pub(super) fn each_mut(&mut self, mut f: impl FnMut(usize, usize, &mut T)) {
        let n = self.n.max(1);
        self.data.iter_mut().enumerate().for_each(|(k, x)| f(k / n, k % n, x));
    }

    /// y = A x, before factoring.
    pub fn multiply(&self, x: &[T], y: &mut [T]) {
        for (row, y) in self.data.chunks_exact(self.n.max(1)).zip(y) {
            let mut sum = T::ZERO;
            for (a, x) in row.iter().zip(x) {
                sum += *a * *x;
            }
            *y = sum;
        }
    }

    /// Number of unknowns before those at the end that couple to nothing.
    fn find_coupled(&self) -> usize {
        let mut coupled = 0;
        for (i, row) in self.data.chunks_exact(self.n.max(1)).enumerate() {
            let (before, behind) = row.split_at(i);
            if before.iter().any(|x| *x != T::ZERO) {
                coupled = i + 1;
            }
            let last = behind.iter().skip(1).rposition(|x| *x != T::ZERO);
            coupled = coupled.max(last.map_or(0, |last| i + last + 2));
        }
        coupled
    }

    /// LU factorisation in place with row interchanges.
    pub fn factor(&mut self) -> Result<(), Singular> {
        let n = self.n;
        self.coupled = self.find_coupled();
        let coupled = self.coupled;
        for k in 0..n {
            let mut p = k;
            let mut best = self.get(k, k).size();
            for i in k + 1..coupled {
                let size = self.get(i, k).size();
                if size > best {
                    (p, best) = (i, size);
                }
            }
            // A NaN pivot is refused too.
            if !(best > NOTHING) {
                let largest = self.data.iter().map(|x| x.size()).fold(0.0, f64::max);
                return Err(Singular { index: k, pivot: best / largest.max(NOTHING) });
            }
            self.pivots[k] = p;
            if k >= coupled {
                continue;
            }
            if p != k {
                let (head, tail) = self.data.split_at_mut(p * n);
                head[k * n..k * n + n].swap_with_slice(&mut tail[..n]);
            }
            let (head, tail) = self.data[..coupled * n].split_at_mut((k + 1) * n);
            let pivot_row = &head[k * n..k * n + coupled];
            let inverse = T::ONE / pivot_row[k];
            for row in tail.chunks_exact_mut(n) {
                let factor = row[k] * inverse;
                row[k] = factor;
                if factor != T::ZERO {
                    for (a, u) in row[k + 1..coupled].iter_mut().zip(&pivot_row[k + 1..]) {
                        *a -= factor * *u;
                    }
                }
            }
        }
        Ok(())
    }

    /// Solves A x = b in place after [`Dense::factor`].
    pub fn solve(&self, b: &mut [T]) {
        let (n, coupled) = (self.n, self.coupled);
        for k in 0..coupled {
            b.swap(k, self.pivots[k]);
        }
        for i in 0..coupled {
            let mut sum = b[i];
            for j in 0..i {
                sum -= self.data[i * n + j] * b[j];
            }
            b[i] = sum;
        }
        for i in coupled..n {
            b[i] = b[i] / self.data[i * n + i];
        }
        for i in (0..coupled).rev() {
            let mut sum = b[i];
            for j in i + 1..coupled {
                sum -= self.data[i * n + j] * b[j];
            }
            b[i] = sum / self.data[i * n + i];
        }
    }
}
