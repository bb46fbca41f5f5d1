//! The documentation against the program: commands, links, names and examples.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

/// What the README promises, to be found word for word in `.ci/run`.
const TEST: &str = "cargo test --release --workspace";
const RUN: &str = "cargo run --release -- run --force verification/p1_spin_up_4";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_owned()
}

fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|e| panic!("{path}: {e}"))
}

/// Contents of the fenced blocks of a language.
fn fenced(text: &str, language: &str) -> Vec<String> {
    let mut out = Vec::new();
    let mut block: Option<String> = None;
    let mut other = false;
    for line in text.lines() {
        let fence = line.trim_start().strip_prefix("```");
        match (&mut block, fence) {
            (Some(_), Some(_)) => out.extend(block.take()),
            (Some(block), None) => *block += &format!("{line}\n"),
            (None, Some(_)) if other => other = false,
            (None, Some(name)) if name.trim() == language => block = Some(String::new()),
            (None, Some(_)) => other = true,
            (None, None) => {}
        }
    }
    out
}

/// Text without fenced blocks and code spans; lines stay where they are.
fn prose(text: &str) -> String {
    let mut out = String::new();
    let mut inside = false;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            inside = !inside;
        } else if !inside && !line.starts_with("    ") {
            // Code spans hold no links.
            let spans: Vec<&str> = line.split('`').collect();
            out.extend(spans.iter().step_by(2).copied().flat_map(|part| [part, " "]));
        }
        out.push('\n');
    }
    out
}

/// Targets of the links and pictures `[…](target)`, with their lines.
fn links(text: &str) -> Vec<(usize, String)> {
    let mut out = Vec::new();
    for (number, line) in prose(text).lines().enumerate() {
        for part in line.split("](").skip(1) {
            if let Some(end) = part.find(')') {
                out.push((number + 1, part[..end].to_owned()));
            }
        }
    }
    out
}

/// Anchors of the headings of a page, as GitHub and mdBook form them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut inside = false;
    let mut out = BTreeSet::new();
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            inside = !inside;
        } else if !inside && line.starts_with('#') {
            let title = line.trim_start_matches('#').trim().to_lowercase();
            let kept = title.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
            out.insert(kept.map(|c| if c == ' ' { '-' } else { c }).collect());
        }
    }
    out
}

/// Markdown pages of the repository, relative to its root, sorted.
fn pages() -> Vec<PathBuf> {
    let mut out = Vec::new();
    let mut open = vec![root()];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if path.is_dir() {
                let foreign =
                    name.starts_with('.') || matches!(&*name, "target" | "results" | "node_modules");
                if !foreign {
                    open.push(path);
                }
            } else if name.ends_with(".md") {
                out.push(path.strip_prefix(root()).unwrap().to_owned());
            }
        }
    }
    out.sort();
    assert!(out.len() >= 10, "{out:?}");
    out
}

/// `folder/../x` as `x`.
fn tidy(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if out.pop() => {}
            Component::CurDir => {}
            part => out.push(part),
        }
    }
    out
}

/// What is wrong with the links of a page at `page`; `exists` and `text` look at the repository.
fn broken_links(
    page: &Path,
    content: &str,
    exists: impl Fn(&Path) -> bool,
    text: impl Fn(&Path) -> String,
) -> Vec<String> {
    let mut out = Vec::new();
    for (line, target) in links(content) {
        if target.contains("://") || target.starts_with("mailto:") {
            continue;
        }
        let (file, anchor) = target.split_once('#').map_or((&*target, None), |(f, a)| (f, Some(a)));
        let path = match file {
            "" => page.to_owned(),
            file => tidy(&page.parent().unwrap().join(file)),
        };
        if !exists(&path) {
            out.push(format!("{}:{line}: there is no {}", page.display(), path.display()));
        } else if let Some(anchor) = anchor
            && !anchors(&text(&path)).contains(anchor)
        {
            out.push(format!("{}:{line}: {} has no heading #{anchor}", page.display(), path.display()));
        }
    }
    out
}

