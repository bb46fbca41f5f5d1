//! Steady rotation of systems in space: the axis that a case says or implies, and what its modes are.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::analysis::campbell::{HubState, Plan};
use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate_stably;
use flexion::linalg::Matrix;
use flexion::linalg::vector::dot;
use flexion::system::Weights;
use flexion_case::{Case, Reading, campbell, parse};
use std::path::Path;

fn read(text: &str) -> Reading {
    parse(text.to_owned(), Path::new("case.toml"), &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// A beam 1 m from the axis, with what else is said of it and of the case.
fn beam(of_beam: &str, more: &str) -> String {
    format!(
        "run = {{ duration = 0 }}\n[[beam]]\nlength = 1\nstart = [1, 0, 0]\nup = [0, 0, 1]\nelements = 16\npolar-inertia = 1e-9\n{of_beam}\n\
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
    let spring = "[[spring]]\nkind = \"line\"\nbetween = [\"ground\", \"beam.tip\"]\nfrom = [2, 1, 0]\nstiffness = 3\n";
    let held = why(&beam("", &format!("{HINGE}{spring}")));
    assert!(held.contains("`spring`") && held.contains("about = \"joint\""), "{held}");
}

#[test]
fn a_faulty_rotation_is_reported_at_its_line() {
    for (rotation, key, words) in [
        ("", "rotation", "says no axis"),
        ("axis = [0, 0, 0]", "rotation.axis", "no direction"),
        ("axis = [1]", "rotation.axis", "3 in space"),
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
    let diagram = campbell(system, Some((fine, 2.0)), &plan, 1, &|_, _| true).unwrap();
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
    assert!(diagram.coarsest().is_some_and(|(_, _, error)| error > 0.0));
}

/// A flat strip that rotates: (I₂ − I₃) Ω² is most of its stiffness of torsion, and is lost with its rotary inertia. Without that a caution
/// says so; with it the frequency is that of the model of a blade.
#[test]
fn a_strip_without_rotary_inertia_is_warned_of_its_torsion_in_rotation() {
    let strip = |rotary: bool| {
        read(&format!(
            "run = {{ duration = 0 }}\n[[beam]]\nlength = 2\nup = [0, 0, 1]\nelements = 16\nsection = {{ kind = \"rectangle\", \
             modulus = 70e9, density = 2700, width = 0.1, height = 5e-4, rotary-inertia = {rotary} }}\n{HINGE}"
        ))
    };
    let warned = |reading: &Reading| {
        reading.case.unused_by_modes().iter().any(|w| w.contains("`rotary-inertia = true`"))
    };
    let (without, with) = (strip(false), strip(true));
    assert!(warned(&without) && !warned(&with));
    // A run in the plane of rotation, in which nothing twists, is not warned; one that leaves it is.
    let run = |reading: &Reading| {
        reading.case.unused_by_run().iter().any(|w| w.contains("`rotary-inertia = true`"))
    };
    let pushed = without.with(&["load=[{on='beam.tip', force=[0, 0, 1]}]".to_owned()]).unwrap();
    assert!(run(&pushed) && !run(&without) && !run(&with));
    let frequencies = frequencies(&with.case, 100.0).0;
    assert!(frequencies.iter().any(|x| (x / 143.931 - 1.0).abs() < 1e-4), "{frequencies:?}");
}

/// What a section leaves unsaid vibrates in no model: the modes in space are those of the exact coupling in the plane, all of them and no
/// others, at any angle and with a hub that is free.
#[test]
fn a_section_silent_on_torsion_has_the_modes_in_the_plane_alone() {
    let short = |more: &str| {
        read(&format!(
            "run = {{ duration = 1 }}\nbeam.length = 1\nbasis.elements = 6\nsection = {{ kind = \"resultants\", mass-per-length = 1, \
             axial-stiffness = 1e4, bending-stiffness = 1 }}\n{more}"
        ))
    };
    let all = |reading: &Reading, coupling: &str, speed: f64| {
        let case = reading.with(&[format!("model.coupling={coupling}")]).unwrap().case;
        let (mut system, _) = case.vibrating(speed > 0.0).unwrap();
        let mut state = system.initial();
        rotate_stably(system.as_mut(), &mut state, 0.0, speed).unwrap();
        modes(system.as_mut(), &state, 1000, &[]).unwrap().modes
    };
    for (more, speed) in [
        ("hub.radius = 0.2\nhub.motion = { kind = \"constant\", speed = 0 }", 0.0),
        ("hub.motion = { kind = \"constant\", speed = 0 }", 3.0),
        ("[[mass]]\non = \"tip\"\nmass = 0.5", 2.0),
    ] {
        let reading = short(more);
        let (plane, space) = (all(&reading, "exact", speed), all(&reading, "space", speed));
        assert_eq!(plane.len(), space.len(), "{more}");
        for (a, b) in plane.iter().zip(&space) {
            let (a, b) = (a.frequency(), b.frequency());
            // Elements of another form: their frequencies differ as their errors do.
            assert!((a / b - 1.0).abs() < 1e-5, "{more}: {a} and {b}");
        }
    }
    let free = short("[hub]\ninertia = 2\nmotion = { kind = \"free\", angle = 0.7 }");
    let found = all(&free, "space", 0.0);
    assert!(found.iter().all(|mode| mode.shares.flap + mode.shares.torsion + mode.shares.z < 1e-12));
    assert_eq!(found.iter().filter(|mode| mode.frequency() == 0.0).count(), 1);
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
    let diagram = campbell(read(text).case.vibrating(true).unwrap().0, None, &plan, 1, &|_, _| true).unwrap();
    assert_eq!(diagram.instabilities, []);
    assert!(diagram.branches.iter().flat_map(|b| &b.points).all(|p| p.mode.damping_ratio().abs() < 1e-7));
}

/// A slender shaft on two bearings, with ρA = L = 1 and the bending stiffnesses 1 and `across`.
fn shaft(across: f64, left: &str) -> Reading {
    read(&format!(
        "[rotation]\naxis = [1, 0, 0]\n[[beam]]\nname = \"shaft\"\nlength = 1\nup = [0, 0, 1]\nelements = 16\npolar-inertia = 1e-9\n\
         section = {{ kind = \"general\", mass-per-length = 1, axial-stiffness = 1e6, torsional-stiffness = 1, \
         bending-stiffness = 1, bending-stiffness-across = {across} }}\n\
         [[joint]]\nbetween = [\"ground\", \"shaft.root\"]\n{left}\n\
         [[joint]]\nkind = \"spherical\"\nbetween = [\"ground\", \"shaft.tip\"]\n"
    ))
}

/// ωₙ of a beam on two supports, ρA = EI = L = 1.
fn simply_supported(n: u32) -> f64 {
    (f64::from(n) * std::f64::consts::PI).powi(2)
}

/// In the rotating frame the whirls of a round shaft have the frequencies |ωₙ ± Ω|: beyond the critical speed both of a pair have
/// one shape, and the lines of different pairs cross.
#[test]
fn the_whirls_of_a_round_shaft_are_followed_past_its_critical_speeds() {
    let left = "kind = \"universal\"\naxis = [1, 0, 0]\nacross = [0, 0, 1]";
    let reading = shaft(1.0, left);
    let speeds: Vec<f64> = (0..=12).map(|i| 5.0 * f64::from(i)).collect();
    let plan = Plan { speeds, count: 4, stations: vec![], hub: HubState::Held, revolutions: 2 };
    let system = reading.case.vibrating(true).unwrap().0;
    let diagram = campbell(system, None, &plan, 1, &|_, _| true).unwrap();
    let mut expected = Vec::new();
    for (pair, n) in [(0, 1), (2, 2)] {
        let whirl = |sign: f64| move |speed: f64| (simply_supported(n) + sign * speed).abs();
        let [forward, backward] = [whirl(-1.0), whirl(1.0)];
        let fits = |branch: usize, frequency: &dyn Fn(f64) -> f64| {
            let points = diagram.branches[branch].points.iter();
            points.clone().count() == diagram.speeds.len()
                && points.clone().all(|p| (p.mode.frequency() - frequency(p.speed)).abs() < 1e-2)
        };
        assert!(
            fits(pair, &forward) && fits(pair + 1, &backward)
                || fits(pair, &backward) && fits(pair + 1, &forward)
        );
        // |ω − Ω| = kΩ at ω/(1 + k), and ω + Ω = kΩ at ω/(k − 1).
        let at = [1.0 / 2.0, 1.0 / 3.0, 1.0].map(|part| part * simply_supported(n));
        expected.extend(at);
    }
    expected.sort_by(f64::total_cmp);
    let found: Vec<f64> = diagram.crossings.iter().map(|crossing| crossing.speed).collect();
    assert!(found.len() == expected.len() && close(&found, &expected, 1e-3), "{found:?} for {expected:?}");
    // Each of the crossings of two lines, Ω = (ω₂ − ω₁)/2 and (ω₂ + ω₁)/2, takes 1/8192 of the range.
    assert!(diagram.speeds.len() < 13 + 4 * 13, "{} speeds", diagram.speeds.len());
}

/// A shaft with two bending stiffnesses is unstable between its first two critical speeds, and stable beyond, with the frequencies
/// ω⁴ − (ω_a² + ω_b² + 2Ω²) ω² + (ω_a² − Ω²)(ω_b² − Ω²) = 0, also where nothing holds its rotation about its axis.
#[test]
fn a_flat_shaft_is_stable_below_and_above_both_critical_speeds() {
    let reading = shaft(9.0, "kind = \"spherical\"");
    let (a, b) = (simply_supported(1).powi(2), 9.0 * simply_supported(1).powi(2));
    // Below and above the first of both planes, π² and 3π², and below the second of the softer one, 4π².
    for speed in [5.0, 35.0_f64] {
        let (found, _) = frequencies(&reading.case, speed);
        let square = speed * speed;
        let (half, product) = (0.5 * (a + b + 2.0 * square), (a - square) * (b - square));
        let root = (half * half - product).sqrt();
        let expected = [(half - root).sqrt(), (half + root).sqrt()];
        let there = |x: &f64| found.iter().any(|found| (found / x - 1.0).abs() < 1e-4);
        assert!(found[0] == 0.0 && expected.iter().all(there), "{found:?} for {expected:?}");
    }
    let (mut system, _) = reading.case.vibrating(true).unwrap();
    let mut state = system.initial();
    let refused = rotate_stably(system.as_mut(), &mut state, 0.0, 20.0).unwrap_err();
    assert!((refused.reached() / a.sqrt() - 1.0).abs() < 1e-4, "{refused}");
}

/// A part that spins against the frame, a joint that moves against it, and a frame about a joint inside the system are no steady state
/// of a system that rotates as a whole.
#[test]
fn a_motion_that_is_no_rotation_of_the_whole_system_is_refused_at_its_key() {
    let body = |name: &str, x: f64, more: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nmass = 2\nposition = [{x}, 0, 1]\n{more}\
             inertia = {{ kind = \"principal\", moments = [0.02, 0.02, 0.03] }}\n"
        )
    };
    let joint = |name: &str, kind: &str, parts: &str, axis: &str, more: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"{kind}\"\nbetween = {parts}\nat = [0, 0, 0]\naxis = {axis}\n{more}\n"
        )
    };
    let run = "run = { duration = 0 }\n";
    let ball = joint("ball", "spherical", "[\"ground\", \"top\"]", "[0, 0, 1]", "");
    let about_z = "[rotation]\naxis = [0, 0, 1]\n";
    let top = |spin: &str| format!("{run}{}{ball}", body("top", 0.0, &format!("spin = {spin}\n")));
    let refused = |text: &str| read(text).fits_modes().err().map(|problems| problems.to_string());
    let message = refused(&top("[0, 0, 200]")).unwrap();
    assert!(message.contains("spin") && message.contains("steady rotation of the whole system"), "{message}");
    // About the axis of the rotation it is that of the whole system, which `--speed` replaces.
    let whole = format!("{}{about_z}", top("[0, 0, 200]"));
    assert_eq!((refused(&whole), read(&whole).case.rotates_at()), (None, Some(200.0)));
    assert!(refused(&format!("{}{about_z}", top("[0, 10, 200]"))).is_some());

    let rotor = |motion: &str| {
        let main = joint("main", "revolute", "[\"nacelle\", \"rotor\"]", "[1, 0, 0]", motion);
        let tower = joint("tower", "spherical", "[\"ground\", \"nacelle\"]", "[0, 0, 1]", "");
        format!("{run}{}{}{tower}{main}", body("nacelle", 0.0, ""), body("rotor", 1.0, ""))
    };
    let message = refused(&rotor("motion = { kind = \"constant\", speed = 10 }")).unwrap();
    assert!(message.contains("`main` has a speed at the start"), "{message}");
    assert_eq!(refused(&rotor("")), None);
    let about = format!("{}[rotation]\nabout = \"main\"\n", rotor(""));
    let problems = parse(about, Path::new("case.toml"), &[]).unwrap_err().to_string();
    assert!(problems.contains("`main` is not a joint with the ground"), "{problems}");
}

/// ζ = ½ η ω at rest, of beams with and without shear, with an axis of rotation and with joints that say a thing twice: a system that is
/// made anew from its model has its damping once.
#[test]
fn damping_of_the_stiffness_counts_once_however_often_a_system_is_made() {
    let ratios = |shear: bool, more: &str| {
        let case = read(&format!(
            "run = {{ duration = 0 }}\nmodel.drop-redundant-rows = true\n[[beam]]\nlength = 2\nup = [0, 0, 1]\nroot = \"clamped\"\nshear = {shear}
            poisson-ratio = 0.3\ndamping = {{ stiffness = 1e-3 }}
            section = {{ kind = \"rectangle\", modulus = 70e9, density = 2700, width = 0.01, height = 0.02, rotary-inertia = true }}\n{more}"
        ))
        .case;
        let (mut system, _) = case.vibrating(false).unwrap();
        let mut state = system.initial();
        if more.contains("axis") {
            rotate_stably(system.as_mut(), &mut state, 0.0, 0.0).unwrap();
        }
        let found = modes(system.as_mut(), &state, 4, &[]).unwrap().modes;
        found.iter().map(|mode| mode.damping_ratio() / (0.5e-3 * mode.eigenvalue.norm())).collect::<Vec<_>>()
    };
    let again = "[[joint]]\nname = \"again\"\nkind = \"fixed\"\nbetween = [\"ground\", \"beam.root\"]\n";
    let axis = "[rotation]\naxis = [0, 0, 1]\n";
    for shear in [false, true] {
        for more in ["", axis, again, &format!("{again}{axis}")] {
            let found = ratios(shear, more);
            assert!(found.iter().all(|ratio| (ratio - 1.0).abs() < 1e-6), "{shear} {more}: {found:?}");
        }
    }
}

/// A strip pitched by 30° vibrates across its flat side: wholly so in the axes of its sections, sin² 30° of it in the plane of rotation, and the rest out
/// of it.
#[test]
fn the_shares_of_a_pitched_strip_are_those_of_its_sections_and_of_the_rotor() {
    for shear in [false, true] {
        let case = read(&format!(
            "run = {{ duration = 0 }}\n[rotation]\naxis = [0, 0, 1]\n[[beam]]\nlength = 5\nup = [0, {}, {}]\nroot = \"clamped\"\nshear = {shear}\npoisson-ratio = 0.3\n\
             section = {{ kind = \"rectangle\", modulus = 70e9, density = 2700, width = 0.02, height = 0.2 }}\n",
            30_f64.to_radians().cos(),
            30_f64.to_radians().sin(),
        ))
        .case;
        let (mut system, _) = case.vibrating(true).unwrap();
        let state = system.initial();
        let shares = modes(system.as_mut(), &state, 1, &[]).unwrap().modes[0].shares;
        let [tangent, height, across] = shares.section;
        assert!((across - 1.0).abs() < 1e-9 && tangent.abs().max(height.abs()) < 1e-9, "{shares:?}");
        assert!((shares.chord - 0.25).abs() < 1e-9 && (shares.flap - 0.75).abs() < 1e-9, "{shares:?}");
    }
}

/// xᵀKx of bent beams with and without shear in rotation, with joints, springs and loads: K as it is assembled, and with its strains summed one by one.
#[test]
fn the_strains_of_a_motion_make_the_form_of_the_stiffness_in_space() {
    let case = read(
        "run = { duration = 0 }\ngravity = [0, 0, -9.81]\n[rotation]\naxis = [0, 0, 1]\n\
         [[beam]]\nname = \"slender\"\nlength = 1\nstart = [0.1, 0, 0]\nup = [0, 0, 1]\nelements = 4\npolar-inertia = 1e-3\nroot = \"clamped\"\n\
         damping = { stiffness = 1e-3 }\n\
         section = { kind = \"general\", mass-per-length = 1, axial-stiffness = 1e3, torsional-stiffness = 1, bending-stiffness = 1, bending-stiffness-across = 9 }\n\
         [[beam]]\nname = \"sheared\"\nlength = 1\nstart = [1.1, 0, 0]\ndirection = [1, 1, 0.5]\nup = [0, 0, 1]\nelements = 2\nshear = true\nroot = \"free\"\n\
         damping = { stiffness = 1e-3 }\n\
         section = { kind = \"general\", mass-per-length = 1, axial-stiffness = 1e3, torsional-stiffness = 1, bending-stiffness = 1, bending-stiffness-across = 9, \
         shear-stiffness = 200, shear-stiffness-across = 300, rotary-inertia = 1e-3, rotary-inertia-across = 1e-3 }\n\
         [[joint]]\nkind = \"fixed\"\nbetween = [\"slender.tip\", \"sheared.root\"]\n\
         [[spring]]\nkind = \"line\"\nbetween = [\"slender@0.5 m\", \"sheared.tip\"]\nstiffness = 20\nlength = 0.3\n\
         [[load]]\non = \"sheared.tip\"\nforce = [0, 0.3, 0]\naxes = \"follower\"\n",
    )
    .case;
    let (mut system, _) = case.vibrating(true).unwrap();
    let mut state = system.initial();
    rotate_stably(system.as_mut(), &mut state, 0.0, 1.5).unwrap();
    let n = state.v.len();
    // Bent further, so that every term of the second variation of the strain energy counts.
    let bent: Vec<f64> = (0..n).map(|i| 0.1 * (i as f64).sin()).collect();
    let from = state.q.clone();
    system.retract(&from, &bent, &mut state.q);
    let mut stiffness = Matrix::new(&system.structure(0));
    system.tangent(&state, Weights::new(0.0, 0.0, 1.0), &mut stiffness);
    let vectors: Vec<Vec<f64>> = (1..5).map(|k| (0..n).map(|i| ((k * i) as f64).cos()).collect()).collect();
    let forms = system.stiffness_forms(&state, &vectors).unwrap();
    let mut product = vec![0.0; n];
    for (x, form) in vectors.iter().zip(forms) {
        stiffness.multiply(x, &mut product);
        let (expected, size) =
            (dot(x, &product), x.iter().zip(&product).map(|(x, p)| (x * p).abs()).sum::<f64>());
        assert!((form.value - expected).abs() < 1e-12 * size, "{form:?} for {expected}");
    }
}

/// A wire of steel of 1 mm, 100 m long: L²GA/EI is 10¹¹ and hides bending in an assembled stiffness, but not in its strains.
#[test]
fn the_frequencies_of_a_wire_with_shear_are_those_of_bending() {
    for (radius, elements, tolerance) in [(5e-4, 12, 1e-4), (5e-4, 60, 1e-3), (1e-4, 12, 1e-3)] {
        let case = read(&format!(
            "run = {{ duration = 0 }}\n[[beam]]\nlength = 100\nup = [0, 1, 0]\nroot = \"clamped\"\nshear = true\nelements = {elements}\n\
             section = {{ kind = \"circle\", modulus = 200e9, density = 7850, radius = {radius} }}\n[rotation]\naxis = [0, 0, 1]\n"
        ))
        .case;
        let (mut system, _) = case.vibrating(false).unwrap();
        let state = system.initial();
        let found = modes(system.as_mut(), &state, 3, &[]).unwrap().modes;
        let unit = radius / 2.0 * (200e9_f64 / 7850.0).sqrt() / 1e4;
        for (mode, root) in found.iter().zip([3.516015268500612, 3.516015268500612, 22.034491564668223]) {
            let expected = root * unit;
            assert!(
                (mode.frequency() / expected - 1.0).abs() < tolerance,
                "{radius} {elements}: {} for {expected}",
                mode.frequency()
            );
            assert!(mode.rounding < 0.1);
        }
    }
}

/// A thread of 40 µm × 10 µm that rotates slowly: what the forces of its equilibrium leave makes no rigid motion of its bending.
#[test]
fn a_thread_with_shear_that_rotates_bends_and_is_no_rigid_body() {
    let found = |shear: bool| {
        let case = read(&format!(
            "run = {{ duration = 0 }}\n[[beam]]\nlength = 10\nup = [0, 1, 0]\nroot = \"clamped\"\nshear = {shear}\nelements = 12\n\
             section = {{ kind = \"rectangle\", modulus = 70e9, density = 2700, width = 1e-5, height = 4e-5, rotary-inertia = true }}\n\
             [rotation]\naxis = [0, 0, 1]\n"
        ))
        .case;
        let (mut system, _) = case.vibrating(true).unwrap();
        let mut state = system.initial();
        rotate_stably(system.as_mut(), &mut state, 0.0, 2e-4).unwrap();
        modes(system.as_mut(), &state, 3, &[]).map(|found| found.modes[0].frequency())
    };
    let (slender, shear) = (found(false).unwrap(), found(true));
    assert!(
        shear.clone().is_err() || (shear.clone().unwrap() / slender - 1.0).abs() < 0.02,
        "{slender} {shear:?}"
    );
}

/// Where rounding leaves nothing of a frequency, it is no motion without stiffness: the slenderness is the cause, and without shear it is computed.
#[test]
fn a_beam_too_slender_for_its_shear_is_refused_with_the_cause() {
    let found = |shear: bool| {
        let case = read(&format!(
            "run = {{ duration = 0 }}\n[[beam]]\nname = \"wire\"\nlength = 100\nup = [0, 1, 0]\nroot = \"clamped\"\nshear = {shear}\nelements = 12\n\
             section = {{ kind = \"circle\", modulus = 200e9, density = 7850, radius = 1e-5 }}\n"
        ))
        .case;
        let (mut system, _) = case.vibrating(false).unwrap();
        let state = system.initial();
        modes(system.as_mut(), &state, 3, &[])
    };
    let refused = found(true).unwrap_err().to_string();
    assert!(
        refused.contains("beam `wire` is so slender") && refused.contains("`shear = false`"),
        "{refused}"
    );
    let unit = 1e-5 / 2.0 * (200e9_f64 / 7850.0).sqrt() / 1e4;
    let first = found(false).unwrap().modes[0].frequency();
    assert!((first / (3.516015268500612 * unit) - 1.0).abs() < 1e-5, "{first}");
}

/// C = ηK damps the vibration ω by ηω/2 and lets those beyond 2/η only decay, λ = −ηω²/2 ± iω√(1 − η²ω²/4), most with rates next to 1/η: the
/// vibrations that are left are found, as many as there are.
#[test]
fn of_strongly_damped_beams_the_vibrations_that_are_left_are_found() {
    let found = |shear: bool, eta: f64, count: usize| {
        let case = read(&format!(
            "run = {{ duration = 0 }}\n[[beam]]\nlength = 5\nup = [0, 1, 0]\nroot = \"clamped\"\nshear = {shear}\npoisson-ratio = 0.3\n\
             damping = {{ stiffness = {eta} }}\n\
             section = {{ kind = \"rectangle\", modulus = 70e9, density = 2700, width = 0.1, height = 0.2 }}\n"
        ))
        .case;
        let (mut system, _) = case.vibrating(false).unwrap();
        let state = system.initial();
        modes(system.as_mut(), &state, count, &[]).unwrap()
    };
    for shear in [true, false] {
        let undamped: Vec<f64> = found(shear, 0.0, 12).modes.iter().map(|mode| mode.frequency()).collect();
        for (eta, count) in [(3e-3, 6), (1e-2, 6), (0.03, 4), (0.03, 10), (0.3, 6), (1.0, 6)] {
            let left: Vec<f64> = undamped.iter().copied().filter(|omega| eta * omega < 2.0).collect();
            let damped = found(shear, eta, count).modes;
            assert_eq!(damped.len(), left.len(), "shear {shear}, η = {eta}: {left:?}");
            for (mode, omega) in damped.iter().zip(left) {
                let zeta = 0.5 * eta * omega;
                let expected = omega * (1.0 - zeta * zeta).sqrt();
                assert!(
                    (mode.frequency() / expected - 1.0).abs() < 1e-5,
                    "{} for {expected}",
                    mode.frequency()
                );
                assert!(
                    (mode.damping_ratio() / zeta - 1.0).abs() < 1e-5,
                    "{} for {zeta}",
                    mode.damping_ratio()
                );
            }
        }
    }
}

/// A strip of EI₃/GJ ≫ 1 that rotates: the tension stiffens its torsion without shear, by about as much as the caution with shear says.
#[test]
fn a_thin_strip_with_shear_is_warned_of_the_trapeze_effect_that_it_lacks() {
    let case = |shear: bool, width: f64| {
        read(&format!(
            "run = {{ duration = 0 }}\n[rotation]\naxis = [0, 0, 1]\n[[beam]]\nname = \"strip\"\nlength = 10\nup = [0, 0, 1]\nroot = \"clamped\"\n\
             shear = {shear}\nelements = 20\nsection = {{ kind = \"rectangle\", modulus = 70e9, density = 2700, width = 0.01, height = {width}, \
             rotary-inertia = true }}\n"
        ))
        .case
    };
    assert_eq!(case(true, 1.0).without_trapeze(0.0), Vec::<String>::new());
    assert_eq!(case(true, 0.02).without_trapeze(5.0), Vec::<String>::new());
    assert_eq!(case(false, 1.0).without_trapeze(5.0), Vec::<String>::new());
    let [caution] = &case(true, 1.0).without_trapeze(5.0)[..] else { panic!() };
    let said: f64 = caution.split("lie about ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let torsion = |shear: bool| {
        let (mut system, _) = case(shear, 1.0).vibrating(true).unwrap();
        let mut state = system.initial();
        rotate_stably(system.as_mut(), &mut state, 0.0, 5.0).unwrap();
        let found = modes(system.as_mut(), &state, 8, &[]).unwrap().modes;
        found.iter().find(|mode| mode.shares.torsion > 0.5).unwrap().frequency()
    };
    let off = 100.0 * (torsion(false) / torsion(true) - 1.0);
    assert!(said > 2.0 && (0.5..2.0).contains(&(said / off)), "{said} {off}: {caution}");
}

/// Of so few elements all motions are soon found, and what rounding leaves of them is no further one: of 600 speeds some had a mode next to zero, of which the
/// diagram ended.
#[test]
fn nothing_is_found_beyond_all_motions_of_a_few_elements() {
    for elements in [2, 3, 4] {
        let text = format!(
            "[beam]\nlength = 1\n[section]\nkind = 'resultants'\nmass-per-length = 1\naxial-stiffness = 1e4\nbending-stiffness = 1\n\
             [hub]\ninertia = 1\nmotion = {{ kind = 'constant', speed = 0 }}\n[model]\ncoupling = 'space'\n[basis]\nelements = {elements}\n"
        );
        let speeds = (0..200).map(|k| 6.0 * f64::from(k) / 199.0).collect();
        let plan = Plan { speeds, count: 10, stations: Vec::new(), hub: HubState::Held, revolutions: 0 };
        let system = read(&text).case.vibrating(true).unwrap().0;
        let diagram = campbell(system, None, &plan, 1, &|_, _| true).unwrap();
        let first = &diagram.branches[0].points;
        assert!(first.len() == 200 && first.iter().all(|point| point.mode.frequency() > 3.5), "{elements}");
    }
}
