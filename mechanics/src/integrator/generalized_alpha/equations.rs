//! The equations of a step: residual and tangent, with the rows of constraints and their stabilization.

use crate::integrator::acceleration::Accelerations;
use crate::integrator::rows::Rows;
use crate::integrator::{Checkpoint, Counters, NotResumed, StepError};
use crate::linalg::{Matrix, Singular};
use crate::system::{Dynamics, RowWeights, Set, Size, State, Weights, is_active};

/// Memory for the equations.
#[derive(Debug)]
pub(super) struct Equations {
    pub(super) tangent: Matrix,
    pub(super) rhs: Vec<f64>,
    pub(super) rows: Rows,
    /// Multipliers μ of the stabilized form, K, and the rows of Gₙ with an entry at each velocity.
    pub(super) mu: Vec<f64>,
    stiffness: Option<Matrix>,
    jacobian_columns: Vec<Vec<(usize, f64)>>,
    /// The start of the step of the kept tangent, with Gₙ, its increment, and its size.
    start: State,
    increment: Vec<f64>,
    step: f64,
    accelerations: Accelerations,
}

impl Equations {
    pub(super) fn new(system: &mut dyn Dynamics, state: &State, stabilized: bool) -> Equations {
        let size = system.size();
        let multipliers = if stabilized { 2 } else { 1 };
        let stabilized = stabilized && size.lambda > 0;
        let rows = Rows::new(system, state);
        let mut jacobian_columns = vec![Vec::new(); if stabilized { size.v } else { 0 }];
        for &(_, j, _) in rows.stored().iter().filter(|_| stabilized) {
            jacobian_columns[j].push((0, 0.0));
        }
        Equations {
            tangent: Matrix::new(&system.structure(multipliers)),
            rhs: vec![0.0; size.v + multipliers * size.lambda],
            accelerations: if stabilized {
                Accelerations::new(system, state, RowWeights::ACCELERATION)
            } else {
                Accelerations::borrowing(system, state, RowWeights::ACCELERATION)
            },
            rows,
            mu: vec![0.0; size.lambda],
            stiffness: stabilized.then(|| Matrix::new(&system.structure(0))),
            jacobian_columns,
            start: State::zeros(if stabilized { size } else { Size::default() }, state.t),
            increment: vec![0.0; size.v],
            step: 0.0,
        }
    }

    /// Consistent accelerations and multipliers of a state.
    pub(super) fn complete(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let place = (state.t, 0.0);
        if self.stiffness.is_some() {
            return self.accelerations.complete(system, state, place, counters);
        }
        let memory = (&mut self.tangent, &mut self.rhs);
        self.accelerations.complete_in(memory, system, state, place, counters)
    }

    /// Whether unknowns without mass have been found.
    pub(super) fn is_massless(&self) -> bool {
        self.accelerations.is_massless()
    }

    /// Whether velocities are held too.
    pub(super) fn is_stabilized(&self) -> bool {
        self.stiffness.is_some()
    }

    /// Stores Gₙ of a step from `from`, where μ acts along it.
    pub(super) fn begin(&mut self, system: &mut dyn Dynamics, from: &State) {
        if self.stiffness.is_some() {
            self.rows.store_jacobian(system, from);
        }
    }

    /// The residuals of the equations and of the rows into `rhs`.
    pub(super) fn residual(&mut self, system: &mut dyn Dynamics, to: &State, [to_v, to_q]: [f64; 2]) {
        let m = self.rows.len();
        let (motion, rows) = self.rhs.split_at_mut(to.v.len());
        system.residual(to, motion);
        let (positions, velocities) = rows.split_at_mut(m);
        self.rows.positions(system, to, [to_q, to_v], positions);
        if !velocities.is_empty() {
            system.constraint(to, RowWeights::VELOCITY, velocities);
            for (k, rate) in velocities.iter_mut().enumerate() {
                *rate = if has_mu(self.rows.sets()[k], to, k) { *rate / to_v } else { self.mu[k] };
            }
        }
    }

    /// The tangent assembled last is of the step `h` from `from` with the increment `d`.
    pub(super) fn remember(&mut self, from: &State, d: &[f64], h: f64) {
        self.step = h;
        if self.stiffness.is_some() {
            self.start.copy_from(from);
        }
        self.increment.copy_from_slice(d);
    }

    /// Assembles a kept tangent again: the same at the same place has the same factors.
    pub(super) fn reassemble(
        &mut self,
        system: &mut dyn Dynamics,
        place: &State,
        weights: [f64; 2],
    ) -> Result<bool, Singular> {
        let (start, d) = (self.start.clone(), self.increment.clone());
        self.begin(system, &start);
        self.assemble(system, place, &d, self.step, weights)
    }

    pub(super) fn save(&self, out: &mut Checkpoint) {
        out.put_state("tangent.start.", &self.start);
        out.put("tangent.increment", &self.increment);
        out.put("tangent.step", &[self.step]);
    }

    pub(super) fn resume(&mut self, from: &Checkpoint) -> Result<(), NotResumed> {
        from.fill_state("tangent.start.", &mut self.start)?;
        from.fill("tangent.increment", &mut self.increment)?;
        from.fill("tangent.step", std::slice::from_mut(&mut self.step))
    }

    /// Assembles and factors the tangent at `to`.
    pub(super) fn assemble(
        &mut self,
        system: &mut dyn Dynamics,
        to: &State,
        d: &[f64],
        h: f64,
        [to_v, to_q]: [f64; 2],
    ) -> Result<bool, Singular> {
        let n = d.len();
        system.tangent(to, Weights { q: to_q, v: to_v, a: 1.0, increment: Some(d) }, &mut self.tangent);
        if !self.rows.is_empty() {
            self.rows.add_border(system, to, n, &mut self.tangent);
            self.stabilize(system, to, d, h, [to_v, to_q]);
        }
        self.tangent.factor()
    }

    /// Adds the rows and columns of μ, where the form is stabilized.
    fn stabilize(&mut self, system: &mut dyn Dynamics, to: &State, d: &[f64], h: f64, [_, to_q]: [f64; 2]) {
        let Some(stiffness) = &mut self.stiffness else { return };
        let (n, m) = (d.len(), self.rows.len());
        let has = |row: usize| has_mu(self.rows.sets()[row], to, row);
        for k in (0..m).filter(|k| !has(*k)) {
            self.tangent.add(n + m + k, n + m + k, 1.0);
        }
        if !(0..m).any(has) {
            return;
        }
        system.tangent(to, Weights { q: 1.0, v: 0.0, a: 0.0, increment: Some(d) }, stiffness);
        let (rows, tangent, jacobian_columns) = (&self.rows, &mut self.tangent, &mut self.jacobian_columns);
        jacobian_columns.iter_mut().for_each(Vec::clear);
        for &(k, j, x) in rows.stored().iter().filter(|(k, ..)| has(*k)) {
            jacobian_columns[j].push((k, x));
            stiffness.column(j, |i, y| tangent.add(i, n + m + k, h * x * y));
        }
        system.jacobian(to, &mut |row, velocities, entries| {
            for (&j, &x) in velocities.iter().zip(entries).filter(|_| has(row)) {
                tangent.add(n + m + row, j, x);
                for &(k, y) in &jacobian_columns[j] {
                    tangent.add(n + row, n + m + k, h * x * y / to_q);
                }
            }
        });
    }
}

/// Whether a row has a multiplier μ: its position is imposed.
fn has_mu(set: Set, s: &State, row: usize) -> bool {
    is_active(set, s.mode[row]) && !matches!(set, Set::Friction { .. })
}
