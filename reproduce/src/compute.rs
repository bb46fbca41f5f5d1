//! Computing what is needed, on all processors, each answer kept as soon as it is there.

use crate::answer::{Answer, Curve, Valued};
use crate::described::{Energy, EnergyTerm, OfEnergy, OfModes};
use crate::keep::Kept;
use crate::need::{Asks, Need};
use crate::shared::Shared;
use flexion::analysis::error::SAFETY;
use flexion::strain_energy::{StrainEnergy, Terms};
use flexion::system::Channel;
use flexion_case::{Contents, Effort, ModesRequest, Quantity, Reading, Request, Run, parse_with, units};
use flexion_results::{Frequencies, Status, Trajectory, Units};
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// How it is computed.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Whether runs that take long are computed.
    pub long: bool,
    /// The numbers of the runs that are computed; `None` for all.
    pub only: Option<BTreeSet<usize>>,
    /// Number of threads; 0 for one on each processor.
    pub threads: usize,
    /// Where answers are kept and looked for; `None` computes all anew.
    pub keep: Option<PathBuf>,
    /// What is computing, by which kept answers are of use.
    pub identity: String,
}

/// How far it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Runs that are done.
    pub done: usize,
    /// Of so many.
    pub of: usize,
    /// Of these, found from an earlier call.
    pub found: usize,
}

/// It was stopped before all runs were done.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("stopped: the runs that are done are kept, and the same command goes on with the others")]
pub struct Stopped;

