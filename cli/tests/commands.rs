//! The commands as a user meets them: exit codes, messages and files.

#![allow(clippy::unwrap_used)] // in helpers of tests

use std::path::Path;
use std::process::{Command, Output};

const SPIN_UP: &str = r#"
title = "spin-up"
[beam]
length = "10 m"
[section]
kind = "uniform"
modulus = "70 GPa"
density = "3000 kg/m^3"
area = "4 cm^2"
second-moment = "2e-7 m^4"
[hub]
motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" }
[integrator]
kind = "newmark"
step = "5 ms"
[run]
duration = "20 s"
[output]
step = "10 ms"
"#;

/// A folder with the case in `spin-up/case.toml`.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("spin-up")).unwrap();
    std::fs::write(folder.path().join("spin-up/case.toml"), SPIN_UP).unwrap();
    folder
}

fn flexion(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexion")).args(arguments).current_dir(folder).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

#[test]
fn a_run_that_finishes_exits_with_0_and_names_its_files() {
    let folder = folder();
    let output = flexion(folder.path(), &["run", "spin-up"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stderr.is_empty(), "a pipe gets no progress bar: {}", text(&output.stderr));
    assert!(text(&output.stdout).contains("results/spin-up/summary.json"), "{}", text(&output.stdout));
    let summary = std::fs::read_to_string(folder.path().join("results/spin-up/summary.json")).unwrap();
    assert!(summary.contains("\"finished\""));
    // The resolved case repeats the run byte for byte.
    let resolved = "results/spin-up/case.resolved.toml";
    let again = flexion(folder.path(), &["run", resolved, "--output", "again"]);
    assert_eq!(again.status.code(), Some(0), "{}", text(&again.stderr));
    let trajectory = |of: &str| std::fs::read(folder.path().join(of).join("trajectory.csv")).unwrap();
    assert!(trajectory("again") == trajectory("results/spin-up"));
}

#[test]
fn results_are_replaced_only_by_force() {
    let folder = folder();
    assert_eq!(flexion(folder.path(), &["run", "spin-up", "-o", "out"]).status.code(), Some(0));
    let second = flexion(folder.path(), &["run", "spin-up", "-o", "out"]);
    assert_eq!(second.status.code(), Some(1));
    assert!(text(&second.stderr).contains("--force"), "{}", text(&second.stderr));
    assert_eq!(flexion(folder.path(), &["run", "spin-up", "-o", "out", "--force"]).status.code(), Some(0));
}

#[test]
fn a_rejected_case_or_command_line_exits_with_1_and_writes_nothing() {
    let folder = folder();
    for arguments in [
        &["run", "missing.toml"][..],
        &["run", "spin-up", "--set", "section.modulus=70 GPs"],
        &["run", "spin-up", "--set", "integrator.kind=adams-4"],
        &["run", "spin-up", "--output", "spin-up/case.toml"],
        &["check", "spin-up", "--set", "beam.length=-1"],
        &["check"],
        &["fly"],
        &["list", "wings"],
    ] {
        let output = flexion(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(text(&output.stderr).contains("error"), "{arguments:?}: {}", text(&output.stderr));
        assert!(!text(&output.stderr).contains('\u{1b}'), "a pipe gets no colours");
    }
    assert!(!folder.path().join("results").exists());
}

#[test]
fn a_run_that_breaks_down_exits_with_2_and_keeps_what_it_computed() {
    let folder = folder();
    let output = flexion(
        folder.path(),
        &[
            "run",
            "spin-up",
            "--set",
            "model.coupling=zeroth",
            "--set",
            "hub.motion.speed=20 rad/s",
            "-o",
            "out",
        ],
    );
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert!(text(&output.stderr).contains("zeroth"), "{}", text(&output.stderr));
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    assert!(summary.contains("\"failed\""));
    let rows = std::fs::read_to_string(folder.path().join("out/trajectory.csv")).unwrap().lines().count();
    assert!((10..2000).contains(&rows), "{rows} rows");
}

#[cfg(unix)]
#[test]
fn an_interrupt_stops_the_run_with_2_and_keeps_what_it_computed() {
    let folder = folder();
    // 2e8 steps: far more than fit into the time before the interrupt.
    let run = Command::new(env!("CARGO_BIN_EXE_flexion"))
        .args(["run", "spin-up", "-o", "out", "--set", "integrator.step=0.1 us"])
        .current_dir(folder.path())
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(700));
    Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap();
    let output = run.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    assert!(summary.contains("\"stopped\""), "{summary}");
}

#[test]
fn check_list_schema_and_help_print_what_they_say() {
    let folder = folder();
    for (arguments, expected) in [
        (&["check", "spin-up"][..], "half-bandwidth"),
        (&["check", "spin-up"], "stable step"),
        (&["check", "spin-up/case.toml", "--set", "basis={kind='radial'}"], "condition number"),
        (&["list"], "doi:10.6052/0459-1879-14-334"),
        (&["list", "integrator"], "spectral-radius"),
        (&["schema"], "https://json-schema.org/draft/2020-12/schema"),
        (&["run", "--help"], "Examples:"),
        (&["check", "--help"], "Examples:"),
        (&["list", "--help"], "Examples:"),
        (&["schema", "--help"], "Example:"),
        (&["--help"], "Example:"),
        (&["--version"], "flexion"),
    ] {
        let output = flexion(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
        assert!(text(&output.stdout).contains(expected), "{arguments:?}: {}", text(&output.stdout));
    }
}
