//! The path of equilibria under growing loads, followed by its arc length past limit points and turning points.
//!
//! The length of a piece of path is (Σ (Δqᵢ/wᵢ)²/n + Δs²)^½, with the scales w of the n velocities and the load factor s. From a
//! point the path is predicted along its direction and corrected across it; the step grows and shrinks
//! as Newton's method converges and with the angle between directions. Where the number of unstable motions changes, the
//! critical state in between is enclosed by dividing the step, which is short there.

use super::equations::{Direction, Equations, Failure, apply};
use super::mechanism::driven_motion;
use super::stability::{Stability, negative_parts, stability};
use crate::linalg::eigen::EigenError;
use crate::system::{State, System};
use std::ops::ControlFlow;

/// First step.
const FIRST: f64 = 0.01;
/// Smallest step, over the longest.
const SMALLEST: f64 = 1e-6;
/// Smallest cosine of the angle between the directions at both ends of a step, and that at which a step may grow.
const COSINES: [f64; 2] = [0.92, 0.985];
/// Iterations up to which a step may grow.
const QUICK: u32 = 4;
/// Step, over the longest, across which the number of unstable motions may change. A longer one might leave a path that bends in
/// a short distance, as that of a column with a small force across, for the unstable path that goes straight on.
const CAREFUL: f64 = 2e-3;
/// Part of an interval at which it is divided: halves of a step of a round size would meet the very state at which the tangent is
/// singular.
const SHARE: f64 = 0.47;
/// Length of path, over the longest step, in which a critical state is enclosed.
const ENCLOSED: f64 = 1e-7;

/// How a path is followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Load factor whose equilibria are of interest.
    pub to: f64,
    /// Number of points at most.
    pub points: usize,
    /// Longest step.
    pub longest: f64,
}

impl Plan {
    /// To a load factor.
    pub fn to(to: f64) -> Plan {
        Plan { to, points: 1000, longest: 0.05 }
    }
}

/// What a critical state is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Critical {
    /// The load has an extreme value: beyond it the structure snaps.
    Limit,
    /// The load goes on: another path branches off.
    Branching,
    /// Vibrations begin or cease to grow.
    Flutter,
}

impl Critical {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Critical::Limit => "limit point",
            Critical::Branching => "branching",
            Critical::Flutter => "flutter",
        }
    }
}

/// A point of a path.
#[derive(Clone, Debug)]
pub struct Point {
    /// Load factor s.
    pub factor: f64,
    /// Length of the path to it.
    pub length: f64,
    /// The equilibrium.
    pub state: State,
    /// Its stability.
    pub stability: Result<Stability, EigenError>,
    /// Whether the load factor is that of the plan.
    pub arrived: bool,
    /// What it is, if it is critical.
    pub critical: Option<Critical>,
}

/// Why a path ends.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PathEnd {
    /// There is no path: the loads drive a motion that nothing holds.
    #[error(
        "there is no equilibrium under the loads near the start: they drive a motion that has no stiffness, largest in the \
         {largest}; hold it, or begin where the loads do no work on it"
    )]
    Mechanism {
        /// Label of the largest unknown of the motion.
        largest: String,
    },
    /// Newton's method fails.
    #[error(
        "the path of equilibria ends at the load factor {factor:.6}: {what} (largest in the {worst}); hold what can move freely, \
         or refine the mesh"
    )]
    Lost {
        /// Load factor reached.
        factor: f64,
        /// What happens beyond.
        what: String,
        /// Label of the worst unknown.
        worst: String,
    },
    /// There are no more points.
    #[error(
        "{points} points lead to the load factor {factor:.6} only: the path may never come to {to}; allow more points or longer \
         steps"
    )]
    Points {
        /// Number of points.
        points: usize,
        /// Load factor reached.
        factor: f64,
        /// Load factor of the plan.
        to: f64,
    },
}

/// An equilibrium while a path is followed.
#[derive(Clone)]
struct Place {
    state: State,
    factor: f64,
    length: f64,
    along: Direction,
}

