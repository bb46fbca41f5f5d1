//! Cases of a beam on a hub, computed as systems in space.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::verification::run::{Run, all, case, integrate, root};
use crate::written::reading;
use flexion::system::Role;
use flexion_case::kinds::integrator::Steps;
use flexion_case::{Effort, Problems, Reading, parse};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A beam on a hub with all that a short case in space may have.
const SHORT: &str = "
gravity = [0, -9.81]
[beam]
length = '1 m'
[section]
kind = 'resultants'
mass-per-length = '2 kg/m'
axial-stiffness = '1e5 N'
bending-stiffness = '20 N m^2'
[hub]
radius = '10 cm'
inertia = '0.2 kg m^2'
motion = { kind = 'free', angle = '30 deg', speed = '1 rad/s', damping = '0.1 N*m*s/rad' }
[basis]
elements = 4
[[mass]]
on = 'tip'
mass = '100 g'
[[load]]
on = 'beam@0.5 m'
force = [0, 1]
[[spring]]
kind = 'point'
on = '25 cm'
stiffness = '10 N/m'
to = [0, 1]
[damping]
stiffness = '1 ms'
[model]
coupling = 'space'
[run]
duration = '0.2 s'
[output]
stations = ['50 cm']
";

/// The same, written at length.
const LONG: &str = "
gravity = [0, -9.81]
[[beam]]
length = 1
start = [0.08660254037844388, 0.049999999999999996, 0]
direction = [0.8660254037844387, 0.49999999999999994, 0]
up = [-0.49999999999999994, 0.8660254037844387, 0]
velocity = [-0.049999999999999996, 0.08660254037844388, 0]
spin = [0, 0, 1]
elements = 4
planar = true
section = { kind = 'resultants', mass-per-length = 2, axial-stiffness = 1e5, bending-stiffness = 20 }
damping = { stiffness = 1e-3 }
[[body]]
name = 'hub-body'
mass = 0.2
spin = [0, 0, 1]
inertia = { kind = 'principal', moments = [0.2, 0.2, 0.2] }
[[joint]]
name = 'hub'
kind = 'revolute'
between = ['ground', 'hub-body']
at = [0, 0, 0]
motion = { kind = 'free', angle = 0.5235987755982988, damping = 0.1 }
[[joint]]
name = 'clamp'
kind = 'fixed'
between = ['hub-body', 'beam.root']
[[mass]]
on = 'tip'
mass = 0.1
[[load]]
on = '0.5 m'
force = [0, 1]
[[spring]]
kind = 'point'
on = '0.25 m'
stiffness = 10
to = [0, 1, 0]
[run]
duration = 0.2
[output]
root-axes = true
stations = ['0.5 m']
";

fn run(reading: &Reading) -> Run {
    integrate(reading).unwrap_or_else(|e| panic!("{e}"))
}

fn refused(text: &str, set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|&set| set.to_owned()).collect();
    let read = parse(text.to_owned(), Path::new("case.toml"), &set);
    let problems: Problems = read.err().unwrap_or_else(|| panic!("{set:?} is read"));
    problems.to_string()
}

#[test]
fn both_spellings_give_the_same_bytes() {
    let short = run(&reading(SHORT, &[]));
    assert!(short.failure.is_none() && short.steps > 10);
    let resolved = reading(SHORT, &[]).resolved();
    let turned = reading(SHORT, &[]).long().unwrap();
    for (spelling, text) in [("resolved", resolved.as_str()), ("turned", turned.as_str()), ("long", LONG)] {
        let other = run(&reading(text, &[]));
        assert_eq!(short.trajectory.channels(), other.trajectory.channels(), "{spelling}");
        assert_eq!(short.fingerprint(), other.fingerprint(), "{spelling}:\n{resolved}");
    }
}

