//! The cone problem of rows whose W is formed: relaxed, or solved by Newton's method where rows follow from each other.
//!
//! [Relaxation](super::cone) is cheap and certain where W is regular. Where it is not, the part of b beside the range of W moves Λ in every sweep, and with friction
//! the limits of discs move with it, so that the motion comes to no rest either; and of all Λ that make one motion the order of the rows chooses one. With the
//! Cholesky factor of W, found with exchanges of rows and ended where what is left is rounding,
//!
//! ```text
//! W = L Lᵀ,   L: m × r,   u = b + L y,   y = Lᵀ Λ
//! ```
//!
//! the problem is that of [`Augmented`] with A = 1 and G = L, which has one answer, the one of least norm. It is solved so where r < m, and where relaxation does not end soon.

use super::augmented::Augmented;
use super::cone::{self, FEW, RowLaw, Unresolved};
use crate::linalg::{Matrix, Structure};

/// Sweeps of relaxation before Newton's method is tried.
const SOON: usize = 2_000;
/// Products of relaxation where Newton's method has failed.
const PRODUCTS: usize = 100_000_000;
/// Change over the largest multiplier with which the multipliers of the last sweep are taken, if they go to and fro for ever.
const CLOSE: f64 = 1e-7;
/// Pivot of W, over its largest entry and m ε, below which it is rounding.
const ROUNDING: f64 = 8.0;

/// W of a row of friction over the largest of normal ones, up to which it moves nothing.
const STILL: f64 = 1e-9;

/// The problem, with its memory.
#[derive(Debug)]
pub struct Few {
    factor: Factor,
    problem: Augmented,
    /// A = 1, with rows and columns beyond the rank that nothing moves.
    unit: Matrix,
    y: Vec<f64>,
    solution: Vec<f64>,
    /// Multipliers of an earlier sweep.
    earlier: Vec<f64>,
    /// W and b without rows of friction that move nothing.
    moving: [Vec<f64>; 2],
}

impl Few {
    /// Memory for so many rows. A rank beyond [`FEW`] asks for more of it when it is met.
    pub fn new(rows: usize) -> Few {
        let order = rows.clamp(1, FEW);
        let mut few = Few {
            factor: Factor {
                entries: Vec::with_capacity(rows * rows),
                left: Vec::with_capacity(rows),
                rank: 0,
            },
            problem: Augmented::with_room(rows, order),
            unit: Matrix::new(&Structure::dense(0)),
            y: Vec::with_capacity(rows),
            solution: Vec::with_capacity(rows),
            earlier: Vec::with_capacity(rows),
            moving: [Vec::with_capacity(rows * rows), Vec::with_capacity(rows)],
        };
        few.identity(order);
        few
    }

    /// Makes A of this order.
    fn identity(&mut self, order: usize) {
        self.unit = Matrix::new(&Structure::dense(order));
        (0..order).for_each(|i| self.unit.add(i, i, 1.0));
        self.problem.keep_new(&self.unit);
    }

    /// Whether rows follow from others to this part of their W.
    pub fn are_dependent(&mut self, w: &[f64], m: usize, part: f64) -> bool {
        self.factor.set(w, m, part);
        self.factor.rank < m
    }

    /// Solves u = b + WΛ for Λ, in place: from the values it has where W is regular; `w` holds W by rows. Gives the number of sweeps, or of iterations.
    ///
    /// # Errors
    /// [`Unresolved`]: at once where W or b is not finite.
    pub fn solve(
        &mut self,
        laws: &[RowLaw],
        w: &[f64],
        b: &[f64],
        lambda: &mut [f64],
    ) -> Result<usize, Unresolved> {
        let m = laws.len();
        if !b.iter().chain(w).all(|x| x.is_finite()) {
            return Err(Unresolved { rows: m, sweeps: 0, change: f64::NAN });
        }
        if m == 1 {
            return cone::relax(laws, (w, b), lambda, cone::SWEEPS, &mut self.earlier);
        }
        let is_normal = |i: usize| matches!(laws[i], RowLaw::Free | RowLaw::Unilateral);
        let least = STILL * (0..m).filter(|i| is_normal(*i)).fold(0.0, |most: f64, i| most.max(w[i * m + i]));
        let is_still = |i: usize| matches!(laws[i], RowLaw::Friction { .. }) && w[i * m + i] <= least;
        if !(0..m).any(is_still) {
            return self.solve_moving(laws, (w, b), lambda);
        }
        // Friction across what a joint holds is not known, and rounding would make it the largest: it is none.
        let mut moving = std::mem::take(&mut self.moving);
        for (to, from) in moving.iter_mut().zip([w, b]) {
            to.clear();
            to.extend_from_slice(from);
        }
        for i in (0..m).filter(|i| is_still(*i)) {
            (0..m).for_each(|j| (moving[0][i * m + j], moving[0][j * m + i]) = (0.0, 0.0));
            (moving[1][i], lambda[i]) = (0.0, 0.0);
        }
        let solved = self.solve_moving(laws, (&moving[0], &moving[1]), lambda);
        self.moving = moving;
        solved
    }

