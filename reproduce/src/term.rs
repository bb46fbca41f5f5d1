//! Terms: quantities of runs, compared with each other, with their errors.

use crate::answer::{Answer, Curve};
use crate::described::{As, OfRun, Term};
use std::collections::BTreeMap;

/// A number with its error.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// Its value.
    pub value: f64,
    /// Its error ±, where it is known.
    pub error: Option<f64>,
    /// Its unit; empty for a pure number.
    pub unit: String,
    /// Whether it is a part of something, shown in per cent.
    pub part: bool,
    /// Whether it differs from run to run.
    pub varies: bool,
}

/// The answers of the runs of an item, by their names; `None` for a run that takes long and was not asked for.
pub type Answers<'a> = BTreeMap<String, (Option<&'a Answer>, Option<f64>)>;

/// Why there is no number.
#[derive(Clone, Debug, PartialEq)]
pub enum Missing {
    /// The run takes so long \[s\], and was not asked for.
    Long(f64),
    /// Something else.
    Because(String),
}

/// The answer of a run.
pub fn answer<'a>(answers: &Answers<'a>, run: &str) -> Result<&'a Answer, Missing> {
    match answers.get(run) {
        Some((Some(answer), _)) => Ok(answer),
        Some((None, seconds)) => Err(Missing::Long(seconds.unwrap_or(0.0))),
        None => Err(Missing::Because(format!("there is no run `{run}`"))),
    }
}

/// The number of a term.
pub fn number(term: &Term, answers: &Answers<'_>) -> Result<Number, Missing> {
    match term {
        Term::Number(value) => {
            Ok(Number { value: *value, error: Some(0.0), unit: String::new(), part: false, varies: false })
        }
        Term::Of(of) => of_run(of, answers),
    }
}

/// A quantity of a run, perhaps compared with another run.
pub fn of_run(of: &OfRun, answers: &Answers<'_>) -> Result<Number, Missing> {
    let OfRun { run, quantity, to, compared } = of;
    let because = |run: &str| {
        let run = run.to_owned();
        move |why: String| Missing::Because(format!("{run}: {why}"))
    };
    let (Some(to), Some(compared)) = (to, compared) else {
        let value = answer(answers, run)?.value(quantity).map_err(because(run))?;
        return Ok(Number {
            value: value.value,
            error: value.error,
            unit: value.unit.clone(),
            part: false,
            varies: value.varies,
        });
    };
    if *compared == As::CurveDifference {
        let (column, within) = window(quantity).map_err(Missing::Because)?;
        let curve = |run: &String| answer(answers, run)?.curve(column).map_err(because(run));
        for run in [run, to] {
            if within.1.is_infinite() && !answer(answers, run)?.finished() {
                return Err(Missing::Because(format!(
                    "{run} ended early, and the claim does not say until when runs are compared"
                )));
            }
        }
        let (value, error) = apart(curve(run)?, curve(to)?, within).map_err(Missing::Because)?;
        return Ok(Number { value, error, unit: String::new(), part: true, varies: false });
    }
    let (own, other) = (answer(answers, run)?, answer(answers, to)?);
    let a = own.value(quantity).map_err(because(run))?;
    let b = other.value(quantity).map_err(because(to))?;
    // A run has no difference from itself.
    let errors = if std::ptr::eq(own, other) { Some((0.0, 0.0)) } else { a.error.zip(b.error) };
    let ratio = a.value / b.value;
    let of_ratio = errors.map(|(e, f)| (e + ratio.abs() * f) / (b.value.abs() - f).max(0.0));
    let (value, error, unit, part) = match compared {
        As::Difference => (a.value - b.value, errors.map(|(e, f)| e + f), a.unit.clone(), false),
        As::Ratio => (ratio, of_ratio, String::new(), false),
        As::RelativeDifference | As::CurveDifference => ((ratio - 1.0).abs(), of_ratio, String::new(), true),
    };
    if !value.is_finite() {
        return Err(Missing::Because(format!("{quantity} of {to} is zero")));
    }
    Ok(Number {
        value,
        error: error.filter(|error| error.is_finite()),
        unit,
        part,
        varies: a.varies || b.varies,
    })
}

