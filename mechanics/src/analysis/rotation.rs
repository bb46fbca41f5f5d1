//! Steady rotation: the equilibrium in the frame of a hub that rotates at a constant speed.

use super::equations::largest;
use super::equilibrium::{Effort, NoEquilibrium, direct, nearby};
use super::stability::{Stability, negative_parts, stability};
use crate::linalg::eigen::EigenError;
use crate::system::{Limit, NotSet, Parameter, State, System};
use std::ops::ControlFlow;

/// Step, over the speed, below which an equilibrium ends.
const SMALLEST: f64 = 1e-8;
/// Least speed, over that asked for, by which steps are measured.
const LEAST: f64 = 1e-4;
/// Step, over the speed, across which the number of negative directions of the stiffness may change.
const CRITICAL: f64 = 1e-5;
/// Steps that may be too long.
const TRIES: u32 = 200;
/// Motion in a step, over the size of the system, and in one across which that number changes.
const FAR: f64 = 0.1;
const BESIDE: f64 = 3e-4;
/// Relative accuracy of the speed at which an equilibrium ends.
const ACCURACY: f64 = 1e-6;

/// A number with six decimals at most.
fn short(x: f64) -> String {
    let text = format!("{x:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Why a beam cannot be brought to a speed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoRotation {
    /// The system does not rotate.
    #[error("the system has no hub that could rotate steadily")]
    DoesNotTurn,
    /// There is no equilibrium.
    #[error(
        "there is no steady rotation at {} rad/s: followed up to {reached:.6} rad/s, where it ends or jumps; beyond, {} (largest in the {}){}",
        short(*.asked),
        .source.what,
        .source.worst,
        because(.why)
    )]
    Lost {
        /// Speed asked for [rad/s].
        asked: f64,
        /// Speed reached [rad/s].
        reached: f64,
        /// What happened beyond.
        source: NoEquilibrium,
        /// What the model knows about it.
        why: Option<Box<Limit>>,
    },
    /// The equilibrium is unstable.
    #[error(
        "the steady rotation at {} rad/s is buckled, {stability}: stable up to {reached:.6} rad/s{}",
        short(*.asked),
        because(.why)
    )]
    Buckled {
        /// Speed asked for [rad/s].
        asked: f64,
        /// Speed up to which it is stable [rad/s].
        reached: f64,
        /// Its stability at the speed asked for.
        stability: Stability,
        /// What the model knows about it.
        why: Option<Box<Limit>>,
    },
    /// The search was ended.
    #[error("the search for the steady rotation at {} rad/s was stopped at {reached:.6} rad/s", short(*.asked))]
    Stopped {
        /// Speed asked for [rad/s].
        asked: f64,
        /// Speed reached [rad/s].
        reached: f64,
    },
    /// Its stability was not found.
    #[error("the stability of the steady rotation at {} rad/s was not found: {source}", short(*.asked))]
    Undecided {
        /// Speed asked for [rad/s].
        asked: f64,
        /// Why.
        source: EigenError,
    },
}

impl NoRotation {
    /// The speed that was reached [rad/s].
    pub fn reached(&self) -> f64 {
        match self {
            NoRotation::DoesNotTurn => 0.0,
            NoRotation::Undecided { asked, .. } => *asked,
            NoRotation::Lost { reached, .. }
            | NoRotation::Buckled { reached, .. }
            | NoRotation::Stopped { reached, .. } => *reached,
        }
    }
}

