//! The equations of an equilibrium under a part of the loads, and Newton's method for them.
//!
//! With r_s the residual under the part s of the loads and r₀ that without loads in the configuration at the start,
//!
//! ```text
//! F(q, λ, s) = ⎡ r_s(q, 0, 0, λ) − (1 − s) r₀ ⎤ = 0,     J = ⎡ K  −Gᵀ⎤,     q ← q ⊞ Δq
//!              ⎣ −g(q)                        ⎦              ⎣−G   0 ⎦
//! ```
//!
//! At a given s the increments are −J⁻¹F. Along a path s is unknown too, and every increment is orthogonal to the direction t of
//! the path, (Δq, Δs)·t = 0 (Riks's normal plane): two solutions with J, which is singular at limit points alone. Loads are
//! linear in s, so that ∂F/∂s = r_{s+½} − r_{s−½} + r₀.
//!
//! A contact is a row as long as it is closed: g ≥ 0, λ ≥ 0, λ g = 0. Behind every solution the one deepest inside its obstacle is
//! closed, or else the one that pulls most is opened, and the equations are solved again, until there is none. Contacts have no
//! friction here.
//!
//! Source: E. Riks, *Int. J. Solids Struct.* 15 (1979) 529–551, doi:10.1016/0020-7683(79)90081-7.

use super::joints;
use super::stiffness::matrices;
use crate::linalg::Matrix;
use crate::linalg::eigen::negative_directions;
use crate::system::{Parameter, State, System, Weights};

/// Iterations allowed at one level, and at one point of a path.
const ITERATIONS: [u32; 2] = [25, 10];
/// Changes of contacts at one level, for each row.
const CHANGES: usize = 4;
/// Scaled size of an increment at which the iteration has converged.
const TOLERANCE: f64 = 1e-11;

/// Scaled size of increments that are rounding if so many of them in a row are not halved: an element that is far shorter than the beam takes digits of
/// its deflection.
const ROUNDING: f64 = 1e-5;
const STALLED: u32 = 3;
/// Largest increment at the end of an iteration over that by which all of the loads would move the system.
const UNBALANCED: f64 = 1e-2;
/// Scaled size below which an increment is small whatever the loads are, for rounding may bend a beam by more than loads along it shorten it; and where
/// motions are held: the held part of an increment shrinks slowly however small it is.
const SMALL: [f64; 2] = [1e-9, 1e-13];

const IN_TURN: &str = "contacts open and close in turn";

/// Why an iteration has ended.
pub(super) struct Failure {
    pub what: String,
    /// Whether J was singular.
    pub singular: bool,
    /// Number of the worst unknown.
    pub worst: usize,
}

impl Failure {
    /// One of no unknown.
    pub(super) fn of(what: &str) -> Failure {
        Failure { what: what.to_owned(), singular: false, worst: 0 }
    }
}

/// A direction of a path: increments of the unknowns and of the part s.
#[derive(Clone, Debug)]
pub(super) struct Direction {
    pub unknowns: Vec<f64>,
    pub part: f64,
}

/// The equations of a system.
pub(super) struct Equations<'a> {
    pub system: &'a mut dyn System,
    pub iterations: u32,
    /// Weight σ of the masses in J, K + σM in the place of K: it holds motions that have no stiffness.
    pub hold: f64,
    /// Iterations allowed at a level.
    pub allowed: u32,
    scales: Vec<f64>,
    start: Vec<f64>,
    tangent: Matrix,
    r: Vec<f64>,
    by_part: Vec<f64>,
    moved: Vec<f64>,
}

