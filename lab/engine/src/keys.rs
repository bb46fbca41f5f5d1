//! What a case may say.

use flexion_case::declaration::{Bound, Entry, Key, Presence, Type};
use flexion_case::{TEMPLATES, choices, examples_of_tables, schema};
use serde_json::{Value, json};

/// The schema, and all choices with their kinds.
pub(crate) fn keys() -> Value {
    let schema: Value = serde_json::from_str(&schema()).unwrap_or_default();
    let kind = |kind: &Entry| {
        json!({
            "name": kind.name, "summary": kind.summary, "source": kind.source, "example": kind.example,
            "keys": kind.keys.iter().map(key).collect::<Vec<_>>(),
        })
    };
    let choice = |choice: &&dyn flexion_case::declaration::Kinds| {
        json!({
            "name": choice.name(), "path": choice.path(), "summary": choice.summary(),
            "kinds": choice.kinds().iter().map(kind).collect::<Vec<_>>(),
        })
    };
    let subject = |(subject, keys): (&str, &[Key])| json!({ "subject": subject, "keys": keys.iter().map(key).collect::<Vec<_>>() });
    let template =
        |template: &flexion_case::Template| json!({ "name": template.name, "summary": template.summary });
    json!({
        "schema": schema,
        "choices": choices().iter().map(choice).collect::<Vec<_>>(),
        "subjects": flexion_case::keys().map(subject),
        "examples": examples_of_tables(),
        "templates": TEMPLATES.iter().map(template).collect::<Vec<_>>(),
    })
}

/// A key, and those of its table.
pub(crate) fn key(key: &Key) -> Value {
    let mut all = json!({ "name": key.name, "doc": key.doc, "required": key.presence == Presence::Required });
    let (takes, unit, bound): (&str, &str, Option<Bound>) = match key.takes {
        Type::Quantity(measure, bound) => ("quantity", &*measure.unit, Some(bound)),
        Type::Quantities(measure, bound) => ("quantities", &*measure.unit, Some(bound)),
        Type::Moment(measure) => ("moment", &*measure.unit, None),
        Type::Number(bound) => ("number", "", Some(bound)),
        Type::Integer(low, high) => ("integer", "", Some(Bound::Between(low as f64, high as f64))),
        Type::Boolean => ("boolean", "", None),
        Type::Text => ("text", "", None),
        Type::Texts => ("texts", "", None),
        Type::Path => ("path", "", None),
        Type::Place => ("place", "", None),
        Type::Places => ("places", "", None),
        Type::Choice(choice) => {
            all["choices"] = choice.kinds().iter().map(|kind| kind.name).collect();
            ("choice", "", None)
        }
        Type::Kind(choice) => {
            all["choice"] = choice.path().into();
            ("kind", "", None)
        }
        Type::Table(keys) | Type::Tables(keys) => {
            all["keys"] = keys.iter().map(self::key).collect();
            (if let Type::Table(_) = key.takes { "table" } else { "tables" }, "", None)
        }
    };
    all["takes"] = takes.into();
    all["unit"] = unit.into();
    all["range"] = bound.map_or(Value::Null, range);
    all
}

/// Least and most of a number, null where it has none, and whether the least is left out.
pub(crate) fn range(bound: Bound) -> Value {
    match bound {
        Bound::Any => json!({ "least": null, "most": null, "above": false }),
        Bound::Positive => json!({ "least": 0, "most": null, "above": true }),
        Bound::NotNegative => json!({ "least": 0, "most": null, "above": false }),
        Bound::Between(low, high) => json!({ "least": low, "most": high, "above": false }),
    }
}
