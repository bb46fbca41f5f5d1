//! Contact multipliers in a linear system of a step: those that lie in their sets.
//!
//! With the factored matrix A of a Newton iteration, the jacobian G of the rows that take part, and the increment x without
//! a change of multipliers, the new multipliers P solve
//!
//! ```text
//! u = value + G x + W (P − P₀),   W = G A⁻¹ Gᵀ,   u and P complementary in the set of each row
//! ```
//!
//! and the increment becomes x + A⁻¹ Gᵀ (P − P₀). See the [cone problem](crate::contact::Few). Of many rows W is not formed, but the motion
//! that they make is found with A itself ([`Augmented`]).

use super::rows::Rows;
use crate::contact::{Augmented, FEW, Few, RowLaw, Unresolved};
use crate::linalg::Matrix;
use crate::system::{Dynamics, Set};

/// Part of the largest closing speed that contacts may leave at the end of an iteration, and that times the step over the largest scale of an unknown.
const LEFT: [f64; 2] = [0.1, 1e-9];

/// How fast contacts close before each problem of an iteration.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Closing {
    largest: f64,
    last: (usize, f64),
}

impl Closing {
    /// Takes what the problem solved last began with.
    pub(super) fn enter(&mut self, impulses: &Impulses) {
        self.last = impulses.worst;
        self.largest = self.largest.max(impulses.closing);
    }

    /// The row of a contact that no finite force stops, with values that are displacements of a step over `unit`: prescribed motions, or contacts on both sides, drive it.
    pub(super) fn driven(&self, unit: f64, scales: &[f64]) -> Option<usize> {
        let (row, left) = self.last;
        let scale = scales.iter().fold(0.0_f64, |most, scale| most.max(*scale));
        (left > LEFT[0] * self.largest && unit * left > LEFT[1] * scale).then_some(row)
    }
}

/// The rows that take part in a step, and memory for their problem.
#[derive(Debug)]
pub(super) struct Impulses {
    /// Rows that take part, their laws, W, b and multipliers.
    rows: Vec<usize>,
    laws: Vec<RowLaw>,
    w: Vec<f64>,
    b: Vec<f64>,
    solution: Vec<f64>,
    /// Of every row of the system the multiplier found last, or one like it.
    guess: Vec<f64>,
    /// A⁻¹ Gᵀ of each row.
    images: Vec<f64>,
    /// For many rows, whose products have room in A.
    many: Option<Augmented>,
    /// Unknowns up to the multiplier of the last joint: those of contacts behind it couple to nothing in A.
    leading: usize,
    few: Few,
    /// The row of a contact that closes fastest before the problem solved last, and how fast: what problems that went before have not stopped.
    worst: (usize, f64),
    /// How fast one closes before that problem and at the end of the increment that has no change of multipliers.
    closing: f64,
    /// What is left of the problem solved last where it has [not settled](Augmented::unsettled), over its largest multiplier; else 0.
    pub(super) residual: f64,
}

impl Impulses {
    /// Memory for the rows of a system and matrices of the given order.
    pub(super) fn new(system: &dyn Dynamics, order: usize) -> Impulses {
        let rows = system.rows();
        let contacts = rows.iter().filter(|set| **set != Set::Free).count();
        let joints = rows.iter().rposition(|set| *set == Set::Free).map_or(0, |last| last + 1);
        let many = contacts > FEW && system.contacts_are_local();
        // That of many rows is made when it is needed.
        let rows = if many { FEW } else { rows.len() };
        Impulses {
            many: many.then(|| Augmented::default().lenient()),
            leading: order.min(system.size().v + joints),
            few: Few::new(rows),
            worst: (0, 0.0),
            closing: 0.0,
            residual: 0.0,
            rows: Vec::with_capacity(rows),
            laws: Vec::with_capacity(rows),
            w: Vec::with_capacity(rows * rows),
            b: Vec::with_capacity(rows),
            solution: Vec::with_capacity(rows),
            guess: vec![0.0; system.rows().len()],
            images: vec![0.0; rows * order],
        }
    }

    /// Takes these multipliers of all rows for near to those that are sought.
    pub(super) fn guess(&mut self, multipliers: &[f64]) {
        self.guess.copy_from_slice(multipliers);
    }

