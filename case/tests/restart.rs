//! A run that goes on from the state of an earlier one is, bit by bit, the run that has never stopped.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{SQUARE_BAR, reading_of as reading};
use flexion::analysis::recording::Entry;
use flexion_case::{Reading, Run};
use flexion_results::{Directory, Status};
use std::ops::ControlFlow;
use std::path::Path;

const REST: &str = r#"
[hub]
inertia = 5
motion = { kind = "spin-up", speed = "8 rad/s", time = "0.3 s" }
[basis]
elements = 4
[integrator]
kind = "radau"
[run]
duration = "0.5 s"
[output]
step = "7 ms"
plots = false
"#;

const INTEGRATORS: &[&str] = &[
    "integrator={kind='radau'}",
    "integrator={kind='radau',tolerance=1e-3,absolute-tolerance=1e-5}",
    "integrator={kind='newmark',step='2 ms'}",
    "integrator={kind='hht',step='3 ms',alpha=0.1}",
    "integrator={kind='generalized-alpha',step='2 ms'}",
    "integrator={kind='runge-kutta-4',step='10 us'}",
    "integrator={kind='adams-4',step='1 us'}",
];

const MODELS: &[&[&str]] = &[
    &[],
    &["model.coupling=exact"],
    &[
        "hub.motion={kind='free',torque={kind='ramp',torque='20 N*m',time='0.1 s'},controller={kind='pd',proportional=30,derivative=4,target='1 rad',rate='3 rad/s',limit=9}}",
    ],
    &[
        "model.coupling=exact",
        "section.rotary-inertia=true",
        "hub.motion={kind='free',torque={kind='constant',torque='20 N*m'}}",
    ],
];

/// Runs until the first step that ends at `until` or later.
fn run(reading: &Reading, until: f64) -> Run {
    let prepared = reading.prepare().unwrap_or_else(|problems| panic!("{}", problems.render(false)));
    prepared.run(&mut |state| {
        if state.t >= until { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })
}

fn bits(numbers: impl IntoIterator<Item = f64>) -> Vec<u64> {
    numbers.into_iter().map(f64::to_bits).collect()
}

/// Compares what the run recorded after `since` with the continued one.
fn assert_same(whole: &Run, parts: &Run, since: f64, what: &str) {
    let rows = |run: &Run| -> Vec<Vec<u64>> {
        // A row at the very end of the first part, but for rounding, belongs to that part.
        let after = run.trajectory.rows().filter(|(t, _)| *t > since * (1.0 + 1e-12));
        after.map(|(t, row)| bits(std::iter::once(t).chain(row.iter().copied()))).collect()
    };
    assert!(rows(whole).len() > 10, "{what}: nothing to compare");
    for (n, (a, b)) in rows(whole).iter().zip(&rows(parts)).enumerate() {
        for (k, (a, b)) in a.iter().zip(b).enumerate() {
            let name = k.checked_sub(1).map_or("t", |k| &whole.trajectory.channels()[k].name);
            let (x, y) = (f64::from_bits(*a), f64::from_bits(*b));
            let t = f64::from_bits(rows(whole)[n][0]);
            assert!(a == b, "{what}: {name} differs at t = {t}: {x:e} and {y:e}");
        }
    }
    assert_eq!(rows(whole).len(), rows(parts).len(), "{what}: numbers of rows");
    assert_eq!(parts.trajectory.len(), rows(parts).len(), "{what}: rows before the start");
    assert_eq!(whole.counters, parts.counters, "{what}");
    assert!(
        whole
            .checkpoint
            .entries()
            .zip(parts.checkpoint.entries())
            .all(|((a, x), (b, y))| { a == b && bits(x.iter().copied()) == bits(y.iter().copied()) }),
        "{what}: the last states differ"
    );
}

#[test]
fn a_stopped_run_goes_on_as_if_it_had_never_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    std::fs::write(&case, [SQUARE_BAR, REST].concat()).unwrap();
    for model in MODELS {
        for integrator in INTEGRATORS {
            let mut set = model.to_vec();
            set.push(integrator);
            if integrator.contains("runge") {
                set.extend(["run.duration=0.15 s", "output.step=2 ms"]);
            }
            if integrator.contains("adams") {
                set.extend(["run.duration=0.01 s", "output.step=0.1 ms"]);
            }
            let what = format!("{set:?}");
            let whole = reading(&case, &set);
            let duration = whole.case.duration;
            let complete = run(&whole, f64::INFINITY);
            assert_eq!(complete.status, Status::Finished, "{what}: {:?}", complete.message);
            let first = run(&whole, 0.43 * duration);
            assert_eq!(first.status, Status::Stopped, "{what}");
            let results = folder.path().join("first");
            let directory = Directory::create(&results, true).unwrap();
            whole.write(&first, &directory).unwrap();
            drop(directory);
            // In two pieces, the second one from the copy of the state among the results.
            set.push("initial={kind='restart',file='first'}");
            let second = run(&reading(&case, &set), 0.71 * duration);
            let results = folder.path().join("second");
            let directory = Directory::create(&results, true).unwrap();
            reading(&case, &set).write(&second, &directory).unwrap();
            drop(directory);
            assert!(results.join("initial.npz").exists());
            set.pop();
            set.push("initial={kind='restart',file='second/state.npz'}");
            let third = run(&reading(&case, &set), f64::INFINITY);
            assert_eq!(third.status, Status::Finished, "{what}: {:?}", third.message);
            assert_same(&complete, &third, second.state.t, &what);
        }
    }
}

