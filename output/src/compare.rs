//! How far two runs are apart.

use std::cmp::Ordering;
use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::csv::io_error;
use super::{Results, ResultsError, Trajectory, select};
use flexion::system::{Channel, Role};
use std::borrow::Cow;

/// Times closer than this fraction of the span are the same.
const SAME: f64 = 1e-12;

/// The difference d(t) = b(t) − a(t) of one column.
#[derive(Clone, Debug, PartialEq)]
pub struct Difference {
    /// Name of the column.
    pub column: String,
    /// SI unit.
    pub unit: Cow<'static, str>,
    /// max |d|, in the unit; NaN when no value is finite.
    pub max: f64,
    /// Time at which `max` first occurs \[s\].
    pub at: f64,
    /// Root mean square of d over the times compared.
    pub rms: f64,
    /// max |a| over the times compared.
    pub peak: f64,
    /// max |a|, or the largest energy of the first run for the error of its energy balance, which is rounding against its own
    /// peak.
    pub scale: f64,
    /// max |d| / `scale`; 0 when both are 0, infinite when only `scale` is.
    pub relative: f64,
    /// First time at which a or b is not a finite number \[s\]; such times are left out of the other figures.
    pub not_finite: Option<f64>,
}

/// Two runs, compared at the times of the first.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Name of the first run.
    pub first: String,
    /// Name of the second.
    pub second: String,
    /// First and last time compared \[s\].
    pub span: (f64, f64),
    /// Whether that is all of the first run.
    pub covers: bool,
    /// Whether the second run was interpolated (by cubics through four neighbouring times), because it was
    /// recorded at other times.
    pub interpolated: bool,
    /// The differences, in the order of the columns asked for.
    pub differences: Vec<Difference>,
    /// Columns only the first run has.
    pub only_first: Vec<String>,
    /// Columns only the second has.
    pub only_second: Vec<String>,
    /// d(t) of each column.
    pub trajectory: Trajectory,
}

/// Most primary columns that are drawn when none are asked for.
const USUAL: usize = 2;
/// Most columns that are drawn.
const MOST_DRAWN: usize = 12;

impl Comparison {
    /// Compares the second run with the first in the columns that both have and one of the patterns matches; without a pattern in all but those of the integration.
    ///
    /// # Errors
    /// [`ResultsError`]: a pattern that matches nothing, runs without times in common.
    pub fn of(first: &Results, second: &Results, patterns: &[String]) -> Result<Comparison, ResultsError> {
        let common = first.trajectory.channels().iter();
        let common = common.filter(|channel| second.trajectory.index(&channel.name).is_some());
        let columns: Vec<&str> = if patterns.is_empty() {
            common.filter(|channel| channel.role != Role::Integration).map(|c| c.name.as_str()).collect()
        } else {
            let common: Vec<&str> = common.map(|channel| channel.name.as_str()).collect();
            select(&common, patterns, &format!("both {} and {}", first.name, second.name))?
        };
        compare(first, second, &columns)
    }

    /// The columns of a figure: those that were chosen, or the first principal ones.
    pub fn drawn(&self, are_chosen: bool) -> Vec<&str> {
        let channels = || self.trajectory.channels().iter();
        let mut drawn: Vec<_> = channels().filter(|c| c.role == Role::Primary).take(USUAL).collect();
        if drawn.is_empty() || are_chosen {
            drawn = channels().take(MOST_DRAWN).collect();
        }
        drawn.into_iter().map(|channel| channel.name.as_str()).collect()
    }

    /// The columns with a value that is not a finite number.
    pub fn not_finite(&self) -> Vec<String> {
        let first = |d: &Difference| {
            let t = d.not_finite?;
            Some(format!("{} is not a finite number at t = {t} s", d.column))
        };
        self.differences.iter().filter_map(first).collect()
    }