/// What `flexion check --long` prints of each planar case that runs in space is read as the same case, value for value.
#[test]
fn the_long_spelling_of_a_short_case_is_the_same_case() {
    let mut turned = 0;
    for name in all().into_iter().map(|variant| variant.name) {
        let planar = case(&name, &[]).unwrap();
        if planar.case.hub_beam().is_none() {
            continue;
        }
        assert!(planar.long().unwrap_err().to_string().contains("in the plane"), "{name}");
        let Ok(space) = case(&name, &["model.coupling=space"]) else { continue };
        let folder = root().join(name.split('/').next().unwrap());
        let (long, file) = (space.long().unwrap(), folder.join("case.toml"));
        let again = parse(long.clone(), &file, &[]).unwrap_or_else(|e| panic!("{name}: {e}\n{long}"));
        assert_eq!(again.resolved(), space.resolved(), "{name}:\n{long}");
        turned += 1;
    }
    assert!(turned >= 65, "{turned}");
}

/// Columns that tell of the integration or are differences of large numbers.
fn is_compared(role: Role) -> bool {
    !matches!(role, Role::Integration | Role::Imbalance)
}

/// The largest difference of any recorded time by column, where a column is farther off than a thousandth of its largest value and the
/// errors that both runs state.
fn differences(name: &str, space: &Reading, plane: &Reading) -> Result<Vec<String>, Problems> {
    let prepare =
        |reading: &Reading| Ok::<_, Problems>(reading.prepare()?.run(&mut |_| ControlFlow::Continue(())));
    let (ours, theirs) = (prepare(space)?, prepare(plane)?);
    let mut list = Vec::new();
    if let Some(why) = &ours.message {
        list.push(format!("failed: {why}; in the plane: {:?}", theirs.message));
    }
    let mut stated: Option<[BTreeMap<String, f64>; 2]> = None;
    let mut shared = 0;
    let columns = theirs.trajectory.channels().iter().filter(|c| is_compared(c.role));
    for column in columns.map(|c| c.name.as_str()).filter(|column| !differs(name, column)) {
        let Some(a) = ours.trajectory.column(column) else { continue };
        let b = theirs.trajectory.column(column).unwrap();
        shared += 1;
        let largest = b.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let off = a.iter().zip(&b).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        if a.len() == b.len() && off <= 1e-3 * largest + 1e-9 {
            continue;
        }
        let errors = stated.get_or_insert_with(|| {
            [(space, &ours), (plane, &theirs)].map(|(reading, run)| {
                let errors = reading.estimate_errors(run, Effort::Full, &mut |_| ControlFlow::Continue(()));
                errors.columns.into_iter().map(|of| (of.column, of.discretization)).collect()
            })
        });
        let [s, p] = [0, 1].map(|i| errors[i].get(column).copied().unwrap_or(0.0));
        if a.len() != b.len() || off > 1e-3 * largest + s + p {
            let rows = [a.len(), b.len()];
            list.push(format!(
                "{column}: off by {off:.2e} of {largest:.2e}, stated {s:.1e} and {p:.1e}, rows {rows:?}"
            ));
        }
    }
    if shared < 5 {
        list.push(format!("{shared} columns are shared"));
    }
    Ok(list)
}

/// Longest run: what a case does later it does by the same equations [s].
const LONGEST: f64 = 4.0;
/// Cases of which less is run: their stiff beams vibrate fast.
const SHORTER: [(&str, f64); 7] = [
    ("gravity_rigid_pendulum", 0.06),
    ("pendulum_45", 0.03),
    ("free_hub_stiff_beam", 0.2),
    ("free_hub_momentum", 0.2),
    ("free_hub_flexible_beam/", 0.5),
    ("pendulum_", 0.1),
    ("contact_friction/sticks", 2.0),
];

const BASIS: &str = "is a basis of the planar models";
const OFFSET: &str = "off the axis, and in space the axis goes through the centres of mass";
const STARTS: &str = "is of a beam on a hub in the plane: a system in space begins";

/// A case and what it is run with. Its friction is regularised over 1e-7 m/s, and rounding leaves 3e-9 m/s of velocities along a beam in space:
/// the steps follow friction that rounding shakes, and become so small that a second takes minutes.
const WIDER: (&str, &str) = ("contact_friction/regularised", "contact.law.slip-speed=1e-5");
/// A stiff pendulum with half the elements: the waves along it, which these tolerances follow, are half as fast.
const COARSER: (&str, &str) = ("pendulum_45", "basis.elements=8");

