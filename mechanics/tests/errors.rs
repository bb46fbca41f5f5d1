//! Errors of systems of one's own, which know no case.

#![allow(clippy::unwrap_used)]

use flexion::analysis::error::{
    Effort, Ended, Estimate, Goal, Mesh, Part as Of, Refinable, Variant, estimate, refine,
};
use flexion::exact::pendulum::rod_angle;
use flexion::integrator::InvalidParameter;
use flexion::linalg::Vec3;
use flexion::multibody::{Axes, Body, Kind, Load, Marker, Model, Multibody, Part};
use flexion::prelude::*;
use flexion::profile::Expression;
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::Arc;

const GRAVITY: f64 = 9.81;
const HEIGHT: &str = "rod.position.z";

fn on(_: &State) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// A rigid rod of 1 m that falls from the horizontal about its end, by fixed steps of 20 ms.
struct Rod;

impl Refinable for Rod {
    type Run = Record;
    type Fault = InvalidParameter;

    fn variant(&self) -> Variant {
        Variant::new(Plan::new(1.0, 0.02).with_step(0.02))
    }

    fn run(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Record, InvalidParameter> {
        let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
        let rod = model.body(Body::new("rod", 1.0, [1e-3, 1.0 / 12.0, 1.0 / 12.0]).at([0.5, 0.0, 0.0]));
        model.join("axis", Kind::Revolute, [Part::Ground, rod], [0.0; 3], ([0.0, 1.0, 0.0], None)).unwrap();
        variant.record_by(&GeneralizedAlpha::chung_hulbert(0.8)?, &mut Multibody::new(model).unwrap(), watch)
    }

    fn has_mesh(&self) -> bool {
        false
    }
}

/// Height of the middle of the rod \[m\].
fn height(t: f64) -> f64 {
    0.5 * rod_angle(0.0, 1.0, GRAVITY, t).sin()
}

/// A free body with the moments 1, 2, 3 kg m² that spins about one of its axes, by Radau.
struct Spinning([f64; 3]);

impl Refinable for Spinning {
    type Run = Record;
    type Fault = InvalidParameter;

    fn variant(&self) -> Variant {
        Variant::new(Plan::new(4.0, 0.01)).with_tolerance(Tolerance::uniform(1e-8))
    }

    fn run(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Record, InvalidParameter> {
        let mut model = Model::new();
        let mut body = Body::new("box", 1.0, [1.0, 2.0, 3.0]);
        (body.spin, body.velocity) = (Some(Vec3(self.0)), Some(Vec3::ZERO));
        model.body(body);
        variant.record(&mut Multibody::new(model).unwrap(), watch)
    }

    fn has_mesh(&self) -> bool {
        false
    }
}

/// A free body of 170 g that a force strikes for some tenths of a millisecond, in a run of a second.
struct Struck {
    force: &'static str,
    tolerance: f64,
}

impl Refinable for Struck {
    type Run = Record;
    type Fault = InvalidParameter;

    fn variant(&self) -> Variant {
        let tolerance = Tolerance { relative: self.tolerance, absolute: 1e-8 };
        Variant::new(Plan::new(1.0, 5e-3)).with_tolerance(tolerance)
    }

