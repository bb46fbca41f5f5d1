//! A small disturbance of the velocities of a state: whether a motion is stable shows in what becomes of it.

use super::joints;
use super::stiffness::mass;
use crate::linalg::{Matrix, Singular};
use crate::system::{State, System, Weights};

/// Adds to v a disturbance δ in all directions that joints and the [plane](crate::system::Dynamics::across) of a system allow, with
/// the kinetic energy `energy` \[J\]:
///
/// ```text
/// (M + τ² K) δ = M ρ + Gᵀ Λ,     G δ = 0
/// ```
///
/// ρ are velocities of all unknowns at random, the same in every run: no symmetry of a system survives them. τ = `time` \[s\]
/// takes the waves away that are faster than that. `false` where δ has no energy.
///
/// # Errors
/// [`Singular`] where M + τ² K is, with the joints.
pub fn disturb(system: &mut dyn System, state: &mut State, energy: f64, time: f64) -> Result<bool, Singular> {
    let n = state.v.len();
    let mut random: Vec<f64> =
        system.scales().iter().enumerate().map(|(i, scale)| random(i) * scale).collect();
    system.across().into_iter().for_each(|i| random[i] = 0.0);
    let mut x = vec![0.0; n + state.lambda.len()];
    mass(system, state).multiply(&random, &mut x[..n]);
    let mut matrix = Matrix::new(&system.structure(1));
    system.tangent(state, Weights::new(1.0, 0.0, time * time), &mut matrix);
    joints::add(system, state, n, &mut matrix);
    matrix.factor_equilibrated()?;
    matrix.solve(&mut x);
    // The part of the kinetic energy that is quadratic in the velocities.
    let mut kinetic = |sign: f64| {
        let v = x[..n].iter().map(|x| sign * x).collect();
        system.energy(&State { v, ..state.clone() }).kinetic
    };
    let own = 0.5 * (kinetic(1.0) + kinetic(-1.0)) - kinetic(0.0);
    let factor = (energy / own).sqrt();
    if !(own > 0.0 && factor.is_finite()) {
        return Ok(false);
    }
    state.v.iter_mut().zip(&x).for_each(|(v, x)| *v += factor * x);
    Ok(true)
}

/// A number between −1 and 1 that belongs to `i` (the mixing function of SplitMix64: Steele, Lea & Flood 2014, doi
/// 10.1145/2714064.2660195).
fn random(i: usize) -> f64 {
    let mut z = (i as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (z ^ (z >> 31)) as i64 as f64 / i64::MAX as f64
}
