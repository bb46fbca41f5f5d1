//! Shape functions of a Hermite element of the exact coupling at its quadrature points. Symbols as in
//! [`super::element`].

use crate::quadrature::Gauss;

/// Gauss points of the bending energy. Two integrate the energy of a straight element exactly; the third
/// is for the fourth-order terms of large rotations.
pub(super) const POINTS: usize = 3;

/// Shape functions at the quadrature points of an element of given length: equal for equal elements.
#[derive(Clone, Debug)]
pub struct Rule {
    pub(super) length: f64,
    pub(super) points: [RulePoint; POINTS],
    /// N′ in the middle of the element, and its [`Relative`] part.
    pub(super) middle: [f64; 4],
    pub(super) middle_relative: Relative,
    pub(super) middle_product: Block,
}

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RulePoint {
    /// Position in the element, 0 to 1.
    pub(super) s: f64,
    /// Quadrature weight \[m\].
    pub(super) weight: f64,
    pub(super) n: [f64; 4],
    pub(super) n1: [f64; 4],
    pub(super) n2: [f64; 4],
    pub(super) l: [f64; 3],
    /// The [`Relative`] parts of N′ and N″.
    pub(super) relative: [Relative; 2],
    /// Products of N′ and N″, by rows.
    pub(super) products: Products,
}

/// Derivatives of the Hermite functions for the difference of the displacements of both ends, and for the slopes there: N₁ + N₃ = 1,
/// and a translation leaves no strain.
pub(super) type Relative = [f64; 3];

/// The relative part of a derivative of the functions.
fn relative([_, first, chord, last]: [f64; 4]) -> Relative {
    [chord, first, last]
}

/// N′ᵢN′ⱼ, N′ᵢN″ⱼ, N″ᵢN′ⱼ and N″ᵢN″ⱼ at a quadrature point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Products {
    pub(super) n11: Block,
    pub(super) n12: Block,
    pub(super) n21: Block,
    pub(super) n22: Block,
}

/// A block of an element's tangent: 4 × 4, by rows.
pub(super) type Block = [f64; 16];

/// a bᵀ
fn outer(a: &[f64; 4], b: &[f64; 4]) -> Block {
    std::array::from_fn(|k| a[k / 4] * b[k % 4])
}

impl Rule {
    /// The rule of an element of length \[m\].
    pub fn new(length: f64) -> Rule {
        let mut points = [RulePoint::default(); POINTS];
        for (point, (s, weight)) in points.iter_mut().zip(Gauss::new(POINTS).on(0.0, 1.0)) {
            let (n, n1, n2) = hermite(s, length);
            let products = Products {
                n11: outer(&n1, &n1),
                n12: outer(&n1, &n2),
                n21: outer(&n2, &n1),
                n22: outer(&n2, &n2),
            };
            let relative = [n1, n2].map(relative);
            *point = RulePoint { s, weight: weight * length, n, n1, n2, l: lagrange(s), relative, products };
        }
        let middle = hermite(0.5, length).1;
        let middle_product = outer(&middle, &middle);
        Rule { length, points, middle, middle_relative: relative(middle), middle_product }
    }

    /// N′ in the middle of the element.
    pub(super) fn middle(&self) -> [f64; 4] {
        self.middle
    }

    /// N′ and N″ at quadrature point `g`.
    pub(super) fn slopes(&self, g: usize) -> ([f64; 4], [f64; 4]) {
        (self.points[g].n1, self.points[g].n2)
    }
}

/// N, N′, N″ at s ∈ [0, 1] of an element of length h.
pub(super) fn hermite(s: f64, h: f64) -> ([f64; 4], [f64; 4], [f64; 4]) {
    let r = 1.0 - s;
    (
        [(1.0 + 2.0 * s) * r * r, h * s * r * r, s * s * (3.0 - 2.0 * s), -h * s * s * r],
        [-6.0 * s * r / h, r * (1.0 - 3.0 * s), 6.0 * s * r / h, s * (3.0 * s - 2.0)],
        [(12.0 * s - 6.0) / (h * h), (6.0 * s - 4.0) / h, (6.0 - 12.0 * s) / (h * h), (6.0 * s - 2.0) / h],
    )
}

/// Quadratic Lagrange functions with nodes 0, ½, 1.
pub(super) fn lagrange(s: f64) -> [f64; 3] {
    [(1.0 - s) * (1.0 - 2.0 * s), 4.0 * s * (1.0 - s), s * (2.0 * s - 1.0)]
}