    fn run(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Record, InvalidParameter> {
        let mut model = Model::new();
        let body = model.body(Body::new("ball", 0.17, [1e-3; 3]));
        model.load(Load {
            name: "blow".to_owned(),
            at: Marker::new(body, [0.0; 3]),
            force: Vec3([1.1, 0.0, 0.0]),
            moment: Vec3::ZERO,
            axes: Axes::Dead,
            amplitude: Some(Arc::new(Expression::new(self.force, "t", 1.0).unwrap())),
        });
        variant.record(&mut Multibody::new(model).unwrap(), watch)
    }

    fn has_mesh(&self) -> bool {
        false
    }
}

fn errors<P: Refinable<Run = Record, Fault = InvalidParameter>>(
    problem: &P,
) -> (Record, Estimate<InvalidParameter>) {
    let run = problem.run(&problem.variant(), &mut on).unwrap();
    let errors = estimate(problem, &problem.variant(), &run, Effort::Full, &mut on).unwrap();
    (run, errors)
}

/// A Gauss pulse, which names its own times of resolution, and half a wave between two breaks, which three points see to a thousandth: the
/// steps of every tolerance end at these times.
#[test]
fn the_error_of_a_short_blow_covers_its_error_and_is_of_its_size() {
    const SPEED: &str = "ball.velocity.x";
    let gauss = ("exp(-((t - 0.61)/1.4e-4)^2)", 1.4e-4 * PI.sqrt());
    let half_wave = ("if(t < 0.5, 0, if(t < 0.5003, sin(pi*(t - 0.5)/3e-4), 0))", 3e-4 * 2.0 / PI);
    for (force, integral) in [gauss, half_wave] {
        let speed = 1.1 * integral / 0.17;
        for tolerance in [1e-4, 1e-6, 1e-8] {
            let struck = Struck { force, tolerance };
            let (run, errors) = errors(&struck);
            let off = (run.column(SPEED).unwrap().last().unwrap() - speed).abs();
            let stated = errors.of(SPEED).unwrap().last;
            let shown = format!("{force} {tolerance:e}: off by {off:e} of {speed:e}, stated {stated:e}");
            assert!(off <= stated && stated < 4.0 * off, "{shown}");
        }
        let goals = |_: &Trajectory| -> Result<Vec<Goal>, InvalidParameter> {
            Ok(vec![Goal { column: SPEED.to_owned(), part: Of::Final, bound: 1e-8 * speed }])
        };
        let struck = Struck { force, tolerance: 1e-6 };
        let found = refine(&struck, &goals, &mut on, &mut |_| {}).unwrap();
        let off = (found.run.column(SPEED).unwrap().last().unwrap() - speed).abs();
        assert_eq!(found.ended, Ended::Reached);
        assert!(off <= 1e-8 * speed, "{force}: {off:e} of {speed:e}");
    }
}

#[test]
fn the_error_of_a_falling_rod_covers_its_error_and_is_of_its_size() {
    let (run, errors) = errors(&Rod);
    let heights = run.column(HEIGHT).unwrap();
    let off = run.trajectory.times().iter().zip(&heights).map(|(t, z)| (z - height(*t)).abs());
    let (off, stated) = (off.fold(0.0, f64::max), errors.of(HEIGHT).unwrap().discretization);
    assert!(off <= stated && stated < 8.0 * off, "off by {off:e}, stated {stated:e}");
}

/// The error of the method falls with the square of the step.
#[test]
fn a_falling_rod_is_refined_to_a_tolerance() {
    let goals = |_: &Trajectory| -> Result<Vec<Goal>, InvalidParameter> {
        Ok(vec![Goal { column: HEIGHT.to_owned(), part: Of::Final, bound: 1e-5 }])
    };
    let mut steps = Vec::new();
    let refined =
        refine(&Rod, &goals, &mut on, &mut |rung| steps.push(rung.variant.fixed_step().unwrap())).unwrap();
    assert!(refined.ended == Ended::Reached && steps.len() > 2, "{steps:?}");
    assert!(steps.windows(2).all(|pair| pair[1] == 0.5 * pair[0]), "{steps:?}");
    let order = refined.rungs.last().unwrap().order.unwrap();
    assert!((order - 2.0).abs() < 0.2, "{order}");
    let last = *refined.run.column(HEIGHT).unwrap().last().unwrap();
    assert!((last - height(1.0)).abs() < 1e-5, "{last}");
}

/// Euler's equations: a disturbance grows like exp(λt), λ = Ω √((J₂ − J₁)(J₃ − J₂)/(J₁ J₃)), about the axis of J₂ only.
#[test]
fn the_middle_axis_of_a_body_of_ones_own_is_unstable() {
    let (_, of_middle) = errors(&Spinning([0.0, 10.0, 0.0]));
    let unstable = of_middle.unstable().unwrap();
    let expected = 1000.0_f64.ln() / (10.0 * (1.0_f64 / 3.0).sqrt());
    assert!((unstable.until - unstable.from - expected).abs() < 0.1 * expected, "{unstable:?}");
    assert_eq!(of_middle.trusted, unstable.until);
    for spin in [[10.0, 0.0, 0.0], [0.0, 0.0, 10.0]] {
        assert_eq!(errors(&Spinning(spin)).1.unstable(), None, "{spin:?}");
    }
}

#[test]
fn a_mesh_has_twice_the_cells_for_every_halving() {
    assert_eq!(Mesh::default().cells(3), 3);
    assert_eq!(Mesh::default().halved().halved().cells(3), 12);
    assert_eq!(Mesh { halvings: 2, factor: Some(1.3) }.cells(3), 16);
}
