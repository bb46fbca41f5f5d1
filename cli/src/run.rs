//! `flexion run`: integrates a case and writes its results.

use crate::{Outcome, case, screen};
use flexion::system::{Channel, Role};
use flexion_case::{Errors, Reading, Run, units};
use flexion_results::{Artifact, Directory, Events, Status, Trajectory};
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The case to run and where its results go.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion run verification/p1_spin_up_4
  flexion run case.toml --vtk --output results/film
  flexion run case.toml --set section.modulus=\"30 GPa\" --output results/soft --force

Exit codes: 0 finished, or stopped where --until asks for it; 1 case rejected; 2 stopped or failed (what was computed is
kept).")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Directory of the results [default: that of the case in results/]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Write the shape of the beam for ParaView too, as `--set output.vtk=true`
    #[arg(long)]
    vtk: bool,
    /// Draw nothing, as `--set output.plots=false`: most of the time of a short run is that of its pictures
    #[arg(long)]
    no_plots: bool,
    /// Stop after the step that reaches this time, e.g. "2 s"; `initial.kind = "restart"` goes on from there
    #[arg(long, value_name = "TIME", value_parser = time)]
    until: Option<f64>,
    /// Estimate the error of every column, by runs with finer meshes and steps
    #[arg(long)]
    error: bool,
    /// Replace the results of a former run
    #[arg(long)]
    force: bool,
}

/// Positions of the progress bar.
const TICKS: f64 = 1000.0;

/// Runs a case.
pub fn run(arguments: &Arguments) -> Outcome {
    let flags = [(arguments.vtk, "output.vtk=true"), (arguments.no_plots, "output.plots=false")];
    let set: Vec<&str> = flags.into_iter().filter_map(|(given, set)| given.then_some(set)).collect();
    let Some(reading) = arguments.case.read_with(&set) else { return Outcome::Rejected };
    let output = arguments.output.clone().unwrap_or_else(|| Path::new("results").join(arguments.case.name()));
    // The case is checked, and the directory tried, before anything is computed.
    let prepared = match reading.prepare() {
        Ok(prepared) => prepared,
        Err(problems) => {
            screen::report(&problems.render(screen::colour()));
            return Outcome::Rejected;
        }
    };
    let directory = match Directory::create(&output, arguments.force) {
        Ok(directory) => directory,
        Err(error) => {
            screen::report(&format!("error: {error}\n"));
            return Outcome::Rejected;
        }
    };
    let mut progress = Progress::new(reading.case.duration);
    let until = arguments.until.unwrap_or(f64::INFINITY);
    let mut reached = false;
    let mut run = prepared.run(&mut |state| {
        reached = state.t >= until;
        if reached { ControlFlow::Break(()) } else { progress.show(state.t) }
    });
    if reached && run.status == Status::Stopped {
        run.message = Some(format!("stopped at t = {:.6} s, as asked", run.state.t));
    }
    if arguments.error {
        match reading.estimate_errors(&run, &mut |state| progress.show(state.t)) {
            Ok(errors) => run.errors = Some(errors),
            Err(problems) => {
                progress.finish();
                screen::report(&problems.render(screen::colour()));
                directory.discard();
                return Outcome::Rejected;
            }
        }
    }
    progress.finish();
    match reading.write(&run, &directory) {
        Ok(status) => finish(status, reached, &reading, &run, &directory),
        Err(error) => {
            screen::report(&format!("error: {error}\n"));
            if let Some(path) = directory.salvage() {
                screen::report(&format!("What was written until then is kept in {}.\n", path.display()));
            }
            Outcome::Incomplete
        }
    }
}

