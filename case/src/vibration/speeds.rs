//! Speeds of rotation as they are written, and the units of what is found at them.

use super::VibrationError;
use crate::case::Case;
use crate::units;
use flexion_results::{Frequencies, Units};

/// Most speeds of a diagram.
const MOST: usize = 100_000;
/// Speeds of a diagram, if nothing else is said.
const USUAL: usize = 51;

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
    /// Reads a speed.
    ///
    /// # Errors
    /// Why it is none.
    pub fn read(text: &str) -> Result<Speed, String> {
        let text = text.trim();
        if let Ok(x) = text.parse::<f64>() {
            return if x.is_finite() {
                Ok(Speed::Plain(x))
            } else {
                Err(format!("`{text}` is no speed: write a finite number"))
            };
        }
        match units::parse(text, &units::ANGULAR_SPEED) {
            Ok(x) if text.ends_with("rpm") => Ok(Speed::Rpm(x)),
            Ok(x) => Ok(Speed::Radians(x)),
            Err(error) => Err(format!("`{text}` is no speed: {}; {}", error.message, error.help)),
        }
    }

    /// The speed in rad/s.
    pub fn in_radians(self, unit: &Frequencies) -> f64 {
        match self {
            Speed::Plain(x) => x / unit.factor,
            Speed::Radians(x) | Speed::Rpm(x) => x,
        }
    }
}

/// Speeds at equal distances: from, to, how many.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    from: Speed,
    /// The last.
    pub to: Speed,
    count: usize,
}

impl Speeds {
    /// Reads speeds, `FROM:TO:NUMBER` or `FROM:TO`.
    ///
    /// # Errors
    /// Why they are none.
    pub fn read(text: &str) -> Result<Speeds, String> {
        let parts: Vec<&str> = text.split(':').collect();
        // The unit of the first is that of the last too, where that has none.
        let last = |from: &str, to: &str| match to.trim().parse::<f64>() {
            Ok(_) => {
                let unit = from.trim().trim_start_matches(|c: char| "0123456789.+-eE".contains(c));
                Speed::read(&format!("{to}{unit}"))
            }
            Err(_) => Speed::read(to),
        };
        let (from, to, count) = match parts[..] {
            [from, to] => (Speed::read(from)?, last(from, to)?, USUAL),
            [from, to, count] => {
                let whole = count.trim().parse::<usize>();
                let whole = whole.map_err(|_| format!("`{count}` is no number of speeds"))?;
                (Speed::read(from)?, last(from, to)?, whole)
            }
            _ => return Err("write FROM:TO:NUMBER, e.g. 0:50:100".to_owned()),
        };
        if !(2..=MOST).contains(&count) {
            return Err(format!("there are from 2 to {MOST} speeds, not {count}"));
        }
        Ok(Speeds { from, to, count })
    }

    /// The speeds [rad/s].
    pub fn in_radians(&self, unit: &Frequencies) -> Vec<f64> {
        let (from, to) = (self.from.in_radians(unit), self.to.in_radians(unit));
        let last = self.count - 1;
        let at = |i: usize| if i == last { to } else { from + (to - from) * i as f64 / last as f64 };
        (0..self.count).map(at).collect()
    }
}

/// In which units speeds and frequencies are asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wanted {
    /// Of both.
    pub both: Option<Frequencies>,
    /// Of speeds, where it is not that of both.
    pub speed: Option<Frequencies>,
    /// Of frequencies, where it is not that of both.
    pub frequency: Option<Frequencies>,
    /// Whether they are multiples of √(EI/ρAL⁴).
    pub dimensionless: bool,
}

impl Wanted {
    /// The units of speeds and frequencies, where this speed is given: without a wish rad/s, or rpm and Hz where it is given in rpm.
    ///
    /// # Errors
    /// A case that has no [unit of its own](Case::dimensionless).
    pub fn units(&self, case: &Case, given: Speed) -> Result<Units, VibrationError> {
        if self.dimensionless {
            let both = case.dimensionless()?;
            return Ok(Units { speed: both, frequency: both });
        }
        let written = match given {
            Speed::Rpm(_) => Frequencies::RPM,
            Speed::Plain(_) | Speed::Radians(_) => Frequencies::RADIANS,
        };
        let speed = self.speed.or(self.both).unwrap_or(written);
        // Nobody counts vibrations by the minute, unless he says so.
        let usual = if speed == Frequencies::RPM { Frequencies::HERTZ } else { speed };
        Ok(Units { speed, frequency: self.frequency.or(self.both).unwrap_or(usual) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_finite_number_is_named_as_it_was_written() {
        for (text, says) in [
            ("nan:1:3", "`nan` is no speed: write a finite number"),
            ("0:nan:3", "`nan` is no speed"),
            ("0:inf", "`inf` is no speed"),
            ("0:1e400:3", "`1e400` is no speed"),
        ] {
            let message = Speeds::read(text).unwrap_err();
            assert!(message.starts_with(says), "{text}: {message}");
        }
        assert!(Speeds::read("0 rpm:20:5").is_ok_and(|speeds| matches!(speeds.to, Speed::Rpm(_))));
    }
}
