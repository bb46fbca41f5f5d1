//! `flexion modes`: modes of vibration at one speed.

use crate::vibration::{self, Options, Speed, report, stations};
use crate::{Outcome, case, screen};
use flexion::analysis::campbell::HubState;
use flexion::analysis::equilibrium::{equilibrium, stable_equilibrium};
use flexion::analysis::modes::{Mode, Modes, modes as find};
use flexion::analysis::rotation::rotate_stably;
use flexion::system::{Slender, State, System};
use flexion_case::{Case, Reading};
use flexion_results::{Artifact, Directory, Frequencies, Scene, Units, write_film, write_modes};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Displacement of a mode in the files of its scene, over the scale of the unknowns.
const DISPLACED: f64 = 1e-3;
/// The same of a mode in motion, and its phases.
const FILMED: f64 = 0.1;
const PHASES: u32 = 24;

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
    #[arg(long, value_name = "SPEED", default_value = "0", value_parser = vibration::speed, allow_hyphen_values = true)]
    speed: Speed,
    /// Number of modes, the lowest
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
    let directory = arguments
        .output
        .as_ref()
        .map(|path| Directory::create_for(Artifact::MODES, path, arguments.force, &reading.inputs()));
    let directory = directory.transpose().map_err(|error| error.to_string())?.map(Arc::new);
    let stopped = discarded_on_ctrl_c(directory.clone());
    let found = compute(arguments, case, speed, hub).inspect_err(|_| {
        directory.iter().for_each(|directory| directory.discard());
    });
    let Found { mut modes, scene, film, slender, mut cautions } = found?;
    // From here on files are written.
    stopped.store(false, Ordering::Relaxed);
    cautions.extend(vibration::without_contacts(case));
    cautions.extend(case.unused_by_modes());
    cautions.extend(case.without_trapeze(speed));
    if let Some(given) = case.rotates_at().filter(|_| speed == 0.0) {
        let given = units.speed.text(given.abs());
        cautions.push(format!("the modes are those at rest, without the rotation at {given} with which the case begins: give it by --speed"));
    }
    let growing = modes.modes.iter().filter(|mode| mode.grows()).count();
    if growing > 0 {
        cautions.push(format!("the equilibrium is unstable: {growing} of the modes grow (negative damping)"));
    }
    let still: Vec<&Mode> = modes.modes.iter().take_while(|mode| mode.eigenvalue.norm() == 0.0).collect();
    if case.space().is_some() && speed == 0.0 && !still.is_empty() {
        let which = if still.len() == 1 { "mode 1 has" } else { &format!("modes 1 to {} have", still.len()) };
        let moved: Vec<String> = still.iter().map(|mode| moves(&mode.shares.named())).collect();
        cautions.push(format!(
            "{which} no stiffness ({}): the equilibrium is one of many, of which that near the parts as they are written was taken",
            moved.join("; ")
        ));
    }
    let errors = modes.modes.iter().enumerate().map(|(number, mode)| (number + 1, mode.rounding));
    cautions.extend(vibration::rounded(errors, slender.as_ref()));
    cautions.iter().for_each(|caution| screen::report(&format!("warning: {caution}\n")));
    compare(arguments, reading, &mut modes, speed, hub);
    let about = match case.space().map(|space| &space.rotation) {
        Some(Ok(rotation)) if speed > 0.0 => {
            format!("at {} about {}", units.speed.text(speed), rotation.described(hub == HubState::Free))
        }
        Some(_) if hub == HubState::Free => "about the equilibrium at rest, free hub".to_owned(),
        Some(_) => "about the equilibrium at rest".to_owned(),
        None if hub == HubState::Free => format!("at {}, free hub", units.speed.text(speed)),
        None => format!("at {}, hub that keeps its speed", units.speed.text(speed)),
    };
    let out = described(&modes, arguments.count, &units, &about);
    let relative = |(number, mode): (usize, &Mode)| (number + 1, mode.mesh.unwrap_or(0.0) / mode.frequency());
    let coarse = modes.modes.iter().enumerate().map(relative).find(|(_, e)| *e > vibration::COARSE);
    if let Some((number, error)) = coarse {
        screen::report(&format!(
            "warning: by the mesh the frequency of mode {number} may be off by {:.1} %: use more elements or functions\n",
            100.0 * error
        ));
    }
    screen::print(&out);
    let Some(directory) = directory else { return Ok(Outcome::Finished) };
    let (resolved, stations) = (reading.resolved(), stations(case, STATIONS));
    let title = arguments.options.title(reading);
    let axes = match case.space() {
        Some(_) => ["along the tangent", "along the height", "across"],
        None => ["axial", "chordwise", "flapwise"],
    };
    let films = film.iter().try_for_each(|film| write_film(&directory, film, Artifact::ModesSeries));
    let written =
        films.and_then(|()| directory.write(Artifact::ModesScene, |f| scene.write(f))).and_then(|()| {
            write_modes(&directory, (&modes, speed, axes), &stations, &units, &resolved, title, &cautions)
        });
    screen::print("\n");
    let files = [("modes", Artifact::ModesCsv), ("shapes", Artifact::ModesSvg)];
    let whole = screen::files(&directory, written, &files);
    Ok(if whole { Outcome::Finished } else { Outcome::Incomplete })
}

