//! `flexion deck`: what it writes is read again and vibrates as the beam of which it is.

#![allow(clippy::unwrap_used)] // in helpers of tests

mod program;

use program::{flexion, text};
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().to_path_buf()
}

/// Tapered, twisted by 40° and bent in its own plane.
const BENT: &str = r#"run = { duration = 0 }
[[beam]]
name = "arm"
length = 10
direction = [0.6, 0, 0.8]
up = [0, 1, 0]
twist = "40 deg"
root = "clamped"
shear = true
elements = ELEMENTS
curve = { kind = "arc", angle = "25 deg", towards = [0.8, 0, -0.6] }
section = { kind = "tapered-rectangle", modulus = "70 GPa", density = 2700, root-width = 0.4, tip-width = 0.2, root-height = 0.9, tip-height = 0.5, rotary-inertia = true }
damping = { stiffness = "1 ms" }
"#;

/// The six lowest frequencies [rad/s] of a case.
fn frequencies(folder: &Path, case: &str) -> Vec<f64> {
    let output = flexion(folder, &["modes", case, "--count", "6", "-o", "modes", "--force"]);
    assert_eq!(output.status.code(), Some(0), "{case}: {}", text(&output.stderr));
    let table = std::fs::read_to_string(folder.join("modes/modes.csv")).unwrap();
    table.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect()
}

/// Largest relative difference of the frequencies of a case from those of the deck that is written of it, and what was printed.
fn off(folder: &Path, case: &str, more: &[&str]) -> (f64, String) {
    let own = frequencies(folder, case);
    let output = flexion(folder, &[&["deck", case, "-o", "deck", "--force"], more].concat());
    let printed = text(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{case}: {}", text(&output.stderr));
    let table = &printed[printed.find("[[beam]]").unwrap()..];
    std::fs::write(folder.join("deck/case.toml"), format!("run = {{ duration = 0 }}\n{table}")).unwrap();
    let again = frequencies(folder, "deck");
    assert_eq!((own.len(), again.len()), (6, 6));
    let off = own.iter().zip(&again).map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max);
    (off, printed)
}

/// The deck of BeamDyn has a line that is a spline of z through its keypoints, and sections that are linear in z between stations: a deck of its own kind is
/// itself to the digits that are written; of any other the differences fall with the square of the element.
#[test]
fn a_deck_for_beamdyn_vibrates_as_its_beam() {
    let folder = tempfile::tempdir().unwrap();
    let blade = root().join("verification/space_blade");
    let set = format!("section = {{ kind = \"deck\", file = \"{}\", format = \"windio\" }}", {
        let file = root().join("verification/blades/IEA-15-240-RWT_windIO.yaml");
        file.canonicalize().unwrap().display().to_string()
    });
    let windio = format!(
        "run = {{ duration = 0 }}\n[[beam]]\nstart = [3.97, 0, 0]\nup = [0, 1, 0]\nroot = \"clamped\"\nshear = true\n{set}\n"
    );
    std::fs::write(folder.path().join("windio.toml"), windio).unwrap();
    let (own, printed) = off(folder.path(), blade.to_str().unwrap(), &["--format", "beamdyn"]);
    assert!(own < 1e-9, "{own:e}");
    assert!(!printed.contains("between stations") && !printed.contains("not written"), "{printed}");
    let (windio, _) = off(folder.path(), "windio.toml", &["--format", "beamdyn"]);
    assert!(windio < 1e-6, "{windio:e}");
    let mut bent = Vec::new();
    for elements in ["60", "480"] {
        std::fs::write(folder.path().join("bent.toml"), BENT.replace("ELEMENTS", elements)).unwrap();
        let (off, printed) = off(folder.path(), "bent.toml", &["--format", "beamdyn"]);
        assert!(printed.contains("more `elements`"), "{printed}");
        bent.push(off);
    }
    assert!(bent[1] < 1e-6 && bent[1] < bent[0] / 40.0, "{bent:?}");
    let blade = std::fs::read_to_string(folder.path().join("deck/beamdyn_blade.dat")).unwrap();
    assert!(blade.contains("\n 1   damp_type"), "{blade:.600}");
}

