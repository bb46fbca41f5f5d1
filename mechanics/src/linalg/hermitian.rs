//! Hermitian band matrix A + iB, A symmetric and B antisymmetric, as L D Lᴴ without interchanges.
//!
//! The upper triangle is kept by rows, real and imaginary parts apart, so that elimination runs along contiguous
//! numbers: n·b² complex multiplications for half-bandwidth b. Without interchanges the pivots D give the inertia
//! (Sylvester). The factors of an indefinite matrix can be inaccurate: whoever solves with them checks the solution.

use super::Band;

/// A Hermitian band matrix, factored in place.
#[derive(Clone, Debug)]
pub struct Hermitian {
    n: usize,
    half: usize,
    /// Entries (k, k + r) at k (half + 1) + r; rows of Lᴴ after factoring, with 1/D on the diagonal.
    re: Vec<f64>,
    im: Vec<f64>,
    is_real: bool,
}

impl Hermitian {
    /// The zero matrix of order `n` and half-bandwidth `half`.
    pub fn new(n: usize, half: usize) -> Hermitian {
        let entries = n * (half + 1);
        Hermitian { n, half, re: vec![0.0; entries], im: vec![0.0; entries], is_real: true }
    }

    /// Becomes a + w b + i c d, of symmetric `a` and `b` and antisymmetric `d`; where c = 0 real.
    pub fn assign(&mut self, a: &Band<f64>, (w, b): (f64, &Band<f64>), (c, d): (f64, &Band<f64>)) {
        let width = self.half + 1;
        self.is_real = c == 0.0;
        // Rows of a band begin `lower` columns left of the diagonal.
        let upper = |band: &Band<f64>, k: usize| {
            let at = k * band.width() + band.lower();
            at..at + width.min(self.n - k)
        };
        for k in 0..self.n {
            let of = [&a.data()[upper(a, k)], &b.data()[upper(b, k)]];
            let row = &mut self.re[k * width..(k + 1) * width];
            for ((x, a), b) in row.iter_mut().zip(of[0]).zip(of[1]) {
                *x = a + w * b;
            }
            if !self.is_real {
                let row = &mut self.im[k * width..(k + 1) * width];
                for (x, d) in row.iter_mut().zip(&d.data()[upper(d, k)]) {
                    *x = c * d;
                }
                self.im[k * width] = 0.0;
            }
        }
    }

    /// Factors in place; the number of negative eigenvalues, or `None` where a number is not finite.
    pub fn factor(&mut self) -> Option<usize> {
        let (n, width) = (self.n, self.half + 1);
        let mut negative = 0;
        for k in 0..n {
            let reach = self.half.min(n - 1 - k);
            let (row, below) = self.re[k * width..].split_at_mut(width);
            // An exactly vanishing pivot is counted as positive and kept from dividing.
            let pivot = if row[0] == 0.0 { f64::MIN_POSITIVE.sqrt() } else { row[0] };
            if !pivot.is_finite() {
                return None;
            }
            negative += usize::from(pivot < 0.0);
            let inverse = 1.0 / pivot;
            row[0] = inverse;
            if self.is_real {
                for r in 1..=reach {
                    let factor = row[r] * inverse;
                    let to = &mut below[(r - 1) * width..(r - 1) * width + width - r];
                    for (x, u) in to.iter_mut().zip(&row[r..]) {
                        *x -= factor * u;
                    }
                }
                row[1..].iter_mut().for_each(|u| *u *= inverse);
                continue;
            }
            let (row_im, below_im) = self.im[k * width..].split_at_mut(width);
            for r in 1..=reach {
                // The conjugate of an entry of the pivot's row, over the pivot.
                let (f, g) = (row[r] * inverse, -row_im[r] * inverse);
                let to = (r - 1) * width..(r - 1) * width + width - r;
                let (to_re, to_im) = (&mut below[to.clone()], &mut below_im[to]);
                for (((x, y), u), v) in to_re.iter_mut().zip(to_im).zip(&row[r..]).zip(&row_im[r..]) {
                    *x -= f * u - g * v;
                    *y -= f * v + g * u;
                }
            }
            row[1..].iter_mut().for_each(|u| *u *= inverse);
            row_im[1..].iter_mut().for_each(|u| *u *= inverse);
        }
        Some(negative)
    }

