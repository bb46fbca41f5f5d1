//! The matrix an integrator owns and a system fills.

use super::equilibration::Equilibration;
use super::vector::weighted_sum;
use super::{Bordered, Dense, Scalar, Singular};
use std::sync::Arc;

/// Part of two entries that mirror each other by which rounding makes them differ.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// Shape of a system's tangent.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Structure {
    /// Dense of the given order.
    Dense {
        /// Order.
        order: usize,
    },
    /// Band with dense border rows and columns behind.
    Band {
        /// Order of the band part.
        order: usize,
        /// Half-bandwidth below the diagonal.
        lower: usize,
        /// Half-bandwidth above the diagonal.
        upper: usize,
        /// Number of dense rows and columns behind the band.
        border: usize,
    },
    /// Another structure in which the unknowns stand in another order: multipliers between the bodies that they couple.
    Ordered {
        /// The place of each unknown, a permutation.
        places: Arc<[u32]>,
        /// The structure of the places: dense or a band.
        of: Box<Structure>,
        /// Whether rows will be exchanged anywhere, for which a band then has room from the start.
        exchanges: bool,
    },
}

impl Structure {
    /// A dense matrix of order `n`.
    pub fn dense(n: usize) -> Structure {
        Structure::Dense { order: n }
    }

    /// A band matrix of order `n` with a border.
    pub fn band(n: usize, lower: usize, upper: usize, border: usize) -> Structure {
        Structure::Band { order: n, lower, upper, border }
    }

    /// The structure `of` with unknown i at the place `places[i]`, and room for exchanged rows.
    pub fn ordered(places: Arc<[u32]>, of: Structure, exchanges: bool) -> Structure {
        debug_assert_eq!(places.len(), of.order());
        match of {
            Structure::Band { .. } => Structure::Ordered { places, of: Box::new(of), exchanges },
            of => of,
        }
    }

    /// The same with `more` unknowns before unknown `at`, whose rows and columns are dense. Without an order of its own
    /// a band takes them among its border.
    pub fn widened(self, at: usize, more: usize) -> Structure {
        match self {
            Structure::Dense { order } => Structure::Dense { order: order + more },
            Structure::Band { order, lower, upper, border } => {
                debug_assert!(at >= order, "unknown {at} stands in the band");
                Structure::Band { order, lower, upper, border: border + more }
            }
            Structure::Ordered { places, of, exchanges } => {
                let (before, behind) = places.split_at(at);
                let order = places.len();
                let added = (order..order + more).map(|place| place as u32);
                let places = before.iter().copied().chain(added).chain(behind.iter().copied());
                let of = Box::new(of.widened(order, more));
                Structure::Ordered { places: places.collect(), of, exchanges }
            }
        }
    }

    /// Order of the whole matrix.
    pub fn order(&self) -> usize {
        match self {
            Structure::Dense { order } => *order,
            Structure::Band { order, border, .. } => order + border,
            Structure::Ordered { of, .. } => of.order(),
        }
    }

    /// Larger half-bandwidth of the part without border.
    pub fn half_bandwidth(&self) -> usize {
        match self {
            Structure::Dense { order } => order.saturating_sub(1),
            Structure::Band { lower, upper, .. } => *lower.max(upper),
            Structure::Ordered { of, .. } => of.half_bandwidth(),
        }
    }

    /// Number of dense rows and columns behind the band.
    pub fn border(&self) -> usize {
        match self {
            Structure::Dense { .. } => 0,
            Structure::Band { border, .. } => *border,
            Structure::Ordered { of, .. } => of.border(),
        }
    }

    /// The cheaper of the band as given and a dense matrix of the same order.
    pub fn cheaper(self) -> Structure {
        match self {
            Structure::Band { order, lower, upper, border } if lower + upper + 1 >= order => {
                Structure::dense(order + border)
            }
            other => other,
        }
    }
}

/// Numbers that identify the content of a matrix: equal stamps, equal content. A system whose tangent
/// depends on a few numbers only stamps it with them.
pub type Stamp = [f64; 6];

