//! Modes of systems in which something moves without stiffness, or only a loop stiffens what its band holds: against closed forms,
//! and against all eigenvalues of dense matrices reduced to the motions that the joints allow.

use flexion::analysis::equilibrium::{equilibrium, stable_equilibrium};
use flexion::analysis::modes::{Modes, modes};
use flexion::linalg::{Matrix, Vec3};
use flexion::multibody::slender::{Beam, Properties, Station};
use flexion::multibody::{Axis, Flexible, Kind, Model, Multibody, Part, Rotating};
use flexion::system::{Dynamics, State, System, Weights};
use nalgebra::DMatrix;
use std::ops::ControlFlow;

const Z: [f64; 3] = [0.0, 0.0, 1.0];
/// EA, GJ, EI₂, EI₃ with L = ρA = 1.
const STIFFNESS: [f64; 4] = [1e5, 0.7, 1.0, 1.7];
/// ρJ about the axis.
const POLAR: f64 = 2e-4;

/// A beam from one point to another.
fn beam(model: &mut Model, name: &str, from: [f64; 3], to: [f64; 3], elements: usize) -> [Part; 2] {
    let d = [0, 1, 2].map(|k| to[k] - from[k]);
    let length = d.iter().map(|x| x * x).sum::<f64>().sqrt();
    let tangent = d.map(|x| x / length);
    let normal = if tangent[2].abs() > 0.9 { [1.0, 0.0, 0.0] } else { Z };
    let section = Properties::principal(STIFFNESS, 1.0, [POLAR, 0.0, 0.0]);
    let built = Beam::straight(
        Station { position: Vec3(from), tangent: Vec3(tangent), normal: Vec3(normal) },
        length,
        elements,
        section,
    );
    let beam = model.beam(Flexible::new(name, built.unwrap()));
    [0, elements].map(|node| Part::Section { beam, node })
}

fn found(system: &mut dyn System, count: usize) -> (State, Modes) {
    let mut s = system.initial();
    equilibrium(system, &mut s).unwrap();
    let found = modes(system, &s, count, &[]).unwrap();
    (s, found)
}

/// The frequencies of K x = ω² M x on the motions that the jacobian allows, without loads; those without stiffness are zero.
fn dense(system: &mut dyn System, s: &State) -> Vec<f64> {
    let (n, m) = (s.v.len(), s.lambda.len());
    let mut matrix = |a, q| {
        let mut out = Matrix::new(&system.structure(0));
        system.tangent(s, Weights::new(a, 0.0, q), &mut out);
        DMatrix::from_fn(n, n, |i, j| out.get(i, j))
    };
    let (mass, stiffness) = (matrix(1.0, 0.0), matrix(0.0, 1.0));
    let mut rows: DMatrix<f64> = DMatrix::zeros(m, n);
    system.jacobian(s, &mut |i, numbers, entries| {
        numbers.iter().zip(entries).for_each(|(j, x)| rows[(i, *j)] += x);
    });
    let parts = (rows.transpose() * &rows).symmetric_eigen();
    let free: Vec<usize> = (0..n).filter(|k| parts.eigenvalues[*k] < 1e-9).collect();
    let z = DMatrix::from_fn(n, free.len(), |i, j| parts.eigenvectors[(i, free[j])]);
    let root = (z.transpose() * mass * &z).cholesky().unwrap().l();
    let half = root.solve_lower_triangular(&(z.transpose() * stiffness * &z)).unwrap();
    let whole: DMatrix<f64> = root.solve_lower_triangular(&half.transpose()).unwrap();
    let mut squares: Vec<f64> =
        ((&whole + whole.transpose()) * 0.5).symmetric_eigenvalues().as_slice().to_vec();
    squares.sort_by(f64::total_cmp);
    let top = squares.last().copied().unwrap();
    squares.into_iter().map(|x| if x.abs() < 1e-13 * top { 0.0 } else { x.sqrt() }).collect()
}

