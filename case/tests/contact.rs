//! Contacts of a case: what is refused, what is recorded, and random ones.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{SQUARE_BAR, finished, outcome, reading};
use flexion_case::{Effort, Reading, parse};
use flexion_results::plot::contact_figure;
use flexion_results::{Directory, Status};
use std::ops::ControlFlow;
use std::path::Path;

/// A pendulum that falls onto the ground; the basis is that of a few modes.
const REST: &str = r#"
[hub]
inertia = 1
motion = { kind = "free", angle = "20 deg" }
[model]
coupling = "high"
[basis]
kind = "modes"
axial = 1
transverse = 2
[[contact]]
name = "ground"
obstacle = { kind = "plane", point = [0, 0] }
law = { kind = "constraint", restitution = 0.3 }
[run]
duration = "0.5 s"
"#;

fn pendulum(set: &[&str]) -> Reading {
    reading(&["gravity = [0, -9.81]\n", SQUARE_BAR, REST].concat(), set)
}

/// Key and text of the one problem of a case that is refused when it is read or prepared.
fn refused(set: &[&str]) -> (String, String) {
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    let read = parse(["gravity = [0, -9.81]\n", SQUARE_BAR, REST].concat(), Path::new("case.toml"), &set);
    let problems = read.and_then(|reading| reading.prepare().map(drop)).unwrap_err();
    assert_eq!(problems.list.len(), 1, "{problems}");
    (problems.list[0].key.clone(), problems.to_string())
}

#[test]
fn bad_contacts_are_refused_at_their_keys() {
    let contact = |keys: &str| format!("contact=[{{{keys}}}]");
    let plane = "obstacle={kind='plane',point=[0,0]}";
    let rigid = "law={kind='constraint',restitution=0.5}";
    let law = |law: &str| contact(&format!("{plane},law={{{law}}}"));
    let wall = |motion: &str| {
        contact(&format!(
            "obstacle={{kind='plane',point=[0,-1],motion={{displacement=[0,1],amplitude={{{motion}}}}}}},{rigid}"
        ))
    };
    for (change, key, words) in [
        (contact(&format!("on='3 m',{plane},{rigid}")), "contact[1].on", "ends at 2 m"),
        (contact(&format!("on='root',{plane},{rigid}")), "contact[1].on", "clamped to the hub"),
        (contact(&format!("on='1 m',points=3,{plane},{rigid}")), "contact[1].points", "whole beam"),
        (contact(&format!("on='1 m',{plane}")), "contact[1].law", "tip"),
        (law("kind='constraint'"), "contact[1].law.restitution", "missing"),
        (law("kind='constraint',restitution=1.1"), "contact[1].law.restitution", "from 0 to 1"),
        (law("kind='constraint',restitution=-0.1"), "contact[1].law.restitution", "from 0 to 1"),
        (law("kind='constraint',restitution=1,friction=-1"), "contact[1].law.friction", "zero or positive"),
        (law("kind='flores',stiffness=1e5,restitution=0"), "contact[1].law.restitution", "no finite damping"),
        (law("kind='hertz',stiffness=0"), "contact[1].law.stiffness", "must be positive"),
        (
            contact(&format!("obstacle={{kind='plane',point=[0]}},{rigid}")),
            "contact[1].obstacle.point",
            "2 components",
        ),
        (
            contact(&format!("obstacle={{kind='stop',offset=0}},{rigid}")),
            "contact[1].obstacle.offset",
            "neither side",
        ),
        (
            contact(&format!("obstacle={{kind='plane',point=[0,1]}},{rigid}")),
            "contact[1].obstacle",
            "inside the obstacle",
        ),
        (contact(&format!("name='tip',{plane},{rigid}")), "contact[1].name", "a meaning of its own"),
        (contact(&format!("name='a b',{plane},{rigid}")), "contact[1].name", "cannot begin"),
        (
            format!("contact=[{{name='a',{plane},{rigid}}},{{name='a',{plane},{rigid}}}]"),
            "contact[2].name",
            "two contacts",
        ),
        (wall("kind='constant'"), "contact[1].obstacle.motion.amplitude", "keeps its place"),
        (
            wall("kind='expression',formula='if(t<0.1,0,1)'"),
            "contact[1].obstacle.motion.amplitude",
            "jumps at t = 0.1",
        ),
    ] {
        let (found, text) = refused(&[&change]);
        assert!(found == key && text.contains(words), "{change}: {found}: {text}");
    }
    // A wall that overtakes the beam at the start: from the point that it touches.
    let touching = "hub.motion={kind='free',angle=0}";
    let (key, text) = refused(&[
        touching,
        &contact(&format!(
            "obstacle={{kind='plane',point=[0,0],motion={{displacement=[0,1],amplitude={{kind='expression',formula='2*t'}}}}}},{rigid}"
        )),
    ]);
    assert!(key == "contact[1].obstacle" && text.contains("closes with 2.000e0 m/s"), "{key}: {text}");
    // Touching at rest is a sound start.
    assert_eq!(finished(&pendulum(&[touching])).trajectory.column("ground.gap").unwrap()[0], 0.0);
}

