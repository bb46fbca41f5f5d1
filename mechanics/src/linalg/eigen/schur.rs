//! The Schur form H = Q T Qᴴ of a Hessenberg matrix, T upper triangular.
//!
//! Real QR iterations with two shifts at a time split H into blocks of order one and two; rotations make the blocks of order two triangular.
//! An iteration that does not split takes other shifts now and then, and at last drops what is rounding of the whole matrix.
//!
//! Sources: the steps are those of `dlahqr` of LAPACK 3.10; M. Ahues & F. Tisseur, *LAPACK Working Note* 122, 1997 (when an entry below the
//! diagonal is dropped).

use num_complex::Complex64;

/// Iterations without a split after which other shifts are taken.
const EXCEPTIONAL: usize = 10;
/// Iterations without a split from which on an entry is dropped that is rounding of the whole matrix.
const STUBBORN: usize = 40;
/// Iterations for each eigenvalue on average.
const ITERATIONS: usize = 100;

/// A square matrix, column by column.
#[derive(Clone, Debug)]
pub(super) struct Square<T> {
    order: usize,
    entries: Vec<T>,
}

impl<T: Copy + Default> Square<T> {
    pub(super) fn zeros(order: usize) -> Square<T> {
        Square { order, entries: vec![T::default(); order * order] }
    }

    pub(super) fn order(&self) -> usize {
        self.order
    }

    pub(super) fn at(&self, i: usize, j: usize) -> T {
        self.entries[i + j * self.order]
    }

    pub(super) fn set(&mut self, i: usize, j: usize, x: T) {
        self.entries[i + j * self.order] = x;
    }

    pub(super) fn column(&self, j: usize) -> &[T] {
        &self.entries[j * self.order..(j + 1) * self.order]
    }

    /// The first `rows` entries of N columns from the column `j` on.
    fn columns<const N: usize>(&mut self, j: usize, rows: usize) -> [&mut [T]; N] {
        let mut rest = &mut self.entries[j * self.order..];
        std::array::from_fn(|_| {
            let (column, others) = std::mem::take(&mut rest).split_at_mut(self.order);
            rest = others;
            &mut column[..rows]
        })
    }
}

/// I − τ v vᵀ with v₀ = 1.
struct Reflection<const N: usize> {
    v: [f64; N],
    tau: f64,
}

impl<const N: usize> Reflection<N> {
    /// The one that turns x into β e₀, and β.
    fn of(x: [f64; N]) -> (Reflection<N>, f64) {
        let largest = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        if x[1..].iter().all(|x| *x == 0.0) {
            return (Reflection { v: [0.0; N], tau: 0.0 }, x[0]);
        }
        let norm = largest * x.iter().map(|x| (x / largest) * (x / largest)).sum::<f64>().sqrt();
        let beta = -norm.copysign(x[0]);
        let mut v = x.map(|of| of / (x[0] - beta));
        v[0] = 1.0;
        (Reflection { v, tau: (beta - x[0]) / beta }, beta)
    }

    /// Reflects the rows from k on of the columns `of`.
    fn reflect_rows(&self, h: &mut Square<f64>, k: usize, of: std::ops::Range<usize>) {
        for column in h.entries.chunks_exact_mut(h.order).take(of.end).skip(of.start) {
            let Some(x) = column.get_mut(k..k + N) else { continue };
            let along = self.tau * x.iter().zip(&self.v).map(|(x, v)| x * v).sum::<f64>();
            x.iter_mut().zip(&self.v).for_each(|(x, v)| *x -= along * v);
        }
    }

    /// Reflects the columns from k on, in the first rows.
    fn reflect_columns(&self, h: &mut Square<f64>, k: usize, rows: usize) {
        let mut columns: [&mut [f64]; N] = h.columns(k, rows);
        for i in 0..rows {
            let along = self.tau * (0..N).map(|c| columns[c][i] * self.v[c]).sum::<f64>();
            (0..N).for_each(|c| columns[c][i] -= along * self.v[c]);
        }
    }
}

