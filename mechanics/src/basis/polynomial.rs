//! Meshfree point interpolation (PIM): polynomials through the data of a moving support domain.
//!
//! ```text
//! w(x) = Σ p_j(ξ) b_j,   p_j = ξʲ,   G b = d,   φ_k = Σ_j ξʲ (G⁻¹)_jk
//! ```
//!
//! over the nodes of a support domain, of half width α_s d_c about the middle of a cell (the interval between
//! two neighbouring nodes, d_c apart), with ξ = (x − middle of the cell)/d_c. The data d are the values at
//! the nodes for the axial field, values and slopes (Hermite type) for the transverse one, and there are as
//! many monomials as data: with n nodes the degree is n − 1 or 2n − 1. Neighbouring cells interpolate the
//! same data at their common node, so the axial field is C⁰ and the transverse field C¹. It is radial point
//! interpolation without the radial functions; α_s = ½ gives the linear and the cubic Hermite element.
//!
//! The polynomial through the data is unique, so the columns of G⁻¹ are written down, not computed by
//! elimination: they are the coefficients of
//!
//! ```text
//! values          ℓ_k = Π (ξ − ξ_j)/(ξ_k − ξ_j)                         over j ≠ k
//! values, slopes  [1 − 2 ℓ_k′(ξ_k)(ξ − ξ_k)] ℓ_k²   and   (ξ − ξ_k) ℓ_k²
//! ```
//!
//! which stay accurate where elimination would lose all digits; κ₁(G) is still reported, and its size limits
//! the support as in the method. Wide supports also oscillate towards the ends of the beam, where they become
//! one-sided (Runge's phenomenon).
//!
//! Sources: G. R. Liu & Y. T. Gu, *Int. J. Numer. Methods Eng.* 50 (2001) 937–951,
//! doi:10.1002/1097-0207(20010210)50:4<937::AID-NME62>3.0.CO;2-X; for rotating beams C. F. Du & D. G. Zhang,
//! *Acta Phys. Sin.* 64 (2015) 034501, doi:10.7498/aps.64.034501.

use super::domains::{self, Domains, per_node};
use super::{BasisError, Field};

/// Most nodes of a support domain: with more the moment matrix is singular.
const MOST_NODES: usize = 40;

/// Parameters of point interpolation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolynomialParameters {
    /// Number of equally spaced nodes, the clamped one at x = 0 included (≥ 2).
    pub nodes: usize,
    /// Half width α_s of the support domain over the node spacing (≥ ½).
    pub support: f64,
}

impl PolynomialParameters {
    /// `nodes` nodes with α_s = 1.5: four nodes in a support, cubics for the axial field and polynomials of
    /// degree 7 for the transverse one.
    pub fn new(nodes: usize) -> PolynomialParameters {
        PolynomialParameters { nodes, support: 1.5 }
    }
}

/// Point interpolation on [0, L]. Its formulas head the source file.
pub type Polynomial = Domains<Patch>;

/// Shape functions of one support domain.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Scaled positions of the nodes ξ; the cell is [−½, ½].
    nodes: Vec<f64>,
    /// Coefficients of ξʲ by functions: the columns of G⁻¹.
    coefficients: Vec<f64>,
    /// Number of functions, and of coefficients of each.
    functions: usize,
    /// κ₁ of the moment matrix.
    condition: f64,
}

impl Patch {
    fn new(nodes: Vec<f64>, per_node: usize) -> Patch {
        let functions = nodes.len() * per_node;
        let mut coefficients = Vec::with_capacity(functions * functions);
        for (k, &here) in nodes.iter().enumerate() {
            let others = || nodes.iter().enumerate().filter(|&(j, _)| j != k).map(|(_, &node)| node);
            let mut shape = vec![1.0];
            for node in others() {
                multiply(&mut shape, -node / (here - node), 1.0 / (here - node));
            }
            if per_node == 2 {
                let slope: f64 = others().map(|node| 1.0 / (here - node)).sum();
                for node in others() {
                    multiply(&mut shape, -node / (here - node), 1.0 / (here - node));
                }
                let mut tilt = shape.clone();
                multiply(&mut shape, 1.0 + 2.0 * slope * here, -2.0 * slope);
                multiply(&mut tilt, -here, 1.0);
                coefficients.extend(shape.into_iter().chain(tilt));
            } else {
                coefficients.extend(shape);
            }
        }
        let condition = moment_norm(&nodes, per_node) * largest_sum(&coefficients, functions);
        Patch { nodes, coefficients, functions, condition }
    }
}

