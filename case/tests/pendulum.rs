//! A flexible beam that falls about a frictionless axis: the limit of a rigid rod, and how far the couplings part.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written;
use flexion::exact::pendulum::rod_angle;
use flexion_case::Run;
use flexion_results::Status;

/// The beam of Guo, Zhang & Chen 2017, doi:10.7498/aps.66.164501.
const BASE: &str = r#"
gravity = [0, "-9.81 m/s^2"]
[beam]
length = "1 m"
[section]
kind = "uniform"
modulus = "68.952 GPa"
density = "2766.7 kg/m^3"
area = "3.14e-4 m^2"
second-moment = "7.85e-9 m^4"
[hub]
motion = { kind = "free", angle = "45 deg" }
[basis]
kind = "finite-elements"
elements = 2
axial-degree = 2
[integrator]
tolerance = 1e-8
absolute-tolerance = 1e-12
[run]
duration = "0.5 s"
[output]
step = "0.005 s"
energy-balance = false
"#;

const COUPLINGS: [&str; 4] = ["zeroth", "first", "high", "exact"];
const ANGLES: [f64; 2] = [45.0, 0.0];

fn run(coupling: &str, degrees: f64, set: &[&str]) -> Run {
    let model = format!("model.coupling={coupling}");
    let angle = format!("hub.motion.angle='{degrees} deg'");
    written::finished(&written::reading(BASE, &[&[model.as_str(), &angle], set].concat()))
}

/// Largest difference of a column.
fn off(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

#[test]
fn a_stiff_beam_falls_like_the_rod_of_the_elliptic_functions() {
    for coupling in COUPLINGS {
        // A beam that does not bend falls alike in every coupling: one angle each, both for two of them.
        for &degrees in if ["first", "exact"].contains(&coupling) { &ANGLES[..] } else { &ANGLES[..1] } {
            let errors = ["1e5", "1e7", "1e9"].map(|stiffness| {
                let section = format!(
                    "section={{kind='resultants',mass-per-length=2,axial-stiffness=1e13,bending-stiffness={stiffness}}}"
                );
                let run = run(coupling, degrees, &[&section, "output.step=0.02"]);
                let rod: Vec<f64> = run
                    .trajectory
                    .times()
                    .iter()
                    .map(|t| rod_angle(degrees.to_radians(), 1.0, 9.81, *t))
                    .collect();
                off(&run.trajectory.column("hub.angle").unwrap(), &rod)
            });
            eprintln!("{coupling} from {degrees}°: {:.1e} {:.1e} {:.1e}", errors[0], errors[1], errors[2]);
            // Like 1/EI, down to the error of the steps.
            assert!(
                errors[0] < 1e-5 && errors[1] < 2e-2 * errors[0] + 1e-9,
                "{coupling} {degrees}: {errors:?}"
            );
            assert!(errors[2] < 1e-8, "{coupling} from {degrees}°: {errors:?}");
        }
    }
}

/// With a hub of a few per cent of the inertia of the beam, so that `first` keeps its positive kinetic energy.
#[test]
fn the_couplings_part_from_the_exact_one_with_the_deflection() {
    let common = ["hub.inertia=0.02", "integrator.tolerance=1e-7", "run.duration=0.4"];
    let column = |run: &Run, name: &str| run.trajectory.column(name).unwrap();
    for degrees in ANGLES {
        let measured = [30.0, 100.0].map(|softer| {
            let modulus = format!("section.modulus={:e}", 68.952e9 / softer);
            let with = |coupling: &str| run(coupling, degrees, &[&common[..], &[&modulus]].concat());
            let exact = with("exact");
            let bent = column(&exact, "tip.deflection").iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let apart = ["zeroth", "first", "high"].map(|coupling| {
                let other = with(coupling);
                off(&column(&other, "tip.deflection"), &column(&exact, "tip.deflection")) / bent
            });
            eprintln!("{degrees}° bent by {bent:.2e} m: {:.1e} {:.1e} {:.1e}", apart[0], apart[1], apart[2]);
            (bent, apart)
        });
        let [(_, stiff), (bent, soft)] = measured;
        // Zeroth lacks the stiffening (ω/ω₁)², whatever the deflection; the others terms of second order in it.
        assert!(soft[0] > 3.0 * soft[1] && soft[0] > 3.0 * soft[2], "{degrees}°: {soft:?}");
        assert!(soft[1] < 0.05 && soft[2] < 0.05 && bent > 0.01, "{degrees}°: {bent} {soft:?}");
        assert!(stiff[1] < soft[1] && stiff[2] < soft[2], "{degrees}°: {stiff:?} {soft:?}");
    }
}

#[test]
fn a_pendulum_that_loses_its_kinetic_energy_ends_with_the_reason() {
    // A fixed step may jump over the singularity: the loss is seen all the same.
    for integrator in ["integrator={kind='newmark',step='0.5 ms'}", "integrator={kind='hht',step='5 ms'}"] {
        let set = [
            "model.coupling=first",
            "section.modulus='689 MPa'",
            "hub.motion.angle=0",
            integrator,
            "basis.elements=10",
        ];
        let run = written::outcome(&written::reading(BASE, &set));
        assert_eq!(run.status, Status::Failed);
        let message = run.message.unwrap();
        assert!(message.contains("losing its positive kinetic energy"), "{integrator}: {message}");
        assert!(
            run.warnings.iter().any(|w| w.contains("keeps its kinetic energy positive")),
            "{:?}",
            run.warnings
        );
    }
}
