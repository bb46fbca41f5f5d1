//! The commands of the program: exit codes, messages and files.

#![allow(clippy::unwrap_used)] // in helpers of tests

mod program;

use program::{flexion, folder, text};
use std::process::Command;

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
fn statics_follow_a_column_past_its_buckling_load() {
    let folder = folder();
    let column = |more: &[&str]| {
        let common = [
            "statics",
            "spin-up",
            "--set",
            "model.coupling=exact",
            "--set",
            "load=[{on='10 m', force=['-400 N', '1 N']}]",
        ];
        flexion(folder.path(), &[&common[..], more].concat())
    };
    let output = column(&["-o", "column"]);
    assert_eq!(output.status.code(), Some(0), "{} {}", text(&output.stdout), text(&output.stderr));
    for file in
        ["statics.json", "statics.csv", "statics.npz", "statics.svg", "statics.png", "case.resolved.toml"]
    {
        assert!(folder.path().join("column").join(file).exists(), "{file}");
    }
    let csv = std::fs::read_to_string(folder.path().join("column/statics.csv")).unwrap();
    let last: Vec<&str> = csv.lines().last().unwrap().split(',').collect();
    let head: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let at = head.iter().position(|name| *name == "tip.deflection [m]").unwrap();
    assert_eq!((last[0], last[2]), ("1.0", "0"), "{csv}");
    // 345.4 N is the load of Euler: bent far, towards the small force.
    assert!(last[at].parse::<f64>().unwrap() > 1.0, "{}", last[at]);
    assert_eq!(column(&["-o", "column"]).status.code(), Some(1));
    let short = column(&["-o", "short", "--points", "5"]);
    assert_eq!(short.status.code(), Some(2), "{}", text(&short.stderr));
    assert!(text(&short.stderr).contains("allow more points"), "{}", text(&short.stderr));
    let turning =
        flexion(folder.path(), &["statics", "spin-up", "--set", "hub.motion={kind='constant',speed=3}"]);
    assert_eq!(turning.status.code(), Some(1));
    assert!(text(&turning.stderr).contains("not in static equilibrium"), "{}", text(&turning.stderr));
}

