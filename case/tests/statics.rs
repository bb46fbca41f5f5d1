//! Starts in equilibria that are not stable, and paths of equilibria.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written;
use flexion::analysis::modes::modes;
use flexion::analysis::path::{Critical, Plan};
use flexion::analysis::rotation::rotate_stably;
use flexion::analysis::stability;

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
[[force]]
station = "10 m"
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
             kind = \"finite-elements\"\nelements = 32\n[[force]]\nstation = 1.0\nforce = [{}, 0.0]\nframe = \"follower\"\n\
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