#[test]
fn the_two_commands_of_the_readme_are_those_that_are_checked() {
    let commands: Vec<String> =
        fenced(&read("README.md"), "sh").iter().map(|block| block.trim().to_owned()).collect();
    assert_eq!(commands, [RUN, TEST]);
    let script = read(".ci/run");
    let calls = |command: &str| {
        script
            .lines()
            .map(str::trim)
            .any(|line| line == command || line.strip_prefix(command).is_some_and(|l| l.starts_with(' ')))
    };
    assert!(calls(TEST), ".ci/run does not call `{TEST}`");
    assert!(calls(RUN), ".ci/run does not call `{RUN}`");
    assert!(!calls(&TEST[..TEST.len() - 1]), "half a word is no command");
}

#[test]
fn the_case_of_the_first_run_and_the_program_exist() {
    let case = RUN.rsplit(' ').next().unwrap();
    assert!(flexion_case::read(&root().join(case), &[]).is_ok());
    // `cargo run` without a package takes the only program of the workspace.
    assert!(read("cli/Cargo.toml").contains("[[bin]]\nname = \"flexion\""));
    assert!(!root().join("mechanics/src/main.rs").exists() && !root().join("mechanics/src/bin").exists());
}

#[test]
fn the_case_in_the_readme_is_valid_and_is_that_of_the_first_run() {
    let blocks = fenced(&read("README.md"), "toml");
    assert_eq!(blocks.len(), 1);
    let untitled = ["title=".to_owned()];
    let shown = flexion_case::parse(blocks[0].clone(), Path::new("case.toml"), &untitled).unwrap();
    let run = flexion_case::read(&root().join(RUN.rsplit(' ').next().unwrap()), &untitled).unwrap();
    assert_eq!(shown.resolved(), run.resolved());
}

#[test]
fn every_relative_link_leads_somewhere() {
    let broken: Vec<String> = pages()
        .iter()
        .flat_map(|page| {
            broken_links(
                page,
                &read(page.to_str().unwrap()),
                |path| root().join(path).exists(),
                |path| read(path.to_str().unwrap()),
            )
        })
        .collect();
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}

#[test]
fn the_check_of_links_sees_broken_ones() {
    let text = "# A b\n[x](there.md) [y](gone.md)\n`[z](code.md)` [w](#a-b) [v](#c)\n```\n[u](block.md)\n```\n[t](https://example.org)";
    let found = broken_links(
        Path::new("docs/page.md"),
        text,
        |path| path != Path::new("docs/gone.md"),
        |_| text.to_owned(),
    );
    assert_eq!(
        found,
        ["docs/page.md:2: there is no docs/gone.md", "docs/page.md:3: docs/page.md has no heading #c"]
    );
}

#[test]
fn every_kind_is_described_in_the_reference_and_named_in_the_readme() {
    let reference = read("docs/src/guide/reference.md") + &read("docs/src/spatial.md");
    let readme = read("README.md");
    for choice in flexion_case::choices() {
        for kind in choice.kinds() {
            let name = format!("`{}`", kind.name);
            assert!(reference.contains(&name), "reference.md does not describe the {} {name}", choice.name());
            // The parts of systems in space are named there by their tables.
            let of_part = ["body.", "beam.", "joint."].iter().any(|table| choice.path().starts_with(table));
            assert!(
                of_part || readme.contains(&name),
                "README.md does not name the {} {name}",
                choice.name()
            );
        }
    }
}

#[test]
fn every_page_of_the_book_is_in_its_summary() {
    let summary = read("docs/src/SUMMARY.md");
    let listed: BTreeSet<PathBuf> =
        links(&summary).into_iter().map(|(_, target)| Path::new("docs/src").join(target)).collect();
    let pages: BTreeSet<PathBuf> = pages()
        .into_iter()
        .filter(|page| page.starts_with("docs/src") && !page.ends_with("SUMMARY.md"))
        .collect();
    assert_eq!(listed, pages);
}

#[test]
fn no_text_names_a_path_of_one_machine() {
    let mut texts = pages();
    texts.extend([".ci/run", "justfile"].map(PathBuf::from));
    for page in texts {
        let text = read(page.to_str().unwrap());
        for path in ["/tmp/", "/root/", "/home/", "C:\\"] {
            assert!(!text.contains(path), "{} mentions {path}", page.display());
        }
    }
}
