//! `flexion modes`: modes of vibration at one speed.

use crate::vibration::{self, Options};
use crate::{Outcome, case, screen};
use flexion_case::{FoundModes, ModesRequest, Reading, Speed, VibrationError, moves};
use flexion_results::{Artifact, Directory, Frequencies};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The case, the speed, and how many modes.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion modes verification/p1_spin_up_4 --speed 4 --count 6
  flexion modes case.toml --speed 300 --unit rpm --output results/modes
  flexion modes case.toml --speed '12.1 rpm'

The motion of the case is replaced by a steady rotation at the speed; the modes are those of small vibrations about its
equilibrium. The hub keeps its speed unless --free-hub is given. The lowest modes are those of the smallest |λ| of e^{λt}: without
damping those of the lowest frequency ω, with damping of the lowest ω/√(1 − ζ²). What does not vibrate, ζ > 0.9962, is listed apart.

Exit codes: 0 finished, 1 case or command line rejected, or no stable rotation at the speed, 2 the files could not be
written.")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Speed of rotation, a number of the unit or with a unit of its own: '12.1 rpm'
    #[arg(long, value_name = "SPEED", default_value = "0", value_parser = Speed::read, allow_hyphen_values = true)]
    speed: Speed,
    /// Number of modes, those of the smallest |λ|
    #[arg(long, value_name = "N", default_value = "10", value_parser = vibration::count)]
    count: usize,
    #[command(flatten)]
    options: Options,
    /// Directory for modes.json, .csv, .npz and the pictures of the shapes
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Write every mode in motion for ParaView too: mode k from the time k to k + 1
    #[arg(long, requires = "output")]
    vtk: bool,
    /// Replace former results in that directory
    #[arg(long, requires = "output")]
    force: bool,
}

/// Finds and writes modes.
pub fn modes(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read() else { return Outcome::Rejected };
    found(arguments, &reading).unwrap_or_else(|error| vibration::refused(&error))
}

fn found(arguments: &Arguments, reading: &Reading) -> Result<Outcome, VibrationError> {
    let units = arguments.options.units(&reading.case, arguments.speed)?;
    let request = ModesRequest {
        speed: arguments.speed.in_radians(&units.speed),
        count: arguments.count,
        free_hub: arguments.options.free_hub,
        units,
        film: arguments.vtk,
    };
    let directory = arguments
        .output
        .as_ref()
        .map(|path| Directory::create_for(Artifact::MODES, path, arguments.force, &reading.inputs()));
    let directory = directory.transpose().map_err(|error| VibrationError::Request(error.to_string()))?;
    let directory = directory.map(Arc::new);
    let stopped = discarded_on_ctrl_c(directory.clone());
    let found = reading.modes(&request).inspect_err(|_| {
        directory.iter().for_each(|directory| directory.discard());
    })?;
    // From here on files are written.
    stopped.store(false, Ordering::Relaxed);
    found.warnings.iter().for_each(|warning| screen::report(&format!("warning: {warning}\n")));
    screen::print(&described(&found));
    let Some(directory) = directory else { return Ok(Outcome::Finished) };
    let written = reading.write_modes(&found, arguments.options.title(reading), &directory);
    screen::print("\n");
    let files = [("modes", Artifact::ModesCsv), ("shapes", Artifact::ModesSvg)];
    let whole = screen::files(&directory, written, &files);
    Ok(if whole { Outcome::Finished } else { Outcome::Incomplete })
}

/// Ends the program on Ctrl-C; a directory that was made for results is gone then, as long as what is given back is set.
fn discarded_on_ctrl_c(directory: Option<Arc<Directory>>) -> Arc<AtomicBool> {
    let discards = Arc::new(AtomicBool::new(true));
    let asked = Arc::clone(&discards);
    let _ = ctrlc::set_handler(move || {
        if let Some(directory) = directory.as_ref().filter(|_| asked.load(Ordering::Relaxed)) {
            directory.discard();
        }
        std::process::exit(2);
    });
    discards
}

/// The table of modes.
fn described(FoundModes { request, modes, about, .. }: &FoundModes) -> String {
    let (asked, unit) = (request.count, &request.units.frequency);
    let mut out = format!("{} modes {about}\n\n", modes.modes.len());
    let head = [
        "mode",
        if unit.name.is_empty() { "frequency" } else { unit.name },
        "± mesh",
        "damping",
        "nodes",
        "moves",
        "in axes of the section",
        "residual",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for (number, mode) in modes.modes.iter().enumerate() {
        rows.push(vec![
            format!("{}", number + 1),
            unit.number(mode.frequency()),
            mode.mesh.map_or("-".to_owned(), |error| format!("{:.1e}", error * unit.factor)),
            format!("{:.4e}", mode.damping_ratio()),
            mode.nodes.to_string(),
            moves(&mode.shares.named()),
            moves(&mode.shares.in_section()),
            format!("{:.0e}", mode.residual),
        ]);
    }
    // Of a beam on a hub these are those of the plane.
    let section = head.len() - 2;
    if rows.iter().skip(1).all(|row| row[section].is_empty()) {
        rows.iter_mut().for_each(|row| drop(row.remove(section)));
    }
    out.push_str(&screen::table(&rows));
    if modes.counted.is_some() {
        out.push_str("\nA Sturm count confirms that no mode below the last is missing.\n");
    }
    if modes.modes.len() < asked {
        let (found, plural) = (modes.modes.len(), if modes.modes.len() == 1 { "" } else { "s" });
        let rest = if modes.overdamped.is_empty() {
            "the system has no more"
        } else {
            "the other motions found are overdamped"
        };
        out.push_str(&format!("\n{asked} modes were asked for, {found} mode{plural} found: {rest}.\n"));
    }
    if !modes.overdamped.is_empty() {
        let rates: Vec<String> =
            modes.overdamped.iter().map(|mode| Frequencies::RADIANS.number(-mode.eigenvalue.re)).collect();
        out.push_str(&format!(
            "\nOverdamped motions, which decay without vibrating, by their rates [1/s]: {}\n",
            rates.join(", ")
        ));
    }
    out
}
