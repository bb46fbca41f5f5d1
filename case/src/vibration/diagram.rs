//! Campbell diagram of a case: its modes over a range of speeds.

use super::{COARSE, VibrationError, campbell, coarse, rounded, unestimated};
use crate::reading::Reading;
use flexion::analysis::campbell::{Branch, Campbell, Instability, NoCampbell, Plan, Resonance, resonances};
use flexion_results::{Directory, OutputError, Units, write_campbell};
use std::sync::atomic::{AtomicBool, Ordering};

/// Modes above those asked for that are followed, for they may come down.
const ABOVE: usize = 3;
/// Parts of the beam at whose ends shapes are given.
const STATIONS: u32 = 50;

/// What is asked of a diagram.
#[derive(Clone, Debug)]
pub struct DiagramRequest {
    /// Speeds of rotation, ascending from at least zero \[rad/s\]; further ones are inserted where a shape changes fast.
    pub speeds: Vec<f64>,
    /// Number of modes, those of the lowest frequencies at any of the speeds.
    pub count: usize,
    /// Lines ω = kΩ to cross, for k from 1 to this number.
    pub revolutions: u32,
    /// Percent of kΩ within which a frequency is near it.
    pub margin: f64,
    /// Whether the hub is free to rotate with the beam under its torques; otherwise it keeps its speed.
    pub free_hub: bool,
    /// Number of threads, 0 for one a processor; the results do not depend on it.
    pub threads: usize,
    /// Units of what is said and written.
    pub units: Units,
}

/// A diagram, with what its reader should know of it.
pub struct Diagram {
    /// What was asked.
    pub request: DiagramRequest,
    /// Frequencies, crossings, critical speeds and instabilities.
    pub campbell: Campbell,
    /// Ranges of speeds in which a frequency is near kΩ.
    pub resonances: Vec<Resonance>,
    /// Stations of the shapes along the beam \[m\].
    pub stations: Vec<f64>,
    /// Warnings.
    pub warnings: Vec<String>,
    /// Why the diagram ends early, or its errors do.
    pub incomplete: Vec<String>,
}

impl Reading {
    /// The modes of the case over speeds of steady rotation, followed by their shapes. `progress` is called with the number of speeds
    /// that are done and the work since its last call, in that of the modes at one speed, and stops by `false`: the diagram ends there.
    ///
    /// # Errors
    /// [`VibrationError`]: a case with parts that do not rotate steadily, speeds that do not ascend from zero, no modes at the first speed.
    pub fn campbell(
        &self,
        request: &DiagramRequest,
        progress: &(dyn Fn(usize, f64) -> bool + Sync),
    ) -> Result<Diagram, VibrationError> {
        self.fits_modes()?;
        let (case, units) = (&self.case, &request.units);
        let ascends = |pair: &[f64]| pair[0] < pair[1];
        let [first, .., last] = request.speeds[..] else {
            return Err(VibrationError::Request("a diagram is of at least two speeds".to_owned()));
        };
        if !(0.0 <= first && last.is_finite() && request.speeds.windows(2).all(ascends)) {
            let (from, to) = (units.speed.text(first), units.speed.text(last));
            let message = format!("speeds ascend from at least zero, but {from} is followed by {to}");
            return Err(VibrationError::Request(message));
        }
        let (system, mut warnings) = case.vibrates(true)?;
        let slender = system.slender();
        warnings.extend(case.without_trapeze(last));
        let plan = Plan {
            speeds: request.speeds.clone(),
            // Those that enter from above are among them.
            count: request.count.max((request.count + ABOVE).min(system.size().v)),
            stations: case.stations_of_shapes(STATIONS),
            hub: case.hub_state(request.free_hub)?,
            revolutions: request.revolutions,
        };
        let finer = self.with_finer_mesh().map_err(|problems| problems.reason());
        let finer = finer.and_then(|finer| finer.case.vibrates(true).map_err(|error| error.to_string()));
        let (finer, mut why) = match finer {
            Ok((finer, _)) => (Some((finer, case.safety_of_frequencies())), None),
            Err(why) => (None, Some(why)),
        };
        let stopped = AtomicBool::new(false);
        let watched = |done: usize, work: f64| {
            let goes_on = progress(done, work);
            stopped.fetch_or(!goes_on, Ordering::Relaxed);
            goes_on
        };
        let mut campbell = campbell(system, finer, &plan, request.threads, &watched)
            .map_err(|error| VibrationError::from(error).suspecting(case))?;
        keep_lowest(&mut campbell, request.count);
        if campbell.branches.is_empty() {
            warnings.push(
                "nothing vibrates at these speeds: all motions found are overdamped, they decay before they come back (ζ > 0.9962), and the diagram is \
                 empty; `flexion modes` lists their rates; is a damping in other units?"
                    .to_owned(),
            );
        }
        let failed = campbell.unestimated.as_ref().filter(|why| **why != NoCampbell::Stopped);
        why = why.or(failed.map(NoCampbell::to_string));
        warnings.extend(why.map(|why| unestimated(&why)));
        let errors = campbell.branches.iter().enumerate().flat_map(|(number, branch)| {
            branch.points.iter().map(move |point| (number + 1, point.mode.rounding))
        });
        warnings.extend(rounded(errors, slender.as_ref()));
        if let Some((branch, point, error)) = campbell.coarsest()
            && error > COARSE
        {
            warnings.push(coarse(branch + 1, Some(units.speed.short(point.speed)), error));
        }
        let incomplete = unstable(&campbell, stopped.into_inner(), units, &mut warnings);
        let resonances = resonances(&campbell, request.revolutions, request.margin / 100.0);
        let (request, stations) = (request.clone(), plan.stations);
        Ok(Diagram { request, campbell, resonances, stations, warnings, incomplete })
    }

