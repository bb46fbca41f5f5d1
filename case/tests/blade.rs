//! Blades of cases: the NREL 5 MW blade against published frequencies, and masses along a blade against the beam in its plane.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::analysis::modes::{Mode, modes};
use flexion::analysis::rotation::rotate_stably;
use flexion::quadrature::Gauss;
use flexion_case::{Reading, parse};
use std::f64::consts::TAU;
use std::path::Path;

const NREL: &str = r#"
[beam]
length = "61.5 m"
[section]
kind = "deck"
file = "nrel_5mw.dat"
format = "elastodyn"
[hub]
radius = "1.5 m"
motion = { kind = "constant", speed = "12.1 rpm" }
[model]
coupling = "space"
[basis]
elements = 60
[run]
duration = "1 s"
"#;

fn nrel() -> Reading {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/blade/case.toml");
    parse(NREL.to_owned(), &folder, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Modes of what a case says vibrates, at a speed \[rad/s\].
fn vibrations(reading: &Reading, speed: f64, count: usize, stations: &[f64]) -> Vec<Mode> {
    let (mut system, _) = reading.case.vibrating(true).unwrap();
    let mut state = system.initial();
    rotate_stably(system.as_mut(), &mut state, 0.0, speed).unwrap();
    modes(system.as_mut(), &state, count, stations).unwrap().modes
}

/// ∫ρA xⁿ dx by straight lines between the rows.
fn moment(power: i32) -> f64 {
    let section = nrel().case.space().unwrap().beams[0].0.section.planar.clone();
    let mut cuts = vec![0.0];
    cuts.extend(section.breaks());
    cuts.push(61.5);
    let gauss = Gauss::new(3);
    let mass = |x: f64| section.resultants(x).mass * x.powi(power);
    cuts.windows(2).map(|c| gauss.integrate(c[0], c[1], mass)).sum()
}

#[test]
fn the_nrel_blade_has_its_published_mass() {
    // J. Jonkman, S. Butterfield, W. Musial & G. Scott, NREL/TP-500-38060 (2009), table 2-2: 17 740 kg, 363 231 kg·m and
    // 11 776 047 kg·m² about the root. The factor 1.04536 of the file makes the mass right as FAST sums it: over the 17
    // elements of table 3-1, each with the density in its middle, the rows joined by straight lines.
    let section = nrel().case.space().unwrap().beams[0].0.section.planar.clone();
    let ends = [vec![41.0 / 15.0; 3], vec![4.1; 11], vec![41.0 / 15.0; 3]].concat();
    let (mut sums, mut from) = ([0.0; 3], 0.0);
    for length in ends {
        let middle: f64 = from + 0.5 * length;
        for (power, sum) in sums.iter_mut().enumerate() {
            *sum += length * section.resultants(middle).mass * middle.powi(power as i32);
        }
        from += length;
    }
    // The published figures are whole numbers and the factor has six digits: 5e-6 of each.
    for (found, published) in sums.into_iter().zip([17_740.0, 363_231.0, 11_776_047.0]) {
        assert!((found / published - 1.0_f64).abs() < 5e-6, "{found} for {published}");
    }
    // The same lines integrated without error have 0.74 %, 0.52 % and 0.68 % less: that is the blade of this model, whose
    // frequencies are higher by half of that.
    for (power, found, less) in [(0, sums[0], 0.739e-2), (1, sums[1], 0.517e-2), (2, sums[2], 0.681e-2)] {
        let share = 1.0 - moment(power) / found;
        assert!((share - less).abs() < 1e-5, "{power}: {share}");
    }
}

#[test]
fn the_nrel_blade_has_the_frequencies_of_lumped_masses_and_lies_among_those_of_its_rotor() {
    // The same report, table 9-1, FAST: a rotor at rest with its generator locked has three modes for each of the
    // blade, which tower and drive train move apart: asymmetric 0.6664 and 0.6675, collective 0.6993 Hz flapwise,
    // asymmetric 1.0793 and 1.0898 Hz edgewise; 1.9223, 1.9337 and 2.0205 Hz second flapwise. The blade on a root
    // that does not move lies among its three.
    let hertz = |speed: f64| -> Vec<f64> {
        vibrations(&nrel(), speed, 5, &[]).iter().map(|mode| mode.frequency() / TAU).collect()
    };
    let found = hertz(0.0);
    for (number, lowest, highest) in [(0, 0.6664, 0.6993), (1, 1.0793, 1.0898), (2, 1.9223, 2.0205)] {
        assert!((lowest..highest).contains(&found[number]), "mode {number}: {found:?}");
    }
    // 1500 lumped masses on the flexibilities of the twisted blade, in a program apart from this one.
    for (found, lumped) in found.iter().zip([0.677699, 1.086436, 1.954316, 4.009036, 4.555737]) {
        assert!((found / lumped - 1.0).abs() < 1e-4, "{found} for {lumped}");
    }
    let rated = hertz(12.1 * TAU / 60.0)[0];
    // Southwell: ω² = ω₀² + B Ω², with B from 1 to 2 for a flapwise mode.
    let factor = (rated * rated - found[0] * found[0]) / (12.1_f64 / 60.0).powi(2);
    assert!((1.0..2.0).contains(&factor), "{factor}");
}

#[test]
fn the_nrel_blade_moves_in_the_shapes_that_elastodyn_is_given() {
    // Coefficients of x², …, x⁶ in the blade file of OpenFAST's regression tests (NRELOffshrBsline5MW_Blade.dat),
    // found by NREL with another program: first and second flapwise, first edgewise, one at the tip.
    let published = [
        (0, 2, [0.0622, 1.7254, -3.2452, 4.7131, -2.2555], 0.01),
        (1, 1, [0.3627, 2.5337, -3.5772, 2.376, -0.6952], 0.015),
        (2, 2, [-0.5809, 1.2067, -15.5349, 29.7347, -13.8255], 0.05),
    ];
    let stations: Vec<f64> = (1..=20).map(|i| 61.5 * f64::from(i) / 20.0).collect();
    let reading = nrel();
    let section = &reading.case.space().unwrap().beams[0].0.blade;
    let found = vibrations(&reading, 12.1 * TAU / 60.0, 3, &stations);
    for (mode, axis, coefficients, tolerance) in published {
        // Out of the axes of the sections into those of the rotor.
        let shape = &found[mode].shape.movement;
        let turned = |i: usize| {
            let (u, (sin, cos)) = (shape[i], section.resultants(stations[i]).twist.sin_cos());
            [u[0].re, cos * u[1].re - sin * u[2].re, sin * u[1].re + cos * u[2].re][axis]
        };
        let moved: Vec<f64> = (0..stations.len()).map(turned).collect();
        for (i, moved_here) in moved[..19].iter().enumerate() {
            let s = (i + 1) as f64 / 20.0;
            let shape = moved_here / moved[19];
            let polynomial = coefficients.iter().rev().fold(0.0, |sum, c| sum * s + c) * s * s;
            assert!((shape - polynomial).abs() < tolerance, "mode {mode} at {s}: {shape} for {polynomial}");
        }
    }
}

/// Masses along a blade against the same beam in its plane, at rest and at speed. It is stiff along its axis: the strain jumps at a
/// mass, and the curve of the exact hub–beam is smooth there.
#[test]
fn masses_along_a_blade_are_those_of_the_beam_in_its_plane() {
    const BEAM: &str = "
[beam]
length = 1
[section]
kind = 'resultants'
mass-per-length = 1
axial-stiffness = 4.9e6
bending-stiffness = 1
[hub]
radius = 0.3
motion = { kind = 'constant', speed = 0 }
[model]
coupling = 'exact'
[basis]
kind = 'finite-elements'
elements = 40
[[mass]]
on = '0.53 m'
mass = 0.7
inertia = 0.01
[[mass]]
on = '1 m'
mass = 0.2
[run]
duration = 1
";
    for speed in [0.0, 6.0] {
        let found = ["exact", "space"].map(|coupling| {
            let set = [format!("model.coupling={coupling}")];
            let set: Vec<&str> = set.iter().map(String::as_str).collect();
            let found = vibrations(&crate::written::reading(BEAM, &set), speed, 8, &[]);
            let in_plane = found.iter().filter(|mode| mode.shares.flap < 0.5);
            in_plane.map(Mode::frequency).take(3).collect::<Vec<_>>()
        });
        for (planar, spatial) in found[0].iter().zip(&found[1]) {
            assert!((spatial / planar - 1.0).abs() < 1e-5, "{speed}: {found:?}");
        }
        assert!(found[1].len() == 3, "{found:?}");
    }
}

/// Where elements end at the rows of a table, twice as many equal ones are the same: the finer mesh cuts each of them.
#[test]
fn the_finer_mesh_of_a_blade_is_finer_between_the_rows_of_its_table() {
    let folder = tempfile::tempdir().unwrap();
    let rows: String = (0..=50)
        .map(|i| format!("{},1,1e6,{},2\n", f64::from(i) / 50.0, [1.0, 0.2][i as usize % 2]))
        .collect();
    std::fs::write(folder.path().join("rows.csv"), format!("x,mass,EA,EI-flap,EI-chord\n{rows}")).unwrap();
    let text = "beam.length = 1\nsection = { kind = \"deck\", format = \"csv\", file = \"rows.csv\" }\n\
         model.coupling = \"space\"\nbasis = { elements = 5 }\n";
    let reading = flexion_case::parse(text.to_owned(), &folder.path().join("case.toml"), &[])
        .unwrap_or_else(|p| panic!("{p}"));
    let size = |reading: &flexion_case::Reading| reading.case.vibrating(false).unwrap().0.size().v;
    let finer = reading.with_finer_mesh().unwrap();
    assert!(10 * size(&finer) >= 19 * size(&reading), "{} and {}", size(&finer), size(&reading));
}
