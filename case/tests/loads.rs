//! Equilibria under loads: buckling, rolling up, and a pendulum that hardly bends.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written;
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::stability;
use flexion_case::{Reading, parse};
use flexion_results::Status;
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;

/// The case of a folder of verification with some of its text changed.
fn reading(folder: &str, changes: &[(&str, &str)]) -> Reading {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification").join(folder).join("case.toml");
    let mut text = std::fs::read_to_string(&file).unwrap();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    parse(text, &file, &[]).unwrap_or_else(|p| panic!("{}", p.render(false)))
}

/// Whether a clamped beam under an axial dead force at its tip would leave its straight shape.
fn buckles(coupling: &str, force: f64) -> bool {
    let force = format!("force = [\"{} N\", \"0 N\"]", -force);
    let coupling = format!("\"{coupling}\"");
    let changes = [("force = [\"0 N\", \"1 kN\"]", force.as_str()), ("\"exact\"", coupling.as_str())];
    let reading = reading("elastica_tip_force", &changes);
    let mut system = reading.case.system().unwrap();
    let mut state = system.initial();
    equilibrium(system.as_mut(), &mut state).unwrap();
    !stability(system.as_mut(), &state).unwrap().is_stable()
}

#[test]
fn a_clamped_column_buckles_under_eulers_load() {
    // P = π² EI/(4 L²); the axis of this beam is compressed by 2e-7.
    let euler = PI * PI * 100.0 / 4.0;
    for coupling in ["first", "high", "exact"] {
        assert!(!buckles(coupling, (1.0 - 2e-6) * euler), "{coupling}");
        assert!(buckles(coupling, (1.0 + 2e-6) * euler), "{coupling}");
    }
    assert!(!buckles("zeroth", 2.0 * euler), "nothing shortens in the zeroth-order coupling");
}

#[test]
fn a_couple_rolls_a_cantilever_up_to_four_circles() {
    // 8π EI/L: the tip rotates by 8π and comes back to the clamp.
    let errors = [40, 80].map(|elements| {
        let elements = format!("elements = {elements}");
        let couple = format!("couple = \"{} N*m\"", 8.0 * PI * 100.0);
        let changes =
            [("elements = 80", elements.as_str()), ("couple = \"628.3185307179587 N*m\"", couple.as_str())];
        let run = reading("roll_up", &changes)
            .prepare()
            .unwrap_or_else(|p| panic!("{}", p.render(false)))
            .run(&mut |_| ControlFlow::Continue(()));
        assert_eq!(run.status, Status::Finished, "{:?}", run.message);
        let at_rest = |column| run.trajectory.column(column).unwrap()[0];
        [at_rest("tip.rotation") - 8.0 * PI, at_rest("tip.axial") + 1.0, at_rest("tip.deflection")]
    });
    for (coarse, fine) in errors[0].iter().zip(errors[1]) {
        assert!(fine.abs() < 2e-3, "{errors:?}");
        assert!((coarse / fine).log2() > 3.8, "{errors:?}");
    }
}

#[test]
fn a_pendulum_too_stiff_to_bend_may_swing_in_rough_steps() {
    // Its strain energy is a ten-millionth of what it exchanges with gravity.
    for method in ["newmark", "generalized-alpha", "hht"] {
        for coupling in ["first", "high", "exact"] {
            let coupling = format!("\"{coupling}\"");
            let integrator = format!("\"{method}\"\nstep = \"5 ms\"");
            let changes = [
                ("\"first\"", coupling.as_str()),
                ("\"radau\"\ntolerance = 1e-9\nabsolute-tolerance = 1e-12", integrator.as_str()),
            ];
            let run = reading("gravity_rigid_pendulum", &changes)
                .prepare()
                .unwrap_or_else(|p| panic!("{}", p.render(false)))
                .run(&mut |_| ControlFlow::Continue(()));
            assert_eq!(run.status, Status::Finished, "{method} {coupling}: {:?}", run.message);
            // θ at 2 s by elliptic functions.
            let end = run.trajectory.column("hub.angle").unwrap().last().copied().unwrap();
            assert!((end + 0.72996).abs() < 2e-3, "{method} {coupling}: {end}");
        }
    }
}

/// A static equilibrium alone: one record, and files like those of any run but for the figure.
#[test]
fn a_run_without_duration_is_its_initial_state() {
    for integrator in ["radau", "newmark", "runge-kutta-4"] {
        let step = if integrator == "radau" { "" } else { ",step='100 ns'" };
        let integrator = format!("{{kind='{integrator}'{step}}}");
        let set = ["run.duration=0".to_owned(), format!("integrator={integrator}"), "output={}".to_owned()];
        let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/elastica_tip_force");
        let reading = flexion_case::read(&case, &set).unwrap_or_else(|p| panic!("{}", p.render(false)));
        let run = reading.prepare().unwrap().run(&mut |_| ControlFlow::Continue(()));
        assert_eq!(run.status, Status::Finished, "{:?}", run.message);
        assert_eq!(run.trajectory.times(), [0.0]);
        assert!((run.trajectory.column("tip.deflection").unwrap()[0] - 0.810_609_69).abs() < 2e-6);
        let folder = tempfile::tempdir().unwrap();
        let directory = flexion_results::Directory::create(folder.path().join("results"), false).unwrap();
        reading.write(&run, &directory).unwrap();
        // Nothing can be drawn against a single time.
        assert!(!folder.path().join("results/plot.svg").exists());
        let again = flexion_case::read(&folder.path().join("results/case.resolved.toml"), &[]);
        assert_eq!(again.unwrap().case.duration, 0.0);
    }
}

/// A load far narrower than an element, P = 0.1 √π N at a = 0.4337 m beside 0.1 N/m, is whole in space as in the plane: the tip of the cantilever goes
/// q L⁴/8EI + P a² (3L − a)/6EI, shortened by its slope.
#[test]
fn a_load_narrower_than_an_element_is_whole_in_the_plane_and_in_space() {
    const BUMP: &str = "
[beam]
length = 1
[section]
kind = 'resultants'
mass-per-length = 1
axial-stiffness = 1e4
bending-stiffness = 1
[hub]
motion = { kind = 'constant', speed = 0 }
[[load]]
on = 'beam'
force-per-length = [0, 1]
distribution = { kind = 'expression', formula = '0.1+exp(-((x-0.4337)/0.0003)^2)*333.3333333333333' }
[initial]
kind = 'static'
[run]
duration = 0
";
    let tip = |coupling: &str| {
        let run = written::finished(&written::reading(BUMP, &[coupling]));
        run.trajectory.column("tip.deflection").unwrap()[0]
    };
    let (p, a) = (0.1 * PI.sqrt(), 0.4337);
    let known = 0.1 / 8.0 + p * a * a * (3.0 - a) / 6.0;
    for coupling in ["model.coupling=exact", "model.coupling=space"] {
        let tip = tip(coupling);
        assert!((tip / known - 1.0).abs() < 1e-3, "{coupling}: {tip} and {known}");
    }
}