#[test]
fn the_energy_balance_closes_through_impacts_and_events_give_all_that_is_lost() {
    let run = finished(&pendulum(&["integrator={kind='radau',tolerance=1e-9,absolute-tolerance=1e-11}"]));
    let last = |name: &str| *run.trajectory.column(name).unwrap().last().unwrap();
    let lost = last("energy.contact_loss");
    assert!(lost > 0.1 && (run.events.lost() / lost - 1.0).abs() < 1e-12, "{lost} {}", run.events.lost());
    let balance = run.trajectory.column("energy.balance").unwrap();
    assert!(balance.iter().all(|x| x.abs() < 1e-6 * lost), "{balance:?}");
    // ½ m v² (1 − e²) of the effective mass, which is what an impact by itself takes; the slowest have no restitution.
    for entry in run.events.impacts().filter(|entry| entry.speed > Some(1e-3)) {
        let [mass, speed, loss, impulse] =
            [entry.mass, entry.speed, entry.lost, entry.impulse].map(Option::unwrap);
        let expected = 0.5 * mass * speed * speed * (1.0 - 0.09);
        assert!((loss / expected - 1.0).abs() < 1e-9, "{entry:?} {expected}");
        assert!((impulse / (1.3 * mass * speed) - 1.0).abs() < 1e-9, "{entry:?}");
        // The ground is y = 0, and the tip of the beam, from a hub of radius 0, 2 m from the origin.
        let [x, y, z] = entry.place.unwrap().0;
        assert!((x - 2.0).abs() < 0.01 && y.abs() < 1e-12 && z == 0.0, "{entry:?}");
    }
    assert!(run.events.list.iter().all(|entry| entry.friction.is_none()));
    // What is pressed for a time has an impulse of at most its largest force for that time; impacts have no duration.
    for entry in &run.events.list {
        assert_eq!(entry.duration.is_some(), matches!(entry.what, "opened" | "burst"), "{entry:?}");
        if let (Some(duration), Some(force)) = (entry.duration, entry.force) {
            assert!(entry.impulse.unwrap() <= 1.000_001 * duration * force, "{entry:?}");
        }
    }
    assert!(run.warnings.iter().any(|w| w.contains("a parameter of the mesh")), "{:?}", run.warnings);
}

/// A hub that turns as prescribed does work in an impact, against an obstacle on the ground and against one of its own.
#[test]
fn the_energy_balance_closes_through_impacts_of_a_beam_whose_hub_turns_as_prescribed() {
    for obstacle in [
        "kind='plane',point=[0,'-50 mm']",
        "kind='stop',offset='-2 mm'",
        "kind='plane',point=[0,'200 mm'],angle='180 deg',motion={displacement=[0,-1],amplitude={kind='expression',formula='t'}}",
    ] {
        let contact = format!(
            "contact=[{{obstacle={{{obstacle}}},law={{kind='constraint',restitution=0.5,friction=0.3}}}}]"
        );
        let run = finished(&pendulum(&[
            &contact,
            "hub.motion={kind='spin-up',speed='4 rad/s',time='0.1 s'}",
            "integrator={kind='radau',tolerance=1e-9,absolute-tolerance=1e-11}",
            "run.duration='0.25 s'",
        ]));
        let last = |name: &str| *run.trajectory.column(name).unwrap().last().unwrap();
        assert!(run.events.impacts().count() > 0 && last("energy.drive") != 0.0, "{obstacle}");
        let balance = run
            .trajectory
            .column("energy.balance")
            .unwrap()
            .into_iter()
            .fold(0.0, |m: f64, x| m.max(x.abs()));
        let (work, lost) = (last("energy.drive"), last("energy.contact_loss"));
        assert!(lost > 0.0 && balance < 1e-6 * work.abs(), "{obstacle}: {balance} of {work}, {lost} lost");
    }
}

