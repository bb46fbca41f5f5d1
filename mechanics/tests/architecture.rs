//! The layer table of `ARCHITECTURE.md` against the sources: who imports whom, names and sizes of files, and that the files which the guides name are there.
//!
//! Test modules inside `src` are held to the same table. Paths in comments and in doc links are not
//! imports and are not checked.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Longest source file, in lines.
const LONGEST: usize = 600;

/// Names that say nothing about what is inside.
const VAGUE: [&str; 10] =
    ["core", "util", "utils", "common", "types", "misc", "helper", "helpers", "base", "stuff"];

/// Models that must not know each other.
const SIBLINGS: [(&str, &str); 1] = [("hub_beam", "multibody")];

/// Module → modules it may import.
type Layers = BTreeMap<String, BTreeSet<String>>;

/// A module that imports another one: file, line, name.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Import {
    line: usize,
    module: String,
}

/// The table under the heading `## Layers`: rows ``| `module` | `a`, `b` | … |``, in order.
fn layer_table(text: &str) -> Vec<(String, BTreeSet<String>)> {
    let section = text.split("\n## Layers\n").nth(1).expect("ARCHITECTURE.md has a section `## Layers`");
    let section = section.split("\n## ").next().unwrap();
    let names = |cell: &str| cell.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>();
    section
        .lines()
        .filter(|line| line.starts_with("| `"))
        .map(|line| {
            let cells: Vec<&str> = line.split('|').collect();
            let module = names(cells[1]).into_iter().next().unwrap();
            (module, names(cells[2]).into_iter().collect())
        })
        .collect()
}

/// Source text with comments, strings and characters replaced by blanks; lines stay where they are.
pub fn code_only(text: &str) -> String {
    let bytes: Vec<char> = text.chars().collect();
    let at = |i: usize| bytes.get(i).copied().unwrap_or('\0');
    let mut out = String::with_capacity(text.len());
    let mut i = 0;
    while i < bytes.len() {
        let start = i;
        if at(i) == '/' && at(i + 1) == '/' {
            while i < bytes.len() && at(i) != '\n' {
                i += 1;
            }
        } else if at(i) == '/' && at(i + 1) == '*' {
            i += 2;
            while i < bytes.len() && !(at(i) == '*' && at(i + 1) == '/') {
                i += 1;
            }
            i += 2;
        } else if at(i) == 'r'
            && (at(i + 1) == '"' || at(i + 1) == '#' && matches!(at(i + 2), '"' | '#'))
            && !(i > 0 && (at(i - 1).is_alphanumeric() || at(i - 1) == '_'))
        {
            let hashes = (i + 1..).take_while(|&k| at(k) == '#').count();
            i += 2 + hashes;
            while i < bytes.len() && !(at(i) == '"' && (1..=hashes).all(|k| at(i + k) == '#')) {
                i += 1;
            }
            i += 1 + hashes;
        } else if at(i) == '"' {
            i += 1;
            while i < bytes.len() && at(i) != '"' {
                i += if at(i) == '\\' { 2 } else { 1 };
            }
            i += 1;
        } else if at(i) == '\'' && (at(i + 1) == '\\' || at(i + 2) == '\'') {
            i += if at(i + 1) == '\\' { 3 } else { 2 };
            while i < bytes.len() && at(i) != '\'' {
                i += 1;
            }
            i += 1;
        } else {
            out.push(at(i));
            i += 1;
            continue;
        }
        out.extend(bytes[start..i.min(bytes.len())].iter().map(|c| if *c == '\n' { '\n' } else { ' ' }));
    }
    out
}

/// Words and the marks `::`, `{`, `}`, `,`, `;` of a source text, with their lines.
fn tokens(code: &str) -> Vec<(usize, String)> {
    let mut out: Vec<(usize, String)> = Vec::new();
    let (mut line, mut joined) = (1, false);
    let mut chars = code.chars().peekable();
    while let Some(c) = chars.next() {
        if c.is_alphanumeric() || c == '_' {
            match out.last_mut() {
                Some((_, word)) if joined => word.push(c),
                _ => out.push((line, c.to_string())),
            }
            joined = true;
            continue;
        }
        joined = false;
        if c == ':' && chars.peek() == Some(&':') {
            chars.next();
            out.push((line, "::".into()));
        } else if c == '\n' {
            line += 1;
        } else if !c.is_whitespace() {
            out.push((line, c.to_string()));
        }
    }
    out
}

