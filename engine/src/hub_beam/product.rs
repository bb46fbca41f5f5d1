//! Products of the constant matrices with vectors: the innermost loops of a linear model.
//!
//! Row i of a band matrix meets the entries i − l … i + u of a vector. With l zeros in front of the vector
//! and a few behind it every row meets a full window, the first and last rows too, and the loop over a row
//! has a length the compiler knows. Rows are read up to a multiple of four entries: what lies beyond the
//! band is the zone of fill, which is zero in a matrix that is not factored.

use crate::linalg::{Matrix, Storage, Structure};
use std::ops::Range;

/// Entries of a row that are summed side by side.
const LANES: usize = 4;
type Lanes = [f64; LANES];

/// How the rows of the stored matrices lie in memory, and which part of a vector they meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    order: usize,
    /// Entries from one row to the next.
    stride: usize,
    /// Entries of a row within the band, and those that are read.
    band: usize,
    width: usize,
    /// How far the window of a row lies behind that of the row before: 1, or 0 for full rows.
    advance: usize,
    /// Zeros in front of a vector.
    lead: usize,
}

/// A vector with zeros in front of it and behind it.
#[derive(Clone, Debug)]
pub(super) struct Padded {
    lead: usize,
    order: usize,
    data: Vec<f64>,
}

impl Padded {
    /// Sets entry i to f(i).
    #[inline]
    pub(super) fn fill(&mut self, f: impl Fn(usize) -> f64) {
        for (i, x) in self.data[self.lead..self.lead + self.order].iter_mut().enumerate() {
            *x = f(i);
        }
    }
}

/// The entries of a matrix, border aside.
pub(super) fn entries(matrix: &Matrix) -> &[f64] {
    match matrix.storage() {
        Storage::Dense(a) => a.data(),
        Storage::Band(a) => a.band().data(),
    }
}

impl Rows {
    /// The first `order` rows of matrices of the given structure.
    pub(super) fn new(structure: &Structure, order: usize) -> Rows {
        match *structure {
            Structure::Dense { order: stride } => {
                Rows { order, stride, band: order, width: order, advance: 0, lead: 0 }
            }
            Structure::Band { lower, upper, .. } => {
                let most = order.saturating_sub(1);
                let (lower, upper) = (lower.min(most), upper.min(most));
                let (band, stride) = (lower + upper + 1, 2 * lower + upper + 1);
                let full = band.next_multiple_of(LANES);
                let width = if full <= stride { full } else { band };
                Rows { order, stride, band, width, advance: 1, lead: lower }
            }
        }
    }

    /// Number of rows.
    pub(super) fn order(&self) -> usize {
        self.order
    }

    /// Columns of row `i`, and where in the entries of a matrix they are stored.
    pub(super) fn row(&self, i: usize) -> (Range<usize>, Range<usize>) {
        let ahead = self.advance * i;
        let first = ahead.saturating_sub(self.lead);
        let last = (ahead + self.band - self.lead).min(self.order);
        let at = i * self.stride + first + self.lead - ahead;
        (first..last, at..at + last - first)
    }

    /// A padded vector of zeros.
    pub(super) fn vector(&self) -> Padded {
        let behind = if self.advance == 0 { 0 } else { self.width };
        Padded { lead: self.lead, order: self.order, data: vec![0.0; self.lead + self.order + behind] }
    }

    /// Calls `f` with i and the sum over `terms` (A, x) of the products (A x)ᵢ, row after row.
    #[inline]
    pub(super) fn products<const TERMS: usize>(
        &self,
        terms: [(&Matrix, &Padded); TERMS],
        f: impl FnMut(usize, f64),
    ) {
        let terms = terms.map(|(a, x)| (entries(a), &x.data[..]));
        match self.width {
            8 => self.sums(terms, fixed::<8>, f),
            12 => self.sums(terms, fixed::<12>, f),
            16 => self.sums(terms, fixed::<16>, f),
            width => self.sums(terms, |lanes, a, x| any(lanes, &a[..width], &x[..width]), f),
        }
    }

    #[inline(always)]
    fn sums<const TERMS: usize>(
        &self,
        terms: [(&[f64], &[f64]); TERMS],
        add: impl Fn(&mut Lanes, &[f64], &[f64]),
        mut f: impl FnMut(usize, f64),
    ) {
        for i in 0..self.order {
            let (row, window) = (i * self.stride, i * self.advance);
            let mut lanes = [0.0; LANES];
            for (a, x) in terms {
                add(&mut lanes, &a[row..], &x[window..]);
            }
            f(i, (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]));
        }
    }
}

/// Adds the products of the first `N` entries to the lanes; `N` is a multiple of their number.
#[inline(always)]
fn fixed<const N: usize>(lanes: &mut Lanes, a: &[f64], x: &[f64]) {
    let (Some(a), Some(x)) = (a.first_chunk::<N>(), x.first_chunk::<N>()) else { return };
    for first in (0..N).step_by(LANES) {
        for k in 0..LANES {
            lanes[k] += a[first + k] * x[first + k];
        }
    }
}

/// Adds the products of all entries to the lanes.
#[inline(always)]
fn any(lanes: &mut Lanes, a: &[f64], x: &[f64]) {
    let (fours, rest) = a.as_chunks::<LANES>();
    let (x_fours, x_rest) = x.as_chunks::<LANES>();
    for (a, x) in fours.iter().zip(x_fours) {
        for k in 0..LANES {
            lanes[k] += a[k] * x[k];
        }
    }
    for (k, (a, x)) in rest.iter().zip(x_rest).enumerate() {
        lanes[k] += a * x;
    }
}
