//! The balance of energy of a run closes to the order of its method.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{self, SQUARE_BAR};
use flexion_case::{Effort, Reading, Run};
use std::ops::ControlFlow;

const REST: &str = r#"
[hub]
radius = 0.1
motion = { kind = "expression", of = "speed", formula = "5*sin(3*t)^2" }
[basis]
kind = "modes"
axial = 1
transverse = 1
[initial]
kind = "steady-rotation"
[run]
duration = "1 s"
[output]
step = "0.05 s"
"#;

fn run(set: &[&str]) -> Run {
    written::finished(&reading(set))
}

fn reading(set: &[&str]) -> Reading {
    written::reading(&[SQUARE_BAR, REST].concat(), set)
}

fn largest(run: &Run, column: &str) -> f64 {
    run.trajectory.column(column).unwrap().iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

/// A free hub with motor, damper, spring and controller: every kind of power there is.
const FREE: &str = "hub={radius=0.1,inertia=2,motion={kind='free',damping=1.5,stiffness=4,torque={kind='expression',formula='9*sin(5*t)'},controller={kind='pd',proportional=20,derivative=2,target='1 rad',rate='2 rad/s'}}}";

#[test]
fn the_balance_of_energy_closes_to_the_order_of_the_method() {
    // Soft along its axis, so that stable steps are long enough for errors to stand out of rounding.
    let soft = "section={kind='resultants',mass-per-length=1.08,axial-stiffness=2e3,bending-stiffness=93}";
    let cases: &[(&str, f64, f64)] = &[
        ("newmark", 4e-3, 2.0),
        ("generalized-alpha", 4e-3, 2.0),
        ("runge-kutta-4", 4e-3, 4.0),
        ("adams-4", 2e-3, 4.0),
    ];
    for drive in ["hub.radius=0.1", FREE] {
        for &(method, step, order) in cases {
            // Before 0.5 s, when the reference of the controller stops and the torque jumps.
            let imbalance = |step: f64| {
                let integrator = format!("integrator={{kind='{method}',step={step}}}");
                largest(&run(&[drive, soft, &integrator, "run.duration=0.4"]), "energy.balance")
            };
            let (coarse, fine) = (imbalance(step), imbalance(0.5 * step));
            let measured = (coarse / fine).log2();
            eprintln!("{method}: {coarse:.3e} {fine:.3e} order {measured:.2}");
            // Energy may close faster than the motion converges.
            assert!(measured > order - 0.35, "{method}: {coarse:.3e} {fine:.3e}: {measured}");
        }
        let imbalance = |tolerance: &str| {
            let set =
                format!("integrator={{kind='radau',tolerance={tolerance},absolute-tolerance={tolerance}}}");
            largest(&run(&[drive, &set]), "energy.balance")
        };
        let (coarse, fine) = (imbalance("1e-6"), imbalance("1e-9"));
        eprintln!("radau: {coarse:.3e} {fine:.3e}");
        assert!(fine < 1e-2 * coarse && fine < 1e-5, "{coarse:.3e} {fine:.3e}");
    }
}

/// Loads of every frame, a lumped mass, gravity and damping of the beam: their work is in the energy balance.
const LOADED: &[&str] = &[
    "gravity=[0, '-9.81 m/s^2']",
    "mass=[{on='2 m',mass='300 g',inertia=2e-3},{on='1 m',mass=0.2}]",
    "load=[{on='2 m',force=[2,30],axes='follower',amplitude={kind='expression',formula='sin(7*t)^2'}},{on='1 m',force=[0,-9],axes='dead',amplitude={kind='expression',formula='sin(5*t)^2'}},\
     {on='1.5 m',couple='3 N*m',amplitude={kind='expression',formula='sin(6*t)'}},\
     {on='beam',force-per-length=[0,4],axes='hub',amplitude={kind='expression',formula='sin(4*t)'}}]",
    "damping={mass='0.5 1/s',stiffness='0.1 ms'}",
];

#[test]
fn the_balance_closes_with_loads_masses_gravity_and_damping() {
    for drive in ["hub.radius=0.1", FREE] {
        for coupling in ["model.coupling=first", "model.coupling=exact"] {
            let with = |more: &[&str]| {
                let mut set = vec![drive, coupling, "run.duration=0.4", "initial.kind=undeformed"];
                set.extend(["basis={kind='finite-elements',elements=2}"]);
                set.extend(LOADED);
                set.extend(more);
                run(&set)
            };
            let fine = with(&["integrator={kind='radau',tolerance=1e-9,absolute-tolerance=1e-10}"]);
            let done =
                ["energy.loads", "energy.dissipated", "energy.drive"].map(|column| largest(&fine, column));
            let off = largest(&fine, "energy.balance");
            eprintln!("{drive} {coupling}: {done:?}, off by {off:.2e}");
            assert!(done.iter().all(|work| *work > 0.05), "{done:?}");
            assert!(off < 1e-8, "{drive} {coupling}: {off:.2e} of {done:?}");
            let off = |step: &str| {
                largest(
                    &with(&[&format!("integrator={{kind='generalized-alpha',step='{step}'}}")]),
                    "energy.balance",
                )
            };
            let order = (off("2 ms") / off("1 ms")).log2();
            eprintln!("order {order:.2}");
            assert!((order - 2.0).abs() < 0.35, "{drive} {coupling}: order {order}");
        }
    }
}

/// A free hub slowed by its damper alone: what it loses is what the damper takes.
#[test]
fn a_damper_takes_the_energy_of_a_free_hub() {
    let hub = "hub={inertia=50,motion={kind='free',speed=2,damping=30}}";
    let run =
        run(&[hub, "initial.kind=undeformed", "integrator={kind='radau',tolerance=1e-9}", "run.duration=5"]);
    let (lost, total) =
        (run.trajectory.column("energy.dissipated").unwrap(), run.trajectory.column("energy.total").unwrap());
    let (first, last) = (total[0], total[total.len() - 1]);
    assert!(last < 0.1 * first);
    assert!((lost[lost.len() - 1] - (first - last)).abs() < 1e-6 * first);
    assert_eq!(largest(&run, "energy.drive"), 0.0);
}

#[test]
fn the_energy_balance_may_be_left_out() {
    let without = run(&["output.energy-balance=false"]);
    let with = run(&[]);
    assert!(without.trajectory.index("energy.balance").is_none());
    assert_eq!(without.trajectory.column("tip.deflection"), with.trajectory.column("tip.deflection"));
    assert_eq!(without.counters, with.counters);
}

/// The estimate covers the difference to a run with eight times the elements and a far tighter tolerance.
#[test]
fn the_true_error_lies_within_the_reported_one() {
    let elements = |n: usize| format!("basis={{kind='finite-elements',elements={n}}}");
    let sets: &[&[&str]] = &[
        &["integrator={kind='radau',tolerance=1e-4,absolute-tolerance=1e-6}"],
        &["integrator={kind='newmark',step='5 ms'}"],
        &["integrator={kind='hht',step='2 ms',alpha=0.1}", "model.coupling=exact"],
        &["integrator={kind='generalized-alpha',step='5 ms'}", FREE, "initial.kind=undeformed"],
        &["integrator={kind='runge-kutta-4',step='10 us'}", "run.duration=0.1", "output.step=0.01"],
    ];
    for set in sets {
        let coarse = elements(3);
        let mut coarse_set = set.to_vec();
        coarse_set.insert(0, &coarse);
        let reading = reading(&coarse_set);
        let run_here = run(&coarse_set);
        let errors = reading.estimate_errors(&run_here, Effort::Full, &mut |_| ControlFlow::Continue(()));
        let fine = elements(24);
        let mut fine_set = set.to_vec();
        fine_set
            .extend([fine.as_str(), "integrator={kind='radau',tolerance=1e-10,absolute-tolerance=1e-11}"]);
        let truth = run(&fine_set);
        assert_eq!(errors.columns.len() + 2, run_here.trajectory.channels().len());
        for error in &errors.columns {
            let pairs = run_here.trajectory.column(&error.column).unwrap();
            let exact = truth.trajectory.column(&error.column).unwrap();
            let off = pairs.iter().zip(&exact).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()));
            assert!(
                off <= error.discretization,
                "{set:?} {}: {off:.3e} of {:.3e}",
                error.column,
                error.discretization
            );
        }
        let model = errors.columns.iter().find(|e| e.column == "tip.deflection").unwrap().model;
        assert_eq!(model.is_some(), !set.contains(&"model.coupling=exact"));
    }
}

