//! The entries of a matrix that are not zero, row by row: for its products with many vectors.

use crate::linalg::{Matrix, Storage};
use num_complex::Complex64;

/// A matrix by rows. The mass matrix of a system in space has a tenth of the entries that the band of its stiffness has room for.
#[derive(Clone, Debug)]
pub struct Sparse {
    /// The entries of each row.
    rows: Vec<std::ops::Range<usize>>,
    /// Column and value.
    entries: Vec<(u32, f64)>,
}

impl Sparse {
    /// The entries of a matrix, which is not factored.
    pub fn of(matrix: &Matrix) -> Sparse {
        let (mut rows, mut entries) = (vec![0..0; matrix.order()], Vec::new());
        matrix.visit(|i, j, x| {
            let at = entries.len();
            let begin = if rows[i].is_empty() { at } else { rows[i].start };
            rows[i] = begin..at + 1;
            entries.push((j as u32, x));
        });
        Sparse { rows, entries }
    }

    /// |A|, entry by entry.
    pub(crate) fn sizes(mut self) -> Sparse {
        self.entries.iter_mut().for_each(|(_, x)| *x = x.abs());
        self
    }

    /// y = A x
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        for (y, row) in y.iter_mut().zip(&self.rows) {
            let row = &self.entries[row.clone()];
            *y = row.iter().fold(0.0, |sum, (j, a)| sum + a * x[*j as usize]);
        }
    }

    /// A z, as many entries as z has: beyond them are the multipliers, whose columns hold nothing.
    pub fn times(&self, z: &[Complex64]) -> Vec<Complex64> {
        let row = |row: &std::ops::Range<usize>| {
            self.entries[row.clone()].iter().map(|(j, a)| z[*j as usize] * *a).sum()
        };
        self.rows.iter().take(z.len()).map(row).collect()
    }

    /// Whether it has no entries.
    pub fn is_zero(&self) -> bool {
        self.entries.is_empty()
    }
}

/// Calls `f` for every entry that the structure of a matrix stores, by the numbers of its unknowns.
pub fn each(matrix: &Matrix, mut f: impl FnMut(usize, usize)) {
    let n = matrix.order();
    let mut f = |i, j| f(matrix.unknown(i), matrix.unknown(j));
    match matrix.storage() {
        Storage::Dense(_) => (0..n * n).for_each(|k| f(k / n, k % n)),
        Storage::Band(a) => {
            let (band, lower, upper) = (a.band().order(), a.band().lower(), a.band().upper());
            for i in 0..n {
                let within =
                    if i < band { i.saturating_sub(lower)..(i + upper + 1).min(band) } else { 0..band };
                within.chain(band..n).for_each(|j| f(i, j));
            }
        }
    }
}
