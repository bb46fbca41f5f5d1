//! Changes of a case, and how cases differ.

use crate::request::Request;
use crate::work::rejected;
use serde_json::{Map, Value, json};

/// The text of the case with the changes written into it.
pub(crate) fn change(request: &Request) -> Value {
    let edited = request.unchanged().and_then(|reading| reading.edited(request.changes()));
    edited.map_or_else(|problems| rejected(&problems), |case| json!({ "status": "finished", "case": case }))
}

/// The changes that make the case of another, `from`; null where no such changes do.
pub(crate) fn difference(request: &Request) -> Result<Value, String> {
    let from = request.option("from").and_then(Value::as_str).ok_or("`from` is no text of a case")?;
    let both = request.read().and_then(|case| Ok((case, request.read_text(from)?)));
    Ok(match both {
        Ok((case, from)) => {
            let set = case.difference(&from);
            let set = set.map(|set| {
                set.into_iter().map(|(key, value)| (key, value.into())).collect::<Map<_, Value>>()
            });
            json!({ "status": "finished", "set": set })
        }
        Err(problems) => rejected(&problems),
    })
}
