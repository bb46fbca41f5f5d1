//! A case of a family, run and held against its answer.

use super::{Answer, Posed, Relation};
use crate::outcome::{Compared, Ending, Outcome, run};
use flexion::analysis::recording::Extremes;
use flexion::system::{Channel, Role};
use flexion_case::{Effort, Problems, Reading, Run};
use flexion_results::{ColumnError, Status};
use std::ops::ControlFlow;

/// Error of what has no stated one, over the largest value of its column.
const UNSTATED: f64 = 1e-2;

/// A finished run with its stated errors and its warnings.
struct Answered {
    run: Run,
    errors: Vec<ColumnError>,
    warnings: Vec<String>,
}

/// Smallest, largest and last value of a column with their stated errors.
type Values = [(f64, f64); 3];

const PARTS: [&str; 3] = ["min", "max", "final"];

impl Answered {
    /// The answer of a case, or how it ended otherwise.
    fn of(reading: &Reading) -> Result<Result<Answered, Ending>, Problems> {
        let ours = run(reading)?;
        match ours.status {
            Status::Finished => {}
            Status::Stopped => return Ok(Err(Ending::Unknown("the run takes too long".to_owned()))),
            Status::Failed => return Ok(Err(Ending::Failed(ours.message.unwrap_or_default()))),
        }
        let errors = reading.estimate_errors(&ours, Effort::Auto, &mut |_| ControlFlow::Continue(()));
        let facts = reading.case.unused_by_run();
        let said = ours.warnings.iter().chain(&errors.warnings);
        // Of right answers too it is said what a run does not use and that a part moves freely; a coarse mesh is one of a column, whose
        // stated error says as much.
        let fact = |w: &&String| {
            facts.contains(w) || w.contains("held by no joint") || w.contains("are coarse: the error of")
        };
        let warnings = said.filter(|w| !fact(w)).cloned().collect();
        Ok(Ok(Answered { run: ours, errors: errors.columns, warnings }))
    }

    fn values(&self, column: &str) -> Option<Values> {
        let e: Extremes = self.run.trajectory.extremes(self.run.trajectory.index(column)?);
        let error = self.errors.iter().find(|error| error.column == column);
        let unstated = [UNSTATED * e.largest(); 3];
        let [min, max, last] = error.map_or(unstated, |error| [error.min, error.max, error.last]);
        Some([(e.min, min), (e.max, max), (e.last, last)])
    }

    /// The columns that a comparison of two cases is of.
    fn columns(&self) -> impl Iterator<Item = &Channel> {
        let compared = |c: &&Channel| !matches!(c.role, Role::Integration | Role::Imbalance);
        self.run.trajectory.channels().iter().filter(compared)
    }
}

/// Runs a case of a family as `flexion run` does, and holds it against its answer.
pub fn judge(posed: &Posed, number: u64) -> Outcome {
    let mut outcome = Outcome {
        number,
        subject: posed.case.subject,
        ending: Ending::Known,
        warnings: Vec::new(),
        values: Vec::new(),
    };
    outcome.ending = match judged(posed, &mut outcome) {
        Ok(ending) => ending,
        Err(problems) => Ending::Refused(problems.to_string()),
    };
    outcome
}

fn judged(posed: &Posed, outcome: &mut Outcome) -> Result<Ending, Problems> {
    let ours = match Answered::of(&posed.case.read(&[])?)? {
        Ok(ours) => ours,
        Err(ending) => return Ok(ending),
    };
    outcome.warnings.clone_from(&ours.warnings);
    match &posed.answer {
        Answer::Known(list) => {
            for known in list {
                let part = PARTS.iter().position(|part| *part == known.part).unwrap_or(2);
                let (value, stated) =
                    ours.values(&known.column).map_or((f64::NAN, f64::NAN), |values| values[part]);
                let size = largest(&ours, &known.column).max(known.value.abs());
                let channel = ours.columns().find(|c| c.name == known.column);
                outcome.values.push(Compared {
                    column: known.column.clone(),
                    part: PARTS[part],
                    principal: channel.is_some_and(|c| c.role == Role::Primary),
                    value,
                    size,
                    stated: stated + known.within,
                    off: (value - known.value).abs(),
                    exact: None,
                });
            }
        }
        Answer::Other(other, relation) => {
            let theirs = match Answered::of(&other.read(&[])?)? {
                Ok(theirs) => theirs,
                Err(ending) => return Ok(ending),
            };
            outcome.warnings.extend(theirs.warnings.clone());
            for channel in ours.columns() {
                // Parts that are named otherwise have columns of their own.
                let (Some(a), Some(b)) = (ours.values(&channel.name), theirs.values(&channel.name)) else {
                    continue;
                };
                let b = match relation {
                    Relation::Scaled(factors) => {
                        let factor = scale(&channel.unit, *factors);
                        b.map(|(value, error)| (value / factor, error / factor))
                    }
                    _ => b,
                };
                let mut compared = pair(channel, largest(&ours, &channel.name), a, b);
                if matches!(relation, Relation::Mirrored) {
                    let [min, max, last] = b.map(|(value, error)| (-value, error));
                    let negative = pair(channel, largest(&ours, &channel.name), a, [max, min, last]);
                    let worst = |of: &[Compared]| of.iter().map(|v| v.off).fold(0.0, f64::max);
                    if worst(&negative) < worst(&compared) {
                        compared = negative;
                    }
                }
                outcome.values.extend(compared);
            }
        }
        Answer::Pairs(first, second) => {
            for channel in ours.columns() {
                let Some(rest) = channel.name.strip_prefix(first) else { continue };
                let other = ours.values(&format!("{second}{rest}"));
                let (Some(a), Some(b)) = (ours.values(&channel.name), other) else {
                    return Ok(Ending::Failed(format!("no column {second}{rest}")));
                };
                outcome.values.extend(pair(channel, largest(&ours, &channel.name), a, b));
            }
        }
    }
    Ok(Ending::Known)
}

/// The largest absolute value of a column.
fn largest(of: &Answered, column: &str) -> f64 {
    of.values(column).map_or(0.0, |values| values[0].0.abs().max(values[1].0.abs()))
}

/// Values of two columns that should be equal; the stated errors are added.
fn pair(channel: &Channel, size: f64, a: Values, b: Values) -> Vec<Compared> {
    let of = |k: usize| Compared {
        column: channel.name.clone(),
        part: PARTS[k],
        principal: channel.role == Role::Primary,
        value: a[k].0,
        size,
        stated: a[k].1 + b[k].1,
        off: (a[k].0 - b[k].0).abs(),
        exact: None,
    };
    (0..3).map(of).collect()
}

/// The factor of a quantity when length, mass and time have others: of `N*m` it is m l²/t².
fn scale(unit: &str, [length, mass, time]: [f64; 3]) -> f64 {
    let of = |symbol: &str| match symbol {
        "m" => length,
        "kg" => mass,
        "s" => time,
        "N" => mass * length / (time * time),
        "J" => mass * length * length / (time * time),
        "W" => mass * length * length / (time * time * time),
        "Pa" => mass / (length * time * time),
        // Angles, and pure numbers.
        _ => 1.0,
    };
    let product = |symbols: &str| -> f64 {
        let one = |symbol: &str| match symbol.split_once('^') {
            Some((symbol, power)) => of(symbol).powi(power.parse().unwrap_or(1)),
            None => of(symbol),
        };
        symbols.split('*').map(one).product()
    };
    let (over, under) = unit.split_once('/').unwrap_or((unit, ""));
    product(over) / product(under)
}
