//! The entries of a matrix that are not zero, row by row: for its products with many vectors.

use crate::linalg::{Matrix, Storage};

/// A matrix by rows. The mass matrix of a system in space has a tenth of the entries that the band of its stiffness has room for.
#[derive(Clone, Debug)]
pub struct Sparse {
    /// Where each row begins among the entries, and where the last ends.
    starts: Vec<usize>,
    /// Column and value.
    entries: Vec<(u32, f64)>,
}

impl Sparse {
    /// The entries of a matrix, which is not factored.
    pub(super) fn of(matrix: &Matrix) -> Sparse {
        let n = matrix.order();
        let mut all = Vec::new();
        each(matrix, |i, j| {
            let x = matrix.get(i, j);
            if x != 0.0 {
                all.push((i, j as u32, x));
            }
        });
        all.sort_unstable_by_key(|(i, j, _)| (*i, *j));
        let mut starts = vec![0; n + 1];
        all.iter().for_each(|(i, ..)| starts[i + 1] += 1);
        (0..n).for_each(|i| starts[i + 1] += starts[i]);
        Sparse { starts, entries: all.into_iter().map(|(_, j, x)| (j, x)).collect() }
    }

    /// y = A x
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        for (y, range) in y.iter_mut().zip(self.starts.windows(2)) {
            let row = &self.entries[range[0]..range[1]];
            *y = row.iter().fold(0.0, |sum, (j, a)| sum + a * x[*j as usize]);
        }
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