#[test]
fn shares_of_modes_add_up_to_one_and_need_modes() {
    let run = finished(&pendulum(&["output={modal-shares=true}", "run.duration='0.45 s'"]));
    let share = |k: usize| run.trajectory.column(&format!("mode.{k}.share")).unwrap();
    for (a, b) in share(1).iter().zip(share(2)).skip(1) {
        assert!((a + b - 1.0).abs() < 1e-12 && (0.0..=1.0).contains(a), "{a} {b}");
    }
    let (key, text) = refused(&["output={modal-shares=true}", "basis={kind='finite-elements'}"]);
    assert!(key == "output.modal-shares" && text.contains("basis `modes`"), "{key}: {text}");
}

#[test]
fn the_whole_beam_may_touch_and_obstacles_are_drawn() {
    let set = [
        "contact=[{name='ground',on='beam',points=4,obstacle={kind='plane',point=[0,0]},law={kind='constraint',restitution=0}},\
         {name='rim',obstacle={kind='cylinder',centre=[0,0],radius=3,inside=true},law={kind='hertz',stiffness=1e5}}]",
        "hub.motion.angle='5 deg'",
        "output={step='10 ms',vtk=true,vtk-step='0.1 s'}",
        "run.duration='0.3 s'",
    ];
    let reading = pendulum(&set);
    let run = finished(&reading);
    for column in ["ground.1.gap", "ground.4.gap"] {
        let least = run.trajectory.column(column).unwrap().into_iter().fold(1.0, f64::min);
        assert!((-1e-7..1e-3).contains(&least), "{column}: {least}");
    }
    let folder = tempfile::tempdir().unwrap();
    let directory = Directory::create(folder.path().join("out"), false).unwrap();
    reading.write(&run, &directory).unwrap();
    let text = |name: &str| std::fs::read_to_string(folder.path().join("out").join(name)).unwrap();
    let series = text("beam.pvd");
    assert_eq!(series.matches("part=\"1\" file=\"vtk/obstacles_").count(), 4, "{series}");
    let document = text("vtk/obstacles_00002.vtp");
    let document = roxmltree::Document::parse(&document).unwrap();
    let piece = document.descendants().find(|node| node.has_tag_name("Piece")).unwrap();
    // Two ends of the plane and 73 points of the circle.
    assert_eq!(piece.attribute("NumberOfPoints"), Some("75"));
    assert_eq!(piece.attribute("NumberOfLines"), Some("2"));
    let events = text("events.csv");
    assert!(
        events.starts_with("time [s],contact,event,") && events.contains(",ground.4,impact,"),
        "{events}"
    );
    let summary: serde_json::Value = serde_json::from_str(&text("summary.json")).unwrap();
    assert_eq!(summary["events"]["impacts"], run.events.impacts().count());
}

#[test]
fn a_contact_without_a_name_has_that_of_its_number() {
    let set = [
        "contact=[{obstacle={kind='plane',point=[0,0]},law={kind='constraint',restitution=0}},{obstacle={kind='stop',offset=0.5},law={kind='hertz',stiffness=1e5}}]",
        "run.duration='0.01 s'",
    ];
    let run = outcome(&pendulum(&set));
    for name in ["contact.gap", "contact.force", "contact2.gap", "contact2.force"] {
        assert!(run.trajectory.index(name).is_some(), "{name}");
    }
}

/// The step is the shorter one while the contact is closed or near, and the impact is that of equal short steps.
#[test]
fn steps_are_those_of_contacts_where_one_is_near() {
    let run = |integrator: &str| {
        let integrator = format!("integrator={{kind='generalized-alpha',{integrator}}}");
        finished(&pendulum(&[&integrator, "run.duration='0.4 s'", "output.step='1 ms'"]))
    };
    let (both, long, short) =
        (run("step='1 ms',contact-step='10 us'"), run("step='1 ms'"), run("step='10 us'"));
    let first = |run: &flexion_case::Run| run.events.impacts().next().unwrap().clone();
    let sizes = both.trajectory.column("step.size").unwrap();
    assert_eq!(sizes[100], 1e-3);
    assert!(long.counters.steps < both.counters.steps && both.counters.steps < short.counters.steps / 2);
    assert!((first(&both).time - first(&short).time).abs() < 1e-4, "{:?} {:?}", first(&both), first(&short));
}

