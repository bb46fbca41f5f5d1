//! Accelerated projected gradients, where Newton's method does not settle.
//!
//! With uₙ + μ|uₜ| in the place of uₙ, Coulomb's friction is complementarity on the cones μΛₙ ≥ |Λₜ|. With u held in that term it is what makes ½ ΛᵀWΛ + cᵀΛ least, u its gradient:
//!
//! ```text
//! Λ⁺ = Π(Z − (u(Z) + μ|uₜ(Z)| eₙ) s/λ),   Z⁺ = Λ⁺ + (Λ⁺ − Λ)(t − 1)/t⁺,   t⁺ = ½ + (¼ + t²)^½
//! ```
//!
//! with the projection Π on the cones, the stiffness s of each contact, and λ the largest eigenvalue of s W, by its powers. Where Λ goes against the last step, t begins at 1
//! anew. A step costs a solution with the factors of A and O(1) for each row. It takes some hundreds to thousands, and contacts that stick and slip by turns do not disturb it: the
//! problems of a heap on which Newton's method goes to and fro for ever end so. Where b lies beside the range of W there is no Λ, and the residual falls no further: who
//! asks for it gets what leaves up to 1e-5 of the largest multiplier. Of redundant contacts it finds the motion, and of their multipliers some, not those of least norm.
//!
//! Sources: Beck & Teboulle (2009, doi 10.1137/080716542), O'Donoghue & Candès (2015, doi 10.1007/s10208-013-9150-3) for beginning anew; de Saxcé & Feng
//! (1998, doi 10.1016/S0895-7177(98)00119-8) for the cones.

use super::projection::Group;
use super::{Augmented, BESIDE, FALLING, TOLERABLE};
use crate::contact::RowLaw;
use crate::linalg::Matrix;

/// Steps at most.
const STEPS: u32 = 10_000;
/// Steps between two looks at the residual, and the residual at which they end.
const LOOK: u32 = 25;
const CLOSE: f64 = 1e-11;
/// Steps in which the residual falls, or else it falls no further.
const PATIENCE: u32 = 1500;
/// Residual up to which the best multipliers of a lenient problem are taken, if no method does better.
const TAKEN: f64 = 1e-3;
/// Powers that λ takes, and a bound over what they give.
const POWERS: u32 = 40;
const SLACK: f64 = 1.05;

impl Augmented {
    /// The same, where Λ is taken too whose residual falls no further than 1e-5 of the largest, or 1e-3 where nothing else is found: whoever asks for that tells what is
    /// [left](Augmented::unsettled).
    #[must_use]
    pub fn lenient(self) -> Augmented {
        Augmented { lenient: true, ..self }
    }

    /// Solves for Λ from Λ₀, with the motion y; whether it settled. Rows of given slip have no cone, and are left to Newton's method.
    pub(super) fn descend(
        &mut self,
        factored: &mut Matrix,
        b: &[f64],
        lambda: &mut [f64],
        y: &mut [f64],
    ) -> bool {
        if self.laws.iter().any(|law| matches!(law, RowLaw::Slip { .. })) {
            return false;
        }
        let (mut ahead, mut next) = (std::mem::take(&mut self.ahead), std::mem::take(&mut self.next));
        let mut best = (f64::INFINITY, std::mem::take(&mut self.best.1));
        for list in [&mut ahead, &mut next] {
            list.clear();
            list.extend_from_slice(if self.guess.len() == b.len() { &self.guess } else { &self.start });
        }
        let length = 1.0 / self.largest(factored, &mut next, y);
        self.onto_cones(&mut ahead);
        lambda.copy_from_slice(&ahead);
        let most = if self.lenient { BESIDE } else { TOLERABLE };
        self.move_by(factored, b, lambda, y);
        // Where more than one Λ is as good, that which is there stays.
        keep_best(&mut best, self.residual, lambda, FALLING);
        let (mut t, mut least, mut fell) = (1.0_f64, self.residual, 0);
        for step in 1..=STEPS {
            self.rates_by(factored, b, &ahead, y);
            next.copy_from_slice(&ahead);
            for (group, stiffness) in self.groups.iter().zip(&self.stiffness) {
                let part = length * common(group, stiffness);
                let friction = &group.friction[..group.count];
                let sliding = friction.iter().map(|i| self.rates[*i]).fold(0.0, libm::hypot);
                next[group.normal] -= part * (self.rates[group.normal] + self.coefficient(group) * sliding);
                friction.iter().for_each(|i| next[*i] -= part * self.rates[*i]);
            }
            self.onto_cones(&mut next);
            let mut against = 0.0;
            for (group, stiffness) in self.groups.iter().zip(&self.stiffness) {
                let along = |i: usize| (ahead[i] - next[i]) * (next[i] - lambda[i]);
                against += group.rows().map(along).sum::<f64>() / common(group, stiffness);
            }
            let before = if against > 0.0 { 1.0 } else { t };
            t = 0.5 + (0.25 + before * before).sqrt();
            let further = (before - 1.0) / t;
            for ((ahead, next), last) in ahead.iter_mut().zip(&next).zip(lambda.iter_mut()) {
                *ahead = next + further * (next - *last);
                *last = *next;
            }
            if step % LOOK == 0 {
                self.iterations += LOOK as usize;
                self.move_by(factored, b, lambda, y);
                keep_best(&mut best, self.residual, lambda, if fell == 0 { FALLING } else { 1.0 });
                if self.residual < FALLING * least {
                    (least, fell) = (self.residual, step);
                }
                let stands = best.0 <= most && step - fell >= PATIENCE;
                if self.residual <= CLOSE || stands || !self.residual.is_finite() {
                    break;
                }
            }
        }
        (self.ahead, self.next) = (ahead, next);
        self.best = best;
        self.best.0 <= most && self.take_best(factored, b, lambda, y)
    }