    /// The same of rows that all move something, or nothing at all.
    fn solve_moving(
        &mut self,
        laws: &[RowLaw],
        (w, b): (&[f64], &[f64]),
        lambda: &mut [f64],
    ) -> Result<usize, Unresolved> {
        let m = laws.len();
        self.factor.set(w, m, ROUNDING * m as f64 * f64::EPSILON);
        if self.factor.rank == m
            && let Ok(sweeps) = cone::relax(laws, (w, b), lambda, SOON, &mut self.earlier)
        {
            return Ok(sweeps);
        }
        match self.newton(laws, w, b) {
            Ok(iterations) => {
                lambda.copy_from_slice(&self.solution);
                Ok(iterations)
            }
            // Neither is certain with friction.
            Err(unresolved) => {
                let sweeps = cone::SWEEPS.min(PRODUCTS / (m * m));
                match cone::relax(laws, (w, b), lambda, sweeps, &mut self.earlier) {
                    Err(relaxed) if relaxed.change <= CLOSE => Ok(relaxed.sweeps),
                    Err(relaxed) if relaxed.change <= unresolved.change => Err(relaxed),
                    Err(_) => Err(unresolved),
                    sweeps => sweeps,
                }
            }
        }
    }

    /// Λ of least norm, from zero, into the solution.
    fn newton(&mut self, laws: &[RowLaw], w: &[f64], b: &[f64]) -> Result<usize, Unresolved> {
        let m = laws.len();
        if self.factor.rank > self.unit.order() {
            self.identity(self.factor.rank);
        }
        // Norms are measured by the mean of W of all normal rows, and of all rows of friction.
        let mean = |normal: bool| {
            let of = |i: &usize| matches!(laws[*i], RowLaw::Free | RowLaw::Unilateral) == normal;
            let (sum, count) =
                (0..m).filter(of).fold((0.0, 0.0), |(sum, count), i| (sum + w[i * m + i], count + 1.0));
            if count > 0.0 { sum / count } else { 0.0 }
        };
        let (normal, friction) = (mean(true), mean(false));
        let inverse = |w: f64| if w > 0.0 { 1.0 / w } else { 1.0 };
        let stiffness = [inverse(normal), inverse(if friction > 0.0 { friction } else { normal })];
        let Few { factor, problem, unit, y, solution, .. } = self;
        problem.begin(laws);
        problem.measure_by(stiffness);
        for row in factor.entries.chunks_exact(m) {
            problem.push(row[..factor.rank].iter().copied().enumerate());
        }
        if !unit.is_factored() {
            unit.factor().map_err(|_| Unresolved { rows: m, sweeps: 0, change: f64::INFINITY })?;
        }
        for (list, length) in [(&mut *solution, m), (y, unit.order())] {
            list.clear();
            list.resize(length, 0.0);
        }
        problem.solve(unit, b, solution, y)?;
        Ok(problem.iterations)
    }
}

/// L, by rows with room for m columns, and the diagonal of W − L Lᵀ.
#[derive(Debug)]
struct Factor {
    entries: Vec<f64>,
    left: Vec<f64>,
    rank: usize,
}

