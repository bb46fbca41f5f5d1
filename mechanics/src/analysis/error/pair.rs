//! The difference of a column of two runs, and what is none.

use crate::analysis::recording::{COMPONENTS, Trajectory};
use crate::system::Role;

/// Part of the largest difference until then that a value may be off by at least: differences pass through zero.
const EARLIER: f64 = 0.25;
/// Largest difference over the largest value from which a value may be off by all of it.
const UNRESOLVED: f64 = 0.1;
/// Part of a time that rounding may have taken.
const SAME_TIME: f64 = 1e-9;
/// Part of the largest value of a column beyond which it is no longer trusted.
const DISTRUSTED: f64 = 0.1;

/// Largest value of a column, over the size of its unit, that counts as zero.
const VANISHING: f64 = 1e-9;
/// The same over the length of the model, or over one radian or a strain of one: what rounding leaves.
const ROUNDING: f64 = 1e-12;
/// The same of a secondary column: what the tolerances of an integration leave.
const SMALL: f64 = 1e-5;

/// Whether a column never differs from zero by more than rounding may: it has no relative error. Zero is judged by the
/// size of its kind: displacements and angles by the principal columns of their unit and the length `size` \[m\] of the model, others by the size of
/// their unit.
pub(super) fn vanishes(of: &Trajectory, index: usize, size: f64) -> bool {
    let channels = of.channels();
    let unit = channels[index].unit.as_ref();
    let principal = || largest(of, |i| channels[i].unit == unit && channels[i].role == Role::Primary);
    let zero = match unit {
        "m" => (VANISHING * principal()).max(ROUNDING * size),
        "rad" | "" => (VANISHING * principal()).max(ROUNDING),
        _ => VANISHING * size_of(unit, of, size),
    };
    of.extremes(index).largest() <= zero
}

/// Whether a column is small beside all others of its unit.
pub(super) fn is_small(of: &Trajectory, index: usize, size: f64) -> bool {
    of.extremes(index).largest() <= SMALL * size_of(&of.channels()[index].unit, of, size)
}

/// The size of a unit: the largest value that it has in any column; of a length that of the model, of a velocity also that which covers it in the time of
/// the run or at the largest angular velocity, of a moment also the largest energy, and of a momentum what the largest force makes in the time of the run.
fn size_of(unit: &str, of: &Trajectory, size: f64) -> f64 {
    let channels = of.channels();
    let counts = |i: usize| !matches!(channels[i].role, Role::Integration | Role::Imbalance);
    let own = |unit: &str| largest(of, |i| channels[i].unit == unit && counts(i));
    let times = of.times();
    let lasts = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
    let rate = |x: f64| if lasts > 0.0 { x / lasts } else { 0.0 };
    let other = match unit {
        "m" => size,
        "rad" | "" => 1.0,
        "m/s" => rate(size).max(size * own("rad/s")),
        "rad/s" => rate(1.0),
        "N*m" => own("J"),
        "kg*m/s" => lasts * own("N"),
        "kg*m^2/s" => lasts * own("N*m").max(own("J")),
        _ => 0.0,
    };
    own(unit).max(other)
}

/// The largest value of these columns.
fn largest(of: &Trajectory, which: impl Fn(usize) -> bool) -> f64 {
    (0..of.channels().len())
        .filter(|i| which(*i))
        .fold(0.0, |most: f64, i| most.max(of.extremes(i).largest()))
}

/// Estimated errors of one column, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnError {
    /// Name of the column.
    pub column: String,
    /// Error of mesh and time integration of the smallest value.
    pub min: f64,
    /// The same of the largest value.
    pub max: f64,
    /// The same of the last value.
    pub last: f64,
    /// The same at any recorded time.
    pub discretization: f64,
    /// Difference to the reference model, where there is one.
    pub model: Option<f64>,
}

/// A column of two runs over their common records.
///
/// A component of a unit quaternion is compared with that of the nearer of q and −q, which are one rotation.
#[derive(Clone, Copy, Debug)]
pub struct Pair<'a> {
    pub(super) ours: &'a Trajectory,
    pub(super) index: usize,
    theirs: &'a Trajectory,
    other: usize,
    /// The first columns of the unit quaternion that the column belongs to, in both.
    quaternion: Option<[usize; 2]>,
}

