//! Sections tabulated along the beam.
//!
//! Between two rows each resultant is a straight line, or the cubic with slopes that keep it monotone: with
//! the lengths hᵢ and the divided differences δᵢ of the intervals, the slope at an inner row is
//!
//! ```text
//! 0 if δᵢ₋₁ δᵢ ≤ 0,  otherwise (w₁ + w₂)/(w₁/δᵢ₋₁ + w₂/δᵢ),   w₁ = 2hᵢ + hᵢ₋₁,  w₂ = hᵢ + 2hᵢ₋₁
//! ```
//!
//! and at an end the one-sided three-point difference, limited to keep the sign of δ and to 3δ. No value leaves
//! the range of its two rows. Two rows at one station make a jump; no interpolation crosses it.
//!
//! Source: F. N. Fritsch & J. Butland, *SIAM J. Sci. Stat. Comput.* 5 (1984) 300–304, doi:10.1137/0905021.

use super::{Resultants, Section, SectionError};

/// How values between two rows are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines.
    #[default]
    Linear,
    /// Monotone cubics, with continuous slopes.
    Cubic,
}

/// Stations between two rows at which the resultants of cubics are checked.
const CHECKS: usize = 8;

/// A tabulated section. Its formulas head the source file.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    stations: Vec<f64>,
    /// Values of each row: ρA, ρS, ρI, EA, ES, EI.
    values: Vec<[f64; 6]>,
    /// Slopes at the start and at the end of each interval; empty for straight lines.
    slopes: Vec<[[f64; 6]; 2]>,
    breaks: Vec<f64>,
    jumps: Vec<f64>,
}

impl Table {
    /// The section through rows (x \[m\], resultants) over a beam of the given length \[m\].
    ///
    /// # Errors
    /// [`SectionError::Invalid`] if there are fewer than two rows, if the stations do not ascend (three rows
    /// at one station are refused too) or do not cover the beam, or if the resultants of a row, or of a cubic
    /// between two rows, make no section.
    pub fn new(
        length: f64,
        rows: &[(f64, Resultants)],
        interpolation: Interpolation,
    ) -> Result<Table, SectionError> {
        let invalid = |message: String| Err(SectionError::Invalid(message));
        for (i, (x, resultants)) in rows.iter().enumerate() {
            let before = |back: usize| i.checked_sub(back).map(|j| rows[j].0);
            let ascends = before(1).is_none_or(|p| p <= *x) && before(2).is_none_or(|p| p < *x);
            if !(x.is_finite() && ascends) {
                return invalid(format!(
                    "row {} of the table of sections, at x = {x} m, does not ascend; two rows at one station make a jump, more are refused",
                    i + 1
                ));
            }
            if let Err(error) = resultants.validate() {
                return invalid(format!("row {} of the table of sections: {error}", i + 1));
            }
        }
        let (Some((first, _)), Some((last, _)), true) = (rows.first(), rows.last(), rows.len() > 1) else {
            return invalid(format!("a table of sections needs at least two rows and has {}", rows.len()));
        };
        if !(*first <= 1e-9 * length && *last >= (1.0 - 1e-9) * length) {
            return invalid(format!(
                "the table of sections runs from {first} m to {last} m and must cover the beam from 0 to {length} m"
            ));
        }
        let stations: Vec<f64> = rows.iter().map(|row| row.0).collect();
        let values: Vec<[f64; 6]> = rows.iter().map(|row| numbers(row.1)).collect();
        let slopes = match interpolation {
            Interpolation::Linear => Vec::new(),
            Interpolation::Cubic => monotone(&stations, &values),
        };
        let mut breaks: Vec<f64> = stations.iter().copied().filter(|&x| 0.0 < x && x < length).collect();
        let jumps = breaks.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        breaks.dedup();
        let table = Table { stations, values, slopes, breaks, jumps };
        // Straight lines between two positive definite rows are positive definite; cubics need not be.
        if interpolation == Interpolation::Cubic {
            for ends in table.stations.windows(2) {
                for k in 1..CHECKS {
                    let x = ends[0] + (ends[1] - ends[0]) * (k as f64 / CHECKS as f64);
                    if let Err(error) = table.resultants(x).validate() {
                        return invalid(format!(
                            "between the rows of the table of sections, at x = {x:.4} m: {error}; take linear interpolation or more rows"
                        ));
                    }
                }
            }
        }
        Ok(table)
    }
}

