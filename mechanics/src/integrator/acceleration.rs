//! Accelerations of a given position and velocity: a = M⁻¹ f.

use super::rows::Rows;
use super::{Counters, StepError, failure};
use crate::linalg::{Matrix, Singular, Structure};
use crate::system::{Dynamics, RowWeights, State, Weights, is_active};
use std::ops::Range;

/// Corrections by which unknowns without mass are put in equilibrium.
const CORRECTIONS: usize = 20;
/// Last correction over the scale of the unknown.
const SETTLED: f64 = 1e-13;

/// Solver of
///
/// ```text
/// ⎡ M  −Gᵀ⎤ ⎡a⎤     ⎡ r(t, q, v, a = 0, λ = 0)       ⎤
/// ⎣ G   0 ⎦ ⎣λ⎦ = − ⎣ c₀ g + c₁ ġ + g̈(t, q, v, a = 0) ⎦
/// ```
///
/// for the acceleration a and the multipliers λ consistent with t, q, v; c₀ = c₁ = 0 but for Baumgarte's stabilization.
/// The residual is linear in a and λ, so one solution is exact. A mass matrix that its stamp shows to be unchanged is
/// not factored again.
///
/// Unknowns C without mass, whose rows of M are zero, have the equations f_C(q, v) + G_Cᵀ λ = 0. A combination nᵀ of them with
/// G_C n = 0 is free of λ. Where it has no damping it gives q_C by Newton's method, and v_C, a_C by nᵀK_C v = 0 and
/// nᵀK_C a = 0, its derivatives for constant K; where it has, v_C and nᵀ(C_C a + K_C v) = 0.
#[derive(Debug)]
pub(crate) struct Accelerations {
    matrix: Matrix,
    rhs: Vec<f64>,
    pub(super) rows: Rows,
    weights: RowWeights,
    massless: Option<Box<Massless>>,
}

/// Memory for unknowns without mass.
#[derive(Debug)]
struct Massless {
    stiffness: Matrix,
    damping: Matrix,
    /// Unknowns without mass, and the combinations of their equations that are free of multipliers.
    unknowns: Vec<usize>,
    free: Vec<Combination>,
    /// Reduced rows of G_C, one behind the other, their pivots, and what the combinations hold.
    reduced: Vec<f64>,
    pivots: Vec<usize>,
    held: Vec<(usize, f64)>,
    increment: Vec<f64>,
    q: Vec<f64>,
}

/// nᵀ r_C = r_c − Σ ratio r_p: an equation of equilibrium.
#[derive(Debug)]
struct Combination {
    /// c, whose equation it replaces.
    unknown: usize,
    /// Where the held unknowns p stand, with their ratios.
    held: Range<usize>,
    /// Whether the velocity, not the configuration, is in equilibrium.
    damped: bool,
    /// Factor that brings it to the size of the equations with mass.
    scale: f64,
}

impl Combination {
    /// nᵀ x, scaled.
    fn of(&self, held: &[(usize, f64)], x: impl Fn(usize) -> f64) -> f64 {
        let held = held[self.held.clone()].iter().map(|&(p, ratio)| ratio * x(p));
        self.scale * (x(self.unknown) - held.sum::<f64>())
    }
}

impl Accelerations {
    /// Allocates for `system`.
    pub(crate) fn new(system: &mut dyn Dynamics, state: &State, weights: RowWeights) -> Accelerations {
        let size = system.size();
        let (matrix, rhs) = (Matrix::new(&system.structure(1)), vec![0.0; size.v + size.lambda]);
        Accelerations { matrix, rhs, ..Accelerations::borrowing(system, state, weights) }
    }

    /// The same without matrix and vector, for [`Accelerations::complete_in`].
    pub(crate) fn borrowing(system: &mut dyn Dynamics, state: &State, weights: RowWeights) -> Accelerations {
        Accelerations {
            matrix: Matrix::new(&Structure::dense(0)),
            rhs: Vec::new(),
            rows: Rows::new(system, state),
            weights,
            massless: None,
        }
    }

    /// As [`Accelerations::complete`], with the memory of a matrix and a vector of (v, λ) whose content is lost.
    pub(crate) fn complete_in(
        &mut self,
        (matrix, rhs): (&mut Matrix, &mut Vec<f64>),
        system: &mut dyn Dynamics,
        state: &mut State,
        place: (f64, f64),
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        std::mem::swap(&mut self.matrix, matrix);
        std::mem::swap(&mut self.rhs, rhs);
        let result = self.complete(system, state, place, counters);
        std::mem::swap(&mut self.matrix, matrix);
        std::mem::swap(&mut self.rhs, rhs);
        result
    }

