//! Blades of cases: the NREL 5 MW blade against published frequencies, and the exact blade in the plane of rotation
//! against the exact hub–beam, which shares no code with it.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::modes::modes;
use flexion::analysis::rotation::{rotate, rotate_stably};
use flexion::blade::{Blade, Component, Model, Setting, StrainEnergy};
use flexion::hub_beam::{Coupling as _, Drive, ExactCoupling, Hub, HubBeam};
use flexion::linalg::{Matrix, negative_pivots};
use flexion::profile::{Constant, Motion};
use flexion::quadrature::Gauss;
use flexion::section::{BladeResultants, Resultants, Uniform};
use flexion::system::{Dynamics, State, System, Weights};
use flexion_case::parse;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;

fn matrix(system: &mut dyn System, state: &State, weights: (f64, f64, f64)) -> Matrix {
    let mut matrix = Matrix::new(&system.structure(0));
    system.tangent(state, Weights::new(weights.0, weights.1, weights.2), &mut matrix);
    matrix
}

/// Frequency [Hz] of mode `number` (from 1) without gyroscopic terms, by the signs of the pivots of K − ω²M.
fn frequency(blade: &mut Blade, number: usize) -> f64 {
    let state = State::zeros(blade.size(), 0.0);
    let (m, k) = (matrix(blade, &state, (1.0, 0.0, 0.0)), matrix(blade, &state, (0.0, 0.0, 1.0)));
    let (mut low, mut high) = (0.0, 1e4);
    while high - low > 1e-8 * high {
        let middle = 0.5 * (low + high);
        if negative_pivots(&k, &m, -middle * middle) >= number { high = middle } else { low = middle }
    }
    low / TAU
}

const NREL: &str = r#"
[beam]
length = "61.5 m"
[section]
kind = "blade"
file = "nrel_5mw.dat"
format = "elastodyn"
[hub]
radius = "1.5 m"
motion = { kind = "constant", speed = "12.1 rpm" }
[blade]
elements = 60
[run]
duration = "1 s"
"#;

fn nrel() -> flexion_case::Reading {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/blade/case.toml");
    parse(NREL.to_owned(), &folder, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

/// ∫ρA xⁿ dx by straight lines between the rows.
fn moment(power: i32) -> f64 {
    let section = nrel().case.hub_beam().unwrap().section.planar.clone();
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
    let section = nrel().case.hub_beam().unwrap().section.planar.clone();
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
    let mut blade = nrel().case.blade().unwrap().unwrap();
    for (number, lowest, highest) in [(1, 0.6664, 0.6993), (2, 1.0793, 1.0898), (3, 1.9223, 2.0205)] {
        let found = frequency(&mut blade, number);
        assert!((lowest..highest).contains(&found), "mode {number}: {found}");
    }
    // 1500 lumped masses on the flexibilities of the twisted blade, in a program apart from this one.
    for (i, lumped) in [0.677699, 1.086436, 1.954316, 4.009036, 4.555737].into_iter().enumerate() {
        let found = frequency(&mut blade, i + 1);
        assert!((found / lumped - 1.0).abs() < 1e-4, "mode {}: {found} for {lumped}", i + 1);
    }
    let at_rest = frequency(&mut blade, 1);
    blade.set_speed(12.1 * TAU / 60.0).unwrap();
    let rated = frequency(&mut blade, 1);
    // Southwell: ω² = ω₀² + B Ω², with B from 1 to 2 for a flapwise mode.
    let factor = (rated * rated - at_rest * at_rest) / (12.1_f64 / 60.0).powi(2);
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
    let mut blade = nrel().case.blade().unwrap().unwrap();
    let mut state = State::zeros(blade.size(), 0.0);
    rotate_stably(&mut blade, &mut state, 0.0, 12.1 * TAU / 60.0).unwrap();
    let found = modes(&mut blade, &state, 3, &[]).unwrap().modes;
    for (mode, axis, coefficients, tolerance) in published {
        let q: Vec<f64> = found[mode].vector.iter().map(|x| x.re).collect();
        let tip = blade.displacement(&q, 61.5).0[axis];
        for i in 1..20 {
            let s = f64::from(i) / 20.0;
            let shape = blade.displacement(&q, 61.5 * s).0[axis] / tip;
            let polynomial = coefficients.iter().rev().fold(0.0, |sum, c| sum * s + c) * s * s;
            println!("{mode} {s}: {shape:.4} {polynomial:.4}");
            assert!((shape - polynomial).abs() < tolerance, "mode {mode} at {s}: {shape} for {polynomial}");
        }
    }
}

#[test]
fn in_the_plane_of_rotation_the_exact_blade_is_the_exact_hub_beam() {
    let (length, elements, radius, speed) = (2.0, 6, 0.4, 7.0);
    // A strain of 2 % at the root.
    let (mass, axial, bending, rotary) = (1.2, 12_000.0, 30.0, 0.003);
    let planar = Uniform::from_resultants(Resultants {
        mass,
        rotary_inertia: rotary,
        axial_stiffness: axial,
        bending_stiffness: bending,
        ..Resultants::default()
    })
    .unwrap();
    let drive = Drive::Prescribed(Motion::Speed {
        profile: Arc::new(Constant::new(speed).unwrap()),
        initial_angle: 0.0,
    });
    let hub = Hub { radius, inertia: 0.0, drive };
    let coupling = ExactCoupling::new(length, elements, &planar, &hub).unwrap();
    assert_eq!(coupling.fields().axial().len(), 2 * elements + 1);
    let mut beam = HubBeam::new(hub, coupling, &[]);
    let mut state = State::zeros(beam.size(), 0.0);
    equilibrium(&mut beam, &mut state).unwrap();

    let section = BladeResultants {
        mass,
        axial_stiffness: axial,
        flap_stiffness: bending,
        chord_stiffness: bending,
        flap_inertia: rotary,
        chord_inertia: rotary,
        ..BladeResultants::default()
    };
    let setting = Setting { length, hub_radius: radius, ..Setting::default() };
    let model = Model { torsion: false, strain_energy: StrainEnergy::Exact, ..Model::default() };
    let mut blade = Blade::new(setting, &section, model, elements).unwrap();
    blade.set_speed(speed).unwrap();
    let in_plane: Vec<usize> =
        (0..blade.size().v).filter(|&i| blade.components()[i] != Component::Flapwise).collect();
    assert_eq!(in_plane.len(), beam.size().v);
    for (i, &row) in in_plane.iter().enumerate() {
        assert!((blade.steady()[row] - state.q[i]).abs() < 1e-9, "{i}");
    }
    let zero = State::zeros(blade.size(), 0.0);
    for weights in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)] {
        let (a, b) = (matrix(&mut beam, &state, weights), matrix(&mut blade, &zero, weights));
        let n = in_plane.len();
        let largest = (0..n * n).fold(0.0_f64, |m, k| m.max(a.get(k / n, k % n).abs()));
        for (i, &row) in in_plane.iter().enumerate() {
            for (j, &column) in in_plane.iter().enumerate() {
                let (beam, blade) = (a.get(i, j), b.get(row, column));
                assert!((beam - blade).abs() < 1e-6 * largest, "{weights:?} {i} {j}: {beam} {blade}");
            }
        }
    }
}

