//! Equilibria that rest on contacts without indentation.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{finished, reading};
use flexion::analysis::path::Plan;

/// A cantilever with EI = 350/3 N·m² and a weight of 5.2974 N/m; loads and contacts follow.
const CANTILEVER: &str = "
run = { duration = 0.01 }
beam = { length = 1 }
section = { kind = 'rectangle', modulus = 70e9, density = 2700, width = 0.02, height = 0.01 }
hub.motion = { kind = 'constant', speed = 0 }
basis = { kind = 'finite-elements', elements = 4 }
";
const STIFFNESS: f64 = 350.0 / 3.0;
const WEIGHT: f64 = 2700.0 * 2e-4 * 9.81;
const RIGID: &str = "law={kind='constraint',restitution=0}";

/// A column at the equilibria of the path, with their load factors.
fn path(text: &str, column: &str) -> Vec<(f64, f64)> {
    let path = reading(text, &[]).load_path(&Plan::to(1.0), |_, _| true).unwrap();
    assert_eq!(path.end, None);
    let i = path.channels.iter().position(|channel| channel.name == column).unwrap();
    path.points.iter().map(|point| (point.factor, point.values[i])).collect()
}

fn last(text: &str, column: &str) -> f64 {
    path(text, column).last().unwrap().1
}

fn near(x: f64, expected: f64, tolerance: f64) {
    assert!((x - expected).abs() < tolerance * expected.abs(), "{x} and not {expected}");
}

/// Force of a support under the middle, and the deflection of the tip.
fn supported() -> [f64; 2] {
    let a: f64 = 0.5;
    let sunk = WEIGHT * a * a * (6.0 - 4.0 * a + a * a) / (24.0 * STIFFNESS);
    let force = 3.0 * STIFFNESS * sunk / a.powi(3);
    [force, force * a * a * (3.0 - a) / (6.0 * STIFFNESS) - WEIGHT / (8.0 * STIFFNESS)]
}

#[test]
fn a_cantilever_rests_on_its_supports() {
    let [force, tip] = supported();
    let gravity = format!("{CANTILEVER}gravity = [0, -9.81]\n");
    let plane = "mount='hub',obstacle={kind='plane',point=[0,0]}";
    let middle = format!("{gravity}contact=[{{on='0.5 m',{plane},{RIGID}}}]\n");
    near(last(&middle, "contact.force"), force, 1e-5);
    near(last(&middle, "tip.deflection"), tip, 1e-5);
    // A support under the tip carries 3/8 of the weight; a tip without mass gives its own to the elements before it.
    let end = format!("{gravity}contact=[{{{plane},law={{kind='massless'}}}}]\n");
    near(last(&end, "contact.force"), 0.375 * WEIGHT, 2e-3);
    let space = format!(
        "run = {{ duration = 0 }}\ngravity = [0, 0, -9.81]\n[[beam]]\nlength = 1\nup = [0, 0, 1]\nroot = 'clamped'\nelements = 4\n\
         section = {{ kind = 'rectangle', modulus = 70e9, density = 2700, width = 0.02, height = 0.01 }}\n\
         [[contact]]\non = 'beam@0.5 m'\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\n{}\n",
        RIGID.replace('=', " = ")
    );
    near(last(&space, "contact.force"), force, 1e-5);
    near(last(&space, "beam.tip.displacement.z"), tip, 1e-5);
}

#[test]
fn a_run_that_begins_on_its_supports_stays_there() {
    let [force, tip] = supported();
    let text = format!(
        "{CANTILEVER}gravity = [0, -9.81]\ninitial.kind = 'static'\n\
         contact=[{{on='0.5 m',mount='hub',obstacle={{kind='plane',point=[0,0]}},{RIGID}}}]\n"
    );
    let run = finished(&reading(&text, &[]));
    assert_eq!(run.events.impacts().count(), 0, "{:?}", run.events);
    for (column, expected) in [("contact.force", force), ("tip.deflection", tip)] {
        run.trajectory.column(column).unwrap().iter().for_each(|x| near(*x, expected, 1e-5));
    }
}

/// A plane lifts the tip by 1 mm, and a force across by 2 mm: the plane's force falls to zero at half of the load.
#[test]
fn a_contact_opens_where_it_would_pull() {
    let force = 2e-3 * 3.0 * STIFFNESS;
    let text = format!(
        "{CANTILEVER}load=[{{on='1 m',force=[0,{force}]}}]\n\
         contact=[{{mount='hub',obstacle={{kind='plane',point=[0,1e-3]}},{RIGID}}}]\n"
    );
    let forces = path(&text, "contact.force");
    assert!(forces.iter().filter(|(factor, _)| *factor < 0.5).count() > 3, "{forces:?}");
    for (factor, x) in &forces {
        assert!((x - (0.5 - factor).max(0.0) * force).abs() < 1e-5 * force, "{forces:?}");
    }
    near(last(&text, "tip.deflection"), 2e-3, 1e-5);
}

/// The ground does not rotate with the hub.
#[test]
fn a_steady_rotation_does_not_rest_on_what_it_slides_off() {
    let text = format!(
        "{CANTILEVER}hub.motion.speed = 1\nload=[{{on='1 m',force=[0,-1],axes='follower'}}]\ninitial.kind = 'steady-rotation'\n\
         contact=[{{obstacle={{kind='plane',point=[0,0]}},{RIGID}}}]\n"
    )
    .replace("hub.motion = { kind = 'constant', speed = 0 }\nbasis", "hub.motion.kind = 'constant'\nbasis");
    let problems = reading(&text, &[]).prepare().map(drop).unwrap_err();
    assert!(problems.to_string().contains("rests on it must move with it"), "{problems}");
}
