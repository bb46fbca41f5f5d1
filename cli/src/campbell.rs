//! `flexion campbell`: modes of vibration over a range of speeds.

use crate::run::stop_on_ctrl_c;
use crate::vibration::{self, Options, report};
use crate::{Outcome, case, screen};
use flexion::analysis::campbell::{Crossing, Resonance};
use flexion_case::{Diagram, DiagramRequest, Reading, Speeds, VibrationError};
use flexion_results::{Artifact, Directory};
use indicatif::{ProgressBar, ProgressStyle};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

/// The case and the speeds.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion campbell verification/p1_spin_up_4 --speeds 0:20:41 --modes 4
  flexion campbell case.toml --speeds 0:600:100 --unit rpm --revolutions 6 --output results/campbell
  flexion campbell case.toml --speeds '0 rpm:20 rpm:100' --margin 10

Speeds are written FROM:TO:NUMBER, ends included, or FROM:TO for 51 of them, in the unit of --unit or with units of
their own. The motion of the case is replaced by steady rotation at each speed; the hub keeps its speed unless
--free-hub is given. Modes are followed by their shapes through crossings and veerings; speeds are inserted where a
shape changes fast. Of the modes of the smallest |λ| of e^{λt} those are shown that are among the --modes lowest frequencies at some speed.

Frequencies are those seen from the rotating frame. There a load that is fixed in space, such as weight, excites with 1Ω. A frequency
that reaches zero is a critical speed: a whirl forward with the rotation, which unbalance excites. A shaft that whirls backward with
its speed has the frequency 2Ω.

Exit codes: 0 finished, 1 case or command line rejected, 2 no steady rotation was found within the range,
and what lies below is kept, or the files could not be written. A divergence or a flutter within the range is a result.")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Range of speeds, e.g. 0:50:100 or '0 rpm:20 rpm:100'
    #[arg(long, value_name = "FROM:TO:NUMBER", value_parser = Speeds::read, allow_hyphen_values = true)]
    speeds: Speeds,
    /// Number of modes, those of the lowest frequencies at any of the speeds
    #[arg(long, value_name = "N", default_value = "6", value_parser = vibration::count)]
    modes: usize,
    /// Lines ω = kΩ to cross, for k from 1 to this number
    #[arg(long, value_name = "K", default_value_t = 4, value_parser = clap::value_parser!(u32).range(0..=MOST_REVOLUTIONS))]
    revolutions: u32,
    /// List the speeds at which a frequency is within this many percent of kΩ
    #[arg(long, value_name = "PERCENT", default_value = "5", value_parser = margin)]
    margin: f64,
    #[command(flatten)]
    options: Options,
    /// Directory for campbell.json, .csv, .npz and the diagram [default: results/NAME-campbell]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace former results in that directory
    #[arg(long)]
    force: bool,
    /// Number of threads [default: one for each processor]; the results do not depend on it
    #[arg(long, value_name = "N", default_value_t = 0, hide_default_value = true)]
    threads: usize,
}

/// Most lines ω = kΩ.
const MOST_REVOLUTIONS: i64 = 1000;

fn margin(text: &str) -> Result<f64, String> {
    match text.trim_end_matches('%').trim().parse::<f64>() {
        Ok(percent) if (0.0..100.0).contains(&percent) => Ok(percent),
        _ => Err("it is a number of percent from 0 to less than 100".to_owned()),
    }
}

/// Computes the diagram of a case.
pub fn campbell(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    diagram(arguments, &reading).unwrap_or_else(|error| vibration::refused(&error))
}