/// The two shifts of an iteration.
type Shifts = [Complex64; 2];

/// The eigenvalues of [a b; c d] as shifts: of two real ones that next to d, twice.
fn shifts([a, b, c, d]: [f64; 4]) -> Shifts {
    let size = a.abs() + b.abs() + c.abs() + d.abs();
    if size == 0.0 {
        return [Complex64::ZERO; 2];
    }
    let [a, b, c, d] = [a, b, c, d].map(|x| x / size);
    let middle = 0.5 * (a + d);
    let product = (a - middle) * (d - middle) - b * c;
    let root = product.abs().sqrt();
    if product >= 0.0 {
        [root, -root].map(|im| size * Complex64::new(middle, im))
    } else {
        let near = if (middle + root - d).abs() <= (middle - root - d).abs() { root } else { -root };
        [(size * (middle + near)).into(); 2]
    }
}

/// H on its way to T, with Q.
struct Iteration {
    h: Square<f64>,
    q: Square<f64>,
    /// The largest entry of H.
    size: f64,
}

impl Iteration {
    /// Whether the entry below the diagonal in row k is rounding.
    fn is_small(&self, k: usize, end: usize, is_stubborn: bool) -> bool {
        let at = |i: usize, j: usize| self.h.at(i, j).abs();
        let below = at(k, k - 1);
        let tiny = f64::MIN_POSITIVE * (self.h.order as f64 / f64::EPSILON);
        if below <= tiny || is_stubborn && below <= f64::EPSILON * self.size {
            return true;
        }
        let mut near = at(k - 1, k - 1) + at(k, k);
        if near == 0.0 {
            near = if k >= 2 { at(k - 1, k - 2) } else { 0.0 } + if k < end { at(k + 1, k) } else { 0.0 };
        }
        if below > f64::EPSILON * near {
            return false;
        }
        let (high, low) = (below.max(at(k - 1, k)), below.min(at(k - 1, k)));
        let gap = (self.h.at(k - 1, k - 1) - self.h.at(k, k)).abs();
        let (large, small) = (at(k, k).max(gap), at(k, k).min(gap));
        let sum = large + high;
        low * (high / sum) <= tiny.max(f64::EPSILON * (small * (large / sum)))
    }

    /// The shifts for the rows from `start` to `end` after so many iterations without a split.
    fn shifts(&self, start: usize, end: usize, iterations: usize) -> Shifts {
        let h = |i: usize, j: usize| self.h.at(i, j);
        let other = |size: f64, x: f64| {
            let a = 0.75 * size + x;
            shifts([a, -0.4375 * size, size, a])
        };
        if iterations.is_multiple_of(2 * EXCEPTIONAL) {
            other(h(end, end - 1).abs() + h(end - 1, end - 2).abs(), h(end, end))
        } else if iterations.is_multiple_of(EXCEPTIONAL) {
            other(h(start + 1, start).abs() + h(start + 2, start + 1).abs(), h(start, start))
        } else {
            shifts([h(end - 1, end - 1), h(end - 1, end), h(end, end - 1), h(end, end)])
        }
    }

    /// The row in which a sweep may begin, and the first column of (H − s₁)(H − s₂) from there on, of any size.
    fn beginning(&self, start: usize, end: usize, [first, second]: Shifts) -> (usize, [f64; 3]) {
        let h = |i: usize, j: usize| self.h.at(i, j);
        let mut m = end - 2;
        loop {
            let size = (h(m, m) - second.re).abs() + second.im.abs() + h(m + 1, m).abs();
            let below = h(m + 1, m) / size;
            let v = [
                below * h(m, m + 1) + (h(m, m) - first.re) * ((h(m, m) - second.re) / size)
                    - first.im * (second.im / size),
                below * (h(m, m) + h(m + 1, m + 1) - first.re - second.re),
                below * h(m + 2, m + 1),
            ];
            let size: f64 = v.iter().map(|x| x.abs()).sum();
            let v = if size > 0.0 { v.map(|x| x / size) } else { v };
            if m == start {
                return (m, v);
            }
            let near = h(m - 1, m - 1).abs() + h(m, m).abs() + h(m + 1, m + 1).abs();
            if h(m, m - 1).abs() * (v[1].abs() + v[2].abs()) <= f64::EPSILON * v[0].abs() * near {
                return (m, v);
            }
            m -= 1;
        }
    }