/// What the file of module path `path` (`["output", "plot"]`) imports from the root of the crate.
fn imports(path: &[&str], text: &str) -> BTreeSet<Import> {
    let code = code_only(text);
    let tokens = tokens(&code);
    let word = |i: usize| tokens.get(i).map_or("", |t| t.1.as_str());
    let mut found = BTreeSet::new();
    // Depth of braces at which each inline module opened.
    let (mut depth, mut inline) = (0_usize, Vec::new());
    let mut i = 0;
    while i < tokens.len() {
        match word(i) {
            "{" => {
                depth += 1;
                if i >= 2 && word(i - 2) == "mod" {
                    inline.push(depth);
                }
            }
            "}" => {
                if inline.last() == Some(&depth) {
                    inline.pop();
                }
                depth = depth.saturating_sub(1);
            }
            first @ ("crate" | "super") if i == 0 || word(i - 1) != "::" && word(i - 1) != "$" => {
                let mut next = i + 1;
                let mut up = usize::from(first == "super");
                while first == "super" && word(next) == "::" && word(next + 1) == "super" {
                    (up, next) = (up + 1, next + 2);
                }
                let at_root = first == "crate" || up == path.len() + inline.len();
                if at_root && word(next) == "::" {
                    for (line, module) in heads(&tokens, next + 1) {
                        found.insert(Import { line, module });
                    }
                }
            }
            _ => {}
        }
        i += 1;
    }
    found
}

