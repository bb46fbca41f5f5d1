//! A law at work in a run.

use super::input::{Input, Timing};
use crate::system::Limit;
use std::ops::Range;

/// Part of a time by which a break may have been joined to another.
const JOINED: f64 = 16.0 * f64::EPSILON;

/// What a law gives: u, and behind it the rates of its states.
type Given = Vec<f64>;

/// A law at work.
pub(super) struct Acting {
    pub(super) input: Input,
    /// Which of the quantities that are read are its own.
    pub(super) own: Vec<usize>,
    /// Number of its next sample, and of all calls that were no repetition.
    count: u64,
    /// Number of its first state among those of all laws.
    pub(super) first: usize,
    /// Arguments and what was given in the last call, and in one that is asked again.
    last: Option<(f64, Vec<f64>, Given)>,
    remembered: Option<(f64, Vec<f64>, Given)>,
}

impl Acting {
    pub(super) fn new(input: Input, own: Vec<usize>, first: usize) -> Acting {
        Acting { input, own, count: 0, first, last: None, remembered: None }
    }

    /// Its own of the quantities that are read, and behind them of the states of all laws.
    pub(super) fn own_of(&self, y: &[f64], x: &[f64]) -> Vec<f64> {
        // Of a law that follows from time alone nothing is read.
        let read = self.own.iter().filter_map(|j| y.get(*j).copied());
        read.chain(x[self.states()].iter().copied()).collect()
    }

    /// Its states among those of all laws.
    pub(super) fn states(&self) -> Range<usize> {
        self.first..self.first + self.input.states.len()
    }

    /// What stands for what it gives where it gives nothing.
    pub(super) fn nothing(&self) -> Vec<f64> {
        vec![f64::NAN; 1 + self.input.states.len()]
    }

    pub(super) fn is_continuous(&self) -> bool {
        matches!(self.input.timing, Timing::Continuous { .. })
    }

    pub(super) fn feeds_back(&self) -> bool {
        self.is_continuous() && !(self.own.is_empty() && self.input.states.is_empty())
    }

    /// Whether a sample is due at a time.
    pub(super) fn is_due(&self, t: f64) -> bool {
        let Timing::Sampled { period } = self.input.timing else { return false };
        let next = self.count as f64 * period;
        t >= next - JOINED * next
    }

    pub(super) fn call(&mut self, t: f64, y: &[f64]) -> Result<Given, Limit> {
        let Input { name, command, states, .. } = &mut self.input;
        let limit = |why: String| Limit::Command { name: name.clone(), why };
        let mut given = vec![0.0; 1 + states.len()];
        given[0] = command.value(t, y, &mut given[1..]).map_err(limit)?;
        match given.iter().position(|value| !value.is_finite()) {
            None => Ok(given),
            Some(0) => Err(limit(format!("gives {} at t = {t:.6} s, and it must be finite", given[0]))),
            Some(i) => Err(limit(format!(
                "gives the rate {} of `{}` at t = {t:.6} s, and it must be finite",
                given[i],
                states[i - 1].name
            ))),
        }
    }

    /// What a law gives that is asked at any time. From time to time an earlier question is asked again.
    pub(super) fn value(&mut self, t: f64, y: &[f64]) -> Result<Given, Limit> {
        if let Some((_, _, given)) = self.last.as_ref().filter(|(at, of, _)| *at == t && of == y) {
            return Ok(given.clone());
        }
        let given = self.call(t, y)?;
        self.count += 1;
        if self.count.is_power_of_two() {
            let (at, of, before) = self.remembered.take().unwrap_or_else(|| (t, y.to_vec(), given.clone()));
            let now = self.call(at, &of)?;
            if let Some((now, before)) =
                now.iter().zip(&before).find(|(now, before)| now.to_bits() != before.to_bits())
            {
                let why = format!(
                    "gives {before} and then {now} for the same time t = {at:.6} s and the same motion: what has memory is sampled, \
                     or a state"
                );
                return Err(Limit::Command { name: self.input.name.clone(), why });
            }
            self.remembered = Some((t, y.to_vec(), given.clone()));
        }
        self.last = Some((t, y.to_vec(), given.clone()));
        Ok(given)
    }

    /// Takes a sample and holds it.
    pub(super) fn sample(&mut self, t: f64, y: &[f64]) -> Result<(), Limit> {
        let given = self.call(t, y)?;
        self.count += 1;
        self.input.signal.hold(t, given[0]);
        Ok(())
    }
}