    /// One iteration on the rows from `start` to `end`, which are three at least.
    fn sweep(&mut self, start: usize, end: usize, shifts: Shifts) {
        let n = self.h.order;
        let (first, mut v) = self.beginning(start, end, shifts);
        for k in first..end - 1 {
            if k > first {
                v = [0, 1, 2].map(|i| self.h.at(k + i, k - 1));
            }
            let (reflection, beta) = Reflection::of(v);
            if k > first {
                self.h.set(k, k - 1, beta);
                (1..3).for_each(|i| self.h.set(k + i, k - 1, 0.0));
            } else if k > start {
                self.h.set(k, k - 1, self.h.at(k, k - 1) * (1.0 - reflection.tau));
            }
            reflection.reflect_rows(&mut self.h, k, k..n);
            reflection.reflect_columns(&mut self.h, k, (k + 3).min(end) + 1);
            reflection.reflect_columns(&mut self.q, k, n);
        }
        let k = end - 1;
        let (reflection, beta) = Reflection::of([0, 1].map(|i| self.h.at(k + i, k - 1)));
        self.h.set(k, k - 1, beta);
        self.h.set(end, k - 1, 0.0);
        reflection.reflect_rows(&mut self.h, k, k..n);
        reflection.reflect_columns(&mut self.h, k, end + 1);
        reflection.reflect_columns(&mut self.q, k, n);
    }

    /// Splits H into blocks of order one and two; `false` where it takes too many iterations.
    fn split(&mut self) -> bool {
        let n = self.h.order;
        let (mut end, mut iterations, mut all) = (n, 0, 0);
        while end > 1 {
            let last = end - 1;
            let is_stubborn = iterations >= STUBBORN;
            let start = (1..end).rev().find(|k| self.is_small(*k, last, is_stubborn)).unwrap_or(0);
            if start > 0 {
                self.h.set(start, start - 1, 0.0);
            }
            if start + 1 >= last {
                (end, iterations) = (start, 0);
                continue;
            }
            (iterations, all) = (iterations + 1, all + 1);
            if all > ITERATIONS * n {
                return false;
            }
            let shifts = self.shifts(start, last, iterations);
            self.sweep(start, last, shifts);
        }
        true
    }
}

/// Q and T.
#[derive(Debug)]
pub(super) struct Schur {
    pub q: Square<Complex64>,
    pub t: Square<Complex64>,
}

impl Schur {
    /// That of a Hessenberg matrix of finite numbers; `None` where the iteration does not end.
    pub(super) fn of(h: Square<f64>) -> Option<Schur> {
        let n = h.order;
        let mut q = Square::zeros(n);
        (0..n).for_each(|i| q.set(i, i, 1.0));
        let size = h.entries.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let mut iteration = Iteration { h, q, size };
        if !iteration.split() {
            return None;
        }
        let Iteration { h, q, .. } = iteration;
        let complex = |of: Square<f64>| Square {
            order: n,
            entries: of.entries.into_iter().map(Complex64::from).collect(),
        };
        let mut schur = Schur { q: complex(q), t: complex(h) };
        (1..n)
            .filter(|k| schur.t.at(*k, k - 1) != Complex64::ZERO)
            .collect::<Vec<_>>()
            .into_iter()
            .for_each(|k| schur.triangulate(k));
        Some(schur)
    }

