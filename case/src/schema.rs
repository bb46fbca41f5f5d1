//! The JSON Schema (draft 2020-12) of case files, for editors.

use super::declaration::{Bound, Entry, Key, Kinds, Presence, Type};
use super::layout;
use super::units::{self, Measure};
use serde_json::{Map, Value, json};

/// A number and a unit, as far as a pattern can describe them.
const QUANTITY: &str = r"^\s*[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*([A-Za-zµμ°1(].*)?$";

/// The schema, as indented text that ends in a newline.
pub fn schema() -> String {
    let mut root = json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Flexion case",
        "description": "A rotating flexible beam, or a system of bodies, joints and beams in space, and how to integrate its motion.",
    });
    if let Some(root) = root.as_object_mut() {
        let described = crate::keys().map(|(what, keys)| {
            let mut layout = table(keys, None, false);
            if let Some(layout) = layout.as_object_mut() {
                layout.insert("description".to_owned(), json!(what));
                if layout::is_spatial(keys) {
                    let some = layout::IN_SPACE.map(|key| json!({ "required": [key] }));
                    layout.insert("anyOf".to_owned(), json!(some));
                }
            }
            layout
        });
        root.insert("anyOf".to_owned(), json!(described));
    }
    format!("{root:#}\n")
}

/// A table with the given keys, and `kind` if it is of a kind, which may be left out of the `default` one.
fn table(keys: &[Key], kind: Option<&str>, default: bool) -> Value {
    let mut properties = Map::new();
    let mut required = Vec::new();
    if let Some(kind) = kind {
        properties.insert("kind".to_owned(), json!({ "const": kind }));
        if !default {
            required.push("kind");
        }
    }
    for key in keys {
        properties.insert(key.name.to_owned(), property(key));
        if key.presence == Presence::Required {
            required.push(key.name);
        }
    }
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn property(key: &Key) -> Value {
    let kind = match key.presence {
        Presence::Name(name) => name,
        _ => "",
    };
    let mut schema = takes(&key.takes, kind);
    let default = match key.presence {
        Presence::Number(value) => Some(json!(value)),
        Presence::Integer(value) => Some(json!(value)),
        Presence::Boolean(value) => Some(json!(value)),
        Presence::Name(name) if matches!(key.takes, Type::Kind(_)) => Some(json!({ "kind": name })),
        Presence::Name(name) => Some(json!(name)),
        Presence::Required | Presence::Optional | Presence::Run | Presence::Empty => None,
    };
    if let Some(object) = schema.as_object_mut() {
        object.insert("description".to_owned(), json!(key.doc));
        object.extend(default.map(|value| ("default".to_owned(), value)));
    }
    schema
}

/// What a type takes; `default` is the kind that a table without `kind` is of, if any.
fn takes(takes: &Type, default: &str) -> Value {
    match takes {
        Type::Quantity(measure, bound) => quantity(measure, *bound),
        Type::Place => json!({ "type": "string" }),
        Type::Places => {
            json!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" } }] })
        }
        Type::Moment(measure) => {
            let one = quantity(measure, Bound::Any);
            json!({ "anyOf": [one, { "type": "array", "items": one }] })
        }
        Type::Quantities(measure, bound) => json!({ "type": "array", "items": quantity(measure, *bound) }),
        Type::Number(bound) => number(*bound),
        Type::Integer(low, high) => json!({ "type": "integer", "minimum": low, "maximum": high }),
        Type::Boolean => json!({ "type": "boolean" }),
        Type::Text | Type::Path => json!({ "type": "string" }),
        Type::Texts => json!({ "type": "array", "items": { "type": "string" } }),
        Type::Choice(choice) => {
            let options: Vec<Value> = choice
                .kinds()
                .iter()
                .map(|kind| json!({ "const": kind.name, "description": kind.summary }))
                .collect();
            json!({ "type": "string", "oneOf": options })
        }
        Type::Table(keys) => table(keys, None, false),
        Type::Tables(keys) => json!({ "type": "array", "items": table(keys, None, false) }),
        Type::Kind(choice) => json!({ "type": "object", "oneOf": kinds(*choice, default) }),
    }
}

fn kinds(choice: &dyn Kinds, default: &str) -> Vec<Value> {
    let described = |kind: &Entry| {
        let mut schema = table(kind.keys, Some(kind.name), kind.name == default);
        if let Some(object) = schema.as_object_mut() {
            let source = if kind.source.is_empty() { String::new() } else { format!(". {}", kind.source) };
            object.insert("description".to_owned(), json!(format!("{}{source}", kind.summary)));
        }
        schema
    };
    choice.kinds().iter().map(described).collect()
}

fn quantity(measure: &Measure, bound: Bound) -> Value {
    let unit = &measure.unit;
    let examples: Vec<&str> = measure.examples.split(", ").map(|example| example.trim_matches('`')).collect();
    json!({
        "anyOf": [number(bound), { "type": "string", "pattern": QUANTITY }],
        "title": format!("{} with its unit, or a number in {unit}", units::article(measure)),
        "examples": examples,
    })
}

fn number(bound: Bound) -> Value {
    match bound {
        Bound::Any => json!({ "type": "number" }),
        Bound::Positive => json!({ "type": "number", "exclusiveMinimum": 0 }),
        Bound::NotNegative => json!({ "type": "number", "minimum": 0 }),
        Bound::Between(low, high) => json!({ "type": "number", "minimum": low, "maximum": high }),
    }
}
