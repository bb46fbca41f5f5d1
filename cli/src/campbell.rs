//! `flexion campbell`: modes of vibration over a range of speeds.

use crate::run::stop_on_ctrl_c;
use crate::vibration::{self, Options, Speed, report, speed, stations};
use crate::{Outcome, case, screen};
use flexion::analysis::campbell::{Branch, Campbell, Crossing, Instability, NoCampbell, Plan};
use flexion_case::Reading;
use flexion_results::{Artifact, Directory, Frequencies, Resonance, Units, resonances, write_campbell};
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
shape changes fast.

Frequencies are those seen from the rotating frame. There a load that is fixed in space, such as weight, excites with 1Ω. A frequency
that reaches zero is a critical speed: a whirl forward with the rotation, which unbalance excites. A shaft that whirls backward with
its speed has the frequency 2Ω.

Exit codes: 0 finished, 1 case or command line rejected, 2 no steady rotation was found within the range,
and what lies below is kept, or the files could not be written. A divergence or a flutter within the range is a result.")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Range of speeds, e.g. 0:50:100 or '0 rpm:20 rpm:100'
    #[arg(long, value_name = "FROM:TO:NUMBER", value_parser = range, allow_hyphen_values = true)]
    speeds: Range,
    /// Number of modes, the lowest at any of the speeds
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

/// Speeds from, to, how many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    from: Speed,
    to: Speed,
    count: usize,
}

/// Most lines ω = kΩ.
const MOST_REVOLUTIONS: i64 = 1000;
/// Modes above those asked for that are followed, for they may come down.
const ABOVE: usize = 3;
/// Most speeds of a diagram.
const MOST: usize = 100_000;

/// Parts of the beam at whose ends shapes are given.
const STATIONS: u32 = 50;

fn margin(text: &str) -> Result<f64, String> {
    match text.trim_end_matches('%').trim().parse::<f64>() {
        Ok(percent) if (0.0..100.0).contains(&percent) => Ok(percent),
        _ => Err("it is a number of percent from 0 to less than 100".to_owned()),
    }
}

fn range(text: &str) -> Result<Range, String> {
    let parts: Vec<&str> = text.split(':').collect();
    // The unit of the first is that of the last too, where that has none.
    let last = |from: &str, to: &str| match to.trim().parse::<f64>() {
        Ok(_) => {
            speed(&format!("{to}{}", from.trim().trim_start_matches(|c: char| "0123456789.+-eE".contains(c))))
        }
        Err(_) => speed(to),
    };
    let (from, to, count) = match parts[..] {
        [from, to] => (speed(from)?, last(from, to)?, 51),
        [from, to, count] => {
            let whole = count.trim().parse::<usize>();
            (speed(from)?, last(from, to)?, whole.map_err(|_| format!("`{count}` is no number of speeds"))?)
        }
        _ => return Err("write FROM:TO:NUMBER, e.g. 0:50:100".to_owned()),
    };
    if !(2..=MOST).contains(&count) {
        return Err(format!("there are from 2 to {MOST} speeds, not {count}"));
    }
    Ok(Range { from, to, count })
}

impl Range {
    /// The speeds [rad/s].
    fn speeds(&self, unit: &Frequencies) -> Result<Vec<f64>, String> {
        let (from, to) = (self.from.in_radians(unit), self.to.in_radians(unit));
        if !(from.is_finite() && to.is_finite() && 0.0 <= from && from < to) {
            let (from, to) = (unit.text(from), unit.text(to));
            return Err(format!("speeds ascend from at least zero, but {from} is followed by {to}"));
        }
        let last = self.count - 1;
        let at = |i: usize| if i == last { to } else { from + (to - from) * i as f64 / last as f64 };
        Ok((0..self.count).map(at).collect())
    }
}

/// Computes the diagram of a case.
pub fn campbell(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read().filter(vibration::fits) else { return Outcome::Rejected };
    match diagram(arguments, &reading) {
        Ok(true) => Outcome::Finished,
        Ok(false) => Outcome::Incomplete,
        Err(message) => {
            report(&message);
            Outcome::Rejected
        }
    }
}

