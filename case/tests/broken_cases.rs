//! Every broken case in `broken_cases/NAME.toml`, one for each thing that a report draws, is refused with exactly the report in
//! `NAME.txt`; every change in [`CHANGES`] of a sound case at its key, on its line, with its words.
//!
//! A line `# set: KEY=VALUE` of a case stands for `--set KEY=VALUE`. After a deliberate change of a
//! message, `FLEXION_ACCEPT=1 cargo test --test broken_cases` rewrites the reports: read the diff.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // in helpers of tests

use flexion_case::{Contents, parse_with};
use std::path::Path;

/// Changes of the sound case: text, its replacement, and key, line and words of the one problem that follows.
type Change = (&'static str, &'static str, &'static str, Option<usize>, &'static str);

/// The section of the sound case.
const SECTION: &str = "kind = \"uniform\"\nmodulus = \"70 GPa\"\ndensity = \"3000 kg/m^3\"\narea = \"4 cm^2\"\nsecond-moment = \"2e-7 m^4\"";

const SOUND: &str = r#"[beam]
length = "10 m"

[section]
kind = "uniform"
modulus = "70 GPa"
density = "3000 kg/m^3"
area = "4 cm^2"
second-moment = "2e-7 m^4"

[hub]
motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" }

[basis]
kind = "finite-elements"
elements = 10

[integrator]
kind = "radau"
tolerance = 1e-6

[run]
duration = "20 s"

[output]
step = "0.01 s"
"#;

