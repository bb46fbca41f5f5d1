//! Drag in proportion to the velocity.

use super::{ForceLaw, Place, Response};

/// Linear drag f = −c ṙ in all directions, as of a slow motion in a viscous fluid at rest: c [N·s/m²] per length, ≥ 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearDrag {
    /// Coefficient c [N·s/m²].
    pub coefficient: f64,
}

impl ForceLaw for LinearDrag {
    fn response(&self, place: &Place) -> Response {
        let c = self.coefficient;
        let diagonal = |i: usize| std::array::from_fn(|j| if i == j { -c } else { 0.0 });
        Response {
            force: place.velocity.map(|v| -c * v),
            by_velocity: std::array::from_fn(diagonal),
            ..Response::default()
        }
    }

    fn is_affine(&self) -> bool {
        true
    }

    fn is_isotropic(&self) -> bool {
        true
    }

    fn dissipates(&self) -> bool {
        true
    }
}
