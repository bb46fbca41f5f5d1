//! Band matrix with LU by threshold pivoting.
//!
//! Row-wise storage: row i holds columns i − l … i + u, so that elimination runs along contiguous memory. Without
//! interchanges the elimination stays within the band, and the cost is n·l·u multiplications. The factors hold 1/Uₖₖ on the diagonal. The first interchange that
//! fills a row beyond column i + u gives all rows l columns more, where they have not had them from the start.
//!
//! The diagonal is the pivot as long as |aᵢₖ|² ≤ τ⁻² |aₖₖ| |aᵢᵢ| for the rows i below it, which holds for
//! every positive definite matrix, and for any units of the unknowns: it bounds by 1/τ the multipliers
//! of the matrix that is scaled to a unit diagonal. Otherwise the largest entry of the column is.

use super::vector::weighted_sum;
use super::{NOTHING, Scalar, Singular};

/// Largest number of vanishing pivots of the band that are moved to the border.
pub const DEFLATIONS: usize = 4;

/// A pivot below this share of its column is taken for zero when the border can replace it.
const VANISHING: f64 = 1e-12;

/// Bound 1/τ² of the squared multipliers with which the diagonal is accepted as pivot.
const GROWTH: f64 = 100.0;

/// Square band matrix with `lower` and `upper` half-bandwidths; factored in place.
#[derive(Clone, Debug)]
pub struct Band<T> {
    n: usize,
    lower: usize,
    upper: usize,
    width: usize,
    data: Vec<T>,
    /// Row exchanged with row k at step k, minus k.
    pivots: Vec<u32>,
    /// The first row that was exchanged with another, or n.
    first_exchange: usize,
    /// Pivots that were too small and were replaced: see [`Band::factor`].
    deflated: Vec<(usize, f64)>,
    /// Largest entry of each column before elimination, for [deflation](Band::deflatable).
    column_size: Vec<f64>,
}

impl<T: Scalar> Band<T> {
    /// The n × n zero band matrix.
    pub fn new(n: usize, lower: usize, upper: usize) -> Band<T> {
        let lower = lower.min(n.saturating_sub(1));
        let upper = upper.min(n.saturating_sub(1));
        let width = lower + upper + 1;
        Band {
            n,
            lower,
            upper,
            width,
            data: vec![T::ZERO; n * width],
            pivots: vec![0; n],
            first_exchange: n,
            deflated: Vec::with_capacity(DEFLATIONS),
            column_size: Vec::new(),
        }
    }

    /// Takes the content of another of the same order.
    pub(super) fn copy_from(&mut self, other: &Band<T>) {
        (self.n, self.lower, self.upper, self.width) = (other.n, other.lower, other.upper, other.width);
        self.data.clone_from(&other.data);
        self.pivots.clone_from(&other.pivots);
        self.first_exchange = other.first_exchange;
        self.deflated.clone_from(&other.deflated);
        self.column_size.clone_from(&other.column_size);
    }

    /// The same matrix with the memory that deflation takes.
    pub(super) fn deflatable(self) -> Band<T> {
        Band { column_size: vec![0.0; self.n], ..self }
    }

    /// Order of the matrix.
    pub fn order(&self) -> usize {
        self.n
    }

    /// Half-bandwidth below the diagonal.
    pub fn lower(&self) -> usize {
        self.lower
    }

    /// Half-bandwidth above the diagonal.
    pub fn upper(&self) -> usize {
        self.upper
    }

    /// Length of a stored row: lower + upper + 1, and `lower` more once interchanges have needed them.
    pub fn width(&self) -> usize {
        self.width
    }

    /// All stored entries, row after row.
    pub fn data(&self) -> &[T] {
        &self.data
    }

    /// All stored entries, row after row, to be changed.
    pub fn data_mut(&mut self) -> &mut [T] {
        &mut self.data
    }

