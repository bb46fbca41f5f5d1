//! Stiffness, damping and mass tabulated along the beam.

use super::{Matrices, Matrix6, SectionError};

/// Part of the length within which a station is that of an end.
const SAME: f64 = 1e-6;

/// Matrices of sections along the beam. Every entry, in the axes of the section, is a straight line between two rows; two rows at one
/// station make a jump.
///
/// Straight lines between positive definite matrices are positive definite.
#[derive(Clone, Debug, PartialEq)]
pub struct MatrixTable {
    rows: Vec<(f64, Matrices)>,
    breaks: Vec<f64>,
    jumps: Vec<f64>,
}

impl MatrixTable {
    /// The sections through rows (s \[m\], matrices) over a beam of the given length \[m\].
    ///
    /// # Errors
    /// [`SectionError::Invalid`] names the row if there are fewer than two, if stations do not ascend (three rows at one station are
    /// refused too) or do not cover the beam, or if the matrices of a row are those of no section.
    pub fn new(length: f64, rows: &[(f64, Matrices)]) -> Result<MatrixTable, SectionError> {
        let invalid = |message: String| Err(SectionError::Invalid(message));
        for (i, (s, matrices)) in rows.iter().enumerate() {
            let before = |back: usize| i.checked_sub(back).map(|j| rows[j].0);
            let ascends = before(1).is_none_or(|p| p <= *s) && before(2).is_none_or(|p| p < *s);
            if !(s.is_finite() && ascends) {
                return invalid(format!(
                    "row {} of the table of matrices, at s = {s} m, does not ascend; two rows at one station make a jump, more are refused",
                    i + 1
                ));
            }
            if let Some(fault) = matrices.fault() {
                return invalid(format!("row {} of the table of matrices, at s = {s} m: {fault}", i + 1));
            }
        }
        let (Some((first, _)), Some((last, _)), true) = (rows.first(), rows.last(), rows.len() > 1) else {
            return invalid(format!("a table of matrices needs at least two rows and has {}", rows.len()));
        };
        if !(first.abs() <= SAME * length && (last - length).abs() <= SAME * length) {
            return invalid(format!(
                "the table of matrices runs from {first} m to {last} m, and must run from 0 to the length of the beam, {length} m"
            ));
        }
        let inside = |s: &f64| *s > SAME * length && *s < (1.0 - SAME) * length;
        let mut breaks: Vec<f64> = rows.iter().map(|row| row.0).filter(inside).collect();
        let jumps = breaks.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        breaks.dedup();
        Ok(MatrixTable { rows: rows.to_vec(), breaks, jumps })
    }

    /// The matrices at arc length `s` \[m\]; at a jump those behind it, at the tip those before it.
    pub fn at(&self, s: f64) -> Matrices {
        let i = self.interval(s);
        let (start, h) = (self.rows[i].0, self.rows[i + 1].0 - self.rows[i].0);
        self.between(i, if h > 0.0 { ((s - start) / h).clamp(0.0, 1.0) } else { 1.0 })
    }

    /// The number of the row before arc length `s` \[m\]; behind a jump where `s` is at one.
    pub fn interval(&self, s: f64) -> usize {
        let last = self.rows.len() - 2;
        let mut i = self.rows[1..=last].partition_point(|row| row.0 <= s);
        while i > 0 && self.rows[i + 1].0 == self.rows[i].0 {
            i -= 1;
        }
        i
    }

    /// The matrices a share x, 0 to 1, of the way from row `i` to the next.
    pub fn between(&self, i: usize, x: f64) -> Matrices {
        let (a, b) = (&self.rows[i].1, &self.rows[i + 1].1);
        let line = |a: &Matrix6, b: &Matrix6| {
            std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + x * (b[i][j] - a[i][j])))
        };
        Matrices {
            stiffness: line(&a.stiffness, &b.stiffness),
            damping: line(&a.damping, &b.damping),
            mass: line(&a.mass, &b.mass),
        }
    }

    /// The rows.
    pub fn rows(&self) -> &[(f64, Matrices)] {
        &self.rows
    }

    /// Stations inside the beam at which the matrices jump or kink, ascending.
    pub fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    /// Those of the breaks at which the matrices jump.
    pub fn jumps(&self) -> &[f64] {
        &self.jumps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(s: f64, size: f64) -> (f64, Matrices) {
        let stiffness = [9.0, 4.0, 3.0, 0.7, 1.1, 2.3].map(|x| size * x);
        let section = Matrices::principal(stiffness, size, [0.3, 0.1, 0.2].map(|x| size * x));
        (s, section.with_tension_centre([0.1, 0.2]).with_damping_times([0.01; 6]))
    }

    #[test]
    fn entries_are_straight_lines_between_rows_and_jump_where_a_station_stands_twice() {
        let rows = [row(0.0, 1.0), row(1.0, 3.0), row(1.0, 5.0), row(2.0, 6.0), row(3.0, 2.0)];
        let table = MatrixTable::new(3.0, &rows).unwrap();
        assert_eq!((table.breaks(), table.jumps()), (&[1.0, 2.0][..], &[1.0][..]));
        assert_eq!(table.rows(), rows);
        for (s, size) in [
            (-1.0, 1.0),
            (0.25, 1.5),
            (1.0 - 1e-12, 3.0),
            (1.0, 5.0),
            (1.5, 5.5),
            (2.5, 4.0),
            (3.0, 2.0),
            (4.0, 2.0),
        ] {
            let (found, expected) = (table.at(s), row(s, size).1);
            for (found, expected) in [
                (found.stiffness, expected.stiffness),
                (found.damping, expected.damping),
                (found.mass, expected.mass),
            ] {
                let pairs = found.as_flattened().iter().zip(expected.as_flattened());
                assert!(pairs.clone().all(|(a, b)| (a - b).abs() < 1e-10), "{s}: {found:?}");
            }
        }
        let jump_at_the_tip = [row(0.0, 1.0), row(3.0, 2.0), row(3.0, 7.0)];
        assert_eq!(MatrixTable::new(3.0, &jump_at_the_tip).unwrap().at(3.0).mass[0][0], 2.0);
    }

    #[test]
    fn tables_that_make_no_beam_are_refused_by_row() {
        for (rows, says) in [
            (vec![], "at least two rows and has 0"),
            (vec![row(0.0, 1.0)], "at least two rows and has 1"),
            (vec![row(0.0, 1.0), row(2.0, 1.0), row(1.0, 1.0), row(3.0, 1.0)], "row 3"),
            (vec![row(0.0, 1.0), row(1.0, 1.0), row(1.0, 1.0), row(1.0, 1.0), row(3.0, 1.0)], "row 4"),
            (vec![row(0.0, 1.0), row(2.0, 1.0)], "the length of the beam"),
            (vec![row(0.5, 1.0), row(3.0, 1.0)], "the length of the beam"),
            (vec![row(0.0, 1.0), row(f64::NAN, 1.0), row(3.0, 1.0)], "row 2"),
            (
                vec![row(0.0, 1.0), row(3.0, -1.0)],
                "row 2 of the table of matrices, at s = 3 m: the stiffness matrix",
            ),
        ] {
            let message = MatrixTable::new(3.0, &rows).unwrap_err().to_string();
            assert!(message.contains(says), "{message}");
        }
    }
}
