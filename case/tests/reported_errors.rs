//! The error that a run reports of itself, against the error it has.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written;
use flexion_case::{Effort, Reading, Run, Target};
use flexion_results::Errors;
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
[[force]]
station = 2
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
    (run, errors.unwrap(), steps)
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
    let errors = reading.estimate_errors(&ours, Effort::Auto, &mut |_| ControlFlow::Continue(())).unwrap();
    let why = errors.unknown.unwrap();
    assert!(why.contains("there is no finer run: must be from 1 to 1000, but is 1200"), "{why}");
    assert!(reading.estimate_errors(&ours, Effort::Full, &mut |_| ControlFlow::Continue(())).is_err());
}

/// A mesh that is too coarse is told which would do, and that one does.
#[test]
fn a_coarse_mesh_is_told_the_mesh_that_would_do() {
    let case = |load: &str, rest: &str| {
        format!("{}{load}\nstation = 1\namplitude = {{ kind = 'ramp', time = 1 }}\n{rest}", written::STRIP)
    };
    let rolled =
        case("[[couple]]\ncouple = 183", "[damping]\nmass-proportional = 10\n[run]\nduration = 1.2\n");
    let bent = case("[[force]]\nforce = [0, -140]", "[run]\nduration = 1.5\n");
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
        let refined = reading.refine(&target, &mut |_| ControlFlow::Continue(())).unwrap();
        assert_eq!(refined.refused, None);
    }
}
