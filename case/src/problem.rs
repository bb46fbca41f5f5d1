//! Problems of a case: collected all at once, each with its place, and rendered for people.
//!
//! The one module that knows the renderer.

#[cfg(feature = "excerpts")]
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use std::fmt;
use std::ops::Range;

/// Most problems that one report shows.
const SHOWN: usize = 50;

/// Characters that are shown of a message or an advice, and of a key: they may quote what was written, however long.
const LONGEST: usize = 1500;
const LONGEST_KEY: usize = 200;

/// The text, or its beginning and its end if it is long.
fn shortened(text: String, longest: usize) -> String {
    if text.len() <= longest || text.chars().count() <= longest {
        return text;
    }
    let (head, tail) = (longest * 2 / 3, longest / 3);
    let end = text.char_indices().rev().nth(tail.saturating_sub(1)).map_or(0, |(at, _)| at);
    text.chars().take(head).chain(" … ".chars()).chain(text[end..].chars()).collect()
}

/// A text that a case was read from: its file, or one `--set` argument.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Source {
    /// Path of the file, or the option of the command line.
    pub name: String,
    /// The whole text.
    pub text: String,
}

/// A place in one of the sources of a case.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Index of the source: 0 is the file.
    pub source: usize,
    /// First byte of the place.
    pub start: usize,
    /// Byte after the last.
    pub end: usize,
}

impl Place {
    /// The bytes `span` of source `source`.
    pub fn new(source: usize, span: Range<usize>) -> Place {
        Place { source, start: span.start, end: span.end }
    }
}

/// The bytes at which the lines of a source begin.
fn line_starts(source: &Source) -> Vec<usize> {
    let ends = source.text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
    std::iter::once(0).chain(ends.map(|(at, _)| at + 1)).collect()
}

/// Line and column (in characters) of a place, both from 1.
fn position(source: &Source, starts: &[usize], place: &Place) -> Option<(usize, usize)> {
    let (at, _) = clamp(&source.text, place);
    let line = starts.partition_point(|start| *start <= at);
    let before = source.text.get(*starts.get(line.checked_sub(1)?)?..at)?;
    Some((line, before.chars().count() + 1))
}

/// One thing that is wrong with a case.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Problem {
    /// What is wrong, in one sentence.
    pub message: String,
    /// Dotted path of the key, empty when it belongs to no key.
    pub key: String,
    /// Where it was written; `None` when it concerns the file as a whole.
    pub place: Option<Place>,
    /// A word or two at the place.
    pub label: String,
    /// What to do about it: one line each.
    pub help: Vec<String>,
}

impl Problem {
    /// A problem with `key` at `place`.
    pub fn new(key: impl Into<String>, place: Option<Place>, message: impl Into<String>) -> Problem {
        let (message, key) = (shortened(message.into(), LONGEST), shortened(key.into(), LONGEST_KEY));
        Problem { message, key, place, ..Problem::default() }
    }

    /// Its key and what is wrong.
    fn title(&self) -> String {
        if self.key.is_empty() { self.message.clone() } else { format!("{}: {}", self.key, self.message) }
    }

    /// Adds a few words that stand under the caret.
    pub fn label(mut self, label: impl Into<String>) -> Problem {
        self.label = label.into();
        self
    }

    /// Adds a line of advice.
    pub fn help(mut self, help: impl Into<String>) -> Problem {
        self.help.push(shortened(help.into(), LONGEST));
        self
    }
}

/// Everything that is wrong with a case, in the order of the file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Problems {
    /// The texts to which the places refer: the file first, then the command line.
    pub sources: Vec<Source>,
    /// The problems, at least one.
    pub list: Vec<Problem>,
    /// Whether they are of how it is written: no TOML, a key or kind that is none, a wrong type or unit. Else what it says is refused.
    pub misread: bool,
}

impl Problems {
    /// Adds a problem.
    pub fn push(&mut self, problem: Problem) {
        self.list.push(problem);
    }

    /// What the first of them says.
    pub fn reason(&self) -> String {
        self.list.first().map_or_else(String::new, |problem| problem.message.clone())
    }

    /// What the [keys](crate::Reading::missing_for_run) that a run alone needs, and that are missing, mean for a case of modes.
    pub fn without_run(&self) -> String {
        let keys: Vec<String> = self.list.iter().map(|problem| format!("`{}`", problem.key)).collect();
        format!("not without {}, which modes do not need", keys.join(" and "))
    }

    /// Puts the problems into the order of their places; those without a place come last.
    pub(super) fn sort(&mut self) {
        self.list.sort_by_key(|p| (p.place.is_none(), p.place.clone()));
    }

