//! `flexion plot`: results of one or several runs in one figure.

use crate::{Outcome, screen};
use flexion_results::plot::{Figure, Scale, runs_figure};
use flexion_results::{Results, Trajectory, write_file};
use std::path::PathBuf;

/// The results to plot.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion plot results/p1_spin_up_4 --columns 'tip.*' --output tip.svg
  flexion plot results/first results/exact --columns tip.deflection,hub.torque --title \"Two couplings\" -o couplings.pdf
  flexion plot results/p1_spin_up_4 --columns tip.deflection --xlim 14:20 --ylim -0.01:0.01 -o end.png
  flexion plot results/p1_spin_up_4 --width 85 -o column.pdf")]
pub struct Arguments {
    /// Directories of results, or CSV files whose first column is `time [s]`
    #[arg(value_name = "RESULT", required = true)]
    results: Vec<PathBuf>,
    /// Columns, one panel each, e.g. tip.deflection,hub.speed or 'tip.*' [default: those of the plot of a run]
    #[arg(long, short, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// File to write, .svg, .png or .pdf
    #[arg(long, short, value_name = "FILE", default_value = "plot.svg")]
    output: PathBuf,
    /// Title above the panels
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// Range of the times shown, e.g. 0:2
    #[arg(long, value_name = "FROM:TO", value_parser = range, allow_hyphen_values = true)]
    xlim: Option<(f64, f64)>,
    /// Range of the values shown in every panel, in the unit of its column, e.g. -0.5:0.1
    #[arg(long, value_name = "FROM:TO", value_parser = range, allow_hyphen_values = true)]
    ylim: Option<(f64, f64)>,
    /// Width of the figure in mm, e.g. 85 for a column of a journal; panels stand below each other where it is narrow
    #[arg(long, value_name = "MM", value_parser = width)]
    width: Option<f64>,
    /// Values on logarithmic axes; those that are not positive are left out
    #[arg(long)]
    log: bool,
    /// Replace a file that exists
    #[arg(long)]
    force: bool,
}

/// Widths of a figure [mm].
const NARROWEST: f64 = 50.0;
const WIDEST: f64 = 1000.0;
fn range(text: &str) -> Result<(f64, f64), String> {
    let ends = text.split_once(':').map(|(from, to)| (from.trim().parse::<f64>(), to.trim().parse::<f64>()));
    match ends {
        Some((Ok(from), Ok(to))) if from < to && (to - from).is_finite() => Ok((from, to)),
        _ => Err("write FROM:TO, two ascending numbers, e.g. 0:2.5".to_owned()),
    }
}

fn width(text: &str) -> Result<f64, String> {
    match text.trim().trim_end_matches("mm").trim().parse::<f64>() {
        Ok(width) if (NARROWEST..=WIDEST).contains(&width) => Ok(width),
        _ => Err(format!("it is a number of mm from {NARROWEST} to {WIDEST}, e.g. 85")),
    }
}

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
    let extension = extension.as_deref().unwrap_or_default();
    if !["svg", "png", "pdf"].contains(&extension) {
        let name = arguments.output.display();
        return Err(format!("the plot {name} must end in .svg, .png or .pdf"));
    }
    if arguments.output.exists() && !arguments.force {
        let name = arguments.output.display();
        return Err(format!("{name} exists; choose another name with --output or replace it with --force"));
    }
    let results = Results::read_all(&arguments.results).map_err(|error| error.to_string())?;
    if let Some((from, to)) = arguments.xlim {
        let shown = |r: &Results| {
            r.trajectory.times().iter().any(|&t| t <= to) && r.trajectory.times().iter().any(|&t| t >= from)
        };
        if !results.iter().any(shown) {
            return Err(format!("there are no records from {from} to {to} s"));
        }
    }
    if arguments.log && arguments.ylim.is_some_and(|(from, _)| from <= 0.0) {
        return Err(
            "a logarithmic axis has positive limits: give --ylim without --log, or from a number above 0"
                .to_owned(),
        );
    }
    let runs: Vec<(&str, &Trajectory)> = results.iter().map(|r| (r.name.as_str(), &r.trajectory)).collect();
    let mut figure = runs_figure(&runs, &arguments.columns, arguments.title.as_deref())
        .map_err(|error| error.to_string())?;
    let cautions = left_out(&figure, arguments, results.len());
    for panel in &mut figure.panels {
        panel.x.range = arguments.xlim.or(panel.x.range);
        panel.y.range = arguments.ylim.or(panel.y.range);
        if arguments.log {
            panel.y.scale = Scale::Logarithmic;
        }
    }
    let drawing = arguments.width.map_or_else(|| figure.draw(), |width| figure.draw_in(width));
    let bytes = match extension {
        "png" => drawing.png(),
        "pdf" => drawing.pdf(),
        _ => Ok(drawing.svg().into_bytes()),
    };
    let bytes = bytes.map_err(|error| error.to_string())?;
    write_file(&arguments.output, &bytes).map_err(|error| error.to_string())?;
    for caution in results.iter().filter_map(|results| results.caution.as_ref()).chain(&cautions) {
        screen::report(&format!("warning: {caution}\n"));
    }
    Ok(())
}

/// What was asked for and is not in the figure.
fn left_out(figure: &Figure, arguments: &Arguments, runs: usize) -> Vec<String> {
    let mut cautions = Vec::new();
    for panel in &figure.panels {
        let quantity = &panel.y.quantity;
        if !arguments.columns.is_empty() && panel.series.len() < runs {
            cautions.push(format!("{quantity} was recorded in {} of the {runs} runs", panel.series.len()));
        }
        let positive = panel.series.iter().flat_map(|series| &series.points).any(|point| point.1 > 0.0);
        if arguments.log && !positive {
            cautions
                .push(format!("{quantity} has no positive value, and none is shown on its logarithmic axis"));
        }
    }
    cautions
}
