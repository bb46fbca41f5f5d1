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
