//! Parameters that an analysis follows: the speed of a steady rotation, a part of the loads.

/// A parameter of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Parameter {
    /// Angular speed Ω [rad/s] with which the frame of the model rotates steadily.
    Speed,
    /// Part of the loads that acts, 0 … 1.
    LoadFactor,
    /// Angle φ \[rad\] by which the frame has rotated against loads of a direction that is fixed in space, with all else as it is.
    Azimuth,
}

/// Why a parameter does not take a value.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotSet {
    /// The model has no such parameter.
    #[error("the model has no {}", match .0 {
        Parameter::Speed | Parameter::Azimuth => "frame that could rotate steadily",
        Parameter::LoadFactor => "loads",
    })]
    Unknown(Parameter),
    /// There is no steady state at this value.
    #[error("{0}")]
    Lost(String),
}

/// A model seen from a frame that rotates steadily, where a steady rotation is v = a = 0.
pub trait Steady {
    /// Sets a parameter until [`release`](Steady::release). With [`Parameter::Speed`] the frame rotates steadily at this
    /// speed in the place of whatever drives it.
    ///
    /// # Errors
    /// [`NotSet`]; the model stays as it was.
    fn set(&mut self, parameter: Parameter, _value: f64) -> Result<(), NotSet> {
        Err(NotSet::Unknown(parameter))
    }

    /// Holds rigid motions at the values they have in the rotating frame, or lets them go: the equation of a held
    /// unknown is that it does not change.
    fn hold(&mut self, _held: bool) {}

    /// Gives the model back its own motion, all of its loads, and its rigid motions.
    fn release(&mut self) {}
}
