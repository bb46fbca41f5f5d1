//! What the coupled scheme remembers and works with.

use crate::integrator::{Checkpoint, NotResumed};
use crate::linalg::Matrix;
use crate::system::Dynamics;

/// Memory of the coupled scheme.
#[derive(Debug, Default)]
pub(super) struct Coupled {
    /// M with the joints.
    pub(super) mass: Option<Matrix>,
    /// Auxiliary acceleration aₙ, and aₙ₊₁ of the attempt.
    pub(super) a: Vec<f64>,
    pub(super) a_next: Vec<f64>,
    /// Size of the step accepted last, and of the attempt.
    pub(super) spacing: [f64; 2],
    /// Increment of the position in the attempt, and in the step accepted.
    pub(super) d: Vec<f64>,
    pub(super) accepted: Vec<f64>,
    /// ϖ and Λ.
    pub(super) velocity: Vec<f64>,
    pub(super) impulses: Vec<f64>,
    /// r₁, and λ before an iteration.
    pub(super) residual: Vec<f64>,
    pub(super) before: Vec<f64>,
    /// Right-hand side with M.
    pub(super) rhs: Vec<f64>,
}

impl Coupled {
    pub(super) fn start(&mut self, system: &dyn Dynamics) {
        let size = system.size();
        let (n, m) = (size.v, size.lambda);
        self.mass = Some(Matrix::new(&system.structure(1)));
        for list in [&mut self.a, &mut self.a_next, &mut self.d, &mut self.accepted, &mut self.velocity] {
            *list = vec![0.0; n];
        }
        (self.impulses, self.before) = (vec![0.0; m], vec![0.0; m]);
        (self.residual, self.rhs) = (vec![0.0; n], vec![0.0; n + m]);
    }

    pub(super) fn accept(&mut self) {
        std::mem::swap(&mut self.a, &mut self.a_next);
        std::mem::swap(&mut self.d, &mut self.accepted);
        self.spacing[0] = self.spacing[1];
    }

    /// Begins anew with the accelerations `a`.
    pub(super) fn restart(&mut self, a: &[f64]) {
        self.a.copy_from_slice(a);
        self.spacing = [0.0; 2];
    }

    pub(super) fn save(&self, out: &mut Checkpoint) {
        out.put("smooth.auxiliary", &self.a);
        out.put("smooth.spacing", &self.spacing[..1]);
    }

    pub(super) fn resume(&mut self, from: &Checkpoint) -> Result<(), NotResumed> {
        from.fill("smooth.auxiliary", &mut self.a)?;
        from.fill("smooth.spacing", &mut self.spacing[..1])
    }
}
