//! Forces and tangent of an element against automatic differentiation of its strain energy, which is written anew from the
//! definitions: rotation matrices, and no formula for a variation.

use super::derivatives::{far, general};
use flexion::multibody::slender::Beam;
use flexion::system::Weights;
use std::ops::{Add, Div, Mul, Sub};

/// x + a e₁ + b e₂ + c e₁e₂ with e₁² = e₂² = 0: with unit a and b, c is the mixed second derivative (Fike and Alonso 2011,
/// doi 10.2514/6.2011-886).
#[derive(Clone, Copy, Debug)]
struct HyperDual([f64; 4]);

impl HyperDual {
    fn constant(x: f64) -> HyperDual {
        HyperDual([x, 0.0, 0.0, 0.0])
    }

    /// f(self) by f, f′ and f″.
    fn chain(self, f: f64, f1: f64, f2: f64) -> HyperDual {
        let [_, a, b, c] = self.0;
        HyperDual([f, f1 * a, f1 * b, f1 * c + f2 * a * b])
    }

    fn sqrt(self) -> HyperDual {
        let f = self.0[0].sqrt();
        self.chain(f, 0.5 / f, -0.25 / (f * f * f))
    }

    fn sin_cos(self) -> (HyperDual, HyperDual) {
        let (s, c) = self.0[0].sin_cos();
        (self.chain(s, c, -s), self.chain(c, -s, -c))
    }

    fn atan(self) -> HyperDual {
        let x = self.0[0];
        let d = 1.0 / (1.0 + x * x);
        self.chain(x.atan(), d, -2.0 * x * d * d)
    }
}

impl Add for HyperDual {
    type Output = HyperDual;
    fn add(self, y: HyperDual) -> HyperDual {
        HyperDual(std::array::from_fn(|k| self.0[k] + y.0[k]))
    }
}

impl Sub for HyperDual {
    type Output = HyperDual;
    fn sub(self, y: HyperDual) -> HyperDual {
        HyperDual(std::array::from_fn(|k| self.0[k] - y.0[k]))
    }
}

impl Mul for HyperDual {
    type Output = HyperDual;
    fn mul(self, y: HyperDual) -> HyperDual {
        let ([x, a, b, c], [y, d, e, f]) = (self.0, y.0);
        HyperDual([x * y, x * d + a * y, x * e + b * y, x * f + a * e + b * d + c * y])
    }
}

impl Div for HyperDual {
    type Output = HyperDual;
    fn div(self, y: HyperDual) -> HyperDual {
        let f = 1.0 / y.0[0];
        self * y.chain(f, -f * f, 2.0 * f * f * f)
    }
}

type Number = HyperDual;
type Vec3 = [Number; 3];

fn dot(a: Vec3, b: Vec3) -> Number {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vec3, b: Vec3) -> Vec3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn sum(a: Vec3, c: Number, b: Vec3) -> Vec3 {
    std::array::from_fn(|k| a[k] + c * b[k])
}

fn scaled(c: Number, a: Vec3) -> Vec3 {
    a.map(|x| c * x)
}

fn unit(a: Vec3) -> Vec3 {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}

fn number(x: f64) -> Number {
    HyperDual::constant(x)
}

/// The smallest rotation that takes `from` to `to`, of x: R = 1 + [v] + [v]²/(1 + from·to), v = from × to.
fn smallest(from: Vec3, to: Vec3, x: Vec3) -> Vec3 {
    let v = cross(from, to);
    let once = cross(v, x);
    let twice = scaled(number(1.0) / (number(1.0) + dot(from, to)), cross(v, once));
    sum(sum(x, number(1.0), once), number(1.0), twice)
}

/// The angle of `b` about its tangent against the transported frame of `a`; (t, n) each.
fn angle(a: (Vec3, Vec3), b: (Vec3, Vec3)) -> Number {
    let n = smallest(a.0, b.0, a.1);
    (dot(cross(b.0, n), b.1) / dot(n, b.1)).atan()
}

fn hermite(z: f64, h: f64) -> [[f64; 4]; 2] {
    [
        [
            (6.0 * z * z - 6.0 * z) / h,
            3.0 * z * z - 4.0 * z + 1.0,
            (6.0 * z - 6.0 * z * z) / h,
            3.0 * z * z - 2.0 * z,
        ],
        [(12.0 * z - 6.0) / (h * h), (6.0 * z - 4.0) / h, (6.0 - 12.0 * z) / (h * h), (6.0 * z - 2.0) / h],
    ]
}

