//! A law at work in a run.

use super::input::{Input, Timing};
use crate::system::Limit;

/// Part of a time by which a break may have been joined to another.
const JOINED: f64 = 16.0 * f64::EPSILON;

/// A law at work.
pub(super) struct Acting {
    pub(super) input: Input,
    /// Which of the quantities that are read are its own.
    pub(super) own: Vec<usize>,
    /// Number of its next sample, and of all calls that were no repetition.
    count: u64,
    /// Arguments and value of the last call, and of one that is asked again.
    last: Option<(f64, Vec<f64>, f64)>,
    remembered: Option<(f64, Vec<f64>, f64)>,
}

impl Acting {
    pub(super) fn new(input: Input, own: Vec<usize>) -> Acting {
        Acting { input, own, count: 0, last: None, remembered: None }
    }

    /// Its own of the quantities that are read.
    pub(super) fn own_of(&self, y: &[f64]) -> Vec<f64> {
        // Of a law that follows from time alone nothing is read.
        self.own.iter().filter_map(|j| y.get(*j).copied()).collect()
    }

    pub(super) fn is_continuous(&self) -> bool {
        matches!(self.input.timing, Timing::Continuous { .. })
    }

    pub(super) fn feeds_back(&self) -> bool {
        self.is_continuous() && !self.own.is_empty()
    }

    /// Whether a sample is due at a time.
    pub(super) fn is_due(&self, t: f64) -> bool {
        let Timing::Sampled { period } = self.input.timing else { return false };
        let next = self.count as f64 * period;
        t >= next - JOINED * next
    }

    pub(super) fn call(&mut self, t: f64, y: &[f64]) -> Result<f64, Limit> {
        let Input { name, command, .. } = &mut self.input;
        let limit = |why: String| Limit::Command { name: name.clone(), why };
        match command.value(t, y) {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(value) => Err(limit(format!("gives {value} at t = {t:.6} s, and it must be finite"))),
            Err(why) => Err(limit(why)),
        }
    }

    /// The value of a law that is asked at any time. From time to time an earlier question is asked again.
    pub(super) fn value(&mut self, t: f64, y: &[f64]) -> Result<f64, Limit> {
        if let Some((_, _, value)) = self.last.as_ref().filter(|(at, of, _)| *at == t && of == y) {
            return Ok(*value);
        }
        let value = self.call(t, y)?;
        self.count += 1;
        if self.count.is_power_of_two() {
            let (at, of, before) = self.remembered.take().unwrap_or_else(|| (t, y.to_vec(), value));
            let now = self.call(at, &of)?;
            if now.to_bits() != before.to_bits() {
                let why = format!(
                    "gives {before} and then {now} for the same time t = {at:.6} s and the same motion: what has memory is sampled"
                );
                return Err(Limit::Command { name: self.input.name.clone(), why });
            }
            self.remembered = Some((t, y.to_vec(), value));
        }
        self.last = Some((t, y.to_vec(), value));
        Ok(value)
    }

    /// Takes a sample and holds it.
    pub(super) fn sample(&mut self, t: f64, y: &[f64]) -> Result<(), Limit> {
        let value = self.call(t, y)?;
        self.count += 1;
        self.input.signal.hold(t, value);
        Ok(())
    }
}
