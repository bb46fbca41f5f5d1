//! Inertia (number of negative eigenvalues) of a Hermitian matrix by Sylvester's law.

use super::{Matrix, Scalar};

/// Number of negative eigenvalues of the symmetric matrix A + w B (equal structures, border ignored), from
/// the signs of the pivots of its LDLᵀ factorisation without interchanges: O(n·b²) for half-bandwidth b.
pub fn negative_pivots(a: &Matrix, b: &Matrix, w: f64) -> usize {
    let half = match a.storage() {
        super::Storage::Dense(_) => a.order().saturating_sub(1),
        super::Storage::Band(m) => m.band().upper(),
    };
    negative_pivots_of(a.order(), half, |i, j| a.get(i, j) + w * b.get(i, j))
}

/// Number of negative eigenvalues of a Hermitian matrix of order `n` and half-bandwidth `half` with the entries
/// `entry(i, j)`, j ≥ i, from LDLᴴ without interchanges.
pub fn negative_pivots_of<T: Scalar>(n: usize, half: usize, entry: impl Fn(usize, usize) -> T) -> usize {
    // Rows of the upper triangle of the last `half` pivots, as a ring.
    let width = half + 1;
    let mut rows = vec![T::ZERO; width * width];
    let mut row = vec![T::ZERO; width];
    let mut count = 0;
    for k in 0..n {
        for (j, x) in row.iter_mut().enumerate() {
            *x = if k + j < n { entry(k, k + j) } else { T::ZERO };
        }
        for p in k.saturating_sub(half)..k {
            let former = &rows[(p % width) * width..(p % width + 1) * width];
            let offset = k - p;
            // The entries of a row are over the pivot in front of it.
            let factor = former[offset].conj() * former[0];
            for j in offset..width {
                row[j - offset] -= factor * former[j];
            }
        }
        // Real but for rounding. An exactly vanishing pivot is counted as positive and kept from dividing.
        let pivot = if row[0].re() == 0.0 { f64::MIN_POSITIVE.sqrt() } else { row[0].re() };
        count += usize::from(pivot < 0.0);
        let kept = &mut rows[(k % width) * width..(k % width + 1) * width];
        kept.copy_from_slice(&row);
        kept[0] = T::real(1.0 / pivot);
    }
    count
}
