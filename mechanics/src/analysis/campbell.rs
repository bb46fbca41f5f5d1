//! Campbell diagram: the modes of a steadily rotating system as functions of its speed.
//!
//! Modes are joined by their shapes, never by their order: from one speed to the next the pairs with the
//! largest assurance |xᴴ M y|² / (xᴴ M x · yᴴ M y), or its like with gyroscopic forces, belong together, so that curves pass through each other where they
//! cross and bend where they veer. Where a shape changes too much between two speeds, speeds are
//! inserted until it does not; where modes change their order, until the interval is 1/8192 of the range: what veers there is
//! then seen to veer, whatever the speeds asked for.
//!
//! The stiffness of a critical speed is singular: K x = 0 in the rotating frame is a forward whirl with the rotation, 1Ω in the frame of
//! the ground. The diagram goes on through unstable ranges and names them.
//!
//! Speeds are cut into [blocks](Speeds::block) of fixed length, each of which begins at rest and may be computed by a system
//! of its own, in parallel; within a block the equilibrium and the modes of the last speed begin the next.

use super::crossings::crossings;
use super::degenerate::align;
pub use super::diagram::{
    Branch, Campbell, Critical, Crossing, HubState, Instability, NoCampbell, Plan, Point,
};
pub use super::resonance::{Resonance, resonances};
use super::rotation::NoRotation;
use super::solved::Solved;
pub use super::speeds::{Block, Speeds};
use super::tracking::{Match, Tracker, changes_order, crossing, match_shapes};
use crate::system::System;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Relative distance of critical speeds that count as one.
const ONE: f64 = 1e-5;
/// Halvings of an interval of speed in which a shape changes too much.
const HALVINGS: u32 = 8;
/// Interval of speed, over the range, in which modes that change their order cross: in a wider one they may veer.
const CROSSING: f64 = 1.0 / 8192.0;
/// Part of that interval on either side of the place at which a change of order is expected.
const SIDE: f64 = 0.4;
/// Speeds that are inserted between two by such an expectation, before intervals are halved.
const EXPECTED: u32 = 8;

/// Computes the diagram of a system. `progress` is called with the number of speeds that are done, and stops by `false`; while the
/// equilibrium at a speed is searched by more than one level of the loads it is called with the same number again.
///
/// # Errors
/// [`NoCampbell`]. Instability is no error. Neither is the end of steady rotation, or a stop, beyond the first speed: the diagram ends there
/// and says so.
pub fn campbell(
    system: Box<dyn System>,
    plan: &Plan,
    progress: impl Fn(usize) -> bool + Sync,
) -> Result<Campbell, NoCampbell> {
    let done = AtomicUsize::new(0);
    let next = |solved: usize| progress(solved + done.fetch_add(solved, Ordering::Relaxed));
    let again = || next(0);
    let mut speeds = Speeds::new(system, plan, &again)?;
    let mut blocks = Vec::new();
    for number in 0..Speeds::blocks(plan) {
        let block = speeds.block(number, || next(1));
        let ends = block.ends();
        blocks.push(block);
        if ends {
            break;
        }
    }
    assemble(&mut speeds, blocks, again)
}

/// The diagram of the blocks in their order, up to the first that ends; `system` computes what is needed in between. `progress` is called before each
/// speed that is inserted, and stops by `false`: the diagram ends there.
///
/// # Errors
/// As [`campbell`].
pub fn assemble(
    system: &mut Speeds<'_>,
    blocks: Vec<Block>,
    mut progress: impl FnMut() -> bool,
) -> Result<Campbell, NoCampbell> {
    let plan = system.plan();
    let mut solved = Vec::with_capacity(plan.speeds.len());
    let mut ended = None;
    for block in blocks {
        solved.extend(block.solved);
        match block.failure {
            None => continue,
            Some(NoCampbell::Rotation(NoRotation::DoesNotTurn)) => return Err(NoRotation::DoesNotTurn.into()),
            Some(failure) if solved.is_empty() => return Err(failure),
            Some(failure @ (NoCampbell::Rotation(_) | NoCampbell::Modes { .. } | NoCampbell::Stopped)) => {
                ended = Some(failure);
            }
            Some(failure) => return Err(failure),
        }
        break;
    }
    system.rest();
    let Refined { solved, matches, stopped } = refine(system, solved, &mut progress)?;
    if stopped {
        ended = Some(NoCampbell::Stopped);
    }
    let Tracker { mut branches, .. } = join(&solved, &matches, plan.count);
    let crossings = crossings(system, &solved, &branches, plan.revolutions);
    system.describe(&solved, &mut branches);
    let criticals = criticals(system, &solved);
    let mut instabilities = divergence(system, &solved);
    instabilities.extend(flutter(&branches));
    if let (Some(ended), Some(last)) = (ended, solved.last()) {
        instabilities.push(Instability::Lost { speed: last.speed, reason: ended.to_string() });
    }
    let speeds = solved.iter().map(|s| s.speed).collect();
    Ok(Campbell { speeds, branches, crossings, criticals, instabilities, unestimated: None })
}

