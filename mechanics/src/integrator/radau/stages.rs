//! The stages of one Radau step: starting values, iteration, end, error estimate.

use super::super::acceleration::Accelerations;
use super::super::joint_forces::JointForces;
use super::super::kept::{KeptTangent, corotation};
use super::super::rows::Rows;
use super::super::{Checkpoint, Convergence, Counters, NotResumed, Progress, StepError, failure};
use super::coefficients::{A, A_INVERSE, A2, A2_INVERSE, C, E_Q, E_V, GAMMA, MU, T, T_INVERSE};
use super::tolerance::Tolerance;
use crate::linalg::Matrix;
use crate::system::{Corotation, Dynamics, Mode, RowWeights, Set, Side, State, Weights, is_active};
use num_complex::Complex64;

/// Largest η with which one iteration is enough: extrapolation multiplies what is left of the error of the starting values by
/// 22 from step to step, and it must not grow. Control would take it for an error of the step, the same in every shorter one.
const STABLE: f64 = 0.02;

/// Names of the stages' accelerations in a checkpoint.
const NAMES: [&str; 3] = ["stage.1", "stage.2", "stage.3"];

/// What stands for the step in kept factors: they serve a step of the very same size.
pub(super) fn weights(h: f64) -> [f64; 2] {
    [h, h * h]
}

/// Unknowns, matrices and buffers of a step: what `start` allocates for a system.
#[derive(Debug)]
pub(super) struct Stages {
    accelerations: Accelerations,
    pub(super) rows: Rows,
    pub(super) is_vector_space: bool,
    /// Increments D of the stages, their rates Ḋ, and the scaled square of their last change, where the configuration is
    /// no vector space.
    pub(super) increments: [Vec<f64>; 3],
    pub(super) rates: [Vec<f64>; 3],
    shift: f64,
    /// M, C and K, kept, and how the sections have rotated since: at the start of the step and at the stages.
    mass: Matrix,
    damping: Matrix,
    stiffness: Matrix,
    pub(super) kept: KeptTangent,
    stage_corotation: [Corotation; 3],
    real: Matrix,
    complex: Matrix<Complex64>,
    pub(super) scale: Vec<f64>,
    inverse_weight: Vec<f64>,
    pub(super) forces: JointForces,
    stage: State,
    increment: Vec<f64>,
    /// Stage accelerations of the attempt and of the accepted step; q₁ ⊟ q₀ likewise.
    pub(super) a: [Vec<f64>; 3],
    pub(super) a_accepted: [Vec<f64>; 3],
    end: Vec<f64>,
    pub(super) end_accepted: Vec<f64>,
    r: [Vec<f64>; 3],
    z: Vec<Complex64>,
    error_q: Vec<f64>,
    error_v: Vec<f64>,
    /// Right-hand side of the estimate without its K e_q, M e_v.
    source: Vec<f64>,
    product: Vec<f64>,
    rotated: Vec<f64>,
    rhs: Vec<f64>,
}

impl Stages {
    pub(super) fn new(system: &mut dyn Dynamics, state: &State, tolerance: Tolerance) -> Stages {
        let size = system.size();
        let n = size.v + size.lambda;
        let structure = system.structure(1);
        let vector = || vec![0.0; n];
        let three = || [vector(), vector(), vector()];
        Stages {
            accelerations: Accelerations::borrowing(system, state, RowWeights::ACCELERATION),
            rows: Rows::new(system, state),
            is_vector_space: system.is_vector_space(),
            increments: three(),
            rates: three(),
            shift: 0.0,
            mass: Matrix::new(&structure),
            damping: Matrix::new(&structure),
            stiffness: Matrix::new(&structure),
            kept: KeptTangent::new(system, state),
            stage_corotation: [(); 3].map(|()| corotation(system, state)),
            real: Matrix::new(&structure),
            complex: Matrix::new(&structure),
            scale: system.scales().to_vec(),
            inverse_weight: vec![0.0; size.v],
            forces: JointForces::new(tolerance.size().sqrt()),
            stage: State::zeros(size, 0.0),
            increment: vec![0.0; size.v],
            a: three(),
            a_accepted: three(),
            end: vec![0.0; size.v],
            end_accepted: vec![0.0; size.v],
            r: three(),
            z: vec![Complex64::new(0.0, 0.0); n],
            error_q: vector(),
            error_v: vector(),
            source: vector(),
            product: vector(),
            rotated: vector(),
            rhs: vector(),
        }
    }

    /// Keeps the stages of the attempt.
    pub(super) fn accept(&mut self) {
        std::mem::swap(&mut self.a, &mut self.a_accepted);
        std::mem::swap(&mut self.end, &mut self.end_accepted);
        self.kept.fresh = false;
    }

