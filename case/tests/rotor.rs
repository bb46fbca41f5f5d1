//! Rotors that begin under gravity.

use crate::written::{finished, reading};
use flexion_case::Run;

/// A bar of the first frequency 6.28 rad/s; its hub rotates at Ω = 0.8 rad/s.
const ROTOR: &str = "
run = { duration = 15.71 }
beam = { length = 10 }
section = { kind = 'rectangle', height = 0.4, width = 0.05, modulus = 7e9, density = 3000 }
hub = { radius = 1, motion = { kind = 'constant', speed = 0.8 } }
initial.kind = 'steady-rotation'
gravity = [0, -1]
output.energy-balance = false
";

/// Deflection of a cantilever of this kind by 1 m/s² across, ρA L⁴/8EI.
const STATIC: f64 = 3000.0 * 1e4 / (8.0 * 7e9 * 0.4 * 0.4 / 12.0);

fn rotor(set: &[&str]) -> Run {
    finished(&reading(ROTOR, set))
}

#[test]
fn a_rotor_under_gravity_begins_in_the_motion_that_repeats_itself() {
    for coupling in ["first", "high", "exact", "space", "space-shear"] {
        for gravity in [[0.0, -1.0], [-1.0, 0.0], [0.6, 0.8]] {
            let [x, y] = gravity;
            let third = if coupling.starts_with("space") { ", 0" } else { "" };
            let coupling = format!("model.coupling={coupling}");
            let gravity = format!("gravity=[{x}, {y}{third}]");
            let run = |initial: &str| rotor(&[&coupling, &gravity, initial]);
            // A revolution is half of the run.
            let repeats = |run: &Run| {
                let w = run.trajectory.column("tip.deflection").unwrap();
                let half = w.len() / 2;
                let size = w.iter().fold(0.0_f64, |most, w| most.max(w.abs()));
                w.iter().zip(&w[half..]).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / size
            };
            let begun = run("initial.kind=steady-rotation");
            assert!(repeats(&begun) < 5e-3, "{coupling}, {gravity}: {:e}", repeats(&begun));
            let said = begun
                .warnings
                .iter()
                .any(|text| text.contains("gravity") && text.contains("periodic motion"));
            assert!(said, "{:?}", begun.warnings);
            let undeformed = run("initial.kind=undeformed");
            assert!(repeats(&undeformed) > 0.1, "{coupling}, {gravity}: {:e}", repeats(&undeformed));
        }
    }
}

/// Of a slow rotation, Ω/ω = 0.016, the deflection is that under the weight, and its velocity Ω times that a quarter of a revolution later.
#[test]
fn a_slow_rotor_follows_its_weight() {
    for coupling in ["model.coupling=first", "model.coupling=space"] {
        let third = if coupling.ends_with("space") { ", 0" } else { "" };
        for (x, y) in [(0, -1), (-1, 0)] {
            // So small that nothing of second order shows.
            let gravity = format!("gravity=[{}, {}{third}]", 0.1 * f64::from(x), 0.1 * f64::from(y));
            let run = rotor(&[coupling, &gravity, "hub.motion.speed=0.1", "run.duration=0"]);
            let of = |column: &str| run.trajectory.column(column).unwrap()[0];
            // In the hub's axes gravity rotates by −Ωt.
            let weight = 0.1 * STATIC;
            let (expected, rate) = (f64::from(y) * weight, -f64::from(x) * 0.1 * weight);
            let (w, v) = (of("tip.deflection"), of("tip.deflection_velocity"));
            assert!((w - expected).abs() < 2e-3 * weight, "{coupling}: {w} and not {expected}");
            assert!((v - rate).abs() < 2e-3 * 0.1 * weight, "{coupling}: {v} and not {rate}");
        }
    }
}

#[test]
fn a_rotor_on_a_spring_to_the_ground_begins_in_the_equilibrium_of_the_start_and_says_so() {
    let spring = "spring=[{kind='point',on='10 m',stiffness=100,to=[20, 0]}]";
    let run = rotor(&[spring, "run.duration=0", "gravity=[0, 0]"]);
    let text = run.warnings.join("\n");
    assert!(text.contains("springs to the ground") && text.contains("as they stand at the start"), "{text}");
}

/// A force of a fixed direction that changes its size has no motion that repeats itself with every revolution; one that changes later has.
#[test]
fn a_rotor_under_a_force_that_changes_with_time_does_not_begin_in_a_periodic_motion() {
    for coupling in ["model.coupling=exact", "model.coupling=space"] {
        let third = if coupling.ends_with("space") { ", 0" } else { "" };
        let said = |amplitude: &str| {
            let load = format!("load=[{{on='tip',force=[5, 0{third}],amplitude={amplitude}}}]");
            let gravity = format!("gravity=[0, -1{third}]");
            rotor(&[coupling, &load, &gravity, "run.duration=0"]).warnings.join("\n")
        };
        for changing in ["{kind='expression',formula='1+0.5*sin(5*t)'}", "{kind='ramp',time=100}"] {
            let said = said(changing);
            assert!(said.contains("changes its size within a revolution"), "{coupling} {changing}: {said}");
            assert!(said.contains("as they stand at the start"), "{coupling} {changing}: {said}");
        }
        // A revolution takes 7.85 s.
        for kept in ["'constant'", "{kind='table',times=[0, 10, 11],factors=[1, 1, 0]}"] {
            let said = said(kept);
            assert!(said.contains("begins in the periodic motion"), "{coupling} {kept}: {said}");
        }
    }
}

/// What the equilibrium leaves is none of the loads: the motion under a weight is in proportion to it, on any mesh.
#[test]
fn a_small_weight_and_a_fine_mesh_begin_in_the_periodic_motion() {
    for coupling in ["model.coupling=exact", "model.coupling=space"] {
        let third = if coupling.ends_with("space") { ", 0" } else { "" };
        let begun = |weight: f64, elements: u32| {
            let gravity = format!("gravity=[0, {weight}{third}]");
            let run = rotor(&[coupling, &gravity, &format!("basis.elements={elements}"), "run.duration=0"]);
            assert!(run.warnings.join("\n").contains("begins in the periodic motion"), "{:?}", run.warnings);
            run.trajectory.column("tip.deflection").unwrap()[0] / weight
        };
        let expected = begun(-0.1, 10);
        for (weight, elements) in [(-1e-3, 10), (-1e-5, 10), (-0.1, 60)] {
            let found = begun(weight, elements);
            assert!(
                (found / expected - 1.0).abs() < 2e-3,
                "{coupling} {weight} {elements}: {found} for {expected}"
            );
        }
    }
}

#[test]
fn a_periodic_motion_that_is_too_large_for_its_first_order_says_so() {
    let said = |speed: f64| {
        rotor(&["model.coupling=exact", &format!("hub.motion.speed={speed}"), "run.duration=0"])
            .warnings
            .join("\n")
    };
    assert!(!said(0.8).contains("no good approximation"));
    // Its first frequency grows with the speed: 7.06 rad/s is on the line.
    assert!((60..90).map(|k| said(0.1 * f64::from(k))).any(|text| text.contains("no good approximation")));
}
