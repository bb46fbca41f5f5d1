//! The cone problem of many rows: Newton's method for the motion that their multipliers make.
//!
//! Of many rows, W = G A⁻¹ Gᵀ is dense, and singular where they are more than the motions that they hold. It is not formed here. With
//! the matrix A of a step, the multipliers Λ₀ from which it starts, and what u = b is before they change,
//!
//! ```text
//! A y = Gᵀ (Λ − Λ₀),   u = b + G y,   Λ = Π(Λ̂ − ρ u)
//! F(y) = A y − Gᵀ (Π(Λ̂ − ρ u) − Λ₀) = 0,   (A + Gᵀ Π′ ρ G) δ = −F
//! ```
//!
//! with the projection Π on the sets of all rows, discs of friction with the radius that Λₙ has. GᵀG has room in the band of A, so that an iteration costs a
//! factorisation of A and O(1) for each row. While Λ̂ is not Λ, u of a contact that presses is −(Λ − Λ̂)/ρ and not zero: Λ̂ is replaced by Λ
//! (the proximal point, or multiplier, method) until it is. That converges at the rate 1/(ρW), and where W is singular what is added to
//! Λ̂ has no part that moves nothing: from Λ₀ = 0, of all Λ that make the same motion, the one of least norm is found.
//!
//! ρ is a multiple of the least Aⱼⱼ/Gᵢⱼ² of a row, which is at least 1/Wᵢᵢ. The result is judged by the residual |Λ − Π(Λ − u/Wᵢᵢ)| of the motion that A itself gives.
//! Where b lies beside the range of W the centre moves by the same amount in every proximal step, along multipliers that make no motion: the iteration ends with the motion.
//!
//! Without friction F is the gradient of a convex function; with Coulomb's it is not, and there may be no solution, or several: where the iteration does not settle
//! with one ρ, gradients are followed (`augmented/gradients.rs`), and then others are tried.
//!
//! Sources: Alart & Curnier (1991, doi 10.1016/0045-7825(91)90022-X); Rockafellar (1976, doi 10.1287/moor.1.2.97) for the proximal point method.

mod gradients;
mod projection;

use super::cone::{RowLaw, Unresolved};
use crate::linalg::Matrix;
use projection::{Group, State, projected};

/// ρ of a row in units of its stiffness, one attempt after the other.
const STIFFNESSES: [f64; 3] = [30.0, 1.0, 1e3];
/// Factor by which ρ grows where u settles slowly, for rows follow almost from each other, and its bound.
const STIFFER: f64 = 10.0;
const STIFFEST: f64 = 1e6;
/// Iterations of an attempt.
const ITERATIONS: usize = 80;
/// Halvings of the part of a step that is taken.
const HALVINGS: usize = 30;
/// Residual, over the largest multiplier, at which the iteration ends.
const SETTLED: f64 = 1e-12;
/// Residual that must be reached where it falls no further, or at the last iteration.
const TOLERABLE: f64 = 1e-8;
/// Part of the residual of a proximal step that may be left by the next while it still falls.
const FALLING: f64 = 0.5;
/// Residual that may be left where the motion is at rest: what of b no multipliers can take away.
const BESIDE: f64 = 1e-5;

/// Memory for problems of many rows.
#[derive(Debug, Default)]
pub struct Augmented {
    groups: Vec<Group>,
    laws: Vec<RowLaw>,
    /// Entries of G that are not zero, row after row, and where each row begins.
    entries: Vec<(usize, f64)>,
    begins: Vec<usize>,
    /// The least Aⱼⱼ/Gᵢⱼ² of the normal row of each contact, and the larger of those of its friction.
    stiffness: Vec<[f64; 2]>,
    /// The same for every contact, where it is given.
    common: Option<[f64; 2]>,
    states: Vec<State>,
    before: Vec<State>,
    rates: Vec<f64>,
    /// u of the proximal step before.
    rates_before: Vec<f64>,
    centre: Vec<f64>,
    start: Vec<f64>,
    force: Vec<f64>,
    image: Vec<f64>,
    /// y, and the projection by which Λ is judged.
    motion: Vec<f64>,
    projection: Vec<f64>,
    /// G δ of a step.
    turn: Vec<f64>,
    /// Multipliers of the gradients' steps, those that they begin with, and those of the least residual, with that.
    ahead: Vec<f64>,
    next: Vec<f64>,
    guess: Vec<f64>,
    best: (f64, Vec<f64>),
    /// The contact of each normal row.
    of_normal: Vec<usize>,
    /// ρ of the attempt in units of the stiffness.
    ratio: f64,
    plain: Option<Matrix>,
    work: Option<Matrix>,
    /// Iterations of the problem solved last.
    pub iterations: usize,
    /// Its residual over the largest multiplier.
    pub residual: f64,
    /// The residual, where gradients of a [lenient](Augmented::lenient) problem ended with more than is tolerable; else 0.
    pub unsettled: f64,
    lenient: bool,
}

