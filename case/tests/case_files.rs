//! Reading case files: what is accepted, what it means in SI, and how bad files are refused.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::hub_beam::Drive;
use flexion_case::kinds::integrator::Steps;
use flexion_case::{Case, Problems, parse, read, schema};
use std::path::Path;

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
[run]
duration = "20 s"
"#;

fn parsed(text: &str, overrides: &[&str]) -> Result<Case, Problems> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    parse(text.to_owned(), Path::new("case.toml"), &overrides).map(|reading| reading.case)
}

#[test]
fn a_case_is_read_in_si_with_defaults() {
    let case = parsed(SPIN_UP, &[]).unwrap();
    assert_eq!(case.title, "spin-up");
    assert_eq!(case.hub_beam().unwrap().length, 10.0);
    let r = case.hub_beam().unwrap().section.planar.resultants(3.0);
    assert_eq!((r.mass, r.axial_stiffness, r.bending_stiffness, r.rotary_inertia), (1.2, 28e6, 14e3, 0.0));
    let Drive::Prescribed(motion) = &case.hub_beam().unwrap().hub.drive else { panic!("the hub is free") };
    assert_eq!((motion.at(0.0).speed, motion.at(7.5).speed, motion.at(15.0).speed), (0.0, 2.0, 4.0));
    assert_eq!((case.hub_beam().unwrap().hub.radius, case.hub_beam().unwrap().hub.inertia), (0.0, 0.0));
    assert!(!case.hub_beam().unwrap().coupling.whole_curve);
    assert_eq!(case.hub_beam().unwrap().bases.elements, Some((10, 1)));
    let tolerances = Steps::Controlled {
        tolerance: 1e-6,
        absolute_tolerance: 1e-8,
        first: None,
        longest: None,
        contact: None,
        breaks: 1,
    };
    assert_eq!(case.steps, tolerances);
    assert_eq!((case.duration, case.output.step), (20.0, 0.02));
    assert!(case.output.stations.is_empty());
}

#[test]
fn overrides_replace_values_tables_and_defaults() {
    let overrides = [
        "section.modulus=30 GPa",
        "basis.elements = 20",
        "basis.kind=finite-elements",
        "model.coupling=exact",
        "integrator={ kind = \"newmark\", step = \"1 ms\" }",
        "output.stations=[\"2 m\", \"5 m\"]",
        "title=one two",
        "title=two",
    ];
    let case = parsed(SPIN_UP, &overrides).unwrap();
    assert_eq!(case.hub_beam().unwrap().section.planar.resultants(0.0).axial_stiffness, 12e6);
    assert_eq!(case.hub_beam().unwrap().bases.elements, Some((20, 1)));
    assert!(case.hub_beam().unwrap().coupling.whole_curve);
    assert_eq!(case.steps, Steps::Fixed { step: 1e-3, contact: None });
    assert_eq!(case.output.stations, [2.0, 5.0]);
    assert_eq!(case.title, "two");
}

#[test]
fn a_name_with_quotes_and_control_characters_survives_resolution() {
    let title = "a \"b\" \\ c\td\u{1}é\u{7f}";
    let text = SPIN_UP.replace("title = \"spin-up\"", "title = \"a \\\"b\\\" \\\\ c\\td\\u0001é\\u007f\"");
    let reading = parse(text, Path::new("case.toml"), &[]).unwrap();
    assert_eq!(reading.case.title, title);
    assert_eq!(parse(reading.resolved(), Path::new("case.toml"), &[]).unwrap().case.title, title);
}

#[test]
fn the_schema_in_the_documentation_is_the_one_of_the_declarations() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/flexion.schema.json");
    let committed = std::fs::read_to_string(file).unwrap();
    assert!(committed == schema(), "run `flexion schema > docs/flexion.schema.json`");
}

#[test]
fn an_explicit_step_beyond_stability_is_refused_at_its_key() {
    let set = "integrator={ kind = \"runge-kutta-4\", step = \"1 ms\" }".to_owned();
    let reading = parse(SPIN_UP.to_owned(), Path::new("case.toml"), &[set]).unwrap();
    let problems = reading.build().map(|_| ()).unwrap_err();
    assert_eq!(problems.list[0].key, "integrator.step");
    assert!(problems.list[0].message.contains("stability limit"), "{problems}");
    assert_eq!(problems.line_and_column(&problems.list[0]), Some((1, 45)));
}