    /// Number of rows that take part.
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Keeps the matrix of an iteration before it is factored, if it may be needed.
    pub(super) fn keep(&mut self, matrix: &Matrix) {
        if let Some(many) = &mut self.many {
            many.keep(matrix, self.leading);
        }
    }

    /// Chooses joints and contacts that take part; friction does with its normal.
    pub(super) fn choose(&mut self, sets: &[Set], takes_part: impl Fn(usize) -> bool) {
        self.rows.clear();
        self.laws.clear();
        for (i, set) in sets.iter().enumerate() {
            let law = match set {
                Set::Free => RowLaw::Free,
                Set::Unilateral { .. } => RowLaw::Unilateral,
                Set::Friction { .. } => continue,
            };
            if takes_part(i) {
                self.rows.push(i);
                self.laws.push(law);
            }
        }
        let normals = self.rows.len();
        for (i, set) in sets.iter().enumerate() {
            if let Set::Friction { coefficient, normal } = *set
                && let Ok(normal) = self.rows[..normals].binary_search(&normal)
            {
                self.rows.push(i);
                self.laws.push(RowLaw::Friction { coefficient, normal });
            }
        }
    }

    /// Solves for the multipliers `p` of the rows that take part and adds what their change does to the increment `x`;
    /// `jacobian` are the stored ones, and `value` gives the value of a row before the increment. The `residual` tells whether they have settled.
    pub(super) fn solve(
        &mut self,
        matrix: &mut Matrix,
        jacobian: &Rows,
        value: impl Fn(usize) -> f64,
        p: &mut [f64],
        x: &mut [f64],
    ) -> Result<(), Unresolved> {
        let (n, m) = (x.len(), self.rows.len());
        (self.residual, self.worst, self.closing) = (0.0, (0, 0.0), 0.0);
        if m == 0 {
            return Ok(());
        }
        let along = |row: usize, x: &[f64]| -> f64 {
            jacobian.of_row(row).iter().map(|&(_, j, entry)| entry * x[j]).sum()
        };
        for (&row, _) in self.rows.iter().zip(&self.laws).filter(|(_, law)| **law == RowLaw::Unilateral) {
            let closing = -value(row);
            if closing > self.worst.1 {
                self.worst = (row, closing);
            }
            self.closing = self.closing.max(closing).max(closing - along(row, x));
        }
        if m > FEW
            && Augmented::solves(&self.laws)
            && let Some(many) = &mut self.many
        {
            many.begin(&self.laws);
            self.b.clear();
            self.solution.clear();
            for &row in &self.rows {
                many.push(jacobian.of_row(row).iter().map(|&(_, j, entry)| (j, entry)));
                many.guess(self.guess[row]);
                self.b.push(value(row) + along(row, x));
                self.solution.push(p[row]);
            }
            if many.solve(matrix, &self.b, &mut self.solution, x).is_ok() {
                self.residual = many.unsettled;
                for (&row, x) in self.rows.iter().zip(&self.solution) {
                    (p[row], self.guess[row]) = (*x, *x);
                }
                return Ok(());
            }
        }
        self.w.clear();
        self.w.resize(m * m, 0.0);
        self.images.resize(self.images.len().max(m * n), 0.0);
        for (k, &row) in self.rows.iter().enumerate() {
            let image = &mut self.images[k * n..(k + 1) * n];
            image.fill(0.0);
            for &(_, j, entry) in jacobian.of_row(row) {
                image[j] += entry;
            }
            matrix.solve(image);
            for (l, &other) in self.rows.iter().enumerate() {
                self.w[l * m + k] = along(other, image);
            }
        }
        self.b.clear();
        self.solution.clear();
        self.solution.extend(self.rows.iter().map(|&row| p[row]));
        // In terms of the whole multipliers, not of their change.
        for (k, &row) in self.rows.iter().enumerate() {
            let part = self.w[k * m..(k + 1) * m].iter().zip(&self.solution);
            self.b.push(value(row) + along(row, x) - part.map(|(w, p)| w * p).sum::<f64>());
        }
        self.few.solve(&self.laws, &self.w, &self.b, &mut self.solution)?;
        for (k, &row) in self.rows.iter().enumerate() {
            let change = self.solution[k] - p[row];
            p[row] = self.solution[k];
            for (x, image) in x.iter_mut().zip(&self.images[k * n..(k + 1) * n]) {
                *x += change * image;
            }
        }
        Ok(())
    }
}