impl<'a> Pair<'a> {
    /// The column called `column` of `ours` and of the more accurate `theirs`; `None` where one of them has none.
    pub fn new(ours: &'a Trajectory, theirs: &'a Trajectory, column: &str) -> Option<Pair<'a>> {
        let (index, other) = (ours.index(column)?, theirs.index(column)?);
        let quaternion = ours.quaternion_of(index).zip(theirs.quaternion_of(other)).map(<[_; 2]>::from);
        Some(Pair { ours, index, theirs, other, quaternion })
    }

    /// The common records. Where one run ends between two records of the other, its last row has no partner.
    fn common(&self) -> impl Iterator<Item = (f64, &'a [f64], &'a [f64])> {
        let both = self.ours.rows().zip(self.theirs.rows());
        let common = both.filter(|((t, _), (other, _))| (t - other).abs() <= SAME_TIME * t.abs());
        common.map(|((t, ours), (_, theirs))| (t, ours, theirs))
    }

    /// q · q_f of a record; 1 for what is no component of a quaternion.
    fn cosine(&self, ours: &[f64], theirs: &[f64]) -> f64 {
        let Some([q, other]) = self.quaternion else { return 1.0 };
        ours[q..].iter().zip(&theirs[other..]).take(COMPONENTS).map(|(a, b)| a * b).sum()
    }

    /// t, y and y_f of the common records.
    pub(super) fn rows(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        let one = |(t, ours, theirs): (f64, &[f64], &[f64])| {
            let y = theirs[self.other];
            (t, ours[self.index], if self.cosine(ours, theirs) < 0.0 { -y } else { y })
        };
        self.common().map(one)
    }

    /// The values y and y_f at the common records.
    pub(super) fn values(&self) -> impl Iterator<Item = (f64, f64)> {
        self.rows().map(|(_, x, y)| (x, y))
    }

    /// max_t |y − y_f|; NaN is not hidden, neither by an earlier row nor by a later.
    pub fn largest(&self) -> f64 {
        self.rows().fold(0.0, |largest, (_, x, y)| worse(largest, (x - y).abs()))
    }

    /// max_t |y_f|
    pub(super) fn size(&self) -> f64 {
        self.rows().fold(0.0, |size, (.., y)| size.max(y.abs()))
    }

    /// Differences of the smallest, largest and last value; NaN where the other run ends before them.
    pub fn of_values(&self) -> [f64; 3] {
        let (ours, theirs) = (self.ours.extremes(self.index), self.theirs.extremes(self.other));
        let other_sign = self.quaternion.is_some()
            && self.common().map(|(_, ours, theirs)| self.cosine(ours, theirs)).sum::<f64>() < 0.0;
        let [low, high] = if other_sign { [-theirs.max, -theirs.min] } else { [theirs.min, theirs.max] };
        let last = |of: &Trajectory| of.times().last().copied().unwrap_or(0.0);
        let (end, reach) = (last(self.ours), last(self.theirs));
        let largest = self.largest();
        let unresolved = (largest / (UNRESOLVED * self.size())).min(1.0) * largest;
        let value = |a: f64, b: f64| if reach >= end { (a - b).abs() } else { 0.0 };
        let at = |time: f64| {
            if time > reach {
                return f64::NAN;
            }
            let until = self.rows().take_while(|(t, ..)| *t <= time).map(|(_, x, y)| (x - y).abs());
            let (earlier, now) = until.fold((0.0, 0.0), |(largest, _), d| (worse(largest, d), d));
            worse(worse(now, EARLIER * earlier), unresolved)
        };
        [worse(value(ours.min, low), at(ours.t_min)), worse(value(ours.max, high), at(ours.t_max)), at(end)]
    }

    /// The time until which the error stays a small part of the largest value.
    pub(super) fn trusted(&self, safety: f64) -> f64 {
        // That of the whole run, also where the other ends before.
        let bound = DISTRUSTED * self.size().max(self.ours.extremes(self.index).largest());
        let off = self.rows().find(|(_, x, y)| !(safety * (x - y).abs() <= bound));
        off.map_or(f64::INFINITY, |(t, ..)| t)
    }
}

/// The larger of two differences, or NaN.
fn worse(a: f64, b: f64) -> f64 {
    if b <= a || a.is_nan() { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Channel, Kind};

    fn column(values: [f64; 3]) -> Trajectory {
        let mut out = Trajectory::new(vec![Channel::new(Role::Detail, "y", "m", "")]);
        for (i, value) in values.into_iter().enumerate() {
            out.push(i as f64, |row| row[0] = value);
        }
        out
    }

    #[test]
    fn a_difference_that_is_no_number_is_reported_whatever_follows_it() {
        let (a, b) = (column([0.0, f64::NAN, 3.0]), column([0.0, 1.0, 2.0]));
        assert!(Pair::new(&a, &b, "y").unwrap().largest().is_nan());
        let c = column([0.0, 0.5, 2.25]);
        let pair = Pair::new(&b, &c, "y").unwrap();
        assert_eq!((pair.largest(), pair.size()), (0.5, 2.25));
        // The difference 0.5 is a fifth of the largest value: no value is better known.
        assert_eq!(pair.of_values(), [0.5, 0.5, 0.5]);
        // A run that ends at 1.5 has no partner for its last record, however far it is.
        let mut short = column([0.0, 1.0, 9.0]);
        short.cut(2.0);
        short.push(1.5, |row| row[0] = 9.0);
        assert_eq!(Pair::new(&b, &short, "y").unwrap().largest(), 0.0);
        let small = column([0.0, 0.99, 2.0]);
        let differences = Pair::new(&b, &small, "y").unwrap().of_values();
        assert!((differences[2] - 0.0025).abs() < 1e-15, "{differences:?}");
        assert_eq!(pair.trusted(1.0), 1.0);
    }

    /// One run continues q = (cos θ/2, 0, 0, sin θ/2) from the sign that the other leaves out: each component differs by what the angles do.
    #[test]
    fn a_quaternion_and_its_negative_are_one_rotation() {
        let turning = |sign: f64, off: f64| {
            let names = ["w", "x", "y", "z"];
            let mut out = Trajectory::new(
                names
                    .map(|name| Channel::new(Role::Detail, name, "", "").with_kind(Kind::Quaternion))
                    .to_vec(),
            );
            for i in 0..10 {
                let half = 0.2 * f64::from(i) + 0.5 * off;
                out.push(f64::from(i), |row| {
                    row.copy_from_slice(&[sign * libm::cos(half), 0.0, 0.0, sign * libm::sin(half)]);
                });
            }
            out
        };
        let ours = turning(1.0, 0.0);
        let [same, negative] = [1.0, -1.0].map(|sign| turning(sign, 1e-3));
        for name in ["w", "x", "z"] {
            let of = |theirs| {
                let pair = Pair::new(&ours, theirs, name).unwrap();
                (pair.largest(), pair.of_values(), pair.trusted(1.0))
            };
            assert_eq!(of(&negative), of(&same), "{name}");
            assert!(of(&negative).0 <= 5.01e-4, "{name}");
        }
        assert!(Pair::new(&ours, &negative, "z").unwrap().of_values().iter().all(|off| *off < 1e-3));
    }
}
