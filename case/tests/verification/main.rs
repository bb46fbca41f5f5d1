//! Every folder of `verification` is run and held to what its `expected.toml` says.

#![allow(clippy::unwrap_used, clippy::panic)]

mod folder;
mod run;

use flexion_case::{Reading, choices};
use folder::Expected;
use std::fmt::Write;

fn folders() -> Vec<String> {
    let mut folders: Vec<String> = std::fs::read_dir(run::root())
        .unwrap()
        .filter_map(|entry| entry.ok().filter(|entry| entry.path().is_dir()))
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect();
    folders.sort();
    assert!(folders.len() > 30, "{} folders", folders.len());
    folders
}

/// Set the variable `VERIFICATION` to a part of a folder's name to run some of them, and run with
/// `--nocapture` to see what was measured.
#[test]
fn every_case_agrees_with_its_reference() {
    let only = std::env::var("VERIFICATION").unwrap_or_default();
    let (mut report, mut wrong) = (String::new(), 0);
    for folder in folders().iter().filter(|folder| folder.contains(&only)) {
        let start = std::time::Instant::now();
        let run = run::run(folder, &[]);
        let steps = run.steps;
        let _ = writeln!(report, "{folder}: {steps} steps, {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
        for c in Expected::read(folder).compare(&run, |other| run::run(other, &[])) {
            let good = c.off <= c.tolerance;
            wrong += u32::from(!good);
            let verdict = if good { "  " } else { "✗ " };
            let (what, off, tolerance, note) = (c.what, c.off, c.tolerance, c.note);
            let _ = writeln!(report, "{verdict}{what}: off by {off:.2e} of {tolerance:.0e} ({note})");
        }
    }
    eprintln!("{report}");
    assert_eq!(wrong, 0, "{wrong} comparisons failed:\n{report}");
}

#[test]
fn every_folder_explains_its_case() {
    for folder in folders() {
        let readme = std::fs::read_to_string(run::root().join(&folder).join("README.md")).unwrap();
        let lines = readme.lines().count();
        assert!(readme.starts_with("# "), "{folder}: README.md has no title");
        assert!((3..=30).contains(&lines), "{folder}: README.md has {lines} lines");
        let reading = run::case(&folder, &[]).unwrap();
        assert!(!reading.case.title.is_empty(), "{folder}: the case has no title");
    }
}

/// Texts at a dotted path of a resolved case, in all tables of a list.
fn at<'t>(value: &'t toml::Value, path: &str) -> Vec<&'t str> {
    match value {
        toml::Value::Array(items) => items.iter().flat_map(|item| at(item, path)).collect(),
        toml::Value::String(text) if path.is_empty() => vec![text],
        _ => {
            let (first, rest) = path.split_once('.').unwrap_or((path, ""));
            value.get(first).map_or(Vec::new(), |value| at(value, rest))
        }
    }
}

/// Whether a case uses a kind of the choice at `path`.
fn uses(reading: &Reading, path: &str, kind: &str) -> bool {
    let resolved = toml::Value::Table(reading.resolved().parse().unwrap());
    let chosen = |path: &str| {
        at(&resolved, path).contains(&kind) || at(&resolved, &format!("{path}.kind")).contains(&kind)
    };
    // Both fields of a mixed basis are chosen from the same kinds, and so are loads of all sorts.
    let others: &[&str] = match path {
        "basis.axial" => &["basis.transverse"],
        "force.frame" => &["distributed-load.frame"],
        "force.amplitude" => &["couple.amplitude", "distributed-load.amplitude"],
        _ => &[],
    };
    chosen(path) || others.iter().any(|path| chosen(path))
}

#[test]
fn every_kind_that_a_case_may_choose_is_verified() {
    let readings: Vec<Reading> = folders().iter().map(|folder| run::case(folder, &[]).unwrap()).collect();
    for choice in choices() {
        for kind in choice.kinds() {
            let used = readings.iter().any(|reading| uses(reading, choice.path(), kind.name));
            assert!(used, "no folder of verification uses the {} `{}`", choice.name(), kind.name);
        }
    }
}
