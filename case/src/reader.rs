//! Reads the raw tree by the declarations: every problem is collected, nothing stops at the first.

use super::declaration::{Bound, Entry, Key, Kinds, Presence, Type, listed};
use super::fault::Fault;
use super::problem::{Place, Problem, Problems, inside};
use super::suggestion;
use super::tree::{Line, Node, Raw};
use super::units::{self, Measure};
use super::values::{Filled, Value, Values, item, join};
use flexion_results::nearest;

/// Reads a table with the given keys.
pub(super) fn table(
    entries: &[Line],
    place: Option<Place>,
    keys: &'static [Key],
    path: &str,
    problems: &mut Problems,
) -> Values {
    let suspected = unknown(entries, keys, path, None, problems);
    known(entries, place, keys, path, &suspected, problems)
}

/// Reads the declared keys; a missing key is no problem of its own when it is `suspected` misspelt.
fn known(
    entries: &[Line],
    place: Option<Place>,
    keys: &'static [Key],
    path: &str,
    suspected: &[&str],
    problems: &mut Problems,
) -> Values {
    let mut values = Values { place, keys, entries: Vec::new(), sound: true };
    for key in keys {
        let path = join(path, key.name);
        let (value, place) = match entries.iter().find(|entry| entry.key == key.name) {
            Some(entry) => (self::value(key, &entry.node, &path, problems), Some(entry.node.place.clone())),
            None => {
                if key.presence == Presence::Required && !suspected.contains(&key.name) {
                    problems.push(missing(key, &path, values.place.clone()));
                }
                (default(key, &path, problems), None)
            }
        };
        match value {
            Some(value) => values.entries.push(Filled { key, value, place }),
            None => values.sound &= place.is_none() && key.presence.is_optional(),
        }
    }
    values
}

/// Reports the keys that are not declared; returns the declared keys they were perhaps meant to be.
fn unknown<'k>(
    entries: &[Line],
    keys: &'k [Key],
    path: &str,
    of: Option<(&'static dyn Kinds, Entry)>,
    problems: &mut Problems,
) -> Vec<&'k str> {
    let mut suspected = Vec::new();
    let all = keys.iter().map(|key| key.name);
    let free: Vec<&str> = all.clone().filter(|key| !entries.iter().any(|e| e.key == *key)).collect();
    for entry in entries {
        let name = entry.key.as_str();
        if keys.iter().any(|key| key.name == name) || (of.is_some() && name == "kind") {
            continue;
        }
        let (all, free) = (all.clone(), free.iter().copied());
        let mut problem = Problem::new(join(path, name), Some(entry.place.clone()), "unknown key");
        let synonym = suggestion::synonym(name, all.clone());
        if let Some(name) = synonym.or_else(|| nearest(name, free)).or_else(|| nearest(name, all)) {
            problem = problem.label(format!("did you mean `{name}`?"));
            suspected.push(name);
        } else if let Some((choice, kind)) = of {
            let owns =
                |other: &Entry| other.name != kind.name && other.keys.iter().any(|key| key.name == name);
            let owners: Vec<Entry> = choice.kinds().into_iter().filter(owns).collect();
            if !owners.is_empty() {
                let owners = listed(owners.iter().map(|kind| kind.name));
                problem = problem.help(format!(
                    "`{name}` is a key of {} {owners}, not of `{}`",
                    choice.name(),
                    kind.name
                ));
                let laid_over = |entry: &&Line| entry.key == "kind" && entry.node.place.source != 0;
                if entry.place.source == 0 && entries.iter().any(|entry| laid_over(&entry)) {
                    problem = problem.help(suggestion::replacement(choice, kind, path, name));
                }
            } else if let Some(advice) = suggestion::advice(name, path) {
                problem = problem.help(advice);
            }
        } else if let Some(advice) = suggestion::advice(name, path) {
            problem = problem.help(advice);
        }
        let allowed = listed(of.iter().map(|_| "kind").chain(keys.iter().map(|key| key.name)));
        problems.push(problem.help(format!("the keys here are {allowed}")));
    }
    suspected
}

/// That a key is missing in the table at `place`.
pub(super) fn missing(key: &Key, path: &str, place: Option<Place>) -> Problem {
    let what = if is_table(&key.takes) { "this table is missing" } else { "this key is missing" };
    let problem = Problem::new(path, place, what);
    problem.label(format!("`{}` belongs here", key.name)).help(advice(key))
}

