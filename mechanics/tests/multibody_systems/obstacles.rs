//! Balls that roll, and beams that obstacles touch anywhere along their length.

use super::contacts::run;
use super::{GRAVITY, odd_body, radau, wave};
use flexion::analysis::transient::{Event, EventKind};
use flexion::contact::{
    Circle, Contact, ContactForce, Contacting, Law, Obstacle, Plane, Sphere, Translation,
};
use flexion::integrator::{Integrator, MoreauJean, NonsmoothAlpha};
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Body, Flexible, Kind, Marker, Model, Multibody, Part, shear};
use flexion::profile::Expression;
use flexion::section::Matrices;
use flexion::system::{Dynamics, Frame, State};
use flexion::verify::dynamics;
use std::sync::Arc;

pub(super) const RUBBING: ContactForce =
    ContactForce { stiffness: 400.0, exponent: 1.5, factor: 0.4, friction: 0.6, slip_speed: 0.7 };

/// A moving obstacle, whose boundary is at the distance `gap` from where it is for a radius of 0.5.
pub(super) type Made = dyn Fn(f64) -> Arc<dyn Obstacle>;

pub(super) fn moved() -> Option<Translation> {
    let displacement = Arc::new(Expression::new("0.1*sin(3*t)", "t", 1.0).unwrap());
    Some(Translation { direction: Vec3([0.0, 0.6, 0.8]), displacement })
}

/// A plane, a hole, a ball and a hollow one, all of which move.
pub(super) fn obstacles() -> [Box<Made>; 4] {
    let axis = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
    [
        Box::new(move |x| {
            Arc::new(Plane { point: Vec3(axis.map(|n| x * n)), normal: Vec3(axis), motion: moved() })
        }),
        Box::new(move |radius| {
            Arc::new(Circle {
                centre: Vec3([0.1; 3]),
                axis: Vec3(axis),
                radius,
                hollow: true,
                motion: moved(),
            })
        }),
        Box::new(|radius| {
            Arc::new(Sphere { centre: Vec3([2.0, 1.5, 0.3]), radius, hollow: false, motion: moved() })
        }),
        Box::new(|radius| Arc::new(Sphere { centre: Vec3([0.2; 3]), radius, hollow: true, motion: moved() })),
    ]
}

/// Forces, rows and tangents of a contact that is 5 cm deep, against differences.
pub(super) fn conforms(model: &Model, made: &Made, deform: impl Fn(&Multibody, &mut State)) {
    for law in [Law::Force(RUBBING), Law::Constraint { restitution: 0.2, friction: 0.6 }] {
        let system = |radius: f64| {
            let contact = Contact { name: "touch".into(), point: 0, obstacle: made(radius), law };
            Contacting::new(Multibody::new(model.clone()).unwrap(), vec![contact])
        };
        let state = |system: &Contacting<Multibody>| {
            let mut s = system.initial();
            deform(system.inner(), &mut s);
            s.a.iter_mut().enumerate().for_each(|(i, a)| *a = 3.0 * wave(i, 4.0));
            s.lambda.iter_mut().enumerate().for_each(|(i, x)| *x = 1.7 * wave(i, 5.0));
            s.memory.fill(0.9);
            s
        };
        let mut touching = system(0.5);
        let s = state(&touching);
        let gap = touching.gaps(&s)[0];
        let grown = if made(0.5).surface(Vec3([9.0; 3]), 0.0).gap > 0.0 { gap } else { -gap - 0.1 };
        let mut touching = system(0.5 + grown + 0.05);
        let s = state(&touching);
        assert!((touching.gaps(&s)[0] + 0.05).abs() < 1e-12, "{:?}", touching.gaps(&s));
        let mut defects = dynamics(&mut touching, &s);
        defects.retain(|d| d.check != "dE/dt" || matches!(law, Law::Force(_)));
        assert_eq!(defects, [], "{:?} {law:?}", made(0.5));
    }
}

#[test]
fn a_ball_that_rubs_conforms_on_every_obstacle() {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let part = model.body(odd_body("box", 0.3));
    model.contact_ball(Marker::new(part, [0.3, -0.2, 0.1]), 0.23);
    for made in obstacles() {
        conforms(&model, &*made, |_, _| {});
    }
}

fn station() -> Station {
    Station { position: Vec3([0.0; 3]), tangent: Vec3([1.0, 0.0, 0.0]), normal: Vec3([0.0, 1.0, 0.0]) }
}

pub(super) fn flexible(elements: usize) -> Flexible {
    let properties = Properties::principal([2e3, 20.0, 30.0, 40.0], 1.2, [0.02, 0.0, 0.0]);
    Flexible::new("beam", Beam::straight(station(), 2.0, elements, properties).unwrap())
}

