//! Case files to begin with. A template gives values only: what they mean, what else could be set and the kinds
//! there are to choose from is written in from the declarations.

mod cases;

use super::declaration::{Bound, Entry, Key, Kinds, Type};
use super::layout;
use super::problem::Problems;
use super::reading::{Reading, parse_with};
use super::resolved::written;
use super::sources::Contents;
use super::values::{Filled, Value, Values, join};
pub use cases::TEMPLATES;
use std::fmt::Write;
use std::path::Path;

/// A case to begin with.
#[derive(Clone, Copy, Debug)]
pub struct Template {
    /// Name.
    pub name: &'static str,
    /// One line on what it shows.
    pub summary: &'static str,
    /// The values, as a case file without comments.
    text: &'static str,
    /// The file that it names, and what is in it.
    pub file: Option<(&'static str, &'static str)>,
}

/// What stands over the tables that a template does without.
const FURTHER: &str =
    "# What else such a case may have: remove the # in front of a table and of its lines to use it.";

impl Template {
    /// The case file with its comments.
    ///
    /// # Errors
    /// [`Problems`] if the template were no case.
    pub fn render(&self) -> Result<String, Problems> {
        let reading = self.read(&[])?;
        let mut out = format!(
            "# {}: {}.\n#\n\
             # Check this case with `flexion check`, run it with `flexion run`; `flexion list` shows all tables and kinds.\n\
             # A quantity is a text with its unit, or a number in SI. Lines like `#key = value` show what else can\n\
             # be set: its default, or an example.\n\n",
            self.name, self.summary
        );
        let values = reading.written();
        Writer { texts: [self.text, ""] }.table(values, values.keys, None, "", &mut out);
        if !layout::is_spatial(values.keys) {
            out.push_str(&self.further(values));
        }
        Ok(out)
    }

    /// The tables that the case could have, commented out: their examples.
    fn further(&self, values: &Values) -> String {
        let mut out = format!("\n{FURTHER}\n");
        for example in crate::examples_of_tables() {
            let name = example.split('=').next().unwrap_or_default();
            if values.entries.iter().any(|filled| filled.key.name == name && filled.place.is_some()) {
                continue;
            }
            // A table that does not go with the others, as a blade with a graded section, is left out.
            let Ok(reading) = self.read(&[example.to_owned()]) else { continue };
            let with = reading.written();
            let mut table = String::new();
            for filled in with.entries.iter().filter(|filled| filled.key.name == name) {
                Writer { texts: [self.text, example] }.nested(filled, "", &mut table);
            }
            for line in table.lines() {
                let _ = match line.is_empty() || line.starts_with('#') {
                    true => writeln!(out, "{line}"),
                    false => writeln!(out, "#{}", line.replace('\'', "\"")),
                };
            }
        }
        out
    }

    /// The case with changes, beside the file that it names.
    fn read(&self, changes: &[String]) -> Result<Reading, Problems> {
        let bytes = |(name, text): (&str, &str)| (name.to_owned(), text.as_bytes().into());
        let files: Contents = self.file.map(bytes).into_iter().collect();
        parse_with(self.text.to_owned(), Path::new(self.name), changes, &files)
    }
}

/// Writes tables with comments.
struct Writer {
    /// What the values were read from: the case and a change of it.
    texts: [&'static str; 2],
}

/// One line of a table: text, comment.
type Line = (String, String);

impl Writer {
    fn table(
        &self,
        values: &Values,
        keys: &'static [Key],
        kind: Option<(&Entry, bool)>,
        path: &str,
        out: &mut String,
    ) {
        let mut lines: Vec<Line> = Vec::new();
        if let Some((kind, given)) = kind {
            let mark = if given { "" } else { "#" };
            lines.push((format!("{mark}kind = \"{}\"", kind.name), kind.summary.to_owned()));
        }
        let filled = |key: &Key| values.entries.iter().find(|filled| filled.key.name == key.name);
        for key in keys.iter().filter(|key| !nested(key)) {
            let given = filled(key).is_some_and(|filled| filled.place.is_some());
            let comment = meaning(key, given);
            match filled(key) {
                Some(Filled { place: Some(place), .. }) => {
                    let text = self.texts.get(place.source).copied().unwrap_or_default();
                    let written = text.get(place.start..place.end).unwrap_or_default();
                    lines.push((format!("{} = {written}", key.name), comment));
                }
                Some(Filled { value, .. }) => {
                    lines.push((format!("#{} = {}", key.name, written(value, &key.takes, false)), comment));
                }
                None => lines.push((format!("#{} = {}", key.name, example(&key.takes)), comment)),
            }
        }
        let width = lines.iter().map(|(text, _)| text.chars().count()).max().unwrap_or(0);
        for (text, comment) in lines {
            let fill = " ".repeat(width - text.chars().count());
            let _ = writeln!(out, "{text}{fill}  # {comment}");
        }
        for key in keys.iter().filter(|key| nested(key)) {
            if let Some(filled) = filled(key) {
                self.nested(filled, path, out);
            }
        }
    }

