//! Products of the constant matrices with vectors: the innermost loops of a linear model.
//!
//! Four matrices, A₁ … A₄ say, are stored together, entry by entry, so that one pass over memory gives the
//! products of all of them with as many vectors, and any weighted sum of them. Row i of a band meets the
//! entries i − l … i + u of a vector; with l zeros in front of the vector and u behind it every row meets a
//! full window, the first and last rows too, and loops over rows have a length the compiler knows.

use crate::linalg::{Matrix, Storage, Structure};

/// Number of matrices that are stored together, at most.
pub(super) const TERMS: usize = 4;

/// Up to four matrices of one structure, entry by entry; `terms`, 2 or 4, are stored.
#[derive(Clone, Debug)]
pub(super) struct Bundle {
    order: usize,
    terms: usize,
    /// Entries of a row.
    width: usize,
    /// How far the window of a row lies behind that of the row before: 1, or 0 for full rows.
    advance: usize,
    /// Entries of a row in front of the diagonal: zeros in front of a vector.
    lead: usize,
    /// Term k of the entry at place j of row i is at (i·width + j)·terms + k.
    data: Vec<f64>,
}

/// As many vectors as a [`Bundle`] has terms, entry by entry, with zeros in front and behind.
#[derive(Clone, Debug)]
pub(super) struct Vectors {
    terms: usize,
    range: std::ops::Range<usize>,
    data: Vec<f64>,
}

impl Vectors {
    /// Sets entry i of vector `k` to `f(i)`; nothing happens if there is no such term.
    #[inline]
    pub(super) fn set(&mut self, k: usize, f: impl Fn(usize) -> f64) {
        let terms = self.terms;
        let entries = &mut self.data[self.range.clone()];
        if terms == TERMS && k < TERMS {
            for (i, x) in entries.as_chunks_mut::<TERMS>().0.iter_mut().enumerate() {
                x[k] = f(i);
            }
        } else if k < 2 {
            for (i, x) in entries.as_chunks_mut::<2>().0.iter_mut().enumerate() {
                x[k] = f(i);
            }
        }
    }

    /// Sets entry i of all vectors to `f(i)`.
    #[inline]
    pub(super) fn set_all(&mut self, f: impl Fn(usize) -> f64) {
        let terms = self.terms;
        let entries = &mut self.data[self.range.clone()];
        if terms == TERMS {
            for (i, x) in entries.as_chunks_mut::<TERMS>().0.iter_mut().enumerate() {
                *x = [f(i); TERMS];
            }
        } else {
            for (i, x) in entries.as_chunks_mut::<2>().0.iter_mut().enumerate() {
                *x = [f(i); 2];
            }
        }
    }
}

impl Bundle {
    /// The first `order` rows of the matrices; zeros stand for those that are not there.
    pub(super) fn new(structure: &Structure, order: usize, matrices: [Option<&Matrix>; TERMS]) -> Bundle {
        let terms = if matrices[2..].iter().all(Option::is_none) { 2 } else { TERMS };
        let most = order.saturating_sub(1);
        let (width, advance, lead) = match *structure {
            Structure::Dense { .. } => (order, 0, 0),
            Structure::Band { lower, upper, .. } => {
                (lower.min(most) + upper.min(most) + 1, 1, lower.min(most))
            }
        };
        let mut data = Vec::with_capacity(order * width * terms);
        for i in 0..order {
            for j in 0..width {
                let column = (advance * i + j).checked_sub(lead).filter(|column| *column < order);
                for matrix in &matrices[..terms] {
                    data.push(matrix.zip(column).map_or(0.0, |(a, column)| a.get(i, column)));
                }
            }
        }
        Bundle { order, terms, width, advance, lead, data }
    }

    /// Number of rows.
    pub(super) fn order(&self) -> usize {
        self.order
    }

    /// Vectors of zeros to multiply with.
    pub(super) fn vectors(&self) -> Vectors {
        self.vectors_of(self.terms)
    }

    /// Two vectors of zeros, to multiply with the first two matrices.
    pub(super) fn pair(&self) -> Vectors {
        self.vectors_of(2)
    }

    fn vectors_of(&self, terms: usize) -> Vectors {
        let behind = self.advance * (self.width - self.lead.min(self.width));
        let first = self.lead * terms;
        let range = first..first + self.order * terms;
        let data = vec![0.0; range.end + behind * terms];
        Vectors { terms, range, data }
    }

