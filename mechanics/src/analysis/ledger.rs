//! The books of energy of a run: work of drives and loads, and energy lost in dampers.
//!
//! ```text
//! W_d(t) = ∫ P_d dt,   W_l(t) = ∫ P_l dt,   D(t) = ∫ P_D dt,   balance = T + U + V − (T + U + V)(0) − W_d − W_l + D
//! ```
//!
//! In each step the power is taken at two or three times, as a polynomial of time between them, and the polynomial is
//! integrated: to the end of the step, and at no further cost to every recorded time inside it. With s from 0 to 1,
//!
//! | order of the method | s | order of the integral | evaluations of the power a step |
//! |---|---|---|---|
//! | up to 2 | 0, 1 (trapezium) | 2 | 1 |
//! | 3, 4 | 0, ½, 1 (Simpson) | 4 | 2 |
//! | 5 | 0 (of no weight at the end), (4 ∓ √6)/10, 1 (Radau) | 5 | 3 |
//! | 5, step that ends where a drive is not smooth | ½ ∓ √15/10, ½ (Gauss) | 6 | 3 |
//!
//! Between the times the dense output is used. The power at the start is that at the end of the step before. Gauss's
//! rule never asks for the power where it jumps, and the step behind a jump does without s = 0. The balance closes to
//! the order of the method (tested), and what is left is the error of the run: its truncation, and the numerical
//! dissipation of methods that have some.

use crate::integrator::{Checkpoint, Integrator, NotResumed};
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

/// Most times in a step at which the power is taken.
const MOST: usize = 4;
const TRAPEZIUM: &[f64] = &[0.0, 1.0];
const SIMPSON: &[f64] = &[0.0, 0.5, 1.0];
/// 0, (4 − √6)/10, (4 + √6)/10, 1
const RADAU: &[f64; MOST] = &[0.0, 0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0];
/// ½ − √15/10, ½, ½ + √15/10
const GAUSS: &[f64] = &[0.112_701_665_379_258_31, 0.5, 0.887_298_334_620_741_7];

/// ∫₀ˢ of the polynomials that are 1 at one of the `nodes` and 0 at the others.
fn weights(nodes: &[f64], s: f64) -> [f64; MOST] {
    let mut weights = [0.0; MOST];
    for (i, (weight, own)) in weights.iter_mut().zip(nodes).enumerate() {
        // Coefficients from the constant on.
        let mut polynomial = [1.0, 0.0, 0.0, 0.0];
        for (_, other) in nodes.iter().enumerate().filter(|(j, _)| *j != i) {
            let scale = 1.0 / (own - other);
            for k in (0..MOST).rev() {
                let below = if k > 0 { polynomial[k - 1] } else { 0.0 };
                polynomial[k] = scale * (below - other * polynomial[k]);
            }
        }
        let [c0, c1, c2, c3] = polynomial;
        *weight = s * (c0 + s * (c1 / 2.0 + s * (c2 / 3.0 + s * c3 / 4.0)));
    }
    weights
}

/// Keeps the books of a run.
#[derive(Clone, Debug)]
pub(super) struct Ledger {
    order: usize,
    /// At the last accepted step, and the power there.
    books: Books,
    power: Power,
    /// At the end of the step that was entered; the power is known if its rule asks for it.
    end: (Books, Power),
    /// Times in the step that was entered, as fractions of it, and the power there.
    nodes: &'static [f64],
    powers: [Power; MOST],
    /// Dense output.
    middle: State,
}

impl Ledger {
    /// Opens the books at the start of a run with a method of the given order.
    pub(super) fn new(system: &mut dyn System, order: usize, state: &State) -> Ledger {
        let (energy, power) = system.energy_and_power(state);
        let books = Books { initial: energy.total(), ..Books::default() };
        let (nodes, powers) = (TRAPEZIUM, [power; MOST]);
        Ledger { order, books, power, end: (books, power), nodes, powers, middle: state.clone() }
    }

    /// The books at the last accepted step.
    pub(super) fn books(&self) -> Books {
        self.books
    }

    /// The books at the end of the step that was entered.
    pub(super) fn end(&self) -> Books {
        self.end.0
    }

    /// The books at time `t`, inside the step from `from` to `to` that was entered.
    pub(super) fn until(&self, (from, to): (&State, &State), t: f64) -> Books {
        let h = to.t - from.t;
        let mut books = self.books;
        if h > 0.0 {
            let weights = weights(self.nodes, (t - from.t) / h);
            for (weight, power) in weights.iter().zip(&self.powers).take(self.nodes.len()) {
                books.add(h * weight, power);
            }
        }
        books
    }

    /// Enters the accepted step from `from` to `to`; `power` is the power at `to` if it is known.
    pub(super) fn enter(
        &mut self,
        system: &mut dyn System,
        integrator: &dyn Integrator,
        (from, to): (&State, &State),
        mut power: Option<Power>,
    ) {
        let jumps = |t: f64| system.breaks().contains(&t);
        self.nodes = match self.order {
            0..=2 => TRAPEZIUM,
            3..=4 => SIMPSON,
            _ if jumps(to.t) => GAUSS,
            _ if jumps(from.t) => &RADAU[1..],
            _ => RADAU,
        };
        for (s, at) in self.nodes.iter().zip(&mut self.powers) {
            *at = if *s == 0.0 {
                self.power
            } else if *s == 1.0 {
                *power.get_or_insert_with(|| system.power(to))
            } else {
                integrator.interpolate(system, from, to, from.t + s * (to.t - from.t), &mut self.middle);
                system.power(&self.middle)
            };
        }
        self.end = (self.until((from, to), to.t), power.unwrap_or(self.power));
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Monomials up to one degree below the order, to the end of the step; and up to the number of nodes inside it.
    #[test]
    fn the_rules_have_their_orders() {
        for (nodes, order) in [(TRAPEZIUM, 2), (SIMPSON, 4), (RADAU, 5), (&RADAU[1..], 5), (GAUSS, 6)] {
            for (s, exact) in [(1.0, order), (0.3, nodes.len())] {
                for k in 0..exact {
                    let weights = weights(nodes, s);
                    let sum: f64 = nodes.iter().zip(weights).map(|(x, w)| w * x.powi(k as i32)).sum();
                    let integral = f64::powi(s, k as i32 + 1) / (k as f64 + 1.0);
                    assert!((sum - integral).abs() < 1e-15, "{nodes:?} {s} {k}: {sum} {integral}");
                }
            }
        }
        assert!(weights(RADAU, 1.0)[0].abs() < 1e-15);
    }
}