    /// Line and column (in characters) of a problem, both from 1.
    pub fn line_and_column(&self, problem: &Problem) -> Option<(usize, usize)> {
        let place = problem.place.as_ref()?;
        let source = self.sources.get(place.source)?;
        position(source, &line_starts(source), place)
    }

    /// The same of all problems, in their order.
    pub fn lines_and_columns(&self) -> Vec<Option<(usize, usize)>> {
        let starts: Vec<Vec<usize>> = self.sources.iter().map(line_starts).collect();
        let of = |problem: &Problem| {
            let place = problem.place.as_ref()?;
            position(self.sources.get(place.source)?, starts.get(place.source)?, place)
        };
        self.list.iter().map(of).collect()
    }

    /// The report, with terminal colours if `colour`; without the feature `excerpts` it has neither colours nor the lines of the case.
    pub fn render(&self, colour: bool) -> String {
        let mut out = String::new();
        for problem in self.list.iter().take(SHOWN) {
            out.push_str(&self.render_one(colour, problem));
            out.push_str("\n\n");
        }
        let name = self.sources.first().map_or("the case", |s| s.name.as_str());
        let count = self.list.len();
        if count > SHOWN {
            out.push_str(&format!("… and {} more\n\n", count - SHOWN));
        }
        out.push_str(&format!("{name}: {count} problem{}\n", if count == 1 { "" } else { "s" }));
        out
    }

    #[cfg(not(feature = "excerpts"))]
    fn render_one(&self, _: bool, problem: &Problem) -> String {
        let help = problem.help.iter().map(|help| format!("\nhelp: {help}"));
        std::iter::once(format!("error: {}", problem.title())).chain(help).collect()
    }

    #[cfg(feature = "excerpts")]
    fn render_one(&self, colour: bool, problem: &Problem) -> String {
        let renderer = if colour { Renderer::styled() } else { Renderer::plain() };
        let mut group = Group::with_title(Level::ERROR.primary_title(problem.title()));
        let window = problem.place.as_ref().and_then(|place| {
            let source = self.sources.get(place.source)?;
            window(&source.text, place).map(|window| (source, window))
        });
        if let Some((source, window)) = &window {
            let mut annotation = AnnotationKind::Primary.span(window.span.clone());
            if !problem.label.is_empty() {
                annotation = annotation.label(problem.label.as_str());
            }
            group = group.element(
                Snippet::source(window.text)
                    .path(source.name.as_str())
                    .line_start(window.line)
                    .annotation(annotation),
            );
        }
        for help in &problem.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        renderer.render(&[group])
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.render(false).trim_end())
    }
}

impl std::error::Error for Problems {}

/// The place of `span` of a text inside the place of its TOML value, where the two correspond.
pub(super) fn inside(place: &Place, text: &str, span: Range<usize>, problems: &Problems) -> Place {
    let written = problems.sources.get(place.source).and_then(|s| s.text.get(place.start..place.end));
    let offset = match written {
        Some(written) if written == text => 0,
        Some(written) if written.get(1..written.len().saturating_sub(1)) == Some(text) => 1,
        _ => return place.clone(),
    };
    let start = place.start + offset;
    Place::new(place.source, start + span.start..start + span.end)
}

/// The line of a place, with the place as a span of it.
#[cfg(feature = "excerpts")]
struct Window<'t> {
    text: &'t str,
    line: usize,
    span: Range<usize>,
}

/// The first line of the place, cut to at most some hundred bytes around it.
#[cfg(feature = "excerpts")]
fn window<'t>(text: &'t str, place: &Place) -> Option<Window<'t>> {
    const MARGIN: usize = 200;
    let (start, end) = clamp(text, place);
    let line_start = text.get(..start)?.rfind('\n').map_or(0, |at| at + 1);
    let line_end = text.get(start..)?.find('\n').map_or(text.len(), |at| start + at);
    let from = boundary(text, line_start.max(start.saturating_sub(MARGIN)));
    let to = boundary(text, line_end.min(start + 2 * MARGIN)).max(start);
    let line = text.get(..line_start)?.matches('\n').count() + 1;
    Some(Window { text: text.get(from..to)?, line, span: start - from..end.clamp(start, to) - from })
}

/// The span of a place, inside the text and on character boundaries.
fn clamp(text: &str, place: &Place) -> (usize, usize) {
    let start = boundary(text, place.start.min(text.len()));
    (start, boundary(text, place.end.clamp(start, text.len())).max(start))
}

/// The last character boundary at or before `at`.
fn boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0)
}
