//! Natural frequencies of a clamped beam against closed forms.

use super::newton::cantilever;
use flexion::multibody::slender::Properties;
use flexion::system::Weights;

const LENGTH: f64 = 2.0;
const STIFFNESS: [f64; 4] = [3e5, 7.0, 12.0, 30.0];
const MASS: f64 = 1.5;
const POLAR: f64 = 0.02;

/// The angular frequencies, ascending.
fn frequencies(elements: usize) -> Vec<f64> {
    let statics = cantilever(LENGTH, elements, Properties::principal(STIFFNESS, MASS, [POLAR, 0.0, 0.0]));
    let n = statics.beam.velocities();
    let free: Vec<usize> = (0..n).filter(|i| !statics.fixed[*i]).collect();
    let rest = vec![0.0; n];
    let matrix = |w: Weights<'_>| {
        let mut full = nalgebra::DMatrix::zeros(n, n);
        statics.beam.add_tangent(&statics.q, &rest, &rest, &w, |at, block| {
            (0..15).for_each(|i| (0..15).for_each(|j| full[(at + i, at + j)] += block[i][j]));
        });
        nalgebra::DMatrix::from_fn(free.len(), free.len(), |i, j| full[(free[i], free[j])])
    };
    let (k, m) = (matrix(Weights::new(0.0, 0.0, 1.0)), matrix(Weights::new(1.0, 0.0, 0.0)));
    let l = m.cholesky().unwrap().l();
    let inner = l.solve_lower_triangular(&k).unwrap();
    let c = l.solve_lower_triangular(&inner.transpose()).unwrap();
    let symmetric: nalgebra::DMatrix<f64> = 0.5 * (&c + c.transpose());
    let mut squares: Vec<f64> = symmetric.symmetric_eigenvalues().iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    squares.into_iter().map(f64::sqrt).collect()
}

/// The closed forms, ascending: bending in two planes, torsion, extension.
fn exact() -> Vec<f64> {
    // cos x cosh x = −1
    let roots = [1.875_104_068_711_961, 4.694_091_132_974_175, 7.854_757_438_237_613, 10.995_540_734_875_467];
    let mut all = Vec::new();
    for stiffness in [STIFFNESS[2], STIFFNESS[3]] {
        all.extend(roots.map(|x| (x / LENGTH).powi(2) * (stiffness / MASS).sqrt()));
    }
    for wave in [STIFFNESS[1] / POLAR, STIFFNESS[0] / MASS] {
        all.extend((0..4).map(|k| (f64::from(k) + 0.5) * std::f64::consts::PI / LENGTH * wave.sqrt()));
    }
    all.sort_by(f64::total_cmp);
    all
}

#[test]
fn frequencies_of_bending_torsion_and_extension_are_those_of_the_closed_forms() {
    let error = |n: usize| -> Vec<f64> {
        let pairs = frequencies(n).into_iter().zip(exact()).take(9);
        pairs.map(|(found, exact)| (found / exact - 1.0).abs()).collect()
    };
    let (coarse, fine) = (error(12), error(24));
    for (coarse, fine) in coarse.iter().zip(&fine) {
        assert!(*fine < 1e-5, "{fine}");
        // Order 4, to rounding.
        assert!(*fine < coarse / 12.0 || *fine < 1e-9, "{coarse} {fine}");
    }
}
