//! Kinds and their makers: what a case may choose, and how the part of a model is made of it.

use super::declaration::{Entry, Key, Kinds};
use super::fault::{At, Fault, Faults, Made};
use super::places::{Parts, Place};
use super::sources::Files;
use super::values::{Value, Values};
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

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

    /// Name and bytes of the file at `key`.
    pub fn file<'v>(&self, v: &'v Values, key: &str) -> Made<(&'v str, Arc<[u8]>)> {
        let name = v.text(key)?;
        Ok((name, self.files.bytes(name).at(key)?))
    }

    /// The bodies and beams of the case.
    pub fn parts(&self) -> Made<&Parts> {
        self.parts.ok_or_else(Faults::default)
    }

    /// The place at `key`.
    pub fn place(&self, v: &Values, key: &str) -> Made<Place> {
        let found = self.parts()?.find(v.text(key)?);
        found.map_err(|fault| Faults::from(fault).within(key))
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

/// Makes a part of the model of the values of a table, whose own keys have no problem.
pub type Make<T> = fn(&Values, &Context<'_>) -> Made<T>;

/// One of the kinds of a choice: all that a case file, its documentation and the model need to know of it.
pub struct Kind<T: 'static> {
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
    /// Makes the part.
    pub make: Make<T>,
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
        let entry = |&Kind { name, summary, source, keys, example, .. }: &Kind<T>| Entry {
            name,
            summary,
            source,
            keys,
            example,
        };
        self.kinds.iter().map(entry).collect()
    }
}

impl<T> Choice<T> {
    /// The part that the key of a table chooses.
    pub fn make(&self, v: &Values, key: &str, c: &Context<'_>) -> Made<T> {
        let none = Values { sound: true, ..Values::default() };
        let (name, values) = match v.value(key)? {
            Value::Kind(entry, values) => (entry.name, values),
            Value::Text(name) => (name.as_str(), &none),
            _ => return Err(Values::misused(key, "no choice")),
        };
        let Some(kind) = self.kinds.iter().find(|kind| kind.name == name) else {
            return Err(Values::misused(key, "a choice among other kinds"));
        };
        if !values.sound {
            return Err(Faults::default());
        }
        (kind.make)(values, c).map_err(|faults| faults.within(key))
    }
}

/// A table of a case, or a list of such tables, and how a part of the model is made of it.
pub struct Table<T: 'static> {
    /// Name, keys and meaning: its type is a table or a list of tables.
    pub key: Key,
    /// How a case may write it: changes `KEY=VALUE` of a case, one a line, as on the command line.
    pub example: &'static str,
    /// Makes the part.
    pub make: Make<T>,
}

impl<T> Table<T> {
    /// The parts of all tables of this name: none, one, or those of a list.
    pub fn make(&self, v: &Values, c: &Context<'_>) -> Made<Vec<T>> {
        let name = self.key.name;
        let tables = match v.optional(name)? {
            None => return Ok(Vec::new()),
            Some(Value::Table(values)) => vec![(name.to_owned(), values)],
            Some(Value::Tables(list)) => {
                list.iter().enumerate().map(|(i, values)| (super::values::item(name, i), values)).collect()
            }
            Some(_) => return Err(Values::misused(name, "no table")),
        };
        let (mut parts, mut faults) = (Vec::new(), Faults::default());
        let mut whole = true;
        for (path, values) in tables {
            let made = if values.sound { (self.make)(values, c) } else { Err(Faults::default()) };
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
