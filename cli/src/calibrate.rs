//! `flexion calibrate`: stated against true errors of cases at random.

use crate::run::stop_on_ctrl_c;
use crate::{Outcome, screen};
use flexion_case::calibration::{Counts, Ending, Outcome as Judged, draw, figure, study};
use flexion_results::{Artifact, Directory, OutputError};
use indicatif::ProgressBar;
use serde_json::{Value, json};
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::atomic::Ordering;

/// The study.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion calibrate --cases 100 --seed 2 --output results/calibration
  flexion calibrate --seed 2 --show 17

Draws legal cases over all kinds: sections, motions, loads, damping, couplings, bases, integrators, tables, contacts, systems
in space. Each is run as `flexion run` does, and again far more finely; the true error of the min, max and final value of every
column is held against the stated one. The same seed gives the same cases. Ctrl-C ends a
study after the cases that are running; what was judged is kept.

Exit codes: 0 finished, 1 command line rejected, 2 stopped, or the files could not be written.")]
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
    #[arg(long, value_name = "N", default_value = "0", hide_default_value = true)]
    threads: usize,
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
    let (bar, stop) = (ProgressBar::new(arguments.cases), stop_on_ctrl_c());
    let numbers = arguments.first..arguments.first.saturating_add(arguments.cases);
    let outcomes = study(arguments.seed, numbers, arguments.threads, &|| {
        bar.inc(1);
        !stop.load(Ordering::Relaxed)
    });
    bar.finish_and_clear();
    let counts = Counts::of(&outcomes);
    let rows: Vec<Vec<String>> = counts.rows().into_iter().map(|row| row.to_vec()).collect();
    screen::print(&(screen::table(&rows) + "\n"));
    let written = write(arguments, &directory, &outcomes, &counts);
    let files = [("counts", Artifact::CalibrationJson), ("plot", Artifact::CalibrationSvg)];
    if !screen::files(&directory, written, &files) {
        return Outcome::Incomplete;
    }
    if (outcomes.len() as u64) < arguments.cases {
        screen::report(&format!("error: stopped by the user after {} cases\n", outcomes.len()));
        return Outcome::Incomplete;
    }
    Outcome::Finished
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
        "seed": arguments.seed, "first": arguments.first, "cases": outcomes.len(), "counts": table,
        "silent": counts.silent, "wrong": counts.wrong, "outcomes": cases,
    });
    directory.write(Artifact::CalibrationJson, |f| writeln!(f, "{json:#}"))?;
    directory.publish()
}
