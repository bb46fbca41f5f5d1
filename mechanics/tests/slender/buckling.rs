//! Lateral buckling of a strip by a force at its tip: P L²/√(EI₂ GJ) = 4.0126 for a strip that does not bend edgewise
//! (Prandtl 1899; the first zero z of J₋₁/₄ gives 4z/2).

use super::newton::cantilever;
use flexion::linalg::{Matrix, Vec3};
use flexion::multibody::slender::{Load, Properties};

/// The load, over √(EI₂ GJ)/L², at which the tangent loses definiteness, with EI₃ = `ratio` EI₂.
fn critical(elements: usize, ratio: f64) -> f64 {
    let (bending, torsion) = (1.0, 0.6_f64);
    let section = Properties::principal([1e6 * ratio, torsion, bending, ratio], 1.0, [1.0; 3]);
    let unstable = |force: f64| {
        let mut statics = cantilever(1.0, elements, section);
        statics.loads.push((elements, Load::Force(Vec3([0.0, force * torsion.sqrt(), 0.0]))));
        statics.load(2);
        let matrix = statics.tangent(1.0);
        let n = statics.fixed.len();
        let mut symmetric = Matrix::new(&flexion::linalg::Structure::dense(n));
        for i in 0..n {
            for j in 0..n {
                symmetric.add(i, j, 0.5 * (matrix.get(i, j) + matrix.get(j, i)));
            }
        }
        determinant_is_negative(&symmetric)
    };
    let (mut low, mut high) = (2.0, 6.0);
    assert!(!unstable(low) && unstable(high));
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if unstable(middle) { high = middle } else { low = middle }
    }
    low
}

/// Whether a symmetric matrix has a negative eigenvalue.
fn determinant_is_negative(matrix: &Matrix) -> bool {
    let n = matrix.order();
    let dense = nalgebra::DMatrix::from_fn(n, n, |i, j| matrix.get(i, j));
    dense.cholesky().is_none()
}

#[test]
fn a_strip_buckles_sideways_at_prandtls_load() {
    let found = [1e2, 1e3, 1e4].map(|ratio| critical(16, ratio));
    // The strip that bends edgewise buckles later, in proportion to EI₂/EI₃.
    let excess = [found[0] - found[1], found[1] - found[2]];
    assert!(excess[0] > 9.0 * excess[1] && excess[0] < 12.0 * excess[1], "{found:?}");
    let limit = found[2] - excess[1] / 9.0;
    assert!((limit - 4.012_599_3).abs() < 1e-4, "{limit} from {found:?}");
}