/// Why planar cases are refused in space, and which.
const REFUSED: &[(&str, &[&str])] = &[
    (
        BASIS,
        &[
            "falling_pendulum",
            "falling_pendulum/massless",
            "falling_pendulum/baumgarte",
            "falling_pendulum/baumgarte-runge-kutta",
            "force_on_one_mode",
            "force_on_one_mode/table",
            "force_on_one_mode/formula",
            "force_on_one_mode/damped",
            "initial_modes",
            "motion_constant",
            "p1_spin_up_4/b_spline",
            "p1_spin_up_4/bezier",
            "p1_spin_up_4/modes",
            "p1_spin_up_4/polynomial",
            "p1_spin_up_4/radial",
            "p1_spin_up_4/mixed_b_spline",
            "p1_spin_up_4/mixed_modes",
            "p1_spin_up_4/mixed_polynomial",
            "p1_spin_up_4/mixed_radial",
            "p1_spin_up_4/runge_kutta",
            "p1_spin_up_4/adams",
            "varying_section",
            "varying_section/tapered_rectangle",
        ],
    ),
    (
        OFFSET,
        &[
            "p3_spin_up",
            "p3_spin_up/n05",
            "p3_spin_up/n1",
            "p3_spin_up/n5",
            "p3_spin_up/zeroth",
            "p3_spin_up/high",
            "p3_spin_up/at_10_rad_s",
            "p3_spin_up/at_20_rad_s",
            "steady_rotation_graded",
        ],
    ),
    ("beams in space and blades do without", &["p3_spin_up/n0", "p3_spin_up/soft_ceramic"]),
    (STARTS, &["drag/vibration"]),
    ("the state is one of another model", &["steady_rotation/restart"]),
    ("which the equilibrium of a system in space leaves out", &["initial_static"]),
];

/// What differs: cases, column, and why.
const OTHERWISE: &[(&str, &str, &str)] = &[
    ("beam_on_stop", "hub.torque", "the ground, and not the hub, carries the obstacle"),
    ("contact_friction", "hub.torque", "the ground, and not the hub, carries the obstacle"),
    ("free_hub_stiff_beam/controlled", "tip.axial_velocity", ROUNDING),
];

/// The beam stretches by 1e-12 of its length, and neither finer steps nor a finer mesh change the difference.
const ROUNDING: &str = "positions in space of a metre, of which the displacement is a difference";

/// Cases with columns that the steps of their own tolerance do not resolve in space: jumps of an acceleration excite all frequencies. Between
/// the tolerances 1e-8 and 1e-12 of both models the differences fall with those of the run in space from itself, of the velocity along
/// the pendulum from 0.7 of it to 1e-3; on four times as fine a mesh they are the same. They are compared at this tolerance.
const FINER: ([&str; 4], f64) =
    (["contact_friction/regularised", "free_hub_flexible_beam", "motion_ramp", "pendulum_"], 1e-12);

/// Fixed steps that resolve how the tip sticks and slips along the stop: in space steps of their own follow it.
const SHORT_STEPS: ([&str; 2], [&str; 2]) = (
    ["contact_friction", "contact_friction/sticks"],
    ["integrator.step=2e-4", "integrator.contact-step=2e-4"],
);

/// What differs where nonsmooth steps follow the closed contact in space, and events in the plane: the force at a record is the mean of a step there, which in the first step
/// also stops the tip, and the tip creeps along the stop with 1e-4 m/s.
const FOLLOWED: [(&str, &str); 5] = [
    ("contact_friction", "stop.force"),
    ("contact_friction/sticks", "stop.force"),
    ("contact_friction/radau", "stop.force"),
    ("contact_friction/radau", "tip.axial_velocity"),
    ("contact_friction/radau", "energy.contact_loss"),
];

fn differs(name: &str, column: &str) -> bool {
    FOLLOWED.contains(&(name, column))
        || OTHERWISE.iter().any(|(cases, of, _)| name.starts_with(cases) && *of == column)
}

