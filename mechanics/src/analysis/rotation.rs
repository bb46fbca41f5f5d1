//! Steady rotation: the equilibrium in the frame of a hub that rotates at a constant speed.

use super::equations::largest;
use super::equilibrium::{Effort, NoEquilibrium, direct, nearby};
use super::stability::{Stability, is_neutral, negative_parts, stability};
use super::stiffness::constrained;
use crate::linalg::Matrix;
use crate::linalg::eigen::{EigenError, negative_directions};
use crate::system::{Limit, NotSet, Parameter, State, System};
use std::ops::ControlFlow;

/// Step, over the speed, below which an equilibrium ends.
const SMALLEST: f64 = 1e-8;
/// Least speed, over that asked for, by which steps are measured.
const LEAST: f64 = 1e-4;
/// Step, over the speed, across which the number of negative directions of the stiffness may change, or a contact.
const CRITICAL: f64 = 1e-5;
/// Steps that may be too long, between two critical speeds.
const TRIES: u32 = 200;
/// Motion in a step, over the size of the system or the motion so far, and in one across which that number changes.
const FAR: f64 = 0.1;
const BESIDE: f64 = 3e-4;
/// Part of the motion of an unknown, and of the largest, that a step may lie off the tangents at both of its ends; and what is rounding, over the
/// size of the system.
const CURVED: [f64; 2] = [0.25, 0.05];
const ROUNDING: f64 = 1e-9;
/// Motion, over the size of the system, from which on Newton's method begins where the tangent leads.
const LED: f64 = 1e-6;
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
        "there is no steady rotation at {} rad/s: followed up to {reached:.6} rad/s, where it ends or jumps; beyond, {}{}{}",
        short(*.asked),
        .source.what,
        largest_in(&.source.worst),
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
        "the steady rotation at {} rad/s is buckled, {stability}: {}{}",
        short(*.asked),
        stable_up_to(*.reached),
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

/// An equilibrium on the way.
struct Point {
    state: State,
    speed: f64,
    /// Negative directions of K, and those that rounding does not decide, where they are known: these are dear.
    negative: usize,
    certain: Option<usize>,
    /// K with its rows, factored where it is regular.
    tangent: Option<Matrix>,
}

impl Point {
    fn of(system: &mut dyn System, state: &State, speed: f64) -> Point {
        let (mut stiffness, multipliers) = constrained(system, state);
        let negative = negative_directions(&stiffness.symmetrized(), multipliers);
        let tangent = stiffness.factor_equilibrated().is_ok().then_some(stiffness);
        Point { state: state.clone(), speed, negative, certain: None, tangent }
    }

    /// Whether K has as many negative directions, but for rounding, as at another equilibrium; the system is left at the speed of this one.
    fn is_like(&mut self, system: &mut dyn System, other: &mut Point) -> bool {
        self.negative == other.negative || {
            let theirs = other.certain(system);
            self.certain(system) == theirs
        }
    }

    fn certain(&mut self, system: &mut dyn System) -> usize {
        let count = self.certain.unwrap_or_else(|| {
            let _ = set(system, self.speed);
            negative_parts(system, &self.state, &mut None)
        });
        let _ = set(system, self.speed);
        *self.certain.insert(count)
    }

    /// −K⁻¹r, with the residual at the speed at which the system is: the increment to its equilibrium along the tangent.
    fn along_tangent(&mut self, system: &mut dyn System) -> Option<Vec<f64>> {
        let n = self.state.v.len();
        let tangent = self.tangent.as_mut()?;
        let mut d = vec![0.0; tangent.order()];
        system.residual(&self.state, &mut d[..n]);
        tangent.solve(&mut d);
        d.iter_mut().for_each(|d| *d = -*d);
        Some(d)
    }