impl Augmented {
    /// Memory for so many rows and a dense A of this order.
    pub(super) fn with_room(rows: usize, order: usize) -> Augmented {
        let list = || Vec::with_capacity(rows);
        let of_order = || Vec::with_capacity(order);
        Augmented {
            groups: Vec::with_capacity(rows),
            laws: Vec::with_capacity(rows),
            entries: Vec::with_capacity(rows * order),
            begins: Vec::with_capacity(rows + 1),
            stiffness: Vec::with_capacity(rows),
            states: Vec::with_capacity(rows),
            before: Vec::with_capacity(rows),
            rates: list(),
            rates_before: list(),
            centre: list(),
            start: list(),
            force: of_order(),
            image: of_order(),
            motion: of_order(),
            turn: list(),
            projection: list(),
            ahead: list(),
            next: list(),
            guess: list(),
            best: (f64::INFINITY, list()),
            of_normal: Vec::with_capacity(rows),
            ..Augmented::default()
        }
    }

    /// Keeps A, of whatever order the one before was, and makes room for the matrix of Newton's method.
    pub(super) fn keep_new(&mut self, matrix: &Matrix) {
        (self.plain, self.work) = (Some(matrix.clone()), Some(matrix.clone()));
    }

    /// Keeps A before it is factored: of a dense one the part of its first `order` unknowns, if rows have entries for those alone and the others couple to nothing.
    pub fn keep(&mut self, matrix: &Matrix, order: usize) {
        let plain = self.plain.get_or_insert_with(|| matrix.clone());
        plain.copy_leading(matrix, order);
    }

    /// Whether problems with these laws are solved: every row is one of a contact.
    pub fn solves(laws: &[RowLaw]) -> bool {
        laws.iter().all(|law| *law != RowLaw::Free)
    }

    /// Begins a problem of rows with the given laws: each is then shown by [`Augmented::push`].
    pub fn begin(&mut self, laws: &[RowLaw]) {
        self.laws.clear();
        self.laws.extend_from_slice(laws);
        self.groups.clear();
        self.of_normal.clear();
        self.of_normal.resize(laws.len(), usize::MAX);
        for (i, law) in laws.iter().enumerate() {
            match *law {
                RowLaw::Free | RowLaw::Unilateral => {
                    self.of_normal[i] = self.groups.len();
                    self.groups.push(Group { normal: i, friction: [0; 2], count: 0 });
                }
                RowLaw::Friction { normal, .. } | RowLaw::Slip { normal, .. } => {
                    if let Some(group) = self.groups.get_mut(self.of_normal[normal])
                        && group.count < 2
                    {
                        group.friction[group.count] = i;
                        group.count += 1;
                    }
                }
            }
        }
        self.entries.clear();
        self.begins.clear();
        self.begins.push(0);
        self.guess.clear();
    }

    /// A guess of the multiplier of the row pushed last, where all rows get one: Newton's method begins with the motion that they make, gradients with them.
    pub fn guess(&mut self, multiplier: f64) {
        self.guess.push(multiplier);
    }

    /// Gives all contacts one stiffness, of their normal rows and of those of friction: norms are measured by it.
    pub fn measure_by(&mut self, stiffness: [f64; 2]) {
        self.common = Some(stiffness);
    }

