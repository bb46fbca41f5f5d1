//! Profiles through the rows of a table that never leave them: straight lines, or monotone cubics.
//!
//! Between two rows, with s = (t − t_i)/h, the cubic with the slopes m and n at its ends is
//!
//! ```text
//! f = f_i + h s [m + s (3δ − 2m − n + s (m + n − 2δ))],   δ = (f_{i+1} − f_i)/h
//! ```
//!
//! Straight lines have m = n = δ. Monotone cubics have at a row the weighted harmonic mean of the δ on both sides, and 0
//! where these differ in sign: between two rows the cubic then lies between their values.
//!
//! Source: F. N. Fritsch and J. Butland, *SIAM J. Sci. Stat. Comput.* 5 (1984) 300–304, doi:10.1137/0905021.

use super::{Profile, ProfileError, checked_rows};

/// Straight lines or monotone cubics through rows (t, f). Every row is a break: of f′ or of f″.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    times: Vec<f64>,
    values: Vec<f64>,
    /// Slopes at both ends of each piece.
    slopes: Vec<[f64; 2]>,
    /// ∫ from the first row to each row.
    sums: Vec<f64>,
    /// ∫ from the first row to t = 0.
    origin: f64,
}

impl Pieces {
    /// Straight lines through at least 2 rows (t \[s\], f) with strictly ascending finite times.
    ///
    /// # Errors
    /// [`ProfileError::Row`] or [`ProfileError::TooFewRows`].
    pub fn linear(rows: &[(f64, f64)]) -> Result<Pieces, ProfileError> {
        Pieces::new(rows, |d, _| d.iter().map(|d| [*d, *d]).collect())
    }

    /// Monotone cubics through the same.
    ///
    /// # Errors
    /// As [`Pieces::linear`].
    pub fn monotone(rows: &[(f64, f64)]) -> Result<Pieces, ProfileError> {
        Pieces::new(rows, |d, h| {
            let last = d.len() - 1;
            let mut at_rows = vec![d[0]; d.len() + 1];
            at_rows[last + 1] = d[last];
            for i in 1..d.len() {
                let (a, b) = (2.0 * h[i] + h[i - 1], h[i] + 2.0 * h[i - 1]);
                let monotone = d[i - 1] * d[i] > 0.0;
                at_rows[i] = if monotone { (a + b) / (a / d[i - 1] + b / d[i]) } else { 0.0 };
            }
            at_rows.windows(2).map(|ends| [ends[0], ends[1]]).collect()
        })
    }

    fn new(
        rows: &[(f64, f64)],
        slopes: impl Fn(&[f64], &[f64]) -> Vec<[f64; 2]>,
    ) -> Result<Pieces, ProfileError> {
        let (times, values) = checked_rows(rows, 2)?;
        let h: Vec<f64> = times.windows(2).map(|t| t[1] - t[0]).collect();
        let d: Vec<f64> = values.windows(2).zip(&h).map(|(f, h)| (f[1] - f[0]) / h).collect();
        let slopes = slopes(&d, &h);
        let mut pieces = Pieces { sums: vec![0.0; times.len()], times, values, slopes, origin: 0.0 };
        for i in 1..pieces.times.len() {
            pieces.sums[i] = pieces.sums[i - 1] + pieces.piece_integral(i - 1, pieces.times[i]);
        }
        pieces.origin = pieces.since_first(0.0);
        Ok(pieces)
    }

    /// The piece in which t lies.
    fn piece(&self, t: f64) -> usize {
        self.times[1..self.times.len() - 1].partition_point(|row| *row <= t)
    }

    /// t − t_i and the coefficients of the cubic in it.
    fn cubic(&self, i: usize, t: f64) -> (f64, [f64; 4]) {
        let h = self.times[i + 1] - self.times[i];
        let [m, n] = self.slopes[i];
        let d = (self.values[i + 1] - self.values[i]) / h;
        (t - self.times[i], [self.values[i], m, (3.0 * d - 2.0 * m - n) / h, (m + n - 2.0 * d) / (h * h)])
    }

