//! Automatic differentiation: polynomials of three numbers whose squares are zero.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// Σ x_m Π eᵢ over the subsets m of {e₁, e₂, e₃}, as bits, with eᵢ² = 0: with unit parts of two of them, the coefficient of their
/// product is a mixed second derivative (Fike & Alonso 2011, doi 10.2514/6.2011-886).
#[derive(Clone, Copy, Debug, Default)]
pub struct Number(pub [f64; 8]);

pub type Vector = [Number; 3];
pub type Matrix = [[Number; 3]; 3];

pub fn number(x: f64) -> Number {
    Number([x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
}

impl Number {
    /// f(self) by f and its three derivatives.
    fn chain(self, [f, f1, f2, f3]: [f64; 4]) -> Number {
        let mut n = self;
        n.0[0] = 0.0;
        let square = n * n;
        number(f) + number(f1) * n + number(0.5 * f2) * square + number(f3 / 6.0) * square * n
    }

    pub fn sqrt(self) -> Number {
        let (x, f) = (self.0[0], self.0[0].sqrt());
        self.chain([f, 0.5 / f, -0.25 / (f * x), 0.375 / (f * x * x)])
    }

    pub fn sin_cos(self) -> (Number, Number) {
        let (s, c) = self.0[0].sin_cos();
        (self.chain([s, c, -s, -c]), self.chain([c, -s, -c, s]))
    }

    pub fn atan(self) -> Number {
        let x = self.0[0];
        let d = 1.0 / (1.0 + x * x);
        self.chain([x.atan(), d, -2.0 * x * d * d, (6.0 * x * x - 2.0) * d * d * d])
    }

    /// The coefficient of e₃, a polynomial of the others.
    pub fn third(self) -> Number {
        let [.., a, b, c, d] = self.0;
        Number([a, b, c, d, 0.0, 0.0, 0.0, 0.0])
    }
}

impl Add for Number {
    type Output = Number;
    fn add(self, y: Number) -> Number {
        Number(std::array::from_fn(|k| self.0[k] + y.0[k]))
    }
}

impl Sub for Number {
    type Output = Number;
    fn sub(self, y: Number) -> Number {
        Number(std::array::from_fn(|k| self.0[k] - y.0[k]))
    }
}

impl Neg for Number {
    type Output = Number;
    fn neg(self) -> Number {
        number(0.0) - self
    }
}

impl Mul for Number {
    type Output = Number;
    fn mul(self, y: Number) -> Number {
        let mut out = [0.0; 8];
        for i in 0..8 {
            (0..8).filter(|j| i & j == 0).for_each(|j| out[i | j] += self.0[i] * y.0[j]);
        }
        Number(out)
    }
}

impl Div for Number {
    type Output = Number;
    fn div(self, y: Number) -> Number {
        let f = 1.0 / y.0[0];
        self * y.chain([f, -f * f, 2.0 * f * f * f, -6.0 * f * f * f * f])
    }
}

pub fn vector(x: [f64; 3]) -> Vector {
    x.map(number)
}

pub fn dot(a: Vector, b: Vector) -> Number {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// a + c b
pub fn sum(a: Vector, c: Number, b: Vector) -> Vector {
    std::array::from_fn(|k| a[k] + c * b[k])
}

pub fn skew(x: Vector) -> Matrix {
    let o = number(0.0);
    [[o, -x[2], x[1]], [x[2], o, -x[0]], [-x[1], x[0], o]]
}

pub fn identity() -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| number(f64::from(u8::from(i == j)))))
}

pub fn transpose(a: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

pub fn apply(a: Matrix, x: Vector) -> Vector {
    a.map(|row| dot(row, x))
}

pub fn product(a: Matrix, b: Matrix) -> Matrix {
    let columns = transpose(b);
    a.map(|row| columns.map(|column| dot(row, column)))
}

/// 1 + b A + c A²
pub fn polynomial(a: Matrix, b: Number, c: Number) -> Matrix {
    let square = product(a, a);
    let one = identity();
    std::array::from_fn(|i| std::array::from_fn(|j| one[i][j] + b * a[i][j] + c * square[i][j]))
}

/// The rotation about x ≠ 0, by Rodrigues' formula.
pub fn rotation(x: Vector) -> Matrix {
    let angle = dot(x, x).sqrt();
    let (sin, cos) = angle.sin_cos();
    polynomial(skew(x), sin / angle, (number(1.0) - cos) / (angle * angle))
}

/// The rotation about x without a part of number 0, by its series.
pub fn small_rotation(x: Vector) -> Matrix {
    polynomial(skew(x), number(1.0), number(0.5))
}

/// The rotation vector of a rotation other than none, of an angle below π.
pub fn logarithm(r: Matrix) -> Vector {
    let half = number(0.5);
    let axis = [half * (r[2][1] - r[1][2]), half * (r[0][2] - r[2][0]), half * (r[1][0] - r[0][1])];
    let cos = half * (r[0][0] + r[1][1] + r[2][2] - number(1.0));
    let sin = dot(axis, axis).sqrt();
    let turned = if cos.0[0] < 0.0 { std::f64::consts::PI } else { 0.0 };
    let angle = (sin / cos).atan() + number(turned);
    axis.map(|x| angle / sin * x)
}

/// The rotation matrix of a unit quaternion.
pub fn of_quaternion(p: [f64; 4]) -> Matrix {
    let [w, x, y, z] = p;
    polynomial(skew(vector([x, y, z])), number(2.0 * w), number(2.0))
}
