//! Starts in equilibria that are not stable, and paths of equilibria.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use crate::written;
use flexion::analysis::modes::modes;
use flexion::analysis::path::{Critical, Plan};
use flexion::analysis::rotation::rotate_stably;
use flexion::analysis::stability;
use flexion_case::Effort;
use std::ops::ControlFlow;

/// P1's beam at rest under a dead force at its tip, 400 N along it and 1 N across: the load of Euler is 345 N.
const COLUMN: &str = r#"
[beam]
length = "10 m"
[section]
kind = "uniform"
modulus = "70 GPa"
density = "3000 kg/m^3"
area = "4 cm^2"
second-moment = "2e-7 m^4"
[hub]
motion = { kind = "constant", speed = 0 }
[model]
coupling = "exact"
[basis]
kind = "finite-elements"
elements = 10
[[load]]
on = "10 m"
force = ["-400 N", "1 N"]
[initial]
kind = "static"
[run]
duration = 0
"#;

#[test]
fn a_column_past_its_buckling_load_begins_bent_and_says_so() {
    let run = written::finished(&written::reading(COLUMN, &[]));
    let tip = run.trajectory.column("tip.deflection").unwrap()[0];
    // The elastica under 400/345.4 of the load of Euler, and a little more by the force across.
    assert!(tip > 5.9 && tip < 6.3, "{tip}");
    assert!(run.warnings.iter().any(|w| w.contains("first stable one on the path")), "{:?}", run.warnings);
    // Without large deflections nothing holds it.
    let run = written::finished(&written::reading(COLUMN, &["model.coupling=first"]));
    assert!(run.warnings.iter().any(|w| w.contains("unstable: 1 direction")), "{:?}", run.warnings);
}

/// Beck's column, EI = ρA = L = 1: flutter at 20.0509, and frequencies below by the determinant of its exact solution.
#[test]
fn becks_column_is_stable_up_to_its_flutter_load() {
    let text = |force: f64| {
        format!(
            "[beam]\nlength = 1.0\n[section]\nkind = \"resultants\"\nmass-per-length = 1.0\naxial-stiffness = 1e8\n\
             bending-stiffness = 1.0\nrotary-inertia = 0.0\n[hub]\n\
             motion = {{ kind = \"constant\", speed = 0 }}\n[model]\ncoupling = \"exact\"\n[basis]\n\
             kind = \"finite-elements\"\nelements = 32\n[[load]]\non = \"1 m\"\nforce = [{}, 0.0]\naxes = \"follower\"\n\
             [run]\nduration = \"0.1 s\"\n",
            -force
        )
    };
    let path = written::reading(&text(30.0), &[]).load_path(&Plan::to(1.0), |_, _| true).unwrap();
    let (point, critical) = path.critical().next().unwrap();
    assert_eq!(critical, Critical::Flutter);
    assert!((30.0 * point.factor / 20.0509 - 1.0).abs() < 1e-5, "{}", 30.0 * point.factor);
    for (force, expected) in [(5.0, &[4.2177][..]), (10.0, &[5.1758, 18.587])] {
        let mut system = written::reading(&text(force), &[]).case.system().unwrap();
        let mut state = system.initial();
        rotate_stably(system.as_mut(), &mut state, 0.0, 0.0).unwrap();
        assert!(stability(system.as_mut(), &state).unwrap().is_stable());
        let found = modes(system.as_mut(), &state, 2, &[]).unwrap();
        for (mode, expected) in found.modes.iter().zip(expected) {
            assert!((mode.frequency() / expected - 1.0).abs() < 3e-5, "{}", mode.frequency());
        }
    }
}