/// The answers of these runs of a paper, in their order; `None` where a run takes long and is not asked for.
///
/// # Errors
/// [`Stopped`]
pub fn compute(
    cases: &BTreeMap<String, String>,
    needs: &[Need],
    options: &Options,
    stop: &(dyn Fn() -> bool + Sync),
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Option<Answer>>, Stopped> {
    let kept = options.keep.as_ref().map(|folder| Kept::new(folder, &options.identity));
    let asked = |i: &usize| options.only.as_ref().is_none_or(|only| only.contains(i));
    let wanted = |i: &usize| asked(i) && (options.long || needs[*i].run.seconds.is_none());
    let mut order: Vec<usize> = (0..needs.len()).filter(wanted).collect();
    // The longest first.
    order.sort_by(|a, b| {
        needs[*b].run.seconds.unwrap_or(0.0).total_cmp(&needs[*a].run.seconds.unwrap_or(0.0))
    });
    let answers: Mutex<Vec<Option<Answer>>> = Mutex::new(vec![None; needs.len()]);
    let (next, done, found) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicUsize::new(0));
    let shared = Shared::default();
    let threads = if options.threads == 0 {
        std::thread::available_parallelism().map_or(1, std::num::NonZeroUsize::get)
    } else {
        options.threads
    };
    let none = String::new();
    std::thread::scope(|scope| {
        for _ in 0..threads.min(order.len()) {
            scope.spawn(|| {
                while let Some(&number) = order.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if stop() {
                        return;
                    }
                    let need = &needs[number];
                    let text = cases.get(&need.run.key.case).unwrap_or(&none);
                    let before = kept.as_ref().and_then(|kept| kept.find(text, need));
                    let answer = match before {
                        Some(answer) => {
                            found.fetch_add(1, Ordering::Relaxed);
                            answer
                        }
                        None => {
                            let Ok(answer) = answered(text, need, &shared, stop) else { return };
                            if let Some(kept) = &kept {
                                kept.keep(text, need, &answer);
                            }
                            answer
                        }
                    };
                    answers.lock().unwrap_or_else(PoisonError::into_inner)[number] = Some(answer);
                    let done = done.fetch_add(1, Ordering::Relaxed) + 1;
                    progress(Progress { done, of: order.len(), found: found.load(Ordering::Relaxed) });
                }
            });
        }
    });
    if done.into_inner() < order.len() {
        return Err(Stopped);
    }
    Ok(answers.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// The answer of one run.
fn answered(text: &str, need: &Need, shared: &Shared, stop: &dyn Fn() -> bool) -> Result<Answer, Stopped> {
    let began = Instant::now();
    let run = &need.run;
    let file = format!("cases/{}.toml", run.key.case);
    let read = parse_with(text.to_owned(), Path::new(&file), &run.key.set, &Contents::new());
    let mut answer = match read {
        Err(problems) => Answer::rejected(problems.reason()),
        Ok(reading) => {
            let mut answer = match (&run.modes, &run.energy) {
                (Some(modes), _) => {
                    // Where the discretization is a part of what is asked.
                    let own = run.key.against.as_ref().is_some_and(Vec::is_empty);
                    frequencies(of_modes(&reading, modes, own), own)
                }
                (_, Some(energy)) => frequencies(of_energy(&reading, energy), true),
                _ => in_time(&reading, need, shared, stop)?,
            };
            answer.stated = titled(reading.stated(), &run.key.set);
            answer.times = times(&reading, need);
            answer
        }
    };
    for value in answer.values.values_mut() {
        if let Ok(Valued { value: number, error, .. }) = value {
            *error = error.filter(|error| error.is_finite());
            if !number.is_finite() {
                *value = Err("it is not finite".to_owned());
            }
        }
    }
    answer.seconds = began.elapsed().as_secs_f64();
    Ok(answer)
}

/// When a run in time ends by its case, and the interval of its records \[s\].
pub fn times(reading: &Reading, need: &Need) -> Option<[f64; 2]> {
    (need.run.key.asks == Asks::Run).then_some([reading.case.duration, reading.case.output.step])
}

/// A case as it is written, whose title says what was changed.
fn titled(stated: String, set: &[String]) -> String {
    let Some((before, rest)) = stated.split_once("title = \"") else { return stated };
    let Some((title, behind)) = rest.split_once("\"\n").filter(|_| !set.is_empty()) else { return stated };
    let changes: Vec<String> = set.iter().map(|set| set.replacen('=', " = ", 1).replace('"', "'")).collect();
    format!("{before}title = \"{title}, with {}\"\n{behind}", changes.join(", "))
}

/// What a run in time says.
fn in_time(
    reading: &Reading,
    need: &Need,
    shared: &Shared,
    stop: &dyn Fn() -> bool,
) -> Result<Answer, Stopped> {
    let mut prepared = match reading.prepare() {
        Ok(prepared) => prepared.without_pictures(),
        Err(problems) => return Ok(Answer::rejected(problems.reason())),
    };
    let quantities: BTreeMap<&String, Result<Quantity, String>> = need
        .quantities
        .iter()
        .map(|name| {
            let read = prepared.quantities(std::slice::from_ref(name)).map_err(|error| error.to_string());
            (name, read.and_then(|mut read| read.pop().ok_or_else(|| format!("{name} is no quantity"))))
        })
        .collect();
    let units = units_of(&quantities, &need.columns, &prepared.channels());
    let against = need.run.key.against.as_ref();
    let request = Request { effort: against.is_none().then_some(Effort::Full), ..Request::default() };
    let mut watch =
        |_: flexion_case::Stage<'_>| if stop() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let run = match reading.calculate(prepared, &request, &mut watch) {
        Ok(calculation) => calculation.run,
        Err(error) => return Ok(Answer::rejected(error.to_string())),
    };
    let changes = against.filter(|changes| !changes.is_empty());
    let itself = against.is_some_and(Vec::is_empty);
    let other = changes.map(|changes| {
        let other = reading.with(changes).map_err(|problems| problems.reason())?;
        shared.run(&other, stop)
    });
    if stop() {
        return Err(Stopped);
    }
    let same = |other: &std::sync::Arc<Run>| other.trajectory == run.trajectory;
    let other = other.map(|other| {
        other.and_then(|other| {
            let end = |run: &Run| run.trajectory.times().last().copied().unwrap_or(0.0);
            if same(&other) {
                Err("`against` gives the same run, which says nothing of its errors".to_owned())
            } else if end(&other) < end(&run) * (1.0 - 1e-9) {
                let ends = format!(
                    "the run of `against` ends at t = {} s, before this one at {} s",
                    end(&other),
                    end(&run)
                );
                Err(other.message.as_ref().map_or(ends.clone(), |why| format!("{ends}: {why}")))
            } else {
                Ok(other)
            }
        })
    });
    let values = quantities.into_iter().map(|(name, quantity)| {
        let valued = quantity.and_then(|quantity| {
            let collected = match &other {
                Some(Ok(other)) => quantity.collect_against(&run, other)?,
                _ => quantity.collect(&run)?,
            };
            let value = collected.value;
            // Where the run is asked for with the mesh and the steps that it has.
            let own = itself && !quantity.varies();
            let error = if own {
                Some(if value.fract() == 0.0 { 0.0 } else { ROUNDED * value.abs() } + collected.records)
            } else {
                collected.error
            };
            Ok(Valued { value, error, varies: quantity.varies(), unit: quantity.unit })
        });
        (name.clone(), valued)
    });
    let compared = match (&other, &run.errors) {
        (Some(Ok(other)), _) => Some((Cow::Borrowed(&other.trajectory), SAFETY)),
        (_, Some(errors)) if errors.unknown.is_none() => Some((Cow::Borrowed(&errors.finer), errors.safety)),
        _ => None,
    };
    let curve_of = |name: &String| {
        let mut curve = curve(&run, name, compared.as_ref())?;
        if itself {
            curve.off = vec![0.0; curve.t.len()];
        }
        Ok(curve)
    };
    let curves = need.columns.iter().map(|name| (name.clone(), curve_of(name)));
    let errors = match (&other, changes, &run.errors) {
        (Some(Ok(_)), Some(changes), _) => {
            format!("twice the difference from the run with {}", changes.join(", "))
        }
        (Some(Err(why)), ..) => format!("not known: {why}"),
        (.., Some(errors)) => errors.unknown.as_ref().map_or_else(
            || "by a companion with a finer mesh and a more accurate integration".to_owned(),
            |why| format!("not known: {why}"),
        ),
        _ if itself => "of rounding, and of the distance of records: the run is asked for with the mesh and the steps that it has".to_owned(),
        _ => "not known: the run ended early, and errors are estimated of whole runs; with `against` it is compared until then".to_owned(),
    };
    let warnings = run.all_warnings().map(str::to_owned).collect();
    Ok(Answer {
        status: if run.status == Status::Finished { "finished" } else { "failed" }.to_owned(),
        message: run.message.clone(),
        warnings,
        units,
        errors,
        values: values.collect(),
        curves: curves.collect(),
        ..Answer::default()
    })
}

