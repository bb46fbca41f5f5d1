//! Modes of vibration superposed on an equilibrium, as the state with which a motion begins.
//!
//! About an equilibrium every free vibration of small amplitude is a sum of [`modes`],
//!
//! ```text
//! δq(t) = Re Σ c x e^{λt}
//! ```
//!
//! With x scaled so that the displacement of the tip is one, the displacement A and the velocity V of that
//! quantity in a mode at t = 0 are Re c = A and Re λc = V, so that
//!
//! ```text
//! c = A + i (A Re λ − V) / Im λ
//! ```
//!
//! Of a nonlinear model a displacement δ along the modes would stretch what only bends: to second order in δ a beam is
//! shortened. With K that of the equilibrium q₀, the state is the equilibrium q under the forces K δ that hold δ in the linear
//! model, and its velocities those at which these forces change with δ̇:
//!
//! ```text
//! r(q) − r(q₀) = K δ,     K(q) v = K δ̇
//! ```

use super::joints;
use super::modes::{Mode, NoModes, modes};
use super::stability::stability;
use super::stiffness::{mass, matrices};
use crate::system::{Direction, Frame, State, System};
use num_complex::Complex64;

/// Step of the differences of displacements, in scales of the unknowns.
const DIFFERENCE: f64 = 1e-5;
/// A mode that moves the tip by less than this part of its largest unknown (both over their scales)
/// cannot be given by it.
const STILL: f64 = 1e-6;
/// Iterations to a displaced shape, and the last increment in scales of the unknowns.
const ITERATIONS: usize = 30;
/// See [`ITERATIONS`].
const SETTLED: f64 = 1e-10;
/// Largest distance from the equilibrium of a hub that is free, as acceleration over ω².
const UNBALANCED: f64 = 1e-9;

/// What one mode does at t = 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Vibration {
    /// Displacement A of the tip, its component that the mode moves most.
    pub displacement: f64,
    /// Its velocity V.
    pub velocity: f64,
}

impl Vibration {
    fn is_still(&self) -> bool {
        self.displacement == 0.0 && self.velocity == 0.0
    }
}

/// Why modes cannot be superposed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoSuperposition {
    /// There are no such modes.
    #[error(transparent)]
    Modes(#[from] NoModes),
    /// There are fewer modes that vibrate, or are rigid motions, than were given something.
    #[error("{asked} modes were asked for, but the unknowns have {found}")]
    Few {
        /// Modes that were asked for.
        asked: usize,
        /// Modes that there are.
        found: usize,
    },
    /// A mode is a rigid motion.
    #[error(
        "mode {0} is the rigid motion of the free hub, which does not vibrate: give it 0, and the hub its angle and \
         speed in `hub.motion`"
    )]
    Rigid(usize),
    /// A mode does not vibrate.
    #[error(
        "mode {number} does not vibrate, it {what} like exp({rate:.6} t): displacement and velocity cannot both be \
         chosen; give it 0, or {advice}"
    )]
    Aperiodic {
        /// Number of the mode, from 1.
        number: usize,
        /// Its rate λ [1/s].
        rate: f64,
        /// What it does.
        what: &'static str,
        /// What to change.
        advice: &'static str,
    },
    /// The tip does not give the amplitude.
    #[error(
        "mode {0} does not move the tip in the frame of the hub, whose amplitude is prescribed; give it 0"
    )]
    Still(usize),
    /// The amplitudes are too large.
    #[error(
        "the amplitudes are so large that no displaced shape is found near that of the modes; give smaller ones"
    )]
    Large,
    /// The free hub is not in equilibrium.
    #[error(
        "the free hub is not in equilibrium where it begins, so that there is nothing to vibrate about: a torque of \
         {torque:.6e} N·m is left and accelerates it by {acceleration:.6e} rad/s²; begin at an angle at which torques, \
         loads and restraints balance, and without what drives or brakes the hub"
    )]
    Unbalanced {
        /// Torque that is left [N·m].
        torque: f64,
        /// Acceleration of the hub by it, the beam rigid [rad/s²].
        acceleration: f64,
    },
}