/// The same for a key that only some cases may leave out.
pub(super) fn left_out(key: &Key, path: &str) -> Fault {
    Fault::new(path, "this key is missing").help(advice(key))
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
        Type::Kind(choice) => format!("a table whose kind is one of {}", choice.names()),
        Type::Table(keys) => {
            let required = keys.iter().filter(|key| key.presence == Presence::Required);
            let mut names: Vec<&str> = required.map(|key| key.name).collect();
            // A length that a deck may say is what a beam has first.
            names.extend(keys.first().filter(|_| names.is_empty()).map(|key| key.name));
            format!("a table with {}", listed(names.into_iter()))
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
        Type::Place => format!("a place: {PLACES}"),
        Type::Places => format!("a place or a list of places: {PLACES}"),
        Type::Moment(measure) => format!(
            "{} such as {} or a number in {}, or a list of three",
            units::article(measure),
            measure.examples,
            measure.unit
        ),
        Type::Quantities(measure, _) => {
            format!("a list of quantities such as {} or of numbers in {}", measure.examples, measure.unit)
        }
        Type::Number(_) => "a number without unit and quotes".to_owned(),
        Type::Integer(low, high) => format!("an integer from {low} to {high}"),
        Type::Boolean => "`true` or `false`".to_owned(),
        Type::Text => "a text".to_owned(),
        Type::Texts => "a list of texts".to_owned(),
        Type::Path => "the path of a file, relative to the folder of the case".to_owned(),
        Type::Choice(choice) => format!("one of {}", choice.names()),
        Type::Table(keys) => format!("a table: its keys are {}", listed(keys.iter().map(|key| key.name))),
        Type::Tables(keys) => format!(
            "a list of tables, each under a heading in double brackets: their keys are {}",
            listed(keys.iter().map(|key| key.name))
        ),
        Type::Kind(_) => "a table with a `kind`".to_owned(),
    }
}

/// What a place is, in words.
const PLACES: &str =
    "a text such as `tip`, `2 m` of the only beam, `arm@2 m`, `arm.tip`, or the name of a part";

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
        (Type::Place, Raw::Text(text)) => Some(Value::Text(text.clone())),
        (Type::Places, Raw::Text(text)) => Some(Value::Texts(vec![text.clone()])),
        (Type::Moment(measure), Raw::Text(_) | Raw::Number(_) | Raw::Integer(_)) => {
            quantity(node, measure, Bound::Any, path, problems).map(|number| Value::Numbers(vec![number]))
        }
        (Type::Moment(measure), Raw::List(items)) => {
            quantities(items, measure, Bound::Any, path, problems).map(Value::Numbers)
        }
        (Type::Quantities(measure, bound), Raw::List(items)) => {
            quantities(items, measure, *bound, path, problems).map(Value::Numbers)
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
        (Type::Texts | Type::Places, Raw::List(items)) => {
            let text =
                |item: &Node| if let Raw::Text(text) = &item.value { Some(text.clone()) } else { None };
            items.iter().map(text).collect::<Option<_>>().map(Value::Texts).or_else(|| mismatch(problems))
        }
        (Type::Choice(choice), Raw::Text(text)) => {
            chosen(*choice, text, &node.place, path, problems).map(|kind| Value::Text(kind.name.to_owned()))
        }
        (Type::Table(keys), Raw::Table(entries)) => {
            Some(Value::Table(table(entries, Some(node.place.clone()), keys, path, problems)))
        }
        (Type::Tables(keys), Raw::List(items)) => {
            Some(Value::Tables(tables(key, keys, items, path, problems)))
        }
        (Type::Kind(choice), Raw::Table(entries)) => kind(*choice, key, entries, &node.place, path, problems),
        // A name alone is a table with that `kind`.
        (Type::Kind(choice), Raw::Text(text)) => {
            let kind = chosen(*choice, text, &node.place, path, problems)?;
            Some(of_kind(*choice, kind, &[], &node.place, path, problems))
        }
        _ => mismatch(problems),
    }
}

