//! The error that a run reports of itself, against the error it has.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written::{self, finished, reading};
use flexion_case::{Effort, Reading, Run, Target};
use flexion_results::{Directory, Errors, Status};
use std::f64::consts::PI;
use std::ops::ControlFlow;

const LENGTH: f64 = 2.0;
const MASS: f64 = 1.5;
const BENDING: f64 = 40.0;
const FORCE: f64 = 0.4;

/// A cantilever whose hub stands still, with a force at its tip that sets in at once.
const CASE: &str = "
[beam]
length = 2
[section]
kind = 'resultants'
mass-per-length = 1.5
axial-stiffness = 1e5
bending-stiffness = 40
[hub]
motion = { kind = 'constant', speed = 0 }
[[load]]
on = '2 m'
force = [0, 0.4]
[run]
duration = 0.8
[output]
step = 0.01
";

/// Its deflection at the tip: Σ 4F/(ρA L ωₙ²) (1 − cos ωₙt) with ωₙ = λₙ² √(EI/(ρA L⁴)) and cos λₙ cosh λₙ = −1, for a
/// mode of norm ∫φ² dx = L has φ(L)² = 4.
fn deflection(t: f64) -> f64 {
    (1..400)
        .map(|n| {
            let mut root = (f64::from(n) - 0.5) * PI;
            for _ in 0..20 {
                // cos λ + 1/cosh λ = 0
                let inverse = 1.0 / root.cosh();
                root += (root.cos() + inverse) / (root.sin() + inverse * root.tanh());
            }
            let frequency = root * root * (BENDING / (MASS * LENGTH.powi(4))).sqrt();
            4.0 * FORCE / (MASS * LENGTH * frequency * frequency) * (1.0 - (frequency * t).cos())
        })
        .sum()
}

fn read(overrides: &[&str]) -> Reading {
    written::reading(CASE, overrides)
}

/// The run, its errors, and the steps of the companions.
fn run(reading: &Reading) -> (Run, Errors, u64) {
    let run = written::outcome(reading);
    let mut steps = 0;
    let errors = reading.estimate_errors(&run, Effort::Full, &mut |_| {
        steps += 1;
        ControlFlow::Continue(())
    });
    (run, errors, steps)
}

#[test]
fn the_reported_error_of_a_loaded_beam_covers_its_error_and_is_of_its_size() {
    let settled = 4.0 * FORCE * LENGTH.powi(3) / BENDING / 12.0;
    assert!((deflection(0.0)).abs() < 1e-15 && deflection(1.0) < 2.0 * settled);
    let bases = [
        "{kind='finite-elements',elements=2}",
        "{kind='finite-elements',elements=8}",
        "{kind='b-spline',elements=5,degree=4}",
        "{kind='polynomial',nodes=7}",
        "{kind='bezier',degree=6}",
        "{kind='modes',axial=1,transverse=2}",
    ];
    let integrators = [
        "{kind='radau',tolerance=1e-3}",
        "{kind='radau'}",
        "{kind='newmark',step=0.02}",
        "{kind='newmark',step=0.001}",
        "{kind='hht',alpha=0.2,step=0.005}",
        "{kind='generalized-alpha',spectral-radius=0.3,step=0.01}",
        "{kind='runge-kutta-4',step=1e-4}",
    ];
    for (i, basis) in bases.into_iter().enumerate() {
        // Every integrator with half of the bases.
        for integrator in integrators.into_iter().skip(i % 2).step_by(2) {
            let (basis, integrator) = (format!("basis={basis}"), format!("integrator={integrator}"));
            let (run, errors, _) = run(&read(&[&basis, &integrator]));
            let reported = errors.columns.iter().find(|e| e.column == "tip.deflection").unwrap();
            let computed = run.trajectory.column("tip.deflection").unwrap();
            let times = run.trajectory.times();
            let error =
                times.iter().zip(&computed).map(|(t, w)| (w - deflection(*t)).abs()).fold(0.0, f64::max);
            // The first coupling is exact here but for the deflection's being finite: the discretization alone.
            let reported = reported.discretization;
            assert!(error <= reported, "{basis} {integrator}: off by {error:e}, reported {reported:e}");
            // S = 2 or 4 times the difference to something better: of the size of the error.
            assert!(
                reported < 8.0 * error + 1e-9,
                "{basis} {integrator}: off by {error:e}, reported {reported:e}"
            );
        }
    }
}