    /// Takes the multipliers of the least residual that gradients have met, where the problem is lenient or they have settled.
    pub(super) fn take_best(
        &mut self,
        factored: &mut Matrix,
        b: &[f64],
        lambda: &mut [f64],
        y: &mut [f64],
    ) -> bool {
        let most = if self.lenient { TAKEN } else { TOLERABLE };
        if self.best.1.len() != lambda.len() || !(self.best.0 <= most) {
            return false;
        }
        lambda.copy_from_slice(&self.best.1);
        self.move_by(factored, b, lambda, y);
        if self.residual > TOLERABLE {
            self.unsettled = self.residual;
        }
        true
    }

    /// u = b + G A⁻¹ Gᵀ (Λ − Λ₀), by way of y.
    pub(super) fn rates_by(&mut self, factored: &mut Matrix, b: &[f64], lambda: &[f64], y: &mut [f64]) {
        self.put_force(lambda);
        y.copy_from_slice(&self.force);
        factored.solve(y);
        self.rates_of(b, y);
    }

    /// A bound of the largest eigenvalue of s W; `along` is memory.
    fn largest(&mut self, factored: &mut Matrix, along: &mut [f64], y: &mut [f64]) -> f64 {
        // Without the symmetry that a problem may have.
        along.iter_mut().enumerate().for_each(|(i, x)| *x = 0.1 + (0.618 * i as f64).fract());
        let mut largest = 1.0;
        for _ in 0..POWERS {
            // W v, with v in the place of Λ − Λ₀.
            self.force.fill(0.0);
            for (i, x) in along.iter().enumerate() {
                for (j, g) in &self.entries[self.begins[i]..self.begins[i + 1]] {
                    self.force[*j] += g * x;
                }
            }
            y.copy_from_slice(&self.force);
            factored.solve(y);
            let (mut before, mut after) = (0.0_f64, 0.0_f64);
            for (group, stiffness) in self.groups.iter().zip(&self.stiffness) {
                let s = common(group, stiffness);
                for i in group.rows() {
                    let change = s * self.row(i).iter().map(|(j, g)| g * y[*j]).sum::<f64>();
                    before += along[i] * along[i] / s;
                    after += change * change / s;
                    along[i] = change;
                }
            }
            largest = (after / before).sqrt();
            let size = after.sqrt();
            along.iter_mut().for_each(|x| *x /= size);
        }
        if largest.is_finite() && largest > 0.0 { SLACK * largest } else { 1.0 }
    }

    fn coefficient(&self, group: &Group) -> f64 {
        match group.friction[..group.count].first().map(|i| self.laws[*i]) {
            Some(RowLaw::Friction { coefficient, .. }) => coefficient,
            _ => 0.0,
        }
    }

