//! Nonsmooth generalized-α: fixed step, order 2 while no contact acts and order 1 across impacts.
//!
//! The motion of a step is split into a smooth part, a correction U of the position and a jump W of the velocity,
//!
//! ```text
//! qₙ₊₁ = q̃ ⊞ U,     vₙ₊₁ = ṽ + W
//! ```
//!
//! so that contacts are imposed at both levels, which Moreau's scheme does at the level of velocities only:
//!
//! ```text
//! position   g(qₙ₊₁) ≥ 0 ⟂ ν ≥ 0                                              no penetration at the end of a step
//! velocity   ġ(qₙ₊₁, vₙ₊₁) + e ġₙ ≥ 0 ⟂ P ≥ 0   where the position is at its bound,   P = 0 elsewhere
//! friction   |P_t| ≤ μ Pₙ, opposite to the sliding velocity (a disc)
//! ```
//!
//! No event is located: any number of impacts may fall into a step. Joints hold exactly at both levels.
//!
//! A contact that stays closed acts over the whole step, in directions that turn with the motion: its impulse is ½ (G(qₙ) + G(qₙ₊₁))ᵀ P, the trapezium rule, where G(qₙ₊₁)ᵀ P
//! would make the method one of order 1 (a point on a sphere: order 2, with 1/180 of the error at 1 ms). A contact that did not act at the start of the step acts
//! along G(qₙ₊₁), as does friction whose tangents turn about the normal by themselves: those of a sphere do, the more the nearer to its poles.
//!
//! *Coupled* (`coupled.rs`): all is solved at once, and forces are those of the end of the step,
//!
//! ```text
//! r(tₙ₊₁, qₙ₊₁, vₙ₊₁, q̈, λ̃) = 0,   ġ(qₙ₊₁, ṽ) = 0 of joints,   M U = Gᵀ ν,   M W = Gᵀ P
//! ```
//!
//! so that the vibrations of a body in contact are those of the generalized-α method. M must be regular.
//!
//! *Decoupled* (`decoupled.rs`): three problems, one after the other. The smooth motion is a step of the
//! [generalized-α method](super::GeneralizedAlpha) in its stabilized form, with all contacts open. The two corrections
//! are each a constant acceleration α over the step, by forces λ of the contacts, which the other forces see:
//!
//! ```text
//! r(tₙ₊₁, q̃ ⊞ ½h²α, ṽ + hα, q̈ + α, λ̃ + λ) = 0,     U = ½h²α, ν = ½h²λ   or   W = hα, P = hλ
//! ```
//!
//! with the matrix M + hC + ½h²K, so that a node without mass is admitted; the contacts act along directions that a correction does not change, of q̃ and of qₙ₊₁. What the contacts change of the forces is not
//! in the accelerations that the smooth motion remembers; acting as an impulse over one step it has its full effect.
//!
//! Sources: Brüls, Acary & Cardona (2014, doi 10.1016/j.cma.2014.07.025); Cosimo, Galvez, Cavalieri, Cardona & Brüls
//! (2020, doi 10.1007/s11044-019-09706-6), who correct the position by h² and not ½h² times the change of acceleration:
//! a constant force then shifts the position by O(h). Friction at the level of positions, which keeps a contact that
//! sticks from creeping, is Capobianco, Harsch, Eugster & Leine's (2021, doi 10.1002/nme.6801) in purpose, not in form.

mod coupled;
mod decoupled;
mod memory;

use super::generalized_alpha::AlphaSteps;
use super::impulses::{Closing, Impulses};
use super::rows::Rows;
use super::{
    Attempt, Checkpoint, Convergence, Counters, GeneralizedAlpha, Info, Integrator, InvalidParameter,
    NotResumed, Progress, Span, StepError, StepReport, Stepper, failure, hermite,
};
use crate::contact::Unresolved;
use crate::linalg::Matrix;
use crate::system::{Dynamics, Mode, Set, State};
use memory::Coupled;
use std::cell::Cell;

/// Name as in a case file.
const NAME: &str = "nonsmooth-generalized-alpha";

/// Iteration error of the corrections, relative to the scales of the unknowns.
const TOLERANCE: f64 = 1e-12;

/// Part of the limit of friction from which on a contact slips.
const SLIPPING: f64 = 1.0 - 1e-9;

/// The nonsmooth generalized-α method. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct NonsmoothAlpha {
    info: Info,
    smooth: GeneralizedAlpha,
    coupled: bool,
}

