//! A band matrix with a few dense rows and columns, eliminated by block elimination.
//!
//! ```text
//! [ B  U ] [x]   [b]        S = D − V B⁻¹ U,   y = S⁻¹ (c − V B⁻¹ b),   x = B⁻¹ (b − U y)
//! [ V  D ] [y] = [c]
//! ```
//!
//! B itself may be singular though the whole is not (a free body whose only hold is in the border).
//! Pivots of B that vanish are then replaced, and for each a further border row and column restores
//! the original matrix: B x = B̃ x − (L e_k) z with z = δ x_k.

use super::band::DEFLATIONS;
use super::vector::weighted_sum;
use super::{Band, Dense, Scalar, Singular};

/// Band matrix of order `n` bordered by `m` dense rows and columns.
#[derive(Clone, Debug)]
pub struct Bordered<T> {
    band: Band<T>,
    border: usize,
    /// U, column after column (m × n).
    columns: Vec<T>,
    /// V, row after row (m × n).
    rows: Vec<T>,
    /// D by rows (m × m).
    corner: Vec<T>,
    /// B⁻¹ U, column after column, deflation columns behind.
    reduced: Vec<T>,
    /// Schur complements of orders m … m + DEFLATIONS.
    schur: Vec<Dense<T>>,
    /// Right-hand side of the Schur complement.
    small: Vec<T>,
}

impl<T: Scalar> Bordered<T> {
    /// The zero matrix with a band of order `n` and a border of width `border`.
    pub fn new(n: usize, lower: usize, upper: usize, border: usize) -> Bordered<T> {
        // Without a border there is nothing to deflate with.
        let further = if border > 0 { border + DEFLATIONS } else { 0 };
        let band = Band::new(n, lower, upper);
        Bordered {
            band: if border > 0 { band.deflatable() } else { band },
            border,
            columns: vec![T::ZERO; n * border],
            rows: vec![T::ZERO; n * border],
            corner: vec![T::ZERO; border * border],
            reduced: vec![T::ZERO; n * further],
            schur: (border..=further).map(Dense::new).collect(),
            small: vec![T::ZERO; further],
        }
    }

    /// The band.
    pub fn band(&self) -> &Band<T> {
        &self.band
    }

    /// The band, to be changed.
    pub fn band_mut(&mut self) -> &mut Band<T> {
        &mut self.band
    }

    /// Border column `k` (length of the band).
    pub fn column_mut(&mut self, k: usize) -> &mut [T] {
        let n = self.band.order();
        &mut self.columns[k * n..(k + 1) * n]
    }

    /// Border row `k` (length of the band).
    pub fn row_mut(&mut self, k: usize) -> &mut [T] {
        let n = self.band.order();
        &mut self.rows[k * n..(k + 1) * n]
    }

    /// Sets corner entry (i, j) of the border.
    pub fn set_corner(&mut self, i: usize, j: usize, x: T) {
        self.corner[i * self.border + j] = x;
    }

    /// Order of the whole matrix.
    pub fn order(&self) -> usize {
        self.band.order() + self.border
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.band.clear();
        self.columns.fill(T::ZERO);
        self.rows.fill(T::ZERO);
        self.corner.fill(T::ZERO);
    }

    /// Entry (i, j), zero outside band and border.
    pub fn get(&self, i: usize, j: usize) -> T {
        let n = self.band.order();
        match (i < n, j < n) {
            (true, true) => self.band.get(i, j),
            (true, false) => self.columns[(j - n) * n + i],
            (false, true) => self.rows[(i - n) * n + j],
            (false, false) => self.corner[(i - n) * self.border + (j - n)],
        }
    }

