//! Full disks, killed runs, wrong files: nothing is lost or half-written, and the message says what to do.

#![allow(clippy::unwrap_used)] // in helpers of tests

mod program;

use program::{SPIN_UP, flexion, text};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// What follows the beam.
const REST: &str = r#"[basis]
kind = "finite-elements"
elements = 10
[run]
duration = "20 s"
[output]
step = "10 ms"
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("case.toml"), [SPIN_UP, REST].concat()).unwrap();
    folder
}

/// Exit code and message of a command that is refused quickly, without a panic.
fn refused(folder: &Path, arguments: &[&str]) -> String {
    let begun = Instant::now();
    let output = flexion(folder, arguments);
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
    assert!(!message.contains("panicked") && message.len() < 20_000, "{arguments:?}: {message}");
    assert!(begun.elapsed() < Duration::from_secs(60), "{arguments:?} took {:?}", begun.elapsed());
    message
}

/// The visible files of a folder and what is in them.
fn content(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file())
        .map(|path| (path.clone(), std::fs::read(&path).unwrap()))
        .collect();
    files.sort();
    files
}

#[test]
fn enormous_numbers_and_files_are_refused_with_their_place() {
    let folder = folder();
    let file = std::fs::File::create(folder.path().join("gigabyte.toml")).unwrap();
    file.set_len(1 << 30).unwrap();
    let message = refused(folder.path(), &["run", "gigabyte.toml"]);
    assert!(message.contains("larger than 10 MB") && message.contains("a few kB"), "{message}");
    // Close to the largest file that is read.
    let digits = "9".repeat(9_000_000);
    for (name, number, expected) in [
        ("integer.toml", digits.clone(), "beam.length"),
        ("text.toml", format!("\"{digits} m\""), "too large"),
        ("unit.toml", format!("\"1 {}\"", "m".repeat(9_000_000)), "unit"),
        ("exponent.toml", format!("1e{digits}"), "finite"),
        ("key.toml", format!("1\n{} = 2", "m".repeat(9_000_000)), "unknown key"),
        ("brackets.toml", "[".repeat(9_000_000), "TOML"),
    ] {
        let case = [SPIN_UP, REST].concat().replace("length = \"10 m\"", &format!("length = {number}"));
        std::fs::write(folder.path().join(name), case).unwrap();
        let message = refused(folder.path(), &["check", name]);
        assert!(message.contains(expected), "{name}: {message}");
    }
    // Whatever a run would need more memory for than there is.
    for (set, expected) in [
        ("output.step=1e-12", "records"),
        ("integrator={kind='newmark',step=1e-30}", "steps"),
        ("basis={kind='bezier',degree=20,elements=1000000}", "entries"),
        ("basis={kind='b-spline',degree=15,elements=1000000}", "entries"),
        (
            "basis={kind='mixed',axial={kind='modes',count=100},transverse={kind='finite-elements',elements=1000000}}",
            "entries",
        ),
        ("basis.elements=1000000000000", "from 1 to"),
    ] {
        let message = refused(folder.path(), &["check", "case.toml", "--set", set]);
        assert!(message.contains(expected), "{set}: {message}");
    }
}

#[test]
fn a_tolerance_below_the_rounding_of_the_values_is_refused() {
    let message = refused(folder().path(), &["run", "case.toml", "--no-plots", "--tolerance", "1e-300"]);
    assert!(message.contains("1e-300") && message.contains("the last digit"), "{message}");
}

#[test]
fn a_path_without_a_case_is_refused() {
    let folder = folder();
    std::fs::create_dir_all(folder.path().join("empty")).unwrap();
    std::fs::create_dir_all(folder.path().join("nested/case.toml")).unwrap();
    std::fs::write(folder.path().join("picture.toml"), b"\x89PNG\r\n\x1a\n\0\0").unwrap();
    for (case, expected) in [
        ("empty", "the folder empty holds no case.toml"),
        ("nested", "not a file but a folder"),
        ("nested/case.toml", "holds no case.toml"),
        ("missing.toml", "a folder that holds a case.toml"),
        ("picture.toml", "not UTF-8"),
    ] {
        let message = refused(folder.path(), &["run", case]);
        assert!(message.contains(expected), "{case}: {message}");
    }
    assert!(!folder.path().join("results").exists());
}

