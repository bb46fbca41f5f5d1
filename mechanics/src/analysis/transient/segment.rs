//! Segments: steps of fixed size between the times at which steps must end.

/// A part of a run without breaks, divided into the fewest equal steps that are not longer than the one asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Segment {
    /// Its start and end \[s\].
    start: f64,
    end: f64,
    /// Size of its steps \[s\], and how many have been completed.
    pub(super) step: f64,
    count: u64,
}

impl Segment {
    pub(super) fn new(start: f64, end: f64, step: f64) -> Segment {
        let span = end - start;
        Segment { start, end, step: span / (span / step - 1e-9).ceil().max(1.0), count: 0 }
    }

    /// Where the next step ends: a multiple, not a sum, so that steps do not drift, and the last one at the end itself.
    pub(super) fn next(&self) -> f64 {
        let t = self.start + (self.count + 1) as f64 * self.step;
        if t >= self.end - 1e-9 * self.step { self.end } else { t }
    }

    /// A step has ended at [`Segment::next`].
    pub(super) fn advance(&mut self) {
        self.count += 1;
    }

    /// As numbers, for a checkpoint.
    pub(super) fn memory(&self) -> [f64; 4] {
        [self.start, self.end, self.step, self.count as f64]
    }

    /// From the [memory](Segment::memory) of a run, to go on to `end`, with the time at which it goes on. `Err` with the
    /// steps before and now if they are not the same.
    pub(super) fn recall(
        [start, _, step, count]: [f64; 4],
        end: f64,
        asked: f64,
    ) -> Result<(Segment, f64), [f64; 2]> {
        let now = Segment::new(start, end, asked).step;
        if (now - step).abs() > 1e-12 * step {
            return Err([step, now]);
        }
        Ok((Segment { start, end, step, count: count as u64 }, start + count * step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_equal_not_longer_than_asked_and_end_at_the_end() {
        let mut segment = Segment::new(1.0, 2.0, 0.3);
        assert_eq!(segment.step, 0.25);
        for t in [1.25, 1.5, 1.75, 2.0] {
            assert_eq!(segment.next(), t);
            segment.advance();
        }
        assert_eq!(Segment::new(0.0, 1.0, 7.0).next(), 1.0);
    }
}