/// A square matrix in the storage of its [`Structure`]; factored in place.
#[derive(Clone, Debug)]
pub struct Matrix<T = f64> {
    storage: Storage<T>,
    ordering: Option<Ordering<T>>,
    stamp: Option<Stamp>,
    /// Stamps of the terms of a combination, and their weights.
    source: Option<([Stamp; 3], [T; 3])>,
    factored: bool,
    /// Units of the unknowns in which it was factored, if others than its own.
    units: Equilibration,
    equilibrated: bool,
}

/// The place of each unknown in the storage, and memory for a vector in the order of the places.
#[derive(Clone, Debug)]
struct Ordering<T> {
    places: Arc<[u32]>,
    unknowns: Vec<u32>,
    vector: Vec<T>,
}

impl<T: Scalar> Ordering<T> {
    fn new(places: Arc<[u32]>) -> Ordering<T> {
        let mut unknowns = vec![0; places.len()];
        places.iter().enumerate().for_each(|(i, place)| unknowns[*place as usize] = i as u32);
        let vector = vec![T::ZERO; places.len()];
        Ordering { places, unknowns, vector }
    }

    /// Takes `b` into the order of the places, changes it, and writes it back.
    fn apply(&mut self, b: &mut [T], change: impl FnOnce(&mut [T])) {
        self.unknowns.iter().zip(&mut self.vector).for_each(|(i, x)| *x = b[*i as usize]);
        change(&mut self.vector);
        self.unknowns.iter().zip(&self.vector).for_each(|(i, x)| b[*i as usize] = *x);
    }
}

/// The storages.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant)] // one a matrix, never in a collection
pub enum Storage<T> {
    /// Dense.
    Dense(Dense<T>),
    /// Band with border.
    Band(Bordered<T>),
}

impl<T: Scalar> Storage<T> {
    /// Entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> T {
        match self {
            Storage::Dense(a) => a.get(i, j),
            Storage::Band(a) => a.get(i, j),
        }
    }

    /// Calls `f` with the place and the value of every entry that it has room for.
    fn each_mut(&mut self, f: impl FnMut(usize, usize, &mut T)) {
        match self {
            Storage::Dense(a) => a.each_mut(f),
            Storage::Band(a) => a.each_mut(f),
        }
    }

    /// Calls `visit` with the places (i, j), j ≥ i, of all entries that it or its mirror image may hold.
    fn mirrors(&self, mut visit: impl FnMut(usize, usize)) {
        let (n, band, half) = match self {
            Storage::Dense(a) => (a.order(), a.order(), a.order()),
            Storage::Band(a) => (a.order(), a.band().order(), a.band().lower().max(a.band().upper())),
        };
        for i in 0..n {
            let end = if i < band { (i + half + 1).min(band) } else { i };
            (i..end).chain(band.max(i)..n).for_each(|j| visit(i, j));
        }
    }

    /// Adds to entry (i, j), which the structure must hold.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, x: T) {
        match self {
            Storage::Dense(a) => a.add(i, j, x),
            Storage::Band(a) => a.add(i, j, x),
        }
    }

    /// The `N` entries of row `i` from column `first` on, which the structure must hold, border aside.
    #[inline]
    pub fn run_mut<const N: usize>(&mut self, i: usize, first: usize) -> &mut [T] {
        match self {
            Storage::Dense(a) => {
                let at = i * a.order() + first;
                &mut a.data_mut()[at..at + N]
            }
            Storage::Band(a) => a.band_mut().run_mut::<N>(i, first),
        }
    }

    /// Adds w times `row` to row i, from column 0 on; the structure must hold what is not zero.
    pub fn add_row(&mut self, i: usize, w: T, row: &[T]) {
        match self {
            Storage::Dense(a) => {
                let at = i * a.order();
                a.data_mut()[at..at + row.len()].iter_mut().zip(row).for_each(|(a, x)| *a += w * *x);
            }
            Storage::Band(a) => {
                row.iter().enumerate().filter(|(_, x)| **x != T::ZERO).for_each(|(j, x)| a.add(i, j, w * *x));
            }
        }
    }

    /// Sets column, row and corner of border unknown `k`, which follows all unknowns but those of the border.
    pub fn set_border(&mut self, k: usize, column: &[T], row: &[T], corner: T) {
        match self {
            Storage::Dense(a) => {
                let border = column.len() + k;
                for (i, (column, row)) in column.iter().zip(row).enumerate() {
                    a.set(i, border, *column);
                    a.set(border, i, *row);
                }
                a.set(border, border, corner);
            }
            Storage::Band(a) => {
                a.column_mut(k).copy_from_slice(column);
                a.row_mut(k).copy_from_slice(row);
                a.set_corner(k, k, corner);
            }
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        match self {
            Storage::Dense(a) => a.clear(),
            Storage::Band(a) => a.clear(),
        }
    }

    /// Whether all entries are stored.
    pub fn is_dense(&self) -> bool {
        matches!(self, Storage::Dense(_))
    }

    /// The stored entries, row after row: of a band without its border, but with room for fill where there is any.
    pub fn entries(&self) -> &[T] {
        match self {
            Storage::Dense(a) => a.data(),
            Storage::Band(a) => a.band().data(),
        }
    }

    /// The rows of [`Storage::entries`].
    pub fn rows(&self) -> std::slice::ChunksExact<'_, T> {
        let (width, data) = match self {
            Storage::Dense(a) => (a.order(), a.data()),
            Storage::Band(a) => (a.band().width(), a.band().data()),
        };
        data.chunks_exact(width.max(1))
    }

    /// The rows of [`Storage::entries`], to be changed.
    pub fn rows_mut(&mut self) -> std::slice::ChunksExactMut<'_, T> {
        match self {
            Storage::Dense(a) => {
                let order = a.order().max(1);
                a.data_mut().chunks_exact_mut(order)
            }
            Storage::Band(a) => a.band_mut().rows_mut(),
        }
    }
}