/// Impulse, speed and loss of the first impact, by a method that locates events and by two that do not, whose figure
/// enlarges the burst too.
#[test]
fn nonsmooth_methods_tell_their_impacts() {
    let run = |integrator: &str| finished(&pendulum(&[integrator, "run.duration='0.4 s'"]));
    let located = run("integrator={kind='radau',tolerance=1e-8}");
    let expected = located.events.impacts().next().unwrap().clone();
    for kind in ["nonsmooth-generalized-alpha", "moreau-jean"] {
        let run = run(&format!("integrator={{kind='{kind}',step='10 us'}}"));
        let found = run.events.impacts().next().unwrap();
        assert!((found.time - expected.time).abs() < 1e-3, "{kind}: {found:?} {expected:?}");
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 0.02;
        assert!(
            near(found.impulse.unwrap(), expected.impulse.unwrap())
                && near(found.speed.unwrap(), expected.speed.unwrap()),
            "{found:?} {expected:?}"
        );
        assert!(near(found.lost.unwrap(), expected.lost.unwrap()), "{kind}: {found:?} {expected:?}");
        let panels = contact_figure(&run.scene, &run.trajectory, &run.events, None).panels;
        let enlarged = panels.iter().find(|panel| panel.y.quantity == "Gap, first burst").unwrap();
        let (from, to) = enlarged.x.range.unwrap();
        assert!(from < found.time && found.time < to && to - from < 0.1, "{kind}: {from} {to}");
    }
}

/// Another mesh says nothing of the error behind an impact.
#[test]
fn errors_are_those_before_the_first_impact() {
    let reading = pendulum(&["integrator={kind='radau',tolerance=1e-7}", "run.duration='0.4 s'"]);
    let run = finished(&reading);
    let errors = reading.estimate_errors(&run, Effort::Full, &mut |_| ControlFlow::Continue(()));
    assert!(
        errors.warnings.iter().any(|text| text.contains("before the first impact")),
        "{:?}",
        errors.warnings
    );
    let of = |name: &str| errors.columns.iter().find(|c| c.column == name).unwrap().discretization;
    // That behind the impact is 0.3.
    assert!(of("hub.angle") < 1e-3, "{}", of("hub.angle"));
}

/// A wall that rises past the reach of a beam of a metre stretches it by a quarter.
#[test]
fn a_wall_that_overtakes_the_beam_is_named() {
    let text = "
[beam]
length = 1
[section]
kind = 'rectangle'
modulus = 70e9
density = 2700
width = 0.02
height = 0.01
[hub]
motion = { kind = 'constant', speed = 0 }
[[mass]]
on = 'tip'
mass = 1
[[contact]]
name = 'wall'
obstacle = {kind='plane',point=[0,-0.05],motion={displacement=[0,1],amplitude={kind='expression',formula='t'}}}
law = {kind='constraint',restitution=0.5}
[model]
coupling = 'exact'
[basis]
kind = 'finite-elements'
elements = 4
[run]
duration = 1.3
";
    let names = |warning: &&String| warning.contains("the contact `wall` presses with");
    let told = |set: &[&str]| finished(&reading(text, set)).warnings.iter().filter(names).count();
    assert_eq!([told(&[]), told(&["run.duration=0.5"])], [1, 0]);
    // A continuous force lets it in.
    for coupling in ["exact", "space"] {
        let run = finished(&reading(
            text,
            &[
                "contact=[{name='wall',obstacle={kind='plane',point=[0,-1e-3],normal=[0,1]},law={kind='hertz',stiffness=10}}]",
                "load=[{on='1 m',force=[0,-50]}]",
                "run.duration=0.3",
                &format!("model.coupling={coupling}"),
            ],
        ));
        assert!(
            run.warnings.iter().any(|w| w.contains("inside its obstacle")),
            "{coupling}: {:?}",
            run.warnings
        );
    }
}

