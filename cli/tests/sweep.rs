//! `flexion sweep`: its exit codes, its files, and that it goes on from wherever it was killed.

#![allow(clippy::unwrap_used)] // in helpers of tests

mod program;

use program::{flexion, folder, text};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

const GRID: [&str; 8] = [
    "sweep",
    "spin-up",
    "--vary",
    "section.modulus=60 GPa:80 GPa:30",
    "--collect",
    "tip.deflection.min",
    "--errors",
    "none",
];

/// A grid of rows, one a part.
fn grid<'a>(output: &'a str, further: &[&'a str]) -> Vec<&'a str> {
    GRID.into_iter().chain(["--part", "1", "--output", output]).chain(further.iter().copied()).collect()
}

/// The whole parts of a folder.
fn parts(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let Ok(entries) = std::fs::read_dir(folder) else { return BTreeMap::new() };
    let entries = entries.map(|entry| entry.unwrap().path());
    let parts = entries.filter(|path| path.extension().is_some_and(|end| end == "parquet"));
    parts
        .map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read(&path).unwrap()))
        .collect()
}

/// The rows of a sweep without their wall times, which is the last column but one.
fn rows(folder: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(folder.join("sweep.csv")).unwrap();
    let without = |line: &str| {
        let mut fields: Vec<&str> = line.rsplitn(3, ',').collect();
        fields.remove(1);
        fields.join(",")
    };
    text.lines().map(without).collect()
}

#[test]
fn a_sweep_that_is_killed_at_any_moment_goes_on_and_repeats_nothing() {
    let folder = folder();
    let of = |name: &str| folder.path().join(name);
    assert_eq!(flexion(folder.path(), &grid("whole", &[])).status.code(), Some(0));
    // Numbers of a linear congruential generator decide when it is killed.
    let mut seed = 12345u64;
    let mut before = BTreeMap::new();
    for _ in 0..6 {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mut child = Command::new(env!("CARGO_BIN_EXE_flexion"))
            .args(grid("killed", &["--threads", "1"]))
            .current_dir(folder.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(20 + (seed >> 33) % 130));
        child.kill().unwrap();
        child.wait().unwrap();
        let now = parts(&of("killed"));
        // What was whole is what it was: a part computed twice would have another wall time.
        assert!(before.iter().all(|(name, bytes)| now.get(name) == Some(bytes)));
        before = now;
    }
    let done = flexion(folder.path(), &grid("killed", &[]));
    let said = text(&done.stdout);
    assert_eq!(done.status.code(), Some(0), "{said}{}", text(&done.stderr));
    assert!(before.len() < 30 || said.contains("30 were there before"), "{said}");
    let now = parts(&of("killed"));
    assert!(now.len() == 30 && before.iter().all(|(name, bytes)| now.get(name) == Some(bytes)));
    assert_eq!(rows(&of("killed")), rows(&of("whole")));
    let hidden = std::fs::read_dir(of("killed")).unwrap().map(|entry| entry.unwrap().file_name());
    let left: Vec<_> = hidden.filter(|name| name.to_str().unwrap().starts_with('.')).collect();
    assert!(left.is_empty(), "{left:?}");
}

#[test]
fn shards_of_a_sweep_make_the_whole_of_it() {
    let folder = folder();
    assert_eq!(flexion(folder.path(), &grid("whole", &["--threads", "2"])).status.code(), Some(0));
    for shard in ["2/3", "3/3", "1/3"] {
        let done = flexion(folder.path(), &grid("shards", &["--shard", shard]));
        assert_eq!(done.status.code(), Some(0));
        assert!(
            text(&done.stdout).contains("10 of 10 rows are done, of a shard of 30"),
            "{}",
            text(&done.stdout)
        );
    }
    let of = |name: &str| folder.path().join(name);
    assert_eq!(rows(&of("shards")), rows(&of("whole")));
}

#[test]
fn what_a_sweep_says_is_what_became_of_it() {
    let folder = folder();
    let sweep = |further: &[&str]| {
        let all: Vec<&str> = ["sweep", "spin-up"].into_iter().chain(further.iter().copied()).collect();
        let done = flexion(folder.path(), &all);
        (done.status.code(), text(&done.stdout), text(&done.stderr))
    };
    let sampled = [
        "--vary",
        "section.modulus=normal(70 GPa, 1 GPa)",
        "--sample",
        "sobol",
        "--runs",
        "8",
        "--seed",
        "5",
    ];
    let collect = ["--collect", "tip.deflection", "--set", "run.duration=1 s"];
    let (code, out, said) = sweep(&[&sampled[..], &collect[..]].concat());
    assert_eq!(code, Some(0), "{said}");
    for part in [
        "8 of 8 rows are done; seed 5",
        "tip.deflection.max",
        "8 of 8 rows (100.0 %)",
        "polars.read_parquet(\"results/spin-up-sweep/*.parquet\")",
    ] {
        assert!(out.contains(part), "{part}\n{out}");
    }
    // Rejected: an unknown key, a folder of another sweep, a column that is not there.
    let (code, _, said) = sweep(&["--vary", "section.modlus=1,2", "--collect", "tip.deflection"]);
    assert!(code == Some(1) && said.contains("did you mean `modulus`?"), "{said}");
    let (code, _, said) = sweep(&["--vary", "section.modulus=1,2 GPa", "--collect", "tip.deflection"]);
    assert!(code == Some(1) && said.contains("some values have a unit and others none"), "{said}");
    let (code, _, said) = sweep(&["--vary", "section.modulus=70 GPa", "--collect", "tip.deflction.min"]);
    assert!(code == Some(1) && said.contains("tip.deflection"), "{said}");
    let (code, _, said) = sweep(&["--vary", "section.modulus=70 GPa", "--collect", "tip.deflection"]);
    assert!(code == Some(1) && said.contains("holds another sweep"), "{said}");
    let (code, _, said) = sweep(&["--collect", "tip.deflection"]);
    assert!(code == Some(1) && said.contains("nothing is varied"), "{said}");
    // Too many failures.
    let bad = ["--vary", "section.modulus=-1 GPa, 70 GPa", "--output", "bad", "--errors", "none"];
    let (code, out, said) = sweep(&[&bad[..], &collect[..]].concat());
    assert!(
        code == Some(2)
            && out.contains("1 rejected")
            && said.contains("1 of the first 2 rows did not finish"),
        "{out}{said}"
    );
    let (code, ..) = sweep(&[&bad[..], &collect[..], &["--keep-going"]].concat());
    assert_eq!(code, Some(0));
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_parts_that_are_whole() {
    let folder = folder();
    let child = Command::new(env!("CARGO_BIN_EXE_flexion"))
        .args(grid("stopped", &["--set", "run.duration=200 s", "--threads", "1"]))
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    while parts(&folder.path().join("stopped")).is_empty() {
        std::thread::sleep(Duration::from_millis(5));
    }
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
    let done = child.wait_with_output().unwrap();
    let (out, said) = (text(&done.stdout), text(&done.stderr));
    assert_eq!(done.status.code(), Some(2), "{out}{said}");
    assert!(said.contains("stopped by the user: the same command goes on"), "{said}");
    let whole = parts(&folder.path().join("stopped")).len();
    assert!((1..30).contains(&whole) && out.contains(&format!("{whole} of 30 rows are done")), "{out}");
}
