//! What makes a recorded motion doubtful.

/// A reason to doubt a recorded motion, found while it was computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Warning {
    /// The energy has grown by `excess` \[J\] more than drives and loads have put in: the steps are too large for the method.
    #[error(
        "the energy has grown by {excess:.3e} J more than drives and loads have put in: the steps are too large for this \
         method, and the motion is not to be trusted"
    )]
    EnergyGained {
        /// Excess of energy \[J\].
        excess: f64,
    },
    /// The energy balance does not close.
    #[error(
        "the energy balance is off by {:.0} % of the largest energy or work of the run: its steps miss what happens, and the \
         motion is not to be trusted",
        100.0 * relative
    )]
    EnergyImbalance {
        /// Its largest value over the largest energy or work of the run.
        relative: f64,
    },
    /// Behind impacts steps lose energy of the vibrations that these excite, or energy comes that nothing has put in.
    #[error(
        "{:.3e} J of energy have {} since the first impact that impacts, dampers and loads do not explain, {:.1} % of the largest energy or work of the run: the steps {}",
        added.abs(),
        if *added < 0.0 { "been lost" } else { "come" },
        100.0 * relative,
        if *added < 0.0 { "damp the vibrations that impacts excite" } else { "do not resolve what happens in impacts" }
    )]
    EnergyUnexplained {
        /// Energy added \[J\]: negative where it is lost.
        added: f64,
        /// Its size over the largest energy or work of the run.
        relative: f64,
    },
    /// A point may have passed through an obstacle within a step of a method that locates no events.
    #[error(
        "the contact `{contact}` may have passed through its obstacle, or touched it, within the step that ends at t = {time:.6} s: no events \
         are located in it"
    )]
    SteppedOver {
        /// End of the first such step \[s\].
        time: f64,
        /// Name of the contact.
        contact: String,
    },
    /// Contacts chattered, and were followed by steps of a nonsmooth method.
    #[error(
        "contacts chatter from t = {begin:.6} s on, faster than their events can be found one by one: {duration:.4} s of the run, in \
         {bursts} burst{}, are computed by nonsmooth steps of at most {step:.2e} s, to which the times of impacts in them are known; they do not resolve what \
         is fast{}",
        if *bursts == 1 { "" } else { "s" },
        if *less > 0.0 {
            format!(", of which dampers take {less:.2e} J less than by their power, as the balance of energy says")
        } else {
            String::new()
        }
    )]
    Chatter {
        /// Begin of the first burst \[s\].
        begin: f64,
        /// Duration of all bursts \[s\].
        duration: f64,
        /// Number of bursts.
        bursts: u64,
        /// Longest step \[s\].
        step: f64,
        /// What dampers have taken less than by their power \[J\].
        less: f64,
    },
    /// Rigid contacts rubbed in space, or were more than motions that they hold, and were followed by steps of a nonsmooth method.
    #[error(
        "rigid contacts with friction in space, or more of them than motions that they hold, are closed for {duration:.4} s, from t = {begin:.6} s on: meanwhile steps of \
         `nonsmooth-generalized-alpha` of at most {step:.2e} s take the place of the steps of this method and of its tolerance"
    )]
    Rubbing {
        /// When the first such contact closed \[s\].
        begin: f64,
        /// For how long contacts were followed so \[s\].
        duration: f64,
        /// Longest step \[s\].
        step: f64,
    },
    /// Events of continuous forces follow each other fast.
    #[error(
        "from t = {time:.6} s on, forces of contacts begin and end every {mean:.1e} s, each located as an event: the run takes long"
    )]
    Grinds {
        /// Time \[s\].
        time: f64,
        /// Mean time between events \[s\].
        mean: f64,
    },
    /// The forces of contacts did not settle.
    #[error(
        "in {steps} step{} the forces of contacts did not settle as far as is asked, and the best that were found are taken: at worst, in the step that ends at \
         t = {time:.6} s, a force is off by {largest:.1e} of the largest one from what the motion of its contact asks for",
        if *steps == 1 { "" } else { "s" }
    )]
    Unsettled {
        /// Number of such steps.
        steps: u64,
        /// Largest residual, over the largest force.
        largest: f64,
        /// End of the step with it \[s\].
        time: f64,
    },
    /// An impact added energy.
    #[error(
        "the impact at t = {time:.6} s adds {energy:.3e} J: restitution by the closing speed of each contact may do so, with friction or where several contacts strike together"
    )]
    ImpactGained {
        /// Time of the worst one \[s\].
        time: f64,
        /// What it adds \[J\].
        energy: f64,
    },
    /// Fixed steps do not resolve the vibration that makes up most of the motion.
    #[error(
        "the motion is mostly a vibration of {steps:.1} steps a period, and its amplitude and phase need {wanted} at least"
    )]
    FewStepsAPeriod {
        /// Steps a period.
        steps: f64,
        /// Steps a period that amplitude and phase need.
        wanted: f64,
    },
}