    /// Replaces `state.a` and `state.lambda` by the consistent ones. `from` and `step` are the start and
    /// the size of the step in which this happens, for messages.
    pub(crate) fn complete(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        (from, step): (f64, f64),
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let n = state.v.len();
        state.a.fill(0.0);
        state.lambda.fill(0.0);
        let (motion, constraints) = self.rhs.split_at_mut(n);
        system.residual(state, motion);
        self.rows.weighted(system, state, self.weights, 1.0, constraints);
        system.tangent(state, Weights::new(1.0, 0.0, 0.0), &mut self.matrix);
        if !self.rows.is_empty() {
            self.rows.add_border(system, state, n, &mut self.matrix);
        }
        let factored = match self.matrix.factor() {
            Ok(factored) => factored,
            Err(singular) if singular.pivot.is_finite() => {
                return self.complete_massless(system, state, (from, step), counters, singular);
            }
            Err(cause) => return Err(failure::singular(system, from, step, cause)),
        };
        self.matrix.solve(&mut self.rhs);
        self.take(state, counters, factored);
        if state.is_finite() { Ok(()) } else { Err(failure::not_finite(system, from, step, state)) }
    }

    /// Whether unknowns without mass have been found.
    pub(crate) fn is_massless(&self) -> bool {
        self.massless.is_some()
    }

    fn take(&self, state: &mut State, counters: &mut Counters, factored: bool) {
        let (a, lambda) = self.rhs.split_at(state.v.len());
        for (out, x) in state.a.iter_mut().zip(a).chain(state.lambda.iter_mut().zip(lambda)) {
            *out = -x;
        }
        counters.residuals += 1;
        counters.tangents += u64::from(factored);
        counters.factorizations += u64::from(factored);
        counters.solves += 1;
    }

    /// As [`Accelerations::complete`] with unknowns without mass; `singular` is why M could not be factored.
    fn complete_massless(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        (from, step): (f64, f64),
        counters: &mut Counters,
        singular: Singular,
    ) -> Result<(), StepError> {
        let n = state.v.len();
        let rows = self.rows.len();
        let work = self.massless.get_or_insert_with(|| {
            let matrix = || Matrix::new(&system.structure(0));
            let (increment, q) = (vec![0.0; n], state.q.clone());
            Box::new(Massless {
                stiffness: matrix(),
                damping: matrix(),
                unknowns: Vec::with_capacity(n),
                free: Vec::with_capacity(n),
                reduced: Vec::with_capacity(n * rows),
                pivots: Vec::with_capacity(rows),
                held: Vec::with_capacity(n * rows),
                increment,
                q,
            })
        });
        system.tangent(state, Weights::new(1.0, 0.0, 0.0), &mut self.matrix);
        system.tangent(state, Weights::new(0.0, 1.0, 0.0), &mut work.damping);
        system.tangent(state, Weights::new(0.0, 0.0, 1.0), &mut work.stiffness);
        self.rows.store_jacobian(system, state);
        work.find(&self.matrix, &self.rows, state);
        if work.unknowns.is_empty() {
            return Err(failure::singular(system, from, step, singular));
        }
        if !self.rows.is_empty() {
            self.rows.add_border(system, state, n, &mut self.matrix);
        }
        for combination in &work.free {
            let (c, row) = (combination.unknown, work.row(combination));
            for j in 0..n {
                let x = combination.of(&work.held, |i| row.get(i, j));
                if x != 0.0 {
                    self.matrix.add(c, j, x);
                }
            }
            self.rows.remove_from_equation(state, c, n, &mut self.matrix);
        }
        self.matrix.factor().map_err(|e| failure::singular(system, from, step, e))?;
        // Equilibrium of the unknowns without mass: what has mass does not move.
        let mut size = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            self.rhs.fill(0.0);
            state.a.fill(0.0);
            state.lambda.fill(0.0);
            system.residual(state, &mut work.increment);
            for combination in &work.free {
                self.rhs[combination.unknown] = -combination.of(&work.held, |i| work.increment[i]);
            }
            self.matrix.solve(&mut self.rhs);
            counters.residuals += 1;
            counters.solves += 1;
            let damped = work.free.iter().any(|combination| combination.damped);
            work.increment.fill(0.0);
            size = 0.0;
            for &c in &work.unknowns {
                size = size.max((self.rhs[c] / system.scales()[c]).abs());
                let moved = if damped { &mut state.v[c] } else { &mut work.increment[c] };
                *moved += self.rhs[c];
            }
            system.retract(&state.q, &work.increment, &mut work.q);
            state.q.copy_from_slice(&work.q);
            if !(size > SETTLED) {
                break;
            }
        }
        if !(size <= 1e4 * SETTLED) {
            let worst = "unknowns without mass, which find no equilibrium".to_owned();
            return Err(StepError::Singular { time: from, step, pivot: 0.0, worst });
        }
        work.velocities(&mut self.matrix, &mut self.rhs, state);
        // Accelerations, with −C_c a = K_c v where there is damping.
        let (motion, constraints) = self.rhs.split_at_mut(n);
        system.residual(state, motion);
        work.stiffness.multiply(&state.v, &mut work.increment);
        for combination in &work.free {
            let rate =
                if combination.damped { combination.of(&work.held, |i| work.increment[i]) } else { 0.0 };
            motion[combination.unknown] = rate;
        }
        self.rows.weighted(system, state, self.weights, 1.0, constraints);
        self.matrix.solve(&mut self.rhs);
        self.take(state, counters, true);
        if state.is_finite() { Ok(()) } else { Err(failure::not_finite(system, from, step, state)) }
    }
}

