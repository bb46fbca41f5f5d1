//! Reading a paper: from the program, or from a folder.

use crate::described::{Described, Item, ItemKind, Lines, Paper};
use flexion_results::nearest;
use include_dir::{Dir, include_dir};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The papers that are built into the program.
static PAPERS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../papers");

/// Why a paper cannot be read: all that is wrong with its files.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", .0.join("\n"))]
pub struct PaperError(pub Vec<String>);

/// The files of a paper: their names within its folder, and their texts.
type Files = BTreeMap<String, String>;

/// The names of the papers that are built into the program.
pub fn built_in_names() -> Vec<String> {
    PAPERS.dirs().map(|dir| dir.path().display().to_string()).collect()
}

/// A paper that is built into the program.
///
/// # Errors
/// A name that is none, and whatever is wrong with its files.
pub fn built_in(name: &str) -> Result<Described, PaperError> {
    let dir = PAPERS.get_dir(name).ok_or_else(|| {
        PaperError(vec![format!("there is no paper `{name}`; there are {}", built_in_names().join(", "))])
    })?;
    let mut files = Files::new();
    let mut open = vec![dir];
    while let Some(dir) = open.pop() {
        open.extend(dir.dirs());
        for file in dir.files() {
            let path = file.path().strip_prefix(name).unwrap_or(file.path());
            if let Some(text) = file.contents_utf8() {
                files.insert(path.to_string_lossy().replace('\\', "/"), text.to_owned());
            }
        }
    }
    described(name, &format!("papers/{name}"), &files)
}

/// A paper in a folder.
///
/// # Errors
/// Whatever is wrong with its files.
pub fn from_folder(folder: &Path) -> Result<Described, PaperError> {
    let mut files = Files::new();
    let mut problems = Vec::new();
    for (within, prefix) in [(folder.to_owned(), ""), (folder.join("cases"), "cases/")] {
        let entries = match std::fs::read_dir(&within) {
            Ok(entries) => entries,
            // A paper of drawings has no cases.
            Err(error) if !prefix.is_empty() && error.kind() == std::io::ErrorKind::NotFound => continue,
            Err(error) => {
                problems.push(format!("cannot read {}: {error}", within.display()));
                continue;
            }
        };
        for path in entries.flatten().map(|entry| entry.path()) {
            let wanted = path.extension().is_some_and(|end| end == "toml" || end == "svg");
            if wanted && path.is_symlink() {
                problems.push(format!("{} is a link: a paper holds its own files", path.display()));
                continue;
            }
            let Some(name) = path.file_name().filter(|_| wanted && path.is_file()) else { continue };
            match std::fs::read_to_string(&path) {
                Ok(text) => drop(files.insert(format!("{prefix}{}", name.to_string_lossy()), text)),
                Err(error) => problems.push(format!("cannot read {}: {error}", path.display())),
            }
        }
    }
    if !problems.is_empty() {
        return Err(PaperError(problems));
    }
    let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    let name = absolute.file_name().map_or("paper".to_owned(), |name| name.to_string_lossy().into_owned());
    described(&name, &folder.display().to_string(), &files)
}

/// The paper of these files; `place` names its folder in messages.
fn described(name: &str, place: &str, files: &Files) -> Result<Described, PaperError> {
    let mut problems = Vec::new();
    let Some(paper) = parsed::<Paper>(place, "paper.toml", files, &mut problems) else {
        return Err(PaperError(problems));
    };
    let mut items = Vec::new();
    for (i, item) in paper.items.iter().enumerate() {
        if paper.items[..i].contains(item) {
            problems.push(format!("{place}/paper.toml: `items` has {item} twice"));
            continue;
        }
        if !is_numbered(item) {
            problems.push(format!(
                "{place}/paper.toml: `{item}` of `items` is no F or T with a number, as F4 or T1"
            ));
            continue;
        }
        let file = format!("{item}.toml");
        let Some(mut read) = parsed::<Item>(place, &file, files, &mut problems) else { continue };
        read.lines = files.get(&file).map(|text| lines(text)).unwrap_or_default();
        if read.kind == ItemKind::Drawing {
            read.drawing.get_or_insert_with(|| format!("{item}.svg"));
        }
        let cases = read.runs.iter().map(|run| ("case", format!("cases/{}.toml", run.case)));
        let drawing = read.drawing.iter().map(|file| ("drawing", file.clone()));
        let named: BTreeSet<(&str, String)> = cases.chain(drawing).collect();
        for (what, name) in named.into_iter().filter(|(_, name)| !files.contains_key(name)) {
            let there = files.keys().map(String::as_str);
            let nearest =
                nearest(&name, there).map_or(String::new(), |name| format!("; perhaps {place}/{name}"));
            problems.push(format!("{place}/{file}: its {what} {place}/{name} does not exist{nearest}"));
        }
        if let Some((name, text)) = read.drawing.as_ref().and_then(|name| files.get_key_value(name))
            && !(text.trim_start().starts_with('<')
                && text.contains("<svg")
                && text.trim_end().ends_with("</svg>"))
        {
            problems.push(format!("{place}/{name} is no drawing in SVG"));
        }
        problems.extend(
            crate::need::problems(&read).into_iter().map(|problem| format!("{place}/{file}: {problem}")),
        );
        items.push((item.clone(), read));
    }
    let listed = |name: &str| paper.items.iter().any(|item| item == name);
    for file in files.keys().filter(|file| !file.contains('/')) {
        let Some(stem) = file.strip_suffix(".toml") else { continue };
        if !["paper", "expected"].contains(&stem) && !listed(stem) {
            problems.push(format!("{place}/{file} is no item of {place}/paper.toml: name it in `items`"));
        }
    }
    if !problems.is_empty() {
        return Err(PaperError(problems));
    }
    let of = |prefix: &str, end: &str| {
        let names = files.iter().filter_map(|(file, text)| {
            let name = file.strip_prefix(prefix)?.strip_suffix(end)?;
            (!name.contains('/')).then(|| (name.to_owned(), text.clone()))
        });
        names.collect::<BTreeMap<String, String>>()
    };
    Ok(Described {
        name: name.to_owned(),
        place: place.to_owned(),
        items,
        cases: of("cases/", ".toml"),
        drawings: of("", ".svg").into_iter().map(|(name, text)| (format!("{name}.svg"), text)).collect(),
        expected: files.get("expected.toml").cloned(),
        paper,
    })
}

