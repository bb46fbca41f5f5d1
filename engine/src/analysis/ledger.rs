//! The books of energy of a run: work of drives and loads, and energy lost in dampers.
//!
//! ```text
//! W_d(t) = ∫ P_d dt,   W_l(t) = ∫ P_l dt,   D(t) = ∫ P_D dt,   balance = T + U + V − (T + U + V)(0) − W_d − W_l + D
//! ```
//!
//! The integrals are taken step by step on the dense output, by a rule of the order of the method or higher: the
//! trapezium for methods of order 2 or less, Gauss's rule with two points up to order 4, with three points beyond. The
//! balance then closes to the order of the method (tested), and what is left is the error of the run: its truncation,
//! and the numerical dissipation of methods that have some.

use crate::integrator::{Checkpoint, Integrator, NotResumed};
use crate::quadrature::Gauss;
use crate::system::{Power, State, System};

/// What has been done to a system and lost by it since the start, in joules.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Books {
    /// Total energy at the start.
    pub initial: f64,
    /// Work of what moves the system.
    pub drive: f64,
    /// Work of the loads, gravity aside.
    pub loads: f64,
    /// Energy lost in dampers.
    pub dissipated: f64,
}

impl Books {
    /// What a total energy `total` has more than it should: 0 for an exact solution.
    pub fn balance(&self, total: f64) -> f64 {
        total - self.initial - self.drive - self.loads + self.dissipated
    }

    fn add(&mut self, weight: f64, power: &Power) {
        self.drive += weight * power.drive;
        self.loads += weight * power.loads;
        self.dissipated += weight * power.dissipated;
    }
}

/// Keeps the books of a run.
#[derive(Clone, Debug)]
pub(super) struct Ledger {
    /// At the last accepted step, and the power there.
    books: Books,
    power: Power,
    /// At the end of the step that was entered.
    end: (Books, Power),
    /// Gauss's rule, or the trapezium.
    gauss: Option<Gauss>,
    /// Dense output.
    middle: State,
}

impl Ledger {
    /// Opens the books at the start of a run with a method of the given order.
    pub(super) fn new(system: &mut dyn System, order: usize, state: &State) -> Ledger {
        let (energy, power) = system.energy_and_power(state);
        let gauss = match order {
            0..=2 => None,
            3..=4 => Some(Gauss::new(2)),
            _ => Some(Gauss::new(3)),
        };
        let books = Books { initial: energy.total(), ..Books::default() };
        Ledger { books, power, end: (books, power), gauss, middle: state.clone() }
    }

    /// The books at the last accepted step.
    pub(super) fn books(&self) -> Books {
        self.books
    }

    /// The books at the end of the step that was entered.
    pub(super) fn end(&self) -> Books {
        self.end.0
    }

    /// The books at `at`, inside the step from `from` to `to` that was entered.
    pub(super) fn until(
        &mut self,
        system: &mut dyn System,
        integrator: &dyn Integrator,
        (from, to): (&State, &State),
        at: &State,
    ) -> Books {
        let mut books = self.books;
        match &self.gauss {
            None => {
                let half = 0.5 * (at.t - from.t);
                books.add(half, &self.power);
                books.add(half, &system.power(at));
            }
            Some(gauss) => {
                for (t, weight) in gauss.on(from.t, at.t) {
                    integrator.interpolate(system, from, to, t, &mut self.middle);
                    books.add(weight, &system.power(&self.middle));
                }
            }
        }
        books
    }

    /// Enters the accepted step from `from` to `to`.
    pub(super) fn enter(
        &mut self,
        system: &mut dyn System,
        integrator: &dyn Integrator,
        (from, to): (&State, &State),
    ) {
        if self.gauss.is_none() {
            let power = system.power(to);
            let (mut books, half) = (self.books, 0.5 * (to.t - from.t));
            books.add(half, &self.power);
            books.add(half, &power);
            self.end = (books, power);
        } else {
            self.end.0 = self.until(system, integrator, (from, to), to);
        }
    }

    /// Closes the step: the next one begins at its end.
    pub(super) fn close(&mut self) {
        (self.books, self.power) = self.end;
    }

    /// Adds the books to a checkpoint.
    pub(super) fn save(&self, out: &mut Checkpoint) {
        let Books { initial, drive, loads, dissipated } = self.books;
        out.put("books", &[initial, drive, loads, dissipated]);
        out.put("power", &[self.power.drive, self.power.loads, self.power.dissipated]);
    }

    /// Takes up the books of an earlier run, if it kept any.
    pub(super) fn recall(&mut self, from: &Checkpoint) -> Result<(), NotResumed> {
        if from.list("books").is_err() {
            return Ok(());
        }
        let [initial, drive, loads, dissipated] = from.numbers("books")?;
        self.books = Books { initial, drive, loads, dissipated };
        let [drive, loads, dissipated] = from.numbers("power")?;
        self.power = Power { drive, loads, dissipated };
        self.end = (self.books, self.power);
        Ok(())
    }
}
