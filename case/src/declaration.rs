//! What a declaration of a key or a kind says.
//!
//! From it come the reading with its messages, the listing, the JSON Schema and the
//! resolved case.

use super::units::Measure;

/// Limits of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// Any finite number.
    Any,
    /// x > 0
    Positive,
    /// x ≥ 0
    NotNegative,
    /// low ≤ x ≤ high
    Between(f64, f64),
}

impl Bound {
    /// Whether `x` is within the limits.
    pub fn admits(self, x: f64) -> bool {
        match self {
            Bound::Any => true,
            Bound::Positive => x > 0.0,
            Bound::NotNegative => x >= 0.0,
            Bound::Between(low, high) => (low..=high).contains(&x),
        }
    }

    /// The limits in words: "positive".
    pub fn words(self) -> String {
        match self {
            Bound::Any => "finite".to_owned(),
            Bound::Positive => "positive".to_owned(),
            Bound::NotNegative => "zero or positive".to_owned(),
            Bound::Between(low, high) => format!("from {} to {}", short(low), short(high)),
        }
    }
}

/// A number with at most four decimals, for people.
pub fn short(x: f64) -> String {
    if x != 0.0 && !(1e-3..1e6).contains(&x.abs()) {
        return format!("{x:e}");
    }
    ((x * 1e4).round() / 1e4).to_string()
}

/// What a key takes.
#[derive(Clone, Copy, Debug)]
pub enum Type {
    /// A number with a dimension.
    Quantity(&'static Measure, Bound),
    /// A place: a body, a beam or a station of it, as [`crate::places`] describes.
    Place,
    /// A place, or a list of places.
    Places,
    /// A number with a dimension, or a list of such numbers.
    Moment(&'static Measure),
    /// A list of numbers with a dimension.
    Quantities(&'static Measure, Bound),
    /// A number without dimension.
    Number(Bound),
    /// An integer of a range, ends included.
    Integer(i64, i64),
    /// `true` or `false`.
    Boolean,
    /// Any text.
    Text,
    /// A list of texts.
    Texts,
    /// A path, relative to the folder of the case.
    Path,
    /// One of some names.
    Choice(&'static dyn Kinds),
    /// A table with the given keys.
    Table(&'static [Key]),
    /// A list of tables with the given keys: `[[force]]`.
    Tables(&'static [Key]),
    /// A table whose `kind` decides which keys it has.
    Kind(&'static dyn Kinds),
}

/// What happens when a key is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presence {
    /// It is a problem.
    Required,
    /// There is no value.
    Optional,
    /// There is no value, and no run: modes and diagrams do without.
    Run,
    /// This number.
    Number(f64),
    /// This integer.
    Integer(i64),
    /// This boolean.
    Boolean(bool),
    /// This name: of a choice, or of a kind with all its defaults.
    Name(&'static str),
    /// A table or list without entries, whose keys then take their defaults.
    Empty,
}

impl Presence {
    /// Whether a key that is left out has no value.
    pub fn is_optional(self) -> bool {
        matches!(self, Presence::Optional | Presence::Run)
    }
}

/// A key of a table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Name, kebab-case.
    pub name: &'static str,
    /// What it takes.
    pub takes: Type,
    /// What happens when it is left out.
    pub presence: Presence,
    /// One line on what it means.
    pub doc: &'static str,
}

/// A kind as declared, without its maker.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Name in a case file.
    pub name: &'static str,
    /// One line on what it is.
    pub summary: &'static str,
    /// Where it comes from: authors, year, DOI; empty for what needs no source.
    pub source: &'static str,
    /// Its keys, besides `kind`.
    pub keys: &'static [Key],
    /// How a case may choose it: changes `KEY=VALUE` of a case, one a line, as on the command line.
    pub example: &'static str,
}

/// A place in a case where one of several kinds is chosen.
pub trait Kinds: Sync + std::fmt::Debug {
    /// What is chosen, e.g. `integrator`.
    fn name(&self) -> &'static str;

    /// Where it stands in a case, e.g. `hub.motion`.
    fn path(&self) -> &'static str;

    /// One line on what it decides.
    fn summary(&self) -> &'static str;

    /// The kinds.
    fn kinds(&self) -> Vec<Entry>;

    /// The kind of this name.
    fn kind(&self, name: &str) -> Option<Entry> {
        self.kinds().into_iter().find(|kind| kind.name == name)
    }

    /// The names of the kinds: "`a`, `b`, `c`".
    fn names(&self) -> String {
        listed(self.kinds().iter().map(|kind| kind.name))
    }
}

/// Names between backticks, with commas.
pub fn listed<'n>(names: impl Iterator<Item = &'n str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
