//! Until when the contacts of a run are those of a more accurate one.
//!
//! Impacts of a beam are chaotic: a difference in the last digits grows from burst to burst, and no tolerance makes all of
//! a long run right. A companion on the same mesh, with a tenth of the tolerance and half the first and the longest step, or half the step, says how far it is.

use super::pair::{Pair, vanishes};
use super::{Refinable, Variant};
use crate::analysis::recording::{Record, Trajectory, Watch};
use crate::analysis::transient::{Ending, Plan};
use crate::system::Kind;

/// Difference of a gap, over its largest value, from which two runs go different ways.
const APART: f64 = 0.01;

/// What makes a companion on the same mesh more accurate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finer {
    /// A tenth of the tolerance.
    Tolerance,
    /// Half the step.
    Step,
}

/// From when on gaps and impacts are not those of a more accurate run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parting {
    /// When a gap differs by a hundredth of its largest value, or the other run ends \[s\].
    pub time: f64,
    /// Whether that is because the other run was given up there.
    pub given_up: bool,
    /// What makes the other run more accurate.
    pub by: Finer,
}

/// The time until which the gaps of a run are those of its companion; `None` where they are to the end.
pub(super) fn parting<P: Refinable>(
    problem: &P,
    variant: &Variant,
    run: &Record,
    watch: &mut Watch<'_>,
) -> Result<Option<Parting>, P::Fault> {
    if run.events.is_empty() {
        return Ok(None);
    }
    let (finer, by) = match variant.fixed_step() {
        None => (variant.more_accurate(run), Finer::Tolerance),
        Some(_) => {
            let half = |step: Option<f64>| step.map(|step| 0.5 * step);
            let (step, contact_step) = (half(variant.plan.step), half(variant.plan.contact_step));
            (
                Variant { plan: Plan { step, contact_step, ..variant.plan.clone() }, ..variant.clone() },
                Finer::Step,
            )
        }
    };
    let companion = problem.record(&finer, watch)?;
    let (ours, theirs) = (&run.trajectory, &companion.trajectory);
    let mut time = f64::INFINITY;
    for (index, channel) in ours.channels().iter().enumerate().filter(|(_, c)| c.kind == Kind::Gap) {
        let Some(pair) = Pair::new(ours, theirs, &channel.name) else { continue };
        // A contact that is closed all the time has a gap of rounding.
        let nothing =
            |of: &Trajectory| of.index(&channel.name).is_some_and(|i| vanishes(of, i, problem.size()));
        if nothing(ours) && nothing(theirs) {
            continue;
        }
        let bound = APART * ours.extremes(index).largest();
        let apart = pair.rows().find(|(_, a, b)| (a - b).abs() > bound);
        time = apart.map_or(time, |(t, ..)| time.min(t));
    }
    if time.is_finite() {
        return Ok(Some(Parting { time, given_up: false, by }));
    }
    let early = companion.ending != Ending::Finished;
    Ok(early.then_some(Parting { time: companion.state.t, given_up: true, by }))
}