/// The first words of a path or of each path of a group `{a::b, c}`.
fn heads(tokens: &[(usize, String)], at: usize) -> Vec<(usize, String)> {
    let Some((line, word)) = tokens.get(at) else { return Vec::new() };
    if word != "{" {
        return vec![(*line, word.clone())];
    }
    let (mut out, mut depth, mut fresh) = (Vec::new(), 1, true);
    for (line, word) in &tokens[at + 1..] {
        match word.as_str() {
            "{" => depth += 1,
            "}" => depth -= 1,
            "," if depth == 1 => fresh = true,
            _ if fresh => {
                out.push((*line, word.clone()));
                fresh = false;
            }
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    out
}

/// Collects the paths of a `use` tree, or the path in code, that begins at token `i`; gives the token behind it.
fn paths(tokens: &[(usize, String)], mut i: usize, prefix: &[String], out: &mut Vec<Vec<String>>) -> usize {
    let word = |i: usize| tokens.get(i).map_or("", |t| t.1.as_str());
    let mut path = prefix.to_vec();
    loop {
        if word(i) == "{" {
            i += 1;
            while !matches!(word(i), "}" | "") {
                i = paths(tokens, i, &path, out);
                i += if word(i) == "as" { 2 } else { 0 };
                i += usize::from(word(i) == ",");
            }
            return i + 1;
        }
        path.push(word(i).to_owned());
        i += 1;
        if word(i) != "::" {
            out.push(path);
            return i;
        }
        i += 1;
    }
}

/// A file: what it imports and what it exports under another path, as paths from the root of the crate.
#[derive(Default)]
struct Uses {
    imports: Vec<Vec<String>>,
    exports: Vec<Vec<String>>,
}

/// The uses of the file of module path `own`, its test module aside.
fn uses(own: &[String], text: &str) -> Uses {
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap();
    let code = code_only(text);
    let tokens = tokens(&code);
    let word = |i: usize| tokens.get(i).map_or("", |t| t.1.as_str());
    let (mut out, mut i) = (Uses::default(), 0);
    while i < tokens.len() {
        let is_use = word(i) == "use";
        let begins = matches!(word(i), "crate" | "super" | "self") && word(i + 1) == "::";
        if !is_use && !begins {
            i += 1;
            continue;
        }
        let is_export = is_use && i > 0 && matches!(word(i - 1), "pub" | ")");
        let mut found = Vec::new();
        i = paths(&tokens, i + usize::from(is_use), &[], &mut found);
        for path in found {
            let up = path.iter().take_while(|w| *w == "super").count();
            let path = match path[0].as_str() {
                "crate" => path[1..].to_vec(),
                "self" => [own, &path[1..]].concat(),
                _ => [&own[..own.len().saturating_sub(up)], &path[up..]].concat(),
            };
            if is_export { &mut out.exports } else { &mut out.imports }.push(path);
        }
    }
    out
}

/// The circles of imports among files, given by module path and text. A name that a `mod.rs` exports again counts
/// as imported from the file that declares it.
fn circles(files: &[(Vec<String>, String)]) -> Vec<BTreeSet<String>> {
    let uses: Vec<Uses> = files.iter().map(|(own, text)| uses(own, text)).collect();
    let mut aliases = BTreeMap::new();
    for ((own, _), uses) in files.iter().zip(&uses) {
        for path in &uses.exports {
            let alias = [own.as_slice(), &path[path.len() - 1..]].concat();
            aliases.insert(alias, path.clone());
        }
    }
    let file_of = |path: &[String]| {
        let mut path = path.to_vec();
        for _ in 0..8 {
            let alias =
                (1..=path.len()).rev().find(|&k| aliases.get(&path[..k]).is_some_and(|a| a[..] != path[..k]));
            let Some(k) = alias else { break };
            path = [&aliases[&path[..k]], &path[k..]].concat();
        }
        (0..=path.len()).rev().find_map(|k| files.iter().position(|(file, _)| *file == path[..k]))
    };
    // Whether a path of imports leads from file i to file j.
    let mut leads = vec![vec![false; files.len()]; files.len()];
    for (i, uses) in uses.iter().enumerate() {
        for j in uses.imports.iter().filter_map(|path| file_of(path)).filter(|j| *j != i) {
            leads[i][j] = true;
        }
    }
    for k in 0..files.len() {
        let onward = leads[k].clone();
        for row in leads.iter_mut().filter(|row| row[k]) {
            row.iter_mut().zip(&onward).for_each(|(to, also)| *to |= also);
        }
    }
    let circle: Vec<Vec<usize>> = (0..files.len())
        .map(|i| (0..files.len()).filter(|&j| leads[i][j] && leads[j][i]).collect())
        .collect();
    let names = |circle: &Vec<usize>| circle.iter().map(|&j| files[j].0.join("/")).collect();
    circle.iter().enumerate().filter(|(i, circle)| circle.first() == Some(i)).map(|(_, c)| names(c)).collect()
}

/// What of the imports of a file the table forbids.
fn violations(layers: &Layers, file: &str, path: &[&str], text: &str) -> Vec<String> {
    let Some(own) = path.first() else { return Vec::new() };
    let empty = BTreeSet::new();
    let allowed = layers.get(*own).unwrap_or(&empty);
    imports(path, text)
        .into_iter()
        .filter(|import| import.module != *own && !allowed.contains(&import.module))
        .map(|import| format!("{file}:{}: `{own}` imports `{}`", import.line, import.module))
        .collect()
}

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

/// All Rust files below a folder, sorted, with their paths relative to it.
pub fn sources(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut out = Vec::new();
    let mut open = vec![folder.to_owned()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).unwrap_or_else(|e| panic!("{}: {e}", next.display())) {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let text = std::fs::read_to_string(&path).unwrap();
                out.push((path.strip_prefix(folder).unwrap().to_owned(), text));
            }
        }
    }
    out.sort();
    out
}

/// Module path of a file below `src`.
fn module_path(file: &Path) -> Vec<&str> {
    let mut path: Vec<&str> =
        file.iter().map(|part| part.to_str().unwrap()).map(|part| part.trim_end_matches(".rs")).collect();
    if matches!(path.last(), Some(&("mod" | "lib" | "main"))) {
        path.pop();
    }
    path
}

