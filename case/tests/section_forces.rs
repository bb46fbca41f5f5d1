//! Section forces and strains at stations against closed forms, and the orders of their recovery.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written;
use std::ops::ControlFlow;

/// A beam in the static equilibrium of a hub that sets off with ω̇ = 0.01 rad/s²: under the load −ρA ω̇ x.
const SETTING_OFF: &str = r#"
title = "forces"
[beam]
length = 10
[section]
kind = "rectangle"
modulus = "70 GPa"
density = 3000
width = "5 mm"
height = "80 mm"
[hub]
motion = { kind = "ramp", speed = "4 rad/s", time = "400 s" }
[initial]
kind = "static"
[run]
duration = "0.01 s"
[output]
stations = ['0 m', '2.3 m', '5 m', '7.77 m']
section-forces = true
strain-heights = ["40 mm", "-10 mm"]
"#;

const LENGTH: f64 = 10.0;
const MASS: f64 = 3000.0 * 4e-4;
const ACCELERATION: f64 = 0.01;

/// The columns at t = 0.
fn first_row(set: &[&str]) -> impl Fn(&str) -> f64 + use<> {
    let reading = written::reading(SETTING_OFF, set);
    let prepared = reading.prepare().unwrap_or_else(|p| panic!("{}", p.render(false)));
    let run = prepared.run(&mut |_| ControlFlow::Break(()));
    move |name: &str| run.trajectory.column(name).unwrap_or_else(|| panic!("no column {name}"))[0]
}

const STATIONS: [(&str, f64); 5] =
    [("x=0", 0.0), ("x=2.3", 2.3), ("x=5", 5.0), ("x=7.77", 7.77), ("tip", LENGTH)];

/// Largest errors of moment and shear force over the stations, relative to their values at the root.
fn errors(set: &[&str]) -> (f64, f64) {
    let value = first_row(set);
    let load = MASS * ACCELERATION;
    let (mut moment_error, mut shear_error) = (0.0_f64, 0.0_f64);
    for (name, x) in STATIONS {
        let shear = -load * (LENGTH * LENGTH - x * x) / 2.0;
        let moment = -load * ((LENGTH.powi(3) - x.powi(3)) / 3.0 - x * (LENGTH * LENGTH - x * x) / 2.0);
        moment_error = moment_error.max((value(&format!("{name}.bending_moment")) - moment).abs());
        shear_error = shear_error.max((value(&format!("{name}.shear_force")) - shear).abs());
    }
    let root = load * LENGTH.powi(3) / 3.0;
    (moment_error / root, shear_error / (1.5 * root / LENGTH))
}

/// The mass per length m₀ + m₁ x of a tapered beam makes the load quadratic and the moment quartic:
/// M = −ω̇ [m₀ ((L³ − x³)/3 − x (L² − x²)/2) + m₁ ((L⁴ − x⁴)/4 − x (L³ − x³)/3)].
#[test]
fn the_bending_moment_is_recovered_to_order_four_and_the_shear_force_to_order_three() {
    let taper = "section={kind='tapered-rectangle',modulus='70 GPa',density=3000,root-width='5 mm',tip-width='2.5 mm',root-height='80 mm',tip-height='80 mm'}";
    // So slow that the exact coupling has nothing to correct.
    let slow = "hub.motion={kind='ramp',speed=4e-3,time=400}";
    let (m0, m1, acceleration) = (MASS, -0.5 * MASS / LENGTH, 1e-5);
    for coupling in ["model.coupling=first", "model.coupling=exact"] {
        let at = |n: usize| {
            let elements = format!("basis.elements={n}");
            let value = first_row(&[taper, slow, coupling, &elements]);
            let [l2, l3, l4] = [2, 3, 4].map(|k| LENGTH.powi(k));
            let (mut moment_error, mut shear_error) = (0.0_f64, 0.0_f64);
            for (name, x) in STATIONS {
                let [x2, x3, x4] = [2, 3, 4].map(|k| x.powi(k));
                let moment = m0 * ((l3 - x3) / 3.0 - x * (l2 - x2) / 2.0)
                    + m1 * ((l4 - x4) / 4.0 - x * (l3 - x3) / 3.0);
                let shear = m0 * (l2 - x2) / 2.0 + m1 * (l3 - x3) / 3.0;
                let off = |column: &str, expected: f64| {
                    (value(&format!("{name}.{column}")) / acceleration + expected).abs()
                };
                moment_error = moment_error.max(off("bending_moment", moment));
                shear_error = shear_error.max(off("shear_force", shear));
            }
            (moment_error / (m0 * l3), shear_error / (m0 * l2))
        };
        let (coarse, fine) = (at(4), at(8));
        let (moment, shear) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
        eprintln!(
            "{coupling}: moment {:.2e} {:.2e} order {moment:.2}, shear {:.2e} {:.2e} order {shear:.2}",
            coarse.0, fine.0, coarse.1, fine.1
        );
        assert!((moment - 4.0).abs() < 0.2, "{coupling}: {coarse:?} {fine:?}");
        assert!((shear - 3.0).abs() < 0.2, "{coupling}: {coarse:?} {fine:?}");
    }
}