#[test]
fn a_deck_for_hawc2_vibrates_as_a_straight_beam() {
    let folder = tempfile::tempdir().unwrap();
    let of_bent = ["curve", "twist", "damping"];
    let straight = BENT.lines().filter(|line| of_bent.iter().all(|key| !line.starts_with(key)));
    let straight = straight.collect::<Vec<_>>().join("\n").replace("ELEMENTS", "480");
    std::fs::write(folder.path().join("straight.toml"), straight).unwrap();
    let (off, printed) = off(folder.path(), "straight.toml", &["--format", "hawc2"]);
    assert!(off < 1e-6, "{off:e}");
    assert!(!printed.contains("damping") && !printed.contains("c2_def"), "{printed}");
    std::fs::write(folder.path().join("bent.toml"), BENT.replace("ELEMENTS", "10")).unwrap();
    let output = flexion(folder.path(), &["deck", "bent.toml", "--format", "hawc2", "-o", "other"]);
    let printed = text(&output.stdout);
    assert!(printed.contains("`c2_def`") && printed.contains("damping, which HAWC2"), "{printed}");
}

#[test]
fn a_deck_is_refused_whole_and_replaced_only_by_force() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, case: &str| std::fs::write(folder.path().join(name), case).unwrap();
    let bent = BENT.replace("ELEMENTS", "4");
    write("bent.toml", &bent);
    let silent = "section = { kind = \"general\", mass-per-length = 5, axial-stiffness = 1e6, torsional-stiffness = 10, bending-stiffness = 20, \
                  bending-stiffness-across = 20, rotary-inertia = 0.1, rotary-inertia-across = 0.1 }";
    let without =
        |key: &str| bent.lines().filter(|line| !line.starts_with(key)).collect::<Vec<_>>().join("\n") + "\n";
    let plain = without("section").replace("shear = true\n", "");
    write("silent.toml", &(plain.replace("damping", &format!("{silent}\ndamping"))));
    write(
        "two.toml",
        &format!(
            "{bent}[[beam]]\nname = \"other\"\nlength = 1\nstart = [0, 5, 0]\nroot = \"clamped\"\nsection = {{ kind = \"circle\", modulus = 1e9, density = 1e3, radius = 0.01 }}\n"
        ),
    );
    write("back.toml", &bent.replace("25 deg", "200 deg").replace("elements = 4", "elements = 20"));
    for (case, more, says) in [
        ("silent.toml", &[][..], "does not say how stiff it is in shear"),
        ("two.toml", &[], "name one of `arm`, `other` by --beam"),
        ("two.toml", &["--beam", "third"], "it has `arm`, `other`"),
        ("back.toml", &[], "does not ascend"),
        ("missing.toml", &[], "missing.toml"),
    ] {
        let output =
            flexion(folder.path(), &[&["deck", case, "--format", "beamdyn", "-o", "out"], more].concat());
        assert_eq!(output.status.code(), Some(1), "{case}: {}", text(&output.stderr));
        assert!(text(&output.stderr).contains(says), "{case}: {}", text(&output.stderr));
        assert!(!folder.path().join("out").exists(), "{case}");
    }
    let named = ["deck", "two.toml", "--format", "beamdyn", "-o", "out", "--beam", "other"];
    assert_eq!(flexion(folder.path(), &named).status.code(), Some(0));
    let before = std::fs::read(folder.path().join("out/beamdyn_blade.dat")).unwrap();
    let second = flexion(folder.path(), &["deck", "bent.toml", "--format", "beamdyn", "-o", "out"]);
    assert_eq!(second.status.code(), Some(1));
    assert!(text(&second.stderr).contains("--force"), "{}", text(&second.stderr));
    assert_eq!(std::fs::read(folder.path().join("out/beamdyn_blade.dat")).unwrap(), before);
    let forced =
        flexion(folder.path(), &["deck", "bent.toml", "--format", "beamdyn", "-o", "out", "--force"]);
    assert_eq!(forced.status.code(), Some(0), "{}", text(&forced.stderr));
    assert!(std::fs::read(folder.path().join("out/beamdyn_blade.dat")).unwrap() != before);
}