/// Whether the diagram is whole, and written.
fn diagram(arguments: &Arguments, reading: &Reading) -> Result<bool, String> {
    let case = &reading.case;
    let (system, mut cautions) = vibration::system(case, true)?;
    cautions.extend(vibration::without_contacts(case));
    cautions.extend(case.unused_by_modes());
    let slender = system.slender();
    let units = arguments.options.units(case, arguments.speeds.to)?;
    let unit = &units.speed;
    let speeds = arguments.speeds.speeds(unit)?;
    cautions.extend(speeds.last().into_iter().flat_map(|speed| case.without_trapeze(*speed)));
    let plan = Plan {
        speeds,
        // Those that enter from above are among them.
        count: arguments.modes.max((arguments.modes + ABOVE).min(system.size().v)),
        stations: stations(case, STATIONS),
        hub: arguments.options.hub(case)?,
        revolutions: arguments.revolutions,
    };
    let named = format!("{}-campbell", arguments.case.name());
    let output = arguments.output.clone().unwrap_or_else(|| Path::new("results").join(named));
    let directory = Directory::create_for(Artifact::CAMPBELL, &output, arguments.force, &reading.inputs())
        .map_err(|error| error.to_string())?;
    let bar = ProgressBar::new(plan.speeds.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} speeds  {eta} left") {
        bar.set_style(style);
    }
    let stop = stop_on_ctrl_c();
    let progress = |done: usize| {
        bar.set_position(done as u64);
        !stop.load(Ordering::Relaxed)
    };
    let finer = reading.with_finer_mesh().ok().and_then(|finer| vibration::system(&finer.case, true).ok());
    let finer = finer.map(|(finer, _)| (finer, vibration::safety(case)));
    let diagram = flexion_case::campbell(system, finer, &plan, arguments.threads, &progress);
    bar.finish_and_clear();
    let mut diagram = diagram.map_err(|error: NoCampbell| {
        directory.discard();
        error.to_string()
    })?;
    keep_lowest(&mut diagram, arguments.modes);
    let errors = diagram.branches.iter().enumerate().flat_map(|(number, branch)| {
        branch.points.iter().map(move |point| (number + 1, point.mode.rounding))
    });
    cautions.extend(vibration::rounded(errors, slender.as_ref()));
    let resonances = resonances(&diagram, plan.revolutions, arguments.margin / 100.0);
    let (resolved, title) = (reading.resolved(), arguments.options.title(reading));
    let shown = (&diagram, plan.revolutions, resonances.as_slice());
    let written = write_campbell(&directory, shown, &units, &plan.stations, &resolved, title, &cautions);
    screen::print(&described(&diagram, &resonances, arguments.margin, &units));
    let files = [("curves", Artifact::CampbellCsv), ("diagram", Artifact::CampbellSvg)];
    let mut whole = screen::files(&directory, written, &files);
    cautions.iter().for_each(|caution| screen::report(&format!("warning: {caution}\n")));
    if let Some((branch, point, error)) = diagram.coarsest()
        && error > vibration::COARSE
    {
        screen::report(&format!(
            "warning: by the mesh the frequency of mode {} at {} may be off by {:.1} %: use more elements or functions\n",
            branch + 1,
            unit.short(point.speed),
            100.0 * error
        ));
    }
    let lost = diagram.instabilities.iter().any(|of| matches!(of, Instability::Lost { .. }));
    if stop.load(Ordering::Relaxed) && !lost {
        whole = false;
        let known = |branch: &Branch| {
            branch.points.iter().take_while(|point| point.mode.mesh.is_some()).last().map(|p| p.speed)
        };
        let until = diagram.branches.iter().filter_map(known).reduce(f64::max);
        let until = until.map_or("at no speed".to_owned(), |speed| format!("up to {}", unit.text(speed)));
        screen::report(&format!(
            "error: stopped by the user: errors of the frequencies by the mesh are known {until}, the frequencies at all speeds\n"
        ));
    }
    for instability in &diagram.instabilities {
        let range = |from: f64, until: Option<f64>| {
            let until = until.map_or("the last speed".to_owned(), |until| unit.text(until));
            format!("from {} to {until}", unit.text(from))
        };
        match instability {
            Instability::Divergence { speed, until } => screen::report(&format!(
                "warning: the steady rotation is unstable {}: motions diverge without vibrating\n",
                range(*speed, *until)
            )),
            Instability::Lost { reason, .. } => {
                whole = false;
                screen::report(&format!("error: {reason}\nWhat lies below is kept.\n"));
            }
            Instability::Flutter { branch, from, to, until } => screen::report(&format!(
                "warning: the damping of mode {} is negative {}; it becomes so beyond {}\n",
                branch + 1,
                range(*to, *until),
                unit.text(*from)
            )),
        }
    }
    Ok(whole)
}

/// Leaves out the modes that are at no speed among the lowest `count` and at none grow.
fn keep_lowest(diagram: &mut Campbell, count: usize) {
    let frequency = |b: &Branch, i: usize| b.points.get(i).map(|p| p.mode.frequency());
    let low = |b: &Branch| {
        b.points.iter().any(|point| point.mode.grows())
            || (0..b.points.len()).any(|i| {
                let below = |other: &&Branch| frequency(other, i).is_some_and(|f| Some(f) < frequency(b, i));
                diagram.branches.iter().filter(below).count() < count
            })
    };
    let low: Vec<bool> = diagram.branches.iter().map(low).collect();
    let renumbered = |branch: &mut usize| {
        let kept = low.get(*branch) == Some(&true);
        *branch = low.iter().take(*branch).filter(|low| **low).count();
        kept
    };
    diagram.crossings.retain_mut(|c| renumbered(&mut c.branch));
    diagram.instabilities.retain_mut(|i| match i {
        Instability::Flutter { branch, .. } => renumbered(branch),
        Instability::Divergence { .. } | Instability::Lost { .. } => true,
    });
    let mut kept = low.iter();
    diagram.branches.retain(|_| kept.next() == Some(&true));
}

/// Modes at both ends, and speeds near crossings.
fn described(diagram: &Campbell, near: &[Resonance], margin: f64, units: &Units) -> String {
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
            "\ncritical speeds, at which a forward whirl has the speed of rotation and unbalance is in resonance\n  {}\n",
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
