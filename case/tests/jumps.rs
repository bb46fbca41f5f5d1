//! Jumps of motions and loads: a prescribed speed that jumps strikes the beam, and no method crosses a step load unseen.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{P1_BEAM as BEAM, finished, outcome, reading, reading_of};
use flexion_case::{Run, parse};
use flexion_results::Status;
use std::ops::ControlFlow;
use std::path::Path;

fn run(case: &str, changes: &[&str]) -> Run {
    let changes: Vec<String> = changes.iter().map(|c| (*c).to_owned()).collect();
    let reading = parse(format!("{BEAM}{case}"), Path::new("case.toml"), &changes)
        .unwrap_or_else(|problems| panic!("{problems}"));
    let run = reading.prepare().unwrap_or_else(|problems| panic!("{problems}"));
    run.run(&mut |_| ControlFlow::Continue(()))
}

/// Largest absolute value of a column.
fn peak(run: &Run, column: &str) -> f64 {
    let values = run.trajectory.column(column).unwrap();
    values.into_iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

fn last(run: &Run, column: &str) -> f64 {
    *run.trajectory.column(column).unwrap().last().unwrap()
}

fn jump(formula: &str, of: &str) -> String {
    format!(
        "[hub]\ninertia = 10\n[hub.motion]\nkind = 'expression'\nof = '{of}'\nformula = '{formula}'\n[run]\nduration = 2\n\
         [output]\nstep = 0.01\n"
    )
}

/// A speed that jumps right after t = 0 strikes as one that jumps a nanosecond later; a step to it would be divided by next to nothing.
#[test]
fn a_speed_that_jumps_at_once_strikes_the_beam() {
    for integrator in ["{kind=\"radau\"}", "{kind=\"newmark\",step=1e-3}"] {
        let integrator = format!("integrator={integrator}");
        let peak_of = |formula: &str| {
            let run = run(&jump(formula, "speed"), &[&integrator]);
            assert_eq!(run.status, Status::Finished, "{formula}: {:?}", run.message);
            peak(&run, "tip.deflection")
        };
        let expected = peak_of("if(t<1e-9,0,0.1)");
        for formula in ["if(t>0,0.1,0)", "if(t>1e-300,0.1,0)", "if(t<=0,0,0.1)"] {
            let found = peak_of(formula);
            assert!((found / expected - 1.0).abs() < 1e-6, "{integrator} {formula}: {found} for {expected}");
        }
    }
}

/// A speed that jumps, an angle with a kink and a speed that rises within half a millisecond are the same blow.
#[test]
fn a_speed_that_jumps_strikes_the_beam() {
    let smooth = jump("0.25*(1+tanh((t-1)/0.0005))", "speed");
    for coupling in ["first", "exact"] {
        let model = format!("model.coupling={coupling}");
        let smooth = run(&smooth, &[&model]);
        let expected = peak(&smooth, "tip.deflection");
        assert!(expected > 1.0, "{expected}");
        for integrator in ["{kind=\"radau\"}", "{kind=\"newmark\",step=1e-3}"] {
            let integrator = format!("integrator={integrator}");
            for (formula, of) in [("if(t<1,0,0.5)", "speed"), ("0.25*(abs(t-1)+t-1)", "angle")] {
                let struck = run(&jump(formula, of), &[&model, &integrator]);
                assert_eq!(struck.status, Status::Finished, "{:?}", struck.message);
                let found = peak(&struck, "tip.deflection");
                assert!(
                    (found / expected - 1.0).abs() < 3e-3,
                    "{coupling} {integrator} {of}: {found} for {expected}"
                );
                let imbalance = peak(&struck, "energy.balance") / peak(&struck, "energy.total");
                assert!(imbalance < 1e-3, "{coupling} {integrator}: {imbalance:e}");
                assert!(
                    struck.warnings.iter().all(|w| !w.contains("energy has grown")),
                    "{:?}",
                    struck.warnings
                );
            }
        }
    }
}

/// Kelvin and Voigt's damping answers a jump of the root's speed with a torque in proportion to the number of elements, and the run says so.
#[test]
fn a_damped_beam_that_is_struck_says_that_its_torque_is_one_of_the_mesh() {
    let damping = "damping={stiffness=0.02}";
    let struck = |set: &[&str]| run(&jump("if(t<1,0,0.5)", "speed"), &[set, &["output.step=1"]].concat());
    for coupling in ["first", "exact", "space"] {
        let model = format!("model.coupling={coupling}");
        let torque = |elements: u32| {
            let run =
                struck(&[damping, &model, &format!("basis={{kind='finite-elements',elements={elements}}}")]);
            let told = |w: &String| {
                w.contains("jumps at t = 1.000000 s") && w.contains("grow with the number of elements")
            };
            assert!(run.warnings.iter().any(told), "{coupling}: {:?}", run.warnings);
            run.trajectory.extremes(run.trajectory.index("hub.torque").unwrap()).max
        };
        let ratio = torque(20) / torque(10);
        assert!((ratio - 2.0).abs() < 0.02, "{coupling}: {ratio}");
    }
    let told = |run: &Run| run.warnings.iter().any(|w| w.contains("grow with the number of elements"));
    assert!(!told(&struck(&[])));
    assert!(!told(&run(&jump("0.25*(1+tanh((t-1)/0.1))", "speed"), &[damping])));
}

/// The blow is an angular impulse: before it nothing moves, and behind it the beam has the momentum M v of a beam that
/// stands still in space while the hub rotates, J Δω.
#[test]
fn the_momentum_behind_the_blow_is_that_of_the_hub() {
    let struck = run(&jump("if(t<1,0,0.5)", "speed"), &["run.duration=1.01", "output.step=1e-4"]);
    let momentum = struck.trajectory.column("hub.angular_momentum").unwrap();
    let (before, behind) = (momentum[9_999], momentum[10_001]);
    assert_eq!(before, 0.0);
    // 10 kg·m² · 0.5 rad/s, and what the clamp has given the beam in 0.1 ms.
    assert!((behind - 5.0).abs() < 0.5, "{behind}");
}

#[test]
fn an_angle_that_jumps_is_refused() {
    let case = format!("{BEAM}{}", jump("if(t<1,0,0.5)", "angle"));
    let problems = parse(case, Path::new("case.toml"), &[]).err().map(|p| p.to_string()).unwrap();
    assert!(problems.contains("jumps by 0.5 rad at t = 1 s"), "{problems}");
}

/// A torque of 1000 N·m·s that steps of fixed size would pass over or count ten times.
#[test]
fn short_step_loads_give_their_impulse_with_fixed_steps() {
    let case = "[hub]\ninertia = 1000\n[hub.motion]\nkind = 'free'\n\
                torque = { kind = 'expression', formula = 'if(t<1.03,0,if(t<1.07,25000,0))' }\n\
                [run]\nduration = 5\n[output]\nstep = 0.1\n";
    for integrator in
        ["{kind=\"newmark\",step=0.1}", "{kind=\"hht\",step=0.1}", "{kind=\"generalized-alpha\",step=0.1}"]
    {
        let run = run(case, &[&format!("integrator={integrator}")]);
        assert_eq!(run.status, Status::Finished, "{:?}", run.message);
        let momentum = last(&run, "hub.angular_momentum");
        assert!((momentum / 1000.0 - 1.0).abs() < 2e-3, "{integrator}: {momentum}");
    }
    let long = "[hub]\ninertia = 1000\n[hub.motion]\nkind = 'free'\n\
                torque = { kind = 'expression', formula = 'if(t<50,0,if(t<50.01,1e5,0))' }\n[run]\nduration = 100\n";
    let run = run(long, &["section.modulus=7e13", "integrator={kind=\"generalized-alpha\",step=0.1}"]);
    let momentum = last(&run, "hub.angular_momentum");
    // What is left is the method's error in vibrations that its steps do not resolve.
    assert!((momentum / 1000.0 - 1.0).abs() < 2e-3, "{momentum}");
}

/// Runs that an account of energy once stopped: they finish, and their balance closes.
#[test]
fn the_balance_closes_at_step_loads_and_at_smooth_ones() {
    let free = |formula: &str| {
        format!(
            "[hub]\ninertia = 1000\n[hub.motion]\nkind = 'free'\ntorque = {{ kind = 'expression', formula = '{formula}' }}\n\
             [run]\nduration = 2\n[output]\nstep = 0.01\n"
        )
    };
    let step = free("if(t<1.03,0,if(t<1.07,25000,0))");
    let smooth = free("25000*exp(-((t-1.05)/0.02256758)^2)");
    let cases = [
        (&step, "{kind=\"newmark\",step=1e-3}", 1e-3),
        (&step, "{kind=\"newmark\",step=1e-4}", 1e-5),
        (&smooth, "{kind=\"runge-kutta-4\",step=5e-5}", 1e-5),
        (&smooth, "{kind=\"radau\"}", 1e-4),
    ];
    for (case, integrator, allowed) in cases {
        let run = run(case, &[&format!("integrator={integrator}")]);
        assert_eq!(run.status, Status::Finished, "{integrator}: {:?}", run.message);
        let imbalance = peak(&run, "energy.balance") / peak(&run, "energy.total");
        assert!(imbalance < allowed, "{integrator}: {imbalance:e}");
    }
}

/// A controller turns a flexible arm: its reference begins to move at once, and stops at 0.52 s.
const ARM: &str = "
[[beam]]
name = 'arm'
length = 1
section = { kind = 'tube', modulus = 70e9, density = 2700, outer-radius = 15e-3, inner-radius = 13e-3 }
[[joint]]
name = 'motor'
kind = 'revolute'
between = ['ground', 'arm.root']
[joint.motion]
kind = 'free'
controller = { kind = 'pd', proportional = 400, derivative = 20, target = '45 deg', rate = 1.5 }
[run]
duration = 1
";

/// The torque of the controller jumps by 30 N·m on the root of the beam, whose mass is next to nothing: ½ h² q̈ is several radians. Methods of
/// the second order follow it, and converge.
#[test]
fn a_torque_that_jumps_on_little_mass_is_followed() {
    let angles = |integrator: &str| {
        let run = finished(&reading(ARM, &[&format!("integrator={integrator}")]));
        run.trajectory.column("motor.angle").unwrap()
    };
    let exact = angles("{kind='radau',tolerance=1e-9}");
    let off = |kind: &str, step: f64| {
        let found = angles(&format!("{{kind='{kind}',step={step}}}"));
        assert_eq!(found.len(), exact.len());
        found.iter().zip(&exact).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
    };
    for kind in ["generalized-alpha", "hht", "newmark"] {
        let errors = [2e-3, 1e-3, 5e-4].map(|step| off(kind, step));
        assert!(
            errors[2] < 2e-3 && errors.windows(2).all(|pair| pair[1] < 0.6 * pair[0]),
            "{kind}: {errors:?}"
        );
    }
}

/// P1 in space: rounding errors of the velocities of its hub grow from step to step where positions alone are held by a method without
/// dissipation, and the run ends. The message says so; what it recommends, runs.
#[test]
fn joints_that_come_loose_are_said_to() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/p1_spin_up_4/case.toml");
    let run = |integrator: &str| {
        outcome(&reading_of(&case, &["model.coupling=space", &format!("integrator={integrator}")]))
    };
    let loose = run("{kind='newmark',step=2e-3}");
    assert_eq!(loose.status, Status::Failed);
    let message = loose.message.unwrap();
    assert!(message.contains("`stabilized`") && !message.contains("smaller step"), "{message}");
    for held in ["{kind='newmark',step=2e-3,stabilized=true}", "{kind='generalized-alpha',step=2e-3}"] {
        let held = run(held);
        assert_eq!(held.status, Status::Finished, "{:?}", held.message);
        assert!((last(&held, "hub.speed") - 4.0).abs() < 1e-4);
    }
}
