//! Every case of `verification` and every variant of one is a test of its own: it is run and held to what the
//! `expected.toml` of its folder says. `cargo test --release --test verification p1_spin_up_4` runs those whose name
//! contains the word; `-- --nocapture` shows what was measured.
//!
//! With `FLEXION_FINGERPRINTS=FILE` the hash of each trajectory is written to `FILE`: a change that is to leave all numbers as they
//! are is held to the same file before and after it.

#![allow(clippy::unwrap_used, clippy::panic)]

mod expected;
mod run;

use expected::Expected;
use flexion_case::{Reading, choices};
use libtest_mimic::{Arguments, Failed, Trial};
use run::Variant;
use std::collections::BTreeMap;
use std::fmt::Write;
use std::sync::Mutex;

/// The hash of each trajectory by the name of its variant.
static FINGERPRINTS: Mutex<BTreeMap<String, u64>> = Mutex::new(BTreeMap::new());

fn main() {
    let arguments = Arguments::from_args();
    let show = arguments.nocapture;
    let mut tests: Vec<Trial> = run::all()
        .into_iter()
        .map(|variant| Trial::test(variant.name.clone(), move || agrees(&variant, show)))
        .collect();
    for (name, test) in [
        ("every_folder_explains_its_case", every_folder_explains_its_case as fn()),
        ("every_kind_that_a_case_may_choose_is_verified", every_kind_that_a_case_may_choose_is_verified),
    ] {
        tests.push(Trial::test(name, move || {
            test();
            Ok(())
        }));
    }
    let conclusion = libtest_mimic::run(&arguments, tests);
    if let Some(file) = std::env::var_os("FLEXION_FINGERPRINTS") {
        let all = FINGERPRINTS.lock().unwrap();
        let lines: String = all.iter().map(|(name, hash)| format!("{hash:016x} {name}\n")).collect();
        std::fs::write(file, lines).unwrap();
    }
    conclusion.exit();
}

fn agrees(variant: &Variant, show: bool) -> Result<(), Failed> {
    let start = std::time::Instant::now();
    let run = run::run(&variant.name, &[]);
    let time = start.elapsed().as_secs_f64();
    FINGERPRINTS.lock().unwrap().insert(variant.name.clone(), run.fingerprint());
    let mut report = format!("{}: {} steps, {time:.2} s\n", variant.name, run.steps);
    // No run that agrees with its reference is called wrong.
    if let Some(alarm) = run.warnings.iter().find(|warning| warning.contains("not to be trusted")) {
        return Err(format!("{}: {alarm}", variant.name).into());
    }
    let mut measured = expected::measured(&variant.name);
    let mut good = true;
    for c in Expected::new(variant).compare(&run) {
        let before = measured.remove(&c.what).map(|off| off.as_float().unwrap());
        let unmeasured = c.is_loose() && before.is_none();
        let (what, off, tolerance, note) = (&c.what, c.off, c.tolerance, &c.note);
        let verdict = if c.good(before) && !unmeasured { "  " } else { "✗ " };
        good &= verdict == "  ";
        let before = before.map_or(String::new(), |off| format!(", measured {off:.1e}"));
        let _ = writeln!(report, "{verdict}{what}: off by {off:.2e} of {tolerance:.0e}{before} ({note})");
    }
    // Written anew by the example `verification_report`.
    good &= measured.is_empty();
    if !measured.is_empty() {
        let _ = writeln!(report, "measured.toml holds what is not compared: {measured}");
    }
    if show {
        eprint!("{report}");
    }
    if good { Ok(()) } else { Err(report.into()) }
}

fn every_folder_explains_its_case() {
    let all = run::all();
    assert!(all.len() > 90, "{} variants", all.len());
    for variant in &all {
        let Variant { name, folder, .. } = variant;
        let readme = std::fs::read_to_string(run::root().join(folder).join("README.md")).unwrap();
        assert!(
            readme.starts_with("# ") && readme.lines().count() >= 3,
            "{folder}: README.md says too little"
        );
        let reading = run::case(name, &[]).unwrap();
        assert!(!reading.case.title.is_empty(), "{folder}: the case has no title");
        // It names each variant.
        if let Some((_, short)) = name.split_once('/') {
            assert!(readme.contains(&format!("`{short}`")), "{folder}: README.md does not name `{short}`");
        }
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
    // Both fields of a mixed basis are chosen from the same kinds.
    let others: &[&str] = match path {
        "section" => &["beam.section"],
        "basis.axial" => &["basis.transverse"],
        _ => &[],
    };
    chosen(path) || others.iter().any(|path| chosen(path))
}

fn every_kind_that_a_case_may_choose_is_verified() {
    let readings: Vec<Reading> = run::all().iter().map(|v| run::case(&v.name, &[]).unwrap()).collect();
    for choice in choices() {
        for kind in choice.kinds() {
            let used = readings.iter().any(|reading| uses(reading, choice.path(), kind.name));
            assert!(used, "no case of verification uses the {} `{}`", choice.name(), kind.name);
        }
    }
}
