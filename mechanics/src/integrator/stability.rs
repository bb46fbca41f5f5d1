//! Stability limits of explicit methods from the largest frequency of a system.

use super::rows::Rows;
use super::{StepError, failure};
use crate::linalg::Matrix;
use crate::linalg::eigen::{Operator, largest};
use crate::system::{Dynamics, State, Weights};

/// The limit is put below the exact one by this much, for the frequency is found from below.
const MARGIN: f64 = 1.005;

/// Relative error estimate of ω² at which the search stops.
const TOLERANCE: f64 = 1e-3;

/// The largest stable step of an explicit method on an undamped system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityLimit {
    /// Method as in a case file.
    pub method: &'static str,
    /// Time at which the frequency was found \[s\].
    pub time: f64,
    /// Largest angular frequency ω of the system [rad/s].
    pub frequency: f64,
    /// Largest stable step, c/(1.005 ω) with the method's constant c \[s\].
    pub step: f64,
}

impl StabilityLimit {
    /// The limit of a method that is stable up to hω = `limit`, at `state`.
    ///
    /// # Errors
    /// As [`largest_frequency`].
    pub fn find(
        method: &'static str,
        limit: f64,
        system: &mut dyn Dynamics,
        state: &State,
    ) -> Result<StabilityLimit, StepError> {
        let frequency = largest_frequency(system, state)?;
        let step = if frequency > 0.0 { limit / (MARGIN * frequency) } else { f64::INFINITY };
        Ok(StabilityLimit { method, time: state.t, frequency, step })
    }

    /// Refuses a step beyond the limit.
    ///
    /// # Errors
    /// [`StepError::Unstable`].
    pub fn check(&self, step: f64) -> Result<(), StepError> {
        if step <= self.step {
            return Ok(());
        }
        let StabilityLimit { method, time, frequency, step: limit } = *self;
        Err(StepError::Unstable { method, time, step, limit, frequency })
    }
}

/// Largest angular frequency ω [rad/s] of small undamped vibrations about `state`:
/// ω² = max xᵀK x / xᵀM x over the x that satisfy the constraints, G x = 0.
///
/// The largest eigenvalue of x ↦ M⁻¹K x in a Krylov space in the inner product of M: see [`largest`]. K and M are
/// the tangent at `state`; K is taken as symmetric, damping and gyroscopic terms are left out. Returns 0
/// when no direction is stiff. Allocates; meant for the start of a run.
///
/// # Errors
/// [`StepError::Singular`] for a singular mass matrix, [`StepError::NotFinite`] for a tangent that is not
/// finite.
///
/// Source: Parlett, *The Symmetric Eigenvalue Problem*, chapter 13 (doi 10.1137/1.9781611971163).
pub fn largest_frequency(system: &mut dyn Dynamics, state: &State) -> Result<f64, StepError> {
    let mut operator = Explicit::new(system, state)?;
    let worst = || system.unknown(0);
    let square = largest(&mut operator, TOLERANCE).map_err(|_| StepError::NotFinite {
        time: state.t,
        step: 0.0,
        worst: worst(),
    })?;
    Ok(square.max(0.0).sqrt())
}

/// x ↦ M⁻¹K x with the dual M x at one state, on the directions that the constraints allow.
struct Explicit {
    velocities: usize,
    factored: Matrix,
    mass: Matrix,
    stiffness: Matrix,
    padded: Vec<f64>,
    image: Vec<f64>,
}

impl Explicit {
    fn new(system: &mut dyn Dynamics, state: &State) -> Result<Explicit, StepError> {
        let structure = system.structure(1);
        let weights = |a, q| Weights::new(a, 0.0, q);
        let mut matrices = [0, 1].map(|_| Matrix::new(&structure));
        for (matrix, (a, q)) in matrices.iter_mut().zip([(1.0, 0.0), (0.0, 1.0)]) {
            system.tangent(state, weights(a, q), matrix);
        }
        let [mass, stiffness] = matrices;
        let mut factored = mass.clone();
        Rows::new(system, state).add_border(system, state, state.v.len(), &mut factored);
        factored.factor().map_err(|e| failure::singular(system, state.t, 0.0, e))?;
        let order = state.v.len() + state.lambda.len();
        let (padded, image) = (vec![0.0; order], vec![0.0; order]);
        Ok(Explicit { velocities: state.v.len(), factored, mass, stiffness, padded, image })
    }
}

impl Operator for Explicit {
    fn dimension(&self) -> usize {
        self.velocities
    }

    fn apply(&mut self, z: &[f64], _dual: &[f64], w: &mut [f64], dual_w: &mut [f64]) {
        self.padded[..self.velocities].copy_from_slice(z);
        self.stiffness.multiply(&self.padded, &mut self.image);
        self.image[self.velocities..].fill(0.0);
        self.factored.solve(&mut self.image);
        w.copy_from_slice(&self.image[..self.velocities]);
        self.dual(w, dual_w);
    }

    fn dual(&mut self, z: &[f64], dual: &mut [f64]) {
        self.padded[..self.velocities].copy_from_slice(z);
        self.mass.multiply(&self.padded, &mut self.image);
        dual.copy_from_slice(&self.image[..self.velocities]);
    }
}
