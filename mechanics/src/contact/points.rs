//! Points of a model that may touch obstacles.

use crate::linalg::Matrix;
use crate::system::State;

/// Motion of a point, in the axes in which its obstacle is given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointMotion {
    /// Position p \[m\].
    pub position: [f64; 3],
    /// Velocity ṗ \[m/s\].
    pub velocity: [f64; 3],
    /// Acceleration p̈ \[m/s²\].
    pub acceleration: [f64; 3],
    /// Part of ṗ that a prescribed motion of the model makes, ∂p/∂t \[m/s\].
    pub prescribed: [f64; 3],
}

/// Derivatives of a point's motion by one unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variation {
    /// Number of the velocity vⱼ.
    pub unknown: usize,
    /// ∂p/∂qⱼ = ∂ṗ/∂vⱼ
    pub position: [f64; 3],
    /// ∂ṗ/∂qⱼ \[1/s\]
    pub velocity: [f64; 3],
}

/// A model with points that may touch obstacles. Points are numbered.
pub trait Points {
    /// Motion of point `k`.
    fn motion(&mut self, k: usize, s: &State) -> PointMotion;

    /// Writes the derivatives of the motion of point `k` that do not vanish.
    fn variations(&mut self, k: usize, s: &State, out: &mut Vec<Variation>);

    /// out += w ∂²(F·p)/∂q², with the components `force` of F.
    fn add_curvature(&mut self, k: usize, s: &State, force: [f64; 3], w: f64, out: &mut Matrix);

    /// Whether point `k` moves by unknowns that are neighbours in the tangent: ∂p/∂q ∂p/∂qᵀ then fits its structure.
    fn is_local(&self, k: usize) -> bool;

    /// Directions in which its points slide on an obstacle: 1 in the plane, 2 in space.
    fn directions(&self) -> usize {
        1
    }

    /// Forgets the forces on all points.
    fn begin_forces(&mut self) {}

    /// Notes a force on point `k`, for the reactions that the model records.
    fn add_force(&mut self, _k: usize, _s: &State, _force: [f64; 3]) {}
}
