//! The resolved case: every key with its value in SI, defaults included, as a TOML file.

use super::declaration::Type;
use super::values::{Value, Values, item, join};
use flexion_results::Artifact;
use std::fmt::Write;

/// Writes the whole case; with `copies`, the tables that name files, with the names of their copies among the results in place of paths.
pub(super) fn resolved(values: &Values, copies: Option<&[String]>) -> String {
    let mut out = String::new();
    table(values, None, "", copies, &mut out);
    out
}

/// The plain keys first, then the tables.
fn table(values: &Values, kind: Option<&str>, path: &str, copies: Option<&[String]>, out: &mut String) {
    if !path.is_empty() {
        let _ = writeln!(out, "\n[{}]", heading(path));
    }
    entries(values, kind, path, copies, out);
}

/// What stands under the heading of a table.
fn entries(values: &Values, kind: Option<&str>, path: &str, copies: Option<&[String]>, out: &mut String) {
    if let Some(kind) = kind {
        let _ = writeln!(out, "kind = {}", quoted(kind));
    }
    let nested = |value: &Value| matches!(value, Value::Table(_) | Value::Tables(_) | Value::Kind(..));
    for filled in values.entries.iter().filter(|filled| !nested(&filled.value)) {
        let unit = match filled.key.takes {
            Type::Quantity(measure, _) | Type::Quantities(measure, _) | Type::Moment(measure) => {
                format!("  # {}", measure.unit)
            }
            _ => String::new(),
        };
        let value = match (filled.key.takes, copies.and_then(|all| copy(path, all))) {
            (Type::Path, Some(artifact)) => quoted(&artifact.file_name()),
            _ => written(&filled.value, &filled.key.takes, false),
        };
        let _ = writeln!(out, "{} = {value}{unit}", filled.key.name);
    }
    for filled in &values.entries {
        let path = join(path, filled.key.name);
        match &filled.value {
            Value::Table(values) => table(values, None, &path, copies, out),
            Value::Tables(list) => {
                for (number, values) in list.iter().enumerate() {
                    let _ = writeln!(out, "\n[[{}]]", heading(&path));
                    entries(values, None, &item(&path, number), copies, out);
                }
            }
            Value::Kind(kind, values) => table(values, Some(kind.name), &path, copies, out),
            _ => {}
        }
    }
}

/// The heading of a table: its path without the numbers of lists.
fn heading(path: &str) -> String {
    path.split('.').map(|part| part.split('[').next().unwrap_or(part)).collect::<Vec<_>>().join(".")
}

/// Key that stands for the blade file of a deck of BeamDyn.
const BLADE_FILE: &str = "BldFile";

/// The path that stands for the blade file that the file of the table at `path` names.
pub(super) fn of_blade(path: &str) -> String {
    join(path, BLADE_FILE)
}

/// The copy, among the results, of the file named in the table at `path`; `all` are the tables that name files.
pub(super) fn copy(path: &str, all: &[String]) -> Option<Artifact> {
    let is_numbered = |path: &str| path.contains('[') || path.ends_with(BLADE_FILE);
    if is_numbered(path) {
        let place = all.iter().filter(|other| is_numbered(other)).position(|other| other == path)?;
        return u32::try_from(place).ok().map(Artifact::Table);
    }
    Artifact::table(path.rsplit('.').next().unwrap_or(path))
}

/// The paths in a case: dotted path of the table and what is written there.
pub(super) fn paths(values: &Values, path: &str, out: &mut Vec<(String, String)>) {
    for filled in &values.entries {
        match (&filled.value, filled.key.takes) {
            (Value::Text(text), Type::Path) => out.push((path.to_owned(), text.clone())),
            (Value::Table(values) | Value::Kind(_, values), _) => {
                paths(values, &join(path, filled.key.name), out);
            }
            (Value::Tables(list), _) => {
                for (number, values) in list.iter().enumerate() {
                    paths(values, &item(&join(path, filled.key.name), number), out);
                }
            }
            _ => {}
        }
    }
}

/// Every value with its dotted path.
pub(super) fn flat(values: &Values, path: &str, out: &mut Vec<(String, String)>) {
    for filled in &values.entries {
        let path = join(path, filled.key.name);
        match &filled.value {
            Value::Table(values) => flat(values, &path, out),
            Value::Tables(list) => {
                for (number, values) in list.iter().enumerate() {
                    flat(values, &item(&path, number), out);
                }
            }
            Value::Kind(kind, values) => {
                out.push((join(&path, "kind"), kind.name.to_owned()));
                flat(values, &path, out);
            }
            value => out.push((path, written(value, &filled.key.takes, true))),
        }
    }
}

/// The defaults in force, as dotted path and value.
pub(super) fn defaults(values: &Values, path: &str, out: &mut Vec<(String, String)>) {
    for filled in &values.entries {
        let path = join(path, filled.key.name);
        match &filled.value {
            Value::Table(values) => defaults(values, &path, out),
            Value::Tables(list) => {
                for (number, values) in list.iter().enumerate() {
                    defaults(values, &item(&path, number), out);
                }
            }
            Value::Kind(kind, values) => {
                if filled.place.is_none() {
                    out.push((join(&path, "kind"), kind.name.to_owned()));
                }
                defaults(values, &path, out);
            }
            _ if filled.place.is_some() => {}
            value => out.push((path, written(value, &filled.key.takes, true))),
        }
    }
}

/// A value as TOML, with its unit if `unit`.
pub(super) fn written(value: &Value, takes: &Type, unit: bool) -> String {
    let text = match value {
        Value::Number(value) => number(*value),
        Value::Numbers(values) => {
            format!("[{}]", values.iter().map(|value| number(*value)).collect::<Vec<_>>().join(", "))
        }
        Value::Integer(value) => value.to_string(),
        Value::Boolean(value) => value.to_string(),
        Value::Text(value) => quoted(value),
        Value::Texts(values) => {
            format!("[{}]", values.iter().map(|value| quoted(value)).collect::<Vec<_>>().join(", "))
        }
        Value::Table(_) | Value::Tables(_) | Value::Kind(..) => String::new(),
    };
    match takes {
        Type::Quantity(measure, _) if unit => format!("{text} {}", measure.unit),
        _ => text,
    }
}

/// A float that TOML reads back exactly.
fn number(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && !(1e-4..1e6).contains(&size) { format!("{value:e}") } else { format!("{value:?}") }
}

/// A basic string.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
