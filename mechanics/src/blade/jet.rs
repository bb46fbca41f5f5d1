//! A number with its gradient and its matrix of second derivatives by N variables.
//!
//! Sums, products and functions of jets follow the rules of differentiation exactly, so that an energy that is
//! written once gives its force and its tangent without a second derivation:
//!
//! ```text
//! ∇(ab) = a ∇b + b ∇a,   ∇∇(ab) = a ∇∇b + b ∇∇a + ∇a ∇bᵀ + ∇b ∇aᵀ,   ∇∇f(a) = f′ ∇∇a + f″ ∇a ∇aᵀ
//! ```

use std::ops::{Add, Mul, Neg, Sub};

/// A value x, its gradient g and its second derivatives h.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jet<const N: usize> {
    /// Value.
    pub x: f64,
    /// First derivatives.
    pub g: [f64; N],
    /// Second derivatives, symmetric.
    pub h: [[f64; N]; N],
}

impl<const N: usize> Jet<N> {
    /// A number that does not depend on the variables.
    pub fn constant(x: f64) -> Jet<N> {
        Jet { x, g: [0.0; N], h: [[0.0; N]; N] }
    }

    /// The variable of the given number at the value x.
    pub fn variable(x: f64, number: usize) -> Jet<N> {
        let mut jet = Jet::constant(x);
        jet.g[number] = 1.0;
        jet
    }

    /// The same number as a function of more variables, of which its own are the first.
    pub fn among<const M: usize>(&self) -> Jet<M> {
        let mut out = Jet::constant(self.x);
        out.g[..N].copy_from_slice(&self.g);
        for (to, from) in out.h.iter_mut().zip(&self.h) {
            to[..N].copy_from_slice(from);
        }
        out
    }

    /// f(self) from f and its first two derivatives.
    fn chain(&self, f: f64, f1: f64, f2: f64) -> Jet<N> {
        let mut out = Jet::constant(f);
        for i in 0..N {
            out.g[i] = f1 * self.g[i];
            for j in 0..N {
                out.h[i][j] = f1 * self.h[i][j] + f2 * self.g[i] * self.g[j];
            }
        }
        out
    }

    /// 1/self
    pub fn inverse(&self) -> Jet<N> {
        let f = 1.0 / self.x;
        self.chain(f, -f * f, 2.0 * f * f * f)
    }

    /// √self
    pub fn sqrt(&self) -> Jet<N> {
        let f = self.x.sqrt();
        self.chain(f, 0.5 / f, -0.25 / (f * self.x))
    }

    /// Sine and cosine.
    pub fn sin_cos(&self) -> (Jet<N>, Jet<N>) {
        let (s, c) = libm::sincos(self.x);
        (self.chain(s, c, -s), self.chain(c, -s, -c))
    }

    /// factor · self
    pub fn scaled(&self, factor: f64) -> Jet<N> {
        self.chain(factor * self.x, factor, 0.0)
    }
}

impl<const N: usize> Add for Jet<N> {
    type Output = Jet<N>;

    fn add(mut self, other: Jet<N>) -> Jet<N> {
        self.x += other.x;
        for i in 0..N {
            self.g[i] += other.g[i];
            for j in 0..N {
                self.h[i][j] += other.h[i][j];
            }
        }
        self
    }
}

impl<const N: usize> Neg for Jet<N> {
    type Output = Jet<N>;

    fn neg(self) -> Jet<N> {
        self.scaled(-1.0)
    }
}

impl<const N: usize> Sub for Jet<N> {
    type Output = Jet<N>;

    fn sub(self, other: Jet<N>) -> Jet<N> {
        self + -other
    }
}

impl<const N: usize> Mul for Jet<N> {
    type Output = Jet<N>;

    fn mul(self, other: Jet<N>) -> Jet<N> {
        let mut out = Jet::constant(self.x * other.x);
        for i in 0..N {
            out.g[i] = self.x * other.g[i] + other.x * self.g[i];
            for j in 0..N {
                out.h[i][j] = self.x * other.h[i][j]
                    + other.x * self.h[i][j]
                    + self.g[i] * other.g[j]
                    + other.g[i] * self.g[j];
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_closed_form() {
        // f = sin(x)·√y / x + cos(x) − 2y at (0.7, 1.9), differentiated by hand.
        let (x0, y0) = (0.7_f64, 1.9_f64);
        let (x, y) = (Jet::<2>::variable(x0, 0), Jet::<2>::variable(y0, 1));
        let (s, c) = x.sin_cos();
        let f = s * y.sqrt() * x.inverse() + c - y.scaled(2.0);
        let (sin, cos, r) = (x0.sin(), x0.cos(), y0.sqrt());
        let sinc1 = cos / x0 - sin / (x0 * x0);
        let sinc2 = -sin / x0 - 2.0 * cos / (x0 * x0) + 2.0 * sin / x0.powi(3);
        let expected = [
            (f.x, sin / x0 * r + cos - 2.0 * y0),
            (f.g[0], sinc1 * r - sin),
            (f.g[1], sin / x0 * 0.5 / r - 2.0),
            (f.h[0][0], sinc2 * r - cos),
            (f.h[0][1], sinc1 * 0.5 / r),
            (f.h[1][0], sinc1 * 0.5 / r),
            (f.h[1][1], -sin / x0 * 0.25 / (r * y0)),
        ];
        for (found, expected) in expected {
            assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
        }
    }
}
