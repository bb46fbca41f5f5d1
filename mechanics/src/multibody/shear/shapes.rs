//! Nodes, quadrature points and shape functions of an element.
//!
//! The four nodes are those of Lobatto's rule, with which the inertia is integrated; the strain energy is integrated with Gauss' rule
//! of three points. L are Lagrange's functions of the nodes. What is seen from the reference section needs those of the other
//! nodes alone.

use crate::quadrature::Gauss;

/// Nodes of an element.
pub const NODES: usize = 4;
/// Quadrature points of the strain energy, and nodes beside the reference section.
pub const POINTS: usize = NODES - 1;
/// The reference section.
pub(super) const REFERENCE: usize = NODES / 2;
/// The other nodes.
pub(super) const OTHERS: [usize; POINTS] = {
    let (mut out, mut k) = ([0; POINTS], 0);
    while k < POINTS {
        out[k] = if k < REFERENCE { k } else { k + 1 };
        k += 1;
    }
    out
};
/// Places of the nodes on [0, 1], the inner ones at ½ ∓ √5/10, and their weights in Lobatto's rule.
pub(super) const LOBATTO: [(f64, f64); NODES] = [
    (0.0, 1.0 / 12.0),
    (0.276_393_202_250_021, 5.0 / 12.0),
    (0.723_606_797_749_979, 5.0 / 12.0),
    (1.0, 1.0 / 12.0),
];

/// Shape functions at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Point {
    /// Place z in the element, 0 to 1.
    pub place: f64,
    /// Weight \[m\].
    pub weight: f64,
    /// L of the nodes beside the reference section, and their derivatives by the arc length [1/m].
    pub value: [f64; POINTS],
    pub slope: [f64; POINTS],
}

impl Point {
    /// The functions at the place `place` of an element of the length `length`.
    pub fn at(place: f64, weight: f64, length: f64) -> Point {
        let [value, slope, _] = lagrange(place);
        let (value, slope) = (OTHERS.map(|i| value[i]), OTHERS.map(|i| slope[i] / length));
        Point { place, weight, value, slope }
    }
}

/// The quadrature points of the strain energy of an element of the length `length`.
pub(super) fn gauss(length: f64) -> [Point; POINTS] {
    let mut points = [Point::default(); POINTS];
    for (point, (z, weight)) in points.iter_mut().zip(Gauss::new(POINTS).on(0.0, 1.0)) {
        *point = Point::at(z, weight * length, length);
    }
    points
}

/// L and its first and second derivatives at the place z.
pub(in crate::multibody) fn lagrange(z: f64) -> [[f64; NODES]; 3] {
    let mut out = [[0.0; NODES]; 3];
    for (i, (own, _)) in LOBATTO.into_iter().enumerate() {
        let (mut value, mut slope, mut curvature) = (1.0, 0.0, 0.0);
        for (j, (other, _)) in LOBATTO.into_iter().enumerate() {
            if j != i {
                curvature = (curvature * (z - other) + 2.0 * slope) / (own - other);
                slope = (slope * (z - other) + value) / (own - other);
                value *= (z - other) / (own - other);
            }
        }
        (out[0][i], out[1][i], out[2][i]) = (value, slope, curvature);
    }
    out
}
