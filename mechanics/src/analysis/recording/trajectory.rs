//! What a run recorded: one row of channel values for each recorded time.

use crate::system::{Channel, Kind, Role};
use std::ops::Range;

/// Components of a quaternion.
pub(in crate::analysis) const COMPONENTS: usize = 4;
/// No value between the rows.
const NOTHING_PASSED: [(f64, f64); 2] = [(0.0, f64::INFINITY), (0.0, f64::NEG_INFINITY)];
/// Component of a unit quaternion that is no rounding.
const CERTAIN: f64 = 1e-6;

/// Recorded times and, for each, one value of every channel.
///
/// Row i holds the values at `times()[i]`; rows are stored one after another.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    channels: Vec<Channel>,
    times: Vec<f64>,
    rows: Vec<f64>,
    /// Smallest and largest value of a channel between the rows, with their times.
    passed: Vec<[(f64, f64); 2]>,
}

/// Smallest, largest and last value of one channel, over the values that are finite numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Smallest value, in the channel's unit; NaN when no value is finite.
    pub min: f64,
    /// Time at which `min` first occurs \[s\].
    pub t_min: f64,
    /// Largest value, in the channel's unit; NaN when no value is finite.
    pub max: f64,
    /// Time at which `max` first occurs \[s\].
    pub t_max: f64,
    /// Last recorded value, finite or not; NaN when nothing was recorded.
    pub last: f64,
    /// Time of the first value that is not finite \[s\], if there is one.
    pub not_finite: Option<f64>,
}

impl Extremes {
    /// Largest absolute value; NaN when no value is finite.
    pub fn largest(&self) -> f64 {
        self.min.abs().max(self.max.abs())
    }

    /// Largest less smallest value; NaN when no value is finite.
    pub fn range(&self) -> f64 {
        self.max - self.min
    }
}

/// Chooses between the signs of the unit quaternions that begin in the columns `first` of a row: each is continued from the row before; where
/// that has none, the first component that is not zero is positive.
pub(super) fn continue_quaternions(first: &[usize], before: &[f64], now: &mut [f64]) {
    for &i in first {
        let of = i..i + COMPONENTS;
        let now = &mut now[of.clone()];
        let cosine: f64 = before.get(of).map_or(0.0, |q| q.iter().zip(&*now).map(|(a, b)| a * b).sum());
        let turned = if cosine == 0.0 {
            now.iter().find(|x| x.abs() > CERTAIN).is_some_and(|x| *x < 0.0)
        } else {
            cosine < 0.0
        };
        if turned {
            now.iter_mut().for_each(|x| *x = -*x);
        }
    }
}

/// The vertex of the parabola through three points, if it lies between them.
pub(super) fn vertex([(t0, a), (t1, b), (t2, c)]: [(f64, f64); 3]) -> Option<(f64, f64)> {
    let (first, second) = ((b - a) / (t1 - t0), (c - b) / (t2 - t1));
    let bend = (second - first) / (t2 - t0);
    let t = 0.5 * (t0 + t1) - 0.5 * first / bend;
    (first * second < 0.0 && t0 < t && t < t2).then_some((t, a + (t - t0) * (first + bend * (t - t1))))
}

impl Trajectory {
    /// An empty trajectory of the given channels, whose names must differ from one another and
    /// from `time`, the name of the first column in files.
    pub fn new(channels: Vec<Channel>) -> Trajectory {
        let passed = vec![NOTHING_PASSED; channels.len()];
        Trajectory { channels, times: Vec::new(), rows: Vec::new(), passed }
    }

    /// Reserves memory for `rows` more rows, so that recording them allocates nothing.
    pub fn reserve(&mut self, rows: usize) {
        self.times.reserve(rows);
        self.rows.reserve(rows.saturating_mul(self.channels.len()));
    }

    /// Appends a row at time `t` \[s\]: `write` receives the row, zeroed, one entry for each channel,
    /// e.g. `trajectory.push(state.t, |row| system.record(&state, row))`.
    pub fn push(&mut self, t: f64, write: impl FnOnce(&mut [f64])) {
        let start = self.rows.len();
        self.times.push(t);
        self.rows.resize(start + self.channels.len(), 0.0);
        write(&mut self.rows[start..]);
    }

    /// First of the four columns of each unit quaternion.
    pub fn quaternions(&self) -> Vec<usize> {
        let mut first = Vec::new();
        let mut rest = 0;
        for (i, columns) in self.channels.windows(COMPONENTS).enumerate() {
            if i >= rest && columns.iter().all(|c| c.kind == Kind::Quaternion) {
                first.push(i);
                rest = i + COMPONENTS;
            }
        }
        first
    }