/// P4's pendulum onto the ground. With a massless contact and steps that do not follow what the impact excites `hht` without dissipation gains
/// 1.1 J of 3 J in 50 ms behind the first touch; `radau` with a loose tolerance gains in some runs in the second burst of impacts,
/// on elements whose axial displacements are no larger than the tolerance. A run says what it has gained, and only that.
#[test]
fn impacts_that_gain_energy_are_warned_of() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/falling_pendulum");
    let gain = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
        let run = written::outcome(&flexion_case::read(&folder, &set).unwrap());
        let (mut low, mut rise) = (0.0_f64, 0.0_f64);
        for imbalance in run.trajectory.column("energy.balance").unwrap() {
            low = low.min(imbalance);
            rise = rise.max(imbalance - low);
        }
        let of_energy = ["energy has grown", "energy balance is off", "of energy have come since"];
        let warned =
            run.warnings.iter().find(|warning| of_energy.iter().any(|words| warning.contains(words)));
        let warned = warned.cloned();
        (rise / largest(&run, "energy.strain"), warned)
    };
    let massless = "contact=[{name='ground',obstacle={kind='plane',point=[0,0]}}]";
    let modes = ["basis.axial=7", "basis.transverse=7", "run.duration=0.42", massless];
    let many = ["basis.axial=9", "basis.transverse=9", "run.duration=0.42", massless];
    let (rise, warned) =
        gain(&[&many[..], &["integrator={kind='hht',step=4e-4,alpha=0,stabilized=true}"]].concat());
    assert!(rise > 0.3 && warned.as_ref().unwrap().contains("use smaller steps"), "{rise}");
    let (rise, warned) =
        gain(&[&modes[..], &["integrator={kind='radau',tolerance=1e-5,absolute-tolerance=1e-5}"]].concat());
    assert!(rise < 0.05 && warned.is_none(), "{rise} {warned:?}");
    for duration in ["0.88", "0.89", "0.9", "0.91", "0.92"] {
        let (rise, warned) = gain(&[
            "model.coupling=exact",
            "basis={kind='finite-elements',elements=4}",
            "integrator={kind='radau',tolerance=1e-4,absolute-tolerance=1e-4}",
            &format!("run.duration={duration}"),
            "output.step=5e-3",
        ]);
        let said = warned.as_ref().is_some_and(|warning| warning.ends_with("use a tighter tolerance"));
        assert!(
            if rise > 0.3 { said } else { rise > 0.15 || warned.is_none() },
            "{duration}: {rise} {warned:?}"
        );
    }
}