/// The column of a text `COLUMN` or `COLUMN@FROM..TO`.
pub fn column(text: &str) -> &str {
    text.split_once('@').map_or(text, |(column, _)| column)
}

/// A column, and the times to which it is restricted.
///
/// # Errors
/// What is wrong with the times.
pub fn window(text: &str) -> Result<(&str, (f64, f64)), String> {
    let Some((column, times)) = text.split_once('@') else {
        return Ok((text, (f64::NEG_INFINITY, f64::INFINITY)));
    };
    let (from, to) =
        times.split_once("..").ok_or_else(|| format!("`@{times}` is no range of times: write @FROM..TO"))?;
    let time = |text: &str, none: f64| match text.trim() {
        "" => Ok(none),
        text => text.parse::<f64>().ok().filter(|time| time.is_finite()).ok_or_else(|| {
            format!("`{text}` of `@{times}` is no time: a number of seconds is asked, with a point")
        }),
    };
    let within = (time(from, f64::NEG_INFINITY)?, time(to, f64::INFINITY)?);
    if within.0 < within.1 {
        Ok((column, within))
    } else {
        Err(format!("`@{times}` is no range of times: it ends before it begins"))
    }
}

/// max |a − b| / max |b| over the common times, and its error by those of both, also of the divisor.
fn apart(a: &Curve, b: &Curve, (from, to): (f64, f64)) -> Result<(f64, Option<f64>), String> {
    let last = |curve: &Curve| curve.t.last().copied().unwrap_or(0.0);
    let end = last(a).min(last(b));
    let needed = if to.is_finite() { to } else { last(a).max(last(b)) };
    if end < needed * (1.0 - 1e-9) {
        return Err(format!("a run ends at t = {end} s, before {needed} s"));
    }
    let (mut largest, mut size, mut off, mut off_size) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let mut j = 0;
    let mut common = 0;
    for (i, t) in a.t.iter().enumerate() {
        while j + 1 < b.t.len() && b.t[j] < t - 1e-9 * t.abs().max(1.0) {
            j += 1;
        }
        let same = b.t.get(j).is_some_and(|other| (other - t).abs() <= 1e-9 * t.abs().max(1.0));
        if !same || !(from..=to).contains(t) {
            continue;
        }
        common += 1;
        largest = largest.max((a.y[i] - b.y[j]).abs());
        size = size.max(b.y[j].abs());
        let error = |curve: &Curve, k: usize| curve.off.get(k).copied().unwrap_or(f64::NAN);
        let now = error(a, i) + error(b, j);
        off = if now.is_nan() { f64::NAN } else { off.max(now) };
        off_size = off_size.max(error(b, j));
    }
    if common == 0 {
        return Err("the two runs have no time in common".to_owned());
    }
    if size == 0.0 {
        return Err("the column is zero".to_owned());
    }
    let ratio = largest / size;
    let error = (off + ratio * off_size) / (size - off_size).max(0.0);
    Ok((ratio, error.is_finite().then_some(error)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3 and 2 ± 0.5: |3 − 2|/2 is 1/2, and |3 − 1.5|/1.5 is 1.
    #[test]
    fn the_error_of_a_divisor_counts() {
        let curve = |y: f64, off: f64| Curve {
            unit: "m".to_owned(),
            t: vec![0.0, 1.0],
            y: vec![0.0, y],
            off: vec![0.0, off],
        };
        let all = (f64::NEG_INFINITY, f64::INFINITY);
        assert_eq!(apart(&curve(3.0, 0.0), &curve(2.0, 0.5), all), Ok((0.5, Some(0.5))));
        assert_eq!(apart(&curve(3.0, 0.0), &curve(2.0, 2.0), all), Ok((0.5, None)));
    }
}