/// The numbers of a list of quantities, if each of them is sound.
fn quantities(
    items: &[Node],
    measure: &'static Measure,
    bound: Bound,
    path: &str,
    problems: &mut Problems,
) -> Option<Vec<f64>> {
    let before = problems.list.len();
    let mut numbers = Vec::with_capacity(items.len());
    for item in items {
        match item.value {
            Raw::Text(_) | Raw::Number(_) | Raw::Integer(_) => {
                numbers.extend(quantity(item, measure, bound, path, problems));
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
    (problems.list.len() == before).then_some(numbers)
}

/// The tables of a list.
fn tables(
    key: &Key,
    keys: &'static [Key],
    items: &[Node],
    path: &str,
    problems: &mut Problems,
) -> Vec<Values> {
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
    list
}

fn kind(
    choice: &'static dyn Kinds,
    key: &'static Key,
    entries: &[Line],
    place: &Place,
    path: &str,
    problems: &mut Problems,
) -> Option<Value> {
    let kind_path = join(path, "kind");
    let Some(entry) = entries.iter().find(|entry| entry.key == "kind") else {
        // A table that only changes some keys of the default kind.
        if let Presence::Name(name) = key.presence
            && let Some(kind) = choice.kind(name)
        {
            return Some(of_kind(choice, kind, entries, place, path, problems));
        }
        let problem =
            Problem::new(kind_path, Some(place.clone()), format!("the kind of {} is missing", choice.name()));
        problems.push(problem.label("`kind` belongs here").help(format!("the kinds are {}", choice.names())));
        return None;
    };
    let Raw::Text(name) = &entry.node.value else {
        let message = format!("a kind is a text, not {}", entry.node.value.describe());
        let problem = Problem::new(kind_path, Some(entry.node.place.clone()), message);
        problems.push(problem.help(format!("the kinds are {}", choice.names())));
        return None;
    };
    let kind = chosen(choice, name, &entry.node.place, &kind_path, problems)?;
    Some(of_kind(choice, kind, entries, place, path, problems))
}

fn of_kind(
    choice: &'static dyn Kinds,
    kind: Entry,
    entries: &[Line],
    place: &Place,
    path: &str,
    problems: &mut Problems,
) -> Value {
    let suspected = unknown(entries, kind.keys, path, Some((choice, kind)), problems);
    Value::Kind(kind, known(entries, Some(place.clone()), kind.keys, path, &suspected, problems))
}

fn chosen(
    choice: &'static dyn Kinds,
    name: &str,
    place: &Place,
    path: &str,
    problems: &mut Problems,
) -> Option<Entry> {
    let kind = choice.kind(name);
    if kind.is_none() {
        let mut problem =
            Problem::new(path, Some(place.clone()), format!("unknown {} `{name}`", choice.name()));
        let kinds = choice.kinds();
        // By its name, or by another that its summary gives: RPIM.
        let called = |kind: &&Entry| {
            kind.summary.split(|c: char| !c.is_alphanumeric()).any(|word| word.eq_ignore_ascii_case(name))
        };
        let near = nearest(name, kinds.iter().map(|kind| kind.name));
        if let Some(near) = near.or(kinds.iter().find(called).map(|kind| kind.name)) {
            problem = problem.label(format!("did you mean `{near}`?"));
        }
        problems.push(problem.help(format!("it is one of {}", choice.names())));
    }
    kind
}

fn default(key: &'static Key, path: &str, problems: &mut Problems) -> Option<Value> {
    match (key.presence, &key.takes) {
        (Presence::Required | Presence::Optional | Presence::Run, _) => None,
        (Presence::Number(value), _) => Some(Value::Number(value)),
        (Presence::Integer(value), _) => Some(Value::Integer(value)),
        (Presence::Boolean(value), _) => Some(Value::Boolean(value)),
        (Presence::Name(name), Type::Kind(choice)) => {
            let kind = choice.kind(name)?;
            Some(Value::Kind(kind, known(&[], None, kind.keys, path, &[], problems)))
        }
        (Presence::Name(name), _) => Some(Value::Text(name.to_owned())),
        (Presence::Empty, Type::Table(keys)) => Some(Value::Table(table(&[], None, keys, path, problems))),
        (Presence::Empty, Type::Tables(_)) => Some(Value::Tables(Vec::new())),
        (Presence::Empty, Type::Texts | Type::Places) => Some(Value::Texts(Vec::new())),
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
    bounded(number, &measure.unit, bound, path, &node.place, problems)
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
        let is_plain = value == 0.0 || (1e-9..1e16).contains(&value.abs());
        let value = if is_plain { value.to_string() } else { format!("{value:e}") };
        format!("must be {}, but is {value}{space}{unit}", bound.words())
    } else {
        // −0 and 0 are the same case.
        return Some(value + 0.0);
    };
    problems.push(Problem::new(path, Some(place.clone()), message));
    None
}
