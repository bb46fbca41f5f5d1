//! `flexion modes` and `flexion campbell`: what both have in common.

use crate::screen;
use flexion::analysis::campbell::HubState;
use flexion::case::{Case, Reading, build};
use flexion::hub_beam::Drive;
use flexion::output::Frequencies;
use flexion::system::System;

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

/// How frequencies are given, and what the hub does.
#[derive(clap::Args)]
pub struct Options {
    /// Unit of speeds and frequencies, given and written
    #[arg(long, value_enum, value_name = "UNIT", default_value = "rad/s", conflicts_with = "dimensionless")]
    unit: Unit,
    /// Speeds and frequencies, given and written, are multiples of √(EI/ρAL⁴), by the section at the root
    #[arg(long)]
    dimensionless: bool,
    /// The hub of the case turns with the beam, under its torques [default: it keeps its speed]
    #[arg(long)]
    free_hub: bool,
}

impl Options {
    /// The unit of speeds and frequencies.
    pub fn frequencies(&self, case: &Case) -> Result<Frequencies, String> {
        if self.dimensionless {
            let section = build::section(&case.section, case.length).map_err(|error| error.to_string())?;
            let r = section.resultants(0.0);
            let time = (r.mass * case.length.powi(4) / r.bending_stiffness).sqrt();
            return Ok(Frequencies::dimensionless(time));
        }
        Ok(match self.unit {
            Unit::Radians => Frequencies::RADIANS,
            Unit::Hertz => Frequencies::HERTZ,
            Unit::Rpm => Frequencies::RPM,
        })
    }

    /// What the hub does.
    pub fn hub(&self, case: &Case) -> Result<HubState, String> {
        if !self.free_hub {
            return Ok(HubState::Held);
        }
        match build::drive(&case.hub.motion, case.duration) {
            Ok(Drive::Free(_)) => Ok(HubState::Free),
            _ => Err("--free-hub needs a case whose hub is free: its hub.motion is prescribed".to_owned()),
        }
    }
}

/// The system of a case, for modes.
pub fn system(case: &Case) -> Result<Box<dyn System>, String> {
    build::system(case).map_err(|error| error.to_string())
}

/// Stations of the shapes: two hundred equal parts.
pub fn stations(case: &Case) -> Vec<f64> {
    (0..=200).map(|i| case.length * f64::from(i) / 200.0).collect()
}

/// The title of a figure.
pub fn title(reading: &Reading) -> Option<&str> {
    Some(reading.case.title.as_str()).filter(|title| !title.is_empty())
}

/// Says what is wrong.
pub fn complain(message: &str) {
    screen::complain(&format!("error: {message}\n"));
}

/// A number of modes.
pub fn count(text: &str) -> Result<usize, String> {
    match text.parse::<usize>() {
        Ok(n) if (1..=1000).contains(&n) => Ok(n),
        _ => Err("it is a whole number from 1 to 1000".to_owned()),
    }
}