    /// Writes a diagram of this case and publishes it.
    ///
    /// # Errors
    /// [`OutputError`] for whatever goes wrong on disk or in drawing.
    pub fn write_campbell(
        &self,
        diagram: &Diagram,
        title: Option<&str>,
        directory: &Directory,
    ) -> Result<(), OutputError> {
        let Diagram { request, campbell, resonances, stations, warnings, .. } = diagram;
        let shown = (campbell, request.revolutions, resonances.as_slice());
        write_campbell(directory, shown, &request.units, stations, &self.resolved(), title, warnings)
    }
}

/// Warns of instabilities, and returns what is missing.
fn unstable(diagram: &Campbell, stopped: bool, units: &Units, warnings: &mut Vec<String>) -> Vec<String> {
    let mut incomplete = Vec::new();
    let lost = diagram.instabilities.iter().any(|of| matches!(of, Instability::Lost { .. }));
    if stopped && !lost {
        let known = |branch: &Branch| {
            branch.points.iter().take_while(|point| point.mode.mesh.is_some()).last().map(|p| p.speed)
        };
        let until = diagram.branches.iter().filter_map(known).reduce(f64::max);
        let until =
            until.map_or("at no speed".to_owned(), |speed| format!("up to {}", units.speed.text(speed)));
        incomplete.push(format!(
            "stopped by the user: errors of the frequencies by the mesh are known {until}, the frequencies at all speeds"
        ));
    }
    let range = |from: f64, until: Option<f64>| {
        let until = until.map_or("the last speed".to_owned(), |until| units.speed.text(until));
        format!("from {} to {until}", units.speed.text(from))
    };
    for instability in &diagram.instabilities {
        match instability {
            Instability::Divergence { speed, until } => warnings.push(format!(
                "the steady rotation is unstable {}: motions diverge without vibrating",
                range(*speed, *until)
            )),
            Instability::Lost { reason, .. } => {
                incomplete.push(format!("{reason}\nWhat lies below is kept."));
            }
            Instability::Flutter { branch, from, to, until } => warnings.push(format!(
                "the damping of mode {} is negative {}; it becomes so beyond {}",
                branch + 1,
                range(*to, *until),
                units.speed.text(*from)
            )),
        }
    }
    incomplete
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