/// Adds vibrations to `state`, the equilibrium of `system` as it stands: one for each of the modes of smallest |λ|, in
/// their order. The displacement of a [`Vibration`] is that component of the displacement of the tip, at `length` \[m\]
/// from the root and seen from the root section, which the mode moves most. Returns the modes.
///
/// Valid for vibrations that are small: of a nonlinear model the state is right to second order in them.
///
/// # Errors
/// [`NoSuperposition`], when there are not so many modes, or a mode that is given something does not vibrate.
pub fn superpose(
    system: &mut dyn System,
    state: &mut State,
    vibrations: &[Vibration],
    length: f64,
) -> Result<Vec<Mode>, NoSuperposition> {
    let found = modes(system, state, vibrations.len(), &[])?.modes;
    if found.len() < vibrations.len() {
        return Err(NoSuperposition::Few { asked: vibrations.len(), found: found.len() });
    }
    balanced(system, state, &found)?;
    let n = state.v.len();
    let (mut displacement, mut velocity) = (vec![0.0; n], vec![0.0; n]);
    let moving = vibrations.iter().zip(&found).enumerate().filter(|(_, (wanted, _))| !wanted.is_still());
    for (index, (wanted, mode)) in moving {
        let number = index + 1;
        let rate = mode.eigenvalue;
        if rate == Complex64::ZERO {
            return Err(NoSuperposition::Rigid(number));
        }
        if rate.im == 0.0 {
            // About a saddle such modes come in pairs, ±λ.
            let stable = rate.re < 0.0 && stability(system, state).is_ok_and(|found| found.divergent == 0);
            let what = if rate.re < 0.0 { "decays" } else { "grows" };
            let advice = if stable {
                "lower the damping"
            } else {
                "begin about an equilibrium that is stable: this one is not"
            };
            return Err(NoSuperposition::Aperiodic { number, rate: rate.re, what, advice });
        }
        let unit =
            Complex64::ONE / moved(system, state, mode, length).ok_or(NoSuperposition::Still(number))?;
        let amplitude =
            Complex64::new(wanted.displacement, (wanted.displacement * rate.re - wanted.velocity) / rate.im);
        for (i, x) in mode.vector.iter().enumerate() {
            let part = amplitude * unit * x;
            displacement[i] += part.re;
            velocity[i] += (part * rate).re;
        }
    }
    displace(system, state, &displacement, &velocity)?;
    Ok(found)
}

/// Moves an equilibrium to that under the forces of a linear displacement, with the velocities that belong to it.
pub(super) fn displace(
    system: &mut dyn System,
    state: &mut State,
    displacement: &[f64],
    velocity: &[f64],
) -> Result<(), NoSuperposition> {
    let (n, from) = (state.v.len(), state.clone());
    system.retract(&from.q, displacement, &mut state.q);
    if !system.is_affine() {
        let free: Vec<usize> = (0..n).filter(|&i| system.direction(i) == Direction::Hub).collect();
        let stiffness = matrices(system, &from).0[2].clone();
        let forces = |d: &[f64]| {
            let (mut d, mut f) = (d.to_vec(), vec![0.0; stiffness.order()]);
            d.resize(stiffness.order(), 0.0);
            stiffness.multiply(&d, &mut f);
            f
        };
        let (target, change) = (forces(displacement), forces(velocity));
        system.hold(true);
        let result = settle(system, &from, state, (&target, &free));
        let mut rate = change;
        if result.is_ok() {
            // What is free to rotate keeps the velocity of the linear motion.
            free.iter().for_each(|&i| rate[i] = velocity[i]);
            let mut tangent = matrices(system, state).0[2].clone();
            tangent.factor_equilibrated().map_err(|_| NoSuperposition::Large)?;
            tangent.solve(&mut rate);
        }
        system.hold(false);
        result?;
        state.v.iter_mut().zip(&rate).for_each(|(v, rate)| *v += rate);
        return Ok(());
    }
    state.v.iter_mut().zip(velocity).for_each(|(v, rate)| *v += rate);
    Ok(())
}