    /// What exceeds a relative tolerance: columns, and a second run that ends before the first.
    pub fn beyond(&self, tolerance: f64) -> Vec<String> {
        let mut out = Vec::new();
        if !self.covers {
            let (from, to) = self.span;
            out.push(format!("{} has no records of {} outside of {from} … {to} s", self.second, self.first));
        }
        for d in &self.differences {
            if let Some(t) = d.not_finite {
                out.push(format!("{} is not a finite number at t = {t} s", d.column));
            } else if d.relative.is_nan() || d.relative > tolerance {
                let of = if d.scale == d.peak { "its peak" } else { "the largest energy" };
                out.push(format!("{} differs by {:.3e} of {of} at t = {} s", d.column, d.relative, d.at));
            }
        }
        out
    }
}

/// Compares two runs in the `columns`, at the times of the first within the span of the second. Where the
/// second was recorded at other times it is interpolated: the cubic through the two times before and the two
/// after (fewer, one-sided, at the ends), whose error is of fourth order in the recording interval. Unit quaternions are compared
/// as rotations, whatever their signs, over one.
///
/// # Errors
/// [`ResultsError::Incomparable`] when the runs have no time in common, times that do not ascend, or other units.
pub fn compare(first: &Results, second: &Results, columns: &[&str]) -> Result<Comparison, ResultsError> {
    let (a, b) = (&first.trajectory, &second.trajectory);
    let refuse = |reason: String| ResultsError::Incomparable {
        first: first.name.clone(),
        second: second.name.clone(),
        reason,
    };
    for run in [first, second] {
        let times = run.trajectory.times();
        if let Some(pair) =
            times.windows(2).find(|pair| pair[0].partial_cmp(&pair[1]) != Some(Ordering::Less))
        {
            return Err(refuse(format!("the times of {} do not ascend after t = {} s", run.name, pair[0])));
        }
    }
    let (Some((&begin, &end)), Some((&from, &to))) =
        (a.times().first().zip(a.times().last()), b.times().first().zip(b.times().last()))
    else {
        return Err(refuse("one of them recorded nothing".to_owned()));
    };
    let slack = SAME * (end - begin).abs().max(to - from);
    let inside = |t: f64| t >= from - slack && t <= to + slack;
    let times: Vec<f64> = a.times().iter().copied().filter(|t| inside(*t)).collect();
    let Some(span) = times.first().copied().zip(times.last().copied()) else {
        return Err(refuse(format!(
            "they have no time in common: one spans {begin} … {end} s, the other {from} … {to} s"
        )));
    };
    let places: Vec<Weights> = times.iter().map(|t| weights(b.times(), *t, slack)).collect();
    let quaternions = a.quaternions();
    let continued = (!quaternions.is_empty()).then(|| {
        let mut continued = b.clone();
        continued.continue_quaternions(&b.quaternions(), 0..b.len());
        continued
    });
    let b = continued.as_ref().unwrap_or(b);
    let ours = |i: usize| -> Vec<f64> {
        a.times().iter().zip(a.values(i)).filter(|(t, _)| inside(**t)).map(|(_, y)| y).collect()
    };
    let theirs = |j: usize| -> Vec<f64> {
        let values: Vec<f64> = b.values(j).collect();
        places.iter().map(|weights| weights.apply(&values)).collect()
    };
    let parts =
        a.channels().iter().zip(a.peaks()).filter(|(c, _)| matches!(c.role, Role::Energy | Role::Work));
    let energy = parts.fold(0.0_f64, |largest, (_, peak)| largest.max(peak));
    let mut channels: Vec<Channel> = Vec::new();
    let mut differences = Vec::new();
    let mut values: Vec<Vec<f64>> = Vec::new();
    for name in columns {
        let (Some(i), Some(j)) = (a.index(name), b.index(name)) else { continue };
        let (channel, other) = (&a.channels()[i], &b.channels()[j]);
        if channel.unit != other.unit {
            return Err(refuse(format!(
                "{name} is in `{}` in one and in `{}` in the other",
                channel.unit, other.unit
            )));
        }
        let (of_first, mut of_second) = (ours(i), theirs(j));
        let quaternion = quaternions.iter().map(|first| *first..first + 4).find(|all| all.contains(&i));
        if let Some(all) = &quaternion {
            // q and −q are one rotation.
            let mut products = vec![0.0; times.len()];
            for (k, l) in all.clone().filter_map(|k| Some((k, b.index(&a.channels()[k].name)?))) {
                let pairs = ours(k).into_iter().zip(theirs(l));
                products.iter_mut().zip(pairs).for_each(|(sum, (x, y))| *sum += x * y);
            }
            of_second.iter_mut().zip(&products).filter(|(_, p)| **p < 0.0).for_each(|(y, _)| *y = -*y);
        }
        let d: Vec<f64> = of_first.iter().zip(&of_second).map(|(x, y)| y - x).collect();
        let least = if quaternion.is_some() { 1.0 } else { 0.0 };
        let least = if channel.role == Role::Imbalance { energy } else { least };
        differences.push(difference(channel, &times, &of_first, &d, least));
        channels.push(channel.clone());
        values.push(d);
    }
    let mut trajectory = Trajectory::new(channels);
    trajectory.reserve(times.len());
    for (k, t) in times.iter().enumerate() {
        trajectory.push(*t, |row| row.iter_mut().zip(&values).for_each(|(entry, d)| *entry = d[k]));
    }
    let only = |of: &Trajectory, other: &Trajectory| -> Vec<String> {
        of.channels().iter().map(|c| &c.name).filter(|name| other.index(name).is_none()).cloned().collect()
    };
    Ok(Comparison {
        first: first.name.clone(),
        second: second.name.clone(),
        span,
        covers: times.len() == a.len(),
        interpolated: places.iter().any(|weights| weights.count > 1),
        differences,
        only_first: only(a, b),
        only_second: only(b, a),
        trajectory,
    })
}

