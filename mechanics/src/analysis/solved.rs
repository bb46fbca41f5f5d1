//! What is known of one speed of a Campbell diagram.

use super::modes::Mode;
use super::stability::Stability;
use crate::system::State;
use num_complex::Complex64;

/// Modes at one speed, with what the next one begins with.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    pub speed: f64,
    /// The modes, ascending.
    pub modes: Vec<Mode>,
    /// M x of each mode.
    pub massed: Vec<Vec<Complex64>>,
    /// G x of each mode, with the skew part G of the damping; empty without one.
    pub gyroscopic: Vec<Vec<Complex64>>,
    pub equilibrium: State,
    pub stability: Stability,
    /// Number of directions in which the symmetric part of K is negative.
    pub negative: usize,
}
