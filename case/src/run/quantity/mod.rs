//! Quantities: numbers of a run that can be asked for by name.
//!
//! `tip.deflection.amplitude@15..20` is the name of a column, of a contact, `work` or `run`, what is asked of it, and the times to which it is restricted.

mod measure;
mod time;

use super::{Prepared, Run};
use flexion::analysis::error::SAFETY;
use flexion::system::Channel;
use flexion_results::{ColumnError, ResultsError, Trajectory, nearest};
pub use measure::Measured;
use time::Compared;

/// Which value of a column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// The last.
    Final,
    /// When it is smallest.
    TimeOfMin,
    /// When it is largest.
    TimeOfMax,
    /// Half of the largest less the smallest.
    Amplitude,
    /// Half of the largest and the smallest.
    Middle,
    /// The largest absolute value.
    Largest,
    /// The mean over time, ∫y dt/T.
    Mean,
    /// √(∫y² dt/T).
    RootMeanSquare,
    /// The value at the time of a record \[s\].
    At(f64),
}

/// What is asked of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfContact {
    /// Time of the first impact, or the first touch of a continuous force.
    FirstTouch,
    /// Impulse of its bursts of impacts, or of a continuous force that has left.
    Impulse,
    /// Number of impacts.
    Impacts,
    /// Energy lost in impacts, or by a continuous force that has left.
    Loss,
}

/// Counted work of a run, and its time of computing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Steps accepted.
    Steps,
    /// Steps attempted and thrown away.
    Rejected,
    /// Evaluations of the residual.
    Residuals,
    /// Factorisations.
    Factorisations,
    /// Time of computing, which differs from run to run.
    Seconds,
}

/// Of what a quantity is.
#[derive(Clone, Debug, PartialEq)]
pub enum Of {
    /// Of a column.
    Column(String, Value),
    /// Of a contact.
    Contact(String, OfContact),
    /// Of the work.
    Work(Work),
    /// The time at which the run ended.
    End,
    /// The time until which its errors stay small, and until which a small disturbance does not lead elsewhere.
    Trusted,
}

/// A quantity of a run: `tip.deflection.min`.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Of what.
    pub of: Of,
    /// The times to which it is restricted \[s\].
    pub within: Option<(f64, f64)>,
    /// Its unit; empty for a pure number.
    pub unit: String,
    text: String,
}

/// What a run says of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collected {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// When the run first has it, or the last time that it is of \[s\].
    pub time: f64,
    /// Its estimated error ±, in the unit of the quantity; `None` where it is not estimated.
    pub error: Option<f64>,
    /// The part of the error that the distance of the records has, where the value is an extreme within some times, in the unit of the quantity.
    pub records: f64,
    /// Whether it lies within the time in which the run is trusted; `None` where that is not estimated.
    pub trusted: Option<bool>,
}

/// Part of the time of computing by which it may differ from run to run: two are told apart beyond a factor 2.
const SECONDS: f64 = 1.0 / 3.0;
/// Part of a value that rounding may have taken.
pub const ROUNDING: f64 = 1e-12;

const VALUES: [(&str, Value); 10] = [
    (".min", Value::Min),
    (".max", Value::Max),
    (".final", Value::Final),
    (".time-of-min", Value::TimeOfMin),
    (".time-of-max", Value::TimeOfMax),
    (".amplitude", Value::Amplitude),
    (".middle", Value::Middle),
    (".largest", Value::Largest),
    (".mean", Value::Mean),
    (".root-mean-square", Value::RootMeanSquare),
];
const CONTACTS: [(&str, OfContact); 4] = [
    (".first-touch", OfContact::FirstTouch),
    (".impulse", OfContact::Impulse),
    (".impacts", OfContact::Impacts),
    (".loss", OfContact::Loss),
];
const WHOLE: [(&str, Of); 7] = [
    ("work.steps", Of::Work(Work::Steps)),
    ("work.rejected", Of::Work(Work::Rejected)),
    ("work.residuals", Of::Work(Work::Residuals)),
    ("work.factorisations", Of::Work(Work::Factorisations)),
    ("work.seconds", Of::Work(Work::Seconds)),
    ("run.end", Of::End),
    ("run.trusted", Of::Trusted),
];

impl Quantity {
    /// Its name, as it is written.
    pub fn name(&self) -> &str {
        &self.text
    }

