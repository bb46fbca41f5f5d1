//! `flexion modes`: modes of vibration at one speed.

use crate::vibration::{self, Options, Speed, report, stations};
use crate::{Outcome, case, screen};
use flexion::analysis::campbell::HubState;
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::modes::{Mode, Modes, modes as find};
use flexion::analysis::rotation::rotate_stably;
use flexion::system::{State, System};
use flexion_case::{Case, Reading};
use flexion_results::{Artifact, Directory, Scene, Units, write_modes};
use std::path::PathBuf;

/// Damping ratio below which a mode grows.
const GROWTH: f64 = -1e-7;
/// Displacement of a mode in the files of its scene, over the scale of the unknowns.
const DISPLACED: f64 = 1e-3;

/// The case, the speed, and how many modes.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion modes verification/p1_spin_up_4 --speed 4 --count 6
  flexion modes case.toml --speed 300 --unit rpm --output results/modes
  flexion modes case.toml --speed '12.1 rpm'

The motion of the case is replaced by a steady rotation at the speed; the modes are those of small vibrations about its
equilibrium. The hub keeps its speed unless --free-hub is given.

Exit codes: 0 finished, 1 case or command line rejected, or no stable rotation at the speed, 2 the files could not be
written.")]
pub struct Arguments {
    #[command(flatten)]
    case: case::Selection,
    /// Speed of rotation, a number of the unit or with a unit of its own: '12.1 rpm'
    #[arg(long, value_name = "SPEED", default_value = "0", value_parser = vibration::speed, allow_negative_numbers = true)]
    speed: Speed,
    /// Number of modes, the lowest
    #[arg(long, value_name = "N", default_value = "10", value_parser = vibration::count)]
    count: usize,
    #[command(flatten)]
    options: Options,
    /// Directory for modes.json, .csv, .npz and the pictures of the shapes
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Replace former results in that directory
    #[arg(long, requires = "output")]
    force: bool,
}

/// Parts of the beam at whose ends shapes are given.
const STATIONS: u32 = 200;

/// Finds and writes modes.
pub fn modes(arguments: &Arguments) -> Outcome {
    let Some(reading) = arguments.case.read().filter(vibration::fits) else { return Outcome::Rejected };
    found(arguments, &reading).unwrap_or_else(|message| {
        report(&message);
        Outcome::Rejected
    })
}

fn found(arguments: &Arguments, reading: &Reading) -> Result<Outcome, String> {
    let case = &reading.case;
    let units = arguments.options.units(case, arguments.speed)?;
    let speed = arguments.speed.in_radians(&units.speed);
    if !(speed.is_finite() && speed >= 0.0) {
        return Err(format!("the speed is {} and must be zero or positive", units.speed.text(speed)));
    }
    let hub = arguments.options.hub(case)?;
    let directory =
        arguments.output.as_ref().map(|path| Directory::create_for(Artifact::MODES, path, arguments.force));
    let directory = directory.transpose().map_err(|error| error.to_string())?;
    let (steady, mut cautions) =
        if speed > 0.0 { vibration::without_loads_in_space(case) } else { (case.clone(), Vec::new()) };
    cautions.extend(vibration::without_contacts(case));
    cautions.extend(case.unused_by_modes());
    let (modes, scene) = compute(arguments, &steady, speed, hub)?;
    let growing = modes.modes.iter().filter(|mode| mode.damping_ratio() < GROWTH).count();
    if growing > 0 {
        cautions.push(format!("the equilibrium is unstable: {growing} of the modes grow (negative damping)"));
    }
    cautions.iter().for_each(|caution| screen::report(&format!("warning: {caution}\n")));
    let errors = mesh_errors(arguments, reading, &modes, speed, hub);
    let about = match case.space() {
        Some(_) => "about the equilibrium".to_owned(),
        None if hub == HubState::Free => format!("at {}, free hub", units.speed.text(speed)),
        None => format!("at {}, hub that keeps its speed", units.speed.text(speed)),
    };
    let out = described(&modes, &errors, &units, &about);
    let relative = |(number, (mode, error)): (usize, (&Mode, &f64))| (number + 1, error / mode.frequency());
    let coarse = modes.modes.iter().zip(&errors).enumerate().map(relative).find(|(_, e)| *e > COARSE);
    if let Some((number, error)) = coarse {
        screen::report(&format!(
            "warning: by the mesh the frequency of mode {number} may be off by {:.1} %: use more elements or functions\n",
            100.0 * error
        ));
    }
    for (number, mode) in modes.modes.iter().enumerate().filter(|(_, mode)| mode.rounding > 1e-6) {
        screen::report(&format!(
            "warning: the frequency of mode {} may be off by {:.1e} by rounding: the mesh is too fine for this coupling; \
             use fewer elements\n",
            number + 1,
            mode.rounding
        ));
    }
    screen::print(&out);
    let Some(directory) = directory else { return Ok(Outcome::Finished) };
    let (resolved, stations) = (reading.resolved(), stations(case, STATIONS));
    let title = arguments.options.title(reading);
    let written = directory.write(Artifact::ModesScene, |f| scene.write(f)).and_then(|()| {
        write_modes(&directory, (&modes, speed), &stations, &units, &resolved, title, &cautions)
    });
    screen::print("\n");
    let files = [("modes", Artifact::ModesCsv), ("shapes", Artifact::ModesSvg)];
    let whole = screen::files(&directory, written, &files);
    Ok(if whole { Outcome::Finished } else { Outcome::Incomplete })
}

