//! What of a step the observer is shown: its samples, and states between its ends.

use super::{Observer, Plan, Run, Step};
use crate::analysis::energy_balance::Integral;
use crate::integrator::Integration;
use crate::system::{State, System};

/// Shortest recording interval, over the length of the run.
const SMALLEST_SAMPLE: f64 = 1e-9;
/// Parts of a first or last step of a smooth motion at which it is shown too: there no neighbour tells of an extreme.
const BEGINNING: [f64; 3] = [1.0 / 16.0, 0.25, 0.5];
const CLOSING: [f64; 3] = [0.5, 0.75, 15.0 / 16.0];

impl Run {
    fn interval(&self, plan: &Plan) -> f64 {
        plan.sample.max(SMALLEST_SAMPLE * (plan.end - self.origin))
    }

    /// Time of the next sample, and by how much the end of a step may miss it \[s\].
    pub(super) fn next_sample(&self, plan: &Plan) -> (f64, f64) {
        let interval = self.interval(plan);
        ((self.origin + multiple(self.samples, interval)).min(plan.end), 1e-9 * interval)
    }

    /// Shows the observer the last state of a run that ends before the end of its plan, where it is none that was shown.
    pub(super) fn show_last(
        &self,
        system: &mut dyn System,
        state: &State,
        plan: &Plan,
        observer: &mut dyn Observer,
    ) {
        let interval = self.interval(plan);
        if state.t > self.origin + multiple(self.samples - 1, interval) + 1e-9 * interval {
            observer.sample(system, state, &self.passed());
        }
    }

    /// The last step, with the balance at its end.
    pub(super) fn passed(&self) -> Step {
        Step { balance: self.balance.as_ref().map(Integral::balance), ..self.last }
    }

    /// Shows the observer the samples in the step, and what it passes between the ends of a step that begins or `ends` a smooth motion.
    /// Velocities and forces inside a step of a nonsmooth method with an `impact` at its end are those before it.
    pub(super) fn show(
        &mut self,
        system: &mut dyn System,
        integrator: &Integration,
        (from, to): (&State, &State),
        (ends, impact): (bool, bool),
        plan: &Plan,
        observer: &mut dyn Observer,
    ) {
        let parts: &[f64] = match (self.begins, ends) {
            (true, true) => &[BEGINNING[0], BEGINNING[1], CLOSING[0], CLOSING[1], CLOSING[2]],
            (true, false) => &BEGINNING,
            (false, true) => &CLOSING,
            (false, false) => &[],
        };
        let mut passed = parts.iter().map(|part| from.t + part * (to.t - from.t)).peekable();
        loop {
            let (t, slack) = self.next_sample(plan);
            while let Some(t) = passed.next_if(|x| *x < t) {
                integrator.interpolate(system, from, to, t, &mut self.middle);
                let balance = self.balance.as_ref().map(|integral| integral.until((from, to), t));
                observer.between(system, &self.middle, &Step { balance, ..self.last });
            }
            if t > to.t + slack {
                return;
            }
            let mut balance = None;
            if t >= to.t - slack {
                self.middle.copy_from(to);
                balance = self.balance.as_ref().map(Integral::end);
            } else {
                integrator.interpolate(system, from, to, t, &mut self.middle);
                if impact {
                    self.middle.v.copy_from_slice(&from.v);
                    self.middle.a.copy_from_slice(&from.a);
                    self.middle.lambda.copy_from_slice(&from.lambda);
                }
                if let Some(integral) = &self.balance {
                    balance = Some(integral.until((from, to), t));
                }
            }
            // The very multiple, not a sum of steps that comes close to it.
            self.middle.t = t;
            observer.sample(system, &self.middle, &Step { balance, ..self.last });
            // An end that is no multiple is not counted: a run that goes on records the next multiple.
            let due = self.origin + multiple(self.samples, self.interval(plan));
            self.samples += u64::from(due <= plan.end + slack);
            if t >= plan.end {
                return;
            }
        }
    }
}

/// k times the interval; k over a whole number where the interval is the inverse of one, so that samples
/// every 0.02 s fall on 13.28 s and not on its neighbour.
fn multiple(k: u64, interval: f64) -> f64 {
    let inverse = (1.0 / interval).round();
    if inverse >= 1.0 && (inverse * interval - 1.0).abs() < 1e-14 {
        k as f64 / inverse
    } else {
        k as f64 * interval
    }
}