/// The figures of the difference `d`, which is measured by the largest value of `a`, or by `least` where that is more.
fn difference(channel: &Channel, times: &[f64], a: &[f64], d: &[f64], least: f64) -> Difference {
    let (mut max, mut at, mut peak) = (f64::NAN, f64::NAN, 0.0_f64);
    let (mut squares, mut count, mut not_finite) = (0.0, 0_usize, None);
    for ((&t, &y), &d) in times.iter().zip(a).zip(d) {
        if !d.is_finite() {
            not_finite = not_finite.or(Some(t));
            continue;
        }
        if max.is_nan() || d.abs() > max {
            (max, at) = (d.abs(), t);
        }
        peak = peak.max(y.abs());
        squares += d * d;
        count += 1;
    }
    let scale = peak.max(least);
    let relative = if max == 0.0 { 0.0 } else { max / scale };
    let rms = (squares / count as f64).sqrt();
    let (column, unit) = (channel.name.clone(), channel.unit.clone());
    Difference { column, unit, max, at, rms, peak, scale, relative, not_finite }
}

/// A value at some time as Σ wᵢ yᵢ over a few neighbouring records.
struct Weights {
    first: usize,
    count: usize,
    weight: [f64; 4],
}

impl Weights {
    fn apply(&self, y: &[f64]) -> f64 {
        self.weight[..self.count].iter().zip(&y[self.first..]).map(|(w, y)| w * y).sum()
    }
}

/// Lagrange's weights at `t` of the records next to it; one record alone where it is at `t`.
fn weights(times: &[f64], t: f64, slack: f64) -> Weights {
    let after = times.partition_point(|x| *x < t);
    for i in [after, after.wrapping_sub(1)] {
        if times.get(i).is_some_and(|x| (x - t).abs() <= slack) {
            return Weights { first: i, count: 1, weight: [1.0, 0.0, 0.0, 0.0] };
        }
    }
    let count = times.len().min(4);
    let first = after.saturating_sub(2).min(times.len() - count);
    let nodes = &times[first..first + count];
    let mut weight = [0.0; 4];
    for (i, w) in weight.iter_mut().enumerate().take(count) {
        *w = 1.0;
        for (j, x) in nodes.iter().enumerate() {
            if j != i {
                *w *= (t - x) / (nodes[i] - x);
            }
        }
    }
    Weights { first, count, weight }
}

