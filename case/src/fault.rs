//! What a maker finds wrong: each fault at its key.

use std::fmt::Display;
use std::ops::Range;

/// What is wrong with the value of a key.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Fault {
    /// Dotted path of the key within the table of the maker; empty for the table itself.
    pub key: String,
    /// What is wrong, in one sentence.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// The bytes of a text that are to blame.
    pub span: Option<Range<usize>>,
}

impl Fault {
    /// A fault at `key`.
    pub fn new(key: impl Into<String>, message: impl Into<String>) -> Fault {
        Fault { key: key.into(), message: message.into(), ..Fault::default() }
    }

    /// Adds a line of advice.
    pub fn help(mut self, help: impl Into<String>) -> Fault {
        self.help = Some(help.into());
        self
    }
}

/// All faults that a maker finds. Empty when a value that it needs has a problem of its own, which is reported already.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faults(pub Vec<Fault>);

impl From<Fault> for Faults {
    fn from(fault: Fault) -> Faults {
        Faults(vec![fault])
    }
}

impl Faults {
    /// The same faults, of a table that stands at `key`.
    pub fn within(mut self, key: &str) -> Faults {
        for fault in &mut self.0 {
            fault.key = if fault.key.is_empty() { key.to_owned() } else { format!("{key}.{}", fault.key) };
        }
        self
    }
}

/// What a maker gives.
pub type Made<T> = Result<T, Faults>;

/// Errors of constructors as faults.
pub trait At<T> {
    /// The value, or the error as a fault at `key`.
    fn at(self, key: &str) -> Made<T>;
}

impl<T, E: Display> At<T> for Result<T, E> {
    fn at(self, key: &str) -> Made<T> {
        self.map_err(|error| Fault::new(key, error.to_string()).into())
    }
}

/// Both values, or the faults of both.
pub fn both<A, B>(a: Made<A>, b: Made<B>) -> Made<(A, B)> {
    match (a, b) {
        (Ok(a), Ok(b)) => Ok((a, b)),
        (Err(mut a), Err(b)) => {
            a.0.extend(b.0);
            Err(a)
        }
        (Err(faults), _) | (_, Err(faults)) => Err(faults),
    }
}

impl std::fmt::Display for Faults {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let messages: Vec<&str> = self.0.iter().map(|fault| fault.message.as_str()).collect();
        f.write_str(&messages.join("; "))
    }
}

impl std::error::Error for Faults {}

/// What is wrong with a case, as it is found.
#[derive(Default)]
pub(crate) struct Found(pub(crate) Faults);

impl Found {
    /// The part, or `None`, with its faults noted.
    pub(crate) fn part<T>(&mut self, made: Made<T>) -> Option<T> {
        made.map_err(|faults| self.0.0.extend(faults.0)).ok()
    }

    /// Notes a fault if there is one.
    pub(crate) fn check(&mut self, wrong: bool, key: &str, message: impl FnOnce() -> String) {
        if wrong {
            self.0.0.push(Fault::new(key, message()));
        }
    }
}