/// What happened at contacts after `since`, with all its quantities.
fn later(run: &Run, since: f64) -> Vec<(&'static str, Vec<Option<u64>>)> {
    let later = run.events.list.iter().filter(|entry| entry.time > since);
    let numbers = |e: &Entry| {
        let place = e.place.map_or([None; 3], |place| place.0.map(Some));
        let known = [e.impulse, e.friction, e.speed, e.mass, e.lost, e.duration, e.force, e.indentation];
        [Some(e.time)].into_iter().chain(known).chain(place).map(|x| x.map(f64::to_bits)).collect()
    };
    later.map(|entry| (entry.what, numbers(entry))).collect()
}

/// Stops the case at these parts of its duration, goes on from each, and compares with the complete run, which it returns, with how many of the
/// stops are in a burst.
fn assert_goes_on(case: &Path, set: &[&str], parts: &[f64]) -> (Run, usize) {
    let whole = reading(case, set);
    let complete = run(&whole, f64::INFINITY);
    assert_eq!(complete.status, Status::Finished, "{set:?}: {:?}", complete.message);
    let mut in_bursts = 0;
    for part in parts {
        let what = format!("{set:?} from {part}");
        let first = run(&whole, part * whole.case.duration);
        in_bursts += usize::from(first.checkpoint.list("burst").is_ok());
        let directory = Directory::create(case.with_file_name("first"), true).unwrap();
        whole.write(&first, &directory).unwrap();
        drop(directory);
        let on = [set, &["initial={kind='restart',file='first'}"]].concat();
        let rest = run(&reading(case, &on), f64::INFINITY);
        assert_eq!(rest.status, Status::Finished, "{what}: {:?}", rest.message);
        assert_same(&complete, &rest, first.state.t, &what);
        let (known, found) = (later(&complete, first.state.t), later(&rest, first.state.t));
        known.iter().zip(&found).for_each(|(known, found)| assert_eq!(known, found, "{what}"));
        assert_eq!(known.len(), found.len(), "{what}: numbers of events");
    }
    (complete, in_bursts)
}

/// Pieces that end while contacts are closed: a rigid one at the tip, and an elastic one in the middle.
#[test]
fn a_run_that_is_stopped_in_contact_goes_on_as_if_it_had_never_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    std::fs::write(&case, [SQUARE_BAR, REST].concat()).unwrap();
    let contacts = "contact=[{obstacle={kind='stop',offset='-1 mm'},law={kind='constraint',restitution=0.4,friction=0.1}},\
                    {on='1 m',obstacle={kind='stop',offset='-0.2 mm'},law={kind='hunt-crossley',stiffness=1e6,restitution=0.5}}]";
    for integrator in ["integrator={kind='radau'}", "integrator={kind='generalized-alpha',step='1 ms'}"] {
        let (complete, _) = assert_goes_on(&case, &[contacts, integrator], &[0.2, 0.43, 0.6]);
        let closed = |name: &str| complete.trajectory.column(name).unwrap().iter().any(|force| *force > 0.0);
        assert!(closed("contact.force") && closed("contact2.force"));
    }
}

