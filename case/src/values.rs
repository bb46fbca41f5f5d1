//! A case as read: typed values in SI, each with the place where it was written.

use super::declaration::{Entry, Key};
use super::fault::{Fault, Faults, Made};
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

/// Typed access. A key that is not declared, or not of this type, is a mistake in the maker that asks for it; it is
/// reported as such.
macro_rules! typed {
    ($($name:ident $type:ty: $pattern:pat => $value:expr, $what:literal;)*) => {
        $(#[doc = concat!("The ", $what, " of a key.")]
        pub fn $name(&self, name: &str) -> Made<$type> {
            match self.value(name)? {
                $pattern => Ok($value),
                _ => Err(Values::misused(name, concat!("no ", $what))),
            }
        })*
    };
}

impl Values {
    fn get(&self, name: &str) -> Option<&Filled> {
        self.entries.iter().find(|filled| filled.key.name == name)
    }

    /// Whether a key has a value.
    pub(super) fn has(&self, name: &str) -> bool {
        self.get(name).is_some()
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

    /// What a maker gets that asks for a key in a way in which it is not declared.
    pub(super) fn misused(name: &str, what: &str) -> Faults {
        Fault::new("", format!("this is a mistake in the program: the key `{name}` is {what}")).into()
    }

    /// The value of a key that may be left out.
    pub(super) fn optional(&self, name: &str) -> Made<Option<&Value>> {
        if self.keys.iter().all(|key| key.name != name) {
            return Err(Values::misused(name, "not declared"));
        }
        Ok(self.get(name).map(|filled| &filled.value))
    }

    /// The value of a key that has one, if it has no problem.
    pub(super) fn value(&self, name: &str) -> Made<&Value> {
        match self.optional(name)? {
            Some(value) => Ok(value),
            None if self.keys.iter().any(|key| key.name == name && key.presence.is_optional()) => {
                Err(Values::misused(name, "one that may be left out"))
            }
            None => Err(Faults::default()),
        }
    }

    typed! {
        number f64: Value::Number(value) => *value, "number";
        numbers &[f64]: Value::Numbers(values) => values, "list of numbers";
        integer i64: Value::Integer(value) => *value, "integer";
        boolean bool: Value::Boolean(value) => *value, "boolean";
        text &str: Value::Text(value) => value, "text";
        texts &[String]: Value::Texts(values) => values, "list of texts";
        table &Values: Value::Table(values) => values, "table";
    }

    /// The count of a key.
    pub fn count(&self, name: &str) -> Made<usize> {
        usize::try_from(self.integer(name)?).map_err(|_| Values::misused(name, "no count"))
    }

    /// The name of the kind of a key.
    pub fn kind(&self, name: &str) -> Option<&'static str> {
        match self.get(name)?.value {
            Value::Kind(entry, _) => Some(entry.name),
            _ => None,
        }
    }

    /// The number of a key that may be left out.
    pub fn optional_number(&self, name: &str) -> Made<Option<f64>> {
        self.optional(name)?.map(|_| self.number(name)).transpose()
    }

    /// The text of a key that may be left out.
    pub fn optional_text(&self, name: &str) -> Made<Option<&str>> {
        self.optional(name)?.map(|_| self.text(name)).transpose()
    }

    /// The boolean of a key that may be left out.
    pub fn optional_boolean(&self, name: &str) -> Made<Option<bool>> {
        self.optional(name)?.map(|_| self.boolean(name)).transpose()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::declaration::{Bound, Presence, Type, key};

    static KEYS: [Key; 2] = [
        key("given", Type::Number(Bound::Any), Presence::Required, ""),
        key("open", Type::Number(Bound::Any), Presence::Optional, ""),
    ];

    #[test]
    fn a_key_that_is_asked_for_otherwise_than_declared_is_reported_as_a_mistake_in_the_program() {
        let filled = Filled { key: &KEYS[0], value: Value::Number(2.0), place: None };
        let values = Values { keys: &KEYS, entries: vec![filled], sound: true, place: None };
        assert_eq!((values.number("given"), values.optional_number("open")), (Ok(2.0), Ok(None)));
        for (found, words) in [
            (values.number("gvien"), "the key `gvien` is not declared"),
            (values.optional_number("oepn").map(|_| 0.0), "the key `oepn` is not declared"),
            (values.integer("given").map(|_| 0.0), "the key `given` is no integer"),
            (values.number("open"), "the key `open` is one that may be left out"),
        ] {
            let message = found.unwrap_err().to_string();
            assert!(message.contains("mistake in the program") && message.contains(words), "{message}");
        }
    }
}
