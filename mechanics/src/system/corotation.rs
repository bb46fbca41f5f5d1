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

/// Vectors in a row, three unknowns each, from `first` to `end`, and their rotation.
#[derive(Clone, Copy, Debug)]
struct Triple {
    first: u32,
    end: u32,
    rotation: [[f64; 3]; 3],
}

impl Corotation {
    /// Removes all rotations, and all memory but that for as many.
    pub fn emptied(mut self) -> Corotation {
        self.pairs.shrink_to_fit();
        self.triples.shrink_to_fit();
        self.clear();
        self
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

    /// Adds the rotation of `N` vectors in space whose components are the unknowns from `first` on.
    #[inline]
    pub fn push_vectors<const N: usize>(&mut self, first: usize, rotation: [[f64; 3]; 3]) {
        self.triples.push(Triple { first: first as u32, end: (first + 3 * N) as u32, rotation });
    }

    /// x ← R x
    pub fn rotate<T: Scalar>(&self, x: &mut [T]) {
        for &Pair { unknowns: [i, j], cos, sin } in &self.pairs {
            (x[i], x[j]) = (x[i].times(cos) - x[j].times(sin), x[i].times(sin) + x[j].times(cos));
        }
        for Triple { first, end, rotation } in &self.triples {
            turn(&mut x[*first as usize..*end as usize], |i, j| rotation[i][j]);
        }
    }

    /// x ← Rᵀ x
    pub fn rotate_back<T: Scalar>(&self, x: &mut [T]) {
        for &Pair { unknowns: [i, j], cos, sin } in &self.pairs {
            (x[i], x[j]) = (x[i].times(cos) + x[j].times(sin), x[j].times(cos) - x[i].times(sin));
        }
        for Triple { first, end, rotation } in &self.triples {
            turn(&mut x[*first as usize..*end as usize], |i, j| rotation[j][i]);
        }
    }
}

/// Multiplies every three entries by a matrix.
#[inline(always)]
fn turn<T: Scalar>(x: &mut [T], entry: impl Fn(usize, usize) -> f64) {
    for x in x.as_chunks_mut::<3>().0 {
        let [a, b, c] = *x;
        *x = [0, 1, 2].map(|i| a.times(entry(i, 0)) + b.times(entry(i, 1)) + c.times(entry(i, 2)));
    }
}
