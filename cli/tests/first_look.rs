//! Answers of the program that were once wrong and called success.

#![allow(clippy::unwrap_used)] // in helpers of tests

use std::path::Path;
use std::process::{Command, Output};

const BLADE: &str = r#"
[beam]
length = 1.0
torsion = false
[section]
kind = "general"
mass-per-length = 1.0
axial-stiffness = 4900.0
torsional-stiffness = 1.0
bending-stiffness = 1.0
bending-stiffness-across = 1.0
[hub]
motion = { kind = "constant", speed = 1.0 }
[model]
coupling = "space"
[run]
duration = "0.1 s"
"#;

fn flexion(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let program = env!("CARGO_BIN_EXE_flexion");
    let Output { status, stdout, stderr } =
        Command::new(program).args(arguments).current_dir(folder).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (status.code(), text(stdout), text(stderr))
}

fn folder(case: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("case.toml"), case).unwrap();
    folder
}

#[test]
fn a_blade_carries_its_masses_and_what_its_modes_leave_out_is_named() {
    // As heavy as the blade, at its tip: 1 + cos z cosh z + z (cos z sinh z − sin z cosh z) = 0, z² = 1.5573.
    let heavy = folder(&format!("{BLADE}[[mass]]\non = '1 m'\nmass = 1.0\n"));
    let (code, said, warned) = flexion(heavy.path(), &["modes", "case.toml", "--count", "2", "--speed", "0"]);
    assert!(code == Some(0) && said.contains("1.557") && warned.is_empty(), "{said} {warned}");
    let fallen = folder(&format!("gravity = [0, -9.81]\n{BLADE}"));
    let (code, out, said) = flexion(fallen.path(), &["modes", "case.toml", "--count", "2", "--speed", "1"]);
    assert!(code == Some(0) && (out + &said).contains("gravity"), "{said}");
}

#[test]
fn a_blade_in_the_plane_and_what_its_file_leaves_out_are_named() {
    let from = BLADE.find("torsion = false").unwrap();
    let to = BLADE.find("[hub]").unwrap();
    let section = "[section]\nkind = \"deck\"\nfile = \"blade.csv\"\nformat = \"csv\"\n";
    let folder = folder(&format!("{}{section}{}", &BLADE[..from], &BLADE[to..]));
    let rows = |twist: &str| {
        format!("x,mass,EA,EI-flap,EI-chord,GJ,twist\n0,1,1e6,1,4,0.3,{twist}\n1,1,1e6,1,4,0.3,0\n")
    };
    std::fs::write(folder.path().join("blade.csv"), rows("0.1")).unwrap();
    let planar = ["modes", "case.toml", "--count", "2", "--set", "model.coupling=first"];
    let (code, _, said) = flexion(folder.path(), &planar);
    assert!(code == Some(0) && said.contains("`model.coupling = \"space\"` for all of them"), "{said}");
    let (code, _, said) = flexion(folder.path(), &["modes", "case.toml", "--count", "2"]);
    assert!(code == Some(0) && said.contains("no rotary inertia about the axis"), "{said}");
    std::fs::write(folder.path().join("blade.csv"), rows("13.3")).unwrap();
    let (code, _, said) = flexion(folder.path(), &["modes", "case.toml", "--count", "2"]);
    assert!(code == Some(1) && said.contains("for degrees name the column `twist [deg]`"), "{said}");
}

const VEERING: &str = r#"
[beam]
length = 1.0
torsion = false
twist = "30 deg"
[section]
kind = "rectangle"
modulus = 6e8
density = 5000.0
width = 0.01
height = 0.02
[hub]
motion = { kind = "constant", speed = 1.0 }
[model]
coupling = "space"
[basis]
elements = 16
[run]
duration = "0.1 s"
"#;

#[test]
fn a_wide_veering_is_one_whatever_the_speeds() {
    let folder = folder(VEERING);
    let last = |count: &str| {
        let speeds = format!("0:40:{count}");
        let arguments = ["campbell", "case.toml", "--speeds", &speeds, "--modes", "4", "-o", count];
        let (code, out, said) = flexion(folder.path(), &arguments);
        assert_eq!(code, Some(0), "{said}");
        let table = out.lines().skip_while(|line| !line.contains("moves at first")).skip(1).take(4);
        table.map(|line| line.split_whitespace().nth(3).unwrap().to_owned()).collect::<Vec<_>>()
    };
    let coarse = last("6");
    for count in ["11", "41", "101"] {
        for (a, b) in coarse.iter().zip(&last(count)) {
            let (a, b): (f64, f64) = (a.parse().unwrap(), b.parse().unwrap());
            assert!((a - b).abs() < 1e-4 * a, "{count} speeds: {a} and {b}");
        }
    }
}