/// The method with its memory.
struct NonsmoothSteps {
    scheme: Scheme,
    work: Work,
}

/// The memory of the smooth motion.
enum Scheme {
    Decoupled(Box<AlphaSteps>),
    Coupled(Box<Coupled>),
}

/// Largest increment, over the largest of a correction, at which it ends where the forces of contacts do not settle.
const LEFT: f64 = 0.1;

/// What a correction imposes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Level {
    Position,
    Velocity,
}

/// Memory that both schemes need.
struct Work {
    convergence: Convergence,
    /// Whether a contact acted in the last step.
    corrected: bool,
    matrix: Matrix,
    rows: Rows,
    impulses: Impulses,
    /// What the cone problems of the last iteration have left, of the position and of the velocity.
    residuals: [f64; 2],
    /// How fast contacts close before each correction of the velocity.
    closing: Closing,
    /// Jacobian at the start of the step, and the rows that acted then, but for friction that twists; whether a contact that takes part is one of them.
    before: Rows,
    acted: Vec<bool>,
    twists: Vec<bool>,
    turns: bool,
    /// The start of the step with all contacts open and the accelerations of the smooth motion; its end.
    from: State,
    smooth: State,
    /// Where the forces of a correction are evaluated.
    trial: State,
    /// α, ½h²α, and the multipliers of the contacts.
    alpha: Vec<f64>,
    increment: Vec<f64>,
    /// U of the step, and memory for q₀ ⊞ s d.
    correction: Vec<f64>,
    uncorrected: Cell<Vec<f64>>,
    forces: Vec<f64>,
    /// What a correction of velocities changes of the multipliers.
    change: Vec<f64>,
    /// Multipliers of the smooth motion at the start of the next step, and the mean ones of the accepted step.
    held: Vec<f64>,
    mean: Vec<f64>,
    rhs: Vec<f64>,
    gaps: Vec<f64>,
    rates: Vec<f64>,
    /// ġ at the start of the step.
    start: Vec<f64>,
    takes_part: Vec<bool>,
    scale: Vec<f64>,
}

impl NonsmoothAlpha {
    /// The decoupled scheme with Chung & Hulbert's parameters for the spectral radius ρ∞ at infinite frequency.
    ///
    /// # Errors
    /// Outside 0 ≤ ρ∞ ≤ 1.
    pub fn decoupled(spectral_radius: f64) -> Result<NonsmoothAlpha, InvalidParameter> {
        Ok(NonsmoothAlpha {
            info: Info { name: NAME, order: 2, estimate_order: None, implicit: true },
            smooth: GeneralizedAlpha::chung_hulbert(spectral_radius)?,
            coupled: false,
        })
    }

    /// The coupled scheme, for systems with a regular mass matrix.
    ///
    /// # Errors
    /// Outside 0 ≤ ρ∞ ≤ 1.
    pub fn coupled(spectral_radius: f64) -> Result<NonsmoothAlpha, InvalidParameter> {
        Ok(NonsmoothAlpha { coupled: true, ..NonsmoothAlpha::decoupled(spectral_radius)? })
    }
}

impl Work {
    fn new(system: &mut dyn Dynamics, state: &State) -> Work {
        let size = system.size();
        let (n, m) = (size.v, size.lambda);
        let zeros = |n| vec![0.0; n];
        let state = || State::zeros(size, state.t);
        Work {
            convergence: Convergence::full(TOLERANCE, 1e-9),
            corrected: false,
            matrix: Matrix::new(&system.structure(1)),
            rows: Rows::new(system, &state()),
            impulses: Impulses::new(system, n + m),
            residuals: [0.0; 2],
            closing: Closing::default(),
            before: Rows::new(system, &state()),
            acted: vec![false; m],
            twists: (0..m).map(|row| system.twists(row)).collect(),
            turns: false,
            from: state(),
            smooth: state(),
            trial: state(),
            alpha: zeros(n),
            increment: zeros(n),
            correction: zeros(n),
            uncorrected: Cell::new(zeros(state().q.len())),
            forces: zeros(m),
            change: zeros(m),
            held: zeros(m),
            mean: zeros(m),
            rhs: zeros(n + m),
            gaps: zeros(m),
            rates: zeros(m),
            start: zeros(m),
            takes_part: vec![false; m],
            scale: system.scales().to_vec(),
        }
    }

