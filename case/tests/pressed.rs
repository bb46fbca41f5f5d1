//! Contacts that nothing stops, that hold what a joint holds too, and that press from the start.

#![allow(clippy::unwrap_used)] // in helpers of tests

use super::verification::run::integrate;
use flexion_case::{Reading, parse};
use std::path::Path;

const METHODS: [&str; 5] = [
    "{ kind = 'nonsmooth-generalized-alpha', step = '1 ms' }",
    "{ kind = 'nonsmooth-generalized-alpha', step = '1 ms', decoupled = false }",
    "{ kind = 'moreau-jean', step = '1 ms' }",
    "{ kind = 'generalized-alpha', step = '1 ms' }",
    "{ kind = 'radau' }",
];
const FLOOR: &str = "obstacle = { kind = 'plane', normal = [0, 0, 1] }";

fn read(text: &str) -> Reading {
    parse(text.to_owned(), Path::new("case.toml"), &[]).unwrap()
}

fn ball(position: f64) -> String {
    format!(
        "[[body]]\nname = 'b'\nmass = 1\ninertia = {{ kind = 'sphere', radius = 0.1 }}\nposition = [0, 0, {position}]\n"
    )
}

/// A prescribed travel drives a ball into a floor that it reaches at 0.2 s, and a plane comes down on a ball that lies on the floor and reaches it at 0.25 s.
#[test]
fn contacts_that_nothing_stops_end_a_run() {
    let touch = |name: &str, obstacle: &str, friction: f64| {
        format!(
            "[[contact]]\nname = '{name}'\non = 'b'\nradius = 0.1\n{obstacle}\nlaw = {{ kind = 'constraint', restitution = 0, friction = {friction} }}\n"
        )
    };
    let head = "gravity = [0, 0, -9.81]\nrun = { duration = 0.5 }\noutput = { step = '5 ms' }\n";
    let driven = format!(
        "{head}{}[[joint]]\nkind = 'prismatic'\nbetween = ['ground', 'b']\naxis = [0, 0, 1]\ntravel = {{ kind = 'constant', speed = -1 }}\n{}",
        ball(0.3),
        touch("floor", FLOOR, 0.0)
    );
    let press = "obstacle = { kind = 'plane', normal = [0, 0, -1], point = [0, 0, 0.4], motion = { displacement = [0, 0, '-0.8 m'], \
                 amplitude = { kind = 'expression', formula = 't' } } }";
    let crushed = |friction: f64| {
        format!("{head}{}{}{}", ball(0.1), touch("floor", FLOOR, friction), touch("press", press, friction))
    };
    for (text, time) in [(driven, 0.2), (crushed(0.0), 0.25), (crushed(0.3), 0.25)] {
        for method in METHODS {
            let run = integrate(&read(&format!("integrator = {method}\n{text}"))).unwrap();
            let failure = run.failure.clone().unwrap_or_default();
            let end = run.end;
            assert!(failure.contains("stops what closes it"), "{method}: {failure}");
            assert!((end - time).abs() < 5e-3, "{method}: {end} of {time}");
        }
    }
}

/// A rod on a hinge, whose end lies on a rough floor at the height of the hinge: friction moves nothing there, each carries half the weight, in equilibrium and after it.
#[test]
fn friction_across_what_a_hinge_holds_is_none() {
    for initial in ["", "initial = { kind = 'static' }\n"] {
        for method in METHODS {
            let text = format!(
                "gravity = [0, 0, -9.81]\nrun = {{ duration = 0.05 }}\noutput = {{ step = '5 ms' }}\n{initial}integrator = {method}\n\
                 [[body]]\nname = 'rod'\nmass = 1\ninertia = {{ kind = 'principal', moments = [0.0833333, 0.0833333, 1e-4] }}\n\
                 position = [0.5, 0, 0]\naxis = [1, 0, 0]\n\
                 [[joint]]\nname = 'hinge'\nkind = 'revolute'\nbetween = ['ground', 'rod']\nat = [0, 0, 0]\naxis = [0, 1, 0]\n\
                 [[contact]]\nname = 'end'\non = 'rod'\nat = [1, 0, 0]\n{FLOOR}\nlaw = {{ kind = 'constraint', restitution = 0, friction = 0.3 }}\n"
            );
            let run = integrate(&read(&text)).unwrap();
            assert_eq!(run.failure, None, "{method}");
            let first = usize::from(initial.is_empty());
            for force in &run.column("end.force")[first..] {
                assert!((force / 4.905 - 1.0).abs() < 1e-6, "{method}: {force}");
            }
            let hinge = run.column("hinge.force.z")[0];
            assert!(initial.is_empty() || (hinge / 4.905 - 1.0).abs() < 1e-6, "{method}: {hinge}");
        }
    }
}

