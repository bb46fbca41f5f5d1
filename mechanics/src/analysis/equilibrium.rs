//! Equilibrium in the system's own frame: r(t, q, 0, 0, λ) = 0 and g(t, q) = 0 by Newton's method with growing loads.
//!
//! K has the multipliers in it, which alone stiffen a mechanism: every level begins with those that balance the most of
//! the loads. Where growing loads end at a limit point, or in an equilibrium that is not stable, the [path](super::path) is
//! followed.
//!
//! A motion without stiffness, as of a mast on a ball joint about the vertical, makes J singular, and the equilibrium one of many. With
//! K + σM in the place of K Newton's method takes the one near the start: σ, small against the squares of all frequencies that are not
//! zero, leaves its solution as it is, and a load in such a direction has none.

use super::equations::{Equations, Failure, apply, highest};
use super::joints;
use super::path::{Plan, first_stable};
use super::settling::settle;
use super::stability::{Stability, is_neutral, stability};
use crate::system::{State, System};
use std::cell::Cell;
use std::ops::ControlFlow;

/// Smallest part of the load by which continuation goes on.
const SMALLEST: f64 = 1e-6;
/// Iterations to an equilibrium nearby.
const NEARBY: u32 = 10;
/// Weights of the masses that hold motions without stiffness, over the square of the highest frequency, one after the other: rounding
/// moves them the less, and soft motions converge the slower.
const HOLDS: [f64; 3] = [1e-12, 1e-10, 1e-8];
/// Points of a path on which a stable equilibrium is looked for.
const POINTS: usize = 400;

/// Why there is no equilibrium.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "no equilibrium found at t = {time:.4} s beyond {percent:.3} % of the load: {what} (largest in the {worst}); take smaller \
     loads, or hold what can move freely",
    percent = 100.0 * reached
)]
pub struct NoEquilibrium {
    /// Time at which it was sought \[s\].
    pub time: f64,
    /// Part of the load up to which there was equilibrium.
    pub reached: f64,
    /// What happened beyond.
    pub what: String,
    /// Label of the worst unknown.
    pub worst: String,
}

/// What an equilibrium took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Load levels.
    pub levels: u32,
    /// Newton iterations.
    pub iterations: u32,
}

/// Brings `state` to equilibrium at its time, beginning from the configuration it has: q and λ such that
/// r(t, q, 0, 0, λ) = 0, with g = 0 of joints and g ≥ 0 ⟂ λ ≥ 0 of contacts, without friction. On return v = a = 0, and the modes
/// tell which contacts are closed.
///
/// The equilibrium is followed from the given configuration as the loads grow: with r_s the residual under the part s
/// of them and r₀ that without loads in the given configuration, the levels r_s(q) = (1 − s) r₀ are solved for s from
/// 0 to 1, the increment of s growing and shrinking as Newton's method converges. A follower or a couple rotates with
/// its section all the way. Whether it is stable is told by [`stability`].
///
/// # Errors
/// [`NoEquilibrium`] when the iteration breaks down however small the increments are: a limit point, or a
/// model that has no equilibrium there.
pub fn equilibrium(system: &mut dyn System, state: &mut State) -> Result<Effort, NoEquilibrium> {
    direct(system, state, &mut |_| ControlFlow::Continue(()))
}