fn table() -> Vec<(String, BTreeSet<String>)> {
    layer_table(&std::fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap())
}

#[test]
fn modules_import_only_what_the_layer_table_allows() {
    let layers: Layers = table().into_iter().collect();
    let mechanics = root().join("mechanics/src");
    let wrong: Vec<String> = sources(&mechanics)
        .iter()
        .flat_map(|(file, text)| violations(&layers, &file.display().to_string(), &module_path(file), text))
        .collect();
    assert!(wrong.is_empty(), "not in the layer table of ARCHITECTURE.md:\n{}", wrong.join("\n"));
}

#[test]
fn every_permission_of_the_layer_table_is_used() {
    let mut used = BTreeSet::new();
    for (file, text) in sources(&root().join("mechanics/src")) {
        let path = module_path(&file);
        if let Some(own) = path.first() {
            used.extend(imports(&path, &text).into_iter().map(|import| (own.to_string(), import.module)));
        }
    }
    for (module, allowed) in table() {
        for other in allowed {
            assert!(
                used.contains(&(module.clone(), other.clone())),
                "`{module}` may import `{other}` and does not: take it out of ARCHITECTURE.md"
            );
        }
    }
}

#[test]
fn the_layer_table_names_every_module_and_each_imports_only_those_above_it() {
    let mut declared: Vec<String> = std::fs::read_to_string(root().join("mechanics/src/lib.rs"))
        .unwrap()
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ").or(line.strip_prefix("mod ")))
        .filter_map(|rest| rest.strip_suffix(';').map(str::to_owned))
        .collect();
    let table = table();
    let mut listed: Vec<String> = table.iter().map(|(module, _)| module.clone()).collect();
    let mut above = BTreeSet::new();
    for (module, allowed) in &table {
        let below: Vec<_> = allowed.difference(&above).collect();
        assert!(below.is_empty(), "`{module}` may import {below:?}, which stand below it in the table");
        above.insert(module.clone());
    }
    declared.sort();
    listed.sort();
    assert_eq!(declared, listed, "modules of mechanics/src/lib.rs, and of the layer table");
}

#[test]
fn models_that_are_siblings_do_not_know_each_other() {
    for (module, allowed) in table() {
        for (a, b) in SIBLINGS {
            assert!(!(module == a && allowed.contains(b)), "`{a}` must not import `{b}`");
            assert!(!(module == b && allowed.contains(a)), "`{b}` must not import `{a}`");
        }
    }
}

#[test]
fn files_are_short_and_named_by_a_noun() {
    for folder in ["mechanics/src", "output/src", "case/src", "cli/src"] {
        for (file, text) in sources(&root().join(folder)) {
            let path = module_path(&file);
            let lines = text.lines().count();
            let is_test = path.last() == Some(&"tests");
            assert!(
                is_test || lines <= LONGEST,
                "{folder}/{} has {lines} lines; split it below {LONGEST}",
                file.display()
            );
            let vague = path.iter().find(|name| VAGUE.contains(name));
            assert!(vague.is_none(), "{folder}/{}: `{vague:?}` names nothing", file.display());
        }
    }
}

/// Paths from the root in backquotes, but for patterns such as `verification/NAME/case.toml`.
#[test]
fn files_that_the_guides_name_are_there() {
    let mut named = 0;
    for guide in ["ARCHITECTURE.md", "CONTRIBUTING.md"] {
        let text = std::fs::read_to_string(root().join(guide)).unwrap();
        for path in text.split('`').skip(1).step_by(2) {
            let is_path =
                path.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || "/._-".contains(c));
            let folder = path.split_once('/').map(|(folder, _)| root().join(folder));
            let is_file = Path::new(path).extension().is_some();
            if is_path && is_file && folder.is_some_and(|folder| folder.is_dir()) {
                assert!(root().join(path).exists(), "{guide} names `{path}`, which is not there");
                named += 1;
            }
        }
    }
    assert!(named > 40, "{named} paths");
}

