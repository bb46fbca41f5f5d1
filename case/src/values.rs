//! A case as read: typed values in SI, each with the place where it was written.

use super::declaration::{Entry, Key};
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
    /// Texts.
    Texts(Vec<String>),
    /// A table.
    Table(Values),
    /// A list of tables.
    Tables(Vec<Values>),
    /// A table of a kind.
    Kind(Entry, Values),
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
    /// The keys that are declared.
    pub keys: &'static [Key],
    /// The values.
    pub entries: Vec<Filled>,
    /// Whether each of its own keys has a value or may be left out.
    pub sound: bool,
}

impl Values {
    /// The value of a key with its place, if it has one.
    pub(super) fn get(&self, name: &str) -> Option<&Filled> {
        self.entries.iter().find(|filled| filled.key.name == name)
    }

    /// The same without defaults.
    pub(super) fn written(&self) -> Values {
        let written = |filled: &Filled| {
            let value = match &filled.value {
                Value::Table(values) => Value::Table(values.written()),
                Value::Tables(list) => Value::Tables(list.iter().map(Values::written).collect()),
                Value::Kind(kind, values) => Value::Kind(*kind, values.written()),
                value => value.clone(),
            };
            filled.place.is_some().then(|| Filled { value, ..filled.clone() })
        };
        Values { entries: self.entries.iter().filter_map(written).collect(), ..self.clone() }
    }

    /// Whether a key is written, and not a default or an empty list.
    pub(super) fn is_written(&self, name: &str) -> bool {
        self.get(name).is_some_and(|filled| {
            let empty = match &filled.value {
                Value::Numbers(list) => list.is_empty(),
                Value::Texts(list) => list.is_empty(),
                _ => false,
            };
            filled.place.is_some() && !empty
        })
    }

    /// The table at a key, whether it is of a kind or not.
    pub(super) fn inner(&self, name: &str) -> Option<&Values> {
        let (name, number) = match name.strip_suffix(']').and_then(|name| name.split_once('[')) {
            Some((name, number)) => (name, number.parse::<usize>().ok()?.checked_sub(1)?),
            None => (name, 0),
        };
        match &self.get(name)?.value {
            Value::Table(values) | Value::Kind(_, values) => Some(values),
            Value::Tables(list) => list.get(number),
            _ => None,
        }
    }

    /// The key of this name whose value was written in a source.
    #[cfg(feature = "sweep")]
    pub(super) fn set_by(&self, source: usize, name: &str) -> Option<&Filled> {
        self.entries.iter().find_map(|filled| {
            let within = match &filled.value {
                Value::Table(values) | Value::Kind(_, values) => values.set_by(source, name),
                Value::Tables(list) => list.iter().find_map(|values| values.set_by(source, name)),
                _ => None,
            };
            let is_set = filled.place.as_ref().is_some_and(|place| place.source == source);
            within.or((is_set && filled.key.name == name).then_some(filled))
        })
    }

    /// Where the value at a dotted path was written, or else the innermost table around it; with the text, if it is one.
    pub(super) fn find(&self, path: &str) -> (Option<Place>, Option<&str>) {
        let (mut place, mut text, mut table) = (self.place.clone(), None, Some(self));
        for part in path.split('.') {
            let Some(values) = table else { break };
            if let Some(filled) = values.get(part) {
                place = filled.place.clone().or(place);
                text = if let Value::Text(text) = &filled.value { Some(text.as_str()) } else { None };
            }
            table = values.inner(part);
            place = table.and_then(|table| table.place.clone()).or(place);
        }
        (place, text)
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
                Value::Texts(values) => values.clone().into(),
                Value::Table(_) | Value::Tables(_) | Value::Kind(..) => return None,
            };
            Some((filled.key.name.to_owned(), value))
        };
        self.entries.iter().filter_map(plain).collect()
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
