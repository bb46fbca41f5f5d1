//! A beam released in modes of vibration about its equilibrium moves as these modes say.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{self, SQUARE_BAR};
use flexion::analysis::modes::{Mode, modes};
use flexion::analysis::rotation::rotate;
use flexion::system::State;
use flexion_case::{Reading, Run};

const REST: &str = r#"
[hub]
radius = 0.1
motion = { kind = "constant", speed = "6 rad/s" }
[model]
coupling = "exact"
[basis]
kind = "finite-elements"
elements = 3
[integrator]
kind = "radau"
tolerance = 1e-10
absolute-tolerance = 1e-14
[run]
duration = "0.5 s"
[output]
step = "0.005 s"
energy-balance = false
"#;

fn reading(set: &[&str]) -> Reading {
    written::reading(&[SQUARE_BAR, REST].concat(), set)
}

fn run(set: &[&str]) -> Run {
    written::finished(&reading(set))
}

fn refusal(set: &[&str]) -> String {
    match reading(set).prepare() {
        Err(problems) => problems.render(false),
        Ok(_) => panic!("{set:?} is accepted"),
    }
}

const TORQUE_FREE: &str = "hub={radius=0.1,inertia=2,motion={kind='free',speed=6}}";
const SPRING: &str = "hub={radius=0.1,inertia=2,motion={kind='free',angle=0.3,rest-angle=0.3,stiffness=900}}";
const DAMPED: &str = "damping={mass='0.5 1/s',stiffness='0.3 ms'}";

/// The modes of the case, found apart from its release.
fn modes_of(set: &[&str], speed: f64, free: bool, count: usize) -> Vec<Mode> {
    let case = reading(set).case;
    let mut system = case.system().unwrap();
    let mut state = State::zeros(system.size(), 0.0);
    if free {
        state.q = system.initial().q;
    }
    rotate(system.as_mut(), &mut state, 0.0, speed, &mut || true).unwrap();
    if free {
        system.hold(false);
        state.v = system.initial().v;
    }
    modes(system.as_mut(), &state, count, &[]).unwrap().modes
}

/// δ(t) = Re c e^{λt} with δ(0) = A and δ̇(0) = V, written as e^{σt} (A cos ωt + (V − σA)/ω sin ωt).
fn vibration(mode: &Mode, a: f64, v: f64, t: f64) -> f64 {
    let (decay, frequency) = (mode.eigenvalue.re, mode.eigenvalue.im);
    (decay * t).exp() * (a * (frequency * t).cos() + (v - decay * a) / frequency * (frequency * t).sin())
}

#[test]
fn every_coupling_vibrates_in_the_mode_in_which_it_is_released() {
    const A: f64 = 1e-6;
    const V: f64 = 3e-5;
    for coupling in ["model.coupling=first", "model.coupling=high", "model.coupling=exact"] {
        for (hub, speed, free, mode) in [
            ("hub.radius=0.1", 6.0, false, 1),
            (TORQUE_FREE, 6.0, true, 2),
            (SPRING, 0.0, true, 1),
            (SPRING, 0.0, true, 2),
        ] {
            for damping in [None, Some(DAMPED)] {
                let mut set = vec![coupling, hub];
                set.extend(damping);
                let all = modes_of(&set, speed, free, mode);
                let zeros = "0,".repeat(mode - 1);
                let initial =
                    format!("initial={{kind='modes',amplitudes=[{zeros}{A}],velocities=[{zeros}{V}]}}");
                set.push(&initial);
                let run = run(&set);
                let tip = run.trajectory.column("tip.deflection").unwrap();
                let expected = |t: f64| vibration(&all[mode - 1], A, V, t);
                let rest = tip[0] - A;
                let worst = run
                    .trajectory
                    .times()
                    .iter()
                    .zip(&tip)
                    .fold(0.0_f64, |worst, (t, tip)| worst.max((tip - rest - expected(*t)).abs()));
                eprintln!("{coupling} {hub} mode {mode} {}: {:.1e}", damping.is_some(), worst / A);
                // What is left is of second order in the vibration, 1e-6 of the beam.
                assert!(worst < 1e-4 * A, "{coupling} {hub} mode {mode}: {:.2e}", worst / A);
            }
        }
    }
}

