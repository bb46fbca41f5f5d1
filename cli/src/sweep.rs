//! `flexion sweep`: runs a case with many values of some of its keys.

use crate::run::stop_on_ctrl_c;
use crate::{Outcome, case, screen};
use flexion_case::sweep::{
    Errors, How, Inputs, Method, Options, Outcome as Swept, Sample, Shard, Stop, Sweep, SweepError, Table,
};
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// The case, its inputs, and what is collected.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion sweep verification/p1_spin_up_4 --vary 'section.modulus=60 GPa:80 GPa:21' --collect tip.deflection.min
  flexion sweep case.toml --vary 'hub.motion.speed=3 rad/s:5 rad/s:11' --vary model.coupling=zeroth,first --collect tip.deflection
  flexion sweep case.toml --table inputs.csv --collect tip.deflection.final --output results/table
  flexion sweep case.toml --vary 'section.modulus=normal(70 GPa, 1 GPa)' --vary 'beam.length=9.9 m:10.1 m' --sample sobol --runs 256 \\
    --seed 1 --collect tip.deflection.min
  flexion sweep case.toml --table inputs.csv --collect tip.deflection.min --output results/table --shard 3/16

Values of --vary are a range FIRST:LAST:COUNT, a list A,B,C, or, with --sample, a range FIRST:LAST or a distribution:
uniform(smallest, largest), normal(mean, standard deviation), lognormal(mean, standard deviation), triangular(smallest, mode, largest),
weibull(scale, shape). Several --vary without --sample are run in all combinations, the last changing fastest.

Each part of the rows is kept as a Parquet file when it is whole. The same command goes on with what is missing, however it was ended.

Exit codes: 0 all rows are done; 1 the case, an input or the folder is rejected; 2 stopped, or more than a tenth of the rows failed.")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// An input and its values, e.g. 'section.modulus=60 GPa:80 GPa:21'; may be repeated
    #[arg(long, value_name = "KEY=VALUES")]
    vary: Vec<String>,
    /// A CSV file with a key in each column and a run in each row
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Sample ranges, lists and distributions: lhs, a Latin hypercube, or sobol, points of Sobol
    #[arg(long, value_name = "METHOD", value_parser = method, requires = "runs")]
    sample: Option<Method>,
    /// Number of sampled runs
    #[arg(long, value_name = "N", requires = "sample")]
    runs: Option<usize>,
    /// Seed of the sample [default: 0]
    #[arg(long, value_name = "S", requires = "sample")]
    seed: Option<u64>,
    /// A quantity to collect, e.g. tip.deflection.min, .max, .final, .mean or .amplitude; a column alone stands for the first three; may be repeated
    #[arg(long, value_name = "COLUMN", required = true)]
    collect: Vec<String>,
    /// Estimate errors of each row, of a sample of 20 rows spread over the inputs, or of none
    #[arg(long, value_name = "ROWS", value_enum, default_value = "sample")]
    errors: ErrorRows,
    /// Give a run up after so many steps [default: 10 million, or twice those of a case with fixed steps]
    #[arg(long, value_name = "STEPS")]
    limit: Option<u64>,
    /// Go on where more than a tenth of the rows fail
    #[arg(long)]
    keep_going: bool,
    /// Compute the I-th of N shares of the parts only, for job arrays with one folder
    #[arg(long, value_name = "I/N", value_parser = shard)]
    shard: Option<Shard>,
    /// Number of threads [default: one for each processor]; the results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    threads: usize,
    /// Rows of a part [default: a 200th of all]
    #[arg(long, value_name = "ROWS")]
    part: Option<usize>,
    /// Folder of the parts [default: results/NAME-sweep]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Of which rows errors are estimated.
#[derive(Clone, Copy, clap::ValueEnum)]
enum ErrorRows {
    Each,
    Sample,
    None,
}

impl From<ErrorRows> for Errors {
    fn from(rows: ErrorRows) -> Errors {
        match rows {
            ErrorRows::Each => Errors::Each,
            ErrorRows::Sample => Errors::Sample,
            ErrorRows::None => Errors::None,
        }
    }
}

fn method(text: &str) -> Result<Method, String> {
    Method::of(text).ok_or_else(|| "the methods are lhs and sobol".to_owned())
}

fn shard(text: &str) -> Result<Shard, String> {
    let parts =
        text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
    match parts {
        Some((number, of)) if 1 <= number && number <= of => Ok(Shard { number, of }),
        _ => Err("a shard is I/N, e.g. 3/16, with I from 1 to N".to_owned()),
    }
}

/// Runs a sweep.
pub fn sweep(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    let Some(inputs) = inputs(arguments) else { return Outcome::Rejected };
    let options = Options { errors: arguments.errors.into(), limit: arguments.limit, part: arguments.part };
    let sweep = match Sweep::new(reading, inputs, &arguments.collect, options) {
        Ok(sweep) => sweep,
        Err(error) => return rejected(&error),
    };
    let named = format!("{}-sweep", arguments.case.name());
    let folder = arguments.output.clone().unwrap_or_else(|| Path::new("results").join(named));
    let how = How {
        threads: arguments.threads,
        shard: arguments.shard.unwrap_or(How::default().shard),
        keep_going: arguments.keep_going,
    };
    let bar = ProgressBar::new(sweep.rows() as u64);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} rows  {msg}  {eta} left") {
        bar.set_style(style);
    }
    let stop = stop_on_ctrl_c();
    let watch =
        || if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let swept = sweep.run_all(&folder, &how, &watch, &|progress| {
        bar.set_length(progress.rows.1 as u64);
        bar.set_position(progress.rows.0 as u64);
        if progress.failures > 0 {
            bar.set_message(format!("{} failed", progress.failures));
        }
    });
    bar.finish_and_clear();
    match swept {
        Ok(swept) => finish(&sweep, &swept, &folder),
        Err(error @ SweepError::Io { .. }) => {
            screen::report(&format!(
                "error: {error}\nThe parts that are whole are kept in {}.\n",
                folder.display()
            ));
            Outcome::Incomplete
        }
        Err(error) => rejected(&error),
    }
}

