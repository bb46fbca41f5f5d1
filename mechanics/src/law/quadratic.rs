//! Drag in proportion to the square of the velocity.

use super::{ForceLaw, Place, Response};
use crate::linalg::vector::inner;

/// Quadratic drag in a fluid at rest, the same in all directions:
///
/// ```text
/// f = −c |ṙ| ṙ,   D_v = −c (|ṙ| 1 + ṙ ṙᵀ/|ṙ|),   D_v = 0 at ṙ = 0
/// ```
///
/// c = ½ ρ C_D d [kg/m²] for a fluid of density ρ [kg/m³] and a beam of width d \[m\] with the drag coefficient C_D. f and D_v are
/// continuous through ṙ = 0. Motion along the axis is resisted as motion across it.
///
/// Source: J. R. Morison et al., *J. Pet. Technol.* 2 (1950) 149–154, doi:10.2118/950149-G, its term of drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraticDrag {
    /// Coefficient c [kg/m²], ≥ 0.
    pub coefficient: f64,
}

impl ForceLaw for QuadraticDrag {
    fn response(&self, place: &Place) -> Response {
        let (c, v) = (self.coefficient, place.velocity);
        let speed = inner(v, v).sqrt();
        if speed == 0.0 {
            return Response::default();
        }
        let row =
            |i: usize| std::array::from_fn(|j| -c * (if i == j { speed } else { 0.0 } + v[i] * v[j] / speed));
        Response {
            force: v.map(|v| -c * speed * v),
            by_velocity: std::array::from_fn(row),
            ..Response::default()
        }
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn dissipates(&self) -> bool {
        true
    }
}
