//! `flexion plot`: results of one or several runs in one figure.

use crate::{Outcome, screen};
use flexion::system::Role;
use flexion_results::plot::{Figure, compare_figure, trajectory_figure};
use flexion_results::{Results, ResultsError, Trajectory, select, write_file};
use std::path::PathBuf;

/// The results to plot.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion plot results/p1_spin_up_4 --columns 'tip.*' --output tip.svg
  flexion plot results/first results/exact --columns tip.deflection,hub.torque --title \"Two couplings\" -o couplings.png")]
pub struct Arguments {
    /// Directories of results, or CSV files whose first column is `time [s]`
    #[arg(value_name = "RESULT", required = true)]
    results: Vec<PathBuf>,
    /// Columns, one panel each, e.g. tip.deflection,hub.speed or 'tip.*' [default: those of the plot of a run]
    #[arg(long, short, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// File to write, .svg or .png
    #[arg(long, short, value_name = "FILE", default_value = "plot.svg")]
    output: PathBuf,
    /// Title above the panels
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Replace a file that exists
    #[arg(long)]
    force: bool,
}

/// Most columns of several runs when none are asked for.
const USUAL: usize = 4;
/// Most panels of a figure.
const MOST: usize = 24;

/// Plots results.
pub fn plot(arguments: &Arguments) -> Outcome {
    match plotted(arguments) {
        Ok(()) => {
            screen::print(&screen::table(&[vec!["plot".to_owned(), arguments.output.display().to_string()]]));
            Outcome::Finished
        }
        Err(message) => {
            screen::report(&format!("error: {message}\n"));
            Outcome::Rejected
        }
    }
}

fn plotted(arguments: &Arguments) -> Result<(), String> {
    let extension = arguments.output.extension().map(|text| text.to_string_lossy().to_lowercase());
    let png = match extension.as_deref() {
        Some("svg") => false,
        Some("png") => true,
        _ => {
            let name = arguments.output.display();
            return Err(format!("the plot {name} must end in .svg or .png"));
        }
    };
    if arguments.output.exists() && !arguments.force {
        let name = arguments.output.display();
        return Err(format!("{name} exists; choose another name with --output or replace it with --force"));
    }
    let results = Results::read_all(&arguments.results).map_err(|error| error.to_string())?;
    let drawing = figure(&results, arguments)?.draw();
    let bytes =
        if png { drawing.png().map_err(|error| error.to_string())? } else { drawing.svg().into_bytes() };
    write_file(&arguments.output, &bytes).map_err(|error| error.to_string())?;
    for caution in results.iter().filter_map(|results| results.caution.as_ref()) {
        screen::report(&format!("warning: {caution}\n"));
    }
    Ok(())
}

fn figure(results: &[Results], arguments: &Arguments) -> Result<Figure, String> {
    let title = arguments.title.as_deref();
    if let ([one], true) = (results, arguments.columns.is_empty()) {
        return Ok(trajectory_figure(&one.trajectory, title));
    }
    // The columns of all runs, each once, those of the first run first.
    let mut names: Vec<&str> = Vec::new();
    let mut usual: Vec<&str> = Vec::new();
    for channel in results.iter().flat_map(|r| r.trajectory.channels()) {
        if !names.contains(&channel.name.as_str()) {
            names.push(&channel.name);
            usual.extend((channel.role == Role::Primary).then_some(channel.name.as_str()));
        }
    }
    let of = if results.len() == 1 { "these results" } else { "any of these results" };
    let columns = if arguments.columns.is_empty() {
        let columns = if usual.is_empty() { names } else { usual };
        columns.into_iter().take(USUAL).collect()
    } else {
        select(&names, &arguments.columns, of).map_err(|error: ResultsError| error.to_string())?
    };
    if columns.len() > MOST {
        let count = columns.len();
        return Err(format!(
            "{count} columns are too many for one figure; choose at most {MOST} with --columns"
        ));
    }
    if let [one] = results {
        return Ok(Figure { title: title.map(String::from), ..single(&one.trajectory, &columns) });
    }
    let runs: Vec<(&str, &Trajectory)> = results.iter().map(|r| (r.name.as_str(), &r.trajectory)).collect();
    Ok(compare_figure(&runs, &columns, title))
}

/// The columns of one run, without a legend.
fn single(trajectory: &Trajectory, columns: &[&str]) -> Figure {
    let mut figure = compare_figure(&[("", trajectory)], columns, None);
    for series in figure.panels.iter_mut().flat_map(|panel| &mut panel.series) {
        series.name = None;
    }
    figure
}
