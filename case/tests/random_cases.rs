//! Cases at random: what a run reports as its error holds against a finer run of the exact coupling, or the run ends
//! with an error. `FLEXION_RANDOM_CASES=500` runs that many instead of a few; `FLEXION_RANDOM_FIRST`
//! begins with a later one, and `FLEXION_RANDOM_SEED` draws others.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)] // in helpers of tests

pub mod draw;

use draw::Drawn;
use flexion::system::State;
use flexion_case::{Effort, Problems, Reading, Run, parse};
use flexion_results::{Status, Trajectory};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Cases of a usual run of the tests.
const CASES: u64 = 100;

/// What is compared, with the size below which nobody asks, in lengths of the beam or in radians.
const COLUMNS: &[(&str, f64)] =
    &[("tip.deflection", 1e-9), ("tip.axial", 1e-9), ("tip.rotation", 1e-8), ("hub.angle", 1e-9)];

/// The reference: elements and tolerances. A case that is off by more than it reports is held against the next,
/// finer one, for it may be the reference that is wrong.
const REFERENCES: &[[&str; 3]] = &[
    [
        "model.coupling=exact",
        "basis={kind='finite-elements',elements=24}",
        "integrator={kind='radau',tolerance=1e-7,absolute-tolerance=1e-9}",
    ],
    [
        "model.coupling=exact",
        "basis={kind='finite-elements',elements=48}",
        "integrator={kind='radau',tolerance=1e-10,absolute-tolerance=1e-12}",
    ],
];

/// Work that a case may cost, its companions, and each of its references: steps times (unknowns + 30).
const BUDGET: f64 = 6e6;

/// How a case ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Verdict {
    /// Right within the reported error.
    Right,
    /// The case was refused, and the reason is none of those that are known.
    Misread,
    /// The case was refused, with a reason that no key alone can tell.
    Refused,
    /// The run ended with an error.
    Failed,
    /// The run said that its error is not known.
    NotEstimated,
    /// A run was given up for the work it takes.
    OutOfTime,
    /// The exact coupling has no solution to compare with.
    NoReference,
    /// Off by more than was reported.
    Wrong,
}

fn read(text: &str, overrides: &[&str]) -> Result<Reading, Problems> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    parse(text.to_owned(), Path::new("case.toml"), &overrides)
}

/// Counts the work of runs, and stops them when it is used up.
#[derive(Default)]
struct Work {
    done: f64,
}

