//! The rows of joints and closed contacts in the equations of an equilibrium, and the motions that they allow.

use crate::linalg::{Matrix, Structure};
use crate::system::{
    Dynamics, Events, Frame, Observed, RowWeights, Set, Size, State, Steady, System, Weights, is_active,
};
use nalgebra::DMatrix;

/// Part of a motion, over its largest, that counts as allowed or forbidden by rounding.
const ROUNDING: f64 = 1e-9;

/// Whether the position of a row is imposed.
fn holds(set: Set, s: &State, row: usize) -> bool {
    is_active(set, s.mode[row]) && !matches!(set, Set::Friction { .. })
}

/// Writes g of the rows that hold, and λ of the others, whose equation is λ = 0.
pub(super) fn positions(system: &mut dyn Dynamics, s: &State, out: &mut [f64]) {
    if out.is_empty() {
        return;
    }
    system.constraint(s, RowWeights::POSITION, out);
    for (i, (set, out)) in system.rows().iter().zip(out).enumerate() {
        if !holds(*set, s, i) {
            *out = s.lambda[i];
        }
    }
}

/// Adds −Gᵀ, G and the equations of the rows that do not hold to a matrix whose multipliers begin at unknown `n`.
pub(super) fn add(system: &mut dyn Dynamics, s: &State, n: usize, matrix: &mut Matrix) {
    let held: Vec<bool> = system.rows().iter().enumerate().map(|(i, set)| holds(*set, s, i)).collect();
    system.jacobian(s, &mut |row, velocities, entries| {
        for (&j, &x) in velocities.iter().zip(entries).filter(|_| held[row]) {
            matrix.add(n + row, j, x);
            matrix.add(j, n + row, -x);
        }
    });
    for i in (0..held.len()).filter(|i| !held[*i]) {
        matrix.add(n + i, n + i, 1.0);
    }
}

/// Adds to the multipliers those that leave the least of the residual, |S (r − Gᵀ Δλ)| with the scales S of the unknowns.
/// Nothing happens where the rows depend on each other.
pub(super) fn balance(system: &mut dyn Dynamics, s: &mut State) {
    let (n, m) = (s.v.len(), s.lambda.len());
    if m == 0 {
        return;
    }
    let mut r = vec![0.0; n + m];
    system.residual(s, &mut r);
    r[n..].fill(0.0);
    let mut matrix = Matrix::new(&system.structure(1));
    matrix.clear();
    for (i, scale) in system.scales().iter().enumerate() {
        matrix.add(i, i, 1.0 / (scale * scale));
    }
    add(system, s, n, &mut matrix);
    if matrix.factor().is_ok() {
        matrix.solve(&mut r);
        s.lambda.iter_mut().zip(&r[n..]).for_each(|(lambda, x)| *lambda -= x);
    }
}

/// A system on the motions x = N y that its rows allow at one state: M, C and K are Nᵀ M N and so on.
pub(super) struct Allowed<'a> {
    inner: &'a mut dyn System,
    /// N.
    motions: DMatrix<f64>,
    scales: Vec<f64>,
    full: Matrix,
}

impl<'a> Allowed<'a> {
    /// N: an orthonormal basis, in units of the scales, of the null space of G.
    pub(super) fn new(inner: &'a mut dyn System, s: &State) -> Allowed<'a> {
        let (n, m) = (s.v.len(), s.lambda.len());
        let scale = inner.scales().to_vec();
        let mut g: DMatrix<f64> = DMatrix::zeros(m, n);
        let held: Vec<bool> = inner.rows().iter().enumerate().map(|(i, set)| holds(*set, s, i)).collect();
        inner.jacobian(s, &mut |row, velocities, entries| {
            for (&j, &x) in velocities.iter().zip(entries).filter(|_| held[row]) {
                g[(row, j)] += x * scale[j];
            }
        });
        for mut row in g.row_iter_mut() {
            let size = row.norm();
            if size > 0.0 {
                row /= size;
            }
        }
        let parts = (g.transpose() * &g).symmetric_eigen();
        let largest = parts.eigenvalues.amax();
        let allowed: Vec<usize> =
            (0..n).filter(|i| parts.eigenvalues[*i].abs() <= ROUNDING * largest.max(1.0)).collect();
        let motions =
            DMatrix::from_fn(n, allowed.len(), |i, k| scale[i] * parts.eigenvectors[(i, allowed[k])]);
        let full = Matrix::new(&inner.structure(0));
        Allowed { inner, scales: vec![1.0; motions.ncols()], motions, full }
    }

    /// N y
    pub(super) fn lift<T: nalgebra::Scalar + Copy + std::iter::Sum>(
        &self,
        y: &[T],
        times: impl Fn(T, f64) -> T,
    ) -> Vec<T> {
        let row = |i: usize| y.iter().enumerate().map(|(k, y)| times(*y, self.motions[(i, k)])).sum();
        (0..self.motions.nrows()).map(row).collect()
    }

    /// The state with velocities and accelerations of as many entries as there are motions.
    pub(super) fn state(&self, s: &State) -> State {
        let zeros = vec![0.0; self.motions.ncols()];
        State { v: zeros.clone(), a: zeros, ..s.clone() }
    }

    fn full_state(&self, s: &State) -> State {
        let zeros = vec![0.0; self.motions.nrows()];
        State { v: zeros.clone(), a: zeros, ..s.clone() }
    }
}

impl Dynamics for Allowed<'_> {
    fn size(&self) -> Size {
        Size { v: self.motions.ncols(), lambda: 0, ..self.inner.size() }
    }

    fn structure(&self, _multipliers: usize) -> Structure {
        Structure::dense(self.motions.ncols())
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn is_vector_space(&self) -> bool {
        self.inner.is_vector_space()
    }

    fn retract(&self, q: &[f64], d: &[f64], out: &mut [f64]) {
        self.inner.retract(q, &self.lift(d, |y, x| y * x), out);
    }

    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let full = self.full_state(s);
        let mut all = vec![0.0; self.motions.nrows()];
        self.inner.residual(&full, &mut all);
        let product = self.motions.tr_mul(&nalgebra::DVector::from_vec(all));
        r.copy_from_slice(product.as_slice());
    }

    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        let full = self.full_state(s);
        self.inner.tangent(&full, Weights { increment: None, ..w }, &mut self.full);
        let n = self.motions.nrows();
        let (mut product, mut column) = (DMatrix::<f64>::zeros(n, self.motions.ncols()), vec![0.0; n]);
        for (mut image, motion) in product.column_iter_mut().zip(self.motions.column_iter()) {
            self.full.multiply(motion.into_owned().as_slice(), &mut column);
            image.copy_from_slice(&column);
        }
        let reduced = self.motions.tr_mul(&product);
        out.clear();
        for (j, column) in reduced.column_iter().enumerate() {
            column.iter().enumerate().for_each(|(i, x)| out.add(i, j, *x));
        }
    }
}

impl Events for Allowed<'_> {}

impl Steady for Allowed<'_> {
    fn hold(&mut self, held: bool) {
        self.inner.hold(held);
    }
}

impl Observed for Allowed<'_> {
    fn frames(&mut self, body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
        let full = self.full_state(s);
        self.inner.frames(body, &full, stations, out);
    }
}
