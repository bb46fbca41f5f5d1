//! A band matrix with a few dense rows and columns, eliminated by block elimination.
//!
//! ```text
//! [ B  U ] [x]   [b]        S = D − V B⁻¹ U,   y = S⁻¹ (c − V B⁻¹ b),   x = B⁻¹ (b − U y)
//! [ V  D ] [y] = [c]
//! ```
//!
//! A border unknown that couples to nothing, as the multiplier of a contact that is open, is its diagonal alone: it has no row, no column and no
//! place in S, and costs one division.
//!
//! B itself may be singular though the whole is not (a free body whose only hold is in the border).
//! Pivots of B that vanish are then replaced, and for each a further border row and column restores
//! the original matrix: B x = B̃ x − (L e_k) z with z = δ x_k.

use super::band::DEFLATIONS;
use super::{Band, Dense, NOTHING, Scalar, Singular};

/// Border unknowns for which there is room from the start; more is made when more couple to something.
const ROOM: usize = 16;

/// The slot of a border unknown that couples to nothing.
const NONE: u32 = u32::MAX;

/// Band matrix of order `n` bordered by `m` dense rows and columns.
#[derive(Clone, Debug)]
pub struct Bordered<T> {
    band: Band<T>,
    border: usize,
    /// The slot of each border unknown that couples to others, the unknown of each slot, and slots for which there is room.
    slots: Vec<u32>,
    coupled: Vec<u32>,
    room: usize,
    /// The diagonal entries of the others.
    diagonal: Vec<T>,
    /// U, slot after slot (room × n).
    columns: Vec<T>,
    /// V, slot after slot (room × n).
    rows: Vec<T>,
    /// D by slots (room × room).
    corner: Vec<T>,
    /// Coupled unknowns, ascending, as they stand in what follows.
    order: Vec<u32>,
    /// B⁻¹ U, column after column, deflation columns behind.
    reduced: Vec<T>,
    /// Schur complement.
    schur: Dense<T>,
    /// Right-hand side of the Schur complement.
    small: Vec<T>,
}

impl<T: Scalar> Bordered<T> {
    /// The zero matrix with a band of order `n` and a border of width `border`.
    pub fn new(n: usize, lower: usize, upper: usize, border: usize) -> Bordered<T> {
        let band = Band::new(n, lower, upper);
        let room = border.min(ROOM);
        // Without a border there is nothing to deflate with.
        let further = if border > 0 { room + DEFLATIONS } else { 0 };
        Bordered {
            band: if border > 0 { band.deflatable() } else { band },
            border,
            slots: vec![NONE; border],
            coupled: Vec::with_capacity(border),
            room,
            diagonal: vec![T::ZERO; border],
            columns: vec![T::ZERO; n * room],
            rows: vec![T::ZERO; n * room],
            corner: vec![T::ZERO; room * room],
            order: Vec::with_capacity(border),
            reduced: vec![T::ZERO; n * further],
            schur: Dense::new(further),
            small: vec![T::ZERO; further],
        }
    }

    /// The band.
    pub fn band(&self) -> &Band<T> {
        &self.band
    }

    /// The band, to be changed.
    pub fn band_mut(&mut self) -> &mut Band<T> {
        &mut self.band
    }

    /// The slot of border unknown `k`, if it couples to others.
    fn slot(&self, k: usize) -> Option<usize> {
        (self.slots[k] != NONE).then_some(self.slots[k] as usize)
    }

    /// The slot of border unknown `k`, which begins to couple to others.
    fn couple(&mut self, k: usize) -> usize {
        if let Some(slot) = self.slot(k) {
            return slot;
        }
        let (n, slot) = (self.band.order(), self.coupled.len());
        if slot == self.room {
            let room = (2 * slot).min(self.border);
            let mut corner = vec![T::ZERO; room * room];
            for (from, to) in self.corner.chunks_exact(slot).zip(corner.chunks_exact_mut(room)) {
                to[..slot].copy_from_slice(from);
            }
            self.corner = corner;
            self.columns.resize(n * room, T::ZERO);
            self.rows.resize(n * room, T::ZERO);
            self.reduced.resize(n * (room + DEFLATIONS), T::ZERO);
            self.small.resize(room + DEFLATIONS, T::ZERO);
            self.room = room;
        }
        self.slots[k] = slot as u32;
        self.coupled.push(k as u32);
        self.corner[slot * self.room + slot] = std::mem::replace(&mut self.diagonal[k], T::ZERO);
        slot
    }

