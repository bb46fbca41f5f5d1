//! `flexion list`: every table and every kind with its keys, from their declarations.

use crate::{Outcome, screen};
use clap::builder::PossibleValuesParser;
use flexion_case::declaration::{Bound, Entry, Key, Kinds, Presence, Type, short};

/// What to list.
#[derive(clap::Args)]
#[command(after_help = "Examples:\n  flexion list\n  flexion list integrator\n  flexion list force")]
pub struct Arguments {
    /// Only this table or choice, with its keys: e.g. section, gravity, output, integrator, contact.law
    #[arg(value_name = "NAME", value_parser = known())]
    name: Option<String>,
    /// Write the page of all keys, as Markdown
    #[arg(long, conflicts_with = "name")]
    markdown: bool,
}

/// Lists all tables and kinds, or those of one name with their keys.
pub fn list(arguments: &Arguments) -> Outcome {
    if arguments.markdown {
        screen::print(&page());
        return Outcome::Finished;
    }
    let Some(name) = &arguments.name else {
        screen::print(&overview());
        return Outcome::Finished;
    };
    let mut out: Vec<String> = Vec::new();
    for (subject, keys) in flexion_case::keys() {
        let known = keys.iter().filter(|key| key.name == name && !matches!(key.takes, Type::Kind(_)));
        out.extend(known.map(|key| table(key, subject)));
    }
    out.dedup();
    let called =
        |choice: &&&dyn Kinds| choice.path() == name || choice.path().rsplit('.').next() == Some(name);
    out.extend(choices().filter(called).map(|choice| kinds(*choice)));
    screen::print(&out.join("\n"));
    Outcome::Finished
}

fn choices() -> impl Iterator<Item = &'static &'static dyn Kinds> {
    flexion_case::choices().iter()
}

/// What can be listed, which shells complete: tables and keys at the top, and choices by their places or the last part of these.
fn known() -> PossibleValuesParser {
    let keys = flexion_case::keys().into_iter().flat_map(|(_, keys)| keys).map(|key| key.name);
    let last = |path: &'static str| path.rsplit('.').next().unwrap_or(path);
    let paths = choices().flat_map(|choice| [choice.path(), last(choice.path())]);
    let mut names: Vec<&str> = keys.chain(paths).collect();
    names.sort_unstable();
    names.dedup();
    names.into()
}

/// All tables and all kinds, one line each.
fn overview() -> String {
    let mut out = String::new();
    for (subject, keys) in flexion_case::keys() {
        out.push_str(&format!("tables and keys of {subject}\n"));
        let row = |key: &Key| vec![key.name.to_owned(), key.doc.to_owned()];
        out.push_str(&screen::table(&keys.iter().map(row).collect::<Vec<_>>()));
        out.push('\n');
    }
    for choice in choices() {
        out.push_str(&heading(*choice));
        let row = |kind: &Entry| vec![kind.name.to_owned(), kind.summary.to_owned(), kind.source.to_owned()];
        out.push_str(&screen::table(&choice.kinds().iter().map(row).collect::<Vec<_>>()));
        out.push('\n');
    }
    out
}

/// A key at the top of a case, with the keys of its table.
fn table(key: &Key, subject: &str) -> String {
    let (form, keys) = match key.takes {
        Type::Table(keys) => (format!("[{}]", key.name), keys),
        Type::Tables(keys) => (format!("[[{}]]", key.name), keys),
        _ => (key.name.to_owned(), std::slice::from_ref(key)),
    };
    format!("{form} of {subject}: {}\n{}", key.doc, screen::table(&keys.iter().map(row).collect::<Vec<_>>()))
}

/// The kinds of a choice with their keys.
fn kinds(choice: &dyn Kinds) -> String {
    let mut out = heading(choice);
    for kind in choice.kinds() {
        out.push_str(&format!("\n{}: {}\n", kind.name, kind.summary));
        if !kind.source.is_empty() {
            out.push_str(&format!("  {}\n", kind.source));
        }
        out.push_str(&screen::table(&kind.keys.iter().map(row).collect::<Vec<_>>()));
    }
    out
}

