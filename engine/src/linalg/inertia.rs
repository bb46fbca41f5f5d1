//! Inertia (number of negative eigenvalues) of a symmetric matrix by Sylvester's law.

use super::Matrix;

/// Number of negative eigenvalues of the symmetric matrix A + w B (equal structures, border ignored), from
/// the signs of the pivots of its LDLᵀ factorisation without interchanges: O(n·b²) for half-bandwidth b.
pub fn negative_pivots(a: &Matrix, b: &Matrix, w: f64) -> usize {
    let n = a.order();
    let half = match a.storage() {
        super::Storage::Dense(_) | super::Storage::Condensed(_) => n.saturating_sub(1),
        super::Storage::Band(m) => m.band().upper(),
    };
    // Rows of the upper triangle of the last `half` pivots, as a ring.
    let width = half + 1;
    let mut rows = vec![0.0; width * width];
    let mut count = 0;
    for k in 0..n {
        let mut row: Vec<f64> =
            (0..width).map(|j| if k + j < n { a.get(k, k + j) + w * b.get(k, k + j) } else { 0.0 }).collect();
        for p in k.saturating_sub(half)..k {
            let former = &rows[(p % width) * width..(p % width + 1) * width];
            let offset = k - p;
            let factor = former[offset] / former[0];
            for j in offset..width {
                row[j - offset] -= factor * former[j];
            }
        }
        // An exactly vanishing pivot is counted as positive and kept from dividing.
        if row[0] == 0.0 {
            row[0] = f64::MIN_POSITIVE;
        }
        if row[0] < 0.0 {
            count += 1;
        }
        rows[(k % width) * width..(k % width + 1) * width].copy_from_slice(&row);
    }
    count
}
