//! Extremes that a run passes between its records.

use super::radau;
use flexion::analysis::recording::record;
use flexion::analysis::transient::Plan;
use flexion::drive::Actuator;
use flexion::linalg::Vec3;
use flexion::multibody::{Body, Drive, Kind, Model, Multibody, Part};
use flexion::profile::Constant;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A unit mass on a rail with a unit spring: x = cos(t − φ).
fn oscillator(phase: f64) -> Multibody {
    let mut model = Model::new();
    let mut body = Body::new("mass", 1.0, [1.0; 3]).at([phase.cos(), 0.0, 0.0]);
    body.velocity = Some(Vec3([phase.sin(), 0.0, 0.0]));
    let part = model.body(body);
    let actuator = Actuator {
        torque: Arc::new(Constant::new(0.0).unwrap()),
        damping: 0.0,
        stiffness: 1.0,
        // The displacement of a joint is zero at the start.
        rest_angle: -phase.cos(),
        controller: None,
    };
    let joint =
        model.join("rail", Kind::Prismatic, [Part::Ground, part], [0.0; 3], ([1.0, 0.0, 0.0], None)).unwrap();
    joint.drive = Drive::Actuated(actuator);
    Multibody::new(model).unwrap()
}

/// Extremes of cos(t − φ) on [0, end].
fn of_cosine(phase: f64, end: f64) -> [f64; 2] {
    let ends = [phase.cos(), (end - phase).cos()];
    let within = |first: f64| {
        // A time first + φ + 2πk in [0, end].
        let k = ((-first - phase) / TAU).ceil();
        first + phase + TAU * k <= end
    };
    let most = if within(0.0) { 1.0 } else { ends[0].max(ends[1]) };
    let least = if within(PI) { -1.0 } else { ends[0].min(ends[1]) };
    [least, most]
}

/// Wherever in the first, a middle or the last step the crest lies: steps of a tenth of a radian, records of a fifth.
#[test]
fn a_crest_is_found_in_the_first_and_in_the_last_step() {
    for k in 0..40 {
        let phase = 0.011 * f64::from(k) - 0.05;
        for end in [1.0, PI + phase + 0.003, PI + phase + 0.02, PI + phase + 0.07, PI + phase + 0.15] {
            let mut system = oscillator(phase);
            let plan = Plan::new(end, 0.2).with_longest_step(0.1);
            let run = record(&mut system, &radau(1e-9), &plan);
            let extremes = run.trajectory.extremes(run.trajectory.index("mass.position.x").unwrap());
            let [least, most] = of_cosine(phase, end);
            // An extreme that is missed between two rows of a step is off by 1 − cos(0.05), 1e-3.
            assert!(
                (extremes.min - least).abs() < 4e-5 && (extremes.max - most).abs() < 4e-5,
                "φ = {phase}, until {end}: {} … {} for {least} … {most}",
                extremes.min,
                extremes.max
            );
        }
    }
}

/// A sphere that spins by Ω about n has the quaternion (cos Ωt/2, n sin Ωt/2), which is continuous whatever its largest component is.
#[test]
fn components_of_a_rotation_have_the_extremes_of_one_continuous_quaternion() {
    let spin: [f64; 3] = [0.6, 2.3, 0.3];
    let size = spin.iter().map(|x| x * x).sum::<f64>().sqrt();
    for end in [1.0, 2.3, 4.0, 9.0] {
        let mut model = Model::new();
        let mut body = Body::new("b", 1.0, [0.1; 3]);
        body.spin = Some(Vec3(spin));
        model.body(body);
        let mut system = Multibody::new(model).unwrap();
        let run = record(&mut system, &radau(1e-9), &Plan::new(end, 0.1));
        // cos(a − φ) with φ = 0 and π/2.
        let half = 0.5 * size * end;
        for (name, factor, phase) in [
            ("w", 1.0, 0.0),
            ("x", spin[0] / size, 0.5 * PI),
            ("y", spin[1] / size, 0.5 * PI),
            ("z", spin[2] / size, 0.5 * PI),
        ] {
            let found = run.trajectory.extremes(run.trajectory.index(&format!("b.rotation.{name}")).unwrap());
            let [least, most] = of_cosine(phase, half).map(|x| factor * x);
            assert!(
                (found.min - least).abs() < 1e-4 && (found.max - most).abs() < 1e-4,
                "{name} until {end}: {} … {} for {least} … {most}",
                found.min,
                found.max
            );
        }
    }
}

/// Rows that are more than a radian of a motion apart do not resolve it: whatever the steps, no component of a unit quaternion is beyond one.
#[test]
fn no_extreme_is_taken_from_rows_that_do_not_resolve_the_motion() {
    for k in 1..60 {
        let (speed, step) = (7.3 * f64::from(k), 0.013 + 0.0031 * f64::from(k));
        let mut model = Model::new();
        let mut body = Body::new("b", 1.0, [0.1; 3]);
        body.spin = Some(Vec3([0.0, 0.0, speed]));
        model.body(body);
        let mut system = Multibody::new(model).unwrap();
        let method = flexion::integrator::GeneralizedAlpha::newmark(0.25, 0.5).unwrap();
        let run = record(&mut system, &method, &Plan::new(3.0, 0.7 * step).with_step(step));
        for name in ["w", "z"] {
            let found = run.trajectory.extremes(run.trajectory.index(&format!("b.rotation.{name}")).unwrap());
            assert!(found.largest() < 1.003, "{speed} rad/s, {step} s, {name}: {found:?}");
        }
    }
}