/// A beam that bends without stretching is shortened by ½∫w′²: the energy of the release is that of bending, to second order, and
/// no axial vibration begins.
#[test]
fn a_release_of_one_hundredth_of_the_length_makes_no_axial_force() {
    let still = ["hub={radius=0.1,motion={kind='constant',speed=0}}", "run.duration=0"];
    let energy = |amplitude: f64| {
        let initial = format!("initial={{kind='modes',amplitudes=[{amplitude}]}}");
        let run = run(&[still[0], still[1], &initial]);
        let last = |name: &str| *run.trajectory.column(name).unwrap().last().unwrap();
        (last("energy.strain"), last("tip.deflection"), last("tip.axial"))
    };
    let length = reading(&still).case.size();
    let (small, ..) = energy(1e-6 * length);
    for part in [0.01, 0.1] {
        let (found, deflection, axial) = energy(part * length);
        let ratio = found / small * (1e-6 / part).powi(2);
        assert!((ratio - 1.0).abs() < 0.6 * part, "{part}: energy by {ratio}");
        assert!((deflection / (part * length) - 1.0).abs() < part * part, "{part}: tip at {deflection}");
        // The first mode: ½∫w′² = 0.581 A²/L.
        assert!((axial / (part * part * length) + 0.581).abs() < 0.01, "{part}: {axial}");
    }
}

#[test]
fn a_release_at_rest_is_the_equilibrium() {
    let still = run(&["initial={kind='modes',amplitudes=[0,0]}"]);
    let steady = run(&["initial.kind=steady-rotation"]);
    for (a, b) in still
        .trajectory
        .column("tip.axial")
        .unwrap()
        .iter()
        .zip(&steady.trajectory.column("tip.axial").unwrap())
    {
        assert_eq!(a, b);
    }
}

#[test]
fn what_does_not_vibrate_is_refused_with_what_to_do() {
    let refused = |set: &[&str], parts: &[&str]| {
        let report = refusal(set);
        for part in parts {
            assert!(report.contains(part), "`{part}` is not in: {report}");
        }
    };
    let one = "initial={kind='modes',amplitudes=['1 mm']}";
    refused(&[TORQUE_FREE, one], &["initial.amplitudes", "mode 1 is the rigid motion", "`hub.motion`"]);
    let velocity = "initial={kind='modes',velocities=['1 mm/s']}";
    refused(&[TORQUE_FREE, velocity], &["initial.velocities", "mode 1 is the rigid motion"]);
    let zeroth = ["model.coupling=zeroth", "hub.motion.speed=60"];
    refused(&[zeroth[0], zeroth[1], one], &["mode 1 does not vibrate, it", "an equilibrium that is stable"]);
    let many = format!("initial={{kind='modes',amplitudes=[{}'1 mm']}}", "0,".repeat(40));
    refused(&[&many], &["41 modes were asked for", "unknowns"]);
    let falling = "hub={inertia=1,motion={kind='free',angle='45 deg'}}";
    let gravity = "gravity=[0, '-9.81 m/s^2']";
    refused(&[falling, gravity, one], &["the free hub is not in equilibrium", "N·m is left"]);
    // Hanging, it is.
    run(&["hub={inertia=1,motion={kind='free',angle='-90 deg'}}", gravity, one, "run.duration=0.01"]);
    // A beam so stiff that the hub's spring alone gives.
    let stiff = ["section.modulus='7e20 Pa'", SPRING, one];
    refused(&stiff, &["mode 1 does not move the tip in the frame of the hub"]);
}

#[test]
fn a_pendulum_swings_in_its_modes_about_hanging() {
    let set = ["hub={inertia=1,motion={kind='free',angle='-90 deg'}}", "gravity=[0, '-9.81 m/s^2']"];
    let run = run(&[set[0], set[1], "initial={kind='modes',amplitudes=[0,'1 um']}"]);
    let tip = run.trajectory.column("tip.deflection").unwrap();
    // The second mode changes its sign within half a period, which is far shorter than a swing.
    let peak = tip.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    assert!(
        (tip[0] - 1e-6).abs() < 1e-10 && peak < 1.01e-6 && tip.iter().any(|x| *x < -0.9e-6),
        "{:.3e} {peak:.3e}",
        tip[0]
    );
}