    /// Projects multipliers on their cones.
    fn onto_cones(&self, values: &mut [f64]) {
        for group in &self.groups {
            if self.laws[group.normal] == RowLaw::Free {
                continue;
            }
            let friction = &group.friction[..group.count];
            let (normal, mu) = (values[group.normal], self.coefficient(group));
            let size = friction.iter().map(|i| values[*i]).fold(0.0, libm::hypot);
            if normal >= 0.0 && size <= mu * normal {
                continue;
            }
            // Behind the cone, on its axis, or beside it.
            let onto = ((normal + mu * size) / (1.0 + mu * mu)).max(0.0);
            values[group.normal] = onto;
            let part = if size > 0.0 { mu * onto / size } else { 0.0 };
            friction.iter().for_each(|i| values[*i] *= part);
        }
    }
}

/// Keeps Λ where its residual is less than this part of the least so far.
fn keep_best(best: &mut (f64, Vec<f64>), residual: f64, lambda: &[f64], part: f64) {
    if residual < part * best.0 {
        best.0 = residual;
        best.1.clear();
        best.1.extend_from_slice(lambda);
    }
}

/// One stiffness for all rows of a contact, so that its cone stays one.
fn common(group: &Group, stiffness: &[f64; 2]) -> f64 {
    if group.count > 0 { stiffness[0].min(stiffness[1]) } else { stiffness[0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Structure;

    /// A body (m, I₁, I₂, I₃) on three points of a plane, pushed so that it tilts and slides: Newton's method and gradients find the same motion, and forces in their cones. (On more
    /// points that slide, the motion depends on how they share the weight, which is not given.)
    #[test]
    fn gradients_find_the_motion_that_newtons_method_finds() {
        let mut matrix = Matrix::new(&Structure::dense(6));
        [2.0, 2.0, 2.0, 0.3, 0.5, 0.4].iter().enumerate().for_each(|(i, x)| matrix.add(i, i, *x));
        let mut factored = matrix.clone();
        factored.factor().unwrap();
        let places = [[1.0, 0.5], [-1.0, 0.4], [0.1, -0.5]];
        for push in [
            [0.4, 0.05, -0.5, 0.1, -0.2, 0.3],
            [0.01, 0.02, -0.5, 0.0, 0.0, 0.01],
            [0.0, 0.0, 0.3, 0.8, -0.2, 0.1],
        ] {
            let rows = places.iter().flat_map(|[x, y]| {
                [[0.0, 0.0, 1.0, *y, -x, 0.0], [1.0, 0.0, 0.0, 0.0, 0.0, -y], [0.0, 1.0, 0.0, 0.0, 0.0, *x]]
            });
            let rows: Vec<[f64; 6]> = rows.collect();
            let laws = (0..places.len()).flat_map(|k| {
                let friction = RowLaw::Friction { coefficient: 0.3, normal: 3 * k };
                [RowLaw::Unilateral, friction, friction]
            });
            let laws: Vec<RowLaw> = laws.collect();
            let b: Vec<f64> =
                rows.iter().map(|row| row.iter().zip(push).map(|(g, v)| g * v).sum::<f64>()).collect();
            let mut many = Augmented::default();
            many.keep(&matrix, 6);
            let mut solve = |gradients: bool| {
                many.begin(&laws);
                rows.iter().for_each(|row| many.push(row.iter().copied().enumerate()));
                let (mut lambda, mut y) = (vec![0.0; b.len()], vec![0.0; 6]);
                if gradients {
                    many.start = lambda.clone();
                    assert!(many.descend(&mut factored, &b, &mut lambda, &mut y));
                } else {
                    many.solve(&mut factored, &b, &mut lambda, &mut y).unwrap();
                }
                assert!(many.residual < 1e-10, "{}", many.residual);
                for contact in lambda.as_chunks::<3>().0 {
                    assert!(libm::hypot(contact[1], contact[2]) <= 0.3 * contact[0] * (1.0 + 1e-9));
                }
                y
            };
            let (newton, gradients) = (solve(false), solve(true));
            for (a, b) in newton.iter().zip(&gradients) {
                assert!((a - b).abs() < 1e-9, "{newton:?} {gradients:?}");
            }
        }
    }
}