impl Factor {
    /// Until `least` of the W of each row is left.
    fn set(&mut self, w: &[f64], m: usize, least: f64) {
        let Factor { entries, left, rank } = self;
        entries.clear();
        entries.resize(m * m, 0.0);
        left.clear();
        left.extend((0..m).map(|i| w[i * m + i]));
        *rank = 0;
        while *rank < m {
            // Rows differ in units: what is left is measured by what there was.
            let part = |i: usize| if w[i * m + i] > 0.0 { left[i] / w[i * m + i] } else { 0.0 };
            let Some(pivot) = (0..m).max_by(|i, j| part(*i).total_cmp(&part(*j))) else { break };
            if part(pivot) <= least {
                break;
            }
            let root = left[pivot].sqrt();
            for i in (0..m).filter(|i| *i != pivot) {
                let (of, row) = (&entries[i * m..], &entries[pivot * m..]);
                let done: f64 = of.iter().zip(row).take(*rank).map(|(x, y)| x * y).sum();
                // W is symmetric up to rounding.
                let entry = (0.5 * (w[i * m + pivot] + w[pivot * m + i]) - done) / root;
                entries[i * m + *rank] = if left[i] > 0.0 { entry } else { 0.0 };
                left[i] -= entry * entry;
            }
            entries[pivot * m + *rank] = root;
            left[pivot] = 0.0;
            *rank += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The end of a hinged rod that moves along the normal alone: friction moves nothing, and is none.
    #[test]
    fn friction_that_moves_nothing_is_none() {
        let friction = RowLaw::Friction { coefficient: 0.3, normal: 0 };
        let laws = [RowLaw::Unilateral, friction, friction];
        for small in [0.0, 1e-33, 1e-17] {
            let w = [3.0, 0.0, 0.0, 0.0, small, 0.0, 0.0, 0.0, small];
            let mut x = [0.0; 3];
            let solved = Few::new(3).solve(&laws, &w, &[-6.0, 1e-18, 0.0], &mut x);
            assert!(
                solved.is_ok() && (x[0] - 2.0).abs() < 1e-9 && x[1].hypot(x[2]) < 1e-6,
                "{small}: {solved:?} {x:?}"
            );
        }
    }

    /// W and b of a box of 2 × 1 × 0.2 (mass 2) that is pressed on so many points of its face, with a push along y.
    fn on_its_face(places: &[[f64; 2]], push: f64) -> (Vec<f64>, Vec<f64>) {
        let inverse = [0.5, 0.5, 0.5, 6.0 / 1.04, 6.0 / 4.04, 6.0 / 5.0];
        // The velocity of a point (x, y, −0.1): v + ω × r.
        let rows: Vec<[f64; 6]> = places
            .iter()
            .map(|[x, y]| [0.0, 0.0, 1.0, *y, -x, 0.0])
            .chain(
                places
                    .iter()
                    .flat_map(|[x, y]| [[1.0, 0.0, 0.0, 0.0, -0.1, -y], [0.0, 1.0, 0.0, 0.1, 0.0, *x]]),
            )
            .collect();
        let free = [0.0, push, -1.0, 0.0, 0.0, 0.0];
        let product = |a: &[f64; 6], b: &[f64; 6]| (0..6).map(|k| a[k] * inverse[k] * b[k]).sum::<f64>();
        let w = rows.iter().flat_map(|a| rows.iter().map(move |b| product(a, b))).collect();
        let b = rows.iter().map(|row| row.iter().zip(free).map(|(g, v)| g * v).sum()).collect();
        (w, b)
    }

    fn laws(contacts: usize, coefficient: f64) -> Vec<RowLaw> {
        let friction = |k| RowLaw::Friction { coefficient, normal: k / 2 };
        (0..contacts).map(|_| RowLaw::Unilateral).chain((0..2 * contacts).map(friction)).collect()
    }

    const CORNERS: [[f64; 2]; 4] = [[1.0, 0.5], [-1.0, 0.5], [-1.0, -0.5], [1.0, -0.5]];

    /// Of four corners each carries a quarter of m v = 2 N s, however the rows are ordered and whatever was there before.
    #[test]
    fn of_redundant_rows_the_answer_is_that_of_least_norm() {
        let (w, b) = on_its_face(&CORNERS, 0.0);
        for start in [0.0, 0.3] {
            let mut lambda = [start; 12];
            lambda[1] = 0.0;
            Few::new(12).solve(&laws(4, 0.5), &w, &b, &mut lambda).unwrap();
            for k in 0..4 {
                assert!((lambda[k] - 0.5).abs() < 1e-10, "{lambda:?}");
            }
            assert!(lambda[4..].iter().all(|x| x.abs() < 1e-10), "{lambda:?}");
        }
    }

    /// What of b lies beside the range of W, here 1e-7 of twist, opens no corner, and slides none.
    #[test]
    fn what_no_multipliers_can_take_away_is_left() {
        let (w, mut b) = on_its_face(&CORNERS, 0.1);
        for (k, b) in b[..4].iter_mut().enumerate() {
            *b += if k % 2 == 0 { 1e-7 } else { -1e-7 };
        }
        let mut lambda = [0.0; 12];
        Few::new(12).solve(&laws(4, 0.5), &w, &b, &mut lambda).unwrap();
        let sum = |list: &[f64]| list.iter().sum::<f64>();
        assert!((sum(&lambda[..4]) - 2.0).abs() < 1e-9, "{lambda:?}");
        // It turns about x by 0.1 × 0.2 N s, which the corners take by their normal impulses.
        let along: f64 = (0..4).map(|k| lambda[5 + 2 * k]).sum();
        assert!((along + 0.2).abs() < 1e-9, "{lambda:?}");
        assert!(lambda[..4].iter().all(|x| *x > 0.4), "{lambda:?}");
    }

    #[test]
    fn numbers_that_are_none_end_it_at_once() {
        let mut lambda = [0.0; 12];
        let (w, mut b) = on_its_face(&CORNERS, 0.0);
        b[2] = f64::NAN;
        let unresolved = Few::new(12).solve(&laws(4, 0.5), &w, &b, &mut lambda).unwrap_err();
        assert!(unresolved.sweeps == 0 && unresolved.change.is_nan());
    }
}