    fn piece_integral(&self, i: usize, t: f64) -> f64 {
        let (x, [a, b, c, d]) = self.cubic(i, t);
        x * (a + x * (b / 2.0 + x * (c / 3.0 + x * d / 4.0)))
    }

    fn since_first(&self, t: f64) -> f64 {
        let i = self.piece(t);
        self.sums[i] + self.piece_integral(i, t)
    }
}

impl Profile for Pieces {
    fn value(&self, t: f64) -> f64 {
        let (x, [a, b, c, d]) = self.cubic(self.piece(t), t);
        a + x * (b + x * (c + x * d))
    }

    fn rate(&self, t: f64) -> f64 {
        let (x, [_, b, c, d]) = self.cubic(self.piece(t), t);
        b + x * (2.0 * c + x * 3.0 * d)
    }

    fn acceleration(&self, t: f64) -> f64 {
        let (x, [_, _, c, d]) = self.cubic(self.piece(t), t);
        2.0 * c + 6.0 * d * x
    }

    fn integral(&self, t: f64) -> f64 {
        self.since_first(t) - self.origin
    }

    fn breaks(&self) -> &[f64] {
        &self.times
    }

    fn range(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks;
    use super::*;

    const ROWS: [(f64, f64); 6] = [(0.0, 0.0), (1.0, 0.0), (1.1, 1.0), (5.0, 1.0), (6.0, 3.0), (8.0, -1.0)];

    #[test]
    fn derivatives_and_integral_belong_to_the_values() {
        for pieces in [Pieces::linear(&ROWS), Pieces::monotone(&ROWS), Pieces::monotone(&ROWS[..2])] {
            let pieces = pieces.unwrap();
            checks::derivatives_and_integral(&pieces, pieces.range().1);
        }
    }

    #[test]
    fn values_lie_between_those_of_neighbouring_rows() {
        for pieces in [Pieces::linear(&ROWS), Pieces::monotone(&ROWS)] {
            let pieces = pieces.unwrap();
            for ends in ROWS.windows(2) {
                let ((a, f), (b, g)) = (ends[0], ends[1]);
                assert!((pieces.value(a) - f).abs() < 1e-15 && (pieces.value(b) - g).abs() < 1e-15);
                for k in 0..=100 {
                    let y = pieces.value(a + (b - a) * f64::from(k) / 100.0);
                    assert!(y >= f.min(g) - 1e-12 && y <= f.max(g) + 1e-12, "{y} between {f} and {g}");
                }
            }
        }
    }

    #[test]
    fn cubics_are_smooth_and_lines_are_straight() {
        let (line, cubic) = (Pieces::linear(&ROWS).unwrap(), Pieces::monotone(&ROWS).unwrap());
        assert_eq!((line.value(0.5), line.value(5.5), line.rate(5.5)), (0.0, 2.0, 2.0));
        for (t, _) in &ROWS[1..5] {
            assert!((cubic.rate(*t) - cubic.rate(t.next_down())).abs() < 1e-9);
        }
    }

    #[test]
    fn the_error_of_monotone_cubics_falls_with_the_square_of_the_spacing_at_least() {
        let error = |n: i32| {
            let rows: Vec<_> = (0..=n).map(|k| f64::from(k) / f64::from(n)).map(|t| (t, t.exp())).collect();
            let pieces = Pieces::monotone(&rows).unwrap();
            (0..=1000)
                .map(|k| f64::from(k) / 1000.0)
                .map(|t| (pieces.value(t) - t.exp()).abs())
                .fold(0.0, f64::max)
        };
        assert!(error(10) < 4e-3 && error(20) < error(10) / 3.5, "{} {}", error(10), error(20));
    }

    #[test]
    fn what_makes_no_table_is_refused() {
        for rows in [&ROWS[..1], &[(0.0, 1.0), (0.0, 2.0)], &[(0.0, f64::NAN), (1.0, 2.0)]] {
            assert!(Pieces::linear(rows).is_err() && Pieces::monotone(rows).is_err());
        }
    }
}