/// Solves r(q) − r(q₀) = f by Newton's method; the unknowns `free` stay as they are.
fn settle(
    system: &mut dyn System,
    from: &State,
    state: &mut State,
    (forces, free): (&[f64], &[usize]),
) -> Result<(), NoSuperposition> {
    let n = state.v.len();
    let scale: Vec<f64> = system.scales().to_vec();
    let (mut start, mut r) = (vec![0.0; n], vec![0.0; forces.len()]);
    system.residual(from, &mut start);
    for _ in 0..ITERATIONS {
        system.residual(state, &mut r[..n]);
        r.iter_mut().zip(forces).for_each(|(r, f)| *r -= f);
        r.iter_mut().zip(&start).for_each(|(r, start)| *r -= start);
        free.iter().for_each(|&i| r[i] = 0.0);
        joints::positions(system, state, &mut r[n..]);
        let mut tangent = matrices(system, state).0[2].clone();
        tangent.factor_equilibrated().map_err(|_| NoSuperposition::Large)?;
        tangent.solve(&mut r);
        r.iter_mut().for_each(|x| *x = -*x);
        let at = state.q.clone();
        system.retract(&at, &r[..n], &mut state.q);
        state.lambda.iter_mut().zip(&r[n..]).for_each(|(lambda, x)| *lambda += x);
        let size = r.iter().zip(&scale).map(|(x, s)| (x / s).abs()).fold(0.0, f64::max);
        if size < SETTLED {
            return Ok(());
        }
    }
    Err(NoSuperposition::Large)
}

/// How far the component of the tip's displacement that the mode moves most moves with it: `None` if none does.
fn moved(system: &mut dyn System, state: &State, mode: &Mode, length: f64) -> Option<Complex64> {
    let scale: Vec<f64> = system.scales().to_vec();
    let largest = mode.vector.iter().zip(&scale).map(|(x, s)| x.norm() / s).fold(0.0, f64::max);
    let step = DIFFERENCE / largest;
    let mut tip = |direction: &[f64]| {
        let mut at = state.clone();
        system.retract(&state.q, direction, &mut at.q);
        let mut frames = [Frame::default(); 2];
        system.frames(system.drawn(), &at, &[0.0, length], &mut frames);
        let [root, tip] = frames;
        let apart: [f64; 3] = std::array::from_fn(|i| tip.position[i] - root.position[i]);
        // Components along the axes of the root section, which are the columns of its rotation.
        [0, 1, 2].map(|j| (0..3).map(|i| root.rotation[i][j] * apart[i]).sum::<f64>())
    };
    let mut out = [Complex64::ZERO; 3];
    for unit in [Complex64::ONE, Complex64::I] {
        let part = |x: &Complex64| if unit == Complex64::ONE { x.re } else { x.im };
        let ahead: Vec<f64> = mode.vector.iter().map(|x| step * part(x)).collect();
        let behind: Vec<f64> = ahead.iter().map(|d| -d).collect();
        let (ahead, behind) = (tip(&ahead), tip(&behind));
        for (out, (ahead, behind)) in out.iter_mut().zip(ahead.into_iter().zip(behind)) {
            *out += unit * (0.5 * (ahead - behind) / step);
        }
    }
    // Displacements are measured by the scale of those of the beam.
    let size = scale.iter().copied().fold(0.0, f64::max);
    let best = out.into_iter().fold(Complex64::ZERO, |best, u| if u.norm() > best.norm() { u } else { best });
    (best.norm() > STILL * largest * size).then_some(best)
}

/// Whether the equation of a free hub holds too: with the hub held, an equilibrium says nothing about it.
fn balanced(system: &mut dyn System, state: &State, found: &[Mode]) -> Result<(), NoSuperposition> {
    let Some(hub) = (0..state.v.len()).find(|&i| system.direction(i) == Direction::Hub) else {
        return Ok(());
    };
    let mut still = state.clone();
    still.a.fill(0.0);
    let mut r = vec![0.0; state.v.len()];
    system.residual(&still, &mut r);
    let inertia = mass(system, state).get(hub, hub);
    let (torque, acceleration) = (-r[hub], -r[hub] / inertia);
    let frequencies = found.iter().map(|mode| mode.eigenvalue.norm()).filter(|size| *size > 0.0);
    let lowest = frequencies.fold(f64::INFINITY, f64::min);
    if acceleration.abs() <= UNBALANCED * lowest * lowest {
        return Ok(());
    }
    Err(NoSuperposition::Unbalanced { torque, acceleration })
}