/// A couple π EI/L rolls a cantilever up to a half circle: its tip is at 2L/π across and −L along. The errors that `statics` states
/// cover those it has, and a mesh of two elements is told one that does.
#[test]
fn errors_of_a_path_are_stated() {
    // EI = 70 GPa · 20 mm · (5 mm)³/12
    let couple = std::f64::consts::PI * 70e9 * 0.02 * 0.005_f64.powi(3) / 12.0;
    let load = format!("[[load]]\non = '1 m'\ncouple = {couple}\n[run]\nduration = 0\n");
    let path = |elements: usize| {
        let set = format!("basis={{kind='finite-elements',elements={elements}}}");
        let (reading, plan) = (written::reading(&[written::STRIP, &load].concat(), &[&set]), Plan::to(1.0));
        let mut path = reading.load_path(&plan, |_, _| true).unwrap();
        let warning = reading.estimate_path_errors(&mut path, &plan, Effort::Auto, |_, _| true);
        assert_eq!((&path.end, &path.unknown), (&None, &None));
        let last = path.points.last().unwrap();
        for (column, exact) in [("tip.deflection", 2.0 / std::f64::consts::PI), ("tip.axial", -1.0)] {
            let at = path.channels.iter().position(|channel| channel.name == column).unwrap();
            let (off, stated) = ((last.values[at] - exact).abs(), last.error.as_ref().unwrap().values[at]);
            // EA stretches the beam by less than 1e-4 of its length, which is no error of the mesh.
            assert!(off <= stated + 1e-4 && stated < 8.0 * off + 1e-3, "{elements} {column}: {off} {stated}");
        }
        warning
    };
    let warning = path(2).unwrap();
    assert!(warning.contains("the mesh is coarse") && warning.contains("basis."), "{warning}");
    assert_eq!(path(16), None);
}

/// A follower force of 13 EI/L² on a cantilever in space, where it flutters: the search for a stable equilibrium can be stopped, and the
/// time that it takes is that of the run.
#[test]
fn a_finer_path_that_costs_too_much_is_not_followed() {
    let reading = written::reading(COLUMN, &["basis.elements=400"]);
    let plan = Plan::to(0.5);
    let mut path = reading.load_path(&plan, |_, _| true).unwrap();
    let mut followed = 0;
    reading.estimate_path_errors(&mut path, &plan, Effort::Auto, |_, _| {
        followed += 1;
        true
    });
    assert!(path.unknown.as_ref().is_some_and(|why| why.contains("--error full")), "{:?}", path.unknown);
    assert_eq!(followed, 0);
}

#[test]
fn a_search_for_a_stable_equilibrium_can_be_stopped() {
    let case = "
initial = { kind = 'static' }
run = { duration = 0 }
[[beam]]
length = 100
root = 'clamped'
section = { kind = 'general', mass-per-length = 1, axial-stiffness = 4.2e8, torsional-stiffness = 3e7, bending-stiffness = 3.5e7, bending-stiffness-across = 3.5e7 }
polar-inertia = 1
[[load]]
on = 'beam.tip'
force = [0, 129900, 0]
axes = 'follower'
";
    let reading = written::reading(case, &[]);
    let mut factors = Vec::new();
    let stopped = reading.prepare_watched(&mut |factor| {
        factors.push(factor);
        if factors.len() < 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    });
    let message = stopped.err().unwrap().list[0].message.clone();
    assert!(message.contains("stopped") && factors.len() == 20, "{message}");
    // Levels of the loads at once, and then a path that begins without them.
    let path = factors.iter().position(|factor| *factor == 0.0).unwrap();
    assert!(factors[..path].contains(&1.0) && path < 10, "{factors:?}");
    assert!(factors[path..].windows(2).all(|pair| pair[1] > pair[0]), "{factors:?}");
    let run = written::finished(&reading);
    assert!(run.warnings.iter().any(|text| text.contains("flutter")), "{:?}", run.warnings);
    // Hundreds of equilibria of 66 unknowns take milliseconds at least.
    assert!(run.wall_time > 1e-3, "{}", run.wall_time);
}

