//! What cannot be built is refused with names.

use super::conformance::profile;
use super::{Watch, odd_body, radau};
use flexion::analysis::Violation;
use flexion::analysis::transient::{Ending, Plan, transient};
use flexion::linalg::Vec3;
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{
    Body, DependentRow, Drive, Flexible, Joint, Kind, Marker, Model, ModelError, Multibody, Part, Spring,
};
use flexion::profile::Motion;
use flexion::system::{Dynamics, Observed, State, System};

fn message(model: Model) -> String {
    Multibody::new(model).map(|_| ()).unwrap_err().to_string()
}

#[test]
fn bodies_without_mass_or_with_impossible_inertia_are_refused() {
    let of = |body: Body| {
        let mut model = Model::new();
        model.body(body);
        message(model)
    };
    assert!(of(Body::new("ghost", 0.0, [1.0; 3])).contains("body `ghost` has the mass 0 kg"));
    assert!(of(Body::new("rod", 1.0, [0.0, 1.0, 1.0])).contains("symmetric and positive definite"));
    assert!(of(Body::new("odd", 1.0, [1.0, 1.0, 3.0])).contains("exceeds the sum of the others by 1.0"));
    let mut turned = Body::new("turned", 1.0, [1.0; 3]);
    turned.frame.rotation[0][0] = 0.9;
    assert!(of(turned).contains("axes that are no rotation"));
    assert_eq!(Multibody::new(Model::new()).map(|_| ()).unwrap_err(), ModelError::Empty);
}

#[test]
fn joints_that_do_not_fit_name_themselves_and_by_how_much() {
    let mut model = Model::new();
    let part = model.body(Body::new("arm", 1.0, [1.0; 3]));
    let from = Marker::new(Part::Ground, [0.0, 0.0, 0.2]).with_axis([0.0, 0.1, 1.0], None).unwrap();
    model.joint(Joint::new("hinge", Kind::Revolute, from, Marker::new(part, [0.0; 3])));
    let error = Multibody::new(model).map(|_| ()).unwrap_err();
    let ModelError::Positions { violations } = &error else { panic!("{error}") };
    assert!((violations[0].length - 0.2).abs() < 1e-15);
    assert!((violations[0].angle - 0.1 / 1.01_f64.sqrt()).abs() < 1e-12, "{violations:?}");
    assert!(error.to_string().contains("`hinge` by 2.000e-1 m"), "{error}");
}

#[test]
fn names_ends_and_drives_are_checked() {
    let two = || {
        let mut model = Model::new();
        let parts = [odd_body("one", 0.1), odd_body("two", 0.9)].map(|body| model.body(body));
        (model, parts)
    };
    let (mut model, [one, two_]) = two();
    model.join("one", Kind::Spherical, [one, two_], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None)).unwrap();
    assert!(message(model).contains("joint `one` has a name that is already taken"));
    let (mut model, [one, _]) = two();
    model.join("self", Kind::Spherical, [one, one], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None)).unwrap();
    assert!(message(model).contains("joint `self` has both ends on the same part"));
    let (mut model, [one, _]) = two();
    assert!(
        model
            .join("far", Kind::Fixed, [one, Part::Body(7)], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None))
            .is_err()
    );
    assert!(
        model.join("none", Kind::Fixed, [one, Part::Ground], Vec3([0.0; 3]), (Vec3([0.0; 3]), None)).is_err()
    );
    let (mut model, [one, two_]) = two();
    let [from, to] = [one, two_].map(|part| Marker::new(part, [0.0; 3]));
    model.spring(Spring {
        name: "soft".into(),
        from,
        to,
        stiffness: -1.0,
        damping: 0.0,
        length: 0.0,
        directions: flexion::multibody::Directions::Line,
    });
    assert!(
        message(model).contains("spring `soft` has a stiffness, damping or length that is not a number ≥ 0")
    );
    let (mut model, [one, two_]) = two();
    let joint = model
        .join("ball", Kind::Spherical, [one, two_], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None))
        .unwrap();
    joint.drive = Drive::Prescribed(Motion::Angle(profile("t")));
    assert!(message(model).contains("joint `ball` is Spherical and has a drive"));
    let (mut model, [one, two_]) = two();
    let joint = model
        .join("jerk", Kind::Revolute, [one, two_], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None))
        .unwrap();
    joint.drive = Drive::Prescribed(Motion::Angle(profile("if(t < 1, 0, t)")));
    let text = message(model);
    let expected = "joint `jerk` has a prescribed angle or displacement that jumps by 1.000e0 at t = 1 s";
    assert!(text.contains(expected), "{text}");
}