impl domains::Patch for Patch {
    fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    fn functions(&self) -> usize {
        self.functions
    }

    /// By Horner's rule.
    fn eval(&self, k: usize, derivative: usize, xi: f64) -> f64 {
        let n = self.functions;
        let mut sum = 0.0;
        for j in (derivative..n).rev() {
            let falling: f64 = (0..derivative).map(|i| (j - i) as f64).product();
            sum = sum * xi + falling * self.coefficients[k * n + j];
        }
        sum
    }

    fn condition(&self) -> f64 {
        self.condition
    }

    /// Degree 2d + 1 for functions of degree d.
    fn points(&self) -> usize {
        self.functions
    }
}

/// Multiplies a polynomial by a + bξ.
fn multiply(polynomial: &mut Vec<f64>, a: f64, b: f64) {
    polynomial.push(0.0);
    for j in (0..polynomial.len()).rev() {
        let below = if j > 0 { polynomial[j - 1] } else { 0.0 };
        polynomial[j] = a * polynomial[j] + b * below;
    }
}

/// ‖G‖₁: the largest column sum of |ξ_kʲ| (and of |j ξ_kʲ⁻¹|) over the monomials j.
fn moment_norm(nodes: &[f64], per_node: usize) -> f64 {
    (0..per_node * nodes.len())
        .map(|j| {
            let data = |xi: &f64| {
                let slope = if per_node == 2 && j > 0 { j as f64 * xi.abs().powi(j as i32 - 1) } else { 0.0 };
                xi.abs().powi(j as i32) + slope
            };
            nodes.iter().map(data).sum()
        })
        .fold(0.0, f64::max)
}

/// ‖G⁻¹‖₁: the largest sum of magnitudes of the coefficients of one function.
fn largest_sum(coefficients: &[f64], functions: usize) -> f64 {
    coefficients.chunks(functions).map(|c| c.iter().map(|c| c.abs()).sum()).fold(0.0, f64::max)
}

