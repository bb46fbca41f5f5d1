//! The resolved case: every key with its value in SI, defaults included, as a TOML file.

use super::declaration::Type;
use super::values::{Value, Values, join};
use std::fmt::Write;

/// Writes the whole case, with `file` in place of every path if there is one.
pub(super) fn resolved(values: &Values, file: Option<&str>) -> String {
    let mut out = String::new();
    table(values, None, "", file, &mut out);
    out
}

/// The plain keys first, then the tables.
fn table(values: &Values, kind: Option<&str>, path: &str, file: Option<&str>, out: &mut String) {
    if !path.is_empty() {
        let _ = writeln!(out, "\n[{path}]");
    }
    if let Some(kind) = kind {
        let _ = writeln!(out, "kind = {}", quoted(kind));
    }
    let nested = |value: &Value| matches!(value, Value::Table(_) | Value::Kind(..));
    for filled in values.entries.iter().filter(|filled| !nested(&filled.value)) {
        let unit = match filled.key.takes {
            Type::Quantity(measure, _) | Type::Quantities(measure, _) => format!("  # {}", measure.unit),
            _ => String::new(),
        };
        let value = match (filled.key.takes, file) {
            (Type::Path, Some(file)) => quoted(file),
            _ => written(&filled.value, &filled.key.takes, false),
        };
        let _ = writeln!(out, "{} = {value}{unit}", filled.key.name);
    }
    for filled in &values.entries {
        let path = join(path, filled.key.name);
        match &filled.value {
            Value::Table(values) => table(values, None, &path, file, out),
            Value::Kind(kind, values) => table(values, Some(kind.name), &path, file, out),
            _ => {}
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
        Value::Table(_) | Value::Kind(..) => String::new(),
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
