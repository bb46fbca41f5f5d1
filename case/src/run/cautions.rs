//! What the reader of a run should know of its steps.

use flexion::analysis::recording::Warning;
use flexion::system::{Jump, System};

/// A warning of a run with fixed or controlled steps, with what to do.
pub(super) fn of_run(warning: &Warning, fixed: bool) -> String {
    let advice = match warning {
        Warning::EnergyGained { .. } if fixed => "; use a smaller step or the adaptive method `radau`",
        Warning::EnergyGained { .. } => "; use a tighter tolerance",
        Warning::EnergyImbalance { .. } => "; use smaller steps or a tighter tolerance",
        Warning::SteppedOver { .. } => "; use smaller steps, or `radau`",
        Warning::FewStepsAPeriod { .. } => ": use smaller steps or the adaptive method `radau`",
        _ => "",
    };
    format!("{warning}{advice}")
}

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
