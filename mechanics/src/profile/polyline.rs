//! Profiles through the rows of a table by straight lines.

use super::{Profile, ProfileError, checked_rows};

/// Straight lines between rows (x, f), constant before the first and behind the last. Every row is a break.
#[derive(Clone, Debug, PartialEq)]
pub struct Polyline {
    abscissae: Vec<f64>,
    values: Vec<f64>,
    /// ∫ from the first row to each row.
    sums: Vec<f64>,
}

impl Polyline {
    /// The lines through at least one row, with strictly ascending finite abscissae.
    ///
    /// # Errors
    /// [`ProfileError::Row`] or [`ProfileError::TooFewRows`].
    pub fn new(rows: &[(f64, f64)]) -> Result<Polyline, ProfileError> {
        let (abscissae, values) = checked_rows(rows, 1)?;
        let mut sums = vec![0.0; abscissae.len()];
        for i in 1..abscissae.len() {
            sums[i] = sums[i - 1] + 0.5 * (values[i - 1] + values[i]) * (abscissae[i] - abscissae[i - 1]);
        }
        Ok(Polyline { abscissae, values, sums })
    }

    /// Number of rows at or before x.
    fn passed(&self, x: f64) -> usize {
        self.abscissae.partition_point(|p| *p <= x)
    }

    fn slope(&self, i: usize) -> f64 {
        (self.values[i + 1] - self.values[i]) / (self.abscissae[i + 1] - self.abscissae[i])
    }

    /// ∫ from the first row to x.
    fn since_first(&self, x: f64) -> f64 {
        match self.passed(x) {
            0 => self.values[0] * (x - self.abscissae[0]),
            i => self.sums[i - 1] + 0.5 * (self.values[i - 1] + self.value(x)) * (x - self.abscissae[i - 1]),
        }
    }
}

impl Profile for Polyline {
    fn value(&self, x: f64) -> f64 {
        match self.passed(x) {
            0 => self.values[0],
            i if i == self.abscissae.len() => self.values[i - 1],
            i => self.values[i - 1] + self.slope(i - 1) * (x - self.abscissae[i - 1]),
        }
    }

    fn rate(&self, x: f64) -> f64 {
        match self.passed(x) {
            0 => 0.0,
            i if i == self.abscissae.len() => 0.0,
            i => self.slope(i - 1),
        }
    }

    fn acceleration(&self, _x: f64) -> f64 {
        0.0
    }

    fn integral(&self, x: f64) -> f64 {
        self.since_first(x) - self.since_first(0.0)
    }

    fn breaks(&self) -> &[f64] {
        &self.abscissae
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks;
    use super::*;

    #[test]
    fn lines_meet_their_rows_and_derivatives_belong_to_the_values() {
        let line = Polyline::new(&[(0.5, 1.0), (1.0, 3.0), (2.0, -1.0)]).unwrap();
        assert_eq!([0.0, 0.5, 0.75, 1.5, 2.0, 9.0].map(|x| line.value(x)), [1.0, 1.0, 2.0, 1.0, -1.0, -1.0]);
        checks::derivatives_and_integral(&line, 3.0);
        assert!(Polyline::new(&[(0.0, 1.0), (0.0, 2.0)]).is_err() && Polyline::new(&[]).is_err());
    }
}
