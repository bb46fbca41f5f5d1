//! Contacts of a case: what is refused, what is recorded, and random ones.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{SQUARE_BAR, finished, outcome, reading};
use flexion_case::calibration::draw_with_contacts;
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
[gravity]
acceleration = 9.81
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
    reading(&[SQUARE_BAR, REST].concat(), set)
}

/// Key and text of the one problem of a case that is refused when it is read or prepared.
fn refused(set: &[&str]) -> (String, String) {
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    let read = parse([SQUARE_BAR, REST].concat(), Path::new("case.toml"), &set);
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
        (
            contact(&format!("station='3 m',{plane},{rigid}")),
            "contact[1].station",
            "beyond the end of the beam",
        ),
        (contact(&format!("station=0,{plane},{rigid}")), "contact[1].station", "must be positive"),
        (contact(&format!("station=1,points=3,{plane},{rigid}")), "contact[1].points", "not both"),
        (contact(&format!("station=1,{plane}")), "contact[1].law", "tip"),
        (law("kind='constraint'"), "contact[1].law.restitution", "missing"),
        (law("kind='constraint',restitution=1.1"), "contact[1].law.restitution", "from 0 to 1"),
        (law("kind='constraint',restitution=-0.1"), "contact[1].law.restitution", "from 0 to 1"),
        (law("kind='constraint',restitution=1,friction=-1"), "contact[1].law.friction", "zero or positive"),
        (law("kind='flores',stiffness=1e5,restitution=0"), "contact[1].law.restitution", "no finite damping"),
        (law("kind='hertz',stiffness=0"), "contact[1].law.stiffness", "must be positive"),
        (
            contact(&format!("obstacle={{kind='plane',point=[0]}},{rigid}")),
            "contact[1].obstacle.point",
            "2 coordinates",
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
        (contact(&format!("name='tip',{plane},{rigid}")), "contact[1].name", "another kind"),
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
    for entry in run.events.impacts().filter(|entry| entry.speed > 1e-3) {
        let expected = 0.5 * entry.mass * entry.speed * entry.speed * (1.0 - 0.09);
        assert!((entry.lost / expected - 1.0).abs() < 1e-9, "{entry:?} {expected}");
        assert!((entry.impulse / (1.3 * entry.mass * entry.speed) - 1.0).abs() < 1e-9, "{entry:?}");
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
        "contact=[{name='ground',points=4,obstacle={kind='plane',point=[0,0]},law={kind='constraint',restitution=0}},\
         {name='rim',obstacle={kind='circle',centre=[0,0],radius=3,inside=true},law={kind='hertz',stiffness=1e5}}]",
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

/// Contacts in random cases: energy is not made, rigid obstacles are not entered, or the run ends with an error.
#[test]
fn random_contacts_make_no_energy_and_let_nothing_through() {
    let (mut touched, mut failed) = (0, 0);
    for seed in 0..30 {
        let drawn = draw_with_contacts(7_000_003 + seed);
        let set = ["integrator={kind='radau',tolerance=1e-7,absolute-tolerance=1e-9}".to_owned()];
        let reading =
            drawn.read(&set).unwrap_or_else(|problems| panic!("{seed}: {problems}\n{}", drawn.text));
        let Ok(prepared) = reading.prepare() else { continue };
        let mut steps = 0;
        let run = prepared.run(&mut |_| {
            steps += 1;
            if steps > 6_000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        failed += usize::from(run.status == Status::Failed);
        if run.events.impacts().next().is_none() {
            continue;
        }
        touched += 1;
        let columns = |name: &str| run.trajectory.column(name).unwrap();
        let total = columns("energy.total").into_iter().fold(0.0, f64::max);
        let work = columns("energy.drive").into_iter().chain(columns("energy.loads"));
        let scale = work.fold(total, |m, x| m.max(x.abs()));
        let gained = columns("energy.balance").into_iter().fold(0.0, f64::max);
        assert!(gained < 1e-3 * scale, "{seed}: {gained} of {scale}\n{}", drawn.text);
        let entered =
            run.trajectory.column("constraint.position").unwrap_or_default().into_iter().fold(0.0, f64::max);
        assert!(entered < 1e-6 * drawn.length, "{seed}: {entered} of {}\n{}", drawn.length, drawn.text);
    }
    eprintln!("{touched} cases touch, {failed} end with an error");
    assert!(touched > 10 && failed < 10, "{touched} cases touch, {failed} end with an error");
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
            near(found.impulse, expected.impulse) && near(found.speed, expected.speed),
            "{found:?} {expected:?}"
        );
        assert!(near(found.lost, expected.lost), "{kind}: {found:?} {expected:?}");
        let panels = contact_figure(&run.trajectory, &run.events, None).panels;
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
    let errors = reading.estimate_errors(&run, Effort::Full, &mut |_| ControlFlow::Continue(())).unwrap();
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
station = 'tip'
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
    let run = finished(&reading(
        text,
        &[
            "contact=[{name='wall',obstacle={kind='plane',point=[0,-1e-3]},law={kind='hertz',stiffness=10}}]",
            "force=[{station=1,force=[0,-50]}]",
            "run.duration=0.3",
        ],
    ));
    assert!(run.warnings.iter().any(|w| w.contains("inside its obstacle")), "{:?}", run.warnings);
}