impl<T: Scalar> Matrix<T> {
    /// The zero matrix.
    pub fn new(structure: &Structure) -> Matrix<T> {
        let storage = match *structure {
            Structure::Dense { order } => Storage::Dense(Dense::new(order)),
            Structure::Band { order, lower, upper, border } => {
                Storage::Band(Bordered::new(order, lower, upper, border))
            }
            Structure::Ordered { ref places, ref of, exchanges } => {
                let mut made = Matrix::new(of);
                if let (Storage::Band(a), true) = (&mut made.storage, exchanges) {
                    a.band_mut().widen();
                }
                return Matrix { ordering: Some(Ordering::new(places.clone())), ..made };
            }
        };
        Matrix {
            storage,
            ordering: None,
            stamp: None,
            source: None,
            factored: false,
            units: Equilibration::default(),
            equilibrated: false,
        }
    }

    /// The place of unknown `i` in the storage.
    #[inline]
    fn place(&self, i: usize) -> usize {
        self.ordering.as_ref().map_or(i, |ordering| ordering.places[i] as usize)
    }

    /// Order of the matrix.
    pub fn order(&self) -> usize {
        match &self.storage {
            Storage::Dense(a) => a.order(),
            Storage::Band(a) => a.order(),
        }
    }

    /// The storage, for reading. In an [ordered](Structure::Ordered) matrix its indices are places.
    pub fn storage(&self) -> &Storage<T> {
        &self.storage
    }

    /// The storage, for writing new content: the matrix is no longer factored, and is unstamped. In an
    /// [ordered](Structure::Ordered) matrix its indices are places.
    pub fn begin(&mut self) -> &mut Storage<T> {
        self.factored = false;
        self.stamp = None;
        self.source = None;
        &mut self.storage
    }

    /// Takes the content of another of the same structure that is not factored.
    pub fn copy_from(&mut self, other: &Matrix<T>) {
        debug_assert!(!other.factored, "the entries are overwritten by the factors");
        match (self.begin(), &other.storage) {
            (Storage::Dense(a), Storage::Dense(b)) => a.copy_from(b),
            (Storage::Band(a), Storage::Band(b)) => a.copy_from(b),
            _ => debug_assert!(false, "structures differ"),
        }
    }

    /// Takes the rows and columns of the first `order` unknowns of another that is not factored, if that is dense; a band as a whole, in which those behind cost next to
    /// nothing where they couple to nothing.
    pub fn copy_leading(&mut self, other: &Matrix<T>, order: usize) {
        debug_assert!(!other.factored, "the entries are overwritten by the factors");
        match (self.begin(), &other.storage) {
            (Storage::Dense(a), Storage::Dense(b)) => a.copy_leading(b, order),
            _ => self.copy_from(other),
        }
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.begin().clear();
    }