/// The modes, the equilibrium that they vibrate about, a beam that is too slender, and warnings.
struct Found {
    modes: Modes,
    scene: Scene,
    film: Option<Scene>,
    slender: Option<Slender>,
    cautions: Vec<String>,
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

fn compute(arguments: &Arguments, case: &Case, speed: f64, hub: HubState) -> Result<Found, String> {
    let (mut system, mut cautions) = vibration::system(case, speed > 0.0)?;
    let mut state = State::zeros(system.size(), 0.0);
    if case.space().is_some() {
        state = system.initial();
    }
    if case.space().is_some() && speed == 0.0 && case.begins_in_static_equilibrium() {
        let found = stable_equilibrium(system.as_mut(), &mut state, &mut |_| ControlFlow::Continue(()))
            .map_err(|error| error.to_string())?;
        cautions.extend(found.left.map(|left| {
            format!(
                "growing loads alone lead to an equilibrium that is {left}; the modes are those about the first stable one on the path of \
                 the loads, in which a run begins by `initial.kind = \"static\"`"
            )
        }));
    } else if case.space().is_some() && speed == 0.0 {
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
    let film = arguments.vtk.then(|| film(case, &modes, system.as_mut(), &state));
    Ok(Found { modes, scene, film, slender: system.slender(), cautions })
}

/// Every mode at the phases of a cycle.
fn film(case: &Case, modes: &Modes, system: &mut dyn System, state: &State) -> Scene {
    let mut scene = case.scene();
    let mut moved = state.clone();
    for (number, mode) in modes.modes.iter().enumerate() {
        for phase in (0..PHASES).map(|phase| f64::from(phase) / f64::from(PHASES)) {
            let (sin, cos) = (std::f64::consts::TAU * phase).sin_cos();
            displace(mode, system, state, [FILMED * cos, FILMED * sin], &mut moved);
            scene.take((number + 1) as f64 + phase, system, &moved);
        }
    }
    scene
}

/// Moves the equilibrium by a Re x − b Im x, where the largest entry of x is that of the scale of its unknown.
fn displace(mode: &Mode, system: &mut dyn System, state: &State, [a, b]: [f64; 2], moved: &mut State) {
    let sizes = mode.vector.iter().zip(system.scales()).map(|(x, scale)| x.norm() / scale);
    let largest = sizes.fold(f64::MIN_POSITIVE, f64::max);
    let d: Vec<f64> = mode.vector.iter().map(|x| (a * x.re - b * x.im) / largest).collect();
    system.retract(&state.q, &d, &mut moved.q);
}

/// The equilibrium under the time 0, and displaced a little by the real and the imaginary part of every mode under the times
/// 1, 2, and so on.
fn displaced(case: &Case, modes: &Modes, system: &mut dyn System, state: &State) -> Scene {
    let mut scene = case.scene();
    scene.take(0.0, system, state);
    let mut moved = state.clone();
    let parts = [[DISPLACED, 0.0], [0.0, -DISPLACED]];
    for (time, (mode, part)) in modes.modes.iter().flat_map(|m| parts.map(|part| (m, part))).enumerate() {
        displace(mode, system, state, part, &mut moved);
        scene.take((time + 1) as f64, system, &moved);
    }
    scene
}

/// Compares the modes with those of twice the elements or functions, where these can be computed.
fn compare(arguments: &Arguments, reading: &Reading, modes: &mut Modes, speed: f64, hub: HubState) {
    let Ok(finer) = reading.with_finer_mesh() else { return };
    let Ok(Found { modes: fine, .. }) = compute(arguments, &finer.case, speed, hub) else { return };
    for (mode, finer) in modes.modes.iter_mut().zip(&fine.modes) {
        mode.compare(finer.frequency(), vibration::safety(&reading.case));
    }
}

/// The table of modes.
fn described(modes: &Modes, asked: usize, units: &Units, about: &str) -> String {
    let unit = &units.frequency;
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

/// Shares above one in a hundred.
fn moves(shares: &[(&str, f64)]) -> String {
    let mut shares: Vec<(&str, f64)> = shares.iter().copied().filter(|s| s.1.abs() > 0.01).collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    let words: Vec<String> =
        shares.iter().map(|(name, share)| format!("{name} {:.0} %", 100.0 * share)).collect();
    words.join(", ")
}