#[test]
fn modes_and_campbell_write_whole_results_and_refuse_what_cannot_be() {
    let folder = folder();
    let output = flexion(folder.path(), &["modes", "spin-up", "--speed", "4", "--count", "4", "-o", "modes"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("Sturm count"), "{}", text(&output.stdout));
    for file in ["modes.json", "modes.csv", "modes.npz", "modes.svg", "modes.png", "case.resolved.toml"] {
        assert!(folder.path().join("modes").join(file).exists(), "{file}");
    }
    let campbell = |more: &[&str]| {
        let common = ["campbell", "spin-up", "--speeds", "0:6:7", "--modes", "3"];
        flexion(folder.path(), &[&common[..], more].concat())
    };
    for (threads, to) in [("1", "one"), ("2", "two")] {
        let output = campbell(&["--threads", threads, "-o", to]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
    for file in ["campbell.json", "campbell.csv", "campbell.npz", "campbell.svg"] {
        let read = |of: &str| std::fs::read(folder.path().join(of).join(file)).unwrap();
        assert!(read("one") == read("two"), "{file} depends on the number of threads");
    }
    assert_eq!(campbell(&["-o", "one"]).status.code(), Some(1));
    assert_eq!(campbell(&["-o", "one", "--force"]).status.code(), Some(0));
    let buckled = campbell(&["--set", "model.coupling=zeroth", "-o", "zeroth"]);
    assert_eq!(buckled.status.code(), Some(0), "{}", text(&buckled.stderr));
    assert!(text(&buckled.stderr).contains("is unstable from"), "{}", text(&buckled.stderr));
    for (file, word) in [("campbell.json", "\"divergence\""), ("campbell.svg", "divergence")] {
        let file = std::fs::read_to_string(folder.path().join("zeroth").join(file)).unwrap();
        assert!(file.contains(word), "{file}");
    }
    // 6 rad/s are 57.29577951308232 rpm.
    let output = flexion(
        folder.path(),
        &[
            &["campbell", "spin-up", "--speeds", "0 rpm:57.29577951308232 rpm:7", "--modes", "3"][..],
            &["--unit", "rad/s", "-o", "rpm"],
        ]
        .concat(),
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let last = |of: &str| {
        let csv = std::fs::read_to_string(folder.path().join(of).join("campbell.csv")).unwrap();
        csv.lines().last().unwrap().split(',').map(|x| x.parse().unwrap()).collect::<Vec<f64>>()
    };
    for (a, b) in last("one").iter().zip(last("rpm")) {
        assert!((a - b).abs() <= 1e-9 * a.abs(), "{a} {b}");
    }
    // Loads fixed in space rotate against the hub: left out, with a warning.
    let heavy = flexion(folder.path(), &["modes", "spin-up", "--speed", "4", "--set", "gravity=[0, -9.81]"]);
    let light = flexion(folder.path(), &["modes", "spin-up", "--speed", "4"]);
    assert!(text(&heavy.stderr).contains("without gravity"), "{}", text(&heavy.stderr));
    assert_eq!(text(&heavy.stdout), text(&light.stdout));
    // As many as there are, which is said.
    let all = flexion(folder.path(), &["modes", "spin-up", "--count", "500"]);
    assert_eq!(all.status.code(), Some(0), "{}", text(&all.stderr));
    assert!(text(&all.stdout).contains("500 modes were asked for"), "{}", text(&all.stdout));
    for (arguments, expected) in [
        (&["modes", "spin-up", "--speed", "nan"][..], "speed"),
        (&["modes", "spin-up", "--speed", "6", "--set", "model.coupling=zeroth"], "buckled"),
        (&["modes", "spin-up", "--free-hub"], "hub is free"),
        (&["campbell", "spin-up", "--speeds", "5:1:3"], "ascend"),
        (&["campbell", "spin-up", "--speeds", "0:20 rps:3"], "`20 rps` is no speed"),
        (&["modes", "spin-up", "--speed", "4 m/s"], "no speed"),
        (&["campbell", "spin-up", "--speeds", "0:1:1"], "from 2"),
        (&["campbell", "spin-up"], "--speeds"),
    ] {
        let output = flexion(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(text(&output.stderr).contains(expected), "{arguments:?}: {}", text(&output.stderr));
    }
}

/// A blade in `blade/case.toml`, twisted and with torsion, and stations of another one that are not sorted.
fn blade() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let case = r#"
title = "blade"
[beam]
length = "10 m"
twist = "30 deg"
[section]
kind = "deck"
file = "stations.csv"
format = "csv"
[hub]
radius = "1 m"
motion = { kind = "constant", speed = "4 rad/s" }
[model]
coupling = "space"
[basis]
elements = 12
[integrator]
kind = "radau"
[run]
duration = "1 s"
"#;
    let head = "x, mass, EA, EI-flap, EI-chord, GJ, inertia-flap, inertia-chord\n";
    let row = |x: u32| format!("{x}, 10, 1e7, 1e4, 4e4, 5e3, 0.1, 0.4\n");
    let write = |name: &str, text: String| {
        std::fs::create_dir_all(folder.path().join("blade")).unwrap();
        std::fs::write(folder.path().join("blade").join(name), text).unwrap();
    };
    write("case.toml", case.to_owned());
    write("stations.csv", format!("{head}{}{}", row(0), row(10)));
    write("unsorted.csv", format!("{head}{}{}{}{}", row(0), row(6), row(4), row(10)));
    write("empty.csv", head.to_owned());
    write("short.csv", format!("{head}{}{}", row(0), row(0)));
    folder
}

#[test]
fn modes_of_a_blade_say_how_it_moves_and_what_is_wrong_with_it() {
    let folder = blade();
    let output = flexion(
        folder.path(),
        &["modes", "blade", "--speed", "4", "--count", "40", "--unit", "Hz", "-o", "out"],
    );
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for word in ["flap", "chord", "torsion", "axial", "Hz", "Sturm count"] {
        assert!(text(&output.stdout).contains(word), "{word}: {}", text(&output.stdout));
    }
    let common = ["campbell", "blade", "--speeds", "0:120:13", "--modes", "4", "--unit", "rpm"];
    for (threads, to) in [("1", "one"), ("2", "two")] {
        let output = flexion(folder.path(), &[&common[..], &["--threads", threads, "-o", to]].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        assert!(text(&output.stdout).contains("4Ω"), "{}", text(&output.stdout));
    }
    for file in ["campbell.json", "campbell.csv", "campbell.npz", "campbell.svg", "campbell.png"] {
        let read = |of: &str| std::fs::read(folder.path().join(of).join(file)).unwrap();
        assert!(read("one") == read("two"), "{file} depends on the number of threads");
    }
    let figure = std::fs::read_to_string(folder.path().join("one/campbell.svg")).unwrap();
    for word in ["1 flap", "1Ω", "4Ω", "[rpm]", "crossings"] {
        assert!(figure.contains(word), "{word}");
    }
    for (arguments, expected) in [
        // Ω L √(ρA/EA) > π/2: the strain would be infinite.
        (&["modes", "blade", "--speed", "300"][..], &["300 rad/s", "followed up to 157.0"][..]),
        (
            &["modes", "blade", "--set", "section.file=unsorted.csv"],
            &["section.file", "unsorted.csv", "4 m", "6 m"],
        ),
        (&["modes", "blade", "--set", "section.file=empty.csv"], &["section.file", "empty.csv"]),
        (&["modes", "blade", "--set", "section.file=short.csv"], &["section.file"]),
        (&["modes", "blade", "--set", "blade.pitch=1"], &["blade"]),
    ] {
        let output = flexion(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        for word in expected {
            assert!(text(&output.stderr).contains(word), "{arguments:?}: {}", text(&output.stderr));
        }
    }
    let diverged = flexion(folder.path(), &["campbell", "blade", "--speeds", "0:300:4", "-o", "soft"]);
    assert_eq!(diverged.status.code(), Some(2), "{}", text(&diverged.stderr));
    let kept = std::fs::read_to_string(folder.path().join("soft/campbell.json")).unwrap();
    assert!(kept.contains("no steady rotation"), "{kept}");
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
        (&["--help"], "Examples:"),
        (&["--version"], "flexion"),
    ] {
        let output = flexion(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
        assert!(text(&output.stdout).contains(expected), "{arguments:?}: {}", text(&output.stdout));
    }
}

#[test]
fn every_template_is_listed_and_passes_the_check() {
    let folder = folder();
    let list = text(&flexion(folder.path(), &["new", "--list"]).stdout);
    let names: Vec<&str> = list.lines().filter_map(|line| line.split_whitespace().next()).collect();
    assert!(names.contains(&"spin-up") && names.contains(&"exact-large-deflection"), "{list}");
    for name in names {
        let file = format!("made/{name}.toml");
        assert_eq!(flexion(folder.path(), &["new", name, "-o", &file]).status.code(), Some(0));
        let checked = flexion(folder.path(), &["check", &file]);
        assert_eq!(checked.status.code(), Some(0), "{name}: {}", text(&checked.stderr));
        let printed = flexion(folder.path(), &["new", name]);
        assert_eq!(printed.stdout, std::fs::read(folder.path().join(&file)).unwrap());
        let again = flexion(folder.path(), &["new", name, "-o", &file]);
        assert_eq!(again.status.code(), Some(1));
        assert!(text(&again.stderr).contains("--force"));
    }
    let unknown = flexion(folder.path(), &["new", "helicopter"]);
    assert_eq!(unknown.status.code(), Some(1));
    assert!(text(&unknown.stderr).contains("spin-up"), "{}", text(&unknown.stderr));
}

#[test]
fn runs_are_compared_and_a_tolerance_decides_the_exit_code() {
    let folder = folder();
    let run = |arguments: &[&str]| {
        let output = flexion(folder.path(), &[&["run", "spin-up"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    };
    run(&["-o", "fine"]);
    run(&["-o", "same"]);
    run(&[
        "-o",
        "coarse",
        "--set",
        "basis={kind='finite-elements',elements=3}",
        "--set",
        "output.step=30 ms",
    ]);
    let same = flexion(folder.path(), &["compare", "fine", "same", "--tolerance", "0"]);
    assert_eq!(same.status.code(), Some(0), "{}", text(&same.stderr));
    assert!(text(&same.stdout).contains("the same in both"));
    let compare = ["compare", "fine", "coarse", "same", "-c", "tip.*,hub.torque", "-o", "differences"];
    let compared = flexion(folder.path(), &[&compare[..], &["--tolerance", "0.05"]].concat());
    assert_eq!(compared.status.code(), Some(0), "{}", text(&compared.stderr));
    assert!(text(&compared.stdout).contains("interpolated by cubics"));
    for file in ["compare.json", "compare.csv", "compare.svg", "compare.png"] {
        assert!(folder.path().join("differences").join(file).is_file(), "{file}");
    }
    let read = || std::fs::read_to_string(folder.path().join("differences/compare.csv")).unwrap();
    assert_eq!(read().lines().count(), 1 + 2 * 7, "six columns of the tip and one of the hub, for two runs");
    assert!(!read().contains("energy"));
    let (before, force) = (read(), [&compare[..], &["--force", "--tolerance", "1e-9"]].concat());
    assert_eq!(flexion(folder.path(), &compare).status.code(), Some(1), "without --force it stays");
    let beyond = flexion(folder.path(), &force);
    assert_eq!(beyond.status.code(), Some(2));
    assert!(text(&beyond.stderr).contains("coarse: tip.deflection differs by"), "{}", text(&beyond.stderr));
    assert_eq!(read(), before, "the same comparison gives the same bytes");
    for (arguments, message) in [
        (&["compare", "fine"][..], "RUN"),
        (&["compare", "fine", "nowhere"], "holds no trajectory.csv"),
        (&["compare", "fine", "same", "--columns", "tip.defelction"], "did you mean `tip.deflection`?"),
        (&["compare", "fine", "same", "--tolerance=-1"], "zero or positive"),
        (&["compare", "fine", "spin-up/case.toml"], "case.toml"),
    ] {
        let output = flexion(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(text(&output.stderr).contains(message), "{arguments:?}: {}", text(&output.stderr));
    }
}

#[test]
fn a_run_draws_nothing_and_ends_early_if_it_is_asked_to() {
    let folder = folder();
    let output = flexion(folder.path(), &["run", "spin-up", "--no-plots", "--until", "0.5 s", "-o", "out"]);
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), String::new()));
    assert!(text(&output.stdout).contains("stopped at t = 0.5"), "{}", text(&output.stdout));
    let held = |name: &str| folder.path().join("out").join(name).exists();
    assert!(held("summary.json") && !held("plot.svg") && !held("plot.png"));
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).unwrap();
    assert!(summary.contains("as asked"), "{summary}");
}

#[test]
fn a_campbell_diagram_of_speeds_in_rpm_is_in_rpm_and_hertz() {
    let folder = blade();
    let common =
        ["campbell", "blade", "--speeds", "0 rpm:60 rpm:7", "--modes", "3", "--margin", "10", "-o", "out"];
    let output = flexion(folder.path(), &[&common[..], &["--title", "A blade"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("within 10 % of kΩ"), "{}", text(&output.stdout));
    let read = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    let head = read("campbell.csv").lines().next().unwrap().to_owned();
    assert!(head.starts_with("speed [rpm],mode1-flap.frequency [Hz],mode1-flap.damping-ratio,"), "{head}");
    assert!(head.contains("mode1-flap.share.flap") && !head.contains("mode4"), "{head}");
    let figure = read("campbell.svg");
    assert!(figure.contains("Speed Ω [rpm]") && figure.contains("Frequency f [Hz]"), "{figure}");
    assert!(figure.contains("A blade") && read("campbell.json").contains("\"resonances\": [\n"));
    // The same speeds, all in one unit.
    let units = ["--speed-unit", "Hz", "--frequency-unit", "rad/s", "--force"];
    assert_eq!(flexion(folder.path(), &[&common[..], &units].concat()).status.code(), Some(0));
    assert!(read("campbell.csv").starts_with("speed [Hz],mode1-flap.frequency [rad/s],"));
}

#[test]
fn shapes_are_written_when_asked_for() {
    let folder = folder();
    let output =
        flexion(folder.path(), &["run", "spin-up", "--vtk", "--set", "output.vtk-step=1 s", "-o", "out"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("out/beam.pvd"));
    let collection = std::fs::read_to_string(folder.path().join("out/beam.pvd")).unwrap();
    assert_eq!(collection.matches("<DataSet").count(), 21);
    assert_eq!(std::fs::read_dir(folder.path().join("out/vtk")).unwrap().count(), 21);
    // The next run does not ask for them: they go with the former results.
    assert_eq!(flexion(folder.path(), &["run", "spin-up", "-o", "out", "--force"]).status.code(), Some(0));
    assert!(!folder.path().join("out/beam.pvd").exists() && !folder.path().join("out/vtk").exists());
}

#[cfg(unix)]
#[test]
fn a_killed_run_leaves_the_former_results_and_the_next_run_works() {
    let folder = folder();
    assert_eq!(flexion(folder.path(), &["run", "spin-up", "-o", "out"]).status.code(), Some(0));
    let content = || {
        let mut files: Vec<_> = std::fs::read_dir(folder.path().join("out"))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .map(|path| (path.clone(), std::fs::read(path).unwrap()))
            .collect();
        files.sort();
        files
    };
    let before = content();
    let start = || {
        Command::new(env!("CARGO_BIN_EXE_flexion"))
            .args(["run", "spin-up", "-o", "out", "--force", "--set", "integrator.step=0.1 us"])
            .current_dir(folder.path())
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap()
    };
    let mut run = start();
    std::thread::sleep(std::time::Duration::from_millis(700));
    // A second run cannot take the same directory meanwhile.
    let second = flexion(folder.path(), &["run", "spin-up", "-o", "out", "--force"]);
    assert_eq!(second.status.code(), Some(1));
    assert!(text(&second.stderr).contains("another run"), "{}", text(&second.stderr));
    run.kill().unwrap();
    run.wait().unwrap();
    assert!(content() == before);
    assert_eq!(flexion(folder.path(), &["run", "spin-up", "-o", "out", "--force"]).status.code(), Some(0));
    assert_eq!(content().len(), before.len());
}

#[test]
fn advice_is_written_the_same_each_time_and_has_an_exit_code() {
    let folder = folder();
    let advise = |output: &str, tolerance: &str| {
        let quantity = ["--quantity", "tip.deflection.final", "--output", output];
        let output = flexion(
            folder.path(),
            &[&["advise", "spin-up", "--tolerance", tolerance], &quantity[..]].concat(),
        );
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    };
    let (code, printed, message) = advise("a", "1e-2");
    assert_eq!(code, Some(0), "{message}");
    assert!(
        printed.contains("--set \"model.coupling=") && printed.contains("difference over asked"),
        "{printed}"
    );
    advise("b", "1e-2");
    for file in ["advice.json", "advice.csv"] {
        let read = |name: &str| std::fs::read_to_string(folder.path().join(name).join(file)).unwrap();
        assert!(read("a") == read("b"), "{file}");
    }
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("a/advice.json")).unwrap()).unwrap();
    assert!(
        json["cheapest"]["difference"].as_f64().unwrap() <= 1.0
            && json["tried"].as_array().unwrap().len() > 5
    );
    let (code, _, message) = advise("c", "much");
    assert!(code == Some(1) && message.contains("much"), "{message}");
}

#[test]
fn completions_and_manual_pages_name_every_command() {
    let folder = folder();
    let help = text(&flexion(folder.path(), &["--help"]).stdout);
    let commands: Vec<&str> = help
        .lines()
        .skip_while(|line| *line != "Commands:")
        .skip(1)
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .filter(|name| *name != "help")
        .collect();
    assert!(commands.contains(&"compare") && commands.len() >= 9, "{commands:?}");
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let output = flexion(folder.path(), &["completions", shell]);
        assert_eq!(output.status.code(), Some(0));
        for command in &commands {
            assert!(text(&output.stdout).contains(command), "{shell}: {command}");
        }
    }
    let page = text(&flexion(folder.path(), &["man"]).stdout);
    assert!(page.contains(".TH flexion 1"), "{}", &page[..200]);
    assert_eq!(flexion(folder.path(), &["man", "--output", "man1"]).status.code(), Some(0));
    for command in commands {
        let page = std::fs::read_to_string(folder.path().join(format!("man1/flexion-{command}.1"))).unwrap();
        assert!(page.contains(".SH SYNOPSIS"), "{command}");
        let help = text(&flexion(folder.path(), &[command, "--help"]).stdout);
        assert!(help.contains("Example"), "{command} --help has an example");
    }
}

#[test]
fn the_long_spelling_of_a_case_gives_the_bytes_of_the_short_one() {
    let folder = folder();
    let space = ["--set", "model.coupling=space", "--set", "run.duration=0.1"];
    let long = flexion(folder.path(), &[&["check", "spin-up", "--long"][..], &space].concat());
    assert_eq!(long.status.code(), Some(0), "{}", text(&long.stderr));
    std::fs::write(folder.path().join("long.toml"), &long.stdout).unwrap();
    for run in
        [&[&["run", "spin-up", "-o", "short"][..], &space].concat()[..], &["run", "long.toml", "-o", "long"]]
    {
        let output = flexion(folder.path(), run);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
    let trajectory = |of: &str| std::fs::read(folder.path().join(of).join("trajectory.csv")).unwrap();
    assert!(trajectory("short") == trajectory("long"), "{}", text(&long.stdout));
    let planar = flexion(folder.path(), &["check", "spin-up", "--long"]);
    assert_eq!(planar.status.code(), Some(1));
    assert!(text(&planar.stderr).contains("model.coupling = \"space\""), "{}", text(&planar.stderr));
}