/// Steps of a loose tolerance damp the vibrations that impacts of a beam in space excite.
#[test]
fn energy_that_steps_lose_behind_impacts_is_told() {
    let text = "
gravity = [0, -9.81]
[beam]
length = 1
[section]
kind = 'uniform'
modulus = '68.952 GPa'
density = 2766.7
area = '3.14 cm^2'
second-moment = '7.85e-9 m^4'
[hub]
motion = { kind = 'free', angle = '45 deg' }
[[contact]]
name = 'ground'
obstacle = { kind = 'plane', point = [0, 0], normal = [0, 1] }
law = { kind = 'constraint', restitution = 0 }
[model]
coupling = 'space'
[basis]
kind = 'finite-elements'
elements = 4
[run]
duration = 0.371
[output]
step = '1 ms'
";
    let told = |tolerance: &str| {
        let run = finished(&reading(text, &[&format!("integrator={{kind='radau',tolerance={tolerance}}}")]));
        let index = run.trajectory.index("energy.balance").unwrap();
        let part = -run.trajectory.extremes(index).min / run.trajectory.largest_energy();
        (part, run.warnings.iter().any(|w| w.contains("of energy have been lost since the first impact")))
    };
    let (loose, tight) = (told("1e-3"), told("1e-6"));
    assert!(loose.0 > 0.01 && loose.1, "{loose:?}");
    assert!(tight.0 < 1e-3 && !tight.1, "{tight:?}");
}

/// Obstacles of a millimetre in the way of the tip, which moves by several centimetres in a step.
#[test]
fn thin_obstacles_are_found_by_steps_that_are_many_times_their_size() {
    let disc = |law: &str| {
        format!(
            "contact=[{{name='pin',obstacle={{kind='cylinder',centre=[1.969615506,0.347296355],radius=0.001}},law={{{law}}}}}]"
        )
    };
    let rigid = disc("kind='constraint',restitution=0.5");
    let elastic = disc("kind='hertz',stiffness=1e6");
    let of = |set: &[&str]| finished(&pendulum(&[&["hub.motion.angle='30 deg'"], set].concat()));
    let trusted = of(&["integrator={kind='radau'}", &rigid]);
    let first = trusted.events.impacts().next().unwrap().time;
    let end = format!("run.duration={}", first + 0.01);
    for integrator in
        ["kind='newmark',step=0.02", "kind='generalized-alpha',step=0.02", "kind='hht',step=0.0123"]
    {
        let integrator = format!("integrator={{{integrator}}}");
        for contact in [&rigid, &elastic] {
            let run = of(&[&integrator, contact, &end]);
            let found = run.events.impacts().next().map(|entry| entry.time);
            assert!(
                found.is_some_and(|time| (time - first).abs() < 2e-3),
                "{integrator} {contact}: {found:?} {first}"
            );
            assert!(!run.warnings.iter().any(|w| w.contains("passed through")), "{:?}", run.warnings);
        }
    }
    for integrator in ["moreau-jean", "nonsmooth-generalized-alpha"] {
        let integrator = format!("integrator={{kind='{integrator}',step=0.02}}");
        let run = of(&[&integrator, &rigid]);
        let warned = run.warnings.iter().any(|w| w.contains("`pin` may have passed through"));
        assert!(warned && run.events.impacts().count() == 0, "{integrator}: {:?}", run.warnings);
        let resolved = of(&[&integrator.replace("0.02", "0.0001"), &rigid, &end]);
        assert!(resolved.events.impacts().count() > 0);
        assert!(!resolved.warnings.iter().any(|w| w.contains("passed through")), "{:?}", resolved.warnings);
    }
}

