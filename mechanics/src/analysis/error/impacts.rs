//! Impacts of rigid contacts, before which runs on two meshes are compared.

use super::{Refinable, Variant};
use crate::analysis::recording::{Record, Watch};
use crate::analysis::transient::Plan;

/// Part of the recording interval in which a record and an impact are at the same time.
const SAME: f64 = 1e-9;

/// The last time recorded \[s\] before the first impact of a run of a mesh with a rigid contact: after it a run on another mesh says
/// nothing of the error. `None` where it is the end of the plan.
pub fn before_impacts<P: Refinable>(problem: &P, plan: &Plan, run: &Record) -> Option<f64> {
    let end = (first_impact(problem, run)? / plan.sample - SAME).floor().max(0.0) * plan.sample;
    Some(end).filter(|end| *end < plan.end)
}

/// The time of the first impact of a run of a mesh with a rigid contact.
fn first_impact<P: Refinable>(problem: &P, run: &Record) -> Option<f64> {
    let rigid = problem.has_mesh() && run.events.is_rigid();
    run.events.list.first().filter(|_| rigid).map(|first| first.time)
}

/// The record of a companion until its first impact.
pub(super) fn until_impact<P: Refinable>(
    problem: &P,
    variant: &Variant,
    watch: &mut Watch<'_>,
) -> Result<Record, P::Fault> {
    let mut companion = problem.record(variant, watch)?;
    if let Some(time) = first_impact(problem, &companion) {
        companion.trajectory.cut(time);
    }
    Ok(companion)
}