#[test]
fn a_coarse_run_has_no_fine_companions() {
    // Six steps; 13 nodes carry waves a thousand times as fast.
    let basis = "basis={kind='polynomial',nodes=13}";
    let coarse = read(&["run.duration=0.3", basis, "integrator={kind='hht',step=0.05}"]);
    let (_, errors, steps) = run(&coarse);
    assert!(errors.warnings.iter().all(|text| text.contains("steps are coarse")), "{:?}", errors.warnings);
    let finest = "integrator={kind='radau',tolerance=1e-9,absolute-tolerance=1e-9}";
    let finer = "basis={kind='polynomial',nodes=25}";
    let fine = read(&["run.duration=0.3", finer, finest]);
    let fine = written::outcome(&fine).counters.steps;
    assert!(2 * steps < fine, "{steps} steps of companions, {fine} of one with the tightest tolerance");
}

/// A case that is sound has its results, also where twice its functions are more than a key allows.
#[test]
fn a_run_without_a_finer_one_says_so() {
    let short = ["run.duration=1e-3", "output.step=1e-4"];
    let reading = read(&[&["basis={kind='finite-elements',elements=1,refine=600}"], &short[..]].concat());
    let ours = written::outcome(&reading);
    let errors = reading.estimate_errors(&ours, Effort::Auto, &mut |_| ControlFlow::Continue(()));
    let why = errors.unknown.unwrap();
    assert!(why.contains("there is no finer run: must be from 1 to 1000, but is 1200"), "{why}");
    // Someone who asks for them is warned.
    assert!(errors.warnings.is_empty(), "{:?}", errors.warnings);
    let errors = reading.estimate_errors(&ours, Effort::Full, &mut |_| ControlFlow::Continue(()));
    let warned = errors
        .warnings
        .iter()
        .any(|warning| warning.contains("could not be estimated: there is no finer run"));
    assert!(warned && errors.columns.is_empty(), "{:?}", errors.warnings);
}

/// A mesh that is too coarse is told which would do, and that one does.
#[test]
fn a_coarse_mesh_is_told_the_mesh_that_would_do() {
    let case = |load: &str, rest: &str| {
        format!("{}{load}\non = '1 m'\namplitude = {{ kind = 'ramp', time = 1 }}\n{rest}", written::STRIP)
    };
    let rolled = case("[[load]]\ncouple = 183", "[damping]\nmass = 10\n[run]\nduration = 1.2\n");
    let bent = case("[[load]]\nforce = [0, -140]", "[run]\nduration = 1.5\n");
    // The default mesh rolled up to two circles, and a coarser one bent.
    for (case, set) in [(&rolled, &[][..]), (&bent, &["basis.elements=3"])] {
        let reading = written::reading(case, set);
        let (_, errors, _) = run(&reading);
        let said = errors.warnings.iter().find(|text| text.contains("coarse")).unwrap();
        let elements = said.split("basis.elements = ").nth(1).unwrap_or_else(|| panic!("{said}"));
        let elements: usize = elements.split('`').next().unwrap().parse().unwrap();
        let (finer, errors, _) = run(&reading.with(&[format!("basis.elements={elements}")]).unwrap());
        assert!(errors.warnings.is_empty(), "{elements}: {:?}", errors.warnings);
        for column in ["tip.deflection", "tip.axial", "hub.torque"] {
            let error = errors.columns.iter().find(|error| error.column == column).unwrap();
            let largest = finer.trajectory.extremes(finer.trajectory.index(column).unwrap()).largest();
            assert!(error.discretization <= 0.01 * largest, "{elements}: {column} {error:?} of {largest}");
        }
    }
}

