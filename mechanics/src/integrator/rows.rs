//! The rows of constraints in the linear systems of a step.
//!
//! With the tangent A of the velocities' equations and the jacobian G,
//!
//! ```text
//! ⎡ A  −Gᵀ ⎤ ⎡Δ ⎤     ⎡ r  ⎤        active rows: c₀ g + c₁ ġ + c₂ g̈ = 0
//! ⎣ G   0  ⎦ ⎣Δλ⎦ = − ⎣ g* ⎦        other rows:  λᵢ = 0 (open), λᵢ ± μ λₙ = 0 (slip)
//! ```

use crate::linalg::{Matrix, Scalar};
use crate::system::{Dynamics, Mode, RowWeights, Set, State, is_active, replace_inactive, slip};

/// Rows of a system, with memory for their values and for a jacobian.
#[derive(Debug, Default)]
pub(super) struct Rows {
    sets: Vec<Set>,
    friction: bool,
    rates: Vec<f64>,
    /// Row, velocity and entry of a jacobian that was stored.
    jacobian: Vec<(usize, usize, f64)>,
    /// The same, row by row.
    by_row: Vec<(usize, usize, f64)>,
    /// Where the entries of each row begin there, and their end.
    begins: Vec<usize>,
}

impl Rows {
    pub(super) fn new(system: &mut dyn Dynamics, state: &State) -> Rows {
        let sets = system.rows().to_vec();
        let friction = sets.iter().any(|set| matches!(set, Set::Friction { .. }));
        let rates = vec![0.0; sets.len()];
        let begins = vec![0; sets.len() + 1];
        let mut rows = Rows { sets, friction, rates, begins, ..Rows::default() };
        rows.store_jacobian(system, state);
        rows
    }

    pub(super) fn len(&self) -> usize {
        self.sets.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.sets.is_empty()
    }

    /// `out` = g/`position` of the active rows, ġ/`velocity` of those of friction.
    pub(super) fn positions(
        &mut self,
        system: &mut dyn Dynamics,
        s: &State,
        [position, velocity]: [f64; 2],
        out: &mut [f64],
    ) {
        if self.is_empty() {
            return;
        }
        system.constraint(s, RowWeights::POSITION, out);
        out.iter_mut().for_each(|g| *g /= position);
        if self.friction {
            system.constraint(s, RowWeights::VELOCITY, &mut self.rates);
            for ((set, g), rate) in self.sets.iter().zip(out.iter_mut()).zip(&self.rates) {
                if matches!(set, Set::Friction { .. }) {
                    *g = rate / velocity;
                }
            }
        }
        replace_inactive(&self.sets, s, out);
    }

    /// `out` = (c₀ g + c₁ ġ + c₂ g̈)/`scale` of the active rows.
    pub(super) fn weighted(
        &self,
        system: &mut dyn Dynamics,
        s: &State,
        c: RowWeights,
        scale: f64,
        out: &mut [f64],
    ) {
        if self.is_empty() {
            return;
        }
        system.constraint(s, c, out);
        out.iter_mut().for_each(|g| *g /= scale);
        replace_inactive(&self.sets, s, out);
    }

    /// Adds −Gᵀ, G and the equations of the other rows to a matrix whose multipliers begin at unknown `first`.
    pub(super) fn add_border<T: Scalar>(
        &self,
        system: &mut dyn Dynamics,
        s: &State,
        first: usize,
        out: &mut Matrix<T>,
    ) {
        let sets = &self.sets;
        system.jacobian(s, &mut |row, velocities, entries| {
            let active = is_active(sets[row], s.mode[row]);
            for (&j, &x) in velocities.iter().zip(entries) {
                if s.mode[row] != Mode::Open {
                    out.add(j, first + row, T::real(-x));
                }
                if active {
                    out.add(first + row, j, T::real(x));
                }
            }
        });
        for (i, set) in sets.iter().enumerate().filter(|(i, set)| !is_active(**set, s.mode[*i])) {
            out.add(first + i, first + i, T::ONE);
            if let (Some(normal), slope) = slip(*set, s.mode[i]) {
                out.add(first + i, first + normal, T::real(slope));
            }
        }
    }

    /// Removes the stored entries of Gᵀ from the equation of velocity `j`.
    pub(super) fn remove_from_equation(&self, s: &State, j: usize, first: usize, out: &mut Matrix) {
        let of_equation =
            |(row, velocity, _): &&(usize, usize, f64)| *velocity == j && s.mode[*row] != Mode::Open;
        for &(row, ..) in self.jacobian.iter().filter(of_equation) {
            let entry = out.get(j, first + row);
            out.add(j, first + row, -entry);
        }
    }

    /// Stores the jacobian at `s`.
    pub(super) fn store_jacobian(&mut self, system: &mut dyn Dynamics, s: &State) {
        let Rows { jacobian, by_row, begins, .. } = self;
        jacobian.clear();
        system.jacobian(s, &mut |row, velocities, entries| {
            jacobian.extend(velocities.iter().zip(entries).map(|(&j, &x)| (row, j, x)));
        });
        // A row may be shown in parts: they are counted, and then put in their places.
        begins.fill(0);
        jacobian.iter().for_each(|(row, ..)| begins[row + 1] += 1);
        (1..begins.len()).for_each(|row| begins[row] += begins[row - 1]);
        by_row.resize(jacobian.len(), (0, 0, 0.0));
        for entry in jacobian.iter() {
            by_row[begins[entry.0]] = *entry;
            begins[entry.0] += 1;
        }
        // Each begin is the end of its row now, and so the begin of the next.
        begins.rotate_right(1);
        begins[0] = 0;
    }

    /// Entries (row, velocity, value) of the stored jacobian.
    pub(super) fn stored(&self) -> &[(usize, usize, f64)] {
        &self.jacobian
    }

    /// The stored entries of a row.
    pub(super) fn of_row(&self, row: usize) -> &[(usize, usize, f64)] {
        &self.by_row[self.begins[row]..self.begins[row + 1]]
    }

    /// Adds `c` Gᵀ x with the stored jacobian.
    pub(super) fn add_transposed(&self, c: f64, x: &[f64], out: &mut [f64]) {
        for &(row, j, entry) in &self.jacobian {
            out[j] += c * entry * x[row];
        }
    }

    pub(super) fn sets(&self) -> &[Set] {
        &self.sets
    }
}
