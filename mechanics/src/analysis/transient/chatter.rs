//! Whether contacts chatter: events follow each other so fast that the run would not come to its end.
//!
//! Counted are events that do not belong to the contact of the event before: bounces of one contact that accumulate come to an end by themselves. A block of
//! them with few steps between is judged by what it leaves: as many events as the rest of the run would have at its rate.

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
