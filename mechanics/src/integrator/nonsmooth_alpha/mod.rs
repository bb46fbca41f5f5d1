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
//! with the matrix M + hC + ½h²K, so that a node without mass is admitted. What the contacts change of the forces is not
//! in the accelerations that the smooth motion remembers; acting as an impulse over one step it has its full effect.
//!
//! Sources: Brüls, Acary & Cardona (2014, doi 10.1016/j.cma.2014.07.025); Cosimo, Galvez, Cavalieri, Cardona & Brüls
//! (2020, doi 10.1007/s11044-019-09706-6), who correct the position by h² and not ½h² times the change of acceleration:
//! a constant force then shifts the position by O(h). Friction at the level of positions, which keeps a contact that
//! sticks from creeping, is Capobianco, Harsch, Eugster & Leine's (2021, doi 10.1002/nme.6801) in purpose, not in form.

mod coupled;
mod decoupled;
mod memory;

use super::impulses::Impulses;
use super::rows::Rows;
use super::{
    Checkpoint, Convergence, Counters, GeneralizedAlpha, Info, Integrator, InvalidParameter, NotResumed,
    Span, StepError, StepReport, failure, hermite,
};
use crate::contact::Unresolved;
use crate::linalg::Matrix;
use crate::system::{Dynamics, Mode, Set, State};
use memory::Coupled;

/// Name as in a case file.
const NAME: &str = "nonsmooth-generalized-alpha";

/// Iteration error of the corrections, relative to the scales of the unknowns.
const TOLERANCE: f64 = 1e-12;

/// Part of the limit of friction from which on a contact slips.
const SLIPPING: f64 = 1.0 - 1e-9;

/// The nonsmooth generalized-α method. Its formulas head the source file.
#[derive(Debug)]
pub struct NonsmoothAlpha {
    info: Info,
    smooth: GeneralizedAlpha,
    convergence: Convergence,
    /// Work of the corrections.
    counters: Counters,
    /// Whether a contact acted in the last step.
    corrected: bool,
    work: Option<Box<Work>>,
    /// Memory of the coupled scheme.
    coupled: Option<Coupled>,
}

/// What a correction imposes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Level {
    Position,
    Velocity,
}

/// What `start` allocates for a system.
#[derive(Debug)]
struct Work {
    matrix: Matrix,
    rows: Rows,
    impulses: Impulses,
    /// The start of the step with all contacts open and the accelerations of the smooth motion; its end.
    from: State,
    smooth: State,
    /// Where the forces of a correction are evaluated.
    trial: State,
    /// α, ½h²α, and the multipliers of the contacts.
    alpha: Vec<f64>,
    increment: Vec<f64>,
    forces: Vec<f64>,
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
            convergence: Convergence::full(TOLERANCE, 1e-9),
            counters: Counters::default(),
            corrected: false,
            work: None,
            coupled: None,
        })
    }

    /// The coupled scheme, for systems with a regular mass matrix.
    ///
    /// # Errors
    /// Outside 0 ≤ ρ∞ ≤ 1.
    pub fn coupled(spectral_radius: f64) -> Result<NonsmoothAlpha, InvalidParameter> {
        let coupled = Some(Coupled::default());
        Ok(NonsmoothAlpha { coupled, ..NonsmoothAlpha::decoupled(spectral_radius)? })
    }

    /// The error of corrections that do not converge.
    fn not_converged(&self, work: &Work, system: &dyn Dynamics, step: f64, size: f64) -> StepError {
        let sizes = work.rhs.iter().zip(&work.scale).map(|(x, scale)| (x / scale).abs());
        let largest = sizes.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        StepError::NotConverged {
            time: work.from.t,
            step,
            iterations: self.convergence.iterations(),
            size: size / TOLERANCE,
            worst: system.unknown(largest.map_or(0, |(i, _)| i)),
        }
    }
}