/// Every method, in plane and in space, stopped at times that are not special: within bursts of impacts, and while a contact presses.
#[test]
fn every_method_goes_on_bit_by_bit_in_the_plane_and_in_space() {
    const FALLING: &str = "
gravity = [0, -9.81]
[beam]
length = 1
[section]
kind = 'resultants'
mass-per-length = 0.54
axial-stiffness = 1e5
bending-stiffness = 11.6
[hub]
inertia = 0.1
motion = { kind = 'free', angle = 0.1 }
[[mass]]
on = 'tip'
mass = 0.2
[basis]
elements = 3
[run]
duration = 0.2
[output]
step = 1e-3
plots = false
";
    const HARD: &str =
        "contact=[{on='tip',obstacle={kind='plane',point=[0,0.05]},law={kind='constraint',restitution=0.5}}]";
    const RUBBED: &str = "contact=[{on='tip',obstacle={kind='plane',point=[0,0.05]},law={kind='constraint',restitution=0,friction=0.3}}]";
    const SOFT: &str = "contact=[{on='tip',obstacle={kind='plane',point=[0,0.05]},law={kind='hunt-crossley',stiffness=1e5,restitution=0.6}}]";
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    std::fs::write(&case, FALLING).unwrap();
    let mut random = 2025_u64;
    let mut part = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.1 + 0.8 * (random >> 11) as f64 / (1_u64 << 53) as f64
    };
    for coupling in ["model.coupling=exact", "model.coupling=space"] {
        for (integrator, contacts) in [
            ("integrator={kind='radau'}", [HARD, SOFT].as_slice()),
            ("integrator={kind='newmark',step=3e-4}", &[SOFT]),
            ("integrator={kind='hht',step=3e-4}", &[SOFT]),
            ("integrator={kind='generalized-alpha',step=3e-4}", &[HARD, SOFT]),
            ("integrator={kind='generalized-alpha',step=3e-4,stabilized=true}", &[HARD, SOFT]),
            ("integrator={kind='nonsmooth-generalized-alpha',step=3e-4}", &[HARD, RUBBED, SOFT]),
            ("integrator={kind='moreau-jean',step=3e-4}", &[HARD, RUBBED, SOFT]),
            ("integrator={kind='runge-kutta-4',step=1e-5}", &[]),
            ("integrator={kind='adams-4',step=5e-6}", &[]),
        ] {
            for contact in ["contact=[]"].iter().chain(contacts) {
                let explicit = contacts.is_empty();
                if explicit && coupling.ends_with("space") {
                    continue; // They have no way to hold joints.
                }
                let times = if explicit {
                    ["run.duration=0.02", "output.step=1e-4"]
                } else {
                    ["run.duration=0.2", "output.step=1e-3"]
                };
                let set = [coupling, integrator, contact, times[0], times[1]];
                let (complete, _) = assert_goes_on(&case, &set, &[part(), part(), part()]);
                assert!(contact.len() < 20 || !complete.events.list.is_empty(), "{set:?}");
            }
        }
    }
}

/// An arm that lies down chatters, and a ball that rolls rubs: both are followed by the steps of another method, within which the run stops too.
#[test]
fn a_run_that_is_stopped_while_contacts_chatter_or_rub_goes_on_bit_by_bit() {
    const ARM: &str = "
gravity = [0, -9.81]
run = { duration = 0.5 }
output = { step = '2 ms', plots = false }
beam = { length = 1 }
damping = { stiffness = '0.2 ms' }
section = { kind = 'circle', modulus = '2 GPa', density = 1200, radius = '5 mm' }
hub = { motion = { kind = 'free', angle = '2 deg' } }
model = { coupling = 'exact' }
basis = { kind = 'finite-elements', elements = 6 }
[[contact]]
name = 'floor'
on = 'beam'
points = 6
obstacle = { kind = 'plane', point = [0, '-1 mm'] }
law = { kind = 'constraint', restitution = 0.2 }
";
    const BALL: &str = "
gravity = [0, 0, -9.81]
run = { duration = 1 }
output = { step = '5 ms', plots = false }
[[body]]
name = 'ball'
mass = 1
inertia = { kind = 'sphere', radius = '5 cm' }
position = [0, 0, '6 cm']
velocity = [0.6, 0.8, 0]
[[contact]]
name = 'ground'
on = 'ball'
radius = '5 cm'
obstacle = { kind = 'plane', normal = [0, 0, 1], motion = { displacement = [0, 0, '-1 m'], amplitude = { kind = 'expression', formula = '8 * max(t - 0.6, 0)^2' } } }
law = { kind = 'constraint', restitution = 0.2, friction = 0.3 }
";
    // More contacts than motions.
    const FEET: &str = "
gravity = [0, 0, -9.81]
run = { duration = 1 }
output = { step = '5 ms', plots = false }
[[body]]
name = 'box'
mass = 1
inertia = { kind = 'box', size = [0.3, 0.2, 0.1] }
position = [0, 0, '6 cm']
[[contact]]
on = 'box'
at = [0.15, 0.1, 0.01]
obstacle = { kind = 'plane', normal = [0, 0, 1] }
law = { kind = 'constraint', restitution = 0 }
[[contact]]
on = 'box'
at = [-0.15, 0.1, 0.01]
obstacle = { kind = 'plane', normal = [0, 0, 1] }
law = { kind = 'constraint', restitution = 0 }
[[contact]]
on = 'box'
at = [-0.15, -0.1, 0.01]
obstacle = { kind = 'plane', normal = [0, 0, 1] }
law = { kind = 'constraint', restitution = 0 }
[[contact]]
on = 'box'
at = [0.15, -0.1, 0.01]
obstacle = { kind = 'plane', normal = [0, 0, 1] }
law = { kind = 'constraint', restitution = 0 }
";
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    for text in [ARM, BALL, FEET] {
        std::fs::write(&case, text).unwrap();
        for integrator in [
            "integrator={kind='radau',tolerance=1e-4}",
            "integrator={kind='generalized-alpha',step='0.5 ms'}",
        ] {
            let parts = [0.02, 0.236, 0.37, 0.64, 0.86];
            let (_, in_bursts) = assert_goes_on(&case, &[integrator], &parts);
            assert!(
                (1..parts.len()).contains(&in_bursts),
                "{integrator}: {in_bursts} are stopped in a burst"
            );
        }
    }
}

