//! What is collected of a run: a value of a column.

use super::{Prepared, Run};
use flexion::system::Channel;
use flexion_results::{ColumnError, ResultsError, Trajectory, nearest};

/// Which value of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Value {
    /// The smallest.
    Min,
    /// The largest.
    Max,
    /// The last.
    Final,
}

/// A quantity of a run: `tip.deflection.min`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    /// The column.
    pub column: String,
    /// Which value of it.
    pub value: Value,
    /// Its unit; empty for a pure number.
    pub unit: String,
}

/// What a run says of a quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Collected {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// When the run first has it \[s\].
    pub time: f64,
    /// Its estimated error ±, in the unit of the quantity; `None` where it is not estimated.
    pub error: Option<f64>,
    /// Whether it lies within the time in which the run is trusted; `None` where that is not estimated.
    pub trusted: Option<bool>,
}

const ENDS: [(&str, Value); 3] = [(".min", Value::Min), (".max", Value::Max), (".final", Value::Final)];

impl Quantity {
    /// Its name: column and value.
    pub fn name(&self) -> String {
        let end = ENDS.iter().find(|(_, value)| *value == self.value).map_or("", |(end, _)| *end);
        format!("{}{end}", self.column)
    }

    /// The quantities that these texts name among the columns of a run: `tip.deflection.min`, `.max` or `.final`; a column alone stands for
    /// all three.
    ///
    /// # Errors
    /// A name that is none.
    pub fn read(texts: &[String], channels: &[Channel]) -> Result<Vec<Quantity>, ResultsError> {
        let mut out: Vec<Quantity> = Vec::new();
        for text in texts {
            let text = text.trim();
            let known = |name: &str| channels.iter().find(|channel| channel.name == name);
            let end = ENDS.iter().find_map(|(end, value)| Some((text.strip_suffix(end)?, *value)));
            let found = match (known(text), end) {
                (Some(channel), _) => Some((channel, vec![Value::Min, Value::Max, Value::Final])),
                (None, Some((column, value))) => known(column).map(|channel| (channel, vec![value])),
                (None, None) => None,
            };
            let (channel, values) = found.ok_or_else(|| {
                let column = end.map_or(text, |(column, _)| column);
                let names: Vec<&str> = channels.iter().map(|channel| channel.name.as_str()).collect();
                ResultsError::NoColumn {
                    pattern: column.to_owned(),
                    of: "this case".to_owned(),
                    nearest: nearest(column, names.iter().copied()).map(str::to_owned),
                    there: names.join(", "),
                }
            })?;
            for value in values {
                let quantity =
                    Quantity { column: channel.name.clone(), value, unit: channel.unit.to_string() };
                if !out.contains(&quantity) {
                    out.push(quantity);
                }
            }
        }
        Ok(out)
    }

    /// Its value in a run.
    ///
    /// # Errors
    /// Why there is none.
    pub fn collect(&self, run: &Run) -> Result<Collected, String> {
        let trajectory: &Trajectory = &run.trajectory;
        let index = trajectory
            .index(&self.column)
            .ok_or_else(|| format!("the run has no column `{}`", self.column))?;
        let of = trajectory.extremes(index);
        if let Some(time) = of.not_finite {
            return Err(format!("{} is not finite at t = {time} s", self.column));
        }
        let last = trajectory.times().last().copied().unwrap_or(f64::NAN);
        let (value, time) = match self.value {
            Value::Min => (of.min, of.t_min),
            Value::Max => (of.max, of.t_max),
            Value::Final => (of.last, last),
        };
        let known = run.errors.as_ref().filter(|errors| errors.unknown.is_none());
        let column = known.and_then(|errors| errors.columns.iter().find(|of| of.column == self.column));
        let of_value = |ColumnError { min, max, last, .. }: &ColumnError| match self.value {
            Value::Min => *min,
            Value::Max => *max,
            Value::Final => *last,
        };
        let error = column.map(of_value).filter(|error| error.is_finite());
        Ok(Collected { value, time, error, trusted: known.map(|errors| time <= errors.trusted) })
    }
}

impl Prepared {
    /// The quantities that these texts name among the columns that the run will record, as [`Quantity::read`].
    ///
    /// # Errors
    /// A name that is none.
    pub fn quantities(&mut self, texts: &[String]) -> Result<Vec<Quantity>, ResultsError> {
        Quantity::read(texts, &self.channels())
    }
}
