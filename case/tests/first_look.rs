//! Answers that were once wrong and called success: short loads, fast motions, tables, poles.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::P1_BEAM as BEAM;
use flexion_case::{Problems, Run, parse};
use flexion_results::Status;
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::path::Path;

fn attempt(changes: &[&str]) -> Result<Run, Problems> {
    let changes: Vec<String> = changes.iter().map(|c| (*c).to_owned()).collect();
    let reading = parse(BEAM.to_owned(), Path::new("case.toml"), &changes)?;
    Ok(reading.prepare()?.run(&mut |_| ControlFlow::Continue(())))
}

fn run(changes: &[&str]) -> Run {
    let run = attempt(changes).unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    run
}

fn column(run: &Run, name: &str) -> Vec<f64> {
    run.trajectory.column(name).unwrap()
}

/// Largest absolute value of a column.
fn peak(run: &Run, name: &str) -> f64 {
    column(run, name).into_iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

fn last(run: &Run, name: &str) -> f64 {
    *column(run, name).last().unwrap()
}

const STILL: &str = "hub={motion={kind='constant',speed=0}}";

#[test]
fn a_smooth_blow_is_seen_whatever_the_interval_of_recording() {
    let load =
        "load=[{on='10 m',force=[0,1000],amplitude={kind='expression',formula='exp(-((t-50.05)/0.005)^2)'}}]";
    let at = |step: &str| run(&[STILL, load, "run.duration=53", step]);
    let (coarse, fine) = (at("output.step=0.1"), at("output.step=0.01"));
    // The same blow as a step load that lasts as long as its impulse says.
    let length = 0.005 * PI.sqrt();
    let step = format!(
        "load=[{{on='10 m',force=[0,1000],amplitude={{kind='expression',formula='if(t<{},0,if(t<{},1,0))'}}}}]",
        50.05 - 0.5 * length,
        50.05 + 0.5 * length
    );
    let step = run(&[STILL, &step, "run.duration=53", "output.step=0.01"]);
    let (a, b, c) =
        (last(&coarse, "tip.deflection"), last(&fine, "tip.deflection"), last(&step, "tip.deflection"));
    assert!(peak(&fine, "tip.deflection") > 0.3);
    assert!((a - b).abs() < 1e-3 && (b - c).abs() < 0.05, "{a} {b} {c}");
}

#[test]
fn the_impulse_of_a_short_torque_is_its_integral() {
    for (torque, impulse) in
        [("1e5*exp(-((t-50)/0.005)^2)", 500.0 * PI.sqrt()), ("if(t < 50, 0, if(t < 50.001, 1e5, 0))", 100.0)]
    {
        let hub = format!(
            "hub={{inertia=1000,motion={{kind='free',torque={{kind='expression',formula='{torque}'}}}}}}"
        );
        let run = run(&[&hub, "section.modulus='70000 GPa'", "run.duration=60"]);
        let found = last(&run, "hub.angular_momentum");
        assert!((found - impulse).abs() < 1e-4 * impulse, "{torque}: {found} for {impulse}");
    }
}

#[test]
fn the_angle_of_a_fast_speed_is_its_integral() {
    let of = |formula: &str, duration: &str| {
        let hub = format!("hub={{inertia=10,motion={{kind='expression',of='speed',formula='{formula}'}}}}");
        run(&[&hub, &format!("run.duration={duration}")])
    };
    let wave = of("sin(100*t)", "60");
    for (t, angle) in wave.trajectory.times().iter().zip(column(&wave, "hub.angle")) {
        let exact = (1.0 - (100.0 * t).cos()) / 100.0;
        assert!((angle - exact).abs() < 1e-10, "{angle} for {exact} at {t}");
    }
    let pulse = of("2*exp(-((t-50.05)/0.005)^2)", "100");
    assert!((last(&pulse, "hub.angle") - 0.01 * PI.sqrt()).abs() < 1e-12);
    assert!(peak(&pulse, "hub.acceleration") > 0.0 && peak(&pulse, "tip.deflection") > 0.1);
}

#[test]
fn tables_stay_within_their_rows_and_a_spline_that_does_not_is_named() {
    let table = |interpolation: &str| {
        format!(
            "load=[{{on='10 m',force=[0,0.05],amplitude={{kind='table',times=[0,1,1.1,5,20],factors=[0,0,1,1,1]{interpolation}}}}}]"
        )
    };
    let with = |interpolation: &str| {
        run(&[STILL, &table(interpolation), "run.duration=20", "damping={stiffness=0.3}"])
    };
    // P L³/(3EI), and twice that at most for a load that acts at once.
    let fixed = 0.05 * 1000.0 / (3.0 * 70e9 * 2e-7);
    for interpolation in ["", ",interpolation='linear'", ",interpolation='monotone'"] {
        let run = with(interpolation);
        let found = column(&run, "tip.deflection");
        assert!(found.iter().all(|y| *y > -1e-3 * fixed && *y < 2.0 * fixed), "{interpolation}");
        assert_eq!(run.warnings, [] as [&str; 0]);
    }
    let spline = with(",interpolation='spline'");
    assert!(spline.warnings[0].contains("leaves the values of its rows"), "{:?}", spline.warnings);
}

#[test]
fn a_fixed_step_that_is_longer_than_a_change_of_the_load_is_named() {
    let hub = "hub={inertia=1000,motion={kind='free',torque={kind='expression',formula='1e5*exp(-((t-5.03)/0.005)^2)'}}}";
    let with =
        |step: &str| run(&[hub, "run.duration=6", &format!("integrator={{kind='newmark',step={step}}}")]);
    let warnings = with("0.1").warnings;
    assert!(warnings.iter().any(|w| w.contains("changes within") && w.contains("t = 5.0")), "{warnings:?}");
    let fine = with("1e-3");
    assert!(fine.warnings.iter().all(|w| !w.contains("changes within")), "{:?}", fine.warnings);
    assert!((last(&fine, "hub.angular_momentum") - 500.0 * PI.sqrt()).abs() < 1.0);
}

#[test]
fn poles_of_a_load_are_refused_and_integrable_slopes_are_not() {
    let load = |formula: &str| {
        let load = format!(
            "load=[{{on='beam',force-per-length=[0,1],distribution={{kind='expression',formula='{formula}'}}}}]"
        );
        attempt(&[STILL, &load, "run.duration=0", "initial.kind='static'", "model.coupling=zeroth"])
    };
    for formula in ["1/(x-3.3)", "tan(x)"] {
        let message = load(formula).err().unwrap().to_string();
        assert!(message.contains("beyond all bounds near x = "), "{message}");
    }
    let run = load("sqrt(1-(x/10)^2)").unwrap_or_else(|problems| panic!("{problems}"));
    // Torque on the hub: ∫ x √(1 − (x/L)²) dx = L²/3.
    let torque = last(&run, "hub.torque");
    assert!((torque + 100.0 / 3.0).abs() < 1e-6, "{torque}");
}

#[test]
fn a_narrow_load_and_a_section_that_jumps_need_no_fine_mesh() {
    let at = |changes: &[&str], elements: &str| {
        let common = [STILL, "beam.length=2", "run.duration=0", "initial.kind='static'", elements];
        last(&run(&[&common[..], changes].concat()), "tip.deflection")
    };
    let narrow = "load=[{on='beam',force-per-length=[0,1],distribution={kind='expression',formula='exp(-((x-1.03)/0.01)^2)'}}]";
    let jump = [
        "section={kind='piecewise',ends=[0.73,2],modulus=[7e10,7e10],density=[2700,2700],area=[4e-4,1e-4],second-moment=[1e-8,2e-10]}",
        "load=[{on='2 m',force=[0,1]}]",
    ];
    // w(L) = P a² (3L − a)/(6EI), and ∫ (L − x)²/EI dx.
    let (p, a, length) = (0.01 * PI.sqrt(), 1.03, 2.0_f64);
    let of_narrow = p * a * a * (3.0 * length - a) / (6.0 * 70e9 * 2e-7);
    let part = |from: f64, to: f64, ei: f64| ((length - from).powi(3) - (length - to).powi(3)) / (3.0 * ei);
    let of_jump = part(0.0, 0.73, 700.0) + part(0.73, 2.0, 14.0);
    for coupling in ["model.coupling=first", "model.coupling=high", "model.coupling=exact"] {
        for elements in ["basis.elements=10", "basis.elements=7", "basis.elements=200"] {
            let narrow = at(&[narrow, coupling], elements);
            assert!((narrow - of_narrow).abs() < 2e-4 * of_narrow, "{narrow} for {of_narrow}");
            let jump = at(&[jump[0], jump[1], coupling], elements);
            // The rest is the foreshortening of the lever.
            assert!((jump - of_jump).abs() < 2e-3 * of_jump, "{coupling} {elements}: {jump} for {of_jump}");
        }
    }
}

#[test]
fn the_axial_force_is_that_of_equilibrium_beside_a_jump_and_a_mass() {
    let run = run(&[
        "beam.length=2",
        "section={kind='piecewise',ends=[0.73,2],modulus=[7e10,2e11],density=[2700,7800],area=[4e-4,1e-4],second-moment=[1e-8,2e-9]}",
        "hub={radius=0.3,motion={kind='constant',speed=30}}",
        "initial.kind='steady-rotation'",
        "mass=[{on='1.5 m',mass=0.5}]",
        "run.duration=0",
        "output.section-forces=true",
        "output.stations=['0 m', '0.5 m', '0.73 m', '1 m', '1.4 m', '1.6 m']",
        "model.coupling=first",
    ]);
    // N(x) = Ω² ∫ₓᴸ ρA (a + ξ) dξ + Ω² m (a + x_m): displacements are below 10⁻⁴ of it.
    let tail = |from: f64, to: f64| 0.5 * ((0.3 + to).powi(2) - (0.3_f64 + from).powi(2));
    for x in [0.0_f64, 0.5, 1.0, 1.4, 1.6] {
        let mass = 1.08 * tail(x.min(0.73), 0.73) + 0.78 * tail(x.max(0.73), 2.0);
        let expected = 900.0 * (mass + if x < 1.5 { 0.5 * 1.8 } else { 0.0 });
        let found = last(&run, &format!("x={x}.axial_force"));
        assert!((found - expected).abs() < 5e-3 * expected, "{x}: {found} for {expected}");
    }
}

#[test]
fn the_extremes_of_a_vibration_do_not_depend_on_the_records() {
    let run =
        run(&[STILL, "initial={kind='modes',amplitudes=[0.1]}", "run.duration=20", "output.step=1.6545"]);
    let extremes = run.trajectory.extremes(run.trajectory.index("tip.deflection").unwrap());
    assert!((extremes.min + 0.1).abs() < 2e-4 && (extremes.max - 0.1).abs() < 2e-4, "{extremes:?}");
    assert!(run.trajectory.column("tip.deflection").unwrap().iter().all(|y| *y > 0.0));
}

#[test]
fn a_vibration_that_the_step_does_not_resolve_is_named() {
    let with = |step: &str| {
        let method = format!("integrator={{kind='newmark',step={step}}}");
        run(&[STILL, "initial={kind='modes',amplitudes=[0.01]}", "run.duration=20", &method]).warnings
    };
    assert!(with("0.7").iter().any(|w| w.contains("steps a period")), "{:?}", with("0.7"));
    assert_eq!(with("0.02"), [] as [&str; 0]);
}
