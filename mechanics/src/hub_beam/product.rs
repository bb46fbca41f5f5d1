//! Products of the constant matrices with vectors: the innermost loops of a linear model.
//!
//! Four matrices A₁ … A₄ are stored together, entry by entry, so that one pass over memory gives the products of all of
//! them with as many vectors, and any weighted sum of them. Row i of a band meets the entries i − l … i + u of a vector;
//! with l zeros in front of the vector and u behind it every row meets a full window, the first and last rows too.

use super::vectors::{Entry, TERMS, Vectors};
use crate::linalg::{Matrix, Storage, Structure};
use std::sync::Arc;

/// Up to four matrices of one structure, entry by entry; the first two alone are stored if the others are not there.
#[derive(Clone, Debug)]
pub(super) struct Bundle {
    order: usize,
    /// Matrices that are stored: 2 or 4.
    terms: usize,
    /// Entries of a row.
    width: usize,
    /// How far the window of a row lies behind that of the row before: 1, or 0 for full rows.
    advance: usize,
    /// Entries of a row in front of the diagonal: zeros in front of a vector.
    lead: usize,
    /// Term k of the entry at position j of row i is at (i·width + j)·terms + k.
    data: Arc<[f64]>,
}

impl Bundle {
    /// The first `order` rows of the matrices; a matrix that is `None` is zero.
    pub(super) fn new(structure: &Structure, order: usize, matrices: [Option<&Matrix>; TERMS]) -> Bundle {
        let most = order.saturating_sub(1);
        let (width, advance, lead) = match *structure {
            Structure::Dense { .. } | Structure::Ordered { .. } => (order, 0, 0),
            Structure::Band { lower, upper, .. } => {
                (lower.min(most) + upper.min(most) + 1, 1, lower.min(most))
            }
        };
        let terms = if matrices[2].is_none() && matrices[3].is_none() { 2 } else { TERMS };
        let mut data = Vec::with_capacity(order * width * terms);
        let bundle = Bundle { order, terms, width, advance, lead, data: Arc::new([]) };
        for i in 0..order {
            for j in 0..width {
                let column = bundle.column(i, j);
                let entry = |a: &Option<&Matrix>| a.zip(column).map_or(0.0, |(a, column)| a.get(i, column));
                data.extend(matrices[..terms].iter().map(entry));
            }
        }
        Bundle { data: data.into(), ..bundle }
    }

    /// Column of the entry at position `j` of row `i`, if it is one of the matrix.
    fn column(&self, i: usize, j: usize) -> Option<usize> {
        (self.advance * i + j).checked_sub(self.lead).filter(|column| *column < self.order)
    }

    /// Number of rows.
    pub(super) fn order(&self) -> usize {
        self.order
    }

    /// Vectors of zeros to multiply with.
    pub(super) fn vectors(&self) -> Vectors {
        let terms = self.terms;
        let behind = self.advance * (self.width - self.lead.min(self.width));
        let range = self.lead * terms..(self.lead + self.order) * terms;
        Vectors { terms, data: vec![0.0; range.end + behind * terms], range }
    }

    fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.data.chunks_exact((self.width * self.terms).max(1))
    }

    /// Writes the products (Aₖ xₖ)ᵢ, row after row; zero for terms that are not stored.
    pub(super) fn products(&self, x: &Vectors, out: &mut [Entry]) {
        match (self.terms, self.width) {
            // Hermite functions with linear ones, and with Hermite ones.
            (TERMS, 11) => self.sums::<TERMS, TERMS, 11>(x, out),
            (2, 15) => self.sums::<2, 2, 15>(x, out),
            (TERMS, _) => self.sums::<TERMS, TERMS, 0>(x, out),
            _ => self.sums::<2, 2, 0>(x, out),
        }
    }

    /// [`Bundle::products`] with the first two matrices alone; zero for the others.
    pub(super) fn first_products(&self, x: &Vectors, out: &mut [Entry]) {
        match (self.terms, self.width) {
            (TERMS, 11) => self.sums::<TERMS, 2, 11>(x, out),
            (TERMS, _) => self.sums::<TERMS, 2, 0>(x, out),
            _ => self.products(x, out),
        }
    }

    /// The products of the first `U` of `T` terms; `W` is the width of a row where it is known at compile time, or 0.
    #[inline(always)]
    fn sums<const T: usize, const U: usize, const W: usize>(&self, x: &Vectors, out: &mut [Entry]) {
        let length = T * if W > 0 { W } else { self.width };
        for (i, out) in out.iter_mut().enumerate() {
            let row = self.data[i * length..][..length].as_chunks::<T>().0;
            let x = x.data[i * self.advance * T..][..length].as_chunks::<T>().0;
            let mut sum = [0.0; U];
            for (a, x) in row.iter().zip(x) {
                for k in 0..U {
                    sum[k] += a[k] * x[k];
                }
            }
            *out = std::array::from_fn(|k| if k < U { sum[k] } else { 0.0 });
        }
    }

    /// xᵀ Aₖ x for one of the matrices, which is symmetric.
    pub(super) fn form(&self, k: usize, x: &[f64]) -> f64 {
        if k >= self.terms {
            return 0.0;
        }
        match (self.terms, self.lead) {
            (TERMS, 5) => self.form_of::<TERMS, 6>(k, x),
            (TERMS, _) => self.form_of::<TERMS, 0>(k, x),
            _ => self.form_of::<2, 0>(k, x),
        }
    }

    /// Σ xᵢ (2 Σⱼ Aᵢⱼ xⱼ − Aᵢᵢ xᵢ) over j ≥ i; `H` is the number of these entries of a row of a band where it is known at compile time, or 0.
    fn form_of<const T: usize, const H: usize>(&self, k: usize, x: &[f64]) -> f64 {
        let (mut sum, k) = (0.0, k.min(T - 1));
        for (i, row) in self.rows().enumerate() {
            let row = &row.as_chunks::<T>().0[i + self.lead - self.advance * i..];
            let x = &x[i..self.order];
            let product: f64 = match (row.first_chunk::<H>(), x.first_chunk::<H>()) {
                (Some(row), Some(x)) if H > 0 => row.iter().zip(x).map(|(a, x)| a[k] * x).sum(),
                _ => row.iter().zip(x).map(|(a, x)| a[k] * x).sum(),
            };
            sum += x[0] * (2.0 * product - row[0][k] * x[0]);
        }
        sum
    }

    /// Writes Σ wₖ Aₖ over the content of `out`, border aside.
    pub(super) fn write_sum(&self, weights: Entry, out: &mut Storage<f64>) {
        if self.fits(out) {
            return self.sum(weights, out, |out, x| *out = x);
        }
        out.clear();
        self.scatter_sum(weights, out);
    }

    /// Adds Σ wₖ Aₖ to `out`.
    pub(super) fn add_sum(&self, weights: Entry, out: &mut Storage<f64>) {
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
    fn scatter_sum(&self, w: Entry, out: &mut Storage<f64>) {
        for (i, row) in self.rows().enumerate() {
            for (j, a) in row.chunks_exact(self.terms).enumerate() {
                // What is zero in all of them may lie outside the band of `out`.
                if let Some(column) = self.column(i, j).filter(|_| a.iter().any(|a| *a != 0.0)) {
                    out.add(i, column, a.iter().zip(w).map(|(a, w)| a * w).sum());
                }
            }
        }
    }

    #[inline(always)]
    fn sum(&self, w: Entry, out: &mut Storage<f64>, put: impl Fn(&mut f64, f64)) {
        for (out, row) in out.rows_mut().zip(self.rows()) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms_are_those_of_all_entries_whatever_the_structure() {
        let band = |n, half| Structure::band(n, half, half, 0);
        let structures = (1..=16).flat_map(|n| {
            [Structure::dense(n)]
                .into_iter()
                .chain((0..8).filter(move |half| *half < n).map(move |half| band(n, half)))
        });
        for structure in structures {
            let (n, half) = (structure.order(), structure.half_bandwidth());
            let [mut first, mut second] = [0, 1].map(|_| Matrix::new(&structure));
            let entry = |i: usize, j: usize| 1.0 / (1 + i + j) as f64;
            for i in 0..n {
                for j in (0..n).filter(|j| i.abs_diff(*j) <= half) {
                    first.add(i, j, entry(i, j));
                    second.add(i, j, 2.0 * entry(i, j));
                }
            }
            let x: Vec<f64> = (0..n).map(|i| 1.0 + (i * i) as f64).collect();
            let near = |i: usize| (0..n).filter(move |j| i.abs_diff(*j) <= half);
            let expected: f64 = (0..n)
                .flat_map(|i| near(i).map(move |j| (i, j)))
                .map(|(i, j)| x[i] * entry(i, j) * x[j])
                .sum();
            for matrices in
                [[Some(&first), Some(&second), None, None], [Some(&first), Some(&second), Some(&first), None]]
            {
                let bundle = Bundle::new(&structure, n, matrices);
                for (k, factor) in [(0, 1.0), (1, 2.0)] {
                    let found = bundle.form(k, &x);
                    assert!(
                        (found / (factor * expected) - 1.0).abs() < 1e-13,
                        "{structure:?}: {found} for {expected}"
                    );
                }
            }
        }
    }
}
