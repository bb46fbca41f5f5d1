//! Equilibrium in the system's own frame: r(t, q, 0, 0, λ) = 0 and g(t, q) = 0 by Newton's method with continuation.
//!
//! ```text
//! ⎡ K  −Gᵀ⎤ ⎡Δq⎤     ⎡ r ⎤
//! ⎣ G   0 ⎦ ⎣Δλ⎦ = − ⎣ g ⎦      q ← q ⊞ Δq
//! ```
//!
//! K has the multipliers in it, which alone stiffen a mechanism: every level begins with those that balance the most of
//! the loads.

use super::joints;
use crate::linalg::Matrix;
use crate::system::{Parameter, State, System, Weights};

/// Newton iterations allowed at one load level.
const ITERATIONS: u32 = 25;
/// Smallest part of the load by which continuation goes on.
const SMALLEST: f64 = 1e-6;
/// Scaled size of an increment at which the iteration has converged.
const TOLERANCE: f64 = 1e-11;

/// Why there is no equilibrium.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "no equilibrium found at t = {time:.4} s beyond {percent:.3} % of the load: {what} (largest in the {worst})",
    percent = 100.0 * reached
)]
pub struct NoEquilibrium {
    /// Time at which it was sought \[s\].
    pub time: f64,
    /// Part of the load up to which there was equilibrium.
    pub reached: f64,
    /// What happened beyond.
    pub what: String,
    /// Label of the worst unknown.
    pub worst: String,
}

/// What an equilibrium took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effort {
    /// Load levels.
    pub levels: u32,
    /// Newton iterations.
    pub iterations: u32,
}

/// Brings `state` to equilibrium at its time, beginning from the configuration it has: q and λ such that
/// r(t, q, 0, 0, λ) = 0, and g = 0 of joints and closed contacts. On return v = a = 0.
///
/// The equilibrium is followed from the given configuration as the loads grow: with r_s the residual under the part s
/// of them and r₀ that without loads in the given configuration, the levels r_s(q) = (1 − s) r₀ are solved for s from
/// 0 to 1, the increment of s growing and shrinking as Newton's method converges. A follower or a couple rotates with
/// its section all the way.
///
/// # Errors
/// [`NoEquilibrium`] when the iteration breaks down however small the increments are: a limit point, or a
/// model that has no equilibrium there.
pub fn equilibrium(system: &mut dyn System, state: &mut State) -> Result<Effort, NoEquilibrium> {
    let (n, m) = (state.v.len(), state.lambda.len());
    state.v.fill(0.0);
    state.a.fill(0.0);
    let scale = system.scales().to_vec();
    let mut tangent = Matrix::new(&system.structure(1));
    let (mut start, mut r) = (vec![0.0; n], vec![0.0; n + m]);
    apply(system, 0.0);
    system.residual(state, &mut start);
    let mut good = state.clone();
    let mut moved = state.q.clone();
    let (mut reached, mut part): (f64, f64) = (0.0, 1.0);
    let mut effort = Effort::default();
    while reached < 1.0 {
        let level = (reached + part).min(1.0);
        apply(system, level);
        joints::balance(system, state);
        let mut failure = None;
        let mut last = f64::INFINITY;
        for iteration in 0..=ITERATIONS {
            let (motion, rows) = r.split_at_mut(n);
            system.residual(state, motion);
            joints::positions(system, state, rows);
            for (r, start) in motion.iter_mut().zip(&start) {
                *r -= (1.0 - level) * start;
            }
            if r.iter().all(|r| *r == 0.0) {
                break;
            }
            system.tangent(state, Weights::new(0.0, 0.0, 1.0), &mut tangent);
            joints::add(system, state, n, &mut tangent);
            if let Err(singular) = tangent.factor() {
                failure = Some((singular.to_string(), singular.index));
                break;
            }
            tangent.solve(&mut r);
            r.iter_mut().for_each(|r| *r = -*r);
            let (r, multipliers) = r.split_at(n);
            state.lambda.iter_mut().zip(multipliers).for_each(|(lambda, x)| *lambda += x);
            system.retract(&state.q, r, &mut moved);
            state.q.copy_from_slice(&moved);
            effort.iterations += 1;
            let (worst, size) = largest(r, &scale);
            // Converged, or as far as rounding lets it come.
            if size <= TOLERANCE || (size < 1e-7 && size > 0.3 * last) {
                break;
            }
            if !(size < 1e3) || iteration == ITERATIONS {
                failure = Some((format!("Newton's method does not converge (increment {size:.1e})"), worst));
                break;
            }
            last = size;
        }
        if failure.is_none()
            && let Err(what) = system.admissible(state)
        {
            failure = Some((what, 0));
        }
        match failure {
            None => {
                effort.levels += 1;
                reached = level;
                part *= 2.0;
                good.copy_from(state);
            }
            Some((what, worst)) => {
                state.copy_from(&good);
                part = 0.25 * (level - reached);
                if part < SMALLEST {
                    apply(system, 1.0);
                    let worst = system.unknown(worst);
                    return Err(NoEquilibrium { time: state.t, reached, what, worst });
                }
            }
        }
    }
    Ok(effort)
}

/// Applies a part of the loads; a model without loads has none to follow.
fn apply(system: &mut dyn System, part: f64) {
    let _ = system.set(Parameter::LoadFactor, part);
}

/// Index and scaled size of the largest increment (a NaN counts as largest).
fn largest(d: &[f64], scale: &[f64]) -> (usize, f64) {
    let mut worst = (0, 0.0);
    for (i, (d, scale)) in d.iter().zip(scale).enumerate() {
        let size = (d / scale).abs();
        if !(size <= worst.1) {
            worst = (i, size);
        }
    }
    worst
}
