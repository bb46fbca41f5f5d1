//! `flexion calibrate`: stated against true errors of cases at random.

use crate::{Outcome, screen};
use flexion_case::calibration::{Counts, Ending, Outcome as Judged, draw, figure, judge};
use flexion_results::{Artifact, Directory, OutputError};
use indicatif::ProgressBar;
use serde_json::{Value, json};
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

/// The study.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion calibrate --cases 100 --seed 2 --output results/calibration
  flexion calibrate --seed 2 --show 17

Draws legal cases over all kinds: sections, motions, loads, damping, couplings, bases, integrators, tables, contacts, systems
in space. Each is run as `flexion run` does, and again far more finely; the true error of the min, max and final value of every
column is held against the stated one. The same seed gives the same cases. A thousand cases take half an hour on two
processors.

Exit codes: 0 finished, 1 command line rejected, 2 the files could not be written.")]
pub struct Arguments {
    /// Number of cases
    #[arg(long, value_name = "N", default_value = "100", value_parser = clap::value_parser!(u64).range(1..=1_000_000))]
    cases: u64,
    /// Number of the first case
    #[arg(long, value_name = "N", default_value = "0")]
    first: u64,
    /// Seed of the sequence of cases
    #[arg(long, value_name = "N", default_value = "1")]
    seed: u64,
    /// Print the case of this number, and the files that it names, and run nothing
    #[arg(long, value_name = "N")]
    show: Option<u64>,
    /// Directory for calibration.json, .csv and the picture
    #[arg(long, short, value_name = "DIR", default_value = "results/calibration")]
    output: PathBuf,
    /// Number of threads [default: one a processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1024))]
    threads: Option<u64>,
    /// Replace former results in that directory
    #[arg(long)]
    force: bool,
}

/// Runs a study, or shows a case of it.
pub fn calibrate(arguments: &Arguments) -> Outcome {
    if let Some(number) = arguments.show {
        let drawn = draw(arguments.seed, number);
        screen::print(&drawn.text);
        for (name, bytes) in &drawn.files {
            screen::print(&format!("# {name}\n"));
            let text = String::from_utf8_lossy(bytes);
            text.lines().for_each(|line| screen::print(&format!("#   {line}\n")));
        }
        return Outcome::Finished;
    }
    let directory = match Directory::create_for(Artifact::CALIBRATION, &arguments.output, arguments.force) {
        Ok(directory) => directory,
        Err(error) => {
            screen::report(&format!("error: {error}\n"));
            return Outcome::Rejected;
        }
    };
    let outcomes = study(arguments);
    let counts = Counts::of(&outcomes);
    let rows: Vec<Vec<String>> = counts.rows().into_iter().map(|row| row.to_vec()).collect();
    screen::print(&(screen::table(&rows) + "\n"));
    let written = write(arguments, &directory, &outcomes, &counts);
    let files = [("counts", Artifact::CalibrationJson), ("plot", Artifact::CalibrationSvg)];
    if screen::files(&directory, written, &files) { Outcome::Finished } else { Outcome::Incomplete }
}

/// The outcomes in the order of their numbers.
fn study(arguments: &Arguments) -> Vec<Judged> {
    let threads = arguments.threads.map_or_else(
        || std::thread::available_parallelism().map_or(1, std::num::NonZero::get),
        |threads| threads as usize,
    );
    let bar = ProgressBar::new(arguments.cases);
    let (next, outcomes) = (AtomicU64::new(0), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let k = next.fetch_add(1, Ordering::Relaxed);
                    if k >= arguments.cases {
                        break;
                    }
                    let number = arguments.first + k;
                    let outcome = judge(&draw(arguments.seed, number), number);
                    if let Ok(mut outcomes) = outcomes.lock() {
                        outcomes.push(outcome);
                    }
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    let mut outcomes = outcomes.into_inner().unwrap_or_default();
    outcomes.sort_by_key(|outcome| outcome.number);
    outcomes
}

fn write(
    arguments: &Arguments,
    directory: &Directory,
    outcomes: &[Judged],
    counts: &Counts,
) -> Result<(), OutputError> {
    directory.write(Artifact::CalibrationCsv, |f| {
        writeln!(f, "case,column,value,principal,warned,largest,stated,true,stated_with_model,off_exact")?;
        for o in outcomes {
            for v in &o.values {
                let (with_model, off) = v.exact.unwrap_or((f64::NAN, f64::NAN));
                writeln!(
                    f,
                    "{},{},{},{},{},{:e},{:e},{:e},{with_model:e},{off:e}",
                    o.number,
                    v.column,
                    v.part,
                    u8::from(v.principal),
                    u8::from(!o.warnings.is_empty()),
                    v.size,
                    v.stated,
                    v.off
                )?;
            }
        }
        Ok(())
    })?;
    let drawing = figure(outcomes).draw();
    directory.write(Artifact::CalibrationSvg, |f| f.write_all(drawing.svg().as_bytes()))?;
    let png = drawing.png()?;
    directory.write(Artifact::CalibrationPng, |f| f.write_all(&png))?;
    let case = |o: &Judged| {
        let (ending, why) = match &o.ending {
            Ending::Known => ("known", None),
            Ending::Unknown(why) => ("unknown", Some(why)),
            Ending::Failed(why) => ("failed", Some(why)),
            Ending::Refused(why) => ("refused", Some(why)),
        };
        json!({ "case": o.number, "of": o.subject, "ending": ending, "why": why, "warnings": o.warnings })
    };
    let table: Value = counts.rows().iter().map(|[what, count, asked]| json!([what, count, asked])).collect();
    let cases: Value = outcomes.iter().map(case).collect();
    let json = json!({
        "seed": arguments.seed, "first": arguments.first, "cases": arguments.cases, "counts": table,
        "silent": counts.silent, "wrong": counts.wrong, "outcomes": cases,
    });
    directory.write(Artifact::CalibrationJson, |f| writeln!(f, "{json:#}"))?;
    directory.publish()
}