/// A beam that hangs on a joint without gravity stays where it is; what rounding moves it by, 10⁻¹⁵ of its length, is no gain of energy.
#[test]
fn a_beam_at_rest_gains_no_energy_by_rounding() {
    let case = "
run = { duration = 0.4 }
[[beam]]
length = 1
start = [0.3, 0.1, 0.2]
direction = [0.3, 0.5, 0.8]
elements = 3
section = { kind = 'circle', modulus = 1e9, density = 2000, radius = 0.01 }
[[joint]]
kind = 'universal'
between = ['ground', 'beam.root']
axis = [0.2, 0.9, -0.4]
across = [0.9, -0.2, 0]
";
    let run = written::finished(&written::reading(case, &[]));
    assert!(run.warnings.is_empty(), "{:?}", run.warnings);
    assert!(largest(&run, "beam.tip.displacement.x") < 1e-13);
}

/// A ball of 2 kg falls from 0.45 m on a plane, by a method that finds no time of an impact within its step: of the energy m g h the
/// part e² is left, in every record, also in the one inside the step of the impact.
#[test]
fn a_record_inside_the_step_of_an_impact_keeps_the_energy() {
    let case = "
gravity = [0, 0, -9.81]
run = { duration = 0.45 }
[[body]]
name = 'b'
mass = 2
inertia = { kind = 'sphere', radius = 0.1 }
position = [0, 0, 0.45]
[[contact]]
name = 'k'
on = 'b'
obstacle = { kind = 'plane', normal = [0, 0, 1] }
";
    let energy = 2.0 * 9.81 * 0.45;
    for restitution in [1.0, 0.5] {
        for method in ["nonsmooth-generalized-alpha", "moreau-jean"] {
            let law = format!("law = {{ kind = 'constraint', restitution = {restitution} }}\n");
            let integrator = format!("integrator={{kind='{method}',step=1e-4}}");
            // Three records a step: some are inside the step of the impact.
            let set = [integrator.as_str(), "output.step=3e-5"];
            let run = written::finished(&written::reading(&format!("{case}{law}"), &set));
            assert!(run.warnings.is_empty(), "{method} {restitution}: {:?}", run.warnings);
            let impact = run.events.list[0].time;
            let times = run.trajectory.times();
            assert!(times.iter().any(|t| (impact - 1e-4..impact).contains(t)), "{impact}");
            let total = run.trajectory.column("energy.total").unwrap();
            for (t, total) in times.iter().zip(&total) {
                let exact =
                    if *t < impact * (1.0 - 1e-12) { 1.0 } else { restitution * restitution } * energy;
                assert!((total - exact).abs() < 2e-3 * energy, "{method} {restitution} {t}: {total} {exact}");
            }
            assert!(largest(&run, "energy.balance") < 2e-3 * energy, "{method} {restitution}");
        }
    }
}