/// A square of bars with four hinges: in the plane it moves, in space three rows follow from the others.
fn four_bar(kinds: [Kind; 4]) -> Model {
    let mut model = Model::new();
    let mut body = |name: &str, x, y| model.body(Body::new(name, 1.0, [0.1; 3]).at([x, y, 0.0]));
    let parts = [body("crank", 0.0, 0.5), body("coupler", 0.5, 1.0), body("rocker", 1.0, 0.5)];
    let joints = [
        ("A", [Part::Ground, parts[0]], [0.0, 0.0, 0.0]),
        ("B", [parts[0], parts[1]], [0.0, 1.0, 0.0]),
        ("C", [parts[1], parts[2]], [1.0, 1.0, 0.0]),
        ("D", [parts[2], Part::Ground], [1.0, 0.0, 0.0]),
    ];
    for ((name, ends, point), kind) in joints.into_iter().zip(kinds) {
        model.join(name, kind, ends, Vec3(point), (Vec3([0.0, 0.0, 1.0]), None)).unwrap();
    }
    model
}

#[test]
fn redundant_rows_are_named_with_the_joints_that_they_follow_from() {
    let error = Multibody::new(four_bar([Kind::Revolute; 4])).map(|_| ()).unwrap_err();
    let ModelError::Redundant { rows, freedoms } = &error else { panic!("{error}") };
    assert_eq!((rows.len(), *freedoms), (3, 1), "{error}");
    for name in ["`A`", "`B`", "`C`", "`D`"] {
        assert!(rows.iter().any(|row| row.following().contains(name)), "{name}: {rows:?}");
    }
    // Each with its joint, and the others that make it, by numbers.
    let others = |of: &DependentRow| of.others.iter().all(|(joint, _)| *joint != of.joint && *joint < 4);
    assert!(rows.iter().all(|row| row.joint < 4 && !row.others.is_empty() && others(row)), "{rows:?}");
    assert!(error.to_string().contains("which follows from"), "{error}");
    // 5 + 4 + 3 + 5 = 17 rows of 18.
    let free = [Kind::Revolute, Kind::Cylindrical, Kind::Spherical, Kind::Revolute];
    assert_eq!(Multibody::new(four_bar(free)).unwrap().freedoms(), 1);
    let dropped = Multibody::new(four_bar([Kind::Revolute; 4]).drop_redundant_rows()).unwrap();
    assert_eq!((dropped.dropped().len(), dropped.freedoms(), dropped.size().lambda), (3, 1, 17));
}

/// The square of bars with motors at both cranks.
fn two_motors(motions: [&str; 2]) -> Model {
    let mut model = four_bar([Kind::Revolute; 4]);
    for (k, (at, motion)) in [[0.0; 3], [1.0, 0.0, 0.0]].into_iter().zip(motions).enumerate() {
        let ends = [Part::Ground, Part::Body(2 * k)];
        let joint = model.join(
            &format!("motor {k}"),
            Kind::Cylindrical,
            ends,
            Vec3(at),
            (Vec3([0.0, 0.0, 1.0]), None),
        );
        joint.unwrap().drive = Drive::Prescribed(Motion::Angle(profile(motion)));
    }
    model
}

