//! Vectors that are multiplied together, entry by entry.

/// Number of matrices that are stored together.
pub(super) const TERMS: usize = 4;

/// An entry of each of the matrices or vectors.
pub(super) type Entry = [f64; TERMS];

/// As many vectors to multiply with a bundle of matrices, entry by entry, with zeros in front and behind.
#[derive(Clone, Debug)]
pub(super) struct Vectors {
    pub(super) terms: usize,
    pub(super) range: std::ops::Range<usize>,
    pub(super) data: Vec<f64>,
}

impl Vectors {
    /// Sets entry i of the vectors to `of(i)`.
    #[inline]
    pub(super) fn set(&mut self, of: impl Fn(usize) -> Entry) {
        let entries = &mut self.data[self.range.clone()];
        if self.terms == TERMS {
            entries.as_chunks_mut::<TERMS>().0.iter_mut().enumerate().for_each(|(i, x)| *x = of(i));
        } else {
            for (i, x) in entries.as_chunks_mut::<2>().0.iter_mut().enumerate() {
                let [a, b, ..] = of(i);
                *x = [a, b];
            }
        }
    }
}
