//! Chatter of contacts, and what the bursts in which they do have in common.
//!
//! Contacts chatter where events follow each other so fast that the run would not come to its end.
//!
//! Counted are events in which other contacts take part than in the event before: bounces of one contact that accumulate come to an end by themselves, as do those of
//! the corners of a box that strike together. A block of them with few steps between is judged by what it leaves: by as many contacts as the events of the rest of the run
//! would strike at its rate, for each has its rows in the steps by which an event is located.

use super::observer::{Event, EventKind};
use crate::contact::Neglected;
use crate::system::{Set, System};

/// Events of a block.
const BLOCK: u32 = 40;
/// Steps, over its events, up to which a block is one of events alone.
const STEPS: u32 = 4;
/// Contacts that the events of the rest of a run may strike.
const MOST: f64 = 20_000.0;

/// The contacts of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Together {
    /// A number that other contacts do not have: that of a single one, a hash of several, below 2⁵³.
    which: u64,
    count: u32,
}

impl Together {
    /// These contacts, if there are any.
    pub(super) fn of(contacts: impl Iterator<Item = usize>) -> Option<Together> {
        contacts.map(|i| i as u64).fold(None, |all, i| match all {
            None => Some(Together { which: i, count: 1 }),
            // Fowler, Noll & Vo's prime.
            Some(Together { which, count }) => {
                let hash = (which ^ (i << 20)).wrapping_mul(0x100_0000_01b3);
                Some(Together { which: (hash ^ (hash >> 32)) & ((1 << 53) - 1), count: count + 1 })
            }
        })
    }
}

/// The events of a block so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Chatter {
    events: u32,
    steps: u32,
    begin: f64,
    /// Contacts of the last event.
    which: Option<u64>,
    /// Blocks that were found too fast.
    pub(super) fast: u32,
}

impl Chatter {
    /// Counts a step that ends at `time`, with the contacts of its event if it has one, and the time that is `left`. Gives the mean time between events where
    /// contacts chatter.
    pub(super) fn count(&mut self, time: f64, event: Option<Together>, left: f64) -> Option<f64> {
        self.steps += 1;
        let which = event.map(|event| event.which);
        if event.is_some() && which != self.which {
            self.events += 1;
            self.which = which;
        }
        if self.steps > STEPS * BLOCK {
            *self = Chatter { begin: time, which: self.which, fast: self.fast, ..Chatter::default() };
        }
        if self.events < BLOCK {
            return None;
        }
        let mean = (time - self.begin) / f64::from(self.events);
        let struck = event.map_or(1.0, |event| f64::from(event.count));
        let chatters = struck * left > MOST * mean;
        let fast = self.fast + u32::from(chatters);
        *self = Chatter { begin: time, which: self.which, fast, ..Chatter::default() };
        chatters.then_some(mean)
    }

    /// What later steps depend on, as numbers.
    pub(super) fn memory(&self) -> [f64; 5] {
        let which = self.which.map_or(-1.0, |which| which as f64);
        [f64::from(self.events), f64::from(self.steps), self.begin, which, f64::from(self.fast)]
    }

    /// From the [memory](Chatter::memory) of a run.
    pub(super) fn recall([events, steps, begin, which, fast]: [f64; 5]) -> Chatter {
        let which = (which >= 0.0).then_some(which as u64);
        Chatter { events: events as u32, steps: steps as u32, begin, which, fast: fast as u32 }
    }
}

/// Steps without a change of any contact behind which the first burst of a run ends.
const FIRST: u32 = 20;
/// Steps behind which the step is doubled, until it is the longest: what a burst begins with is the fastest of it.
const DOUBLED: u32 = 100;

/// What bursts of a run have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bursts {
    /// Mean time between events \[s\] of a burst that is to begin, 0 of one of contacts that rub.
    pub(super) due: Option<f64>,
    /// Steps without a change behind which the next one ends.
    pub(super) hold: u32,
    /// Steps without a change so far; `None` outside of bursts.
    pub(super) quiet: Option<u32>,
    neglected: Neglected,
    /// Steps since the step was changed, its size, and the longest \[s\].
    pub(super) count: u32,
    pub(super) step: f64,
    pub(super) longest: f64,
}