    /// First column of the unit quaternion that the column at `index` is a component of.
    pub(in crate::analysis) fn quaternion_of(&self, index: usize) -> Option<usize> {
        let first = (self.channels[index].kind == Kind::Quaternion).then(|| self.quaternions())?;
        first.into_iter().find(|first| (*first..first + COMPONENTS).contains(&index))
    }

    /// Chooses between the signs of unit quaternions, which mean the same rotation, in some rows: each is continued from
    /// the row before; in the first row the first component that is not zero is positive. `first` are their
    /// [columns](Trajectory::quaternions).
    pub fn continue_quaternions(&mut self, first: &[usize], rows: Range<usize>) {
        let width = self.channels.len();
        for row in rows {
            let (before, now) = self.rows.split_at_mut(row * width);
            let last = before.len().saturating_sub(width);
            continue_quaternions(first, &before[last..], &mut now[..width]);
        }
    }

    /// Takes a value of the channel at `index` at time `t` \[s\] that is between the rows: it counts for the extremes.
    pub fn pass(&mut self, index: usize, t: f64, y: f64) {
        let [low, high] = &mut self.passed[index];
        if y.is_finite() && y < low.1 {
            *low = (t, y);
        }
        if y.is_finite() && y > high.1 {
            *high = (t, y);
        }
    }

    /// Leaves out the rows at `t` \[s\] and later, and what was passed between rows.
    pub fn cut(&mut self, t: f64) {
        let rows = self.times.partition_point(|time| *time < t);
        self.times.truncate(rows);
        self.rows.truncate(rows * self.channels.len());
        self.passed.fill(NOTHING_PASSED);
    }

    /// Says what the channel at `index` is, of a trajectory that was read.
    pub fn describe(&mut self, index: usize, role: Role, kind: Kind) {
        if let Some(channel) = self.channels.get_mut(index) {
            (channel.role, channel.kind) = (role, kind);
        }
    }

    /// The recorded channels, in column order.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The recorded times \[s\].
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether nothing was recorded.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// The rows with their times, in the order in which they were recorded.
    pub fn rows(&self) -> impl Iterator<Item = (f64, &[f64])> {
        let width = self.channels.len();
        self.times.iter().enumerate().map(move |(i, &t)| (t, &self.rows[i * width..(i + 1) * width]))
    }

