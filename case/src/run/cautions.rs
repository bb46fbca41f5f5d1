//! What the reader of a run should know of its steps.

use flexion::system::{Jump, System};

/// A caution if a fixed step \[s\] is longer than the time in which a load or a motion changes.
pub(super) fn unseen(system: &dyn System, step: f64, duration: f64) -> Option<String> {
    let pairs = system.breaks().windows(2).filter(|pair| pair.iter().any(|b| b.jump == Jump::Nothing));
    let gaps =
        pairs.filter(|pair| pair[1].time <= duration).map(|pair| (pair[1].time - pair[0].time, pair[0].time));
    let (gap, time) = gaps.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|(gap, _)| *gap < step)?;
    Some(format!(
        "a load or a motion changes within {gap:.1e} s near t = {time:.6} s, and steps of {step} s do not see it: use steps \
         of {gap:.1e} s, or the adaptive method `radau`"
    ))
}
