//! Changes of a case in its text, and how one case differs from another.

use super::problem::{Place, Problems};
use super::reading::{Reading, parse_with};
use super::tree::{self, Line, Node, Raw};
use std::ops::Range;

impl Reading {
    /// The text of the case with changes, dotted path and value as of `--set`, written into it; comments stay. Where that cannot be, it
    /// is the case as it is [stated](Reading::stated), without its comments.
    ///
    /// # Errors
    /// Everything that is wrong with the changes.
    pub fn edited(&self, changes: &[(String, String)]) -> Result<String, Problems> {
        let set: Vec<String> = changes.iter().map(|(path, value)| format!("{path}={value}")).collect();
        let changed = self.with(&set)?;
        let text = self.sources().first().map_or(String::new(), |source| source.text.clone());
        let edited = changes.iter().try_fold(text, |text, (path, value)| edit(&text, path, value));
        let same = edited.filter(|text| {
            let read = parse_with(text.clone(), &self.file, &[], self.contents());
            read.is_ok_and(|read| read.means(&changed))
        });
        Ok(same.unwrap_or_else(|| changed.stated()))
    }

    /// The changes, dotted path and value as of `--set`, that make this case of another; `None` where no such changes do.
    pub fn difference(&self, from: &Reading) -> Option<Vec<(String, String)>> {
        let (mine, theirs) = (self.given(), from.given());
        let mut set = Vec::new();
        // Tables of another kind, all keys of which are said.
        let mut anew: Vec<String> = Vec::new();
        for given in &mine {
            let other = theirs.iter().find(|other| other.path == given.path);
            let within = anew.iter().any(|path| given.path.starts_with(path.as_str()));
            let differs = within || other.is_none_or(|other| other.value != given.value);
            let is_said = given.place.is_some() || other.is_some_and(|other| other.place.is_some());
            if !differs || !is_said || given.is_table() || (within && given.place.is_none()) {
                continue;
            }
            if given.is_kind() {
                anew.push(format!("{}.", given.path));
            }
            set.push((given.path.clone(), given.written.unwrap_or(&given.value).to_owned()));
        }
        let changes: Vec<String> = set.iter().map(|(path, value)| format!("{path}={value}")).collect();
        from.with(&changes).ok().filter(|case| case.means(self)).map(|_| set)
    }
}

/// A text with one value changed, or a key added; `None` where it has no place for it.
fn edit(text: &str, path: &str, value: &str) -> Option<String> {
    let mut problems = Problems::default();
    let root = tree::read(text, &[], &mut problems);
    let value = if tree::is_value(value) { value.to_owned() } else { toml::Value::from(value).to_string() };
    let (mut at, mut parts) =
        (&root, path.split(['.', '[']).map(|part| part.trim_end_matches(']')).peekable());
    while let Some(part) = parts.next() {
        match &at.value {
            Raw::Table(lines) => match lines.iter().find(|line| line.key == part) {
                Some(line) => at = &line.node,
                None if parts.peek().is_some() => return None,
                None => return added(text, at, lines, &format!("{part} = {value}")),
            },
            Raw::List(items) => at = tree::item(items, part)?,
            _ => return None,
        }
    }
    let of = span(text, &at.place)?;
    // A table of its own heading is not one place.
    let one = !matches!(at.value, Raw::Table(_)) || text[of.clone()].starts_with('{');
    if one {
        Some(format!("{}{value}{}", &text[..of.start], &text[of.end..]))
    } else {
        anew(text, path, &value)
    }
}

/// A text with other lines under the heading of a table and in the place of its inner tables.
fn anew(text: &str, path: &str, value: &str) -> Option<String> {
    let read = toml::from_str::<toml::Table>(&format!("value = {value}")).ok()?;
    let table = read.get("value")?.as_table()?;
    // The kind stands first.
    let (kind, other): (Vec<_>, Vec<_>) = table.iter().partition(|(key, _)| *key == "kind");
    let lines = kind.into_iter().chain(other).map(|(key, value)| format!("{key} = {value}\n"));
    let heading = format!("[{path}]");
    let inner = format!("[{path}.");
    let (mut out, mut within) = (String::new(), false);
    let mut lines = Some(lines.collect::<String>());
    for line in text.split_inclusive('\n') {
        let bare = line.trim_start();
        if bare.starts_with(&heading) {
            out.push_str(line);
            out.push_str(&lines.take()?);
            within = true;
        } else if bare.starts_with('[') && !bare.starts_with(&inner) && within {
            out.push('\n');
            within = false;
        }
        if !within {
            out.push_str(line);
        }
    }
    lines.is_none().then_some(out)
}

