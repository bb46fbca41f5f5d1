//! `flexion run`: integrates a case and writes its results.

use crate::{Outcome, case, screen};
use flexion::system::{Channel, Role};
use flexion_case::{
    Calculation, Collected, Effort, Quantity, Reading, RefineError, Request, Run, Stage, Target, units,
};
use flexion_results::{Artifact, ColumnError, Directory, Errors, Events, Rung, Status, Trajectory};
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
  flexion run case.toml --tolerance 1e-4 --quantity tip.deflection.min
  flexion run case.toml --print tip.deflection.min | cut -f2
  flexion run case.toml --set section.modulus=\"30 GPa\" --output results/soft --force

Exit codes: 0 finished, or stopped where --until asks for it; 1 case rejected; 2 stopped or failed, the estimate of errors
too (what was computed is kept).")]
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
    /// Estimate the error of every column by runs with finer meshes and steps: never, where they cost a few times the run,
    /// or always
    #[arg(long, value_name = "EFFORT", value_enum, default_value = "auto")]
    error: ErrorEffort,
    /// Refine mesh and steps until the estimated error is below this: a part of the largest value, "1e-4", or with a unit,
    /// "0.1 mm"
    #[arg(long, value_name = "ERROR")]
    tolerance: Option<String>,
    /// What the tolerance is for: a column, or its min, max or final value, e.g. tip.deflection.min [default: all
    /// principal columns]
    #[arg(long, value_name = "COLUMN", requires = "tolerance")]
    quantity: Option<String>,
    /// Print nothing but these values, a line each, for scripts: name, value, unit, ± and time, with tabs between them; a column
    /// alone stands for its min, max and final value
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    print: Vec<String>,
    /// Replace the results of a former run
    #[arg(long)]
    force: bool,
}

/// How much the estimate of errors may cost.
#[derive(Clone, Copy, clap::ValueEnum)]
pub(crate) enum ErrorEffort {
    Off,
    Auto,
    Full,
}

impl ErrorEffort {
    pub(crate) fn effort(self) -> Option<Effort> {
        match self {
            ErrorEffort::Off => None,
            ErrorEffort::Auto => Some(Effort::Auto),
            ErrorEffort::Full => Some(Effort::Full),
        }
    }
}

/// Positions of the progress bar, and the part of a run from which its end can be told.
const TICKS: f64 = 1000.0;
const CERTAIN: f64 = 0.05;

/// Runs a case.
pub fn run(arguments: &Arguments) -> Outcome {
    let flags = [(arguments.vtk, "output.vtk=true"), (arguments.no_plots, "output.plots=false")];
    let set: Vec<&str> = flags.into_iter().filter_map(|(given, set)| given.then_some(set)).collect();
    let Some(reading) = arguments.case.read_with(&set) else { return Outcome::Rejected };
    let output = arguments.output.clone().unwrap_or_else(|| Path::new("results").join(arguments.case.name()));
    let mut progress = Progress::new(reading.case.duration);
    // The case is checked, and the directory tried, before anything is computed.
    let mut prepared = match reading.prepare_watched(&mut |factor| progress.show_search(factor)) {
        Ok(prepared) => prepared,
        Err(problems) => {
            progress.finish();
            screen::report(&problems.render(screen::colour()));
            return Outcome::Rejected;
        }
    };
    let printed = match prepared.quantities(&arguments.print) {
        Ok(quantities) => quantities,
        Err(error) => {
            progress.finish();
            screen::report(&format!("error: {error}\n"));
            return Outcome::Rejected;
        }
    };
    let directory = match Directory::create_for(Artifact::RUN, &output, arguments.force, &reading.inputs()) {
        Ok(directory) => directory,
        Err(error) => {
            progress.finish();
            screen::report(&format!("error: {error}\n"));
            return Outcome::Rejected;
        }
    };
    let request = Request {
        until: arguments.until.unwrap_or(f64::INFINITY),
        effort: arguments.error.effort(),
        target: arguments.tolerance.clone().map(|of| Target::new(of, arguments.quantity.clone())),
    };
    let lines = progress.lines();
    let calculated = reading.calculate(prepared, &request, &mut |stage| match stage {
        Stage::Search(factor) => progress.show_search(factor),
        Stage::Time(t) => progress.show(t),
        Stage::Refined(rung) => {
            lines.say(&refined(rung));
            ControlFlow::Continue(())
        }
    });
    progress.finish();
    match calculated {
        Ok(calculation) => write(&calculation, &directory, &printed),
        Err(error) => {
            match error {
                RefineError::Case(problems) => screen::report(&problems.render(screen::colour())),
                other => screen::report(&format!("error: {other}\n")),
            }
            directory.discard();
            Outcome::Rejected
        }
    }
}

