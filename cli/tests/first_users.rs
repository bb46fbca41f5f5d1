//! What first users met: templates, listings, cases without a run, blades that say what they are, and messages.

#![allow(clippy::unwrap_used)] // in helpers of tests

mod program;

use program::{flexion, folder, text};
use std::path::Path;

/// What a command that succeeds prints.
fn printed(folder: &Path, arguments: &[&str]) -> String {
    let output = flexion(folder, arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// The message of a command that is rejected.
fn rejected(folder: &Path, arguments: &[&str]) -> String {
    let output = flexion(folder, arguments);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {}", text(&output.stdout));
    text(&output.stderr)
}

#[test]
fn each_template_runs() {
    let folder = folder();
    let list = printed(folder.path(), &["new", "--list"]);
    for name in list.lines().filter_map(|line| line.split_whitespace().next()) {
        let file = format!("{name}.toml");
        printed(folder.path(), &["new", name, "-o", &file]);
        if name == "blade" {
            printed(folder.path(), &["modes", &file, "--speed", "20 rpm", "-o", "results/blade"]);
            assert!(rejected(folder.path(), &["run", &file]).contains("hub.motion"));
        } else {
            printed(
                folder.path(),
                &[
                    "run",
                    &file,
                    "-o",
                    &format!("results/{name}"),
                    "--error",
                    "off",
                    "--no-plots",
                    "--until",
                    "0.3 s",
                ],
            );
        }
    }
}

#[test]
fn the_template_of_a_blade_says_what_it_is() {
    let folder = folder();
    printed(folder.path(), &["new", "blade", "-o", "blade.toml"]);
    let check = printed(folder.path(), &["check", "blade.toml"]);
    // The trapezoids of its table.
    for line in [
        "beam                1904.500000 kg",
        "flapwise stiffness  3.800000e8 N·m² at the root, 6.000000e4 at the tip",
        "edgewise stiffness  4.200000e8 N·m² at the root, 9.000000e5 at the tip",
        "twist               -12.000° at the root, 0.000° at the tip",
        "torsion             as its section says",
        "not without `hub.motion` and `run.duration`",
    ] {
        assert!(check.contains(line), "{line}: {check}");
    }
    let without = printed(folder.path(), &["check", "blade.toml", "--set", "beam.torsion=false"]);
    assert!(without.contains("torsion             held"), "{without}");
    let modes = printed(folder.path(), &["modes", "blade.toml", "--speed", "30 rpm", "--count", "4"]);
    assert!(modes.contains("Hz") && modes.contains("flap") && modes.contains("chord"), "{modes}");
    let speeds = ["--speeds", "0 rpm:40 rpm:5", "--modes", "4"];
    printed(folder.path(), &[&["campbell", "blade.toml", "-o", "campbell"], &speeds[..]].concat());
    assert!(folder.path().join("campbell/campbell.png").exists());
}

#[test]
fn the_arm_comes_to_rest_where_its_motor_balances_gravity() {
    let folder = folder();
    printed(folder.path(), &["new", "arm", "-o", "arm.toml"]);
    let stations = ["--set", "output.stations=['0.5 m']", "--no-plots", "--error", "off"];
    let printed = printed(folder.path(), &[&["run", "arm.toml", "-o", "arm"], &stations[..]].concat());
    assert!(folder.path().join("arm/trajectory.csv").exists(), "{printed}");
    let csv = std::fs::read_to_string(folder.path().join("arm/trajectory.csv")).unwrap();
    let column = csv.lines().next().unwrap().split(',').position(|name| name == "hub.angle [rad]").unwrap();
    let last: f64 = csv.lines().last().unwrap().split(',').nth(column).unwrap().parse().unwrap();
    // 80 N·m/rad (60° − θ) = g (m (a + L) + ρAL (a + L/2)) cos θ of the rigid arm; the bend of 3 mm changes θ by less than 1e-3.
    let moment = 9.81 * (0.1 * 1.05 + 0.405 * 0.55);
    let mut angle = 60_f64.to_radians();
    for _ in 0..50 {
        angle = 60_f64.to_radians() - moment * angle.cos() / 80.0;
    }
    assert!((last - angle).abs() < 1e-3, "{last} for {angle}");
}

#[test]
fn each_table_of_a_case_can_be_listed() {
    let folder = folder();
    for (name, line) in [
        ("load", "components of the force"),
        ("gravity", "acceleration of gravity"),
        ("mass", "moment of inertia about its centre"),
        ("damping", "stiffness"),
        ("output", "strain-heights"),
        ("beam", "[[beam]] of a system in space"),
        ("body", "[[body]] of a system in space"),
        ("section", "elastodyn"),
        ("run", "duration"),
        ("joint", "revolute"),
        ("contact.law", "hertz"),
        ("law", "hertz"),
    ] {
        let listed = printed(folder.path(), &["list", name]);
        assert!(listed.contains(line), "{name}: {listed}");
    }
    assert!(rejected(folder.path(), &["list", "loads"]).contains("'load'"));
}

#[test]
fn the_page_of_keys_is_current() {
    let folder = folder();
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/guide/keys.md");
    let written = std::fs::read_to_string(page).unwrap();
    assert!(
        printed(folder.path(), &["list", "--markdown"]) == written,
        "cargo run --release -- list --markdown > docs/src/guide/keys.md"
    );
}

#[test]
fn frequencies_need_neither_a_motion_nor_a_duration() {
    let folder = folder();
    let case = "beam = { length = \"1 m\" }\nsection = { kind = \"rectangle\", modulus = \"70 GPa\", density = \"2700 kg/m^3\", \
                width = \"20 mm\", height = \"5 mm\" }\nmass = [{ on = \"tip\", mass = \"10 g\" }]\n";
    std::fs::write(folder.path().join("short.toml"), case).unwrap();
    for arguments in [
        &["modes", "short.toml", "--count", "3"][..],
        &["campbell", "short.toml", "--speeds", "0:10:3", "--modes", "2"],
        &["statics", "short.toml", "--set", "load=[{on='tip', force=[0, 1]}]"],
        &["check", "short.toml"],
    ] {
        printed(folder.path(), arguments);
    }
    let message = rejected(folder.path(), &["run", "short.toml"]);
    assert!(
        message.contains("run.duration: this key is missing") && message.contains("hub.motion"),
        "{message}"
    );
    let run =
        ["run", "short.toml", "--set", "run.duration=0", "--set", "hub.motion={kind='constant', speed=0}"];
    printed(folder.path(), &run);
}

#[test]
fn messages_say_what_to_write() {
    let folder = folder();
    let check = |set: &[&str]| flexion(folder.path(), &[&["check", "spin-up"], set].concat());
    for (set, says) in [
        (&["--set", "section.modulus=70 GP"][..], "did you mean `GPa`?"),
        (&["--set", "section.modulus=70", "GPa"], "--set 'section.modulus=30 GPa'"),
        (&["--set", "basis=RPIM"], "did you mean `radial`?"),
        (&["--set", "mass=[{on='top', mass=1}]"], "`tip`"),
    ] {
        let output = check(set);
        assert_eq!(output.status.code(), Some(1), "{set:?}");
        assert!(text(&output.stderr).contains(says), "{set:?}: {}", text(&output.stderr));
    }
    let named = check(&["--set", "basis=radial"]);
    assert_eq!(named.status.code(), Some(0), "{}", text(&named.stderr));
    let metres = "section={kind='rectangle', modulus='70 GPa', density=2.7, width=30, height=50}";
    for (set, says) in [
        ("section.modulus=70", "waves of stretch run at 0.15 m/s"),
        ("section.modulus=7e13", "waves of stretch run at 152752.52 m/s"),
        (metres, "the radius of gyration of the section is 14.434 m"),
    ] {
        let suspected = text(&check(&["--set", set]).stdout);
        assert!(suspected.contains(says) && suspected.contains("unit missing or wrong?"), "{suspected}");
    }
}