    /// Writes (q₀ ⊞ s d) ⊞ s U: of an increment d that may be of several turns, and not of the rotation that the ends show.
    fn follow(&self, system: &dyn Dynamics, from: &State, d: &[f64], s: f64, out: &mut State) {
        let mut q = self.uncorrected.take();
        out.v.iter_mut().zip(d).for_each(|(part, d)| *part = s * d);
        system.retract(&from.q, &out.v, &mut q);
        let part = if self.corrected { s } else { 0.0 };
        out.v.iter_mut().zip(&self.correction).for_each(|(v, u)| *v = part * u);
        system.retract(&q, &out.v, &mut out.q);
        self.uncorrected.set(q);
    }

    /// The start of a step: `from` with all contacts open and the accelerations of the smooth motion.
    fn begin(&mut self, from: &State) {
        (self.residuals, self.closing) = ([0.0; 2], Closing::default());
        (self.from.t, self.from.side) = (from.t, from.side);
        self.from.q.copy_from_slice(&from.q);
        self.from.v.copy_from_slice(&from.v);
        self.from.lambda.copy_from_slice(&from.lambda);
        self.from.copy_modes(from);
        let acted = self.acted.iter_mut().zip(&from.mode).zip(&self.twists);
        acted.for_each(|((acted, mode), twists)| *acted = *mode != Mode::Open && !twists);
        open(self.rows.sets(), &mut self.from);
        self.impulses.guess(&from.lambda);
    }

    /// Keeps the jacobian at the start of the step, where contacts that acted then take part.
    fn keep_directions(&mut self, system: &mut dyn Dynamics) {
        self.turns = self.acted.iter().zip(&self.takes_part).any(|(acted, now)| *acted && *now);
        if self.turns {
            self.before.store_jacobian(system, &self.from);
        }
    }

    /// Adds ½ (Gₙ₊₁ − Gₙ)ᵀ λ to `rhs`, with the stored Gₙ₊₁.
    fn turn(&mut self, lambda: &[f64]) {
        if !self.turns {
            return;
        }
        for (part, rows) in [(0.5, &self.rows), (-0.5, &self.before)] {
            for &(row, j, x) in rows.stored().iter().filter(|(row, ..)| self.acted[*row]) {
                self.rhs[j] += part * x * lambda[row];
            }
        }
    }

    /// The error of corrections that do not converge.
    fn not_converged(&self, system: &dyn Dynamics, step: f64, size: f64) -> StepError {
        let place = (self.from.t, step);
        failure::not_converged(system, place, &self.convergence, size / TOLERANCE, &self.rhs)
    }

    /// The error of contacts without a solution.
    fn unresolved(&self, system: &dyn Dynamics, step: f64, cause: Unresolved) -> StepError {
        failure::contacts(system, (self.from.t, step), cause, &self.rhs)
    }

    /// The end of the iterations of a step.
    ///
    /// # Errors
    /// Where a contact still closes.
    fn stopped(&self, system: &dyn Dynamics, step: f64) -> Result<(), StepError> {
        match self.closing.driven(step * step, &self.scale) {
            Some(row) => Err(failure::driven(system, (self.from.t, step), row)),
            None => Ok(()),
        }
    }

    /// Whether row `i` is a unilateral contact.
    fn is_contact(&self, i: usize) -> bool {
        matches!(self.rows.sets()[i], Set::Unilateral { .. })
    }

    /// Adds the contacts that `touches` to those that take part; whether there are new ones.
    fn admit(&mut self, touches: impl Fn(&Work, usize) -> bool) -> bool {
        let mut new = false;
        for i in 0..self.takes_part.len() {
            if !self.takes_part[i] && self.is_contact(i) && touches(self, i) {
                (self.takes_part[i], new) = (true, true);
            }
        }
        new
    }

    /// Judges no increment by one before it, of which other contacts took part; gives the iterations until then.
    fn begin_anew(&mut self) -> u32 {
        let before = self.convergence.iterations();
        self.convergence.begin(true);
        before
    }

    /// What follows from an increment of this size, and the largest one of the correction; `new` contacts take part since it. Where the forces have not settled, increments are
    /// no smaller than what is left of them lets them be; the part that is left of the largest is told with them.
    fn progress(&mut self, size: f64, largest: f64, new: bool) -> Progress {
        let unsettled = self.unsettled() > 0.0;
        match self.convergence.judge(size) {
            _ if new && size.is_finite() => Progress::Continue,
            Progress::Diverged if unsettled && size <= LEFT * largest => {
                self.residuals[0] = self.residuals[0].max(size / largest);
                Progress::Converged
            }
            progress => progress,
        }
    }

