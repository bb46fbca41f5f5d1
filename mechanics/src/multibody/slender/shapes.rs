//! Shape functions of an element at the points where it is evaluated.
//!
//! The centreline is cubic, r = Σ Nᵢ(s) xᵢ with x = (r₁, r′₁, r₂, r′₂); its derivatives need (r₂ − r₁, r′₁, r′₂) alone. What is sampled at the first node, in the middle and
//! at the second node is interpolated by the quadratic Lagrange functions L. The torsion follows from the angles of twist
//! φ₁ₘ, φₘ₂, φ₁₂ between the three sections (1, m, 2). Seen from any of the three, φ is interpolated quadratically; the
//! three slopes there are sampled and interpolated in turn:
//!
//! ```text
//! κ₁(1) = (4φ₁ₘ − φ₁₂)/h,  κ₁(m) = (φ₁ₘ + φₘ₂)/h,  κ₁(2) = (4φₘ₂ − φ₁₂)/h
//! κ₁(z) = Σ P φ,   P = (4(1 − z)², 4z², −(1 − 2z)²)/h,    z = s/h
//! ```

use crate::quadrature::Gauss;

/// Quadrature points of the strain energy.
pub(super) const POINTS: usize = 2;
/// Quadrature points of mass and distributed loads.
pub(super) const MASS_POINTS: usize = 4;

/// Shape functions of an element of given length.
#[derive(Clone, Debug)]
pub(super) struct Shapes {
    pub length: f64,
    pub points: [Point; POINTS],
    /// The part of ε and κ₁ that vanishes at these points, P₂(2z − 1) with the coefficients of `sample` and `torsion`, and the
    /// weight ∫P₂² ds.
    pub rest: Point,
    /// r′ in the middle by (r₂ − r₁, r′₁, r′₂).
    pub middle: [f64; 3],
    /// P at the three sections.
    pub windings: [[f64; 3]; 3],
}

/// Shape functions at a quadrature point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Point {
    /// Place z in the element, 0 to 1.
    pub place: f64,
    /// Weight \[m\].
    pub weight: f64,
    /// r′ and r″ by (r₂ − r₁, r′₁, r′₂).
    pub slope: [f64; 3],
    pub curvature: [f64; 3],
    /// L and P.
    pub sample: [f64; 3],
    pub torsion: [f64; 3],
}

impl Point {
    /// The functions at the place z of an element of length h.
    pub fn at(place: f64, weight: f64, length: f64) -> Point {
        let [_, slope, curvature] = hermite(place, length).map(|n| [n[2], n[1], n[3]]);
        Point { place, weight, slope, curvature, sample: sample(place), torsion: torsion(place, length) }
    }
}

impl Shapes {
    /// The functions of an element of the length h \[m\].
    pub fn new(length: f64) -> Shapes {
        let mut points = [Point::default(); POINTS];
        for (point, (z, weight)) in points.iter_mut().zip(Gauss::new(POINTS).on(0.0, 1.0)) {
            *point = Point::at(z, weight * length, length);
        }
        let third = 1.0 / 3.0;
        let torsion = [2.0 * third / length, 2.0 * third / length, -2.0 * third / length];
        let sample = [third, -2.0 * third, third];
        let rest = Point { weight: length / 5.0, sample, torsion, ..Point::default() };
        let windings = [0.0, 0.5, 1.0].map(|z| self::torsion(z, length));
        Shapes { length, points, rest, middle: [1.5 / length, -0.25, -0.25], windings }
    }
}

/// N, N′, N″ at the place z of an element of length h.
pub(in crate::multibody) fn hermite(z: f64, h: f64) -> [[f64; 4]; 3] {
    let y = 1.0 - z;
    [
        [(1.0 + 2.0 * z) * y * y, h * z * y * y, z * z * (3.0 - 2.0 * z), -h * z * z * y],
        [-6.0 * z * y / h, y * (1.0 - 3.0 * z), 6.0 * z * y / h, z * (3.0 * z - 2.0)],
        [(12.0 * z - 6.0) / (h * h), (6.0 * z - 4.0) / h, (6.0 - 12.0 * z) / (h * h), (6.0 * z - 2.0) / h],
    ]
}

/// L at the place z.
pub(in crate::multibody) fn sample(z: f64) -> [f64; 3] {
    [(1.0 - z) * (1.0 - 2.0 * z), 4.0 * z * (1.0 - z), z * (2.0 * z - 1.0)]
}

/// P at the place z of an element of length h.
fn torsion(z: f64, h: f64) -> [f64; 3] {
    [4.0 * (1.0 - z) * (1.0 - z) / h, 4.0 * z * z / h, -(1.0 - 2.0 * z) * (1.0 - 2.0 * z) / h]
}
