//! Points of a model that may touch obstacles.

use super::obstacle::Obstacle;
use crate::linalg::{Mat3, Matrix, Vec3};
use crate::system::{Frame, State};

/// Gap at which a contact touches, over the length of the system.
pub(crate) const TOUCHING: f64 = 1e-13;

/// Motion of a point, in the axes in which its obstacle is given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointMotion {
    /// Position p \[m\].
    pub position: Vec3,
    /// Velocity ṗ \[m/s\].
    pub velocity: Vec3,
    /// Acceleration p̈ \[m/s²\].
    pub acceleration: Vec3,
    /// Part of ṗ that a prescribed motion of the model makes, ∂p/∂t \[m/s\].
    pub prescribed: Vec3,
    /// Radius R of the ball about the point that touches in its place \[m\].
    pub radius: f64,
    /// Angular velocity ω of the ball [rad/s].
    pub spin: Vec3,
    /// ω̇ [rad/s²]
    pub spin_rate: Vec3,
    /// The curve of which it is the point nearest to the obstacle, unless it is a fixed point or at an end.
    pub curve: Option<Curve>,
}

/// A curve p(s) of material points at the point nearest to an obstacle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curve {
    /// p′
    pub slope: Vec3,
    /// p″ \[1/m\]
    pub curvature: Vec3,
    /// ṗ′ \[1/s\]
    pub slope_rate: Vec3,
}

/// Derivatives of a point's motion by one unknown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Variation {
    /// Number of the velocity vⱼ.
    pub unknown: usize,
    /// ∂p/∂qⱼ = ∂ṗ/∂vⱼ
    pub position: Vec3,
    /// ∂ṗ/∂qⱼ \[1/s\]
    pub velocity: Vec3,
    /// ∂ω/∂vⱼ of a ball.
    pub rotation: Vec3,
    /// ∂ω/∂qⱼ of a ball.
    pub spin: Vec3,
    /// ∂p′/∂qⱼ on a curve.
    pub slope: Vec3,
}

/// A model with points that may touch obstacles. Points are numbered.
pub trait Points {
    /// Places point `k` at `s`, of which the others then speak: if it is any point of a curve, at that nearest to `obstacle`.
    fn approach(&mut self, _k: usize, _s: &State, _obstacle: &dyn Obstacle) {}

    /// Arc length \[m\] of point `k` on its curve, as [`Points::approach`] found it; `None` for a fixed point.
    fn station(&self, _k: usize) -> Option<f64> {
        None
    }

    /// Position of point `k` and radius of the ball about it \[m\], where they cost less than its [motion](Points::motion): they say
    /// whether it may touch.
    fn position(&mut self, _k: usize, _s: &State) -> Option<(Vec3, f64)> {
        None
    }

    /// Motion of point `k`.
    fn motion(&mut self, k: usize, s: &State) -> PointMotion;

    /// Writes the derivatives of the motion of point `k` that do not vanish.
    fn variations(&mut self, k: usize, s: &State, out: &mut Vec<Variation>);

    /// out += w ∂(∂p/∂qᵀ F + ∂ω/∂vᵀ M)/∂q, with the components of F and M, of which M counts for a ball alone, held fixed.
    fn add_curvature(&mut self, k: usize, s: &State, wrench: [Vec3; 2], w: f64, out: &mut Matrix);

    /// Whether point `k` moves by unknowns that are neighbours in the tangent: ∂p/∂q ∂p/∂qᵀ then fits its structure.
    fn is_local(&self, k: usize) -> bool;

    /// Directions in which its points slide on an obstacle: 1 in the plane, 2 in space.
    fn directions(&self) -> usize {
        1
    }

    /// Frame, in space, in which the motion of point `k` is given, once it has [approached](Points::approach): that of space, or of what
    /// its obstacle is fixed to.
    fn frame(&mut self, _k: usize, _s: &State) -> Frame {
        Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY }
    }

    /// Forgets the forces on all points.
    fn begin_forces(&mut self) {}

    /// Notes a force on point `k`, for the reactions that the model records.
    fn add_force(&mut self, _k: usize, _s: &State, _force: Vec3) {}
}