#[test]
fn motions_that_contradict_each_other_are_refused_with_their_names() {
    for motions in [["t", "2*t"], ["t", "t + 0.1*t^2"]] {
        for model in [two_motors(motions), two_motors(motions).drop_redundant_rows()] {
            let error = Multibody::new(model).map(|_| ()).unwrap_err();
            let ModelError::Contradictory { rows } = &error else { panic!("{error}") };
            assert_eq!(rows.len(), 1, "{rows:?}");
            assert!(rows[0].opposed().starts_with("prescribed angle in joint `motor 1` against"), "{rows:?}");
            assert!(
                rows[0].opposed().contains("`motor 0`") && !error.to_string().contains("drop"),
                "{error}"
            );
        }
    }
    assert!(Multibody::new(two_motors(["t", "t"]).drop_redundant_rows()).is_ok());
}

/// The motors agree at the start, with their accelerations, and no longer.
#[test]
fn a_run_ends_where_a_dropped_row_is_violated() {
    let mut system = Multibody::new(two_motors(["t", "t + 0.1*t^3"]).drop_redundant_rows()).unwrap();
    let mut state = system.initial();
    let plan = Plan::new(1.0, 0.01);
    let mut watch = Watch { each: |_: &mut dyn System, _: &State| (), imbalance: 0.0 };
    let ending = transient(&mut system, &radau(1e-10), &mut state, &plan, &mut watch);
    let Ending::Failed(error) = ending else { panic!("{ending:?}") };
    let text = error.to_string();
    assert!(
        text.contains("prescribed angle in joint `motor 1`") && text.contains("is violated by"),
        "{text}"
    );
    // Before it the violation is what the motors differ by.
    let mut violation = Violation::new(&system);
    violation.evaluate(&mut system, &state);
    let expected = (0.1 * state.t.powi(3)).sin();
    assert!(state.t > 0.0 && expected < 1e-6, "{}", state.t);
    assert!((violation.largest[0] - expected).abs() < 1e-9, "{:?} {expected}", violation.largest);
}

/// Bars along one line: stretched between two pivots, where nothing can move, and a parallelogram that is folded flat.
#[test]
fn a_singular_start_is_refused() {
    for pivots in [[0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 3.0, 2.0]] {
        let mut model = Model::new();
        let mut body = |k: usize| {
            let at = [0.5 * (pivots[k] + pivots[k + 1]), 0.0, 0.0];
            model.body(Body::new(&format!("bar {k}"), 1.0, [0.1; 3]).at(at))
        };
        let parts = [Part::Ground, body(0), body(1), body(2), Part::Ground];
        for k in 0..4 {
            let ends = [parts[k], parts[k + 1]];
            let at = [pivots[k], 0.0, 0.0];
            model
                .join(["A", "B", "C", "D"][k], Kind::Revolute, ends, Vec3(at), (Vec3([0.0, 1.0, 0.0]), None))
                .unwrap();
        }
        for model in [model.clone(), model.drop_redundant_rows()] {
            let error = Multibody::new(model).map(|_| ()).unwrap_err();
            let ModelError::Singular { rows } = &error else { panic!("{error}") };
            assert!(rows.len() == 1 && rows[0].keeps.contains("along"), "{rows:?}");
        }
    }
}

#[test]
fn a_locked_mechanism_is_refused() {
    // A motion that is prescribed at both cranks.
    let mut model = four_bar([Kind::Revolute, Kind::Cylindrical, Kind::Spherical, Kind::Revolute]);
    for (k, at) in [(0, [0.0; 3]), (2, [1.0, 0.0, 0.0])] {
        let ends = [Part::Ground, Part::Body(k)];
        let joint = model.join(
            &format!("motor {k}"),
            Kind::Cylindrical,
            ends,
            Vec3(at),
            (Vec3([0.0, 0.0, 1.0]), None),
        );
        joint.unwrap().drive = Drive::Prescribed(Motion::Angle(profile("t")));
    }
    let text = message(model);
    assert!(text.contains("prescribed angle in joint `motor 2` (which follows from"), "{text}");
    assert!(text.contains("0 degrees of freedom are left"), "{text}");
    // Two hinges with different axes hold a body: it moves no more, and nothing is redundant.
    let mut model = Model::new();
    let part = model.body(Body::new("box", 1.0, [0.1; 3]));
    model
        .join("along z", Kind::Revolute, [Part::Ground, part], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None))
        .unwrap();
    model
        .join("along x", Kind::Revolute, [Part::Ground, part], Vec3([0.0; 3]), (Vec3([1.0, 0.0, 0.0]), None))
        .unwrap();
    let text = message(model);
    assert!(text.contains("redundant") && text.contains("0 degrees of freedom are left"), "{text}");
}

