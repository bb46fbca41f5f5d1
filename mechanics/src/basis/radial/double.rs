//! Double-double arithmetic: numbers of 106 bits as unevaluated sums of two doubles.
//!
//! Sources: T. J. Dekker, *Numer. Math.* 18 (1971) 224–242, doi:10.1007/BF01397083; Y. Hida, X. S. Li &
//! D. H. Bailey, *Proc. ARITH-15* (2001) 155–162, doi:10.1109/ARITH.2001.930115.

use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// high + low, |low| ≤ ½ ulp(high).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Double {
    high: f64,
    low: f64,
}

const LN_2: Double = Double { high: std::f64::consts::LN_2, low: 2.319_046_813_846_299_6e-17 };

impl Double {
    /// 0
    pub(super) const ZERO: Double = Double { high: 0.0, low: 0.0 };
    /// 1
    pub(super) const ONE: Double = Double { high: 1.0, low: 0.0 };

    /// The nearest double.
    #[inline(always)]
    pub(super) fn value(self) -> f64 {
        self.high + self.low
    }

    /// |x|
    pub(super) fn abs(self) -> Double {
        if self.high < 0.0 { -self } else { self }
    }

    /// xⁿ.
    pub(super) fn powi(self, n: usize) -> Double {
        (0..n).fold(Double::ONE, |product, _| product * self)
    }

    /// x^y for x > 0.
    pub(super) fn pow(self, y: f64) -> Double {
        Double::exp(self.ln() * y.into())
    }

    /// eˣ = 2ᵏ (e^{r/8})⁸ with |r| ≤ ½ ln 2; the squarings keep e^{…} − 1.
    fn exp(self) -> Double {
        let k = (self.high / LN_2.high).round();
        let r = (self - LN_2 * k.into()) * 0.125.into();
        let (mut sum, mut term) = (r, r);
        for n in 2..19 {
            term = term * r / (n as f64).into();
            sum += term;
        }
        for _ in 0..3 {
            sum = sum + sum + sum * sum;
        }
        (sum + Double::ONE) * libm::exp2(k).into()
    }

    /// ln x for x > 0: one step of Newton's method on e^y = x from the double result.
    fn ln(self) -> Double {
        let y = Double::from(libm::log(self.high));
        y + (self * Double::exp(-y) - Double::ONE)
    }
}

impl From<f64> for Double {
    fn from(high: f64) -> Double {
        Double { high, low: 0.0 }
    }
}

/// a + b exactly.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let part = sum - a;
    (sum, (a - (sum - part)) + (b - part))
}

/// a + b exactly, |a| ≥ |b|.
#[inline(always)]
fn quick_sum(a: f64, b: f64) -> Double {
    let high = a + b;
    Double { high, low: b - (high - a) }
}

impl Add for Double {
    type Output = Double;
    #[inline]
    fn add(self, o: Double) -> Double {
        let (sum, error) = two_sum(self.high, o.high);
        let (low, rest) = two_sum(self.low, o.low);
        let first = quick_sum(sum, error + low);
        quick_sum(first.high, first.low + rest)
    }
}

impl Neg for Double {
    type Output = Double;
    #[inline]
    fn neg(self) -> Double {
        Double { high: -self.high, low: -self.low }
    }
}

impl Sub for Double {
    type Output = Double;
    #[inline]
    fn sub(self, o: Double) -> Double {
        self + -o
    }
}

impl Mul for Double {
    type Output = Double;
    #[inline]
    fn mul(self, o: Double) -> Double {
        let product = self.high * o.high;
        let error = self.high.mul_add(o.high, -product);
        quick_sum(product, error + (self.high * o.low + self.low * o.high))
    }
}

impl Div for Double {
    type Output = Double;
    #[inline]
    fn div(self, o: Double) -> Double {
        let first = self.high / o.high;
        let rest = self - o * first.into();
        let second = rest.high / o.high;
        let third = (rest - o * second.into()).high / o.high;
        quick_sum(first, second) + third.into()
    }
}

impl AddAssign for Double {
    #[inline]
    fn add_assign(&mut self, o: Double) {
        *self = *self + o;
    }
}

impl SubAssign for Double {
    #[inline]
    fn sub_assign(&mut self, o: Double) {
        *self = *self - o;
    }
}

impl MulAssign for Double {
    #[inline]
    fn mul_assign(&mut self, o: Double) {
        *self = *self * o;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_third_times_three_and_the_square_of_a_root_are_exact_to_31_digits() {
        let third = Double::ONE / 3.0.into();
        assert!((third * 3.0.into() - Double::ONE).value().abs() < 1e-31);
        let root = Double::from(2.0).pow(0.5);
        assert!((root * root - 2.0.into()).value().abs() < 1e-30);
    }

    #[test]
    fn powers_of_a_rational_exponent_return_their_base() {
        // (x^0.625)^8 = x^5, and 0.625 is a double.
        for x in [0.3, 1.0, 7.0, 50.0, 1e4] {
            let error = Double::from(x).pow(0.625).powi(8) / Double::from(x).powi(5) - Double::ONE;
            assert!(error.value().abs() < 2e-30, "{x}: {:e}", error.value());
        }
    }

    #[test]
    fn the_exponential_of_one_is_e_to_31_digits() {
        // e = 2.718281828459045 + 1.4456468917292502e-16 to 32 digits.
        let e = Double::ONE.exp() - std::f64::consts::E.into();
        assert!((e.value() - 1.445_646_891_729_250_2e-16).abs() < 1e-30, "{:e}", e.value());
    }
}
