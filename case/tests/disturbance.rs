//! Runs that keep a plane or an axis exactly say when a disturbance would lead them away.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::verification::run::case;
use crate::written;
use flexion_case::{Effort, Reading};
use flexion_results::{Errors, Unstable};
use std::ops::ControlFlow;

fn errors(reading: &Reading) -> Errors {
    let run = written::outcome(reading);
    reading.estimate_errors(&run, Effort::Full, &mut |_| ControlFlow::Continue(()))
}

fn unstable(text: &str, overrides: &[&str]) -> Option<Unstable> {
    let errors = errors(&written::reading(text, overrides));
    let warned = errors.warnings.iter().any(|warning| warning.contains("the motion is unstable"));
    assert_eq!(warned, errors.unstable.is_some(), "{:?}", errors.warnings);
    errors.unstable
}

/// A free body with the moments 1, 2, 3 kg m² spins about one of its axes.
const BODY: &str = "
run = { duration = 4 }
output = { step = 0.01 }
integrator = { kind = 'radau', tolerance = 1e-8 }
[[body]]
name = 'box'
mass = 1
inertia = { kind = 'principal', moments = [1, 2, 3] }
spin = [0, 10, 0]
";

/// Euler's equations: a disturbance grows like exp(λt), λ = Ω √((J₂ − J₁)(J₃ − J₂)/(J₁ J₃)), about the axis of J₂ only.
#[test]
fn the_middle_axis_of_a_body_is_unstable() {
    let Unstable { from, until, .. } = unstable(BODY, &[]).unwrap();
    let rate = 10.0 * (1.0_f64 / 3.0).sqrt();
    let expected = 1000.0_f64.ln() / rate;
    assert!((until - from - expected).abs() < 0.1 * expected, "{from} {until}, expected {expected}");
    for spin in ["[10, 0, 0]", "[0, 0, 10]"] {
        let set = format!(
            "body=[{{name='box', mass=1, inertia={{kind='principal', moments=[1, 2, 3]}}, spin={spin}}}]"
        );
        assert_eq!(unstable(BODY, &[&set]), None, "{spin}");
    }
}

/// A straight cantilever of 1 m and EI = 100 N m² under a force along it, in the plane and in space.
const PLANAR: &str = "
run = { duration = 1.4 }
output = { step = 0.01 }
hub = { motion = { kind = 'constant', speed = 0 } }
model = { coupling = 'exact' }
basis = { kind = 'finite-elements', elements = 4 }
beam = { length = 1 }
damping = { stiffness = 1e-3 }
section = { kind = 'resultants', mass-per-length = 1, axial-stiffness = 1e5, bending-stiffness = 100 }
[[load]]
on = '1 m'
force = [-300, 0]
amplitude = { kind = 'expression', formula = 'if(t < 0.4, (1 - cos(pi*t/0.4))/2, 1)' }
";
const SPATIAL: &str = "
run = { duration = 1.4 }
output = { step = 0.01 }
[[beam]]
length = 1
damping = { stiffness = 1e-3 }
up = [0, 0, 1]
root = 'clamped'
elements = 4
section = { kind = 'rectangle', modulus = 1e10, density = 940, width = 0.1, height = 0.0106265857 }
[[load]]
on = 'beam.tip'
force = [-300, 0, 0]
amplitude = { kind = 'expression', formula = 'if(t < 0.4, (1 - cos(pi*t/0.4))/2, 1)' }
";

/// Euler's load is π² EI/(4L²) = 246.7 N.
#[test]
fn a_straight_column_says_when_it_would_buckle() {
    for text in [PLANAR, SPATIAL] {
        assert!(unstable(text, &[]).is_some(), "{text}");
        assert_eq!(unstable(&text.replace("-300", "-200"), &[]), None, "{text}");
    }
}

/// Beyond three quarters of a turn a couple about a fixed axis no longer keeps a cantilever in its plane.
#[test]
fn a_cantilever_that_is_rolled_up_leaves_its_plane() {
    let set = ["model.refine=1", "run.duration=2.2", "integrator.tolerance=1e-5"];
    let errors = errors(&case("space_roll_up_release/four-seconds", &set).unwrap());
    let Unstable { from, until, column, .. } = errors.unstable.unwrap();
    assert!((0.8..1.5).contains(&from) && (1.5..1.9).contains(&until), "{from} {until}");
    assert!(column.ends_with(".z") && errors.trusted == until, "{column}");
}