/// With fixed steps a run may also be prolonged.
#[test]
fn a_finished_run_is_prolonged_by_the_same_steps() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    std::fs::write(&case, [SQUARE_BAR, REST].concat()).unwrap();
    for set in [
        ["integrator={kind='newmark',step='2 ms'}", "model.coupling=exact"],
        ["integrator={kind='runge-kutta-4',step='10 us'}", "model.coupling=first"],
    ] {
        let short = reading(&case, &[set[0], set[1], "run.duration=0.25"]);
        let first = run(&short, f64::INFINITY);
        let directory = Directory::create(folder.path().join("short"), true).unwrap();
        short.write(&first, &directory).unwrap();
        drop(directory);
        let complete = run(&reading(&case, &set), f64::INFINITY);
        let prolonged =
            run(&reading(&case, &[set[0], set[1], "initial={kind='restart',file='short'}"]), f64::INFINITY);
        assert_eq!(prolonged.status, Status::Finished, "{:?}", prolonged.message);
        assert_same(&complete, &prolonged, 0.25, set[0]);
    }
}

#[test]
fn another_model_is_refused_and_another_integrator_begins_anew() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    std::fs::write(&case, [SQUARE_BAR, REST].concat()).unwrap();
    let first = reading(&case, &[]);
    let run_there = run(&first, 0.2);
    let directory = Directory::create(folder.path().join("first"), true).unwrap();
    first.write(&run_there, &directory).unwrap();
    drop(directory);
    let from = "initial={kind='restart',file='first'}";
    for (change, reason) in [
        ("section.modulus=6 GPa", "`section.modulus` was 7"),
        ("basis.elements=5", "`basis.elements` was 4 and is 5"),
        ("hub.motion={kind='constant',speed=8}", "`hub.motion.kind` was spin-up and is constant"),
        ("model.coupling=exact", "`model.coupling` was \"first\" and is \"exact\""),
        ("run.duration=0.1", "the earlier run ended at t = 0.2"),
    ] {
        let problems = reading(&case, &[from, change, "output.step=1 ms"]).prepare().map(|_| ()).unwrap_err();
        let text = problems.to_string();
        assert!(text.contains(reason), "{change}: {text}");
    }
    for broken in ["case.toml", "missing.npz"] {
        let from = format!("initial={{kind='restart',file='{broken}'}}");
        let problems = flexion_case::read(&case, &[from]).map(|_| ()).unwrap_err();
        assert_eq!(problems.list[0].key, "initial.file");
        assert!(problems.to_string().contains(broken), "{problems}");
    }
    // Another method starts there, and goes the same way.
    let other = run(&reading(&case, &[from, "integrator={kind='newmark',step='0.1 ms'}"]), f64::INFINITY);
    assert_eq!(other.status, Status::Finished, "{:?}", other.message);
    let complete = run(&first, f64::INFINITY);
    let last = |run: &Run| *run.trajectory.column("tip.deflection").unwrap().last().unwrap();
    assert!(
        (last(&other) - last(&complete)).abs() < 1e-4 * last(&complete).abs().max(1e-2),
        "{} {}",
        last(&other),
        last(&complete)
    );
    // A step that the new duration would change.
    let set = ["integrator={kind='newmark',step='2 ms'}"];
    let fixed = run(&reading(&case, &set), 0.2);
    let directory = Directory::create(folder.path().join("fixed"), true).unwrap();
    reading(&case, &set).write(&fixed, &directory).unwrap();
    drop(directory);
    let uneven = reading(&case, &[set[0], "initial={kind='restart',file='fixed'}", "run.duration=0.6011"]);
    let refused = uneven.prepare().err().map(|problems| problems.render(false)).unwrap_or_default();
    assert!(refused.contains("multiple"), "{refused}");
}

