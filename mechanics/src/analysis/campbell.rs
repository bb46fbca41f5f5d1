//! Campbell diagram: the modes of a steadily turning system as functions of its speed.
//!
//! Modes are followed by their shapes, never by their order: from one speed to the next the pairs with the
//! largest assurance |xᴴ M y|² / (xᴴ M x · yᴴ M y) belong together, so that curves pass through each other where they
//! cross and bend where they veer. Where a shape changes too much between two speeds, speeds are
//! inserted until it does not.
//!
//! Speeds are cut into blocks of fixed length that threads share; within a block the equilibrium and the modes of
//! the last speeds begin the next, which the inertia of the system checks.
//! The result does not depend on the number of threads.

use super::crossings::crossings;
use super::modes::{Mode, NoModes};
use super::rotation::NoRotation;
use super::tracking::{Match, Tracker, match_shapes};
use super::worker::{Solved, Worker};
use crate::system::System;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// Speeds in a block.
const BLOCK: usize = 25;
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
    /// Stations of the shapes \[m\], which the modes at the ends of a branch get.
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
    /// The stiffness is exhausted at a speed: ω = 0 there, the steady rotation beyond is unstable.
    Divergence {
        /// The critical speed [rad/s], to six digits.
        speed: f64,
        /// The whole story.
        reason: String,
    },
    /// No steady rotation was found beyond a speed.
    Lost {
        /// Speed up to which it was followed [rad/s].
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

/// Computes the diagram. `progress` is told how many of the speeds are done, and may break off by `false`.
///
/// # Errors
/// [`NoCampbell`]. A divergence, or the end of steady rotation, beyond the first speed is no error: the diagram ends there and
/// says so.
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
    let (results, mut worker) = solve_all(build, plan, progress)?;
    for result in results {
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
    worker.rest();
    let (solved, matches) = refine(&mut worker, solved)?;
    let mut branches = follow(&solved, &matches, plan.count);
    let crossings = crossings(&mut worker, &solved, &branches, plan.revolutions);
    worker.describe_ends(&solved, &mut branches);
    let mut instabilities = flutter(&branches);
    if let Some(ended) = ended {
        let (speed, reason) = (ended.reached(), ended.to_string());
        instabilities.push(match ended {
            NoRotation::Buckled { .. } => Instability::Divergence { speed, reason },
            _ => Instability::Lost { speed, reason },
        });
    }
    Ok(Campbell { speeds: solved.iter().map(|s| s.speed).collect(), branches, crossings, instabilities })
}

type Results = Vec<Result<Solved, NoCampbell>>;

/// The modes at all speeds, up to the first failure in each block, and one of those who found them.
fn solve_all<'a>(
    build: &Build<'_>,
    plan: &'a Plan,
    progress: &(dyn Fn(usize) -> bool + Sync),
) -> Result<(Results, Worker<'a>), NoCampbell> {
    let blocks: Vec<&[f64]> = plan.speeds.chunks(BLOCK).collect();
    let threads = match plan.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        n => n,
    };
    let (next, done, stop) = (AtomicUsize::new(0), AtomicUsize::new(0), AtomicBool::new(false));
    // Nothing is computed beyond a block in which the rotation ends.
    let end = AtomicUsize::new(usize::MAX);
    let results: Vec<Mutex<Results>> = blocks.iter().map(|_| Mutex::new(Vec::new())).collect();
    let work = |worker: &mut Worker<'_>| -> Result<(), NoCampbell> {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let (Some(block), Some(slot)) = (blocks.get(number), results.get(number)) else { return Ok(()) };
            if end.load(Ordering::Relaxed) < number {
                continue;
            }
            worker.rest();
            let mut out: Vec<Solved> = Vec::with_capacity(block.len());
            let mut failure = None;
            for &speed in *block {
                if stop.load(Ordering::Relaxed) {
                    return Err(NoCampbell::Stopped);
                }
                let last = &out[out.len().saturating_sub(2)..];
                let result = worker.solve(speed, last);
                if !progress(1 + done.fetch_add(1, Ordering::Relaxed)) {
                    stop.store(true, Ordering::Relaxed);
                }
                match result {
                    Ok(solved) => out.push(solved),
                    Err(why) => {
                        failure = Some(Err(why));
                        end.fetch_min(number, Ordering::Relaxed);
                        break;
                    }
                }
            }
            let out = out.into_iter().map(Ok).chain(failure).collect();
            if let Ok(mut slot) = slot.lock() {
                *slot = out;
            }
        }
    };
    let mut worker = Worker::new(build, plan)?;
    let helper = || work(&mut Worker::new(build, plan)?);
    std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads.min(blocks.len())).map(|_| scope.spawn(helper)).collect();
        let mut outcome = work(&mut worker);
        for other in others {
            outcome = outcome.and(other.join().unwrap_or(Err(NoCampbell::Stopped)));
        }
        outcome
    })?;
    let results = results.into_iter().flat_map(|slot| slot.into_inner().unwrap_or_default()).collect();
    Ok((results, worker))
}

/// Inserts speeds where a shape changes too much from one to the next; with the matches of each speed with the next.
fn refine(
    worker: &mut Worker<'_>,
    solved: Vec<Solved>,
) -> Result<(Vec<Solved>, Vec<Vec<Match>>), NoCampbell> {
    let count = worker.plan().count;
    let mut out: Vec<Solved> = Vec::with_capacity(solved.len());
    let mut all = Vec::with_capacity(solved.len());
    for next in solved {
        let Some(before) = out.last() else {
            out.push(next);
            continue;
        };
        let smallest = (next.speed - before.speed) * 0.5_f64.powi(HALVINGS as i32);
        // Speeds still to be passed, the nearest last.
        let mut ahead = vec![next];
        while let (Some(from), Some(to)) = (out.last(), ahead.last()) {
            let matches = match_shapes(from, to);
            let clear = matches.iter().take(count).all(|m| m.is_clear());
            if clear || to.speed - from.speed <= 1.5 * smallest {
                all.push(matches);
                out.extend(ahead.pop());
            } else {
                let middle = 0.5 * (from.speed + to.speed);
                worker.go_to(from);
                ahead.push(worker.solve(middle, std::slice::from_ref(from))?);
            }
        }
    }
    Ok((out, all))
}

/// The branches that begin as the lowest `count` modes.
fn follow(solved: &[Solved], matches: &[Vec<Match>], count: usize) -> Vec<Branch> {
    let mut tracker = Tracker::new(solved.first(), count);
    for (to, matches) in solved.iter().skip(1).zip(matches) {
        tracker.step(matches, to);
    }
    tracker.branches
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
