//! A case as read: typed values in SI, each with the place where it was written.

use super::declaration::{Key, Kind};
use super::problem::Place;

/// The value of a key.
#[derive(Clone, Debug)]
pub enum Value {
    /// A quantity in SI, or a number.
    Number(f64),
    /// Quantities in SI.
    Numbers(Vec<f64>),
    /// An integer.
    Integer(i64),
    /// A boolean.
    Boolean(bool),
    /// A text, a path or the name of a choice.
    Text(String),
    /// A table.
    Table(Values),
    /// A list of tables.
    Tables(Vec<Values>),
    /// A table of a kind.
    Kind(&'static Kind, Values),
}

/// A value and where it comes from.
#[derive(Clone, Debug)]
pub struct Filled {
    /// The declaration.
    pub key: &'static Key,
    /// The value.
    pub value: Value,
    /// Where the value was written; `None` for a default.
    pub place: Option<Place>,
}

/// The values of a table, in the order of its declaration; those with problems are missing.
#[derive(Clone, Debug, Default)]
pub struct Values {
    /// Where the table was written; `None` if it was left out.
    pub place: Option<Place>,
    /// The values.
    pub entries: Vec<Filled>,
}

impl Values {
    fn get(&self, name: &str) -> Option<&Filled> {
        self.entries.iter().find(|filled| filled.key.name == name)
    }

    /// The number of a key.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)?.value {
            Value::Number(value) => Some(value),
            _ => None,
        }
    }

    /// The numbers of a key.
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match &self.get(name)?.value {
            Value::Numbers(values) => Some(values),
            _ => None,
        }
    }

    /// The integer of a key.
    pub fn integer(&self, name: &str) -> Option<i64> {
        match self.get(name)?.value {
            Value::Integer(value) => Some(value),
            _ => None,
        }
    }

    /// The count of a key.
    pub fn count(&self, name: &str) -> Option<usize> {
        usize::try_from(self.integer(name)?).ok()
    }

    /// The boolean of a key.
    pub fn boolean(&self, name: &str) -> Option<bool> {
        match self.get(name)?.value {
            Value::Boolean(value) => Some(value),
            _ => None,
        }
    }

    /// The text of a key.
    pub fn text(&self, name: &str) -> Option<&str> {
        match &self.get(name)?.value {
            Value::Text(value) => Some(value),
            _ => None,
        }
    }

    /// The table of a key.
    pub fn table(&self, name: &str) -> Option<&Values> {
        match &self.get(name)?.value {
            Value::Table(values) => Some(values),
            _ => None,
        }
    }

    /// The tables of a list.
    pub fn tables(&self, name: &str) -> &[Values] {
        match self.get(name).map(|filled| &filled.value) {
            Some(Value::Tables(values)) => values,
            _ => &[],
        }
    }

    /// The kind of a key and its table.
    pub fn kind(&self, name: &str) -> Option<(&'static Kind, &Values)> {
        match &self.get(name)?.value {
            Value::Kind(kind, values) => Some((kind, values)),
            _ => None,
        }
    }

    /// Where the value of a key was written, or else the table.
    pub fn place(&self, name: &str) -> Option<Place> {
        self.get(name).and_then(|filled| filled.place.clone()).or_else(|| self.place.clone())
    }

    /// The values of the plain keys.
    pub(super) fn to_json(&self) -> serde_json::Map<String, serde_json::Value> {
        let plain = |filled: &Filled| {
            let value = match &filled.value {
                Value::Number(value) => (*value).into(),
                Value::Numbers(values) => values.clone().into(),
                Value::Integer(value) => (*value).into(),
                Value::Boolean(value) => (*value).into(),
                Value::Text(value) => value.as_str().into(),
                Value::Table(_) | Value::Tables(_) | Value::Kind(..) => return None,
            };
            Some((filled.key.name.to_owned(), value))
        };
        self.entries.iter().filter_map(plain).collect()
    }

    /// The defaults in force, as dotted path and value.
    pub(super) fn defaults(&self, path: &str, out: &mut Vec<(String, String)>) {
        for filled in &self.entries {
            let path = join(path, filled.key.name);
            match &filled.value {
                Value::Table(values) => values.defaults(&path, out),
                Value::Tables(list) => {
                    for (number, values) in list.iter().enumerate() {
                        values.defaults(&item(&path, number), out);
                    }
                }
                Value::Kind(kind, values) => {
                    if filled.place.is_none() {
                        out.push((join(&path, "kind"), kind.name.to_owned()));
                    }
                    values.defaults(&path, out);
                }
                _ if filled.place.is_some() => {}
                value => out.push((path, super::resolved::written(value, &filled.key.takes, true))),
            }
        }
    }
}

/// A dotted path.
pub(super) fn join(path: &str, name: &str) -> String {
    if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") }
}

/// The path of table `number`, from 0, of a list.
pub(super) fn item(path: &str, number: usize) -> String {
    format!("{path}[{}]", number + 1)
}
