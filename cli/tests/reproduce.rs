//! `flexion reproduce`: what it refuses before it computes.

#![allow(clippy::unwrap_used)] // in helpers of tests

mod program;

use program::{SPIN_UP, flexion, text};
use std::path::Path;

/// A folder with a paper of one run.
fn paper(folder: &Path) {
    let put = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    std::fs::create_dir_all(folder.join("mine/cases")).unwrap();
    put("mine/paper.toml", "title = 'T'\nauthors = 'A'\nsource = 'S'\nabout = 'B'\nitems = ['T1']\n");
    put("mine/cases/spin_up.toml", &format!("{SPIN_UP}[run]\nduration = '0.1 s'\n"));
    put(
        "mine/T1.toml",
        "title = 'T'\nkind = 'table'\n[[run]]\nname = 'one'\ncase = 'spin_up'\nagainst = []\n[table]\ncolumns = [{ title = 'd', quantity = 'tip.deflection.min' }]\n",
    );
}

#[test]
fn a_word_beside_all_is_judged_too() {
    let folder = tempfile::tempdir().unwrap();
    for words in [["all", "P9"], ["P9", "all"], ["all", "P1/F99"]] {
        let output = flexion(folder.path(), &["reproduce", words[0], words[1]]);
        assert_eq!(output.status.code(), Some(1));
        assert!(text(&output.stderr).contains("error: "), "{}", text(&output.stderr));
    }
}

#[test]
fn what_was_accepted_is_not_thrown_away() {
    let folder = tempfile::tempdir().unwrap();
    paper(folder.path());
    let call = |option: &str| flexion(folder.path(), &["reproduce", "mine", option]);
    let missing = call("--check");
    assert_eq!(missing.status.code(), Some(1));
    assert!(text(&missing.stderr).contains("--accept"), "{}", text(&missing.stderr));
    for option in ["--accept", "--check"] {
        let output = call(option);
        assert_eq!(output.status.code(), Some(0), "{option}: {}", text(&output.stderr));
    }
    let file = folder.path().join("mine/expected.toml");
    std::fs::write(&file, "[values").unwrap();
    for option in ["--accept", "--check"] {
        let output = call(option);
        assert_eq!(output.status.code(), Some(1));
        assert!(text(&output.stderr).contains("mend it"), "{}", text(&output.stderr));
    }
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "[values");
}

/// Where a report cannot be written, or would replace what is not its own, nothing is computed.
#[test]
fn a_folder_is_judged_before_anything_is_computed() {
    let folder = tempfile::tempdir().unwrap();
    paper(folder.path());
    let there = |name: &str| folder.path().join(name);
    let call =
        |more: &[&str]| flexion(folder.path(), &[&["reproduce", "mine", "--output", "out"], more].concat());
    let refused = |more: &[&str], said: &str| {
        let output = call(more);
        let error = text(&output.stderr);
        assert!(output.status.code() == Some(1) && error.contains(said), "{error}");
        assert!(!there("out/kept").exists(), "{error}");
    };
    std::fs::write(there("out"), "a file").unwrap();
    refused(&[], "is a file");
    std::fs::remove_file(there("out")).unwrap();
    std::fs::create_dir(there("out")).unwrap();
    std::fs::write(there("out/report.html"), "of a former version").unwrap();
    refused(&["--force"], "a version before kept none");
    std::fs::remove_file(there("out/report.html")).unwrap();
    std::fs::write(there("out/notes.txt"), "mine").unwrap();
    refused(&[], "notes.txt");
    let lock = std::fs::File::open(there("out")).unwrap();
    lock.lock().unwrap();
    refused(&["--force"], "another run is writing");
    drop(lock);
    std::fs::create_dir(there("mine/expected.toml")).unwrap();
    refused(&["--force", "--accept"], "expected.toml");
    std::fs::remove_dir(there("mine/expected.toml")).unwrap();
    let names = || {
        let all = std::fs::read_dir(there("out")).unwrap().map(|file| file.unwrap().file_name());
        let mut all: Vec<String> = all.map(|name| name.into_string().unwrap()).collect();
        all.sort();
        all
    };
    assert_eq!(call(&["--force"]).status.code(), Some(0));
    assert_eq!(
        names(),
        [".flexion-files", "claims.csv", "kept", "mine_T1_table.csv", "notes.txt", "report.html"]
    );
    // A former report goes as a whole.
    std::fs::remove_file(there("out/notes.txt")).unwrap();
    std::fs::rename(there("mine"), there("other")).unwrap();
    assert_eq!(flexion(folder.path(), &["reproduce", "other", "--output", "out"]).status.code(), Some(0));
    assert_eq!(names(), [".flexion-files", "claims.csv", "kept", "other_T1_table.csv", "report.html"]);
}
