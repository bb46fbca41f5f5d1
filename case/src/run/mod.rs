//! A case, run: from its reading to its results.

mod clock;
mod contact;
pub mod error;
pub mod errors;
mod restart;
mod trust;

use super::case::Output;
use super::kinds::contact::Contact;
use super::kinds::initial::Initial;
use super::kinds::integrator::Steps;
use super::problem::Problems;
use super::reading::{Live, Reading};
use super::resolved;
use clock::Clock;
use errors::Errors;
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::superposition::superpose;
use flexion::analysis::transient::{Ending, Plan, resume, transient_to_checkpoint};
use flexion::hub_beam::{Drive, Mount};
use flexion::integrator::{Checkpoint, Counters, Info};
use flexion::system::{State, System};
use flexion_results::plot::{contact_figure, trajectory_figure};
use flexion_results::{
    Artifact, Attachments, Directory, Drawn, Events, Integration, OutputError, ProblemSize, Recorder,
    RunReport, Shapes, Status, Trajectory, Watch, write_run,
};
use std::sync::Arc;

/// Length over height of a beam drawn without knowing its height.
const SLENDERNESS: f64 = 50.0;

/// A case with all that its run needs, checked: what remains can only fail in time.
pub struct Prepared {
    live: Live,
    state: State,
    plan: Plan,
    energy_balance: bool,
    modal_shares: bool,
    tables: Vec<(Artifact, Vec<u8>)>,
    shapes: Option<Shapes>,
    /// The history of the earlier run that this one goes on with.
    history: Option<Checkpoint>,
    /// What its reader should know about the model before it runs.
    warnings: Vec<String>,
}

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Run {
    /// How it ended.
    pub status: Status,
    /// Why it ended early.
    pub message: Option<String>,
    /// What it recorded.
    pub trajectory: Trajectory,
    /// The shapes of the beam, if the case asks for them.
    pub shapes: Option<Shapes>,
    /// What happened at its contacts.
    pub events: Events,
    /// The tables that the case names, byte for byte, under their names among the results.
    pub tables: Vec<(Artifact, Vec<u8>)>,
    /// The last accepted step.
    pub state: State,
    /// The same with all that a run needs to go on from it.
    pub checkpoint: Checkpoint,
    /// Estimated errors, once someone has [estimated them](Reading::estimate_errors).
    pub errors: Option<Errors>,
    /// What its reader should know about the validity of the model.
    pub warnings: Vec<String>,
    /// The integrator.
    pub info: Info,
    /// Work done.
    pub counters: Counters,
    /// Size of the equations solved in each iteration.
    pub size: ProblemSize,
    /// Time of computing \[s\]. It and `cpu_time` are the figures that differ from run to run.
    pub wall_time: f64,
    /// Time of computing of the processor \[s\], where the system gives it.
    pub cpu_time: Option<f64>,
}

impl Reading {
    /// Builds the system and brings it into its initial state.
    ///
    /// # Errors
    /// [`Problems`] at the key that is to blame, also when there is no equilibrium to begin with.
    pub fn prepare(&self) -> Result<Prepared, Problems> {
        let mut live = self.build()?;
        let mut state = live.system.initial();
        let history = self.begin(live.system.as_mut(), &mut state)?;
        if history.is_none() {
            self.check_contacts(live.system.as_mut(), &state)?;
        }
        let warnings = self.effective_masses(live.system.as_mut(), &state);
        let case = &self.case;
        let (step, longest_step, contact_step) = match case.steps {
            Steps::Fixed { step, contact } => (Some(step), None, contact),
            Steps::Controlled { first, longest, .. } => (first, longest, None),
        };
        let plan = Plan { end: case.duration, step, longest_step, contact_step, sample: case.output.step };
        let copy = |(key, bytes): (String, &[u8])| Some((resolved::copy(&key)?, bytes.to_vec()));
        let tables = self.tables().into_iter().filter_map(copy).collect();
        let Output { energy_balance, modal_shares, .. } = case.output;
        let shapes = self.shapes();
        Ok(Prepared { live, state, plan, energy_balance, modal_shares, tables, shapes, history, warnings })
    }

    /// Brings the undeformed `state` into the initial state of the case. Returns the history of an earlier run to go on
    /// with.
    fn begin(&self, system: &mut dyn System, state: &mut State) -> Result<Option<Checkpoint>, Problems> {
        match &self.case.initial {
            Initial::Undeformed => {}
            Initial::Restart(earlier) => return restart::begin(earlier, self, state),
            Initial::SteadyRotation => self.equilibrium(system, state)?,
            Initial::Static => {
                let speed = match &self.case.hub.drive {
                    Drive::Prescribed(motion) => motion.at(0.0).speed,
                    Drive::Free(hub) => hub.speed,
                };
                if speed != 0.0 {
                    let message = format!(
                        "the hub rotates at {speed} rad/s at the start, and a rotating beam is not in static equilibrium: use \
                         `steady-rotation`"
                    );
                    return Err(self.problem("initial.kind", message));
                }
                self.equilibrium(system, state)?;
            }
            Initial::Modes(vibrations) => {
                self.equilibrium(system, state)?;
                superpose(system, state, vibrations, self.case.length).map_err(|error| {
                    // At the list that was written.
                    let defaults = self.defaults();
                    let written = |key: &&str| defaults.iter().all(|(name, _)| name != key);
                    let key = ["initial.amplitudes", "initial.velocities"].into_iter().find(written);
                    self.problem(key.unwrap_or("initial"), error.to_string())
                })?;
            }
        }
        Ok(None)
    }

