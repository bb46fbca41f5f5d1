//! Shafts, beams that spin about their own axes, and what a command says where it fails or rotates the other way.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::analysis::campbell::{Branch, Point};
use flexion::analysis::modes::Mode;
use flexion::analysis::rotation::rotate;
use flexion::system::Frame;
use flexion_case::{DiagramRequest, ModesRequest, Reading, parse};
use flexion_results::{Frequencies, Units};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Length, radius, modulus, density.
const SHAFT: [f64; 4] = [2.0, 0.05, 210e9, 7850.0];

/// A round shaft on pinned ends, which rotates about the axis of the case.
fn shaft(section: &str, axis: &str) -> Reading {
    shafts(&["s"], section, axis)
}

/// Several of them, on one line.
fn shafts(names: &[&str], section: &str, axis: &str) -> Reading {
    let [length, radius, modulus, density] = SHAFT;
    let mut text = format!("rotation = {{ axis = {axis} }}\nrun = {{ duration = 0 }}\n");
    for name in names {
        text += &format!(
            "[[beam]]\nname = '{name}'\nlength = {length}\nup = [0, 1, 0]\nroot = 'free'\nelements = 24\n\
             section = {{ kind = 'circle', modulus = {modulus}, density = {density}, radius = {radius}{section} }}\n\
             [[joint]]\nkind = 'spherical'\nbetween = ['ground', '{name}.root']\n\
             [[joint]]\nkind = 'spherical'\nbetween = ['ground', '{name}.tip']\n"
        );
    }
    read(text)
}

