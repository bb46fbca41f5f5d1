//! Reads the raw tree by the declarations: every problem is collected, nothing stops at the first.

use super::declaration::{Bound, Key, Kind, Presence, Seam, Type, listed};
use super::elsewhere;
use super::problem::{Place, Problem, Problems};
use super::tree::{Entry, Node, Raw};
use super::units::{self, Measure};
use super::values::{Filled, Value, Values, item, join};
use flexion_results::nearest;

/// Reads a table with the given keys.
pub(super) fn table(
    entries: &[Entry],
    place: Option<Place>,
    keys: &'static [Key],
    path: &str,
    problems: &mut Problems,
) -> Values {
    let suspected = unknown(entries, keys, path, None, problems);
    let entries = known(entries, place.as_ref(), keys, path, &suspected, problems);
    Values { place, entries }
}

/// Reads the declared keys; a missing key is no problem of its own when it is `suspected` misspelt.
fn known(
    entries: &[Entry],
    place: Option<&Place>,
    keys: &'static [Key],
    path: &str,
    suspected: &[&str],
    problems: &mut Problems,
) -> Vec<Filled> {
    let mut values = Vec::new();
    for key in keys {
        let path = join(path, key.name);
        let (value, place) = match entries.iter().find(|entry| entry.key == key.name) {
            Some(entry) => (self::value(key, &entry.node, &path, problems), Some(entry.node.place.clone())),
            None => {
                if key.presence == Presence::Required && !suspected.contains(&key.name) {
                    let what =
                        if is_table(&key.takes) { "this table is missing" } else { "this key is missing" };
                    let problem = Problem::new(&path, place.cloned(), what);
                    problems.push(problem.label(format!("`{}` belongs here", key.name)).help(advice(key)));
                }
                (default(key, &path, problems), None)
            }
        };
        if let Some(value) = value {
            values.push(Filled { key, value, place });
        }
    }
    values
}

/// Reports the keys that are not declared; returns the declared keys they were perhaps meant to be.
fn unknown<'k>(
    entries: &[Entry],
    keys: &'k [Key],
    path: &str,
    of: Option<(&'static Seam, &'static Kind)>,
    problems: &mut Problems,
) -> Vec<&'k str> {
    let mut suspected = Vec::new();
    for entry in entries {
        let name = entry.key.as_str();
        if keys.iter().any(|key| key.name == name) || (of.is_some() && name == "kind") {
            continue;
        }
        let all = keys.iter().map(|key| key.name);
        let free = all.clone().filter(|key| !entries.iter().any(|e| e.key == *key));
        let mut problem = Problem::new(join(path, name), Some(entry.place.clone()), "unknown key");
        if let Some(name) = nearest(name, free).or_else(|| nearest(name, all)) {
            problem = problem.label(format!("did you mean `{name}`?"));
            suspected.push(name);
        } else if let Some((seam, kind)) = of {
            let owners: Vec<&str> = seam
                .kinds
                .iter()
                .filter(|other| other.name != kind.name && other.keys.iter().any(|key| key.name == name))
                .map(|other| other.name)
                .collect();
            if !owners.is_empty() {
                let owners = listed(owners.into_iter());
                problem = problem
                    .help(format!("`{name}` is a key of {} {owners}, not of `{}`", seam.name, kind.name));
                let laid_over = |entry: &&Entry| entry.key == "kind" && entry.node.place.source != 0;
                if entry.place.source == 0 && entries.iter().any(|entry| laid_over(&entry)) {
                    problem = problem.help(elsewhere::replacement(seam, kind, path, name));
                }
            } else if let Some(advice) = elsewhere::advice(name, path) {
                problem = problem.help(advice);
            }
        } else if let Some(advice) = elsewhere::advice(name, path) {
            problem = problem.help(advice);
        }
        let allowed = listed(of.iter().map(|_| "kind").chain(keys.iter().map(|key| key.name)));
        problems.push(problem.help(format!("the keys here are {allowed}")));
    }
    suspected
}

fn is_table(takes: &Type) -> bool {
    matches!(takes, Type::Table(_) | Type::Kind(_))
}

/// What a missing key takes.
fn advice(key: &Key) -> String {
    let takes = match &key.takes {
        Type::Quantity(measure, _) => {
            format!("{}, for example {}", units::article(measure), measure.examples)
        }
        Type::Kind(seam) => format!("a table whose kind is one of {}", seam.names()),
        Type::Table(keys) => {
            let required = keys.iter().filter(|key| key.presence == Presence::Required);
            format!("a table with {}", listed(required.map(|key| key.name)))
        }
        other => expected(other),
    };
    format!("`{}`, the {}, takes {takes}", key.name, key.doc)
}