#[test]
fn an_obstacle_that_touches_anywhere_conforms() {
    let section = Matrices::principal([2e3, 400.0, 300.0, 20.0, 30.0, 40.0], 1.2, [0.02, 0.01, 0.01]);
    let root = Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY };
    let sheared = shear::Beam::straight(root, 2.0, 3, section.with_mass_centre([0.1, -0.05])).unwrap();
    for beam in [flexible(3), Flexible::new("beam", sheared)] {
        touches_anywhere(beam);
    }
}

fn touches_anywhere(beam: Flexible) {
    // The nearest point, and one of a station, which is no node.
    for station in [None, Some(0.77)] {
        touches(beam.clone(), station);
    }
}

fn touches(beam: Flexible, station: Option<f64>) {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let beam = model.beam(beam);
    assert_eq!(beam, 0);
    match station {
        Some(station) => model.contact_station(0, station, 0.02),
        None => model.contact_beam(0, 0.02),
    };
    let axis = [0.0, 0.8, 0.6];
    let obstacles: [&Made; 3] = [
        // Within an element, beside an end, and a rod across.
        &|radius| Arc::new(Sphere { centre: Vec3([1.2, 0.3, 0.7]), radius, hollow: false, motion: moved() }),
        &|radius| Arc::new(Sphere { centre: Vec3([2.7, 0.1, 0.6]), radius, hollow: false, motion: moved() }),
        &move |radius| {
            Arc::new(Circle {
                centre: Vec3([0.5, 0.1, 0.7]),
                axis: Vec3(axis),
                radius,
                hollow: false,
                motion: moved(),
            })
        },
    ];
    for made in obstacles {
        conforms(&model, made, |system, s| {
            let d: Vec<f64> = (0..s.v.len()).map(|i| 0.06 * wave(i, 1.7)).collect();
            system.retract(&s.q.clone(), &d, &mut s.q);
            s.v.iter_mut().enumerate().for_each(|(i, v)| *v = 0.8 * wave(i, 2.9));
        });
    }
}

/// A ball of inertia 2/5 m R² is thrown without spin at v₀ along a plane: it slides with the deceleration μg until it rolls, at
/// t = 2v₀/(7μg), with 5/7 v₀, in any direction.
#[test]
fn a_ball_slides_and_then_rolls_with_five_sevenths_of_its_speed() {
    let (mass, radius, speed, mu) = (0.6, 0.11, 1.4, 0.3);
    let direction = [0.6, 0.8];
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let mut ball = Body::new("ball", mass, [0.4 * mass * radius * radius; 3]).at([0.0, 0.0, radius]);
    ball.velocity = Some(Vec3([speed * direction[0], speed * direction[1], 0.0]));
    let part = model.body(ball);
    model.contact_ball(Marker::new(part, [0.0; 3]), radius);
    let rolls = 2.0 * speed / (7.0 * mu * GRAVITY);
    let plane = Arc::new(Plane { point: Vec3([0.0; 3]), normal: Vec3([0.0, 0.0, 1.0]), motion: None });
    let table = |law: Law| {
        let contact = Contact { name: "table".into(), point: 0, obstacle: plane.clone(), law };
        Contacting::new(Multibody::new(model.clone()).unwrap(), vec![contact])
    };
    let along = |v: &[f64]| v[0] * direction[0] + v[1] * direction[1];
    let across = |v: &[f64]| v[0] * direction[1] - v[1] * direction[0];
    let methods: [Box<dyn Integrator>; 2] =
        [Box::new(MoreauJean::new(0.5).unwrap()), Box::new(NonsmoothAlpha::decoupled(0.8).unwrap())];
    for mut method in methods {
        let name = method.info().name;
        for (end, expected, tolerance) in
            [(0.5 * rolls, speed * (1.0 - 1.0 / 7.0), 1e-9), (2.0 * rolls, 5.0 / 7.0 * speed, 1e-3)]
        {
            let mut system = table(Law::Constraint { restitution: 0.0, friction: mu });
            let (s, _) = run(&mut system, method.as_mut(), end, Some(rolls / 400.0));
            assert!((along(&s.v) - expected).abs() < tolerance * speed, "{name}: {:?}", s.v);
            assert!(across(&s.v).abs() < 1e-9, "{name}: {:?}", s.v);
            // Rolling: ω = e_z × v/R. Angular velocities are in the axes of the ball, so the size alone is compared.
            let spin = s.v[3].hypot(s.v[4]).hypot(s.v[5]);
            assert!(end < rolls || (spin * radius - along(&s.v)).abs() < 1e-6, "{name}: {:?}", s.v);
        }
    }
    // A stiff force from the depth at which it carries the ball: friction is regularised, so that rolling is approached.
    let force = ContactForce { stiffness: 1e6, exponent: 1.0, factor: 0.0, friction: mu, slip_speed: 1e-3 };
    let mut system = table(Law::Force(force));
    let (s, watch) = run(&mut system, &radau(1e-8), 2.0 * rolls, None);
    assert!((along(&s.v) - 5.0 / 7.0 * speed).abs() < 1e-3 * speed, "{:?}", s.v);
    assert!(watch.imbalance < 1e-4, "{:e}", watch.imbalance);
}

