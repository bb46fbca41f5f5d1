//! Modes of vibration of a case at one speed of rotation.

use super::{COARSE, VibrationError, coarse, moves, rounded, unestimated};
use crate::case::Case;
use crate::reading::Reading;
use flexion::analysis::campbell::HubState;
use flexion::analysis::equilibrium::{equilibrium, stable_equilibrium};
use flexion::analysis::mesh_error::compare;
use flexion::analysis::modes::{Mode, Modes, modes as find};
use flexion::analysis::rotation::rotate_stably;
use flexion::system::{Slender, State, System};
use flexion_results::{Artifact, Directory, OutputError, Scene, Units, write_film, write_modes};
use std::ops::ControlFlow;

/// Displacement of a mode in the files of its scene, over the scale of the unknowns.
const DISPLACED: f64 = 1e-3;
/// The same of a mode in motion, and its phases.
const FILMED: f64 = 0.1;
const PHASES: u32 = 24;
/// Modes of a finer mesh beyond those asked for: with damping the last ones may change their order.
const MORE: usize = 4;
/// Parts of the beam at whose ends shapes are given.
const STATIONS: u32 = 200;

/// What is asked of the modes of a case.
#[derive(Clone, Debug)]
pub struct ModesRequest {
    /// Speed of rotation \[rad/s\]; the frequencies are those of the speed with the other sign.
    pub speed: f64,
    /// Number of modes, those of the smallest |λ|.
    pub count: usize,
    /// Whether the hub is free to rotate with the beam under its torques; otherwise it keeps its speed.
    pub free_hub: bool,
    /// Units of what is said and written.
    pub units: Units,
    /// Whether every mode is shown in motion.
    pub film: bool,
}

/// Modes of a case, with what its reader should know of them.
pub struct FoundModes {
    /// What was asked.
    pub request: ModesRequest,
    /// The modes, with their errors by the mesh where a finer mesh has them too.
    pub modes: Modes,
    /// Stations of their shapes along the beam \[m\].
    pub stations: Vec<f64>,
    /// What the three directions of the shapes are called.
    pub axes: [&'static str; 3],
    /// The equilibrium that they vibrate about, and each displaced a little.
    pub scene: Scene,
    /// Every mode in motion, where it was asked.
    pub film: Option<Scene>,
    /// The state that they are of, in words: `at 4 rad/s, hub that keeps its speed`.
    pub about: String,
    /// Warnings.
    pub warnings: Vec<String>,
    slender: Option<Slender>,
}

impl Reading {
    /// The modes of small vibrations about the equilibrium of the case in steady rotation, which replaces its motion.
    ///
    /// # Errors
    /// [`VibrationError`]: a case with parts that do not rotate steadily, a speed that is not finite, no equilibrium or no modes.
    pub fn modes(&self, request: &ModesRequest) -> Result<FoundModes, VibrationError> {
        self.fits_modes()?;
        let (case, speed, units) = (&self.case, request.speed, &request.units);
        if !speed.is_finite() {
            return Err(VibrationError::Request("the speed must be a finite number".to_owned()));
        }
        let hub = case.hub_state(request.free_hub)?;
        let mut found = compute(case, request, hub).map_err(|error| error.suspecting(case))?;
        found.warnings.extend(case.without_trapeze(speed));
        if let Some(given) = case.rotates_at().filter(|_| speed == 0.0) {
            let given = units.speed.text(given.abs());
            found.warnings.push(format!("the modes are those at rest, without the rotation at {given} with which the case begins: give it by --speed"));
        }
        found.warnings.extend(about_motions(case, speed, &found.modes));
        let errors = found.modes.modes.iter().enumerate().map(|(number, mode)| (number + 1, mode.rounding));
        found.warnings.extend(rounded(errors, found.slender.as_ref()));
        // With those of twice the elements or functions, where these can be computed.
        let finer = self.with_finer_mesh().map_err(|problems| problems.reason());
        match finer
            .and_then(|finer| finer_modes(&finer.case, request, hub).map_err(|error| error.to_string()))
        {
            Ok(finer) => compare(&mut found.modes.modes, &finer, case.safety_of_frequencies()),
            Err(why) => found.warnings.push(unestimated(&why)),
        }
        let relative =
            |(number, mode): (usize, &Mode)| (number + 1, mode.mesh.unwrap_or(0.0) / mode.frequency());
        let largest = found.modes.modes.iter().enumerate().map(relative).find(|(_, error)| *error > COARSE);
        found.warnings.extend(largest.map(|(number, error)| coarse(number, None, error)));
        found.about = match case.space().map(|space| &space.rotation) {
            Some(Ok(rotation)) if speed != 0.0 => {
                format!("at {} about {}", units.speed.text(speed), rotation.described(hub == HubState::Free))
            }
            Some(_) if hub == HubState::Free => "about the equilibrium at rest, free hub".to_owned(),
            Some(_) => "about the equilibrium at rest".to_owned(),
            None if hub == HubState::Free => format!("at {}, free hub", units.speed.text(speed)),
            None => format!("at {}, hub that keeps its speed", units.speed.text(speed)),
        };
        Ok(found)
    }