/// The modes and the equilibrium that they vibrate about.
fn compute(arguments: &Arguments, case: &Case, speed: f64, hub: HubState) -> Result<(Modes, Scene), String> {
    let mut system = vibration::system(case)?;
    let mut state = State::zeros(system.size(), 0.0);
    if case.space().is_some() {
        state = system.initial();
    }
    if case.space().is_some() && speed == 0.0 {
        equilibrium(system.as_mut(), &mut state).map_err(|error| error.to_string())?;
    } else {
        rotate_stably(system.as_mut(), &mut state, 0.0, speed).map_err(|error| error.to_string())?;
    }
    if hub == HubState::Free {
        system.hold(false);
        state.v = system.initial().v;
    }
    let modes = find(system.as_mut(), &state, arguments.count, &stations(case, STATIONS));
    let modes = modes.map_err(|error| error.to_string())?;
    let scene = displaced(case, &modes, system.as_mut(), &state);
    Ok((modes, scene))
}

/// The equilibrium under the time 0, and displaced a little by the real and the imaginary part of every mode under the times
/// 1, 2, and so on.
fn displaced(case: &Case, modes: &Modes, system: &mut dyn System, state: &State) -> Scene {
    let mut scene = case.scene();
    scene.take(0.0, system, state);
    let scales = system.scales().to_vec();
    let mut moved = state.clone();
    for (time, (mode, part)) in modes.modes.iter().flat_map(|m| [(m, 0), (m, 1)]).enumerate() {
        let sizes = mode.vector.iter().zip(&scales).map(|(x, scale)| x.norm() / scale);
        let step = DISPLACED / sizes.fold(f64::MIN_POSITIVE, f64::max);
        let d: Vec<f64> = mode.vector.iter().map(|x| step * if part == 0 { x.re } else { x.im }).collect();
        system.retract(&state.q, &d, &mut moved.q);
        scene.take((time + 1) as f64, system, &moved);
    }
    scene
}

/// Relative error of a frequency by the mesh above which there is a warning.
const COARSE: f64 = 0.01;

/// Error of each frequency by the mesh \[rad/s\], from its difference to the one with twice the functions; none where that
/// cannot be computed.
fn mesh_errors(
    arguments: &Arguments,
    reading: &Reading,
    modes: &Modes,
    speed: f64,
    hub: HubState,
) -> Vec<f64> {
    let Ok(finer) = reading.with_finer_mesh() else { return Vec::new() };
    let steady =
        if speed > 0.0 { vibration::without_loads_in_space(&finer.case).0 } else { finer.case.clone() };
    let Ok((fine, _)) = compute(arguments, &steady, speed, hub) else { return Vec::new() };
    let safety = reading.case.hub_beam().map_or(2.0, |beam| beam.bases.safety);
    let pairs = modes.modes.iter().zip(&fine.modes);
    pairs.map(|(a, b)| safety * (a.frequency() - b.frequency()).abs()).collect()
}

/// The table of modes.
fn described(modes: &Modes, errors: &[f64], units: &Units, about: &str) -> String {
    let unit = &units.frequency;
    let mut out = format!("{} modes {about}\n\n", modes.modes.len());
    let head = [
        "mode",
        if unit.name.is_empty() { "frequency" } else { unit.name },
        "± mesh",
        "damping",
        "nodes",
        "moves",
        "residual",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for (number, mode) in modes.modes.iter().enumerate() {
        rows.push(vec![
            format!("{}", number + 1),
            format!("{:.6}", mode.frequency() * unit.factor),
            errors.get(number).map_or("-".to_owned(), |error| format!("{:.1e}", error * unit.factor)),
            format!("{:.4e}", mode.damping_ratio()),
            mode.nodes.to_string(),
            moves(mode),
            format!("{:.0e}", mode.residual),
        ]);
    }
    out.push_str(&screen::table(&rows));
    if modes.counted.is_some() {
        out.push_str("\nNone is missing among them, by the inertia of the stiffness.\n");
    }
    out
}

/// Shares above one in a hundred.
fn moves(mode: &Mode) -> String {
    let mut shares: Vec<(&str, f64)> = mode.shares.named().into_iter().filter(|s| s.1.abs() > 0.01).collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    let words: Vec<String> =
        shares.iter().map(|(name, share)| format!("{name} {:.0} %", 100.0 * share)).collect();
    words.join(", ")
}
