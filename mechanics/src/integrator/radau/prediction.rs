//! Starting values of a step.

/// What the starting values of a step are made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Prediction {
    /// The acceleration at the start.
    Constant,
    /// The last step, of this size.
    Extrapolated { last: f64 },
    /// The last attempt from the same start, of this size.
    Tried { last: f64 },
}
