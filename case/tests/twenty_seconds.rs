//! What stays in twenty seconds: the balance of energy, the angular momentum, and the motion that a recorded torque gives.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written;
use flexion_case::Run;
use std::fmt::Write;
use std::path::Path;

/// A beam so soft that it swings by a fifth of its length, on a hub that is free to rotate.
const BASE: &str = r#"
[beam]
length = "2 m"
[section]
kind = "resultants"
mass-per-length = 1.2
axial-stiffness = 200.0
bending-stiffness = 8.0
[hub]
radius = 0.2
inertia = 3.0
motion = { kind = "free", speed = "1.5 rad/s" }
[basis]
kind = "finite-elements"
elements = 2
[initial]
kind = "modes"
velocities = [0, "1.6 m/s"]
[run]
duration = "20 s"
[output]
step = "0.1 s"
"#;

const COUPLINGS: [&str; 3] = ["first", "high", "exact"];

fn run_in(folder: &Path, set: &[&str]) -> Run {
    let file = folder.join("case.toml");
    std::fs::write(&file, BASE).unwrap();
    written::finished(&written::reading_of(&file, set))
}

fn run(set: &[&str]) -> Run {
    run_in(tempfile::tempdir().unwrap().path(), set)
}

fn column(run: &Run, name: &str) -> Vec<f64> {
    run.trajectory.column(name).unwrap()
}

fn largest(run: &Run, name: &str) -> f64 {
    column(run, name).iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// Largest change since the start over the value at the start.
fn drift(run: &Run, name: &str) -> f64 {
    let values = column(run, name);
    values.iter().fold(0.0_f64, |m, x| m.max((x / values[0] - 1.0).abs()))
}

#[test]
fn angular_momentum_and_energy_stay_without_torque() {
    for coupling in COUPLINGS {
        let model = format!("model.coupling={coupling}");
        for integrator in [
            // Relative to the angle of the hub, which grows: with 1e-11 the momentum drifts by 1e-10.
            "integrator={kind='radau',tolerance=1e-12,absolute-tolerance=1e-13}",
            "integrator={kind='runge-kutta-4',step='0.5 ms'}",
        ] {
            let run = run(&[&model, integrator]);
            let swing = largest(&run, "tip.deflection");
            let off = (drift(&run, "hub.angular_momentum"), drift(&run, "energy.total"));
            eprintln!(
                "{coupling} {integrator}: swing {swing:.2} m, momentum {:.1e}, energy {:.1e}",
                off.0, off.1
            );
            assert!(swing > 0.3, "{swing}");
            assert!(off.0 < 1e-10 && off.1 < 1e-9, "{coupling} {integrator}: {off:?}");
        }
    }
}

/// Motor, damper, spring, gravity, a follower force and material damping: every kind of power there is.
const DRIVEN: &[&str] = &[
    "hub={radius=0.2,inertia=3,motion={kind='free',damping=0.5,stiffness=4,torque={kind='expression',formula='3*sin(0.9*t)'}}}",
    "gravity=[0, '-2 m/s^2']",
    "load=[{on='2 m',force=[0.1,0.5],axes='follower',amplitude={kind='expression',formula='sin(1.1*t)'}}]",
    "damping={mass='0.05 1/s'}",
    "initial={kind='undeformed'}",
];

#[test]
fn the_balance_of_energy_closes_to_the_order_of_each_method() {
    for coupling in COUPLINGS {
        let model = format!("model.coupling={coupling}");
        let imbalance = |integrator: &str| {
            let mut set = vec![model.as_str(), integrator];
            set.extend(DRIVEN);
            let run = run(&set);
            for work in ["energy.loads", "energy.drive", "energy.dissipated"] {
                assert!(largest(&run, work) > 0.1, "{work}");
            }
            largest(&run, "energy.balance") / largest(&run, "energy.total")
        };
        for (method, step, order) in [
            ("newmark", 4e-3, 2.0),
            ("hht", 4e-3, 2.0),
            ("generalized-alpha", 4e-3, 2.0),
            ("runge-kutta-4", 4e-3, 4.0),
            ("adams-4", 5e-4, 4.0),
        ] {
            let at = |step: f64| imbalance(&format!("integrator={{kind='{method}',step={step}}}"));
            let (coarse, fine) = (at(step), at(0.5 * step));
            let measured = (coarse / fine).log2();
            eprintln!("{coupling} {method}: {coarse:.2e} {fine:.2e} of the energy, order {measured:.2}");
            assert!(measured > order - 0.35, "{coupling} {method}: {coarse:.2e} {fine:.2e}: {measured:.2}");
            assert!(fine < 1e-3, "{fine:.2e}");
        }
        // Steps are chosen by the error of the motion: the balance follows the tolerance.
        for tolerance in [1e-5, 1e-7, 1e-9] {
            let off = imbalance(&format!(
                "integrator={{kind='radau',tolerance={tolerance:e},absolute-tolerance={tolerance:e}}}"
            ));
            eprintln!("{coupling} radau: {off:.2e} of the energy at {tolerance:e}");
            assert!(off < 10.0 * tolerance, "{coupling} radau: {off:.2e} at {tolerance:e}");
        }
    }
}

#[test]
fn a_free_hub_under_the_torque_of_a_prescribed_motion_moves_as_prescribed() {
    for coupling in ["zeroth", "first", "high", "exact"] {
        let folder = tempfile::tempdir().unwrap();
        let common = [
            &format!("model.coupling={coupling}"),
            "initial={kind='undeformed'}",
            "integrator={kind='radau',tolerance=1e-10,absolute-tolerance=1e-12}",
            "output.step=0.01",
        ];
        // From rest and smoothly: a sudden start would be heard in the spline through the torque.
        let motion = "hub.motion={kind='expression',of='speed',formula='0.8*sin(0.15*t)^4'}";
        let prescribed = run_in(folder.path(), &[&common[..], &[motion]].concat());
        let mut table = "time [s],torque [N*m]\n".to_owned();
        for (t, torque) in prescribed.trajectory.times().iter().zip(column(&prescribed, "hub.torque")) {
            writeln!(table, "{t:?},{torque:?}").unwrap();
        }
        std::fs::write(folder.path().join("torque.csv"), table).unwrap();
        let motion =
            "hub.motion={kind='free',torque={kind='table',file='torque.csv',interpolation='spline'}}";
        let free = run_in(folder.path(), &[&common[..], &[motion]].concat());
        for name in ["hub.angle", "hub.speed", "tip.deflection", "tip.axial", "energy.total"] {
            let (a, b) = (column(&prescribed, name), column(&free, name));
            let peak = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let off = a.iter().zip(&b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs())) / peak;
            eprintln!("{coupling} {name}: {off:.1e} of {peak:.3}");
            assert!(off < 1e-6, "{coupling} {name}: {off:.2e} of {peak:.3}");
        }
    }
}
