//! A case, run: from its reading to its results.

pub mod advise;
pub(crate) mod calculation;
pub(crate) mod cautions;
pub(crate) mod clock;
mod contact;
pub(crate) mod error;
mod files;
mod plane;
pub(crate) mod quantity;
pub mod refine;
mod restart;
mod scene;
pub(crate) mod variant;

use super::case::{Output, suspected};
use super::kinds::initial::Initial;
use super::problem::Problems;
use super::reading::{Live, Reading};
use super::values::Value;
use clock::Clock;
use flexion::analysis::equilibrium::stable_equilibrium;
use flexion::analysis::error::Refinable;
use flexion::analysis::periodic::{NoPeriodicMotion, circulate};
use flexion::analysis::recording::{Columns, Record, Recorder, Watch};
use flexion::analysis::superposition::superpose;
use flexion::analysis::transient::{Ending, Plan, resumable, resume, transient_to_checkpoint};
use flexion::integrator::{Checkpoint, Info};
use flexion::system::{Channel, State, System};
use flexion_results::{Artifact, Errors, ProblemSize, Scene, Shapes, Status};
use plane::Plane;
use std::f64::consts::TAU;
use std::ops::{ControlFlow, Deref};

/// Most memory for records [bytes], and columns that every run may have.
const MOST_BYTES: f64 = 4e9;
const COMMON: usize = 12;

/// A case with all that its run needs, checked: what remains can only fail in time.
pub struct Prepared {
    live: Live,
    state: State,
    plan: Plan,
    energy_balance: bool,
    modal_shares: bool,
    tables: Vec<(Artifact, Vec<u8>)>,
    shapes: Option<Shapes>,
    scene: Scene,
    /// The history of the earlier run that this one goes on with.
    history: Option<Checkpoint>,
    /// What its reader should know about the model before it runs.
    warnings: Vec<String>,
    /// What the beam bears at its contacts.
    limits: Vec<contact::Limit>,
    /// Whether its planar beams stay in their plane.
    plane: Plane,
    /// Time that this took \[s\], and that of the processor.
    taken: (f64, Option<f64>),
    /// Who is shown the records.
    shown: Option<Shown>,
}

/// Is shown the time \[s\] of a record, and the values of the system's own columns, which are the first.
pub type Shown = Box<dyn FnMut(f64, &[f64])>;

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Run {
    /// How it ended.
    pub status: Status,
    /// Why it ended early, or before the accuracy that was asked.
    pub message: Option<String>,
    /// What it recorded, and its last state.
    pub record: Record,
    /// The shapes of the beam, if the case asks for them.
    pub shapes: Option<Shapes>,
    /// Its motion in space, at some of the recorded times.
    pub scene: Scene,
    /// The tables that the case names, byte for byte, under their names among the results.
    pub tables: Vec<(Artifact, Vec<u8>)>,
    /// The last accepted step with all that a run needs to go on from it.
    pub checkpoint: Checkpoint,
    /// Estimated errors, once someone has [estimated them](Reading::estimate_errors).
    pub errors: Option<Errors>,
    /// What its reader should know about the validity of the model.
    pub warnings: Vec<String>,
    /// The integrator.
    pub info: Info,
    /// Size of the equations solved in each iteration.
    pub size: ProblemSize,
    /// Time of computing, preparation included \[s\]. Times are the figures that differ from run to run.
    pub wall_time: f64,
    /// Time of computing of the processor \[s\], where the system gives it.
    pub cpu_time: Option<f64>,
    /// The part of both that preparation took \[s\].
    pub preparation: (f64, Option<f64>),
}

/// A run is its record, and more.
impl Deref for Run {
    type Target = Record;

    fn deref(&self) -> &Record {
        &self.record
    }
}

impl AsRef<Record> for Run {
    fn as_ref(&self) -> &Record {
        &self.record
    }
}

impl From<Run> for Record {
    fn from(run: Run) -> Record {
        run.record
    }
}

impl Run {
    /// The estimated error of a column at every record, S |y − y_f| with the finer run; NaN where that has ended, `None` where none is known.
    pub fn error_in_time(&self, column: usize) -> Option<Vec<f64>> {
        let errors = self.errors.as_ref().filter(|errors| !errors.finer.is_empty())?;
        let finer = &errors.finer;
        let (of, name) = (&self.record.trajectory, &self.record.trajectory.channels().get(column)?.name);
        let (theirs, end) = (finer.index(name)?, finer.times().last().copied()?);
        let off = |(t, y): (&f64, f64)| {
            let there = finer.at(theirs, *t).filter(|_| *t <= end);
            there.map_or(f64::NAN, |other| errors.safety * (y - other).abs())
        };
        Some(of.times().iter().zip(of.values(column)).map(off).collect())
    }

