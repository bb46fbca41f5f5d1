//! Bodies that touch obstacles.

use super::{GRAVITY, odd_body, radau, wave};
use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::contact::{Circle, Contact, ContactForce, Contacting, Law, Obstacle, Plane, Translation};
use flexion::integrator::{GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha};
use flexion::linalg::{Structure, Vec3};
use flexion::multibody::rotation::about;
use flexion::multibody::{Axes, Body, Kind, Load, Marker, Model, Multibody, Part};
use flexion::profile::Expression;
use flexion::system::{Dynamics, Mode, Observed, State, System};
use flexion::verify::dynamics;
use std::sync::Arc;

fn ground(model: Model, restitution: f64) -> Contacting<Multibody> {
    let plane = Plane { point: Vec3([0.0; 3]), normal: Vec3([0.0, 0.0, 1.0]), motion: None };
    let law = Law::Constraint { restitution, friction: 0.0 };
    let contact = Contact { name: "ground".into(), point: 0, obstacle: Arc::new(plane), law };
    Contacting::new(Multibody::new(model).unwrap(), vec![contact])
}

#[derive(Default)]
pub struct Watch {
    pub events: Vec<Event>,
    pub imbalance: f64,
    lowest: f64,
}

impl Observer for Watch {
    fn wants_energy_balance(&self) -> bool {
        true
    }
    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        let imbalance = step.balance.unwrap().imbalance(system.energy(state).total());
        self.imbalance = self.imbalance.max(imbalance.abs());
        let gap = system.channels().iter().position(|c| c.name == "ground.gap");
        let mut values = vec![0.0; system.channels().len()];
        system.record(state, &mut values);
        self.lowest = gap.map_or(self.lowest, |at| self.lowest.min(values[at]));
    }
    fn event(&mut self, event: &Event) {
        self.events.push(event.clone());
    }
}

pub fn run(system: &mut dyn System, method: &dyn Integrator, end: f64, step: Option<f64>) -> (State, Watch) {
    let (mut state, mut watch) = (system.initial(), Watch::default());
    state.mode.iter_mut().zip(system.rows()).for_each(|(mode, set)| {
        *mode = if *set == flexion::system::Set::Free { Mode::Closed } else { Mode::Open };
    });
    let plan = Plan { end, step, longest_step: None, break_steps: 1, contact_step: None, sample: end / 50.0 };
    assert_eq!(transient(system, method, &mut state, &plan, &mut watch), Ending::Finished);
    (state, watch)
}

#[test]
fn a_point_of_a_body_conforms() {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let part = model.body(odd_body("box", 0.3));
    model.contact_point(Marker::new(part, [0.3, -0.2, 0.1]));
    let mut system = ground(model, 0.5);
    let mut s = system.initial();
    s.a.iter_mut().enumerate().for_each(|(i, a)| *a = 3.0 * wave(i, 4.0));
    s.lambda[0] = 1.7;
    let mut defects = dynamics(&mut system, &s);
    // The row does not hold here, and does work.
    defects.retain(|d| d.check != "dE/dt");
    assert_eq!(defects, []);
}

