//! Profiles through the rows of a table: a C² cubic spline.
//!
//! Between t_i and t_{i+1}, h = t_{i+1} − t_i, with the second derivatives m at the rows,
//!
//! ```text
//! h_{i−1} m_{i−1} + 2 (h_{i−1} + h_i) m_i + h_i m_{i+1} = 6 (Δf_i/h_i − Δf_{i−1}/h_{i−1})
//! ```
//!
//! Source: C. de Boor, *A Practical Guide to Splines* (2001), chapter IV.

use super::{Profile, ProfileError, checked_rows};
use crate::quadrature::Gauss;

/// What closes the equations of the spline at the two ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum End {
    /// f‴ is continuous at the second and the last but one row: fourth-order accurate up to the ends.
    #[default]
    NotAKnot,
    /// f″ = 0 at the ends.
    Natural,
}

/// A cubic spline through rows (t, f). It is C²; its jumps of f‴ at the rows are not reported as breaks,
/// so that a finely sampled table does not dictate the steps. A spline overshoots where rows change abruptly.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<f64>,
    curvatures: Vec<f64>,
    /// ∫ from the first row to each row.
    sums: Vec<f64>,
    /// ∫ from the first row to t = 0.
    origin: f64,
    /// Rows at which steps should end.
    resolution: Vec<f64>,
}

/// What three points may miss between two rows of the resolution, over the sum of |Δ∫f| and of |Δf| from row to row there,
/// and over these of the whole table.
const SEEN: (f64, f64) = (0.05, 1e-6);

impl Table {
    /// The spline through at least 3 rows (t \[s\], f) with strictly ascending finite times.
    ///
    /// # Errors
    /// [`ProfileError::Row`] or [`ProfileError::TooFewRows`].
    pub fn new(rows: &[(f64, f64)], end: End) -> Result<Table, ProfileError> {
        let (times, values) = checked_rows(rows, 3)?;
        let curvatures = second_derivatives(&times, &values, end);
        let sums = vec![0.0; times.len()];
        let mut table = Table { sums, times, values, curvatures, origin: 0.0, resolution: Vec::new() };
        for i in 1..table.times.len() {
            table.sums[i] = table.sums[i - 1] + table.piece_integral(i - 1, table.times[i]);
        }
        table.origin = table.since_first(0.0);
        let mut resolution = Vec::new();
        table.resolve((0, table.times.len() - 1), &Gauss::new(3), &mut resolution);
        table.resolution = resolution;
        Ok(table)
    }

    /// Adds rows between two until three points see the spline and its derivative in between.
    fn resolve(&self, (i, j): (usize, usize), points: &Gauss, out: &mut Vec<f64>) {
        let sums = |of: &[f64]| of.windows(2).map(|f| (f[1] - f[0]).abs()).sum::<f64>();
        let is_seen = |of: &[f64], f: &dyn Fn(f64) -> f64| {
            let (size, (local, global)) = (sums(&of[i..=j]), SEEN);
            let found = points.integrate(self.times[i], self.times[j], f);
            let found_size = points.integrate(self.times[i], self.times[j], |t| f(t).abs());
            size <= global * sums(of)
                || (found - (of[j] - of[i])).abs() <= local * size && found_size >= 0.3 * size
        };
        if j - i > 1 && !(is_seen(&self.sums, &|t| self.value(t)) && is_seen(&self.values, &|t| self.rate(t)))
        {
            let middle = i.midpoint(j);
            self.resolve((i, middle), points, out);
            out.push(self.times[middle]);
            self.resolve((middle, j), points, out);
        }
    }

    /// How far the spline leaves the values of its rows, over their range: the largest excess at three points of each piece
    /// and the time of it \[s\].
    pub fn overshoot(&self) -> (f64, f64) {
        let least = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = self.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let places = self.times.windows(2).flat_map(|t| [0.25, 0.5, 0.75].map(|s| t[0] + s * (t[1] - t[0])));
        let excess = places.map(|t| ((self.value(t) - largest).max(least - self.value(t)), t));
        let (excess, time) = excess.fold((0.0, 0.0), |most, new| if new.0 > most.0 { new } else { most });
        (if excess > 0.0 { excess / (largest - least) } else { 0.0 }, time)
    }

    /// The piece in which t lies, and (t − t_i, t_{i+1} − t, h).
    fn piece(&self, t: f64) -> (usize, f64, f64, f64) {
        let i = self.times[1..self.times.len() - 1].partition_point(|&knot| knot <= t);
        let (a, b) = (self.times[i], self.times[i + 1]);
        (i, t - a, b - t, b - a)
    }