impl Default for Bursts {
    fn default() -> Bursts {
        Bursts {
            due: None,
            hold: FIRST,
            quiet: None,
            neglected: Neglected::default(),
            count: 0,
            step: 0.0,
            longest: 0.0,
        }
    }
}

impl Bursts {
    /// Counts a step of a burst.
    pub(super) fn count(&mut self, system: &dyn System, h: f64, event: Option<&Event>) {
        let Some(quiet) = &mut self.quiet else { return };
        *quiet = if event.is_some() { 0 } else { *quiet + 1 };
        if let Some(Event { kind: EventKind::Impact { impulses, rates, .. }, .. }) = event {
            for (i, set) in system.rows().iter().enumerate() {
                let Set::Unilateral { restitution } = *set else { continue };
                if impulses[i] > 0.0 {
                    let speed = (-rates[i]).max(0.0);
                    // 1/W of P = (1 + e) v/W.
                    let energy = 0.5 * restitution * restitution * speed * impulses[i] / (1.0 + restitution);
                    self.neglected.add(Neglected { count: 1, time: h, gap: speed * h, energy });
                }
            }
        }
    }

    /// Whether no contact has opened or closed for so many steps that a burst is over.
    pub(super) fn rest(&self) -> bool {
        self.quiet.is_some_and(|quiet| quiet >= self.hold)
    }

    /// The step that is due next, if it is another than before.
    pub(super) fn longer(&mut self) -> Option<f64> {
        self.quiet?;
        self.count += 1;
        if self.count < DOUBLED || self.step >= self.longest {
            return None;
        }
        (self.count, self.step) = (0, (2.0 * self.step).min(self.longest));
        Some(self.step)
    }

    /// What later steps depend on, as numbers.
    pub(super) fn memory(&self) -> [f64; 6] {
        let Neglected { count, time, gap, energy } = self.neglected;
        [f64::from(self.hold), count as f64, time, gap, energy, self.due.unwrap_or(-1.0)]
    }

    /// From the [memory](Bursts::memory) of a run.
    pub(super) fn recall([hold, count, time, gap, energy, due]: [f64; 6]) -> Bursts {
        let neglected = Neglected { count: count as u64, time, gap, energy };
        let due = (due >= 0.0).then_some(due);
        Bursts { due, hold: hold as u32, neglected, ..Bursts::default() }
    }

    /// Adds what was neglected outside of bursts.
    pub(super) fn add(&mut self, neglected: Neglected) {
        self.neglected.add(neglected);
    }

    /// What its steps neglect.
    pub(super) fn neglected(&self) -> Neglected {
        self.neglected
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether 500 events, of which the k-th is one of these contacts, chatter in a run of 1 s.
    fn chatters<const N: usize>(mean: f64, of: impl Fn(usize) -> [usize; N]) -> bool {
        let mut chatter = Chatter::default();
        (1..500).any(|k| chatter.count(mean * k as f64, Together::of(of(k).into_iter()), 1.0).is_some())
    }

    #[test]
    fn bounces_of_one_contact_are_no_chatter_and_those_of_two_in_turn_are() {
        assert!(!chatters(1e-7, |_| [3]) && chatters(1e-7, |k| [k % 2]));
        // They let the run come to its end.
        assert!(!chatters(1e-3, |k| [k % 2]));
    }

    #[test]
    fn contacts_that_strike_together_are_one_and_those_that_take_turns_with_others_chatter() {
        assert!(!chatters(1e-7, |_| [0, 1, 2, 3]));
        // The first of them takes part each time.
        assert!(chatters(1e-7, |k| [0, 1 + k % 2, 5]));
    }

    #[test]
    fn events_of_many_contacts_count_as_many() {
        assert!(!chatters(1e-4, |k| [k % 2]));
        assert!(chatters(1e-4, |k| [k % 2, 2, 3]));
    }

    #[test]
    fn what_is_remembered_is_a_number_that_is_exact() {
        let many = Together::of((0..400).step_by(3));
        let mut chatter = Chatter::default();
        chatter.count(0.0, many, 1.0);
        assert_eq!(Chatter::recall(chatter.memory()), chatter);
    }
}
