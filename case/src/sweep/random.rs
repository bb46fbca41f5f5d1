//! Random numbers that depend on a seed alone, on every machine and for good.
//!
//! SplitMix64, of G. L. Steele, D. Lea & C. H. Flood 2014, Fast splittable pseudorandom number generators, doi:10.1145/2714064.2660195.

/// A stream of random numbers.
pub(super) struct Random(u64);

impl Random {
    /// The stream of a seed and the number of an input.
    pub(super) fn new(seed: u64, stream: usize) -> Random {
        let mut random = Random(seed);
        let start = random.next() ^ (stream as u64).wrapping_mul(0xd134_2543_de82_ef95);
        Random(start)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = self.0;
        let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number within 0 < u < 1: the middle of one of 2⁵² parts.
    pub(super) fn unit(&mut self) -> f64 {
        ((self.next() >> 12) as f64 + 0.5) / (1u64 << 52) as f64
    }

    /// A number below `count`, which is not zero.
    fn below(&mut self, count: u64) -> u64 {
        // The high half of a product is nearly uniform: it is off by count / 2⁶⁴.
        ((u128::from(self.next()) * u128::from(count)) >> 64) as u64
    }

    /// The numbers below `count` in a random order (Fisher and Yates).
    pub(super) fn order(&mut self, count: usize) -> Vec<u32> {
        let mut order: Vec<u32> = (0..count as u32).collect();
        for i in (1..count).rev() {
            order.swap(i, self.below(i as u64 + 1) as usize);
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_published_generator() {
        // The first numbers of the seed 1234567, as the reference implementation prints them.
        let mut random = Random(1_234_567);
        let first = [random.next(), random.next(), random.next()];
        assert_eq!(first, [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423]);
    }

    #[test]
    fn an_order_holds_every_number_once_and_depends_on_seed_and_stream() {
        let order = |seed, stream| Random::new(seed, stream).order(100);
        let mut sorted = order(1, 0);
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, of)| i as u32 == *of));
        assert_eq!(order(1, 0), order(1, 0));
        assert_ne!(order(1, 0), order(2, 0));
        assert_ne!(order(1, 0), order(1, 1));
    }
}
