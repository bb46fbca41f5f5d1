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

/// Exponent that stands for an infinite entry, its negative for no entry, and the size of exponents below which there is a number.
const NONE: i32 = 1 << 20;
const NUMBER: i32 = 1 << 19;

/// The diagonal S of a matrix, by places.
#[derive(Clone, Debug, Default)]
pub(super) struct Equilibration {
    scales: Vec<f64>,
    /// Row, column and exponent of two of every entry that is not zero.
    entries: Vec<(u32, u32, i32)>,
    exponents: Vec<i32>,
    largest: Vec<i32>,
}

impl Equilibration {
    /// S with which the largest entry sᵢ |aᵢⱼ| sⱼ of every row is between ½ and 4; `measure` calls what it is given with i, j and |aᵢⱼ| of every entry.
    ///
    /// Of powers of two and their products the exponents tell the largest: sweeps are over integers, and over entries that are not zero.
    pub(super) fn find(&mut self, order: usize, measure: impl FnOnce(&mut dyn FnMut(usize, usize, f64))) {
        let Equilibration { scales, entries, exponents, largest } = self;
        entries.clear();
        measure(&mut |i, j, size| {
            if size > 0.0 {
                let exponent = if size.is_finite() { libm::ilogb(size) } else { NONE };
                entries.push((i as u32, j as u32, exponent));
            }
        });
        exponents.clear();
        exponents.resize(order, 0);
        for _ in 0..SWEEPS {
            largest.clear();
            largest.resize(order, -NONE);
            for &(i, j, exponent) in entries.iter() {
                let (i, j) = (i as usize, j as usize);
                let scaled = exponent + exponents[i] + exponents[j];
                largest[i] = largest[i].max(scaled);
                largest[j] = largest[j].max(scaled);
            }
            let mut changes = false;
            for (s, exponent) in exponents.iter_mut().zip(&*largest) {
                let by = if exponent.abs() < NUMBER { -exponent / 2 } else { 0 };
                changes |= by != 0;
                *s += by;
            }
            if !changes {
                break;
            }
        }
        scales.clear();
        scales.extend(exponents.iter().map(|e| libm::scalbn(1.0, *e)));
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
