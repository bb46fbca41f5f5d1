//! Times at which a model with contacts breaks off or an event happens, and its steady rotation.

use super::Contacting;
use crate::contact::law::Law;
use crate::contact::points::Points;
use crate::system::{
    Break, Crossing, Dynamics, Events, Jump, Limit, NotSet, Observed, Parameter, State, Steady,
};

impl<S: Points + Dynamics + Events + Observed> Events for Contacting<S> {
    fn breaks(&self) -> &[Break] {
        &self.breaks
    }

    fn pass(&mut self, s: &State) -> Result<(), Limit> {
        self.inner.pass(s)
    }

    /// An obstacle whose velocity jumps strikes too, without an impulse of its own.
    fn impulse(&mut self, s: &State, p: &mut [f64]) -> bool {
        // Its rows come first.
        let own = self.inner.impulse(s, &mut p[..s.v.len() + self.rows]);
        let moved = |b: &Break| b.time == s.t && b.jump == Jump::Velocity;
        own || self.contacts.iter().any(|placed| placed.contact.obstacle.breaks().iter().any(moved))
    }

    fn impulse_work(&mut self, before: &State, after: &State) -> f64 {
        self.inner.impulse_work(before, after)
    }

    fn turning(&mut self, s: &State) -> f64 {
        self.inner.turning(s)
    }

    fn indicators(&self) -> usize {
        self.indicators + self.forces()
    }

    fn indicate(&mut self, s: &State, out: &mut [f64]) {
        let (own, gaps) = out.split_at_mut(self.indicators);
        self.inner.indicate(s, own);
        self.each(s, |placed, near, _| {
            if let Law::Force(_) = placed.contact.law {
                gaps[placed.place] = near.surface.gap;
            }
        });
    }

    fn indicator_rates(&mut self, s: &State, out: &mut [f64]) {
        let (own, rates) = out.split_at_mut(self.indicators);
        self.inner.indicator_rates(s, own);
        self.each(s, |placed, near, _| {
            if let Law::Force(_) = placed.contact.law {
                rates[placed.place] = near.rate;
            }
        });
    }

    fn cross(&mut self, fired: &[usize], s: &mut State) -> Crossing {
        let own: Vec<usize> = fired.iter().copied().filter(|k| *k < self.indicators).collect();
        let crossing = if own.is_empty() { Crossing::Restart } else { self.inner.cross(&own, s) };
        let mut closing = vec![0.0; self.forces()];
        let length = self.length();
        self.each(s, |placed, near, _| {
            if let Law::Force(_) = placed.contact.law {
                closing[placed.place] = near.closing_speed(length);
            }
        });
        for &k in fired.iter().filter(|k| **k >= self.indicators) {
            s.memory[self.memory + k - self.indicators] = closing[k - self.indicators];
        }
        if crossing == Crossing::Continue { Crossing::Restart } else { crossing }
    }
}

impl<S: Steady> Steady for Contacting<S> {
    fn set(&mut self, parameter: Parameter, value: f64) -> Result<(), NotSet> {
        self.inner.set(parameter, value)
    }

    fn hold(&mut self, held: bool) {
        self.inner.hold(held);
    }

    fn release(&mut self) {
        self.inner.release();
    }
}
