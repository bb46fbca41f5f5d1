//! The balance of energy of a run.
//!
//! Where the equations of a step are solved iteratively and the step is not controlled, a step too large can
//! converge to a wrong solution that gains energy from nowhere. The audit compares E(t) − E(0) with the work
//! ∫P dt of everything outside the energy, and stops a run that gains far more than it was given.

use super::transient::RunError;
use crate::system::{Power, State, System};

/// Excess energy, over the largest strain energy of the run, beyond which a run is stopped.
const EXCESS: f64 = 0.5;
/// Share of the energy that gravity has exchanged which a rough step may lose or gain on the way: a pendulum too stiff
/// to bend has next to no strain energy, but the truncation error of its swing. A swing of twenty steps has 1 %.
const SWING: f64 = 0.05;
/// Steps at the start of a run whose energy is not judged.
const UNJUDGED: u64 = 20;
/// Steps from one entry to the next: energy and power cost as much as an iteration, and what goes wrong grows.
const INTERVAL: u64 = 4;

/// The books of one run with equal steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Audit {
    steps: u64,
    /// Power at the last two entries [W].
    power: [f64; 2],
    /// Work since the start, and a bound of the error of its quadrature [J].
    work: f64,
    uncertainty: f64,
    /// Energy at the start, and the largest strain energy since [J].
    initial: f64,
    largest_strain: f64,
    /// Lowest and highest energy of gravity [J].
    gravity: [f64; 2],
}

impl Audit {
    /// Opens the books at the start of a run.
    pub(super) fn new(system: &mut dyn System, state: &State) -> Audit {
        let (energy, power) = system.energy_and_power(state);
        Audit {
            steps: 0,
            power: [0.0, power.total()],
            work: 0.0,
            uncertainty: 0.0,
            initial: energy.total(),
            largest_strain: energy.strain,
            gravity: [energy.gravity; 2],
        }
    }

    /// The books as numbers, for a checkpoint.
    pub(super) fn memory(&self) -> [f64; 9] {
        let ([first, middle], [low, high]) = (self.power, self.gravity);
        let steps = self.steps as f64;
        [steps, first, middle, self.work, self.uncertainty, self.initial, self.largest_strain, low, high]
    }

    /// Takes up the [memory](Audit::memory) of another run.
    pub(super) fn recall(&mut self, memory: [f64; 9]) {
        let [steps, first, middle, work, uncertainty, initial, largest_strain, low, high] = memory;
        let (power, gravity) = ([first, middle], [low, high]);
        *self = Audit { steps: steps as u64, power, work, uncertainty, initial, largest_strain, gravity };
    }

    /// Counts a step of size `h` that ended at `to`, enters every fourth and judges every eighth. Gives the power at
    /// `to` where it was needed.
    ///
    /// # Errors
    /// [`RunError::Energy`] when the energy has grown by more than the drive has put in.
    pub(super) fn enter(
        &mut self,
        system: &mut dyn System,
        h: f64,
        to: &State,
    ) -> Result<Option<Power>, RunError> {
        self.steps += 1;
        if !self.steps.is_multiple_of(INTERVAL) {
            return Ok(None);
        }
        let h = INTERVAL as f64 * h;
        let (energy, at_end) = system.energy_and_power(to);
        let power = at_end.total();
        self.largest_strain = self.largest_strain.max(energy.strain);
        let [low, high] = &mut self.gravity;
        (*low, *high) = (low.min(energy.gravity), high.max(energy.gravity));
        let swing = *high - *low;
        let [first, middle] = self.power;
        self.power = [middle, power];
        if !self.steps.is_multiple_of(2 * INTERVAL) {
            return Ok(Some(at_end));
        }
        // Simpson's rule; its difference from the trapezium bounds its error.
        let work = h / 3.0 * (first + 4.0 * middle + power);
        self.uncertainty += (work - 0.5 * h * (first + 2.0 * middle + power)).abs();
        self.work += work;
        let excess = energy.total() - self.initial - self.work;
        // A motion that starts smoothly has energy and work that vanish like high powers of t: in the first
        // steps their quadrature is no measure. They set the level that later steps are held against.
        if self.steps <= UNJUDGED {
            self.initial += excess;
            return Ok(Some(at_end));
        }
        if excess > EXCESS * self.largest_strain + SWING * swing + self.uncertainty {
            return Err(RunError::Energy { time: to.t, excess, work: self.work, strain: energy.strain });
        }
        Ok(Some(at_end))
    }
}
