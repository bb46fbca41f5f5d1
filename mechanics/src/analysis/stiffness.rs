//! The stiffness ∂r/∂q of a system in wide numbers.

use crate::linalg::eigen::widen;
use crate::linalg::{Double, Matrix};
use crate::system::{State, System, Weights};

/// K = ∂r/∂q at a state, and whether it was summed from the [terms](System::stiffness_terms) of the strains, so
/// that no digit of its lowest eigenvalues is lost however fine the mesh.
pub fn stiffness(system: &mut dyn System, state: &State) -> (Matrix<Double>, bool) {
    let structure = system.structure(0);
    let mut rest = Matrix::new(&structure);
    let mut wide = Matrix::<Double>::new(&structure);
    let in_terms = system.stiffness_terms(state, &mut rest, &mut |index, b, w| {
        for (&i, bi) in index.iter().zip(b) {
            let row = Double::from(*bi) * w.into();
            for (&j, bj) in index.iter().zip(b) {
                wide.add(i, j, row * (*bj).into());
            }
        }
    });
    if !in_terms {
        let rest = tangent(system, state, Weights::new(0.0, 0.0, 1.0));
        return (widen(&rest, &structure), false);
    }
    crate::linalg::eigen::each(&rest, |i, j| wide.add(i, j, rest.get(i, j).into()));
    (wide, true)
}

/// A tangent of the system.
pub fn tangent(system: &mut dyn System, state: &State, weights: Weights<'_>) -> Matrix {
    let mut matrix = Matrix::new(&system.structure(0));
    system.tangent(state, weights, &mut matrix);
    matrix
}