    /// The next row of G.
    pub fn push(&mut self, entries: impl Iterator<Item = (usize, f64)>) {
        self.entries.extend(entries.filter(|(_, x)| *x != 0.0));
        self.begins.push(self.entries.len());
    }

    fn row(&self, i: usize) -> &[(usize, f64)] {
        &self.entries[self.begins[i]..self.begins[i + 1]]
    }

    /// Solves for Λ, from Λ₀ in `lambda`, with u = b of Λ₀, and adds y to `x`; `factored` is the matrix that was kept, with its factors.
    ///
    /// # Errors
    /// [`Unresolved`], with the residual that is left; at once where b is not finite.
    pub fn solve(
        &mut self,
        factored: &mut Matrix,
        b: &[f64],
        lambda: &mut [f64],
        x: &mut [f64],
    ) -> Result<(), Unresolved> {
        if !b.iter().all(|b| b.is_finite()) {
            return Err(Unresolved { rows: self.laws.len(), sweeps: 0, change: f64::NAN });
        }
        let order = factored.order();
        for list in [&mut self.force, &mut self.image, &mut self.motion] {
            list.clear();
            list.resize(order, 0.0);
        }
        self.start.clear();
        self.start.extend_from_slice(lambda);
        self.rates.clear();
        self.rates.extend_from_slice(b);
        self.measure();
        (self.iterations, self.residual, self.unsettled) = (0, f64::INFINITY, 0.0);
        self.best.0 = f64::INFINITY;
        let mut y = std::mem::take(&mut self.motion);
        let [first, others @ ..] = STIFFNESSES;
        let settled = self.attempt(factored, b, lambda, &mut y, first)
            || self.descend(factored, b, lambda, &mut y)
            || others.into_iter().any(|ratio| self.attempt(factored, b, lambda, &mut y, ratio))
            || self.take_best(factored, b, lambda, &mut y);
        if settled {
            x.iter_mut().zip(&y).for_each(|(x, y)| *x += y);
        }
        self.motion = y;
        if settled {
            return Ok(());
        }
        lambda.copy_from_slice(&self.start);
        Err(Unresolved { rows: self.laws.len(), sweeps: self.iterations, change: self.residual })
    }

    /// The stiffness of every contact.
    fn measure(&mut self) {
        let Augmented { groups, entries, begins, stiffness, plain, common, .. } = self;
        let Some(plain) = plain else { return };
        stiffness.clear();
        if let Some(common) = common {
            stiffness.resize(groups.len(), *common);
            return;
        }
        stiffness.extend(groups.iter().map(|group| {
            let of_row = |i: usize| {
                let least = entries[begins[i]..begins[i + 1]].iter();
                let least =
                    least.map(|(j, g)| plain.get(*j, *j).abs() / (g * g)).fold(f64::INFINITY, f64::min);
                if least.is_finite() && least > 0.0 { least } else { 1.0 }
            };
            let friction = group.friction[..group.count].iter().map(|i| of_row(*i));
            [of_row(group.normal), friction.fold(0.0, f64::max)]
        }));
    }

    /// One attempt; whether it settled.
    fn attempt(
        &mut self,
        factored: &mut Matrix,
        b: &[f64],
        lambda: &mut [f64],
        y: &mut [f64],
        ratio: f64,
    ) -> bool {
        if self.guess.len() == b.len() && ratio == STIFFNESSES[0] {
            // The motion of the guess shows what every contact does.
            let guess = std::mem::take(&mut self.guess);
            self.rates_by(factored, b, &guess, y);
            self.guess = guess;
        } else {
            y.fill(0.0);
        }
        self.ratio = ratio;
        self.centre.clear();
        self.centre.extend_from_slice(&self.start);
        self.before.clear();
        self.rates_before.clear();
        let (mut last, mut last_moved) = (f64::INFINITY, f64::INFINITY);
        for _ in 0..ITERATIONS {
            self.iterations += 1;
            self.rates_of(b, y);
            self.project(lambda);
            if self.has_settled() {
                self.move_by(factored, b, lambda, y);
                let falls = self.residual < FALLING * last;
                let moved = self.moved(lambda);
                let tolerable = if moved <= SETTLED { BESIDE } else { TOLERABLE };
                if self.residual <= SETTLED || (!falls && self.residual <= tolerable) {
                    return true;
                }
                if moved > FALLING * last_moved {
                    self.ratio = (STIFFER * self.ratio).min(STIFFEST);
                }
                self.rates_before.clone_from(&self.rates);
                (last, last_moved) = (self.residual, moved);
                self.centre.copy_from_slice(lambda);
                self.project(lambda);
            }
            std::mem::swap(&mut self.states, &mut self.before);
            if !self.improve(lambda, y) {
                return false;
            }
        }
        // Directions of slip that settle slowly.
        self.move_by(factored, b, lambda, y);
        self.residual <= TOLERABLE
    }