/// What a type takes, in words.
fn expected(takes: &Type) -> String {
    match takes {
        Type::Quantity(measure, _) => {
            format!(
                "{}: a text such as {} or a number in {}",
                units::article(measure),
                measure.examples,
                measure.unit
            )
        }
        Type::Quantities(measure, _) => {
            format!("a list of quantities such as {} or of numbers in {}", measure.examples, measure.unit)
        }
        Type::Number(_) => "a number without unit and quotes".to_owned(),
        Type::Integer(low, high) => format!("an integer from {low} to {high}"),
        Type::Boolean => "`true` or `false`".to_owned(),
        Type::Text => "a text".to_owned(),
        Type::Path => "the path of a file, relative to the folder of the case".to_owned(),
        Type::Choice(seam) => format!("one of {}", seam.names()),
        Type::Table(keys) => format!("a table: its keys are {}", listed(keys.iter().map(|key| key.name))),
        Type::Tables(keys) => format!(
            "a list of tables, each under a heading in double brackets: their keys are {}",
            listed(keys.iter().map(|key| key.name))
        ),
        Type::Kind(_) => "a table with a `kind`".to_owned(),
    }
}

fn value(key: &'static Key, node: &Node, path: &str, problems: &mut Problems) -> Option<Value> {
    let mismatch = |problems: &mut Problems| {
        let message = format!("{} is not what this key takes", node.value.describe());
        let problem = Problem::new(path, Some(node.place.clone()), message);
        problems.push(problem.help(format!("`{}` takes {}", key.name, expected(&key.takes))));
        None
    };
    match (&key.takes, &node.value) {
        (Type::Quantity(measure, bound), Raw::Text(_) | Raw::Number(_) | Raw::Integer(_)) => {
            quantity(node, measure, *bound, path, problems).map(Value::Number)
        }
        (Type::Quantities(measure, bound), Raw::List(items)) => {
            let before = problems.list.len();
            let mut numbers = Vec::with_capacity(items.len());
            for item in items {
                match item.value {
                    Raw::Text(_) | Raw::Number(_) | Raw::Integer(_) => {
                        numbers.extend(quantity(item, measure, *bound, path, problems));
                    }
                    _ => {
                        let message = format!("{} is not {}", item.value.describe(), units::article(measure));
                        problems.push(
                            Problem::new(path, Some(item.place.clone()), message)
                                .help(format!("write for example {}", measure.examples)),
                        );
                    }
                }
            }
            (problems.list.len() == before).then_some(Value::Numbers(numbers))
        }
        (Type::Number(bound), Raw::Number(value)) => {
            bounded(*value, "", *bound, path, &node.place, problems).map(Value::Number)
        }
        (Type::Number(bound), Raw::Integer(value)) => {
            bounded(*value as f64, "", *bound, path, &node.place, problems).map(Value::Number)
        }
        (Type::Integer(low, high), Raw::Integer(value)) => {
            if (low..=high).contains(&value) {
                return Some(Value::Integer(*value));
            }
            let message = format!("must be from {low} to {high}, but is {value}");
            problems.push(Problem::new(path, Some(node.place.clone()), message));
            None
        }
        (Type::Boolean, Raw::Boolean(value)) => Some(Value::Boolean(*value)),
        (Type::Text | Type::Path, Raw::Text(text)) => Some(Value::Text(text.clone())),
        (Type::Choice(seam), Raw::Text(text)) => {
            chosen(seam, text, &node.place, path, problems).map(|kind| Value::Text(kind.name.to_owned()))
        }
        (Type::Table(keys), Raw::Table(entries)) => {
            Some(Value::Table(table(entries, Some(node.place.clone()), keys, path, problems)))
        }
        (Type::Tables(keys), Raw::List(items)) => {
            let mut list = Vec::with_capacity(items.len());
            for (number, node) in items.iter().enumerate() {
                let path = item(path, number);
                match &node.value {
                    Raw::Table(entries) => {
                        list.push(table(entries, Some(node.place.clone()), keys, &path, problems));
                    }
                    other => {
                        let message = format!("{} is not a table", other.describe());
                        let problem = Problem::new(&path, Some(node.place.clone()), message);
                        problems.push(problem.help(format!("`{}` takes {}", key.name, expected(&key.takes))));
                    }
                }
            }
            Some(Value::Tables(list))
        }
        (Type::Kind(seam), Raw::Table(entries)) => kind(seam, key, entries, &node.place, path, problems),
        (Type::Kind(seam), Raw::Text(text)) if seam.kind(text).is_some() => {
            let problem =
                Problem::new(path, Some(node.place.clone()), "this key takes a table, not a name alone");
            problems.push(problem.help(format!("write `{} = {{ kind = \"{text}\", … }}`", key.name)));
            None
        }
        _ => mismatch(problems),
    }
}