#[cfg(unix)]
#[test]
fn a_deck_that_cannot_be_written_ends_with_2_and_leaves_the_former_one() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bent.toml"), BENT.replace("ELEMENTS", "20")).unwrap();
    let deck = "deck bent.toml --format beamdyn --force -o";
    let run = |limit: &str, output: &str| {
        std::process::Command::new("sh")
            .args(["-c", &format!("trap '' XFSZ; {limit} exec \"$1\" {deck} {output}"), "sh"])
            .arg(env!("CARGO_BIN_EXE_flexion"))
            .current_dir(folder.path())
            .output()
            .unwrap()
    };
    assert_eq!(run("", "out").status.code(), Some(0));
    let read = || {
        ["primary", "blade"]
            .map(|name| std::fs::read(folder.path().join(format!("out/beamdyn_{name}.dat"))).unwrap())
    };
    let before = read();
    for output in ["out", "fresh"] {
        // 8 kB at most in any file.
        let limited = run("ulimit -f 16;", output);
        let message = text(&limited.stderr);
        assert_eq!(limited.status.code(), Some(2), "{message}");
        assert!(message.contains("cannot write"), "{message}");
    }
    assert!(read() == before && !folder.path().join("fresh").exists());
}

/// Twists, prebend and edge of the deck of the IEA 15 MW turbine, by its keypoints, as they are drawn.
#[test]
fn the_blade_that_is_drawn_is_that_of_its_deck() {
    let reading = flexion_case::read(&root().join("verification/space_blade"), &[]).unwrap();
    let blades = reading.case.space().unwrap().blades();
    let [blade] = &blades[..] else { panic!("{blades:?}") };
    let file = root().join("verification/blades/IEA-15-240-RWT_BeamDyn.dat");
    let text = String::from_utf8_lossy(&std::fs::read(file).unwrap()).into_owned();
    let numbers =
        |line: &str| -> Vec<f64> { line.split_whitespace().map_while(|word| word.parse().ok()).collect() };
    let keypoints: Vec<Vec<f64>> = text.lines().map(numbers).filter(|row| row.len() == 4).collect();
    let last = keypoints.last().unwrap();
    for (section, twist, row) in [
        (blade.sections.first().unwrap(), blade.twist.first().unwrap(), &keypoints[0]),
        (blade.sections.last().unwrap(), blade.twist.last().unwrap(), last),
    ] {
        assert!((twist.to_degrees() - row[3]).abs() < 1e-9, "{twist} {row:?}");
        // x of the deck is −Z, y is Y, z is X, from the radius of the hub.
        let place = section.position;
        let of = [-place[2], place[1], place[0] - 3.97];
        assert!(of.iter().zip(row).all(|(a, b)| (a - b).abs() < 1e-9), "{of:?} {row:?}");
        // A twist about −z turns y, to the trailing edge, towards x.
        let height = section.rotation.column(1);
        assert!((height[1] - row[3].to_radians().cos()).abs() < 3e-3, "{height:?}");
        assert!((-height[2] - row[3].to_radians().sin()).abs() < 3e-3, "{height:?}");
    }
    assert!(blade.is_deck && keypoints[0][3] > 15.0 && last[0] < -3.9, "{keypoints:?}");
}

/// The copy of a primary file among the results names the copy of its blade file: the resolved case runs by itself, with the same results, and goes on
/// from the state of the run.
#[test]
fn the_resolved_case_of_a_blade_of_beamdyn_runs_by_itself() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("verification/space_blade");
    let case = case.to_str().unwrap();
    for coupling in ["", "[beam]\nlength = 1"] {
        assert_eq!(coupling.is_empty(), coupling != "[beam]\nlength = 1");
    }
    let run = |arguments: &[&str]| {
        let output = flexion(folder.path(), &[&["run"], arguments].concat());
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {}", text(&output.stderr));
    };
    let motion = ["--set", "run.duration=0.01", "--set", "output.step=0.01", "--error", "off", "--no-plots"];
    run(&[&[case, "-o", "first"], &motion[..]].concat());
    std::fs::create_dir(folder.path().join("alone")).unwrap();
    for name in ["case.resolved.toml", "table1.csv", "table2.csv"] {
        std::fs::copy(folder.path().join("first").join(name), folder.path().join("alone").join(name))
            .unwrap();
    }
    run(&["alone/case.resolved.toml", "-o", "second", "--error", "off", "--no-plots"]);
    let read = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(read("first/trajectory.csv") == read("second/trajectory.csv"));
    assert!(
        read("first/table1.csv") == read("second/table1.csv")
            && read("first/table2.csv") == read("second/table2.csv")
    );
    let on = ["--set", "initial={kind='restart', file='../first'}", "--set", "run.duration=0.02"];
    run(&[&["alone/case.resolved.toml", "-o", "third", "--error", "off", "--no-plots"], &on[..]].concat());
}
