//! Campbell diagram: the modes of a steadily turning system as functions of its speed.
//!
//! Modes are followed by their shapes, never by their order: from one speed to the next the pairs with the
//! largest assurance |xᴴ M y|² / (xᴴ M x · yᴴ M y) belong together, so that curves pass through each other where they
//! cross and bend where they veer. Where a shape changes too much between two speeds, speeds are
//! inserted until it does not.
//!
//! Speeds are cut into blocks of fixed length that threads share; within a block the equilibrium of the last speed
//! begins the next. The result does not depend on the number of threads.

use super::modes::{Mode, Modes, NoModes, modes};
use super::rotation::{NoRotation, rotate_stably};
use super::stiffness::tangent;
use super::tracking::{Tracker, match_shapes};
use crate::linalg::Matrix;
use crate::system::{State, System, Weights};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Speeds in a block.
const BLOCK: usize = 8;
/// Modes computed beyond those asked for, so that curves may cross the last one.
const SPARE: usize = 4;
/// Halvings of an interval of speed in which a shape changes too much.
const HALVINGS: u32 = 8;
/// Damping ratio below which a motion grows.
const GROWTH: f64 = -1e-9;

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Speeds [rad/s], ascending.
    pub speeds: Vec<f64>,
    /// Number of modes, the lowest at the first speed.
    pub count: usize,
    /// Stations of the shapes \[m\].
    pub stations: Vec<f64>,
    /// Whether the hub keeps its speed, or is free to turn about it.
    pub hub: HubState,
    /// Lines ω = k Ω whose crossings are looked for, from 1 to this k.
    pub revolutions: u32,
    /// Number of threads; 0 for as many as the machine has.
    pub threads: usize,
}

/// What the hub does while the beam vibrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HubState {
    /// It keeps its speed: modes of the beam on a hub of infinite inertia.
    Held,
    /// It turns with the beam, under its torques.
    Free,
}

/// A mode at a speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Speed [rad/s].
    pub speed: f64,
    /// The mode.
    pub mode: Mode,
    /// Assurance against the mode at the speed before; 1 at the first.
    pub assurance: f64,
}

/// One mode over the speeds; it ends where it leaves the modes computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Branch {
    /// The mode at each speed of the diagram.
    pub points: Vec<Point>,
}

/// A crossing of a branch with a line ω = k Ω: resonance with an excitation k times a revolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Number of the branch, from 0.
    pub branch: usize,
    /// k
    pub revolutions: u32,
    /// Speed Ω [rad/s].
    pub speed: f64,
}

/// Where motion begins to grow.
#[derive(Clone, Debug, PartialEq)]
pub enum Instability {
    /// The damping of a branch becomes negative between the two speeds [rad/s].
    Flutter {
        /// Number of the branch, from 0.
        branch: usize,
        /// Last stable speed.
        from: f64,
        /// First unstable speed.
        to: f64,
    },
    /// The stiffness is exhausted at a speed: ω = 0 there, no steady rotation beyond.
    Divergence {
        /// The critical speed [rad/s].
        speed: f64,
        /// The whole story.
        reason: String,
    },
}

/// A Campbell diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Campbell {
    /// Speeds [rad/s]: those asked for, up to a divergence, and those inserted.
    pub speeds: Vec<f64>,
    /// The modes, ascending in their frequency at the first speed.
    pub branches: Vec<Branch>,
    /// Crossings with the lines of whole revolutions.
    pub crossings: Vec<Crossing>,
    /// Instabilities.
    pub instabilities: Vec<Instability>,
}

/// Why there is no diagram.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoCampbell {
    /// The speeds make no axis.
    #[error("a Campbell diagram needs at least two ascending speeds of at least zero")]
    Speeds,
    /// The system cannot be built.
    #[error("{0}")]
    Build(String),
    /// There is no steady rotation at the first speed, or the system does not turn.
    #[error(transparent)]
    Rotation(#[from] NoRotation),
    /// The modes at a speed.
    #[error("at {speed} rad/s: {source}")]
    Modes {
        /// The speed [rad/s].
        speed: f64,
        /// Why.
        source: NoModes,
    },
    /// It was stopped.
    #[error("stopped")]
    Stopped,
}

