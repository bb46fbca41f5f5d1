//! Modes of rotating beams with strong damping against a dense solution of all eigenvalues.

use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate_stably;
use flexion::linalg::{Mat3, Matrix, Vec3};
use flexion::multibody::slender::{self, Properties, Station};
use flexion::multibody::{self, Axis, Flexible, Kind, Model, Multibody, Part, Rotating, shear};
use flexion::section::Matrices;
use flexion::system::{Dynamics, Frame, State, System, Weights};
use nalgebra::{DMatrix, Schur};
use num_complex::Complex64;

/// A square bar of aluminium of 5 m by 4 cm on a hub of 0.5 m, in a frame that rotates about z.
fn bar(elements: usize, with_shear: bool, viscosity: f64) -> Rotating {
    let (modulus, side, density) = (70e9, 0.04_f64, 2700.0);
    let (area, second) = (side * side, side.powi(4) / 12.0);
    let [axial, bending, torsion] = [modulus * area, modulus * second, 0.3 * modulus * 2.0 * second];
    let inertia = [2.0, 1.0, 1.0].map(|part| part * density * second);
    let beam: multibody::Beam = if with_shear {
        let ends: Vec<f64> = (0..=elements).map(|i| 5.0 * i as f64 / elements as f64).collect();
        let frame = |s: f64| Frame { position: Vec3([0.5 + s, 0.0, 0.0]), rotation: Mat3::IDENTITY };
        let stiffness = [axial, 0.3 * axial, 0.3 * axial, torsion, bending, bending];
        let section = |_: f64| Matrices::principal(stiffness, density * area, inertia);
        shear::Beam::new(&ends, frame, section).unwrap().into()
    } else {
        let root = Station {
            position: Vec3([0.5, 0.0, 0.0]),
            tangent: Vec3([1.0, 0.0, 0.0]),
            normal: Vec3([0.0, 1.0, 0.0]),
        };
        let section = Properties::principal([axial, torsion, bending, bending], density * area, inertia);
        slender::Beam::straight(root, 5.0, elements, section).unwrap().into()
    };
    let mut model = Model::new();
    let beam = model.beam(Flexible::new("bar", beam).viscous(viscosity));
    let root = [Part::Ground, Part::Section { beam, node: 0 }];
    model.join("root", Kind::Fixed, root, Vec3([0.5, 0.0, 0.0]), (Vec3([0.0, 0.0, 1.0]), None)).unwrap();
    Rotating::new(Multibody::new(model).unwrap(), Axis::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap())
}

/// The eigenvalues of (λ² M + λ C + K) x = 0 in the motions that the joints allow, largest 1/λ first: those of the dense matrix of (x, y/s) ↦
/// (−K⁻¹(C x + s M y/s), x/s) with y = λ x.
fn dense(system: &mut dyn System, state: &State) -> Vec<Complex64> {
    let n = state.v.len();
    let mut of = |a, v, q| {
        let mut matrix = Matrix::new(&system.structure(0));
        system.tangent(state, Weights::new(a, v, q), &mut matrix);
        DMatrix::from_fn(n, n, |i, j| matrix.get(i, j))
    };
    let [mass, damping, stiffness] = [of(1.0, 0.0, 0.0), of(0.0, 1.0, 0.0), of(0.0, 0.0, 1.0)];
    let mut rows = DMatrix::<f64>::zeros(system.rows().len(), n);
    system.jacobian(state, &mut |row, columns, values| {
        columns.iter().zip(values).for_each(|(j, g)| rows[(row, *j)] += g);
    });
    // A basis of the motions without Gx.
    let projection = rows.transpose() * &rows;
    let eigen = projection.symmetric_eigen();
    let allowed: Vec<usize> = (0..n).filter(|k| eigen.eigenvalues[*k].abs() < 1e-9).collect();
    let basis = DMatrix::from_fn(n, allowed.len(), |i, k| eigen.eigenvectors[(i, allowed[k])]);
    let [mass, damping, stiffness] = [mass, damping, stiffness].map(|of| basis.transpose() * of * &basis);
    let (m, scale) = (allowed.len(), 10.0);
    let inverse = stiffness.lu();
    let (c, b) = (inverse.solve(&damping).unwrap(), inverse.solve(&mass).unwrap());
    let mut a = DMatrix::zeros(2 * m, 2 * m);
    a.view_mut((0, 0), (m, m)).copy_from(&-c);
    a.view_mut((0, m), (m, m)).copy_from(&(-scale * b));
    (0..m).for_each(|i| a[(m + i, i)] = 1.0 / scale);
    // With 1 added there are no zeros among the eigenvalues; what is rounding of the whole matrix ends the iteration.
    a += DMatrix::identity(2 * m, 2 * m);
    let rounding = f64::EPSILON * a.norm();
    let schur =
        [1.0, 10.0, 100.0, 1e3].iter().find_map(|k| Schur::try_new(a.clone(), k * rounding, 3000)).unwrap();
    let eigenvalues = schur.complex_eigenvalues();
    let mut all: Vec<Complex64> = eigenvalues.iter().map(|x| Complex64::new(x.re - 1.0, x.im)).collect();
    all.sort_by(|a, b| b.norm().total_cmp(&a.norm()));
    all.iter().filter(|x| x.norm() > 0.0).map(|x| 1.0 / x).collect()
}

/// Modes are those of the dense solution, and none that vibrates is missing up to the last, from hardly any damping to overdamped motions alone.
#[test]
fn modes_of_a_strongly_damped_rotating_beam_are_those_of_a_dense_solution() {
    for with_shear in [false, true] {
        for viscosity in [1e-4, 4e-3, 0.02, 0.1, 1.0, 100.0] {
            let mut system = bar(4, with_shear, viscosity);
            let mut s = system.initial();
            rotate_stably(&mut system, &mut s, 0.0, 3.0).unwrap();
            let found = modes(&mut system, &s, 6, &[]).unwrap();
            // A damping in proportion to the stiffness leaves no vibration above 2/η; zeros of the matrix for what has no mass are beyond.
            let vibrates = |x: &Complex64| x.im > 1e-6 * x.norm() && x.norm() < 4.0 / viscosity;
            let vibrations: Vec<Complex64> = dense(&mut system, &s).into_iter().filter(vibrates).collect();
            let what = format!("shear {with_shear}, {viscosity} s");
            let expected = vibrations.len().min(6);
            assert_eq!(found.modes.len(), expected, "{what}: {:?}", vibrations);
            for (mode, expected) in found.modes.iter().zip(&vibrations) {
                let off = (mode.eigenvalue - expected).norm() / expected.norm();
                assert!(off < 1e-6, "{what}: {} for {expected}", mode.eigenvalue);
            }
        }
    }
}

/// A finer mesh has more motions that decay alike, and the same vibrations.
#[test]
fn a_finer_mesh_of_a_strongly_damped_beam_has_the_same_vibrations() {
    let found = |elements: usize| {
        let mut system = bar(elements, true, 0.02);
        let mut s = system.initial();
        rotate_stably(&mut system, &mut s, 0.0, 3.0).unwrap();
        modes(&mut system, &s, 6, &[]).unwrap().modes
    };
    let [coarse, fine] = [4, 10].map(found);
    assert_eq!((coarse.len(), fine.len()), (4, 4));
    for (a, b) in coarse.iter().zip(&fine) {
        assert!((a.eigenvalue - b.eigenvalue).norm() < 1e-3 * b.eigenvalue.norm());
    }
}