impl<'a> Equations<'a> {
    /// Those that begin at `state`, whose velocities and accelerations become zero.
    pub(super) fn new(system: &'a mut dyn System, state: &mut State) -> Equations<'a> {
        state.v.fill(0.0);
        state.a.fill(0.0);
        let (n, m) = (state.v.len(), state.lambda.len());
        let (scales, tangent) = (system.scales().to_vec(), Matrix::new(&system.structure(1)));
        let mut start = vec![0.0; n];
        apply(system, 0.0);
        system.residual(state, &mut start);
        let (r, by_part, moved) = (vec![0.0; n + m], vec![0.0; n + m], state.q.clone());
        Equations {
            system,
            iterations: 0,
            hold: 0.0,
            allowed: ITERATIONS[0],
            scales,
            start,
            tangent,
            r,
            by_part,
            moved,
        }
    }

    /// Writes F into `r`.
    fn residual(&mut self, state: &State, part: f64) {
        apply(self.system, part);
        let (motion, rows) = self.r.split_at_mut(state.v.len());
        self.system.residual(state, motion);
        joints::positions(self.system, state, rows);
        for (r, start) in motion.iter_mut().zip(&self.start) {
            *r -= (1.0 - part) * start;
        }
    }

    /// Factors J at a state and a part of the loads.
    fn factor(&mut self, state: &State, part: f64) -> Result<(), Failure> {
        self.assemble(state, part);
        self.factor_assembled()
    }

    /// Writes J at a state and a part of the loads into `tangent`.
    fn assemble(&mut self, state: &State, part: f64) {
        apply(self.system, part);
        self.system.tangent(state, Weights::new(self.hold, 0.0, 1.0), &mut self.tangent);
        joints::add(self.system, state, state.v.len(), &mut self.tangent);
    }

    fn factor_assembled(&mut self) -> Result<(), Failure> {
        let factored = self.tangent.factor_equilibrated();
        factored.map(|_| ()).map_err(|e| Failure { what: e.to_string(), singular: true, worst: e.index })
    }

    /// Writes J⁻¹ ∂F/∂s into `by_part`, with J factored.
    fn solve_by_part(&mut self, state: &State, part: f64) {
        let n = state.v.len();
        let mut below = vec![0.0; n];
        apply(self.system, part - 0.5);
        self.system.residual(state, &mut below);
        apply(self.system, part + 0.5);
        self.system.residual(state, &mut self.by_part[..n]);
        apply(self.system, part);
        for ((f, below), start) in self.by_part.iter_mut().zip(&below).zip(&self.start) {
            *f += start - below;
        }
        self.by_part[n..].fill(0.0);
        self.tangent.solve(&mut self.by_part);
    }

    /// Scaled inner product of two directions, the mean over the velocities.
    pub(super) fn inner(&self, a: (&[f64], f64), b: (&[f64], f64)) -> f64 {
        let n = self.scales.len() as f64;
        let terms = a.0.iter().zip(b.0).zip(&self.scales);
        terms.map(|((a, b), scale)| a * b / (scale * scale)).sum::<f64>() / n + a.1 * b.1
    }

    /// The direction of the path at an equilibrium, of length one, along `before` or, without it, with growing loads.
    pub(super) fn direction(
        &mut self,
        state: &State,
        part: f64,
        before: Option<&Direction>,
    ) -> Result<Direction, Failure> {
        self.factor(state, part)?;
        self.solve_by_part(state, part);
        let x: Vec<f64> = self.by_part.iter().map(|x| -x).collect();
        let size = self.inner((&x, 1.0), (&x, 1.0)).sqrt();
        let along = before.map_or(1.0, |b| self.inner((&x, 1.0), (&b.unknowns, b.part)));
        let factor = if along < 0.0 { -1.0 / size } else { 1.0 / size };
        Ok(Direction { unknowns: x.iter().map(|x| factor * x).collect(), part: factor })
    }

    /// Moves a state by `step` along a direction.
    pub(super) fn advance(&mut self, state: &mut State, part: &mut f64, along: &Direction, step: f64) {
        let d: Vec<f64> = along.unknowns.iter().map(|x| step * x).collect();
        self.take(state, &d);
        *part += step * along.part;
    }

    /// The scales of the unknowns.
    pub(super) fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// The residual under all of the loads.
    pub(super) fn forces(&mut self, state: &State) -> Vec<f64> {
        self.residual(state, 1.0);
        self.r[..state.v.len()].to_vec()
    }

    /// The increment −J⁻¹F under all of the loads that keeps contacts apart and lets none pull, to the first order; `None` where K + σM is negative in
    /// some direction that the rows allow.
    pub(super) fn sink(&mut self, state: &mut State) -> Result<Option<Vec<f64>>, Failure> {
        let m = state.lambda.len();
        for _ in 0..CHANGES * (1 + m) {
            self.residual(state, 1.0);
            self.assemble(state, 1.0);
            if negative_directions(&self.tangent, m) > 0 {
                return Ok(None);
            }
            self.factor_assembled()?;
            self.tangent.solve(&mut self.r);
            let d: Vec<f64> = self.r.iter().map(|x| -x).collect();
            if !joints::change_contact_behind(self.system, state, &d) {
                return Ok(Some(d));
            }
        }
        Err(Failure::of(IN_TURN))
    }

    /// Moves a state by an increment of the unknowns.
    pub(super) fn take(&mut self, state: &mut State, d: &[f64]) {
        let (d, multipliers) = d.split_at(state.v.len());
        self.system.retract(&state.q, d, &mut self.moved);
        state.q.copy_from_slice(&self.moved);
        state.lambda.iter_mut().zip(multipliers).for_each(|(lambda, x)| *lambda += x);
    }

    /// Solves for an equilibrium from a state near it: at the part of the loads given, or in the plane across a path. Contacts
    /// close and open.
    pub(super) fn solve(
        &mut self,
        state: &mut State,
        part: &mut f64,
        path: Option<&Direction>,
    ) -> Result<u32, Failure> {
        let mut taken = 0;
        for _ in 0..CHANGES * (1 + state.lambda.len()) {
            taken += self.converge(state, part, path)?;
            if !joints::change_contact(self.system, state) {
                return Ok(taken);
            }
        }
        Err(Failure::of(IN_TURN))
    }

    /// [`solve`](Equations::solve) with the contacts that are closed.
    fn converge(
        &mut self,
        state: &mut State,
        part: &mut f64,
        path: Option<&Direction>,
    ) -> Result<u32, Failure> {
        let allowed = if path.is_some() { ITERATIONS[1] } else { self.allowed };
        let (mut least, mut stalled) = (f64::INFINITY, 0);
        for iteration in 0..=allowed {
            self.residual(state, *part);
            if self.r.iter().all(|r| *r == 0.0) {
                return Ok(iteration);
            }
            self.factor(state, *part)?;
            self.tangent.solve(&mut self.r);
            let mut change = 0.0;
            if let Some(t) = path {
                self.solve_by_part(state, *part);
                let along = |x: &[f64]| self.inner((x, 0.0), (&t.unknowns, 0.0));
                change = along(&self.r) / (t.part - along(&self.by_part));
            }
            let terms = self.r.iter().zip(&self.by_part);
            let d: Vec<f64> = match path {
                Some(_) => terms.map(|(x, by_part)| -x - change * by_part).collect(),
                None => self.r.iter().map(|x| -x).collect(),
            };
            self.take(state, &d);
            *part += change;
            self.iterations += 1;
            let (worst, size) = largest(&d, &self.scales);
            let size = if change.abs() <= size { size } else { change.abs() };
            stalled = if size > 0.5 * least { stalled + 1 } else { 0 };
            // Converged, or as far as rounding lets it come.
            let ended = size <= TOLERANCE
                || (size < 1e-7 && size > 0.3 * least)
                || (size < ROUNDING && stalled >= STALLED);
            let mut response = f64::INFINITY;
            if ended && size > SMALL[usize::from(self.hold > 0.0)] {
                if path.is_none() {
                    self.solve_by_part(state, *part);
                }
                response = largest(&self.by_part, &self.scales).1;
            }
            if ended && (size <= UNBALANCED * response || response == 0.0) {
                apply(self.system, *part);
                return self.system.admissible(state).map(|()| iteration + 1).map_err(|limit| Failure {
                    what: limit.to_string(),
                    singular: false,
                    worst: 0,
                });
            }
            if !(size < 1e3) || iteration == allowed {
                let what = if ended {
                    format!(
                        "rounding of the stiffness hides the loads: increments stay at {size:.1e} of the size of the system, and all of the loads make \
                         one of {response:.1e}; take fewer elements, or leave the shear out of a beam that is so slender"
                    )
                } else {
                    format!("Newton's method does not converge (increment {size:.1e})")
                };
                return Err(Failure { what, singular: false, worst });
            }
            least = size.min(least);
        }
        Ok(allowed)
    }
}

/// The largest ratio of the entries of K and M on the diagonal, about the square of the highest frequency [1/s²].
pub(super) fn highest(system: &mut dyn System, state: &State) -> f64 {
    let ([mass, _, stiffness], _) = matrices(system, state);
    let ratios = (0..state.v.len()).map(|i| (stiffness.get(i, i) / mass.get(i, i)).abs());
    ratios.filter(|x| x.is_finite()).fold(0.0, f64::max)
}

/// Applies a part of the loads; a model without loads has none to follow.
pub(super) fn apply(system: &mut dyn System, part: f64) {
    let _ = system.set(Parameter::LoadFactor, part);
}

/// Index and scaled size of the largest increment (a NaN counts as largest).
pub(super) fn largest(d: &[f64], scale: &[f64]) -> (usize, f64) {
    let mut worst = (0, 0.0);
    for (i, (d, scale)) in d.iter().zip(scale).enumerate() {
        let size = (d / scale).abs();
        if !(size <= worst.1) {
            worst = (i, size);
        }
    }
    worst
}