    /// ∫ from t_i to t on piece i.
    fn piece_integral(&self, i: usize, t: f64) -> f64 {
        let (h, s) = (self.times[i + 1] - self.times[i], t - self.times[i]);
        let (m, n) = (self.curvatures[i], self.curvatures[i + 1]);
        let slope = (self.values[i + 1] - self.values[i]) / h - h * (2.0 * m + n) / 6.0;
        s * (self.values[i] + s * (slope / 2.0 + s * (m / 6.0 + s * (n - m) / (24.0 * h))))
    }

    fn since_first(&self, t: f64) -> f64 {
        let i = self.piece(t).0;
        self.sums[i] + self.piece_integral(i, t)
    }
}

/// m at the rows: one sweep of elimination; the equations are diagonally dominant for both ends.
fn second_derivatives(t: &[f64], f: &[f64], end: End) -> Vec<f64> {
    let n = t.len();
    let h = |i: usize| t[i + 1] - t[i];
    let bend = |i: usize| 6.0 * ((f[i + 1] - f[i]) / h(i) - (f[i] - f[i - 1]) / h(i - 1));
    if n == 3 && end == End::NotAKnot {
        return vec![bend(1) / (3.0 * (h(0) + h(1))); 3]; // the parabola through three rows
    }
    let (mut diagonal, mut m) = (vec![0.0; n], vec![0.0; n]);
    let mut upper = vec![0.0; n];
    for i in 1..n - 1 {
        let (before, after) = (h(i - 1), h(i));
        let (mut lower, mut middle, mut next) = (before, 2.0 * (before + after), after);
        if end == End::NotAKnot && i == 1 {
            // m_0 = m_1 + (m_1 − m_2) h_0/h_1
            middle += before * (1.0 + before / after);
            next -= before * before / after;
        }
        if end == End::NotAKnot && i == n - 2 {
            middle += after * (1.0 + after / before);
            lower -= after * after / before;
        }
        let factor = if i == 1 { 0.0 } else { lower / diagonal[i - 1] };
        diagonal[i] = middle - factor * upper[i - 1];
        upper[i] = next;
        m[i] = bend(i) - factor * m[i - 1];
    }
    for i in (1..n - 1).rev() {
        let next = if i == n - 2 { 0.0 } else { upper[i] * m[i + 1] };
        m[i] = (m[i] - next) / diagonal[i];
    }
    if end == End::NotAKnot {
        m[0] = m[1] + (m[1] - m[2]) * h(0) / h(1);
        m[n - 1] = m[n - 2] + (m[n - 2] - m[n - 3]) * h(n - 2) / h(n - 3);
    }
    m
}

impl Profile for Table {
    fn value(&self, t: f64) -> f64 {
        let (i, a, b, h) = self.piece(t);
        let (m, n) = (self.curvatures[i], self.curvatures[i + 1]);
        (self.values[i] * b + self.values[i + 1] * a) / h
            - a * b / 6.0 * (m * (1.0 + b / h) + n * (1.0 + a / h))
    }

    fn rate(&self, t: f64) -> f64 {
        let (i, a, b, h) = self.piece(t);
        let (m, n) = (self.curvatures[i], self.curvatures[i + 1]);
        (self.values[i + 1] - self.values[i]) / h + (n * a * a - m * b * b) / (2.0 * h) - h * (n - m) / 6.0
    }

    fn acceleration(&self, t: f64) -> f64 {
        let (i, a, b, h) = self.piece(t);
        (self.curvatures[i] * b + self.curvatures[i + 1] * a) / h
    }

    fn integral(&self, t: f64) -> f64 {
        self.since_first(t) - self.origin
    }

    fn resolution(&self) -> &[f64] {
        &self.resolution
    }

    fn range(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }
}

#[cfg(test)]
mod tests {
    use super::super::{checks, covers};
    use super::*;

    const TIMES: [f64; 6] = [0.0, 0.4, 0.5, 1.3, 2.0, 3.0];

    #[test]
    fn derivatives_and_integral_belong_to_the_values() {
        let rows: Vec<_> = TIMES.iter().map(|&t| (t, (2.0 * t).sin())).collect();
        for end in [End::NotAKnot, End::Natural] {
            for rows in [&rows[..], &rows[..4], &rows[..3]] {
                let table = Table::new(rows, end).unwrap();
                for &(t, f) in rows {
                    assert!((table.value(t) - f).abs() < 1e-15, "row at {t}");
                }
                // Differences across a row would straddle the jump of f‴.
                struct Parts(Table, Vec<f64>);
                impl std::fmt::Debug for Parts {
                    fn fmt(&self, _: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                        Ok(())
                    }
                }
                impl Profile for Parts {
                    fn value(&self, t: f64) -> f64 {
                        self.0.value(t)
                    }
                    fn rate(&self, t: f64) -> f64 {
                        self.0.rate(t)
                    }
                    fn acceleration(&self, t: f64) -> f64 {
                        self.0.acceleration(t)
                    }
                    fn integral(&self, t: f64) -> f64 {
                        self.0.integral(t)
                    }
                    fn breaks(&self) -> &[f64] {
                        &self.1
                    }
                }
                let knots: Vec<f64> = rows.iter().map(|row| row.0).collect();
                let duration = knots[knots.len() - 1];
                checks::derivatives_and_integral(&Parts(table, knots), duration);
            }
        }
    }