const CHANGES: &[Change] = &[
    (r#"kind = "radau""#, "kind = 'radau'\nstep = '1 ms'", r#"integrator.step"#, Some(20), r#"unknown key"#),
    ("kind = \"uniform\"\n", "", r#"section.kind"#, Some(4), r#"the kind of section is missing"#),
    (
        r#"kind = "spin-up", speed = "4 rad/s", time = "15 s""#,
        r#"kind = "expression", of = "speed", formula = "4*sin(omega*t)""#,
        r#"hub.motion.formula"#,
        Some(12),
        r#"`omega` is not known"#,
    ),
    (
        r#"kind = "spin-up", speed = "4 rad/s", time = "15 s""#,
        r#"kind = "table", of = "speed", file = "short.csv""#,
        r#"hub.motion.file"#,
        Some(12),
        r#"from 0 s to 10 s and the run needs it from 0 s to 20 s"#,
    ),
    (
        r#"step = "0.01 s""#,
        r#"stations = ["5 m", true]"#,
        r#"output.stations"#,
        Some(26),
        r#"a list is not what this key takes"#,
    ),
    (
        r#"step = "0.01 s""#,
        r#"strain-heights = [0.01, 0.01]"#,
        r#"output.strain-heights"#,
        Some(26),
        r#"given twice"#,
    ),
    (
        r#"length = "10 m""#,
        r#"length = "10,5 m""#,
        r#"beam.length"#,
        Some(2),
        r#"a decimal comma is not read"#,
    ),
    (r#"length = "10 m""#, r#"length = nan"#, r#"beam.length"#, Some(2), r#"must be a finite number"#),
    (r#"length = "10 m""#, r#"length = 0"#, r#"beam.length"#, Some(2), r#"must be positive, but is 0 m"#),
    (
        r#"length = "10 m""#,
        r#"length = "10 s""#,
        r#"beam.length"#,
        Some(2),
        r#"`s` is a unit of time, not of length"#,
    ),
    (r#"length = "10 m""#, r#"length = "m""#, r#"beam.length"#, Some(2), r#"expected a number at the start"#),
    (
        r#"length = "10 m""#,
        r#"length = true"#,
        r#"beam.length"#,
        Some(2),
        r#"a boolean is not what this key takes"#,
    ),
    (r#"length = "10 m""#, "length = \"10 m\"\nlength = 3", r#""#, Some(3), r#"duplicate key"#),
    (
        "[beam]\nlength = \"10 m\"",
        "[beam]\nlength = \"10 m\"\n[[beam]]\nname = \"arm\"",
        r#""#,
        Some(3),
        r#"duplicate key"#,
    ),
    (
        "[beam]\nlength = \"10 m\"",
        "[beam]\nlength = \"10 m\"\npolar-inertia = 1e-3",
        r#"beam.polar-inertia"#,
        Some(3),
        r#"does not carry this"#,
    ),
    (
        "[beam]\nlength = \"10 m\"",
        r#"beam = 10"#,
        r#"beam"#,
        Some(1),
        r#"an integer is not what this key takes"#,
    ),
    (
        r#"modulus = "70 GPa""#,
        r#"modulus = "70e400 GPa""#,
        r#"section.modulus"#,
        Some(6),
        r#"too large for a number"#,
    ),
    (
        r#"modulus = "70 GPa""#,
        r#"modulus = "70 GPascal""#,
        r#"section.modulus"#,
        Some(6),
        r#"unknown unit `GPascal`"#,
    ),
    (r#"second-moment"#, r#"second_moment"#, r#"section.second_moment"#, Some(9), r#"unknown key"#),
    (
        r#"speed = "4 rad/s""#,
        r#"speed = "4 Hz""#,
        r#"hub.motion.speed"#,
        Some(12),
        r#"`Hz` counts cycles, not angle"#,
    ),
    (
        r#"[hub]"#,
        "[hub]\ninertia = \"-2 kg*m^2\"",
        r#"hub.inertia"#,
        Some(12),
        r#"must be zero or positive, but is -2 kg*m^2"#,
    ),
    (
        r#"elements = 10"#,
        r#"elements = 99999999999999999999"#,
        r#"basis.elements"#,
        Some(16),
        r#"an integer out of range"#,
    ),
    (
        r#"elements = 10"#,
        r#"elements = 0"#,
        r#"basis.elements"#,
        Some(16),
        r#"must be from 1 to 1000000, but is 0"#,
    ),
    (r#"elements = 10"#, "elements = 10\ncolour = \"red\"", r#"basis.colour"#, Some(17), r#"unknown key"#),
    (
        r#"tolerance = 1e-6"#,
        r#"tolerance = inf"#,
        r#"integrator.tolerance"#,
        Some(20),
        r#"must be a finite number"#,
    ),
    (
        r#"tolerance = 1e-6"#,
        r#"tolerance = "1e-6""#,
        r#"integrator.tolerance"#,
        Some(20),
        r#"a text is not what this key takes"#,
    ),
    (r#"kind = "radau""#, r#"kind = "rado""#, r#"integrator.kind"#, Some(19), r#"unknown integrator `rado`"#),
    (
        "kind = \"radau\"\ntolerance = 1e-6",
        "kind = \"hht\"\nstep = \"1 ms\"\nalpha = -0.3",
        r#"integrator.alpha"#,
        Some(21),
        r#"must be from 0 to 0.3333, but is -0.3"#,
    ),
    (
        "kind = \"radau\"\ntolerance = 1e-6",
        "kind = \"newmark\"\nstep = \"1 ms\"\nbeta = 0.1666",
        r#"integrator.beta"#,
        Some(21),
        r#"only conditionally stable"#,
    ),
    (
        "kind = \"radau\"\ntolerance = 1e-6",
        "kind = \"newmark\"\nstep = \"30 s\"",
        r#"integrator.step"#,
        Some(20),
        r#"the step 30 s is longer than the run of 20 s"#,
    ),
    (
        r#"duration = "20 s""#,
        r#"duration = 2020-01-01"#,
        r#"run.duration"#,
        Some(23),
        r#"a date is not what this key takes"#,
    ),
    (
        r#"step = "0.01 s""#,
        r#"step = "1 min""#,
        r#"output.step"#,
        Some(26),
        r#"the output step 60 s is longer than the run of 20 s"#,
    ),
    (r#"step = "0.01 s""#, r#"step = "1 ps""#, r#"output.step"#, Some(26), r#"makes 2.0e13 records in 20 s"#),
    (
        r#"step = "0.01 s""#,
        r#"stations = ["5 m", "1200 cm"]"#,
        r#"output.stations"#,
        Some(26),
        r#"`1200 cm` is not on the beam, which ends at 10 m"#,
    ),
    (r#"[output]"#, "[dampers]\nfactor = 1\n[output]", r#"dampers"#, Some(25), r#"unknown key"#),
    (
        r#"[basis]"#,
        "[model]\ncoupling = \"second\"\n[basis]",
        r#"model.coupling"#,
        Some(15),
        r#"unknown coupling `second`"#,
    ),
    (
        "[basis]\nkind = \"finite-elements\"\nelements = 10",
        "[model]\ncoupling = \"exact\"\n[basis]\nkind = \"bezier\"",
        r#"basis"#,
        Some(16),
        r#"cannot use the basis `bezier`"#,
    ),
    (
        "[basis]\nkind = \"finite-elements\"\nelements = 10",
        "[model]\ncoupling = \"exact\"\n[basis]\nkind = \"mixed\"\naxial = { kind = \"finite-elements\", elements = 5 }\ntransverse = { kind = \"finite-elements\" }",
        r#"basis"#,
        Some(16),
        r#"cannot use the basis `mixed`"#,
    ),
    (
        "kind = \"finite-elements\"\nelements = 10",
        "kind = \"b-spline\"\ndegree = 1",
        r#"basis.degree"#,
        Some(16),
        r#"transverse B-splines must be from 2 to 15"#,
    ),
    (
        "kind = \"finite-elements\"\nelements = 10",
        "kind = \"radial\"\nshape = 9",
        r#"basis.shape"#,
        Some(16),
        r#"singular to working precision"#,
    ),
    (
        "kind = \"finite-elements\"\nelements = 10",
        "kind = \"polynomial\"\nnodes = 21\nsupport = 7.5",
        r#"basis.support"#,
        Some(17),
        r#"singular to working precision"#,
    ),
    (
        "kind = \"finite-elements\"\nelements = 10",
        "kind = \"mixed\"\naxial = { kind = \"modes\", count = 2 }\ntransverse = { kind = \"bezier\", degree = 1 }",
        r#"basis.transverse.degree"#,
        Some(17),
        r#"degree"#,
    ),
    (
        r#"[beam]"#,
        "initial = { kind = \"modes\" }\n[beam]",
        r#"initial.amplitudes"#,
        Some(1),
        r#"no mode is given an amplitude"#,
    ),
    (
        r#"[beam]"#,
        "initial = { kind = \"modes\", amplitudes = [1, 0], velocities = [2] }\n[beam]",
        r#"initial.velocities"#,
        Some(1),
        r#"are 1 and 2"#,
    ),
    (
        r#"[beam]"#,
        "initial = { kind = \"restart\", file = \"words.csv\" }\n[beam]",
        r#"initial.file"#,
        Some(1),
        r#"words.csv is not the state of a run"#,
    ),
    (
        r#"kind = "spin-up", speed = "4 rad/s", time = "15 s""#,
        r#"kind = "table", of = "speed", file = "no_such.csv""#,
        r#"hub.motion.file"#,
        Some(12),
        r#"there is no file no_such.csv"#,
    ),
    (
        r#"kind = "spin-up", speed = "4 rad/s", time = "15 s""#,
        r#"kind = "table", of = "speed", file = "unsorted.csv""#,
        r#"hub.motion.file"#,
        Some(12),
        r#"must lie behind the row before it"#,
    ),
    (
        r#"kind = "spin-up", speed = "4 rad/s", time = "15 s""#,
        r#"kind = "table", of = "angle", file = "words.csv""#,
        r#"hub.motion.file"#,
        Some(12),
        r#"`5,fast`, is not two numbers"#,
    ),
    (
        r#"kind = "spin-up", speed = "4 rad/s", time = "15 s""#,
        r#"kind = "expression", of = "speed", formula = "4*sin(t""#,
        r#"hub.motion.formula"#,
        Some(12),
        r#"a closing `)` is missing"#,
    ),
    (
        r#"kind = "spin-up", speed = "4 rad/s", time = "15 s""#,
        r#"kind = "free", torque = { kind = "table", file = "unsorted.csv" }, controller = { kind = "pd" }"#,
        r#"hub.motion.torque.file"#,
        Some(12),
        r#"must lie behind the row before it"#,
    ),
    (
        SECTION,
        "kind = 'graded'\nceramic-modulus = '151 GPa'\nmetal-modulus = '70 GPa'\nceramic-density = 3000\nmetal-density = 2707\nwidth = '20 mm'\nheight = '20 mm'\nexponent = 2\nfirst-moment = true",
        r#"section.first-moment"#,
        Some(13),
        r#"cannot be kept without the rotary inertia"#,
    ),
    (
        SECTION,
        "kind = 'tube'\nmodulus = '70 GPa'\ndensity = 3000\nouter-radius = '1 cm'\ninner-radius = '12 mm'",
        r#"section.inner-radius"#,
        Some(9),
        r#"must be less than the outer radius 0.01 m, but is 0.012 m"#,
    ),
    (SECTION, "kind = 'table'\nfile = 'short.csv'", r#"section.file"#, Some(6), r#"has a column `t`"#),
    (
        SECTION,
        "kind = 'piecewise'\nends = ['4 m', '9 m']\nmodulus = [1e9, 1e9]\ndensity = [1, 1]\narea = [1, 1]\nsecond-moment = [1, 1]",
        r#"section.ends"#,
        Some(6),
        r#"the last segment ends at 9 m and must end with the beam"#,
    ),
    (
        SECTION,
        "kind = 'piecewise'\nends = ['4 m', '10 m']\nmodulus = [1e9, 1e9]\ndensity = [1, 1]\narea = [1, 1]\nsecond-moment = [1]",
        r#"section.second-moment"#,
        Some(10),
        r#"has 1 entries for the 2 segments"#,
    ),
    (
        "[beam]",
        "load = [{ on = '11 m', force = [0, 1] }]\n[beam]",
        r#"load[1].on"#,
        Some(1),
        r#"`11 m` is not on the beam, which ends at 10 m"#,
    ),
    (
        "[beam]",
        "load = [{ on = '1 m', force = [0, 1, 2] }]\n[beam]",
        r#"load[1].force"#,
        Some(1),
        r#"points out of the plane of motion"#,
    ),
    (
        "[beam]",
        "load = [{ on = 'beam', force-per-length = [0, 1] }, { on = 'beam', force-per-length = [0, 1], from = 5, to = 4 }]\n[beam]",
        r#"load[2].from"#,
        Some(1),
        r#"it has no length"#,
    ),
    (
        "[beam]",
        "load = [{ on = '1 m', couple = 1, amplitude = { kind = 'table', times = [0, 1, 30], factors = [1] } }]\n[beam]",
        r#"load[1].amplitude.factors"#,
        Some(1),
        r#"there are 1 factors for 3 rows"#,
    ),
    (
        "[beam]",
        "load = [{ on = '1 m', force = [0, 1], amplitude = { kind = 'expression', formula = '2*y' } }]\n[beam]",
        r#"load[1].amplitude.formula"#,
        Some(1),
        r#"`y` is not known"#,
    ),
    ("[beam]", "[beam]\npitch = '2 deg'", r#"beam.pitch"#, Some(2), r#"does not carry this"#),
];

#[test]
fn every_broken_case_is_refused_with_its_report() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/broken_cases");
    let accept = std::env::var_os("FLEXION_ACCEPT").is_some();
    let mut names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .filter_map(|entry| {
            entry.unwrap().file_name().into_string().unwrap().strip_suffix(".toml").map(String::from)
        })
        .collect();
    names.sort();
    assert!(names.len() >= 9, "{} cases", names.len());
    let mut wrong = Vec::new();
    for name in &names {
        let text = std::fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
        let overrides: Vec<String> =
            text.lines().filter_map(|line| line.strip_prefix("# set: ").map(String::from)).collect();
        let report = match refusal(text, &folder, name, &overrides) {
            Some(report) => report,
            None => {
                wrong.push(format!("{name} is accepted"));
                continue;
            }
        };
        let expected = folder.join(format!("{name}.txt"));
        if accept {
            std::fs::write(&expected, &report).unwrap();
        } else if std::fs::read_to_string(&expected).ok().as_deref() != Some(&report) {
            wrong.push(format!("{name} reports\n{report}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The report of a case, with the folder left out of it.
fn refusal(text: String, folder: &Path, name: &str, overrides: &[String]) -> Option<String> {
    let file = folder.join(format!("{name}.toml"));
    let problems = match flexion_case::parse(text, &file, overrides) {
        Err(problems) => problems,
        Ok(_) => return None,
    };
    let trimmed: Vec<String> =
        problems.render(false).lines().map(|line| line.trim_end().to_owned()).collect();
    Some(trimmed.join("\n").replace(&format!("{}/", folder.display()), "") + "\n")
}

#[test]
fn every_change_is_refused_at_its_key_and_line() {
    let text = |rows: &[u8]| rows.to_vec().into();
    let files: Contents = [
        ("short.csv".to_owned(), text(b"t,speed\n0,0\n5,1\n10,4\n")),
        ("words.csv".to_owned(), text(b"t,angle\n0,0\n5,fast\n30,4\n")),
        ("unsorted.csv".to_owned(), text(b"t,speed\n0,0\n5,1\n3,2\n30,4\n")),
    ]
    .into();
    let read = |case: String, set: &[String]| parse_with(case, Path::new("case.toml"), set, &files);
    assert!(read(SOUND.to_owned(), &[]).is_ok());
    for (from, to, key, line, words) in CHANGES {
        assert!(SOUND.contains(from), "{from}");
        let Err(problems) = read(SOUND.replacen(from, to, 1), &[]) else { panic!("{to} is accepted") };
        let found = |p: &&flexion_case::Problem| {
            p.key == *key
                && p.message.contains(words)
                && problems.line_and_column(p).map(|(line, _)| line) == *line
        };
        assert!(problems.list.iter().find(found).is_some(), "{to}: {key} {line:?} {words}\n{problems}");
    }
    for (set, key, words) in [
        ("section.modulos=30 GPa", "section.modulos", "unknown key"),
        ("section.modulus", "", "an override is KEY=VALUE"),
        ("basis.elements.x=1", "basis.elements", "is an integer and has no keys"),
        ("basis=RPIM", "basis", "unknown basis `RPIM`"),
        (
            "load=[{on='beam', force-per-length=[0, 1], distribution={kind='table', stations=[2, 8], factors=[1, 1]}}]",
            "load[1].distribution",
            "covers the stations from 2 m to 8 m, and the load acts from 0 m to 10 m",
        ),
    ] {
        let problems = read(SOUND.to_owned(), &[set.to_owned()]).unwrap_err();
        assert!(problems.list[0].key == key && problems.list[0].message.contains(words), "{set}\n{problems}");
    }
}

#[test]
fn shear_of_a_beam_on_a_hub_is_a_key_of_its_model() {
    let case = SOUND.replace("length = \"10 m\"", "length = \"10 m\"\nshear = true");
    let problems = flexion_case::parse(case, Path::new("case.toml"), &[]).unwrap_err();
    let [problem] = &problems.list[..] else { panic!("{problems}") };
    assert_eq!(problem.key, "beam.shear");
    assert!(
        problem.help.iter().any(|help| help.contains("`model.coupling = \"space-shear\"`")),
        "{problems}"
    );
}

#[test]
fn tables_in_lists_are_changed_by_number_by_name_and_the_only_one_by_its_keys() {
    let beam = |name: &str| {
        format!(
            "[[beam]]\n{name}length=1\nup=[0,1,0]\nsection={{kind='circle',radius=0.01,modulus=1e9,density=1e3}}\n"
        )
    };
    let one = format!("run.duration=1\n{}", beam(""));
    let two = format!("run.duration=1\n{}{}", beam("name='left'\n"), beam("name='right'\n"));
    let read = |text: &str, set: &str| {
        flexion_case::parse(text.to_owned(), Path::new("case.toml"), &[set.to_owned()])
    };
    for set in ["beam.elements=7", "beam.1.elements=7", "beam[1].elements=7", "beam.1.section.radius=0.02"] {
        assert!(read(&one, set).is_ok(), "{set}");
    }
    for set in [
        "beam.2.elements=7",
        "beam[2].elements=7",
        "beam.right.elements=7",
        "beam.left.section.radius='2 cm'",
    ] {
        assert!(read(&two, set).is_ok(), "{set}");
    }
    for (text, set, words) in [
        (&one, "beam.elements=-7", "elements"),
        (&two, "beam.elements=7", "2 tables, of which none has the name `elements`"),
        (&one, "beam.0.elements=7", "has no number 0"),
        (&two, "beam.0.elements=7", "none has the name `0`"),
        (&two, "beam.3.elements=7", "none has the name `3`"),
        (&two, "beam[2].elements=-7", "beam[2].elements"),
    ] {
        let problems = read(text, set).map(|_| ()).unwrap_err().to_string();
        assert!(problems.contains(words), "{set}: {problems}");
    }
    let problems = read(&two, "beam.middle.elements=7").map(|_| ()).unwrap_err().to_string();
    assert!(problems.contains("`left`, `right`") && problems.contains("from 1 to 2"), "{problems}");
}

#[test]
fn problems_stand_at_their_lines_and_columns() {
    let text = "[beam]\nlength = \"10 s\"\n[section]\nkind = \"circle\"\nmodulus = 1e9\ndensity = -1\nradius = \"1 cm\"\n[hub.motion]\nkind = \"constant\"\nspeed = \"4 Hz\"\n[run]\nduration = 1\n";
    let problems = flexion_case::parse(text.to_owned(), Path::new("case.toml"), &[]).unwrap_err();
    let places: Vec<_> =
        problems.list.iter().map(|p| (p.key.as_str(), problems.line_and_column(p))).collect();
    assert_eq!(
        places,
        [
            ("beam.length", Some((2, 14))),
            ("section.density", Some((6, 11))),
            ("hub.motion.speed", Some((10, 12)))
        ]
    );
}