    /// The column of slot `k`.
    fn column(&self, slot: usize) -> &[T] {
        let n = self.band.order();
        &self.columns[slot * n..(slot + 1) * n]
    }

    /// The row of slot `k`.
    fn row(&self, slot: usize) -> &[T] {
        let n = self.band.order();
        &self.rows[slot * n..(slot + 1) * n]
    }

    /// Border column `k` (length of the band).
    pub fn column_mut(&mut self, k: usize) -> &mut [T] {
        let (n, slot) = (self.band.order(), self.couple(k));
        &mut self.columns[slot * n..(slot + 1) * n]
    }

    /// Border row `k` (length of the band).
    pub fn row_mut(&mut self, k: usize) -> &mut [T] {
        let (n, slot) = (self.band.order(), self.couple(k));
        &mut self.rows[slot * n..(slot + 1) * n]
    }

    /// Corner entry (i, j) of the border.
    fn corner(&self, i: usize, j: usize) -> T {
        match (self.slot(i), self.slot(j)) {
            (Some(a), Some(b)) => self.corner[a * self.room + b],
            _ if i == j => self.diagonal[i],
            _ => T::ZERO,
        }
    }

    /// Sets corner entry (i, j) of the border.
    pub fn set_corner(&mut self, i: usize, j: usize, x: T) {
        if i == j && self.slot(i).is_none() {
            self.diagonal[i] = x;
            return;
        }
        let (a, b) = (self.couple(i), self.couple(j));
        self.corner[a * self.room + b] = x;
    }

    /// Order of the whole matrix.
    pub fn order(&self) -> usize {
        self.band.order() + self.border
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.band.clear();
        let (n, used) = (self.band.order(), self.coupled.len());
        self.columns[..n * used].fill(T::ZERO);
        self.rows[..n * used].fill(T::ZERO);
        for row in self.corner.chunks_exact_mut(self.room.max(1)).take(used) {
            row[..used].fill(T::ZERO);
        }
        self.diagonal.fill(T::ZERO);
        self.coupled.drain(..).for_each(|k| self.slots[k as usize] = NONE);
    }

    /// Entry (i, j), zero outside band and border.
    pub fn get(&self, i: usize, j: usize) -> T {
        let n = self.band.order();
        match (i < n, j < n) {
            (true, true) => self.band.get(i, j),
            (true, false) => self.slot(j - n).map_or(T::ZERO, |slot| self.column(slot)[i]),
            (false, true) => self.slot(i - n).map_or(T::ZERO, |slot| self.row(slot)[j]),
            (false, false) => self.corner(i - n, j - n),
        }
    }