    #[test]
    fn first_and_second_derivative_are_continuous_at_the_rows() {
        let rows: Vec<_> = TIMES.iter().map(|&t| (t, (2.0 * t).sin())).collect();
        for end in [End::NotAKnot, End::Natural] {
            let table = Table::new(&rows, end).unwrap();
            for t in &TIMES[1..5] {
                let (before, after) = (t - 1e-9, t + 1e-9);
                assert!((table.rate(before) - table.rate(after)).abs() < 1e-7);
                assert!((table.acceleration(before) - table.acceleration(after)).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn not_a_knot_reproduces_cubics_and_three_rows_a_parabola() {
        let cubic = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t + 0.3 * t * t * t;
        let table = Table::new(&TIMES.map(|t| (t, cubic(t))), End::NotAKnot).unwrap();
        let parabola = |t: f64| 1.0 - 2.0 * t + 0.5 * t * t;
        let three = Table::new(&[0.0, 1.0, 3.0].map(|t| (t, parabola(t))), End::NotAKnot).unwrap();
        for k in 0..=30 {
            let t = 0.1 * k as f64;
            assert!((table.value(t) - cubic(t)).abs() < 1e-13, "{t}");
            assert!((table.acceleration(t) - 1.0 - 1.8 * t).abs() < 1e-11, "{t}");
            assert!((three.value(t) - parabola(t)).abs() < 1e-14, "{t}");
        }
    }

    #[test]
    fn natural_ends_do_not_bend() {
        let table = Table::new(&TIMES.map(|t| (t, t.exp())), End::Natural).unwrap();
        assert_eq!((table.acceleration(0.0), table.acceleration(3.0)), (0.0, 0.0));
    }

    #[test]
    fn error_falls_with_the_fourth_power_of_the_spacing() {
        let error = |n: usize| {
            let rows: Vec<_> =
                (0..=n).map(|i| 3.0 * i as f64 / n as f64).map(|t| (t, (2.0 * t).sin())).collect();
            let table = Table::new(&rows, End::NotAKnot).unwrap();
            (0..=1000)
                .map(|k| 0.003 * k as f64)
                .fold(0.0_f64, |m, t| m.max((table.value(t) - (2.0 * t).sin()).abs()))
        };
        let order = (error(40) / error(80)).log2();
        assert!((order - 4.0).abs() < 0.4, "order {order}");
    }

    #[test]
    fn rows_that_make_no_table_are_named_and_a_longer_run_is_refused() {
        let bad = Table::new(&[(0.0, 1.0), (1.0, 2.0), (1.0, 3.0)], End::NotAKnot).unwrap_err();
        assert!(bad.to_string().contains("row 3"), "{bad}");
        assert!(Table::new(&[(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0)], End::NotAKnot).is_err());
        assert!(Table::new(&[(0.0, 1.0), (1.0, 2.0)], End::Natural).is_err());
        let table = Table::new(&[(0.0, 1.0), (1.0, 2.0), (2.0, 3.0)], End::NotAKnot).unwrap();
        assert!(covers(&table, 2.0).is_ok() && covers(&table, 2.1).is_err());
    }

    #[test]
    fn an_overshoot_is_measured_and_a_spike_is_resolved() {
        let (overshoot, time) =
            Table::new(&[(0.0, 0.0), (1.0, 0.0), (1.1, 1.0), (5.0, 1.0), (20.0, 1.0)], End::NotAKnot)
                .unwrap()
                .overshoot();
        assert!(overshoot > 10.0 && time > 5.0, "{overshoot} at {time}");
        let wave = |k: i32| f64::from(k) / 10.0;
        let sine: Vec<_> = (0..=100).map(|k| (wave(k), wave(k).sin())).collect();
        let table = Table::new(&sine, End::NotAKnot).unwrap();
        assert!(table.overshoot().0 < 1e-3 && table.resolution().len() < 10, "{:?}", table.resolution());
        let spike: Vec<_> = (0..=1000).map(|k| (wave(k), f64::from(u8::from(k == 500)))).collect();
        let times = Table::new(&spike, End::NotAKnot).unwrap().resolution().to_vec();
        let near = times.iter().filter(|t| (*t - 50.0).abs() < 0.15).count();
        assert!(near >= 2 && times.len() < 60, "{times:?}");
    }
}
