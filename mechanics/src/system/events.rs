//! What happens at single times: jumps that are known before, and events that are found.

use super::{Limit, State};

/// What jumps at a [`Break`]. A smoother function counts as greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Jump {
    /// A velocity, as by a prescribed speed that jumps: an impulse acts.
    Velocity,
    /// An acceleration, as by a force that jumps.
    Acceleration,
    /// The first derivative of an acceleration.
    Slope,
    /// The second derivative of an acceleration.
    Curvature,
    /// Nothing: a step with error control ends there to see a load or a motion that changes fast.
    Nothing,
}

/// A time that is known before the run: the motion is not smooth there, or changes fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Break {
    /// Time \[s\].
    pub time: f64,
    /// What jumps there.
    pub jump: Jump,
}

/// Sorts breaks by time and joins those of one time, to rounding, to the roughest of them.
pub fn ordered(mut breaks: Vec<Break>) -> Vec<Break> {
    breaks.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.jump.cmp(&b.jump)));
    breaks.dedup_by(|later, first| {
        let one = later.time - first.time <= 8.0 * f64::EPSILON * first.time.abs();
        if one {
            first.jump = first.jump.min(later.jump);
        }
        one
    });
    breaks
}

/// How a run goes on after an event.
#[derive(Clone, Debug, PartialEq)]
pub enum Crossing {
    /// As if nothing had happened.
    Continue,
    /// From this state with new accelerations: a force jumps.
    Restart,
    /// With velocities changed by the [impulse](Events::impulse) at this time.
    Jump,
    /// Not at all, for the reason given.
    Stop(Limit),
}

/// The single times of a model. Contacts are no events of the model: a driver finds them from the rows.
pub trait Events {
    /// Known times at which the motion is not smooth, ascending.
    fn breaks(&self) -> &[Break] {
        &[]
    }

    /// A run begins at `s`, or goes on from there behind a break or an event: called once each, in order of time. What is held from one break
    /// to the next is taken here.
    ///
    /// # Errors
    /// Why the run cannot go on.
    fn pass(&mut self, _s: &State) -> Result<(), Limit> {
        Ok(())
    }

    /// Writes the impulse p [N·s, N·m·s] that acts at the time of `s` by a jump of a prescribed velocity, and in the entries after
    /// those of the velocities by how much ∂g/∂t of each row jumps; `s` is the state before it: M Δv = p + Gᵀ Λ,
    /// G Δv = −Δ∂g/∂t of the rows of joints. `false` where there is none.
    fn impulse(&mut self, _s: &State, _p: &mut [f64]) -> bool {
        false
    }

    /// Work \[J\] of what enforces a prescribed velocity without a row, between the states before and after a jump of it or an
    /// impact.
    fn impulse_work(&mut self, _before: &State, _after: &State) -> f64 {
        0.0
    }

    /// Largest rate of rotation of what carries contact points or obstacles [rad/s]: over an arc of more than a radian a gap may fall and rise
    /// without its ends telling.
    fn turning(&mut self, _s: &State) -> f64 {
        0.0
    }

    /// Number of indicators.
    fn indicators(&self) -> usize {
        0
    }

    /// Writes the indicators: an event is found where one of them changes its sign.
    fn indicate(&mut self, _s: &State, _out: &mut [f64]) {}

    /// Writes the rates of the indicators; zero where a rate is not known, or where it does not matter that the indicator
    /// changes its sign twice in a step.
    fn indicator_rates(&mut self, _s: &State, out: &mut [f64]) {
        out.fill(0.0);
    }

    /// What follows when the indicators `fired` have changed their sign at `s`.
    fn cross(&mut self, _fired: &[usize], _s: &mut State) -> Crossing {
        Crossing::Continue
    }
}