/// Two clamped beams that cross in a joint, and a hub on its axis: displacements that rounding alone makes have no relative error.
#[test]
fn what_rounding_leaves_of_zero_is_neither_coarse_nor_distrusted() {
    let circle = "section = { kind = 'circle', modulus = 70e9, density = 2700, radius = 5e-3 }";
    let ends = "root = 'clamped'\ntip = 'clamped'";
    let crossed = format!(
        "run = {{ duration = 0 }}\ninitial = {{ kind = 'static' }}\n\
         [[beam]]\nname = 'a'\nlength = 2\nstart = [-1, 0, 0]\n{circle}\n{ends}\n\
         [[beam]]\nname = 'b'\nlength = 2\nstart = [0, -1, 0]\ndirection = [0, 1, 0]\n{circle}\n{ends}\n\
         [[joint]]\nkind = 'spherical'\nbetween = ['a@1 m', 'b@1 m']\n\
         [[load]]\non = 'a@1 m'\nforce = [0, 0, -1]\n"
    );
    let strip =
        "section = { kind = 'rectangle', modulus = 69e9, density = 2766, height = 2.5e-3, width = 0.1 }";
    let hub = format!(
        "gravity = [0, 0, -9.81]\nrun = {{ duration = 0.3 }}\n\
         [[body]]\nname = 'hub'\nmass = 10\ninertia = {{ kind = 'principal', moments = [5, 5, 9.557] }}\n\
         [[joint]]\nname = 'bearing'\nkind = 'revolute'\nbetween = ['ground', 'hub']\naxis = [0, 0, 1]\n\
         motion = {{ kind = 'free' }}\n\
         [[beam]]\nname = 'blade'\nstart = [0.35, 0, 0]\nlength = 1.45\nup = [0, 1, 1]\n{strip}\nelements = 8\n\
         [[joint]]\nkind = 'fixed'\nbetween = ['hub', 'blade.root']\n"
    );
    for (case, column) in [(&crossed, "b.tip.displacement.z"), (&hub, "hub.position.x")] {
        let reading = written::reading(case, &[]);
        let (ours, errors, _) = run(&reading);
        let largest = ours.trajectory.extremes(ours.trajectory.index(column).unwrap()).largest();
        assert!(largest > 0.0 && largest < 1e-20, "{column}: {largest:e} is no rounding");
        assert!(errors.warnings.is_empty(), "{column}: {:?}", errors.warnings);
        assert_eq!((errors.trusted, errors.distrusted), (ours.state.t, None));
        // Not asked to be accurate to a part of itself either.
        let target = Target::new("0.05".to_owned(), None);
        let refined = reading.refine(&target, &mut |_| ControlFlow::Continue(()), &mut |_| {}).unwrap();
        assert_eq!(refined.refused, None);
    }
}

/// A pendulum of three modes falls on a floor at 0.37001 s; the record at 0.37 s is the last before it. Its speed there differs from
/// that of six modes by 0.005 rad/s, and by 15 rad/s after the impact, which no error before it may show.
#[test]
fn errors_before_an_impact_do_not_show_what_comes_after_it() {
    let case = "
beam = { length = 1 }
hub = { motion = { kind = 'free', angle = '45 deg' } }
gravity = [0, -9.81]
model = { coupling = 'high' }
basis = { kind = 'modes', axial = 3, transverse = 3 }
section = { kind = 'uniform', modulus = '68.952 GPa', density = 2766.7, area = '3.14 cm^2', second-moment = 7.85e-9 }
run = { duration = 0.3702 }
output = { step = '20 us' }
[[contact]]
name = 'floor'
obstacle = { kind = 'plane', point = [0, 0] }
law = { kind = 'constraint', restitution = 0 }
";
    let reading = written::reading(case, &[]);
    let run = written::outcome(&reading);
    let errors = reading.estimate_errors(&run, Effort::Auto, &mut |_| ControlFlow::Continue(()));
    let speed = errors.columns.iter().find(|error| error.column == "hub.speed").unwrap();
    assert!((0.004..0.2).contains(&speed.discretization), "{speed:?}");
    let until: Vec<_> =
        errors.warnings.iter().filter(|text| text.contains("before the first impact")).collect();
    assert!(until.len() == 1 && until[0].contains("t = 0.370000 s"), "{:?}", errors.warnings);
}