    /// Adds `x` to entry (i, j), which must lie within band or border.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, x: T) {
        let n = self.band.order();
        match (i < n, j < n) {
            (true, true) => self.band.add(i, j, x),
            (true, false) => self.columns[(j - n) * n + i] += x,
            (false, true) => self.rows[(i - n) * n + j] += x,
            (false, false) => self.corner[(i - n) * self.border + (j - n)] += x,
        }
    }

    /// Calls `f` with the place and the value of every entry that it has room for.
    pub(super) fn each_mut(&mut self, mut f: impl FnMut(usize, usize, &mut T)) {
        let (n, lower, upper) = (self.band.order(), self.band.lower(), self.band.upper());
        for (i, row) in self.band.rows_mut().enumerate() {
            let first = i.saturating_sub(lower);
            let within = first..(i + upper + 1).min(n);
            within.zip(&mut row[first + lower - i..]).for_each(|(j, x)| f(i, j, x));
        }
        for k in 0..self.border {
            let of = k * n..(k + 1) * n;
            self.columns[of.clone()].iter_mut().enumerate().for_each(|(i, x)| f(i, n + k, x));
            self.rows[of].iter_mut().enumerate().for_each(|(j, x)| f(n + k, j, x));
            let corner = &mut self.corner[k * self.border..(k + 1) * self.border];
            corner.iter_mut().enumerate().for_each(|(j, x)| f(n + k, n + j, x));
        }
    }

    /// Replaces the content by Σ wₖ Aₖ of real matrices of the same structure.
    pub(super) fn combine(&mut self, terms: [&Bordered<f64>; 3], weights: [T; 3]) {
        self.band.combine(terms.map(|a| &a.band), weights);
        weighted_sum(&mut self.columns, terms.map(|a| &a.columns[..]), weights);
        weighted_sum(&mut self.rows, terms.map(|a| &a.rows[..]), weights);
        weighted_sum(&mut self.corner, terms.map(|a| &a.corner[..]), weights);
    }

    /// y = A x, before factoring.
    pub fn multiply(&self, x: &[T], y: &mut [T]) {
        let n = self.band.order();
        let (xb, xs) = x.split_at(n);
        let (yb, ys) = y.split_at_mut(n);
        self.band.multiply(xb, yb);
        for (k, xk) in xs.iter().enumerate() {
            for (y, u) in yb.iter_mut().zip(&self.columns[k * n..(k + 1) * n]) {
                *y += *u * *xk;
            }
        }
        for (k, yk) in ys.iter_mut().enumerate() {
            let mut sum = T::ZERO;
            for (v, x) in self.rows[k * n..(k + 1) * n].iter().zip(xb) {
                sum += *v * *x;
            }
            for (d, x) in self.corner[k * self.border..(k + 1) * self.border].iter().zip(xs) {
                sum += *d * *x;
            }
            *yk = sum;
        }
    }

    /// The same for x and y in another order: place k belongs to their entry `unknowns[k]`.
    pub(super) fn multiply_ordered(&self, unknowns: &[u32], x: &[T], y: &mut [T]) {
        let (n, m) = (self.band.order(), self.border);
        let (inside, outside) = unknowns.split_at(n);
        let of = |row: &[T], unknowns: &[u32]| {
            row.iter().zip(unknowns).fold(T::ZERO, |sum, (a, j)| sum + *a * x[*j as usize])
        };
        for (i, &unknown) in inside.iter().enumerate() {
            let (first, row) = self.band.row(i);
            let mut sum = of(row, &inside[first..]);
            for (k, &j) in outside.iter().enumerate() {
                sum += self.columns[k * n + i] * x[j as usize];
            }
            y[unknown as usize] = sum;
        }
        for (k, &unknown) in outside.iter().enumerate() {
            let row = of(&self.rows[k * n..(k + 1) * n], inside);
            y[unknown as usize] = row + of(&self.corner[k * m..(k + 1) * m], outside);
        }
    }

    /// Factors in place.
    pub fn factor(&mut self) -> Result<(), Singular> {
        let n = self.band.order();
        let m = self.border;
        self.band.factor(m > 0)?;
        if m == 0 {
            return Ok(());
        }
        let extra = self.band.deflated().len();
        for k in 0..m {
            let z = &mut self.reduced[k * n..(k + 1) * n];
            z.copy_from_slice(&self.columns[k * n..(k + 1) * n]);
            self.band.solve(z);
        }
        for k in 0..extra {
            let z = &mut self.reduced[(m + k) * n..(m + k + 1) * n];
            z.fill(T::ZERO);
            z[self.band.deflated()[k].0] = -T::ONE;
            self.band.backward(z);
        }
        let schur = &mut self.schur[extra];
        schur.clear();
        for j in 0..m + extra {
            let z = &self.reduced[j * n..(j + 1) * n];
            for i in 0..m {
                let mut sum = if j < m { self.corner[i * m + j] } else { T::ZERO };
                for (v, z) in self.rows[i * n..(i + 1) * n].iter().zip(z) {
                    sum -= *v * *z;
                }
                schur.add(i, j, sum);
            }
            for (i, &(at, delta)) in self.band.deflated().iter().enumerate() {
                let corner = if j == m + i { -T::ONE } else { T::ZERO };
                schur.add(m + i, j, corner - T::real(delta) * z[at]);
            }
        }
        schur.factor().map_err(|e| {
            let at = |k: usize| self.band.deflated()[k - m].0;
            Singular { index: if e.index < m { n + e.index } else { at(e.index) }, pivot: e.pivot }
        })
    }

    /// Solves A x = b in place after [`Bordered::factor`].
    pub fn solve(&mut self, b: &mut [T]) {
        let n = self.band.order();
        let m = self.border;
        if m == 0 {
            self.band.solve(b);
            return;
        }
        let extra = self.band.deflated().len();
        let (x, y) = b.split_at_mut(n);
        self.band.solve(x);
        let small = &mut self.small[..m + extra];
        for i in 0..m {
            let mut sum = y[i];
            for (v, x) in self.rows[i * n..(i + 1) * n].iter().zip(x.iter()) {
                sum -= *v * *x;
            }
            small[i] = sum;
        }
        for (i, &(at, delta)) in self.band.deflated().iter().enumerate() {
            small[m + i] = -T::real(delta) * x[at];
        }
        self.schur[extra].solve(small);
        y.copy_from_slice(&small[..m]);
        for (k, s) in small.iter().enumerate() {
            for (x, z) in x.iter_mut().zip(&self.reduced[k * n..(k + 1) * n]) {
                *x -= *z * *s;
            }
        }
    }
}