/// A damped arm that falls on a floor, in steps too long for what the impact excites and dampers take at once: what they take is what the method
/// lets them, and radau finds 0.106 J.
#[test]
fn dampers_take_no_more_behind_an_impact_than_there_is() {
    let case = "
gravity = [0, -9.81]
run = { duration = 0.4 }
output = { step = '1 ms' }
beam = { length = 1 }
damping = { stiffness = '5 ms' }
section = { kind = 'circle', modulus = '2 GPa', density = 1200, radius = '5 mm' }
hub = { motion = { kind = 'free', angle = '20 deg' } }
model = { coupling = 'exact' }
basis = { kind = 'finite-elements', elements = 2 }
[[contact]]
name = 'floor'
on = 'tip'
obstacle = { kind = 'plane', point = [0, 0] }
law = { kind = 'constraint', restitution = 0.5 }
";
    let methods = [
        "kind='moreau-jean',step='1 ms'",
        "kind='nonsmooth-generalized-alpha',step='0.1 ms'",
        "kind='hht',alpha=0,step='1 ms'",
        "kind='hht',alpha=0.1,step='1 ms'",
        "kind='generalized-alpha',step='1 ms'",
    ];
    for method in methods {
        let run = written::finished(&written::reading(case, &[&format!("integrator={{{method}}}")]));
        // What steps damp that resolve no vibration is said.
        assert!(!run.warnings.iter().any(|w| w.contains("energy has grown")), "{method}: {:?}", run.warnings);
        let column = |name: &str| run.trajectory.column(name).unwrap();
        let (dissipated, balance) = (column("energy.dissipated"), column("energy.balance"));
        let taken = dissipated.last().unwrap();
        assert!((taken - 0.105).abs() < 0.005, "{method}: {taken}");
        // What the method loses by itself is missing; nothing is gained.
        let gained = balance.iter().fold(0.0_f64, |most, x| most.max(*x));
        assert!(gained < 1e-4, "{method}: {gained:e}");
    }
}

/// A ball of 2 kg on a floor that is lifted with 1 m/s², and on a belt that begins to go with 3 m/s: drives put in what energy and losses need, with no lag of
/// F V h/2.
#[test]
fn the_work_of_a_moving_obstacle_counts_with_the_impulse_of_the_step() {
    let lifted = "
gravity = [0, 0, -9.81]
run = { duration = 0.4 }
output = { step = '10 ms' }
[[body]]
name = 'b'
mass = 2
inertia = { kind = 'sphere', radius = 0.1 }
position = [0, 0, 0.1]
[[contact]]
name = 'k'
on = 'b'
radius = 0.1
obstacle = { kind = 'plane', normal = [0, 0, 1], DIRECTION }
law = { kind = 'constraint', restitution = 0, friction = 0.2 }
";
    let up =
        "motion = { displacement = [0, 0, 1], amplitude = { kind = 'expression', formula = '0.5*t^2' } }";
    let along = "motion = { displacement = [1, 0, 0], amplitude = { kind = 'expression', formula = '3*t' } }";
    for (motion, step) in [(up, 0.01), (along, 0.01)] {
        for method in ["moreau-jean", "nonsmooth-generalized-alpha"] {
            let set = format!("integrator={{kind='{method}',step={step}}}");
            let run = written::finished(&written::reading(&lifted.replace("DIRECTION", motion), &[&set]));
            let (driven, off) = (largest(&run, "energy.drive"), largest(&run, "energy.balance"));
            eprintln!("{motion} {method}: {driven} {off:e}");
            assert!(driven > 0.5 && off < 1e-3 * driven, "{motion} {method}: {off:e} of {driven}");
        }
    }
}