/// Brings `state` from the steady rotation at the speed `from` [rad/s], which it holds (the undeformed beam does
/// for `from` = 0 without loads), to that at `to`. On return the system rotates steadily at `to`
/// with its hub held, and v = a = 0.
///
/// The equilibrium r(q, 0, 0; Ω) = 0 is followed in Ω, under all of the loads; where they have none at `from` = 0, they grow at the first speed
/// that allows one. A step of the speed is divided until it moves the system by a tenth of its size at most and K has as many
/// negative directions behind it as before; it begins where the last step leads. Beyond a critical speed another equilibrium lies nearby, on the other side of the axis. A step
/// of 1e-5 of the speed that moves the system by 3e-4 of its size at most passes a critical one, so that a shaft that lies on the axis, but
/// for 1e-10 of its length, stays straight; from 1e-9 on it bends outwards, and has no critical speed. `watch` is called for every
/// equilibrium that is tried on the way, and ends the search by `false`.
///
/// # Errors
/// [`NoRotation`] when the equilibrium ends on the way, or the search is ended.
pub fn rotate(
    system: &mut dyn System,
    state: &mut State,
    from: f64,
    to: f64,
    watch: &mut dyn FnMut() -> bool,
) -> Result<Effort, NoRotation> {
    system.hold(true);
    let mut goes_on = true;
    let mut good = state.clone();
    let mut effort = Effort::default();
    // Negative directions of K at the last equilibrium.
    let mut before = None;
    if from != 0.0 && system.set(Parameter::Speed, from).is_ok() {
        before = Some(negative_parts(system, state));
    }
    let mut tries = 0;
    // The step that led there, and by which increment of the configuration.
    let mut secant: Option<(f64, Vec<f64>)> = None;
    let mut reached = from;
    let mut step = if before.is_some() { to - from } else { 0.0 };
    loop {
        let next = if step.abs() < (to - reached).abs() { reached + step } else { to };
        let none = |what: String| {
            let worst = "steady state".to_owned();
            NoEquilibrium { time: good.t, reached: 0.0, what, worst }
        };
        let set = match system.set(Parameter::Speed, next) {
            Ok(()) => Ok(()),
            Err(NotSet::Unknown(_)) => return Err(NoRotation::DoesNotTurn),
            Err(NotSet::Lost(what)) => Err(none(what)),
        };
        let mut level = |_| {
            goes_on = goes_on && watch();
            if goes_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let unit = reached.abs().max(next.abs()).max(LEAST * to.abs());
        let found = set.and_then(|()| match before {
            None => direct(system, state, &mut level),
            Some(_) => {
                if let Some((step, moved)) = &secant {
                    let part = (next - reached) / step;
                    let predicted: Vec<f64> = moved.iter().map(|d| part * d).collect();
                    system.retract(&good.q, &predicted, &mut state.q);
                }
                nearby(system, state, &mut level)
            }
        });
        let found = found.and_then(|spent| {
            let now = negative_parts(system, state);
            let is_critical = (next - reached).abs() <= CRITICAL * unit;
            let allowed = match before {
                None => f64::INFINITY,
                Some(before) if before == now => FAR,
                Some(_) if is_critical => BESIDE,
                Some(_) => 0.0,
            };
            let mut moved = vec![0.0; state.v.len()];
            system.difference(&good.q, &state.q, &mut moved);
            if largest(&moved, system.scales()).1 > allowed {
                return Err(none("no equilibrium is near the last one".to_owned()));
            }
            Ok((spent, now, moved))
        });
        match found {
            Ok((spent, now, moved)) => {
                effort.levels += spent.levels;
                effort.iterations += spent.iterations;
                good.copy_from(state);
                secant = before.filter(|_| next != reached).map(|_| (next - reached, moved));
                (before, reached) = (Some(now), next);
                if next == to {
                    return Ok(effort);
                }
                step = if step == 0.0 { to - from } else { 2.0 * step };
            }
            Err(source) => {
                state.copy_from(&good);
                // Without an equilibrium at rest the first speed is tried.
                step = if next == reached { to - from } else { 0.25 * (next - reached) };
                tries += 1;
                if step.abs() < SMALLEST * unit || step == 0.0 || tries > TRIES || !goes_on {
                    let why = if goes_on { system.explain(state) } else { None };
                    let _ = system.set(Parameter::Speed, reached);
                    return Err(match goes_on {
                        true => NoRotation::Lost { asked: to, reached, source, why: why.map(Box::new) },
                        false => NoRotation::Stopped { asked: to, reached },
                    });
                }
            }
        }
    }
}

fn because(why: &Option<Box<Limit>>) -> String {
    why.as_ref().map(|why| format!(": {why}")).unwrap_or_default()
}

/// As [`rotate`], and refuses an equilibrium from which motions diverge. Flutter is left to the [modes](super::modes).
///
/// # Errors
/// [`NoRotation`], with the speed up to which the rotation is stable.
pub fn rotate_stably(
    system: &mut dyn System,
    state: &mut State,
    from: f64,
    to: f64,
) -> Result<Effort, NoRotation> {
    let start = state.clone();
    let effort = rotate(system, state, from, to, &mut || true)?;
    let found = stability(system, state).map_err(|source| NoRotation::Undecided { asked: to, source })?;
    if found.divergent == 0 {
        return Ok(effort);
    }
    let why = system.explain(state);
    // Where it is lost, by bisection.
    let (mut low, mut high) = (from, to);
    let mut at = start;
    while (high - low).abs() > ACCURACY * high.abs().max(low.abs()) {
        let middle = 0.5 * (low + high);
        let mut next = at.clone();
        if rotate(system, &mut next, low, middle, &mut || true).is_ok()
            && stability(system, &next).is_ok_and(|found| found.divergent == 0)
        {
            low = middle;
            at = next;
        } else {
            high = middle;
        }
    }
    let _ = system.set(Parameter::Speed, low);
    state.copy_from(&at);
    Err(NoRotation::Buckled { asked: to, reached: low, stability: found, why: why.map(Box::new) })
}