/// Two kinks of a table beside an end of equal elements, which makes room for one of them and was at the other: a notch of a tenth with flanks of a
/// hundredth, and one of a thousandth with flanks of a tenth of that. The tip's deflection under a small force is F ∫ (L − x)²/EI dx.
#[test]
fn a_notch_is_as_flexible_as_its_table_says_wherever_elements_end() {
    for [width, flank] in [[1e-1, 1e-2], [1e-3, 1e-4]] {
        let rows = [
            (0.0, 200.0),
            (0.5 - flank, 200.0),
            (0.5, 4.0),
            (0.5 + width, 4.0),
            (0.5 + width + flank, 200.0),
            (1.0, 200.0),
        ];
        let table: String = rows.iter().map(|(x, ei)| format!("{x},1,1e6,{ei}\n")).collect();
        let files: flexion_case::Contents =
            [("notch.csv".to_owned(), format!("x,mass,EA,EI\n{table}").into_bytes().into())]
                .into_iter()
                .collect();
        let gauss = flexion::quadrature::Gauss::new(8);
        let flexibility: f64 = rows
            .windows(2)
            .flat_map(|pair| (0..100).map(move |k| (pair[0], pair[1], f64::from(k))))
            .map(|((a, f), (b, g), k)| {
                let at = |k: f64| a + (b - a) * k / 100.0;
                gauss.integrate(at(k), at(k + 1.0), |x| (1.0 - x).powi(2) / (f + (g - f) * (x - a) / (b - a)))
            })
            .sum();
        for coupling in ["first", "exact", "space"] {
            for force in [0.01, 1.0] {
                let text = format!(
                    "[beam]\nlength=1\n[section]\nkind='table'\nfile='notch.csv'\ninterpolation='linear'\n[hub]\n\
                     motion={{kind='constant',speed=0}}\n[model]\ncoupling='{coupling}'\n[basis]\nkind='finite-elements'\nelements=10\n\
                     [[load]]\non='tip'\nforce=[0,{force}]\n[run]\nduration=0\n"
                );
                let reading = flexion_case::parse_with(text, std::path::Path::new("case.toml"), &[], &files);
                let reading = reading.unwrap_or_else(|problems| panic!("{problems}"));
                let mut path = reading.load_path(&Plan::to(1.0), |_, _| true).unwrap();
                assert_eq!(path.end, None, "{coupling}");
                reading.estimate_path_errors(&mut path, &Plan::to(1.0), Effort::Full, |_, _| true);
                let tip = path.channels.iter().position(|c| c.name == "tip.deflection").unwrap();
                let last = path.points.last().unwrap();
                let (found, error) = (last.values[tip], last.error.as_ref().unwrap().values[tip]);
                let off = (found - force * flexibility).abs();
                let rounds = path
                    .cautions
                    .iter()
                    .any(|caution| caution.contains("rounding of the assembled stiffness"));
                assert_eq!(rounds, coupling == "first" && width < 1e-2, "{coupling} {:?}", path.cautions);
                // What bends by a thousandth is shorter along its axis by a millionth.
                // The caution says up to 4.7e-3.
                let allowed = if rounds { 4.7e-3 * found } else { error + 1e-5 * found };
                assert!(
                    off <= allowed,
                    "{coupling} {width} {force}: {found} ± {error} for {}",
                    force * flexibility
                );
            }
        }
    }
}

/// A cantilever with shear of slenderness S under a force that bends it by a part of its length, F L³/(3 EI) for small ones.
fn slender_with_shear(slenderness: f64, elements: usize, part: f64) -> flexion_case::Reading {
    let height = 12_f64.sqrt() / slenderness;
    let force = 0.25 * 12e9 * height.powi(3) * part;
    let case = format!(
        "initial = {{ kind = 'static' }}\nrun = {{ duration = 0 }}\n[[beam]]\nlength = 1\nroot = 'clamped'\nup = [0, 1, 0]\nshear = true\n\
         elements = {elements}\nsection = {{ kind = 'rectangle', modulus = 12e12, density = 1000, width = '1 mm', height = {height:e} }}\n[[load]]\n\
         on = 'tip'\nforce = [0, {force:e}, 0]\n"
    );
    written::reading(&case, &[])
}