/// What came of a case: nothing, if it is none of its own.
enum Outcome {
    Refused(String),
    Differs(Vec<String>),
}

fn outcome(name: &str, seen: &Mutex<Vec<String>>) -> Option<Outcome> {
    let planar = case(name, &[]).unwrap();
    planar.case.hub_beam()?;
    let refused = |problems: &Problems| {
        let keys: Vec<String> = problems.list.iter().map(|p| format!("{}: {}", p.key, p.message)).collect();
        Some(Outcome::Refused(keys.join("; ")))
    };
    let shorter =
        SHORTER.iter().find(|(cases, _)| name.starts_with(cases)).map_or(LONGEST, |(_, duration)| *duration);
    let mut set = vec![format!("run.duration={}", planar.case.duration.min(shorter))];
    for (_, change) in [WIDER, COARSER].iter().filter(|(case, _)| name == *case) {
        set.push((*change).to_owned());
    }
    if SHORT_STEPS.0.contains(&name) {
        set.extend(SHORT_STEPS.1.map(str::to_owned));
    }
    let controlled = matches!(planar.case.steps, Steps::Controlled { .. });
    if controlled && FINER.0.iter().any(|cases| name.starts_with(cases)) {
        set.push(format!("integrator.tolerance={}", FINER.1));
        set.push(format!("integrator.absolute-tolerance={}", 1e-2 * FINER.1));
    }
    let with = |coupling: &'static str| {
        let set: Vec<&str> = [coupling].into_iter().chain(set.iter().map(String::as_str)).collect();
        case(name, &set)
    };
    let space = match with("model.coupling=space") {
        Ok(space) => space,
        Err(problems) => return refused(&problems),
    };
    // Variants that differ by their planar coupling are one case in space.
    let resolved = space.resolved();
    let known = {
        let mut seen = seen.lock().unwrap();
        let title = |line: &&str| !line.starts_with("title");
        let resolved: String = resolved.lines().filter(title).collect();
        let known = seen.contains(&resolved);
        seen.push(resolved);
        known
    };
    if known {
        return None;
    }
    let plane = with("model.coupling=exact").unwrap_or(planar);
    match differences(name, &space, &plane) {
        Ok(found) => Some(Outcome::Differs(found)),
        Err(problems) => refused(&problems),
    }
}

#[test]
fn planar_cases_in_space_are_those_of_the_exact_coupling() {
    let names: Vec<String> = all().into_iter().map(|variant| variant.name).collect();
    let (next, found, seen) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()), Mutex::new(Vec::new()));
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some(name) = names.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let start = std::time::Instant::now();
                    if let Some(outcome) = outcome(name, &seen) {
                        let time = start.elapsed().as_secs_f64();
                        match &outcome {
                            Outcome::Refused(why) => eprintln!("{name} {time:.2} s: refused: {why}"),
                            Outcome::Differs(list) => {
                                eprintln!("{name} {time:.2} s: ran {}", list.join("\n     "))
                            }
                        }
                        found.lock().unwrap().insert(name.clone(), outcome);
                    }
                }
            });
        }
    });
    let found = found.into_inner().unwrap();
    let (mut wrong, mut ran) = (String::new(), 0);
    for (name, outcome) in &found {
        let expected = REFUSED.iter().find(|(_, names)| names.contains(&name.as_str()));
        match (outcome, expected) {
            (Outcome::Refused(why), Some((words, _))) if why.contains(words) => {}
            (Outcome::Refused(why), _) => writeln!(wrong, "{name} is refused: {why}").unwrap(),
            (Outcome::Differs(_), Some((words, _))) => {
                writeln!(wrong, "{name} runs, though {words}").unwrap()
            }
            (Outcome::Differs(list), None) => {
                ran += 1;
                list.iter().for_each(|what| writeln!(wrong, "{name}: {what}").unwrap());
            }
        }
    }
    let of_list = REFUSED.iter().flat_map(|(_, names)| names.iter());
    let gone: Vec<_> = of_list.filter(|name| !found.contains_key(**name)).collect();
    assert!(gone.is_empty(), "there are no such cases, or they are as another: {gone:?}");
    assert!(wrong.is_empty() && ran >= 55, "{ran} ran\n{wrong}");
}

