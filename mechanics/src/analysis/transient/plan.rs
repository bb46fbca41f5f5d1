//! What a run is asked to do.

/// What a run is asked to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// End of the run \[s\].
    pub end: f64,
    /// Step of a fixed-step method \[s\]: each segment between breaks is divided into the
    /// fewest equal steps not longer than it.
    /// For an adaptive method, its first step; `None` lets the method choose.
    pub step: Option<f64>,
    /// Longest step of an adaptive method \[s\]; `None` for two recording intervals, or a hundredth of the run if
    /// that is shorter.
    pub longest_step: Option<f64>,
    /// Step while a contact is closed or comes near \[s\], if shorter than `step`: the rest of a fixed step is divided into
    /// the fewest equal ones not longer than it. A step under control is not longer than it from the first impact on: what
    /// impacts set vibrating is damped by longer steps, in flight too.
    pub contact_step: Option<f64>,
    /// Least number of steps of an adaptive method between two neighbouring [breaks](crate::system::Events::breaks), 1 or more: what
    /// is short beside the rest of a motion may be within every tolerance, and its steps then have the length of its breaks.
    pub break_steps: u32,
    /// Interval of recording \[s\]; the end is recorded too.
    pub sample: f64,
}

impl Plan {
    /// Runs to `end` \[s\] with the steps that the method chooses, and records at intervals of `sample` \[s\].
    pub fn new(end: f64, sample: f64) -> Plan {
        Plan { end, step: None, longest_step: None, contact_step: None, break_steps: 1, sample }
    }

    /// The plan with fixed steps, or a first step of a method with step control \[s\].
    #[must_use]
    pub fn with_step(self, step: f64) -> Plan {
        Plan { step: Some(step), ..self }
    }

    /// The plan with a longest step of a method with step control \[s\].
    #[must_use]
    pub fn with_longest_step(self, step: f64) -> Plan {
        Plan { longest_step: Some(step), ..self }
    }

    /// The plan with [steps near contacts](Plan::contact_step) \[s\].
    #[must_use]
    pub fn with_contact_step(self, step: f64) -> Plan {
        Plan { contact_step: Some(step), ..self }
    }

    /// The plan with so many [steps between breaks](Plan::break_steps) at least.
    #[must_use]
    pub fn with_break_steps(self, steps: u32) -> Plan {
        Plan { break_steps: steps, ..self }
    }

    /// Longest step under control of a run from `origin` \[s\]. While the drive is constant, the error estimate cannot detect an event inside the
    /// step: what the recorded columns can show bounds it.
    pub(super) fn longest_from(&self, origin: f64) -> f64 {
        self.longest_step.unwrap_or((2.0 * self.sample).min(0.01 * (self.end - origin)))
    }
}