/// Increments that rounding keeps from falling, or that fall slowly because a motion is held that is taken for free, are no equilibrium while they are as
/// large as what the loads make: the tip went 2.9 times too far by the first, and not at all by the second.
#[test]
fn what_rounding_hides_is_no_equilibrium() {
    for (slenderness, elements, part, expected) in [(1e6, 400, 1e-6, 1.0), (2e6, 200, 0.1, 0.989907)] {
        let run = written::finished(&slender_with_shear(slenderness, elements, part));
        let tip = run.trajectory.column("beam.tip.displacement.y").unwrap()[0] / part;
        assert!((tip / expected - 1.0).abs() < 0.02, "{slenderness:e} {elements}: {tip}");
    }
    let path = slender_with_shear(1e7, 100, 1e-6).load_path(&Plan::to(1.0), |_, _| true).unwrap();
    let end = path.end.unwrap();
    assert!(
        end.contains("rounding of the stiffness hides the loads") && end.contains("take fewer elements"),
        "{end}"
    );
}

/// Of a bar under a couple with the radius of gyration ρ and the curvature κ, a strain inside the elements has the energy 1 − 10 κ²ρ² times its own
/// (theory of beams in space): at κρ = √0.1 it has none left. The pure couple has the curvature M/EI everywhere.
#[test]
fn a_caution_says_where_bending_makes_the_axial_strain_of_a_beam_in_space_inaccurate() {
    let (axial, bending) = (5600.0_f64, 7.49e-3_f64);
    let part = |of: f64| of * (axial * bending).sqrt();
    let reading = |of: f64, set: &[&str]| {
        let text = format!(
            "[beam]\nlength='20 mm'\n[section]\nkind='uniform'\nmodulus=7e7\ndensity=2700\narea=8e-5\nsecond-moment=1.07e-10\n\
             [basis]\nelements=10\n[[load]]\non='tip'\ncouple={:e}\n[model]\ncoupling='space'\n[hub]\nmotion={{kind='constant',speed=0}}\n",
            part(of)
        );
        written::reading(&text, set)
    };
    let statics = |of: f64| reading(of, &[]).load_path(&Plan::to(1.0), |_, _| true).unwrap();
    let of = |cautions: &[String]| cautions.iter().find(|caution| caution.contains("is bent to")).cloned();
    assert_eq!(of(&statics(0.09).cautions), None);
    let caution = of(&statics(0.2).cautions).unwrap();
    assert!(caution.contains("beam `beam` is bent to κ·√(EI/EA) = 0.20 at 0.0"), "{caution}");
    let limit = statics(0.35);
    let critical = limit.points.iter().find(|point| point.critical.is_some()).unwrap();
    assert!((0.35 * critical.factor - 0.1_f64.sqrt()).abs() < 2e-3, "{}", 0.35 * critical.factor);
    // A run sees what is bent on the way too, and the plane coupling has no such limit.
    let run = |coupling: &str| {
        let set = ["initial={kind='static'}", "run.duration=0", coupling];
        written::finished(&reading(0.2, &set)).warnings
    };
    assert!(of(&run("model.coupling=space")).is_some());
    assert!(of(&run("model.coupling=exact")).is_none());
}

/// The inertia of a hub that sets off with α = 0.01 rad/s² grows with the loads: under the factor s its torque is s J α = 4 s N·m, J = 1.2 kg/m · (10 m)³/3 = 400 kg·m².
#[test]
fn the_inertia_of_a_hub_that_sets_off_is_a_load() {
    let case = "[beam]\nlength=10\n[section]\nkind='uniform'\nmodulus='70 GPa'\ndensity=3000\narea='4 cm^2'\nsecond-moment=2e-7\n\
                [hub]\nmotion={kind='ramp',speed=4,time=400}\n";
    for coupling in ["zeroth", "first", "exact"] {
        let set = format!("model.coupling={coupling}");
        let path = written::reading(case, &[&set]).load_path(&Plan::to(1.0), |_, _| true).unwrap();
        let column = |name: &str| path.channels.iter().position(|channel| channel.name == name).unwrap();
        assert!(path.points.len() > 3);
        for point in &path.points {
            let of = |name: &str| point.values[column(name)];
            assert!((of("hub.acceleration") - 0.01 * point.factor).abs() < 1e-17);
            assert!(
                (of("hub.torque") - 4.0 * point.factor).abs() < 1e-5,
                "{coupling} {}: {}",
                point.factor,
                of("hub.torque")
            );
        }
    }
}
