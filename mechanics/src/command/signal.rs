//! What a law commands at present, as a function of time for those who apply it.

use crate::profile::Profile;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// A number that is set while a run goes on: a torque, a force, the factor of a load. From the time at which it was last held on it has its
/// new value, and before that time the one before.
#[derive(Debug)]
pub struct Signal {
    /// Bits of the value before, of the value, and of the time from which it holds \[s\].
    bits: [AtomicU64; 3],
}

impl Default for Signal {
    fn default() -> Signal {
        Signal { bits: [0.0, 0.0, f64::NEG_INFINITY].map(|x: f64| AtomicU64::new(x.to_bits())) }
    }
}

impl Signal {
    fn get(&self, i: usize) -> f64 {
        f64::from_bits(self.bits[i].load(Relaxed))
    }

    fn put(&self, values: [f64; 3]) {
        self.bits.iter().zip(values).for_each(|(bits, value)| bits.store(value.to_bits(), Relaxed));
    }

    /// Its last value.
    pub fn last(&self) -> f64 {
        self.get(1)
    }

    /// Gives it a value at all times.
    pub fn set(&self, value: f64) {
        self.put([value, value, f64::NEG_INFINITY]);
    }

    /// Gives it a value from `time` \[s\] on.
    pub fn hold(&self, time: f64, value: f64) {
        self.put([self.last(), value, time]);
    }
}

/// Between two samples it is a constant; its breaks are those of the system that is commanded.
impl Profile for Signal {
    fn value(&self, t: f64) -> f64 {
        self.get(usize::from(t >= self.get(2)))
    }

    fn rate(&self, _t: f64) -> f64 {
        0.0
    }

    fn acceleration(&self, _t: f64) -> f64 {
        0.0
    }

    fn integral(&self, t: f64) -> f64 {
        self.value(t) * t
    }
}

/// A signal on top of a function of time.
#[derive(Clone, Debug)]
pub struct Added {
    /// The function of time.
    pub to: Arc<dyn Profile>,
    /// The signal.
    pub signal: Arc<Signal>,
}

impl Profile for Added {
    fn value(&self, t: f64) -> f64 {
        self.to.value(t) + self.signal.value(t)
    }

    fn rate(&self, t: f64) -> f64 {
        self.to.rate(t)
    }

    fn acceleration(&self, t: f64) -> f64 {
        self.to.acceleration(t)
    }

    fn integral(&self, t: f64) -> f64 {
        self.to.integral(t) + self.signal.integral(t)
    }

    fn breaks(&self) -> &[f64] {
        self.to.breaks()
    }

    fn resolution(&self) -> &[f64] {
        self.to.resolution()
    }

    fn parts(&self) -> usize {
        self.to.parts()
    }

    fn range(&self) -> (f64, f64) {
        self.to.range()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_held_signal_has_its_former_value_before_its_time() {
        let signal = Signal::default();
        assert_eq!(signal.value(1.0), 0.0);
        signal.hold(0.5, 2.0);
        assert_eq!([0.4, 0.5_f64.next_down(), 0.5, 9.0].map(|t| signal.value(t)), [0.0, 0.0, 2.0, 2.0]);
        signal.hold(1.0, 3.0);
        assert_eq!([0.9, 1.0].map(|t| signal.value(t)), [2.0, 3.0]);
        signal.set(7.0);
        assert_eq!([0.0, 9.0].map(|t| signal.value(t)), [7.0, 7.0]);
    }
}