fn kind(
    seam: &'static Seam,
    key: &'static Key,
    entries: &[Entry],
    place: &Place,
    path: &str,
    problems: &mut Problems,
) -> Option<Value> {
    let kind_path = join(path, "kind");
    let Some(entry) = entries.iter().find(|entry| entry.key == "kind") else {
        // A table that only changes some keys of the default kind.
        if let Presence::Name(name) = key.presence
            && let Some(kind) = seam.kind(name)
        {
            return Some(of_kind(seam, kind, entries, place, path, problems));
        }
        let problem =
            Problem::new(kind_path, Some(place.clone()), format!("the kind of {} is missing", seam.name));
        problems.push(problem.label("`kind` belongs here").help(format!("the kinds are {}", seam.names())));
        return None;
    };
    let Raw::Text(name) = &entry.node.value else {
        let message = format!("a kind is a text, not {}", entry.node.value.describe());
        let problem = Problem::new(kind_path, Some(entry.node.place.clone()), message);
        problems.push(problem.help(format!("the kinds are {}", seam.names())));
        return None;
    };
    let kind = chosen(seam, name, &entry.node.place, &kind_path, problems)?;
    Some(of_kind(seam, kind, entries, place, path, problems))
}

fn of_kind(
    seam: &'static Seam,
    kind: &'static Kind,
    entries: &[Entry],
    place: &Place,
    path: &str,
    problems: &mut Problems,
) -> Value {
    let suspected = unknown(entries, kind.keys, path, Some((seam, kind)), problems);
    let entries = known(entries, Some(place), kind.keys, path, &suspected, problems);
    Value::Kind(kind, Values { place: Some(place.clone()), entries })
}

fn chosen(
    seam: &'static Seam,
    name: &str,
    place: &Place,
    path: &str,
    problems: &mut Problems,
) -> Option<&'static Kind> {
    let kind = seam.kind(name);
    if kind.is_none() {
        let mut problem = Problem::new(path, Some(place.clone()), format!("unknown {} `{name}`", seam.name));
        if let Some(near) = nearest(name, seam.kinds.iter().map(|kind| kind.name)) {
            problem = problem.label(format!("did you mean `{near}`?"));
        }
        problems.push(problem.help(format!("it is one of {}", seam.names())));
    }
    kind
}

fn default(key: &'static Key, path: &str, problems: &mut Problems) -> Option<Value> {
    match (key.presence, &key.takes) {
        (Presence::Required | Presence::Optional, _) => None,
        (Presence::Number(value), _) => Some(Value::Number(value)),
        (Presence::Integer(value), _) => Some(Value::Integer(value)),
        (Presence::Boolean(value), _) => Some(Value::Boolean(value)),
        (Presence::Name(name), Type::Kind(seam)) => {
            let kind = seam.kind(name)?;
            let entries = known(&[], None, kind.keys, path, &[], problems);
            Some(Value::Kind(kind, Values { place: None, entries }))
        }
        (Presence::Name(name), _) => Some(Value::Text(name.to_owned())),
        (Presence::Empty, Type::Table(keys)) => Some(Value::Table(table(&[], None, keys, path, problems))),
        (Presence::Empty, Type::Tables(_)) => Some(Value::Tables(Vec::new())),
        (Presence::Empty, _) => Some(Value::Numbers(Vec::new())),
    }
}

fn quantity(
    node: &Node,
    measure: &'static Measure,
    bound: Bound,
    path: &str,
    problems: &mut Problems,
) -> Option<f64> {
    let number = match &node.value {
        Raw::Integer(value) => *value as f64,
        Raw::Number(value) => *value,
        Raw::Text(text) => match units::parse(text, measure) {
            Ok(value) => value,
            Err(error) => {
                let place = inside(&node.place, text, error.span, problems);
                problems.push(Problem::new(path, Some(place), error.message).help(error.help));
                return None;
            }
        },
        _ => return None,
    };
    bounded(number, measure.unit, bound, path, &node.place, problems)
}

/// The place of `span` of a text inside the place of its TOML value, where the two correspond.
pub(super) fn inside(place: &Place, text: &str, span: std::ops::Range<usize>, problems: &Problems) -> Place {
    let written = problems.sources.get(place.source).and_then(|s| s.text.get(place.start..place.end));
    let offset = match written {
        Some(written) if written == text => 0,
        Some(written) if written.get(1..written.len().saturating_sub(1)) == Some(text) => 1,
        _ => return place.clone(),
    };
    let start = place.start + offset;
    Place::new(place.source, start + span.start..start + span.end)
}

fn bounded(
    value: f64,
    unit: &str,
    bound: Bound,
    path: &str,
    place: &Place,
    problems: &mut Problems,
) -> Option<f64> {
    let message = if !value.is_finite() {
        "must be a finite number".to_owned()
    } else if !bound.admits(value) {
        let space = if unit.is_empty() { "" } else { " " };
        format!("must be {}, but is {value}{space}{unit}", bound.words())
    } else {
        return Some(value);
    };
    problems.push(Problem::new(path, Some(place.clone()), message));
    None
}
