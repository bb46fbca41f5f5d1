//! `flexion modes` and `flexion campbell`: what both have in common.

use crate::{Outcome, screen};
use flexion_case::{Case, Reading, Speed, VibrationError, Wanted};
use flexion_results::{Frequencies, Units};

/// Units of frequencies and speeds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Unit {
    /// Radians a second
    #[value(name = "rad/s")]
    Radians,
    /// Cycles a second
    #[value(name = "Hz")]
    Hertz,
    /// Revolutions a minute
    #[value(name = "rpm")]
    Rpm,
}

impl Unit {
    fn frequencies(self) -> Frequencies {
        match self {
            Unit::Radians => Frequencies::RADIANS,
            Unit::Hertz => Frequencies::HERTZ,
            Unit::Rpm => Frequencies::RPM,
        }
    }
}

/// How frequencies are given, and what the hub does.
#[derive(clap::Args)]
pub struct Options {
    /// Unit of speeds and frequencies, given and written [default: rad/s, or rpm and Hz where the speed is given in rpm]
    #[arg(long, value_enum, value_name = "UNIT", conflicts_with = "dimensionless")]
    unit: Option<Unit>,
    /// Unit of speeds, where it is not that of frequencies
    #[arg(long, value_enum, value_name = "UNIT", conflicts_with = "dimensionless")]
    speed_unit: Option<Unit>,
    /// Unit of frequencies, where it is not that of speeds
    #[arg(long, value_enum, value_name = "UNIT", conflicts_with = "dimensionless")]
    frequency_unit: Option<Unit>,
    /// Speeds and frequencies, given and written, are multiples of √(EI/ρAL⁴), by the section at the root
    #[arg(long)]
    dimensionless: bool,
    /// Title of the figure [default: that of the case]
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
    /// The hub of the case, in space the joint that is the axis, rotates with the beam, under its torques [default: it keeps its speed]
    #[arg(long)]
    pub free_hub: bool,
}

impl Options {
    /// The units of speeds and frequencies, where this speed is given.
    pub fn units(&self, case: &Case, given: Speed) -> Result<Units, VibrationError> {
        let of = |unit: Option<Unit>| unit.map(Unit::frequencies);
        let (both, dimensionless) = (of(self.unit), self.dimensionless);
        Wanted { both, speed: of(self.speed_unit), frequency: of(self.frequency_unit), dimensionless }
            .units(case, given)
    }

    /// The title of a figure.
    pub fn title<'a>(&'a self, reading: &'a Reading) -> Option<&'a str> {
        self.title.as_deref().filter(|title| !title.is_empty()).or(reading.title())
    }
}

/// Reports why there are no modes.
pub fn refused(error: &VibrationError) -> Outcome {
    match error {
        VibrationError::Case(problems) => screen::report(&problems.render(screen::colour())),
        error => report(&error.to_string()),
    }
    Outcome::Rejected
}

/// Reports an error.
pub fn report(message: &str) {
    screen::report(&format!("error: {message}\n"));
}

/// A number of modes.
pub fn count(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(n) if (1..=1000).contains(&n) => Ok(n),
        _ => Err("it is a whole number from 1 to 1000".to_owned()),
    }
}
