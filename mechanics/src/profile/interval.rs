//! Intervals: bounds of all values that a formula takes between two times. What samples miss, bounds do not.
//!
//! Every operation rounds outwards, so that the result holds each value of the exact function. A variable that occurs
//! twice counts as two: bounds are wide over wide intervals, and tight over narrow ones.
//!
//! Source: Moore, Kearfott & Cloud, *Introduction to Interval Analysis* (2009), doi:10.1137/1.9780898717716.

use std::f64::consts::{FRAC_PI_2, LOG10_E, PI, TAU};
use std::ops::{Add, Div, Mul, Neg, Sub};

use super::number::{Function, Number};

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Interval {
    pub low: f64,
    pub high: f64,
}

/// All numbers.
const ALL: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };

impl Interval {
    /// From bounds that may be wrong by their last digits (denormal numbers aside); all numbers where there is no bound.
    fn rounded(low: f64, high: f64) -> Interval {
        let wide = |x: f64| 2.0 * f64::EPSILON * x.abs();
        let (low, high) = (low - wide(low), high + wide(high));
        if low.is_nan() || high.is_nan() { ALL } else { Interval { low, high } }
    }

    /// The values of a function that grows.
    fn growing(self, f: fn(f64) -> f64) -> Interval {
        Interval::rounded(f(self.low), f(self.high))
    }

    /// The part between two numbers: where a function is defined.
    fn within(self, low: f64, high: f64) -> Interval {
        Interval { low: self.low.clamp(low, high), high: self.high.clamp(low, high) }
    }

    pub fn contains(self, x: f64) -> bool {
        self.low <= x && x <= self.high
    }

    /// Whether a + k p lies inside for some whole k.
    fn contains_one_of(self, a: f64, period: f64) -> bool {
        let slack = 1e-15 * (self.low.abs() + self.high.abs());
        ((self.low - slack - a) / period).ceil() <= ((self.high + slack - a) / period).floor()
    }

    pub fn sin(self) -> Interval {
        if !(self.high - self.low < TAU) {
            return Interval { low: -1.0, high: 1.0 };
        }
        let (a, b) = (libm::sin(self.low), libm::sin(self.high));
        let low = if self.contains_one_of(-FRAC_PI_2, TAU) { -1.0 } else { a.min(b) };
        let high = if self.contains_one_of(FRAC_PI_2, TAU) { 1.0 } else { a.max(b) };
        Interval::rounded(low, high)
    }

    pub fn cos(self) -> Interval {
        Interval::sin(self + Interval { low: FRAC_PI_2, high: FRAC_PI_2 })
    }

    pub fn tan(self) -> Interval {
        let pole = !(self.high - self.low < PI) || self.contains_one_of(FRAC_PI_2, PI);
        if pole { ALL } else { self.growing(libm::tan) }
    }

    pub fn asin(self) -> Interval {
        self.within(-1.0, 1.0).growing(libm::asin)
    }

    pub fn acos(self) -> Interval {
        Interval::constant(FRAC_PI_2) - Interval::asin(self)
    }

    pub fn atan(self) -> Interval {
        self.growing(libm::atan)
    }

    pub fn sinh(self) -> Interval {
        self.growing(libm::sinh)
    }

    pub fn cosh(self) -> Interval {
        let (a, b) = (libm::cosh(self.low), libm::cosh(self.high));
        Interval::rounded(if self.contains(0.0) { 1.0 } else { a.min(b) }, a.max(b))
    }

    pub fn tanh(self) -> Interval {
        self.growing(libm::tanh)
    }

    pub fn exp(self) -> Interval {
        self.growing(libm::exp)
    }

    pub fn ln(self) -> Interval {
        self.within(0.0, f64::INFINITY).growing(libm::log)
    }

    pub fn log10(self) -> Interval {
        Interval::ln(self) * Interval::constant(LOG10_E)
    }

    pub fn sqrt(self) -> Interval {
        self.within(0.0, f64::INFINITY).growing(f64::sqrt)
    }

    /// xⁿ with a whole n.
    fn power(self, n: f64) -> Interval {
        let (a, b) = (libm::pow(self.low, n), libm::pow(self.high, n));
        if n < 0.0 && self.contains(0.0) {
            return ALL;
        }
        let least = if n % 2.0 == 0.0 && self.contains(0.0) { 0.0 } else { a.min(b) };
        Interval::rounded(least, a.max(b))
    }
}

impl Number for Interval {
    fn constant(value: f64) -> Interval {
        Interval { low: value, high: value }
    }

    fn pow(self, exponent: Interval) -> Interval {
        let n = exponent.low;
        if exponent.high == n && n.fract() == 0.0 {
            return self.power(n);
        }
        Interval::exp(exponent * Interval::ln(self))
    }

