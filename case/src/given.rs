//! The values of a case, one by one, as a form shows them.

use super::declaration::{Key, Type};
use super::problem::Place;
use super::reading::Reading;
use super::resolved;
use super::values::{Value, Values, item, join};

/// A value of a case.
#[derive(Clone, Debug)]
pub struct Given<'r> {
    /// Dotted path of its key, by which it can be changed.
    pub path: String,
    /// The declaration of the key.
    pub key: &'static Key,
    /// The value as TOML, in SI without its unit; of a kind its name, and nothing of a table.
    pub value: String,
    /// The value of a number, in SI.
    pub number: Option<f64>,
    /// Where it was written; `None` for a default.
    pub place: Option<&'r Place>,
    /// What was written there.
    pub written: Option<&'r str>,
}

impl Given<'_> {
    /// Whether it is a table, or a list of such, whose values follow.
    pub(super) fn is_table(&self) -> bool {
        matches!(self.key.takes, Type::Table(_) | Type::Tables(_))
    }

    /// Whether it is the kind of a table.
    pub(super) fn is_kind(&self) -> bool {
        matches!(self.key.takes, Type::Kind(_))
    }
}

impl Reading {
    /// The values of the case as it is spelled, defaults included; tables stand before what is in them.
    pub fn given(&self) -> Vec<Given<'_>> {
        let mut out = Vec::new();
        push(self.written(), "", &mut out);
        for given in &mut out {
            let written = given
                .place
                .and_then(|place| self.sources().get(place.source)?.text.get(place.start..place.end));
            given.written = written.filter(|_| !given.is_table() && !given.is_kind());
        }
        out
    }
}

fn push<'r>(values: &'r Values, path: &str, out: &mut Vec<Given<'r>>) {
    for filled in &values.entries {
        let path = join(path, filled.key.name);
        let number = match &filled.value {
            Value::Number(value) => Some(*value),
            Value::Integer(value) => Some(*value as f64),
            _ => None,
        };
        let value = match &filled.value {
            Value::Kind(kind, _) => kind.name.to_owned(),
            value => resolved::written(value, &filled.key.takes, false),
        };
        let place = filled.place.as_ref();
        out.push(Given { path: path.clone(), key: filled.key, value, number, place, written: None });
        match &filled.value {
            Value::Table(values) | Value::Kind(_, values) => push(values, &path, out),
            Value::Tables(list) => {
                for (number, values) in list.iter().enumerate() {
                    push(values, &item(&path, number), out);
                }
            }
            _ => {}
        }
    }
}