/// What is wrong with a case is said at its place in the spelling in which it is written.
#[test]
fn hostile_cases_are_refused_at_their_place() {
    for (text, set, words) in [
        (SHORT, &["load=[{on='beam@2', force=[0, 1]}]"][..], &["load[1].on", "has no unit"][..]),
        (SHORT, &["load=[{on='beam@2 m', force=[0, 1]}]"], &["load[1].on", "ends at 1 m"]),
        (SHORT, &["load=[{on='tip', force=[0, 0, 1]}]"], &["load[1].force", "out of the plane"]),
        (SHORT, &["gravity=[0, 0, -9.81]"], &["gravity", "out of the plane"]),
        (
            SHORT,
            &["joint=[{name='hub', kind='fixed', between=['ground', 'beam.tip']}]"],
            &["joint[1].name", "`hub-1`"],
        ),
        (
            SHORT,
            &["body=[{name='ball', mass=1, inertia={kind='sphere', radius=1}}]", "model.coupling=first"],
            &["body", "space"],
        ),
        (
            SHORT,
            &["body=[{name='hub-body', mass=1, inertia={kind='sphere', radius=1}}]"],
            &["body[1].name", "[hub]"],
        ),
        (SHORT, &["model.coupling=exact", "model.refine=2"], &["model.refine", "space"]),
        (SHORT, &["damping.mass=1"], &["damping.mass", "relative to the hub", "exact"]),
        (SHORT, &["load=[{on='tip', force=[0, 1], axes='hub'}]"], &["load[1].axes", "turns with the hub"]),
        (
            SHORT,
            &["contact=[{obstacle={kind='stop', offset='-1 cm'}}]"],
            &["contact[1].obstacle", "turns with the hub"],
        ),
        (SHORT, &["contact=[{obstacle={kind='plane', point=[0, -3]}}]"], &["contact[1].law", "without mass"]),
        (SHORT, &["basis={kind='modes'}"], &["basis", "`modes`"]),
        (SHORT, &["model.coupling=exact", "beam.pitch='2 deg'"], &["beam.pitch", "space"]),
        (
            SHORT,
            &["initial={kind='modes', amplitudes=['1 mm']}"],
            &["initial.kind", "`model.coupling = \"exact\"`"],
        ),
        (SHORT, &["output.section-forces=true"], &["output.section-forces"]),
        (SHORT, &["section.bending-stiffness='20 kg'"], &["section.bending-stiffness"]),
        (SHORT, &["integrator={kind='runge-kutta-4', step='1 us'}"], &["integrator.kind", "explicit"]),
        (LONG, &["model.coupling=exact"], &["model.coupling", "[beam]"]),
        (LONG, &["beam.planar=false"], &["beam[1].section", "torsion", "planar = true"]),
        (LONG, &["beam.direction=[0, 0, 1]"], &["beam[1].planar", "does not lie in the plane"]),
        (LONG, &["beam.name=hub"], &["beam[1].name", "meaning of its own"]),
        (LONG, &["beam.name=ground"], &["beam[1].name", "meaning of its own"]),
        (LONG, &["beam.name=a.b"], &["beam[1].name", "cannot begin"]),
        (LONG, &["hub.radius=1"], &["hub", "unknown key"]),
        (
            LONG,
            &["contact=[{on='tip', obstacle={kind='plane'}, law={kind='hertz', stiffness=1e4}}]"],
            &["contact[1].obstacle.normal", "left out", "[0, 0, 1]"],
        ),
        (
            LONG,
            &[
                "contact=[{on='tip', obstacle={kind='cylinder', radius=1}, law={kind='hertz', stiffness=1e4}}]",
            ],
            &["contact[1].obstacle.axis", "left out"],
        ),
        (
            LONG,
            &[
                "beam.section={kind='rectangle', modulus=1e9, density=1e3, width=0.01, height=0.02}",
                "beam.up=[]",
            ],
            &["beam[1].up", "left out", "stiffer"],
        ),
        (
            SHORT,
            &["load=[{on='tip', law={kind='linear-drag', coefficient=1}}]"],
            &["load[1].law", "is a point"],
        ),
        (
            SHORT,
            &["load=[{on='beam', law={kind='linear-drag', coefficient=1}, axes='follower'}]"],
            &["load[1].axes", "the motion alone"],
        ),
        (
            SHORT,
            &["load=[{on='beam', force-per-length=[0, 1], law={kind='linear-drag', coefficient=1}}]"],
            &["load[1].force-per-length", "leave it out"],
        ),
    ] {
        let message = refused(text, set);
        for word in words {
            assert!(message.contains(word), "`{word}` is not in the message of {set:?}: {message}");
        }
    }
    let twice = refused(&format!("{SHORT}\n[[beam]]\nlength = 1\n"), &[]);
    assert!(twice.contains("TOML") && twice.contains("`[beam]` is one table"), "{twice}");
}