#[test]
fn a_range_of_speeds_has_one_unit_and_a_crossing_that_few_speeds_miss_is_shown() {
    let folder = folder(VEERING);
    let table = |speeds: &str| {
        let arguments = ["campbell", "case.toml", "--speeds", speeds, "--modes", "2", "-o", "out", "--force"];
        let (code, out, said) = flexion(folder.path(), &arguments);
        assert_eq!(code, Some(0), "{said}");
        out
    };
    assert_eq!(table("0 rpm:40:3"), table("0:40 rpm:3"));
    let rows = table("0 rpm:400:3");
    let crossings: Vec<&str> =
        rows.lines().filter(|line| line.contains("Ω ") && line.contains("rpm")).collect();
    assert!(!crossings.is_empty() && rows.contains("crossing"), "{rows}");
}

#[test]
fn statics_without_a_load_are_refused() {
    let folder = folder(RUN);
    let (code, _, said) = flexion(folder.path(), &["statics", "case.toml"]);
    assert!(code == Some(1) && said.starts_with("error: hub:"), "{said}");
    let still = ["statics", "case.toml", "--set", "hub.motion.speed=0"];
    let (code, _, said) = flexion(folder.path(), &still);
    assert!(code == Some(1) && said.contains("no load moves the system"), "{said}");
}

#[test]
fn a_mesh_that_is_too_coarse_for_a_frequency_is_named() {
    let straight = VEERING.replace("twist = \"30 deg\"\n", "");
    let folder = folder(&straight);
    let (_, out, said) = flexion(
        folder.path(),
        &["modes", "case.toml", "--speed", "100", "--count", "3", "--set", "basis.elements=3"],
    );
    assert!(out.contains("± mesh") && said.contains("by the mesh the frequency"), "{out}{said}");
    let (_, _, said) = flexion(folder.path(), &["modes", "case.toml", "--count", "3"]);
    assert_eq!(said, "");
}

const RUN: &str = r#"
[beam]
length = 2
[section]
kind = "uniform"
modulus = "70 GPa"
density = 3000
area = "4 cm^2"
second-moment = "2e-7 m^4"
[hub]
motion = { kind = "constant", speed = 1 }
[run]
duration = 1
"#;

#[test]
fn requests_beyond_reason_are_refused_with_the_reason() {
    let folder = folder(RUN);
    let many = "[[mass]]\non = '1 m'\nmass = 0.001\n".repeat(10_000);
    std::fs::write(folder.path().join("many.toml"), format!("{RUN}{many}")).unwrap();
    for (arguments, expected) in [
        (
            &[
                "run",
                "case.toml",
                "--set",
                "output.step=1.2e-7",
                "--set",
                "output.stations=['0.1 m', '0.2 m', '0.3 m', '0.4 m', '0.5 m', '0.6 m', '0.7 m', '0.8 m', '0.9 m', '1 m', '1.1 m', '1.2 m']",
            ][..],
            "GB",
        ),
        (&["check", "case.toml", "--set", "basis.elements=1000000"], "GB"),
        (&["campbell", "case.toml", "--speeds", "0:1:2", "--revolutions", "1000000000"], "1000"),
        (&["run", "case.toml", "--set", "integrator={kind='radau',max-step=1e-300}"], "integrator.max-step"),
        (&["run", "case.toml", "--until", "nan"], "nan"),
        (&["run", "case.toml", "--set", "section={kind='table',file='/dev/zero'}"], "regular file"),
    ] {
        let (code, _, said) = flexion(folder.path(), arguments);
        assert!(matches!(code, Some(1 | 2)) && said.contains(expected), "{arguments:?}: {code:?} {said}");
    }
    let (code, _, said) = flexion(folder.path(), &["check", "many.toml"]);
    assert_eq!(code, Some(0), "{said}");
}

#[test]
fn runs_with_values_that_are_no_numbers_do_not_compare() {
    let folder = folder(RUN);
    let csv = |y: &str| format!("time [s],tip.deflection [m]\n0,0\n1,{y}\n2,1\n");
    std::fs::write(folder.path().join("a.csv"), csv("1")).unwrap();
    std::fs::write(folder.path().join("b.csv"), csv("NaN")).unwrap();
    let (code, _, said) = flexion(folder.path(), &["compare", "a.csv", "b.csv"]);
    assert!(code == Some(2) && said.contains("not a finite number"), "{code:?} {said}");
}