    /// Solves for the right-hand side x + iy in place, after [`Hermitian::factor`].
    pub fn solve(&self, x: &mut [f64], y: &mut [f64]) {
        if self.is_real {
            self.solve_real(x);
            self.solve_real(y);
            return;
        }
        let (n, width) = (self.n, self.half + 1);
        for k in 0..n {
            let reach = self.half.min(n - 1 - k);
            let (a, b) = (x[k], y[k]);
            let at = k * width + 1..k * width + 1 + reach;
            let to = x[k + 1..k + 1 + reach].iter_mut().zip(&mut y[k + 1..k + 1 + reach]);
            for ((x, y), (u, v)) in to.zip(self.re[at.clone()].iter().zip(&self.im[at])) {
                *x -= u * a + v * b;
                *y -= u * b - v * a;
            }
        }
        for k in (0..n).rev() {
            let reach = self.half.min(n - 1 - k);
            let at = k * width + 1..k * width + 1 + reach;
            let (mut a, mut b) = (x[k] * self.re[k * width], y[k] * self.re[k * width]);
            let from = x[k + 1..k + 1 + reach].iter().zip(&y[k + 1..k + 1 + reach]);
            for ((x, y), (u, v)) in from.zip(self.re[at.clone()].iter().zip(&self.im[at])) {
                a -= u * x - v * y;
                b -= u * y + v * x;
            }
            (x[k], y[k]) = (a, b);
        }
    }

    /// Solves for a real right-hand side with a real matrix.
    fn solve_real(&self, x: &mut [f64]) {
        let (n, width) = (self.n, self.half + 1);
        for k in 0..n {
            let reach = self.half.min(n - 1 - k);
            let a = x[k];
            let row = &self.re[k * width + 1..k * width + 1 + reach];
            for (x, u) in x[k + 1..k + 1 + reach].iter_mut().zip(row) {
                *x -= u * a;
            }
        }
        for k in (0..n).rev() {
            let reach = self.half.min(n - 1 - k);
            let row = &self.re[k * width + 1..k * width + 1 + reach];
            let sum: f64 = x[k + 1..k + 1 + reach].iter().zip(row).map(|(x, u)| x * u).sum();
            x[k] = x[k] * self.re[k * width] - sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use num_complex::Complex64;

    /// A symmetric and an antisymmetric band.
    fn bands(n: usize, half: usize) -> [Band<f64>; 3] {
        let mut bands = [(); 3].map(|()| Band::new(n, half, half));
        for i in 0..n {
            for j in i..n.min(i + half + 1) {
                let x = ((7 * i + 3 * j) as f64).sin();
                let diagonal = if i == j { 3.0 + x } else { 0.0 };
                bands[0].set(i, j, x + diagonal);
                bands[0].set(j, i, x + diagonal);
                bands[1].set(i, j, (x * 2.0).cos());
                bands[1].set(j, i, (x * 2.0).cos());
                bands[2].set(i, j, if i == j { 0.0 } else { x * x });
                bands[2].set(j, i, if i == j { 0.0 } else { -x * x });
            }
        }
        bands
    }

    #[test]
    fn solutions_satisfy_their_equations_and_inertia_is_that_of_the_eigenvalues() {
        for (n, half, c) in [(1, 0, 0.3), (7, 2, 0.0), (12, 3, 0.7), (30, 9, -1.3)] {
            let [a, b, d] = bands(n, half);
            for w in [-2.0, -0.5, 0.4] {
                let entry = |i, j| Complex64::new(a.get(i, j) + w * b.get(i, j), c * d.get(i, j));
                let full = nalgebra::DMatrix::from_fn(n, n, entry);
                let mut factors = Hermitian::new(n, half);
                factors.assign(&a, (w, &b), (c, &d));
                let negative = factors.factor().unwrap();
                let eigenvalues = full.clone().symmetric_eigenvalues();
                assert_eq!(negative, eigenvalues.iter().filter(|e| **e < 0.0).count());
                let x: Vec<Complex64> = (0..n).map(|i| Complex64::new((i as f64).cos(), i as f64)).collect();
                let f = &full * nalgebra::DVector::from_vec(x.clone());
                let mut parts = [f.map(|f| f.re), f.map(|f| f.im)];
                let [re, im] = &mut parts;
                factors.solve(re.as_mut_slice(), im.as_mut_slice());
                for (i, x) in x.iter().enumerate() {
                    assert!((Complex64::new(re[i], im[i]) - x).norm() < 1e-9 * n as f64, "{i} of {n}");
                }
            }
        }
    }
}