#[test]
fn an_output_that_cannot_be_is_refused_before_anything_is_computed() {
    let folder = folder();
    std::fs::write(folder.path().join("taken"), "mine").unwrap();
    // Too long to be computed: the refusal must come before.
    let run = |output: &str| {
        let set = "integrator={kind='newmark',step='0.1 us'}";
        refused(folder.path(), &["run", "case.toml", "--force", "--set", set, "--output", output])
    };
    assert!(run("taken").contains("choose another output directory"));
    assert!(run("taken/below").contains("part of the path is a file"));
    let name = "x".repeat(300);
    assert!(run(&name).contains("choose a shorter"), "{}", run(&name));
    assert_eq!(std::fs::read_to_string(folder.path().join("taken")).unwrap(), "mine");
    // Parents that are missing are made.
    let output = flexion(folder.path(), &["run", "case.toml", "--output", "some/where/new"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(folder.path().join("some/where/new/summary.json").is_file());
    let output = flexion(folder.path(), &["plot", "some/where/new", "--output", "other/place/a.svg"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for (output, expected) in [("taken/a.svg", "part of the path is a file"), ("some", "svg")] {
        let message = refused(folder.path(), &["plot", "some/where/new", "--force", "--output", output]);
        assert!(message.contains(expected), "{output}: {message}");
    }
}

#[cfg(unix)]
#[test]
fn a_read_only_directory_is_refused_before_anything_is_computed() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let locked = folder.path().join("locked");
    std::fs::create_dir(&locked).unwrap();
    let permit = |mode| std::fs::set_permissions(&locked, std::fs::Permissions::from_mode(mode)).unwrap();
    permit(0o555);
    if std::fs::write(locked.join("probe"), "").is_ok() {
        println!("left out: permissions do not bind this user");
    } else {
        for output in ["locked", "locked/below"] {
            let message = refused(folder.path(), &["run", "case.toml", "--output", output]);
            assert!(message.contains("locked") && message.contains("may write"), "{message}");
        }
    }
    permit(0o755);
    // No user can make files there.
    if cfg!(target_os = "linux") {
        let message = refused(folder.path(), &["run", "case.toml", "--output", "/proc/flexion"]);
        assert!(message.contains("/proc/flexion") && message.contains("check the path"), "{message}");
    }
}

/// Runs a script by `sh` with the program as `$1`.
#[cfg(unix)]
fn shell(folder: &Path, script: &str) -> Output {
    Command::new("sh")
        .args(["-c", script, "sh", env!("CARGO_BIN_EXE_flexion")])
        .current_dir(folder)
        .output()
        .unwrap()
}

#[cfg(unix)]
/// Files with names of results that no run wrote, and those that a case reads, in the folder of the results.
#[test]
fn force_touches_neither_foreign_files_nor_what_the_case_reads() {
    let folder = tempfile::tempdir().unwrap();
    let case = [SPIN_UP, REST].concat().replace(
        r#"{ kind = "spin-up", speed = "4 rad/s", time = "15 s" }"#,
        r#"{ kind = "table", of = "speed", file = "turning.csv" }"#,
    );
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("case.toml", &case);
    write("turning.csv", "t,value\n0,0\n40,1\n");
    let run = ["run", "case.toml", "-o", ".", "--force", "--no-plots", "--error", "off"];
    for (name, of_result) in
        [("plot.svg", true), ("beam.pvd", true), ("table99.csv", true), ("modes.csv", false)]
    {
        write(name, "mine");
        if of_result {
            let before = content(folder.path());
            let message = refused(folder.path(), &run);
            assert!(message.contains(name) && message.contains("move it away"), "{message}");
            assert_eq!(content(folder.path()), before);
            std::fs::remove_file(folder.path().join(name)).unwrap();
        }
    }
    for _ in 0..2 {
        let output = flexion(folder.path(), &run);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    }
    assert_eq!(std::fs::read_to_string(folder.path().join("modes.csv")).unwrap(), "mine");
    assert_eq!(std::fs::read_to_string(folder.path().join("case.toml")).unwrap(), case);
    // The same motion by the copy that the run wrote, and the run in its own folder from its own case or state.
    let of = |arguments: &[&str]| refused(folder.path(), &[&run[..1], arguments, &run[2..]].concat());
    for (arguments, name) in [
        (&["case.toml", "--set", "hub.motion.file=motion.csv"][..], "motion.csv"),
        (&["case.resolved.toml"], "case.resolved.toml"),
        (
            &["case.toml", "--set", "run.duration=30", "--set", "initial={kind='restart',file='.'}"],
            "state.npz",
        ),
    ] {
        let before = content(folder.path());
        let message = of(arguments);
        assert!(message.contains(name) && message.contains("is read by the case"), "{message}");
        assert_eq!(content(folder.path()), before);
    }
}

#[test]
fn files_that_may_not_grow_end_with_2_and_the_former_results_stay() {
    let folder = folder();
    assert_eq!(flexion(folder.path(), &["run", "case.toml", "-o", "out"]).status.code(), Some(0));
    let before = content(&folder.path().join("out"));
    // 64 kB at most in any file, where the trajectory takes more.
    let limited = |output: &str| {
        shell(
            folder.path(),
            &format!("trap '' XFSZ; ulimit -f 128; exec \"$1\" run case.toml -o {output} --force"),
        )
    };
    for output in ["out", "fresh"] {
        let run = limited(output);
        let message = text(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{message}");
        assert!(message.contains("trajectory") && message.contains("record less often"), "{message}");
    }
    assert!(content(&folder.path().join("out")) == before);
    assert!(!folder.path().join("fresh").exists());
    // 8 kB at most: what was computed is printed at least.
    for command in ["modes case.toml --speed 1", "campbell case.toml --speeds 0:4:3", "compare out out"] {
        let run =
            shell(folder.path(), &format!("trap '' XFSZ; ulimit -f 16; exec \"$1\" {command} -o fresh"));
        let message = text(&run.stderr);
        assert_eq!(run.status.code(), Some(2), "{command}: {message}");
        assert!(message.contains("cannot write") && !run.stdout.is_empty(), "{command}: {message}");
        assert!(!folder.path().join("fresh").exists(), "{command}");
    }
    assert_eq!(flexion(folder.path(), &["run", "case.toml", "-o", "out", "--force"]).status.code(), Some(0));
    let names = |files: &[(PathBuf, Vec<u8>)]| files.iter().map(|file| file.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(&content(&folder.path().join("out"))), names(&before));
}

#[cfg(target_os = "linux")]
#[test]
fn on_a_full_or_read_only_disk_the_former_results_stay() {
    let folder = folder();
    // A disk that holds two sets of small results and not a large one, in a name space of its own.
    let script = r#"
        mkdir disk && mount -t tmpfs -o size=4m tmpfs disk 2>/dev/null || { echo "cannot mount"; exit 77; }
        set='output.step=20 ms'
        "$1" run case.toml -o disk/out --set "$set" >/dev/null || exit 70
        cp -r disk/out before
        "$1" run case.toml -o disk/out --force --set 'output.step=1 ms' 2>message; code=$?
        diff -r disk/out before >&2 || exit 71
        ls -A disk/out | grep '^\.' | grep -v -x .flexion-files >&2 && exit 72
        "$1" run case.toml -o disk/out --force --set "$set" >/dev/null || exit 73
        mount -o remount,ro disk || exit $code
        "$1" run case.toml -o disk/out --force 2>>message; [ $? = 1 ] || exit 74
        exit $code
    "#;
    let spaces = ["unshare", "--user", "--map-root-user", "--mount", "sh", "-c", script, "sh"];
    let output = Command::new(spaces[0])
        .args(&spaces[1..])
        .arg(env!("CARGO_BIN_EXE_flexion"))
        .current_dir(folder.path())
        .output();
    let Ok(output) = output else {
        println!("left out: there is no `unshare`");
        return;
    };
    let message = std::fs::read_to_string(folder.path().join("message")).unwrap_or_default();
    if message.is_empty() && !matches!(output.status.code(), Some(70..=74)) {
        println!("left out: no file system can be mounted here: {}", text(&output.stderr));
        return;
    }
    assert_eq!(output.status.code(), Some(2), "{message}{}", text(&output.stderr));
    assert!(message.contains("disk/out") && message.contains("make room"), "{message}");
    assert!(message.contains("this file system is read-only"), "{message}");
}

#[cfg(target_os = "linux")]
#[test]
fn an_output_that_cannot_be_printed_is_an_error() {
    let folder = folder();
    for arguments in ["list", "schema", "new spin-up", "check case.toml", "man", "completions bash"] {
        let output = shell(folder.path(), &format!("exec \"$1\" {arguments} >/dev/full"));
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {message}");
        assert!(
            message.contains("standard output") && message.contains("make room"),
            "{arguments}: {message}"
        );
    }
    // A closed pipe is no error.
    let output = shell(folder.path(), "\"$1\" schema | head -n 1; \"$1\" list | head -n 1");
    assert!(output.status.success() && output.stderr.is_empty(), "{}", text(&output.stderr));
}

#[cfg(unix)]
#[test]
fn a_run_killed_at_any_moment_leaves_the_former_or_the_new_results() {
    let folder = folder();
    let out = folder.path().join("out");
    let run = |seconds: u32| {
        let step = format!("output.step={} ms", 10 * seconds);
        let mut command = Command::new(env!("CARGO_BIN_EXE_flexion"));
        command.args(["run", "case.toml", "-o", "out", "--force", "--set", &step]);
        command.current_dir(folder.path()).stdout(Stdio::null()).stderr(Stdio::null());
        command
    };
    // Results of either kind, as they should be; timings differ from run to run.
    let steady = |files: Vec<(PathBuf, Vec<u8>)>| -> Vec<(PathBuf, Vec<u8>)> {
        // The list has the hash of the summary.
        let timed = ["summary.json", ".flexion-files"];
        files.into_iter().filter(|(path, _)| !timed.iter().any(|name| path.ends_with(name))).collect()
    };
    let begun = Instant::now();
    assert!(run(2).status().unwrap().success());
    let whole = begun.elapsed();
    let second = steady(content(&out));
    assert!(run(1).status().unwrap().success());
    let first = steady(content(&out));
    let kills: u32 = 24;
    let mut replaced = 0;
    for k in 0..kills {
        let mut killed = run(2).spawn().unwrap();
        std::thread::sleep(whole * (k + 1) / kills);
        killed.kill().unwrap();
        killed.wait().unwrap();
        // Where a summary is, the results are whole: the former, or the new. Where files were just being moved,
        // every command finishes that first.
        if out.join("summary.json").exists() {
            let found = steady(content(&out));
            assert!(found == first || found == second, "killed after {k} of {kills} parts of a run");
            replaced += u32::from(found == second);
        }
        let compared = flexion(folder.path(), &["compare", "out", "out", "--tolerance", "0"]);
        assert_eq!(compared.status.code(), Some(0), "{k}: {}", text(&compared.stderr));
        assert!(run(1).status().unwrap().success(), "the run after one that was killed");
        assert!(steady(content(&out)) == first, "{k}");
    }
    println!("{replaced} of {kills} runs had replaced the results when they were killed");
}

/// Two bars on hinges.
const IN_SPACE: &str = r#"run = { duration = "1 s" }
gravity = [0, 0, -9.81]
[[body]]
name = "upper"
mass = 1
position = [0.5, 0, 0]
inertia = { kind = "sphere", radius = 0.1 }
[[body]]
name = "lower"
mass = 1
position = [1.5, 0, 0]
inertia = { kind = "sphere", radius = 0.1 }
[[joint]]
kind = "revolute"
between = ["ground", "upper"]
at = [0, 0, 0]
axis = [0, 1, 0]
[[joint]]
kind = "revolute"
between = ["upper", "lower"]
at = [1, 0, 0]
axis = [0, 1, 0]
"#;

const ROD: &str = "section = { kind = \"circle\", modulus = \"70 GPa\", density = 2700, radius = 0.01 }";

#[test]
fn systems_in_space_that_cannot_be_are_refused_at_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("case.toml");
    let joint = |text: &str| format!("{IN_SPACE}[[joint]]\n{text}\n");
    for (case, expected) in [
        (IN_SPACE.replace("\"upper\", \"lower\"", "\"upper\", \"lwoer\""), ["joint[2].between", "`lower`"]),
        (IN_SPACE.replace("name = \"lower\"", "name = \"upper\""), ["body[2]", "already taken"]),
        (IN_SPACE.replace("name = \"lower\"", "name = \"a b\""), ["body[2].name", "column"]),
        (IN_SPACE.replace("mass = 1", "mass = 0"), ["body[1].mass", "positive"]),
        (IN_SPACE.replace("axis = [0, 1, 0]", "axis = [0, 0, 0]"), ["joint[1].axis", "no direction"]),
        (IN_SPACE.replace("at = [0, 0, 0]", "at = [0]"), ["joint[1].at", "3 in space"]),
        (
            IN_SPACE.replace("between = [\"ground\", \"upper\"]", "between = [\"upper\", \"upper\"]"),
            ["joint[1]", "same"],
        ),
        (
            joint(
                "kind = \"spherical\"\nbetween = [\"ground\", \"lower\"]\nmotion = { kind = \"constant\", speed = 1 }",
            ),
            ["joint[3].motion", "revolute"],
        ),
        (joint("kind = \"fixed\"\nbetween = [\"ground\", \"upper\"]"), ["joint3", "redundant"]),
        (
            format!("{IN_SPACE}[integrator]\nkind = \"runge-kutta-4\"\nstep = 1e-4\n"),
            ["integrator.kind", "radau"],
        ),
        (format!("{IN_SPACE}[initial]\nkind = \"modes\"\namplitudes = [0.1]\n"), ["initial.kind", "static"]),
        (format!("{IN_SPACE}[hub]\nradius = 1\n"), ["hub", "unknown key"]),
        (format!("{IN_SPACE}[[load]]\non = \"upper\"\n"), ["load[1]", "neither"]),
        (
            format!("{IN_SPACE}[[load]]\non = \"ground\"\nat = [0, 0, 0]\nforce = [1, 0, 0]\n"),
            ["load[1].on", "moves nothing"],
        ),
        (
            format!(
                "{IN_SPACE}[[spring]]\nkind = \"line\"\nbetween = [\"ground\", \"upper\"]\nfrom = [0.5, 0, 0]\nstiffness = 1\n"
            ),
            ["spring[1]", "no direction"],
        ),
        (
            format!(
                "{IN_SPACE}[[contact]]\non = \"upper\"\nobstacle = {{ kind = \"plane\", normal = [0, 0, 1] }}\nlaw = {{ kind = \"massless\" }}\n"
            ),
            ["contact[1].law", "mass"],
        ),
        (
            format!(
                "{IN_SPACE}[[contact]]\non = \"upper\"\nobstacle = {{ kind = \"plane\", normal = [0, 0, 1], point = [0, 0, 1] }}\nlaw = {{ kind = \"hertz\", stiffness = 1 }}\n"
            ),
            ["contact[1].obstacle", "inside"],
        ),
        (
            format!(
                "{IN_SPACE}[[contact]]\non = \"upper\"\nobstacle = {{ kind = \"plane\", normal = [0, 0, 0] }}\nlaw = {{ kind = \"hertz\", stiffness = 1 }}\n"
            ),
            ["contact[1].obstacle.normal", "direction"],
        ),
        (
            format!(
                "{IN_SPACE}[[contact]]\non = \"upper\"\nobstacle = {{ kind = \"plane\", normal = [0, 0, 1] }}\nlaw = {{ kind = \"constraint\", restitution = 2 }}\n"
            ),
            ["contact[1].law.restitution", "from 0 to 1"],
        ),
        (
            format!(
                "{IN_SPACE}[[beam]]\nlength = 1\nsection = {{ kind = \"resultants\", mass-per-length = 1, axial-stiffness = 1, bending-stiffness = 1 }}\n"
            ),
            ["beam[1].section", "torsion"],
        ),
        (
            format!("{IN_SPACE}[[beam]]\nlength = 1\n{ROD}\noutline = {{ y = [0, 1, 2], z = [0, 1, 2] }}\n"),
            ["beam[1].outline", "enclose no area"],
        ),
        (
            format!("{IN_SPACE}[[beam]]\nlength = 1\n{ROD}\noutline = {{ y = [0, 1, 2], z = [0] }}\n"),
            ["beam[1].outline.z", "3 corners"],
        ),
        (
            format!(
                "{IN_SPACE}[[beam]]\nlength = 1\n{ROD}\nelements = 1\ncurve = {{ kind = \"arc\", angle = \"300 deg\" }}\n"
            ),
            ["beam[1].elements", "more elements"],
        ),
        (
            format!("{IN_SPACE}[[beam]]\nlength = 1\n{ROD}\nelements = 1000000000\n"),
            ["beam[1].elements", "from 1 to"],
        ),
        (
            format!(
                "{IN_SPACE}[[beam]]\nlength = 1\n{ROD}\n[[joint]]\nkind = \"fixed\"\nbetween = [\"upper\", \"beam@2 m\"]\n"
            ),
            ["joint[3].between", "ends at 1 m"],
        ),
        (format!("{IN_SPACE}[[beam]]\nlength = 1e300\n{ROD}\n"), ["beam[1]", ""]),
        (IN_SPACE.replace("mass = 1\n", "mass = 1e308\n"), ["body[1]", ""]),
    ] {
        std::fs::write(&file, &case).unwrap();
        let output = flexion(folder.path(), &["check", "case.toml"]);
        let message = text(&output.stderr);
        assert!(!message.contains("panicked"), "{case}{message}");
        if expected[1].is_empty() {
            // An enormous number may be a system; a run of it ends without a panic.
            let output = flexion(folder.path(), &["run", "case.toml", "--force", "--until", "1e-3"]);
            assert!(!text(&output.stderr).contains("panicked"), "{case}{}", text(&output.stderr));
            continue;
        }
        assert_eq!(output.status.code(), Some(1), "{case}{message}");
        assert!(expected.iter().all(|words| message.contains(words)), "{expected:?}: {message}");
        assert!(message.contains("case.toml:") || expected[0] == "joint[3]", "{message}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn modes_that_are_stopped_or_not_found_leave_no_folder() {
    let folder = folder();
    let set = "--set basis.elements=100000 --count 300 -o out";
    let stopped = shell(folder.path(), &format!("timeout -s INT 1 \"$1\" modes case.toml {set}"));
    assert!(!stopped.status.success() && !folder.path().join("out").exists(), "{}", text(&stopped.stderr));
    let message = refused(
        folder.path(),
        &["modes", "case.toml", "--speed", "50 rad/s", "--set", "model.coupling=zeroth", "-o", "out"],
    );
    assert!(!folder.path().join("out").exists(), "{message}");
}

/// Painlevé's rod, whose friction presses its end into the floor faster than the floor pushes it out: no force fits its slip, and no step begins.
#[test]
fn a_run_that_does_not_begin_says_that_nothing_was_recorded() {
    let folder = folder();
    let case = "run={duration=1}\ngravity=[0,0,-9.81]\n[[body]]\nname='rod'\nmass=1\ninertia={kind='principal',moments=[0.0833333333333,0.0833333333333,1e-4]}\n\
                position=[0.22360679775,0,0.4472135955]\naxis=[1,0,2]\nvelocity=[-1,0,0]\n[[contact]]\non='rod'\nat=[0,0,0]\n\
                obstacle={kind='plane',normal=[0,0,1]}\nlaw={kind='constraint',restitution=0,friction=1.4}\n";
    std::fs::write(folder.path().join("rod.toml"), case).unwrap();
    let output = flexion(folder.path(), &["run", "rod.toml", "-o", "out"]);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(2), "{err}");
    assert!(err.ends_with("Nothing was recorded.\n") && !out.contains("NaN"), "{out}{err}");
}