/// Friction on a slope holds a block when tan α < μ, whatever the direction of the slope, and otherwise lets it slide with
/// g (sin α − μ cos α) straight down.
#[test]
fn a_block_on_a_slope_of_any_direction_stays_or_slides_straight_down() {
    let (slope, end) = (0.4_f64, 0.5);
    for (azimuth, mu) in [(0.3_f64, 0.5), (2.1, 0.5), (0.3, 0.2), (4.4, 0.2)] {
        let (sin, cos) = slope.sin_cos();
        let down = [cos * azimuth.cos(), cos * azimuth.sin(), -sin];
        let normal = [sin * azimuth.cos(), sin * azimuth.sin(), cos];
        let contact = |law, depth: f64| {
            let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
            let part = model.body(Body::new("block", 0.7, [0.1; 3]).at(normal.map(|n| -depth * n)));
            model.contact_point(Marker::new(part, [0.0; 3]));
            let obstacle = Arc::new(Plane { point: Vec3([0.0; 3]), normal: Vec3(normal), motion: None });
            let contact = Contact { name: "slope".into(), point: 0, obstacle, law };
            Contacting::new(Multibody::new(model).unwrap(), vec![contact])
        };
        let expected = (GRAVITY * (sin - mu * cos)).max(0.0) * end;
        let mut system = contact(Law::Constraint { restitution: 0.0, friction: mu }, 0.0);
        let (s, _) = run(&mut system, &MoreauJean::new(0.5).unwrap(), end, Some(1e-3));
        for k in 0..3 {
            assert!((s.v[k] - expected * down[k]).abs() < 1e-9, "{azimuth} {mu}: {:?}", s.v);
        }
        // Regularised, and at the depth at which the force carries it, it creeps where tanh(v/v_s) = tan α/μ.
        let (slip_speed, depth) = (1e-4, 0.7 * GRAVITY * cos / 1e6);
        let force = ContactForce { stiffness: 1e6, exponent: 1.0, factor: 0.0, friction: mu, slip_speed };
        let (s, _) = run(&mut contact(Law::Force(force), depth), &radau(1e-9), end, None);
        let speed: f64 = (0..3).map(|k| s.v[k] * down[k]).sum();
        let creep = if expected > 0.0 { 0.0 } else { slip_speed * (slope.tan() / mu).atanh() };
        let tolerance = if expected > 0.0 { 1e-3 * expected } else { 1e-6 * creep };
        assert!(
            (speed - expected - creep).abs() < tolerance,
            "{azimuth} {mu}: {speed:e}, {expected:e} {creep:e}"
        );
    }
}

/// A beam that hangs on a hinge at its first node falls on a small ball; it strikes as the same fall on a station there does.
#[test]
fn a_swinging_beam_strikes_a_ball_where_it_is() {
    for (place, station) in [(1.0, 2), (1.5, 3)] {
        let end = 0.4;
        let results = [true, false].map(|anywhere| {
            let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
            model.beam(flexible(4));
            let node = |node| Part::Section { beam: 0, node };
            let axis = ([0.0, 1.0, 0.0], None);
            model.join("hinge", Kind::Revolute, [Part::Ground, node(0)], [0.0; 3], axis).unwrap();
            // Below the station by half a millimetre: the contact stays near it.
            let radius = 0.05;
            if anywhere {
                model.contact_beam(0, 0.0);
            } else {
                model.contact_point(Marker::new(node(station), [0.0; 3]));
            }
            let centre = [place, 0.0, -radius - 5e-4];
            let obstacle = Arc::new(Sphere { centre: Vec3(centre), radius, hollow: false, motion: None });
            let law = Law::Constraint { restitution: 0.3, friction: 0.0 };
            let contact = Contact { name: "stop".into(), point: 0, obstacle, law };
            let mut system = Contacting::new(Multibody::new(model).unwrap(), vec![contact]);
            let (_, watch) = run(&mut system, &radau(1e-8), end, None);
            assert!(watch.imbalance < 1e-5, "{:e}", watch.imbalance);
            watch.events
        });
        let [first, second] = results.map(|events| events[0].clone());
        assert!((first.time - second.time).abs() < 1e-5 * first.time, "{first:?} {second:?}");
        let impulse = |event: &Event| match &event.kind {
            EventKind::Impact { impulses, .. } => impulses[5],
            other => panic!("{other:?}"),
        };
        let [first, second] = [impulse(&first), impulse(&second)];
        assert!((first / second - 1.0).abs() < 1e-3, "{first} {second}");
    }
}