/// `compare.json`: all figures, with `null` for what is not finite, and the tolerance if there is one.
pub fn compare_json(comparisons: &[Comparison], tolerance: Option<f64>) -> String {
    let one = |c: &Comparison| {
        let columns: Map<String, Value> = c
            .differences
            .iter()
            .map(|d| {
                let value = json!({
                    "unit": d.unit, "max": d.max, "time": d.at, "rms": d.rms, "peak": d.peak,
                    "relative": d.relative, "not_finite": d.not_finite,
                });
                (d.column.clone(), value)
            })
            .collect();
        json!({
            "run": c.second,
            "from": c.span.0,
            "to": c.span.1,
            "covers_reference": c.covers,
            "times": c.trajectory.len(),
            "interpolation": if c.interpolated { "cubic" } else { "none" },
            "columns": columns,
            "only_in_reference": c.only_first,
            "only_in_run": c.only_second,
            "beyond_tolerance": tolerance.map(|tolerance| c.beyond(tolerance)),
        })
    };
    let value = json!({
        "reference": comparisons.first().map(|c| &c.first),
        "tolerance": tolerance,
        "comparisons": comparisons.iter().map(one).collect::<Vec<_>>(),
    });
    format!("{value:#}\n")
}

/// `compare.csv`: one line for each run and column.
///
/// # Errors
/// Whatever `to` returns.
pub fn compare_csv(comparisons: &[Comparison], to: impl Write) -> io::Result<()> {
    write(comparisons, to).map_err(io_error)
}