    /// The quantities that these texts name among the columns and the contacts of a run; a column alone stands for its smallest, largest and last value.
    ///
    /// # Errors
    /// A name that is none.
    pub fn read(
        texts: &[String],
        channels: &[Channel],
        contacts: &[String],
    ) -> Result<Vec<Quantity>, ResultsError> {
        let mut out: Vec<Quantity> = Vec::new();
        for text in texts {
            for quantity in one(text.trim(), channels, contacts)? {
                if !out.contains(&quantity) {
                    out.push(quantity);
                }
            }
        }
        Ok(out)
    }

    /// Whether it differs from run to run.
    pub fn varies(&self) -> bool {
        self.of == Of::Work(Work::Seconds)
    }

    /// Its value in a run.
    ///
    /// # Errors
    /// Why there is none.
    pub fn collect(&self, run: &Run) -> Result<Collected, String> {
        let Measured { value, time } = self.measure_run(run)?;
        let records = self.error_of_records(&run.trajectory, value);
        let known = run.errors.as_ref().filter(|errors| errors.unknown.is_none());
        let error = match (&self.of, self.within) {
            (Of::Work(Work::Seconds), _) => Some(SECONDS * value),
            (Of::Work(_) | Of::End | Of::Trusted, _) => Some(0.0),
            (Of::Column(column, of @ (Value::Min | Value::Max | Value::Final)), None) => {
                let column = known.and_then(|errors| errors.columns.iter().find(|of| of.column == *column));
                column.map(|ColumnError { min, max, last, .. }| match of {
                    Value::Min => *min,
                    Value::Max => *max,
                    _ => *last,
                })
            }
            (Of::Column(column, of), _) => known.and_then(|errors| {
                if let Value::TimeOfMin | Value::TimeOfMax = of {
                    return self.error_of_time(run, (&errors.finer, errors.safety), column, *of, time);
                }
                let finer = self.measure_column(&errors.finer, column, *of).ok()?;
                Some(errors.safety * (value - finer.value).abs() + ROUNDING * value.abs() + records)
            }),
            (Of::Contact(..), _) => None,
        };
        let error = error.filter(|error| error.is_finite());
        Ok(Collected { value, time, error, records, trusted: known.map(|errors| time <= errors.trusted) })
    }

    /// Its value in a run, with the error by another run of the same motion that is more accurate: twice the difference.
    ///
    /// # Errors
    /// Why there is no value.
    pub fn collect_against(&self, run: &Run, other: &Run) -> Result<Collected, String> {
        let Measured { value, time } = self.measure_run(run)?;
        let records = self.error_of_records(&run.trajectory, value);
        let error = match self.of {
            Of::Work(Work::Seconds) => Some(SECONDS * value),
            Of::Work(_) | Of::End | Of::Trusted => Some(0.0),
            Of::Column(ref column, of @ (Value::TimeOfMin | Value::TimeOfMax)) => {
                self.error_of_time(run, (&other.trajectory, SAFETY), column, of, time)
            }
            Of::Column(..) | Of::Contact(..) => self
                .measure_run(other)
                .ok()
                .map(|other| SAFETY * (value - other.value).abs() + ROUNDING * value.abs() + records),
        };
        Ok(Collected { value, time, error: error.filter(|error| error.is_finite()), records, trusted: None })
    }

    /// The error \[s\] of the time of an extreme by a more accurate run with its factor of safety: no less than that of the times themselves.
    fn error_of_time(
        &self,
        run: &Run,
        (theirs, safety): (&Trajectory, f64),
        column: &str,
        of: Value,
        time: f64,
    ) -> Option<f64> {
        let apart = (time - self.measure_column(theirs, column, of).ok()?.value).abs();
        let within = self.within.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let compared = Compared { ours: &run.trajectory, theirs, column, safety };
        let error = compared.error_of_time(of == Value::TimeOfMax, time, within)?;
        Some(error.max(safety * apart) + ROUNDING * time.abs())
    }
}

