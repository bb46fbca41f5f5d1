//! Obstacles that bodies and beams carry.

use super::contacts::run;
use super::obstacles::{Made, conforms, flexible, moved, obstacles};
use super::{odd_body, radau, wave};
use flexion::contact::{Circle, Contact, ContactForce, Contacting, Law, Sphere};
use flexion::integrator::{MoreauJean, NonsmoothAlpha};
use flexion::linalg::Vec3;
use flexion::multibody::{Body, Marker, Model, Multibody, Part};
use flexion::system::{Dynamics, Frame, Observed, State};
use std::sync::Arc;

fn deformed(system: &Multibody, s: &mut State) {
    let d: Vec<f64> = (0..s.v.len()).map(|i| 0.06 * wave(i, 1.7)).collect();
    system.retract(&s.q.clone(), &d, &mut s.q);
    s.v.iter_mut().enumerate().for_each(|(i, v)| *v = 0.8 * wave(i, 2.9));
}

#[test]
fn a_ball_that_rubs_on_a_moving_body_conforms() {
    let mut model = Model::new().with_gravity([0.3, -0.2, -4.0]);
    let (part, carrier) = (model.body(odd_body("box", 0.3)), model.body(odd_body("anvil", 2.3)));
    let point = model.contact_ball(Marker::new(part, [0.3, -0.2, 0.1]), 0.23);
    let on = Marker::new(carrier, [0.1, 0.2, -0.3]).with_axis([1.0, 2.0, 2.0], None).unwrap();
    model.mount(point, on);
    for made in obstacles() {
        conforms(&model, &*made, |_, _| {});
    }
}

/// A ball on an obstacle that a section of a beam carries, and a beam on one that a body carries: at a station, and where it is nearest.
#[test]
fn what_beams_carry_and_what_touches_them_conforms() {
    let mut model = Model::new().with_gravity([0.3, -0.2, -4.0]);
    let part = model.body(odd_body("box", 0.3));
    model.beam(flexible(2));
    let point = model.contact_ball(Marker::new(part, [0.3, -0.2, 0.1]), 0.23);
    model.mount(point, Marker::new(Part::Section { beam: 0, node: 1 }, [0.1, 0.0, 0.2]));
    for made in obstacles() {
        conforms(&model, &*made, deformed);
    }
    for station in [Some(0.77), None] {
        let mut model = Model::new().with_gravity([0.3, -0.2, -4.0]);
        let carrier = model.body(odd_body("drum", 2.3));
        model.beam(flexible(3));
        let point = match station {
            Some(station) => model.contact_station(0, station, 0.02),
            None => model.contact_beam(0, 0.02),
        };
        model.mount(point, Marker::new(carrier, [0.1, 0.2, -0.3]));
        let made: [&Made; 2] = [
            &|radius| {
                Arc::new(Sphere { centre: Vec3([1.2, 0.3, 0.7]), radius, hollow: false, motion: moved() })
            },
            &|radius| {
                Arc::new(Circle {
                    centre: Vec3([0.5, 0.1, 0.7]),
                    axis: Vec3([0.0, 0.8, 0.6]),
                    radius,
                    hollow: false,
                    motion: moved(),
                })
            },
        ];
        for made in made {
            conforms(&model, made, deformed);
        }
    }
}

#[test]
fn a_part_does_not_touch_what_it_carries_itself() {
    let mut model = Model::new();
    let part = model.body(odd_body("box", 0.3));
    let point = model.contact_point(Marker::new(part, [0.3, 0.0, 0.0]));
    model.mount(point, Marker::new(part, [0.0; 3]));
    assert!(Multibody::new(model).is_err());
    let mut model = Model::new();
    model.beam(flexible(3));
    let point = model.contact_beam(0, 0.02);
    model.mount(point, Marker::new(Part::Section { beam: 0, node: 2 }, [0.0; 3]));
    assert!(Multibody::new(model).is_err());
}

/// Balls of mass 0.2 kg and radius 0.1 m in a row along x, the first of which flies at 1 m/s against the others.
fn row(count: usize, law: Law) -> Contacting<Multibody> {
    let (mass, radius) = (0.2, 0.1);
    let mut model = Model::new();
    let parts: Vec<Part> = (0..count)
        .map(|i| {
            let at = 2.0 * radius * i as f64 - if i == 0 { 0.02 } else { 0.0 };
            let mut ball =
                Body::new(&format!("ball{i}"), mass, [0.4 * mass * radius * radius; 3]).at([at, 0.0, 0.0]);
            ball.velocity = Some(Vec3([if i == 0 { 1.0 } else { 0.0 }, 0.0, 0.0]));
            model.body(ball)
        })
        .collect();
    let contacts = (1..count).map(|i| {
        let point = model.contact_ball(Marker::new(parts[i - 1], [0.0; 3]), radius);
        model.mount(point, Marker::new(parts[i], [0.0; 3]));
        let obstacle = Arc::new(Sphere { centre: Vec3::ZERO, radius, hollow: false, motion: None });
        Contact { name: format!("touch{i}"), point, obstacle, law }
    });
    let contacts = contacts.collect();
    Contacting::new(Multibody::new(model).unwrap(), contacts)
}