    /// Calls `f` with i and the products (Aₖ xₖ)ᵢ, row after row; zero for terms that are not stored.
    #[inline]
    pub(super) fn products(&self, x: &Vectors, mut f: impl FnMut(usize, [f64; TERMS])) {
        let pairs = |[a, b, c, d]: [f64; TERMS]| [a + c, b + d, 0.0, 0.0];
        // Rows of the common lengths: Hermite functions with linear or Hermite ones for the other field.
        match (self.terms, self.width) {
            (TERMS, 11) => self.rows::<{ TERMS * 11 }>(x, f),
            (TERMS, 15) => self.rows::<{ TERMS * 15 }>(x, f),
            (TERMS, _) => self.rows::<0>(x, f),
            (_, 11) => self.rows::<{ 2 * 11 }>(x, |i, lanes| f(i, pairs(lanes))),
            (_, 15) => self.rows::<{ 2 * 15 }>(x, |i, lanes| f(i, pairs(lanes))),
            _ => self.rows::<0>(x, |i, lanes| f(i, pairs(lanes))),
        }
    }

    /// Sums each row by four lanes, which belong to the terms in turn. `LENGTH` is the number of entries of
    /// a row where the compiler knows it, or 0.
    #[inline(always)]
    fn rows<const LENGTH: usize>(&self, x: &Vectors, mut f: impl FnMut(usize, [f64; TERMS])) {
        let length = if LENGTH > 0 { LENGTH } else { self.width * self.terms };
        let advance = self.advance * self.terms;
        for (i, row) in self.data.chunks_exact(length.max(1)).enumerate() {
            let mut lanes = [0.0; TERMS];
            let (a, a_rest) = row.as_chunks::<TERMS>();
            let (x, x_rest) = x.data[i * advance..][..length].as_chunks::<TERMS>();
            for (a, x) in a.iter().zip(x) {
                for k in 0..TERMS {
                    lanes[k] += a[k] * x[k];
                }
            }
            for (k, (a, x)) in a_rest.iter().zip(x_rest).enumerate() {
                lanes[k] += a * x;
            }
            f(i, lanes);
        }
    }

    /// Calls `f` with i, the products (Aₖ xₖ)ᵢ as [`Bundle::products`] does, and (A₁ y₁)ᵢ, (A₂ y₂)ᵢ: one pass over
    /// the matrices for both.
    #[inline]
    pub(super) fn products_and_pair(
        &self,
        x: &Vectors,
        y: &Vectors,
        mut f: impl FnMut(usize, [f64; TERMS], [f64; 2]),
    ) {
        let pair = |[a, b, c, d]: [f64; TERMS]| [a + c, b + d];
        let four = |lanes: [f64; TERMS]| [lanes[0] + lanes[2], lanes[1] + lanes[3], 0.0, 0.0];
        match (self.terms, self.width) {
            (TERMS, 11) => self.rows_and_pair::<11>(x, y, f),
            (TERMS, 15) => self.rows_and_pair::<15>(x, y, f),
            (TERMS, _) => self.rows_and_pair::<0>(x, y, f),
            (_, 15) => self.both_pairs::<{ 2 * 15 }>(x, y, |i, x, y| f(i, four(x), pair(y))),
            _ => self.both_pairs::<0>(x, y, |i, x, y| f(i, four(x), pair(y))),
        }
    }

    /// [`Bundle::products_and_pair`] for four terms; `WIDTH` is that of a row, or 0.
    #[inline(always)]
    fn rows_and_pair<const WIDTH: usize>(
        &self,
        x: &Vectors,
        y: &Vectors,
        mut f: impl FnMut(usize, [f64; TERMS], [f64; 2]),
    ) {
        let width = if WIDTH > 0 { WIDTH } else { self.width };
        for (i, row) in self.data.chunks_exact((width * TERMS).max(1)).enumerate() {
            let at = i * self.advance;
            let x = x.data[at * TERMS..][..width * TERMS].as_chunks::<TERMS>().0;
            let y = y.data[at * 2..][..width * 2].as_chunks::<2>().0;
            let (mut four, mut two) = ([0.0; TERMS], [0.0; 2]);
            for ((a, x), y) in row.as_chunks::<TERMS>().0.iter().zip(x).zip(y) {
                for k in 0..TERMS {
                    four[k] += a[k] * x[k];
                }
                for k in 0..2 {
                    two[k] += a[k] * y[k];
                }
            }
            f(i, four, two);
        }
    }