fn numbers(r: Resultants) -> [f64; 6] {
    [r.mass, r.first_moment, r.rotary_inertia, r.axial_stiffness, r.coupling_stiffness, r.bending_stiffness]
}

/// Slopes at both ends of every interval, run by run between jumps.
fn monotone(x: &[f64], f: &[[f64; 6]]) -> Vec<[[f64; 6]; 2]> {
    let length = |i: usize| x[i + 1] - x[i];
    let mut slopes = vec![[[0.0; 6]; 2]; x.len() - 1];
    for c in 0..6 {
        let difference = |i: usize| (f[i + 1][c] - f[i][c]) / length(i);
        let at_end = |near: usize, far: usize| {
            let (h, g, d, e) = (length(near), length(far), difference(near), difference(far));
            let slope = ((2.0 * h + g) * d - h * e) / (h + g);
            match (slope * d > 0.0, d * e > 0.0) {
                (false, _) => 0.0,
                (true, false) if slope.abs() > 3.0 * d.abs() => 3.0 * d,
                _ => slope,
            }
        };
        // Intervals of length zero are jumps: no neighbour beyond them.
        let exists = |i: usize| i + 1 < x.len() && length(i) > 0.0;
        for i in (0..x.len() - 1).filter(|&i| exists(i)) {
            let before = i.checked_sub(1).filter(|&j| exists(j));
            let after = Some(i + 1).filter(|&j| exists(j));
            let inner = |a: usize, b: usize| {
                let (h, g, d, e) = (length(a), length(b), difference(a), difference(b));
                let (w1, w2) = (2.0 * g + h, g + 2.0 * h);
                if d * e <= 0.0 { 0.0 } else { (w1 + w2) / (w1 / d + w2 / e) }
            };
            slopes[i][0][c] = match (before, after) {
                (Some(j), _) => inner(j, i),
                (None, Some(j)) => at_end(i, j),
                (None, None) => difference(i),
            };
            slopes[i][1][c] = match (after, before) {
                (Some(j), _) => inner(i, j),
                (None, Some(j)) => at_end(i, j),
                (None, None) => difference(i),
            };
        }
    }
    slopes
}