    /// Adds `x` to entry (i, j), which must lie within band or border.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, x: T) {
        let n = self.band.order();
        if i < n && j < n {
            self.band.add(i, j, x);
        } else if x != T::ZERO {
            self.add_outside(i, j, x);
        }
    }

    /// The same within the border.
    fn add_outside(&mut self, i: usize, j: usize, x: T) {
        let n = self.band.order();
        if i < n {
            self.column_mut(j - n)[i] += x;
        } else if j < n {
            self.row_mut(i - n)[j] += x;
        } else if i == j && self.slots[i - n] == NONE {
            self.diagonal[i - n] += x;
        } else {
            let (a, b) = (self.couple(i - n), self.couple(j - n));
            self.corner[a * self.room + b] += x;
        }
    }

    /// Calls `f` with the place and the value of every entry that is stored.
    pub(super) fn each_mut(&mut self, mut f: impl FnMut(usize, usize, &mut T)) {
        let (n, lower, upper) = (self.band.order(), self.band.lower(), self.band.upper());
        for (i, row) in self.band.rows_mut().enumerate() {
            let first = i.saturating_sub(lower);
            let within = first..(i + upper + 1).min(n);
            within.zip(&mut row[first + lower - i..]).for_each(|(j, x)| f(i, j, x));
        }
        for (slot, &k) in self.coupled.iter().enumerate() {
            let (of, k) = (slot * n..(slot + 1) * n, n + k as usize);
            self.columns[of.clone()].iter_mut().enumerate().for_each(|(i, x)| f(i, k, x));
            self.rows[of].iter_mut().enumerate().for_each(|(j, x)| f(k, j, x));
            let corner = &mut self.corner[slot * self.room..(slot + 1) * self.room];
            self.coupled.iter().zip(corner).for_each(|(j, x)| f(k, n + *j as usize, x));
        }
        for (k, x) in self.diagonal.iter_mut().enumerate().filter(|(k, _)| self.slots[*k] == NONE) {
            f(n + k, n + k, x);
        }
    }

    /// Takes the content of another of the same structure, before factoring.
    pub(super) fn copy_from(&mut self, other: &Bordered<T>) {
        self.clear();
        self.band.copy_from(&other.band);
        self.diagonal.clone_from(&other.diagonal);
        for (slot, &k) in other.coupled.iter().enumerate() {
            let k = k as usize;
            self.column_mut(k).copy_from_slice(other.column(slot));
            self.row_mut(k).copy_from_slice(other.row(slot));
            for &j in &other.coupled {
                self.set_corner(k, j as usize, other.corner(k, j as usize));
            }
        }
    }

    /// Replaces the content by Σ wₖ Aₖ of real matrices of the same structure.
    pub(super) fn combine(&mut self, terms: [&Bordered<f64>; 3], weights: [T; 3]) {
        let sum = |x: [f64; 3]| weights[0].times(x[0]) + (weights[1].times(x[1]) + weights[2].times(x[2]));
        self.clear();
        self.band.combine(terms.map(|a| &a.band), weights);
        let n = self.band.order();
        for k in 0..self.border {
            let slots = terms.map(|a| a.slot(k));
            if slots == [None; 3] {
                self.diagonal[k] = sum(terms.map(|a| a.diagonal[k]));
                continue;
            }
            let entry = |of: fn(&Bordered<f64>, usize) -> &[f64], i: usize| {
                let at = |t: usize| slots[t].map_or(0.0, |slot| of(terms[t], slot)[i]);
                sum([at(0), at(1), at(2)])
            };
            let slot = self.couple(k);
            for i in 0..n {
                self.columns[slot * n + i] = entry(Bordered::column, i);
                self.rows[slot * n + i] = entry(Bordered::row, i);
            }
        }
        for a in 0..self.coupled.len() {
            for b in 0..self.coupled.len() {
                let [i, j] = [a, b].map(|slot| self.coupled[slot] as usize);
                self.corner[a * self.room + b] = sum(terms.map(|term| term.corner(i, j)));
            }
        }
    }

    /// y = A x, before factoring.
    pub fn multiply(&self, x: &[T], y: &mut [T]) {
        let n = self.band.order();
        let (xb, xs) = x.split_at(n);
        let (yb, ys) = y.split_at_mut(n);
        self.band.multiply(xb, yb);
        for (y, (d, x)) in ys.iter_mut().zip(self.diagonal.iter().zip(xs)) {
            *y = *d * *x;
        }
        for (slot, &k) in self.coupled.iter().enumerate() {
            for (y, u) in yb.iter_mut().zip(self.column(slot)) {
                *y += *u * xs[k as usize];
            }
            let mut sum = T::ZERO;
            for (v, x) in self.row(slot).iter().zip(xb) {
                sum += *v * *x;
            }
            for (d, j) in self.corner[slot * self.room..].iter().zip(&self.coupled) {
                sum += *d * xs[*j as usize];
            }
            ys[k as usize] = sum;
        }
    }

    /// The same for x and y in another order: place k belongs to their entry `unknowns[k]`.
    pub(super) fn multiply_ordered(&self, unknowns: &[u32], x: &[T], y: &mut [T]) {
        let (inside, outside) = unknowns.split_at(self.band.order());
        let of = |row: &[T], unknowns: &[u32]| {
            row.iter().zip(unknowns).fold(T::ZERO, |sum, (a, j)| sum + *a * x[*j as usize])
        };
        for (i, &unknown) in inside.iter().enumerate() {
            let (first, row) = self.band.row(i);
            let mut sum = of(row, &inside[first..]);
            for (slot, &k) in self.coupled.iter().enumerate() {
                sum += self.column(slot)[i] * x[outside[k as usize] as usize];
            }
            y[unknown as usize] = sum;
        }
        for (&unknown, d) in outside.iter().zip(&self.diagonal) {
            y[unknown as usize] = *d * x[unknown as usize];
        }
        for (slot, &k) in self.coupled.iter().enumerate() {
            let mut sum = of(self.row(slot), inside);
            for (d, j) in self.corner[slot * self.room..].iter().zip(&self.coupled) {
                sum += *d * x[outside[*j as usize] as usize];
            }
            y[outside[k as usize] as usize] = sum;
        }
    }

    /// Factors in place.
    pub fn factor(&mut self) -> Result<(), Singular> {
        let n = self.band.order();
        self.band.factor(self.border > 0)?;
        if self.border == 0 {
            return Ok(());
        }
        let alone = |k: &usize| self.slots[*k] == NONE && !(self.diagonal[*k].size() > NOTHING);
        if let Some(k) = (0..self.border).find(alone) {
            return Err(Singular { index: n + k, pivot: self.diagonal[k].size() });
        }
        self.order.clear();
        self.order.extend(&self.coupled);
        self.order.sort_unstable();
        let (m, extra) = (self.order.len(), self.band.deflated().len());
        for k in 0..m {
            let slot = self.slots[self.order[k] as usize] as usize;
            let z = &mut self.reduced[k * n..(k + 1) * n];
            z.copy_from_slice(&self.columns[slot * n..(slot + 1) * n]);
            self.band.solve(z);
        }
        for k in 0..extra {
            let z = &mut self.reduced[(m + k) * n..(m + k + 1) * n];
            z.fill(T::ZERO);
            z[self.band.deflated()[k].0] = -T::ONE;
            self.band.backward(z);
        }
        self.schur.resize(m + extra);
        for j in 0..m + extra {
            let z = &self.reduced[j * n..(j + 1) * n];
            for i in 0..m {
                let at = self.order[i] as usize;
                let mut sum = if j < m { self.corner(at, self.order[j] as usize) } else { T::ZERO };
                for (v, z) in self.row(self.slots[at] as usize).iter().zip(z) {
                    sum -= *v * *z;
                }
                self.schur.add(i, j, sum);
            }
            for (i, &(at, delta)) in self.band.deflated().iter().enumerate() {
                let corner = if j == m + i { -T::ONE } else { T::ZERO };
                self.schur.add(m + i, j, corner - T::real(delta) * z[at]);
            }
        }
        let (order, band) = (&self.order, &self.band);
        self.schur.factor().map_err(|e| {
            let index = match order.get(e.index) {
                Some(k) => n + *k as usize,
                None => band.deflated()[e.index - m].0,
            };
            Singular { index, pivot: e.pivot }
        })
    }

    /// Solves A x = b in place after [`Bordered::factor`].
    pub fn solve(&mut self, b: &mut [T]) {
        let n = self.band.order();
        if self.border == 0 {
            self.band.solve(b);
            return;
        }
        let (m, extra) = (self.order.len(), self.band.deflated().len());
        let (x, y) = b.split_at_mut(n);
        self.band.solve(x);
        for (i, &k) in self.order.iter().enumerate() {
            let k = k as usize;
            let mut sum = y[k];
            for (v, x) in self.row(self.slots[k] as usize).iter().zip(x.iter()) {
                sum -= *v * *x;
            }
            self.small[i] = sum;
        }
        for (i, &(at, delta)) in self.band.deflated().iter().enumerate() {
            self.small[m + i] = -T::real(delta) * x[at];
        }
        let small = &mut self.small[..m + extra];
        self.schur.solve(small);
        for ((y, d), slot) in y.iter_mut().zip(&self.diagonal).zip(&self.slots) {
            if *slot == NONE {
                *y = *y / *d;
            }
        }
        for (k, s) in self.order.iter().zip(small.iter()) {
            y[*k as usize] = *s;
        }
        for (k, s) in small.iter().enumerate() {
            for (x, z) in x.iter_mut().zip(&self.reduced[k * n..(k + 1) * n]) {
                *x -= *z * *s;
            }
        }
    }
}