    fn apply(self, function: Function) -> Interval {
        match function {
            Function::Sin => Interval::sin(self),
            Function::Cos => Interval::cos(self),
            Function::Tan => Interval::tan(self),
            Function::Asin => Interval::asin(self),
            Function::Acos => Interval::acos(self),
            Function::Atan => Interval::atan(self),
            Function::Sinh => Interval::sinh(self),
            Function::Cosh => Interval::cosh(self),
            Function::Tanh => Interval::tanh(self),
            Function::Exp => Interval::exp(self),
            Function::Ln => Interval::ln(self),
            Function::Log10 => Interval::log10(self),
            Function::Sqrt => Interval::sqrt(self),
        }
    }

    fn below(self, other: Interval, or_equal: bool) -> Option<bool> {
        let (surely, never) = match or_equal {
            true => (self.high <= other.low, self.low > other.high),
            false => (self.high < other.low, self.low >= other.high),
        };
        (surely || never).then_some(surely)
    }

    fn differs_from_zero(self) -> Option<bool> {
        match (self.contains(0.0), self.low == self.high) {
            (false, _) => Some(true),
            (true, true) => Some(false),
            (true, false) => None,
        }
    }

    fn floor(self) -> (Interval, Option<f64>) {
        let (low, high) = (self.low.floor(), self.high.floor());
        (Interval { low, high }, (low == high).then_some(low))
    }

    fn or(self, other: Interval) -> Interval {
        Interval { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

impl Neg for Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { low: -self.high, high: -self.low }
    }
}

impl Add for Interval {
    type Output = Interval;
    fn add(self, o: Interval) -> Interval {
        Interval::rounded(self.low + o.low, self.high + o.high)
    }
}

impl Sub for Interval {
    type Output = Interval;
    fn sub(self, o: Interval) -> Interval {
        self + -o
    }
}

impl Mul for Interval {
    type Output = Interval;
    fn mul(self, o: Interval) -> Interval {
        let products = [self.low * o.low, self.low * o.high, self.high * o.low, self.high * o.high];
        if products.iter().any(|x| x.is_nan()) {
            return ALL;
        }
        let (low, high) = (f64::min, f64::max);
        Interval::rounded(
            products.into_iter().fold(f64::INFINITY, low),
            products.into_iter().fold(f64::NEG_INFINITY, high),
        )
    }
}

impl Div for Interval {
    type Output = Interval;
    fn div(self, o: Interval) -> Interval {
        if o.contains(0.0) { ALL } else { self * Interval::rounded(1.0 / o.high, 1.0 / o.low) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::program::Program;

    #[test]
    fn bounds_hold_every_value_and_are_tight_over_short_intervals() {
        let texts = [
            "sin(t) + cos(3*t)*t",
            "tan(t/9) - asin(t/4)*acos(-t/5) + atan(t)",
            "sinh(t) - cosh(t - 1)/tanh(t + 4)",
            "exp(-t^2) + (t + 4)^0.5*ln(t + 4) + log10(5 - t) + sqrt(4 + t)",
            "t^3 - t^2 + (t + 5)^-2 + 2^t",
            "abs(t) + sign(t)*step(t - 0.9) + floor(1.9*t) + min(t, 0.9) - max(t^2, 2) + if(t < 0.3, t, 7)",
        ];
        for text in texts {
            let program = Program::parse(text, "t").unwrap();
            for (a, b) in [(-3.0, 3.0), (-1.1, 0.2), (0.1, 0.4), (1.0, 1.01), (2.2, 2.200001)] {
                let (bounds, _) = program.bounds(a, b);
                let samples = (0..=1000).map(|k| program.value(a + (b - a) * f64::from(k) / 1000.0));
                let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
                for y in samples {
                    assert!(bounds.contains(y), "{text} from {a} to {b}: {bounds:?} without {y}");
                    (low, high) = (low.min(y), high.max(y));
                }
                let excess = (bounds.high - bounds.low) - (high - low);
                let jumps = b - a > 0.1;
                assert!(
                    jumps || excess < 20.0 * (b - a),
                    "{text} from {a} to {b}: {bounds:?}, {low} to {high}"
                );
            }
        }
    }

    #[test]
    fn poles_and_undecided_branches_show() {
        for (text, unbounded, decided) in [
            ("1/(t - 3.3)", true, true),
            ("tan(t)", true, true),
            ("ln(t - 3)", true, true),
            ("if(t < 3.3, 1, 2)", false, false),
            ("if(t < 9, 1, 2)", false, true),
        ] {
            let (bounds, whether) = Program::parse(text, "t").unwrap().bounds(3.0, 5.0);
            assert_eq!(
                (bounds.low.is_infinite() || bounds.high.is_infinite(), whether),
                (unbounded, decided),
                "{text}"
            );
        }
    }
}
