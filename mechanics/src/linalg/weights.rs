//! Weights of rows, by which pivots of different units are compared.
//!
//! The scaling that gives a symmetric matrix a unit diagonal, dᵢ = |aᵢᵢ|^(−½), has no units. A row without a diagonal, as of a constraint, has
//! dᵢ = 1/maxⱼ |aᵢⱼ| dⱼ over the columns whose dⱼ is known: its largest entry is then 1 too.

use super::Scalar;

/// Passes after which rows are weighed by themselves: those of constraints, and those of unknowns that constraints alone hold.
const PASSES: usize = 2;

/// Makes weights of the rows `start`.. of the sizes of their diagonals; `row` gives the first column of a row and the entries from there on, of
/// rows without a diagonal.
pub(super) fn weigh<'a, T: Scalar>(
    start: usize,
    weights: &mut [f64],
    row: impl Fn(usize) -> (usize, &'a [T]),
) {
    let n = weights.len();
    let mut left = 0;
    for weight in &mut weights[start..] {
        if *weight > 0.0 {
            *weight = 1.0 / weight.sqrt();
        } else {
            left += 1;
        }
    }
    for pass in 0..=PASSES {
        if left == 0 {
            return;
        }
        for i in start..n {
            if weights[i] > 0.0 {
                continue;
            }
            let (first, entries) = row(i);
            let of_column = |j: usize| if pass < PASSES { weights[j] } else { 1.0 };
            let sizes = entries.iter().enumerate().map(|(k, x)| x.size() * of_column(first + k));
            let size = sizes.fold(0.0, f64::max);
            if size > 0.0 {
                weights[i] = 1.0 / size;
                left -= 1;
            }
        }
    }
}
