//! The raw case: a TOML tree that knows where each key and value was written.

use super::problem::{Place, Problem, Problems, Source};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Deepest nesting of tables and lists that is read: a case needs four.
const DEEPEST: usize = 12;

/// A value and where it was written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    pub place: Place,
    pub value: Raw,
}

/// A TOML value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Raw {
    Text(String),
    Integer(i64),
    Number(f64),
    Boolean(bool),
    List(Vec<Node>),
    Table(Vec<Line>),
    /// A value that no key takes, described: a date, an integer out of range …
    Other(&'static str),
}

/// A key of a table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    pub key: String,
    pub place: Place,
    pub node: Node,
}

impl Raw {
    /// What it is, with its article.
    pub fn describe(&self) -> &'static str {
        match self {
            Raw::Text(_) => "a text",
            Raw::Integer(_) => "an integer",
            Raw::Number(_) => "a number",
            Raw::Boolean(_) => "a boolean",
            Raw::List(_) => "a list",
            Raw::Table(_) => "a table",
            Raw::Other(what) => what,
        }
    }
}

/// Parses the file, source 0 of `problems`, then lays the overrides over it.
pub(super) fn read(text: &str, overrides: &[String], problems: &mut Problems) -> Node {
    let (table, errors) = DeTable::parse_recoverable(text);
    for error in errors {
        problems.push(syntax(0, error.message(), error.span()));
    }
    let place = Place::default();
    let mut root = Node { place, value: convert_table(table.get_ref(), 0, 0, problems) };
    for argument in overrides {
        lay_over(&mut root, argument, problems);
    }
    root
}

fn syntax(source: usize, message: &str, span: Option<std::ops::Range<usize>>) -> Problem {
    let place = span.map(|span| Place::new(source, span));
    Problem::new("", place, format!("not valid TOML: {message}"))
}

fn convert(value: &Spanned<DeValue<'_>>, source: usize, depth: usize, problems: &mut Problems) -> Node {
    let place = Place::new(source, value.span());
    if depth > DEEPEST {
        problems.push(Problem::new("", Some(place.clone()), format!("nested deeper than {DEEPEST} levels")));
        return Node { place, value: Raw::Other("a nested value") };
    }
    let value = match value.get_ref() {
        DeValue::String(text) => Raw::Text(text.clone().into_owned()),
        DeValue::Boolean(value) => Raw::Boolean(*value),
        DeValue::Integer(digits) => match i64::from_str_radix(digits.as_str(), digits.radix()) {
            Ok(value) => Raw::Integer(value),
            Err(_) => Raw::Other("an integer out of range"),
        },
        DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
            Ok(value) => Raw::Number(value),
            Err(_) => Raw::Other("an unreadable number"),
        },
        DeValue::Datetime(_) => Raw::Other("a date"),
        DeValue::Array(items) => {
            Raw::List(items.iter().map(|item| convert(item, source, depth + 1, problems)).collect())
        }
        DeValue::Table(table) => convert_table(table, source, depth + 1, problems),
    };
    Node { place, value }
}

fn convert_table(table: &DeTable<'_>, source: usize, depth: usize, problems: &mut Problems) -> Raw {
    let entry = |(key, value): (&Spanned<_>, _), problems: &mut Problems| {
        let name: &toml::de::DeString<'_> = key.get_ref();
        let place = Place::new(source, key.span());
        Line { key: name.clone().into_owned(), place, node: convert(value, source, depth, problems) }
    };
    let mut entries: Vec<Line> = table.iter().map(|pair| entry(pair, problems)).collect();
    entries.sort_by(|a, b| a.place.cmp(&b.place));
    Raw::Table(entries)
}