    /// Forgets the tangents, and completes `state`.
    pub(super) fn restart(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        self.kept.forget(true);
        let memory = (&mut self.real, &mut self.rhs);
        self.accelerations.complete_in(memory, system, state, (state.t, 0.0), counters)
    }

    pub(super) fn save(&self, out: &mut Checkpoint) {
        for (a, name) in self.a_accepted.iter().zip(NAMES) {
            out.put(name, a);
        }
        self.kept.save(out);
    }

    /// What [`Stages::save`] wrote: the same tangents at the same place have the same factors.
    pub(super) fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        for (a, name) in self.a_accepted.iter_mut().zip(NAMES) {
            from.fill(name, a)?;
        }
        self.kept.resume(from)?;
        let [step, _] = self.kept.weights;
        if step.is_finite() {
            let (mut counters, place) = (Counters::default(), self.kept.place.clone());
            self.assemble(system, &mut counters);
            let factored = self.factor(system, &place, step, &mut counters);
            factored.map_err(|error| NotResumed::Failed(error.to_string()))?;
            self.kept.resume(from)?;
        }
        Ok(())
    }

    /// Weights of the norms, 1/(absolute·scale + relative·|q|).
    pub(super) fn set_error_weights(&mut self, from: &State, tolerance: Tolerance) {
        for (i, w) in self.inverse_weight.iter_mut().enumerate() {
            *w = 1.0
                / if self.is_vector_space {
                    tolerance.absolute * self.scale[i] + tolerance.relative * from.q[i].abs()
                } else {
                    // Off a vector space q is not the size of what d changes.
                    tolerance.absolute.max(tolerance.relative) * self.scale[i]
                };
        }
    }

    /// Assembles the tangents at the predicted stage in the middle of the step.
    pub(super) fn renew(
        &mut self,
        system: &mut dyn Dynamics,
        (from, to): (&State, &State),
        h: f64,
        counters: &mut Counters,
    ) {
        self.set_stage(system, (from, to), h, 1);
        self.kept.place.copy_from(&self.stage);
        self.assemble(system, counters);
    }

    /// Assembles the tangents at their place.
    fn assemble(&mut self, system: &mut dyn Dynamics, counters: &mut Counters) {
        let place = &self.kept.place;
        system.tangent(place, Weights::new(1.0, 0.0, 0.0), &mut self.mass);
        system.tangent(place, Weights::new(0.0, 1.0, 0.0), &mut self.damping);
        system.tangent(place, Weights::new(0.0, 0.0, 1.0), &mut self.stiffness);
        counters.tangents += 3;
        self.kept.weights = [f64::NAN; 2];
        self.kept.renewed();
    }

    /// Factors of the tangents for steps of size `h`.
    pub(super) fn factor(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        self.kept.weights = [f64::NAN; 2];
        let terms = [&self.mass, &self.damping, &self.stiffness];
        let (h_gamma, h_mu) = (h * GAMMA, Complex64::new(h * MU[0], h * MU[1]));
        self.real.combine(terms, [1.0, h_gamma, h_gamma * h_gamma]);
        self.complex.combine(terms, [Complex64::ONE, h_mu, h_mu * h_mu]);
        if !self.rows.is_empty() {
            let n = from.v.len();
            self.rows.add_border(system, &self.kept.place, n, &mut self.real);
            self.rows.add_border(system, &self.kept.place, n, &mut self.complex);
        }
        let error = |cause| failure::singular(system, from.t, h, cause);
        let real = self.real.factor().map_err(error)?;
        let complex = self.complex.factor().map_err(error)?;
        counters.factorizations += u64::from(real) + u64::from(complex);
        self.kept.weights = weights(h);
        Ok(())
    }

    /// Simplified Newton iterations; returns the verdict and the size of the last increment.
    pub(super) fn iterate(
        &mut self,
        system: &mut dyn Dynamics,
        (from, to): (&State, &State),
        h: f64,
        convergence: &mut Convergence,
        counters: &mut Counters,
    ) -> (Progress, f64) {
        let n = from.v.len() + from.lambda.len();
        // h²γ² and h²μ².
        let (real_part, complex_part) = {
            let (h_gamma, h_mu) = (h * GAMMA, Complex64::new(h * MU[0], h * MU[1]));
            (h_gamma * h_gamma, h_mu * h_mu)
        };
        loop {
            self.shift = 0.0;
            for i in 0..3 {
                self.set_stage(system, (from, to), h, i);
                if convergence.iterations() == 0 {
                    system.corotate(&self.kept.place, &self.stage, &mut self.stage_corotation[i]);
                }
                let (motion, rows) = self.r[i].split_at_mut(from.v.len());
                system.residual(&self.stage, motion);
                if !rows.is_empty() {
                    self.rows.weighted(system, &self.stage, RowWeights::VELOCITY, 1.0, rows);
                }
                self.stage_corotation[i].rotate_back(&mut self.r[i]);
            }
            self.mix_rows(from, h);
            let [r1, r2, r3] = &self.r;
            let (r1, r2, r3) = (&r1[..n], &r2[..n], &r3[..n]);
            let (real, complex) = (&mut self.rhs[..n], &mut self.z[..n]);
            let [p, q, s] = &T_INVERSE;
            for i in 0..n {
                let (x, y, z) = (r1[i], r2[i], r3[i]);
                real[i] = real_part * (p[0] * x + p[1] * y + p[2] * z);
                complex[i] = complex_part
                    * Complex64::new(q[0] * x + q[1] * y + q[2] * z, s[0] * x + s[1] * y + s[2] * z);
            }
            self.real.solve(&mut self.rhs);
            self.complex.solve(&mut self.z);
            let size = self.update(h, convergence.iterations() == 0);
            counters.iterations += 1;
            counters.residuals += 3;
            counters.solves += 2;
            match convergence.judge(size) {
                Progress::Continue => {}
                // The rate of the last step does not know how far this one rotates.
                Progress::Converged
                    if convergence.iterations() == 1
                        && size > 0.0
                        && (!self.is_vector_space || convergence.eta() > STABLE) => {}
                Progress::Converged => match self.forces.judge(self.kept.fresh) {
                    Progress::Continue => {}
                    verdict => return (verdict, size),
                },
                Progress::Diverged => return (Progress::Diverged, size),
            }
        }
    }

    /// Writes (hA)⁻¹ ġ of the three stages in the place of ġ, for the rows that impose it.
    fn mix_rows(&mut self, from: &State, h: f64) {
        let n = from.v.len();
        for (k, set) in self.rows.sets().iter().enumerate() {
            if is_active(*set, from.mode[k]) {
                let rates = [0, 1, 2].map(|i| self.r[i][n + k]);
                for (r, row) in self.r.iter_mut().zip(A_INVERSE) {
                    r[n + k] = (row[0] * rates[0] + row[1] * rates[1] + row[2] * rates[2]) / h;
                }
            }
        }
    }

    /// Sets the velocity and the increment of stage `i`. Off a vector space Dᵢ = h Σ Aᵢⱼ Ḋⱼ, with the rates of the last iteration.
    pub(super) fn set_motion(&mut self, system: &dyn Dynamics, from: &State, h: f64, i: usize) {
        let n = from.v.len();
        let [a1, a2, a3] = self.a.each_ref().map(|a| &a[..n]);
        let (row, row2) = (A[i].map(|x| h * x), A2[i].map(|x| h * h * x));
        let elapsed = h * C[i];
        let (v0, v, d) = (&from.v[..n], &mut self.stage.v[..n], &mut self.increment[..n]);
        for k in 0..n {
            v[k] = v0[k] + row[0] * a1[k] + row[1] * a2[k] + row[2] * a3[k];
            d[k] = elapsed * v0[k] + row2[0] * a1[k] + row2[1] * a2[k] + row2[2] * a3[k];
        }
        if !self.is_vector_space {
            system.rate(&from.q, &self.increments[i][..n], &self.stage.v, &mut self.rates[i][..n]);
            for k in 0..n {
                let d: f64 = (0..3).map(|j| row[j] * self.rates[j][k]).sum();
                self.shift += ((d - self.increments[i][k]) * self.inverse_weight[k]).powi(2);
                (self.increment[k], self.increments[i][k]) = (d, d);
            }
        }
    }

    /// Sets the stage state to stage `i`.
    fn set_stage(&mut self, system: &dyn Dynamics, (from, to): (&State, &State), h: f64, i: usize) {
        self.set_motion(system, from, h, i);
        let (a, lambda) = self.a[i].split_at(from.v.len());
        self.stage.a.copy_from_slice(a);
        self.stage.lambda.copy_from_slice(lambda);
        self.stage.copy_modes(from);
        // The last stage is the end of the step, with its side.
        (self.stage.t, self.stage.side) =
            if i == 2 { (to.t, to.side) } else { (from.t + h * C[i], Side::Right) };
        system.retract(&from.q, &self.increment, &mut self.stage.q);
    }

    /// ΔQ = −T w, rotated with its stage, and Δa = (hA)⁻² ΔQ; gives the size of ΔQ and of h ΔV = A⁻¹ ΔQ.
    fn update(&mut self, h: f64, first: bool) -> f64 {
        let n = self.rhs.len();
        let [d1, d2, d3] = self.r.each_mut().map(|d| &mut d[..n]);
        let (real, complex) = (&self.rhs[..n], &self.z[..n]);
        for i in 0..n {
            let (x, z) = (real[i], complex[i]);
            d1[i] = T[0][0] * x + T[0][1] * z.re + T[0][2] * z.im;
            d2[i] = T[1][0] * x + T[1][1] * z.re + T[1][2] * z.im;
            d3[i] = T[2][0] * x + z.re;
        }
        for (d, corotation) in [&mut *d1, &mut *d2, &mut *d3].into_iter().zip(&self.stage_corotation) {
            corotation.rotate(d);
        }
        if !self.is_vector_space {
            for (increment, d) in self.increments.iter_mut().zip([&*d1, &*d2, &*d3]) {
                increment.iter_mut().zip(d).for_each(|(x, d)| *x -= d);
            }
        }
        let rows =
            |a: &[[f64; 3]; 3], d: [f64; 3]| a.map(|row| row[0] * d[0] + row[1] * d[1] + row[2] * d[2]);
        let squares = |d: [f64; 3]| d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        let inverse = 1.0 / (h * h);
        let [a1, a2, a3] = self.a.each_mut().map(|a| &mut a[..n]);
        let mut square = self.shift;
        let velocities = self.inverse_weight.len();
        self.forces.begin(first);
        for i in velocities..n {
            let [x, y, z] = rows(&A2_INVERSE, [d1[i], d2[i], d3[i]]).map(|x| inverse * x);
            a1[i] -= x;
            a2[i] -= y;
            a3[i] -= z;
            square += 0.0 * (x + y + z); // a multiplier that is not finite is found
            for (change, value) in [(x, a1[i]), (y, a2[i]), (z, a3[i])] {
                self.forces.enter(self.rows.sets()[i - velocities], change, value);
            }
        }
        if !self.is_vector_space {
            // The rates of later stages are not yet those of the new velocities.
            for i in 0..velocities {
                let speed = rows(&A_INVERSE, [d1[i], d2[i], d3[i]]);
                self.rates.iter_mut().zip(speed).for_each(|(rate, x)| rate[i] -= x / h);
            }
        }
        let weights = &self.inverse_weight[..velocities];
        let (d1, d2, d3) = (&d1[..velocities], &d2[..velocities], &d3[..velocities]);
        let (a1, a2, a3) = (&mut a1[..velocities], &mut a2[..velocities], &mut a3[..velocities]);
        for i in 0..velocities {
            let [x, y, z] = rows(&A2_INVERSE, [d1[i], d2[i], d3[i]]);
            a1[i] -= inverse * x;
            a2[i] -= inverse * y;
            a3[i] -= inverse * z;
        }
        for i in 0..velocities {
            let (d, w) = ([d1[i], d2[i], d3[i]], weights[i]);
            square += (squares(d) + squares(rows(&A_INVERSE, d))) * (w * w);
        }
        (square / (6 * velocities.max(1)) as f64).sqrt()
    }

    /// Writes the end of the step, and projects it onto the constraints.
    pub(super) fn finish(&mut self, system: &mut dyn Dynamics, from: &State, h: f64, to: &mut State) {
        self.set_stage(system, (from, to), h, 2);
        to.copy_from(&self.stage);
        if !self.rows.is_empty() {
            // What rounding leaves of the force of an open contact.
            for ((lambda, set), mode) in to.lambda.iter_mut().zip(self.rows.sets()).zip(&from.mode) {
                if *set != Set::Free && *mode == Mode::Open {
                    *lambda = 0.0;
                }
            }
            self.project(system, from, to);
        }
        self.end.copy_from_slice(&self.increment);
    }

    /// q ← q ⊞ δ and v ← v + ν with G δ = −g, G ν = −ġ, of least size in the norm of the real matrix.
    fn project(&mut self, system: &mut dyn Dynamics, from: &State, to: &mut State) {
        let n = from.v.len();
        for (weights, rounds) in [(RowWeights::POSITION, 4), (RowWeights::VELOCITY, 4)] {
            let position = weights == RowWeights::POSITION;
            for _ in 0..rounds {
                let (motion, rows) = self.rhs.split_at_mut(n);
                motion.fill(0.0);
                system.constraint(to, weights, rows);
                for (k, set) in self.rows.sets().iter().enumerate() {
                    let friction = matches!(set, Set::Friction { .. });
                    if !is_active(*set, to.mode[k]) || (position && friction) {
                        rows[k] = 0.0;
                    }
                }
                self.kept.solve(&mut self.real, &mut self.rhs);
                let x = &self.rhs[..n];
                let close = |(x, scale): (&f64, &f64)| x.abs() <= f64::EPSILON * scale;
                let done = x.iter().zip(&self.scale).all(close);
                if position {
                    self.increment.iter_mut().zip(x).for_each(|(d, x)| *d -= x);
                    system.retract(&from.q, &self.increment, &mut to.q);
                } else {
                    to.v.iter_mut().zip(x).for_each(|(v, x)| *v -= x);
                }
                if done {
                    break;
                }
            }
        }
    }

    /// Scaled error of the attempt.
    pub(super) fn estimate(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        h: f64,
        filter_twice: bool,
        counters: &mut Counters,
    ) -> f64 {
        let n = from.v.len();
        let h_gamma = h * GAMMA;
        let [a1, a2, a3] = self.a.each_ref().map(|a| &a[..n]);
        let (a0, error_q, error_v) = (&from.a[..n], &mut self.error_q[..n], &mut self.error_v[..n]);
        for i in 0..n {
            error_q[i] = h * h * (E_Q[0] * a1[i] + E_Q[1] * a2[i] + E_Q[2] * a3[i]);
            error_v[i] = h * (GAMMA * a0[i] + E_V[0] * a1[i] + E_V[1] * a2[i] + E_V[2] * a3[i]);
        }
        self.mass.multiply(&self.error_v, &mut self.source);
        counters.solves += 1;
        self.subtract_stiffness_times_error(h_gamma);
        self.filter(h_gamma);
        let error = self.error_norm(h);
        if !filter_twice || error < 1.0 {
            return error.max(1e-10);
        }
        // Once more, through f at the estimate: M e_v′ = M e_v − γ h r(q₀ ⊞ ε_q, v₀ + ε_v, a₀),
        // e_q′ = e_q + γh ε_v = ε_q.
        for i in 0..n {
            self.stage.v[i] = from.v[i] + self.error_v[i];
        }
        self.stage.a.copy_from_slice(&from.a);
        (self.stage.t, self.stage.side) = (from.t, from.side);
        self.stage.lambda.copy_from_slice(&from.lambda);
        system.retract(&from.q, &self.error_q[..n], &mut self.stage.q);
        system.residual(&self.stage, &mut self.product[..n]);
        counters.residuals += 1;
        counters.solves += 1;
        for i in 0..n {
            self.source[i] -= h_gamma * self.product[i];
        }
        self.subtract_stiffness_times_error(h_gamma);
        self.filter(h_gamma);
        self.error_norm(h).max(1e-10)
    }

    /// `rhs` = `source` − `h_gamma`·K e_q
    fn subtract_stiffness_times_error(&mut self, h_gamma: f64) {
        self.rotated.copy_from_slice(&self.error_q);
        self.kept.multiply(&self.stiffness, &mut self.rotated, &mut self.product);
        for ((rhs, source), product) in self.rhs.iter_mut().zip(&self.source).zip(&self.product) {
            *rhs = source - h_gamma * product;
        }
    }

    /// ε_v from `rhs`, ε_q = e_q + hγ ε_v.
    fn filter(&mut self, h_gamma: f64) {
        self.kept.solve(&mut self.real, &mut self.rhs);
        self.error_v.copy_from_slice(&self.rhs);
        for (q, v) in self.error_q.iter_mut().zip(&self.error_v) {
            *q += h_gamma * v;
        }
    }

    fn error_norm(&self, h: f64) -> f64 {
        let mut square = 0.0;
        for ((q, v), w) in self.error_q.iter().zip(&self.error_v).zip(&self.inverse_weight) {
            square += (q * q + h * h * v * v) * (w * w);
        }
        (square / (2 * self.inverse_weight.len().max(1)) as f64).sqrt()
    }

    /// Unknown with the largest scaled error.
    pub(super) fn worst_error(&self, h: f64) -> usize {
        failure::largest(
            (0..self.inverse_weight.len())
                .map(|i| self.inverse_weight[i] * (self.error_q[i].abs() + h * self.error_v[i].abs())),
        )
    }

    /// Unknown with the largest scaled increment.
    pub(super) fn worst_increment(&self) -> usize {
        failure::largest(
            (0..self.inverse_weight.len())
                .map(|i| self.inverse_weight[i] * (self.rhs[i].abs() + self.z[i].norm())),
        )
    }
}