    /// [`Bundle::products_and_pair`] for two terms, summed by four lanes as [`Bundle::rows`] does.
    #[inline(always)]
    fn both_pairs<const LENGTH: usize>(
        &self,
        x: &Vectors,
        y: &Vectors,
        mut f: impl FnMut(usize, [f64; TERMS], [f64; TERMS]),
    ) {
        let length = if LENGTH > 0 { LENGTH } else { self.width * self.terms };
        let advance = self.advance * self.terms;
        for (i, row) in self.data.chunks_exact(length.max(1)).enumerate() {
            let (mut of_x, mut of_y) = ([0.0; TERMS], [0.0; TERMS]);
            let (a, a_rest) = row.as_chunks::<TERMS>();
            let (x, x_rest) = x.data[i * advance..][..length].as_chunks::<TERMS>();
            let (y, y_rest) = y.data[i * advance..][..length].as_chunks::<TERMS>();
            for ((a, x), y) in a.iter().zip(x).zip(y) {
                for k in 0..TERMS {
                    of_x[k] += a[k] * x[k];
                    of_y[k] += a[k] * y[k];
                }
            }
            for (k, ((a, x), y)) in a_rest.iter().zip(x_rest).zip(y_rest).enumerate() {
                of_x[k] += a * x;
                of_y[k] += a * y;
            }
            f(i, of_x, of_y);
        }
    }

    /// xᵀ Aₖ x for one of the matrices; 0 for one that is not there.
    pub(super) fn form(&self, k: usize, x: &[f64]) -> f64 {
        if k >= self.terms {
            return 0.0;
        }
        let row = |i: usize| -> f64 {
            let first = (self.advance * i).saturating_sub(self.lead);
            let last = (self.advance * i + self.width - self.lead).min(self.order);
            let at = i * self.width + first + self.lead - self.advance * i;
            let a = self.data[at * self.terms..].chunks_exact(self.terms);
            a.zip(&x[first..last]).map(|(a, x)| a[k] * x).sum()
        };
        (0..self.order).map(|i| x[i] * row(i)).sum()
    }

    /// Writes Σ wₖ Aₖ over the content of `out`, border aside.
    pub(super) fn write_sum(&self, weights: [f64; TERMS], out: &mut Storage<f64>) {
        if self.fits(out) {
            return self.sum(weights, out, |out, x| *out = x);
        }
        out.clear();
        self.scatter_sum(weights, out);
    }

    /// Adds Σ wₖ Aₖ to `out`.
    pub(super) fn add_sum(&self, weights: [f64; TERMS], out: &mut Storage<f64>) {
        if self.fits(out) {
            return self.sum(weights, out, |out, x| *out += x);
        }
        self.scatter_sum(weights, out);
    }

    /// Whether the rows lie in `out` as they lie here.
    fn fits(&self, out: &Storage<f64>) -> bool {
        out.is_dense() == (self.advance == 0)
    }

    /// Adds Σ wₖ Aₖ to a storage of another kind, entry by entry.
    fn scatter_sum(&self, w: [f64; TERMS], out: &mut Storage<f64>) {
        for (i, row) in self.data.chunks_exact((self.width * self.terms).max(1)).enumerate() {
            for (j, a) in row.chunks_exact(self.terms).enumerate() {
                let Some(column) = (self.advance * i + j).checked_sub(self.lead) else { continue };
                // What is zero in all of them may lie outside the band of `out`.
                if column < self.order && a.iter().any(|a| *a != 0.0) {
                    let x = a.iter().zip(&w).map(|(a, w)| a * w).sum();
                    out.add(i, column, x);
                }
            }
        }
    }

    #[inline(always)]
    fn sum(&self, w: [f64; TERMS], out: &mut Storage<f64>, put: impl Fn(&mut f64, f64)) {
        let rows = self.data.chunks_exact((self.width * self.terms).max(1));
        for (out, row) in out.rows_mut().zip(rows) {
            // Behind the band is the zone of fill of former factors.
            let (out, fill) = out.split_at_mut(self.width);
            if self.terms == TERMS {
                for (out, a) in out.iter_mut().zip(row.as_chunks::<TERMS>().0) {
                    put(out, (w[0] * a[0] + w[2] * a[2]) + (w[1] * a[1] + w[3] * a[3]));
                }
            } else {
                for (out, a) in out.iter_mut().zip(row.as_chunks::<2>().0) {
                    put(out, w[0] * a[0] + w[1] * a[1]);
                }
            }
            fill.fill(0.0);
        }
    }
}