/// Strains at the two Gauss points z of an element of the length h, and last the parts of ε and κ₁ along P₂(2z − 1); q as in
/// the library.
fn strains(q: &[Vec3; 7], h: f64) -> [[Number; 4]; 3] {
    let [r1, g1, n1, nm, r2, g2, n2] = *q;
    let x = [r1, g1, r2, g2];
    let combine = |n: [f64; 4]| (0..4).fold([number(0.0); 3], |y, i| sum(y, number(n[i]), x[i]));
    let middle = combine(hermite(0.5, h)[0]);
    let slopes = [g1, middle, g2];
    let frames = [(unit(g1), n1), (unit(middle), nm), (unit(g2), n2)];
    let (first, second, whole) =
        (angle(frames[0], frames[1]), angle(frames[1], frames[2]), angle(frames[0], frames[2]));
    let torsion = [
        (number(4.0) * first - whole) / number(h),
        (first + second) / number(h),
        (number(4.0) * second - whole) / number(h),
    ];
    // The part of the values at 0, ½, 1 along P₂: a parabola y₀ + … + c x², x = 2z − 1, has 2c/3 of it.
    let part = |y: [Number; 3]| number(2.0 / 3.0) * (number(0.5) * (y[0] + y[2]) - y[1]);
    // ε of the axis and the mean ½K²κ₁² of the fibres beside it.
    let axial = std::array::from_fn(|k| {
        let stiffness = super::derivatives::stiffness(0.5 * h * k as f64);
        let polar = number(0.5 * (stiffness[2][2] + stiffness[3][3]) / stiffness[0][0]);
        dot(slopes[k], slopes[k]).sqrt() - number(1.0) + polar * torsion[k] * torsion[k]
    });
    let rest = [part(axial), part(torsion), number(0.0), number(0.0)];
    let outer = 0.5 * (1.0 - (1.0 / 3.0_f64).sqrt());
    let [first_point, second_point] = [outer, 1.0 - outer].map(|z| {
        let l = [(1.0 - z) * (1.0 - 2.0 * z), 4.0 * z * (1.0 - z), z * (2.0 * z - 1.0)];
        let interpolated = |y: [Number; 3]| (0..3).fold(number(0.0), |s, i| s + number(l[i]) * y[i]);
        let [slope, curvature] = hermite(z, h).map(combine);
        let (t, length) = (unit(slope), dot(slope, slope).sqrt());
        let n = smallest(frames[1].0, t, nm);
        let (sin, cos) = interpolated([number(0.0) - first, number(0.0), second]).sin_cos();
        let n = sum(scaled(cos, n), sin, cross(t, n));
        let b = cross(t, n);
        [
            interpolated(axial),
            interpolated(torsion),
            number(0.0) - dot(b, curvature) / length,
            dot(n, curvature) / length,
        ]
    });
    [first_point, second_point, rest]
}

/// The strain energy at q ⊞ d, d the given variations.
fn energy(beam: &Beam, q: &[f64; 21], d: &[Number; 15], initial: &[[f64; 4]; 3]) -> Number {
    let h = beam.elements()[0].length();
    let at = |k: usize| [number(q[k]), number(q[k + 1]), number(q[k + 2])];
    let by = |k: usize| [d[k], d[k + 1], d[k + 2]];
    let [r1, g1, r2, g2] = [(0, 0), (3, 3), (12, 8), (15, 11)].map(|(q, d)| sum(at(q), number(1.0), by(d)));
    let middle = |r1: Vec3, g1: Vec3, r2: Vec3, g2: Vec3| {
        let x = [r1, g1, r2, g2];
        let n = hermite(0.5, h)[0];
        (0..4).fold([number(0.0); 3], |y, i| sum(y, number(n[i]), x[i]))
    };
    let moved = |before: Vec3, now: Vec3, n: Vec3, spin: Number| {
        let (t, n) = (unit(now), smallest(unit(before), unit(now), n));
        let (sin, cos) = spin.sin_cos();
        sum(scaled(cos, n), sin, cross(t, n))
    };
    let before = middle(at(0), at(3), at(12), at(15));
    let normals = [
        moved(at(3), g1, at(6), d[6]),
        moved(before, middle(r1, g1, r2, g2), at(9), d[7]),
        moved(at(15), g2, at(18), d[14]),
    ];
    let strains = strains(&[r1, g1, normals[0], normals[1], r2, g2, normals[2]], h);
    let outer = 0.5 * (1.0 - (1.0 / 3.0_f64).sqrt());
    let mut energy = number(0.0);
    for ((strain, initial), (z, w)) in
        strains.iter().zip(initial).zip([(outer, 0.5), (1.0 - outer, 0.5), (0.5, 0.2)])
    {
        let stiffness = super::derivatives::stiffness(z * h);
        for i in 0..4 {
            for j in 0..4 {
                let c = number(0.5 * w * h * stiffness[i][j]);
                energy = energy + c * (strain[i] - number(initial[i])) * (strain[j] - number(initial[j]));
            }
        }
    }
    energy
}