    /// Makes the block of the rows k − 1 and k triangular by a rotation.
    fn triangulate(&mut self, k: usize) {
        let n = self.t.order;
        let [a, b, c, d] = [(k - 1, k - 1), (k - 1, k), (k, k - 1), (k, k)].map(|(i, j)| self.t.at(i, j).re);
        // The difference of both eigenvalues from d, without cancellation.
        let half = 0.5 * (a - d);
        let product = half * half + b * c;
        let root = product.abs().sqrt();
        let (first, second) = if product >= 0.0 {
            let far = half + root.copysign(half);
            let near = if far == 0.0 { 0.0 } else { -b * c / far };
            (Complex64::from(far), Complex64::from(near))
        } else {
            (Complex64::new(half, root), Complex64::new(half, -root))
        };
        // An eigenvector of the first is (d + first − d, c).
        let size = libm::hypot(first.norm(), c);
        let (cosine, sine) = (first / size, c / size);
        for column in self.t.entries.chunks_exact_mut(n).skip(k - 1) {
            let [x, y] = [column[k - 1], column[k]];
            column[k - 1] = cosine.conj() * x + sine * y;
            column[k] = cosine * y - sine * x;
        }
        for (of, rows) in [(&mut self.t, k + 1), (&mut self.q, n)] {
            let [left, right]: [&mut [Complex64]; 2] = of.columns(k - 1, rows);
            for (x, y) in left.iter_mut().zip(right) {
                (*x, *y) = (cosine * *x + sine * *y, cosine.conj() * *y - sine * *x);
            }
        }
        self.t.set(k, k - 1, Complex64::ZERO);
        self.t.set(k - 1, k - 1, d + first);
        self.t.set(k, k, d + second);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    /// Q T Qᴴ = H, Qᴴ Q = 1.
    fn check(h: &Square<f64>) -> Schur {
        let n = h.order;
        let schur = Schur::of(h.clone()).unwrap();
        let of = |a: &Square<Complex64>| DMatrix::from_fn(n, n, |i, j| a.at(i, j));
        let (q, t) = (of(&schur.q), of(&schur.t));
        let original = DMatrix::from_fn(n, n, |i, j| Complex64::from(h.at(i, j)));
        let size = original.norm();
        assert!((&q * &t * q.adjoint() - original).norm() <= 1e-14 * n as f64 * size);
        assert!((q.adjoint() * &q - DMatrix::identity(n, n)).norm() < 1e-14 * n as f64);
        assert!((0..n).all(|j| (j + 1..n).all(|i| t[(i, j)] == Complex64::ZERO)));
        schur
    }

    #[test]
    fn a_matrix_is_that_of_its_schur_form() {
        for n in [1, 2, 3, 4, 5, 17, 60] {
            for seed in 1..6 {
                let noise = crate::linalg::vector::noise(n * n, seed);
                let mut h = Square::zeros(n);
                (0..n).for_each(|j| (0..(j + 2).min(n)).for_each(|i| h.set(i, j, noise[i + n * j])));
                check(&h);
            }
        }
    }

    /// The eigenvalues are the roots of one, on which steps without other shifts make no progress.
    #[test]
    fn a_cyclic_matrix_has_the_roots_of_one() {
        let n = 12;
        let mut h = Square::zeros(n);
        (1..n).for_each(|i| h.set(i, i - 1, 1.0));
        h.set(0, n - 1, 1.0);
        let t = check(&h).t;
        for k in 0..n {
            let root = Complex64::cis(std::f64::consts::TAU * k as f64 / n as f64);
            assert!((0..n).any(|i| (t.at(i, i) - root).norm() < 1e-14 * n as f64), "{root}");
        }
    }

    #[test]
    fn graded_and_split_matrices_have_their_schur_form() {
        let n = 30;
        let noise = crate::linalg::vector::noise(n * n, 3);
        for power in [1, 4, 10, 30] {
            let mut h = Square::zeros(n);
            for j in 0..n {
                for i in 0..(j + 2).min(n) {
                    h.set(i, j, noise[i + n * j] * libm::pow(0.1, f64::from(power) * (i.max(j) / 3) as f64));
                }
            }
            check(&h);
            h.set(10, 9, 0.0);
            check(&h);
        }
        check(&Square::zeros(5));
    }
}
