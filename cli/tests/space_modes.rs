//! `flexion modes` and `flexion campbell` of a rotor in space: what they print and write.

#![allow(clippy::unwrap_used)] // in helpers of tests

mod program;

use program::{flexion, folder, text};

const ROTOR: &str = r#"run = { duration = 0 }
gravity = [0, 0, -9.81]
[[body]]
name = "hub"
mass = 3
inertia = { kind = "sphere", radius = 0.1 }
[[beam]]
name = "blade"
length = 2
elements = 4
up = [0, 0, 1]
section = { kind = "rectangle", modulus = "70 GPa", density = 2700, width = "4 cm", height = "1 cm" }
[[joint]]
name = "shaft"
kind = "revolute"
between = ["ground", "hub"]
motion = { kind = "constant", speed = "30 rpm" }
[[joint]]
kind = "fixed"
between = ["hub", "blade.root"]
"#;

#[test]
fn a_rotor_has_modes_and_a_diagram_with_their_errors() {
    let folder = folder();
    std::fs::write(folder.path().join("rotor.toml"), ROTOR).unwrap();
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    let output =
        flexion(folder.path(), &["modes", "rotor.toml", "--speed", "40 rpm", "-o", "modes", "--vtk"]);
    let (out, said) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(out.contains("at 40.000000 rpm about the axis (0.0000, 0.0000, 1.0000)"), "{out}");
    assert!(out.contains("`shaft` keeps its angle") && out.contains("flap 100 %"), "{out}");
    let json = read("modes/modes.json");
    let speed = "\"speed\": 40.0";
    assert!(json.contains("\"speed-unit\": \"rpm\"") && json.contains("\"unit\": \"Hz\""), "{json}");
    assert!(
        (json.contains(speed) || json.contains("39.99999")) && json.contains("\"mesh-error\": "),
        "{json}"
    );
    // Ten modes at 24 phases.
    let series = read("modes/modes.pvd");
    assert_eq!(series.matches("<DataSet").count(), 240, "{series}");
    assert!(read("modes/vtk/frame_00239.vtu").contains("Points"));
    // The shapes are those of the blade, though a body stands before it.
    assert!(read("modes/modes.svg").contains("along the height"));
    let speeds = ["campbell", "rotor.toml", "--speeds", "0 rpm:120 rpm:5", "--modes", "3", "-o", "diagram"];
    let output = flexion(folder.path(), &speeds);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("± mesh"), "{}", text(&output.stdout));
    let table = read("diagram/campbell.csv");
    let head: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let at = head.iter().position(|name| *name == "mode1-flap.mesh-error [Hz]").unwrap();
    for row in table.lines().skip(1) {
        let error: f64 = row.split(',').nth(at).unwrap().parse().unwrap();
        assert!(error > 0.0 && error < 0.1, "{row}");
    }
}

/// The shaft lets its prescribed motion go: a rotation without stiffness, and higher frequencies than with the angle kept.
#[test]
fn a_shaft_that_is_let_go_rotates_with_the_blade() {
    let folder = folder();
    std::fs::write(folder.path().join("rotor.toml"), ROTOR).unwrap();
    for at in [&["--speed", "40 rpm"][..], &[]] {
        let frequencies = |more: &[&str]| {
            let arguments = [&["modes", "rotor.toml", "--unit", "Hz", "--count", "4"], at, more].concat();
            let output = flexion(folder.path(), &arguments);
            let out = text(&output.stdout);
            assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
            let row = |line: &str| line.split_whitespace().nth(1)?.parse().ok();
            (out.lines().filter_map(row).collect::<Vec<f64>>(), out)
        };
        let ((kept, _), (free, out)) = (frequencies(&[]), frequencies(&["--free-hub"]));
        assert!(out.contains(if at.is_empty() { "free hub" } else { "`shaft` is free" }), "{out}");
        // The lowest across the plane stays, but for its sag; the lowest in the plane is the rotation now, and the next far higher.
        assert_eq!((kept.len(), free.len(), free[0]), (4, 4, 0.0), "{kept:?} {free:?}");
        assert!((free[1] / kept[0] - 1.0).abs() < 1e-3, "{kept:?} {free:?}");
        assert!(kept[1] < 9.0 && free[2] > 10.0, "{kept:?} {free:?}");
    }
    let speeds = ["campbell", "rotor.toml", "--speeds", "0 rpm:120 rpm:3", "--modes", "3", "--free-hub"];
    let output = flexion(folder.path(), &speeds);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let at_rest = ROTOR.replace("speed = \"30 rpm\"", "speed = 0");
    let turntable = format!("{at_rest}[rotation]\naxis = [0, 0, 1]\npoint = [1, 0, 0]\n");
    std::fs::write(folder.path().join("turntable.toml"), turntable).unwrap();
    let output = flexion(folder.path(), &["modes", "turntable.toml", "--speed", "3", "--free-hub"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("--free-hub needs a revolute"), "{}", text(&output.stderr));
}

#[test]
fn a_case_without_an_axis_says_what_to_write() {
    let folder = folder();
    let clamped = "run = { duration = 0 }\n[[beam]]\nlength = 1\nroot = \"clamped\"\nsection = { kind = \"circle\", modulus = 7e10, \
                   density = 2700, radius = 0.01 }\n";
    std::fs::write(folder.path().join("clamped.toml"), clamped).unwrap();
    for command in
        [&["modes", "clamped.toml", "--speed", "3"][..], &["campbell", "clamped.toml", "--speeds", "0:3"]]
    {
        let output = flexion(folder.path(), command);
        assert_eq!(output.status.code(), Some(1), "{command:?}");
        assert!(
            text(&output.stderr).contains("`rotation = { axis = [0, 0, 1] }`"),
            "{}",
            text(&output.stderr)
        );
    }
    let axis = ["modes", "clamped.toml", "--speed", "3", "--set", "rotation={axis=[0, 0, 1]}"];
    assert_eq!(flexion(folder.path(), &axis).status.code(), Some(0));
}

/// A column of EI = 1 N·m² and 2 N·m² beyond the first of its loads π²EI/4L²: bent it has modes without growth, straight it has one.
#[test]
fn a_buckled_column_has_the_modes_of_the_equilibrium_in_which_its_run_begins() {
    let folder = folder();
    let column = |initial: &str| {
        format!(
            "run = {{ duration = 0 }}\n{initial}\n[[beam]]\nlength = 1\nup = [0, 0, 1]\nroot = \"clamped\"\nelements = 8\n\
             section = {{ kind = \"general\", mass-per-length = 1, axial-stiffness = 1e6, torsional-stiffness = 1, bending-stiffness = 1, \
             bending-stiffness-across = 2, rotary-inertia = 1e-5, rotary-inertia-across = 1e-5 }}\n\
             [[load]]\non = \"beam.tip\"\nforce = [-3, 0, 0.001]\n"
        )
    };
    for (initial, words, unstable) in [
        ("", "the equilibrium is unstable", true),
        ("initial = { kind = \"static\" }", "the first stable one on the path", false),
    ] {
        std::fs::write(folder.path().join("column.toml"), column(initial)).unwrap();
        let output =
            flexion(folder.path(), &["modes", "column.toml", "--count", "4", "-o", "modes", "--force"]);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
        assert!(said.contains(words), "{said}");
        assert_eq!(said.contains("modes grow"), unstable, "{said}");
    }
}