    /// The equilibrium at the speed `to`, where it is on the same branch, and whether a critical speed lies between; `tangents` tells whether K has any
    /// to go by.
    fn next(
        &mut self,
        system: &mut dyn System,
        to: f64,
        (unit, far, tangents): (f64, f64, bool),
        watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(Point, Effort, bool), Missed> {
        set(system, to)?;
        let scales = system.scales().to_vec();
        let elsewhere = |system: &dyn System, (worst, _): (usize, f64)| NoEquilibrium {
            time: 0.0,
            reached: 0.0,
            what: "the equilibrium nearest to the last one lies elsewhere".to_owned(),
            worst: system.unknown(worst),
        };
        let mut state = self.state.clone();
        let forward = if tangents { self.along_tangent(system) } else { None };
        if let Some(d) = &forward {
            let led = largest(d, &scales);
            if !(led.1 <= 2.0 * far) {
                return Err(Missed::Tangent(elsewhere(system, led)));
            }
            // Next to a critical speed a small one is rounding.
            if led.1 > LED {
                let (d, multipliers) = d.split_at(scales.len());
                system.retract(&self.state.q, d, &mut state.q);
                state.lambda.iter_mut().zip(multipliers).for_each(|(lambda, d)| *lambda += d);
            }
        }
        let effort = nearby(system, &mut state, watch)?;
        let mut point = Point::of(system, &state, to);
        let mut moved = vec![0.0; scales.len()];
        system.difference(&self.state.q, &state.q, &mut moved);
        let most = largest(&moved, &scales);
        let passes = (to - self.speed).abs() <= CRITICAL * unit && most.1 <= BESIDE;
        let alike = most.1 <= far && point.is_like(system, self);
        if passes || !alike {
            return if passes { Ok((point, effort, !alike)) } else { Err(elsewhere(system, most).into()) };
        }
        if tangents && most.1 > ROUNDING {
            set(system, self.speed)?;
            let back = point.along_tangent(system);
            set(system, to)?;
            let back = back.map(|d| d.iter().map(|d| -d).collect());
            let off = |d: &Option<Vec<f64>>| d.as_ref().and_then(|d| off(&moved, d, &scales, most.1));
            let is_on = |d: &Option<Vec<f64>>| d.is_some() && off(d).is_none();
            if !(is_on(&forward) && is_on(&back)) {
                let worst = off(&forward).or(off(&back)).unwrap_or(most.0);
                return Err(Missed::Tangent(elsewhere(system, (worst, 0.0))));
            }
        }
        Ok((point, effort, false))
    }
}

/// An unknown whose motion lies off a tangent.
fn off(moved: &[f64], along: &[f64], scales: &[f64], most: f64) -> Option<usize> {
    let [of_own, of_most] = CURVED;
    let mut all = moved.iter().zip(along).zip(scales);
    all.position(|((x, d), scale)| {
        !((x - d).abs() <= of_own * x.abs() + (of_most * most + ROUNDING) * scale.abs())
    })
}

/// Why a step was too long.
enum Missed {
    /// The system does not rotate.
    Still,
    /// There is no equilibrium, or none nearby.
    None(NoEquilibrium),
    /// It lies off the tangents.
    Tangent(NoEquilibrium),
}

impl From<NoEquilibrium> for Missed {
    fn from(source: NoEquilibrium) -> Missed {
        Missed::None(source)
    }
}

fn set(system: &mut dyn System, speed: f64) -> Result<(), Missed> {
    system.set(Parameter::Speed, speed).map_err(|error| match error {
        NotSet::Unknown(_) => Missed::Still,
        NotSet::Lost(what) => NoEquilibrium { time: 0.0, reached: 0.0, what, worst: String::new() }.into(),
    })
}

/// Brings `state` from the steady rotation at the speed `from` [rad/s], which it holds (the undeformed beam does
/// for `from` = 0 without loads), to that at `to`. On return the system rotates steadily at `to`
/// with its hub held, and v = a = 0.
///
/// The equilibrium r(q, 0, 0; Ω) = 0 is followed in Ω, under all of the loads; where they have none at `from` = 0, they grow at the first speed
/// that allows one. A step Δq of the speed is divided until K has as many negative directions behind it as before and Δq is near both −K⁻¹r(q; Ω + ΔΩ)
/// at its begin, from where it is looked for, and K⁻¹r(q + Δq; Ω) at its end: each unknown within a quarter of its own motion and a twentieth of
/// the largest, which is a tenth of the size of the system, or of the motion so far, at most. Beyond a critical speed another equilibrium lies nearby, on the other side of
/// the axis. A step of 1e-5 of the speed that moves the system by 3e-4 of its size at most passes a critical one, so that a shaft that lies on the
/// axis, but for 1e-10 of its length, stays straight; from 1e-9 on it bends outwards, and has no critical speed. `watch` is called for every
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
    follow(system, state, [from, to], watch, &mut |_, _| true)
}

