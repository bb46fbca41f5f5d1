//! Units of the unknowns of a matrix in which all its rows are alike.
//!
//! Pivots of different rows are compared by size, and a row of a joint, whose entries are 1, beside a stiffness of 10¹² N/m is no pivot until the last:
//! the beam is then eliminated as if it were free, and the rounding of its vanishing stiffness, 10¹² ε, stands beside the row. In S A S, with a
//! diagonal S that brings the largest entry of every row and column to one, rows are compared in the same way in any units of mass, length and time, and
//! A⁻¹ = S (S A S)⁻¹ S. The entries of S are powers of two, which round nothing.
//!
//! Source: D. Ruiz, *A scaling algorithm to equilibrate both rows and columns norms in matrices*, RAL-TR-2001-034 (the sweeps).

use super::Scalar;

/// Sweeps over all rows at once: what is left of a factor is its root at each.
const SWEEPS: usize = 12;

/// The diagonal S of a matrix, by places.
#[derive(Clone, Debug, Default)]
pub(super) struct Equilibration {
    scales: Vec<f64>,
    largest: Vec<f64>,
}

impl Equilibration {
    /// S with which the largest entry sᵢ |aᵢⱼ| sⱼ of every row is between ½ and 4; `measure` calls what it is given with i, j and |aᵢⱼ| of every entry.
    pub(super) fn find(&mut self, order: usize, mut measure: impl FnMut(&mut dyn FnMut(usize, usize, f64))) {
        let Equilibration { scales, largest } = self;
        scales.clear();
        scales.resize(order, 1.0);
        for _ in 0..SWEEPS {
            largest.clear();
            largest.resize(order, 0.0);
            measure(&mut |i, j, size| {
                let size = size * scales[i] * scales[j];
                largest[i] = largest[i].max(size);
                largest[j] = largest[j].max(size);
            });
            let mut changes = false;
            for (s, size) in scales.iter_mut().zip(&*largest) {
                if *size > 0.0 && size.is_finite() {
                    let by = -libm::ilogb(*size) / 2;
                    changes |= by != 0;
                    *s = libm::scalbn(*s, by);
                }
            }
            if !changes {
                break;
            }
        }
    }

    /// S
    pub(super) fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// b ← S b
    pub(super) fn scale<T: Scalar>(&self, b: &mut [T]) {
        b.iter_mut().zip(&self.scales).for_each(|(b, s)| *b = b.times(*s));
    }
}
