//! How the sections rotate from one state to another, so that a kept tangent can be used further on.

use crate::linalg::Scalar;

/// Rotations R of pairs of unknowns, which are the components of a vector in the plane. To an integrator it is opaque:
/// it applies R and Rᵀ.
#[derive(Clone, Debug, Default)]
pub struct Corotation {
    pairs: Vec<Pair>,
}

/// A pair of unknowns and the cosine and sine of its rotation.
#[derive(Clone, Copy, Debug)]
struct Pair {
    unknowns: [usize; 2],
    cos: f64,
    sin: f64,
}

impl Corotation {
    /// No rotations, with memory for those of `n` unknowns.
    pub fn with_capacity(n: usize) -> Corotation {
        Corotation { pairs: Vec::with_capacity(n / 2) }
    }

    /// Removes all rotations.
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Adds the rotation of the vector with the components `unknowns` by the angle with this cosine and sine.
    #[inline]
    pub fn push(&mut self, unknowns: [usize; 2], cos: f64, sin: f64) {
        self.pairs.push(Pair { unknowns, cos, sin });
    }

    /// x ← R x
    pub fn rotate<T: Scalar>(&self, x: &mut [T]) {
        for &Pair { unknowns: [i, j], cos, sin } in &self.pairs {
            (x[i], x[j]) = (x[i].times(cos) - x[j].times(sin), x[i].times(sin) + x[j].times(cos));
        }
    }

    /// x ← Rᵀ x
    pub fn rotate_back<T: Scalar>(&self, x: &mut [T]) {
        for &Pair { unknowns: [i, j], cos, sin } in &self.pairs {
            (x[i], x[j]) = (x[i].times(cos) + x[j].times(sin), x[j].times(cos) - x[i].times(sin));
        }
    }
}