impl Section for Table {
    fn resultants(&self, x: f64) -> Resultants {
        let last = self.stations.len() - 2;
        // The interval to the right of x; at the last station the one to the left, unless it is a jump.
        let mut i = self.stations[1..=last].partition_point(|&end| end <= x);
        while i > 0 && self.stations[i + 1] == self.stations[i] {
            i -= 1;
        }
        let h = self.stations[i + 1] - self.stations[i];
        let s = if h > 0.0 { ((x - self.stations[i]) / h).clamp(0.0, 1.0) } else { 1.0 };
        let (a, b) = (&self.values[i], &self.values[i + 1]);
        let value = |c: usize| {
            let line = a[c] + s * (b[c] - a[c]);
            let Some([p, q]) = self.slopes.get(i) else { return line };
            // Cubic Hermite interpolation, as a deviation from the line.
            let rise = b[c] - a[c];
            line + s * (1.0 - s) * ((1.0 - s) * (h * p[c] - rise) - s * (h * q[c] - rise))
        };
        Resultants {
            mass: value(0),
            first_moment: value(1),
            rotary_inertia: value(2),
            axial_stiffness: value(3),
            coupling_stiffness: value(4),
            bending_stiffness: value(5),
        }
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn jumps(&self) -> &[f64] {
        &self.jumps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(x: f64, size: f64) -> (f64, Resultants) {
        let resultants = Resultants {
            mass: size,
            first_moment: 0.1 * size,
            rotary_inertia: size,
            axial_stiffness: 10.0 * size,
            coupling_stiffness: size,
            bending_stiffness: 3.0 * size,
        };
        (x, resultants)
    }

    #[test]
    fn straight_lines_join_the_rows_and_end_cells_there() {
        let table =
            Table::new(3.0, &[row(0.0, 1.0), row(1.0, 3.0), row(3.0, 2.0)], Interpolation::Linear).unwrap();
        assert_eq!(table.breaks(), [1.0]);
        for (x, size) in [(0.0, 1.0), (0.25, 1.5), (1.0, 3.0), (2.0, 2.5), (3.0, 2.0), (4.0, 2.0)] {
            let (found, expected) = (numbers(table.resultants(x)), numbers(row(x, size).1));
            for (found, expected) in found.into_iter().zip(expected) {
                assert!((found - expected).abs() < 1e-15 * expected.abs() * 4.0, "{x}: {found} {expected}");
            }
        }
    }

    #[test]
    fn two_rows_at_one_station_make_a_jump_for_both_interpolations() {
        let rows = [row(0.0, 1.0), row(1.0, 3.0), row(1.0, 5.0), row(2.0, 6.0), row(3.0, 7.0), row(3.0, 9.0)];
        for interpolation in [Interpolation::Linear, Interpolation::Cubic] {
            let table = Table::new(3.0, &rows, interpolation).unwrap();
            assert_eq!((table.breaks(), table.jumps()), (&[1.0, 2.0][..], &[1.0][..]));
            for (x, size) in [(1.0 - 1e-12, 3.0), (1.0, 5.0), (1.5, 5.5), (2.5, 6.5), (3.0, 7.0)] {
                let found = table.resultants(x).mass;
                assert!((found - size).abs() < 1e-10, "{interpolation:?} {x}: {found}");
            }
        }
    }

    #[test]
    fn cubics_stay_within_their_rows_and_have_continuous_slopes() {
        let sizes = [1.0, 1.1, 5.0, 5.0, 4.9, 1.0];
        let rows: Vec<_> = sizes.iter().enumerate().map(|(i, &s)| row((i * i) as f64, s)).collect();
        let table = Table::new(25.0, &rows, Interpolation::Cubic).unwrap();
        for i in 0..5 {
            let (a, b) = (rows[i].0, rows[i + 1].0);
            let (low, high) = (sizes[i].min(sizes[i + 1]), sizes[i].max(sizes[i + 1]));
            for k in 0..=20 {
                let found = table.resultants(a + (b - a) * k as f64 / 20.0).mass;
                assert!((low - 1e-14..=high + 1e-14).contains(&found), "{i} {k}: {found}");
            }
        }
        for x in [1.0, 4.0, 9.0, 16.0] {
            let (at, d) = (|x: f64| table.resultants(x).mass, 1e-6);
            let (left, right) = ((at(x) - at(x - d)) / d, (at(x + d) - at(x)) / d);
            assert!((left - right).abs() < 2e-5, "slopes at {x}: {left} {right}");
        }
    }

    #[test]
    fn cubics_converge_to_a_smooth_section_with_order_three_or_more() {
        let size = |x: f64| 2.0 + (1.3 * x).exp();
        let error = |count: usize| {
            let rows: Vec<_> =
                (0..=count).map(|i| 2.0 * i as f64 / count as f64).map(|x| row(x, size(x))).collect();
            let table = Table::new(2.0, &rows, Interpolation::Cubic).unwrap();
            (0..400)
                .map(|k| k as f64 / 200.0)
                .fold(0.0_f64, |most, x| most.max((table.resultants(x).mass - size(x)).abs()))
        };
        let order = (error(20) / error(40)).log2();
        assert!(order > 2.7, "order {order:.2}");
    }

    #[test]
    fn tables_that_make_no_section_are_refused_by_row() {
        for (rows, says) in [
            (vec![], "at least two rows"),
            (vec![row(0.0, 1.0)], "at least two rows"),
            (vec![row(0.0, 1.0), row(2.0, 1.0)], "cover the beam"),
            (vec![row(0.5, 1.0), row(3.0, 1.0)], "cover the beam"),
            (vec![row(0.0, 1.0), row(2.0, 1.0), row(1.0, 1.0), row(3.0, 1.0)], "row 3"),
            (vec![row(0.0, 1.0), row(1.0, 1.0), row(1.0, 1.0), row(1.0, 1.0), row(3.0, 1.0)], "row 4"),
            (vec![row(0.0, 1.0), row(3.0, -1.0)], "row 2"),
            (vec![row(0.0, 1.0), row(f64::NAN, 1.0), row(3.0, 1.0)], "row 2"),
        ] {
            let message = Table::new(3.0, &rows, Interpolation::Linear).unwrap_err().to_string();
            assert!(message.contains(says), "{message}");
        }
    }
}
