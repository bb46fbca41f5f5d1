//! Units of frequencies and speeds.

/// Most decimals of a number.
const MOST: usize = 20;

/// In what frequencies and speeds are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// Name of the unit, empty for a pure number.
    pub name: &'static str,
    /// Number of units in one rad/s.
    pub factor: f64,
}

/// The units of speeds and of frequencies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Units {
    /// Of speeds of rotation.
    pub speed: Frequencies,
    /// Of frequencies of vibration.
    pub frequency: Frequencies,
}

impl Frequencies {
    /// rad/s
    pub const RADIANS: Frequencies = Frequencies { name: "rad/s", factor: 1.0 };
    /// Hz
    pub const HERTZ: Frequencies = Frequencies { name: "Hz", factor: 1.0 / std::f64::consts::TAU };
    /// Revolutions a minute.
    pub const RPM: Frequencies = Frequencies { name: "rpm", factor: 60.0 / std::f64::consts::TAU };

    /// The unit of this name: `rad/s`, `Hz` or `rpm`.
    pub fn named(name: &str) -> Option<Frequencies> {
        [Frequencies::RADIANS, Frequencies::HERTZ, Frequencies::RPM]
            .into_iter()
            .find(|unit| unit.name == name)
    }

    /// Multiples of 1/τ, τ in s.
    pub fn dimensionless(time: f64) -> Frequencies {
        Frequencies { name: "", factor: time }
    }

    /// A frequency in rad/s: six decimals, and six digits of a small one.
    pub fn number(&self, frequency: f64) -> String {
        let value = frequency * self.factor;
        let whole = libm::log10(value.abs()).floor();
        let decimals = if whole < -1.0 && whole.is_finite() { 5 - whole as i32 } else { 6 };
        format!("{value:.*}", usize::try_from(decimals).unwrap_or(6).min(MOST))
    }

    /// The same with its unit.
    pub fn text(&self, frequency: f64) -> String {
        format!("{} {}", self.number(frequency), self.name).trim_end().to_owned()
    }

    /// The same with five digits, for headings and messages.
    pub fn short(&self, frequency: f64) -> String {
        let value = frequency * self.factor;
        let whole = libm::log10(value.abs().max(1.0)).floor() as usize + 1;
        format!("{value:.*} {}", 5_usize.saturating_sub(whole), self.name).trim_end().to_owned()
    }

    /// The name of a column of such numbers.
    pub(crate) fn column(&self, name: &str) -> String {
        if self.name.is_empty() { name.to_owned() } else { format!("{name} [{}]", self.name) }
    }
}
