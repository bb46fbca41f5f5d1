//! Steady rotation of systems in space: the axis that a case says or implies, and what its modes are.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::analysis::campbell::{HubState, Plan};
use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate_stably;
use flexion_case::{Case, Reading, campbell, parse};
use std::path::Path;

fn read(text: &str) -> Reading {
    parse(text.to_owned(), Path::new("case.toml"), &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A beam 1 m from the axis, with what else is said of it and of the case.
fn beam(of_beam: &str, more: &str) -> String {
    format!(
        "run = {{ duration = 0 }}\n[[beam]]\nlength = 1\nstart = [1, 0, 0]\nelements = 16\npolar-inertia = 1e-9\n{of_beam}\n\
         section = {{ kind = \"general\", mass-per-length = 1, axial-stiffness = 1e6, torsional-stiffness = 1, \
         bending-stiffness = 1, bending-stiffness-across = 9 }}\n{more}"
    )
}

fn frequencies(case: &Case, speed: f64) -> (Vec<f64>, Vec<String>) {
    let (mut system, left_out) = case.vibrating(speed > 0.0).unwrap();
    let mut state = system.initial();
    rotate_stably(system.as_mut(), &mut state, 0.0, speed).unwrap();
    let found = modes(system.as_mut(), &state, 4, &[]).unwrap();
    (found.modes.iter().map(|mode| mode.frequency()).collect(), left_out)
}

fn close(a: &[f64], b: &[f64], tolerance: f64) -> bool {
    a.iter().zip(b).all(|(a, b)| (a / b - 1.0).abs() < tolerance)
}

const HINGE: &str = "[[joint]]\nkind = \"revolute\"\nbetween = [\"ground\", \"beam.root\"]\nat = [0, 0, 0]\n";

/// A hinge whose drive does not count, the name of that hinge, and a turntable are the same.
#[test]
fn a_joint_or_a_line_is_the_axis() {
    let clamped = beam("root = \"clamped\"", "[rotation]\naxis = [0, 0, -3]\npoint = [0, 0, 7]\n");
    let (expected, _) = frequencies(&read(&clamped).case, 5.0);
    // Across the plane of rotation it is the beam 1 m from the axis of the closed series.
    let flap = flexion::exact::rotating::flapwise_frequency(1, 5.0, 1.0);
    assert!((expected[0] / flap - 1.0).abs() < 1e-5, "{expected:?} for {flap}");
    for text in [
        beam("", HINGE),
        beam("", &format!("{HINGE}motion = {{ kind = \"spin-up\", speed = 3, time = 1 }}\n")),
        beam(
            "",
            &format!("{HINGE}motion = {{ kind = \"free\", angle = 0.4, damping = 2, stiffness = 30 }}\n"),
        ),
        beam("", &format!("{HINGE}name = \"shaft\"\n[rotation]\nabout = \"shaft\"\n")),
        beam("", &format!("{HINGE}[rotation]\naxis = [0, 0, 1]\n")),
        // A second bearing on the same axis leaves the drive to the first.
        beam("", &format!("{HINGE}{}\n", HINGE.replace("revolute", "cylindrical")))
            .replace("[[beam]]", "model.drop-redundant-rows = true\n[[beam]]"),
    ] {
        let (found, _) = frequencies(&read(&text).case, 5.0);
        assert!(close(&found, &expected, 1e-7), "{text}\n{found:?} for {expected:?}");
    }
}

/// Gravity along the axis sags the beam as it turns; across the axis it is left out and named.
#[test]
fn of_a_load_fixed_in_space_the_part_along_the_axis_remains() {
    let with = |gravity: &str| {
        let text = beam("root = \"clamped\"", "[rotation]\naxis = [0, 0, 1]\n");
        frequencies(&read(&format!("gravity = {gravity}\n{text}")).case, 4.0)
    };
    let (along, none) = with("[0, 0, -0.5]");
    let (oblique, named) = with("[0.2, 0.3, -0.5]");
    let (free, _) = with("[0, 0, 0]");
    assert!(close(&along, &oblique, 1e-9) && !close(&along, &free, 1e-5), "{along:?} {oblique:?} {free:?}");
    assert_eq!((none, named), (vec![], vec!["gravity".to_owned()]));
}

#[test]
fn a_case_without_one_axis_says_what_it_needs() {
    let why = |text: &str| match read(text).case.vibrating(true) {
        Ok(_) => panic!("{text}"),
        Err(faults) => faults.to_string(),
    };
    assert!(why(&beam("root = \"clamped\"", "")).contains("`rotation = { axis = [0, 0, 1] }`"));
    let spring = "[[spring]]\nbetween = [\"ground\", \"beam.tip\"]\nfrom = [2, 1, 0]\nstiffness = 3\n";
    let held = why(&beam("", &format!("{HINGE}{spring}")));
    assert!(held.contains("`spring`") && held.contains("about = \"joint\""), "{held}");
}

#[test]
fn a_faulty_rotation_is_reported_at_its_line() {
    for (rotation, key, words) in [
        ("", "rotation", "says no axis"),
        ("axis = [0, 0, 0]", "rotation.axis", "no direction"),
        ("axis = [0, 1]", "rotation.axis", "3 components"),
        ("about = \"hinge\"", "rotation.about", "did you mean `hinge1`"),
        ("about = \"hinge1\"\naxis = [0, 0, 1]", "rotation.axis", "already says"),
        ("about = \"hinge1\"\npoint = [0, 0, 1]", "rotation.point", "belongs to"),
    ] {
        let text = beam("", &format!("{HINGE}name = \"hinge1\"\n[rotation]\n{rotation}\n"));
        let problems = parse(text, Path::new("case.toml"), &[]).unwrap_err();
        let [problem] = &problems.list[..] else { panic!("{problems}") };
        assert!(problem.key.starts_with(key), "{rotation}: {}", problem.key);
        assert!(problem.place.is_some() && problems.to_string().contains(words), "{rotation}: {problems}");
    }
}

/// Frequencies at every speed with their errors by the mesh, which are those found from twice the elements.
#[test]
fn a_campbell_diagram_knows_the_errors_of_its_mesh() {
    let text = beam("elements = 5", HINGE).replace("elements = 16\n", "");
    let reading = read(&text);
    let finer = reading.with_finer_mesh().unwrap();
    let plan = Plan {
        speeds: vec![0.0, 2.0, 4.0, 6.0],
        count: 4,
        stations: Vec::new(),
        hub: HubState::Held,
        revolutions: 0,
    };
    let [system, fine] = [&reading, &finer].map(|reading| reading.case.vibrating(true).unwrap().0);
    let diagram = campbell(system, Some((fine, 2.0)), &plan, 1, &|_| true).unwrap();
    for speed in [0.0, 4.0] {
        let [(coarse, _), (fine, _)] = [&reading, &finer].map(|reading| {
            let (mut system, _) = reading.case.vibrating(true).unwrap();
            let mut state = system.initial();
            rotate_stably(system.as_mut(), &mut state, 0.0, speed).unwrap();
            let found = modes(system.as_mut(), &state, 4, &[]).unwrap();
            (found.modes.iter().map(|mode| mode.frequency()).collect::<Vec<_>>(), ())
        });
        for (coarse, fine) in coarse.iter().zip(&fine) {
            let points = diagram.branches.iter().flat_map(|branch| &branch.points);
            let near = |f: f64| (f / coarse - 1.0).abs() < 1e-7;
            let mut same = points.filter(|point| point.speed == speed && near(point.mode.frequency()));
            let point = same.next().unwrap_or_else(|| panic!("{coarse} at {speed}"));
            let (error, expected) = (point.mode.mesh.unwrap(), 2.0 * (coarse - fine).abs());
            assert!((error - expected).abs() < 1e-6 * coarse && error > 0.0, "{error} for {expected}");
        }
    }
    assert!(diagram.coarsest().is_some_and(|(_, point)| point.mode.mesh.is_some()));
}

/// An overhung disc on an undamped shaft: its motions neither grow nor decay.
#[test]
fn rounding_is_no_negative_damping() {
    let text = "run = { duration = 1 }
        [[beam]]\nname = \"shaft\"\nlength = 0.5\nelements = 8\npolar-inertia = 1e-8
        section = { kind = \"general\", mass-per-length = 1e-4, axial-stiffness = 1e7, torsional-stiffness = 1e4, \
        bending-stiffness = 100, bending-stiffness-across = 100 }
        [[body]]\nname = \"disc\"\nmass = 1\nposition = [0.5, 0, 0]\naxis = [1, 0, 0]
        inertia = { kind = \"principal\", moments = [0.01, 0.01, 0.02] }
        [[joint]]\nkind = \"revolute\"\nbetween = [\"ground\", \"shaft.root\"]\naxis = [1, 0, 0]
        motion = { kind = \"constant\", speed = 20 }
        [[joint]]\nkind = \"fixed\"\nbetween = [\"shaft.tip\", \"disc\"]\n";
    let speeds = (0..=30).map(|k| 2.0 * f64::from(k)).collect();
    let plan = Plan { speeds, count: 4, stations: Vec::new(), hub: HubState::Held, revolutions: 0 };
    let diagram = campbell(read(text).case.vibrating(true).unwrap().0, None, &plan, 1, &|_| true).unwrap();
    assert_eq!(diagram.instabilities, []);
    assert!(diagram.branches.iter().flat_map(|b| &b.points).all(|p| p.mode.damping_ratio().abs() < 1e-7));
}