    /// Brings `state` into the equilibrium at the speed that the hub has.
    fn equilibrium(&self, system: &mut dyn System, state: &mut State) -> Result<(), Problems> {
        let velocity = state.v.clone();
        system.hold(true);
        equilibrium(system, state).map_err(|error| self.problem("initial", error.to_string()))?;
        system.hold(false);
        state.v = velocity;
        Ok(())
    }

    /// Room for the shapes, if the case asks for them.
    fn shapes(&self) -> Option<Shapes> {
        let case = &self.case;
        let interval = case.output.vtk?;
        let every = (interval / case.output.step).round().max(1.0) as usize;
        let height = case.section.height.unwrap_or(case.length / SLENDERNESS);
        let drawn = |contact: &Contact| Drawn {
            station: contact.stations.last().copied().unwrap_or(case.length),
            on_hub: contact.mount == Mount::Hub,
            obstacle: Arc::clone(&contact.obstacle),
        };
        let shapes = Shapes::new(case.length, &case.output.stations, height, every);
        Some(shapes.with_obstacles(case.contacts.iter().map(drawn).collect()))
    }

    /// Writes the results of a run of this case and publishes them.
    ///
    /// # Errors
    /// [`OutputError`] for whatever goes wrong on disk or in drawing.
    pub fn write(&self, run: &Run, directory: &Directory) -> Result<Status, OutputError> {
        let file = self.file.file_name().map(|name| name.to_string_lossy());
        let estimated = run.errors.iter().flat_map(|errors| &errors.columns);
        let errors: Vec<_> = estimated.map(|e| (e.column.clone(), e.discretization, e.model)).collect();
        let report = RunReport {
            status: run.status,
            message: run.message.as_deref(),
            title: &self.case.title,
            file: file.as_deref(),
            duration: self.case.duration,
            end_time: run.state.t,
            warnings: &run.warnings,
            integrator: Integration { info: &run.info, settings: self.settings("integrator") },
            errors: &errors,
            events: (!run.events.is_empty()).then_some(&run.events),
            counters: run.counters,
            size: run.size,
            wall_time: run.wall_time,
            cpu_time: run.cpu_time,
        };
        let identity = self.identity();
        let title = (!self.case.title.is_empty()).then_some(self.case.title.as_str());
        let figure = match &run.events {
            events if events.is_empty() => trajectory_figure(&run.trajectory, title),
            events => contact_figure(&run.trajectory, events, title),
        };
        let attachments = Attachments {
            figure: Some(&figure),
            tables: &run.tables,
            state: Some((&run.checkpoint, &identity)),
            shapes: run.shapes.as_ref(),
        };
        let case = self.resolved_with_copies();
        write_run(directory, &report, &run.trajectory, &case, attachments)
    }
}

impl Prepared {
    /// Integrates to the end, or to where `watch` stops it or the integration fails: what was computed
    /// until then is in the run.
    pub fn run(self, watch: &mut Watch<'_>) -> Run {
        let Prepared {
            live,
            mut state,
            plan,
            energy_balance,
            modal_shares,
            tables,
            shapes,
            history,
            mut warnings,
        } = self;
        let Live { mut system, mut integrator } = live;
        let clock = Clock::start();
        let mut recorder =
            Recorder::new(system.as_mut(), &state, &plan, [energy_balance, modal_shares], watch)
                .with_shapes(shapes);
        let parts = (system.as_mut(), integrator.as_mut());
        let (ending, checkpoint) = match &history {
            None => transient_to_checkpoint(parts.0, parts.1, &mut state, &plan, &mut recorder),
            Some(history) => resume(parts.0, parts.1, history, &mut state, &plan, &mut recorder)
                .unwrap_or_else(|error| (Ending::Failed(error.into()), history.clone())),
        };
        let (wall_time, cpu_time) = clock.elapsed();
        let warning = recorder.warning();
        let (trajectory, mut shapes, events) = recorder.into_parts();
        warnings.extend(system.cautions(&trajectory.peaks()));
        warnings.extend(warning);
        if let (Ending::Finished, Some(shapes)) = (&ending, &mut shapes) {
            shapes.finish(system.as_mut(), &state);
        }
        let (status, message) = match ending {
            Ending::Finished => (Status::Finished, None),
            Ending::Stopped => {
                (Status::Stopped, Some(format!("stopped by the user at t = {:.6} s", state.t)))
            }
            Ending::Failed(error) => (Status::Failed, Some(error.to_string())),
        };
        Run {
            status,
            message,
            trajectory,
            shapes,
            events,
            tables,
            warnings,
            info: integrator.info().clone(),
            counters: integrator.counters(),
            size: size(system.as_ref()),
            state,
            checkpoint,
            errors: None,
            wall_time,
            cpu_time,
        }
    }
}

fn size(system: &dyn System) -> ProblemSize {
    let unknowns = system.size().v + system.size().lambda;
    let structure = system.structure(0);
    ProblemSize { unknowns, half_bandwidth: structure.half_bandwidth(), border: structure.border() }
}