#[test]
fn contacts_and_loads_say_where_they_act() {
    let (height, angle) = (0.3, 0.6_f64);
    let mut model = Model::new();
    let mut body = odd_body("box", height);
    body.frame.rotation = about([0.0, 0.0, angle]);
    let origin = body.frame.position;
    let part = model.body(body);
    let own = Marker::new(part, [0.4, 0.0, 0.0]);
    let push = |name: &str, axes, force: Vec3, moment: Vec3| Load {
        name: name.into(),
        at: own,
        force,
        moment,
        axes,
        amplitude: Some(Arc::new(Expression::new("2 + t", "t", 1.0).unwrap())),
    };
    model.load(push("turning", Axes::Follower, Vec3([3.0, 0.0, 0.0]), Vec3([0.0, 2.0, 0.0])));
    model.load(push("couple", Axes::Dead, Vec3([0.0; 3]), Vec3([1.0, 0.0, 0.0])));
    model.load(push("fixed", Axes::Dead, Vec3([0.0, 0.0, 5.0]), Vec3([0.0; 3])));
    model.contact_point(Marker::new(part, [0.0, 0.5, 0.0]));
    let mut system = ground(model, 0.5);
    let mut s = system.initial();
    s.t = 0.5;
    s.lambda[0] = 1.7;
    let (sin, cos) = angle.sin_cos();
    let expected = [
        ("turning", [0.4 * cos, 0.4 * sin, 0.0], [7.5 * cos, 7.5 * sin, 0.0], [-5.0 * sin, 5.0 * cos, 0.0]),
        ("couple", [0.4 * cos, 0.4 * sin, 0.0], [0.0; 3], [2.5, 0.0, 0.0]),
        ("fixed", [0.4 * cos, 0.4 * sin, 0.0], [0.0, 0.0, 12.5], [0.0; 3]),
        ("ground", [-0.5 * sin, 0.5 * cos, 0.0], [0.0, 0.0, 1.7], [0.0; 3]),
    ];
    let found = system.point_forces(&s);
    assert_eq!(found.len(), expected.len());
    for (found, (name, from_origin, force, moment)) in found.iter().zip(expected) {
        assert_eq!(found.name, name);
        let place = (found.place - origin - Vec3(from_origin)).norm();
        let [force, moment] = [found.force - Vec3(force), found.moment - Vec3(moment)].map(|x| x.norm());
        assert!(place < 1e-15 && force < 1e-14 && moment < 1e-14, "{found:?}");
    }
}

/// A tilted rod falls on one end: Λ = (1 + e) u/(1/m + s²/J) at the horizontal distance s from its centre.
#[test]
fn a_rod_that_falls_on_its_end_is_thrown_into_rotation() {
    let (mass, inertia, half, height, tilt, e) = (1.5, 0.2, 0.6, 0.4, 0.7_f64, 0.5);
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let mut rod = Body::new("rod", mass, [0.002, inertia, inertia]);
    rod.frame.rotation = about([0.0, tilt, 0.0]);
    rod.frame.position[2] = height + half * tilt.sin();
    let part = model.body(rod);
    model.contact_point(Marker::new(part, [half, 0.0, 0.0]));
    let mut system = ground(model, e);
    let fall = (2.0 * GRAVITY * height).sqrt();
    let arm = half * tilt.cos();
    let impulse = (1.0 + e) * fall / (1.0 / mass + arm * arm / inertia);
    let time = fall / GRAVITY;
    let (s, watch) = run(&mut system, &radau(1e-10), time + 1e-3, None);
    assert_eq!(watch.events.len(), 1);
    let EventKind::Impact { impulses, .. } = &watch.events[0].kind else { panic!("{:?}", watch.events) };
    assert!((watch.events[0].time - time).abs() < 1e-9);
    assert!((impulses[0] / impulse - 1.0).abs() < 1e-8, "{impulses:?} for {impulse}");
    assert!((s.v[2] - (-fall + impulse / mass - GRAVITY * 1e-3)).abs() < 1e-7, "{:?}", s.v);
    // The end is thrown up: about −y.
    assert!((s.v[4] + impulse * arm / inertia).abs() < 1e-7, "{:?}", s.v);
    assert!(watch.imbalance < 1e-8, "{:e}", watch.imbalance);
}