/// The units of quantities and columns.
fn units_of(
    quantities: &BTreeMap<&String, Result<Quantity, String>>,
    columns: &BTreeSet<String>,
    channels: &[Channel],
) -> BTreeMap<String, String> {
    let of =
        quantities.iter().filter_map(|(name, of)| Some(((*name).clone(), of.as_ref().ok()?.unit.clone())));
    let known = |name: &String| channels.iter().find(|channel| channel.name == *name);
    let columns = columns.iter().filter_map(|name| Some((name.clone(), known(name)?.unit.to_string())));
    of.chain(columns).collect()
}

/// A column over time, with its difference from another run times a factor.
fn curve(run: &Run, name: &str, compared: Option<&(Cow<'_, Trajectory>, f64)>) -> Result<Curve, String> {
    let of: &Trajectory = &run.trajectory;
    let unknown = || {
        let names: Vec<&str> = of.channels().iter().map(|channel| channel.name.as_str()).collect();
        format!("the run has no column `{name}`; there are {}", names.join(", "))
    };
    let index = of.index(name).ok_or_else(unknown)?;
    let Channel { unit, .. } = &of.channels()[index];
    let y: Vec<f64> = of.values(index).collect();
    let off = compared.and_then(|(other, safety)| {
        let theirs = other.index(name)?;
        let off = of.times().iter().zip(&y).map(|(t, y)| {
            let there = other.at(theirs, *t).filter(|_| *t <= other.times().last().copied().unwrap_or(0.0));
            there.map_or(f64::NAN, |other| safety * (y - other).abs())
        });
        Some(off.collect())
    });
    Ok(Curve { unit: unit.to_string(), t: of.times().to_vec(), y, off: off.unwrap_or_default() })
}

/// Frequencies with their errors, and their unit.
type Found = Result<(Vec<(f64, Option<f64>)>, &'static str), String>;

fn frequencies(found: Found, own: bool) -> Answer {
    match found {
        Err(why) => Answer::rejected(why),
        Ok((found, unit)) => {
            let valued = |(i, (value, error)): (usize, (f64, Option<f64>))| {
                let unit = unit.to_owned();
                (format!("frequency-{}", i + 1), Ok(Valued { value, error, unit, varies: false }))
            };
            let units = (1..=found.len()).map(|number| (format!("frequency-{number}"), unit.to_owned()));
            Answer {
                status: "finished".to_owned(),
                units: units.collect(),
                errors: if own { "of rounding" } else { "by a finer mesh" }.to_owned(),
                values: found.into_iter().enumerate().map(valued).collect(),
                ..Answer::default()
            }
        }
    }
}

/// The unit of time of frequencies \[s\], and a speed \[rad/s\]: a pure number is over that unit.
pub fn scale(unit: Option<&toml::Value>, speed: &toml::Value) -> Result<(Option<f64>, f64), String> {
    let number = |value: &toml::Value, measure: &units::Measure| match value {
        toml::Value::Integer(number) => Ok(*number as f64),
        toml::Value::Float(number) => Ok(*number),
        toml::Value::String(text) => units::parse(text, measure).map_err(|error| error.message),
        other => Err(format!("{other} is no {}", measure.name)),
    };
    let unit = unit.map(|unit| number(unit, &units::TIME)).transpose()?;
    // What is filled in by `each` is a text without a unit.
    let pure = match speed {
        toml::Value::String(text) => text.trim().parse::<f64>().ok(),
        toml::Value::Integer(number) => Some(*number as f64),
        toml::Value::Float(number) => Some(*number),
        _ => None,
    };
    let speed = match (pure, unit) {
        (Some(pure), Some(unit)) => pure / unit,
        _ => number(speed, &units::ANGULAR_SPEED)?,
    };
    Ok((unit, speed))
}

fn of_modes(reading: &Reading, asked: &OfModes, own: bool) -> Found {
    let (unit, speed) = scale(asked.unit.as_ref(), &asked.speed)?;
    let factor = unit.unwrap_or(1.0);
    let found = if asked.transverse {
        reading.transverse_frequencies(speed, asked.count).map_err(|error| error.to_string())?
    } else {
        let units = Units { speed: Frequencies::RADIANS, frequency: Frequencies::RADIANS };
        let request = ModesRequest { speed, count: asked.count, free_hub: false, units, film: false };
        let found = reading.modes(&request).map_err(|error| error.to_string())?;
        let modes = found.modes.modes.iter();
        modes
            .map(|mode| (mode.frequency(), mode.mesh.map(|mesh| mesh + mode.rounding * mode.frequency())))
            .collect()
    };
    let rounding =
        |(value, error): (f64, Option<f64>)| (value, if own { Some(ROUNDED * value) } else { error });
    let found = found.into_iter().map(rounding);
    let scaled = found.map(|(value, error)| (factor * value, error.map(|error| factor * error)));
    Ok((scaled.collect(), if unit.is_some() { "" } else { "rad/s" }))
}

/// What rounding leaves of a value, relative.
const ROUNDED: f64 = 1e-12;
/// What Ritz's method with 20 polynomials leaves of the first frequencies, relative.
const RITZ: f64 = 1e-9;

fn of_energy(reading: &Reading, asked: &OfEnergy) -> Found {
    let (unit, speed) = scale(asked.unit.as_ref(), &asked.speed)?;
    let has = |term| asked.terms.contains(&term);
    let energy = match asked.energy {
        Energy::Linear => StrainEnergy::Linear,
        Energy::Exact => StrainEnergy::Exact,
        Energy::Coupled if asked.terms.is_empty() => StrainEnergy::Coupled(Terms::ALL),
        Energy::Coupled => StrainEnergy::Coupled(Terms {
            bending_first: has(EnergyTerm::BendingFirst),
            bending_second: has(EnergyTerm::BendingSecond),
            axial_first: has(EnergyTerm::AxialFirst),
            axial_second: has(EnergyTerm::AxialSecond),
            stretched_inertia: has(EnergyTerm::StretchedInertia),
        }),
    };
    let found = reading.frequencies_by(energy, speed, asked.count).map_err(|error| error.to_string())?;
    let factor = unit.unwrap_or(1.0);
    let own = found.into_iter().map(|flapwise| {
        let square = flapwise * flapwise - if asked.chordwise { speed * speed } else { 0.0 };
        let frequency = factor * square.max(0.0).sqrt();
        (frequency, Some(RITZ * factor * flapwise * flapwise / square.max(f64::MIN_POSITIVE).sqrt()))
    });
    Ok((own.collect(), if unit.is_some() { "" } else { "rad/s" }))
}