fn rejected(error: &SweepError) -> Outcome {
    match error {
        SweepError::Case(problems) => screen::report(&problems.render(screen::colour())),
        other => screen::report(&format!("error: {other}\n")),
    }
    Outcome::Rejected
}

/// What is varied; what is wrong with a table goes to standard error.
fn inputs(arguments: &Arguments) -> Option<Inputs> {
    let sample = arguments.sample.zip(arguments.runs);
    let sample =
        sample.map(|(method, runs)| Sample { method, runs, seed: arguments.seed.unwrap_or_default() });
    let mut inputs = Inputs { vary: arguments.vary.clone(), table: None, sample };
    if let Some(path) = &arguments.table {
        let name = path.display().to_string();
        let text = match std::fs::read_to_string(path) {
            Ok(text) => text,
            Err(error) => {
                screen::report(&format!("error: cannot read {name}: {error}\n"));
                return None;
            }
        };
        match Table::parse(&name, &text) {
            Ok(table) => inputs.table = Some(table),
            Err(problems) => {
                screen::report(&problems.render(screen::colour()));
                return None;
            }
        }
    }
    Some(inputs)
}

/// Says what became of a sweep and where its files are.
fn finish(sweep: &Sweep, swept: &Swept, folder: &Path) -> Outcome {
    let totals = &swept.totals;
    let mut out = format!("{} of {} rows are done", totals.rows, swept.rows);
    if swept.rows < sweep.rows() {
        out.push_str(&format!(", of a shard of {}", sweep.rows()));
    }
    if swept.found > 0 {
        out.push_str(&format!("; {} were there before", swept.found));
    }
    if let Some(seed) = sweep.seed() {
        out.push_str(&format!("; seed {seed}"));
    }
    out.push('\n');
    if totals.failures() > 0 {
        let kinds = [(totals.failed, "failed"), (totals.given_up, "given up"), (totals.rejected, "rejected")];
        let kinds: Vec<String> =
            kinds.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
        out.push_str(&format!("  did not finish: {}\n", kinds.join(", ")));
    }
    if let Some((row, reason)) = &totals.first_failure {
        out.push_str(&format!("  row {row}: {reason}\n"));
    }
    out.push('\n');
    out.push_str(&quantities(sweep, swept));
    out.push_str(&errors(swept));
    screen::print(&out);
    let parts = folder.join("*.parquet");
    screen::print(&format!("rows     {}\n", parts.display()));
    if let Some(csv) = &swept.csv {
        screen::print(&format!("as text  {}\n", csv.display()));
    }
    screen::print(&format!("read     polars.read_parquet(\"{}\").sort(\"row\")\n", parts.display()));
    match swept.stop {
        None => Outcome::Finished,
        Some(Stop::Asked) => {
            screen::report(
                "error: stopped by the user: the same command goes on with the rows that are missing\n",
            );
            Outcome::Incomplete
        }
        Some(Stop::Failures { failures, rows }) => {
            screen::report(&format!(
                "error: {failures} of the first {rows} rows did not finish, which is more than a tenth: look at their `reason`, or add \
                 `--keep-going`\n"
            ));
            Outcome::Incomplete
        }
    }
}

/// The range of each quantity over the rows, with its largest error.
fn quantities(sweep: &Sweep, swept: &Swept) -> String {
    let head = ["", "unit", "smallest", "largest", "worst ±", "of its value"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for (quantity, of) in sweep.quantities().iter().zip(&swept.totals.quantities) {
        if of.min > of.max {
            continue;
        }
        let unit = if quantity.unit.is_empty() { "1" } else { &quantity.unit };
        let error = |x: Option<f64>| x.map_or("-".to_owned(), |x| format!("{x:.1e}"));
        rows.push(vec![
            quantity.name().to_owned(),
            unit.to_owned(),
            format!("{:.6e}", of.min),
            format!("{:.6e}", of.max),
            error(of.error),
            error(of.relative),
        ]);
    }
    if rows.len() > 1 { screen::table(&rows) + "\n" } else { String::new() }
}

/// Of how many rows errors are known.
fn errors(swept: &Swept) -> String {
    let totals = &swept.totals;
    if totals.estimated == 0 {
        return "  errors are estimated of no row\n\n".to_owned();
    }
    let share = 100.0 * totals.estimated as f64 / totals.rows.max(1) as f64;
    let mut out = format!(
        "  ± is the error of mesh and steps, estimated of {} of {} rows ({share:.1} %)",
        totals.estimated, totals.rows
    );
    if let Some(worst) = totals.worst() {
        out.push_str(&format!(", at worst {worst:.1e} of the value"));
    }
    out.push('\n');
    if totals.distrusted > 0 {
        out.push_str(&format!(
            "  {} rows have a value beyond the time until which their run is trusted: see the columns `.trusted`\n",
            totals.distrusted
        ));
    }
    out + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexion_case::sweep::LIMIT;

    #[test]
    fn a_limit_is_the_one_that_the_help_states() {
        assert_eq!(LIMIT, 10_000_000);
    }

    #[test]
    fn a_shard_is_one_of_so_many() {
        assert_eq!(shard("3/16"), Ok(Shard { number: 3, of: 16 }));
        for wrong in ["0/4", "5/4", "3", "a/b"] {
            assert!(shard(wrong).is_err());
        }
    }
}