/// The velocities along x, in the order of the balls.
fn velocities(system: &Contacting<Multibody>, s: &State) -> Vec<f64> {
    let mut observed = system.clone();
    let mut places = |t: &State| -> Vec<f64> {
        let place = |i: usize| {
            let mut out = [Frame::default()];
            observed.frames(i, t, &[0.0], &mut out);
            out[0].position[0]
        };
        (0..t.v.len() / 6).map(place).collect()
    };
    let step: Vec<f64> = s.v.iter().map(|v| 1e-3 * v).collect();
    let mut later = s.clone();
    system.retract(&s.q, &step, &mut later.q);
    let now = places(s);
    places(&later).iter().zip(now).map(|(b, a)| (b - a) / 1e-3).collect()
}

/// m ẍᵢ = K(δᵢ₋₁^{3/2} − δᵢ^{3/2}) by small steps of the classical method of Runge and Kutta.
fn chain(count: usize, stiffness: f64) -> Vec<f64> {
    let rate = |y: &[f64]| -> Vec<f64> {
        let force = |i: usize| stiffness * (y[i] - y[i + 1]).max(0.0).powf(1.5);
        let total = |i: usize| {
            let from = if i > 0 { force(i - 1) } else { 0.0 };
            from - if i + 1 < count { force(i) } else { 0.0 }
        };
        (0..count).map(|i| y[count + i]).chain((0..count).map(|i| total(i) / 0.2)).collect()
    };
    let mut y = vec![0.0; 2 * count];
    y[count] = 1.0;
    let h = 2e-7;
    let add = |y: &[f64], k: &[f64], h: f64| y.iter().zip(k).map(|(y, k)| y + h * k).collect::<Vec<f64>>();
    for _ in 0..100_000 {
        let k1 = rate(&y);
        let k2 = rate(&add(&y, &k1, 0.5 * h));
        let k3 = rate(&add(&y, &k2, 0.5 * h));
        let k4 = rate(&add(&y, &k3, h));
        for i in 0..y.len() {
            y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    y.split_off(count)
}

/// A row of balls with Hertz's force passes on nearly all of the motion, and keeps the rest as the equations along a line have it.
#[test]
fn a_row_of_balls_passes_on_a_blow_as_the_equations_along_a_line_do() {
    let force = ContactForce { stiffness: 1e7, exponent: 1.5, factor: 0.0, friction: 0.0, slip_speed: 1.0 };
    for count in [3, 5] {
        let mut system = row(count, Law::Force(force));
        let (s, watch) = run(&mut system, &radau(1e-12), 0.04, None);
        assert!(watch.imbalance < 1e-8, "{:e}", watch.imbalance);
        let expected = chain(count, 1e7);
        for (found, expected) in velocities(&system, &s).iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-6, "{found} {expected}");
        }
        assert!(expected[count - 1] > 0.98 && expected[0] < -0.05, "{expected:?}");
    }
}

/// Two equal balls that strike without loss exchange their velocities; with e, the velocity is divided (1 − e)/2 : (1 + e)/2.
#[test]
fn two_equal_balls_exchange_their_velocities() {
    for restitution in [1.0, 0.4] {
        let law = Law::Constraint { restitution, friction: 0.0 };
        let expected = [0.5 * (1.0 - restitution), 0.5 * (1.0 + restitution)];
        let check = |s: &State, system: &Contacting<Multibody>, name: &str| {
            for (found, expected) in velocities(system, s).iter().zip(expected) {
                assert!((found - expected).abs() < 1e-9, "{name}: {found} {expected}");
            }
        };
        let mut system = row(2, law);
        let (s, _) = run(&mut system, &radau(1e-9), 0.1, None);
        check(&s, &system, "radau");
        let (s, _) = run(&mut system, &MoreauJean::new(0.5).unwrap(), 0.1, Some(1e-3));
        check(&s, &system, "moreau-jean");
        let (s, _) = run(&mut system, &NonsmoothAlpha::decoupled(0.8).unwrap(), 0.1, Some(1e-3));
        check(&s, &system, "nonsmooth");
    }
}
