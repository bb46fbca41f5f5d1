//! `flexion run`: integrates a case and writes its results.

use crate::{Outcome, case, screen};
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::case::{Initial, Integrator as IntegratorCase, Live, Reading};
use flexion::linalg::Structure;
use flexion::output::plot::trajectory_figure;
use flexion::output::{
    Artifact, Directory, Integration, ProblemSize, RunReport, Status, Trajectory, write_run,
};
use flexion::system::{State, System};
use indicatif::{ProgressBar, ProgressStyle};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The case to run and where its results go.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion run verification/spin-up
  flexion run case.toml --set section.modulus=\"30 GPa\" --output results/soft --force

Exit codes: 0 finished, 1 case rejected, 2 stopped or failed (what was computed is kept).")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Directory of the results [default: results/<name of the case>]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace the results of a former run
    #[arg(long)]
    force: bool,
}

/// Positions of the progress bar.
const TICKS: f64 = 1000.0;

/// Runs a case.
pub fn run(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    let output = arguments.output.clone().unwrap_or_else(|| Path::new("results").join(arguments.case.name()));
    match prepare(&reading, &output, arguments.force) {
        Ok(prepared) => integrate(&reading, prepared),
        Err(message) => {
            screen::complain(&message);
            Outcome::Rejected
        }
    }
}

/// Everything a run needs, checked.
struct Prepared {
    system: Box<dyn System>,
    integrator: Box<dyn flexion::integrator::Integrator>,
    state: State,
    directory: Directory,
}

fn prepare(reading: &Reading, output: &Path, force: bool) -> Result<Prepared, String> {
    let render = |problems: flexion::case::Problems| problems.render(screen::colour());
    let Live { mut system, integrator } = reading.build().map_err(render)?;
    let mut state = State::zeros(system.size(), 0.0);
    if reading.case.initial == Initial::SteadyRotation {
        equilibrium(system.as_mut(), &mut state)
            .map_err(|error| render(reading.problem("initial", error.to_string())))?;
    }
    let directory = Directory::create(output, force).map_err(|error| format!("error: {error}\n"))?;
    Ok(Prepared { system, integrator, state, directory })
}

fn integrate(reading: &Reading, prepared: Prepared) -> Outcome {
    let Prepared { mut system, mut integrator, mut state, directory } = prepared;
    let case = &reading.case;
    let (step, longest_step) = match case.integrator {
        IntegratorCase::Radau { initial_step, max_step, .. } => (initial_step, max_step),
        _ => (case.integrator.step(), None),
    };
    let plan = Plan { end: case.duration, step, longest_step, sample: case.output.step };
    let mut watch = Watch::new(system.as_ref(), &plan);
    let start = Instant::now();
    let ending = transient(system.as_mut(), integrator.as_mut(), &mut state, &plan, &mut watch);
    let wall_time = start.elapsed().as_secs_f64();
    watch.bar.finish_and_clear();
    let trajectory = watch.trajectory;

    let (status, message) = match ending {
        Ending::Finished => (Status::Finished, None),
        Ending::Stopped => (Status::Stopped, Some(format!("stopped by the user at t = {:.6} s", state.t))),
        Ending::Failed(error) => (Status::Failed, Some(error.to_string())),
    };
    let file = reading.file.file_name().map(|name| name.to_string_lossy());
    let report = RunReport {
        status,
        message: message.as_deref(),
        title: &case.title,
        file: file.as_deref(),
        duration: case.duration,
        end_time: state.t,
        warnings: &[],
        integrator: Integration { info: integrator.info(), settings: reading.settings("integrator") },
        counters: integrator.counters(),
        size: size(system.as_ref()),
        wall_time,
    };
    let title = (!case.title.is_empty()).then_some(case.title.as_str());
    let figure = trajectory_figure(&trajectory, title);
    match write_run(&directory, &report, &trajectory, &reading.resolved(), Some(&figure)) {
        Ok(status) => finish(status, message.as_deref(), wall_time, &trajectory, &directory),
        Err(error) => {
            screen::complain(&format!("error: {error}\n"));
            Outcome::Incomplete
        }
    }
}

/// Says how the run went and where its files are.
fn finish(
    status: Status,
    message: Option<&str>,
    wall_time: f64,
    trajectory: &Trajectory,
    directory: &Directory,
) -> Outcome {
    let end = format!("{:.6}", trajectory.times().last().copied().unwrap_or(0.0));
    let mut out = format!("{} at t = {end} s after {wall_time:.2} s of computing\n\n", status.word());
    out.push_str(&extremes(trajectory));
    out.push('\n');
    let place = |what: &str, artifact| vec![what.to_owned(), directory.file(artifact).display().to_string()];
    out.push_str(&screen::table(&[place("summary", Artifact::Summary), place("plot", Artifact::PlotSvg)]));
    screen::print(&out);
    if status == Status::Finished {
        return Outcome::Finished;
    }
    let reason = match (message, trajectory.first_not_finite()) {
        (Some(message), _) => message.to_owned(),
        (None, Some((channel, t))) => format!("{} is not finite at t = {t} s", channel.name),
        (None, None) => status.word().to_owned(),
    };
    screen::complain(&format!("error: {reason}\nWhat was computed until t = {end} s is kept.\n"));
    Outcome::Incomplete
}

/// Smallest, largest and last value of what is recorded at the tip and the hub.
fn extremes(trajectory: &Trajectory) -> String {
    let head = ["", "unit", "min", "at t [s]", "max", "at t [s]", "last"];
    let mut rows = vec![head.iter().map(|cell| (*cell).to_owned()).collect::<Vec<_>>()];
    for (index, channel) in trajectory.channels().iter().enumerate() {
        if !(channel.name.starts_with("tip.") || channel.name.starts_with("hub.")) {
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

fn size(system: &dyn System) -> ProblemSize {
    let unknowns = system.size().v + system.size().lambda;
    match system.structure() {
        Structure::Dense { order } => {
            ProblemSize { unknowns, half_bandwidth: order.saturating_sub(1), border: 0 }
        }
        Structure::Band { lower, upper, border, .. } => {
            ProblemSize { unknowns, half_bandwidth: lower.max(upper), border }
        }
    }
}

/// Records the run, shows how far it is, and stops it on Ctrl-C.
struct Watch {
    trajectory: Trajectory,
    bar: ProgressBar,
    shown: Instant,
    end: f64,
    stop: Arc<AtomicBool>,
}

impl Watch {
    fn new(system: &dyn System, plan: &Plan) -> Watch {
        let mut trajectory = Trajectory::new(system.channels().to_vec());
        trajectory.reserve((plan.end / plan.sample).min(1e7) as usize + 2);
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
        Watch { trajectory, bar, shown: Instant::now(), end: plan.end, stop }
    }
}

impl Observer for Watch {
    fn sample(&mut self, system: &mut dyn System, state: &State, _step: &Step) {
        self.trajectory.push(state.t, |row| system.record(state, row));
    }

    fn step(&mut self, state: &State) -> ControlFlow<()> {
        if self.shown.elapsed() > Duration::from_millis(100) {
            self.shown = Instant::now();
            self.bar.set_position((state.t / self.end * TICKS) as u64);
            self.bar.set_message(format!("t = {:.3} s", state.t));
        }
        if self.stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}