    /// Writes modes of this case and publishes them.
    ///
    /// # Errors
    /// [`OutputError`] for whatever goes wrong on disk or in drawing.
    pub fn write_modes(
        &self,
        found: &FoundModes,
        title: Option<&str>,
        directory: &Directory,
    ) -> Result<(), OutputError> {
        let FoundModes { request, modes, stations, axes, scene, film, warnings, .. } = found;
        film.iter().try_for_each(|film| write_film(directory, film, Artifact::ModesSeries))?;
        directory.write_arrays(Artifact::ModesScene, |to| scene.put(to))?;
        let shown = (modes, request.speed, *axes);
        write_modes(directory, shown, stations, &request.units, &self.resolved(), title, warnings)
    }
}

/// Modes that grow, and motions without stiffness.
fn about_motions(case: &Case, speed: f64, modes: &Modes) -> Vec<String> {
    let mut warnings = Vec::new();
    let growing = modes.modes.iter().filter(|mode| mode.grows()).count();
    if growing > 0 {
        warnings.push(format!("the equilibrium is unstable: {growing} of the modes grow (negative damping)"));
    }
    let still: Vec<&Mode> = modes.modes.iter().take_while(|mode| mode.eigenvalue.norm() == 0.0).collect();
    if case.space().is_some() && speed == 0.0 && !still.is_empty() {
        let which = if still.len() == 1 { "mode 1 has" } else { &format!("modes 1 to {} have", still.len()) };
        let moved: Vec<String> = still.iter().map(|mode| moves(&mode.shares.named())).collect();
        warnings.push(format!(
            "{which} no stiffness ({}): the equilibrium is one of many, of which that near the parts as they are written was taken",
            moved.join("; ")
        ));
    }
    warnings
}

/// The modes of the case on a finer mesh: some more, among which that of every mode is.
fn finer_modes(case: &Case, request: &ModesRequest, hub: HubState) -> Result<Vec<Mode>, VibrationError> {
    let of = |more: usize| {
        let request = ModesRequest { count: request.count + more, film: false, ..request.clone() };
        compute(case, &request, hub).map(|found| found.modes.modes)
    };
    of(MORE).or_else(|_| of(0))
}

/// The modes on the mesh of the case.
fn compute(case: &Case, request: &ModesRequest, hub: HubState) -> Result<FoundModes, VibrationError> {
    let speed = request.speed;
    let (mut system, mut warnings) = case.vibrates(speed != 0.0)?;
    let mut state = State::zeros(system.size(), 0.0);
    if case.space().is_some() {
        state = system.initial();
    }
    if case.space().is_some() && speed == 0.0 && case.begins_in_static_equilibrium() {
        let found = stable_equilibrium(system.as_mut(), &mut state, &mut |_| ControlFlow::Continue(()))
            .map_err(VibrationError::not_found)?;
        warnings.extend(found.left.map(|left| {
            format!(
                "growing loads alone lead to an equilibrium that is {left}; the modes are those about the first stable one on the path of \
                 the loads, in which a run begins by `initial.kind = \"static\"`"
            )
        }));
    } else if case.space().is_some() && speed == 0.0 {
        equilibrium(system.as_mut(), &mut state).map_err(VibrationError::not_found)?;
    } else {
        rotate_stably(system.as_mut(), &mut state, 0.0, speed).map_err(VibrationError::not_found)?;
    }
    if hub == HubState::Free {
        system.hold(false);
        state.v = system.initial().v;
    }
    let stations = case.stations_of_shapes(STATIONS);
    let modes = find(system.as_mut(), &state, request.count, &stations).map_err(VibrationError::not_found)?;
    let scene = displaced(case, &modes, system.as_mut(), &state);
    let film = request.film.then(|| film(case, &modes, system.as_mut(), &state));
    let axes = match case.space() {
        Some(_) => ["along the tangent", "along the height", "across"],
        None => ["axial", "chordwise", "flapwise"],
    };
    let (request, slender) = (request.clone(), system.slender());
    Ok(FoundModes { request, modes, stations, axes, scene, film, about: String::new(), warnings, slender })
}

/// Every mode at the phases of a cycle.
fn film(case: &Case, modes: &Modes, system: &mut dyn System, state: &State) -> Scene {
    let mut scene = case.scene();
    let mut moved = state.clone();
    for (number, mode) in modes.modes.iter().enumerate() {
        for phase in (0..PHASES).map(|phase| f64::from(phase) / f64::from(PHASES)) {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * phase);
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
