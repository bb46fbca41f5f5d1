//! The raw case: a TOML tree that knows where each key and value was written.

use super::change::{Change, Setting};
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
        // Of a key that is too deep the parser does not say where it is.
        let deep = if error.span().is_none() { deep_key(text) } else { None };
        problems.push(match deep {
            Some(key) => too_deep(Place::new(0, key)),
            None => syntax(0, error.message(), error.span()),
        });
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
    let problem = Problem::new("", place, format!("not valid TOML: {message}"));
    if message != "duplicate key" {
        return problem;
    }
    problem.help("a key is written once: `[beam]` is one table, and `[[beam]]`, each time it is written, one of several")
}

/// Where the first key with too many parts stands.
fn deep_key(text: &str) -> Option<std::ops::Range<usize>> {
    let key = |line: &str| line.split('=').next().unwrap_or_default().trim_end().len();
    let mut keys = text.split_inclusive('\n').scan(0, |end, line| {
        let start = *end;
        *end += line.len();
        Some(start..start + key(line))
    });
    keys.find(|span| text[span.clone()].matches('.').count() > DEEPEST)
}

fn too_deep(place: Place) -> Problem {
    Problem::new("", Some(place), format!("nested deeper than {DEEPEST} levels"))
}

fn convert(value: &Spanned<DeValue<'_>>, source: usize, depth: usize, problems: &mut Problems) -> Node {
    let place = Place::new(source, value.span());
    if depth > DEEPEST {
        problems.push(too_deep(place.clone()));
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
    put(root, path, node, &all, problems);
}

/// Makes a change of the program's own.
pub(super) fn change(root: &mut Node, change: &Change, problems: &mut Problems) {
    let (source, text) = (problems.sources.len(), change.to_string());
    let all = Place::new(source, 0..text.len());
    let node = set(&change.to, &Place::new(source, change.path.len() + 1..text.len()));
    problems.sources.push(Source { name: "--set".to_owned(), text });
    put(root, &change.path, node, &all, problems);
}

/// Adds a load, a table of TOML, to those of a case; a silent one has the amplitude zero.
pub(super) fn push_load(root: &mut Node, load: &str, silent: bool, problems: &mut Problems) {
    let source = problems.sources.len();
    problems.sources.push(Source { name: "load of an input or a law".to_owned(), text: load.to_owned() });
    let all = Place::new(source, 0..load.len());
    let (parsed, errors) = DeValue::parse_recoverable(load);
    if let Some(error) = errors.first() {
        problems.push(syntax(source, error.message(), error.span()));
        return;
    }
    let mut node = convert(&parsed, source, 0, problems);
    let line = |key: &str, node: Node| Line { key: key.to_owned(), place: all.clone(), node };
    if let (Raw::Table(entries), true) = (&mut node.value, silent) {
        if let Some(own) = entries.iter().find(|entry| entry.key == "amplitude") {
            let message = "is what an input or a law gives";
            problems
                .push(Problem::new("load.amplitude", Some(own.place.clone()), message).help("leave it out"));
            return;
        }
        let text =
            |key: &str, text: &str| line(key, Node { place: all.clone(), value: Raw::Text(text.to_owned()) });
        let zero = Raw::Table(vec![text("kind", "expression"), text("formula", "0")]);
        entries.push(line("amplitude", Node { place: all.clone(), value: zero }));
    }
    let Raw::Table(entries) = &mut root.value else { return };
    match entries.iter_mut().find(|entry| entry.key == "load").map(|entry| &mut entry.node.value) {
        Some(Raw::List(list)) => list.push(node),
        // One that is no list is refused at its own line.
        Some(_) => {}
        None => {
            let list = Node { place: all.clone(), value: Raw::List(vec![node]) };
            entries.push(line("load", list));
        }
    }
}

/// Takes the last loads away.
pub(super) fn pop_loads(root: &mut Node, count: usize) {
    let Raw::Table(entries) = &mut root.value else { return };
    let Some(at) = entries.iter().position(|entry| entry.key == "load") else { return };
    if let Raw::List(list) = &mut entries[at].node.value {
        list.truncate(list.len() - count.min(list.len()));
        if count > 0 && list.is_empty() {
            entries.remove(at);
        }
    }
}

/// The value of a setting at a place.
fn set(to: &Setting, place: &Place) -> Node {
    let line =
        |key: &str, to: &Setting| Line { key: key.to_owned(), place: place.clone(), node: set(to, place) };
    let value = match to {
        Setting::Number(x) => Raw::Number(*x),
        Setting::Integer(n) => Raw::Integer(*n),
        Setting::Boolean(value) => Raw::Boolean(*value),
        Setting::Name(name) => Raw::Text((*name).to_owned()),
        Setting::Kind(kind, keys) => {
            let kind = line("kind", &Setting::Name(kind));
            Raw::Table([kind].into_iter().chain(keys.iter().map(|(key, to)| line(key, to))).collect())
        }
    };
    Node { place: place.clone(), value }
}

/// Puts a node at a dotted path, which is written at the beginning of `all`.
fn put(root: &mut Node, path: &str, node: Node, all: &Place, problems: &mut Problems) {
    let source = all.source;
    let mut at = 0;
    let mut target = root;
    // Of a list, `load[1]` as messages write it is `load.1`.
    for part in path.split(['.', '[']) {
        let name = part.trim().trim_end_matches(']');
        let place = Place::new(source, at..at + part.len());
        at += part.len() + 1;
        if name.is_empty() {
            problems.push(Problem::new("", Some(all.clone()), "the key of an override is empty"));
            return;
        }
        if let Raw::Text(_) = target.value {
            // A name alone is a table with that `kind`.
            let kind = Line { key: "kind".to_owned(), place: target.place.clone(), node: target.clone() };
            *target = Node { place: place.clone(), value: Raw::Table(vec![kind]) };
        }
        let parent = path.get(..at.saturating_sub(part.len() + 2)).unwrap_or_default();
        let found = if let Raw::List(items) = &target.value { choose(items, name) } else { Ok(None) };
        match found {
            Err([message, help]) => {
                problems.push(Problem::new(parent, Some(place), message).help(help));
                return;
            }
            Ok(None) => {}
            Ok(Some((i, is_name))) => {
                let Raw::List(items) = &mut target.value else { return };
                target = &mut items[i];
                if is_name {
                    continue;
                }
            }
        }
        let what = target.value.describe();
        let Raw::Table(entries) = &mut target.value else {
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

/// Whether a text is a value of TOML.
pub(super) fn is_value(text: &str) -> bool {
    DeValue::parse_recoverable(text.trim()).1.is_empty()
}

/// The item of a list that a part of a path means.
pub(super) fn item<'n>(items: &'n [Node], part: &str) -> Option<&'n Node> {
    let (number, _) = choose(items, part).ok().flatten()?;
    items.get(number)
}

/// The item of a list that a part of a path means, and whether the part is its number, from 1, or its name: the only table of a list
/// needs neither.
///
/// # Errors
/// Of several tables none is meant: what is wrong, and what to write.
fn choose(items: &[Node], part: &str) -> Result<Option<(usize, bool)>, [String; 2]> {
    let number = part.parse::<usize>().ok();
    let numbered = number.and_then(|n| n.checked_sub(1)).filter(|i| *i < items.len());
    let named = || items.iter().position(|item| name_of(item) == Some(part));
    if let Some(i) = numbered.or_else(named) {
        return Ok(Some((i, true)));
    }
    match items.iter().filter(|item| matches!(item.value, Raw::Table(_))).count() {
        1 if items.len() == 1 && number.is_none() => Ok(Some((0, false))),
        tables @ 2.. => {
            let names: Vec<String> =
                items.iter().filter_map(name_of).map(|name| format!("`{name}`")).collect();
            let names = if names.is_empty() { "none has one".to_owned() } else { names.join(", ") };
            Err([
                format!("is a list of {tables} tables, of which none has the name `{part}`"),
                format!("write a number from 1 to {tables}, or a name: {names}"),
            ])
        }
        _ if number.is_some() && !items.is_empty() => Err([
            format!("is a list of {}, and has no number {part}", items.len()),
            format!("write a number from 1 to {}", items.len()),
        ]),
        _ => Ok(None),
    }
}

/// The name of a table in a list.
fn name_of(item: &Node) -> Option<&str> {
    let Raw::Table(entries) = &item.value else { return None };
    entries.iter().find(|entry| entry.key == "name").and_then(|entry| match &entry.node.value {
        Raw::Text(name) => Some(name.as_str()),
        _ => None,
    })
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
