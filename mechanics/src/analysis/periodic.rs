//! Periodic motion of what rotates steadily under loads whose direction is fixed in space, as gravity across the axis.
//!
//! Seen from the frame, such loads rotate. About the equilibrium q₀ without them, whose matrices are M, C and K, the residual of their
//! system is r(φ) where the frame stands at the azimuth φ = Ωt, and to first order the motion q₀ ⊞ δ follows
//!
//! ```text
//! M δ̈ + C δ̇ + K δ = −r(Ωt),     r(φ) = r₁ cos φ + r₂ sin φ
//! ```
//!
//! with the rows of joints in K. Its periodic part is
//!
//! ```text
//! δ = Re Q e^{iΩt},     (K + iΩ C − Ω² M) Q = −(r₁ − i r₂)
//! ```
//!
//! A motion that begins with δ(0) = Re Q and δ̇(0) = Re iΩQ repeats itself with every revolution: the deflection under the loads, enlarged by
//! their frequency, with the velocity by which it follows them. Of a nonlinear model it is that under the forces K δ
//! ([superposition](super::superposition)).

use super::stiffness::matrices;
use super::superposition::{NoSuperposition, displace};
use crate::linalg::Matrix;
use crate::system::{Parameter, State, System};
use num_complex::Complex64;
use std::f64::consts::{FRAC_PI_2, PI};

/// Part of the loads by which they may differ from their first harmonic.
const HARMONIC: f64 = 1e-6;

/// The motion of a periodic start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Periodic {
    /// Largest amplitude of an unknown, over its scale: what is left out is about the square of it.
    pub amplitude: f64,
}

/// Why there is no periodic motion to begin with.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoPeriodicMotion {
    /// A spring to the ground, for one.
    #[error("what acts changes with the angle otherwise than a force of a fixed direction")]
    NotHarmonic,
    /// The size of a load, for one.
    #[error("a load of a fixed direction changes its size within a revolution")]
    Changing,
    /// Near a resonance, for one.
    #[error("no periodic motion was found near the steady rotation")]
    Far,
}

impl From<NoSuperposition> for NoPeriodicMotion {
    fn from(_: NoSuperposition) -> NoPeriodicMotion {
        NoPeriodicMotion::Far
    }
}

/// Moves `state`, the equilibrium of `mean` in a frame that rotates at `speed` [rad/s], onto the periodic motion of `loaded`, the same system
/// with loads that keep their direction in space across the axis. Velocities are added to those that it has.
///
/// Valid to first order in these loads, which do not change otherwise.
///
/// # Errors
/// [`NoPeriodicMotion`]; the state is then as it was.
pub fn circulate(
    [mean, loaded]: [&mut dyn System; 2],
    state: &mut State,
    speed: f64,
) -> Result<Periodic, NoPeriodicMotion> {
    let n = state.v.len();
    let mut still = state.clone();
    still.v.fill(0.0);
    still.a.fill(0.0);
    // What the equilibrium leaves.
    let mut left = vec![0.0; n];
    mean.residual(&still, &mut left);
    let mut residual_at = |azimuth: f64| {
        let mut r = vec![0.0; n];
        let set = loaded.set(Parameter::Azimuth, azimuth);
        loaded.residual(&still, &mut r);
        r.iter_mut().zip(&left).for_each(|(r, left)| *r -= left);
        set.map(|()| r).map_err(|_| NoPeriodicMotion::NotHarmonic)
    };
    let (quarter, half) = (residual_at(FRAC_PI_2)?, residual_at(PI)?);
    let (opposite, here) = (residual_at(-FRAC_PI_2)?, residual_at(0.0)?);
    let pairs = || [[&here, &half], [&quarter, &opposite]];
    let largest = |x: f64, y: f64| x.max(y.abs());
    let of = |r: fn(f64, f64) -> f64| {
        let all = pairs().into_iter().flat_map(|[a, b]| a.iter().zip(b).map(move |(a, b)| r(*a, *b)));
        all.fold(0.0, largest)
    };
    // Opposite loads have opposite residuals.
    if !(of(|a, b| a + b) <= HARMONIC * of(|a, b| a - b)) {
        return Err(NoPeriodicMotion::NotHarmonic);
    }
    let [cosine, sine] =
        pairs().map(|[a, b]| a.iter().zip(b).map(|(a, b)| 0.5 * (a - b)).collect::<Vec<_>>());
    let ([mass, damping, stiffness], multipliers) = matrices(mean, &still);
    let mut impedance: Matrix<Complex64> = Matrix::new(&mean.structure(1));
    let weights = [Complex64::from(-speed * speed), Complex64::new(0.0, speed), Complex64::ONE];
    impedance.combine([&mass, &damping, &stiffness], weights);
    let mut moved: Vec<Complex64> = cosine.iter().zip(&sine).map(|(c, s)| Complex64::new(-c, *s)).collect();
    // The rows of joints do not change with the azimuth.
    moved.resize(n + multipliers, Complex64::ZERO);
    impedance.factor_equilibrated().map_err(|_| NoPeriodicMotion::Far)?;
    impedance.solve(&mut moved);
    let amplitude =
        moved[..n].iter().zip(mean.scales()).fold(0.0, |most: f64, (x, scale)| most.max(x.norm() / scale));
    let displacement: Vec<f64> = moved[..n].iter().map(|moved| moved.re).collect();
    let velocity: Vec<f64> = moved[..n].iter().map(|moved| -speed * moved.im).collect();
    let mut found = state.clone();
    displace(mean, &mut found, &displacement, &velocity)?;
    state.copy_from(&found);
    Ok(Periodic { amplitude })
}