    /// The stamp of the content, if it has one.
    pub fn stamp(&self) -> Option<Stamp> {
        self.stamp
    }

    /// Stamps the content.
    pub fn set_stamp(&mut self, stamp: Option<Stamp>) {
        self.stamp = stamp;
    }

    /// Whether the content is that of `stamp`.
    pub fn holds(&self, stamp: &Stamp) -> bool {
        self.stamp.as_ref() == Some(stamp)
    }

    /// Whether the matrix has been factored since it was last written.
    pub fn is_factored(&self) -> bool {
        self.factored
    }

    /// Entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> T {
        self.storage.get(self.place(i), self.place(j))
    }

    /// The unknown at a place of the storage.
    pub fn unknown(&self, place: usize) -> usize {
        self.ordering.as_ref().map_or(place, |ordering| ordering.unknowns[place] as usize)
    }

    /// Calls `visit` with the row and the value of every entry of column `j` that is not zero.
    pub fn column(&self, j: usize, mut visit: impl FnMut(usize, T)) {
        let (n, place) = (self.order(), self.place(j));
        let (band, reach) = match &self.storage {
            Storage::Band(a) if place < a.band().order() => {
                let (first, last) = (place.saturating_sub(a.band().upper()), place + a.band().lower() + 1);
                (first..last.min(a.band().order()), a.band().order()..n)
            }
            _ => (0..n, n..n),
        };
        for i in band.chain(reach) {
            let i = self.unknown(i);
            let x = self.get(i, j);
            if x != T::ZERO {
                visit(i, x);
            }
        }
    }

    /// Calls `visit` with row, column and value of every entry that is not zero.
    pub fn visit(&self, mut visit: impl FnMut(usize, usize, T)) {
        let mut entry = |i: usize, j: usize, x: T| {
            if x != T::ZERO {
                visit(self.unknown(i), self.unknown(j), x);
            }
        };
        match &self.storage {
            Storage::Dense(a) => {
                for (i, row) in a.data().chunks_exact(a.order().max(1)).enumerate() {
                    row.iter().enumerate().for_each(|(j, x)| entry(i, j, *x));
                }
            }
            Storage::Band(a) => {
                let (band, n) = (a.band().order(), a.order());
                for i in 0..band {
                    let (first, row) = a.band().row(i);
                    row.iter().enumerate().for_each(|(k, x)| entry(i, first + k, *x));
                    (band..n).for_each(|j| entry(i, j, a.get(i, j)));
                }
                (band..n).for_each(|i| (0..n).for_each(|j| entry(i, j, a.get(i, j))));
            }
        }
    }

    /// Calls `visit` with every entry on and above the diagonal of the storage that it may hold, and with the one that mirrors it.
    pub fn mirrored(&self, mut visit: impl FnMut(T, T)) {
        self.storage.mirrors(|i, j| visit(self.storage.get(i, j), self.storage.get(j, i)));
    }

    /// ½ (A − Aᵀ), but for what rounding leaves of it.
    pub fn skew(&self) -> Matrix<T> {
        let mut out = self.clone();
        let (half, to) = (T::real(0.5), out.begin());
        to.clear();
        self.storage.mirrors(|i, j| {
            let [a, b] = [self.storage.get(i, j), self.storage.get(j, i)];
            if (a - b).size() > ROUNDING * (a.size() + b.size()) {
                to.add(i, j, half * (a - b));
                to.add(j, i, half * (b - a));
            }
        });
        out
    }

    /// ½ (A + Aᵀ)
    pub fn symmetrized(&self) -> Matrix<T> {
        let mut out = self.clone();
        let half = T::real(0.5);
        let to = out.begin();
        self.storage.mirrors(|i, j| {
            let off = half * (self.storage.get(j, i) - self.storage.get(i, j));
            if off != T::ZERO {
                to.add(i, j, off);
                to.add(j, i, -off);
            }
        });
        out
    }

    /// Adds `x` to entry (i, j). For hot loops use the [storage](Matrix::begin) itself.
    pub fn add(&mut self, i: usize, j: usize, x: T) {
        self.factored = false;
        let (i, j) = (self.place(i), self.place(j));
        self.storage.add(i, j, x);
    }

    /// Adds `block` to the rows and columns of the unknowns from `at` on.
    pub fn add_block<const N: usize>(&mut self, at: usize, block: &[[T; N]; N]) {
        self.factored = false;
        let places: [usize; N] = std::array::from_fn(|k| self.place(at + k));
        match &mut self.storage {
            Storage::Band(a) if places.iter().all(|place| *place < a.band().order()) => {
                a.band_mut().add_block(&places, block);
            }
            storage => {
                for (i, row) in places.iter().zip(block) {
                    row.iter().zip(&places).for_each(|(x, j)| storage.add(*i, *j, *x));
                }
            }
        }
    }

    /// y = A x. Only before factoring.
    pub fn multiply(&self, x: &[T], y: &mut [T]) {
        debug_assert!(!self.factored, "the entries are overwritten by the factors");
        if let (Some(ordering), Storage::Band(a)) = (&self.ordering, &self.storage) {
            return a.multiply_ordered(&ordering.unknowns, x, y);
        }
        match &self.storage {
            Storage::Dense(a) => a.multiply(x, y),
            Storage::Band(a) => a.multiply(x, y),
        }
    }

    /// Factors in place; `false` when the content was factored already and nothing was done.
    pub fn factor(&mut self) -> Result<bool, Singular> {
        if self.factored {
            return Ok(false);
        }
        let result = match &mut self.storage {
            Storage::Dense(a) => a.factor(),
            Storage::Band(a) => a.factor(),
        };
        if let Err(cause) = result {
            self.stamp = None;
            self.source = None;
            let index = self.ordering.as_ref().map_or(cause.index, |o| o.unknowns[cause.index] as usize);
            return Err(Singular { index, ..cause });
        }
        (self.factored, self.equilibrated) = (true, false);
        Ok(true)
    }

    /// The same in the units of the unknowns in which the largest entry of every row is about one: which pivots are exchanged does not depend on
    /// the units of the content.
    pub fn factor_equilibrated(&mut self) -> Result<bool, Singular> {
        if self.factored {
            return Ok(false);
        }
        let (order, storage) = (self.order(), &mut self.storage);
        self.units.find(order, |measure| storage.each_mut(|i, j, x| measure(i, j, x.size())));
        let s = self.units.scales();
        storage.each_mut(|i, j, x| *x = x.times(s[i] * s[j]));
        self.factor()?;
        self.equilibrated = true;
        Ok(true)
    }

    /// Solves A x = b in place after [`Matrix::factor`].
    pub fn solve(&mut self, b: &mut [T]) {
        debug_assert!(self.factored, "factor first");
        let (storage, units) = (&mut self.storage, self.equilibrated.then_some(&self.units));
        let mut solve = |b: &mut [T]| {
            units.into_iter().for_each(|units| units.scale(b));
            match storage {
                Storage::Dense(a) => a.solve(b),
                Storage::Band(a) => a.solve(b),
            }
            units.into_iter().for_each(|units| units.scale(b));
        };
        match &mut self.ordering {
            None => solve(b),
            Some(ordering) => ordering.apply(b, solve),
        }
    }
}

impl<T: Scalar> Matrix<T> {
    /// Sets the matrix to Σ wₖ Aₖ (equal structures). When the terms have the stamps of the last combination and
    /// the weights are the same the content, factored or not, is left as it is.
    pub fn combine(&mut self, terms: [&Matrix; 3], weights: [T; 3]) {
        let source = match terms.map(|a| a.stamp) {
            [Some(a), Some(b), Some(c)] => Some(([a, b, c], weights)),
            _ => None,
        };
        if source.is_some() && source == self.source {
            return;
        }
        match (self.begin(), terms.map(|a| &a.storage)) {
            (Storage::Dense(out), [Storage::Dense(a), Storage::Dense(b), Storage::Dense(c)]) => {
                weighted_sum(out.data_mut(), [a, b, c].map(|a| a.data()), weights);
            }
            (Storage::Band(out), [Storage::Band(a), Storage::Band(b), Storage::Band(c)]) => {
                out.combine([a, b, c], weights);
            }
            _ => debug_assert!(false, "structures differ"),
        }
        self.source = source;
    }
}
