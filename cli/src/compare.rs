//! `flexion compare`: how far runs are apart.

use crate::{Outcome, screen};
use flexion_results::plot::difference_figure;
use flexion_results::{
    Artifact, Comparison, Directory, OutputError, Results, ResultsError, compare_csv, compare_json,
};
use std::path::PathBuf;

/// The runs to compare.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion compare results/fine results/coarse
  flexion compare results/fine results/coarse --columns 'tip.*' --tolerance 1e-3 --output results/differences

The runs are compared at the times of the first, REFERENCE. A run recorded at other times is interpolated there by
cubics: name the run recorded most finely last, or record at the same times.

Exit codes: 0 compared, 1 command line rejected, 2 a difference exceeds the tolerance or a value is not finite, or the files could not be
written.")]
pub struct Arguments {
    /// Directory of the results, or CSV file, that the others are compared with
    #[arg(value_name = "REFERENCE")]
    reference: PathBuf,
    /// Directories of results, or CSV files
    #[arg(value_name = "RUN", required = true)]
    runs: Vec<PathBuf>,
    /// Columns, e.g. tip.deflection,tip.axial or 'tip.*' [default: all in common but step.*]
    #[arg(long, short, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// Largest difference allowed, relative to the peak of REFERENCE (of the total energy for the energy balance); beyond it
    /// the exit code is 2
    #[arg(long, value_name = "X", value_parser = tolerance)]
    tolerance: Option<f64>,
    /// Directory for compare.json, compare.csv and the plots of runs and differences
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace a former comparison in that directory
    #[arg(long, requires = "output")]
    force: bool,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 => Ok(value),
        _ => Err("it is a number, zero or positive, e.g. 1e-3".to_owned()),
    }
}

/// Compares runs.
pub fn compare(arguments: &Arguments) -> Outcome {
    let (results, comparisons) = match compared(arguments) {
        Ok(compared) => compared,
        Err(error) => {
            screen::report(&format!("error: {error}\n"));
            return Outcome::Rejected;
        }
    };
    let mut out = String::new();
    for comparison in &comparisons {
        out.push_str(&described(comparison));
        out.push('\n');
    }
    screen::print(&out);
    for caution in results.iter().filter_map(|results| results.caution.as_ref()) {
        screen::report(&format!("warning: {caution}\n"));
    }
    if let Some(path) = &arguments.output {
        let inputs: Vec<PathBuf> = results.iter().map(|results| results.path.clone()).collect();
        let directory = match Directory::create_for(Artifact::COMPARISON, path, arguments.force, &inputs) {
            Ok(directory) => directory,
            Err(error) => {
                screen::report(&format!("error: {error}\n"));
                return Outcome::Rejected;
            }
        };
        let written = fill(&directory, arguments, &results, &comparisons);
        let files = [("figures", Artifact::CompareJson), ("plot", Artifact::CompareSvg)];
        if !screen::files(&directory, written, &files) {
            return Outcome::Incomplete;
        }
    }
    let mut beyond = false;
    for comparison in &comparisons {
        let what = match arguments.tolerance {
            Some(tolerance) => comparison.beyond(tolerance),
            None => comparison.not_finite(),
        };
        for what in what {
            screen::report(&format!("error: {}: {what}\n", comparison.second));
            beyond = true;
        }
    }
    if beyond { Outcome::Incomplete } else { Outcome::Finished }
}

fn compared(arguments: &Arguments) -> Result<(Vec<Results>, Vec<Comparison>), ResultsError> {
    let paths: Vec<PathBuf> = std::iter::once(&arguments.reference).chain(&arguments.runs).cloned().collect();
    let results = Results::read_all(&paths)?;
    let mut comparisons = Vec::new();
    if let Some((reference, runs)) = results.split_first() {
        for run in runs {
            comparisons.push(Comparison::of(reference, run, &arguments.columns)?);
        }
    }
    Ok((results, comparisons))
}

/// The table of one comparison.
fn described(c: &Comparison) -> String {
    let times = c.trajectory.len();
    let how = if c.interpolated { "interpolated by cubics" } else { "the same in both" };
    let mut out = format!(
        "{} against {}: {times} times from {} to {} s, {how}\n\n",
        c.second, c.first, c.span.0, c.span.1
    );
    let head = ["", "unit", "max |Δ|", "at t [s]", "RMS", "peak", "relative"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for d in &c.differences {
        let unit = if d.unit.is_empty() { "1" } else { &d.unit };
        let mut row = vec![d.column.clone(), unit.to_owned()];
        row.extend([format!("{:.4e}", d.max), format!("{:.4}", d.at)]);
        row.extend([d.rms, d.peak, d.relative].map(|y| format!("{y:.4e}")));
        rows.push(row);
    }
    out.push_str(&screen::table(&rows));
    for (name, columns) in [(&c.first, &c.only_first), (&c.second, &c.only_second)] {
        if !columns.is_empty() {
            out.push_str(&format!("\nonly in {name}: {}\n", columns.join(", ")));
        }
    }
    if !c.covers {
        out.push_str(&format!("\n{} does not have all times of {}\n", c.second, c.first));
    }
    out
}

/// Writes the files.
fn fill(
    directory: &Directory,
    arguments: &Arguments,
    results: &[Results],
    comparisons: &[Comparison],
) -> Result<(), OutputError> {
    let compared = comparisons.first().map_or(&[][..], |c| c.trajectory.channels());
    let are_chosen = !arguments.columns.is_empty();
    let drawn = comparisons.first().map_or_else(Vec::new, |c| c.drawn(are_chosen));
    let mut warning = String::new();
    if are_chosen && drawn.len() < compared.len() {
        warning =
            format!("warning: the figure shows the first {} of {} columns\n", drawn.len(), compared.len());
    }
    let drawing = difference_figure(results, comparisons, &drawn, None).draw();
    directory.write(Artifact::CompareCsv, |f| compare_csv(comparisons, f))?;
    directory.write(Artifact::CompareSvg, |f| f.write_all(drawing.svg().as_bytes()))?;
    match drawing.png() {
        Ok(png) => directory.write(Artifact::ComparePng, |f| f.write_all(&png))?,
        Err(error) => warning.push_str(&format!("warning: {error}\n")),
    }
    let json = compare_json(comparisons, arguments.tolerance);
    directory.write(Artifact::CompareJson, |f| f.write_all(json.as_bytes()))?;
    directory.publish()?;
    screen::report(&warning);
    Ok(())
}
