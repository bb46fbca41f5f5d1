//! `flexion statics`: the path of equilibria as the loads grow.

use crate::run::{ErrorEffort, Progress};
use crate::vibration::report;
use crate::{Outcome, case, screen};
use flexion::analysis::path::Plan;
use flexion_case::{Reading, StaticsError, StaticsRequest};
use flexion_results::{Artifact, Directory, LoadPath, write_statics};
use std::path::{Path, PathBuf};

/// The case, and how far its loads grow.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion statics case.toml --output results/statics
  flexion statics case.toml --to 3 --set 'load=[{on=\"2 m\", force=[\"-400 N\", \"1 N\"]}]'

The loads of t = 0 are multiplied by a factor that grows from zero; the equilibrium is followed by the length of its path, past
limit points at which the load falls again, until the factor is reached. Every equilibrium is judged: stable, or in how many
directions it is left; critical loads in between are located. The hub is at rest and held.

Exit codes: 0 finished, 1 case or command line rejected, 2 the path ends before the load factor, or the files could not be
written; what was found is kept.")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Load factor to which the path is followed
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = positive, allow_hyphen_values = true)]
    to: f64,
    /// Longest step: of displacements over the length of the beam, and of the load factor
    #[arg(long, value_name = "STEP", default_value = "0.05", value_parser = positive)]
    step: f64,
    /// Number of equilibria at most
    #[arg(long, value_name = "N", default_value = "1000", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    points: u32,
    /// Directory for statics.json, .csv, .npz and the picture [default: results/NAME-statics]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Estimate errors by the path on a finer mesh: never, where it takes some seconds at most, or always
    #[arg(long, value_name = "EFFORT", value_enum, default_value = "auto")]
    error: ErrorEffort,
    /// Replace former results in that directory
    #[arg(long)]
    force: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("it is a positive number".to_owned()),
    }
}

/// Follows and writes a path.
pub fn statics(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    followed(arguments, &reading).unwrap_or_else(|error| {
        match error {
            StaticsError::Case(problems) => screen::report(&problems.render(screen::colour())),
            error => report(&error.to_string()),
        }
        Outcome::Rejected
    })
}

fn followed(arguments: &Arguments, reading: &Reading) -> Result<Outcome, StaticsError> {
    let named = format!("{}-statics", arguments.case.name());
    let output = arguments.output.clone().unwrap_or_else(|| Path::new("results").join(named));
    let plan = Plan { points: arguments.points as usize, longest: arguments.step, ..Plan::to(arguments.to) };
    let directory = Directory::create_for(Artifact::STATICS, &output, arguments.force, &reading.inputs())
        .map_err(|error| StaticsError::NotFound(error.to_string()))?;
    let mut progress = Progress::new(arguments.to);
    let request = StaticsRequest { plan, effort: arguments.error.effort() };
    let path =
        reading.statics(&request, &mut |points, factor| progress.show_points(points, factor).is_continue());
    progress.finish();
    let path = path.inspect_err(|_| directory.discard())?;
    screen::print(&described(&path));
    let written = write_statics(&directory, &path, &reading.resolved(), reading.title(), &path.cautions);
    let files = [("path", Artifact::StaticsCsv), ("figure", Artifact::StaticsSvg)];
    let whole = screen::files(&directory, written, &files);
    path.cautions.iter().for_each(|caution| screen::report(&format!("warning: {caution}\n")));
    if let Some(end) = &path.end {
        screen::report(&format!("error: {end}\nWhat lies before it is kept.\n"));
    }
    Ok(if whole && path.end.is_none() { Outcome::Finished } else { Outcome::Incomplete })
}

/// Critical states and the last equilibrium.
fn described(path: &LoadPath) -> String {
    let mut out = format!("{} equilibria\n\n", path.points.len());
    let printed: Vec<_> = path.printed().collect();
    let mut rows = vec![vec!["load factor".to_owned(), "is".to_owned(), "beyond".to_owned()]];
    rows[0].extend(printed.iter().map(|(_, channel)| format!("{} [{}]", channel.name, channel.unit)));
    let last = path.points.last().map(|point| (point, "last"));
    for (point, what) in path.critical().map(|(point, critical)| (point, critical.name())).chain(last) {
        let stability = point.stability.map_or_else(|| "unknown".to_owned(), |found| found.to_string());
        let error = point.error.as_ref();
        let stated = |value: f64, error: Option<f64>| match error {
            Some(error) => flexion_results::with_error(value, error),
            None => format!("{value:.6}"),
        };
        // The load factor of the last point is the one that was asked for.
        let of_factor = error.filter(|_| point.critical.is_some()).map(|error| error.factor);
        let mut row = vec![stated(point.factor, of_factor), what.to_owned(), stability];
        row.extend(
            printed.iter().map(|(i, _)| stated(point.values[*i], error.map(|error| error.values[*i]))),
        );
        rows.push(row);
    }
    out.push_str(&screen::table(&rows));
    let stated = path.points.iter().any(|point| point.error.is_some());
    match &path.unknown {
        Some(why) => out.push_str(&format!("\n  errors are not known: {why}\n")),
        None if stated => out.push_str("\n  ± is the error of the mesh, estimated by a finer one\n"),
        None => {}
    }
    out.push('\n');
    out
}