/// Builds the system of the diagram, once a thread.
pub type Build<'a> = dyn Fn() -> Result<Box<dyn System>, String> + Sync + 'a;

/// Modes at one speed, with what the next one begins with.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    pub speed: f64,
    pub modes: Modes,
    pub mass: Matrix,
    pub equilibrium: State,
}

/// Computes the diagram. `progress` is told how many of the speeds are done, and may break off by `false`.
///
/// # Errors
/// [`NoCampbell`]. A divergence beyond the first speed is no error: the diagram ends there and says so.
pub fn campbell(
    build: &Build<'_>,
    plan: &Plan,
    progress: &(dyn Fn(usize) -> bool + Sync),
) -> Result<Campbell, NoCampbell> {
    let speeds = &plan.speeds;
    let ascending =
        speeds.windows(2).all(|w| w[0] < w[1]) && speeds.iter().all(|s| s.is_finite() && *s >= 0.0);
    if speeds.len() < 2 || !ascending {
        return Err(NoCampbell::Speeds);
    }
    let mut solved = Vec::with_capacity(speeds.len());
    let mut ended = None;
    for result in solve_all(build, plan, progress)? {
        match result {
            Ok(one) => solved.push(one),
            Err(NoCampbell::Rotation(NoRotation::DoesNotTurn)) => return Err(NoRotation::DoesNotTurn.into()),
            Err(NoCampbell::Rotation(reason)) => {
                ended = Some(reason);
                break;
            }
            Err(other) => return Err(other),
        }
    }
    match ended {
        Some(reason) if solved.is_empty() => return Err(reason.into()),
        _ => {}
    }
    let mut worker = Worker::new(build, plan)?;
    let solved = refine(&mut worker, solved)?;
    let branches = follow(&solved, plan.count);
    let crossings = crossings(&branches, plan.revolutions);
    let mut instabilities = flutter(&branches);
    if let Some(reason) = ended {
        instabilities.push(Instability::Divergence { speed: reason.reached(), reason: reason.to_string() });
    }
    Ok(Campbell { speeds: solved.iter().map(|s| s.speed).collect(), branches, crossings, instabilities })
}

/// A system of its own and its last equilibrium.
struct Worker<'a> {
    system: Box<dyn System>,
    plan: &'a Plan,
    state: State,
    speed: f64,
}

impl<'a> Worker<'a> {
    fn new(build: &Build<'_>, plan: &'a Plan) -> Result<Worker<'a>, NoCampbell> {
        let system = build().map_err(NoCampbell::Build)?;
        let state = State::zeros(system.size(), 0.0);
        Ok(Worker { system, plan, state, speed: 0.0 })
    }

    /// Begins anew from rest.
    fn rest(&mut self) {
        self.state = State::zeros(self.system.size(), 0.0);
        self.speed = 0.0;
    }

    fn solve(&mut self, speed: f64) -> Result<Solved, NoCampbell> {
        let system = self.system.as_mut();
        rotate_stably(system, &mut self.state, self.speed, speed)?;
        self.speed = speed;
        let mut state = self.state.clone();
        if self.plan.hub == HubState::Free {
            system.hold(false);
            state.v = system.initial().v;
        }
        let count = (self.plan.count + SPARE).min(system.size().v);
        let modes = modes(system, &state, count, &self.plan.stations)
            .map_err(|source| NoCampbell::Modes { speed, source })?;
        let mass = tangent(system, &state, Weights::new(1.0, 0.0, 0.0));
        system.hold(true);
        Ok(Solved { speed, modes, mass, equilibrium: self.state.clone() })
    }
}

type Results = Vec<Result<Solved, NoCampbell>>;

