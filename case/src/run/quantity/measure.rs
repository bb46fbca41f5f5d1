//! The value of a quantity in a run.

use super::super::Run;
use super::{Of, OfContact, Quantity, Value, Work};
use flexion::analysis::recording::{Entry, Events};
use flexion_results::Trajectory;

/// A value, and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// In the unit of the quantity.
    pub value: f64,
    /// When the run first has it, or the last time that it is of \[s\].
    pub time: f64,
}

impl Quantity {
    /// Its value in a run.
    pub(super) fn measure_run(&self, run: &Run) -> Result<Measured, String> {
        let last = run.trajectory.times().last().copied().unwrap_or(f64::NAN);
        let at_end = |value: f64| Ok(Measured { value, time: last });
        match &self.of {
            Of::Column(column, value) => self.measure_column(&run.trajectory, column, *value),
            Of::Contact(contact, what) => self.measure_contact(&run.events, contact, *what, run.state.t),
            Of::Work(work) => at_end(match work {
                Work::Steps => run.counters.steps as f64,
                Work::Rejected => run.counters.rejected as f64,
                Work::Residuals => run.counters.residuals as f64,
                Work::Factorisations => run.counters.factorizations as f64,
                Work::Seconds => run.cpu_time.unwrap_or(run.wall_time),
            }),
            Of::End => at_end(run.state.t),
            Of::Trusted => {
                let errors = run.errors.as_ref().ok_or("the errors of the run were not estimated")?;
                match &errors.unknown {
                    Some(why) => Err(why.clone()),
                    None => at_end(errors.trusted),
                }
            }
        }
    }

    pub(super) fn measure_column(
        &self,
        of: &Trajectory,
        column: &str,
        value: Value,
    ) -> Result<Measured, String> {
        let index = of.index(column).ok_or_else(|| format!("the run has no column `{column}`"))?;
        let last = of.times().last().copied().unwrap_or(f64::NAN);
        let (from, to) = self.within.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let asked = if let Value::At(time) = value { [time, time] } else { [from, to] };
        if let Some(time) = asked.into_iter().find(|time| between_records(of, *time)) {
            return Err(format!(
                "t = {time} s is between two records, where values are not known as well as at them: let one fall there by `output.step`"
            ));
        }
        if let Value::At(time) = value {
            let value = of.at(index, time).ok_or_else(|| format!("the run ends at t = {last} s"))?;
            return Ok(Measured { value, time });
        }
        if to.is_finite() && !(last >= to * (1.0 - 1e-9)) {
            return Err(format!("the run ends at t = {last} s"));
        }
        let extremes =
            if self.within.is_some() { of.extremes_within(index, from, to) } else { of.extremes(index) };
        if let Some(time) = extremes.not_finite {
            return Err(format!("{column} is not finite at t = {time} s"));
        }
        if extremes.min.is_nan() {
            return Err(format!("the run ends at t = {last} s, and has no record from t = {from} s on"));
        }
        let end = last.min(to);
        let (value, time) = match value {
            Value::Min => (extremes.min, extremes.t_min),
            Value::Max => (extremes.max, extremes.t_max),
            Value::Final | Value::At(_) => (extremes.last, end),
            Value::TimeOfMin => (extremes.t_min, extremes.t_min),
            Value::TimeOfMax => (extremes.t_max, extremes.t_max),
            Value::Amplitude => (0.5 * extremes.range(), end),
            Value::Middle => (0.5 * (extremes.max + extremes.min), end),
            Value::Largest if extremes.max.abs() >= extremes.min.abs() => {
                (extremes.max.abs(), extremes.t_max)
            }
            Value::Largest => (extremes.min.abs(), extremes.t_min),
            Value::Mean => (mean(of, index, (from, to), |y| y), end),
            Value::RootMeanSquare => {
                // Of parts of the largest value, whose squares neither overflow nor vanish.
                let largest = extremes.max.abs().max(extremes.min.abs());
                let scale = if largest > 0.0 { largest } else { 1.0 };
                (scale * mean(of, index, (from, to), |y| (y / scale).powi(2)).sqrt(), end)
            }
        };
        Ok(Measured { value, time })
    }

