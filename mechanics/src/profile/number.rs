//! What a formula can be evaluated with.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A smooth function of one number.
#[derive(Clone, Copy, Debug)]
pub(super) enum Function {
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    Ln,
    Log10,
    Sqrt,
}

/// What a formula can be evaluated with: numbers alone, with derivatives, or intervals of them.
pub(super) trait Number:
    Copy
    + Default
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    fn constant(value: f64) -> Self;
    fn pow(self, exponent: Self) -> Self;
    fn apply(self, function: Function) -> Self;
    /// Whether this is less than (or equal to) `other`: `None` for an interval of which only a part is.
    fn below(self, other: Self, or_equal: bool) -> Option<bool>;
    fn differs_from_zero(self) -> Option<bool>;
    /// The largest whole number below, and that number where there is one alone.
    fn floor(self) -> (Self, Option<f64>);
    /// What holds one and the other.
    fn or(self, other: Self) -> Self;
}

impl Number for f64 {
    fn constant(value: f64) -> f64 {
        value
    }

    fn pow(self, exponent: f64) -> f64 {
        libm::pow(self, exponent)
    }

    fn apply(self, function: Function) -> f64 {
        match function {
            Function::Sin => libm::sin(self),
            Function::Cos => libm::cos(self),
            Function::Tan => libm::tan(self),
            Function::Asin => libm::asin(self),
            Function::Acos => libm::acos(self),
            Function::Atan => libm::atan(self),
            Function::Sinh => libm::sinh(self),
            Function::Cosh => libm::cosh(self),
            Function::Tanh => libm::tanh(self),
            Function::Exp => libm::exp(self),
            Function::Ln => libm::log(self),
            Function::Log10 => libm::log10(self),
            Function::Sqrt => f64::sqrt(self),
        }
    }

    fn below(self, other: f64, or_equal: bool) -> Option<bool> {
        Some(if or_equal { self <= other } else { self < other })
    }

    fn differs_from_zero(self) -> Option<bool> {
        Some(self != 0.0)
    }

    fn floor(self) -> (f64, Option<f64>) {
        (f64::floor(self), Some(f64::floor(self)))
    }

    fn or(self, _: f64) -> f64 {
        self
    }
}