/// Numbers that no run has are refused, and nothing panics.
#[test]
fn a_state_with_numbers_that_no_run_has_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    std::fs::write(&case, [SQUARE_BAR, REST].concat()).unwrap();
    for integrator in ["integrator={kind='radau'}", "integrator={kind='newmark',step='2 ms'}"] {
        let whole = reading(&case, &[integrator]);
        let results = folder.path().join("first");
        let directory = Directory::create(&results, true).unwrap();
        whole.write(&run(&whole, 0.2), &directory).unwrap();
        drop(directory);
        let file = results.join("state.npz");
        let (good, text) = flexion_results::read_state(std::fs::File::open(&file).unwrap()).unwrap();
        let on =
            reading(&case, &[integrator, &format!("initial={{kind='restart',file='{}'}}", file.display())]);
        assert_eq!(run(&on, f64::INFINITY).status, Status::Finished);
        for name in ["run", "last", "sample", "control", "segment", "time", "format"] {
            let Ok(list) = good.list(name) else { continue };
            for wrong in [f64::NAN, f64::INFINITY, -1.0] {
                let mut bad = good.clone();
                bad.put(name, &vec![wrong; list.len()]);
                flexion_results::write_state(&bad, &text, std::fs::File::create(&file).unwrap()).unwrap();
                let set = [integrator, &format!("initial={{kind='restart',file='{}'}}", file.display())];
                let Ok(reading) = flexion_case::read(&case, &set.map(str::to_owned)) else { continue };
                // Refused while it is read, or as soon as it runs; never a panic.
                if let Ok(prepared) = reading.prepare() {
                    let run = prepared.run(&mut |_| ControlFlow::Continue(()));
                    assert!(
                        wrong == -1.0 || run.status == Status::Failed,
                        "{name} = {wrong}: {:?}",
                        run.message
                    );
                }
            }
        }
    }
}

/// With a folder of results or without: a case whose state lacks something is refused before anything is written.
#[test]
fn a_state_that_lacks_a_list_or_a_number_is_refused_at_its_key() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    std::fs::write(&case, [SQUARE_BAR, REST].concat()).unwrap();
    for integrator in ["integrator={kind='radau'}", "integrator={kind='generalized-alpha',step='2 ms'}"] {
        let whole = reading(&case, &[integrator]);
        let first = run(&whole, 0.2);
        let directory = Directory::create(folder.path().join("first"), true).unwrap();
        whole.write(&first, &directory).unwrap();
        drop(directory);
        let file = folder.path().join("first/state.npz");
        let (good, text) = flexion_results::read_state(std::fs::File::open(&file).unwrap()).unwrap();
        let refusal = |bad: &flexion::integrator::Checkpoint| {
            flexion_results::write_state(bad, &text, std::fs::File::create(&file).unwrap()).unwrap();
            let set = [integrator, "initial={kind='restart',file='first'}"].map(str::to_owned);
            let read = flexion_case::read(&case, &set).and_then(|reading| reading.prepare().map(drop));
            read.err().map(|problems| problems.render(false))
        };
        assert_eq!(refusal(&good), None);
        let mut seen = 0;
        for (name, list) in good.entries() {
            if name.starts_with("events") || name.starts_with("energy") && name != "energy.gain" {
                continue;
            }
            let mut without = flexion::integrator::Checkpoint::default();
            good.entries()
                .filter(|(other, _)| *other != name)
                .for_each(|(name, list)| without.put(name, list));
            let said = refusal(&without).unwrap_or_else(|| panic!("{integrator}: without {name}"));
            assert!(said.contains(name) || name == "format", "{said}");
            if !list.is_empty() && !["accepted", "control"].contains(&name) {
                let mut bad = good.clone();
                let mut numbers = list.to_vec();
                numbers[list.len() - 1] = f64::NAN;
                bad.put(name, &numbers);
                assert!(refusal(&bad).is_some(), "{integrator}: {name} with NaN");
                seen += 1;
            }
        }
        assert!(seen > 10, "{seen}");
    }
}