    /// What the distance h of the records leaves of a mean, or of an extreme within some times, which is that of parabolas through three of
    /// them: the largest difference from the same of every second and of every third record. Of a smooth curve this is more than three times
    /// the error O(h²) of a mean, and fifteen times the error O(h⁴) of an extreme; of one that the records do not follow, it is of its order.
    pub(super) fn error_of_records(&self, of: &Trajectory, value: f64) -> f64 {
        let Of::Column(column, what) = &self.of else { return 0.0 };
        let Some(index) = of.index(column) else { return 0.0 };
        let followed = match what {
            Value::Final | Value::At(_) | Value::TimeOfMin | Value::TimeOfMax => true,
            Value::Mean | Value::RootMeanSquare => false,
            // Extremes of the whole run are followed between the records too.
            _ => self.within.is_none(),
        };
        if followed {
            return 0.0;
        }
        let (from, to) = self.within.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let records = of.times().iter().copied().zip(of.values(index));
        let inside: Vec<(f64, f64)> = records.filter(|(t, _)| (from..=to).contains(t)).collect();
        // The ends of the times belong to each.
        let some = |every: usize, first: usize| {
            let mut part = Trajectory::new(vec![of.channels()[index].clone()]);
            for (k, (t, y)) in inside.iter().enumerate() {
                if k % every == first || k == 0 || k + 1 == inside.len() {
                    part.push(*t, |row| row[0] = *y);
                }
            }
            part
        };
        let parts = [(2, 0), (2, 1), (3, 0), (3, 1), (3, 2)];
        let found = parts
            .iter()
            .filter_map(|&(every, first)| self.measure_column(&some(every, first), column, *what).ok());
        found.fold(0.0, |most, found| most.max((found.value - value).abs()))
    }

    fn measure_contact(
        &self,
        events: &Events,
        contact: &str,
        what: OfContact,
        end: f64,
    ) -> Result<Measured, String> {
        let (from, to) = self.within.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let within =
            |entry: &&Entry| (from..=to).contains(&entry.time) && events.name(entry.contact) == contact;
        if to.is_finite() && end < to {
            return Err(format!("the run ends at t = {end} s"));
        }
        let of = |kinds: &'static [&'static str]| {
            events.list.iter().filter(within).filter(move |entry| kinds.contains(&entry.what))
        };
        let sum =
            |kinds, value: fn(&Entry) -> Option<f64>| of(kinds).filter_map(value).fold(0.0, |sum, x| sum + x);
        let at_end = |value: f64| Ok(Measured { value, time: end.min(to) });
        match what {
            OfContact::FirstTouch => {
                let first = of(&["impact", "touched", "closed"]).next();
                let time = first
                    .map(|entry| entry.time)
                    .ok_or_else(|| format!("{contact} is not touched until t = {end} s"))?;
                Ok(Measured { value: time, time })
            }
            // Impacts, the force of a closed contact until it opens, a continuous force; a burst is the sum of some of the first two.
            OfContact::Impulse => at_end(sum(&["impact", "opened", "left"], |entry| entry.impulse)),
            OfContact::Impacts => at_end(of(&["impact", "touched"]).count() as f64),
            OfContact::Loss => at_end(sum(&["impact", "left"], |entry| entry.lost)),
        }
    }
}

/// The mean of f(y) over the records from one time to another by the trapezoidal rule, ∫f(y) dt/T.
fn mean(of: &Trajectory, index: usize, (from, to): (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    let records = of.times().iter().copied().zip(of.values(index)).filter(|(t, _)| (from..=to).contains(t));
    let mut sum = 0.0;
    let mut ends: Option<[(f64, f64); 2]> = None;
    for (t, y) in records {
        let [first, (before, last)] = ends.unwrap_or([(t, f(y)); 2]);
        sum += 0.5 * (t - before) * (last + f(y));
        ends = Some([first, (t, f(y))]);
    }
    let Some([(start, only), (end, _)]) = ends else { return f64::NAN };
    if end > start { sum / (end - start) } else { only }
}

/// Whether a time within the records is none of theirs.
fn between_records(of: &Trajectory, time: f64) -> bool {
    let times = of.times();
    let next = times.partition_point(|t| *t < time);
    let same = |t: Option<&f64>| t.is_some_and(|t| (t - time).abs() <= 1e-9 * t.abs().max(1e-6));
    let inside = next > 0 && next < times.len();
    inside && !same(times.get(next)) && !same(times.get(next - 1))
}
