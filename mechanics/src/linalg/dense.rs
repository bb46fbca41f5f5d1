//! Dense matrix with LU by partial pivoting.

use super::{NOTHING, Scalar, Singular};

/// Dense square matrix, stored by rows; factored in place.
#[derive(Clone, Debug)]
pub struct Dense<T> {
    n: usize,
    data: Vec<T>,
    pivots: Vec<usize>,
}

impl<T: Scalar> Dense<T> {
    /// The n × n zero matrix.
    pub fn new(n: usize) -> Dense<T> {
        Dense { n, data: vec![T::ZERO; n * n], pivots: vec![0; n] }
    }

    /// Takes the content of another.
    pub(super) fn copy_from(&mut self, other: &Dense<T>) {
        self.n = other.n;
        self.data.clone_from(&other.data);
        self.pivots.clone_from(&other.pivots);
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

    /// LU factorisation in place with row interchanges.
    pub fn factor(&mut self) -> Result<(), Singular> {
        let n = self.n;
        for k in 0..n {
            let mut p = k;
            let mut best = self.get(k, k).size();
            for i in k + 1..n {
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
            if p != k {
                let (head, tail) = self.data.split_at_mut(p * n);
                head[k * n..k * n + n].swap_with_slice(&mut tail[..n]);
            }
            let (head, tail) = self.data.split_at_mut((k + 1) * n);
            let pivot_row = &head[k * n..];
            let inverse = T::ONE / pivot_row[k];
            for row in tail.chunks_exact_mut(n) {
                let factor = row[k] * inverse;
                row[k] = factor;
                if factor != T::ZERO {
                    for (a, u) in row[k + 1..].iter_mut().zip(&pivot_row[k + 1..]) {
                        *a -= factor * *u;
                    }
                }
            }
        }
        Ok(())
    }

    /// Solves A x = b in place after [`Dense::factor`].
    pub fn solve(&self, b: &mut [T]) {
        let n = self.n;
        for k in 0..n {
            b.swap(k, self.pivots[k]);
        }
        for i in 0..n {
            let mut sum = b[i];
            for j in 0..i {
                sum -= self.data[i * n + j] * b[j];
            }
            b[i] = sum;
        }
        for i in (0..n).rev() {
            let mut sum = b[i];
            for j in i + 1..n {
                sum -= self.data[i * n + j] * b[j];
            }
            b[i] = sum / self.data[i * n + i];
        }
    }
}