/// Follows the path of equilibria from `start`, without loads, and shows the points to `visit`, which stops by `false`. The
/// system carries the loads of the last point on return; [`release`](crate::system::Steady::release) gives it all of them.
///
/// # Errors
/// [`PathEnd`]; the points before it have been shown.
pub fn follow(
    system: &mut dyn System,
    start: &State,
    plan: &Plan,
    mut visit: impl FnMut(&mut dyn System, &Point) -> bool,
) -> Result<(), PathEnd> {
    walk(system, start, plan, point, |equations, (from, to)| {
        let Some(((here, before), (there, now))) = from.zip(Some(to)) else {
            return visit(equations.system, to.1);
        };
        if let Some(critical) = between(equations, plan, (here, before), (there, now))
            && !visit(equations.system, &critical)
        {
            return false;
        }
        if let Some(arrived) = arrive(equations, plan, here, there)
            && !visit(equations.system, &arrived)
        {
            return false;
        }
        apply(equations.system, there.factor);
        visit(equations.system, now)
    })
}

/// The first stable equilibrium with the load factor of the plan on the path from `start`; `None` where the path leads to none. Of the
/// other points only the definiteness of K is followed, which O(n) operations tell. `watch` is shown the load factor of each and stops by
/// `Break`.
pub(super) fn first_stable(
    system: &mut dyn System,
    start: &State,
    plan: &Plan,
    watch: &mut dyn FnMut(f64) -> ControlFlow<()>,
) -> Option<State> {
    let mut found = None;
    let mut known = None;
    let definiteness = |equations: &mut Equations<'_>, place: &Place| {
        apply(equations.system, place.factor);
        Definiteness(negative_parts(equations.system, &place.state, &mut known))
    };
    // A path that ends has shown what lies before.
    let _ = walk(system, start, plan, definiteness, |equations, (from, (there, _))| {
        let arrived = from.and_then(|(here, _)| arrive(equations, plan, here, there));
        let stable = |point: &Point| point.stability.as_ref().is_ok_and(Stability::is_stable);
        found = arrived.filter(stable).map(|point| point.state);
        found.is_none() && watch(there.factor).is_continue()
    });
    found
}

/// What is found at a place, and compared with what is found at the next: a step across which it changes is short.
trait Judgement {
    fn is_as(&self, other: &Self) -> bool;
}

impl Judgement for Point {
    fn is_as(&self, other: &Point) -> bool {
        self.stability == other.stability
    }
}

/// Number of directions in which the quadratic form of K is negative.
struct Definiteness(usize);

impl Judgement for Definiteness {
    fn is_as(&self, other: &Definiteness) -> bool {
        self.0 == other.0
    }
}