/// Applies one `KEY=VALUE` argument; KEY is a dotted path, VALUE is TOML or else a bare text.
pub(super) fn lay_over(root: &mut Node, argument: &str, problems: &mut Problems) {
    let source = problems.sources.len();
    problems.sources.push(Source { name: "--set".to_owned(), text: argument.to_owned() });
    let all = Place::new(source, 0..argument.len());
    let Some(equals) = argument.find('=') else {
        problems.push(
            Problem::new("", Some(all), "an override is KEY=VALUE")
                .help("for example `--set section.modulus=\"30 GPa\"`"),
        );
        return;
    };
    let path = &argument[..equals];
    let value = argument[equals + 1..].trim();
    // Where the value begins in the argument.
    let start = argument.len() - argument[equals + 1..].trim_start().len();
    if path.split('.').count() > DEEPEST {
        problems.push(Problem::new("", Some(all), format!("a key deeper than {DEEPEST} levels")));
        return;
    }
    let (parsed, errors) = DeValue::parse_recoverable(value);
    let mut node = if errors.is_empty() {
        convert(&parsed, source, 0, problems)
    } else {
        Node { place: Place::default(), value: Raw::Text(value.to_owned()) }
    };
    shift(&mut node, start);
    if !errors.is_empty() {
        node.place = Place::new(source, start..start + value.len());
    }
    let mut at = 0;
    let mut target = root;
    for part in path.split('.') {
        let name = part.trim();
        let place = Place::new(source, at..at + part.len());
        at += part.len() + 1;
        if name.is_empty() {
            problems.push(Problem::new("", Some(all), "the key of an override is empty"));
            return;
        }
        if let Raw::Text(_) = target.value {
            // A name alone is a table with that `kind`.
            let kind = Line { key: "kind".to_owned(), place: target.place.clone(), node: target.clone() };
            *target = Node { place: place.clone(), value: Raw::Table(vec![kind]) };
        }
        let found = match &target.value {
            Raw::List(items) => {
                let of_name = numbered(items, name).or_else(|| named(items, name));
                let tables = items.iter().filter(|item| matches!(item.value, Raw::Table(_))).count();
                if of_name.is_none() && tables > 1 {
                    let parent = path.get(..at.saturating_sub(part.len() + 2)).unwrap_or_default();
                    let message =
                        format!("is a list of {tables} tables, of which none has the name `{name}`");
                    let help =
                        format!("write a number from 0 to {}, or a name: {}", tables - 1, names(items));
                    problems.push(Problem::new(parent, Some(place), message).help(help));
                    return;
                }
                of_name.map(|i| (i, true)).or((tables == 1 && items.len() == 1).then_some((0, false)))
            }
            _ => None,
        };
        if let Some((i, is_name)) = found {
            let Raw::List(items) = &mut target.value else { return };
            target = &mut items[i];
            if is_name {
                continue;
            }
        }
        let what = target.value.describe();
        let Raw::Table(entries) = &mut target.value else {
            let parent = path.get(..at.saturating_sub(part.len() + 2)).unwrap_or_default();
            problems.push(Problem::new(parent, Some(place), format!("is {what} and has no keys")));
            return;
        };
        let index = entries.iter().position(|e| e.key == name).unwrap_or_else(|| {
            let empty = Node { place: place.clone(), value: Raw::Table(Vec::new()) };
            entries.push(Line { key: name.to_owned(), place: place.clone(), node: empty });
            entries.len() - 1
        });
        if at > path.len() {
            entries[index].place = place;
        }
        target = &mut entries[index].node;
    }
    *target = node;
}

/// The place in a list that a part of a path numbers, from 0.
fn numbered(items: &[Node], part: &str) -> Option<usize> {
    part.parse().ok().filter(|i| *i < items.len())
}

/// The name of a table in a list.
fn name_of(item: &Node) -> Option<&str> {
    let Raw::Table(entries) = &item.value else { return None };
    entries.iter().find(|entry| entry.key == "name").and_then(|entry| match &entry.node.value {
        Raw::Text(name) => Some(name.as_str()),
        _ => None,
    })
}

/// The table with a name.
fn named(items: &[Node], part: &str) -> Option<usize> {
    items.iter().position(|item| name_of(item) == Some(part))
}

/// The names in a list, for people.
fn names(items: &[Node]) -> String {
    let names: Vec<String> = items.iter().filter_map(name_of).map(|name| format!("`{name}`")).collect();
    if names.is_empty() { "none has one".to_owned() } else { names.join(", ") }
}

/// Moves the places of a value that was parsed from the middle of its source.
fn shift(node: &mut Node, by: usize) {
    node.place.start += by;
    node.place.end += by;
    match &mut node.value {
        Raw::List(items) => items.iter_mut().for_each(|item| shift(item, by)),
        Raw::Table(entries) => {
            for entry in entries {
                entry.place.start += by;
                entry.place.end += by;
                shift(&mut entry.node, by);
            }
        }
        _ => {}
    }
}
