//! Known times at which steps end, as a method sees them.

use crate::integrator::Info;
use crate::system::{Jump, Side, System};

pub(super) fn is_fixed(info: &Info) -> bool {
    info.estimate_order.is_none()
}

/// Whether steps of this method end at a jump.
fn sees(info: &Info, jump: Jump) -> bool {
    !is_fixed(info) || jump <= Jump::Acceleration
}

/// The first break after `t` that the method sees, or the end of the run.
pub(super) fn next_break(system: &dyn System, info: &Info, t: f64, end: f64) -> f64 {
    let breaks = system.breaks();
    let later = &breaks[breaks.partition_point(|b| b.time <= t)..];
    let found = later.iter().find(|b| sees(info, b.jump));
    found.map_or(end, |b| b.time.min(end))
}

/// Where a step after `t` must end, and the side of that time: the left one of a break.
pub(super) fn stop(system: &dyn System, info: &Info, t: f64, end: f64) -> (f64, Side) {
    let stop = next_break(system, info, t, end);
    let side = if jump_at(system, info, stop).is_some() { Side::Left } else { Side::Right };
    (stop, side)
}

/// What jumps at `t`, if the method sees it.
pub(super) fn jump_at(system: &dyn System, info: &Info, t: f64) -> Option<Jump> {
    let breaks = system.breaks();
    let at = breaks.get(breaks.partition_point(|b| b.time < t))?;
    (at.time == t && at.jump != Jump::Nothing && sees(info, at.jump)).then_some(at.jump)
}