/// Writes the results and says how the run went.
fn write(
    Calculation { reading, run, reached, refused }: &Calculation<'_>,
    directory: &Directory,
    printed: &[Quantity],
) -> Outcome {
    match reading.write(run, directory) {
        Ok(status) => {
            let outcome = finish(status, *reached, reading, run, directory, printed);
            match refused {
                Some(why) => {
                    screen::report(&format!("error: {why}\n"));
                    Outcome::Incomplete
                }
                None => outcome,
            }
        }
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
fn finish(
    status: Status,
    reached: bool,
    reading: &Reading,
    run: &Run,
    directory: &Directory,
    printed: &[Quantity],
) -> Outcome {
    let trajectory = &run.trajectory;
    let end = format!("{:.6}", trajectory.times().last().copied().unwrap_or(0.0));
    if printed.is_empty() {
        describe(status, reading, run, directory);
    } else {
        screen::print(&values(run, printed));
    }
    for warning in run.all_warnings() {
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
    let kept = if trajectory.is_empty() {
        "Nothing was recorded.".to_owned()
    } else {
        format!("What was computed until t = {end} s is kept.")
    };
    screen::report(&format!("error: {reason}\n{kept}\n"));
    Outcome::Incomplete
}

/// Says what a run gave and where its files are.
fn describe(status: Status, reading: &Reading, run: &Run, directory: &Directory) {
    let trajectory = &run.trajectory;
    let end = format!("{:.6}", trajectory.times().last().copied().unwrap_or(0.0));
    let wall_time = run.wall_time;
    let mut out = format!("{} at t = {end} s in {wall_time:.3} s of wall time\n\n", status.word());
    if !trajectory.is_empty() {
        out.push_str(&extremes(trajectory, run.errors.as_ref()));
        out.push('\n');
    }
    if !run.events.is_empty() {
        out.push_str(&impacts(&run.events));
    }
    out.push_str(&run.errors.as_ref().map(|errors| sequence(&errors.sequence)).unwrap_or_default());
    out.push_str(&run.errors.as_ref().map(|errors| trust(errors, trajectory)).unwrap_or_default());
    screen::print(&out);
    let mut files = vec![("summary", Artifact::Summary)];
    let plot = directory.file(Artifact::PlotSvg).is_file();
    files.extend((reading.case.output.plots && plot).then_some(("plot", Artifact::PlotSvg)));
    files.extend((!run.events.is_empty()).then_some(("events", Artifact::Events)));
    let solid = reading.case.space().is_some() && reading.case.output.vtk.is_some();
    files.extend((run.shapes.is_some() || solid).then_some(("shapes", Artifact::ShapeSeries)));
    screen::files(directory, Ok(()), &files);
}

/// A line for each quantity: name, value, unit, ±, time.
fn values(run: &Run, printed: &[Quantity]) -> String {
    let line = |quantity: &Quantity| match quantity.collect(run) {
        Ok(Collected { value, time, error, .. }) => {
            let error = error.map_or_else(String::new, |error| format!("{error:?}"));
            format!("{}\t{value:?}\t{}\t{error}\t{time:?}\n", quantity.name(), quantity.unit)
        }
        // What is not finite is said as an error.
        Err(_) => format!("{}\tNaN\t{}\t\t\n", quantity.name(), quantity.unit),
    };
    printed.iter().map(line).collect()
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

/// Smallest, largest and last value of the columns that most readers look for, with their errors where those are known.
fn extremes(trajectory: &Trajectory, errors: Option<&Errors>) -> String {
    let known = errors.is_some_and(|errors| !errors.columns.is_empty());
    let mut head = vec!["", "unit", "min", "at t [s]", "max", "at t [s]", "last"];
    let of = |name: &str| errors.and_then(|errors| errors.columns.iter().find(|error| error.column == name));
    let has_model = |error: &ColumnError| error.model.is_some();
    let model = known && errors.is_some_and(|errors| errors.columns.iter().any(has_model));
    head.extend(model.then_some("exact coupling differs by"));
    let mut rows = vec![head.iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>()];
    for (index, channel) in trajectory.channels().iter().enumerate() {
        if !is_printed(channel) {
            continue;
        }
        let e = trajectory.extremes(index);
        let error = of(&channel.name);
        let unit = if channel.unit.is_empty() { "1" } else { &channel.unit };
        let value = |x: f64, error: Option<f64>| match error {
            Some(error) if error.is_finite() => flexion_results::with_error(x, error),
            _ => format!("{x:.6e}"),
        };
        let mut row = vec![
            channel.name.clone(),
            unit.to_owned(),
            value(e.min, error.map(|error| error.min)),
            format!("{:.4}", e.t_min),
            value(e.max, error.map(|error| error.max)),
            format!("{:.4}", e.t_max),
            value(e.last, error.map(|error| error.last)),
        ];
        if model {
            let differs = error.and_then(|error| error.model);
            row.push(differs.map_or("-".to_owned(), |model| format!("{model:.0e}")));
        }
        rows.push(row);
    }
    screen::table(&rows)
}

/// The refined runs with what they found.
fn sequence(rungs: &[Rung]) -> String {
    if rungs.is_empty() {
        return String::new();
    }
    let mut rows = vec![["refined", "quantity", "value", "error", "order"].map(str::to_owned).to_vec()];
    for Rung { changes, quantity, value, error, order } in rungs {
        let value = value.map_or("-".to_owned(), |value| flexion_results::with_error(value, *error));
        let order = order.map_or("-".to_owned(), |order| format!("{order:.1}"));
        rows.push(vec![changes.join(" "), quantity.clone(), value, format!("{error:.1e}"), order]);
    }
    screen::table(&rows) + "\n"
}

/// What is said of a refined run at once, for the next may take long.
fn refined(rung: &Rung) -> String {
    format!("{}: the error of {} is {:.1e}\n", rung.changes.join(" "), rung.quantity, rung.error)
}

/// What the estimate of errors says of the run as a whole.
fn trust(errors: &Errors, trajectory: &Trajectory) -> String {
    let end = trajectory.times().last().copied().unwrap_or(0.0);
    match &errors.unknown {
        // A warning says it.
        Some(_) if !errors.warnings.is_empty() => String::new(),
        Some(why) => format!("  errors are not known: {why}\n\n"),
        None if errors.trusted < end => match (&errors.distrusted, &errors.unstable) {
            (Some(column), _) => format!(
                "  trusted until t = {:.4} s: from there the error of {column} exceeds a tenth of its largest value\n\n",
                errors.trusted
            ),
            (None, Some(_)) => {
                format!(
                    "  trusted until t = {:.4} s: from there a disturbance leads elsewhere\n\n",
                    errors.trusted
                )
            }
            (None, None) => format!("  errors are known until t = {:.4} s\n\n", errors.trusted),
        },
        None => "  ± is the error of mesh and steps, estimated by a finer run\n\n".to_owned(),
    }
}

/// A time with its unit, or in seconds.
fn time(text: &str) -> Result<f64, String> {
    let time = text.parse().or_else(|_| units::parse(text, &units::TIME).map_err(|error| error.message))?;
    if time >= 0.0 { Ok(time) } else { Err(format!("`{text}` is no time of a run: zero or later")) }
}

/// Whether Ctrl-C was pressed. Without a handler it ends the program at once, and the results are not written; the second one
/// does so.
pub(crate) fn stop_on_ctrl_c() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    let _ = ctrlc::set_handler(move || {
        if asked.swap(true, Ordering::Relaxed) {
            std::process::exit(2);
        }
    });
    stop
}

/// Shows how far a run is, and those that follow it, and stops them on Ctrl-C.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// When it was shown, and when the run began that it shows.
    shown: Instant,
    began: Instant,
    end: f64,
    last: f64,
    /// Number of the run.
    run: usize,
    stop: Arc<AtomicBool>,
}

impl Progress {
    pub(crate) fn new(end: f64) -> Progress {
        // The bar draws on standard error, and only if that is a terminal.
        let bar = ProgressBar::new(TICKS as u64);
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} {percent:>3} %  {msg}") {
            bar.set_style(style);
        }
        let now = Instant::now();
        Progress { bar, shown: now, began: now, end, last: 0.0, run: 1, stop: stop_on_ctrl_c() }
    }

    pub(crate) fn show(&mut self, t: f64) -> ControlFlow<()> {
        // A companion or a refined run begins.
        if t < self.last {
            (self.began, self.run) = (Instant::now(), self.run + 1);
        }
        self.last = t;
        let part = if self.end > 0.0 { t / self.end } else { 0.0 };
        self.draw(part, |began, run| {
            let left = began.elapsed().as_secs_f64() * (1.0 / part - 1.0);
            let left = if part > CERTAIN { format!("  {left:.0} s left of this run") } else { String::new() };
            format!("run {run}: t = {t:.3} s{left}")
        })
    }

    /// Shows the load factor at which a stable equilibrium is looked for.
    pub(crate) fn show_search(&mut self, factor: f64) -> ControlFlow<()> {
        self.draw(0.0, |_, _| format!("equilibrium: load factor {factor:.3}"))
    }

    /// Shows the number of equilibria on a path and the load factor of the last.
    pub(crate) fn show_points(&mut self, points: usize, factor: f64) -> ControlFlow<()> {
        let part = (factor / self.end).clamp(0.0, 1.0);
        self.draw(part, |_, _| format!("{points} equilibria, load factor {factor:.4}"))
    }

    fn draw(&mut self, part: f64, text: impl Fn(Instant, usize) -> String) -> ControlFlow<()> {
        if self.shown.elapsed() > Duration::from_millis(100) {
            self.shown = Instant::now();
            self.bar.set_position((part * TICKS) as u64);
            self.bar.set_message(text(self.began, self.run));
        }
        if self.stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    /// What writes lines beside the bar.
    pub(crate) fn lines(&self) -> Lines {
        Lines(self.bar.clone())
    }

    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Lines on standard error, above the bar where there is one.
pub(crate) struct Lines(ProgressBar);

impl Lines {
    pub(crate) fn say(&self, line: &str) {
        self.0.suspend(|| screen::report(line));
    }
}