/// All tables and kinds with their keys, as a page of the guide.
fn page() -> String {
    let mut out = "# Keys of a case\n\nEvery table, kind and key, as the program declares them: `flexion list --markdown` writes this \
                   page, `flexion list NAME` shows a part of it.\n"
        .to_owned();
    for (subject, keys) in flexion_case::keys() {
        out.push_str(&format!("\n## A case of {subject}\n"));
        let plain = |key: &&Key| !matches!(key.takes, Type::Table(_) | Type::Tables(_));
        out.push_str(&rows(keys.iter().filter(plain)));
        for key in keys {
            let (open, close, keys) = match key.takes {
                Type::Table(keys) => ("[", "]", keys),
                Type::Tables(keys) => ("[[", "]]", keys),
                _ => continue,
            };
            let (name, when) = (key.name, default(key));
            out.push_str(&format!("\n### `{open}{name}{close}`\n\n{} ({when}).\n", key.doc));
            out.push_str(&rows(keys.iter()));
        }
    }
    for choice in choices() {
        out.push_str(&format!("\n## `{}`: {}\n\n{}.\n", choice.path(), choice.name(), choice.summary()));
        for kind in choice.kinds() {
            let source = if kind.source.is_empty() { String::new() } else { format!(" ({})", kind.source) };
            out.push_str(&format!("\n**`{}`**: {}{source}\n", kind.name, cell(kind.summary)));
            out.push_str(&rows(kind.keys.iter()));
        }
    }
    out
}

/// A table of keys in Markdown, if there are any.
fn rows<'k>(keys: impl Iterator<Item = &'k Key>) -> String {
    let line = |key: &Key| {
        format!("| `{}` | {} | {} | {} |\n", key.name, cell(&takes(key)), default(key), cell(key.doc))
    };
    let lines: String = keys.map(line).collect();
    if lines.is_empty() {
        lines
    } else {
        format!("\n| key | takes | | meaning |\n|---|---|---|---|\n{lines}")
    }
}

/// Text that Markdown leaves as it is.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('*', "\\*").replace('<', "\\<")
}

fn heading(choice: &dyn Kinds) -> String {
    format!("{} ({}): {}\n", choice.name(), choice.path(), choice.summary())
}

/// Name, type, default and meaning of a key.
fn row(key: &Key) -> Vec<String> {
    vec![key.name.to_owned(), takes(key), default(key), key.doc.to_owned()]
}

/// What a key takes, in a few words.
fn takes(key: &Key) -> String {
    let takes = match key.takes {
        Type::Quantity(measure, _) => measure.unit.to_string(),
        Type::Place => "place".to_owned(),
        Type::Places => "place, or list of places".to_owned(),
        Type::Moment(measure) => format!("{0}, or list, {0}", measure.unit),
        Type::Quantities(measure, _) => format!("list, {}", measure.unit),
        Type::Number(_) => "number".to_owned(),
        Type::Integer(low, high) => format!("integer {low} … {high}"),
        Type::Boolean => "true or false".to_owned(),
        Type::Text => "text".to_owned(),
        Type::Texts => "list of texts".to_owned(),
        Type::Path => "path".to_owned(),
        Type::Choice(choice) => choice.kinds().iter().map(|kind| kind.name).collect::<Vec<_>>().join(" or "),
        Type::Table(_) => "table".to_owned(),
        Type::Tables(_) => "tables".to_owned(),
        Type::Kind(choice) => format!("table: {}", choice.name()),
    };
    match key.takes {
        Type::Quantity(_, bound) | Type::Quantities(_, bound) | Type::Number(bound)
            if bound != Bound::Any =>
        {
            format!("{takes}, {}", bound.words())
        }
        _ => takes,
    }
}

/// Whether a key may be left out, and what is then taken.
fn default(key: &Key) -> String {
    match key.presence {
        Presence::Required => "required".to_owned(),
        Presence::Run => "required of a run".to_owned(),
        Presence::Optional | Presence::Empty => "optional".to_owned(),
        Presence::Number(value) => format!("default {}", short(value)),
        Presence::Integer(value) => format!("default {value}"),
        Presence::Boolean(value) => format!("default {value}"),
        Presence::Name("") => "optional".to_owned(),
        Presence::Name(value) => format!("default {value}"),
    }
}