/// Speeds at which directions of the stiffness change their sign.
fn criticals(system: &mut Speeds<'_>, solved: &[Solved]) -> Vec<Critical> {
    let mut out: Vec<Critical> = Vec::new();
    for pair in solved.windows(2) {
        for (speed, [below, above]) in system.changes([&pair[0], &pair[1]], |_, negative| negative) {
            let directions = below.abs_diff(above);
            // Rounding parts the two directions of a round shaft.
            match out.last_mut().filter(|last| speed - last.speed <= ONE * speed) {
                Some(last) => last.directions += directions,
                None => out.push(Critical { speed, directions }),
            }
        }
    }
    out
}

/// Ranges of speed in which motions leave the steady rotation without vibrating.
fn divergence(system: &mut Speeds<'_>, solved: &[Solved]) -> Vec<Instability> {
    let diverges = |s: &Solved| s.stability.divergent > 0;
    let first = solved.first().filter(|s| diverges(s));
    let mut out: Vec<Instability> =
        first.map(|s| Instability::Divergence { speed: s.speed, until: None }).into_iter().collect();
    for pair in solved.windows(2) {
        let ends = [&pair[0], &pair[1]];
        for (speed, _) in system.changes(ends, |stability, _| usize::from(stability.divergent > 0)) {
            match out.last_mut() {
                Some(Instability::Divergence { until: until @ None, .. }) => *until = Some(speed),
                _ => out.push(Instability::Divergence { speed, until: None }),
            }
        }
    }
    out
}

/// Speeds between which no shape changes too much.
struct Refined {
    solved: Vec<Solved>,
    /// Of each speed with the next.
    matches: Vec<Vec<Match>>,
    /// Whether it was stopped before the last one.
    stopped: bool,
}

/// Inserts speeds where a shape changes too much from one to the next.
fn refine(
    system: &mut Speeds<'_>,
    solved: Vec<Solved>,
    progress: &mut dyn FnMut() -> bool,
) -> Result<Refined, NoCampbell> {
    let Plan { count, speeds, .. } = system.plan();
    let range = speeds.last().zip(speeds.first()).map_or(0.0, |(last, first)| last - first);
    let count = *count;
    let mut out: Vec<Solved> = Vec::with_capacity(solved.len());
    let mut all = Vec::with_capacity(solved.len());
    for next in solved {
        let Some(before) = out.last() else {
            out.push(next);
            continue;
        };
        let smallest = (next.speed - before.speed) * 0.5_f64.powi(HALVINGS as i32);
        // Speeds still to be passed, the nearest last.
        let (mut ahead, mut expected) = (vec![next], 0);
        loop {
            // Degenerate modes are like those before; at the first speed, like those behind.
            if let ([first], Some(to)) = (out.as_mut_slice(), ahead.last()) {
                align(to, first);
            }
            let (Some(from), Some(to)) = (out.last(), ahead.last_mut()) else { break };
            align(from, to);
            let matches = match_shapes(from, to);
            let interval = to.speed - from.speed;
            let clear = matches.iter().take(count).all(|m| m.is_clear()) || interval <= 1.5 * smallest;
            let ordered = interval <= CROSSING * range || !changes_order(from, to, &matches, count);
            if clear && ordered {
                all.push(matches);
                out.extend(ahead.pop());
            } else if !progress() {
                return Ok(Refined { solved: out, matches: all, stopped: true });
            } else {
                let place =
                    if clear && expected < EXPECTED { crossing(from, to, &matches, count) } else { None };
                let beside = place.and_then(|place| beside([from.speed, to.speed], place, CROSSING * range));
                expected += u32::from(beside.is_some());
                let middle = 0.5 * (from.speed + to.speed);
                match system.between(beside.unwrap_or(middle), from) {
                    Ok(between) => ahead.push(between),
                    Err(NoCampbell::Stopped) => {
                        return Ok(Refined { solved: out, matches: all, stopped: true });
                    }
                    Err(error) => return Err(error),
                }
            }
        }
    }
    Ok(Refined { solved: out, matches: all, stopped: false })
}

/// A speed next to the `place` in an interval at which modes are expected to change their order, before it or else behind it: with both,
/// the change is within an interval of the length `width`.
fn beside([from, to]: [f64; 2], place: f64, width: f64) -> Option<f64> {
    let [before, behind] = [place - SIDE * width, place + SIDE * width];
    let side = if before - from > 0.5 * SIDE * width { before } else { behind };
    (from < side && side < to).then_some(side)
}

/// The branches that begin as the lowest `count` modes.
fn join(solved: &[Solved], matches: &[Vec<Match>], count: usize) -> Tracker {
    let mut tracker = Tracker::new(solved.first(), count);
    for (to, matches) in solved.iter().skip(1).zip(matches) {
        tracker.step(matches, to);
    }
    tracker
}

/// Ranges of speed in which the damping of a branch is negative.
fn flutter(branches: &[Branch]) -> Vec<Instability> {
    let mut out = Vec::new();
    for (branch, b) in branches.iter().enumerate() {
        let grows = |p: &Point| p.mode.frequency() > 0.0 && p.mode.grows();
        let mut i = 0;
        while let Some(first) = (i..b.points.len()).find(|i| grows(&b.points[*i])) {
            let end = (first..b.points.len()).find(|i| !grows(&b.points[*i]));
            let (from, to) = (b.points[first.saturating_sub(1)].speed, b.points[first].speed);
            out.push(Instability::Flutter { branch, from, to, until: end.map(|end| b.points[end].speed) });
            i = end.unwrap_or(b.points.len());
        }
    }
    out
}
