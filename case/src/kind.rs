//! Kinds and their makers: what a case may choose, and how the part of a model is made of it.

use super::declaration::{Entry, Key, Kinds, Presence, Type};
use super::fault::{Fault, Faults, Made};
use super::places::Parts;
use super::sources::Files;
use super::values::{Value, Values};
use crate::laws::Signals;
use std::cell::RefCell;
use std::fmt;

/// What a maker knows of the rest of the case.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// Length of the beam \[m\]; `None` if it has a problem of its own.
    pub length: Option<f64>,
    /// Duration of the run \[s\]; `None` if it has a problem of its own.
    pub duration: Option<f64>,
    /// The bodies and beams of the case; `None` if one of them has a problem of its own.
    pub parts: Option<&'a Parts>,
    /// The files that the case names.
    pub files: &'a Files<'a>,
    /// What the reader of a case should know of its parts.
    pub cautions: &'a RefCell<Vec<String>>,
    /// What laws of a program command.
    pub(crate) signals: &'a Signals,
}

impl Context<'_> {
    /// Length of the beam \[m\].
    pub fn length(&self) -> Made<f64> {
        self.length.ok_or_else(Faults::default)
    }

    /// Duration of the run \[s\].
    pub fn duration(&self) -> Made<f64> {
        self.duration.ok_or_else(Faults::default)
    }

    /// The bodies and beams of the case.
    pub fn parts(&self) -> Made<&Parts> {
        self.parts.ok_or_else(Faults::default)
    }

    /// Whether a station lies on the beam.
    pub fn on_beam(&self, station: f64, key: &str) -> Made<()> {
        match self.length {
            Some(length) if station > length => {
                let message =
                    format!("the station {station} m lies beyond the end of the beam at {length} m");
                Err(Fault::new(key, message).into())
            }
            _ => Ok(()),
        }
    }
}

/// A table whose keys are the fields of a type.
pub trait Keys: Sized {
    /// The keys.
    const KEYS: &'static [Key];

    /// The fields of the values of a table.
    ///
    /// # Errors
    /// The faults of all fields.
    fn read(v: &Values, c: &Context<'_>) -> Made<Self>;
}

/// Makes a part of the model of a table, whose own keys have no problem.
pub trait Maker<T>: Sync {
    /// The keys of the table.
    fn keys(&self) -> &'static [Key];

    /// The part.
    ///
    /// # Errors
    /// What is wrong with the table, at paths within it.
    fn make(&self, v: &Values, c: &Context<'_>) -> Made<T>;
}

/// Makes a part of the keys of a table.
pub struct Of<K, T>(pub fn(K, &Context<'_>) -> Made<T>);

impl<K: Keys, T> Maker<T> for Of<K, T> {
    fn keys(&self) -> &'static [Key] {
        K::KEYS
    }

    fn make(&self, v: &Values, c: &Context<'_>) -> Made<T> {
        K::read(v, c).and_then(|keys| (self.0)(keys, c))
    }
}

/// No keys.
pub struct Nothing;

impl Keys for Nothing {
    const KEYS: &'static [Key] = &[];

    fn read(_: &Values, _: &Context<'_>) -> Made<Nothing> {
        Ok(Nothing)
    }
}

/// A part that needs no keys.
pub struct Is<T>(pub T);

impl<T: Clone + Sync> Maker<T> for Is<T> {
    fn keys(&self) -> &'static [Key] {
        &[]
    }

    fn make(&self, _: &Values, _: &Context<'_>) -> Made<T> {
        Ok(self.0.clone())
    }
}

/// One of the kinds of a choice: all that a case file, its documentation and the model need to know of it.
pub struct Kind<T: 'static> {
    /// Name in a case file.
    pub name: &'static str,
    /// One line on what it is.
    pub summary: &'static str,
    /// Where it comes from: authors, year, DOI; empty for what needs no source.
    pub source: &'static str,
    /// How a case may choose it: changes `KEY=VALUE` of a case, one a line, as on the command line.
    pub example: &'static str,
    /// Makes the part, of its keys besides `kind`.
    pub make: &'static dyn Maker<T>,
}

/// A place in a case where one of several kinds is chosen.
pub struct Choice<T: 'static> {
    /// What is chosen, e.g. `integrator`.
    pub name: &'static str,
    /// Where it stands in a case, e.g. `hub.motion`.
    pub path: &'static str,
    /// One line on what it decides.
    pub summary: &'static str,
    /// The kinds.
    pub kinds: &'static [Kind<T>],
}