/// A text with a line added to a table.
fn added(text: &str, table: &Node, lines: &[Line], line: &str) -> Option<String> {
    let inline = span(text, &table.place).is_some_and(|of| text[of].starts_with('{'));
    let is_plain = |line: &&Line| match &line.node.value {
        Raw::Table(_) => span(text, &line.node.place).is_some_and(|of| text[of].starts_with('{')),
        Raw::List(_) => span(text, &line.node.place).is_some_and(|of| text[of].starts_with('[')),
        _ => true,
    };
    let last = lines.iter().filter(is_plain).map(|line| line.node.place.end).max();
    let (before, between) = match last {
        Some(end) if inline => (end, ", "),
        // Behind the line with its comment.
        Some(end) => (text.get(end..)?.find('\n').map_or(text.len(), |at| end + at), "\n"),
        None => return None,
    };
    Some(format!("{}{between}{line}{}", text.get(..before)?, text.get(before..)?))
}

fn span(text: &str, place: &Place) -> Option<Range<usize>> {
    let of = place.start..place.end;
    (place.source == 0 && text.get(of.clone()).is_some() && !of.is_empty()).then_some(of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse;
    use std::path::Path;

    const CASE: &str = include_str!("../../verification/p1_spin_up_4/case.toml");

    fn reading(text: &str) -> Reading {
        parse(text.to_owned(), Path::new("case.toml"), &[]).unwrap()
    }

    fn pairs(of: &[(&str, &str)]) -> Vec<(String, String)> {
        of.iter().map(|(path, value)| ((*path).to_owned(), (*value).to_owned())).collect()
    }

    #[test]
    fn a_change_is_written_at_its_place_and_comments_stay() {
        let case = reading(CASE);
        let edited =
            case.edited(&pairs(&[("section.modulus", "\"30 GPa\""), ("basis.elements", "7")])).unwrap();
        assert!(edited.contains("30 GPa") && edited.contains("elements = 7"), "{edited}");
        assert_eq!(edited.matches('#').count(), CASE.matches('#').count());
        assert_eq!(edited.lines().count(), CASE.lines().count());
        // A bare text is a text, and a key that is not there is added to its table.
        let edited = case
            .edited(&pairs(&[("section.modulus", "30 GPa"), ("output.energy-balance", "false")]))
            .unwrap();
        assert_eq!(edited.lines().count(), CASE.lines().count() + 1, "{edited}");
        // A table of another kind has other lines under its heading.
        let edited = case.edited(&pairs(&[("basis", "{kind='modes', axial=4, transverse=5}")])).unwrap();
        assert!(edited.contains("[basis]\nkind = \"modes\"\naxial = 4\ntransverse = 5\n\n["), "{edited}");
        assert!(edited.contains("\"70 GPa\"") && !edited.contains("elements"), "{edited}");
        assert!(
            reading(&edited)
                .means(&case.with(&["basis={kind='modes', axial=4, transverse=5}".to_owned()]).unwrap())
        );
        let problems = case.edited(&pairs(&[("section.moduls", "1")])).unwrap_err();
        assert!(problems.reason().contains("unknown"), "{}", problems.reason());
    }

    #[test]
    fn a_case_differs_by_changes_that_make_it_of_the_other() {
        let case = reading(CASE);
        let changes =
            ["section.modulus=30 GPa", "basis=modes", "output.energy-balance=false", "basis.transverse=4"];
        let other = case.with(&changes.map(str::to_owned)).unwrap();
        let set = other.difference(&case).unwrap();
        let made = case
            .with(&set.iter().map(|(path, value)| format!("{path}={value}")).collect::<Vec<_>>())
            .unwrap();
        assert!(made.means(&other) && set.len() == 4, "{set:?}");
        assert_eq!(case.difference(&case), Some(Vec::new()));
        let spatial = reading(include_str!("../../verification/space_joints/case.toml"));
        assert_eq!(spatial.difference(&case), None);
    }
}
