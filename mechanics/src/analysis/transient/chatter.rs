//! Chatter of contacts, and what the bursts in which they do have in common.
//!
//! Contacts chatter where events follow each other so fast that the run would not come to its end.
//!
//! Counted are events that do not belong to the contact of the event before: bounces of one contact that accumulate come to an end by themselves. A block of
//! them with few steps between is judged by what it leaves: as many events as the rest of the run would have at its rate.

use super::observer::{Event, EventKind};
use crate::contact::Neglected;
use crate::system::{Set, System};

/// Events of a block.
const BLOCK: u32 = 40;
/// Steps, over its events, up to which a block is one of events alone.
const STEPS: u32 = 4;
/// Events that the rest of a run may have.
const MOST: f64 = 20_000.0;

/// The events of a block so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Chatter {
    events: u32,
    steps: u32,
    begin: f64,
    contact: Option<usize>,
    /// Blocks that were found too fast.
    pub(super) fast: u32,
}

impl Chatter {
    /// Counts a step that ends at `time`, with the contact of its event if it has one, and the time that is `left`. Gives the mean time between events where
    /// contacts chatter.
    pub(super) fn count(&mut self, time: f64, event: Option<usize>, left: f64) -> Option<f64> {
        self.steps += 1;
        if event.is_some() && event != self.contact {
            self.events += 1;
            self.contact = event;
        }
        if self.steps > STEPS * BLOCK {
            *self = Chatter { begin: time, contact: self.contact, fast: self.fast, ..Chatter::default() };
        }
        if self.events < BLOCK {
            return None;
        }
        let mean = (time - self.begin) / f64::from(self.events);
        let chatters = left > MOST * mean;
        let fast = self.fast + u32::from(chatters);
        *self = Chatter { begin: time, contact: self.contact, fast, ..Chatter::default() };
        chatters.then_some(mean)
    }

    /// What later steps depend on, as numbers.
    pub(super) fn memory(&self) -> [f64; 5] {
        let contact = self.contact.map_or(-1.0, |contact| contact as f64);
        [f64::from(self.events), f64::from(self.steps), self.begin, contact, f64::from(self.fast)]
    }

    /// From the [memory](Chatter::memory) of a run.
    pub(super) fn recall([events, steps, begin, contact, fast]: [f64; 5]) -> Chatter {
        let contact = (contact >= 0.0).then_some(contact as usize);
        Chatter { events: events as u32, steps: steps as u32, begin, contact, fast: fast as u32 }
    }
}

/// Steps without a change of any contact behind which the first burst of a run ends.
const FIRST: u32 = 20;
/// Steps behind which the step is doubled, until it is the longest: what a burst begins with is the fastest of it.
const DOUBLED: u32 = 100;

/// What bursts of a run have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bursts {
    /// Mean time between events \[s\] of a burst that is to begin.
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
    /// Whether the run ended in one.
    pub(super) open: bool,
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
            open: false,
        }
    }
}

impl Bursts {
    /// Counts a step of a burst; whether it is over.
    pub(super) fn count(&mut self, system: &dyn System, h: f64, event: Option<&Event>) -> bool {
        let Some(quiet) = &mut self.quiet else { return false };
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
        *quiet >= self.hold
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
        [f64::from(self.hold), count as f64, time, gap, energy, self.due.unwrap_or_default()]
    }

    /// From the [memory](Bursts::memory) of a run.
    pub(super) fn recall([hold, count, time, gap, energy, due]: [f64; 6]) -> Bursts {
        let neglected = Neglected { count: count as u64, time, gap, energy };
        let due = (due > 0.0).then_some(due);
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

    #[test]
    fn bounces_of_one_contact_are_no_chatter_and_those_of_two_in_turn_are() {
        let chatters = |contacts: usize, mean: f64| {
            let mut chatter = Chatter::default();
            (1..500).any(|k| chatter.count(mean * f64::from(k), Some(k as usize % contacts), 1.0).is_some())
        };
        assert!(!chatters(1, 1e-7) && chatters(2, 1e-7));
        // They let the run come to its end.
        assert!(!chatters(2, 1e-3));
    }
}
