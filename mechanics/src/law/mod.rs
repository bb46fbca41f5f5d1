//! Force laws: the force on a place by its time, position and velocity, with the derivatives that tangents need.
//!
//! A law knows no model. Per length of a beam it acts in the plane ([`hub_beam::load::LineLaw`](crate::hub_beam::load::LineLaw)) and in
//! space ([`multibody::LineLaw`](crate::multibody::LineLaw)) alike:
//!
//! ```text
//! f = f(t, r, ṙ) [N/m],   D_r = ∂f/∂r,   D_v = ∂f/∂ṙ
//! ```
//!
//! with r and ṙ the place of the axis and its velocity in inertial axes. A load that is linear in f(t) alone is faster as one of the
//! others, which are reduced to their moments over the shapes when a system is built.

mod linear;
mod quadratic;

pub use linear::LinearDrag;
pub use quadratic::QuadraticDrag;

use crate::linalg::vector::inner;

/// Where and how fast a place is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Place {
    /// Time t \[s\].
    pub time: f64,
    /// Position r, inertial axes \[m\].
    pub position: [f64; 3],
    /// Velocity ṙ, inertial axes [m/s].
    pub velocity: [f64; 3],
}

/// Force on a place and its derivatives, inertial axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// Force f \[N\], per length [N/m].
    pub force: [f64; 3],
    /// D_r; its entry (i, j) is ∂fᵢ/∂rⱼ.
    pub by_position: [[f64; 3]; 3],
    /// D_v; its entry (i, j) is ∂fᵢ/∂ṙⱼ.
    pub by_velocity: [[f64; 3]; 3],
}

impl Response {
    /// Power f·ṙ on a place.
    pub fn power(&self, place: &Place) -> f64 {
        inner(self.force, place.velocity)
    }
}

/// A force law. The derivatives must be those of the force: Newton's method converges by them.
pub trait ForceLaw: std::fmt::Debug + Send + Sync {
    /// Force and derivatives at a place; continuous in position and velocity.
    fn response(&self, place: &Place) -> Response;

    /// The same at many places: one virtual call for all of them.
    fn responses(&self, places: &[Place], out: &mut [Response]) {
        for (place, out) in places.iter().zip(out) {
            *out = self.response(place);
        }
    }

    /// Whether force and position, velocity are joined linearly, f = f₀(t) + D_r(t) r + D_v(t) ṙ: with D_r and D_v of no state, one
    /// iteration of Newton's method solves a linear model.
    fn is_affine(&self) -> bool {
        false
    }

    /// Whether it depends on the velocity alone, and turns with it: f(Q ṙ) = Q f(ṙ) for every rotation Q. Seen from a frame that
    /// rotates steadily it is then steady.
    fn is_isotropic(&self) -> bool {
        false
    }

    /// Whether its power −f·ṙ ≥ 0 is a loss; otherwise f·ṙ is work of the loads.
    fn dissipates(&self) -> bool {
        false
    }
}