fn read(text: String) -> Reading {
    parse(text, Path::new("case.toml"), &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

fn request(speed: f64, count: usize) -> ModesRequest {
    let units = Units { speed: Frequencies::RADIANS, frequency: Frequencies::RADIANS };
    ModesRequest { speed, count, free_hub: false, units, film: false }
}

/// Frequencies [rad/s] of the vibrations and warnings.
fn modes(reading: &Reading, speed: f64, count: usize) -> (Vec<f64>, Vec<String>) {
    let found = reading.modes(&request(speed, count)).unwrap_or_else(|error| panic!("{error}"));
    let all = found.modes.modes.iter().map(Mode::frequency);
    (all.filter(|omega| *omega > 1.0).collect(), found.warnings)
}

/// Rayleigh's shaft: whirl at ω with ω² (1 + j₂ δ) − j₁ δ Ω ω = ω₀², δ = (i nπ/L)², where j₂ = 1 and j₁ = 2 are the moments of inertia in bending and about
/// the axis over ρI, seen from the shaft at |ω − Ω|.
fn rayleigh(speed: f64, inertia: [f64; 2]) -> Vec<f64> {
    let whirls = [1.0, 2.0].into_iter().flat_map(|n| [1.0, -1.0].map(|sign| whirl(n, sign, speed, inertia)));
    let mut all: Vec<f64> = whirls.collect();
    all.sort_by(f64::total_cmp);
    all
}

/// The n-th whirl, forward or backward by its sign.
fn whirl(n: f64, sign: f64, speed: f64, [polar, bending]: [f64; 2]) -> f64 {
    let [length, radius, modulus, density] = SHAFT;
    let (gyration, k) = (0.5 * radius, n * PI / length);
    let (delta, still) = ((gyration * k).powi(2), gyration * k * k * (modulus / density).sqrt());
    let (a, b) = (1.0 + bending * delta, 0.5 * polar * delta * speed);
    ((b + sign * (b * b + a * still * still).sqrt()) / a - speed).abs()
}

/// With its rotary inertia the shaft is Rayleigh's. Without it there is the polar moment alone, which is further from that than no moment at all, and a caution.
#[test]
fn a_shaft_without_rotary_inertia_in_bending_says_that_it_is_too_stiff() {
    for (section, inertia) in [(", rotary-inertia = true", [2.0, 1.0]), ("", [2.0, 0.0])] {
        let reading = shaft(section, "[1, 0, 0]");
        let (found, warnings) = modes(&reading, 200.0, 6);
        for (found, expected) in found.iter().zip(rayleigh(200.0, inertia)) {
            assert!((found / expected - 1.0).abs() < 1e-5, "{section}: {found} {expected}");
        }
        // δ/2 of the first: 0.08 %.
        let says = warnings
            .iter()
            .any(|text| text.contains("about n² × 0.08 %") && text.contains("`rotary-inertia`"));
        assert_eq!(says, inertia[1] == 0.0, "{warnings:?}");
        let of_run = reading.case.unused_by_run();
        assert_eq!(of_run.iter().any(|text| text.contains("spins about its own axis")), inertia[1] == 0.0);
    }
    assert!(rayleigh(200.0, [2.0, 1.0])[0] < 0.9999 * rayleigh(200.0, [2.0, 0.0])[0]);
    // A beam that turns across its axis has no such moment.
    let (_, warnings) = modes(&shaft("", "[0, 0, 1]"), 5.0, 2);
    assert!(!warnings.iter().any(|text| text.contains("spins about")), "{warnings:?}");
}

/// A joint that turns the beam about itself, and a spin at the start.
#[test]
fn a_run_of_a_shaft_that_is_turned_by_a_joint_has_the_caution() {
    let case = |axis: &str, spin: &str| {
        read(format!(
            "run = {{ duration = 1 }}\n[[beam]]\nname = 's'\nlength = 1\nup = [0, 1, 0]\nroot = 'free'\n{spin}\n\
             section = {{ kind = 'circle', modulus = 210e9, density = 7850, radius = 0.02 }}\n\
             [[joint]]\nname = 'a'\nkind = 'revolute'\nbetween = ['ground', 's.root']\naxis = {axis}\n{}",
            if spin.is_empty() { "motion = { kind = 'constant', speed = 50 }\n" } else { "" }
        ))
    };
    for (axis, spin, says) in
        [("[1, 0, 0]", "", true), ("[0, 0, 1]", "", false), ("[1, 0, 0]", "spin = [50, 0, 0]", true)]
    {
        let warnings = case(axis, spin).case.unused_by_run();
        assert_eq!(
            warnings.iter().any(|text| text.contains("spins about its own axis")),
            says,
            "{axis} {spin}: {warnings:?}"
        );
    }
}

/// M, D and K are symmetric but for the speed, which turns the sign of the rest: both senses have one spectrum.
#[test]
fn the_frequencies_of_a_rotation_are_those_of_its_other_sense() {
    let reading = shaft(", rotary-inertia = true", "[1, 0, 0]");
    let [forwards, backwards] = [200.0, -200.0].map(|speed| modes(&reading, speed, 6).0);
    for (a, b) in forwards.iter().zip(&backwards) {
        assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
    assert!(reading.modes(&request(f64::NAN, 2)).is_err());
}

/// Where modes, a start or the case itself is refused, the cautions of its deck are shown, which name the cause.
#[test]
fn a_refusal_shows_the_cautions_of_a_deck() {
    let folder = tempfile::tempdir().unwrap();
    let deck = |last: &str| {
        format!("x,mass,EA,GJ,EI-flap,EI-chord\n0,100,2e9,1e8,3e9,6e9\n30000,60,1e9,5e7,1e9,2e9\n{last}\n")
    };
    let case = |more: &str| {
        let text = format!(
            "rotation = {{ axis = [0, 0, 1] }}\n{more}\n[[beam]]\nname = 'b'\nroot = 'clamped'\nup = [0, 1, 0]\nstart = [1, 0, 0]\n\
             section = {{ kind = 'deck', file = 'd.csv', format = 'csv' }}\n"
        );
        parse(text, &folder.path().join("case.toml"), &[])
    };
    std::fs::write(folder.path().join("d.csv"), deck("60000,30,4e8,2e7,3e8,7e8")).unwrap();
    let reading = case("run = { duration = 0 }").unwrap_or_else(|problems| panic!("{problems}"));
    let message = reading.modes(&request(0.8, 2)).err().unwrap().to_string();
    assert!(message.contains("are its coordinates in metres?"), "{message}");
    // A twist with a digit too much turns an element by more than elements may turn.
    let twisted = "x,mass,EA,GJ,EI-flap,EI-chord,twist [deg]\n0,100,2e9,1e8,3e9,6e9,0\n30,60,1e9,5e7,1e9,2e9,4\n60,30,4e8,2e7,3e8,7e8,6122\n";
    std::fs::write(folder.path().join("d.csv"), twisted).unwrap();
    let message = case("run = { duration = 0 }").err().unwrap().to_string();
    assert!(message.contains("line 4 of d.csv: the twist reaches 6.1220e3°"), "{message}");
}

/// The unit √(EI/ρAL⁴) is known wherever there is one section.
#[test]
fn one_beam_in_space_has_frequencies_without_dimension() {
    let [length, radius, modulus, density] = SHAFT;
    let unit = shaft("", "[1, 0, 0]").case.dimensionless().unwrap();
    let expected = length * length / (0.5 * radius) * (density / modulus).sqrt();
    assert!((unit.factor / expected - 1.0).abs() < 1e-12, "{} {expected}", unit.factor);
}

/// Each branch of a shaft that is free to turn about itself is one whirl, seen from the shaft at |ω − Ω|, while others cross it and some pass
/// through zero; the rotation without stiffness, which G does not see, stays at zero throughout.
#[test]
fn the_branches_of_shafts_that_are_free_to_turn_are_their_whirls() {
    for names in [&["s"][..], &["s", "t"]] {
        let reading = shafts(names, ", rotary-inertia = true", "[1, 0, 0]");
        let units = Units { speed: Frequencies::RADIANS, frequency: Frequencies::RADIANS };
        let speeds = (0..=10).map(|i| 250.0 * f64::from(i)).collect();
        let (count, threads) = (8 * names.len(), 1);
        let request =
            DiagramRequest { speeds, count, revolutions: 1, margin: 5.0, free_hub: false, threads, units };
        let found = reading.campbell(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"));
        let branches = &found.campbell.branches;
        for turning in &branches[..names.len()] {
            assert!(
                turning.points.iter().all(|point| point.mode.frequency() == 0.0),
                "{:?}",
                frequencies(turning)
            );
        }
        let mut whirls = Vec::new();
        for n in [1.0, 2.0] {
            for sign in [1.0, -1.0] {
                whirls.push(move |speed| whirl(n, sign, speed, [2.0, 1.0]));
            }
        }
        for whirl in whirls {
            let off = |branch: &&Branch| {
                let off = |point: &Point| (point.mode.frequency() - whirl(point.speed)).abs();
                branch.points.len() == found.campbell.speeds.len()
                    && branch.points.iter().map(off).fold(0.0, f64::max) < 0.1
            };
            assert_eq!(branches.iter().filter(off).count(), names.len());
        }
    }
}

/// Frequencies [rad/s] at all speeds.
fn frequencies(branch: &Branch) -> Vec<f64> {
    branch.points.iter().map(|point| point.mode.frequency()).collect()
}

/// A rotation that is far beyond what the beam stands is searched by many levels of the loads, which are counted and can be stopped.
#[test]
fn the_search_for_a_steady_rotation_can_be_stopped() {
    let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../verification/space_air_bearing/case.toml");
    let heavy = ["beam[1].section.density=100000".to_owned()];
    let reading = parse(std::fs::read_to_string(&file).unwrap(), &file, &heavy)
        .unwrap_or_else(|problems| panic!("{problems}"));
    let asked = AtomicUsize::new(0);
    let request = DiagramRequest {
        speeds: vec![0.0, 1e4, 2e4],
        count: 4,
        revolutions: 0,
        margin: 5.0,
        free_hub: false,
        threads: 1,
        units: Units { speed: Frequencies::RADIANS, frequency: Frequencies::RADIANS },
    };
    let found = reading.campbell(&request, &|_, _| asked.fetch_add(1, Ordering::Relaxed) < 20).unwrap();
    assert!(asked.into_inner() < 24, "it ends where it is told to");
    assert_eq!(found.campbell.speeds, [0.0], "what was found is kept");
    assert!(found.incomplete.iter().any(|why| why.contains("stopped")), "{:?}", found.incomplete);
}

/// A table with stiffness in shear and none in torsion makes no beam with shear, which twists.
#[test]
fn no_stiffness_in_torsion_is_made_up_for_a_beam_with_shear() {
    let folder = tempfile::tempdir().unwrap();
    let columns =
        "x,mass,EA,EI-flap,EI-chord,GA-chord,GA-flap\n0,100,2e9,3e9,6e9,4e8,2e8\n30,60,1e9,1e9,2e9,2e8,1e8\n";
    std::fs::write(folder.path().join("d.csv"), columns).unwrap();
    let case = |shear: bool| {
        let text = format!(
            "rotation = {{ axis = [0, 0, 1] }}\nrun = {{ duration = 0 }}\n[[beam]]\nname = 'b'\nroot = 'clamped'\nup = [0, 1, 0]\n\
             start = [1, 0, 0]\nshear = {shear}\nsection = {{ kind = 'deck', file = 'd.csv', format = 'csv' }}\n"
        );
        parse(text, &folder.path().join("case.toml"), &[])
    };
    let refused = case(true).err().unwrap().to_string();
    assert!(refused.contains("says nothing of torsion") && refused.contains("GJ"), "{refused}");
    let held = case(false).unwrap_or_else(|problems| panic!("{problems}"));
    assert!(
        held.case.cautions.iter().any(|caution| caution.contains("its torsion is held")),
        "{:?}",
        held.case.cautions
    );
}

/// A thin round cantilever with EI = ρA = L = 1, parallel to the axis and beside it.
fn beside(distance: f64) -> Reading {
    let radius: f64 = 0.001;
    let (modulus, density) = (4.0 / (PI * radius.powi(4)), 1.0 / (PI * radius * radius));
    read(format!(
        "rotation = {{ axis = [1, 0, 0] }}\nrun = {{ duration = 0 }}\n[[beam]]\nname = 's'\nlength = 1\nstart = [0, 0, {distance}]\n\
         up = [0, 1, 0]\nroot = 'clamped'\nelements = 24\n\
         section = {{ kind = 'circle', modulus = {modulus}, density = {density}, radius = {radius} }}\n"
    ))
}

/// Branches, critical speeds and ranges near Ω of a diagram from rest to 8 rad/s.
fn diagram(reading: &Reading, speeds: usize) -> flexion_case::Diagram {
    diagram_at(reading, (0..speeds).map(|i| 8.0 * i as f64 / (speeds - 1) as f64).collect())
}

fn diagram_at(reading: &Reading, speeds: Vec<f64>) -> flexion_case::Diagram {
    let units = Units { speed: Frequencies::RADIANS, frequency: Frequencies::RADIANS };
    let request =
        DiagramRequest { speeds, count: 3, revolutions: 1, margin: 5.0, free_hub: false, threads: 1, units };
    reading.campbell(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"))
}

/// Beyond its critical speed a cantilever beside the axis has several equilibria: the one followed from rest is taken, whatever the speeds. The frequencies of 0.1 are those
/// of a program of its own by automatic differentiation of the energy, in 400 steps of the speed.
#[test]
fn the_equilibrium_followed_from_rest_does_not_depend_on_the_speeds() {
    for (distance, known) in
        [(0.03, None), (0.1, Some([2.805, 10.051, 25.39])), (0.3, None), (1e-5, None), (1e-8, None)]
    {
        let reading = beside(distance);
        let (expected, _) = modes(&reading, 8.0, 3);
        let expected: Vec<f64> = if distance < 0.01 { Vec::new() } else { expected };
        if let Some(known) = known {
            for (found, known) in expected.iter().zip(known) {
                assert!((found / known - 1.0).abs() < 5e-4, "{expected:?}");
            }
        }
        for speeds in [2, 3, 9] {
            let found = diagram(&reading, speeds).campbell;
            assert!(found.criticals.is_empty(), "{distance}, {speeds}: {:?}", found.criticals);
            let mut last: Vec<f64> =
                found.branches.iter().filter_map(|b| b.points.last()).map(|p| p.mode.frequency()).collect();
            last.sort_by(f64::total_cmp);
            for (found, expected) in last.iter().zip(&expected) {
                assert!((found / expected - 1.0).abs() < 1e-7, "{distance}, {speeds}: {last:?} {expected:?}");
            }
        }
    }
}

/// On the axis, but for rounding, it has its critical speed, once; its ranges near Ω are those of the closed forms |3.516 ± Ω| whatever the speeds.
#[test]
fn a_straight_shaft_has_one_critical_speed_and_the_ranges_of_its_whirls() {
    let first = 3.516015;
    for distance in [0.0, 1e-13, 1e-11] {
        for speeds in [2, 5, 17] {
            let found = diagram(&beside(distance), speeds);
            let [critical] = found.campbell.criticals.as_slice() else {
                panic!("{distance}, {speeds}: {:?}", found.campbell.criticals)
            };
            assert!((critical.speed / first - 1.0).abs() < 2e-6, "{distance}: {critical:?}");
            // The forward whirl ω₁ − Ω meets 0.95 Ω and 1.05 Ω.
            let [whirl] = found.resonances.as_slice() else { panic!("{:?}", found.resonances) };
            for (found, side) in [(whirl.from, 1.05), (whirl.to, 0.95)] {
                assert!((found * (1.0 + side) / first - 1.0).abs() < 1e-5, "{distance}, {speeds}: {whirl:?}");
            }
        }
    }
}

/// A strip held at both ends and beside the axis bends outwards beyond its critical speed. By collocation of von Kármán's equations its middle has three
/// equilibria there, 2.97e-2, −5.4e-3 and −2.47e-2: the last has a positive stiffness too, and is not that which is followed from rest.
#[test]
fn a_strip_held_at_both_ends_bends_outwards_whatever_the_speeds() {
    let speed = 51.4579;
    for shear in [false, true] {
        let reading = read(format!(
            "rotation = {{ axis = [0, 0, 1] }}\nrun = {{ duration = 0 }}\n[[beam]]\nname = 's'\nlength = 1\nstart = [3e-3, 0, 0]\n\
             direction = [0, 0, 1]\nup = [1, 0, 0]\nroot = 'clamped'\ntip = 'clamped'\nelements = 16\nshear = {shear}\npolar-inertia = 1e-9\n\
             section = {{ kind = 'general', mass-per-length = 1, axial-stiffness = 1e5, torsional-stiffness = 1, bending-stiffness = 1, \
             bending-stiffness-across = 20, {} }}\n",
            if shear {
                "shear-stiffness = 3e4, shear-stiffness-across = 3e4, rotary-inertia = 1e-5, rotary-inertia-across = 2e-4"
            } else {
                ""
            }
        ));
        let mut system = reading.case.vibrating(true).unwrap().0;
        let mut state = system.initial();
        rotate(system.as_mut(), &mut state, 0.0, speed, &mut || true).unwrap();
        let mut middle = [Frame::default()];
        let beam = system.drawn();
        system.frames(beam, &state, &[0.5], &mut middle);
        let deflection = middle[0].position.0[0] - 3e-3;
        // Shear makes it softer, and its critical speed lower.
        let bound = if shear { 0.05 } else { 0.01 };
        assert!((deflection / 2.97e-2 - 1.0).abs() < bound, "{shear}: {deflection}");
        let (expected, _) = modes(&reading, speed, 3);
        for speeds in [2, 3, 9] {
            let speeds = (0..speeds).map(|i| speed * f64::from(i) / f64::from(speeds - 1)).collect();
            let found = diagram_at(&reading, speeds).campbell;
            let mut last: Vec<f64> =
                found.branches.iter().filter_map(|b| b.points.last()).map(|p| p.mode.frequency()).collect();
            last.sort_by(f64::total_cmp);
            for (found, expected) in last.iter().zip(&expected) {
                assert!((found / expected - 1.0).abs() < 1e-7, "{shear}: {last:?} {expected:?}");
            }
        }
    }
}