    /// Index of the channel called `name`.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.channels.iter().position(|c| c.name == name)
    }

    /// Indices of the channels with this role.
    pub fn with_role(&self, role: Role) -> impl Iterator<Item = usize> {
        self.channels.iter().enumerate().filter(move |(_, c)| c.role == role).map(|(i, _)| i)
    }

    /// Values of the channel at `index`, in time order; nothing for an index out of range.
    pub fn values(&self, index: usize) -> impl Iterator<Item = f64> {
        let width = self.channels.len();
        let taken = if index < width { self.len() } else { 0 };
        self.rows.iter().skip(index).step_by(width.max(1)).take(taken).copied()
    }

    /// Values of the channel called `name`, or `None` when there is none of that name.
    pub fn column(&self, name: &str) -> Option<Vec<f64>> {
        self.index(name).map(|i| self.values(i).collect())
    }

    /// Extremes of the channel at `index`, between the rows too where a run has [passed](Trajectory::pass) them; the first of
    /// equal values counts.
    pub fn extremes(&self, index: usize) -> Extremes {
        let nan = f64::NAN;
        let mut e = Extremes { min: nan, t_min: nan, max: nan, t_max: nan, last: nan, not_finite: None };
        for (&t, y) in self.times.iter().zip(self.values(index)) {
            e.last = y;
            if !y.is_finite() {
                e.not_finite = e.not_finite.or(Some(t));
                continue;
            }
            // A comparison with NaN is false: the negated form lets the first value in.
            if e.min.is_nan() || y < e.min {
                (e.min, e.t_min) = (y, t);
            }
            if e.max.is_nan() || y > e.max {
                (e.max, e.t_max) = (y, t);
            }
        }
        if let Some([low, high]) = self.passed.get(index) {
            if low.1 < e.min {
                (e.t_min, e.min) = *low;
            }
            if high.1 > e.max {
                (e.t_max, e.max) = *high;
            }
        }
        e
    }

    /// Extremes of the channel at `index` over the records from one time to another \[s\], with the vertices of the parabolas through three of them.
    pub fn extremes_within(&self, index: usize, from: f64, to: f64) -> Extremes {
        let inside = |(_, t): &(usize, &f64)| (from..=to).contains(*t);
        let rows = self.times.iter().enumerate().filter(inside).map(|(row, _)| row);
        let mut part = Trajectory::new(vec![self.channels[index].clone()]);
        let at = |row: usize| (self.times[row], self.rows[row * self.channels.len() + index]);
        for row in rows {
            let (t, y) = at(row);
            part.push(t, |of| of[0] = y);
            if row > 0
                && row + 1 < self.times.len()
                && let Some((t, y)) = vertex([at(row - 1), (t, y), at(row + 1)])
                && (from..=to).contains(&t)
            {
                part.pass(0, t, y);
            }
        }
        part.extremes(0)
    }

    /// The value of the channel at `index` at a time \[s\], on the line between two records; `None` outside of the records.
    pub fn at(&self, index: usize, time: f64) -> Option<f64> {
        let value = |row: usize| self.rows[row * self.channels.len() + index];
        let above = self.times.partition_point(|t| *t < time);
        let next = *self.times.get(above)?;
        if next == time {
            return Some(value(above));
        }
        let below = above.checked_sub(1)?;
        let part = (time - self.times[below]) / (next - self.times[below]);
        Some((1.0 - part) * value(below) + part * value(above))
    }

    /// The largest absolute value of each channel.
    pub fn peaks(&self) -> Vec<f64> {
        let mut peaks = vec![0.0_f64; self.channels.len()];
        for (_, row) in self.rows() {
            peaks.iter_mut().zip(row).for_each(|(peak, x)| *peak = peak.max(x.abs()));
        }
        for (peak, passed) in peaks.iter_mut().zip(&self.passed) {
            *peak =
                passed.iter().filter(|(_, y)| y.is_finite()).fold(*peak, |peak, (_, y)| peak.max(y.abs()));
        }
        peaks
    }

    /// Largest energy or work of the run \[J\].
    pub fn largest_energy(&self) -> f64 {
        let energies =
            [Role::Energy, Role::Work, Role::Imbalance].into_iter().flat_map(|r| self.with_role(r));
        energies.map(|i| self.extremes(i).largest()).fold(0.0, f64::max)
    }

    /// Largest value of the energy balance over the [largest energy](Trajectory::largest_energy), where it was recorded.
    pub fn relative_imbalance(&self) -> Option<f64> {
        let balance = self.extremes(self.with_role(Role::Imbalance).next()?);
        Some(balance.largest() / self.largest_energy()).filter(|x| x.is_finite())
    }

    /// The channel and time of the first value that is not a finite number, if there is one.
    pub fn first_not_finite(&self) -> Option<(&Channel, f64)> {
        self.rows().find_map(|(t, row)| {
            let i = row.iter().position(|y| !y.is_finite())?;
            self.channels.get(i).map(|c| (c, t))
        })
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::analysis::recording) fn channel(name: &str, unit: &'static str) -> Channel {
        Channel::new(Role::Detail, name, unit, format!("the {name}"))
    }

    /// Two channels: a cosine with its lowest point at t = 2 s, and a constant.
    fn sample() -> Trajectory {
        let mut t = Trajectory::new(vec![channel("tip.deflection", "m"), channel("hub.speed", "rad/s")]);
        for i in 0..=4 {
            let time = f64::from(i);
            t.push(time, |row| {
                row.copy_from_slice(&[libm::cos(std::f64::consts::FRAC_PI_2 * time), 4.0]);
            });
        }
        t
    }

    #[test]
    fn columns_are_what_was_recorded_row_by_row() {
        let t = sample();
        assert_eq!(t.len(), 5);
        assert_eq!(t.column("hub.speed"), Some(vec![4.0; 5]));
        assert_eq!(t.column("nothing"), None);
        assert_eq!(t.rows().nth(2).map(|(time, row)| (time, row[0], row[1])), Some((2.0, -1.0, 4.0)));
        assert_eq!(t.values(2).count(), 0);
    }

    #[test]
    fn extremes_of_a_cosine_are_the_first_of_its_equal_crests() {
        let e = sample().extremes(0);
        assert_eq!((e.min, e.t_min, e.max, e.t_max, e.last), (-1.0, 2.0, 1.0, 0.0, 1.0));
        let e = sample().extremes(1);
        assert_eq!((e.t_min, e.t_max, e.not_finite), (0.0, 0.0, None));
    }

    #[test]
    fn extremes_skip_what_is_not_finite_and_say_where_it_began() {
        let mut t = Trajectory::new(vec![channel("a", "m")]);
        for (time, y) in [(0.0, 1.0), (1.0, f64::NAN), (2.0, f64::INFINITY)] {
            t.push(time, |row| row[0] = y);
        }
        let e = t.extremes(0);
        assert_eq!((e.min, e.max, e.last, e.not_finite), (1.0, 1.0, f64::INFINITY, Some(1.0)));
        assert_eq!(t.first_not_finite().map(|(c, t)| (c.name.as_str(), t)), Some(("a", 1.0)));
        assert!(Trajectory::new(vec![channel("a", "m")]).extremes(0).min.is_nan());
    }
}