impl Massless {
    /// K, or C where the combination has damping.
    fn row(&self, combination: &Combination) -> &Matrix {
        if combination.damped { &self.damping } else { &self.stiffness }
    }

    /// Finds the unknowns whose row of `mass` is zero, and by elimination in G_C the combinations of their equations.
    fn find(&mut self, mass: &Matrix, rows: &Rows, state: &State) {
        let n = state.v.len();
        let zero = |c: &usize| mass.get(*c, *c) == 0.0 && (0..n).all(|j| mass.get(*c, j) == 0.0);
        self.unknowns.clear();
        self.unknowns.extend((0..n).filter(zero));
        // Reduced row echelon form of G_C: pivots are held.
        let width = self.unknowns.len().max(1);
        self.reduced.clear();
        self.pivots.clear();
        for i in (0..rows.len()).filter(|i| is_active(rows.sets()[*i], state.mode[*i])) {
            let entry = |c: &usize| {
                let entries = rows.of_row(i).iter().filter(|(_, j, _)| j == c);
                entries.map(|(_, _, x)| x).sum::<f64>()
            };
            self.reduced.extend(self.unknowns.iter().map(entry));
            let (before, row) = self.reduced.split_at_mut(width * self.pivots.len());
            for (pivot, reduced) in self.pivots.iter().zip(before.chunks_exact(width)) {
                let factor = row[*pivot];
                row.iter_mut().zip(reduced).for_each(|(x, r)| *x -= factor * r);
            }
            let largest = row.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
            let Some((pivot, value)) = largest.map(|(k, x)| (k, *x)).filter(|(_, x)| *x != 0.0) else {
                self.reduced.truncate(width * self.pivots.len());
                continue;
            };
            row.iter_mut().for_each(|x| *x /= value);
            for other in before.chunks_exact_mut(width) {
                let factor = other[pivot];
                other.iter_mut().zip(&*row).for_each(|(x, r)| *x -= factor * r);
            }
            self.pivots.push(pivot);
        }
        self.free.clear();
        self.held.clear();
        for (k, &unknown) in self.unknowns.iter().enumerate().filter(|(k, _)| !self.pivots.contains(k)) {
            let start = self.held.len();
            let rows = self.reduced.chunks_exact(width);
            self.held.extend(self.pivots.iter().zip(rows).map(|(p, row)| (self.unknowns[*p], row[k])));
            let damped = self.damping.get(unknown, unknown) != 0.0;
            let row = if damped { &self.damping } else { &self.stiffness };
            let largest = (0..n).fold(f64::MIN_POSITIVE, |x, j| x.max(row.get(unknown, j).abs()));
            let scale = (0..n).fold(0.0_f64, |x, j| x.max(mass.get(j, j))) / largest;
            self.free.push(Combination { unknown, held: start..self.held.len(), damped, scale });
        }
    }

    /// v_C of nᵀK_C v = 0, where there is no damping.
    fn velocities(&mut self, matrix: &mut Matrix, rhs: &mut [f64], state: &mut State) {
        if self.free.iter().any(|combination| combination.damped) {
            return;
        }
        self.stiffness.multiply(&state.v, &mut self.increment);
        rhs.fill(0.0);
        for combination in &self.free {
            rhs[combination.unknown] = -combination.of(&self.held, |i| self.increment[i]);
        }
        matrix.solve(rhs);
        for &c in &self.unknowns {
            state.v[c] += rhs[c];
        }
    }
}
