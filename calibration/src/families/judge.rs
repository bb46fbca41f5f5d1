//! A case of a family, run and held against its answer.

use super::crowds::{Crowd, Held, LONGEST, Sum};
use super::{Answer, Posed, Relation};
use crate::outcome::{Compared, Ending, Outcome, run};
use flexion::analysis::recording::Extremes;
use flexion::system::{Channel, Role};
use flexion_case::{Effort, Problems, Reading, Run};
use flexion_results::{ColumnError, Status};
use std::ops::ControlFlow;
use std::time::Instant;

/// Error of what has no stated one, over the largest value of its column.
const UNSTATED: f64 = 1e-2;

/// Error of a sum of forces or impulses that nobody states, over the sum.
const SUMMED: f64 = 1e-3;
/// Part of the energy in play that a run may make, and that may be gone without an account; steps that resolve contacts have losses with an error of the
/// size of a step.
const MADE: f64 = 1e-3;
const LOST: f64 = 1e-2;

/// A finished run with its stated errors.
struct Answered {
    run: Run,
    errors: Vec<ColumnError>,
}

/// Smallest, largest and last value of a column with their stated errors.
type Values = [(f64, f64); 3];

const PARTS: [&str; 3] = ["min", "max", "final"];

impl Answered {
    /// The answer of a case, or how it ended otherwise; its warnings and its time are added to an outcome.
    fn of(
        reading: &Reading,
        timed: bool,
        outcome: &mut Outcome,
    ) -> Result<Result<Answered, Ending>, Problems> {
        let begin = Instant::now();
        let watch = |begin: Instant| match timed && begin.elapsed() > LONGEST {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        };
        let ours = if timed { reading.prepare()?.run(&mut |_| watch(begin)) } else { run(reading)? };
        outcome.seconds = outcome.seconds.max(begin.elapsed().as_secs_f64());
        let facts = reading.case.unused_by_run();
        // Of right answers too it is said what a run does not use, that a part moves freely, and which steps follow friction; a coarse mesh is one of a column, whose
        // stated error says as much.
        let fact = |w: &&String| {
            facts.contains(w)
                || w.contains("held by no joint")
                || w.contains("are coarse: the error of")
                || w.contains("follow the direction of sliding")
        };
        outcome.warnings.extend(ours.warnings.iter().filter(|w| !fact(w)).cloned());
        match ours.status {
            Status::Finished => {}
            Status::Stopped => return Ok(Err(Ending::Unknown("the run takes too long".to_owned()))),
            Status::Failed => return Ok(Err(Ending::Failed(ours.message.unwrap_or_default()))),
        }
        let begin = Instant::now();
        let errors = reading.estimate_errors(&ours, Effort::Auto, &mut |_| watch(begin));
        outcome.warnings.extend(errors.warnings.iter().filter(|w| !fact(w)).cloned());
        Ok(Ok(Answered { run: ours, errors: errors.columns }))
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
    judged(posed, None, number)
}

/// The same of a crowd of contacts, which is held against their laws besides.
pub(super) fn judge_crowd(crowd: &Crowd, number: u64) -> Outcome {
    judged(&crowd.posed, Some(&crowd.held), number)
}

fn judged(posed: &Posed, held: Option<&Held>, number: u64) -> Outcome {
    let mut outcome = Outcome::of(number, posed.case.subject);
    outcome.ending = match answer(posed, held, &mut outcome) {
        Ok(ending) => ending,
        Err(problems) => Ending::Refused(problems.to_string()),
    };
    outcome
}

fn answer(posed: &Posed, held: Option<&Held>, outcome: &mut Outcome) -> Result<Ending, Problems> {
    let answered = |reading: &Reading, outcome: &mut Outcome| Answered::of(reading, held.is_some(), outcome);
    let ours = match answered(&posed.case.read(&[])?, outcome)? {
        Ok(ours) => ours,
        Err(ending) => return Ok(ending),
    };
    if let Some(held) = held {
        hold(held, &ours, outcome);
    }
    match &posed.answer {
        Answer::Known(list) => {
            for known in list {
                let part = PARTS.iter().position(|part| *part == known.part).unwrap_or(2);
                let (value, stated) =
                    ours.values(&known.column).map_or((f64::NAN, f64::NAN), |values| values[part]);
                let size = largest(&ours, &known.column).max(known.value.abs());
                let channel = ours.columns().find(|c| c.name == known.column);
                // Behind an impact on a beam nothing is stated: a crowd is held against what is well-posed all the same.
                let stated = if held.is_some() && !stated.is_finite() { UNSTATED * size } else { stated };
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
            let theirs = match answered(&other.read(&[])?, outcome)? {
                Ok(theirs) => theirs,
                Err(ending) => return Ok(ending),
            };
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

/// Holds a crowd of contacts against sums and laws.
fn hold(held: &Held, ours: &Answered, outcome: &mut Outcome) {
    let mut sum = |name: &str, value: f64, known: f64, stated: f64| {
        outcome.values.push(Compared {
            column: name.to_owned(),
            part: "final",
            principal: true,
            value,
            size: known.abs(),
            stated,
            off: (value - known).abs(),
            exact: None,
        });
    };
    for Sum { name, terms, value, within } in &held.sums {
        let of = |(column, factor): &(String, f64)| {
            let last = ours.run.trajectory.index(column).map(|i| ours.run.trajectory.extremes(i).last);
            factor * last.unwrap_or(f64::NAN)
        };
        // Stated errors of single forces say nothing of their sum.
        sum(name, terms.iter().map(of).sum(), *value, within + SUMMED * value.abs());
    }
    if let Some((value, within)) = held.impulse {
        let found = ours.run.events.impulses().map(|(_, impulse)| impulse).sum();
        sum("impulse of all contacts", found, value, within + SUMMED * value.abs());
    }
    let extremes = |suffix: &str| {
        let names =
            ours.run.trajectory.channels().iter().enumerate().filter(|(_, c)| c.name.ends_with(suffix));
        let least = |(m, n): (f64, f64), e: Extremes| (m.min(e.min), n.max(e.max));
        names.map(|(i, _)| ours.run.trajectory.extremes(i)).fold((0.0, 0.0), least)
    };
    let mut broken = |what: &str, by: f64, bound: f64| {
        // Written so that NaN is counted.
        if !(by <= bound) {
            outcome.broken.push(format!("{what}: {by:.2e}, and {bound:.2e} at most"));
        }
    };
    if let Some(entered) = held.entered {
        broken("a contact is entered [m]", -extremes(".gap").0, entered);
    }
    let (lost, made) = extremes("energy.balance");
    let nonsmooth = |text: &str| text.contains("nonsmooth-generalized-alpha") || text.contains("moreau-jean");
    let stepped = nonsmooth(ours.run.info.name) || ours.run.warnings.iter().any(|w| nonsmooth(w));
    // What is stated to be the error of the balance is not silent.
    let stated = ours.values("energy.balance").map_or([0.0; 2], |of| [of[0].1, of[1].1]);
    let [less, more] = stated.map(|error| if error.is_nan() { 0.0 } else { error });
    broken("energy is made [J]", made, if stepped { LOST } else { MADE } * held.energy + more);
    broken("energy goes nowhere [J]", -lost, LOST * held.energy + less);
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