/// A box that stands on four feet presses them from the first row on, with its weight and no moment.
#[test]
fn feet_press_from_the_first_row_on() {
    let mut text = "gravity = [0, 0, -9.81]\nrun = { duration = 0 }\ninitial = { kind = 'static' }\nintegrator = { kind = 'radau' }\n[[body]]\nname = 'box'\nmass = 2\n\
                    inertia = { kind = 'box', size = [0.4, 0.3, 0.2] }\nposition = [0.03, 0.02, 0.1]\n"
        .to_owned();
    let feet = [[-0.2, -0.15], [-0.2, 0.15], [0.2, -0.15], [0.2, 0.15]];
    for (i, [x, y]) in feet.iter().enumerate() {
        text.push_str(&format!(
            "[[contact]]\nname = 'c{i}'\non = 'box'\nat = [{x}, {y}, 0]\n{FLOOR}\nlaw = {{ kind = 'constraint', restitution = 0 }}\n"
        ));
    }
    let run = integrate(&read(&text)).unwrap();
    let forces: Vec<f64> = (0..4).map(|i| run.column(&format!("c{i}.force"))[0]).collect();
    let sum =
        |of: &dyn Fn([f64; 2]) -> f64| forces.iter().zip(feet).map(|(f, foot)| f * of(foot)).sum::<f64>();
    assert!((sum(&|_| 1.0) / 19.62 - 1.0).abs() < 1e-9, "{forces:?}");
    assert!((sum(&|[x, _]| x) / (19.62 * 0.03) - 1.0).abs() < 1e-9, "{forces:?}");
    assert!((sum(&|[_, y]| y) / (19.62 * 0.02) - 1.0).abs() < 1e-9, "{forces:?}");
}

/// Two balls in a bowl, of which one falls on the other, whose contacts with the bowl are at its bottom.
#[test]
fn balls_come_together_at_the_bottom_of_a_bowl() {
    for method in &METHODS[..3] {
        let mut text = format!(
            "gravity = [0, 0, -9.81]\nrun = {{ duration = 0.5 }}\noutput = {{ step = '2 ms' }}\nintegrator = {method}\n"
        );
        for (name, radius, place) in [("a", 0.02, [0.0, 0.0, 0.0201]), ("b", 0.05, [0.02, 0.001, 0.15])] {
            text.push_str(&format!(
                "[[body]]\nname = '{name}'\nmass = 0.01\ninertia = {{ kind = 'sphere', radius = {radius} }}\nposition = {place:?}\n\
                 [[contact]]\nname = '{name}o'\non = '{name}'\nradius = {radius}\nobstacle = {{ kind = 'sphere', radius = 0.3, centre = [0, 0, 0.3], inside = true }}\n\
                 law = {{ kind = 'constraint', restitution = 0, friction = 0.4 }}\n"
            ));
        }
        text.push_str(
            "[[contact]]\nname = 'ab'\non = 'a'\nradius = 0.02\nmount = 'b'\nobstacle = { kind = 'sphere', radius = 0.05 }\n\
             law = { kind = 'constraint', restitution = 0, friction = 0.4 }\n",
        );
        let run = integrate(&read(&text)).unwrap();
        assert_eq!(run.failure, None, "{method}");
        let balance = run.column("energy.balance").iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        // A hundredth of what they have fallen by.
        assert!(balance < 0.01 * 0.01 * 9.81 * 0.1, "{method}: {balance}");
    }
}