/// A ball that falls from h = 0.45 m has v = √(2gh) at t₁ = √(2h/g), and with e = 1 is at v (t − t₁) − g (t − t₁)²/2 after that. It has
/// no mesh: its errors are known after the impact too.
#[test]
fn errors_of_bodies_without_a_mesh_are_known_after_impacts() {
    let case = "
gravity = [0, 0, -9.81]
run = { duration = 0.45 }
[[body]]
name = 'b'
mass = 2
inertia = { kind = 'sphere', radius = 0.1 }
position = [0, 0, 0.45]
[[contact]]
on = 'b'
obstacle = { kind = 'plane', normal = [0, 0, 1] }
law = { kind = 'constraint', restitution = 1 }
";
    let (run, errors, _) = run(&written::reading(case, &[]));
    assert!(errors.warnings.is_empty() && errors.unknown.is_none(), "{:?}", errors.warnings);
    assert_eq!(errors.trusted, 0.45);
    let first = (2.0 * 0.45 / 9.81_f64).sqrt();
    let since = 0.45 - first;
    let exact = 9.81 * first * since - 0.5 * 9.81 * since * since;
    let height = run.trajectory.extremes(run.trajectory.index("b.position.z").unwrap()).last;
    let stated = errors.columns.iter().find(|error| error.column == "b.position.z").unwrap().last;
    assert!((height - exact).abs() <= stated && stated < 1e-9, "{height} {exact} {stated}");
}

/// Work is counted in evaluations of the residual where impacts take more of them than steps do.
#[test]
fn a_run_that_took_long_at_its_contacts_is_not_repeated_unasked() {
    let reading = read(&["run.duration=0.01", "output.step=1e-3"]);
    let mut run = written::outcome(&reading);
    run.record.counters.residuals = (1.3e7 / run.size.unknowns as f64) as u64;
    let errors = reading.estimate_errors(&run, Effort::Auto, &mut |_| ControlFlow::Continue(()));
    assert!(errors.unknown.is_some_and(|why| why.contains("--error full")));
}

/// What an estimate warns of stands in `summary.json` too.
#[test]
fn warnings_of_the_estimate_are_in_the_summary() {
    let reading = read(&["basis={kind='finite-elements',elements=1}", "output.plots=false"]);
    let (mut run, errors, _) = run(&reading);
    let warning = errors.warnings.iter().find(|text| text.contains("coarse")).unwrap().clone();
    run.errors = Some(errors);
    let folder = tempfile::tempdir().unwrap();
    reading.write(&run, &Directory::create(folder.path(), true).unwrap()).unwrap();
    let summary = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let written = summary["warnings"].as_array().unwrap();
    assert!(written.iter().any(|text| *text == *warning), "{written:?}");
}

