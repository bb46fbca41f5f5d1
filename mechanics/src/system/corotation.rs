//! How the sections rotate from one state to another, so that a kept tangent can be used further on.

use crate::linalg::Scalar;

/// Rotations R of pairs and triples of unknowns, which are the components of a vector in the plane or in space. To an
/// integrator it is opaque: it applies R and Rᵀ.
#[derive(Clone, Debug, Default)]
pub struct Corotation {
    pairs: Vec<Pair>,
    triples: Vec<Triple>,
}

/// A pair of unknowns and the cosine and sine of its rotation.
#[derive(Clone, Copy, Debug)]
struct Pair {
    unknowns: [usize; 2],
    cos: f64,
    sin: f64,
}

/// Three unknowns in a row, from `first` on, and their rotation.
#[derive(Clone, Copy, Debug)]
struct Triple {
    first: usize,
    rotation: [[f64; 3]; 3],
}

impl Corotation {
    /// No rotations, with memory for those of `n` unknowns.
    pub fn with_capacity(n: usize) -> Corotation {
        Corotation { pairs: Vec::with_capacity(n / 2), triples: Vec::with_capacity(n / 3) }
    }

    /// Removes all rotations.
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.triples.clear();
    }

    /// Adds the rotation of the vector with the components `unknowns` by the angle with this cosine and sine.
    #[inline]
    pub fn push(&mut self, unknowns: [usize; 2], cos: f64, sin: f64) {
        self.pairs.push(Pair { unknowns, cos, sin });
    }

    /// Adds the rotation of the vector in space whose components are the unknowns from `first` on.
    #[inline]
    pub fn push_vector(&mut self, first: usize, rotation: [[f64; 3]; 3]) {
        self.triples.push(Triple { first, rotation });
    }

    /// x ← R x
    pub fn rotate<T: Scalar>(&self, x: &mut [T]) {
        for &Pair { unknowns: [i, j], cos, sin } in &self.pairs {
            (x[i], x[j]) = (x[i].times(cos) - x[j].times(sin), x[i].times(sin) + x[j].times(cos));
        }
        for Triple { first, rotation } in &self.triples {
            turn(&mut x[*first..], |i, j| rotation[i][j]);
        }
    }

    /// x ← Rᵀ x
    pub fn rotate_back<T: Scalar>(&self, x: &mut [T]) {
        for &Pair { unknowns: [i, j], cos, sin } in &self.pairs {
            (x[i], x[j]) = (x[i].times(cos) + x[j].times(sin), x[j].times(cos) - x[i].times(sin));
        }
        for Triple { first, rotation } in &self.triples {
            turn(&mut x[*first..], |i, j| rotation[j][i]);
        }
    }
}

/// Multiplies the first three entries by a matrix.
#[inline(always)]
fn turn<T: Scalar>(x: &mut [T], entry: impl Fn(usize, usize) -> f64) {
    let [a, b, c] = [x[0], x[1], x[2]];
    for (i, x) in x[..3].iter_mut().enumerate() {
        *x = a.times(entry(i, 0)) + b.times(entry(i, 1)) + c.times(entry(i, 2));
    }
}