/// A hanging arm of many links swings down on the ground; its multipliers are in the band, that of the contact in the
/// border, in the stabilized form too.
#[test]
fn the_end_of_a_chain_lands_on_the_ground() {
    let n = 14;
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let (mut last, length) = (Part::Ground, 0.2);
    for i in 0..n {
        let x = length * f64::from(i);
        let next =
            model.body(Body::new(&format!("link {i}"), 0.4, [0.002; 3]).at([x + 0.5 * length, 0.0, 0.3]));
        let axis = ([0.0, 1.0, 0.0], None);
        model.join(&format!("hinge {i}"), Kind::Revolute, [last, next], [x, 0.0, 0.3], axis).unwrap();
        last = next;
    }
    model.contact_point(Marker::new(last, [0.5 * length, 0.0, 0.0]));
    let mut system = ground(model, 0.0);
    for multipliers in [1, 2] {
        let structure = system.structure(multipliers);
        assert!(matches!(structure, Structure::Ordered { .. }), "{structure:?}");
        assert_eq!(structure.border(), multipliers);
    }
    for stabilized in [false, true] {
        let method = GeneralizedAlpha::chung_hulbert(0.7).unwrap();
        let method = if stabilized { method.stabilized() } else { method };
        let (s, watch) = run(&mut system, &method, 0.4, Some(5e-4));
        let impact = watch.events.iter().any(|e| matches!(e.kind, EventKind::Impact { .. }));
        assert!(impact, "{:?}", watch.events);
        assert!(watch.lowest > -1e-6, "{:e}", watch.lowest);
        // Of some 40 J that have been set free.
        assert!(watch.imbalance < 0.02, "{:e}", watch.imbalance);
        assert!(s.is_finite());
    }
}

/// A point of a body at an obstacle, with a law that rubs.
fn rubbing(obstacle: Arc<dyn Obstacle>, law: Law) -> Contacting<Multibody> {
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let part = model.body(odd_body("box", 0.3));
    model.contact_point(Marker::new(part, [0.3, -0.2, 0.1]));
    let contact = Contact { name: "wall".into(), point: 0, obstacle, law };
    Contacting::new(Multibody::new(model).unwrap(), vec![contact])
}

/// Two directions of sliding, on a plane and inside a cylinder: forces, rows and tangents against differences.
#[test]
fn a_point_that_rubs_in_space_conforms() {
    let size = (1.0_f64 + 4.0 + 0.25).sqrt();
    let normal = [1.0, -2.0, 0.5].map(|x| x / size);
    // The point is 5 cm inside.
    let plane =
        |x: f64| Arc::new(Plane { point: Vec3(normal.map(|n| x * n)), normal: Vec3(normal), motion: None });
    let hole = |x: f64| {
        Arc::new(Circle {
            centre: Vec3([0.0; 3]),
            axis: Vec3([0.0, 0.0, 1.0]),
            radius: -x,
            hollow: true,
            motion: None,
        })
    };
    let free = Law::Constraint { restitution: 0.0, friction: 0.0 };
    let inside = |obstacle: Arc<dyn Obstacle>| {
        let mut system = rubbing(obstacle, free);
        let s = system.initial();
        system.gaps(&s)[0] + 0.05
    };
    let plane = plane(inside(plane(0.0)));
    let hole = hole(inside(hole(-1.0)) - 1.0);
    let force = ContactForce { stiffness: 400.0, exponent: 1.5, factor: 0.4, friction: 0.6, slip_speed: 0.7 };
    // A hole along an axis of any direction, which moves.
    let moved = Translation {
        direction: Vec3([0.0, 0.6, 0.8]),
        displacement: Arc::new(Expression::new("0.1*sin(3*t)", "t", 1.0).unwrap()),
    };
    let tilted = |radius: f64| {
        Arc::new(Circle {
            centre: Vec3([0.0; 3]),
            axis: Vec3(normal),
            radius,
            hollow: true,
            motion: Some(moved.clone()),
        })
    };
    let tilted = tilted(1.0 - inside(tilted(1.0)));
    for obstacle in [plane as Arc<dyn Obstacle>, hole, tilted] {
        for law in [Law::Force(force), Law::Constraint { restitution: 0.2, friction: 0.6 }] {
            let mut system = rubbing(Arc::clone(&obstacle), law);
            let mut s = system.initial();
            let rows = if matches!(law, Law::Force(_)) { 0 } else { 3 };
            assert_eq!(s.lambda.len(), rows);
            s.a.iter_mut().enumerate().for_each(|(i, a)| *a = 3.0 * wave(i, 4.0));
            s.lambda.iter_mut().enumerate().for_each(|(i, x)| *x = 1.7 * wave(i, 5.0));
            s.memory.fill(0.9);
            assert!(system.gaps(&s)[0] < 0.0, "the contact is open: {:?}", system.gaps(&s));
            let mut defects = dynamics(&mut system, &s);
            defects.retain(|d| d.check != "dE/dt" || rows == 0);
            assert_eq!(defects, [], "{obstacle:?} {law:?}");
        }
    }
}