/// What `left` says of a continuous force: impulse, duration and loss of a rigid pendulum with the mass m = I/L² at its tip,
/// and the loss of the whole run.
#[test]
fn the_events_of_continuous_forces_give_impulse_duration_and_loss() {
    let case = std::fs::read_to_string("../verification/contact_laws/case.toml").unwrap();
    let mass = 1.0;
    for (law, rebound) in
        [("kind='hertz',stiffness=1e7", 1.0), ("kind='matched',stiffness=1e7,restitution=0.5", 0.5)]
    {
        let contact =
            format!("contact=[{{name='ground',obstacle={{kind='plane',point=[0,0]}},law={{{law}}}}}]");
        let run = finished(&reading(&case, &[&contact]));
        let [touched, left] = &run.events.list[..] else { panic!("{:?}", run.events.list) };
        assert_eq!((touched.what, left.what), ("touched", "left"));
        assert!((touched.speed.unwrap() - 1.0).abs() < 1e-4 && touched.impulse.is_none(), "{touched:?}");
        assert!((left.impulse.unwrap() / (mass * (1.0 + rebound)) - 1.0).abs() < 2e-4, "{left:?}");
        let lost = 0.5 * mass * (1.0 - rebound * rebound);
        assert!((left.lost.unwrap() - lost).abs() < 2e-4, "{left:?}");
        let recorded = run.trajectory.column("energy.contact_loss").unwrap();
        assert!(
            (run.events.lost() - recorded.last().unwrap()).abs() < 1e-6,
            "{} {recorded:?}",
            run.events.lost()
        );
        if rebound == 1.0 {
            // δ = (5mv²/4K)^(2/5), F = K δ^(3/2), T = 2.9432752 δ/v (Hertz).
            let deepest = (1.25 * mass / 1e7_f64).powf(0.4);
            assert!((left.indentation.unwrap() / deepest - 1.0).abs() < 2e-4, "{left:?} {deepest}");
            assert!((left.force.unwrap() / (1e7 * deepest.powf(1.5)) - 1.0).abs() < 2e-4, "{left:?}");
            assert!((left.duration.unwrap() / (2.943_275_2 * deepest) - 1.0).abs() < 2e-4, "{left:?}");
        }
    }
}