impl Work {
    fn new(system: &mut dyn Dynamics, state: &State) -> Work {
        let size = system.size();
        let (n, m) = (size.v, size.lambda);
        let zeros = |n| vec![0.0; n];
        let state = || State::zeros(size, state.t);
        Work {
            matrix: Matrix::new(&system.structure(1)),
            rows: Rows::new(system, &state()),
            impulses: Impulses::new(m, n + m),
            from: state(),
            smooth: state(),
            trial: state(),
            alpha: zeros(n),
            increment: zeros(n),
            forces: zeros(m),
            rhs: zeros(n + m),
            gaps: zeros(m),
            rates: zeros(m),
            start: zeros(m),
            takes_part: vec![false; m],
            scale: system.scales().to_vec(),
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
        self.impulses.solve(matrix, self.rows.stored(), value, forces, &mut self.rhs)
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

impl Integrator for NonsmoothAlpha {
    fn info(&self) -> &Info {
        &self.info
    }

    fn start(&mut self, system: &mut dyn Dynamics, state: &mut State, step: f64) -> Result<(), StepError> {
        self.counters = Counters::default();
        self.convergence.reset();
        self.work = Some(Box::new(Work::new(system, state)));
        if let Some(coupled) = &mut self.coupled {
            coupled.start(system);
        }
        open(system.rows(), state);
        // Without joints nothing is to be stabilized.
        self.smooth.stabilize(system.rows().contains(&Set::Free));
        self.smooth.start(system, state, step)?;
        self.restart(system, state)
    }

    fn step(
        &mut self,
        system: &mut dyn Dynamics,
        from: &State,
        span: Span,
        to: &mut State,
    ) -> Result<StepReport, StepError> {
        let Some(mut work) = self.work.take() else {
            return Err(StepError::NotStarted { method: NAME });
        };
        (work.from.t, work.from.side) = (from.t, from.side);
        work.from.q.copy_from_slice(&from.q);
        work.from.v.copy_from_slice(&from.v);
        work.from.lambda.copy_from_slice(&from.lambda);
        work.from.copy_modes(from);
        open(work.rows.sets(), &mut work.from);
        let result = match self.coupled.take() {
            Some(mut coupled) => {
                let result = self.attempt_coupled(&mut coupled, &mut work, system, span, to);
                self.coupled = Some(coupled);
                result
            }
            None => self.attempt_decoupled(&mut work, system, from, span, to),
        };
        self.work = Some(work);
        result
    }

    fn discard(&mut self) {
        self.smooth.discard();
    }

    fn accept(&mut self, _from: &State, _to: &State) {
        if let Some(work) = &mut self.work {
            match &mut self.coupled {
                Some(coupled) => {
                    coupled.accept();
                    self.counters.steps += 1;
                }
                None => self.smooth.accept(&work.from, &work.smooth),
            }
            work.from.a.copy_from_slice(&work.smooth.a);
        }
    }

    fn interpolate(&self, system: &dyn Dynamics, from: &State, to: &State, t: f64, out: &mut State) {
        if self.corrected {
            hermite::linear(system, from, to, t, out);
        } else if let Some(coupled) = &self.coupled {
            hermite::cubic(system, from, to, &coupled.accepted, t, out);
        } else {
            self.smooth.interpolate(system, from, to, t, out);
        }
    }

    fn restart(&mut self, system: &mut dyn Dynamics, state: &mut State) -> Result<(), StepError> {
        open(system.rows(), state);
        self.smooth.restart(system, state)?;
        if let Some(work) = &mut self.work {
            work.from.copy_from(state);
        }
        if let Some(coupled) = &mut self.coupled {
            coupled.restart(&state.a);
        }
        Ok(())
    }

    fn save(&self, out: &mut Checkpoint) {
        self.smooth.save(out);
        out.put("corrections.counters", &self.counters.to_numbers());
        out.put("corrections.convergence", &self.convergence.memory());
        if let Some(work) = &self.work {
            out.put("smooth.a", &work.from.a);
        }
        if let Some(coupled) = &self.coupled {
            coupled.save(out);
        }
    }

    fn resume(&mut self, system: &mut dyn Dynamics, from: &Checkpoint) -> Result<(), NotResumed> {
        self.smooth.resume(system, from)?;
        self.counters = Counters::from_numbers(from.numbers("corrections.counters")?);
        self.convergence.recall(from.numbers("corrections.convergence")?);
        let Some(work) = &mut self.work else {
            return Err(NotResumed::Failed(format!("{NAME} was not started")));
        };
        from.fill("smooth.a", &mut work.from.a)?;
        match &mut self.coupled {
            Some(coupled) => coupled.resume(from),
            None => Ok(()),
        }
    }

    fn resolves_contacts(&self) -> bool {
        true
    }

    fn worst(&self) -> usize {
        self.smooth.worst()
    }

    fn counters(&self) -> Counters {
        let (mut all, own) = (self.smooth.counters(), self.counters);
        all.steps += own.steps;
        all.iterations += own.iterations;
        all.residuals += own.residuals;
        all.tangents += own.tangents;
        all.factorizations += own.factorizations;
        all.solves += own.solves;
        all
    }
}
