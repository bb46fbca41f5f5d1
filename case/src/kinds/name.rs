//! Names of parts, which begin the names of their columns.

use crate::fault::{Fault, Made};
use crate::keys::{Field, text};

/// Names that columns, places and messages use otherwise.
const TAKEN: [&str; 8] =
    ["root", "tip", "energy", "step", "time", "constraint", "momentum", "angular_momentum"];

/// The key of a name that may be left out.
pub(super) const NAME: Field<Option<String>> =
    text().called("name", "name, for messages and columns; that of its number if left out");

/// How a name is written.
pub(crate) const PLAIN: &str = "begin with a letter, and go on with letters, digits, `-` and `_`";

/// Whether columns can have a name in theirs.
pub(crate) fn is_plain(name: &str) -> bool {
    name.starts_with(char::is_alphabetic) && name.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_')
}

/// The name of a part that is written, empty where it is left out; `also` are names that parts of this sort cannot have.
pub(super) fn name(written: Option<String>, also: &[&str]) -> Made<String> {
    let Some(name) = written else { return Ok(String::new()) };
    if !is_plain(&name) {
        let message = format!("`{name}` cannot begin the name of a column");
        return Err(Fault::new("name", message).help(PLAIN).into());
    }
    if TAKEN.contains(&name.as_str()) || also.contains(&name.as_str()) {
        let message = format!("`{name}` has a meaning of its own in places and columns");
        return Err(Fault::new("name", message)
            .help(format!("write another, for example `{name}-1`"))
            .into());
    }
    Ok(name)
}

/// `name`, or that of its number, from 0: `joint`, `joint2`, ….
pub(crate) fn numbered(name: &str, what: &str, number: usize) -> String {
    match (name.is_empty(), number) {
        (false, _) => name.to_owned(),
        (_, 0) => what.to_owned(),
        (_, i) => format!("{what}{}", i + 1),
    }
}
