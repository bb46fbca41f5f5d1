//! Where a model puts its recorded quantities: name, unit, role and value at one place.

use std::borrow::Cow;

/// One recorded quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channel {
    /// Column name, e.g. `tip.deflection`.
    pub name: String,
    /// SI unit, e.g. `m`; empty for a pure number.
    pub unit: Cow<'static, str>,
    /// One line for people: what it is.
    pub meaning: String,
    /// What it is to its readers.
    pub role: Role,
    /// What kind of number it is.
    pub kind: Kind,
}

/// What kind of number a recorded quantity is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Kind {
    /// Any real number.
    #[default]
    Real,
    /// Never negative, e.g. a force that only presses.
    NonNegative,
    /// One of four consecutive components (w, x, y, z) of a unit quaternion, which has the same meaning with the other sign.
    Quaternion,
    /// Gap of a contact \[m\].
    Gap,
    /// Displacement across the axis of a beam in the plane \[m\]: zero while the beam stays straight.
    Deflection,
    /// Kinetic energy \[J\].
    KineticEnergy,
    /// Strain energy \[J\].
    StrainEnergy,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 7] = [
        Kind::Real,
        Kind::NonNegative,
        Kind::Quaternion,
        Kind::Gap,
        Kind::Deflection,
        Kind::KineticEnergy,
        Kind::StrainEnergy,
    ];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Real => "real",
            Kind::NonNegative => "non-negative",
            Kind::Quaternion => "quaternion",
            Kind::Gap => "gap",
            Kind::Deflection => "deflection",
            Kind::KineticEnergy => "kinetic-energy",
            Kind::StrainEnergy => "strain-energy",
        }
    }
}

impl Channel {
    /// A quantity of this role, name, unit and meaning.
    pub fn new(
        role: Role,
        name: impl Into<String>,
        unit: impl Into<Cow<'static, str>>,
        meaning: impl Into<String>,
    ) -> Channel {
        Channel { name: name.into(), unit: unit.into(), meaning: meaning.into(), role, kind: Kind::Real }
    }

    /// The same quantity of another kind.
    #[must_use]
    pub fn with_kind(self, kind: Kind) -> Channel {
        Channel { kind, ..self }
    }
}

/// What a recorded quantity is to its readers: which are added up, drawn and printed follows from this, not from names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Role {
    /// One of the few that most readers look for: drawn in the figure of a run, and printed after it.
    Primary,
    /// Printed after a run.
    Secondary,
    /// Only recorded, e.g. at a station.
    #[default]
    Detail,
    /// A part of the total energy \[J\]: all parts together are [`Energy::total`](super::Energy::total).
    Energy,
    /// The total energy, work, or a loss \[J\].
    Work,
    /// Error of the energy balance, E(t) − E(0) − work + losses \[J\]: zero if exact.
    Imbalance,
    /// Describes the time integration, not the motion.
    Integration,
}

impl Role {
    /// All roles.
    pub const ALL: [Role; 7] = [
        Role::Primary,
        Role::Secondary,
        Role::Detail,
        Role::Energy,
        Role::Work,
        Role::Imbalance,
        Role::Integration,
    ];

    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Role::Primary => "primary",
            Role::Secondary => "secondary",
            Role::Detail => "detail",
            Role::Energy => "energy",
            Role::Work => "work",
            Role::Imbalance => "imbalance",
            Role::Integration => "integration",
        }
    }
}

/// Takes the recorded quantities of a model one after another: a row takes their values, a list of channels what they are.
/// A row asks for no name, so that recording allocates nothing.
#[derive(Debug)]
pub struct Sink<'a>(Taken<'a>);

#[derive(Debug)]
enum Taken<'a> {
    Values(std::slice::IterMut<'a, f64>),
    Channels(&'a mut Vec<Channel>),
}

impl<'a> Sink<'a> {
    /// Writes values into a row; those behind its end are left out.
    pub fn row(row: &'a mut [f64]) -> Sink<'a> {
        Sink(Taken::Values(row.iter_mut()))
    }

    /// Collects what the quantities are.
    pub fn channels(list: &'a mut Vec<Channel>) -> Sink<'a> {
        Sink(Taken::Channels(list))
    }

    /// Takes a quantity: its value, and a function that says what it is.
    #[inline]
    pub fn put(&mut self, value: f64, channel: impl FnOnce() -> Channel) {
        match &mut self.0 {
            Taken::Values(row) => row.next().into_iter().for_each(|out| *out = value),
            Taken::Channels(list) => list.push(channel()),
        }
    }

    /// Takes quantities that differ by one word, e.g. the components of a vector.
    #[inline]
    pub fn put_all<const N: usize>(
        &mut self,
        values: [f64; N],
        words: [&'static str; N],
        channel: impl Fn(&'static str) -> Channel,
    ) {
        for (value, word) in values.into_iter().zip(words) {
            self.put(value, || channel(word));
        }
    }
}
