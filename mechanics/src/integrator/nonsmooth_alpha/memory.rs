//! What the coupled scheme remembers and works with.

use crate::integrator::acceleration::Accelerations;
use crate::integrator::auxiliary::Auxiliary;
use crate::integrator::{Counters, GeneralizedAlpha, StepError};
use crate::linalg::Matrix;
use crate::system::{Dynamics, RowWeights, State};

/// Memory of the coupled scheme.
#[derive(Debug)]
pub(super) struct Coupled {
    pub(super) auxiliary: Auxiliary,
    pub(super) accelerations: Accelerations,
    /// M with the joints.
    pub(super) mass: Matrix,
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
    pub(super) fn new(system: &mut dyn Dynamics, state: &State, method: &GeneralizedAlpha) -> Coupled {
        let size = system.size();
        let (n, m) = (size.v, size.lambda);
        Coupled {
            auxiliary: method.auxiliary(n),
            accelerations: Accelerations::new(system, state, RowWeights::ACCELERATION),
            mass: Matrix::new(&system.structure(1)),
            d: vec![0.0; n],
            accepted: vec![0.0; n],
            velocity: vec![0.0; n],
            impulses: vec![0.0; m],
            residual: vec![0.0; n],
            before: vec![0.0; m],
            rhs: vec![0.0; n + m],
        }
    }

    pub(super) fn accept(&mut self, from: &State, smooth: &State, to: &State) {
        self.auxiliary.accept(&from.a, &smooth.a, &to.v);
        std::mem::swap(&mut self.d, &mut self.accepted);
    }

    pub(super) fn restart(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        self.accelerations.complete(system, state, (state.t, 0.0), counters)?;
        self.auxiliary.restart(&state.a, &state.v);
        Ok(())
    }
}
