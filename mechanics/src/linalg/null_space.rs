//! A basis of the motions that rows allow.

use nalgebra::{DMatrix, DVector};

/// Part of the largest diagonal entry of R below which a row follows from others.
const DEPENDENT: f64 = 1e-10;

/// Motions x with J x = 0: some of the unknowns are independent, and the others follow from them.
#[derive(Clone, Debug, PartialEq)]
pub struct NullSpace {
    /// Numbers of the independent unknowns, ascending.
    pub independent: Vec<usize>,
    /// One vector for each of them: 1 there, 0 at the other independent ones.
    pub vectors: Vec<Vec<f64>>,
}

impl NullSpace {
    /// Of the dense `rows` of J for the unknowns with these scales. With the columns of J in the order of a pivoted factorisation, J P = Q [R₁ R₂]
    /// with a triangular R₁ as large as the rank, the first unknowns are −R₁⁻¹ R₂ times the others: those that the rows hold best are
    /// dependent.
    pub fn of(rows: &[Vec<f64>], scales: &[f64]) -> NullSpace {
        let n = scales.len();
        // Unknowns of one size, rows too.
        let mut j = DMatrix::from_fn(rows.len(), n, |i, k| rows[i][k] * scales[k]);
        for mut row in j.row_iter_mut() {
            let size = row.norm();
            if size > 0.0 {
                row /= size;
            }
        }
        let factors = j.col_piv_qr();
        let r = factors.r();
        let mut order = DMatrix::from_fn(1, n, |_, k| k as f64);
        factors.p().permute_columns(&mut order);
        let order: Vec<usize> = order.iter().map(|k| *k as usize).collect();
        let diagonal: Vec<f64> = (0..r.nrows().min(n)).map(|i| r[(i, i)].abs()).collect();
        let largest = diagonal.iter().copied().fold(0.0, f64::max);
        let rank = diagonal.iter().take_while(|x| **x > DEPENDENT * largest).count();
        let square = r.view((0, 0), (rank, rank)).clone_owned();
        let mut found: Vec<(usize, Vec<f64>)> = (rank..n)
            .map(|k| {
                let right: DVector<f64> = -r.view((0, k), (rank, 1)).column(0).clone_owned();
                let dependent = square.solve_upper_triangular(&right).unwrap_or(right);
                let own = order[k];
                let mut vector = vec![0.0; n];
                for (i, x) in dependent.iter().enumerate() {
                    vector[order[i]] = x * scales[order[i]] / scales[own];
                }
                vector[own] = 1.0;
                (own, vector)
            })
            .collect();
        found.sort_by_key(|(own, _)| *own);
        let (independent, vectors) = found.into_iter().unzip();
        NullSpace { independent, vectors }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_that_rows_allow_move_no_row() {
        // Two rows and one that follows from them, for unknowns of different units.
        let rows = [
            vec![1.0, 0.0, -1e-3, 0.0, 2.0],
            vec![0.0, 1.0, 0.0, 0.5, 0.0],
            vec![2.0, -3.0, -2e-3, -1.5, 4.0],
        ];
        let scales = [1.0, 1.0, 1e3, 1.0, 1e-2];
        let found = NullSpace::of(&rows, &scales);
        assert_eq!(found.vectors.len(), 3);
        for (k, (own, x)) in found.independent.iter().zip(&found.vectors).enumerate() {
            for row in &rows {
                let g: f64 = row.iter().zip(x).map(|(a, x)| a * x).sum();
                // Rounding is of the sizes of rows and vectors of unknowns of one size.
                let norm = |of: &mut dyn Iterator<Item = f64>| of.map(|x| x * x).sum::<f64>().sqrt();
                let size = norm(&mut row.iter().zip(scales).map(|(a, s)| a * s))
                    * norm(&mut x.iter().zip(scales).map(|(x, s)| x / s));
                assert!(g.abs() <= 1e-13 * size, "{g:e}");
            }
            for (l, other) in found.independent.iter().enumerate() {
                assert_eq!(x[*other], f64::from(u8::from(k == l)), "{own}");
            }
        }
        assert_eq!(NullSpace::of(&[], &[1.0, 1.0]).independent, [0, 1]);
    }
}