/// Of a uniform beam the moment is cubic, and nothing is left but rounding.
#[test]
fn a_cubic_moment_is_recovered_without_error() {
    let (moment, shear) = errors(&["basis.elements=4"]);
    assert!(moment < 1e-9 && shear < 1e-9, "{moment:.2e} {shear:.2e}");
}

#[test]
fn smooth_bases_give_the_forces_close_around_the_station() {
    for basis in ["basis={kind='b-spline',elements=8,degree=5}", "basis={kind='bezier',degree=8}"] {
        let (moment, shear) = errors(&[basis]);
        eprintln!("{basis}: {moment:.2e} {shear:.2e}");
        assert!(moment < 1e-6 && shear < 1e-5, "{basis}: {moment:.2e} {shear:.2e}");
    }
}

/// A force P at x_P leaves the moment P ⟨x_P − x⟩. Both sides of it are recovered without error, up to the elements next to it;
/// at the force itself the forces are those behind it.
#[test]
fn on_either_side_of_a_point_load_the_forces_are_right_and_at_it_they_are_those_behind_it() {
    let (force, place) = (3.0, 6.0);
    let load = MASS * ACCELERATION;
    for elements in [10, 20] {
        let basis = format!("basis.elements={elements}");
        let stations = "output.stations=['0 m', '2.3 m', '5 m', '6 m', '7.77 m']";
        let value = first_row(&[&basis, stations, "load=[{on='6 m',force=[0,3],axes='hub'}]"]);
        for (name, x) in STATIONS.into_iter().chain([("x=6", place)]) {
            let (arm, part) = if x < place { (place - x, 1.0) } else { (0.0, 0.0) };
            let shear = force * part - load * (LENGTH * LENGTH - x * x) / 2.0;
            let moment = force * arm
                - load * ((LENGTH.powi(3) - x.powi(3)) / 3.0 - x * (LENGTH * LENGTH - x * x) / 2.0);
            let off = (value(&format!("{name}.bending_moment")) - moment).abs() / (force * LENGTH);
            let off_shear = (value(&format!("{name}.shear_force")) - shear).abs() / force;
            eprintln!("{elements} {name}: {off:.2e} {off_shear:.2e}");
            assert!(off < 1e-8 && off_shear < 1e-7, "{elements} {name}: {off:.2e} {off_shear:.2e}");
        }
    }
}

/// The torque on a hub without inertia of its own is the moment at the root; strains follow from the forces.
#[test]
fn the_root_moment_balances_the_torque_of_the_hub_and_strains_follow_hooke() {
    for coupling in ["model.coupling=first", "model.coupling=exact"] {
        let value = first_row(&[coupling]);
        let torque = MASS * ACCELERATION * LENGTH.powi(3) / 3.0;
        assert!((value("x=0.bending_moment") + torque).abs() < 1e-5 * torque);
        assert!((value("hub.torque") - torque).abs() < 1e-3 * torque, "{}", value("hub.torque"));
        let bending = 70e9 * 5e-3 * 0.08_f64.powi(3) / 12.0;
        for (name, y) in [("0.04", 0.04), ("-0.01", -0.01)] {
            let expected = -y * value("x=2.3.bending_moment") / bending;
            let strain = value(&format!("x=2.3.strain_y={name}"));
            assert!((strain - expected).abs() < 1e-3 * expected.abs(), "{strain} {expected}");
        }
    }
}

/// Steady rotation: EA u″ + ρAω²(x + u) = 0, N = EA (cos kx / cos kL − 1) with k = ω √(ρ/E).
#[test]
fn the_centrifugal_force_is_recovered_from_any_axial_field() {
    let speed = 2.0;
    let turning = ["hub.motion={kind='constant',speed=2}", "initial.kind=steady-rotation"];
    let error = |more: &[&str]| {
        let mut set = turning.to_vec();
        set.extend(more);
        let value = first_row(&set);
        let root = 0.5 * MASS * speed * speed * LENGTH * LENGTH;
        STATIONS.iter().fold(0.0_f64, |worst, (name, x)| {
            let k = speed * (3000.0_f64 / 70e9).sqrt();
            // cos kx − cos kL without cancellation.
            let sines = (0.5 * k * (LENGTH + x)).sin() * (0.5 * k * (LENGTH - x)).sin();
            let expected = 70e9 * 4e-4 * 2.0 * sines / (k * LENGTH).cos();
            worst.max((value(&format!("{name}.axial_force")) - expected).abs() / root)
        })
    };
    let (coarse, fine) = (error(&["basis.elements=8"]), error(&["basis.elements=16"]));
    let order = (coarse / fine).log2();
    eprintln!("linear: {coarse:.2e} {fine:.2e} order {order:.2}");
    assert!(fine < 1e-6 && (order > 1.8 || fine < 1e-9));
    let quadratic = error(&["basis={kind='finite-elements',elements=8,axial-degree=2}"]);
    let exact = error(&["basis.elements=8", "model.coupling=exact"]);
    eprintln!("quadratic: {quadratic:.2e}, exact: {exact:.2e}");
    assert!(quadratic < 1e-8, "{quadratic:.2e}");
    assert!(exact < 1e-5, "{exact:.2e}");
}
