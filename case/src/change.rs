//! Changes that the program itself makes of a case: they have types, where those of `--set` are text.

use super::keys::Field;
use super::values::join;
use std::fmt;

/// A change of a case: the dotted path of a key, and what it is set to.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    pub(super) path: String,
    pub(super) to: Setting,
}

/// What a key is set to.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// A quantity in SI, or a number.
    Number(f64),
    /// An integer.
    Integer(i64),
    /// A boolean.
    Boolean(bool),
    /// The name of a choice.
    Name(&'static str),
    /// A kind, with some of its keys.
    Kind(&'static str, Vec<Key>),
}

/// A key of a table, and what it is set to.
pub type Key = (&'static str, Setting);

impl Change {
    /// A number of elements, functions or parts at a dotted path.
    pub(super) fn count(path: String, count: usize) -> Change {
        Change { path, to: count.into() }
    }
}

/// As on the command line.
impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}={}", self.path, self.to)
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Setting::Number(x) => write!(f, "{x:e}"),
            Setting::Integer(n) => write!(f, "{n}"),
            Setting::Boolean(value) => write!(f, "{value}"),
            Setting::Name(name) => f.write_str(name),
            Setting::Kind(kind, keys) => {
                write!(f, "{{kind='{kind}'")?;
                keys.iter().try_for_each(|(key, to)| write!(f, ",{key}={to}"))?;
                f.write_str("}")
            }
        }
    }
}

impl From<f64> for Setting {
    fn from(x: f64) -> Setting {
        Setting::Number(x)
    }
}

impl From<usize> for Setting {
    fn from(count: usize) -> Setting {
        Setting::Integer(count as i64)
    }
}

impl From<bool> for Setting {
    fn from(value: bool) -> Setting {
        Setting::Boolean(value)
    }
}

/// The type of a field that the program sets.
pub trait Settable {
    /// What it is set to.
    type Value: Into<Setting>;
}

impl Settable for f64 {
    type Value = f64;
}

impl Settable for usize {
    type Value = usize;
}

impl Settable for bool {
    type Value = bool;
}

impl<T: Settable> Settable for Option<T> {
    type Value = T::Value;
}

impl<T: Settable> Field<T> {
    /// The key, and what it is set to.
    pub fn to(&self, value: T::Value) -> Key {
        (self.key.name, value.into())
    }
}

impl<T> Field<T> {
    /// The change of a key of its table.
    pub fn change(&self, (key, to): Key) -> Change {
        Change { path: join(self.key.name, key), to }
    }

    /// The change to a kind with these keys, and the defaults of others.
    pub fn change_kind(&self, kind: &'static str, keys: Vec<Key>) -> Change {
        Change { path: self.key.name.to_owned(), to: Setting::Kind(kind, keys) }
    }
}