    /// What its reader should know: of the model, of its steps and of its errors.
    pub fn all_warnings(&self) -> impl Iterator<Item = &str> {
        let estimates = self.errors.iter().flat_map(|errors| &errors.warnings);
        self.warnings.iter().chain(estimates).map(String::as_str)
    }
}

impl Reading {
    /// Builds the system and brings it into its initial state.
    ///
    /// # Errors
    /// [`Problems`] at the key that is to blame, also when there is no equilibrium to begin with.
    pub fn prepare(&self) -> Result<Prepared, Problems> {
        self.prepare_watched(&mut |_| ControlFlow::Continue(()))
    }

    /// As [`Reading::prepare`]; `watch` is shown the load factors at which an equilibrium is looked for, at first the levels of the whole loads
    /// and then the path to a stable one, and ends the search by `Break`.
    ///
    /// # Errors
    /// As [`Reading::prepare`], and where the search was ended.
    pub fn prepare_watched(
        &self,
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Prepared, Problems> {
        let clock = Clock::start();
        self.missing_for_run()?;
        let mut live = self.build()?;
        let mut state = live.system.initial();
        let (history, unstable) =
            self.begin(live.system.as_mut(), &mut state, watch).map_err(|mut problems| {
                if let (Some(problem), Some(caution)) =
                    (problems.list.first_mut(), suspected(&self.case.cautions))
                {
                    problem.help.push(caution);
                }
                problems
            })?;
        if history.is_none() {
            self.check_contacts(live.system.as_mut(), &state)?;
        }
        let mut warnings = self.case.unused_by_run();
        warnings.extend(self.effective_masses(live.system.as_mut(), &state));
        warnings.extend(unstable);
        let case = &self.case;
        warnings.extend(cautions::struck(live.system.as_ref(), case.damping_of_stiffness(), case.duration));
        let stabilized = self.values.inner("integrator").and_then(|of| of.get("stabilized"));
        if stabilized.is_some_and(|of| matches!(of.value, Value::Boolean(false))) {
            warnings.extend(cautions::positions_only(live.system.as_ref()));
        }
        if let Some(step) = case.steps.step() {
            warnings.extend(cautions::unseen(live.system.as_ref(), step, case.duration));
        }
        self.check_memory(live.system.as_mut())?;
        let plan = self.variant().plan;
        if let Some(history) = &history {
            let parts = (live.system.as_mut(), live.integrator.as_ref());
            resumable(parts.0, parts.1, history, &state, &plan, case.output.energy_balance)
                .map_err(|error| self.problem("initial.file", error.to_string()))?;
        }
        let (tables, plane) = (self.copies(), Plane::new(&self.case, live.system.as_mut()));
        let Output { energy_balance, modal_shares, .. } = case.output;
        let (shapes, scene) = (self.shapes(), self.case.scene());
        Ok(Prepared {
            live,
            state,
            plan,
            energy_balance,
            modal_shares,
            tables,
            shapes,
            scene,
            history,
            warnings,
            limits: self.limits(),
            plane,
            taken: clock.elapsed(),
            shown: None,
        })
    }

    /// Whether the records fit into memory.
    fn check_memory(&self, system: &mut dyn System) -> Result<(), Problems> {
        let records = self.case.duration / self.case.output.step + 2.0;
        let columns = system.channels().len() + COMMON;
        let bytes = 8.0 * records * columns as f64;
        if bytes <= MOST_BYTES {
            return Ok(());
        }
        let message = format!(
            "{records:.1e} records of {columns} columns take {:.1} GB of memory, and at most {:.0} GB are taken: record less often, \
             or at fewer stations",
            1e-9 * bytes,
            1e-9 * MOST_BYTES
        );
        Err(self.problem("output.step", message))
    }

    /// Brings the undeformed `state` into the initial state of the case. Returns the history of an earlier run to go on
    /// with, and a warning of an equilibrium that is unstable.
    fn begin(
        &self,
        system: &mut dyn System,
        state: &mut State,
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(Option<Checkpoint>, Option<String>), Problems> {
        let mut warning = None;
        match &self.case.initial {
            Initial::Undeformed => {}
            Initial::Restart(earlier) => return Ok((restart::begin(earlier, self, state)?, None)),
            Initial::SteadyRotation => {
                match self.case.space().filter(|_| state.v.iter().any(|v| *v != 0.0)) {
                    Some(space) => {
                        let rotation = space.rotation.as_ref().map_err(Clone::clone);
                        let turning =
                            rotation.and_then(|rotation| rotation.turning(space.multibody.model(), state));
                        let (turning, unsteady) = turning.map_err(|why| self.problem("initial.kind", why))?;
                        warning = unsteady;
                        // States of laws stand behind those of the model.
                        state.q[..turning.q.len()].copy_from_slice(&turning.q);
                        state.v[..turning.v.len()].copy_from_slice(&turning.v);
                    }
                    None => warning = self.turning(system, state, watch)?,
                }
            }
            Initial::Static => {
                self.at_rest(&state.v, "initial.kind", "use `steady-rotation`")?;
                warning = self.equilibrium(system, state, watch)?;
            }
            Initial::Modes(vibrations) => {
                warning = self.equilibrium(system, state, watch)?;
                superpose(system, state, vibrations, self.case.size()).map_err(|error| {
                    // At the list that was written.
                    let defaults = self.defaults();
                    let written = |key: &&str| defaults.iter().all(|(name, _)| name != key);
                    let key = ["initial.amplitudes", "initial.velocities"].into_iter().find(written);
                    self.problem(key.unwrap_or("initial"), error.to_string())
                })?;
            }
        }
        Ok((None, warning))
    }

    /// Refuses what moves at the start with the velocities `v`, at a key and with what to do.
    pub(super) fn at_rest(&self, v: &[f64], key: &str, advice: &str) -> Result<(), Problems> {
        let speed = self.case.hub_beam().map_or(0.0, |beam| beam.hub.speed_at_start());
        if speed != 0.0 {
            let message = format!(
                "the hub rotates at {speed} rad/s at the start, and a rotating beam is not in static equilibrium: {advice}"
            );
            return Err(self.problem(key, message));
        }
        if self.case.space().is_some() && v.iter().any(|v| *v != 0.0) {
            let message = "the parts move at the start, and what moves is not in static equilibrium: take away \
                           `velocity`, `spin` and prescribed speeds at t = 0";
            return Err(self.problem(key, message));
        }
        Ok(())
    }

    /// Brings the state of a beam on a hub into steady rotation, under loads of a fixed direction in their periodic motion. Returns
    /// what is to be said of these, or of the equilibrium.
    fn turning(
        &self,
        system: &mut dyn System,
        state: &mut State,
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Option<String>, Problems> {
        let speed = self.case.hub_beam().map_or(0.0, |beam| beam.hub.speed_at_start());
        let (mut mean, what) = self.case.vibrating(speed != 0.0).map_err(|faults| self.problems(faults))?;
        if what.is_empty() {
            return self.equilibrium(system, state, watch);
        }
        let mut at = mean.initial();
        let turned = self.equilibrium(mean.as_mut(), &mut at, watch);
        let revolution = TAU / speed.abs();
        let periodic = match turned {
            Ok(None) if self.case.hub_beam().is_some_and(|beam| beam.load_changes(revolution)) => {
                Err(NoPeriodicMotion::Changing)
            }
            // Laws have states.
            Ok(None) if mean.size() != system.size() => Err(NoPeriodicMotion::Changing),
            // Contacts may be closed.
            Ok(None) if !self.case.has_contacts() => {
                mean.hold(true);
                system.hold(true);
                let found = circulate([mean.as_mut(), system], &mut at, speed);
                system.hold(false);
                found
            }
            _ => Err(NoPeriodicMotion::Far),
        };
        let said = cautions::unsteady(&what.join(" and "), &periodic);
        if periodic.is_err() {
            return Ok(self.equilibrium(system, state, watch)?.or(Some(said)));
        }
        state.q[..at.q.len()].copy_from_slice(&at.q);
        state.v[..at.v.len()].copy_from_slice(&at.v);
        Ok(Some(said))
    }

    /// Brings `state` into the equilibrium at the speed that the hub has. Returns a warning of one that is unstable, or that
    /// growing loads alone do not lead to.
    fn equilibrium(
        &self,
        system: &mut dyn System,
        state: &mut State,
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Option<String>, Problems> {
        let velocity = state.v.clone();
        system.hold(true);
        let found = stable_equilibrium(system, state, watch)
            .map_err(|error| self.problem("initial", error.to_string()))?;
        system.hold(false);
        state.v = velocity;
        Ok(match (found.stability, found.left) {
            (Some(now), _) if !now.is_stable() => Some(format!(
                "the equilibrium at the start is {now}: the smallest disturbance leads away from it, and the path of growing \
                 loads leads to none that is stable; `flexion statics` shows the path"
            )),
            (Some(_), Some(left)) => Some(format!(
                "growing loads alone lead to an equilibrium that is {left}; the run begins in the first stable one on the path \
                 of the loads, which `flexion statics` shows"
            )),
            (None, _) => Some("the stability of the equilibrium at the start was not found".to_owned()),
            _ if found.neutral => Some(
                "the equilibrium at the start is one of many, for some motion has no stiffness (`flexion modes` shows it with the \
                 frequency zero): the one near the parts as they are written was taken"
                    .to_owned(),
            ),
            _ => None,
        })
    }

    /// Room for the shapes, if the case asks for them.
    fn shapes(&self) -> Option<Shapes> {
        let case = &self.case;
        let interval = case.output.vtk?;
        let every = (interval / case.output.step).round().max(1.0) as usize;
        let beam = case.hub_beam()?;
        let shapes = Shapes::new(beam.length, &case.output.stations, beam.height(), every);
        Some(shapes.with_obstacles(beam.drawn()))
    }
}

impl Prepared {
    /// What its reader should know about the model before it runs.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// The columns that the run will record.
    pub fn channels(&mut self) -> Vec<Channel> {
        let columns = Columns { energy_balance: self.energy_balance, modal_shares: self.modal_shares };
        let recorder = Recorder::new(self.live.system.as_mut(), &self.state, &self.plan, columns);
        recorder.channels().to_vec()
    }

    /// The same that shows its records while it runs; they are computed once more for that.
    pub fn with_shown(self, shown: Shown) -> Prepared {
        Prepared { shown: Some(shown), ..self }
    }

    /// The same without shapes and scene, for those who look at the columns alone.
    pub fn without_pictures(self) -> Prepared {
        Prepared { shapes: None, scene: Scene::default(), ..self }
    }

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
            mut shapes,
            mut scene,
            history,
            mut warnings,
            limits,
            mut plane,
            taken,
            mut shown,
        } = self;
        let Live { mut system, integrator } = live;
        let clock = Clock::start();
        let mut row = Vec::new();
        let mut pictures = |system: &mut dyn System, state: &State| {
            shapes.iter_mut().for_each(|shapes| shapes.sample(system, state));
            scene.sample(system, state);
            plane.look(system, state);
            if let Some(shown) = &mut shown {
                row.resize(system.channels().len(), 0.0);
                system.record(state, &mut row);
                shown(state.t, &row);
            }
        };
        let columns = Columns { energy_balance, modal_shares };
        let mut recorder = Recorder::new(system.as_mut(), &state, &plan, columns)
            .with_watch(watch)
            .with_sampled(&mut pictures);
        let parts = (system.as_mut(), integrator.as_ref());
        let (ending, checkpoint) = match &history {
            None => transient_to_checkpoint(parts.0, parts.1, &mut state, &plan, &mut recorder),
            Some(history) => resume(parts.0, parts.1, history, &mut state, &plan, &mut recorder)
                .unwrap_or_else(|error| (Ending::Failed(error.into()), history.clone())),
        };
        let (wall_time, cpu_time) = clock.elapsed();
        let (wall_time, cpu_time) =
            (wall_time + taken.0, cpu_time.zip(taken.1).map(|(run, before)| run + before));
        let counters = checkpoint.counters().unwrap_or_default();
        let record = recorder.into_record(system.as_mut(), state, counters, ending);
        warnings.extend(system.cautions(&record.trajectory.peaks()));
        warnings.extend(plane.warning());
        warnings.extend(contact::overloaded(&limits, &record.trajectory));
        warnings.extend(record.warnings.iter().map(|warning| cautions::of_run(warning, plan.step.is_some())));
        scene.draw(system.as_mut());
        if let Ending::Finished = record.ending {
            shapes.iter_mut().for_each(|shapes| shapes.finish(system.as_mut(), &record.state));
            scene.finish(system.as_mut(), &record.state);
        }
        let (status, message) = match &record.ending {
            Ending::Finished => (Status::Finished, None),
            Ending::Stopped => {
                (Status::Stopped, Some(format!("stopped by the user at t = {:.6} s", record.state.t)))
            }
            Ending::Failed(error) => (Status::Failed, Some(error.to_string())),
        };
        Run {
            status,
            message,
            record,
            shapes,
            scene,
            tables,
            warnings,
            info: integrator.info().clone(),
            size: size(system.as_ref()),
            checkpoint,
            errors: None,
            wall_time,
            cpu_time,
            preparation: taken,
        }
    }
}

fn size(system: &dyn System) -> ProblemSize {
    let unknowns = system.size().v + system.size().lambda;
    let structure = system.structure(0);
    ProblemSize { unknowns, half_bandwidth: structure.half_bandwidth(), border: structure.border() }
}