    /// Solves for the multipliers `forces` of the contacts with `matrix`, or with those of `other`, and adds what they do to
    /// the increment in `rhs`; in units of accelerations, by which velocities move as `to_v` and positions as `to_q`.
    fn solve_cone(
        &mut self,
        level: Level,
        [to_v, to_q]: [f64; 2],
        other: Option<(&mut Matrix, &mut [f64])>,
    ) -> Result<(), Unresolved> {
        let (sets, gaps, rates, start) = (self.rows.sets(), &self.gaps, &self.rates, &self.start);
        let (takes_part, forces) = (&self.takes_part, &self.forces);
        let strikes = |i: usize| other.is_none() || forces[i] > 0.0 || gaps[i] <= 0.0;
        self.impulses.choose(sets, |i| takes_part[i] && strikes(i));
        let value = |i: usize| match (sets[i], level) {
            (Set::Unilateral { .. }, Level::Position) => gaps[i] / to_q,
            (Set::Unilateral { restitution }, Level::Velocity) => {
                (rates[i] + restitution * start[i].min(0.0)) / to_v
            }
            _ => rates[i] / to_v,
        };
        let (matrix, forces) = match other {
            Some((matrix, forces)) => (matrix, forces),
            None => (&mut self.matrix, &mut self.forces[..]),
        };
        let solved = self.impulses.solve(matrix, &self.rows, value, forces, &mut self.rhs);
        self.residuals[level as usize] = self.impulses.residual;
        if level == Level::Velocity {
            self.closing.enter(&self.impulses);
        }
        solved
    }

    /// What the cone problems of a step have left.
    fn unsettled(&self) -> f64 {
        let [position, velocity] = self.residuals;
        position.max(velocity)
    }

    /// The modes of the rows by the forces `lambda`, for those who read the state: impulses decide about contacts.
    fn modes(&self, lambda: &[f64], modes: &mut [Mode]) {
        let sets = self.rows.sets();
        // A disc slips as a whole.
        let rubbing = |normal: usize| {
            let same = move |set: &Set| matches!(set, Set::Friction { normal: n, .. } if *n == normal);
            let rows = sets.iter().zip(lambda).filter(move |(set, _)| same(set));
            rows.map(|(_, x)| x * x).sum::<f64>().sqrt()
        };
        for (i, set) in sets.iter().enumerate() {
            modes[i] = match *set {
                Set::Free => Mode::Closed,
                Set::Unilateral { .. } if lambda[i] > 0.0 => Mode::Closed,
                Set::Friction { coefficient, normal } if lambda[normal] > 0.0 => {
                    if rubbing(normal) < SLIPPING * coefficient * lambda[normal] {
                        Mode::Closed
                    } else if lambda[i] < 0.0 {
                        Mode::SlipForward
                    } else {
                        Mode::SlipBackward
                    }
                }
                _ => Mode::Open,
            };
        }
    }
}

/// Opens all contacts.
fn open(sets: &[Set], state: &mut State) {
    for ((set, mode), lambda) in sets.iter().zip(&mut state.mode).zip(&mut state.lambda) {
        if *set == Set::Free {
            *mode = Mode::Closed;
        } else {
            (*mode, *lambda) = (Mode::Open, 0.0);
        }
    }
}

/// Gives `state` the modes, forces and accelerations of `closed` again, where contacts press: they do until the end of the first step.
fn press(sets: &[Set], closed: &State, state: &mut State) {
    let mut contacts = sets.iter().zip(&closed.lambda).filter(|(set, _)| **set != Set::Free);
    if contacts.any(|(_, force)| *force != 0.0) {
        state.copy_forces(closed);
    }
}

impl Integrator for NonsmoothAlpha {
    fn info(&self) -> &Info {
        &self.info
    }

    fn resolves_contacts(&self) -> bool {
        true
    }

    fn stepper(
        &self,
        system: &mut dyn Dynamics,
        state: &mut State,
        _step: f64,
        counters: &mut Counters,
    ) -> Result<Box<dyn Stepper>, StepError> {
        let closed = state.clone();
        open(system.rows(), state);
        // Without joints nothing is to be stabilized.
        let joints = system.rows().contains(&Set::Free);
        let smooth = self.smooth.clone();
        let smooth = if joints { smooth.stabilized() } else { smooth.positions_only() };
        let scheme = if self.coupled {
            Scheme::Coupled(Box::new(Coupled::new(system, state, &smooth)))
        } else {
            Scheme::Decoupled(Box::new(smooth.memory(system, state)))
        };
        let mut steps = NonsmoothSteps { scheme, work: Work::new(system, state) };
        steps.restart(system, state, counters)?;
        press(system.rows(), &closed, state);
        Ok(Box::new(steps))
    }
}