    /// The motion y that multipliers make, and the residual of both.
    fn move_by(&mut self, factored: &mut Matrix, b: &[f64], lambda: &[f64], y: &mut [f64]) {
        self.rates_by(factored, b, lambda, y);
        self.residual = self.judge(lambda);
    }

    /// u = b + G y
    fn rates_of(&mut self, b: &[f64], y: &[f64]) {
        for i in 0..self.laws.len() {
            let change: f64 = self.row(i).iter().map(|(j, g)| g * y[*j]).sum();
            self.rates[i] = b[i] + change;
        }
    }

    /// Λ = Π(Λ̂ − ρ u), and what every contact does.
    fn project(&mut self, lambda: &mut [f64]) {
        self.states.clear();
        for (k, (group, stiffness)) in self.groups.iter().zip(&self.stiffness).enumerate() {
            let ratio = self.ratio;
            let rho = |i: usize| ratio * stiffness[usize::from(i != group.normal)];
            let z = |i: usize| self.centre[i] - rho(i) * self.rates[i];
            let mut state = projected(group, &self.laws, z, lambda);
            if let (State::Slips([a, b], _), Some(State::Slips([c, d], _))) = (state, self.before.get(k))
                && a * c + b * d < 0.0
            {
                // Between two directions against each other it sticks: the next step is that of one that does.
                group.friction[..group.count].iter().for_each(|i| lambda[*i] = z(*i));
                state = State::Sticks;
            }
            self.states.push(state);
        }
    }

    /// Whether contacts stick, slip and are open as in the iteration before, and the directions in which they slip have settled.
    fn has_settled(&self) -> bool {
        self.states.len() == self.before.len()
            && self.states.iter().zip(&self.before).all(|(now, before)| match (now, before) {
                (State::Slips(a, _), State::Slips(b, _)) => (a[0] - b[0]).abs() + (a[1] - b[1]).abs() <= 1e-6,
                (now, before) => now == before,
            })
    }

    /// Largest change of u since the proximal step before, in terms of the largest multiplier.
    fn moved(&self, lambda: &[f64]) -> f64 {
        if self.rates_before.len() != self.rates.len() {
            return f64::INFINITY;
        }
        let largest = lambda.iter().fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
        let mut moved = 0.0_f64;
        for (group, stiffness) in self.groups.iter().zip(&self.stiffness) {
            for i in group.rows() {
                let change = self.rates[i] - self.rates_before[i];
                moved = moved.max(change.abs() * stiffness[usize::from(i != group.normal)]);
            }
        }
        moved / largest
    }

    /// Gᵀ (Λ − Λ₀) into `force`.
    fn put_force(&mut self, lambda: &[f64]) {
        self.force.fill(0.0);
        for i in 0..self.laws.len() {
            let change = lambda[i] - self.start[i];
            if change != 0.0 {
                for (j, g) in &self.entries[self.begins[i]..self.begins[i + 1]] {
                    self.force[*j] += g * change;
                }
            }
        }
    }