#[test]
fn files_do_not_import_each_other_in_a_circle() {
    let mut wrong = Vec::new();
    for folder in ["mechanics/src", "output/src", "case/src", "cli/src"] {
        let files: Vec<(Vec<String>, String)> = sources(&root().join(folder))
            .into_iter()
            .map(|(file, text)| (module_path(&file).into_iter().map(str::to_owned).collect(), text))
            .filter(|(path, _): &(Vec<String>, String)| !path.iter().any(|part| part == "tests"))
            .collect();
        wrong.extend(circles(&files).into_iter().map(|circle| format!("{folder}: {circle:?}")));
    }
    assert!(wrong.is_empty(), "circles of imports; move what they share below both:\n{}", wrong.join("\n"));
}

mod the_checker {
    use super::*;

    fn modules(path: &[&str], text: &str) -> Vec<String> {
        imports(path, text).into_iter().map(|import| import.module).collect()
    }

    #[test]
    fn it_reports_a_forbidden_import_with_its_line() {
        let layers: Layers = layer_table(
            "\n## Layers\n\n| module | may import | x |\n|---|---|---|\n| `linalg` | – | |\n| `hub_beam` | `linalg` | |\n\n## Next\n| `no` | `no` | |\n",
        )
        .into_iter()
        .collect();
        assert_eq!(layers.len(), 2);
        let bad = "use crate::linalg::Band;\nuse crate::multibody::Node;\n";
        assert_eq!(
            violations(&layers, "hub_beam/bad.rs", &["hub_beam", "bad"], bad),
            ["hub_beam/bad.rs:2: `hub_beam` imports `multibody`"]
        );
        assert_eq!(violations(&layers, "x.rs", &["linalg"], "fn f() { crate::hub_beam::g() }").len(), 1);
        assert!(violations(&layers, "x.rs", &["linalg"], "use crate::linalg::Band;").is_empty());
    }

    #[test]
    fn it_sees_groups_inline_paths_and_chains_of_super() {
        assert_eq!(
            modules(&["a"], "use crate::{b::{X, Y}, c, d::Z};\nfn f() -> crate::e::T { loop {} }"),
            ["b", "c", "d", "e"]
        );
        assert_eq!(modules(&["a", "b"], "use super::super::c::X;"), ["c"]);
        assert!(modules(&["a", "b"], "use super::c::X;").is_empty());
        assert_eq!(modules(&["a"], "use super::c::X;"), ["c"]);
        assert!(modules(&["a"], "mod tests { use super::c::X; }").is_empty());
        assert_eq!(modules(&["a"], "mod tests { fn f() {} } use super::c::X;"), ["c"]);
    }

    #[test]
    fn it_finds_circles_through_exported_names() {
        let file = |path: &str, text: &str| (path.split('/').map(str::to_owned).collect(), text.to_owned());
        let files = [
            file("a", "mod b; mod c; pub use b::{X, Y as Z}; pub trait T {}"),
            file("a/b", "use super::{T, c}; fn f() { c::g() }"),
            file("a/c", "fn g() -> crate::a::X { loop {} }"),
            file("a/d", "use super::{T, X};"),
        ];
        let expected = BTreeSet::from(["a/b".to_owned(), "a/c".to_owned()]);
        assert_eq!(circles(&files), [expected]);
        assert!(circles(&files[..2]).is_empty());
    }

    #[test]
    fn it_does_not_take_text_for_code() {
        let text = "/// [x](crate::b::X)\n// crate::c::X\n/* crate::d::X */ const S: &str = \"crate::e::X \\\" crate::f::X\";\nconst R: &str = r#\"crate::g::X\"#; const C: char = '\"'; use crate::h::X; fn f<'a>(x: &'a str) {}";
        assert_eq!(
            imports(&["a"], text).into_iter().map(|i| (i.line, i.module)).collect::<Vec<_>>(),
            [(4, "h".to_owned())]
        );
    }
}