/// A bar on a hinge at its end.
fn arm(velocity: Option<f64>) -> Multibody {
    let mut model = Model::new();
    let velocity = velocity.map(|velocity| [0.0, velocity, 0.0]);
    let body = Body {
        spin: Some(Vec3([0.0, 0.0, 3.0])),
        velocity: velocity.map(Vec3),
        ..Body::new("arm", 2.0, [0.2; 3])
    };
    let part = model.body(body.at([0.5, 0.0, 0.0]));
    model
        .join("h", Kind::Revolute, [Part::Ground, part], Vec3([0.0; 3]), (Vec3([0.0, 0.0, 1.0]), None))
        .unwrap();
    Multibody::new(model).unwrap()
}

/// With a spin, and at the same time the velocity zero of its centre: what is left is J/(J + m a²) of it.
#[test]
fn velocities_that_the_joints_change_are_told() {
    let cautions = arm(Some(0.0)).cautions(&[]);
    assert_eq!(cautions.len(), 2, "{cautions:?}");
    let spin: f64 = 3.0 * 0.2 / (0.2 + 2.0 * 0.25);
    for words in [
        "body `arm`",
        "(0.0000, 0.0000, 3.0000)",
        &format!("{:.4}) rad/s", spin),
        &format!("{:.4}", 0.5 * spin),
    ] {
        assert!(cautions.concat().contains(words), "{words}: {cautions:?}");
    }
    assert_eq!(arm(Some(1.5)).cautions(&[]), Vec::<String>::new());
}

/// The velocity of the centre follows from the spin where it is not given.
#[test]
fn a_velocity_that_is_not_given_follows_from_the_spin_and_the_joints() {
    let system = arm(None);
    assert_eq!(system.cautions(&[]), Vec::<String>::new());
    for (used, expected) in system.initial().v.iter().zip([0.0, 1.5, 0.0, 0.0, 0.0, 3.0]) {
        assert!((used - expected).abs() < 1e-14, "{used} {expected}");
    }
}