/// A refinement that is stopped keeps what is finished, says every run, and the best of them is the result.
#[test]
fn a_refinement_that_is_stopped_keeps_its_best_run() {
    let reading = read(&["basis={kind='finite-elements',elements=1}"]);
    let target = Target::new("1e-9".to_owned(), Some("tip.deflection".to_owned()));
    let (said, mut steps) = (std::cell::RefCell::new(Vec::new()), 0_u32);
    let mut watch = |_: &flexion::system::State| {
        // 200 steps into what follows the second refinement.
        steps += u32::from(said.borrow().len() == 2);
        if steps > 200 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let refined =
        reading.refine(&target, &mut watch, &mut |rung| said.borrow_mut().push(rung.clone())).unwrap();
    assert_eq!(refined.refused.as_deref(), Some("stopped by the user"));
    let errors = refined.run.errors.unwrap();
    assert_eq!((refined.run.status, errors.sequence.len()), (Status::Finished, 2));
    assert_eq!(errors.sequence, said.into_inner());
    let error = errors.columns.iter().find(|error| error.column == "tip.deflection").unwrap();
    assert_eq!(error.discretization, errors.sequence[1].error);
}

/// Where errors cannot fall to what is asked the sequence ends by itself, with the run of the smallest error, and calls a smooth motion
/// neither chaotic nor unstable. A tolerance with a unit bounds the columns that it fits.
#[test]
fn a_refinement_ends_at_rounding_with_its_best_run() {
    let smooth = "load=[{on='2 m',force=[0,0.4],amplitude={kind='ramp',time=0.4}}]";
    let reading = read(&[smooth, "run.duration=0.5"]);
    let target = Target::new("4e-13 m".to_owned(), None);
    let mut runs = 0;
    let refined = reading.refine(&target, &mut |_| ControlFlow::Continue(()), &mut |_| runs += 1).unwrap();
    let errors = refined.run.errors.unwrap();
    let refused = refined.refused.unwrap();
    assert!(!refused.contains("amplifies") && runs <= 9, "{refused} {:?}", errors.sequence);
    assert!(errors.sequence.iter().all(|rung| rung.quantity.starts_with("tip.")), "{:?}", errors.sequence);
    let least = errors.sequence.iter().map(|rung| rung.error).fold(f64::INFINITY, f64::min);
    let best = errors.sequence.iter().find(|rung| rung.error == least).unwrap();
    let column = errors.columns.iter().find(|error| error.column == best.quantity).unwrap();
    assert_eq!(column.discretization, least, "{:?}", errors.sequence);
}

/// Radau, which companions run by, leaves friction in space to nonsmooth steps: those of a companion are shorter than the steps of the run, x = vt − ½ μg t².
#[test]
fn a_companion_of_a_sliding_box_has_shorter_steps() {
    let case = "gravity = [0, 0, -10]\n[[body]]\nname = 'box'\nmass = 1\ninertia = { kind = 'principal', moments = [1, 1, 1] }\n\
                position = [0, 0, 0]\nvelocity = [1, 0, 0]\n[[contact]]\non = 'box'\nobstacle = { kind = 'plane', point = [0, 0, 0], \
                normal = [0, 0, 1] }\nlaw = { kind = 'constraint', restitution = 0, friction = 0.2 }\n[integrator]\nkind = 'moreau-jean'\n\
                step = 1e-3\n[run]\nduration = 0.2\n";
    let reading = written::reading(case, &[]);
    let run = written::outcome(&reading);
    let errors = reading.estimate_errors(&run, Effort::Full, &mut |_| ControlFlow::Continue(()));
    assert_eq!(errors.unknown, None);
    let x = *run.trajectory.column("box.position.x").unwrap().last().unwrap();
    let stated = errors.columns.iter().find(|error| error.column == "box.position.x").unwrap().last;
    let off = (x - 0.16).abs();
    assert!(off <= stated && stated < 10.0 * off.max(1e-6), "{off:e} {stated:e}");
}

/// Loads that set in at once make the ends of a fine mesh vibrate for a moment, with accelerations that are never seen again. The crest of the
/// slow motion that comes later stands between two records: it is that of dense ones, at any interval.
#[test]
fn a_crest_between_records_is_found_behind_a_start_that_was_far_faster() {
    let text = "beam.length = 1\nrun.duration = 0.5\nmodel.coupling = \"exact\"\nbasis.elements = 32\n\
                section = { kind = \"rectangle\", modulus = 3e9, density = 7800, width = 5e-3, height = 5e-3, rotary-inertia = true }\n\
                hub.motion = { kind = \"expression\", formula = \"0.3*sin(0.944*t)\", of = \"angle\" }\n\
                damping.stiffness = 3.2e-4\n[[load]]\non = \"beam\"\nforce-per-length = [0, 9.4e-3]\nfrom = 0.41\n\
                [[load]]\non = \"tip\"\nforce = [-9.4e-4, 9.4e-3]\naxes = \"follower\"\n\
                [[mass]]\non = \"0.6 m\"\nmass = 0.39\ninertia = 4.9e-6\n\
                [[spring]]\nkind = \"point\"\non = \"0.5 m\"\nto = [1, 0.1]\nstiffness = 1.4\n";
    let crest = |step: &str| {
        let run = finished(&reading(text, &[format!("output.step={step}").as_str()]));
        let column = run.trajectory.index("tip.rotation_velocity").unwrap();
        run.trajectory.extremes(column).max
    };
    let dense = crest("5e-4");
    for step in ["0.01", "0.019963574", "0.05", "0.25"] {
        let found = crest(step);
        assert!(
            (found / dense - 1.0).abs() < 1e-3,
            "{found} in place of {dense} with records every {step} s"
        );
    }
}

/// The records bound the steps of this run in space: they are twice the interval of recording, whether its tolerance is 1e-6 or 1e-7, and damp
/// the axial waves that gravity sets off, of some 1e-7 m. What is true is told by the planar equations, with steps that follow those waves.
#[test]
fn an_error_of_steps_that_records_bound_is_stated_and_refined() {
    const SPUN: &str = "
gravity = [-2, -0.4]
[beam]
length = 0.19
[section]
kind = 'resultants'
mass-per-length = 0.0144
axial-stiffness = 1626
bending-stiffness = 0.0196
[hub]
radius = 0.0127
motion = { kind = 'spin-up', speed = 27.3, time = 0.16 }
[run]
duration = 0.161
";
    let exact = "integrator={kind='radau',tolerance=1e-10,absolute-tolerance=1e-11}";
    let exact = finished(&reading(SPUN, &["model.coupling=exact", "basis.elements=20", exact]));
    let last = |run: &Run, name: &str| *run.trajectory.column(name).unwrap().last().unwrap();
    let run_of = |tolerance: &str| {
        let reading = reading(SPUN, &["model.coupling=space", tolerance]);
        let (run, errors, _) = run(&reading);
        let off = |name: &str| {
            let stated = errors.columns.iter().find(|error| error.column == name).unwrap();
            let largest = run.trajectory.rows().zip(exact.trajectory.rows());
            let [ours, theirs] = [&run, &exact].map(|run| run.trajectory.index(name).unwrap());
            let largest = largest.map(|((_, x), (_, y))| (x[ours] - y[theirs]).abs()).fold(0.0, f64::max);
            ((last(&run, name) - last(&exact, name)).abs() / stated.last, largest / stated.discretization)
        };
        (run.counters.steps, off("tip.axial"), off("tip.axial_velocity"))
    };
    let [loose, tight] = ["integrator.tolerance=1e-6", "integrator.tolerance=1e-7"].map(run_of);
    assert!(tight.0 < loose.0 * 11 / 10, "the tolerance decides about steps: {} and {}", loose.0, tight.0);
    for (_, axial, velocity) in [loose, tight] {
        // Waves that steps damp converge with an order below one: the difference of two runs is no more than a part of the error.
        for off in [axial.0, axial.1, velocity.0, velocity.1] {
            assert!(off < 2.0, "{axial:?} {velocity:?}");
        }
    }
    let target = Target::new("1e-4".to_owned(), Some("tip.axial.final".to_owned()));
    let refined = reading(SPUN, &["model.coupling=space"]).refine(
        &target,
        &mut |_| ControlFlow::Continue(()),
        &mut |_| (),
    );
    let refined = refined.unwrap();
    assert_eq!(refined.refused, None);
    let off = (last(&refined.run, "tip.axial") - last(&exact, "tip.axial")).abs();
    let largest = exact.trajectory.extremes(exact.trajectory.index("tip.axial").unwrap()).largest();
    assert!(off < 1e-4 * largest, "{off:e} of {largest:e}");
}