fn diagram(arguments: &Arguments, reading: &Reading) -> Result<Outcome, VibrationError> {
    let units = arguments.options.units(&reading.case, arguments.speeds.to)?;
    let request = DiagramRequest {
        speeds: arguments.speeds.in_radians(&units.speed),
        count: arguments.modes,
        revolutions: arguments.revolutions,
        margin: arguments.margin,
        free_hub: arguments.options.free_hub,
        threads: arguments.threads,
        units,
    };
    let named = format!("{}-campbell", arguments.case.name());
    let output = arguments.output.clone().unwrap_or_else(|| Path::new("results").join(named));
    let directory = Directory::create_for(Artifact::CAMPBELL, &output, arguments.force, &reading.inputs())
        .map_err(|error| VibrationError::Request(error.to_string()))?;
    let bar = ProgressBar::new(request.speeds.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} speeds  {eta} left") {
        bar.set_style(style);
    }
    let stop = stop_on_ctrl_c();
    let progress = |done: usize| {
        bar.set_position(done as u64);
        !stop.load(Ordering::Relaxed)
    };
    let found = reading.campbell(&request, &progress);
    bar.finish_and_clear();
    let found = found.inspect_err(|_| directory.discard())?;
    let written = reading.write_campbell(&found, arguments.options.title(reading), &directory);
    screen::print(&described(&found));
    let files = [("curves", Artifact::CampbellCsv), ("diagram", Artifact::CampbellSvg)];
    let whole = screen::files(&directory, written, &files);
    found.warnings.iter().for_each(|warning| screen::report(&format!("warning: {warning}\n")));
    found.incomplete.iter().for_each(|what| report(what));
    let whole = whole && found.incomplete.is_empty();
    Ok(if whole { Outcome::Finished } else { Outcome::Incomplete })
}

/// Modes at both ends, and speeds near crossings.
fn described(found: &Diagram) -> String {
    let Diagram { request, campbell: diagram, resonances: near, .. } = found;
    let (margin, units) = (request.margin, &request.units);
    let mut out = format!("{} modes at {} speeds\n\n", diagram.branches.len(), diagram.speeds.len());
    let head = ["mode", "moves", "first", "last", "± mesh", "followed to"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let furthest = diagram.speeds.last().copied();
    let mut moves = Vec::new();
    for (number, branch) in diagram.branches.iter().enumerate() {
        if let (Some(first), Some(last)) = (branch.points.first(), branch.points.last()) {
            moves.push(first.mode.shares.dominant());
            let largest = branch.points.iter().filter_map(|point| point.mode.mesh).max_by(f64::total_cmp);
            let ends = Some(last.speed) != furthest;
            rows.push(vec![
                format!("{}", number + 1),
                first.mode.shares.dominant().to_owned(),
                units.frequency.text(first.mode.frequency()),
                units.frequency.text(last.mode.frequency()),
                largest.map_or("-".to_owned(), |error| format!("{:.1e}", error * units.frequency.factor)),
                if ends { units.speed.text(last.speed) } else { "the end".to_owned() },
            ]);
        }
    }
    out.push_str(&screen::table(&rows));
    if !diagram.criticals.is_empty() {
        let speeds: Vec<String> = diagram.criticals.iter().map(|c| units.speed.text(c.speed)).collect();
        out.push_str(&format!(
            "\ncritical speeds, at which a motion loses its stiffness in the rotating frame: a forward whirl with the speed of rotation, which unbalance excites, \
             or a divergence\n  {}\n",
            speeds.join(", ")
        ));
    }
    if !near.is_empty() || !diagram.crossings.is_empty() {
        out.push_str(&format!(
            "\nspeeds at which a frequency in the rotating frame is within {margin} % of kΩ\n"
        ));
        let head = ["mode", "", "", "crossing", "from", "to"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        let text = |speed: f64| units.speed.text(speed);
        let mut row = |branch: usize, revolutions: u32, crossings: &[String], ends: [String; 2]| {
            let moves = moves.get(branch).copied().unwrap_or_default();
            let (mode, line) = (format!("{}", branch + 1), format!("{revolutions}Ω"));
            let [from, to] = ends;
            rows.push(vec![mode, moves.to_owned(), line, crossings.join(", "), from, to]);
        };
        let lies = |c: &Crossing, r: &Resonance| {
            (c.branch, c.revolutions) == (r.branch, r.revolutions) && (r.from..=r.to).contains(&c.speed)
        };
        for r in near {
            let crosses = diagram.crossings.iter().filter(|c| lies(c, r));
            let crossings: Vec<String> = crosses.map(|c| text(c.speed)).collect();
            row(r.branch, r.revolutions, &crossings, [text(r.from), text(r.to)]);
        }
        // A crossing is computed, and a range lies between speeds of the diagram: few speeds may miss it.
        for c in diagram.crossings.iter().filter(|c| !near.iter().any(|r| lies(c, r))) {
            row(c.branch, c.revolutions, &[text(c.speed)], ["-".to_owned(), "-".to_owned()]);
        }
        out.push_str(&screen::table(&rows));
    }
    out.push('\n');
    out
}