/// The modes at all speeds, up to the first failure in each block.
fn solve_all(
    build: &Build<'_>,
    plan: &Plan,
    progress: &(dyn Fn(usize) -> bool + Sync),
) -> Result<Results, NoCampbell> {
    let blocks: Vec<&[f64]> = plan.speeds.chunks(BLOCK).collect();
    let threads = match plan.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        n => n,
    };
    let (next, done, stop) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicBool::new(false));
    let results: Vec<Mutex<Results>> = blocks.iter().map(|_| Mutex::new(Vec::new())).collect();
    let work = || -> Result<(), NoCampbell> {
        let mut worker = Worker::new(build, plan)?;
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let (Some(block), Some(slot)) = (blocks.get(number), results.get(number)) else { return Ok(()) };
            worker.rest();
            let mut out = Vec::with_capacity(block.len());
            for &speed in *block {
                if stop.load(Ordering::Relaxed) {
                    return Err(NoCampbell::Stopped);
                }
                let result = worker.solve(speed);
                let failed = result.is_err();
                out.push(result);
                if !progress(1 + done.fetch_add(1, Ordering::Relaxed)) {
                    stop.store(true, Ordering::Relaxed);
                }
                if failed {
                    break;
                }
            }
            if let Ok(mut slot) = slot.lock() {
                *slot = out;
            }
        }
    };
    std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.min(blocks.len())).map(|_| scope.spawn(work)).collect();
        let mut outcome = work();
        for other in others {
            outcome = outcome.and(other.join().unwrap_or(Err(NoCampbell::Stopped)));
        }
        outcome
    })?;
    Ok(results.into_iter().flat_map(|slot| slot.into_inner().unwrap_or_default()).collect())
}

/// Inserts speeds where a shape changes too much from one to the next.
fn refine(worker: &mut Worker<'_>, solved: Vec<Solved>) -> Result<Vec<Solved>, NoCampbell> {
    let count = worker.plan.count;
    let mut out: Vec<Solved> = Vec::with_capacity(solved.len());
    for next in solved {
        if let Some(before) = out.last() {
            let smallest = (next.speed - before.speed) * 0.5_f64.powi(HALVINGS as i32);
            // Speeds still to be passed, the nearest last.
            let mut ahead = vec![next];
            while let (Some(from), Some(to)) = (out.last(), ahead.last()) {
                let clear = match_shapes(from, to, count).iter().all(|m| m.is_clear());
                if clear || to.speed - from.speed <= 1.5 * smallest {
                    out.extend(ahead.pop());
                } else {
                    worker.state.copy_from(&from.equilibrium);
                    worker.speed = from.speed;
                    let middle = worker.solve(0.5 * (from.speed + to.speed))?;
                    ahead.push(middle);
                }
            }
        } else {
            out.push(next);
        }
    }
    Ok(out)
}

/// The branches that begin as the lowest `count` modes.
fn follow(solved: &[Solved], count: usize) -> Vec<Branch> {
    let mut tracker = Tracker::new(solved.first(), count);
    for pair in solved.windows(2) {
        tracker.step(&pair[0], &pair[1]);
    }
    tracker.branches
}

/// Crossings with ω = k Ω, between speeds by inverse interpolation of ω − k Ω.
fn crossings(branches: &[Branch], revolutions: u32) -> Vec<Crossing> {
    let mut out = Vec::new();
    for (branch, b) in branches.iter().enumerate() {
        for k in 1..=revolutions {
            let above = |p: &Point| p.mode.frequency() - f64::from(k) * p.speed;
            for w in b.points.windows(2) {
                let (a, c) = (above(&w[0]), above(&w[1]));
                // At rest the lines all begin: a rigid motion crosses none of them there.
                if (a > 0.0) != (c > 0.0) && w[0].mode.frequency().max(w[1].mode.frequency()) > 0.0 {
                    let speed = w[0].speed + (w[1].speed - w[0].speed) * a / (a - c);
                    out.push(Crossing { branch, revolutions: k, speed });
                }
            }
        }
    }
    out.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    out
}

/// Branches whose damping becomes negative.
fn flutter(branches: &[Branch]) -> Vec<Instability> {
    let mut out = Vec::new();
    for (branch, b) in branches.iter().enumerate() {
        let grows = |p: &Point| p.mode.damping_ratio() < GROWTH;
        if let Some(first) = b.points.iter().position(grows) {
            let from = b.points[first.saturating_sub(1)].speed;
            out.push(Instability::Flutter { branch, from, to: b.points[first].speed });
        }
    }
    out
}