impl Stepper for NonsmoothSteps {
    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        (span, _): (Span, Attempt),
        to: &mut State,
        counters: &mut Counters,
    ) -> Result<StepReport, StepError> {
        self.work.begin(from);
        match &mut self.scheme {
            Scheme::Coupled(coupled) => coupled.step(&mut self.work, system, span, to, counters),
            Scheme::Decoupled(smooth) => self.work.step(smooth, system, (from, to), span, counters),
        }
    }

    fn accept(&mut self, _from: &State, to: &State) {
        let Work { from, smooth, held, mean, .. } = &mut self.work;
        match &mut self.scheme {
            Scheme::Coupled(coupled) => coupled.accept(from, smooth, to),
            Scheme::Decoupled(steps) => steps.accept(from, smooth),
        }
        from.a.copy_from_slice(&smooth.a);
        for k in 0..mean.len() {
            mean[k] = to.lambda[k] + 0.5 * (held[k] - smooth.lambda[k]);
        }
        held.copy_from_slice(&smooth.lambda);
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        // Behind an impulse too, for the acceleration at `from` has that impulse in it.
        let mut contacts = from.lambda.iter().zip(system.rows()).filter(|(_, set)| **set != Set::Free);
        let behind = contacts.any(|(force, _)| *force != 0.0);
        match &self.scheme {
            scheme if self.work.corrected || behind => {
                let s = hermite::fraction(from, to, t);
                match scheme {
                    Scheme::Coupled(coupled) => {
                        out.v.iter_mut().zip(&coupled.accepted).for_each(|(part, d)| *part = s * d);
                        system.retract(&from.q, &out.v, &mut out.q);
                    }
                    Scheme::Decoupled(smooth) => self.work.follow(system, from, smooth.increment(), s, out),
                }
                hermite::linear(from, to, t, out);
            }
            Scheme::Coupled(coupled) => hermite::cubic(system, from, to, &coupled.accepted, t, out),
            Scheme::Decoupled(smooth) => smooth.interpolate(system, from, to, t, out),
        }
    }

    /// Impulses act over the whole step, and see dampers as the change of velocity that they make.
    fn middle(&self, system: &dyn Dynamics, from: &State, to: &State, out: &mut State, damped: &mut [f64]) {
        match &self.scheme {
            Scheme::Coupled(coupled) => {
                hermite::middle(system, from, to, &coupled.accepted, out);
                damped.copy_from_slice(&coupled.auxiliary.damped);
            }
            Scheme::Decoupled(smooth) => {
                hermite::middle(system, from, to, smooth.increment(), out);
                for (i, w) in damped.iter_mut().enumerate() {
                    *w = smooth.damped()[i] + to.v[i] - self.work.smooth.v[i];
                }
            }
        }
        out.lambda.copy_from_slice(&self.work.mean);
    }

    fn restart(
        &mut self,
        system: &mut dyn Dynamics,
        state: &mut State,
        counters: &mut Counters,
    ) -> Result<(), StepError> {
        let closed = state.clone();
        open(system.rows(), state);
        match &mut self.scheme {
            Scheme::Coupled(coupled) => coupled.restart(system, state, counters)?,
            Scheme::Decoupled(smooth) => smooth.restart(system, state, counters)?,
        }
        self.work.from.copy_from(state);
        self.work.held.copy_from_slice(&state.lambda);
        press(system.rows(), &closed, state);
        Ok(())
    }

    fn save(&self, out: &mut Checkpoint) {
        match &self.scheme {
            Scheme::Coupled(coupled) => coupled.auxiliary.save(out),
            Scheme::Decoupled(smooth) => smooth.save(out),
        }
        out.put("corrections.convergence", &self.work.convergence.memory());
        out.put("smooth.a", &self.work.from.a);
        out.put("smooth.lambda", &self.work.held);
    }

    fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        match &mut self.scheme {
            Scheme::Coupled(coupled) => coupled.auxiliary.resume(from)?,
            Scheme::Decoupled(smooth) => smooth.resume(system, from)?,
        }
        self.work.convergence.recall(from.numbers("corrections.convergence")?);
        from.fill("smooth.a", &mut self.work.from.a)?;
        from.fill("smooth.lambda", &mut self.work.held)
    }
}