fn refusal(path: &Path) -> String {
    read(path, &[]).map(|_| ()).unwrap_err().to_string()
}

#[test]
fn what_is_no_case_file_is_refused_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    assert!(refusal(path).contains("holds no case.toml"), "{}", refusal(path));
    assert!(refusal(&path.join("missing.toml")).contains("or a folder that holds a case.toml"));
    std::fs::create_dir_all(path.join("nested/case.toml")).unwrap();
    assert!(refusal(&path.join("nested")).contains("is not a file"));
    std::fs::write(path.join("latin.toml"), b"title = 'ok'\n# caf\xe9\n").unwrap();
    assert!(refusal(&path.join("latin.toml")).contains("not UTF-8 text: byte 18, on line 2"));
    let huge = std::fs::File::create(path.join("huge.toml")).unwrap();
    huge.set_len(1 << 30).unwrap();
    assert!(refusal(&path.join("huge.toml")).contains("larger than 10 MB"));
    std::fs::write(path.join("case.toml"), SPIN_UP).unwrap();
    let again = parse(SPIN_UP.to_owned(), Path::new("case.toml"), &[]).unwrap();
    assert_eq!(read(path, &[]).unwrap().resolved(), again.resolved());
    if Path::new("/dev/zero").exists() {
        assert!(refusal(Path::new("/dev/zero")).contains("is not a file"));
    }
}

#[test]
fn hostile_nesting_is_refused_without_exhausting_the_stack() {
    let dotted = "a.".repeat(70) + "a";
    let mut inline = "1".to_owned();
    for _ in 0..70 {
        inline = format!("{{ {dotted} = {inline} }}");
    }
    let key = "a.".repeat(100_000) + "a";
    for text in [
        format!("x = {}", "[".repeat(1_000_000)),
        format!("x = {}", "{a=".repeat(300_000)),
        format!("x = {inline}"),
        format!("[{key}]\nb = 1"),
        format!("{key} = 1"),
        "[[a]]\n".repeat(100_000),
        "=\n".repeat(200_000),
    ] {
        let problems = parsed(&text, &[]).map(|_| ()).unwrap_err();
        assert!(problems.to_string().len() < 100_000);
    }
    let set = format!("{key}=1");
    assert!(parsed(SPIN_UP, &[&set]).is_err());
}

/// The default integrator must not pass over an event of the motion that is short against the run.
#[test]
fn a_short_event_of_the_motion_is_not_passed_over() {
    let tip = |overrides: &[&str]| {
        let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
        let reading = parse(SPIN_UP.to_owned(), Path::new("case.toml"), &overrides).unwrap();
        let run = reading.prepare().unwrap().run(&mut |_| std::ops::ControlFlow::Continue(()));
        run.trajectory.column("tip.deflection").unwrap().iter().fold(0.0, |m: f64, x| m.max(x.abs()))
    };
    let event = "hub.motion={kind='expression',of='speed',formula='exp(-((t-10)/0.05)^2)'}";
    let small = tip(&[event, "integrator={kind='newmark',step='1 ms'}"]);
    let adaptive = tip(&[event]);
    assert!(small > 0.5 && (adaptive / small - 1.0).abs() < 1e-2, "{adaptive} {small}");
}

/// A station a rounding error before the tip is the tip.
#[test]
fn a_station_at_the_tip_is_not_recorded_twice() {
    let reading = parse(
        SPIN_UP.to_owned(),
        Path::new("case.toml"),
        &["output.stations=[\"9.999999999999999 m\", \"5 m\"]".to_owned()],
    );
    let mut live = reading.unwrap().build().unwrap();
    let channels = live.system.channels();
    let names: Vec<&str> = channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names.iter().filter(|name| **name == "tip.deflection").count(), 1);
    assert!(names.contains(&"x=5.deflection"));
}