fn write(comparisons: &[Comparison], to: impl Write) -> ::csv::Result<()> {
    let mut csv = ::csv::Writer::from_writer(to);
    csv.write_record(["reference", "run", "column", "unit", "max", "time [s]", "rms", "peak", "relative"])?;
    for c in comparisons {
        for d in &c.differences {
            let number = |y: f64| format!("{y:?}");
            csv.write_record([
                &c.first,
                &c.second,
                &d.column,
                &d.unit.to_string(),
                &number(d.max),
                &number(d.at),
                &number(d.rms),
                &number(d.peak),
                &number(d.relative),
            ])?;
        }
    }
    Ok(csv.flush()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::channel;
    use flexion::system::Kind;

    fn results(name: &str, times: &[f64], columns: &[(&str, &dyn Fn(f64) -> f64)]) -> Results {
        let mut t = Trajectory::new(columns.iter().map(|(name, _)| channel(name, "m")).collect());
        for time in times {
            t.push(*time, |row| row.iter_mut().zip(columns).for_each(|(y, (_, f))| *y = f(*time)));
        }
        Results { name: name.into(), path: name.into(), trajectory: t, caution: None }
    }

    fn grid(n: usize, end: f64) -> Vec<f64> {
        (0..=n).map(|i| end * i as f64 / n as f64).collect()
    }

    #[test]
    fn on_the_same_times_the_figures_are_those_of_the_difference() {
        let times = grid(100, 1.0);
        let a = results("a", &times, &[("w", &|t| -2.0 * t), ("zero", &|_| 0.0), ("mine", &|_| 1.0)]);
        let b = results(
            "b",
            &times,
            &[("zero", &|_| 0.0), ("w", &|t| -2.0 * t + 0.1 * t * t), ("its", &|_| 1.0)],
        );
        let c = compare(&a, &b, &["w", "zero"]).unwrap();
        let d = &c.differences[0];
        assert!(!c.interpolated && c.covers);
        assert!((d.max - 0.1).abs() < 1e-15 && d.at == 1.0 && d.peak == 2.0);
        assert!((d.relative - 0.05).abs() < 1e-15);
        // Mean of (0.1 t²)² over 0 … 1, as the sum over 101 points.
        let mean: f64 = times.iter().map(|t| (0.1 * t * t).powi(2)).sum::<f64>() / 101.0;
        assert!((d.rms - mean.sqrt()).abs() < 1e-15);
        assert_eq!((c.differences[1].max, c.differences[1].relative), (0.0, 0.0));
        assert_eq!((c.only_first, c.only_second), (vec!["mine".to_owned()], vec!["its".to_owned()]));
    }

    #[test]
    fn a_cubic_is_interpolated_exactly_and_a_sine_to_fourth_order() {
        let cubic = |t: f64| 1.0 + t - 3.0 * t * t + 2.0 * t.powi(3);
        let a = results("a", &grid(37, 2.0), &[("w", &cubic), ("s", &|t: f64| (3.0 * t).sin())]);
        let error = |n: usize| {
            let b = results("b", &grid(n, 2.0), &[("w", &cubic), ("s", &|t: f64| (3.0 * t).sin())]);
            let c = compare(&a, &b, &["w", "s"]).unwrap();
            assert!(c.interpolated);
            assert!(c.differences[0].max < 1e-13, "{}", c.differences[0].max);
            c.differences[1].rms
        };
        let order = (error(40) / error(160)).log2() / 2.0;
        assert!((order - 4.0).abs() < 0.3, "{order}");
    }

    #[test]
    fn a_rotation_is_compared_whatever_the_signs_of_its_quaternions() {
        let angle = |t: f64| 20.0 * t.sin().powi(2);
        let component = |k: usize, t: f64| match k {
            0 => (0.5 * angle(t)).cos(),
            3 => 0.0,
            k => [0.6, 0.8][k - 1] * (0.5 * angle(t)).sin(),
        };
        let names = ["b.rotation.w", "b.rotation.x", "b.rotation.y", "b.rotation.z"];
        let run = |intervals: usize, sign: &dyn Fn(f64) -> f64| {
            let of = |k: usize| move |t: f64| sign(t) * component(k, t);
            let [w, x, y, z] = [0, 1, 2, 3].map(of);
            let columns: [(&str, &dyn Fn(f64) -> f64); 4] =
                [(names[0], &w), (names[1], &x), (names[2], &y), (names[3], &z)];
            let mut results = results("r", &grid(intervals, 4.0), &columns);
            (0..4).for_each(|i| results.trajectory.describe(i, Role::Detail, Kind::Quaternion));
            results
        };
        let positive = run(400, &|t| component(0, t).signum());
        let alternating = run(400, &|t| if (100.0 * t).round() % 2.0 == 0.0 { -1.0 } else { 1.0 });
        let finer = run(1600, &|t| -component(0, t).signum());
        for (other, bound) in [(&alternating, 1e-15), (&finer, 1e-15)] {
            let c = compare(&positive, other, &names).unwrap();
            assert!(c.differences.iter().all(|d| d.max <= bound), "{:?}", c.differences);
        }
        // 20 intervals more than a record each: interpolated, over one also where the component is zero.
        let c = compare(&run(1620, &|_| 1.0), &finer, &names).unwrap();
        assert!(
            c.interpolated && c.differences.iter().all(|d| d.max < 1e-5 && d.scale == 1.0),
            "{:?}",
            c.differences
        );
        let mut continued = alternating.trajectory;
        continued.continue_quaternions(&continued.quaternions(), 0..continued.len());
        let w = continued.column(names[0]).unwrap();
        assert!(w[0] == 1.0 && w.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 0.11), "{w:?}");
    }

    #[test]
    fn the_error_of_the_energy_balance_is_compared_with_the_largest_energy() {
        let run = |name: &str, error: f64| {
            let mut run =
                results(name, &grid(10, 1.0), &[("energy", &|t| 8e4 * t), ("balance", &|t| error * t)]);
            let roles = [Role::Energy, Role::Imbalance];
            let channels = run.trajectory.channels().iter().zip(roles);
            let channels = channels.map(|(c, role)| Channel { role, ..c.clone() }).collect();
            let mut t = Trajectory::new(channels);
            run.trajectory.rows().for_each(|(time, row)| t.push(time, |out| out.copy_from_slice(row)));
            run.trajectory = t;
            run
        };
        let c = compare(&run("a", 1e-7), &run("b", 1e-6), &["energy", "balance"]).unwrap();
        assert!(c.beyond(1e-10).is_empty(), "{:?}", c.beyond(1e-10));
        assert!(c.beyond(1e-12)[0].contains("of the largest energy"), "{:?}", c.beyond(1e-12));
    }

    #[test]
    fn a_run_that_ends_early_exceeds_any_tolerance() {
        let a = results("a", &grid(100, 1.0), &[("w", &|t| t)]);
        let b = results("b", &grid(50, 0.5), &[("w", &|t| t)]);
        let c = compare(&a, &b, &["w"]).unwrap();
        assert_eq!((c.span, c.covers), ((0.0, 0.5), false));
        assert!(c.beyond(1.0)[0].contains("b has no records of a outside of 0 … 0.5 s"));
        assert!(compare(&b, &a, &["w"]).unwrap().beyond(1e-12).is_empty());
    }

    #[test]
    fn values_that_are_not_finite_lie_beyond_any_tolerance() {
        let times = grid(10, 1.0);
        let a = results("a", &times, &[("w", &|_| 1.0)]);
        let b = results("b", &times, &[("w", &|t| if t > 0.75 { f64::NAN } else { 1.0 })]);
        let c = compare(&a, &b, &["w"]).unwrap();
        assert_eq!((c.differences[0].max, c.differences[0].not_finite), (0.0, Some(0.8)));
        assert_eq!(c.beyond(f64::INFINITY).len(), 1);
        let json: Value = serde_json::from_str(&compare_json(&[c], Some(0.1))).unwrap();
        assert_eq!(json["comparisons"][0]["columns"]["w"]["not_finite"], 0.8);
    }

    #[test]
    fn what_cannot_be_compared_is_said() {
        let a = results("a", &grid(10, 1.0), &[("w", &|t| t)]);
        let fault = |b: &Results| compare(&a, b, &["w"]).unwrap_err().to_string();
        assert!(fault(&results("b", &[5.0, 6.0], &[("w", &|t| t)])).contains("no time in common"));
        assert!(fault(&results("b", &[0.0, 0.5, 0.5], &[("w", &|t| t)])).contains("do not ascend"));
        assert!(fault(&results("b", &[], &[("w", &|t| t)])).contains("recorded nothing"));
        let mut b = results("b", &grid(10, 1.0), &[]);
        b.trajectory = Trajectory::new(vec![channel("w", "rad")]);
        b.trajectory.push(0.0, |_| {});
        assert!(fault(&b).contains("`m` in one and in `rad`"));
    }

    #[test]
    fn one_line_of_the_table_is_one_run_and_column() {
        let times = grid(4, 1.0);
        let a = results("a", &times, &[("w", &|t| t)]);
        let b = results("b", &times, &[("w", &|t| 1.5 * t)]);
        let mut out = Vec::new();
        compare_csv(&[compare(&a, &b, &["w"]).unwrap()], &mut out).unwrap();
        let text = String::from_utf8(out).unwrap();
        assert!(
            text.starts_with("reference,run,column,unit,max,time [s],rms,peak,relative\na,b,w,m,0.5,1.0,")
        );
        assert!(text.ends_with(",1.0,0.5\n"), "{text}");
    }
}