/// [`rotate`], with every equilibrium on the way shown to `visit`, which ends the search by `false`.
fn follow(
    system: &mut dyn System,
    state: &mut State,
    [from, to]: [f64; 2],
    watch: &mut dyn FnMut() -> bool,
    visit: &mut dyn FnMut(&mut dyn System, &Point) -> bool,
) -> Result<Effort, NoRotation> {
    system.hold(true);
    let mut goes_on = true;
    let mut effort = Effort::default();
    let start = state.q.clone();
    let mut last = None;
    if from != 0.0 && system.set(Parameter::Speed, from).is_ok() {
        state.v.fill(0.0);
        state.a.fill(0.0);
        last = Some(Point::of(system, state, from));
    }
    let mut tries = 0;
    // Whether K has tangents to go by: a motion without stiffness makes rounding of them.
    let mut tangents = true;
    let mut known = false;
    // The step before a critical speed.
    let mut wide: Option<f64> = None;
    let mut step = if last.is_some() { to - from } else { 0.0 };
    loop {
        let reached = last.as_ref().map_or(from, |last: &Point| last.speed);
        let next = if step.abs() < (to - reached).abs() { reached + step } else { to };
        let mut level = |_| {
            goes_on = goes_on && watch();
            if goes_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let unit = reached.abs().max(next.abs()).max(LEAST * to.abs());
        let found = match &mut last {
            Some(last) => {
                let mut so_far = vec![0.0; last.state.v.len()];
                system.difference(&start, &last.state.q, &mut so_far);
                let far = FAR * largest(&so_far, system.scales()).1.max(1.0);
                last.next(system, next, (unit, far, tangents), &mut level)
            }
            None => set(system, next).and_then(|()| {
                let effort = direct(system, state, &mut level)?;
                Ok((Point::of(system, state, next), effort, false))
            }),
        };
        let source = match found {
            Ok((point, spent, is_critical)) => {
                effort.levels += spent.levels;
                effort.iterations += spent.iterations;
                state.copy_from(&point.state);
                goes_on = goes_on && visit(system, &point);
                if next == to {
                    return Ok(effort);
                }
                if is_critical {
                    (step, tries) = (wide.take().unwrap_or(step), 0);
                } else {
                    step = if step == 0.0 { to - from } else { 2.0 * (next - reached) };
                    wide = wide.filter(|wide| wide.abs() > step.abs());
                }
                last = Some(point);
                if goes_on {
                    continue;
                }
                NoEquilibrium { time: 0.0, reached: 0.0, what: String::new(), worst: String::new() }
            }
            Err(missed) => {
                let source = match missed {
                    Missed::Still => return Err(NoRotation::DoesNotTurn),
                    Missed::None(source) => source,
                    Missed::Tangent(source) => {
                        if let (Some(last), false) = (&last, known) {
                            known = true;
                            tangents = !is_neutral(system, &last.state);
                            if !tangents {
                                continue;
                            }
                        }
                        source
                    }
                };
                // Without an equilibrium at rest the first speed is tried.
                wide = wide.or(Some(next - reached));
                step = if next == reached { to - from } else { 0.25 * (next - reached) };
                tries += 1;
                source
            }
        };
        if step.abs() < SMALLEST * unit || step == 0.0 || tries > TRIES || !goes_on {
            if let Some(last) = &last {
                state.copy_from(&last.state);
            }
            let why = if goes_on { system.explain(state) } else { None };
            let _ = system.set(Parameter::Speed, reached);
            return Err(match goes_on {
                true => NoRotation::Lost { asked: to, reached, source, why: why.map(Box::new) },
                false => NoRotation::Stopped { asked: to, reached },
            });
        }
    }
}

fn stable_up_to(reached: f64) -> String {
    if reached == 0.0 {
        "unstable at rest already".to_owned()
    } else {
        format!("stable up to {reached:.6} rad/s")
    }
}

fn largest_in(worst: &str) -> String {
    if worst.is_empty() { String::new() } else { format!(" (largest in the {worst})") }
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
    let diverges = |system: &mut dyn System, state: &State| {
        stability(system, state).map_or(true, |found| found.divergent > 0)
    };
    // The last equilibrium before the first that is unstable, and that one's speed; between them, by bisection.
    let (mut low, mut at, mut high) = (from, start.clone(), to);
    let mut first = start;
    let _ = follow(system, &mut first, [from, to], &mut || true, &mut |system, point| {
        if diverges(system, &point.state) {
            high = point.speed;
            return false;
        }
        (low, at) = (point.speed, point.state.clone());
        true
    });
    let mut middle = at.clone();
    while (high - low).abs() > ACCURACY * high.abs().max(low.abs()) {
        let speed = 0.5 * (low + high);
        middle.copy_from(&at);
        if rotate(system, &mut middle, low, speed, &mut || true).is_ok() && !diverges(system, &middle) {
            low = speed;
            at.copy_from(&middle);
        } else {
            high = speed;
        }
    }
    let _ = system.set(Parameter::Speed, low);
    state.copy_from(&at);
    Err(NoRotation::Buckled { asked: to, reached: low, stability: found, why: why.map(Box::new) })
}