/// A beam on a hinge whose motion is prescribed, with a body at its tip, begins to turn with the hinge as a rigid one, in a loop too; not so where
/// its tip is held.
#[test]
fn beams_begin_with_the_motion_that_joints_prescribe() {
    let (speed, length, axis) = (10.0, 2.0, ([0.0, 0.0, 1.0], None));
    let beam = |held: bool| {
        let mut model = Model::new();
        let root = Station {
            position: Vec3([0.5, 0.0, 0.0]),
            tangent: Vec3([1.0, 0.0, 0.0]),
            normal: Vec3([0.0, 1.0, 0.0]),
        };
        let section = Properties::principal([1e6, 20.0, 30.0, 40.0], 0.3, [3e-4, 1e-4, 2e-4]);
        let beam = model.beam(Flexible::new("b", Beam::straight(root, length, 6, section).unwrap()));
        let (first, last) = (Part::Section { beam, node: 0 }, Part::Section { beam, node: 6 });
        let hub = model.body(Body::new("hub", 1.0, [0.1; 3]));
        let turned = model.join("motor", Kind::Revolute, [Part::Ground, hub], [0.0; 3], axis).unwrap();
        turned.drive = Drive::Prescribed(Motion::Angle(profile("10*t")));
        model.join("clamp", Kind::Fixed, [hub, first], root.position, axis).unwrap();
        let tip = [2.5, 0.0, 0.0];
        if held {
            model.join("hold", Kind::Spherical, [Part::Ground, last], tip, axis).unwrap();
        } else {
            let body = model.body(Body::new("tip", 0.2, [0.01; 3]).at(tip));
            model.join("weld", Kind::Fixed, [last, body], tip, axis).unwrap();
        }
        Multibody::new(model).unwrap()
    };
    let mut system = beam(false);
    assert_eq!(system.cautions(&[]), Vec::<String>::new());
    let state = system.initial();
    let line = 0.3 * ((2.5_f64.powi(3) - 0.5_f64.powi(3)) / 3.0) + 2e-4 * length;
    let kinetic = 0.5 * speed * speed * (0.1 + line + 0.2 * 2.5 * 2.5 + 0.01);
    let found = system.energy(&state).kinetic;
    assert!((found - kinetic).abs() < 1e-9 * kinetic, "{found} {kinetic}");
    let held = beam(true).cautions(&[]);
    assert!(matches!(&held[..], [one] if one.contains("`b`") && one.contains("shock")), "{held:?}");
}

/// A slider-crank whose slider is driven beyond its dead centre, and a body whose inertia is all but zero: failure and
/// warning have their names and what to try.
#[test]
fn a_run_that_cannot_go_on_names_the_loop_or_the_body() {
    let fails = |model: Model, end: f64| {
        let mut system = Multibody::new(model).unwrap();
        let mut s = system.initial();
        let plan = Plan::new(end, end / 10.0);
        let mut watch = Watch { each: |_: &mut dyn System, _: &State| {}, imbalance: 0.0 };
        let Ending::Failed(error) = transient(&mut system, &radau(1e-6), &mut s, &plan, &mut watch) else {
            panic!("no failure")
        };
        error.to_string()
    };
    // With a crank and a rod of 1 m the slider reaches 2 m at t = 0.713 s.
    let mut model = Model::new();
    let (height, half) = (0.6, 0.4);
    let crank = model.body(Body::new("crank", 1.0, [0.1; 3]).at([0.5 * 0.8, 0.5 * height, 0.0]));
    let rod = model.body(Body::new("rod", 1.0, [0.1; 3]).at([0.8 + half, 0.5 * height, 0.0]));
    let slider = model.body(Body::new("slider", 1.0, [0.1; 3]).at([1.6, 0.0, 0.0]));
    let z = ([0.0, 0.0, 1.0], None);
    model.join("hinge", Kind::Revolute, [Part::Ground, crank], [0.0; 3], z).unwrap();
    let across = ([1.0, 0.0, 0.0], Some(Vec3::AXES[2]));
    model.join("pin", Kind::Universal, [crank, rod], [0.8, height, 0.0], across).unwrap();
    model.join("wrist", Kind::Spherical, [rod, slider], [1.6, 0.0, 0.0], z).unwrap();
    let x = ([1.0, 0.0, 0.0], None);
    let guide = model.join("guide", Kind::Prismatic, [Part::Ground, slider], [1.6, 0.0, 0.0], x).unwrap();
    guide.drive = Drive::Prescribed(Motion::Angle(profile("t^2*(3 - 2*t)/2")));
    let message = fails(model, 2.0);
    for word in ["`hinge`, `pin`, `wrist`, `guide`", "close to a singular configuration", "t = 0.71"] {
        assert!(message.contains(word), "{word}: {message}");
    }
    let mut model = Model::new();
    model.body(Body::new("bob", 1.0, [1e-30; 3]));
    let cautions = Multibody::new(model).unwrap().cautions(&[]);
    for word in ["body `bob` has the moment of inertia 1.0e-30 kg·m²", "give it that of its shape"] {
        assert!(cautions[0].contains(word), "{cautions:?}");
    }
}