/// Says how the run went and where its files are.
fn finish(status: Status, reached: bool, reading: &Reading, run: &Run, directory: &Directory) -> Outcome {
    let trajectory = &run.trajectory;
    let wall_time = run.wall_time;
    let end = format!("{:.6}", trajectory.times().last().copied().unwrap_or(0.0));
    let mut out = format!("{} at t = {end} s in {wall_time:.3} s of wall time\n\n", status.word());
    out.push_str(&extremes(trajectory));
    out.push('\n');
    if !run.events.is_empty() {
        out.push_str(&impacts(&run.events));
    }
    if let Some(errors) = &run.errors {
        out.push_str(&error_table(errors, trajectory));
        out.push('\n');
    }
    screen::print(&out);
    let mut files = vec![("summary", Artifact::Summary)];
    files.extend(reading.case.output.plots.then_some(("plot", Artifact::PlotSvg)));
    files.extend((!run.events.is_empty()).then_some(("events", Artifact::Events)));
    files.extend(run.shapes.is_some().then_some(("shapes", Artifact::ShapeSeries)));
    screen::files(directory, Ok(()), &files);
    let estimates = run.errors.iter().flat_map(|errors| &errors.warnings);
    for warning in run.warnings.iter().chain(estimates) {
        screen::report(&format!("warning: {warning}\n"));
    }
    if status == Status::Finished || (reached && status == Status::Stopped) {
        return Outcome::Finished;
    }
    let reason = match (&run.message, trajectory.first_not_finite()) {
        (Some(message), _) => message.clone(),
        (None, Some((channel, t))) => format!("{} is not finite at t = {t} s", channel.name),
        (None, None) => status.word().to_owned(),
    };
    screen::report(&format!("error: {reason}\nWhat was computed until t = {end} s is kept.\n"));
    Outcome::Incomplete
}

/// Number of impacts, the first of them, and the energy lost.
fn impacts(events: &Events) -> String {
    let count = events.impacts().count();
    let Some(first) = events.impacts().next() else { return "  no impacts\n\n".to_owned() };
    let (time, name, lost) = (first.time, events.name(first.contact), events.lost());
    format!(
        "  impacts: {count}, the first at t = {time:.6} s ({name}); energy lost in them: {lost:.6e} J\n\n"
    )
}

/// Whether a column is printed after a run.
fn is_printed(channel: &Channel) -> bool {
    matches!(channel.role, Role::Primary | Role::Secondary)
}

/// Smallest, largest and last value of the columns that most readers look for.
fn extremes(trajectory: &Trajectory) -> String {
    let head = ["", "unit", "min", "at t [s]", "max", "at t [s]", "last"];
    let mut rows = vec![head.iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>()];
    for (index, channel) in trajectory.channels().iter().enumerate() {
        if !is_printed(channel) {
            continue;
        }
        let e = trajectory.extremes(index);
        let unit = if channel.unit.is_empty() { "1" } else { channel.unit };
        let mut row = vec![channel.name.clone(), unit.to_owned()];
        let value = |x: f64| format!("{x:.6e}");
        row.extend([
            value(e.min),
            format!("{:.4}", e.t_min),
            value(e.max),
            format!("{:.4}", e.t_max),
            value(e.last),
        ]);
        rows.push(row);
    }
    screen::table(&rows)
}

/// Estimated errors of the same columns.
fn error_table(errors: &Errors, trajectory: &Trajectory) -> String {
    let head = ["", "unit", "error of mesh and steps", "difference to the exact coupling"];
    let mut rows = vec![head.iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>()];
    for error in &errors.columns {
        let channel = trajectory.channels().iter().find(|channel| channel.name == error.column);
        let Some(channel) = channel.filter(|channel| is_printed(channel)) else { continue };
        let model = error.model.map_or("-".to_owned(), |model| format!("{model:.1e}"));
        let unit = if channel.unit.is_empty() { "1" } else { channel.unit };
        rows.push(vec![
            error.column.clone(),
            unit.to_owned(),
            format!("{:.1e}", error.discretization),
            model,
        ]);
    }
    screen::table(&rows)
}

/// A time with its unit, or in seconds.
fn time(text: &str) -> Result<f64, String> {
    text.parse().or_else(|_| units::parse(text, &units::TIME).map_err(|error| error.message))
}

/// Shows how far a run is, and stops it on Ctrl-C.
struct Progress {
    bar: ProgressBar,
    shown: Instant,
    end: f64,
    stop: Arc<AtomicBool>,
}

impl Progress {
    fn new(end: f64) -> Progress {
        // The bar draws on standard error, and only if that is a terminal.
        let bar = ProgressBar::new(TICKS as u64);
        let template = "{wide_bar} {percent:>3} %  {msg}  {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        let stop = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&stop);
        // Without a handler Ctrl-C ends the program at once, and the results are not written.
        let _ = ctrlc::set_handler(move || {
            if asked.swap(true, Ordering::Relaxed) {
                std::process::exit(2);
            }
        });
        Progress { bar, shown: Instant::now(), end, stop }
    }

    fn show(&mut self, t: f64) -> ControlFlow<()> {
        if self.shown.elapsed() > Duration::from_millis(100) {
            self.shown = Instant::now();
            self.bar.set_position((t / self.end * TICKS) as u64);
            self.bar.set_message(format!("t = {t:.3} s"));
        }
        if self.stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
