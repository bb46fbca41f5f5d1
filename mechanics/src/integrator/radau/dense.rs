//! Dense output from the stages of the accepted step.

use super::coefficients::{A, A2, C, lagrange};
use super::stages::Stages;
use crate::system::{Dynamics, Set, Side, State};

/// Part of ½h (|a₀| + |a₁|) by which v₁ − v₀ may be off the trapezium in a step that resolves its accelerations: (hω)²/12 of a vibration.
/// A reaction is a small difference of the forces of inertia and strain, of which the quintic must hold more digits than of either.
pub(super) const RESOLVED: f64 = 0.002;
/// The same from which on the velocity at the start of a step tells nothing of the step: it is that of a vibration with hω > 1.5.
pub(super) const BLIND: f64 = 0.2;

/// Difference of two parts of a step that are the same but for rounding.
const SAME: f64 = 1e-9;

impl Stages {
    /// Whether the accelerations at both ends of a step tell its change of velocity, but for this `part`.
    pub(super) fn resolve(&self, from: &State, to: &State, part: f64) -> bool {
        let half = 0.5 * (to.t - from.t);
        let ends = from.v.iter().zip(&to.v).zip(from.a.iter().zip(&to.a));
        let [mut off, mut size] = [0.0_f64; 2];
        for (((v0, v1), (a0, a1)), scale) in ends.zip(&self.scale) {
            off = off.max((v1 - v0 - half * (a0 + a1)).abs() / scale);
            size = size.max(half * (a0.abs() + a1.abs()) / scale);
        }
        off <= part * size
    }

    /// Writes the stage of the accepted step at the time `t`, if there is one inside it: its state as it was found, and not one of the dense
    /// output, which knows the ends of the step alone. What is integrated through the stages has the order and the damping of the method.
    pub(super) fn write_stage(
        &self,
        system: &dyn Dynamics,
        (from, to): (&State, &State),
        t: f64,
        out: &mut State,
    ) -> bool {
        let h = to.t - from.t;
        let Some(i) = (0..2).find(|i| ((t - from.t) / h - C[*i]).abs() <= SAME) else { return false };
        let weights = [0, 1, 2].map(|k| if k == i { 1.0 } else { 0.0 });
        self.write_between(system, (from, h), (C[i], weights), out);
        out.lambda.copy_from_slice(&self.a_accepted[i][out.v.len()..]);
        out.copy_modes(from);
        (out.t, out.side) = (t, Side::Right);
        true
    }

    /// Writes the polynomials through the stages at the time `t`, of the increments through the start too.
    pub(super) fn collocate(
        &self,
        system: &dyn Dynamics,
        (from, to): (&State, &State),
        t: f64,
        out: &mut State,
    ) {
        let h = to.t - from.t;
        let s = (t - from.t) / h;
        self.write_between(system, (from, h), (s, lagrange(s)), out);
    }

    /// Configuration, velocities and accelerations at the part `s` of the accepted step of size `h`, where the stages have these weights Lᵢ(s):
    ///
    /// ```text
    /// D(s) = s Σ Lᵢ Dᵢ/cᵢ,   v(s) = Σ Lᵢ Vᵢ = v₀ + h Σᵢ Lᵢ Σⱼ Aᵢⱼ aⱼ,   a(s) = Σ Lᵢ aᵢ
    /// ```
    fn write_between(
        &self,
        system: &dyn Dynamics,
        (from, h): (&State, f64),
        (s, weights): (f64, [f64; 3]),
        out: &mut State,
    ) {
        let n = from.v.len();
        let stages = &self.a_accepted;
        let along =
            |row: [f64; 3], k: usize| row[0] * stages[0][k] + row[1] * stages[1][k] + row[2] * stages[2][k];
        let mixed = |rows: [[f64; 3]; 3], weights: [f64; 3]| {
            [0, 1, 2].map(|j| weights[0] * rows[0][j] + weights[1] * rows[1][j] + weights[2] * rows[2][j])
        };
        let of_increments = [0, 1, 2].map(|i| s * weights[i] / C[i]);
        let velocity = mixed(A, weights).map(|x| h * x);
        let position = mixed(A2, of_increments).map(|x| h * h * x);
        for k in 0..n {
            // The acceleration's slot holds the increment until the configuration is retracted.
            out.a[k] = if self.is_vector_space {
                s * h * from.v[k] + along(position, k)
            } else {
                (0..3).map(|i| of_increments[i] * self.increments[i][k]).sum()
            };
            out.v[k] = from.v[k] + along(velocity, k);
        }
        system.retract(&from.q, &out.a, &mut out.q);
        for k in 0..n {
            out.a[k] = along(weights, k);
        }
    }

    /// λ of the joints at the part `s` of the accepted step, by the polynomial through the stages.
    pub(super) fn interpolate_forces(&self, s: f64, out: &mut State) {
        let n = out.v.len();
        let weights = lagrange(s);
        for (k, set) in self.rows.sets().iter().enumerate() {
            if *set == Set::Free {
                out.lambda[k] = (0..3).map(|i| weights[i] * self.a_accepted[i][n + k]).sum();
            }
        }
    }
}
