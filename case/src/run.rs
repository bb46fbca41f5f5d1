//! A case, run: from its reading to its results.

use super::restart::Restart;
use super::{Errors, Initial, Integrator as IntegratorCase, Live, Problems, Reading, resolved};
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::superposition::superpose;
use flexion::analysis::transient::{Ending, Plan, resume, transient_to_checkpoint};
use flexion::integrator::{Checkpoint, Counters, Info};
use flexion::linalg::Structure;
use flexion::system::{Dynamics, Observed, State, Steady, System};
use flexion_results::plot::trajectory_figure;
use flexion_results::{
    Artifact, Attachments, Directory, Integration, OutputError, ProblemSize, Recorder, RunReport, Shapes,
    Status, Trajectory, Watch, write_run,
};
use std::time::Instant;

/// Length over height of a beam drawn without knowing its height.
const SLENDERNESS: f64 = 50.0;

/// A case with all that its run needs, checked: what remains can only fail in time.
pub struct Prepared<'a> {
    reading: &'a Reading,
    live: Live,
    state: State,
    plan: Plan,
    tables: Vec<(Artifact, Vec<u8>)>,
    shapes: Option<Shapes>,
    /// The history of the earlier run that this one goes on with.
    history: Option<Checkpoint>,
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
    /// Time of computing of the processor \[s\], where the system tells it.
    pub cpu_time: Option<f64>,
}

impl Reading {
    /// Builds the system and brings it into its initial state.
    ///
    /// # Errors
    /// [`Problems`] at the key that is to blame, also when there is no equilibrium to begin with.
    pub fn prepare(&self) -> Result<Prepared<'_>, Problems> {
        let mut live = self.build()?;
        let case = &self.case;
        let mut state = live.system.initial();
        let mut history = None;
        if let Initial::Restart { file } = &case.initial {
            let restart = Restart::read(self, file)?;
            history = restart.begin(self, &mut state)?;
        }
        if case.initial == Initial::Static {
            let mut row = vec![0.0; live.system.channels().len()];
            live.system.record(&state, &mut row);
            let speed = live.system.channels().iter().position(|c| c.name == "hub.speed").map(|i| row[i]);
            if let Some(speed) = speed.filter(|speed| *speed != 0.0) {
                let message = format!(
                    "the hub turns at {speed} rad/s at the start, and a turning beam is not in static equilibrium: use \
                     `steady-rotation`"
                );
                return Err(self.problem("initial.kind", message));
            }
        }
        if matches!(case.initial, Initial::SteadyRotation | Initial::Static | Initial::Modes { .. }) {
            let velocity = state.v.clone();
            live.system.hold(true);
            equilibrium(live.system.as_mut(), &mut state)
                .map_err(|error| self.problem("initial", error.to_string()))?;
            live.system.hold(false);
            state.v = velocity;
        }
        if let Initial::Modes { vibrations } = &case.initial {
            let tip = ["tip.deflection", "tip.axial"];
            let place = |name| live.system.channels().iter().position(|channel| channel.name == name);
            let recorded: Vec<usize> = tip.into_iter().filter_map(place).collect();
            superpose(live.system.as_mut(), &mut state, vibrations, &recorded).map_err(|error| {
                // At the list that was written.
                let written = |key: &str| self.defaults().iter().all(|(name, _)| name != key);
                let keys = ["initial.amplitudes", "initial.velocities"];
                let key = keys.into_iter().find(|key| written(key)).unwrap_or("initial");
                self.problem(key, error.to_string())
            })?;
        }
        let (step, longest_step) = match case.integrator {
            IntegratorCase::Radau { initial_step, max_step, .. } => (initial_step, max_step),
            _ => (case.integrator.step(), None),
        };
        let plan = Plan { end: case.duration, step, longest_step, sample: case.output.step };
        let mut tables = Vec::new();
        for (key, file) in self.tables() {
            let failed = |error| self.problem(&key, format!("cannot read {}: {error}", file.display()));
            if let Some(artifact) = resolved::copy(&key) {
                tables.push((artifact, std::fs::read(&file).map_err(failed)?));
            }
        }
        Ok(Prepared { reading: self, live, state, plan, tables, shapes: self.shapes(), history })
    }

    /// Room for the shapes, if the case asks for them.
    fn shapes(&self) -> Option<Shapes> {
        let case = &self.case;
        let interval = case.output.vtk?;
        let every = (interval / case.output.step).round().max(1.0) as usize;
        let height = case.section.height().unwrap_or(case.length / SLENDERNESS);
        Some(Shapes::new(case.length, &case.output.stations, height, every))
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
            counters: run.counters,
            size: run.size,
            wall_time: run.wall_time,
            cpu_time: run.cpu_time,
        };
        let identity = self.identity();
        let title = (!self.case.title.is_empty()).then_some(self.case.title.as_str());
        let figure = trajectory_figure(&run.trajectory, title);
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

impl Prepared<'_> {
    /// The case.
    pub fn reading(&self) -> &Reading {
        self.reading
    }

    /// Integrates to the end, or to where `watch` stops it or the integration fails: what was computed
    /// until then is in the run.
    pub fn run(self, watch: &mut Watch<'_>) -> Run {
        let Prepared { reading, live, mut state, plan, tables, shapes, history } = self;
        let books = reading.case.output.energy_balance;
        let Live { mut system, mut integrator } = live;
        let (start, cpu_start) = (Instant::now(), processor_time());
        let mut recorder = Recorder::new(system.as_ref(), &plan, books, watch).with_shapes(shapes);
        let parts = (system.as_mut(), integrator.as_mut());
        let (ending, checkpoint) = match &history {
            None => transient_to_checkpoint(parts.0, parts.1, &mut state, &plan, &mut recorder),
            Some(history) => resume(parts.0, parts.1, history, &mut state, &plan, &mut recorder)
                .unwrap_or_else(|error| (Ending::Failed(error.into()), history.clone())),
        };
        let wall_time = start.elapsed().as_secs_f64();
        let cpu_time = processor_time().zip(cpu_start).map(|(end, start)| end - start);
        let warning = recorder.warning();
        let (trajectory, mut shapes) = recorder.into_parts();
        let mut warnings = system.cautions(&trajectory.peaks());
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

/// Processor time of this thread [s].
#[cfg(unix)]
fn processor_time() -> Option<f64> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
}

/// Unknown on this system.
#[cfg(not(unix))]
fn processor_time() -> Option<f64> {
    None
}

fn size(system: &dyn System) -> ProblemSize {
    let unknowns = system.size().v + system.size().lambda;
    let structure = system.structure(0);
    let border = if let Structure::Band { border, .. } = structure { border } else { 0 };
    ProblemSize { unknowns, half_bandwidth: structure.half_bandwidth(), border }
}