    /// A table, or a list of tables, under its heading.
    fn nested(&self, Filled { key, value, place }: &Filled, path: &str, out: &mut String) {
        let path = join(path, key.name);
        if let (Value::Tables(list), Type::Tables(keys)) = (value, key.takes) {
            for (number, values) in list.iter().enumerate() {
                let what = if number == 0 { format!("# {}\n", capitalised(key.doc)) } else { String::new() };
                let _ = writeln!(out, "\n{what}[[{path}]]");
                self.table(values, keys, None, &path, out);
            }
            return;
        }
        let mark = if place.is_some() { "" } else { "#" };
        let choice = match key.takes {
            Type::Kind(choice) => format!("; its kind is one of {}", names(choice)),
            _ => String::new(),
        };
        let _ = writeln!(out, "\n# {}{choice}\n{mark}[{path}]", capitalised(key.doc));
        match (value, key.takes) {
            (Value::Table(values), Type::Table(keys)) => self.table(values, keys, None, &path, out),
            (Value::Kind(kind, values), Type::Kind(_)) => {
                self.table(values, kind.keys, Some((kind, place.is_some())), &path, out);
            }
            _ => {}
        }
    }
}

fn nested(key: &Key) -> bool {
    matches!(key.takes, Type::Table(_) | Type::Tables(_) | Type::Kind(_))
}

/// What a key means, its unit and limits, what it can be chosen from, and whether it can be left out where it is not given.
fn meaning(key: &Key, given: bool) -> String {
    let mut text = key.doc.to_owned();
    match key.takes {
        Type::Quantity(measure, bound) | Type::Quantities(measure, bound) => {
            let _ = write!(text, " [{}]", measure.unit);
            limits(bound, &mut text);
        }
        Type::Place => text.push_str(", such as \"tip\" or \"2 m\""),
        Type::Moment(measure) => {
            let _ = write!(text, " [{}]", measure.unit);
        }
        Type::Number(bound) => limits(bound, &mut text),
        Type::Choice(choice) => {
            let _ = write!(text, "; one of {}", names(choice));
        }
        _ => {}
    }
    if key.presence.is_optional() && !given {
        text.push_str(" (optional)");
    }
    text
}

fn names(choice: &dyn Kinds) -> String {
    choice.kinds().iter().map(|kind| kind.name).collect::<Vec<_>>().join(", ")
}

fn limits(bound: Bound, text: &mut String) {
    if bound != Bound::Any {
        let _ = write!(text, ", {}", bound.words());
    }
}

/// A value of the type, for a key without default.
fn example(takes: &Type) -> String {
    match takes {
        Type::Quantity(measure, _) => {
            // The second one is small: times that can be left out are short.
            let examples: Vec<&str> = measure.examples.split(", ").collect();
            let small = examples.get(1).or(examples.first()).copied().unwrap_or_default();
            format!("\"{}\"", small.trim_matches(['`', '"']))
        }
        Type::Place | Type::Places => "\"tip\"".to_owned(),
        _ => "…".to_owned(),
    }
}

fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().chain(chars).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every value of the case of a template with this text, defaults included.
    fn case(template: &Template, text: &str) -> String {
        let contents: Contents =
            template.file.map(|(name, text)| (name.to_owned(), text.as_bytes().into())).into_iter().collect();
        parse_with(text.to_owned(), Path::new("case.toml"), &[], &contents)
            .unwrap_or_else(|p| panic!("{}: {}\n{text}", template.name, p.render(false)))
            .resolved()
    }

    /// The text without the marks before values, except of keys that have none.
    fn uncommented(text: &str) -> String {
        let optional = |line: &&str| !(line.starts_with('#') && line.ends_with("(optional)"));
        let lines = text.lines().filter(optional);
        lines
            .map(|line| line.strip_prefix('#').filter(|l| !l.starts_with(' ')).unwrap_or(line))
            .collect::<Vec<_>>()
            .join("\n")
    }

    #[test]
    fn the_commented_file_is_the_same_case_as_the_template() {
        for template in TEMPLATES {
            assert_eq!(
                case(template, &template.render().unwrap()),
                case(template, template.text),
                "{}",
                template.name
            );
        }
    }

    #[test]
    fn the_defaults_shown_are_those_in_force() {
        for template in TEMPLATES {
            let text = template.render().unwrap();
            let text = text.split(FURTHER).next().unwrap();
            assert_ne!(uncommented(text), text.trim_end());
            assert_eq!(
                case(template, &uncommented(text)),
                case(template, template.text),
                "{}",
                template.name
            );
        }
    }

    #[test]
    fn each_further_table_can_be_used_as_it_stands() {
        for template in TEMPLATES {
            let text = template.render().unwrap();
            let Some((text, further)) = text.split_once(FURTHER) else { continue };
            // A table with those within it.
            let mut tables: Vec<String> = Vec::new();
            for block in further.split("\n\n").filter(|block| block.contains("#[")) {
                let inner = block.lines().any(|line| line.starts_with("#[") && line.contains('.'));
                match tables.last_mut().filter(|_| inner) {
                    Some(table) => *table += &format!("\n\n{block}"),
                    None => tables.push(block.to_owned()),
                }
            }
            assert!(tables.len() > 3, "{}: {tables:?}", template.name);
            for table in tables {
                let with = case(template, &format!("{text}\n{}", uncommented(&table)));
                assert_ne!(with, case(template, template.text), "{}: {table}", template.name);
            }
        }
    }

    #[test]
    fn every_line_that_sets_something_says_what_it_means() {
        for template in TEMPLATES {
            for line in template.render().unwrap().lines() {
                let prose = line.is_empty() || line.starts_with("# ") || line == "#";
                let header = line.trim_start_matches('#').starts_with('[');
                assert!(prose || header || line.contains("  # "), "{}: {line}", template.name);
                assert!(!line.contains('…') || line.contains("  # "), "{line}");
            }
        }
    }
}
