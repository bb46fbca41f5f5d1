//! Forms xᵀKx of the stiffness of a system, the strains of its beams summed one by one.
//!
//! Where a beam is slender its stiffness in shear or along its axis is so much larger than that in bending that the rounding of an assembled K hides
//! the lowest frequencies. The strains of a motion are differences of what is next to each other, and lose nothing by it.

use super::system::Multibody;
use crate::linalg::Matrix;
use crate::system::{Dynamics, State, StiffnessForm, Weights};

impl Multibody {
    /// ∂r/∂q without the stiffness of strains.
    pub(super) fn unstrained_stiffness(&mut self, s: &State) -> Matrix {
        let mut rest = Matrix::new(&self.structure(0));
        self.assemble(s, Weights::new(0.0, 0.0, 1.0), false, &mut rest);
        rest
    }

    /// The forms, of a stiffness that is `rest` without its strains.
    pub(super) fn forms(&self, s: &State, rest: &Matrix, vectors: &[Vec<f64>]) -> Vec<StiffnessForm> {
        let mut forms = StiffnessForm::of(rest, vectors);
        for (form, x) in forms.iter_mut().zip(vectors) {
            for (of, &[q, v]) in self.constants.model.beams.iter().zip(&self.constants.beams) {
                form.value += of.beam.strain_form(&s.q[q..], &x[v..]);
            }
        }
        forms
    }
}
