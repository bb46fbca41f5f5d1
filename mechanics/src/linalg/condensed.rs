//! A band matrix of which some unknowns are hidden: a full matrix by the cost of a band.
//!
//! A matrix that is full, but made of running sums along the unknowns, is the Schur complement of a larger
//! band matrix whose further unknowns are the values of those sums:
//!
//! ```text
//! ⎡ V  H ⎤ ⎡x⎤   ⎡b⎤
//! ⎣ R  S ⎦ ⎣h⎦ = ⎣0⎦         A = V − H S⁻¹ R
//! ```
//!
//! Whoever multiplies by A or solves A x = b sees x and b only: the hidden unknowns h stand between the
//! visible ones, at places that make the whole a narrow band, which is factored as it is. Two rules:
//!
//! - S is triangular in the order in which the hidden unknowns are listed, so that a product with A takes one
//!   pass over them;
//! - H and S do not depend on the weights of a tangent, only V and R do: sums of such matrices, real or
//!   complex, are then sums of their A.

use super::{Bordered, Scalar, Singular};
use std::cell::RefCell;
use std::sync::Arc;

/// Where the unknowns of a [`Condensed`] matrix stand in its band.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Places {
    /// Place of each visible unknown, ascending.
    pub visible: Vec<usize>,
    /// Place of each hidden unknown, each behind those that its equation contains.
    pub hidden: Vec<usize>,
}

impl Places {
    /// Order of the band.
    pub fn len(&self) -> usize {
        self.visible.len() + self.hidden.len()
    }

    /// Whether there is no unknown.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A band with border and hidden unknowns; see the [module documentation](self).
#[derive(Clone, Debug)]
pub struct Condensed<T> {
    whole: Bordered<T>,
    places: Arc<Places>,
    border: usize,
    /// All unknowns of the band, and the border's.
    all: RefCell<Vec<T>>,
}

impl<T: Scalar> Condensed<T> {
    /// The zero matrix with half-bandwidths `lower` and `upper` and a border of width `border`.
    pub fn new(places: Arc<Places>, lower: usize, upper: usize, border: usize) -> Condensed<T> {
        let n = places.len();
        Condensed {
            whole: Bordered::new(n, lower, upper, border),
            places,
            border,
            all: RefCell::new(vec![T::ZERO; n + border]),
        }
    }

    /// Number of visible unknowns, border included.
    pub fn order(&self) -> usize {
        self.places.visible.len() + self.border
    }

    /// Places of the unknowns in the band.
    pub fn places(&self) -> &Places {
        &self.places
    }

    /// The band of all unknowns, with its border.
    pub fn whole(&self) -> &Bordered<T> {
        &self.whole
    }

    /// The band of all unknowns, to be changed.
    pub fn whole_mut(&mut self) -> &mut Bordered<T> {
        &mut self.whole
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.whole.clear();
    }

    /// Adds `x` to the entry of the visible unknowns i and j.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, x: T) {
        self.whole.add(self.place(i), self.place(j), x);
    }

    /// Writes column, row and corner of border unknown `k`, over the visible unknowns.
    pub fn set_border(&mut self, k: usize, column: &[T], row: &[T], corner: T) {
        for ((&place, u), v) in self.places.visible.iter().zip(column).zip(row) {
            self.whole.column_mut(k)[place] = *u;
            self.whole.row_mut(k)[place] = *v;
        }
        self.whole.set_corner(k, k, corner);
    }

    /// Place of a visible unknown, border included.
    fn place(&self, i: usize) -> usize {
        let visible = &self.places.visible;
        visible.get(i).copied().unwrap_or(i - visible.len().min(i) + self.places.len())
    }

    /// Entry (i, j) of A, before factoring. O(n) a call, and allocates: for tests and reports.
    pub fn get(&self, i: usize, j: usize) -> T {
        let mut unit = vec![T::ZERO; self.order()];
        let mut column = unit.clone();
        unit[j] = T::ONE;
        self.multiply(&unit, &mut column);
        column[i]
    }

    /// y = A x, before factoring.
    pub fn multiply(&self, x: &[T], y: &mut [T]) {
        let Places { visible, hidden } = &*self.places;
        let n = visible.len();
        let mut all = self.all.borrow_mut();
        self.spread(x, &mut all);
        for &i in hidden {
            all[i] = -self.whole.row_times(i, &all) / self.whole.get(i, i);
        }
        for (y, &i) in y.iter_mut().zip(visible) {
            *y = self.whole.row_times(i, &all);
        }
        for (k, y) in y[n..].iter_mut().enumerate() {
            *y = self.whole.row_times(self.places.len() + k, &all);
        }
    }

    /// Visible entries to their places, zero for the hidden ones.
    fn spread(&self, x: &[T], all: &mut [T]) {
        let (x, border) = x.split_at(self.places.visible.len());
        all.fill(T::ZERO);
        for (x, &place) in x.iter().zip(&self.places.visible) {
            all[place] = *x;
        }
        all[self.places.len()..].copy_from_slice(border);
    }

    /// Factors in place.
    pub fn factor(&mut self) -> Result<(), Singular> {
        self.whole.factor().map_err(|e| {
            // The visible unknown at or before the place, or of the border.
            let Places { visible, .. } = &*self.places;
            let index = match e.index.checked_sub(self.places.len()) {
                Some(k) => visible.len() + k,
                None => visible.partition_point(|&place| place <= e.index).saturating_sub(1),
            };
            Singular { index, pivot: e.pivot }
        })
    }

    /// Solves A x = b in place after [`Condensed::factor`].
    pub fn solve(&mut self, b: &mut [T]) {
        let mut all = self.all.borrow_mut();
        self.spread(b, &mut all);
        self.whole.solve(&mut all);
        let (b, border) = b.split_at_mut(self.places.visible.len());
        for (b, &place) in b.iter_mut().zip(&self.places.visible) {
            *b = all[place];
        }
        border.copy_from_slice(&all[self.places.len()..]);
    }

    /// Replaces the content by Σ wₖ Aₖ of real matrices of the same structure: V and R by their sums, H and S,
    /// which all have in common, as they are.
    pub(super) fn combine(&mut self, terms: [&Condensed<f64>; 3], weights: [T; 3]) {
        self.whole.combine(terms.map(|a| &a.whole), weights);
        let band = terms[0].whole.band();
        let (lower, upper, n) = (band.lower(), band.upper(), band.order());
        for &j in &self.places.hidden {
            for i in j.saturating_sub(upper)..(j + lower + 1).min(n) {
                self.whole.band_mut().set(i, j, T::real(band.get(i, j)));
            }
        }
    }
}