impl Work {
    fn watch(&mut self, state: &State) -> ControlFlow<()> {
        self.done += state.q.len() as f64 + 30.0;
        if self.done > BUDGET { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

fn run(reading: &Reading) -> Result<Run, Problems> {
    let mut work = Work::default();
    Ok(reading.prepare()?.run(&mut |state| work.watch(state)))
}

/// Largest difference of a column over the common rows.
fn apart(a: &Trajectory, b: &Trajectory, column: &str) -> f64 {
    let (a, b) = (a.column(column).unwrap(), b.column(column).unwrap());
    // Written so that NaN is kept.
    let differences = a.iter().zip(&b).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, |largest, d| if d <= largest { largest } else { d })
}

/// A column that is off by more than was reported.
struct Beyond {
    column: &'static str,
    found: f64,
    reported: f64,
}

/// Reads the case and brings it to its start, with the smaller step that the message asks for if it was refused.
fn admitted(text: &str) -> Result<Reading, Problems> {
    let mut factor = 1.0;
    loop {
        let reading = read(text, &[])?;
        let step = reading.case.steps.step();
        let shorter = step.map(|step| format!("integrator.step={:e}", step * factor));
        let overrides: Vec<&str> = shorter.iter().map(String::as_str).filter(|_| factor < 1.0).collect();
        let reading = read(text, &overrides)?;
        match reading.prepare().map(drop) {
            Ok(()) => return Ok(reading),
            Err(problems)
                if factor > 1e-6 && problems.list.iter().all(|p| p.message.contains("stability limit")) =>
            {
                factor *= 0.5;
            }
            Err(problems) => return Err(problems),
        }
    }
}

/// Runs one case; with a verdict other than the harmless ones goes a message.
fn judge(drawn: &Drawn) -> (Verdict, String) {
    let text = drawn.text.as_str();
    let reading = match admitted(text) {
        Ok(reading) => reading,
        Err(problems) => {
            // Only for what no key alone can tell.
            let known = |message: &str| message.contains("singular");
            return match problems.list.iter().find(|problem| !known(&problem.message)) {
                Some(problem) => (Verdict::Misread, format!("refused: {}: {}", problem.key, problem.message)),
                None => (Verdict::Refused, String::new()),
            };
        }
    };
    let begun = Instant::now();
    let run_of_case = match run(&reading) {
        Ok(run) => run,
        Err(problems) => return (Verdict::Misread, problems.to_string()),
    };
    let took = begun.elapsed();
    match run_of_case.status {
        Status::Finished => {}
        Status::Stopped => return (Verdict::OutOfTime, "the run".to_owned()),
        Status::Failed => return (Verdict::Failed, run_of_case.message.unwrap_or_default()),
    }
    let begun = Instant::now();
    let mut work = Work::default();
    let errors = match reading.estimate_errors(&run_of_case, Effort::Full, &mut |state| work.watch(state)) {
        Ok(errors) => errors,
        Err(problems) => return (Verdict::Misread, format!("no estimate: {problems}")),
    };
    let spent = format!("run {took:.1?}, companions {:.1?} ({:.1e})", begun.elapsed(), work.done);
    if work.done > BUDGET {
        return (Verdict::OutOfTime, format!("companions: {spent}"));
    }
    if !errors.warnings.is_empty() {
        return (Verdict::NotEstimated, errors.warnings.join("; "));
    }
    let mut beyond = Vec::new();
    for (k, finest) in REFERENCES.iter().enumerate() {
        let begun = Instant::now();
        let reference = match read(text, finest).and_then(|reading| run(&reading)) {
            Ok(reference) => reference,
            Err(problems) => return (Verdict::NoReference, problems.to_string()),
        };
        match reference.status {
            Status::Finished => {}
            Status::Stopped => return (Verdict::OutOfTime, format!("reference {k}: {spent}")),
            Status::Failed => return (Verdict::NoReference, reference.message.unwrap_or_default()),
        }
        beyond.clear();
        let mut largest = 0.0_f64;
        for (column, negligible) in COLUMNS {
            let Some(error) = errors.columns.iter().find(|error| error.column == *column) else { continue };
            let exact = reading.case.hub_beam().unwrap().coupling.whole_curve;
            let Some(model) = error.model.or(exact.then_some(0.0)) else {
                return (Verdict::Wrong, format!("no model error of {column} and no word about it"));
            };
            let unit = if column.ends_with('n') { 1.0 } else { drawn.length };
            let values = |run: &Run| {
                let e = run.trajectory.extremes(run.trajectory.index(column).unwrap());
                [e.min, e.max, e.last]
            };
            let [min, max, last] =
                std::array::from_fn(|k| (values(&run_of_case)[k] - values(&reference)[k]).abs());
            let history = apart(&run_of_case.trajectory, &reference.trajectory, column);
            for (found, discretization) in
                [(history, error.discretization), (min, error.min), (max, error.max), (last, error.last)]
            {
                let reported = discretization + model + negligible * unit;
                largest = largest.max(found / reported);
                // Written so that NaN is an error.
                if !(found <= reported) {
                    beyond.push(Beyond { column, found, reported });
                }
            }
        }
        if beyond.is_empty() {
            let took = begun.elapsed();
            return (
                Verdict::Right,
                format!("{largest:.2} of what it reports; {spent}, reference {k} {took:.1?}"),
            );
        }
    }
    let all: Vec<String> = beyond
        .iter()
        .map(|b| format!("{} is off by {:e}, and the run reports {:e}", b.column, b.found, b.reported))
        .collect();
    (Verdict::Wrong, all.join("; "))
}

#[test]
fn a_run_is_right_within_its_reported_error_or_ends_with_an_error() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let seed = number("FLEXION_RANDOM_SEED").unwrap_or(1);
    let first = number("FLEXION_RANDOM_FIRST").unwrap_or(0);
    let count = number("FLEXION_RANDOM_CASES").unwrap_or(CASES);
    let threads = number("FLEXION_RANDOM_THREADS").map_or_else(
        || std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        |threads| threads as usize,
    );
    let (next, verdicts) = (AtomicU64::new(first), Mutex::new(BTreeMap::new()));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    if k >= first + count {
                        break;
                    }
                    let drawn = draw::case(seed.wrapping_mul(1_000_003).wrapping_add(k));
                    let begun = Instant::now();
                    let (verdict, message) = judge(&drawn);
                    eprintln!("case {k}: {verdict:?} after {:.1?}: {message}", begun.elapsed());
                    if matches!(
                        verdict,
                        Verdict::Wrong | Verdict::Misread | Verdict::OutOfTime | Verdict::NoReference
                    ) || begun.elapsed().as_secs() >= 10
                    {
                        eprintln!("{}", drawn.text);
                    }
                    verdicts.lock().unwrap().insert(k, (verdict, message));
                }
            });
        }
    });
    let verdicts = verdicts.into_inner().unwrap();
    let mut tally = BTreeMap::new();
    for (verdict, _) in verdicts.values() {
        *tally.entry(*verdict).or_insert(0_u64) += 1;
    }
    eprintln!("{count} cases of seed {seed} from {first}: {tally:?}");
    let of = |verdict| tally.get(&verdict).copied().unwrap_or(0);
    for (verdict, what) in [(Verdict::Wrong, "silently wrong"), (Verdict::Misread, "refused though valid")] {
        if let Some((k, (_, message))) = verdicts.iter().find(|(_, (found, _))| *found == verdict) {
            panic!("{} of {count} cases are {what}; the first is {k}: {message}", of(verdict));
        }
    }
    assert!(2 * of(Verdict::Right) > count, "too few cases say anything: {tally:?}");
}