#[test]
fn forces_and_tangent_are_the_derivatives_of_the_strain_energy() {
    let beam = general();
    let (q, ..) = far(&beam, 53);
    let first: &[f64; 21] = q[..21].try_into().unwrap();
    let rest: &[f64; 21] = beam.initial()[..21].try_into().unwrap();
    let at = |k: usize| [number(rest[3 * k]), number(rest[3 * k + 1]), number(rest[3 * k + 2])];
    let initial = strains(&std::array::from_fn(at), beam.elements()[0].length()).map(|s| s.map(|x| x.0[0]));
    let zero = [0.0; 15];
    let motion = flexion::multibody::slender::Motion { q: first, v: &zero, a: &zero };
    let (mut force, mut tangent) = ([0.0; 15], [[0.0; 15]; 15]);
    beam.elements()[0].add_forces(&motion, &mut force);
    beam.elements()[0].add_tangent(&motion, &Weights::new(0.0, 0.0, 1.0), &mut tangent);
    // The tangent is that of forces on velocities: it differs from the second derivative by the part of the spin that
    // increments of r′ make, δΘ = δφ − ½ (t × δr′)·dr′/|r′|².
    let nodes: [[f64; 3]; 3] = [3, 9, 15].map(|k| match k {
        9 => {
            let n = hermite(0.5, beam.elements()[0].length())[0];
            std::array::from_fn(|i| n[0] * q[i] + n[1] * q[3 + i] + n[2] * q[12 + i] + n[3] * q[15 + i])
        }
        k => [q[k], q[k + 1], q[k + 2]],
    });
    let n = hermite(0.5, beam.elements()[0].length())[0];
    let shares = [[0.0, 1.0, 0.0, 0.0], n, [0.0, 0.0, 0.0, 1.0]];
    let mut connection = [[0.0; 15]; 15];
    for ((g, share), spin) in nodes.into_iter().zip(shares).zip([6, 7, 14]) {
        let square: f64 = g.iter().map(|x| x * x).sum();
        let t = g.map(|x| x / square.sqrt());
        let skew = [[0.0, -t[2], t[1]], [t[2], 0.0, -t[0]], [-t[1], t[0], 0.0]];
        for (i, a) in [0, 3, 8, 11].into_iter().enumerate() {
            for (j, b) in [0, 3, 8, 11].into_iter().enumerate() {
                for k in 0..9 {
                    connection[a + k / 3][b + k % 3] +=
                        0.5 * force[spin] * share[i] * share[j] * skew[k / 3][k % 3] / square;
                }
            }
        }
    }
    let largest = tangent.iter().flatten().fold(0.0, |a: f64, x| a.max(x.abs()));
    for i in 0..15 {
        for j in 0..15 {
            let d = std::array::from_fn(|k| {
                HyperDual([0.0, f64::from(u8::from(k == i)), f64::from(u8::from(k == j)), 0.0])
            });
            let [_, gradient, _, second] = energy(&beam, first, &d, &initial).0;
            assert!((force[i] - gradient).abs() < 1e-12 * largest, "{i}: {} for {gradient}", force[i]);
            let expected = second + connection[i][j];
            assert!(
                (tangent[i][j] - expected).abs() < 1e-12 * largest,
                "({i}, {j}): {} for {expected}",
                tangent[i][j]
            );
        }
    }
}