/// A deck says the length of its line, and the short spelling leaves it out as the long one does; in the plane too.
#[test]
fn a_deck_says_the_length_of_a_beam_on_a_hub() {
    let of = |beam: &str, section: &str, coupling: &str| {
        let text = format!(
            "run.duration = 0\nbeam = {{ {beam} }}\nsection = {section}\nmodel.coupling = \"{coupling}\"\n"
        );
        parse(text, &root().join("blades/case.toml"), &[])
    };
    let deck = "{ kind = \"deck\", file = \"IEA-15-240-RWT_BeamDyn.dat\", format = \"beamdyn\" }";
    let read = of("shear = true", deck, "space-shear").unwrap();
    let beam = &read.case.space().unwrap().beams[0].0;
    assert!((beam.length - 117.149).abs() < 1e-3, "{}", beam.length);
    let planar = of("", deck, "first").unwrap();
    assert_eq!(planar.case.hub_beam().unwrap().length, beam.length);
    for (beam, section, coupling, says) in [
        (
            "",
            "{ kind = \"circle\", modulus = 7e10, density = 2700, radius = 0.1 }",
            "space",
            "beam.length: this key is missing",
        ),
        (
            "",
            "{ kind = \"circle\", modulus = 7e10, density = 2700, radius = 0.1 }",
            "first",
            "beam.length: this key is missing",
        ),
        ("", "{ kind = \"deck\", file = \"none.dat\", format = \"beamdyn\" }", "space", "cannot read"),
        ("length = 117", deck, "space-shear", "leave the length out"),
    ] {
        let message = of(beam, section, coupling).unwrap_err().to_string();
        assert!(
            message.contains(says) && !(says == "cannot read" && message.contains("missing")),
            "{message}"
        );
    }
}

/// A deck's height points to its trailing edge: seen from the hub its deflection has the sign of the plane, and what follows that height is refused.
#[test]
fn a_deck_deflects_to_the_same_side_in_the_plane_and_in_space() {
    let of = |coupling: &str, more: &str| {
        let text = format!(
            "run.duration = 0.5\nbeam = {{}}\nsection = {{ kind = \"deck\", file = \"IEA-15-240-RWT_BeamDyn.dat\", format = \"beamdyn\" }}\nmodel.coupling = \"{coupling}\"\n\
             hub = {{ radius = 4, motion = {{ kind = \"spin-up\", speed = 0.1, time = 1 }} }}\nbasis.elements = 10\n{more}\n"
        );
        parse(text, &root().join("blades/case.toml"), &[])
    };
    let last = |coupling: &str| {
        let run = of(coupling, "").unwrap().prepare().unwrap().run(&mut |_| ControlFlow::Continue(()));
        *run.trajectory.column("tip.deflection").unwrap().last().unwrap()
    };
    let (plane, space) = (last("exact"), last("space"));
    assert!(plane < 0.0 && (space / plane - 1.0).abs() < 0.5, "{plane} and {space}");
    for more in
        ["load = [{ on = \"tip\", force = [0, 1], axes = \"follower\" }]", "output.strain-heights = [0.1]"]
    {
        let message = of("space", more).unwrap_err().to_string();
        assert!(message.contains("to the trailing edge in space"), "{message}");
    }
}