fn compare(found: &Modes, expected: &[f64], rigid: usize, tolerance: f64) {
    assert_eq!(found.counted, Some(found.modes.len()));
    for (k, (mode, expected)) in found.modes.iter().zip(expected).enumerate() {
        let frequency = mode.frequency();
        if k < rigid {
            assert_eq!((frequency, *expected), (0.0, 0.0), "mode {k}");
        } else {
            assert!((frequency / expected - 1.0).abs() < tolerance, "mode {k}: {frequency} for {expected}");
        }
    }
}

/// Sine waves in both planes, (nπ)² √EI; the beam turns about its axis without stiffness, and twists in cosine waves nπ √(GJ/ρJ).
#[test]
fn a_beam_between_two_hinges_turns_freely_about_its_axis() {
    let pi = std::f64::consts::PI;
    for elements in [10, 100, 800] {
        let mut model = Model::new();
        let ends = beam(&mut model, "beam", [0.0; 3], [1.0, 0.0, 0.0], elements);
        for (k, end) in ends.into_iter().enumerate() {
            let name = format!("end {k}");
            model
                .join(
                    &name,
                    Kind::Spherical,
                    [Part::Ground, end],
                    Vec3([k as f64, 0.0, 0.0]),
                    (Vec3(Z), None),
                )
                .unwrap();
        }
        let mut system = Multibody::new(model).unwrap();
        let (mut s, found) = found(&mut system, 6);
        let waves = |n: f64, stiffness: f64| n * n * pi * pi * stiffness.sqrt();
        let mut expected: Vec<f64> =
            [1.0, 2.0].iter().flat_map(|n| [waves(*n, 1.0), waves(*n, 1.7)]).collect();
        expected.extend([0.0, waves(3.0, 1.0)]);
        expected.sort_by(f64::total_cmp);
        // Rounding takes n⁴ε of the lowest square.
        compare(&found, &expected, 1, if elements == 10 { 2e-3 } else { 1e-4 });
        let stable = stable_equilibrium(&mut system, &mut s, &mut |_| ControlFlow::Continue(())).unwrap();
        assert!(stable.stability.is_some_and(|found| found.is_stable()) && stable.left.is_none());
    }
}

/// Six rigid motions, and the frequencies of the free beam (4.730, 7.853)² √EI.
#[test]
fn a_free_beam_has_six_motions_without_stiffness() {
    let mut model = Model::new();
    beam(&mut model, "beam", [0.3, -0.2, 0.5], [0.9, 0.6, 0.5], 40);
    let mut system = Multibody::new(model).unwrap();
    let (_, found) = found(&mut system, 9);
    let (one, two) = (22.373285448061, 61.672822869);
    let expected = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, one, one * 1.7_f64.sqrt(), two];
    compare(&found, &expected, 6, 1e-5);
}

/// Four flexible bars that close a loop, hinged at their ends: it folds, and its bars bend and twist. The band alone, without the
/// rows that close the loop, is a chain that folds three times over.
#[test]
fn a_four_bar_of_beams_folds_without_stiffness() {
    let corners = [[0.0, 0.0, 0.0], [0.1, 0.6, 0.0], [1.0, 0.9, 0.0], [1.1, 0.0, 0.0]];
    let mut model = Model::new();
    let bars: Vec<[Part; 2]> =
        (0..3).map(|k| beam(&mut model, &format!("bar {k}"), corners[k], corners[k + 1], 6)).collect();
    let pairs = [
        [Part::Ground, bars[0][0]],
        [bars[0][1], bars[1][0]],
        [bars[1][1], bars[2][0]],
        [bars[2][1], Part::Ground],
    ];
    for (k, pair) in pairs.into_iter().enumerate() {
        model.join(&format!("hinge {k}"), Kind::Revolute, pair, Vec3(corners[k]), (Vec3(Z), None)).unwrap();
    }
    let mut system = Multibody::new(model).unwrap();
    let (s, found) = found(&mut system, 8);
    compare(&found, &dense(&mut system, &s), 1, 1e-6);
}