#[test]
fn modes_are_found_through_the_system_and_say_which_way_they_swing() {
    let section = BladeResultants {
        mass: 1.0,
        axial_stiffness: 4900.0,
        flap_stiffness: 1.0,
        chord_stiffness: 2.0,
        ..BladeResultants::default()
    };
    let setting = Setting { length: 1.0, ..Setting::default() };
    let model = Model { torsion: false, strain_energy: StrainEnergy::Linear, ..Model::default() };
    let mut blade = Blade::new(setting, &section, model, 30).unwrap();
    let mut state = State::zeros(blade.size(), 0.0);
    rotate_stably(&mut blade, &mut state, 0.0, 6.0).unwrap();
    let found = modes(&mut blade, &state, 4, &[0.5, 1.0]).unwrap();
    // Flapwise γ = 6: Wright et al. 1982.
    let flap: Vec<f64> = found.modes.iter().filter(|m| m.shares.flap > 0.5).map(|m| m.frequency()).collect();
    assert!((flap[0] - 7.360).abs() < 6e-4 && (flap[1] - 26.809).abs() < 6e-4, "{flap:?}");
    for mode in &found.modes {
        assert!(mode.shares.flap > 1.0 - 1e-9 || mode.shares.flap < 1e-9, "{:?}", mode.shares);
        assert!(mode.damping_ratio().abs() < 1e-9);
    }
    // A soft blade cannot be held at a speed at which its strain would be infinite.
    let exact = Model { strain_energy: StrainEnergy::Exact, ..model };
    let mut soft = Blade::new(setting, &section, exact, 10).unwrap();
    let mut state = State::zeros(soft.size(), 0.0);
    let error = rotate(&mut soft, &mut state, 0.0, 300.0).unwrap_err();
    // x + w₁ = sin(βx)/(β cos β), β = Ω √(ρA/EA): at β = π/2 the stretch is infinite.
    let limit = std::f64::consts::FRAC_PI_2 * 70.0;
    assert!((error.reached() / limit - 1.0).abs() < 0.1, "{error}");
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
    for (energy, coupling) in [("exact", "exact"), ("linear", "first")] {
        for speed in [0.0, 6.0] {
            let found = [false, true].map(|blade| {
                let mut set = vec![format!("model.coupling={coupling}")];
                set.extend(blade.then(|| format!("blade={{elements=40,strain-energy='{energy}'}}")));
                let set: Vec<&str> = set.iter().map(String::as_str).collect();
                let (mut system, _) =
                    crate::written::reading(BEAM, &set).case.vibrating(speed > 0.0).unwrap();
                let mut state = system.initial();
                rotate_stably(system.as_mut(), &mut state, 0.0, speed).unwrap();
                let found = modes(system.as_mut(), &state, 8, &[0.5, 1.0]).unwrap();
                let in_plane = found.modes.iter().filter(|mode| mode.shares.flap < 0.5);
                in_plane.map(|mode| mode.frequency()).take(3).collect::<Vec<_>>()
            });
            for (beam, blade) in found[0].iter().zip(&found[1]) {
                assert!((blade / beam - 1.0).abs() < 1e-5, "{energy} {speed}: {found:?}");
            }
            assert!(found[1].len() == 3, "{found:?}");
        }
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
    let text =
        "beam.length = 1\nsection = { kind = \"blade\", file = \"rows.csv\" }\nblade = { elements = 5 }\n";
    let reading = flexion_case::parse(text.to_owned(), &folder.path().join("case.toml"), &[])
        .unwrap_or_else(|p| panic!("{p}"));
    let size = |reading: &flexion_case::Reading| reading.case.vibrating(false).unwrap().0.size().v;
    let finer = reading.with_finer_mesh().unwrap();
    assert!(10 * size(&finer) >= 19 * size(&reading), "{} and {}", size(&finer), size(&reading));
}
