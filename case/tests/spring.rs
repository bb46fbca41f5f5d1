//! A cantilever whose tip stands on a spring, against closed forms.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{SQUARE_BAR, finished, reading};
use flexion::analysis::modes::modes;
use flexion::system::State;

/// EI of the bar [N·m²], its mass per length [kg/m] and its length [m].
const EI: f64 = 7e9 * 0.02 * 0.02 * 0.02 * 0.02 / 12.0;
const MASS: f64 = 2700.0 * 4e-4;
const L: f64 = 2.0;
const STIFFNESS: f64 = 150.0;

const REST: &str = "[hub]\nradius = 0.3\nmotion = { kind = 'constant', speed = 0 }\n[run]\nduration = 0\n";

fn with_spring(change: &str) -> flexion_case::Reading {
    let text = format!(
        "{SQUARE_BAR}{REST}[[spring]]\nkind = 'point'\non = '2 m'\nstiffness = {STIFFNESS}\nto = [2.3, 0]\n"
    );
    reading(&text, &[change, "initial.kind=static"])
}

#[test]
fn a_force_at_the_tip_deflects_beam_and_spring_side_by_side() {
    // δ = P L³/(3 EI + k L³); cubic elements are exact under a force at the tip.
    for coupling in ["zeroth", "first", "high"] {
        let text = format!(
            "{SQUARE_BAR}{REST}[model]\ncoupling = '{coupling}'\n[[load]]\non = '2 m'\nforce = [0, 1e-3]\n"
        );
        let spring = format!("spring=[{{kind='point',on='2 m',stiffness={STIFFNESS},to=[2.3,0]}}]");
        let run = finished(&reading(&text, &["initial.kind=static", &spring]));
        let tip = run.trajectory.column("tip.deflection").unwrap()[0];
        let expected = 1e-3 * L.powi(3) / (3.0 * EI + STIFFNESS * L.powi(3));
        assert!((tip / expected - 1.0).abs() < 1e-8, "{coupling}: {tip} for {expected}");
    }
}

/// The lowest root z of 1 + cos z cosh z = κ/z³ (cos z sinh z − sin z cosh z), κ = k L³/EI.
fn lowest(kappa: f64) -> f64 {
    let f = |z: f64| 1.0 + z.cos() * z.cosh() - kappa / z.powi(3) * (z.cos() * z.sinh() - z.sin() * z.cosh());
    let (mut low, mut high) = (1.0, 3.9266);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 { high = middle } else { low = middle }
    }
    low
}

#[test]
fn a_spring_at_the_tip_raises_the_frequency_as_the_characteristic_equation_says() {
    for coupling in ["model.coupling=first", "model.coupling=exact"] {
        let mut system = with_spring(coupling).case.system().unwrap();
        let state = State::zeros(system.size(), 0.0);
        let found = modes(system.as_mut(), &state, 1, &[]).unwrap().modes[0].frequency();
        let z = lowest(STIFFNESS * L.powi(3) / EI);
        let expected = z * z * (EI / (MASS * L.powi(4))).sqrt();
        // Ten cubic elements: an error of order (z/10)⁴/720 of the frequency, some 10⁻⁵.
        assert!((found / expected - 1.0).abs() < 2e-5, "{coupling}: {found} for {expected}");
        assert!(z > 1.9, "the spring matters");
    }
}

#[test]
fn what_a_damper_loses_is_what_the_energy_lacks() {
    let text = format!(
        "{SQUARE_BAR}[hub]\nradius = 0.3\nmotion = {{ kind = 'spin-up', speed = 3, time = 0.5 }}\n[run]\nduration = 0.5\n\
         [[spring]]\nkind = 'point'\non = '2 m'\nstiffness = {STIFFNESS}\ndamping = 4\nto = [2.3, 0]\n"
    );
    for coupling in ["first", "exact"] {
        let set = [format!("model.coupling={coupling}"), "integrator.tolerance=1e-9".to_owned()];
        let run = finished(&reading(&text, &[&set[0], &set[1]]));
        let column = |name: &str| run.trajectory.column(name).unwrap();
        let lost = *column("energy.dissipated").last().unwrap();
        let balance = column("energy.balance").iter().fold(0.0, |worst: f64, x| worst.max(x.abs()));
        assert!(lost > 0.1, "{coupling}: {lost} J");
        // The errors of radau's steps, some 10⁻⁹ each.
        assert!(balance < 1e-5 * lost, "{coupling}: {balance} J of {lost} J");
    }
}