    /// Largest |Λ − Π(Λ − s u)| over the largest multiplier.
    fn judge(&mut self, lambda: &[f64]) -> f64 {
        let mut projection = std::mem::take(&mut self.projection);
        projection.clear();
        projection.extend_from_slice(&self.start);
        let (mut largest, mut worst) = (f64::MIN_POSITIVE, 0.0_f64);
        for (group, stiffness) in self.groups.iter().zip(&self.stiffness) {
            let z = |i: usize| lambda[i] - stiffness[usize::from(i != group.normal)] * self.rates[i];
            projected(group, &self.laws, z, &mut projection);
            for i in group.rows() {
                largest = largest.max(lambda[i].abs());
                let off = (lambda[i] - projection[i]).abs();
                worst = if off.is_nan() { f64::INFINITY } else { worst.max(off) };
            }
        }
        self.projection = projection;
        if worst == 0.0 { 0.0 } else { worst / largest }
    }

    /// One step of Newton's method from y; `false` where its matrix is singular.
    fn improve(&mut self, lambda: &[f64], y: &mut [f64]) -> bool {
        self.put_force(lambda);
        let Some(plain) = &self.plain else { return false };
        plain.multiply(y, &mut self.image);
        let mut work = match self.work.take() {
            Some(mut work) => {
                work.copy_from(plain);
                work
            }
            None => plain.clone(),
        };
        // The states were swapped into those before.
        for ((group, stiffness), state) in self.groups.iter().zip(&self.stiffness).zip(&self.before) {
            let mut add = |of: usize, by: usize, x: f64| {
                let (rows, columns) = (self.row(of), self.row(by));
                let rho = self.ratio * stiffness[usize::from(by != group.normal)];
                for (i, g) in rows {
                    columns.iter().for_each(|(j, h)| work.add(*i, *j, rho * x * g * h));
                }
            };
            let friction = &group.friction[..group.count];
            if *state != State::Open {
                add(group.normal, group.normal, 1.0);
            }
            match *state {
                State::Open | State::Closed => {}
                State::Sticks => friction.iter().for_each(|i| add(*i, *i, 1.0)),
                State::Given(slopes) => {
                    friction.iter().zip(slopes).for_each(|(i, slope)| add(*i, group.normal, -slope));
                }
                State::Slips(along, turning) => {
                    let RowLaw::Friction { coefficient, .. } = self.laws[friction[0]] else { continue };
                    for (a, &i) in friction.iter().enumerate() {
                        add(i, group.normal, coefficient * along[a]);
                        for (c, &j) in friction.iter().enumerate() {
                            let unit = f64::from(u8::from(a == c)) - along[a] * along[c];
                            if unit != 0.0 && turning > 0.0 {
                                add(i, j, turning * unit);
                            }
                        }
                    }
                }
            }
        }
        let factored = work.factor();
        let ok = factored.is_ok();
        if ok {
            for (f, image) in self.force.iter_mut().zip(&self.image) {
                *f -= image;
            }
            work.solve(&mut self.force);
            let part = self.part();
            y.iter_mut().zip(&self.force).for_each(|(y, d)| *y += part * d);
        }
        self.work = Some(work);
        ok && y.iter().all(|y| y.is_finite())
    }

