//! Second-order Taylor coefficients in one variable: value, first and second derivative together.
//!
//! For g(f): (g f)′ = g′ f′, (g f)″ = g″ f′² + g′ f″.

use super::number::{Function, Number};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// f, f′ and f″ at one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Jet {
    pub value: f64,
    pub rate: f64,
    pub bend: f64,
}

impl Number for Jet {
    fn constant(value: f64) -> Jet {
        Jet { value, rate: 0.0, bend: 0.0 }
    }

    /// A constant exponent leaves negative bases possible.
    fn pow(self, exponent: Jet) -> Jet {
        if !exponent.is_constant() {
            return Jet::exp(exponent * self.ln());
        }
        let (x, n) = (self.value, exponent.value);
        let term = |factor: f64, power: f64| if factor == 0.0 { 0.0 } else { factor * libm::pow(x, power) };
        self.chain(libm::pow(x, n), term(n, n - 1.0), term(n * (n - 1.0), n - 2.0))
    }

    fn apply(self, function: Function) -> Jet {
        match function {
            Function::Sin => self.sin(),
            Function::Cos => self.cos(),
            Function::Tan => self.tan(),
            Function::Asin => self.asin(),
            Function::Acos => self.acos(),
            Function::Atan => self.atan(),
            Function::Sinh => self.sinh(),
            Function::Cosh => self.cosh(),
            Function::Tanh => self.tanh(),
            Function::Exp => self.exp(),
            Function::Ln => self.ln(),
            Function::Log10 => self.log10(),
            Function::Sqrt => self.sqrt(),
        }
    }

    fn below(self, other: Jet, or_equal: bool) -> Option<bool> {
        self.value.below(other.value, or_equal)
    }

    fn differs_from_zero(self) -> Option<bool> {
        self.value.differs_from_zero()
    }

    fn floor(self) -> (Jet, Option<f64>) {
        let (whole, decided) = Number::floor(self.value);
        (Jet::constant(whole), decided)
    }

    fn or(self, _: Jet) -> Jet {
        self
    }
}

impl Jet {
    /// The variable itself.
    pub fn variable(value: f64) -> Jet {
        Jet { value, rate: 1.0, bend: 0.0 }
    }

    fn is_constant(self) -> bool {
        self.rate == 0.0 && self.bend == 0.0
    }

    /// g of this jet from g, g′ and g″ at its value. A constant stays one where g′ is infinite.
    pub fn chain(self, g: f64, slope: f64, bend: f64) -> Jet {
        if self.is_constant() {
            return Jet::constant(g);
        }
        let first = if self.rate == 0.0 { 0.0 } else { bend * self.rate * self.rate };
        Jet { value: g, rate: slope * self.rate, bend: first + slope * self.bend }
    }

    pub fn sin(self) -> Jet {
        let (s, c) = libm::sincos(self.value);
        self.chain(s, c, -s)
    }

    pub fn cos(self) -> Jet {
        let (s, c) = libm::sincos(self.value);
        self.chain(c, -s, -c)
    }

    pub fn tan(self) -> Jet {
        let y = libm::tan(self.value);
        let slope = 1.0 + y * y;
        self.chain(y, slope, 2.0 * y * slope)
    }

    pub fn asin(self) -> Jet {
        let x = self.value;
        let slope = 1.0 / ((1.0 - x) * (1.0 + x)).sqrt();
        self.chain(libm::asin(x), slope, x * slope.powi(3))
    }

    pub fn acos(self) -> Jet {
        let y = self.asin();
        Jet { value: libm::acos(self.value), rate: -y.rate, bend: -y.bend }
    }

    pub fn atan(self) -> Jet {
        let slope = 1.0 / (1.0 + self.value * self.value);
        self.chain(libm::atan(self.value), slope, -2.0 * self.value * slope * slope)
    }

    pub fn sinh(self) -> Jet {
        let (s, c) = (libm::sinh(self.value), libm::cosh(self.value));
        self.chain(s, c, s)
    }

    pub fn cosh(self) -> Jet {
        let (s, c) = (libm::sinh(self.value), libm::cosh(self.value));
        self.chain(c, s, c)
    }

    pub fn tanh(self) -> Jet {
        let y = libm::tanh(self.value);
        let slope = (1.0 - y) * (1.0 + y);
        self.chain(y, slope, -2.0 * y * slope)
    }

    pub fn exp(self) -> Jet {
        let y = libm::exp(self.value);
        self.chain(y, y, y)
    }

    pub fn ln(self) -> Jet {
        let slope = 1.0 / self.value;
        self.chain(libm::log(self.value), slope, -slope * slope)
    }

    pub fn log10(self) -> Jet {
        let slope = std::f64::consts::LOG10_E / self.value;
        self.chain(libm::log10(self.value), slope, -slope / self.value)
    }

    pub fn sqrt(self) -> Jet {
        let y = self.value.sqrt();
        self.chain(y, 0.5 / y, -0.25 / (y * self.value))
    }
}

impl Add for Jet {
    type Output = Jet;
    fn add(self, o: Jet) -> Jet {
        Jet { value: self.value + o.value, rate: self.rate + o.rate, bend: self.bend + o.bend }
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, o: Jet) -> Jet {
        self + -o
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        Jet { value: -self.value, rate: -self.rate, bend: -self.bend }
    }
}

impl Mul for Jet {
    type Output = Jet;
    fn mul(self, o: Jet) -> Jet {
        Jet {
            value: self.value * o.value,
            rate: self.rate * o.value + self.value * o.rate,
            bend: self.bend * o.value + 2.0 * self.rate * o.rate + self.value * o.bend,
        }
    }
}

impl Div for Jet {
    type Output = Jet;
    fn div(self, o: Jet) -> Jet {
        // From f = q g: f′ = q′g + qg′, f″ = q″g + 2q′g′ + qg″.
        let value = self.value / o.value;
        let rate = (self.rate - value * o.rate) / o.value;
        Jet { value, rate, bend: (self.bend - 2.0 * rate * o.rate - value * o.bend) / o.value }
    }
}
