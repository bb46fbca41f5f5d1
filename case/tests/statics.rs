//! Starts in equilibria that are not stable, and paths of equilibria.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written;
use flexion::analysis::modes::modes;
use flexion::analysis::path::{Critical, Plan};
use flexion::analysis::rotation::rotate_stably;
use flexion::analysis::stability;
use flexion_case::Effort;
use std::ops::ControlFlow;

/// P1's beam at rest under a dead force at its tip, 400 N along it and 1 N across: the load of Euler is 345 N.
const COLUMN: &str = r#"
[beam]
length = "10 m"
[section]
kind = "uniform"
modulus = "70 GPa"
density = "3000 kg/m^3"
area = "4 cm^2"
second-moment = "2e-7 m^4"
[hub]
motion = { kind = "constant", speed = 0 }
[model]
coupling = "exact"
[basis]
kind = "finite-elements"
elements = 10
[[load]]
on = "10 m"
force = ["-400 N", "1 N"]
[initial]
kind = "static"
[run]
duration = 0
"#;

#[test]
fn a_column_past_its_buckling_load_begins_bent_and_says_so() {
    let run = written::finished(&written::reading(COLUMN, &[]));
    let tip = run.trajectory.column("tip.deflection").unwrap()[0];
    // The elastica under 400/345.4 of the load of Euler, and a little more by the force across.
    assert!(tip > 5.9 && tip < 6.3, "{tip}");
    assert!(run.warnings.iter().any(|w| w.contains("first stable one on the path")), "{:?}", run.warnings);
    // Without large deflections nothing holds it.
    let run = written::finished(&written::reading(COLUMN, &["model.coupling=first"]));
    assert!(run.warnings.iter().any(|w| w.contains("unstable: 1 direction")), "{:?}", run.warnings);
}

/// Beck's column, EI = ρA = L = 1: flutter at 20.0509, and frequencies below by the determinant of its exact solution.
#[test]
fn becks_column_is_stable_up_to_its_flutter_load() {
    let text = |force: f64| {
        format!(
            "[beam]\nlength = 1.0\n[section]\nkind = \"resultants\"\nmass-per-length = 1.0\naxial-stiffness = 1e8\n\
             bending-stiffness = 1.0\nrotary-inertia = 0.0\n[hub]\n\
             motion = {{ kind = \"constant\", speed = 0 }}\n[model]\ncoupling = \"exact\"\n[basis]\n\
             kind = \"finite-elements\"\nelements = 32\n[[load]]\non = \"1 m\"\nforce = [{}, 0.0]\naxes = \"follower\"\n\
             [run]\nduration = \"0.1 s\"\n",
            -force
        )
    };
    let path = written::reading(&text(30.0), &[]).load_path(&Plan::to(1.0), |_, _| true).unwrap();
    let (point, critical) = path.critical().next().unwrap();
    assert_eq!(critical, Critical::Flutter);
    assert!((30.0 * point.factor / 20.0509 - 1.0).abs() < 1e-5, "{}", 30.0 * point.factor);
    for (force, expected) in [(5.0, &[4.2177][..]), (10.0, &[5.1758, 18.587])] {
        let mut system = written::reading(&text(force), &[]).case.system().unwrap();
        let mut state = system.initial();
        rotate_stably(system.as_mut(), &mut state, 0.0, 0.0).unwrap();
        assert!(stability(system.as_mut(), &state).unwrap().is_stable());
        let found = modes(system.as_mut(), &state, 2, &[]).unwrap();
        for (mode, expected) in found.modes.iter().zip(expected) {
            assert!((mode.frequency() / expected - 1.0).abs() < 3e-5, "{}", mode.frequency());
        }
    }
}

/// A couple π EI/L rolls a cantilever up to a half circle: its tip is at 2L/π across and −L along. The errors that `statics` states
/// cover those it has, and a mesh of two elements is told one that does.
#[test]
fn errors_of_a_path_are_stated() {
    // EI = 70 GPa · 20 mm · (5 mm)³/12
    let couple = std::f64::consts::PI * 70e9 * 0.02 * 0.005_f64.powi(3) / 12.0;
    let load = format!("[[load]]\non = '1 m'\ncouple = {couple}\n[run]\nduration = 0\n");
    let path = |elements: usize| {
        let set = format!("basis={{kind='finite-elements',elements={elements}}}");
        let (reading, plan) = (written::reading(&[written::STRIP, &load].concat(), &[&set]), Plan::to(1.0));
        let mut path = reading.load_path(&plan, |_, _| true).unwrap();
        let warning = reading.estimate_path_errors(&mut path, &plan, Effort::Auto, |_, _| true);
        assert_eq!((&path.end, &path.unknown), (&None, &None));
        let last = path.points.last().unwrap();
        for (column, exact) in [("tip.deflection", 2.0 / std::f64::consts::PI), ("tip.axial", -1.0)] {
            let at = path.channels.iter().position(|channel| channel.name == column).unwrap();
            let (off, stated) = ((last.values[at] - exact).abs(), last.error.as_ref().unwrap().values[at]);
            // EA stretches the beam by less than 1e-4 of its length, which is no error of the mesh.
            assert!(off <= stated + 1e-4 && stated < 8.0 * off + 1e-3, "{elements} {column}: {off} {stated}");
        }
        warning
    };
    let warning = path(2).unwrap();
    assert!(warning.contains("the mesh is coarse") && warning.contains("basis."), "{warning}");
    assert_eq!(path(16), None);
}

/// A follower force of 13 EI/L² on a cantilever in space, where it flutters: the search for a stable equilibrium can be stopped, and the
/// time that it takes is that of the run.
#[test]
fn a_search_for_a_stable_equilibrium_can_be_stopped() {
    let case = "
initial = { kind = 'static' }
run = { duration = 0 }
[[beam]]
length = 100
root = 'clamped'
section = { kind = 'general', mass-per-length = 1, axial-stiffness = 4.2e8, torsional-stiffness = 3e7, bending-stiffness = 3.5e7, bending-stiffness-across = 3.5e7 }
polar-inertia = 1
[[load]]
on = 'beam.tip'
force = [0, 129900, 0]
axes = 'follower'
";
    let reading = written::reading(case, &[]);
    let mut factors = Vec::new();
    let stopped = reading.prepare_watched(&mut |factor| {
        factors.push(factor);
        if factors.len() < 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let message = stopped.err().unwrap().list[0].message.clone();
    assert!(message.contains("stopped") && factors.len() == 20, "{message}");
    assert!(factors.windows(2).all(|pair| pair[1] > pair[0]), "{factors:?}");
    let run = written::finished(&reading);
    assert!(run.warnings.iter().any(|text| text.contains("flutter")), "{:?}", run.warnings);
    // Hundreds of equilibria of 66 unknowns take milliseconds at least.
    assert!(run.wall_time > 1e-3, "{}", run.wall_time);
}
