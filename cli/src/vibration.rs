//! `flexion modes` and `flexion campbell`: what both have in common.

use crate::screen;
use flexion::analysis::campbell::HubState;
use flexion::hub_beam::Drive;
use flexion::system::{Fork, Slender};
use flexion_case::{Case, Reading, units};
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
    free_hub: bool,
}

impl Options {
    /// The units of speeds and frequencies, where this speed is given.
    pub fn units(&self, case: &Case, given: Speed) -> Result<Units, String> {
        if self.dimensionless {
            let resultants = case.hub_beam().map(|beam| (beam.length, beam.section.planar.resultants(0.0)));
            let (length, r) = resultants
                .ok_or("--dimensionless is for a beam on a hub: a system in space has no one section")?;
            let time = (r.mass * length.powi(4) / r.bending_stiffness).sqrt();
            let both = Frequencies::dimensionless(time);
            return Ok(Units { speed: both, frequency: both });
        }
        let written = match given {
            Speed::Rpm(_) => Unit::Rpm,
            Speed::Plain(_) | Speed::Radians(_) => Unit::Radians,
        };
        let speed = self.speed_unit.or(self.unit).unwrap_or(written);
        // Nobody counts vibrations by the minute, unless he says so.
        let usual = if speed == Unit::Rpm { Unit::Hertz } else { speed };
        let frequency = self.frequency_unit.or(self.unit).unwrap_or(usual);
        Ok(Units { speed: speed.frequencies(), frequency: frequency.frequencies() })
    }

    /// The title of a figure.
    pub fn title<'a>(&'a self, reading: &'a Reading) -> Option<&'a str> {
        self.title.as_deref().filter(|title| !title.is_empty()).or(title(reading))
    }

    /// What the hub does.
    pub fn hub(&self, case: &Case) -> Result<HubState, String> {
        if !self.free_hub {
            return Ok(HubState::Held);
        }
        let Some(beam) = case.hub_beam() else {
            let rotation = case.space().and_then(|space| space.rotation.as_ref().ok());
            return match rotation.and_then(|rotation| rotation.keeps.as_ref()) {
                Some(_) => Ok(HubState::Free),
                None => Err("--free-hub needs a revolute or cylindrical joint with the ground about the axis of rotation: the                              case has none that could be free"
                    .to_owned()),
            };
        };
        match beam.hub.drive {
            Drive::Free(_) => Ok(HubState::Free),
            Drive::Prescribed(_) => {
                Err("--free-hub needs a case whose hub is free: its hub.motion is prescribed".to_owned())
            }
        }
    }
}

/// Whether a case contains only what its vibrations use; what they do not is reported at its line.
pub fn fits(reading: &Reading) -> bool {
    let fits = reading.fits_modes();
    fits.as_ref().err().into_iter().for_each(|problems| screen::report(&problems.render(screen::colour())));
    fits.is_ok()
}

/// What vibrates in a case, at rest or in steady rotation, and a warning that names the loads that are left out: in the frame of a
/// rotating hub those fixed in space are periodic, and there is no steady state to linearize about. Their mean over a revolution
/// is zero: the modes are those about this mean.
pub fn system(case: &Case, rotates: bool) -> Result<(Box<dyn Fork>, Vec<String>), String> {
    let (system, left_out) = case.vibrating(rotates).map_err(|error| error.to_string())?;
    let across = if case.space().is_some() { "the part across the axis of " } else { "" };
    let caution = format!(
        "without {across}{}: seen from a hub that rotates it changes with every revolution, a state that is not steady has no modes, \
         and its mean over a revolution is zero",
        left_out.join(" and ")
    );
    Ok((system, if left_out.is_empty() { Vec::new() } else { vec![caution] }))
}

/// Relative error of a frequency by the mesh above which there is a warning.
pub const COARSE: f64 = 0.01;

/// Relative error of a frequency by rounding above which there is a warning.
const ROUNDED: f64 = 1e-6;

/// A warning that frequencies may be off by rounding, of the numbers of modes and their errors, with the beam that is to blame.
pub fn rounded(modes: impl Iterator<Item = (usize, f64)>, slender: Option<&Slender>) -> Option<String> {
    let (mut numbers, mut largest): (Vec<usize>, f64) = (Vec::new(), 0.0);
    for (number, error) in modes.filter(|(_, error)| *error > ROUNDED) {
        largest = largest.max(error);
        if numbers.last() != Some(&number) {
            numbers.push(number);
        }
    }
    let (first, last) = (numbers.first()?, numbers.last()?);
    let which = match numbers.len() {
        1 => format!("the frequency of mode {first}"),
        n if last - first + 1 == n => format!("the frequencies of modes {first} to {last}"),
        _ => {
            let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
            format!("the frequencies of modes {}", numbers.join(", "))
        }
    };
    let why = slender.map_or_else(
        || "the mesh is too fine for this coupling; use fewer elements".to_owned(),
        Slender::to_string,
    );
    Some(format!("{which} may be off by {largest:.1e} of it by rounding: {why}"))
}

/// The error of a frequency by the mesh over its difference to that of twice the elements or functions.
pub fn safety(case: &Case) -> f64 {
    case.hub_beam().map_or(2.0, |beam| beam.bases.safety)
}

/// A warning for a case whose contacts do not matter here.
pub fn without_contacts(case: &Case) -> Option<String> {
    let message = "without contacts: a contact that opens and closes has no small vibrations, and the modes are those of the free beam";
    case.has_contacts().then(|| message.to_owned())
}

/// A speed as written: `12.1 rpm`, or a number of the unit chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Speed {
    /// A number of the unit chosen.
    Plain(f64),
    /// With a unit, in rad/s.
    Radians(f64),
    /// In revolutions a minute, in rad/s.
    Rpm(f64),
}

impl Speed {
    /// The speed in rad/s.
    pub fn in_radians(self, unit: &Frequencies) -> f64 {
        match self {
            Speed::Plain(x) => x / unit.factor,
            Speed::Radians(x) | Speed::Rpm(x) => x,
        }
    }
}

/// A speed from the command line.
pub fn speed(text: &str) -> Result<Speed, String> {
    let text = text.trim();
    if let Ok(x) = text.parse::<f64>() {
        return Ok(Speed::Plain(x));
    }
    match units::parse(text, &units::ANGULAR_SPEED) {
        Ok(x) if text.ends_with("rpm") => Ok(Speed::Rpm(x)),
        Ok(x) => Ok(Speed::Radians(x)),
        Err(error) => Err(format!("`{text}` is no speed: {}; {}", error.message, error.help)),
    }
}

/// Stations of the shapes: the ends of so many equal parts of the beam on a hub, or of the first beam in space.
pub fn stations(case: &Case, parts: u32) -> Vec<f64> {
    let equal = |length: f64| (0..=parts).map(|i| length * f64::from(i) / f64::from(parts)).collect();
    let of_space = case.space().and_then(|space| space.beams.first());
    let length = case.hub_beam().map(|beam| beam.length).or(of_space.map(|(beam, _)| beam.length));
    length.map_or_else(Vec::new, equal)
}

/// The title of a case, where it has one.
pub fn title(reading: &Reading) -> Option<&str> {
    Some(reading.case.title.as_str()).filter(|title| !title.is_empty())
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