impl<T> fmt::Debug for Choice<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

impl<T> Kinds for Choice<T> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn path(&self) -> &'static str {
        self.path
    }

    fn summary(&self) -> &'static str {
        self.summary
    }

    fn kinds(&self) -> Vec<Entry> {
        let entry = |&Kind { name, summary, source, example, make }: &Kind<T>| Entry {
            name,
            summary,
            source,
            keys: make.keys(),
            example,
        };
        self.kinds.iter().map(entry).collect()
    }
}

impl<T> Choice<T> {
    /// The part that a value chooses.
    ///
    /// # Errors
    /// What its maker refuses, at paths within the value; nothing, if the value has a problem that is reported already.
    pub fn make(&self, value: &Value, c: &Context<'_>) -> Made<T> {
        let none = Values { sound: true, ..Values::default() };
        let (name, values) = match value {
            Value::Kind(entry, values) => (entry.name, values),
            Value::Text(name) => (name.as_str(), &none),
            _ => return Err(Faults::default()),
        };
        let kind = self.kinds.iter().find(|kind| kind.name == name).ok_or_else(Faults::default)?;
        kind.make.make(values, c)
    }

    /// The name of what a value chooses.
    pub fn named(&self, value: &Value) -> &'static str {
        match value {
            Value::Kind(entry, _) => entry.name,
            Value::Text(name) => {
                self.kinds.iter().find(|kind| kind.name == name).map_or("", |kind| kind.name)
            }
            _ => "",
        }
    }
}

/// A table of a case, or a list of such tables, and how a part of the model is made of it.
pub struct Table<T: 'static> {
    /// Name, keys and meaning: its type is a table or a list of tables.
    pub key: Key,
    /// How a case may write it: changes `KEY=VALUE` of a case, one a line, as on the command line.
    pub example: &'static str,
    /// Makes the part.
    pub make: &'static dyn Maker<T>,
}

impl<T> Table<T> {
    /// A list of tables.
    pub const fn list<K: Keys>(
        name: &'static str,
        doc: &'static str,
        example: &'static str,
        make: &'static Of<K, T>,
    ) -> Table<T> {
        let key = Key { name, takes: Type::Tables(K::KEYS), presence: Presence::Empty, doc };
        Table { key, example, make }
    }

    /// One table, which may be left out.
    pub const fn one<K: Keys>(
        name: &'static str,
        doc: &'static str,
        example: &'static str,
        make: &'static Of<K, T>,
    ) -> Table<T> {
        let key = Key { name, takes: Type::Table(K::KEYS), presence: Presence::Optional, doc };
        Table { key, example, make }
    }

    /// The values of all tables of this name, and what each is called: none, one, or those of a list.
    pub fn tables_in<'v>(&self, v: &'v Values) -> Vec<(String, &'v Values)> {
        let name = self.key.name;
        match v.get(name).map(|filled| &filled.value) {
            Some(Value::Table(values)) => vec![(name.to_owned(), values)],
            Some(Value::Tables(list)) => {
                list.iter().enumerate().map(|(i, values)| (super::values::item(name, i), values)).collect()
            }
            _ => Vec::new(),
        }
    }

    /// The parts of all tables of this name.
    ///
    /// # Errors
    /// The faults of all makers, at paths of the case.
    pub fn make(&self, v: &Values, c: &Context<'_>) -> Made<Vec<T>> {
        let (mut parts, mut faults) = (Vec::new(), Faults::default());
        let mut whole = true;
        for (path, values) in self.tables_in(v) {
            let made = self.make.make(values, c);
            match made {
                Ok(part) => parts.push(part),
                Err(more) => {
                    whole = false;
                    faults.0.extend(more.within(&path).0);
                }
            }
        }
        if whole { Ok(parts) } else { Err(faults) }
    }
}