    /// The stored rows, to be changed.
    pub fn rows_mut(&mut self) -> std::slice::ChunksExactMut<'_, T> {
        self.data.chunks_exact_mut(self.width.max(1))
    }

    /// Replaces the content by Σ wₖ Aₖ of real matrices with the same band.
    pub(super) fn combine(&mut self, terms: [&Band<f64>; 3], weights: [T; 3]) {
        let band = self.lower + self.upper + 1;
        let row = |a: &Band<f64>, i: usize| i * a.width..i * a.width + band;
        for (i, out) in self.data.chunks_exact_mut(self.width).enumerate() {
            let (out, fill) = out.split_at_mut(band);
            weighted_sum(out, terms.map(|a| &a.data[row(a, i)]), weights);
            fill.fill(T::ZERO);
        }
    }

    /// Gives every row room for the fill that interchanges bring.
    pub(super) fn widen(&mut self) {
        let width = self.lower + self.upper + 1 + self.lower;
        let mut data = vec![T::ZERO; self.n * width];
        for (to, from) in data.chunks_exact_mut(width).zip(self.data.chunks_exact(self.width)) {
            to[..self.width].copy_from_slice(from);
        }
        (self.data, self.width) = (data, width);
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.data.fill(T::ZERO);
    }

    /// Entry (i, j), zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> T {
        if j + self.lower < i || j > i + self.upper {
            return T::ZERO;
        }
        self.data[i * self.width + j + self.lower - i]
    }

    /// Adds `x` to entry (i, j), which must lie within the band.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, x: T) {
        debug_assert!(j + self.lower >= i && j <= i + self.upper, "({i}, {j}) is outside the band");
        self.data[i * self.width + j + self.lower - i] += x;
    }

    /// Sets entry (i, j), which must lie within the band.
    #[inline]
    pub fn set(&mut self, i: usize, j: usize, x: T) {
        debug_assert!(j + self.lower >= i && j <= i + self.upper, "({i}, {j}) is outside the band");
        self.data[i * self.width + j + self.lower - i] = x;
    }

    /// The `N` entries of row `i` from column `first` on, which must lie within the band.
    #[inline]
    pub fn run_mut<const N: usize>(&mut self, i: usize, first: usize) -> &mut [T] {
        debug_assert!(first + self.lower >= i && first + N <= i + self.upper + 1, "outside the band");
        let at = i * self.width + first + self.lower - i;
        &mut self.data[at..at + N]
    }

    /// The first column of row `i`, and its entries from there on.
    pub(super) fn row(&self, i: usize) -> (usize, &[T]) {
        let first = i.saturating_sub(self.lower);
        let last = (i + self.upper + 1).min(self.n);
        let at = i * self.width + self.lower - i;
        (first, &self.data[at + first..at + last])
    }

    /// Adds `block` to the rows and columns `places`, which must lie within the band.
    #[inline]
    pub(super) fn add_block<const N: usize>(&mut self, places: &[usize; N], block: &[[T; N]; N]) {
        for (&i, entries) in places.iter().zip(block) {
            let row = &mut self.data[i * self.width..(i + 1) * self.width];
            for (&j, x) in places.iter().zip(entries) {
                debug_assert!(j + self.lower >= i && j <= i + self.upper, "({i}, {j}) is outside the band");
                row[j + self.lower - i] += *x;
            }
        }
    }

    /// y = A x, before factoring.
    pub fn multiply(&self, x: &[T], y: &mut [T]) {
        y.fill(T::ZERO);
        self.multiply_add(T::ONE, x, y);
    }

    /// y += w A x, before factoring.
    pub fn multiply_add(&self, w: T, x: &[T], y: &mut [T]) {
        let (l, band) = (self.lower, self.lower + self.upper + 1);
        for (i, (row, y)) in self.data.chunks_exact(self.width).zip(y).enumerate() {
            let first = i.saturating_sub(l);
            let last = (i + self.upper + 1).min(self.n);
            let mut sum = T::ZERO;
            if i >= l && i + self.upper < self.n {
                for (a, x) in row[..band].iter().zip(&x[i - l..i - l + band]) {
                    sum += *a * *x;
                }
            } else {
                for (a, x) in row[first + l - i..].iter().zip(&x[first..last]) {
                    sum += *a * *x;
                }
            }
            *y += w * sum;
        }
    }

    /// LU factorisation in place, with row interchanges where they are needed.
    ///
    /// A pivot below working precision would end the elimination. When `deflate` allows it, the
    /// pivot is replaced by the size of the matrix instead and noted in [`Band::deflated`]: the
    /// factors are then those of A + Σ δ_k (L e_k) e_kᵀ, and the caller's border undoes the change.
    pub fn factor(&mut self, deflate: bool) -> Result<(), Singular> {
        self.deflated.clear();
        self.first_exchange = self.n;
        if deflate {
            self.measure_columns();
        }
        // The common bands are given to the compiler as constants: it unrolls the loops over them.
        match (self.lower, self.upper) {
            (3, 3) if self.width == 7 => self.eliminate::<3, 7>(deflate),
            (5, 5) if self.width == 11 => self.eliminate::<5, 11>(deflate),
            (7, 7) if self.width == 15 => self.eliminate::<7, 15>(deflate),
            (9, 9) if self.width == 19 => self.eliminate::<9, 19>(deflate),
            (15, 15) if self.width == 31 => self.eliminate::<15, 31>(deflate),
            (23, 23) if self.width == 47 => self.eliminate::<23, 47>(deflate),
            _ => self.eliminate_from(0, deflate),
        }
    }

    /// Elimination with half-bandwidths `HALF` and rows of length `WIDTH` while the diagonal is a sufficient pivot.
    fn eliminate<const HALF: usize, const WIDTH: usize>(&mut self, deflate: bool) -> Result<(), Singular> {
        let mut k = 0;
        while k + HALF < self.n {
            let small = if deflate { VANISHING * self.column_size[k] } else { 0.0 };
            let rows = &mut self.data[k * WIDTH..(k + HALF + 1) * WIDTH];
            let (rows, _) = rows.as_chunks_mut::<WIDTH>();
            let Some((pivot_row, below)) = rows.split_first_mut() else { break };
            let pivot = pivot_row[HALF];
            let limit = GROWTH * pivot.size();
            let mut sound = pivot.size() > small;
            for r in 0..HALF {
                let size = below[r][HALF - 1 - r].size();
                sound &= size * size <= limit * below[r][HALF].size();
            }
            if !sound {
                break;
            }
            let inverse = T::ONE / pivot;
            pivot_row[HALF] = inverse;
            self.pivots[k] = 0;
            for r in 0..HALF {
                let first = HALF - 1 - r;
                let factor = below[r][first] * inverse;
                if factor == T::ZERO {
                    continue;
                }
                below[r][first] = factor;
                for j in 1..=HALF {
                    below[r][first + j] -= factor * pivot_row[HALF + j];
                }
            }
            k += 1;
        }
        self.eliminate_from(k, deflate)
    }

    /// Elimination of the columns from `start` on, with interchanges where they are needed.
    fn eliminate_from(&mut self, start: usize, deflate: bool) -> Result<(), Singular> {
        let (n, l, u) = (self.n, self.lower, self.upper);
        let mut width = self.width;
        // Columns up to which earlier interchanges have filled the rows.
        let mut filled = 0;
        for k in start..n {
            let last_row = (k + l).min(n - 1);
            let diagonal = self.data[k * width + l].size();
            let limit = GROWTH * diagonal;
            let (mut p, mut best, mut sound) = (k, diagonal, true);
            for i in k + 1..=last_row {
                let size = self.data[i * width + k + l - i].size();
                sound &= size * size <= limit * self.data[i * width + l].size();
                if size > best {
                    (p, best) = (i, size);
                }
            }
            // Compared with its own column, so that unknowns in different units do not make a sound
            // band look singular. A NaN pivot is refused too.
            let small = if deflate { NOTHING.max(VANISHING * self.column_size[k]) } else { NOTHING };
            // What vanishes is replaced where it stands, on the diagonal.
            if sound && diagonal > small || !(best > small) {
                (p, best) = (k, diagonal);
            }
            filled = filled.max((p + u).min(n - 1)).max(k);
            let count = filled - k;
            if count > width - l - 1 {
                self.widen();
                width = self.width;
            }
            self.pivots[k] = (p - k) as u32;
            if !(best > small) {
                if !deflate || !best.is_finite() || self.deflated.len() == DEFLATIONS {
                    let largest = self.data.iter().map(|x| x.size()).fold(0.0, f64::max);
                    return Err(Singular { index: k, pivot: best / largest });
                }
                let delta = if self.column_size[k] > 0.0 { self.column_size[k] } else { 1.0 };
                self.data[k * width + l] += T::real(delta);
                self.deflated.push((k, delta));
            }
            let rows = &mut self.data[k * width..(last_row + 1) * width];
            if p != k {
                self.first_exchange = self.first_exchange.min(k);
                // Entry (k, k + j) against entry (p, k + j).
                let (head, tail) = rows.split_at_mut((p - k) * width);
                let start = l - (p - k);
                head[l..l + count + 1].swap_with_slice(&mut tail[start..start + count + 1]);
            }
            let (pivot_row, below) = rows.split_at_mut(width);
            let inverse = T::ONE / pivot_row[l];
            pivot_row[l] = inverse;
            let pivot_row = &pivot_row[l + 1..l + 1 + count];
            for (r, row) in below.chunks_exact_mut(width).enumerate() {
                let (first, rest) = row[l - 1 - r..].split_at_mut(1);
                let factor = first[0] * inverse;
                first[0] = factor;
                for (a, u) in rest.iter_mut().zip(pivot_row) {
                    *a -= factor * *u;
                }
            }
        }
        Ok(())
    }

    fn measure_columns(&mut self) {
        self.column_size.fill(0.0);
        for (i, row) in self.data.chunks_exact(self.width).enumerate() {
            let first = i.saturating_sub(self.lower);
            let last = (i + self.upper + 1).min(self.n);
            let sizes = &mut self.column_size[first..last];
            for (size, a) in sizes.iter_mut().zip(&row[first + self.lower - i..]) {
                *size = size.max(a.size());
            }
        }
    }

    /// The pivots that [`Band::factor`] replaced, each with the amount δ that was added.
    pub fn deflated(&self) -> &[(usize, f64)] {
        &self.deflated
    }

    /// b ← L⁻¹ P b after factoring.
    pub fn forward(&self, b: &mut [T]) {
        match self.lower {
            3 => self.forward_by_rows::<3>(b),
            5 => self.forward_by_rows::<5>(b),
            7 => self.forward_by_rows::<7>(b),
            9 => self.forward_by_rows::<9>(b),
            15 => self.forward_by_rows::<15>(b),
            23 => self.forward_by_rows::<23>(b),
            _ => self.forward_by_rows::<0>(b),
        }
        if self.first_exchange < self.n {
            self.forward_interchanged(b);
        }
    }

    /// Row by row up to the first exchange; `LOWER` is the half-bandwidth, or 0.
    fn forward_by_rows<const LOWER: usize>(&self, b: &mut [T]) {
        let (width, l) = (self.width, if LOWER > 0 { LOWER } else { self.lower });
        let short = if self.first_exchange < l { self.first_exchange } else { l };
        if short == LOWER
            && let Some(x) = b.first_chunk_mut::<LOWER>()
        {
            for i in 1..LOWER {
                let row = &self.data[i * width..][..LOWER];
                let mut sum = x[i];
                for j in 0..i {
                    sum -= row[LOWER - i + j] * x[j];
                }
                x[i] = sum;
            }
        } else {
            for i in 0..short {
                b[i] = forward_products(b[i], &self.data[i * width + l - i..i * width + l], &b[..i]);
            }
        }
        let rows = self.data[short * width..self.first_exchange * width].chunks_exact(width);
        for (i, row) in rows.enumerate() {
            let (x, b) = b[i..].split_at_mut(l);
            let sum = match (row.first_chunk::<LOWER>(), x.first_chunk::<LOWER>()) {
                (Some(row), Some(x)) if LOWER > 0 => forward_products(b[0], row, x),
                _ => forward_products(b[0], &row[..l], x),
            };
            b[0] = sum;
        }
    }

    /// From the first exchange on: the columns before it, and then column by column, each after its exchange.
    fn forward_interchanged(&self, b: &mut [T]) {
        let (l, width, start) = (self.lower, self.width, self.first_exchange);
        for i in start..(start + l).min(self.n) {
            let first = i.saturating_sub(l);
            let row = &self.data[i * width + l + first - i..i * width + l + start - i];
            b[i] = forward_products(b[i], row, &b[first..start]);
        }
        for k in start..self.n {
            let p = self.pivots[k] as usize;
            if p != 0 {
                b.swap(k, k + p);
            }
            let bk = b[k];
            let last = (k + l).min(self.n - 1);
            let mut at = (k + 1) * width + l;
            for x in &mut b[k + 1..last + 1] {
                at -= 1;
                *x -= self.data[at] * bk;
                at += width;
            }
        }
    }

    /// b ← U⁻¹ b after factoring.
    pub fn backward(&self, b: &mut [T]) {
        match self.upper {
            3 => self.backward_by_rows::<3>(b),
            5 => self.backward_by_rows::<5>(b),
            7 => self.backward_by_rows::<7>(b),
            9 => self.backward_by_rows::<9>(b),
            15 => self.backward_by_rows::<15>(b),
            23 => self.backward_by_rows::<23>(b),
            _ => self.backward_by_rows::<0>(b),
        }
    }

    /// `UPPER` is the length of the rows before the first exchange, but for the last ones, or 0.
    fn backward_by_rows<const UPPER: usize>(&self, b: &mut [T]) {
        let (n, l, width) = (self.n, self.lower, self.width);
        let common = if UPPER > 0 { self.first_exchange.min(n.saturating_sub(UPPER)) } else { 0 };
        let short = &self.data[common * width..];
        if self.first_exchange == n
            && common + UPPER == n
            && let Some(x) = b.last_chunk_mut::<UPPER>()
        {
            for k in (0..UPPER).rev() {
                let row = &short[k * width + l..][..UPPER + 1];
                let mut sum = x[k];
                for j in (k + 1..UPPER).rev() {
                    sum -= row[j - k] * x[j];
                }
                x[k] = sum * row[0];
            }
        } else {
            for k in (common..n).rev() {
                let longest = if k < self.first_exchange { self.upper } else { width - l - 1 };
                let row = &self.data[k * width + l..k * width + l + 1 + longest.min(n - 1 - k)];
                b[k] = backward_products(b[k], &row[1..], &b[k + 1..k + row.len()]) * row[0];
            }
        }
        for (k, row) in self.data[..common * width].chunks_exact(width).enumerate().rev() {
            let (x, tail) = b[k..].split_at_mut(1);
            let (pivot, row) = (row[l], &row[l + 1..]);
            if let (Some(row), Some(tail)) = (row.first_chunk::<UPPER>(), tail.first_chunk::<UPPER>()) {
                x[0] = backward_products(x[0], row, tail) * pivot;
            }
        }
    }

    /// Solves A x = b in place after [`Band::factor`].
    pub fn solve(&self, b: &mut [T]) {
        self.forward(b);
        self.backward(b);
    }
}

/// sum − Σ aⱼ xⱼ, first to last: the newest of the x, for which the sum has to wait, comes last.
#[inline(always)]
fn forward_products<T: Scalar>(mut sum: T, a: &[T], x: &[T]) -> T {
    for (a, x) in a.iter().zip(x) {
        sum -= *a * *x;
    }
    sum
}

/// sum − Σ aⱼ xⱼ, last to first: here the newest is the first.
#[inline(always)]
fn backward_products<T: Scalar>(mut sum: T, a: &[T], x: &[T]) -> T {
    for (a, x) in a.iter().zip(x).rev() {
        sum -= *a * *x;
    }
    sum
}