/// An arch of two bars with three hinges is stiff, but each of the two ways to cut its loop leaves a double pendulum; a truss of
/// nine bars leaves a chain with nine hinges, more than pivots of a band can be replaced.
#[test]
fn an_arch_and_a_truss_are_stiff_though_their_bands_are_mechanisms() {
    let (mut arch, mut truss) = (Model::new(), Model::new());
    let corners = [[0.0, 0.0, 0.0], [0.5, 0.7, 0.0], [1.2, 0.0, 0.0]];
    let bars = [0, 1].map(|k| beam(&mut arch, &format!("bar {k}"), corners[k], corners[k + 1], 6));
    let pairs = [[Part::Ground, bars[0][0]], [bars[0][1], bars[1][0]], [bars[1][1], Part::Ground]];
    for (k, pair) in pairs.into_iter().enumerate() {
        arch.join(&format!("hinge {k}"), Kind::Revolute, pair, Vec3(corners[k]), (Vec3(Z), None)).unwrap();
    }
    // Zigzag of joints 0 … 5, lower ones even; bars from each to the next two.
    let place = |k: usize| [0.5 * k as f64, if k.is_multiple_of(2) { 0.0 } else { 0.8 }, 0.0];
    let mut at: Vec<Vec<Part>> = vec![Vec::new(); 6];
    for (a, b) in [(0, 1), (1, 2), (0, 2), (2, 3), (1, 3), (3, 4), (2, 4), (4, 5), (3, 5)] {
        let ends = beam(&mut truss, &format!("bar {a}{b}"), place(a), place(b), 2);
        at[a].push(ends[0]);
        at[b].push(ends[1]);
    }
    at[0].insert(0, Part::Ground);
    at[4].insert(0, Part::Ground);
    for (k, parts) in at.iter().enumerate() {
        for (l, part) in parts.iter().enumerate().skip(1) {
            let name = format!("hinge {k}{l}");
            truss.join(&name, Kind::Revolute, [parts[0], *part], Vec3(place(k)), (Vec3(Z), None)).unwrap();
        }
    }
    for model in [arch, truss.drop_redundant_rows()] {
        let mut system = Multibody::new(model).unwrap();
        let (s, found) = found(&mut system, 8);
        compare(&found, &dense(&mut system, &s), 0, 1e-6);
    }
}

/// A round shaft between hinges whirls with ω₀ ± Ω in axes that rotate with it, and turns freely.
#[test]
fn a_shaft_that_turns_freely_whirls_forward_and_backward() {
    let mut model = Model::new();
    let section = Properties::principal([1e5, 0.7, 1.0, 1.0], 1.0, [1e-9, 0.0, 0.0]);
    let root = Station { position: Vec3([0.0; 3]), tangent: Vec3(Z), normal: Vec3([1.0, 0.0, 0.0]) };
    let built = Beam::straight(root, 1.0, 16, section).unwrap();
    let beam = model.beam(Flexible::new("shaft", built));
    for (k, node) in [0, 16].into_iter().enumerate() {
        let parts = [Part::Ground, Part::Section { beam, node }];
        model
            .join(&format!("end {k}"), Kind::Spherical, parts, Vec3([0.0, 0.0, k as f64]), (Vec3(Z), None))
            .unwrap();
    }
    let mut system = Rotating::new(Multibody::new(model).unwrap(), Axis::new([0.0; 3], Z).unwrap());
    let mut s = system.initial();
    flexion::analysis::rotation::rotate_stably(&mut system, &mut s, 0.0, 3.0).unwrap();
    let found = modes(&mut system, &s, 5, &[]).unwrap();
    let whirl = |n: f64| n * n * std::f64::consts::PI.powi(2);
    let expected = [0.0, whirl(1.0) - 3.0, whirl(1.0) + 3.0, whirl(2.0) - 3.0, whirl(2.0) + 3.0];
    for (mode, expected) in found.modes.iter().zip(expected) {
        assert!(
            (mode.frequency() - expected).abs() <= 1e-4 * expected,
            "{} for {expected}",
            mode.frequency()
        );
        assert!(mode.damping_ratio().abs() < 1e-9);
    }
}