impl Polynomial {
    /// The basis on a beam of the given length \[m\].
    ///
    /// # Errors
    /// [`BasisError::Invalid`] if the length or a parameter is out of its range;
    /// [`BasisError::Singular`] if a moment matrix G is singular to working precision, κ₁(G)·2⁻⁵² ≥ 1.
    pub fn new(
        length: f64,
        parameters: PolynomialParameters,
        field: Field,
    ) -> Result<Polynomial, BasisError> {
        let PolynomialParameters { nodes, support } = parameters;
        if !(support.is_finite() && support >= 0.5) {
            return Err(BasisError::Invalid(format!(
                "support {support} of the polynomial basis must be at least 0.5, or a cell misses its own nodes"
            )));
        }
        Domains::of(length, nodes, (support, false), field, |positions, x| {
            let count = positions.len();
            if count > MOST_NODES {
                return Err(BasisError::Invalid(format!(
                    "the support of {support} spacings holds {count} nodes and no polynomial through more than {MOST_NODES} can be resolved; narrow it"
                )));
            }
            let patch = Patch::new(positions, per_node(field));
            if patch.condition.is_nan() || patch.condition * f64::EPSILON >= 1.0 {
                return Err(BasisError::Singular {
                    basis: "polynomial",
                    number: patch.condition,
                    place: format!("x = {x:.4} m"),
                    parameters: format!(
                        "support {support} with {count} nodes, degree {}",
                        patch.functions - 1
                    ),
                    advice: "narrow the support, or take the basis `radial`",
                });
            }
            Ok(patch)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Basis, Hermite, Role, checks};
    use super::domains::Patch as _;
    use super::*;

    fn with(nodes: usize, support: f64, field: Field) -> Polynomial {
        Polynomial::new(3.7, PolynomialParameters { nodes, support }, field).unwrap()
    }

    #[test]
    fn it_is_a_basis_of_its_field() {
        for field in [Field::Axial, Field::Transverse] {
            for nodes in [2, 3, 5, 11] {
                for support in [0.5, 1.0, 1.5, 2.5, 3.5] {
                    checks::all(&with(nodes, support, field), field);
                }
            }
        }
        checks::all(&with(11, 4.5, Field::Axial), Field::Axial);
    }

    #[test]
    fn the_narrowest_support_is_the_hermite_element() {
        let (one, two) = (with(6, 0.5, Field::Transverse), Hermite::new(3.7, 5, Field::Transverse).unwrap());
        let (mut a, mut b) = ([0.0; 4], [0.0; 4]);
        for cell in 0..5 {
            let x = one.cells()[cell] + 0.3;
            for d in 0..4 {
                let support = one.eval(cell, x, d, &mut a);
                assert_eq!(two.eval(cell, x, d, &mut b), support);
                for (a, b) in a.iter().zip(&b).take(support.len()) {
                    assert!((a - b).abs() < 1e-13 * (1.0 + b.abs()), "{a} for {b}");
                }
            }
        }
    }

    #[test]
    fn it_reproduces_clamped_polynomials_of_the_degree_of_its_data() {
        // Four nodes of values and slopes at the ends of the beam: degree 5 there with three nodes.
        let derivatives: [&dyn Fn(f64) -> f64; 3] = [
            &|x| 0.3 * x * x - 0.07 * x.powi(3) + 0.01 * x.powi(5),
            &|x| 0.6 * x - 0.21 * x * x + 0.05 * x.powi(4),
            &|x| 0.6 - 0.42 * x + 0.2 * x.powi(3),
        ];
        let basis = with(11, 1.5, Field::Transverse);
        let nodal: Vec<f64> = (0..basis.len())
            .map(|i| derivatives[(basis.role(i) == Role::Slope) as usize](basis.anchor(i)))
            .collect();
        checks::reproduces(&basis, &nodal, derivatives);
        let basis = with(11, 1.5, Field::Axial);
        let nodal: Vec<f64> = (0..basis.len()).map(|i| basis.anchor(i).powi(2)).collect();
        checks::reproduces(&basis, &nodal, [&|x: f64| x * x, &|x| 2.0 * x]);
    }

    #[test]
    fn values_and_slopes_at_all_nodes_of_the_support_are_the_unknowns() {
        // At the far nodes, too, where no element is integrated: Kronecker of the whole inverse.
        for (per_node, support) in [(1, 4), (2, 4), (2, 6)] {
            let nodes: Vec<f64> = (0..support).map(|k| k as f64 - 0.5).collect();
            let patch = Patch::new(nodes.clone(), per_node);
            for k in 0..patch.functions {
                for (j, &xi) in nodes.iter().enumerate() {
                    for derivative in 0..per_node {
                        let unit = if k == j * per_node + derivative { 1.0 } else { 0.0 };
                        let found = patch.eval(k, derivative, xi);
                        let tolerance = f64::EPSILON * patch.condition;
                        assert!((found - unit).abs() < tolerance.min(1e-7), "{k} at {xi}: {found}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_support_too_wide_for_monomials_is_refused_with_its_numbers() {
        let parameters = PolynomialParameters { nodes: 21, support: 6.5 };
        match Polynomial::new(10.0, parameters, Field::Transverse) {
            Err(error @ BasisError::Singular { number, .. }) => {
                assert!(number * f64::EPSILON >= 1.0);
                assert!(error.to_string().contains("support 6.5"), "{error}");
            }
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn parameters_out_of_range_are_refused() {
        for (nodes, support) in
            [(0, 1.5), (1, 1.5), (11, 0.4), (11, f64::NAN), (11, f64::INFINITY), (100, 50.0)]
        {
            let parameters = PolynomialParameters { nodes, support };
            let error = Polynomial::new(10.0, parameters, Field::Transverse).unwrap_err();
            assert!(matches!(error, BasisError::Invalid(_)), "{nodes} {support}: {error}");
        }
    }
}
