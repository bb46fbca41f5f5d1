//! What the reader of a run should know of its steps.

use flexion::analysis::periodic::{NoPeriodicMotion, Periodic};
use flexion::analysis::recording::Warning;
use flexion::system::{Jump, Set, System};

/// A warning of a run with fixed or controlled steps, with what to do.
pub(super) fn of_run(warning: &Warning, fixed: bool) -> String {
    let advice = match warning {
        Warning::EnergyGained { .. } if fixed => "; use a smaller step or the adaptive method `radau`",
        Warning::EnergyGained { .. } => "; use a tighter tolerance",
        Warning::EnergyImbalance { .. } | Warning::EnergyUnexplained { .. } => {
            "; use smaller steps or a tighter tolerance"
        }
        Warning::SteppedOver { .. } if fixed => "; use smaller steps, or `radau`",
        Warning::SteppedOver { .. } => "; use a smaller `contact-step`",
        Warning::Grinds { .. } => {
            "; take fewer points, a softer force, or a `constraint` with `nonsmooth-generalized-alpha`"
        }
        Warning::ImpactGained { .. } => "; no restitution, or a continuous law of force, does not",
        Warning::Unsettled { .. } => "; smaller steps have fewer contacts in one",
        Warning::Chatter { .. } | Warning::Rubbing { .. } => "; `contact-step` makes them shorter",
        Warning::FewStepsAPeriod { .. } => ": use smaller steps or the adaptive method `radau`",
        _ => "",
    };
    format!("{warning}{advice}")
}

/// A caution where a prescribed speed jumps and beams have damping in proportion to their stiffness: behind the jump the root moves and the beam does
/// not yet, with a rate of strain as the inverse of the first element's length.
pub(super) fn struck(system: &dyn System, damping: f64, duration: f64) -> Option<String> {
    let mut jumps = system.breaks().iter().filter(|b| b.jump == Jump::Velocity && b.time < duration);
    let time = jumps.next().filter(|_| damping > 0.0)?.time;
    Some(format!(
        "a velocity jumps at t = {time:.6} s, and damping in proportion to the stiffness answers a jump with a force without bound: forces and \
         torques right behind it grow with the number of elements, their impulses do not; let the speed rise within some time"
    ))
}

/// A caution where a method that holds positions alone has contacts that may open.
pub(super) fn positions_only(system: &dyn System) -> Option<String> {
    let mut sets = system.rows().iter();
    sets.any(|set| matches!(set, Set::Unilateral { .. })).then(|| {
        "with `stabilized = false` nothing holds the velocities of closed contacts: where they close and open within a step their forces may \
         grow without bound; leave the key out"
            .to_owned()
    })
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

/// Amplitude of a periodic motion, over the size of the model, from which on its first order is no good approximation.
const LARGE: f64 = 0.1;

/// What is said of a start in steady rotation under `what`, which does not rotate.
pub(crate) fn unsteady(what: &str, periodic: &Result<Periodic, NoPeriodicMotion>) -> String {
    let begins = match periodic {
        Ok(Periodic { amplitude }) if *amplitude > LARGE => format!(
            "the run begins in the periodic motion under them, as that is to first order, which is no good approximation here: its amplitude is \
             {amplitude:.2} of the size of the model, near a resonance or under loads too large; let damping end what is left"
        ),
        Ok(_) => "the run begins in the periodic motion under them, as that is to first order".to_owned(),
        Err(why) => format!(
            "the run begins in the equilibrium under them as they stand at the start, and vibrates until damping has ended that: \
             {why}"
        ),
    };
    format!(
        "loads of a direction that is fixed in space ({what}) change with every revolution, seen from what rotates: {begins}"
    )
}