/// Whether this is the name of an item: a figure or a table with its number.
fn is_numbered(item: &str) -> bool {
    let number = item.strip_prefix(['F', 'T']).unwrap_or_default();
    let (first, rest) = number.split_at_checked(1).unwrap_or_default();
    first.chars().all(|c| ('1'..='9').contains(&c))
        && !first.is_empty()
        && rest.chars().all(|c| c.is_ascii_alphanumeric())
}

fn parsed<T: serde::de::DeserializeOwned>(
    place: &str,
    file: &str,
    files: &Files,
    problems: &mut Vec<String>,
) -> Option<T> {
    let Some(text) = files.get(file) else {
        problems.push(format!("{place}/{file} does not exist"));
        return None;
    };
    match toml::from_str(text) {
        Ok(read) => Some(read),
        Err(error) => {
            let perhaps = meant(error.message()).map_or(String::new(), |name| format!("; perhaps `{name}`"));
            problems.push(format!("{place}/{file}: {}{perhaps}", error.to_string().trim_end()));
            None
        }
    }
}

/// The name that is nearest to an unknown one, among those that a message offers: "unknown field `a`, expected one of `b`, `c`".
fn meant(message: &str) -> Option<&str> {
    let (_, rest) = message.split_once("unknown ")?;
    let mut quoted = rest.split('`').skip(1).step_by(2);
    let unknown = quoted.next()?;
    nearest(unknown, quoted)
}

/// Where things stand in the file of an item.
fn lines(text: &str) -> Lines {
    use toml::Spanned;
    #[derive(serde::Deserialize, Default)]
    struct Places {
        #[serde(default, rename = "run")]
        runs: Vec<OfRun>,
        #[serde(default, rename = "claim")]
        claims: Vec<OfClaim>,
        #[serde(default, rename = "plot")]
        plots: Vec<OfPlot>,
        table: Option<Spanned<OfTable>>,
    }
    #[derive(serde::Deserialize)]
    struct OfRun {
        name: Spanned<String>,
        #[serde(default)]
        set: Vec<Spanned<String>>,
        #[serde(default)]
        against: Vec<Spanned<String>>,
    }
    #[derive(serde::Deserialize)]
    struct OfClaim {
        rule: Spanned<toml::Table>,
    }
    #[derive(serde::Deserialize)]
    struct OfPlot {
        y: Spanned<String>,
    }
    #[derive(serde::Deserialize)]
    struct OfTable {
        columns: Vec<Spanned<toml::Table>>,
    }
    let of = |at: usize| text.get(..at).map_or(1, |before| before.matches('\n').count() + 1);
    let all = |list: &[Spanned<String>]| list.iter().map(|text| of(text.span().start)).collect::<Vec<_>>();
    let places: Places = toml::from_str(text).unwrap_or_default();
    let runs = places.runs.iter();
    let columns = places.table.iter().flat_map(|table| &table.get_ref().columns);
    Lines {
        runs: runs.map(|run| (of(run.name.span().start), all(&run.set), all(&run.against))).collect(),
        claims: places.claims.iter().map(|claim| of(claim.rule.span().start)).collect(),
        plots: places.plots.iter().map(|plot| of(plot.y.span().start)).collect(),
        table: places.table.as_ref().map(|table| of(table.span().start)),
        columns: columns.map(|column| of(column.span().start)).collect(),
        text: text.to_owned(),
    }
}