    /// The part of the step δ in `force` to take, from y with A y in `image`: all of it, or up to where δᵀF changes its sign, if it has grown by then. Without
    /// friction F is the gradient of a convex function that this part makes least along δ, so that the iteration cannot go to and fro.
    fn part(&mut self) -> f64 {
        let Some(plain) = &self.plain else { return 1.0 };
        let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
        let first = dot(&self.force, &self.image);
        plain.multiply(&self.force, &mut self.image);
        let second = dot(&self.force, &self.image);
        let mut turn = std::mem::take(&mut self.turn);
        turn.clear();
        let along = |i: usize| self.row(i).iter().map(|(j, g)| g * self.force[*j]).sum::<f64>();
        turn.extend((0..self.laws.len()).map(along));
        let mut projection = std::mem::take(&mut self.projection);
        projection.clear();
        projection.extend_from_slice(&self.start);
        let mut slope = |part: f64| {
            for (group, stiffness) in self.groups.iter().zip(&self.stiffness) {
                let z = |i: usize| {
                    let rho = self.ratio * stiffness[usize::from(i != group.normal)];
                    self.centre[i] - rho * (self.rates[i] + part * turn[i])
                };
                projected(group, &self.laws, z, &mut projection);
            }
            let forces =
                turn.iter().zip(&projection).zip(&self.start).map(|((turn, x), start)| turn * (x - start));
            first + part * second - forces.sum::<f64>()
        };
        let begin = slope(0.0);
        let mut bounds = [0.0, 1.0];
        if begin < 0.0 && slope(1.0) > -begin {
            for _ in 0..HALVINGS {
                let middle = 0.5 * (bounds[0] + bounds[1]);
                bounds[usize::from(slope(middle) > 0.0)] = middle;
            }
        }
        (self.projection, self.turn) = (projection, turn);
        bounds[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Structure;

    /// The body of a box (m, I₁, I₂) with a point at each of these places below it, pressed by its weight 1 and a push of 0.1 along y.
    fn solved(places: &[[f64; 2]], friction: f64) -> (Vec<f64>, Augmented) {
        // v_x, v_y, v_z, ω_x, ω_y
        let mut matrix = Matrix::new(&Structure::dense(5));
        [2.0, 2.0, 2.0, 0.3, 0.5].iter().enumerate().for_each(|(i, x)| matrix.add(i, i, *x));
        let n = places.len();
        let mut laws = vec![RowLaw::Unilateral; n];
        for k in 0..n {
            laws.extend([RowLaw::Friction { coefficient: friction, normal: k }; 2]);
        }
        let free = [0.0, 0.05, -0.5, 0.0, 0.0];
        let mut many = Augmented::default();
        many.begin(&laws);
        let rows: Vec<[f64; 5]> = places
            .iter()
            .map(|[x, y]| [0.0, 0.0, 1.0, *y, -x])
            .chain(places.iter().flat_map(|_| [[1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0]]))
            .collect();
        let along = |row: &[f64; 5]| row.iter().zip(free).map(|(g, x)| g * x).sum::<f64>();
        let b: Vec<f64> = rows.iter().map(along).collect();
        rows.iter().for_each(|row| many.push(row.iter().copied().enumerate()));
        many.keep(&matrix, 5);
        matrix.factor().unwrap();
        let (mut lambda, mut x) = (vec![0.0; 3 * n], vec![0.0; 5]);
        many.solve(&mut matrix, &b, &mut lambda, &mut x).unwrap();
        (lambda, many)
    }

    /// On more than three points the forces of the least norm are linear in the place, and so equal on the four corners of a box.
    #[test]
    fn of_redundant_contacts_the_forces_of_least_norm_are_found() {
        let corners = [[1.0, 0.5], [-1.0, 0.5], [-1.0, -0.5], [1.0, -0.5]];
        let (forces, many) = solved(&corners, 0.6);
        for k in 0..4 {
            assert!((forces[k] - 0.25).abs() < 1e-11, "{forces:?}");
            // The push is held by all alike.
            assert!((forces[4 + 2 * k + 1] + 0.025).abs() < 1e-11, "{forces:?}");
        }
        assert!(many.residual < 1e-11 && many.iterations < 20, "{} {}", many.residual, many.iterations);
        // Of points to one side of the centre, that farthest away opens, and the others carry the weight where its moment is zero.
        let (forces, _) = solved(&[[1.0, 0.0], [0.5, 0.3], [0.5, -0.3], [-0.1, 0.2], [-0.1, -0.2]], 0.6);
        let moment: f64 = forces[..5].iter().zip([1.0, 0.5, 0.5, -0.1, -0.1]).map(|(f, x)| f * x).sum();
        let weight: f64 = forces[..5].iter().sum();
        assert!((weight - 1.0).abs() < 1e-11 && moment.abs() < 1e-11, "{forces:?}");
        assert!(forces.iter().take(5).all(|f| *f >= 0.0));
    }

    #[test]
    fn contacts_slip_on_the_rim_of_the_disc() {
        let (forces, _) = solved(&[[1.0, 0.5], [-1.0, 0.5], [-1.0, -0.5], [1.0, -0.5]], 0.06);
        for k in 0..4 {
            let [x, y] = [forces[4 + 2 * k], forces[4 + 2 * k + 1]];
            assert!(x.abs() < 1e-11 && (y + 0.06 * 0.25).abs() < 1e-11, "{forces:?}");
        }
    }
}
