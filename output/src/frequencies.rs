//! Units of frequencies and speeds.

/// In what frequencies and speeds are written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frequencies {
    /// Name of the unit, empty for a pure number.
    pub name: &'static str,
    /// Number of units in one rad/s.
    pub factor: f64,
}

impl Frequencies {
    /// rad/s
    pub const RADIANS: Frequencies = Frequencies { name: "rad/s", factor: 1.0 };
    /// Hz
    pub const HERTZ: Frequencies = Frequencies { name: "Hz", factor: 1.0 / std::f64::consts::TAU };
    /// Revolutions a minute.
    pub const RPM: Frequencies = Frequencies { name: "rpm", factor: 60.0 / std::f64::consts::TAU };

    /// Multiples of 1/τ, τ in s.
    pub fn dimensionless(time: f64) -> Frequencies {
        Frequencies { name: "", factor: time }
    }

    /// A frequency in rad/s with its unit.
    pub fn text(&self, frequency: f64) -> String {
        format!("{:.6} {}", frequency * self.factor, self.name).trim_end().to_owned()
    }

    /// The name of a column of such numbers.
    pub(crate) fn column(&self, name: &str) -> String {
        if self.name.is_empty() { name.to_owned() } else { format!("{name} [{}]", self.name) }
    }
}