/// The same; `watch` is shown the part of the loads of every level that is tried, and ends the search by `Break`.
pub(super) fn direct(
    system: &mut dyn System,
    state: &mut State,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Effort, NoEquilibrium> {
    let start = state.clone();
    if !system.contacts(&start).is_empty() && is_neutral(system, &start) {
        return come_to_rest(system, state, watch);
    }
    let (mut result, singular) = follow_loads(system, state, 0.0, watch);
    if result.is_err() && (singular || is_neutral(system, &start)) {
        let highest = highest(system, &start);
        for hold in HOLDS.map(|part| part * highest).into_iter().filter(|hold| *hold > 0.0) {
            let mut held = start.clone();
            if let (Ok(effort), _) = follow_loads(system, &mut held, hold, watch)
                && release(system, &mut held).is_ok()
            {
                state.copy_from(&held);
                result = Ok(effort);
                break;
            }
        }
    }
    result
}

/// The equilibrium under all of the loads to which Newton's method leads from one nearby, in few iterations.
pub(super) fn nearby(
    system: &mut dyn System,
    state: &mut State,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Effort, NoEquilibrium> {
    if watch(1.0).is_break() {
        return Err(stopped(system, state.t, 0.0));
    }
    let start = state.clone();
    let mut equations = Equations::new(system, state);
    equations.allowed = NEARBY;
    apply(equations.system, 1.0);
    joints::balance(equations.system, state);
    match equations.solve(state, &mut 1.0, None) {
        Ok(iterations) => Ok(Effort { levels: 1, iterations }),
        Err(_) if is_neutral(equations.system, &start) => {
            state.copy_from(&start);
            direct(system, state, watch)
        }
        Err(Failure { what, worst, .. }) => {
            let worst = equations.system.unknown(worst);
            Err(NoEquilibrium { time: state.t, reached: 0.0, what, worst })
        }
    }
}

/// Solves again without the masses that held an equilibrium, if all of its motions have a stiffness.
fn release(system: &mut dyn System, state: &mut State) -> Result<u32, Failure> {
    if is_neutral(system, state) {
        return Ok(0);
    }
    let mut equations = Equations::new(system, state);
    equations.solve(state, &mut 1.0, None)
}

/// The equilibrium in which contacts hold what the loads drive.
fn come_to_rest(
    system: &mut dyn System,
    state: &mut State,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Effort, NoEquilibrium> {
    let mut equations = Equations::new(system, state);
    let found = settle(&mut equations, state, watch).and_then(|()| {
        let neutral = is_neutral(equations.system, state);
        let unit = highest(equations.system, state);
        let holds = if neutral { HOLDS.map(|part| part * unit).to_vec() } else { vec![0.0] };
        let mut last = Err(Failure::of("nothing holds it"));
        for hold in holds {
            equations.hold = hold;
            let mut held = state.clone();
            last = equations.solve(&mut held, &mut 1.0, None);
            if last.is_ok() {
                state.copy_from(&held);
                break;
            }
        }
        last
    });
    apply(equations.system, 1.0);
    match found {
        Ok(_) => Ok(Effort { levels: 1, iterations: equations.iterations }),
        Err(Failure { what, worst, .. }) => {
            let worst = equations.system.unknown(worst);
            Err(NoEquilibrium { time: state.t, reached: 0.0, what, worst })
        }
    }
}

/// [`direct`] with the weight `hold` of the masses beside K; and whether a matrix was singular.
fn follow_loads(
    system: &mut dyn System,
    state: &mut State,
    hold: f64,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> (Result<Effort, NoEquilibrium>, bool) {
    let mut equations = Equations::new(system, state);
    equations.hold = hold;
    let mut singular = false;
    let mut good = state.clone();
    let (mut reached, mut part): (f64, f64) = (0.0, 1.0);
    let mut levels = 0;
    while reached < 1.0 {
        let mut level = (reached + part).min(1.0);
        if watch(level).is_break() {
            apply(equations.system, 1.0);
            return (Err(stopped(equations.system, state.t, reached)), singular);
        }
        apply(equations.system, level);
        joints::balance(equations.system, state);
        match equations.solve(state, &mut level, None) {
            Ok(_) => {
                levels += 1;
                reached = level;
                part *= 2.0;
                good.copy_from(state);
            }
            Err(failure) => {
                singular |= failure.singular;
                state.copy_from(&good);
                part = 0.25 * (level - reached);
                if part < SMALLEST {
                    apply(equations.system, 1.0);
                    let worst = equations.system.unknown(failure.worst);
                    let none = NoEquilibrium { time: state.t, reached, what: failure.what, worst };
                    return (Err(none), singular);
                }
            }
        }
    }
    apply(equations.system, 1.0);
    (Ok(Effort { levels, iterations: equations.iterations }), singular)
}

/// Why there is none where the search was ended.
fn stopped(system: &dyn System, time: f64, reached: f64) -> NoEquilibrium {
    let (what, worst) = ("the search was stopped".to_owned(), system.unknown(0));
    NoEquilibrium { time, reached, what, worst }
}

/// An equilibrium, and how it was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// Its stability; `None` where it was not found.
    pub stability: Option<Stability>,
    /// That of the equilibrium which growing loads alone lead to, where it is unstable and another was found by following the
    /// path of the loads.
    pub left: Option<Stability>,
    /// Whether some motion has no stiffness: the equilibrium is one of many.
    pub neutral: bool,
}

/// As [`equilibrium`], with its stability; where growing loads end, or lead to an equilibrium that is unstable, the path of the
/// loads is followed by its arc length to the first that is stable. `watch` is shown the load factors that are tried and ends the search by
/// `Break`.
///
/// # Errors
/// [`NoEquilibrium`] when there is none at all, or the search is ended.
pub fn stable_equilibrium(
    system: &mut dyn System,
    state: &mut State,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Result<Found, NoEquilibrium> {
    let start = state.clone();
    let (ended, last) = (Cell::new(false), Cell::new(0.0));
    let mut watch = |factor: f64| {
        last.set(factor);
        let flow = watch(factor);
        ended.set(flow.is_break());
        flow
    };
    let direct = direct(system, state, &mut watch);
    if ended.get() {
        return direct.map(|_| Found { stability: None, left: None, neutral: false });
    }
    let neutral = direct.is_ok() && is_neutral(system, state);
    let found = direct.as_ref().ok().map(|_| stability(system, state));
    match found {
        Some(Ok(stability)) if stability.is_stable() => {
            return Ok(Found { stability: Some(stability), left: None, neutral });
        }
        Some(Err(_)) => return Ok(Found { stability: None, left: None, neutral }),
        _ => {}
    }
    let left = found.and_then(Result::ok);
    let plan = Plan { points: POINTS, ..Plan::to(1.0) };
    let best = first_stable(system, &start, &plan, &mut watch);
    apply(system, 1.0);
    match best {
        Some(best) => {
            state.copy_from(&best);
            Ok(Found { stability: Some(Stability::default()), left, neutral: false })
        }
        None if ended.get() => Err(stopped(system, state.t, last.get())),
        None if !system.contacts(&start).is_empty() => {
            let mut rest = start.clone();
            let settled = come_to_rest(system, &mut rest, &mut watch);
            let found = settled.is_ok().then(|| stability(system, &rest).ok()).flatten();
            if let Some(stability) = found.filter(|found| found.is_stable() || direct.is_err()) {
                let neutral = is_neutral(system, &rest);
                state.copy_from(&rest);
                return Ok(Found { stability: Some(stability), left, neutral });
            }
            direct.map(|_| Found { stability: left, left: None, neutral })
        }
        None => direct.map(|_| Found { stability: left, left: None, neutral }),
    }
}