/// The quantities of a text.
fn one(text: &str, channels: &[Channel], contacts: &[String]) -> Result<Vec<Quantity>, ResultsError> {
    let quantity =
        |of: Of, within, unit: &str, text: String| Quantity { of, within, unit: unit.to_owned(), text };
    if let Some((_, of)) = WHOLE.iter().find(|(name, _)| *name == text) {
        let unit = if matches!(of, Of::Work(Work::Seconds) | Of::End | Of::Trusted) { "s" } else { "" };
        return Ok(vec![quantity(of.clone(), None, unit, text.to_owned())]);
    }
    let known = |name: &str| channels.iter().find(|channel| channel.name == name);
    if let Some(channel) = known(text) {
        let of = |(end, value): &(&str, Value)| {
            quantity(Of::Column(text.to_owned(), *value), None, &channel.unit, format!("{text}{end}"))
        };
        return Ok(VALUES[..3].iter().map(of).collect());
    }
    let wrong = |reason: String| ResultsError::Quantity { quantity: text.to_owned(), reason };
    let (name, times) = text.split_once('@').map_or((text, None), |(name, times)| (name, Some(times)));
    if let Some(column) = name.strip_suffix(".at") {
        let channel = known(column).ok_or_else(|| unknown(column, channels, contacts))?;
        let time = times.and_then(|time| time.trim().parse::<f64>().ok()).filter(|time| time.is_finite());
        let time =
            time.ok_or_else(|| wrong("a time in seconds follows `@`, as in `tip.deflection.at@1.5`".into()))?;
        return Ok(vec![quantity(
            Of::Column(column.to_owned(), Value::At(time)),
            None,
            &channel.unit,
            text.to_owned(),
        )]);
    }
    let within = times.map(|times| window(times).ok_or_else(|| {
        wrong("two times in seconds follow `@`, as in `tip.deflection.amplitude@15..20`, of which one may be left out".into())
    })).transpose()?;
    let ends = |end: &str| name.strip_suffix(end);
    // The longest ending: `tip.time-of-min` is no smallest value.
    let value = VALUES
        .iter()
        .filter_map(|(end, value)| Some((ends(end)?, *value)))
        .min_by_key(|(name, _)| name.len());
    if let Some((column, value)) = value
        && let Some(channel) = known(column)
    {
        let unit = if matches!(value, Value::TimeOfMin | Value::TimeOfMax) { "s" } else { &channel.unit };
        return Ok(vec![quantity(Of::Column(column.to_owned(), value), within, unit, text.to_owned())]);
    }
    let of_contact = CONTACTS.iter().find_map(|(end, of)| Some((ends(end)?, *of)));
    if let Some((contact, of)) = of_contact
        && contacts.iter().any(|name| name == contact)
    {
        let unit = match of {
            OfContact::FirstTouch => "s",
            OfContact::Impulse => "N*s",
            OfContact::Impacts => "",
            OfContact::Loss => "J",
        };
        return Ok(vec![quantity(Of::Contact(contact.to_owned(), of), within, unit, text.to_owned())]);
    }
    let column = value.map(|(column, _)| column).or(of_contact.map(|(contact, _)| contact));
    Err(unknown(column.unwrap_or(name), channels, contacts))
}

/// `FROM..TO`, of which either may be left out.
fn window(text: &str) -> Option<(f64, f64)> {
    let (from, to) = text.split_once("..")?;
    let number = |text: &str, none: f64| {
        if text.trim().is_empty() {
            Some(none)
        } else {
            text.trim().parse::<f64>().ok().filter(|t| t.is_finite())
        }
    };
    let (from, to) = (number(from, f64::NEG_INFINITY)?, number(to, f64::INFINITY)?);
    (from <= to).then_some((from, to))
}

fn unknown(name: &str, channels: &[Channel], contacts: &[String]) -> ResultsError {
    let names =
        || channels.iter().map(|channel| channel.name.as_str()).chain(contacts.iter().map(String::as_str));
    ResultsError::NoColumn {
        pattern: name.to_owned(),
        of: "this case".to_owned(),
        nearest: nearest(name, names()).map(str::to_owned),
        there: names().collect::<Vec<_>>().join(", "),
    }
}

impl Prepared {
    /// The quantities that these texts name among the columns that the run will record and its contacts, as [`Quantity::read`].
    ///
    /// # Errors
    /// A name that is none.
    pub fn quantities(&mut self, texts: &[String]) -> Result<Vec<Quantity>, ResultsError> {
        let contacts: Vec<String> =
            self.live.system.contacts(&self.state).into_iter().map(|contact| contact.name).collect();
        Quantity::read(texts, &self.channels(), &contacts)
    }
}
