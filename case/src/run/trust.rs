//! Until when the contacts of a run are those of a more accurate one.
//!
//! Impacts of a beam are chaotic: a difference in the last digits grows from burst to burst, and no tolerance makes all of
//! a long run right. A companion on the same mesh, with a tenth of the tolerance or half the step, says how far it is.

use super::Run;
use crate::kinds::integrator::Steps;
use crate::problem::Problems;
use crate::reading::Reading;
use flexion::analysis::recording::Watch;
use flexion_results::Status;

/// Difference of a gap, over its largest value, from which two runs go different ways.
const APART: f64 = 0.01;

impl Reading {
    /// A warning with the time until which the gaps of a run are those of its companion; none where they are to the end.
    pub(super) fn trust(&self, run: &Run, watch: &mut Watch<'_>) -> Result<Option<String>, Problems> {
        if !self.case.has_contacts() {
            return Ok(None);
        }
        let (changes, what) = match self.case.steps {
            Steps::Controlled { .. } => (self.tolerances(0.1, 1e-13, 1.0), "a tenth of the tolerance"),
            Steps::Fixed { step, contact } => {
                let half = |key: &str, step: f64| format!("integrator.{key}={:e}", 0.5 * step);
                let contact = contact.map(|contact| half("contact-step", contact));
                ([half("step", step)].into_iter().chain(contact).collect(), "half the step")
            }
        };
        let companion = self.with(&changes)?.prepare()?.run(watch);
        let (ours, theirs) = (&run.trajectory, &companion.trajectory);
        let mut first = f64::INFINITY;
        for (index, channel) in ours.channels().iter().enumerate() {
            let Some(other) = theirs.index(&channel.name).filter(|_| channel.name.ends_with(".gap")) else {
                continue;
            };
            let bound = APART * ours.extremes(index).largest();
            let rows = ours.times().iter().zip(ours.values(index).zip(theirs.values(other)));
            let apart = rows.into_iter().find(|(_, (a, b))| (a - b).abs() > bound);
            first = apart.map_or(first, |(t, _)| first.min(*t));
        }
        let end = companion.state.t;
        if !first.is_finite() && companion.status != Status::Finished {
            return Ok(Some(format!(
                "gaps and impacts are known until t = {end:.6} s only: a run with {what} was given up there"
            )));
        }
        Ok(first.is_finite().then(|| {
            format!(
                "from t = {first:.6} s gaps and impacts are not those of a run with {what}: impacts amplify every \
                 difference"
            )
        }))
    }
}