/// A body thrown across a slope whose inclination is its angle of friction: its velocity v and its part u down the slope
/// have the constant sum v₀, for both grow by g sin α (1 − u/v) and shrink by as much. In the end it slides down with v₀/2.
#[test]
fn a_body_thrown_across_a_slope_ends_downhill_with_half_its_speed() {
    let (slope, speed) = (0.5_f64, 1.3);
    let (sin, cos) = slope.sin_cos();
    let plane = Plane { point: Vec3([0.0; 3]), normal: Vec3([sin, 0.0, cos]), motion: None };
    let law = Law::Constraint { restitution: 0.0, friction: slope.tan() };
    let contact = Contact { name: "slope".into(), point: 0, obstacle: Arc::new(plane), law };
    let mut model = Model::new().with_gravity([0.0, 0.0, -GRAVITY]);
    let mut body = Body::new("body", 0.7, [0.1; 3]);
    body.velocity = Some(Vec3([0.0, speed, 0.0]));
    let part = model.body(body);
    model.contact_point(Marker::new(part, [0.0; 3]));
    let system = Contacting::new(Multibody::new(model).unwrap(), vec![contact]);
    let methods: [Box<dyn Integrator>; 2] =
        [Box::new(MoreauJean::new(0.5).unwrap()), Box::new(NonsmoothAlpha::decoupled(0.8).unwrap())];
    for mut method in methods {
        let name = method.info().name;
        let mut system = system.clone();
        for end in [0.1, 3.0] {
            let mut off = |step: f64| {
                let (s, _) = run(&mut system, method.as_mut(), end, Some(step));
                let (down, across) = (s.v[0] * cos - s.v[2] * sin, s.v[1]);
                assert!((s.v[0] * sin + s.v[2] * cos).abs() < 1e-9, "{name}: {:?}", s.v);
                assert!(end < 1.0 || across.abs() < 1e-6, "{name}: {:?}", s.v);
                (down.hypot(across) + down - speed).abs()
            };
            // A method of first order: within what gravity does in a step.
            let (coarse, fine) = (off(1e-3), off(2.5e-4));
            assert!(coarse < 5e-4 * GRAVITY && fine < 0.3 * coarse, "{name}, {end} s: {coarse:e}, {fine:e}");
        }
    }
    // A method that locates events leaves it to the same steps, which begin with an eighth of their length and are doubled.
    for end in [0.1, 3.0] {
        let off = |step: f64| {
            let (mut system, mut state) = (system.clone(), system.clone().initial());
            let plan = Plan::new(end, end).with_contact_step(step);
            let ending = transient(&mut system, &radau(1e-6), &mut state, &plan, &mut Watch::default());
            assert_eq!(ending, Ending::Finished);
            let (down, across) = (state.v[0] * cos - state.v[2] * sin, state.v[1]);
            (down.hypot(across) + down - speed).abs()
        };
        let (coarse, fine) = (off(1e-3), off(2.5e-4));
        assert!(coarse < 5e-4 * GRAVITY && fine < 0.5 * coarse, "{end} s: {coarse:e}, {fine:e}");
    }
}