/// Follows a path, judges its places, and shows them to `visit`, each with the one before it.
fn walk<J: Judgement>(
    system: &mut dyn System,
    start: &State,
    plan: &Plan,
    mut judge: impl FnMut(&mut Equations<'_>, &Place) -> J,
    mut visit: impl FnMut(&mut Equations<'_>, (Option<(&Place, &J)>, (&Place, &J))) -> bool,
) -> Result<(), PathEnd> {
    let mut state = start.clone();
    if let Some(largest) = driven_motion(system, &state) {
        return Err(PathEnd::Mechanism { largest });
    }
    let mut equations = Equations::new(system, &mut state);
    let (mut factor, mut step) = (0.0, FIRST.min(plan.longest));
    let first =
        equations.solve(&mut state, &mut factor, None).and_then(|_| equations.direction(&state, 0.0, None));
    let mut here = match first {
        Ok(along) => Place { state, factor, length: 0.0, along },
        Err(failure) => return Err(lost(&equations, 0.0, failure)),
    };
    let mut before = judge(&mut equations, &here);
    if !visit(&mut equations, (None, (&here, &before))) {
        return Ok(());
    }
    for _ in 1..plan.points.max(2) {
        let (there, now, iterations, cosine) = loop {
            match advance(&mut equations, &here, step) {
                Ok((there, iterations)) => {
                    let (a, b) = (&here.along, &there.along);
                    let cosine = equations.inner((&a.unknowns, a.part), (&b.unknowns, b.part));
                    if cosine > COSINES[0] || step < SMALLEST * plan.longest {
                        let now = judge(&mut equations, &there);
                        if now.is_as(&before) || step < CAREFUL * plan.longest {
                            break (there, now, iterations, cosine);
                        }
                    }
                }
                Err(failure) if step < SMALLEST * plan.longest => {
                    return Err(lost(&equations, here.factor, failure));
                }
                Err(_) => {}
            }
            step *= 0.5;
        };
        if !visit(&mut equations, (Some((&here, &before)), (&there, &now))) {
            return Ok(());
        }
        (here, before) = (there, now);
        if iterations <= QUICK && cosine > COSINES[1] {
            step = (1.5 * step).min(plan.longest);
        }
    }
    Err(PathEnd::Points { points: plan.points, factor: here.factor, to: plan.to })
}

fn lost(equations: &Equations<'_>, factor: f64, failure: Failure) -> PathEnd {
    PathEnd::Lost { factor, what: failure.what, worst: equations.system.unknown(failure.worst) }
}

/// One step along the path.
fn advance(equations: &mut Equations<'_>, from: &Place, step: f64) -> Result<(Place, u32), Failure> {
    let (mut state, mut factor) = (from.state.clone(), from.factor);
    equations.advance(&mut state, &mut factor, &from.along, step);
    let iterations = equations.solve(&mut state, &mut factor, Some(&from.along))?;
    let along = equations.direction(&state, factor, Some(&from.along))?;
    Ok((Place { state, factor, length: from.length + step, along }, iterations))
}

/// The point of a place, with its stability.
fn point(equations: &mut Equations<'_>, place: &Place) -> Point {
    let Place { state, factor, length, .. } = place.clone();
    apply(equations.system, factor);
    let found = stability(equations.system, &state);
    Point { factor, length, state, stability: found, arrived: false, critical: None }
}

/// The point with the load factor of the plan between two places, if it lies there.
fn arrive(equations: &mut Equations<'_>, plan: &Plan, here: &Place, there: &Place) -> Option<Point> {
    if (here.factor < plan.to) == (there.factor < plan.to) {
        return None;
    }
    let share = (plan.to - here.factor) / (there.factor - here.factor);
    let length = here.length + share * (there.length - here.length);
    let (mut state, mut factor) = (here.state.clone(), here.factor);
    equations.advance(&mut state, &mut factor, &here.along, length - here.length);
    equations.solve(&mut state, &mut factor, Some(&here.along)).ok()?;
    factor = plan.to;
    equations.solve(&mut state, &mut factor, None).ok()?;
    let found = stability(equations.system, &state);
    Some(Point { factor, length, state, stability: found, arrived: true, critical: None })
}

/// The critical state between two points of different stability.
fn between(
    equations: &mut Equations<'_>,
    plan: &Plan,
    (here, before): (&Place, &Point),
    (there, now): (&Place, &Point),
) -> Option<Point> {
    let (Ok(first), Ok(last)) = (&before.stability, &now.stability) else { return None };
    if first == last {
        return None;
    }
    let limit = here.along.part * there.along.part < 0.0;
    let (mut low, mut high) = (0.0, there.length - here.length);
    let mut best = there.clone();
    let mut far = *last;
    while high - low > ENCLOSED * plan.longest {
        let middle = low + SHARE * (high - low);
        let Ok((place, _)) = advance(equations, here, middle) else { break };
        let Ok(found) = stability(equations.system, &place.state) else { break };
        if found == *first {
            low = middle;
        } else {
            (high, far, best) = (middle, found, place);
        }
    }
    let critical = match () {
        () if first.fluttering != far.fluttering => Critical::Flutter,
        () if limit => Critical::Limit,
        () => Critical::Branching,
    };
    Some(Point { stability: Ok(far), critical: Some(critical), ..point(equations, &best) })
}