/// A cantilever on an elastic bed under a force P at its tip: the points are a rule of integration over its length. The tip of
/// a beam on a foundation of K per length, with β = (K/4EI)^¼, is lifted by
/// P/(2EIβ³) (sinh βL cosh βL − sin βL cos βL)/(cosh² βL + cos² βL).
#[test]
fn whole_beam_contact_converges_with_its_points_to_a_beam_on_an_elastic_foundation() {
    let case = std::fs::read_to_string("../verification/beam_on_stop/case.toml").unwrap();
    let (force, bending, foundation, length) = (1e-3, 14e3, 5.6_f64, 10.0);
    let x = (foundation / (4.0 * bending)).powf(0.25) * length;
    let shape = (x.sinh() * x.cosh() - x.sin() * x.cos()) / (x.cosh().powi(2) + x.cos().powi(2));
    let exact = force * (length / x).powi(3) / (2.0 * bending) * shape;
    let error = |points: usize| {
        let contact = format!(
            "contact=[{{name='bed',on='beam',points={points},mount='hub',obstacle={{kind='plane',point=[0,0],angle='180 deg'}},\
             law={{kind='hertz',stiffness={foundation},exponent=1}}}}]"
        );
        let run = finished(&reading(&case, &[&contact, "basis.elements=20"]));
        run.trajectory.column("tip.deflection").unwrap()[0] / exact - 1.0
    };
    let errors = [5, 10, 20].map(error);
    assert!(errors[2].abs() < 1e-3, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((3.9..4.1).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
}

/// Explicit methods hold closed contacts with Baumgarte's constants; without them the error names the key.
#[test]
fn explicit_methods_need_baumgartes_constants_for_rigid_contacts() {
    let method = |keys: &str| format!("integrator={{kind='runge-kutta-4',step='20 us'{keys}}}");
    let (key, text) = refused(&[&method("")]);
    assert!(key == "integrator.step" && text.contains("key `baumgarte`"), "{key}: {text}");
    let run =
        outcome(&pendulum(&[&method(",baumgarte={position=5000,velocity=1000}"), "run.duration='0.4 s'"]));
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    let trusted = finished(&pendulum(&["integrator={kind='radau',tolerance=1e-9}", "run.duration='0.4 s'"]));
    let first = |run: &flexion_case::Run| run.events.impacts().next().unwrap().clone();
    let (found, expected) = (first(&run), first(&trusted));
    assert!((found.time - expected.time).abs() < 1e-7, "{found:?} {expected:?}");
    assert!((found.lost.unwrap() / expected.lost.unwrap() - 1.0).abs() < 1e-4, "{found:?} {expected:?}");
}

/// A beam that sags onto a rigid disc: no extreme of a force that only presses is a pull.
#[test]
fn extremes_of_contact_forces_do_not_go_through_events() {
    let disc = "contact=[{name='bed',on='beam',points=5,obstacle={kind='cylinder',centre=[1.2,-0.53],radius=0.5},law={kind='constraint',restitution=0}}]";
    let run = finished(&pendulum(&[
        disc,
        "hub.motion={kind='constant',speed=0}",
        "basis={kind='finite-elements',elements=10}",
        "model.coupling='first'",
        "damping.mass=20",
        "run.duration=0.3",
        "output.step=0.003",
    ]));
    let mut pressed = 0.0_f64;
    for k in 1..=5 {
        let index = run.trajectory.index(&format!("bed.{k}.force")).unwrap();
        let extremes = run.trajectory.extremes(index);
        pressed = pressed.max(extremes.max);
        assert!(extremes.min >= -1e-9 * extremes.max.max(1.0), "{k}: {extremes:?}");
    }
    assert!(pressed > 1.0 && run.events.list.iter().any(|entry| entry.what == "opened"), "{pressed}");
}

/// A pinned rod falls flat with e = 0.3. At rest it would be pressed against the ground with b = 3g/2, and what its last closing speed v leaves
/// of the bounces takes 2ev/(b(1 − e)), to the limit of the series; no velocity at all is left behind it to measure rounding by.
#[test]
fn bounces_of_a_rigid_rod_that_are_not_followed_take_the_rest_of_their_series() {
    let case = r#"
gravity = [0, 0, -9.81]
[[body]]
name = "rod"
mass = 0.8
inertia = { kind = "principal", moments = [0.06666666666666667, 0.06666666666666667, 1e-9] }
position = [0.3535533905932738, 0, 0.35355339059327373]
axis = [0.7071067811865476, 0, 0.7071067811865475]
[[joint]]
name = "pin"
kind = "revolute"
between = ["ground", "rod"]
at = [0, 0, 0]
axis = [0, -1, 0]
[[contact]]
name = "g"
on = "rod"
at = [0.7071067811865476, 0, 0.7071067811865475]
obstacle = { kind = "plane", normal = [0, 0, 1] }
law = { kind = "constraint", restitution = 0.3 }
[run]
duration = 0.94
[output]
step = 0.005
"#;
    let run = finished(&reading(case, &[]));
    let last = run.events.impacts().last().unwrap();
    let [v, b] = [last.speed.unwrap(), 1.5 * 9.81];
    let neglected = run.events.neglected;
    assert_eq!(neglected.count, 1, "{neglected:?}");
    let time = 2.0 * 0.3 * v / (b * 0.7);
    assert!(v > 1e-5 && (neglected.time / time - 1.0).abs() < 1e-3, "{neglected:?} for {time:e}");
}

/// A ball at rest on an inclined belt, along whose plane the belt goes: that rounding makes the belt rise with 10⁻¹⁶ of its speed is no closing speed. One that does rise
/// is refused.
#[test]
fn a_closing_speed_that_is_rounding_is_none() {
    let case = |belt: &str| {
        format!(
            "
gravity = [0, 0, -9.81]
run = {{ duration = 0.02 }}
output = {{ step = '10 ms' }}
integrator = {{ kind = 'moreau-jean', step = 0.001 }}
[[body]]
name = 'b'
mass = 2
inertia = {{ kind = 'sphere', radius = 0.1 }}
position = [0, 0, 0]
[[contact]]
name = 'k'
on = 'b'
obstacle = {{ kind = 'plane', normal = [0.1, 0.2, 0.7], motion = {{ displacement = {belt}, amplitude = {{ kind = 'expression', formula = '30*t' }} }} }}
law = {{ kind = 'constraint', restitution = 0, friction = 0.2 }}
"
        )
    };
    for belt in [
        "[0.7, 0, -0.1]",
        "[-0.7, 0, 0.1]",
        "[0, 0.7, -0.2]",
        "[0, -0.7, 0.2]",
        "[0.6, 0.4, -0.2]",
        "[-0.6, -0.4, 0.2]",
    ] {
        let run = finished(&reading(&case(belt), &[]));
        assert!(run.trajectory.column("energy.drive").unwrap().last().unwrap() > &0.01, "{belt}");
    }
    let refused = reading(&case("[0.7, 0, -0.0999]"), &[]).prepare().err().unwrap().render(false);
    assert!(refused.contains("touches at the start and closes"), "{refused}");
}
