//! Stability limits of explicit methods from the largest frequency of a system.

use super::rows::Rows;
use super::{StepError, failure};
use crate::linalg::Matrix;
use crate::system::{Dynamics, State, Weights};

/// The limit is put below the exact one by this much, for the frequency is found from below.
const MARGIN: f64 = 1.005;

/// Relative change of the largest eigenvalue over [`SETTLED`] iterations at which the search stops.
const CHANGE: f64 = 1e-4;
const SETTLED: usize = 4;

/// Largest number of search vectors.
const MOST_VECTORS: usize = 200;

/// The largest stable step of an explicit method on an undamped system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityLimit {
    /// Method as in a case file.
    pub method: &'static str,
    /// Time at which the frequency was found [s].
    pub time: f64,
    /// Largest angular frequency ω of the system [rad/s].
    pub frequency: f64,
    /// Largest stable step, c/(1.005 ω) with the method's constant c [s].
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
/// Lanczos' method in the inner product of M with full reorthogonalisation, from a fixed start vector;
/// it stops when the largest Ritz value has settled to 1e-4, which it approaches from below. K and M are
/// the tangent at `state`; K is taken as symmetric, damping and gyroscopic terms are left out. Returns 0
/// when no direction is stiff. Allocates; meant for the start of a run.
///
/// # Errors
/// [`StepError::Singular`] for a singular mass matrix, [`StepError::NotFinite`] for a tangent that is not
/// finite.
///
/// Source: Parlett, *The Symmetric Eigenvalue Problem*, chapter 13 (doi 10.1137/1.9781611971163).
pub fn largest_frequency(system: &mut dyn Dynamics, state: &State) -> Result<f64, StepError> {
    let n = state.v.len();
    let mut pencil = Pencil::new(system, state)?;
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut images: Vec<Vec<f64>> = Vec::new();
    let (mut diagonal, mut off): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut estimates: Vec<f64> = Vec::new();
    let mut w = pencil.project(&start_vector(n));
    let mut largest = 0.0;
    for _ in 0..n.min(MOST_VECTORS) {
        let mut image = pencil.mass_times(&w);
        let norm = dot(&w, &image).max(0.0).sqrt();
        // The new direction is rounding error: the invariant subspace is exhausted.
        let reference = diagonal.iter().fold(largest, |m: f64, a: &f64| m.max(a.abs()));
        if !diagonal.is_empty() && norm <= 1e-12 * reference || norm == 0.0 {
            break;
        }
        if !diagonal.is_empty() {
            off.push(norm);
        }
        scale(&mut w, 1.0 / norm);
        scale(&mut image, 1.0 / norm);
        let v = std::mem::take(&mut w);
        let stiff = pencil.stiffness_times(&v);
        diagonal.push(dot(&v, &stiff));
        w = pencil.solve(&stiff);
        basis.push(v);
        images.push(image);
        for _ in 0..2 {
            for (v, image) in basis.iter().zip(&images) {
                let share = dot(&w, image);
                for (w, v) in w.iter_mut().zip(v) {
                    *w -= share * v;
                }
            }
        }
        largest = largest_eigenvalue(&diagonal, &off);
        if !largest.is_finite() || failure::first_bad(&w).is_some() {
            let index = failure::first_bad(&w).unwrap_or(0);
            return Err(StepError::NotFinite {
                time: state.t,
                step: 0.0,
                worst: system.unknown(index),
            });
        }
        estimates.push(largest);
        if let Some(index) = estimates.len().checked_sub(SETTLED + 1)
            && largest - estimates[index] <= CHANGE * largest.abs()
        {
            break;
        }
    }
    Ok(largest.max(0.0).sqrt())
}

/// Mass and stiffness at one state, on the directions the constraints allow.
struct Pencil {
    velocities: usize,
    factored: Matrix,
    mass: Matrix,
    stiffness: Matrix,
    padded: Vec<f64>,
    image: Vec<f64>,
}

impl Pencil {
    fn new(system: &mut dyn Dynamics, state: &State) -> Result<Pencil, StepError> {
        let structure = system.structure(1);
        let weights = |a, q| Weights::new(a, 0.0, q);
        let mut matrices = [0, 1, 2].map(|_| Matrix::new(&structure));
        for (matrix, (a, q)) in matrices.iter_mut().zip([(1.0, 0.0), (1.0, 0.0), (0.0, 1.0)]) {
            system.tangent(state, weights(a, q), matrix);
        }
        let [mut factored, mass, stiffness] = matrices;
        Rows::new(system, state).add_border(system, state, state.v.len(), &mut factored);
        factored.factor().map_err(|e| failure::singular(system, state.t, 0.0, e))?;
        let order = state.v.len() + state.lambda.len();
        let (padded, image) = (vec![0.0; order], vec![0.0; order]);
        Ok(Pencil { velocities: state.v.len(), factored, mass, stiffness, padded, image })
    }

    fn mass_times(&mut self, x: &[f64]) -> Vec<f64> {
        self.padded[..self.velocities].copy_from_slice(x);
        self.mass.multiply(&self.padded, &mut self.image);
        self.image[..self.velocities].to_vec()
    }

    fn stiffness_times(&mut self, x: &[f64]) -> Vec<f64> {
        self.padded[..self.velocities].copy_from_slice(x);
        self.stiffness.multiply(&self.padded, &mut self.image);
        self.image[..self.velocities].to_vec()
    }

    /// The acceleration under the force `f`.
    fn solve(&mut self, f: &[f64]) -> Vec<f64> {
        self.image.fill(0.0);
        self.image[..self.velocities].copy_from_slice(f);
        self.factored.solve(&mut self.image);
        self.image[..self.velocities].to_vec()
    }

    /// The part of `x` that satisfies the constraints.
    fn project(&mut self, x: &[f64]) -> Vec<f64> {
        let force = self.mass_times(x);
        self.solve(&force)
    }
}

/// A fixed vector without structure: a linear congruential sequence in (−½, ½).
fn start_vector(n: usize) -> Vec<f64> {
    let mut seed: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut next = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    (0..n).map(|_| next()).collect()
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn scale(x: &mut [f64], factor: f64) {
    for x in x {
        *x *= factor;
    }
}

/// Largest eigenvalue of a symmetric tridiagonal matrix, by bisection on Sturm sequences.
fn largest_eigenvalue(diagonal: &[f64], off: &[f64]) -> f64 {
    let side = |i: usize| off.get(i).map_or(0.0, |b| b.abs());
    let radius = |i: usize| side(i) + if i > 0 { side(i - 1) } else { 0.0 };
    let mut high = f64::NEG_INFINITY;
    let mut low = f64::NEG_INFINITY;
    for (i, a) in diagonal.iter().enumerate() {
        high = high.max(a + radius(i));
        low = low.max(*a);
    }
    if !high.is_finite() {
        return f64::NAN;
    }
    // All eigenvalues lie below x exactly if every pivot of T − x is negative.
    let all_below = |x: f64| {
        let mut pivot = -1.0;
        for (i, a) in diagonal.iter().enumerate() {
            let b = if i > 0 { off[i - 1] } else { 0.0 };
            pivot = a - x - b * b / pivot;
            if pivot >= 0.0 {
                return false;
            }
        }
        true
    };
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if all_below(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}
