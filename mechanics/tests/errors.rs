//! Errors of systems of one's own, which know no case.

#![allow(clippy::unwrap_used)]

use flexion::analysis::error::{
    Advice, Effort, Ended, Estimate, Goal, Ladder, Mesh, Part as Of, Refinable, Variant, advise, estimate,
    refine,
};
use flexion::exact::pendulum::rod_angle;
use flexion::integrator::InvalidParameter;
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Axes, Body, Flexible, Joint, Kind, Load, Marker, Model, Multibody, Part};
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

/// A rod of 1 m on a ball joint that falls from the horizontal, by one of three models: rigid, as a beam, and as one with shear, of which the
/// data are missing.
struct Falling {
    model: usize,
    /// Elements of its coarsest mesh.
    elements: usize,
    controlled: bool,
}

const TIP: &str = "rod.tip.position.z";

impl Refinable for Falling {
    type Run = Record;
    type Fault = InvalidParameter;

    fn variant(&self) -> Variant {
        let variant = Variant::new(Plan::new(0.6, 0.01).with_step(0.01));
        if self.controlled { variant.with_tolerance(Tolerance::uniform(1e-6)) } else { variant }
    }

    fn run(&self, variant: &Variant, watch: &mut Watch<'_>) -> Result<Record, InvalidParameter> {
        let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
        if self.model == 0 {
            let mut rod = Body::new("rod.tip", 0.8, [1e-4, 0.8 / 12.0, 0.8 / 12.0]).at([1.0, 0.0, 0.0]);
            rod.centre = [-0.5, 0.0, 0.0].into();
            let rod = model.body(rod);
            let z = [0.0, 0.0, 1.0];
            model.join("ball", Kind::Spherical, [Part::Ground, rod], [0.0; 3], (z, None)).unwrap();
        } else {
            let section = Properties::principal([1e7, 800.0, 1e3, 1e3], 0.8, [1e-4, 0.0, 0.0]);
            let root = Station {
                position: [0.0; 3].into(),
                tangent: [1.0, 0.0, 0.0].into(),
                normal: [0.0, 1.0, 0.0].into(),
            };
            let beam = Beam::straight(root, 1.0, variant.mesh.cells(self.elements), section).unwrap();
            let beam = model.beam(Flexible::new("rod", beam));
            let ends = [Part::Ground, Part::Section { beam, node: 0 }];
            let [ground, end] = ends.map(|part| Marker::new(part, [0.0; 3]));
            model.joint(Joint::new("ball", Kind::Spherical, ground, end));
        }
        let alpha = GeneralizedAlpha::chung_hulbert(0.8)?;
        variant.record_by(&alpha, &mut Multibody::new(model).unwrap(), watch)
    }

    fn has_mesh(&self) -> bool {
        self.model > 0
    }
}

struct Rods;

impl Ladder for Rods {
    type Motion = Falling;

    fn models(&self) -> usize {
        3
    }

    fn model(&self, model: usize) -> Result<Falling, InvalidParameter> {
        // The shear stiffness is not given.
        let missing = || GeneralizedAlpha::chung_hulbert(f64::NAN).map(|_| ()).unwrap_err();
        if model == 2 { Err(missing()) } else { Ok(Falling { model, elements: 4, controlled: true }) }
    }

    fn families(&self, model: usize) -> Vec<Result<Falling, InvalidParameter>> {
        vec![Ok(Falling { model, elements: 1, controlled: true })]
    }

    fn methods(&self, model: usize, _: usize) -> Vec<Result<Falling, InvalidParameter>> {
        vec![Ok(Falling { model, elements: 1, controlled: false })]
    }
}

/// The beam gives way by about m g L³/(EI) parts of its length: that is a difference of the models, and the rigid rod does where more is
/// allowed.
#[test]
fn the_cheapest_model_of_a_rod_depends_on_what_is_asked() {
    let ask = |bound: f64| -> Advice<InvalidParameter> {
        let goals = |_: &Trajectory| -> Result<Vec<Goal>, InvalidParameter> {
            Ok(vec![Goal { column: TIP.to_owned(), part: Of::History, bound }])
        };
        advise(&Rods, &goals, &mut on).unwrap_or_else(|_| panic!("no advice"))
    };
    let coarse = ask(1e-2);
    assert_eq!((coarse.trusted, coarse.untried.len(), coarse.untried[0].0), (1, 1, 2));
    let cheapest = &coarse.tried[coarse.cheapest.unwrap()];
    assert!(cheapest.choice.model == 0 && cheapest.difference.as_ref().unwrap() <= &1.0, "{cheapest:?}");
    // That of the trusted answer is added to what a run is off by.
    let own = Falling { model: 0, elements: 1, controlled: true }.run(&cheapest.variant, &mut on).unwrap();
    let (ours, theirs) = (own.column(TIP).unwrap(), coarse.record.column(TIP).unwrap());
    let off = ours.iter().zip(&theirs).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!((cheapest.difference.as_ref().unwrap() - (off / 1e-2 + coarse.error)).abs() < 1e-9, "{off}");
    let least = coarse.tried.iter().filter(|tried| tried.holds()).map(|tried| tried.work);
    assert_eq!(least.fold(f64::INFINITY, f64::min), cheapest.work);
    // What gives way is asked for: no step makes the rigid rod bend.
    let apart = coarse.tried.iter().find(|tried| tried.choice.model == 0 && tried.choice.family.is_none());
    let apart = 1e-2 * apart.unwrap().difference.as_ref().unwrap();
    let fine = ask(0.3 * apart);
    let mut rigid = fine.tried.iter().filter(|tried| tried.choice.model == 0);
    assert!(rigid.all(|tried| !tried.holds()));
    assert_eq!(fine.tried[fine.cheapest.unwrap()].choice.model, 1);
}
